"""A hand that two arms and a rod hold, such as the upright of a wishbone suspension.

Both arms turn about hinges, and end in balls on the hand; one of them is driven, or is a slider.
The rod is fixed to the ground, or to a driven slider or crank, such as a steering rack.  The driven
arm determines the first ball.  The other arm has to reach it: the two balls have a given distance
on the hand.  Then the end of the rod is where three spheres meet, and three points of the hand give
its pose.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Crank, Naming, Slide, Strut, vector
from closedform.lemmas.lines import coordinate
from closedform.lemmas.missed import MOVED, SHARE
from closedform.lemmas.spheres import three_spheres
from closedform.lemmas.two_vectors import two_vectors
from closedform.loops.hand import check_plain, in_space, square
from closedform.loops.leg_by_leg import (
    SIGN,
    named,
    record_lemma,
    size_of,
    solution_of,
    where_free,
)
from closedform.loops.letters import letters
from closedform.loops.modes import NO_MODE, export
from closedform.loops.points import (
    FREE_POINT,
    NEAR,
    named_point,
    require_triangle,
    side_length,
    with_roles,
)
from closedform.mechanics.frames import pose_symbols
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, branches, real
from closedform.model.inverse import Inverse
from closedform.model.step import Step

IN_LINE = "the three points of the hand are not in line"
THIRD = sp.Matrix([real(f"C_{i}") for i in "xyz"])
"""The coordinates of the end of the rod on the hand."""
ARMS, ROD = "arm at right angles to the hand", "rod in the plane of the hand"


def two_arms(
    d: Derivation, driver: Crank | Slide, follower: Crank, tie: Strut | Slide | Crank
) -> None:
    """Derive and export a hand that two arms and a rod hold.

    It exports ``fk``, the pose of the hand in four assembly modes, ``jacobian``, ``singularities``
    and ``skeleton``.  The hand moves along a curve, or on a surface if the rod is driven too, so
    there is no ``ik``.

    Parameters
    ----------
    d
        the derivation, with its parameters and one or two joints; its task becomes the pose
    driver
        the driven arm, or a slider.  It has no rod (0), and ends at ``on_hand``, which is seen from
        the point that is the hand, in the frame of the hand
    follower
        the other arm, which has no rod either; its joint is a symbol, not a joint of ``d``
    tie
        the rod, with its length: a ``Strut``, or a driven ``Slide`` or ``Crank``
    """
    m = TwoArms(d, driver, follower, tie)
    loop = d.loop = _state(m)
    at = _forward(m, loop)
    _draw(m, at)
    _velocity(m, at, loop)


@dataclass(frozen=True)
class TwoArms:
    """The arms and the rod of a hand."""

    d: Derivation
    driver: Crank | Slide
    given: Crank
    tie: Strut | Slide | Crank

    def __post_init__(self) -> None:
        d, name = self.d, self.d.name
        for leg in (self.driver, self.given, self.tie):
            if not isinstance(leg, Strut):
                check_plain(d, [leg])
        driven = tuple(e.joint for e in (self.driver, self.tie) if not isinstance(e, Strut))
        if driven != d.actuated:
            raise ShapeError(f"{name}: its joints must be those of the driven arm and of the rod")
        if self.driver.rod != 0 or self.given.rod != 0:
            raise ShapeError(f"{name}: both arms end on the hand, so their rods have the length 0")
        if any(len(place) != len(THIRD) for place in self.places):
            raise ShapeError(f"{name}: each arm and the rod end on_hand, at a point in space")
        if self.normal.is_zero_matrix:
            raise ShapeError(f"{name}: the arms and the rod end in line; the hand turns freely")
        d.task = [*map(str, pose_symbols())]
        d.singularities = d.poles = (ARMS, ROD)

    @cached_property
    def pose(self) -> sp.Matrix:
        return pose_symbols()

    @property
    def places(self) -> list[sp.Matrix]:
        """The ends of the arms and of the rod, in the frame of the hand."""
        return [vector(e.on_hand) for e in (self.driver, self.given, self.tie)]

    @property
    def spans(self) -> list[sp.Matrix]:
        """The vectors from the end of the driven arm to the other ends."""
        first, *others = self.places
        return [place - first for place in others]

    @property
    def normal(self) -> sp.Matrix:
        first, second = self.spans
        return first.cross(second).applyfunc(sp.expand)

    @property
    def sides(self) -> list[sp.Expr]:
        """The lengths of the spans, and the distance of their ends."""
        first, second = self.spans
        return [*map(side_length, (first, second, second - first))]

    @property
    def follower(self) -> Crank:
        """The other arm, with the hand as its rod."""
        return replace(self.given, rod=self.sides[0])

    @property
    def equations(self) -> tuple[sp.Expr, ...]:
        """Those of the loop, with the angle of the arm and the end of the rod as unknowns."""
        b, c, n = self.driver.end(), self.given.end(), self.tie.end()
        (d, e), R, p = self.spans, self.pose[:3, :3], self.pose[:3, 3]
        u, v = c - b, THIRD - b
        rod = sp.sympify(self.tie.rod, strict=True)
        turned = (R * d - u, R * e - v, R * d.cross(e) - u.cross(v))
        return (
            square(u) - square(d),
            square(v) - square(e),
            square(v - u) - square(e - d),
            square(THIRD - n) - rod**2,
            *(entry for equation in turned for entry in equation),
            *(p - b + R * self.places[0]),
            *(x - int(k == 3) for k, x in enumerate(self.pose[3, :])),
        )


@dataclass(frozen=True)
class _Posture:
    """The hand in an assembly mode, in the names of a program."""

    program: Program
    modes: Branches
    position: sp.Matrix
    ends: tuple[sp.Matrix, sp.Matrix, sp.Matrix]
    """Those of the arms and of the rod on the hand."""
    spans: Sequence[sp.Matrix]
    """The vectors from the first of these to the others."""
    near: sp.Matrix
    """The other end of the rod."""


def _state(m: TwoArms) -> Step:
    ends = (m.driver.end(), m.given.end(), m.tie.end())
    both = zip(ends, m.places, strict=True)
    rows = [(str(k), end.T, place.T) for k, (end, place) in enumerate(both, 1)]
    tie = sp.sympify(m.tie.rod, strict=True)
    return m.d.step(
        "The loop",
        "Two arms end in balls on the hand, in the points b of the first two rows, and a rod leads "
        "from the third one to the hand.  On the hand these ends are e, seen in its frame.  The "
        f"rod has the length {tie}.  The angle {m.given.joint} of the second arm is not driven.",
        {},
        rows=[("i", "b", "e"), *rows],
    )


def _forward(m: TwoArms, loop: Step) -> _Posture:
    d, f = m.d, m.d.program()
    arm, rod = real("sigma_arm"), real("sigma_rod")
    modes = branches((arm, SIGN), (rod, SIGN))
    d.assembly_modes = modes.labels
    slid = [e.joint for e in (m.driver, m.tie) if isinstance(e, Slide)]
    size = f.let("size", size_of(d, (m.driver, m.given, m.tie), slid))
    share = MOVED if slid else SHARE
    spans = [named(f, name, e) for name, e in zip("de", m.spans, strict=True)]
    apart = require_triangle(f, spans, size, IN_LINE)
    b, n = named(f, "b_1", m.driver.end()), named(f, "b_3", m.tie.end())
    sides = [
        f.let(name, e, nonnegative=True)
        for name, e in zip(("side_12", "side_13", "side_23"), m.sides, strict=True)
    ]
    follower = replace(m.given, rod=sides[0])
    naming = Naming(f, size, "_2", share)
    follower = follower.named(naming)
    met = follower.solve(naming, b - follower.base, arm)
    start = len(f.body)
    c = named(f, "b_2", b - met.rod)
    body = (*met.link.body, *f.body[start:])
    links = [replace(met.link, body=body, means=dict(zip(c, follower.end(), strict=True)))]
    found = three_spheres(
        replace(f, suffix="_C"),
        [b, c, n],
        [sides[1], sides[2], _rod(f, m.tie)],
        tuple(THIRD),
        rod,
        scale=size,
        share=share,
        free=tuple(THIRD),
    )
    end, link = named_point(f, found, THIRD, _roles(m))
    links.append(link)
    turned = [named(f, name, x - b) for name, x in zip("uv", (c, end), strict=True)]
    link, R = two_vectors(f, spans, turned, m.pose[:3, :3])
    roles: list[tuple[str, Any]] = [
        (rf"\mathbf {x}", e) for x, e in zip("de", m.spans, strict=True)
    ]
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
            "UNREACHABLE: the arms or the rod do not reach.",
            *where_free([met]),
            FREE_POINT,
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
            passive=(m.given.joint, *THIRD),
        )
    )
    for link in links[:told]:
        record_lemma(d, "fk", link)
    return _Posture(
        program=Program(list(f.body), f.taken),
        modes=modes,
        position=position,
        ends=(b, c, end),
        spans=turned,
        near=n,
    )


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
    m.d.step(
        "Forward: the second arm, and three spheres",
        "The first arm gives its ball.  The second arm has to reach it with the side of the hand "
        "between both balls, in one of two ways.  The end C of the rod is at known distances from "
        "both balls and from the other end of the rod: three spheres meet in two points.  So there "
        "are four assembly modes.  The three points give the rotation R of the hand, and so its "
        "position.",
        {},
        proves="The end of the rod satisfies its equation if and only if the pose does.",
        equal=[(m.equations[3].xreplace(at), length)],
        uses=[loop],
        solves={"fk": ()},
    )


def _velocity(m: TwoArms, at: _Posture, loop: Step) -> None:
    """The step on velocities, and what follows from them."""
    d = m.d
    _state_velocity(m, loop)
    v = Program(list(at.program.body), at.program.taken)
    (b, c, end), (u, w) = at.ends, at.spans
    t = named(v, "t", end - at.near)
    turning = named(v, "f", m.given.rate_at(c))
    along = v.let("Delta_1", u.dot(turning))
    volume = v.let("Delta_2", t.dot(u.cross(w)))
    over = v.let("over_u", 1 / square(u), nonnegative=True)
    to_hand = named(v, "to_hand", at.position - b)
    columns = []
    rates = [(m.driver.rate, sp.zeros(3, 1))]
    if not isinstance(m.tie, Strut):
        rates.append((sp.zeros(3, 1), m.tie.rate))
    for k, (moved, pulled) in enumerate(rates, 1):
        moved, pulled = named(v, f"m_{k}", moved), named(v, f"n_{k}", pulled)
        turn = v.let(f"phi_{k}", u.dot(moved) / along)
        swept = named(v, f"w_{k}", u.cross(turn * turning - moved) * over)
        rest = v.let(f"lambda_{k}", t.dot(pulled - moved - swept.cross(w)) / volume)
        omega = named(v, f"omega_{k}", swept + rest * u)
        columns.append((moved + omega.cross(to_hand)).col_join(omega))
    export(
        d,
        v,
        at.modes,
        [
            (
                "jacobian",
                "Velocity and angular velocity of the hand, in base axes, per joint rate.",
                {"J": sp.Matrix.hstack(*columns).tolist()},
                ("Not finite at a parallel singularity.",),
            ),
            (
                "singularities",
                "The second arm cannot turn the hand, or the rod cannot.",
                {"factors": [along, volume]},
                (),
            ),
        ],
        {"J": r"\boldsymbol\omega", "factors": r"\Delta_1"},
    )


def _state_velocity(m: TwoArms, loop: Step) -> None:
    """The step on velocities.

    In the formulas u and v lead from the first ball to the other ends on the hand, and s along the
    rod; r, m and n are the rates of the first ball, of the second one and of the rod's near end.
    """
    u, v, s, r, f, n = (sp.Matrix([real(f"{x}_{i}") for i in "xyz"]) for x in "uvsrmn")
    along, volume = u.dot(f), s.dot(u.cross(v))
    moved = u.dot(r) * f - along * r
    swept = u.cross(moved)
    pulled = along * square(u) * s.dot(n - r) - s.dot(swept.cross(v))
    omega = swept * volume + pulled * u
    names = letters(m.d, "uvsrmn")
    U, V, S, R, M, N = (rf"\mathbf {x}" for x in names)
    rate = rf"\dot{{{U}}}"
    u_, v_, s_, r_, m_, n_ = names
    m.d.step(
        "Velocity and singular sets",
        f"Let {u_} lead from the ball of the first arm to that of the second one, {v_} to the end "
        f"of the rod, and {s_} along the rod.  The first ball moves by {r_}, the near end of the "
        f"rod by {n_}, and a turn of the second arm by one radian moves its ball by {m_}.  The "
        "hand turns by omega.  Both modes of the second arm meet where Delta_1 vanishes: it moves "
        "its ball at right angles to the line of the balls.  Those of the rod meet where Delta_2 "
        "vanishes: the rod is in the plane of the three points of the hand.",
        {
            r"\boldsymbol\omega": rf"\frac{{{U} \times {rate}}}{{{U}\cdot{U}}} + \lambda\,{U}",
            rate: rf"\frac{{{U}\cdot{R}}}{{\Delta_1}}\,{M} - {R}",
            r"\lambda": rf"\frac{{{S}\cdot({N} - {R}) - {S}\cdot(({U} \times {rate}) \times "
            rf"{V})/({U}\cdot{U})}}{{\Delta_2}}",
            r"\Delta_1": rf"{U}\cdot{M}",
            r"\Delta_2": rf"{S}\cdot({U} \times {V})",
        },
        proves="With this omega the second ball moves as its arm does, and the rod keeps its "
        "length.",
        equal=[
            (omega.cross(u), moved * square(u) * volume),
            (u.dot(moved), sp.S.Zero),
            (s.dot(omega.cross(v)), along * square(u) * volume * s.dot(n - r)),
        ],
        uses=[loop],
    )


def _draw(m: TwoArms, at: _Posture) -> None:
    """The skeleton: pivots A, balls B, the ends of the rod B3 and C3, and the hand P."""
    names = [
        "P" if place.is_zero_matrix else name
        for name, place in zip(("B1", "B2", "C3"), m.places, strict=True)
    ]
    near = "A3" if isinstance(m.tie, Strut) else "B3"

    def placed(ends: Sequence[sp.Matrix], start: sp.Matrix, hand: sp.Matrix) -> dict[str, Any]:
        found = {"A1": m.driver.base, "A2": m.given.base, "A3": m.tie.base}
        found |= {near: start, **dict(zip(names, ends, strict=True))}
        return {name: in_space(e) for name, e in {"P": hand, **found}.items()}

    first, second, third = names
    links: dict[str, tuple[str, ...]] = {"ground": ("A1", "A2", "A3", "A1")}
    links |= {"arm2": ("A2", second), "rod": (near, third), "hand": (*names, first)}
    if isinstance(m.driver, Crank):
        links["arm1"] = ("A1", first)
    if isinstance(m.tie, Crank):
        links["crank3"] = ("A3", near)
    joints: dict[sp.Symbol, tuple[str, ...]] = {}
    lengths: dict[tuple[str, str], sp.Expr] = {}
    for leg, base, end in ((m.driver, "A1", first), (m.given, "A2", second), (m.tie, "A3", near)):
        if isinstance(leg, Strut):
            continue
        joints[leg.joint] = (base,) if isinstance(leg, Crank) else (base, end)
        length = leg.length if isinstance(leg, Crank) else leg.joint
        lengths[base, end] = sp.sympify(length, strict=True)
    pairs = [(first, second), (third, first), (second, third), (near, third)]
    sides = [*m.sides, sp.sympify(m.tie.rod, strict=True)]
    lengths |= dict(zip(pairs, sides, strict=True))
    closing = dict(zip(pairs, m.equations[:4], strict=True))
    position = m.pose[:3, 3]
    if "P" not in names:
        links["hand0"] = ("P", first)
        gap = square(position - m.driver.end())
        lengths["P", first] = side_length(m.places[0])
        closing["P", first] = sp.expand(gap - square(m.places[0]))
    posture = placed([m.driver.end(), m.given.end(), THIRD], m.tie.end(), position)
    skeleton(
        m.d,
        placed(at.ends, at.near, at.position),
        links=links,
        joints=joints,
        hand="P",
        hand_at=posture["P"],
        ground=("A1", "A2", "A3"),
        lengths=lengths,
        program=at.program,
        branches=at.modes,
        notes=(NO_MODE,),
        at_posture=[posture],
        closing=closing,
    )


__all__ = ["TwoArms", "two_arms"]
