"""The inverse of a planar linkage with slides: the same groups, from the hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp

from closedform.lemmas.legs import Naming, Stretch, cross_in_plane
from closedform.lemmas.lines import Ray, two_lines
from closedform.lemmas.missed import MOST_LOST, lost
from closedform.loops.crossed import Crossed, crossed, state
from closedform.loops.from_hand import export_inverse, undetermined
from closedform.loops.hand import square
from closedform.loops.leg_by_leg import MISSED, named
from closedform.loops.linkage import GROUND
from closedform.loops.pantograph import Pantograph, pantograph
from closedform.loops.pantograph import state as in_line
from closedform.loops.sliding import Frame, SlidingLinkage, fold_name, swing_name
from closedform.loops.sliding_solver import Block, Solver, World
from closedform.mechanics.assur_slides import (
    EitherWay,
    Fold,
    Hold,
    Meet,
    OnLine,
    SlidingOrder,
    Swing,
    sliding_order,
)
from closedform.model.functions import choose, real
from closedform.model.step import Step


def inverse(m: SlidingLinkage, loop: Step, poles: Sequence[Block]) -> None:
    """Derive and export the inverse, or say why there is none."""
    if undetermined(m.d, m.hand):
        return
    known = [GROUND, *[m.follower] * bool(m.follower)]
    bars = {name: at for name, at in m.points.items() if name not in m.cylinders}
    bars_across = {case.body: case for case in crossed(m)}
    parallel = [(body, GROUND) for body in bars_across]
    points = [m.hand_at] * bool(m.hand_at)
    found = sliding_order(bars, m.pairs, known, points, parallel)
    case = pantograph(m) if found.left and m.hand_at else None
    if case:
        sliders = [m.slides[k].other(GROUND) for k in case.sliders.values()]
        others = {name: at for name, at in bars.items() if name not in case.links}
        again = sliding_order(others, m.pairs, [*known, *sliders], points, parallel)
        case = None if again.left or again.held else case
        found = again if case else found
    if found.left:
        m.d.no_inverse(f"with the hand held, {found.undone}")
        return
    if any((len(h.points) > 1 and h.slides) or len(h.slides) > 1 for h in found.held):
        m.d.no_inverse(f"with the hand held, {found.held[0].body} is held more than once")
        return
    there = {m.hand_at, *(p for at in bars.values() for p in at)}
    for name in m.cylinders:
        if loose := [p for p in m.points[name] if p not in there]:
            m.d.no_inverse(f"with the hand held, the end {loose[0]} of {name} can still move")
            return
    used = {g.body: bars_across[g.body] for g in found.groups if isinstance(g, EitherWay)}
    steps = [loop, *(state(m, crossing, loop) for crossing in used.values())]
    if case:
        steps.append(in_line(m, case, loop))
    _Reverse(m, steps, found, poles, across=used, case=case).export()


@dataclass
class _Reverse:
    """The inverse as it is written into a program."""

    m: SlidingLinkage
    steps: Sequence[Step]
    order: SlidingOrder
    poles: Sequence[Block]
    across: Mapping[str, Crossed]
    """The bodies that crossed bars keep parallel to the ground."""
    case: Pantograph | None = None
    values: dict[sp.Symbol, sp.Expr] = field(default_factory=dict)
    lost: list[sp.Expr] = field(default_factory=list)
    """How much each group enlarges an error of the target."""
    equations: list[sp.Expr] = field(default_factory=list)

    def __post_init__(self) -> None:
        m = self.m
        self.program = p = m.d.program()
        moved = [sp.Abs(x) for x in m.hand if m.moving and m.follower not in m.turning]
        self.size = p.let("size", m.size + sp.Add(*moved))
        self.solver = Solver(m, p, self.size, sp.S.Half, m.d.actuated)
        self.solver.start([GROUND, *[m.follower] * bool(m.follower)])
        if m.hand_at:
            self.solver.here.at[m.hand_at] = self.solver.meant.at[m.hand_at] = m.hand

    def _in_line(self, case: Pantograph) -> None:
        """The points of a pantograph that slides hold on lines, from the hand."""
        m, p, solver, shares = self.m, self.program, self.solver, case.shares
        (first, k), (second, j) = case.sliders.items()
        hand, ways = shares[m.hand_at], [m.slides[i].way for i in (k, j)]

        def other(place: sp.Matrix, unknown: str, world: World) -> sp.Matrix:
            known = second if unknown == first else first
            moved = hand * world.at[m.hand_at] + shares[known] * place
            return (-moved / shares[unknown]).applyfunc(sp.simplify)

        def lines(world: World) -> list[sp.Matrix]:
            holds = [OnLine(m.slides[i].other(GROUND), i) for i in (k, j)]
            own, far = (
                solver.ray(hold, point, world).at
                for hold, point in zip(holds, (first, second), strict=True)
            )
            return [own, other(far, first, world)]

        unknowns = m.unknown(first)
        rays = [
            Ray(named(p, f"a{i}_0", at), way)
            for i, (at, way) in enumerate(zip(lines(solver.here), ways, strict=True), 1)
        ]
        fixed = cross_in_plane(*ways).is_number
        link = two_lines(solver.names("0"), (rays[0], rays[1]), unknowns, self.size, fixed=fixed)
        place = solver.done(link, unknowns, f"p{first}")
        drawn = [Ray(at, way) for at, way in zip(lines(solver.meant), ways, strict=True)]
        equations = tuple(ray.equation(unknowns) for ray in drawn)
        solver.blocks.append(Block("", tuple(unknowns), equations, (False, False), sp.S.One))
        for world, at in ((solver.here, place), (solver.meant, unknowns)):
            world.at[first] = at
            world.at[second] = other(at, second, world)
        solver.here.at[second] = named(p, f"p{second}", solver.here.at[second])
        for point, i in case.sliders.items():
            solver.parallel(m.slides[i].other(GROUND), GROUND, point)

    def export(self) -> None:
        if self.case:
            self._in_line(self.case)
        for k, group in enumerate(self.order.groups, 1):
            if isinstance(group, Hold):
                self._hold(group, k)
            elif isinstance(group, EitherWay):
                case = self.across[group.body]
                self.solver.either_way(group.body, group.near, (case.along, case.way), k)
            else:
                before = len(self.solver.blocks)
                self.solver.solve(group, k)
                for block in self.solver.blocks[before:]:
                    self._lose(block, k)
        self._joints()
        self.equations = [e for b in self.solver.blocks for e in b.equations]
        self._determined()
        self._write()

    def _lose(self, block: Block, k: int) -> None:
        """Note what a group that is nearly tangent loses, so that later ones tolerate it."""
        det = block.matrix.applyfunc(lambda e: e.xreplace(self.solver.values)).det()
        last = k == len(self.order.groups)
        if det.is_number or (last and not self.order.held):
            return
        p, solver = self.program, self.solver
        size = p.let(f"det_{k}", sp.Abs(det), nonnegative=True)
        more = lost(self._scale(block), size)
        self.lost.append(more)
        if not self.order.held:
            grown = sp.Max(solver.share, more / 2)
            solver.share = p.let(f"may_miss_{k}", grown, nonnegative=True)

    def _scale(self, block: Block) -> sp.Expr:
        return self.size if block.scale is None else block.scale

    def _hold(self, group: Hold, k: int) -> None:
        """A body that is known already: the target has to be on the curve of the hand."""
        m, p, solver = self.m, self.program, self.solver
        here, meant = solver.here, solver.meant
        near, *others = group.points
        free = [flag for link in solver.links for case in link.degenerate for flag in case.flags]
        most = sp.Min(MOST_LOST, sp.Mul(*self.lost))

        def compare(gap: sp.Expr, name: str) -> None:
            # a pin that is free may be chosen such that the distance is right
            off = p.let(name, choose(sp.Or(*free), 0, gap) if free else gap)
            p.match(off, self.size * most / 2, "the hand is on its curve")
            solver.missed.append(sp.Abs(off))

        if group.slides:
            (slide,) = group.slides
            ray = solver.ray(OnLine(group.body, slide), near, here)
            compare(cross_in_plane(ray.way, here.at[near] - ray.at), f"off_{k}")
            solver.parallel(group.body, m.slides[slide].other(group.body), near)
            return
        for point in others:
            between = square(here.at[point] - here.at[near])
            apart = p.let(f"apart_{k}{point}", sp.sqrt(between), nonnegative=True)
            compare(apart - m.length(group.body, near, point), f"off_{k}{point}")
        local = m.local(group.body, near)
        span = m.local(group.body, others[0]) - local
        frames = [
            Frame(w.at[near], local, w.at[others[0]] - w.at[near], span) for w in (here, meant)
        ]
        solver.know(group.body, *frames)

    def _joints(self) -> None:
        """The driven joints, from where the bodies are."""
        m, solver = self.m, self.solver
        for body, q in m.driven.items():
            if body in m.turning:
                self.values[q] = solver.angle(body, q, (q,))
            else:
                places = (solver.slid(body, w) for w in (solver.here, solver.meant))
                self.values[q] = solver.linear(q, *places)
        for k, q in m.glides.items():
            places = (solver.glided(k, w) for w in (solver.here, solver.meant))
            self.values[q] = solver.linear(q, *places)
        for body, q in m.cylinders.items():
            near, far = m.points[body]
            names = Naming(self.program, self.size, f"_{q}")
            w = solver.here.at[far] - solver.here.at[near]
            solved = Stretch(q, (0, 0)).solve(names, w, real("none"))
            solver.links.append(solved.link)
            self.values[q] = solved.value
            between = square(solver.meant.at[far] - solver.meant.at[near])
            solver.blocks.append(Block("", (q,), (between - q**2,), (True,), sp.S.One))

    def _determined(self) -> None:
        """Whether the joints determine the posture: the groups of the forward map."""
        m, g, solver = self.m, self.program, self.solver
        if not self.poles:
            return
        known = self._forward_unknowns()
        volumes, scales = [], []
        for k, block in enumerate(self.poles, 1):
            A = g.matrix(f"A_{k}", block.matrix.applyfunc(lambda e: e.xreplace(known)))
            volumes.append(g.let(f"Delta_{k}", sp.Abs(A.det()), nonnegative=True))
            scales.append(self._scale(block).xreplace(known))
        for fold in [group for group in m.groups if isinstance(group, Fold) and group.far]:
            for body, near in zip(fold.bodies, (fold.pin, fold.near), strict=True):
                scales += self._stretches(body, near, fold.far) if near else []
        meets = [group for group in m.groups if isinstance(group, Meet)]
        for pin, hold in [(group.pin, hold) for group in meets for hold in group.holds]:
            if isinstance(hold, OnLine):
                other = m.slides[hold.slide].other(hold.body)
                scales += [self._away(other, pin)] * (other != GROUND)
            else:
                scales += self._stretches(hold.body, hold.near, pin)
        missed = g.let("missed", sp.Add(*solver.missed))
        g.determined(
            sp.Mul(*volumes),
            sp.Mul(*scales),
            "a group can move while the joints stand still",
            name=r"|\det A|",
            missed=missed,
            size=self.size,
        )

    def _forward_unknowns(self) -> dict[sp.Basic, sp.Expr]:
        """The joints and the unknowns of the forward map, in the names of the program."""
        m, solver = self.m, self.solver
        known: dict[sp.Basic, sp.Expr] = dict(self.values)
        for body, q in m.driven.items():
            if body in m.turning:
                a, b = solver.here.frames[body].vector(sp.Matrix([1, 0]))
                known |= {sp.cos(q): a, sp.sin(q): b}
        for group in m.groups:
            if isinstance(group, Meet):
                known |= dict(zip(m.unknown(group.pin), solver.here.at[group.pin], strict=True))
            elif isinstance(group, Fold) and group.far:
                base = solver.here.frames[group.on]
                seen = base.seen(solver.here.at[group.far])
                known |= dict(zip(m.unknown(fold_name(group)), seen, strict=True))
            elif isinstance(group, Swing):
                way = m.slides[group.slide].way
                here = solver.here.frames[group.bodies[0]].vector(way)
                known |= dict(zip(m.unknown(swing_name(group)), here, strict=True))
        return known

    def _away(self, body: str, pin: str) -> sp.Expr:
        """By how much a pin that slides on a body moves more than a point near its centre."""
        here = self.solver.here
        apart = here.at[pin] - here.frames[body].start
        return sp.Max(1, sp.sqrt(square(apart)) / self.size)

    def _stretches(self, body: str, near: str, pin: str) -> list[sp.Expr]:
        """By how much points of a body move more than its pin, or the angle of a follower."""
        m = self.m
        if body in m.cylinders:
            return []
        length = self._apart(body, near, pin)
        if body == m.follower:
            return [self.size / length]
        parts = [b for b, on in m.folded.items() if on == body]
        others = [p for b in (body, *parts) for p in m.points[b] if p not in (near, pin)]
        return [sp.Max(1, *(self._apart(body, near, p) / length for p in dict.fromkeys(others)))]

    def _apart(self, body: str, near: str, far: str) -> sp.Expr:
        """The distance of two points of a body, or of parts of it."""
        if {near, far} <= {*self.m.points[body]}:
            return self.m.length(body, near, far)
        here = self.solver.here.at
        return sp.sqrt(square(here[far] - here[near]))

    def _told(self) -> str:
        """The bodies in their order."""
        groups = [" and ".join(group.bodies) for group in self.order.groups]
        if self.case:
            sliders = [self.m.slides[k].other(GROUND) for k in self.case.sliders.values()]
            groups.insert(0, f"{' and '.join(sliders)}, where the points in line are on both lines")
        return ", ".join(groups)

    def _write(self) -> None:
        m, d, g, solver = self.m, self.m.d, self.program, self.solver
        on_curve = bool(self.order.held)
        near_pole = bool(self.poles)
        d.step(
            "Inverse: group by group, from the hand",
            "The hand is known instead of the joints.  The bodies are found in this order, again "
            f"group by group: {self._told()}.  "
            + "The length of a cylinder is the distance of its ends.  " * bool(m.cylinders)
            + "The target has to be on the curve of the hand, which the body that is held tells.  "
            * on_curve
            + (
                "Near a parallel singularity rounded joints do not determine the hand.  The status "
                "is SINGULAR if the product of the determinants of all groups is less than 2^-10 "
                f"of that of their scales.  {MISSED}"
            )
            * near_pole,
            {},
            uses=list(self.steps),
            solves={"ik": ()},
        )
        export_inverse(
            d,
            g,
            [self.values[q] for q in d.actuated],
            hand=tuple(m.hand),
            name=m.follower or "the hand",
            signs=solver.signs,
            notes=(
                "UNREACHABLE: the bodies do not meet"
                + ", or the target is not on the curve of the hand" * on_curve
                + ".",
                "SINGULAR: a group is free to move, as where its pivots coincide; one posture is "
                "used.",
                *["SINGULAR also near a parallel singularity."] * near_pole,
                *(
                    f"Where {' and '.join(c.near)} coincide, {body} is free to turn; it is found "
                    f"only where it is parallel to the {GROUND}."
                    for body, c in self.across.items()
                ),
                *["Left out: the postures in which the parallelogram is crossed."]
                * bool(self.case),
            ),
            links=solver.links,
            equations=self.equations,
            passive=[x for b in solver.blocks for x in b.unknowns if x not in {*d.actuated}],
            angles=tuple(m.hand) if m.follower in m.turning else (),
            on_curve=on_curve,
            images="" if self.case else "fk",
        )


__all__ = ["inverse"]
