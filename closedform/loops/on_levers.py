"""A hand in a plane on three lines, some of which motors turn: 3-RPR with driven pivots.

Each joint determines a line, on which a point of the hand slides.  The equations are linear in the
position of the hand, which is eliminated: two assembly modes.  If all lines are on sliders, their
directions do not change, and it is a hand on three rails.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Leg, cross_in_plane, turned_left, vector
from closedform.lemmas.rails import Rail
from closedform.lemmas.three_lines import three_lines, weights_of
from closedform.loops.hand import check_order, in_space, square
from closedform.loops.leg_by_leg import (
    SIGN,
    Choice,
    LegByLeg,
    named,
    record_lemma,
    size_of,
)
from closedform.loops.modes import NO_MODE, export_in_plane
from closedform.loops.slotted import Lever, turned_to_line
from closedform.loops.yaw import yaw_by_amplitude
from closedform.mechanics.loops import velocity_matrices
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, branches, real
from closedform.model.inverse import Combination, Inverse
from closedform.model.pair import Pair
from closedform.model.step import Step

LEGS = 3
MEET = (
    "the lines do not hold the hand: they are parallel, or the normals in their points pass "
    "through one point"
)


@dataclass(frozen=True)
class _OnLevers:
    """A hand on three lines."""

    d: Derivation
    legs: tuple[Lever | Rail, ...]

    def __post_init__(self) -> None:
        name = self.d.name
        if len(self.legs) != LEGS:
            raise ShapeError(f"{name}: a hand on lines that motors turn needs {LEGS} legs")
        check_order(self.d, [cast("Leg", leg) for leg in self.legs])
        if not any(isinstance(leg, Lever) for leg in self.legs):
            raise ShapeError(f"{name}: no motor turns a line; three rails are those of on_rails")
        if all(place.is_zero_matrix for place in self.places):
            raise ShapeError(f"{name}: all lines hold the same point of the hand; it turns freely")
        self.d.task = ["x", "y", "yaw"]

    @cached_property
    def target(self) -> tuple[sp.Symbol, ...]:
        return real("x"), real("y"), real("yaw")

    @property
    def hand(self) -> sp.Matrix:
        return sp.Matrix(self.target[:2])

    @property
    def yaw(self) -> sp.Symbol:
        return self.target[2]

    @property
    def pair(self) -> Pair:
        return Pair(sp.sin(self.yaw), sp.cos(self.yaw))

    @property
    def places(self) -> list[sp.Matrix]:
        """The points that slide along the lines, in the frame of the hand."""
        return [vector(leg.on_hand or (0, 0)) for leg in self.legs]

    @property
    def normals(self) -> list[sp.Matrix]:
        return [leg.normal for leg in self.legs]

    def arms(self, pair: Pair) -> list[sp.Matrix]:
        """The same points, as the base sees them from the point of the hand."""
        return [
            sp.Matrix([pair.c * x - pair.s * y, pair.s * x + pair.c * y]) for x, y in self.places
        ]

    def levels(self, normals: Sequence[sp.Matrix]) -> list[sp.Expr]:
        """How far the lines are from the origin, along their normals."""
        return [
            n.dot(leg.base) + leg.rod if isinstance(leg, Lever) else n.dot(leg.end())
            for n, leg in zip(normals, self.legs, strict=True)
        ]

    def coefficients(
        self, normals: Sequence[sp.Matrix], weights: Sequence[sp.Expr]
    ) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """a, b and c of the equation a sin(yaw) + b cos(yaw) = c, which has no position."""
        total = [sp.S.Zero] * 3
        rows = zip(normals, weights, self.levels(normals), self.places, strict=True)
        for n, weight, level, place in rows:
            parts = n.dot(turned_left(place)), n.dot(place), level
            total = [t - weight * part for t, part in zip(total, parts, strict=True)]
        a, b, c = total
        return a, b, c

    @cached_property
    def loop(self) -> tuple[sp.Expr, ...]:
        """The equations of the loop: the points of the hand are on the lines."""
        rows = zip(self.normals, self.levels(self.normals), self.arms(self.pair), strict=True)
        return tuple(n.dot(self.hand + arm) - level for n, level, arm in rows)


def on_levers(d: Derivation, legs: Sequence[Lever | Rail], modes: Choice = SIGN) -> None:
    """Derive and export a hand that slides on three lines in a plane, some of which motors turn.

    Parameters
    ----------
    d
        the derivation, with its parameters, three driven joints and three passive slides; its task
        becomes ``x, y, yaw``
    legs
        the levers with the lines, or sliders with rails, in the order of the joints; each ends
        ``on_hand``, at the point that slides along its line
    modes
        the names of the assembly modes, by the sign of the determinant of A
    """
    m = _OnLevers(d, tuple(legs))
    d.singularities, d.poles = (*(f"leg {k}" for k in (1, 2, 3)), "all legs"), ("all legs",)
    loop = d.step(
        "The loop",
        "Leg i has a line, whose unit normal n and distance g from the origin its joint determines."
        "  The point e of the hand, in its frame, is on the line: the product of n and p + R*e is "
        "g.",
        {},
        rows=[
            ("i", "n", "g", "e"),
            *(
                (str(k), n.T, level, place.T)
                for k, (n, level, place) in enumerate(
                    zip(m.normals, m.levels(m.normals), m.places, strict=True), 1
                )
            ),
        ],
    )
    d.loop = loop
    at = _forward(m, modes, loop)
    _draw(m, at)
    _velocity(m, at, loop)
    _inverse(m, loop)


@dataclass(frozen=True)
class _Posture:
    """The hand in an assembly mode, in the names of a program."""

    program: Program
    modes: Branches
    hand: sp.Matrix
    pair: Pair
    arms: list[sp.Matrix]
    volume: sp.Expr


def _under_names(p: Program, name: str, values: sp.Matrix) -> sp.Matrix:
    """A vector with its entries under names, also if they are numbers."""
    return sp.Matrix([p.let(f"{name}_{i}", e) for i, e in zip("xy", values, strict=True)])


def _forward(m: _OnLevers, choice: Choice, loop: Step) -> _Posture:
    d, f, sigma = m.d, m.d.program(), real("sigma_assembly")
    modes = branches((sigma, choice))
    d.assembly_modes = modes.labels
    sliders = [leg.joint for leg in m.legs if isinstance(leg, Rail)]
    size = f.let("size", size_of(d, m.legs, sliders))
    normals = [_under_names(f, f"n{k}", n) for k, n in enumerate(m.normals, 1)]
    weights = [f.let(f"w{k}", e) for k, e in enumerate(weights_of(normals), 1)]
    turn, pair, root = yaw_by_amplitude(
        f,
        m.yaw,
        [f.let(n, e) for n, e in zip("abc", m.coefficients(normals, weights), strict=True)],
        sigma,
        size,
        missed=lambda _: size / 4,
        said="the lines do not hold the hand",
    )
    arms = [named(f, f"e{k}", arm) for k, arm in enumerate(m.arms(pair), 1)]
    rows = zip(m.levels(normals), normals, arms, strict=True)
    levels = [f.let(f"g{k}", level - n.dot(e)) for k, (level, n, e) in enumerate(rows, 1)]
    meet = three_lines(f, normals, levels, weights, m.hand)
    assert turn.lemma is not None
    assert meet.lemma is not None
    hand = sp.Matrix([meet.lemma[x] for x in m.hand])
    w, n = weights_of(m.normals), m.normals
    a, b, c = m.coefficients(n, w)
    d.explain({r"\mathbf e_i": "point of the hand on line i, in its frame"})
    d.step(
        "Forward: two assembly modes",
        "The sum of the normals, each times the determinant w of the other two, is zero.  So the "
        "sum of the equations with these weights does not contain p.  It is "
        "a*sin(yaw) + b*cos(yaw) = c, and has two solutions: these are the assembly modes.  Then "
        "three lines are known on which the hand is.",
        {
            "w_1": r"\det(\mathbf n_2, \mathbf n_3)",
            "b": r"-\sum_i w_i\,\mathbf n_i\cdot\mathbf e_i",
            "c": r"-\sum_i w_i\,g_i",
        },
        proves="The weighted equations add up to that of the yaw.",
        equal=[
            (
                -sp.Add(*(weight * e for weight, e in zip(w, m.loop, strict=True))),
                a * m.pair.s + b * m.pair.c - c,
            )
        ],
        uses=[loop],
    )
    d.function(
        "fk",
        "Position and yaw of the hand in both assembly modes.",
        {"q": d.actuated},
        {"p": [*hand, turn.lemma[m.yaw]]},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            "UNREACHABLE: the hand is too short for the lines.",
            "SINGULAR: all three lines are parallel, or the hand turns freely; then yaw = 0 is "
            "returned.",
            "Ill-conditioned near the parallel singularities, where both modes meet.",
        ),
    )
    d.inverses.append(
        Inverse(
            "fk",
            m.target,
            (sp.S.Zero,) * LEGS,
            m.loop,
            links=(turn, meet),
            glue=Combination(_combined(n, w), {u: u for u in m.target}),
        )
    )
    record_lemma(d, "fk", turn)
    record_lemma(d, "fk", meet)
    return _Posture(
        program=Program(list(f.body), f.taken),
        modes=modes,
        hand=hand,
        pair=pair,
        arms=arms,
        volume=sigma * root,
    )


def _combined(normals: Sequence[sp.Matrix], weights: Sequence[sp.Expr]) -> sp.Matrix:
    """What takes the equation of the yaw, and the sum of all equations times their normals, back.

    The weights are at right angles to both columns of the normals.
    """
    rows = sp.Matrix.hstack(*normals).T
    square_ = rows.T * rows
    width = sp.Add(*(w**2 for w in weights))
    return (-sp.Matrix(weights)).row_join(rows * square_.adjugate()) / width


def _points(m: _OnLevers, hand: sp.Matrix, pair: Pair) -> dict[str, list[sp.Expr]]:
    points = {"P": in_space(hand)}
    for k, (leg, place, arm) in enumerate(zip(m.legs, m.places, m.arms(pair), strict=True), 1):
        points[f"A{k}"] = in_space(leg.base)
        if isinstance(leg, Rail) or leg.rod:
            foot = leg.end() if isinstance(leg, Rail) else leg.foot()
            points[f"B{k}"] = in_space(foot)
        if any(place):
            points[f"C{k}"] = in_space(hand + arm)
    return points


def _draw(m: _OnLevers, at: _Posture) -> None:
    ground = ("A1", "A2", "A3")
    links: dict[str, tuple[str, ...]] = {"ground": (*ground, "A1")}
    lengths: dict[tuple[str, str], sp.Expr] = {}
    joints: dict[sp.Symbol, tuple[str, ...]] = {}
    points = _points(m, at.hand, at.pair)
    for k, (leg, place) in enumerate(zip(m.legs, m.places, strict=True), 1):
        base, near, far = f"A{k}", f"B{k}", f"C{k}" if any(place) else "P"
        if far != "P":
            links[f"hand{k}"] = ("P", far)
            lengths["P", far] = sp.sqrt(sp.factor(square(place)))
        if isinstance(leg, Rail):
            joints[leg.joint] = (base, near)
            lengths[base, near] = leg.joint
        else:
            joints[leg.joint] = (base,)
            if leg.rod:
                links[f"lever{k}"] = (base, near)
                lengths[base, near] = leg.rod
            else:
                near = base
        joints[leg.slide] = (near, far)
    skeleton(
        m.d,
        points,
        links=links,
        joints=joints,
        hand="P",
        hand_at=in_space(m.hand),
        ground=ground,
        lengths=lengths,
        program=at.program,
        branches=at.modes,
        notes=(NO_MODE,),
        at_posture=[_points(m, m.hand, m.pair)],
    )


def _matrices(
    m: _OnLevers, hand: sp.Matrix, arms: Sequence[sp.Matrix]
) -> tuple[sp.Matrix, list[sp.Expr]]:
    """A of A*dx = B*dq, and the diagonal of B."""
    rows, rates = [], []
    for leg, n, arm in zip(m.legs, m.normals, arms, strict=True):
        rows.append([*n, cross_in_plane(arm, n)])
        if isinstance(leg, Rail):
            rates.append(n.dot(leg.rate))
        else:
            rates.append(-n.diff(leg.joint).dot(hand + arm - leg.base))
    return sp.Matrix(rows), rates


def _velocity(m: _OnLevers, at: _Posture, loop: Step) -> None:
    d, v = m.d, Program(list(at.program.body), at.program.taken)
    A, B = velocity_matrices(m.loop, m.target, d.actuated)
    rows, rates = _matrices(m, m.hand, m.arms(m.pair))
    a, b, _ = m.coefficients(m.normals, weights_of(m.normals))
    d.step(
        "Velocity and singular sets",
        "The derivatives of the loop equations give A*dx = B*dq.  Row i of A is the normal of the "
        "line and its moment about the hand.  B is diagonal.  The entry of a line that turns is "
        "how far its point is from the pivot, along the line; it is zero where the point is beside "
        f"the pivot (serial).  A is singular if {MEET} (parallel), which is where both assembly "
        "modes meet.",
        {"A": rows, **{f"B_{{{k}{k}}}": e for k, e in enumerate(rates, 1)}},
        proves="A and B are the derivatives, and the determinant of A is b*sin(yaw) - a*cos(yaw).",
        equal=[
            (A, rows),
            (B, sp.diag(*rates)),
            (rows.det(), b * m.pair.s - a * m.pair.c),
        ],
        uses=[loop],
    )
    rows, rates = _matrices(m, at.hand, at.arms)
    export_in_plane(d, v, at.modes, (rows, rates), at.volume)


def _inverse(m: _OnLevers, loop: Step) -> None:
    d, g = m.d, m.d.program()
    solved = LegByLeg(d, g, g.let("size", size_of(d, m.legs, m.target[:-1])))
    known: dict[sp.Basic, sp.Expr] = {}
    for k, (leg, arm) in enumerate(zip(m.legs, m.arms(m.pair), strict=True), 1):
        if isinstance(leg, Rail):
            solved.solve(k, cast("Leg", leg), m.hand + arm - leg.base)
            continue
        names, sigma = solved.naming(k), real(f"sigma_{k}")
        solved.choices.append((sigma, SIGN))
        w = named(g, f"span{k}", m.hand + arm - leg.base)
        sides = (-w.dot(vector(leg.along)), w.dot(vector(leg.across)), leg.rod)
        turned = turned_to_line(names, leg.joint, sides, sigma, "a point is at its pivot")
        known |= {e: g.let(f"{e.func.__name__}{k}", value) for e, value in turned.known.items()}
        solved.found.append(turned.found)
    normals = [_under_names(g, f"n{k}", n.xreplace(known)) for k, n in enumerate(m.normals, 1)]
    weights = [g.let(f"w{k}", e) for k, e in enumerate(weights_of(normals), 1)]
    a, b, _ = m.coefficients(normals, weights)
    volume = g.let("Delta", b * m.pair.s - a * m.pair.c)
    width = g.let("width", sp.sqrt(sp.Add(*(w**2 for w in weights))), nonnegative=True)
    g.determined(
        sp.Abs(volume) * width,
        solved.size,
        MEET,
        name=r"|\det A|\,w",
        missed=solved.missed,
        size=solved.size,
    )
    d.step(
        "Inverse: leg by leg",
        "Each leg is solved alone: its line has to pass through its point of the hand, which is on "
        "either side of the pivot of a line that turns.  Near a parallel singularity rounded "
        "joints do not determine the hand.  The position amplifies an error of the yaw by the "
        "inverse of w, the root of the sum of the squares of the weights.  The status is SINGULAR "
        "if the determinant of A, times w, is less than 2^-10 of the sum of all lengths.",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    solved.export(
        {"x": m.target},
        {"x": m.target},
        "UNREACHABLE: a line cannot reach its point of the hand, which is too near its pivot.",
        [f"SINGULAR: {MEET}."],
    )
    solved.certify(m.loop, "fk", angles=(m.yaw,))


__all__ = ["on_levers"]
