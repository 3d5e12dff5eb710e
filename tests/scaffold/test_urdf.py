"""URDF files: the axes that are read, the choices of a chain, and what is refused."""

import re
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import sympy as sp
from places import ROOT

from closedform.cli.commands import main
from closedform.mechanics.arm import Serial, from_screws
from closedform.model.derivation import Derivation, Paper
from closedform.scaffold.chains.recognise import recognised
from closedform.scaffold.inputs.tables import Table, TableError
from closedform.scaffold.inputs.tree import Choice, meant_angle
from closedform.scaffold.inputs.urdf import read_urdf
from closedform.scaffold.new import new

ARMS = ROOT / "benchmarks" / "arms"
UR5 = """
<robot name="ur5">
  <link name="base"/>
  <joint name="pan" type="revolute">
    <parent link="base"/><child link="shoulder"/>
    <origin xyz="0 0 0.089159" rpy="0 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-6.28" upper="6.28" effort="1" velocity="1"/>
  </joint>
  <joint name="lift" type="revolute">
    <parent link="shoulder"/><child link="upper"/>
    <origin xyz="0 0.13585 0" rpy="0 1.570796325 0"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="elbow" type="revolute">
    <parent link="upper"/><child link="fore"/>
    <origin xyz="0 -0.1197 0.425" rpy="0 0 0"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="wrist-1" type="continuous">
    <parent link="fore"/><child link="w1"/>
    <origin xyz="0 0 0.39225" rpy="0 1.5708 0"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="wrist-2" type="revolute">
    <parent link="w1"/><child link="w2"/>
    <origin xyz="0 0.093 1e-17" rpy="0 0 0"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="wrist-3" type="revolute">
    <parent link="w2"/><child link="w3"/>
    <origin xyz="0 0 0.09465" rpy="0 0 0"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="flange" type="fixed">
    <parent link="w3"/><child link="tool0"/>
    <origin xyz="0 0.0823 0" rpy="0 0 1.570796325"/>
  </joint>
</robot>
"""


@pytest.fixture
def ur5(tmp_path: Path) -> Path:
    path = tmp_path / "ur5.urdf"
    path.write_text(UR5, "utf-8")
    return path


def numbers(element: ElementTree.Element | None, key: str, default: str) -> np.ndarray:
    text = default if element is None else element.get(key, default)
    return np.array([float(x) for x in text.split()])


def turned(axis: np.ndarray, angle: float) -> np.ndarray:
    """The rotation about an axis, by the exponential series."""
    K = np.cross(np.eye(3), axis / np.linalg.norm(axis)) * angle
    total = term = np.eye(3)
    for k in range(1, 40):
        term = term @ K / k
        total = total + term
    return total


def forward(text: str, q: np.ndarray) -> np.ndarray:
    """The pose of the last link by the definition of URDF, joint after joint, in floating point."""
    T, values = np.eye(4), iter(q)
    for joint in ElementTree.fromstring(text).findall("joint"):
        origin = joint.find("origin")
        r, p, y = numbers(origin, "rpy", "0 0 0")
        step = np.eye(4)
        step[:3, 3] = numbers(origin, "xyz", "0 0 0")
        step[:3, :3] = turned(np.eye(3)[2], y) @ turned(np.eye(3)[1], p) @ turned(np.eye(3)[0], r)
        T = T @ step
        if joint.get("type") != "fixed":
            move, axis = np.eye(4), numbers(joint.find("axis"), "xyz", "1 0 0")
            if joint.get("type") == "prismatic":
                move[:3, 3] = axis * next(values)
            else:
                move[:3, :3] = turned(axis, next(values))
            T = T @ move
    return T


def arm_of(path: Path, read: Callable[..., Table] = read_urdf, *choice: Choice) -> Serial:
    table = read(path, *choice)
    d = Derivation("arm", "Arm", Paper("p", "P", ("A",)), "An arm.")
    for name, given in table.parameters.items():
        value = sp.Rational(given["value"])
        d.parameter(name, value=value, unit="rad", meaning="an angle", nonnegative=False)
    for name, kind in table.joints.items():
        d.joint(name, kind)  # type: ignore[arg-type]
    return from_screws(d, table.axes, table.home, base=table.base)


def test_the_chain_has_the_pose_of_the_file(ur5: Path) -> None:
    arm = arm_of(ur5)
    pose = sp.lambdify(arm.joints, arm.pose, "numpy")
    for q in np.random.default_rng(0).uniform(-3, 3, (20, 6)):
        # 1.5708 stands for pi/2, which moves the tool by up to 4e-6
        np.testing.assert_allclose(pose(*q), forward(UR5, q), atol=2e-5)


def test_joints_in_any_direction_and_slides(tmp_path: Path) -> None:
    text = """<robot name="r"><link name="a"/>
    <joint name="q1" type="revolute"><parent link="a"/><child link="b"/>
      <origin xyz="0.1 -0.2 0.3" rpy="0.5235987755982988 0 0"/><axis xyz="0 0.6 0.8"/></joint>
    <joint name="q2" type="prismatic"><parent link="b"/><child link="c"/>
      <origin xyz="0 0.25 0" rpy="0 -0.7853981633974483 3.141592653589793"/><axis xyz="0 0 2"/>
    </joint></robot>"""
    path = tmp_path / "r.urdf"
    path.write_text(text, "utf-8")
    arm = arm_of(path)
    pose = sp.lambdify(arm.joints, arm.pose, "numpy")
    unit = text.replace("0 0 2", "0 0 1")  # the axis is a direction; a slide moves by its unit
    for q in np.random.default_rng(1).uniform(-2, 2, (10, 2)):
        np.testing.assert_allclose(pose(*q), forward(unit, q), atol=1e-12)


# A Piper by AgileX: frames of links are turned about their own axes, by 0.1359 and -1.7939.
PIPER = """<robot name="piper">
  <joint name="joint1" type="revolute"><parent link="a"/><child link="b"/>
    <origin xyz="0 0 0.123" rpy="0 0 0"/><axis xyz="0 0 1"/></joint>
  <joint name="joint2" type="revolute"><parent link="b"/><child link="c"/>
    <origin xyz="0 0 0" rpy="1.5707963267948966 -0.1359 -3.141592653589793"/>
    <axis xyz="0 0 1"/></joint>
  <joint name="joint3" type="revolute"><parent link="c"/><child link="d"/>
    <origin xyz="0.28503 0 0" rpy="0 0 -1.7939"/><axis xyz="0 0 1"/></joint>
  <joint name="joint4" type="revolute"><parent link="d"/><child link="e"/>
    <origin xyz="-0.021984 -0.25075 0" rpy="1.5707963267948966 0 0"/><axis xyz="0 0 1"/></joint>
  <joint name="joint5" type="revolute"><parent link="e"/><child link="f"/>
    <origin xyz="0 0 0" rpy="-1.5707963267948966 0 0"/><axis xyz="0 0 1"/></joint>
  <joint name="joint6" type="revolute"><parent link="f"/><child link="g"/>
    <origin xyz="0 -0.091 0" rpy="1.5707963267948966 0 0"/><axis xyz="0 0 1"/></joint>
</robot>"""


def test_frames_turned_by_any_angle_keep_their_axes(tmp_path: Path) -> None:
    """Sines of an angle are not rounded decimals; turns of joints about their axes are offsets."""
    path = tmp_path / "piper.urdf"
    path.write_text(PIPER, "utf-8")
    table = read_urdf(path)
    assert not any("rounded" in note for note in table.notes)
    values = {name: float(sp.Rational(given["value"])) for name, given in table.parameters.items()}
    assert sorted(values.values()) == [0.1359, 1.7939]
    assert not {s for _, w, p in table.axes for e in (*w, *p) for s in e.free_symbols}
    arm = arm_of(path)
    assert "axes 4, 5 and 6 meet in a point" in recognised(arm)
    pose = arm.pose.subs({s: values[str(s)] for s in arm.pose.free_symbols if str(s) in values})
    moved = sp.lambdify(arm.joints, pose, "numpy")
    for q in np.random.default_rng(2).uniform(-3, 3, (10, 6)):
        np.testing.assert_allclose(moved(*q), forward(PIPER, q), atol=1e-12)


def test_what_an_exporter_added_to_lengths_and_axes_is_dropped(ur5: Path) -> None:
    """Sums in binary, and a frame that was turned by 1.5708 instead of pi/2."""
    exact = arm_of(ur5)
    noisy = UR5.replace("0.13585", "0.13585000000000003").replace("0.093 ", "0.0930000000004 ")
    noisy = noisy.replace('"0 0 0.39225"', '"1.568e-06 0 0.39225"')
    noisy = noisy.replace('xyz="0 0 1"', 'xyz="0 -3.673e-06 0.99999999999325"')
    ur5.write_text(noisy, "utf-8")
    assert arm_of(ur5).pose == exact.pose
    notes = "\n".join(new("noisy", "urdf", ur5).notes)
    assert "0.13585" not in notes and "0.093" not in notes  # a page of notes said so
    for part in (
        "xyz 1.568e-06 is taken for 0",
        "the axis (0, -3.673e-06, 0.999999999993) is taken for (0, 0, 1)",
    ):
        assert part in notes


def test_axes_that_a_rounded_right_angle_turned_are_straight() -> None:
    """A file in which rpy="1.571 0 0" was multiplied out, into axes and short lengths."""
    path = ARMS / "m0609.urdf"
    script = new("m0609", "urdf", path, choice=Choice(ignore=8.4e-5))
    assert "an inverse with 8 branches is proposed" in script.inverse
    assert any("is taken for (0, 1, 0)" in note for note in script.notes)


@pytest.mark.parametrize("length", ["0.089159", "0.089159001", "0.00002", "-0.1234567"])
def test_a_length_that_may_be_meant_is_kept(ur5: Path, length: str) -> None:
    ur5.write_text(UR5.replace("0.089159", length), "utf-8")
    assert read_urdf(ur5).axes[1][2][2] == sp.Rational(length)


def test_an_angle_with_many_digits_is_not_worth_a_note(ur5: Path) -> None:
    """Files of ROS write pi/2 with six digits or more at each joint: a page of notes said so."""
    given = UR5.replace("1.5708", "1.570796")
    assert given != UR5
    ur5.write_text(given, "utf-8")
    table = read_urdf(ur5)
    assert not [note for note in table.notes if "the angle" in note]
    assert all(not e.has(sp.sin, sp.cos) for _, w, at in table.axes for e in (*w, *at))


def test_what_was_not_taken_literally_is_said(ur5: Path) -> None:
    script = new("my_ur5", "urdf", ur5)
    notes = "\n".join(script.notes)
    for part in (
        "1.5708 is taken for pi/2",
        "joint 'wrist-1': it is called wrist_1",
        "from base to tool0",
    ):
        assert part in notes
        assert part in " ".join(script.text.split()).replace("# ", "")
    assert "1e-17" not in notes
    assert 'pan = d.joint("pan", limits=(Rational("-6.28"), Rational("6.28")))' in script.text
    assert 'lift = d.joint("lift")' in script.text
    assert "an inverse with 8 branches is proposed" in script.inverse
    assert max(len(line) for line in script.text.splitlines() if line.startswith("#")) <= 100


TAKEN = re.compile(
    r"other numbers moves the tool by at most (\S+), and turns it by at most (\S+) rad"
)


@pytest.mark.parametrize("name", ["nero", "aubo_i16", "xarm7", "x5"])
def test_how_far_what_was_taken_for_other_numbers_moves_the_tool(name: str) -> None:
    """1.5708 for pi/2, 3.1415 for pi, 0 for 3.7e-6 in an axis: as much as in the worst posture."""
    path = ARMS / f"{name}.urdf"
    (said,) = (m for note in read_urdf(path).notes if (m := TAKEN.search(note)))
    moved, turned = map(float, said.groups())
    arm = arm_of(path)
    pose = sp.lambdify(arm.joints, arm.pose, "numpy")
    away = []
    for q in np.random.default_rng(3).uniform(-3, 3, (300, len(arm.joints))):
        there, here = forward(path.read_text("utf-8"), q), pose(*q)
        R = np.linalg.norm(there[:3, :3] - here[:3, :3]) / np.sqrt(2)
        away.append((np.linalg.norm(there[:3, 3] - here[:3, 3]), R))
    most = np.max(away, axis=0)
    assert moved / 6 < most[0] <= moved and turned / 6 < most[1] <= turned


def test_a_file_that_is_taken_literally_moves_nothing() -> None:
    assert not any("other numbers" in note for note in read_urdf(ARMS / "hc10.urdf").notes)


def test_lengths_in_millimetres_are_pointed_out(ur5: Path) -> None:
    assert not any("millimetres" in note for note in read_urdf(ur5).notes)
    ur5.write_text(edited("0.425", "425"), "utf-8")
    assert any("is 425 m from the origin" in note for note in read_urdf(ur5).notes)


def test_notes_are_those_of_the_chain(ur5: Path) -> None:
    """A camera beside it has a rounded angle too."""
    camera = """<joint name="camera" type="fixed"><parent link="base"/><child link="eye"/>
                <origin xyz="0 0 1e-12" rpy="0 1.57079 0"/></joint>"""
    plain = read_urdf(ur5, Choice("base", "w1")).notes
    ur5.write_text(UR5.replace("</robot>", f"{camera}</robot>"), "utf-8")
    assert read_urdf(ur5, Choice("base", "w1")).notes == plain


def test_a_prefix_that_is_not_declared_is_read(ur5: Path) -> None:
    """Parts for Gazebo of older files have some."""
    plain = read_urdf(ur5).axes
    part = '<gazebo><sensor:camera name="eye"><rate>20</rate></sensor:camera></gazebo></robot>'
    ur5.write_text(UR5.replace("</robot>", part), "utf-8")
    assert read_urdf(ur5).axes == plain


def test_base_and_tool_choose_the_chain(ur5: Path) -> None:
    table = read_urdf(ur5, Choice("shoulder", "w1"))
    assert list(table.joints) == ["lift", "elbow", "wrist_1"]
    assert sp.Matrix(table.axes[0][2]) == sp.Matrix([0, sp.Rational("0.13585"), 0])


def test_the_command(ur5: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "my_ur5", "--from", "urdf", str(ur5), "-o", str(tmp_path)]) == 0
    assert (tmp_path / "my_ur5.py").is_file()
    found = capsys.readouterr()
    assert "8 branches" in found.out and "taken for pi/2" in found.err
    assert main(["new", "b", "--from", "dh", str(ur5), "--tool", "w1"]) == 2
    assert "--tool, --ignore and --hold are for a URDF or MJCF file" in capsys.readouterr().err


def test_a_tilted_mount_stays_apart_from_the_arm(ur5: Path) -> None:
    """Arms of humanoids: the tilt is in the base alone, and the axes are those of a level arm."""
    level = read_urdf(ur5, Choice("base"))
    tilted = UR5.replace(
        'xyz="0 0 0.089159" rpy="0 0 0"', 'xyz="0 0.1 0.9" rpy="-2.0679 0 -1.2217"'
    )
    ur5.write_text(tilted, "utf-8")
    table = read_urdf(ur5)
    assert [w for _, w, _ in table.axes] == [w for _, w, _ in level.axes]
    assert not {s for _, w, p in table.axes for e in (*w, *p) for s in e.free_symbols}
    values = {sp.Symbol(n, real=True): float(sp.Rational(p["value"])) for n, p in
              table.parameters.items()}  # fmt: skip
    d = Derivation("arm", "Arm", Paper("p", "P", ("A",)), "An arm.")
    for name in table.parameters:
        d.parameter(name, value=1, unit="rad", meaning="tilt", nonnegative=False)
    for name, kind in table.joints.items():
        d.joint(name, kind)  # type: ignore[arg-type]
    arm = from_screws(d, table.axes, table.home, base=table.base)
    assert sp.prod(arm.moves).free_symbols == arm.pose.free_symbols
    for pose in (arm.pose, sp.prod(arm.moves)):
        at = sp.lambdify(arm.joints, pose.xreplace(values), "numpy")
        for q in np.random.default_rng(2).uniform(-3, 3, (5, 6)):
            np.testing.assert_allclose(at(*q), forward(tilted, q), atol=2e-5)


@pytest.mark.parametrize(
    ("written", "meant"), [("3.14", "pi"), ("-1.57", "-pi/2"), ("0.26", "0.26"), ("3.1", "3.1")]
)
def test_right_angles_may_have_two_decimals(written: str, meant: str) -> None:
    notes: list[str] = []
    found = meant_angle(sp.Rational(written), "here", notes)
    assert found == sp.nsimplify(meant, rational=True) and len(notes) == ("pi" in meant)


def test_short_lengths_are_named_and_left_out_if_wanted(
    ur5: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Axes that pass each other by little, as in files of calibrated or exported arms."""
    drifted = UR5.replace('xyz="0 0 0.09465"', 'xyz="0.0003 0 0.09465"')
    drifted = drifted.replace('xyz="0 0.0823 0"', 'xyz="0 0.0823 -0.0004"')
    ur5.write_text(drifted, "utf-8")
    command = ["new", "drifted", "--from", "urdf", str(ur5), "-o"]
    assert main([*command, str(tmp_path)]) == 0
    said = capsys.readouterr()
    assert "no inverse" in said.out and "lengths such as 0.0004, of the joint flange" in said.err
    assert "--ignore 0.0004" in said.err
    assert main([*command, str(tmp_path / "near"), "--ignore", "0.0004"]) == 0
    said = capsys.readouterr()
    assert "8 branches" in said.out and "at most 0.0007 from where the file has it" in said.err
    arm = arm_of(ur5, read_urdf, Choice(ignore=0.0004))
    pose = sp.lambdify(arm.joints, arm.pose, "numpy")
    for q in np.random.default_rng(1).uniform(-3, 3, (20, 6)):
        away = pose(*q) - forward(drifted, q)
        assert 5e-5 < np.linalg.norm(away[:3, 3]) < 0.0007 + 2e-5
        np.testing.assert_allclose(away[:3, :3], 0, atol=2e-5)


def edited(old: str, new: str) -> str:
    assert old in UR5
    return UR5.replace(old, new)


CIRCLE = (
    "<robot>"
    + "".join(
        f'<joint name="{n}" type="revolute"><parent link="{p}"/><child link="{c}"/></joint>'
        for n, p, c in (("one", "a", "b"), ("two", "b", "a"))
    )
    + "</robot>"
)
BRANCHED = UR5.replace(
    "</robot>",
    '<joint name="finger" type="prismatic"><parent link="w3"/><child link="finger"/></joint>'
    '<joint name="thumb" type="prismatic"><parent link="w3"/><child link="thumb"/></joint></robot>',
)


def test_an_expanded_file_may_mention_macros_in_its_comments(ur5: Path) -> None:
    mentioned = '<robot xmlns:xacro="http://w" name="ur5"><!-- <xacro:arg name="x"/> -->'
    ur5.write_text(UR5.replace('<robot name="ur5">', mentioned), "utf-8")
    assert len(read_urdf(ur5).joints) == 6


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<robot", "is not valid XML"),
        ("<mujoco/>", "the file is not URDF"),
        ('<!DOCTYPE r [<!ENTITY a "b">]><robot/>', "are not read"),
        ('<robot xmlns:xacro="http://w"><xacro:arg/></robot>', "expand it first: xacro ur5.urdf"),
        ("<robot/>", "there are no joints"),
        (edited("0.425", "0.4x25"), "joint elbow: xyz"),
        (edited("0.425", ""), "xyz needs three numbers"),
        (edited("0.425", "1e999999"), "joint elbow: xyz"),
        (edited('<axis xyz="0 0 1"/>', '<axis xyz="0 0 0"/>'), "pan: its axis is zero; write its"),
        (edited('<parent link="fore"/>', ""), "no parent link; write <parent link="),
        (edited('"continuous"', '"planar"'), "a planar joint has no closed form"),
        (edited('"continuous"', '"hinge"'), "not know; a joint is revolute, "),
        (edited('<child link="w1"/>', '<child link="w1"/><mimic joint="pan"/>'), "it mimics pan"),
        (edited('<child link="w1"/>', '<child link="shoulder"/>'), "has two parents"),
        (BRANCHED, "choose one with --tool: finger, thumb"),
        (CIRCLE, "the links form a circle; closed loops are written with --from loop"),
    ],
)
def test_what_cannot_be_read_is_explained(text: str, message: str, ur5: Path) -> None:
    ur5.write_text(text, "utf-8")
    with pytest.raises(TableError) as caught:
        read_urdf(ur5)
    assert message in str(caught.value)


def test_links_that_are_not_there_are_named(ur5: Path) -> None:
    with pytest.raises(TableError, match="there is no link wrist for the tool; the links"):
        read_urdf(ur5, Choice(tool="wrist"))
    with pytest.raises(TableError, match="w1 is not carried by tool0; its root is base"):
        read_urdf(ur5, Choice("tool0", "w1"))


def joint(name: str, parent: str, child: str, place: str, axis: str, *, more: str = "") -> str:
    return (
        f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{place}"/><axis xyz="{axis}"/>{more}</joint>'
    )


MIMIC = '<mimic joint="lower" multiplier="{}"/>'
PALLETISER = "<robot>" + "".join(
    [
        joint("turn", "base", "column", "0 0 0.4", "0 0 1"),
        joint("lower", "column", "arm", "0.1 0 0", "0 1 0"),
        joint("level", "arm", "elbow", "0 0 0.5", "0 1 0", more=MIMIC.format(-1)),
        joint("upper", "elbow", "forearm", "0 0 0", "0 -1 0"),
        '<joint name="end" type="fixed"><parent link="forearm"/><child link="tool"/>'
        '<origin xyz="0.6 0 0"/></joint></robot>',
    ]
)
"""A parallelogram keeps the elbow level, and a second motor turns the forearm."""


def test_a_joint_that_mimics_another_is_a_coupling(tmp_path: Path) -> None:
    """The joints that follow from motors have the pose that the file has, joint by joint."""
    path = tmp_path / "palletiser.urdf"
    path.write_text(PALLETISER, "utf-8")
    table = read_urdf(path)
    assert list(table.joints) == ["turn_0", "lower", "upper"]  # a script uses turn itself
    assert str(table.couplings["upper"]) == "m_lower + m_upper"
    serial = arm_of(path, read_urdf)
    pose = sp.lambdify(serial.joints, serial.pose, "numpy")
    for turn, lower, upper in np.random.default_rng(2).uniform(-3, 3, (20, 3)):
        there = forward(PALLETISER, np.array([turn, lower, -lower, upper]))
        np.testing.assert_allclose(pose(turn, lower, lower + upper), there, atol=1e-14)
    assert "4 branches" in new("palletiser", "urdf", path).inverse


def test_a_hand_that_is_kept_level_by_mimic_joints_is_led_to_its_table(tmp_path: Path) -> None:
    path = tmp_path / "palletiser.urdf"
    level = joint("hand", "forearm", "tool", "0.6 0 0", "0 1 0", more=MIMIC.format(-1))
    path.write_text(
        PALLETISER[: PALLETISER.index('<joint name="end"')] + level + "</robot>", "utf-8"
    )
    with pytest.raises(TableError, match="from the wrist to the hand in the row of the turret"):
        read_urdf(path)


def test_a_joint_that_mimics_another_may_have_an_offset(tmp_path: Path) -> None:
    text = PALLETISER.replace('multiplier="-1"', 'multiplier="-1" offset="0.7853982"')
    path = tmp_path / "palletiser.urdf"
    path.write_text(text, "utf-8")
    serial = arm_of(path, read_urdf)
    pose = sp.lambdify(serial.joints, serial.pose, "numpy")
    for turn, lower, upper in np.random.default_rng(2).uniform(-3, 3, (5, 3)):
        there = forward(text, np.array([turn, lower, np.pi / 4 - lower, upper]))
        np.testing.assert_allclose(pose(turn, lower, lower + upper), there, atol=1e-12)


LIMITED = '<limit lower="0" upper="0.2"/>'


def slide(name: str, parent: str, child: str, place: str, axis: str, *, more: str) -> str:
    return joint(name, parent, child, place, axis, more=more).replace("revolute", "prismatic")


LIFT = "<robot>" + "".join(
    [
        slide("outer", "base", "mast", "0 0 0.3", "0 0 1", more=LIMITED),
        joint("turn1", "mast", "column", "0 0 0.1", "0 0 1"),
        slide("inner", "column", "head", "0.02 0 0", "0 0 -1", more=MIMIC.format(-0.5)),
        joint("swing", "head", "arm", "0.1 0 0", "0 0 1"),
        slide("reach", "arm", "beam", "0.4 0 0", "1 0 0", more=LIMITED),
        slide("tip", "beam", "hand", "0.1 0 0.05", "1 0 0", more="{}"),
        joint("grip", "hand", "finger", "0 0 0", "0 1 0"),
        joint("grip2", "hand", "thumb", "0 0 0", "0 1 0", more='<mimic joint="grip"/>'),
        "</robot>",
    ]
).replace('"lower" multiplier', '"outer" multiplier')
"""Two stages of a lift with a joint between them, and a beam whose tip moves with it."""


def test_slides_that_mimic_others_are_columns(tmp_path: Path) -> None:
    """Fingers beyond the tool that mimic each other do not matter."""
    text = LIFT.format('<mimic joint="reach" multiplier="1.5" offset="0.03"/>')
    path = tmp_path / "lift.urdf"
    path.write_text(text, "utf-8")
    table = read_urdf(path, Choice(tool="hand"))
    assert list(table.joints) == ["outer", "turn1_0", "swing", "reach"]
    assert {q: str(e) for q, e in table.couplings.items()} == {
        "outer": "3*m_outer/2",
        "reach": "5*m_reach/2",
    }
    assert table.limits["outer"] == ("0", "3/10") and table.limits["reach"] == ("0", "1/2")
    serial = arm_of(path, read_urdf, Choice(tool="hand"))
    pose = sp.lambdify(serial.joints, serial.pose, "numpy")
    without = text.replace('<joint name="grip" type="revolute"', '<joint name="grip" type="fixed"')
    for outer, turn, swing, reach in np.random.default_rng(2).uniform(-1, 1, (5, 4)):
        file = [outer, turn, -0.5 * outer, swing, reach, 1.5 * reach + 0.03, 0]
        there = forward(without.split('<joint name="grip"')[0] + "</robot>", np.array(file[:6]))
        moved = pose(1.5 * outer, turn, swing, 2.5 * reach)
        np.testing.assert_allclose(moved, there, atol=1e-14)


def test_the_joints_of_a_chain_may_follow_a_joint_beside_it(tmp_path: Path) -> None:
    path = tmp_path / "lift.urdf"
    text = LIFT.format('<mimic joint="grip" multiplier="0.01"/>')
    path.write_text(text.replace(LIMITED, '<mimic joint="grip" multiplier="0.02"/>', 2), "utf-8")
    table = read_urdf(path, Choice("arm", "hand"))
    assert {q: str(e) for q, e in table.couplings.items()} == {"reach": "3*m_reach/2"}
    said = "reach: it mimics grip and grip is not on the chain"
    assert any(said in note for note in table.notes)


def test_names_of_joints_that_are_words_of_python_are_changed(tmp_path: Path) -> None:
    path = tmp_path / "palletiser.urdf"
    path.write_text(PALLETISER.replace('"upper"', '"raise"'), "utf-8")
    assert "4 branches" in new("palletiser", "urdf", path).inverse


FINGER = (
    "<robot>"
    + joint("base", "palm", "first", "0 0 0.05", "0 1 0")
    + joint("middle", "first", "second", "0 0 0.04", "0 1 0", more='<mimic joint="base"/>')
    + joint("end", "second", "pad", "0 0 0.03", "{}", more='<mimic joint="base"/>')
    + "</robot>"
)
TIPS = {
    "0 1 0": "joints middle and end follow the motor of base about axes parallel to its own, as in "
    "a finger.  The tip turns by 3 times the angle of the motor, and no lemma divides",
    "0 -1 0": "The tip turns as the motor does, but an arm needs a motor for each joint, so",
    "1 0 0": "the motor of base turns the arm about two axes at once",
}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (PALLETISER.replace('multiplier="-1"', 'multiplier="0.5"'), "by a whole multiple"),
        (PALLETISER.replace('joint="lower"', 'joint="level"'), "which follows it in turn"),
        (PALLETISER.replace('multiplier="-1"', 'multiplier="0"'), "zero times"),
        (PALLETISER.replace('"-1"', '"x"'), "joint level: multiplier"),
        (PALLETISER.replace("0 0 0.5", "0 0.1 0.5").replace('"0 0 0"', '"0.1 0 0"'), "neighbour"),
        (PALLETISER.replace('joint="lower"', 'joint="other"'), "the file has no such joint"),
        (
            PALLETISER.replace('multiplier="-1"', 'multiplier="0.5"'),
            "by 1/2 times the angle, which is not a whole multiple",
        ),
        (
            PALLETISER.replace('"0 0 0.5"/><axis xyz="0 1 0"', '"0 0 0.5"/><axis xyz="1 0 0"'),
            "the motor of lower turns the arm about two axes at once, and no lemma solves",
        ),
        (
            "<robot>"
            + joint("one", "base", "arm", "0 0 0.4", "0 0 1")
            + joint("two", "arm", "hand", "0 0 0", "0 0 1", more='<mimic joint="one"/>')
            + joint("three", "hand", "tool", "0.3 0 0", "0 1 0")
            + "</robot>",
            "both turn about one axis, by 2 times the angle of the motor, of which the pose of the "
            "tool determines only the fraction of a turn",
        ),
        (
            "<robot>"
            + joint("one", "base", "arm", "0 0 0.4", "0 0 1")
            + slide("two", "arm", "tool", "0 0 0", "1 0 0", more='<mimic joint="one"/>')
            + "</robot>",
            "one of the two turns and the other slides, so that their inverse is not algebraic",
        ),
        *((FINGER.format(tip), told) for tip, told in TIPS.items()),
    ],
)
def test_other_joints_that_mimic_are_refused(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "palletiser.urdf"
    path.write_text(text, "utf-8")
    with pytest.raises(TableError, match=message):
        read_urdf(path)


def test_angles_in_degrees_are_told_of(tmp_path: Path) -> None:
    """A tool turned by 90 degrees got the parameter angle1 = 90 rad, and limits were taken so."""
    path = tmp_path / "arm.urdf"
    path.write_text(UR5.replace('rpy="0 0 0"', 'rpy="0 90 0"', 1), "utf-8")
    with pytest.raises(TableError, match="rpy has 90, and angles of URDF are in radians; write "):
        read_urdf(path)
    limited = '<limit lower="0" upper="120" effort="1" velocity="1"/>'
    text = "<robot>" + joint("one", "base", "arm", "0 0 0.4", "0 0 1", more=limited)
    path.write_text(text + joint("two", "arm", "hand", "0.3 0 0", "0 0 1") + "</robot>", "utf-8")
    notes = "\n".join(read_urdf(path).notes)
    assert "joint one: its limits 0 and 120 are in radians; if degrees are meant" in notes
