"""Machines with more joints than their tool has motions, of which some are held."""

from pathlib import Path

import numpy as np
import pytest
from arms import OK, SINGULAR, misses
from chains import printed
from test_urdf import forward

from closedform.cli.commands import main
from closedform.pipeline import scripts
from closedform.pipeline.trial import fault
from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.inputs.tree import Choice
from closedform.scaffold.new import InverseSearch, new

MACHINES = {
    "concrete_pump": [
        ("slew", "revolute", "0 0 3.8", "0 0 1"),
        ("b1", "revolute", "0.4 0 0.3", "0 -1 0"),
        ("b2", "revolute", "9.2 0.3 0", "0 1 0"),
        ("b3", "revolute", "8.1 -0.35 0", "0 -1 0"),
        ("b4", "revolute", "7.7 0.2 0", "0 1 0"),
        ("tip", "fixed", "6.6 0 0", ""),
    ],
    "log_loader": [
        ("slew", "revolute", "0 0 1.8", "0 0 1"),
        ("boom", "revolute", "0.2 0 0.4", "0 -1 0"),
        ("jib", "revolute", "3.2 0 0.1", "0 1 0"),
        ("ext", "prismatic", "1.5 0 -0.1", "1 0 0"),
        ("swing", "revolute", "0.9 0 0", "0 1 0"),
        ("sway", "revolute", "0 0 -0.2", "1 0 0"),
    ],
}
HELD = [("concrete_pump", "b1"), ("concrete_pump", "b4"), ("log_loader", "ext"),
        ("log_loader", "jib")]  # fmt: skip


def urdf(name: str, folder: Path, extra: str = "") -> Path:
    rows = "".join(
        f'<joint name="{joint}" type="{kind}"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f'<origin xyz="{xyz}"/>{f"<axis xyz={axis!r}/>" if axis else ""}</joint>'
        for k, (joint, kind, xyz, axis) in enumerate(MACHINES[name])
    )
    path = folder / f"{name}.urdf"
    path.write_text(f'<robot name="{name}">{rows}{extra}</robot>', "utf-8")
    return path


@pytest.mark.parametrize(("name", "joint"), HELD)
def test_a_joint_that_is_held_is_an_input(name: str, joint: str, tmp_path: Path) -> None:
    """Its value may be any, also that of a slide drawn in beyond the joint before it."""
    path = urdf(name, tmp_path)
    choice = Choice(hold={joint: "0.3"})
    script = new(name, "urdf", path, choice=choice, search=InverseSearch(fault=fault))
    assert "an inverse with" in script.inverse
    (tmp_path / f"{name}.py").write_text(script.text, "utf-8")
    (source,) = scripts.find([str(tmp_path / f"{name}.py")])
    module = printed(scripts.load(source), tmp_path / "printed")
    assert module.Parameters._fields == (joint,) and module.Parameters() == (0.3,)
    moving = [row[0] for row in MACHINES[name] if row[1] != "fixed"]
    q = np.random.default_rng(4).uniform(-3, 3, (300, len(moving)))
    T = np.array([forward(path.read_text("utf-8"), row) for row in q])
    others = [k for k, one in enumerate(moving) if one != joint]
    params = module.Parameters(q[:, moving.index(joint)])
    np.testing.assert_allclose(module.pose(q[:, others], params), T, atol=1e-13)
    answers, status = module.ik(T, params)
    assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
    again = module.Parameters(params[0][:, None])
    away, turned = misses(module.pose(answers, again), T, status)
    assert away < 1e-12 * 50 and turned < 1e-12
    turns = np.array([row[1] == "revolute" for row in MACHINES[name] if row[1] != "fixed"])[others]
    off = answers - q[:, None, others]
    gaps = np.abs(np.where(turns, np.angle(np.exp(1j * off)), off)).max(axis=-1)
    assert np.nanmin(gaps, axis=-1).max() < 1e-8


def test_the_message_for_such_a_machine_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = urdf("concrete_pump", tmp_path)
    command = ["new", "pump", "--from", "urdf", str(path), "-o", str(tmp_path)]
    assert main(command) == 1
    assert "of a URDF or MJCF file do so with --hold JOINT, such as --hold b1" in (
        capsys.readouterr().err
    )
    assert main([*command, "--hold", "b1=0.5"]) == 0
    told = capsys.readouterr()
    assert "the parameter b1, an input of all printed functions, is 0.5 rad by default" in told.err
    assert "an inverse with 2 branches" in told.out


@pytest.mark.parametrize(
    ("hold", "message"),
    [
        ({"b7": "0"}, "--hold b7: the chain has no such joint that moves; its joints are b1, b2"),
        ({"tip": "0"}, "--hold tip: the chain has no such joint that moves"),
        ({"b1": "much"}, "joint b1: --hold"),
        ({"b4": "0"}, "joint follower: it mimics b4; hold both, or neither"),
    ],
)
def test_what_cannot_be_held_is_named(hold: dict, message: str, tmp_path: Path) -> None:
    follower = (
        '<joint name="follower" type="revolute"><parent link="l6"/><child link="l7"/>'
        '<axis xyz="0 1 0"/><mimic joint="b4"/></joint>'
    )
    path = urdf("concrete_pump", tmp_path, follower)
    with pytest.raises(TableError, match=message):
        new("pump", "urdf", path, choice=Choice(hold=hold))


def test_the_stages_of_a_telescope_are_named(tmp_path: Path) -> None:
    """A mobile manipulator whose arm has four stages: only the lift was named, which is no help."""
    wrist = [
        ("yaw", "0.08 0 0", "0 0 1"),
        ("pitch", "0 0 -0.03", "0 1 0"),
        ("roll", "0 0 0", "1 0 0"),
    ]
    rows = [("lift", "prismatic", "0 0 0.2", "0 0 1")]
    rows += [(f"arm{k}", "prismatic", "0.01 0 0", "0 1 0") for k in (3, 2, 1, 0)]
    MACHINES["stretch"] = rows + [(name, "revolute", at, axis) for name, at, axis in wrist]
    path = urdf("stretch", tmp_path)
    script = new("stretch", "urdf", path)
    assert "joints arm3, arm2, arm1 and arm0 slide in one direction" in script.inverse
    assert "--hold arm2 --hold arm1 --hold arm0" in script.advice
    held = Choice(hold=dict.fromkeys(("arm2", "arm1", "arm0"), "0"))
    assert "an inverse with 2 branches" in new("stretch", "urdf", path, choice=held).inverse


RAIL = """\
joint, a, alpha, d, theta
rail, 0, {}, rail, pi/2
pan, 0.05, pi/2, 0.1, pan
lift, 0.4, 0, 0, lift
elbow, 0.35, 0, 0, elbow
bend, 0, pi/2, 0.1, bend
roll, 0, 0, 0.08, roll
"""


def test_an_arm_of_five_joints_on_a_leaning_rail_is_solved_if_it_is_held(tmp_path: Path) -> None:
    """It was said that no three axes are parallel; and that a held joint has to be renamed."""
    path = tmp_path / "arm.csv"
    leaning = RAIL.format("pi/3")
    path.write_text(leaning, "utf-8")
    script = new("arm", "dh", path)
    assert "axes 3, 4 and 5 are parallel, and joint 1 beside them slides" in script.inverse
    line = "# rail = 0.1 m: held"
    assert line in script.advice
    path.write_text(f"{leaning}{line}\n", "utf-8")
    assert "an inverse with 4 branches" in new("arm", "dh", path).inverse


def test_an_arm_of_five_joints_on_a_level_rail_is_solved(tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    path.write_text(RAIL.format("pi/2"), "utf-8")
    assert new("arm", "dh", path).structure == "a rail, a turret, three parallel joints and a roll"


SEVEN = """\
a, alpha, d, theta
0, 0, 0.5, waist
0, 0, 0.2, torso
0, pi/2, 0.3, shoulder
0.4, 0, 0, elbow
0.3, 0, 0.1, bend
0, pi/2, 0, tilt
0.1, 0, 0.2, roll
"""


def test_joints_of_seven_that_move_the_tool_in_five_ways_are_named(tmp_path: Path) -> None:
    """It was said that no joint leaves a spherical wrist, and that another one may be given."""
    path = tmp_path / "arm.csv"
    path.write_text(SEVEN, "utf-8")
    script = new("arm", "dh", path)
    told = "joints waist, torso and shoulder can move in two ways while the tool stands still"
    assert told in script.inverse and script.advice.startswith("Give values to two of them")
    held = "# waist = 0.1 rad: held\n# torso = 0.2 rad: held\n"
    path.write_text(held + SEVEN, "utf-8")
    assert "an inverse with" in new("arm", "dh", path).inverse
