"""Solves the groups of a linkage with slides in a program, in either direction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import sympy as sp

from closedform.lemmas.circles import two_circles
from closedform.lemmas.legs import Naming, cross_in_plane
from closedform.lemmas.lines import (
    Ray,
    coordinate,
    direction,
    either_way,
    line_and_circle,
    two_lines,
)
from closedform.lemmas.missed import missed_circles
from closedform.loops.from_hand import turned
from closedform.loops.hand import square
from closedform.loops.leg_by_leg import named, named_in
from closedform.loops.linkage import GROUND
from closedform.loops.sliding import Frame, Sliding, SlidingLinkage, fold_name, swing_name
from closedform.mechanics.assur_slides import (
    Fold,
    Group,
    Meet,
    OnCircle,
    OnLine,
    Place,
    Swing,
)
from closedform.model.functions import Program, real
from closedform.model.inverse import Link


@dataclass(frozen=True)
class Block:
    """The equations of a group in symbols, and its unknowns."""

    name: str
    unknowns: tuple[sp.Symbol, ...]
    equations: tuple[sp.Expr, ...]
    halved: tuple[bool, ...]
    """Which equations are squares, whose derivatives are halved."""
    scale: sp.Expr | None = None
    """The largest value of the determinant; none if it is the size of the linkage."""

    def rows(self, symbols: Sequence[sp.Symbol]) -> sp.Matrix:
        """The derivatives of the equations."""
        rows = sp.Matrix(self.equations).jacobian(list(symbols))
        half = [sp.Rational(1, 2) if h else 1 for h in self.halved]
        return sp.diag(*half) * rows

    @property
    def matrix(self) -> sp.Matrix:
        return self.rows(self.unknowns).applyfunc(sp.expand)


@dataclass
class World:
    """What is known of the bodies and their points: in names of a program, or in symbols."""

    frames: dict[str, Frame] = field(default_factory=dict)
    at: dict[str, sp.Matrix] = field(default_factory=dict)
    folded: dict[str, dict[str, Frame]] = field(default_factory=dict)
    """The parts of a body that are known from it, and where they are in its coordinates."""


@dataclass
class Solver:
    """The groups as they are written into a program."""

    m: SlidingLinkage
    program: Program
    size: sp.Expr
    share: sp.Expr
    free: tuple[sp.Symbol, ...] = ()
    here: World = field(default_factory=World)
    meant: World = field(default_factory=World)
    links: list[Link] = field(default_factory=list)
    blocks: list[Block] = field(default_factory=list)
    signs: list[sp.Symbol] = field(default_factory=list)
    missed: list[sp.Expr] = field(default_factory=list)
    values: dict[sp.Basic, sp.Expr] = field(default_factory=dict)
    """The unknowns in the names of the program."""
    whole: sp.Expr = sp.S.One
    """The size of the linkage; ``size`` grows where accuracy is lost."""

    def __post_init__(self) -> None:
        self.whole = self.size

    def names(self, tag: str) -> Naming:
        return Naming(self.program, self.size, f"_{tag}", self.share)

    def know(self, body: str, frame: Frame, meant: Frame) -> None:
        """Add a body and all its points."""
        self.here.frames[body], self.meant.frames[body] = frame, meant
        for point in self.m.points[body]:
            if point not in self.here.at:
                local = self.m.local(body, point)
                self.here.at[point] = named(self.program, f"p{point}", frame.at(local))
                self.meant.at[point] = meant.at(local)
        for part, own in self.here.folded.get(body, {}).items():
            self.know(part, frame.carried(own), meant.carried(self.meant.folded[body][part]))

    def local(self, body: str, point: str, world: World) -> sp.Matrix:
        """A point of a body, or of a part of it, in the coordinates of the body."""
        if point in self.m.points[body]:
            return self.m.local(body, point)
        for part, frame in world.folded.get(body, {}).items():
            if (at := self._of_part(part, point, world)) is not None:
                return frame.at(at)
        raise KeyError(point)

    def _of_part(self, part: str, point: str, world: World) -> sp.Matrix | None:
        try:
            return self.local(part, point, world)
        except KeyError:
            return None

    def start(self, bodies: Sequence[str]) -> None:
        """Add bodies with known joints."""
        for body in bodies:
            self.know(body, self.m.moved(body), self.m.moved(body))

    def solve(self, group: Group, k: int) -> None:
        """Write a group that has one or two solutions, or none to choose."""
        if isinstance(group, Meet):
            self._meet(group, k)
        elif isinstance(group, Swing):
            self._swing(group, k)
        elif isinstance(group, Fold):
            (self._fold if group.far else self._glide)(group, k)
        elif isinstance(group, Place):
            self.parallel(group.body, group.like, group.near)

    def parallel(self, body: str, like: str, point: str) -> None:
        """A body with a known point that is not turned to another one."""
        frames = [
            Frame(
                w.at[point],
                self.local(body, point, w),
                w.frames[like].arm,
                w.frames[like].span,
                w.frames[like].still,
            )
            for w in (self.here, self.meant)
        ]
        self.know(body, *frames)

    def ray(self, hold: OnLine, point: str, world: World) -> Ray:
        """The line on which a body holds a point."""
        slide = self.m.slides[hold.slide]
        frame = world.frames[slide.other(hold.body)]
        at = self.local(hold.body, point, world) + slide.shift(hold.body)
        return Ray(frame.at(at), frame.vector(slide.way))

    def _sign(self, name: str) -> sp.Symbol:
        self.signs.append(sigma := real(f"sigma_{name}"))
        return sigma

    def done(self, link: Link, unknowns: sp.Matrix, name: str) -> sp.Matrix:
        """Record a link; returns the names of its solution."""
        p, lemma = self.program, link.lemma
        assert lemma is not None
        start = len(p.body)
        place = sp.Matrix(
            [p.let(f"{name}_{i}", lemma[x]) for i, x in zip("xy", unknowns, strict=True)]
        )
        means = dict(zip(place, unknowns, strict=True))
        self.links.append(replace(link, body=(*link.body, *p.body[start:]), means=means))
        self.values |= dict(zip(unknowns, place, strict=True))
        return place

    def _meet(self, group: Meet, k: int) -> None:
        m, p, tag = self.m, self.program, self.names(f"{k}")
        lines = [h for h in group.holds if isinstance(h, OnLine)]
        # a point of two lines is computed on the first, which may be the more accurate one
        lines.sort(key=lambda h: m.slides[h.slide].other(h.body) != GROUND)
        circles = [h for h in group.holds if isinstance(h, OnCircle)]
        unknowns = m.unknown(group.pin)
        lengths = [self.length(c.body, c.near, group.pin, self.here) for c in circles]
        radii = self._radii(tag, lengths)
        centres = [named(p, f"b{i}_{k}", self.here.at[c.near]) for i, c in enumerate(circles, 1)]
        raw = [self.ray(h, group.pin, self.here) for h in lines]
        rays = [
            Ray(named(p, f"a{i}_{k}", ray.at), self._way(ray.way, f"{i}_{k}"))
            for i, ray in enumerate(raw, 1)
        ]
        fixed = len(raw) == 2 and cross_in_plane(raw[0].way, raw[1].way).is_number
        if len(rays) == 2 and not fixed:
            rays = [rays[0], self._all_named(rays[1], f"2_{k}")]
        if len(circles) == 2:
            sigma = self._sign(f"{k}")
            link, missed = self._circles(k, (centres, radii), unknowns, sigma)
            self.missed.append(missed)
        elif circles:
            sigma = self._sign(f"{k}")
            link, missed = line_and_circle(tag, rays[0], (centres[0], radii[0]), unknowns, sigma)
            self.missed.append(missed)
        else:
            link = two_lines(tag, (rays[0], rays[1]), unknowns, self.whole, self.free, fixed=fixed)
        place = self.done(link, unknowns, f"p{group.pin}")
        drawn = [self.ray(h, group.pin, self.meant) for h in lines]
        lengths = [self.length(c.body, c.near, group.pin, self.meant) for c in circles]
        squares = [
            square(unknowns - self.meant.at[c.near]) - r**2
            for c, r in zip(circles, lengths, strict=True)
        ]
        # a lemma on a circle and a line has the line first
        equations = [*(ray.equation(unknowns) for ray in drawn), *squares]
        halved = [*(False for _ in drawn), *(True for _ in squares)]
        names = " and ".join(group.bodies)
        what = {0: f"{names} in line", 1: f"{names} crosswise", 2: f"slides of {names} parallel"}
        scale = sp.Mul(*lengths)
        self.blocks.append(
            Block(what[len(lines)], tuple(unknowns), tuple(equations), tuple(halved), scale)
        )
        self.here.at[group.pin], self.meant.at[group.pin] = place, unknowns
        for hold in lines[:1] if len(group.bodies) == 1 else lines:
            like = m.slides[hold.slide].other(hold.body)
            self.parallel(hold.body, like, group.pin)
        for circle, equation, r in zip(circles, squares, lengths, strict=True):
            frames = [
                self._between(circle, group.pin, w, still)
                for w, still in ((self.here, sp.S.Zero), (self.meant, equation / r**2))
            ]
            self.know(circle.body, *frames)

    def length(self, body: str, near: str, far: str, world: World) -> sp.Expr:
        """The distance of two points of a body, or of parts of it."""
        if {near, far} <= {*self.m.points[body]}:
            return self.m.length(body, near, far)
        ends = [self.local(body, point, world) for point in (near, far)]
        return sp.sqrt(square(ends[1] - ends[0]))

    def _between(self, hold: OnCircle, pin: str, world: World, still: sp.Expr) -> Frame:
        """Where a body is that holds a known pin about a known point."""
        start, place = self.local(hold.body, hold.near, world), world.at[hold.near]
        span = self.local(hold.body, pin, world) - start
        return Frame(place, start, world.at[pin] - place, span, still)

    def _glide(self, group: Fold, _: int) -> None:
        """A body as a part of another one, on which a driven slide moves it."""
        ((body,), on), k = (group.bodies, group.on), group.slide
        assert k is not None
        slide, q, right = self.m.slides[k], self.m.glides[k], sp.Matrix([1, 0])
        start = slide.shift(body) + q * slide.way * (1 if body == slide.between[1] else -1)
        for world in (self.here, self.meant):
            zero = sp.zeros(2, 1)
            world.folded.setdefault(on, {})[body] = Frame(start, zero, right, right)

    def glided(self, k: int, world: World) -> sp.Expr:
        """How far a body slid on another one."""
        slide = self.m.slides[k]
        on, body = slide.between
        point, frame = self.m.points[body][0], world.frames[on]
        zero = frame.at(self.m.local(body, point) + slide.shift(body))
        return frame.vector(slide.way).dot(world.at[point] - zero)

    def _fold(self, group: Fold, k: int) -> None:
        """Two bodies as parts of a third one, in whose coordinates their common pin is found."""
        m, p, (first, second), name = self.m, self.program, group.bodies, fold_name(group)
        slide = None if group.slide is None else m.slides[group.slide]
        turning = [(second, group.near)] if slide else [(first, group.pin), (second, group.near)]
        unknowns, sigma, tag = m.unknown(name), self._sign(f"{k}"), self.names(f"{k}")
        drawn, lengths = (
            [self.length(body, end, group.far, w) for body, end in turning]
            for w in (self.meant, self.here)
        )
        radii = self._radii(tag, lengths)
        centres = [
            named(p, f"b{i}_{k}", self.local(group.on, end, self.here))
            for i, (_, end) in enumerate(turning, 1)
        ]
        squares = [
            square(unknowns - self.local(group.on, end, self.meant)) - r**2
            for (_, end), r in zip(turning, drawn, strict=True)
        ]
        if slide:
            at, line = (
                Ray(self.local(first, group.far, w) + slide.shift(first), slide.way)
                for w in (self.here, self.meant)
            )
            ray = Ray(named(p, f"a1_{k}", at.at), self._way(at.way, f"1_{k}"))
            link, missed = line_and_circle(tag, ray, (centres[0], radii[0]), unknowns, sigma)
            equations, halved = [line.equation(unknowns), *squares], (False, True)
            what = f"{second} across the slide of {first} on {group.on}"
        else:
            link, missed = self._circles(k, (centres, radii), unknowns, sigma)
            equations, halved = squares, (True, True)
            what = f"{second} and {first} on {group.on} in line"
        self.missed.append(missed)
        place = self.done(link, unknowns, f"p{name}")
        block = Block(what, tuple(unknowns), tuple(equations), halved, sp.Mul(*drawn))
        self.blocks.append(block)
        for world, far in ((self.here, place), (self.meant, unknowns)):
            parts = world.folded.setdefault(group.on, {})
            if slide:
                own = self.local(first, group.far, world)
                parts[first] = Frame(far, own, slide.way, slide.way)
            for (body, end), equation, r in zip(turning, squares, drawn, strict=True):
                start, own = (self.local(b, end, world) for b in (group.on, body))
                span = self.local(body, group.far, world) - own
                still = equation / r**2 if world is self.meant else sp.S.Zero
                parts[body] = Frame(start, own, far - start, span, still)

    def _radii(self, tag: Naming, lengths: Sequence[sp.Expr]) -> list[sp.Symbol]:
        """The radii of circles under names, unless they are joints."""
        return [
            r if r in self.m.moving else tag.let(f"r{i}", r, nonnegative=True)
            for i, r in enumerate(lengths, 1)
        ]

    def _circles(
        self,
        k: int,
        circles: tuple[Sequence[sp.Matrix], Sequence[sp.Symbol]],
        unknowns: sp.Matrix,
        sigma: sp.Symbol,
    ) -> tuple[Link, sp.Expr]:
        """Where two circles meet, and the length by which they miss each other."""
        centres, radii = circles
        met = two_circles(
            replace(self.program, suffix=f"_{k}"),
            centres,
            radii,
            tuple(unknowns),
            sigma,
            scale=self.size,
            share=self.share,
            free=self.free,
        )
        apart = sp.sqrt(square(centres[1] - centres[0]))
        return met.link, missed_circles(apart, (radii[0], radii[1]))

    def _way(self, way: sp.Matrix, tag: str) -> sp.Matrix:
        """A direction with its coordinates under names, unless they are rational numbers."""
        p = self.program
        return sp.Matrix(
            [
                e if e.is_Symbol or e.is_Rational else p.let(f"l{i}{tag}", e)
                for i, e in zip("xy", way, strict=True)
            ]
        )

    def _all_named(self, ray: Ray, tag: str) -> Ray:
        """A line all of whose numbers are under names; a lemma has a case in which they vary."""
        p = self.program
        at, way = (
            sp.Matrix(
                [
                    e if e.is_Symbol else p.let(f"{n}{i}{tag}", e)
                    for i, e in zip("xy", v, strict=True)
                ]
            )
            for n, v in (("a", ray.at), ("l", ray.way))
        )
        return Ray(at, way)

    def _swing(self, group: Swing, k: int) -> None:
        m, p, tag = self.m, self.program, self.names(f"{k}")
        (first, second), slide = group.near, m.slides[group.slide]
        a, b = group.bodies
        drawn, offset = (
            sp.simplify(
                cross_in_plane(
                    slide.way,
                    self.local(b, second, w) + slide.shift(b) - self.local(a, first, w),
                )
            )
            for w in (self.meant, self.here)
        )
        unknowns, sigma = m.unknown(swing_name(group)), self._sign(f"{k}")
        w = named(p, f"w_{k}", self.here.at[second] - self.here.at[first])
        e = offset if offset == 0 else tag.coefficient("e", offset)
        link, missed = direction(tag, w, e, unknowns, sigma, free=self.free)
        self.missed.append(missed)
        t = self.done(link, unknowns, f"p{swing_name(group)}")
        # a direction between near points is less accurate, and so is what follows from it
        less = self.size * (self.size / (2**10 * sp.sqrt(square(w)) + self.size / 2**30))
        self.size = tag.let("size", sp.Max(self.size, less), nonnegative=True)
        between = self.meant.at[second] - self.meant.at[first]
        equations = (cross_in_plane(unknowns, between) - drawn, square(unknowns) - 1)
        name = f"{a} and {b} with both pivots at right angles to their slide"
        block = Block(name, tuple(unknowns), equations, (False, True))
        self.blocks.append(block)
        for body, near in zip(group.bodies, group.near, strict=True):
            frames = [
                Frame(world.at[near], self.local(body, near, world), arm, slide.way, still)
                for world, arm, still in (
                    (self.here, t, sp.S.Zero),
                    (self.meant, unknowns, equations[1]),
                )
            ]
            self.know(body, *frames)

    def either_way(self, body: str, near: str, ways: tuple[sp.Matrix, sp.Matrix], k: int) -> None:
        """A body with a known point, whose line is parallel to one of the ground.

        ``ways`` are the directions of both, that of the body first.
        """
        m, (along, way) = self.m, ways
        unknowns = m.unknown(f"t_{body}")
        link = either_way(way, unknowns, self._sign(f"{k}"))
        t = self.done(link, unknowns, f"pt_{body}")
        equations = (cross_in_plane(unknowns, way), square(unknowns) - 1)
        self.blocks.append(Block("", tuple(unknowns), equations, (False, True), sp.S.One))
        frames = [
            Frame(world.at[near], m.local(body, near), arm, along, still)
            for world, arm, still in (
                (self.here, t, sp.S.Zero),
                (self.meant, unknowns, equations[1]),
            )
        ]
        self.know(body, *frames)

    def linear(self, x: sp.Symbol, value: sp.Expr, meant: sp.Expr) -> sp.Expr:
        """A coordinate that is known; returns its value."""
        name = named_in(self.program, f"at_{x}", value)
        self.links.append(coordinate(x, name))
        self.blocks.append(Block("", (x,), (x - meant,), (False,), sp.S.One))
        self.values[x] = name
        return name

    def angle(self, body: str, x: sp.Symbol, free: Sequence[sp.Symbol]) -> sp.Expr:
        """The joint of a body that turns about the ground."""
        right = sp.Matrix([1, 0])
        end = self.here.frames[body].vector(right)
        found = turned(
            self.program, x, (end[0], end[1]), size=sp.S.One, free=free, body=body, name="v"
        )
        (a, b), rho = found.end, found.length
        self.links.append(found.link)
        meant = self.meant.frames[body].vector(right)
        equations = (rho * sp.cos(x) - meant[0], rho * sp.sin(x) - meant[1])
        self.blocks.append(Block("", (x, rho), equations, (False, False), sp.S.One))
        self.values |= {sp.cos(x): a, sp.sin(x): b, rho: sp.S.One, x: found.angle}
        return found.angle

    def slid(self, body: str, world: World) -> sp.Expr:
        """How far a body with a joint slid on the ground."""
        slide: Sliding = self.m.slide_of(body)
        point = self.m.points[body][0]
        from_zero = world.at[point] - self.m.local(body, point) - slide.shift(body)
        return slide.way.dot(from_zero)


__all__ = ["Block", "Solver", "World"]
