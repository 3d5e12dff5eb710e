"""What keeps a hand on four legs upright, so that it turns about the z axis alone.

Rods with universal joints do, whose outer axes are vertical.  The hand may also consist of two
halves, which parallelograms keep from turning; one or two bars join them, and turn.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import cross_in_plane
from closedform.lemmas.parallelogram import Parallelogram
from closedform.lemmas.universal import Universal
from closedform.loops.held import (
    LEFT_OUT,
    TURNED,
    Held,
    check_directions,
    state_parallelograms,
    state_universals,
)
from closedform.loops.letters import letters
from closedform.loops.modes import Exported
from closedform.loops.platform_legs import Platform
from closedform.model.step import Step

TWO_BARS = (
    "Two equal, parallel bars with vertical pins join the halves, so both halves turn with one "
    "rate, and the bars turn against them about z alone.  So the halves cannot turn, unless all "
    "normals are in one plane (constraint singularity)."
)
ONE_BAR = (
    "One bar with vertical pins joins the halves, so both tilt with one rate, and each may turn "
    "about z by itself.  The two parallelograms of a half leave it a turn about the cross product "
    "of their normals.  So the halves cannot turn, unless the horizontal parts of both cross "
    "products are parallel (constraint singularity)."
)


def check_upright(m: Platform) -> None:
    """Refuse legs that do not keep the hand upright."""
    name = m.d.name
    kind = Parallelogram if m.halves else Universal
    check_directions(name, 3, m.legs)
    if 0 < len(m.halves) < len(m.legs):
        raise ShapeError(f"{name}: all four legs end on a Half of the hand, or none does")
    if not all(isinstance(leg.rod, kind) for leg in m.legs):
        needed = (
            "a hand of two halves needs rods that are a Parallelogram"
            if m.halves
            else "a hand on four legs needs rods with universal joints, Universal or Stretch with "
            "an axis, whose axes are vertical, or two halves, Half, on parallelograms"
        )
        raise ShapeError(f"{name}: {needed}, to keep it upright")
    directions = [leg.rod.direction for leg in m.legs]
    if not m.halves and any(sp.simplify(e) != 0 for v in directions for e in v[:2]):
        raise ShapeError(
            f"{name}: the axes of the universal joints have to be vertical, along z; then the hand "
            f"turns about z alone"
        )
    if m.halves and sorted(map(m.places.count, m.places)) != [2, 2, 2, 2]:
        raise ShapeError(f"{name}: two legs end on each half of the hand, at one pin")


def state_upright(m: Platform, loop: Step) -> None:
    """The step on what keeps the hand upright."""
    shown = [(k, leg.rod.direction) for k, leg in m.numbered]
    u, normal, part = letters(m.d, "unm")
    if m.halves:
        then = (
            "  Each parallelogram takes one freedom of turning from the half that it holds: "
            f"the rate omega with which it turns is at right angles to the normal {normal} of the "
            f"parallelogram.  {ONE_BAR if m.bars == 1 else TWO_BARS}"
        )
        state_parallelograms(Held(m.d, m.numbered, loop, shown, then))
        return
    then = (
        f"  Here {u} is vertical in all legs, so the hand may turn about z.  Each leg takes "
        "one freedom of tilting from it: the rate omega with which it turns is at right angles to "
        f"{part}, the part of the rod across the outer axes, which is horizontal.  So the hand "
        f"cannot tilt, unless all vectors {part} are parallel (constraint singularity)."
    )
    state_universals(Held(m.d, m.numbered, loop, shown, then))


def constraint(m: Platform, rods: Sequence[sp.Matrix]) -> Exported:
    """The function whose factors all vanish where the hand can tilt."""
    couples = [leg.rod.couple(rod) for leg, rod in zip(m.legs, rods, strict=True)]
    if m.bars == 1:
        first = [k for k, place in enumerate(m.places) if place == m.places[0]]
        of_halves = first, [k for k in range(len(couples)) if k not in first]
        left = [couples[i].cross(couples[j]) for i, j in of_halves]
        factors = [cross_in_plane(*left)]
        of = "the horizontal parts of two vectors, each the cross product of the normals of the "
        end = (
            "parallelograms of a half (unit vector along the bars times the vector along the rods)."
        )
    elif m.halves:
        factors = [sp.Matrix.hstack(*some).det() for some in combinations(couples, 3)]
        of = "three normals of the parallelograms (unit vector along the bars times the vector "
        end = "along the rods), for each three of the four legs."
    else:
        factors = [cross_in_plane(one, other) for one, other in combinations(couples, 2)]
        of, end = "the horizontal parts of two rods, ", "for each two of the four legs."
    return (
        "constraint",
        "The factors that all vanish where the legs do not keep the hand upright.",
        {"factors": factors},
        (f"The determinant of {of}{end}",),
    )


def left_out(m: Platform) -> str:
    """A note on the postures that are left out, in which the hand is tilted."""
    return LEFT_OUT if m.halves else TURNED


__all__ = ["check_upright", "constraint", "left_out", "state_upright"]
