"""Three legs that are hinged on the hand, as in a 3-SPR mechanism: the reverse of a tripod.

A leg stays in a plane of the hand, and its base in this plane.  The three planes meet in a line of
the hand.  As in a tripod the weighted sum of the three conditions gives the twist of the hand, and
two of them are then linear in its position.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Leg, Stretch, cross_in_plane, vector
from closedform.loops.guides import Placed, polar
from closedform.loops.hinges import TILTED, Frame, Hinged, Hinges
from closedform.loops.leg_by_leg import named, named_in
from closedform.loops.tripod_legs import named_cosines
from closedform.mechanics.frames import rotation
from closedform.model.functions import Program, choose, real

COUNT = 3
FOLLOWS = (real("follow_1"), real("follow_2"))
"""The rates of the twist per rate of each tilt, whatever they are."""
PSI = real("psi")
"""The twist of the hand about its own z axis, which follows from the target."""
DELTA = real("delta")
"""The amplitude of the equation of the twist."""


@dataclass(frozen=True)
class ThreeHinges(Hinges):
    """Three legs that stretch, each with a ball joint on the ground and a hinge on the hand.

    The axes ``on_hand`` are horizontal in the frame of the hand, no two of them are parallel, and
    the planes of the legs meet in a line of the hand.  The target is that of a tripod: the height
    z of the hand, and its tilts.  The twist of the hand and its motion sideways follow.
    """

    pivot: Sequence[sp.Expr] = (0, 0, 0)
    side: int = 1
    """The sign of the second sum if the hand is level and not twisted; found from the legs."""

    what: ClassVar[str] = "three hinged legs"
    degree: ClassVar[int] = 16
    nothing: ClassVar[sp.Expr] = sp.Rational(1, 2**80)
    fixes: ClassVar[str] = "place or the twist"
    divides: ClassVar[str] = (
        "Gamma, which divides what two hinges fix, or tau, the amplitude delta of the equation of "
        "the twist over the sum of the coordinates of the bases,"
    )
    left_out: ClassVar[str] = (
        "Where the twist of the hand is free it is taken as 0.  Left out: the postures in which "
        "the hand is twisted by another half turn."
    )
    motion: ClassVar[str] = (
        "Each tilt turns the hand about an axis a: that of the tilt, and the z axis of the hand "
        "times the rate with which the twist follows, which is minus the derivative of f*cos(psi) "
        "+ g*sin(psi) with respect to the tilt, over delta.  It moves the point of the hand by w.  "
        "So an entry of A is the part of w along r_i, the vector along rod i, and the moment about "
        "a of r_i at e_i, which leads from the point of the hand to the end of rod i"
    )

    @property
    def coordinates(self) -> tuple[sp.Symbol, ...]:
        return (real("x"), real("y"), *TILTED[:3])

    @property
    def solved(self) -> dict[sp.Symbol, sp.Matrix]:
        return dict(zip(self.coordinates[:2], (sp.eye(3).col(0), sp.eye(3).col(1)), strict=True))

    @property
    def own(self) -> tuple[str, ...]:
        return (*super().own, "twist")

    @property
    def weights(self) -> tuple[sp.Expr, ...]:
        """Factors with which the axes of the hinges add up to zero."""
        axes = [h.axis for _, h in self.hinged]
        return tuple(
            sp.simplify(cross_in_plane(axes[(k + 1) % 3], axes[(k + 2) % 3])) for k in range(3)
        )

    @property
    def tilted(self) -> sp.Matrix:
        """The rotation without the twist."""
        _, a, b, _ = TILTED
        return rotation("y", b) * rotation("x", a)

    def balance(self, turned: bool) -> sp.Expr:
        """The sum over the legs of weight*m*base, for the axes m and for m turned by 90 degrees.

        With the twist psi, the first times cos(psi) plus the second times sin(psi) vanishes.
        """
        total = sp.S.Zero
        for weight, (_, h) in zip(self.weights, self.hinged, strict=True):
            x, y, _ = h.axis
            m = sp.Matrix([-y, x, 0] if turned else [x, y, 0])
            total += self.side * weight * (self.tilted * m).dot(h.leg.base)
        return sp.collect(sp.expand(total), [sp.cos(t) for t in TILTED[1:3]])

    def with_legs(self, name: str, legs: Sequence[Leg | Hinged]) -> ThreeHinges:
        hinged = [(k, h) for k, h in enumerate(legs) if isinstance(h, Hinged) and h.on_hand]
        if not len(hinged) == len(legs) == COUNT:
            raise ShapeError(f"{name}: all three legs are Hinged, with an axis on_hand")
        for _, h in hinged:
            h.check(name)
            if not isinstance(h.leg, Stretch):
                raise ShapeError(
                    f"{name}: a leg with a hinge on the hand must be a Stretch, so that its ball "
                    f"joint stands still"
                )
            if h.axis[2] != 0:
                raise ShapeError(
                    f"{name}: the hinge of {h.leg.joint} has to be horizontal in the frame of the "
                    f"hand"
                )
        found = replace(self, hinged=tuple(hinged))
        if 0 in found.weights:
            raise ShapeError(f"{name}: two hinges are parallel; they need three directions")
        off = [h.axis.dot(vector(h.leg.on_hand or (0, 0, 0))) for _, h in hinged]
        if sp.simplify(sum(w * e for w, e in zip(found.weights, off, strict=True))) != 0:
            raise ShapeError(
                f"{name}: the planes of the three legs, which are normal to their hinges, have to "
                f"meet in a line of the hand"
            )
        level = sp.simplify(found.balance(turned=True).subs(dict.fromkeys(TILTED, 0)))
        if not (level.is_positive or level.is_negative):
            raise ShapeError(
                f"{name}: the bases of the legs do not determine how the hand is twisted at rest; "
                "write their coordinates with positive parameters"
            )
        return replace(found, side=1 if level.is_positive else -1)

    @property
    def reach(self) -> sp.Expr:
        """The sum of the distances of the bases from the axes of the ground."""
        return sp.Add(*(sp.Abs(e) for _, h in self.hinged for e in h.leg.base))

    def frame(self, p: Program, *, guarded: bool = False) -> Frame:
        sums = named_cosines(p, TILTED[1:3], *(self.balance(turned) for turned in (False, True)))
        f, g = (p.let(name, e) for name, e in zip("fg", sums, strict=True))
        meaning = "the twist of the hand is free"
        link = polar(p, (PSI, DELTA), (g, -f), meaning, sp.S.Zero if guarded else None)
        c, s, delta = (
            next(name for name, e in link.means.items() if e == value)
            for value in (sp.cos(PSI), sp.sin(PSI), DELTA)
        )
        over = choose(link.degenerate[0].flags[0], 1, delta) if guarded else delta
        follows = [p.let(f"twist_{t}", -self.rest(c, s).diff(t) / over) for t in TILTED[1:3]]
        fixed = (delta / self.reach,)
        return replace(self.turned(p, (c, s), follows), fixed=fixed, links=(link,))

    def rest(self, c: sp.Expr, s: sp.Expr) -> sp.Expr:
        """What vanishes for the correct twist, from its cosine and sine."""
        return self.balance(turned=False) * c + self.balance(turned=True) * s

    def turned(
        self, p: Program, twist: tuple[sp.Expr, sp.Expr], follows: Sequence[sp.Expr]
    ) -> Frame:
        """The hand from the cosine and sine of its twist, and how the twist follows the tilts."""
        z, _, tilt_y, _ = TILTED
        (c, s), up = twist, sp.eye(3).col(2)
        first, second, third = (self.tilted.col(k) for k in range(3))
        R = p.matrix("R", sp.Matrix.hstack(c * first + s * second, c * second - s * first, third))
        none, about = sp.zeros(3, 1), (rotation("y", tilt_y).col(0), sp.eye(3).col(1))
        axes = [
            named(p, letter, axis + follow * R.col(2))
            for letter, axis, follow in zip("ab", about, follows, strict=True)
        ]
        return Frame(rotation=R, axes=(none, *axes), shift=z * up, moves=(up, none, none))

    def width(self, at: Frame, M: sp.Matrix) -> sp.Expr:
        return self.weights[2] * at.rotation[2, 2]

    def ends(
        self, p: Program, shift: sp.Matrix, levers: Sequence[sp.Matrix]
    ) -> tuple[sp.Matrix, ...]:
        far = (enumerate(shift + lever, 1) for lever in levers)
        return tuple(
            sp.Matrix([named_in(p, f"f_{k}{i}", e) for i, e in entries])
            for k, entries in enumerate(far, 1)
        )

    def posture(self, places: Sequence[sp.Matrix]) -> Placed:
        """The hand at a target with any twist, which follows the tilts in any way."""
        p = Program()
        return self.placed(p, places, self.turned(p, (sp.cos(PSI), sp.sin(PSI)), FOLLOWS)).explicit(
            p
        )

    def rate(self, value: sp.Matrix, x: sp.Symbol) -> sp.Matrix:
        found = value.diff(x)
        for tilt, follow in zip(TILTED[1:3], FOLLOWS, strict=True):
            if x == tilt:
                found += follow * value.diff(PSI)
        return found


__all__ = ["FOLLOWS", "PSI", "ThreeHinges"]
