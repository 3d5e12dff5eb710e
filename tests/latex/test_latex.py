"""The LaTeX article, the notebook cell, the errata and the terminal page."""

import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
import sympy as sp
from places import ROOT

from closedform.emit.backends.latex.article import Page, decimal, default, document
from closedform.emit.backends.latex.claims import derives
from closedform.emit.backends.latex.formulas import Printer, measure
from closedform.emit.backends.latex.prose import (
    Prose,
    escape,
    loosen,
    mixed,
    quoted,
    spaced,
    symbol_name,
)
from closedform.emit.notebook import notebook
from closedform.emit.render import render
from closedform.emit.show import show
from closedform.lemmas.sine_cosine import linear_pair
from closedform.model.claims import Claim, Erratum, Gravity
from closedform.model.derivation import Derivation, Paper, Solved
from closedform.model.functions import Program, branches, choose, real
from closedform.model.inverse import Degenerate, Inverse
from closedform.proof.checks.statements import Undecidable
from closedform.proof.claims import ClaimResult, ErratumResult, ReadingResult
from closedform.proof.prove import InverseResult, Proof, prove

ROBOTS = ("planar_2r", "spherical_wrist")
GENERATED = ROOT / "generated" / "latex"
PAPER = Paper("odd", "Rods & 100 % of #1_x", ("A. Müller", "B_C"), "Proc. {X} ~ 2")


@cache
def derived(name: str) -> tuple[Derivation, Proof]:
    if name == "awkward":
        return awkward()
    module = __import__(f"closedform.derivations.{name}", fromlist=["d"])
    return module.d, prove(module.d)


@cache
def article(name: str) -> str:
    return render("latex/robot.tex.jinja", document(*derived(name)))


def awkward() -> tuple[Derivation, Proof]:
    """A derivation with everything that is hard to print: long, wide, deep and odd characters."""
    d = Derivation("awkward", "Arm & leg_1", PAPER, "It costs 5 % of l1^2, in {sets}: a < b.")
    lengths = [d.parameter(n, value=1, unit="m", meaning="m_1 & n") for n in ("l1", "loff", "gs")]
    theta1, theta2, theta2R = d.joint("theta1"), d.joint("theta2"), d.joint("theta2R")
    d.joint("theta4", passive=True)
    d.joint("theta5", coupling=-theta1 - theta2)
    d.assembly_modes, d.singularities = ("up", "down"), ("A & B",)
    d.task = ["x", "y"]
    angles = [theta1, theta1 + theta2, theta1 - theta2, theta2R]
    long = sum(
        a * sp.sin(t) * sp.cos(u) ** 2 for a in lengths for t in angles for u in angles if t != u
    )
    wide = sp.Matrix(
        4, 6, lambda i, j: sp.cos(theta1 * (i + j)) * lengths[j % 3] * (long if i == j else 1)
    )
    deep = sp.sqrt(long**2 + 1) / (long + sp.sqrt(lengths[0] ** 2 + long) / 2)
    d.step(
        "Everything_& more",
        "Since sqrt(1 - theta1^2) <= 1 and theta1 = pi/6, 100 % of a_1 is {left}.",
        {"x": long, r"J_{xy}": wide, "deep": deep, r"\det A = B": (long, 1)},
        published=("(1)", "Table_I"),
        equal=[(sp.sin(theta1) ** 2, 1 - sp.cos(theta1) ** 2)],
    )
    d.function("singularities", "Factors.", {"q": (theta1, theta2, theta2R)}, {"f": [long, theta1]})
    d.function(
        "deep", "Arrays.", {"q": (theta1, theta2, theta2R)}, {"A": [[[long, 1], [2, long]]] * 2}
    )
    px, py, sigma = real("px"), real("py"), real("sigma_up")
    p = Program()
    h = p.bound("h", sp.sqrt(px**2 + py**2), lengths[0], "within 100 % of reach_1")
    flag = p.vanishes("on_axis", h, 1, "the hand is on the axis", free=(theta1,))
    p.match(px - py, 1, "equal")
    lemma = linear_pair(theta1, py, px)
    d.solved.append(Solved("ik", theta1, lemma, sp.sin(theta1) * px - sp.cos(theta1) * py))
    d.function(
        "ik",
        "Inverse.",
        {"x": (px, py)},
        {
            "q": [
                choose(flag, 0, lemma[theta1]),
                sigma * long.subs({theta1: px, theta2: py, theta2R: h}),
            ]
        },
        program=p,
        branches=branches((sigma, {+1: "up", -1: "down"})),
        result="Solutions",
        notes=("A note & more.",),
    )
    zero = sp.Integer(0)
    case = Degenerate(
        (flag,), {px: zero, py: zero}, theta1, relation=r"\theta_2 = \pi, \theta_1 any"
    )
    d.inverses.append(Inverse("ik", (theta1, theta2), (px, py), (theta1, theta2), (case,)))
    printed = r"$\sin θ_1 = \frac{a}{b}$ with 5 % of “θ1”"
    both = (ReadingResult("all of $a_1$", "refuted", "$1$"), ReadingResult("100 %", "proved", "&"))
    results = (
        ClaimResult(
            label="eq. (1) & 50 %", where="p. 3_4", printed=printed, kind="not decidable here",
            evidence="a < b", corrected="",
        ),
        ClaimResult(
            label="eq. (2)", where="p. 3_4", printed="x_1 is one", kind="refuted",
            evidence=r"at $\theta_1 = 2\pi/3$: 1, not 0", corrected=rf"$x_1 = {sp.latex(long)}$",
            readings=both, erratum="long-one", paraphrase=True,
        ),
        ClaimResult(
            label="Table_I, last row", where="", printed="fine", kind="proved under assumption",
            evidence="$a > 0$", corrected="",
        ),
        ClaimResult(
            label="eq. (3)", where="", printed="fine", kind="proved", evidence="", corrected="",
        ),
    )  # fmt: skip
    wrong = ErratumResult("long-one", "100 % of $x_1$ & more_", "RESULT", "Since $a < b$.", "5 %.")
    inverse = InverseResult(
        function="ik",
        branches=2,
        continua=1,
        solutions=2,
        method="generic",
        assumptions=("px - l1",),
        lemmas=(lemma.name,),
    )
    steps = tuple(s.title for s in d.steps)
    return d, Proof(
        name="awkward",
        paper="odd",
        steps=steps,
        identities=1,
        inverses=(inverse,),
        claims=results,
        errata=(wrong,),
    )


@pytest.mark.parametrize("name", [*ROBOTS, "awkward"])
def test_no_python_shows_through(name: str) -> None:
    text = article(name)
    for sign in ("None", "Symbol(", "{{", "}}}}}", "Piecewise", "Matrix(", "StrEnum", str(ROOT)):
        assert sign not in text
    assert "\\date{}" in text


@pytest.mark.parametrize("name", [*ROBOTS, "awkward"])
def test_every_claim_step_and_function_is_printed(name: str) -> None:
    derivation, proof = derived(name)
    text = article(name)
    for claim in proof.claims:
        assert quoted(claim.label) in text
        assert mixed(claim.printed) in text
    for step in derivation.steps:
        assert f"\\subsection{{{escape(step.title)}}}" in text
    for function in (f for f in derivation.functions if f.name != "skeleton"):
        assert f"\\function{{{escape(function.name)}(" in text
        for label in function.branches.labels if function.branches else ():
            assert escape(label) in text or label == "only"
    page = show(derivation, proof)
    assert all(claim.label in re.sub(r"\s+", " ", page) for claim in proof.claims)


@pytest.mark.parametrize("name", [*ROBOTS, "awkward"])
def test_article_compiles_and_fits(name: str, tmp_path: Path) -> None:
    if shutil.which("pdflatex") is None:
        pytest.skip("pdflatex is not installed")
    (tmp_path / f"{name}.tex").write_text(article(name), encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", f"{name}.tex"]
    for _ in range(2):
        run = subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
        log = run.stdout.decode("utf-8", "replace")
        assert run.returncode == 0, log[-2000:]
    assert (tmp_path / f"{name}.pdf").exists()
    assert "undefined references" not in log
    too_wide = [float(w) for w in re.findall(r"Overfull \\hbox \(([\d.]+)pt", log)]
    assert max(too_wide, default=0) < 20
    assert "Overfull \\vbox" not in log


def test_output_does_not_depend_on_the_hash_seed() -> None:
    script = (
        "import sys; sys.path[:0] = ['tests', 'tests/latex']\n"
        "from test_latex import *\n"
        "d, p = derived('awkward')\n"
        "print(article('awkward'), notebook(d), show(d, p))\n"
        "print(render('errata.md.jinja', context([part(d, p)])))\n"
    )
    runs = [
        subprocess.Popen(
            [sys.executable, "-c", script],
            cwd=ROOT,
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONIOENCODING": "utf-8"},
            stdout=subprocess.PIPE,
        )
        for seed in ("0", "4321")
    ]
    printed = [run.communicate()[0] for run in runs]
    assert printed[0] == printed[1]
    assert len(printed[0]) > 10_000


def test_claims_link_to_the_step_and_the_error() -> None:
    text = article("awkward")
    assert "\\label{step:awkward:1}" in text
    assert r"Table\_I, last row, \eqref{eq:awkward:1}--\eqref{eq:awkward:" in text
    assert r"\hyperref[claim:awkward:1]" not in text
    assert r"\hyperref[claim:awkward:3]{Table\_I}" in text
    assert not re.search(r"eq\. \((1\) \\& 50 \\%|3\)), \\(mbox|eqref)", text)
    assert text.count(r"\label{erratum:awkward:long-one}") == 1
    assert r"\hyperref[erratum:awkward:long-one]{100 \% of $\displaystyle x_1$ \& more\_}" in text
    labels = re.findall(r"\\(?:label|longequation|matrixequation)\{([^}#]+)\}", text)
    assert len(set(labels)) == len(labels)
    assert set(re.findall(r"\\(?:(?:eq)?ref\*?\{|hyperref\[)([^}\]]+)", text)) <= set(labels)


@pytest.mark.parametrize(
    ("label", "derived"),
    [
        ("eq. (9)", True),
        ("eq. (9), line 2", True),
        ("(9)", True),
        ("eq. (90)", False),
        ("9", False),
    ],
)
def test_a_step_derives_the_claims_of_its_equation(label: str, derived: bool) -> None:
    step = replace(awkward()[0].steps[0], published=("(9)", "Table II"))
    assert derives(step, label) == derived
    assert derives(step, "Table II") and not derives(step, "Table I")


def test_errors_stand_before_the_claims_with_all_that_was_found() -> None:
    text = article("awkward")
    section = text[text.index(r"\section{Errata}") : text.index(r"\section{Claims of the paper}")]
    for part in (
        r"\subsection{\texorpdfstring{100 \% of $\displaystyle x_1$ \& more\_}{100 \% of x\_1 \& ",
        r"Changes a result or a design",
        r"Since $\displaystyle a < b$.",
        r"\textbf{eq. (2)} (p. 3\_4): $x_{1}$ is one",
        r"\finding{Read as:}{all of $\displaystyle a_1$}",
        r"\finding{Refuted:}{at $\displaystyle \theta_1 = 2\pi/3$: 1, not 0}",
        r"\finding{Other reading, proved:}{100 \% (\&)}",
        r"\finding{Holds instead, proved:}",
        r"\emph{What follows:} 5 \%.",
    ):
        assert part in section, part
    assert r"\detail{Assumption:}{$\displaystyle a > 0$}" in text
    assert "$x_{1}$ is one (paraphrased)" in text
    page = re.sub(r"\s+", " ", show(*awkward()))
    assert "1. 100 % of x_1 & more_ (changes a result or a design): eq. (2)" in page


def test_claims_and_errors_show_themselves_in_a_notebook() -> None:
    claim = Claim("eq. (1)", "{Two} of $x$", lambda *_: Undecidable("a figure"))
    erratum = Erratum("key", "It is $x$", Gravity.RESULT, "Since 5 % are lost.", "Use.")
    assert claim._repr_markdown_() == "**eq. (1):** Two of $x$"
    assert erratum._repr_markdown_() == "**It is $x$.** Since 5 % are lost.\n\nUse."


@pytest.mark.parametrize("name", ["planar_2r", "puma560", "delta"])
def test_steps_show_themselves_in_a_notebook_as_in_the_article(name: str) -> None:
    for step in derived(name)[0].steps:
        text = step._repr_markdown_()
        words = re.sub(r"\$\$.*?\$\$|\$.*?\$", "", text, flags=re.DOTALL)
        assert not re.search(r"theta\d|_[ijs]\b|\\", words), words
        assert (
            max(map(len, text.splitlines())) < 1500
        )  # a matrix as wide as its columns is not read


def test_without_proof_nothing_is_called_proved() -> None:
    derivation, _ = derived("planar_2r")
    assert "roved" not in show(derivation, None)
    text = show(derivation, None, "latex")
    assert "Sound:" not in text
    assert "Claims of the paper" not in text and "Errata" not in text


def test_terminal_page_is_narrow() -> None:
    for name in (*ROBOTS, "awkward"):
        assert max(map(len, show(*derived(name)).splitlines())) <= 100


@pytest.mark.parametrize("name", [*ROBOTS, "awkward"])
def test_notebook_balances(name: str) -> None:
    text = notebook(derived(name)[0])
    assert text.startswith("**")
    assert text.count("$") % 2 == 0
    assert text.count("{") == text.count("}")
    assert text.count("\\begin") == text.count("\\end")


@pytest.mark.parametrize(
    ("name", "latex"),
    [
        ("theta1", r"\theta_{1}"),
        ("theta2R", r"\theta_{2\mathrm{R}}"),
        ("sigma_elbow", r"\sigma_{\mathrm{elbow}}"),
        ("R11", "R_{11}"),
        ("px", "p_{x}"),
        ("T12", "T_{12}"),
        ("rS", r"r_{\mathrm{S}}"),
        ("c_theta4", r"c_{\theta_{4}}"),
        ("qdot1", r"\dot{q}_{1}"),
        ("below", r"\mathrm{below}"),
        ("psi_max", r"\psi_{\mathrm{max}}"),
        ("lamda", r"\lambda"),
        ("L0", "L_{0}"),
        ("CP_y", r"\mathit{CP}_{y}"),
    ],
)
def test_symbol_names(name: str, latex: str) -> None:
    assert symbol_name(name) == latex


@pytest.mark.parametrize(
    ("text", "latex"),
    [
        ("theta1 = pi/6 holds", r"$\theta_{1} = \pi/6$ holds"),
        ("a = l1, l2", "$a = l_{1}$, $l_{2}$"),
        ("the sqrt(1 - D^2) of it", r"the $\sqrt{1 - D^{2}}$ of it"),
        ("|l1 - l2| <= l1", r"$|l_{1} - l_{2}| \le  l_{1}$"),
        ("half-angle and a 2R arm (see eq. (9))", "half-angle and a 2R arm (see eq. (9))"),
        ("difference = [0.29 +/- 1.5e-6]", r"$\mathrm{difference} = [0.29 \pm  1.5\cdot 10^{-6}]$"),
        ("100 % of it_", r"100 \% of it\_"),
        ("A step, and I", "A step, and I"),
        ("the arm's end; x' = 1", r"the arm's end; $x$' = 1"),
        ("v = -omega × q", r"$v = -\omega \times  q$"),
        ("a twist (v; omega_z)", r"a twist ($v$; $\omega_{z}$)"),
        ("(front, sigma_side = 1)", r"(front, $\sigma_{\mathrm{side}} = 1$)"),
        ("free (theta1 + theta2 is given)", r"free ($\theta_{1} + \theta_{2}$ is given)"),
        ("(theta1 + theta2)/2 = gamma7", r"$(\theta_{1} + \theta_{2})/2 = \gamma_{7}$"),
        ("l1 = l2 (theta2 = 0)", r"$l_{1} = l_{2}$ $(\theta_{2} = 0)$"),
        ("A line.  A step, and A holds: A too", "A line.  A step, and $A$ holds: $A$ too"),
    ],
)
def test_prose(text: str, latex: str) -> None:
    assert Prose(derived("planar_2r")[0])(text) == latex


@pytest.mark.parametrize(
    ("value", "text"),
    [("123/200", "0.615"), ("12", "12"), ("1/3", "1/3"), ("-5/2", "-2.5"), ("1/8192", "1/8192"),
     ("0.12345678901234567", "0.12345678901234567")],
)  # fmt: skip
def test_defaults_are_decimals_where_these_are_exact(value: str, text: str) -> None:
    assert decimal(sp.Rational(value)) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("0.90757121103705138000", r"$13 \pi/45$"),
        ("0.61086523819801535192", r"$7 \pi/36$"),
        ("-0.78539816339744830962", r"$- \pi/4$"),
        ("0.907571", "0.907571"),
    ],
)
def test_a_default_that_is_a_part_of_a_turn_is_written_as_one(value: str, text: str) -> None:
    """The angle of 52 degrees of a table was a fraction of 17 digits, wider than the page."""
    assert default(sp.Rational(value)).replace(r"\,", " ") == text


def test_a_proof_names_the_bounds_it_assumes() -> None:
    """The explicit forms would fill lines that TeX cannot break."""
    sound = next(line for line in article("planar_2r").splitlines() if line.startswith("Sound:"))
    assert r"$(l_{1} - l_{2})^{2} \le r^2 \le (l_{1} + l_{2})^{2}$" in sound


def test_only_a_single_matrix_shrinks() -> None:
    matrix = r"\begin{bmatrix} a & b \end{bmatrix}"
    assert mixed(f"${matrix}$") == rf"\fit{{$\displaystyle {matrix}$}}"
    assert r"\fit" not in mixed(f"${matrix} = {matrix}$")
    assert r"\fit" not in mixed("$a$ and $b$")


def test_parentheses_that_tex_can_break() -> None:
    assert loosen(r"\left(a + b \right) c") == "(a + b) c"
    assert loosen(r"\left(\frac{a}{b} \right)") == r"\Bigl(\frac{a}{b}\Bigr)"
    matrix = r"\left[\begin{matrix}a\end{matrix}\right]"
    assert loosen(matrix) == matrix


def test_parts_between_whose_terms_tex_cannot_break_get_names() -> None:
    """A wide sum in a numerator, cases beside other terms; a part that recurs is named once."""
    d, proof = awkward()
    page = Page(d, proof)
    l1, theta1 = d.parameters[0].symbol, d.joints[0].symbol
    wide = sum(sp.sin(k * theta1) * l1 ** (k - 2) for k in range(2, 14))
    flag = sp.Symbol("nowhere")
    cases = choose(flag, 0, sum(sp.cos(k * theta1) for k in range(2, 9)))
    equations = page.equations("a", theta1 * wide / (7 * l1)) + page.equations("b", cases + theta1)
    equations += page.equations("c", l1 * wide / (1 + l1))
    left = dict(equations)
    assert left["a"] == r"\frac{u_{1} \theta_{1}}{7 l_{1}}" and left["b"] == r"\theta_{1} + u_{2}"
    assert left["c"] == r"\frac{l_{1} u_{1}}{l_{1} + 1}"
    assert page.math(wide).startswith(left["u_{1}"])
    assert r"u_{3}, & \text{otherwise}" in left["u_{2}"] and r"\cos (8 \theta_{1})" in left["u_{3}"]
    assert [name for name, _ in equations if name] == ["a", "u_{1}", "b", "u_{2}", "u_{3}", "c"]


def test_the_width_of_cases_is_that_of_the_widest_row() -> None:
    cases = r"\begin{cases}a, & b \\ abcdef, & b\end{cases}"
    assert measure(f"x + {cases}") > measure("x + abcdef")
    assert measure(f"{cases} + {cases}") > 1.8 * measure(cases)


def test_half_sums_are_one_fraction() -> None:
    a, b = real("theta1"), real("theta2")
    assert Printer({a, b}).math(sp.sin((a - b) / 2)) == (r"\sin \frac{\theta_{1} - \theta_{2}}{2}")


def test_a_joint_is_not_subtracted_from_another_angle() -> None:
    theta, gamma = sp.symbols("theta2 gamma1", real=True)
    math, difference = Printer({theta}).math, r" (\theta_{2} - \gamma_{1})"
    for angle in (gamma - theta, theta - gamma):
        assert math(sp.cos(angle)) == rf"\cos{difference}"
        assert math(sp.sin(angle) ** 2) == rf"\sin^{{2}}{difference}"


def test_a_direction_comes_before_an_angle_to_either_side_of_it() -> None:
    x, y, sigma, a, b = sp.symbols("x y sigma_waist a b", real=True)
    text = Printer(set()).math(2 * sigma * sp.atan2(a, b) + sp.atan2(-x, y))
    assert text.startswith(r"\operatorname{atan2}(- x,\ y) + 2 \sigma")
    assert Printer(set()).math(sp.atan2(sigma * a, b) - x).endswith("- x")


def test_words_are_factors_with_a_space() -> None:
    assert spaced(r"\mathrm{side} n_{1}") == r"\mathrm{side}\, n_{1}"
    assert spaced(r"2 \mathrm{side}_{c} \mathrm{gap}") == r"2\, \mathrm{side}_{c}\, \mathrm{gap}"
    unchanged = r"L_{1} \mathrm{s}_{2} \mathrm{c}_{1} + \mathrm{side} = 0"
    assert spaced(unchanged) == unchanged


def test_a_table_of_a_step() -> None:
    d, proof = awkward()
    x = d.parameters[0].symbol
    d.step("In cases", "By x.", {}, rows=[("where", "value"), ((0, x, 2 * x), x**2), ("else", "0")])
    tex = render("latex/robot.tex.jinja", document(d, proof))
    name = symbol_name(x.name)
    assert r"\begin{longtable}{@{}ll@{}}" in tex and r"where & value \\ \midrule" in tex
    assert rf"$\displaystyle 0 \le {name} \le 2 {name}$ & $\displaystyle {name}^{{2}}$" in tex
    assert f"0 <= {x} <= {2 * x}  |  {x**2}" in show(d, proof)


def test_statements_that_functions_share_are_printed_once() -> None:
    d = __import__("closedform.derivations.hybrid_five_bar", fromlist=["d"]).d
    tex = render("latex/robot.tex.jinja", document(d, Proof(d.name, d.paper.key, (), 0, ())))
    place, cases = r"Section~\ref{inverse:hybrid_five_bar:fk}", "with its special cases"
    assert rf"Continue after the lines of \texttt{{fk}}, {place}, {cases}." in tex
    assert rf"Continue after the lines of \texttt{{jacobian}}, {cases}." in tex


def test_special_characters() -> None:
    assert escape("50 % & {a_b} ~ ^ \\ # $") == (
        r"50 \% \& \{a\_b\} \textasciitilde{} \textasciicircum{} \textbackslash{} \# \$"
    )
    assert escape("θ1 ≥ 0°") == r"$\theta_{1}$ $\ge$ 0$^\circ$"
    assert mixed("5 % of $θ_1$") == r"5 \% of $\displaystyle \theta _1$"
