"""Claims of Shi, Zhu and Li about the double parallelogram and the IRB 260."""

from functools import partial

import sympy as sp
from closedform.derivations.claims.irb260_equations import Palletiser, equations, symbols
from sympy import cos, pi, sin

from closedform import (
    Count,
    Derivation,
    Enumeration,
    Every,
    Identity,
    Refuted,
    Undecidable,
    Under,
    homogeneous,
    inverse,
    real,
    rotation,
    twist_of,
)


def state(d: Derivation, arm: Palletiser) -> None:
    """Transcribe all claims, in the order of the paper."""
    mechanism(d, arm)
    equations(d, arm)
    verification(d, arm)
    values(d)


def mechanism(d: Derivation, arm: Palletiser) -> None:
    """The double parallelogram and the virtual joint."""
    _, theta2, theta3, theta4, theta5 = arm.thetas
    R, sigma = arm.pose[:3, :3], real("sigma")
    z = sp.Matrix([0, 0, 1])
    loops = {"lower loop": arm.lower, "upper loop": arm.upper}
    turns = {name: next(iter(loop.solution)) for name, loop in loops.items()}
    parallel = {name: loops[name][turn].subs(sigma, 1) for name, turn in turns.items()}
    bracket = sum(parallel.values())
    crank = real("crank")  # the angle of the upper arm against the plate
    plate = turns["lower loop"]
    upper = [e.subs(theta2, crank - theta3 - pi / 2 + plate) for e in arm.upper.equations]
    d.claim(
        "two four-bar mechanisms",
        "“This manipulator includes two parallel four-bar mechanisms that make the kinematics and "
        "dynamic analysis complicated.”",
        Undecidable(
            "a statement about the machine, not about its kinematics; if motor 3 is on the turret, "
            "a third parallelogram drives the upper arm"
        ),
        where="Abstract",
    )
    claim = partial(d.claim, where="II. Background")
    claim(
        "planar translation",
        "“Since the four links constitutes a parallelogram and one link is fixed, the coupler can "
        "only achieve the planar translation no matter the angle that the input link rotates.”",
        Every(
            {
                "the loop is closed by a coupler that does not turn": Identity(
                    [e.subs(arm.lower.solution).subs(sigma, 1) for e in arm.lower.equations]
                    + [parallel["lower loop"]],
                    [0, 0, 0],
                ),
                "the other assembly is the antiparallelogram": Count(
                    arm.lower.equations, tuple(arm.lower.solution), 2
                ),
            }
        ),
    )
    claim(
        "parallel translation",
        "“Therefore the end-effector of the robot can only obtain the parallel translation.”",
        Refuted(
            Identity(
                R.subs(dict.fromkeys(arm.actuated, 0) | {theta5: pi / 2}), rotation("z", pi / 2)
            ),
            "at theta5 = pi/2, all others 0, the hand is turned by a right angle about z",
            r"$R = R_z(\theta_1 + \theta_5)$: the hand stays level and turns about the vertical",
            Identity(R, rotation("z", arm.thetas[0] + theta5)),
        ),
    )
    claim(
        "ground frame",
        "“The coupler of the lower one is the “ground frame” of the upper one.”",
        Undecidable("taken from a drawing, Fig. 3; the derivation starts from it"),
    )
    claim = partial(d.claim, where="III. Modeling")
    free, reach, lift = symbols("turn", 1), symbols("a", 1), real("lift")
    scara = sp.prod(
        homogeneous(rotation("z", angle), rotation("z", angle) * sp.Matrix([length, 0, h]))
        for angle, length, h in zip(free, reach, (0, 0, lift), strict=True)
    )
    claim(
        "not an open chain",
        "“this robot is not an open-chain system because a rotation of the end-effector is "
        "confined”",
        Refuted(
            Identity(scara[:3, 2], z),
            "a SCARA arm is an open chain with three vertical axes and a vertical slide, and its "
            "hand also stays level",
            "it is not an open chain because its links close two loops: the arm has eight joints "
            "between seven bodies, and an open chain has six",
            Enumeration(2, loops_of_the_arm, "independent loops"),
        ),
    )
    claim(
        "four motors",
        "“Note that there are four motor-driven joints in this robot.”",
        Enumeration(
            4,
            lambda: arm.J_space.subs(dict.fromkeys(arm.actuated, 0)).rank(),
            "independent twists at home",
        ),
    )
    claim(
        "axes 1 and 5",
        "“Since the axis 1 and 5 are only rotating along the z axis, so they can be ignored "
        "temporarily.”",
        Identity(
            sp.Matrix.hstack(arm.moved[0][3:, :], arm.moved[4][3:, :]), sp.Matrix.hstack(z, z)
        ),
    )
    claim(
        "rotation along X",
        "“Due to the existing double four-bar mechanism, the axis 2 and 3 can not affect the "
        "rotation of the end-effector along the X axis.”",
        Identity([*R.diff(theta2), *R.diff(theta3)], [0] * 18),
    )
    claim(
        "joint 4",
        "“It is noticed that the join 4 is not driven by any motor. However, it can rotate a "
        "special angle to make the end-effector keep horizontal due to the parallel mechanism.”",
        Count(list(arm.free[:3, :3] * z - z), (theta4,), 1),
    )
    claim(
        "virtual constraint",
        r"“this virtual motor always rotates the same amount of the angle as the summation of "
        r"rotation angles of the joint 2 and joint 3 but in an opposite direction, i.e., "
        r"$\theta_4 = -(\theta_2 + \theta_3)$”",
        Under(
            Every(
                {
                    "two parallelograms": Identity(bracket - theta2 - theta3, -(theta2 + theta3)),
                    "it keeps the hand level": Identity(arm.couple(arm.free)[:3, 2], z),
                    "assemblies of the lower loop": Count(
                        arm.lower.equations, tuple(arm.lower.solution), 2
                    ),
                    "assemblies of the upper loop": Count(upper, tuple(arm.upper.solution), 2),
                }
            ),
            "both loops are assembled as parallelograms; each has one other assembly, the "
            "antiparallelogram, which it can enter when it is flat",
        ),
    )
    across = sp.Matrix([-cos(arm.thetas[0]), -sin(arm.thetas[0]), 0])
    claim(
        "axis X",
        "“the virtual motor can counteract the rotation that the motor 2 and motor 3 give along "
        "the axis X”",
        Refuted(
            Identity(arm.moved[1][3:, :].subs(arm.thetas[0], pi / 2), sp.Matrix([0, -1, 0])),
            "the axes turn with the turret; at theta1 = pi/2 the axis of joint 2 is along -y",
            r"the rotation is about $-(\cos\theta_1, \sin\theta_1, 0)$, the axis X of the turret",
            Identity(sp.Matrix.hstack(*(arm.moved[i][3:, :] for i in (1, 2, 3))),
                     sp.Matrix.hstack(*[across] * 3))
        )
    )  # fmt: skip
    claim(
        "equivalent open chain",
        "“Instead the robot mechanism is transformed to an equivalent open-chain loop with five "
        "axes as shown in Fig. 4.”",
        Every(
            {
                "axes of the chain": Enumeration(5, lambda: len(arm.moves), "joints"),
                "its wrist bracket turns like that of the loops": Identity(
                    arm.couple(arm.moves[1] * arm.moves[2] * arm.moves[3])[:3, :3],
                    rotation("x", -bracket),
                ),
            }
        ),
    )


def loops_of_the_arm() -> int:
    """The number of joints of the double parallelogram beyond those of a tree of its bodies."""
    joints = [
        ("turret", "lower arm"), ("turret", "lower rod"), ("plate", "lower arm"),
        ("plate", "lower rod"), ("lower arm", "upper arm"), ("plate", "upper rod"),
        ("bracket", "upper arm"), ("bracket", "upper rod"),
    ]  # fmt: skip
    bodies = {body for joint in joints for body in joint}
    return len(joints) - (len(bodies) - 1)


def verification(d: Derivation, arm: Palletiser) -> None:
    """Section V."""
    claim = partial(d.claim, where="V. Verification")
    offset, turn = symbols("h", 1), real("turn")
    mounted = arm.pose * homogeneous(rotation("z", turn), offset)
    at_home = dict.fromkeys(arm.actuated, 0)
    same = Identity(
        sp.Matrix.hstack(*(twist_of(mounted.diff(q) * inverse(mounted)) for q in arm.actuated)),
        arm.J_space,
    )
    claim(
        "checking the Jacobian",
        "“If we can check that the Jacobian matrix is correct, all the kinematics problems talked "
        "above can be verified.”",
        Refuted(
            Every(
                {
                    "a hand mounted elsewhere has the same spatial Jacobian": same,
                    "and another pose": Identity((mounted - arm.pose)[:3, 3].subs(at_home), offset),
                    "nor does the velocity of eq. (23) contain l2 and l5": Identity(
                        [e.diff(s) for e in arm.velocity for s in arm.lengths[1::3]], [0] * 6
                    ),
                }
            ),
            "a derivative does not determine constants: another initial pose has the same "
            "Jacobian, and the height z may be wrong by any constant",
            r"a correct spatial Jacobian verifies the pose up to $g_{st}(0)$",
            same,
        ),
    )
    claim(
        "omega5",
        r"“$\omega_5 = 0$ (because it has no effect on the $v_{q_5}^s$)”",
        Identity(arm.velocity.diff(arm.rates[3]), sp.zeros(3, 1)),
    )
    for label, printed, reason in (
        (
            "Fig. 7",
            "“From this comparison it is obvious to see that two groups of curves are almost the "
            "same, Fig. 7.”",
            "curves in a figure, without dimensions or numbers; the calculated curves are derived "
            "as a table, for the dimensions of public models",
        ),
        (
            "Fig. 8",
            "“Fig. 8 shows the subtle difference in the corresponding directions.”",
            "a figure",
        ),
        (
            "source of the errors",
            "“These little errors are identified from the modeling or calculation approximation in "
            "ADAMS® and MATLAB®.”",
            "no number of either program is printed",
        ),
        (
            "valid technique",
            "“Hence it is concluded that the new proposed technique is valid for the hybrid "
            "manipulator.”",
            "an inference from the curves of a single path in two figures",
        ),
    ):
        claim(label, printed, Undecidable(reason))


def values(d: Derivation) -> None:
    """Judgements of value."""
    d.claim(
        "challenging",
        "“solving these equations under the constraints is challenging for this double four-bar "
        "mechanism”",
        Undecidable("a judgement of value; a lemma gives both solutions of each loop"),
        where="III. Modeling",
    )
    d.claim(
        "simpler",
        "“The system can be changed into an equivalent open-chain mechanism with these "
        "assumptions, and then everything becomes simpler to calculate.”",
        Undecidable("a judgement of value"),
        where="Conclusions",
    )
    d.claim(
        "other mechanisms",
        "“It can also be widely extended to other hybrid mechanisms, especially more-than-one "
        "four-bar linkage.”",
        Undecidable("the paper names no other mechanism"),
        where="Conclusions",
    )
