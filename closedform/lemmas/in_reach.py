"""Keeps a point within reach of two links where two solutions of a quartic nearly meet.

There a rounding error of the target turns the joint by the root of that error, or by its third root
where three solutions meet.  The joint that the quartic determines with it, the direction in which
three parallel axes turn an offset, and so the point that two links have to reach, are then wrong by
more than rounding, and a stretched or folded elbow seems to be out of reach.  Of the turns of the
joint that the target does not distinguish, one is taken for which the links reach.  If the axis of
the joint is parallel to those of the links, it distinguishes none.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import sympy as sp

from closedform.lemmas.chain import Chain
from closedform.lemmas.pairs import direction
from closedform.lemmas.quartic import OnCircle
from closedform.model.functions import choose, sign_of
from closedform.model.lemma import label
from closedform.model.pair import Pair
from closedform.model.tolerances import ROUNDING

UNDISTINGUISHED = ROUNDING / 16
"""By how much rounding may move a point of the circle, in units of the terms it is a sum of."""
FARTHEST = sp.Max(sp.Rational(1, 2**12), 2**11 * ROUNDING)
"""The largest turn of a step, far more than the third root of a rounding error."""
ALIGNED = ROUNDING / 4
"""The sine between two axes that count as parallel, more than the rounding of a direction."""
NEARLY = sp.Rational(1, 2**19)
"""The sine between two axes that may become parallel."""
LARGEST = sp.Rational(1, 2**6)
"""The largest turn that makes them parallel, or the offset free."""
SHORT = ROUNDING
"""By how much links have to be too short before it matters, in units of the size of the arm."""

FASTEST = 8
"""How fast an offset turns with the joint, at most, times the sine between axis and links."""

Turning = Callable[[Pair, Pair], tuple[sp.Matrix, sp.Matrix, sp.Matrix, sp.Matrix]]
"""What the pairs of both joints carry: a point q, an axis, where it is aimed, and an offset.

Three parallel axes turn the axis to its aim and the offset with it; two links reach q less that.
"""


def within_links(
    chain: Chain,
    x: sp.Symbol,
    pair: Pair,
    on_circle: OnCircle,
    carried: Turning,
    *,
    lengths: tuple[sp.Expr, sp.Expr],
) -> Pair:
    """The pair of a joint, turned by no more than rounding so that two links reach what follows.

    Parameters
    ----------
    chain
        the chain, which has solved for the joint by a quartic
    x
        the joint
    pair
        its pair
    on_circle
        the meaning of the quartic; the point is the pair of the other joint
    carried
        what follows from both pairs
    lengths
        those of the two links
    """
    start = _Place(chain, on_circle, carried, pair, f"{label(x)}_reach0")
    low, high = sp.Abs(lengths[0] - lengths[1]), sp.Add(*lengths)
    goal = start.let("goal", sp.Min(sp.Max(start.distance, low), high))
    away = start.let("away", start.distance - goal)
    loose = chain.program.vanishes(
        f"loose_{label(x)}",
        sp.Min(_too_short(start, away), _not_aimed(start)),
        sp.S.One,
        "the links seem to be too short or too long, or an axis is not where it is aimed",
    )
    chain.notes.append(
        "SINGULAR: where solutions nearly meet, and two links are stretched or folded, a joint is "
        "turned by no more than rounding so that they reach the target."
    )
    aligned = start.aligned().aligned()
    level = aligned.level()
    inside = level.inside(low, high, aligned.level_rate)
    found = start.secant(goal, away)
    far = start.far(goal)
    near = sp.And(aligned.beside <= NEARLY, sp.Abs(start.to_aligned) <= LARGEST)
    places = (
        (far, sp.And(start.moved <= LARGEST, far.wrong <= 1)),
        (aligned, sp.And(near, aligned.wrong <= 1)),
        *((p, sp.And(near, p.wrong <= 1, p.is_within(low, high))) for p in (level, inside)),
        # far from where solutions meet the turn is too small to matter
        (found, found.wrong <= 1),
        (start, True),
    )
    s, c = (
        start.let(name, sp.Piecewise(*((getattr(p.pair, name), taken) for p, taken in places)))
        for name in ("s", "c")
    )
    kept = Pair(choose(loose, s, pair.s), choose(loose, c, pair.c))
    kept = kept.known_as(chain.program, f"_reached{label(x)}")
    chain.meaning |= {kept.s: sp.sin(x), kept.c: sp.cos(x)}
    chain.values[x] = kept.angle
    return kept


def _too_short(start: _Place, away: sp.Expr) -> sp.Expr:
    """Not positive if links are too short or too long, and a turn by rounding may change that.

    The offset turns faster than the joint, the more so the nearer its axis is to being parallel.
    """
    short = start.let("short", sp.Abs(away) / start.chain.size)
    movable = short * start.aside - 2 * FASTEST * start.undistinguished
    freely = sp.Min(start.moved, start.aside / 2) - LARGEST
    return sp.Max(SHORT - short, sp.Min(movable, freely))


def _not_aimed(start: _Place) -> sp.Expr:
    """Not positive if the axis is nearly parallel, but not as much as its aim."""
    return sp.Max(ALIGNED - sp.Abs(start.too_far), start.aside - NEARLY)


@dataclass(frozen=True)
class _Place:
    """A turn of the joint, and what follows from it.  Names end in ``name``."""

    chain: Chain
    on_circle: OnCircle
    carried: Turning
    pair: Pair
    name: str

    def let(self, name: str, value: sp.Expr) -> sp.Expr:
        return self.chain.let(f"{name}_{self.name}", value)

    def turned(self, turn: Pair, suffix: str) -> _Place:
        """Turned by the angle of a pair."""
        name = f"{self.name}{suffix}"
        pair = (self.pair + turn).known_as(self.chain.program, f"_{name}")
        return replace(self, pair=pair, name=name)

    def by(self, angle: sp.Expr, suffix: str) -> _Place:
        """Turned by the angle with this tangent."""
        name = f"{self.name}{suffix}"
        t = self.chain.let(f"t_{name}", angle)
        unit = self.chain.let(f"unit_{name}", sp.sqrt(1 + t**2))
        return self.turned(Pair(t / unit, 1 / unit), suffix)

    def _with_rates(
        self, name: str, value: Callable[[Pair], sp.Matrix], pair: Pair
    ) -> list[list[sp.Expr]]:
        """The first two entries of a vector that is linear in the pair, and both derivatives."""
        s, c = sp.Dummy("s"), sp.Dummy("c")
        here = {s: pair.s, c: pair.c}
        rows = []
        for k, e in enumerate(value(Pair(s, c))[:2]):
            e = sp.sympify(e, strict=True)
            by_s, by_c = e.diff(s), e.diff(c)
            values = (
                e.xreplace(here),
                by_s * pair.c - by_c * pair.s,
                -by_s * pair.s - by_c * pair.c,
            )
            rows.append([self.let(f"{name}{k}{i}", v) for i, v in enumerate(values)])
        return rows

    @cached_property
    def point(self) -> list[list[sp.Expr]]:
        return self._with_rates("point", self.on_circle.point, self.pair)

    @cached_property
    def missed(self) -> sp.Expr:
        """How far the point is from the unit circle."""
        (x, *_), (y, *_) = self.point
        return self.let("missed", sp.sqrt(x**2 + y**2) - self.on_circle.radius)

    @cached_property
    def rounding(self) -> sp.Expr:
        """By how much rounding may move the point: the terms are at least its derivatives."""
        terms = sp.Add(*(sp.Abs(e) for row in self.point for e in row))
        return self.let("rounding", UNDISTINGUISHED * (1 + terms))

    @cached_property
    def _other(self) -> Pair:
        (x, *_), (y, *_) = self.point
        r = self.let("r", sp.sqrt(x**2 + y**2))
        return direction(y, x, r, sp.Eq(r, 0)).known_as(self.chain.program, f"_other_{self.name}")

    @cached_property
    def _across(self) -> list[list[sp.Expr]]:
        """What both pairs carry, seen along the parallel axes."""
        names = ("q", "along", "aimed", "offset")
        carried = zip(names, self.carried(self.pair, self._other), strict=True)
        return [[self.let(f"{n}{k}", m[k]) for k in (0, 1)] for n, m in carried]

    @cached_property
    def distance(self) -> sp.Expr:
        """How far from each other the links have their ends."""
        (x, y), (a, b), (u, v), (e, f) = self._across
        sine, cosine = self.let("cross", a * v - b * u), self.let("dot", a * u + b * v)
        length = self.let("length", sp.sqrt(sine**2 + cosine**2))
        lift = direction(sine, cosine, length, sp.Eq(length, 0))
        s, c = self.let("lift_s", lift.s), self.let("lift_c", lift.c)
        dx, dy = self.let("dx", x - c * e + s * f), self.let("dy", y - s * e - c * f)
        return self.let("distance", sp.sqrt(dx**2 + dy**2))

    def is_within(self, low: sp.Expr, high: sp.Expr) -> sp.Basic:
        """Whether the links reach."""
        return sp.And(low <= self.distance, self.distance <= high)

    @cached_property
    def wrong(self) -> sp.Expr:
        """By how much more than rounding the place misses the target.

        The point is on its circle, and the axis is as far from being parallel as its aim.
        """
        missed, turned = sp.Abs(self.missed), sp.Abs(self.too_far)
        return self.let("wrong", sp.Max(missed / self.rounding, turned / ALIGNED))

    @cached_property
    def aside(self) -> sp.Expr:
        """The sine between the axis and those that are parallel, where the other joint turns it."""
        _, (a, b), _, _ = self._across
        return self.let("aside", sp.sqrt(a**2 + b**2))

    @cached_property
    def too_far(self) -> sp.Expr:
        """By how much the axis is farther from being parallel than its aim."""
        _, _, (u, v), _ = self._across
        return self.let("turned", self.aside - sp.sqrt(u**2 + v**2))

    @cached_property
    def _aim(self) -> list[list[sp.Expr]]:
        return self._with_rates("aim", lambda pair: self.carried(pair, self._other)[2], self.pair)

    @cached_property
    def beside(self) -> sp.Expr:
        """The sine between the axis and those that are parallel."""
        (x, *_), (y, *_) = self._aim
        return self.let("beside", sp.sqrt(x**2 + y**2))

    @cached_property
    def to_aligned(self) -> sp.Expr:
        """The turn to where the axis is nearest to those that are parallel."""
        (x, dx, _), (y, dy, _) = self._aim
        size = self.let("aim_rate", dx**2 + dy**2)
        turn = choose(sp.Eq(size, 0), 1, -(x * dx + y * dy) / size)
        return self.let("to_aligned", turn)

    def aligned(self) -> _Place:
        """Turned to there, as if the turn were small."""
        return self.by(sp.Max(-1, sp.Min(1, self.to_aligned)), "a")

    @cached_property
    def level_rate(self) -> sp.Expr:
        """The rate of half of the square of the axis' sine less that of its aim."""
        other = self._other
        axes = self._with_rates("axis", lambda pair: self.carried(self.pair, pair)[1], other)
        ((a, da, _), (b, db, _)), ((u, du, _), (v, dv, _)) = axes, self._aim
        (x, dx, _), (y, dy, _) = self.point
        swing = self.let("swing_other", (x * dy - y * dx) / (x**2 + y**2))
        return self.let("level_rate", (a * da + b * db) * swing - u * du - v * dv)

    def level(self) -> _Place:
        """Turned so that the axis is as far from being parallel as its aim, as if it were linear.

        Where three solutions nearly meet, this is the one in the middle, if the axis is nearly
        parallel here.
        """
        _, (a, b), _, _ = self._across
        (u, *_), (v, *_) = self._aim
        rate = self.level_rate
        excess = self.let("level_off", (u - a) * (u + a) + (v - b) * (v + b))
        turn = choose(sp.Eq(rate, 0), 0, excess / (2 * rate))
        return self.by(sp.Max(-1, sp.Min(1, turn)), "l")

    def inside(self, low: sp.Expr, high: sp.Expr, rate: sp.Expr) -> _Place:
        """Turned by what the target does not distinguish, so that the links reach with some play.

        A nearly parallel axis turns the offset much faster than the joint turns.
        """
        most = self.let("play", choose(sp.Eq(rate, 0), 0, ALIGNED * self.beside / 2 / sp.Abs(rate)))
        goal = self.let("inside", sp.Min(sp.Max(self.distance, low), high))
        away = self.let("outside", self.distance - goal)
        ahead = self.by(most, "i")
        change = self.let("change", ahead.distance - self.distance)
        t = choose(sp.Abs(change) <= 2 * sp.Abs(away), 0, -2 * away / change)
        return self.by(most * t, "j")

    @cached_property
    def moved(self) -> sp.Expr:
        """By how much turns move the point: little if the joint is nearly parallel to the links."""
        rates = [e**2 for row in self.point for e in row[1:]]
        return self.let("moved", sp.sqrt(sp.Add(*rates)))

    def far(self, goal: sp.Expr) -> _Place:
        """Turned by any angle so that the distance is the goal, for a joint parallel to the links.

        There the square of the distance is a cosine of the turn, which three values determine.
        """
        side = self.turned(Pair(sp.S.One, sp.S.Zero), "q")
        back = self.turned(Pair(sp.S.Zero, -sp.S.One), "h")
        here, behind = self.distance**2, back.distance**2
        mean = self.let("mean", (here + behind) / 2)
        a = self.let("swing_c", (here - behind) / 2)
        b = self.let("swing_s", side.distance**2 - mean)
        h = self.let("swing", sp.sqrt(a**2 + b**2))
        w = self.let("wanted", sp.Max(-h, sp.Min(goal**2 - mean, h)))
        root = self.let("swing_root", sign_of(b) * sp.sqrt(sp.Max(0, (h - w) * (h + w))))
        turn = direction((b * w - a * root) / h, (a * w + b * root) / h, h, sp.Eq(h, 0))
        return self.turned(turn, "r")

    @cached_property
    def undistinguished(self) -> sp.Expr:
        """The largest turn that moves the point along the circle up to rounding."""
        (x, dx, ddx), (y, dy, ddy) = self.point
        rate = self.let("rate", x * dx + y * dy)
        bend = self.let("bend", sp.Abs(dx**2 + dy**2 + x * ddx + y * ddy))
        R = self.rounding
        whole = self.let("whole", sp.Abs(rate) + sp.sqrt(rate**2 + 2 * bend * R))
        most = self.let("farthest", FARTHEST)
        return self.let("most", choose(whole * most <= 2 * R, most, 2 * R / whole))

    def secant(self, goal: sp.Expr, away: sp.Expr) -> _Place:
        """Turned so far that the distance is the goal, as if it were linear in the turn."""
        most = self.undistinguished
        ends = [(k * most, self.by(k * most, n)) for k, n in ((1, "p"), (-1, "m"))]
        (t1, g1), (t2, g2) = ((t, place.let("gap", place.distance - goal)) for t, place in ends)
        side = self.let("side", sign_of(away))
        first = self.let("one", g1 * side) <= self.let("two", g2 * side)
        t = self.let("turn", sp.Piecewise((t1, first), (t2, True)))
        gap = self.let("gap", sp.Piecewise((g1, first), (g2, True)))
        crosses = self.let("beyond", gap * side) < 0
        over = self.let("over", choose(crosses, away - gap, 1))
        t = self.let("inside", choose(crosses, t * away / over, 0))
        near = self.by(t, "n")
        gap = near.let("gap", near.distance - goal)
        apart = sp.Abs(away - gap) > sp.Abs(away) / 2
        over = near.let("over", choose(apart, away - gap, 1))
        t = self.let("nearer", choose(apart, t * away / over, t))
        return self.by(t, "f")


__all__ = ["within_links"]
