"""Driven slides between two moving bodies of a planar linkage, which are one body for given joints.

The other route is complex numbers: a triangle gives the one body, and the slide moves the other.
"""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, script_of
from places import TESTS

from closedform.scaffold.inputs.tables import TableError

BOOM = (TESTS / "held_out_loops" / "telescopic_boom.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR = range(3)
STRUT = """
hand = "W"
[bodies]
ground = {L = [0.3, 0], T = [0.52, 0.65]}
arm = {L = [0, 0], B = [0.35, 0]}
knuckle = {W = [0, 0], B = [-0.06, -0.1], S = [-0.1, 0.12]}
strut = {}
[joints]
a = {between = ["ground", "arm"], at = "L"}
top = {between = ["ground", "strut"], at = "T"}
s = {between = ["strut", "knuckle"], at = "S", kind = "prismatic", axis = [-0.15, 1], driven = true}
b = {between = ["arm", "knuckle"], at = "B"}
"""
"""A MacPherson suspension in a plane, whose strut is driven."""
COUPLER = """
hand = "psi"
[bodies]
ground = {A = [0, 0], G = [0.6, 0]}
crank = {A = [0, 0], B = [0.2, 0]}
outer = {}
inner = {}
rocker = {G = [0.6, 0], C = [0.6, 0.4]}
[joints]
q1 = {between = ["ground", "crank"], at = "A", driven = true}
b = {between = ["crank", "outer"], at = "B"}
q2 = {between = ["outer", "inner"], at = "B", kind = "prismatic", axis = [1, 0], driven = true}
c = {between = ["inner", "rocker"], at = "C"}
psi = {between = ["ground", "rocker"], at = "G"}
"""
"""A four-bar linkage with a motor on the crank, and a cylinder as its coupler."""


def check_jacobian(loop: ModuleType, q: np.ndarray) -> None:
    J, status, h = loop.jacobian(q), loop.fk(q).status, 1e-6
    for k, step in enumerate(h * np.eye(q.shape[-1])):
        ahead, behind = loop.fk(q + step), loop.fk(q - step)
        rate = (ahead.p - behind.p) / (2 * h)
        there = (status == OK) & (ahead.status == OK) & (behind.status == OK)
        there &= np.abs(J[..., k]).max(-1) < 5
        assert there.sum() > 100
        assert np.abs(rate - J[..., k])[there].max() < 1e-6


def both_angles(from_: complex, to: complex, arm: float, rod: np.ndarray) -> list[np.ndarray]:
    """The directions of an arm about a point that a rod joins to another one."""
    away = to - from_
    c = (abs(away) ** 2 + arm**2 - rod**2) / (2 * abs(away) * arm)
    with np.errstate(invalid="ignore"):
        return [np.angle(away) + sign * np.arccos(c) for sign in (1, -1)]


def check_hands(loop: ModuleType, q: np.ndarray, hands: list[np.ndarray]) -> None:
    """The modes are exactly the ``hands``; NaN where there is none."""
    p, status = loop.fk(q)
    for hand in hands:
        place = np.stack([hand.real, hand.imag], -1)
        there = ~np.isnan(hand)
        gaps = np.abs(p - place[:, None]).max(axis=-1)
        gaps = np.where(np.isnan(gaps), np.inf, gaps).min(axis=1)
        assert there.sum() > 500 and gaps[there].max() < 1e-9 and np.median(gaps[there]) < 1e-14
        assert (status[~there] == UNREACHABLE).all()


def test_a_boom_is_lifted_and_slides_out(tmp_path: Path) -> None:
    boom = derived("boom", script_of("boom", BOOM, tmp_path), tmp_path, crosscheck=True)
    rng = np.random.default_rng(1)
    q = np.stack([rng.uniform(0.3, 2.9, 5000), rng.uniform(-1, 3, 5000)], -1)
    lug, foot = 1.5 - 0.2j, 1 - 0.5j
    angles = both_angles(0, foot, abs(lug), q[:, 0])
    hands = [np.exp(1j * (angle - np.angle(lug))) * (4 + q[:, 1]) for angle in angles]
    check_hands(boom, q, hands)
    check_jacobian(boom, q)
    place = np.stack([hands[0].real, hands[0].imag], -1)[~np.isnan(hands[0])]
    answers, status = boom.ik(place)
    at = q[~np.isnan(hands[0])]
    assert (np.abs(answers - at[:, None]).max(axis=-1).min(axis=1) < 1e-12).all()
    assert (status == OK).all()
    assert np.abs(boom.fk(answers[:, 0]).p - place[:, None]).max(axis=-1).min(axis=1).max() < 1e-11


def test_a_strut_that_is_driven_moves_the_knuckle(tmp_path: Path) -> None:
    wheel = derived("wheel", script_of("wheel", STRUT, tmp_path), tmp_path)
    s = np.random.default_rng(2).uniform(-0.9, 0.9, (5000, 1))
    way = complex(-0.15, 1) / abs(complex(-0.15, 1))
    top, hinge, ball, mount = 0.52 + 0.65j, 0.3, -0.06 - 0.1j, -0.1 + 0.12j
    rod = ball + s[:, 0] * way - mount  # from the top to the ball, as the strut sees it
    hands = []
    for angle in both_angles(hinge, top, 0.35, np.abs(rod)):
        turn = (hinge + 0.35 * np.exp(1j * angle) - top) / rod
        hands.append(top + turn * (s[:, 0] * way - mount))
    check_hands(wheel, s, hands)
    check_jacobian(wheel, s)


def test_a_coupler_may_be_a_cylinder(tmp_path: Path) -> None:
    four = derived("four", script_of("four", COUPLER, tmp_path), tmp_path)
    rng = np.random.default_rng(3)
    q = np.stack([rng.uniform(-3, 3, 3000), rng.uniform(0.2, 0.7, 3000)], -1)
    psi, status = four.fk(q)
    pin = 0.6 + 0.4j * np.exp(1j * psi[..., 0])
    gap = np.abs(pin - 0.2 * np.exp(1j * q[:, :1])) - q[:, 1:]
    assert (status == OK).sum() > 2000 and np.abs(gap[status == OK]).max() < 1e-14
    away = 0.6 - 0.2 * np.exp(1j * q[:, 0])
    exists = (np.abs(away) < 0.4 + q[:, 1]) & (np.abs(away) > abs(0.4 - q[:, 1]))
    assert ((status == OK).all(axis=1) == exists).all()


def test_a_body_that_is_held_twice_at_one_place_is_refused(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops" / "scissor_lift.toml").read_text("utf-8")
    text = text.replace('bar1 = {O = [0, 0], M = ["l/2", 0]', "bar1 = {O = [0, 0], M = [0, 0]")
    with pytest.raises(TableError, match="O and M are at the same point of bar1"):
        script_of("t", text, tmp_path)


@pytest.mark.parametrize("zero", [0, 1.5])
def test_the_points_of_a_driven_body_are_where_they_are_at_zero(
    tmp_path: Path, zero: float
) -> None:
    text = BOOM.replace("T = [4, 0]", f"T = [{zero}, 0.25]")
    boom = derived(f"boom{int(zero)}", script_of(f"boom{int(zero)}", text, tmp_path), tmp_path)
    p = boom.fk([1.2, 0.5]).p
    assert np.allclose(np.linalg.norm(p, axis=-1), np.hypot(zero + 0.5, 0.25))
