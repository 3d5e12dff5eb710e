"""A hand at the end of a rod that another rod holds: a five-bar linkage with its tool on a rod.

The rod of the first leg is a body of three points: its near end, the hand, and the point where the
rod of the second leg ends.  So it is a plane vector, from the near end to the hand, and the third
point is this vector turned and stretched by constants.  The same turn and stretch take the rod of
the second leg to a vector that ends at the hand.  So the hand is where two circles meet, as if both
rods ended there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.circles import two_circles
from closedform.lemmas.legs import Crank, Leg, Slide, Stretch, vector
from closedform.lemmas.missed import MOVED, SHARE, lost
from closedform.loops.conditioning import conditioning
from closedform.loops.hand import check_order, check_plain, in_space, square
from closedform.loops.leg_by_leg import (
    MISSED,
    SIGN,
    Choice,
    LegByLeg,
    named_in,
    record_lemma,
    size_of,
)
from closedform.loops.letters import letters
from closedform.loops.modes import NO_MODE, export
from closedform.loops.parallel import NEAR
from closedform.mechanics.loops import velocity_matrices
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, branches, real
from closedform.model.inverse import Inverse
from closedform.model.step import Step

POLE = "rods in line"
MEET = "the second rod points to the near end of the first"


def on_rod(
    d: Derivation,
    hand: Sequence[sp.Symbol],
    first: Crank | Slide,
    second: Crank | Slide | Stretch,
    at: Sequence[Any],
    *,
    modes: Choice = SIGN,
) -> None:
    """Derive and export a mechanism in a plane whose hand is a point of the rod of a leg.

    Parameters
    ----------
    d
        the derivation, with its parameters and two joints, in the order of the legs
    hand
        the two coordinates of the hand, the symbols of the task
    first
        the leg whose rod has the hand at its far end
    second
        the other leg; its rod ends on that of the first
    at
        where it ends there: how far from the near end of the first rod, along this rod towards the
        hand, and how far to its left
    modes
        the names of the assembly modes, by the sign of the determinant of ``jacobian_parallel``
    """
    mechanism = OnRod(d, sp.Matrix(hand), first, second, vector(at))
    d.singularities, d.poles = ("leg 1", "leg 2", POLE), (POLE,)
    mechanism.d.loop = loop = _state_loop(mechanism)
    posture = _forward(mechanism, modes, loop)
    _draw(mechanism, posture)
    _velocity(mechanism, posture, loop)
    _inverse(mechanism, loop)


@dataclass(frozen=True)
class OnRod:
    """Two legs in a plane, the second of which ends on the rod of the first."""

    d: Derivation
    hand: sp.Matrix
    first: Crank | Slide
    second: Crank | Slide | Stretch
    at: sp.Matrix

    def __post_init__(self) -> None:
        name = self.d.name
        if not (len(self.hand) == len(self.first.base) == len(self.second.base) == 2):
            raise ShapeError(
                f"{name}: a hand on a rod is solved in a plane only, so its vectors need 2 entries"
            )
        if len(self.at) != 2 or not any(self.at):
            raise ShapeError(
                f"{name}: at must be the two coordinates on the first rod "
                f"where the second ends, not both 0"
            )
        if isinstance(self.first, Stretch):
            raise ShapeError(f"{name}: the first leg needs a rod of constant length")
        check_plain(self.d, self.legs)
        check_order(self.d, self.legs)
        if any(leg.on_hand for leg in self.legs):
            raise ShapeError(f"{name}: the rods end on each other, so no leg has on_hand")

    @property
    def legs(self) -> tuple[Leg, Leg]:
        return cast("Leg", self.first), cast("Leg", self.second)

    @cached_property
    def length(self) -> sp.Expr:
        """The length of the first rod, from its near end to the hand."""
        return sp.sympify(self.first.rod, strict=True)

    @cached_property
    def rod(self) -> sp.Expr:
        """The length of the second rod."""
        return sp.sympify(self.second.rod, strict=True)

    @cached_property
    def square(self) -> sp.Expr:
        """The squared distance of the end of the second rod from the near end of the first."""
        return sp.factor(square(self.at))

    @cached_property
    def to_point(self) -> sp.Matrix:
        """The turn and stretch from the first rod to the place on it where the second rod ends."""
        u, v = self.at
        return sp.Matrix([[u, -v], [v, u]]) / self.length

    @cached_property
    def to_hand(self) -> sp.Matrix:
        """The inverse turn and stretch."""
        u, v = self.at
        return sp.Matrix([[u, v], [-v, u]]) * self.length / self.square

    @cached_property
    def stretch(self) -> sp.Expr:
        """By how much it stretches."""
        return self.length / sp.sqrt(self.square)

    @cached_property
    def centres(self) -> tuple[sp.Matrix, sp.Matrix]:
        """The centres of the two circles on which the hand is."""
        near, other = self.first.end(), self.second.end()
        return near, near + self.to_hand * (other - near)

    def end(self, near: sp.Matrix, hand: sp.Matrix) -> sp.Matrix:
        """Where the second rod ends, if the first leads from its near end to the hand."""
        return near + self.to_point * (hand - near)

    @cached_property
    def loop(self) -> tuple[sp.Expr, sp.Expr]:
        """Each rod keeps its length."""
        near, other = self.first.end(), self.second.end()
        return (
            square(self.hand - near) - self.length**2,
            square(self.end(near, self.hand) - other) - self.rod**2,
        )

    @property
    def letter(self) -> str:
        """That of the end of the second rod on the first."""
        return letters(self.d, "c")[0]

    @property
    def moved(self) -> list[sp.Symbol]:
        return [leg.joint for leg in self.legs if isinstance(leg, Slide)]


def _state_loop(m: OnRod) -> Step:
    shown = {
        r"\mathbf b_1": m.first.end(),
        r"\mathbf b_2": m.second.end(),
        r"|\mathbf p - \mathbf b_1|": m.length,
        rf"|\mathbf {m.letter} - \mathbf b_2|": m.rod,
    }
    m.d.explain(
        {
            r"\mathbf b_1": "near end of the first rod",
            r"\mathbf b_2": "near end of the second rod",
            rf"\mathbf {m.letter}": "end of the second rod on the first",
        }
    )
    return m.d.step(
        "The loop",
        "The joints determine the near ends of the rods, b1 and b2.  The first rod leads from b1 "
        f"to the hand p, and the second from b2 to the point {m.letter} of the first.  Both keep "
        "their lengths.",
        shown,
    )


@dataclass(frozen=True)
class _Posture:
    """The hand in an assembly mode, in the names of a program."""

    program: Program
    modes: Branches
    near: tuple[sp.Matrix, sp.Matrix]
    """The near ends of the rods."""
    spans: tuple[sp.Matrix, sp.Matrix]
    """The vectors from the centres of the circles to the hand."""
    side: sp.Expr
    size: sp.Expr
    """The sign and the size of the determinant of A, which has these as rows."""

    @property
    def hand(self) -> sp.Matrix:
        return self.near[0] + self.spans[0]


def _forward(m: OnRod, choice: Choice, loop: Step) -> _Posture:
    d, f, sigma = m.d, m.d.program(), real("sigma_assembly")
    modes = branches((sigma, choice))
    d.assembly_modes = modes.labels
    stretched = [leg.joint for leg in m.legs if isinstance(leg, Stretch)]
    size = f.let("size", size_of(d, m.legs, m.moved) + sp.Add(*stretched))
    near = [
        sp.Matrix([named_in(f, f"b{k}_{i}", e) for i, e in zip("xy", leg.end(), strict=True)])
        for k, leg in enumerate(m.legs, 1)
    ]
    far = near[0] + m.to_hand * (near[1] - near[0])
    centre = sp.Matrix([f.let(f"c2_{i}", e) for i, e in zip("xy", far, strict=True)])
    radii = [f.let("r_1", m.length, nonnegative=True), f.let("r_2", m.rod * m.stretch)]
    share = SHARE if len(m.moved) + len(stretched) == 0 else MOVED
    # a hand that misses its circle by this much misses the rod by no more
    scale = f.let("scale", size * sp.Min(1, m.stretch))
    found = two_circles(
        f, (near[0], centre), radii, tuple(m.hand), sigma, scale=scale, share=share, free=m.hand
    )
    first, second = m.centres
    d.step(
        "Forward: two circles",
        f"The point {m.letter} is seen from b1 as p is, turned and stretched by constants.  The "
        f"inverse turn and stretch take the rod from b2 to {m.letter} to a vector from b3 to p, so "
        "that the hand is on a circle about b3.  It meets the circle about b1 twice: these are the "
        "two assembly modes.",
        {r"\mathbf b_3": second, r"|\mathbf p - \mathbf b_3|": m.rod * m.stretch},
        proves="The squared distance of the hand from b3 is that of c from b2, times a constant.",
        equal=[
            (square(m.hand - second), m.stretch**2 * (m.loop[1] + m.rod**2)),
            (found.rows.det(), found.volume),
        ],
        uses=[loop],
    )
    d.explain({r"\mathbf b_3": "centre of the second circle of the hand"})
    d.function(
        "fk",
        "Position of the hand in both assembly modes.",
        {"q": d.actuated},
        {"p": [found.lemma[x] for x in m.hand]},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            "UNREACHABLE: the rods do not meet.",
            "SINGULAR: both circles are the same, and the hand is free; one point is returned.",
            NEAR,
        ),
    )
    equations = (
        square(m.hand - first) - m.length**2,
        square(m.hand - second) - (m.rod * m.stretch) ** 2,
    )
    d.inverses.append(
        Inverse("fk", tuple(m.hand), (sp.S.Zero,) * 2, equations, links=(found.link,))
    )
    record_lemma(d, "fk", found.link)
    v = Program(list(f.body), f.taken)
    span = sp.Matrix([v.let(f"A_1{i}", e) for i, e in enumerate(found.first, 1)])
    other = sp.Matrix([v.let(f"A_2{i}", e) for i, e in enumerate(near[0] + span - centre, 1)])
    return _Posture(v, modes, (near[0], near[1]), (span, other), side=found.side, size=found.size)


def _draw(m: OnRod, at: _Posture) -> None:
    first, second = m.loop
    distance, ahead = sp.sqrt(m.square), m.at - sp.Matrix([m.length, 0])
    share = m.square / m.length**2
    lengths: dict[tuple[str, str], sp.Expr] = {("B1", "P"): m.length, ("B1", "C"): distance}
    closing: dict[tuple[str, str], sp.Expr] = {("B1", "P"): first, ("B1", "C"): share * first}
    links: dict[str, tuple[str, ...]] = {"ground": ("A1", "A2")}
    if any(ahead):
        lengths["C", "P"] = sp.sqrt(sp.factor(square(ahead)))
        closing["C", "P"] = sp.factor(square(ahead)) / m.length**2 * first
        links["rod1"] = ("B1", "C", "P")
    else:
        links["rod1"] = ("B1", "P")
    joints: dict[sp.Symbol, tuple[str, ...]] = {}
    for k, leg in enumerate(m.legs, 1):
        near = f"A{k}" if isinstance(leg, Stretch) else f"B{k}"
        if isinstance(leg, Crank):
            links[f"crank{k}"] = (f"A{k}", near)
            joints[leg.joint] = (f"A{k}",)
            lengths[f"A{k}", near] = sp.sympify(leg.length, strict=True)
        else:
            ends = (near, "C") if isinstance(leg, Stretch) else (f"A{k}", near)
            joints[leg.joint], lengths[ends] = ends, leg.joint
        if k == 2:
            lengths[near, "C"], closing[near, "C"] = m.rod, second
            if not isinstance(leg, Stretch):
                links["rod2"] = (near, "C")
    skeleton(
        m.d,
        _points(m, at.near, at.hand),
        links=links,
        joints=joints,
        hand="P",
        hand_at=in_space(m.hand),
        ground=("A1", "A2"),
        lengths=lengths,
        program=at.program,
        branches=at.modes,
        notes=(NO_MODE,),
        at_posture=[_points(m, (m.first.end(), m.second.end()), m.hand)],
        closing=closing,
    )


def _points(
    m: OnRod, near: tuple[sp.Matrix, sp.Matrix], hand: sp.Matrix
) -> dict[str, list[sp.Expr]]:
    points = {f"A{k}": leg.base for k, leg in enumerate(m.legs, 1)}
    points |= {f"B{k}": end for k, end in enumerate(near, 1)}
    if isinstance(m.second, Stretch):
        del points["B2"]
    points |= {"C": m.end(near[0], hand), "P": hand}
    return {name: in_space(at) for name, at in points.items()}


def _rates(m: OnRod, spans: Sequence[sp.Matrix]) -> sp.Matrix:
    """B of A*dp = B*dq, if A has the spans as rows."""
    near, other = spans
    moved = (sp.eye(2) - m.to_hand) * m.first.rate
    driven = (
        m.stretch**2 * m.second.joint
        if isinstance(m.second, Stretch)
        else other.dot(m.to_hand * m.second.rate)
    )
    return sp.Matrix([[near.dot(m.first.rate), 0], [other.dot(moved), driven]])


def _velocity(m: OnRod, at: _Posture, loop: Step) -> None:
    d, v = m.d, Program(list(at.program.body), at.program.taken)
    first, second = m.centres
    spans = (m.hand - first, m.hand - second)
    circles = [square(s) for s in spans]
    circles[1] -= (m.rod * m.stretch) ** 2
    A, B = velocity_matrices(circles, tuple(m.hand), d.actuated)
    rates = _rates(m, spans)
    a = sp.Matrix(2, 2, lambda i, j: real(f"a{i + 1}{j + 1}"))
    d.step(
        "Velocity and singular sets",
        "The derivatives of the equations of both circles, halved, give A*dp = B*dq.  The rows of "
        "A are the vectors from the centres of the circles to the hand.  B is lower triangular, "
        f"because the first leg also moves the point {m.letter}.  B is singular if a joint moves "
        "the near end of its rod at right angles to it (serial).  A is singular if both centres "
        f"are in line with the hand, which is where {MEET} (parallel).",
        {
            "A": sp.Matrix.vstack(*(s.T for s in spans)),
            "B": rates,
            "J": "A^{-1} B",
            r"\Delta": r"\left|\det A\right|",
            r"\det J": r"\frac{\det B}{\det A}",
            r"\kappa": r"\lVert A\rVert_2\,\lVert A^{-1}\rVert_2",
        },
        proves="A and B are half of the derivatives, and the adjugate of A gives J with A*J = B.",
        equal=[
            (A, 2 * sp.Matrix.vstack(*(s.T for s in spans))),
            (B, 2 * rates),
            (a * a.adjugate(), a.det() * sp.eye(2)),
        ],
        uses=[loop],
    )
    d.explain(
        {
            "J": "derivative of p with respect to q",
            r"\Delta": "the determinant of A without its sign",
            r"\kappa": "condition number of A",
        }
    )
    found = _rates(m, at.spans)
    B_at = sp.Matrix(2, 2, [e if e == 0 else v.let(f"B_{n // 2 + 1}{n % 2 + 1}", e)
                            for n, e in enumerate(found)])  # fmt: skip
    size = v.let("Delta", at.size, nonnegative=True)
    volume = at.side * size
    A_at = sp.Matrix.vstack(*(s.T for s in at.spans))
    pole = "Not finite at a parallel singularity."
    export(
        d,
        v,
        at.modes,
        [
            ("jacobian_parallel", "A of A*dp = B*dq.", {"A": A_at}, ()),
            ("jacobian_serial", "B of A*dp = B*dq, which is lower triangular.", {"B": B_at}, ()),
            (
                "jacobian",
                "Derivative of p with respect to q: A^-1*B.",
                {"J": A_at.adjugate() * B_at / volume},
                (pole,),
            ),
            (
                "determinant",
                "Determinant of the Jacobian.",
                {"det": B_at[0, 0] * B_at[1, 1] / volume},
                (pole,),
            ),
            (
                "singularities",
                "The diagonal of B (serial) and the determinant of A (parallel).",
                {"factors": [B_at[0, 0], B_at[1, 1], volume]},
                (),
            ),
            ("condition_number", *conditioning(v, at.spans, size)),
        ],
    )


def _inverse(m: OnRod, loop: Step) -> None:
    d, g = m.d, m.d.program()
    moved = tuple(m.hand) if m.moved else ()
    solved = LegByLeg(d, g, g.let("size", size_of(d, m.legs, moved)))
    _, second = m.legs
    first = m.first.named(solved.naming(1)) if isinstance(m.first, Crank) else m.first
    leg = cast("Leg", first)
    solved.solve(1, leg, m.hand - first.base)
    span = solved.found[0].rod
    start = len(g.body)
    named = sp.Matrix([g.let(f"A_1{i}", e) for i, e in enumerate(span, 1)])
    link = solved.found[0].link
    meant = dict(zip(named, m.hand - first.end(), strict=True))
    own = replace(link, body=(*link.body, *g.body[start:]), means=meant)
    solved.found[0] = replace(solved.found[0], link=own, rod=named)
    near, size = m.hand - named, solved.size
    # where the first leg is nearly tangent, rounding moves the end of the second one far
    rate = first.rate_at(near)
    arm = solved.lengths((leg,)) * (first.length if isinstance(first, Crank) else 1)
    tangent = g.let("tangent", sp.Abs(named.dot(rate)), nonnegative=True)
    solved.share = g.let("may_miss", sp.Max(1, lost(arm, tangent)) / 2, nonnegative=True)
    solved.solve(2, second, m.end(near, m.hand) - second.base)
    other = m.to_hand * solved.found[1].rod
    volume = g.let("Delta", named[0] * other[1] - named[1] * other[0])
    # a hand that is farther from b1 than c moves more than c when it is moved by rounding
    scale = solved.lengths(m.legs) * m.stretch * sp.Max(1, m.stretch)
    missed = solved.missed * m.stretch
    g.determined(sp.Abs(volume), scale, MEET, name=r"|\det A|", missed=missed, size=size)
    d.step(
        "Inverse: one leg after the other",
        f"The first leg has to reach the hand with its rod.  Then the point {m.letter} is known, "
        "and the second leg has to reach it with its own rod.  "
        f"{solved.on_modes}Near a parallel singularity rounded joints do not determine the hand.  "
        "The status is SINGULAR if the determinant of A is less than 2^-10 of the product of the "
        "radii of both circles, or of a multiple of it if the hand is farther from b1 than c: as "
        f"many times as it is farther.  {MISSED}",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    solved.export(
        {"x": tuple(m.hand)},
        {"p": tuple(m.hand)},
        "UNREACHABLE: a rod does not reach.",
        [f"SINGULAR also near a parallel singularity, where {MEET}."],
    )
    solved.certify(m.loop, images="fk")


__all__ = ["on_rod"]
