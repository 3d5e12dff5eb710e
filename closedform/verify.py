"""Checks the certificates of proofs, independently of the prover that wrote them.

Every polynomial is computed here from the expressions of a certificate.  The certificate only helps
with what is hard to find and easy to check: the value of a root, a combination of polynomials.
docs/certificates.md describes the format.  This module imports nothing of closedform.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from itertools import combinations, product
from math import prod
from typing import Any, TypeAlias

from flint import Ordering, arb, arb_mat, ctx, fmpq, fmpq_mpoly_ctx, fmpz_mat

FORMAT = 3
SIZES = {"name": 1, "unknown": 1, "root": 1, "angle": 2, "circle": 2, "known": 0, "value": 0}

Nodes: TypeAlias = "Mapping[int, list[Any]]"
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
    # As dictionaries they have no negative indices, which would be second numbers of an entry.
    nodes, certificates = (dict(enumerate(document[part])) for part in ("nodes", "certificates"))
    names = [node[1:] for node in nodes.values() if node[0] == "name"]
    require(len(names) == len({name for name, _ in names}), "a name has two meanings")
    require(all(sign in (-1, 0, 1) for _, sign in names), "a name has an unknown sign")
    for k, node in nodes.items():
        require(all(a in range(k) for a in operands(node)), "a node holds later ones")
    kinds = {
        "identity": check_identity,
        "count": check_count,
        "inverse": check_inverse,
        "point": check_point,
    }
    for k, certificate in certificates.items():
        try:
            kinds[certificate["kind"]]({"nodes": nodes, "certificates": certificates}, certificate)
        except Exception as error:  # whatever goes wrong, nothing is proved
            raise Refused(f"certificate {k} ({certificate['of']}): {error!r}") from error


def operands(node: list[Any]) -> list[int]:
    op, *args = node
    return args[: {"number": 0, "name": 0, "^": 1}.get(op)]


def check_identity(document: dict[str, Any], certificate: dict[str, Any]) -> None:
    """The listed expressions vanish wherever they are real and no denominator vanishes."""
    field = Field(document["nodes"], certificate)
    listed = [field.polynomial(p) for p in certificate["nonzero"]]
    for p in inverted_in(field, certificate["zero"]):
        for f in (f for f in listed if not f.is_constant()):
            while (division := divmod(p, f))[1] == 0:
                p = division[0]
        require(p.is_constant(), "a denominator is not listed")


def inverted_in(field: Field, zero: list[int]) -> list[Polynomial]:
    """Whatever is a denominator in expressions that vanish."""
    require(zero, "nothing is stated")
    for k in zero:
        require(field.value(k).num == 0, f"node {k} does not vanish")
    return field.inverted


def check_inverse(document: dict[str, Any], certificate: dict[str, Any]) -> None:
    """The counts of the steps of an inverse multiply to the number of its branches."""
    counts = [(document["certificates"][k], less) for k, less in certificate["counts"]]
    require(all(c["kind"] == "count" for c, _ in counts), "this is not a count")
    require(all(less in range(c["count"]) for c, less in counts), "more are left out than counted")
    require(len({k for k, _ in certificate["counts"]}) == len(counts), "a count is used twice")
    total, branches = prod(c["count"] - less for c, less in counts), certificate["branches"]
    require(counts and branches in range(1, total + 1), "fewer solutions are counted than branches")
    require(total == branches * certificate["per branch"], f"{total} solutions are counted")


def check_point(document: dict[str, Any], certificate: dict[str, Any]) -> None:
    """At a point, the determinant of a matrix is not zero; for one entry, the entry is not."""
    with ctx.workprec(300):
        rows = matrix_of(document["nodes"], certificate)
        require(rows and not arb_mat(rows).det().contains(0), "the determinant may be zero")


def matrix_of(nodes: Nodes, certificate: dict[str, Any]) -> list[list[arb]]:
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


def enclosed(nodes: Nodes, balls: dict[int, arb], k: int) -> arb:
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


def system_of(nodes: Nodes, certificate: dict[str, Any]) -> tuple[Field, list[Polynomial]]:
    """The polynomials of a system, with the relations of the cosines and sines of its angles."""
    field = Field(nodes, certificate)
    kinds = {kind for kind, *_ in certificate["field"]}
    require(kinds <= {"name", "unknown", "circle"}, "a generator has the wrong kind")
    angles, circles = certificate["angles"], [turn for _, turn in field.turns.values()]
    named = [k for k, *_ in (*field.values.items(), *angles, *certificate["given"])]
    require(all(nodes[k][0] == "name" for k in named), "only a name can be given a value")
    require(len(named) == len(set(named)), "a name has two values")
    rows = [row for _, row in angles]
    require(not rows or abs(fmpz_mat(rows).det()) == 1, "the change of angles is not invertible")
    require(len(rows) == len(circles), "an angle is not used")
    for k, row in angles:
        field.turns[k] = 1, reduce(turned, map(times, circles, row))
    field.nodes = {**nodes, **{k: ["+", given] for k, given in certificate["given"]}}
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
        self.field, num, den = field, field.reduced(num), field.reduced(den)
        require(den != 0, "a denominator is identically zero")
        common = den if den.is_one() else num.gcd(den) * den.leading_coefficient()
        self.num, self.den = (num, den) if common.is_one() else (num / common, den / common)

    def __add__(self, other: Fraction) -> Fraction:
        common = self.den if self.den == other.den else self.den.gcd(other.den)
        left, right = self.den / common, other.den / common
        return Fraction(self.field, self.num * right + other.num * left, self.den * right)

    def __mul__(self, other: Fraction) -> Fraction:
        return Fraction(self.field, self.num * other.num, self.den * other.den)

    def __pow__(self, n: int) -> Fraction:
        power = reduce(Fraction.__mul__, [self] * abs(n)) if n else self.field.number(1)
        if n >= 0:
            return power
        self.field.inverted.append(power.num)
        return Fraction(self.field, power.den, power.num)

    def __neg__(self) -> Fraction:
        return Fraction(self.field, -self.num, self.den)


def turned(a: Rotation, b: Rotation) -> Rotation:
    return a[0] * b[0] + -(a[1] * b[1]), a[1] * b[0] + a[0] * b[1]


def times(turn: Rotation, n: int) -> Rotation:
    turns = [turn if n > 0 else (turn[0], -turn[1])] * abs(n)
    return reduce(turned, turns or [(turn[0].field.number(1), turn[0].field.number(0))])


class Field:
    """The generators of a certificate, each with at most one relation, which is monic in it."""

    def __init__(self, nodes: Nodes, certificate: dict[str, Any]):
        steps = certificate["field"]
        self.nodes, self.assumed = nodes, certificate.get("assumed", [])
        self.stated = {*certificate.get("zero", []), *self.assumed}  # with all their parts
        for k in filter(self.stated.__contains__, reversed(range(len(nodes)))):
            self.stated.update(operands(nodes[k]))
        self.kinds = [kind for kind, *_ in steps for _ in range(SIZES[kind])]
        names = [f"g{i}" for i in reversed(range(len(self.kinds)))]
        self.context = fmpq_mpoly_ctx.get(names, Ordering.lex)  # a later generator is larger
        self.generators = self.context.gens()[::-1]
        self.unknowns = [i for i, kind in enumerate(self.kinds) if kind in ("unknown", "circle")]
        self.signs = [0] * len(self.kinds)
        self.relations: dict[int, Polynomial] = {}
        self.values: dict[int, Fraction] = {}
        self.lengths: dict[int, Fraction] = {}
        self.turns: dict[Any, tuple[int, Rotation]] = {}
        self.known: list[Polynomial] = []
        self.inverted: list[Polynomial] = []
        self.size = 0  # the number of generators so far
        for kind, *about in steps:
            size = self.size + SIZES[kind]
            getattr(self, f"add_{kind}")(*self.generators[self.size : size], *about)
            self.size = size

    def add_name(self, g: Polynomial, k: int) -> None:
        """A node that may have any value, within the sign of its name."""
        require(k not in self.values, "a node has two generators")
        op, *about = self.nodes[k]
        self.values[k] = self.fraction(g)
        self.signs[self.size] = about[1] if op == "name" else int(op == "pi")

    add_unknown = add_name

    def add_angle(self, c: Polynomial, s: Polynomial, k: Any, divisor: int) -> None:
        """The cosine and the sine of a node that is divided by a number."""
        require(divisor > 0, "an angle is divided by zero")
        self.turns[k] = divisor, (self.fraction(c), self.fraction(s))
        self.relations[self.size + 1] = s * s + c * c - 1

    def add_circle(self, c: Polynomial, s: Polynomial) -> None:
        """The cosine and the sine of a new unknown angle."""
        self.add_angle(c, s, ("circle", self.size), 1)

    def add_root(self, g: Polynomial, p: list[Any], n: int) -> None:
        """The root of a power that is not negative."""
        square = self.product([[p, n]])
        require(square.den.is_one(), "a relation has a denominator")
        self.relations[self.size], self.signs[self.size] = g * g - square.num, 1

    def add_known(self, k: int, p: list[Any], factors: list[Any]) -> None:
        """A polynomial is not negative, because such factors make it a radicand."""
        quotient, radicand = self.polynomial(p), self.radicand(k)
        difference = self.fraction(quotient) * self.product(factors) + -radicand
        require(difference.num == 0 != radicand.num, "a radicand has other factors")
        self.known.append(quotient)
        self.inverted += [self.polynomial(f) for f, n in factors if n]

    def add_value(self, k: int, factors: list[Any]) -> None:
        """The root of a radicand, or the length of a vector: its square is right."""
        value = self.product(factors)
        require((value * value + -self.radicand(k)).num == 0, "a root has another square")
        (self.lengths if self.nodes[k][0] == "atan2" else self.values)[k] = value

    def radicand(self, k: int) -> Fraction:
        """What is not negative wherever the statement is real."""
        require(k in self.stated, "a root is not in the statement")
        op, *args = self.nodes[k]
        if op in ("atan2", "abs"):
            return reduce(Fraction.__add__, (self.value(a) ** 2 for a in args))
        require(op == "sqrt" or k in self.assumed, "a node may be negative")
        return self.value(args[0] if op == "sqrt" else k)

    def fraction(self, p: Polynomial) -> Fraction:
        return Fraction(self, p, self.context.constant(1))

    def polynomial(self, terms: list[Any]) -> Polynomial:
        """From a list of terms: each a coefficient, then generators, each with its power."""
        total = self.context.constant(0)
        for coefficient, *powers in terms:
            require(all(i in range(self.size) for i in powers[::2]), "there is no such generator")
            factors = zip(powers[::2], powers[1::2], strict=True)
            total += prod((self.generators[i] ** n for i, n in factors), start=fmpq(coefficient))
        return total

    def product(self, pairs: list[Any]) -> Fraction:
        """Of powers of polynomials; none with an odd power is negative."""
        factors = [(self.polynomial(p), n) for p, n in pairs]
        require(all(n % 2 == 0 or self.nonnegative(p) for p, n in factors), "it may be negative")
        return reduce(Fraction.__mul__, (self.fraction(p) ** n for p, n in factors), self.number(1))

    def nonnegative(self, p: Polynomial) -> bool:
        """Whether this is known or follows from its terms; no cosine or sine is beyond 1."""
        positive, slack = fmpq(0), fmpq(0)
        for exponents, a in p.terms():
            powers = {i: n for i, n in enumerate(reversed(exponents)) if n}
            if prod((self.signs[i] for i, n in powers.items() if n % 2), start=a) > 0:
                positive += 0 if powers else a
            elif all(self.kinds[i] == "angle" for i in powers):
                slack += abs(a)
            else:
                return p in self.known
        return positive >= slack or p in self.known

    def number(self, value: int | str) -> Fraction:
        return self.fraction(self.context.constant(fmpq(value)))

    def reduced(self, p: Polynomial) -> Polynomial:
        degrees = p.degrees()
        high = next((i for i in reversed(self.relations) if degrees[-1 - i] > 1), None)
        return p if high is None else self.reduced(divmod(p, self.relations[high])[1])

    def leading(self, p: Polynomial) -> tuple[Monomial, Polynomial]:
        """The largest monomial of the unknowns (graded reverse lexicographic), its coefficient."""
        slots, monomials = [len(self.kinds) - 1 - i for i in self.unknowns], p.monoms()
        found = [tuple([m[j] for j in slots]) for m in monomials]
        lead = max(set(found), key=lambda m: (sum(m), [-n for n in m]))
        without = dict.fromkeys(slots, 0)
        terms = [(m, p.coefficient(k)) for k, m in enumerate(monomials) if found[k] == lead]
        rests = ((tuple([without.get(j, n) for j, n in enumerate(m)]), a) for m, a in terms)
        return lead, self.context.from_dict(dict(rests))

    def value(self, k: int) -> Fraction:
        """The value of a node."""
        if k not in self.values:
            op, *args = self.nodes[k]
            if op == "number":
                self.values[k] = self.number(args[0])
            elif op in ("+", "*"):
                join = Fraction.__add__ if op == "+" else Fraction.__mul__
                shortest_first = sorted(map(self.value, args), key=lambda x: len(x.num))
                self.values[k] = reduce(join, shortest_first)
            elif op == "^":
                self.values[k] = self.value(args[0]) ** args[1]
            else:
                require(op in ("sin", "cos"), f"{op} has no value")
                self.values[k] = self.rotation(args[0], fmpq(1))[op == "sin"]
        return self.values[k]

    def rotation(self, k: int, q: fmpq) -> Rotation:
        """The cosine and the sine of a rational multiple of a node."""
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
        length = self.lengths[k] if n % 2 else self.number(1)  # an even multiple needs no root
        scale = (x * x + y * y) ** -(n // 2) * length**-1
        cos, sin = times((x, y), int(q))
        return cos * scale, sin * scale
