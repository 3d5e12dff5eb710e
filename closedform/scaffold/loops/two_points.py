"""Reads a body that has two points as the rod that it is: a rod between its joints."""

from __future__ import annotations

import sympy as sp

from closedform.scaffold.loops.bodies import GROUND
from closedform.scaffold.loops.legs import Legs

PINS = {"revolute", "spherical", "universal"}


def read_rods(found: Legs) -> None:
    """Give the bodies that are rods a length in the place of their two points.

    They are on a driven body, or on the rod that is on it.  The latter is no rod if it has the
    point of the hand, because then it is the hand.
    """
    loop = found.loop
    ends = [j.other(GROUND) for j in found.driven() if GROUND in j.between]
    for second in (False, True):
        beside = [j.other(body) for body in ends for j in loop.of(body)]
        rods = [
            body
            for body in dict.fromkeys(beside)
            if body not in loop.rods
            and _is_rod(found, body)
            and not (second and loop.hand in loop.bodies[body])
        ]
        for body in rods:
            first, last = loop.bodies[body].values()
            loop.rods[body], loop.bodies[body] = found.length(last - first), {}
        ends = [body for body in dict.fromkeys(beside) if body in loop.rods]


def _is_rod(found: Legs, body: str) -> bool:
    """Whether a body has two points, which differ, and is pinned in both and nowhere else."""
    loop, joints = found.loop, found.loop.of(body)
    points = loop.bodies[body]
    return (
        len(points) == 2
        and {j.at for j in joints} == {*points}
        and all(j.kind in PINS and not j.driven and j.name != loop.hand for j in joints)
        and all(GROUND not in j.between for j in joints)
        and any(map(sp.simplify, sp.Matrix.hstack(*points.values()) * sp.Matrix([1, -1])))
    )


__all__ = ["read_rods"]
