"""The lemmas that solve for a joint, with the names of the field.

Each is a function that adds its statements to a :class:`~closedform.functions.Program` and returns
a :class:`Lemma`: the equations, the unknowns and the closed form of each.  The closed forms are
chosen for the boundary of the workspace: differences of lengths, or of their squares, under the
roots instead of ``1 - cos(x)**2``, and ``atan2`` instead of ``acos``.

:func:`closedform.prove_lemma.prove_lemma` proves a lemma once, for symbolic coefficients: its
solutions satisfy the equations, and the equations have no others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp

from closedform.functions import Program, Statement, choose, sign_of, used_up


@dataclass(frozen=True)
class Lemma:
    """A lemma applied: ``equations`` vanish at ``solution`` (unknown -> closed form).

    ``excluded`` solutions of the equations violate the inequality that ``statement`` names.
    ``means`` holds names for the steps that follow, and what they are in the unknowns: cosine and
    sine of one, or of a sum, computed without the angle.  ``body`` are the statements that the
    lemma added to the program.  ``premises`` says what names of earlier statements must stand for;
    where the inverse is proved, so is that.
    """

    name: str
    statement: str
    equations: tuple[sp.Expr, ...]
    solution: Mapping[sp.Symbol, sp.Expr]
    branches: int
    excluded: int = 0
    means: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    body: tuple[Statement, ...] = ()
    premises: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def __getitem__(self, unknown: sp.Symbol) -> sp.Expr:
        return self.solution[unknown]

    def known(self, value: sp.Expr) -> sp.Symbol:
        """The name of a value in the unknowns, as ``cos(x)``."""
        return next(name for name, meaning in self.means.items() if meaning == value)

    def pair(self, angle: sp.Expr) -> tuple[sp.Symbol, sp.Symbol]:
        """The names of the cosine and the sine of an angle."""
        return self.known(sp.cos(angle)), self.known(sp.sin(angle))


def label(joint: sp.Symbol) -> str:
    """What tells a joint from the others in the names of its sine and cosine: 1 of theta1."""
    return str(joint.name).removeprefix("theta")


def linear_pair(x: sp.Symbol, sine: sp.Expr, cosine: sp.Expr) -> Lemma:
    """``cos x : sin x = cosine : sine``, both known up to a common positive factor.

    Of the two directions of the line only one has the right sign; x is free where both vanish.
    """
    return Lemma(
        "atan2 of a linear pair",
        r"\sin x\,B - \cos x\,A = 0,\ A\sin x + B\cos x > 0 \;\Rightarrow\; "
        r"x = \operatorname{atan2}(A, B)",
        (sp.sin(x) * cosine - sp.cos(x) * sine,),
        {x: sp.atan2(sine, cosine)},
        1,
        excluded=1,
    )


def sine_cosine(
    program: Program,
    x: sp.Symbol,
    a: sp.Expr,
    b: sp.Expr,
    c: sp.Expr,
    sigma: sp.Symbol,
    *,
    suffix: str = "",
    free: Sequence[sp.Symbol] = (),
    scale: sp.Expr = sp.S.One,
    slack: sp.Expr | None = None,
    reach: tuple[sp.Expr, sp.Expr, sp.Expr] | None = None,
) -> Lemma:
    """``a sin x + b cos x = c``: two solutions where ``a^2 + b^2 >= c^2``.

    With ``h = sqrt(a^2 + b^2)`` the equation is ``cos(x - atan2(a, b)) = c / h``; half the angle
    ``x - atan2(a, b)`` has the tangent ``sqrt(h - c) / sqrt(h + c)``.  x is free where
    ``a = b = c = 0``; with ``free`` joints that is flagged, on the ``scale`` of the coefficients,
    and the answer there is x = 0.  ``b sin x - a cos x`` gets a name too.  ``slack`` is the scale
    of what c may be missed by, if it is not that; ``reach`` are two links and a height, as in
    :func:`~closedform.pairs.sine_cosine_pair`.
    """
    start = len(program.body)
    h = program.let(f"h{suffix}", sp.sqrt(a**2 + b**2), nonnegative=True)
    size = slack if slack is not None else scale if free else h
    below = program.bound(f"below{suffix}", h - c, size, "the amplitude is not smaller than c")
    above = program.bound(f"above{suffix}", h + c, size, "the amplitude is not smaller than -c")
    turn = 2 * sp.atan2(sp.sqrt(below), sp.sqrt(above))
    root = sp.sqrt(below) * sp.sqrt(above)
    if reach is not None:
        root = program.let(f"root{suffix}", root, nonnegative=True)
        lever = 4 * root * (reach[0] + reach[1])
        tangent = nearly_tangent(program, lever, h * size, suffix)
        held = sp.sqrt(root_in_reach(program, below * above, h, size, *reach, suffix=suffix))
        turn = choose(tangent, sp.atan2(held, (above - below) / 2), turn)
        root = program.let(f"in_reach{suffix}", choose(tangent, held, root), nonnegative=True)
    onward = program.let(f"onward{suffix}", sigma * root)
    direction = sp.atan2(a, b) + sigma * turn
    if free:
        nowhere = program.vanishes(f"nowhere{suffix}", h, scale, "the amplitude is zero", free)
        direction = choose(nowhere, 0, direction)
    return Lemma(
        "a sin x + b cos x = c",
        r"a\sin x + b\cos x = c \;\Rightarrow\; x = \operatorname{atan2}(a, b) + "
        r"2\sigma\operatorname{atan2}(\sqrt{h-c}, \sqrt{h+c}),\ h = \sqrt{a^2+b^2}",
        (a * sp.sin(x) + b * sp.cos(x) - c,),
        {x: direction},
        2,
        means={onward: b * sp.sin(x) - a * sp.cos(x)},
        body=tuple(program.body[start:]),
    )


def nearly_tangent(program: Program, lever: sp.Expr, scale: sp.Expr, suffix: str = "") -> sp.Symbol:
    """A flag that the ``lever`` of a turn is so short that rounding may decide what is in reach.

    It is 2^-8 of the ``scale``; for a longer one the tolerance of a reach covers the rounding.
    """
    return program.vanishes(f"tangent{suffix}", lever - scale / 2**8, scale, "the turn is tangent")


def root_in_reach(
    program: Program,
    square: sp.Expr,
    h: sp.Expr,
    scale: sp.Expr,
    first: sp.Expr,
    second: sp.Expr,
    height: sp.Expr,
    *,
    suffix: str,
) -> sp.Symbol:
    """The ``square`` of a coordinate, brought within reach where that is a matter of rounding."""
    farthest, nearest = (first + second) ** 2 - height**2, (first - second) ** 2 - height**2
    wanted = program.let(f"wanted{suffix}", sp.Max(0, nearest, sp.Min(square, farthest)))
    rounding = 2 * h * scale / 2**44
    return program.let(
        f"held{suffix}",
        sp.Piecewise((wanted, sp.Abs(wanted - square) <= rounding), (square, True)),
        nonnegative=True,
    )


def heron_factors(
    program: Program,
    first: sp.Expr,
    second: sp.Expr,
    reach: sp.Expr,
    scale: sp.Expr,
    *,
    suffix: str = "",
) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol, sp.Symbol]:
    """The factors S, A, B, C of Heron's formula; a triangle exists where none is negative."""
    return (
        program.let(f"S{suffix}", first + second + reach, nonnegative=True),
        program.bound(f"A{suffix}", first + second - reach, scale, "nearer than full stretch"),
        program.bound(f"B{suffix}", reach + first - second, scale, "farther than the fold"),
        program.bound(f"C{suffix}", reach - first + second, scale, "farther than the fold"),
    )


def square_factors(
    program: Program,
    first: sp.Expr,
    second: sp.Expr,
    square: sp.Expr,
    scale: sp.Expr,
    *,
    suffix: str = "",
) -> tuple[sp.Symbol, sp.Symbol]:
    """N and M of :func:`two_link_triangle_by_square`; a triangle exists where none is negative.

    A fold of some 2^-44 of the links is none: there M may be missed by its own square.
    """
    total, apart = first + second, first - second
    N = program.bound(
        f"N{suffix}", total**2 - square, 2 * total * scale, "nearer than full stretch"
    )
    M = program.bound(
        f"M{suffix}",
        square - apart**2,
        2 * (sp.Abs(apart) + total / 2**44) * scale,
        "farther than the fold",
    )
    return N, M


def triangle_equations(
    first: sp.Expr, second: sp.Expr, reach: sp.Expr, elbow: sp.Symbol, base: sp.Symbol
) -> tuple[sp.Expr, sp.Expr]:
    """Two links, at 0 and at ``elbow``, end ``reach`` away in the direction ``base``."""
    return (
        first + second * sp.cos(elbow) - reach * sp.cos(base),
        second * sp.sin(elbow) - reach * sp.sin(base),
    )


def two_link_triangle(
    program: Program,
    first: sp.Expr,
    second: sp.Expr,
    reach: sp.Expr,
    elbow: sp.Symbol,
    base: sp.Symbol,
    sigma: sp.Symbol,
    *,
    scale: sp.Expr | None = None,
    suffix: str = "",
) -> Lemma:
    """The triangle of two links of lengths ``first``, ``second`` whose ends are ``reach`` apart.

    ``elbow`` is the joint angle between the links (zero when stretched), ``base`` the angle from
    the first link to the line of the ends, so that a link at ``theta`` reaches the direction
    ``theta + base``.  Two mirror solutions.  With the four factors of Heron's formula, S, A, B, C,

        tan(elbow / 2) = sqrt(S A) / sqrt(B C),   tan(base / 2) = sqrt(A C) / sqrt(S B).

    The elbow is free where a link has no length, and the base where the reach is zero.  ``scale``
    is the natural scale of the lengths: by default that of the links, more where the reach is a
    difference of larger lengths.
    """
    scale = first + second if scale is None else scale
    S, A, B, C = heron_factors(program, first, second, reach, scale, suffix=suffix)
    rS, rA, rB, rC = (
        program.let(f"r{name}{suffix}", sp.sqrt(value), nonnegative=True)
        for name, value in (("S", S), ("A", A), ("B", B), ("C", C))
    )
    return Lemma(
        "two-link triangle",
        r"\tan\frac{\theta}{2} = \sigma\frac{\sqrt{S A}}{\sqrt{B C}},\quad "
        r"\tan\frac{\alpha}{2} = \sigma\frac{\sqrt{A C}}{\sqrt{S B}}",
        triangle_equations(first, second, reach, elbow, base),
        {
            elbow: 2 * sigma * sp.atan2(rS * rA, rB * rC),
            base: 2 * sigma * sp.atan2(rA * rC, rS * rB),
        },
        2,
    )


def triangle_angles(
    first: sp.Expr, second: sp.Expr, N: sp.Expr, M: sp.Expr, sigma: sp.Expr
) -> tuple[sp.Expr, sp.Expr]:
    """Elbow and base of :func:`two_link_triangle_by_square`, for N and M."""
    elbow = 2 * sigma * sp.atan2(sp.sqrt(N), sp.sqrt(M))
    beyond = 2 * sigma * second * (sp.sqrt(N) * sp.sqrt(M))
    return elbow, sp.atan2(beyond, (first - second) * N + (first + second) * M)


def two_link_triangle_by_square(
    program: Program,
    first: sp.Expr,
    second: sp.Expr,
    square: sp.Expr,
    elbow: sp.Symbol,
    base: sp.Symbol,
    sigma: sp.Symbol,
    *,
    scale: sp.Expr | None = None,
    suffix: str = "",
    free: Sequence[sp.Symbol] = (),
) -> tuple[Lemma, tuple[sp.Expr, sp.Expr]]:
    """As :func:`two_link_triangle`, by the ``square`` of the distance R of the ends.

    With N = (l1 + l2)^2 - R^2 and M = R^2 - (l1 - l2)^2

        tan(elbow / 2) = sqrt(N / M),
        tan(base) = 2 l2 sqrt(N M) / ((l1 - l2) N + (l1 + l2) M),

    without R itself.  Cosine and sine of the base, times 4 l1 l2 R, are returned too, for what
    turns with it.  Both angles rest on the same N and M, whose rounding counts as some of R; so
    the links end where they should even where their angles are ill-conditioned.

    The elbow is free where a link has no length: the convention is a stretched one, and the
    ``free`` joints get the status for it.  The base is free where R = 0.  ``scale`` is the natural
    scale of the lengths: by default that of the links, more where R comes from larger ones.
    """
    total = first + second
    N, M = square_factors(
        program, first, second, square, total if scale is None else scale, suffix=suffix
    )
    bend, lead = triangle_angles(first, second, N, M, sigma)
    no_link = program.vanishes(
        f"no_link{suffix}", first * second, total**2, "a link has no length", free
    )
    ahead = program.let(f"ahead{suffix}", choose(no_link, 1, lead.args[1]))
    beyond = program.let(f"beyond{suffix}", choose(no_link, 0, lead.args[0]))
    lemma = Lemma(
        "two-link triangle",
        r"N = (l_1 + l_2)^2 - R^2,\ M = R^2 - (l_1 - l_2)^2:\quad "
        r"\tan\frac{\theta}{2} = \sigma\frac{\sqrt N}{\sqrt M},\quad "
        r"\tan\alpha = \sigma\frac{2 l_2 \sqrt{N M}}{(l_1 - l_2) N + (l_1 + l_2) M}",
        triangle_equations(first, second, sp.sqrt(square), elbow, base),
        {elbow: choose(no_link, 0, bend), base: sp.atan2(beyond, ahead)},
        2,
    )
    return lemma, (ahead, beyond)


def parallelogram(
    crank: sp.Expr,
    coupler: sp.Expr,
    angle: sp.Expr,
    frame: sp.Expr,
    turn: sp.Symbol,
    rod: sp.Symbol,
    sigma: sp.Symbol,
) -> Lemma:
    """The four-bar linkage with equal opposite sides: its two assemblies.

    The crank and the rod have the length ``crank``, the coupler and the fixed link the length
    ``coupler``; the crank is at ``angle`` and the fixed link at ``frame`` in a common plane.
    Unknown are the ``turn`` of the coupler against the fixed link and the angle of the ``rod``.

    With the plus sign the linkage is a parallelogram, and the coupler does not turn; with the minus
    sign it is an antiparallelogram.  They meet where the linkage is flat.  The antiparallelogram
    has a free turn where it is flat with equal sides.
    """
    bend = angle - frame
    half = sp.atan2(crank * sp.sin(bend), crank * sp.cos(bend) - coupler)
    turned = (1 - sigma) * half
    return Lemma(
        "parallelogram",
        r"l\,e^{i\theta} + a\,e^{i(\gamma + \varphi)} = a\,e^{i\gamma} + l\,e^{i\beta} "
        r"\;\Rightarrow\; (\varphi, \beta) = (0, \theta) \text{ or } "
        r"\tan\frac{\varphi}{2} = \frac{l\sin(\theta - \gamma)}{l\cos(\theta - \gamma) - a},\ "
        r"\beta = 2\gamma + \varphi - \theta",
        tuple(
            crank * (f(angle) - f(rod)) + coupler * (f(frame + turn) - f(frame))
            for f in (sp.cos, sp.sin)
        ),
        {turn: turned, rod: sigma * angle + (1 - sigma) * frame + turned},
        2,
    )


def zyz_angles(
    program: Program,
    R: sp.Matrix,
    first: sp.Symbol,
    middle: sp.Symbol,
    last: sp.Symbol,
    sigma: sp.Symbol,
    *,
    turn: int = 1,
    scale: int = 1,
    suffix: str = "",
) -> Lemma:
    """``Rz(first) Ry(turn * middle) Rz(last) = R``: two solutions, by the sign of sin(middle).

    The third column of R gives the first two angles.  The last is *not* read from the third row, as
    the textbooks do: near ``middle = 0`` that row knows nothing of it.  It follows from the
    rotation that the first angle leaves, ``Rz(first)^T R = Ry(middle) Rz(last)``, whose second row
    is ``(sin(last), cos(last), 0)``, and so keeps the product exact whatever error ``first`` has.
    The second solution is the first with a half turn of both outer angles.

    Where ``sin(middle) = 0`` only ``first + last`` (or ``first - last``) is determined; the
    convention is ``first = 0``.  ``scale`` counts the roundings that R has seen.
    """
    h = program.let(f"h{suffix}", sp.sqrt(R[0, 2] ** 2 + R[1, 2] ** 2), nonnegative=True)
    aligned = program.vanishes(
        f"aligned{suffix}", h, scale, "the first and the last axis coincide", free=(first,)
    )
    tag = label(first)
    c_first = program.let(f"c{tag}", choose(aligned, 1, turn * R[0, 2] / h))
    s_first = program.let(f"s{tag}", choose(aligned, 0, turn * R[1, 2] / h))
    flip = program.let(f"flip{suffix}", choose(aligned, 0, (1 - sigma) * sp.pi / 2))
    s_middle = turn * (c_first * R[0, 2] + s_first * R[1, 2])
    s_last = c_first * R[1, 0] - s_first * R[0, 0]
    c_last = c_first * R[1, 1] - s_first * R[0, 1]
    axis = [turn * R[i, 2] for i in (0, 1)]
    return Lemma(
        "ZYZ angles",
        r"c_1 = \sigma R_{13}/h,\ s_1 = \sigma R_{23}/h,\ h = \sqrt{R_{13}^2 + R_{23}^2};\quad "
        r"\theta_2 = \operatorname{atan2}(c_1 R_{13} + s_1 R_{23}, R_{33});\quad "
        r"\theta_3 = \operatorname{atan2}(c_1 R_{21} - s_1 R_{11}, c_1 R_{22} - s_1 R_{12})",
        (
            sp.cos(first) * sp.sin(middle) - axis[0],
            sp.sin(first) * sp.sin(middle) - axis[1],
            sp.cos(middle) - R[2, 2],
            sp.sin(last) - (sp.cos(first) * R[1, 0] - sp.sin(first) * R[0, 0]),
            sp.cos(last) - (sp.cos(first) * R[1, 1] - sp.sin(first) * R[0, 1]),
        ),
        {
            first: sp.atan2(s_first, c_first) + flip,
            middle: sigma * sp.atan2(s_middle, R[2, 2]),
            last: sp.atan2(s_last, c_last) + flip,
        },
        2,
    )


def two_sines(
    program: Program,
    unknowns: tuple[sp.Symbol, sp.Symbol],
    u: tuple[sp.Expr, sp.Expr],
    v: tuple[sp.Expr, sp.Expr],
    p: tuple[sp.Expr, sp.Expr],
    scale: sp.Expr,
    *,
    free: Sequence[sp.Symbol] = (),
) -> Lemma:
    """``u sin x + v sin y = p`` for vectors of the plane, and cosines that are not negative.

    The part of the equation across u gives sin y; what is left along u gives sin x, so that an
    error of y does no harm where u and v are nearly parallel.  There sin y is not known to many
    digits, and one is taken that leaves u no more than its length.  Where they are parallel a
    combination of the sines is free; the convention is that both are equally large, which exists
    whenever any answer does.  The directions of u and v are known to a few units in the last
    place, so that a multiple of the usual tolerance counts as parallel.  Cosines are kept from
    zero, so that their sign can be read from the answer.  ``scale`` is the natural scale of p,
    which decides how far the equation may be missed.
    """
    x, y = unknowns
    area = program.let("area_uv", u[0] * v[1] - u[1] * v[0])
    sigma = program.let("sigma_uv", sign_of(area))
    start = len(program.body)
    size = sp.sqrt(u[0] ** 2 + u[1] ** 2)
    size = size if size.is_Symbol else program.let("size_u", size, nonnegative=True)
    aside = program.let("v_across_u", sigma * (u[0] * v[1] - u[1] * v[0]) / size)
    lean = program.let("v_along_u", (u[0] * v[0] + u[1] * v[1]) / size)
    ahead = program.let("p_along_u", (u[0] * p[0] + u[1] * p[1]) / size)
    across = program.let("p_across_u", sigma * (u[0] * p[1] - u[1] * p[0]) / size)
    parallel = program.vanishes(
        "parallel", aside, 64 * sp.Abs(lean), "both vectors are parallel", free
    )
    for name, room in (("room_below", aside - across), ("room_above", aside + across)):
        program.bound(name, room, scale, "a sine is at most 1")
    with_v = sp.Piecewise((ahead, lean >= 0), (-ahead, True))
    whole = program.let("whole_y", choose(parallel, size + sp.Abs(lean), aside))
    part = program.let("part_y", choose(parallel, with_v, across))
    _, sine = _from_sine(program, f"{y}_0", part, whole, scale)
    rest = program.let("rest", ahead - sine * lean)
    left = program.let("left_along", size - sp.Abs(rest))
    spent = program.vanishes("spent_along", used_up(left), scale, "no room: a sine is at most 1")
    loose = sp.Abs(lean) / (aside + sp.Rational(1, 10**9) * size)
    play = program.let("play_along", scale * (1 + choose(spent, loose, 0)))
    program.bound("kept_along", left, play, "a sine is at most 1")
    lacking = (sp.Abs(left) - left) / 2 * lean / (lean**2 + aside**2)
    eased = sp.Piecewise((lacking, rest >= 0), (-lacking, True))
    part = program.let("eased", choose(spent, part + whole * eased, part))
    cy, sy = _from_sine(program, str(y), part, whole, scale)
    along = program.let("along_u", ahead - sy * lean)
    cx, sx = _from_sine(program, str(x), along, size, scale)
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
    )


def _from_sine(
    program: Program, x: str, part: sp.Expr, whole: sp.Expr, scale: sp.Expr
) -> tuple[sp.Symbol, sp.Symbol]:
    """Cosine and sine of the angle with ``sin x = part / whole`` and a cosine not negative."""
    below, above = (
        program.bound(f"{name}_{x}", value, scale, meaning, positive=True)
        for name, value, meaning in (
            ("below", whole - part, "a sine is at most 1"),
            ("above", whole + part, "a sine is at least -1"),
        )
    )
    total = program.let(f"total_{x}", below + above)
    cosine = program.let(f"c_{x}", 2 * sp.sqrt(below) * sp.sqrt(above) / total)
    return cosine, program.let(f"s_{x}", (above - below) / total)


@dataclass(frozen=True)
class Chord:
    """Where two circles meet, seen from the line of their centres.

    ``direction`` points from the first centre to the second, ``distance`` is between them; a common
    point is ``along`` that line from the first centre and ``height`` to its left or right.
    """

    direction: tuple[sp.Expr, sp.Expr]
    distance: sp.Expr
    along: sp.Expr
    height: sp.Expr
    flag: sp.Symbol


def circle_intersection(
    program: Program,
    centres: tuple[sp.Expr, sp.Expr],
    first: sp.Expr,
    second: sp.Expr,
    unknowns: tuple[sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
    scale: sp.Expr,
    *,
    free: tuple[sp.Symbol, ...] = (),
    suffix: str = "",
) -> tuple[Lemma, Chord]:
    """The points at the distances ``first`` and ``second`` from two points.

    ``centres`` is the vector from the first to the second, and ``unknowns`` the vector from the
    first to the point.  With the factors of Heron's formula the height of the triangle is
    ``sqrt(S A B C) / (2 d)``.  ``scale`` is the size of the coordinates, whose rounding decides
    what counts as zero.  Where the radii are equal and the centres coincide, the point is free on
    a circle; for one radius the convention is that of centres which are parted along the first
    axis, for two it is the point on this axis.  Circles that touch meet in one point.
    """
    x, y = unknowns
    apart = program.let(
        f"apart{suffix}", sp.sqrt(centres[0] ** 2 + centres[1] ** 2), nonnegative=True
    )
    S = first + second + apart
    A = program.bound(f"slack{suffix}", first + second - apart, scale, "the bars meet")
    touching = program.vanishes(f"touching{suffix}", A, scale, "the bars are in line")
    flag = program.vanishes(f"coincide{suffix}", apart, scale, "the centres coincide", free)
    n: tuple[sp.Expr, sp.Expr] = (
        choose(flag, 1, centres[0] / apart),
        choose(flag, 0, centres[1] / apart),
    )
    if first == second:
        d = program.let(f"distance{suffix}", choose(flag, 0, apart), nonnegative=True)
        along, height = d / 2, sp.sqrt(S) * sp.sqrt(A) / 2
    else:
        d = apart
        B = program.bound(f"outer{suffix}", apart + first - second, scale, "the bars meet")
        C = program.bound(f"inner{suffix}", apart - first + second, scale, "the bars meet")
        along = choose(flag, first, (apart + (first - second) * (first + second) / apart) / 2)
        rise = sp.sqrt(S) * sp.sqrt(A) * sp.sqrt(B) * sp.sqrt(C) / (2 * apart)
        height = choose(flag, 0, rise)
    n = (program.let(f"n_1{suffix}", n[0]), program.let(f"n_2{suffix}", n[1]))
    height = program.let(f"height{suffix}", choose(touching, 0, height), nonnegative=True)
    return Lemma(
        "circle intersection",
        r"|\mathbf x| = r_1,\ |\mathbf x - \mathbf d| = r_2 \;\Rightarrow\; \mathbf x = "
        r"\frac{d^2 + r_1^2 - r_2^2}{2 d}\,\mathbf n + \sigma h\,\mathbf n^\perp,\quad "
        r"h = \frac{\sqrt{S A B C}}{2 d}",
        (
            x**2 + y**2 - first**2,
            (x - centres[0]) ** 2 + (y - centres[1]) ** 2 - second**2,
        ),
        {x: along * n[0] - sigma * height * n[1], y: along * n[1] + sigma * height * n[0]},
        2,
    ), Chord(n, d, along, height, flag)
