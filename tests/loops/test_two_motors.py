"""Legs with two motors each, a 3-PRPS mechanism, against its drawing."""

import re
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, script_of, unbroken
from places import TESTS

from closedform import Across, Along, Derivation, Paper, Stretch, parallel, platform, real
from closedform.algebra.shapes import ShapeError
from closedform.cli.commands import main
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "three_prps.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
ANGLES = 2 * np.pi / 3 * np.arange(3)
OUT = np.stack([np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)
AXES = np.stack([-np.sin(ANGLES), np.cos(ANGLES), 0 * ANGLES], axis=1)


@pytest.fixture(scope="module")
def prps(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("prps")
    return derived("prps", script_of("prps", TEXT, folder), folder, crosscheck=True)


def test_the_article_derives_the_sliders_too(tmp_path: Path) -> None:
    """Their equations give them at once, and were left out."""
    (tmp_path / "prps.py").write_text(script_of("prps", TEXT, tmp_path), "utf-8")
    out = tmp_path / "out"
    derive = ["derive", str(tmp_path / "prps.py"), "-o", str(out), "--backend", "latex"]
    assert main([*derive, "--no-crosscheck"]) == 0
    text = (out / "latex" / "prps.tex").read_text("utf-8")
    sought = re.search(r"The unknowns solved for are (.*?)\.", text, re.DOTALL)
    assert sought is not None and re.findall(r"[pq]_\{?\d", sought[1]) == [
        f"{letter}_{{{k}" for k in (1, 2, 3) for letter in "pq"
    ]
    assert "0 &= 0" not in text


def rotation(r: np.ndarray) -> np.ndarray:
    K = np.cross(np.eye(3), r)
    return np.linalg.inv(np.eye(3) + K) @ (np.eye(3) - K)


def missed(v, t: np.ndarray, q: np.ndarray) -> np.ndarray:
    """By how far carts miss the planes of their legs, and ends of legs their lengths."""
    ends = t[:3] + v.c * OUT @ rotation(t[3:]).T
    rods = ends - (v.b * OUT + q[::2, None] * AXES)
    return np.array([*(rods * AXES).sum(axis=1), *(np.linalg.norm(rods, axis=1) - q[1::2])])


def pose(t: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation(t[3:]), t[:3]
    return T


def targets(rows: int) -> np.ndarray:
    around = np.random.default_rng(3).uniform(-0.2, 0.2, (rows, 6))
    return around + np.array([0, 0, 0.5, 0, 0, 0])


def test_newton_finds_the_joints_that_the_closed_form_gives(prps: ModuleType) -> None:
    rng, v = np.random.default_rng(1), prps.Parameters()
    for t in targets(20):
        [q], [status] = prps.ik(pose(t))
        assert status == OK
        for start in rng.uniform(0.1, 1, (5, 6)):
            found = newton(lambda q: missed(v, t, q), start)  # noqa: B023
            assert found is None or (found[1::2] < 0).any() or np.allclose(found, q)
        back = newton(lambda t: missed(v, t, q), t + 1e-3)  # noqa: B023
        assert back is not None and np.allclose(back, t, atol=1e-9)


def test_rates_are_those_of_the_drawing(prps: ModuleType) -> None:
    for t in targets(20):
        T = pose(t)
        [q] = prps.ik(T).q
        twist = np.array([1, -2, 1, 2, 1, -1]) * 1e-6
        K = np.cross(np.eye(3), twist[3:])
        moved = T.copy()
        moved[:3, 3] += twist[:3]
        moved[:3, :3] = np.linalg.inv(np.eye(3) - K / 2) @ (np.eye(3) + K / 2) @ T[:3, :3]
        rates = prps.jacobian_inverse(T, q) @ twist
        assert np.allclose(prps.ik(moved).q[0] - q, rates, atol=1e-10)
        A, B = prps.jacobian_parallel(T, q), prps.jacobian_serial(T, q)
        assert np.allclose(A @ twist, B * rates) and np.allclose(B[::2], 1)
        assert np.isclose(prps.singularities(T, q)[-1], np.linalg.det(A))


def test_where_the_legs_do_not_hold_the_hand(prps: ModuleType) -> None:
    T = np.eye(4)  # all legs are horizontal: the hand may rise
    [q], [status] = prps.ik(T)
    assert status == SINGULAR and np.allclose(q[::2], 0)
    T[0, 0] = 2
    assert prps.ik(T).status == INVALID and np.isnan(prps.ik(T).q).all()


def of(legs: list, d: Derivation) -> None:
    platform(d, [leg(d.joint(f"q{k}", "prismatic")) for k, leg in enumerate(legs, 1)])


def test_legs_that_are_no_pairs_are_refused() -> None:
    def along(q, at=(0, 0, 0), way=(0, 0, 1)):
        return Along(q, at, way, on_hand=(1, 0, 0))

    def across(q, at=(0, 0, 0), way=(0, 0, 1)):
        return Across(q, at, way, on_hand=(1, 0, 0))

    d = [Derivation("t", "T", Paper("t", "T", ("A",)), "T") for _ in range(3)]
    with pytest.raises(ShapeError, match="three pairs, in this order; of a pair, the second"):
        of([along, across, along, across, across, along], d[0])
    with pytest.raises(ShapeError, match="q1 and q2 have to have the same axis"):
        of([along, lambda q: across(q, (1, 0, 0))] * 3, d[1])
    with pytest.raises(ShapeError, match="a hand that turns in space, on three pairs"):
        d[2].task = ["x", "y", "z"]
        qs = [d[2].joint(f"q{k}", "prismatic") for k in (1, 2, 3)]
        parallel(
            d[2], [real(e) for e in "xyz"], [along(qs[0]), *(Stretch(q, (0, 0, 0)) for q in qs[1:])]
        )


def test_a_file_may_name_all_sliders_first(tmp_path: Path) -> None:
    text = TEXT.replace("copies = 3\n", "")
    assert text != TEXT
    head, joints = TEXT.split("[joints]\n")
    lines = joints.strip().splitlines()
    text = head + "[joints]\n" + "\n".join([lines[2], lines[0], lines[1], lines[3]])
    script = unbroken(script_of("prps", text, tmp_path))
    assert script.index("Along(p1") < script.index("Across(q1") < script.index("Along(p2")


def test_a_cylindrical_joint_is_copied_with_its_slider(tmp_path: Path) -> None:
    """Its slider was not copied, because its name did not end in a number."""
    lines = [e for e in TEXT.splitlines() if not e.startswith(("r1", "cart1", "p1"))]
    at = lines.index("[joints]") + 1
    joint = 'between = ["ground", "tube1"], at = "A1", kind = "cylindrical"'
    lines.insert(at, f"p1 = {{{joint}, axis = [0, 1, 0], driven = true}}")
    script = script_of("prps", "\n".join(lines), tmp_path)
    assert script.split("platform(")[1] == script_of("prps", TEXT, tmp_path).split("platform(")[1]


def test_other_axes_are_told_of(tmp_path: Path) -> None:
    text = TEXT.replace("axis = [0, 1, 0]}", "axis = [0, 0, 1]}")
    with pytest.raises(TableError, match="a slider, about whose direction the leg turns"):
        script_of("prps", text, tmp_path)


@pytest.mark.parametrize(("name", "rod"), [("eclipse", "rod1"), ("three_pprs", "strut1")])
def test_the_rod_of_a_leg_with_two_motors_may_have_points(
    name: str, rod: str, tmp_path: Path
) -> None:
    text = (TESTS / "held_out_loops" / f"{name}.toml").read_text("utf-8")
    plain = re.search(rf'{rod} = {{length = "?(\w+)"?}}', text)
    first, last = re.findall(rf'"{rod}".*at = "(\w+)"', text)
    assert plain
    points = f'{rod} = {{{first} = [0, 0, 0], {last} = [0, 0, "{plain[1]}"]}}'
    other = text.replace(plain[0], points)
    assert script_of(name, other, tmp_path) == script_of(name, text, tmp_path)
