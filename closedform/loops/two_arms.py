"""A hand that two arms and a rod hold, such as the upright of a wishbone suspension.

Both arms turn about hinges, and end in balls on the hand; one of them is driven, or is a slider.
The rod is fixed to the ground, or to a driven slider or crank, such as a steering rack.  The driven
arm determines the first ball.  The other arm has to reach it: the two balls have a given distance
on the hand.  A strut in which the hand slides may take the place of the other arm, as in a
MacPherson suspension: its ball stands still, and the distance of both balls says how far the hand
slid.  Then the end of the rod is where three spheres meet, and three points of the hand give its
pose.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from closedform.lemmas.legs import Crank, Naming, Slide, Solution, Strut, vector
from closedform.lemmas.lines import coordinate
from closedform.lemmas.missed import MOVED, SHARE
from closedform.lemmas.sliding_strut import SlidingStrut
from closedform.lemmas.spheres import three_spheres
from closedform.lemmas.two_vectors import two_vectors
from closedform.loops.hand import square
from closedform.loops.leg_by_leg import (
    SIGN,
    named,
    record_lemma,
    size_of,
    solution_of,
    where_free,
)
from closedform.loops.points import FREE_POINT, NEAR, named_point, require_triangle, with_roles
from closedform.loops.two_arms_hand import THIRD, Damper, Posture, TwoArms
from closedform.loops.two_arms_rates import draw, velocity
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, branches, real
from closedform.model.inverse import Inverse, Link
from closedform.model.step import Step

IN_LINE = "the three points of the hand are not in line"
MET = "both balls are close to each other"
NEARLY = "the end of the rod is close to the line of both balls"
ON_ARM = (
    "Two arms end in balls on the hand, in the points b of the first two rows, and a rod leads "
    "from the third one to the hand.  On the hand these ends are e, seen in its frame.  The rod "
    "has the length {tie}.  The angle {joint} of the second arm is not driven."
)
ON_STRUT = (
    "An arm ends in a ball on the hand, in the point b of the first row.  A ball at that of the "
    "second row holds a strut, in which the hand slides by {joint}, and a rod leads from the third "
    "one to the hand.  In the frame of the hand the balls and the end of the rod are e; the second "
    "ball is on the line of the strut.  The rod has the length {tie}.  The slide {joint} is not "
    "driven."
)
BY_ARM = (
    "The first arm gives its ball.  The second arm has to reach it with the side of the hand "
    "between both balls, in one of two ways.  "
)
BY_STRUT = (
    "The arm gives its ball.  Its distance from the ball of the strut says how far the hand slid, "
    "in one of two ways: on the hand a line meets a sphere.  "
)
BY_DAMPER = (
    "The damper {joint} leads from the ground to the first arm.  Its length gives the angle of "
    "this arm in one of two ways: a crank and a rod.  "
)
BY_ROD = (
    "The end C of the rod is at known distances from both balls and from the other end of the rod: "
    "three spheres meet in two points.  So there are {modes} assembly modes.  The three points "
    "give the rotation R of the hand, and so its position."
)


def two_arms(
    d: Derivation,
    driver: Crank | Slide,
    follower: Crank | SlidingStrut,
    tie: Strut | Slide | Crank,
    damper: Damper | None = None,
) -> None:
    """Derive and export a hand that two arms and a rod hold.

    It exports ``fk``, the pose of the hand in four assembly modes, or eight with a damper,
    ``jacobian``, ``singularities`` and ``skeleton``.  The hand moves along a curve, or on a surface
    if the rod is driven too, so there is no ``ik``.

    Parameters
    ----------
    d
        the derivation, with its parameters and one or two joints; its task becomes the pose
    driver
        the driven arm, or a slider.  It has no rod (0), and ends at ``on_hand``, which is seen from
        the point that is the hand, in the frame of the hand
    follower
        the other arm, which has no rod either, or a strut in which the hand slides; its joint is
        passive
    tie
        the rod, with its length: a ``Strut``, or a driven ``Slide`` or ``Crank``
    damper
        a cylinder that turns the first arm, whose joint is passive then
    """
    m = TwoArms(d, driver, follower, tie, damper)
    loop = d.loop = _state(m)
    at = _forward(m, loop)
    draw(m, at)
    velocity(m, at, loop)


def _state(m: TwoArms) -> Step:
    ends = (m.driver.end(), m.given.end(), m.tie.end())
    both = zip(ends, m.places, strict=True)
    rows = [(str(k), end.T, place.T) for k, (end, place) in enumerate(both, 1)]
    tie = sp.sympify(m.tie.rod, strict=True)
    return m.d.step(
        "The loop",
        (ON_STRUT if m.strut else ON_ARM).format(tie=tie, joint=m.given.joint) + _damped(m),
        {},
        rows=[("i", "b", "e"), *rows],
    )


def _damped(m: TwoArms) -> str:
    """What is said of the damper, if there is one."""
    if not (m.damper and m.pushed):
        return ""
    return (
        f"  The first arm is not driven either: the damper of length {m.damper.joint} leads from "
        f"{tuple(m.damper.base)} to its point {tuple(m.pushed.end())}."
    )


def _forward(m: TwoArms, loop: Step) -> Posture:
    d, f = m.d, m.d.program()
    arm, rod = real("sigma_arm"), real("sigma_rod")
    push = real("sigma_damper")
    modes = branches(*[(push, SIGN)] * bool(m.damper), (arm, SIGN), (rod, SIGN))
    d.assembly_modes = modes.labels
    slid = [e.joint for e in (m.driver, m.tie) if isinstance(e, Slide)]
    slid += [m.damper.joint] if m.damper else []
    size = f.let("size", size_of(d, (m.driver, m.given, m.tie), slid))
    naming = Naming(f, size, "_2", MOVED if slid else SHARE)
    pushed = _pushed(m, replace(naming, tag="_0"), push)
    second = (_on_strut if m.strut else _on_arm)(m, naming, arm, pushed)
    b, c, n = second.ball, second.at, second.near
    links = [*([pushed.link] if pushed else []), second.link]
    found = three_spheres(
        replace(f, suffix="_C"),
        [b, c, n],
        [*second.sides, _rod(f, m.tie)],
        tuple(THIRD),
        rod,
        scale=size,
        share=naming.share,
        free=tuple(THIRD),
    )
    end, link = named_point(f, found, THIRD, _roles(m))
    links.append(link)
    turned = [named(f, name, x - b) for name, x in zip("uv", (c, end), strict=True)]
    apart = require_triangle(f, second.spans, size, IN_LINE)
    first, other = second.spans
    length = f.let("length_d", sp.sqrt(square(first)), nonnegative=True)
    area = f.let("area", sp.sqrt(square(first.cross(other))), nonnegative=True)
    for value, meaning in ((length, MET), (area / length, NEARLY)):
        f.determined(value, 2 * size, meaning, size=size)
    link, R = two_vectors(f, second.spans, turned, m.pose[:3, :3])
    d_, e_ = m.spans
    roles: list[tuple[str, Any]] = [(r"\mathbf d", d_), (r"\mathbf e", e_)]
    roles += [(rf"\mathbf {x}", f"{e} - b_1") for x, e in zip("uv", ("b_2", "C"), strict=True)]
    links.append(with_roles(link, roles))
    position = named(f, "p", b - R * m.places[0])
    links += [coordinate(x, e) for x, e in zip(m.pose[:3, 3], position, strict=True)]
    told = len(links)
    links += [coordinate(x, sp.Integer(k == 3)) for k, x in enumerate(m.pose[3, :])]
    _state_modes(m, loop)
    solved = solution_of(links)
    d.function(
        "fk",
        "Pose of the hand in all assembly modes.",
        {"q": d.actuated},
        {"p": m.pose.xreplace(solved)},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            f"UNREACHABLE: the {'arm, the strut' if m.strut else 'arms'}"
            f"{', the damper' if m.damper else ''} or the rod do not reach.",
            *where_free([*([pushed.met] if pushed else []), second.met]),
            FREE_POINT,
            f"SINGULAR too where {MET}, or {NEARLY}.",
            *apart,
            NEAR,
        ),
    )
    d.inverses.append(
        Inverse(
            "fk",
            tuple(m.pose),
            (sp.S.Zero,) * len(m.equations),
            m.equations,
            links=tuple(links),
            passive=(*[m.driver.joint] * bool(m.damper), m.given.joint, *THIRD),
        )
    )
    for link in links[:told]:
        record_lemma(d, "fk", link)
    return Posture(
        program=Program(list(f.body), f.taken),
        modes=modes,
        position=position,
        rotation=R,
        ends=(b, c, end),
        spans=turned,
        near=n,
        pushed=pushed.end if pushed else None,
    )


@dataclass(frozen=True)
class _Pushed:
    """How a damper turns the first arm, in the names of a program."""

    met: Solution
    link: Link
    end: sp.Matrix
    """That of the damper on the arm."""
    ball: sp.Matrix


def _pushed(m: TwoArms, names: Naming, sigma: sp.Symbol) -> _Pushed | None:
    """The first arm, which a damper turns."""
    f, damper = names.program, m.damper
    if not (damper and m.pushed):
        return None
    arm, driver = m.pushed.named(names), m.driver
    assert isinstance(driver, Crank)
    base = named(f, "b_0", damper.base)
    met = arm.solve(names, base - arm.base, sigma)
    start = len(f.body)
    end = named(f, "e_0", base - met.rod)
    sine, cosine = met.value.args
    radius = f.let("radius_ball", sp.sqrt(sine**2 + cosine**2), nonnegative=True)
    c, s = f.let("c_0", cosine / radius), f.let("s_0", sine / radius)
    ahead, beside = (vector(e) for e in (driver.along, driver.across))
    ball = named(f, "b_1", driver.base + driver.length * (c * ahead + s * beside))
    means = dict(zip((*end, *ball), (*arm.end(), *driver.end()), strict=True))
    link = replace(met.link, body=(*met.link.body, *f.body[start:]), means=means)
    return _Pushed(met, link, end, ball)


@dataclass(frozen=True)
class _Second:
    """How the second ball is found, in the names of a program."""

    met: Solution
    link: Link
    """The same, with the statements that name what follows from the joint."""
    ball: sp.Matrix
    """That of the driven arm."""
    at: sp.Matrix
    near: sp.Matrix
    """The other end of the rod."""
    spans: Sequence[sp.Matrix]
    """The vectors from the first ball to the other ends, in the frame of the hand."""
    sides: Sequence[sp.Symbol]
    """The distances of the end of the rod from both balls."""


def _on_arm(m: TwoArms, names: Naming, sigma: sp.Symbol, pushed: _Pushed | None) -> _Second:
    """An arm that ends in the second ball."""
    f = names.program
    spans = [named(f, name, e) for name, e in zip("de", m.spans, strict=True)]
    b = pushed.ball if pushed else named(f, "b_1", m.driver.end())
    n = named(f, "b_3", m.tie.end())
    between, *sides = (
        f.let(name, e, nonnegative=True)
        for name, e in zip(("side_12", "side_13", "side_23"), m.sides, strict=True)
    )
    assert isinstance(m.given, Crank)
    arm = replace(m.given, rod=between).named(names)
    met = arm.solve(names, b - arm.base, sigma)
    start = len(f.body)
    c = named(f, "b_2", b - met.rod)
    body = (*met.link.body, *f.body[start:])
    link = replace(met.link, body=body, means=dict(zip(c, arm.end(), strict=True)))
    return _Second(met, link, ball=b, at=c, near=n, spans=spans, sides=sides)


def _on_strut(m: TwoArms, names: Naming, sigma: sp.Symbol, pushed: _Pushed | None) -> _Second:
    """A strut that holds the second ball, in which the hand slides."""
    f, strut = names.program, m.strut
    assert strut
    b = pushed.ball if pushed else named(f, "b_1", m.driver.end())
    c, n = (named(f, f"b_{k}", leg.end()) for k, leg in ((2, strut), (3, m.tie)))
    (d, e), first = m.spans, m.places[0]
    e = named(f, "e", e)
    distance = names.let("distance", sp.sqrt(square(c - b)), nonnegative=True)
    met = strut.solve(names, distance, first, sigma)
    start = len(f.body)
    found = named(f, "d", strut.reached(met.value) - first)
    body = (*met.link.body, *f.body[start:])
    link = replace(met.link, body=body, means=dict(zip(found, d, strict=True)))
    sides = [
        f.let(name, sp.sqrt(square(x)), nonnegative=True)
        for name, x in (("side_13", e), ("side_23", e - found))
    ]
    return _Second(met, link, ball=b, at=c, near=n, spans=[found, e], sides=sides)


def _rod(f: Program, tie: Strut | Slide | Crank) -> sp.Expr:
    """The length of the rod, under a name."""
    rod = sp.sympify(tie.rod, strict=True)
    return rod if rod.is_Symbol else f.let("r_3", rod, nonnegative=bool(rod.is_nonnegative))


def _roles(m: TwoArms) -> tuple[tuple[str, Any], ...]:
    """What the letters of the lemma on three spheres stand for."""
    lengths = [*m.sides[1:], sp.sympify(m.tie.rod, strict=True)]
    names = zip((r"\mathbf x", r"\mathbf a", r"\mathbf c_3"), ("C", "b_2", "b_3"), strict=True)
    return (
        *((letter, f"{point} - b_1") for letter, point in names),
        *((f"r_{k}", length) for k, length in enumerate(lengths, 1)),
    )


def _state_modes(m: TwoArms, loop: Step) -> None:
    """The step on the assembly modes."""
    R, (first, _, third) = m.pose[:3, :3], m.places
    rod = sp.sympify(m.tie.rod, strict=True)
    reached = m.driver.end() + R * (third - first)
    at = dict(zip(THIRD, reached, strict=True))
    length = square(reached - m.tie.end()) - rod**2
    second = "strut" if m.strut else "second arm"
    m.d.step(
        f"Forward: {'the damper, ' * bool(m.damper)}the {second}, and three spheres",
        (BY_DAMPER.format(joint=m.damper.joint) if m.damper else "")
        + (BY_STRUT if m.strut else BY_ARM)
        + BY_ROD.format(modes="eight" if m.damper else "four"),
        {},
        proves="The end of the rod satisfies its equation if and only if the pose does.",
        equal=[(m.rod.xreplace(at), length)],
        uses=[loop],
        solves={"fk": ()},
    )


__all__ = ["Damper", "two_arms"]
