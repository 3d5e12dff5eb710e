"""A hand whose three arms slide through balls on parallel sliders, as in a 3-PSP mechanism.

The balls determine the plane of the hand, and in this plane each arm is a line through its ball.
So the hand lifts and tilts; its twist about its own axis and its motion sideways follow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from closedform.lemmas.legs import cross_in_plane
from closedform.lemmas.lines import FAR, coordinate
from closedform.lemmas.links import degenerate, polar_lemma
from closedform.lemmas.rails import named_number
from closedform.lemmas.sine_cosine import linear_pair
from closedform.lemmas.through_ball import ThroughBall
from closedform.loops.balls import (
    ASIDE,
    TARGET,
    TILT_X,
    TILT_Y,
    TWIST,
    UP,
    OnBalls,
    Posture,
    Turns,
    Z,
    exact_turns,
)
from closedform.loops.balls_rates import draw, state_velocity
from closedform.loops.leg_by_leg import SIGN, named, named_in, record, record_lemma, size_of
from closedform.loops.points import NEAR
from closedform.mechanics.frames import rotation
from closedform.model.derivation import Derivation
from closedform.model.functions import SINGLE, Program, branches, choose, real
from closedform.model.inverse import Inverse, Link
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair
from closedform.model.step import Step

RHO, LENGTH = real("rho"), real("nu")
SIDE = real("sigma_side")
MEET = "the arms do not fix the twist of the hand"
TOO_FAR = (
    f"the plane of the hand is so steep that one ball is higher than another one by {FAR} times "
    f"the sum of all lengths"
)
LEFT_OUT = (
    "The postures in which the hand is turned by half a turn about its own axis are left out."
)


def on_balls(d: Derivation, legs: Sequence[ThroughBall]) -> None:
    """Derive and export a hand whose arms slide through three balls on parallel sliders.

    Its task is ``z, tilt_x, tilt_y``: the height of the point of the hand, where its arms meet, and
    two tilts.  The hand is twisted about its own axis first, then turned by ``tilt_x`` about the x
    axis of the base and by ``tilt_y`` about its y axis.  ``hand_pose(x)`` is its pose, with the
    twist and the motion sideways that follow.  It exports ``fk`` with both assembly modes, in which
    the axis of the hand points to either side of the plane of the balls, ``ik``, and the Jacobians,
    the singular set and the skeleton as functions of the joints.

    Parameters
    ----------
    d
        the derivation, with its parameters and joints; the legs are in the order of the joints
    legs
        three :class:`~closedform.lemmas.through_ball.ThroughBall`, whose sliders move along z
    """
    m = OnBalls(d, tuple(legs))
    if not d.singularities:
        d.singularities, d.poles = ("twist", "all legs"), ("twist",)
    loop = _close(m)
    at = _forward(m, loop)
    state_velocity(m, at, loop)
    draw(m, at)
    _inverse(m, loop)


def _close(m: OnBalls) -> Step:
    """The steps on the loop, and on the plane of the hand."""
    d, turns = m.d, exact_turns()
    R, T = turns.rotation, turns.tilted
    p, ball = sp.Matrix([*ASIDE, Z]), sp.Matrix([real(f"b_{i}") for i in "xyz"])
    d.explain({"R": "rotation of the hand", r"\mathbf p": "position of the point of the hand"})
    rows = [(str(k), leg.end().T, leg.way.T) for k, leg in enumerate(m.legs, 1)]
    d.loop = loop = d.step(
        "The loop",
        "The joint of leg i moves a ball b along z.  In the frame of the hand the arm i is a line "
        "through the origin with the direction t.  So in this frame the vector from the point p of "
        "the hand to b has no part along the axis of the hand, and none across t.  R twists the "
        "hand about its own axis first, then turns it by tilt_x about the x axis of the base and "
        "by tilt_y about its y axis.",
        {"R": R},
        rows=[("i", "b", "t"), *rows],
        proves="R is a rotation, and takes the axis z to that of the two tilts.",
        equal=[
            (R.T * R, sp.eye(3)),
            (R, rotation("y", TILT_Y) * rotation("x", TILT_X) * rotation("z", TWIST)),
            (R * UP, T * UP),
            (UP.dot(R.T * (ball - p)), (T * UP).dot(ball - p)),
        ],
    )
    return loop


def _twist(m: OnBalls, f: Program, pins: Sequence[sp.Matrix], size: sp.Expr) -> tuple[Link, Pair]:
    """The twist of the hand, from its balls in its plane."""
    sine, cosine = m.twisting(pins)
    across, along = f.let("across", sine), f.let("along", cosine)
    start, said = len(f.body), MEET
    h = f.let("h_twist", sp.sqrt(across**2 + along**2), nonnegative=True)
    free = f.vanishes("turns", h, size, said, (TWIST,))
    pair = Pair(
        f.let("s_twist", choose(free, 0, across / h)), f.let("c_twist", choose(free, 1, along / h))
    )
    lemma = replace(linear_pair(TWIST, across, along), solution={TWIST: sp.atan2(pair.s, pair.c)})
    none = dict.fromkeys((across, along), sp.S.Zero)
    link = Link(
        unknowns=(TWIST,),
        equations=lemma.equations,
        lemma=lemma,
        body=tuple(f.body[start:]),
        means={pair.s: sp.sin(TWIST), pair.c: sp.cos(TWIST)},
        degenerate=degenerate(free, [none], TWIST, said),
    )
    return link, pair


def _polar(
    f: Program,
    unknowns: tuple[sp.Symbol, sp.Symbol],
    target: tuple[sp.Expr, sp.Expr],
    *,
    count: int,
) -> Link:
    """An angle and a length with the sign of the mode, of a vector that does not vanish."""
    angle, length = unknowns
    x, y = (
        named_number(f, f"{n}_{angle}", e) if e.is_number else e
        for n, e in zip("xy", target, strict=True)
    )
    start = len(f.body)
    size = f.let(f"size_{angle}", sp.sqrt(x**2 + y**2), nonnegative=True)
    r = f.let(f"{length}_0", SIDE * size)
    pair = Pair(y / r, x / r).known_as(f, f"_{angle}")
    lemma = polar_lemma({angle: pair.angle, length: r}, (x, y), count, r"\sigma" * (count == 2))
    if count == 2:
        lemma = replace(lemma, signs=(SIDE,))
    return Link(
        unknowns=(angle, length),
        equations=lemma.equations,
        lemma=lemma,
        body=tuple(f.body[start:]),
        means={pair.s: sp.sin(angle), pair.c: sp.cos(angle), r: length},
    )


def _near(m: OnBalls, f: Program, k: int, rise: sp.Expr) -> None:
    """Bound the height of a ball above the first one."""
    most = FAR * size_of(m.d, m.legs)
    said = "the balls are near each other"
    f.bound(f"near_{k}", most - sp.Abs(rise), most / 2, said)


def _require_triangle(m: OnBalls, f: Program, sides: Sequence[sp.Matrix]) -> list[str]:
    if not sp.simplify(cross_in_plane(*m.sides)).free_symbols:
        return []
    said = "the sliders are not in one plane"
    flat = f.vanishes("flat", sp.Abs(cross_in_plane(*sides)), sp.S.One, said)
    f.require([choose(flat, 1, 0)], 1, said)
    return [f"INVALID: also if {said.replace('not ', '')}."]


def _forward(m: OnBalls, loop: Step) -> Posture:
    d, f = m.d, m.d.program()
    modes = branches((SIDE, SIGN))
    d.assembly_modes = modes.labels
    size = f.let("size", size_of(d, m.legs, d.actuated))
    sides = [named(f, n, e) for n, e in zip("uv", m.sides, strict=True)]
    notes = _require_triangle(m, f, sides)
    balls = [
        sp.Matrix([*base, named_in(f, f"b{k}_z", h)])
        for k, (base, h) in enumerate(zip(m.bases, m.heights, strict=True), 1)
    ]
    for k in (1, 2):
        _near(m, f, k + 1, m.heights[k] - m.heights[0])
    N = named(f, "N", m.normal([b[2] for b in balls], sides))
    second = _polar(f, (TILT_Y, RHO), (N[2], N[0]), count=2)
    (rho,) = (n for n, e in second.means.items() if e == RHO)
    first = _polar(f, (TILT_X, LENGTH), (rho, -N[1]), count=1)
    tilts = {e: n for link in (first, second) for n, e in link.means.items()}
    x, y = (Pair(tilts[sp.sin(e)], tilts[sp.cos(e)]) for e in (TILT_X, TILT_Y))
    T = Turns(x, y, Pair(sp.S.Zero, sp.S.One)).tilted
    pins = [named(f, f"m{k}", (T.T * (ball - balls[0]))[:2, 0]) for k, ball in enumerate(balls, 1)]
    turn, pair = _twist(m, f, pins, size)
    turns = Turns(x, y, pair)
    hand = named(f, "p", balls[0] + turns.rotation * sp.Matrix([*m.centre(pins, pair), 0]))
    places = [coordinate(e, value) for e, value in zip((*ASIDE, Z), hand, strict=True)]
    links = [second, first, turn, *places]
    solved = {u: e for link in links if link.lemma for u, e in link.lemma.solution.items()}
    exact = exact_turns()
    equations = _solved_forward(m, exact)
    _state_forward(m, exact, loop)
    d.function(
        "fk",
        "Height and tilts of the hand in both assembly modes.",
        {"q": d.actuated},
        {"p": [solved[e] for e in TARGET]},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            "The axis of the hand points to either side of the plane of the balls.",
            f"UNREACHABLE: {TOO_FAR}.",
            f"SINGULAR: {MEET}, and twist = 0 is taken.",
            LEFT_OUT,
            *notes,
            NEAR,
        ),
    )
    record(
        d,
        Inverse(
            "fk",
            TARGET,
            (sp.S.Zero,) * len(equations),
            equations,
            links=tuple(links),
            passive=(RHO, LENGTH, TWIST, *ASIDE),
        ),
    )
    return Posture(Program(list(f.body), f.taken), modes, turns, hand, balls, sides)


def _solved_forward(m: OnBalls, exact: Turns) -> tuple[sp.Expr, ...]:
    """The equations that the links of ``fk`` solve, in all unknowns."""
    N = m.normal(m.heights, m.sides)
    balls = [leg.end() for leg in m.legs]
    pins = [(exact.tilted.T * (ball - balls[0]))[:2, 0] for ball in balls]
    sine, cosine = m.twisting(pins)
    centre = sp.Matrix([*m.centre(pins, exact.twist), 0])
    hand = sp.Matrix([*ASIDE, Z]) - balls[0] - exact.rotation * centre
    return (
        RHO * exact.y.c - N[2],
        RHO * exact.y.s - N[0],
        LENGTH * exact.x.c - RHO,
        LENGTH * exact.x.s + N[1],
        exact.twist.s * cosine - exact.twist.c * sine,
        *hand,
    )


def _state_forward(m: OnBalls, exact: Turns, loop: Step) -> None:
    """The step on the assembly modes."""
    axis, N = exact.tilted * UP, m.normal(m.heights, m.sides)
    balls = [leg.end() for leg in m.legs]
    sides = [ball - balls[0] for ball in balls[1:]]
    flat = [sp.Matrix(sp.symbols(f"m{k}_x m{k}_y", real=True)) for k, _ in enumerate(m.legs, 1)]
    seen = [rotation("z", -TWIST)[:2, :2] * pin for pin in flat]
    sine, cosine = m.twisting(flat)
    total = sp.Add(
        *(w * leg.normal.dot(e) for w, leg, e in zip(m.weights, m.legs, seen, strict=True))
    )
    centre = m.centre(flat, exact.twist)
    m.d.step(
        "Forward: two assembly modes",
        "The balls are in the plane of the hand, so its axis is a multiple of N, the product of "
        "two vectors between them: positive or negative, which are the assembly modes.  nu is the "
        "length of N with this sign, and rho that of N without its part along y.  The axis "
        "gives the tilts; those with a negative cosine of tilt_x turn the hand by half a turn "
        "about its axis, which takes its arms to themselves, and are left out.  Let m_i be the "
        "ball i in the plane, without the twist.  The normals of the arms, each times a weight w, "
        "add up to zero.  So the sum of their equations does not contain the point of the hand: "
        "it gives the twist, and the other half of its solutions is the half turn that is left "
        "out.  Then the point of the hand is where two arms meet.",
        {"N": N, "w": sp.Matrix([m.weights])},
        proves="N is at right angles to both vectors.  The weighted equations of the arms add up "
        "to that of the twist, for any point of the hand.  The point where two arms meet satisfies "
        "their equations.",
        equal=[
            *((N.dot(side), sp.S.Zero) for side in sides),
            (axis.dot(axis), sp.S.One),
            (
                sum(
                    (w * leg.normal for w, leg in zip(m.weights, m.legs, strict=True)),
                    sp.zeros(2, 1),
                ),
                sp.zeros(2, 1),
            ),
            (total, exact.twist.c * sine - exact.twist.s * cosine),
            *(
                (leg.normal.dot(e - centre), sp.S.Zero)
                for leg, e in zip(m.legs[:2], seen[:2], strict=True)
            ),
        ],
        uses=[loop],
        solves={"fk": ()},
    )


def _inverse(m: OnBalls, loop: Step) -> None:
    d, g, exact = m.d, m.d.program(), exact_turns()
    size = g.let("size", size_of(d, m.legs))
    placed, links, values, slope, pins = _placed(m, g, size, exact)
    d.function(
        "hand_pose",
        "Pose of the hand, which the target determines.",
        {"x": TARGET},
        {"T": placed},
        program=Program(list(g.body), g.taken),
        notes=(LEFT_OUT,),
    )
    equations, found, joints = [*_placing(m, exact)], list(links), []
    px, py = values
    n = exact.tilted * UP
    for k, leg in enumerate(m.legs, 1):
        off = sp.Matrix(leg.base[:2, 0]) - sp.Matrix([px, py])
        rise = g.let(f"rise_{k}", leg.up * (Z - leg.base[2] - slope.dot(off)))
        lemma = Lemma(
            "line and plane",
            r"q = \frac{\mathbf n\cdot\mathbf w}{D}",
            (rise - leg.joint,),
            {leg.joint: rise},
            1,
            roles=((r"\mathbf n", n), ("D", n[2])),
        )
        found.append(Link((leg.joint,), lemma.equations, {}, lemma))
        away = sp.Matrix(leg.base[:2, 0]) - ASIDE
        above = Z - leg.base[2] - (n[0] * away[0] + n[1] * away[1]) / n[2]
        equations.append(leg.up * above - leg.joint)
        joints.append(rise)
    for k in (1, 2):
        _near(m, g, k + 1, slope.dot(m.bases[k] - m.bases[0]))
    sure = g.let("sure", sp.sqrt(sp.Add(*(e**2 for e in m.twisting(pins)))), nonnegative=True)
    g.determined(sure, size, MEET, name="h", scale_name=r"\Lambda", size=size)
    d.step(
        "Inverse: the plane of the hand",
        "The tilts give the plane, and the sliders meet it in the balls.  Where they are in the "
        "plane does not depend on the height: seen along the axis of the hand and enlarged by n_z, "
        "the part of its axis n along z, they are at m_i.  So the twist and then the place of the "
        "point of the hand follow as in the forward problem, and each joint is how far the plane "
        "is from its start along z.  Where h, the length of the vector that gives the twist, is "
        "less than 2^-10 of Lambda, the sum of all lengths, the status is SINGULAR.",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    d.branches = SINGLE.labels
    d.function(
        "ik",
        "The driven joints of the only working mode.",
        {"x": TARGET},
        {"q": joints},
        program=g,
        branches=SINGLE,
        result="Solutions",
        notes=(
            f"UNREACHABLE: {TOO_FAR}.",
            f"SINGULAR: {MEET}, and twist = 0 is taken.",
            LEFT_OUT,
        ),
    )
    for link in found:
        record_lemma(d, "ik", link)
    d.inverses.append(
        Inverse(
            "ik",
            d.actuated,
            (sp.S.Zero,) * len(equations),
            tuple(equations),
            images="fk",
            angles=(TILT_X, TILT_Y),
            links=tuple(found),
            passive=(TWIST, *ASIDE),
        )
    )


def _flat(tilted: sp.Matrix) -> sp.Matrix:
    """What takes a point, seen along z, to the plane of the hand, times n_z."""
    return tilted[:2, :2].adjugate()


def _placing(m: OnBalls, exact: Turns) -> tuple[sp.Expr, ...]:
    """The equations for the twist and the place of the hand, at its tilts."""
    T = exact.tilted
    pins = [_flat(T) * base for base in m.bases]
    sine, cosine = m.twisting(pins)
    turn = rotation("z", TWIST)[:2, :2]
    place = T[:2, :2] * turn * m.centre(pins, exact.twist) / T[2, 2]
    return (exact.twist.s * cosine - exact.twist.c * sine, *(ASIDE - place))


def _placed(
    m: OnBalls, g: Program, size: sp.Expr, exact: Turns
) -> tuple[sp.Matrix, list[Link], list[sp.Expr], sp.Matrix, list[sp.Matrix]]:
    """The pose of the hand, how it follows, its point sideways, and the slope of its plane."""
    T = g.matrix("T", exact.tilted)
    pins = [named(g, f"m{k}", _flat(T) * base) for k, base in enumerate(m.bases, 1)]
    turn, pair = _twist(m, g, pins, size)
    spun = sp.Matrix([[pair.c, -pair.s], [pair.s, pair.c]])
    place = named(g, "p", T[:2, :2] * spun * m.centre(pins, pair) / T[2, 2])
    links, found = [turn], []
    for e, value in zip(ASIDE, place, strict=True):
        start = len(g.body)
        found.append(g.let(f"at_{e}", value))
        body = tuple(g.body[start:])
        links.append(replace(coordinate(e, value), body=body, means={found[-1]: e}))
    R = T * sp.Matrix([[pair.c, -pair.s, 0], [pair.s, pair.c, 0], [0, 0, 1]])
    pose = R.row_join(sp.Matrix([*place, Z])).col_join(sp.Matrix([[0, 0, 0, 1]]))
    slope = sp.Matrix([g.let(f"slope_{i}", T[k, 2] / T[2, 2]) for k, i in enumerate("xy")])
    return pose, links, found, slope, pins


__all__ = ["on_balls"]
