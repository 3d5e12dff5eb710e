"""The skeleton of a mechanism: the points and links to draw, exported as a function and proved.

The proof shows that no link changes its length when the joints move, and that the position of the
hand is that of the forward map.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import sympy as sp

from closedform.algebra.normal_form import normal
from closedform.mechanics.frames import rotation
from closedform.mechanics.links import Group
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Function, Program
from closedform.model.names import listed
from closedform.model.skeleton import Skeleton

FEW = 3
"""So many links of one kind are told apart; where there are more, their points say which."""


def skeleton(
    d: Derivation,
    points: Mapping[str, Sequence[Any]],
    *,
    links: Mapping[str, Sequence[str]],
    joints: Mapping[sp.Symbol, Sequence[str]],
    hand: str,
    hand_at: Sequence[Any] | None = None,
    ground: Sequence[str] = ("base",),
    lengths: Mapping[tuple[str, str], sp.Expr] | None = None,
    inputs: Sequence[sp.Symbol] | None = None,
    pose: Mapping[str, Any] | None = None,
    program: Program | None = None,
    branches: Branches | None = None,
    notes: Sequence[str] = (),
    at_posture: Sequence[Mapping[str, Sequence[Any]]] = (),
    closing: Mapping[tuple[str, str], sp.Expr] | None = None,
) -> None:
    """Export ``skeleton``, the points of the mechanism in the base frame, and prove it.

    Parameters
    ----------
    d
        the derivation
    points
        the three coordinates of each named point, in the names of the ``program`` if there is one
    links
        polylines through points of one rigid body
    joints
        the points at which each joint is: one for a revolute joint, two for a slide; a joint that
        the task names has its kind from their number
    hand, hand_at
        the point that is the hand, and where the forward map says it is
    ground
        points that are fixed to the base
    lengths
        the distance between two points, for a slide or where the script says it more simply
    inputs
        the joints that it is a function of, by default all that are driven
    pose
        the pose of the hand, an input before the joints, if no forward map gives it
    program
        the program that computes the points
    branches
        the assembly modes, if there are any
    notes
        sentences for its documentation
    at_posture
        for the proof, the points in angles of the mechanism instead of names of the program; a
        later mapping gives points in another way, for the distances between them
    closing
        by how much the squared distance of two points of ``at_posture`` exceeds that of the length:
        an equation of the loop, which the forward map solves
    """
    kinds = {joint: "revolute" if len(at) == 1 else "prismatic" for joint, at in joints.items()}
    kinds |= {j.symbol: j.kind for j in d.joints}
    drawn = Skeleton(
        points=tuple(points),
        links={name: tuple(link) for name, link in links.items()},
        joints={str(joint): tuple(at) for joint, at in joints.items()},
        hand=hand,
        ground=tuple(ground),
        kinds={str(joint): kinds[joint] for joint in joints},
    )
    places = {name: sp.Matrix(list(map(sp.sympify, at))) for name, at in points.items()}
    function = d.function(
        "skeleton",
        "Points of the mechanism in the base frame.",
        {**(pose or {}), "q": d.actuated if inputs is None else tuple(inputs)},
        {"points": sp.Matrix([list(at) for at in places.values()])},
        program=program,
        branches=branches,
        notes=notes,
    )
    d.skeleton = drawn
    position = "the given position" if pose else "the position of the forward map"
    own, rest = dict(lengths or {}), dict(closing or {})
    pairs = list(dict.fromkeys([*_segments(drawn), *own]))
    equal: list[tuple[Any, Any]] = []
    distances: dict[sp.Expr, list[tuple[str, str]]] = {}
    bounds: list[sp.Expr] = []
    for at, limits, held in _cases(function, tuple(places), pairs, at_posture):
        bounds += [b for b in limits if b not in bounds]
        for pair in held:
            gap = at[pair[1]] - at[pair[0]]
            square = gap.dot(gap)
            length = own.get(pair)
            if length is None:
                length = sp.sqrt(sp.factor(_still(square, function)))
            equal.append((square, sp.expand(length**2) + rest.get(pair, 0)))
            if pair not in distances.setdefault(length, []):
                distances[length].append(pair)
        if hand_at is not None and hand in at:
            equal.append((at[hand], sp.Matrix(list(hand_at))))
    closed = (
        "  For a rod that closes a loop, this follows from the equation of the loop."
        if rest
        else ""
    )
    d.step(
        "Skeleton",
        f"The links are drawn through these points.  {_placed(drawn)}  No link changes its length "
        f"when the joints move, and the hand is at {position}.{closed}",
        {},
        rows=[
            ("Link", "Points", "Distance"),
            *(
                (
                    _links_of(drawn, ends),
                    ", ".join(" to ".join(map(_spoken, e)) for e in ends),
                    size,
                )
                for size, ends in distances.items()
            ),
        ],
        proves=(
            "The squared distance of each pair of neighbouring points is the square of the length"
            f"{', plus the equation of the loop for a rod that closes it' if rest else ''}, and "
            f"the hand is at {position}."
        ),
        equal=equal,
        nonnegative=bounds,
    )


def _spoken(point: str) -> str:
    """The name of a point in words: ``corner 1`` for ``corner1``."""
    return re.sub(r"(?<=[a-z]{2})(?=\d)", " ", point.replace("_", " "))


def _between(pair: tuple[str, str]) -> str:
    return " to ".join(map(_spoken, pair))


def _placed(drawn: Skeleton) -> str:
    """Which points are on the base, where the joints are, and which point is the hand."""
    ground = [_spoken(p) for p in drawn.ground if p != "base"]
    at: dict[str, list[str]] = {}
    for joint, points in drawn.joints.items():
        first, last = _spoken(points[0]), _spoken(points[-1])
        slides = drawn.kinds[joint] == "prismatic"
        line = f"from {first} to {last}" if slides else f"on the line of {first} and {last}"
        at.setdefault(line if len(points) > 1 else f"at {first}", []).append(joint)
    joints = listed([f"{listed(names)} {place}" for place, names in at.items()])
    hand = "" if drawn.hand == "hand" else f"; the hand is at {_spoken(drawn.hand)}"
    s = "s" * (len(ground) > 1)
    fixed = f"The base has the point{s} {listed(ground)}.  " if ground else ""
    return f"{fixed}The joints are {joints}{hand}."


def _links_of(drawn: Skeleton, pairs: Iterable[tuple[str, str]]) -> str:
    """The links and the joints that lead from point to point: ``crank 1, 2, 3``."""
    found: dict[str, list[str]] = {}
    for pair in pairs:
        links = [name for name, link in drawn.links.items() if pair in {*pairwise(link)}]
        for name in links or [joint for joint, at in drawn.joints.items() if at == pair]:
            word, _, number = _spoken(name).partition(" ")
            numbers = found.setdefault(word if links else name, [])
            if links and number not in numbers and word != "hand":
                numbers.append(number)
    return "; ".join(
        f"{word} {', '.join(numbers)}".rstrip() if len(found) == 1 and len(numbers) <= FEW else word
        for word, numbers in found.items()
    )


def _segments(drawn: Skeleton) -> list[tuple[str, str]]:
    """Neighbouring points of each link, which keep their distance."""
    return list(dict.fromkeys(pair for link in drawn.links.values() for pair in pairwise(link)))


def _cases(
    function: Function,
    names: Sequence[str],
    pairs: Sequence[tuple[str, str]],
    at_posture: Sequence[Mapping[str, Sequence[Any]]],
) -> Iterator[tuple[dict[str, sp.Matrix], tuple[sp.Expr, ...], list[tuple[str, str]]]]:
    """Points in joints and parameters, what is not negative there, and the distances to prove."""
    for k, given in enumerate(at_posture):
        at = {name: sp.Matrix(list(place)) for name, place in given.items()}
        later = at_posture[k + 1 :]
        held = [p for p in pairs if set(p) <= set(at) and not any(set(p) <= set(x) for x in later)]
        yield at, (), held
    if at_posture:
        return
    entries = [e for a in function.outputs for e in a.entries]
    for _, signs in function.cases():
        found, limits = function.explicit(entries, signs)
        at = {name: sp.Matrix(found[3 * k : 3 * k + 3]) for k, name in enumerate(names)}
        yield at, limits, list(pairs)


def _still(square: sp.Expr, function: Function) -> sp.Expr:
    """A squared distance that does not depend on the inputs, from one posture."""
    return normal(square.subs(dict.fromkeys(function.symbols, 0)))


def serial_skeleton(
    d: Derivation,
    groups: Sequence[Group],
    joints: Sequence[sp.Symbol],
    lead: sp.Matrix,
    last: sp.Matrix,
) -> dict[str, Any]:
    """The arguments of :func:`skeleton` for a serial chain.

    Each joint is at a point of its axis.  A link leads along the axis first and then across to the
    next one; axes that meet share their point.
    """
    drawing = _Serial(d.program(), lead)
    remaining = iter(enumerate(joints, 1))
    for k, group in enumerate(groups):
        local = sp.zeros(3, 1)
        for i, row in enumerate(group.rows):
            number, joint = next(remaining)
            x, y, z = row.shift
            corner = local + sp.Matrix([0, 0, z])
            across = rotation("z", group.angle(0, i + 1)) * sp.Matrix([x, y, 0])
            local = corner + across
            span = sp.sqrt(sp.factor(sp.expand(x**2 + y**2)))
            drawing.add(number, joint, row.slides, (corner, z), (local, span))
        drawing.go_on(k, group, is_last=k == len(groups) - 1 and last[:3, 3].is_zero_matrix)
    shift = sp.Matrix(last[:3, 3])
    if not shift.is_zero_matrix:
        drawing.extend(shift)
    return drawing.arguments(d)


class _Serial:
    """Collects points and links along a chain, in the names of a program."""

    def __init__(self, program: Program, lead: sp.Matrix):
        self.program = program
        self.turn, self.origin = sp.Matrix(lead[:3, :3]), sp.Matrix(lead[:3, 3])
        self.points: dict[str, sp.Matrix] = {"base": sp.zeros(3, 1)}
        self.links: dict[str, list[str]] = {}
        self.joints: dict[sp.Symbol, tuple[str, ...]] = {}
        self.lengths: dict[tuple[str, str], sp.Expr] = {}
        self.here = "base"
        self.link = "ground"
        self._to("joint1", self.origin, sp.sqrt(sp.factor(self.origin.dot(self.origin))))

    def add(
        self,
        number: int,
        joint: sp.Symbol,
        slides: bool,
        corner: tuple[sp.Matrix, sp.Expr],
        end: tuple[sp.Matrix, sp.Expr],
    ) -> None:
        """A joint and the link after it: along its axis to the corner, then across to the end."""
        before, self.link = self.here, f"link{number}"
        (foot, along), (to, across) = corner, end
        if slides:
            self.points[f"slide{number}"] = self._place(foot)
            self.here = f"slide{number}"
            self.joints[joint] = (before, self.here)
        else:
            self.joints[joint] = (before,)
            name = f"joint{number + 1}" if across == 0 else f"corner{number}"
            self._to(name, self._place(foot), along)
        self._to(f"joint{number + 1}", self._place(to), across)

    def go_on(self, k: int, group: Group, *, is_last: bool) -> None:
        """Move to the frame where a group ends."""
        if not is_last:
            self.origin = self.program.matrix(f"p{k + 1}", self._place(group.span(0)))
            self.turn = self.program.matrix(f"R{k + 1}", self.turn * group.rotation)

    def extend(self, shift: sp.Matrix) -> None:
        """The tool, at a constant place in the last frame."""
        self._to("tool", self._place(shift), sp.sqrt(sp.factor(shift.dot(shift))))

    def arguments(self, d: Derivation) -> dict[str, Any]:
        if self.here == f"joint{len(self.joints) + 1}":
            self._rename(self.here, "tool")
        return {
            "points": self.points,
            "links": {name: tuple(link) for name, link in self.links.items()},
            "joints": self.joints,
            "hand": self.here,
            "lengths": self.lengths,
            "inputs": tuple(joint for joint in self.joints if joint in d.actuated),
            "program": self.program,
            "ground": tuple(self.links.get("ground", ("base",))),
        }

    def _to(self, name: str, at: sp.Matrix, length: sp.Expr) -> None:
        """Continue the link to a point, unless it is already there."""
        if length == 0:
            return
        self.points[name] = at
        self.links.setdefault(self.link, [self.here]).append(name)
        self.lengths[self.here, name] = length
        self.here = name

    def _place(self, local: sp.Matrix) -> sp.Matrix:
        return self.origin + self.turn * local

    def _rename(self, old: str, new: str) -> None:
        self.points = {new if n == old else n: at for n, at in self.points.items()}
        self.links = {
            name: [new if n == old else n for n in link] for name, link in self.links.items()
        }
        self.lengths = {
            (new if a == old else a, new if b == old else b): e
            for (a, b), e in self.lengths.items()
        }
        self.here = new
