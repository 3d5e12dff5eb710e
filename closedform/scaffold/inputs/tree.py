"""A tree of links, as in files that describe robots, and the chain from a base to a tool.

Such files contain rounded numbers.  Rounded angles, such as 1.5708, become the fraction of pi that
they stand for, and noise that the arithmetic of an exporter added to lengths and axes is removed;
the notes say so.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import combinations
from typing import NamedTuple

import sympy as sp

from closedform.mechanics.frames import exponential, homogeneous, rotation
from closedform.model.tolerances import UNIT_LENGTH
from closedform.scaffold.inputs.decimals import add_axes, has_many_angles, rational_if_slow
from closedform.scaffold.inputs.exact import decimals, orthonormal, unit_vector, without_squares
from closedform.scaffold.inputs.held import held
from closedform.scaffold.inputs.joints import MOVING, Joint, Mimic, couple, declare, led
from closedform.scaffold.inputs.own_turns import (
    along_axes,
    own_part,
    own_turn,
    product,
    turned_back,
)
from closedform.scaffold.inputs.tables import (
    JOINTS,
    Short,
    Table,
    TableError,
    shown_name,
    use_exact,
)

LARGEST = 2_000_000
"""Maximum size of a file in bytes; meshes are files of their own."""
NOISE = 1e-9
"""Angles and coordinates of axes below this are the rounding of an exporter, not meant.

A difference below this, also of a length, is not worth a note.
"""
MEANT = ((0, Fraction(1, 10**5)), (4, Fraction(1, 10**6)), (9, Fraction(1, 10**9)))
"""A length this close to a number with this many decimals stands for it; finally, nanometres."""
NEAR = 5e-4
"""An angle this close to a multiple of pi/12 stands for it; so does a direction to an axis."""
TILTS = (sp.atan(sp.sqrt(2) / 2), sp.atan(sp.sqrt(2)))
"""Angles between the diagonal of a cube and its sides and edges: 35.26 and 54.74 degrees."""
ROUNDED = 1e-6
"""An angle is never exact: a difference from what it stands for below this is not worth a note."""
FAR = 20
"""Joints farther apart than this are probably not placed in metres."""
SHORT = 1 / 200
"""Of the longest length of a chain: a shorter one is named if no inverse is found."""
CIRCLE = "the links form a circle; closed loops are written with --from loop"


@dataclass(frozen=True)
class Choice:
    """The links between which the chain is read; ``ignore`` is a length that counts as 0.

    By default the chain leads from the root to the only end that has joints before it.  ``hold``
    has the values of joints that are held, as text.
    """

    base: str = ""
    tool: str = ""
    ignore: float = 0.0
    hold: Mapping[str, str] = field(default_factory=dict)


DEFAULT = Choice()


def table_of(joints: Sequence[Joint], file: str, choice: Choice) -> Table:
    """The chain of a file, as axes at home."""
    if not joints:
        raise TableError(f"{file}: there are no joints")
    chain = _chain(joints, choice.base, choice.tool, file)
    if not chain:
        raise TableError(
            f"{file}: no joint leads from {shown_name(choice.base or choice.tool)} to the tool; "
            f"choose a tool after it, with --tool, or another --base"
        )
    chain = led(chain, joints, file)
    table = Table(notes=[note for joint in chain for note in joint.notes])
    as_written = chain
    chain = _without_short(chain, choice.ignore, file, table.notes)
    table.end = chain[-1].child
    short = _short(chain)
    table.doubt = "" if choice.tool else _gripper(chain)
    chain = held(chain, choice.hold, table, file)
    found = list(_read(chain, table, Displacement.of(as_written, choice.ignore), file))
    table, moved, mimics, offsets = min(found, key=_Placed.effort)
    table.short = _shortest(table.axes, short)
    if not table.axes:
        raise TableError(f"{file}: no joint between {chain[0].parent} and {chain[-1].child} moves")
    couple(mimics, table)
    table.axes = [(joint + offsets.get(joint, 0), w, at) for joint, w, at in table.axes]
    table.notes.append(
        f"{file}: the chain leads from {shown_name(chain[0].parent)} to "
        f"{shown_name(chain[-1].child)}"
    )
    table.notes += moved.notes(file) + _units(as_written, file)
    use_exact(table, file)
    return table


def _read(
    chain: Sequence[Joint], table: Table, moved: Displacement, file: str
) -> Iterator[_Placed]:
    """The ways to read a chain: as it is, with offsets of joints, or in decimals."""
    angles = [own_turn(joint) for joint in chain]
    straight = [turned_back(j, a) for j, a in zip(chain, angles, strict=True)]
    if has_many_angles(straight):
        yield _Placed.in_decimals(chain, table, deepcopy(moved), file)
        return
    if not has_many_angles(chain):
        yield _Placed.of(chain, table, deepcopy(moved), file)
    if any(angles):  # sines of angles are slow, and joints may turn them back
        yield _Placed.of(chain, table, deepcopy(moved), file, angles)
    parts = [a or own_part(joint) for a, joint in zip(angles, chain, strict=True)]
    if parts != angles:  # so are sums of roots, such as the cosine of pi/12
        yield _Placed.of(chain, table, deepcopy(moved), file, parts)


class _Placed(NamedTuple):
    """A table with the axes of a chain at home, the joints that mimic others, and offsets."""

    table: Table
    moved: Displacement
    mimics: list[Mimic]
    offsets: dict[sp.Symbol, sp.Expr]

    @classmethod
    def of(
        cls,
        chain: Sequence[Joint],
        table: Table,
        moved: Displacement,
        file: str,
        offsets: Sequence[sp.Expr] = (),
    ) -> _Placed:
        """The axes where all joints are zero; with ``offsets``, where they have turned back what
        their origins turn them about their own axes."""
        table, place = deepcopy(table), sp.eye(4)
        mimics: list[Mimic] = []
        turned: dict[sp.Symbol, sp.Expr] = {}
        for joint, angle in zip(chain, offsets or [sp.S.Zero] * len(chain), strict=True):
            where = f"{file}, joint {shown_name(joint.name)}"
            joint = turned_back(joint, angle)
            there = product(place, joint.origin)
            place = _meant_turns(there, where, table.notes)
            moved.turn(joint, between(place, there))
            if joint.kind == "fixed":
                continue
            there, place = place, _level(place, table, where, moved.ignore)
            moved.moved += _size(place[:3, 3] - there[:3, 3])
            if joint.mimics:
                mimics.append(Mimic(joint, place, len(table.axes), file))
                place = product(place, _offset(joint, where, table.notes))
                continue
            if not table.axes and not along_axes(place):
                # what a tilted mount does to all axes stays apart
                table.base, place = rational_if_slow(place, where, table), sp.eye(4)
            symbol = declare(joint, table, where)
            axis = _unit(joint.axis, place[:3, :3], table, where)
            direction = (place[:3, :3] * axis).applyfunc(sp.expand)
            table.axes.append((symbol, list(direction), list(place[:3, 3])))
            turned[symbol] = angle
        table.home = place
        return cls(table, moved, mimics, turned)

    @classmethod
    def in_decimals(
        cls, chain: Sequence[Joint], table: Table, moved: Displacement, file: str
    ) -> _Placed:
        """The axes of a chain whose frames have many angles."""
        table = deepcopy(table)
        changed = add_axes(chain, table, file, moved.ignore)
        for joint, angle in changed.turned:
            moved.turn(joint, 2 * angle)
        moved.moved += changed.moved
        moved.turned += changed.tool
        return cls(table, moved, [], {})

    def effort(self) -> tuple[int, ...]:
        """How many angles are in axes, tool and offsets, and how many of them in sines; then how
        many coordinates have roots, and how many joints have offsets."""
        vectors = [v for _, *both in self.table.axes for v in both]
        entries = [*self.table.home, *(e for v in vectors for e in v)]
        inside = {abs(f.args[0]) for e in entries for f in e.atoms(sp.sin, sp.cos)}
        offsets = [abs(a) for a in self.offsets.values() if a != 0]
        with_sines = {a for a in offsets if sp.sin(a).has(sp.sin)}
        roots = [e for e in entries if any(not r.exp.is_Integer for r in e.atoms(sp.Pow))]
        return len(inside | with_sines), len(inside), len(roots), len(offsets)


def _offset(joint: Joint, where: str, notes: list[str]) -> sp.Matrix:
    """How far a joint that mimics another is moved if that one is at zero."""
    if joint.offset == 0:
        return sp.eye(4)
    if not orthonormal(joint.axis):
        raise TableError(
            f"{where}: it mimics {shown_name(joint.mimics)} with an offset, and its axis is not "
            f"along the coordinates; put the offset into the origin of the next joint"
        )
    if MOVING[joint.kind] == "prismatic":
        return homogeneous(sp.eye(3), tuple(joint.offset * joint.axis))
    twist = sp.Matrix([0, 0, 0, *joint.axis])
    return exponential(twist, meant_angle(joint.offset, f"{where}: offset", notes))


class Displacement:
    """How far what was taken for other numbers moves the tool, in any posture."""

    def __init__(self, ignore: float) -> None:
        self.ignore = ignore
        self.turned = self.moved = 0.0
        self.after: dict[str, float] = {}
        self.slides = False

    @classmethod
    def of(cls, chain: Sequence[Joint], ignore: float) -> Displacement:
        found, after = cls(ignore), 0.0
        for joint in reversed(chain):
            if MOVING.get(joint.kind) == "prismatic":
                found.slides = True
            found.after[joint.name] = after
            if joint.written is not None:
                place, axis = joint.written
                found.turn(joint, between(joint.origin, place))
                found.moved += _size(joint.origin[:3, 3] - place[:3, 3])
                if joint.kind in MOVING:
                    found.turn(joint, 2 * _between(joint.axis, axis))
            after += _size(joint.origin[:3, 3])
        return found

    def turn(self, joint: Joint, angle: float) -> None:
        """Add a turn of what comes after a joint."""
        self.turned += angle
        self.moved += angle * self.after[joint.name]

    def notes(self, file: str) -> list[str]:
        if max(self.turned, self.moved) < NOISE:
            return []
        slides = ", with its slides at 0," if self.slides else ""
        return [
            f"{file}: what is taken for other numbers moves the tool{slides} by at most "
            f"{_rounded_up(self.moved)}, and turns it by at most {_rounded_up(self.turned)} rad"
        ]


def between(one: sp.Matrix, other: sp.Matrix) -> float:
    """The angle of the rotation between those of two poses."""
    if one == other:
        return 0.0
    return 2 * math.asin(min(1.0, _size(one[:3, :3] - other[:3, :3]) / math.sqrt(8)))


def _between(one: sp.Matrix, other: sp.Matrix) -> float:
    """The angle between two directions."""
    return math.asin(min(1.0, _size(one.cross(other)) / (_size(one) * _size(other))))


def _unit(axis: sp.Matrix, frame: sp.Matrix, table: Table, where: str) -> sp.Matrix:
    """The unit vector that the decimals of an axis stand for, if its frame hides them later."""
    if not frame.has(sp.sin, sp.cos) or orthonormal(axis):
        return axis
    seen = [(frame.T * sp.Matrix(v)).applyfunc(without_squares) for _, v, _ in table.axes]
    unit = unit_vector(axis, [v for v in seen if not v.has(sp.sin, sp.cos)])
    if unit is None:
        return axis
    table.notes.append(
        f"{where}: the axis {decimals(axis)} is rounded; the unit vector "
        f"({', '.join(map(str, unit))}) is used instead"
    )
    return unit


def _size(value: sp.Matrix) -> float:
    still = dict.fromkeys(value.free_symbols, sp.S.Zero)
    return math.sqrt(sum(float(e.xreplace(still).evalf(30)) ** 2 for e in value))


def _units(chain: Sequence[Joint], file: str) -> list[str]:
    """A note if the lengths are too large for metres."""
    far = max(chain, key=lambda joint: _size(joint.origin[:3, 3]))
    length = _size(far.origin[:3, 3])
    if length <= FAR:
        return []
    return [
        f"{file}: joint {shown_name(far.name)} is {length:.4g} m from the origin of its parent "
        f"link; if the file is in millimetres, divide its lengths by 1000"
    ]


def _without_short(
    chain: Sequence[Joint], ignore: float, file: str, notes: list[str]
) -> list[Joint]:
    """The chain with lengths of at most ``ignore`` as 0; the notes say how far that is from it."""
    kept, moved = [], 0.0
    for joint in chain:
        place = joint.origin.copy()
        short = [i for i in range(3) if 0 < abs(float(place[i, 3])) <= ignore]
        if short:
            lengths = [float(place[i, 3]) for i in short]
            moved += math.hypot(*lengths)
            notes.append(
                f"{file}, joint {shown_name(joint.name)}: {', '.join(f'{e:.6g}' for e in lengths)} "
                f"is taken for 0, because of --ignore"
            )
            for i in short:
                place[i, 3] = sp.S.Zero
        kept.append(replace(joint, origin=place))
    if moved:
        notes.append(
            f"{file}: without these lengths the tool is at most {_rounded_up(moved)} from where "
            f"the file has it; its orientation is the same"
        )
    return kept


def _rounded_up(length: float) -> str:
    if length < 1e-12:  # what rounding adds
        return "0"
    step = 10.0 ** (math.floor(math.log10(length)) - 1)
    return f"{math.ceil(length / step - 1e-9) * step:.2g}"


def _short(chain: Sequence[Joint]) -> tuple[float, str] | None:
    """The longest of the lengths that are short beside the others, and its joint."""
    sizes = [(abs(float(e)), joint.name) for joint in chain for e in joint.origin[:3, 3] if e != 0]
    longest = max(sizes, default=(0.0, ""))[0]
    return max((found for found in sizes if found[0] < SHORT * longest), default=None)


def _gripper(chain: Sequence[Joint]) -> str:
    """What to try if the last joint does not carry the tool: a sentence."""
    last = [joint for joint in chain if joint.kind in MOVING][-1:]
    return "".join(
        f"If the last joint, {shown_name(j.name)}, opens a hand, end the chain before it, with "
        f"--tool {shown_name(j.parent)}."
        for j in last
    )


def placed(xyz: Sequence[sp.Expr], rpy: Sequence[sp.Expr]) -> sp.Matrix:
    """A pose from its position and from turns about the fixed axes x, y and z, in this order."""
    x, y, z = rpy
    return homogeneous(rotation("z", z) * rotation("y", y) * rotation("x", x), tuple(xyz))


def meant_number(value: sp.Rational, what: str, notes: list[str]) -> sp.Rational:
    """A number, or 0 if it is noise."""
    return value if abs(float(value)) >= NOISE else _taken(value, sp.S.Zero, what, notes)


def meant_length(value: sp.Rational, what: str, notes: list[str]) -> sp.Rational:
    """A length without what the arithmetic of an exporter added to it."""
    length = Fraction(int(value.p), int(value.q))  # rounds a hundred times faster than SymPy
    for places, near in MEANT:
        steps = round(length * 10**places)
        if abs(length - Fraction(steps, 10**places)) < near and (places or steps == 0):
            return _taken(value, sp.Rational(steps, 10**places), what, notes)
    return value


def _taken(value: sp.Rational, meant: sp.Rational, what: str, notes: list[str]) -> sp.Rational:
    if abs(float(value - meant)) >= NOISE:
        notes.append(f"{what} {float(value)!r} is taken for {float(meant):.12g}")
    return meant


def meant_axis(given: sp.Matrix, where: str, notes: list[str]) -> sp.Matrix:
    """An axis: along the coordinates if it nearly is, else a unit vector, unless rounded."""
    size = max(map(abs, given))
    others = sp.sqrt(given.dot(given) - size**2)
    if 0 < others < NEAR * size:
        found = given.applyfunc(lambda e: sp.sign(e) if abs(e) == size else sp.S.Zero)
        if others >= NOISE * size:
            notes.append(f"{where}: the axis {decimals(given)} is taken for {decimals(found)}")
        return found
    length = sp.sqrt(given.dot(given))
    exact = length.is_Rational or abs(float(length) - 1) > UNIT_LENGTH  # else it was rounded
    return given / length if exact and length != 1 else given


def meant_angle(value: sp.Rational, where: str, notes: list[str]) -> sp.Expr:
    """The multiple of pi/12, or the tilt of the diagonal of a cube, that was rounded to a number.

    Right angles are written with two decimals too, as 1.57 and 3.14.  Any other number is itself.
    """
    given = float(value)
    steps = round(given * 12 / math.pi)
    exact, near = steps * sp.pi / 12, steps * math.pi / 12
    short = steps % 6 == 0 and f"{near:.2f}" == f"{given:.12g}"
    if given == 0 or (abs(near - given) > NEAR and not short):
        tilt = next((a for a in TILTS if abs(float(a) - abs(given)) < NEAR), None)
        if tilt is None:
            return value
        exact, near = (tilt, float(tilt)) if given > 0 else (-tilt, -float(tilt))
    if abs(near - given) > ROUNDED:
        notes.append(f"{where}: the angle {given:.9g} is taken for {exact}")
    return exact


def _chain(joints: Sequence[Joint], base: str, tool: str, file: str) -> list[Joint]:
    """The joints from the base to the tool."""
    above: dict[str, Joint] = {}
    for joint in joints:
        if joint.child in above:
            raise TableError(
                f"{file}: the link {shown_name(joint.child)} has two parents; closed loops are "
                f"written with --from loop"
            )
        above[joint.child] = joint
    links = {j.parent for j in joints} | set(above)
    for given, what in ((base, "base"), (tool, "tool")):
        if given and given not in links:
            raise TableError(
                f"{file}: there is no link {shown_name(given)} for the {what}; the links are "
                f"{', '.join(sorted(map(shown_name, links)))}"
            )
    if not tool:
        tool = _only_end(above, {j.parent for j in joints}, file)
    found: list[Joint] = []
    link = tool
    while link != base and link in above:
        joint = above[link]
        if joint.kind in ("ball", "floating", "planar"):
            raise TableError(
                f"{file}, joint {shown_name(joint.name)}: a {joint.kind} joint has no closed "
                f"form here; choose a base after it, such as --base {shown_name(joint.child)}"
            )
        if len(found) > 20 * JOINTS:
            raise TableError(f"{file}: {CIRCLE}")
        found.insert(0, joint)
        link = joint.parent
    if base and link != base:
        raise TableError(
            f"{file}: {shown_name(tool)} is not carried by {shown_name(base)}; its root is "
            f"{shown_name(link)}"
        )
    return found


def _only_end(above: Mapping[str, Joint], parents: set[str], file: str) -> str:
    """The end of the only chain that moves, with the fixed links at its end."""
    ends: dict[tuple[str, ...], list[str]] = {}
    if above and not set(above) - parents:
        raise TableError(f"{file}: {CIRCLE}")
    for link in sorted(set(above) - parents):
        moving: list[str] = []
        at = link
        while at in above and len(moving) <= JOINTS:
            if above[at].kind in MOVING:
                moving.insert(0, above[at].name)
            at = above[at].parent
        ends.setdefault(tuple(moving), []).append(link)
    longest = [m for m in ends if m and not any(m != o and m == o[: len(m)] for o in ends)]
    if not longest:
        raise TableError(f"{file}: no joint turns about an axis or slides along one")
    if len(longest) > 1 or len(ends[longest[0]]) > 1:
        choices = sorted(shown_name(link) for m in longest for link in ends[m])
        raise TableError(
            f"{file}: there are several ends; choose one with --tool: {', '.join(choices)}"
            f"{_parting([link for m in longest for link in ends[m]], above)}"
        )
    return ends[longest[0]][0]


def _parting(ends: Sequence[str], above: Mapping[str, Joint]) -> str:
    """A clause on the link where the chains to some ends part, if joints that move lead there."""
    chains = []
    for end in ends:
        chain = [end]
        while chain[0] in above and len(chain) <= 20 * JOINTS:
            chain.insert(0, above[chain[0]].parent)
        chains.append(chain)
    common = [links[0] for links in zip(*chains, strict=False) if len(set(links)) == 1]
    moving = [above[link].name for link in common if link in above and above[link].kind in MOVING]
    if not moving:
        return ""
    joints = shown_name(moving[0])
    if len(moving) > 1:
        joints = f"the {len(moving)} joints {joints} to {shown_name(moving[-1])}"
    return f"; or {shown_name(common[-1])}, where they part, after {joints}"


def _level(place: sp.Matrix, table: Table, where: str, ignore: float) -> sp.Matrix:
    """The place of a joint, with coordinates of those before it if lengths nearly add up to them.

    Lengths that cancel are rounded one by one: 0.0036562 up and 0.0036563 down parts two axes.
    """
    place, near = place.copy(), max(float(MEANT[0][1]), ignore * (1 + NOISE))
    for i in range(3):
        gaps = [(_gap(place[i, 3], at[i]), joint, at[i]) for joint, _, at in table.axes]
        found = [(gap, k) for k, (gap, *_) in enumerate(gaps) if gap < near]
        if not found:
            continue
        gap, joint, place[i, 3] = gaps[min(found)[1]]
        if gap >= NOISE:
            table.notes.append(
                f"{where}: with all joints at zero its {'xyz'[i]} is taken for that of joint "
                f"{joint}, {gap:.3g} from it{', because of --ignore' if gap <= ignore else ''}"
            )
    return place


def _gap(one: sp.Expr, other: sp.Expr) -> float:
    """How far two coordinates are from each other; infinite if that depends on a parameter."""
    apart = one - other
    return math.inf if apart.free_symbols else abs(float(apart))


def _shortest(
    axes: Sequence[tuple[sp.Symbol, list[sp.Expr], list[sp.Expr]]], short: tuple[float, str] | None
) -> list[Short]:
    """What may not be meant, if no inverse is found: ``short`` lengths, and coordinates that nearly
    agree, also without these; the shortest first.
    """
    least, found = NOISE, []
    if short:
        least, name = short
        told = f"The file has lengths such as {least:.6g}, of the joint {shown_name(name)}"
        found.append(Short(told, _rounded_up(least)))
    gaps = [
        (_gap(here[i], there[i]), str(one), str(other), "xyz"[i])
        for (one, _, there), (other, _, here) in combinations(axes, 2)
        for i in range(3)
    ]
    longest = max((gap for gap, *_ in gaps if gap < math.inf), default=0.0)
    parted = {
        _rounded_up(gap): f"With all joints at zero, {coordinate} of the joints {one} and {other} "
        f"differs by {gap:.6g}"
        for gap, one, other, coordinate in sorted(gaps, reverse=True)
        if least < gap < SHORT * longest
    }
    some = sorted(parted.items(), key=lambda item: float(item[0]))[:3]
    return [*found, *(Short(told, gap) for gap, told in some)]


def _meant_turns(place: sp.Matrix, where: str, notes: list[str]) -> sp.Matrix:
    """A pose with the multiples of pi/12 to which angles add up, as 2.7549 and 0.3867 do."""
    numbers = {f for f in place.atoms(sp.sin, sp.cos) if not f.free_symbols}
    sums = sorted({f.args[0] for f in numbers}, key=sp.default_sort_key)
    meant = {a: meant_angle(a, f"{where}, together with the turns before it", notes) for a in sums}
    return place.xreplace({f: f.func(meant[f.args[0]]) for f in numbers})
