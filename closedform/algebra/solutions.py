"""The number of solutions of a kinematic system, which decides whether an inverse is complete.

The unknown angles become pairs `s, c` on the unit circle, which turns the forward equations into
polynomials over the field of rational functions in parameters and targets. The number of solutions
of a zero-dimensional system, over the complex numbers and with multiplicity, is the number of
monomials that no leading monomial of a Groebner basis divides. Targets that obey relations (the
entries of a rotation) are first written in free parameters.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product
from typing import Any, Literal, TypeAlias

import sympy as sp
from flint import fmpq, fmpq_mat
from sympy import QQ, Rational, Symbol
from sympy.polys.groebnertools import groebner
from sympy.polys.numberfields import primitive_element
from sympy.polys.orderings import grevlex
from sympy.polys.rings import PolyElement, PolyRing

from closedform.algebra.certificates import Counted, System, open_record
from closedform.algebra.expressions import TRIGONOMETRIC

Expr: TypeAlias = Any  # SymPy's annotations are partial
Monomial: TypeAlias = tuple[int, ...]
Method: TypeAlias = Literal["generic", "specialised"]


class NotRationalError(ValueError):
    """An equation contains a root, which the count of its solutions cannot take."""


class InfinitelyManyError(ValueError):
    """The system has infinitely many solutions for generic parameters."""


@dataclass(frozen=True)
class SolutionCount:
    """The number of solutions for generic values of the parameters."""

    count: int
    """Solutions over the complex numbers, with multiplicity."""
    distinct: bool
    """Whether all of them provably differ from each other."""
    method: Method
    """`generic`: proved over the function field; `specialised`: equal at all `points`."""
    points: tuple[dict[Symbol, Expr], ...] = ()
    certificate: int | None = None
    """The number of its certificate, if one was recorded."""
    conjugate: int = 0
    """Solutions that the certificate counts too, for other signs of the roots of numbers."""

    def __int__(self) -> int:
        return self.count


def count_solutions(
    equations: Iterable[Expr],
    unknowns: Sequence[Symbol],
    *,
    target_substitution: Mapping[Symbol, Expr] | None = None,
    saturate: Iterable[Expr] = (),
    method: Method = "generic",
    specialisations: int = 3,
    seed: int = 0,
) -> SolutionCount:
    """Count the solutions of `equations = 0`.

    An unknown that occurs in a sine or cosine is an angle, counted modulo a full turn. Every other
    symbol is a parameter. A root of a number, such as `sqrt(2)`, counts as what it is. Raises
    `InfinitelyManyError` if there are infinitely many solutions.
    While certificates are recorded, the basis of the certificate is counted, if SymPy agrees for
    random parameters. Otherwise SymPy computes a basis for symbolic ones.

    Parameters
    ----------
    equations
        expressions that vanish
    unknowns
        what they are solved for
    target_substitution
        rational functions of free parameters for target symbols that are not independent, see
        `rotation_parametrisation`
    saturate
        expressions that must not vanish, besides the denominators that contain unknowns
    method
        whether parameters stay symbols, or get numbers
    specialisations
        how many sets of numbers they get
    seed
        that of the numbers
    """
    equations, saturate, given = list(equations), list(saturate), target_substitution or {}
    if field := _field_of_roots([*equations, *saturate, *given.values()]):
        counted = count_solutions(
            [field.written(e) for e in equations] + [field.polynomial],
            [*unknowns, field.unknown],
            target_substitution={s: field.written(e) for s, e in given.items()},
            saturate=[field.written(e) for e in saturate],
            method=method,
            specialisations=specialisations,
            seed=seed,
        )
        count = counted.count // field.degree
        return replace(counted, count=count, conjugate=counted.count - count)
    system = _System(equations, unknowns, given, saturate)
    draw = random.Random(seed)
    record, certified = open_record(), None
    if method == "generic":
        if record:
            stated = {
                s for e in [*equations, *saturate] for s in sp.sympify(e, strict=True).free_symbols
            }
            given = {**given, **system.merged(stated - {*given, *unknowns})}
            problem = System(equations, saturate, given, system.angles, system.plain)
            certified = record.count(problem)
        if certified and certified.count and certified.count == _count_at_a_point(system, draw):
            distinct = _are_distinct(*_certified_at_a_point(certified, draw))
            return SolutionCount(certified.count, distinct, "generic", (), certified.number)
        total, distinct = 1, True
        for variables, polynomials in system.blocks():
            free = {s for p in polynomials for s in p.free_symbols} - set(variables)
            parameters = sorted(free, key=str)
            ring = PolyRing(variables, _function_field(parameters), grevlex)
            basis = groebner([_element(ring, p) for p in polynomials], ring)
            monomials = _standard_monomials(basis, ring)
            alone = _are_distinct(_specialised(basis, parameters, draw), monomials)
            total, distinct = total * len(monomials), distinct and alone
        if certified and certified.count != total:
            raise RuntimeError(f"{total} solutions are counted, but their certificate differs")
        number = certified.number if certified else None
        return SolutionCount(total, distinct, "generic", (), number)

    ring = PolyRing(system.variables, QQ, grevlex)
    points, counts, distinct = [], set(), True
    for _ in range(specialisations):
        point = {p: _random_rational(draw) for p in system.parameters}
        basis = groebner([_element(ring, p.subs(point)) for p in system.polynomials], ring)
        monomials = _standard_monomials(basis, ring)
        distinct = distinct and _are_distinct(basis, monomials)
        counts.add(len(monomials))
        points.append(point)
    if len(counts) != 1:
        raise ValueError(f"the count depends on the parameters ({sorted(counts)}): change `seed`")
    return SolutionCount(counts.pop(), distinct, "specialised", tuple(points))


def rotation_parametrisation(
    parameters: tuple[Symbol, Symbol, Symbol] | None = None,
) -> sp.ImmutableMatrix:
    """Every rotation except half turns, by the quaternion `(1, a, b, c)` (Euler-Rodrigues).

    `(1 + |v|**2) R = (1 - |v|**2) I + 2 [v] + 2 v v^T` with `v = (a, b, c)`.
    """
    a, b, c = parameters or sp.symbols("rho1:4", real=True)
    v = sp.Matrix([a, b, c])
    cross = sp.Matrix([[0, -c, b], [c, 0, -a], [-b, a, 0]])
    square = v.dot(v)
    numerator = (1 - square) * sp.eye(3) + 2 * cross + 2 * v * v.T
    return sp.ImmutableMatrix(numerator / (1 + square))


@dataclass(frozen=True)
class _FieldOfRoots:
    """The field of the roots of numbers: each is a polynomial in one of its elements.

    As an unknown, this element may be any zero of its irreducible ``polynomial``. Automorphisms of
    the algebraic closure exchange the zeros, so to each of them belong equally many solutions.
    """

    unknown: Symbol
    polynomial: Expr
    roots: Mapping[Expr, Expr]

    @property
    def degree(self) -> int:
        return int(sp.degree(self.polynomial, self.unknown))

    def written(self, e: Expr) -> Expr:
        """An expression with polynomials in the unknown for its roots."""
        return sp.sympify(e, strict=True).xreplace(self.roots)


def _field_of_roots(expressions: Iterable[Expr]) -> _FieldOfRoots | None:
    """The field of all roots of numbers in the expressions; None if there are none."""
    powers = {p for e in expressions for p in sp.sympify(e, strict=True).atoms(sp.Pow)}
    roots = sorted((p for p in powers if p.is_algebraic and not p.exp.is_Integer), key=str)
    if not roots:
        return None
    unknown = Symbol("root_of_numbers", real=True)
    polynomial, _, powers_of = primitive_element(roots, unknown, ex=True)
    return _FieldOfRoots(
        unknown,
        polynomial,
        {p: sp.Poly(row, unknown).as_expr() for p, row in zip(roots, powers_of, strict=True)},
    )


class _System:
    """Polynomials in `variables` with coefficients rational in `parameters`."""

    def __init__(
        self,
        equations: Sequence[Expr],
        unknowns: Sequence[Symbol],
        substitution: Mapping[Symbol, Expr],
        saturate: Sequence[Expr],
    ) -> None:
        self._circles: dict[Symbol, tuple[Symbol, Symbol]] = {}
        given = [sp.sympify(e, strict=True).subs(substitution) for e in [*equations, *saturate]]
        unknowns, given, changes = _absolute_angles(unknowns, given)
        self._unknowns = set(unknowns)
        algebraic = [self._without_angles(e) for e in given]
        fractions = [sp.fraction(sp.together(e)) for e in algebraic]
        plain = [u for u in unknowns if any(u in e.free_symbols for e in algebraic)]
        circles = sorted(self._circles.values(), key=lambda pair: _rank(pair, algebraic))
        self.variables = [v for pair in circles for v in pair] + plain
        self.plain = plain
        order = [next(a for a, c in self._circles.items() if c is pair) for pair in circles]
        self.angles = {
            angle: [int(sum_.coeff(a)) for a in order] for angle, sum_ in changes.items()
        }
        missing = self._unknowns - set(plain) - set(self._circles)
        if missing:
            raise InfinitelyManyError(
                f"{', '.join(sorted(map(str, missing)))}: no equation contains this unknown, "
                f"so it is free"
            )
        self.polynomials = [numerator for numerator, _ in fractions[: len(equations)]]
        self.polynomials += [s**2 + c**2 - 1 for s, c in self._circles.values()]
        nonzero = [numerator for numerator, _ in fractions[len(equations) :]]
        nonzero += [d for _, d in fractions if d.has(*self.variables)]
        for factor in dict.fromkeys(nonzero):
            inverse = sp.Dummy(f"inverse{len(self.variables)}")
            self.variables.append(inverse)
            self.polynomials.append(inverse * factor - 1)
        self._merge_parameters()
        free = {s for p in self.polynomials for s in p.free_symbols}
        self.parameters = sorted(free - set(self.variables), key=str)

    def _merge_parameters(self) -> None:
        """Keep one of two parameters that occur only as one sum or difference, such as `a + b`.

        The system at `(a, b)` is the system at `(a + b, 0)`; fewer parameters are much faster.
        """
        self._merged: dict[Symbol, Expr] = {}
        free = {s for p in self.polynomials for s in p.free_symbols}
        parameters = sorted(free - set(self.variables), key=str)
        if len(parameters) < 2:
            return
        ring = PolyRing([*self.variables, *parameters], QQ, grevlex)
        read = [_element(ring, p) for p in self.polynomials]
        generators = dict(zip(ring.symbols, ring.gens, strict=True))
        for a, b in combinations(parameters, 2):
            slopes = [(p.diff(generators[a]), p.diff(generators[b])) for p in read]
            for sign in (1, -1):
                if all(x == sign * y for x, y in slopes):
                    self.polynomials = [p.subs(b, 0) for p in self.polynomials]
                    read = [p.evaluate(generators[b], 0).set_ring(ring) for p in read]
                    if any(x != 0 for x, _ in slopes):
                        self._merged[a] = self._merged.get(a, sp.Dummy(f"{a}'")) - sign * b
                    break

    def merged(self, stated: set[Symbol]) -> dict[Symbol, Expr]:
        """Of each merged sum, one symbol as the new parameter (the sum) minus the other symbols."""
        return {
            a: e
            for a, e in self._merged.items()
            if all(s in stated or isinstance(s, sp.Dummy) for s in {a} | e.free_symbols)
        }

    def blocks(self) -> list[tuple[list[Symbol], list[Expr]]]:
        """Parts without common variables: their solutions combine freely, so counts multiply."""
        parts: list[tuple[list[Symbol], list[Expr]]] = [([v], []) for v in self.variables]
        for polynomial in self.polynomials:
            touched = [part for part in parts if polynomial.has(*part[0])] or parts[:1]
            parts = [part for part in parts if part not in touched]
            variables = {v for part in touched for v in part[0]}
            equations = [p for part in touched for p in part[1]] + [polynomial]
            parts.append(([v for v in self.variables if v in variables], equations))
        return parts

    def _without_angles(self, e: Expr) -> Expr:
        """Write unknown angles by sine and cosine, known ones by the tangent of half the angle."""
        e = sp.expand_trig(e.rewrite([sp.tan, sp.cot, sp.sec, sp.csc], sp.cos))
        replaced = {f: self._algebraic(f) for f in sorted(e.atoms(sp.sin, sp.cos), key=str)}
        return e.xreplace(replaced)

    def _algebraic(self, f: Expr) -> Expr:
        angle = f.args[0]
        if not angle.is_Symbol:
            raise ValueError(
                f"{f}: each angle must be an integer multiple of one symbol; "
                f"make that angle a symbol"
            )
        if angle in self._unknowns:
            if angle not in self._circles:
                self._circles[angle] = (sp.Dummy(f"s_{angle}"), sp.Dummy(f"c_{angle}"))
            return self._circles[angle][isinstance(f, sp.cos)]
        half = Symbol(f"tan({angle}/2)")
        numerator = 1 - half**2 if isinstance(f, sp.cos) else 2 * half
        return numerator / (1 + half**2)


def _rank(pair: tuple[Symbol, Symbol], equations: Sequence[Expr]) -> tuple[int, str]:
    """Variables in the most equations come first: for a Puma arm 15 times faster than last."""
    return -sum(e.has(*pair) for e in equations), pair[0].name


def _absolute_angles(
    unknowns: Sequence[Symbol], equations: Sequence[Expr]
) -> tuple[list[Symbol], list[Expr], dict[Symbol, Expr]]:
    """New unknown angles, such as `theta1 + theta2` for `theta2`, if that lowers the degree.

    The change is invertible over the integers, so it keeps the number of solutions. It is chosen
    among the arguments of the sines and cosines, to minimise the sum of all multiples.
    """
    functions = {f for e in equations for f in e.atoms(*TRIGONOMETRIC)}
    terms = [sp.expand(f.args[0]).as_coefficients_dict() for f in functions]
    angles = [u for u in unknowns if any(u in t for t in terms)]
    if any(t[u] % 1 for t in terms for u in angles):
        raise ValueError("a fraction of an unknown angle occurs: use this fraction as the unknown")
    rows = {tuple(int(t[u]) for u in angles) for t in terms}
    units = {tuple(int(i == j) for j in range(len(angles))) for i in range(len(angles))}
    best, least = sp.eye(len(angles)), sum(abs(k) for row in rows for k in row)
    for choice in combinations(sorted(rows | units, reverse=True), len(angles)):
        change = sp.Matrix(choice)
        if abs(change.det()) == 1:
            inverse = change.inv()
            size = sum(abs(k) for row in rows for k in sp.Matrix([row]) * inverse)
            if size < least:
                best, least = inverse, size
    fresh = [sp.Dummy(f"angle{i}", real=True) for i in range(len(angles))]
    known = dict(zip(angles, best * sp.Matrix(fresh), strict=True)) if angles else {}
    rest = [u for u in unknowns if u not in angles]
    return fresh + rest, [e.xreplace(known) for e in equations], known


def _function_field(parameters: Sequence[Symbol]) -> Any:
    return QQ.frac_field(*parameters) if parameters else QQ


def _element(ring: PolyRing, e: Expr) -> PolyElement:
    try:
        polynomial = sp.Poly(e, *ring.symbols, domain=ring.domain)
    except (sp.PolynomialError, sp.CoercionFailed) as reason:
        raise NotRationalError(
            f"{e} is not rational: make each root an unknown, with an equation for its square"
        ) from reason
    element: PolyElement = ring.from_dict(polynomial.rep.to_dict())
    return element


def _standard_monomials(basis: Sequence[PolyElement], ring: PolyRing) -> list[Monomial]:
    """The monomials that no leading monomial divides; raises if there are infinitely many."""
    leading = [g.LM for g in basis]
    bounds = [
        min((m[i] for m in leading if not any(m[:i] + m[i + 1 :])), default=None)
        for i in range(ring.ngens)
    ]
    if None in bounds:
        free = ring.symbols[bounds.index(None)]
        raise InfinitelyManyError(
            f"the equations leave {free} free, so there are infinitely many solutions"
        )
    candidates = product(*(range(bound) for bound in bounds if bound is not None))
    return [m for m in candidates if not any(_divides(lead, m) for lead in leading)]


def _divides(a: Monomial, b: Monomial) -> bool:
    return all(i <= j for i, j in zip(a, b, strict=True))


def _are_distinct(basis: Sequence[PolyElement], monomials: Sequence[Monomial]) -> bool:
    """Whether the trace form of the quotient algebra over QQ is regular (Hermite).

    The entries of the form are polynomials in the coefficients of the basis. So a form that is
    regular at one specialisation is regular for generic parameters.
    """
    if not monomials:
        return True
    ring, size = basis[0].ring, len(monomials)
    table = [
        [_remainder(ring, basis, a, b) for b in monomials]  # products of basis elements
        for a in monomials
    ]
    traces = [sum(row[j].get(m, QQ(0)) for j, m in enumerate(monomials)) for row in table]
    form = [
        sum(value * traces[monomials.index(m)] for m, value in entry.items())
        for row in table
        for entry in row
    ]
    matrix = fmpq_mat(size, size, [fmpq(int(v.numerator), int(v.denominator)) for v in form])
    return matrix.det() != 0


def _remainder(
    ring: PolyRing, basis: Sequence[PolyElement], a: Monomial, b: Monomial
) -> PolyElement:
    product = ring.from_dict({tuple(i + j for i, j in zip(a, b, strict=True)): QQ(1)})
    remainder: PolyElement = product.rem(basis)
    return remainder


def _specialised(
    basis: Sequence[PolyElement], parameters: Sequence[Symbol], draw: random.Random
) -> list[PolyElement]:
    """A basis with numbers for its parameters, where no denominator vanishes."""
    if not parameters:
        return list(basis)
    ring = basis[0].ring.clone(domain=QQ)
    while True:
        point = [QQ(draw.randint(-99, 99), draw.randint(1, 20)) for _ in parameters]
        try:
            return [
                ring.from_dict({m: c.numer(*point) / c.denom(*point) for m, c in g.terms()})
                for g in (g.monic() for g in basis)
            ]
        except ZeroDivisionError:
            continue


def _count_at_a_point(system: _System, draw: random.Random) -> int | None:
    """The number of solutions for random parameters, by SymPy: another route to a certificate."""
    point, total = {p: _random_rational(draw) for p in system.parameters}, 1
    for variables, polynomials in system.blocks():
        ring = PolyRing(variables, QQ, grevlex)
        try:
            basis = groebner([_element(ring, p.subs(point)) for p in polynomials], ring)
            total *= len(_standard_monomials(basis, ring))
        except (InfinitelyManyError, NotRationalError):
            return None
    return total


def _certified_at_a_point(
    certified: Counted, draw: random.Random
) -> tuple[list[PolyElement], list[Monomial]]:
    """A certified basis with numbers for its parameters, where no leading coefficient vanishes.

    There it is a basis too.  The second result are the monomials that no leading one divides.
    """
    field = certified.field
    last = len(field.kinds) - 1
    unknown = [last - i for i in reversed(field.unknowns)]  # the checker counts from the least one
    ring = PolyRing([f"x{k}" for k in range(len(unknown))], QQ, grevlex)
    leads = [field.leading(p)[0][::-1] for p in certified.basis]
    while True:
        point = [QQ(draw.randint(-99, 99), draw.randint(1, 20)) for _ in field.kinds]
        basis = []
        for p in certified.basis:
            terms: dict[Monomial, Any] = {}
            for powers, a in p.terms():
                value = QQ(int(a.p), int(a.q))
                for j, n in enumerate(powers):
                    value *= point[j] ** int(n) if n and j not in unknown else 1
                monomial = tuple([int(powers[j]) for j in unknown])
                terms[monomial] = terms.get(monomial, QQ(0)) + value
            basis.append(ring.from_dict(terms))
        if all(g != 0 and lead == g.LM for g, lead in zip(basis, leads, strict=True)):
            return basis, _standard_monomials(basis, ring)


def _random_rational(draw: random.Random) -> Expr:
    return Rational(draw.choice([-1, 1]) * draw.randint(1, 99), draw.randint(1, 20))
