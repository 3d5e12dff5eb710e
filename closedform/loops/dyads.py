"""All that follows from the bodies of a planar linkage that is solved dyad by dyad."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import sympy as sp

from closedform.lemmas.circles import two_circles
from closedform.lemmas.legs import Naming
from closedform.lemmas.missed import MOVED, SHARE
from closedform.loops.conditioning import JACOBIAN, conditioning
from closedform.loops.dyads_inverse import inverse, known_points
from closedform.loops.hand import in_space
from closedform.loops.leg_by_leg import SIGN, Choice, named, record
from closedform.loops.linkage import GROUND, Body, Linkage, Solved
from closedform.loops.modes import NO_MODE, Exported, export
from closedform.loops.parallel import NEAR
from closedform.loops.posed import pose_of, pose_rates
from closedform.mechanics.loops import velocity_matrices
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, branches, real
from closedform.model.inverse import Inverse, Link
from closedform.model.step import Step

STILL = "hand stands still"
OF_PINS = ", of which the last are the task"


def linkage(
    d: Derivation,
    hand: Sequence[sp.Symbol],
    bodies: Mapping[str, Body],
    at: str = "",
    *,
    modes: Choice = SIGN,
) -> None:
    """Derive and export a planar linkage that is solved dyad by dyad.

    Parameters
    ----------
    d
        the derivation, with its parameters and one to three joints
    hand
        the symbols of the task: the two coordinates of a point, these and the yaw of its body, or
        the joint of a body
    bodies
        all bodies, one of which is called ``ground``; see :class:`~closedform.loops.linkage.Body`
    at
        the point that is the hand, if it is a point; with a yaw, of one body only
    modes
        the names of the assembly modes of a dyad, by the sign of its determinant
    """
    m = Linkage(d, sp.Matrix(hand), bodies, at)
    d.poles = tuple(f"{pole(step)} in line" for step in m.solved)
    d.singularities = (*[STILL] * (len(m.hand) == len(d.actuated)), *d.poles)
    loop = _state(m)
    at_posture = _forward(m, modes, loop)
    _draw(m, at_posture)
    _velocity(m, at_posture, loop)
    inverse(m, loop)


def pole(step: Solved) -> str:
    """The bars that are in line at a parallel singularity."""
    a, b = step.dyad.bodies
    return f"{a} and {b}"


def _state(m: Linkage) -> Step:
    rows: list[tuple[Any, ...]] = [("Pin", "Bodies", "Held at", "Distances")]
    for step in m.solved:
        (a, b), (near, other) = step.dyad.bodies, step.near
        lengths = m.length(a, near, step.pin), m.length(b, other, step.pin)
        rows += [(step.pin, a, near, lengths[0]), (step.pin, b, other, lengths[1])]
    return m.d.step(
        "The linkage",
        "The driven bodies turn about the ground.  " * bool(m.driven)
        + "The length of a cylinder is its joint.  " * bool(m.cylinders)
        + "Each pin of the table belongs to two bodies, of "
        "which one more point is known before: they are a dyad, and the pin is at the given "
        "distances from these points.",
        {},
        rows=rows,
    )


@dataclass
class Posture:
    """All points in an assembly mode, in the names of a program."""

    program: Program
    modes: Branches
    points: dict[str, sp.Matrix]
    spans: list[tuple[sp.Matrix, sp.Matrix]] = field(default_factory=list)
    """For each dyad, the vectors from the centres of both circles to the goal."""
    volumes: list[sp.Expr] = field(default_factory=list)
    """The determinants of these."""


def _forward(m: Linkage, choice: Choice, loop: Step) -> Posture:
    d, f = m.d, m.d.program()
    signs = [real(f"sigma_dyad{k}") for k, _ in enumerate(m.solved, 1)]
    modes = branches(*((sigma, choice) for sigma in signs))
    d.assembly_modes = modes.labels
    size = f.let("size", m.size + sp.Add(*m.cylinders.values()))
    found = Posture(f, modes, known_points(m, f, list(m.driven)))
    links: list[Link] = []
    outputs: list[sp.Expr] = []
    for k, (step, sigma) in enumerate(zip(m.circles, signs, strict=False), 1):
        met = _meet(m, found, (k, step, sigma), size)
        outputs = [met.lemma[x] for x in step.unknowns]
        link, start = met.link, len(f.body)
        if step in m.inner:
            place = named(f, f"p{step.goal}", sp.Matrix(outputs))
            found.points[step.goal] = place
            meant = dict(zip(place, step.unknowns, strict=True))
            link = replace(link, body=(*link.body, *f.body[start:]), means=meant)
            _carry(m, f, step, found.points)
        links.append(link)
    if m.follower:
        step, k = m.solved[-1], len(m.solved)
        names = Naming(f, size, f"_{k}", _share(m))
        crank = m.crank(m.follower, step.pin, m.length(step.dyad.bodies[1], step.near[1], step.pin))
        solved = crank.solve(names, found.points[step.near[1]] - crank.base, signs[-1])
        outputs, last = [solved.value], solved.link
        links.append(last)
        found.points[step.pin] = found.points[step.near[1]] - solved.rod
    turn = pose_of(m, f, found.points, size) if m.posed else None
    if turn:
        outputs = [*found.points[m.at], turn.yaw]
        links += turn.links
    apart = m.require_apart(f)
    d.step(
        "Forward: dyad by dyad",
        "Two circles meet in the pin of each dyad, about the points that are known before.  They "
        "meet twice, which gives two assembly modes for each dyad.  "
        f"{_ending(m)}",
        {},
        uses=[loop],
    )
    what = f"{m.hand[0]}" if m.follower else f"Position{' and yaw' * m.posed} of the hand"
    d.function(
        "fk",
        f"{what} in all assembly modes.",
        {"q": d.actuated},
        {"p": outputs},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            "UNREACHABLE: the bodies of a dyad do not meet.",
            *_free(m, links),
            *apart,
            NEAR,
        ),
    )
    passive = [e for step in m.circles if step in m.inner for e in step.unknowns]
    equations = [*m.loop, *(turn.equations if turn else ())]
    record(
        d,
        Inverse(
            "fk",
            tuple(m.hand),
            (sp.S.Zero,) * len(equations),
            tuple(equations),
            links=tuple(links),
            passive=(*passive, *([turn.length] if turn else ())),
        ),
    )
    return _again(m, found)


def _ending(m: Linkage) -> str:
    if m.follower:
        return f"The last pin gives the angle {m.hand[0]} of the {m.follower}."
    if m.posed:
        return (
            f"Two pins give the yaw of the {m.carrier}, and so its point {m.at}, which is the hand."
        )
    last = m.solved[-1]
    if last.pin == last.goal:
        return "The last pin is the hand."
    return (
        "The hand is seen from the first point of the last dyad as the pin is, turned and "
        "stretched by constants.  The inverse turn and stretch take both circles to those of the "
        "hand."
    )


def _free(m: Linkage, links: Sequence[Link]) -> list[str]:
    if m.follower:
        ends = [c for c in links[-1].degenerate if c.free]
        notes = [f"SINGULAR: {c.meaning}; {c.free} is free, 0 is returned." for c in ends]
    else:
        notes = []
    return [
        "SINGULAR: both circles of a dyad are the same, and its pin is free; one point is used.",
        *notes,
    ]


def _meet(m: Linkage, at: Posture, dyad: tuple[int, Solved, sp.Symbol], size: sp.Expr) -> Any:
    """The two points in which the circles of a dyad meet."""
    (k, step, sigma), f = dyad, at.program
    first, second = m.centres(step, at.points)
    span = named(f, f"u{k}", (second - first).applyfunc(sp.expand))
    radii = [
        r if r.is_Symbol else f.let(f"r{i}_{k}", r, nonnegative=True)
        for i, r in enumerate(m.radii(step), 1)
    ]
    scale = size * sp.Min(1, m.stretch(step))
    if not scale.is_Symbol:
        scale = f.let(f"scale_{k}", scale)
    met = two_circles(
        replace(f, suffix=f"_{k}"),
        (first, first + span),
        radii,
        tuple(step.unknowns),
        sigma,
        scale=scale,
        share=_share(m),
        free=tuple(m.hand),
    )
    at.spans.append((sp.Matrix(met.first), sp.Matrix(met.first) - span))
    at.volumes.append(met.side * met.size)
    return met


def _share(m: Linkage) -> sp.Rational:
    """By what share of the size a hand may miss; the size of the inverse counts no cylinders."""
    return MOVED if m.cylinders else SHARE


def _carry(m: Linkage, p: Program, step: Solved, points: dict[str, sp.Matrix]) -> None:
    """Add the points of both bodies of a dyad, those that are used later under names."""
    before = set(points)
    m.carry(step, points)
    _name_new(p, before, points)


def _carry_last(m: Linkage, p: Program, step: Solved, points: dict[str, sp.Matrix]) -> None:
    """Add the points of the body that is the hand, and of the rod that turns it."""
    before = set(points)
    m.carry_body(m.follower, m.pivot(m.follower), step.pin, points)
    m.carry_body(step.dyad.bodies[1], step.near[1], step.pin, points)
    _name_new(p, before, points)


def _name_new(p: Program, before: set[str], points: dict[str, sp.Matrix]) -> None:
    for point in [x for x in points if x not in before]:
        points[point] = named(p, f"p{point}", points[point])


def _again(m: Linkage, found: Posture) -> Posture:
    """The posture in a program for functions of the joints, with all points under names."""
    v = Program(list(found.program.body), found.program.taken)
    if m.follower:
        step, points = m.solved[-1], found.points
        points[step.pin] = named(v, f"p{step.pin}", points[step.pin])
        _carry_last(m, v, step, points)
        span = points[step.pin] - points[step.near[1]]
        found.spans.append((points[step.pin] - points[step.near[0]], span))
    elif not m.posed:
        step = m.solved[-1]
        near = found.points[step.near[0]]
        found.points[step.goal] = named(v, f"p{step.goal}", near + found.spans[-1][0])
        _carry(m, v, step, found.points)
    found.program = v
    return found


def _draw(m: Linkage, at: Posture) -> None:
    links: dict[str, tuple[str, ...]] = {}
    lengths: dict[tuple[str, str], sp.Expr] = {}
    closing: dict[tuple[str, str], sp.Expr] = {}
    bars = _bars(m)
    for body, points in m.points.items():
        line = (*points, points[0]) if len(points) > 2 else points
        if len(points) > 1 and body not in m.cylinders:
            links[body] = line
        for a, b in pairwise(line):
            if {a, b} <= set(m.points[GROUND]) and body != GROUND:
                continue
            lengths[a, b] = m.length(body, a, b)
            if body in bars:
                near, far, equation = bars[body]
                share = m.squared(body, a, b) / m.squared(body, near, far)
                closing[a, b] = sp.factor(share) * equation
    joints = {b.joint: (m.pivot(body),) for body, b in m.driven.items() if b.joint}
    joints |= {q: m.points[body] for body, q in m.cylinders.items()}
    hand = m.at or m.solved[-1].pin
    skeleton(
        m.d,
        {name: in_space(place) for name, place in at.points.items()},
        links=links,
        joints=joints,
        hand=hand,
        hand_at=in_space(m.posture[hand]),
        ground=m.points[GROUND],
        lengths=lengths,
        program=at.program,
        branches=at.modes,
        notes=(NO_MODE,),
        at_posture=[{name: in_space(m.posture[name]) for name in at.points}],
        closing=closing,
    )


def _bars(m: Linkage) -> dict[str, tuple[str, str, sp.Expr]]:
    """Of each body of a dyad, the two points whose distance an equation of the loop gives."""
    found, loop = {}, iter(m.loop)
    for step in m.circles:
        (a, b), (near, other) = step.dyad.bodies, step.near
        found[a] = (near, step.goal, next(loop))
        found[b] = (other, step.pin, next(loop) / m.stretch(step) ** 2)
    if m.follower:
        dyad = m.solved[-1].dyad
        found[dyad.bodies[1]] = (dyad.near[1], dyad.pin, next(loop))
    return found


@dataclass(frozen=True)
class Rate:
    """The velocity of a point for each driven joint, times the determinants of some dyads."""

    times: sp.Matrix
    dyads: frozenset[int] = frozenset()

    def over(self, volumes: Sequence[sp.Expr], dyads: frozenset[int]) -> sp.Matrix:
        """The velocity times the determinants of more dyads."""
        return self.times * _product(volumes, dyads - self.dyads)


def _velocity(m: Linkage, at: Posture, loop: Step) -> None:
    d, n = m.d, len(m.d.actuated)
    A, B = velocity_matrices(m.loop, m.variables, d.actuated)
    rows, driven = _rows(m, [end - start for end, start in _ends(m)])
    d.step(
        "Velocity and singular sets",
        "The derivatives of the equations of all dyads, halved, give A*du = B*dq for the "
        f"coordinates u of the pins{OF_PINS * (not m.posed)}.  A is block triangular, "
        "because each dyad depends on those before it.  Its determinant is the product of those of "
        "the dyads.  One of them vanishes if both bars of the dyad are in line (parallel: the pin "
        "can move while the joints stand still).",
        {"A": rows, "B": driven},
        proves="A and B are half of the derivatives.",
        equal=[(A, 2 * rows), (B, 2 * driven)],
        uses=[loop],
    )
    v = Program(list(at.program.body), at.program.taken)
    volumes = [v.let(f"Delta_{k}", e) for k, e in enumerate(at.volumes, 1)]
    rates = {p: Rate(sp.zeros(2, n)) for p in m.points[GROUND]}
    for body, drawn in m.driven.items():
        k = d.actuated.index(drawn.joint)
        for point in m.points[body]:
            if point not in rates:
                arm = at.points[point] - at.points[m.pivot(body)]
                turned = sp.zeros(2, n)
                turned[:, k] = sp.Matrix([-arm[1], arm[0]])
                rates[point] = Rate(turned)
    for k, step in enumerate(m.circles):
        _rate_of(m, v, (k, step), (at, rates, volumes))
    if m.follower:
        step = m.solved[-1]
        crank = m.crank(m.follower, step.pin)
        rod = at.spans[-1][1]
        near = rates[step.near[1]]
        volume = v.let(f"Delta_{len(m.solved)}", rod.dot(crank.rate_at(at.points[step.pin])))
        volumes.append(volume)
        longer = _longer(m, step.dyad.bodies[1]) * _product(volumes, near.dyads)
        moved = v.matrix("B_last", rod.T * near.times + longer)
        J = moved / _product(volumes, near.dyads) / volume
        still = moved[0] if n == 1 else sp.S.Zero
    elif m.posed:
        start, end = m.solved[-1].near[0], m.solved[-1].pin
        moving = {p: rates[p].times / _product(volumes, rates[p].dyads) for p in (start, end, m.at)}
        J = pose_rates(m, at.points, moving)
        still = sp.Matrix.vstack(rates[start].times, rates[""].times[1, :]).det()
    else:
        hand = rates[m.at]
        J = hand.times / _product(volumes, hand.dyads)
        still = rates[""].times.det() if n == 2 else sp.S.Zero
    pole_note = "Not finite at a parallel singularity."
    A_at, B_at = _rows_at(m, at)
    order = f"u are the coordinates of the pins, dyad by dyad{OF_PINS * (not m.posed)}."
    functions: list[Exported] = [
        ("jacobian_parallel", "A of A*du = B*dq.", {"A": A_at.tolist()}, (order,)),
        ("jacobian_serial", "B of A*du = B*dq.", {"B": B_at.tolist()}, (order,)),
        ("jacobian", "Derivative of the task with respect to q.", {"J": J.tolist()}, (pole_note,)),
    ]
    if n == len(m.hand):
        functions.append(
            ("determinant", "Determinant of the Jacobian.", {"det": J.det()}, (pole_note,))
        )
    factors = [*[still] * (n == len(m.hand)), *volumes]
    functions.append(
        (
            "singularities",
            "Where the hand stands still (serial), and the determinants of the dyads (parallel).",
            {"factors": factors},
            (),
        )
    )
    if n == len(m.hand) == 2:
        size = v.let("pushed", sp.Abs(hand.times.det()), nonnegative=True)
        rows = [hand.times[i, :].T for i in range(2)]
        functions.append(("condition_number", *conditioning(v, rows, size, of=JACOBIAN)))
    export(d, v, at.modes, functions, {})


def _product(volumes: Sequence[sp.Expr], dyads: frozenset[int]) -> sp.Expr:
    return sp.Mul(*(volumes[k] for k in sorted(dyads)))


def _rate_of(
    m: Linkage,
    v: Program,
    dyad: tuple[int, Solved],
    motion: tuple[Posture, dict[str, Rate], Sequence[sp.Expr]],
) -> None:
    """Add the velocities of the points of a dyad, and as "" what moves the circles of the hand."""
    (k, step), (at, rates, volumes) = dyad, motion
    a, b = at.spans[k]
    near, other = (rates[p] for p in step.near)
    both = near.dyads | other.dyads
    first = near.over(volumes, both)
    second = first + step.turned * (other.over(volumes, both) - first)
    plain = Rate(second, both) if step.turned != sp.eye(2) else other
    longer = [_longer(m, body) for body in step.dyad.bodies]
    sized = a.T * near.times + longer[0] * _product(volumes, near.dyads)
    other_sized = b.T * plain.times
    other_sized += longer[1] * m.stretch(step) ** 2 * _product(volumes, plain.dyads)
    rows = [v.matrix(f"s1_{k + 1}", sized), v.matrix(f"s2_{k + 1}", other_sized)]
    rates[""] = Rate(sp.Matrix.vstack(*rows))
    s = [Rate(row, r.dyads).over(volumes, both) for row, r in zip(rows, (near, plain), strict=True)]
    pushed = sp.Matrix.vstack(b[1] * s[0] - a[1] * s[1], a[0] * s[1] - b[0] * s[0])
    goal = Rate(v.matrix(f"w_{k + 1}", pushed), both | {k})
    rates[step.goal] = goal
    if step.goal == step.pin:
        for body, near_point in zip(step.dyad.bodies, step.near, strict=True):
            for point in m.points[body]:
                if point not in rates:
                    rates[point] = _carried(m, (body, near_point, step.pin, point), rates, volumes)


def _longer(m: Linkage, body: str) -> sp.Matrix:
    """Half of the derivative of the squared length of a body with respect to the driven joints."""
    q = m.cylinders.get(body)
    return sp.Matrix([[q if joint == q else 0 for joint in m.d.actuated]])


def _carried(
    m: Linkage,
    place: tuple[str, str, str, str],
    rates: Mapping[str, Rate],
    volumes: Sequence[sp.Expr],
) -> Rate:
    """The velocity of a point of a body, from those of two others."""
    body, near, far, point = place
    dyads = rates[near].dyads | rates[far].dyads
    start, end = (rates[p].over(volumes, dyads) for p in (near, far))
    return Rate(start + m.turn(body, near, far, point) * (end - start), dyads)


def _rows(m: Linkage, bars: Sequence[sp.Matrix]) -> tuple[sp.Matrix, sp.Matrix]:
    """A and B of A*du = B*dq, row by row: the bar times the rates of its ends."""
    A, B = [], []
    for bar, (end, start), longer in zip(bars, _ends(m), _lengthened(m), strict=True):
        A.append(bar.T * (end - start).jacobian(list(m.variables)))
        B.append(bar.T * (start - end).jacobian(list(m.d.actuated)) + longer)
    return sp.Matrix.vstack(*A), sp.Matrix.vstack(*B)


def _lengthened(m: Linkage) -> list[sp.Matrix]:
    """For each of these bars, what its own joint adds to the row of B."""
    found = []
    for step in m.circles:
        first, second = step.dyad.bodies
        found += [_longer(m, first), m.stretch(step) ** 2 * _longer(m, second)]
    if m.follower:
        found.append(_longer(m, m.solved[-1].dyad.bodies[1]))
    return found


def _ends(m: Linkage) -> list[tuple[sp.Matrix, sp.Matrix]]:
    """The far end and the near end of the bars of all dyads."""
    at = m.posture
    found = [(step.unknowns, centre) for step in m.circles for centre in m.centres(step, at)]
    if m.follower:
        dyad = m.solved[-1].dyad
        found.append((at[dyad.pin], at[dyad.near[1]]))
    return found


def _rows_at(m: Linkage, at: Posture) -> tuple[sp.Matrix, sp.Matrix]:
    """A and B in the names of the program."""
    bars = [bar for spans in at.spans for bar in spans]
    if m.follower:
        del bars[-2]  # the follower turns, so only the rod is a row
    known: dict[sp.Basic, sp.Expr] = {}
    for step in m.circles:
        known |= dict(zip(step.unknowns, at.points[step.goal], strict=True))
    if m.follower:
        pin = m.solved[-1].pin
        crank, psi = m.crank(m.follower, pin), m.hand[0]
        arm = (at.points[pin] - crank.base) / sp.sympify(crank.length, strict=True)
        known[sp.cos(psi)] = arm.dot(sp.Matrix(crank.along))
        known[sp.sin(psi)] = arm.dot(sp.Matrix(crank.across))
    A, B = _rows(m, bars)
    return A.xreplace(known), B.xreplace(known)


__all__ = ["Posture", "linkage"]
