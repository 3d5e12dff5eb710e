"""A hand that turns on two rails and a third leg: all its assembly modes, against its drawing."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of
from sympy import Rational

from closedform import Crank, Derivation, Paper, Rail, Slide, Stretch, platform, prove, real
from closedform.algebra.shapes import ShapeError
from closedform.check.crosscheck import crosscheck
from closedform.check.finding import module_backend

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
B, A = 0.4, 0.1
STAGE = """
hand = "P"
[parameters]
b = {{value = "0.4", meaning = "base"}}
a = {{value = "0.1", meaning = "hand"}}
[bodies]
ground = {{A1 = ["-b", 0], G2 = ["b", 0], G3 = [0, 0.3]}}
hand = {{P = [0, 0], C1 = {ends[0]}, C2 = {ends[1]}, C3 = {ends[2]}}}
tube = {{}}
rod = {{}}
cart2 = {{G2 = ["b", 0]}}
block2 = {{}}
cart3 = {{G3 = [0, 0.3]}}
block3 = {{}}
[joints]
a1 = {{between = ["ground", "tube"], at = "A1"}}
c1 = {{between = ["rod", "hand"], at = "C1"}}
s2 = {{between = ["cart2", "block2"], at = "G2", kind = "prismatic", axis = [1, 0]}}
c2 = {{between = ["block2", "hand"], at = "C2"}}
s3 = {{between = ["cart3", "block3"], at = "G3", kind = "prismatic", axis = {way}}}
c3 = {{between = ["block3", "hand"], at = "C3"}}
q1 = {{between = ["tube", "rod"], at = "A1", kind = "prismatic", driven = true}}
[joints.q2]
between = ["ground", "cart2"]
at = "G2"
kind = "prismatic"
axis = [0, 1]
driven = true
[joints.q3]
between = ["ground", "cart3"]
at = "G3"
kind = "prismatic"
axis = {rate}
driven = true
"""
SPREAD = (('["-a", 0]', '["a", 0]', '[0, "a"]'), [(-A, 0), (A, 0), (0, A)])
CENTRE = (('["a/2", "a/2"]', '["a", 0]', '[0, "a"]'), [(A / 2, A / 2), (A, 0), (0, A)])
SAME = (('["-a", 0]', '["a", 0]', '["a", 0]'), [(-A, 0), (A, 0), (A, 0)])
KINDS = {
    "ellipse": (SPREAD, (1, 0), (1, 2), 4),
    "level": (SPREAD, (1, 3), (1, 0), 4),
    "circle": (CENTRE, (1, 0), (0, 1), 2),
    "pinned": (SAME, (1, 0), (1, 2), 2),
}
"""The ends of the legs, the directions of the third slider and its rail, the number of modes."""


@pytest.fixture(scope="module", params=KINDS)
def made(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[str, str, ModuleType]:
    kind = request.param
    (ends, _), rate, way, _ = KINDS[kind]
    folder = tmp_path_factory.mktemp(kind)
    text = STAGE.format(ends=ends, rate=list(rate), way=list(way))
    script = script_of(f"on_{kind}", text, folder)
    return kind, script, derived(f"on_{kind}", script, folder)


def off(kind: str, q: np.ndarray, x: np.ndarray) -> np.ndarray:
    """By how much the legs miss the ends of the hand."""
    (_, places), rate, way, _ = KINDS[kind]
    s, c = np.sin(x[..., 2]), np.cos(x[..., 2])
    R = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
    ends = x[..., None, :2] + np.einsum("...ij,kj->...ki", R, np.array(places))
    gaps = ends - [(-B, 0), (B, 0), (0, 0.3)]
    u, v = (np.array(w) / np.hypot(*w) for w in (rate, way))
    second = gaps[..., 1, 1] - q[..., 1]
    third = gaps[..., 2, :] - q[..., 2, None] * u
    first = np.hypot(gaps[..., 0, 0], gaps[..., 0, 1]) - q[..., 0]
    return np.stack([first, second, v[0] * third[..., 1] - v[1] * third[..., 0]], -1)


def postures(count: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1, 1, (count, 3)) * (0.5, 0.5, np.pi)


def gaps_of(p: np.ndarray, x: np.ndarray) -> np.ndarray:
    gap = p - x[..., None, :]
    gap[..., 2] = np.angle(np.exp(1j * gap[..., 2]))
    return np.where(np.isnan(gap), np.inf, np.abs(gap)).max(-1)


def test_all_postures_are_found(made: tuple[str, str, ModuleType]) -> None:
    kind, _, stage = made
    x = postures(100_000, 1)
    q, status = stage.ik(x)
    assert np.isin(status, (OK, SINGULAR)).all() and np.abs(off(kind, q[:, 0], x)).max() < 1e-14
    kept = status[:, 0] == OK
    assert kept.mean() > 0.95
    found = stage.fk(q[kept, 0])
    assert found.p.shape[1] == KINDS[kind][3] == len(stage.ASSEMBLY_MODES)
    assert gaps_of(found.p, x[kept]).min(-1).max() < 1e-12
    solved = found.status == OK
    assert np.isnan(found.p[found.status == UNREACHABLE]).all()
    missed = off(kind, np.broadcast_to(q[kept], found.p.shape)[solved], found.p[solved])
    assert np.abs(missed).max() < 1e-12


def test_newton_finds_no_other_mode(made: tuple[str, str, ModuleType]) -> None:
    kind, _, stage = made
    rng, seen = np.random.default_rng(2), set()
    for q in stage.ik(postures(12, 3)).q[:, 0]:
        p = stage.fk(q).p
        for start in postures(20, int(rng.integers(1000))):
            x = newton(lambda x: off(kind, q, x), start)  # noqa: B023
            if x is not None:
                gaps = gaps_of(p, x)
                seen.add(int(gaps.argmin()))
                assert gaps.min() < 1e-6
    assert seen == {*range(KINDS[kind][3])}


def test_where_the_leg_does_not_reach(made: tuple[str, str, ModuleType]) -> None:
    """Where two modes end they meet: SINGULAR there, UNREACHABLE beyond, and no gap between."""
    kind, _, stage = made
    low = stage.ik(postures(2000, 4)).q[:, 0]
    high = low * (0.0, 1, 1)
    here, there = stage.fk(low).status, stage.fk(high).status
    some = ((here == OK) & (there == UNREACHABLE)).any(-1)
    assert some.sum() > 100
    low, high = low[some], high[some]
    mode = ((here == OK) & (there == UNREACHABLE))[some].argmax(-1)
    rows = np.arange(len(low))
    for _ in range(60):
        middle = (low + high) / 2
        inside = (stage.fk(middle).status[rows, mode] == OK)[:, None]
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    p = stage.fk(low).p[rows, mode]
    assert np.abs(off(kind, low, p)).max() < 1e-11
    assert (stage.ik(p).status == SINGULAR).mean() > 0.95


def test_derivatives(made: tuple[str, str, ModuleType]) -> None:
    _, _, stage = made
    q = stage.ik(postures(500, 5)).q[:, 0]
    rates = [(stage.fk(q + s).p - stage.fk(q - s).p) / 2e-6 for s in 1e-6 * np.eye(3)]
    J, expected = stage.jacobian(q), np.stack(rates, -1)
    with np.errstate(invalid="ignore"):
        tame = (np.abs(J).max((-1, -2)) < 20) & (np.abs(expected).max((-1, -2)) < 20)
    assert tame.mean() > 0.3
    np.testing.assert_allclose(J[tame], expected[tame], atol=1e-5)
    A, B = stage.jacobian_parallel(q), stage.jacobian_serial(q)
    np.testing.assert_allclose((A @ J)[tame], (B[..., None] * np.eye(3))[tame], atol=1e-10)
    factors = stage.singularities(q)[..., -1]
    np.testing.assert_allclose(np.linalg.det(A[tame]), factors[tame], atol=1e-13)
    np.testing.assert_allclose(stage.determinant(q)[tame], np.linalg.det(J[tame]), rtol=1e-7)


@pytest.mark.parametrize("kind", ["level", "pinned"])
def test_the_printed_code_agrees_with_its_source(kind: str, tmp_path: Path) -> None:
    (ends, _), rate, way, _ = KINDS[kind]
    text = STAGE.format(ends=ends, rate=list(rate), way=list(way))
    script = script_of(f"checked_{kind}", text, tmp_path)
    module = derived(f"checked_{kind}", script, tmp_path)
    found = crosscheck(read_script(script), module_backend("numpy", module))
    assert not [failure for f in found for failure in f.failures]


def toy(third: str, ways: tuple[tuple[int, int], ...], places: list[tuple]) -> Derivation:
    """Rails as the first and the last leg, and another one between them."""
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    kinds = ("prismatic", "revolute" if third == "crank" else "prismatic", "prismatic")
    q = [d.joint(f"q{k}", kind) for k, kind in enumerate(kinds, 1)]
    s, t = (d.joint(n, "prismatic", passive=True) for n in "st")
    half, at = Rational(1, 2), (Rational(-1, 3), Rational(1, 4))
    legs = {
        "crank": lambda e: Crank(
            q[1], half, half, pivot=at, along=(1, 0), across=(0, 1), on_hand=e
        ),
        "slide": lambda e: Slide(q[1], half, at, (1, 0), on_hand=e),
        "stretch": lambda e: Stretch(q[1], at, on_hand=e),
    }
    rates = [(-y, x) for x, y in ways]
    platform(
        d,
        [
            Rail(q[0], s, (0, 0), rates[0], ways[0], on_hand=places[0]),
            legs[third](places[1]),
            Rail(q[2], t, (1, 0), rates[1], ways[1], on_hand=places[2]),
        ],
    )
    return d


@pytest.mark.parametrize("third", ["crank", "slide", "stretch"])
@pytest.mark.parametrize("level", [False, True])
def test_each_kind_of_third_leg_is_proved(third: str, level: bool) -> None:
    tenth = Rational(1, 10)
    ways = ((1, 0), (-1, 0)) if level else ((1, 0), (0, 1))
    d = toy(third, ways, [(0, tenth), (-tenth, 0), (2 * tenth, 0)])
    prove(d)
    assert len(d.assembly_modes) == 4


def test_rails_that_hold_nothing_say_why() -> None:
    with pytest.raises(ShapeError, match="the legs do not hold the hand"):
        toy("stretch", ((1, 0), (1, 0)), [(1, 2), (0, 0), (1, 2)])


def test_an_ellipse_that_becomes_a_circle_is_invalid() -> None:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    a = d.parameter("a", value=1, unit="m", meaning="arm")
    q = [d.joint(f"q{k}", "prismatic") for k in range(1, 4)]
    s, t = (d.joint(n, "prismatic", passive=True) for n in "st")
    half = Rational(1, 2)
    platform(
        d,
        [
            Stretch(q[0], (0, 0), on_hand=(a, half)),
            Rail(q[1], s, (0, 0), (0, 1), (1, 0), on_hand=(1, 0)),
            Rail(q[2], t, (0, 0), (1, 0), (0, 1), on_hand=(0, 1)),
        ],
    )
    (fk,) = (f for f in d.functions if f.name == "fk")
    assert any("along an ellipse, not a circle" in note for note in fk.notes)
    assert real("yaw") in d.inverses[0].unknowns
