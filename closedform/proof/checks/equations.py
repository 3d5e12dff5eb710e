"""Checks of equations: identities, approximations, and statements that must agree."""

# mypy: allow-untyped-calls
# SymPy is only partly annotated.

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from closedform.algebra.counterexample import Counterexample
from closedform.algebra.normal_form import decide
from closedform.model.claims import (
    APPROXIMATION,
    INCOMPLETE,
    INCONSISTENT,
    NOT_DECIDABLE,
    PROVED,
    PROVED_UNDER,
    REFUTED,
    Check,
    Verdict,
)
from closedform.model.indexed import Indexed, at_index
from closedform.model.notation import SIGN, Relation
from closedform.proof.checks.evidence import (
    Exact,
    Expr,
    Point,
    at,
    cases,
    denested,
    difference,
    entries,
    shown,
)

_DEGREE = 6
"""From this degree on, the terms of an error are not considered."""
_SHORT = 40
"""The longest printed side, in characters, that is repeated in the evidence."""
_SYMBOL = re.compile(r"[A-Za-z](_\w|_\{\w+\}|\^\w|\^\{\w+\})*|\\mathbf\{\w\}")
"""What a formula calls a matrix or a vector by, such as ``T_2^0``."""


@dataclass(frozen=True)
class Identity(Check):
    """``printed`` equals ``derived`` for all values of the symbols.

    ``nonnegative`` lists expressions that may be assumed to be nonnegative.  ``small`` is a symbol
    that tends to zero, or several that do so together: a refuted equation whose error vanishes with
    them is an approximation, and its order is derived.  ``names`` are the texts of the two sides,
    for the evidence.  If the symbols depend on each other, as the angles of a closed loop do,
    ``postures`` lists points at which they agree: only such a point can refute.
    """

    printed: Exact
    derived: Exact
    nonnegative: tuple[Expr, ...] = ()
    small: sp.Symbol | tuple[sp.Symbol, ...] | None = None
    names: tuple[str, str] = ("the printed form", "the derived one")
    postures: Sequence[Point] = ()
    parts: Sequence[str] = ()
    """What the name of each part of a list adds to that of the list: ``for k = 1``."""

    def judge(self) -> Verdict:
        sides = list(zip(entries(self.printed), entries(self.derived), strict=True))
        gap = difference(self.printed, self.derived)
        decision = decide(gap, self.nonnegative, sides=sides, postures=self.postures)
        if decision.holds:
            assumed = [piece for a in decision.assumptions for piece in (", ", a, r" $\ge 0$")]
            kind = PROVED_UNDER if decision.assumptions else PROVED
            return Verdict(kind, tuple(assumed[1:]))
        assert decision.counterexample is not None
        where = self._point(decision.counterexample)
        if self.small is not None and (order := _order(gap, self.small)):
            return Verdict(APPROXIMATION, (*order, "; e.g. ", *where))
        return Verdict(REFUTED, where)

    def _point(self, found: Counterexample) -> tuple[Any, ...]:
        """The counterexample with the values of both sides, so that a reader can check it."""
        shape = getattr(self.printed, "shape", None)
        entry, of = "", ""
        if shape:
            row, column = divmod(found.entry, shape[1])
            entry = f"in row {row + 1}, " + f"column {column + 1}, " * (shape[1] > 1)
        elif isinstance(self.printed, Sequence) and not self.parts:
            entry, of = f"part {found.entry + 1} of ", "that of "
        printed, derived = (
            shown(entries(side)[found.entry], found.point) for side in (self.printed, self.derived)
        )
        left, right = self.names
        if self.parts:
            left = f"{left} {self.parts[found.entry]}"
        if right == f"${derived}$":
            return (*at(found.point), entry, left, " is ", printed, ", not ", derived)
        of = "" if right.startswith("that of ") else of
        contrast = (entry, left, " is ", printed, ", but ", of, right, " is ", derived)
        return (*at(found.point), *contrast)


def _order(gap: Exact, small: sp.Symbol | tuple[sp.Symbol, ...]) -> tuple[Any, ...]:
    """The leading term of the largest error, if all errors vanish with the ``small`` symbols."""
    small = small if isinstance(small, tuple) else (small,)
    scale = sp.Dummy("scale", real=True)
    scaled = {s: scale * s for s in small}
    terms = []
    for entry in entries(gap):
        found = _leading(entry.xreplace(scaled), scale)
        if found is None:
            return ()
        if found[1] != 0:
            terms.append(found)
    if not terms:
        return ()
    degree, term = min(terms, key=lambda t: t[0])
    if degree <= 0:
        return ()
    of = [piece for s in small for piece in (", ", s)]
    return ("the error is ", term, f" and terms of order {degree + 1} in ", *of[1:])


def _leading(e: Expr, scale: sp.Symbol) -> tuple[int, Expr] | None:
    """The degree and the coefficient of the first term in Taylor's series; None if it has none."""
    for degree in range(_DEGREE):
        coefficient = sp.simplify(e.subs(scale, 0) / sp.factorial(degree))
        if coefficient.has(sp.nan, sp.zoo, sp.oo):
            return None
        if coefficient != 0:
            return degree, sp.factor(coefficient)
        e = e.diff(scale)
    return _DEGREE, sp.S.Zero


@dataclass(frozen=True)
class Equal(Check):
    r"""All sides of a printed equation are equal, for all values of the symbols.

    A formula with ``\pm`` states that each posture satisfies it with one of the signs.  A formula
    with a free index states that it holds for each value of the index; one with cases has to hold
    in each of them, and they have to leave no gap.  ``on`` replaces symbols, for example by their
    values at a posture; ``defines`` is a side that only names the others.  ``postures`` is that of
    :class:`Identity`.
    """

    relation: Relation | tuple[Relation, ...]
    nonnegative: tuple[Expr, ...] = ()
    small: sp.Symbol | tuple[sp.Symbol, ...] | None = None
    on: Mapping[sp.Symbol, Expr] | None = None
    defines: Any = None
    postures: Sequence[Point] = ()

    def judge(self) -> Verdict:
        several = self.relation if isinstance(self.relation, tuple) else (self.relation,)
        if len(several) > 1:
            return worst(replace(self, relation=r).judge() for r in several)
        (relation,) = several
        if not relation.signs or set(relation.signs) != {"="}:
            raise ValueError(f"{' '.join(relation.texts)} is not an equation")
        if indices := [s.indices for s in relation.sides if isinstance(s, Indexed)]:
            return self._for_each(relation, indices[0])
        sides = [
            (self._on(side), text)
            for side, text in zip(relation.sides, relation.texts, strict=True)
            if self.defines is None or side != self.defines
        ]
        if len(sides) < 2:
            raise ValueError(f"{' = '.join(relation.texts)} only defines a name")
        (first, name), *others = sides
        return worst(self._compare(first, name, side, text) for side, text in others)

    def _for_each(self, relation: Relation, indices: Sequence[int]) -> Verdict:
        """The verdict for each value of the index; the first fault is the simplest to check."""
        for k in indices:
            here = replace(relation, sides=tuple(at_index(s, k) for s in relation.sides))
            verdict = replace(self, relation=here).judge()
            if verdict.kind != PROVED:
                return Verdict(verdict.kind, (f"for $i = {k}$: ", *verdict.evidence))
        return Verdict(PROVED)

    def _on(self, side: Exact) -> Exact:
        if not self.on:
            return side
        values = {symbol: sp.sympify(value, strict=True) for symbol, value in self.on.items()}
        return sp.sympify(side, strict=True).xreplace(values)

    def _compare(self, first: Exact, name: str, side: Exact, text: str) -> Verdict:
        spoken = ("the left side", "the right side")
        if not isinstance(first, sp.MatrixBase) and isinstance(side, sp.MatrixBase):
            first, name, side, text = side, text, first, name
            spoken = spoken[::-1]
        if isinstance(first, sp.MatrixBase) and side == 0:
            side = sp.zeros(*first.shape)
        short = [len(t) <= _SHORT and r"\begin" not in t for t in (name, text)]
        names = (f"${name}$", f"${text}$") if all(short) else spoken
        if isinstance(first, sp.MatrixBase) and _SYMBOL.fullmatch(name):
            names = (f"${name}$", names[1])
        if any(e.has(sp.Piecewise) for e in (*entries(first), *entries(side))):
            return self._in_cases([*entries(first)], [*entries(side)], names)
        gap = difference(first, side)
        if any(e.has(SIGN) for e in entries(gap)):
            product = [
                sp.prod(e.subs(SIGN, s) for s in (1, -1)) if e.has(SIGN) else e
                for e in entries(gap)
            ]
            verdict = Identity(product, [sp.S.Zero] * len(product), self.nonnegative).judge()
            if verdict.kind != REFUTED:
                return verdict
            point = next((p for p in verdict.evidence if isinstance(p, Mapping)), {})
            sentence = ("neither sign of $\\pm$ makes ", names[0], " equal ", names[1])
            return Verdict(REFUTED, (*at(point), *sentence))
        return Identity(
            printed=first,
            derived=side,
            nonnegative=self.nonnegative,
            small=self.small,
            names=names,
            postures=self.postures,
        ).judge()

    def _in_cases(self, left: list[Expr], right: list[Expr], names: tuple[str, str]) -> Verdict:
        """The worst verdict of the cases, each under its conditions."""
        several = {p for e in (*left, *right) for p in e.atoms(sp.Piecewise)}
        if len(several) > 1:
            raise ValueError("an equation with cases may have one list of them only")
        (first,) = several
        found: list[Verdict] = []
        for value, gaps in cases(first):
            printed, derived = ([e.subs(first, value) for e in side] for side in (left, right))
            given = (*self.nonnegative, *gaps)
            verdict = Identity(printed, derived, given, self.small, names).judge()
            under = verdict.kind == PROVED_UNDER and not self.nonnegative
            found.append(Verdict(PROVED) if under else verdict)
        if first.args[-1][1] != sp.true:
            found.append(Verdict(REFUTED, ("the cases leave a gap",)))
        return worst(found)


@dataclass(frozen=True)
class Agree(Check):
    """Two statements of the paper about the same quantity can both hold: the two are equal.

    ``names`` says where each stands.
    """

    first: Exact
    second: Exact
    names: tuple[str, str]
    nonnegative: tuple[Expr, ...] = ()

    def judge(self) -> Verdict:
        verdict = Identity(self.first, self.second, self.nonnegative, None, self.names).judge()
        return Verdict(INCONSISTENT, verdict.evidence) if verdict.kind == REFUTED else verdict


@dataclass(frozen=True)
class Reaches(Check):
    """Joint angles of an example: ``forward`` takes the ``printed`` angles to ``target``."""

    forward: Exact
    printed: Mapping[sp.Symbol, Expr]
    target: Exact

    def judge(self) -> Verdict:
        reached = [denested(sp.expand_trig(e.subs(self.printed))) for e in entries(self.forward)]
        target = entries(self.target)
        both = [(*reached, *target)] * len(reached)
        decision = decide(difference(reached, target), sides=both)
        if decision.holds:
            return Verdict(PROVED, ("the forward map takes them to the target",))
        assert decision.counterexample is not None
        where = decision.counterexample.point
        return Verdict(
            REFUTED,
            (*at(where), "they reach ", *_listed(reached, where), ", not ",
             *_listed(target, where)),
        )  # fmt: skip


def _listed(values: Sequence[Expr], point: Point) -> list[Any]:
    pieces: list[Any] = []
    for value in values:
        pieces += [", ", shown(value, point)]
    return ["(", *pieces[1:], ")"]


_SEVERITY = (
    PROVED, PROVED_UNDER, APPROXIMATION, NOT_DECIDABLE, INCOMPLETE, INCONSISTENT, REFUTED,
)  # fmt: skip


def worst(verdicts: Iterable[Verdict]) -> Verdict:
    """The worst of several verdicts; the first of several equally bad ones.

    Nothing is worse than a refutation, so what follows one is not computed.
    """
    found = []
    for verdict in verdicts:
        found.append(verdict)
        if verdict.kind == REFUTED:
            break
    return max(found, key=lambda v: _SEVERITY.index(v.kind))


LISTED = 12
"""If more parts than this are all proved, the evidence is only their number."""


@dataclass(frozen=True)
class Every(Check):
    """A statement with several parts; its verdict is the worst verdict of its parts.

    The evidence is that of the parts with this verdict.  The name of a part says what it states.
    """

    parts: Mapping[str, Check]

    def judge(self) -> Verdict:
        if not self.parts:
            raise ValueError("Every needs at least one part")
        verdicts = {name: check.judge() for name, check in self.parts.items()}
        kind = worst(list(verdicts.values())).kind
        if kind == PROVED and len(verdicts) > LISTED:
            return Verdict(kind, (f"all {len(verdicts)} parts: {kind}",))
        pieces: list[Any] = []
        for name, v in verdicts.items():
            if v.kind != kind:
                continue
            pieces += ["; ", name]
            if v.evidence:
                pieces += [" (", *v.evidence, ")"] if kind == PROVED else [": ", *v.evidence]
        return Verdict(kind, tuple(pieces[1:]))


@dataclass(frozen=True)
class Under(Check):
    """A check that holds under an ``assumption`` that the paper does not state."""

    check: Check
    assumption: str

    def judge(self) -> Verdict:
        verdict = self.check.judge()
        if verdict.kind == PROVED:
            return Verdict(PROVED_UNDER, (self.assumption,))
        if verdict.kind == PROVED_UNDER:
            return Verdict(PROVED_UNDER, (self.assumption, ", ", *verdict.evidence))
        return verdict
