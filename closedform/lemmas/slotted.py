"""A single loop whose pin slides along a lever: the inversions of the slider-crank.

A pin at the end of a crank is on a line of a lever that turns about another pivot.  The crank may
drive the lever (the quick-return mechanism of Whitworth, an oscillating cylinder), or the lever the
crank.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.amplitude import Amplitude
from closedform.lemmas.coupled import POSITION
from closedform.lemmas.hand import check_plain, in_space
from closedform.lemmas.leg_by_leg import MISSED, SIGN, Choice, record_lemma, size_of, where_free
from closedform.lemmas.legs import Crank, Naming, Solution, vector
from closedform.lemmas.missed import SHARE
from closedform.lemmas.modes import EQUATIONS, NO_MODE, Exported, export
from closedform.lemmas.reached import bounds_of
from closedform.mechanics.loops import velocity_matrices
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, branches, choose, real
from closedform.model.inverse import Degenerate, Inverse, Link
from closedform.model.pair import Pair
from closedform.model.step import Step


@dataclass(frozen=True)
class Lever:
    """A lever that turns about ``pivot`` in a plane, with a line along which a pin slides.

    At the angle 0 the line has the direction of the unit vector ``along``, and at 90 degrees that
    of ``across``, at right angles to it.  Its distance from the pivot is ``offset``, positive on
    the side of ``across`` at the angle 0.  ``slide`` is the passive joint: how far the pin is along
    the line.
    """

    joint: sp.Symbol
    slide: sp.Symbol
    pivot: Sequence[Any]
    along: Sequence[Any]
    across: Sequence[Any]
    offset: Any = 0
    on_hand: Sequence[Any] = ()

    @property
    def rod(self) -> sp.Expr:
        """The offset as a length, as in formulas for any leg."""
        return sp.sympify(self.offset, strict=True)

    @property
    def base(self) -> sp.Matrix:
        return vector(self.pivot)

    def normal(self, pair: Pair) -> sp.Matrix:
        """The unit vector across the line, at an angle with this sine and cosine."""
        return pair.c * vector(self.across) - pair.s * vector(self.along)

    def foot(self, pair: Pair) -> sp.Matrix:
        """The point of the line that is nearest to the pivot."""
        return self.base + self.rod * self.normal(pair)


def slotted(
    d: Derivation,
    driver: Crank | Lever,
    follower: Crank | Lever,
    modes: Choice = POSITION,
) -> None:
    """Derive and export a loop of a crank and a lever, along which the pin of the crank slides.

    Parameters
    ----------
    d
        the derivation, with its parameters, one driven joint and the passive slide; the task has
        one coordinate
    driver, follower
        the crank, whose rod has no length, and the lever; the joint of the driver is that of the
        derivation, and the joint of the follower is the symbol of the task
    modes
        the names of the assembly modes, by the sign of ``jacobian_parallel``
    """
    cranks = [leg for leg in (driver, follower) if isinstance(leg, Crank)]
    levers = [leg for leg in (driver, follower) if isinstance(leg, Lever)]
    if len(cranks) != 1 or cranks[0].rod != 0:
        raise ShapeError(
            f"{d.name}: a pin at the end of a crank without a rod slides along a lever"
        )
    check_plain(d, cranks)
    m = _Slotted(d, driver, follower, cranks[0], levers[0])
    d.singularities, d.poles = ("driver", "follower"), ("follower",)
    d.loop = loop = d.step(
        "The loop",
        "The crank turns about A1 and determines the point P of the pin, which is on the line of "
        "the lever.  The lever turns about A2, and n is the unit normal of its line.",
        {
            r"\mathbf P": m.crank.end(),
            r"\mathbf n": m.lever.normal(_exact(m.lever.joint)),
            r"\mathbf n\cdot(\mathbf P - \mathbf A_2)": m.lever.rod,
        },
    )
    d.explain({r"\mathbf P": "pin", r"\mathbf n": "unit normal of the line of the lever"})
    d.explain({r"\mathbf A_2": "pivot of the lever"})
    at = _forward(m, modes, loop)
    _draw(m, at)
    _velocity(m, at, loop)
    _inverse(m, loop)


def _exact(joint: sp.Symbol) -> Pair:
    return Pair(sp.sin(joint), sp.cos(joint))


@dataclass(frozen=True)
class _Slotted:
    """The loop of a derivation: both bodies, in either order."""

    d: Derivation
    driver: Crank | Lever
    follower: Crank | Lever
    crank: Crank
    lever: Lever

    @property
    def equation(self) -> sp.Expr:
        normal = self.lever.normal(_exact(self.lever.joint))
        return normal.dot(self.crank.end() - self.lever.base) - self.lever.rod

    def size(self) -> sp.Expr:
        return size_of(self.d, (self.crank, self.lever))

    def solve(self, of: Crank | Lever, names: Naming, sigma: sp.Symbol, side: int) -> _Turned:
        """The joint of one body, if that of the other one is known.

        The derivative of the equation with respect to it has the sign ``-side * sigma``.
        """
        if isinstance(of, Lever):
            w = self.crank.end() - of.base
            a, b = -w.dot(vector(of.along)), w.dot(vector(of.across))
            c, met = of.rod, "the pin is at the pivot of its lever"
        else:
            n, length = (
                self.lever.normal(_exact(self.lever.joint)),
                sp.sympify(of.length, strict=True),
            )
            a, b = (length * n.dot(vector(e)) for e in (of.across, of.along))
            c, met = self.lever.rod - n.dot(of.base - self.lever.base), "a crank has no length"
        sides = [side * sp.expand(e) for e in (a, b, c)]
        return _turned(names, of.joint, sides, sigma, met)


@dataclass(frozen=True)
class _Turned:
    """The joint of one body, and the sine and cosine of its angle in the names of a program."""

    found: Solution
    pair: Pair


def _turned(
    names: Naming, x: sp.Symbol, sides: Sequence[sp.Expr], sigma: sp.Symbol, met: str
) -> _Turned:
    """``a sin x + b cos x = c``, also where a and b vanish."""
    p = names.program
    a, b = (names.let(n, e) for n, e in zip("ab", sides, strict=False))
    c = names.coefficient("c", sides[2]) if sides[2] else sp.S.Zero
    start = len(p.body)
    scale = names.size * names.share
    found = Amplitude.of(p, x, (a, b, c), sigma, scale=lambda _: scale, suffix=names.tag)
    root = names.let("root", found.root, nonnegative=True)
    none = names.vanishes("none", found.h, met, x)
    ahead = names.let("ahead", (found.above - found.below) / 2)
    sine = names.let("sine", choose(none, 0, a * ahead + sigma * b * root))
    cosine = names.let("cosine", choose(none, 1, b * ahead - sigma * a * root))
    width = names.let(
        "width", choose(none, 1, found.h * (found.above + found.below) / 2), nonnegative=True
    )
    lemma = found.lemma(
        sp.atan2(sine, cosine),
        r"\sigma\operatorname{atan2}(\sqrt{(h-c)(h+c)}, c),\ h = \sqrt{a^2+b^2}",
    )
    locus = {a: sp.S.Zero, b: sp.S.Zero} | ({c: sp.S.Zero} if c.is_Symbol else {})
    case = Degenerate((none,), locus, x, met)
    link = Link((x,), lemma.equations, {}, lemma, tuple(p.body[start:]), degenerate=(case,))
    missed = names.let("missed", sp.Max(0, sp.Abs(c) - found.h))
    return _Turned(
        Solution(link, lemma[x], sp.zeros(2, 1), missed), Pair(sine / width, cosine / width)
    )


@dataclass(frozen=True)
class _Posture:
    """The follower in an assembly mode, in the names of a program."""

    program: Program
    modes: Branches
    pair: Pair


def _forward(m: _Slotted, choice: Choice, loop: Step) -> _Posture:
    d, f, sigma, x = m.d, m.d.program(), real("sigma_assembly"), m.follower.joint
    modes = branches((sigma, choice))
    d.assembly_modes = modes.labels
    names = Naming(f, f.let("size", m.size()), "", SHARE)
    solved = m.solve(m.follower, names, sigma, -1)
    how = (
        "The line of the lever has to pass by the pin.  It does so with the pin on either side of "
        "the point of the line that is nearest to the pivot."
        if isinstance(m.follower, Lever)
        else "The pin is where the line of the lever meets the circle of the crank."
    )
    d.step(
        "Forward: the follower",
        f"{how}  Both solutions are assembly modes.",
        {},
        uses=[loop],
    )
    d.function(
        "fk",
        f"{x} in both assembly modes.",
        {"q": d.actuated},
        {"p": [solved.found.value]},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            "UNREACHABLE: the pin does not reach the line of the lever.",
            *where_free([solved.found]),
            "Ill-conditioned near the parallel singularity, where both modes meet.",
        ),
    )
    link = solved.found.link
    d.inverses.append(Inverse("fk", (x,), (sp.S.Zero,), (-m.equation,), links=(link,)))
    record_lemma(d, "fk", link)
    v = Program(list(f.body), f.taken)
    pair = Pair(v.let("sine_x", solved.pair.s), v.let("cosine_x", solved.pair.c))
    return _Posture(v, modes, pair)


def _points(m: _Slotted, crank: Pair, lever: Pair) -> dict[str, sp.Matrix]:
    arm = crank.c * vector(m.crank.along) + crank.s * vector(m.crank.across)
    pin = m.crank.base + sp.sympify(m.crank.length, strict=True) * arm
    foot = {"F": m.lever.foot(lever)} if m.lever.rod else {}
    return {"A1": m.crank.base, "P": pin, "A2": m.lever.base, **foot}


def _draw(m: _Slotted, at: _Posture) -> None:
    exact = [_exact(leg.joint) for leg in (m.crank, m.lever)]
    known = [at.pair if leg is m.follower else _exact(leg.joint) for leg in (m.crank, m.lever)]
    foot = ["F"] if m.lever.rod else []
    near = (*foot, "A2")[0]
    turning = "A1" if m.driver is m.crank else "A2"
    lever = {"lever": ("A2", "F")} if foot else {}
    lengths = {("A1", "P"): sp.sympify(m.crank.length, strict=True)}
    if foot:
        lengths["A2", "F"] = m.lever.rod
    skeleton(
        m.d,
        {name: in_space(place) for name, place in _points(m, *known).items()},
        links={"ground": ("A1", "A2"), "crank": ("A1", "P")} | lever,
        joints={m.driver.joint: (turning,), m.lever.slide: (near, "P")},
        hand="P",
        hand_at=in_space(m.crank.end()),
        ground=("A1", "A2"),
        lengths=lengths,
        program=at.program,
        branches=at.modes,
        notes=(NO_MODE,),
        at_posture=[{n: in_space(place) for n, place in _points(m, *exact).items()}],
    )


def _velocity(m: _Slotted, at: _Posture, loop: Step) -> None:
    d, q, x = m.d, m.driver.joint, m.follower.joint
    A, B = velocity_matrices([m.equation], (x,), (q,))
    a, b = (sp.collect(sp.expand(e[0]), [sp.sin(x), sp.cos(x)]) for e in (A, B))
    d.step(
        "Velocity and singular sets",
        "The derivative of the equation of the loop gives A*dx = B*dq.  With respect to the angle "
        "of the lever it is, up to the sign, the distance of the pin from the point of the line "
        "that is nearest to the pivot.  With respect to the angle of the crank it vanishes where "
        "the crank is at right angles to the line.  If A vanishes, the follower can move while the "
        "driver stands still (parallel).  If B vanishes, the follower stands still (serial).",
        {"A": a, "B": b, "J": r"\frac{B}{A}"},
        proves="A and B are the derivatives.",
        equal=[(A[0], a), (B[0], b)],
        uses=[loop],
    )
    v = Program(list(at.program.body), at.program.taken)
    seen = {sp.sin(x): at.pair.s, sp.cos(x): at.pair.c}
    A_at, B_at = v.let("A", a.xreplace(seen)), v.let("B", b.xreplace(seen))
    pole = "Not finite at a parallel singularity."
    functions: list[Exported] = [
        ("jacobian_parallel", "A of A*dx = B*dq.", {"A": [[A_at]]}, ()),
        (
            "jacobian_serial",
            "B of A*dx = B*dq.",
            {"B": [B_at]},
            ("Its sign distinguishes the working modes.",),
        ),
        ("jacobian", "Derivative of x with respect to q: B/A.", {"J": [[B_at / A_at]]}, (pole,)),
        ("determinant", "The Jacobian as a number: B/A.", {"det": B_at / A_at}, (pole,)),
        ("singularities", "B (serial) and A (parallel).", {"factors": [B_at, A_at]}, ()),
    ]
    export(d, v, at.modes, functions, {**EQUATIONS, "det": "J", "factors": "A"})


def _inverse(m: _Slotted, loop: Step) -> None:
    d, g, sigma = m.d, m.d.program(), real("sigma_driver")
    q, x = m.driver.joint, m.follower.joint
    size = g.let("size", m.size())
    solved = m.solve(m.driver, Naming(g, size, ""), sigma, 1)
    inside = bounds_of(g)
    A = velocity_matrices([m.equation], (x,), (q,))[0][0]
    seen = {sp.sin(q): solved.pair.s, sp.cos(q): solved.pair.c}
    named = g.let("A", sp.expand(A).xreplace(seen))
    meant = "the pin is where the follower can move alone"
    g.determined(sp.Abs(named), size, meant, name="|A|", missed=solved.found.missed, size=size)
    working = branches((sigma, SIGN))
    d.branches = working.labels
    d.step(
        "Inverse: the driver",
        "The same equation is solved for the driver.  The sign of B tells its two solutions "
        "apart.  Near a parallel singularity rounded joints do not determine the follower, however "
        "they are computed.  A rounding error of the lengths turns it by this error over A.  The "
        f"status is SINGULAR if A is less than 2^-10 of the sum of all lengths.  {MISSED}",
        {},
        uses=[loop],
    )
    d.function(
        "ik",
        "The driven joint in both working modes.",
        {"x": (x,)},
        {"q": [solved.found.value]},
        program=g,
        branches=working,
        result="Solutions",
        notes=(
            "UNREACHABLE: the pin does not reach the line of the lever.",
            *where_free([solved.found]),
            f"SINGULAR also near the parallel singularity, where {meant}.",
        ),
    )
    d.function(
        "workspace_contains",
        "Whether the follower can reach the target.",
        {"p": (x,)},
        {"inside": sp.true},
        program=inside,
        boolean=True,
    )
    link = solved.found.link
    record_lemma(d, "ik", link)
    d.inverses.append(
        Inverse(
            "ik",
            d.actuated,
            (sp.S.Zero,),
            (m.equation,),
            images="fk",
            links=(link,),
            angles=(x,),
        )
    )


__all__ = ["Lever", "slotted"]
