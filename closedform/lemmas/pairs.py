"""Lemmas that hand an angle on as its sine and cosine.

A joint after the first is found in a frame that the earlier joints have turned.  Only the sines
and cosines of these are needed for it; the angles themselves are taken once, for the output.  Every
pair is normalised by its own numbers, so that it lies on the unit circle to rounding even where a
bound was clamped, and what is built on it stays a rotation.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.sine_cosine import nearly_tangent, root_in_reach
from closedform.lemmas.triangle import heron_factors, triangle_equations
from closedform.model.functions import Program, choose
from closedform.model.lemma import Lemma, label


@dataclass(frozen=True)
class Pair:
    """The sine and the cosine of an angle."""

    s: sp.Expr
    c: sp.Expr

    def __add__(self, other: Pair) -> Pair:
        return Pair(self.s * other.c + self.c * other.s, self.c * other.c - self.s * other.s)

    def __neg__(self) -> Pair:
        return Pair(-self.s, self.c)

    def __sub__(self, other: Pair) -> Pair:
        return self + -other

    @property
    def angle(self) -> sp.Expr:
        return sp.atan2(self.s, self.c)

    def known_as(self, program: Program, label: str) -> Pair:
        """The same pair, named ``s<label>`` and ``c<label>`` in the program."""
        return Pair(program.let(f"s{label}", self.s), program.let(f"c{label}", self.c))

    def instead_of(self, angle: sp.Expr) -> dict[sp.Expr, sp.Expr]:
        """The substitution that puts the pair in the place of the sine and cosine of ``angle``."""
        return {sp.sin(angle): self.s, sp.cos(angle): self.c}


def direction(y: sp.Expr, x: sp.Expr, length: sp.Expr, undefined: sp.Basic = sp.false) -> Pair:
    """The pair of ``atan2(y, x)`` for a vector of the given length; zero where it is undefined."""
    return Pair(choose(undefined, 0, y / length), choose(undefined, 1, x / length))


def amplitude_lemma(x: sp.Symbol, a: sp.Expr, b: sp.Expr, c: sp.Expr, pair: Pair) -> Lemma:
    """``a sin x + b cos x = c``, solved by a pair that was built for either sign."""
    return Lemma(
        "a sin x + b cos x = c",
        r"a\sin x + b\cos x = c \;\Rightarrow\; x = \operatorname{atan2}(a, b) + \sigma\delta,\ "
        r"(\cos\delta, \sin\delta) = \frac{(c, \sqrt{(h - c)(h + c)})}{h},\ h = \sqrt{a^2+b^2}",
        (a * sp.sin(x) + b * sp.cos(x) - c,),
        {x: pair.angle},
        2,
    )


def sine_cosine_pair(
    program: Program,
    x: sp.Symbol,
    a: sp.Expr,
    b: sp.Expr,
    c: sp.Expr,
    sigma: sp.Expr,
    scale: sp.Expr,
    *,
    reach: tuple[sp.Expr, sp.Expr, sp.Expr] | None = None,
    suffix: str = "",
) -> tuple[Lemma, Pair, sp.Expr, sp.Symbol]:
    """``a sin x + b cos x = c`` as in :func:`~closedform.lemmas.sine_cosine.sine_cosine`, by pairs.

    Also returns ``a cos x - b sin x``, the other coordinate of the vector that x turns: it is
    ``-sigma`` times the root of ``(h - c)(h + c)``.  Where ``a = b = c = 0`` the joint x is free;
    the convention is 0, and the flag is returned as well.

    ``reach`` are two links and a height: in the plane that x turns the links have to reach the
    point at this coordinate and height.  Where the root is small, rounding of h changes it by a
    multiple, and links much shorter than c might seem too short.  Of the roots that rounding
    allows, the one within reach is then taken.
    """
    h = program.let(f"amplitude{suffix}", sp.sqrt(a**2 + b**2), nonnegative=True)
    below = program.bound(f"below{suffix}", h - c, scale, "the amplitude is not smaller than c")
    above = program.bound(f"above{suffix}", h + c, scale, "the amplitude is not smaller than -c")
    flag = program.vanishes(f"free_{x.name}", h, scale, f"{x.name} moves nothing", free=(x,))
    root = program.let(f"root{suffix}", sp.sqrt(below * above), nonnegative=True)
    width = program.let(f"width{suffix}", below + above, nonnegative=True)
    if reach is not None:
        tangent = nearly_tangent(program, root, h, suffix)
        held = root_in_reach(program, below * above, h, scale, *reach, suffix=suffix)
        whole = 2 * sp.sqrt(held + (above - below) ** 2 / 4)
        root = program.let(f"ahead{suffix}", choose(tangent, sp.sqrt(held), root), nonnegative=True)
        width = program.let(f"span{suffix}", choose(tangent, whole, width), nonnegative=True)
    turn = Pair(2 * sigma * root / width, (above - below) / width)
    both = Pair(a / h, b / h) + turn
    pair = Pair(choose(flag, 0, both.s), choose(flag, 1, both.c)).known_as(program, label(x))
    return amplitude_lemma(x, a, b, c, pair), pair, -sigma * root, flag


@dataclass(frozen=True)
class LinksAtHeight:
    """Two links that have to reach a point at a ``height``, whose other coordinate a turn gives.

    That is the root of the turn.  Where the root is small, rounding changes it by a multiple, and
    links much shorter than the amplitude might seem too short.
    """

    l1: sp.Expr
    l2: sp.Expr
    height: sp.Expr

    def reached(
        self,
        program: Program,
        bounds: tuple[sp.Expr, sp.Expr],
        of_turn: tuple[sp.Expr, sp.Expr],
        amplitude: sp.Expr,
        scale: sp.Expr,
        suffix: str,
    ) -> tuple[sp.Expr, sp.Expr]:
        """The root and the width of a turn; of the roots that rounding allows one within reach."""
        (below, above), (root, width) = bounds, of_turn
        tangent = nearly_tangent(program, root, amplitude, suffix)
        links = self.l1, self.l2, self.height
        held = root_in_reach(program, below * above, amplitude, scale, *links, suffix=suffix)
        whole = sp.sqrt(4 * held + (above - below) ** 2)
        return (
            program.let(f"kept{suffix}", choose(tangent, sp.sqrt(held), root), nonnegative=True),
            program.let(f"span{suffix}", choose(tangent, whole, width), nonnegative=True),
        )


def triangle_pairs(
    program: Program,
    first: sp.Expr,
    second: sp.Expr,
    reach: sp.Expr,
    elbow: sp.Symbol,
    base: sp.Symbol,
    sigma: sp.Expr,
    scale: sp.Expr,
    *,
    free: tuple[sp.Symbol, sp.Symbol],
    suffix: str = "",
) -> tuple[Lemma, Pair, Pair, sp.Symbol]:
    """The triangle of :func:`~closedform.lemmas.triangle.two_link_triangle`, by pairs.

    With the factors S, A, B, C of Heron's formula

        (cos, sin)(elbow) = (BC - SA, 2 sqrt(SABC)) / (BC + SA),
        (cos, sin)(base)  = (SB - AC, 2 sqrt(SABC)) / (SB + AC).

    ``free`` names the joints of the elbow and of the base.  The first is free where a link has no
    length: the convention is a stretched triangle.  The second is free where the reach is zero;
    this flag, ``folded``, is returned.
    """
    S, A, B, C = heron_factors(program, first, second, reach, scale, suffix=suffix)
    no_link = program.vanishes(
        f"no_link{suffix}", first * second, (first + second) ** 2, "a link is missing", free[:1]
    )
    folded = program.vanishes(f"folded{suffix}", reach, scale, "the links are folded", free[1:])
    products = [program.let(f"{n}{suffix}", v) for n, v in _heron(S, A, B, C).items()]
    SA, BC, SB, AC = products
    root = program.let(f"area{suffix}", 2 * sp.sqrt(SA * BC), nonnegative=True)
    elbows = program.let(f"links{suffix}", SA + BC)
    bases = program.let(f"sides{suffix}", SB + AC)
    at_elbow = Pair(
        choose(no_link, 0, sigma * root / elbows), choose(no_link, 1, (BC - SA) / elbows)
    )
    unturned = sp.Or(no_link, folded)
    at_base = Pair(
        choose(unturned, 0, sigma * root / bases), choose(unturned, 1, (SB - AC) / bases)
    )
    lemma = Lemma(
        "two-link triangle",
        r"(\cos\theta, \sin\theta) = \frac{(BC - SA,\ 2\sigma\sqrt{SABC})}{BC + SA},\quad "
        r"(\cos\alpha, \sin\alpha) = \frac{(SB - AC,\ 2\sigma\sqrt{SABC})}{SB + AC}",
        triangle_equations(first, second, reach, elbow, base),
        {elbow: at_elbow.angle, base: at_base.angle},
        2,
    )
    return lemma, at_elbow, at_base, folded


def _heron(S: sp.Expr, A: sp.Expr, B: sp.Expr, C: sp.Expr) -> dict[str, sp.Expr]:
    return {"SA": S * A, "BC": B * C, "SB": S * B, "AC": A * C}
