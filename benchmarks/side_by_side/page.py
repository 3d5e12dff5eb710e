"""What the page of the comparison says besides its numbers."""

HEAD = """# Side by side

Eight tasks with closedform and with other libraries that robotics engineers use, all for a UR5e
with the nominal lengths of the maker. Every answer is compared with ours, and the tests do the
same for each library that is installed. Solvers that enumerate have to give the same postures or
sets of postures. Those that iterate from a seed find one solution, which need not be the nearest;
the tables count how often it is. Each library is used as its documentation recommends. It solves
100 targets, one after the other if it does not take several, or follows a path of 200 points. The
times are medians for one target or point, on {machine}, all taking turns in one process. What is
computed once, such as a derivation or compiling, is not counted; the first table shows it.

This page is written by `python -m benchmarks.side_by_side`; libraries that are not installed are
left out. `pip install 'closedform[derive,plot,peers]'` installs them all. PyRoki is
`almond-pyroki` there, a fork that installs the module `pyroki`, because PyPI does not have PyRoki
itself.
"""

TITLES = {
    "nearest": "The posture nearest to the last one",
    "limits": "Joint limits",
    "tracking": "Following a path",
    "batch": "All postures of many targets",
    "gradient": "Jacobians and gradients",
    "tool": "A tool",
    "drawing": "Drawing",
    "URDF": "URDF",
}

INTRODUCTIONS = {
    "nearest": """\
The limits leave two turns to all joints but the elbow, so most postures are possible at several
turns. One call of closedform takes all targets. The second row shows it with one target a call,
most of which is the work of Python around one call of the C function `ur_arm_nearest`
([in a controller](in-a-controller.md)).""",
    "limits": """\
All postures within 2.6 rad of zero. closedform drops nothing: it says which joint of which branch
has no turn within its limits.""",
    "tracking": """\
A straight path of 40 cm. closedform also says where the branch changes and where a joint jumps,
and computes all points between two such places at once.""",
    "batch": "All solutions, without limits.",
    "gradient": """\
The Jacobian of the flange, in the axes of the base. PyRoki computes it by automatic
differentiation, and so do [our array modules](using.md#any-array-library), also through the
inverse and by the dimensions.""",
    "tool": "A tool that is 15 cm long, and then the nearest posture.",
    "drawing": "The arm in one posture, with Matplotlib and without a window.",
    "URDF": """\
The time until the poses of the arm can be computed. closedform derives and proves the forward and
the inverse map and prints C and NumPy, which is done once for an arm; the others read the file
whenever a program starts.""",
}

TAIL = """## What the others can do and we cannot

- Inverses of any arm: the numeric solvers of the Robotics Toolbox, pinocchio and PyRoki take arms
  without a closed form, with more than six joints, and several hands at once. ssik enumerates the
  solutions of arms of six joints without a closed form, and samples those of arms with seven.
- Dynamics: pinocchio and the Robotics Toolbox. closedform stops at velocities and static forces.
- Collisions: pinocchio, the Robotics Toolbox and PyRoki. closedform gives the frames of the
  links.
- Optimisation of whole paths, with costs of one's own: PyRoki.
- Teleoperation, with a clutch and calibration of the device: ssik.
- Meshes in a viewer: the Robotics Toolbox, pinocchio, PyRoki, and ssik in its examples.

Mechanisms with closed loops, proofs, and code without dependencies in C and JavaScript are ours.
"""
