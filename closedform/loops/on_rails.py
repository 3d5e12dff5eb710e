"""A hand that turns on three rails in a plane (3-PPR): two assembly modes, in closed form."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.amplitude import Amplitude
from closedform.lemmas.legs import Leg, cross_in_plane, vector
from closedform.lemmas.rails import Rail, named_number
from closedform.loops.hand import check_order, in_space, square
from closedform.loops.leg_by_leg import SIGN, Choice, LegByLeg, named_in, record_lemma, size_of
from closedform.loops.modes import NO_MODE, export
from closedform.mechanics.loops import velocity_matrices
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, branches, choose, real
from closedform.model.inverse import Combination, Degenerate, Inverse, Link
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair
from closedform.model.step import Step

TASK = ("x", "y", "yaw")
POLE = "rails"
MEET = "the rails do not hold the hand: the normals in their points pass through one point"


@dataclass(frozen=True)
class OnRails:
    """A hand on three rails."""

    d: Derivation
    legs: tuple[Rail, ...]

    def __post_init__(self) -> None:
        name = self.d.name
        check_order(self.d, [leg for _, leg in self.driven])
        if list(self.d.task) not in ([], list(TASK)):
            raise ShapeError(f"{name}: the task of this hand must be {', '.join(TASK)}")
        self.d.task = list(TASK)
        if not any(self.weights):
            raise ShapeError(f"{name}: the three rails are parallel, so the hand slides along them")
        if self.coefficients[0] == self.coefficients[1] == 0:
            raise ShapeError(f"{name}: the rails do not hold the hand anywhere; it turns freely")

    @cached_property
    def target(self) -> tuple[sp.Symbol, ...]:
        return tuple(map(real, TASK))

    @property
    def hand(self) -> sp.Matrix:
        return sp.Matrix(self.target[:2])

    @property
    def numbered(self) -> list[tuple[int, Rail]]:
        return [*enumerate(self.legs, 1)]

    @property
    def driven(self) -> list[tuple[int, Leg]]:
        """The same, as legs of any kind."""
        return [(k, cast("Leg", leg)) for k, leg in self.numbered]

    @cached_property
    def weights(self) -> tuple[sp.Expr, ...]:
        """Factors with which the normals of the rails add up to zero."""
        n = [leg.normal for leg in self.legs]
        return tuple(sp.simplify(cross_in_plane(n[(k + 1) % 3], n[(k + 2) % 3])) for k in range(3))

    @cached_property
    def order(self) -> tuple[int, int, int]:
        """Two rails that are not parallel, and the third one."""
        third = next(k for k in (2, 0, 1) if self.weights[k] != 0)
        return ((third + 1) % 3, (third + 2) % 3, third)

    def arms(self, pair: Pair) -> list[sp.Matrix]:
        """The points of the rails, from the point that is the hand."""
        places = [vector(leg.on_hand or (0, 0)) for leg in self.legs]
        return [sp.Matrix([pair.c * x - pair.s * y, pair.s * x + pair.c * y]) for x, y in places]

    @property
    def turned(self) -> list[sp.Matrix]:
        yaw = self.target[2]
        return self.arms(Pair(sp.sin(yaw), sp.cos(yaw)))

    @cached_property
    def coefficients(self) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """a, b and c of the equation a sin(yaw) + b cos(yaw) = c, in which x and y cancel."""
        total = [sp.S.Zero] * 3
        for weight, leg in zip(self.weights, self.legs, strict=True):
            x, y = vector(leg.on_hand or (0, 0))
            turned = sp.Matrix([-y, x]), sp.Matrix([x, y]), leg.end()
            total = [t - weight * leg.normal.dot(v) for t, v in zip(total, turned, strict=True)]
        a, b, c = (sp.factor_terms(sp.expand(t)) for t in total)
        return a, b, c

    @cached_property
    def loop(self) -> tuple[sp.Expr, ...]:
        """The equations of the loop: the points of the hand are on the rails."""
        ends = zip(self.legs, self.turned, strict=True)
        return tuple(leg.normal.dot(self.hand + arm - leg.end()) for leg, arm in ends)


def on_rails(d: Derivation, legs: Sequence[Rail], modes: Choice = SIGN) -> None:
    """Derive and export a hand that turns on three rails; its task is x, y and yaw."""
    m = OnRails(d, tuple(legs))
    if not d.singularities:
        d.singularities, d.poles = (POLE,), (POLE,)
    d.loop = loop = d.step(
        "The loop",
        "The joint of leg i moves the rail, which passes through b and has the normal n.  The "
        "point e of the hand, in its frame, is on the rail: n is at right angles to p + R*e - b.",
        {},
        rows=[
            ("i", "b", "n", "e"),
            *(
                (str(k), leg.end().T, leg.normal.T, vector(leg.on_hand or (0, 0)).T)
                for k, leg in m.numbered
            ),
        ],
    )
    posture = _forward(m, modes, loop)
    _draw(m, posture)
    _velocity(m, posture, loop)
    _inverse(m, loop)


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
    yaw, modes = m.target[2], branches((sigma, choice))
    d.assembly_modes = modes.labels
    size = f.let("size", size_of(d, m.legs, d.actuated))
    named = [named_in(f, n, e) for n, e in zip("abc", m.coefficients, strict=True)]
    start = len(f.body)
    at = Amplitude.of(
        f, yaw, (named[0], named[1], named[2]), sigma, scale=lambda _: size / 4, suffix="_turn"
    )
    free = f.vanishes("free", at.h, size, "the hand turns freely", (yaw,))
    root = f.let("root", at.root, nonnegative=True)
    # not by the differences h - c and h + c, in which a small c is lost
    length = f.let("length", choose(free, 1, sp.sqrt(named[2] ** 2 + root**2)), nonnegative=True)
    reach = f.let("reach", choose(free, 1, at.h), nonnegative=True)
    away = Pair(sigma * root / length, named[2] / length)
    found = Pair(at.a / reach, at.b / reach) + away
    pair = Pair(f.let("s", choose(free, 0, found.s)), f.let("c_yaw", choose(free, 1, found.c)))
    how = r"\sigma\delta,\ (\cos\delta, \sin\delta) = \frac{(c, \sqrt{(h - c)(h + c)})}{h},\ "
    lemma = at.lemma(sp.atan2(pair.s, pair.c), rf"{how}h = \sqrt{{a^2+b^2}}")
    case = Degenerate(
        (free,), dict.fromkeys(named, sp.S.Zero), yaw, "the rails do not hold the hand"
    )
    means = {pair.s: sp.sin(yaw), pair.c: sp.cos(yaw)}
    turn = Link(
        unknowns=(yaw,),
        equations=lemma.equations,
        given={},
        lemma=lemma,
        body=tuple(f.body[start:]),
        means=means,
        degenerate=(case,),
    )
    arms = [
        sp.Matrix([named_in(f, f"e{k}_{i}", e) for i, e in zip("xy", arm, strict=True)])
        for k, arm in enumerate(m.arms(pair), 1)
    ]
    i, j, k = m.order
    met = _meet(m, f, arms)
    hand = sp.Matrix([met[x] for x in m.hand])
    w, combined = m.weights, sp.zeros(3, 3)
    combined[i, 1] = combined[j, 2] = 1
    combined[k, :] = sp.Matrix([[-1, -w[i], -w[j]]]) / w[k]
    d.step(
        "Forward: two assembly modes",
        "The sum of the normals, each times a weight, is zero.  So the sum of the equations with "
        "these weights does not contain p.  It is a*sin(yaw) + b*cos(yaw) = c, and has two "
        "solutions: these are the assembly modes.  Then the hand is where two of its rails meet.",
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
        {"p": [*hand, lemma[yaw]]},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            "UNREACHABLE: the hand is too short for the rails.",
            "SINGULAR: the hand turns freely, and yaw = 0 is returned.",
            "Ill-conditioned near the parallel singularities, where both modes meet.",
        ),
    )
    d.inverses.append(
        Inverse(
            "fk",
            m.target,
            (sp.S.Zero,) * 3,
            m.loop,
            links=(turn, Link(tuple(m.hand), met.equations, {}, met)),
            glue=Combination(combined, {u: u for u in m.target}),
        )
    )
    record_lemma(d, "fk", turn)
    record_lemma(d, "fk", Link(tuple(m.hand), met.equations, {}, met))
    v = Program(list(f.body), f.taken)
    at_hand = sp.Matrix([named_in(v, f"p_{i}", e) for i, e in zip("xy", hand, strict=True)])
    return _Posture(v, modes, at_hand, arms, sigma * root)


def _meet(m: OnRails, f: Program, arms: Sequence[sp.Matrix]) -> Lemma:
    """Where two rails meet, by the distances of the hand from them along their normals."""
    i, j, _ = m.order
    far, way = [], []
    for n in (i, j):
        leg = m.legs[n]
        base = sp.simplify(leg.normal.dot(leg.base)) + leg.normal.dot(leg.rate) * leg.joint
        far.append(f.let(f"g{n + 1}", base - leg.normal.dot(arms[n])))
        numbers = zip("xy", leg.way, strict=True)
        way.append(sp.Matrix([named_number(f, f"t{n + 1}_{axis}", e) for axis, e in numbers]))
    across = cross_in_plane(way[0], way[1])
    found = (far[0] * way[1] - far[1] * way[0]) / across
    return Lemma(
        "oblique coordinates",
        r"\mathbf w = \frac{g_s\,\mathbf t - g_t\,\mathbf s}{D},\quad g_s = s_1 w_2 - s_2 w_1,\ "
        r"g_t = t_1 w_2 - t_2 w_1",
        tuple(cross_in_plane(t, m.hand) - g for t, g in zip(way, far, strict=True)),
        dict(zip(m.hand, found, strict=True)),
        1,
        roles=((r"\mathbf w", m.hand), (r"\mathbf s", way[0]), (r"\mathbf t", way[1])),
    )


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
    rows, yaw = _rows(m, m.turned), m.target[2]
    a, b, _ = m.coefficients
    d.step(
        "Velocity and singular sets",
        "The derivatives of the loop equations give A*dx = B*dq.  Row i of A is the normal n and "
        "its moment about the hand.  B is diagonal and constant, so no posture is serially "
        f"singular.  A is singular if {MEET} (parallel), which is where both assembly modes meet.",
        {"A": rows, **{f"B_{{{k}{k}}}": e for k, e in enumerate(rates, 1)}},
        proves="A and B are the derivatives, and the determinant of A is b*sin(yaw) - a*cos(yaw).",
        equal=[
            (A, rows),
            (B, sp.diag(*rates)),
            (rows.det(), b * sp.sin(yaw) - a * sp.cos(yaw)),
        ],
        uses=[loop],
    )
    named = sp.Matrix(
        3,
        3,
        [named_in(v, f"A_{n // 3 + 1}{n % 3 + 1}", e) for n, e in enumerate(_rows(m, at.arms))],
    )
    volume = v.let("Delta", at.volume)
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
                "Derivative of x, y and yaw with respect to q: A^-1*B.",
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
    links: dict[str, tuple[str, ...]] = {"ground": ("A1", "A2", "A3", "A1")}
    lengths: dict[tuple[str, str], sp.Expr] = {}
    closing: dict[tuple[str, str], sp.Expr] = {}
    joints: dict[sp.Symbol, tuple[str, ...]] = {}
    for (k, leg), equation, arm in zip(m.numbered, m.loop, m.turned, strict=True):
        base, near, far = f"A{k}", f"B{k}", f"C{k}"
        links[f"hand{k}"] = ("P", far)
        joints |= {leg.joint: (base, near), leg.slide: (near, far)}
        lengths["P", far] = sp.sqrt(sp.factor(square(vector(leg.on_hand or (0, 0)))))
        lengths[base, near] = leg.joint
        lengths[near, far] = leg.way.dot(m.hand + arm - leg.end())
        closing[near, far] = equation**2
    points = _points(m, at.hand, at.arms)
    for (k, leg), arm in zip(m.numbered, at.arms, strict=True):
        # along the rail: so a point near the guide loses no digits
        along = leg.way.dot(at.hand + arm - leg.end())
        points[f"C{k}"] = in_space(leg.end() + along * leg.way)
    skeleton(
        m.d,
        points,
        links=links,
        joints=joints,
        hand="P",
        hand_at=in_space(m.hand),
        ground=("A1", "A2", "A3"),
        lengths=lengths,
        program=at.program,
        branches=at.modes,
        notes=(NO_MODE,),
        at_posture=[_points(m, m.hand, m.turned)],
        closing=closing,
    )


def _inverse(m: OnRails, loop: Step) -> None:
    d, g = m.d, m.d.program()
    solved = LegByLeg(d, g, g.let("size", size_of(d, m.legs, m.target[:2])))
    for (k, leg), arm in zip(m.driven, m.turned, strict=True):
        solved.solve(k, leg, m.hand + arm - leg.base)
    a, b, _ = m.coefficients
    yaw = m.target[2]
    volume = g.let("Delta", b * sp.sin(yaw) - a * sp.cos(yaw))
    g.determined(sp.Abs(volume), solved.size, MEET, name=r"|\det A|")
    d.step(
        "Inverse: leg by leg",
        "Each leg is solved alone: its rail has to pass through its point of the hand.  Near a "
        "parallel singularity rounded joints do not determine the hand.  The status is SINGULAR if "
        "the determinant of A is less than 2^-10 of the sum of all lengths.",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    solved.export({"x": m.target}, {"x": m.target}, "", [f"SINGULAR: {MEET}."])
    zeros, links = (sp.S.Zero,) * 3, tuple(s.link for s in solved.found)
    d.inverses.append(Inverse("ik", d.actuated, zeros, m.loop, images="fk", links=links))


__all__ = ["on_rails"]
