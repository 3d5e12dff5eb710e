"""Checks of the claims of a paper.  A verdict is always computed, never written by hand.

A check contains the statement *as printed* and the derived form, and :meth:`Check.judge` compares
them exactly.  There are five verdicts.  A statement that can neither be proved nor refuted raises
:class:`~closedform.algebra.normal_form.Undecided`, which fails the build.
"""

# mypy: allow-untyped-calls
# SymPy is only partly annotated.

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import sympy as sp
from sympy.core.relational import Relational

from closedform.algebra.balls import evaluate
from closedform.algebra.counterexample import Counterexample
from closedform.algebra.normal_form import Undecided, decide
from closedform.algebra.solutions import InfinitelyManyError, count_solutions
from closedform.model.claims import (
    APPROXIMATION,
    NOT_DECIDABLE,
    PROVED,
    PROVED_UNDER,
    REFUTED,
    Check,
    Verdict,
)
from closedform.model.functions import reject_floats

Expr: TypeAlias = Any  # SymPy's annotations are partial
Exact: TypeAlias = Any  # an expression, a matrix or a sequence of them

_SEVERITY = (PROVED, PROVED_UNDER, APPROXIMATION, NOT_DECIDABLE, REFUTED)
_READABLE = 24
"""The longest exact value, in characters, that is not shown as a decimal."""


@dataclass(frozen=True)
class Identity(Check):
    """``printed`` equals ``derived`` for all values of the symbols.

    ``nonnegative`` lists expressions that may be assumed to be nonnegative.  ``small`` is a symbol
    that tends to zero: a refuted equation whose error vanishes with it is an approximation, and its
    order is derived.  ``corrected`` is a form in the terms of the paper that is proved equal to
    ``derived``; the default correction is the derived form itself.
    """

    printed: Exact
    derived: Exact
    nonnegative: tuple[Expr, ...] = ()
    corrected: Exact = None
    small: sp.Symbol | None = None

    def judge(self) -> Verdict:
        difference = _difference(self.printed, self.derived)
        sides = list(zip(_entries(self.printed), _entries(self.derived), strict=True))
        decision = decide(difference, self.nonnegative, sides=sides)
        if decision.holds:
            assumed = ", ".join(f"{a} >= 0" for a in decision.assumptions)
            return Verdict(decision.verdict, f"where {assumed}" if assumed else "")
        assert decision.counterexample is not None
        corrected = self.derived if self.corrected is None else self.corrected
        _require_equal(corrected, self.derived, self.nonnegative)
        where = self._point(decision.counterexample)
        if self.small is not None and (order := self._order(self.small)):
            return Verdict(APPROXIMATION, f"{order}; e.g. {where}", _latex(corrected))
        return Verdict(REFUTED, where, self._correction(corrected))

    def _point(self, found: Counterexample) -> str:
        """The counterexample with the values of both sides, so that a reader can check it."""
        shape = getattr(self.printed, "shape", None)
        entry = ""
        if shape is not None:
            entry = "entry ({},{}): ".format(*(k + 1 for k in divmod(found.entry, shape[1])))
        elif isinstance(self.printed, Sequence):
            entry = f"part {found.entry + 1}: "
        printed, derived = (
            _value(_entries(side)[found.entry], found.point)
            for side in (self.printed, self.derived)
        )
        return f"{entry}{_at(found)}the printed form is {printed}, not {derived}"

    def _order(self, small: sp.Symbol) -> str:
        """The leading term of the largest error, if all errors vanish with ``small``."""
        terms = []
        for entry in _entries(_difference(self.printed, self.derived)):
            series = sp.series(sp.simplify(entry), small, 0, 6).removeO()
            if series != 0:
                term = sp.factor(series.as_leading_term(small))
                terms.append((sp.degree(sp.numer(term), small), term))
        if not terms:
            return ""
        degree, term = min(terms, key=lambda t: t[0])
        return f"the error is {term} + O({small}**{degree + 1})" if degree > 0 else ""

    def _correction(self, corrected: Exact) -> str:
        """The corrected form in LaTeX; for a matrix, only the wrong entries with their indices."""
        if not isinstance(corrected, sp.MatrixBase) or corrected.shape == (1, 1):
            return _latex(corrected)
        difference = _difference(self.printed, self.derived)
        return r",\ ".join(
            rf"[{i + 1},{j + 1}] = {sp.latex(corrected[i, j])}"
            for i in range(corrected.rows)
            for j in range(corrected.cols)
            if not decide(difference[i, j], self.nonnegative).holds
        )


@dataclass(frozen=True)
class Decimal(Check):
    """A printed decimal is the exact value, rounded to the printed digits.

    If the value is halfway between two decimals, both are right.
    """

    printed: str
    exact: Expr
    unit: str = ""

    def judge(self) -> Verdict:
        digits = len(self.printed.partition(".")[2])
        scaled = _constant(self.exact) * 10**digits
        units = scaled - sp.Rational(self.printed) * 10**digits
        value = evaluate([self.exact], {})[0].str(digits + 6, radius=False)
        exact = f"the exact value is {value}{self._unit}"
        if _sign(sp.Abs(units) - sp.Rational(1, 2)) <= 0:
            return Verdict(PROVED, exact)
        cut = _sign(sp.Abs(units) - 1) < 0 and _sign(units) == _sign(scaled)
        off = _fixed(_nearest(100 * sp.Abs(units)), 2)
        how = "truncated, not rounded" if cut else f"off by {off} units of the last place"
        unit = rf"\text{{{self._unit}}}" if self.unit else ""
        return Verdict(REFUTED, f"{how}: {exact}", _fixed(_nearest(scaled), digits) + unit)

    @property
    def _unit(self) -> str:
        return f" {self.unit}" if self.unit else ""


@dataclass(frozen=True)
class Posture(Check):
    """Joint angles of an example: ``forward`` takes the ``printed`` angles to ``target``.

    ``corrected`` gives the angles of the intended branch.  They are proved to reach the target and
    are printed in degrees.
    """

    forward: Exact
    printed: Mapping[sp.Symbol, Expr]
    target: Exact
    corrected: Mapping[sp.Symbol, Expr] | None = None

    def judge(self) -> Verdict:
        reached, target = self._reached(self.printed), _entries(self.target)
        decision = decide(_difference(reached, target), sides=[(*reached, *target)] * len(reached))
        if decision.holds:
            return Verdict(PROVED, "the forward map takes them to the target")
        assert decision.counterexample is not None
        where = decision.counterexample.point
        evidence = (
            f"{_at(decision.counterexample)}they reach ({_values(reached, where)}), "
            f"not ({_values(target, where)})"
        )
        if self.corrected is None:
            return Verdict(REFUTED, evidence)
        _require_equal(self._reached(self.corrected), target)
        angles = (rf"{sp.latex(s)} = {_degrees(v)}" for s, v in self.corrected.items())
        return Verdict(REFUTED, evidence, r",\ ".join(angles))

    def _reached(self, joints: Mapping[sp.Symbol, Expr]) -> list[Expr]:
        return [_denested(sp.expand_trig(e.subs(joints))) for e in _entries(self.forward)]


@dataclass(frozen=True)
class Count(Check):
    """A system of equations has the printed number of solutions (``None``: infinitely many).

    The solutions are counted over the complex numbers; coincident ones count once.  ``given``
    replaces dependent targets by free parameters.
    """

    equations: Sequence[Expr]
    unknowns: Sequence[sp.Symbol]
    printed: int | None
    given: Mapping[sp.Symbol, Expr] | None = None

    def judge(self) -> Verdict:
        found = self._found()
        words = "a continuum of" if found is None else str(found)
        text = f"a Groebner basis counts {words} solution{'' if found == 1 else 's'}"
        if found == self.printed:
            return Verdict(PROVED, text)
        return Verdict(REFUTED, text, "infinitely many" if found is None else str(found))

    def _found(self) -> int | None:
        equations = [sp.sympify(e, strict=True) for e in self.equations]
        equations = [e for e in equations if e != 0]
        try:
            counted = count_solutions(
                equations, self.unknowns, target_substitution=dict(self.given or {})
            )
        except InfinitelyManyError:
            return None
        if counted.distinct:
            return counted.count
        parameters = {s for e in equations for s in e.free_symbols} - set(self.unknowns)
        if counted.count == 2 and not parameters:
            return 1
        raise Undecided(f"there are {counted.count} solutions, but some may coincide")


@dataclass(frozen=True)
class Enumeration(Check):
    """A number or a list found by enumeration of all cases; ``meaning`` describes it."""

    printed: Any
    found: Callable[[], Any]
    meaning: str

    def judge(self) -> Verdict:
        found = self.found()
        if found == self.printed:
            return Verdict(PROVED, f"{self.meaning}: {found}")
        return Verdict(REFUTED, f"{self.meaning}: {found}, not {self.printed}", str(found))


@dataclass(frozen=True)
class Holds(Check):
    """Named relations between constants: the statement is proved if all hold, else refuted.

    Enclosures decide inequalities; the exact zero test decides equations.
    """

    relations: Mapping[str, Expr]

    def judge(self) -> Verdict:
        if not self.relations:
            raise ValueError("Holds needs at least one relation")
        failed = [name for name, relation in self.relations.items() if not _holds(relation)]
        if failed:
            return Verdict(REFUTED, f"not so: {', '.join(failed)}")
        return Verdict(PROVED, ", ".join(self.relations))


@dataclass(frozen=True)
class Under(Check):
    """A check that holds under an ``assumption`` that the paper does not state."""

    check: Check
    assumption: str

    def judge(self) -> Verdict:
        verdict = self.check.judge()
        kind = PROVED_UNDER if verdict.kind == PROVED else verdict.kind
        return Verdict(kind, self.assumption, verdict.corrected)


@dataclass(frozen=True)
class Every(Check):
    """A statement with several parts; its verdict is the worst verdict of its parts."""

    parts: Mapping[str, Check]

    def judge(self) -> Verdict:
        if not self.parts:
            raise ValueError("Every needs at least one part")
        verdicts = {name: check.judge() for name, check in self.parts.items()}
        worst = max(verdicts.values(), key=lambda v: _SEVERITY.index(v.kind)).kind
        return Verdict(
            worst,
            "; ".join(
                f"{name}: {v.kind}" + (f" ({v.evidence})" if v.evidence else "")
                for name, v in verdicts.items()
            ),
            r";\quad ".join(
                rf"\text{{{name}: }} {v.corrected}" for name, v in verdicts.items() if v.corrected
            ),
        )


@dataclass(frozen=True)
class Deferred(Check):
    """A check with expressions that take long to build; ``make`` builds them when it is judged."""

    make: Callable[[], Check]

    def judge(self) -> Verdict:
        return self.make().judge()


@dataclass(frozen=True)
class Refuted(Check):
    """A statement about all cases, contradicted by a ``witness``, which must be provable.

    ``corrected`` is the statement that holds instead, in LaTeX or in words; ``proof`` proves it.
    """

    witness: Check
    explanation: str
    corrected: str = ""
    proof: Check | None = None

    def judge(self) -> Verdict:
        if self.corrected and self.proof is None:
            raise ValueError(f"the correction {self.corrected} has no proof")
        for check in (self.witness, self.proof):
            if check is not None and check.judge().kind not in (PROVED, PROVED_UNDER):
                raise ValueError(f"the witness against a claim does not hold: {self.explanation}")
        return Verdict(REFUTED, self.explanation, self.corrected)


@dataclass(frozen=True)
class Undecidable(Check):
    """A figure, a measurement or a judgement of value; ``reason`` explains it."""

    reason: str

    def judge(self) -> Verdict:
        return Verdict(NOT_DECIDABLE, self.reason)


def _entries(value: Exact) -> list[Expr]:
    many = isinstance(value, sp.MatrixBase | Sequence)
    entries = [sp.sympify(e, strict=True) for e in (value if many else [value])]
    for e in entries:
        reject_floats(e, "a claim")
    return entries


def _constant(value: Expr) -> Expr:
    (e,) = _entries(value)
    if e.free_symbols:
        names = ", ".join(sorted(map(str, e.free_symbols)))
        raise ValueError(f"{e} is not a constant: it depends on {names}")
    return e


def _difference(a: Exact, b: Exact) -> Exact:
    shape = getattr(a, "shape", None)
    if shape != getattr(b, "shape", None):
        raise ValueError(f"the two sides have different shapes: {a}, {b}")
    differences = [x - y for x, y in zip(_entries(a), _entries(b), strict=True)]
    if shape is not None:
        return sp.Matrix(*shape, differences)
    return sp.Matrix(differences) if isinstance(a, Sequence) else differences[0]


def _require_equal(corrected: Exact, derived: Exact, nonnegative: Sequence[Expr] = ()) -> None:
    if not decide(_difference(corrected, derived), nonnegative).holds:
        raise ValueError(f"the corrected form {corrected} does not equal {derived}")


def _latex(value: Exact) -> str:
    if isinstance(value, list | tuple):
        return r",\ ".join(str(sp.latex(v)) for v in value)
    return str(sp.latex(value))


def _value(e: Expr, point: Mapping[sp.Symbol, Expr]) -> str:
    """The value at a point: exact if that is short, else six digits."""
    exact = e.subs(point)
    if not exact.free_symbols and exact.is_finite and len(str(exact)) <= _READABLE:
        return str(exact)
    return str(evaluate([e], point)[0].str(6, radius=False))


def _values(entries: Sequence[Expr], point: Mapping[sp.Symbol, Expr]) -> str:
    return ", ".join(_value(e, point) for e in entries)


def _at(found: Counterexample) -> str:
    """The point of a counterexample as text; empty for constants."""
    at = ", ".join(f"{s} = {v}" for s, v in found.point.items())
    return f"at {at} " if at else ""


def _degrees(angle: Expr) -> str:
    degrees = sp.sympify(angle, strict=True) * 180 / sp.pi
    if degrees.free_symbols:
        return str(sp.latex(angle))
    if degrees.is_Rational:
        return rf"{sp.latex(degrees)}^\circ"
    return rf"{_fixed(_nearest(degrees * 10**4), 4)}^\circ"


def _denested(e: Expr) -> Expr:
    """Write roots of ``a + b sqrt(c)`` in this form too, if possible."""
    roots = [p for p in e.atoms(sp.Pow) if p.exp.is_Rational and not p.exp.is_Integer]
    plain = {p: sp.sqrtdenest(sp.sqrt(sp.expand(p.base))) ** (2 * p.exp) for p in roots}
    return e.xreplace(plain)


def _sign(e: Expr) -> int:
    """The sign of a constant; zero only if the constant is proved to vanish."""
    e = _constant(e)
    if e.is_Rational:
        return int(sp.sign(e))
    ball = evaluate([e], {})[0]
    if not ball.contains(0):
        return 1 if ball > 0 else -1
    if decide(_denested(e)).holds:
        return 0
    raise Undecided(f"the sign of {e} cannot be decided")


def _holds(relation: Expr) -> bool:
    """Whether a relation between constants holds; SymPy may already have decided it."""
    if relation in (sp.true, sp.false):
        return bool(relation)
    if not isinstance(relation, Relational):
        raise TypeError(f"{relation} is neither an equation nor an inequality")
    sign = _sign(relation.lhs - relation.rhs)
    allowed = {
        sp.Eq: (0,),
        sp.Ne: (-1, 1),
        sp.Gt: (1,),
        sp.Ge: (0, 1),
        sp.Lt: (-1,),
        sp.Le: (-1, 0),
    }
    return sign in allowed[type(relation)]


def _nearest(e: Expr) -> int:
    """The integer nearest to a constant; of two, the one farther from zero."""
    size = abs(e)
    floor = int(str(evaluate([size], {})[0].mid().floor().unique_fmpz()))
    below = floor if _sign(size - floor) >= 0 else floor - 1
    up = _sign(size - below - sp.Rational(1, 2)) >= 0
    return _sign(e) * (below + up)


def _fixed(n: int, digits: int) -> str:
    """``n / 10**digits`` as a decimal."""
    whole, part = divmod(abs(n), 10**digits)
    sign = "-" if n < 0 else ""
    return f"{sign}{whole}.{part:0{digits}d}" if digits else f"{sign}{whole}"
