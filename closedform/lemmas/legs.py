"""Legs of a closed loop: a joint moves one end of a rod, and the other end is at a given point.

Each kind of leg knows where its joint brings the near end of the rod, and which values of the joint
bring this end to the distance of the rod from a given point:

:class:`Crank`
    the end turns on a circle; two solutions, as a triangle has two mirror images;
:class:`Slide`
    the end moves along a line; two solutions, where the line meets a sphere;
:class:`Stretch`
    the end stays, and the joint is the length of the rod; one solution.

A :class:`Strut` has no joint: its rod leads from a point of the ground, so the hand is on a sphere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Protocol

import sympy as sp

from closedform.lemmas.extended import Extended
from closedform.lemmas.registry import theorem
from closedform.lemmas.triangle import Triangle, indexed
from closedform.lemmas.universal import Universal
from closedform.model.functions import Program, choose, real
from closedform.model.inverse import Degenerate, Link
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair
from closedform.model.tolerances import HALF_DIGITS

theorem(
    "crank and rod",
    statement=r"""A crank of length $l > 0$ turns about the origin in the plane of the orthonormal
vectors $\mathbf u$ and $\mathbf v$.  Its end $l(\cos\theta\,\mathbf u + \sin\theta\,\mathbf
v)$ is at the distance $r$ from the point $\mathbf w$, which is at the distance $p$ from the plane.
Let $a = \mathbf w\cdot\mathbf u$, $b = \mathbf w\cdot\mathbf v$, $R = \sqrt{a^2 + b^2} > 0$ and
$s = \sqrt{r^2 - p^2}$.  There is a solution if and only if $r \ge p$ and the lengths $l$, $s$ and
$R$ are those of a triangle.  The solutions are
$$\theta = \operatorname{atan2}(b, a) - \alpha, \qquad \tan\frac{\alpha}{2} =
\sigma\frac{\sqrt{\mathcal A\mathcal C}}{\sqrt{\mathcal S\mathcal B}}, \qquad \sigma = \pm 1,$$
with $\mathcal S = l + s + R$, $\mathcal A = l + s - R$, $\mathcal B = R + l - s$ and $\mathcal C =
R - l + s$.  Without $\alpha$ this is
$$\theta = \operatorname{atan2}(b\,X - \sigma a\,Y,\ a\,X + \sigma b\,Y), \qquad X = \mathcal
S\mathcal B - \mathcal A\mathcal C, \qquad Y = 2\sqrt{\mathcal S\mathcal A\mathcal B\mathcal
C}.$$""",
    proof=r"""The squared distance of the end from $\mathbf w$ is $p^2$ plus that of its projection
onto the plane.  So the projection is at the distance $s$ from the end of the crank, at $R$ from the
origin, and the crank joins both: a triangle with the sides $l$, $s$ and $R$, whose angle at the
origin is $\alpha$.  The lemma of the two-link triangle gives both of its mirror images.
The half angle says $(\cos\alpha, \sin\alpha) = (X, \sigma Y)/(\mathcal S\mathcal B + \mathcal
A\mathcal C)$, and the vector $(a, b)$ is turned by $-\alpha$.""",
    exception=r"""If $R = 0$, every $\theta$ is a solution if $l = s$, and none otherwise; if $l =
0$, every $\theta$ is one if $s = R$.""",
    rests_on=("two-link triangle",),
)
theorem(
    "line and sphere",
    statement=r"""Let $\mathbf s$ be a unit vector, $m = \mathbf w\cdot\mathbf s$ and $p = |\mathbf
w\times\mathbf s|$.  The point $q\,\mathbf s$ is at the distance $r$ from $\mathbf w$ if and only if
$r \ge p$ and
$$q = m - \sigma\sqrt{r^2 - p^2}, \qquad \sigma = \pm 1.$$""",
    proof=r"""$|\mathbf w - q\,\mathbf s|^2 = (m - q)^2 + p^2$, because $|\mathbf w|^2 = m^2 +
p^2$.  As the product $(r - p)(r + p)$, the radicand loses no digits at the edge of the reach.""",
)
theorem(
    "length of a leg",
    statement=r"""A leg of length $q \ge 0$ from the origin ends at $\mathbf w$ for exactly one $q =
|\mathbf w|$.""",
    proof=r"""Of the two numbers with the square $|\mathbf w|^2$, one is not negative.""",
)


@dataclass(frozen=True)
class Solution:
    """A joint solved for, and the ``rod`` from its near end to its far end, as a vector.

    ``missed`` is the length by which the rod misses a target just outside of the reach of the leg.
    """

    link: Link
    value: sp.Expr
    rod: sp.Matrix
    missed: sp.Expr = sp.S.Zero


class Leg(Protocol):
    """What a loop needs from a leg.  Vectors have as many entries as the space has dimensions."""

    joint: sp.Symbol
    rod: Any
    on_hand: Sequence[Any]

    @property
    def base(self) -> sp.Matrix:
        """The point of the ground from which the near end is seen."""

    @property
    def rate(self) -> sp.Matrix:
        """The derivative of the near end with respect to the joint."""

    @property
    def signs(self) -> int:
        """The number of its working modes."""

    def end(self) -> sp.Matrix:
        """Where the joint brings the near end of the rod."""

    def solve(self, chain: Naming, w: sp.Matrix, sigma: sp.Symbol) -> Solution:
        """The joint, if ``w`` leads from the base of the leg to the far end of the rod."""


def sign_of_leg(k: int) -> sp.Symbol:
    """The sign that tells the two working modes of a leg apart."""
    return real(f"sigma_leg{k}")


def vector(entries: Sequence[Any]) -> sp.Matrix:
    return sp.Matrix([sp.sympify(e, strict=True) for e in entries])


def cross_in_plane(a: sp.Matrix, b: sp.Matrix) -> sp.Expr:
    return a[0] * b[1] - a[1] * b[0]


def turned_left(v: sp.Matrix) -> sp.Matrix:
    """A vector of a plane, turned by a right angle to the left."""
    return sp.Matrix([-v[1], v[0]])


def rotated(v: sp.Matrix, pair: Pair) -> sp.Matrix:
    """A vector of a plane, turned to the left by the angle of a pair."""
    return sp.Matrix([pair.c * v[0] - pair.s * v[1], pair.s * v[0] + pair.c * v[1]])


def closing_weights(vectors: Sequence[sp.Matrix]) -> tuple[sp.Expr, ...]:
    """Factors with which three vectors of a plane add up to zero."""
    return tuple(sp.simplify(cross_in_plane(vectors[k - 2], vectors[k - 1])) for k in range(3))


@dataclass(frozen=True)
class Naming:
    """Names the quantities of one leg in a program; ``size`` is the sum of all lengths.

    The end of the rod may be off by a ``share`` of it.
    """

    program: Program
    size: sp.Expr
    tag: str
    share: sp.Expr = sp.S.Half

    def let(self, name: str, value: sp.Expr, **assumptions: bool) -> sp.Symbol:
        return self.program.let(f"{name}{self.tag}", value, **assumptions)

    def coefficient(self, name: str, value: Any, **assumptions: bool) -> sp.Symbol:
        """A symbol as it is, anything else under a name: a lemma is proved for all its values."""
        value = sp.sympify(value, strict=True)
        return value if value.is_Symbol else self.let(name, value, **assumptions)

    def bound(self, name: str, value: sp.Expr, meaning: str) -> sp.Symbol:
        return self.program.bound(f"{name}{self.tag}", value, self.size * self.share, meaning)

    def half_chord(self, name: str, r: sp.Expr, aside: sp.Expr, meaning: str) -> sp.Symbol:
        """The root of ``r**2 - aside**2``, if ``r`` is long enough, which ``meaning`` says."""
        over = self.bound("over", r - aside, meaning)
        under = self.bound("under", r + aside, meaning)
        return self.let(name, sp.sqrt(over) * sp.sqrt(under), nonnegative=True)

    def lost(self, r: sp.Expr, fore: sp.Expr) -> sp.Symbol:
        """By which factor ``fore``, the part of a rod in a plane, has larger errors than the rod.

        Where the rod is nearly at right angles to the plane, this part has lost digits.
        """
        least = self.size * HALF_DIGITS
        return self.let("lost", sp.Max(1, r / (fore + least)), positive=True)

    def vanishes(self, name: str, value: sp.Expr, meaning: str, free: sp.Symbol) -> sp.Symbol:
        return self.program.vanishes(f"{name}{self.tag}", value, self.size, meaning, (free,))


@dataclass(frozen=True)
class Crank:
    """A crank of some ``length`` that turns about ``pivot`` in the plane of ``along``, ``across``.

    Both are unit vectors, at right angles: the crank points along the first at 0 and along the
    second at 90 degrees.  The rod leads from its end to the point ``on_hand``, as seen from the
    point that is the hand.  Both lengths may be a
    :class:`~closedform.lemmas.parallelogram.Parallelogram`.
    """

    joint: sp.Symbol
    length: Any
    rod: Any
    pivot: Sequence[Any]
    along: Sequence[Any]
    across: Sequence[Any]
    on_hand: Sequence[Any] = ()
    signs: int = 2

    @property
    def base(self) -> sp.Matrix:
        return vector(self.pivot)

    @property
    def rate(self) -> sp.Matrix:
        return self._turned(Pair(sp.cos(self.joint), -sp.sin(self.joint)))

    def rate_at(self, end: sp.Matrix) -> sp.Matrix:
        """The rate, where the near end of the rod is known and the angle is not."""
        u, v, crank = vector(self.along), vector(self.across), end - self.base
        return crank.dot(u) * v - crank.dot(v) * u

    def _turned(self, pair: Pair) -> sp.Matrix:
        length = sp.sympify(self.length, strict=True)
        u, v = vector(self.along), vector(self.across)
        if length.is_number:  # roots of both cancel
            u, v = ((length * w).applyfunc(sp.expand) for w in (u, v))
            return pair.c * u + pair.s * v
        return length * (pair.c * u + pair.s * v)

    def end(self) -> sp.Matrix:
        return self.base + self._turned(Pair(sp.sin(self.joint), sp.cos(self.joint)))

    def named(self, chain: Naming) -> Crank:
        """The same crank with names for lengths that are not symbols, as its lemma has them."""
        length = chain.coefficient("l", self.length, nonnegative=True)
        return replace(self, length=length)

    def solve(self, chain: Naming, w: sp.Matrix, sigma: sp.Symbol) -> Solution:
        p, q = chain.program, self.joint
        l = chain.coefficient("l", self.length, nonnegative=True)
        r = chain.coefficient("r", self.rod, nonnegative=True)
        if r == l:  # the lemma is proved for lengths that do not depend on each other
            r = chain.let("r", r, nonnegative=True)
        u, v = vector(self.along), vector(self.across)
        a, b = chain.let("wu", w.dot(u)), chain.let("wv", w.dot(v))
        normal = u.cross(v) if len(w) == 3 else sp.Matrix()
        aside = chain.let("aside", w.dot(normal)) if len(w) == 3 else sp.S.Zero
        start = len(p.body)
        s: sp.Expr = r
        scale = chain.size * chain.share
        missed, lost = sp.S.Zero, sp.S.One
        if aside != 0:
            s = chain.half_chord("fore", r, aside, "the rod reaches the plane of the crank")
            missed = sp.Max(0, sp.Abs(aside) - r)
            lost = chain.lost(r, s)
            scale = scale * lost
        fore, beside, plainly = s, aside, {}
        if aside != 0:
            plainly[s] = sp.sqrt(r**2 - aside**2)
        if isinstance(self.rod, Extended):  # in the plane it is a rod, which is longer by the links
            links = sp.Add(*self.rod.links)
            s = r = chain.let("reach", links + fore, nonnegative=True)
            plainly[r], aside = links + plainly.pop(fore), sp.S.Zero
            start = len(p.body)
        R = chain.let("R", sp.sqrt(a**2 + b**2), nonnegative=True)
        triangle = Triangle.from_reach(p, (l, s), R, sigma, scale=scale, suffix=chain.tag)
        met = chain.vanishes("met", R, "the rod ends on the axis of the crank", q)
        none: sp.Basic = sp.false
        if not p.explicit(l).is_number:
            none = chain.vanishes("no_crank", l, "the crank has no length", q)
        S, A, B, C = triangle.factors
        ahead = chain.let("ahead", S * B - A * C)
        beyond = chain.let("beyond", 2 * triangle.root, nonnegative=True)
        free = sp.Or(met, none)
        sine = chain.let("sine", choose(free, 0, b * ahead - sigma * a * beyond))
        cosine = chain.let("cosine", choose(free, 1, a * ahead + sigma * b * beyond))
        radius = chain.let("radius", choose(free, 1, R * triangle.width), nonnegative=True)
        share = chain.let("share", l / radius, nonnegative=True)
        away = share * cosine * u + share * sine * v
        lemma = Lemma(
            "crank and rod",
            r"\theta = \operatorname{atan2}(b X - \sigma a Y, a X + \sigma b Y),\quad X = "
            r"\mathcal S\mathcal B - \mathcal A\mathcal C,\ Y = "
            r"2\sqrt{\mathcal S\mathcal A\mathcal B\mathcal C}",
            ((a - l * sp.cos(q)) ** 2 + (b - l * sp.sin(q)) ** 2 + aside**2 - r**2,),
            {q: sp.atan2(sine, cosine)},
            2,
            signs=(sigma,),
            roles=(
                (r"\theta", q),
                *(("l", l), ("r", r), ("a", a), ("b", b)),
                *((("p", sp.Abs(aside)), ("s", s)) if aside != 0 else ()),
            ),
            letters=triangle.letters
            | {ahead: indexed("X", chain.tag), beyond: indexed("Y", chain.tag)}
            | ({s: indexed("s", chain.tag)} if aside != 0 else {}),
            plainly=plainly,
        )
        root = sp.sqrt(r - aside) * sp.sqrt(r + aside)
        case = Degenerate((met,), {a: 0, b: 0, l: root}, q, "a rod ends on the axis of its crank")
        cases: tuple[Degenerate, ...] = (case,)
        if none != sp.false:
            locus = {l: 0, r: sp.sqrt(a**2 + b**2 + aside**2)}
            cases += (Degenerate((none,), locus, q, "a crank has no length"),)
        link = Link((q,), lemma.equations, {}, lemma, tuple(p.body[start:]), degenerate=cases)
        missed -= sp.Min(0, l + s - R, R + l - s, R - l + s) / lost
        rod = w - away
        if isinstance(self.rod, Extended):
            part = chain.let("part", fore / s, nonnegative=True)
            rod = part * (rod - beside * normal) + beside * normal
        return Solution(link, lemma[q], rod, chain.let("missed", missed))


class Slider:
    """Where a slider is: the joint moves it from ``start`` along the unit vector ``direction``."""

    joint: sp.Symbol
    start: Sequence[Any]
    direction: Sequence[Any]

    @property
    def base(self) -> sp.Matrix:
        return vector(self.start)

    @property
    def rate(self) -> sp.Matrix:
        return vector(self.direction)

    def end(self) -> sp.Matrix:
        return self.base + self.joint * self.rate


@dataclass(frozen=True)
class Slide(Slider):
    """A slider that moves from ``start`` along the unit vector ``direction``, at one end of a rod.

    The rod leads to the point ``on_hand``, as seen from the point that is the hand.  It may be a
    :class:`~closedform.lemmas.parallelogram.Parallelogram`.
    """

    joint: sp.Symbol
    rod: Any
    start: Sequence[Any]
    direction: Sequence[Any]
    on_hand: Sequence[Any] = ()
    signs: int = 2

    reaches: ClassVar[str] = "the rod reaches the line of the slider"
    """What has to hold for a solution, in words."""

    def rate_at(self, end: sp.Matrix) -> sp.Matrix:
        return self.rate

    def solve(self, chain: Naming, w: sp.Matrix, sigma: sp.Symbol) -> Solution:
        p, q, s = chain.program, self.joint, self.rate
        r = chain.coefficient("r", self.rod, nonnegative=True)
        given, missed = w, sp.S.Zero
        if isinstance(self.rod, Extended):  # across the axes it is a rod, longer by the links
            n = self.rod.direction
            beside = chain.let("beside", w.dot(n))
            pair = replace(chain, tag=f"_pair{chain.tag}")
            fore = pair.half_chord("fore", r, beside, "the rods reach across the axes")
            lost = chain.lost(r, fore)
            missed = sp.Max(0, sp.Abs(beside) - r)
            r = chain.let("reach", sp.Add(*self.rod.links) + fore, nonnegative=True)
            w, chain = w - beside * n, replace(chain, size=chain.size * lost)
        m = chain.let("m", w.dot(s))
        off = w.cross(s) if len(w) == 3 else sp.Matrix([cross_in_plane(w, s)])
        parts = [e for e in off if e != 0]
        size = sp.sqrt(sum(e**2 for e in parts)) if len(parts) > 1 else sum(parts, sp.S.Zero)
        signed = {} if len(parts) == 1 else {"nonnegative": True}  # False would say negative
        aside = chain.let("aside", size, **signed) if parts else size
        start = len(p.body)
        if parts:
            root = chain.half_chord("root", r, aside, self.reaches)
        else:  # along the line the rod is the half chord itself, whose square would overflow
            root = chain.bound("root", r, self.reaches)
        value = chain.let("slide", m - sigma * root)
        lemma = Lemma(
            "line and sphere",
            r"q = m - \sigma\sqrt{r^2 - p^2}",
            ((m - q) ** 2 + aside**2 - r**2,),
            {q: value},
            2,
            signs=(sigma,),
            roles=(("q", q), ("m", m), ("r", r), ("p", aside)),
            plainly={q: m - sigma * sp.sqrt(r**2 - aside**2)},
        )
        link = Link((q,), lemma.equations, {}, lemma, tuple(p.body[start:]))
        rod, missed = w - value * s, missed + sp.Max(0, sp.Abs(aside) - r)
        if isinstance(self.rod, Extended):
            part = chain.let("part", fore / r, nonnegative=True)
            rod = part * rod + (given - w)
        return Solution(link, value, rod, missed)


@dataclass(frozen=True)
class Stretch:
    """A leg of variable length, the joint, from ``pivot`` to the point ``on_hand``.

    With an ``axis`` it has universal joints at both ends, as a
    :class:`~closedform.lemmas.universal.Universal`.
    """

    joint: sp.Symbol
    pivot: Sequence[Any]
    on_hand: Sequence[Any] = ()
    axis: Sequence[Any] = ()
    signs: int = 1

    @property
    def base(self) -> sp.Matrix:
        return vector(self.pivot)

    @property
    def rod(self) -> sp.Symbol | Universal:
        return Universal(self.joint, self.axis) if self.axis else self.joint

    @property
    def rate(self) -> sp.Matrix:
        return sp.zeros(len(self.pivot), 1)

    def end(self) -> sp.Matrix:
        return self.base

    def solve(self, chain: Naming, w: sp.Matrix, sigma: sp.Symbol) -> Solution:
        q = self.joint
        named = [chain.coefficient(f"w{k}", e) for k, e in enumerate(w, 1)]
        start = len(chain.program.body)
        value = chain.let("leg", sp.sqrt(sum(e**2 for e in named)), nonnegative=True)
        lemma = Lemma(
            "length of a leg",
            r"q = |\mathbf w|",
            (sum(e**2 for e in named) - q**2,),
            {q: value},
            1,
            excluded=1,
            roles=(("q", q), (r"\mathbf w", sp.Matrix(w))),
            letters={value: "q"},
            plainly={value: sp.sqrt(sum(e**2 for e in w))},
        )
        body = tuple(chain.program.body[start:])
        return Solution(Link((q,), lemma.equations, {}, lemma, body), value, w)


@dataclass(frozen=True)
class Strut:
    """A ``rod`` of constant length from the point ``pivot`` of the ground; it has no joint.

    It leads to the point ``on_hand``, as seen from the point that is the hand.
    """

    rod: Any
    pivot: Sequence[Any]
    on_hand: Sequence[Any] = ()

    @property
    def base(self) -> sp.Matrix:
        return vector(self.pivot)

    def end(self) -> sp.Matrix:
        return self.base

    def onto(self, chain: Naming, w: sp.Matrix) -> sp.Matrix:
        """The rod in the direction of ``w``, after a check that ``w`` is as long as the rod.

        So what the check tolerates does not add to what the rods of other legs miss.
        """
        p, rod = chain.program, sp.sympify(self.rod, strict=True)
        length = chain.let("strut", sp.sqrt(sum(e**2 for e in w)), nonnegative=True)
        none = chain.program.vanishes(f"none{chain.tag}", length, chain.size, "no direction")
        p.match(length - rod, chain.size / 2, "the hand is on the sphere of the strut")
        share = chain.let("share", choose(none, 1, rod / length), nonnegative=True)
        return sp.Matrix([chain.let(f"p{i}", share * e) for i, e in zip("xyz", w, strict=True)])


class Carrier:
    """What carries a ``leg`` elsewhere, and has its joint, its lengths and its modes."""

    leg: Crank | Slide | Stretch

    @property
    def joint(self) -> sp.Symbol:
        return self.leg.joint

    @property
    def rod(self) -> Any:
        return self.leg.rod

    @property
    def length(self) -> Any:
        """The length of the crank."""
        return self.leg.length if isinstance(self.leg, Crank) else 0

    @property
    def signs(self) -> int:
        return self.leg.signs


__all__ = [
    "Carrier",
    "Crank",
    "Leg",
    "Naming",
    "Slide",
    "Slider",
    "Solution",
    "Stretch",
    "Strut",
    "closing_weights",
    "cross_in_plane",
    "rotated",
    "sign_of_leg",
    "turned_left",
    "vector",
]
