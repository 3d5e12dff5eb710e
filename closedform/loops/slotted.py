"""A single loop whose pin slides along a lever or a slider: inversions of the slider-crank.

A pin at the end of a crank is on a line of a lever, which turns about another pivot, or of a
slider.  With a lever it is a quick-return mechanism or a cylinder that swings about its end, with a
slider a Scotch yoke.  Either of both bodies may be driven.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.amplitude import Amplitude
from closedform.lemmas.legs import Crank, Naming, Solution, vector
from closedform.lemmas.missed import MOVED, SHARE
from closedform.lemmas.rails import Rail
from closedform.loops.coupled import POSITION, export_rates
from closedform.loops.hand import check_plain, in_space
from closedform.loops.leg_by_leg import MISSED, SIGN, Choice, record_lemma, size_of, where_free
from closedform.loops.letters import letters
from closedform.loops.modes import NO_MODE
from closedform.loops.reached import bounds_of, export_reach
from closedform.mechanics.loops import velocity_matrices
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import SINGLE, Branches, Program, branches, choose, real
from closedform.model.inverse import Degenerate, Inverse, Link
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

    @property
    def normal(self) -> sp.Matrix:
        """The unit vector across the line."""
        return sp.cos(self.joint) * vector(self.across) - sp.sin(self.joint) * vector(self.along)

    @property
    def level(self) -> sp.Expr:
        """How far the line is from the origin, along its normal."""
        return self.normal.dot(self.base) + self.rod

    def foot(self) -> sp.Matrix:
        """The point of the line that is nearest to the pivot."""
        return self.base + self.rod * self.normal


def slotted(
    d: Derivation,
    driver: Crank | Lever | Rail,
    follower: Crank | Lever | Rail,
    modes: Choice = POSITION,
) -> None:
    """Derive and export a loop of a crank and a line, along which the pin of the crank slides.

    Parameters
    ----------
    d
        the derivation, with its parameters, one driven joint and the passive slide; the task has
        one coordinate
    driver, follower
        the crank, whose rod has no length, and the lever or slider with the line; the joint of the
        driver is that of the derivation, and the joint of the follower is the symbol of the task
    modes
        the names of the assembly modes, by the sign of ``jacobian_parallel``
    """
    cranks = [leg for leg in (driver, follower) if isinstance(leg, Crank)]
    lines = [leg for leg in (driver, follower) if not isinstance(leg, Crank)]
    if len(cranks) != 1 or cranks[0].rod != 0:
        raise ShapeError(f"{d.name}: the pin must be at the end of a crank without a rod")
    check_plain(d, cranks)
    m = _Slotted(d, driver, follower, cranks[0], lines[0])
    d.singularities = ("driver", "follower")
    d.poles = () if isinstance(follower, Rail) else ("follower",)
    if isinstance(m.line, Lever):
        where, carrier, distance = "pivot", "lever.  The lever turns about", m.line.rod
    else:
        where, carrier = "start", "slider.  The slider starts at"
        distance = m.normal.dot(m.line.rate) * m.line.joint
    (n,) = letters(d, "n")
    d.loop = loop = d.step(
        "The loop",
        "The crank turns about A1 and determines the point P of the pin, which is on the line of "
        f"the {carrier} A2, and {n} is the unit normal of its line.",
        {
            r"\mathbf P": m.crank.end(),
            rf"\mathbf {n}": m.line.normal,
            rf"\mathbf {n}\cdot(\mathbf P - \mathbf A_2)": distance,
        },
    )
    d.explain({r"\mathbf P": "pin", rf"\mathbf {n}": "unit normal of the line of the pin"})
    d.explain({r"\mathbf A_2": f"{where} of the body with the line"})
    at = _forward(m, modes, loop)
    _draw(m, at)
    _velocity(m, at, loop)
    _inverse(m, loop)


@dataclass(frozen=True)
class _Slotted:
    """The loop of a derivation: the crank with its pin, and the body with the line."""

    d: Derivation
    driver: Crank | Lever | Rail
    follower: Crank | Lever | Rail
    crank: Crank
    line: Lever | Rail

    @property
    def normal(self) -> sp.Matrix:
        return self.line.normal

    @property
    def level(self) -> sp.Expr:
        """How far the line is from the origin, along its normal."""
        line = self.line
        return line.level if isinstance(line, Lever) else line.normal.dot(line.end())

    @property
    def equation(self) -> sp.Expr:
        return self.normal.dot(self.crank.end()) - self.level

    def names(self, program: Program, known: Crank | Lever | Rail, share: sp.Rational) -> Naming:
        """Names for what follows from the joint of one body."""
        moved = [known.joint] if isinstance(known, Rail) else []
        size = program.let("size", size_of(self.d, (self.crank, self.line), moved))
        return Naming(program, size, "", share)

    def solve(self, of: Crank | Lever | Rail, names: Naming, sigma: sp.Symbol, side: int) -> Known:
        """The joint of one body, if that of the other one is known.

        The equation is taken times ``side``, and its derivative has the sign of ``-sigma``.
        """
        if isinstance(of, Rail):
            found = of.solve(names, self.crank.end() - of.base, sigma)
            return Known(found, {of.joint: found.value})
        if isinstance(of, Lever):
            w = self.crank.end() - of.base
            sides = (-w.dot(vector(of.along)), w.dot(vector(of.across)), of.rod)
            met = "the pin is at the pivot of its lever"
        else:
            arms = (sp.sympify(of.length, strict=True) * vector(e) for e in (of.across, of.along))
            sides = (*map(self.normal.dot, arms), self.level - self.normal.dot(of.base))
            met = "a crank has no length"
        return turned_to_line(names, of.joint, [side * sp.expand(e) for e in sides], sigma, met)

    def points(self) -> dict[str, sp.Matrix]:
        """The points that are drawn: pivots, pin, and a point of the line."""
        foot = {} if self.near == "A2" else {self.near: self.foot()}
        return {"A1": self.crank.base, "P": self.crank.end(), "A2": self.line.base, **foot}

    @property
    def near(self) -> str:
        """The point from which the pin slides."""
        return "A2" if isinstance(self.line, Lever) and self.line.rod == 0 else "F"

    def foot(self) -> sp.Matrix:
        return self.line.foot() if isinstance(self.line, Lever) else self.line.end()


@dataclass(frozen=True)
class Known:
    """The joint of one body, and what its sine and cosine are in the names of a program."""

    found: Solution
    known: dict[sp.Basic, sp.Expr]


def turned_to_line(
    names: Naming, x: sp.Symbol, sides: Sequence[sp.Expr], sigma: sp.Symbol, met: str
) -> Known:
    """``a sin x + b cos x = c``, also where a and b vanish."""
    p = names.program
    a, b = (names.let(n, e) for n, e in zip("ab", sides, strict=False))
    c = names.coefficient("c", sides[2]) if sides[2] else sp.S.Zero
    start = len(p.body)
    scale = names.size * names.share
    found = Amplitude.of(p, x, (a, b, c), sigma, scale=lambda _: scale, suffix=names.tag)
    root = names.let("root", found.root, nonnegative=True)
    none: sp.Basic = sp.false
    if not all(p.explicit(e).is_number for e in (a, b)):
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
    cases = () if none == sp.false else (Degenerate((none,), locus, x, met),)
    link = Link((x,), lemma.equations, {}, lemma, tuple(p.body[start:]), degenerate=cases)
    missed = names.let("missed", sp.Max(0, sp.Abs(c) - found.h))
    known = {sp.sin(x): sine / width, sp.cos(x): cosine / width}
    return Known(Solution(link, lemma[x], sp.zeros(2, 1), missed), known)


@dataclass(frozen=True)
class _Posture:
    """The follower in an assembly mode, in the names of a program."""

    program: Program
    modes: Branches
    known: dict[sp.Basic, sp.Expr]


def _forward(m: _Slotted, choice: Choice, loop: Step) -> _Posture:
    d, f, sigma, x = m.d, m.d.program(), real("sigma_assembly"), m.follower.joint
    linear = isinstance(m.follower, Rail)
    modes = SINGLE if linear else branches((sigma, choice))
    d.assembly_modes = modes.labels
    names = m.names(f, m.driver, MOVED if isinstance(m.driver, Rail) else SHARE)
    solved, side = m.solve(m.follower, names, sigma, -1), 1 if linear else -1
    if linear:
        how = "The equation of the loop is linear in the joint of the slider."
    elif m.follower is m.line:
        how = (
            "The line of the lever has to pass by the pin.  It does so with the pin on either side "
            "of the point of the line that is nearest to the pivot.  Both are assembly modes."
        )
    else:
        how = (
            "The pin is where the line meets the circle of the crank.  Both points are assembly "
            "modes."
        )
    d.step("Forward: the follower", how, {}, uses=[loop])
    notes = (
        *["UNREACHABLE: the pin does not reach the line."] * (not linear),
        *where_free([solved.found]),
        *["Ill-conditioned near the parallel singularity, where both modes meet."] * (not linear),
    )
    d.function(
        "fk",
        f"{x}{'' if linear else ' in both assembly modes'}.",
        {"q": d.actuated},
        {"p": [solved.found.value]},
        program=f,
        branches=modes,
        result="Positions",
        notes=notes,
    )
    link = solved.found.link
    d.inverses.append(Inverse("fk", (x,), (sp.S.Zero,), (side * m.equation,), links=(link,)))
    record_lemma(d, "fk", link)
    v = Program(list(f.body), f.taken)
    known = {e: v.let(f"{e.func.__name__}_x", value) for e, value in solved.known.items()}
    return _Posture(v, modes, known)


def _draw(m: _Slotted, at: _Posture) -> None:
    exact = {name: in_space(place) for name, place in m.points().items()}
    turning = "A1" if m.driver is m.crank else "A2"
    links = {"ground": ("A1", "A2"), "crank": ("A1", "P")}
    lengths = {("A1", "P"): sp.sympify(m.crank.length, strict=True)}
    joints: dict[sp.Symbol, tuple[str, ...]] = {m.line.slide: (m.near, "P")}
    if isinstance(m.line, Rail):
        lengths["A2", m.near] = m.line.joint
    elif m.line.rod:
        links["lever"] = "A2", m.near
        lengths["A2", m.near] = m.line.rod
    joints[m.driver.joint] = ("A2", m.near) if isinstance(m.driver, Rail) else (turning,)
    skeleton(
        m.d,
        {name: [e.xreplace(at.known) for e in place] for name, place in exact.items()},
        links=links,
        joints=joints,
        hand="P",
        hand_at=in_space(m.crank.end()),
        ground=("A1", "A2"),
        lengths=lengths,
        program=at.program,
        branches=at.modes,
        notes=(NO_MODE,) * (not isinstance(m.follower, Rail)),
        at_posture=[exact],
    )


def _velocity(m: _Slotted, at: _Posture, loop: Step) -> None:
    d, q, x = m.d, m.driver.joint, m.follower.joint
    A, B = velocity_matrices([m.equation], (x,), (q,))
    a, b = (sp.collect(sp.expand(e[0]), [sp.sin(x), sp.cos(x)]) for e in (A, B))
    d.step(
        "Velocity and singular sets",
        "The derivative of the equation of the loop gives A*dx = B*dq.  With respect to "
        + (
            "the angle of the lever it is, up to the sign, the distance of the pin from the point "
            "of the line that is nearest to the pivot."
            if isinstance(m.line, Lever)
            else "the joint of the slider it is a constant."
        )
        + "  With respect to the angle of the crank it vanishes where the crank is at right angles "
        "to the line.  If A vanishes, the follower can move while the driver stands still "
        "(parallel).  If B vanishes, the follower stands still (serial).",
        {"A": a, "B": b, "J": r"\frac{B}{A}"},
        proves="A and B are the derivatives.",
        equal=[(A[0], a), (B[0], b)],
        uses=[loop],
    )
    v = Program(list(at.program.body), at.program.taken)
    A_at, B_at = v.let("A", a.xreplace(at.known)), v.let("B", b.xreplace(at.known))
    export_rates(d, v, at.modes, (A_at, B_at), two_modes=not isinstance(m.driver, Rail))


def _inverse(m: _Slotted, loop: Step) -> None:
    d, g, sigma = m.d, m.d.program(), real("sigma_driver")
    q, x, linear = m.driver.joint, m.follower.joint, isinstance(m.driver, Rail)
    names = m.names(g, m.follower, sp.S.Half)
    solved, inside = m.solve(m.driver, names, sigma, 1), bounds_of(g)
    A = velocity_matrices([m.equation], (x,), (q,))[0][0]
    alone, why = "the pin is where the follower can move alone", ""
    if d.poles:
        value, missed = g.let("A", sp.expand(A).xreplace(solved.known)), solved.found.missed
        g.determined(sp.Abs(value), names.size, alone, name="|A|", missed=missed, size=names.size)
        why = (
            "  Near a parallel singularity rounded joints do not determine the follower, however "
            "they are computed.  A rounding error of the lengths turns it by this error over A.  "
            "The status is SINGULAR if A is less than 2^-10 of the sum of all lengths.  "
            f"{MISSED}"
        )
    working = SINGLE if linear else branches((sigma, SIGN))
    d.branches = working.labels
    solutions = "It is linear in it" if linear else "The sign of B tells its two solutions apart"
    d.step(
        "Inverse: the driver",
        f"The same equation is solved for the driver.  {solutions}.{why}",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    d.function(
        "ik",
        f"The driven joint in {'the only working mode' if linear else 'both working modes'}.",
        {"x": (x,)},
        {"q": [solved.found.value]},
        program=g,
        branches=working,
        result="Solutions",
        notes=(
            *["UNREACHABLE: the pin does not reach the line."] * bool(inside.body),
            *where_free([solved.found]),
            *[f"SINGULAR also near the parallel singularity, where {alone}."] * bool(d.poles),
        ),
    )
    export_reach(d, inside, {"p": (x,)}, "the follower")
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
            angles=() if isinstance(m.follower, Rail) else (x,),
        )
    )


__all__ = ["Lever", "slotted", "turned_to_line"]
