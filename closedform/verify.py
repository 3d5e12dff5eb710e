"""Checks the certificates of proofs, independently of the prover that wrote them.

Every polynomial is computed here from the expressions of a certificate.  The certificate only helps
with what is hard to find and easy to check: the value of a root, a combination of polynomials.
docs/certificates.md describes the format.  This module imports nothing of closedform.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import reduce
from itertools import combinations, product
from math import prod
from typing import Any, TypeAlias

from flint import Ordering, arb, arb_mat, ctx, fmpq, fmpq_mpoly_ctx, fmpz_mat

FORMAT = 3
PAIRS = ("angle", "circle")
ROOTS = ("root", "abs")

Polynomial: TypeAlias = Any  # fmpq_mpoly, whose annotations are partial
Monomial: TypeAlias = "tuple[int, ...]"
Lead: TypeAlias = "tuple[Monomial, Polynomial, Polynomial]"
Rotation: TypeAlias = "tuple[Fraction, Fraction]"  # the cosine and the sine of an angle


class Refused(ValueError):  # noqa: N818
    """A certificate that does not prove what it states."""


def require(condition: Any, fault: str) -> None:
    if not condition:
        raise Refused(fault)


def check(document: dict[str, Any]) -> None:
    """Check all certificates of a mechanism; raise :class:`Refused` for the first bad one."""
    require(document["format"] == FORMAT, "the format is unknown")
    nodes = document["nodes"]
    names = [node[1:] for node in nodes if node[0] == "name"]
    require(len(names) == len({name for name, _ in names}), "a name has two meanings")
    require(all(sign in (-1, 0, 1) for _, sign in names), "a name has an unknown sign")
    for k, node in enumerate(nodes):
        require(all(a in range(k) for a in operands(node)), "a node holds later ones")
    kinds = {
        "identity": check_identity,
        "count": check_count,
        "inverse": check_inverse,
        "point": check_point,
    }
    for k, certificate in enumerate(document["certificates"]):
        try:
            kinds[certificate["kind"]](document, certificate)
        except Exception as error:  # whatever goes wrong, nothing is proved
            raise Refused(f"certificate {k} ({certificate['of']}): {error!r}") from error


def operands(node: list[Any]) -> list[int]:
    op, *args = node
    return args[: {"number": 0, "name": 0, "^": 1}.get(op)]


def check_identity(document: dict[str, Any], certificate: dict[str, Any]) -> None:
    """The listed expressions vanish wherever they are real and no denominator vanishes."""
    field = Field(document["nodes"], certificate["generators"], ("name", *ROOTS, "angle"))
    field.roots = [field.root_of(factors) for factors in certificate["roots"]]
    for node, constant, factors in certificate["assumed"]:
        field.assume(node, field.number(constant), field.factors(factors))
    require(certificate["zero"], "nothing is stated")
    for node in certificate["zero"]:
        require(field.value(node).num == 0, f"node {node} does not vanish")
    listed = [field.polynomial(p) for p in certificate["nonzero"]]
    for p in field.inverted:
        for f in (f for f in listed if not f.is_constant()):
            while (division := divmod(p, f))[1] == 0:
                p = division[0]
        require(field.is_number(p), "a denominator is not listed")


def check_inverse(document: dict[str, Any], certificate: dict[str, Any]) -> None:
    """The counts of the steps of an inverse multiply to the number of its branches."""
    counts = [(document["certificates"][k], less) for k, less in certificate["counts"]]
    require(all(c["kind"] == "count" for c, _ in counts), "this is not a count")
    total = prod(c["count"] - less for c, less in counts)
    branches = certificate["branches"] * certificate["per branch"]
    require(counts and total == branches > 0, f"{total} solutions are counted")


def check_point(document: dict[str, Any], certificate: dict[str, Any]) -> None:
    """At a point, the determinant of a matrix is not zero; for one entry, the entry is not."""
    with ctx.workprec(300):
        rows = matrix_of(document["nodes"], certificate)
        require(rows and not arb_mat(rows).det().contains(0), "the determinant may be zero")


def matrix_of(nodes: list[Any], certificate: dict[str, Any]) -> list[list[arb]]:
    """Enclosures of the entries of a matrix at a point at which all assumptions hold."""
    balls: dict[int, arb] = {}
    for name, k in certificate["at"]:
        named = nodes[name][0] == "name" and name not in balls
        require(named, "only a name has a value, and only one")
        balls[name] = enclosed(nodes, balls, k)
        require(balls[name] * nodes[name][2] >= 0, "the point is not in the domain")
    for k in certificate["assumed"]:
        require(enclosed(nodes, balls, k) >= 0, "an assumption does not hold at the point")
    return [[enclosed(nodes, balls, k) for k in row] for row in certificate["matrix"]]


def enclosed(nodes: list[Any], balls: dict[int, arb], k: int) -> arb:
    """A ball that contains the value of a node; ``balls`` has those of names, and remembers."""
    if k not in balls:
        op, *args = nodes[k]
        x = [enclosed(nodes, balls, a) for a in operands(nodes[k])]
        require(op != "atan2" or not all(v.contains(0) for v in x), "there is no direction")
        if op == "number":
            balls[k] = arb(fmpq(args[0]))
        elif op in ("+", "*"):
            balls[k] = sum(x, arb(0)) if op == "+" else prod(x, start=arb(1))
        elif op in ("^", "abs"):
            balls[k] = x[0] ** args[1] if op == "^" else abs(x[0])
        else:
            require(op in ("pi", "sqrt", "sin", "cos", "atan2"), f"{op} has no value")
            balls[k] = getattr(arb, op)(*x)
        require(balls[k].is_finite(), "a value is not defined")
    return balls[k]


def check_count(document: dict[str, Any], certificate: dict[str, Any]) -> None:
    """A system has so many solutions, with multiplicity, for generic parameters."""
    field, system = system_of(document["nodes"], certificate)
    elements = list(system)
    for multiplier, element, combination in certificate["steps"]:
        m, p = field.polynomial(multiplier), field.polynomial(element)
        require(m != 0 and not any(field.leading(m)[0]), "a multiplier is zero or has an unknown")
        total = sum((field.polynomial(q) * elements[i] for i, q in combination), 0 * m)
        require(m * p == total, "an element of the basis is not in the ideal")
        elements.append(p)
    basis = [(*field.leading(p), p) for p in (elements[i] for i in certificate["basis"])]
    count = staircase([lead for lead, _, _ in basis], len(field.unknowns))
    require(count == certificate["count"], f"the basis leaves {count} monomials")
    pairs = [(f, g) for f, g in combinations(basis, 2) if any(map(min, f[0], g[0]))]
    for p in [*system, *(s_polynomial(field, f, g) for f, g in pairs)]:
        require(remainder(field, p, basis) == 0, "it is not a Groebner basis of the system")


def system_of(nodes: list[Any], certificate: dict[str, Any]) -> tuple[Field, list[Polynomial]]:
    """The polynomials of a system, with the relations of the cosines and sines of its angles."""
    field = Field(nodes, certificate["generators"], ("name", "unknown", "circle"))
    angles, circles = certificate["angles"], [turn for _, turn in field.turns.values()]
    named = [k for k, *_ in (*field.values.items(), *angles, *certificate["given"])]
    require(all(nodes[k][0] == "name" for k in named), "only a name can be given a value")
    require(len(named) == len(set(named)), "a name has two values")
    rows = [row for _, row in angles]
    require(not rows or abs(fmpz_mat(rows).det()) == 1, "the change of angles is not invertible")
    require(len(rows) == len(circles), "an angle is not used")
    for k, row in angles:
        field.turns[k] = 1, reduce(turned, map(times, circles, row))
    field.given = dict(certificate["given"])
    system = [field.value(k).num for k in certificate["equations"]]
    leads = [field.leading(p)[0] for p in field.inverted]
    require(not any(map(any, leads)), "a denominator has an unknown")
    return field, [p for p in (*system, *field.relations.values()) if p != 0]


def staircase(leads: list[Monomial], size: int) -> int | None:
    """The number of monomials that none of these divides; None if there are infinitely many."""
    bounds = [[m[i] for m in leads if sum(m) == m[i]] for i in range(size)]
    if not all(bounds):
        return None
    candidates = product(*(range(min(powers)) for powers in bounds))
    return sum(not any(divides(lead, m) for lead in leads) for m in candidates)


def divides(a: Monomial, b: Monomial) -> bool:
    return all(i <= j for i, j in zip(a, b, strict=True))


def s_polynomial(field: Field, f: Lead, g: Lead) -> Polynomial:
    common = tuple(map(max, f[0], g[0]))
    return shifted(field, f, common) * g[1] - shifted(field, g, common) * f[1]


def shifted(field: Field, f: Lead, to: Monomial) -> Polynomial:
    """A multiple of a polynomial whose leading monomial is this one."""
    powers = zip(field.unknowns, to, f[0], strict=True)
    return prod((field.generators[i] ** (m - n) for i, m, n in powers), start=f[2])


def remainder(field: Field, p: Polynomial, basis: list[Lead]) -> Polynomial:
    """What is left of a polynomial when no leading monomial of the basis divides its own."""
    while p != 0:
        lead, coefficient = field.leading(p)
        divisor = next((f for f in basis if divides(f[0], lead)), None)
        if divisor is None:
            break
        common = divisor[1].gcd(coefficient)
        p = p * (divisor[1] / common) - shifted(field, divisor, lead) * (coefficient / common)
    return p


class Fraction:
    """A fraction of polynomials in the generators of a field, reduced by its relations."""

    def __init__(self, field: Field, num: Polynomial, den: Polynomial):
        num, den = field.reduced(num), field.reduced(den)
        require(den != 0, "a denominator is identically zero")
        common = num.gcd(den) * den.leading_coefficient()
        self.field, self.num, self.den = field, num / common, den / common

    def __add__(self, other: Fraction) -> Fraction:
        common = self.den.gcd(other.den)
        left, right = self.den / common, other.den / common
        return Fraction(self.field, self.num * right + other.num * left, self.den * right)

    def __mul__(self, other: Fraction) -> Fraction:
        return Fraction(self.field, self.num * other.num, self.den * other.den)

    def __pow__(self, n: int) -> Fraction:
        base = self if n >= 0 else self.field.inverse(self)
        return reduce(Fraction.__mul__, [base] * abs(n), self.field.number(1))

    def __neg__(self) -> Fraction:
        return Fraction(self.field, -self.num, self.den)

    def __eq__(self, other: object) -> bool:
        assert isinstance(other, Fraction)
        return bool(self.field.reduced(self.num * other.den - other.num * self.den) == 0)


def turned(a: Rotation, b: Rotation) -> Rotation:
    return a[0] * b[0] + -(a[1] * b[1]), a[1] * b[0] + a[0] * b[1]


def times(turn: Rotation, n: int) -> Rotation:
    one = turn[0].field.number(1)
    return reduce(turned, [turn if n > 0 else (turn[0], -turn[1])] * abs(n), (one, one + -one))


class Field:
    """The generators of a certificate and their relations, each monic in a generator of its own."""

    def __init__(self, nodes: list[Any], generators: list[Any], allowed: Iterable[str]):
        self.nodes = nodes
        self.kinds = [g[0] for g in generators for _ in range(2 if g[0] in PAIRS else 1)]
        require(set(self.kinds) <= set(allowed), "a generator has the wrong kind")
        names = [f"g{i}" for i in reversed(range(len(self.kinds)))]
        self.context = fmpq_mpoly_ctx.get(names, Ordering.lex)  # a later generator is larger
        self.generators = self.context.gens()[::-1]
        self.unknowns = [i for i, kind in enumerate(self.kinds) if kind in ("unknown", "circle")]
        self.signs = [1 if kind in ROOTS else 0 for kind in self.kinds]
        self.relations: dict[int, Polynomial] = {}
        self.squares: dict[int, Polynomial] = {}
        self.values: dict[int, Fraction] = {}
        self.given: dict[int, int] = {}
        self.turns: dict[Any, tuple[int, Rotation]] = {}
        self.roots: list[tuple[Fraction, Fraction, list[tuple[Polynomial, int]]]] = []
        self.inverted: list[Polynomial] = []
        self.nonnegative: list[Polynomial] = []
        self.real: set[int] = set()
        i = 0
        for kind, *about in generators:
            self._declare(i, kind, *about)
            i += 2 if kind in PAIRS else 1

    def _declare(self, i: int, kind: str, about: Any = None, divisor: int = 1) -> None:
        g, one = self.generators[i], self.context.constant(1)
        if kind in PAIRS:
            s = self.generators[i + 1]
            key = about if kind == "angle" else ("circle", i)
            require(divisor > 0, "an angle is divided by zero")
            self.turns[key] = divisor, (Fraction(self, g, one), Fraction(self, s, one))
            self.relations[i + 1] = s * s + g * g - 1
        elif kind in ROOTS:
            p = self.polynomial(about)
            require(not any(p.degrees()[: len(self.kinds) - i]), "a relation has later generators")
            self.squares[i] = p if kind == "root" else self.reduced(p * p)
            self.relations[i] = g * g - self.squares[i]
        else:
            op, *name = self.nodes[about]
            self.values[about] = Fraction(self, g, one)
            self.signs[i] = name[1] if op == "name" else int(op == "pi")

    def polynomial(self, terms: list[Any]) -> Polynomial:
        """From a list of terms: each a coefficient, then generators, each with its power."""
        total = self.context.constant(0)
        for coefficient, *powers in terms:
            factors = zip(powers[::2], powers[1::2], strict=True)
            total += prod((self.generators[i] ** n for i, n in factors), start=fmpq(coefficient))
        return total

    def factors(self, pairs: list[Any]) -> list[tuple[Polynomial, int]]:
        return [(self.polynomial(p), n) for p, n in pairs]

    def number(self, value: int | str) -> Fraction:
        return Fraction(self, self.context.constant(fmpq(value)), self.context.constant(1))

    def reduced(self, p: Polynomial) -> Polynomial:
        for i in reversed(self.relations):
            if p.degrees()[-1 - i] > 1:
                p = divmod(p, self.relations[i])[1]
        return p

    def is_number(self, p: Polynomial) -> bool:
        """Whether a polynomial, of roots of numbers at most, has a norm that differs from zero."""
        for i in reversed(self.squares):
            slot = -1 - i
            other = {m: -a if m[slot] % 2 else a for m, a in p.terms()}
            p = self.reduced(p * self.context.from_dict(other)) if p.degrees()[slot] else p
        return bool(p.is_constant() and p != 0)

    def inverse(self, a: Fraction) -> Fraction:
        """A root that divides the denominator moves to the numerator: ``1/w = w/w**2``."""
        num, den = a.den, a.num
        self.inverted.append(den)
        for g in (self.generators[i] for i in self.squares):
            if den != 0 and divmod(den, g)[1] == 0:
                num, den = num * g, den * g
        return Fraction(self, num, den)

    def leading(self, p: Polynomial) -> tuple[Monomial, Polynomial]:
        """The largest monomial of the unknowns (graded reverse lexicographic), its coefficient."""
        grouped: dict[Monomial, dict[Monomial, fmpq]] = {}
        slots = [len(self.kinds) - 1 - i for i in self.unknowns]
        for m, a in p.terms():
            rest = tuple(0 if j in slots else n for j, n in enumerate(m))
            grouped.setdefault(tuple(m[j] for j in slots), {})[rest] = a
        lead = max(grouped, key=lambda m: (sum(m), [-n for n in m]))
        return lead, self.context.from_dict(grouped[lead])

    def value(self, k: int) -> Fraction:
        """The value of a node."""
        if k in self.given:
            return self.value(self.given[k])
        if k not in self.values:
            op, *args = self.nodes[k]
            if op == "number":
                self.values[k] = self.number(args[0])
            elif op in ("+", "*"):
                join = Fraction.__add__ if op == "+" else Fraction.__mul__
                self.values[k] = reduce(join, map(self.value, args))
            elif op == "^":
                self.values[k] = self.value(args[0]) ** args[1]
            elif op in ("sqrt", "abs"):
                self.values[k] = self.root(self.value(args[0]) ** (1 if op == "sqrt" else 2))
            else:
                require(op in ("sin", "cos"), f"{op} is not a generator")
                self.values[k] = self.rotation(args[0], fmpq(1))[op == "sin"]
        return self.values[k]

    def rotation(self, k: int, q: fmpq) -> Rotation:
        """The cosine and the sine of a rational multiple of a node."""
        if k in self.given:
            return self.rotation(self.given[k], q)
        if k in self.turns:
            divisor, turn = self.turns[k]
            require((q * divisor).q == 1, "an angle is divided too finely")
            return times(turn, int(q * divisor))
        op, *args = self.nodes[k]
        if op == "+":
            return reduce(turned, (self.rotation(a, q) for a in args))
        if op == "*":
            require(len(args) == 2 and self.nodes[args[0]][0] == "number", "this is no multiple")
            return self.rotation(args[1], q * fmpq(self.nodes[args[0]][1]))
        require(op == "atan2" and q.q == 1, "an angle is not a generator")
        y, x, n = self.value(args[0]), self.value(args[1]), int(abs(q))
        norm = x * x + y * y  # an even multiple needs no root
        scale = norm ** -(n // 2) * (self.root(norm) ** -1 if n % 2 else self.number(1))
        cos, sin = times((x, y), int(q))
        return cos * scale, sin * scale

    def root_of(self, pairs: list[Any]) -> tuple[Fraction, Fraction, list[Any]]:
        """The value that a certificate gives to a root, its square and its factors."""
        factors = self.factors(pairs)
        value = self.product(factors)
        return value, value * value, factors

    def product(self, factors: list[tuple[Polynomial, int]]) -> Fraction:
        one = self.number(1)
        return reduce(Fraction.__mul__, (Fraction(self, p, one.den) ** n for p, n in factors), one)

    def root(self, a: Fraction) -> Fraction:
        """The value of a root: its square is right, it is real, and no factor is negative."""
        if a.num == 0:
            return a
        known = [(value, factors) for value, square, factors in self.roots if square == a]
        require(known, "a root has no value")
        value, factors = known[0]
        self.require_real(factors)
        require(all(n % 2 == 0 or self.sign(p) > 0 for p, n in factors), "a root may be negative")
        return value

    def require_real(self, factors: list[tuple[Polynomial, int]]) -> None:
        """The radicands of all generators in these factors of a root are not negative.

        One of unknown sign is not, because it is a simple factor of a radicand in the statement.
        """
        doubtful = self.roots_in(p for p, _ in factors) - self.real
        for i in doubtful:
            if self.kinds[i] == "abs" or self.sign(self.squares[i]) > 0:
                self.real.add(i)
        for i in doubtful - self.real:
            others = [p for p, n in factors if (p, n) != (self.generators[i], 1)]
            if len(others) == len(factors) - 1 and self.roots_in(others) <= self.real:
                self.real.add(i)
        require(doubtful <= self.real, "a root may be imaginary")

    def roots_in(self, polynomials: Iterable[Polynomial]) -> set[int]:
        """The roots in polynomials and in the radicands of these roots."""
        found = {i for p in polynomials for i in self.squares if p.degrees()[-1 - i]}
        return found | self.roots_in(self.squares[i] for i in found) if found else found

    def sign(self, p: Polynomial) -> int:
        """1 or -1 if a polynomial is certainly not negative or not positive, else 0."""
        for q in self.nonnegative:
            ratio, rest = divmod(p, q)
            if rest == 0 and ratio.is_constant():
                return 1 if ratio.leading_coefficient() > 0 else -1
        signs, constant, slack = set[int](), fmpq(0), fmpq(0)
        for exponents, a in p.terms():
            powers = {i: n for i, n in enumerate(reversed(exponents)) if n}
            odd = [self.signs[i] for i, n in powers.items() if n % 2]
            if all(odd):
                signs.add(prod(odd) * (1 if a > 0 else -1))
                constant += 0 if powers else a
            elif all(self.kinds[i] == "angle" for i in powers):  # cosines and sines are at most 1
                slack += abs(a)
            else:
                return 0
        return signs.pop() if len(signs) == 1 and abs(constant) >= slack else 0

    def assume(self, k: int, constant: Fraction, factors: list[tuple[Polynomial, int]]) -> None:
        """Node k is not negative; without factors of known sign, it is a product that is not."""
        require(self.value(k).num != 0, "it is zero that is not negative")
        require(constant * self.product(factors) == self.value(k), "a guard has other factors")
        self.require_real(factors)
        odd = [p for p, n in factors if n % 2]
        known = [*filter(None, map(self.sign, [constant.num, *odd]))]
        rest = prod((p for p in odd if not self.sign(p)), start=prod(known) * self.number(1).num)
        self.nonnegative.append(self.reduced(rest))
