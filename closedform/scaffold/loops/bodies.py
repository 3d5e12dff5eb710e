"""The bodies of a closed loop, and the joints between them, as a file has them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import sympy as sp

from closedform.scaffold.inputs.tables import TableError

GROUND = "ground"
AXES = "xyz"


@dataclass(frozen=True)
class Joint:
    """A joint of the file."""

    name: str
    kind: str
    between: tuple[str, str]
    at: str
    axis: sp.Matrix | None
    driven: bool
    second: sp.Matrix | None = None
    """The axis that is fixed to the hand, of a universal joint between it and the ground."""

    def other(self, body: str) -> str:
        return self.between[1] if self.between[0] == body else self.between[0]


@dataclass
class Loop:
    """The content of a file: the bodies with their points, and the joints."""

    file: str
    dimensions: int
    hand: str
    bodies: dict[str, dict[str, sp.Matrix]] = field(default_factory=dict)
    rods: dict[str, sp.Expr] = field(default_factory=dict)
    parallelograms: dict[str, sp.Matrix] = field(default_factory=dict)
    """The rods and cranks that are parallelograms, with a vector along their short sides."""
    apexes: dict[str, sp.Matrix] = field(default_factory=dict)
    """Of a parallelogram with a third rod, the vector from the middle to it."""
    joints: dict[str, Joint] = field(default_factory=dict)
    parameters: dict[str, dict[str, str]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    seen: list[str] = field(default_factory=list)
    """What the description of the mechanism begins with: how the loop is seen."""
    said: list[str] = field(default_factory=list)
    """What the description of the mechanism says of parts that the script leaves out."""
    screws: str = ""
    """Where the axes of an RCCC linkage are, as it is written."""

    def of(self, body: str) -> list[Joint]:
        return [j for j in self.joints.values() if body in j.between]

    @property
    def symbols(self) -> set[str]:
        """The names in the expressions."""
        entries = [e for body in self.bodies.values() for at in body.values() for e in at]
        entries += self.rods.values()
        entries += [e for bar in self.parallelograms.values() for e in bar]
        axes = [a for j in self.joints.values() for a in (j.axis, j.second) if a is not None]
        entries += [e for axis in axes for e in axis]
        return {s.name for e in entries for s in e.free_symbols}

    @property
    def positive(self) -> dict[sp.Symbol, sp.Symbol]:
        """The symbols of lengths, as positive ones."""
        angles = {n for n, given in self.parameters.items() if given.get("unit") == "rad"}
        lengths = self.symbols - angles
        return {sp.Symbol(n, real=True): sp.Symbol(n, positive=True) for n in lengths}

    def length(self, v: sp.Matrix) -> sp.Expr:
        """The length of a vector, for positive parameters."""
        positive = self.positive
        square = sp.trigsimp(sp.expand(v.dot(v)).xreplace(positive))
        return sp.sqrt(sp.factor(square)).xreplace({b: a for a, b in positive.items()})

    def error(self, text: str) -> TableError:
        return TableError(f"{self.file}: {text}")


def with_pivots(loop: Loop) -> Loop:
    """The loop with the pivot of each body that a joint with a value turns about the ground.

    The points of such a body are where they are when the joint is zero, so it need not name this.
    """
    bodies = dict(loop.bodies)
    for j in loop.joints.values():
        if GROUND in j.between and j.kind == "revolute" and (j.driven or j.name == loop.hand):
            body = j.other(GROUND)
            own, at = bodies[body], bodies[GROUND].get(j.at)
            if at is not None and own and j.at not in own and body not in loop.rods:
                bodies[body] = {j.at: at, **own}
    return replace(loop, bodies=bodies)


def check_pivot(loop: Loop, joint: Joint) -> None:
    """Refuse a body whose joint has a value, unless it is known where its points are at zero."""
    name, body, at = joint.name, joint.other(GROUND), joint.at
    if body in loop.rods:
        raise loop.error(f"{name} turns {body}; {points_of(body)}")
    own, base = loop.bodies[body].get(at), loop.bodies[GROUND].get(at)
    if own is not None and base is not None and any(sp.simplify(e) != 0 for e in own - base):
        raise loop.error(
            f"{at}, where {name} is, has different coordinates on the ground and on {body}; the "
            f"points of {body} are where they are when {name} is zero"
        )


def points_of(body: str) -> str:
    """What to write for a rod that a joint with a value turns."""
    return (
        f"give {body} its points instead of a length: where they are when the joint that turns it "
        f"is zero"
    )


def check_moved(loop: Loop, driven: Mapping[str, Joint]) -> None:
    """Refuse a hand that is a point of a body that a driven joint moves without any loop."""
    alone = [body for body in driven if loop.hand in loop.bodies[body]]
    if alone and loop.hand not in loop.bodies[GROUND]:
        raise loop.error(
            f"the hand {loop.hand} is a point of {alone[0]}, which {driven[alone[0]].name} moves "
            f"alone, without the loop; the hand is a point of another body, or a joint"
        )


def across_axis(axis: sp.Matrix, arm: sp.Matrix, start: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
    """An arm that turns about an axis, less what is along it, and where the rest starts."""
    along = axis * sp.simplify(arm.dot(axis))
    return (arm - along).applyfunc(sp.simplify), start + along


def around(line: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
    """Two unit vectors in numbers at right angles to a third one, which is their product."""
    k = min(range(len(AXES)), key=lambda i: (abs(line[i]), i))
    first = sp.eye(len(AXES)).col(k) - line[k] * line
    first = (first / sp.sqrt(first.dot(first))).applyfunc(sp.simplify)
    return first, line.cross(first).applyfunc(sp.simplify)


__all__ = [
    "AXES",
    "GROUND",
    "Joint",
    "Loop",
    "across_axis",
    "around",
    "check_moved",
    "check_pivot",
    "points_of",
    "with_pivots",
]
