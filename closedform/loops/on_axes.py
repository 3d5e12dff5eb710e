"""What is said of three points of a hand that legs with two motors hold by axes."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.lemmas.axial import Across, Along, FreeAlong
from closedform.lemmas.legs import Crank, Leg, Slide, Stretch, vector
from closedform.lemmas.turret import Around, OnTurret
from closedform.loops.letters import letters
from closedform.loops.platform_legs import Platform
from closedform.model.names import listed
from closedform.model.step import Step

Planar = FreeAlong | OnTurret
"""Legs that move in a plane, as a crank or a slider with a rod."""


def close_on_axes(m: Platform) -> Step:
    """The step on the loop."""
    (e,) = letters(m.d, "e")
    pairs = [*zip(m.legs[::2], m.places[::2], strict=True)]
    rows = [
        (str(k), str(leg.joint), leg.base.T, _axis(leg).T, place.T)
        for k, (leg, place) in enumerate(pairs, 1)
    ]
    return m.d.step(
        "The loop",
        "Three points of the hand are held by axes of the ground.  Its pose is the position p of "
        "one of its points, and R, by which it is turned.  The axis k passes a_k and has the "
        f"direction u_k, and a leg from there ends at a ball joint, which is {e} in the frame of "
        f"the hand, so at p + R*{e}.  {_along(m)}{_around(m)}".rstrip(),
        {},
        rows=[("k", "first motor", "a", "u", e), *rows],
    )


def _axis(leg: Leg) -> sp.Matrix:
    return vector(leg.axis) if isinstance(leg, Around) else leg.rate


def _names(legs: Sequence[Leg]) -> str:
    return listed([str(leg.joint) for leg in legs])


def _motors(noun: str, legs: Sequence[Leg], verb: str) -> str:
    """The start of a sentence on one motor or on several."""
    one = len(legs) == 1
    return f"The {noun}{'' if one else 's'} of {_names(legs)} {verb}{'s' if one else ''}"


def _along(m: Platform) -> str:
    """What sliders along axes do, and the second motors of their legs."""
    sliders = [leg for leg in m.legs if isinstance(leg, Along)]
    if not sliders:
        return ""
    told = (
        f"{_motors('slider', sliders, 'move')} along the axis, with a leg in the plane at right "
        "angles to it.  So this joint is the coordinate of the ball joint along the axis.  "
    )
    if any(isinstance(leg, Across) for leg in m.legs):
        told += (
            "A leg that turns about the axis and stretches has the length that is the distance of "
            "the ball joint from the axis.  "
        )
    return told + _rods(m, FreeAlong, "In this plane")


def _around(m: Platform) -> str:
    """What turrets do, and the second motors of their legs."""
    turrets = [leg for leg in m.legs if isinstance(leg, Around)]
    if not turrets:
        return ""
    told = (
        f"{_motors('turret', turrets, 'turn')} a plane through the axis, in which the leg moves.  "
        "So the ball joint has no part along the normal of this plane.  "
    )
    stretched = [e for e in m.legs if isinstance(e, OnTurret) and isinstance(e.leg, Stretch)]
    if stretched:
        told += f"There {_names(stretched)} is the length of a leg.  "
    return told + _rods(m, OnTurret, "There")


def _rods(m: Platform, planar: type[FreeAlong] | type[OnTurret], where: str) -> str:
    told = ""
    for kind, moves in ((Slide, "slider"), (Crank, "crank")):
        if rods := [e for e in m.legs if isinstance(e, planar) and isinstance(e.leg, kind)]:
            told += (
                f"{where} the {moves} of {_names(rods)} moves one end of a rod, which keeps its "
                f"length to the ball joint.  "
            )
    return told


def row_on_axes(m: Platform) -> str:
    """Which vectors the rows of A have, as a sentence; empty if all are those of rods."""
    if not m.axial:
        return ""
    rows = []
    if any(isinstance(leg, Along) for leg in m.legs):
        rows.append("for a slider along an axis the direction of this axis")
    if any(isinstance(leg, Around) for leg in m.legs):
        rows.append("for a turret the normal of its plane")
    if any(isinstance(leg, Across) for leg in m.legs):
        rows.append("for a leg that stretches from an axis the vector from the axis to its end")
    if any(isinstance(leg, Planar) for leg in m.legs):
        rows.append("for a leg in such a plane the vector along its rod, or along the leg")
    return f"This vector is {'; '.join(rows)}.  "


def beside_turrets(m: Platform) -> str:
    """Sentences on B, if there are turrets."""
    if not any(isinstance(leg, Around) for leg in m.legs):
        return ""
    return (
        "The entry of a turret is the distance of the ball joint from its axis, negative behind "
        "it: the part of the vector w_i from the pivot to the ball joint in the direction of the "
        "plane.  The equation of a leg in its plane does not change with the turret, where the "
        "loop closes.  "
    )


def still_on_axes(m: Platform) -> str:
    """Where B is singular."""
    cases = []
    if any(isinstance(leg, Across) for leg in m.legs):
        cases.append("a leg has the length 0")
    if any(isinstance(leg, Around) for leg in m.legs):
        cases.append("a ball joint is on the axis of its turret")
    if any(isinstance(leg, Planar) for leg in m.legs):
        cases.append("a joint moves the near end of a rod at right angles to it")
    return f"{', or '.join(cases)} (serial: the joint moves"


def still_on_turrets(m: Platform) -> list[tuple[sp.Expr, sp.Expr]]:
    """That the equation of a leg in the plane of a turret does not depend on its joint there.

    The derivative is a multiple of the equation of the turret.
    """
    pairs = []
    for k, leg in enumerate(m.legs):
        if isinstance(leg, OnTurret):
            ahead = leg.flat(m.spans[k] + m.arms[k])[0]
            pairs.append((m.loop[k].diff(leg.turret.joint), 2 * ahead * m.loop[k - 1]))
    return pairs


def solved_on_axes(m: Platform) -> str:
    """Sentences on how the joints follow."""
    told = ""
    if any(isinstance(leg, Around) for leg in m.legs):
        told += "The plane of a turret passes the ball joint, on either side of the axis.  "
    rods = [leg.leg for leg in m.legs if isinstance(leg, FreeAlong | OnTurret)]
    if any(isinstance(leg, FreeAlong) for leg in m.legs):
        told += "Seen along the axis a rod and what moves it are in a plane.  "
    if any(isinstance(leg, Crank) for leg in rods):
        told += (
            "In their plane the crank and the rod are two sides of a triangle whose sides are "
            "known.  "
        )
    if any(isinstance(leg, Slide) for leg in rods):
        told += "In its plane the end of a rod is on the line of its slider, to either side.  "
    return told


__all__ = [
    "beside_turrets",
    "close_on_axes",
    "row_on_axes",
    "solved_on_axes",
    "still_on_axes",
    "still_on_turrets",
]
