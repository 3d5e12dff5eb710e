"""The free turn of a straight virtual arm, which keeps the real arms of the H6AR within reach."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import sympy as sp
from closedform.derivations.h6ar_mechanism import (
    L_2W,
    Dimensions,
    L_theta,
    Pair,
    a_3W,
    pair,
    reach,
    theta2A,
    theta23A,
)
from sympy import Rational, sqrt

from closedform import Derivation, Program, choose, real, sign_of, used_up

WIDER = 2**7
"""The root of how many tolerances a turn may take at a tangent waist, where three events meet."""
EVENTS = 2**2
"""By how many tolerances real arms may be beyond a limit elsewhere, where errors add."""


class Correction(NamedTuple):
    """How small turns make an area large enough that is too small by rounding.

    ``spent`` says that the area has no margin left.  The upper arm turns by ``aside``, after which
    ``missing`` of the area is still lacking.  The free turn adds ``slope`` per radian and moves the
    tip by ``tip_rate`` per radian, in units of the scale of the tolerance.  ``floor`` is smaller
    than any slope that matters.
    """

    spent: sp.Symbol
    aside: sp.Symbol
    missing: sp.Symbol
    slope: sp.Symbol
    tip_rate: sp.Symbol
    usual_rates: Sequence[sp.Symbol]
    floor: sp.Expr

    def strain(self, turn: sp.Expr) -> sp.Expr:
        """How far a free turn and the one aside move the tip, in units of the usual tolerance."""
        free, aside = self.usual_rates
        return 2**40 * (free * sp.Abs(turn) + aside * sp.Abs(self.aside))

    def linear_turn(self) -> sp.Expr:
        """The free turn if the area is linear in it."""
        return sign_of(self.slope) * self.allowed(self.missing / (sp.Abs(self.slope) + self.floor))

    def allowed(self, turn: sp.Expr) -> sp.Expr:
        """The turn, or 0 if it is negative or moves the tip by more than the tolerance."""
        little = sp.And(turn > 0, turn * self.tip_rate <= Rational(1, 2**40))
        return sp.Piecewise((turn, little), (0, True))


@dataclass(frozen=True)
class FreeTurn:
    """The turn of the virtual fore-arm that leaves the tip where it is.

    If the virtual arm with the wrist is straight, rounding of the target decides how far it bends.
    Real arms at their own limit may then seem to be beyond it.  All postures that differ by a small
    turn of the virtual fore-arm reach the target equally well, so one that exists is taken.  In
    exact arithmetic the turn is zero.

    The free turn by t moves the tip by ``tilt`` times t.  It does so along the upper arm, and the
    fore-arm turns by t.  If the waist is tangent and the virtual arm bent, it does so away from the
    waist axis, and the waist turns too, which leaves the tip where it is.  Then the fore-arm turns
    by ``fore`` times t, and the upper arm by ``aside`` times t besides.
    """

    program: Program
    m: Dimensions
    slack: sp.Symbol
    tilt: sp.Symbol
    drawn: sp.Symbol
    fore: sp.Expr = sp.S.One
    aside: sp.Expr = sp.S.Zero
    left: sp.Expr = sp.S.One
    """The share of the way of the tip that the waist does not make up for."""
    curve: sp.Expr = sp.S.Zero
    """The same of half of the square of the way."""
    wider: sp.Expr = sp.S.One
    """Turns may miss the tip by the square of this times the tolerance; SINGULAR says so."""
    leniency: sp.Expr = sp.S.One
    """Real arms may be beyond their limits by this many tolerances; SINGULAR says so."""

    def upper_turn(self, turn: sp.Expr, aside: sp.Expr) -> sp.Expr:
        """The tangent of the turn of the upper arm that belongs to a free turn."""
        fore = self.fore * turn
        return fore - self.drawn * fore / self.m.L1 + self.aside * turn + aside

    def correction(
        self,
        name: str,
        margin: sp.Symbol,
        slopes: tuple[sp.Symbol, sp.Symbol],
        scale: sp.Expr,
        meaning: str,
    ) -> Correction:
        """The turns that make an area ``margin`` large enough; ``scale`` is its natural size.

        ``slopes`` are the rates of the area for the free turn and for a turn of the upper arm
        aside.  Each turn takes a share, in proportion to what it can add within the tolerance of
        the tip.
        """
        let, fore = self.program.let, sqrt(L_2W**2 + a_3W**2)
        # how far each turn moves the tip, by itself and by its square, in units of the tolerance
        upper = self.upper_turn(sp.S.One, sp.S.Zero)
        square = self.m.L1 * upper**2 + fore * self.fore**2 + self.curve * self.tilt**2
        squares = (square, self.m.L1)
        ways = list(zip((self.left * sp.Abs(self.tilt), self.m.L1), squares, strict=True))
        spent = self.program.vanishes(
            f"spent_{name}", used_up(margin), scale, f"no margin left: {meaning}"
        )

        def rate(by: sp.Expr, square: sp.Expr, wider: sp.Expr) -> sp.Expr:
            root = sqrt(self.slack * square / 2) / 10**6
            return (by + wider * root) / (wider**2 * self.slack)

        kinds = {"heavy": self.wider} | ({} if self.wider == 1 else {"usual": sp.S.One})
        tip_rates, *usual = (
            [
                let(f"{kind}_{k}_{name}", choose(spent, rate(*way, wider), 1))
                for k, way in enumerate(ways)
            ]
            for kind, wider in kinds.items()
        )
        gains = [
            let(f"gain_{k}_{name}", choose(spent, sp.Abs(s) / e, 0))
            for k, (s, e) in enumerate(zip(slopes, tip_rates, strict=True))
        ]
        play = let(f"play_{name}", scale + choose(spent, sum(gains), 0))
        self.program.bound(f"kept_{name}", margin, choose(spent, self.leniency, 1) * play, meaning)
        share = gains[1] ** 2 / (gains[0] ** 2 + gains[1] ** 2 + scale**2)
        share = let(f"share_{name}", choose(spent, sp.Piecewise((share, margin < 0), (0, True)), 0))
        floors = [scale * e / 2**24 for e in tip_rates]
        aside = -sign_of(slopes[1]) * share * margin / (sp.Abs(slopes[1]) + floors[1])
        aside = let(f"aside_{name}", choose(spent, aside, 0))
        return Correction(
            spent=spent,
            aside=aside,
            missing=let(f"lack_{name}", margin * (share - 1)),
            slope=slopes[0],
            tip_rate=tip_rates[0],
            usual_rates=usual[0] if usual else tip_rates,
            floor=floors[0],
        )

    def turn(self, name: str, corrections: Sequence[tuple[Correction, sp.Expr]]) -> sp.Symbol:
        """A free turn that makes every area large enough, as far as possible.

        Each correction comes with the coefficient of the square of the turn in its area.
        """
        let = self.program.let
        spent = sp.Or(*(correction.spent for correction, _ in corrections))
        sides = []
        for side, sign in (("on", 1), ("back", -1)):
            turn, ends = sp.S.Zero, []
            for k, (e, curve) in enumerate(corrections):
                slope = sign * e.slope
                root = sqrt(sp.Max(0, e.slope**2 + 4 * e.missing * curve))
                root = let(f"root_{side}_{k}_{name}", choose(spent, root, 0))
                near = e.allowed(2 * e.missing / (slope + root + e.floor))
                far = e.allowed((root - slope) / (2 * sp.Max(curve, 0) + e.floor / 2**24))
                ends.append(let(f"far_{side}_{k}_{name}", choose(spent, far, 0)))
                first = sp.Piecewise((near, slope >= 0), (ends[-1], e.missing > 0), (0, True))
                turn = sp.Max(turn, first)
            turn = let(f"near_{side}_{name}", choose(spent, turn, 0))

            def grown(t: sp.Expr, k: int) -> sp.Expr:
                e, curve = corrections[k]
                return t * (sign * e.slope + curve * t) - e.missing  # noqa: B023

            needs = [sp.Piecewise((t, grown(turn, k) < 0), (0, True)) for k, t in enumerate(ends)]
            turn = let(f"turn_{side}_{name}", choose(spent, sp.Max(turn, *needs), 0))
            least = sp.Min(*(grown(turn, k) for k in range(len(corrections))))
            sides.append((turn, let(f"left_{side}_{name}", choose(spent, least, 0))))
        (on, on_left), (back, back_left) = sides
        turn = sp.Piecewise((on, on_left >= back_left), (-back, True))
        return let(f"turn_{name}", choose(spent, turn, 0))


def turned_by(tangent: sp.Expr) -> Pair:
    """The pair of an angle between -pi/2 and pi/2 from its tangent."""
    length = sqrt(1 + tangent**2)
    return Pair(tangent / length, 1 / length)


def moved_by(tangent: sp.Expr, e: sp.Matrix) -> sp.Matrix:
    """How far such a turn moves a point, accurate for small turns too."""
    turn = turned_by(tangent)
    return sp.Matrix([-turn.s * e[1], turn.s * e[0]]) - turn.s**2 / (1 + turn.c) * e


def bent_whole(m: Dimensions, bend: Pair) -> tuple[sp.Expr, sp.Expr]:
    """Of the virtual arm with the wrist: its fore-arm across its upper arm, and all along it."""
    return L_2W * bend.c - a_3W * bend.s, m.L1 + L_2W * bend.s + a_3W * bend.c


def free_turn(program: Program, m: Dimensions, bend: Pair, slack: sp.Symbol) -> FreeTurn:
    """The free turn of a virtual arm from the angle of its elbow."""
    tilt, drawn = bent_whole(m, bend)
    return FreeTurn(program, m, slack, program.let("tilt", tilt), program.let("drawn", drawn))


def with_waist(free: FreeTurn, upper: Pair, outward: sp.Expr) -> tuple[FreeTurn, sp.Expr]:
    """The free turn, with the waist where this is tangent, and the rate of the waist.

    The tip is ``outward`` from the waist axis in the mid-plane, and L_theta beside this plane.
    """
    let = free.program.let
    tangent = sp.And(
        sp.Symbol("tangent"),
        16 * sp.Abs(outward) <= sp.Abs(L_theta),
        sp.Abs(free.tilt) >= free.m.L1 / 2**20,
    )
    not_stretched = sp.Not(sp.Symbol("stretched"))
    lenient = sp.And(sp.Symbol("tangent"), not_stretched)
    far = sqrt(outward**2 + L_theta**2) + free.slack / 2**60
    free = replace(
        free,
        fore=let("fore_rate", choose(tangent, upper.c, 1)),
        aside=let("aside_rate", choose(tangent, -upper.s * free.tilt / free.m.L1, 0)),
        left=let("left_rate", choose(tangent, sp.Abs(outward) / far, 1)),
        curve=let("left_curve", choose(tangent, 1 / far, 0)),
        wider=let("wider", choose(sp.And(tangent, not_stretched), WIDER, 1)),
        leniency=let("leniency", choose(lenient, WIDER**2, EVENTS)),
    )
    return free, choose(tangent, L_theta * free.tilt / far**2, 0)


def report_short_wrist(program: Program, m: Dimensions, at_limit: sp.Basic) -> None:
    """Report SINGULAR at a limit where a short wrist lets an answer miss more than is promised."""
    by_wrist, lengths = real("by_wrist", nonnegative=True), sum(m)
    program.determined(
        choose(at_limit, lengths - 4 * by_wrist, lengths),
        lengths,
        "the waist is tangent, or a sine at its limit, while the wrist is short",
    )


def turn_step(d: Derivation, m: Dimensions) -> None:
    """Add the step of the derivation that explains the free turn."""
    tilt, drawn = bent_whole(m, pair(theta23A - theta2A))
    p = reach(m, pair(theta2A), pair(theta23A), L_2W, a_3W)
    rate = p.diff(theta23A) + (1 - drawn / m.L1) * p.diff(theta2A)
    d.step(
        "Straight virtual arm, arms at their limit",
        "If the virtual fore-arm turns by t and the virtual upper arm by (1 - drawn / L1) t, the "
        "tip moves by R_perp t along the upper arm.  If the virtual arm with the wrist is "
        "straight, R_perp is zero.  A rounding error of the target then turns the arm by as much "
        "as the square root of that error, and a real arm at its own limit may seem to be beyond "
        "it.  In that case the virtual arm is turned back.  In exact arithmetic this turn is zero.",
        {r"R_\parallel": drawn, r"R_\perp": tilt},
        proves="If the wrist turns with the fore-arm, the rate of the tip is R_perp along the "
        "upper arm.",
        equal=[(rate, tilt * pair(theta2A).unit)],
    )


def as_published(d: Derivation, m: Dimensions) -> None:
    """Add the step with the paper's formula for the elbow, and why the code uses another."""
    d.write("theta3A", r"\theta_3^A", "angle from the virtual upper arm to the virtual fore-arm")
    d.write("L_3A", "L_{3A}", "square of the reach minus the squares of the links")
    elbow, L_3A = real("theta3A"), real("L_3A")
    end = reach(m, pair(theta2A), pair(theta23A), L_2W, a_3W)
    fore = sp.sqrt(L_2W**2 + a_3W**2)
    cosines = 2 * m.L1 * (L_2W * sp.sin(elbow) + a_3W * sp.cos(elbow))
    d.step(
        "Inverse: the law of cosines",
        "The links of the virtual arm and its reach form a triangle.  The square of the reach "
        "minus the squares of the links is L_3A, which depends on the elbow alone.  The paper "
        "solves this with two arcsines, and takes the shoulder from a quotient, eq. (14).  An "
        "arcsine has one value where there are two elbows, and it loses half its digits where the "
        "arm is straight.  A quotient does not distinguish opposite directions.  So the code uses "
        "the lemma of the two-link arm, which gives all signs and computes arctangents.",
        {
            "L_{3A}": cosines,
            r"\theta_3^A": sp.asin(L_3A / (2 * m.L1 * fore)) - sp.asin(a_3W / fore),
        },
        published=("(13)",),
        proves="The square of the reach is the sum of the squares of the links and L_3A.",
        equal=[
            (
                end.dot(end) - m.L1**2 - L_2W**2 - a_3W**2,
                cosines.xreplace({elbow: theta23A - theta2A}),
            )
        ],
        solves={"ik": [theta2A, theta23A]},
    )
