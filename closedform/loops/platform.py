"""A hand that turns and that legs carry: three in a plane, or six in space.

In space four legs may keep the hand upright; then it turns about the z axis alone.

:func:`platform` derives what has a closed form: the inverse with all working modes, the velocity
and the singular sets.  The forward problem leads to an equation of degree 6 in a plane, 8 for a
hand that is kept upright, or 40, and no ``fk`` is derived.  What depends on the posture is a
function of the pose and of the joints.  If two of three legs end in one point of the hand, there is
``fk`` too, see :mod:`closedform.loops.meeting`; also on two rails, see
:mod:`closedform.loops.two_rails`, and if six legs end in three points, three, two and one of them,
see :mod:`closedform.loops.three_points`.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, pairwise
from operator import add
from typing import Any

import sympy as sp

from closedform.lemmas.axial import Along, FreeAlong
from closedform.lemmas.legs import Leg, Slide
from closedform.lemmas.planes import Plane
from closedform.lemmas.rails import Rail
from closedform.lemmas.turret import Around, OnTurret
from closedform.loops.guides import Ball
from closedform.loops.hand import in_space, rate_of, square
from closedform.loops.leg_by_leg import (
    MISSED,
    LegByLeg,
    known_sides,
    named,
    named_in,
    size_of,
)
from closedform.loops.letters import letters
from closedform.loops.meeting import Meet
from closedform.loops.modes import NO_MODE
from closedform.loops.on_axes import (
    beside_turrets,
    close_on_axes,
    row_on_axes,
    solved_on_axes,
    still_on_axes,
    still_on_turrets,
)
from closedform.loops.on_rails import on_rails
from closedform.loops.pairs import degree_of_pairs
from closedform.loops.platform_legs import (
    UPRIGHT,
    Half,
    Platform,
    Posture,
    check_holds,
    counted_degree,
    jacobians,
    matrices,
    pull_of,
)
from closedform.loops.skeleton import Drawing, points_of
from closedform.loops.three_points import ThreePoints
from closedform.loops.two_rails import TwoRails
from closedform.loops.upright import check_upright, constraint, left_out, state_upright
from closedform.mechanics.frames import hat, require_pose
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, real
from closedform.model.names import listed
from closedform.model.step import Step

AXES = "xyz"
DEGREE_OF_CIRCLES = 16
"""Of three points of a body that are on given circles."""
DEGREE_IN_SPACE = 40
"""Of six points of a body that are at given distances from six points of the ground."""
TASK_IN_PLANE = 3
"""The number of coordinates of a hand that turns in a plane."""
AMPLIFIED = (
    "2^-10 of Sigma.  Sigma is a third of the determinant, times the sum over all rods of what a "
    "missed length does to the hand: by how much it turns it, times Lambda, the sum of all "
    "lengths, and by how much it moves the point in which three legs end.  So rods that miss by "
    "a 3000th of Lambda could turn the hand by a radian"
)
TOGETHER = "The pose and the joints have to belong together, as ik gives them."


def platform(d: Derivation, legs: Sequence[Leg | Half], *, bars: int = 2) -> None:
    """Derive and export a hand with three legs in a plane, or with four or six in space.

    Four legs in space keep the hand upright.  Their rods have universal joints with vertical outer
    axes (:class:`~closedform.lemmas.universal.Universal`, or a ``Stretch`` with an ``axis``), or
    each leg is a :class:`Half`, or each is a :class:`~closedform.lemmas.planes.Plane`.

    It exports ``ik``, ``jacobian_parallel`` (A), ``jacobian_serial`` (the diagonal of B),
    ``jacobian_inverse`` (B^-1*A), ``singularities`` and ``skeleton``, in a plane and for four legs
    ``jacobian`` and ``determinant``, for four legs ``constraint``, and ``workspace_contains`` where
    the reach of the legs is limited.

    There is also ``fk`` on three rails in a plane, and on four
    :class:`~closedform.lemmas.planes.Plane` legs in space, with two assembly modes; on two rails,
    and if two of three legs end in one point of the hand, with four; and if six legs end in three
    points of it, three, two and one of them, or legs that stretch start so in three points of the
    ground, with eight.
    Then what depends on the posture is a function of the joints, and there is ``jacobian`` instead
    of ``jacobian_inverse``.

    Parameters
    ----------
    d
        the derivation, with its parameters and joints; the legs are in the order of the joints.
        Its task becomes ``x, y, yaw`` in a plane, ``x, y, z, yaw`` with four legs, and the pose
        with six.  If it has no ``singularities``, they are named after the legs
    legs
        see :mod:`closedform.lemmas.legs`; ``on_hand`` is seen in the frame of the hand
    bars
        how many bars join the halves of a hand: two, as in a Par 4, or one, as in an H4
    """
    for kind, count in ((Rail, TASK_IN_PLANE), (Plane, UPRIGHT)):
        flat = [leg for leg in legs if isinstance(leg, Rail | Plane) and isinstance(leg, kind)]
        if len(flat) == len(legs) == len(d.actuated) == count:
            on_rails(d, flat)
            return
    m = Platform(d, tuple(legs), bars)
    upright = len(m.legs) == UPRIGHT
    if upright:
        check_upright(m)
    check_holds(m)
    if not d.singularities:
        d.singularities = (*(f"leg {k}" for k, _ in m.numbered), "all legs")
    m.d.loop = loop = close_on_axes(m) if m.axial else _close(m)
    if upright:
        state_upright(m, loop)
    if solved := TwoRails.of(m) or Meet.of(m) or ThreePoints.of(m):
        d.poles = d.singularities[-1:]
        at = solved.forward(loop)
        _velocity(m, loop)
        solved.export_rates(at)
        _draw(m, at)
        _inverse(m, loop, points=solved if isinstance(solved, ThreePoints) else None)
        return
    degree = _forward(m, loop)
    _velocity(m, loop)
    _export(m)
    _draw(m)
    _inverse(m, loop, degree)


def _close(m: Platform) -> Step:
    """The step on the loop."""
    ends = zip(m.numbered, m.places, m.offsets, strict=True)
    rows = [
        (
            str(k),
            leg.end().T,
            place.T,
            *[offset.T] * bool(m.halves),
            leg.normal.T if isinstance(leg, Rail) else sp.sympify(leg.rod, strict=True),
        )
        for (k, leg), place, offset in ends
    ]
    e, s = letters(m.d, "es")
    last = "length of the rod" + ", or normal of the rail" * m.rails
    columns = ("i", "b", e, *[s] * bool(m.halves), last)
    joined = "a bar joins them" if m.bars == 1 else "two bars join them"
    far = (
        f"The halves of the hand do not turn, and {joined}, which R turns.  The pin of the "
        f"half that holds rod i is {e} in the frame of that bar, and {s} leads from it to the far "
        f"end of the rod.  The rod keeps the distance of its ends: |p + R*{e} + {s} - b| is its "
        "length."
        if m.halves
        else f"The far end is {e} in the frame of the hand.  The rod keeps the distance of its "
        f"ends: |p + R*{e} - b| is its length."
    )
    if m.rails:
        far += (
            f"  A leg with a rail has no rod: b is on the rail, whose normal is n, and the far end "
            f"is on it too, so n^T*(p + R*{e} - b) is zero."
        )
    turned = "R, by which it is turned" if m.tilts or m.dimensions == 2 else "R, a turn about z"
    count = {3: "Three", 4: "Four", 6: "Six"}[len(m.legs)]
    return m.d.step(
        "The loop",
        f"{count} rods carry the hand.  Its pose is the position p of one of its points, and "
        f"{turned}.  The near end of rod i is b, which the joint of its leg determines.  {far}",
        {},
        rows=[columns, *rows],
    )


def _forward(m: Platform, loop: Step) -> str:
    """The degree of the forward problem, for which no formula is derived."""
    if m.axial:
        degree = f"{DEGREE_OF_CIRCLES}"
        found = (
            "The joints leave each point a circle about its axis, and three points on such circles "
            "have to keep their distances, as those of a 3-RPS mechanism.  These are three "
            "equations in the tangents of half of the angles on the circles, each of degree two in "
            "two of them, so they have at most 16 solutions; for points in general position "
            "it is not less."
        )
    elif m.pairs:
        degree = f"{degree_of_pairs(m.pairs)}"
        found = (
            "Two legs leave the point in which they meet a circle, and three points on such "
            "circles have to keep their distances.  The degree was counted by elimination, at "
            "places and lengths drawn at random."
        )
    elif m.tilts:
        degree, general = (
            f"{DEGREE_IN_SPACE}",
            f"For points in general position it is {DEGREE_IN_SPACE}",
        )
        found = f"{general}, and it is never more."
        if len(m.meeting) == len(AXES):
            degree = f"at most {2 * Ball.degree}"
            found = (
                f"The point has two places, and for each of them the equation that remains has at "
                f"most the degree {Ball.degree}."
            )
        elif len(m.groups) < len(m.legs) or len(m.groups_on_ground) < len(m.legs):
            degree = f"at most {DEGREE_IN_SPACE}"
            found = f"{general}; here legs end in the same point, and it may be less."
    else:
        degree = f"{counted_degree(m)}"
        found = "It was counted with a Groebner basis, at lengths and joints drawn at random."
    how = "They have to be solved together: no coordinate follows from a part of them."
    if len(m.meeting) >= m.dimensions:
        joints = listed([str(leg.joint) for leg in m.meeting])
        how = (
            f"The legs of {joints} end in the same point of the hand, which follows from their "
            f"equations alone; the others then turn the hand about it."
        )
    m.d.step(
        f"Forward: an equation of degree {degree}",
        f"If the joints are given, the equations of the loop determine the pose.  {how}  The "
        f"number of complex solutions is the degree of the equation that remains.  {found}  No "
        "formula is derived for it.",
        {},
        uses=[loop],
    )
    return degree


def _velocity(m: Platform, loop: Step) -> None:
    d = m.d
    ends = [span + arm for span, arm in zip(m.spans, m.arms, strict=True)]
    rates = [rate_of(*each) for each in zip(m.legs, m.rods, ends, strict=True)]
    n = m.dimensions
    v, omega = (sp.Matrix([real(f"{name}_{i}") for i in "xyz"]) for name in ("v", "omega"))
    omega = omega if m.tilts else sp.Matrix([0, 0, omega[2]])
    v, turning = v[:n, 0], hat(omega)[:n, :n]
    twist = sp.Matrix([*v, *(e for e in omega if e != 0)])
    moved = [v + turning * arm for arm in m.arms]
    axes = range(1, n + 1)
    rod, arm = ([_component(d, letter, "i", i) for i in axes] for letter in "rh")
    shown = {r"\mathbf a_i": sp.Matrix([[*rod, *m.moment(sp.Matrix(arm), sp.Matrix(rod))]])}
    for k, leg in m.numbered:
        along = sp.Matrix([_component(d, "r", str(k), i) for i in axes])
        if isinstance(leg, Around):
            along = sp.Matrix([_component(d, "w", str(k), i) for i in axes])
        shown[f"B_{{{k}{k}}}"] = rate_of(leg, along, along)
    e, s = letters(d, "es")
    halved, twice = "of the loop equations, halved,", "is twice the"
    adjugate = ", and the adjugate gives J with A*J = B" * (not m.tilts)
    times = "that" if m.axial or m.rails else "twice the"
    row = (
        f"the vector r along rod i, which is p + R*{e}{f' + {s}' * bool(m.halves)} - b, and its "
        f"moment about {'p' if m.tilts or m.dimensions == 2 else 'the vertical through p'}"
    )
    serial = "the joint moves the near end of a rod at right angles to it (serial: the joint moves"
    if m.rails:
        halved = "of the equations of the loop, those of the rods halved,"
        twice = "is, for a rod twice, the"
        row = "the vector r, along rod i or at right angles to its rail, and its moment about p"
        serial = "the joint moves the near end of a rod at right angles to it (serial: it moves"
    if m.axial:
        halved = "of the equations of the loop, those of the distances halved,"
        twice = "is, for a distance twice, the"
        row, serial = "a vector r and its moment about p", still_on_axes(m)
    d.step(
        "Velocity and singular sets",
        f"The derivatives {halved} give A*t = B*dq for the twist t of the "
        f"hand: the velocity of its point p and its angular velocity.  Row i of A is {row}, at the "
        f"end of the arm h, which is R*{e}.  {row_on_axes(m)}B is diagonal, because each leg "
        f"depends on its own joint alone.  {beside_turrets(m)}B is singular if {serial} and the "
        f"hand stands still).  A is singular if {m.meet} (parallel: the hand can move while the "
        f"joints stand still).",
        shown,
        proves=f"The derivative of each loop equation along a twist and a joint rate {twice} "
        f"row of A times the twist, minus {times} entry of B times the rate.  The formula for the "
        f"determinant holds for any matrix{adjugate}.",
        equal=[
            *of_any_matrix(len(m.legs), adjugate=not m.tilts),
            *(
                pair
                for leg, rod, row, rate, by, e in zip(
                    m.legs, m.rods, m.rows, rates, moved, m.loop, strict=True
                )
                for pair in (
                    (rod.dot(by), (row * twist)[0]),
                    (
                        e.diff(leg.joint),
                        -rate * (1 if isinstance(leg, Along | Around | Rail) else 2),
                    ),
                )
            ),
            *still_on_turrets(m),
        ],
        uses=[loop],
    )


def _export(m: Platform) -> None:
    """The functions of a pose and the joints that belong to it."""
    d, p = m.d, m.d.program()
    ends = [
        sp.Matrix([named_in(p, f"b_{k}{i}", e) for i, e in enumerate(leg.end(), 1)])
        for k, leg in m.numbered
    ]
    arms = _named_arms(m, p)
    spans = [m.position + s - end for s, end in zip(m.offsets, ends, strict=True)]
    placed = _named_rows(m, p, arms, spans)
    rods = [row[0, : m.dimensions].T for row in placed]
    driven = [
        named_in(p, f"B_{k}{k}", rate_of(leg, rod, span + arm))
        for (k, leg), rod, span, arm in zip(m.numbered, rods, spans, arms, strict=True)
    ]
    volume = p.let("Delta", determinant(p, placed))
    A = sp.Matrix.vstack(*placed)
    shares = [row / b for row, b in zip(placed, driven, strict=True)]
    if m.axial:  # the quotient first: a product of small lengths may be too small for the type
        ways = [named(p, f"r_{k}", share[0, :3].T) for k, share in enumerate(shares, 1)]
        shares = [way.col_join(m.moment(arm, way)).T for way, arm in zip(ways, arms, strict=True)]
    inverse = (
        "jacobian_inverse",
        "B^-1*A: joint rates per velocity and angular velocity of the hand.",
        {"K": sp.Matrix.vstack(*shares)},
        ("Not finite at a serial singularity.",),
    )
    *both, singular = matrices(m, A, driven, volume)
    functions = [*both, inverse, singular]
    if len(m.legs) == UPRIGHT:
        functions.append(constraint(m, rods))
    if not m.tilts:
        functions += jacobians(m, p, A, driven, volume)
    for name, summary, outputs, notes in functions:
        d.function(
            name,
            summary,
            {**m.target, "q": d.actuated},
            outputs,
            program=p,
            notes=(TOGETHER, *notes),
        )


def of_any_matrix(n: int, *, adjugate: bool) -> list[tuple[Any, Any]]:
    """That the determinant is correct, and the adjugate if it is used."""
    a = sp.Matrix(n, n, lambda i, j: real(f"a{i + 1}{j + 1}"))
    p = Program()
    value = p.explicit(determinant(p, [a.row(i) for i in range(n)]))
    inverse = [(a * a.adjugate(), value * sp.eye(n))] if adjugate else []
    return [(value, a.det(method="berkowitz")), *inverse]


def _component(d: Derivation, letter: str, leg: str, axis: int) -> sp.Symbol:
    """A symbol for a component of the vector along a rod, r, or of the arm of its moment, h."""
    name = f"{letter}{leg}_{axis}"
    if name not in d.written:
        vector = {"r": "vector along rod", "w": "vector from the pivot to the end of leg"}.get(
            letter, "arm of rod"
        )
        meaning = f"component {axis} of the {vector} i" if leg == "i" else ""
        d.write(name, f"{letter}_{{{leg}{axis}}}", meaning)
    return real(name)


def _named_arms(m: Platform, p: Program) -> list[sp.Matrix]:
    return [
        sp.Matrix([named_in(p, f"h_{k}{i}", e) for i, e in enumerate(arm, 1)])
        for k, arm in enumerate(m.arms, 1)
    ]


def _named_rows(
    m: Platform,
    p: Program,
    arms: Sequence[sp.Matrix],
    spans: Sequence[sp.Matrix],
    rods: Sequence[sp.Matrix] = (),
) -> list[sp.Matrix]:
    """The rows of A, their entries under names.

    A rod is a span and an arm, and the arm has no moment, so the moment is that of the span.
    """
    found = []
    given = rods or map(pull_of, m.legs, map(add, spans, arms))
    for (k, _), arm, span, rod in zip(m.numbered, arms, spans, given, strict=True):
        entries = enumerate([*rod, *m.moment(arm, rod if m.axial or m.rails else span)], 1)
        found.append(sp.Matrix([[named_in(p, f"A_{k}{i}", e) for i, e in entries]]))
    return found


def determinant(p: Program, rows: Sequence[sp.Matrix]) -> sp.Expr:
    """The determinant of some rows; four or six are expanded by the minors of two halves."""
    n, half = len(rows), len(rows) // 2
    if n == 3:
        return sp.Matrix.vstack(*rows).det()
    every, terms = range(n), []
    for some in combinations(every, half):
        others = [k for k in every if k not in some]
        sign = (-1) ** (sum(some) - sum(range(half)))
        minors = [
            p.let(
                f"{letter}_{''.join(str(k + 1) for k in chosen)}",
                sp.Matrix.vstack(*(rows[k][0, columns] for k in chosen)).det(),
            )
            for letter, chosen, columns in (
                ("N", some, slice(0, half)),
                ("M", others, slice(half, n)),
            )
        ]
        terms.append(sign * sp.Mul(*minors))
    return sp.Add(*terms)


def _draw(m: Platform, at: Posture | None = None) -> None:
    """The skeleton: bases A, near ends B and far ends C of the rods, pins M, and P, the hand."""
    distinct = list({tuple(place): place for place in m.places}.values())
    first = [(distinct if m.halves else m.places).index(place) + 1 for place in m.places]
    pins = [
        "P" if e.is_zero_matrix else f"{'M' if m.halves else 'C'}{k}"
        for k, e in zip(first, m.places, strict=True)
    ]
    places = dict(zip(pins, m.places, strict=True)) | {"P": sp.zeros(m.dimensions, 1)}

    def placed(position: sp.Matrix, rotation: sp.Matrix) -> dict[str, Sequence[Any]]:
        """All points, from the pose of the hand."""
        found: dict[str, Sequence[Any]] = {"P": in_space(position)}
        found |= {pin: in_space(position + rotation * e) for pin, e in places.items()}
        for (k, leg), pin, place, offset in zip(m.numbered, pins, m.places, m.offsets, strict=True):
            end = f"C{k}" if m.halves else pin
            found |= points_of(k, leg, end, position + rotation * place + offset)
        return found

    corners = list(dict.fromkeys(pins))
    hand = (*corners, *corners[:1]) if len(corners) > 2 else tuple(corners)
    if m.halves:
        hand = hand if "P" in hand else (hand[0], "P", hand[1])
    drawn = Drawing()
    for (k, leg), pin, offset, equation in zip(m.numbered, pins, m.offsets, m.loop, strict=True):
        end = f"C{k}" if m.halves else pin
        if isinstance(leg, Rail):
            span = m.spans[k - 1] + m.arms[k - 1]
            drawn.add_rail(k, leg, end, leg.way.dot(span), equation)
        else:
            aside = m.loop[k - 2] ** 2 if isinstance(leg, OnTurret) else 0
            drawn.add_leg(k, leg, end, equation + aside)
        if end != pin:
            drawn.links[f"half{k}"] = (pin, end)
            drawn.lengths[pin, end] = sp.sqrt(sp.factor(sp.trigsimp(square(offset))))
    drawn.links["hand"] = hand
    if "P" not in hand:
        drawn.links["hand0"] = ("P", hand[0])
    for pair in [*pairwise(hand), *pairwise(drawn.links.get("hand0", ()))]:
        gap = places[pair[1]] - places[pair[0]]
        drawn.lengths[pair] = sp.sqrt(sp.factor(sp.expand(square(gap))))
        if m.tilts:  # the length of the cosine and sine of one angle is known
            drawn.closing[pair] = sp.expand(square(m.rotation * gap) - square(gap))
    ground = tuple(f"A{k}" for k, leg in m.numbered if not isinstance(leg, FreeAlong | OnTurret))
    points = placed(m.position, m.rotation)
    skeleton(
        m.d,
        placed(at.position, at.rotation) if at else points,
        links={"ground": (*ground, ground[0]), **drawn.links},
        joints=drawn.joints,
        hand="P",
        hand_at=in_space(m.position),
        ground=ground,
        lengths=drawn.lengths,
        pose=None if at else m.target,
        program=at.program if at else None,
        branches=at.modes if at else None,
        notes=(NO_MODE if at else TOGETHER,),
        at_posture=[points],
        closing=drawn.closing,
    )


def _inverse(m: Platform, loop: Step, degree: str = "", points: ThreePoints | None = None) -> None:
    """The inverse; the ``degree`` is that of the forward problem, if ``fk`` is not derived.

    ``points`` are those in which six legs end, if it is.
    """
    d, g = m.d, m.d.program()
    if m.tilts:
        require_pose(g, m.pose)
    slides = any(isinstance(leg, Slide | Along | Rail) for leg in m.legs)
    moved = tuple(m.position) if slides else ()
    solved = LegByLeg(d, g, g.let("size", size_of(d, m.whole, moved)))
    arms = _named_arms(m, g)
    for (k, leg), arm, offset in zip(m.numbered, arms, m.offsets, strict=True):
        solved.solve(k, leg, m.position + arm + offset - leg.base)
    if points:
        sizes = solved.each_length(m.legs), solved.size
        volume, least = points.amplified(g, arms, [s.rod for s in solved.found], sizes)
        least, scale_name, said = least / 3, r"\Sigma", AMPLIFIED
    else:
        spans = [s.rod - arm for s, arm in zip(solved.found, arms, strict=True)]
        rows = _named_rows(m, g, arms, spans, [s.rod for s in solved.found] if m.axial else ())
        volume = determinant(g, rows)
        least, scale_name, said = _scale(m, g, solved, turns=not degree)
    g.determined(
        sp.Abs(g.let("Delta", volume)),
        least,
        m.meet,
        name=r"|\det A|",
        scale_name=scale_name,
        missed=solved.missed,
        size=solved.size,
    )
    d.step(
        "Inverse: leg by leg",
        f"Each leg is solved alone.  {known_sides(m.legs)}{solved_on_axes(m)}{solved.on_modes}"
        "Near a parallel singularity rounded "
        "joints do not determine the hand.  The status is SINGULAR if the determinant of A is "
        f"less than {said}.  {MISSED}",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    solved.export(
        m.target,
        m.target,
        "UNREACHABLE: a rod does not reach.",
        [
            f"SINGULAR also near a parallel singularity, where {m.meet}: the loop "
            "closes, but the joints do not determine the hand.",
            *(["INVALID: the matrix is not a pose."] if m.tilts else []),
            *([left_out(m)] if len(m.legs) == UPRIGHT else []),
            *(
                [f"fk is not derived: the forward problem is an equation of degree {degree}."]
                if degree
                else []
            ),
        ],
    )
    solved.certify(m.loop, "" if degree else "fk", angles=() if degree or m.tilts else m.pose[2:])


def _scale(m: Platform, g: Program, solved: LegByLeg, *, turns: bool) -> tuple[sp.Expr, str, str]:
    """The scale of the determinant of A, as an expression, as LaTeX, and in words.

    If ``fk`` gives what the hand ``turns``, this counts in radians, otherwise at the ends of rods.
    """
    rods, product = solved.lengths(m.legs), r"\prod_i |\mathbf r_i|"
    of = "of the product of the lengths of the rods and"
    total = "Lambda, the sum of all lengths"
    if turns and not m.tilts:
        return rods * solved.size, rf"\Lambda {product}", f"2^-10 {of} {total}"
    lever = g.let("lever", sp.sqrt(m.spread), nonnegative=True)
    spread = (
        "lambda, the root mean square distance of the ends of the rods on the hand from their "
        "centre"
    )
    if m.tilts:  # six legs lose more digits in their determinant than in the pose
        scale = rods * lever**3 / 2**10
        return scale, rf"2^{{-10}} \lambda^3 {product}", f"2^-20 {of} the third power of {spread}"
    return rods * lever, rf"\lambda {product}", f"2^-10 {of} {spread}"


__all__ = ["determinant", "of_any_matrix", "platform"]
