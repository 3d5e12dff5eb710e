"""Exact postures and inequalities of the five-bar linkage, the evidence for and against claims."""

from functools import partial
from typing import NamedTuple

import sympy as sp
from closedform.derivations import hybrid_five_bar_design as design
from sympy import Abs, atan2, cos, sin, sqrt

from closedform import real
from closedform.proof.checks import Check, Every, Holds, Identity

DEFAULT = (7, 8, 5)
Eq, Ne, Lt, Gt = (partial(relation, evaluate=False) for relation in (sp.Eq, sp.Ne, sp.Lt, sp.Gt))


class FiveBar(NamedTuple):
    """The results of the derivation."""

    lengths: tuple[sp.Symbol, ...]
    angles: tuple[sp.Symbol, ...]
    elbows: tuple[sp.Matrix, sp.Matrix]
    by_legs: tuple[sp.Matrix, sp.Matrix]
    k: sp.Matrix
    p: tuple[sp.Symbol, ...]
    loop: tuple[sp.Expr, ...]
    A: sp.Matrix
    B: sp.Matrix
    in_plane: dict[sp.Symbol, sp.Expr]
    volumes: dict[str, design.Regime]

    @property
    def CD(self) -> sp.Matrix:
        return self.elbows[1] - self.elbows[0]

    @property
    def det_A(self) -> sp.Expr:
        return self.A.det()

    @property
    def kappa(self) -> sp.Expr:
        """The condition number of A."""
        c = Abs(cos(self.angles[3] - self.angles[4]))
        return sqrt((1 + c) / (1 - c))


def signs(bar: FiveBar) -> Check:
    """The sine of the angle between the bars of a leg, 2 sigma atan2(a, b), has the sign sigma."""
    a, b = real("a", positive=True), real("b", positive=True)
    sigma = real("sigma")
    return Every(
        {
            f"branch {s}": Identity(
                sin(2 * sigma * atan2(a, b)).subs(sigma, s), s * 2 * a * b / (a**2 + b**2)
            )
            for s in (1, -1)
        }
    )


class Plane(NamedTuple):
    """A posture in the plane of the linkage: C, D and P as (y, rho), for given lengths."""

    lengths: tuple[int, int, int]
    C: sp.Matrix
    D: sp.Matrix
    P: sp.Matrix

    @property
    def B(self) -> sp.Matrix:
        return sp.Matrix([self.lengths[0], 0])

    def closed(self) -> dict[str, sp.Expr]:
        _, L1, L2 = self.lengths
        return {
            "AC = BD = L1": Eq(square(self.C) - square(self.D - self.B), 0),
            "AC = L1": Eq(square(self.C) - L1**2, 0),
            "CP = L2": Eq(square(self.P - self.C) - L2**2, 0),
            "DP = L2": Eq(square(self.P - self.D) - L2**2, 0),
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
        return sp.Matrix.hstack(self.P - self.C, self.P - self.D).det()

    @property
    def dot(self) -> sp.Expr:
        return (self.P - self.C).dot(self.P - self.D)

    def other_mode(self) -> "Plane":
        """The posture with the leg over C reflected about AP."""
        C = 2 * self.C.dot(self.P) / square(self.P) * self.P - self.C
        return self._replace(C=C)


def square(v: sp.Matrix) -> sp.Expr:
    return sp.expand(v.dot(v))


def coincident(lengths: tuple[int, int, int] = DEFAULT) -> Plane:
    """C = D, and P at the distance L2 from them, parallel to AB."""
    L0, L1, L2 = lengths
    C = sp.Matrix([sp.Rational(L0, 2), sqrt(L1**2 - sp.Rational(L0, 2) ** 2)])
    return Plane(lengths, C, C, C - sp.Matrix([L2, 0]))


def isotropic() -> Plane:
    """The symmetric isotropic posture: CD is parallel to AB and sqrt(2) L2 long."""
    L0, L1, L2 = DEFAULT
    half = L2 / sqrt(2)
    C_y = sp.Rational(L0, 2) - half
    height = sqrt(sp.expand(L1**2 - C_y**2))
    P = sp.Matrix([sp.Rational(L0, 2), height - half])
    return Plane(DEFAULT, sp.Matrix([C_y, height]), sp.Matrix([L0 - C_y, height]), P)


def on_the_axis() -> Holds:
    """P on AB inside the workspace: the default lengths, AP = BP = 7/2."""
    L0, L1, L2 = DEFAULT
    half = sp.Rational(L0, 2)
    C_y = (L1**2 - L2**2 + half**2) / (2 * half)
    C = sp.Matrix([C_y, sqrt(L1**2 - C_y**2)])
    posture = Plane(DEFAULT, C, sp.Matrix([L0 - C[0], C[1]]), sp.Matrix([half, 0]))
    return Holds({**posture.closed(), **posture.interior(), "rho = 0": Eq(posture.P[1], 0)})


def serial(bar: FiveBar) -> Check:
    """The diagonal of B: rho L2, and entries that vanish if AP or BP is L1 + L2 or |L1 - L2|."""
    L0, L1, L2 = bar.lengths
    rho = bar.by_legs[0].dot(bar.k.cross(sp.Matrix([0, 1, 0])))
    parts = {"rho": Identity(bar.B[0, 0], L2 * rho)}
    for i, name in enumerate(("AP", "BP")):
        arm = bar.by_legs[i] - sp.Matrix([0, i * L0, 0])
        reach = arm.dot(arm)
        parts[name] = Identity(
            ((L1 + L2) ** 2 - reach) * (reach - (L1 - L2) ** 2), 4 * bar.B[i + 1, i + 1] ** 2
        )
    return Every(parts)


def without_parallel(L0: int, L1: int, L2: int) -> dict[str, sp.Expr]:
    """The conditions for a design without parallel singularities, for given numbers."""
    return {
        f"{L0} > 2*{L1}, C and D stay apart": sp.sympify(L0 > 2 * L1),
        f"2*{L2} > {L0} + 2*{L1}, C, P, D are never in line": sp.sympify(2 * L2 > L0 + 2 * L1),
    }


def longest(bar: FiveBar) -> Check:
    """CD is at most L0 + 2 L1."""
    return Identity(*design.longest(bar.CD, *bar.angles[1:3]))


def shortest(bar: FiveBar) -> Check:
    """CD is at least L0 - 2 L1 if this is not negative."""
    return Identity(*design.shortest(bar.CD, *bar.angles[1:3]))
