"""The exact zero test, against identities known by other means and against mpmath."""

from __future__ import annotations

import random
import time

import mpmath
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import Abs, Rational, acos, asin, atan, atan2, cos, pi, sin, sqrt, tan
from sympy.simplify.fu import TR8

from closedform.algebra.expressions import InexactNumberError
from closedform.algebra.factors import polynomial_factors
from closedform.algebra.normal_form import Undecided, decide, determinant, equal, is_zero, normal

x, y, theta, phi = sp.symbols("x y theta phi", real=True)
a, b = sp.symbols("a b", nonnegative=True)
l1, l2 = sp.symbols("l1 l2", positive=True)
r = sqrt(x**2 + y**2)

TRUE = {
    "double angle": sin(2 * theta) - 2 * sin(theta) * cos(theta),
    "half angle": cos(theta) - 1 + 2 * sin(theta / 2) ** 2,
    "third and half": sin(theta / 3 + theta / 2)
    - sin(theta / 3) * cos(theta / 2)
    - cos(theta / 3) * sin(theta / 2),
    "pi/12": sin(theta + pi / 12) - sin(theta) * cos(pi / 12) - cos(theta) * sin(pi / 12),
    "pi/3": cos(theta + pi / 3) - cos(theta) / 2 + sqrt(3) * sin(theta) / 2,
    "pi/5": sin(theta + pi / 5) ** 2 + cos(theta + pi / 5) ** 2 - 1,
    "tangent of a half": tan(theta / 2) - sin(theta) / (1 + cos(theta)),
    "reciprocals": sp.sec(theta) ** 2 - tan(theta) ** 2 - 1,
    "sum to product": sin(theta) + sin(phi) - 2 * sin((theta + phi) / 2) * cos((theta - phi) / 2),
    "angle not expanded": cos(x * (theta + phi)) - cos(x * theta + x * phi),
    "root of a square": sqrt(x**2) - Abs(x),
    "product of moduli": Abs(x) * Abs(y) - Abs(x * y),
    "modulus of a quotient": Abs(x / y) - Abs(x) / Abs(y),
    "roots of nonnegatives": sqrt(a * b) - sqrt(a) * sqrt(b),
    "rational radicands": sqrt(Rational(3, 8)) - sqrt(6) / 4,
    "binomial under a root": sqrt(l1**2 + 2 * l1 * l2 + l2**2) - l1 - l2,
    "difference under a root": sqrt((l1 - l2) ** 2) - Abs(l1 - l2),
    "quotient under a root": sqrt(l1 / l2) - sqrt(l1 * l2) / l2,
    "root power": (x**2 + 1) ** Rational(3, 2) - (x**2 + 1) * sqrt(x**2 + 1),
    "rationalised": 1 / (sqrt(a + 1) + 1) - (sqrt(a + 1) - 1) / a,
    "modulus of the sine": sqrt(1 - cos(theta) ** 2) - Abs(sin(theta)),
    "modulus of the half sine": sqrt(2 - 2 * cos(theta)) - 2 * Abs(sin(theta / 2)),
    "split modulus of the sine": sqrt(1 + cos(theta)) * sqrt(1 - cos(theta)) - Abs(sin(theta)),
    "sine squared times": sqrt((sin(theta) * x) ** 2 + (sin(theta) * y) ** 2) - Abs(sin(theta)) * r,
    "atan2": r * cos(atan2(y, x)) - x,
    "even atan2": cos(2 * atan2(y, x)) - (x**2 - y**2) / (x**2 + y**2),
    "thrice atan2": sin(3 * atan2(y, x)) - (3 * x**2 * y - y**3) / r**3,
    "half atan2": 2 * cos(atan2(y, x) / 2) ** 2 - 1 - x / r,
    "quarter atan2": sin(atan2(y, x) / 2)
    - 2 * sin(atan2(y, x) / 4) * cos(atan2(y, x) / 4),
    "difference of atan2": sin(theta - atan2(y, x)) * r - x * sin(theta) + y * cos(theta),
    "atan": sin(2 * atan(x)) - 2 * x / (1 + x**2),
    "acos": sin(acos(x)) - sqrt(1 - x**2),
    "thrice acos": cos(3 * acos(x)) - 4 * x**3 + 3 * x,
    "acos and asin": cos(acos(x) + asin(x)),
    "halved acos": cos(acos(x) / 2) ** 2 - (1 + x) / 2,
}  # fmt: skip

FALSE = {
    "root of a square of a real": sqrt(x**2) - x,
    "roots of reals": sqrt(x * y) - sqrt(x) * sqrt(y),
    "sign of the sine": sqrt(1 - cos(theta) ** 2) - sin(theta),
    "double angle": sin(2 * theta) - 2 * sin(theta),
    "swapped": sin(theta - phi) - sin(phi - theta),
    "swapped atan2": cos(atan2(x, y)) - cos(atan2(y, x)),
    "dropped root": sqrt(l1**2 + l2**2) - l1 - l2,
    "half atan2": cos(atan2(y, x) / 2) ** 2 - x / r,
    "third power": cos(3 * acos(x)) - 4 * x**3 + 4 * x,
    "small": sin(theta) ** 2 + cos(theta) ** 2 - 1 + Rational(1, 10**30),
}


@pytest.mark.parametrize("name", TRUE)
def test_identity_is_proved(name: str) -> None:
    result = is_zero(TRUE[name])
    assert result.zero and not result.assumptions


@pytest.mark.parametrize("name", FALSE)
def test_non_identity_is_not_proved(name: str) -> None:
    assert not is_zero(FALSE[name])


@pytest.mark.parametrize("name", TRUE)
def test_the_list_of_identities_is_true(name: str) -> None:
    """mpmath agrees at points within all domains, so the list itself is right."""
    f = sp.lambdify([x, y, theta, phi, a, b, l1, l2], TRUE[name], "mpmath")
    draw = random.Random(name)
    for _ in range(5):
        signed = [draw.uniform(-0.9, 0.9) for _ in range(4)]
        positive = [draw.uniform(0.1, 3) for _ in range(4)]
        assert abs(f(*signed, *positive)) < 1e-12


@pytest.mark.parametrize("name", [n for n in FALSE if n not in ("small", "roots of reals")])
def test_false_identity_is_refuted(name: str) -> None:
    decision = decide(FALSE[name])
    assert decision.verdict == "refuted" and decision.counterexample is not None
    f = sp.lambdify(list(decision.counterexample.point), FALSE[name], "mpmath")
    point = [mpmath.mpf(sp.N(v, 30)) for v in decision.counterexample.point.values()]
    assert abs(f(*point)) > 1e-6


def test_true_on_its_real_domain_is_undecided_without_the_licence() -> None:
    split = FALSE["roots of reals"]
    with pytest.raises(Undecided, match="no counterexample"):
        decide(split)
    assert decide(split, [x, y]).verdict == "proved under assumption"


def test_licences_are_used_and_named() -> None:
    guards = [x, y + 1]
    result = is_zero(sqrt(x**2) - x, guards)
    assert result.zero and result.assumptions == (x,)
    assert is_zero(sqrt(x * (y + 1)) - sqrt(x) * sqrt(y + 1), guards).assumptions == (x, y + 1)
    assert is_zero(sqrt(1 - cos(theta) ** 2) - sin(theta), [sin(theta) >= 0])
    assert is_zero(sqrt(x**2) + x, [x <= 0])
    assert not is_zero(sqrt(x**2) + x, [x >= 0])


def test_licence_of_a_product_licenses_the_product_only() -> None:
    triple = sqrt((x - 1) * (y - 1) * (x + y))
    product = [(x - 1) * (y - 1)]
    assert is_zero(triple - sqrt((x - 1) * (y - 1)) * sqrt(x + y), product)
    assert not is_zero(triple - sqrt(x - 1) * sqrt(y - 1) * sqrt(x + y), product)


def test_an_unused_licence_is_not_an_assumption() -> None:
    decision = decide(sin(2 * theta) - 2 * sin(theta) * cos(theta), [x])
    assert decision.verdict == "proved" and decision.assumptions == ()
    assert decide(sqrt(x**2) - x, [x]).verdict == "proved under assumption"


def test_counterexample_keeps_the_assumptions() -> None:
    decision = decide(sqrt(x**2) - x + y, [x - 2])
    assert decision.counterexample is not None and decision.counterexample.point[x] >= 2


def two_link(sign: int) -> sp.Matrix:
    """The half-angle inverse of the 2R arm, put into its forward map."""
    S, A, B, C = l1 + l2 + r, l1 + l2 - r, r + l1 - l2, r - l1 + l2
    theta2 = 2 * atan2(sqrt(S) * sqrt(A), sqrt(B) * sqrt(C))
    alpha = 2 * atan2(sqrt(A) * sqrt(C), sqrt(S) * sqrt(B))
    theta1 = atan2(y, x) - sign * alpha
    return sp.Matrix(
        [
            l1 * cos(theta1) + l2 * cos(theta1 + theta2) - x,
            l1 * sin(theta1) + l2 * sin(theta1 + theta2) - y,
        ]
    )


def test_two_link_inverse_is_sound_and_its_misprint_is_refuted() -> None:
    assert is_zero(two_link(1))
    assert decide(two_link(-1)).verdict == "refuted"


def test_two_link_inverse_by_the_cosine_rule() -> None:
    D = (x**2 + y**2 - l1**2 - l2**2) / (2 * l1 * l2)
    for theta2 in (acos(D), -acos(D), atan2(sqrt(1 - D**2), D)):
        theta1 = atan2(y, x) - atan2(l2 * sin(theta2), l1 + l2 * cos(theta2))
        result = is_zero([l1 * cos(theta1) + l2 * cos(theta1 + theta2) - x])
        assert result.zero
        assert r in result.denominators


def rotation(q: sp.Symbol, alpha: sp.Expr) -> sp.Matrix:
    s, c, sa, ca = sin(q), cos(q), sin(alpha), cos(alpha)
    return sp.Matrix([[c, -s * ca, s * sa], [s, c * ca, -c * sa], [0, sa, ca]])


def test_six_revolute_rotation_is_orthonormal_and_quick() -> None:
    R = sp.eye(3)
    for q in sp.symbols("q1:7", real=True):
        R = R * rotation(q, sp.Symbol(f"alpha_{q}", real=True))
    start = time.perf_counter()
    assert is_zero(R.T * R - sp.eye(3))
    assert time.perf_counter() - start < 5
    assert is_zero(R[0, :].cross(R[1, :]) - R[2, :])
    wrong = R.copy()
    wrong[0, 0] = -wrong[0, 0]
    assert 0 in is_zero(R - wrong).nonzero and len(is_zero(R - wrong).nonzero) == 1


@pytest.mark.parametrize("n", range(25))
def test_constant_angles(n: int) -> None:
    exact = normal(cos(n * pi / 12 + theta))
    assert abs(mpmath.mpf(sp.N(exact.subs(theta, 1) - cos(n * pi / 12 + 1), 30))) < 1e-25


def test_normal_form_is_canonical() -> None:
    pairs = [
        (1 / (1 - sin(theta)), (1 + sin(theta)) / cos(theta) ** 2),
        (1 / (sqrt(2) + sqrt(3)), sqrt(3) - sqrt(2)),
        ((x**2 - y**2) / (x - y), x + y),
        (1 / (r + x), (r - x) / y**2),
    ]
    for left, right in pairs:
        assert normal(left) == normal(right)
        assert equal(left, right)
        assert normal(normal(left)) == normal(left)


def test_floats_are_named() -> None:
    with pytest.raises(InexactNumberError, match=r"0\.5"):
        is_zero(cos(0.5 * theta))


@pytest.mark.parametrize(
    "e",
    [
        sp.sign(x) - 1,
        sp.Max(x, y) - x - y,
        sp.Piecewise((x, x > 0), (0, True)),
        sp.cbrt(x),
        sp.exp(x),
        cos(pi / 7 + theta),
        cos(atan2(y, x) / 3),
        sqrt(-1 - x**2),
        1 / (sin(theta) ** 2 + cos(theta) ** 2 - 1),
    ],
)
def test_out_of_scope_is_said(e: sp.Expr) -> None:
    with pytest.raises(Undecided):
        is_zero(e)


def test_decide_refutes_what_has_no_normal_form() -> None:
    assert decide(sp.Max(x, 0) - x).verdict == "refuted"
    with pytest.raises(Undecided, match="no counterexample"):
        decide(sp.Max(x, 0) - (x + Abs(x)) / 2)


ANGLES = st.sampled_from([theta, phi, theta / 2, theta + phi, phi - 2 * theta, theta + pi / 6])


@st.composite
def trigonometric(draw: st.DrawFn, depth: int = 2) -> sp.Expr:
    if depth == 0 or draw(st.integers(0, 4)) == 0:
        leaf = draw(st.integers(0, 3))
        if leaf == 0:
            return draw(st.sampled_from([x, l1, sp.Integer(2), Rational(-1, 3)]))
        return draw(st.sampled_from([sin, cos]))(draw(ANGLES))
    parts = [draw(trigonometric(depth - 1)) for _ in range(draw(st.integers(2, 3)))]
    return sp.Add(*parts) if draw(st.booleans()) else sp.Mul(*parts)


REWRITINGS = {
    "expand_trig": sp.expand_trig,
    "expand": lambda e: sp.expand(e, trig=True),
    "product to sum": lambda e: TR8(sp.expand(e)),
    "half tangents": lambda e: e.rewrite(tan),
    "shifted": lambda e: e.replace(sin, lambda u: cos(u - pi / 2)),
    "turned": lambda e: e.xreplace({theta: theta + 4 * pi}),
}


@settings(max_examples=60, deadline=None)
@given(trigonometric(), st.sampled_from(sorted(REWRITINGS)))
def test_rewritten_is_equal_and_perturbed_is_refuted(e: sp.Expr, rewriting: str) -> None:
    rewritten = REWRITINGS[rewriting](e)
    assert is_zero(e - rewritten)
    perturbed = decide(e - rewritten + cos(theta) * x / 7)
    assert perturbed.verdict == "refuted"
    assert perturbed.counterexample is not None and not perturbed.counterexample.ball.contains(0)


@settings(max_examples=60, deadline=None)
@given(trigonometric())
def test_normal_form_has_the_same_value(e: sp.Expr) -> None:
    point = {theta: Rational(7, 10), phi: Rational(-13, 10), x: Rational(5, 3), l1: 2}
    with mpmath.workdps(30):
        assert abs(sp.N((normal(e) - e).subs(point), 20, maxn=200, strict=False)) < 1e-12


def test_a_guard_that_vanishes_licenses_nothing() -> None:
    assert not is_zero(
        sqrt(x**2) - x, nonnegative=[y - y, sp.sin(theta) ** 2 + sp.cos(theta) ** 2 - 1]
    )


def test_determinant_by_minors() -> None:
    """Agrees with SymPy's determinant for sums of angles, and is zero for dependent rows."""
    a, b = sp.symbols("a b", real=True)
    J = sp.Matrix(
        [
            [sp.cos(a), sp.sin(a + b), 0, 1],
            [sp.sin(a), a, sp.sqrt(2), 0],
            [0, sp.cos(b), b, sp.sin(a)],
            [1, 0, 0, sp.sin(b) ** 2],
        ]
    )
    assert equal(determinant(J), J.det(method="berkowitz"))
    J[3, :] = J[0, :] * 2
    assert determinant(J) == 0


def test_roots_of_long_numbers_are_not_factored() -> None:
    """Of two primes with 60 digits each, which nobody could factor; multiples are recognised."""
    number = (10**60 + 7) * (10**61 + 93)
    root = sp.Symbol("x", real=True)
    long = sp.atan2(sp.Pow(number, sp.Rational(1, 2), evaluate=False), root)
    assert equal(sp.sin(long) ** 2 + sp.cos(long) ** 2, 1)
    three = sp.sqrt(sp.UnevaluatedExpr(9 * number)).doit()
    assert equal(three**2, 9 * number)


@pytest.mark.parametrize("first", [0, 1])
def test_roots_of_numbers_with_long_factors_are_recognised(first: int) -> None:
    """The hypotenuse of an offset, and the sine of its angle, in whichever order they come."""
    a, b = 3020000000000000, 700000000000001
    turned = x - sp.atan(sp.Rational(a, b))
    entries = [
        sp.sqrt(a**2 + b**2) * y,
        sp.sqrt(a**2 + b**2) * sin(turned) - b * sin(x) + a * cos(x),
    ]
    problem = sp.Matrix([entries[first], entries[1 - first]])
    assert equal(sp.Add(*problem), entries[0])


def test_factors_of_a_polynomial() -> None:
    """Their product is the polynomial up to a number, and each is irreducible by other means."""
    x, y, a = sp.symbols("x y a")
    for factors in ([(x + y, 2), (x - a, 1), (2 * y**2 - x, 1)], [(x**2 + y**2 - a**2, 3)]):
        product = sp.expand(sp.Rational(-5, 3) * sp.Mul(*(f**n for f, n in factors)))
        found = polynomial_factors(product)
        assert sp.cancel(product / sp.Mul(*(f**n for f, n in found))).is_number
        assert {(sp.Poly(f).monic(), n) for f, n in factors} == {
            (sp.Poly(f).monic(), n) for f, n in found
        }
