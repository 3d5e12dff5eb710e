"""The exact normal form of kinematic expressions.

An expression becomes a fraction of polynomials over the rationals in one ring, the `Tower`:

- a symbol (and `pi`) is a generator;
- an angle is a pair of generators `s, c` with `s**2 = 1 - c**2`; the pair belongs to the angle
  divided by the common denominator of its multiples in the whole problem, so that `theta/2` works;
- a square root is a generator `w` with `w**2 = radicand`, one for each irreducible factor of known
  sign; a modulus of unknown sign is a generator `a` with `a**2 = f**2`;
- sine and cosine of `atan2`, `acos`, `asin`, `atan` are algebraic in their arguments.

In the lexicographic order, each generator is larger than all others in its relation. So the
relations are a Groebner basis, and division by them, newest first, gives the normal form. A normal
form of zero is a proof if the recorded denominators do not vanish. The converse fails only if two
generators have a relation that the tower does not know. Then a counterexample must be found, as
`closedform.algebra.normal_form.decide` does.

All symbols and all square roots are real: points with a negative radicand are outside the domain
of the identity.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import reduce
from math import gcd, lcm
from typing import NamedTuple

import sympy as sp
from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx, fmpz
from sympy import Rational
from sympy.core.function import AppliedUndef

from closedform.algebra.expressions import (
    QUOTIENTS,
    TRIGONOMETRIC,
    Expr,
    Problem,
    angle_divisors,
    angle_terms,
    entries_of,
    margin_of,
    shortened,
    sign_of,
    subexpressions,
)
from closedform.algebra.integers import long_factors, smooth_factors
from closedform.algebra.trace import Factors, Trace

_INVERSE = (sp.atan2, sp.acos, sp.asin, sp.atan)
_OPAQUE = (sp.Symbol, sp.NumberSymbol, AppliedUndef, sp.Derivative, *_INVERSE)


class Undecided(ValueError):  # noqa: N818
    """The normal form cannot prove or cannot express the claim; the message says what to do."""


class Fraction(NamedTuple):
    """An element of the tower; both polynomials are reduced."""

    num: fmpq_mpoly
    den: fmpq_mpoly


class Rotation(NamedTuple):
    """Cosine and sine of an angle."""

    cos: Fraction
    sin: Fraction


class _Full(Exception):  # noqa: N818
    """The ring has too few generators."""


class Tower:
    """The ring of one problem; conversions are remembered for each sub-expression."""

    def __init__(self, problem: Sequence[Expr], nonnegative: Sequence[Expr], size: int) -> None:
        self._ctx = fmpq_mpoly_ctx.get([f"g{i}" for i in range(size)], Ordering.lex)
        self._gens = self._ctx.gens()
        self._unused = size  # slots are handed out from the last, so newer ones are larger
        self._meaning: dict[int, Expr] = {}
        self._sign: dict[int, int] = {}
        self._relations: dict[int, fmpq_mpoly] = {}
        self._pairs: dict[int, int] = {}  # slot of the sine -> slot of the cosine
        self._memo: dict[Expr, Fraction] = {}
        self._roots: dict[Expr, Fraction] = {}
        self._rotations: dict[Expr, Rotation] = {}
        self._long: list[fmpz] = []
        self._licences: dict[frozenset[str], tuple[int, Expr]] = {}
        self._denominators: dict[str, fmpq_mpoly] = {}
        self.assumptions: dict[Expr, None] = {}
        self.trace = Trace()
        self.peak = 0
        self.zero, self.one = self._constant(0), self._constant(1)
        self._divisor = angle_divisors([*problem, *nonnegative])
        for guard in nonnegative:
            self._license(guard)

    def convert(self, e: Expr) -> Fraction:
        """The normal form of an expression."""
        known = self._memo.get(e)
        if known is None:
            known = self._memo[e] = self._convert(e)
        return known

    def _convert(self, e: Expr) -> Fraction:
        if e.is_Rational:
            return self._constant(fmpq(e.p, e.q))
        if e.is_Add:
            return reduce(self._add, map(self.convert, e.args))
        if e.is_Mul:
            return self._product([self.convert(a) for a in e.args])
        if e.is_Pow:
            return self._pow(e)
        if isinstance(e, sp.sin | sp.cos):
            rotation = self._rotation(e.args[0])
            return rotation.sin if isinstance(e, sp.sin) else rotation.cos
        if isinstance(e, TRIGONOMETRIC):
            return self.convert(QUOTIENTS[e.func](e.args[0]))
        if isinstance(e, sp.Abs):
            x = self.convert(e.args[0])
            return self._sqrt(self._mul(x, x), e)
        if isinstance(e, _OPAQUE):
            self.trace.steps.append(("name", e))
            return self._polynomial(self._generator(e, sign_of(e)))
        raise Undecided(
            f"{shortened(e)} has no algebraic normal form ({type(e).__name__}); "
            "state the case (its sign, its branch) as an assumption and treat each case separately"
        )

    # Arithmetic of fractions

    def _constant(self, value: int | fmpq) -> Fraction:
        return Fraction(self._ctx.constant(value), self._ctx.constant(1))

    def _polynomial(self, p: fmpq_mpoly) -> Fraction:
        return Fraction(p, self.one.den)

    def _reduced(self, p: fmpq_mpoly) -> fmpq_mpoly:
        """Remainder modulo the relations; the newest, which is the largest, is stored last."""
        self.peak = max(self.peak, len(p))
        degrees = p.degrees()
        for slot in reversed(self._relations):
            if degrees[slot] > 1:
                p = divmod(p, self._relations[slot])[1]
                degrees = p.degrees()
        return p

    def _cancelled(self, num: fmpq_mpoly, den: fmpq_mpoly) -> Fraction:
        num, den = self._reduced(num), self._reduced(den)
        if den.is_zero():
            raise Undecided("a denominator is identically zero: the expression is undefined")
        if not den.is_constant():
            common = num.gcd(den)
            num, den = num / common, den / common
        if den.is_constant():
            return Fraction(num / den.leading_coefficient(), self.one.den)
        return Fraction(num, den)

    def _add(self, a: Fraction, b: Fraction) -> Fraction:
        if a.den.is_one() and b.den.is_one():
            return Fraction(a.num + b.num, a.den)
        if a.den == b.den:
            return self._cancelled(a.num + b.num, a.den)
        common = a.den.gcd(b.den)
        left, right = a.den / common, b.den / common
        return self._cancelled(a.num * right + b.num * left, a.den * right)

    def _mul(self, a: Fraction, b: Fraction) -> Fraction:
        if a.den.is_one() and b.den.is_one():
            return Fraction(self._reduced(a.num * b.num), a.den)
        return self._cancelled(a.num * b.num, a.den * b.den)

    def _product(self, factors: Sequence[Fraction]) -> Fraction:
        """A product; single terms are multiplied first, and reduced once."""
        terms, others = self.one.num, []
        for a in factors:
            if a.den.is_one() and len(a.num) == 1:
                terms *= a.num
            else:
                others.append(a)
        return reduce(self._mul, others, Fraction(self._reduced(terms), self.one.den))

    def _inverse(self, a: Fraction) -> Fraction:
        """1/a; a root that divides the denominator moves to the numerator: `1/w = w/radicand`."""
        num, den = a.den, a.num
        if not den.is_constant():
            self._denominators.setdefault(str(den), den)
        powers = [min(column) for column in zip(*den.monoms(), strict=True)]
        for slot in self._relations:
            if powers and powers[slot] and slot not in self._pairs:
                num, den = num * self._gens[slot], den * self._gens[slot]
        return self._cancelled(num, den)

    def _power(self, a: Fraction, n: int) -> Fraction:
        if n < 0:
            return self._inverse(self._power(a, -n))
        if n == 0:
            return self.one
        half = self._power(a, n // 2)
        square = self._mul(half, half)
        return self._mul(square, a) if n % 2 else square

    def _pow(self, e: Expr) -> Fraction:
        base, exponent = e.args
        if exponent.is_Integer:
            return self._power(self.convert(base), int(exponent))
        if exponent.is_Rational and exponent.q == 2:
            return self._power(self._root_of(base), int(exponent.p))
        raise Undecided(f"{e} is neither an integer power nor a square root: rewrite it as such")

    def sum(self, a: Fraction, b: Fraction) -> Fraction:
        return self._add(a, b)

    def product(self, a: Fraction, b: Fraction, factor: int = 1) -> Fraction:
        return self._mul(self._mul(a, b), self._constant(factor))

    # Generators

    def _generator(self, meaning: Expr, sign: int) -> fmpq_mpoly:
        if self._unused == 0:
            raise _Full
        self._unused -= 1
        self._meaning[self._unused], self._sign[self._unused] = meaning, sign
        return self._gens[self._unused]

    def _quadratic(self, meaning: Expr, square: fmpq_mpoly, sign: int) -> fmpq_mpoly:
        generator = self._generator(meaning, sign)
        self._relations[self._unused] = generator * generator - square
        return generator

    # Angles

    def _rotation(self, angle: Expr) -> Rotation:
        known = self._rotations.get(angle)
        if known is None:
            terms = [self._multiple(atom, q) for atom, q in angle_terms(angle).items()]
            known = reduce(self._compose, terms) if terms else Rotation(self.one, self.zero)
            self._rotations[angle] = known
        return known

    def _compose(self, a: Rotation, b: Rotation) -> Rotation:
        """The addition theorem."""
        mul, add = self._mul, self._add
        return Rotation(
            add(mul(a.cos, b.cos), _negative(mul(a.sin, b.sin))),
            add(mul(a.sin, b.cos), mul(a.cos, b.sin)),
        )

    def _turned(self, a: Rotation, n: int) -> Rotation:
        if n < 0:
            return self._turned(Rotation(a.cos, _negative(a.sin)), -n)
        return reduce(self._compose, [a] * n) if n else Rotation(self.one, self.zero)

    def _multiple(self, atom: Expr, q: Rational) -> Rotation:
        if atom == sp.pi:
            return self._constant_rotation(q)
        if isinstance(atom, _INVERSE):
            return self._inverse_rotation(atom, q)
        base = atom / self._divisor[atom]
        if base not in self._rotations:
            self.trace.steps.append(("angle", atom, self._divisor[atom]))
            c = self._generator(sp.cos(base), 0)
            cosine = self._unused
            s = self._quadratic(sp.sin(base), 1 - c * c, 0)
            self._pairs[self._unused] = cosine
            self._rotations[base] = Rotation(self._polynomial(c), self._polynomial(s))
        return self._turned(self._rotations[base], int(q * self._divisor[atom]))

    def _constant_rotation(self, q: Rational) -> Rotation:
        self.trace.unwritable = "identities with a part of pi in an angle"
        c, s = sp.cos(q * sp.pi), sp.sin(q * sp.pi)
        if c.has(*TRIGONOMETRIC) or s.has(*TRIGONOMETRIC):
            raise Undecided(f"cos({q}*pi) has no known square-root form")
        return Rotation(self.convert(c), self.convert(s))

    def _inverse_rotation(self, atom: Expr, q: Rational) -> Rotation:
        """cos and sin of `q` times an inverse function; an even multiple needs no root."""
        direction, unit = self._direction(atom)
        n, halvings = int(q.p), int(q.q).bit_length() - 1
        if q.q != 1 << halvings:
            raise Undecided(
                f"{q} times {atom}: an inverse function can be halved, "
                f"but not divided by another number"
            )
        norm = self._add(
            self._mul(direction.cos, direction.cos), self._mul(direction.sin, direction.sin)
        )
        if n % 2 == 0:
            double = self._compose(direction, direction)
            return self._turned(double if unit else self._scaled(double, norm), n // 2)
        principal = direction if unit else self._scaled(direction, self._sqrt(norm, atom))
        for _ in range(halvings):
            principal = self._halved(principal)
        return self._turned(principal, n)

    def _scaled(self, a: Rotation, norm: Fraction) -> Rotation:
        factor = self._inverse(norm)
        return Rotation(self._mul(a.cos, factor), self._mul(a.sin, factor))

    def _halved(self, a: Rotation) -> Rotation:
        """Half of an angle in (-pi, pi); its cosine is therefore positive."""
        self.trace.unwritable = "identities with half the value of an inverse function"
        half = self._constant(fmpq(1, 2))
        c = self._sqrt(self._mul(self._add(self.one, a.cos), half), None)
        return Rotation(c, self._mul(self._mul(a.sin, half), self._inverse(c)))

    def _direction(self, atom: Expr) -> tuple[Rotation, bool]:
        """A vector along the value of an inverse function, and whether it is a unit vector."""
        x = self.convert(atom.args[0])
        if isinstance(atom, sp.atan2):
            return Rotation(self.convert(atom.args[1]), x), False
        if isinstance(atom, sp.atan):
            return Rotation(self.one, x), False
        other = self._root_of(1 - atom.args[0] ** 2)
        self.trace.steps.append(("value", atom, []))  # the length of the vector is 1
        return (Rotation(x, other) if isinstance(atom, sp.acos) else Rotation(other, x)), True

    # Square roots

    def _root_of(self, e: Expr) -> Fraction:
        return self._sqrt(self.convert(e), sp.Pow(e, sp.S.Half, evaluate=False))

    def _sqrt(self, a: Fraction, e: Expr) -> Fraction:
        """The square root of a fraction, as a product.

        Square factors leave the root, each factor of known sign gets a root of its own, and the
        rest one together.  ``e`` is the expression that has this root, for the trace.
        """
        if a.num.is_zero():
            self.trace.steps.append(("value", e, [(a.num, 1)]))
            return self.zero
        constant, powers = self._factored(a)
        outside: Factors = [(f, power - power % 2) for f, power in powers if power // 2]
        parts, rest = list[tuple[Fraction, int]](), dict[str, fmpq_mpoly]()
        for f, power in powers:
            half, odd = divmod(power, 2)
            sign = self._known_sign(f)
            positive = f * sign if sign else f
            constant *= sign if sign and odd else 1
            plain = sign or half % 2 == 0
            modulus = self._polynomial(positive) if plain else self._modulus(f)
            parts.append((modulus, half))
            if odd and sign:
                outside.append((positive, 1))
                parts.append((self._root(positive), 1))
            elif odd:
                rest[str(f)] = f
        for group, sign in self._licensed_groups(rest):
            constant *= sign
            outside.append((group * sign, 1))
            parts.append((self._root(group * sign), 1))
        remaining = reduce(lambda p, f: p * f, rest.values(), self.one.num)
        if not rest and constant < 0:
            raise Undecided("a square root of a negative quantity: the expression is not real")
        if rest:
            remaining = remaining if constant > 0 else -remaining
            outside.append((self._ctx.constant(abs(constant)), 1))
            self.trace.steps.append(("known", e, remaining, outside))
            parts.append((self._root(remaining), 1))
        parts += self._rational_root(abs(constant))
        factors = [(part.num, power) for part, power in parts if power]
        self.trace.steps.append(("value", e, factors))
        return reduce(self._mul, (self._power(part, power) for part, power in parts))

    def _rational_root(self, value: fmpq) -> Iterator[tuple[Fraction, int]]:
        yield self._constant(fmpq(1, value.q)), 1
        small, number = smooth_factors(value.p * value.q)
        for prime, power in small:
            yield from self._number_root(prime, power)
        for known in self._long:
            power = 0
            while number % known == 0:
                number, power = number // known, power + 1
            yield from self._number_root(known, power)
        if number.is_square():
            yield self._constant(int(number.isqrt())), 1
        else:
            yield from self._long_root(number)

    def _number_root(self, number: fmpz, power: int) -> Iterator[tuple[Fraction, int]]:
        yield self._constant(int(number) ** (power // 2)), 1
        if power % 2:
            yield self._root(self._ctx.constant(number)), 1

    def _long_root(self, number: fmpz) -> Iterator[tuple[Fraction, int]]:
        """The root of a number without known factors; no such root is a multiple of another."""
        known = next((n for n in self._long if (n * number).is_square()), None)
        if known is not None:
            yield self._constant(fmpq((known * number).isqrt(), known)), 1
            yield self._root(self._ctx.constant(known)), 1
            return
        for factor, power in long_factors(number):
            self._long.append(factor)
            yield from self._number_root(factor, power)

    def _root(self, radicand: fmpq_mpoly) -> Fraction:
        meaning = sp.sqrt(self.expression(radicand))
        return self._nonnegative(meaning, radicand, ("root", radicand, 1))

    def _modulus(self, f: fmpq_mpoly) -> Fraction:
        return self._nonnegative(sp.Abs(self.expression(f)), f * f, ("root", f, 2))

    def _nonnegative(
        self, meaning: Expr, square: fmpq_mpoly, declared: tuple[str, fmpq_mpoly, int]
    ) -> Fraction:
        if meaning not in self._roots:
            self.trace.steps.append(declared)
            root = self._quadratic(meaning, self._reduced(square), 1)
            self._roots[meaning] = self._polynomial(root)
        return self._roots[meaning]

    def _factored(self, a: Fraction) -> tuple[fmpq, list[tuple[fmpq_mpoly, int]]]:
        """The constant and the primitive irreducible factors of a fraction."""
        constant, powers, factors = fmpq(1), dict[str, int](), dict[str, fmpq_mpoly]()
        for p, direction in ((a.num, 1), (a.den, -1)):
            for f, power in self._irreducible(p):
                scale = content(f)
                constant *= scale ** (direction * power)
                if not f.is_constant():
                    f = f / scale
                    factors[str(f)] = f
                    powers[str(f)] = powers.get(str(f), 0) + direction * power
        return constant, [(factors[key], power) for key, power in powers.items() if power]

    def _irreducible(self, p: fmpq_mpoly) -> Iterator[tuple[fmpq_mpoly, int]]:
        """Factors over the tangents of half angles, in which `1 - c**2` is a square.

        Factors are unique in the ring with `t = s/(1 + c)`, but not in that with `s, c`. A factor
        is returned in `s, c`, multiplied by the power of `1 + c` that makes it a polynomial.
        """
        degrees = p.degrees()
        pairs = [(s, c) for s, c in self._pairs.items() if degrees[s] or degrees[c]]
        for s, c in pairs:
            p, degree = self._to_tangent(p, s, c)
            yield (1 + self._gens[c]) / self._ctx.constant(2), degree
        constant, factors = p.factor()
        yield self._ctx.constant(constant), 1
        for f, power in factors:
            for s, c in pairs:
                f, degree = self._from_tangent(f, s, c)
                yield 1 + self._gens[c], -power * degree
            yield f, power

    def _to_tangent(self, p: fmpq_mpoly, s: int, c: int) -> tuple[fmpq_mpoly, int]:
        """`(1 + t**2)**d * p` with `t` instead of `s`, and the degree `d`."""
        t = self._gens[s]
        degree = max(m[s] + m[c] for m in p.monoms())
        terms = (
            self._without(m, a, s, c)
            * (2 * t) ** m[s]
            * (1 - t * t) ** m[c]
            * (1 + t * t) ** (degree - m[s] - m[c])
            for m, a in p.terms()
        )
        return sum(terms, self.zero.num), degree

    def _from_tangent(self, f: fmpq_mpoly, s: int, c: int) -> tuple[fmpq_mpoly, int]:
        """`(1 + c)**d * f(s/(1 + c))` and the degree `d`."""
        cosine = self._gens[c]
        degree = (f.degrees()[s] + 1) // 2
        terms = (
            self._without(m, a, s, c)
            * self._gens[s] ** (m[s] % 2)
            * (1 - cosine) ** (m[s] // 2)
            * (1 + cosine) ** (degree - (m[s] + 1) // 2)
            for m, a in f.terms()
        )
        return sum(terms, self.zero.num), degree

    def _without(self, monomial: tuple[int, ...], a: fmpq, s: int, c: int) -> fmpq_mpoly:
        exponents = [0 if i in (s, c) else k for i, k in enumerate(monomial)]
        return self._ctx.term(coeff=a, exp_vec=exponents)

    # Signs

    def _known_sign(self, f: fmpq_mpoly) -> int:
        """Sign of a factor, from its form or from an assumption, which is then recorded."""
        sign = self._evident_sign(f)
        if not sign and (licence := self._licences.get(frozenset([str(f)]))):
            sign, guard = licence
            self.assumptions[guard] = None
        return sign

    def _evident_sign(self, f: fmpq_mpoly) -> int:
        """Sign of a sum of terms of one sign; sines and cosines are at most 1."""
        signs, constant, slack = set[int](), fmpq(0), fmpq(0)
        for monomial, a in f.terms():
            used = [slot for slot, power in enumerate(monomial) if power]
            odd = [self._sign[slot] for slot in used if monomial[slot] % 2]
            if not used:
                constant = a
            elif all(odd):
                signs.add((-1) ** (odd.count(-1) + (a < 0)))
            elif all(slot in self._pairs or slot in self._pairs.values() for slot in used):
                slack += abs(a)
            else:
                return 0
        if abs(constant) < slack:
            return 0
        if constant:
            signs.add(1 if constant > 0 else -1)
        return signs.pop() if len(signs) == 1 else 0

    def _license(self, guard: Expr) -> None:
        before = len(self.trace.steps)
        value = self.convert(guard)
        self.trace.guards[guard] = any(s[0] == "value" for s in self.trace.steps[before:])
        if value.num.is_zero():
            return
        constant, powers = self._factored(value)
        sign, unknown = 1 if constant > 0 else -1, dict[str, fmpq_mpoly]()
        outside: Factors = [(self._ctx.constant(abs(constant)), 1)]
        for f, power in powers:
            outside += [(f, power - power % 2)] if power // 2 else []
            if power % 2 and (known := self._evident_sign(f)):
                sign *= known
                outside.append((f * known, 1))
            elif power % 2:
                unknown[str(f)] = f
        if unknown:
            self._licences[frozenset(unknown)] = (sign, guard)
            product = reduce(lambda p, key: p * unknown[key], sorted(unknown), self.one.num)
            self.trace.steps.append(("known", guard, product * sign, outside))

    def _licensed_groups(self, rest: dict[str, fmpq_mpoly]) -> Iterator[tuple[fmpq_mpoly, int]]:
        for keys, (sign, guard) in self._licences.items():
            if keys <= rest.keys():
                self.assumptions[guard] = None
                yield reduce(lambda p, key: p * rest.pop(key), sorted(keys), self.one.num), sign

    # Back to SymPy

    def expression(self, p: fmpq_mpoly) -> Expr:
        """A polynomial of the tower as a SymPy expression."""
        return sp.Add(
            *(
                sp.Mul(
                    Rational(int(a.p), int(a.q)),
                    *(self._meaning[i] ** k for i, k in enumerate(monomial) if k),
                )
                for monomial, a in p.terms()
            )
        )

    def rationalised(self, a: Fraction) -> Fraction:
        """The same value without roots and sines in the denominator."""
        num, den = a
        for slot in reversed(self._relations):
            if den.degrees()[slot]:
                conjugate = den.compose(*self._flipped(slot), ctx=self._ctx)
                num, den = self._cancelled(num * conjugate, den * conjugate)
        return self._cancelled(num, den)

    def _flipped(self, slot: int) -> list[fmpq_mpoly]:
        return [-g if i == slot else g for i, g in enumerate(self._gens)]

    def inverted(self) -> list[fmpq_mpoly]:
        """The irreducible factors of all denominators."""
        factors: dict[str, fmpq_mpoly] = {}
        for den in self._denominators.values():
            factors |= {str(f): f for f, _ in den.factor()[1]}
        return list(factors.values())

    def denominators(self) -> tuple[Expr, ...]:
        """The irreducible expressions that are assumed not to vanish."""
        factored = map(self.expression, self.inverted())
        return tuple(f for f in factored if f.free_symbols and not f.is_positive)


def converted(problem: Problem, nonnegative: Iterable[Expr]) -> tuple[Tower, list[Fraction]]:
    entries, guards = entries_of(problem), [margin_of(g) for g in nonnegative]
    parts = subexpressions([*entries, *guards])
    roots = sum(isinstance(e, (sp.Pow, sp.Abs, *_INVERSE)) for e in parts)
    size = 4 + roots + 2 * sum(isinstance(e, _OPAQUE) for e in parts)
    while True:
        tower = Tower(entries, guards, size)
        try:
            return tower, [tower.convert(e) for e in entries]
        except _Full:
            size *= 2


def _negative(a: Fraction) -> Fraction:
    return Fraction(-a.num, a.den)


def content(p: fmpq_mpoly) -> fmpq:
    """The rational factor; without it the coefficients are coprime integers, the first positive."""
    coefficients = p.coeffs()
    numerator = gcd(*(int(a.p) for a in coefficients))
    denominator = lcm(*(int(a.q) for a in coefficients))
    return fmpq(numerator if coefficients[0] > 0 else -numerator, denominator)
