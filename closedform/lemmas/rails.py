"""Legs of two slides in a plane: a driven slider carries a rail, along which the hand slides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Naming, Slider, Solution, cross_in_plane, turned_left, vector
from closedform.lemmas.missed import MOVED
from closedform.lemmas.registry import theorem
from closedform.lemmas.spheres import Meeting
from closedform.model.functions import Program
from closedform.model.inverse import Link
from closedform.model.lemma import Lemma

theorem(
    "oblique coordinates",
    statement=r"""Let $\mathbf s$ and $\mathbf t$ be vectors of a plane with $D = s_1 t_2 - s_2 t_1
\ne 0$.  For each vector $\mathbf w$ there is exactly one pair of numbers with $\mathbf w =
q\,\mathbf s + \lambda\,\mathbf t$, and
$$q = \frac{w_1 t_2 - w_2 t_1}{D}, \qquad \lambda = \frac{s_1 w_2 - s_2 w_1}{D}.$$""",
    proof=r"""These are two linear equations with the determinant $D$, and Cramer's rule solves
them.""",
)


@dataclass(frozen=True)
class Rail(Slider):
    """A slider that carries a rail, along which the hand slides; in a plane.

    The joint moves the slider from ``start`` along the unit vector ``direction``, and the rail has
    the direction of the unit vector ``along``; both are numbers.  ``slide`` is the passive joint:
    how far the point ``on_hand``, as seen from the point that is the hand, is along the rail.
    """

    joint: sp.Symbol
    slide: sp.Symbol
    start: Sequence[Any]
    direction: Sequence[Any]
    along: Sequence[Any]
    on_hand: Sequence[Any] = ()
    signs: int = 1
    rod: int = 1
    """The length of the rod in formulas for any leg: the normal of the rail is a unit vector."""

    def __post_init__(self) -> None:
        if not (len(self.start) == len(self.direction) == len(self.along) == 2):
            raise ShapeError(
                f"{self.joint}: the vectors of a rail need 2 entries, because it is in a plane"
            )
        cross = sp.simplify(cross_in_plane(self.rate, self.way))
        if not cross.is_number or cross == 0:
            raise ShapeError(
                f"{self.joint}: the directions of a slider and of the rail on it must differ, and "
                f"both must be numbers"
            )

    @property
    def way(self) -> sp.Matrix:
        """The direction of the rail."""
        return vector(self.along)

    @property
    def normal(self) -> sp.Matrix:
        """The direction of the rail, turned by a right angle to the left."""
        return turned_left(self.way)

    def pull(self, span: sp.Matrix) -> sp.Matrix:
        """The vector whose product with the velocity of the point is its row of A."""
        return self.normal

    def excess(self, span: sp.Matrix) -> sp.Expr:
        """What vanishes if the point is on the rail, from the vector to it from the slider."""
        return self.normal.dot(span)

    def solve(self, chain: Naming, w: sp.Matrix, sigma: sp.Symbol) -> Solution:
        q, cross = self.joint, sp.simplify(cross_in_plane(self.rate, self.way))
        off = chain.let("off", cross_in_plane(w, self.way))
        named = named_number(chain.program, f"cross{chain.tag}", cross)
        lemma = Lemma(
            "oblique coordinates",
            r"q = \frac{w_1 t_2 - w_2 t_1}{D}",
            (q * named - off,),
            {q: off / named},
            1,
            roles=((r"\mathbf w", sp.Matrix(w)), (r"\mathbf t", self.way), ("D", cross)),
        )
        return Solution(Link((q,), lemma.equations, {}, lemma), lemma[q], self.normal)


def named_number(program: Program, name: str, number: sp.Expr) -> sp.Expr:
    """A rational number as it is; any other under a name, for all of whose values a lemma holds."""
    return number if number.is_Rational else program.let(name, number)


def two_rails(
    program: Program, ends: Sequence[sp.Matrix], rails: Sequence[Rail], hand: sp.Matrix
) -> Meeting:
    """The point that two rails share; ``ends`` are points of them."""
    a, b = rails
    across = sp.simplify(cross_in_plane(a.way, b.way))
    if across == 0:
        raise ShapeError(f"the rails of {a.joint} and {b.joint} are parallel")
    if not across.is_number:
        raise ShapeError(f"the rails of {a.joint} and {b.joint} have directions in parameters")
    s, t = (
        sp.Matrix([named_number(program, f"{n}_{i}", e) for i, e in zip("xy", r.way, strict=True)])
        for n, r in zip("st", rails, strict=True)
    )
    start = len(program.body)
    far = program.let("along", cross_in_plane(ends[1] - ends[0], t) / cross_in_plane(s, t))
    found = ends[0] + far * s
    lemma = Lemma(
        "oblique coordinates",
        r"\lambda = \frac{w_1 t_2 - w_2 t_1}{D}",
        tuple(cross_in_plane(way, hand - e) for way, e in zip((s, t), ends, strict=True)),
        dict(zip(hand, found, strict=True)),
        1,
        roles=((r"\mathbf w", ends[1] - ends[0]), (r"\mathbf t", b.way), ("D", across)),
    )
    return Meeting(
        Link(tuple(hand), lemma.equations, {}, lemma, tuple(program.body[start:])),
        tuple(far * s),
        sp.sign(across),
        abs(across),
        sp.Matrix.vstack(a.normal.T, b.normal.T),
    )


def rail_and_circle(
    program: Program,
    ends: Sequence[sp.Matrix],
    legs: Sequence[Any],
    hand: sp.Matrix,
    sigma: sp.Symbol,
    *,
    scale: sp.Expr,
) -> Meeting:
    """The points of a rail at the length of a rod from the near end of the rod.

    Parameters
    ----------
    program
        the program that the names and bounds are added to
    ends
        a point of the rail and the near end of the rod, in the order of the legs
    legs
        two, of which one is a rail
    hand
        the point that is sought
    sigma
        the sign that names the two points
    scale
        the size of the coordinates, whose rounding decides what counts as zero
    """
    p, k = program, 0 if isinstance(legs[0], Rail) else 1
    rail, rod, at, centre = legs[k], legs[1 - k], ends[k], ends[1 - k]
    names = Naming(p, scale, "", MOVED)
    w = sp.Matrix([p.let(f"w_{i}", e) for i, e in zip("xy", centre - at, strict=True)])
    r = names.coefficient("r", rod.rod, nonnegative=True)
    start = len(p.body)
    m, off = p.let("m", w.dot(rail.way)), p.let("aside", w.dot(rail.normal))
    root = names.half_chord("root", r, off, "the rod reaches the rail")
    side = -sigma if k == 0 else sigma
    far = p.let("along", m + side * root)
    found, plain = at + far * rail.way, sp.sqrt(r**2 - off**2)
    equations = (rail.normal.dot(hand - at), (hand - at - w).dot(hand - at - w) - r**2)
    lemma = Lemma(
        "line and sphere",
        rf"q = m {'-' if k == 0 else '+'} \sigma\sqrt{{r^2 - p^2}}",
        equations if k == 0 else equations[::-1],
        dict(zip(hand, found, strict=True)),
        2,
        signs=(sigma,),
        roles=(("q", far), ("m", m), ("r", r), ("p", sp.Abs(off))),
        plainly=dict(zip(hand, at + (m + side * plain) * rail.way, strict=True)),
    )
    rows = [sp.Matrix([[0, 1]]), sp.Matrix([[side * root, -off]])]
    span = far * rail.way
    return Meeting(
        Link(tuple(hand), lemma.equations, {}, lemma, tuple(p.body[start:])),
        tuple(span if k == 0 else span - w),
        sigma,
        root,
        sp.Matrix.vstack(*(rows if k == 0 else rows[::-1])),
    )


__all__ = ["Rail", "named_number", "rail_and_circle", "two_rails"]
