"""Recognises a hand of two halves, which one bar joins, or two parallel ones, as in a Par 4."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.scaffold.loops.bodies import GROUND, Joint, Loop
from closedform.scaffold.loops.spherical import through_one_point

PAIR = 2
UP = sp.Matrix([0, 0, 1])


@dataclass(frozen=True)
class Pin:
    """A pin that joins a half to a bar."""

    joint: Joint
    on_half: sp.Matrix
    on_bar: sp.Matrix


def halves(loop: Loop) -> tuple[dict[str, Pin], int]:
    """The halves of the hand, with their pins on the bar that has its point, and how many bars.

    There are none if the hand is one body.
    """
    bars = [body for body, points in loop.bodies.items() if loop.hand in points]
    if loop.dimensions != 3 or len(bars) != 1 or through_one_point(loop):
        return {}, 0
    (bar,) = bars
    pins = [j for j in loop.of(bar) if j.kind == "revolute" and _may_be_half(loop, j.other(bar))]
    if len(pins) != PAIR or any(j.driven or GROUND in j.between for j in pins):
        return {}, 0
    found = {j.other(bar): _pin(loop, j, bar) for j in pins}
    second = {
        j.other(half) for half in found for j in loop.of(half) if j.other(half) not in loop.rods
    } - {bar}
    if len(second) > 1:
        more = " and ".join(sorted(second))
        raise loop.error(f"{more} join {' and '.join(found)} beside {bar}; two bars are enough")
    if second:
        _check_parallel(loop, found, bar, *second)
    return found, 1 + len(second)


def _may_be_half(loop: Loop, body: str) -> bool:
    """Whether a body is neither a rod nor part of a leg that stretches."""
    return body not in loop.rods and not any(j.driven for j in loop.of(body))


def _pin(loop: Loop, joint: Joint, bar: str) -> Pin:
    half = joint.other(bar)
    if joint.axis is None or joint.axis.cross(UP) != sp.zeros(3, 1):
        raise loop.error(f"{joint.name} joins {bar} and {half}; its axis has to be [0, 0, 1]")
    for body in (bar, half):
        if joint.at not in loop.bodies[body]:
            raise loop.error(f"{body} has no point {joint.at}, where {joint.name} is")
    return Pin(joint, loop.bodies[half][joint.at], loop.bodies[bar][joint.at])


def _check_parallel(loop: Loop, found: dict[str, Pin], bar: str, other: str) -> None:
    """Refuse a second bar that is not equal to the first one and parallel to it."""
    beside = [_pin(loop, j, other) for j in loop.of(other)]
    ends = {pin.joint.other(other): pin for pin in beside}
    if len(beside) != PAIR or ends.keys() != found.keys():
        raise loop.error(f"{other} has to join {' and '.join(found)}, as {bar} does")
    first, second = found
    along = [pins[second].on_bar - pins[first].on_bar for pins in (found, ends)]
    apart = [ends[half].on_half - found[half].on_half for half in found]
    if any(sp.simplify(e) != 0 for pair in (along, apart) for e in pair[0] - pair[1]):
        raise loop.error(
            f"{bar} and {other} have to be opposite sides of a parallelogram, in the coordinates "
            f"of the file"
        )


__all__ = ["Pin", "halves"]
