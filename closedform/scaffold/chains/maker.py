"""Writes the lines of a proposed chain: what all structures of arms have in common."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from closedform.mechanics.arm import Group, Serial
from closedform.mechanics.frames import rotation
from closedform.scaffold.chains.proposal import NoChainError
from closedform.scaffold.source import GIVEN, source

Z = sp.Matrix([0, 0, 1])
FLIP = "{+1: 'noflip', -1: 'flip'}"
LINE = "{+1: 'first', -1: 'second'}"
SIDE = "{+1: 'left', -1: 'right'}"


@dataclass(frozen=True)
class Solved:
    """The solution of the joints that carry a point.

    ``turned`` are their rotations: a pair about z, and the constant rotation after it.  With fewer
    than three joints, ``rest`` is what they leave of the point, which is zero if it can be reached.
    """

    structure: str
    turned: Sequence[tuple[str, sp.Matrix]]
    rest: str = ""


@dataclass
class Maker:
    """Writes lines that refer to a vector by its name and to a rotation by its pairs' names."""

    arm: Serial
    lines: list[str] = field(default_factory=list)
    used: list[str] = field(default_factory=list)
    count: int = 0
    branches: int = 1
    degree: int = 2
    """The highest degree of an equation that may be left: a chain without a quartic is shorter."""
    pairs: tuple[str, str] = ("", "")
    levers: list[str] = field(default_factory=list)
    """Numbers that vanish where the joints that were solved are singular."""
    solved_as: dict[int, tuple[str, str, sp.Expr]] = field(default_factory=dict)
    """Of a joint that turns and was solved: the unknown, its pair, and what that is ahead."""

    def add(self, line: str) -> None:
        self.lines.append(line)

    def solve(self, lemma: str, arguments: str, result: str = "", branches: int = 1) -> None:
        self.used.append(lemma)
        self.branches *= branches
        self.add(f"{result + ' = ' if result else ''}ik.solve({lemma}, {arguments})")

    def require(self, condition: Any, found: str, needed: str) -> None:
        """Raise :class:`NoChainError` unless the condition holds."""
        if not condition:
            raise NoChainError(found, needed)

    def links(self, group: Group, turns: Sequence[int]) -> list[sp.Matrix]:
        """The plane vectors from each turning axis to the next, and from the last to the end."""
        vectors = []
        for k, i in enumerate(turns):
            stop = turns[k + 1] if k + 1 < len(turns) else len(group.rows)
            shifts = (sp.Matrix(row.shift[:2]) for row in group.rows[i:stop])
            vectors.append(sum(shifts, sp.zeros(2, 1)))
        return vectors

    def two_links(
        self, joints: Sequence[Any], vectors: Sequence[Any], x: str, y: str, alone: bool = False
    ) -> None:
        """Solve two joints, given with their signs and link vectors, to reach the point x, y.

        With ``alone``, x and y are target coordinates, so the links set the scale of rounding.
        """
        (first, second), (u, v) = joints, vectors
        lengths = [norm(w) for w in (u, v)]
        self.require(
            0 not in lengths,
            f"link {lengths.index(0) + 1 if 0 in lengths else 0} of its planar two-link part "
            "has no length",
            "Both links need one.  If the last is missing, say where the tool is, in the last row "
            "of the table or, for a modified table, with tool= of from_dh.",
        )
        at = [heading(w) for w in (u, v)]
        a = self.angle(first + at[0])
        b = self.angle(second + at[1] - at[0])
        more = f", scale={source(sum(lengths))}" if (x, y) == ("x", "y") and alone else ""
        names = [self.length_of(f"link{i}", value) for i, value in enumerate(lengths, 1)]
        arguments = f"({a}, {b}), ({x}, {y}), ({', '.join(names)})"
        self.solve("two_links", f"{arguments}, {{+1: 'up', -1: 'down'}}{more}", f"{a}_, {b}_", 2)
        self.pairs = (f"{a}_", f"{b}_")

    def by_quartic(
        self, angle: str, double: tuple[str, str], radius: str, pair: str, more: str = ""
    ) -> None:
        """Solve an angle: where the ellipse of ``centre``, ``along`` and ``aside`` meets a circle.

        The circle is around the origin.  The equation is the difference of the squares of both
        distances; ``double`` are the coefficients of twice the angle in it.  The result is a
        ``pair`` of this name.  ``more`` are further arguments of ``OnCircle``.
        """
        square = f"centre.dot(centre) + (along.dot(along) + aside.dot(aside))/2 - {radius}**2"
        ellipse = "lambda pair: centre + along*pair.c + aside*pair.s"
        self.add(f"on_circle = OnCircle({ellipse}, {radius}{more})")
        linear = "centre.dot(along), centre.dot(aside)"
        arguments = f"{angle}, ({', '.join(double)}, {linear}, {square})"
        self.solve("quartic", f"{arguments}, ({LINE}, {SIDE}), on_circle", pair, 4)

    def length_of(self, name: str, value: Any) -> str:
        """The length of a link, under a ``name`` unless it is a parameter."""
        if value.is_Symbol:
            return source(value)
        self.add(f"{name} = ik.program.let('{name}', {source(value)}, nonnegative=True)")
        return name

    def angle(self, value: Any) -> str:
        """A joint, or a name for a joint with an offset or a sign."""
        value = sp.expand(value)
        if value.is_Symbol:
            return str(value)
        self.count += 1
        name = f"psi{self.count}"
        self.add(f"{name} = ik.angle('{name}', {source(value)})")
        return name

    def less(self, pair: str, v: Any) -> str:
        """The pair minus the direction of ``v``, which the auxiliary angle has as an offset."""
        length = norm(sp.Matrix(v[:2]))
        c, s = v[0] / length, v[1] / length
        if s == 0 and c == 1:
            return pair
        if c.free_symbols | s.free_symbols:
            self.add(f"ahead = ik.direction('ahead', {source(v[0])}, {source(v[1])})")
            return f"({pair} - ahead)"
        return f"({pair} + Pair({source(-s)}, {source(c)}))"

    def require_normal(self, along: Any, first: int, second: int) -> None:
        self.require(
            along == 0,
            f"axes {first} and {second} are not at right angles",
            "The known chains need a right angle there.",
        )

    def wrist(
        self,
        lift: Any,
        wrist: Sequence[Group],
        M: str,
        after: sp.Matrix,
        *,
        numbers: Sequence[int] = (4, 5, 6),
        more: str = "",
        choice: str = FLIP,
    ) -> tuple[str, Any]:
        """Solve ``lift`` and the two joints after it, with their offsets, as ZYZ angles.

        Returns the pair of the first angle, and what it is ahead of ``lift``.

        Parameters
        ----------
        lift
            the angle of the first joint of the wrist, or of parallel ones together
        wrist
            the groups of the joints, from the one that ``lift`` ends
        M
            the rotation that is left to them, as it is written
        after
            the rotation to the tool
        numbers
            those of the joints
        more
            further arguments of the lemma, as they are written
        choice
            the names of its solutions, as they are written
        """
        first, middle, last = wrist
        e = first.end * Z
        self.require_normal(e[2], numbers[0], numbers[1])
        sense, epsilon = -1 if e[1].is_negative else 1, ahead_of_lift(e)
        W = rotation("z", -epsilon) * first.end * middle.end
        self.require_normal(sp.simplify(W[1, 2]), numbers[1], numbers[2])
        tau = heading((W[2, 2], W[0, 2]))
        rest = sp.simplify(rotation("y", -tau) * W)
        omega = heading((rest[0, 0], rest[1, 0]))
        if after != sp.eye(3):
            self.add(f"{M} = ik.matrix('{M}_tool', {M} * {source(after.T)})")
        turns = [g.rows[0].turn for g in (middle, last)]
        names = (
            self.angle(lift + epsilon),
            self.angle(sense * turns[0] + tau),
            self.angle(turns[1] + omega),
        )
        arguments = f"{M}, ({', '.join(names)}), {choice}{more}"
        self.solve("zyz", arguments, f"{names[0]}_", 2)
        return f"{names[0]}_", epsilon


def point(name: str) -> Any:
    """The entries of the vector with this name in the lines."""
    return sp.Matrix([sp.Symbol(f"{name}[{i}]") for i in range(3)])


def times(R: sp.Matrix, value: str) -> str:
    return value if (R - sp.eye(3)).is_zero_matrix else f"{source(R)} * {value}"


def followed(value: str, R: sp.Matrix) -> str:
    return value if sp.eye(3) == R else f"{value} * {source(R)}"


def sine_cosine(angle: Any) -> tuple[Any, Any]:
    """Sine and cosine of an angle that holds directions of vectors."""
    found = (sp.sin(angle), sp.cos(angle))
    if not angle.free_symbols:
        return found
    sine, cosine = (sp.simplify(sp.expand_trig(e)) for e in found)
    return sine, cosine


def norm(v: sp.Matrix) -> Any:
    """The length of a vector in the plane."""

    return sp.sqrt(sp.simplify(v.dot(v))) if v != sp.zeros(2, 1) else sp.S.Zero


def heading(v: Sequence[Any]) -> Any:
    """The direction of a plane vector; that of a turn by a parameter has its sine and cosine."""
    x, y = (sp.simplify(e) if e.has(sp.sin, sp.cos) else e for e in v[:2])
    held = {f.args[0] for e in (x, y) for f in e.atoms(sp.sin, sp.cos) if f.free_symbols}
    for angle in (s * a for a in sorted(held, key=sp.default_sort_key) for s in (1, -1)):
        c, s = sp.cos(angle), sp.sin(angle)
        along, across = sp.simplify(x * c + y * s), sp.simplify(y * c - x * s)
        if 0 in (along, across) and (along + across).is_number:
            turn = angle + sp.atan2(across, along)
            return sp.atan2(sp.sin(turn), sp.cos(turn))
    if x.is_number and y.is_number and x != 0:  # atan knows 2 + sqrt(3), but no other form of it
        side = sp.sign(y)
        return side * sp.atan2(sp.radsimp(abs(y / x)), sp.sign(x)) if y else sp.atan2(0, x)
    if x.is_number and y.has(GIVEN):  # this stays as it is, with the length of the vector
        return sp.pi / 2 - sp.atan2(x, y)
    return sp.atan2(y, x)


def simple(value: sp.Matrix) -> sp.Matrix:
    """A matrix with each entry simplified."""
    return sp.Matrix(value).applyfunc(sp.simplify)


def ahead_of_lift(axis: sp.Matrix) -> Any:
    """How far the first angle of a wrist is ahead of its joint, from the axis after that.

    A turn about -y is a turn about y in the other direction.
    """
    return heading(-axis if axis[1].is_negative else axis) - sp.pi / 2


def turning(w: Any, v: Any) -> tuple[Any, Any]:
    """The coefficients of sin(x) and cos(x) in the scalar product of ``v`` and ``Rz(x) w``."""
    return w[0] * v[1] - w[1] * v[0], w[0] * v[0] + w[1] * v[1]


__all__ = [
    "FLIP",
    "LINE",
    "SIDE",
    "Maker",
    "Solved",
    "Z",
    "ahead_of_lift",
    "followed",
    "heading",
    "norm",
    "point",
    "simple",
    "sine_cosine",
    "times",
    "turning",
]
