"""Checks of statements in words: numbers, enumerations, and predicates over a domain."""

# mypy: allow-untyped-calls
# SymPy is only partly annotated.

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp
from sympy.core.relational import Relational

from closedform.algebra.balls import evaluate
from closedform.algebra.counterexample import find_counterexample
from closedform.algebra.normal_form import Undecided, decide, positive_form
from closedform.model.claims import (
    NOT_DECIDABLE,
    PROVED,
    REFUTED,
    Check,
    Verdict,
)
from closedform.model.notation import Relation
from closedform.proof.checks.evidence import (
    Expr,
    Point,
    constant,
    fixed,
    holds,
    nearest,
    sign,
)


@dataclass(frozen=True)
class Rounded(Check):
    """A printed decimal is the exact value, rounded to the printed digits.

    ``relation`` is the printed formula; its last side is the decimal.  If the value is halfway
    between two decimals, both are right.  ``scale`` is the unit of the decimal in units of the
    value, such as ``pi/180`` for degrees.  With ``cut``, the further digits are cut off instead.
    """

    relation: Relation
    exact: Expr
    unit: str = ""
    scale: Expr = sp.S.One
    cut: bool = False

    def judge(self) -> Verdict:
        if not set(self.relation.signs) <= {"="}:  # "60 or -60" has an alternative without a sign
            raise ValueError(f"{' '.join(self.relation.texts)} is not an equation")
        digits = self.relation.decimals
        value = constant(self.exact) / self.scale
        scaled = value * 10**digits
        units = scaled - constant(self.relation.right) / self.scale * 10**digits
        shown = evaluate([value], {})[0].str(digits + 6, radius=False)
        exact = f"the exact value is ${shown}$" + (f" {self.unit}" if self.unit else "")
        cut = sign(sp.Abs(units) - 1) < 0 and sign(units) in (0, sign(scaled))
        if cut if self.cut else sign(sp.Abs(units) - sp.Rational(1, 2)) <= 0:
            return Verdict(PROVED, (exact,))
        off = fixed(nearest(100 * sp.Abs(units)), 2)
        how = "truncated, not rounded" if cut else f"off by {off} units of the last place"
        return Verdict(REFUTED, (f"{how}: {exact}",))


@dataclass(frozen=True)
class Enumeration(Check):
    """A number, a list or a truth found by enumeration of all cases; ``meaning`` describes it."""

    printed: Any
    found: Callable[[], Any]
    meaning: str

    def judge(self) -> Verdict:
        found = self.found()
        if isinstance(found, bool):
            told = self.meaning if found else f"not so: {self.meaning}"
            return Verdict(PROVED if found == self.printed else REFUTED, (told,))
        if found == self.printed:
            return Verdict(PROVED, (f"{self.meaning}: {_in_words(found)}",))
        text = f"{self.meaning}: {_in_words(found)}, not {_in_words(self.printed)}"
        return Verdict(REFUTED, (text,))


def _in_words(value: Any) -> str:
    """A number, or a list of names without the signs of the programming language."""
    if isinstance(value, list | tuple | set | frozenset):
        parts = list(value) if isinstance(value, list | tuple) else sorted(value, key=str)
        several = (
            f"({_in_words(p)})" if isinstance(p, list | tuple) else _in_words(p) for p in parts
        )
        return ", ".join(several) or "none"
    return str(value)


@dataclass(frozen=True)
class Holds(Check):
    """Named relations between constants: the statement is proved if all hold, else refuted.

    Enclosures decide inequalities; the exact zero test decides equations.  If the constants are
    those of a ``point``, a reader is told this point instead of the names.
    """

    relations: Mapping[str, Expr]
    point: Point | None = None

    def judge(self) -> Verdict:
        if not self.relations:
            raise ValueError("Holds needs at least one relation")
        failed = [name for name, relation in self.relations.items() if not holds(relation)]
        if failed:
            return Verdict(REFUTED, (f"not so: {', '.join(failed)}",))
        return Verdict(
            PROVED, ("at ", dict(self.point)) if self.point else (", ".join(self.relations),)
        )


@dataclass(frozen=True)
class ForAll(Check):
    """A relation holds at every point of a domain.

    ``where`` lists inequalities that bound the domain.  ``on`` replaces symbols that depend on each
    other.  An equation is decided exactly.  For an inequality, ``slack`` replaces symbols by
    expressions in nonnegative symbols; if the difference of the sides then has positive
    coefficients only, the relation is proved.  A point of ``among`` or a simple point of the domain
    that violates the relation refutes it.
    """

    relation: Expr
    where: Sequence[Expr] = ()
    on: Mapping[sp.Symbol, Expr] | None = None
    slack: Sequence[tuple[sp.Symbol, Expr]] = ()
    among: Sequence[Point] = ()

    def judge(self) -> Verdict:
        relation = _placed(sp.sympify(self.relation, strict=True), self.on)
        if relation in (sp.true, sp.false):
            return (
                Verdict(PROVED)
                if relation == sp.true
                else Verdict(REFUTED, _violation(relation, {}))
            )
        where = [_placed(c, self.on) for c in self.where]
        violated = _first([*where, _negated(relation)], self.among)
        if violated is not None:
            return Verdict(REFUTED, _violation(relation, violated))
        if isinstance(relation, sp.Eq):
            gaps = [c.gts - c.lts for c in where if isinstance(c, sp.Ge | sp.Le | sp.Gt | sp.Lt)]
            decision = decide(relation.lhs - relation.rhs, gaps)
            if decision.holds:
                return Verdict(PROVED)
            assert decision.counterexample is not None
            return Verdict(REFUTED, _violation(relation, decision.counterexample.point))
        if isinstance(relation, sp.Ge | sp.Le | sp.Gt | sp.Lt) and self._positive(relation):
            return Verdict(PROVED)
        if (point := _simple([*where, _negated(relation)])) is not None:
            return Verdict(REFUTED, _violation(relation, point))
        raise Undecided(f"{relation} can be neither proved nor refuted")

    def _positive(self, relation: Expr) -> bool:
        gap = relation.gts - relation.lts
        try:
            form = positive_form(gap, list(self.slack))
        except (ValueError, sp.PolynomialError):  # not a polynomial, or not with these signs
            return False
        strict = isinstance(relation, sp.Gt | sp.Lt)
        return not strict or bool(form.is_positive)


@dataclass(frozen=True)
class Exists(Check):
    """Some point satisfies all relations.

    The points of ``among`` are tried first, then simple points.  If none is found, ``never`` has to
    prove that there is none: a check of the opposite.
    """

    relations: Sequence[Expr]
    among: Sequence[Point] = ()
    never: Check | None = None

    def judge(self) -> Verdict:
        found = _first(self.relations, self.among)
        if found is None:
            found = _simple(self.relations)
        if found is not None:
            return Verdict(PROVED, ("for example at ", dict(found)) if found else ())
        if self.never is not None:
            opposite = self.never.judge()
            if opposite.kind == PROVED:
                return Verdict(REFUTED, _opposite(opposite.evidence))
        raise Undecided("no point was found, and nothing proves that there is none")


@dataclass(frozen=True)
class Not(Check):
    """The opposite of a check that can be proved and refuted."""

    check: Check

    def judge(self) -> Verdict:
        verdict = self.check.judge()
        if verdict.kind not in (PROVED, REFUTED):
            return verdict
        if verdict.kind == PROVED:
            return Verdict(REFUTED, _opposite(verdict.evidence))
        return Verdict(
            PROVED, ("the opposite does not hold: ", *verdict.evidence) if verdict.evidence else ()
        )


@dataclass(frozen=True)
class Undecidable(Check):
    """A figure, a measurement or a judgement of value; ``reason`` explains it."""

    reason: str

    def judge(self) -> Verdict:
        return Verdict(NOT_DECIDABLE, (self.reason,))


def _placed(relation: Expr, on: Mapping[sp.Symbol, Expr] | None) -> Expr:
    return relation.subs(on, simultaneous=True) if on else relation


def _negated(relation: Expr) -> Expr:
    return sp.Not(relation) if isinstance(relation, Relational) else sp.false


def _first(relations: Sequence[Expr], among: Iterable[Point]) -> Point | None:
    """The first of some points that give all symbols a value and at which all relations hold."""
    for point in among:
        placed = [sp.sympify(r, strict=True).subs(point) for r in relations]
        if not any(r.free_symbols for r in placed) and all(map(holds, placed)):
            return point
    return None


def _simple(relations: Sequence[Expr]) -> Point | None:
    """A simple point at which all relations provably hold."""
    if any(r == sp.false for r in relations):
        return None
    conditions = [r for r in relations if r != sp.true]
    equations = [c for c in conditions if isinstance(c, sp.Eq)]
    if equations or not conditions:
        return None
    found = find_counterexample(sp.S.One, conditions=conditions)
    return found.point if found else None


def _violation(relation: Expr, point: Point) -> tuple[Any, ...]:
    return ("it fails at ", dict(point)) if point else ("it does not hold",)


def _opposite(evidence: tuple[Any, ...]) -> tuple[Any, ...]:
    """What refutes a statement whose opposite is proved."""
    return ("the opposite is proved: ", *evidence) if evidence else ("the opposite is proved",)
