"""A hand that legs carry: all that follows from the list of its legs.

:func:`parallel` is for a hand that does not turn, a point or a platform: two legs in a plane, three
in space.  It exports the forward map with all assembly modes, the inverse with all working modes,
the velocity, the singular sets, the workspace and the skeleton, and records the steps that prove
them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import sympy as sp

from closedform.lemmas.circles import two_circles
from closedform.lemmas.legs import Crank, Leg, Slide, Stretch, Strut
from closedform.lemmas.missed import MOVED, SHARE
from closedform.lemmas.planes import Flat, three_planes
from closedform.lemmas.rails import rail_and_circle, two_rails
from closedform.lemmas.spheres import Meeting, three_spheres
from closedform.loops.conditioning import conditioning
from closedform.loops.hand import Hand
from closedform.loops.held import check_held, constraint, left_out, state_held
from closedform.loops.leg_by_leg import (
    MISSED,
    SIGN,
    Choice,
    LegByLeg,
    known_sides,
    named_in,
    record_lemma,
    signs_of_modes,
    size_of,
)
from closedform.loops.letters import bold
from closedform.loops.modes import NO_MODE, Exported, export
from closedform.loops.skeleton import draw
from closedform.mechanics.frames import merge_angles
from closedform.mechanics.loops import velocity_matrices
from closedform.model.derivation import Derivation
from closedform.model.functions import (
    SINGLE,
    Branches,
    Program,
    branches,
    real,
)
from closedform.model.inverse import Inverse, Link
from closedform.model.step import Step

AXES = "xyz"


def parallel(
    d: Derivation,
    hand: Sequence[sp.Symbol],
    legs: Sequence[Leg],
    modes: Choice = SIGN,
    *,
    passive: Sequence[sp.Symbol] = (),
) -> None:
    """Derive and export a mechanism whose hand does not turn and is carried by legs.

    Parameters
    ----------
    d
        the derivation, with its parameters and joints; the legs are in the order of the joints.
        If it has no ``singularities``, they are named after the legs
    hand
        the coordinates of the hand, the symbols of the task: two in a plane, three in space
    legs
        as many as there are coordinates, see :mod:`closedform.lemmas.legs`.  In space the first may
        be a :class:`~closedform.lemmas.legs.Strut`; then the hand moves on a sphere
    modes
        the names of the assembly modes, by the sign of the determinant of ``jacobian_parallel``
    passive
        the angles of the rods from the x axis, for a mechanism in a plane; with them
        ``passive_angles`` is exported
    """
    mechanism = Hand(d, sp.Matrix(hand), tuple(legs))
    check_held(mechanism)
    if not d.singularities:
        d.singularities = (*(f"leg {k}" for k, _ in mechanism.driven), mechanism.pole)
        d.poles = (mechanism.pole,)
    mechanism.d.loop = loop = mechanism.state_loop()
    state_held(mechanism, loop)
    posture = _forward(mechanism, modes, loop, passive)
    if passive:
        _passive_angles(mechanism, posture, passive)
    draw(mechanism, posture.hand, posture.program, posture.modes, passive)
    _velocity(mechanism, posture, loop)
    _inverse(mechanism, loop)


@dataclass(frozen=True)
class _Posture:
    """The hand in an assembly mode, in the names of the program of ``fk``."""

    program: Program
    modes: Branches
    hand: sp.Matrix
    rods: tuple[sp.Matrix, ...]
    """The vectors along the rods, from their near ends to their far ends."""
    side: sp.Expr
    size: sp.Expr
    """The sign and the size of the determinant of the matrix that has them as rows."""


def _forward(m: Hand, choice: Choice, loop: Step, passive: Sequence[sp.Symbol]) -> _Posture:
    d, n, f = m.d, len(m.legs), m.d.program()
    sigma = real("sigma_assembly")
    modes = branches((sigma, choice)) if len(m.flat) < n else SINGLE
    d.assembly_modes = modes.labels
    stretched = [leg.joint for leg in m.legs if isinstance(leg, Stretch)]
    slid = [leg.joint for leg in m.legs if isinstance(leg, Slide | Flat)]
    # the size has to be positive where a leg has a negative length, which does not reach a rail
    stretched = [sp.Abs(q) if m.flat else q for q in stretched]
    size = f.let("size", size_of(d, m.legs, slid) + sp.Add(*stretched))
    ends = [
        sp.Matrix([named_in(f, f"c{k}_{i}", e) for i, e in zip(AXES, c, strict=False)])
        for (k, _), c in zip(m.numbered, m.centres, strict=True)
    ]
    near = m.in_lemma(ends)
    met = (_on_lines if m.flat else _on_rods)(m, f, near, size, sigma)
    found = met.found
    d.step(
        f"Forward: {met.title}",
        met.reason + "  The passive angles are those of the rods." * bool(passive),
        met.shown | _shown_angles(m, passive),
        proves=met.proves,
        equal=[(found.rows.det(), found.volume)],
        uses=[loop],
        solves={"fk": ()},
    )
    d.function(
        "fk",
        f"Position of the hand in {'both assembly modes' if len(modes) > 1 else 'its only mode'}.",
        {"q": m.joints},
        {"p": [found.lemma[x] for x in m.hand]},
        program=f,
        branches=modes,
        result="Positions",
        notes=(*met.notes, *left_out(m)),
    )
    equations = tuple(m.in_lemma(m.loop))
    d.inverses.append(
        Inverse("fk", tuple(m.hand), (sp.S.Zero,) * n, equations, links=(found.link,))
    )
    record_lemma(d, "fk", met.link)
    v = Program(list(f.body), f.taken)
    (first, _), *_ = m.in_lemma(m.numbered)
    name = f"span_{first}" if m.flat else f"A_{first}"
    rod = sp.Matrix([v.let(f"{name}{i}", e) for i, e in enumerate(found.first, 1)])
    return _Posture(
        program=v,
        modes=modes,
        hand=near[0] + rod,
        rods=tuple(rod + near[0] - end for end in ends),
        side=found.side,
        size=found.size,
    )


class _Meeting(NamedTuple):
    """The hand where legs meet, and what the article and the docstring say of it."""

    found: Meeting
    link: Link
    title: str
    reason: str
    shown: dict[str, Any]
    proves: str
    notes: tuple[str, ...]


NEAR = "Ill-conditioned near the parallel singularities, where both modes meet."


def _on_rods(
    m: Hand, f: Program, near: Sequence[sp.Matrix], size: sp.Expr, sigma: sp.Symbol
) -> _Meeting:
    n = len(m.legs)
    radii = _radii(m, f, size)
    meet = two_circles if n == 2 else three_spheres
    still = all(isinstance(leg, Crank | Strut) for leg in m.legs)
    hand, share = tuple(m.hand), SHARE if still else MOVED
    found = meet(f, near, m.in_lemma(radii), hand, sigma, scale=size, share=share, free=hand)
    ((first, _), start), *others = m.in_lemma(list(zip(m.numbered, m.centres, strict=True)))
    shape = "circles" if n == 2 else "spheres"
    return _Meeting(
        found=found,
        link=replace(
            found.link,
            lemma=replace(
                found.lemma,
                roles=_roles(m),
                written={
                    **found.lemma.written,
                    **{f"c{k}": rf"\mathbf b_{k}" for k, _ in m.numbered},
                    "first": rf"\mathbf b_{first}",
                    "result": r"\mathbf p",
                },
                letters={**found.lemma.letters, **m.coordinates(near)},
            ),
        ),
        title=f"{m.count} {shape}",
        reason=f"The hand is where {m.count} {shape} about the points b_i meet, whose radii are "
        f"the lengths of the rods.  They meet twice, on both sides of the "
        f"{'line' if n == 2 else 'plane'} of their centres: these are the two assembly modes.  The "
        f"determinant of the vectors along the rods has the sign of the mode.",
        shown={}
        if m.alike  # the points of all legs are the same formula
        else {
            rf"\mathbf b_{k} - \mathbf b_{first}": (c - start).applyfunc(merge_angles)
            for (k, _), c in others
        },
        proves="The determinant of the vectors along the rods, in the frame of the lemma, is the "
        "sign of the mode times a product of lengths.",
        notes=(
            "UNREACHABLE: the rods do not meet.",
            f"SINGULAR: centres coincide{' or are in line' if n == 3 else ''}, and the hand is "
            "free on a circle; one of its points is returned.",
            NEAR,
        ),
    )


def _radii(m: Hand, f: Program, size: sp.Expr) -> list[sp.Symbol]:
    """The lengths of the rods; numbers that differ have names, because the lemma equates them.

    Circles meet only if their radii are not negative; of spheres, which meet by the squares of
    their radii, this is asked here.
    """
    rods = {k: sp.sympify(leg.rod, strict=True) for k, leg in m.numbered}
    same, found = len({*rods.values()}) == 1, []
    for (k, rod), leg in zip(rods.items(), m.legs, strict=True):
        if len(m.legs) == 3 and isinstance(leg, Stretch):
            found.append(f.bound(f"r_{k}", rod, size, "a leg has a positive length"))
        elif rod.is_Symbol or (rod.is_number and same):
            found.append(rod)
        else:
            found.append(f.let(f"r_{k}", rod))
    return found


def _on_lines(
    m: Hand, f: Program, near: Sequence[sp.Matrix], size: sp.Expr, sigma: sp.Symbol
) -> _Meeting:
    notes: tuple[str, ...] = ()
    if m.planes:
        found, title = three_planes(f, near, m.planes, m.hand, scale=size), "three planes"
        reason = "The hand is where the planes of the three legs meet."
        notes = ("UNREACHABLE: the bars of a leg do not reach.",)
    elif len(m.rails) == 2:
        found, title = two_rails(f, near, m.rails, m.hand), "two lines"
        reason = "The hand is where the two rails meet."
    else:
        found = rail_and_circle(f, near, m.legs, m.hand, sigma, scale=size)
        title, notes = "line and circle", ("UNREACHABLE: the rod does not reach the rail.", NEAR)
        reason = (
            "The hand is where the rail meets a circle about the near end of the rod.  They meet "
            "twice, on both sides of the normal to the rail through this point: these are the two "
            "assembly modes.  The determinant of A has the sign of the mode."
        )
    proves = (
        "The determinant of the rows of A, in the frame of the rail, is the sign of the mode times "
        "a length; of two rails, it is a number."
    )
    if m.planes:
        proves = "The determinant of the rows of A, the normals of the planes, is this number."
    return _Meeting(
        found=found,
        link=found.link,
        title=title,
        reason=reason,
        shown={},
        proves=proves,
        notes=notes,
    )


def _roles(m: Hand) -> tuple[tuple[str, Any], ...]:
    """What the letters of the lemma stand for that gives the hand."""
    (first, _), *others = m.in_lemma(m.numbered)
    between = [rf"\mathbf b_{k} - \mathbf b_{first}" for k, _ in others]
    names = [r"d\,\mathbf n"] if len(others) == 1 else [r"\mathbf a", r"\mathbf c_3"]
    return (
        (r"\mathbf x", rf"\mathbf p - \mathbf b_{first}"),
        *zip(names, between, strict=True),
        *(
            (f"r_{k}", sp.sympify(leg.rod, strict=True))
            for k, leg in enumerate(m.in_lemma(m.legs), 1)
        ),
    )


def _of_passive(passive: Sequence[sp.Symbol]) -> str:
    """What stands on the left of the equation of the passive angles."""
    return f"({', '.join(map(sp.latex, passive))})"


def _shown_angles(m: Hand, passive: Sequence[sp.Symbol]) -> dict[str, Any]:
    """The angles of the rods, from the hand and their near ends."""
    rods = [m.hand - c for c in m.centres]
    angles = tuple(sp.atan2(rod[1], rod[0], evaluate=False) for rod in rods[: len(passive)])
    return {_of_passive(passive): angles} if passive else {}


def _passive_angles(m: Hand, at: _Posture, passive: Sequence[sp.Symbol]) -> None:
    m.d.function(
        "passive_angles",
        "Angles of the rods from the x axis in both assembly modes.",
        {"q": m.joints},
        {"theta": [sp.atan2(rod[1], rod[0]) for rod in at.rods]},
        program=at.program,
        branches=at.modes,
        entries=tuple(passive),
        notes=(NO_MODE,),
        equation=_of_passive(passive),
    )


def _velocity(m: Hand, at: _Posture, loop: Step) -> None:
    d, n = m.d, len(m.legs)
    A, B = velocity_matrices(m.loop, tuple(m.hand), m.joints)
    spans = [m.hand - c for c in m.centres]
    rods = m.rows(spans)
    # a crank moves its end at right angles to itself, so what leads to its pivot counts as well
    rates = m.rates(
        [
            span + leg.end() - leg.base if isinstance(leg, Crank) else rod
            for leg, span, rod in zip(m.legs, spans, rods, strict=True)
        ]
    )
    halves = [1 if isinstance(leg, Flat) else 2 for leg in m.legs]
    labels = [k for k, _ in m.driven]
    still = sp.zeros(n - len(rates), len(rates))
    strut = "  A strut has no joint, so its row of B is zero." * still.rows
    halved, vectors, half = ", halved,", "vectors along the rods", "half of the derivatives"
    if m.planes:
        halved, half, vectors = "", "the derivatives", "normals of the planes"
    if m.rails:
        halved, half = ", those of rods halved,", "the derivatives, of a rod half of them"
        vectors += " and the normals of the rails"
    a = sp.Matrix(n, n, lambda i, j: real(f"a{i + 1}{j + 1}"))
    adjugate = a.adjugate()
    d.step(
        "Velocity and singular sets",
        f"The derivatives of the loop equations{halved} give A*dp = B*dq.  The "
        f"rows of A are the {vectors}.  B is diagonal, because each "
        "leg depends on its own joint alone.  "
        "B is singular if the joint moves the near end of a rod at right angles to it (serial: "
        f"the joint moves and the hand stands still).  A is singular if {m.meet} (parallel: the "
        f"hand can move while the joints stand still).{strut}",
        {**_shown_velocity(m, rods, rates), **_shown_jacobian(m)},
        proves=f"A and B are {half}, and the adjugate of A gives J with A*J = B.",
        equal=[
            (A, sp.diag(*halves) * sp.Matrix.vstack(*(r.T for r in rods))),
            (B, sp.diag(*halves) * still.col_join(sp.diag(*rates))),
            (a * adjugate, a.det() * sp.eye(n)),
        ],
        uses=[loop],
    )
    v = Program(list(at.program.body), at.program.taken)
    placed = {
        e: named_in(v, f"A_{k}{i}", value)
        for (k, _), row, rod in zip(m.numbered, a.tolist(), m.rows(at.rods), strict=True)
        for i, (e, value) in enumerate(zip(row, rod, strict=True), 1)
    }
    along = [sp.Matrix([placed[e] for e in row]) for row in a.tolist()]
    turned = m.rates(along)
    driven = [v.let(f"B_{k}{k}", e) for k, e in zip(labels, turned, strict=True)]
    size = at.size if at.size.is_number else v.let("Delta", at.size, nonnegative=True)
    side = at.side * size
    J = adjugate.xreplace(placed) * still.col_join(sp.diag(*driven)) / side
    A_at = a.xreplace(placed)
    pole = "Not finite at a parallel singularity."
    functions: list[Exported] = [
        (
            "jacobian_parallel",
            f"A of A*dp = B*dq; its rows are the {vectors}.",
            {"A": A_at},
            (),
        ),
        (
            "jacobian_serial",
            "The diagonal of B of A*dp = B*dq.",
            {"B": driven},
            signs_of_modes([leg for _, leg in m.driven]),
        ),
        ("jacobian", "Derivative of p with respect to q: A^-1*B.", {"J": J}, (pole,)),
    ]
    if not still:
        det = sp.Mul(*driven) / side
        functions.append(("determinant", "Determinant of the Jacobian.", {"det": det}, (pole,)))
    functions += [
        (
            "singularities",
            "The diagonal of B (serial) and the determinant of A (parallel).",
            {"factors": [*driven, side]},
            (),
        ),
    ]
    if not m.flat:  # a normal is a unit vector, and a rod has a length
        functions.append(("condition_number", *conditioning(v, along, size, on_sphere=bool(still))))
    functions += constraint(m, along)
    export(d, v, at.modes, functions)


def _shown_velocity(m: Hand, rods: Sequence[sp.Matrix], rates: Sequence[sp.Expr]) -> dict[str, Any]:
    """A and the diagonal of B; of alike legs, by the row of A and the entry of B of leg i."""
    numbers = [k for k, _ in m.driven]
    if not m.alike:
        diagonal = {
            f"B_{{{k}{k}}}": _by_joint(leg.joint, e)
            for (k, leg), e in zip(m.driven, rates, strict=True)
        }
        m.d.explain(dict.fromkeys(diagonal, "entry of the diagonal of B"))
        if len(m.legs) == 2 or m.flat:
            return {"A": sp.Matrix.vstack(*(r.T for r in rods)), **diagonal}
        ends = " & ".join(rf"\mathbf p - \mathbf b_{k}" for k, _ in m.numbered)
        return {"A": rf"\begin{{bmatrix}} {ends} \end{{bmatrix}}^T", **diagonal}
    [(i, leg)] = m.as_shown(m.driven)
    vectors = {
        rf"\mathbf a_{i}": rf"\mathbf p - \mathbf b_{i}",
        rf"\mathbf t_{i}": leg.rate,
    }
    meanings = ("vector along the rod of a leg", "derivative of b with respect to the joint")
    entry = f"B_{{{i}{i}}}"
    m.d.explain({**dict(zip(vectors, meanings, strict=True)), entry: "entry of the diagonal of B"})
    rows = " & ".join(rf"\mathbf a_{k}" for k in numbers)
    return {
        "A": rf"\begin{{bmatrix}} {rows} \end{{bmatrix}}^T",
        **vectors,
        entry: rf"\mathbf a_{i}\cdot\mathbf t_{i}",
    }


def _by_joint(joint: sp.Symbol, rate: sp.Expr) -> sp.Expr:
    """An entry of B by the sine and the cosine of its joint, with common factors in front."""
    turned = sp.collect(sp.expand(rate), [sp.sin(joint), sp.cos(joint)])
    return sp.factor_terms(turned)


def _shown_jacobian(m: Hand) -> dict[str, Any]:
    """What follows from A and B: the Jacobian, its determinant and the condition number of A."""
    numbers = [k for k, _ in m.driven]
    entries = [sp.Symbol(f"B_{k}{k}") for k in numbers]
    struts = len(m.legs) - len(entries)
    shown: dict[str, Any] = {
        "B": sp.zeros(struts, len(entries)).col_join(sp.diag(*entries)),
        "J": "A^{-1} B",
        r"\Delta": r"\left|\det A\right|",
    }
    m.d.explain({"A": "factor of the rate of the hand"})
    meanings = {"B": "factor of the joint rates", "J": "derivative of p with respect to q"}
    meanings |= {r"\Delta": "the determinant of A without its sign"}
    if not struts:
        shown[r"\det J"] = r"\frac{\det B}{\det A}"
    if struts:
        still = next(k for k, leg in m.numbered if isinstance(leg, Strut))
        rod = rf"\mathbf p - \mathbf b_{still}"
        (along,) = bold(m.d, "s")
        shown[along] = rf"\frac{{{rod}}}{{\left|{rod}\right|}}"
        shown["Q"] = rf"A \left(I - {along}\,{along}^T\right)"
        shown[r"\kappa"] = r"\frac{\varsigma_1}{\varsigma_2}"
        meanings[along] = "unit vector along the strut"
        meanings["Q"] = "rows of A without their part along the strut"
        meanings[r"\kappa"] = "condition number of Q, whose least singular value is zero"
        meanings[r"\varsigma_1"] = "largest singular value of Q"
        meanings[r"\varsigma_2"] = "second singular value of Q"
    elif not m.flat:
        norm = "F" if len(numbers) == 3 else "2"
        part = r"\tfrac{1}{3}\," if len(numbers) == 3 else ""
        shown[r"\kappa"] = rf"{part}\lVert A\rVert_{norm}\,\lVert A^{{-1}}\rVert_{norm}"
        meanings[r"\kappa"] = "condition number of A"
    m.d.explain(meanings)
    return shown


def _inverse(m: Hand, loop: Step) -> None:
    d, g = m.d, m.d.program()
    slides = any(isinstance(leg, Slide | Flat) for leg in m.legs)
    solved = LegByLeg(d, g, g.let("size", size_of(d, m.legs, tuple(m.hand) if slides else ())))
    straight: list[sp.Matrix] = []
    hand = m.hand
    for k, leg in m.numbered:
        w = hand + m.place(leg) - leg.base
        if isinstance(leg, Strut):
            straight.append(leg.onto(solved.naming(k), w))
            hand = straight[0] - m.place(leg) + leg.base
        else:
            solved.solve(k, leg, w)
    rows = solved.rows(straight, subtract=not m.flat)
    along = [
        sp.Matrix([named_in(g, f"A_{k}{i}", e) for i, e in enumerate(row, 1)])
        for (k, _), row in zip(m.numbered, rows, strict=True)
    ]
    # branches that differ in the first leg alone share the cross product
    first, *others = along
    across = others[0].cross(others[1]) if len(others) == 2 else None
    volume = g.let("Delta", first.dot(across) if across else sp.Matrix.hstack(*along).det())
    # lengths that are not part of the sum of all lengths, such as those of an arc, are rounded too
    given = [e for leg in m.legs for e in (leg.rod, getattr(leg, "length", sp.S.Zero))]
    links = [sp.sympify(e, strict=True) for e in given]
    beyond = sp.Add(*(e for e in links if not e.is_Atom)) / solved.size
    scale = solved.lengths(m.legs) * (1 + beyond)
    g.determined(
        sp.Abs(volume),
        scale,
        m.meet,
        name=r"|\det A|",
        missed=solved.missed,
        size=solved.size,
    )
    d.step(
        "Inverse: leg by leg",
        f"Each leg is solved alone.  {known_sides(m.legs)}{solved.on_modes}"
        "Rounded joints miss the lengths of the rods "
        "by a few units in the last place.  The error of the hand can be this error times the "
        "product of the lengths of the rods over the determinant of A.  So near a parallel "
        "singularity the joints do not determine the hand, however they are computed.  The "
        f"status is SINGULAR if the determinant is less than 2^-10 of the product.  {MISSED}",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    off_sphere = ", or the target is not on the sphere" * bool(straight)
    solved.export(
        {"x": tuple(m.hand)},
        {"p": tuple(m.hand)},
        f"UNREACHABLE: a rod does not reach{off_sphere}.",
        [
            f"SINGULAR also near a parallel singularity, where {m.meet}: the loop "
            "closes, but a unit in the last place of the joints moves the hand by more "
            f"than 1e-12 of the lengths.  {MISSED}",
            *left_out(m),
        ],
    )
    at = dict(zip(m.hand, m.onto_struts(), strict=True))
    ends = zip(m.legs, m.loop, strict=True)
    turning = [e.xreplace(at) for leg, e in ends if not isinstance(leg, Strut)]
    solved.certify(turning, images="fk")


__all__ = ["parallel"]
