"""The palletiser of Shi, Zhu and Li for their claims, and motions computed in other ways."""

from collections.abc import Iterable
from itertools import combinations
from typing import Any, NamedTuple

import sympy as sp
from sympy import cos, pi, sin

from closedform import Check, Indexed, Lemma, Not, homogeneous, real, rotation, twist_matrix

ABSTRACT = "Abstract"
BACKGROUND = "II. BACKGROUND"
MODELING = "III. MODELING"
FORWARD = "IV. KINEMATICS, A. Forward Kinematics"
JACOBIAN = "IV. KINEMATICS, B. Spatial Jacobian"
VERIFICATION = "V. VERIFICATION"
CONCLUSIONS = "CONCLUSIONS"
ASSEMBLY = (
    "the loops stay parallelograms where they are flat; there each could change to its other "
    "assembly, the antiparallelogram"
)
FIVE = (1, 2, 3, 4, 5)
VERTICAL = sp.Matrix([0, 0, 1])


class Palletiser(NamedTuple):
    """The results of the derivation.

    With five independent joints the pose is ``free`` by exponentials and ``chain`` by
    Denavit-Hartenberg.
    """

    lengths: tuple[sp.Symbol, ...]
    thetas: tuple[sp.Symbol, ...]
    moves: list[sp.Matrix]
    free: sp.Matrix
    links: list[sp.Matrix]
    chain: sp.Matrix
    pose: sp.Matrix
    twists: list[sp.Matrix]
    moved: list[sp.Matrix]
    J_space: sp.Matrix
    rates: sp.Matrix
    velocity: sp.Matrix
    lower: Lemma
    upper: Lemma

    @property
    def actuated(self) -> tuple[sp.Symbol, ...]:
        return self.thetas[:3] + self.thetas[4:]

    @property
    def five_rates(self) -> list[sp.Symbol]:
        """The rates of all joints, which here do not depend on each other."""
        return [*self.rates[:3], real("theta4_dot"), self.rates[3]]

    @property
    def V(self) -> sp.Matrix:
        """The spatial velocity as a 4x4 matrix."""
        return twist_matrix(self.J_space * self.rates)

    def couple(self, e: sp.Matrix) -> sp.Matrix:
        _, theta2, theta3, theta4, _ = self.thetas
        return e.xreplace({theta4: -(theta2 + theta3)})

    def rate(self, e: sp.Matrix) -> sp.Matrix:
        """The time derivative of a matrix that depends on the actuated joints."""
        pairs = zip(self.actuated, self.rates, strict=True)
        return sum((e.diff(angle) * rate for angle, rate in pairs), sp.zeros(*e.shape))

    def bracket(self, lower: int = 1, upper: int = 1) -> sp.Expr:
        """The turn of the wrist bracket in given assemblies of the loops: 1 or -1."""
        sigma, (plate, _) = real("sigma"), self.lower.solution
        turn = self.lower[plate].subs(sigma, lower)
        (second, _) = self.upper.solution
        return turn + self.upper[second].subs(sigma, upper).subs(plate, turn)

    def linkage(self, turn: sp.Expr) -> sp.Matrix:
        """The pose of the hand on the closed linkage, by plane geometry, without screws."""
        l1, l2, l3, l4, l5, l6 = self.lengths
        theta1, theta2, theta3, _, theta5 = self.thetas
        forearm = theta2 + theta3 + pi / 2  # from the vertical
        forward = l1 + l3 * sin(theta2) + l4 * sin(forearm)
        up = l2 + l3 * cos(theta2) + l4 * cos(forearm)
        wrist = homogeneous(rotation("x", -turn), (0, forward, up))
        turret, hand = (homogeneous(rotation("z", angle)) for angle in (theta1, theta5))
        return turret * wrist * homogeneous(sp.eye(3), (0, l6, -l5)) * hand

    def constraints(self) -> sp.Matrix:
        """The constraints of the closed linkage on its rates, at a posture with unit lengths.

        The columns are the rates of the five joints, then those of the loops.
        """
        _, theta2, theta3, theta4, _ = self.thetas
        (plate, rod), (second, other) = self.lower.solution, self.upper.solution
        equations = sp.Matrix(
            [
                *self.lower.equations,
                *self.upper.equations,
                theta4 - plate - second + theta2 + theta3,
            ]
        )
        slopes = equations.jacobian([*self.thetas, plate, rod, second, other])
        posture = {theta2: pi / 6, theta3: pi / 6, plate: 0, second: 0, rod: pi / 6}
        posture |= {other: 5 * pi / 6}
        fixed = {s: 1 if s.is_positive else 0 for s in slopes.free_symbols if s not in posture}
        return slopes.subs(posture | fixed)

    def freedoms(self) -> int:
        """How many rates of the closed linkage are independent."""
        slopes = self.constraints()
        return int(slopes.cols - slopes.rank())

    def driving_sets(self) -> list[tuple[int, ...]]:
        """The sets of joints whose rates determine all rates, without the undriven joint 4."""
        slopes = self.constraints()
        return [
            joints
            for joints in combinations((1, 2, 3, 5), self.freedoms())
            if slopes[:, [k for k in range(slopes.cols) if k + 1 not in joints]].rank()
            == slopes.rank()
        ]


def each(values: Iterable[Any]) -> Indexed:
    """A name whose index is that of a joint."""
    found = list(values)
    return Indexed(FIVE, lambda i: found[i - 1])


def stated(holds: bool, check: Check) -> Check:
    """A check, or its opposite if the sentence denies it."""
    return check if holds else Not(check)


def unit_axis() -> sp.Matrix:
    """An arbitrary unit vector, given by its polar angles."""
    lam, mu = real("lambda"), real("mu")
    return sp.Matrix([sin(lam) * cos(mu), sin(lam) * sin(mu), cos(lam)])


def turned(angle: sp.Expr) -> sp.Matrix:
    """The rotation about the unit axis: the axis is turned to z, and back."""
    frame = rotation("z", real("mu")) * rotation("y", real("lambda"))
    return frame * rotation("z", angle) * frame.T


def screw_motion(point: sp.Matrix, angle: sp.Expr, pitch: sp.Expr = sp.S.Zero) -> sp.Matrix:
    """The motion along the screw whose axis goes through a point in the direction of the axis."""
    slide = pitch * angle * unit_axis()
    about = homogeneous(turned(angle), slide)
    return homogeneous(sp.eye(3), point) * about * homogeneous(sp.eye(3), -point)


def euler_angles(name: str) -> sp.Matrix:
    """An arbitrary rotation."""
    return sp.prod(rotation(axis, real(f"{name}_{i}")) for i, axis in enumerate("zyz"))


def vector(name: str) -> sp.Matrix:
    """A vector of real symbols."""
    return sp.Matrix([real(f"{name}_{i}") for i in "xyz"])
