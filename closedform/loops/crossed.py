"""Crossed bars, as in a scissor lift: what they keep parallel.

Two bars are pinned to each other where both are divided in the same ratio.  By the intercept
theorem the line through two of their ends is parallel to that through the two others.  If the
latter are on a line of the ground and the former on a line of a table, the table is parallel to
the ground.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, permutations

import sympy as sp

from closedform.lemmas.legs import cross_in_plane
from closedform.loops.linkage import GROUND
from closedform.loops.sliding import SlidingLinkage
from closedform.model.functions import real
from closedform.model.step import Step


@dataclass(frozen=True)
class Crossed:
    """Two bars that cross at ``pin``; ``way`` is the line of the ground, ``along`` of ``body``.

    The ends ``near`` are on a line of the ground, the ends ``far`` on one of the body.  Both pairs
    have the end of the first bar first.
    """

    bars: tuple[str, str]
    pin: str
    near: tuple[str, str]
    far: tuple[str, str]
    ratio: sp.Expr
    body: str
    way: sp.Matrix
    along: sp.Matrix


def crossed(m: SlidingLinkage) -> list[Crossed]:
    """The crossed bars of a linkage that keep a body parallel to the ground."""
    found: dict[str, Crossed] = {}
    bars = [name for name in m.bodies if name not in m.cylinders and len(m.points[name]) > 2]
    for a, b in combinations([name for name in bars if name != GROUND], 2):
        for pin in [p for p in m.points[a] if p in m.points[b]]:
            for near, far, ratio in _divided(m, (a, b), pin):
                if (way := _line(m, GROUND, near)) is None:
                    continue
                for body in m.bodies:
                    if body in (a, b, GROUND):
                        continue
                    if (along := _line(m, body, far)) is not None:
                        case = Crossed((a, b), pin, near, far, ratio, body, way, along)
                        found.setdefault(body, case)
    return list(found.values())


def _divided(
    m: SlidingLinkage, bars: tuple[str, str], pin: str
) -> Iterator[tuple[tuple[str, str], tuple[str, str], sp.Expr]]:
    """The ends on either side of a pin, such that it divides both bars in the same ratio."""
    first, second = (
        {
            (near, far): ratio
            for near, far in permutations([p for p in m.points[bar] if p != pin], 2)
            if (ratio := _ratio(m, bar, pin, near, far)) is not None
        }
        for bar in bars
    )
    for (near1, far1), ratio in first.items():
        for (near2, far2), other in second.items():
            if sp.simplify(ratio - other) == 0:
                yield (near1, near2), (far1, far2), ratio


def _ratio(m: SlidingLinkage, bar: str, pin: str, near: str, far: str) -> sp.Expr | None:
    """By how much farther the far end is from the near one than the pin, all in one line."""
    start = m.local(bar, near)
    inner, whole = m.local(bar, pin) - start, m.local(bar, far) - start
    if not any(inner) or sp.simplify(cross_in_plane(inner, whole)) != 0:
        return None
    ratio = sp.simplify(inner.dot(whole) / inner.dot(inner))
    return None if ratio == 1 else ratio


def _line(m: SlidingLinkage, body: str, points: tuple[str, str]) -> sp.Matrix | None:
    """The direction of a line of a body that two points never leave, one of which slides."""
    ways = [(k, s.way) for k, s in enumerate(m.slides) if body in s.between]
    for k, way in ways:
        slider = m.slides[k].other(body)
        places = [_on(m, body, p, way) for p in points]
        slides = any(p in m.points[slider] and p not in m.points[body] for p in points)
        if slides and all(places):
            one, other = (place[0] for place in places if place)
            if sp.simplify(cross_in_plane(way, one - other)) == 0:
                return way
    return None


def _on(m: SlidingLinkage, body: str, point: str, way: sp.Matrix) -> tuple[sp.Matrix, ...]:
    """A place on the line along which a point can move on a body; nothing if it can leave it."""
    if point in m.points[body]:
        return (m.local(body, point),)
    for slide in m.slides:
        if body not in slide.between or point not in m.points[other := slide.other(body)]:
            continue
        if sp.simplify(cross_in_plane(way, slide.way)) == 0:
            return (m.local(other, point) + slide.shift(other),)
    return ()


def state(m: SlidingLinkage, case: Crossed, loop: Step) -> Step:
    """The step that says what crossed bars keep parallel."""
    (a, b), (n1, n2), (f1, f2) = case.bars, case.near, case.far
    ratio = real("kappa")
    M, p, q = (sp.Matrix([real(f"{name}_{i}") for i in "xy"]) for name in ("m", "a", "b"))
    ends = [e + ratio * (M - e) for e in (p, q)]
    return m.d.step(
        f"{case.body} stays parallel",
        f"The bars {a} and {b} cross at {case.pin}, which divides both in the same ratio: the "
        f"vector from {n1} to {f1} is {case.ratio} times that from {n1} to {case.pin}, and that "
        f"from {n2} to {f2} is as many times that from {n2} to {case.pin}.  By the intercept "
        f"theorem the vector from {f1} to {f2} is {sp.simplify(1 - case.ratio)} times that from "
        f"{n1} to {n2}.  {n1} and {n2} stay on a line of the {GROUND}, and {f1} and {f2} on a line "
        f"of {case.body}.  So both lines are parallel, unless the ends coincide.",
        {},
        proves="The intercept theorem, with any places of the pin and of both near ends.",
        equal=[(ends[0] - ends[1], (1 - ratio) * (p - q))],
        uses=[loop],
    )


__all__ = ["Crossed", "crossed", "state"]
