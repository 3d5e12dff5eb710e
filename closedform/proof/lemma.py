"""Proves a lemma for the coefficients to which it is applied."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from closedform.algebra.solutions import SolutionCount, count_solutions
from closedform.model.functions import Array, Bound, Function, Let, Program, substitute
from closedform.model.lemma import Lemma
from closedform.proof.require import ProofError, require


def prove_lemma(
    lemma: Lemma, program: Program, given: Mapping[sp.Symbol, sp.Expr] | None = None
) -> SolutionCount:
    """Prove a lemma for the coefficients to which it is applied: symbols, so for all values.

    Its solutions satisfy its equations for both signs, its names have the values in ``means``, and
    the equations have no other solutions.  ``given`` writes dependent coefficients in free
    parameters.  The result is the count of the solutions.
    """
    given = dict(given or {})
    outputs = (*lemma.solution.values(), *lemma.means)
    premises = [Bound(name, meaning, sp.S.One, "") for name, meaning in lemma.premises.items()]
    body = [*premises, *program.body]
    steps = [s.value for s in body if isinstance(s, (Let, Bound))]
    free = {s for e in (*outputs, *steps) for s in e.free_symbols}
    sign = next((s for s in free if s.name.startswith("sigma")), None)
    function = Function("lemma", "", (), (Array("x", (len(outputs),), outputs),), tuple(body))
    for value in (1, -1) if sign else (1,):
        signs = {sign: value} if sign else {}
        values = function.values(signs)
        solution = dict(zip(lemma.solution, values, strict=False))
        meant = [substitute(e, solution) for e in lemma.means.values()]
        named = [a - b for a, b in zip(meant, values[len(solution) :], strict=True)]
        vanishing = sp.Matrix([*(substitute(e, solution) for e in lemma.equations), *named])
        bounds = tuple(substitute(b, given) for b in function.bounds(signs))
        fault = f"what the lemma {lemma.name!r} gives does not satisfy its equations"
        require(substitute(vanishing, given), bounds, fault)
    counted = count_solutions(lemma.equations, tuple(lemma.solution), target_substitution=given)
    if counted.count != lemma.branches + lemma.excluded:
        given_count = f"{lemma.branches + lemma.excluded} are accounted for"
        raise ProofError(
            f"the lemma {lemma.name!r} has {counted.count} solutions, but {given_count}"
        )
    return counted
