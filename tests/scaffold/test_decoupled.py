"""Arms whose slides come before or after the joints that turn: gantries and machine tools."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, UNREACHABLE, misses
from chains import arm, printed, solved
from proposals import forward
from sympy import pi

from closedform.cli.commands import main
from closedform.emit.backends.latex.article import document
from closedform.emit.render import render
from closedform.proof.prove import Proof, prove
from closedform.scaffold.chains.chainlinks import singles
from closedform.scaffold.chains.decoupled import DecoupledMaker
from closedform.scaffold.chains.propose import NoChainError, propose
from closedform.scaffold.new import new

H = sp.Rational(1, 2)
GANTRY = [(0, pi / 2, None, pi / 2), (0, pi / 2, None, pi / 2), (0, 0, None, 0)]
APART = {
    "offset wrist": ([*GANTRY, (H, -pi / 2, 1), (1, pi / 2, H), (0, 0, 1)], "d1 d2 d3 t4 t5 t6"),
    "oblique wrist": ([*GANTRY, (H, pi / 3, 1), (1, pi / 3, H), (0, 0, 1)], "d1 d2 d3 t4 t5 t6"),
    "five axes": ([*GANTRY, (H, -pi / 2, 1), (1, 0, H)], "d1 d2 d3 t4 t5"),
    "slides at the tool": (
        [(H, -pi / 2, 1), (1, pi / 2, H), (0, 0, 1), *GANTRY], "t1 t2 t3 d4 d5 d6",
    ),
}  # fmt: skip


LEVEL = {
    "a yaw": ([(0, 0, 1)], "t1"),
    "2 slides and a yaw": (
        [(0, pi / 2, None, 0), (H, -pi / 2, None, 0), (0, 0, 1)], "d1 d2 t3",
    ),
    "3 slides and a yaw": (
        [*[(0, pi / 2, None, pi / 2)] * 3, (H, 0, 1)], "d1 d2 d3 t4",
    ),
}  # fmt: skip


@pytest.mark.parametrize("structure", LEVEL)
def test_slides_before_a_turn_of_the_level_tool(structure: str, tmp_path: Path) -> None:
    rows, joints = LEVEL[structure]
    d, serial = arm(rows, joints)
    found = propose(serial)
    assert found.structure == structure
    solved(d, serial, found.source)
    assert prove(d).inverses[0].branches == found.branches == 1
    serial.export(d)
    robot = printed(d, tmp_path)
    q = np.random.default_rng(6).uniform(-3, 3, (50, len(rows)))
    T = forward([[float(e) if e is not None else e for e in row] for row in rows], q)
    x = {"x": T[:, 0, 3], "y": T[:, 1, 3], "z": T[:, 2, 3]}
    x["yaw"] = np.arctan2(T[:, 1, 0], T[:, 0, 0])
    answers, status = robot.ik(np.column_stack([x[n] for n in serial.coordinates().names]))
    assert (status == OK).all()
    turned = np.exp(1j * (answers[:, 0, -1] - q[:, -1]))
    np.testing.assert_allclose(answers[:, 0, :-1], q[:, :-1], atol=1e-13)
    np.testing.assert_allclose(turned, 1, atol=1e-13)


def test_a_slide_may_be_normal_to_the_turn_after_it(tmp_path: Path) -> None:
    """A lift whose arm swings in a plane with it, as that of a Toyota HSR, with a wrist."""
    rows = [(H, -pi / 2, None, 0), (sp.Rational(1, 8), pi / 2, H), (0, -pi / 2, 2),
            (0, pi / 2, 0), (0, 0, H)]  # fmt: skip
    d, serial = arm(rows, "d1 t2 t3 t4 t5")
    found = propose(serial)
    assert found.structure == "a slide and a turret, and 3 joints that turn the tool"
    solved(d, serial, found.source)
    assert prove(d).inverses[0].branches == found.branches == 4
    serial.export(d)
    robot = printed(d, tmp_path)
    q = np.random.default_rng(6).uniform(-3, 3, (400, 5))
    q[:100, 1:] = np.round(q[:100, 1:])
    q[100:200, 3] = 0
    T = forward([[float(e) if e is not None else e for e in row] for row in rows], q)
    answers, status = robot.ik(T)
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    assert max(misses(robot.pose(answers), T, status)) < 1e-12 * 4
    off = np.abs(np.exp(1j * (answers - q[:, None])) - 1).max(axis=-1)
    assert (np.nanmin(off, axis=1)[200:] < 1e-8).all()
    T[:, 1, 3] += 1  # out of the plane of the lift and the swing
    assert (robot.ik(T).status == UNREACHABLE).all()


@pytest.mark.parametrize("name", APART)
def test_the_joints_that_turn_come_from_the_rotation_alone(name: str, tmp_path: Path) -> None:
    rows, joints = APART[name]
    d, serial = arm(rows, joints)
    found = propose(serial)
    assert found.structure.endswith("the tool, apart from each other")
    solved(d, serial, found.source)
    assert prove(d).inverses[0].branches == found.branches
    serial.export(d)
    robot = printed(d, tmp_path)
    q = np.random.default_rng(3).uniform(-3, 3, (400, len(rows)))
    q[:100, -2:] = np.round(q[:100, -2:])
    q[100:200, len(rows) - 2] = q[200:300, 1] = 0
    T = forward([[float(e) if e is not None else e for e in row] for row in rows], q)
    answers, status = robot.ik(T)
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    away, turned = misses(robot.pose(answers), T, status)
    assert max(away, turned) < 1e-12 * 40
    turns = [j.startswith("t") for j in joints.split()]
    off = np.where(turns, np.angle(np.exp(1j * (answers - q[:, None]))), answers - q[:, None])
    near = np.nanmin(np.abs(off).max(axis=-1), axis=1)
    assert (near[300:] < 1e-8).all()
    if len(rows) < 6:
        turned = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0], [0.48, 0.64, 0.6]])
        T[:, :3, :3] = T[:, :3, :3] @ turned
        assert np.isin(robot.ik(T).status[300:], UNREACHABLE).all()


def test_what_a_slide_is_set_to_is_written_like_the_slide() -> None:
    """The value d1_ of the slide d1 looked like another symbol with its letter."""
    d, serial = arm(*APART["offset wrist"])
    serial.export(d)
    solved(d, serial, propose(serial).source)
    text = render("latex/robot.tex.jinja", document(d, Proof(d.name, d.paper.key, (), 0, ())))
    assert r"$\displaystyle d_{1} = " in text


@pytest.mark.filterwarnings("error")
def test_two_slides_do_not_reach_what_a_singular_wrist_leaves() -> None:
    rows = [GANTRY[0], GANTRY[2], (H, -pi / 2, 1), (1, pi / 2, H), (0, 0, 1)]
    serial = arm(rows, "d1 d2 t3 t4 t5")[1]
    with pytest.raises(NoChainError) as caught:
        DecoupledMaker(serial).decoupled(singles(serial))
    assert caught.value.found == "it has fewer than three slides and three joints that turn"


def test_why_slides_among_joints_that_turn_are_refused() -> None:
    rows = [(H, -pi / 2, 1), *GANTRY[:2], (1, pi / 3, H), (H, pi / 3, 1), (H, 0, 1)]
    with pytest.raises(NoChainError) as caught:
        propose(arm(rows, "t1 d2 d3 t4 t5 t6")[1])
    assert "slides apart from turns" in [t.name for t in caught.value.tried]


def test_a_modified_table_of_one_joint_is_read(tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    path.write_text("a, alpha, d, theta\n0.5, 0, 0, t\n", "utf-8")
    assert new("arm", "dh", path, modified=True).inverse


def test_a_joint_that_does_not_move_the_origin_of_the_tool_is_named(tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    path.write_text("a, alpha, d, theta\n0.5, 0, 0, t1\n0.5, 0, 0, t2\n", "utf-8")
    script = new("arm", "dh", path, modified=True)
    assert script.inverse and "on the axis of t2, which only turns the tool" in script.advice


FEW = {
    "turret, joint, slide": ([(0, pi / 2, 0), (0, -pi / 2, 0), (0, pi / 2, None, 0), (0, 0, H)],
                             "t1 t2 d3 t4", 2),
    "turret, slide, joint": ([(0, 0, H), (0, pi / 2, None, 0), (H, pi / 2, 0), (0, 0, H)],
                             "t1 d2 t3 t4", 4),
    "polar with two more": ([(0, -pi / 2, H), (0, pi / 2, 0), (0, pi / 2, None, 0), (0, -pi / 2, 0),
                             (0, 0, H)], "t1 t2 d3 t4 t5", 4),
}  # fmt: skip


@pytest.mark.parametrize("name", FEW)
def test_the_last_axis_decides_where_a_slide_leads_to_the_first(name: str, tmp_path: Path) -> None:
    """With the wrist on the first axis, its joint was taken for free although the tool points."""
    rows, joints, branches = FEW[name]
    d, serial = arm(rows, joints)
    found = propose(serial)
    solved(d, serial, found.source)
    assert prove(d).inverses[0].branches == found.branches == branches
    serial.export(d)
    robot = printed(d, tmp_path)
    rng, n = np.random.default_rng(6), len(rows)
    q = np.where(
        rng.random((2000, n)) < 0.6, pi_halves(rng, (2000, n)), rng.uniform(-3, 3, (2000, n))
    )
    slide = joints.split().index(next(j for j in joints.split() if j.startswith("d")))
    q[:, slide] = rng.uniform(0.3, 2, 2000)
    T = forward([[None if e is None else float(e) for e in row] for row in rows], q)
    answers, status = robot.ik(T)
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    assert max(misses(robot.pose(answers), T, status)) < 1e-12 * 3


def pi_halves(rng: np.random.Generator, shape: tuple[int, int]) -> np.ndarray:
    """Multiples of a right angle, and angles near them."""
    near = 10.0 ** rng.uniform(-16, -1, shape) * rng.choice([-1, 0, 1], shape)
    return rng.integers(-2, 3, shape) * np.pi / 2 + near


BASE = """\
axes = [
    {joint = "x1", kind = "prismatic", direction = [1, 0, 0]},
    {joint = "y1", kind = "prismatic", direction = [0, 1, 0]},
    {joint = "heading", direction = [0, 0, 1], point = [0, 0, 0]},
]
[home]
position = [0, 0, 0]
"""


@pytest.mark.filterwarnings("error")
def test_a_mobile_base_without_any_length_is_cross_checked(tmp_path: Path) -> None:
    """Where both slides are at 0 it has no size, and the error relative to it was not a number."""
    (tmp_path / "base.toml").write_text(BASE, "utf-8")
    new_one = ["new", "base", "--from", "screws", str(tmp_path / "base.toml"), "-o", str(tmp_path)]
    assert main(new_one) == 0
    printed_to = ["-o", str(tmp_path / "out"), "--backend", "numpy", "-j1"]
    assert main(["derive", str(tmp_path / "base.py"), *printed_to]) == 0
