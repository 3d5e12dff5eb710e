"""A hand whose three balls slide along horizontal lines that motors move, as that of a CaPaMan.

The heights of the balls give the height and both tilts of the hand, and then its twist about the z
axis follows from one equation, and its motion sideways from two linear ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from closedform.lemmas.legs import Crank, Slide, Solution, turned_left, vector
from closedform.lemmas.lines import coordinate
from closedform.lemmas.links import degenerate, polar_lemma
from closedform.lemmas.sine_cosine import linear_pair
from closedform.lemmas.unit_vector import last_entry
from closedform.loops.balls import ASIDE, TARGET, TILT_X, TILT_Y, TWIST, Turns, Z
from closedform.loops.leg_by_leg import SIGN, LegByLeg, named, named_in, record, size_of
from closedform.loops.letters import letters
from closedform.loops.lines_hand import (
    BallOnLine,
    OnLines,
    Posture,
    Twisted,
    as_turns,
    exact_pose,
)
from closedform.loops.lines_rates import draw, state_velocity
from closedform.loops.slotted import turned_to_line
from closedform.loops.yaw import yaw_by_amplitude
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, branches, choose, real
from closedform.model.inverse import Inverse, Link
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair
from closedform.model.step import Step

RHO, LAST = real("rho"), real("n_z")
SIDE, SPUN = real("sigma_side"), real("sigma_twist")
ON_EDGE = "the hand is on edge, and its height and tilts do not determine how it turns"
FREE = "the lines leave the twist of the hand free"
HALF_TURN = (
    "tilt_y is between -90 and 90 degrees; other angles of the same posture differ by half a turn "
    "in each of both tilts and the twist."
)


def on_lines(d: Derivation, legs: Sequence[BallOnLine]) -> None:
    """Derive and export a hand whose three balls slide along horizontal lines.

    Its task is ``z, tilt_x, tilt_y``.  The hand is turned by ``tilt_x`` about the x axis of the
    base, by ``tilt_y`` about its y axis, and then by the twist about its z axis.  The twist and the
    motion sideways follow: ``hand_pose(q)`` is the pose in all four assembly modes.  ``fk``, the
    Jacobians, the singular set and the skeleton are functions of the joints too, and ``ik`` gives
    all working modes.

    Parameters
    ----------
    d
        the derivation, with its parameters, three driven joints and three passive slides
    legs
        three :class:`~closedform.loops.lines_hand.BallOnLine`, in the order of the driven joints
    """
    m = OnLines(d, tuple(legs))
    if not d.singularities:
        d.singularities = (*(f"leg {k}" for k, _ in m.numbered), "on edge", "twist")
        d.poles = ("on edge",)
    loop = _close(m)
    at = _forward(m, loop)
    state_velocity(m, at, loop)
    draw(m, at)
    _inverse(m, loop)


def _close(m: OnLines) -> Step:
    """The step on the loop."""
    d, exact = m.d, exact_pose()
    d.explain({"R": "rotation of the hand", r"\mathbf p": "position of the point of the hand"})
    rows = [(str(k), leg.leg.end().T, leg.normal.T, leg.place.T) for k, leg in m.numbered]
    last = exact.tilted[2, :]
    r, n, e = letters(d, "rne")
    d.loop = loop = d.step(
        "The loop",
        f"The joint of leg i moves the point {r} of a horizontal line, and {n} is a normal of the "
        f"line, horizontal too.  The corner {e} of the hand, in its frame, is a ball on this "
        f"line.  So it is as high as {r}, and as far along {n}.  R turns the hand by tilt_x about "
        f"the x axis of the base, by tilt_y about its y axis, and by the twist about its z axis.  "
        f"The twist leaves the last row of R as it is.",
        {"R": exact.rotation},
        rows=[("i", r, n, e), *rows],
        proves="R is a rotation, and the last row is that of the tilts alone.",
        equal=[
            (exact.rotation.T * exact.rotation, sp.eye(3)),
            (exact.rotation, as_turns()),
            (exact.rotation[2, :], last),
        ],
    )
    return loop


def _require_triangle(m: OnLines, f: Program) -> tuple[sp.Expr, list[str]]:
    """The area of the corners under a name, and notes on where it vanishes."""
    area = named_in(f, "area", m.area)
    if area.is_number:
        return area, []
    spread = named_in(f, "spread", m.spread)
    said = "the corners of the hand are not in line"
    flat = f.vanishes("in_line", sp.Abs(area), spread**2, said, squares=True)
    f.require([choose(flat, 1, 0)], 1, said)
    return area, [f"INVALID: also unless {said}."]


def _tilts(
    f: Program, row: tuple[sp.Symbol, sp.Symbol], last: sp.Symbol
) -> tuple[list[Link], Turns]:
    """Both tilts from the last row of R."""
    (u, v), start = row, len(f.body)
    rho = f.let("rho", sp.sqrt(last**2 + v**2), nonnegative=True)
    flag = f.vanishes("on_edge", rho, sp.S.One, "the x axis of the hand is vertical", (TILT_X,))
    x = Pair(choose(flag, 0, v / rho), choose(flag, 1, last / rho)).known_as(f, "_x")
    lemma = polar_lemma({TILT_X: x.angle, RHO: rho}, (last, v))
    said = "the x axis of the hand is vertical"
    first = Link(
        unknowns=(TILT_X, RHO),
        equations=lemma.equations,
        lemma=lemma,
        body=tuple(f.body[start:]),
        means={x.s: sp.sin(TILT_X), x.c: sp.cos(TILT_X), rho: RHO},
        degenerate=degenerate(flag, [dict.fromkeys((last, v), sp.S.Zero)], TILT_X, said),
    )
    start = len(f.body)
    whole = f.let("whole", sp.sqrt(u**2 + rho**2), nonnegative=True)
    y = Pair(-u / whole, rho / whole).known_as(f, "_y")
    lemma = replace(linear_pair(TILT_Y, -u, rho), solution={TILT_Y: y.angle})
    second = Link(
        unknowns=(TILT_Y,),
        equations=lemma.equations,
        lemma=lemma,
        body=tuple(f.body[start:]),
        means={y.s: sp.sin(TILT_Y), y.c: sp.cos(TILT_Y)},
    )
    return [first, second], Turns(x, y, Pair(sp.S.Zero, sp.S.One))


def _forward(m: OnLines, loop: Step) -> Posture:
    d, f = m.d, m.d.program()
    modes = branches((SIDE, SIGN), (SPUN, SIGN))
    d.assembly_modes = modes.labels
    size = f.let("size", size_of(d, m.legs, m.sliders))
    area, notes = _require_triangle(m, f)
    high, *row = letters(d, "huv")
    heights = [named_in(f, f"{high}_{k}", e) for k, e in enumerate(m.heights, 1)]
    u, v = (f.let(n, e / area) for n, e in zip(row, m.level(heights), strict=True))
    scale = f.let("leeway", size * m.spread / sp.Abs(area), nonnegative=True)
    level, last = last_entry(f, (LAST, u, v), SIDE, scale, "the heights of the balls fit the hand")
    tilting, tilts = _tilts(f, (u, v), last)
    T = f.matrix("T", tilts.tilted[:2, :2])
    flat = [named(f, f"f{k}", T * leg.place) for k, leg in m.numbered]
    beside = [named_in(f, f"y_{k}", e) for k, e in enumerate(m.beside, 1)]
    equation = (*m.twisting(flat), m.weighted(beside))
    spun, pair, root = yaw_by_amplitude(
        f,
        TWIST,
        [named_in(f, f"mu_{k}", e) for k, e in enumerate(equation, 1)],
        SPUN,
        size,
        missed=lambda _: size / 4,
        said=FREE,
    )
    aside = named(f, "p", m.centre(beside, flat, pair))
    z = f.let("p_z", heights[0] - m.rise((u, v), 0))
    hand = sp.Matrix([*aside, z])
    places = [coordinate(e, value) for e, value in zip((*ASIDE, Z), hand, strict=True)]
    links = [level, *tilting, spun, *places]
    solved = {e: x for link in links if link.lemma for e, x in link.lemma.solution.items()}
    _state_forward(m, loop)
    d.function(
        "fk",
        "Height and tilts of the hand in all assembly modes.",
        {"q": d.actuated},
        {"p": [solved[e] for e in TARGET]},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            "The z axis of the hand points up or down, and the hand is twisted in two ways, which "
            "have the same height and tilts; hand_pose has both poses.",
            HALF_TURN,
            "UNREACHABLE: the heights of the balls differ too much, or the lines are too far from "
            "the hand for its corners.",
            "SINGULAR: the x axis of the hand is vertical, and tilt_x = 0 is taken; or "
            f"{FREE}, and twist = 0 is taken.",
            *notes,
            "Ill-conditioned where the hand is on edge: modes meet there.",
        ),
    )
    equations = _solved_forward(m)
    record(
        d,
        Inverse(
            "fk",
            TARGET,
            (sp.S.Zero,) * len(equations),
            equations,
            links=tuple(links),
            passive=(LAST, RHO, TWIST, *ASIDE),
        ),
    )
    pose = Twisted(tilts, pair)
    at = Program(list(f.body), f.taken)
    _export_pose(m, at, modes, pose, hand)
    return Posture(
        program=at,
        modes=modes,
        pose=pose,
        hand=hand,
        upright=last,
        root=SPUN * root,
    )


def _export_pose(m: OnLines, f: Program, modes: Branches, pose: Twisted, hand: sp.Matrix) -> None:
    """The function that returns the poses of the hand."""
    T = pose.rotation.row_join(hand).col_join(sp.Matrix([[0, 0, 0, 1]]))
    m.d.function(
        "hand_pose",
        "Pose of the hand in all assembly modes.",
        {"q": m.d.actuated},
        {"T": T},
        program=Program(list(f.body), f.taken),
        branches=modes,
        notes=("NaN for an assembly mode that does not exist.",),
    )


def _solved_forward(m: OnLines) -> tuple[sp.Expr, ...]:
    """The equations that the links of ``fk`` solve, in all unknowns."""
    exact = exact_pose()
    u, v = (e / m.area for e in m.level(m.heights))
    x, y, t = exact.tilts.x, exact.tilts.y, exact.pair
    flat = [exact.tilted[:2, :2] * leg.place for leg in m.legs]
    a, b = m.twisting(flat)
    return (
        LAST**2 + u**2 + v**2 - 1,
        RHO * x.c - LAST,
        RHO * x.s - v,
        y.s * RHO + y.c * u,
        a * t.s + b * t.c - m.weighted(m.beside),
        *(ASIDE - m.centre(m.beside, flat, t)),
        Z - m.heights[0] + m.rise((u, v), 0),
    )


def _state_forward(m: OnLines, loop: Step) -> None:
    """The step on the assembly modes."""
    d, exact = m.d, exact_pose()
    high, first, second, weight = letters(d, "huvw")
    heights = [real(f"{high}_{k}") for k, _ in m.numbered]
    u, v = (e / m.area for e in m.level(heights))
    z = heights[0] - m.rise((u, v), 0)
    beside = [real(f"y_{k}") for k, _ in m.numbered]
    flat = [exact.tilted[:2, :2] * leg.place for leg in m.legs]
    a, b = m.twisting(flat)
    place, t = sp.Matrix([real("p_x"), real("p_y")]), exact.pair
    ends = [t.c * f + t.s * turned_left(f) for f in flat]
    lines = [
        leg.normal.dot(place + end) - y for leg, end, y in zip(m.legs, ends, beside, strict=True)
    ]
    met = dict(zip(place, m.centre(beside, flat, t), strict=True))
    normals = zip(m.weights, m.legs, strict=True)
    d.explain(
        {
            first: "first entry of the last row of R",
            second: "second entry of this row",
            weight: "weights, with which the normals of the lines add up to zero",
        }
    )
    d.step(
        "Forward: the heights, then the twist",
        f"The heights {high}_i of the balls are three linear equations for the height of the hand "
        f"and the first two entries {first} and {second} of the last row of R.  This row is a unit "
        f"vector, so its last entry n_z has one of two signs: the z axis of the hand points up or "
        f"down.  The row gives the tilts; rho is the length of ({second}, n_z).  The normals of "
        f"the lines, each times a weight {weight}, add up to zero.  So the sum of their equations "
        f"does not contain the point of the hand: it is "
        f"mu_1*sin(twist) + mu_2*cos(twist) = mu_3, and has two solutions.  So there are "
        f"four assembly modes.  Two lines that are not parallel give the point.",
        {first: u, second: v, weight: sp.Matrix([m.weights])},
        proves="The linear equations hold for any heights.  The last row of R is "
        "-sin(tilt_y), cos(tilt_y)*sin(tilt_x), cos(tilt_y)*cos(tilt_x).  The weighted equations "
        "add up to that of the twist, for any point of the hand, and the point satisfies two of "
        "them.",
        equal=[
            *((z + m.rise((u, v), k), h) for k, h in enumerate(heights)),
            (
                exact.rotation[2, :],
                sp.Matrix(
                    [
                        [
                            -sp.sin(TILT_Y),
                            sp.cos(TILT_Y) * sp.sin(TILT_X),
                            sp.cos(TILT_Y) * sp.cos(TILT_X),
                        ]
                    ]
                ),
            ),
            (sum((w * leg.normal for w, leg in normals), sp.zeros(2, 1)), sp.zeros(2, 1)),
            (
                sp.Add(*(w * e for w, e in zip(m.weights, lines, strict=True))),
                a * t.s + b * t.c - m.weighted(beside),
            ),
            *((lines[k].xreplace(met), sp.S.Zero) for k in m.order),
        ],
        uses=[loop],
        solves={"fk": ()},
    )


def _inverse(m: OnLines, loop: Step) -> None:
    d, g, exact = m.d, m.d.program(), exact_pose()
    solved = LegByLeg(d, g, g.let("size", size_of(d, m.legs, [Z])))
    T = g.matrix("T", exact.tilted)
    g.bound("upright", exact.tilts.y.c, sp.S.One, "tilt_y is between -90 and 90 degrees")
    known: dict[sp.Basic, sp.Expr] = {}
    for k, leg in m.numbered:
        off = g.let(f"off_{k}", Z + m.rise(T[2, :], k - 1) - leg.base[2])
        known |= _solve(m, solved, k, off)
    flat = [named(g, f"f{k}", T[:2, :2] * leg.place) for k, leg in m.numbered]
    a, b = (g.let(f"mu_{k}", e) for k, e in enumerate(m.twisting(flat), 1))
    c = g.let("mu_3", m.weighted([e.xreplace(known) for e in m.beside]))
    h = g.let("h_twist", sp.sqrt(a**2 + b**2), nonnegative=True)
    g.bound("twists", h - sp.Abs(c), solved.size / 4, "the corners of the hand reach their lines")
    g.determined(
        sp.Abs(T[2, 2] * exact.tilts.y.c * m.area),
        solved.size * m.spread,
        ON_EDGE,
        name=r"|\det A|",
        scale_name=r"\Lambda\,e",
        missed=solved.missed,
        size=solved.size,
    )
    d.step(
        "Inverse: leg by leg",
        "The height and the tilts of the hand give the heights of its corners, and each joint "
        f"brings its line to this height.  {solved.on_modes}The equation of the twist must have a "
        "solution too.  Near the parallel singularity rounded joints do not determine the "
        "tilts.  The status is SINGULAR if the determinant of A is less than 2^-10 of Lambda, the "
        "sum of all lengths, times e, the sum of the sides of the hand along x and y.",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    inputs = {"x": TARGET}
    solved.export(
        inputs,
        inputs,
        "UNREACHABLE: a line does not reach the height of its corner, or the lines are too far "
        "from the hand for its corners.",
        [HALF_TURN, f"SINGULAR: {ON_EDGE}."],
    )
    row = exact.tilted[2, :]
    equations = [h - Z - m.rise(row, k) for k, h in enumerate(m.heights)]
    solved.certify(equations, "fk", angles=(TILT_X, TILT_Y))


def _solve(m: OnLines, solved: LegByLeg, k: int, off: sp.Symbol) -> dict[sp.Basic, sp.Expr]:
    """Solve a leg for its joint, and say what this means for its line."""
    leg, names = m.legs[k - 1].leg, solved.naming(k)
    if isinstance(leg, Crank):
        sigma = real(f"sigma_{k}")
        solved.choices.append((sigma, SIGN))
        length = sp.sympify(leg.length, strict=True)
        arms = (length * vector(e)[2] for e in (leg.across, leg.along))
        found = turned_to_line(names, leg.joint, (*arms, off), sigma, "a crank has no length")
        solved.found.append(found.found)
        return found.known
    assert isinstance(leg, Slide)
    lift = m.legs[k - 1].lift
    value = off / lift
    lemma = Lemma(
        "line and plane",
        r"q = \frac{\mathbf n\cdot\mathbf w}{D}",
        (lift * leg.joint - off,),
        {leg.joint: value},
        1,
        roles=((r"\mathbf n\cdot\mathbf w", off), ("D", lift)),
    )
    solved.found.append(
        Solution(Link((leg.joint,), lemma.equations, {}, lemma), value, sp.Matrix())
    )
    return {leg.joint: value}


__all__ = ["on_lines"]
