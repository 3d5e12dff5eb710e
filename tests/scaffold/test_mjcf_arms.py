"""MJCF models of known arms: their poses by a reading of the XML, and what is proposed for them.

The models have the bodies and joints of public ones, without their shapes.
"""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import sympy as sp
from places import TESTS
from test_urdf import arm_of, turned

from closedform.scaffold.inputs.mjcf import read_mjcf
from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.inputs.tree import Choice
from closedform.scaffold.new import new

pytest.importorskip("mujoco", reason="MuJoCo is not installed")

MODELS = TESTS / "mjcf"
UR = "turret, three parallel joints and two more (UR)"
TURRET = "turret and two parallel joints, with a spherical wrist"
ARMS = {
    "panda": (Choice(tool="hand"), 1e-7, "8 branches", "with joint7 given"),
    "panda_scene": (Choice(base="link0", tool="hand"), 1e-7, "8 branches", "with joint7 given"),
    "ur5e": (Choice(tool="attachment_site"), 1e-9, "8 branches", UR),
    "so_arm": (Choice(tool="Fixed_Jaw"), 2.4e-5, "4 branches", "2 joints that turn the tool"),
    "vx300s": (Choice(tool="pinch"), 1e-9, "8 branches", TURRET),
    "z1": (Choice(), 1e-9, "8 branches", UR),
    "iiwa14": (Choice(tool="attachment_site"), 1e-9, "8 branches", "with joint3 given"),
    "degrees": (Choice(tool="tool"), 1e-9, "8 branches", UR),
}
FOLLOWING = {
    "joint_arm_l2": "joint_arm_l3",
    "joint_arm_l1": "joint_arm_l3",
    "joint_arm_l0": "joint_arm_l3",
}


class Model:
    """An MJCF file as plain XML: includes, defaults of classes, and the poses of its bodies."""

    def __init__(self, path: Path) -> None:
        root = ElementTree.parse(path).getroot()
        for part in root.findall("include"):
            root.extend(ElementTree.parse(path.parent / part.attrib["file"]).getroot())
        self.root = root
        settings: dict[str, str] = {}
        for compiler in root.findall("compiler"):
            settings |= compiler.attrib
        self.unit = 1.0 if settings.get("angle") == "radian" else np.pi / 180
        self.sequence = settings.get("eulerseq", "xyz")
        self.classes: dict[str, dict[str, str]] = {"main": {}}
        for default in root.findall("default"):
            self.declare(default, {}, default.get("class", "main"))

    def declare(self, default: ElementTree.Element, above: dict[str, str], name: str) -> None:
        joint = default.find("joint")
        self.classes[name] = above | ({} if joint is None else joint.attrib)
        for below in default.findall("default"):
            self.declare(below, self.classes[name], below.attrib["class"])

    def place(self, element: ElementTree.Element) -> np.ndarray:
        T = np.eye(4)
        T[:3, 3] = vector(element, "pos", "0 0 0")
        T[:3, :3] = self.rotation(element)
        return T

    def rotation(self, element: ElementTree.Element) -> np.ndarray:
        if "quat" in element.attrib:
            w, *v = vector(element, "quat", "") / np.linalg.norm(vector(element, "quat", ""))
            K = np.cross(np.eye(3), np.array(v))
            return np.eye(3) + 2 * w * K + 2 * K @ K
        if "axisangle" in element.attrib:
            *axis, angle = vector(element, "axisangle", "")
            return turned(np.array(axis), angle * self.unit)
        if "xyaxes" in element.attrib:
            x, y = vector(element, "xyaxes", "").reshape(2, 3)
            return np.column_stack([x, y, np.cross(x, y)])
        if "zaxis" in element.attrib:
            z = vector(element, "zaxis", "")
            axis = np.cross([0, 0, 1], z)
            return turned(axis, np.arctan2(np.linalg.norm(axis), z[2]))
        R = np.eye(3)
        for letter, angle in zip(self.sequence, vector(element, "euler", "0 0 0"), strict=True):
            axis = np.eye(3)["xyz".index(letter.lower())]
            step = turned(axis, angle * self.unit)
            R = R @ step if letter.islower() else step @ R
        return R

    def pose(self, end: str, values: dict[str, float], base: str = "") -> np.ndarray:
        """The pose of a body or site; a floating body is at its place in the file."""
        found: dict[str, np.ndarray] = {}

        def go(element: ElementTree.Element, T: np.ndarray, above: str) -> None:
            for child in element:
                kind = child.get("childclass", above)
                if child.tag not in ("body", "frame", "site"):
                    continue
                at = T @ self.place(child)
                for joint in child.findall("joint") if child.tag == "body" else []:
                    at = at @ self.motion(joint, kind, values)
                found[child.get("name", "")] = at
                go(child, at, kind)

        for world in self.root.findall("worldbody"):
            go(world, np.eye(4), "main")
        start = found[base] if base else np.eye(4)
        return np.linalg.inv(start) @ found[end]

    def motion(
        self, joint: ElementTree.Element, above: str, values: dict[str, float]
    ) -> np.ndarray:
        given = self.classes[joint.get("class", above)] | joint.attrib
        axis, pos = (np.array([float(x) for x in given.get(k, d).split()])
                     for k, d in (("axis", "0 0 1"), ("pos", "0 0 0")))  # fmt: skip
        q, T = values.get(given["name"], 0.0), np.eye(4)
        if given.get("type") == "slide":
            T[:3, 3] = q * axis / np.linalg.norm(axis)
            return T
        T[:3, :3] = turned(axis, q)
        T[:3, 3] = pos - T[:3, :3] @ pos
        return T


def vector(element: ElementTree.Element, key: str, default: str) -> np.ndarray:
    return np.array([float(x) for x in element.get(key, default).split()])


def end_of(choice: Choice) -> str:
    return choice.tool or "link06"


@pytest.mark.parametrize("name", ARMS)
def test_the_poses_are_those_of_the_xml(name: str) -> None:
    choice, tolerance, *_ = ARMS[name]
    arm = arm_of(MODELS / f"{name}.xml", read_mjcf, choice)
    pose = sp.lambdify(arm.joints, arm.pose, "numpy")
    model = Model(MODELS / f"{name}.xml")
    names = [s.name.removesuffix("_0") for s in arm.joints]
    for q in np.random.default_rng(1).uniform(-2, 2, (10, len(names))):
        there = model.pose(end_of(choice), dict(zip(names, q, strict=True)), choice.base)
        np.testing.assert_allclose(np.array(pose(*q), float), there, atol=tolerance)


@pytest.mark.parametrize("name", ARMS)
def test_an_inverse_is_proposed(name: str) -> None:
    choice, _, *said = ARMS[name]
    script = new("arm", "mjcf", MODELS / f"{name}.xml", choice=choice)
    assert all(words in script.inverse for words in said), script.inverse


def test_the_stages_of_a_telescope_are_one_slide() -> None:
    """Equalities tie three stages to the fourth, and limits are those of all together."""
    path, choice = MODELS / "stretch.xml", Choice("base_link", "link_gripper")
    table = read_mjcf(path, choice)
    assert list(table.joints) == ["joint_lift", "joint_arm_l3", "joint_wrist_yaw"]
    assert str(table.couplings["joint_arm_l3"]) == "4*m_joint_arm_l3"
    assert table.limits["joint_arm_l3"] == ("0", "13/25")
    arm = arm_of(path, read_mjcf, choice)
    pose = sp.lambdify(arm.joints, arm.pose, "numpy")
    model = Model(path)
    for lift, stage, yaw in np.random.default_rng(4).uniform(-1, 1, (10, 3)):
        values = {"joint_lift": lift, "joint_wrist_yaw": yaw, "joint_arm_l3": stage}
        values |= {follower: values[leader] for follower, leader in FOLLOWING.items()}
        there = model.pose("link_gripper", values, "base_link")
        np.testing.assert_allclose(pose(lift, 4 * stage, yaw), there, atol=1e-12)
    assert (
        "1 branch is proposed (2 slides and a yaw)" in new("a", "mjcf", path, choice=choice).inverse
    )


@pytest.mark.parametrize(
    ("name", "choice", "message"),
    [
        ("panda", Choice(), "; or hand, where they part, after the 7 joints joint1 to joint7"),
        (
            "vx300s",
            Choice(),
            "or gripper_link, where they part, after the 6 joints waist to wrist_",
        ),
        ("stretch", Choice(tool="link_gripper"), "a base after it, such as --base base_link"),
    ],
)
def test_what_to_choose_is_said(name: str, choice: Choice, message: str) -> None:
    with pytest.raises(TableError, match=message):
        read_mjcf(MODELS / f"{name}.xml", choice)


def test_a_jaw_and_sites_are_named() -> None:
    jaw = read_mjcf(MODELS / "so_arm.xml").doubt
    assert "If the last joint, Jaw, opens a hand" in jaw and "--tool Fixed_Jaw" in jaw
    assert "Jaw" not in read_mjcf(MODELS / "so_arm.xml", Choice(tool="Moving_Jaw")).doubt
    notes = read_mjcf(MODELS / "ur5e.xml").notes
    assert any("--tool: attachment_site" in note for note in notes)


def test_a_finger_without_the_other_has_a_motor_of_its_own() -> None:
    table = read_mjcf(MODELS / "panda.xml", Choice("hand", "left_finger"))
    assert list(table.joints) == ["finger_joint1"] and not table.couplings
    assert any("finger_joint2 is not on the chain" in note for note in table.notes)


TIED = """<mujoco><worldbody><body name="a"><joint name="one" type="slide"/>
<body name="b" pos="0 0 0.5"><joint name="two" type="slide"/></body></body></worldbody>
<equality><joint joint1="two" {}/></equality></mujoco>"""


@pytest.mark.parametrize(
    ("equation", "message"),
    [
        ('joint2="one" polycoef="0 1 0.5 0 0"', "a polynomial of one, of degree above 1"),
        ('polycoef="0.1 0 0 0 0"', "an equality holds it"),
        ('joint2="two"', "which follows it in turn"),
    ],
)
def test_other_equalities_are_refused(equation: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "tied.xml"
    path.write_text(TIED.format(equation), "utf-8")
    with pytest.raises(TableError, match=message):
        read_mjcf(path)


def test_an_inactive_equality_ties_nothing(tmp_path: Path) -> None:
    path = tmp_path / "tied.xml"
    path.write_text(TIED.format('joint2="one" active="false"'), "utf-8")
    assert list(read_mjcf(path).joints) == ["one", "two"]
