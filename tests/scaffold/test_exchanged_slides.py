"""Slides along the axis of a neighbour that turns: the order of the two does not matter."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, misses
from chains import arm, printed, solved
from proposals import forward
from sympy import pi

from closedform.proof.prove import prove
from closedform.scaffold.chains.chainlinks import singles
from closedform.scaffold.chains.propose import propose

H = sp.Rational(1, 2)
ARMS = {
    "an instrument whose slide and roll pass through a fixed point, with an offset wrist": (
        [(0, pi / 2, 0), (0, pi / 2, 0), (0, 0, None, 0), (0, -pi / 2, 1), (H, pi / 2, 0),
         (0, 0, H)],
        "t1 t2 d3 t4 t5 t6", "spherical shoulder, a turret, a joint and a slide",
        (1, 2, 4, 3, 5, 6),
    ),
    "a slide within a spherical wrist": (
        [(0, -pi / 2, 1), (H, pi / 2, H), (0, 0, H), (0, -pi / 2, None, 0), (0, pi / 2, 0),
         (0, 0, H)],
        "t1 t2 t3 d4 t5 t6", "spherical wrist, a turret, a joint and a slide", (1, 2, 4, 3, 5, 6),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", ARMS)
def test_the_inverse_returns_to_every_posture(name: str, tmp_path: Path) -> None:
    rows, joints, structure, _ = ARMS[name]
    d, serial = arm(rows, joints)
    found = propose(serial)
    assert found.structure == structure
    solved(d, serial, found.source)
    assert prove(d).inverses[0].branches == found.branches == 8
    serial.export(d)
    robot = printed(d, tmp_path)
    q = np.random.default_rng(3).uniform(-3, 3, (400, 6))
    q[:100] = np.round(q[:100])
    T = forward([[None if e is None else float(e) for e in row] for row in rows], q)
    answers, status = robot.ik(T)
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    assert max(misses(robot.pose(answers), T, status)) < 1e-12 * 4
    turns = [j.startswith("t") for j in joints.split()]
    off = np.where(turns, np.angle(np.exp(1j * (answers - q[:, None]))), answers - q[:, None])
    assert (np.nanmin(np.abs(off).max(axis=-1), axis=1)[100:] < 1e-8).all()


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("reverse", [False, True])
def test_every_order_has_the_same_pose(name: str, reverse: bool) -> None:
    rows, joints, _, order = ARMS[name]
    _, serial = arm(rows, joints)
    whole = singles(serial).reversed() if reverse else singles(serial)
    orders = list(whole.orders())
    found = [o.numbers[::-1] if reverse else o.numbers for o in orders]
    assert found == [(1, 2, 3, 4, 5, 6), order]
    values = dict(zip(serial.joints, map(sp.Rational, (1, 2, -1, 3, 2, -2)), strict=True))
    first, second = (sp.N(o.pose().xreplace(values)) for o in orders)
    assert (first - second).applyfunc(abs).norm() < 1e-12


def test_a_slide_passes_every_joint_about_its_axis() -> None:
    """A quill among parallel joints, of which none is solved in another order."""
    rows = [(1, 0, 0), (1, 0, 0), (0, 0, None, 0), (1, pi / 2, 0), (0, pi / 2, 1), (0, 0, 0)]
    _, serial = arm(rows, "t1 t2 d3 t4 t5 t6")
    found = [order.numbers for order in singles(serial).orders()]
    assert sorted(found) == [
        (1, 2, 3, 4, 5, 6), (1, 2, 4, 3, 5, 6), (1, 3, 2, 4, 5, 6), (3, 1, 2, 4, 5, 6),
    ]  # fmt: skip


def test_a_camera_on_a_head_that_pans_and_tilts_on_a_lift(tmp_path: Path) -> None:
    """Three joints for a point, as in a Tiago: only the order of the table was tried."""
    rows = [(0, 0, None, 0), (H, pi / 2, 1), (H, pi / 2, sp.Rational(1, 8))]
    d, serial = arm(rows, "d1 t2 t3")
    found = propose(serial)
    assert found.name == "three joints for a point, in the order 2, 1, 3"
    solved(d, serial, found.source)
    assert prove(d).inverses[0].branches == found.branches == 4
    serial.export(d)
    robot = printed(d, tmp_path)
    q = np.random.default_rng(6).uniform(-3, 3, (400, 3))
    q[:100] = np.round(q[:100])
    q[100:200, 2] = np.pi  # the camera comes to the axis of the pan
    x = forward([[None if e is None else float(e) for e in row] for row in rows], q)[:, :3, 3]
    answers, status = robot.ik(x)
    reached = np.where((status == OK)[..., None], robot.fk(answers), x[:, None])
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    assert np.abs(reached - x[:, None]).max() < 1e-12 * 4
    off = np.abs(np.exp(1j * (answers - q[:, None])) - 1).max(axis=-1)
    assert (np.nanmin(off, axis=1)[200:] < 1e-8).all()
