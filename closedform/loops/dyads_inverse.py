"""The inverse of a planar linkage that is solved dyad by dyad: the same lemmas in reverse.

The hand is known, and the driven bodies are not.  If the bodies are dyads again, one after the
other, the joints follow.  A hand that one joint moves is on a curve: then a body is held at two
points at last, and their distance tells whether the target is on the curve.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import sympy as sp

from closedform.lemmas.circles import two_circles
from closedform.lemmas.legs import Naming, Solution, Stretch, cross_in_plane
from closedform.lemmas.missed import MOST_LOST, lost, missed_circles
from closedform.loops.bar_errors import Bars, hand_error
from closedform.loops.from_hand import export_inverse, turned, undetermined
from closedform.loops.hand import square
from closedform.loops.leg_by_leg import MISSED, named, where_free
from closedform.loops.linkage import GROUND, Linkage
from closedform.loops.parallelograms import home, parallel_to_ground, state
from closedform.mechanics.assur import Dyad, Held, Order, Parallel, Shifted, order
from closedform.model.functions import Program, choose, real
from closedform.model.inverse import Link
from closedform.model.step import Step


def known_points(m: Linkage, p: Program, bodies: Sequence[str]) -> dict[str, sp.Matrix]:
    """The points of the ground and of bodies whose joints are known, in a program."""
    at = {point: m.ground(point) for point in m.points[GROUND]}
    for body in bodies:
        for point in m.points[body]:
            if point not in at:
                at[point] = named(p, f"p{point}", m.on_turning(body, point))
    return at


def inverse(m: Linkage, loop: Step) -> None:
    """Derive and export the inverse, or say why there is none."""
    if undetermined(m.d, m.hand):
        return
    bars = {name: at for name, at in m.points.items() if name not in m.cylinders}
    points = [m.at] * bool(m.at)
    found = order(bars, m.known, points, sought=m.driven)
    if found.left and (m.follower or len(m.d.actuated) > 1):  # not for a hand on a curve
        even = parallel_to_ground(m)
        again = order(bars, m.known, points, sought=m.driven, parallel=even)
        found = found if again.left or again.held else again
    if found.left:
        m.d.no_inverse(f"with the hand held, {found.undone}")
        return
    if found.parallel:
        loop = state(m, [step.body for step in found.parallel], loop)
    there = {m.at, *(p for at in bars.values() for p in at)}
    for name in m.cylinders:
        if loose := [p for p in m.points[name] if p not in there]:
            m.d.no_inverse(f"with the hand held, the end {loose[0]} of {name} can still move")
            return
        found.steps.append(Held(name, m.points[name]))
    _Reverse(m, loop, found).export()


@dataclass
class _Reverse:
    """The inverse as it is written into a program."""

    m: Linkage
    loop: Step
    order: Order
    links: list[Link] = field(default_factory=list)
    found: list[Solution] = field(default_factory=list)
    values: dict[sp.Symbol, sp.Expr] = field(default_factory=dict)
    equations: list[sp.Expr] = field(default_factory=list)
    passive: list[sp.Symbol] = field(default_factory=list)
    signs: list[sp.Symbol] = field(default_factory=list)
    missed: list[sp.Expr] = field(default_factory=list)
    free: list[sp.Symbol] = field(default_factory=list)
    """The flags that a pin is free."""
    lost: list[sp.Expr] = field(default_factory=list)
    """How much each dyad enlarges an error of the target."""

    def __post_init__(self) -> None:
        m, self.program = self.m, self.m.d.program()
        self.size = self.program.let("size", m.size)
        self.share: sp.Expr = sp.S.Half
        """The part of the size by which a bar may miss; more where accuracy is lost."""
        self.at = known_points(m, self.program, m.known[1:])
        self.meant = {p: m.ground(p) for p in m.points[GROUND]}
        for body in m.known[1:]:
            self.meant |= {p: m.on_turning(body, p) for p in m.points[body]}
        if m.at:
            self.at[m.at] = self.meant[m.at] = m.hand[:2, :]

    def export(self) -> None:
        for k, step in enumerate(self.order.steps, 1):
            self._widen(k)
            if isinstance(step, Held) and step.body in self.m.cylinders:
                self._stretch(step, k)
            elif isinstance(step, Held):
                self._hold(step, k)
            elif isinstance(step, Parallel):
                self._beside(step)
            else:
                driven = [body for body in step.bodies if body in self.m.driven]
                if len(driven) == 1:
                    self._crank(step, driven[0], k)
                    continue
                self._circles(step, k)
                for body in driven:
                    self._angle(body, self.m.pivot(body), step.pin)
        self._determined()
        self._write()

    def _widen(self, k: int) -> None:
        """Let a dyad tolerate what those before have lost, unless the hand is on a curve."""
        if self.lost and isinstance(self.order.steps[k - 1], Dyad | Shifted) and not self.on_curve:
            grown = sp.Max(1, *self.lost) / 2
            self.share = self.program.let(f"may_miss_{k}", grown, nonnegative=True)

    @property
    def on_curve(self) -> bool:
        return any(step.body not in self.m.cylinders for step in self.order.held)

    def _carry(self, body: str, near: str, far: str) -> None:
        """Add the other points of a body, under names and in symbols."""
        m = self.m
        for point in m.points[body]:
            if point not in self.at:
                place = m.point_on(body, (near, far, point), self.at)
                self.at[point] = named(self.program, f"p{point}", place)
                self.meant[point] = m.point_on(body, (near, far, point), self.meant)

    def _beside(self, step: Parallel) -> None:
        """A body that is parallel to the ground, from one of its points."""
        m, turn = self.m, home(self.m, step.body)
        for point in m.points[step.body]:
            if point not in self.at:
                span = (turn * m.span(step.body, step.near, point)).applyfunc(sp.simplify)
                self.at[point] = named(self.program, f"p{point}", self.at[step.near] + span)
                self.meant[point] = self.meant[step.near] + span

    def _crank(self, step: Dyad | Shifted, body: str, k: int) -> None:
        """A driven body and the bar that it moves."""
        m, p = self.m, self.program
        i = step.bodies.index(body)
        other, near = step.bodies[1 - i], step.near[1 - i]
        pin, end = step.pins[i], step.pins[1 - i]
        shift = self._shift(step) * (1 if i else -1)
        rod = m.length(other, near, end)
        names = Naming(p, self.size, f"_{k}", self.share)
        drawn = m.crank(body, pin, rod)
        crank = drawn.named(names)
        self.signs.append(sigma := real(f"sigma_{body}"))
        centre = self.at[near] + shift
        w = centre - crank.base
        solved = crank.solve(names, w, sigma)
        start = len(p.body)
        place = named(p, f"p{pin}", centre - solved.rod)
        link = replace(
            solved.link,
            body=(*solved.link.body, *p.body[start:]),
            means=dict(zip(place, crank.end(), strict=True)),
        )
        self.links.append(link)
        self.free += [flag for case in link.degenerate for flag in case.flags]
        self.found.append(solved)
        self.values[crank.joint] = solved.value
        self.missed.append(solved.missed)
        self.equations.append(square(drawn.end() - self.meant[near] - shift) - rod**2)
        self.at[pin], self.meant[pin] = place, drawn.end()
        if any(shift):
            self._moved(end, pin, -shift)
        self._lose(step)
        self._carry(body, m.pivot(body), pin)
        self._carry(other, near, end)

    def _shift(self, step: Dyad | Shifted) -> sp.Matrix:
        """By how much the pin of the second body is away from that of the first one."""
        if isinstance(step, Dyad):
            return sp.zeros(2, 1)
        turn, span = home(self.m, step.on), self.m.span(step.on, *step.pins)
        return (turn * span).applyfunc(sp.simplify)

    def _moved(self, point: str, pin: str, by: sp.Matrix) -> None:
        """Add a point that is at a constant vector from a known one."""
        self.at[point] = named(self.program, f"p{point}", self.at[pin] + by)
        self.meant[point] = self.meant[pin] + by

    def _circles(self, step: Dyad | Shifted, k: int) -> None:
        """Two bodies that no joint drives."""
        m, p = self.m, self.program
        self.signs.append(sigma := real(f"sigma_{step.pin}"))
        unknowns = m.unknown(step.pin)
        lengths = self._lengths(step)
        radii = [
            r if r.is_Symbol else p.let(f"r{i}_{k}", r, nonnegative=True)
            for i, r in enumerate(lengths, 1)
        ]
        shifts = (self._shift(step), sp.zeros(2, 1))
        first, second = zip(step.near, shifts, strict=True)
        centres = [
            named(p, f"b{i}_{k}", self.at[n] + by) for i, (n, by) in enumerate((first, second), 1)
        ]
        met = two_circles(
            replace(p, suffix=f"_{k}"),
            centres,
            radii,
            tuple(unknowns),
            sigma,
            scale=self.size,
            share=self.share,
            free=m.d.actuated,
        )
        start = len(p.body)
        place = named(p, f"p{step.pin}", sp.Matrix([met.lemma[x] for x in unknowns]))
        means = dict(zip(place, unknowns, strict=True))
        self.links.append(replace(met.link, body=(*met.link.body, *p.body[start:]), means=means))
        self.free += [flag for case in met.link.degenerate for flag in case.flags]
        if not self.on_curve:
            apart = sp.sqrt(square(centres[1] - centres[0]))
            self.missed.append(missed_circles(apart, (radii[0], radii[1])))
        self.passive += unknowns
        for (near, by), length in zip((first, second), lengths, strict=True):
            self.equations.append(square(unknowns - self.meant[near] - by) - length**2)
        self.at[step.pin], self.meant[step.pin] = place, unknowns
        if isinstance(step, Shifted):
            self._moved(step.far, step.pin, -shifts[0])
        self._lose(step)
        for body, near, pin in zip(step.bodies, step.near, step.pins, strict=True):
            self._carry(body, near, pin)

    def _lose(self, step: Dyad | Shifted) -> None:
        """Note that a pin is moved far by rounding if its bars are in line, or both begin there."""
        a, b = (self.at[p] - self.at[near] for p, near in zip(step.pins, step.near, strict=True))
        size = sp.Mul(*self._lengths(step))
        between = self.at[step.near[0]] + self._shift(step) - self.at[step.near[1]]
        apart = sp.sqrt(square(between))
        self.lost.append(lost(size, sp.Abs(a[0] * b[1] - a[1] * b[0])))
        self.lost.append(lost(self.size, apart))

    def _lengths(self, step: Dyad | Shifted) -> list[sp.Expr]:
        ends = zip(step.bodies, step.near, step.pins, strict=True)
        return [self.m.length(*end) for end in ends]

    def _stretch(self, step: Held, k: int) -> None:
        """A cylinder, both of whose ends are known."""
        near, far = step.points
        q = self.m.cylinders[step.body]
        leg = Stretch(q, (0, 0))
        names = Naming(self.program, self.size, f"_{k}")
        solved = leg.solve(names, self.at[far] - self.at[near], real("none"))
        self.links.append(solved.link)
        self.found.append(solved)
        self.values[q] = solved.value
        self.equations.append(square(self.meant[far] - self.meant[near]) - q**2)

    def _hold(self, step: Held, k: int) -> None:
        """A body whose points are known: their distances have to be right."""
        m, p = self.m, self.program
        near, far, *others = step.points
        for point in () if step.implied else (far, *others):
            between = square(self.at[point] - self.at[near])
            apart = p.let(f"apart_{k}{point}", sp.sqrt(between), nonnegative=True)
            gap = apart - m.length(step.body, near, point)
            # a pin that is free may be chosen such that the distance is right
            off = p.let(f"off_{k}{point}", choose(sp.Or(*self.free), 0, gap))
            most = sp.Min(MOST_LOST, sp.Mul(*self.lost))
            p.match(off, self.size * most / 2, "the hand is on its curve")
            self.missed.append(sp.Abs(off))
        if step.body in m.driven:
            self._angle(step.body, near, far)
        self._carry(step.body, near, far)

    def _angle(self, body: str, near: str, far: str) -> None:
        """The joint of a driven body, both of whose ends are known."""
        m, p = self.m, self.program
        end = far if near == m.pivot(body) else near
        crank = m.crank(body, end)
        q, w = crank.joint, self.at[end] - crank.base
        along, across = (w.dot(sp.Matrix(e)) for e in (crank.along, crank.across))
        found = turned(p, q, (along, across), size=self.size, free=(q,), body=body, name="w")
        rho = found.length
        self.links.append(found.link)
        self.passive.append(rho)
        self.values[q] = found.angle
        meant = self.meant[end] - crank.base
        for e, unit in ((sp.cos(q), crank.along), (sp.sin(q), crank.across)):
            self.equations.append(rho * e - meant.dot(sp.Matrix(unit)))

    def _determined(self) -> None:
        """Whether the joints determine the posture: how far the forward map moves the hand."""
        m, g = self.m, self.program
        bars = []
        for k, dyad in enumerate(m.dyads, 1):
            a, b = (self.at[dyad.pin] - self.at[near] for near in dyad.near)
            first, second = (e.subs(self.values) for e in self._lengths(dyad))
            volume = g.let(f"Delta_{k}", cross_in_plane(a, b))
            bars.append(Bars((a, b), (first, second), volume))
        missed = g.let("missed", sp.Add(*self.missed))
        g.determined(
            sp.Abs(sp.Mul(*(pair.volume for pair in bars))),
            hand_error(m, g, self.at, bars, self.size),
            "both bars of a dyad are in line",
            name=r"|\det A|",
            missed=missed,
            size=self.size,
        )

    def _write(self) -> None:
        m, d, g = self.m, self.m.d, self.program
        on_curve = self.on_curve
        d.step(
            "Inverse: dyad by dyad, from the hand",
            "The hand is known instead of the joints.  The bodies are found in this order, again "
            f"dyad by dyad: {self._told()}.  "
            + "The length of a cylinder is the distance of its ends.  " * bool(m.cylinders)
            + "The target has to be on the curve of the hand, which the last distance tells.  "
            * on_curve
            + "Near a parallel singularity rounded joints do not determine the hand.  The status "
            "is SINGULAR if the hand moves more than 2^10 times as far as the bars of the dyads "
            f"miss their lengths.  {MISSED}",
            {},
            uses=[self.loop],
            solves={"ik": ()},
        )
        apart = m.require_apart(g)
        parallel = bool(self.order.parallel)
        passive = [s for s in self.order.pairs if not {*s.bodies} & {*m.driven}]
        export_inverse(
            d,
            g,
            [self.values[q] for q in d.actuated],
            hand=tuple(m.hand),
            name=m.follower or "the hand",
            signs=self.signs,
            notes=(
                "UNREACHABLE: the bodies do not meet"
                + ", or the target is not on the curve of the hand." * on_curve
                + "." * (not on_curve),
                *where_free(self.found),
                *[
                    "SINGULAR: both circles of a dyad are the same, and its pin is free; one point "
                    "is used, from which the hand need not reach the target."
                ]
                * bool(passive),
                "SINGULAR also near a parallel singularity, where both bars of a dyad are in line.",
                *apart,
                *["Left out: the postures in which a parallelogram is crossed."] * parallel,
            ),
            links=self.links,
            equations=self.equations,
            passive=self.passive,
            angles=tuple(m.hand) if m.follower else tuple(m.hand[2:]),
            on_curve=on_curve,
            images="" if parallel else "fk",
        )

    def _told(self) -> str:
        return ", ".join(
            " and ".join(s.bodies) if isinstance(s, Dyad | Shifted) else s.body
            for s in self.order.steps
        )


__all__ = ["inverse", "known_points"]
