"""Legs with two motors, of which the first one turns the plane of the leg.

An Eclipse has three columns on a circular rail, a 3-RRRS mechanism three arms of two motors each.
The joints are those that Newton's method finds from the drawing.
"""

from pathlib import Path

import numpy as np
import pytest
from loop_files import apart, derived, newton, script_of, unbroken
from places import TESTS

from closedform import Around, Derivation, OnTurret, Paper, Slide, Stretch, platform
from closedform.algebra.shapes import ShapeError
from closedform.scaffold.source import LINE

ECLIPSE = (TESTS / "held_out_loops" / "eclipse.toml").read_text("utf-8")
ARMS = """
hand = "P"
copies = 3
[parameters]
b = {value = "0.3", meaning = "base"}
c = {value = "0.1", meaning = "hand"}
a = {value = "0.25", meaning = "cranks"}
l = {value = "0.3", meaning = "rods"}
[bodies]
ground = {A1 = ["b", 0, 0]}
turret1 = {A1 = ["b", 0, 0]}
crank1 = {A1 = ["b", 0, 0], B1 = ["b + a", 0, 0]}
rod1 = {length = "l"}
hand = {P = [0, 0, 0], C1 = ["c", 0, 0]}
[joints]
t1 = {between = ["ground", "turret1"], at = "A1", axis = [0, 0, 1], driven = true}
q1 = {between = ["turret1", "crank1"], at = "A1", axis = [0, 1, 0], driven = true}
b1 = {between = ["crank1", "rod1"], at = "B1", axis = [0, 1, 0]}
c1 = {between = ["rod1", "hand"], at = "C1", kind = "spherical"}
"""
CYLINDERS = """
hand = "P"
copies = 3
[parameters]
b = {value = "0.3", meaning = "base"}
c = {value = "0.15", meaning = "hand"}
[bodies]
ground = {A1 = ["b", 0, 0]}
turret1 = {A1 = ["b", 0, 0]}
tube1 = {}
rod1 = {}
hand = {P = [0, 0, 0], C1 = ["c", 0, 0]}
[joints]
t1 = {between = ["ground", "turret1"], at = "A1", axis = [0, 0, 1], driven = true}
r1 = {between = ["turret1", "tube1"], at = "A1", axis = [0, 1, 0]}
q1 = {between = ["tube1", "rod1"], at = "A1", kind = "prismatic", driven = true}
c1 = {between = ["rod1", "hand"], at = "C1", kind = "spherical"}
"""
FILES = {"eclipse": ECLIPSE, "arms": ARMS, "cylinders": CYLINDERS}
BRANCHES = {"eclipse": 64, "arms": 64, "cylinders": 8}
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
ANGLES = 2 * np.pi / 3 * np.arange(3)
OUT = np.stack([np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)
UP = np.array([0, 0, 1])


@pytest.fixture(scope="module", params=FILES)
def mechanism(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):
    kind, folder = request.param, tmp_path_factory.mktemp("m")
    assert len(FILES[kind].strip().splitlines()) < 40
    return kind, derived(
        f"turret_{kind}", script_of(f"turret_{kind}", FILES[kind], folder), folder, crosscheck=True
    )


def rotation(r: np.ndarray) -> np.ndarray:
    K = np.cross(np.eye(3), r)
    return np.linalg.inv(np.eye(3) + K) @ (np.eye(3) - K)


def missed(kind: str, v, t: np.ndarray, q: np.ndarray) -> np.ndarray:
    """By how far ball joints miss the planes of their legs, and rods their lengths."""
    ends = t[:3] + v.c * OUT @ rotation(t[3:]).T
    turn, other = ANGLES + q[::2], q[1::2, None]
    ahead = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    pivots = 0 * OUT if kind == "eclipse" else v.b * OUT
    near = {
        "eclipse": lambda: v.b * ahead + other * UP,
        "arms": lambda: pivots + v.a * (np.cos(other) * ahead - np.sin(other) * UP),
        "cylinders": lambda: pivots,
    }[kind]()
    lengths = q[1::2] if kind == "cylinders" else v.l
    aside = (np.cross(UP, ahead) * (ends - pivots)).sum(axis=1)
    return np.array([*aside, *(np.linalg.norm(ends - near, axis=1) - lengths)])


def pose(t: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation(t[3:]), t[:3]
    return T


def targets(rows: int) -> np.ndarray:
    around = np.random.default_rng(3).uniform(-0.03, 0.03, (rows, 6))
    return around + np.array([0, 0, 0.3, 0, 0, 0])


def test_newton_finds_no_joints_that_the_closed_form_lacks(mechanism) -> None:
    kind, m = mechanism
    rng, v, met = np.random.default_rng(1), m.Parameters(), 0
    turns = np.array([True, kind == "arms"] * 3)
    for t in targets(10):
        q, status = m.ik(pose(t))
        exist = q[status == OK]
        assert q.shape == (BRANCHES[kind], 6) and len(exist)
        for row in exist:
            assert np.abs(missed(kind, v, t, row)).max() < 1e-12
        for start in rng.uniform(-2, 2, (12, 6)):
            found = newton(lambda q: missed(kind, v, t, q), start)  # noqa: B023
            if found is not None and (kind != "cylinders" or (found[1::2] > 0).all()):
                met += 1
                assert apart(exist, found, turns).min() < 1e-9
    assert met > 10


def test_rates_are_those_of_the_drawing(mechanism) -> None:
    _, m = mechanism
    for t in targets(5):
        T = pose(t)
        twist = np.array([1, -2, 1, 2, 1, -1]) * 1e-6
        K = np.cross(np.eye(3), twist[3:])
        moved = T.copy()
        moved[:3, 3] += twist[:3]
        moved[:3, :3] = np.linalg.inv(np.eye(3) - K / 2) @ (np.eye(3) + K / 2) @ T[:3, :3]
        q, status = m.ik(T)
        beside = m.ik(moved).q
        for k in np.flatnonzero(status == OK)[::5]:
            rates = m.jacobian_inverse(T, q[k]) @ twist
            step = np.angle(np.exp(1j * (beside[k] - q[k])))
            assert np.allclose(step, rates, atol=1e-9)
            A, B = m.jacobian_parallel(T, q[k]), m.jacobian_serial(T, q[k])
            assert np.allclose(A @ twist, B * rates)
            assert np.isclose(m.singularities(T, q[k])[-1], np.linalg.det(A))


def test_a_ball_joint_on_the_axis_of_its_turret_leaves_it_free(mechanism) -> None:
    kind, m = mechanism
    v, T = m.Parameters(), np.eye(4)
    T[:3, 3] = (-v.c if kind == "eclipse" else v.b - v.c, 0, 0.2)
    q, status = m.ik(T)
    reached = ~np.isnan(q).any(axis=-1)
    assert reached.any() and (status[reached] == SINGULAR).all()
    assert (q[reached, 0] == 0).all() and np.abs(m.jacobian_serial(T, q[reached][0])[0]) < 1e-12
    T[0, 3] = 20
    if kind != "cylinders":
        assert (m.ik(T).status == UNREACHABLE).all()


def test_legs_that_are_not_on_their_turret_are_refused() -> None:
    d = Derivation("t", "T", Paper("t", "T", ("A",)), "T")
    q = [d.joint(f"q{k}", "prismatic" if k % 2 == 0 else "revolute") for k in range(1, 7)]
    with pytest.raises(ShapeError, match="unit vectors in space at right angles"):
        Around(q[0], (0, 0, 0), (0, 0, 1), (1, 0, 1))
    turrets = [Around(e, (0, 0, 0), (0, 0, 1), (1, 0, 0), on_hand=(1, 0, 0)) for e in q[::2]]
    with pytest.raises(ShapeError, match="in the two coordinates of the plane of the turret"):
        OnTurret(Slide(q[1], 1, (0, 0, 0), (0, 0, 1)), turrets[0])
    legs = [OnTurret(Stretch(e, (0, 0)), t) for e, t in zip(q[1::2], turrets, strict=True)]
    assert legs[0].on_hand == (1, 0, 0)
    legs[1] = OnTurret(Stretch(q[3], (0, 0)), turrets[0])
    with pytest.raises(ShapeError, match="q3 and q4 have to have the same axis"):
        platform(d, [leg for pair in zip(turrets, legs, strict=True) for leg in pair])


def test_the_script_has_the_plane_of_each_leg(tmp_path: Path) -> None:
    """Its second coordinate is along the axis, and a crank turns about the axis of its joint."""
    script = script_of("arms", ARMS, tmp_path)
    assert max(map(len, script.splitlines())) <= LINE
    assert "OnTurret(Crank(q2, a, l, (0, 0), (1, 0), (0, -1)), Around(t2" in unbroken(script)
    script = unbroken(script_of("e", ECLIPSE, tmp_path))
    assert "OnTurret(Slide(z3, l, (b, 0), (0, 1)), Around(t3" in script


def test_a_loop_that_leads_back_to_the_ground_ends(tmp_path: Path) -> None:
    """A chain of bodies that closes on the ground was followed round and round."""
    text = """
hand = "P"
[bodies]
ground = {O = [0, 0, 0], S = [0.3, 0.3, 0]}
first = {O = [0, 0, 0], A = [0.3, 0, 0]}
second = {A = [0, 0, 0]}
rod = {length = 0.4}
[joints]
q = {between = ["ground", "first"], at = "O", axis = [0, 0, 1], driven = true}
t = {between = ["first", "second"], at = "A", axis = [1, 0, 0]}
P = {between = ["second", "rod"], at = "P", kind = "spherical"}
d = {between = ["ground", "rod"], at = "S", kind = "spherical"}
"""
    with pytest.raises(ValueError, match="q moves first, which must be joined to one rod"):
        script_of("round", text.replace("P =", "c ="), tmp_path)
