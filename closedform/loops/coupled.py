"""A single loop: a rod joins the driven leg to another one, whose joint is the task.

The four-bar linkage (two cranks) and the slider-crank (a crank and a slide) are of this kind.  If
the driven leg stretches, it takes the place of the rod: a cylinder that turns a lever.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import sympy as sp

from closedform.lemmas.legs import Crank, Leg, Naming, Slide, Stretch
from closedform.lemmas.missed import MOVED, SHARE
from closedform.loops.hand import check_plain, in_space, rate_of, square
from closedform.loops.leg_by_leg import (
    MISSED,
    SIGN,
    Choice,
    record,
    record_lemma,
    size_of,
    where_free,
)
from closedform.loops.letters import letters
from closedform.loops.modes import EQUATIONS, NO_MODE, Exported, export
from closedform.loops.reached import bounds_of, export_reach
from closedform.loops.screws import Screws, check_screws, export_slides
from closedform.mechanics.frames import merge_angles
from closedform.mechanics.loops import velocity_matrices
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import SINGLE, Branches, Program, branches, real
from closedform.model.inverse import Inverse
from closedform.model.step import Step

POSITION = {+1: "positive", -1: "negative"}
"""Names of assembly modes that differ from those of working modes."""


def coupled(
    d: Derivation,
    driver: Crank | Slide | Stretch,
    follower: Crank | Slide,
    modes: Choice = POSITION,
    *,
    screws: Screws | None = None,
) -> None:
    """Derive and export a loop of a driven leg, a rod and a leg whose joint is the task.

    Parameters
    ----------
    d
        the derivation, with its parameters and one joint; the task has one coordinate
    driver, follower
        the legs, see :mod:`closedform.lemmas.legs`, with the same rod; the joint of the first is
        that of the derivation, and the joint of the second is the symbol of the task.  If the
        driver is a ``Stretch``, its joint is the rod of the follower
    modes
        the names of the assembly modes, by the sign of the determinant of ``jacobian_parallel``
    screws
        the places of the axes of an RCCC linkage, if both legs are cranks whose axes meet in the
        origin; then ``slides`` is exported too
    """
    check_plain(d, (driver, follower))
    if driver.rod != follower.rod:
        raise ValueError(f"{d.name}: the driver and the follower must have the same rod")
    d.singularities, d.poles = ("driver", "follower"), ("follower",)
    loop = square(follower.end() - driver.end()) - sp.sympify(driver.rod, strict=True) ** 2
    (b,) = letters(d, "b")
    keeps = "is the driver" if isinstance(driver, Stretch) else "keeps its length"
    d.loop = stated = d.step(
        "The loop",
        "The driver determines the point B1 at one end of the rod, and the follower the point B2 "
        f"at the other end.  The rod {keeps}.",
        {
            rf"\mathbf {b}_1": driver.end(),
            rf"\mathbf {b}_2": follower.end(),
            rf"|\mathbf {b}_2 - \mathbf {b}_1|": sp.sympify(driver.rod, strict=True),
        },
    )
    d.explain({rf"\mathbf {b}_1": "place of B1, the end of the rod on the driver"})
    d.explain({"A": "factor of the rate of the follower", "B": "factor of the rate of the driver"})
    d.explain({rf"\mathbf {b}_2": "place of B2, the end of the rod on the follower"})
    closed = _Loop(d, driver, follower, loop, stated)
    rod = _forward(closed, modes)
    _draw(closed, rod)
    _velocity(closed, rod)
    if screws:
        check_screws(d, (driver, follower))
        reached = driver.end() + rod.vector
        cranks = cast("tuple[Crank, Crank]", (driver, follower))
        export_slides(d, screws, cranks, (rod.program, rod.modes, reached))
    _inverse(closed)


@dataclass(frozen=True)
class _Loop:
    """The loop of a derivation: its legs, its equation, and the step that states it."""

    d: Derivation
    driver: Crank | Slide | Stretch
    follower: Crank | Slide
    equation: sp.Expr
    stated: Step

    @property
    def rod(self) -> sp.Expr:
        return sp.sympify(self.driver.rod, strict=True)

    @property
    def driven(self) -> Leg:
        """The driver, as a leg of any kind."""
        return cast("Leg", self.driver)

    def size(self, given: Crank | Slide | Stretch) -> sp.Expr:
        """The sum of the lengths of the loop, and of the travel of the leg whose joint is given.

        Other parameters, such as those of the slides of an RCCC linkage, do not count.
        """
        legs = (self.driven, self.follower)
        return size_of(self.d, legs, _slid(given), among=self.equation.free_symbols)


@dataclass(frozen=True)
class _Rod:
    """The rod in an assembly mode, from the driver to the follower, in the names of a program."""

    program: Program
    modes: Branches
    vector: sp.Matrix


def _slid(leg: Crank | Slide | Stretch) -> list[sp.Symbol]:
    return [] if isinstance(leg, Crank) else [leg.joint]


def _forward(loop: _Loop, choice: Choice) -> _Rod:
    d, driver, follower = loop.d, loop.driver, loop.follower
    f, sigma = d.program(), real("sigma_assembly")
    modes = branches((sigma, choice))
    d.assembly_modes = modes.labels
    size = f.let("size", loop.size(driver))
    names = Naming(f, size, "_2", MOVED if _slid(driver) else SHARE)
    found = follower.solve(names, driver.end() - follower.base, sigma)
    d.step(
        "Forward: the follower",
        "The follower has to reach the point B1 with the rod.  Both solutions are assembly modes.",
        {},
        uses=[loop.stated],
        solves={"fk": ()},
    )
    d.function(
        "fk",
        f"{follower.joint} in both assembly modes.",
        {"q": d.actuated},
        {"p": [found.value]},
        program=f,
        branches=modes,
        result="Positions",
        notes=(
            "UNREACHABLE: the rod does not reach, so the loop cannot close.",
            *where_free([found]),
            "Ill-conditioned near the parallel singularity, where both modes meet.",
        ),
    )
    x = follower.joint
    record(d, Inverse("fk", (x,), (sp.S.Zero,), (loop.equation,), links=(found.link,)))
    v = Program(list(f.body), f.taken)
    along = sp.Matrix([v.let(f"w{i}", -e) for i, e in zip("xyz", found.rod, strict=False)])
    return _Rod(v, modes, along)


def _points(loop: _Loop) -> dict[str, sp.Matrix]:
    legs = {"1": loop.driver, "2": loop.follower}
    return {f"A{k}": leg.base for k, leg in legs.items()} | {
        f"B{k}": leg.end() for k, leg in legs.items() if not isinstance(leg, Stretch)
    }


def _draw(loop: _Loop, rod: _Rod) -> None:
    d, driver, follower = loop.d, loop.driver, loop.follower
    posture = {name: in_space(at) for name, at in _points(loop).items()}
    end = driver.end() + rod.vector
    closing = ("A1" if isinstance(driver, Stretch) else "B1", "B2")
    lengths = {closing: loop.rod}
    links: dict[str, tuple[str, ...]] = {"ground": ("A1", "A2")}
    if not isinstance(driver, Stretch):
        links["rod"] = closing
    joints: dict[sp.Symbol, tuple[str, ...]] = {}
    for k, leg in enumerate((driver, follower), 1):
        base, near = f"A{k}", f"B{k}"
        if isinstance(leg, Stretch):
            joints[leg.joint] = closing
            continue
        crank = isinstance(leg, Crank)
        lengths[base, near] = (
            sp.sympify(leg.length, strict=True) if isinstance(leg, Crank) else leg.joint
        )
        if crank:
            links[f"crank{k}"] = (base, near)
        joints[leg.joint] = (base,) if crank else (base, near)
    skeleton(
        d,
        posture | {"B2": in_space(end)},
        links=links,
        joints=joints,
        hand="B2",
        hand_at=in_space(follower.end()),
        ground=("A1", "A2"),
        lengths=lengths,
        program=rod.program,
        branches=rod.modes,
        notes=(NO_MODE,),
        at_posture=[posture],
        closing={closing: loop.equation},
    )


def _velocity(loop: _Loop, rod: _Rod) -> None:
    d, driver, follower = loop.d, loop.driver, loop.follower
    q, x = driver.joint, follower.joint
    A, B = velocity_matrices([loop.equation], (x,), (q,))
    along = follower.end() - driver.end()
    a, b = (
        merge_angles(sp.expand(e)) for e in (along.dot(follower.rate), rate_of(loop.driven, along))
    )
    named = " and ".join(f"{n} is {e}" for n, e in (("x", x), ("q", q)) if str(e) != n)
    serial = (
        "B is the length of the driver."
        if isinstance(driver, Stretch)
        else "B vanishes if the driver moves B1 at right angles to the rod (serial: the driver "
        "moves and the follower stands still)."
    )
    d.step(
        "Velocity and singular sets",
        f"The derivative of the loop equation, halved, gives A*dx = B*dq, where {named}.  {serial}"
        "  A vanishes "
        "if the follower moves B2 at right angles to the rod (parallel: the driver stands still "
        "and cannot hold the follower).",
        {"A": a, "B": b, "J": r"\frac{B}{A}"},
        proves="A and B are half of the derivatives.",
        equal=[(A[0] / 2, a), (B[0] / 2, b)],
        uses=[loop.stated],
    )
    v = Program(list(rod.program.body), rod.program.taken)
    placed = follower.rate_at(driver.end() + rod.vector)
    A_at, B_at = v.let("A", rod.vector.dot(placed)), v.let("B", rate_of(loop.driven, rod.vector))
    export_rates(d, v, rod.modes, (A_at, B_at), two_modes=loop.driven.signs == 2)


def export_rates(
    d: Derivation, v: Program, modes: Branches, rates: tuple[sp.Expr, sp.Expr], *, two_modes: bool
) -> None:
    """Export the Jacobians and the singular set of a single loop, from A and B of A*dx = B*dq.

    With ``two_modes``, the sign of B tells the working modes apart.
    """
    A, B = rates
    pole = ("Not finite at a parallel singularity.",) * bool(d.poles)
    signed = ("Its sign distinguishes the working modes.",) * two_modes
    functions: list[Exported] = [
        ("jacobian_parallel", "A of A*dx = B*dq.", {"A": [[A]]}, ()),
        ("jacobian_serial", "B of A*dx = B*dq.", {"B": [B]}, signed),
        ("jacobian", "Derivative of x with respect to q: B/A.", {"J": [[B / A]]}, pole),
        ("determinant", "The Jacobian as a number: B/A.", {"det": B / A}, pole),
        ("singularities", "B (serial) and A (parallel).", {"factors": [B, A]}, ()),
    ]
    export(d, v, modes, functions, {**EQUATIONS, "det": "J", "factors": "A"})


def _inverse(loop: _Loop) -> None:
    d, driver, follower = loop.d, loop.driver, loop.follower
    g, sigma, x = d.program(), real("sigma_driver"), follower.joint
    size = g.let("size", loop.size(follower))
    found = loop.driven.solve(Naming(g, size, "_1"), follower.end() - driver.base, sigma)
    inside = bounds_of(g)
    A = g.let("A", found.rod.dot(follower.rate))
    stretches = isinstance(driver, Stretch)
    scale, least = found.value if stretches else loop.rod, "the length of the rod"
    if isinstance(follower, Crank):
        scale, least = scale * size, f"{least} times the sum of all lengths"
    across = "the rod is at right angles to the follower"
    g.determined(sp.Abs(A), scale, across, name="|A|", missed=found.missed, size=size)
    working = SINGLE if stretches else branches((sigma, SIGN))
    d.branches = working.labels
    reached = (
        "The driver is the distance of B2 from B1."
        if stretches
        else "The driver has to reach the point B2 with the rod, just as the follower reaches B1.  "
        "Its two solutions are told apart by the sign of B."
    )
    d.step(
        "Inverse: the driver",
        f"{reached}  Near a parallel singularity rounded "
        "joints do not determine the follower, however they are computed.  A rounding error of "
        "the lengths moves it by this error times the length of the rod over A.  The status is "
        f"SINGULAR if A is less than 2^-10 of {least}.  {MISSED}",
        {},
        uses=[loop.stated],
        solves={"ik": ()},
    )
    d.function(
        "ik",
        f"The driven joint in {'the only working mode' if stretches else 'both working modes'}.",
        {"x": (x,)},
        {"q": [found.value]},
        program=g,
        branches=working,
        result="Solutions",
        notes=(
            *["UNREACHABLE: the rod does not reach."] * bool(inside.body),
            *where_free([found]),
            "SINGULAR also near the parallel singularity, where the rod is at right angles to the "
            "path of the follower: the loop closes, but a unit in the last place of the driver "
            "moves the follower by more than 1e-12.",
        ),
    )
    export_reach(d, inside, {"p": (x,)}, "the follower")
    record_lemma(d, "ik", found.link)
    d.inverses.append(
        Inverse(
            "ik",
            d.actuated,
            (sp.S.Zero,),
            (loop.equation,),
            images="fk",
            links=(found.link,),
            angles=(x,) if isinstance(follower, Crank) else (),
        )
    )


__all__ = ["POSITION", "coupled", "export_rates"]
