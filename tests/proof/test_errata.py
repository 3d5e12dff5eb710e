"""The list of errors of a paper: grouped, gravest first, with all places."""

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from wrong_paper import PAPER, derivation, proof

from closedform.emit import errata_text
from closedform.emit.backends.latex.errata import context, formula, markdown, stacked
from closedform.emit.errata import KINDS, MEANINGS, Part, gathered, part
from closedform.emit.render import render
from closedform.emit.terminal import WIDTH
from closedform.model.claims import REFUTED, VERDICTS, Gravity
from closedform.proof.claims import ClaimResult, ErratumResult

ONE = derivation()
PROOF = proof(ONE)
EXPECTED = Path(__file__).with_name("wrong_paper.md")


def own() -> Part:
    found = part(ONE, PROOF)
    assert found is not None
    return found


def page(*parts: Part | None) -> str:
    return render("errata.md.jinja", context(parts))


def test_a_wrong_paper_gives_the_expected_page() -> None:
    text = page(own())
    assert text[text.index('<a id="wrong">') :] == EXPECTED.read_text("utf-8")


def test_errors_are_counted_once_however_often_they_stand() -> None:
    (paper,) = gathered([own()])
    assert paper.errors() == {"Errors": 3, "Inconsistencies": 1, "Omissions": 1, "Misprints": 1}
    assert paper.verdicts()[REFUTED] == 5
    assert "| [On one link \\& its errors](#wrong) | 3 | 1 | 1 | 1 | 10 |" in page(own())


def test_a_terminal_gets_text() -> None:
    """The same errors, without marks of Markdown or LaTeX, in lines that fit."""
    text = errata_text.text([own()])
    (paper,) = gathered([own()])
    for entry in paper.entries:
        assert f"\n{entry.number}. " in text and entry.gravity.value[1:] in " ".join(text.split())
    assert not re.search(r"\$|\\\\|\*\*|<a |&amp;", text)
    assert "\n   eq. (2)" in text and "\n     printed: " in text
    assert max(map(len, text.splitlines())) <= WIDTH
    assert text.endswith("\n") and not text.startswith("\n") and "\n\n\n" not in text


def test_the_gravest_comes_first() -> None:
    (paper,) = gathered([own()])
    order = list(Gravity)
    assert all(order.index(a.gravity) <= order.index(b.gravity) for a, b in pairwise(paper.entries))
    assert [e.number for e in paper.entries] == [1, 2, 3, 4, 5, 6]
    assert paper.entries[0].erratum.key == "cosine"
    assert [c.label for c in paper.entries[0].claims] == ["eq. (2)", "eq. (2), again"]


def test_every_gravity_and_every_verdict_has_its_place() -> None:
    assert [g for kinds in KINDS.values() for g in kinds] == list(Gravity)
    assert set(MEANINGS) == set(VERDICTS)


def test_the_worst_verdict_leads() -> None:
    (paper,) = gathered([own()])
    entry = paper.entries[0]
    kinds = ("proved under assumption", "refuted", "incomplete")
    mixed = replace(entry, claims=tuple(replace(entry.claims[0], kind=k) for k in kinds))
    assert mixed.verdicts == ("refuted", "incomplete", "proved under assumption")


class TestSeveralMechanisms:
    def test_of_one_paper_give_one_list(self) -> None:
        other = replace(own(), robot="other")
        assert page(own(), other) == page(own())

    def test_each_adds_its_places(self) -> None:
        claim = ClaimResult(
            label="eq. (9)",
            where="",
            printed="$y$",
            kind=REFUTED,
            evidence="",
            corrected="",
            readings=(),
            erratum="cosine",
        )
        other = replace(own(), robot="other", claims=(claim,))
        (paper,) = gathered([own(), None, other])
        assert [c.label for c in paper.entries[0].claims][-1] == "eq. (9)"
        assert len(paper.claims) == len(PROOF.claims) + 1

    def test_that_describe_an_error_differently_are_refused(self) -> None:
        errata = (replace(PROOF.errata[0], why="Otherwise."),)
        other = replace(own(), robot="other", errata=errata)
        with pytest.raises(ValueError, match="one_link and other describe the erratum typo"):
            gathered([own(), other])

    def test_of_two_papers_are_apart(self) -> None:
        paper = replace(PAPER, key="second", title="Second")
        text = page(own(), replace(own(), paper=paper))
        assert text.count("\n## ") == 2
        assert "| all | 6 | 2 | 2 | 2 | 20 |" in text


def test_a_paper_without_errors_says_so() -> None:
    proved = tuple(c for c in PROOF.claims if c.kind == "proved")
    text = page(replace(own(), claims=proved, errata=()))
    assert "No error was found." in text
    assert "### " not in text
    assert "Claims proved as printed: 1 of 1." in text


def test_mechanisms_without_claims_are_left_out() -> None:
    assert part(ONE, replace(PROOF, claims=())) is None
    assert page(None).count("## ") == 0


@pytest.mark.parametrize("text", [page(own()), page(own(), None)])
def test_the_page_is_well_formed(text: str) -> None:
    anchors = re.findall(r'<a id="([^"]+)"></a>', text)
    links = re.findall(r"\]\(#([^)]+)\)", text)
    assert len(set(anchors)) == len(anchors)
    assert set(links) <= set(anchors)
    assert "\n\n\n" not in text and not re.search(r"[ \t]\n", text)
    for row in (line for line in text.splitlines() if line.startswith("|")):
        assert row.endswith("|")
    tables = re.findall(r"(?:^\|.*\n)+", text, flags=re.MULTILINE)
    for table in tables:
        cells = {len(re.findall(r"(?<!\\)\|", row)) for row in table.splitlines()}
        assert len(cells) == 1, table


def test_formulas_survive_markdown() -> None:
    assert markdown("5 * a_b of $x_1 | y$") == r"5 \* a\_b of $`x_1 \vert y`$"
    assert markdown("a $x$, $y$ b ") == "a $`x`$, $`y`$ b "
    assert formula(r"\| v \| = `a`") == r"\Vert v \Vert = 'a'"
    assert markdown("") == ""


def test_a_long_formula_stands_alone() -> None:
    long = "x + " * 20 + "x"
    assert stacked(f"${long}$").splitlines() == [
        "",
        "    ```math",
        f"    {long}",
        "    ```",
    ]
    assert stacked("$x$") == " $`x`$"
    assert "```math" not in stacked(f"so ${long}$")


def test_an_erratum_keeps_its_gravity() -> None:
    assert all(isinstance(e, ErratumResult) and Gravity[e.gravity] for e in PROOF.errata)
