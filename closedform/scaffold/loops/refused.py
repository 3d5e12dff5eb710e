"""What is said of legs that are recognised and not derived: what they are, and what to do."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from closedform.model.names import listed
from closedform.scaffold.loops.bodies import AXES, GROUND, Joint, Loop
from closedform.scaffold.loops.spherical import centre_name

BALLS = ("spherical", "universal")
PAIR = 2
"""The motors of a leg of which one may be held."""
FOUR_BAR = 4
"""The bodies of a four-bar linkage, and its joints."""


def two_motors(loop: Loop, joint: Joint) -> str:
    """What is said of a driven joint of a leg in space that another one drives too.

    The leg is followed from the ground to the hand, as long as no body has a branch.
    """
    ways = [_way(loop, start) for start in loop.of(GROUND)]
    motors = next((m for m in ([j for j in way if j.driven] for way in ways) if joint in m), [])
    if len(motors) != PAIR or loop.dimensions != len(AXES):
        return ""
    return (
        f".  {motors[0].name} and {motors[1].name} drive one leg, so it has two motors.  This is "
        f"supported if one of them is a slider, about whose direction the leg turns, and the other "
        f"one stretches the leg at right angles to it, as in a 3-PRPS mechanism, or moves a rod "
        f"across it by a slider or a crank, as in a 3-PPRS mechanism; or if the first one turns "
        f"the plane of the leg about an axis in it, as in an Eclipse.  Otherwise write the "
        f"equations in Python, or hold one of both motors and describe what is left.  If both "
        f"motors of three such legs leave the ends of the legs circles, the forward problem has "
        f"degree 16"
    )


def _way(loop: Loop, joint: Joint) -> list[Joint]:
    """The joints of a leg from one on the ground on."""
    body, found = joint.other(GROUND), [joint]
    while loop.hand not in loop.bodies[body]:
        onward = [j for j in loop.of(body) if j not in found]
        if len(onward) != 1:
            break
        found.append(onward[0])
        body = onward[0].other(body)
    return found


def carried(loop: Loop, joint: Joint) -> str:
    """What is said of a driven joint that turns a body which nothing else holds."""
    alone = [body for body in joint.between if loop.of(body) == [joint]]
    if len(alone) != 1 or joint.kind != "revolute":
        return ""
    (tool,) = alone
    body = joint.other(tool)
    return (
        f".  Nothing else holds {tool}, so {joint.name} is in no loop: it is the angle of {tool} "
        f"on {body}.  Leave both out, and take a point of {body} as the hand"
    )


def arcs(loop: Loop) -> str:
    """What is said of a mechanism all of whose axes meet."""
    at = centre_name(loop)
    if not at:
        return ""
    joints = [*loop.joints.values()]
    last = [j.name for j in loop.of(GROUND) if not j.driven]
    if len(joints) == FOUR_BAR == len(loop.bodies) and len(last) == 1:
        return (
            f".  All axes meet in {at}, so this is a spherical four-bar linkage.  It is derived "
            f'with hand = "{last[0]}", the joint on the ground that is not driven; then '
            f"{loop.hand} follows from {last[0]} and the axes"
        )
    return (
        f".  All axes meet in {at}, so this is a spherical mechanism.  Read by its axes is a "
        f"five-bar linkage with two driven joints on the ground, where the hand is a point of a "
        f"rod, on the axis between both rods, and a hand on three legs of three axes each, which "
        f"is {at} itself.  Of another one, write each arc as a rod "
        f"with ball joints at the ends, whose length is their distance, and hold the hand by a "
        f"rod from {at}, or by a spherical joint there if it turns"
    )


def beyond(loop: Loop, onward: Sequence[Joint]) -> list[Joint]:
    """The passive slides on the bodies that some joints lead to."""
    return [
        j
        for first in onward
        for body in first.between
        for j in loop.of(body)
        if j.kind == "prismatic" and not j.driven
    ]


def ball_on_hand(loop: Loop, onward: Sequence[Joint]) -> str:
    """What is said of a ball that slides on the hand, as in a 3-PSP mechanism."""
    if len(onward) != 1 or onward[0].kind != "spherical":
        return ""
    joint = onward[0]
    for block in joint.between:
        onto = [j for j in loop.of(block) if j is not joint]
        if [j.kind for j in onto] == ["prismatic"] and not onto[0].driven:
            hand = onto[0].other(block)
            return (
                f".  With {joint.name} and {onto[0].name} a ball slides along a line of "
                f"{hand}, as in a 3-PSP mechanism.  This is supported if three sliders that "
                f"are parallel move three such balls, and the three lines meet in {loop.hand}, "
                f"which is the hand.  In a plane it is a hand on three pins"
            )
    return ""


def ball_on_line(loop: Loop, slide: Joint) -> str:
    """What is said of a passive slide in space whose ball ends a leg, as in a CaPaMan."""
    hands = [body for body, points in loop.bodies.items() if loop.hand in points]
    for body in slide.between:
        onto = [j for j in loop.of(body) if j is not slide]
        if [j.kind for j in onto] == ["spherical"] and onto[0].other(body) in hands:
            return (
                f".  {slide.name} leaves {onto[0].name} a line, which the motor moves.  Three "
                f"points of a hand on three lines are an equation of degree eight.  This is "
                f"supported for three horizontal lines, as of a CaPaMan, on driven sliders, or on "
                f"cranks that are parallelograms or have the axis of the line"
            )
    return ""


def driven_mast(loop: Loop, slide: Joint) -> str:
    """What is said of a driven slide that carries the joint on which the hand turns."""
    post = slide.other(GROUND)
    onward = [j for j in loop.of(post) if j is not slide]
    turning = onward[0] if len(onward) == 1 else None
    if slide.kind != "prismatic" or turning is None or turning.at != loop.hand:
        return ""
    if turning.kind not in ("universal", "spherical"):
        return ""
    return (
        f".  {slide.name} is the slide of a mast, which is supported if it is passive and one more "
        f"leg is driven.  Then {slide.name} is travel, a coordinate of the hand, and the joints of "
        f"the legs that you have follow by the same formulas"
    )


def hinges_of_leg(loop: Loop, joint: Joint) -> str:
    """What is said of a leg of hinges alone that has several bodies, as of an Omni-Wrist III."""
    way = _way(loop, joint)
    bodies = [a for first, then in pairwise(way) for a in {*first.between} & {*then.between}]
    last = {*way[-1].between} - {*bodies, GROUND}
    hinges = all(j.kind == "revolute" for j in way)
    on_hand = any(loop.hand in loop.bodies[body] for body in last)
    if loop.dimensions != len(AXES) or not hinges or not on_hand or len(bodies) < PAIR + 1:
        return ""
    return (
        f".  {listed(bodies)} are one after the other, joined by hinges alone.  A leg has a driven "
        f"body and one rod, whose ends are balls or universal joints; two hinges whose axes meet "
        f"are a universal joint.  Legs of four hinges or more, as of an Omni-Wrist III, are not "
        f"derived; if the hand is the mirror image of the ground, both have the same distance from "
        f"the plane of the middle joints, which is an equation to write in Python"
    )


def on_turning_body(loop: Loop, joint: Joint) -> str:
    """What is said of a planar linkage on a body that a motor turns, as a leg of a quadruped."""
    turned = [
        (j, body)
        for body in joint.between
        for j in loop.of(body)
        if j is not joint and GROUND in j.between and j.driven and j.kind == "revolute"
    ]
    if loop.dimensions != len(AXES) or joint.kind != "revolute" or not turned:
        return ""
    (first, body), *_ = turned
    return (
        f".  {first.name} turns {body}, which carries the rest, as on the leg of a quadruped or an "
        f"excavator that swings.  If the rest moves in a plane, write it as a file of its own, "
        f"with two coordinates, in which {body} is the ground.  Then {first.name} is that of an "
        f"arm whose other joints are two slides, x and y of that file: a table of three joints"
    )


def shafts(loop: Loop, joint: Joint) -> str:
    """What is said of a driven shaft that ends in a universal joint on its own axis."""
    near = next((j for j in loop.of(joint.other(GROUND)) if j.kind == "universal"), None)
    if near is None or joint.kind != "revolute" or near.at != joint.at:
        return ""
    return (
        f".  If {near.name} is a joint of Cardan between two shafts, write it as a body, its "
        f"cross, with a revolute joint on each shaft; all axes meet in one point, and each is "
        f"given where all joints are zero.  Two such joints one after the other are two files: "
        f"the task of the first one drives the second one"
    )


def moving_driver(loop: Loop, joint: Joint) -> str:
    """What is said of a motor between two moving bodies of a single loop."""
    follower = loop.joints.get(loop.hand)
    if follower is None or joint.kind != "revolute":
        return ""
    first, second = joint.between
    return (
        f".  A linkage has the same joints when it is seen from another of its bodies: describe it "
        f"with {first} or {second} as the ground.  Then {joint.name} is on the ground, and the "
        f"hand is the other joint there"
    )


def hinge_loop(loop: Loop) -> str:
    """What is said of a loop of more than four hinges in space; empty if it is another one."""
    count = len(loop.joints)
    hinges = all(j.kind == "revolute" and j.axis is not None for j in loop.joints.values())
    each = all(len(loop.of(body)) == PAIR for body in loop.bodies)
    if loop.dimensions != len(AXES) or not hinges or not each or count <= FOUR_BAR:
        return ""
    moves = (
        "moves by its special dimensions alone, as linkages of Goldberg, Myard and Bricard do"
        if count <= len(AXES) * PAIR
        else "leads to an equation of degree 16"
    )
    return (
        f"this is a single loop of {count} hinges in space, which {moves}; it is not derived.  Of "
        f"four hinges, those that are parallel, that meet in one point, or that are those of a "
        f"Bennett linkage are supported"
    )


def sliding_halves(loop: Loop, far: Joint) -> str:
    """What is said of a hand whose two halves slide on each other, as of an I4."""
    for half in far.between:
        for slide in loop.of(half):
            if text := halves_on(loop, slide, half):
                return text
    return ""


def halves_on(loop: Loop, slide: Joint, half: str) -> str:
    """The same of a slide between a half and another one that has the point of the hand."""
    other = slide.other(half)
    if slide.kind != "prismatic" or slide.driven or loop.hand not in loop.bodies[other]:
        return ""
    return (
        f".  {slide.name} lets {half} slide on {other}, as the halves of an I4.  Two "
        f"halves are supported if pins join them to one bar, or to two, as of an H4 or "
        f"a Par 4.  Here each leg is solved alone: it is that of a hand that does not "
        f"turn, whose position is that of its half"
    )


def ball_on_driven(loop: Loop, onward: Sequence[Joint]) -> str:
    """What is said of a driven body that ends in a ball on a hand which rods hold."""
    if loop.dimensions != len(AXES) or [j.kind for j in onward] != ["spherical"]:
        return ""
    (ball,) = onward
    hands = [body for body in ball.between if loop.hand in loop.bodies[body]]
    rods = [j for body in hands for j in loop.of(body) if j is not ball]
    if not hands or len(rods) != len(AXES) or any(j.kind not in BALLS for j in rods):
        return ""
    return (
        f".  {ball.name} is known if the driven joint is, and {len(rods)} rods turn {hands[0]} "
        f"about it: an equation of degree 8.  A hand on two arms is supported, one of them with a "
        f"hinge on the ground, and one rod"
    )


def turning_guide(loop: Loop, joint: Joint, slide: Joint) -> str:
    """What is said of a leg in a plane whose guide a motor turns, as of a 3-RPR mechanism."""
    if loop.dimensions == len(AXES):
        return ""
    return (
        f".  As {joint.name} turns the line on which {slide.name} slides, each leg of this kind "
        f"holds a point of the hand on a known line.  This is supported if all three legs are of "
        f"this kind, or are sliders with a line, and pins join what slides to the hand.  Otherwise "
        f"drive {slide.name} instead"
    )


def on_strut(loop: Loop, onward: Sequence[Joint]) -> str:
    """What is said of an arm that ends in a ball on a hand which slides in a strut (MacPherson)."""
    if loop.dimensions != len(AXES) or [j.kind for j in onward] != ["spherical"]:
        return ""
    hands = [body for body in onward[0].between if loop.hand in loop.bodies[body]]
    for slide in (j for body in hands for j in loop.of(body) if j.kind == "prismatic"):
        strut = slide.other(hands[0])
        balls = [j for j in loop.of(strut) if GROUND in j.between and j.kind in BALLS]
        if balls and not slide.driven:
            return (
                f".  {hands[0]} slides on {strut}, which {balls[0].name} holds on the ground, as "
                f"in a MacPherson suspension.  This is supported if {balls[0].name} is spherical "
                f"and {strut} has no other joint, and if one rod with a ball at each end leads "
                f"from {hands[0]} to the ground, or to a driven body there"
            )
    return ""


def six_lengths(loop: Loop, rods: Sequence[str]) -> str:
    """What is said of a hand on rods and driven legs that are six together."""
    driven = [j.name for j in loop.joints.values() if j.driven]
    if loop.dimensions != len(AXES) or len(rods) + len(driven) != len(AXES) * PAIR:
        return ""
    legs = f"the leg{'s' * (len(driven) > 1)} of {listed(driven)}"
    return (
        f".  {listed([*rods, legs])} give six distances of the hand, as the links of a "
        f"suspension do: an equation of degree 40 in general.  With each rod as a "
        f"leg that stretches it is a platform on six legs, whose ik gives all lengths for a pose "
        f"of the hand"
    )


def hinged_on(loop: Loop, joint: Joint) -> str:
    """What is said of a hand that is hinged to the only driven body, as on an RRSS linkage."""
    body = joint.other(GROUND)
    if loop.dimensions != len(AXES) or sum(j.driven for j in loop.joints.values()) != 1:
        return ""
    hinges = [
        j for j in loop.of(body) if j is not joint and j.kind == "revolute" and j.axis is not None
    ]
    for hinge in hinges:
        if loop.hand in loop.bodies[hinge.other(body)]:
            return (
                f'.  With hand = "{hinge.name}" the loop is derived, if a rod closes it; then '
                f"{loop.hand} follows from {joint.name} and {hinge.name}, as the end of an arm"
            )
    return ""


def on_rocker(loop: Loop, left: Sequence[str]) -> str:
    """What is said of a hand on a body that a passive joint holds on the ground."""
    for joint in (loop.joints[name] for name in left):
        body = joint.other(GROUND)
        if GROUND in joint.between and loop.hand in loop.bodies[body]:
            return (
                f".  {joint.name} holds {body} on the ground.  If a single loop moves it, write "
                f'hand = "{joint.name}"; {loop.hand} follows from this joint'
            )
    return ""


def on_cylinder(loop: Loop, far: Joint, rod: str) -> str:
    """What is said of a leg whose end may slide along the axis about which it turns."""
    block = far.other(rod) if rod in far.between else ""
    onto = [j for j in loop.of(block) if j is not far] if block else []
    if loop.dimensions != len(AXES) or [j.kind for j in onto] != ["prismatic"]:
        return ""
    (slide,) = onto
    if far.axis is None or slide.axis is None or any(far.axis.cross(slide.axis)):
        return ""
    return (
        f".  {far.name} and {slide.name} are a cylindrical joint at the end of {rod}, as in a "
        f"3-PRC mechanism: a leg keeps the hand at a distance from an axis.  This is supported if "
        f"all three legs are of this kind, each with the same axis at both ends of its rod, on a "
        f"driven slider or crank"
    )


__all__ = [
    "arcs",
    "ball_on_driven",
    "ball_on_hand",
    "ball_on_line",
    "beyond",
    "carried",
    "driven_mast",
    "halves_on",
    "hinge_loop",
    "hinged_on",
    "hinges_of_leg",
    "moving_driver",
    "on_cylinder",
    "on_rocker",
    "on_strut",
    "on_turning_body",
    "shafts",
    "six_lengths",
    "sliding_halves",
    "turning_guide",
    "two_motors",
]
