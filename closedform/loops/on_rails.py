"""A hand that turns about one axis on rails or planes: two assembly modes, in closed form.

In a plane it is on three rails (3-PPR).  In space four legs of two bars with parallel axes keep it
in planes, as on a Quadrupteron.  The equations are linear in its position, which is eliminated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Leg, Naming, cross_in_plane, vector
from closedform.lemmas.missed import MOVED
from closedform.lemmas.planes import Flat, Plane, three_planes
from closedform.lemmas.rails import Rail, named_number
from closedform.loops.hand import check_order, in_space, square
from closedform.loops.leg_by_leg import SIGN, Choice, LegByLeg, named_in, record_lemma, size_of
from closedform.loops.modes import NO_MODE, export
from closedform.loops.skeleton import ANY, Drawing
from closedform.loops.yaw import yaw_by_amplitude
from closedform.mechanics.loops import velocity_matrices
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, branches, real
from closedform.model.inverse import Combination, Inverse, Link
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair
from closedform.model.step import Step

TASKS = {2: ("x", "y", "yaw"), 3: ("x", "y", "z", "yaw")}
"""By the number of dimensions."""
MEET = {
    2: "the rails do not hold the hand: the normals in their points pass through one point",
    3: "the planes do not hold the hand: it can turn and move at once",
}


@dataclass(frozen=True)
class OnRails:
    """A hand on three rails, or in four planes."""

    d: Derivation
    legs: tuple[Flat, ...]

    def __post_init__(self) -> None:
        name = self.d.name
        check_order(self.d, [leg for _, leg in self.driven])
        if list(self.d.task) not in ([], list(self.task)):
            raise ShapeError(f"{name}: the task of this hand must be {', '.join(self.task)}")
        self.d.task = list(self.task)
        if not any(self.weights):
            parallel = "three rails are parallel" if self.in_plane else "planes share a direction"
            raise ShapeError(f"{name}: the {parallel}, so the hand slides along them")
        if self.coefficients[0] == self.coefficients[1] == 0:
            raise ShapeError(
                f"{name}: the {self.flats} do not hold the hand anywhere; it turns freely"
            )

    @property
    def dimensions(self) -> int:
        return len(self.legs) - 1

    @property
    def in_plane(self) -> bool:
        return self.dimensions == 2

    @property
    def flats(self) -> str:
        return "rails" if self.in_plane else "planes"

    @property
    def task(self) -> tuple[str, ...]:
        return TASKS[self.dimensions]

    @property
    def meet(self) -> str:
        return MEET[self.dimensions]

    @cached_property
    def target(self) -> tuple[sp.Symbol, ...]:
        return tuple(map(real, self.task))

    @property
    def hand(self) -> sp.Matrix:
        return sp.Matrix(self.target[:-1])

    @property
    def yaw(self) -> sp.Symbol:
        return self.target[-1]

    @cached_property
    def places(self) -> list[sp.Matrix]:
        return [vector(leg.on_hand or (0,) * self.dimensions) for leg in self.legs]

    @property
    def planes(self) -> list[Plane]:
        return [leg for leg in self.legs if isinstance(leg, Plane)]

    @property
    def numbered(self) -> list[tuple[int, Flat]]:
        return [*enumerate(self.legs, 1)]

    @property
    def driven(self) -> list[tuple[int, Leg]]:
        """The same, as legs of any kind."""
        return [(k, cast("Leg", leg)) for k, leg in self.numbered]

    @cached_property
    def weights(self) -> tuple[sp.Expr, ...]:
        """Factors with which the normals of the legs add up to zero."""
        found = []
        for k, _ in enumerate(self.legs):
            others = [leg.normal for i, leg in enumerate(self.legs) if i != k]
            found.append(sp.simplify((-1) ** k * sp.Matrix.hstack(*others).det()))
        return tuple(found)

    @cached_property
    def order(self) -> tuple[int, ...]:
        """The legs that determine the position of a hand whose yaw is known, and the last one."""
        n = len(self.legs)
        last = next(k for k in (n - 1, *range(n - 1)) if self.weights[k] != 0)
        return tuple((last + 1 + i) % n for i in range(n))

    def arms(self, pair: Pair) -> list[sp.Matrix]:
        """The points in which the legs end, from the point that is the hand."""
        return [
            sp.Matrix([pair.c * x - pair.s * y, pair.s * x + pair.c * y, *up])
            for x, y, *up in self.places
        ]

    @property
    def turned(self) -> list[sp.Matrix]:
        return self.arms(Pair(sp.sin(self.yaw), sp.cos(self.yaw)))

    @cached_property
    def coefficients(self) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """a, b and c of the equation a sin(yaw) + b cos(yaw) = c, which has no position."""
        total = [sp.S.Zero] * 3
        for weight, leg, (x, y, *up) in zip(self.weights, self.legs, self.places, strict=True):
            none, above = [sp.S.Zero] * len(up), sp.Matrix([0, 0, *up])
            end = leg.end() - above if up else leg.end()
            turned = sp.Matrix([-y, x, *none]), sp.Matrix([x, y, *none]), end
            total = [t - weight * leg.normal.dot(v) for t, v in zip(total, turned, strict=True)]
        a, b, c = (sp.factor_terms(sp.expand(t)) for t in total)
        return a, b, c

    @cached_property
    def loop(self) -> tuple[sp.Expr, ...]:
        """The equations of the loop: the points of the hand are on the rails or in the planes."""
        ends = zip(self.legs, self.turned, strict=True)
        return tuple(leg.normal.dot(self.hand + arm - leg.end()) for leg, arm in ends)


def on_rails(d: Derivation, legs: Sequence[Flat], modes: Choice = SIGN) -> None:
    """Derive and export a hand that turns on three rails, or in four planes.

    Its task is x, y and yaw, or x, y, z and yaw.
    """
    m = OnRails(d, tuple(legs))
    if not d.singularities:
        d.singularities = d.poles = (m.flats,)
    said = (
        "The joint of leg i moves the rail, which passes through b and has the normal n.  The "
        "point e of the hand, in its frame, is on the rail: n is at right angles to p + R*e - b."
        if m.in_plane
        else "The joint of leg i moves b, from which two bars lead to the point e of the hand, in "
        "its frame.  Their axes have the direction n, so n is at right angles to p + R*e - b."
    )
    d.loop = loop = d.step(
        "The loop",
        said,
        {},
        rows=[
            ("i", "b", "n", "e"),
            *(
                (str(k), leg.end().T, leg.normal.T, place.T)
                for (k, leg), place in zip(m.numbered, m.places, strict=True)
            ),
        ],
    )
    if m.planes:
        _upright(m, loop)
    posture = _forward(m, modes, loop)
    _draw(m, posture)
    _velocity(m, posture, loop)
    _inverse(m, loop)


def _upright(m: OnRails, loop: Step) -> None:
    """The step on what keeps a hand upright in space."""
    normals = sp.Matrix.hstack(*(m.legs[k].normal for k in m.order[:-1])).T
    m.d.explain({r"\mathbf z": "direction of the z axis"})
    m.d.step(
        "The axes",
        "A leg turns the hand about the direction n of its bars, and about the axis z of the hand "
        "by a last joint, unless n is vertical.  The first turn keeps the part of z along n.  So "
        "the axis z of the hand, R*z, has the same parts along all n as z has.  Three of them are "
        "a basis, so R*z is z: the hand is upright, and turns about z alone.",
        {r"\mathbf n_i^T R\,\mathbf z": r"\mathbf n_i^T\mathbf z", r"R\,\mathbf z": r"\mathbf z"},
        proves="The directions of three legs are a basis.",
        equal=[(normals.adjugate() * normals, normals.det() * sp.eye(3))],
        uses=[loop],
    )


@dataclass(frozen=True)
class _Posture:
    """The hand in an assembly mode, in the names of the program of ``fk``."""

    program: Program
    modes: Branches
    hand: sp.Matrix
    arms: list[sp.Matrix]
    volume: sp.Expr
    """The determinant of A."""


def _forward(m: OnRails, choice: Choice, loop: Step) -> _Posture:
    d, f, sigma = m.d, m.d.program(), real("sigma_assembly")
    yaw, modes = m.yaw, branches((sigma, choice))
    d.assembly_modes = modes.labels
    size = f.let("size", size_of(d, m.legs, d.actuated))
    named = [named_in(f, n, e) for n, e in zip("abc", m.coefficients, strict=True)]
    turn, pair, root = yaw_by_amplitude(
        f,
        yaw,
        named,
        sigma,
        size,
        missed=lambda _: size / 4,
        said=f"the {m.flats} do not hold the hand",
    )
    arms = [
        sp.Matrix([named_in(f, f"e{k}_{i}", e) for i, e in zip("xyz", arm, strict=False)])
        for k, arm in enumerate(m.arms(pair), 1)
    ]
    link = (_where_rails_meet if m.in_plane else _where_planes_meet)(m, f, arms, size)
    assert link.lemma is not None
    hand = sp.Matrix([link.lemma[x] for x in m.hand])
    *others, k = m.order
    w, combined = m.weights, sp.zeros(len(m.order))
    for column, i in enumerate(others, 1):
        combined[i, column] = 1
    combined[k, :] = sp.Matrix([[-1, *(-w[i] for i in others)]]) / w[k]
    d.step(
        "Forward: two assembly modes",
        "The sum of the normals, each times a weight, is zero.  So the sum of the equations with "
        "these weights does not contain p.  It is a*sin(yaw) + b*cos(yaw) = c, and has two "
        "solutions: these are the assembly modes.  Then the hand is where "
        f"{'two of its rails' if m.in_plane else 'three of its planes'} meet.",
        dict(zip("abc", m.coefficients, strict=True)),
        proves="The weighted equations add up to that of the yaw.",
        equal=[
            (
                -sp.Add(*(w * e for w, e in zip(m.weights, m.loop, strict=True))),
                m.coefficients[0] * sp.sin(yaw)
                + m.coefficients[1] * sp.cos(yaw)
                - m.coefficients[2],
            )
        ],
        uses=[loop],
    )
    d.function(
        "fk",
        "Position and yaw of the hand in both assembly modes.",
        {"q": d.actuated},
        {"p": [*hand, sp.atan2(pair.s, pair.c)]},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            f"UNREACHABLE: the hand is too short for the {m.flats}"
            + ", or the bars of a leg do not reach" * bool(m.planes)
            + ".",
            "SINGULAR: the hand turns freely, and yaw = 0 is returned.",
            "Ill-conditioned near the parallel singularities, where both modes meet.",
        ),
    )
    d.inverses.append(
        Inverse(
            "fk",
            m.target,
            (sp.S.Zero,) * len(m.loop),
            m.loop,
            links=(turn, link),
            glue=Combination(combined, {u: u for u in m.target}),
        )
    )
    record_lemma(d, "fk", turn)
    record_lemma(d, "fk", link)
    v = Program(list(f.body), f.taken)
    at_hand = sp.Matrix([named_in(v, f"p_{i}", e) for i, e in zip("xyz", hand, strict=False)])
    return _Posture(v, modes, at_hand, arms, sigma * root)


def _where_planes_meet(m: OnRails, f: Program, arms: Sequence[sp.Matrix], size: sp.Expr) -> Link:
    """The hand in three of its planes; the bars of all legs have to reach."""
    *others, last = m.order
    ends = {
        k: sp.Matrix([named_in(f, f"c{k + 1}_{i}", e) for i, e in zip("xyz", v, strict=True)])
        for k, v in ((k, m.legs[k].end() - arms[k]) for k in m.order)
    }
    met = three_planes(
        f, [ends[k] for k in others], [m.planes[k] for k in others], m.hand, scale=size
    )
    assert met.link.lemma is not None
    hand = sp.Matrix([met.link.lemma[x] for x in m.hand])
    m.planes[last].reached(Naming(f, size, "_4", MOVED), hand - ends[last])
    return met.link


def _where_rails_meet(m: OnRails, f: Program, arms: Sequence[sp.Matrix], _: sp.Expr) -> Link:
    """The hand on two of its rails, by its distances from them along their normals."""
    far, way = [], []
    for n in m.order[:2]:
        leg = m.legs[n]
        assert isinstance(leg, Rail)
        base = sp.simplify(leg.normal.dot(leg.base)) + leg.normal.dot(leg.rate) * leg.joint
        far.append(f.let(f"g{n + 1}", base - leg.normal.dot(arms[n])))
        numbers = zip("xy", leg.way, strict=True)
        way.append(sp.Matrix([named_number(f, f"t{n + 1}_{axis}", e) for axis, e in numbers]))
    across = cross_in_plane(way[0], way[1])
    found = (far[0] * way[1] - far[1] * way[0]) / across
    lemma = Lemma(
        "oblique coordinates",
        r"\mathbf w = \frac{g_s\,\mathbf t - g_t\,\mathbf s}{D},\quad g_s = s_1 w_2 - s_2 w_1,\ "
        r"g_t = t_1 w_2 - t_2 w_1",
        tuple(cross_in_plane(t, m.hand) - g for t, g in zip(way, far, strict=True)),
        dict(zip(m.hand, found, strict=True)),
        1,
        roles=((r"\mathbf w", m.hand), (r"\mathbf s", way[0]), (r"\mathbf t", way[1])),
    )
    return Link(tuple(m.hand), lemma.equations, {}, lemma)


def _rows(m: OnRails, arms: Sequence[sp.Matrix]) -> sp.Matrix:
    """A of A*dx = B*dq."""
    rows = [
        [*leg.normal, cross_in_plane(arm, leg.normal)]
        for leg, arm in zip(m.legs, arms, strict=True)
    ]
    return sp.Matrix(rows)


def _velocity(m: OnRails, at: _Posture, loop: Step) -> None:
    d, v = m.d, Program(list(at.program.body), at.program.taken)
    A, B = velocity_matrices(m.loop, m.target, d.actuated)
    rates = [leg.normal.dot(leg.rate) for leg in m.legs]
    rows, yaw, n = _rows(m, m.turned), m.yaw, len(m.legs)
    a, b, _ = m.coefficients
    side = (-1) ** m.dimensions
    det = "b*sin(yaw) - a*cos(yaw)" if m.in_plane else "a*cos(yaw) - b*sin(yaw)"
    *names, last = m.task
    d.step(
        "Velocity and singular sets",
        "The derivatives of the loop equations give A*dx = B*dq.  Row i of A is the normal n and "
        "its moment about the hand.  B is diagonal and constant, so no posture is serially "
        f"singular.  A is singular if {m.meet} (parallel), which is where both assembly "
        "modes meet.",
        {"A": rows, **{f"B_{{{k}{k}}}": e for k, e in enumerate(rates, 1)}},
        proves=f"A and B are the derivatives, and the determinant of A is {det}.",
        equal=[
            (A, rows),
            (B, sp.diag(*rates)),
            (rows.det(), side * (b * sp.sin(yaw) - a * sp.cos(yaw))),
        ],
        uses=[loop],
    )
    entries = enumerate(_rows(m, at.arms))
    named = sp.Matrix(n, n, [named_in(v, f"A_{i // n + 1}{i % n + 1}", e) for i, e in entries])
    volume = v.let("Delta", side * at.volume)
    pole = "Not finite at a parallel singularity."
    export(
        d,
        v,
        at.modes,
        [
            ("jacobian_parallel", "A of A*dx = B*dq.", {"A": named}, ()),
            ("jacobian_serial", "The diagonal of B of A*dx = B*dq.", {"B": rates}, ()),
            (
                "jacobian",
                f"Derivative of {', '.join(names)} and {last} with respect to q: A^-1*B.",
                {"J": named.adjugate() * sp.diag(*rates) / volume},
                (pole,),
            ),
            (
                "determinant",
                "Determinant of the Jacobian.",
                {"det": sp.Mul(*rates) / volume},
                (pole,),
            ),
            ("singularities", "The determinant of A (parallel).", {"factors": [volume]}, ()),
        ],
    )


def _points(m: OnRails, hand: sp.Matrix, arms: Sequence[sp.Matrix]) -> dict[str, list[sp.Expr]]:
    points = {"P": in_space(hand)}
    for (k, leg), arm in zip(m.numbered, arms, strict=True):
        points |= {f"A{k}": in_space(leg.base), f"B{k}": in_space(leg.end())}
        points[f"C{k}"] = in_space(hand + arm)
    return points


def _draw(m: OnRails, at: _Posture) -> None:
    ground = tuple(f"A{k}" for k, _ in m.numbered)
    drawn, v = Drawing({"ground": (*ground, ground[0])}), at.program
    points = _points(m, at.hand, at.arms)
    posed: list[dict[str, Sequence[sp.Expr]]] = [{**_points(m, m.hand, m.turned)}]
    arms = zip(m.numbered, m.loop, m.places, m.turned, at.arms, strict=True)
    for (k, leg), equation, place, turned, arm in arms:
        base, near, far = f"A{k}", f"B{k}", f"C{k}"
        drawn.links[f"hand{k}"] = ("P", far)
        drawn.lengths["P", far] = sp.sqrt(sp.factor(square(place)))
        if isinstance(leg, Plane):
            drawn.add_plane(k, leg, far)
            names = Naming(v, size_of(m.d, m.legs, m.d.actuated), f"_bars{k}")
            span = at.hand + arm - leg.end()
            points[f"E{k}"] = in_space(leg.end() + leg.named_elbow(names, span))
            end = m.hand + turned
            bars = {near: end - ANY, f"E{k}": end - ANY + leg.elbow(ANY), far: end}
            posed.append({name: in_space(e) for name, e in bars.items()})
            continue
        drawn.joints |= {leg.joint: (base, near), leg.slide: (near, far)}
        drawn.lengths[base, near] = leg.joint
        drawn.lengths[near, far] = leg.way.dot(m.hand + turned - leg.end())
        drawn.closing[near, far] = equation**2
        # along the rail: so a point near the guide loses no digits
        along = leg.way.dot(at.hand + arm - leg.end())
        points[far] = in_space(leg.end() + along * leg.way)
    skeleton(
        m.d,
        points,
        links=drawn.links,
        joints=drawn.joints,
        hand="P",
        hand_at=in_space(m.hand),
        ground=ground,
        lengths=drawn.lengths,
        program=v,
        branches=at.modes,
        notes=(NO_MODE,),
        at_posture=posed,
        closing=drawn.closing,
    )


def _inverse(m: OnRails, loop: Step) -> None:
    d, g = m.d, m.d.program()
    solved = LegByLeg(d, g, g.let("size", size_of(d, m.legs, m.target[:-1])))
    for (k, leg), arm in zip(m.driven, m.turned, strict=True):
        solved.solve(k, leg, m.hand + arm - leg.base)
    a, b, _ = m.coefficients
    yaw = m.yaw
    volume = g.let("Delta", b * sp.sin(yaw) - a * sp.cos(yaw))
    g.determined(sp.Abs(volume), solved.size, m.meet, name=r"|\det A|", size=solved.size)
    d.step(
        "Inverse: leg by leg",
        f"Each leg is solved alone: its {m.flats[:-1]} has to pass through its point of the hand.  "
        "Near a "
        "parallel singularity rounded joints do not determine the hand.  The status is SINGULAR if "
        "the determinant of A is less than 2^-10 of the sum of all lengths.",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    beyond = "UNREACHABLE: the bars of a leg do not reach." * bool(m.planes)
    solved.export({"x": m.target}, {"x": m.target}, beyond, [f"SINGULAR: {m.meet}."])
    solved.certify(m.loop, "fk", angles=(m.yaw,))


__all__ = ["on_rails"]
