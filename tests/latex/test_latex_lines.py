"""The lines of an algorithm: what they use is defined before them, and what they define is used."""

import re
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
import sympy as sp
from places import ROOT

from closedform.emit.backends.latex.article import Page, document
from closedform.emit.backends.latex.formulas import Printer
from closedform.emit.backends.latex.grouping import joint_by_joint
from closedform.emit.backends.latex.listing import parts_first
from closedform.emit.backends.latex.names import Quantities
from closedform.emit.backends.latex.twins import twins
from closedform.emit.backends.latex.wide import Lines, unit_circles
from closedform.lemmas.two_link import two_link_arm
from closedform.model.expressions import substitute
from closedform.model.functions import Bound, Let, Program, Vanishes, real
from closedform.proof.prove import Proof

GENERATED = ROOT / "generated" / "latex"
ARTICLES = sorted(p for p in GENERATED.glob("*.tex") if p.stem != "closedform")
BOX = re.compile(r"\\begin\{algorithm\}\{(.*?)\}\n(.*?)\\end\{algorithm\}", re.S)
STEP = re.compile(r"\\algorithmstep\{\d\}\{(.*)\}\{.*\}")
RESULT = re.compile(r"\\(?:theta|rho|psi|phi|alpha)_|[JTABdp]_")
"""Names of joints and of entries of what a function returns."""


def page(name: str) -> Page:
    d = import_module(f"closedform.derivations.{name}").d
    return Page(d, Proof(d.name, d.paper.key, (), 0, ()))


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_names_are_defined_before_they_are_used_and_used_at_all(tex: Path) -> None:
    text = tex.read_text("utf-8")
    boxes = list(BOX.finditer(text))
    assert boxes
    for box in boxes:
        items = [i for line in STEP.findall(box[2]) for i in line.split(r",\quad ")]
        made = [m[1] if (m := re.match(r"\$\\displaystyle (.*?) = ", i)) else "" for i in items]
        for name, item in zip(made, items, strict=True):
            left, right = (re.sub("[{}$]", "", s) for s in (name, item.rpartition(" = ")[2]))
            assert left != right, (box[1], item)
        for k, name in enumerate(made):
            if "_{" not in name:
                continue
            pairs = zip(items[:k], made[:k], strict=True)
            before = [i.removeprefix(rf"$\displaystyle {n} = ") for i, n in pairs]
            assert not any(name in i for i in before), (box[1], name)
            later = " ".join(items[k + 1 :]) + text[box.end() :]
            entry = re.fullmatch(r"(M)_\{\d\d\}", name)  # of a rotation in a product
            assert name in later or RESULT.match(name) or (entry and entry[1] in later), name


@pytest.mark.parametrize("tex", ARTICLES, ids=lambda path: path.stem)
def test_the_name_of_a_matrix_is_not_that_of_a_number(tex: Path) -> None:
    """N was a factor of the Jacobian in a step, and a squared length in an algorithm."""
    text = tex.read_text("utf-8")
    matrices = set(re.findall(r"(?m)^(\S+) &= \\begin\{bmatrix\}", text))
    for box in BOX.finditer(text):
        items = [i for line in STEP.findall(box[2]) for i in line.split(r",\quad ")]
        made = [m for i in items if (m := re.match(r"\$\\displaystyle (\S+) = (.*)", i))]
        assert not {m[1] for m in made if "bmatrix" not in m[2]} & matrices, box[1]


def test_the_part_of_a_part_stands_first() -> None:
    texts = [r"$\displaystyle x = u_{1}$", *(rf"$\displaystyle {n} = {e}$" for n, e in (
        ("u_{1}", "a u_{3} + u_{2}"), ("u_{2}", "b + u_{3}"), ("u_{3}", "c"),
    ))]  # fmt: skip
    names = ["u_{1}", "u_{2}", "u_{3}"]
    found = [re.sub(r"\$\\displaystyle (.*?) = .*", r"\1", t) for t in parts_first(names, texts)]
    assert found == ["u_{3}", "u_{2}", "u_{1}", "x"]


def test_a_function_is_told_in_the_names_of_the_steps() -> None:
    context = document(page("h6ar").derivation, Proof("h6ar", "", (), 0, ()))
    fk = next(f for f in context["functions"] if f["name"] == "fk")
    text = " ".join(line.text for line in fk["lines"])
    assert r"x = r_W \mathrm{c}_{1} - L_\theta \mathrm{s}_{1}" in text
    assert all(name in fk["borrowed"] for name in ("$r_W$", r"$L_\theta$", r"\eqref"))


def test_a_narrow_quantity_is_found_inside_another_one() -> None:
    a, b, c = map(real, "abc")
    quantities = Quantities(Printer(set()), ())
    quantities.define("s", a + b)
    quantities.define("t", sp.sin(c) * real("s") + c)
    own = {"a": a, "b": b, "c": c}
    (t,) = quantities.of_a_function((a + b) * sp.sin(c) + c, (), own).free_symbols
    assert str(t) == "t " and quantities.in_value(t) == {"t"}
    assert quantities(a + b) == a + b  # a step does not shorten what is short


def test_the_sine_of_a_difference_takes_a_minus_in() -> None:
    a, b, c = map(real, "abc")
    math = Printer(set()).math
    assert math(-c * sp.sin(a - b)) == r"c \sin (b - a)"
    assert math(-c / sp.sin(a - b)) == r"\frac{c}{\sin (b - a)}"
    assert math(-c * sp.sin(a + b)) == r"- c \sin (a + b)"
    assert math(-c * sp.cos(a - b)) == r"- c \cos (a - b)"


# Two parts that differ in names alone


def test_two_equal_arms_are_told_once() -> None:
    found = page("h6ar_loop_closed")
    algorithm = found.algorithm(found.derivation["ik"])
    pair = algorithm.twins
    assert pair is not None and pair.differences == (("R", "L"),)
    flags = {s.symbol: sp.false for s in algorithm.function.body if isinstance(s, Vanishes)}
    values = {
        s.symbol: substitute(s.value, flags)
        for s in algorithm.function.body
        if isinstance(s, Let | Bound)
    }
    told = [s for s in pair.alike if s in values]
    assert len(told) >= 5
    for s in told:
        assert values[s].xreplace(dict(pair.symbols)) == values[pair.symbols[s]]
    assert {str(s) for s in pair.apart} == {"r_right", "h_right", "sigma_right"}
    texts = [line.text for line in algorithm.lines()]
    assert sum(r"\theta_2^j = " in t for t in texts) == 1  # r_i would look like r_I
    assert not any(rf"\theta_2^{side} = " in t for t in texts for side in "RL")
    assert sum("r_R = " in t for t in texts) == sum("r_L = " in t for t in texts) == 1


JOINTS = (("theta2R", "theta3R"), ("theta2L", "theta3L"))


def two_arms(
    lengths: tuple[str, str], names: tuple[str, str], joints: tuple[tuple[str, str], ...] = JOINTS
) -> tuple[Any, ...]:
    """Two arms of two links; the last length of each, and what the names of each end in."""
    p = Program()
    arms = []
    for own, last, name in zip(joints, lengths, names, strict=True):
        ends = tuple(p.let(f"{k}_{name}", real(f"{k}0") ** 2) for k in "rh")
        pair = tuple(map(real, own))
        sigma = p.let(f"sigma_{name}", real("tau"))
        links = (real("l_1"), real("l_2"), real(last))
        arms.append(two_link_arm(p, links, ends, pair, sigma, suffix=f"_{name}"))
    flags = {s.symbol: s for s in p.body if isinstance(s, Vanishes)}
    usual = dict.fromkeys(flags, sp.false)
    values = {s.symbol: substitute(s.value, usual) for s in p.body if isinstance(s, Let | Bound)}
    for arm in arms:
        angles = {**arm.solution, **arm.plainly}
        values |= {u: substitute(e, usual) for u, e in angles.items()}
    return twins(arms, values, flags), *arms


def test_twins_are_found_by_what_their_names_stand_for() -> None:
    found, one, other = two_arms(("l_3", "l_3"), ("a", "left_behind"))
    assert found is not None and found.lemmas == (one, other) and found.differences == (("R", "L"),)
    assert real("r_left_behind") in found.symbols.values()


@pytest.mark.parametrize(
    ("joints", "each", "told"),
    [
        (JOINTS, "$i = R,\\ L$", (r"\theta_{2\mathrm{R}}", r"\theta_{2i}")),
        (
            (("alpha_right", "beta_right"), ("alpha_left", "beta_left")),
            r"$i = \mathrm{right},\ \mathrm{left}$",
            (r"\alpha_{\mathrm{right}}", r"\alpha_{i}"),
        ),
        (
            (("theta1", "theta2"), ("theta3", "theta4")),
            r"$(i,\ j) = (1,\ 2),\ (3,\ 4)$",
            (r"\theta_{2}", r"\theta_{j}"),
        ),
    ],
)
def test_twins_are_named_by_what_differs_in_their_joints(
    joints: tuple[tuple[str, str], ...], each: str, told: tuple[str, str]
) -> None:
    found = two_arms(("l_3", "l_3"), ("a", "b"), joints)[0]
    assert found is not None and found.each == each
    printer = Printer(set())
    shown = {printer.doprint(s) for s in found.symbols}
    with found.as_one(printer):
        once = {printer.doprint(s) for s in found.symbols}
    assert told[0] in shown - once and told[1] in once - shown
    assert len(once) == len(found.symbols)


def test_an_index_of_twins_differs_from_those_of_other_names() -> None:
    found = two_arms(("l_3", "l_3"), ("a", "b"))[0]
    assert found.beside(["r_I", r"k_{j}", "i"]).each == r"$k = R,\ L$"


def test_lemmas_with_other_lengths_are_no_twins() -> None:
    assert two_arms(("l_3", "l_4"), ("R", "L"))[0] is None


def test_squares_of_a_sine_and_a_cosine_are_added() -> None:
    a, b, c, x = map(real, "abcx")
    circle = (a * c - b * sp.cos(x)) * sp.cos(x) + (a * b - b * sp.sin(x)) * sp.sin(x)
    shorter = list(unit_circles(circle))
    assert any(sp.expand(e + b - a * c * sp.cos(x) - a * b * sp.sin(x)) == 0 for e in shorter)
    assert not list(unit_circles(a * sp.cos(x) + b * sp.sin(x)))
    value = (a * sp.sin(x) + b) * sp.sin(x) + (a * sp.cos(x) + c) * sp.cos(x)
    assert page("delta").lines.tidy(value) == a + b * sp.sin(x) + c * sp.cos(x)


def test_a_distance_in_a_table_has_the_difference_of_its_angles() -> None:
    a, b = map(real, "ab")
    distance = sp.sqrt(2 * (1 - sp.sin(a) * sp.sin(b) - sp.cos(a) * sp.cos(b)))
    assert r"\cos (a - b)" in page("delta").cell(distance)


def test_a_product_of_sums_is_not_multiplied_out() -> None:
    a, b, m, n = map(real, "abmn")
    value = m * (a + b) + n * (a - b)
    assert page("planar_2r").lines.tidy(value) == value


def test_a_direction_less_an_angle_is_told_as_such() -> None:
    context = document(page("planar_2r").derivation, Proof("planar_2r", "", (), 0, ()))
    ik = next(f for f in context["inverses"] if f["name"] == "ik")
    text = " ".join(line.text for line in ik["lines"])
    assert r"\theta_{1} = \operatorname{atan2}(p_{y},\ p_{x}) - \alpha" in text
    (defined,) = (
        row.label
        for step in context["steps"]
        for block in step["blocks"]
        for row in block.rows
        if row.left == r"\alpha"
    )
    assert any(defined in s["seen"] for s in ik["stages"])


def test_sums_are_collected_joint_by_joint() -> None:
    q = [real(f"theta{k}") for k in range(7)]
    c, s = [sp.cos(a) for a in q], [sp.sin(a) for a in q]
    c23, s23 = sp.cos(q[2] + q[3]), sp.sin(q[2] + q[3])
    inner = c23 * (c[4] * c[5] * c[6] - s[4] * s[6]) - s23 * s[5] * c[6]
    entry = c[1] * inner - s[1] * (s[4] * c[5] * c[6] + c[4] * s[6])
    assert joint_by_joint(sp.expand(entry)) == entry
    lines = Lines(Printer(set(q)), ())
    assert lines.tidy(sp.expand(entry)) == entry
    a, b = real("a"), real("b")
    negative = joint_by_joint(sp.expand(-c[1] * (a + b * c[2]) + s[1] * c[2]))
    assert -c[1] * (a + b * c[2]) in negative.args  # the sign stands before the joint
    assert joint_by_joint(a * c[1] + b) == a * c[1] + b


def test_a_quantity_is_found_in_what_a_joint_multiplies() -> None:
    a, b, q, p = map(real, ("a", "b", "theta1", "theta2"))
    X = a * sp.cos(p) + b * sp.sin(p) + a * b * sp.cos(p) ** 2
    quantities = Quantities(Printer({q, p}), ())
    quantities.define("X", X)
    named = quantities(sp.expand(X * sp.cos(q)) + b * sp.sin(q))
    assert quantities.printer.math(named) == r"X \mathrm{c}_{1} + b \mathrm{s}_{1}"


def test_the_coordinates_of_a_vector_are_named_where_they_occur_again() -> None:
    """Except as a result, which nothing would give then, and in a program, which computes them."""
    a, b, q = map(real, ("a", "b", "theta1"))
    r = a * sp.cos(q) + b * sp.sin(q) + a * b * sp.cos(q) ** 2
    quantities = Quantities(Printer({q}), ())
    quantities.define("(r, h)_I", sp.Matrix([r, a + b]))
    math = quantities.printer.math
    assert math(quantities(r * sp.cos(q))) == r"r_{I} \mathrm{c}_{1}"
    assert math(quantities(-r)) == "- r_{I}"
    for names in ({}, {"a": a, "b": b, "theta1": q}):
        assert quantities.of_a_function(r, (), names) == r
        assert quantities.of_a_function(a + b, (), names) == a + b
        again = quantities.of_a_function(r * sp.cos(q), (), names)
        assert quantities.in_value(again) == (set() if names else {"r_{I}"})
    assert math(quantities.of_a_function(r * sp.cos(q), ())) == r"r_{I} \mathrm{c}_{1}"


def test_a_former_meaning_of_a_wide_name_serves_too() -> None:
    a, b, x, y = map(real, "abxy")
    quantities = Quantities(Printer(set()), ())
    of_joints, of_target = (sp.sqrt(u**2 + v**2 + u * v) for u, v in ((a, b), (x, y)))
    quantities.define("L", of_joints)
    quantities.define("L", of_target)
    for value in (of_joints, of_target):
        found = quantities.of_a_function(a * value, ())
        assert quantities.printer.math(found) == "a L"


def test_a_sum_behind_a_fraction_has_no_name() -> None:
    k = [real(f"k{i}") for i in range(9)]
    inner = k[6] + k[7] + k[8] + k[5] + k[4] * sp.sin(k[3]) + k[3] * sp.sin(k[2])
    angle, turn = sp.sin(sp.pi * k[0] / 6), sp.sin(sp.pi * k[1] / 12)
    value = sp.pi / 36 * (2 * k[1] * angle * turn - 3 * k[2] * angle + 6 * inner * angle * turn**2)
    lines = Lines(Printer(set()), ())
    lines.line_width = 60
    (left, right), (name, _) = lines.equations("v", value)[:2]
    assert right.startswith(r"\frac{\pi}{36} \Bigl(") and name == "u_{1}" and left == "v"
    context = document(page("irb260").derivation, Proof("irb260", "", (), 0, ()))
    blocks = [block for step in context["steps"] for block in step["blocks"]]
    velocity = next(row.right for block in blocks for row in block.rows if row.left == "v_{1}")
    assert velocity.startswith(r"\frac{\pi}{36} \Bigl(2 l_{3}")
