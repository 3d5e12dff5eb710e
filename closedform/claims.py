"""Checks that judge what a paper says.  A verdict is computed, never typed in.

A check holds the statement *as printed*, beside what was derived, and :meth:`Check.judge` compares
them exactly.  There are five verdicts; an equation that can be neither proved nor refuted raises
:class:`~closedform.algebra.Undecided`, which fails the build.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp
from flint import arb

from closedform.algebra import decide
from closedform.reference import evaluate
from closedform.solutions import InfinitelyManyError, count_solutions

PROVED = "proved"
PROVED_UNDER = "proved under assumption"
APPROXIMATION = "approximation"
REFUTED = "refuted"
NOT_DECIDABLE = "not decidable here"
VERDICTS = (PROVED, PROVED_UNDER, APPROXIMATION, REFUTED, NOT_DECIDABLE)


@dataclass(frozen=True)
class Verdict:
    """What was found.

    ``evidence`` is a sentence: the assumption, the counterexample, the order of the error, or the
    reason.  ``corrected`` is the LaTeX of the form that was proved instead.
    """

    kind: str
    evidence: str = ""
    corrected: str = ""


class Check(ABC):
    """A computation that judges one claim."""

    @abstractmethod
    def judge(self) -> Verdict: ...


@dataclass(frozen=True)
class Identity(Check):
    """``printed`` equals ``derived`` for all values of the symbols.

    ``nonnegative`` lists what may be assumed.  ``small`` names a symbol that tends to zero: then a
    refuted equation whose error vanishes with it is an approximation, and the order is derived.
    ``corrected`` is a form in the paper's own terms that is proved equal to ``derived``; without it
    the derived form itself stands as the correction.
    """

    printed: Any
    derived: Any
    nonnegative: tuple[sp.Expr, ...] = ()
    corrected: Any = None
    small: sp.Symbol | None = None

    def judge(self) -> Verdict:
        decision = decide(_difference(self.printed, self.derived), self.nonnegative)
        if decision.holds:
            assumed = ", ".join(f"{a} >= 0" for a in decision.assumptions)
            return Verdict(decision.verdict, f"where {assumed}" if assumed else "")
        assert decision.counterexample is not None
        corrected = self.derived if self.corrected is None else self.corrected
        if not decide(_difference(corrected, self.derived), self.nonnegative).holds:
            raise ValueError(f"the corrected form {corrected} does not equal {self.derived}")
        where = decision.counterexample.describe()
        if self.small is not None and (order := self._order()):
            return Verdict(APPROXIMATION, f"{order}; e.g. {where}", _latex(corrected))
        return Verdict(REFUTED, where, _latex(self._differing(corrected)))

    def _order(self) -> str:
        difference = sp.simplify(self.printed - self.derived)
        leading = sp.series(difference, self.small, 0, 6).removeO()
        term = leading.as_leading_term(self.small)
        degree = sp.degree(term, self.small) if term != 0 else 0
        return f"the error is {term} + O({self.small}**{degree + 1})" if degree > 0 else ""

    def _differing(self, corrected: Any) -> Any:
        """Of a matrix only the wrong entries, as equations of its elements."""
        if not isinstance(corrected, sp.MatrixBase) or corrected.shape == (1, 1):
            return corrected
        printed = sp.Matrix(self.printed)
        entries = []
        for i in range(corrected.rows):
            for j in range(corrected.cols):
                if not decide(printed[i, j] - self.derived[i, j], self.nonnegative).holds:
                    entries.append((i + 1, j + 1, corrected[i, j]))
        return entries


@dataclass(frozen=True)
class Decimal(Check):
    """A printed decimal is the exact value, rounded to the digits that are printed."""

    printed: str
    exact: sp.Expr
    unit: str = ""

    def judge(self) -> Verdict:
        digits = len(self.printed.partition(".")[2])
        value, error = evaluate([self.exact, self.exact - sp.Rational(self.printed)], {})
        half = arb(1) / (2 * 10**digits)
        error = abs(error)
        right = value.str(digits + 6, radius=False)
        if error <= half:
            return Verdict(PROVED, f"the exact value is {right}{self._unit}")
        within = "truncated, not rounded: " if error < 2 * half else ""
        nearest = _rounded(self.exact, digits)
        return Verdict(
            REFUTED, f"{within}the exact value is {right}{self._unit}", f"{nearest}{self._unit}"
        )

    @property
    def _unit(self) -> str:
        return f" {self.unit}" if self.unit else ""


@dataclass(frozen=True)
class Count(Check):
    """A system of equations has the printed number of solutions (``None``: infinitely many)."""

    equations: tuple[sp.Expr, ...]
    unknowns: tuple[sp.Symbol, ...]
    printed: int | None

    def judge(self) -> Verdict:
        try:
            found: int | None = count_solutions(self.equations, self.unknowns).count
        except InfinitelyManyError:
            found = None
        words = "a continuum of" if found is None else str(found)
        text = f"a Groebner basis counts {words} solution{'' if found == 1 else 's'}"
        return Verdict(PROVED if found == self.printed else REFUTED, text)


@dataclass(frozen=True)
class Every(Check):
    """A statement with several parts: it is worth what its worst part is worth."""

    parts: Mapping[str, Check]

    def judge(self) -> Verdict:
        verdicts = {name: check.judge() for name, check in self.parts.items()}
        worst = max(verdicts.values(), key=lambda v: VERDICTS.index(v.kind)).kind
        return Verdict(
            worst,
            "; ".join(
                f"{name}: {v.kind}" + (f" ({v.evidence})" if v.evidence else "")
                for name, v in verdicts.items()
            ),
            r";\quad ".join(v.corrected for v in verdicts.values() if v.corrected),
        )


@dataclass(frozen=True)
class Refuted(Check):
    """A statement about all cases that a witness contradicts: ``witness`` must be provable.

    ``corrected`` says what holds instead; it is what ``proof`` proves.
    """

    witness: Check
    explanation: str
    corrected: str = ""
    proof: Check | None = None

    def judge(self) -> Verdict:
        for check in (self.witness, self.proof):
            if check is not None and check.judge().kind not in (PROVED, PROVED_UNDER):
                raise ValueError(f"the witness against a claim does not hold: {self.explanation}")
        return Verdict(REFUTED, self.explanation, self.corrected)


@dataclass(frozen=True)
class Undecidable(Check):
    """A figure, a measurement or a judgement of value; ``reason`` says which."""

    reason: str

    def judge(self) -> Verdict:
        return Verdict(NOT_DECIDABLE, self.reason)


def _difference(a: Any, b: Any) -> Any:
    if isinstance(a, sp.MatrixBase) or isinstance(b, sp.MatrixBase):
        return sp.Matrix(a) - sp.Matrix(b)
    if isinstance(a, Sequence):
        return sp.Matrix([x - y for x, y in zip(a, b, strict=True)])
    return sp.sympify(a) - sp.sympify(b)


def _latex(value: Any) -> str:
    if isinstance(value, list):
        return r",\ ".join(rf"[{i},{j}] = {sp.latex(e)}" for i, j, e in value)
    if isinstance(value, tuple):
        return r",\ ".join(sp.latex(v) for v in value)
    return str(sp.latex(value))


def _rounded(exact: sp.Expr, digits: int) -> str:
    scaled = sp.floor(exact * 10**digits + sp.Rational(1, 2))
    whole, part = divmod(abs(int(scaled)), 10**digits)
    sign = "-" if int(scaled) < 0 else ""
    return f"{sign}{whole}.{part:0{digits}d}" if digits else f"{sign}{whole}"
