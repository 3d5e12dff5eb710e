"""Brackets in brackets, and the sentences that say where a symbol is defined."""

import pytest
import sympy as sp

from closedform.emit.backends.latex.equations import by_equation, defined_in
from closedform.emit.backends.latex.prose import breakable, loosen, symbol_name

a, b, c = sp.symbols("a b c")


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (a * (b + c), "a (b + c)"),
        (a * (b + c * (a + b)), r"a \bigl[b + c (a + b)\bigr]"),
        (
            a * (b + c * (a + b * (a + c))),
            r"a \bigl(b + c \bigl[a + b (a + c)\bigr]\bigr)",
        ),
        (sp.cos(a * (b + c)), r"\cos{(a (b + c))}"),
        (a * (1 - sp.cos(b - c)), r"a \bigl[1 - \cos{(b - c)}\bigr]"),
    ],
)
def test_a_sum_with_parentheses_in_it_has_brackets(value: sp.Expr, shown: str) -> None:
    assert loosen(sp.latex(value)) == shown


def test_a_symbol_is_said_to_be_that_of_an_equation() -> None:
    assert defined_in([r"\Delta"], ["eq:x:4"]) == r"$\Delta$ is that of \eqref{eq:x:4}"
    assert defined_in(["a", "b"], ["eq:x:4", "eq:x:5"]) == (
        r"$a$ and $b$ are those of \eqref{eq:x:4} and \eqref{eq:x:5}"
    )


def test_a_coordinate_is_said_to_be_one_of_its_vector() -> None:
    told = defined_in(["b_{1,x}", "b_{1,y}"], ["eq:x:1"])
    assert told == r"$b_{1,x}$ and $b_{1,y}$ are coordinates of $\mathbf b_1$, see \eqref{eq:x:1}"


def test_names_are_in_the_order_of_their_equations() -> None:
    assert by_equation({"h": "eq:x:12", "u": "eq:x:4"}) == ["u", "h"]


def test_an_entry_of_a_vector_of_a_leg_has_one_line_of_indices() -> None:
    assert symbol_name("r_i1") == "r_{i1}"
    assert symbol_name("v_ik3") == "v_{ik3}"
    assert symbol_name("sigma_leg1") == r"\sigma_{\mathrm{leg}_{1}}"


def test_a_formula_is_broken_between_its_equations_and_not_in_brackets() -> None:
    """A column of the claims had ``sin(x +`` at the end of a line."""
    two = r"y = \sin (x + \gamma) + a, \ \gamma = \frac{a + b}{(c + d)}"
    assert breakable(two) == (
        r"y = \sin (x + \nobreak \gamma) + a,$ $\displaystyle \gamma = \frac{a + b}{(c + d)}"
    )
    cases = r"(a, \ b) = \begin{cases} (c - d), \ e \\[15pt] f \end{cases}"
    assert breakable(cases) == cases
    long = rf"({' + '.join(['a_1 x_1'] * 9)}) + (b + c)"
    assert breakable(long) == long.replace("(b + c)", r"(b + \nobreak c)")
