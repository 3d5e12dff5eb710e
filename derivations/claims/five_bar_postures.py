"""The five-bar linkage for the claims: its graph, exact postures, and what bounds its lengths."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import product
from typing import NamedTuple, TypeAlias

import sympy as sp
from closedform.derivations import hybrid_five_bar_design as design
from sympy import Abs, pi, sqrt

from closedform import (
    Check,
    Enumeration,
    Every,
    ForAll,
    Holds,
    Identity,
    Relation,
    equal,
    normal,
    real,
)

DEFAULT = (7, 8, 5)
NO_LENGTHS = "a figure for lengths that the paper does not give"
Point: TypeAlias = "dict[sp.Symbol, sp.Expr]"
NO_MODEL = "the paper gives no masses, no stiffness and no tolerances"
Eq, Ne, Lt, Gt = (partial(relation, evaluate=False) for relation in (sp.Eq, sp.Ne, sp.Lt, sp.Gt))
J = sp.Matrix([0, 1, 0])

CLOSED = (
    (1, 1, 1, pi / 2, pi / 2, pi / 3, 2 * pi / 3),  # a square with an equilateral triangle on it
    (2, 2, 2, pi / 2, pi / 2, pi / 3, 2 * pi / 3),
    (2, 1, 1, pi / 2, pi, sp.S.Zero, pi / 2),  # C = (0, 1), D = (1, 0), P = (1, 1)
    (2, 1, 1, pi / 2, pi / 2, sp.S.Zero, pi),  # C = (0, 1), P = (1, 1), D = (2, 1)
    (sqrt(3) - 1, 1, 1, pi / 6, pi / 2, pi, 7 * pi / 6),
    (sqrt(3), 1, 1, pi / 2, pi / 2, pi / 6, 5 * pi / 6),  # CP and DP at an obtuse angle
    (2, 1, sqrt(2), pi / 2, pi / 2, -pi / 4, -3 * pi / 4),  # at a right one, with P on AB
)
"""L0, L1, L2 and theta2 to theta5 of postures that a person can check by hand."""

JOINTS = {
    "theta1": ("base", "AB"),
    "theta2": ("AB", "AC"),
    "theta3": ("AB", "BD"),
    "theta4": ("AC", "CP"),
    "theta5": ("BD", "DP"),
    "P": ("CP", "DP"),
}
"""The bodies that each revolute joint connects."""


def routes(start: str, end: str, seen: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """The ways from one body to another, as joints, without passing a body twice."""
    if start == end:
        yield ()
        return
    for joint, bodies in JOINTS.items():
        for a, b in (bodies, bodies[::-1]):
            if a == start and b not in (*seen, start):
                yield from ((joint, *rest) for rest in routes(b, end, (*seen, start)))


def in_loop() -> list[str]:
    """The joints whose bodies are also connected in another way; the other joints are in series."""
    return [joint for joint, (a, b) in JOINTS.items() if len(list(routes(a, b))) > 1]


class FiveBar(NamedTuple):
    """The results of the derivation."""

    lengths: tuple[sp.Symbol, ...]
    angles: tuple[sp.Symbol, ...]
    pivots: tuple[sp.Matrix, sp.Matrix]
    elbows: tuple[sp.Matrix, sp.Matrix]
    by_legs: tuple[sp.Matrix, sp.Matrix]
    k: sp.Matrix
    p: sp.Matrix
    loop: tuple[sp.Expr, ...]
    A: sp.Matrix
    A_loop: sp.Matrix
    B: sp.Matrix
    in_plane: dict[sp.Symbol, sp.Expr]
    volumes: dict[str, design.Regime]

    @property
    def CD(self) -> sp.Matrix:
        return self.elbows[1] - self.elbows[0]

    @property
    def bars(self) -> tuple[sp.Matrix, ...]:
        """The vectors AC, BD, CP and DP."""
        driven = (e - o for e, o in zip(self.elbows, self.pivots, strict=True))
        following = (p - e for p, e in zip(self.by_legs, self.elbows, strict=True))
        return (*driven, *following)

    @property
    def gram(self) -> sp.Matrix:
        return (self.A * self.A.T).applyfunc(normal)

    @property
    def eigenvalues(self) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """The eigenvalues of the matrix ``gram``, in their order: its last block is symmetric."""
        G = self.gram
        return G[1, 1] - Abs(G[1, 2]), G[0, 0], G[1, 1] + Abs(G[1, 2])

    @property
    def kappa(self) -> sp.Expr:
        """The condition number of A, by the singular values."""
        smallest, _, largest = self.eigenvalues
        return sqrt(largest / smallest)

    def freedom(self, angles: Sequence[sp.Symbol]) -> int:
        """The freedom of the loop if only some angles can change, at a posture with L0 = CD."""
        t = self.angles
        posture = dict.fromkeys(self.lengths, sp.S.One) | {
            t[0]: sp.S.Zero, t[1]: pi / 2, t[2]: pi / 2, t[3]: pi / 3, t[4]: 2 * pi / 3
        }  # fmt: skip
        gap = self.by_legs[0] - self.by_legs[1]
        if any(e.subs(posture) != 0 for e in gap):
            raise ValueError("the loop is not closed")
        return len(angles) - gap.jacobian(list(angles)).subs(posture).rank()

    def postures(self, at: Mapping[sp.Symbol, sp.Expr] | None = None) -> list[Point]:
        """The postures of ``CLOSED`` in which angles have the given values, up to full turns."""
        names = (*self.lengths, *self.angles[1:])
        found = []
        for several in CLOSED:
            posture = dict(zip(names, map(sp.sympify, several), strict=True))
            posture[self.angles[0]] = sp.S.Zero
            if any(sp.simplify(e) != 0 for e in (self.by_legs[0] - self.by_legs[1]).subs(posture)):
                raise ValueError(f"the loop is not closed at {posture}")
            gaps = ((angle - value).subs(posture) for angle, value in (at or {}).items())
            if all((gap / (2 * pi)).is_integer for gap in gaps):
                found.append(posture)
        return found

    def turned_by(self, bar: sp.Matrix, other: sp.Matrix) -> sp.Expr:
        """The cross product of two bars, about the normal of the plane."""
        return normal(self.k.dot(bar.cross(other)))

    def serial_cases(self) -> list[str]:
        """Which points are in line where an entry of B vanishes."""
        AC, BD, CP, DP = self.bars
        L2 = self.lengths[2]
        named = {
            "P on AB": normal(L2 * self.k.dot(J.cross(self.by_legs[0]))),
            "AC and CP aligned": self.turned_by(AC, CP),
            "BD and DP aligned": self.turned_by(BD, DP),
            "CP and DP aligned": self.turned_by(CP, DP),
        }
        return [name for name, e in named.items() if any(equal(e, self.B[i, i]) for i in range(3))]


class Plane(NamedTuple):
    """A posture in the plane of the linkage: C, D and P as (y, rho), for given lengths."""

    lengths: Sequence[sp.Expr]
    C: sp.Matrix
    D: sp.Matrix
    P: sp.Matrix

    @property
    def B(self) -> sp.Matrix:
        return sp.Matrix([self.lengths[0], 0])

    def closed(self) -> dict[str, sp.Expr]:
        _, L1, L2 = self.lengths
        return {
            "AC = L1": Eq(square(self.C), L1**2),
            "BD = L1": Eq(square(self.D - self.B), L1**2),
            "CP = L2": Eq(square(self.P - self.C), L2**2),
            "DP = L2": Eq(square(self.P - self.D), L2**2),
        }

    def interior(self) -> dict[str, sp.Expr]:
        _, L1, L2 = self.lengths
        found = {}
        for name, reach in (("AP", square(self.P)), ("BP", square(self.P - self.B))):
            found[f"{name} < L1 + L2"] = Lt(reach, (L1 + L2) ** 2)
            found[f"{name} > |L1 - L2|"] = Gt(reach, (L1 - L2) ** 2)
        return found

    @property
    def cross(self) -> sp.Expr:
        """CP x DP: L2^2 times the sine of the angle between them."""
        return turn(self.P - self.C, self.P - self.D)

    @property
    def dot(self) -> sp.Expr:
        return (self.P - self.C).dot(self.P - self.D)

    @property
    def diagonal(self) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """The diagonal entries of B."""
        legs = turn(self.C, self.P - self.C), turn(self.D - self.B, self.P - self.D)
        return self.lengths[2] * self.P[1], *legs

    @property
    def conditions(self) -> tuple[sp.Expr, sp.Expr]:
        """The squares of the condition numbers of A and of B."""
        L2 = self.lengths[2]
        c = Abs(self.dot) / L2**2
        entries = [normal(e**2) for e in self.diagonal]
        return normal((1 + c) / (1 - c)), sp.Max(*entries) / sp.Min(*entries)

    def other_mode(self) -> "Plane":
        """The posture with the leg over C reflected about AP."""
        C = 2 * self.C.dot(self.P) / square(self.P) * self.P - self.C
        return self._replace(C=C.applyfunc(sp.simplify))

    def corners(self) -> list[sp.Expr]:
        """How the outline A, B, D, P, C turns at each corner; convex if no two signs differ."""
        points = [sp.zeros(2, 1), self.B, self.D, self.P, self.C]
        return [turn(points[i - 1] - points[i - 2], points[i] - points[i - 1]) for i in range(5)]


def turn(a: sp.Matrix, b: sp.Matrix) -> sp.Expr:
    return sp.expand(a[0] * b[1] - a[1] * b[0])  # det() would first try to cancel every product


def square(v: sp.Matrix) -> sp.Expr:
    return sp.expand(v.dot(v))


def modes(lengths: Sequence[sp.Expr], P: sp.Matrix) -> list[Plane]:
    """The postures of all signs of both legs for a position of P in the plane."""
    L0, L1, L2 = lengths
    found = []
    for signs in product((1, -1), repeat=2):
        ends = []
        for pivot, s in zip((sp.zeros(2, 1), sp.Matrix([L0, 0])), signs, strict=True):
            v = P - pivot
            along = (square(v) + L1**2 - L2**2) / (2 * square(v))
            off = sqrt(L1**2 / square(v) - along**2)
            ends.append(pivot + along * v + s * off * sp.Matrix([-v[1], v[0]]))
        found.append(Plane(tuple(lengths), *ends, P))
    return found


def coincident(lengths: tuple[int, int, int] = DEFAULT) -> Plane:
    """C = D, and P at the distance L2 from them, parallel to AB."""
    L0, L1, L2 = lengths
    C = sp.Matrix([sp.Rational(L0, 2), sqrt(L1**2 - sp.Rational(L0, 2) ** 2)])
    return Plane(lengths, C, C, C - sp.Matrix([L2, 0]))


def symmetric(half: sp.Expr, lengths: tuple[int, int, int] = DEFAULT) -> Plane:
    """CD is parallel to AB and twice ``half`` long, and P is between CD and AB."""
    L0, L1, L2 = lengths
    C_y = sp.Rational(L0, 2) - half
    height = sqrt(sp.expand(L1**2 - C_y**2))
    P = sp.Matrix([sp.Rational(L0, 2), height - sqrt(L2**2 - half**2)])
    return Plane(lengths, sp.Matrix([C_y, height]), sp.Matrix([L0 - C_y, height]), P)


def isotropic() -> Plane:
    """CP and DP are at right angles."""
    return symmetric(DEFAULT[2] / sqrt(2))


def in_line() -> Plane:
    """C, P and D are in line, on the far side of a convex outline."""
    return symmetric(sp.Integer(DEFAULT[2]))


def on_the_axis() -> Plane:
    """P on AB inside the workspace: the default lengths, AP = BP = 7/2."""
    L0, L1, L2 = DEFAULT
    half = sp.Rational(L0, 2)
    C_y = (L1**2 - L2**2 + half**2) / (2 * half)
    C = sp.Matrix([C_y, sqrt(L1**2 - C_y**2)])
    return Plane(DEFAULT, C, sp.Matrix([L0 - C[0], C[1]]), sp.Matrix([half, 0]))


def serial_by_position(bar: FiveBar) -> Check:
    """For a given P, only the signs of the entries of B depend on the working mode.

    The first entry is L2 rho, where the square of rho is that of the distance of P from AB.  The
    others are twice the areas of the triangles ACP and BDP, so they vanish only at the distances
    L1 + L2 and |L1 - L2| of P from A or from B.
    """
    _, L1, L2 = bar.lengths
    p = bar.by_legs[0]
    parts: dict[str, Check] = {
        "the first entry": Identity(bar.B[0, 0] ** 2, L2**2 * (p.dot(p) - p.dot(J) ** 2))
    }
    for i, (name, o) in enumerate(zip(("AP", "BP"), bar.pivots, strict=True)):
        arm = bar.by_legs[i] - o
        reach = arm.dot(arm)
        parts[f"the entry that depends on {name}"] = Identity(
            ((L1 + L2) ** 2 - reach) * (reach - (L1 - L2) ** 2), 4 * bar.B[i + 1, i + 1] ** 2
        )
    return Every(parts)


def sign_patterns(indicator: Callable[[Plane], Sequence[sp.Expr]]) -> Check:
    """The eight postures for one P differ in the signs of an indicator."""
    P = sp.Matrix([3, 6])
    postures = [posture for s in (1, -1) for posture in modes(DEFAULT, sp.diag(1, s) * P)]
    return Enumeration(
        len(postures),
        lambda: len({tuple(bool(e > 0) for e in indicator(at)) for at in postures}),
        "postures that differ in a sign, for P at 3 along AB and 6 from AB and the lengths 7, 8, 5",
    )


def range_of_CD(bar: FiveBar) -> dict[str, Check]:
    """CD takes all values between max(0, L0 - 2 L1) and L0 + 2 L1, and no other."""
    t2, t3 = bar.angles[1:3]
    L0, L1, _ = bar.lengths
    corner = sp.acos(L0 / (2 * L1))
    ends = [({t2: pi, t3: sp.S.Zero}, L0 + 2 * L1), ({t2: sp.S.Zero, t3: pi}, L0 - 2 * L1)]
    return {
        r"$CD \le L_0 + 2 L_1$": Identity(*design.longest(bar.CD, t2, t3)),
        r"$CD \ge L_0 - 2 L_1$": Identity(*design.shortest(bar.CD, t2, t3)),
        "both bounds are reached": Identity(
            [bar.CD.dot(bar.CD).subs(at) for at, _ in ends], [end**2 for _, end in ends]
        ),
        r"C and D meet if $L_0 \le 2 L_1$": Identity(
            bar.CD.subs({t2: corner, t3: pi - corner}), sp.zeros(3, 1)
        ),
    }


def relations(formula: Relation | tuple[Relation, ...]) -> list[sp.Expr]:
    """The relations between neighbouring sides of printed formulas."""
    several = formula if isinstance(formula, tuple) else (formula,)
    return [
        Relation(r.sides[i : i + 2], r.signs[i : i + 1], r.texts[i : i + 2]).relational
        for r in several
        for i in range(len(r.signs))
    ]


def implies(
    printed: Sequence[sp.Expr],
    wanted: sp.Expr,
    lengths: Sequence[sp.Symbol],
    among: Sequence[Point] = (),
) -> Check:
    """Inequalities between lengths imply another one, which is linear in them too.

    Each printed inequality says that a gap is positive.  If one of them is solved for a length, and
    then all coefficients of the wanted gap are positive, the implication is proved.  Only lengths
    with which the loop can close refute it; those of ``among`` are tried first.
    """
    L0, L1, L2 = lengths
    closes = sp.Le(L0, 2 * (L1 + L2))
    for r in printed:
        if isinstance(r, sp.Ne):
            continue
        strict = isinstance(r, sp.Gt | sp.Lt)
        gap = real("gap", positive=True) if strict else real("gap", nonnegative=True)
        for length in lengths:
            slack = [(length, s) for s in sp.solve(r.gts - r.lts - gap, length)]
            form = sp.expand((wanted.gts - wanted.lts).subs(slack))
            if form.is_positive or (form.is_nonnegative and not isinstance(wanted, sp.Gt | sp.Lt)):
                return ForAll(wanted, where=printed, slack=slack)
    return ForAll(wanted, where=[*printed, closes], among=among)


def closed_and(posture: Plane, **more: sp.Expr) -> Holds:
    """A posture is closed, and further relations hold at it."""
    relations = {**posture.closed(), **{k.replace("_", " "): v for k, v in more.items()}}
    names = ("L0", "L1", "L2", "y", "rho")
    values = map(sp.sympify, (*posture.lengths, *posture.P))
    return Holds(relations, dict(zip(map(real, names), values, strict=True)))
