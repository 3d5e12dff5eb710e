"""Two equations in the sines and cosines of two angles."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.lemmas.registry import theorem
from closedform.model.functions import Bound, Program, choose, sign_of, used_up
from closedform.model.lemma import Lemma

Vector = tuple[sp.Expr, sp.Expr]
theorem(
    "two sines",
    statement=r"""Let $u$, $v$ and $p$ be vectors of the plane with $u \times v \ne 0$.  The
equation $u\sin x + v\sin y = p$ with $\cos x \ge 0$ and $\cos y \ge 0$ has exactly one solution,
$$\sin y = \frac{u \times p}{u \times v}, \qquad \sin x = \frac{u \cdot (p - v\sin y)}{u \cdot u},$$
if both quotients are in $[-1, 1]$, and none otherwise.""",
    proof=r"""The cross product of $u$ with the equation is $(u \times v)\sin y = u \times p$.
With this $\sin y$ the vector $p - v\sin y$ is parallel to $u$, and its scalar product with $u$
gives $\sin x$.  A sine in $[-1, 1]$ and a cosine that is not negative belong to one angle, in
$[-\pi/2, \pi/2]$.  Without the inequalities there are three further solutions, with other signs
of the cosines.""",
    exception=r"""If $u$ and $v$ are parallel, only one combination of the sines is determined.""",
)


PLAY = 32
"""How many times the scale of p the last sine may miss its limit, if both are at theirs."""


def two_sines(
    program: Program,
    unknowns: tuple[sp.Symbol, sp.Symbol],
    vectors: tuple[Vector, Vector],
    p: Vector,
    *,
    scale: sp.Expr,
    free: Sequence[sp.Symbol] = (),
    leniency: sp.Expr = sp.S.One,
) -> Lemma:
    """``u sin x + v sin y = p`` for vectors of the plane, and cosines that are not negative.

    The component of the equation across u gives sin y; the rest along u gives sin x, so that an
    error of y does no harm where u and v are nearly parallel.  There only a few digits of sin y are
    known, and a value is taken for which the rest is not longer than u.  Where they are parallel a
    combination of the sines is free; the convention is that both are equally large, which exists
    whenever any answer does.  The directions of u and v are known to a few units in the last place,
    so that a multiple of the usual tolerance counts as parallel.  Cosines are kept from zero, so
    that their sign can be read from the answer.

    Parameters
    ----------
    program
        the program that the names and bounds are added to
    unknowns
        x and y
    vectors
        u and v
    p
        the right side
    scale
        the natural scale of p, which decides how far the equation may be missed
    free
        the joints that are free where u and v are parallel
    leniency
        how many times farther than usual a sine may miss its limit
    """
    (x, y), (u, v) = unknowns, vectors
    area = program.let("area_uv", u[0] * v[1] - u[1] * v[0])
    sigma = program.let("sigma_uv", sign_of(area))
    start = len(program.body)
    within = leniency * scale
    size = sp.sqrt(u[0] ** 2 + u[1] ** 2)
    size = size if size.is_Symbol else program.let("size_u", size, nonnegative=True)
    aside = program.let("v_across_u", sigma * (u[0] * v[1] - u[1] * v[0]) / size)
    lean = program.let("v_along_u", (u[0] * v[0] + u[1] * v[1]) / size)
    ahead = program.let("p_along_u", (u[0] * p[0] + u[1] * p[1]) / size)
    across = program.let("p_across_u", sigma * (u[0] * p[1] - u[1] * p[0]) / size)
    parallel = program.vanishes(
        "parallel", aside, 64 * sp.Abs(lean), "both vectors are parallel", free
    )
    for name, margin in (("margin_below", aside - across), ("margin_above", aside + across)):
        program.bound(name, margin, within, "a sine is at most 1")
    with_v = sp.Piecewise((ahead, lean >= 0), (-ahead, True))
    whole = program.let("whole_y", choose(parallel, size + sp.Abs(lean), aside))
    part = program.let("part_y", choose(parallel, with_v, across))
    _, sine = _from_sine(program, f"{y}_0", part, whole, scale, play=within)
    rest = program.let("rest", ahead - sine * lean)
    left = program.let("left_along", size - sp.Abs(rest))
    spent = program.vanishes(
        "spent_along", used_up(left), scale, "no margin left: a sine is at most 1"
    )
    loose = sp.Abs(lean) / (aside + sp.Rational(1, 10**9) * size)
    missed = PLAY * within
    allowance = program.let("play_along", missed * (1 + choose(spent, loose, 0)))
    program.bound("kept_along", left, allowance, "a sine is at most 1")
    lacking = left * lean / (lean**2 + aside**2)
    eased = sp.Piecewise((lacking, rest < 0), (-lacking, True))
    # the sine of y starts from a limit that it is beyond, and it stops at a limit
    inside = sp.Max(-whole, sp.Min(whole, part))
    eased = sp.Max(-whole, sp.Min(whole, inside + whole * eased))
    eased = sp.Piecewise((eased, left < 0), (part, True))
    part = program.let("eased", choose(spent, eased, part))
    cy, sy = _from_sine(program, str(y), part, whole, scale, play=within)
    along = program.let("along_u", ahead - sy * lean)
    cx, sx = _from_sine(program, str(x), along, size, scale, play=missed)
    bounds = [s.symbol for s in program.body[start:] if isinstance(s, Bound)]
    return Lemma(
        "two sines",
        r"u\sin x + v\sin y = p,\ \cos x \ge 0,\ \cos y \ge 0 \;\Rightarrow\; "
        r"\sin y = \frac{u \times p}{u \times v},\ "
        r"\sin x = \frac{u \cdot (p - v \sin y)}{u \cdot u}",
        tuple(u[k] * sp.sin(x) + v[k] * sp.sin(y) - p[k] for k in (0, 1)),
        {x: sp.atan2(sx, cx), y: sp.atan2(sy, cy)},
        1,
        excluded=3,
        means={cx: sp.cos(x), sx: sp.sin(x), cy: sp.cos(y), sy: sp.sin(y)},
        body=tuple(program.body[start:]),
        signs=(sigma,),
        roles=tuple((n, sp.Matrix(e)) for n, e in (("u", u), ("v", v), ("p", p))),
        plainly={
            **dict.fromkeys(bounds, sp.S.One),
            **_plainly((x, y), (u, v), p, size, (aside, *bounds[-3:-1])),
        },
    )


def _plainly(
    unknowns: tuple[sp.Symbol, sp.Symbol],
    vectors: tuple[Vector, Vector],
    p: Vector,
    size: sp.Expr,
    names: Sequence[sp.Symbol],
) -> dict[sp.Symbol, sp.Expr]:
    """The angles by arcsines; the names are of v across u, and of a bound for each sine."""
    (x, y), (u, v), (across, for_y, for_x) = unknowns, vectors, names
    whole, part = v[0] * u[1] - v[1] * u[0], p[0] * u[1] - p[1] * u[0]
    along = sum(a * (b - c * sp.sin(y)) for a, b, c in zip(u, p, v, strict=True))
    return {
        across: whole / size,
        for_y: sp.Abs(whole) / size - sp.Abs(part) / size,
        y: sp.asin(part / whole),
        for_x: size - sp.Abs(along) / size,
        x: sp.asin(along / size**2),
    }


def _from_sine(
    program: Program,
    x: str,
    part: sp.Expr,
    whole: sp.Expr,
    scale: sp.Expr,
    *,
    play: sp.Expr,
) -> tuple[sp.Symbol, sp.Symbol]:
    """Cosine and sine of the angle with ``sin x = part / whole`` and a cosine not negative."""
    below, above = (
        program.bound(f"{name}_{x}", value, play, meaning, above=scale + whole)
        for name, value, meaning in (
            ("below", whole - part, "a sine is at most 1"),
            ("above", whole + part, "a sine is at least -1"),
        )
    )
    total = program.let(f"total_{x}", below + above)
    cosine = program.let(f"c_{x}", 2 * sp.sqrt(below) * sp.sqrt(above) / total)
    return cosine, program.let(f"s_{x}", (above - below) / total)
