"""Single loops of four axes through one point, such as a joint of Cardan."""

import itertools
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from loop_files import derived, newton, read_script, script_of
from places import TESTS

from closedform.scaffold.inputs.tables import TableError

CARDAN = (TESTS / "held_out_loops" / "cardan.toml").read_text("utf-8")


def test_a_joint_of_cardan_turns_as_is_known(tmp_path: Path) -> None:
    joint = derived("cardan", script_of("cardan", CARDAN, tmp_path), tmp_path, crosscheck=True)
    theta = np.random.default_rng(1).uniform(-np.pi, np.pi, (1000, 1))
    psi, status = joint.fk(theta)
    assert not status.any()
    assert np.allclose(
        np.sin(psi) * np.cos(theta)[:, None], np.cos(psi) * np.sin(theta)[:, None] * np.sqrt(0.75)
    )
    answers = joint.ik(psi[:, 0]).q
    assert np.abs(np.exp(1j * answers) - np.exp(1j * theta)[:, None]).min(axis=1).max() < 1e-9


def test_other_axes_through_one_point(tmp_path: Path) -> None:
    """The arcs of a spherical four-bar linkage are the angles between its axes."""
    other = CARDAN.replace("axis = [0, 0, 1]", "axis = [0.6, 0, 0.8]")
    loop = derived("arcs", script_of("arcs", other, tmp_path), tmp_path)
    axes = np.array([1, 0, 0]), np.array([np.sqrt(0.75), 0.5, 0])
    first, second = np.array([0.6, 0, 0.8]), np.array([-0.5, np.sqrt(0.75), 0])
    count = 0
    for theta in np.linspace(-3, 3, 50):
        psi, status = loop.fk([theta])
        for angle in psi[status == 0, 0]:
            ends = [
                np.cos(t) * v + np.sin(t) * np.cross(a, v) + (1 - np.cos(t)) * a * (a @ v)
                for a, v, t in zip(axes, (first, second), (theta, angle), strict=True)
            ]
            assert np.isclose(ends[0] @ ends[1], first @ second, atol=1e-12)
            count += 1
    assert count > 20


def test_a_point_without_a_joint_does_not_count(tmp_path: Path) -> None:
    text = CARDAN.replace("ground = {", "ground = {E = [1, 2, 3], ")
    assert text != CARDAN and "coupled(" in script_of("t", text, tmp_path)


def test_axes_that_do_not_meet_are_refused(tmp_path: Path) -> None:
    with pytest.raises(TableError, match="should meet in one point, all joints are at this point"):
        script_of(
            "t", CARDAN.replace("cross = {O = [0, 0, 0]}", "cross = {O = [0, 0, 1]}"), tmp_path
        )


def test_bodies_of_axes_alone_need_no_points(tmp_path: Path) -> None:
    """A joint of Cardan by its axes; the bodies without the point O were not read as arcs."""
    text = """
hand = "psi"
[parameters]
al = {value = "0.4", unit = "rad", meaning = "angle of the shafts"}
[bodies]
ground = {O = [0, 0, 0]}
first = {}
cross = {}
last = {}
[joints]
q = {between = ["ground", "first"], at = "O", axis = [0, 0, 1], driven = true}
c1 = {between = ["first", "cross"], at = "O", axis = [1, 0, 0]}
c2 = {between = ["cross", "last"], at = "O", axis = [0, 1, 0]}
psi = {between = ["ground", "last"], at = "O", axis = ["sin(al)", 0, "cos(al)"]}
"""
    mechanism = derived("shafts", script_of("shafts", text, tmp_path), tmp_path)
    q = np.array([0.3, 1.0, 2.0, -1.3])
    psi, status = mechanism.fk(q[:, None])
    assert not status.any()
    assert np.allclose(np.tan(psi[..., 0]) * np.cos(0.4), np.tan(q)[:, None])


EYE = """
hand = "O"
copies = 3
[bodies]
ground = {O = [0, 0, 0.1]}
lower1 = {}
upper1 = {}
hand = {}
[joints]
q1 = {between = ["ground", "lower1"], at = "O", axis = [0.6, 0, -0.8], driven = true}
m1 = {between = ["lower1", "upper1"], at = "O", axis = [0.28, 0.96, 0]}
n1 = {between = ["upper1", "hand"], at = "O", axis = [0.6, 0, 0.8]}
"""


def spun(axis: np.ndarray, angle: float) -> np.ndarray:
    """A turn about an axis."""
    K = np.cross(np.eye(3), axis)
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def test_three_legs_of_three_axes_hold_a_hand(tmp_path: Path) -> None:
    """An Agile Eye with other arcs, against the turns of its nine joints."""
    eye = derived("eye", script_of("eye", EYE, tmp_path), tmp_path)
    rng, found = np.random.default_rng(7), 0
    thirds = [spun(np.array([0, 0, 1]), 2 * np.pi * k / 3) for k in range(3)]
    axes = [turn @ np.array([[0.6, 0, -0.8], [0.28, 0.96, 0], [0.6, 0, 0.8]]).T for turn in thirds]
    for _ in range(10):
        w = rng.normal(0, 0.4, 3)
        R = spun(w / np.linalg.norm(w), np.linalg.norm(w))
        q, status = eye.ik(R)
        for k, start in itertools.product(range(3), rng.uniform(-3, 3, (6, 3))):
            a, m, n = axes[k].T
            chain = newton(
                lambda u: (spun(a, u[0]) @ spun(m, u[1]) @ spun(n, u[2]) - R).ravel(),  # noqa: B023
                start,
            )
            if chain is not None:
                found += 1
                assert np.nanmin(np.abs(np.exp(1j * q[:, k]) - np.exp(1j * chain[0]))) < 1e-6
        assert (status != 0).all() or np.abs(eye.singularities(R, q[status == 0][0])).min() > 0
    assert found > 60
    assert np.abs(eye.ik(np.eye(3)).q).max(axis=-1).min() < 1e-15


def test_ends_of_cranks_are_told_without_roots(tmp_path: Path) -> None:
    """The table of an Agile Eye was wider than the page."""
    d = read_script(script_of("eye", EYE, tmp_path))
    ends = [row[1] for row in d.steps[0].rows[1:]]
    assert len(ends) == 3
    assert {e.base for end in ends for e in end.atoms(sp.Pow) if e.is_number} <= {3}


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("[0.6, 0, 0.8]", "[0.28, 0.96, 0]", "m1 and n1, the joints of upper1, have parallel axes"),
        ("[0.28, 0.96, 0]", "[-0.6, 0, 0.8]", "q1 and m1, the joints of lower1, have parallel"),
    ],
)
def test_an_arc_has_an_angle(old: str, new: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(TableError, match=said):
        script_of("eye", EYE.replace(old, new), tmp_path)


def test_the_hand_is_where_the_axes_meet(tmp_path: Path) -> None:
    with pytest.raises(TableError, match="the hand P is not a point of a body"):
        script_of("eye", EYE.replace('hand = "O"', 'hand = "P"'), tmp_path)
