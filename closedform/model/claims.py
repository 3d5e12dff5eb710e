"""Claims of a paper: what it prints, the check that judges it, and the errata that follow.

A claim is one object: its text contains the formulas and the phrases that are judged.  Formulas
stand between dollar signs and are read by the :class:`~closedform.model.notation.Notation` of the
paper.  Phrases stand in braces, as in ``the closed chain admits {eight} working modes``; each is
looked up among the ``phrases`` of the claim or among :data:`NUMBERS`.  The check is a function of
these pieces, in their order.  So a changed text is judged as another claim.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from closedform.model.display import Shown
from closedform.model.names import check_formulas, check_key, check_text
from closedform.model.notation import Notation, Relation

PROVED = "proved"
PROVED_UNDER = "proved under assumption"
APPROXIMATION = "approximation"
INCOMPLETE = "incomplete"
INCONSISTENT = "inconsistent"
REFUTED = "refuted"
NOT_DECIDABLE = "not decidable here"
VERDICTS = (
    PROVED,
    PROVED_UNDER,
    APPROXIMATION,
    INCOMPLETE,
    INCONSISTENT,
    REFUTED,
    NOT_DECIDABLE,
)
HOLDS = (PROVED, PROVED_UNDER)
FAULTS = (APPROXIMATION, INCOMPLETE, INCONSISTENT, REFUTED)
"""The verdicts that an erratum has to explain."""

NUMBERS: dict[str, int | None] = {
    "zero": 0,
    "no": 0,
    "one": 1,
    "two": 2,
    "both": 2,
    "three": 3,
    "four": 4,
    "five": 5,
    "six": 6,
    "seven": 7,
    "eight": 8,
    "nine": 9,
    "ten": 10,
    "eleven": 11,
    "twelve": 12,
    "infinite": None,
}
"""Phrases that every claim knows; ``None`` stands for infinitely many."""


@dataclass(frozen=True)
class Verdict:
    """The result of a check.

    ``evidence`` is a sentence in pieces: text, in which formulas stand between dollar signs;
    expressions, which are written in the notation of the paper; and points, which map symbols to
    values.
    """

    kind: str
    evidence: tuple[Any, ...] = ()


class Check(ABC):
    """A computation that judges one claim."""

    @abstractmethod
    def judge(self) -> Verdict: ...


@dataclass(frozen=True)
class Reading:
    """One of several ways to read a claim: ``text`` says what the words are taken to mean.

    ``means`` extends the notation; ``check`` replaces the check of the claim.
    """

    text: str
    check: Callable[..., Check] | None = None
    means: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_text("a reading", self.text)
        check_formulas("a reading", self.text)


PIECE = re.compile(r"\$(?P<formula>[^$]*)\$|\{(?P<phrase>[^{}$]*)\}")


@dataclass(frozen=True)
class Claim(Shown):
    """A statement of a paper as printed, and what judges it.

    ``check`` takes the formulas (each a tuple of relations, or the relation itself if there is one)
    and the meanings of the phrases; without it, the formulas are equations that always hold.  Each
    mapping of ``phrases`` gives the phrases that can stand in one place, with their meanings.
    ``opposites`` maps words in braces, such as "must", to words that turn the statement into its
    opposite, such as "need not"; the check does not take them, but they reverse its verdict.
    ``corrected`` is the statement that holds instead, written
    like ``printed``; the same check has to prove it.  The first of several ``readings`` is the one
    that the context of the paper supports, and gives the verdict.  ``erratum`` is the key of the
    error that the claim shows.  ``paraphrase`` marks a text that is not verbatim.  ``fixed`` is the
    reason why a change of the text may leave the verdict as it is.
    """

    label: str
    printed: str
    check: Callable[..., Check] | None = None
    where: str = ""
    notation: Notation = field(default_factory=lambda: Notation({}))
    phrases: tuple[Mapping[str, Any], ...] = ()
    opposites: Mapping[str, str] = field(default_factory=dict)
    corrected: str = ""
    readings: tuple[Reading, ...] = ()
    erratum: str = ""
    paraphrase: bool = False
    fixed: str = ""

    def __post_init__(self) -> None:
        check_text("label of a claim", self.label)
        check_text(f"claim {self.label}", self.printed, self.where, self.corrected, self.fixed)
        if isinstance(self.check, Check):
            raise TypeError(
                f"claim {self.label}: the check must be a function of the formulas and phrases "
                f"of the text, such as lambda f: Equal(f)"
            )
        for text in (self.printed, self.corrected):
            if re.search(r"[${}]", PIECE.sub("", text)):
                raise ValueError(
                    f"claim {self.label}: a dollar sign or a brace is not closed: {text}"
                )

    @property
    def text(self) -> str:
        """The printed text without the braces around its phrases."""
        return plain(self.printed)

    def checked(self, text: str, reading: Reading | None, default: Callable[..., Check]) -> Check:
        """The check of a text of this claim: printed, corrected or changed."""
        notation = self.notation.extended(reading.means) if reading else self.notation
        check = (reading.check if reading else None) or self.check or default
        return check(*self.pieces(text, notation))

    def pieces(self, text: str, notation: Notation) -> list[Any]:
        """The formulas and phrases of a text, in their order."""
        found: list[Any] = []
        for match in PIECE.finditer(text):
            if match["formula"] is not None:
                relations = notation.read(match["formula"])
                found.append(relations[0] if len(relations) == 1 else relations)
            elif match["phrase"] not in self.turning:
                found.append(self.meaning(match["phrase"]))
        return found

    @property
    def turning(self) -> set[str]:
        """The words that keep the statement or turn it into its opposite."""
        return {*self.opposites, *self.opposites.values()}

    def is_opposite(self, text: str) -> bool:
        """Whether the words of a text make it the opposite of what the check judges."""
        words = [m["phrase"] for m in PIECE.finditer(text)]
        return sum(word in self.opposites.values() for word in words) % 2 == 1

    def vocabulary(self, phrase: str) -> Mapping[str, Any]:
        """The phrases that can stand in the place of one, with their meanings."""
        for phrases in self.phrases:
            if phrase in phrases:
                return phrases
        if phrase.lower() in NUMBERS:
            return NUMBERS
        raise ValueError(f"claim {self.label}: the phrase {phrase!r} has no meaning")

    def meaning(self, phrase: str) -> Any:
        """What a phrase means."""
        phrases = self.vocabulary(phrase)
        return phrases[phrase if phrase in phrases else phrase.lower()]


def plain(text: str) -> str:
    """A text without the braces around its phrases."""
    return PIECE.sub(lambda m: m[0] if m["formula"] is not None else m["phrase"], text)


class Gravity(Enum):
    """What an erratum changes for a reader, gravest first."""

    MOTION = "changes what a robot does"
    RESULT = "changes a result or a design"
    STATEMENT = "a statement is false"
    INCONSISTENCY = "two statements cannot both hold"
    OMISSION = "a case or a solution is missing"
    MISPRINT = "a misprint; the paper goes on with the right form"


@dataclass(frozen=True)
class Erratum(Shown):
    """One error of a paper, which may stand in several places: the claims that name its key.

    ``why`` explains the error to its author, and ``use`` says what follows for someone who used it.
    ``numbers`` maps names to constants, each with a number of digits after the point: ``[miss]`` in
    the texts stands for the decimal of the constant ``miss``.
    """

    key: str
    title: str
    gravity: Gravity
    why: str
    use: str
    numbers: Mapping[str, tuple[Any, int]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_key(self.key, "key of an erratum")
        check_text(f"erratum {self.key}", self.title, self.why, self.use)
        check_formulas(f"erratum {self.key}", self.title, self.why, self.use)
        for name in self.numbers:
            if f"[{name}]" not in self.why + self.use:
                raise ValueError(f"erratum {self.key}: no text contains the number [{name}]")


__all__ = [
    "APPROXIMATION", "FAULTS", "HOLDS", "INCOMPLETE", "INCONSISTENT", "NOT_DECIDABLE", "NUMBERS",
    "PROVED", "PROVED_UNDER", "REFUTED", "VERDICTS", "Check", "Claim", "Erratum", "Gravity",
    "Reading", "Relation", "Verdict", "plain",
]  # fmt: skip
