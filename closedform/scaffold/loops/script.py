"""Writes the derivation of a closed loop from the legs that were found in its file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass

import sympy as sp

from closedform.algebra.formulas import number
from closedform.model.names import listed
from closedform.scaffold.inputs.tables import Table, TableError, add_joint
from closedform.scaffold.loops.bennett import bennett
from closedform.scaffold.loops.between_links import between_links
from closedform.scaffold.loops.bodies import AXES, GROUND, Joint, Loop
from closedform.scaffold.loops.guides import GuideLine, guide
from closedform.scaffold.loops.hinges import hinged
from closedform.scaffold.loops.idle import without_idle
from closedform.scaffold.loops.inverted import inverted
from closedform.scaffold.loops.legs import TURNING, UPRIGHT, Legs, LoopLeg
from closedform.scaffold.loops.linkages import LinkageLines, linkage, posed_linkage
from closedform.scaffold.loops.mirrored import mirrored
from closedform.scaffold.loops.on_balls import on_balls
from closedform.scaffold.loops.on_cylinders import on_cylinders
from closedform.scaffold.loops.on_levers import on_levers
from closedform.scaffold.loops.on_line import on_line
from closedform.scaffold.loops.on_lines import on_lines
from closedform.scaffold.loops.on_pins import on_pins
from closedform.scaffold.loops.on_rod import on_rod
from closedform.scaffold.loops.refused import hinge_loop
from closedform.scaffold.loops.rods import read_pairs, read_rods
from closedform.scaffold.loops.screws import with_screws
from closedform.scaffold.loops.sliding import sliding
from closedform.scaffold.loops.slotted import slotted
from closedform.scaffold.loops.spherical import with_arcs
from closedform.scaffold.loops.spindle import NEEDED, spindle
from closedform.scaffold.loops.two_arms import two_arms
from closedform.scaffold.loops.uprights import HINGED, uprights
from closedform.scaffold.source import file_name, fitted, literal, variable, wrapped_literal

UNSAID = "say what it measures"
BY_HAND = (
    "For another mechanism write its equations in Python; velocity_matrices and lemmas such as "
    "three_spheres take them."
)
ON_AXES = (
    "If it is universal joints that keep it from turning, give both of each leg their axis.  With "
    "four legs and vertical axes it turns about z alone."
)
IN_PLANE = (
    ".  A hand that moves in a plane alone is written with two coordinates: all points are as they "
    "are seen across this plane, and a parallelogram that is at right angles to it is a rod"
)
FUNCTIONS = {"Rational", "Abs"}
"""What a leg calls of SymPy that begins with a capital letter."""


KINDS = {
    "parallel": "a hand that does not turn",
    "platform": "a hand that turns",
    "tripod": "a hand that lifts and tilts",
    "on_rod": "a hand on a rod",
    "on_pins": "a hand on three pins",
    "on_levers": "a hand on lines that motors turn",
    "on_balls": "a hand on three balls",
    "on_lines": "a hand on three lines",
    "mirrored": "a mirrored hand",
    "bennett": "a Bennett linkage",
    "coupled": "a single loop",
    "slotted": "a pin on a line",
    "two_arms": "a hand on two arms",
    "linkage": "a linkage of many bars",
    "sliding_linkage": "a linkage with slides",
}
"""What each function derives, in the words of the guide."""
BY_LEG = {
    "Upright": "tripod",
    "Sleeve": "on_pins",
    "ThroughBall": "on_balls",
    "BallOnLine": "on_lines",
}
"""The function of a hand whose first leg says which it is."""


def loop_script(name: str, loop: Loop, origin: str) -> tuple[str, str]:
    """The derivation of a loop, as Python, and the kind of the mechanism in words."""
    loop = inverted(with_arcs(without_idle(on_line(with_screws(loop)))))
    origin, way, table = file_name(origin), _way(loop), Table()
    for joint in (leg.joint for leg in way.legs) if way.legs else loop.joints.values():
        if joint.driven:
            kind = "prismatic" if joint.kind == "prismatic" else "revolute"
            add_joint(table, joint.name, kind, loop.file)
    lines = [*_head(name, loop, way, origin), *_body(table, way)]
    return "\n".join(part for line in lines for part in fitted(line)) + "\n", way.kind


def _way(loop: Loop) -> _Way:
    """What derives the loop, by the first of the kinds that it is of."""
    again = deepcopy(loop)
    try:
        return _first_way(loop)
    except TableError:
        try:
            lines = sliding(deepcopy(again), few=True)
        except TableError:
            lines = None  # what the other kinds say of it is nearer
        lines = lines or posed_linkage(again)
        if lines is None:
            raise
        return _bodies(again, lines)


def _bodies(loop: Loop, lines: LinkageLines) -> _Way:
    """A linkage of bodies."""
    if loop.hand in loop.joints:
        return _Way([], [loop.hand], linkage=lines)
    task = [*AXES[:2], *["yaw"] * lines.posed]
    return _Way([], task, f"at={literal(lines.hand)}", lines)


def _first_way(loop: Loop) -> _Way:
    follower = loop.joints.get(loop.hand)
    if lines := sliding(loop) or linkage(loop):
        return _bodies(loop, lines)
    if arms := two_arms(loop):
        return _Way(arms, [], function="two_arms")
    if follower and not follower.driven:
        return _single(loop, follower)
    read_rods(loop)
    read_pairs(loop)
    found = Legs(loop)
    if carried := on_rod(found):
        found.check_all_used()
        return _Way(carried[0], list(AXES[:2]), carried[1])
    if pinned := on_pins(found) or on_balls(found) or on_lines(found):
        found.check_all_used()
        return _Way(pinned, [])
    if turned := on_levers(found):
        found.check_all_used()
        return _Way(turned, [], function="on_levers")
    if image := mirrored(found):
        found.check_all_used()
        return _Way(image.legs, [], image.pivot, function="mirrored", more=image.mirror)
    points = {j.at for j in loop.joints.values()}.union(*loop.bodies.values())
    if follower:
        raise loop.error(f"the hand is the joint {loop.hand}, which must not be driven")
    if loop.hand not in points:
        raise loop.error(
            f"the hand {loop.hand} is not a point of a body, nor where a joint is, nor a joint"
        )
    return _on_legs(found)


def _single(loop: Loop, follower: Joint) -> _Way:
    """A single loop, whose task is a joint."""
    found = Legs(loop)
    if hinges := bennett(found, follower):
        found.check_all_used()
        return _Way(hinges, [loop.hand], loop.hand, function="bennett")
    read_rods(loop)
    read_pairs(loop)
    if turning := slotted(found, follower):
        found.check_all_used()
        return _Way(turning, [loop.hand])
    screws = f"screws={loop.screws}" if loop.screws else ""
    return _Way(_coupled(found, follower), [loop.hand], screws, function="coupled")


def _on_legs(found: Legs) -> _Way:
    """A hand that legs carry."""
    loop = found.loop
    if extended := between_links(found) or on_cylinders(found):
        found.check_all_used()
        return _Way(extended[0], [], guide=extended[1])
    driven, struts = found.legs(), found.struts()
    passive = None if loop.parallelograms else guide(found)
    found.check_all_used()
    held = bool(passive or struts or loop.parallelograms or loop.dimensions == 2)
    held |= any(leg.on_axis for leg in driven)
    if found.turning and not held and (on_hinges := hinged(found, driven)):
        return _Way(on_hinges[0], [], guide=on_hinges[1])
    _check_ends(found, passive.held if passive else ())
    if found.half_held and not found.turning:
        hinge, other = found.half_held[0]
        mixed = (
            ".  Legs of this kind beside a parallelogram, as of a HALF manipulator, which keep one "
            "axis of the hand, are not supported" * bool(loop.parallelograms)
        )
        raise loop.error(
            f"{hinge.name} and {other.name} are a hinge and a universal joint at the ends of one "
            f"leg; three such legs leave the hand no motion.  If it should not turn, write "
            f'kind = "universal" and the same axis at both ends of each leg{mixed}'
        )
    if passive:
        return _Way(driven, [], guide=passive)
    legs = [*struts, *driven]
    if found.turning and not _keeps(loop):
        return _turning(found, driven, struts)
    kept = bool(found.halves) or not (struts or loop.parallelograms)
    if loop.dimensions == 3 and len(legs) == UPRIGHT and kept:
        return _Way(legs, [], bars=found.bars)
    if found.halves:
        raise loop.error(
            f"{len(driven)} joints are driven, but a hand of two halves needs {UPRIGHT}, two on "
            f"each half"
        )
    if len(legs) != loop.dimensions:
        on_sphere = " beside its strut" if struts else ""
        rods = [f"; the parallelogram {rod} keeps it from turning" for rod in _held(loop)]
        more = (
            ".  One leg more than that is redundant: leave it out.  Its joint follows from the "
            "position of the hand by the same formula as those of the others"
        )
        raise loop.error(
            f"{len(driven)} joints are driven, but a hand that does not turn needs "
            f"{loop.dimensions - len(struts)}{on_sphere}{''.join(rods[:1])}"
            + more * (len(legs) == loop.dimensions + 1)
            + IN_PLANE * (loop.dimensions == 3 and len(legs) == 2)
        )
    if len(found.axes) == len(legs) and not any(any(found.axes[0].cross(e)) for e in found.axes):
        raise loop.error(
            f"the universal joints of all {len(legs)} legs have the same axis, about which the "
            f"hand can always turn.  Give the legs axes in different directions, or add a fourth "
            f"leg: {UPRIGHT} legs with vertical axes carry a hand that turns about z alone"
        )
    return _Way(legs, list(AXES[: loop.dimensions]))


def _turning(found: Legs, driven: Sequence[LoopLeg], struts: Sequence[LoopLeg]) -> _Way:
    """A hand that turns, on legs alone."""
    plain = not struts and not found.loop.parallelograms
    line = spindle(found, driven) if plain else None
    upright = uprights(found) if plain and not line else []
    if not line and not upright:
        _check_turning(found, driven, struts)
    _check_ends(found, fixed=True)
    return _Way(upright or [*struts, *driven], [], guide=line)


def _keeps(loop: Loop) -> bool:
    """Whether parallelograms keep the hand from turning, though other rods do not."""
    if loop.dimensions == 2:
        return bool(_held(loop))
    return bool(loop.apexes) and len(_held(loop)) + len(loop.apexes) == len(AXES)


def _held(loop: Loop) -> list[str]:
    """The rods that are parallelograms; in a plane one of them keeps the hand from turning."""
    return [rod for rod in loop.rods if rod in loop.parallelograms]


def _check_ends(found: Legs, held: Sequence[str] = (), *, fixed: bool = False) -> None:
    """Refuse legs in space that hold a hand that may turn by the axis of a revolute joint.

    Unless it is ``fixed`` that the hand turns, only where the file gives the axis.  The joints in
    ``held`` are not those of legs.
    """
    loop, body = found.loop, found.turning
    if not body or loop.dimensions == 2:
        return
    hinges = [j for j in loop.of(body) if j.kind == "revolute" and j.name not in held]
    if held := [j.name for j in hinges if fixed or j.axis is not None]:
        if _meet(found, hinges):
            raise loop.error(
                f"the axes of the driven joints and of {listed(held)} meet in {loop.hand}, so this "
                f"is a spherical mechanism.  Join {body} to the ground by a spherical joint at "
                f'{loop.hand}, and write kind = "spherical" at both ends of each rod instead of '
                f"an axis; the distance of its ends is its length"
            )
        raise loop.error(
            f"{listed(held)} would hold {body} by an axis; a leg may end on a hand that "
            f'turns in a spherical or a universal joint, as in kind = "spherical".  {BY_HAND}'
        )


def _meet(found: Legs, hinges: Sequence[Joint]) -> bool:
    """Whether the axes on the hand and those of the driven joints meet in the point of the hand."""
    loop = found.loop
    at = loop.bodies[found.turning]
    driven = [j for j in found.driven() if j.kind == "revolute" and j.at == loop.hand]
    return len(driven) == len(found.driven()) and all(
        j.axis is not None
        and j.at in at
        and not any(map(sp.simplify, (at[j.at] - at[loop.hand]).cross(j.axis)))
        for j in hinges
    )


def _check_turning(found: Legs, legs: Sequence[LoopLeg], struts: Sequence[LoopLeg]) -> None:
    """Refuse a hand that may turn with too few driven joints, or too many."""
    loop, body = found.loop, found.turning
    rails = sum(bool(leg.passive) for leg in legs)
    if rails and len(legs) != TURNING[2]:
        raise loop.error(
            f"{body} may turn; a hand on a rail needs {TURNING[2]} driven joints then, and there "
            f"are {len(legs)}"
        )
    if loop.parallelograms:
        these = "one of its rods must be a parallelogram"
        if loop.dimensions > 2:
            these = "all of its rods must be parallelograms"
        raise loop.error(f"{body} may turn; either {these}, or no body")
    if held := [j.name for j in loop.of(body) if j.kind == "universal" and j.axis is not None]:
        raise loop.error(
            f"{body} may turn, although {listed(held)} has an axis; either all of its rods must "
            f"have universal joints with an axis at both ends, or none"
        )
    hinged = f"  {HINGED}" if loop.dimensions == 3 and len(legs) == 3 else ""
    on_axes = f"  {ON_AXES}" if loop.dimensions == 3 else ""
    if loop.dimensions == 3 and len(legs) == TURNING[3] - 1 and not struts:
        raise loop.error(
            f"{body} may turn, and there are {len(legs)} driven joints; they leave it one freedom, "
            f"such as a turn about its tool.  {NEEDED}.  Another hand that turns in space needs "
            f"{TURNING[3]}"
        )
    needed, where = TURNING[loop.dimensions], "a plane" if loop.dimensions == 2 else "space"
    if struts or len(legs) != needed:
        instead = "a strut carries it" if struts else f"there are {len(legs)}"
        raise loop.error(
            f"{body} may turn, so it needs {needed} driven joints in {where}, and {instead}.  "
            f"If the rods are parallelograms, which keep it from turning, give each "
            f"parallelogram = [...], a vector along its short sides.{on_axes}{hinged}"
        )


def _coupled(found: Legs, follower: Joint) -> list[LoopLeg]:
    """The driver and the follower of a single loop."""
    loop, hand = found.loop, found.loop.hand
    drivers = found.driven()
    if len(drivers) != 1 or GROUND not in follower.between:
        instead = (
            f".  Of this loop {listed(on_ground)} may be the hand"
            if len(drivers) == 1 and (on_ground := _passive_on_ground(loop))
            else ""
        )
        raise loop.error(
            f"a loop with one driven joint needs a follower that is on the ground{instead}"
        )
    if refused := hinge_loop(loop):
        raise loop.error(refused)
    (driver,), found.end = drivers, "the other leg"
    found.check_place(driver)
    far = _beyond(loop, follower)
    loop.hand = far.at
    first = found.leg(driver)
    if GROUND in driver.between:
        loop.hand = _beyond(loop, driver).at
    else:  # the leg that stretches is the rod
        half = far.other(follower.other(GROUND))
        if half not in driver.between:
            raise loop.error(f"{half} must be a rod, or half of the leg that {driver.name} moves")
        loop.rods[half], loop.hand = sp.Symbol(driver.name, real=True), driver.at
    legs = [first, found.leg(follower)]
    loop.hand = hand
    found.check_all_used()
    _check_axes(loop, driver, follower)
    if any(leg.passive for leg in legs):
        raise loop.error("a single loop with a rail is not supported; a rod has to close it")
    return legs


def _passive_on_ground(loop: Loop) -> list[str]:
    return [j.name for j in loop.of(GROUND) if not j.driven]


def _check_axes(loop: Loop, driver: Joint, follower: Joint) -> None:
    """Refuse a rod in space that revolute joints hold, unless all axes are parallel."""
    ends = [j for rod in loop.rods for j in loop.of(rod) if j.kind == "revolute"]
    own = [j.axis for j in (driver, follower) if j.kind == "revolute" and j.axis is not None]
    held = [
        j.name
        for j in ends
        if j.axis is not None and any(j.axis.cross(axis) != sp.zeros(3, 1) for axis in own)
    ]
    if loop.dimensions == len(AXES) and held:
        raise loop.error(
            f"{listed(held)} would hold the rod by an axis.  In space four axes leave a loop a "
            f"motion only if they are parallel, meet in one point, or as in a Bennett linkage, "
            f"which is four revolute joints that all have an axis.  If they meet in one point, "
            f"leave the axis of {listed(held)} out; if the rod has ball joints, write "
            f'kind = "spherical"'
        )


def _beyond(loop: Loop, joint: Joint) -> Joint:
    """The joint at the other end of a body on the ground."""
    body = joint.other(GROUND)
    near = next((j for j in loop.of(body) if j is not joint), None)
    if near is None:
        raise loop.error(f"{body} is joined to the ground alone")
    return near


@dataclass(frozen=True)
class _Way:
    """What derives the loop: its legs, its task, and where the second rod ends on the first.

    A linkage has bodies instead of legs.  A passive leg may rule the motion of the hand, and bars
    may join its halves.
    """

    legs: Sequence[LoopLeg]
    task: Sequence[str]
    at: str = ""
    linkage: LinkageLines | None = None
    guide: GuideLine | None = None
    bars: int = 0
    function: str = ""
    """The function that is called, if the rest does not say it."""
    more: str = ""
    """Its last argument, if it has one more."""

    @property
    def name(self) -> str:
        """The function that is called; a hand that turns sets its task itself."""
        if self.function:
            return self.function
        if self.linkage:
            grouped = self.linkage.slides or self.linkage.grouped
            return "sliding_linkage" if grouped else "linkage"
        if self.guide:
            return "guided"
        if named := BY_LEG.get(self.legs[0].call.partition("(")[0]):
            return named
        if len(self.task) == 1 and any(leg.passive for leg in self.legs):
            return "slotted"
        if self.at:
            return "on_rod"
        return {0: "platform", 1: "coupled"}.get(len(self.task), "parallel")

    @property
    def kind(self) -> str:
        """The same in words."""
        if self.guide:
            return self.guide.kind
        if any(leg.call.startswith("SlidingStrut(") for leg in self.legs):
            return "a hand on an arm and a strut"
        if self.linkage and not self.linkage.slides:
            return KINDS["linkage"]
        upright = self.name == "platform" and len(self.legs) == UPRIGHT
        return "a hand that stays upright" if upright else KINDS[self.name]

    @property
    def arguments(self) -> list[str]:
        """Those after the derivation and the task."""
        if self.linkage:
            bodies = [f"        {body}," for body in self.linkage.bodies]
            lines = [f"        {slide}," for slide in self.linkage.slides]
            slides = ["    [", *lines, "    ],"] if lines else ["    [],"] * self.linkage.grouped
            return ["    {", *bodies, "    },", *slides, *[f"    {self.at},"] * bool(self.at)]
        legs = [leg.call for leg in self.legs]
        if self.name in ("coupled", "slotted", "on_rod", "two_arms"):
            return [f"    {argument}," for argument in [*legs, *[self.at] * bool(self.at)]]
        first = [f"    {self.guide.call},"] if self.guide else []
        first += [f"    {self.at},"] * bool(self.at)
        one = [f"    {self.more},"] * bool(self.more) or ["    bars=1,"] * (self.bars == 1)
        return [*first, "    [", *(f"        {leg}," for leg in legs), "    ],", *one]

    @property
    def parts(self) -> Sequence[str]:
        """The legs or the bodies, as they are written."""
        if self.linkage:
            return [*self.linkage.bodies, *self.linkage.slides]
        return [*([self.guide.call] if self.guide else []), *(leg.call for leg in self.legs)]

    @property
    def words(self) -> str:
        """What the mechanism consists of."""
        if self.linkage:
            return self.linkage.words
        passive = [self.guide.words] if self.guide else []
        if self.bars:
            bars = {
                1: "One bar with vertical pins joins",
                2: "Two parallel bars with vertical pins join",
            }
            passive.append(f"{bars[self.bars]} the halves of the hand.")
        alike: dict[str, list[LoopLeg]] = {}
        for leg in self.legs:
            alike.setdefault(leg.words.removeprefix(f"{leg.joint.name} "), []).append(leg)
        return "  ".join([*passive, *(_sentences(legs) for legs in alike.values())])


def _sentences(legs: Sequence[LoopLeg]) -> str:
    """What legs are of which the same can be said."""
    first, *others = legs
    joints = listed([leg.joint.name for leg in others])
    return f"{_sentence(first)}." + f"  The same holds for {joints}." * bool(others)


def _sentence(leg: LoopLeg) -> str:
    """What a leg is; the name of a joint keeps its letters."""
    if leg.words.startswith(f"{leg.joint.name} "):
        return f"Joint {leg.words}"
    return f"{leg.words[0].upper()}{leg.words[1:]}"


def _head(name: str, loop: Loop, way: _Way, origin: str) -> list[str]:
    task = way.task
    title = name.replace("_", " ").capitalize()
    calls = sorted(
        {c for e in (*way.parts, way.at) for c in re.findall(r"\b([A-Z]\w+)\(", e)} - FUNCTIONS
    )
    names = sorted([*calls, "Derivation", "Paper", way.name, *["real"] * bool(task)])
    fractions = [number(given.get("value") or "1") for given in loop.parameters.values()]
    used = " ".join([*way.parts, way.at]) + "Rational(" * any(f.denominator != 1 for f in fractions)
    functions = [f for f in ("Abs", "Rational", "cos", "sin", "sqrt") if f"{f}(" in used]
    functions += ["pi"] * bool(re.search(r"\bpi\b", used))
    lines = [
        f'"""{title}: a derivation from {origin}."""',
        "",
        *([f"from sympy import {', '.join(sorted(functions))}", ""] if functions else []),
        f"from closedform import {', '.join(names)}",
        "",
        "d = Derivation(",
        f'    "{name}",',
        f'    "{title}",',
        f'    Paper("{name}", "{title}", ("the file {origin}",)),',
        *wrapped_literal("  ".join([*loop.seen, way.words, *loop.said])),
        *([f"    task=[{', '.join(literal(x) for x in task)}],"] if task else []),
        ")",
    ]
    for symbol, given in loop.parameters.items():
        value = number(given.get("value") or "1")
        exact = f"{value.numerator}" if value.denominator == 1 else f'Rational("{value}")'
        angle = given.get("unit") == "rad" or (given.get("value") or "1").startswith("-")
        sign = ", nonnegative=False" if angle else ""
        lines.append(
            f'{variable(symbol)} = d.parameter("{symbol}", value={exact}, '
            f"unit={literal(given.get('unit') or 'm')}, "
            f'meaning={literal(given.get("meaning") or UNSAID)}, source="{origin}"{sign})'
        )
    return lines


def _body(table: Table, way: _Way) -> list[str]:
    lines = []
    for joint, kind in table.joints.items():
        argument = ', "prismatic"' if kind == "prismatic" else ""
        lines.append(f'{joint} = d.joint("{joint}"{argument})')
    passive = [leg.passive for leg in way.legs if leg.passive]
    passive += way.linkage.passive if way.linkage else ()
    passive += [way.guide.slide] if way.guide and way.guide.slide else []
    lines += [f'{slide} = d.joint("{slide}", "prismatic", passive=True)' for slide in passive]
    if way.name == "two_arms":
        for arm in (leg.joint for leg in way.legs[:2] if not leg.joint.driven):
            slides = '"prismatic", ' * (arm.kind == "prismatic")
            lines.append(f'{arm.name} = d.joint("{arm.name}", {slides}passive=True)')
    if way.name in ("coupled", "slotted", "bennett") or (way.linkage and len(way.task) == 1):
        (x,) = way.task
        hand = [f"    ({x},),"] * bool(way.linkage)
        lines += [f'{x} = real("{x}")', f"{way.name}(", "    d,", *hand]
    else:
        coordinates = ", ".join(f"real({literal(x)})" for x in way.task)
        lines += [f"{way.name}(", "    d,", *[f"    ({coordinates}),"] * bool(way.task)]
    return [*lines, *way.arguments, ")"]


__all__ = ["loop_script"]
