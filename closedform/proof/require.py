"""Requires that an expression vanishes, and explains a failure to the author of a derivation."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import sympy as sp

from closedform.algebra.counterexample import Counterexample
from closedform.algebra.expressions import shortened
from closedform.algebra.normal_form import Decision, Undecided, decide
from closedform.algebra.operations import operations


class ProofError(ValueError):
    """A step or an inverse of a derivation is wrong; the message says how."""


@lru_cache(maxsize=32)
def _decide(difference: sp.ImmutableMatrix, nonnegative: tuple[sp.Expr, ...]) -> Decision:
    """Decide, with a cache: branches that share a stage have the same equations."""
    return decide(difference, nonnegative)


def forget_decisions() -> None:
    """Forget all decisions, so that the certificates of a mechanism are complete."""
    _decide.cache_clear()


def require(
    difference: Any, nonnegative: tuple[sp.Expr, ...], fault: str, names: Sequence[str] = ()
) -> Decision:
    """Prove that a difference vanishes, or raise with its residual and a simple counterexample.

    ``fault`` is the message of the error: a place and a clause.  ``names`` describe the entries.
    """
    try:
        decision = _decide(sp.ImmutableMatrix([difference]), nonnegative)
    except Undecided as error:
        raise ProofError(f"{fault}, or this cannot be decided: {error}") from error
    if not decision.holds:
        assert isinstance(decision.counterexample, Counterexample)
        entry = decision.counterexample.entry
        about = f" in {names[entry]}" if entry < len(names) else ""
        residual = sp.Matrix([difference])[entry]
        if decision.proof is not None and entry < len(decision.proof.remainders):
            short = decision.proof.remainders[entry]
            residual = min((residual, short), key=operations) if short != 0 else residual
        raise ProofError(
            f"{fault}. {decision.counterexample.describe()}; "
            f"the residual{about} is {shortened(residual)}"
        )
    return decision
