"""What is too wide for a line or too long for a page, in articles of users' mechanisms."""

from itertools import product
from types import SimpleNamespace

import pytest
import sympy as sp
from closedform.derivations import scara

from closedform.emit.backends.latex.article import Page
from closedform.emit.backends.latex.formulas import FITS, Printer, measure
from closedform.emit.backends.latex.inverse import Told
from closedform.emit.backends.latex.wide import Lines, moduli_cancelled, unit_circles
from closedform.emit.render import render
from closedform.model.derivation import Derivation
from closedform.model.functions import real
from closedform.proof.prove import Proof

a, b, x = real("a"), real("b"), real("x")


def test_vectors_of_a_wide_table_stand_upright() -> None:
    page = Page(scara.d, Proof("scara", "", (), 0, ()))
    long = sp.Add(*(sp.sqrt(3) * real(f"l{k}") * sp.cos(real(f"q{k}")) for k in range(5)))
    narrow, wide = (sp.Matrix([[e, e, x]]) for e in (a, long))
    heading = ["point", "seen in the hand"]
    rows, upright = page.table([heading, [narrow, narrow]])
    assert not upright and " & " in rows[1][0]
    rows, upright = page.table([heading, [narrow, wide]])
    assert upright and not any(" & " in cell for cell in rows[1])
    assert rows[0] == heading


def test_a_modulus_that_cancels_is_not_printed() -> None:
    length = sp.Abs(sp.sin(a))
    direction = sp.sin(a) * sp.sin(b) / length + sp.sin(a) * sp.cos(x) / length
    expected = sp.sin(a) * sp.sin(b) + sp.sin(a) * sp.cos(x)
    assert moduli_cancelled(length * direction) == expected
    assert moduli_cancelled(sp.Matrix([[length * direction, x]])) == sp.Matrix([[expected, x]])
    assert moduli_cancelled(direction) == direction


def test_fourth_powers_of_a_sine_and_a_cosine_add_to_one_with_their_product() -> None:
    s, c = sp.sin(a), sp.cos(a)
    value = b * (s**4 + 2 * s**2 * c**2 + c**4) + x * s**2 + x * c**2
    assert b + x in list(unit_circles(sp.expand(value)))


def test_the_arguments_of_a_wide_maximum_get_names() -> None:
    least = [sp.Min(*(real(f"k{9 * j + k}") / b for k in range(9))) for j in range(4)]
    rows = Lines(Printer(set()), ()).equations("k", sp.Max(*least))
    assert all(measure(f"{left} = {right}") <= FITS for left, right in rows)
    assert len(rows) > 1 and r"\max" in rows[0][1]


@pytest.mark.parametrize(("signs", "many"), [(3, False), (6, True)])
def test_many_branches_have_their_signs_in_columns_over_pages(signs: int, many: bool) -> None:
    names = [real(f"sigma_{k}") for k in range(signs)]
    cases = [
        ("_".join("plus" if v > 0 else "minus" for v in row), dict(zip(names, row, strict=True)))
        for row in product((1, -1), repeat=signs)
    ]
    told = Told.__new__(Told)
    told.page, told.whole = Printer(set()), SimpleNamespace(cases=lambda: cases)
    rest = {"reached": "", "name": "ik", "continua": (), "proved": (), "notes": ()}
    text = render("latex/branches.tex.jinja", {"f": rest | told.branches()})
    assert text.count("plus\\_plus\\_minus") >= 1
    assert ("longtable" in text) == many
    assert ("= +1" in text) != many
    assert text.count(r"\texttt{") == 2**signs


@pytest.mark.parametrize(
    ("joints", "written"),
    [
        (("left_joint1", "left_joint2"), [r"\theta_{1}", r"\theta_{2}"]),
        (("shoulder_pan_joint", "elbow_joint"), [r"\theta_{1}", r"\theta_{2}"]),
        (("LShoulderPitch", "LElbowYaw"), [r"\theta_{1}", r"\theta_{2}"]),
        (("rho1", "theta2"), [r"\rho_{1}", r"\theta_{2}"]),
        (("q1", "q2"), ["q_{1}", "q_{2}"]),
        (("joint1", "elbow"), [r"\mathrm{joint}_{1}", r"\mathrm{elbow}"]),
    ],
)
def test_joints_that_are_called_by_words_have_short_letters(
    joints: tuple[str, ...], written: list[str]
) -> None:
    d = Derivation("arm", "Arm", scara.d.paper, "An arm.")
    symbols = [d.joint(name) for name in joints]
    page = Page(d, Proof("arm", "", (), 0, ()))
    assert [page.math(s) for s in symbols] == written
    assert [page.written(name) for name in joints] == written


def test_what_a_lemma_finds_of_a_joint_has_its_number() -> None:
    d = Derivation("arm", "Arm", scara.d.paper, "An arm.")
    first, last = d.joint("arm_joint1"), d.joint("arm_joint12")
    page = Page(d, Proof("arm", "", (), 0, ()))
    assert page.math(real("sigma_arm_joint1")) == r"\sigma_{1}"
    assert page.math(real("square_arm_joint12")) == r"\mathrm{square}_{2}"
    assert page.math(real("c_arm_joint1")) == r"c_{\theta_{1}}"
    assert page.math(sp.cos(first + last)) == r"\mathrm{c}_{12}"
    assert page.prose("arm_joint1 is free") == r"$\theta_{1}$ is free"
    d = Derivation("arm", "Arm", scara.d.paper, "An arm.")
    d.joint("LShoulderPitch")
    text = "the axis of LShoulderPitch"
    assert Page(d, Proof("arm", "", (), 0, ())).prose(text) == r"the axis of $\theta_{1}$"


def test_a_length_of_that_name_keeps_it() -> None:
    d = Derivation("arm", "Arm", scara.d.paper, "An arm.")
    d.parameter("theta1", value=sp.Integer(1), unit="rad", meaning="twist", source="example")
    joint = d.joint("arm_joint1")
    assert Page(d, Proof("arm", "", (), 0, ())).math(joint) != r"\theta_{1}"
