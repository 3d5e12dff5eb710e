"""The velocity of a hand that two arms and a rod hold, and its drawing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from closedform.lemmas.legs import Crank, Strut, vector
from closedform.lemmas.sliding_strut import SlidingStrut
from closedform.loops.hand import in_space, square
from closedform.loops.leg_by_leg import named
from closedform.loops.letters import letters
from closedform.loops.modes import NO_MODE, export
from closedform.loops.points import side_length
from closedform.loops.two_arms_hand import THIRD, Posture, TwoArms
from closedform.mechanics.skeleton import skeleton
from closedform.model.functions import Program, real
from closedform.model.step import Step

BY_ARM = (
    "Let {u} lead from the ball of the first arm to that of the second one, {v} to the end of the "
    "rod, and {s} along the rod.  The first ball moves by {r}, the near end of the rod by {n}, and "
    "a turn of the second arm by one radian moves its ball by {m}.  The hand turns by omega.  Both "
    "modes of the second arm meet where Delta_1 vanishes: it moves its ball at right angles to the "
    "line of the balls.  "
)
BY_STRUT = (
    "Let {u} lead from the ball of the arm to that of the strut, {v} to the end of the rod, and "
    "{s} along the rod.  The ball of the arm moves by {r}, and the near end of the rod by {n}.  "
    "The ball of the strut stands still, and the point of the hand there moves along the direction "
    "{m} of the strut; its velocity, less {r}, is that of {u} on the hand.  The hand turns by "
    "omega.  Both modes of the strut meet where Delta_1 vanishes: it is at right angles to the "
    "line of the balls.  "
)


BY_DAMPER = (
    "  The length of the damper, times its rate, is Delta_0 times that of the angle of its arm.  "
    "Delta_0 vanishes where the damper is in line with the hinge of the arm."
)


def velocity(m: TwoArms, at: Posture, loop: Step) -> None:
    """The step on velocities, and what follows from them."""
    d = m.d
    _state_velocity(m, loop)
    v = Program(list(at.program.body), at.program.taken)
    (b, c, end), (u, w) = at.ends, at.spans
    t = named(v, "t", end - at.near)
    if isinstance(m.given, SlidingStrut):
        turning = named(v, "f", at.rotation * m.given.ahead)
    else:
        turning = named(v, "f", m.given.rate_at(c))
    along = v.let("Delta_1", u.dot(turning))
    volume = v.let("Delta_2", t.dot(u.cross(w)))
    over = v.let("over_u", 1 / square(u), nonnegative=True)
    to_hand = named(v, "to_hand", at.position - b)
    columns = []
    first, factors = m.driver.rate, [along, volume]
    if m.damper and m.pushed and at.pushed is not None:
        push = v.let("Delta_0", (at.pushed - m.damper.base).dot(m.pushed.rate_at(at.pushed)))
        first, factors = m.driver.rate_at(b) * m.damper.joint / push, [push, *factors]
    rates = [(first, sp.zeros(3, 1))]
    if not isinstance(m.tie, Strut):
        rates.append((sp.zeros(3, 1), m.tie.rate))
    if m.damper and not isinstance(m.tie, Strut):
        rates.reverse()  # the joint of the damper is the last one
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
                f"{'The damper cannot turn its arm, or the' if m.damper else 'The'} "
                f"{'strut' if m.strut else 'second arm'} cannot turn the hand, or the rod cannot.",
                {"factors": factors},
                (),
            ),
        ],
        {"J": r"\boldsymbol\omega", "factors": r"\Delta_0" if m.damper else r"\Delta_1"},
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
    pushed = []
    if m.damper and m.pushed:
        end, joint = m.pushed.end(), m.driver.joint
        away = end - m.damper.base
        pushed = [(away.dot(m.pushed.rate_at(end)), sp.diff(square(away), joint) / 2)]
    names = letters(m.d, "uvsrmn")
    U, V, S, R, M, N = (rf"\mathbf {x}" for x in names)
    rate = rf"\dot{{{U}}}"
    u_, v_, s_, r_, m_, n_ = names
    moves = "the second ball moves as its arm does"
    if m.strut:
        moves = "the hand slides along the strut"
    m.d.step(
        "Velocity and singular sets",
        (BY_STRUT if m.strut else BY_ARM).format(u=u_, v=v_, s=s_, r=r_, n=n_, m=m_)
        + "Those of the rod meet where Delta_2 vanishes: the rod is in the plane of the three "
        "points of the hand." + BY_DAMPER * bool(m.damper),
        {
            r"\boldsymbol\omega": rf"\frac{{{U} \times {rate}}}{{{U}\cdot{U}}} + \lambda\,{U}",
            rate: rf"\frac{{{U}\cdot{R}}}{{\Delta_1}}\,{M} - {R}",
            r"\lambda": rf"\frac{{{S}\cdot({N} - {R}) - {S}\cdot(({U} \times {rate}) \times "
            rf"{V})/({U}\cdot{U})}}{{\Delta_2}}",
            r"\Delta_1": rf"{U}\cdot{M}",
            r"\Delta_2": rf"{S}\cdot({U} \times {V})",
        },
        proves=f"With this omega {moves}, and the rod keeps its length.",
        equal=[
            (omega.cross(u), moved * square(u) * volume),
            (u.dot(moved), sp.S.Zero),
            (s.dot(omega.cross(v)), along * square(u) * volume * s.dot(n - r)),
            *pushed,
        ],
        uses=[loop],
    )


def draw(m: TwoArms, at: Posture) -> None:
    """The skeleton: pivots A, balls B, the ends of the rod B3 and C3, and the hand P.

    If the hand slides in a strut, B2 is the point of the hand from which this is counted.
    """
    position, rotation, strut = m.pose[:3, 3], m.pose[:3, :3], m.strut
    places = [vector(e.on_hand) for e in (m.driver, m.given, m.tie)]
    names = _names(places)
    near = "A3" if isinstance(m.tie, Strut) else "B3"
    links, joints, lengths = _legs(m, names, near)

    def placed(
        ends: Sequence[sp.Matrix], start: sp.Matrix, hand: sp.Matrix, pushed: sp.Matrix | None
    ) -> dict[str, Any]:
        found = {"A1": m.driver.base, "A2": m.given.base, "A3": m.tie.base}
        if m.damper and pushed is not None:
            found |= {"A4": m.damper.base, "B4": pushed}
        found |= {near: start, **dict(zip(names, ends, strict=True))}
        return {name: in_space(e) for name, e in {"P": hand, **found}.items()}

    ends = [m.driver.end(), m.given.end(), THIRD]
    shown = list(at.ends)
    if strut:
        ends[1] = position + rotation * places[1]
        shown[1] = at.position + at.rotation * places[1]
    pairs = [(0, 1), (2, 0), (1, 2)]
    sides = {
        (names[i], names[k]): (places[k] - places[i], ends[k] - ends[i])
        for i, k in pairs
        if names[i] != names[k]
    }
    if "P" not in names:
        links["hand0"] = ("P", names[0])
        sides["P", names[0]] = places[0], ends[0] - position
    closing: dict[tuple[str, str], sp.Expr] = {}
    for pair, (side, gap) in sides.items():
        lengths[pair] = side_length(side)
        closing[pair] = sp.expand(square(gap) - square(side))
    rod = near, names[2]
    lengths[rod], closing[rod] = sp.sympify(m.tie.rod, strict=True), m.rod
    if m.damper:
        closing["A4", "B4"] = m.equations[0]
    if strut:
        closing["A2", names[1]] = square(ends[1] - strut.end()) - strut.joint**2
    posture = placed(ends, m.tie.end(), position, m.pushed.end() if m.pushed else None)
    skeleton(
        m.d,
        placed(shown, at.near, at.position, at.pushed),
        links=links,
        joints=joints,
        hand="P",
        hand_at=posture["P"],
        ground=("A1", "A2", "A3", *["A4"] * bool(m.damper)),
        lengths=lengths,
        program=at.program,
        branches=at.modes,
        notes=(NO_MODE,),
        at_posture=[posture],
        closing=closing,
    )


def _names(places: Sequence[sp.Matrix]) -> list[str]:
    """Those of three points of the hand; points at the same place have one name."""
    names: list[str] = []
    for place, name in zip(places, ("B1", "B2", "C3"), strict=True):
        same = places.index(place)
        names.append("P" if place.is_zero_matrix else [*names, name][same])
    return names


_Points = tuple[str, ...]


def _legs(
    m: TwoArms, names: Sequence[str], near: str
) -> tuple[dict[str, _Points], dict[sp.Symbol, _Points], dict[tuple[str, str], sp.Expr]]:
    """The links, the joints, and the lengths of arms and slides."""
    first, second, third = names
    links: dict[str, _Points] = {"ground": ("A1", "A2", "A3", "A1")}
    if not m.strut:
        links["arm2"] = ("A2", second)
    links |= {"rod": (near, third), "hand": (*dict.fromkeys(names), first)}
    if isinstance(m.driver, Crank):
        links["arm1"] = ("A1", first)
    if isinstance(m.tie, Crank):
        links["crank3"] = ("A3", near)
    joints: dict[sp.Symbol, _Points] = {}
    lengths: dict[tuple[str, str], sp.Expr] = {}
    passive = [m.driver.joint] if m.damper else []
    if m.damper and m.pushed:
        links["arm1"] = ("A1", first, "B4", "A1")
        joints[m.damper.joint] = ("A4", "B4")
        lengths["A4", "B4"] = m.damper.joint
        arm, end = m.driver, m.pushed.end().subs(m.driver.joint, 0)
        start = arm.end().subs(arm.joint, 0)
        lengths["B4", "A1"] = side_length(end - arm.base)
        lengths[first, "B4"] = side_length(end - start)
    for leg, base, end in ((m.driver, "A1", first), (m.given, "A2", second), (m.tie, "A3", near)):
        if not isinstance(leg, Strut):
            if leg.joint not in passive:
                joints[leg.joint] = (base,) if isinstance(leg, Crank) else (base, end)
            length = leg.length if isinstance(leg, Crank) else leg.joint
            lengths[base, end] = sp.sympify(length, strict=True)
    return links, joints, lengths


__all__ = ["draw", "velocity"]
