"""Each step of an inverse says which equations it solves, and what its lemma gives is returned."""

import re
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
import sympy as sp
from places import ROOT

from closedform.emit.backends.latex.algorithm import Algorithm
from closedform.emit.backends.latex.article import Page, document
from closedform.emit.backends.latex.equations import Numbered, Numbers, reference
from closedform.emit.backends.latex.sheet import Block
from closedform.model.derivation import Derivation
from closedform.model.expressions import substitute
from closedform.model.functions import Bound, Function, Let, Vanishes
from closedform.proof.prove import Proof

GENERATED = ROOT / "generated" / "latex"
ARTICLES = sorted(p for p in GENERATED.glob("*.tex") if p.stem != "closedform")
LABEL = r"\\(?:label|longequation|matrixequation)\{(.*?)\}"
SOLVES = re.compile(r"^The lemma .* solves (?:each of )?(.*?)(?: once more.*|[:.])$", re.MULTILINE)


def derivation(name: str) -> Derivation:
    found: Derivation = import_module(f"closedform.derivations.{name}").d
    return found


@cache
def article(name: str) -> dict:
    d = derivation(name)
    return document(d, Proof(d.name, d.paper.key, (), 0, ()))


def stages(name: str, function: str) -> list[dict]:
    return next(f["stages"] for f in article(name)["inverses"] if f["name"] == function)


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_each_step_refers_to_the_equations_that_it_solves(tex: Path) -> None:
    text = tex.read_text("utf-8")
    solved = SOLVES.findall(text)
    assert solved
    for step in solved:  # a lemma in vectors has its equations in its statement
        assert step == "them" or re.fullmatch(r"(?:\\eqref\{[^}]*\}(?:--|, | and )?)+", step)
    assert {*re.findall(r"\\eqref\{(.*?)\}", text)} <= {*re.findall(LABEL, text)}


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_each_step_says_where_its_equations_come_from(tex: Path) -> None:
    told = re.findall(
        r"^From (?:.* of )?the (?:forward map|equations of the loop).*",
        tex.read_text("utf-8"),
        re.M,
    )
    assert told
    known = [t for t in told if r"\eqref" in t or r"\ref{step:" in t]
    # the pitch of the H6AR is the angle of its last joint, which no equation says
    assert len(known) == len(told) or (tex.stem.startswith("h6ar") and len(known) == len(told) - 1)


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_an_inverse_refers_to_the_sections_that_give_its_reasons(tex: Path) -> None:
    text, d = tex.read_text("utf-8"), derivation(tex.stem)
    reasons = [(s, name) for s in d.steps for name, _ in s.solves]
    titled = [s for s in d.steps if s.title.startswith("Inverse")]
    assert {id(s) for s in titled} <= {id(s) for s, _ in reasons}
    for step, function in reasons:
        label = rf"\label{{inverse:{d.name}:{function.replace('_', '-')}}}"
        told = text.partition(label)[2].partition(r"\begin{algorithm}")[0]
        section = rf"\ref{{step:{d.name}:{d.steps.index(step) + 1}}}"
        assert section in told, (step.title, function)


def test_a_section_explains_the_unknowns_that_it_names() -> None:
    found = {s["unknowns"]: s["from"] for s in stages("ur_arm", "ik")}
    assert r"(see Section~\ref{step:ur_arm:5})" in found[r"$\theta_{1}$"]
    assert r"(see Section~\ref{step:ur_arm:7})" in found[r"$\theta_{2}$ and $\theta_{3}$"]


@pytest.mark.parametrize("name", ["planar_2r", "irb260", "spherical_wrist"])
def test_what_the_lemmas_give_is_what_the_function_returns(name: str) -> None:
    d = derivation(name)
    inverse = next(i for i in d.inverses if i.function == "ik")
    function = d["ik"]
    at = {p.symbol: sp.Float(p.value, 30) for p in d.parameters}
    at |= {q: sp.Float("0.4", 30) * k for k, q in enumerate(d.actuated, 1)}
    at |= {x: f.xreplace(at) for x, f in zip(inverse.targets, inverse.forward, strict=True)}
    for _, signs in function.cases():
        values = dict(zip(inverse.unknowns, function.values(signs), strict=True))
        for solved in (s for s in d.solved if s.function == "ik"):
            for unknown in solved.lemma.solution.keys() & values.keys():
                (given,), _ = function.explicit([solved.lemma.solution[unknown]], signs)
                difference = sp.N((given - values[unknown]).xreplace(at), 30)
                assert abs(sp.sin(difference / 2)) < 1e-25, (name, unknown)


def test_the_rotation_of_a_lemma_is_one_matrix() -> None:
    (step,) = stages("agile_wrist", "fk")
    assert step["unknowns"] == "$R$" and step["matrix"] == "Here $R$ is a rotation."
    assert len(step["blocks"][0].rows) == 3  # that it is a rotation needs no equations
    [last] = [row for block in step["solution"] for row in block.rows if row.left == "R"]
    assert last.right.count("&") == 6


def test_names_of_the_derivation_are_not_defined_again() -> None:
    (step,) = stages("three_prs", "ik")
    assert step["seen"].startswith(r"The other symbols are those of \eqref{eq:three_prs:2}--")
    told = [*step["definitions"], *step["role_blocks"]]
    defined = {row.left for block in told for row in block.rows}
    assert not {"f", "g", "R_{11}", "h_{1,x}", "p_{x}"} & defined and "m_{1}" in defined


def rows(blocks: list) -> dict[str, str]:
    return {row.left: row.right for block in blocks for row in block.rows}


def test_a_linear_pair_shows_both_equations() -> None:
    first, second = stages("planar_2r", r"ik\_pose")
    assert rows(first["blocks"]) == {
        r"l_{1} \mathrm{s}_{1}": r"p_{y} - l_{2} R_{21}",
        r"l_{1} \mathrm{c}_{1}": r"p_{x} - l_{2} R_{11}",
    }
    assert [*rows(second["blocks"])] == [r"\mathrm{s}_{2}", r"\mathrm{c}_{2}"]
    shoulder = stages("planar_2r", "ik")[1]
    assert rows(shoulder["blocks"]) == {
        r"r \sin (\alpha + \theta_{1})": "p_{y}",
        r"r \cos (\alpha + \theta_{1})": "p_{x}",
    }
    assert r"where $\theta_{2}$ is known" in shoulder["from"]
    assert shoulder["count"] == "There is one solution"
    turret, _, _, hand = stages("irb260", "ik")
    assert [*rows(turret["blocks"])] == [r"r \mathrm{s}_{1}", r"r \mathrm{c}_{1}"]
    assert rows(hand["blocks"]) == {
        r"\mathrm{s}_{15}": r"\sin \psi", r"\mathrm{c}_{15}": r"\cos \psi",
    }  # fmt: skip


def test_an_angle_beside_a_direction_is_told_by_two_arctangents() -> None:
    solved = rows(stages("puma560", "ik")[0]["solution"])[r"\theta_{1}"]
    assert solved == (
        r"\operatorname{atan2}(p_{x},\ - p_{y}) + \sigma_{1} \operatorname{atan2}(k_{1},\ d_{3})"
    )
    level = rows(stages("irb2400", "ik")[0]["solution"])[r"\theta_{1}"]
    assert level == r"\operatorname{atan2}(- \sigma_{1} w_{y},\ - \sigma_{1} w_{x})"


def test_names_are_defined_below_the_equations_that_hold_them() -> None:
    step = stages("irb2400", "ik")[0]
    assert {"w_{x}", "w_{y}"} <= rows(step["definitions"]).keys()
    assert not step["role_blocks"]


def test_an_angle_of_the_derivation_keeps_its_letter() -> None:
    step = stages("puma560", "ik")[1]
    assert r"\alpha" in rows(step["solution"])
    assert rows(step["solution"])[r"\theta_{2}"].endswith(r"- \alpha")


def test_the_letters_of_simple_lemmas_stand_for_something() -> None:
    _, slide, remaining = stages("scara", "ik")
    assert slide["roles"] == "$d$ is $d_{3}$ and $c$ is $h - z$"
    assert remaining["roles"].startswith(r"$\lambda$ is $\theta_{4}$ and $\mu - \nu$ is")


def test_parts_of_the_names_of_branches_are_typewriter() -> None:
    prose = Page(derivation("puma560"), Proof("puma560", "", (), 0, ())).prose
    assert prose("right: X >= 0; left: X <= 0.  up: it is above.") == (
        r"\texttt{right}: $X \ge  0$; \texttt{left}: $X \le  0$.  \texttt{up}: it is above."
    )
    assert prose("It faces the wrist (right, X >= 0).").startswith(r"It faces the wrist (\texttt")
    assert "texttt" not in prose("It turns to the right and up.")


def test_a_wide_matrix_has_its_number_beside_it() -> None:
    matrix = Numbered("A", r"\begin{bmatrix} 1 \end{bmatrix}", "eq:x:1", numbered=True)
    assert str(Block((matrix,), wide=True)).startswith(r"\matrixequation{eq:x:1}")
    total = Numbered("A", "a + b", "eq:x:2", numbered=True)
    assert str(Block((total,), wide=True)).startswith(r"\longequation{eq:x:2}")


def test_three_neighbours_are_a_range() -> None:
    labels = [f"eq:x:{k}" for k in (9, 3, 4, 5, 3, 7, 8)]
    marks = [rf"\eqref{{eq:x:{k}}}" for k in (3, 5, 7, 8, 9)]
    assert reference(labels[1:4]) == f"{marks[0]}--{marks[1]}"
    assert reference(labels) == f"{marks[0]}--{marks[1]} and {marks[2]}--{marks[4]}"
    assert reference([labels[1], labels[6], labels[3]]) == f"{marks[0]}, {marks[1]} and {marks[3]}"


def test_an_equation_that_is_solved_defines_nothing() -> None:
    numbers = Numbers("x")
    numbers.number([[("r", "1")]], defining=False)
    assert not numbers.defined and numbers.is_shown([("r", "1")]) == "eq:x:1"
    numbers.number([[("r", "2")]])
    assert numbers.defined == {"r": "eq:x:2"}


FORWARD = ("0.3", "1.05", "-0.2", "1.1", "-0.25", "0.4")
"""Joints of the H6AR at which its loop closes."""


@pytest.mark.parametrize("name", ["h6ar", "h6ar_loop_closed"])
@pytest.mark.parametrize("function", ["fk", "pose"])
def test_the_lines_of_a_forward_map_compute_it(name: str, function: str) -> None:
    """Also those of the pose, which goes on in the angles that the forward map has found."""
    d = derivation(name)
    page = Page(d, Proof(d.name, d.paper.key, (), 0, ()))
    first = page.algorithm(d["fk"])
    at = {p.symbol: sp.Rational(p.value) for p in d.parameters}
    at |= dict(zip(d.actuated, map(sp.Rational, FORWARD), strict=True))
    known = dict(at)
    computed(first, known)
    algorithm = page.algorithm(d[function])
    found = computed(algorithm, known)
    wanted = run(d[function], at)
    assert all(abs(e - w) < 1e-25 for e, w in zip(found, wanted, strict=True))
    text = " ".join(line.text for line in algorithm.lines())
    assert r"\psi" in text and "c_{\\psi}" not in text


def run(function: Function, at: dict) -> list[sp.Expr]:
    """What the program of a function returns, statement by statement."""
    values = dict(at)
    for statement in function.body:
        if isinstance(statement, Vanishes):
            values[statement.symbol] = sp.false
        elif isinstance(statement, Let | Bound):
            values[statement.symbol] = sp.N(substitute(statement.value, values), 40)
    return [sp.N(substitute(e, values), 30) for a in function.outputs for e in a.entries]


def computed(algorithm: Algorithm, known: dict) -> list[sp.Expr]:
    """What the printed lines compute, which come to be ``known``."""
    algorithm.lines()
    for symbol in algorithm.values:
        if symbol in algorithm.printed and symbol not in known:
            known[symbol] = sp.N(algorithm.value(symbol).xreplace(known), 40)
            known[algorithm.known.get(symbol, symbol)] = known[symbol]
    return [sp.N(algorithm.shown(e).xreplace(known), 30) for e in algorithm.outputs]


def test_what_depends_on_a_branch_is_computed_for_each() -> None:
    d = derivation("agile_wrist")
    page = Page(d, Proof(d.name, d.paper.key, (), 0, ()))
    lines = [line.text for line in page.algorithm(d["jacobian_parallel"]).lines()]
    [branches] = [k for k, text in enumerate(lines) if "for each" in text]
    assert all("R_{13}" not in text for text in lines[:branches])
