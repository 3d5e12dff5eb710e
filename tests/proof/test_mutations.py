"""Every claim of every paper is judged by its printed text: a changed text changes the verdict."""

import re
from collections.abc import Iterator
from decimal import Decimal
from itertools import zip_longest

import pytest
import sympy as sp
from claimed import derivation, result
from sympy import pi

from closedform.algebra.normal_form import equal
from closedform.model.claims import HOLDS, NOT_DECIDABLE, PIECE, Check, Claim
from closedform.model.functions import real
from closedform.model.notation import Notation, Relation
from closedform.pipeline.scripts import Source, sources
from closedform.proof.checks.equations import Equal
from closedform.proof.checks.statements import Enumeration, ForAll, Rounded, Undecidable
from closedform.proof.claims import judged
from closedform.proof.mutations import Mutation, mutations, outcomes

REVERSING = re.compile(
    r"\b(not|no|never|none|neither|nor|cannot|without|all|every|always|only|must)\b", re.IGNORECASE
)
NOT_REVERSING = {
    ("planar_2r", "joint variables"): "it must be observed that: the words introduce the statement",
    ("h6ar", "six freedoms by Kutzbach"): "the words say how the wrist is represented",
    ("h6ar", "singular wrist"): "the words state a case; eq. (10) is about the opposite one",
    ("irb260", "inverse kinematics"): "the words say what the paper leaves out",
}
x, y = real("x"), real("y")
NAMES = Notation({"x": x, "y": y, r"\theta_1": real("t1"), r"\theta_2": real("t2")})


@pytest.mark.parametrize("source", sources(), ids=lambda s: s.name)
def test_every_claim_is_judged_by_its_text(source: Source) -> None:
    claims = derivation(source.name).claims
    labels = [c.label for c in claims]
    assert len(set(labels)) == len(labels), "two claims have the same label"
    found = ((c, result(source.name, c.label)) for c in claims)
    assert [fault for c, r in found for fault in faults(c, held=r.kind)] == []


@pytest.mark.parametrize("source", sources(), ids=lambda s: s.name)
def test_words_that_reverse_a_statement_are_judged(source: Source) -> None:
    """Such a word stands in braces: a phrase of the claim contains it, or it has an opposite."""
    left = {
        (source.name, c.label)
        for c in derivation(source.name).claims
        if REVERSING.search(PIECE.sub("", c.printed))
        and result(source.name, c.label).kind != NOT_DECIDABLE
    }
    assert left == {place for place in NOT_REVERSING if place[0] == source.name}


def faults(claim: Claim, *, held: str = "") -> Iterator[str]:
    """What is wrong with a claim: it cannot be changed, or its check ignores a piece of it.

    ``held`` is the verdict of the printed text, if that is known.
    """
    held = held or judged(claim, claim.printed).kind
    if held == NOT_DECIDABLE:
        return
    found = [*outcomes(claim, held=held in HOLDS)]
    if not any(o.changes for o in found) and not claim.fixed:
        yield f"{claim.label}: no change of the text changes the verdict, and no reason is given"
    if held not in HOLDS:
        return
    for outcome in found:
        known = outcome.error or outcome.changes or claim.fixed
        if not (known or equivalent(claim, outcome.mutation)):
            yield f"{claim.label}: {outcome.mutation}: it is still {outcome.kind}"


def equivalent(claim: Claim, mutation: Mutation) -> bool:
    """Whether a changed text says the same, or says less.

    A weaker inequality holds as well, and so does an equation that has lost one of its sides.
    A decimal halfway between two is rounded to both; one less in its last digit has to be wrong.
    """
    if mutation.kind == "number" and "." in mutation.old:
        text, last = claim.printed, Decimal(mutation.old).as_tuple().exponent
        less = str(Decimal(mutation.old) - Decimal((0, (1,), int(last))))
        place = next(k for k, (a, b) in enumerate(zip(text, mutation.text, strict=True)) if a != b)
        start = text.rfind(mutation.old, 0, place + len(mutation.old))
        changed = text[:start] + less + text[start + len(mutation.old) :]
        return judged(claim, changed).kind not in HOLDS
    printed, changed = (
        [m["formula"] for m in PIECE.finditer(text) if m["formula"] is not None]
        for text in (claim.printed, mutation.text)
    )
    pairs = [pair for pair in zip_longest(printed, changed) if pair[0] != pair[1]]
    return bool(pairs) and all(same(claim.notation, a, b) for a, b in pairs)


def same(notation: Notation, a: str, b: str) -> bool:
    first, second = notation.read(a), notation.read(b)
    return len(first) == len(second) and all(map(same_relation, first, second))


def same_relation(a: Relation, b: Relation) -> bool:
    if a.signs != b.signs or len(a.sides) != len(b.sides):
        return False
    if set(a.signs) & {"<", ">", "<=", ">=", "!="}:
        return True  # the change of the sign itself is another mutation
    if set(a.signs) == {"="} and set(b.sides) < set(a.sides):
        return True
    return all(map(same_value, a.sides, b.sides))


def same_value(a: sp.Expr | sp.MatrixBase, b: sp.Expr | sp.MatrixBase) -> bool:
    if getattr(a, "shape", None) != getattr(b, "shape", None):
        return False
    entries = zip(a, b, strict=True) if isinstance(a, sp.MatrixBase) else [(a, b)]
    return all(p == q or ((p - q) / (2 * pi)).is_integer or bool(equal(p, q)) for p, q in entries)


def claim(printed: str, check: object = None, **more: object) -> Claim:
    return Claim("eq. (1)", printed, check, notation=NAMES, **more)  # type: ignore[arg-type]


def changes(printed: str, **more: object) -> list[str]:
    more.setdefault("opposites", {"must": "need not"})
    return [str(m) for m in mutations(claim(printed, **more))]


class TestMutations:
    @pytest.mark.parametrize(
        ("printed", "expected"),
        [
            ("$x = -y$", ["name x -> y", "sign - -> +", "name y -> x"]),
            (r"$1 = \pm\sin x$", ["number 1 -> 2", r"sign \pm -> + ", r"function \sin -> \cos",
                                   "name x -> y"]),
            ("$1.09 = 3$", ["number 1.09 -> 1.10", "number 3 -> 4"]),
            (r"$\theta_{1} < 2$", [r"name \theta_{1} -> \theta_2", "relation < -> > ",
                                    "number 2 -> 3"]),
            ("{four} edges", ["phrase four -> five", "phrase four -> infinite"]),
            ("{infinite} many", ["phrase infinite -> one"]),
            ("it {must} be $x$", ["word must -> need not", "name x -> y"]),
        ],
    )  # fmt: skip
    def test_every_place_changes_once(self, printed: str, expected: list[str]) -> None:
        assert changes(printed) == expected

    def test_phrases_change_to_those_that_mean_something_else(self) -> None:
        where = [{"above": 1, "over": 1, "below": -1}]
        assert changes("{above}", phrases=where) == ["phrase above -> below"]

    def test_the_text_around_a_change_stays(self) -> None:
        texts = [m.text for m in mutations(claim(r"is $x$ {two} $\theta_{1} = 1$ so"))]
        assert texts == [
            r"is $y$ {two} $\theta_{1} = 1$ so",
            r"is $x$ {three} $\theta_{1} = 1$ so",
            r"is $x$ {infinite} $\theta_{1} = 1$ so",
            r"is $x$ {two} $\theta_2 = 1$ so",
            r"is $x$ {two} $\theta_{1} = 2$ so",
        ]

    def test_of_a_fault_the_correction_is_tried(self) -> None:
        wrong = claim("$x = y$", corrected="$x = x$")
        (outcome,) = outcomes(wrong)
        assert outcome.mutation.kind == "correction" and outcome.changes


def first_side_only(relation: Relation) -> Check:
    return Enumeration(relation.left, lambda: x, "the left side")


class TestFaults:
    """A check that ignores a piece of its claim is found."""

    @pytest.mark.parametrize(
        ("bad", "fault"),
        [
            (claim("$x = 2y$", first_side_only), "number 2 -> 3: it is still proved"),
            (claim("$x = 2y$", first_side_only), "name y -> x: it is still proved"),
            (claim("{two} edges", lambda _: Enumeration(1, lambda: 1, "one")), "no change of"),
            (claim("an edge", lambda: Enumeration(1, lambda: 1, "one")), "no change of the text"),
            (claim("$x = 1$", lambda _: Enumeration(1, lambda: 2, "one")), "no change of the text"),
        ],
    )
    def test_what_is_ignored_is_named(self, bad: Claim, fault: str) -> None:
        assert any(fault in found for found in faults(bad))

    @pytest.mark.parametrize(
        "good",
        [
            claim("$x = x$"),
            claim("$x + 0 y = x$"),
            claim(r"$x = x + y - y = 2 x / 2$"),
            claim("$x y^0 = x$"),
            claim("an edge", lambda: Enumeration(1, lambda: 1, "one"), fixed="it has no piece"),
            claim("$x$ {two}", lambda *_: Undecidable("a figure")),
            claim("$x^2 > -1$", lambda r: ForAll(r.relational)),
            claim(r"$\sin^2 x + \cos^2 x = 1$", lambda r: Equal(r)),
            claim("$0.125 = 0.12$", lambda r: Rounded(r, r.left), fixed="a decimal halfway"),
        ],
        ids=lambda c: c.printed,
    )
    def test_what_is_equivalent_or_cannot_be_decided_is_not(self, good: Claim) -> None:
        assert list(faults(good)) == []

    def test_an_error_of_a_check_is_not_a_change(self) -> None:
        def strict(relation: Relation) -> Check:
            if relation.right != y:
                raise KeyError("only y")
            return Equal(NAMES.read("x = x"))

        found = list(outcomes(claim("$x = y$", strict)))
        assert any("KeyError" in o.error for o in found)
        assert any("no change of the text" in f for f in faults(claim("$1 = y$", strict)))
        assert not any(o.changes for o in found)


def test_an_unfinished_text_is_refused() -> None:
    for text in ("$x = y", "{two", "two}", "$x$ and $"):
        with pytest.raises(ValueError, match="is not closed"):
            claim(text)
