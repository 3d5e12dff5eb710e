"""How articles tell an inverse and set formulas; no TeX is needed."""

import re
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
import sympy as sp
from chains import arm, solved
from places import ROOT

from closedform.emit.backends.latex.algorithm import Algorithm
from closedform.emit.backends.latex.article import Page
from closedform.emit.backends.latex.cases import Cases
from closedform.emit.backends.latex.formulas import FITS, Printer, integer, is_nested, measure
from closedform.emit.backends.latex.inequalities import inequalities
from closedform.emit.backends.latex.inverse import Told
from closedform.emit.backends.latex.names import Quantities, is_word
from closedform.emit.backends.latex.wide import Lines
from closedform.model.derivation import Derivation
from closedform.model.functions import Bound, Vanishes, real
from closedform.proof.prove import Proof
from closedform.scaffold.chains.propose import propose

GENERATED = ROOT / "generated" / "latex"
ARTICLES = sorted(p for p in GENERATED.glob("*.tex") if p.stem != "closedform")
SMALL = ("planar_2r", "scara", "spherical_wrist")
t1, t2, t3 = (real(f"theta{k}") for k in (1, 2, 3))
a, b, c, x, y, N, M, sigma = map(real, ("a", "b", "c", "x", "y", "N", "M", "sigma_side"))


@cache
def page(name: str) -> Page:
    d: Derivation = import_module(f"closedform.derivations.{name}").d
    return Page(d, Proof(d.name, d.paper.key, (), 0, ()))


@cache
def told(name: str) -> tuple[Told, dict]:
    found = page(name)
    function = found.derivation["ik"]
    algorithm = found.algorithm(function)
    text = Told(found, function, algorithm, found.after(function, algorithm))
    return text, text.context()


def derivation_of(tex: Path) -> str:
    """The part of an article in front of the claims, which quote the papers."""
    text = tex.read_text(encoding="utf-8")
    return re.split(r"\\section\{(?:Errata|Claims)", text)[0]


# What must not be on a page


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_no_code_leaks_into_the_formulas(tex: Path) -> None:
    text = derivation_of(tex)
    for number in ("1099511627776", "8796093022208", "16777216", "1000000000"):
        assert number not in text
    for jargon in ("\\statement", "\\textsc{let}", "\\textsc{bound}", "\\textsc{flag}", "factors_"):
        assert jargon not in text
    for word in ("flip", "ctheta", "selbow", "celbow", "whole", "below", "above", "beyond", "held"):
        assert f"\\mathrm{{{word}" not in text
    for letters in (r"u_{p}", r"i_{n,", r"\mathrm{True}", "inside ="):
        assert letters not in text


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_every_row_of_a_display_is_estimated_to_fit(tex: Path) -> None:
    text = derivation_of(tex)
    displays = re.findall(r"\\begin\{(align\*?)\}\n(.*?)\n\\end\{\1\}", text, re.DOTALL)
    assert displays
    for _, display in displays:
        plain = re.sub(r" \\notag| \\label\{[^}]*\}", "", display)
        for row in re.split(r" \\\\(?:\[\dpt\])?\n", plain):
            assert measure(row.replace(" &= ", " = ").replace(r"&\quad", "")) <= FITS + 6, row


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_no_fraction_stands_in_another_or_in_an_exponent(tex: Path) -> None:
    text = derivation_of(tex)
    for formula in re.findall(r"\$([^$]*)\$|&= (.*)", text):
        assert not is_nested("".join(formula)), formula
    assert not re.search(r"[_^]\{[^{}]*\\frac", text)


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_no_sum_starts_with_a_minus_if_it_has_another_term(tex: Path) -> None:
    for inner in re.findall(r"\(- ([^()]*)\)", derivation_of(tex)):
        assert " + " not in inner, inner


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_every_inverse_has_an_algorithm_that_names_its_statuses(tex: Path) -> None:
    text = derivation_of(tex)
    part = text[text.index(r"\section{Inverse") : text.index(r"\section{Functions}")]
    for section in part.split(r"\subsection{Function")[1:]:
        assert section.count(r"\begin{algorithm}") == section.count(r"\end{algorithm}") == 1
        assert r"\textsc{unreachable}" in section or r"\textsc{singular}" in section
        # one branch has no name
        assert (r"\topic{Branches" in section) == (r"\textbf{for each}" in section)


# What an inverse says


@pytest.mark.parametrize("name", SMALL)
def test_each_joint_is_solved_in_a_step_with_its_lemma(name: str) -> None:
    text, context = told(name)
    stages = context["stages"]
    unknowns = {u for s in text.stages.solvings for u in s.unknowns}
    assert text.inverse is not None
    assert set(text.inverse.unknowns) <= unknowns | set(text.inverse.rank.defined)
    for stage, step in zip(stages, text.stages.steps, strict=True):
        assert stage["from"].startswith("From")
        assert stage["lemma"]
        assert stage["solution"] and stage["blocks"]
        for u in (u for solving in step for u in solving.unknowns):
            assert text.page.math(u) in stage["unknowns"]
    first = {s[0].lemma.name: k for k, s in reversed(list(enumerate(text.stages.steps)))}
    for k, (stage, step) in enumerate(zip(stages, text.stages.steps, strict=True)):
        assert bool(stage["statement"]) == (first[step[0].lemma.name] == k)


@pytest.mark.parametrize("name", SMALL)
def test_every_failure_has_its_status(name: str) -> None:
    text, context = told(name)
    body = text.function.body
    lines = "\n".join(line.text for line in context["lines"])
    cases = context["cases"]
    assert (r"\textsc{unreachable}" in lines) == any(isinstance(s, Bound) for s in body)
    for flag in (s for s in body if isinstance(s, Vanishes) and s.free):
        held = [c for c in cases if c.meaning == text.page.prose(flag.meaning)]
        assert any(c.status == "singular" for c in held)
        for joint in flag.free:
            assert any(f"${text.page.math(joint)}$" in c.returned for c in held)


@pytest.mark.parametrize("name", ["three_prs", "delta", "planar_2r"])
def test_every_bound_is_a_condition_for_the_reader(name: str) -> None:
    algorithm = told(name)[0].algorithm
    bounds = [s.symbol for s in algorithm.function.body if isinstance(s, Bound)]
    assert bounds and all(algorithm.conditions([s]) for s in bounds)


def evaluated(algorithm: Algorithm, given: dict) -> list[float]:
    """The answers, computed from what the lines print, in their order."""
    known = dict(given)
    for symbol in algorithm.values:
        if symbol in algorithm.printed:
            value = algorithm.value(symbol).xreplace(known)
            shown = algorithm.known.get(symbol, symbol)
            known[shown] = sp.N(value, 30)
            for angle in getattr(shown, "args", ()):
                if {sp.sin(angle), sp.cos(angle)} <= known.keys():
                    known[angle] = sp.atan2(known[sp.sin(angle)], known[sp.cos(angle)])
    answers = [algorithm.shown(e).xreplace(known) for e in algorithm.outputs]
    return [complex(sp.N(e)).real for e in answers]


TARGETS = {
    "planar_2r": {"px": "1.2", "py": "0.4"},
    "scara": {"x_x": "0.31", "x_y": "0.2", "x_z": "0.1", "x_yaw": "0.3"},
    "spherical_wrist": dict(
        zip((f"R{i}{j}" for i in "123" for j in "123"), (
            "0.36", "0.48", "-0.8", "-0.8", "0.6", "0", "0.48", "0.64", "0.6"
        ), strict=True)
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SMALL)
def test_the_algorithm_computes_what_the_function_computes(name: str) -> None:
    text, _ = told(name)
    function, derivation = text.function, text.page.derivation
    given = {p.symbol: p.value for p in derivation.parameters}
    given |= {s: sp.Rational(TARGETS[name][str(s)]) for s in function.symbols}
    for _, signs in function.cases():
        point = given | {s: sp.Integer(v) for s, v in signs.items()}
        wanted = [complex(sp.N(e.xreplace(point))).real for e in function.values(signs)]
        assert evaluated(text.algorithm, point) == pytest.approx(wanted, abs=1e-12)


# Formulas


@pytest.mark.parametrize(
    ("value", "latex"),
    [
        (-b + a * sigma - c, r"\sigma_{\mathrm{side}} a - b - c"),
        ((y - a) ** 2, "(y - a)^{2}"),
        (2 * sp.sqrt(N) * sp.sqrt(M) * sigma * a, r"2 \sigma_{\mathrm{side}} a \sqrt{M N}"),
        (-sp.sin(t2 + t3) * sp.cos(t1), r"- \mathrm{c}_{1} \mathrm{s}_{23}"),
        (sp.atan2(y, x) - a, r"\operatorname{atan2}(y,\ x) - a"),
        ((-a - b) * sp.sin(x), r"- (a + b) \sin x"),
        (a / 2**40, "2^{-40} a"),
        (2**43 * a, "2^{43} a"),
        (a / 2000000, r"5 \cdot 10^{-7} a"),
        (a**2 + sp.Rational(1, 10**4), r"a^{2} + 10^{-4}"),
        (sp.Mul(b, 1 / a, 1 / a, evaluate=False), r"\frac{b}{a^{2}}"),
        (sp.pi * (a - b) * sp.cos(x) / 18, r"\frac{\pi}{18} (a - b) \cos x"),
        (sp.atan(a), r"\arctan(a)"),
        ((a / sp.cos(x) - b) / y, r"\frac{a - b \cos x}{y \cos x}"),
        (sp.cos((a - b) / 2) * a / y, r"\frac{a \cos((a - b)/2)}{y}"),
        (a * (b**2) ** sp.Rational(3, 4) / y, r"\frac{a \left|b\right|^{3/2}}{y}"),
    ],
)
def test_terms_and_factors_stand_as_a_person_writes_them(value: sp.Expr, latex: str) -> None:
    assert Printer({t1, t2, t3}).math(value) == latex


def test_a_symbol_that_gets_another_name_is_printed_by_it():
    a, b = sp.symbols("a b", real=True)
    flag = sp.Symbol("is_straight")
    value, cases = sp.sqrt(a) + sp.cos(a * b), sp.Piecewise((a, flag), (b, True))
    printer = Printer(set())
    assert printer.math(value) == r"\sqrt{a} + \cos (a b)"
    assert "is straight" in printer.math(cases)
    printer.rename({a: "w", flag: "f"})
    assert printer.math(value) == r"\sqrt{w} + \cos (b w)"
    assert "$f$" in printer.math(cases)
    printer.rename({a: "v"})
    assert printer.math(value) == r"\sqrt{v} + \cos (b v)"


def test_large_powers_of_two_and_ten() -> None:
    assert integer(2**40) == "2^{40}" and integer(10**9) == "10^{9}" and integer(4095) == "4095"


def test_the_common_factor_stands_in_front() -> None:
    lines = Lines(Printer({t3}), ())
    assert lines.equations("d", a * b * sp.cos(t3) + a * c * sp.cos(t3)) == [
        ("d", r"a \mathrm{c}_{3} (b + c)")
    ]


def test_a_polynomial_is_collected_and_its_coefficients_are_named() -> None:
    """Each line fits, and what the names stand for gives the polynomial again."""
    wide = sp.expand(
        sum((a**k + b**2 * c * k + y**3 * c + 5 * a * b * y + c**4) * x**k for k in range(1, 6))
    )
    lines = Lines(Printer(set()), ())
    rows = lines.equations("F", wide)
    assert len(rows) > 2
    assert all(measure(left + right) <= FITS for left, right in rows)
    symbol, terms = lines._polynomial(wide) or (x, [])
    assert sp.expand(sum(e * symbol**k for k, e in terms) - wide) == 0


def test_a_sum_of_squares_is_not_collected() -> None:
    pairs = [(real(f"a_{k}"), real(f"b_{k}")) for k in range(1, 11)]
    total = sum((p * y - q * x) ** 2 for p, q in pairs)
    rows = Lines(Printer(set()), ()).equations("N", total)
    assert [left for left, _ in rows if left] == ["N"]
    assert "".join(right for _, right in rows).count(")^{2}") == 10


def test_an_equation_to_zero_is_taken_apart_too() -> None:
    wide = sp.expand((a * x + b * y - c) ** 4 * (x + 7 * a) + b**3 * x**2 * y)
    rows = Lines(Printer(set()), ()).equations("F", sp.Eq(wide, 0))
    assert all(measure(left + right) <= FITS + 5 for left, right in rows)
    assert [left for left, right in rows if right.endswith(" = 0")] == ["F"]


def test_a_sum_in_products_gets_a_name_once() -> None:
    part = sum(sp.sin(k * x) * y**k for k in range(1, 4))
    rows = Lines(Printer(set()), ()).equations(
        "v",
        part * sp.cos(5 * x) * b
        + part * sp.cos(7 * x) * c
        + sp.cos(9 * x) * a * b * sp.sin(11 * x),
    )
    assert [left for left, _ in rows].count("u_{1}") == 1


def test_a_long_sum_is_broken_before_its_terms() -> None:
    total = sum(real(f"a_{k}") * sp.cos(real(f"b_{k}")) for k in range(1, 19))
    rows = Lines(Printer(set()), ()).equations("s", total)
    assert len(rows) > 1 and all(not left for left, _ in rows[1:])
    assert all(right.startswith(("+", "-")) for _, right in rows[1:])
    assert all(measure(left + right) <= FITS for left, right in rows)
    assert sum(right.count(r"\cos") for _, right in rows) == 18


def test_a_quantity_is_used_after_its_definition() -> None:
    printer = Printer({t1, t2})
    quantities = Quantities(printer, ["x"])
    rho = a + b * sp.sin(t2) + c * sp.cos(t2)
    quantities.define(r"\rho", rho)
    quantities.define("x", rho * 2)
    assert printer.math(quantities(a * rho)) == r"a \rho"
    assert printer.math(quantities(-rho + y)) == r"y - \rho"
    assert quantities(a * sp.sin(t2)) == a * sp.sin(t2)


@pytest.mark.parametrize(
    ("name", "word"),
    [("up", True), ("selbow", True), ("in_reach", True), ("h_wrist", False), ("px", False),
     ("rS", False), ("N", False), ("R1_23", False), ("theta2", False), ("sigma_x", False)],
)  # fmt: skip
def test_names_that_are_words(name: str, word: bool) -> None:
    assert is_word(name) == word


# Names and conditions


def test_a_name_in_a_condition_is_defined_in_its_step() -> None:
    step, *_ = told("irb2400")[1]["stages"]
    assert "h_{1} = 0" in step["degenerate"]
    assert r"h_{1} &= \sqrt{" in "".join(map(str, step["solution"]))


def test_a_length_keeps_the_name_that_a_step_gave_it() -> None:
    text = (GENERATED / "srs_arm.tex").read_text(encoding="utf-8")
    first = text[text.index("Step 1:") : text.index("Step 2:")]
    assert "$r$ is $L$" in first  # r is the name of another distance in this chapter
    assert r"\mathrm{plane}" not in text


def test_a_list_of_arguments_is_not_called_as_one_of_them() -> None:
    assert told("scara")[1]["given"] == r"$\displaystyle \mathtt{x} = (x,\ y,\ z,\ \psi)$"


def test_an_arctangent_has_no_length_below_both_arguments() -> None:
    [step] = told("spherical_wrist")[1]["stages"]
    solution = "".join(map(str, step["solution"]))
    assert r"\sigma_{\mathrm{wrist}} R_{23},\ \sigma_{\mathrm{wrist}} R_{13})" in solution


def test_two_bounds_of_one_name_are_one_condition() -> None:
    sheet = page("scara")
    order = {x: 0, y: 1}
    found = inequalities(sheet, order, [y - a, y + a, b - y, x - c, x + c])
    assert found == [r"$\left|a\right| \le y \le b$", r"$\left|c\right| \le x$"]


def test_a_turned_hand_is_called_as_the_inverse_calls_it() -> None:
    sheet = page("agile_wrist")
    [hand] = sheet.derivation["fk"].outputs
    assert [left for left, _ in sheet.array(hand, [*range(1, 10)])] == ["R"]


def test_values_that_would_be_long_keep_their_names() -> None:
    """With all lengths and twists as parameters the special cases took minutes, and recursed."""
    names = ["a1", "a2", "a3", "d1", "d2", "d3", "d4", "k1", "k2", "k3", "k4", "k5"]
    a1, a2, a3, d1, d2, d3, d4, k1, k2, k3, k4, k5 = map(real, names)
    rows = [(a1, k1, d1), (a2, k2, d2), (a3, k3, d3), (0, k4, d4), (0, k5, 0), (0, 0, 0)]
    d, serial = arm(rows, **dict.fromkeys(names, "1"))
    solved(d, serial, propose(serial).source)
    page = Page(d, Proof(d.name, d.paper.key, (), 0, ()))
    cases = Cases(page.algorithm(d["ik"])).told()
    assert len(cases) == len(set(cases)) > 4
    assert all(len(c.where) < 300 and "Constant" not in c.where for c in cases)
