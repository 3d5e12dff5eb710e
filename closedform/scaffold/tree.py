"""A tree of links, as in files that describe robots, and the chain from a base to a tool.

Such files contain rounded numbers.  Rounded angles, such as 1.5708, become the fraction of pi that
they stand for, and noise that the arithmetic of an exporter added to lengths and axes is removed;
the notes say so.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from closedform.mechanics.frames import homogeneous, rotation
from closedform.model.functions import real
from closedform.scaffold.exact import orthonormal, turned_on, unit_vector, without_squares
from closedform.scaffold.tables import (
    JOINTS,
    NUMBERED,
    TAKEN,
    Table,
    TableError,
    add_joint,
    shown_name,
    use_exact,
)

LARGEST = 2_000_000
"""Maximum size of a file in bytes; meshes are files of their own."""
NOISE = sp.Rational(1, 10**9)
"""Angles and coordinates of axes below this are the rounding of an exporter, not meant."""
MEANT = ((0, sp.Rational(1, 10**5)), (4, sp.Rational(1, 10**6)), (9, sp.Rational(1, 10**9)))
"""A length this close to a number with this many decimals stands for it; finally, nanometres."""
ALONG = 2e-5
"""A direction this close to an axis of coordinates, in radians, stands for it."""
NEAR = sp.Rational(1, 2000)
"""An angle this close to a multiple of pi/12 stands for it."""
SHORT = 1 / 200
"""Of the longest length of a chain: a shorter one is named if no inverse is found."""
MOVING = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic"}


@dataclass(frozen=True)
class Joint:
    """A joint of the file, with its place on the parent link and its axis, as they are written."""

    name: str
    kind: str
    parent: str
    child: str
    origin: sp.Matrix
    axis: sp.Matrix
    limits: tuple[str, str] | None = None
    mimics: str = ""
    factor: sp.Rational = sp.S.One
    offset: sp.Rational = sp.S.Zero
    """Of a joint that mimics another: its value is the factor times that one, plus the offset."""
    written: tuple[sp.Matrix, sp.Matrix] | None = None
    """Place and axis without what was taken for other numbers; None if nothing was."""
    notes: tuple[str, ...] = ()
    """What was not taken as it is written."""


@dataclass(frozen=True)
class Choice:
    """The links between which the chain is read; ``ignore`` is a length that counts as 0.

    By default the chain leads from the root to the only end that has joints before it.
    """

    base: str = ""
    tool: str = ""
    ignore: float = 0.0


DEFAULT = Choice()


def table_of(joints: Sequence[Joint], file: str, choice: Choice) -> Table:
    """The chain of a file, as axes at home."""
    if not joints:
        raise TableError(f"{file}: there are no joints")
    chain = _chain(joints, choice.base, choice.tool, file)
    table = Table(notes=[note for joint in chain for note in joint.notes])
    moved = Displacement.of(chain)
    chain = _without_short(chain, choice.ignore, file, table.notes)
    table.doubt = _doubt(chain)
    place = sp.eye(4)
    mimics: list[_Mimic] = []
    for joint in chain:
        where = f"{file}, joint {shown_name(joint.name)}"
        there = _product(place, joint.origin)
        place = _meant_turns(there, where, table.notes)
        moved.turn(joint, between(place, there))
        if joint.kind == "fixed":
            continue
        if joint.mimics:
            mimics.append(_Mimic(joint, place, len(table.axes), where))
            continue
        if not table.axes and not _along_axes(place):
            table.base, place = place, sp.eye(4)  # what a tilted mount does to all axes stays apart
        name = _symbol(joint.name)
        add_joint(table, name, MOVING[joint.kind], where)
        axis = _unit(joint.axis, place[:3, :3], table, where)
        direction = (place[:3, :3] * axis).applyfunc(sp.expand)
        table.axes.append((real(name), list(direction), list(place[:3, 3])))
        if name != joint.name:
            table.notes.append(f"{where}: it is called {name}")
        if joint.limits:
            table.limits[name] = joint.limits
    if not table.axes:
        raise TableError(f"{file}: no joint between {chain[0].parent} and {chain[-1].child} moves")
    for mimic in mimics:
        mimic.couple(table)
    table.home = place
    table.notes.append(
        f"{file}: the chain leads from {shown_name(chain[0].parent)} to "
        f"{shown_name(chain[-1].child)}"
    )
    table.notes += moved.notes(file)
    use_exact(table, file)
    return table


class Displacement:
    """How far what was taken for other numbers moves the tool, in any posture."""

    def __init__(self) -> None:
        self.turned = self.moved = 0.0
        self.after: dict[str, float] = {}
        self.slides = False

    @classmethod
    def of(cls, chain: Sequence[Joint]) -> Displacement:
        found, after = cls(), 0.0
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
        f"{where}: the axis {_listed(axis)} is rounded; the unit vector "
        f"({', '.join(map(str, unit))}) is used instead"
    )
    return unit


def _size(value: sp.Matrix) -> float:
    return math.sqrt(sum(float(e.evalf(30)) ** 2 for e in value))


@dataclass(frozen=True)
class _Mimic:
    """A joint that mimics another, at home, after some number of other joints of the chain."""

    joint: Joint
    place: sp.Matrix
    after: int
    where: str

    def couple(self, table: Table) -> None:
        """Let a neighbour on the same axis turn by what this joint adds; another has no chain."""
        mimicked, factor = _symbol(self.joint.mimics), self.joint.factor
        told = f"{self.where}: it mimics {shown_name(self.joint.mimics)}"
        if mimicked not in table.joints:
            raise TableError(f"{told}, which is not on the chain")
        for k in (self.after, self.after - 1):
            if 0 <= k < len(table.axes) and (sense := self._sense(*table.axes[k][1:])):
                name = str(table.axes[k][0])
                break
        else:
            name = ""
        whole = factor.is_Integer and self.joint.offset == 0
        turns = {"revolute"} == {
            MOVING[self.joint.kind],
            table.joints.get(name),
            table.joints[mimicked],
        }
        if not (whole and turns) or name == mimicked or mimicked in table.couplings:
            raise TableError(
                f"{told}; a mimic joint is read if it turns about the axis of a neighbour on the "
                f"chain that has a motor of its own, and by a whole multiple of the angle of "
                f"another, as in a parallelogram.  Write the arm as a table of joints and couple "
                f"the two with d.joint(..., coupling=...)"
            )
        own = table.couplings.get(name, real(f"m_{name}"))
        table.couplings[name] = own + sense * factor * real(f"m_{mimicked}")
        table.limits.pop(name, None)
        table.notes.append(
            f"{told}; both turn about the axis of {name}, whose angle is {table.couplings[name]} "
            f"in those of the motors"
        )

    def _sense(self, direction: Sequence[sp.Expr], point: Sequence[sp.Expr]) -> int:
        """1 or -1 if an axis is that of this joint, in its direction or against it; else 0."""
        own = (self.place[:3, :3] * self.joint.axis).applyfunc(sp.expand)
        other, between_axes = sp.Matrix(direction), sp.Matrix(point) - self.place[:3, 3]
        same = own.cross(other).applyfunc(sp.simplify).is_zero_matrix
        if not same or not own.cross(between_axes).applyfunc(sp.simplify).is_zero_matrix:
            return 0
        return 1 if sp.simplify(own.dot(other)) > 0 else -1


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


def _doubt(chain: Sequence[Joint]) -> str:
    """What to try if no inverse is found: a sentence on lengths that may not be meant, or none."""
    sizes = [(abs(float(e)), joint.name) for joint in chain for e in joint.origin[:3, 3] if e != 0]
    longest = max(sizes, default=(0.0, ""))[0]
    short = [found for found in sizes if found[0] < SHORT * longest]
    if not short:
        return ""
    length, name = max(short)
    return (
        f"The file has lengths such as {length:.6g}, of the joint {shown_name(name)}; if they are "
        f"not meant, leave them out with --ignore {_rounded_up(length)}."
    )


def placed(xyz: Sequence[sp.Expr], rpy: Sequence[sp.Expr]) -> sp.Matrix:
    """A pose from its position and from turns about the fixed axes x, y and z, in this order."""
    x, y, z = rpy
    return homogeneous(rotation("z", z) * rotation("y", y) * rotation("x", x), tuple(xyz))


def meant_number(value: sp.Rational, what: str, notes: list[str]) -> sp.Rational:
    """A number, or 0 if it is noise."""
    return value if abs(value) >= NOISE else _taken(value, sp.S.Zero, what, notes)


def meant_length(value: sp.Rational, what: str, notes: list[str]) -> sp.Rational:
    """A length without what the arithmetic of an exporter added to it."""
    for decimals, near in MEANT:
        short = sp.Rational(round(value * 10**decimals), 10**decimals)
        if abs(value - short) < near and (decimals or short == 0):
            return _taken(value, short, what, notes)
    return value


def _taken(value: sp.Rational, meant: sp.Rational, what: str, notes: list[str]) -> sp.Rational:
    if value != meant:
        notes.append(f"{what} {float(value)!r} is taken for {float(meant):.12g}")
    return meant


def meant_axis(given: sp.Matrix, where: str, notes: list[str]) -> sp.Matrix:
    """An axis: along the coordinates if it nearly is, a unit vector if its length is rational."""
    size = max(map(abs, given))
    others = sp.sqrt(given.dot(given) - size**2)
    if 0 < others < ALONG * size:
        found = given.applyfunc(lambda e: sp.sign(e) if abs(e) == size else sp.S.Zero)
        notes.append(f"{where}: the axis {_listed(given)} is taken for {_listed(found)}")
        return found
    length = sp.sqrt(given.dot(given))
    return given / length if length.is_Rational and length != 1 else given


def _listed(vector: sp.Matrix) -> str:
    return "(" + ", ".join(f"{float(e):.12g}" for e in vector) + ")"


def meant_angle(value: sp.Rational, where: str, notes: list[str]) -> sp.Expr:
    """The multiple of pi/12 that was rounded to a number, or the number.

    Right angles are written with two decimals too, as 1.57 and 3.14.
    """
    steps = sp.Integer(round(float(value) * 12 / math.pi))
    exact = steps * sp.pi / 12
    short = steps % 6 == 0 and value == sp.Rational(f"{float(exact):.2f}")
    if value == 0 or (abs(sp.N(exact - value, 30)) > NEAR and not short):
        return value
    notes.append(f"{where}: the angle {sp.N(value, 8)} is taken for {exact}")
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
                f"form here; choose a base after it with --base"
            )
        if len(found) > 20 * JOINTS:
            raise TableError(f"{file}: the links form a circle")
        found.insert(0, joint)
        link = joint.parent
    if base and link != base:
        raise TableError(
            f"{file}: {shown_name(tool)} is not carried by {shown_name(base)}; its root is "
            f"{shown_name(link)}"
        )
    return found


def _along_axes(place: sp.Matrix) -> bool:
    """Whether a pose turns the axes of coordinates to each other."""
    return all(e in (-1, 0, 1) for e in place[:3, :3])


def _only_end(above: Mapping[str, Joint], parents: set[str], file: str) -> str:
    """The end of the only chain that moves, with the fixed links at its end."""
    ends: dict[tuple[str, ...], list[str]] = {}
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
        raise TableError(f"{file}: no joint moves")
    if len(longest) > 1 or len(ends[longest[0]]) > 1:
        choices = sorted(shown_name(link) for m in longest for link in ends[m])
        raise TableError(
            f"{file}: there are several ends; choose one with --tool: {', '.join(choices)}"
        )
    return ends[longest[0]][0]


def _product(a: sp.Matrix, b: sp.Matrix) -> sp.Matrix:
    shifted = a[:3, :3] * b[:3, 3] + a[:3, 3]
    return homogeneous(turned_on(a[:3, :3], b[:3, :3]), tuple(shifted.applyfunc(sp.expand)))


def _meant_turns(place: sp.Matrix, where: str, notes: list[str]) -> sp.Matrix:
    """A pose with the multiples of pi/12 to which angles add up, as 2.7549 and 0.3867 do."""
    held = place.atoms(sp.sin, sp.cos)
    sums = sorted({f.args[0] for f in held}, key=sp.default_sort_key)
    meant = {a: meant_angle(a, f"{where}, together with the turns before it", notes) for a in sums}
    return place.xreplace({f: f.func(meant[f.args[0]]) for f in held})


def _symbol(name: str) -> str:
    """The name of a joint as an identifier that the written script does not use itself."""
    plain = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_")
    known = plain if plain[:1].isalpha() else f"q_{plain}"
    return f"{known}_0" if known in TAKEN or NUMBERED.fullmatch(known) else known
