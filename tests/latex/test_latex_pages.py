"""What was seen on the pages of the book and mended; no TeX is needed."""

import re
from functools import cache
from importlib import import_module

import numpy as np
import pytest
import sympy as sp
from closedform.generated.numpy import puma560
from places import ROOT

from closedform.algebra.normal_form import equal
from closedform.emit.backends.latex import symbols
from closedform.emit.backends.latex.angles import same_angle
from closedform.emit.backends.latex.article import Page, document, indexed, tied
from closedform.emit.backends.latex.claims import Claims
from closedform.emit.backends.latex.equations import Numbered, Numbers
from closedform.emit.backends.latex.formulas import FITS, Printer, flat, measure
from closedform.emit.backends.latex.lemmas import clauses, packed
from closedform.emit.backends.latex.prose import Prose, escape, mixed, quoted
from closedform.emit.backends.latex.sheet import Block
from closedform.emit.backends.latex.wide import Lines
from closedform.emit.render import render
from closedform.mechanics import by_axes
from closedform.mechanics.arm import from_dh
from closedform.model.derivation import Derivation, Paper
from closedform.model.functions import real
from closedform.proof.claims import ClaimResult
from closedform.proof.prove import Proof

t1, t2 = (real(f"theta{k}") for k in (1, 2))
x, y = real("x"), real("y")


@cache
def derivation(name: str) -> Derivation:
    found: Derivation = import_module(f"closedform.derivations.{name}").d
    return found


@cache
def context(name: str) -> dict:
    d = derivation(name)
    return document(d, Proof(d.name, d.paper.key, (), 0, ()))


def test_a_length_is_not_printed_as_a_cosine() -> None:
    """c1 of the paper is a length: its sign is not that of cos(theta1)."""
    d = derivation("opw_arm")
    page = Page(d, Proof(d.name, d.paper.key, (), 0, ()))
    cosine = page.math(sp.cos(d.joints[0].symbol))
    lengths = [page.math(p.symbol) for p in d.parameters]
    assert cosine == r"\mathrm{c}_{1}" and cosine not in lengths
    assert len(set(lengths)) == len(lengths)


def test_a_parameter_that_looks_like_a_cosine_is_an_error() -> None:
    d = Derivation("awkward", "Awkward", derivation("scara").paper, "A link.")
    d.parameter("c1", value=sp.Integer(1), unit="m", meaning="length", source="example")
    theta = d.joint("theta1")
    page = Page(d, Proof(d.name, d.paper.key, (), 0, ()))
    page.math(sp.cos(theta))
    with pytest.raises(ValueError, match="cannot be told apart"):
        symbols.require_distinct(d, page.math, page.legend())


@pytest.mark.parametrize("name", ["puma560", "scara"])
def test_statements_of_lemmas_break_between_formulas(name: str) -> None:
    """Each line fits, and no formula is torn: brackets balance and no line ends with a sign."""
    for inverse in context(name)["inverses"]:
        for stage in inverse["stages"]:
            for line in stage["statement"]:
                assert measure(line) <= FITS + 3
                assert line.count("(") == line.count(")")
                assert not re.search(r"[-+=]$", line.strip())


def test_clauses_end_at_the_spaces_outside_of_brackets() -> None:
    text = r"(a,\ b) = \frac{1}{(c,\ d)},\ e = f,\quad g = 1;\quad h"
    assert clauses(text) == [r"(a,\ b) = \frac{1}{(c,\ d)},", "e = f,", "g = 1;", "h"]
    assert packed("", ["a" * 50, "b" * 50]) == ["a" * 50, "b" * 50]
    assert packed("", ["a", "b"]) == [r"a\quad b"]


def test_symbols_of_a_kind_share_a_row() -> None:
    rows = [(f"A_{{{k}}}", rf"see \eqref{{eq:r:{k}}}") for k in (1, 2, 3)]
    rows += [("f", r"see \eqref{eq:r:9}"), ("x", "task coordinate"), ("y", "task coordinate")]
    assert symbols.joined(rows) == [
        (r"A_{1},\ A_{2},\ A_{3}", r"see \eqref{eq:r:1}--\eqref{eq:r:3}"),
        ("f", r"see \eqref{eq:r:9}"),
        (r"x,\ y", "task coordinates"),
    ]


def test_a_function_refers_to_the_matrix_that_a_step_shows() -> None:
    """The Jacobians of the IRB 260 hold rho, which has a name, and stood on the page twice."""
    functions = {f["name"]: f for f in context("irb260")["functions"]}
    for name in (r"jacobian", r"jacobian\_space", r"jacobian\_body", "determinant"):
        assert functions[name]["evaluates"].startswith(r"\eqref") and not functions[name]["blocks"]


def test_a_coordinate_is_not_told_by_itself() -> None:
    functions = {f["name"]: f for f in context("scara")["functions"]}
    [block] = functions["fk"]["blocks"]
    assert all(row.left not in row.right for row in block.rows if row.left == r"\psi")


def test_a_condition_is_called_not_equated() -> None:
    numbers = Numbers("r")
    [row] = numbers.number([[(r"\psi = 0:", "x = 1")]])
    assert row.called and not numbers.defined
    assert r"\psi = 0: \quad" in str(Block((row,)))
    assert Numbered("x", "1").text == "x = 1"


def test_names_of_parts_are_not_given_twice() -> None:
    lines = Lines(Printer(set()), ())
    wide = sp.expand((x + y) ** 9) / (1 + sp.expand((x - 2 * y) ** 9))
    first = {left for left, _ in lines.equations("F", wide) if left.startswith("u")}
    lines.clear(spend=True)
    second = {left for left, _ in lines.equations("G", wide + 1) if left.startswith("u")}
    assert first and second and not first & second


@pytest.mark.parametrize(
    ("evidence", "text"),
    [
        (r"$\frac{\pi}{2}$", r"\pi/2"),
        (r"$\frac{3 \sqrt{23}}{2}$", r"3 \sqrt{23}/2"),
        (r"$\frac{a + b}{2}$", r"\frac{a + b}{2}"),
        ("L0 <= 2 L1: proved", r"L_{0} \le  2 L_{1}$: proved"),
        ("for k = 1, 2", "for k = 1, 2"),
        ("depends on theta2", r"depends on $\displaystyle \theta_{2}$"),
    ],
)
def test_evidence_stands_in_a_line(evidence: str, text: str) -> None:
    d = derivation("hybrid_five_bar")
    assert text in Claims(d, Proof(d.name, d.paper.key, (), 0, ())).told(evidence)


@pytest.mark.parametrize(
    ("robot", "text", "latex"),
    [
        ("irb260", "here elbow_up means", r"here \texttt{elbow\_up} means"),
        ("irb260", "where ik has a branch", r"where \texttt{ik} has a branch"),
        ("puma560", "and [p]_× the matrix", r"and $[p]_\times$ the matrix"),
        ("slider_crank", "reaches the point B1 with", "point $B_{1}$ with"),
        ("three_prs", "at a point, a is free", "at a point, $a$ is free"),
        ("three_prs", "a line of length a.", "a line of length $a$."),
    ],
)
def test_code_and_points_in_a_sentence(robot: str, text: str, latex: str) -> None:
    assert latex in Prose(derivation(robot))(text)


def test_angles_in_a_table_stand_in_a_line() -> None:
    table = next(s["rows"] for s in context("puma560")["steps"] if s["rows"])
    assert table[1][2] == r"$\displaystyle \pi/2$" and len(table) == 7


def test_an_angle_whose_name_is_a_word_is_a_symbol_in_sentences() -> None:
    steps = context("opw_arm")["inverses"][0]["stages"]
    told = " ".join(s["degenerate"] for s in steps)
    assert r"the axis of $\varphi$" in told and "axis of lower" not in told


def test_a_vector_called_by_its_coordinates_has_them_as_names() -> None:
    lines = Lines(Printer(set()), ())
    wide = [sum(sp.sin(n * x + k) * y**n for n in range(12)) for k in (1, 2)]
    rows = lines.equations("(r, h)_T", sp.Matrix(wide))
    assert [left for left, _ in rows if left] == ["r_{T}", "h_{T}"]


def test_tall_rows_have_space_between_them() -> None:
    tall = Numbered("A", r"\begin{bmatrix} 1 \\ 2 \end{bmatrix}")
    fraction, flat = Numbered("a", r"\frac{b}{c}"), Numbered("b", "c")
    gaps = re.findall(r"\\\\(\[\dpt\])?\n", str(Block((tall, flat, flat, fraction))))
    assert gaps == ["[4pt]", "", "[2pt]"]


def test_an_arm_of_six_joints_tells_its_twists_by_the_geometric_jacobian() -> None:
    """The article says how J_s and J_b follow from J; the printed functions agree with it."""
    shown = dict(next(s for s in derivation("puma560").steps if s.title == "Jacobians").shown)
    assert isinstance(shown["J_s"], str) and isinstance(shown["J"], sp.MatrixBase)
    q = np.array([0.3, -0.7, 1.1, 0.4, 0.9, -1.3])
    J, T = puma560.jacobian(q), puma560.pose(q)
    R, (px, py, pz) = T[:3, :3], T[:3, 3]
    cross = np.array([[0, -pz, py], [pz, 0, -px], [-py, px, 0]])
    shift = np.block([[np.eye(3), cross], [np.zeros((3, 3)), np.eye(3)]])
    turn = np.block([[R.T, np.zeros((3, 3))], [np.zeros((3, 3)), R.T]])
    assert np.allclose(puma560.jacobian_space(q), shift @ J, rtol=0, atol=1e-14)
    assert np.allclose(puma560.jacobian_body(q), turn @ J, rtol=0, atol=1e-14)


@pytest.mark.parametrize(("modified", "sign", "last"), [(0, 1, "i-1"), (1, 1, "i"), (0, -1, "")])
def test_columns_follow_from_axes_that_the_motions_turn_about(modified, sign, last, monkeypatch):
    """Of a joint that turns against its axis, the column has another sign."""
    monkeypatch.setattr(by_axes, "ENTRIES", 0)
    d = Derivation("arm", "Arm", Paper("toy", "Toys", ("A.",)), "An arm.")
    q = [d.joint("theta1"), d.joint("theta2")]
    rows = [(1, sp.pi / 3, 2, sign * q[0]), (3, sp.pi / 5, 1, sign * q[1])]
    arm = from_dh(d, rows, modified=bool(modified))
    found = by_axes.by_axes(d, arm.pose, arm.moves, q)
    assert (found is not None) == bool(last)
    if found:
        assert found.jacobian[by_axes.AXIS].endswith(rf"A_{{{last}}}")
        assert all(bool(equal(a, b)) for a, b in found.equal(arm.pose, arm.geometric))


def test_the_book_explains_a_status_once() -> None:
    chapter = render("latex/robot.tex.jinja", context("scara"))
    as_article, _, rest = chapter.partition(r"\begin{document}")
    assert r"\textsc{unreachable} & the target" in as_article
    assert r"\textsc{unreachable} & the target" not in rest and r"\statuses" in rest


def test_a_function_that_an_equation_defines_is_not_listed() -> None:
    """Its statements are those of a program; the equations of the step say what it computes."""
    told = context("three_prs")
    shown = {f["name"].replace("\\", ""): f for f in told["functions"]}
    for name in ("jacobian_parallel", "jacobian_serial", "jacobian", "determinant"):
        assert shown[name]["evaluates"].startswith(r"\eqref{") and not shown[name]["lines"]
    assert not told["singular"]["lines"] and len(told["singular"]["rank"]) == 5


TEX = ROOT / "generated" / "latex"


def test_a_row_of_the_notation_says_what_its_symbol_is() -> None:
    rows = [
        line
        for path in TEX.glob("*.tex")
        for line in path.read_text("utf-8").splitlines()
        if re.match(r"\$.*\$ & see ", line)
    ]
    assert rows == []


def test_symbols_with_one_meaning_keep_it_in_their_row() -> None:
    rows = [(f"A_{{{k}}}", rf"a motion, see \eqref{{eq:r:{k}}}") for k in (1, 2, 3)]
    rows += [("B_{1}", r"a force, see \eqref{eq:r:4}"), ("B_{2}", r"a torque, see \eqref{eq:r:5}")]
    assert symbols.joined(rows) == [
        (r"A_{1},\ A_{2},\ A_{3}", r"a motion, see \eqref{eq:r:1}--\eqref{eq:r:3}"),
        *rows[3:],
    ]


def test_no_distance_of_two_points_is_an_equation() -> None:
    """The skeleton was printed as ``|base - corner1| = h``."""
    for path in TEX.glob("*.tex"):
        assert r"|\text{" not in path.read_text("utf-8"), path.name


@pytest.mark.parametrize(
    ("text", "latex"),
    [
        ("the *singularity locus* of P", r"the \emph{singularity locus} of P"),
        ("as *i*) it is", r"as \emph{i}) it is"),
        ("A*T*B and 4*4", "A*T*B and 4*4"),
        ("Link a^i θ^i", r"Link $a^{i}$ $\theta^{i}$"),
        ("0p_n is the position", "${}^0p_{n}$ is the position"),
        ("the coordinates (x, y, z)_R are", "the coordinates $(x, y, z)_{R}$ are"),
    ],
)
def test_a_quotation_is_set_as_the_paper_prints_it(text: str, latex: str) -> None:
    assert quoted(text) == latex


def test_the_size_of_a_matrix_has_a_cross() -> None:
    assert escape("a 4x4 matrix, and 0x10") == r"a 4$\times$4 matrix, and 0x10"


def test_the_rate_of_a_target_is_a_differential() -> None:
    assert Prose(derivation("delta"))("It is A*dp = B*dq.") == (
        r"It is $A\,\mathrm{d}\mathbf p = B\,\mathrm{d}q$."
    )


def test_points_in_the_errata_are_written_as_in_the_derivation() -> None:
    written = Prose(derivation("hybrid_five_bar")).with_points
    told = written("A test of P.  A path from A meets AB at (0, 1); A controller waits.")
    assert told == (
        r"A test of $P$.  A path from $A$ meets $\mathit{AB}$ at (0, 1); A controller waits."
    )
    assert written("A and B turn", first=False) == "$A$ and $B$ turn"


def test_a_matrix_with_the_letter_of_a_point_is_bold() -> None:
    prose = Prose(derivation("hybrid_five_bar"))
    told = prose("A is on AB, and det(𝐀) = 0 if CD = 2*h: 𝐀*dp = 𝐁*dq has the rows of 𝐀.")
    assert told == (
        r"$A$ is on $\mathit{AB}$, and $\det(\mathbf A) = 0$ if $\mathit{CD} = 2\,h$: "
        r"$\mathbf A\,\mathrm{d}\mathbf p = \mathbf B\,\mathrm{d}q$ has the rows of $\mathbf A$."
    )
    assert symbols.matrix_of("B_{22}", {r"\mathbf{B}"}) == r"\mathbf{B}"
    assert symbols.matrix_of("J_{s,12}", {"J_{s}"}) == "J_{s}"
    assert symbols.matrix_of("B_{22}", {"A"}) == ""


def test_a_vector_of_the_formulas_is_bold_in_sentences() -> None:
    told = Prose(derivation("rpr_planar"))("A2 is at b, and p - b_1 has the length rho1.")
    assert r"at $b$, and $\mathbf p - \mathbf b_1$ has" in told  # b is also a parameter


def test_an_angle_that_is_another_one_is_told_once() -> None:
    a, b = real("a"), real("b")
    assert same_angle([sp.sin(a), sp.cos(a)], [sp.sin(b), sp.cos(b)]) == b
    assert same_angle([sp.sin(a), sp.cos(a)], [sp.cos(b), sp.sin(b)]) is None
    assert same_angle([sp.sin(a)], [sp.sin(b)]) is None


def test_a_sum_of_products_is_grouped() -> None:
    """k_1 of the planar arm was M*l1 + M*l2 + N*l1 - N*l2."""
    l1, l2, M, N = (real(n) for n in ("l1", "l2", "M", "N"))
    tidied = Lines(Printer(()), ()).tidy(M * l1 + M * l2 + N * l1 - N * l2)
    assert tidied in (M * (l1 + l2) + N * (l1 - l2), l1 * (M + N) + l2 * (M - N))


def test_the_entries_of_a_diagonal_share_a_row() -> None:
    rows = [(f"B_{{{k}{k}}}", rf"entry, see \eqref{{eq:x:{k}}}") for k in (1, 2, 3)]
    whole = [(r"B_{11},\ B_{22},\ B_{33}", r"entry, see \eqref{eq:x:1}--\eqref{eq:x:3}")]
    assert symbols.joined(rows) == whole
    assert symbols.joined([rows[0], rows[2]]) == [rows[0], rows[2]]
    fourth = ("B_{44}", r"entry, see \eqref{eq:x:4}")
    assert symbols.joined([*rows, fourth])[0][0] == r"B_{11},\ \ldots,\ B_{44}"


@pytest.mark.parametrize(
    ("title", "entry"),
    [
        ("The loop", "loop"),
        ("Inverse: the elbow", "inverse kinematics!elbow"),
        ("Centre of the wrist", "centre of the wrist"),
        ("Jacobian and its determinant", "Jacobian and its determinant"),
        ("Velocity: A and B", "velocity!A and B"),
        ("Forward: P from two circles", "forward kinematics!P from two circles"),
    ],
)
def test_no_entry_of_the_index_starts_with_an_article(title: str, entry: str) -> None:
    assert indexed(title) == entry


def test_the_number_of_a_model_stays_on_its_line_in_a_title() -> None:
    assert tied("ABB IRB 260 palletiser") == "ABB IRB~260 palletiser"
    assert tied("Planar 2R arm") == "Planar 2R arm"


def test_results_that_are_arguments_are_told_in_one_sentence() -> None:
    """What the summary tells is not told again, and the others stand in one line."""
    functions = {f["name"].replace("\\", ""): f for f in context("irb2400")["functions"]}
    found = functions["joints_from_motors"]
    assert r"$\theta_{3} = m_{3} - m_{2}$" in found["summary"]
    assert found["blocks"] == []
    left, right = found["same"].split(" = ")
    assert left.count(r"\theta_") == right.count("m_") == 5


def test_few_results_that_are_arguments_stay_equations() -> None:
    d = Derivation("toy", "Toy", derivation("scara").paper, "A turn of three joints.")
    a, b, c = (d.joint(f"theta{k}") for k in (1, 2, 3))
    motors = [real(f"m{k}") for k in (1, 2, 3)]
    d.function(
        "motors", "Angles of the motors.", {"q": (a, b, c)}, {"m": [a, b, b + c]}, entries=motors
    )
    (found,) = document(d, Proof(d.name, d.paper.key, (), 0, ()))["functions"]
    assert found["same"] == "" and found["blocks"]


def test_tables_of_a_mechanism_are_as_wide_as_the_text_and_no_box_stands_alone() -> None:
    text = render("latex/robot.tex.jinja", context("scara"))
    mechanism = text[text.index(r"\section{Mechanism}") : text.index(r"\section{Notation}")]
    assert mechanism.count(r"\begin{fulltable}") == mechanism.count(r"\endhead") == 2
    notation = text[text.index(r"\section{Notation}") : text.index(r"\section{Derivation}")]
    (measured,) = re.findall(r"\\symbols\{(.*)\}\n", notation)
    assert all(rf"\widest{{{s}}}" in measured for s in re.findall(r"(?m)^(\$.*?\$) & ", notation))
    box = re.search(r"\\newcommand\{\\proofend\}.*", text)
    assert box and r"\nobreak\hskip1em" in box[0] and "penalty" not in box[0]
    assert text.count(r"\square") == 1


def test_lines_of_a_formula_start_below_the_words_that_lead_to_them() -> None:
    lines = r"$\begin{aligned} a &= b \\ &= c \end{aligned}$"
    assert mixed(lines, led=True).startswith(r"\newline ")
    assert r"\newline" not in mixed(lines) + mixed("$a$", led=True)


def test_a_remark_is_not_broken_where_a_line_can_hold_it() -> None:
    style = render("latex/robot.tex.jinja", context("scara"))
    remark = re.search(r"\\newcommand\{\\remark\}\[1\]\{\\sbox.*\n.*", style)
    assert remark and r"\usebox{\fitbox}" in remark[0] and r"\remark{#3}" in style


def test_half_an_angle_in_a_line_has_brackets() -> None:
    """A distance in a table was 2 r |sin b/2|."""
    assert flat(r"2 r |\sin \frac{\beta_{1}}{2}|") == r"2 r |\sin(\beta_{1}/2)|"
    assert flat(r"\cos \frac{a - b}{2} + \frac{1}{2}") == r"\cos((a - b)/2) + 1/2"


def test_figures_stand_beside_what_they_show() -> None:
    """The mechanism above the tables of its letters; the branches of ik at ik, not at fk."""
    text = render("latex/robot.tex.jinja", context("slider_crank"))
    assert text.index(r"\figuresof{slider_crank}") < text.index("Parameter & Name")
    (at_ik,) = (m.start() for m in re.finditer(r"\\figuresat{ik}\n\n\\topic", text))
    assert at_ik > text.index(r"\subsection{Function \texttt{ik}}")


def test_a_symbol_without_an_equation_of_its_own_is_in_the_notation() -> None:
    """A block of a matrix, of which a determinant is shown, and the parts of a target."""
    known = dict(context("franka_arm")["symbols"])
    assert known[r"J_{\hat{7}}"] == r"$J$ without the column of $\theta_{7}$"
    assert known["R"] == "rotation in $T$" and known["p"] == "position in $T$"
    assert "R_{ij}" in known
    assert dict(context("puma560")["symbols"])["p"].startswith("centre of the wrist")


def test_an_argument_is_not_called_as_a_coordinate() -> None:
    """x of ik(x) is not the coordinate x."""
    (first, _) = context("planar_2r")["inverses"]
    assert first["given"] == r"$\displaystyle \mathtt{x} = (p_{x},\ p_{y})$"
    (there,) = first["continua"]
    assert there["locus"].startswith(r"$\displaystyle p_{x} = 0$, $\displaystyle p_{y} = 0$")


def test_a_continuum_says_what_is_arbitrary_and_what_holds() -> None:
    text = render("latex/robot.tex.jinja", context("spherical_wrist"))
    assert r"is free where, for some $\psi$," in text
    assert r"All solutions share $\theta_4+\theta_6$" in text
    assert r"All solutions satisfy $\theta_2 = \pi$" in render(
        "latex/robot.tex.jinja", context("planar_2r")
    )


def test_a_note_of_many_functions_is_printed_once() -> None:
    """Seven functions of a delta robot repeated the same sentence."""
    text = render("latex/robot.tex.jinja", context("delta"))
    assert text.count("NaN for an assembly mode that does not exist.") == 1
    line = next(line for line in text.splitlines() if "mode that does not exist" in line)
    assert r"\texttt{jacobian\_serial}" in line and r"\texttt{fk}" not in line


def test_a_singular_entry_refers_to_its_matrix_and_not_to_a_special_design() -> None:
    """B_33 led to the equation for unequal legs, and B_22 to none."""
    rank = [formula for _, formula in context("hybrid_five_bar")["singular"]["rank"]]
    places = [re.findall(r"\\eqref\{[^}]*\}", f) for f in rank if "B_" in f]
    assert len(places) == 2 and places[0] and places[0] == places[1]


def test_a_symbol_that_no_equation_defines_is_in_the_notation() -> None:
    """The condition number was a quotient of two letters that nothing introduced."""
    meanings = dict(context("spherical_five_bar")["symbols"])
    assert meanings[r"\varsigma_{1}"] == "largest singular value of $Q$"


@pytest.mark.parametrize("name", ["h6ar", "h6ar_loop_closed", "three_prs", "hybrid_five_bar"])
def test_a_row_of_the_notation_does_not_lean_on_its_neighbours(name: str) -> None:
    """The rows are sorted by letter: these, the same and there mean nothing in them."""
    leaning = re.compile(r"\b(these|those lengths|the same|from there|that plane)\b")
    assert not [m for _, m in context(name)["symbols"] if leaning.search(m)]


def test_a_continuum_says_where_in_coordinates_and_for_which_angles() -> None:
    """``x = (0, 0, 0)`` had the coordinate x for the target, and beta was nowhere introduced."""
    at_pivot = [c["locus"] for i in context("hybrid_five_bar")["inverses"] for c in i["continua"]]
    assert "x = 0$" in at_pivot[1] and "(0" not in at_pivot[1]
    over = [c["any"] for i in context("irb260")["inverses"] for c in i["continua"]]
    assert over == ["", r"$\beta$"]


@pytest.mark.parametrize("name", ["planar_2r", "hybrid_five_bar", "irb260", "h6ar"])
def test_a_section_of_the_paper_is_not_taken_for_one_of_the_book(name: str) -> None:
    """Section 2.6 was that of the paper, but a chapter of the book has a section 2.6 too."""
    told = [step["reason"] for step in context(name)["steps"]]
    assert not [t for t in told if re.search(r"[Ss]ection \d(?!.{0,8}of the paper)", t)]


def test_lines_through_points_are_written_as_the_points_are() -> None:
    """The bars AC and BD were upright, P and A slanted, and CD was once a name of the code."""
    prose = Prose(derivation("hybrid_five_bar"))
    assert prose("to the left of CD: a turn about AB") == (
        r"to the left of $\mathit{CD}$: a turn about $\mathit{AB}$"
    )


def test_the_claims_follow_the_sections_of_the_paper() -> None:
    """The conclusions stood between the introduction and section 2."""
    d = derivation("h6ar")
    assert {c.where for c in d.claims} <= {*d.paper.sections}
    late = next(c for c in d.claims if c.where.startswith("5"))
    assert d.claims.index(late) < len(d.claims) - 1  # it is judged earlier
    results = tuple(
        ClaimResult(
            label=c.label, where=c.where, printed="", kind="proved", evidence="", corrected=""
        )
        for c in d.claims
    )
    rows = Claims(d, Proof(d.name, d.paper.key, (), 0, (), claims=results), []).rows()
    assert [r["where"] for r in rows if r["heading"]] == [*map(escape, d.paper.sections)]


def test_a_note_of_many_functions_is_told_once() -> None:
    text = render("latex/robot.tex.jinja", context("five_bar"))
    section = text.partition(r"\section{Functions}")[2]
    assert section.count("NaN for an assembly mode that does not exist.") == 1
    assert r"\texttt{jacobian\_parallel}" in section.partition("NaN for an assembly mode")[0]
    assert section.count("Not finite at a parallel singularity.") == 2


def test_the_parts_of_a_target_are_one_list() -> None:
    first = context("irb2400")["inverses"][0]["stages"][0]["from"]
    assert first.startswith("From $p_{x}$, $p_{y}$, $R_{13}$ and $R_{23}$ of the forward map")


def test_the_figure_of_a_mechanism_follows_its_description() -> None:
    """Below the tables it was pushed behind the notation, three pages from its text."""
    text = render("latex/robot.tex.jinja", context("h6ar"))
    assert text.index(r"\figuresof{h6ar}") < text.index("Parameter & Name")


def test_coordinates_of_one_point_share_a_row() -> None:
    symbols = [form for form, _ in context("h6ar")["symbols"]]
    assert r"x,\ y,\ z" in symbols and r"x_{T},\ y_{T},\ z_{T}" in symbols


def test_a_lemma_names_what_its_formula_contains() -> None:
    """The signs tau and the products C and S of the agile wrist were in no sentence."""
    (fk,) = (i for i in context("agile_wrist")["inverses"] if i["name"] == "fk")
    told = str(fk)
    assert "is $" in told and all(rf"${letter}$ is $" in told for letter in ("C", "S"))


def test_an_inverse_that_always_answers_says_so() -> None:
    """Instead of a map of the workspace, which would have one colour."""
    told = {
        name: next(f["reached"] for f in context(name)["inverses"] if f["name"] == "ik")
        for name in ("spherical_wrist", "planar_2r")
    }
    assert told == {
        "spherical_wrist": "Every orientation is reached in every branch: the workspace has no "
        "boundary.",
        "planar_2r": "",
    }


def test_bookmarks_are_plain_text() -> None:
    """A formula in a heading has a plain version, which a viewer shows beside the page."""
    heading = re.compile(r"\\(?:sub)*section\{(.*\$.*)\}$", re.M)
    found = [
        h
        for path in ROOT.glob("generated/latex/*.tex")
        for h in heading.findall(path.read_text("utf-8"))
    ]
    assert found
    for text in found:
        plain = re.fullmatch(r"\\texorpdfstring\{.*\}\{(.*)\}", text)[1]
        assert not re.search(r"\$|\\(?!_|&|%|textasciicircum)", plain), plain
