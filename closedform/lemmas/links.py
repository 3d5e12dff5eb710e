"""The lemmas of :mod:`closedform.lemmas` as links of a chain: each returns its joint as a pair.

The first argument is the :class:`~closedform.lemmas.chain.Chain`.  A coefficient is a symbol or a
number; any other expression gets a name, so that the lemma is proved for all its values.  Boundary
and degenerate cases are as in :mod:`closedform.lemmas`: products of differences under the roots,
``atan2`` at the output, a convention where a joint is free.  A case that the numbers of an arm rule
out gets no flag.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.amplitude import Amplitude
from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain, Choice
from closedform.lemmas.pairs import direction
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.lemmas.tangent import ANYWHERE, Goal, Tangency, Turned
from closedform.lemmas.triangle import Triangle
from closedform.model.functions import Let, choose, real
from closedform.model.inverse import Degenerate
from closedform.model.lemma import Lemma, label
from closedform.model.pair import Pair
from closedform.model.tolerances import FLOAT, ROUNDING


def turned(pair: Pair) -> sp.Matrix:
    """The rotation about z by the angle of a pair."""
    return sp.Matrix([[pair.c, -pair.s, 0], [pair.s, pair.c, 0], [0, 0, 1]])


def named(chain: Chain, angle: sp.Symbol, pair: Pair) -> tuple[Pair, dict[sp.Symbol, sp.Expr]]:
    """The pair under the names ``s`` and ``c`` with the number of the joint, and their meanings."""
    names = pair.known_as(chain.program, label(angle))
    return names, {names.s: sp.sin(angle), names.c: sp.cos(angle)}


def differs_from_zero(chain: Chain, value: sp.Expr, scale: sp.Expr) -> bool:
    """Whether a value is a number that is not zero within the tolerance of its scale.

    If the scale contains a parameter, any number may be tiny compared with it.
    """
    numbers = {
        s.symbol: s.value for s in chain.program.body if isinstance(s, Let) and s.value.is_number
    }
    value, scale = (
        sp.sympify(value, strict=True).xreplace(numbers),
        sp.sympify(scale, strict=True).xreplace(numbers),
    )
    if not (value.is_number and scale.is_number):
        return False
    return bool(abs(value) > 2 * sp.Rational(FLOAT.feasibility) * scale)


def vanishing(*coefficients: sp.Expr) -> dict[sp.Symbol, sp.Expr] | None:
    """A flag that all coefficients vanish; None if one is a nonzero number."""
    if any(e.is_number and e != 0 for e in coefficients):
        return None
    return {s: sp.S.Zero for e in coefficients for s in e.free_symbols}


def degenerate(
    flag: sp.Basic,
    loci: Sequence[Mapping[sp.Symbol, sp.Expr] | None],
    free: sp.Symbol | None,
    meaning: str,
) -> tuple[Degenerate, ...]:
    """The degenerate cases of a flag; none if there is no flag or the case cannot occur."""
    if not isinstance(flag, sp.Symbol):
        return ()
    return tuple(Degenerate((flag,), locus, free, meaning) for locus in loci if locus is not None)


@dataclass(frozen=True)
class Facing(Turned):
    """The pair of a joint that turns a vector into a plane, and the coordinate ``ahead`` in it.

    For ``a sin x + b cos x = c`` this is ``a cos x - b sin x``, and it has the sign ``-side``.
    """

    ahead: sp.Expr
    side: sp.Symbol


@chain_lemma("a sin x + b cos x = c", "the pair of x, with `.ahead` and `.side`")
def turn(
    chain: Chain,
    x: sp.Symbol,
    coefficients: Sequence[sp.Expr],
    choice: Choice,
    *,
    toward: Goal = ANYWHERE,
    scale: sp.Expr | None = None,
    name: str = "",
) -> Applied:
    """``a sin x + b cos x = c``: both solutions.  x is free where ``a = b = c = 0``.

    Where both solutions nearly meet, a rounding error of the target turns x by a multiple of that
    error.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    x
        the joint or the auxiliary angle that is solved for
    coefficients
        a, b and c
    choice
        the names of the two solutions, by the sign of the root
    toward
        what later joints have to reach; near a tangent, x is turned such that they do
    scale
        the scale of the error that is allowed in c, by default half the size of the arm
    name
        the name of the sign and what other names end in, by default the number of the joint
    """
    p, tag = chain.program, name or label(x)
    sigma = chain.sign(tag, choice)
    a, b, c = (
        chain.coefficient(f"{n}_turn{tag}", e) for n, e in zip("abc", coefficients, strict=True)
    )
    # half: what is clamped stays well within the round trip that is promised
    missed_by = chain.size / 2 if scale is None else scale
    at = Amplitude.of(p, x, (a, b, c), sigma, scale=lambda _: missed_by, suffix=tag)
    flag: Any = sp.false
    if not any(differs_from_zero(chain, e, chain.size) for e in (a, b, c)):
        flag = p.vanishes(
            f"free{tag}", at.h, chain.size, f"the target is on the axis of {x.name}", free=(x,)
        )
    root = p.let(f"root{tag}", at.root, nonnegative=True)
    width = p.let(f"width{tag}", at.below + at.above, nonnegative=True)
    allowance = 2 * missed_by * ROUNDING
    found = toward.reached(
        Tangency(
            chain=chain, at=at, root=root, width=width, allowance=allowance, suffix=tag, free=flag
        )
    )
    chain.tangent.append(found.tangent)
    pair, means = named(chain, x, found.pair)
    across = a * pair.c - b * pair.s if found.root is None else -sigma * found.root
    ahead = p.let(f"ahead{tag}", across)
    means[ahead] = a * sp.cos(x) - b * sp.sin(x)
    how = (
        r"\sigma\delta,\ (\cos\delta, \sin\delta) = \frac{(c, \sqrt{(h - c)(h + c)})}{h},\ "
        r"h = \sqrt{a^2+b^2}"
    )
    lemma = at.lemma(pair.angle, how)
    if c != 0:  # otherwise the direction is that of (a, b), turned by a quarter
        away = sp.atan2(root, c, evaluate=False)
        told = sp.atan2(a, b, evaluate=False) + sigma * away
        lemma = replace(lemma, plainly={x: choose(flag, 0, told)})
    meaning = f"all coefficients of the equation for {x} vanish; {x} is free, 0 is returned."
    cases = degenerate(flag, [vanishing(a, b, c)], x, meaning)
    facing = Facing(s=pair.s, c=pair.c, lever=root, ahead=ahead, side=sigma)
    return Applied(lemma, facing, means, {}, cases)


theorem(
    "two-link arm",
    statement=r"""Let $u(\lambda) = (\cos\lambda, \sin\lambda)$, $l_1, l_2 > 0$ and $(x, y) \ne 0$.
With $r = \sqrt{x^2 + y^2}$ and the factors $\mathcal S = l_1 + l_2 + r$, $\mathcal A = l_1 + l_2 -
r$, $\mathcal B = r + l_1 - l_2$ and $\mathcal C = r - l_1 + l_2$ of the triangle with these sides,
the equation $l_1 u(\lambda) + l_2 u(\lambda + \mu) = (x, y)$ has a solution if and only if
$\mathcal A$, $\mathcal B$ and $\mathcal C$ are not negative.  The solutions are
$$(\cos\mu, \sin\mu) = \frac{(\mathcal B\mathcal C - \mathcal S\mathcal A,\
2\sigma\sqrt{\mathcal S\mathcal A\mathcal B\mathcal C})}{\mathcal B\mathcal C + \mathcal S\mathcal
A}, \qquad \lambda = \operatorname{atan2}(y, x) - \alpha,$$
$$(\cos\alpha, \sin\alpha) = \frac{(\mathcal S\mathcal B - \mathcal A\mathcal C,\
2\sigma\sqrt{\mathcal S\mathcal A\mathcal B\mathcal C})}{\mathcal S\mathcal B + \mathcal A\mathcal
C}, \qquad \sigma = \pm 1.$$
A cranked second link, in the complex plane $(b - i a)\, e^{i\nu}$ instead of $l_2 e^{i(\lambda +
\mu)}$, is a straight one: $l_2 = \sqrt{a^2 + b^2}$ and $\lambda + \mu = \nu -
\operatorname{atan2}(a, b)$.""",
    proof=r"""Turn the plane by $-\lambda$: the first link is then at the angle $0$, the second at
$\mu$, and $(x, y)$ at $\alpha = \operatorname{atan2}(y, x) - \lambda$.  These are the
equations of the two-link triangle.  Its tangents of half angles are those of the stated sines and
cosines, by $(\cos\mu, \sin\mu) = (1 - t^2,\ 2 t)/(1 + t^2)$ with $t = \tan(\mu/2)$,
and likewise for $\alpha$.  For the cranked link, $b - i a = \sqrt{a^2 + b^2}\,
e^{-i\operatorname{atan2}(a, b)}$.""",
    exception=r"""If $(x, y) = 0$, which needs $l_1 = l_2$, the arm is folded and $\lambda$ is
free.  If a link has no length, $\mu$ is free, and a stretched arm is returned.""",
    rests_on=("two-link triangle",),
)


@chain_lemma("l1 u(x1) + l2 u(x1 + x2) = (x, y)", "both pairs")
def two_links(
    chain: Chain,
    unknowns: tuple[sp.Symbol, sp.Symbol],
    target: Sequence[sp.Expr],
    lengths: tuple[sp.Expr, sp.Expr],
    choice: Choice,
    *,
    scale: sp.Expr | None = None,
    mirrored: sp.Expr = sp.S.One,
    name: str = "elbow",
) -> Applied:
    """The planar two-link arm: ``l1 u(first) + l2 u(first + second) = (x, y)``, two elbows.

    ``u`` is the unit vector at an angle.  With the factors S, A, B, C of Heron's formula

        (cos, sin)(second) = (BC - SA, 2 sigma sqrt(SABC)) / (BC + SA),

    and first is the direction of (x, y) minus the angle at the base of the triangle.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    unknowns
        the angles that are solved for: first, and second, which is counted from the first link
    target
        x and y
    lengths
        l1 and l2
    choice
        the names of the two elbows, by the sign of sin(second)
    scale
        the size of the terms whose differences x and y are, by default that of the whole arm
    mirrored
        a sign that multiplies that of the elbow, for example the side of an earlier turn, which
        mirrors the plane
    name
        the name of the sign, and what other names end in
    """
    p, scale = chain.program, chain.size if scale is None else scale
    (first, second), (x, y), (l1, l2) = unknowns, target, lengths
    sigma = mirrored * chain.sign(name, choice)
    for length in lengths:
        if length.is_negative:
            raise ShapeError(
                f"{chain.d.name}: the two-link arm for {first} and {second} has the length "
                f"{length}; give it as positive, and add pi to the angle of that link"
            )
    at_zero = [l1 - l2, x, y]
    x, y = (e if e.is_Symbol else chain.named(f"{n}_{name}", e) for n, e in (("x", x), ("y", y)))
    l1, l2 = (
        chain.coefficient(f"l{i}_{name}", e, nonnegative=True) for i, e in enumerate((l1, l2), 1)
    )
    r = p.let(f"r_{name}", sp.sqrt(x**2 + y**2), nonnegative=True)
    # half: what is clamped stays well within the round trip that is promised
    triangle = Triangle.from_reach(p, (l1, l2), r, sigma, scale=scale / 2, suffix=f"_{name}")
    no_link: Any = sp.false
    if not differs_from_zero(chain, l1 * l2, (l1 + l2) ** 2):
        no_link = p.vanishes(
            f"no_link_{name}", l1 * l2, (l1 + l2) ** 2, "a link has no length", free=(second,)
        )
    folded: Any = sp.false
    if not any(differs_from_zero(chain, e, scale) for e in at_zero):
        folded = p.vanishes(
            f"folded_{name}", r, scale, f"the arm ends on the axis of {first}", free=(first,)
        )
    twice = p.let(f"area_{name}", 2 * triangle.root, nonnegative=True)
    whole = p.let(f"sum_{name}", triangle.whole, nonnegative=True)
    width = p.let(f"width_{name}", triangle.width, nonnegative=True)
    at_elbow, at_base = triangle.elbow_pair(twice, whole), triangle.base_pair(twice, width)
    bent = Pair(choose(no_link, 0, at_elbow.s), choose(no_link, 1, at_elbow.c))
    bend, means = named(chain, second, bent)
    unturned = sp.Or(no_link, folded)
    off = Pair(choose(unturned, 0, at_base.s), choose(unturned, 1, at_base.c))
    bearing = direction(y, x, r, folded)
    lift, more = named(chain, first, bearing - off.known_as(p, f"_base_{name}"))
    lemma = Lemma(
        "two-link arm",
        r"l_1 u(\lambda) + l_2 u(\lambda + \mu) = (x, y),\ u(\lambda) = (\cos\lambda, \sin\lambda) "
        r"\;\Rightarrow\; "
        r"(\cos\mu, \sin\mu) = \frac{(\mathcal B\mathcal C - \mathcal S\mathcal A,\ "
        r"2\sigma\sqrt{\mathcal S\mathcal A\mathcal B\mathcal C})}"
        r"{\mathcal B\mathcal C + \mathcal S\mathcal A},\ "
        r"\lambda = \operatorname{atan2}(y, x) - \alpha,\quad "
        r"(\cos\alpha, \sin\alpha) = \frac{(\mathcal S\mathcal B - \mathcal A\mathcal C,\ "
        r"2\sigma\sqrt{\mathcal S\mathcal A\mathcal B\mathcal C})}"
        r"{\mathcal S\mathcal B + \mathcal A\mathcal C}",
        (
            l1 * sp.cos(first) + l2 * sp.cos(first + second) - x,
            l1 * sp.sin(first) + l2 * sp.sin(first + second) - y,
        ),
        {first: lift.angle, second: bend.angle},
        2,
        roles=(
            ("l_1", l1),
            ("l_2", l2),
            (r"\lambda", first),
            (r"\mu", second),
            ("x", x),
            ("y", y),
        ),
        letters=triangle.letters,
    )
    meaning = f"equal links folded onto the axis of {first}, which is free; 0 is returned."
    cases = degenerate(folded, [_folded(x, y, l1, l2)], first, meaning)
    meaning = f"a link without length: {second} is free, 0 is returned."
    cases += degenerate(no_link, _stretched(x, y, l1, l2), second, meaning)
    return Applied(lemma, (lift, bend), means | more, {}, cases)


def _folded(
    x: sp.Symbol, y: sp.Symbol, l1: sp.Expr, l2: sp.Expr
) -> dict[sp.Symbol, sp.Expr] | None:
    """The case of equal links that end where they begin; None for different numbers."""
    end = {x: sp.S.Zero, y: sp.S.Zero}
    if l1 == l2:
        return end
    if l2.is_Symbol:
        return end | {l2: l1}
    return end | {l1: l2} if l1.is_Symbol else None


def _stretched(
    x: sp.Symbol, y: sp.Symbol, l1: sp.Expr, l2: sp.Expr
) -> list[dict[sp.Symbol, sp.Expr]]:
    """The case of either link without length, and the other in any direction."""
    u = real("beta")
    return [
        {x: (l1 + l2 - gone) * sp.cos(u), y: (l1 + l2 - gone) * sp.sin(u), gone: sp.S.Zero}
        for gone in dict.fromkeys((l1, l2))
        if gone.is_Symbol and l1 != l2
    ]


theorem(
    "polar coordinates",
    statement=r"""Let $u(\theta) = (\cos\theta, \sin\theta)$ and $(x, y) \ne 0$.  The equation
$\rho\,u(\theta) = (x, y)$ has two solutions with $\theta$ in $(-\pi, \pi]$: for $\sigma = \pm 1$,
$\rho = \sigma\sqrt{x^2 + y^2}$ and $\theta = \operatorname{atan2}(\sigma y, \sigma x)$.  One of
them has $\rho > 0$.""",
    proof=r"""The squares of both sides say $\rho^2 = x^2 + y^2$.  For either sign of $\rho$ the
unit vector $u(\theta)$ is $(x, y)/\rho$, whose angle is $\operatorname{atan2}(\sigma y, \sigma
x)$.""",
    exception=r"""If $x = y = 0$, then $\rho = 0$ and $\theta$ is free.""",
)


def polar_lemma(
    solution: Mapping[sp.Symbol, sp.Expr],
    target: Sequence[sp.Expr],
    count: int = 1,
    sign: str = "",
) -> Lemma:
    """The lemma for an angle and a length, in this order, of which ``count`` pairs are found.

    ``sign`` is how the statement writes that of the length.
    """
    (angle, length), (x, y) = solution, target
    space = " " if sign else ""
    return Lemma(
        "polar coordinates",
        r"\rho\cos\theta = x,\ \rho\sin\theta = y \;\Rightarrow\; "
        rf"\rho = {sign}\sqrt{{x^2 + y^2}},\ "
        rf"\theta = \operatorname{{atan2}}({sign}{space}y, {sign}{space}x)",
        (length * sp.cos(angle) - x, length * sp.sin(angle) - y),
        dict(solution),
        count,
        excluded=2 - count,
        roles=((r"\rho", length), (r"\theta", angle), ("x", x), ("y", y)),
    )


@chain_lemma("r u(x) = (x, y)", "the pair of x, and r")
def polar(
    chain: Chain,
    angle: sp.Symbol,
    length: sp.Symbol,
    target: Sequence[sp.Expr],
    choice: Choice | None,
    *,
    name: str = "side",
) -> Applied:
    """``length u(angle) = (x, y)``: the length has either sign, or with no ``choice`` is positive.

    The angle is free where the length vanishes.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    angle
        the joint or the auxiliary angle that is solved for
    length
        the prismatic joint or the auxiliary length that is solved for
    target
        x and y
    choice
        the names of the two solutions, by the sign of the length; None if it is positive
    name
        the name of the sign, and what other names end in
    """
    p = chain.program
    sigma = chain.sign(name, choice) if choice else sp.S.One
    x, y = (chain.coefficient(f"{n}_{name}", e) for n, e in zip("xy", target, strict=True))
    r = p.let(f"r_{name}", sp.sqrt(x**2 + y**2), nonnegative=True)
    flag: Any = sp.false
    if not any(differs_from_zero(chain, e, chain.size) for e in (x, y)):
        flag = p.vanishes(
            f"on_axis_{name}", r, chain.size, f"the target is on the axis of {angle}", (angle,)
        )
    pair, means = named(chain, angle, direction(sigma * y, sigma * x, r, flag))
    value = p.let(f"{length.name}_{name}", sigma * r)
    solution = {angle: pair.angle, length: value}
    lemma = polar_lemma(solution, (x, y), 2 if choice else 1, r"\sigma")
    meaning = f"the target is on the axis of {angle}; {angle} is free, 0 is returned."
    cases = degenerate(flag, [vanishing(x, y)], angle, meaning)
    return Applied(lemma, (pair, value), means | {value: length}, {}, cases)


theorem(
    "slide",
    statement="The equation $d = c$ has exactly one solution, $d = c$.",
    proof=r"""A prismatic joint along the direction of a coordinate moves the hand by as much as
it is extended; nothing has to be solved.""",
)


@chain_lemma("d = value", "the value")
def slide(chain: Chain, joint: sp.Symbol, value: sp.Expr) -> Applied:
    """``joint = value``: a prismatic joint along the direction of a coordinate."""
    if value.is_Symbol and value.name not in chain.d.written:
        chain.d.write(value, same=joint.name)  # such as d3_, which is written like d3
    roles = (("d", joint), ("c", value))
    lemma = Lemma("slide", r"d = c", (joint - value,), {joint: value}, 1, roles=roles)
    return Applied(lemma, value)


theorem(
    "remaining angle",
    statement=r"""Let $\mu$ and $\nu$ be given by their sines and cosines.  In $(-\pi, \pi]$
exactly one $\lambda$ has $\lambda + \nu = \mu$ up to whole turns,
$$\lambda = \operatorname{atan2}(\sin\mu\cos\nu - \cos\mu\sin\nu,\
\cos\mu\cos\nu + \sin\mu\sin\nu).$$""",
    proof=r"""By the addition theorems the arguments are $\sin(\mu - \nu)$ and $\cos(\mu -
\nu)$.  Angles with the same sine and cosine differ by whole turns, and one of them is in
$(-\pi, \pi]$.""",
)


@chain_lemma("x = value", "the angle")
def remainder(chain: Chain, joint: sp.Symbol, total: sp.Expr) -> Applied:
    """``joint = total``, an angle: what remains of an angle of the target after the earlier joints.

    It is computed from the sine and the cosine of the sum, so it needs no reduction.
    """
    total = chain.by_angles(total)
    pair = chain.pair_of(total)
    if pair is None:
        raise ShapeError(
            f"{chain.d.name}: the lemma 'remaining angle' cannot read {joint} from {total}: it "
            f"needs a sum of solved angles and angles of the target, each of them once"
        )
    lemma = Lemma(
        "remaining angle",
        r"\lambda = \mu - \nu",
        (sp.cos(joint) - sp.cos(total), sp.sin(joint) - sp.sin(total)),
        {joint: pair.angle},
        1,
        roles=((r"\lambda", joint), (r"\mu - \nu", total)),
    )
    return Applied(lemma, total, {}, dict(chain.meaning))
