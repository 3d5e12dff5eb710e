"""The reader of printed formulas: every construct, and errors that show the place."""

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import acos, asin, atan, cos, pi, sin, sqrt

from closedform.algebra.normal_form import equal
from closedform.model.functions import real
from closedform.model.notation import SIGN, Notation, NotationError
from closedform.model.tokens import tokens

a, b, x, y = map(real, "abxy")
one, two = real("theta1"), real("theta2")
T = sp.Matrix([[1, x], [0, 1]])
V = sp.Matrix([1, 2, 3])
NAMES = Notation(
    {
        "a": a,
        "b": b,
        "x": x,
        "y": y,
        r"\theta_1": one,
        r"\theta_2": two,
        r"\theta_{12}": one + two,
        "c_1": cos(one),
        "s": sin,
        r"a \tan 2": sp.atan2,
        "T": T,
        r"{}^0T_1": 2 * T,
        "v": V,
        "w": sp.Matrix([x, 0, 0]),
        "p_1": a,
        "p_2": b,
        r"\hat{v}": -V,
        "^*": lambda value: value + 1,
    }
)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("x + y - 2", x + y - 2),
        ("-x^2", -(x**2)),
        ("2x y", 2 * x * y),
        ("2(x + y)", 2 * (x + y)),
        ("x^2y", x**2 * y),
        ("x^{-1}", 1 / x),
        ("x^{a + 1}", x ** (a + 1)),
        ("1.50", sp.Rational(3, 2)),
        (r"x \cdot y / 2", x * y / 2),
        (r"\frac{x + 1}{2 y}", (x + 1) / (2 * y)),
        (r"\sqrt{x^2 + 1}", sqrt(x**2 + 1)),
        (r"\sqrt[3]{x}", sp.cbrt(x)),
        (r"|x - y|", sp.Abs(x - y)),
        (r"2\left|x\right| y", 2 * sp.Abs(x) * y),
        (r"\pi / 2", pi / 2),
        (r"30^\circ", pi / 6),
        (r"x^{\circ}", x * pi / 180),
        (r"12 \text{ cm}", sp.Integer(12)),
        (r"\left( x \, \right) \quad y", x * y),
        (r"x^*", x + 1),
    ],
)
def test_arithmetic(text: str, value: sp.Expr) -> None:
    assert NAMES.value(text) == value


@pytest.mark.parametrize(
    ("text", "value"),
    [
        (r"\sin x y", sin(x) * y),
        (r"\sin(x) y", sin(x) * y),
        (r"\sin 2x", sin(2 * x)),
        (r"\cos(x + y)^2", cos(x + y) ** 2),
        (r"\cos^2 x", cos(x) ** 2),
        (r"\tan x", sin(x) / cos(x)),
        (r"\sin^{-1} x", asin(x)),
        (r"\cos^{-1}\left(\frac{x}{y}\right)", acos(x / y)),
        (r"\tan^{-1}\frac{x}{y}", atan(x / y)),
        (r"\sin\theta_1\cos\theta_2", sin(one) * cos(two)),
        (r"s\theta_1 c_1", sin(one) * cos(one)),
        (r"s(x + y)", sin(x + y)),
        (r"a \tan 2(y, x)", sp.atan2(y, x)),
    ],
)
def test_functions_have_one_value(text: str, value: sp.Expr) -> None:
    assert NAMES.value(text) == value


def test_the_inverse_tangent_of_a_quotient_has_one_value_of_two() -> None:
    behind = {x: -1, y: 1}
    assert NAMES.value(r"\tan^{-1}\frac{y}{x}").subs(behind) == -pi / 4
    assert NAMES.value(r"a \tan 2(y, x)").subs(behind) == 3 * pi / 4


def test_the_longest_name_wins() -> None:
    assert NAMES.value(r"\theta_1 + \theta_{12}") == 2 * one + two
    assert NAMES.value(r"\theta_{1}") == NAMES.value(r"\theta _1") == one
    assert NAMES.value(r"{}^0T_1") == 2 * T
    assert NAMES.value(r"\hat{v} + v") == sp.zeros(3, 1)


def test_signs() -> None:
    value = NAMES.value(r"x \pm y \mp 1")
    assert value == x + SIGN * y - SIGN
    assert value.subs(SIGN, -1) == x - y + 1


@pytest.mark.parametrize(
    ("text", "value"),
    [
        (r"\begin{bmatrix} 1 & x \\ 0 & 1 \end{bmatrix}", T),
        (r"\left[\begin{array}{c@{}c} 1 & x \\ 0 & 1 \\ \end{array}\right]", T),
        (r"\begin{pmatrix} T & v \end{pmatrix}", None),
        (r"\begin{bmatrix} T & 0 \\ 0 & 1 \end{bmatrix}", sp.diag(T, 1)),
        (r"[1, x; 0, 1]", T),
        (r"[x, y]^T", sp.Matrix([x, y])),
        (r"T^{-1}", sp.Matrix([[1, -x], [0, 1]])),
        (r"2 T^T", 2 * T.T),
        (r"v \cdot w", x),
        (r"v \times w", sp.Matrix([0, 3 * x, -2 * x])),
        (r"T + 0", T),
    ],
)
def test_matrices(text: str, value: sp.Matrix | None) -> None:
    if value is None:
        with pytest.raises(ValueError):
            NAMES.value(text)
    else:
        assert NAMES.value(text) == value


@pytest.mark.parametrize(
    "text",
    [
        r"\begin{cases} x & \text{if } x > 0 \\ -x & \text{otherwise} \end{cases}",
        r"\begin{cases} x, & x > 0 \\ -x, & \text{else} \end{cases}",
    ],
)
def test_cases(text: str) -> None:
    assert NAMES.value(text) == sp.Piecewise((x, x > 0), (-x, True))


def test_sums_over_an_index() -> None:
    assert NAMES.value(r"\sum_{i=1}^{2} p_i x + y") == a * x + b * x + y
    assert NAMES.value(r"\sum_{k=0}^3 k") == 6
    (relation,) = NAMES.read(r"y = \sum_{i=1}^2 i p_{i}")
    assert relation.right == a + 2 * b


def test_relations() -> None:
    (chain,) = NAMES.read(r"0 < x \le y")
    assert chain.sides == (0, x, y) and chain.signs == ("<", "<=")
    (unequal,) = NAMES.read(r"x \neq 1.20")
    assert unequal.signs == ("!=",) and unequal.decimals == 2
    assert unequal.relational == sp.Ne(x, sp.Rational(6, 5), evaluate=False)
    with pytest.raises(NotationError, match="3 sides"):
        _ = chain.relational


def test_a_formula_may_hold_several_relations() -> None:
    found = NAMES.read(r"x = 1, y = 2 \text{ or } a = b; b = 3.")
    assert [(r.left, r.right) for r in found] == [(x, 1), (y, 2), (a, b), (b, 3)]


def test_aligned_lines() -> None:
    text = (
        r"\begin{aligned} x &= y \\ &\quad + a \\ - a + b &= \begin{bmatrix} 1 \\ 2 \end{bmatrix}"
        r"\\ y &= -x \end{aligned}"
    )
    found = [(r.left, r.right) for r in NAMES.read(text)]
    assert found == [(x, y + a), (b - a, sp.Matrix([1, 2])), (y, -x)]


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("", ">>> : a formula is empty"),
        ("x + q", "x +  >>> q: the notation has no such name"),
        ("x = ", "x =  >>> : the formula ends too early"),
        ("(x", "(x >>> : ) is missing"),
        ("x)", "x >>> ): what follows cannot be read"),
        (r"x \foo y", r"x  >>> \foo y: what follows cannot be read"),
        (r"\frac{1}{x", r"\frac{1}{x >>> : } is missing"),
        (r"\sin", r"\sin >>> : the formula ends too early"),
        (
            r"\begin{bmatrix} 1 & 2 \\ 3 \end{bmatrix} + x",
            r"end{bmatrix}  >>> + x: the rows of a matrix differ",
        ),
    ],
)
def test_errors_show_the_place(text: str, place: str) -> None:
    with pytest.raises(NotationError) as error:
        NAMES.read(text)
    assert place in str(error.value)


def test_a_name_must_not_be_empty() -> None:
    with pytest.raises(NotationError):
        Notation({" ": x})


@pytest.mark.parametrize(
    ("text", "sides"),
    [
        (r"\theta_{1} = x^{2}", [r"\theta_{1}", "x^{2}"]),
        (
            r"\left(\frac{x}{y}\right) = \left|x\right|",
            [r"\left(\frac{x}{y}\right)", r"\left|x\right|"],
        ),
        (r"x = 30^{\circ}, y = 1", ["x", r"30^{\circ}"]),
    ],
)
def test_the_text_of_a_side_is_whole(text: str, sides: list[str]) -> None:
    assert list(NAMES.read(text)[0].texts) == sides


def test_pieces_are_the_places_of_misprints() -> None:
    text = r"\theta_{1} = -2\sin(x) + \sqrt{y^{3}} \cdot \theta_{12}"
    found = [(p.kind, text[p.start : p.end], p.name) for p in NAMES.pieces(text)]
    assert found == [
        ("name", r"\theta_{1}", r"\theta_1"),
        ("relation", "=", ""),
        ("sign", "-", ""),
        ("number", "2", ""),
        ("function", r"\sin", ""),
        ("name", "x", "x"),
        ("sign", "+", ""),
        ("name", "y", "y"),
        ("number", "3", ""),
        ("name", r"\theta_{12}", r"\theta_{12}"),
    ]


def test_alternatives_mean_something_else_of_the_same_kind() -> None:
    assert NAMES.alternatives(r"\theta_1")[0] == r"\theta_2"
    assert NAMES.alternatives("p_1")[0] == "p_2"
    assert set(NAMES.alternatives("v")) == {"w", r"\hat{v}"}
    for name in ("x", r"\theta_1", "T"):
        meaning = NAMES.meanings[name]
        assert all(NAMES.meanings[other] != meaning for other in NAMES.alternatives(name))


def test_an_extended_notation_leaves_the_first_alone() -> None:
    more = NAMES.extended({"x": y, "z": a})
    assert more.value("x + z") == y + a
    assert NAMES.value("x") == x
    assert NAMES.extended({}) is NAMES


def test_tokens_know_their_places() -> None:
    text = r"\left( x_{1} \,+ \text{ if } y"
    assert [(t.text, text[t.start : t.after]) for t in tokens(text)] == [
        ("(", r"\left("),
        ("x", "x"),
        ("_", "_"),
        ("1", "1}"),
        ("+", "+"),
        (r"\text", r"\text"),
        ("{ if }", "{ if }"),
        ("y", "y"),
    ]


def test_names_of_the_paper_are_written() -> None:
    assert NAMES.write(sin(one) * x**2) == r"x^{2} \sin \theta_1"
    assert NAMES.write(sp.Matrix([x])) == r"\left[\begin{matrix}x\end{matrix}\right]"


LEAVES = st.sampled_from([x, y, a, one, two, pi]) | st.integers(-3, 12).map(sp.Integer)
EXPRESSIONS = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.tuples(inner, inner).map(lambda pair: pair[0] + pair[1]),
        st.tuples(inner, inner).map(lambda pair: pair[0] * pair[1]),
        st.tuples(inner, st.integers(2, 3)).map(lambda pair: pair[0] ** pair[1]),
        inner.map(lambda e: e / 3),
        inner.map(lambda e: 1 / (e**2 + 1)),
        inner.map(lambda e: sqrt(e**2 + 2)),
        inner.map(sin),
        inner.map(cos),
        inner.map(sp.Abs),
    ),
    max_leaves=6,
)


@settings(max_examples=150, deadline=None)
@given(EXPRESSIONS)
def test_what_is_written_is_read_again(e: sp.Expr) -> None:
    read = NAMES.value(NAMES.write(e))
    assert read == e or equal(read, e)
