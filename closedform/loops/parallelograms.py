"""Parallelograms of a planar linkage, which keep a body parallel to another one.

Two bars of the same length are pinned to both bodies, as far apart on one as on the other.  So the
bodies are parallel, unless the parallelogram is crossed.  Heads of palletizers and of cranes are
held so, by one parallelogram after the other.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations

import sympy as sp

from closedform.loops.hand import square
from closedform.loops.linkage import GROUND, Linkage
from closedform.mechanics.assur import Parallel
from closedform.model.functions import real
from closedform.model.names import listed
from closedform.model.step import Step


@dataclass(frozen=True)
class Side:
    """A body that two bars keep parallel to the body ``like``, with the pins on both, in order."""

    body: str
    like: str
    bars: tuple[str, str]
    on: tuple[str, str]
    of: tuple[str, str]


def sides(m: Linkage) -> list[Side]:
    """The bodies of a linkage that parallelograms keep parallel to others, in both directions."""
    bodies = [name for name in m.bodies if name not in m.cylinders]
    found = []
    for body, like in permutations(bodies, 2):
        if body == GROUND:
            continue
        bars = list(_bars(m, bodies, body, like))
        for k, (first, r1, p1) in enumerate(bars):
            for second, r2, p2 in bars[k + 1 :]:
                if first == second or r1 == r2 or p1 == p2:
                    continue
                apart = m.squared(body, r1, r2) - m.squared(like, p1, p2)
                length = m.squared(first, r1, p1) - m.squared(second, r2, p2)
                if sp.simplify(apart) == 0 and sp.simplify(length) == 0:
                    found.append(Side(body, like, (first, second), (r1, r2), (p1, p2)))
    return found


def _bars(
    m: Linkage, bodies: Sequence[str], body: str, like: str
) -> Iterator[tuple[str, str, str]]:
    """The bodies that are pinned to both, each with its pins."""
    for bar in bodies:
        if bar in (body, like, GROUND):
            continue
        for r in m.points[bar]:
            for p in m.points[bar]:
                if r != p and r in m.points[body] and p in m.points[like]:
                    yield bar, r, p


def parallel_to_ground(m: Linkage) -> list[Parallel]:
    """The bodies that one parallelogram after the other keeps parallel to the ground."""
    all_sides, found = sides(m), {GROUND: Parallel(GROUND, "", ())}
    while new := [s for s in all_sides if s.like in found and s.body not in found]:
        side = new[0]
        bars = (*found[side.like].bars, side.bars)
        found[side.body] = Parallel(side.body, "", bars)
    del found[GROUND]
    return list(found.values())


def home(m: Linkage, body: str) -> sp.Matrix:
    """The turn from the coordinates of a body to those of the ground, to which it is parallel."""
    all_sides = sides(m)
    ways: dict[str, sp.Matrix] = {GROUND: sp.eye(2)}
    while body not in ways:
        side = next(s for s in all_sides if s.like in ways and s.body not in ways)
        own, other = m.span(side.body, *side.on), ways[side.like] * m.span(side.like, *side.of)
        u, v = own.dot(other), own[0] * other[1] - own[1] * other[0]
        ways[side.body] = (sp.Matrix([[u, -v], [v, u]]) / square(own)).applyfunc(sp.simplify)
    return ways[body]


def state(m: Linkage, bodies: Sequence[str], loop: Step) -> Step:
    """The step that says which bodies parallelograms keep parallel to the ground."""
    near, far, span = (sp.Matrix([real(f"{n}_{i}") for i in "xy"]) for n in ("a", "b", "e"))
    kept = [s for s in sides(m) if s.body in bodies]
    told = [f"{s.body} parallel to {s.like} by {listed(s.bars)}" for s in _first(kept)]
    return m.d.step(
        "Parallelograms",
        f"Two bars of the same length, which are as far apart on one body as on another one, keep "
        f"both bodies parallel: {'; '.join(told)}.  So {listed(bodies)} keep their direction.  The "
        f"postures in which a parallelogram is crossed are left out of the inverse.",
        {},
        proves="If the ends of a bar are at a and b, and the other bar begins at a + e and ends at "
        "b + e, both have the same length.",
        equal=[(square((far + span) - (near + span)), square(far - near))],
        uses=[loop],
    )


def _first(kept: Sequence[Side]) -> list[Side]:
    """One side of each body, by which it is parallel to the ground or to one before."""
    found: dict[str, Side] = {}
    while new := [s for s in kept if s.body not in found and s.like in (GROUND, *found)]:
        found[new[0].body] = new[0]
    return list(found.values())


__all__ = ["home", "parallel_to_ground", "state"]
