"""Checks of claims and the verdicts that they give."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

PROVED = "proved"
PROVED_UNDER = "proved under assumption"
APPROXIMATION = "approximation"
REFUTED = "refuted"
NOT_DECIDABLE = "not decidable here"
VERDICTS = (PROVED, PROVED_UNDER, APPROXIMATION, REFUTED, NOT_DECIDABLE)


@dataclass(frozen=True)
class Verdict:
    """The result of a check.

    ``evidence`` is a sentence: the assumption, the counterexample, the order of the error, or the
    reason.  ``corrected`` is the LaTeX of the form that was proved instead; a form that is not
    proved is never given.
    """

    kind: str
    evidence: str = ""
    corrected: str = ""


class Check(ABC):
    """A computation that judges one claim."""

    @abstractmethod
    def judge(self) -> Verdict: ...
