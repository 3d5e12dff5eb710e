"""The zero test that proves identities.

`is_zero` proves that the normal form (see `closedform.algebra.tower`) of every entry is zero.
`decide` can also refute by a counterexample, and raises `Undecided` if it can do neither.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

import sympy as sp

from closedform.algebra.certificates import open_record, point
from closedform.algebra.counterexample import Counterexample, find_counterexample
from closedform.algebra.expressions import Expr, Problem, entries_of, margin_of, shortened
from closedform.algebra.tower import Fraction, Tower, Undecided, content, converted

__all__ = [
    "Decision",
    "Undecided",
    "ZeroResult",
    "decide",
    "determinant",
    "equal",
    "is_zero",
    "normal",
    "positive_form",
]


@dataclass(frozen=True)
class ZeroResult:
    """Result of the zero test; `zero` means that every normal form is zero, which is a proof."""

    zero: bool
    nonzero: tuple[int, ...]
    """Indices of the entries whose normal form is not zero."""
    assumptions: tuple[Expr, ...]
    """The assumptions of the caller that were used: these expressions are nonnegative."""
    terms: int
    """The largest number of terms of any intermediate polynomial."""
    _tower: Tower = field(repr=False, compare=False)
    _residues: tuple[Fraction, ...] = field(repr=False, compare=False)

    def __bool__(self) -> bool:
        return self.zero

    @property
    def denominators(self) -> tuple[Expr, ...]:
        """The identity is claimed only for points at which none of these vanishes."""
        return self._tower.denominators()

    @property
    def remainders(self) -> tuple[Expr, ...]:
        """Numerators of the normal forms, entry by entry."""
        return tuple(self._tower.expression(a.num) for a in self._residues)


@dataclass(frozen=True)
class Decision:
    """A proof or a refutation."""

    holds: bool
    verdict: str
    """As in the errata: `proved`, `proved under assumption` or `refuted`."""
    assumptions: tuple[Expr, ...]
    proof: ZeroResult | None
    counterexample: Counterexample | None


def is_zero(problem: Problem, nonnegative: Iterable[Expr] = ()) -> ZeroResult:
    """Whether the normal form of every entry is zero.

    `nonnegative` lists the assumptions of the caller: expressions, or relations `a >= b`. They
    allow `sqrt(p*q) = sqrt(p)*sqrt(q)` and `|p| = p`; the result names those that were used.
    """
    tower, residues = converted(problem, nonnegative)
    nonzero = tuple(i for i, a in enumerate(residues) if not a.num.is_zero())
    assumptions = tuple(tower.assumptions)
    return ZeroResult(
        zero=not nonzero,
        nonzero=nonzero,
        assumptions=assumptions,
        terms=tower.peak,
        _tower=tower,
        _residues=tuple(residues),
    )


def equal(a: Expr, b: Expr, nonnegative: Iterable[Expr] = ()) -> bool:
    """Whether `a - b` (matrices: entry by entry) has normal form zero."""
    return is_zero(a - b, nonnegative).zero


def normal(e: Expr, nonnegative: Iterable[Expr] = ()) -> Expr:
    """The normal form as a SymPy fraction, expanded, with a rational denominator."""
    tower, (value,) = converted(e, nonnegative)
    value = tower.rationalised(value)
    scale = content(value.den)
    num, den = value.num / scale, value.den / scale
    return tower.expression(num) / tower.expression(den)


def determinant(J: sp.MatrixBase) -> Expr:
    """The normal form of a determinant without denominators, expanded by minors.

    Every minor of the first columns is reduced immediately, which keeps twists of general axes
    short. The sparsest columns come first.
    """
    tower, entries = converted(J, ())
    n = J.rows
    columns = [entries[j::n] for j in range(n)]
    order = sorted(range(n), key=lambda j: sum(len(e.num) for e in columns[j]))
    swaps = sum(order[a] > order[b] for a, b in combinations(range(n), 2))
    minors: dict[tuple[int, ...], Fraction] = {(): tower.one}
    for k, j in enumerate(order):
        longer: dict[tuple[int, ...], Fraction] = {}
        for rows, minor in minors.items():
            for i, entry in enumerate(columns[j]):
                if i in rows or entry.num.is_zero():
                    continue
                chosen = tuple(sorted((*rows, i)))
                term = tower.product(minor, entry, (-1) ** (k - chosen.index(i)))
                longer[chosen] = tower.sum(longer[chosen], term) if chosen in longer else term
        minors = longer
    (value,) = minors.values() or (tower.zero,)
    return (-1) ** swaps * tower.expression(value.num) / tower.expression(value.den)


def positive_form(expr: Expr, slack: Sequence[tuple[sp.Symbol, Expr]]) -> Expr:
    """``expr`` rewritten in nonnegative symbols, so that all its coefficients are positive.

    Such a form proves that the expression is not negative if the new symbols are not negative.
    """
    top, bottom = sp.fraction(sp.together(sp.expand(expr.subs(slack))))
    for part in (top, bottom):
        polynomial = sp.Poly(part, sp.Dummy("one"), *sorted(part.free_symbols, key=str))
        if any(c.is_negative for c in polynomial.coeffs()):
            raise ValueError(f"{expr}: {polynomial.as_expr()} has a negative coefficient")
    return sp.expand(top) / sp.factor(bottom)


def decide(
    problem: Problem,
    nonnegative: Iterable[Expr] = (),
    seed: int = 0,
    *,
    sides: Sequence[Sequence[Expr]] = (),
    postures: Sequence[Mapping[sp.Symbol, Expr]] = (),
) -> Decision:
    """Prove that every entry is zero, or refute it at a point at which the assumptions hold.

    ``sides`` contains, for each entry, the expressions of which it is the difference; the
    counterexample is a point at which they have values too.  If symbols depend on each other, only
    points of ``postures`` can refute.
    """
    guards = [margin_of(g) for g in nonnegative]
    try:
        result, obstacle = is_zero(problem, guards), ""
    except Undecided as reason:
        result, obstacle = None, str(reason)
    if result:
        if record := open_record():
            record.identity(problem, result.assumptions, result._tower)
        verdict = "proved under assumption" if result.assumptions else "proved"
        return Decision(True, verdict, result.assumptions, result, None)
    witness = find_counterexample(
        sp.Matrix(entries_of(problem)),
        conditions=[g >= 0 for g in guards],
        seed=seed,
        sides=sides,
        postures=postures,
    )
    if witness:
        entry = sp.sympify(entries_of(problem)[witness.entry], strict=True)
        point([[entry]], witness.point, "refutations by a counterexample", guards)
        return Decision(False, "refuted", tuple(guards), result, witness)
    if result is not None:
        entry = result.nonzero[0]
        obstacle = f"the normal form of entry {entry} is {shortened(result.remainders[entry])}"
    raise Undecided(
        f"{shortened(entries_of(problem))}: {obstacle}, and no counterexample was found; "
        "list in `nonnegative` the expressions that must not be negative for its roots to split"
    )
