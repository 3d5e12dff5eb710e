"""Finds the legs of a closed loop: what each of them is, from the ground to the hand.

The loops are cut at the rods: each keeps the distance of its ends.  A rod between the ground and
the hand is a strut, which has no driven joint.  A hand that may turn, because its rods end in
several points and are not parallelograms, needs three driven joints in a plane and six in space.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from closedform.model.names import listed
from closedform.scaffold.loops.axial import TwoMotors, call_of, in_pairs, leg_on_axis, told
from closedform.scaffold.loops.bodies import (
    AXES,
    GROUND,
    Joint,
    Loop,
    across_axis,
    check_pivot,
    points_of,
)
from closedform.scaffold.loops.halves import halves
from closedform.scaffold.loops.refused import (
    arcs,
    ball_on_driven,
    ball_on_hand,
    ball_on_line,
    beyond,
    carried,
    driven_mast,
    halves_on,
    hinged_on,
    hinges_of_leg,
    moving_driver,
    on_cylinder,
    on_rocker,
    on_strut,
    on_turning_body,
    shafts,
    six_lengths,
    sliding_halves,
    turning_guide,
    two_motors,
)
from closedform.scaffold.loops.rods import check_short_side, several_told
from closedform.scaffold.source import source

UPRIGHT = 4
"""The number of driven joints of a hand in space that turns about the z axis alone."""
TURNING = {2: 3, 3: 6}
"""The number of driven joints of a hand that turns, in a plane and in space."""

ON_ARM = (
    ".  An arm whose bodies parallelograms keep from turning, as a desk lamp, is a table of joints "
    "with motors, such as m2 - m1, in a column of that name.  Of another arm each loop is a file "
    "of its own"
)
"""What may be meant if a joint between two moving bodies in a plane is driven."""


@dataclass(frozen=True)
class LoopLeg:
    """A leg as lines of the script: what makes it, and what it is in words."""

    joint: Joint
    call: str
    words: str
    place: sp.Matrix
    """Where it ends, as seen from the point that is the hand."""
    passive: str = ""
    """The passive slide of a rail."""
    on_axis: bool = False
    """Whether it is one of both motors of a leg that turns about the axis of its slider."""


class Legs:
    """Finds the legs of a loop, from the ground to the hand."""

    def __init__(self, loop: Loop):
        self.loop = loop
        self.turning = ""
        """The body that is the hand, if it may turn."""
        self.used: set[str] = set()
        """The joints that legs consist of."""
        self.arm = ""
        """The rod that has the point of the hand, if the hand is not where rods end."""
        self.end = "the hand"
        """What a rod joins a leg to."""
        self.halves, self.bars = halves(loop)
        """The halves of the hand, if it has two, and the number of bars that join them."""
        self.axes: list[sp.Matrix] = []
        """The axes of legs with universal joints that keep the hand from turning."""
        self.half_held: list[tuple[Joint, Joint]] = []
        """The hinge and the universal joint at the ends of a leg, which may turn the hand."""
        self.offset: sp.Matrix | None = None
        """From the pin of a half to the end of a leg, while the leg is written."""
        self.upright: Callable[[sp.Matrix], sp.Matrix] | None = None
        """Coordinates in the plane of a leg, while the leg of a tripod is written."""

    def at(self, v: sp.Matrix) -> str:
        """A point or a direction as it is written."""
        return _tuple(self.upright(v) if self.upright else v)

    def tail(self, place: sp.Matrix) -> str:
        """The last argument of a leg, left out if its rod ends in the point of the hand."""
        plain = self.upright or self.arm or not any(place)
        return "" if plain else f", on_hand={_tuple(place)}"

    def bar(self, body: str, length: sp.Expr) -> str:
        """The length of a rod or a crank, or the parallelogram that it is."""
        side = self.loop.parallelograms.get(body)
        if side is None:
            return source(length)
        width = self.loop.length(side)
        if width == 0:
            raise self.loop.error(f"{body}: the short sides of a parallelogram need a length")
        way = _tuple(self.direction(side, width))
        if body in self.loop.apexes:
            apex = _tuple(self.loop.apexes[body])
            return f"Prism({source(length)}, {way}, {source(width)}, {apex})"
        return f"Parallelogram({source(length)}, {way}, {source(width)})"

    def rod(self, rod: str, near: Joint) -> str:
        """The length of a rod, or what it is if it keeps the hand from turning."""
        length = self.loop.rods[rod]
        far = [j for j in self.loop.of(rod) if j is not near]
        axis = self.axis_of(near, far[0]) if far else None
        if axis is None:
            return self.bar(rod, length)
        if rod in self.loop.parallelograms:
            raise self.loop.error(
                f"{rod} is a parallelogram, so {near.name} and {far[0].name} need no axis"
            )
        return f"Universal({source(length)}, {self.at(axis)})"

    def axis_of(self, near: Joint, far: Joint) -> sp.Matrix | None:
        """The direction of the outer axes of the universal joints at the ends of a leg."""
        ends = [(j, j.axis) for j in (near, far) if j.kind == "universal" and j.axis is not None]
        if not ends:
            return None
        hinge = next((j for j in (near, far) if j.kind == "revolute" and j.axis is not None), None)
        if len(ends) == 1 and hinge:
            self.half_held.append((hinge, ends[0][0]))
            return None
        if len(ends) == 1 or self.loop.dimensions == 2:
            raise self.loop.error(
                f"{ends[0][0].name} has an axis; universal joints keep {self.end} from turning if "
                f"a leg in space has them at both ends, each with the axis that is not fixed to "
                f"the leg"
            )
        (_, first), (_, second) = ends
        if any(sp.simplify(e) for e in first.cross(second)):
            raise self.loop.error(
                f"the axes of {near.name} and {far.name} have to be parallel, or the leg turns "
                f"{self.end}; for a hand that turns leave both out"
            )
        self.axes.append(first)
        return first

    def direction(self, v: sp.Matrix, length: sp.Expr) -> sp.Matrix:
        return (v / length).applyfunc(sp.simplify)

    def driven(self) -> list[Joint]:
        return [j for j in self.loop.joints.values() if j.driven]

    def legs(self) -> list[LoopLeg]:
        loop = self.loop
        driven = self.driven()
        if not driven:
            raise loop.error("no joint is driven; set driven = true")
        for joint in driven:
            self.check_place(joint)
        if self.halves:
            bars = {joint.name for half in self.halves for joint in loop.of(half)}
            self.used |= {name for name in bars if loop.joints[name].kind == "revolute"}
            return [self.on_half(j) for j in driven]
        return [self.leg(j) for j in in_pairs(loop, driven)]

    def check_place(self, joint: Joint) -> None:
        """Refuse a drive between two bodies that both move, unless it slides them."""
        in_plane = self.loop.dimensions == 2
        moved = GROUND not in joint.between and joint.kind != "prismatic"
        if moved and not leg_on_axis(self.loop, joint):
            raise self.loop.error(
                f"{joint.name} is driven, so it must be between the ground and a body, or slide "
                f"the two halves of a leg; it is between {listed(joint.between)}"
                + (
                    carried(self.loop, joint)
                    or two_motors(self.loop, joint)
                    or on_turning_body(self.loop, joint)
                    or moving_driver(self.loop, joint)
                    or ON_ARM * in_plane
                )
            )

    def on_half(self, joint: Joint) -> LoopLeg:
        """A leg that ends on one of the halves of the hand."""
        leg = self.leg(joint)
        assert self.offset is not None
        return replace(leg, call=f"Half({leg.call}, {self.at(self.offset)})")

    def check_all_used(self) -> None:
        """Refuse joints that are part of no leg, and bodies without a joint."""
        for name, joint in self.loop.joints.items():
            if (
                name not in self.used
                and self.turning
                and {*joint.between} == {GROUND, self.turning}
            ):
                raise self.loop.error(
                    f"{name} joins {self.turning} to the ground itself; of the joints that hold a "
                    f"hand on the ground, a universal and a spherical one in space are supported"
                )
        if left := [name for name in self.loop.joints if name not in self.used]:
            slides = [self.loop.joints[name] for name in left]
            halves = (
                halves_on(self.loop, j, j.between[1]) for j in slides if GROUND not in j.between
            )
            raise self.loop.error(
                f"no leg contains {listed(left)}; a leg leads from the ground to {self.end} and "
                f"has a driven joint, and only a rod may lead there without one"
                + (on_rocker(self.loop, left) or next(filter(None, halves), ""))
            )
        held = {body for joint in self.loop.joints.values() for body in joint.between}
        if loose := [name for name in self.loop.bodies if name not in {*held, GROUND}]:
            raise self.loop.error(f"no joint holds {listed(loose)}")

    def struts(self) -> list[LoopLeg]:
        """The rods from the ground to the hand, which no joint drives."""
        loop = self.loop
        found: list[LoopLeg] = []
        for joint in loop.of(GROUND):
            rod = joint.other(GROUND)
            if joint.driven or rod not in loop.rods:
                continue
            if loop.dimensions == 2 or found:
                raise loop.error(
                    f"the rod {rod} leads from the ground to the hand; only one may, and only in "
                    "space, with two driven joints" + six_lengths(loop, self.passive_rods())
                )
            self.used.add(joint.name)
            length, place = self.bar(rod, loop.rods[rod]), self.place_on_hand(rod, joint)
            base = self.point(GROUND, joint)
            found.append(
                LoopLeg(
                    joint,
                    f"Strut({length}, {self.at(base)}{self.tail(place)})",
                    f"a strut of length {loop.rods[rod]} leads from the ground to the hand",
                    place,
                )
            )
        return found

    def passive_rods(self) -> list[str]:
        """The rods from the ground, which no joint drives."""
        ways = [(j, j.other(GROUND)) for j in self.loop.of(GROUND)]
        return [body for j, body in ways if body in self.loop.rods and not j.driven]

    def leg(self, joint: Joint) -> LoopLeg:
        loop = self.loop
        if on_axis := leg_on_axis(loop, joint):
            return self.on_axis(on_axis, joint)
        if GROUND not in joint.between:
            return self.stretch(joint)
        body = joint.other(GROUND)
        self.used.add(joint.name)
        onward = [j for j in loop.of(body) if j is not joint]
        rods = [(j, j.other(body)) for j in onward if j.other(body) in loop.rods]
        slides = [j for j in onward if j.kind == "prismatic"]
        if joint.kind == "prismatic" and len(slides) == 1 and not rods:
            return self.rail(joint, body, slides[0])
        if second := next((j for j in onward if j.driven), None):
            raise loop.error(
                f"{second.name} is driven, on {body}, which {joint.name} moves; a leg has one "
                f"driven joint, and the others are passive"
                + (two_motors(loop, joint) or ON_ARM * (loop.dimensions == 2))
            )
        if joint.kind == "revolute" and slides and not rods:
            raise loop.error(
                f"{joint.name} turns {body}, on which {slides[0].name} slides; a passive slide is "
                f"supported on a driven slider, not on a driven crank"
                + (ball_on_line(loop, slides[0]) or turning_guide(loop, joint, slides[0]))
            )
        if len(rods) != 1 or len(onward) != 1:
            carried = listed([j.other(body) for j in onward]) or "nothing else"
            raise loop.error(
                f"{joint.name} moves {body}, which must be joined to one rod, a body with a "
                f"length or two points, or to one body by a passive slide; it is joined to "
                f"{carried}"
                + ball_on_hand(loop, onward)
                + "".join(ball_on_line(loop, j) for j in beyond(loop, onward))
                + two_motors(loop, joint)
                + ("" if arcs(loop) else hinged_on(loop, joint))
                + driven_mast(loop, joint)
                + (ball_on_driven(loop, onward) or on_strut(loop, onward))
                + (arcs(loop) or hinges_of_leg(loop, joint) or shafts(loop, joint))
                + several_told(loop, body)
            )
        if joint.kind == "prismatic":
            return self.slider(joint, *rods[0])
        if joint.kind == "revolute":
            return self.crank(joint, *rods[0])
        raise loop.error(f"{joint.name} is driven, so it must be revolute or prismatic")

    def on_axis(self, leg: TwoMotors, joint: Joint) -> LoopLeg:
        """One of both motors of a leg of which one moves its end along an axis."""
        self.used |= {j.name for j in leg.joints}
        place = self.place_of(leg.ball)
        call = f"{call_of(self, leg, joint)}{self.tail(place)})"
        return LoopLeg(joint, call, told(leg, joint), place, on_axis=True)

    def slider(self, joint: Joint, near: Joint, rod: str) -> LoopLeg:
        """A driven slider with a rod, which is ``near`` where the slider carries it."""
        if joint.axis is None:
            raise self.loop.error(f"{joint.name} slides; say in which direction with axis")
        beyond = [j for j in self.loop.of(rod) if j is not near and j.at != self.loop.hand]
        if len(beyond) == 1 and beyond[0].other(rod) in self.loop.rods:
            return self.plane(joint, near, beyond[0])
        place, length = self.place_on_hand(rod, near), self.loop.rods[rod]
        end = self.point(joint.other(GROUND), near)
        return LoopLeg(
            joint,
            f"Slide({joint.name}, {self.rod(rod, near)}, {self.at(end)}, "
            f"{self.at(joint.axis)}{self.tail(place)})",
            f"{joint.name} moves a slider, which a rod of length {length} joins to {self.end}",
            place,
        )

    def plane(self, joint: Joint, near: Joint, elbow: Joint) -> LoopLeg:
        """A slider with two rods; ``near`` is on the slider, and ``elbow`` between the rods."""
        loop = self.loop
        first = near.other(joint.other(GROUND))
        second = elbow.other(first)
        far = [j for j in loop.of(second) if j is not elbow]
        turning = [near, elbow, *far]
        kinds = {"revolute", "universal"} if self.upright_by_planes(far) else {"revolute"}
        axes = [j.axis for j in turning if j.axis is not None and j.kind in kinds]
        if (
            len(turning) != 3
            or len(axes) != 3
            or any(axes[0].cross(axis) != sp.zeros(3, 1) for axis in axes)
        ):
            raise loop.error(
                f"{joint.name} moves two rods one after the other; this is supported if three "
                f"revolute joints with parallel axes join the slider, the rods {first} and "
                f"{second} and the hand: give each its axis.  Of four legs whose hand turns about "
                f"z, the last joint is universal, unless the axes are vertical"
            )
        assert joint.axis is not None
        advance = sp.simplify(axes[0].dot(joint.axis))
        if not advance.is_number or advance == 0:
            raise loop.error(
                f"the axis of {joint.name} must not be at right angles to that of {near.name}, and "
                f"both are given in numbers"
            )
        place = self.place_of(far[0], second, held=True)
        self.used |= {j.name for j in turning}
        bars = f"({source(loop.rods[first])}, {source(loop.rods[second])})"
        return LoopLeg(
            joint,
            f"Plane({joint.name}, {bars}, {self.at(self.point(joint.other(GROUND), near))}, "
            f"{self.at(joint.axis)}, {self.at(axes[0])}{self.tail(place)})",
            f"{joint.name} moves a slider, which two rods of length {loop.rods[first]} and "
            f"{loop.rods[second]} with parallel axes join to {self.end}",
            place,
        )

    def upright_by_planes(self, far: Sequence[Joint]) -> bool:
        """Whether a leg of two bars may end in a universal joint: its hand turns about z."""
        return len(self.driven()) == UPRIGHT and all(j.kind == "universal" for j in far)

    def crank(self, joint: Joint, near: Joint, rod: str) -> LoopLeg:
        """A driven crank with a rod, which is ``near`` where the crank carries it."""
        check_short_side(self.loop, joint, rod, self.end)
        place = self.place_on_hand(rod, near)
        arm, _ = self.arm_of(joint, near)
        return LoopLeg(
            joint,
            self.cranked(joint, near, self.rod(rod, near), place),
            f"{joint.name} turns a crank of length {self.loop.length(arm)}, which a rod of length "
            f"{self.loop.rods[rod]} joins to {self.end}",
            place,
        )

    def arm_of(self, joint: Joint, near: Joint) -> tuple[sp.Matrix, sp.Matrix]:
        """A crank at the angle 0 as a vector at right angles to its axis, and where it starts."""
        body, start = joint.other(GROUND), self.pivot(joint)
        arm = self.point(body, near) - start
        if self.loop.dimensions == 3:
            if joint.axis is None:
                raise self.loop.error(f"{joint.name} turns in space; say about which axis")
            arm, start = across_axis(joint.axis, arm, start)
        return arm, start

    def directions(self, joint: Joint, arm: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
        """Where a crank points at the angle 0, and the direction in which it turns there."""
        length = self.loop.length(arm)
        if length == 0:
            raise self.loop.error(
                f"the end of {joint.other(GROUND)} is on the axis of {joint.name}, so it does not "
                f"move{shafts(self.loop, joint)}"
            )
        along = self.direction(arm, length)
        if joint.axis is None or self.loop.dimensions == 2:
            return along, sp.Matrix([-along[1], along[0]])
        return along, joint.axis.cross(along).applyfunc(sp.simplify)

    def cranked(self, joint: Joint, near: Joint, rod: str, place: sp.Matrix) -> str:
        """A driven crank as it is written, with the rod that it carries at ``near``."""
        arm, start = self.arm_of(joint, near)
        along, across = self.directions(joint, arm)
        return (
            f"Crank({joint.name}, {self.bar(joint.other(GROUND), self.loop.length(arm))}, {rod}, "
            f"{self.at(start)}, {self.at(along)}, {self.at(across)}{self.tail(place)})"
        )

    def rail(self, joint: Joint, body: str, slide: Joint) -> LoopLeg:
        """A slider with a rail, along which a body slides that has the point of the hand."""
        loop, far = self.loop, slide.other(body)
        if loop.dimensions == 3 or slide.driven:
            raise loop.error(
                f"{slide.name} slides on {body}; this is supported for a passive slide in a plane "
                f"only" + (two_motors(loop, joint) if slide.driven else ball_on_line(loop, slide))
            )
        for j in (joint, slide):
            if j.axis is None:
                raise loop.error(f"{j.name} slides; say in which direction with axis")
            if not all(e.is_number for e in j.axis):
                raise loop.error(f"{j.name} has a direction with parameters; use numbers")
        assert joint.axis is not None
        assert slide.axis is not None
        if joint.axis[0] * slide.axis[1] == joint.axis[1] * slide.axis[0]:
            raise loop.error(f"{joint.name} and {slide.name} slide in the same direction")
        self.used.add(slide.name)
        points, place = loop.bodies[far], sp.zeros(2, 1)
        if loop.hand in points:
            place = points.get(slide.at, points[loop.hand]) - points[loop.hand]
        else:
            pins = [
                j
                for j in loop.of(far)
                if j is not slide
                and (j.at == loop.hand or any(loop.hand in loop.bodies[b] for b in j.between))
            ]
            if not pins:
                raise loop.error(f"{slide.name} does not lead to the hand {loop.hand}")
            self.used |= {pin.name for pin in pins}
            place = self.place_of(pins[0], far)
        return LoopLeg(
            joint,
            f"Rail({joint.name}, {slide.name}, {self.at(self.point(body, slide))}, "
            f"{self.at(joint.axis)}, {self.at(slide.axis)}{self.tail(place)})",
            f"{joint.name} moves a slider with a rail, along which the hand slides",
            place,
            slide.name,
        )

    def point(self, body: str, joint: Joint) -> sp.Matrix:
        """Where a joint is on a body."""
        points = self.loop.bodies[body]
        if joint.at in points:
            return points[joint.at]
        instead = f"; {points_of(body)}" if body in self.loop.rods else ""
        raise self.loop.error(f"{body} has no point {joint.at}, where {joint.name} is{instead}")

    def pivot(self, joint: Joint) -> sp.Matrix:
        """Where a body turns about the ground, which is the same point of both at the angle 0."""
        at = self.point(GROUND, joint)
        check_pivot(self.loop, joint)
        return at

    def stretch(self, joint: Joint) -> LoopLeg:
        """A leg of two bodies that slide along each other."""
        self.check_place(joint)
        loop = self.loop
        if on_ground := middle_leg(loop, joint):
            self.used |= {joint.name, on_ground.name}
            return LoopLeg(
                joint,
                f"Stretch({joint.name}, {self.at(self.point(GROUND, on_ground))})",
                f"{joint.name} is the length of the leg that carries the hand",
                sp.zeros(loop.dimensions, 1),
            )
        ends: dict[bool, Joint] = {}
        for half in joint.between:
            others = [j for j in loop.of(half) if j is not joint]
            if len(others) != 1:
                raise loop.error(f"{half} is half of a leg, so it needs one more joint")
            ends[GROUND in others[0].between] = others[0]
        if len(ends) != 2:
            apart = (
                "; if another body holds it, as on an arm, write each loop as a file of its own, "
                "seen from that body" * (loop.dimensions == 2)
            )
            raise loop.error(
                f"one half of the leg of {joint.name} must be joined to the ground{apart}"
            )
        self.used |= {joint.name, *(end.name for end in ends.values())}
        base = self.point(GROUND, ends[True])
        place = self.place_of(ends[False])
        axis = self.axis_of(ends[True], ends[False])
        held = "" if axis is None else f", axis={self.at(axis)}"
        return LoopLeg(
            joint,
            f"Stretch({joint.name}, {self.at(base)}{self.tail(place)}{held})",
            f"{joint.name} is the length of a leg from the ground to {self.end}",
            place,
        )

    def place_on_hand(self, rod: str, near: Joint) -> sp.Matrix:
        """Where a rod ends, seen from the point that is the hand."""
        far = [j for j in self.loop.of(rod) if j is not near]
        if rod == self.arm:
            self.used.add(near.name)
            return sp.zeros(2, 1)
        if not far or (len(far) > 1 and any(j.at != self.loop.hand for j in far)):
            raise self.loop.error(
                f"the rod {rod} must have two ends, one of them on {self.end}; it is joined to "
                f"{listed([near.other(rod), *(j.other(rod) for j in far)])}"
            )
        self.used |= {near.name, *(j.name for j in far)}
        return self.place_of(far[0], rod)

    def place_of(self, far: Joint, rod: str = "", *, held: bool = False) -> sp.Matrix:
        """Where a leg ends on the hand, which may turn unless the leg keeps it from turning."""
        loop = self.loop
        held |= rod in loop.parallelograms or (far.kind == "universal" and far.axis is not None)
        if far.at == loop.hand:
            return sp.zeros(loop.dimensions, 1)
        if half := next((b for b in far.between if b != rod and b in self.halves), ""):
            return self.place_on_half(far, half)
        body = next((b for b in far.between if b != rod and loop.hand in loop.bodies[b]), "")
        if not body:
            other = far.other(rod) if rod in far.between else " and ".join(far.between)
            raise loop.error(
                f"{far.name} leads to {other}, not to a body with the point {loop.hand}, which is "
                f"{self.end}; a leg has one rod, and the hand is one body"
                f"{self.lever(far)}{on_cylinder(loop, far, rod)}{sliding_halves(loop, far)}"
            )
        if far.at not in loop.bodies[body]:
            raise loop.error(f"{body} has no point {far.at}, where {far.name} is")
        if not held:
            self.turning = body
        return loop.bodies[body][far.at] - loop.bodies[body][loop.hand]

    def lever(self, far: Joint) -> str:
        """What to do if a leg ends on a body that turns about the ground, as on an excavator."""
        loop = self.loop
        held = [
            (j.name, body)
            for body in far.between
            for j in loop.of(body)
            if GROUND in j.between and j.kind == "revolute" and not j.driven and body != GROUND
        ]
        if not held:
            return ""
        (joint, body), *_ = held
        if loop.dimensions == len(AXES):
            return (
                f".  {joint} holds {body} on the ground.  Drive {joint} here, and write the loop "
                f'that moves {body} as a file of its own, with hand = "{joint}"; if it is in a '
                f"plane, with two coordinates"
            )
        return (
            f".  {joint} holds {body} on the ground.  Of an arm whose joints are driven through "
            f'loops, write each loop as a file of its own, this one with hand = "{joint}", and the '
            f"arm as a table of joints"
        )

    def place_on_half(self, far: Joint, half: str) -> sp.Matrix:
        """The pin of the half that a leg holds, seen from the point of the hand."""
        loop, pin = self.loop, self.halves[half]
        self.offset = self.point(half, far) - pin.on_half
        (hand,) = (points[loop.hand] for points in loop.bodies.values() if loop.hand in points)
        return pin.on_bar - hand


def middle_leg(loop: Loop, slide: Joint) -> Joint | None:
    """The universal joint on the ground of a leg whose end is the hand, if a slide is its other.

    So the slide carries the hand, as that of a Tricept; it may be driven.
    """
    for half in slide.between:
        post = slide.other(half)
        if loop.hand in loop.bodies[half] and half != GROUND and slide.kind == "prismatic":
            others = [j for j in loop.of(post) if j is not slide]
            if [j.kind for j in others] == ["universal"] and GROUND in others[0].between:
                return others[0] if loop.dimensions == len(AXES) else None
    return None


def _tuple(v: sp.Matrix) -> str:
    return f"({', '.join(map(source, v))})"


__all__ = ["TURNING", "UPRIGHT", "Legs", "LoopLeg", "across_axis", "middle_leg"]
