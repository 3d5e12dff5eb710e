"""A pantograph: three points of a linkage that stay in line, at distances in a constant ratio.

An arm and a shin are pinned to each other, and two links complete a parallelogram with parts of
both.  The pin of the links divides the line from the end of the arm to that of the shin as the
parallelogram divides both.  So if two slides hold two of the three points on lines, the third one
determines both: legs of walking machines are of this kind.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import permutations

import sympy as sp

from closedform.lemmas.legs import cross_in_plane
from closedform.loops.linkage import GROUND
from closedform.loops.sliding import SlidingLinkage
from closedform.model.functions import real
from closedform.model.step import Step


@dataclass(frozen=True)
class Pantograph:
    """The points ``start``, ``middle`` and ``end`` in line; the last is ``ratio`` times as far.

    The ends are points of the ``arm`` and of the ``shin``, and the ``links`` are pinned to each
    other in the middle.
    """

    arm: str
    shin: str
    links: tuple[str, str]
    points: tuple[str, str, str]
    ratio: sp.Expr
    sliders: Mapping[str, int]
    """The points that slides hold on lines of the ground, with the numbers of these slides."""

    @property
    def shares(self) -> dict[str, sp.Expr]:
        """The multiples of the three points whose sum vanishes."""
        return dict(zip(self.points, (1 - self.ratio, self.ratio, -sp.S.One), strict=True))


def pantograph(m: SlidingLinkage) -> Pantograph | None:
    """The pantograph of a linkage whose hand is one of its points, and two slides hold the others.

    None if there is no such pantograph, or if both slides are parallel.
    """
    for arm, shin, links, points, ratio in _pantographs(m):
        others = [p for p in points if p != m.hand_at]
        sliders = {p: k for p in others if (k := _slide(m, p)) is not None}
        if len(others) == len(sliders) == len(points) - 1:
            first, second = (m.slides[k].way for k in sliders.values())
            if sp.simplify(cross_in_plane(first, second)) != 0:
                return Pantograph(arm, shin, links, points, ratio, sliders)
    return None


def _slide(m: SlidingLinkage, point: str) -> int | None:
    """The slide on the ground of a body that has a point."""
    for k, slide in enumerate(m.slides):
        if GROUND in slide.between and point in m.points[slide.other(GROUND)]:
            return k
    return None


def _pantographs(
    m: SlidingLinkage,
) -> Iterator[tuple[str, str, tuple[str, str], tuple[str, str, str], sp.Expr]]:
    """The pantographs of a linkage: arm, shin, links, points in line, and the ratio."""
    bodies = [name for name in m.bodies if name != GROUND and name not in m.cylinders]
    for arm, shin in permutations(bodies, 2):
        for pin in [p for p in m.points[arm] if p in m.points[shin]]:
            for start, near, ratio in _in_line(m, arm, pin):
                for far, end, other in _in_line(m, shin, pin, ahead=False):
                    if sp.simplify(ratio - other) != 0:
                        continue
                    sides = m.length(arm, near, pin), m.length(shin, pin, far)
                    for links, middle in _links(m, (arm, shin), (near, far), sides):
                        yield arm, shin, links, (start, middle, end), ratio


def _in_line(
    m: SlidingLinkage, body: str, pin: str, *, ahead: bool = True
) -> Iterator[tuple[str, str, sp.Expr]]:
    """Two points of a body in line with its pin, and a ratio.

    Of the arm, by which factor the pin is farther from the first point than the second one is; of
    the shin, by which the second point is farther from the pin than the first one is.
    """
    for first, second in permutations([p for p in m.points[body] if p != pin], 2):
        begin, inner, outer = (first, second, pin) if ahead else (pin, first, second)
        start = m.local(body, begin)
        short, whole = m.local(body, inner) - start, m.local(body, outer) - start
        if any(short) and sp.simplify(cross_in_plane(short, whole)) == 0:
            yield first, second, sp.simplify(short.dot(whole) / short.dot(short))


def _links(
    m: SlidingLinkage,
    pair: tuple[str, str],
    near: tuple[str, str],
    sides: tuple[sp.Expr, sp.Expr],
) -> Iterator[tuple[tuple[str, str], str]]:
    """The links that complete a parallelogram, with their common pin; ``near`` are those on both.

    That on the arm is as long as the second side, and that on the shin as the first one.
    """
    bodies = [b for b in m.bodies if b not in (*pair, GROUND) and b not in m.cylinders]
    for first, second in permutations(bodies, 2):
        shared = [p for p in m.points[first] if p in m.points[second]]
        for middle in shared:
            if near[0] not in m.points[first] or near[1] not in m.points[second]:
                continue
            if middle in (*m.points[pair[0]], *m.points[pair[1]]):
                continue
            gaps = (
                m.length(first, near[0], middle) - sides[1],
                m.length(second, near[1], middle) - sides[0],
            )
            if all(sp.simplify(gap) == 0 for gap in gaps):
                yield (first, second), middle


def state(m: SlidingLinkage, case: Pantograph, loop: Step) -> Step:
    """The step that says which points are in line."""
    ratio = real("kappa")
    A, u, v = (sp.Matrix([real(f"{name}_{i}") for i in "xy"]) for name in "auv")
    start, middle, end = case.points
    return m.d.step(
        f"{start}, {middle} and {end} stay in line",
        f"The links {' and '.join(case.links)} complete a parallelogram with {case.arm} and "
        f"{case.shin}, which have the same ratio {case.ratio} of the whole length to the part that "
        f"is beside it.  So {end} is {case.ratio} times as far from {start} as {middle} is, in the "
        f"same direction.  The postures in which the parallelogram is crossed are left out of the "
        f"inverse.",
        {},
        proves="With any place of the first point and any sides of the parallelogram.",
        equal=[(A + ratio * u + ratio * v - A, ratio * (A + u + v - A))],
        uses=[loop],
    )


__all__ = ["Pantograph", "pantograph", "state"]
