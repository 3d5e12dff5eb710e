"""The book: numbered equations, one meaning for each symbol, lemmas with proofs, and its pages."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from closedform.derivations.rpr_planar import d as rpr_planar
from closedform.generated.numpy import rpr_planar as code
from places import ROOT

from closedform.emit.backends.latex import book, figures, lemmas, symbols
from closedform.emit.backends.latex.article import Page, document
from closedform.emit.backends.latex.equations import canonical, names_in
from closedform.emit.render import render
from closedform.lemmas.registry import theorem, theorems
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, choose, real
from closedform.model.inverse import Inverse
from closedform.model.paper import Paper, Work
from closedform.proof.prove import Proof

GENERATED = ROOT / "generated" / "latex"
ARTICLES = sorted(p for p in GENERATED.glob("*.tex") if p.stem != "closedform")
PAPER = Paper("toy", "A toy", ("A. Nonymous", "B. Else"), "Journal", year="1999")


def toy() -> Derivation:
    d = Derivation("toy", "Toy", PAPER, "Two turns.")
    theta1, theta4, l1 = (
        d.joint("theta1"),
        d.joint("theta4"),
        d.parameter("l1", value=1, unit="m", meaning="link"),
    )
    reach = d.step("Reach", "By the link.", {"r": l1 * sp.cos(theta1)}, published=("(1)",))
    d.step("Side", "So it is.", {"t": real("r") * sp.sin(theta4), "J": sp.Matrix([[l1, 1]])})
    d.step("Again", "It was found.", {"J": sp.Matrix([[l1, 1]])}, uses=[reach])
    d.function("side", "The side.", {"q": (theta1, theta4)}, {"w": sp.Matrix([[l1, 1]])})
    return d


def article(d: Derivation) -> str:
    titles = tuple(s.title for s in d.steps)
    return render("latex/robot.tex.jinja", document(d, Proof(d.name, d.paper.key, titles, 0, ())))


def clashes(d: Derivation) -> list[str]:
    page = Page(d, Proof(d.name, d.paper.key, (), 0, ()))
    for step in d.steps:
        page.step(step)
    return symbols.clashes(d, page.math, page.legend())


def compiled(name: str, folder: Path, passes: int, *options: str) -> str:
    if shutil.which("pdflatex") is None:
        pytest.skip("pdflatex is not installed")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", *options, name]
    path = os.pathsep.join([str(folder), str(GENERATED), ""])
    for _ in range(passes):
        run = subprocess.run(
            command,
            cwd=folder,
            capture_output=True,
            check=False,
            env={**os.environ, "TEXINPUTS": path, "max_print_line": "1000"},
        )
        log = run.stdout.decode("utf-8", "replace")
        assert run.returncode == 0, log[-2000:]
    return log


def test_equations_have_numbers_and_later_steps_refer_to_them(tmp_path: Path) -> None:
    text = article(toy())
    assert re.findall(r"\\label\{eq:toy:(\d+)\}", text) == ["1", "2", "3"]
    assert r"Here $r$ is that of \eqref{eq:toy:1}." in text
    assert r"This rests on \eqref{eq:toy:1}." in text
    (tmp_path / "toy.tex").write_text(text, encoding="utf-8")
    compiled("toy.tex", tmp_path, 2)
    aux = (tmp_path / "toy.aux").read_text("utf-8")
    found = dict(re.findall(r"\\newlabel\{eq:toy:(\d+)\}\{\{(\d+)\}", aux))
    assert found == {"1": "1", "2": "2", "3": "3"}


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_what_an_algorithm_explains_is_in_it(tex: Path) -> None:
    """A function that continues another one had its names explained a second time."""
    text = tex.read_text("utf-8")
    for found in re.finditer(r"\\end\{algorithm\}\nHere (.*)\.\n", text):
        lines = text[text.rindex(r"\begin{algorithm}", 0, found.start()) : found.start()]
        for name in re.findall(r"\$([^$]*)\$", found[1]):
            assert name in lines


def test_a_length_that_must_not_vanish_is_required_by_name() -> None:
    """The article said that 0 = 0 is required, which a flag is where it is not set."""
    d = toy()
    p, x, length = d.program(), real("x"), d.parameters[0].symbol
    none = p.vanishes("none", length, 1, "the link has a length")
    p.require([choose(none, 1, 0)], 1, "the link has a length")
    d.function("ik", "The turns.", {"x": (x,)}, {"q": (x, x)}, program=p, result="Solutions")
    d.inverses.append(Inverse("ik", d.actuated, (x,), (d.actuated[0],)))
    text = article(d)
    assert r"\textbf{unless} $l_{1} \ne 0$ (the link has a length): \textsc{invalid}" in text


def test_a_matrix_is_printed_once() -> None:
    text = article(toy())
    assert text.count(r"\begin{bmatrix}") == 1
    assert r"The result is that of \eqref{eq:toy:3}." in text
    assert r"It evaluates \eqref{eq:toy:3}." in text


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_no_article_repeats_a_numbered_equation(tex: Path) -> None:
    text = tex.read_text("utf-8")
    own = text[text.index(r"\section{Derivation}") :]
    equations = re.findall(r"(?m)^((?:.* \\notag \\\\\n)*.*) \\label\{eq:", own)
    assert equations
    assert sorted({x for x in equations if equations.count(x) > 1}) == []


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_every_proof_names_what_was_proved(tex: Path) -> None:
    text = tex.read_text("utf-8")
    assert r"\proved{" in text
    assert r"\proved{(" not in text


def test_symbols_that_look_alike_are_refused() -> None:
    d = toy()
    assert clashes(d) == []
    p = Program()
    p.let("T_1", 1)
    p.let("T1", 2)
    d.function("alike", "Alike.", {"x": real("x")}, {"z": real("x")}, program=p)
    assert clashes(d) == ["T_{1} is written for T1 and for T_1"]
    with pytest.raises(ValueError, match="cannot be told apart"):
        article(d)
    d.write("T1", r"\tau_1")
    assert clashes(d) == []


def test_a_symbol_in_two_forms_is_refused() -> None:
    d = toy()
    d.step("Twice", "A sine is upright.", {"s_4": sp.sin(d.joints[1].symbol)})
    assert clashes(d) == [r"one symbol is written in several ways: \mathrm{s}_{4}, s_{4}"]
    d = toy()
    p = Program()
    p.let("r2", real("x") ** 2)
    d.function("square", "Square.", {"x": real("x")}, {"z": real("x")}, program=p)
    d.step("Square", "As a power.", {"r^2": d.joints[0].symbol})
    assert clashes(d) == ["one symbol is written in several ways: r^{2}, r_{2}"]
    d.write("r2", "r^2")
    assert clashes(d) == []


def test_a_symbol_without_a_meaning_is_found() -> None:
    d = toy()
    d.step("Slope", "By k.", {"g": real("k")})
    page = Page(d, Proof(d.name, d.paper.key, (), 0, ()))
    for step in d.steps:
        page.step(step)
    assert symbols.undefined(d, page.numbers, page.math) == ["k"]
    d.write("k", meaning="the slope")
    assert symbols.undefined(d, page.numbers, page.math) == []
    assert ("k", "the slope") in symbols.table(d, page.numbers, page.prose, page.math)


@pytest.mark.parametrize(
    ("formula", "names"),
    [
        (r"\theta_{23A} + r_2", [r"\theta_{23A}", "r_{2}"]),
        (r"T = A_1 A_2", ["T", "A_{1}", "A_{2}"]),
        (r"\det J_{xy}", ["J_{xy}"]),
        (r"|\text{A} - \text{B}|", []),
        (r"r_{\mathrm{S}}^2", [r"r_{\mathrm{S}}"]),
        (r"(\varphi, \beta)_{\text{crossed}}", [r"\varphi", r"\beta"]),
        (r"\mathbf p = \mathbf c + \overrightarrow{CP}",
         [r"\mathbf{p}", r"\mathbf{c}", r"\overrightarrow{CP}"]),
    ],
)  # fmt: skip
def test_names_in_a_formula(formula: str, names: list[str]) -> None:
    assert names_in(formula) == names
    assert canonical("R_1^T") == "R_{1}^{T}"


def test_every_lemma_is_stated_and_proved() -> None:
    sources = [p.read_text("utf-8") for p in (ROOT / "closedform" / "lemmas").glob("*.py")]
    applied = {name for s in sources for name in re.findall(r'\bLemma\(\s*"([^"]+)"', s)}
    supporting = {other for t in theorems().values() for other in t.rests_on}
    # they say what a step proves, and solve for nothing
    of_a_step = {"parallelogram in space", "three parallel rods", "parallel axes"}
    of_a_step |= {"universal joints with parallel axes", "parallelogram between two links"}
    assert applied | supporting | of_a_step == set(theorems())
    assert all(t.statement and t.proof for t in theorems().values())
    order = list(theorems())
    for name, t in theorems().items():
        assert all(order.index(other) < order.index(name) for other in t.rests_on)


def test_a_lemma_brings_those_that_it_rests_on() -> None:
    shown = [t["key"] for t in lemmas.context(["two-link arm"], {})]
    assert shown == ["two-link-triangle", "two-link-arm"]
    with pytest.raises(ValueError, match="dollar"):
        theorem("broken", statement="$x", proof="")


def test_a_chapter_does_not_end_with_a_few_lines_on_a_page(tmp_path: Path) -> None:
    """The next run sets it tighter; one that ends with more is left as it is."""
    chapters = [book.Chapter(n, n, PAPER, (), None) for n in ("long", "longer")]
    (tmp_path / "book.tex").write_text(
        render("latex/book.tex.jinja", book.context(chapters)), "utf-8"
    )
    for one, lines in zip(chapters, (41, 60), strict=True):
        text = f"\\mechanism{{{one.name}}}{{}}\\label{{chapter:{one.name}}}" + "\n\nA line." * lines
        (tmp_path / f"{one.name}.tex").write_text(text, "utf-8")

    def ends(passes: int) -> dict[str, tuple[float, int]]:
        compiled("book.tex", tmp_path, passes)
        aux = (tmp_path / "book.aux").read_text("utf-8")
        found = re.findall(r"\\closesat\{(\w+)\}\{(.*?)pt\}\{(\d)\}", aux)
        return {name: (float(height), int(tight)) for name, height, tight in found}

    first, second = ends(1), ends(1)
    assert first["long"][0] < 100 and first["long"][1] == 0
    assert second["long"][0] > 600 and second["long"][1] == 1
    assert first["longer"] == second["longer"]


def test_chapters_are_in_the_order_of_a_course() -> None:
    def chapter(name: str) -> book.Chapter:
        return book.Chapter(name, name, PAPER, ("slide",), None)

    given = [chapter(n) for n in ("zebra", "puma560", "ant", "planar_2r")]
    assert [c.name for c in book.in_order(given)] == ["planar_2r", "puma560", "ant", "zebra"]
    text = render("latex/book.tex.jinja", book.context(given))
    assert re.findall(r"\\chapterof\{(\w+)\}", text) == ["planar_2r", "puma560", "ant", "zebra"]
    assert r"Used for \hyperref[chapter:planar_2r]{planar\_2r}" in text
    known = [p.stem for p in ARTICLES]
    assert set(book.COURSE) == set(known)


def test_works_are_listed_with_their_years() -> None:
    collection = Paper("books", "Books", ("X",), works=(Work("b", ("C. D",), "T", "P", "1981"),))
    assert PAPER.cited == (Work("toy", ("A. Nonymous", "B. Else"), "A toy", "Journal", "1999"),)
    entries = book.bibliography.entries([PAPER, collection])
    assert [(e["key"], e["published"]) for e in entries] == [
        ("b", "P, 1981."),
        ("toy", "Journal, 1999."),
    ]


def test_figures_that_were_drawn_are_included() -> None:
    captions = {"toy-mechanism": "At home", "other-mechanism": "No", "toy-fig9": "A path of $x_1$"}
    captions |= {"toy-fig10": "A map", "toy-fig11": "Not drawn"}
    pages = figures.pages(captions, ["toy-fig10", "toy-fig9", "toy-mechanism"], {})
    assert list(pages) == ["toy"]
    found = re.findall(r"\\drawing{(.*?)}", pages["toy"])
    assert found == ["toy-mechanism", "toy-fig9", "toy-fig10"]


def test_figures_stand_at_their_steps() -> None:
    places = {"toy-a": "The loop", "toy-b": "ik", "toy-c": "The loop"}
    captions = dict.fromkeys(["toy-a", "toy-b", "toy-c", "toy-d"], "A")
    text = figures.pages(captions, [*captions], places)["toy"]
    shown = {
        where: re.findall(r"\\drawing{(.*?)}", part)
        for where, part in re.findall(r"\\figures{([^{}]*)}{(See.*?})}\n", text, re.DOTALL)
    }
    assert shown == {
        "step-the-loop": ["toy-a", "toy-c"], "ik": ["toy-b"], "mechanism": ["toy-d"],
    }  # fmt: skip
    assert r"See Figures~\ref{figure:toy-a} and \ref{figure:toy-c}." in text


def test_figures_are_written_for_tex(tmp_path: Path) -> None:
    (tmp_path / "toy-mechanism.pdf").touch()
    figures.write(tmp_path, {"toy-mechanism": "5 %"}, {"toy-mechanism": "Pose"})
    assert r"\figures{step-pose}" in (tmp_path / "toy-figures.tex").read_text()
    assert r"\drawing{toy-mechanism}{5 \%}" in (tmp_path / "toy-figures.tex").read_text()


def test_the_jacobian_is_unbounded_at_a_pole() -> None:
    b = code.Parameters().b
    near, far = ([b / 2 + e, b / 2 + e] for e in (1e-9 * b, 0.1 * b))
    grown = [np.abs(code.jacobian(np.array(q))).max() for q in (far, near)]
    assert rpr_planar.poles == ("flat",)
    assert grown[1] > 1e3 * grown[0]


def test_the_passive_angles_have_their_names() -> None:
    text = (GENERATED / "hybrid_five_bar.tex").read_text("utf-8")
    section = text[text.index(r"\function{passive\_angles") :]
    lefts = re.findall(r"(\\theta_\{\d\}) = \\operatorname\{atan2\}", section)
    assert lefts[:2] == [r"\theta_{4}", r"\theta_{5}"]


def test_the_book_compiles_and_fits(tmp_path: Path) -> None:
    log = compiled("closedform.tex", tmp_path, 2, "-draftmode")
    assert "undefined references" not in log
    assert "multiply-defined" not in log
    too_wide = [float(w) for w in re.findall(r"Overfull \\hbox \(([\d.]+)pt", log)]
    assert max(too_wide, default=0) < 5


def test_the_book_does_not_depend_on_the_hash_seed() -> None:
    script = (
        "import json, sys; sys.path[:0] = ['tests', 'tests/latex']\n"
        "from test_book import *\n"
        "print(article(toy()), json.dumps(lemmas.context(None, {})))\n"
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
    assert printed[0] == printed[1] and len(printed[0]) > 10_000


def test_what_most_chapters_have_is_not_in_the_index() -> None:
    def chapter(name: str, *entries: str) -> book.Chapter:
        return book.Chapter(name, name, PAPER, (), None, indexed=entries)

    usual = r"function!fk@\texttt{fk}"
    four = [chapter("a", usual, "loop"), chapter("b", usual, "loop"), chapter("c", usual)]
    assert book.everywhere([*four, chapter("d")]) == [usual]
    assert book.everywhere(four[:2]) == []  # two chapters are no crowd
    own = book.chapter(toy(), None).indexed
    assert own == ("reach", "side", "again", r"function!side@\texttt{side}")
    text = render("latex/book.tex.jinja", book.context([*four, chapter("d")]))
    assert rf"\csname everywhere:\detokenize{{{usual}}}\endcsname" in text
    assert all(rf"\indexed{{{entry}}}" in article(toy()) for entry in own)
