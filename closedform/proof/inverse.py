"""Proves an inverse: its links, and the glue between them.

Together they show that every branch satisfies the forward map and that no posture is missed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.algebra import certificates
from closedform.algebra.shapes import ShapeError, require_shape
from closedform.algebra.solutions import SolutionCount
from closedform.model.derivation import Derivation
from closedform.model.expressions import substitute
from closedform.model.inverse import Combination, Inverse, Rank
from closedform.proof.glue import prove_glue
from closedform.proof.links import count_system, prove_lemma, prove_system
from closedform.proof.require import ProofError, require
from closedform.proof.witness import uncovered


@dataclass(frozen=True)
class InverseResult:
    """The proved facts about one inverse."""

    function: str
    branches: int
    continua: int
    solutions: int
    method: str
    assumptions: tuple[str, ...]
    """Bounds in inputs and parameters; none if the bounds of lemmas are in names."""
    lemmas: tuple[str, ...]


def prove_inverse(derivation: Derivation, inverse: Inverse) -> InverseResult:
    """Prove that all branches satisfy the equations and that there are no other solutions."""
    function = derivation[inverse.function]
    where = f"{derivation.name}.{function.name}"
    by_lemmas = inverse.by_lemmas
    if any((link.lemma is not None) != by_lemmas for link in inverse.chained) or (
        inverse.glue is not None and not by_lemmas
    ):
        raise ProofError(f"{where}: either each link of an inverse has a lemma, or none has")
    assumptions: list[sp.Expr] = []
    counts: list[tuple[SolutionCount, int]] = []
    for link in inverse.chained:
        if link.lemma:
            found, counted = prove_lemma(link, function.signs, f"{where}: ")
            if isinstance(inverse.glue, Rank):
                assumptions += found
            counts.append((counted, link.lemma.excluded))
    if not by_lemmas:
        assumptions += prove_system(function, inverse, where)
    prove_glue(function, inverse, where)
    lemmas = _prove_steps_follow(derivation, inverse)
    if not by_lemmas:
        counts = [(counted, 0) for counted in count_system(inverse)]
    each = inverse.glue.solutions_per_branch if isinstance(inverse.glue, Combination) else 1
    count = math.prod(counted.count - excluded for counted, excluded in counts)
    method = _method(inverse, [counted for counted, _ in counts])
    branches = _require_all_branches(derivation, inverse, count, each)
    certificates.add_inverse(
        function.name,
        branches,
        [(counted.certificate, counted.conjugate + excluded) for counted, excluded in counts],
        each,
    )
    cases = [case for link in inverse.links for case in link.degenerate if case.free]
    return InverseResult(
        function=function.name,
        branches=branches,
        continua=len(cases if by_lemmas else inverse.degenerate),
        solutions=count // each,
        method=method,
        assumptions=tuple(dict.fromkeys(map(str, assumptions))),
        lemmas=tuple(dict.fromkeys(link.lemma.name for link in inverse.links if link.lemma))
        or lemmas,
    )


def _method(inverse: Inverse, counts: Sequence[SolutionCount]) -> str:
    """How the solutions were counted, in words."""
    if isinstance(inverse.glue, Combination):
        because = inverse.glue.because
        return "lemma by lemma" + (f"; {because}" if because else "")
    if inverse.by_lemmas:
        return "lemma by lemma"
    return "step by step" if len(counts) > 1 else counts[0].method


def _require_all_branches(derivation: Derivation, inverse: Inverse, count: int, each: int) -> int:
    """The number of branches; raises if their solutions are not ``count``, ``each`` for a branch.

    The error names a posture that no branch reaches.
    """
    function = derivation[inverse.function]
    branches = len(function.branches) if function.branches else 1
    if count != branches * each:
        how = "step by step" if len(inverse.chained) > 1 else "from a Groebner basis"
        found = (
            f"the lemmas have {count} solutions together"
            if inverse.by_lemmas
            else f"the system has {count} solutions (counted {how})"
        )
        are = f"branch{'es are' if branches > 1 else ' is'} given"
        raise ProofError(
            f"{derivation.name}.{function.name}: {found}, but {branches} {are}"
            f"{f' for {each} solutions each' if each > 1 else ''}. "
            f"{uncovered(derivation, function, inverse)}".rstrip()
        )
    return branches


def _prove_steps_follow(derivation: Derivation, inverse: Inverse) -> tuple[str, ...]:
    """Prove that the equations in the article hold on the graph of the forward map."""
    graph = dict(zip(inverse.targets, inverse.forward, strict=True))
    lemmas = []
    for solved in derivation.solved:
        if solved.function != inverse.function or inverse.by_lemmas:
            continue
        fault = (
            f"{derivation.name}.{inverse.function}: the equation solved for {solved.unknown} by "
            f"the lemma {solved.lemma.name!r} does not follow from the forward map"
        )
        try:
            require_shape(solved.lemma, solved.equation, solved.unknown)
        except ShapeError as error:
            raise ProofError(f"{derivation.name}.{inverse.function}: {error}") from error
        posture = graph if solved.posture is None else solved.posture
        require(substitute(solved.equation, posture), (), fault)
        lemmas.append(solved.lemma.name)
    return tuple(dict.fromkeys(lemmas))


__all__ = ["InverseResult", "prove_inverse"]
