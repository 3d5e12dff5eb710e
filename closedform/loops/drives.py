"""Joints driven through a parallelogram, whose motor is beside the motor of the link before."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from string import ascii_letters
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.parallelogram import parallelogram
from closedform.model.derivation import Derivation
from closedform.model.functions import real

KEEPS_TURNS = "The map is linear and keeps whole turns: its angles are not reduced to (-pi, pi]."

NUMBERED = "the joint with this number"


def parallelogram_drive(
    d: Derivation,
    through: Mapping[sp.Symbol, tuple[sp.Symbol, Any]],
    motors: Sequence[str] = (),
) -> sp.Matrix:
    """Derive the joints of an arm from its motors, if parallelograms drive some of its links.

    Exports ``joints_from_motors`` and ``motors_from_joints``, and returns the matrix that takes the
    motors to the joints.

    Parameters
    ----------
    d
        the derivation, with its joints
    through
        for each joint that a parallelogram drives: the joint before it, whose axis is parallel, and
        the length of the link between both axes.  Its motor stands on the same body as that of the
        joint before
    motors
        the names of the motors, in the order of the joints; by default ``m3`` for ``theta3``
    """
    joints = d.actuated
    names = [*(motors or (f"m{_tag(q)}" for q in joints))]
    if len(set(names)) != len(joints) or not set(through) <= set(joints):
        raise ShapeError(
            f"{d.name}: give each joint one motor with a name of its own, and list in through "
            f"only joints of the arm"
        )
    turned = dict(zip(joints, map(real, names), strict=True))
    for q, name in zip(joints, names, strict=True):
        d.write(name, meaning=f"angle of the motor of {q if motors else NUMBERED}")
    rows = [turned[q] - turned[through[q][0]] if q in through else turned[q] for q in joints]
    angles = sp.Matrix([turned[q] for q in joints])
    M = sp.Matrix(rows).jacobian(angles)
    for q, (before, link) in through.items():
        _state(d, q, before, link, turned[q])
    coupled = ", ".join(f"{q} = {turned[q]} - {turned[through[q][0]]}" for q in through)
    back = ", ".join(f"{turned[q]} = {through[q][0]} + {q}" for q in through)
    d.step(
        "Motors",
        f"The motor of a parallelogram turns by the sum of two joints: {back}.  The other motors "
        "turn their joints directly.  M converts angles of the motors to angles of the joints.",
        {
            rf"M = \partial({', '.join(map(sp.latex, joints))}) / \partial m": M,
            "M^{-1}": M.inv(),
        },
        proves="M is the derivative of the joints with respect to the motors.",
        equal=[(M * angles, sp.Matrix(rows))],
    )
    d.explain({"M": "derivative of the joints with respect to the motors"})
    for name, summary, given, found in (
        ("joints_from_motors", f"Joint angles from motor angles: {coupled}.", angles, M * angles),
        (
            "motors_from_joints",
            f"Motor angles from joint angles: {back}.",
            joints,
            M.inv() * sp.Matrix(joints),
        ),
    ):
        inputs, outputs = ("motors", "q") if given is angles else ("q", "motors")
        d.function(name, summary, {inputs: given}, {outputs: found}, notes=(KEEPS_TURNS,))
    return M


def _tag(q: sp.Symbol) -> str:
    """The number of a joint, or its name if it has no number."""
    return str(q).lstrip(ascii_letters + "_") or f"_{q}"


def _state(d: Derivation, q: sp.Symbol, before: sp.Symbol, link: Any, motor: sp.Symbol) -> None:
    """The step on one parallelogram."""
    tag = _tag(q)
    r, gamma = real(f"r{tag}", positive=True), real(f"gamma{tag}")
    phi, beta, sigma = real(f"phi{tag}"), real(f"beta{tag}"), real("sigma")
    for symbol, meaning in (
        (r, "length of the crank"),
        (gamma, "direction of the crank at rest"),
        (phi, "turn of the driven link against the crank"),
        (beta, "angle of the rod"),
    ):
        d.write(str(symbol), meaning=f"{meaning}, of the parallelogram of {q}")
    loop = parallelogram((link, r), (before, gamma + motor), (phi, beta), sigma)
    closed = sp.Matrix(loop.equations).subs(loop.solution)
    d.step(
        "The parallelogram and its motor",
        f"The motor of {q} is on the same body as that of {before}.  It turns a crank of length "
        f"{r}.  A rod as long as the link between both axes, {link}, leads from it to the driven "
        f"link, {r} from its axis.  The loop equations have two solutions for the turn of the "
        "driven link against the crank.  In the parallelogram it is 0, so the angle of the motor "
        f"is {before} + {q}, the turn of the driven link against the body of the motors, whatever "
        "the crank.  The crossed one, an antiparallelogram, is left out: the two meet only where "
        "crank and link are in line.",
        {
            "0": sp.Matrix(loop.equations),
            sp.latex(before + q - motor, order="none"): loop[phi].subs(sigma, 1),
        },
        proves="Both solutions close the loop, and in the first one the link turns with the crank.",
        equal=[
            *((closed.subs(sigma, sign), sp.zeros(2, 1)) for sign in (1, -1)),
            (loop[phi].subs(sigma, 1), sp.S.Zero),
        ],
    )


__all__ = ["parallelogram_drive"]
