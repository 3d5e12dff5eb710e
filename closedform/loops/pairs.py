"""The degree of the forward problem of six legs in three pairs, as of an octahedral platform.

The legs of a pair end in the same point of the hand, so this point is on a circle about the line
of their near ends.  The three points keep their distances.  A parameter t on each circle makes
these distances polynomials of degree two in each of two parameters; the elimination of two of them
leaves one polynomial, whose degree is counted modulo a prime, at points and lengths drawn at
random.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

from flint import nmod, nmod_poly

from closedform.algebra.shapes import ShapeError

PRIMES = (1_000_003, 2_147_483_647)
"""The count has to be the same modulo both."""
MOST = 16
"""The degree of the polynomial that is left: two conditions of degree 2 and 2, with the third."""
Vector = Sequence[nmod]


@dataclass(frozen=True)
class Circle:
    """A circle in space: its points are numerators over a common denominator, in a parameter."""

    point: tuple[nmod_poly, nmod_poly, nmod_poly]
    below: nmod_poly

    @classmethod
    def about(cls, first: Vector, second: Vector, draw: random.Random) -> Circle:
        """A circle about the line of two points, whose centre and size are drawn at random."""
        p = int(first[0].modulus())
        along = [b - a for a, b in zip(first, second, strict=True)]
        place = drawn(draw, p)
        centre = [a + place * e for a, e in zip(first, along, strict=True)]
        x = _cross(along, [drawn(draw, p) for _ in range(3)])
        y = _cross(along, x)
        stretch = sum((e * e for e in along), nmod(0, p))
        # x is as long as y is after a stretch, so a**2 + stretch*b**2 is the same on the circle
        a, b = drawn(draw, p), drawn(draw, p)
        below = nmod_poly([1, 0, int(stretch)], p)
        step = nmod_poly([int(-2 * a), int(-2 * stretch * b)], p)
        slope = nmod_poly([0, 1], p)
        u = below * int(a) + step
        v = below * int(b) + step * slope
        at = [
            below * int(c) + u * int(e) + v * int(f) for c, e, f in zip(centre, x, y, strict=True)
        ]
        return cls((at[0], at[1], at[2]), below)


def drawn(draw: random.Random, p: int) -> nmod:
    return nmod(draw.randrange(1, p), p)


def _cross(a: Vector, b: Vector) -> list[nmod]:
    return [a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1))]


def degree_of_pairs(pairs: Sequence[tuple[int, int]]) -> int:
    """The degree, if the legs of each pair start in the points with these numbers."""
    counts = {_counted(pairs, p, random.Random(p)) for p in PRIMES}
    if len(counts) > 1:
        raise ShapeError(f"the degree of {len(pairs)} pairs of legs is not determined: {counts}")
    return counts.pop()


def _counted(pairs: Sequence[tuple[int, int]], p: int, draw: random.Random) -> int:
    near = {k: [drawn(draw, p) for _ in range(3)] for pair in pairs for k in pair}
    circles = [Circle.about(near[a], near[b], draw) for a, b in pairs]
    apart = {pair: drawn(draw, p) for pair in combinations(range(3), 2)}
    places = [nmod(k, p) for k in range(1, MOST + 2)]
    values = [_eliminated(circles, apart, t) for t in places]
    left = _through(places, values, p)
    while left.degree() > 0 and not left % circles[0].below:  # where the circle is at infinity
        left //= circles[0].below
    return int(left.degree())


def _eliminated(circles: Sequence[Circle], apart: dict[tuple[int, int], nmod], t: nmod) -> nmod:
    """What vanishes if the point at ``t`` of the first circle leads to points of the two others."""
    first, second, third = circles
    p = int(t.modulus())
    here = Circle(
        tuple(nmod_poly([int(e(t))], p) for e in first.point),  # type: ignore[arg-type]
        nmod_poly([int(first.below(t))], p),
    )
    to_second = nmod_poly([int(c[0]) for c in _distance(here, second, apart[0, 1])], p)
    to_third = [c[0] for c in _distance(here, third, apart[0, 2])]
    between = _distance(second, third, apart[1, 2])
    # both are quadratic in the parameter of the third circle
    one = [nmod_poly([int(c)], p) for c in to_third]
    cross = [one[i] * between[j] - one[j] * between[i] for i, j in ((0, 2), (0, 1), (1, 2))]
    quartic = cross[0] * cross[0] - cross[1] * cross[2]
    return _resultant(to_second, quartic)


def _distance(one: Circle, other: Circle, square: nmod) -> list[nmod_poly]:
    """The equation of a distance: for each power of the second parameter, one in the first.

    The denominator of each circle divides the squared distance from any point once.
    """
    p = int(square.modulus())
    powers = [nmod_poly([0], p) for _ in range(5)]
    for x, y in zip(one.point, other.point, strict=True):
        for i in range(3):
            for j in range(3):
                powers[i + j] += (x * int(other.below[i]) - one.below * int(y[i])) * (
                    x * int(other.below[j]) - one.below * int(y[j])
                )
    for i in range(3):
        for j in range(3):
            powers[i + j] -= one.below * one.below * int(square * other.below[i] * other.below[j])
    return _divided(powers, one.below, other.below)


def _divided(powers: list[nmod_poly], below: nmod_poly, other: nmod_poly) -> list[nmod_poly]:
    """A polynomial in two parameters over one in each, both of which divide it."""
    rest, found = list(powers), []
    for k in range(2, -1, -1):
        lead = rest[k + 2] * int(1 / other[2])
        found.append(lead)
        for j in range(3):
            rest[k + j] -= lead * int(other[j])
    return [lead // below for lead in reversed(found)]


def _resultant(f: nmod_poly, g: nmod_poly) -> nmod:
    """The product of the values of ``g`` at both zeros of the quadratic ``f``, without a scale."""
    p = int(f.modulus())
    rest = g % f
    a, b, c = (f[k] for k in (2, 1, 0))
    u, v = rest[1], rest[0]
    power = a ** (g.degree() - 1) if g.degree() > 0 else nmod(1, p)
    return power * (u * u * c - u * v * b + v * v * a)


def _through(places: Sequence[nmod], values: Sequence[nmod], p: int) -> nmod_poly:
    """The polynomial with these values."""
    total = nmod_poly([0], p)
    for k, (t, value) in enumerate(zip(places, values, strict=True)):
        term = nmod_poly([int(value)], p)
        for other in [*places[:k], *places[k + 1 :]]:
            term *= nmod_poly([int(-other), 1], p) * int(1 / (t - other))
        total += term
    return total


__all__ = ["degree_of_pairs"]
