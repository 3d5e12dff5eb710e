"""Legs of a slider and two bars with parallel axes, which keep the hand in a moving plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Naming, Slider, Solution, vector
from closedform.lemmas.missed import MOVED
from closedform.lemmas.rails import Rail, named_number
from closedform.lemmas.registry import theorem
from closedform.lemmas.spheres import Meeting
from closedform.model.functions import Program, choose
from closedform.model.inverse import Link
from closedform.model.lemma import Lemma

theorem(
    "line and plane",
    statement=r"""Let $\mathbf n$ and $\mathbf s$ be vectors with $D = \mathbf n\cdot\mathbf s \ne
0$.  The vector $\mathbf w - q\,\mathbf s$ is at right angles to $\mathbf n$ for exactly one number
$q$,
$$q = \frac{\mathbf n\cdot\mathbf w}{D}.$$""",
    proof=r"""$\mathbf n\cdot(\mathbf w - q\,\mathbf s) = \mathbf n\cdot\mathbf w - q D$.""",
)
theorem(
    "point of three planes",
    statement=r"""Let $\mathbf n_1$, $\mathbf n_2$, $\mathbf n_3$ be vectors with $D = \mathbf
n_1\cdot(\mathbf n_2\times\mathbf n_3) \ne 0$, and $\mathbf b_k$ points.  There is exactly one point
$\mathbf p$ with $\mathbf n_k\cdot(\mathbf p - \mathbf b_k) = 0$ for all $k$,
$$\mathbf p = \frac{h_1\,\mathbf n_2\times\mathbf n_3 + h_2\,\mathbf n_3\times\mathbf n_1 +
h_3\,\mathbf n_1\times\mathbf n_2}{D}, \qquad h_k = \mathbf n_k\cdot\mathbf b_k.$$""",
    proof=r"""These are three linear equations with the determinant $D$.  The point solves them,
because $\mathbf n_1$ is at right angles to the second and the third term, and so on.""",
)
theorem(
    "parallel axes",
    statement=r"""If all joints of a leg that turn have the direction $\mathbf n$, the hand keeps
this direction: $R\,\mathbf n = \mathbf n$ for its rotation $R$ from any other posture of the leg.
A hand on two such legs, whose axes have different directions, does not turn: $R = I$.""",
    proof=r"""A rotation about $\mathbf n$ keeps $\mathbf n$, and so does a product of such
rotations.  A slide does not turn the hand.  If $R\,\mathbf a = \mathbf a$ and $R\,\mathbf b =
\mathbf b$, then $R(\mathbf a\times\mathbf b) = \mathbf a\times\mathbf b$.  The determinant of
$\mathbf a$, $\mathbf b$ and $\mathbf a\times\mathbf b$ is $|\mathbf a\times\mathbf b|^2$.  If it
is not zero, the three vectors are a basis, and $R = I$.""",
)


@dataclass(frozen=True)
class Plane(Slider):
    """A slider that carries two bars, which turn about parallel axes; in space.

    The joint moves the slider from ``start`` along the unit vector ``direction``.  The three axes,
    at the slider, between the two ``bars`` and at the hand, have the direction of the unit vector
    ``axis``; both vectors are numbers.  So the point ``on_hand``, as seen from the point that is
    the hand, stays in a plane through the slider.  The bars limit how far it is from there.
    """

    joint: sp.Symbol
    bars: tuple[Any, Any]
    start: Sequence[Any]
    direction: Sequence[Any]
    axis: Sequence[Any]
    on_hand: Sequence[Any] = ()
    signs: int = 1
    rod: int = 1
    """The length of the rod in formulas for any leg: the normal of the plane is a unit vector."""

    def __post_init__(self) -> None:
        if not (len(self.start) == len(self.direction) == len(self.axis) == 3):
            raise ShapeError(f"{self.joint}: the vectors of a plane need 3 entries")
        if not self.advance.is_number or self.advance == 0:
            raise ShapeError(
                f"{self.joint}: the direction of a slider must not be at right angles to the "
                f"axes of its bars, and both must be numbers"
            )

    @property
    def normal(self) -> sp.Matrix:
        return vector(self.axis)

    @property
    def advance(self) -> sp.Expr:
        """How far the plane moves along its normal for each unit of the joint."""
        return sp.simplify(self.normal.dot(self.rate))

    @property
    def lengths(self) -> tuple[sp.Expr, sp.Expr]:
        first, second = (sp.sympify(bar, strict=True) for bar in self.bars)
        return first, second

    def solve(self, chain: Naming, w: sp.Matrix, sigma: sp.Symbol) -> Solution:
        q = self.joint
        off = chain.let("off", self.normal.dot(w))
        named = named_number(chain.program, f"advance{chain.tag}", self.advance)
        value = off / named
        lemma = Lemma(
            "line and plane",
            r"q = \frac{\mathbf n\cdot\mathbf w}{D}",
            (off - q * named,),
            {q: value},
            1,
            roles=((r"\mathbf w", sp.Matrix(w)), (r"\mathbf n", self.normal), ("D", self.advance)),
        )
        link = Link((q,), lemma.equations, {}, lemma)
        self.reached(chain, w - chain.let("slid", value) * self.rate)
        return Solution(link, value, self.normal)

    def reached(self, chain: Naming, w: sp.Matrix) -> tuple[sp.Symbol, sp.Symbol]:
        """Ask that the bars reach along ``w``, from the slider to the hand: two margins."""
        first, second = self.lengths
        named = [chain.coefficient(f"w{i}", e) for i, e in zip("xyz", w, strict=True)]
        far = chain.let("far", sp.sqrt(sum(e**2 for e in named)), nonnegative=True)
        meaning = "the bars reach"
        over = chain.bound("over", first + second - far, meaning)
        return over, chain.bound("under", far - sp.Abs(first - second), meaning)

    def elbow(self, w: sp.Matrix) -> sp.Matrix:
        """From the slider to the joint between the bars, to the left of ``w``.

        The bars are in the plane if ``w`` is.
        """
        first, second = self.lengths
        ahead = (first**2 - second**2 + w.dot(w)) / (2 * w.dot(w))
        return ahead * w + sp.sqrt(self.aside(w)) * self.normal.cross(w)

    def aside(self, w: sp.Matrix) -> sp.Expr:
        """The square of how far the elbow is beside ``w``, per square of the length of ``w``."""
        first, second = self.lengths
        square = w.dot(w)
        return ((first + second) ** 2 - square) * (square - (first - second) ** 2) / (4 * square**2)

    def named_elbow(self, names: Naming, w: sp.Matrix) -> sp.Matrix:
        """The same in the names of a program; if the bars are folded, along some direction."""
        p, (first, second) = names.program, self.lengths
        w = sp.Matrix([names.let(f"w{i}", e) for i, e in zip("xyz", w, strict=True)])
        far = names.let("far", sp.sqrt(w.dot(w)), nonnegative=True)
        folded = p.vanishes(f"folded{names.tag}", far, names.size, "the bars are folded")
        per = names.let("per", choose(folded, 0, 1 / far), nonnegative=True)
        total = first + second
        margins = [total - far, total + far, far - (first - second), far + first - second]
        roots = [sp.sqrt(sp.Max(0, margin)) for margin in margins]
        ahead = names.let("ahead", (1 + (first - second) * total * per**2) / 2)
        beside = names.let("beside", sp.Mul(*roots) * per**2 / 2, nonnegative=True)
        still = names.let("still", choose(folded, first, 0))
        least = min(range(3), key=lambda i: (abs(self.normal[i]), i))
        side = self.normal.cross(sp.eye(3).col(least))
        side /= sp.sqrt(side.dot(side))
        return ahead * w + beside * self.normal.cross(w) + still * side


Flat = Rail | Plane
"""Legs in which the hand slides along a line or moves in a plane."""


def _numbers(place: sp.Matrix) -> set[sp.Expr]:
    """The numbers in the coordinates of a point, such as roots."""
    found: set[sp.Expr] = set()
    for e in place:
        for term in sp.Add.make_args(sp.expand(e)):
            found.add(term.as_independent(*term.free_symbols)[0])
    return found


def three_planes(
    program: Program,
    ends: Sequence[sp.Matrix],
    planes: Sequence[Plane],
    hand: sp.Matrix,
    *,
    scale: sp.Expr,
) -> Meeting:
    """The point that three planes share; ``ends`` are points of them."""
    p = program
    volume = sp.simplify(sp.Matrix.hstack(*(plane.normal for plane in planes)).det())
    if volume == 0:
        raise ShapeError(
            "the axes of the bars of the three legs are parallel to one plane, so "
            "the legs do not determine the place of the hand"
        )
    n = [
        sp.Matrix([named_number(p, f"n{k}_{i}", e) for i, e in zip("xyz", x.normal, strict=True)])
        for k, x in enumerate(planes, 1)
    ]
    start = len(p.body)
    heights = [p.let(f"h_{k}", a.dot(e)) for k, (a, e) in enumerate(zip(n, ends, strict=True), 1)]
    stated = tuple(a.dot(hand - e) for a, e in zip(n, ends, strict=True))
    if any(not number.is_Rational for e in ends for number in _numbers(e)):
        # a lemma is counted in rational numbers, so it has the names of the heights
        start = len(p.body)
        stated = tuple(a.dot(hand) - h for a, h in zip(n, heights, strict=True))
    across = [n[1].cross(n[2]), n[2].cross(n[0]), n[0].cross(n[1])]
    total = sum((h * c for h, c in zip(heights, across, strict=True)), sp.zeros(3, 1))
    width = n[0].dot(across[0])
    found = [p.let(f"p_{i}", e / width) for i, e in zip("xyz", total, strict=True)]
    lemma = Lemma(
        "point of three planes",
        r"\mathbf p = \frac{1}{D}\sum_k h_k\,\mathbf n_{k+1}\times\mathbf n_{k+2}",
        stated,
        dict(zip(hand, found, strict=True)),
        1,
        roles=(("D", volume),),
    )
    body = tuple(p.body[start:])
    for k, (plane, end) in enumerate(zip(planes, ends, strict=True), 1):
        plane.reached(Naming(p, scale, f"_{k}", MOVED), sp.Matrix(found) - end)
    return Meeting(
        Link(tuple(hand), lemma.equations, {}, lemma, body),
        tuple(sp.Matrix(found) - ends[0]),
        sp.sign(volume),
        abs(volume),
        sp.Matrix.vstack(*(plane.normal.T for plane in planes)),
    )


__all__ = ["Flat", "Plane", "three_planes"]
