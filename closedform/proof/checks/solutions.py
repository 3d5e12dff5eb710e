"""Checks of solutions: how many there are, and which of them a printed formula gives.

A printed formula is judged as a map: ``theta = tan^-1(u/v)`` has one value, between minus and plus
a quarter turn.
"""

# mypy: allow-untyped-calls
# SymPy is only partly annotated.

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import islice, product
from typing import Any

import numpy as np
import sympy as sp

from closedform.algebra.balls import Evaluator, Undetermined
from closedform.algebra.normal_form import Undecided, decide
from closedform.algebra.solutions import InfinitelyManyError, count_solutions
from closedform.model.claims import INCOMPLETE, PROVED, REFUTED, Check, Verdict
from closedform.model.notation import SIGN
from closedform.proof.checks.equations import Every
from closedform.proof.checks.evidence import Expr, at, cases, shown

SAMPLES = 100_000
"""The number of sampled postures, of which a share is given."""
_CLOSE = 1e-6
_SIMPLE = 2000
"""The number of postures that are searched for a simple one."""
_ANGLES = (
    0,
    sp.pi / 6,
    -sp.pi / 6,
    sp.pi / 3,
    sp.pi / 2,
    -sp.pi / 2,
    2 * sp.pi / 3,
    -2 * sp.pi / 3,
)


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
        found = self.found()
        words = "a continuum of" if found is None else str(found)
        text = f"a Groebner basis counts {words} solution{'' if found == 1 else 's'}"
        return Verdict(PROVED if found == self.printed else REFUTED, (text,))

    def found(self) -> int | None:
        given = tuple(sorted((self.given or {}).items(), key=str))
        equations = [sp.sympify(e, strict=True) for e in self.equations]
        return _counted(tuple(e for e in equations if e != 0), tuple(self.unknowns), given)


@lru_cache(maxsize=16)
def _counted(
    equations: tuple[Expr, ...],
    unknowns: tuple[sp.Symbol, ...],
    given: tuple[tuple[sp.Symbol, Expr], ...],
) -> int | None:
    """The number of solutions; the readings of a claim and its correction ask for the same one."""
    try:
        counted = count_solutions(equations, unknowns, target_substitution=dict(given))
    except InfinitelyManyError:
        return None
    if counted.distinct:
        return counted.count
    parameters = {s for e in equations for s in e.free_symbols} - set(unknowns)
    if counted.count == 2 and not parameters:
        return 1
    raise Undecided(f"there are {counted.count} solutions, but some may coincide")


def forget_solutions() -> None:
    """Forget all counts, so that each derivation leaves the certificates of its own."""
    _counted.cache_clear()


@dataclass(frozen=True)
class Postures:
    """Sampled postures: joints, in ranges, and the dimensions at which they are sampled.

    ``inputs`` gives the inputs of a formula as functions of the joints.  ``groups`` names parts of
    the postures whose share is also given.  ``virtual`` gives joints that the mechanism does not
    have, in those that it has, for a picture of the result of the formulas.
    """

    inputs: Mapping[sp.Symbol, Expr]
    joints: Sequence[sp.Symbol]
    dimensions: Mapping[sp.Symbol, Expr] = field(default_factory=dict)
    ranges: Mapping[sp.Symbol, tuple[float, float]] = field(default_factory=dict)
    groups: Mapping[str, Expr] = field(default_factory=dict)
    virtual: Mapping[sp.Symbol, Expr] = field(default_factory=dict)

    def arrays(self) -> dict[sp.Symbol, np.ndarray]:
        """The joints and the inputs at the sampled postures, the same on every run."""
        rng = np.random.default_rng(0)
        drawn = {
            q: rng.uniform(*self.ranges.get(q, (-np.pi, np.pi)), size=SAMPLES) for q in self.joints
        }
        drawn |= {s: np.full(SAMPLES, float(v)) for s, v in self.dimensions.items()}
        return drawn | {s: values(e, drawn) for s, e in self.inputs.items()}

    def drawn(self) -> list[Any]:
        """The ranges of the joints, in words."""
        several: dict[str, list[sp.Symbol]] = {}
        for q in self.joints:
            low, high = (f"{np.degrees(a):.0f}^\\circ" for a in self.ranges.get(q, (-np.pi, np.pi)))
            several.setdefault(f"${low}$ to ${high}$", []).append(q)
        pieces: list[Any] = []
        for words, joints in several.items():
            pieces += [", " * bool(pieces), *(p for q in joints for p in (q, ", "))][:-1]
            pieces.append(f" from {words}")
        return pieces

    def simple(self) -> Iterator[dict[sp.Symbol, Expr]]:
        """Exact postures that a person can check by hand, with unit dimensions."""
        used = {s for e in self.inputs.values() for s in e.free_symbols}
        lengths = dict.fromkeys(sorted(used - set(self.joints), key=str), sp.S.One)
        for ranks in islice(_ranked(len(self.joints)), _SIMPLE):
            yield lengths | {q: _ANGLES[r] for q, r in zip(self.joints, ranks, strict=True)}


def _ranked(length: int) -> Iterator[tuple[int, ...]]:
    """The ranks of this many angles among the simple ones, those with the least sum first."""
    last = len(_ANGLES) - 1
    for total in range(length * last + 1):
        yield from _with_sum(total, length, last)


def _with_sum(total: int, length: int, last: int) -> Iterator[tuple[int, ...]]:
    if not length:
        yield ()
        return
    for first in range(max(0, total - (length - 1) * last), min(total, last) + 1):
        for others in _with_sum(total - first, length - 1, last):
            yield (first, *others)


def values(e: Expr, at_symbols: Mapping[sp.Symbol, np.ndarray]) -> np.ndarray:
    """The values of an expression over arrays; not a number where it has no real value."""
    symbols = tuple(s for s in at_symbols if s in e.free_symbols)
    size = len(next(iter(at_symbols.values())))
    with np.errstate(all="ignore"):
        found = _compiled(symbols, e)(*(at_symbols[s] for s in symbols))
    return np.broadcast_to(np.asarray(found), (size,))


@lru_cache(maxsize=64)
def _compiled(symbols: tuple[sp.Symbol, ...], e: Expr) -> Callable[..., Any]:
    """An expression as a function; the forward map is evaluated for many claims."""
    compiled: Callable[..., Any] = sp.lambdify(symbols, e, "numpy", cse=True)
    return compiled


@dataclass(frozen=True)
class Solves(Check):
    """Printed formulas for unknowns give every solution of the ``equations``.

    Every value of the formulas has to satisfy the equations; otherwise the claim is refuted.  If
    they do, but there are more solutions than values, the formulas are incomplete.  ``postures``
    gives the share of sampled postures whose own unknowns the formulas miss.  ``nonnegative`` lists
    what must not be negative for the formulas to be real; ``given`` replaces dependent targets by
    free parameters.
    """

    formulas: Mapping[sp.Symbol, Expr]
    equations: Sequence[Expr]
    postures: Postures | None = None
    nonnegative: tuple[Expr, ...] = ()
    given: Mapping[sp.Symbol, Expr] | None = None

    def judge(self) -> Verdict:
        given = dict(self.given or {})
        branches = self._branches()
        for branch, conditions in branches:
            left = [
                sp.sympify(e, strict=True).subs(branch, simultaneous=True).subs(given)
                for e in self.equations
            ]
            if any(e.has(sp.nan, sp.zoo) for e in left):
                return Verdict(REFUTED, ("the formula has no value", *self._share()))
            decision = decide(sp.Matrix(left), [*self.nonnegative, *conditions])
            if not decision.holds:
                assert decision.counterexample is not None
                where = at(decision.counterexample.point)
                return Verdict(
                    REFUTED, (*where, "the formula does not solve the equation", *self._share())
                )
        counted = Count(self.equations, tuple(self.formulas), None, self.given).found()
        given_values = len({tuple(b.values()) for b, _ in branches}) // self._cases()
        if counted is not None and given_values >= counted:
            few = {1: "the only solution", 2: "both solutions"}
            text = few.get(counted, f"all {counted} solutions")
            return Verdict(PROVED, (text,))
        many = "infinitely many" if counted is None else str(counted)
        text = f"right, but it gives {given_values} of {many} solutions"
        return Verdict(INCOMPLETE, (text, *self._share()))

    def _cases(self) -> int:
        """The number of cases of the formulas, of which each posture is in one."""
        return max([len(p.args) for f in self.formulas.values() for p in _piecewise(f)] or [1])

    def _branches(self) -> list[tuple[dict[sp.Symbol, Expr], list[Expr]]]:
        """The values for each sign and each case, with the conditions of the case."""
        cases: list[tuple[dict[sp.Symbol, Expr], list[Expr]]] = [(dict(self.formulas), [])]
        while any(_piecewise(f) for branch, _ in cases for f in branch.values()):
            cases = [c for branch, conditions in cases for c in _split(branch, conditions)]
        return [
            ({u: f.subs(SIGN, s) for u, f in branch.items()}, conditions)
            for branch, conditions in cases
            for s in ((1, -1) if any(f.has(SIGN) for f in branch.values()) else (1,))
        ]

    def _share(self) -> tuple[Any, ...]:
        if self.postures is None:
            return ()
        sampled = self.postures.arrays()
        found = np.zeros(SAMPLES, dtype=bool)
        for s in (1, -1):
            close = np.ones(SAMPLES, dtype=bool)
            for unknown, formula in self.formulas.items():
                gap = values(formula.subs(SIGN, s), sampled) - sampled[unknown]
                close &= np.abs(np.angle(np.exp(1j * gap))) < _CLOSE
            found |= close
        return share(
            "it misses the posture from which the target was computed",
            ~found,
            self.postures,
            sampled,
        )


@dataclass(frozen=True)
class Procedure(Check):
    """Printed formulas, evaluated one after the other, lead to postures that reach the target.

    ``formulas`` give names, in order, in the inputs and in names given before.  ``reached`` is the
    forward map in the names; it has to equal the ``targets``, which ``postures`` takes as inputs.
    A sample can refute a procedure.  If no posture is missed, the exact zero test has to prove it:
    that the target is reached, or, with ``steps``, that each formula solves its equation.
    """

    formulas: Mapping[sp.Symbol, Expr]
    reached: Mapping[sp.Symbol, Expr]
    postures: Postures
    steps: Mapping[str, Check] = field(default_factory=dict)

    def judge(self) -> Verdict:
        sampled = self.postures.arrays()
        missed = self._missed(sampled)
        if not missed.any():
            return self._proved()
        where = self._simple()
        how = share("it does not reach its target", missed, self.postures, sampled)
        return Verdict(REFUTED, (*where, *how[1:]) if where else how[1:])

    def _missed(self, sampled: Mapping[sp.Symbol, np.ndarray]) -> np.ndarray:
        """Whether the target is missed, for each posture and for all signs."""
        size = 1 + sum(np.abs(sampled[t]) for t in self.reached)
        missed = np.ones(np.shape(size), dtype=bool)
        for signs in product(
            (1, -1), repeat=len([f for f in self.formulas.values() if f.has(SIGN)])
        ):
            names, chosen = dict(sampled), iter(signs)
            for name, formula in self.formulas.items():
                used = formula.subs(SIGN, next(chosen)) if formula.has(SIGN) else formula
                names[name] = values(used, names)
            gaps = [np.abs(values(e, names) - sampled[t]) for t, e in self.reached.items()]
            missed &= ~(np.max(gaps, axis=0) < _CLOSE * size)
        return missed

    def _missed_simple(self) -> list[dict[sp.Symbol, Expr]]:
        """The simple postures that seem to be missed, by their values in floating point."""
        simple = list(self.postures.simple())
        decimal = {value: float(value) for value in (sp.S.One, *_ANGLES)}
        arrays = {s: np.array([decimal[p[s]] for p in simple]) for s in simple[0]}
        arrays |= {s: values(e, arrays) for s, e in self.postures.inputs.items()}
        return [p for p, out in zip(simple, self._missed(arrays), strict=True) if out]

    def _proved(self) -> Verdict:
        """The verdict if no sampled posture is missed: an exact proof for each choice of signs."""
        if self.steps:
            return Every(self.steps).judge()
        signs = (1, -1) if any(f.has(SIGN) for f in self.formulas.values()) else (1,)
        for s in signs:
            names = dict(self.postures.inputs)
            for name, formula in self.formulas.items():
                names[name] = formula.subs(SIGN, s).subs(names, simultaneous=True)
            gaps = [
                e.subs(names, simultaneous=True) - self.postures.inputs[t]
                for t, e in self.reached.items()
            ]
            if not decide(sp.Matrix(gaps)).holds:
                raise Undecided(
                    f"none of {SAMPLES} sampled postures is missed, but samples prove nothing"
                )
        return Verdict(PROVED, ("the posture that it gives reaches its target",))

    def _simple(self) -> tuple[Any, ...]:
        """A posture that a person can check by hand, with what is reached there."""
        if any(f.has(SIGN) for f in self.formulas.values()):
            return ()
        inputs, both = self.postures.inputs, [*self.reached.values(), *self.reached]
        evaluator = None
        for posture in self._missed_simple()[:20]:
            point = posture | {s: sp.simplify(e.xreplace(posture)) for s, e in inputs.items()}
            given = {s: v for s, v in point.items() if s not in self.formulas}
            evaluator = evaluator or Evaluator(tuple(given), both, named=self.formulas)
            try:
                balls = evaluator(given)
            except (Undetermined, TypeError):
                continue
            pairs = list(zip(self.reached, balls, balls[len(self.reached) :], strict=False))
            missed = [(t, a) for t, a, b in pairs if not (a - b).contains(0)]
            if all(b.is_finite() for b in balls) and missed:
                pieces: list[Any] = []
                for t, ball in missed:
                    decimal = ball.str(6, radius=False)
                    pieces += [", ", t, f" = ${decimal}$ instead of ", shown(point[t], {})]
                return ("at ", posture, ": it reaches ", *pieces[1:], "; ")
        return ()


def share(
    what: str, missed: np.ndarray, postures: Postures, sampled: Mapping[sp.Symbol, np.ndarray]
) -> tuple[Any, ...]:
    """How many of the sampled postures are missed, in all and in each group."""
    pieces = ["; ", f"{what} in {_percent(missed)} of {SAMPLES} sampled postures, with "]
    pieces += postures.drawn()
    groups = [
        f"{name}: {_percent(missed[part])}"
        for name, condition in postures.groups.items()
        if (part := values(sp.sympify(condition, strict=True), sampled).astype(bool)).any()
    ]
    return (*pieces, f" ({', '.join(groups)})") if groups else tuple(pieces)


def _percent(part: np.ndarray) -> str:
    return f"{100 * float(np.mean(part)):.1f} %"


def _piecewise(e: Expr) -> list[Expr]:
    return sorted(e.atoms(sp.Piecewise), key=str)


def _split(
    branch: dict[sp.Symbol, Expr], conditions: list[Expr]
) -> Iterator[tuple[dict[sp.Symbol, Expr], list[Expr]]]:
    """The cases of the first piecewise function of a branch."""
    first = next((p for f in branch.values() for p in _piecewise(f)), None)
    if first is None:
        yield branch, conditions
        return
    for value, gaps in cases(first):
        yield {u: f.subs(first, value) for u, f in branch.items()}, [*conditions, *gaps]
