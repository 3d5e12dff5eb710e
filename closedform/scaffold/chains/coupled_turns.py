"""Writes the chain of parallel axes of which one motor turns several, as a belt does.

Wafer robots and fingers are of this kind.  Seen along the axes each link turns by the angle of the
first joint, plus a multiple of that of the motor.  The sums of the links with one multiple are what
counts.  If there are

- two, and their multiples differ by 1: they are two links;
- two whose multiples differ by 2, or three in steps of 1: the outer two turn against each other,
  seen from the direction between them (``opposite_links``), unless they are equally long: then they
  reach along that direction, together with the one between them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.mechanics.arm import Group
from closedform.mechanics.frames import rotation
from closedform.model.names import listed
from closedform.scaffold.chains.known import KnownMaker
from closedform.scaffold.chains.maker import Z, heading, norm, simple
from closedform.scaffold.chains.proposal import NoChainError
from closedform.scaffold.chains.slides import REACH
from closedform.scaffold.chains.wrists import ELBOW
from closedform.scaffold.source import source

NEEDED = (
    "Known are arms with axes along z that reach x and y by a joint of its own and, after it, "
    "joints that one motor turns about parallel axes: also with a slide along them, with a last "
    "joint that turns the hand, or after a turret, there also before a spherical wrist."
)


@dataclass(frozen=True)
class Fan:
    """Links of a plane: at the angle ``base`` plus each multiple of ``motor``, a vector."""

    base: sp.Expr
    motor: sp.Symbol
    vectors: Mapping[int, sp.Matrix]

    @property
    def steps(self) -> tuple[int, ...]:
        return tuple(sorted(self.vectors))

    @property
    def degree(self) -> int:
        """That of the equation of the motor."""
        return self.steps[-1] - self.steps[0]


class CoupledMaker(KnownMaker):
    """Writes the lines for arms whose joints follow others."""

    turned: tuple[tuple[sp.Expr, str], ...] = ()
    """The two angles that were solved last, and their pairs."""

    def coupled(self) -> str:
        task, groups = self.arm.coordinates(), self.arm.groups
        names = task.names if task else ()
        if len(groups) == 1 and names[:2] == ("x", "y"):
            return self._flat(groups[0], names)
        if names == ("x", "y", "z") or (not names and len(self.arm.joints) == 6):
            return self.whole()
        raise self._other(groups)

    def _other(self, groups: Sequence[Group]) -> NoChainError:
        """Why an arm with such axes has no chain."""
        kinds = ["".join("P" if row.slides else "R" for row in g.rows) for g in groups]
        followers = [q.name for q in self.arm.axes if q not in self.arm.joints]
        carry = " that carry its wrist" * (len(self.arm.groups) > len(groups))
        return NoChainError(
            f"{listed(followers)} {'follows' if len(followers) == 1 else 'follow'} other joints, "
            f"and the axes{carry} are {' | '.join(kinds)} (R turns, P slides, | where the "
            f"direction changes)",
            NEEDED,
        )

    def _flat(self, group: Group, names: Sequence[str]) -> str:
        """Solve an arm with parallel axes, with or without a slide or a yaw."""
        self._require_z("its first axis is not parallel to the z axis of the base")
        turns = [i for i, row in enumerate(group.rows) if not row.slides]
        vectors = self.links(group, turns)
        self._tool(group, vectors)
        joints = [group.rows[i].turn for i in turns]
        self.add(f"{', '.join(names)} = ik.x")
        if "yaw" not in names:
            self._reach(self._fan(joints, vectors), *self._less_by(self.arm.lead[:2, 3]))
            self._lift(group.rows)
            return TURNS + ", with a slide" * ("z" in names)
        before = {s for e in joints[:-1] for s in e.free_symbols}
        self.require(
            joints[-1].free_symbols - before,
            "its last joint has no motor of its own",
            "A hand whose yaw is a target needs one.",
        )
        hand = self._hand(joints, vectors[-1])
        at = self._less_by(self.arm.lead[:2, 3] + hand)
        self._reach(self._fan(joints[:-1], vectors[:-1]), *at)
        self._lift(group.rows)
        self._remaining_yaw(joints[-1])
        return f"{TURNS} and a yaw" + ", with a slide" * ("z" in names)

    def _position(self, groups: Sequence[Group]) -> tuple[str, list[str]]:
        """Solve a turret and coupled joints in its plane, which carry the point ``p``."""
        if len(groups) != 2 or [row.slides for g in groups for row in g.rows].count(True):
            raise self._other(groups)
        base, second = groups
        self.require(len(base.rows) == 1, "its first two axes are parallel", NEEDED)
        self.require_normal((base.end * Z)[2], 1, 2)
        self.require(
            sp.simplify(sum((row.shift[2] for row in second.rows), sp.S.Zero)) == 0,
            "its tool or wrist is beside the plane through axis 1 in which the coupled joints move",
            "The known chains of a turret and coupled joints need it in this plane.",
        )
        turns = [row.turn for row in second.rows]
        fan = self._fan(turns, self.links(second, range(len(turns))))
        first = self._turn_base(base, sp.S.Zero)
        self._reach(fan, "q[0]", "q[1]")
        structure = f"turret and {TURNS}"
        alone = self.arm.coordinates() is not None
        return structure, [first, "" if alone else self._sum(sp.Add(*turns))]

    def _sum(self, total: sp.Expr) -> str:
        """The pair of a sum of turns, by the two angles that were solved."""
        (one, a), (two, b) = self.turned
        for factor, text in ((0, a), (1, f"({a} + {b})"), (-1, f"({a} - {b})")):
            ahead = sp.expand(total - one - factor * two)
            if ahead.free_symbols & {*self.arm.joints}:
                continue
            if ahead != 0:
                text = f"({text} + Pair{source((sp.sin(ahead), sp.cos(ahead)))})"
            if text == a:
                return a
            self.add(f"turn2 = {text}.known_as(ik.program, '_turn2')")
            return "turn2"
        raise NoChainError(
            f"its wrist turns by {total}, and links by {one} and by {two} more or less",
            "The axes of the wrist have to turn as the last link does.",
        )

    def _fan(self, joints: Sequence[sp.Expr], vectors: Sequence[sp.Matrix]) -> Fan:
        """The links by the multiples of the motor; each turns with the other joint."""
        angles = [sp.Add(*joints[: k + 1]) for k in range(len(joints))]
        moved = [q for q in self.arm.joints if any(e.has(q) for e in angles)]
        rates = {q: {e.diff(q) for e in angles} for q in moved}
        whole = [q for q in moved if rates[q] in ({1}, {-1})]
        self.require(
            len(moved) == 2 and whole,
            f"{len(moved)} motors turn its parallel links, and {len(whole) or 'none'} of these "
            f"turns all of them",
            "A point of a plane needs two motors, of which the first turns all links.",
        )
        base, motor = whole[0], next(q for q in moved if q != whole[0])
        at_zero, found = dict.fromkeys(moved, sp.S.Zero), dict[int, sp.Matrix]()
        for angle, vector in zip(angles, vectors, strict=True):
            step, ahead = int(angle.diff(motor)), rotation("z", angle.xreplace(at_zero))
            turned = (ahead * sp.Matrix([*vector, 0]))[:2, 0]
            found[step] = simple(found.get(step, sp.zeros(2, 1)) + turned)
        left = {n: v for n, v in found.items() if not v.is_zero_matrix}
        return Fan(angles[0].diff(base) * base, motor, left)

    def _reach(self, fan: Fan, x: str, y: str) -> None:
        """Solve the two motors of a fan, whose end is at x, y."""
        steps, v = fan.steps, fan.vectors
        if len(steps) == 2 and fan.degree == 1:
            turn = fan.base + steps[0] * fan.motor
            one, other = (heading(v[n]) for n in steps)
            self.two_links((turn, fan.motor), [v[n] for n in steps], x, y, alone=x == "x")
            found = turn + one, fan.motor + other - one
            self.turned = tuple(zip(found, self.pairs, strict=True))
            return
        self.require(
            fan.degree == 2,
            f"seen from its first joint, its links turn by {listed([str(n) for n in steps])} times "
            f"the angle of {fan.motor}, which gives an equation of degree {fan.degree}",
            "Known are links whose multiples differ by 2 at most.",
        )
        low, high = steps[0], steps[-1]
        half = (heading(v[high]) + heading(v[low])) / 2
        turn = fan.base + (low + 1) * fan.motor + half
        opposite = fan.motor + (heading(v[high]) - heading(v[low])) / 2
        middle = v.get(low + 1, sp.zeros(2, 1))
        ahead, aside, _ = simple(rotation("z", -half) * sp.Matrix([*middle, 0]))
        if ahead.could_extract_minus_sign():
            ahead, aside, turn, opposite = -ahead, -aside, turn + sp.pi, opposite + sp.pi
        angles, lengths = (self.angle(turn), self.angle(opposite)), (norm(v[high]), norm(v[low]))
        self.turned = (turn, f"{angles[0]}_"), (opposite, f"{angles[1]}_")
        if sp.simplify(lengths[0] - lengths[1]) != 0:
            self._against(angles, lengths, (ahead, aside), (x, y))
        elif aside == 0:
            self._along(angles, ahead + 2 * lengths[0] * sp.cos(opposite), (x, y))
        else:
            self._beside(angles, 2 * lengths[0], (ahead, aside), (x, y))

    def _along(self, angles: tuple[str, str], reach: sp.Expr, at: tuple[str, str]) -> None:
        """Solve links that reach along the direction between the two that turn apart."""
        (a, b), (x, y) = angles, at
        (cosine,) = reach.atoms(sp.cos)
        length, rest = reach.coeff(cosine), reach.xreplace({cosine: sp.S.Zero})
        self.add(f"rho = ik.length('rho', {source(reach)})")
        self.solve("polar", f"{a}, rho, ({x}, {y}), {REACH}", f"{a}_, rho_", 2)
        sides = f"(0, {source(length)}, {source(sp.Symbol('rho_') - rest)})"
        self.solve("turn", f"{b}, {sides}, {ELBOW}", f"{b}_", 2)

    def _beside(
        self, angles: tuple[str, str], reach: sp.Expr, offset: tuple[Any, Any], at: tuple[str, str]
    ) -> None:
        """The same with a link between them that leads aside."""
        (a, b), (ahead, aside), (x, y) = angles, offset, at
        seen = f"(turned(pair).T * Matrix([{x}, {y}, 0]))[0]"
        less = f" - ({source(ahead)})" if ahead != 0 else ""
        self.add(f"along = CoordinateWithin(lambda pair: {seen}{less}, {source(reach)})")
        sides = f"({x}, -{y}, {source(-aside)})"
        self.solve("turn", f"{a}, {sides}, {REACH}, toward=along", f"{a}_", 2)
        sides = f"(0, {source(reach)}, {source(sp.Symbol(f'{a}_.ahead') - ahead)})"
        self.solve("turn", f"{b}, {sides}, {ELBOW}", f"{b}_", 2)

    def _against(
        self,
        angles: tuple[str, str],
        lengths: tuple[Any, Any],
        offset: tuple[Any, Any],
        at: tuple[str, str],
    ) -> None:
        """Solve links that turn against each other, seen from the direction between them."""
        (a, b), (x, y) = angles, at
        one, two = (self.length_of(f"link{i}", e) for i, e in enumerate(lengths, 1))
        along, aside = f"({one} + {two})*{b}_.c", f"({one} - {two})*{b}_.s"
        self.add(f"radius = ik.let('radius', sqrt({x}**2 + {y}**2))")
        if offset[1] == 0:
            h = "0" if offset[0] == 0 else self.length_of("link3", offset[0])
            arguments = f"({one}, {two}, {h}), radius, ({REACH}, {ELBOW})"
            self.solve("opposite_links", f"{b}, {arguments}", f"{b}_", 4)
            end = f"{along} + {h}" if h != "0" else along, aside
        else:
            self.add(f"centre = {source(sp.Matrix(offset))}")
            self.add(f"along, aside = Matrix([{one} + {two}, 0]), Matrix([0, {one} - {two}])")
            self.by_quartic(b, (f"2*{one}*{two}", "0"), "radius", f"{b}_")
            self.add(f"on_ellipse = ik.vector('end', centre + Matrix([{along}, {aside}]))")
            miss = "ik.let('at_end', sqrt(on_ellipse[0]**2 + on_ellipse[1]**2)) - radius"
            self.add(f"ik.program.match({miss}, ik.size/2, 'the point is one of the arm')")
            end = "on_ellipse[0]", "on_ellipse[1]"
        self.solve("rotate", f"{a}, ({', '.join(end)}), ({x}, {y}), because={{{b}: 1}}", f"{a}_")


TURNS = "parallel joints of which one motor turns several"


__all__ = ["CoupledMaker"]
