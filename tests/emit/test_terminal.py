"""Formulas on a terminal: LaTeX and expressions as text."""

import re

import pytest
import sympy as sp

from closedform.emit.show import show
from closedform.emit.terminal import decimal, expression, from_latex, mixed, paragraph
from closedform.emit.text import wrapped
from closedform.pipeline import scripts


@pytest.mark.parametrize(
    ("latex", "pretty", "ascii"),
    [
        (r"\mu_{23}", "μ_23", "mu_23"),
        (r"\mathbf r\cdot(\mathbf v - \mathbf u)", "r·(v - u)", "r*(v - u)"),
        (r"|\mathbf r|^2 + h^2\,|\mathbf v|^2", "|r|^2 + h^2 |v|^2", "|r|^2 + h^2 |v|^2"),
        (r"\frac{\det B}{\det A}", "(det B)/(det A)", "(det B)/(det A)"),
        (r"\frac{d}{2} A^{-1}B", "d/2 A^-1 B", "d/2 A^-1 B"),
        (r"2 a_2 f\cos\eta", "2 a_2 f cos η", "2 a_2 f cos eta"),
        (r"1 - \cos(\theta)", "1 - cos(θ)", "1 - cos(theta)"),
        (r"\lVert A\rVert_F", "‖A‖_F", "||A||_F"),
        (r"\begin{bmatrix} A & 0 \\[5pt] b & 1 \end{bmatrix}^T", "[A, 0; b, 1]^T", None),
        (r"e^{\hat\xi\theta}", "e^(ξ\u0302θ)", "e^(xi theta)"),
        (r"\phi_{1,\text{crossed}}", "φ_(1,crossed)", "phi_(1,crossed)"),
        (r"[p]_\times", "[p]_×", "[p]_x"),
        (r"\sqrt{a", "sqrt(a)", "sqrt(a)"),
        (r"\begin{bmatrix} a &", "[a]", "[a]"),
        ("", "", ""),
    ],
)
def test_latex_is_read(latex: str, pretty: str, ascii: str | None) -> None:
    assert from_latex(latex) == pretty
    assert from_latex(latex, pretty=False) == (pretty if ascii is None else ascii)


def test_formulas_in_a_sentence() -> None:
    assert mixed(r"Only $\theta_1$ is free.", pretty=False) == "Only theta_1 is free."


def test_cases_are_told_in_words() -> None:
    a, b = sp.symbols("a b")
    cases = sp.Piecewise((a, sp.Eq(b, 0)), (b, True))
    assert expression(cases) == "a if b = 0, else b"
    assert expression(1 + cases) == "(a if b = 0, else b) + 1"


@pytest.mark.parametrize("text", ["0", "2", "-0.375", "0.39225", "2.0943951023931953", "1/3"])
def test_exact_decimals(text: str) -> None:
    assert decimal(sp.Rational(text)) == text


@pytest.mark.parametrize("name", [source.name for source in scripts.sources()])
def test_no_latex_is_left_on_the_page_of_a_mechanism(name: str) -> None:
    (source,) = scripts.find([name])
    page = show(scripts.load(source), None)
    assert not re.search(r"\\[a-z]{2}|mathbf|Piecewise", page)


def test_a_word_with_a_hyphen_stays_on_its_line() -> None:
    assert wrapped("It turns counter-clockwise.", 20) == ["It turns", "counter-clockwise."]


def test_degrees_are_not_an_exponent() -> None:
    assert from_latex(r"-30^\circ") == from_latex(r"-30^{\circ}") == "-30°"
    assert from_latex(r"-30^\circ", pretty=False) == "-30 deg"


def test_plain_text_has_plain_letters() -> None:
    assert paragraph("The rows of 𝐀, and a row of θ.") == ["The rows of A, and a row of θ."]
