"""A hand in a plane on two rails and a third leg: up to four assembly modes.

Seen from the ground, a hand whose two points are on lines is a trammel: its position follows from
its yaw, and any other point of it is on an ellipse.  The end of the third leg is also on a circle,
and both curves meet four times.  If the rails are parallel, they determine the yaw, up to a sign,
and the end of the third leg is on a line.  If the ellipse is a circle, two circles meet.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import sympy as sp

from closedform.lemmas.legs import Slide, Stretch, cross_in_plane, turned_left
from closedform.lemmas.missed import MOVED
from closedform.lemmas.quartic import OnCircle, quartic_in
from closedform.lemmas.rails import Rail, rail_and_circle, two_rails
from closedform.loops.hand import square
from closedform.loops.leg_by_leg import SIGN, named, named_in, named_rod, record_lemma, size_of
from closedform.loops.modes import export
from closedform.loops.platform_legs import Platform, Posture, jacobians, matrices, pull_of
from closedform.loops.points import NEAR
from closedform.loops.yaw import never_free, yaw_by_amplitude
from closedform.model.functions import Program, branches, choose, real
from closedform.model.inverse import Combination, Inverse, Link
from closedform.model.pair import Pair
from closedform.model.step import Step

RAILS = 2
LINE, SIDE = real("sigma_line"), real("sigma_side")
LINES = {1: "first", -1: "second"}
TURN, ROD = real("sigma_turn"), real("sigma_rod")


@dataclass(frozen=True)
class TwoRails:
    """The two legs of a hand with rails, and the third one, by their places in the order."""

    m: Platform
    rails: tuple[int, int]
    third: int

    @classmethod
    def of(cls, m: Platform) -> TwoRails | None:
        """The same of a hand, if it is of this kind."""
        if m.dimensions != 2:
            return None
        held = [k for k, leg in enumerate(m.legs) if isinstance(leg, Rail)]
        if len(held) != RAILS:
            return None
        (other,) = {0, 1, 2} - {*held}
        return cls(m, (held[0], held[1]), other)

    @property
    def legs(self) -> tuple[Rail, Rail]:
        first, second = (self.m.legs[k] for k in self.rails)
        assert isinstance(first, Rail)
        assert isinstance(second, Rail)
        return first, second

    @cached_property
    def across(self) -> sp.Expr:
        """The sine of the angle between the rails."""
        first, second = self.legs
        return sp.simplify(cross_in_plane(first.way, second.way))

    @property
    def parallel(self) -> bool:
        return bool(self.across == 0)

    def met(self, first: sp.Expr, second: sp.Expr) -> sp.Matrix:
        """The point at two distances from the rails through the origin, along their normals."""
        one, other = self.legs
        return (first * other.way - second * one.way) / self.across

    @cached_property
    def curve(self) -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
        """The path of the third end, from the near end of its rod: u + v cos(yaw) + w sin(yaw)."""
        m, legs = self.m, self.legs
        places = [m.places[k] for k in self.rails]
        last = m.places[self.third]

        def moved(ends: Sequence[sp.Matrix]) -> sp.Matrix:
            first, second = (leg.normal.dot(e) for leg, e in zip(legs, ends, strict=True))
            return self.met(first, second)

        at = moved([leg.end() for leg in legs]) - m.legs[self.third].end()
        cosine = last - moved(places)
        sine = turned_left(last) - moved([turned_left(e) for e in places])
        return at, cosine.applyfunc(sp.factor_terms), sine.applyfunc(sp.factor_terms)

    @cached_property
    def bend(self) -> tuple[sp.Expr, sp.Expr]:
        """The coefficients of cos(2 yaw) and sin(2 yaw) in the equation of the yaw."""
        _, v, w = self.curve
        return (
            sp.factor(sp.expand((square(v) - square(w)) / 2)),
            sp.factor(sp.expand(v.dot(w))),
        )

    @property
    def round(self) -> bool:
        """Whether the third end is on a circle, at all dimensions."""
        return not self.parallel and self.bend == (0, 0)

    @cached_property
    def level(self) -> tuple[sp.Matrix, tuple[sp.Expr, sp.Expr, sp.Expr]]:
        """Of parallel rails: the weights of the loop equations, and a, b and c of the yaw."""
        (first, second), m = self.legs, self.m
        same = sp.simplify(first.way.dot(second.way))
        weights = {self.rails[0]: sp.S.One, self.rails[1]: -same}
        total = [sp.S.Zero] * 3
        for k, leg in zip(self.rails, self.legs, strict=True):
            along, place = weights[k] * leg.normal, m.places[k]
            parts = turned_left(place), place, leg.end()
            total = [t + along.dot(v) for t, v in zip(total, parts, strict=True)]
        a, b, c = (sp.factor_terms(sp.expand(t)) for t in total)
        return sp.Matrix([[weights.get(k, 0) for k in range(3)]]), (a, b, c)

    def forward(self, loop: Step) -> Posture:
        """Derive and export ``fk``."""
        return _forward(self, loop)

    def export_rates(self, at: Posture) -> None:
        """Export what depends on the joints and the assembly mode."""
        m, d = self.m, self.m.d
        v = Program(list(at.program.body), at.program.taken)
        A, driven = at.rates(v, *at.vectors(v))
        volume = v.let("Delta", A.det())
        functions = [*matrices(m, A, driven, volume), *jacobians(m, v, A, driven, volume)]
        export(d, v, at.modes, functions)


@dataclass(frozen=True)
class _Turned:
    """How the yaw is found, the third rod then, and by what its equation was divided."""

    turn: Link
    pair: Pair
    rod: sp.Matrix
    why: str
    notes: tuple[str, ...]
    scale: sp.Expr = sp.S.One


@dataclass(frozen=True)
class _Found:
    """What a way of solving gives: the links, the hand and the third rod, in a mode."""

    links: tuple[Link, ...]
    matrix: sp.Matrix
    pair: Pair
    hand: sp.Matrix
    rod: sp.Matrix
    why: str
    shown: Mapping[str, sp.Expr]
    proves: str
    equal: tuple[tuple[sp.Expr, sp.Expr], ...]
    notes: tuple[str, ...] = ()


def _forward(on: TwoRails, loop: Step) -> Posture:
    m = on.m
    d, f = m.d, m.d.program()
    joints = [leg.joint for leg in m.legs if isinstance(leg, Slide | Rail)]
    stretched = [sp.Abs(leg.joint) for leg in m.legs if isinstance(leg, Stretch)]
    size = f.let("size", size_of(d, m.whole, joints) + sp.Add(*stretched))
    if on.parallel:
        modes, solve = branches((TURN, SIGN), (ROD, SIGN)), _on_parallel_rails
    elif on.round:
        modes, solve = branches((TURN, SIGN)), _on_circle
    else:
        modes, solve = branches((LINE, LINES), (SIDE, SIGN)), _on_ellipse
    d.assembly_modes = modes.labels
    found = solve(on, f, size)
    d.step(
        f"Forward: {'two' if len(modes) == 2 else 'four'} assembly modes",
        found.why,
        dict(found.shown),
        proves=found.proves,
        equal=[*found.equal],
        uses=[loop],
        solves={"fk": ()},
    )
    turn, placed = found.links
    assert placed.lemma is not None
    d.function(
        "fk",
        "Position and yaw of the hand in all assembly modes.",
        {"q": d.actuated},
        {"p": [*(placed.lemma[x] for x in m.position), sp.atan2(found.pair.s, found.pair.c)]},
        program=f,
        branches=modes,
        result="Positions",
        notes=("UNREACHABLE: the third leg does not reach.", *found.notes, NEAR),
    )
    d.inverses.append(
        Inverse(
            "fk",
            tuple(m.pose),
            (sp.S.Zero,) * len(m.loop),
            m.loop,
            links=found.links,
            glue=Combination(found.matrix, {u: u for u in m.pose}),
        )
    )
    for link in (turn, placed):
        record_lemma(d, "fk", link)
    rods = {on.third + 1: found.rod}
    rods |= {k + 1: pull_of(m.legs[k], sp.zeros(2, 1)) for k in on.rails}
    return Posture(
        m=m,
        program=Program(list(f.body), f.taken),
        modes=modes,
        position=found.hand,
        rotation=sp.Matrix([[found.pair.c, -found.pair.s], [found.pair.s, found.pair.c]]),
        rods=rods,
        spans=(),
        volumes=(),
        sign=1,
    )


def _arms(on: TwoRails, f: Program, pair: Pair) -> list[sp.Matrix]:
    """The places of the ends from the hand, named."""
    return [
        named(f, f"e{k}", sp.Matrix([pair.c * x - pair.s * y, pair.s * x + pair.c * y]))
        for k, (x, y) in enumerate(on.m.places, 1)
    ]


def _on_ellipse(on: TwoRails, f: Program, size: sp.Expr) -> _Found:
    yaw, r, path = on.m.pose[2], named_rod(f, on.third + 1, on.m.legs[on.third], size), _path(on, f)
    u, v, w = path
    p, q = on.bend
    names = [
        f.let(f"{letter}_yaw", e)
        for letter, e in zip(
            "pqabe",
            (p, q, u.dot(v), u.dot(w), square(u) - r**2 + (square(v) + square(w)) / 2),
            strict=True,
        )
    ]
    notes = []
    if p.free_symbols or q.free_symbols:
        shape = "the two points on the rails take the third one along an ellipse, not a circle"
        lengths = size_of(on.m.d, on.m.whole)
        none = f.vanishes("none", p**2 + q**2, lengths**4, shape, squares=True)
        f.require([choose(none, 1, 0)], 1, shape)
        notes.append(f"INVALID: also unless {shape}.")
    start = len(f.body)
    means = OnCircle(lambda pair: u + v * pair.c + w * pair.s, r)
    applied = quartic_in(f, yaw, names, (LINE, SIDE), means, tag="yaw", may_be_free=False)
    (relation,) = applied.relations
    turn = Link(
        unknowns=(yaw,),
        equations=applied.lemma.equations,
        given=applied.given,
        lemma=applied.lemma,
        body=tuple(s for s in f.body[start:] if getattr(s, "symbol", None) != relation.root),
        means=applied.means,
        degenerate=applied.degenerate,
        relations=applied.relations,
    )
    rod = named(f, "rod", means.point(applied.result))
    off = f.let("off", sp.sqrt(square(rod)) - r)
    f.match(off, size * MOVED, "the third leg reaches the hand")
    by = _Turned(
        turn,
        applied.result,
        rod,
        "The rails determine the position of the hand for each yaw.  So the vector along the third "
        "rod is u + v*cos(yaw) + w*sin(yaw), and the far end of this rod is on an ellipse, as that "
        "of a trammel.  The rod keeps its length, which gives an equation of degree four: its "
        "solutions are where the ellipse meets a circle.  Two lines pass through these points, "
        "each through two of them: the first sign of a mode says which line, and the second one "
        "which point of it.  Then the hand is where both rails meet.",
        notes=tuple(notes),
    )
    return _where_rails_meet(on, f, by)


def _on_circle(on: TwoRails, f: Program, size: sp.Expr) -> _Found:
    yaw, r, path = on.m.pose[2], named_rod(f, on.third + 1, on.m.legs[on.third], size), _path(on, f)
    u, v, w = path
    apart = f.let("distance", sp.sqrt(square(u)), nonnegative=True)
    far = sp.sqrt(sp.factor(sp.expand(square(on.curve[1]))))
    radius = f.let("radius", far, nonnegative=True)
    # relative to this sum, because the square of a large distance is beyond the range of the type
    span = f.let("span", apart + r + radius, nonnegative=True)
    share = f.let("share", r / span, nonnegative=True)
    right = ((r - apart) * ((r + apart) / span) / radius - radius / span) / 2
    sides = (u.dot(w) / span / radius, u.dot(v) / span / radius, right)
    names = [named_in(f, n, e) for n, e in zip("abc", sides, strict=True)]
    turn, pair, _ = yaw_by_amplitude(
        f,
        yaw,
        names,
        TURN,
        size / span,
        missed=lambda _: share * (size / radius) * MOVED,
        said="the third end turns about the near end of its rod",
    )
    rod = named(f, "rod", u + v * pair.c + w * pair.s)
    by = _Turned(
        turn,
        pair,
        rod,
        "The rails determine the position of the hand for each yaw.  So the vector along the third "
        "rod is u + v*cos(yaw) + w*sin(yaw).  Here v and w are equally long and at right angles, "
        "so the far end of this rod is on a circle.  The rod keeps its length, which gives an "
        "equation with two solutions: these are the assembly modes.  Then the hand is where both "
        "rails meet.",
        notes=("SINGULAR: the third leg lets the hand turn freely, and yaw = 0 is returned.",),
        scale=2 * far * (sp.sqrt(square(on.curve[0])) + on.m.legs[on.third].rod + far),
    )
    return _where_rails_meet(on, f, by)


def _path(on: TwoRails, f: Program) -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
    at, cosine, sine = (named(f, n, e) for n, e in zip("uvw", on.curve, strict=True))
    return at, cosine, sine


def _where_rails_meet(on: TwoRails, f: Program, by: _Turned) -> _Found:
    """The rest of the solution if the rails are not parallel."""
    m, (i, j), k = on.m, on.rails, on.third
    arms = _arms(on, f, by.pair)
    ends = [m.legs[n].end() - arms[n] for n in on.rails]
    met = two_rails(f, ends, on.legs, m.position)
    hand = named(f, "hand", sp.Matrix([met.lemma[x] for x in m.position]))
    yaw = m.pose[2]
    u, v, w = on.curve
    path = u + v * sp.cos(yaw) + w * sp.sin(yaw)
    total = path + m.rods[k]
    first, second = on.legs
    matrix = sp.zeros(3, 3)
    matrix[i, 1] = matrix[j, 2] = 1
    matrix[k, 0] = by.scale
    matrix[k, 1] = total.dot(second.way) / on.across
    matrix[k, 2] = -total.dot(first.way) / on.across
    shift = on.met(m.loop[i], m.loop[j])
    return _Found(
        links=(by.turn, met.link),
        matrix=matrix,
        pair=by.pair,
        hand=hand,
        rod=by.rod,
        why=by.why,
        shown={
            r"\mathbf u": u,
            r"\mathbf v": v,
            r"\mathbf w": w,
        },
        proves="The vector along the third rod differs from this by what the loop equations of the "
        "rails miss.",
        equal=tuple(zip(m.rods[k], path + shift, strict=True)),
        notes=by.notes,
    )


def _on_parallel_rails(on: TwoRails, f: Program, size: sp.Expr) -> _Found:
    m, (i, j), k, yaw = on.m, on.rails, on.third, on.m.pose[2]
    weights, (a, b, c) = on.level
    names = [named_in(f, n, e) for n, e in zip("abc", (a, b, c), strict=True)]
    turn, pair, _ = yaw_by_amplitude(
        f,
        yaw,
        names,
        TURN,
        size,
        missed=lambda _: size / 4,
        said="both rails hold the same point of the hand",
    )
    arms = _arms(on, f, pair)
    held = (i, k)
    ends = [named(f, f"c{n + 1}", m.legs[n].end() - arms[n]) for n in held]
    met = rail_and_circle(
        replace(f, suffix="_rod"), ends, [m.legs[n] for n in held], m.position, ROD, scale=size
    )
    hand = named(f, "hand", sp.Matrix([met.lemma[x] for x in m.position]))
    matrix = sp.zeros(3, 3)
    matrix[i, 1] = matrix[k, 2] = 1
    same = -weights[0, j]
    matrix[j, :] = sp.Matrix([[-1 / same, 1 / same, 0]])
    return _Found(
        links=(turn, met.link),
        matrix=matrix,
        pair=pair,
        hand=hand,
        rod=named(f, "rod", hand - ends[1]),
        why="The rails are parallel, so the difference of their equations does not contain the "
        "position of the hand.  It is a*sin(yaw) + b*cos(yaw) = c, and has two solutions.  Then "
        "the hand is on a line, and the end of the third rod meets this line twice: so there are "
        "four assembly modes.",
        shown=dict(zip("abc", (a, b, c), strict=True)),
        proves="The difference of the equations is that of the yaw.",
        equal=(
            (
                sp.Add(*(e * l for e, l in zip(weights, m.loop, strict=True))),
                a * sp.sin(yaw) + b * sp.cos(yaw) - c,
            ),
        ),
        notes=("SINGULAR: the hand turns freely, and yaw = 0 is returned.",)
        * (not never_free(a, b)),
    )


__all__ = ["TwoRails"]
