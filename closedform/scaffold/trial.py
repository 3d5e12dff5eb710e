"""Runs the lines of a proposed chain, and proves what they solve before they are written."""

from __future__ import annotations

import sympy as sp

import closedform
from closedform.algebra.solutions import NotRationalError
from closedform.lemmas.chain import Chain
from closedform.mechanics.arm import Serial
from closedform.model.derivation import Derivation
from closedform.proof.inverse import prove_inverse
from closedform.scaffold.tables import CHAIN, IMPORTED, LINKED


def solved(d: Derivation, arm: Serial, lines: str) -> Chain:
    """The chain that the lines build in a derivation, as a script that contains them does."""
    task = arm.coordinates()
    if task is not None:
        d.task = list(task.names)
    angles = ["yaw"] if task is not None and "yaw" in task.names else []
    ik = Chain(d, arm.pose if task is None else task.values, angles=angles)
    known = {name: getattr(sp, name) for name in IMPORTED}
    known |= {name: getattr(closedform, name) for name in (*CHAIN, *LINKED)}
    known |= {symbol.name: symbol for symbol in (*ik.joints, *(p.symbol for p in d.parameters))}
    exec(lines, known | {"ik": ik})
    ik.finish("All solutions of the inverse kinematics.")
    return ik


def fault(d: Derivation, arm: Serial, lines: str) -> str:
    """A clause on why the proof of a proposed chain fails; empty if it does not.

    Where it cannot be carried out, because a length is a root such as sqrt(401), nothing is known.
    """
    try:
        solved(d, arm, lines)
        prove_inverse(d, d.inverses[-1])
    except NotRationalError:
        return ""
    except (ValueError, TypeError, ArithmeticError, NotImplementedError) as error:
        return str(error).removeprefix(f"{d.name}.ik: ").partition(". ")[0]
    return ""
