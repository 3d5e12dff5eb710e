"""Linkages that cylinders drive: an excavator's bucket and a backhoe, against their drawings.

The other route begins with the angles of the bodies, of which the lengths of the cylinders follow.
"""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, read_script, script_of
from places import TESTS

from closedform.check.truth import values_of

FOLDER = TESTS / "held_out_loops"


def module(name: str, folder: Path) -> ModuleType:
    text = (FOLDER / f"{name}.toml").read_text("utf-8")
    return derived(f"{name}_driven", script_of(f"{name}_driven", text, folder), folder)


@pytest.fixture(scope="module")
def bucket(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return module("bucket", tmp_path_factory.mktemp("bucket"))


@pytest.fixture(scope="module")
def backhoe(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return module("backhoe", tmp_path_factory.mktemp("backhoe"))


def turn(angle: np.ndarray) -> np.ndarray:
    return np.exp(1j * angle)


def test_the_bucket_has_every_posture_of_its_drawing(bucket: ModuleType) -> None:
    v = bucket.Parameters()
    lever, psi = np.linspace(-3, 3, 400), np.linspace(-np.pi, np.pi, 4001)
    C = v.r * 1j * turn(lever)
    q = abs(C + v.f - 1j * v.h)
    missed = abs(C[:, None] - v.e - v.s * turn(psi)) - v.l
    rows, places = np.nonzero(np.diff(np.sign(missed), axis=1))
    left, right = missed[rows, places], missed[rows, places + 1]
    found = psi[places] + (psi[1] - psi[0]) * left / (left - right)
    assert len(rows) > 100 and len(bucket.ASSEMBLY_MODES) == 4
    forward = np.angle(turn(bucket.fk(q[rows, None]).p[..., 0] - found[:, None]))
    assert np.nanmin(abs(forward), axis=1).max() < 1e-3
    answers = bucket.ik(found[:, None]).q[..., 0]
    near = np.nanmin(abs(answers - q[rows, None]), axis=1)
    assert np.quantile(near, 0.9) < 1e-4  # the drawing is coarse where the bars are in line


def test_both_lengths_of_the_cylinder_lead_back(bucket: ModuleType) -> None:
    psi, status = bucket.fk([1.6])
    assert not status.any()
    for row in psi:
        answers = bucket.ik(row)
        assert not answers.status.any()
        assert np.allclose(np.nanmin(abs(answers.q - 1.6)), 0, atol=1e-12)
    rates = (bucket.fk([1.6 + 1e-6]).p - bucket.fk([1.6 - 1e-6]).p) / 2e-6
    assert np.allclose(bucket.jacobian([1.6])[:, 0], rates, atol=1e-7)


def test_the_backhoe_has_every_posture_of_its_drawing(backhoe: ModuleType) -> None:
    boom, tilt = np.random.default_rng(1).uniform(-np.pi, np.pi, (2, 500))
    B = backhoe.Parameters().b * turn(boom)
    C, G = 0.3 * turn(boom), (0.6 + 0.4j) * turn(boom)
    D, P = B + (-0.1 + 0.3j) * turn(tilt), B + 0.5 * turn(tilt)
    q = np.stack([abs(C - 0.3 + 0.3j), abs(D - G)], axis=1)
    hand = np.stack([P.real, P.imag], axis=1)
    forward, answers = backhoe.fk(q), backhoe.ik(hand)
    assert len(backhoe.ASSEMBLY_MODES) == 4 and len(backhoe.BRANCHES) == 2
    sure = (forward.status == 0).all(axis=1)
    missed = np.linalg.norm(forward.p - hand[:, None], axis=-1).min(axis=1)
    assert sure.mean() > 0.9 and missed[sure].max() < 1e-9
    assert np.nanmin(np.linalg.norm(answers.q - q[:, None], axis=-1), axis=1).max() < 1e-6
    J, step = backhoe.jacobian(q[0]), np.array([1e-7, -2e-7])
    moved = backhoe.fk(q[0] + step).p - backhoe.fk(q[0] - step).p
    assert np.allclose(moved, 2 * J @ step, atol=1e-11)


def test_a_rod_may_be_pinned_to_the_end_of_the_piston(tmp_path: Path) -> None:
    text = (FOLDER / "bucket.toml").read_text("utf-8")
    other = text.replace('c2 = {between = ["lever"', 'c2 = {between = ["rodc"')
    assert text != other and script_of("bucket", text, tmp_path) == script_of(
        "bucket", other, tmp_path
    )


def test_two_cylinders_may_be_pinned_to_each_other(tmp_path: Path) -> None:
    text = """
hand = "P"
[bodies]
ground = {A = [0, 0], B = [1, 0], E = [2, 0]}
t1 = {}
p1 = {}
t2 = {}
p2 = {}
rod = {C = [0, 0], D = [0.5, 0], P = [0.3, 0.3]}
lever = {length = "0.8"}
[joints]
a = {between = ["ground", "t1"], at = "A"}
b = {between = ["ground", "t2"], at = "B"}
q1 = {between = ["t1", "p1"], at = "A", kind = "prismatic", driven = true}
q2 = {between = ["t2", "p2"], at = "B", kind = "prismatic", driven = true}
c = {between = ["p1", "p2"], at = "C"}
f = {between = ["p2", "rod"], at = "C"}
g = {between = ["rod", "lever"], at = "D"}
h = {between = ["lever", "ground"], at = "E"}
"""
    script = script_of("two", text, tmp_path)
    assert "t1 and t2 meet in C, rod and lever meet in D" in " ".join(
        script.replace('"', " ").split()
    )


def test_a_cylinder_that_is_not_driven_is_left_out(tmp_path: Path) -> None:
    text = (FOLDER / "bucket.toml").read_text("utf-8")
    text = text.replace("driven = true}", "axis = [1, 0]}")
    lever = 'lj = {between = ["ground", "lever"], at = "L"'
    text = text.replace(lever, f"{lever}, driven = true")
    script = script_of("bucket", text, tmp_path)
    assert "tube" not in script and len(read_script(script).actuated) == 1


def test_the_landing_gear_has_every_posture_of_its_drawing(tmp_path: Path) -> None:
    """The hand is the angle of the strut, which reaches on to the wheel."""
    gear = module("landing_gear", tmp_path)
    upper, psi = np.linspace(-3, 3, 300), np.linspace(-np.pi, np.pi, 4001)
    U, F = -0.6 + 0.1j, -0.9 + 0.3j
    q = abs(U + (0.1 + 0.15j) * turn(upper) - F)
    missed = abs((U + 0.5 * turn(upper))[:, None] + 0.5j * turn(psi)) - 0.45
    rows, places = np.nonzero(np.diff(np.sign(missed), axis=1))
    left, right = missed[rows, places], missed[rows, places + 1]
    found = psi[places] + (psi[1] - psi[0]) * left / (left - right)
    assert len(rows) > 100 and len(gear.ASSEMBLY_MODES) == 4
    forward = np.angle(turn(gear.fk(q[rows, None]).p[..., 0] - found[:, None]))
    assert np.quantile(np.nanmin(abs(forward), axis=1), 0.95) < 1e-3
    at = gear.skeleton(q[:, None])[..., gear.SKELETON.points.index("W"), :2]
    wheel = -1.2j * turn(gear.fk(q[:, None]).p[..., 0])
    assert np.nanmax(abs(at[..., 0] + 1j * at[..., 1] - wheel)) < 1e-12


def test_jacks_are_checked_where_the_leg_closes(tmp_path: Path) -> None:
    """Of random lengths none closed, so no value of ``fk`` was compared with its source."""
    text = (FOLDER / "jacks.toml").read_text("utf-8")
    leg = derived("jacks", script_of("jacks", text, tmp_path), tmp_path, crosscheck=True)
    page = (tmp_path / "jacks_out" / "jacks-crosscheck.md").read_text("utf-8")
    rows = [line.split("|") for line in page.splitlines() if line.startswith("| ")][1:]
    assert len(rows) == 10 and all(int(row[-2]) > 100 for row in rows)

    hip, knee = np.random.default_rng(3).uniform(-1, 1, (2, 200))
    v, thigh, shank = leg.Parameters(), turn(hip), turn(hip + knee)
    K = -1j * v.t * thigh
    C, G, D = (0.05 - 0.2j) * thigh, (-0.04 - 0.1j) * thigh, K + (-0.05 + 0.02j) * shank
    q = np.stack([abs(C - 0.1 + 0.05j), abs(D - G)], axis=1)
    P = K - 1j * v.s * shank
    forward = leg.fk(q).p
    assert np.nanmin(abs(forward[..., 0] + 1j * forward[..., 1] - P[:, None]), axis=1).max() < 1e-12
    back = leg.ik(np.stack([P.real, P.imag], axis=1)).q
    assert np.nanmin(abs(back - q[:, None]).max(axis=2), axis=1).max() < 1e-9


def test_only_what_moves_far_is_singular(tmp_path: Path) -> None:
    """A crane whose bodies have several pins: each of them was counted, as if one moved the next.

    So a quarter of its answers were SINGULAR, where the hand moves by 20 to 100 times a cylinder.
    """
    crane, rng = module("loader_crane", tmp_path), np.random.default_rng(1)
    q = rng.uniform([0.9, 0.3], [1.3, 1.0], (4000, 2))
    fk = crane.fk(q)
    there = fk.status == 0
    back = crane.ik(fk.p[there])
    away = np.abs(back.q - np.broadcast_to(q[:, None], (*there.shape, 2))[there][:, None]).max(-1)
    own = back.status[np.arange(len(away)), np.nanargmin(away, axis=1)]
    gain = np.linalg.norm(crane.jacobian(q)[there], 2, axis=(1, 2))
    assert np.nanmin(away, axis=1).max() < 1e-7  # both answers of a leg may nearly meet
    assert ((gain > 20) & (gain < 40)).sum() > 100
    assert not own[gain < 40].any()
    again, status = crane.fk(back.q[back.status == 0])
    target = np.broadcast_to(fk.p[there][:, None], back.q.shape)[back.status == 0]
    missed = np.linalg.norm(again - target[:, None], axis=-1)
    assert np.where(status == 0, missed, np.inf).min(1).max() < 1e-12 * 2.65


def test_a_short_boom_is_no_error(tmp_path: Path) -> None:
    """The condition number is 5000 there, and moves by 1600 roundings: lengths are rounded too."""
    text = (FOLDER / "backhoe.toml").read_text("utf-8")
    d = read_script(script_of("backhoe", text, tmp_path))
    values = values_of(d, d["condition_number"])
    row = np.array([0.5916976372747829, 0.6820982436563482, 0.0030175538817743845])
    size, eps = abs(float(values.exact.exactly(row)[0].mid())), np.finfo(float).eps
    assert size > 5000
    assert values.moved_by_numbers(row, 0, eps) > 100 * eps * size
    assert values.moved_by_numbers(np.array([0.5, 0.7, 1.0]), 0, eps) < 100 * eps * size
