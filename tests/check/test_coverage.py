"""A paper's text beside the claims that quote it: what is covered by neither is found."""

from dataclasses import replace

import pytest

from closedform.check.coverage import Gap, cover, fragments
from closedform.model.claims import Claim
from closedform.model.derivation import Paper
from closedform.model.notation import Notation

TEXT = """Abstract. We present a planar arm with two links.

The arm is a “novel” design - see Smith for others of its kind. $$ y = l_{1}
\\sin \\theta_1 \\tag{2} $$
It has eight modes of working, and two of these are singular. The hand draws a line.
It has eight modes of working.

References: Smith, On arms.
"""
PAPER = Paper("arm", "An arm", ("A. Nonymous",))
SCOPE = (
    ("Abstract.", "two links.", "an introduction"),
    ("The arm is", "of its kind.", "literature"),
    ("References:", "On arms.", "references"),
)
NAMES = Notation({})


def claim(printed: str, *, paraphrase: bool = False) -> Claim:
    where = [{"eight": 8}, {"two": 2}]
    return Claim("a", printed, None, notation=NAMES, phrases=tuple(where), paraphrase=paraphrase)


QUOTED = (
    claim(r"$y = l_{1} \sin\theta_1$"),
    claim("“It has {eight} modes of working[...] and {two} of these are singular.”"),
)
LINE = claim("“The hand draws a line.”")


def test_all_is_covered() -> None:
    found = cover(replace(PAPER, out_of_scope=SCOPE), [*QUOTED, LINE], TEXT)
    assert (found.gaps, found.unfound) == ((), ())
    assert found.quoted > 0 and found.out_of_scope > 0


def test_a_statement_without_a_claim_is_a_gap() -> None:
    found = cover(replace(PAPER, out_of_scope=SCOPE), QUOTED, TEXT)
    assert found.gaps == (Gap(5, "The hand draws a line."),)
    assert found.left > 0 and not found.unfound


def test_without_claims_the_whole_text_is_a_gap() -> None:
    found = cover(PAPER, [], TEXT)
    assert len(found.gaps) == 1 and found.gaps[0].line == 1
    assert found.quoted == found.out_of_scope == 0


def test_every_repetition_of_a_quotation_is_covered() -> None:
    repeated = claim("“It has {eight} modes of working”")
    found = cover(PAPER, [repeated], TEXT)
    assert all("eight modes" not in gap.text for gap in found.gaps)


def test_a_quotation_that_the_paper_does_not_print_is_named() -> None:
    wrong = claim("“It has {eight} modes of operation”")
    assert cover(PAPER, [wrong], TEXT).unfound == ("a: “It has eight modes of operation”",)
    formula = claim(r"$y = l_1 \cos\theta_1$")
    assert cover(PAPER, [formula], TEXT).unfound == (r"a: $y = l_1 \cos\theta_1$",)


def test_a_paraphrase_need_not_be_verbatim() -> None:
    assert not cover(PAPER, [claim("eight modes of operation", paraphrase=True)], TEXT).unfound


@pytest.mark.parametrize("omission", ["[...]", "…"])
def test_a_quotation_with_a_wrong_half_is_named(omission: str) -> None:
    half = claim(f"“The hand draws a line. {omission} It is blue.”")
    assert len(cover(PAPER, [half], TEXT).unfound) == 1


@pytest.mark.parametrize(
    "passage", [("The arm is a", "of no kind.", "wrong"), ("of its kind", "The arm", "turned")]
)
def test_a_passage_out_of_scope_has_to_be_there(passage: tuple[str, str, str]) -> None:
    found = cover(replace(PAPER, out_of_scope=(passage,)), [], TEXT)
    assert found.unfound == (f"out of scope: {passage[0]} ... {passage[1]}",)


def test_spaces_quotation_marks_and_numbers_of_equations_do_not_matter() -> None:
    other = claim('a "novel"   design – see')
    formula = claim(r"$y=l_{1}\sin\theta_1$")
    assert not cover(PAPER, [other, formula], TEXT).unfound
    found = cover(replace(PAPER, out_of_scope=SCOPE), [*QUOTED, LINE], TEXT)
    assert not any("tag" in gap.text for gap in found.gaps)


def test_fragments() -> None:
    assert fragments("Fig. 2: “one two [...] three four”, “fife”") == [
        "one two ",
        " three four",
        "fife",
    ]
    assert fragments("all of it") == ["all of it"]
    assert fragments("“a” and “long enough”") == ["long enough"]
