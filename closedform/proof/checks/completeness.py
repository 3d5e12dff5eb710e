"""Checks of completeness: whether a list of equations, cases or formulas leaves something out."""

# mypy: allow-untyped-calls
# SymPy is only partly annotated.

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.algebra.normal_form import Undecided, decide
from closedform.model.claims import HOLDS, INCOMPLETE, PROVED, REFUTED, Check, Verdict
from closedform.proof.checks.equations import worst
from closedform.proof.checks.evidence import Expr, Point, at, holds
from closedform.proof.checks.solutions import Count


@dataclass(frozen=True)
class Listing(Check):
    """A printed list contains all that is ``found``; ``meaning`` describes what it lists.

    The claim is refuted if the list contains something else, and incomplete if something is
    missing.  ``shown`` writes an element for the evidence.
    """

    printed: Collection[Any]
    found: Callable[[], Collection[Any]]
    meaning: str
    shown: Callable[[Any], tuple[Any, ...]] = lambda element: (element,)

    def judge(self) -> Verdict:
        found = list(self.found())
        wrong = sorted((e for e in self.printed if e not in found), key=str)
        if wrong:
            return Verdict(REFUTED, ("not among the ", self.meaning, ": ", *self._listed(wrong)))
        missing = [e for e in found if e not in self.printed]
        if missing:
            return Verdict(INCOMPLETE, (self.meaning, ": it omits ", *self._listed(missing)))
        return Verdict(PROVED, (self.meaning, ": ", *self._listed(found)))

    def _listed(self, elements: Sequence[Any]) -> list[Any]:
        pieces = [piece for e in elements for piece in (", ", *self.shown(e))]
        return pieces[1:]


@dataclass(frozen=True)
class Replaces(Check):
    """Printed ``equations`` have the same solutions as the ``source`` that they replace.

    They have to hold at every posture, whose targets are ``posture``, functions of the unknowns;
    otherwise the claim is refuted.  If they have more solutions than the source, they are weaker,
    and the claim is incomplete.  ``given`` replaces dependent targets when solutions are counted.
    """

    equations: Sequence[Expr]
    source: Sequence[Expr]
    unknowns: Sequence[sp.Symbol]
    posture: Mapping[sp.Symbol, Expr]
    given: Mapping[sp.Symbol, Expr] | None = None

    def judge(self) -> Verdict:
        at_posture = [
            sp.sympify(e, strict=True).subs(self.posture, simultaneous=True) for e in self.equations
        ]
        decision = decide(sp.Matrix(at_posture))
        if not decision.holds:
            assert decision.counterexample is not None
            where = decision.counterexample
            return Verdict(REFUTED, (*at(where.point), f"equation {where.entry + 1} does not hold"))
        printed, wanted = (
            Count(system, self.unknowns, None, self.given).found()
            for system in (self.equations, self.source)
        )
        if printed == wanted:
            return Verdict(PROVED, (f"both systems have {_number(printed)}",))
        return Verdict(
            INCOMPLETE,
            (f"they have {_number(printed)}, but the equations that they replace have "
             f"{_number(wanted)}",),
        )  # fmt: skip


def _number(count: int | None) -> str:
    if count is None:
        return "infinitely many solutions"
    return f"{count or 'no'} solution{'' if count == 1 else 's'}"


@dataclass(frozen=True)
class Cases(Check):
    """Formulas for several cases, each right in its case; together they cover every posture.

    ``cases`` pairs the condition of each case with the check of its formulas.  If a posture of
    ``among`` is in none of them, the claim is incomplete.
    """

    cases: Sequence[tuple[Expr, Check]]
    among: Sequence[Point]

    def judge(self) -> Verdict:
        verdicts = [check.judge() for _, check in self.cases]
        found = worst(verdicts)
        if found.kind not in HOLDS:
            return found
        conditions = [condition for condition, _ in self.cases]
        for point in self.among:
            if not any(holds(c.subs(point)) for c in conditions):
                return Verdict(
                    INCOMPLETE, ("right where it answers, but it has no case for ", dict(point))
                )
        if sp.Or(*conditions) != sp.true:
            raise Undecided("nothing proves that the cases cover every posture")
        return Verdict(found.kind, ("every posture is in one of the cases",))
