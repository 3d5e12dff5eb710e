"""Three bodies of a linkage that are pinned to each other: a cylinder folds two links, or a truss.

The other routes are angles and triangles, or rigid bodies that Newton's method puts together.
"""

from pathlib import Path

import numpy as np
import pytest
from loop_files import apart, derived, script_of
from places import TESTS
from planar_bodies import Linkage

from closedform.mechanics.assur_slides import Fold, groups_for, sliding_order
from closedform.scaffold.inputs.tables import TableError

FOLDER = TESTS / "held_out_loops"
OK, UNREACHABLE, SINGULAR = range(3)
TRUSS = """
hand = "psi"
[bodies]
ground = {A = [0, 0], G = [0.5, 0]}
crank = {A = [0, 0], P = [0.1, 0]}
bar1 = {length = 0.3}
plate = {B = [0, 0], C = [0.25, 0], D = [0.4, 0.1]}
bar2 = {length = 0.2}
flap = {G = [0.5, 0], D = [0.5, 0.2]}
[joints]
theta = {between = ["ground", "crank"], at = "A", driven = true}
psi = {between = ["ground", "flap"], at = "G"}
p1 = {between = ["crank", "bar1"], at = "P"}
b = {between = ["bar1", "plate"], at = "B"}
p2 = {between = ["crank", "bar2"], at = "P"}
c = {between = ["plate", "bar2"], at = "C"}
d = {between = ["flap", "plate"], at = "D"}
"""
JACK = """
hand = "T"
[bodies]
ground = {A = [0, 0]}
bar1 = {length = 0.2}
bar2 = {length = 0.2}
bar3 = {length = 0.2}
bar4 = {length = 0.2}
nut = {}
screw = {}
roller = {T = [0, 0]}
[joints]
a1 = {between = ["ground", "bar1"], at = "A"}
a2 = {between = ["ground", "bar2"], at = "A"}
l = {between = ["bar1", "bar3"], at = "L"}
r = {between = ["bar2", "bar4"], at = "R"}
t = {between = ["bar3", "roller"], at = "T"}
u = {between = ["bar4", "roller"], at = "T"}
v = {between = ["ground", "roller"], at = "A", kind = "prismatic", axis = [0, 1]}
n = {between = ["bar1", "nut"], at = "L"}
q = {between = ["nut", "screw"], at = "L", kind = "prismatic", driven = true}
s = {between = ["bar2", "screw"], at = "R"}
"""
DOUBLED = """
hand = "P"
[bodies]
ground = {A = [0, 0], G = [0.5, 0]}
crank = {A = [0, 0], B = [0.15, 0]}
plate = {B = [0, 0], C = [0.4, 0], P = [0.2, 0.2]}
other = {B = [0, 0], C = [0.4, 0]}
rocker = {length = 0.3}
[joints]
theta = {between = ["ground", "crank"], at = "A", driven = true}
b = {between = ["crank", "plate"], at = "B"}
b2 = {between = ["crank", "other"], at = "B"}
c = {between = ["plate", "rocker"], at = "C"}
c2 = {between = ["other", "rocker"], at = "C"}
g = {between = ["ground", "rocker"], at = "G"}
"""


def test_a_cylinder_that_folds_a_stay_moves_the_leg_in_all_modes(tmp_path: Path) -> None:
    """The stay from its pivot to the leg is as long as the cylinder says, by two triangles."""
    text = (FOLDER / "side_stay.toml").read_text("utf-8")
    gear = derived("stay", script_of("stay", text, tmp_path), tmp_path, crosscheck=True)
    arm, far = np.hypot(0.2, 0.12), np.hypot(0.6, 0.1)
    ear = np.arctan2(0.12, 0.2)  # of an end of the cylinder, seen from the knee
    rng = np.random.default_rng(1)
    for q in rng.uniform(0.02, 0.46, 300):
        opened = np.arccos(1 - q**2 / (2 * arm**2))
        found = []
        for knee in (2 * ear + opened, 2 * ear - opened):
            stay = np.sqrt(0.5**2 + 0.45**2 - 2 * 0.5 * 0.45 * np.cos(knee))
            c = (0.5**2 + far**2 - stay**2) / (2 * 0.5 * far)
            if abs(c) < 1:
                base = np.arctan2(0.1, -0.6) + np.pi / 2
                found += [base + np.arccos(c), base - np.arccos(c)]
        p, status = gear.fk([q])
        there = p[status == OK]
        assert len(there) == len(found)
        for psi in found:
            assert apart(there, np.array([psi]), np.array([True])).min() < 1e-9
    q = rng.uniform(0.02, 0.46, (5000, 1))
    p, status = gear.fk(q)
    rows, modes = np.nonzero(status == OK)
    answers, told = gear.ik(p[rows, modes])
    assert (np.abs(answers - q[rows, None]).min(axis=(1, 2)) < 1e-9).all()
    again = gear.fk(answers[told == OK]).p
    at = np.repeat(p[rows, modes][:, None], 2, axis=1)[told == OK]
    assert (
        np.nanmin(np.abs(np.angle(np.exp(1j * (again - at[:, None])))), axis=(1, 2)) < 1e-12
    ).all()


def test_a_cylinder_at_its_end_is_singular_and_lost_nowhere(tmp_path: Path) -> None:
    text = (FOLDER / "side_stay.toml").read_text("utf-8")
    gear = derived("ends", script_of("ends", text, tmp_path), tmp_path)
    most = 2 * np.hypot(0.2, 0.12)
    for share in (1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 0):
        p, status = gear.fk([most * (1 - share)])
        assert (status == OK).all()
        q, told = gear.ik(p)
        assert np.isin(told, (OK, SINGULAR)).all()
        assert (np.abs(q - most * (1 - share)).min(axis=(1, 2)) < 1e-12).all()
        assert share > 1e-4 or (told == SINGULAR).any(axis=1).all()
        near = gear.singularities([most * (1 - share)])
        assert np.abs(near).min() <= np.sqrt(share) + 1e-7
    assert (gear.fk([most * (1 + 1e-9)]).status == UNREACHABLE).all()


def test_the_rates_of_a_folded_stay_are_differences(tmp_path: Path) -> None:
    text = (FOLDER / "side_stay.toml").read_text("utf-8").replace('"psi"', '"F"', 1)
    gear = derived("rates", script_of("rates", text, tmp_path), tmp_path)
    q, h = np.random.default_rng(2).uniform(0.1, 0.4, (500, 1)), 1e-6
    ahead, behind, J = gear.fk(q + h), gear.fk(q - h), gear.jacobian(q)[..., 0]
    there = (ahead.status == OK) & (behind.status == OK) & (np.abs(J).max(-1) < 5)
    assert there.sum() > 500
    assert np.abs((ahead.p - behind.p) / (2 * h) - J)[there].max() < 1e-7


def test_the_cylinder_between_the_bars_of_a_scissor_lift(tmp_path: Path) -> None:
    """The bars are at opposite angles, and the table is above or below their upper ends.

    Where these ends meet, the table is free.
    """
    text = (FOLDER / "folded_scissor.toml").read_text("utf-8")
    lift = derived("lift", script_of("lift", text, tmp_path), tmp_path)
    bar = np.linspace(-np.pi, np.pi, 4000)
    along = np.exp(1j * bar)
    across = -along.conj()
    q = np.abs(along * (0.2 + 0.05j) - along / 2 - across * (0.2 + 0.05j))
    p, status = lift.fk(q[:, None])
    for side in (1, -1):
        hand = np.stack([0 * bar, np.sin(bar) + 0.1 * side], -1)
        off = np.nanmin(np.abs(p - hand[:, None]).max(axis=-1), axis=-1)
        assert np.median(off) < 1e-13 and (off < 1e-7).all()
    inside = (q > q.min() + 1e-6) & (q < q.max() - 1e-6)
    assert (status[inside] == OK).all()  # eight modes: four angles, and both sides


def test_bars_that_are_a_triangle_are_one_body(tmp_path: Path) -> None:
    flap = derived("truss", script_of("truss", TRUSS, tmp_path), tmp_path)
    path, rng, count = tmp_path / "truss.toml", np.random.default_rng(3), 0
    for theta in (0.8, -0.7, -1.4):
        linkage = Linkage(path, theta)
        p, status = flap.fk([theta])
        exist = p[status == OK]
        for hand in filter(lambda e: e is not None, (linkage.assembled(rng) for _ in range(40))):
            assert apart(exist, hand, np.array([True])).min() < 1e-8
            count += 1
    assert count > 40


def test_a_car_jack_is_two_triangles_on_its_screw(tmp_path: Path) -> None:
    jack = derived("jack", script_of("jack", JACK, tmp_path), tmp_path)
    q = np.linspace(0.01, 0.39, 50)[:, None]
    p = jack.fk(q).p
    height = 2 * np.sqrt(0.2**2 - q**2 / 4)
    assert np.abs(np.abs(p[..., 1]).max(axis=1, keepdims=True) - height).max() < 1e-14
    top = np.concatenate([0 * height, height], axis=1)
    assert np.abs(jack.ik(top).q[..., 0] - q).min(axis=1).max() < 1e-13


def test_bodies_that_are_pinned_together_twice_are_named(tmp_path: Path) -> None:
    with pytest.raises(TableError, match="plate and other are pinned together at B and at C, so"):
        script_of("t", DOUBLED, tmp_path)
    held = DOUBLED.replace('["plate", "rocker"], at = "C"', '["plate", "ground"], at = "G"')
    held = held.replace("C = [0.4, 0], P", "G = [0.4, 0], P")
    held += 'h = {between = ["plate", "ground"], at = "A"}\n'
    held = held.replace("plate = {", "plate = {A = [0.5, 0.5], ")
    with pytest.raises(TableError, match="plate is pinned to the ground at A and at G, so it can"):
        script_of("t", held, tmp_path)


def test_only_what_the_hand_needs_is_folded() -> None:
    """Of two triangles on a beam, that which no pin of the hand is on is left out."""
    bodies = {
        "ground": "AG",
        "beam": "ACEH",
        "other": "HIK",
        "stay": "EI",
        "mast": "CFD",
        "brace": "EF",
        "rocker": "DG",
    }
    groups = sliding_order(bodies, (), ["ground"]).groups
    assert sum(isinstance(group, Fold) for group in groups) == 2
    kept = groups_for(groups, bodies, (), "rocker")
    assert [group.bodies for group in kept] == [("mast", "brace"), ("beam", "rocker")]
    last = groups_for(groups, bodies, (), "other")
    assert [group.bodies for group in last] == [group.bodies for group in groups]
