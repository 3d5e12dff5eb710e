"""The planar arm of two links with an offset at the fore-arm: alone, and beside another arm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from closedform.lemmas.triangle import square_factors
from closedform.model.functions import Number, Program, choose
from closedform.model.lemma import Lemma


def two_link_arm(
    program: Program,
    lengths: tuple[sp.Expr, sp.Expr, sp.Expr],
    target: tuple[sp.Expr, sp.Expr],
    unknowns: tuple[sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
    *,
    scale: sp.Expr | None = None,
    suffix: str = "",
    free: Sequence[sp.Symbol] = (),
) -> Lemma:
    """A planar arm with a cranked fore-arm, by the triangle of its elbow.

    ``lengths`` are the upper arm l, and of the fore-arm the length a along it and its offset b;
    ``unknowns`` are the absolute angles of both, ``target`` is (r, h):

        l cos(x) + a sin(y) + b cos(y) = r,   l sin(x) - a cos(y) + b sin(y) = h.

    The fore-arm is a link of length sqrt(a^2 + b^2) that lags behind y by atan2(a, b).  Both angles
    turn together where r = h = 0, and one of them is free where a link has no length.  ``scale`` is
    that of what the target may be missed by, if it is not the length of the arm.
    """
    upper, along, across = lengths
    r, h = target
    start = len(program.body)
    second = program.let(f"fore{suffix}", sp.sqrt(along**2 + across**2), nonnegative=True)
    square = program.let(f"square{suffix}", r**2 + h**2, nonnegative=True)
    size = upper + second if scale is None else scale
    squares = square_factors(program, upper, second, square, size, suffix=suffix)
    flags = _degenerate(program, upper, second, sp.Abs(r) + sp.Abs(h), suffix, free)
    return _arm(
        program, lengths, second, target, unknowns, sigma, squares, flags, suffix, start, (1, 0)
    )


def two_link_arm_beside(
    program: Program,
    lengths: tuple[sp.Expr, sp.Expr, sp.Expr],
    second: sp.Symbol,
    target: tuple[sp.Expr, sp.Expr],
    unknowns: tuple[sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
    squares: tuple[sp.Expr, sp.Expr],
    scale: sp.Expr,
    *,
    apart: Number = 0,
    suffix: str = "",
    sided: bool = False,
    free: Sequence[sp.Symbol] = (),
    rest: tuple[Number, Number] = (1, 0),
) -> Lemma:
    """The two-link arm, where another arm knows better than the target how far it is bent.

    As :func:`two_link_arm`, for a fore-arm of length ``second``.  With the reach R the ``squares``
    are N = (l + f)^2 - R^2 and M = R^2 - (l - f)^2, so that tan(elbow / 2) = sqrt(N / M).  Taken
    from the target, N has lost all its digits where the arm is straight, and the elbow half of
    them; an arm nearby gives them without a difference of nearly equal lengths.  M is another
    matter where the end is close to the shoulder, closer than to the end of the other arm: there R
    is short and has all its digits.  ``apart`` is the square of the distance of both ends, which
    tells the one from the other; with zero M is always that of ``squares``.  ``scale`` is that of
    the distance between both, which decides how far the target may be missed.  ``sided`` keeps the
    elbow from being quite straight, so that its side can be read from the answer.  ``rest`` is the
    direction of the upper arm where the end is on the shoulder; the end has seen some roundings, so
    that a multiple of the usual tolerance counts as there.
    """
    upper, along, across = lengths
    r, h = target
    area, squared = (upper + second) * scale, r**2 + h**2
    beside = (upper + second) ** 2 * squared < apart**2
    folding = sp.Piecewise((squared - (upper - second) ** 2, beside), (squares[1], True))
    N, M = (
        program.bound(f"{name}{suffix}", value, area, meaning, positive=sided)
        for name, value, meaning in (
            ("N", squares[0], "nearer than full stretch"),
            ("M", folding, "farther than the fold"),
        )
    )
    start = len(program.body)
    flags = _degenerate(program, upper, second, sp.Abs(r) + sp.Abs(h), suffix, free, roundings=64)
    lemma = _arm(
        program, lengths, second, target, unknowns, sigma, (N, M), flags, suffix, start, rest
    )
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
    elbow: tuple[sp.Expr, sp.Expr],
    *,
    suffix: str = "",
) -> tuple[tuple[sp.Symbol, sp.Symbol], sp.Symbol]:
    """N and M of an arm from cosine and sine of y - x, and the sine of its bend times ``second``.

    N = 2 l (f - f cos(bend)) and M = 2 l (f + f cos(bend)); of f - |..| and f + |..| the smaller
    one is the square of f sin(bend) over the larger one.
    """
    upper, along, across = lengths
    c, s = elbow
    straight = program.let(f"straight{suffix}", along * s + across * c)
    bent = program.let(f"bent{suffix}", across * s - along * c)
    stretched = straight >= 0
    large = program.let(
        f"large{suffix}", second + sp.Piecewise((straight, stretched), (-straight, True))
    )
    small = program.let(f"small{suffix}", bent**2 / large)
    N = program.let(f"N{suffix}", 2 * upper * sp.Piecewise((small, stretched), (large, True)))
    M = program.let(f"M{suffix}", 2 * upper * sp.Piecewise((large, stretched), (small, True)))
    return (N, M), bent


def _degenerate(
    program: Program,
    upper: sp.Expr,
    second: sp.Expr,
    reach: sp.Expr,
    suffix: str,
    free: Sequence[sp.Symbol],
    roundings: int = 1,
) -> tuple[sp.Symbol, sp.Symbol]:
    """The flags of an arm: its end is on the shoulder, or a link has no length."""
    size = upper + second
    return (
        program.vanishes(
            f"folded{suffix}", reach, roundings * size, "the end is on the shoulder", free
        ),
        program.vanishes(f"short{suffix}", upper * second, size**2, "a link has no length", free),
    )


def _arm(
    program: Program,
    lengths: tuple[sp.Expr, sp.Expr, sp.Expr],
    second: sp.Symbol,
    target: tuple[sp.Expr, sp.Expr],
    unknowns: tuple[sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
    squares: tuple[sp.Symbol, sp.Symbol],
    flags: tuple[sp.Symbol, sp.Symbol],
    suffix: str,
    start: int,
    rest: tuple[Number, Number],
) -> Lemma:
    """The lemma of an arm from N and M and the flags of :func:`_degenerate`.

    ``rest`` is the direction of the upper arm where the end is on the shoulder.
    """
    (upper, along, across), (r, h), (x, y), (N, M) = lengths, target, unknowns, squares
    folded, short = flags
    rN, rM = (program.let(f"r{e.name}", sp.sqrt(e), nonnegative=True) for e in (N, M))
    whole = program.let(f"whole{suffix}", N + M)
    bend = (
        program.let(f"c_bend{suffix}", choose(short, 1, (M - N) / whole)),
        program.let(f"s_bend{suffix}", choose(short, 0, 2 * sigma * rN * rM / whole)),
    )
    # 1 + cos(bend) = 2 M / (N + M): without a difference of nearly equal lengths at the fold
    ahead = choose(short, upper + second, upper - second + 2 * second * (M / whole))
    beyond = (program.let(f"ahead_1{suffix}", ahead), second * bend[1])
    out = program.let(f"out{suffix}", r * beyond[0] + h * beyond[1])
    up = program.let(f"up{suffix}", h * beyond[0] - r * beyond[1])
    norm = program.let(f"norm{suffix}", sp.sqrt(out**2 + up**2), nonnegative=True)
    cx = program.let(f"c{x.name}", choose(folded, rest[0], out / norm))
    sx = program.let(f"s{x.name}", choose(folded, rest[1], up / norm))
    size = upper + second
    bare = program.vanishes(f"bare{suffix}", second, size, "the fore-arm has no length")
    lag = (choose(bare, 1, across / second), choose(bare, 0, along / second))
    lag = tuple(program.let(f"{f}_lag{suffix}", e) for f, e in zip("cs", lag, strict=True))
    turn = (bend[0] * lag[0] - bend[1] * lag[1], bend[1] * lag[0] + bend[0] * lag[1])
    turn = tuple(program.let(f"{f}_relative{suffix}", e) for f, e in zip("cs", turn, strict=True))
    cy = program.let(f"c{y.name}", cx * turn[0] - sx * turn[1])
    sy = program.let(f"s{y.name}", sx * turn[0] + cx * turn[1])
    upwards = choose(folded, sp.atan2(rest[1], rest[0]), sp.atan2(up, out))
    elbow = choose(short, 0, 2 * sigma * sp.atan2(rN, rM))
    return Lemma(
        "two-link arm",
        r"l e^{ix} + (b - ia) e^{iy} = r + ih \;\Rightarrow\; x = \operatorname{atan2}(h, r) - "
        r"\alpha,\ y = x + \theta + \operatorname{atan2}(a, b), \text{ with } \theta, \alpha "
        r"\text{ of the two-link triangle}",
        (
            upper * sp.cos(x) + along * sp.sin(y) + across * sp.cos(y) - r,
            upper * sp.sin(x) - along * sp.cos(y) + across * sp.sin(y) - h,
        ),
        {x: upwards, y: upwards + elbow + sp.atan2(lag[1], lag[0])},
        2,
        means={
            name: f(angle)
            for angle, pair in ((x, (cx, sx)), (y, (cy, sy)), (y - x, turn))
            for f, name in zip((sp.cos, sp.sin), pair, strict=True)
        },
        body=tuple(program.body[start:]),
    )
