"""How printed text is compared with a paper, and which part of a formula a name is."""

import pytest
import sympy as sp

from closedform.check.coverage import cover
from closedform.model.claims import Claim
from closedform.model.derivation import Paper
from closedform.model.notation import Notation

PAPER = Paper("a-paper", "A paper", ("Nobody",))


@pytest.mark.parametrize(
    ("printed", "quoted", "found"),
    [
        (r"$$\text{For elbow up, } \theta_2 = 30$$", r"“For elbow up, $\theta_2 = 30$”", True),
        (r"the matrix $T_{2}^{0}$ of the arm", "“the matrix $T_2^0$ of the arm”", True),
        ("the cosine of the arm", "“the sine of the arm”", False),
    ],
)
def test_braces_are_ignored(printed: str, quoted: str, found: bool) -> None:
    covered = cover(PAPER, [Claim("claim", quoted)], printed)
    assert (covered.unfound == ()) == found


def test_a_gap_shows_the_text_as_printed() -> None:
    covered = cover(PAPER, [], r"a line with \text{words} and {braces}")
    assert [gap.text for gap in covered.gaps] == [r"a line with \text{words} and {braces"]


NOTATION = Notation(
    {"c_{12}": sp.Symbol("c12"), "s_{12}": sp.Symbol("s12"), "c_1": sp.Symbol("c1")}
)


def test_the_text_of_a_side_has_its_last_brace() -> None:
    (relation,) = NOTATION.read("c_{12} = c_1^{2}")
    assert relation.texts == ("c_{12}", "c_1^{2}")


def test_a_name_ends_after_its_brace() -> None:
    text = "c_{12} + c_1"
    names = [text[p.start : p.end] for p in NOTATION.pieces(text) if p.kind == "name"]
    assert names == ["c_{12}", "c_1"]


def test_a_number_in_braces_is_the_number_alone() -> None:
    text = "c_1^{2}"
    numbers = [text[p.start : p.end] for p in NOTATION.pieces(text) if p.kind == "number"]
    assert numbers == ["2"]
