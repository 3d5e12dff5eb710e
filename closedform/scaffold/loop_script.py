"""Writes the derivation of a closed loop from the legs that were found in its file."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence

from closedform.algebra.formulas import number
from closedform.scaffold.loops import AXES, GROUND, TURNING, Joint, Legs, Loop, LoopLeg, listed
from closedform.scaffold.source import file_name, literal
from closedform.scaffold.tables import Table, add_joint
from closedform.scaffold.uprights import HINGED, uprights

UNSAID = "say what it measures"
DEGREES = {1: 6, 2: 4}
"""Of the forward problem of a hand that turns in a plane, if some of its three legs are rails."""
FUNCTIONS = {"Rational", "Abs"}
"""What a leg calls of SymPy that begins with a capital letter."""


def loop_script(name: str, loop: Loop, origin: str) -> str:
    """The derivation of a loop, as Python."""
    origin = file_name(origin)
    found = Legs(loop)
    follower = loop.joints.get(loop.hand)
    if follower and not follower.driven:
        legs, task = _coupled(found, follower), [loop.hand]
    else:
        points = {j.at for j in loop.joints.values()}.union(*loop.bodies.values())
        if follower:
            raise loop.error(f"the hand is the joint {loop.hand}, which must not be driven")
        if loop.hand not in points:
            raise loop.error(
                f"the hand {loop.hand} is not a point of a body, nor where a joint is, nor a joint"
            )
        driven, struts = found.legs(), found.struts()
        found.check_all_used()
        legs, task = [*struts, *driven], list(AXES[: loop.dimensions])
        if found.turning and not (loop.dimensions == 2 and _held(loop)):
            upright = [] if struts or loop.parallelograms else uprights(found)
            if not upright:
                _check_turning(found, driven, struts)
            legs, task = upright or legs, []
        elif len(legs) != loop.dimensions:
            on_sphere = " beside its strut" if struts else ""
            held = f"; the parallelogram {_held(loop)[0]} keeps it from turning" * bool(_held(loop))
            raise loop.error(
                f"{len(driven)} joints are driven, but a hand that does not turn needs "
                f"{loop.dimensions - len(struts)}{on_sphere}{held}"
            )
    table = Table()
    for leg in legs:
        if leg.joint.driven:
            kind = "prismatic" if leg.joint.kind == "prismatic" else "revolute"
            add_joint(table, leg.joint.name, kind, loop.file)
    return "\n".join([*_head(name, loop, legs, task, origin), *_body(table, legs, task)]) + "\n"


def _held(loop: Loop) -> list[str]:
    """The rods that are parallelograms; in a plane one of them keeps the hand from turning."""
    return [rod for rod in loop.rods if rod in loop.parallelograms]


def _check_turning(found: Legs, legs: Sequence[LoopLeg], struts: Sequence[LoopLeg]) -> None:
    """Refuse a hand that may turn with too few driven joints, or too many."""
    loop, body = found.loop, found.turning
    rails = sum(bool(leg.passive) for leg in legs)
    if rails and not rails == len(legs) == TURNING[2]:
        degree = DEGREES.get(rails) if len(legs) == TURNING[2] else None
        raise loop.error(
            f"{body} may turn; this is not known for a hand on a rail"
            + f", and leads to an equation of degree {degree}" * (degree is not None)
        )
    if loop.parallelograms:
        these = "one" if loop.dimensions == 2 else "all"
        raise loop.error(
            f"{body} may turn; either {these} of its rods must be parallelograms, or no body"
        )
    fixed = [j.name for j in loop.of(body) if j.kind == "revolute" and j.axis is not None]
    if fixed and loop.dimensions == 3:
        raise loop.error(
            f"{listed(fixed)} would hold {body} by an axis; a leg is known to end on a hand that "
            f"turns in a spherical or a universal joint"
        )
    hinged = f"  {HINGED}" if loop.dimensions == 3 and len(legs) == 3 else ""
    needed, where = TURNING[loop.dimensions], "a plane" if loop.dimensions == 2 else "space"
    if struts or len(legs) != needed:
        instead = "a strut carries it" if struts else f"there are {len(legs)}"
        raise loop.error(
            f"{body} may turn, so it needs {needed} driven joints in {where}, and {instead}.  "
            f"If the rods are parallelograms, which keep it from turning, give each "
            f"parallelogram = [...], a vector along its short sides.{hinged}"
        )


def _coupled(found: Legs, follower: Joint) -> list[LoopLeg]:
    """The driver and the follower of a single loop."""
    loop = found.loop
    drivers = found.driven()
    if len(drivers) != 1 or GROUND not in follower.between:
        raise loop.error("a loop with one driven joint needs a follower that is on the ground")
    driver, ends = drivers[0], []
    for joint in (driver, follower):
        body = joint.other(GROUND)
        near = next((j for j in loop.of(body) if j is not joint), None)
        if near is None:
            raise loop.error(f"{body} is joined to the ground alone")
        ends.append((joint, near))
    hand, found.end = loop.hand, "the other leg"
    loop.hand = ends[1][1].at
    first = found.leg(driver)
    loop.hand = ends[0][1].at
    second = found.leg(follower)
    loop.hand = hand
    found.check_all_used()
    if first.passive or second.passive:
        raise loop.error("a single loop with a rail is not known; a rod has to close it")
    return [first, second]


def _way(legs: Sequence[LoopLeg], task: Sequence[str]) -> str:
    """The call that derives the loop; a hand that turns sets its task itself."""
    if legs[0].call.startswith("Upright"):
        return "tripod"
    return {0: "platform", 1: "coupled"}.get(len(task), "parallel")


def _sentence(leg: LoopLeg) -> str:
    """What a leg is; the name of a joint keeps its letters."""
    if leg.words.startswith(f"{leg.joint.name} "):
        return f"Joint {leg.words}"
    return f"{leg.words[0].upper()}{leg.words[1:]}"


def _head(
    name: str, loop: Loop, legs: Sequence[LoopLeg], task: Sequence[str], origin: str
) -> list[str]:
    title = name.replace("_", " ").capitalize()
    words = "  ".join(f"{_sentence(leg)}." for leg in legs)
    calls = sorted({c for leg in legs for c in re.findall(r"([A-Z]\w+)\(", leg.call)} - FUNCTIONS)
    names = sorted([*calls, "Derivation", "Paper", _way(legs, task), *["real"] * bool(task)])
    fractions = [number(given.get("value") or "1") for given in loop.parameters.values()]
    used = " ".join(leg.call for leg in legs) + "Rational(" * any(
        f.denominator != 1 for f in fractions
    )
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
        f'    Paper("{name}", "{title}", ("the maker of the mechanism",)),',
        *wrapped_literal(words),
        *([f"    task=[{', '.join(literal(x) for x in task)}],"] if task else []),
        ")",
    ]
    for symbol, given in loop.parameters.items():
        value = number(given.get("value") or "1")
        exact = f"{value.numerator}" if value.denominator == 1 else f'Rational("{value}")'
        angle = given.get("unit") == "rad" or (given.get("value") or "1").startswith("-")
        sign = ", nonnegative=False" if angle else ""
        lines.append(
            f'{symbol} = d.parameter("{symbol}", value={exact}, '
            f"unit={literal(given.get('unit') or 'm')}, "
            f'meaning={literal(given.get("meaning") or UNSAID)}, source="{origin}"{sign})'
        )
    return lines


def wrapped_literal(text: str) -> list[str]:
    """A text as an argument in several lines, each a literal."""
    rows = textwrap.wrap(text, 88, drop_whitespace=False)
    return [f"    {literal(row)}{',' * (row is rows[-1])}" for row in rows]


def _body(table: Table, legs: Sequence[LoopLeg], task: Sequence[str]) -> list[str]:
    lines = []
    for joint, kind in table.joints.items():
        argument = ', "prismatic"' if kind == "prismatic" else ""
        lines.append(f'{joint} = d.joint("{joint}"{argument})')
    for leg in legs:
        if leg.passive:
            lines.append(f'{leg.passive} = d.joint("{leg.passive}", "prismatic", passive=True)')
    if len(task) == 1:
        (x,) = task
        lines += [f'{x} = real("{x}")', f"{_way(legs, task)}(", "    d,"]
        return [*lines, *(f"    {leg.call}," for leg in legs), ")"]
    hand = [f"    ({', '.join(f'real({literal(x)})' for x in task)}),"] if task else []
    lines += [f"{_way(legs, task)}(", "    d,", *hand, "    ["]
    return [*lines, *(f"        {leg.call}," for leg in legs), "    ],", ")"]


__all__ = ["loop_script"]
