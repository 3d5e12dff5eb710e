"""The angles of a rotation about z, y and z."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass, replace
from functools import cached_property

import sympy as sp

from closedform.algebra.solutions import rotation_parametrisation
from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain, Choice
from closedform.lemmas.links import named
from closedform.lemmas.offset import Offset, chord, on_side
from closedform.lemmas.pairs import direction
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.model.functions import Program, choose, real
from closedform.model.inverse import Degenerate
from closedform.model.lemma import Lemma, label
from closedform.model.pair import Pair
from closedform.model.tolerances import ROUNDING

ALIGNED = 16
"""How far a wrist may be from aligned to count as such, in units of the rounding of the target.

This covers the rounding that an arm adds to the rotation of its wrist, and it turns the hand by
3e-14 at most.  Of random postures of a Puma whose wrist is exactly aligned, 98 of 100 are
recognised; in the others the returned angles are correct too.
"""

theorem(
    "ZYZ angles",
    statement=r"""Let $R$ be a rotation with $h = \sqrt{R_{13}^2 + R_{23}^2} > 0$.  The equation
$R_z(\lambda)\, R_y(\mu)\, R_z(\nu) = R$ has two solutions with angles in $(-\pi, \pi]$.  For
$\sigma = \pm 1$, the sign of $\sin\mu$, they are
$$(\cos\lambda, \sin\lambda) = \frac{\sigma}{h}(R_{13}, R_{23}), \qquad
\mu = \operatorname{atan2}(R_{13}\cos\lambda + R_{23}\sin\lambda,\ R_{33}),$$
$$\nu = \operatorname{atan2}(R_{21}\cos\lambda - R_{11}\sin\lambda,\
R_{22}\cos\lambda - R_{12}\sin\lambda).$$""",
    proof=r"""The third column of the product is $(\cos\lambda\sin\mu,\ \sin\lambda\sin\mu,\
\cos\mu)$.  So $|\sin\mu| = h \ne 0$; if $\sigma$ is its sign, $\cos\lambda$ and $\sin\lambda$ are
as stated, and $\sin\mu = R_{13}\cos\lambda + R_{23}\sin\lambda$.  The equation leaves
$R_z(\lambda)^T R = R_y(\mu)\, R_z(\nu)$, whose second row is $(\sin\nu, \cos\nu, 0)$; this gives
$\nu$.  Conversely, for these $\lambda$ and $\mu$ the third column of $R_z(\lambda)^T R$ is
$(\sigma h, 0, R_{33})$, which is that of $R_y(\mu)$.  So $R_y(\mu)^T R_z(\lambda)^T R$ is a
rotation about the $z$ axis.  $R_y$ does not change second rows, so its angle is $\nu$.""",
    exception=r"""If $h = 0$, the first and the last axis coincide.  For $R_{33} = 1$ only
$\lambda + \nu$ is determined, for $R_{33} = -1$ only $\lambda - \nu$.""",
)


@dataclass(frozen=True)
class Zyz:
    """The lemma, and the outer angles: those of pairs, plus half a turn in some branches."""

    lemma: Lemma
    first: Pair
    last: Pair
    flip: sp.Expr
    aligned: sp.Symbol


def zyz_angles(
    program: Program,
    R: sp.Matrix,
    angles: tuple[sp.Symbol, sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
    *,
    free: Sequence[sp.Symbol] = (),
    scale: int = 1,
    suffix: str = "",
) -> Zyz:
    """``Rz(first) Ry(middle) Rz(last) = R``: two solutions, by the sign of sin(middle).

    The second solution is the first with a half turn of both outer angles.  Where ``sin(middle) =
    0`` only ``first + last`` (or ``first - last``) is determined; the convention is ``first = 0``.

    Parameters
    ----------
    program
        the program that the names and bounds are added to
    R
        the rotation
    angles
        first, middle and last
    sigma
        the sign of sin(middle)
    free
        which joint is free where it vanishes, by default the first angle
    scale
        the number of roundings that R has seen
    suffix
        what the names end in
    """
    h = program.let(f"h{suffix}", sp.sqrt(R[0, 2] ** 2 + R[1, 2] ** 2), nonnegative=True)
    aligned = program.vanishes(
        f"aligned{suffix}",
        h,
        scale,
        "the first and the last axis coincide",
        free=free or angles[:1],
    )
    pair = direction(R[1, 2], R[0, 2], h, aligned)
    pair = pair.known_as(program, suffix or label(angles[0]))
    flip = program.let(f"flip{suffix}", choose(aligned, 0, (1 - sigma) * sp.pi / 2))
    lemma, rest = zyz_lemma(R, angles, pair, sigma, flip)
    return Zyz(replace(lemma, signs=(sigma,)), pair, rest, flip, aligned)


def zyz_lemma(
    R: sp.Matrix,
    angles: tuple[sp.Symbol, sp.Symbol, sp.Symbol],
    pair: Pair,
    side: sp.Expr = sp.S.One,
    flip: sp.Expr = sp.S.Zero,
) -> tuple[Lemma, Pair]:
    """The lemma, once the ``pair`` of the first angle is known, and the pair of the last.

    ``side`` is the sign of sin(middle), and ``flip`` a turn that is added to both outer angles.

    The third column of R gives the first two angles.  The last is *not* read from the third row, as
    the textbooks do: near ``middle = 0`` that row hardly depends on it.  It follows from the
    rotation that the first angle leaves, ``Rz(first)^T R = Ry(middle) Rz(last)``, whose second row
    is ``(sin(last), cos(last), 0)``, and so keeps the product exact whatever error ``first`` has.
    """
    first, middle, last = angles
    s, c = pair.s, pair.c
    rest = Pair(c * R[1, 0] - s * R[0, 0], c * R[1, 1] - s * R[0, 1])
    cf, sf, cm, sm, cl, sl = (f(x) for x in (first, middle, last) for f in (sp.cos, sp.sin))
    left = sp.Matrix([[cf, sf, 0], [-sf, cf, 0], [0, 0, 1]]) * R
    right = sp.Matrix([[cm * cl, -cm * sl, sm], [sl, cl, 0], [-sm * cl, sm * sl, cm]])
    lemma = Lemma(
        "ZYZ angles",
        r"(\cos\lambda, \sin\lambda) = \sigma (R_{13}, R_{23})/h,\ h = \sqrt{R_{13}^2 + R_{23}^2},"
        r"\quad \mu = \operatorname{atan2}(R_{13}\cos\lambda + R_{23}\sin\lambda,\ R_{33}),\quad "
        r"\nu = \operatorname{atan2}(R_{21}\cos\lambda - R_{11}\sin\lambda,\ "
        r"R_{22}\cos\lambda - R_{12}\sin\lambda)",
        tuple(left - right),
        {
            first: pair.angle + flip,
            middle: side * sp.atan2(c * R[0, 2] + s * R[1, 2], R[2, 2]),
            last: rest.angle + flip,
        },
        2,
        roles=tuple(zip((r"\lambda", r"\mu", r"\nu"), angles, strict=True)),
    )
    return lemma, rest


@dataclass(frozen=True)
class Reaching:
    """Directions u for which ``(x, y) - offset u`` is within reach of two links.

    If the target does not determine u, or only up to rounding, the reach decides.  Otherwise no
    solution might be found for a pose at a singular wrist, although there is one.
    """

    chain: Chain
    target: tuple[sp.Expr, sp.Expr]
    """x and y."""
    lengths: tuple[sp.Expr, sp.Expr]
    """Those of the two links."""
    _: KW_ONLY
    offset: sp.Expr
    ahead: Pair
    """How far u is turned ahead of the angle that is solved for."""
    lever: sp.Expr
    """The lever of the turn before: a rounding error of the target over it turns the wrist."""

    @classmethod
    def turning(
        cls,
        chain: Chain,
        target: tuple[sp.Expr, sp.Expr],
        lengths: tuple[sp.Expr, sp.Expr],
        offset: tuple[sp.Expr, sp.Expr],
        *,
        lever: sp.Expr,
    ) -> Reaching:
        """The same if the angle turns the vector ``offset``, which may be zero at some postures."""
        x, y = (sp.sympify(e, strict=True) for e in offset)
        length = chain.let("offset", sp.sqrt(x**2 + y**2))
        ahead = direction(y, x, length, sp.Eq(length, 0))
        return cls(chain, target, lengths, offset=length, ahead=ahead, lever=lever)

    def _at(self, reach: sp.Expr, side: sp.Expr, name: str) -> Pair:
        def vanishes(name: str, value: sp.Expr, scale: sp.Expr) -> sp.Symbol:
            return self.chain.program.vanishes(name, value, scale, "the turn has no effect")

        pair, unit = self._leaving(
            Offset(self.target, self._r, self.offset, vanishes), reach, side, name
        )
        self.chain.units.append((pair.s, pair.c, unit))
        return pair

    def _leaving(
        self, past: Offset, reach: sp.Expr, side: sp.Expr, name: str
    ) -> tuple[Pair, tuple[sp.Expr, ...]]:
        return past.leaving(self.chain, reach, side, name)

    @cached_property
    def _r(self) -> sp.Expr:
        x, y = self.target
        return self.chain.program.let("r_hub", sp.sqrt(x**2 + y**2), nonnegative=True)

    @property
    def _reach(self) -> tuple[sp.Expr, sp.Expr]:
        """The least and the greatest distance that the two links bridge."""
        l1, l2 = self.lengths
        return sp.Abs(l1 - l2), l1 + l2

    @property
    def _turned(self) -> tuple[sp.Expr, sp.Expr]:
        """The least and the greatest distance to which the angle can turn the offset."""
        return sp.Abs(self._r - self.offset), self._r + self.offset

    def _reach_near(self, there: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """The same, if a distance that is nearly right is known."""
        return self._reach

    def _here(self, u: Pair) -> sp.Expr:
        """The distance at a direction."""
        (x, y) = self.target
        return sp.sqrt((x - self.offset * u.c) ** 2 + (y - self.offset * u.s) ** 2)

    def middle(self) -> Pair:
        """The middle of those distances within reach that turning the offset allows."""
        p, (least, most) = self.chain.program, self._reach
        low, high = self._turned
        nearest = p.let("nearest", sp.Max(least, low))
        farthest = p.let("most_reach", sp.Min(most, high))
        return self._at(p.let("mid_reach", (nearest + farthest) / 2), sp.S.One, "mid")

    def moved(self, u: Pair, gain: sp.Expr) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol, Pair]:
        """Flags: u may be inaccurate, the nearest direction in reach is u up to rounding, it is u.

        That direction is returned too.  ``gain`` is what multiplies an error of u in the target.
        """
        p, size = self.chain.program, self.chain.size
        x, y = self.target
        close = p.vanishes(
            "close", gain * self.lever - size / 2**11, size, "its direction may be inaccurate"
        )
        there = p.let("here", self._here(u))
        least, most = self._reach_near(there)
        reach = p.let("in_reach", sp.Min(sp.Max(there, least), most))
        cross = p.let("cross", x * u.s - y * u.c)
        flat = p.vanishes("flat", sp.Abs(cross), size, "the offset is in line")
        side = choose(flat, 1, cross / sp.Abs(cross))
        v = self._at(reach, p.let("side", side), "near")
        inside = p.vanishes("inside", sp.Abs(reach - there), size, "it is in reach")
        change = sp.sqrt((v.c - u.c) ** 2 + (v.s - u.s) ** 2)
        doubt = gain * change - 4 * ROUNDING
        near = p.vanishes("within_rounding", doubt, 4, "the turn is free up to rounding")
        return close, near, inside, v


@dataclass(frozen=True)
class ReachingAcross(Reaching):
    """The same of one link, of which a slide leaves what is across it.

    What the link has to reach there is ``beside + x u.c + y u.s``; x and y are the target.
    """

    beside: sp.Expr

    @classmethod
    def by_slide(
        cls,
        chain: Chain,
        target: tuple[sp.Expr, sp.Expr],
        beside: sp.Expr,
        length: sp.Expr,
        *,
        lever: sp.Expr,
    ) -> ReachingAcross:
        """For a link of this length."""
        none, lengths = Pair(sp.S.Zero, sp.S.One), (sp.sympify(length, strict=True), sp.S.Zero)
        return cls(chain, target, lengths, offset=sp.S.Zero, ahead=none, lever=lever, beside=beside)

    @property
    def _reach(self) -> tuple[sp.Expr, sp.Expr]:
        length, _ = self.lengths
        return -length - self.beside, length - self.beside

    @property
    def _turned(self) -> tuple[sp.Expr, sp.Expr]:
        return -self._r, self._r

    def _here(self, u: Pair) -> sp.Expr:
        x, y = self.target
        return x * u.c + y * u.s

    def _leaving(
        self, past: Offset, reach: sp.Expr, side: sp.Expr, name: str
    ) -> tuple[Pair, tuple[sp.Expr, ...]]:
        let = self.chain.program.let
        cc = let(f"k_{name}", sp.Max(0, self._r + reach), nonnegative=True)
        ss = let(f"d_{name}", sp.Max(0, self._r - reach), nonnegative=True)
        return past.turned(self.chain, (cc, ss, side), self.chain.size, name)


@dataclass(frozen=True)
class ReachingInPlane(ReachingAcross):
    """The same of two links in a plane, which have to reach a point at a ``height`` there.

    The angle turns the plane about the direction in which heights are measured.
    """

    height: sp.Expr

    @classmethod
    def by_links(
        cls,
        chain: Chain,
        target: tuple[sp.Expr, sp.Expr],
        point: tuple[sp.Expr, sp.Expr],
        lengths: tuple[sp.Expr, sp.Expr],
        *,
        lever: sp.Expr,
    ) -> ReachingInPlane:
        """For a ``point`` at ``x u.c + y u.s`` and the first coordinate, and at the second one."""
        none, (beside, height) = Pair(sp.S.Zero, sp.S.One), point
        exact = [sp.sympify(e, strict=True) for e in lengths]
        return cls(
            chain, target, (exact[0], exact[1]), offset=sp.S.Zero, ahead=none, lever=lever,
            beside=beside, height=height,
        )  # fmt: skip

    @property
    def _reach(self) -> tuple[sp.Expr, sp.Expr]:
        """That on the side of the axis on which the plane leads farther, and as near."""
        return self._on_side(self.beside)

    def _reach_near(self, there: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        return self._on_side(there + self.beside)

    def _on_side(self, where: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        low, high = on_side(where >= 0, *chord(self.lengths, sp.Abs(self.height)))
        return low - self.beside, high - self.beside


@chain_lemma("Rz(x1) Ry(x2) Rz(x3) = R", "the pair of x1")
def zyz(
    chain: Chain,
    R: sp.Matrix,
    unknowns: tuple[sp.Symbol, sp.Symbol, sp.Symbol],
    choice: Choice,
    *,
    reaching: Reaching | Callable[[Pair], Reaching] | None = None,
    name: str = "wrist",
) -> Applied:
    """``Rz(first) Ry(middle) Rz(last) = R``: two solutions, by the sign of sin(middle).

    The second solution is the first with a half turn of both outer angles.  The last angle is read
    from the rotation that the first leaves, which keeps the product exact near ``middle = 0``.
    There only ``first + last`` or ``first - last`` is determined; first is 0, or what keeps the
    rest of the arm within reach.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    R
        the rotation that the three angles make
    unknowns
        the angles that are solved for: first, middle and last
    choice
        the names of the two solutions, by the sign of sin(middle)
    reaching
        what the rest of the arm has to reach, if the first angle decides on it; if the middle one
        does too, a function of its pair
    name
        the name of the sign, and what other names end in
    """
    p, (first, middle, last) = chain.program, unknowns
    sigma = chain.sign(name, choice)
    free = next((a for a in (first, last) if a in chain.joints), None)
    if free is None:
        free = next(j for j in chain.joints if chain.defined[last].has(j))
    halves: dict[sp.Symbol, tuple[Pair, sp.Expr]] = {}
    unit: dict[sp.Expr, sp.Expr] = {}
    near: tuple[sp.Symbol, ...] = ()
    if reaching is None:
        angles = zyz_angles(p, R, unknowns, sigma, free=(free,), scale=ALIGNED, suffix=f"_{name}")
        lemma, aligned = angles.lemma, angles.aligned
        halves = {first: (angles.first, angles.flip), last: (angles.last, angles.flip)}
        halves[middle] = _tilt(R, angles.first, sigma), sp.S.Zero
        s, c = (choose(aligned, e, sigma * e) for e in (angles.first.s, angles.first.c))
        pair, means = named(chain, first, Pair(s, c))
    else:
        h = p.let(f"h_{name}", sp.sqrt(R[0, 2] ** 2 + R[1, 2] ** 2), nonnegative=True)
        aligned = p.vanishes(
            f"aligned_{name}", h, ALIGNED, "the first and the last axis are parallel", (free,)
        )
        if callable(reaching):
            reaching = reaching(Pair(p.let(f"s_{middle}", sigma * h), R[2, 2]))
        u = sigma * R[0, 2] / h, sigma * R[1, 2] / h
        found, near, unit = within_reach(reaching, u, h, first, aligned)
        pair, means = named(chain, first, found)
        lemma, _ = zyz_lemma(R, unknowns, pair)
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
    return Applied(
        lemma=lemma, result=pair, means=means, given=given, degenerate=tuple(cases), halves=halves
    )


def _tilt(R: sp.Matrix, first: Pair, side: sp.Expr) -> Pair:
    """The pair of the middle angle, for sums that contain it; ``side`` is the sign of its sine."""
    return Pair(side * (first.c * R[0, 2] + first.s * R[1, 2]), R[2, 2])


def within_reach(
    reaching: Reaching,
    u: tuple[sp.Expr, sp.Expr],
    h: sp.Symbol,
    first: sp.Symbol,
    aligned: sp.Symbol,
) -> tuple[Pair, tuple[sp.Symbol, ...], dict[sp.Expr, sp.Expr]]:
    """The first angle, in reach where the target does not determine it, or only up to rounding.

    Elsewhere its direction is ``u``, a vector that was divided by its length ``h``.  Also returns
    the flags of the latter case, and free choices as the sine and cosine of an angle.
    """
    p = reaching.chain.program
    # the pair of a joint is called by its label, and an article writes both names alike
    name = f"raw_{label(first)}" if first in reaching.chain.joints else first.name
    raw = Pair(
        p.let(f"s_{name}", choose(aligned, 0, u[1])),
        p.let(f"c_{name}", choose(aligned, 1, u[0])),
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


__all__ = [
    "ALIGNED",
    "Reaching",
    "ReachingAcross",
    "ReachingInPlane",
    "Zyz",
    "within_reach",
    "zyz",
    "zyz_angles",
    "zyz_lemma",
]
