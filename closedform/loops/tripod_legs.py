"""The legs of a tripod: where its hand is, and how its corners move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Crank, Leg, Slide, Stretch, cross_in_plane, vector
from closedform.loops.hand import check_order, check_plain, square
from closedform.loops.leg_by_leg import named_in
from closedform.mechanics.frames import rotation
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, choose, real

TASK = ("z", "tilt_x", "tilt_y")


@dataclass(frozen=True)
class Upright:
    """A leg that stays in a vertical plane through the z axis, and carries a corner of the hand.

    The plane contains the z axis and ``heading``, a horizontal unit vector in numbers.  In this
    plane the ``leg`` is seen with two coordinates: the distance from the z axis along ``heading``,
    and the height.  ``corner`` is the end of the leg on the hand, as x and y in the frame of the
    hand, and z if the point of the hand is not in the plane of the corners.
    """

    leg: Leg
    heading: Sequence[Any]
    corner: Sequence[Any]

    @property
    def along(self) -> sp.Matrix:
        return vector(self.heading)

    @property
    def flat(self) -> sp.Matrix:
        """The x and y of the corner."""
        return vector(self.corner)[:2, 0]

    @property
    def end(self) -> sp.Matrix:
        """The corner, seen from the point of the hand."""
        return sp.Matrix([*vector(self.corner), 0][:3])

    @property
    def normal(self) -> sp.Matrix:
        """The normal of the plane, horizontal."""
        return sp.Matrix([-self.along[1], self.along[0]])

    def in_space(self, place: sp.Matrix) -> list[sp.Expr]:
        """A point of the plane: distance from the z axis and height."""
        return [*(place[0] * self.along), place[1]]


@dataclass(frozen=True)
class Placed:
    """The hand at a target, in the names of a program."""

    program: Program
    turn: tuple[sp.Expr, sp.Expr]
    """The cosine and the sine of the twist."""
    delta: sp.Expr
    rotation: sp.Matrix
    position: sp.Matrix
    arms: tuple[sp.Matrix, ...]
    """The corners, from the point of the hand, in the base frame."""

    def corner(self, leg: Upright, k: int) -> sp.Matrix:
        """The corner of a leg, in its plane."""
        far = self.position + self.arms[k]
        return sp.Matrix([leg.along.dot(far[:2, 0]), far[2]])


def sum_of_cosines(tilts: Sequence[sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    """The sum of the cosines of two tilts, as written and as it keeps its digits near zero."""
    (sx, cx), (sy, cy) = ((sp.sin(t), sp.cos(t)) for t in tilts)
    return cx + cy, (sy - sx) * (sy + sx) / (cx - cy)


def named_cosines(p: Program, tilts: Sequence[sp.Expr], *sums: sp.Expr) -> tuple[sp.Expr, ...]:
    """Sums of both tilts with a name for the sum of their cosines, where that is a factor."""
    plain, apart = sum_of_cosines(tilts)
    x, y = plain.args
    found = tuple(e.coeff(x) if e.coeff(x) == e.coeff(y) else sp.S.Zero for e in sums)
    if not any(found):
        return sums
    u = p.let("u", choose(x * y < -sp.Rational(1, 2), apart, plain))
    return tuple(
        sp.expand(e - factor * plain) + factor * u for e, factor in zip(sums, found, strict=True)
    )


@dataclass(frozen=True)
class Tripod:
    """The legs of a tripod."""

    d: Derivation
    legs: tuple[Upright, ...]

    def __post_init__(self) -> None:
        name = self.d.name
        if len(self.legs) != 3:
            raise ShapeError(f"{name}: a tripod has three legs, not {len(self.legs)}")
        for upright in self.legs:
            leg = upright.leg
            if not isinstance(leg, Crank | Slide | Stretch) or not all(
                len(v) == 2 for v in (upright.heading, upright.flat, leg.base, leg.rate)
            ):
                raise ShapeError(
                    f"{name}: a leg of a tripod must be a crank, a slide or a stretching leg in "
                    f"a plane, so its vectors need 2 entries"
                )
            if not square(upright.along).is_number or sp.simplify(square(upright.along) - 1) != 0:
                raise ShapeError(f"{name}: a heading must be a unit vector, in numbers")
        if any(sp.simplify(e.end[2] - self.legs[0].end[2]) != 0 for e in self.legs):
            raise ShapeError(
                f"{name}: the corners must have the same z in the frame of the hand, or the twist "
                f"is another one"
            )
        check_order(self.d, [upright.leg for upright in self.legs])
        check_plain(self.d, [upright.leg for upright in self.legs])
        if any(weight == 0 for weight in self.weights):
            raise ShapeError(f"{name}: two legs are in the same plane")
        if list(self.d.task) not in ([], list(TASK)):
            raise ShapeError(f"{name}: the task of a tripod must be {', '.join(TASK)}")
        if not self.side:
            raise ShapeError(
                f"{name}: the corners do not determine how the hand is turned at rest; write "
                "their coordinates with positive parameters"
            )
        self.d.task = list(TASK)

    @cached_property
    def target(self) -> tuple[sp.Symbol, ...]:
        return tuple(map(real, TASK))

    @property
    def size(self) -> sp.Expr:
        """The sum of the distances of the corners from the axes of the hand."""
        return sp.Add(*(sp.Abs(e) for leg in self.legs for e in leg.flat))

    @cached_property
    def weights(self) -> tuple[sp.Expr, ...]:
        """Factors with which the normals of the planes add up to zero."""
        n = [leg.normal for leg in self.legs]
        return tuple(sp.simplify(cross_in_plane(n[(k + 1) % 3], n[(k + 2) % 3])) for k in range(3))

    @cached_property
    def tilted(self) -> sp.Matrix:
        """The rotation without the twist."""
        _, a, b = self.target
        return rotation("y", b) * rotation("x", a)

    @property
    def axes(self) -> tuple[sp.Matrix, ...]:
        """The axes about which tilt_x, tilt_y and the twist turn the hand."""
        x, y, z = (sp.eye(3).col(k) for k in range(3))
        return rotation("y", self.target[2]) * x, y, self.tilted * z

    def balance(self, turned: bool) -> sp.Expr:
        """The sum over the legs of weight*n*e, for the corners e and for e turned by 90 degrees.

        With the twist psi, the first times cos(psi) plus the second times sin(psi) vanishes.
        """
        total = sp.S.Zero
        for weight, leg in zip(self.weights, self.legs, strict=True):
            x, y = leg.flat
            e = sp.Matrix([-y, x, 0] if turned else [x, y, 0])
            total += weight * leg.normal.dot((self.tilted * e)[:2, 0])
        return sp.collect(sp.expand(total), [sp.cos(t) for t in self.target])

    def cosines(self) -> tuple[sp.Expr, sp.Expr]:
        """The sum of the cosines of the tilts, as written and as it keeps its digits near zero."""
        return sum_of_cosines(self.target[1:])

    @cached_property
    def side(self) -> int:
        """The sign of the second sum if the hand is level and not twisted; 0 if it is unknown."""
        level = sp.simplify(self.balance(turned=True).subs(dict.fromkeys(self.target, 0)))
        return int(bool(level.is_positive)) - int(bool(level.is_negative))

    @property
    def numbered(self) -> list[tuple[int, Upright]]:
        return [*enumerate(self.legs, 1)]

    def placed(self, p: Program, *, guarded: bool = False, plain: bool = False) -> Placed:
        """Name the hand at a target in a program.

        Parameters
        ----------
        p
            the program
        guarded
            whether the twist is zero where it is free, instead of being undefined.  It is free
            only where delta is exactly zero: nearby a rod may reach with the twist of the target,
            and not with zero
        plain
            whether to write the sums as a person does, though they may lose digits
        """
        side = sp.Integer(self.side)
        sums: tuple[sp.Expr, ...] = tuple(side * self.balance(turned) for turned in (False, True))
        if not plain:
            sums = named_cosines(p, self.target[1:], *sums)
        f, g = (p.let(name, e) for name, e in zip("fg", sums, strict=True))
        delta = p.let("delta", sp.sqrt(f**2 + g**2), nonnegative=True)
        cosine, sine = g / delta, -f / delta
        if guarded:
            free = p.vanishes("untwisted", delta, 0, "the twist of the hand is free")
            cosine, sine = choose(free, 1, cosine), choose(free, 0, sine)
        c, s = p.let("c", cosine), p.let("s", sine)
        first, second, third = (self.tilted.col(k) for k in range(3))
        columns = [c * first + s * second, c * second - s * first, third]
        R = p.matrix("R", sp.Matrix.hstack(*columns))
        arms = []
        for k, leg in self.numbered:
            arm = R * leg.end
            arms.append(
                sp.Matrix([named_in(p, f"h{k}_{i}", e) for i, e in zip("xyz", arm, strict=True)])
            )
        n = [leg.normal for leg in self.legs]
        off = [named_in(p, f"beside_{k + 1}", n[k].dot(arms[k][:2, 0])) for k in range(2)]
        across = self.weights[2]
        x = named_in(p, "px", (n[0][1] * off[1] - n[1][1] * off[0]) / across)
        y = named_in(p, "py", (n[1][0] * off[0] - n[0][0] * off[1]) / across)
        return Placed(
            program=p,
            turn=(c, s),
            delta=delta,
            rotation=R,
            position=sp.Matrix([x, y, self.target[0]]),
            arms=tuple(arms),
        )

    @cached_property
    def posture(self) -> Placed:
        """The hand in the angles of the target and the twist psi, without a program."""
        psi = real("psi")
        turned = self.tilted * rotation("z", psi)
        arms = tuple(turned * leg.end for leg in self.legs)
        n = [leg.normal for leg in self.legs]
        off = [n[k].dot(arms[k][:2, 0]) for k in range(2)]
        sideways = sp.Matrix([n[0].T, n[1].T]).LUsolve(-sp.Matrix(off))
        position = sp.Matrix([*sideways, self.target[0]])
        pair = (sp.cos(psi), sp.sin(psi))
        return Placed(
            program=Program(),
            turn=pair,
            delta=sp.S.One,
            rotation=turned,
            position=position,
            arms=arms,
        )

    @property
    def twisting(self) -> sp.Expr:
        """An expression that vanishes for the correct twist psi."""
        c, s = self.posture.turn
        f, g = (self.side * self.balance(turned) for turned in (False, True))
        return f * c + g * s

    def rows(self, placed: Placed, rods: Sequence[sp.Matrix], delta: sp.Expr) -> list[sp.Matrix]:
        """The rows of A, from the vectors along the rods; ``delta`` is what divides."""
        p, at, psi, tilts = placed.program, self.posture, real("psi"), self.target[1:]
        held = dict(zip(at.turn, placed.turn, strict=True))
        follows = [
            named_in(p, f"twist_{t}", -self.twisting.diff(t).xreplace(held) / delta) for t in tilts
        ]
        rows = []
        for k, (leg, rod) in enumerate(zip(self.legs, rods, strict=True)):
            far, row = at.corner(leg, k), [rod[1]]
            for t, follow in zip(tilts, follows, strict=True):
                rate = far.diff(t).xreplace(held) + far.diff(psi).xreplace(held) * follow
                row.append(named_in(p, f"A_{k + 1}{len(row) + 1}", rod.dot(rate)))
            rows.append(sp.Matrix([row]))
        return rows

    def loop(self, placed: Placed) -> tuple[sp.Expr, ...]:
        """The equations of the loop: each rod keeps its length."""
        return tuple(
            square(placed.corner(leg, k) - leg.leg.end())
            - sp.sympify(leg.leg.rod, strict=True) ** 2
            for k, leg in enumerate(self.legs)
        )


__all__ = ["TASK", "Placed", "Tripod", "Upright", "named_cosines", "sum_of_cosines"]
