"""Keeps the last axis of an arm within the limits of its wrist, near singular joints.

A wrist whose neighbouring axes are not at right angles does not reach every direction.  Where the
joints that carry it are singular, a joint is free, or a rounding error of the target turns the
joints by a multiple of that error.  The direction that remains for the wrist may then lie beyond
its limit, although a posture reaches the target.  The target does not distinguish some turns of
these joints; of these, one is taken that brings the direction within the limits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations

import sympy as sp

from closedform.lemmas.chain import Chain
from closedform.lemmas.links import turned
from closedform.model.functions import choose, sign_of
from closedform.model.lemma import label
from closedform.model.pair import Pair
from closedform.model.tolerances import ROUNDING

SHORT = sp.Rational(1, 2**8)
"""A lever below this fraction of its scale is short.

A longer one amplifies rounding errors too little to matter for the tolerance of the wrist.
"""


@dataclass(frozen=True)
class Carrying:
    """A joint that carries the wrist: ``Rz(unknown)``, then the ``shift`` and the rotation ``end``.

    ``pair`` is that of the unknown.
    """

    unknown: sp.Symbol
    pair: Pair
    shift: sp.Matrix
    end: sp.Matrix


def within_tilt(
    chain: Chain,
    joints: Sequence[Carrying],
    p: sp.Matrix,
    *,
    tool: sp.Matrix,
    limits: tuple[sp.Expr, sp.Expr],
    levers: Sequence[sp.Expr],
) -> list[Pair]:
    """The pairs of joints that carry a wrist to ``p``, turned so that it can point its last axis.

    They are turned only so far that the position changes by no more than rounding.  First, all of
    them turn together, in the direction that moves the wrist least; then one alone, whose axis is
    nearest to it.

    Parameters
    ----------
    chain
        the chain, which has solved the joints
    joints
        those before the wrist
    p
        the position of the wrist
    tool
        the direction of its last axis
    limits
        the least and the greatest component of ``tool`` along the first axis of the wrist
    levers
        the joints are turned only if one of these, in units of its scale, is short
    """
    p, tool = chain.vector("wrist_at", p), chain.vector("tool_axis", tool)
    seen = _Posture(chain=chain, joints=tuple(joints), p=p, tool=tool, limits=limits, name="tilt0")
    loose = chain.program.vanishes(
        "loose_wrist",
        sp.Max(seen.margin, sp.Min(*map(sp.Abs, levers)) - SHORT),
        sp.S.One,
        "the joints before the wrist are nearly free, and it does not tilt as far",
    )
    chain.notes.append(
        "SINGULAR: a free joint before the wrist gets its usual value, or the nearest one with "
        "which the wrist tilts as far as the target requires."
    )
    near = seen.turned(seen.together(), "tilt1")
    near = near.turned(near.alone(), "tilt2")
    found = []
    for joint, other in zip(joints, near.joints, strict=True):
        pair = Pair(
            choose(loose, other.pair.s, joint.pair.s), choose(loose, other.pair.c, joint.pair.c)
        ).known_as(chain.program, f"_kept{label(joint.unknown)}")
        chain.meaning |= {pair.s: sp.sin(joint.unknown), pair.c: sp.cos(joint.unknown)}
        chain.values[joint.unknown] = pair.angle
        found.append(pair)
    return found


@dataclass(frozen=True)
class _Posture:
    """The joints at some angles, and the axes as these angles turn them.  Names end in ``name``."""

    chain: Chain
    joints: tuple[Carrying, ...]
    p: sp.Matrix
    tool: sp.Matrix
    limits: tuple[sp.Expr, sp.Expr]
    name: str

    def let(self, name: str, value: sp.Expr) -> sp.Expr:
        return self.chain.let(f"{name}_{self.name}", value)

    def vector(self, name: str, value: sp.Matrix) -> sp.Matrix:
        return self.chain.vector(f"{name}_{self.name}", value)

    @cached_property
    def frames(self) -> tuple[list[sp.Matrix], list[sp.Matrix], sp.Matrix]:
        """The axes of the joints, how they move the wrist, and the first axis of the wrist."""
        G, at = sp.eye(3), sp.zeros(3, 1)
        axes, moves = [], []
        for k, joint in enumerate(self.joints, 1):
            axes.append(G[:, 2])
            moves.append(self.vector(f"move{k}", G[:, 2].cross(self.p - at)))
            G = self.chain.matrix(f"turned{k}_{self.name}", G * turned(joint.pair))
            at = self.vector(f"at{k}", at + G * joint.shift)
            G = self.chain.matrix(f"frame{k}_{self.name}", G * joint.end)
        return axes, moves, G[:, 2]

    @property
    def margin(self) -> sp.Expr:
        """How far the component of the last axis is from its limits; negative beyond them."""
        low, high = self.limits
        along = self.frames[2].dot(self.tool)
        return self.let("margin", sp.Min(along - low, high - along))

    def together(self) -> list[sp.Expr]:
        """The rates of all joints that move the wrist least."""
        moves = self.frames[1]
        if len(moves) == 1:
            return [sp.S.One]
        if len(moves) == 2:
            a, b = moves
            found = [[b.dot(b), -a.dot(b)], [-a.dot(b), a.dot(a)]]
        else:
            rows = [sp.Matrix([m[i] for m in moves]) for i in range(3)]
            found = [list(a.cross(b)) for a, b in combinations(rows, 2)]
        return self._largest(found)

    def _largest(self, found: Sequence[Sequence[sp.Expr]]) -> list[sp.Expr]:
        """The longest of some vectors."""
        named = [
            [self.let(f"rate{i}{k}", e) for i, e in enumerate(rates)]
            for k, rates in enumerate(found)
        ]
        best, *others = named
        size = self.let("square0", sp.Add(*(e**2 for e in best)))
        for k, rates in enumerate(others, 1):
            square = self.let(f"square{k}", sp.Add(*(e**2 for e in rates)))
            more = square > size
            best = [
                self.let(f"best{i}{k}", sp.Piecewise((b, more), (a, True)))
                for i, (a, b) in enumerate(zip(best, rates, strict=True))
            ]
            size = self.let(f"most{k}", sp.Max(size, square))
        return best

    def alone(self) -> list[sp.Expr]:
        """The rates of the one joint that moves the wrist least: 1, and 0 for the others."""
        squares = [self.let(f"lever{k}", m.dot(m)) for k, m in enumerate(self.frames[1], 1)]
        least = self.let("least", sp.Min(*squares))
        rates: list[sp.Expr] = []
        for k, square in enumerate(squares):
            chosen = sp.Piecewise((1 - sp.Add(*rates), square <= least), (0, True))
            rates.append(self.let(f"alone{k}", chosen))
        return rates

    def turned(self, rates: Sequence[sp.Expr], name: str) -> _Posture:
        """The joints turned at the ``rates``, as far as the limits need and rounding allows."""
        axes, moves, f = self.frames
        axis = self.vector("spin", sum((r * a for r, a in zip(rates, axes, strict=True)), Z0))
        size = self.let("rate", sp.sqrt(axis.dot(axis)))
        w = self.vector("unit", axis / size)
        low, high = self.limits
        along = self.let("along", f.dot(self.tool))
        k = self.let("fixed", w.dot(f) * w.dot(self.tool))
        u, v = self.let("ahead", along - k), self.let("aside", w.cross(f).dot(self.tool))
        h = self.let("reach", sp.sqrt(u**2 + v**2))
        wanted = self.let("wanted", sp.Min(sp.Max(along, low), high) - k)
        c = self.let("held", sp.Min(sp.Max(wanted, -h), h))
        root = self.let("across", sp.sqrt(sp.Max(0, (h - c) * (h + c))))
        side = sign_of(v)
        in_line = sp.Eq(h, 0)  # one of the axes is the axis of the turn, which does not tilt it
        by_s, by_c = (v * c - side * u * root) / h**2, (u * c + side * v * root) / h**2
        sine = self.let("by_s", sp.Piecewise((0, in_line), (by_s, True)))
        cosine = self.let("by_c", sp.Piecewise((1, in_line), (by_c, True)))
        forward = cosine > 0
        top = self.let("half_s", sp.Piecewise((sine, forward), (1 - cosine, True)))
        below = self.let("half_c", sp.Piecewise((1 + cosine, forward), (sine, True)))
        angle = self.let("angle", sp.Piecewise((2 * sp.Abs(sine), forward), (4, True)) / size)
        away = sum((r * m for r, m in zip(rates, moves, strict=True)), Z0)
        bent = sp.Add(*map(sp.Abs, rates)) * sp.Add(
            *(sp.Abs(r) * sp.sqrt(m.dot(m)) for r, m in zip(rates, moves, strict=True))
        )
        cost = self.let("cost", angle * (sp.sqrt(away.dot(away)) + angle * bent / 2))
        allowed = cost <= self.let("play", self.chain.size * ROUNDING)
        found = []
        for i, (joint, rate) in enumerate(zip(self.joints, rates, strict=True), 1):
            a, b = self.let(f"top{i}", rate * top), self.let(f"below{i}", size * below)
            whole = self.let(f"whole{i}", a**2 + b**2)
            s = self.let(f"s{i}", sp.Piecewise((2 * a * b / whole, allowed), (0, True)))
            c1 = self.let(f"c{i}", sp.Piecewise(((b**2 - a**2) / whole, allowed), (1, True)))
            pair = joint.pair + Pair(s, c1)
            pair = Pair(self.let(f"sine{i}", pair.s), self.let(f"cosine{i}", pair.c))
            found.append(replace(joint, pair=pair))
        return replace(self, joints=tuple(found), name=name)


Z0 = sp.zeros(3, 1)

__all__ = ["Carrying", "within_tilt"]
