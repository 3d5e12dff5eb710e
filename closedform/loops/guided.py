"""A hand that something without a motor holds on the ground, and the driven legs that move it.

A passive leg of a universal joint and a slide holds the hand of a Tricept, a universal joint the
foot of many humanoids, a ball joint the platforms that only turn.  Each leaves the hand as many
degrees of freedom as there are driven legs.

:func:`guided` derives what has a closed form: the pose of the hand, the inverse with all working
modes, the velocity and the singular sets.  The forward problem is an equation of high degree, and
no ``fk`` is derived.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from closedform.lemmas.axial import FreeAlong
from closedform.lemmas.extended import Extended
from closedform.lemmas.legs import Leg, vector
from closedform.loops.guided_hand import COUNTS, Guided, Holder
from closedform.loops.guides import LENGTH, TURNS, Ball, Cross, Driven, Gimbal, Guide
from closedform.loops.hand import rate_of, square
from closedform.loops.hinged_pose import motions, state_pose
from closedform.loops.hinges import Hinged, Hinges
from closedform.loops.leg_by_leg import MISSED, LegByLeg, named_in, signs_of_modes
from closedform.loops.letters import bold, letters
from closedform.loops.on_cylinders import OnCylinders
from closedform.loops.parallel_axes import ParallelAxes, moved_by, state_axes
from closedform.loops.platform import determinant, of_any_matrix
from closedform.loops.skeleton import Drawing, points_of
from closedform.loops.three_planes import ThreePlanes, state_planes
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, real
from closedform.model.step import Step

FEW = 4
"""So many legs have a Jacobian that is printed; the adjugate of more rows is long."""
LONG = ("jacobian", "determinant")
TOGETHER = "The target and the joints have to belong together, as ik gives them."


def guided(d: Derivation, guide: Holder, legs: Sequence[Leg | Hinged]) -> None:
    """Derive and export a hand that something without a motor holds on the ground.

    The task is the position ``x, y, z`` of the hand on a passive leg, the angles ``turn_1, turn_2``
    of a universal joint, or the rotation ``R`` of a hand on a ball joint.  It exports ``ik``,
    ``jacobian_parallel`` (A), ``jacobian_serial`` (the diagonal of B), ``jacobian_inverse``
    (B^-1*A), ``jacobian``, ``determinant``, ``singularities``, ``skeleton`` and, where the reach of
    the legs is limited, ``workspace_contains``.  Unless the target is a rotation, ``hand_pose`` is
    exported too; if it is one, ``jacobian`` gives the angular velocity of the hand.

    Parameters
    ----------
    d
        the derivation, with its parameters and joints; the legs are in the order of the joints.
        If it has no ``singularities``, they are named after the legs
    guide
        what holds the hand: a :class:`Guide` with three legs, a :class:`Gimbal` or a
        :class:`Cross` with two, a :class:`Ball` or a :class:`Mast` with three, a
        :class:`BallOnMast` with four, a :class:`Spindle` with five.  The ``slide`` of a guide may
        be driven; then one of the legs is a ``Stretch`` with this joint
    legs
        cranks, slides or legs that stretch; ``on_hand`` is seen from the point of the hand, where
        the hand is not turned
    """
    if isinstance(guide, Hinges | ThreePlanes):
        guide = guide.with_legs(d.name, legs)
    if isinstance(guide, Guide) and guide.slide in d.actuated:
        guide = guide.driven()
    m = Guided(d, guide, tuple(e.leg if isinstance(e, Hinged) else e for e in legs))
    if not d.singularities:
        numbered = [f"leg {k}" for k, _ in m.numbered]
        d.singularities = (*numbered, "all legs", *guide.own)
    if isinstance(guide, Hinges):
        placed: Step | None = state_pose(d, guide, m.places, m.posture)
    elif isinstance(guide, Guide | Gimbal):
        placed = _place(m, guide)
    elif isinstance(guide, ThreePlanes):
        placed = state_planes(d, guide, m.places)
    else:
        placed = None
    loop = _close(m, placed)
    if isinstance(guide, ParallelAxes):
        state_axes(d, m.legs, loop)
    _velocity(m, loop)
    _draw(m)
    _inverse(m, loop)


def _place(m: Guided, guide: Guide | Gimbal) -> Step:
    """The step on the pose of the hand, and the function that returns it."""
    d, p, at = m.d, m.d.program(), m.posture
    placed = guide.place(p, m.places, m.size)
    a, b, c = guide.joint.axes
    (turn_1, turn_2), v = TURNS, at.turns[1]
    second, along = letters(d, "vu")
    d.explain({rf"\mathbf {second}": "second axis", "R": "rotation of the hand"})
    shown: dict[str, Any] = {"R": at.rotation, rf"\mathbf {second}": v}
    equal: list[tuple[Any, Any]] = [
        (at.rotation.T * at.rotation, sp.eye(3)),
        (v.dot(a), sp.S.Zero),
        (at.rotation * b, v),
        (sp.Matrix([square(a), square(b), a.dot(b)]), sp.Matrix([1, 1, 0])),
    ]
    proves = (
        f"R is a rotation, keeps the first axis at right angles to {second}, and takes the second "
        f"axis to {second}.  The axes, where nothing is turned, are unit vectors at right angles."
    )
    if isinstance(guide, Gimbal):
        said = (
            f"{'The cross' if isinstance(guide, Cross) else 'The universal joint'} turns the hand "
            "by turn_1 about an axis that is fixed to the ground, and by turn_2 about the axis "
            f"{second}, which the first turn moves."
        )
        notes: tuple[str, ...] = ()
    else:
        assert at.slide and m.exact.slide
        u = at.slide.ahead
        d.explain({rf"\mathbf {along}": f"direction of the {guide.leg}"})
        d.explain({r"\mathbf p": "position of the point of the hand"})
        shown |= {rf"\mathbf {along}": u, r"\mathbf p": m.pivot + at.shift}
        said = (
            f"The universal joint of the {guide.leg} turns it by turn_1 about an axis that is "
            f"fixed to the ground, and by turn_2 about the axis {second}, which the first turn "
            f"moves.  "
            f"The hand is fixed to the end of the leg, whose direction is {along}.  So R is the "
            "rotation of the hand, and its point p is ahead of the pivot by the length of the "
            "leg.  Conversely, let X, Y and Z be the coordinates of p along the two axes and the "
            "leg where nothing is turned, from the pivot.  Then the length is the root of X^2 + "
            "Y^2 + Z^2, and with rho, the root of Y^2 + Z^2, turn_1 = atan2(-Y, Z) and turn_2 = "
            "atan2(X, rho).  The postures with -Y, -Z and -rho, in which the hand is turned by "
            "half a turn about the leg, are left out."
        )
        equal += [
            (v.dot(u), sp.S.Zero),
            (
                sp.Matrix([axis.dot(u) for axis in (a, b, c)]),
                sp.Matrix(
                    [
                        sp.sin(turn_2),
                        -sp.sin(turn_1) * sp.cos(turn_2),
                        sp.cos(turn_1) * sp.cos(turn_2),
                    ]
                ),
            ),
            (m.exact.slide.length * m.exact.slide.ahead, m.exact.shift),
            (m.exact.rotation.T * m.exact.rotation, sp.eye(3)),
        ]
        proves += (
            "  The coordinates of u along the axes and the leg before they turn are those three.  "
            "At the turns and the length of a position, u times the length leads from the pivot "
            "to it, and R is a rotation."
        )
        notes = (
            f"With X and Y, the coordinates of the hand along the two axes of the {guide.leg}, and "
            "Z along the leg, where nothing is turned, from its pivot: turn_1 = atan2(-Y, Z) and "
            "turn_2 = atan2(X, sqrt(Y^2 + Z^2)).",
            f"Not finite where the hand is on the first axis of the {guide.leg}.",
            guide.left_out,
        )
    step = d.step("Pose of the hand", said, shown, proves=proves, equal=equal)
    T = placed.rotation.row_join(m.pivot + placed.shift)
    d.function(
        "hand_pose",
        "Pose of the hand, which the target determines.",
        m.inputs,
        {"T": sp.Matrix.vstack(T, sp.Matrix([[0, 0, 0, 1]]))},
        program=p,
        notes=notes,
    )
    return step


def _close(m: Guided, placed: Step | None) -> Step:
    rows = (
        (str(k), leg.end().T, place.T, sp.sympify(leg.rod, strict=True))
        for (k, leg), place in zip(m.numbered, m.places, strict=True)
    )
    said, near, far = (
        "The joint of leg i determines the near end b_i of its rod.  The far end is c_i in the "
        "frame of the hand, seen from its point p.  The rod keeps the distance of its ends: "
        "|p + R*c_i - b_i| is its length.",
        "b_i",
        "c_i",
    )
    if isinstance(m.guide, ParallelAxes):
        said, near, far = m.guide.legs_close, "b", "e"
    else:
        m.d.explain({r"\mathbf b_i": "near end of rod i"})
        m.d.explain({r"\mathbf c_i": "far end of rod i, in the frame of the hand"})
    m.d.loop = loop = m.d.step(
        "The loop",
        f"{m.guide.holds}{said}",
        m.guide.shown(m.d) if isinstance(m.guide, ParallelAxes) else {},
        rows=[("i", near, far, "length of the rod"), *rows],
        uses=[placed] if placed else [],
    )
    m.d.step(
        f"Forward: an equation of degree {m.guide.degree}",
        f"If the joints are given, {m.guide.follow} from {COUNTS[len(m.legs)]} equations, "
        f"which have to be solved together.  In general they have {m.guide.degree} complex "
        "solutions.  No formula is derived for it.",
        {},
        uses=[loop],
    )
    return loop


def _velocity(m: Guided, loop: Step) -> None:
    """A*dx = B*dq, for the velocity of the hand."""
    d, p = m.d, m.d.program()
    placed = m.placed(p)
    rods = []
    for (k, leg), arm in zip(m.numbered, placed.arms, strict=True):
        near = [named_in(p, f"b_{k}{i}", e) for i, e in enumerate(leg.end(), 1)]
        rod = m.pivot + arm - sp.Matrix(near)
        if isinstance(leg.rod, Extended):
            rod = leg.rod.named_along(p, f"_{k}", rod)
        if isinstance(leg, FreeAlong):
            rod = leg.pull(rod)
        rods.append(sp.Matrix([named_in(p, f"r_{k}{i}", e) for i, e in enumerate(rod, 1)]))
    rows = m.rows(p, placed, rods)
    stretched = [placed.row(k, rod) for k, rod in enumerate(rods)]
    driven = [
        named_in(p, f"B_{k}{k}", rate_of(leg, rod))
        for (k, leg), rod in zip(m.numbered, rods, strict=True)
    ]
    D = sp.Matrix.vstack(*rows)
    volume = p.let("Delta", _volume(p, rows))
    _state_velocity(m, loop)
    few = len(rows) <= FEW
    J = D.adjugate() * sp.diag(*driven) / volume if few else sp.zeros(0)
    det = sp.Mul(*driven) / volume
    if isinstance(m.guide, OnCylinders):
        J, det = _by_units(p, rows, driven)
    own = [*placed.fixed]
    if slide := placed.slide:
        rows = stretched = [row * slide.inverse for row in rows]
        J, det, own = slide.rates * J, slide.volume * det, [slide.volume]
    ball = isinstance(m.guide, Ball)
    per = "angular velocity" if ball else "rate of the target"
    finite = "Not finite at a parallel singularity."
    where = ""
    if isinstance(m.guide, Guide):
        where = f"the hand is on the first axis of the {m.guide.leg}"
    if isinstance(m.guide, Hinges):
        where = f"the hinges do not fix the {m.guide.fixes} of the hand"
    on_axis = [f"Not finite where {where}."] * bool(own)
    exported: list[tuple[str, str, dict[str, Any], Sequence[str]]] = [
        ("jacobian_parallel", "A of A*dx = B*dq.", {"A": sp.Matrix.vstack(*rows)}, on_axis),
        (
            "jacobian_serial",
            "The diagonal of B of A*dx = B*dq.",
            {"B": driven},
            signs_of_modes(m.legs),
        ),
        (
            "jacobian_inverse",
            f"B^-1*A: joint rates per {per}.",
            {"K": sp.Matrix.vstack(*map(_rates, rows, stretched, driven))},
            ("Not finite at a serial singularity.", *on_axis),
        ),
        (
            "jacobian",
            "Angular velocity of the hand in the base frame per joint rate: A^-1*B."
            if ball
            else "Derivative of the target with respect to q: A^-1*B.",
            {"J": J},
            (finite,),
        ),
        (
            "determinant",
            "Determinant of the Jacobian.",
            {"det": det},
            (finite,),
        ),
        (
            "singularities",
            "The diagonal of B (serial) and the determinant "
            + (
                f"of D (parallel), and that of G (the {m.guide.leg})."
                if isinstance(m.guide, Guide)
                else "of A (parallel)" + ", and what the hinges fix." * bool(own) + "." * (not own)
            ),
            {"factors": [*driven, volume, *own]},
            (),
        ),
    ]
    if not few:
        exported = [entry for entry in exported if entry[0] not in LONG]
    for name, summary, outputs, notes in exported:
        d.function(
            name,
            summary,
            {**m.inputs, "q": d.actuated},
            outputs,
            program=p,
            notes=(TOGETHER, *notes),
        )


def _by_units(
    p: Program, rows: Sequence[sp.Matrix], driven: Sequence[sp.Expr]
) -> tuple[sp.Matrix, sp.Expr]:
    """A^-1*B and its determinant, from rows over their largest entries.

    Rods across the axes may all be tiny beside the mechanism, and so are products of their entries.
    """
    sizes = [
        p.let(f"unit_{k}", sp.Max(*map(sp.Abs, row)), nonnegative=True)
        for k, row in enumerate(rows, 1)
    ]
    A = p.matrix("U", sp.Matrix.vstack(*(row / e for row, e in zip(rows, sizes, strict=True))))
    B = [p.let(f"V_{k}", b / e) for k, (b, e) in enumerate(zip(driven, sizes, strict=True), 1)]
    volume = p.let("Delta_U", A.det())
    return A.adjugate() * sp.diag(*B) / volume, sp.Mul(*B) / volume


def _volume(p: Program, rows: Sequence[sp.Matrix]) -> sp.Expr:
    """The determinant of some rows, by minors of two parts if they are many."""
    return sp.Matrix.vstack(*rows).det() if len(rows) <= FEW else determinant(p, rows)


def _rates(row: sp.Matrix, stretched: sp.Matrix, driven: sp.Expr) -> sp.Matrix:
    """A row over its entry of B, which cancels in an entry that has it as a factor."""

    def over(name: sp.Expr, value: sp.Expr) -> sp.Expr:
        found = value / driven
        return name / driven if found.as_numer_denom()[1].has(driven) else found

    return sp.Matrix([[over(*entry) for entry in zip(row, stretched, strict=True)]])


def _state_velocity(m: Guided, loop: Step) -> None:
    """The step on the velocity and the singular sets."""
    d, at = m.d, m.posture
    spans = [m.pivot + arm - leg.end() for leg, arm in zip(m.legs, at.arms, strict=True)]
    r, f, w = (sp.Matrix([real(f"{n}_{i}") for i in "xyz"]) for n in ("r", "f", "omega"))
    d.explain(
        {
            r"\mathbf f_i": "from the pivot to the far end of rod i",
            r"\mathbf r_i": "vector along rod i",
            r"\mathbf a_i": "row i of A",
            "B_{ii}": "entry of the diagonal of B",
        }
    )
    hinges = isinstance(m.guide, Hinges)
    called = m.guide.leg if isinstance(m.guide, Guide) else ""
    moment = about = r"(\mathbf f_i\times\mathbf r_i)"
    if isinstance(m.guide, Cross):
        (shift,) = bold(d, "s")
        about = rf"((\mathbf f_i - {shift})\times\mathbf r_i)"
        d.explain({shift: "from the pivot to the point of the hand"})
    first, second, along, rate = bold(d, "avuw")
    entry = rf"{first}^T(\mathbf e_i\times\mathbf r_i) + {rate}^T\mathbf r_i"
    row = rf"\begin{{bmatrix}}{first}^T{moment} & {second}^T{about}\end{{bmatrix}}"
    alone = {
        Ball: rf"{moment}^T",
        ParallelAxes: r"\mathbf r_i^T",
        OnCylinders: r"\mathbf r_i^T",
        ThreePlanes: r"(\mathbf e_i\times\mathbf r_i)^T + \mathbf r_i^T V",
    }
    shown: dict[str, Any] = {
        ("A_{ik}" if hinges else r"\mathbf a_i"): entry
        if hinges
        else alone.get(type(m.guide), row),
        "B_{ii}": r"\mathbf r_i^T\,\frac{\partial\mathbf b_i}{\partial q_i}",
    }
    equal: list[tuple[Any, Any]] = [(r.dot(w.cross(f)), w.dot(f.cross(r)))]
    proves = (
        "The product of r_i with a velocity of turning is its moment.  The derivative of each loop "
        "equation with respect to its joint is minus twice the entry of B."
    )
    if isinstance(m.guide, Hinges):
        d.explain(
            {
                r"\mathbf e_i": "from the point of the hand to the far end of rod i",
                first: "axis about which a coordinate turns the hand",
                rate: "velocity of the point of the hand per rate of a coordinate",
            }
        )
        equal += motions(m.guide, at)
        proves += "  The derivatives of the position and of each e_i with respect to the target "
        proves += "are those motions."
    elif isinstance(m.guide, ParallelAxes):
        shown = {**m.guide.rods, **shown}
        proves = m.guide.proves
    elif not isinstance(m.guide, Ball):
        d.explain({first: "first axis"})
        proves += "  The derivative of each f_i with respect to a joint that holds the hand is "
        proves += "that of a point that this joint moves."
    for arm, lever in zip(at.arms, at.levers or at.arms, strict=True):
        for joint, axis in m.joints:
            turned = axis.cross(arm if joint == TURNS[0] else lever)
            equal.append((arm.diff(joint), axis if joint == LENGTH else turned))
    for leg, span in zip(m.legs, spans, strict=True):
        equal += moved_by(leg, span, m.guide.moved if isinstance(m.guide, ParallelAxes) else ())
    if at.slide:
        d.explain(
            {
                r"\mathbf D_i": f"how the joints of the {called} stretch rod i",
                "G": f"velocity of the hand per rate of the {called}",
            }
        )
        shown = {
            r"\mathbf D_i": rf"\begin{{bmatrix}}{first}^T{moment} & {second}^T{moment} & "
            rf"{along}^T\mathbf r_i\end{{bmatrix}}",
            r"\mathbf a_i": r"\mathbf D_i\,G^{-1}",
            "G": at.slide.rates,
            "B_{ii}": shown["B_{ii}"],
        }
        joints = (*TURNS, LENGTH)
        equal += [
            (at.shift.jacobian(joints), at.slide.rates),
            (at.slide.rates * at.slide.inverse, sp.eye(3)),
            (at.slide.rates.det(), at.slide.volume),
        ]
        proves += (
            "  G is the derivative of the position with respect to these joints; its inverse and "
            "its determinant are correct."
        )
    if len(m.legs) > FEW:
        equal += of_any_matrix(len(m.legs), adjugate=False)
        proves += "  The formula for the determinant holds for any matrix."
    d.step(
        "Velocity and singular sets",
        "The derivatives of the loop equations, halved, give A*dx = B*dq for the "
        + ("angular velocity dx" if isinstance(m.guide, Ball) else "rates of the target x")
        + f".  {m.guide.motion}.  "
        "B is diagonal, because each leg depends on its own joint alone.  B is singular if the "
        "joint moves the near end of a rod at right angles to it (serial: the joint moves and the "
        "hand stands still).  A is singular if the rods do not hold the hand (parallel: the hand "
        "can move while the joints stand still)."
        + (
            f"  G is singular where the hand is on the first axis of the {called}, which then "
            "turns freely about it." * bool(at.slide)
        ),
        shown,
        proves=proves,
        equal=equal,
        uses=[loop],
    )


def _draw(m: Guided) -> None:
    """The skeleton: pivot O, bases A, near ends B and far ends C of the legs, and P, the hand.

    E are the far ends of rods on which the hand slides.
    """
    p = m.d.program()
    placed = m.placed(p)
    exact, loop = m.exact, m.closed(m.exact.arms)
    held, pivoted = isinstance(m.guide, Gimbal | Ball), isinstance(m.guide, Guide | Cross)
    held &= not isinstance(m.guide, ThreePlanes)
    pivoted &= not isinstance(m.guide, Driven)  # there the pivot is the base of a leg

    def points(shift: sp.Matrix, arms: Sequence[sp.Matrix]) -> dict[str, Sequence[Any]]:
        hand = m.pivot + shift
        found: dict[str, Sequence[Any]] = {"P": [*hand]}
        if pivoted:
            found = {"O": [*m.pivot], **found}
        for (k, leg), arm, far in zip(m.numbered, arms, m.far, strict=True):
            found |= points_of(k, leg, far, m.pivot + arm)
        return found

    bases = [f"A{k}" for k, _ in m.numbered]
    drawn = Drawing({"ground": (*bases, *bases[:1])} if len(bases) > 2 else {"ground": (*bases,)})
    if isinstance(m.guide, Guide) and not isinstance(m.guide, Driven):
        drawn.joints[m.guide.slide] = ("O", "P")
        drawn.lengths["O", "P"] = sp.sqrt(square(exact.shift))
    if isinstance(m.guide, Cross):
        drawn.links["cross"] = ("O", "P")
        drawn.lengths["O", "P"] = sp.sqrt(sp.factor(square(vector(m.guide.offset))))
    for (k, leg), place, far, equation in zip(m.numbered, m.places, m.far, loop, strict=True):
        if isinstance(leg.rod, Extended):
            drawn.add_extended(k, leg, far, equation, m.pivot + exact.arms[k - 1] - leg.end())
        else:
            drawn.add_leg(k, leg, far, equation, m.pivot + exact.arms[k - 1])
        if far != "P":
            drawn.links[f"hand{k}"] = ("P", far)
            drawn.lengths["P", far] = sp.sqrt(sp.factor(sp.trigsimp(square(place))))
            if isinstance(m.guide, Ball):
                drawn.closing["P", far] = sp.expand(
                    square(m.guide.rotation * place) - square(place)
                )
    skeleton(
        m.d,
        points(placed.shift, placed.arms),
        links=drawn.links,
        joints=drawn.joints,
        hand="P",
        ground=(*["O"] * pivoted, *["P"] * (held and not pivoted), *bases),
        lengths=drawn.lengths,
        pose=m.inputs,
        program=p,
        notes=(TOGETHER,),
        at_posture=[points(exact.shift, exact.arms)],
        closing=drawn.closing,
    )


def _least(fixed: Sequence[sp.Expr], matrix: str) -> str:
    """What decides whether the hand is held, as a formula."""
    found = [rf"|\det {matrix}|", r"|\Gamma|\,\Lambda", r"\tau\,\Lambda"][: 1 + len(fixed)]
    return rf"\min({', '.join(found)})" if fixed else found[0]


def _inverse(m: Guided, loop: Step) -> None:
    d, g, guide = m.d, m.d.program(), m.guide
    if isinstance(guide, Ball):
        guide.check(g)
    size = g.let("size", m.size)
    solved = LegByLeg(d, g, size)
    placed = guide.place(g, m.places, size)
    for (k, leg), arm in zip(m.numbered, placed.arms, strict=True):
        solved.solve(k, leg, m.pivot + arm - leg.base)
    rows = m.rows(g, placed, [s.rod for s in solved.found])
    volume = g.let("Delta", _volume(g, rows))
    spread = sp.Add(*(square(arm) for arm in placed.arms)) / len(m.legs)
    if placed.slide is None:  # the ends of the legs keep their distances from the pivot
        spread = sp.factor(sp.Add(*map(square, m.places)) / len(m.legs))
    if isinstance(guide, Cross):
        spread += sp.factor(square(vector(guide.offset)))
    lever = {0: sp.S.One, 2: spread}.get(guide.turning, spread ** sp.Rational(3, 2))
    least = g.let("least", solved.lengths(m.legs) * lever, nonnegative=True)
    meet = "the rods do not hold the hand"
    matrix, loose = "D" if placed.slide else "A", bool(placed.fixed)
    g.determined(
        sp.Min(sp.Abs(volume), *(sp.Abs(e) * least for e in placed.fixed)),
        least,
        meet,
        name=_least(placed.fixed, matrix),
        scale_name=r"\Lambda",
        missed=solved.missed,
        size=solved.size,
    )
    power = "mean square" if guide.turning == 2 else "third power of the root mean square"
    of_ends = (
        f" and the {power} distance of their far ends from the "
        f"{'point of the hand' if isinstance(guide, Hinges | Cross | ThreePlanes) else 'pivot'}"
        + ", with the square of the length of the cross"
        * isinstance(guide, Cross)
    )
    d.step(
        "Inverse: leg by leg",
        f"The target gives the pose of the hand, and each leg is solved alone.  {solved.on_modes}"
        "Near a parallel singularity rounded joints do not determine the hand.  The status is "
        f"SINGULAR if the determinant of {matrix} is less than 2^-10 of Lambda, the product of the "
        "lengths of the rods"
        + of_ends * bool(guide.turning)
        + "."
        + (guide.too if isinstance(guide, Hinges) and loose else "")
        + f"  {MISSED}",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    solved.export(
        m.inputs,
        m.inputs,
        "UNREACHABLE: a rod does not reach.",
        [
            f"SINGULAR also near a parallel singularity, where {meet}: the loop closes, but the "
            "joints do not determine the hand.",
            *(
                [
                    f"SINGULAR too where the hand is on the first axis of the {guide.leg}, which "
                    "turns freely about it; there turn_1 = 0 is taken.",
                    guide.left_out,
                ]
                if isinstance(guide, Guide)
                else []
            ),
            *(
                [guide.left_out]
                if isinstance(guide, Hinges | ParallelAxes) and guide.left_out
                else []
            ),
            *(["INVALID: the matrix is not a proper rotation."] if "R" in guide.inputs else []),
            f"fk is not derived: the forward problem is an equation of degree {guide.degree}.",
        ],
    )
    means = {name: e for link in placed.links for name, e in link.means.items()}
    held = (g.explicit(e.xreplace(means)) for link in placed.links for e in link.equations)
    shift = placed.shift if placed.slide else m.posture.shift
    arms = [shift + m.posture.rotation * place for place in m.places]
    solved.certify((*held, *m.closed(arms)), before=placed.links)


__all__ = ["guided"]
