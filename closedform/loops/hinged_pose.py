"""What the article says of a hand on hinged legs: its pose, and how it moves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from closedform.lemmas.legs import vector
from closedform.loops.guides import Placed
from closedform.loops.hinges import TILTED, Hinges, InPlane, StandingPlane, TurningPlane
from closedform.loops.letters import letters
from closedform.loops.mast import BallOnMast, Mast
from closedform.loops.spindle import Spindle
from closedform.loops.three_hinges import PSI, ThreeHinges
from closedform.loops.tripod_legs import sum_of_cosines
from closedform.mechanics.frames import homogeneous
from closedform.model.derivation import Derivation
from closedform.model.functions import Program
from closedform.model.step import Step

IN_PLANE = (
    "The axes of the revolute joints on the hand are at right angles to the first axis of the "
    "universal joints, so the hand stays in a plane through this axis.  The plane turns about it "
    "by turn_1, and v is its normal.  The hand turns in the plane, about v, by turn_2.  R is the "
    "rotation of the hand.  The distance of the hand is measured in the plane, at right angles to "
    "the axis.  "
)
ON_AXIS = (
    "The universal joints on the hand turn it about an axis of its own, v, and about an axis of "
    "the ground, which is the normal of a plane.  So v stays in this plane.  The hand turns in it "
    "by turn_1, and about v by turn_2.  R is the rotation of the hand.  "
)
TILTS = (
    "The hand is twisted about its own z axis, then turned by tilt_x about the x axis of the base "
    "and by tilt_y about the y axis.  This is its rotation R.  "
)
LINE = (
    "The hand is an axis, on which all legs end.  It is turned by turn_1 about an axis that is "
    "fixed to the ground, and by turn_2 about an axis that the first turn moves.  This is R, the "
    "rotation of the hand, up to the turn about its own axis, which moves no leg.  "
)
MAST = (
    "A slide moves the universal joint along a mast by the travel.  This joint turns the hand by "
    "turn_1 about an axis that stands still, and by turn_2 about an axis that the first turn "
    "moves.  R is the rotation of the hand, and its point p is the centre of the joint.  "
)
BALL = (
    "A slide moves the ball joint along a mast by the travel.  The hand is turned by turn_1 about "
    "an axis that stands still, by turn_2 about an axis that the first turn moves, and by turn_3 "
    "about an axis of its own.  R is the rotation of the hand, and its point p is the centre of "
    "the ball.  "
)
HINGED = (
    "A hinge keeps leg k in a plane, whose normal m is an axis of the ground, or of the hand.  "
    "So m is at right angles to the vector from the base of the leg to its end on the hand.  For "
    "a given rotation this is linear in the position p of the hand, and gives {them}."
)

TWISTED = (
    "The hand is twisted by psi about its own z axis, then turned by tilt_x about the x axis of "
    "the base and by tilt_y about its y axis.  A hinge keeps leg k in a plane of the hand, whose "
    "normal is its axis: it is at right angles to the vector from the base of the leg to its end "
    "on the hand.  This gives three equations.  The sum of the axes, each times a weight, is zero. "
    " So the sum of the equations with these weights does not contain p.  It is f*cos(psi) + "
    "g*sin(psi) = 0, and gives the twist.  Then two of the equations are linear in the x and y of "
    "p.  The other solution for the twist differs by half a turn and is left out."
)

WORDS: dict[type, str] = {
    TurningPlane: IN_PLANE,
    StandingPlane: ON_AXIS,
    Spindle: LINE,
    Mast: MAST,
    BallOnMast: BALL,
}
"""How a target says what the pose is; without an entry it is a height, two tilts and a twist."""


def state_pose(d: Derivation, guide: Hinges, places: Sequence[sp.Matrix], at: Placed) -> Step:
    """The step on the pose of the hand, and the function that returns it."""
    if isinstance(guide, ThreeHinges):
        return _state_twisted(d, guide, places, at)
    p = d.program()
    placed = guide.place(p, places)
    plane = guide if isinstance(guide, InPlane) else None
    them = "its place along the axis" if plane else "its place sideways, x and y"
    d.explain({"R": "rotation of the hand", r"\mathbf p": "position of the point of the hand"})
    shown: dict[str, Any] = {"R": at.rotation, r"\mathbf p": vector(guide.pivot) + at.shift}
    proves = "R is a rotation.  "
    equal: list[tuple[Any, Any]] = [(at.rotation.T * at.rotation, sp.eye(3))]
    if plane:
        a, b, _ = plane.joint.axes
        v, turns = at.rotation * b, isinstance(plane, TurningPlane)
        (letter,) = letters(d, "v")
        name = rf"\mathbf {letter}"
        d.explain({name: "normal of the plane" if turns else "axis of the hand"})
        shown[name] = v
        equal.append((v.dot(a), sp.S.Zero))
        normal = v if turns else a
        equal += [((at.shift + at.levers[k]).dot(normal), sp.S.Zero) for k in plane.inside]
        proves += f"{letter} is at right angles to the first axis, and the legs end in the plane.  "
    for k, h in guide.hinged:
        normal = at.rotation * h.axis if h.on_hand else h.axis
        span = vector(guide.pivot) + at.arms[k] - h.leg.base
        equal.append((normal.dot(span), sp.S.Zero))
    if guide.hinged:
        proves += "The hinged legs are in their planes.  "
    step = d.step(
        "Pose of the hand",
        WORDS.get(type(guide), TILTS) + HINGED.format(them=them) * bool(guide.hinged),
        shown,
        proves=proves.rstrip(),
        equal=equal,
    )
    _export(d, guide, p, placed, "Pose of the hand, which the target determines.")
    return step


def _state_twisted(
    d: Derivation, guide: ThreeHinges, places: Sequence[sp.Matrix], at: Placed
) -> Step:
    """The same if the twist of the hand follows from its tilts."""
    p = d.program()
    placed = guide.place(p, places)
    f, g = (guide.balance(turned) for turned in (False, True))
    pair = (sp.cos(PSI), sp.sin(PSI))
    d.write("psi", r"\psi", "twist of the hand about its own z axis")
    d.explain(
        {
            "f": "coefficient of cos(psi) in the equation of the twist",
            "g": "coefficient of sin(psi) in the equation of the twist",
            r"\delta": "amplitude of the equation of the twist",
            "R": "rotation of the hand",
            r"\mathbf p": "position of the point of the hand",
        }
    )
    axes = [h.axis for _, h in guide.hinged]
    off = [
        (at.rotation * h.axis).dot(vector(guide.pivot) + at.arms[k] - h.leg.base)
        for k, h in guide.hinged
    ]
    total = sum((w * m for w, m in zip(guide.weights, axes, strict=True)), sp.zeros(3, 1))
    plain, apart = sum_of_cosines(TILTED[1:3])
    step = d.step(
        "Pose of the hand",
        TWISTED,
        {
            r"R\,R_z(\psi)^{-1}": guide.tilted,
            "f": f,
            "g": g,
            r"\delta": r"\sqrt{f^2 + g^2}",
            r"\cos\psi": r"\frac{g}{\delta}",
            r"\sin\psi": r"-\frac{f}{\delta}",
            r"\mathbf p": vector(guide.pivot) + at.shift,
        },
        proves="The weighted axes add up to zero.  The legs of two hinges are in their planes, and "
        "for the third the distance from its plane, times its weight, is minus f*cos(psi) + "
        "g*sin(psi), up to the sign that makes the twist small.  Both forms of the sum of cosines "
        "are equal.",
        equal=[
            (at.rotation.T * at.rotation, sp.eye(3)),
            (total, sp.zeros(3, 1)),
            (sp.Matrix(off[:2]), sp.zeros(2, 1)),
            (guide.weights[2] * off[2], -guide.side * guide.rest(*pair)),
            (guide.rest(*pair).diff(PSI), g * pair[0] - f * pair[1]),
            (plain, apart),
        ],
    )
    summary = "Pose of the hand: its twist and its sideways motion follow from the target."
    _export(d, guide, p, placed, summary)
    return step


def _export(d: Derivation, guide: Hinges, p: Program, placed: Placed, summary: str) -> None:
    d.function(
        "hand_pose",
        summary,
        guide.inputs,
        {"T": homogeneous(placed.rotation, vector(guide.pivot) + placed.shift)},
        program=p,
        notes=(f"Not finite where the hinges do not fix the {guide.fixes} of the hand.",)
        * guide.loose,
    )


def motions(guide: Hinges, at: Placed) -> list[tuple[Any, Any]]:
    """That the hand moves as the rows of A have it."""
    found: list[tuple[Any, Any]] = []
    for x, axis, move in zip(guide.target, at.turns, at.moves, strict=True):
        found.append((guide.rate(at.shift, x), move))
        found += [(guide.rate(lever, x), axis.cross(lever)) for lever in at.levers]
    return found


__all__ = ["motions", "state_pose"]
