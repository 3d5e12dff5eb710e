"""Recognises legs with two motors: a slider, and on it a leg that turns and stretches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from closedform.scaffold.loops.bodies import GROUND, Joint, Loop

SPACE = 3


@dataclass(frozen=True)
class TwoMotors:
    """A leg whose slider and whose length are driven."""

    slider: Joint
    hinge: Joint
    stretch: Joint
    ball: Joint


def leg_on_axis(loop: Loop, driven: Joint) -> TwoMotors | None:
    """The leg with two motors of which a joint is one, if it is of this kind."""
    if loop.dimensions != SPACE or driven.kind != "prismatic":
        return None
    if GROUND in driven.between:
        return _from_slider(loop, driven)
    for slider in loop.of(GROUND):
        leg = _from_slider(loop, slider) if slider.driven else None
        if leg and leg.stretch is driven:
            return leg
    return None


def _from_slider(loop: Loop, slider: Joint) -> TwoMotors | None:
    """The leg that a driven slider carries."""
    joint, body = slider, slider.other(GROUND)
    path = []
    for _ in range(3):
        onward = [j for j in loop.of(body) if j is not joint]
        if len(onward) != 1:
            return None
        (joint,) = onward
        body = joint.other(body)
        path.append(joint)
    hinge, stretch, ball = path
    kinds = slider.kind, hinge.kind, stretch.kind, ball.kind
    if kinds != ("prismatic", "revolute", "prismatic", "spherical") or not stretch.driven:
        return None
    if slider.axis is None or hinge.axis is None or any(slider.axis.cross(hinge.axis)):
        return None
    return TwoMotors(slider, hinge, stretch, ball)


def in_pairs(loop: Loop, driven: Sequence[Joint]) -> list[Joint]:
    """Driven joints in their order, but both motors of a leg one after the other."""
    found: list[Joint] = []
    for joint in driven:
        leg = leg_on_axis(loop, joint)
        found += [j for j in ((leg.slider, leg.stretch) if leg else (joint,)) if j not in found]
    return found


def told(leg: TwoMotors) -> str:
    """What a leg is, in words."""
    return (
        f"{leg.slider.name} moves a slider, on which a leg turns about its axis, whose length is "
        f"{leg.stretch.name}"
    )


__all__ = ["TwoMotors", "in_pairs", "leg_on_axis", "told"]
