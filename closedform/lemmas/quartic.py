"""One angle from an equation of degree four, in the sine and the cosine of it and its double."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.algebra.resolvent import Resolvent
from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain, Choice
from closedform.lemmas.links import degenerate
from closedform.lemmas.pairs import any_pair
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.model.functions import Program, choose, real, sign_of
from closedform.model.inverse import Degenerate, Relation
from closedform.model.lemma import Lemma, label
from closedform.model.pair import Pair

POLISHED = 3
"""The number of steps that remove the rounding of a root."""

theorem(
    "resolvent",
    statement=r"""For real $a$, $b$ and $e$ the cubic $(1 - u^2)(u - e) + a^2(1 - u) - b^2(1 + u)$
has a root $u$ with $-1 \le u \le 1$.""",
    proof=r"""At $u = -1$ the cubic is $2 a^2 \ge 0$ and at $u = 1$ it is $-2 b^2 \le 0$.  It is
continuous, so it vanishes in between.""",
)
theorem(
    "quartic in one angle",
    statement=r"""Let $p$ and $q$ not both be zero, $k = \sqrt{p^2 + q^2}$ and $2\eta =
\operatorname{atan2}(q, p)$.  Let
$$A = \frac{a\cos\eta + b\sin\eta}{k}, \qquad B = \frac{b\cos\eta - a\sin\eta}{k}, \qquad E =
\frac{e}{k},$$
let $u$ be a root of the resolvent of $A$, $B$ and $E$ with $-1 < u < 1$, let $\varphi$ be the angle
in $(0, \pi/2)$ with $\cos 2\varphi = u$, and let
$$n_\tau = \frac{A}{2\cos\varphi} - \tau\,\frac{B}{2\sin\varphi}, \qquad \tau = \pm 1.$$
The solutions of $p\cos 2x + q\sin 2x + 2 a\cos x + 2 b\sin x + e = 0$ are
$$x = \eta + \tau\varphi + \sigma\delta_\tau, \qquad (\cos\delta_\tau, \sin\delta_\tau) =
\bigl(-n_\tau, \sqrt{(1 - n_\tau)(1 + n_\tau)}\bigr), \qquad \sigma = \pm 1,$$
for those $\tau$ with $|n_\tau| \le 1$.""",
    proof=r"""With $y = x - \eta$ the equation, divided by $k$, is $\cos 2 y + 2 A\cos y + 2 B\sin y
+ E = 0$.  Twice the product $\bigl(\cos(y - \varphi) + n_1\bigr)\bigl(\cos(y + \varphi) +
n_{-1}\bigr)$ is
$$\cos 2 y + 2\cos\varphi\,(n_1 + n_{-1})\cos y + 2\sin\varphi\,(n_{-1} - n_1)\sin y + u + 2 n_1
n_{-1}.$$
The coefficients of $\cos y$ and $\sin y$ are $2 A$ and $2 B$.  With $2\cos^2\varphi = 1 + u$ and
$2\sin^2\varphi = 1 - u$ the rest is $u + A^2/(1 + u) - B^2/(1 - u)$, which is $E$
because the resolvent vanishes at $u$.  So the equation says that one of the factors is zero, that
is, $\cos(y - \tau\varphi) = -n_\tau$ for $\tau = 1$ or $\tau = -1$.""",
    exception=r"""In the plane of $\cos y$ and $\sin y$ the equation is that of a hyperbola, its
solutions are the points of the hyperbola on the unit circle, and each $\tau$ is a line through two
of these points.  If $u = -1$, then $A = 0$, both lines are parallel to the axis of $\cos y$, and
$(n_1 + n_{-1})^2 = (n_1 - n_{-1})^2 + 2 (E - u)$; if $u = 1$, then $B = 0$, and the lines are
parallel to the other axis.""",
    rests_on=("resolvent",),
)


@dataclass(frozen=True)
class OnCircle:
    """The equation says that a point is on a circle around the origin of its plane.

    The point is linear in the pair of the angle.  If it is far from the origin for most angles, the
    point itself is more accurate than the coefficients of the equation.
    """

    point: Callable[[Pair], sp.Matrix]
    radius: sp.Expr
    square: Callable[[Pair], sp.Expr] | None = None
    """The square of the distance less that of the radius, if there is a more accurate form."""

    def missed(self, program: Program, pair: Pair, tag: str) -> sp.Symbol:
        """The square of the distance of the point from the origin, less that of the radius."""
        r = self.radius
        if self.square is not None:
            return program.let(f"missed_{tag}", self.square(pair))
        x, y = (
            program.let(f"{n}_{tag}", e) for n, e in zip("xy", self.point(pair)[:2], strict=True)
        )
        distance = program.let(f"r_{tag}", sp.sqrt(x**2 + y**2), nonnegative=True)
        return program.let(f"missed_{tag}", (distance - r) * (distance + r))


@chain_lemma("p cos 2x + q sin 2x + 2 a cos x + 2 b sin x + e = 0", "the pair of x")
def quartic(
    chain: Chain,
    x: sp.Symbol,
    coefficients: Sequence[sp.Expr],
    choices: tuple[Choice, Choice],
    means: OnCircle,
    *,
    name: str = "",
) -> Applied:
    """``p cos 2x + q sin 2x + 2 a cos x + 2 b sin x + e = 0``: up to four solutions, on two lines.

    Where two solutions nearly meet, a target that is missed by more than rounding is accepted too;
    compare the target with the result of the chain.  x is free where all coefficients vanish.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    x
        the joint or the auxiliary angle that is solved for
    coefficients
        p, q, a, b and e; if p and q vanish, so must the others
    choices
        the names of the two lines, and those of the two solutions on each
    means
        the meaning of the equation: a point is on a circle
    name
        the name of the sign and what other names end in, by default the number of the joint
    """
    (line, side), program, tag = choices, chain.program, name or label(x)
    signs = chain.sign(f"line_{tag}", line), chain.sign(tag, side)
    letters = zip("pqabe", coefficients, strict=True)
    named = [chain.named(f"{n}_quartic{tag}", value) for n, value in letters]
    free = all(e.free_symbols or e == 0 for e in map(sp.sympify, coefficients[:2]))
    applied = quartic_in(program, x, named, signs, means, tag=tag, may_be_free=free)
    (relation,) = applied.relations
    assert relation.root is not None
    chain.coefficients.add(relation.root)
    return applied


def quartic_in(
    program: Program,
    x: sp.Symbol,
    coefficients: Sequence[sp.Symbol],
    signs: tuple[sp.Symbol, sp.Symbol],
    means: OnCircle,
    *,
    tag: str,
    may_be_free: bool,
) -> Applied:
    """The same in a program that is not a chain.

    Parameters
    ----------
    program
        the program that the names and bounds are added to
    x
        the angle
    coefficients
        names for p, q, a, b and e
    signs
        those of the lines, and of the solutions on each
    means
        the meaning of the equation: a point is on a circle
    tag
        what names end in
    may_be_free
        whether p and q may vanish, with all other coefficients
    """
    (tau, sigma), (p, q, a, b, e) = signs, coefficients
    size = program.let(f"size_{tag}", sp.sqrt(p**2 + q**2), nonnegative=True)
    free: sp.Basic = sp.false
    if may_be_free:
        size, free = _divisor(program, x, size, means.radius, tag)
    half, behind = _half(program, p, q, size, tag)
    A = program.let(f"A_{tag}", (a * half.c + b * half.s) / size)
    B = program.let(f"B_{tag}", (b * half.c - a * half.s) / size)
    E = program.let(f"E_{tag}", e / size)
    u = program.let(f"u_{tag}", Resolvent(A, B, E))
    meaning = "the root of the resolvent is between -1 and 1"
    upper = program.bound(f"upper_{tag}", (1 + u) / 2, sp.S.One, meaning)
    lower = program.bound(f"lower_{tag}", (1 - u) / 2, sp.S.One, meaning)
    left = program.vanishes(f"left_{tag}", u, 0, "the root of the resolvent is not positive")
    over = program.let(f"over_{tag}", choose(left, lower, 1))  # which is not zero
    rest_a = choose(left, B**2 / over, 0) + 2 * (E - u)
    rest_b = choose(left, 0, A**2 / upper) - 2 * (E - u)
    cosine, m, at_a = _part(program, A, (upper, rest_a), u, f"a_{tag}")
    sine, d, at_b = _part(program, B, (lower, rest_b), -u, f"b_{tag}")
    n = program.let(f"n_{tag}", (m - tau * d) / 2)
    # much more than the rounding error of e, a difference of squares, which small terms amplify:
    # the circle decides in the end
    terms = sp.Abs(e) + size + 2 * sp.sqrt(a**2 + b**2) + means.radius**2
    missed = program.let(f"missed_{tag}", 2**16 * terms / size / (2 + sp.Abs(m + tau * d)))
    meaning = "the line meets the unit circle"
    below = program.bound(f"below_{tag}", 1 - n, missed, meaning)
    above = program.bound(f"above_{tag}", 1 + n, missed, meaning)
    width = program.let(f"width_{tag}", below + above, nonnegative=True)
    away = Pair(2 * sigma * sp.sqrt(below) * sp.sqrt(above) / width, (below - above) / width)
    found = (Pair(tau * sine, cosine) + away).known_as(program, f"_line_{tag}")
    beside = cosine * found.c - tau * sine * found.s + (m + tau * d) / 2
    falls = program.let(f"falls_{tag}", sigma * sign_of(beside))
    found = (found + half).known_as(program, f"_{tag}_0")
    for step in range(1, POLISHED + 1):
        found = _polished(program, found, falls, ((p, q, a, b), means), f"{tag}_{step}")
    found = Pair(choose(free, 0, found.s), choose(free, 1, found.c))
    pair = found.known_as(program, label(x))
    names = {pair.s: sp.sin(x), pair.c: sp.cos(x)}
    lemma = Lemma(
        "quartic in one angle",
        r"p\cos 2x + q\sin 2x + 2 a\cos x + 2 b\sin x + e = 0 \;\Rightarrow\; "
        r"x = \eta + \tau\varphi + \sigma\delta_\tau",
        (p * sp.cos(2 * x) + q * sp.sin(2 * x) + 2 * a * sp.cos(x) + 2 * b * sp.sin(x) + e,),
        {x: pair.angle},
        4,
        roles=(("x", x), ("p", p), ("q", q), ("a", a), ("b", b), ("e", e)),
        letters={
            symbol: rf"\bar{{{letter}}}_{{{sp.latex(sp.Symbol(tag))}}}"
            for letter, symbol in zip("pqabe", (p, q, a, b, e), strict=True)
        },
    )
    given = _in_free_symbols((p, q, a, b, e), u)
    t = real("rho")
    cases: list[tuple[tuple[sp.Symbol, ...], dict[sp.Symbol, sp.Expr], str]] = [
        ((behind,), given, "half of the angle is beyond a quarter turn")
    ]
    for flags, at in (((at_a, left), 2 * t**2 - 1), ((at_b,), 1 - 2 * t**2)):
        locus = {n: value.xreplace({u: at}) for n, value in {**given, u: u}.items()}
        cases.append((flags, locus, "the lines are nearly parallel to an axis"))
    none = dict.fromkeys((p, q, a, b, e), sp.S.Zero)
    found_free = degenerate(free, [none], x, f"the point does not depend on {x.name}")
    told = tuple(Degenerate(flags, locus, None, text) for flags, locus, text in cases)
    relation = Relation(Resolvent(A, B, E).law(u), (), f"that {u} is a root", root=u)
    return Applied(lemma, pair, names, given, found_free + told, relations=(relation,))


def _divisor(
    program: Program, x: sp.Symbol, size: sp.Symbol, radius: sp.Expr, tag: str
) -> tuple[sp.Symbol, sp.Symbol]:
    """The size by which others are divided, and a flag: it vanishes, and x is free."""
    meaning = f"the point does not depend on {x.name}"
    free = program.vanishes(f"free_{tag}", size, radius**2, meaning, free=(x,), squares=True)
    return program.let(f"divisor_{tag}", choose(free, 1, size), nonnegative=True), free


def _half(
    program: Program, p: sp.Symbol, q: sp.Symbol, size: sp.Symbol, tag: str
) -> tuple[Pair, sp.Symbol]:
    """The pair of half the angle of the vector (p, q) of this size, and whether p is negative.

    The cosine is not negative, whichever of both is computed first.
    """
    behind = program.vanishes(f"behind_{tag}", p, 0, "p is not positive")
    large = program.let(f"large_{tag}", sp.sqrt((1 + choose(behind, -p, p) / size) / 2))
    small = program.let(f"small_{tag}", q / size / (2 * large))
    sense = sign_of(q)
    pair = Pair(choose(behind, sense * large, small), choose(behind, sense * small, large))
    return pair.known_as(program, f"_half_{tag}"), behind


def _in_free_symbols(coefficients: Sequence[sp.Symbol], u: sp.Symbol) -> dict[sp.Symbol, sp.Expr]:
    """The coefficients whose resolvent has the root u, for any size and half of an angle."""
    p, q, a, b, e = coefficients
    size = sp.Symbol("kappa", positive=True)
    turn = any_pair("tau")
    s, c = turn.s, turn.c
    A, B = a * c + b * s, b * c - a * s
    rest = size * u + (A**2 / (1 + u) - B**2 / (1 - u)) / size
    return {p: size * (c**2 - s**2), q: 2 * size * s * c, e: rest}


def _part(
    p: Program, a: sp.Symbol, squares: tuple[sp.Symbol, sp.Expr], near: sp.Expr, tag: str
) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol]:
    """The root of the first of two ``squares``, a divided by it, and a flag.

    The second is the square of that quotient.  The root of the resolvent determines a small square
    only poorly.  If it is the smaller of the two, it follows from the other, and the flag is true;
    ``near`` is not positive if the square is below 1/2.
    """
    square, rest = squares[0], p.let(f"rest_{tag}", squares[1])
    small = p.vanishes(
        f"small_{tag}", sp.Max(near, square - rest), 0, "the lines are nearly parallel to an axis"
    )
    zero = p.vanishes(f"no_{tag}", sp.Abs(a), 0, "the lines are parallel to an axis")
    long = p.let(f"long_{tag}", choose(zero, 1, a / sp.Abs(a)) * sp.sqrt(sp.Abs(rest)))
    by = p.let(f"by_{tag}", choose(small, long, 1))
    short = p.let(f"root_{tag}", choose(small, a / by, sp.sqrt(square)))
    none = p.vanishes(f"none_{tag}", sp.Abs(short), 0, "the lines are parallel to an axis")
    over = choose(none, 0, a / short)
    return short, p.let(f"over_{tag}", choose(small, long, over)), small


def _polished(
    program: Program,
    found: Pair,
    falls: sp.Symbol,
    equation: tuple[tuple[sp.Symbol, ...], OnCircle],
    tag: str,
) -> Pair:
    """The pair after a step against the rounding error of a root, if the point comes closer.

    The step solves the equation up to second order, so it works also where two roots nearly meet:
    ``falls`` is 1 for the root at which the point enters the circle.
    """
    (p, q, a, b), means = equation
    s, c = found.s, found.c
    missed = means.missed(program, found, f"{tag}a")
    sine, cosine = 2 * s * c, (c - s) * (c + s)
    rate = program.let(f"rate_{tag}", 2 * (q * cosine - p * sine - a * s + b * c))
    bend = program.let(f"bend_{tag}", -4 * (p * cosine + q * sine) - 2 * (a * c + b * s))
    inner = program.let(f"inner_{tag}", rate**2 - 2 * missed * bend)
    apart = program.vanishes(f"apart_{tag}", inner, 0, "the point does not come to the circle")
    outer = rate - falls * sp.sqrt(sp.Max(inner, 0))
    above = program.let(f"above_{tag}s", choose(apart, rate, 2 * missed))
    below = program.let(f"below_{tag}s", choose(apart, bend, outer))
    still = program.vanishes(f"still_{tag}", sp.Abs(below), 0, "the step has no length")
    t = program.let(f"step_{tag}", choose(still, 0, -above / below))
    unit = program.let(f"unit_{tag}", sp.sqrt(1 + t**2), nonnegative=True)
    ahead = (found + Pair(t / unit, 1 / unit)).known_as(program, f"_{tag}a")
    after = means.missed(program, ahead, f"{tag}b")
    closer = program.vanishes(
        f"closer_{tag}",
        sp.Abs(after) - sp.Abs(missed),
        0,
        "the step comes closer to the circle",
    )
    pair = Pair(choose(closer, ahead.s, s), choose(closer, ahead.c, c))
    return pair.known_as(program, f"_{tag}")


__all__ = ["OnCircle", "quartic", "quartic_in"]
