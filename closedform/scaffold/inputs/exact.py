"""Exact values for the decimals in a table: unit vectors, rotations, and named angles.

Derivations compute with exact numbers.  (0, 0.7071, 0.7071) is not a unit vector, and cos(pi/18)
has no form in square roots that the proofs could use.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import combinations, product
from math import hypot
from typing import Any

import sympy as sp
from sympy.simplify.fu import TR8

from closedform.model.functions import real
from closedform.model.tolerances import UNIT_LENGTH

ROUNDED = 0.75
"""Tolerance in units of the last decimal: half for its own rounding, the rest for the others'."""
FINEST = 1e-15
WORD = 62
"""Longer denominators grow from axis to axis, and proofs take minutes."""
SHORT = (1, 2, 3, 4, 5, 6, 8, 10, 12)
"""The parts of a half turn whose multiples have short sines and cosines: one root in another."""
SIMPLE: tuple[sp.Expr, ...] = (
    *map(sp.Integer, (0, 1)),
    *(sp.Rational(p, q) for p, q in ((1, 2), (1, 3), (2, 3), (3, 5), (4, 5))),
    *(sp.sqrt(n) / k for n, k in ((2, 2), (3, 2), (3, 3), (6, 3), (6, 6), (5, 5))),
    2 * sp.sqrt(5) / 5,
    *((sp.sqrt(6) + sign * sp.sqrt(2)) / 4 for sign in (1, -1)),
)
"""Absolute values that coordinates of unit vectors often have."""
AXES = tuple(sp.eye(3)[:, i] for i in range(3))


def orthonormal(given: sp.Matrix) -> bool:
    """Whether the columns are exactly unit vectors, normal to each other.

    Sines and cosines, as of a turn by 0.1359, are exact; this must hold for all of their angles.
    """
    unit: sp.Matrix = sp.eye(given.cols)
    return bool((given.T * given).applyfunc(without_squares) == unit)


def without_squares(value: sp.Expr) -> sp.Expr:
    """A polynomial in sines and cosines, with cosines for squares of sines."""
    found = sp.expand(value).replace(
        lambda e: e.is_Pow and isinstance(e.base, sp.sin) and e.exp.is_Integer and e.exp > 1,
        lambda e: (1 - sp.cos(e.base.args[0]) ** 2) ** (e.exp // 2) * e.base ** (e.exp % 2),
    )
    return sp.expand(found)


def turned_on(first: sp.Matrix, then: sp.Matrix) -> sp.Matrix:
    """The product of two rotations, in which turns about parallel axes are one turn."""
    found = (first * then).applyfunc(sp.expand)
    joined = found.applyfunc(lambda e: sp.expand(TR8(e)))
    return joined if orthonormal(joined) else found


def unit_vector(
    given: sp.Matrix, known: Sequence[sp.Matrix] = (), *, roots: bool = True
) -> sp.Matrix | None:
    """The exact unit vector that was rounded to the given numbers.

    If the decimals allow it, it is one of the ``known`` vectors or normal to one of them; but not
    normal if that takes denominators of more than :data:`WORD` bits, as after several such vectors.
    Otherwise it has simple coordinates if possible (square ``roots`` only if allowed), and rational
    ones if not.  None if the length
    is not 1 within :data:`~closedform.model.tolerances.UNIT_LENGTH`.
    """
    if given.free_symbols:
        return None
    numbers = [float(e) for e in given]
    length = hypot(*numbers)
    if abs(length - 1) > UNIT_LENGTH:
        return None
    u, place = [x / length for x in numbers], _last_place(given)
    across = (a.cross(b).applyfunc(sp.expand) for a, b in combinations(known, 2))
    related = [*known, *across]
    near = (sign * v for v in related for sign in (1, -1) if _is_unit(v))
    chosen = next((v for v in near if _close(v, u, place)), None) or _simple(u, place, roots)
    if chosen is not None:
        return chosen
    for v in known:
        if abs(sum(float(a) * b for a, b in zip(v, u, strict=True))) <= 2 * place:
            normal = _normal_to(v, u, place)
            if all(int(n.q).bit_length() <= WORD for e in normal for n in e.atoms(sp.Rational)):
                return normal
    return _rational(u, place)


def rotation(
    given: sp.Matrix, known: Sequence[sp.Matrix] = (), *, roots: bool = True
) -> sp.Matrix | None:
    """The exact rotation that was rounded to the given 3x3 matrix; None if no rotation is near."""
    third = unit_vector(given[:, 2], known, roots=roots)
    if third is None or unit_vector(given[:, 0], roots=roots) is None:
        return None
    first = unit_vector(given[:, 0], [third, *known], roots=roots)
    if first is None or sp.expand(first.dot(third)) != 0:
        first = _normal_to(third, [float(e) for e in given[:, 0]], _last_place(given))
    found = sp.Matrix.hstack(first, third.cross(first).applyfunc(sp.expand), third)
    away = max(abs(float(a) - float(b)) for a, b in zip(found, given, strict=True))
    return found if away <= UNIT_LENGTH else None


def _last_place(given: sp.Matrix) -> float:
    """The unit of the last decimal; 0.001 if the numbers are not decimals."""
    digits = [
        next((k for k in range(16) if (e * 10**k).is_Integer), None)
        for e in given
        if e.is_Rational and not e.is_Integer
    ]
    return max(10.0 ** -max((k for k in digits if k is not None), default=3), FINEST)


def _close(v: Sequence[sp.Expr], u: Sequence[float], place: float) -> bool:
    return all(abs(float(a) - b) <= ROUNDED * place for a, b in zip(v, u, strict=True))


def _is_unit(v: sp.Matrix) -> bool:
    return bool(sp.expand(v.dot(v)) == 1)


def _simple(u: Sequence[float], place: float, roots: bool) -> sp.Matrix | None:
    simple = SIMPLE if roots else [s for s in SIMPLE if s.is_Rational]
    sizes = [[s for s in simple if abs(float(s) - abs(x)) <= ROUNDED * place] for x in u]
    for chosen in product(*sizes):
        v = sp.Matrix([s if x >= 0 else -s for s, x in zip(chosen, u, strict=True)])
        if _is_unit(v):
            return v
    return None


def _fractions(*values: float) -> Iterator[tuple[sp.Rational, ...]]:
    """Fractions that approximate the numbers more and more closely."""
    for k in range(2, 53):
        near = (Fraction(x).limit_denominator(2**k) for x in values)
        yield tuple(sp.Rational(f.numerator, f.denominator) for f in near)


def _rational(u: Sequence[float], place: float) -> sp.Matrix:
    """A rational point of the sphere, by stereographic projection from the opposite pole."""
    pole = max(range(3), key=lambda i: abs(u[i]))
    sign = 1 if u[pole] > 0 else -1
    a, b = (i for i in range(3) if i != pole)
    v = sp.zeros(3, 1)
    for s, t in _fractions(*(u[i] / (1 + abs(u[pole])) for i in (a, b))):
        below = 1 + s**2 + t**2
        v[a], v[b], v[pole] = 2 * s / below, 2 * t / below, sign * (2 - below) / below
        if _close(v, u, place):
            break
    return v


def _normal_to(axis: sp.Matrix, u: Sequence[float], place: float) -> sp.Matrix:
    """A unit vector that is exactly normal to an axis, and rational in a frame on that axis."""
    x, y, z = axis if axis[2] >= 0 else -axis
    across = sp.Matrix([1 - x**2 / (1 + z), -x * y / (1 + z), -x])
    along = sp.Matrix([-x * y / (1 + z), 1 - y**2 / (1 + z), -y])
    c, s = (sum(float(e) * b for e, b in zip(v, u, strict=True)) for v in (across, along))
    sign = 1 if c > 0 else -1
    found = across
    for (t,) in _fractions(s / (abs(c) + hypot(c, s))):
        found = (sign * (1 - t**2) * across + 2 * t * along) / (1 + t**2)
        if _close(found, u, place):
            break
    return found.applyfunc(lambda e: sp.radsimp(sp.expand(e)))


Axis = tuple[sp.Expr, list[sp.Expr], list[sp.Expr]]
"""A joint, the direction of its axis, and a point on it."""


def straightened(axes: Sequence[Axis]) -> list[Axis]:
    """The axes with the point of one where the next one meets it, if the lengths to it go back.

    Lengths forth and back would cancel in the printed code, and lose digits.
    """
    found = list(axes)
    before: sp.Matrix = sp.zeros(3, 1)
    for k, (_, _, after) in enumerate(axes[1:]):
        joint, direction, point = found[k]
        w, here = sp.Matrix(direction), sp.Matrix(point)
        forth, back = here - before, sp.Matrix(after) - here
        meets = all(e in (-1, 0, 1) for e in w) and back.cross(w).is_zero_matrix
        if meets and (forth.dot(w) * back.dot(w)).is_negative:
            found[k] = (joint, direction, after)
        before = sp.Matrix(found[k][2])
    return found


@dataclass
class Angles:
    """Names for the angles whose cosine has no short form with square roots."""

    taken: Callable[[str], bool]
    named: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)
    places: dict[sp.Expr, str] = field(default_factory=dict)

    def read(self, entry: sp.Expr, where: str, *, angle: bool = False) -> sp.Expr:
        """The entry with names for such angles in its sines and cosines.

        With ``angle``, the entry is itself an angle and may get a name.
        """
        functions = entry.atoms(sp.sin, sp.cos)
        held = {f: f.func(self._named(f.args[0], where)) for f in functions}
        entry = entry.xreplace(held)
        return self._named(entry, where) if angle else entry

    def _named(self, angle: sp.Expr, where: str) -> sp.Expr:
        unknown = sp.Add(*(t for t in sp.Add.make_args(angle) if not _is_simple(t)))
        if unknown == 0:
            return angle
        value, sign = (-unknown, -1) if unknown < 0 else (unknown, 1)
        if value not in self.named:
            numbers = (f"angle{n}" for n in range(1, 1000))
            held = {s.name for s in self.named.values()}
            name = next(n for n in numbers if n not in held and not self.taken(n))
            self.named[value], self.places[value] = real(name), where
        return angle - unknown + sign * self.named[value]


def _is_simple(term: sp.Expr) -> bool:
    """Whether the sine and the cosine have short forms with square roots, or it has symbols."""
    if term.free_symbols or term == 0:
        return True
    factor, rest = term.as_coeff_Mul()
    if rest == sp.pi:
        return factor.is_Rational and factor.q in SHORT
    return factor.is_Integer and isinstance(rest, sp.atan | sp.atan2)


def decimal(value: sp.Expr) -> str:
    """A number as exact text, in decimals if they end; to 20 digits if it is not rational."""
    if not value.is_Rational:
        return str(value.evalf(20))
    places = next((k for k in range(1, 31) if 10**k % value.q == 0), 0)
    if value.is_Integer or not places:
        return str(value)
    digits = f"{abs(value.p) * 10**places // value.q:0{places + 1}d}"
    return f"{'-' if value < 0 else ''}{digits[:-places]}.{digits[-places:]}"


def coordinates(vector: Any) -> str:
    """A vector in a message."""
    return f"({', '.join(map(str, vector))})"


def decimals(vector: Any) -> str:
    """A vector in a message, in decimals."""
    return f"({', '.join(f'{float(e):.12g}' for e in vector)})"


__all__ = [
    "Angles",
    "coordinates",
    "decimal",
    "decimals",
    "orthonormal",
    "rotation",
    "straightened",
    "turned_on",
    "unit_vector",
    "without_squares",
]
