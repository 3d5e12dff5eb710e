"""Proves a link of an inverse: its solutions satisfy its equations, and there are no others.

The solutions of a link with a lemma are those of the lemma, with its coefficients as free symbols,
so for all their values.  Those of a link without one are what the function returns.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import sympy as sp

from closedform.algebra.solutions import InfinitelyManyError, SolutionCount, count_solutions
from closedform.model.expressions import substitute
from closedform.model.functions import Bound, Function, Let, Statement, explicit, real
from closedform.model.inverse import Degenerate, Inverse, Link
from closedform.proof.posture import outcomes
from closedform.proof.require import ProofError, require

Expr = Any

MISSED = "the answer, put into the forward map, does not give the target"


@dataclass(frozen=True)
class Answers:
    """The solutions of some unknowns, as a program: one of each branch."""

    solution: Mapping[Expr, Expr]
    body: tuple[Statement, ...]
    branches: tuple[tuple[str, Mapping[Expr, int]], ...]
    means: Mapping[Expr, Expr] = field(default_factory=dict)

    @classmethod
    def of_lemma(cls, link: Link, signs: Sequence[Expr]) -> Answers:
        """The solutions of a lemma; the ``signs`` in its coefficients stay symbols."""
        assert link.lemma is not None
        own = dict.fromkeys([*link.lemma.signs, *signs])
        used = {s for e in (*link.lemma.solution.values(), *link.means) for s in e.free_symbols}
        used |= {s for e in _values(link.body) for s in e.free_symbols}
        chosen = [s for s in own if s in used]
        cases = (dict(zip(chosen, v, strict=True)) for v in product((1, -1), repeat=len(chosen)))
        named = tuple(("", signs) for signs in cases)
        return cls(link.lemma.solution, link.body, named, link.means)

    @classmethod
    def of_function(cls, function: Function, unknowns: Sequence[Expr]) -> Answers:
        """The solutions that a function returns for its ``unknowns``."""
        outputs = [e for a in function.outputs for e in a.entries]
        solution = dict(zip(unknowns, outputs, strict=True))
        branches = tuple((label or "only", signs) for label, signs in function.cases())
        return cls(solution, function.body, branches)


def _values(body: Sequence[Statement]) -> Iterator[Expr]:
    return (s.value for s in body if isinstance(s, Let | Bound))


def prove_sound(
    answers: Answers,
    equations: Sequence[Expr],
    cases: Sequence[Degenerate],
    given: Mapping[Expr, Expr],
    fault: str,
    *,
    names: Sequence[str] = (),
) -> list[Expr]:
    """Prove that answers satisfy equations in every branch and case.

    Returns the assumptions of the generic case.

    Parameters
    ----------
    answers
        the values of the unknowns in each branch
    equations
        what they must satisfy
    cases
        the degenerate ones
    given
        what the equations contain, in free symbols
    fault
        the message of an error, with braces where the branch or the case goes
    names
        those of the equations
    """
    found: list[Expr] = []
    for case in (None, *cases):
        for label, signs in answers.branches:
            if case and case.branches and label not in case.branches:
                continue
            locus = given if case is None else case.locus
            flags = dict.fromkeys(case.flags, sp.true) if case else {}
            known = {**signs, **flags, **(locus if case else {})}
            exprs = [*answers.solution.values(), *answers.means]
            values, bounds = explicit(answers.body, exprs, known)
            solution = dict(zip(answers.solution, values, strict=False))
            residues = [substitute(e, solution) for e in equations]
            residues += [
                value - substitute(meaning, solution)
                for value, meaning in zip(
                    values[len(solution) :], answers.means.values(), strict=True
                )
            ]
            place = fault.replace("{}", _where(label, case))
            both = sp.ImmutableMatrix([substitute(e, locus) for e in (*residues, *bounds)])
            for side in outcomes(both):
                vanishing, guards = side[: len(residues)], side[len(residues) :]
                decision = require(sp.ImmutableMatrix(vanishing), tuple(guards), place, names)
                found += decision.assumptions if case is None else ()
    return list(dict.fromkeys(found))


def _where(label: str, case: Degenerate | None) -> str:
    branch = f", branch {label}" if label else ""
    if case is None:
        return branch
    return f"{branch}, if {case.meaning.rstrip('.') or ', '.join(map(str, case.flags))}"


def prove_lemma(link: Link, signs: Sequence[Expr], where: str) -> tuple[list[Expr], SolutionCount]:
    """Prove that a lemma gives all solutions of its equations, and no others.

    ``signs`` are those of the branches of the inverse.  Returns the assumptions and the count.
    """
    lemma = link.lemma
    assert lemma is not None
    fault = (
        f"{where}what the lemma {lemma.name!r} gives for {_listed(link.unknowns)} does not satisfy "
        f"its equations{{}}"
    )
    answers = Answers.of_lemma(link, signs)
    found = prove_sound(answers, link.equations, link.degenerate, link.given, fault)
    try:
        counted = _count(link)
    except InfinitelyManyError as error:
        raise ProofError(f"{where}the lemma {lemma.name!r}: {error}") from error
    if counted.count != lemma.branches + lemma.excluded:
        raise ProofError(
            f"{where}the equations of the lemma {lemma.name!r} for {_listed(link.unknowns)} have "
            f"{counted.count} solutions, but {lemma.branches} branches are given; it is applied to "
            f"equations of another shape"
        )
    return found, counted


def _listed(unknowns: Sequence[Expr]) -> str:
    return ", ".join(map(str, unknowns))


_counted: dict[Any, SolutionCount] = {}


def forget_counts() -> None:
    """Forget all counts, so that the certificates of a mechanism are complete."""
    _counted.clear()


def _count(link: Link) -> SolutionCount:
    """The solutions of a lemma; equal lemmas of an inverse are counted once."""
    given = {s: e for s, e in link.given.items() if any(q.has(s) for q in link.equations)}
    equations = tuple(e for e in link.equations if e.xreplace(given) != 0)
    key = (equations, link.unknowns, tuple(given.items()))
    if key not in _counted:
        _counted[key] = count_solutions(equations, link.unknowns, target_substitution=given)
    return _counted[key]


def prove_system(function: Function, inverse: Inverse, where: str) -> list[Expr]:
    """Prove that the answers of a function satisfy all equations of the links without a lemma."""
    alone = [link for link in inverse.chained if link.lemma is None]
    given = alone[0].given if len(alone) == 1 else {}
    return prove_sound(
        Answers.of_function(function, inverse.unknowns),
        [e for link in alone for e in link.equations],
        inverse.degenerate,
        given,
        f"{where}{{}}: {MISSED}",
        names=_names_of(inverse),
    )


def _names_of(inverse: Inverse) -> list[str]:
    """The name of each equation of an inverse, to tell a user which one fails."""
    names = []
    for k, x in enumerate(inverse.targets, 1):
        name = str(x) if isinstance(x, sp.Symbol) else f"equation {k}"
        names += [f"cos({name})", f"sin({name})"] if x in inverse.angles else [name]
    return names


def count_system(inverse: Inverse) -> list[SolutionCount]:
    """The counts of the links without a lemma, which multiply.

    Each is over the field of the inputs and the unknowns of the links before.
    """
    links = [link for link in inverse.chained if link.lemma is None]
    return [_count_alone(inverse, links, k) for k in range(len(links))]


def _count_alone(inverse: Inverse, links: Sequence[Link], k: int) -> SolutionCount:
    """The solutions of a link, for the unknowns of the links before it."""
    link, where = links[k], inverse.function + (f", link {k + 1}" if len(links) > 1 else "")
    equations = [substitute(e, link.given) for e in link.equations]
    _require_earlier(equations, link.given, links[:k], where)
    if any(_has(equations, other.unknowns) for other in links[k + 1 :]):
        raise ProofError(f"{where}: an equation contains an unknown of a later link")
    constant = [e for e in equations if not e.has(*link.unknowns)]
    if constant:
        require(sp.Matrix(constant), (), f"{where}: an equation without unknowns does not hold")
    turning = [e for e in equations if e.has(*link.unknowns)]
    lengths = [u for u in link.unknowns if u in inverse.nonnegative]
    turning, squares = _in_squares(turning, lengths, where)
    try:
        return count_solutions(turning, [*squares, *(u for u in link.unknowns if u not in lengths)])
    except InfinitelyManyError as error:
        raise ProofError(f"{where}: {error}") from error


def _has(equations: Sequence[Expr], unknowns: Sequence[Expr]) -> bool:
    return any(e.has(*unknowns) for e in equations)


def _require_earlier(
    equations: Sequence[Expr], given: Mapping[Expr, Expr], links: Sequence[Link], where: str
) -> None:
    """Prove that the given expressions of a link satisfy the earlier links it depends on."""
    for other in links:
        if _has(equations, other.unknowns):
            earlier = sp.Matrix([substitute(e, given) for e in other.equations])
            fault = f"{where}: what the link is given does not satisfy an earlier equation"
            require(earlier, (), fault)


def _in_squares(
    equations: Sequence[Expr], lengths: Sequence[Expr], where: str
) -> tuple[list[Expr], list[Expr]]:
    """Equations in the squares of lengths, whose signs do not count, and these squares."""
    roots = {u: sp.sqrt(real(f"{u}_squared")) for u in lengths}
    squared = {u**2: s**2 for u, s in roots.items()}
    found = [sp.expand(e).xreplace(squared) for e in equations]
    if odd := [u for u in lengths if _has(found, [u])]:
        raise ProofError(
            f"{where}: the equations contain {odd[0]} itself, not its square alone, so its sign "
            f"matters; take it out of nonnegative"
        )
    return found, list(squared.values())


__all__ = ["Answers", "count_system", "forget_counts", "prove_lemma", "prove_sound", "prove_system"]
