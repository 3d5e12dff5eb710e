"""The planar arm of two links with an offset at the forearm: alone, and next to another arm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from closedform.lemmas.triangle import FARTHER, NEARER, Triangle
from closedform.model.functions import Program, choose, real
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair

LEVEL = Pair(sp.S.Zero, sp.S.One)
"""The direction of an upper arm where nothing else determines it."""


Vector = tuple[sp.Expr, sp.Expr]


def two_link_arm(
    program: Program,
    lengths: tuple[sp.Expr, sp.Expr, sp.Expr],
    target: Vector,
    unknowns: tuple[sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
    *,
    scale: sp.Expr | None = None,
    suffix: str = "",
    free: Sequence[sp.Symbol] = (),
) -> Lemma:
    """A planar arm with a cranked fore-arm, by the triangle of its elbow.

        l cos(x) + a sin(y) + b cos(y) = r,   l sin(x) - a cos(y) + b sin(y) = h.

    The fore-arm is a link of length sqrt(a^2 + b^2) that lags behind y by atan2(a, b).  Both angles
    turn together where r = h = 0, and one of them is free where a link has no length.

    Parameters
    ----------
    program
        the program that the names and bounds are added to
    lengths
        the upper arm l, and of the fore-arm the length a along it and its offset b
    target
        r and h
    unknowns
        the absolute angles x and y of both
    sigma
        the sign of the elbow
    scale
        that of what the target may be missed by, by default the length of the arm
    suffix
        what the names end in
    free
        the joints that are free in a degenerate case
    """
    upper, along, across = lengths
    start = len(program.body)
    second = program.let(f"fore{suffix}", sp.sqrt(along**2 + across**2), nonnegative=True)
    square = program.let(f"square{suffix}", target[0] ** 2 + target[1] ** 2, nonnegative=True)
    triangle = Triangle.from_square(
        program, (upper, second), square, sigma, scale=scale, suffix=suffix
    )
    return _Arm(program, lengths, target, unknowns, triangle, suffix).lemma(start, free)


def two_link_arm_beside(
    program: Program,
    lengths: tuple[sp.Expr, sp.Expr, sp.Expr],
    target: Vector,
    unknowns: tuple[sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
    *,
    second: sp.Symbol,
    squares: Vector,
    scale: sp.Expr,
    suffix: str = "",
    sided: bool = False,
    free: Sequence[sp.Symbol] = (),
    rest: Pair = LEVEL,
) -> Lemma:
    """The two-link arm whose bend another arm gives more accurately than the target.

    If the arm is straight, the N of its triangle, computed from the target, has lost all its
    digits, and the elbow half of them.  An arm nearby gives N and M without a difference of nearly
    equal lengths.

    Parameters
    ----------
    program, lengths, target, unknowns, sigma, suffix, free
        as of :func:`two_link_arm`
    second
        the length of the fore-arm
    squares
        N and M, see :class:`~closedform.lemmas.triangle.Triangle`
    scale
        the scale of the distance of both ends, which decides how far the target may be missed
    sided
        whether the elbow is kept from being quite straight, so that its side can be read from the
        answer
    rest
        the direction of the upper arm where the end is on the shoulder.  The end has seen some
        roundings, so a multiple of the usual tolerance counts as there.
    """
    upper, along, across = lengths
    area, squared = (upper + second) * scale, target[0] ** 2 + target[1] ** 2
    N, M = (
        program.bound(
            f"{name}{suffix}", value, area, meaning, above=upper * second if sided else None
        )
        for name, value, meaning in zip("NM", squares, (NEARER, FARTHER), strict=True)
    )
    start = len(program.body)
    triangle = Triangle(upper, second, sigma, N, M)
    lemma = _Arm(program, lengths, target, unknowns, triangle, suffix).lemma(start, free, rest, 64)
    premises = {
        second: sp.sqrt(along**2 + across**2),
        N: (upper + second) ** 2 - squared,
        M: squared - (upper - second) ** 2,
    }
    return replace(lemma, premises=premises)


def elbow_squares(
    program: Program,
    lengths: tuple[sp.Expr, sp.Expr, sp.Expr],
    second: sp.Symbol,
    elbow: Pair,
    *,
    suffix: str = "",
) -> tuple[tuple[sp.Symbol, sp.Symbol], sp.Symbol]:
    """N and M of an arm from the pair of y - x, and the sine of its bend times ``second``.

    N = 2 l (f - f cos(bend)) and M = 2 l (f + f cos(bend)); of f - |..| and f + |..| the smaller
    one is the square of f sin(bend) over the larger one.
    """
    upper, along, across = lengths
    straight = program.let(f"straight{suffix}", along * elbow.s + across * elbow.c)
    bent = program.let(f"bent{suffix}", across * elbow.s - along * elbow.c)
    stretched = straight >= 0
    large = program.let(
        f"large{suffix}", second + sp.Piecewise((straight, stretched), (-straight, True))
    )
    small = program.let(f"small{suffix}", bent**2 / large)
    N = program.let(f"N{suffix}", 2 * upper * sp.Piecewise((small, stretched), (large, True)))
    M = program.let(f"M{suffix}", 2 * upper * sp.Piecewise((large, stretched), (small, True)))
    return (N, M), bent


@dataclass(frozen=True)
class _Arm:
    """An arm whose triangle is known."""

    program: Program
    lengths: tuple[sp.Expr, sp.Expr, sp.Expr]
    target: Vector
    unknowns: tuple[sp.Symbol, sp.Symbol]
    triangle: Triangle
    suffix: str

    def let(self, name: str, value: sp.Expr, **assumptions: bool) -> sp.Symbol:
        return self.program.let(f"{name}{self.suffix}", value, **assumptions)

    def vanishes(
        self,
        name: str,
        value: sp.Expr,
        scale: sp.Expr,
        meaning: str,
        free: Sequence[sp.Symbol] = (),
    ) -> sp.Symbol:
        return self.program.vanishes(f"{name}{self.suffix}", value, scale, meaning, free)

    def lemma(
        self, start: int, free: Sequence[sp.Symbol], rest: Pair = LEVEL, roundings: int = 1
    ) -> Lemma:
        """The lemma, whose statements begin at ``start``.

        ``roundings`` multiplies the tolerance within which the end is on the shoulder.
        """
        (r, h), (x, y) = self.target, self.unknowns
        upper, second = self.triangle.first, self.triangle.second
        size, reach = upper + second, sp.Abs(r) + sp.Abs(h)
        folded = self.vanishes(
            "folded", reach, roundings * size, "the end is on the shoulder", free
        )
        short = self.vanishes("short", upper * second, size**2, "a link has no length", free)
        bend, elbow, share = self._elbow(short)
        # 1 + cos(bend) = 2 M / (N + M): without a difference of nearly equal lengths at the fold
        ahead = choose(short, size, upper - second + 2 * second * share)
        beyond = (self.let("ahead_1", ahead), second * bend.s)
        out = self.let("out", r * beyond[0] + h * beyond[1])
        up = self.let("up", h * beyond[0] - r * beyond[1])
        norm = self.let("norm", sp.sqrt(out**2 + up**2), nonnegative=True)
        cx = self.program.let(f"c{x.name}", choose(folded, rest.c, out / norm))
        sx = self.program.let(f"s{x.name}", choose(folded, rest.s, up / norm))
        lag = self._lag()
        turn = bend + lag
        turn = Pair(c=self.let("c_relative", turn.c), s=self.let("s_relative", turn.s))
        fore = Pair(sx, cx) + turn
        cy, sy = self.program.let(f"c{y.name}", fore.c), self.program.let(f"s{y.name}", fore.s)
        upwards = choose(folded, rest.angle, sp.atan2(up, out))
        _, along, across = self.lengths
        return Lemma(
            "two-link arm",
            r"l_1 e^{i\lambda} + (b - ia) e^{i\nu} = x + iy \;\Rightarrow\; "
            r"\lambda = \operatorname{atan2}(y, x) - \alpha,\ "
            r"\nu = \lambda + \mu + \operatorname{atan2}(a, b)",
            (
                upper * sp.cos(x) + along * sp.sin(y) + across * sp.cos(y) - r,
                upper * sp.sin(x) - along * sp.cos(y) + across * sp.sin(y) - h,
            ),
            {x: upwards, y: upwards + elbow + lag.angle},
            2,
            means={
                name: f(angle)
                for angle, pair in ((x, Pair(sx, cx)), (y, Pair(sy, cy)), (y - x, turn))
                for f, name in ((sp.cos, pair.c), (sp.sin, pair.s))
            },
            body=tuple(self.program.body[start:]),
            signs=(self.triangle.sigma,),
            roles=tuple(
                zip(
                    (r"\lambda", r"\nu", "l_1", "a", "b", "x", "y"),
                    (x, y, upper, *self.lengths[1:], r, h),
                    strict=True,
                ),
            ),
            plainly=self._plainly(folded, rest, elbow),
        )

    def _plainly(self, folded: sp.Symbol, rest: Pair, elbow: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
        """The angles of the triangle, and those of the links."""
        (r, h), (x, y) = self.target, self.unknowns
        _, along, across = self.lengths
        upper, second = self.triangle.first, self.triangle.second
        bend = real(f"bend_angle{self.suffix}")
        base = sp.atan2(second * sp.sin(bend), upper + second * sp.cos(bend))
        return {
            bend: elbow,
            x: choose(folded, rest.angle, sp.atan2(h, r) - base),
            y: x + bend + sp.atan2(along, across),
        }

    def _elbow(self, short: sp.Symbol) -> tuple[Pair, sp.Expr, sp.Expr]:
        """The pair and the angle of the elbow, and half of one plus its cosine."""
        at = self.triangle
        rN, rM = (
            self.program.let(f"r{e.name}", sp.sqrt(e), nonnegative=True) for e in (at.N, at.M)
        )
        whole = self.let("whole", at.whole)
        found = at.elbow_pair(2 * rN * rM, whole)
        bend = Pair(
            c=self.let("c_bend", choose(short, 1, found.c)),
            s=self.let("s_bend", choose(short, 0, found.s)),
        )
        return bend, choose(short, 0, 2 * at.sigma * sp.atan2(rN, rM)), at.M / whole

    def _lag(self) -> Pair:
        """The pair of the angle by which the fore-arm lags behind; zero without a fore-arm."""
        upper, along, across = self.lengths
        second = self.triangle.second
        bare = self.vanishes("bare", second, upper + second, "the fore-arm has no length")
        return Pair(
            c=self.let("c_lag", choose(bare, 1, across / second)),
            s=self.let("s_lag", choose(bare, 0, along / second)),
        )


__all__ = ["elbow_squares", "two_link_arm", "two_link_arm_beside"]
