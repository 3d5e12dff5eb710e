"""A step of an inverse tells the letters of its lemma from those of the mechanism."""

import pytest
import sympy as sp
from test_latex_sources import article, derivation, stages

from closedform.emit.backends.latex.formulas import Printer
from closedform.emit.backends.latex.prose import Prose
from closedform.emit.backends.latex.roles import primed


@pytest.mark.parametrize(
    ("formula", "letters", "shown"),
    [
        (r"q = m - \sigma\sqrt{r^2 - p^2}", {"r"}, r"q = m - \sigma\sqrt{r'^2 - p^2}"),
        (r"l e^{ix} + (b - ia) e^{iy}", {"x", "b"}, r"l e^{ix'} + (b' - ia) e^{iy}"),
        (r"\operatorname{atan2}(a, b) + \tan a", {"a"}, r"\operatorname{atan2}(a', b) + \tan a'"),
        (r"|\mathbf x| = r_1 x_2", {"x", "r_{1}"}, r"|\mathbf x| = r_1' x_2"),
        (r"\theta + \theta_1", {r"\theta"}, r"\theta' + \theta_1"),
    ],
)
def test_a_prime_stands_at_whole_letters(formula: str, letters: set[str], shown: str) -> None:
    assert primed(formula, letters) == shown


def test_a_letter_that_means_something_else_has_a_prime() -> None:
    (step,) = stages("slider_crank", "ik")
    assert "$l'$ is $r$, $r'$ is $l$, $a$ is $x$" in step["roles"]
    (step,) = stages("slider_crank", "fk")
    assert step["statement"] == [r"q = m - \sigma\sqrt{r'^2 - p^2}"]
    (step,) = stages("five_bar", "ik")
    assert "'" not in step["roles"]


def test_what_an_equation_needs_follows_it() -> None:
    (step,) = stages("delta", "ik")
    assert [row.left for block in step["definitions"] for row in block.rows] == ["k_{1}", "k_{2}"]
    assert [row.left for block in step["role_blocks"] for row in block.rows] == ["s"]
    assert r"\left|k_{2}\right| \le l" in step["exists"]


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("(y - s)**2 + (x - c)**2", r"\left(x - c\right)^{2} + \left(y - s\right)^{2}"),
        ("(b - sin(a))**2 + (d - cos(a))**2", None),
        ("y**2 + (x - b)**2", r"\left(x - b\right)^{2} + y^{2}"),
    ],
)
def test_the_squares_of_a_distance_are_in_the_order_of_coordinates(
    text: str, shown: str | None
) -> None:
    printed = Printer(set()).doprint(sp.sympify(text))
    assert printed == shown if shown else printed.index("cos") < printed.index("sin")


def test_what_vanishes_says_where_it_is_defined() -> None:
    found = article("orthoglide")["singular"]
    (_, first), *_ = found["rank"]
    assert first.endswith(r"B_{11} = 0$, where $B_{11}$ is that of \eqref{eq:orthoglide:18}")
    functions = {f["name"]: f["evaluates"] for f in article("orthoglide")["functions"]}
    assert functions["constraint"] == r"\eqref{eq:orthoglide:14} in each assembly mode"


def test_points_of_a_drawing_are_symbols() -> None:
    prose = Prose(derivation("delta"))
    assert prose("B1a to C1a") == "$B_{1a}$ to $C_{1a}$"
    assert Prose(derivation("four_bar"))("about A1") == "about $A_{1}$"


def test_a_reader_takes_squares_where_a_program_takes_products() -> None:
    (step,) = stages("orthoglide", "ik")
    [last] = [row.right for block in step["solution"] for row in block.rows][-1:]
    assert last.endswith(r"\sqrt{L^{2} - x^{2} - y^{2}}")
    (step,) = stages("rpr_planar", "fk")
    x = next(row.right for b in step["solution"] for row in b.rows if row.left == "x")
    assert x == r"\frac{b^{2} + \rho_{1}^{2} - \rho_{2}^{2}}{2 b}"
