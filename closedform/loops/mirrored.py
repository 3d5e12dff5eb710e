"""A hand that is the mirror image of the ground in the plane of three balls, as a Canfield joint.

Each leg has a crank on the ground and the same crank, mirrored, on the hand, and a ball joins both.
The balls determine the plane in which the hand is the mirror image of the ground.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.amplitude import Amplitude
from closedform.lemmas.legs import Crank, Solution, sign_of_leg, vector
from closedform.lemmas.links import degenerate
from closedform.lemmas.mirror import Image, mirror_image
from closedform.loops.leg_by_leg import SIGN, LegByLeg, named, record, size_of
from closedform.loops.modes import NO_MODE, export
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import SINGLE, Program, choose, real
from closedform.model.inverse import Inverse, Link
from closedform.model.pair import Pair
from closedform.model.step import Step

LEGS = 3
TASK = ("x", "y", "z")
HAND = sp.Matrix([real(e) for e in TASK])
MIRRORS = ((1, 1, -1), (1, -1, 1), (-1, 1, 1), (-1, -1, -1))
AT_PIVOT = "the point of the hand is at its mirror image on the ground"
LEFT_OUT = (
    "Left out: assembly modes in which the hand is not the mirror image of the ground, of which "
    "there are up to 15."
)


@dataclass(frozen=True)
class Mirrored:
    """A hand that is the mirror image of the ground, and its legs."""

    d: Derivation
    pivot: sp.Matrix
    """The point of the ground whose mirror image is the point of the hand."""
    mirror: sp.Matrix
    """Takes the ground, seen from the pivot, to the hand in its own frame."""
    legs: tuple[Crank, ...]

    def __post_init__(self) -> None:
        name, joints = self.d.name, [leg.joint for leg in self.legs]
        if len(self.legs) != LEGS or joints != list(self.d.actuated):
            raise ShapeError(
                f"{name}: a mirrored hand has three legs, in the order of the driven joints"
            )
        if not all(isinstance(e, Crank) and e.rod == 0 and len(e.base) == LEGS for e in self.legs):
            raise ShapeError(
                f"{name}: the legs of a mirrored hand are cranks in space with the rod 0, whose "
                f"ends are the balls"
            )
        if tuple(self.mirror.diagonal()) not in MIRRORS or not self.mirror.is_diagonal():
            raise ShapeError(
                f"{name}: the frame of the hand is that of the ground, mirrored in a plane of two "
                f"of its axes, or in its origin"
            )
        if list(self.d.task) not in ([], list(TASK)):
            raise ShapeError(f"{name}: the task of this hand must be {', '.join(TASK)}")
        self.d.task = list(TASK)

    @property
    def numbered(self) -> list[tuple[int, Crank]]:
        return [*enumerate(self.legs, 1)]

    @cached_property
    def balls(self) -> list[sp.Matrix]:
        """The balls, seen from the pivot."""
        return [leg.end() - self.pivot for leg in self.legs]

    @cached_property
    def loop(self) -> tuple[sp.Expr, ...]:
        """What vanishes if the balls are in the plane of the mirror.

        They are as far from the point of the hand as from the pivot: ``w.b - w.w/2``.
        """
        w = HAND - self.pivot
        return tuple((b.dot(b) - (b - w).dot(b - w)) / 2 for b in self.balls)

    def image(self, point: sp.Matrix) -> sp.Matrix:
        """The mirror image of a point, at the target."""
        w = HAND - self.pivot
        return point - (2 * w.dot(point - self.pivot) / w.dot(w) - 1) * w


def mirrored(
    d: Derivation,
    pivot: Sequence[Any],
    legs: Sequence[Crank],
    *,
    mirror: Sequence[int] = (1, 1, -1),
) -> None:
    """Derive and export a hand that is the mirror image of the ground in the plane of three balls.

    Its task is ``x, y, z``, the position of the point of the hand, which is the mirror image of the
    ``pivot``.  It exports ``fk``, ``ik`` with both working modes of each leg, ``hand_pose``, the
    Jacobians and the singular set as functions of the joints, and the skeleton.

    Parameters
    ----------
    d
        the derivation, with its parameters and joints; the legs are in the order of the joints
    pivot
        the point of the ground whose mirror image is the point of the hand
    legs
        three cranks on the ground without a rod (0), whose ends are the balls; on the hand there
        are the same cranks, mirrored
    mirror
        the signs with which the coordinates of the ground are those of its mirror image in the
        frame of the hand
    """
    m = Mirrored(d, vector(pivot), sp.diag(*mirror), tuple(legs))
    if not d.singularities:
        d.singularities, d.poles = (
            (*(f"leg {k}" for k, _ in m.numbered), "line", "pivot"),
            ("line",),
        )
    loop = _close(m)
    at = _forward(m, loop)
    _velocity(m, at, loop)
    _draw(m, at)
    _inverse(m, loop)


def _close(m: Mirrored) -> Step:
    """The step on the loop, and why the hand of the mirror closes it."""
    d = m.d
    w, X, B, a = (sp.Matrix([real(f"{e}_{i}") for i in "xyz"]) for e in ("w", "X", "B", "a"))
    off, on = w.dot(X) / w.dot(w) - sp.Rational(1, 2), w.dot(B) - w.dot(w) / 2
    turned = a - 2 * w.dot(a) / w.dot(w) * w
    seen = X - 2 * off * w
    d.explain(
        {
            r"\mathbf w": "from the pivot to the point of the hand",
            r"\mathbf b_k": "ball k, seen from the pivot",
            r"\mathbf n": "unit normal of the plane of the balls, along w",
            "R": "rotation of the hand",
        }
    )
    n = sp.Matrix([real(f"n_{i}") for i in "xyz"])
    rows = [
        (str(k), leg.base.T, ball.T) for (k, leg), ball in zip(m.numbered, m.balls, strict=True)
    ]
    d.loop = step = d.step(
        "The loop",
        "The joint of leg k turns a crank about an axis through A_k, and b_k is the ball at its "
        "end, seen from the pivot.  The hand is the mirror image of the ground in the plane of the "
        "three balls.  So the crank on the hand, from the mirror image of A_k, is as long as that "
        "on the ground and at right angles to the mirror image of its axis, wherever the ball is "
        "in the plane: the loop is closed.  Its point is the mirror image of the pivot.  With the "
        "vector w from the pivot to it, the plane halves w at right angles, so w^T*b_k is half of "
        "w^T*w.  The rotation R of the hand is the reflection in the plane, after that which takes "
        "the frame of the ground to that of its image.",
        {
            r"\mathbf w^T\mathbf b_k": r"\tfrac12\,\mathbf w^T\mathbf w",
            "R": r"(I - 2\,\mathbf n\,\mathbf n^T)\,\operatorname{diag}"
            + f"({', '.join(map(str, m.mirror.diagonal()))})",
        },
        rows=[("k", "A", "b"), *rows],
        proves="A point of the plane, B, is as far from the mirror image of a point X as from X, "
        "and as far along the mirror image of a direction as along this.",
        equal=[
            ((seen - B).dot(seen - B) - (X - B).dot(X - B), 4 * off * on),
            ((seen - B).dot(turned) - (X - B).dot(a), 2 * w.dot(a) / w.dot(w) * on),
        ],
    )
    p = d.program()
    away = named(p, "w", HAND - m.pivot)
    size = p.let("size", size_of(d, m.legs))
    _, n = _normal(p, away, size)
    R = (sp.eye(3) - 2 * n * n.T) * m.mirror
    T = R.row_join(HAND).col_join(sp.Matrix([[0, 0, 0, 1]]))
    d.function(
        "hand_pose",
        "Pose of the hand, which the target determines.",
        {"x": tuple(HAND)},
        {"T": T},
        program=p,
        notes=(f"SINGULAR in ik: {AT_PIVOT}; the plane is then taken at right angles to z.",),
    )
    return step


def _normal(
    p: Program, w: sp.Matrix, size: sp.Expr, name: str = "n"
) -> tuple[sp.Symbol, sp.Matrix]:
    """The length of the vector to the hand, and the normal of the mirror."""
    dist = p.let("dist", sp.sqrt(w.dot(w)), nonnegative=True)
    at_pivot = p.vanishes("at_pivot", dist, size, AT_PIVOT)
    entries = zip("xyz", w, (0, 0, 1), strict=True)
    return dist, sp.Matrix(
        [p.let(f"{name}_{i}", choose(at_pivot, e, x / dist)) for i, x, e in entries]
    )


@dataclass(frozen=True)
class _Posture:
    """The hand in the names of the program of ``fk``."""

    program: Program
    hand: sp.Matrix
    balls: list[sp.Matrix]
    image: Image


def _forward(m: Mirrored, loop: Step) -> _Posture:
    d, f = m.d, m.d.program()
    size = f.let("size", size_of(d, m.legs))
    balls = [named(f, f"b{k}", b) for k, b in enumerate(m.balls, 1)]
    image = mirror_image(f, tuple(HAND), m.pivot, balls, size)
    link = image.link
    assert link.lemma is not None
    hand = sp.Matrix([link.lemma[e] for e in HAND])
    d.assembly_modes = SINGLE.labels
    d.explain({r"\mathbf N": "normal of the plane of the balls"})
    d.step(
        "Forward: a mirror image",
        "The joints give the balls, and these the plane of the mirror, with the normal N, the "
        "product of two vectors between them.  The point of the hand is the mirror image of the "
        "pivot.  The equations have one more solution, the pivot itself: it belongs to no plane, "
        "and is left out.  So are the postures in which the hand is not the mirror image of the "
        "ground.  For given joints the balls stand still, and three points of the hand are on "
        "circles about its axes: an equation of degree 16, of which the mirror image is one "
        "solution.",
        {
            r"\mathbf N": r"(\mathbf b_2 - \mathbf b_1)\times(\mathbf b_3 - \mathbf b_1)",
            r"\mathbf w": r"\frac{2\,\mathbf N^T\mathbf b_1}{\mathbf N^T\mathbf N}\,\mathbf N",
        },
        uses=[loop],
        solves={"fk": ()},
    )
    d.function(
        "fk",
        "Position of the hand.",
        {"q": d.actuated},
        {"p": list(hand)},
        program=f,
        branches=SINGLE,
        result="Positions",
        notes=(
            "SINGULAR: the balls are in one line, and the plane turns about it; the pivot is "
            "returned.",
            LEFT_OUT,
        ),
    )
    record(d, Inverse("fk", tuple(HAND), (sp.S.Zero,) * LEGS, m.loop, links=(link,)))
    return _Posture(Program(list(f.body), f.taken), hand, balls, image)


def _velocity(m: Mirrored, at: _Posture, loop: Step) -> None:
    d, v = m.d, Program(list(at.program.body), at.program.taken)
    w = HAND - m.pivot
    d.step(
        "Velocity and singular sets",
        "The derivatives of the equations give A*dp = B*dq.  Row k of A is the vector from the "
        "ball to the point of the hand, w - b_k, and B is diagonal: w^T times the derivative of "
        "the ball.  Let n be the unit normal along N, and w = t*n.  Then entry k of B is t times "
        "n^T v_k, for the derivative v_k of the ball, and the determinant of A is half of t times "
        "the length of N.  So t cancels in J = A^-1*B.  The singular sets are n^T v_k = 0, where a "
        "ball moves in the plane of the mirror (serial: its joint moves, and the hand stands "
        "still); N = 0, where the balls are in one line (parallel: the plane may turn about it); "
        "and t = 0, where the pivot is in the plane: there the point of the hand moves along n "
        "alone, and the hand turns about it.",
        {},
        proves="The derivatives of an equation, with respect to the position and to a joint.  The "
        "determinant of A is N^T*(w - b_1), and with n along z, so that t/2 is the last coordinate "
        "of all balls, it is half of t times the length of N.",
        equal=[
            *(
                (sp.Matrix([e.diff(x) for x in HAND]), b - w)
                for e, b in zip(m.loop, m.balls, strict=True)
            ),
            *((e.diff(leg.joint), w.dot(leg.rate)) for e, leg in zip(m.loop, m.legs, strict=True)),
            *_triangle(),
        ],
        uses=[loop],
    )
    image, size = at.image, size_of(m.d, m.legs)
    n, t = image.normal, image.away
    A = sp.Matrix.vstack(*(named(v, f"A_{k}", t * n - b).T for k, b in enumerate(at.balls, 1)))
    along = [v.let(f"g_{k}", n.dot(named(v, f"v_{k}", leg.rate))) for k, leg in m.numbered]
    volume = v.let("Delta", size**2 * image.area / 2)
    pole = "Not finite where the balls are in one line."
    export(
        d,
        v,
        SINGLE,
        [
            ("jacobian_parallel", "A of A*dp = B*dq.", {"A": A}, ()),
            (
                "jacobian_serial",
                "The diagonal of B of A*dp = B*dq.",
                {"B": [t * g for g in along]},
                (),
            ),
            (
                "jacobian",
                "Derivative of the position with respect to q: A^-1*B.",
                {"J": A.adjugate() * sp.diag(*along) / volume},
                (pole,),
            ),
            (
                "determinant",
                "Determinant of the Jacobian.",
                {"det": t**2 * sp.Mul(*along) / volume},
                (pole,),
            ),
            (
                "singularities",
                "n^T v_k (serial), the length of N over the square of all lengths (parallel), and "
                "the distance of the hand from the pivot.",
                {"factors": [*along, image.area, t]},
                ("The signs of the first ones distinguish the working modes.",),
            ),
        ],
    )


def _triangle() -> list[tuple[Any, Any]]:
    """The determinant of A, for any triangle and any point."""
    w, *b = (sp.Matrix([real(f"{e}_{i}") for i in "xyz"]) for e in ("w", "b1", "b2", "b3"))
    N = (b[1] - b[0]).cross(b[2] - b[0])
    t = real("t")
    plane = {b[0][2]: t / 2, b[1][2]: t / 2, b[2][2]: t / 2, w[0]: 0, w[1]: 0, w[2]: t}
    A = sp.Matrix.vstack(*((w - e).T for e in b))
    return [(A.det(), N.dot(w - b[0])), (A.det().subs(plane), (N[2] * t / 2).subs(plane))]


def _draw(m: Mirrored, at: _Posture) -> None:
    """The skeleton: pivots A, balls B, the pivots C of the hand, and P, its point."""
    p = Program(list(at.program.body), at.program.taken)
    size = p.let("sum_of_lengths", size_of(m.d, m.legs))
    _, n = _normal(p, named(p, "w", at.hand - m.pivot), size, "m")
    half = p.let("half", n.dot(at.hand - m.pivot) / 2)

    def placed(hand: sp.Matrix, balls: Sequence[sp.Matrix], image: Any) -> dict[str, Any]:
        found: dict[str, Any] = {"P": [*hand]}
        for (k, leg), ball in zip(m.numbered, balls, strict=True):
            found |= {
                f"A{k}": [*leg.base],
                f"B{k}": [*(m.pivot + ball)],
                f"C{k}": [*image(leg.base)],
            }
        return found

    def image(point: sp.Matrix) -> sp.Matrix:
        return point - 2 * (n.dot(point - m.pivot) - half) * n

    corners = [f"C{k}" for k, _ in m.numbered]
    ground = tuple(f"A{k}" for k, _ in m.numbered)
    links: dict[str, tuple[str, ...]] = {
        "ground": (*ground, ground[0]),
        "hand": (*corners, corners[0]),
        "hand0": ("P", corners[0]),
    }
    lengths: dict[tuple[str, str], sp.Expr] = {}
    closing: dict[tuple[str, str], sp.Expr] = {}
    joints: dict[sp.Symbol, tuple[str, ...]] = {}
    w = HAND - m.pivot
    for (k, leg), equation in zip(m.numbered, m.loop, strict=True):
        links |= {f"crank{k}": (f"A{k}", f"B{k}"), f"rod{k}": (f"B{k}", f"C{k}")}
        joints[leg.joint] = (f"A{k}",)
        lengths[f"A{k}", f"B{k}"] = lengths[f"B{k}", f"C{k}"] = sp.sympify(leg.length, strict=True)
        off = w.dot(leg.base - m.pivot) / w.dot(w) - sp.Rational(1, 2)
        closing[f"B{k}", f"C{k}"] = 4 * off * equation
    first = m.legs[0].base
    for (a, one), (b, two) in zip(m.numbered, [*m.numbered[1:], m.numbered[0]], strict=True):
        gap = one.base - two.base
        lengths[f"C{a}", f"C{b}"] = sp.sqrt(sp.factor(sp.expand(gap.dot(gap))))
    lengths["P", "C1"] = sp.sqrt(sp.factor(sp.expand((first - m.pivot).dot(first - m.pivot))))
    skeleton(
        m.d,
        placed(at.hand, at.balls, image),
        links=links,
        joints=joints,
        hand="P",
        hand_at=[*HAND],
        ground=ground,
        lengths=lengths,
        program=p,
        branches=SINGLE,
        notes=(NO_MODE,),
        at_posture=[placed(HAND, m.balls, m.image)],
        closing=closing,
    )


@dataclass(frozen=True)
class _Plane:
    """The plane of the mirror in the program of ``ik``, seen from the pivot.

    Its normal is w over the sum of the lengths, which is not divided by its own length: so the
    equation of a leg is that of the loop also where the hand is near the pivot.
    """

    normal: sp.Matrix
    length: sp.Symbol
    """The largest entry of the normal."""
    offset: sp.Symbol
    """The product of the normal with a point of the plane."""


def _inverse(m: Mirrored, loop: Step) -> None:
    d, g = m.d, m.d.program()
    solved = LegByLeg(d, g, g.let("size", size_of(d, m.legs)))
    share = named(g, "m", (HAND - m.pivot) / solved.size)
    dist = g.let("dist", sp.sqrt(share.dot(share)), nonnegative=True)
    at_pivot = g.vanishes("at_pivot", dist, sp.S.One, AT_PIVOT, d.actuated)
    entries = zip("xyz", share, (0, 0, 1), strict=True)
    plane = _Plane(
        normal=sp.Matrix([g.let(f"n_{i}", choose(at_pivot, e, x)) for i, x, e in entries]),
        length=g.let("n_length", choose(at_pivot, 1, sp.Max(*map(sp.Abs, share))), positive=True),
        offset=g.let("offset", choose(at_pivot, 0, solved.size * dist**2 / 2)),
    )
    balls = [_solve(m, solved, k, plane) for k, _ in m.numbered]
    u, v = (named(g, e, (b - balls[0])) for e, b in zip("uv", balls[1:], strict=True))
    area = g.let("area", sp.sqrt(sp.Add(*(e**2 for e in u.cross(v)))), nonnegative=True)
    g.determined(
        area,
        solved.size**2,
        "the balls are nearly in one line",
        name=r"|\mathbf N|",
        scale_name=r"\Lambda^2",
        missed=solved.missed,
        size=solved.size,
    )
    d.step(
        "Inverse: leg by leg",
        "The position of the hand gives the plane of the mirror, which halves w at right angles.  "
        "Each ball moves on a circle, which meets the plane in two "
        "points: w^T*b_k is a combination of the cosine and the sine of the "
        f"joint.  {solved.on_modes}Where the length of N is less than 2^-10 of the square of "
        "Lambda, the sum of all lengths, rounded joints do not determine the plane, and the status "
        "is SINGULAR.",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    inputs = {"x": tuple(HAND)}
    solved.export(
        inputs,
        inputs,
        "UNREACHABLE: a ball does not reach the plane of the mirror.",
        [
            f"SINGULAR: {AT_PIVOT}; any plane through it may be the mirror, and the horizontal one "
            "is taken.",
            "SINGULAR also where the balls are nearly in one line: the loop closes, but the joints "
            "do not determine the plane.",
            LEFT_OUT,
        ],
    )
    solved.certify([e / size_of(d, m.legs) for e in m.loop], "fk")


def _solve(m: Mirrored, solved: LegByLeg, k: int, plane: _Plane) -> sp.Matrix:
    """Solve a leg for its joint; returns its ball, seen from the pivot."""
    n, scale = plane.normal, solved.size * plane.length
    g, leg, sigma = solved.program, m.legs[k - 1], sign_of_leg(k)
    q, l = leg.joint, sp.sympify(leg.length, strict=True)
    along, across, start = vector(leg.along), vector(leg.across), leg.base - m.pivot
    a, b = (g.let(f"turn_{e}_{k}", l * n.dot(x)) for e, x in (("a", across), ("b", along)))
    c = g.let(f"turn_c_{k}", plane.offset - n.dot(start))
    body = len(g.body)
    at = Amplitude.of(g, q, (a, b, c), sigma, scale=lambda _: scale / 2, suffix=f"_{k}")
    said = "the circle of a ball is parallel to the plane of the mirror"
    free = g.vanishes(f"free_{k}", at.h, scale, said, (q,))
    root = g.let(f"root_{k}", at.root, nonnegative=True)
    pair = at.pair(root, g.let(f"width_{k}", at.below + at.above, nonnegative=True))
    pair = Pair(choose(free, 0, pair.s), choose(free, 1, pair.c)).known_as(g, f"_{k}")
    lemma = at.lemma(pair.angle, r"2\sigma\operatorname{atan2}(\sqrt{h-c}, \sqrt{h+c})")
    plain = sp.atan2(a, b, evaluate=False) + sigma * sp.atan2(root, c, evaluate=False)
    link = Link(
        unknowns=(q,),
        equations=lemma.equations,
        lemma=replace(lemma, plainly={q: plain}),
        body=tuple(g.body[body:]),
        means={pair.s: sp.sin(q), pair.c: sp.cos(q)},
        degenerate=degenerate(free, [dict.fromkeys((a, b, c), sp.S.Zero)], q, said),
    )
    missed = g.let(f"missed_{k}", sp.Max(0, sp.Abs(c) - at.h) / plane.length)
    ball = named(g, f"ball{k}", start + l * (pair.c * along + pair.s * across))
    solved.choices.append((sigma, SIGN))
    solved.found.append(Solution(link, lemma[q], ball, missed))
    return ball


__all__ = ["MIRRORS", "mirrored"]
