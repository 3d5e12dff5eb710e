"""Recognises a hand that hinges let move along a line alone, as the table of a Sarrus linkage."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from closedform.model.names import listed
from closedform.scaffold.loops.bodies import GROUND, Joint, Loop

TRAVEL = "travel"
"""The joint that takes the place of the legs that hold the hand, and is the task."""


@dataclass(frozen=True)
class _Flat:
    """A leg of parallel hinges from the ground to the hand, which keeps the hand in a plane."""

    joints: Sequence[Joint]
    bodies: Sequence[str]
    normal: sp.Matrix

    @property
    def driven(self) -> bool:
        return any(j.driven for j in self.joints)


def on_line(loop: Loop) -> Loop:
    """The loop with a slide in the place of the legs that let the hand move along a line alone.

    Such a leg has parallel hinges.  The hand cannot turn and stays on the line in which the planes
    of two legs meet, if their hinges have different directions.
    """
    body = next((b for b, at in loop.bodies.items() if loop.hand in at and b != GROUND), None)
    if loop.dimensions == 2 or body is None or loop.hand in loop.joints:
        return loop
    flat = list(_flat_legs(loop, body))
    first = next((leg for leg in flat if leg.driven), flat[0]) if flat else None
    others = [leg for leg in flat if leg is not first]
    across = [leg for leg in others if first and not _parallel(leg.normal, first.normal)]
    if first is None or not across:
        return loop
    names = [leg.joints[0].name for leg in flat]
    if sum(j.driven for j in loop.joints.values()) != 1 or any(leg.driven for leg in others):
        raise loop.error(
            f"the legs of {listed(names)} have hinges in different directions, so {body} moves "
            f"along a line alone, as in a Sarrus linkage; one joint has to be driven"
        )
    way = _upwards(first.normal.cross(across[0].normal))
    place = _place(loop, flat, body, way)
    if place is None:
        raise loop.error(
            f"the legs of {listed(names)} would let {body} move along a line alone, as in a "
            f"Sarrus linkage, but their hinges leave it no place, or no motion: all have to be at "
            f"right angles to one line, and a leg has to end as far along them as it begins"
        )
    gone = [leg for leg in flat if not leg.driven]
    like = _size(loop, first, body, way) if first.driven else None
    unlike = [leg for leg in gone if like is None or _size(loop, leg, body, way) != like]
    return _with_slide(loop, body, (place, way), gone, unlike)


def _with_slide(
    loop: Loop,
    body: str,
    line: tuple[sp.Matrix, sp.Matrix],
    gone: Sequence[_Flat],
    unlike: Sequence[_Flat],
) -> Loop:
    """The loop without these legs, and with a slide from the ground to the hand."""
    place, way = line
    removed = {b for leg in gone for b in leg.bodies}
    cut = {j.name for leg in gone for j in leg.joints}
    bodies = {b: at for b, at in loop.bodies.items() if b not in removed}
    bodies[body] = {p: (at + place).applyfunc(sp.simplify) for p, at in bodies[body].items()}
    joints = {name: j for name, j in loop.joints.items() if name not in cut}
    travel = TRAVEL + "_1" * (TRAVEL in joints or TRAVEL in {*loop.parameters, *loop.symbols})
    joints[travel] = Joint(travel, "prismatic", (GROUND, body), loop.hand, way, driven=False)
    direction = ", ".join(map(str, way))
    names = listed([leg.joints[0].name for leg in unlike])
    beyond = (
        f"The reach of the leg{'s' * (len(unlike) > 1)} of {names} is not examined, because its "
        f"sizes are not those of a driven leg."
    )
    if unlike:
        loop.notes.append(f"{loop.file}: {beyond}")
    said = (
        f"Hinges in two directions keep {body} from turning and let it move along "
        f"({direction}) alone, as in a Sarrus linkage: {travel} is the coordinate of {loop.hand}."
        + f"  {beyond}"
        * bool(unlike)
    )
    left = replace(
        loop,
        hand=travel,
        bodies=bodies,
        rods={b: r for b, r in loop.rods.items() if b not in removed},
        joints=joints,
        said=[*loop.said, said],
    )
    unused = loop.symbols - left.symbols
    return replace(left, parameters={n: g for n, g in left.parameters.items() if n not in unused})


def _size(loop: Loop, leg: _Flat, body: str, way: sp.Matrix) -> tuple[sp.Expr, ...] | None:
    """The lengths of the plates of a leg, and how far apart its ends are across the line."""
    aside = leg.normal.cross(way)
    lengths = []
    for name, a, b in zip(leg.bodies, leg.joints, leg.joints[1:], strict=False):
        at = loop.bodies[name]
        if name in loop.rods:
            lengths.append(loop.rods[name])
        elif a.at in at and b.at in at:
            span = at[b.at] - at[a.at]
            lengths.append(sp.sqrt(span.dot(aside) ** 2 + span.dot(way) ** 2))
        else:
            return None
    ends = loop.bodies[GROUND][leg.joints[0].at] - loop.bodies[body][leg.joints[-1].at]
    return tuple(sp.simplify(e) for e in (*lengths, sp.Abs(ends.dot(aside))))


def _flat_legs(loop: Loop, body: str) -> Iterator[_Flat]:
    """The legs of three hinges with parallel axes."""
    for start in loop.of(GROUND):
        joints, bodies = [start], [start.other(GROUND)]
        while bodies[-1] != body:
            onward = [j for j in loop.of(bodies[-1]) if j is not joints[-1]]
            if len(onward) != 1 or onward[0].other(bodies[-1]) in {GROUND, *bodies}:
                break
            joints.append(onward[0])
            bodies.append(onward[0].other(bodies[-1]))
        axes = [j.axis for j in joints if j.kind == "revolute" and j.axis is not None]
        if bodies[-1] != body or len(joints) != 3 or len(axes) != 3:
            continue
        if all(_parallel(axes[0], axis) for axis in axes[1:]):
            yield _Flat(joints, bodies[:-1], axes[0])


def _parallel(a: sp.Matrix, b: sp.Matrix) -> bool:
    return a.cross(b).applyfunc(sp.simplify).is_zero_matrix is True


def _upwards(v: sp.Matrix) -> sp.Matrix:
    """The unit vector of a direction, whose last coordinate that is not zero is positive."""
    unit = (v / sp.sqrt(v.dot(v))).applyfunc(sp.simplify)
    last = next(e for e in reversed(unit) if e != 0)
    return -unit if last.could_extract_minus_sign() else unit


def _place(loop: Loop, legs: Sequence[_Flat], body: str, way: sp.Matrix) -> sp.Matrix | None:
    """The point of the line that is nearest to the origin; None if the legs do not agree on one."""
    unknown = sp.Matrix(sp.symbols("x:3"))
    equations = [unknown.dot(way)]
    for leg in legs:
        near, far = leg.joints[0].at, leg.joints[-1].at
        on_ground, on_hand = loop.bodies[GROUND].get(near), loop.bodies[body].get(far)
        if on_ground is None or on_hand is None or sp.simplify(leg.normal.dot(way)) != 0:
            return None
        apart = sp.zeros(3, 1)
        for name, a, b in zip(leg.bodies, leg.joints, leg.joints[1:], strict=False):
            at = loop.bodies[name]
            if a.at in at and b.at in at:
                apart += at[b.at] - at[a.at]
        gap = unknown + on_hand - on_ground - apart
        equations.append(sp.expand(gap.dot(leg.normal)))
    found = sp.solve(equations, list(unknown), dict=True)
    return unknown.subs(found[0]) if found else None


__all__ = ["on_line"]
