"""The lemma of degree four: its proof, its numbers, and the arms that need it."""

import itertools
import random
from fractions import Fraction
from pathlib import Path
from typing import Any

import flint
import mpmath
import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, link, misses, newton, wrapped
from chains import arm, printed, solved
from flint import arb
from numpy.typing import NDArray
from sympy import cos, pi, sin
from test_corrected import printed_array

from closedform.algebra.balls import Evaluator, to_float
from closedform.algebra.resolvent import Resolvent, cubic, enclosed
from closedform.check.finding import module_backend
from closedform.check.inverses import check_inverse
from closedform.check.rows import RowEvaluator
from closedform.emit.backends.latex.article import Page
from closedform.lemmas.chain import Chain
from closedform.lemmas.quartic import OnCircle, quartic
from closedform.mechanics.arm import from_dh
from closedform.model.derivation import Derivation, Paper
from closedform.proof.prove import Proof, prove
from closedform.proof.require import ProofError
from closedform.scaffold.chains.propose import NoChainError, propose

LINE, SIDE = {+1: "first", -1: "second"}, {+1: "left", -1: "right"}
A, B, E = sp.symbols("a b e", real=True)


def coefficients(angles: NDArray[Any]) -> NDArray[Any]:
    """Those of ``cos 2x + 2 a cos x + 2 b sin x + e`` with these roots, whose sum is a turn.

    In ``z = exp(i x)`` twice the expression times z^2 is the monic polynomial with the roots z.
    """
    z = np.exp(1j * angles)
    one = z.sum(axis=0)
    pairs = sum(z[i] * z[j] for i, j in itertools.combinations(range(4), 2))
    return np.array([-one.real / 2, -one.imag / 2, pairs.real / 2]).T


def near_roots(count: int) -> NDArray[Any]:
    """Coefficients with four, two close, twice two close, and three close real roots."""
    rng = np.random.default_rng(7)
    x, gap = rng.uniform(-3, 3, (3, count)), 10.0 ** rng.uniform(-9, 0, (2, count))
    kinds = [x, (x[0], x[0] + gap[0], x[1]), (x[0], x[0] + gap[0], gap[1] - x[0])]
    kinds.append((x[0], x[0] + gap[0], x[0] + gap[1]))
    found = [np.array(k) for k in kinds]
    return np.concatenate([coefficients(np.vstack([k, -k.sum(axis=0)])) for k in found])


def test_the_root_of_a_resolvent_is_alone_and_enclosed() -> None:
    """Against the roots of mpmath: in the interval, and farther from the middle one."""
    evaluator = Evaluator((A, B, E), [Resolvent(A, B, E)])
    for a, b, e in near_roots(25):
        exact = [mpmath.mpf(v) for v in (a, b, e)]
        with mpmath.workdps(60):
            p, q, r = exact
            roots = mpmath.polyroots(
                [-1, r, 1 - p * p - q * q, p * p - q * q - r], maxsteps=500, extraprec=600
            )
            real = sorted(mpmath.re(z) for z in roots if abs(mpmath.im(z)) < 1e-25)
        (ball,) = evaluator([a, b, e])
        found = to_float(ball)
        assert -1 <= found <= 1
        nearest = min(real, key=lambda z: abs(z - found))
        assert abs(float(nearest) - found) < 1e-13
        if len(real) == 3 and min(real[1] - real[0], real[2] - real[1]) > 1e-12:
            assert nearest != real[1]


def test_a_ball_of_coefficients_encloses_the_roots_of_all() -> None:
    draw = random.Random(3)
    for _ in range(50):
        middle = [draw.uniform(-2, 2) for _ in range(3)]
        wide = enclosed(*(arb(m, 1e-6) for m in middle))
        for _ in range(5):
            inside = [m + draw.uniform(-1e-6, 1e-6) for m in middle]
            sharp = enclosed(*map(arb, inside))
            assert wide.overlaps(sharp)
    with flint.ctx.workprec(200):
        assert enclosed(arb(0), arb(1), arb(0)).rel_accuracy_bits() > 150


def test_rows_of_balls_contain_a_root() -> None:
    """In fractions the cubic falls through zero within each radius."""
    rows = near_roots(200)
    evaluator = RowEvaluator((A, B, E), [Resolvent(A, B, E)])
    middle, radius = evaluator.balls(rows)
    np.testing.assert_array_equal(evaluator.values(rows), middle)
    settled = np.flatnonzero(np.isfinite(radius[:, 0].astype(float)))
    assert len(settled) > 500
    for k in settled:
        at, wide = (Fraction(*x.as_integer_ratio()) for x in (middle[k, 0], radius[k, 0]))
        given = [Fraction(v) for v in rows[k]]
        assert at - wide <= -1 or cubic(at - wide, *given) >= 0
        assert at + wide >= 1 or cubic(at + wide, *given) <= 0


def test_the_lowered_root_solves_the_cubic(tmp_path: Path) -> None:
    """A program of the four languages: its value leaves no more of the cubic than rounding."""
    d = Derivation("cubic", "Cubic", Paper("toy", "Toys", ("A.",)), "A cubic.", task=["a"])
    d.joint("t1")
    rows = near_roots(20000)
    d.function("root", "The root.", {"x": (A, B, E)}, {"u": Resolvent(A, B, E)})
    u = printed(d, tmp_path).root(rows)
    a, b, e = rows.T
    scale = np.maximum.reduce([np.ones_like(a), a * a, b * b, abs(e)])
    assert (abs(u) <= 1).all()
    assert (abs(cubic(u, a, b, e)) / scale).max() < 2e-15


def toy(shift: int = 0) -> tuple[Derivation, Chain]:
    """A joint of which an expression of degree four is the task."""
    d = Derivation("four", "Four", Paper("toy", "Toys", ("A.",)), "Degree four.", task=["y"])
    x = d.joint("t1")
    c = sp.Matrix([3, 1])
    long, wide = sp.Matrix([2, 0]), sp.Matrix([0, 1])
    at = c + long * cos(x) + wide * sin(x)
    ik = Chain(d, [at.dot(at)])
    (y,) = ik.x
    # |c + long cos x + wide sin x|^2 = 10 + 5/2 + 3/2 cos 2x + 12 cos x + 2 sin x
    circle = OnCircle(lambda pair: c + long * pair.c + wide * pair.s, sp.sqrt(y))
    rest = sp.Rational(25, 2) + shift - y
    ik.solve(quartic, x, (sp.Rational(3, 2), 0, 6, 1, rest), (LINE, SIDE), circle)
    ik.finish("All four.")
    return d, ik


def test_the_lemma_is_proved_for_any_coefficients() -> None:
    d, ik = toy()
    (inverse,) = prove(d).inverses
    assert inverse.branches == inverse.solutions == 4
    assert inverse.lemmas == ("quartic in one angle",)
    (link,) = ik.links
    assert len(link.degenerate) == 3  # every way in which the parts of a line are computed


def test_a_wrong_coefficient_is_noticed() -> None:
    d, _ = toy(shift=1)
    with pytest.raises(ProofError, match="does not follow from the forward map"):
        prove(d)


TILTED = [(1, pi / 2, 3), (3, pi / 3, 1), (sp.Rational(1, 2), -pi / 2, sp.Rational(1, 5))]
WRIST = [(0, pi / 2, 4), (0, -pi / 2, 0), (0, 0, sp.Rational(4, 5))]
NEAR = (0, pi / 2, 1)
SHOULDER = [(0, pi / 2, 3), (0, -pi / 2, 0), (0, pi / 2, 4), (1, pi / 3, 1), (2, -pi / 4, 1),
            (sp.Rational(1, 2), pi / 2, 1)]  # fmt: skip
H, FIFTH = sp.Rational(1, 2), sp.Rational(1, 5)
MIDDLE = {
    "general": [(H, pi / 3, 1), (2, 0, H), (1, 0, 0), (H, pi / 2, H), (FIFTH, pi / 3, 1),
                (0, 0, H)],
    "level": [(0, pi / 2, 1), (2, 0, 0), (3 * H, 0, 0), (0, pi / 2, H), (FIFTH, pi / 2, H),
              (0, 0, H)],
    "oblique": [(FIFTH, pi / 3, 1), (2, 0, H), (1, 0, 0), (FIFTH, pi / 3, H), (FIFTH, pi / 3, 1),
                (0, 0, H)],
    "from the tool": [(FIFTH, pi / 3, 1), (H, pi / 2, H), (1, 0, 0), (2, 0, H), (H, pi / 3, 1),
                      (0, 0, H)],
}  # fmt: skip
"""Three parallel axes in the middle, and two skew ones after them, or before them."""
BEHIND = [(-1, pi / 2, -10), (14, pi / 2, 4), (-14, -pi / 2, 11)]
"""A short distance between skew axes: the ellipse is ten times as large as the arm."""


@pytest.mark.parametrize(
    ("rows", "joint"),
    [
        (TILTED + WRIST, 2),
        (SHOULDER, 3),
        (BEHIND + WRIST, 2),
        (MIDDLE["general"], 4),
        (MIDDLE["level"], 1),
        (MIDDLE["oblique"], 2),
        (MIDDLE["from the tool"], 3),
    ],
)
def test_an_arm_with_skew_axes_gets_all_its_postures(rows: Any, joint: int, tmp_path: Path) -> None:
    """Random postures, and postures at which two solutions meet, are among the answers."""
    d, serial = arm(rows)
    found = propose(serial)
    assert "quartic" in found.lemmas
    assert found.branches == 8
    solved(d, serial, found.source)
    (inverse,) = prove(d).inverses
    assert inverse.branches == inverse.solutions == 8
    serial.export(d)
    code = printed(d, tmp_path)
    rng = np.random.default_rng(11)
    q = rng.uniform(-np.pi, np.pi, (20000, 6))
    _is_found(code, q, 1e-5)
    _is_found(code, singular(code, q, joint), 1e-2)  # where three meet, a cube root of rounding


def test_four_joints_whose_first_three_carry_a_point_in_space(tmp_path: Path) -> None:
    """The pose has more coordinates than the joints; the rest of it is compared."""
    rows = [(-H, pi / 2, 1), (2, pi / 2, FIFTH), (1, 0, -H), (FIFTH, 0, 0)]
    d, serial = arm(rows)
    found = propose(serial)
    assert "quartic" in found.lemmas and found.branches == 4
    solved(d, serial, found.source)
    (inverse,) = prove(d).inverses
    assert inverse.branches == 4
    serial.export(d)
    code = printed(d, tmp_path)
    q = np.random.default_rng(13).uniform(-np.pi, np.pi, (2000, 4))
    _is_found(code, q, 1e-5)
    T = code.fk(q)
    T[:, :3, 3] += 1e-3 * np.random.default_rng(14).normal(size=(len(T), 3))
    assert (code.ik(T).status == 1).all()


def test_single_precision_finds_the_postures_too(tmp_path: Path) -> None:
    """A short lever amplifies roundings beyond what is allowed of a reachable target."""
    d, serial = arm(MIDDLE["level"])
    solved(d, serial, propose(serial).source)
    serial.export(d)
    code = printed_array(d, tmp_path)
    q = np.random.default_rng(0).uniform(-3, 3, (20000, 6))
    T = code.pose(q)
    answers, status = code.ik(T.astype(np.float32))
    away = abs(wrapped(answers - q[:, None])).max(axis=-1)
    assert np.nan_to_num(away, nan=9).min(axis=1).max() < 0.1
    missed = abs(code.pose(np.nan_to_num(answers)) - T[:, None]).max(axis=(2, 3))
    assert missed[status == OK].max() / abs(T[:, :3, 3]).max() < 4e-5


def singular(code: Any, q: NDArray[Any], joint: int) -> NDArray[Any]:
    """Postures at which a factor of the determinant changes its sign, by bisection."""
    low, high = q.copy(), q.copy()
    high[:, joint] += np.random.default_rng(12).uniform(0.05, 1, len(q))
    start, end = (np.sign(code.singularities(x)) for x in (low, high))
    factor = (start != end).sum(axis=0).argmax()
    changes = start[:, factor] != end[:, factor]
    low, high, start = low[changes], high[changes], start[changes, factor]
    for _ in range(60):
        middle = (low + high) / 2
        same = np.sign(code.singularities(middle)[:, factor]) == start
        low, high = np.where(same[:, None], middle, low), np.where(same[:, None], high, middle)
    assert len(low) > 500
    return low


def _is_found(code: Any, q: NDArray[Any], gap: float) -> None:
    target = code.fk(q)
    answers, status = code.ik(target)
    missed = abs(code.fk(np.nan_to_num(answers)) - target[:, None]).max(axis=(2, 3))
    size = abs(target[:, :3, 3]).max()
    assert (missed[status == code.Status.OK] / size).max() < 2e-12
    away = abs((answers - q[:, None] + np.pi) % (2 * np.pi) - np.pi).max(axis=-1)
    free = (status == code.Status.SINGULAR).any(axis=1)
    assert np.nan_to_num(away, nan=9).min(axis=1)[~free].max() < gap


@pytest.mark.parametrize("name", ["general", "from the tool"])
def test_the_postures_are_those_of_a_numeric_inverse(name: str, tmp_path: Path) -> None:
    """Newton's method from many starts finds the same solutions, and no others."""
    rows = MIDDLE[name]
    d, serial = arm(rows)
    solved(d, serial, propose(serial).source)
    serial.export(d)
    code = printed(d, tmp_path)
    plain = np.array(rows, dtype=float)

    def pose(q: NDArray[Any]) -> NDArray[Any]:
        T = np.eye(4)
        for k, (a, alpha, length) in enumerate(plain):
            T = T @ link(a, alpha, length, q[:, k])
        return T

    rng = np.random.default_rng(5)
    for q in rng.uniform(-np.pi, np.pi, (4, 6)):
        target = pose(q[None])[0]
        starts = np.concatenate([q[None], rng.uniform(-np.pi, np.pi, (400, 6))])
        numeric = newton(pose, target, starts)
        answers, status = code.ik(target)
        found = answers[status == code.Status.OK]
        away = abs(wrapped(numeric[:, None] - found)).max(axis=-1)
        assert away.min(axis=1).max() < 1e-7 and set(away.argmin(axis=1)) == set(range(len(found)))


def test_solutions_that_meet_where_four_axes_are_parallel(tmp_path: Path) -> None:
    """There the last axis is along the three, and a difference of squares says little."""
    d, serial = arm(MIDDLE["level"])
    solved(d, serial, propose(serial).source)
    serial.export(d)
    code = printed(d, tmp_path)
    q = np.random.default_rng(6).uniform(-np.pi, np.pi, (5000, 6))
    q[:, 4] = np.where(q[:, 4] > 0, np.pi, 0) + 10.0 ** np.random.default_rng(7).uniform(
        -12, -6, 5000
    )
    target = code.fk(q)
    answers, status = code.ik(target)
    done = np.isin(status, (code.Status.OK, code.Status.SINGULAR))
    assert done.any(axis=1).mean() > 0.999
    missed = abs(code.fk(np.nan_to_num(answers)) - target[:, None]).max(axis=(2, 3))
    assert missed[done].max() < 1e-11


def test_branches_are_named_as_in_exact_arithmetic(tmp_path: Path) -> None:
    """The names do not depend on how the half of an angle is computed."""
    d, serial = arm(MIDDLE["oblique"])
    solved(d, serial, propose(serial).source)
    prove(d)
    serial.export(d)
    code = printed(d, tmp_path)
    finding = check_inverse(d, d["ik"], d.inverses[0], module_backend("numpy", code))
    assert not finding.failures and finding.compared > 200


def test_a_chain_without_a_quartic_goes_first() -> None:
    """Of a Franka arm the seventh joint is given, though the third would do with a quartic."""
    rows = [(0, -pi / 2, 0), (0, pi / 2, 0), (1, pi / 2, 2), (-1, -pi / 2, 0),
            (0, pi / 2, 2), (sp.Rational(1, 2), pi / 2, 0), (0, 0, 1)]  # fmt: skip
    assert "quartic" not in propose(arm(rows)[1]).lemmas


def test_a_twist_may_be_a_parameter() -> None:
    """Its tangent, which scripts do not know, is not written."""
    alpha = sp.Symbol("alpha", real=True)
    rows = [(1, alpha, 3), (3, alpha, 1), (sp.Rational(1, 2), -alpha, 1), *WRIST]
    d, serial = arm(rows, alpha="7/20")
    found = propose(serial)
    assert found.lemmas[0] == "quartic"
    solved(d, serial, found.source)


def test_skew_axes_that_meet_are_invalid(tmp_path: Path) -> None:
    """The chain divides by their distance, a parameter."""
    d = Derivation("arm", "Arm", Paper("toy", "Toys", ("A.",)), "An arm.")
    a1 = d.parameter("a1", value=1, unit="m", meaning="between the first two axes")
    rows = [(a1, *TILTED[0][1:]), *TILTED[1:], *WRIST]
    serial = from_dh(d, [(*row, d.joint(f"t{k}")) for k, row in enumerate(rows, 1)])
    solved(d, serial, propose(serial).source)
    serial.export(d)
    code = printed(d, tmp_path)
    q = np.array([0.3, 0.5, -0.7, 0.2, 0.9, 0.1])
    status = [code.ik(code.fk(q, (a,)), (a,)).status for a in (0.0, 1.0)]
    assert (status[0] == code.Status.INVALID).all()
    assert (status[1] == code.Status.OK).any()


@pytest.mark.parametrize(
    ("rows", "why"),
    [
        ([(1, pi / 3, 0), (2, pi / 3, 0), (2, pi / 2, 0), (0, pi / 2, 0), *WRIST[1:]], "to axis 2"),
        ([*MIDDLE["level"][:4], (sp.Rational(1, 999), pi / 2, H), (0, 0, H)], "that is short"),
    ],
)
def test_what_the_chain_cannot_do_well_is_refused(rows: Any, why: str) -> None:
    """Equal links that fold onto an axis, and axes that nearly meet."""
    with pytest.raises(NoChainError, match=why) as e:
        propose(arm(rows)[1])
    assert e.value.degree == 4


def test_a_wrist_that_moves_on_a_circle_leaves_an_equation_of_degree_two(tmp_path: Path) -> None:
    """The square of its distance from the first axis does not contain twice the angle."""
    rows = [(4, pi / 2, 3), (4, pi / 2, 0), (2, pi / 2, 0), NEAR, *WRIST[1:]]
    d, serial = arm(rows)
    found = propose(serial)
    assert found.lemmas[0] == "turn" and "quartic" not in found.lemmas
    solved(d, serial, found.source)
    assert prove(d).inverses[0].branches == found.branches == 4
    serial.export(d)
    code = printed(d, tmp_path)
    rng = np.random.default_rng(9)
    corners = rng.choice((0, np.pi / 2, np.pi), (500, 6))
    away = rng.choice((0, 1e-15, 1e-9, 1e-3, 1), (500, 1))
    q, T = corners + away * rng.uniform(-1, 1, (500, 6)), np.eye(4)
    for k, (a, alpha, length) in enumerate(rows):
        T = T @ link(float(a), float(alpha), float(length), q[:, k])
    answers, status = code.ik(T)
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    missed, turned = misses(code.pose(answers), T, status)
    assert missed < 1e-12 * 15 and turned < 1e-12
    apart = np.abs(wrapped(answers - q[:, None]))[away[:, 0] == 1].max(axis=-1)
    assert len(apart) > 50 and (np.nanmin(apart, axis=1) < 1e-6).all()


def test_an_article_writes_the_coefficients_as_letters() -> None:
    d, serial = arm(SHOULDER)
    solved(d, serial, propose(serial).source)
    page = Page(d, Proof(d.name, d.paper.key, (), 0, ()))
    text = " ".join(line.text for line in page.algorithm(d["ik"]).lines())
    assert "quartic" not in text
    assert all(rf"\bar{{{letter}}}" in text for letter in "qae")
