"""Formulas in the order in which a person writes them, on all pages and piece by piece."""

import re
from importlib import import_module
from itertools import permutations
from pathlib import Path

import pytest
import sympy as sp
from places import ROOT

from closedform.emit.backends.latex.article import Page
from closedform.emit.backends.latex.equations import Numbers, parts_first
from closedform.emit.backends.latex.formulas import Printer
from closedform.emit.backends.latex.inequalities import equality, inequalities
from closedform.emit.backends.latex.inverse import without_turns
from closedform.emit.backends.latex.prose import Prose, mixed
from closedform.emit.backends.latex.sheet import Sheet
from closedform.emit.backends.latex.symbols import joined
from closedform.emit.backends.latex.wide import Lines
from closedform.model.derivation import Derivation, Paper
from closedform.model.functions import real

GENERATED = ROOT / "generated" / "latex"
ARTICLES = sorted(p for p in GENERATED.glob("*.tex") if p.stem != "closedform")
each = pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
a, b, x, y = (real(n, nonnegative=True) for n in ("a", "b", "x", "y"))


@pytest.fixture
def sheet() -> Sheet:
    d = Derivation("arm", "Arm", Paper("key", "Title", ("Author",)), "Two links.", task=["x", "y"])
    d.parameter("l1", value=2, unit="m", meaning="length")
    d.parameter("l2", value=1, unit="m", meaning="length")
    return Sheet(d)


def outside_parentheses(text: str) -> str:
    while (shorter := re.sub(r"\([^()]*\)|\{[^{}]*\}", "", text)) != text:
        text = shorter
    return text


def test_an_index_that_is_a_word_is_upright() -> None:
    assert mixed("$l_{off}$") == r"$\displaystyle l_{\mathrm{off}}$"
    assert mixed("$P_{xyz} + R_{uvw} + g_{st}$") == r"$\displaystyle P_{xyz} + R_{uvw} + g_{st}$"


# All articles


@each
def test_what_is_subtracted_stands_on_the_other_side(tex: Path) -> None:
    solved = tex.read_text("utf-8").partition(r"\topic{Step 1")[2]
    rows = re.findall(r"^(.*?) &= (.*?) \\label", solved, re.M)
    assert not [left for left, _ in rows if left == "0"]
    assert not [left for left, right in rows if right == "0" and "-" in outside_parentheses(left)]


@each
def test_bounds_of_one_quantity_are_a_chain(tex: Path) -> None:
    for line in re.findall(r"\\textbf\{unless\} (.*?): ", tex.read_text("utf-8")):
        bounds = [b.split(r" \le ") for b in re.findall(r"\$([^$]*)\$", line)]
        pairs = [b for b in bounds if len(b) == 2]
        assert not [p for p, q in permutations(pairs, 2) if p[0] == q[1]], line


@each
def test_parts_of_a_formula_stand_before_it(tex: Path) -> None:
    """They followed it, so that a name was used before it was defined."""
    derived = tex.read_text("utf-8").partition(r"\section{Inverse")[0]
    for display in re.findall(r"\\begin\{align\}(.*?)\\end\{align\}", derived, re.S):
        for part in re.finditer(r"^(u_\{\d+\}) &=", display, re.M):
            assert part[1] not in display[: part.start()], display


def test_what_an_equation_contains_is_defined_before_it() -> None:
    """Except entries of a matrix, and an equation that is solved for the name it defines."""
    rows = [("v", "[v_{1} v_{2}]"), ("v_{1}", "a u_{1}^{2}"), ("", "+ v_{12}"), ("u_{1}", "b")]
    rows.append(("v_{2}", "u_{1}"))
    assert parts_first(rows) == [rows[0], rows[3], rows[1], rows[2], rows[4]]
    product = [("T = A B", "x"), ("A", "C"), ("B", "y"), ("C", "z")]
    assert parts_first(product) == [product[k] for k in (3, 1, 2, 0)]
    solved = [("L", r"\sin \theta"), (r"\theta", r"\arcsin L")]
    assert parts_first(solved) == solved


def test_an_equation_is_known_in_another_spelling() -> None:
    """Squares of one length were printed twice, because one had braces."""
    numbers = Numbers("arm")
    numbers.number([[("r^{2}", "x^2 + y_1")]])
    assert numbers.is_shown([("r^2", "x^{2} + y_{1}")]) == numbers.with_right("x^{2} + y_1") != ""


@each
def test_what_is_proved_of_a_loop_is_told_of_its_equations(tex: Path) -> None:
    """The forward map of a loop was said to satisfy the forward map."""
    found = re.findall(r"Sound: every branch, substituted into the (\w+)", tex.read_text("utf-8"))
    d = import_module(f"closedform.derivations.{tex.stem}").d
    assert {*found} <= {"equations" if d.loop else "forward"}


@each
def test_halves_of_symbols_are_one_fraction(tex: Path) -> None:
    half = r"\\frac\{[^{}]*(?:\{[^{}]*\})?[^{}]*\}\{2\}"
    text = re.sub(r"\\pi", "", tex.read_text("utf-8"))
    assert not re.search(rf"[^ ] [+-] {half} [+-] {half}", text)


@pytest.mark.parametrize(
    ("value", "printed"),
    [
        (x + a / 2 + b / 2, r"\frac{a + b}{2} + x"),
        (x - a / 2 - b / 2, r"x - \frac{a + b}{2}"),
        (x - a / 2 + b / 2, r"\frac{b - a}{2} + x"),
        (x + a / 2 + b / 3, r"\frac{a}{2} + \frac{b}{3} + x"),
    ],
)
def test_halves_are_added_above_one_line(value: sp.Expr, printed: str) -> None:
    assert Printer(set()).doprint(value) == printed


@each
def test_a_part_of_a_formula_has_one_meaning(tex: Path) -> None:
    steps = re.sub(
        r"\\begin\{algorithm\}.*?\\end\{algorithm\}", "", tex.read_text("utf-8"), flags=re.S
    )
    rows = re.findall(r"^(u_\{\d+\}) &= (.*?)(?: \\label.*| \\\\.*)?$", steps, re.M)
    rows += re.findall(r"\\longformula\{(u_\{\d+\}) = (.*)\}", steps)
    assert len({*rows}) == len({name for name, _ in rows}), rows


@each
def test_no_angle_of_a_vector_along_the_axis_is_returned(tex: Path) -> None:
    assert r"\operatorname{atan2}(0" not in tex.read_text("utf-8").replace(r"\bigl", "")


@each
def test_a_section_of_a_paper_is_one_part_of_the_table(tex: Path) -> None:
    headings = re.findall(r"\\multicolumn\{3\}.*\\bfseries\\small (.*)", tex.read_text("utf-8"))
    assert len(headings) == len({*headings})


def test_half_sums_are_those_that_a_step_defines() -> None:
    for name in ("h6ar", "h6ar_loop_closed"):
        text = (GENERATED / f"{name}.tex").read_text("utf-8")
        steps, _, rest = text.partition(r"\section{Inverse kinematics}")
        assert r"\mu_2 &= \frac{\theta_2^L + \theta_2^R}{2}" in steps
        assert r"\cos \delta_{23}" in rest and r"\theta_2^L + \theta_2^R" not in rest


def test_an_aligned_wrist_has_the_printed_angles() -> None:
    text = (GENERATED / "spherical_wrist.tex").read_text("utf-8")
    assert r"$\theta_{4}$ is free; $\theta_{4} = 0$" in text
    # with theta4 = 0 this is the angle of the remaining rotation
    assert (
        r"\theta_{6} = \operatorname{atan2}(R_{21} \mathrm{c}_{4} - R_{11} \mathrm{s}_{4}" in text
    )


# Piece by piece


def test_bounds() -> None:
    page = Page.__new__(Page)
    page.printer = Printer(set())
    page.math, page.lines = page.printer.math, Lines(page.printer, ())
    told = [
        ([x - a, x + a], r"$\left|a\right| \le x$"),
        ([a - x, x - b], r"$b \le x \le a$"),
        ([a - x**2 - y**2, x**2 + y**2 - b], r"$b \le x^{2} + y^{2} \le a$"),
        ([a - x - y, x + y + a], r"$\left|x + y\right| \le a$"),
        ([a + b - x, a - b + x, b - a + x], r"$\left|a - b\right| \le x \le a + b$"),
    ]
    for values, text in told:
        assert inequalities(page, {x: 0}, values) == [
            text.replace(r"|a\right| \le x", r"|a\right| \le x")
        ]
    assert inequalities(page, {}, [a - x, b - y]) == [r"$x \le a$", r"$y \le b$"]


def test_a_target_is_compared_with_a_length(sheet: Sheet) -> None:
    length = next(iter(sheet.parameters))
    assert equality(sheet, length - x) == equality(sheet, x - length)
    assert equality(sheet, length - x).startswith("$x = ")


def test_numbers_stand_first() -> None:
    math = Printer(set()).math
    assert math(sp.sqrt(3) * a) == r"\sqrt{3} a"
    assert math(sp.sqrt(2) * a / 4) == r"\frac{\sqrt{2} a}{4}"
    assert math(1 + sp.cos(x)) == r"1 + \cos x"
    assert math(2 + sp.cos(x) - sp.cos(y)) == r"2 + \cos x - \cos y"
    assert math(x**2 + 1) == "x^{2} + 1"


def test_entries_of_matrices_stand_behind_lengths() -> None:
    printer = Printer(set())
    printer.parameters = frozenset("a")
    assert printer.math(real("R21") * a) == "a R_{21}"


def test_terms_stand_in_the_order_of_the_letters_that_are_printed() -> None:
    printer = Printer(set())
    printer.written = {"beyond": r"\Delta_z", "width": r"\Delta_x"}
    value = real("beyond") ** 2 + real("width") ** 2
    assert printer.math(value) == r"\Delta_x^{2} + \Delta_z^{2}"


def test_factors_in_a_sentence_are_one_formula(sheet: Sheet) -> None:
    prose = Prose(sheet.derivation)
    assert prose("the product l1 l2 of both") == r"the product $l_{1}\,l_{2}$ of both"
    assert prose("what fk returns") == r"what \texttt{fk} returns"


def test_rows_with_fractions_have_space_and_lines_of_their_own() -> None:
    rows = r"\begin{aligned} x &= \frac{a}{b} \\ y &= b \end{aligned}"
    assert mixed(f"we get ${rows}$") == rf"we get \newline $\displaystyle {rows}$".replace(
        r"\\ ", r"\\[6pt] "
    )
    assert r"\newline" not in mixed(f"${rows}$")


def test_symbols_that_differ_in_a_number_share_a_row() -> None:
    rows = [
        (r"\xi_{1}", r"twist, see \eqref{1}"),
        (r"\xi_{1}'", r"moved, see \eqref{3}"),
        (r"\xi_{2}", r"twist, see \eqref{2}"),
        (r"\xi_{2}'", r"moved, see \eqref{4}"),
    ]
    assert joined(rows) == [
        (r"\xi_{1},\ \xi_{2}", r"twist, see \eqref{1} and \eqref{2}"),
        (r"\xi_{1}',\ \xi_{2}'", r"moved, see \eqref{3} and \eqref{4}"),
    ]


def test_a_vector_along_the_axis_has_no_angle() -> None:
    assert without_turns(sp.atan2(0, sp.sqrt(x - y), evaluate=False)) == 0
    other = sp.atan2(y, sp.sqrt(x), evaluate=False)
    assert without_turns(other) == other
