"""A hand that turns and that legs carry: three of them in a plane, or six in space.

:func:`platform` derives what has a closed form: the inverse with all working modes, the velocity
and the singular sets.  The forward problem leads to an equation of degree 6 in a plane, or 40 in
space, and no ``fk`` is derived.  What depends on the posture is a function of the pose and of the
joints.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, pairwise
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.algebra.solutions import count_solutions
from closedform.lemmas.legs import Crank, Leg, Slide, Stretch, Strut, cross_in_plane, vector
from closedform.lemmas.rails import Rail
from closedform.loops.hand import check_order, check_plain, in_space, rate_of, square
from closedform.loops.leg_by_leg import MISSED, LegByLeg, named_in, signs_of_modes, size_of
from closedform.loops.on_rails import on_rails
from closedform.mechanics.frames import hat, pose_symbols, require_pose, rotation
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, real
from closedform.model.step import Step

DEGREE_IN_SPACE = 40
"""Of six points of a body that are at given distances from six points of the ground."""

TASK_IN_PLANE = 3
"""The number of coordinates of a hand that turns in a plane."""
TOGETHER = "The pose and the joints have to belong together, as ik gives them."


def platform(d: Derivation, legs: Sequence[Leg]) -> None:
    """Derive and export a hand with three legs in a plane, or six in space.

    It exports ``ik``, ``jacobian_parallel`` (A), ``jacobian_serial`` (the diagonal of B),
    ``jacobian_inverse`` (B^-1*A), ``singularities``, ``skeleton``, in a plane ``jacobian`` and
    ``determinant``, and ``workspace_contains`` where the reach of the legs is limited.  On three
    rails in a plane there is also ``fk``, with two assembly modes.

    Parameters
    ----------
    d
        the derivation, with its parameters and joints; the legs are in the order of the joints.
        Its task becomes ``x, y, yaw`` in a plane and the pose in space.  If it has no
        ``singularities``, they are named after the legs
    legs
        see :mod:`closedform.lemmas.legs`; ``on_hand`` is seen in the frame of the hand
    """
    rails = [leg for leg in legs if isinstance(leg, Rail)]
    if len(rails) == len(legs) == len(d.actuated) == TASK_IN_PLANE:
        on_rails(d, rails)
        return
    m = Platform(d, tuple(legs))
    if not d.singularities:
        d.singularities = (*(f"leg {k}" for k, _ in m.numbered), "all legs")
    m.d.loop = loop = m.state_loop()
    degree = _forward(m, loop)
    _velocity(m, loop)
    _export(m)
    _draw(m)
    _inverse(m, loop, degree)


@dataclass(frozen=True)
class Platform:
    """A hand that turns, and its legs."""

    d: Derivation
    legs: tuple[Leg, ...]

    def __post_init__(self) -> None:
        name, n = self.d.name, len(self.legs)
        if n != {2: 3, 3: 6}.get(self.dimensions):
            raise ShapeError(
                f"{name}: {n} legs in {self.dimensions} dimensions; a hand that turns has three "
                f"legs in a plane or six in space"
            )
        for leg in self.legs:
            if isinstance(leg, Strut):
                raise ShapeError(f"{name}: a strut cannot carry a hand that turns")
        check_order(self.d, self.legs)
        check_plain(self.d, self.legs)
        task = [str(e) for e in self.pose] if self.dimensions == 3 else ["x", "y", "yaw"]
        if list(self.d.task) not in ([], task):
            raise ShapeError(f"{name}: the task of this hand is {', '.join(task)}")
        self.d.task = task
        if self.spread == 0:
            raise ShapeError(f"{name}: all legs end in the same point of the hand; it turns freely")
        if any(isinstance(leg, Rail) for leg in self.legs):
            raise ShapeError(
                f"{name}: a rail cannot carry a hand that turns; the forward problem is of degree "
                f"{degree_in_plane(self)}, and no formula is derived for it"
            )

    @property
    def dimensions(self) -> int:
        return len(self.legs[0].base)

    @property
    def meet(self) -> str:
        """What the rods do where A is singular."""
        if self.dimensions == 3:
            return "the lines of the rods belong to one linear complex"
        return "the rods pass through one point or are parallel"

    @property
    def numbered(self) -> list[tuple[int, Leg]]:
        return [*enumerate(self.legs, 1)]

    @cached_property
    def pose(self) -> sp.Matrix:
        """The target: x, y and yaw, or a homogeneous transform."""
        if self.dimensions == 2:
            return sp.Matrix([real("x"), real("y"), real("yaw")])
        return pose_symbols()

    @property
    def target(self) -> dict[str, Any]:
        """The input that is the target, under its name."""
        return {"x": tuple(self.pose)} if self.dimensions == 2 else {"T": self.pose}

    @property
    def position(self) -> sp.Matrix:
        return self.pose[:2, 0] if self.dimensions == 2 else self.pose[:3, 3]

    @property
    def rotation(self) -> sp.Matrix:
        if self.dimensions == 3:
            return self.pose[:3, :3]
        return rotation("z", self.pose[2])[:2, :2]

    @cached_property
    def places(self) -> list[sp.Matrix]:
        """Where the rods end, in the frame of the hand."""
        return [vector(leg.on_hand or [0] * self.dimensions) for leg in self.legs]

    @property
    def spread(self) -> sp.Expr:
        """The mean squared distance of these ends from their centre."""
        n = len(self.places)
        centre = sum(self.places, sp.zeros(self.dimensions, 1)) / n
        return sp.factor(sp.expand(sum(square(place - centre) for place in self.places) / n))

    @cached_property
    def arms(self) -> list[sp.Matrix]:
        """The same, from the point that is the hand, in the frame of the base."""
        return [self.rotation * place for place in self.places]

    @cached_property
    def rods(self) -> list[sp.Matrix]:
        """The vectors along the rods, from their near ends to the hand."""
        legs = zip(self.legs, self.arms, strict=True)
        return [self.position + arm - leg.end() for leg, arm in legs]

    @cached_property
    def loop(self) -> tuple[sp.Expr, ...]:
        """The equations of the loop: each rod keeps its length."""
        return tuple(
            square(rod) - sp.sympify(leg.rod, strict=True) ** 2
            for leg, rod in zip(self.legs, self.rods, strict=True)
        )

    def state_loop(self) -> Step:
        return self.d.step(
            "The loop",
            f"{'Three' if self.dimensions == 2 else 'Six'} rods carry the hand.  Its pose is the "
            "position p of one of its points, and R, by which it is turned.  The near end of rod i "
            "is b, which the joint of its leg determines.  The far end is e in the frame of the "
            "hand.  The rod keeps the distance of its ends: |p + R*e - b| is its length.",
            {},
            rows=[
                ("i", "b", "e", "length of the rod"),
                *(
                    (str(k), leg.end().T, place.T, sp.sympify(leg.rod, strict=True))
                    for (k, leg), place in zip(self.numbered, self.places, strict=True)
                ),
            ],
        )


def _forward(m: Platform, loop: Step) -> int:
    """The degree of the forward problem, which has no closed form."""
    if m.dimensions == 3:
        degree = DEGREE_IN_SPACE
        found = f"For points in general position it is {degree}, and it is never more."
    else:
        degree = degree_in_plane(m)
        found = "It was counted with a Groebner basis, at lengths and joints drawn at random."
    m.d.step(
        f"Forward: an equation of degree {degree}",
        "If the joints are given, the equations of the loop determine the pose.  They have to be "
        "solved together: no coordinate follows from a part of them.  The number of complex "
        f"solutions is the degree of the equation that remains.  {found}  No formula is derived "
        "for it.",
        {},
        uses=[loop],
    )
    return degree


def degree_in_plane(m: Platform) -> int:
    """The number of complex poses for the same joints, at generic lengths and joints.

    A square root in the drawing is one more unknown, whose two values have as many poses each.
    """
    x, y, yaw = m.pose
    ends = [sp.Matrix([real(f"b{k}_{i}") for i in "xy"]) for k, _ in m.numbered]
    hand = [m.position + arm - end for arm, end in zip(m.arms, ends, strict=True)]
    equations = [
        (leg.normal.dot(e) if isinstance(leg, Rail) else square(e)) - real(f"r{k}")
        for (k, leg), e in zip(m.numbered, hand, strict=True)
    ]
    roots = {e for f in equations for e in f.atoms(sp.Pow) if e.exp == sp.Rational(1, 2)}
    names = {e: real(f"root{k}") for k, e in enumerate(sorted(roots, key=str))}
    equations = [e.xreplace(names) for e in equations]
    equations += [name**2 - e.base for e, name in names.items()]
    unknowns = (x, y, yaw, *names.values())
    found = int(count_solutions(equations, unknowns, method="specialised").count)
    return found // (1 << len(names))


def _moment(arm: sp.Matrix, vector: sp.Matrix) -> sp.Matrix:
    """The moment about the point that is the hand of a vector at the end of an arm."""
    if len(arm) == 3:
        return arm.cross(vector)
    return sp.Matrix([cross_in_plane(arm, vector)])


def _velocity(m: Platform, loop: Step) -> None:
    d = m.d
    rows = [rod.col_join(_moment(arm, rod)).T for arm, rod in zip(m.arms, m.rods, strict=True)]
    rates = [rate_of(leg, rod) for leg, rod in zip(m.legs, m.rods, strict=True)]
    n = m.dimensions
    v, omega = (sp.Matrix([real(f"{name}_{i}") for i in "xyz"]) for name in ("v", "omega"))
    omega = omega if n == 3 else sp.Matrix([0, 0, omega[2]])
    v, turning = v[:n, 0], hat(omega)[:n, :n]
    twist = sp.Matrix([*v, *(e for e in omega if e != 0)])
    moved = [v + turning * arm for arm in m.arms]
    axes = range(1, n + 1)
    rod, arm = ([_component(d, letter, "i", i) for i in axes] for letter in "rh")
    shown = {r"\mathbf a_i": sp.Matrix([[*rod, *_moment(sp.Matrix(arm), sp.Matrix(rod))]])}
    for k, leg in m.numbered:
        along = sp.Matrix([_component(d, "r", str(k), i) for i in axes])
        shown[f"B_{{{k}{k}}}"] = rate_of(leg, along)
    d.step(
        "Velocity and singular sets",
        "The derivatives of the loop equations, halved, give A*t = B*dq for the twist t of the "
        "hand: the velocity of its point p and its angular velocity.  Row i of A is the vector r "
        "along rod i, which is p + R*e - b, and its moment about p, at the end of the arm h, which "
        "is R*e.  B is diagonal, because each leg depends on its own "
        "joint alone.  B is singular if the joint moves the near end of a rod at right angles to "
        "it (serial: the joint moves and the hand stands still).  A is singular if "
        f"{m.meet} (parallel: the hand can move while the joints stand still).",
        shown,
        proves="The derivative of each loop equation along a twist and a joint rate is twice the "
        "row of A times the twist, minus twice the entry of B times the rate.  The "
        "formula for the determinant holds for any "
        f"matrix{', and the adjugate gives J with A*J = B' if m.dimensions == 2 else ''}.",
        equal=[
            *_of_any_matrix(len(m.legs)),
            *(
                pair
                for leg, rod, row, rate, by, e in zip(
                    m.legs, m.rods, rows, rates, moved, m.loop, strict=True
                )
                for pair in ((rod.dot(by), (row * twist)[0]), (e.diff(leg.joint), -2 * rate))
            ),
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
    placed = _named_rows(p, arms, [m.position - end for end in ends])
    rods = [row[0, : m.dimensions].T for row in placed]
    driven = [
        named_in(p, f"B_{k}{k}", rate_of(leg, rod))
        for (k, leg), rod in zip(m.numbered, rods, strict=True)
    ]
    volume = p.let("Delta", determinant(p, placed))
    A = sp.Matrix.vstack(*placed)
    serial = "Not finite at a serial singularity."
    functions: list[tuple[str, str, dict[str, Any], tuple[str, ...]]] = [
        (
            "jacobian_parallel",
            "A of A*t = B*dq; a row is the vector along a rod and its moment about the hand.",
            {"A": A},
            (),
        ),
        (
            "jacobian_serial",
            "The diagonal of B of A*t = B*dq.",
            {"B": driven},
            signs_of_modes(m.legs),
        ),
        (
            "jacobian_inverse",
            "B^-1*A: joint rates per velocity and angular velocity of the hand.",
            {"K": sp.Matrix.vstack(*(row / b for row, b in zip(placed, driven, strict=True)))},
            (serial,),
        ),
        (
            "singularities",
            "The diagonal of B (serial) and the determinant of A (parallel).",
            {"factors": [*driven, volume]},
            (),
        ),
    ]
    if m.dimensions == 2:
        pole = ("Not finite at a parallel singularity.",)
        J = A.adjugate() * sp.diag(*driven) / volume
        det = sp.Mul(*driven) / volume
        functions += [
            ("jacobian", "Derivative of x, y and yaw with respect to q: A^-1*B.", {"J": J}, pole),
            ("determinant", "Determinant of the Jacobian.", {"det": det}, pole),
        ]
    for name, summary, outputs, notes in functions:
        d.function(
            name,
            summary,
            {**m.target, "q": d.actuated},
            outputs,
            program=p,
            notes=(TOGETHER, *notes),
        )


def _of_any_matrix(n: int) -> list[tuple[Any, Any]]:
    """That the determinant is correct, and for three rows the adjugate too."""
    a = sp.Matrix(n, n, lambda i, j: real(f"a{i + 1}{j + 1}"))
    p = Program()
    value = p.explicit(determinant(p, [a.row(i) for i in range(n)]))
    adjugate = [(a * a.adjugate(), value * sp.eye(n))] if n == 3 else []
    return [(value, a.det(method="berkowitz")), *adjugate]


def _component(d: Derivation, letter: str, leg: str, axis: int) -> sp.Symbol:
    """A symbol for a component of the vector along a rod, r, or of the arm of its moment, h."""
    name = f"{letter}{leg}_{axis}"
    if name not in d.written:
        vector = "vector along rod" if letter == "r" else "arm of rod"
        d.write(name, f"{letter}_{{{leg}{axis}}}", f"component {axis} of the {vector} {leg}")
    return real(name)


def _named_arms(m: Platform, p: Program) -> list[sp.Matrix]:
    return [
        sp.Matrix([named_in(p, f"h_{k}{i}", e) for i, e in enumerate(arm, 1)])
        for k, arm in enumerate(m.arms, 1)
    ]


def _named_rows(
    p: Program, arms: Sequence[sp.Matrix], spans: Sequence[sp.Matrix]
) -> list[sp.Matrix]:
    """The rows of A, their entries under names.

    The ``spans`` lead from the near ends of the rods to the point that is the hand.  A rod is a
    span and an arm, and the arm has no moment, so the moment is that of the span.
    """
    found = []
    for k, (arm, span) in enumerate(zip(arms, spans, strict=True), 1):
        entries = enumerate([*(span + arm), *_moment(arm, span)], 1)
        found.append(sp.Matrix([[named_in(p, f"A_{k}{i}", e) for i, e in entries]]))
    return found


def determinant(p: Program, rows: Sequence[sp.Matrix]) -> sp.Expr:
    """The determinant of three or six rows; six are expanded by the minors of two halves."""
    n = len(rows)
    if n == 3:
        return sp.Matrix.vstack(*rows).det()
    every, terms = range(n), []
    for some in combinations(every, 3):
        others = [k for k in every if k not in some]
        sign = (-1) ** (sum(some) - 3)
        minors = [
            p.let(
                f"{letter}_{''.join(str(k + 1) for k in chosen)}",
                sp.Matrix.vstack(*(rows[k][0, columns] for k in chosen)).det(),
            )
            for letter, chosen, columns in (
                ("N", some, slice(0, 3)),
                ("M", others, slice(3, 6)),
            )
        ]
        terms.append(sign * sp.Mul(*minors))
    return sp.Add(*terms)


def _draw(m: Platform) -> None:
    """The skeleton: bases A, near ends B and far ends C of the rods, and P, the hand."""
    far = [next(k for k, e in enumerate(m.places, 1) if e == place) for place in m.places]
    ends = ["P" if e.is_zero_matrix else f"C{k}" for k, e in zip(far, m.places, strict=True)]
    at = dict(zip(ends, (m.position + arm for arm in m.arms), strict=True))
    points = {"P": in_space(m.position), **{name: in_space(e) for name, e in at.items()}}
    links: dict[str, tuple[str, ...]] = {}
    lengths: dict[tuple[str, str], sp.Expr] = {}
    closing: dict[tuple[str, str], sp.Expr] = {}
    joints: dict[sp.Symbol, tuple[str, ...]] = {}
    for (k, leg), end, equation in zip(m.numbered, ends, m.loop, strict=True):
        base, near = f"A{k}", f"A{k}" if isinstance(leg, Stretch) else f"B{k}"
        points |= {base: in_space(leg.base), near: in_space(leg.end())}
        lengths[near, end], closing[near, end] = sp.sympify(leg.rod, strict=True), equation
        joints[leg.joint] = (base,) if isinstance(leg, Crank) else (base, near)
        if isinstance(leg, Stretch):
            joints[leg.joint] = (base, end)
            continue
        links[f"rod{k}"] = (near, end)
        lengths[base, near] = leg.joint
        if isinstance(leg, Crank):
            links[f"crank{k}"] = (base, near)
            lengths[base, near] = sp.sympify(leg.length, strict=True)
    corners = list(dict.fromkeys(ends))
    links["hand"] = tuple([*corners, *corners[:1]] if len(corners) > 2 else corners)
    if "P" not in corners:
        links["hand0"] = ("P", corners[0])
    places = dict(zip(ends, m.places, strict=True)) | {"P": sp.zeros(m.dimensions, 1)}
    for pair in [*pairwise(links["hand"]), *pairwise(links.get("hand0", ()))]:
        gap = places[pair[1]] - places[pair[0]]
        lengths[pair] = sp.sqrt(sp.factor(sp.expand(square(gap))))
        if m.dimensions == 3:  # in a plane, that of cosine and sine is known
            closing[pair] = sp.expand(square(m.rotation * gap) - square(gap))
    ground = tuple(f"A{k}" for k, _ in m.numbered)
    skeleton(
        m.d,
        points,
        links={"ground": (*ground, ground[0]), **links},
        joints=joints,
        hand="P",
        hand_at=in_space(m.position),
        ground=ground,
        lengths=lengths,
        pose=m.target,
        notes=(TOGETHER,),
        at_posture=[points],
        closing=closing,
    )


def _inverse(m: Platform, loop: Step, degree: int) -> None:
    d, g = m.d, m.d.program()
    if m.dimensions == 3:
        require_pose(g, m.pose)
    slides = any(isinstance(leg, Slide) for leg in m.legs)
    solved = LegByLeg(d, g, g.let("size", size_of(d, m.legs, tuple(m.position) if slides else ())))
    arms = _named_arms(m, g)
    for (k, leg), arm in zip(m.numbered, arms, strict=True):
        solved.solve(k, leg, m.position + arm - leg.base)
    spans = [s.rod - arm for s, arm in zip(solved.found, arms, strict=True)]
    rows = _named_rows(g, arms, spans)
    volume = g.let("Delta", determinant(g, rows))
    lever = g.let("lever", sp.sqrt(m.spread), nonnegative=True)
    # six legs lose more digits in their determinant than in the pose that they determine
    power, share = (1, "2^-10") if m.dimensions == 2 else (3, "2^-20")
    least = solved.lengths(m.legs) * lever**power
    g.determined(
        sp.Abs(volume),
        least if power == 1 else least / 2**10,
        m.meet,
        name=r"|\det A|",
        scale_name=r"\lambda \prod_i |\mathbf r_i|"
        if power == 1
        else r"2^{-10} \lambda^3 \prod_i |\mathbf r_i|",
        missed=solved.missed,
        size=solved.size,
    )
    d.step(
        "Inverse: leg by leg",
        f"Each leg is solved alone.  {solved.on_modes}Near a parallel singularity rounded "
        "joints do not determine the hand.  The status is SINGULAR if the determinant of A is "
        f"less than {share} of the product of the lengths of the rods and"
        f"{'' if power == 1 else ' the third power of'} lambda, the root mean square distance "
        f"of the ends of the rods on the hand from their centre.  {MISSED}",
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
            *(["INVALID: the matrix is not a pose."] if m.dimensions == 3 else []),
            f"fk is not derived: the forward problem is an equation of degree {degree}.",
        ],
    )
    solved.certify(m.loop)


__all__ = ["Platform", "platform"]
