"""Proposes the chain for the joints of a wrist, whose axes meet at any angles.

Three axes that meet in a point reach every direction if neighbours are at right angles, and are
then those of Euler's angles.  Otherwise the angle between the first and the last axis gives the
middle joint, and two rotations of vectors give the others.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from closedform.mechanics.arm import Group, Row
from closedform.scaffold.chains.chainlinks import Single, parallel
from closedform.scaffold.chains.maker import FLIP, SIDE, Maker, Z, times, turning
from closedform.scaffold.source import source

ELBOW = "{+1: 'up', -1: 'down'}"
"""A branch of a joint that a distance determines is an elbow."""


@dataclass(frozen=True)
class Carried:
    """Two links of some ``lengths`` reach a ``point`` less an ``offset``, which a wrist turns.

    They are as they are written.  The offset may contain ``{}``, for the pair of the middle joint.
    """

    point: str
    offset: str
    lengths: Sequence[str]
    offset_at: sp.Matrix
    """The entries of the offset; those of ``to_end`` if it depends on a pair."""

    @property
    def moves(self) -> bool:
        """Whether the offset depends on the middle joint."""
        return "{}" in self.offset


@dataclass
class WristMaker(Maker):
    """Writes the lines that turn single joints, and those of a wrist."""

    unknowns: dict[int, str] = field(default_factory=dict)
    lifted: str = ""
    """The pair of the first joint of a wrist."""
    more: str = ""
    """Further arguments of the lemma of a wrist, besides its angles."""
    carried: Carried | None = None
    """What a wrist of any angles carries, if two links have to reach it."""
    before_middle: str = ""
    """The goal of the middle joint of a wrist of any angles, if no two links have to reach it."""
    tilted: dict[int, tuple[str, sp.Expr]] = field(default_factory=dict)
    """Of the middle joint of a wrist of equal angles: the unknown, and what it is ahead of it."""

    def vector(self, name: str, value: str, label: str = "") -> None:
        """Name a vector, by default by the name of the variable."""
        self.add(f"{name} = ik.vector('{label or name}', {value})")

    def _turn(
        self,
        joint: Single,
        sides: tuple[Any, Any, Any],
        toward: str = "",
        *,
        scale: str = "",
        by_size: bool = False,
        choice: str = "",
    ) -> str:
        name, pair = self.unknown(joint), f"pair{joint.number}"
        per = "/ik.size" if by_size else ""
        shown = ", ".join(f"({source(e)}){per}" if per and e != 0 else source(e) for e in sides)
        more = (f", toward={toward}" if toward else "") + (f", scale={scale}" if scale else "")
        self.solve(
            "turn", f"{name}, ({shown}), {choice or (ELBOW if by_size else SIDE)}{more}", pair, 2
        )
        self.levers.append(f"{pair}.lever/ik.size")
        self.solved_as[joint.number] = (name, pair, sp.S.Zero)
        return pair

    def within_reach(self, vector: str, beside: Any, reach: str) -> None:
        """Name the goal that a turn's third coordinate differs from ``beside`` by the reach."""
        less = f" - ({source(beside)})" if beside != 0 else ""
        self.add(f"seen_across = CoordinateWithin(lambda pair: ({vector})[2]{less}, {reach})")

    def ahead_of_turn(self, vector: str, w: sp.Matrix, tilt: Any) -> None:
        """Name the goal that two turns can bring a vector as long as ``w`` to it.

        The axes of the turns meet at the angle whose cosine is ``tilt``.
        """
        lengths = ((1 - tilt**2), w[0] ** 2 + w[1] ** 2)
        reach = sp.sqrt(sp.Mul(*map(sp.simplify, lengths)))
        self.within_reach(vector, tilt * w[2], source(reach))

    def _rotate(
        self, joint: Single, w: str, v: str, because: str = "", *, scale: str = "", more: str = ""
    ) -> str:
        name, pair = self.unknown(joint), f"pair{joint.number}"
        more += (f", because={because}" if because else "") + (f", scale={scale}" if scale else "")
        self.solve("rotate", f"{name}, {w}, {v}{more}", pair)
        self.levers.append(f"sqrt(({v})[0]**2 + ({v})[1]**2)/ik.size")
        self.solved_as[joint.number] = (name, pair, sp.S.Zero)
        return pair

    def unknown(self, joint: Single) -> str:
        """The angle of a joint as it turns the frame; its name is kept for later equations."""
        if joint.number not in self.unknowns:
            self.unknowns[joint.number] = self.angle(joint.turn)
        return self.unknowns[joint.number]

    # The joints that turn the tool

    def orientation(self, joints: Sequence[Single], M: str) -> None:
        """Solve the joints for the rotation that the others leave to them."""
        if len(joints) == 3:
            self._wrist(joints, M)
            return
        if len(joints) == 2:
            first, last = joints
            self.require(
                not parallel(first),
                f"axes {first.number} and {last.number} are parallel",
                "The axes of the last two joints must not be parallel.",
            )
            w = source((first.end * Z)[:2, 0])
            pair = self._rotate(first, w, f"{M}[:, 2]", scale="1")
            inside = times(first.end.T, f"(turned({pair}).T * {M})")
            self.add(f"R_rest = ik.matrix('R_rest', {inside})")
            M = "R_rest"
        self._rotate(joints[-1], "(1, 0)", f"{M}[:, 0]", scale="1")

    def _wrist(self, joints: Sequence[Single], M: str) -> None:
        first, middle, last = joints
        if is_normal(joints):
            self.normal_wrist(joints, M, self.more)
            return
        self.wrist_about(first, middle, last, M, "")

    def normal_wrist(
        self, joints: Sequence[Single], M: str, more: str = "", choice: str = FLIP
    ) -> None:
        """Solve three joints, neighbours at right angles, for the rotation that is left to them."""
        groups = [Group((Row(1, j.turn, (sp.S.Zero,) * 3, False),), j.end) for j in joints]
        groups[-1] = Group(groups[-1].rows, sp.eye(3))
        numbers = [j.number for j in joints]
        turn = joints[0].turn
        pair, epsilon = self.wrist(
            turn, groups, M, sp.eye(3), numbers=numbers, more=more, choice=choice
        )
        self.lifted = self._less_by_angle(pair, epsilon)

    def _less_by_angle(self, pair: str, epsilon: sp.Expr) -> str:
        """The pair of an angle without the constant that was added to it."""
        if epsilon == 0:
            return pair
        sine, cosine = source(sp.sin(-epsilon)), source(sp.cos(epsilon))
        return f"({pair} + Pair({sine}, {cosine}))"

    def wrist_about(
        self, first: Single, middle: Single, last: Single, M: str, onward: str = ""
    ) -> None:
        """Solve three joints whose axes have any angle for the rotation that is left to them.

        ``onward`` is the rotation after the first joint, if it is not a constant.
        """
        self.add(f"M = ik.matrix('M_wrist', {M})")
        if onward:
            self.add(f"R_between = ik.matrix('R_between', {onward})")
        between = "R_between" if onward else source(first.end)
        w, (x, sense) = middle.end * Z, self.middle(first, middle, onward)
        past = self._past_turn(f"{between} * turned({{}}) * {source(w)}", middle)
        if sense:
            pair = self._tilt(first, middle, past)
        elif not onward and _has_parameters(first, middle):
            pair = f"pair{middle.number}"
            axes = f"({source(first.end.T * Z)}, {source(w)})"
            more = f", toward={past}" if past else ""
            self.solve("tilt_between", f"{x}, {axes}, M[:, 2], {FLIP}{more}", pair, 2)
        else:
            row = [sp.Symbol(f"R_between[2, {i}]") for i in range(3)]
            g = sp.Matrix(row) if onward else first.end.T * Z
            a, b = (sp.expand(e) for e in turning(w, g))
            c = sp.Symbol("M[2, 2]") - sp.expand(g[2] * w[2])
            scale = "1" if onward else source(_least_tilt(first.end.T * Z, w))
            pair = self._turn(middle, (a, b, c), past, scale=scale, choice=FLIP)
        if self.carried and self.carried.moves:
            self.vector("to_end", self.carried.offset.format(pair))
        of = "" if sense > 0 else "-"
        self.around((first, middle, last), between, pair, lambda e: f"{x}: {of}{e}")
        if onward:  # the outer axes may be nearly in line, where a cosine says little of the tilt
            self.add(f"ik.program.match({self.aside}, ik.size, 'the wrist tilts as far')")

    aside = "ik.size*(sqrt(axis[0]**2 + axis[1]**2) - sqrt(M[0, 2]**2 + M[1, 2]**2))"
    """By how much the last axis of a wrist seems to be farther aside than the target has it."""

    def around(
        self,
        joints: Sequence[Single],
        between: str,
        pair: str,
        level: Callable[[str], str],
    ) -> None:
        """Solve the first and the last of three joints for the rotation ``M``.

        The ``pair`` of the middle one is known, and so is the rotation ``between`` the first two.
        ``level`` writes why a multiple of ``M[2, 2] - axis[2]`` vanishes, with the sign of a tilt.
        """
        first, middle, last = joints
        self.vector("axis", f"{between} * turned({pair}) * {source(middle.end * Z)}")
        because = f"{{{level('(M[2, 2] + axis[2])')}}}"
        lifted = self._rotate(first, "axis", "M[:, 2]", because, scale="16", more=self._free())
        self.add(f"R_last = turned({lifted}) * {between} * turned({pair}) * {source(middle.end)}")
        self.add("R_rest = ik.matrix('R_rest', R_last.T * M)")
        lift = self.unknown(first)
        each = (
            f"{{{lift}: (-R_last[0, k], -R_last[1, k]), {level('R_last[2, k]')}}} for k in (0, 1)"
        )
        self.solve("spin", f"{self.unknown(last)}, R_rest, [{each}]", f"pair{last.number}")
        self.lifted = lifted

    def _past_turn(self, last: str, middle: Single) -> str:
        """The goal of the middle turn, which moves the ``last`` axis, if links are reached after.

        The target of the axis is that of ``M``.
        """
        if self.carried is None:
            return self.before_middle
        pair = self.untilted(middle, "pair")
        offset = self.carried.offset.format(pair) if self.carried.moves else self.carried.offset
        moved = f"offset=lambda pair: {offset}, last=lambda pair: {last.format(pair)}"
        point, lengths = self.carried.point, ", ".join(self.carried.lengths)
        self.add(f"past = LinksPastTurn(lambda _: {point}, {lengths}, axis=M[:, 2], {moved})")
        return "past"

    def _free(self) -> str:
        """The argument that keeps the first turn within reach where the target leaves it free."""
        if self.carried is None:
            return self.more
        (x, y, _), q = self.carried.offset_at, self.carried.point
        if x == y == 0:
            return ""
        offset = f"({source(x)}, {source(y)})"
        arguments = f"({q}[0], {q}[1]), ({', '.join(self.carried.lengths)}), {offset}"
        self.add(f"reaching = Reaching.turning(ik, {arguments}, lever=ik.size)")
        return ", reaching=reaching"

    def middle(self, first: Single, middle: Single, onward: str = "") -> tuple[str, int]:
        """The unknown of the middle joint of a wrist, and its sense.

        If the first and the last axis can point the same way (1) or opposite ways (-1), it is zero
        there.  In general (0) it is the angle of the joint.
        """
        g, w = first.end.T * Z, middle.end * Z
        sense = 0
        if not onward:
            sense = next((k for k in (1, -1) if sp.simplify(g[2] - k * w[2]) == 0), 0)
        if not sense:
            return self.unknown(middle), 0
        if middle.number not in self.tilted:
            a, b = (sp.simplify(e) for e in turning(w, g))
            k = sp.simplify(1 - g[2] ** 2)
            if a == 0 and sp.simplify(b - k) == 0:
                ahead = sp.S.Zero
            elif a == 0 and sp.simplify(b + k) == 0:
                ahead = sp.pi
            else:
                ahead = sp.atan2(a, b)
            ahead -= sp.pi if sense < 0 else 0
            self.tilted[middle.number] = self.angle(middle.turn - ahead), -ahead
        return self.tilted[middle.number][0], sense

    def untilted(self, middle: Single, pair: str) -> str:
        """The pair of the middle joint of a wrist from that of its unknown."""
        if middle.number not in self.tilted:
            return pair
        _, ahead = self.tilted[middle.number]
        return self._less_by_angle(pair, ahead)

    def _tilt(self, first: Single, middle: Single, past: str) -> str:
        """Solve the middle joint of a wrist of equal angles."""
        x, sense = self.middle(first, middle)
        name, pair = f"tilted{middle.number}", f"pair{middle.number}"
        more = (", sense=-1" if sense < 0 else "") + (f", toward={past}" if past else "")
        k = sp.simplify(1 - (first.end.T * Z)[2] ** 2)
        self.solve("tilt", f"{x}, {source(k)}, M[:, 2], {FLIP}{more}", name, 2)
        self.add(f"{pair} = {self.untilted(middle, name)}")
        return pair


def _has_parameters(first: Single, middle: Single) -> bool:
    """Whether the angles of a wrist are parameters, which may be equal."""
    return bool((first.end.T * Z).free_symbols | (middle.end * Z).free_symbols)


def _least_tilt(g: sp.Matrix, w: sp.Matrix) -> sp.Expr:
    """Half the sine of the least tilt of a wrist, or of the most: a cosine says that much of it.

    What is clamped stays well within the round trip that is promised.  The unit vectors ``g`` and
    ``w`` are the first and the last axis, seen from the middle joint.
    """
    aside = [sp.sqrt(v[0] ** 2 + v[1] ** 2) for v in (g, w)]
    sines = [sp.Abs(sp.expand(aside[0] * w[2] + k * g[2] * aside[1])) for k in (-1, 1)]
    return sp.Min(*sines) / 2


def is_normal(wrist: Sequence[Single]) -> bool:
    """Whether the neighbours among three axes are at right angles."""
    return all(sp.simplify((j.end * Z)[2]) == 0 for j in wrist[:2])


__all__ = ["ELBOW", "Carried", "WristMaker", "is_normal"]
