"""The demand that something vanishes, and what a derivation that does not meet it is told."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import sympy as sp

from closedform.algebra.counterexample import Counterexample
from closedform.algebra.normal_form import Decision, Undecided, decide
from closedform.algebra.tower import shortened


class ProofError(ValueError):
    """A step or an inverse of a derivation is wrong, and how."""


@lru_cache(maxsize=32)
def _decide(difference: sp.ImmutableMatrix, nonnegative: tuple[sp.Expr, ...]) -> Decision:
    """Branches that share a stage leave the same to prove."""
    return decide(difference, nonnegative)


def require(
    difference: Any, nonnegative: tuple[sp.Expr, ...], fault: str, names: Sequence[str] = ()
) -> Decision:
    """Prove that a difference vanishes, or say what is left of it and at which simple point.

    ``fault`` says what is wrong if it does not: a place and a clause; ``names`` say what the
    entries are about.
    """
    try:
        decision = _decide(sp.ImmutableMatrix([difference]), nonnegative)
    except Undecided as error:
        raise ProofError(f"{fault}, as far as can be decided: {error}") from error
    if not decision.holds:
        assert isinstance(decision.counterexample, Counterexample)
        entry = decision.counterexample.entry
        about = f" in {names[entry]}" if entry < len(names) else ""
        residual = sp.Matrix([difference])[entry]
        if decision.proof is not None and entry < len(decision.proof.remainders):
            short = decision.proof.remainders[entry]
            residual = min((residual, short), key=sp.count_ops) if short != 0 else residual
        raise ProofError(
            f"{fault}. {decision.counterexample.describe()}; "
            f"the residual{about} is {shortened(residual)}"
        )
    return decision
