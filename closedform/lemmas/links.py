"""The lemmas of :mod:`closedform.lemmas` as links of a chain: each hands its joint on as a pair.

The first argument is the :class:`~closedform.lemmas.chain.Chain`.  A coefficient is a symbol or a
number; any other expression gets a name, so that the lemma is proved for all its values.  Boundary
and degenerate cases are as in :mod:`closedform.lemmas`: products of differences under the roots,
``atan2`` at the output, a convention where a joint is free.  A case that the numbers of an arm rule
out gets no flag.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.algebra.solutions import rotation_parametrisation
from closedform.lemmas.amplitude import Amplitude
from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain, Choice
from closedform.lemmas.pairs import direction
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.lemmas.tangent import ROUNDING, Anywhere, Goal, Offset, Tangency, Turned
from closedform.lemmas.triangle import Triangle
from closedform.lemmas.zyz import zyz_angles, zyz_lemma
from closedform.model.functions import Let, choose, real
from closedform.model.inverse import Degenerate
from closedform.model.lemma import Lemma, label
from closedform.model.pair import Pair
from closedform.model.tolerances import FLOAT

_ROUNDINGS = 16
"""How far a wrist may be from aligned to count as such, in units of the rounding of the target.

This covers the rounding that an arm adds to the rotation of its wrist, and it turns the hand by
3e-14 at most.  Of random postures of a Puma whose wrist is exactly aligned, 98 of 100 are
recognised; in the others the returned angles are right as well.
"""

ANYWHERE = Anywhere()


def turned(pair: Pair) -> sp.Matrix:
    """The rotation about z by the angle of a pair."""
    return sp.Matrix([[pair.c, -pair.s, 0], [pair.s, pair.c, 0], [0, 0, 1]])


def named(chain: Chain, angle: sp.Symbol, pair: Pair) -> tuple[Pair, dict[sp.Symbol, sp.Expr]]:
    """The pair under the names ``s`` and ``c`` with the number of the joint, and their meanings."""
    names = pair.known_as(chain.program, label(angle))
    return names, {names.s: sp.sin(angle), names.c: sp.cos(angle)}


def differs_from_zero(chain: Chain, value: sp.Expr, scale: sp.Expr) -> bool:
    """Whether a value is a number that no tolerance takes for zero on its scale, also a number.

    If the scale contains a parameter, a number may be arbitrarily small beside it.
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
    a: sp.Expr,
    b: sp.Expr,
    c: sp.Expr,
    choice: Choice,
    *,
    toward: Goal = ANYWHERE,
    scale: sp.Expr | None = None,
    name: str = "",
) -> Applied:
    """``a sin x + b cos x = c``: both solutions.  x is free where ``a = b = c = 0``.

    Where both solutions nearly meet, a rounding of the target turns x by a multiple of it.
    ``toward`` says what later joints have to reach; there, x is turned such that they do.
    ``scale`` is the scale of the error that is allowed in c, by default half the size of the arm.
    """
    p, tag = chain.program, name or label(x)
    sigma = chain.sign(tag, choice)
    a, b, c = (
        chain.coefficient(f"{n}_turn{tag}", e) for n, e in zip("abc", (a, b, c), strict=True)
    )
    # half: what is clamped stays well within the round trip that is promised
    missed_by = chain.size / 2 if scale is None else scale
    at = Amplitude.of(p, x, (a, b, c), sigma, scale=lambda _: missed_by, suffix=tag)
    flag: Any = sp.false
    if not any(differs_from_zero(chain, e, chain.size) for e in (a, b, c)):
        flag = p.vanishes(f"free{tag}", at.h, chain.size, f"the axis of {x.name} is met", free=(x,))
    root = p.let(f"root{tag}", at.root, nonnegative=True)
    width = p.let(f"width{tag}", at.below + at.above, nonnegative=True)
    play = 2 * missed_by * ROUNDING
    found = toward.reached(Tangency(chain, at, root, width, play, tag, flag))
    pair, means = named(chain, x, found.pair)
    across = a * pair.c - b * pair.s if found.root is None else -sigma * found.root
    ahead = p.let(f"ahead{tag}", across)
    means[ahead] = a * sp.cos(x) - b * sp.sin(x)
    how = (
        r"\sigma\delta,\ (\cos\delta, \sin\delta) = \frac{(c, \sqrt{(h - c)(h + c)})}{h},\ "
        r"h = \sqrt{a^2+b^2}"
    )
    lemma = at.lemma(pair.angle, how)
    meaning = f"all coefficients of the equation for {x} vanish; {x} is free, 0 is returned."
    cases = degenerate(flag, [vanishing(a, b, c)], x, meaning)
    return Applied(lemma, Facing(pair.s, pair.c, root, ahead, sigma), means, {}, cases)


theorem(
    "two-link arm",
    statement=r"""Let $u(\theta) = (\cos\theta, \sin\theta)$, $l_1, l_2 > 0$ and $(x, y) \ne 0$.
With $r = \sqrt{x^2 + y^2}$ and the factors $\mathcal S = l_1 + l_2 + r$, $\mathcal A = l_1 + l_2 -
r$, $\mathcal B = r + l_1 - l_2$ and $\mathcal C = r - l_1 + l_2$ of the triangle with these sides,
the equation $l_1 u(\theta) + l_2 u(\theta + \varphi) = (x, y)$ has a solution if and only if
$\mathcal A$, $\mathcal B$ and $\mathcal C$ are not negative.  The solutions are
$$(\cos\varphi, \sin\varphi) = \frac{(\mathcal B\mathcal C - \mathcal S\mathcal A,\
2\sigma\sqrt{\mathcal S\mathcal A\mathcal B\mathcal C})}{\mathcal B\mathcal C + \mathcal S\mathcal
A}, \qquad \theta = \operatorname{atan2}(y, x) - \alpha,$$
$$(\cos\alpha, \sin\alpha) = \frac{(\mathcal S\mathcal B - \mathcal A\mathcal C,\
2\sigma\sqrt{\mathcal S\mathcal A\mathcal B\mathcal C})}{\mathcal S\mathcal B + \mathcal A\mathcal
C}, \qquad \sigma = \pm 1.$$
A second link that is cranked, $(b - i a)\, e^{i y}$ instead of $l_2 e^{i y}$ in the complex
plane, is a straight one of length $\sqrt{a^2 + b^2}$ at the angle $y - \operatorname{atan2}(a,
b)$.""",
    proof=r"""Turn the plane by $-\theta$: the first link is then at the angle $0$, the second at
$\varphi$, and $(x, y)$ at $\alpha = \operatorname{atan2}(y, x) - \theta$.  These are the
equations of the two-link triangle.  Its tangents of half angles are those of the stated sines and
cosines, by $(\cos\varphi, \sin\varphi) = (1 - t^2,\ 2 t)/(1 + t^2)$ with $t = \tan(\varphi/2)$,
and likewise for $\alpha$.  For the cranked link, $b - i a = \sqrt{a^2 + b^2}\,
e^{-i\operatorname{atan2}(a, b)}$.""",
    exception=r"""If $(x, y) = 0$, which needs $l_1 = l_2$, the arm is folded and $\theta$ is
free.  If a link has no length, $\varphi$ is free, and a stretched arm is returned.""",
    rests_on=("two-link triangle",),
)


@chain_lemma("l1 u(x1) + l2 u(x1 + x2) = (x, y)", "both pairs")
def two_links(
    chain: Chain,
    first: sp.Symbol,
    second: sp.Symbol,
    x: sp.Expr,
    y: sp.Expr,
    l1: sp.Expr,
    l2: sp.Expr,
    choice: Choice,
    *,
    scale: sp.Expr | None = None,
    mirrored: sp.Expr = sp.S.One,
    name: str = "elbow",
) -> Applied:
    """The planar two-link arm: ``l1 u(first) + l2 u(first + second) = (x, y)``, two elbows.

    ``u`` is the unit vector at an angle.  With the factors S, A, B, C of Heron's formula

        (cos, sin)(second) = (BC - SA, 2 sigma sqrt(SABC)) / (BC + SA),

    and first is the direction of (x, y) minus the angle at the base of the triangle.  ``scale`` is
    the size of the terms whose differences x and y are, by default that of the whole arm.
    ``mirrored`` is a sign that multiplies that of the elbow, for example the side of an earlier
    turn, which mirrors the plane.
    """
    p, scale = chain.program, chain.size if scale is None else scale
    sigma = mirrored * chain.sign(name, choice)
    for length in (l1, l2):
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
        r"l_1 u(\theta) + l_2 u(\theta + \varphi) = (x, y) \;\Rightarrow\; "
        r"(\cos\varphi, \sin\varphi) = \frac{(\mathcal B\mathcal C - \mathcal S\mathcal A,\ "
        r"2\sigma\sqrt{\mathcal S\mathcal A\mathcal B\mathcal C})}"
        r"{\mathcal B\mathcal C + \mathcal S\mathcal A},\ "
        r"\theta = \operatorname{atan2}(y, x) - \alpha,\quad "
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
            (r"\theta", first),
            (r"\varphi", second),
            ("x", x),
            ("y", y),
        ),
        letters=triangle.letters,
    )
    meaning = f"equal links folded onto the axis of {first}, which is free; 0 is returned."
    cases = degenerate(folded, [_folded(x, y, l1, l2)], first, meaning)
    meaning = f"a link without length: {second} is free; 0."
    cases += degenerate(no_link, _stretched(x, y, l1, l2), second, meaning)
    return Applied(lemma, (lift, bend), means | more, {}, cases)


def _folded(
    x: sp.Symbol, y: sp.Symbol, l1: sp.Expr, l2: sp.Expr
) -> dict[sp.Symbol, sp.Expr] | None:
    """The case of equal links that end where they begin; None where numbers make them unequal."""
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


@chain_lemma("r u(x) = (x, y)", "the pair of x, and r")
def polar(
    chain: Chain,
    angle: sp.Symbol,
    length: sp.Symbol,
    x: sp.Expr,
    y: sp.Expr,
    choice: Choice | None,
    *,
    name: str = "side",
) -> Applied:
    """``length u(angle) = (x, y)``: the length has either sign, or with no ``choice`` is positive.

    ``length`` is a prismatic joint or an auxiliary length.  The angle is free where it vanishes.
    """
    p = chain.program
    sigma = chain.sign(name, choice) if choice else sp.S.One
    x, y = (chain.coefficient(f"{n}_{name}", e) for n, e in (("x", x), ("y", y)))
    r = p.let(f"r_{name}", sp.sqrt(x**2 + y**2), nonnegative=True)
    flag: Any = sp.false
    if not any(differs_from_zero(chain, e, chain.size) for e in (x, y)):
        flag = p.vanishes(f"on_axis_{name}", r, chain.size, f"the axis of {angle} is met", (angle,))
    pair, means = named(chain, angle, direction(sigma * y, sigma * x, r, flag))
    value = p.let(f"{length.name}_{name}", sigma * r)
    lemma = Lemma(
        "polar coordinates",
        r"\rho\,u(\theta) = (x, y) \;\Rightarrow\; \rho = \sigma\sqrt{x^2 + y^2},\ "
        r"\theta = \operatorname{atan2}(\sigma y, \sigma x)",
        (length * sp.cos(angle) - x, length * sp.sin(angle) - y),
        {angle: pair.angle, length: value},
        2 if choice else 1,
        excluded=0 if choice else 1,
        roles=((r"\rho", length), (r"\theta", angle), ("x", x), ("y", y)),
    )
    meaning = f"the axis of {angle} is met; {angle} is free, 0 is returned."
    cases = degenerate(flag, [vanishing(x, y)], angle, meaning)
    return Applied(lemma, (pair, value), means | {value: length}, {}, cases)


theorem(
    "slide",
    statement=r"""The equation $d = z$ has the one solution $d = z$.""",
    proof=r"""A prismatic joint along the direction of a coordinate moves the hand by as much as
it is extended; nothing has to be solved.""",
)


@chain_lemma("d = value", "the value")
def slide(chain: Chain, joint: sp.Symbol, value: sp.Expr) -> Applied:
    """``joint = value``: a prismatic joint along the direction of a coordinate."""
    lemma = Lemma("slide", r"d = z", (joint - value,), {joint: value}, 1)
    return Applied(lemma, value)


theorem(
    "remaining angle",
    statement=r"""Let $\psi$ and $\varphi$ be given by their sines and cosines.  In $(-\pi, \pi]$
exactly one $\theta$ has $\theta + \varphi = \psi$ up to whole turns,
$$\theta = \operatorname{atan2}(\sin\psi\cos\varphi - \cos\psi\sin\varphi,\
\cos\psi\cos\varphi + \sin\psi\sin\varphi).$$""",
    proof=r"""By the addition theorems the arguments are $\sin(\psi - \varphi)$ and $\cos(\psi -
\varphi)$.  Angles with the same sine and cosine differ by whole turns, and one of them is in
$(-\pi, \pi]$.""",
)


@chain_lemma("x = value", "the angle")
def remainder(chain: Chain, joint: sp.Symbol, total: sp.Expr) -> Applied:
    """``joint = total``, an angle: what the earlier joints leave of an angle of the target.

    It is read from the sine and the cosine of the sum, so that it needs no reduction.
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
        r"\theta = \psi - \varphi",
        (sp.cos(joint) - sp.cos(total), sp.sin(joint) - sp.sin(total)),
        {joint: pair.angle},
        1,
    )
    return Applied(lemma, total, {}, dict(chain.meaning))


@chain_lemma("Rz(x1) Ry(x2) Rz(x3) = R", "the pair of x1")
def zyz(
    chain: Chain,
    R: sp.Matrix,
    first: sp.Symbol,
    middle: sp.Symbol,
    last: sp.Symbol,
    choice: Choice,
    *,
    reaching: Reaching | None = None,
    name: str = "wrist",
) -> Applied:
    """``Rz(first) Ry(middle) Rz(last) = R``: two solutions, by the sign of sin(middle).

    The second solution is the first with a half turn of both outer angles.  The last angle is read
    from the rotation that the first leaves, which keeps the product exact near ``middle = 0``.
    There only ``first + last`` or ``first - last`` is determined; first is 0, or what keeps the
    rest of the arm within reach.
    """
    p = chain.program
    sigma = chain.sign(name, choice)
    free = next((a for a in (first, last) if a in chain.joints), None)
    if free is None:
        free = next(j for j in chain.joints if chain.defined[last].has(j))
    halves: dict[sp.Symbol, tuple[Pair, sp.Expr]] = {}
    unit: dict[sp.Expr, sp.Expr] = {}
    near: tuple[sp.Symbol, ...] = ()
    if reaching is None:
        angles = zyz_angles(
            p, R, (first, middle, last), sigma, free=(free,), scale=_ROUNDINGS, suffix=f"_{name}"
        )
        lemma, aligned = angles.lemma, angles.aligned
        halves = {first: (angles.first, angles.flip), last: (angles.last, angles.flip)}
        halves[middle] = _tilt(R, angles.first, sigma), sp.S.Zero
        s, c = (choose(aligned, e, sigma * e) for e in (angles.first.s, angles.first.c))
        pair, means = named(chain, first, Pair(s, c))
    else:
        h = p.let(f"h_{name}", sp.sqrt(R[0, 2] ** 2 + R[1, 2] ** 2), nonnegative=True)
        aligned = p.vanishes(
            f"aligned_{name}", h, _ROUNDINGS, "the first and the last axis are parallel", (free,)
        )
        found, near, unit = _within_reach(reaching, R, h, first, sigma, aligned)
        pair, means = named(chain, first, found)
        lemma, _ = zyz_lemma(R, (first, middle, last), pair)
        halves[middle] = _tilt(R, pair, sp.S.One), sp.S.Zero
    given = dict(zip(R, rotation_parametrisation(), strict=True))
    cases = [
        Degenerate(
            flags,
            dict(zip(R, turned, strict=True)) | unit,
            free if flags == (aligned,) else None,
            f"the first and the last axis of the {name} are parallel; {free} is free.",
        )
        for flags in filter(None, ((aligned,), near))
        for turned in _aligned(real("psi"))
    ]
    return Applied(lemma, pair, means, given, tuple(cases), halves)


def _tilt(R: sp.Matrix, first: Pair, side: sp.Expr) -> Pair:
    """The pair of the middle angle, for sums that contain it; ``side`` is the sign of its sine."""
    return Pair(side * (first.c * R[0, 2] + first.s * R[1, 2]), R[2, 2])


def _within_reach(
    reaching: Reaching,
    R: sp.Matrix,
    h: sp.Symbol,
    first: sp.Symbol,
    sigma: sp.Symbol,
    aligned: sp.Symbol,
) -> tuple[Pair, tuple[sp.Symbol, ...], dict[sp.Expr, sp.Expr]]:
    """The first angle, in reach where the target does not determine it, or only up to rounding.

    Also returns the flags of the latter case, and free choices as the sine and cosine of an angle.
    """
    p = reaching.chain.program
    raw = Pair(
        p.let(f"s_{first}", choose(aligned, 0, sigma * R[1, 2] / h)),
        p.let(f"c_{first}", choose(aligned, 1, sigma * R[0, 2] / h)),
    )
    back = -reaching.ahead
    start = reaching.middle() + back
    close, moves, inside, moved = reaching.moved(raw + reaching.ahead, h)
    off = moved + back
    start = Pair(p.let("s_start", start.s), p.let("c_start", start.c))
    off = Pair(p.let("s_off", off.s), p.let("c_off", off.c))
    brought = sp.And(moves, sp.Not(inside))
    s_near = p.let("s_kept", choose(brought, off.s, raw.s))
    c_near = p.let("c_kept", choose(brought, off.c, raw.c))
    raw = Pair(choose(close, s_near, raw.s), choose(close, c_near, raw.c))
    t = real("t")
    unit = {start.s: sp.sin(t), start.c: sp.cos(t), off.s: sp.sin(t), off.c: sp.cos(t)}
    found = Pair(choose(aligned, start.s, raw.s), choose(aligned, start.c, raw.c))
    return found, (close, moves), unit


def _aligned(psi: sp.Symbol) -> tuple[sp.Matrix, sp.Matrix]:
    s, c = sp.sin(psi), sp.cos(psi)
    return (
        sp.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
        sp.Matrix([[-c, s, 0], [s, c, 0], [0, 0, -1]]),
    )


@dataclass(frozen=True)
class Reaching:
    """Directions u for which ``(x, y) - offset u`` is within reach of two links.

    If the target does not determine u, or only up to rounding, the reach decides.  Otherwise a pose
    at a singular wrist could come back without a solution although it has one.
    """

    chain: Chain
    x: sp.Expr
    y: sp.Expr
    offset: sp.Expr
    l1: sp.Expr
    l2: sp.Expr
    ahead: Pair
    """How far u is turned ahead of the angle that is solved for."""
    lever: sp.Expr
    """The lever of the turn before, over which a rounding of the target turns the wrist."""

    def _at(self, reach: sp.Expr, side: sp.Expr, name: str) -> Pair:
        def vanishes(name: str, value: sp.Expr, scale: sp.Expr) -> sp.Symbol:
            return self.chain.program.vanishes(name, value, scale, "the turn has no effect")

        at = (self.x, self.y)
        past = Offset(at, self._r, self.offset, vanishes)
        pair, unit = past.leaving(self.chain, reach, side, name)
        self.chain.units.append((pair.s, pair.c, unit))
        return pair

    @cached_property
    def _r(self) -> sp.Expr:
        return self.chain.program.let("r_hub", sp.sqrt(self.x**2 + self.y**2), nonnegative=True)

    def middle(self) -> Pair:
        """The middle of those distances within reach that turning the offset allows."""
        p, r = self.chain.program, self._r
        nearest = p.let("nearest", sp.Max(sp.Abs(self.l1 - self.l2), sp.Abs(r - self.offset)))
        farthest = p.let("farthest", sp.Min(self.l1 + self.l2, r + self.offset))
        return self._at(p.let("mid_reach", (nearest + farthest) / 2), sp.S.One, "mid")

    def moved(self, u: Pair, play: sp.Expr) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol, Pair]:
        """Flags: u may be in doubt, the nearest direction in reach is u within rounding, it is u.

        That direction is returned too.  ``play`` is what multiplies an error of u in the target.
        """
        p, size = self.chain.program, self.chain.size
        close = p.vanishes("close", play * self.lever - size / 2**11, size, "it may be in doubt")
        ex, ey = self.x - self.offset * u.c, self.y - self.offset * u.s
        there = p.let("here", sp.sqrt(ex**2 + ey**2))
        reach = p.let(
            "in_reach", sp.Min(sp.Max(there, sp.Abs(self.l1 - self.l2)), self.l1 + self.l2)
        )
        cross = p.let("cross", self.x * u.s - self.y * u.c)
        flat = p.vanishes("flat", sp.Abs(cross), size, "the offset is in line")
        side = choose(flat, 1, cross / sp.Abs(cross))
        v = self._at(reach, p.let("side", side), "near")
        inside = p.vanishes("inside", sp.Abs(reach - there), size, "it is in reach")
        change = sp.sqrt((v.c - u.c) ** 2 + (v.s - u.s) ** 2)
        doubt = play * change - sp.Rational(1, 2**42)  # of which single precision knows nothing
        near = p.vanishes("within_rounding", doubt, 4, "the turn is free within rounding")
        return close, near, inside, v
