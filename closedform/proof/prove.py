"""Proves a derivation: its steps, its inverses, the lemmas they use, and the claims of the paper.

Every proof uses the exact zero test of :mod:`closedform.algebra.normal_form` or a count of
solutions by a Groebner basis.  A step or an inverse that does not hold raises :class:`ProofError`;
a claim that does not hold gets its verdict.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import sympy as sp

from closedform.algebra import certificates
from closedform.algebra.normal_form import Undecided
from closedform.algebra.shapes import ShapeError, require_shape
from closedform.algebra.solutions import InfinitelyManyError, SolutionCount, count_solutions
from closedform.model.claims import NOT_DECIDABLE, VERDICTS
from closedform.model.derivation import Continuum, Derivation, Inverse
from closedform.model.functions import Function, real, substitute
from closedform.proof.chain import forget_counts, prove_chain
from closedform.proof.checks.solutions import forget_solutions
from closedform.proof.claims import (
    ClaimResult,
    ErratumResult,
    ReadingResult,
    erratum_result,
    judge,
    require_shown,
)
from closedform.proof.reduction import prove_reduction
from closedform.proof.require import ProofError, forget_decisions, require
from closedform.proof.witness import uncovered

Progress = Callable[[str], None]

MISSED = "the answer, put into the forward map, does not give the target"


@dataclass(frozen=True)
class InverseResult:
    """The proved facts about one inverse."""

    function: str
    branches: int
    continua: int
    solutions: int
    method: str
    assumptions: tuple[str, ...]
    lemmas: tuple[str, ...]


@dataclass(frozen=True)
class Proof:
    """All proved facts about one derivation, as plain data that can be stored."""

    name: str
    paper: str
    steps: tuple[str, ...]
    identities: int
    inverses: tuple[InverseResult, ...]
    claims: tuple[ClaimResult, ...] = field(default=())
    errata: tuple[ErratumResult, ...] = field(default=())
    without_inverse: str = ""

    def verdicts(self) -> dict[str, int]:
        """The number of claims for each verdict, in the order of :data:`VERDICTS`."""
        counts = Counter(c.kind for c in self.claims)
        return {kind: counts[kind] for kind in VERDICTS if counts[kind]}

    def summary(self) -> str:
        """One line about what was proved."""
        inverses = ", ".join(
            f"{i.function} {i.branches} branch{'es' if i.branches > 1 else ''} sound and complete"
            for i in self.inverses
        )
        claims = ", ".join(f"{n} {kind}" for kind, n in self.verdicts().items())
        parts = [f"{len(self.steps)} steps ({self.identities} identities)"]
        parts.append(inverses or self.outcome())
        return "; ".join(p for p in [*parts, f"claims: {claims}" if claims else ""] if p)

    def outcome(self) -> str:
        """The number of proved branches, or the reason why there is no inverse."""
        if not self.inverses:
            return f"no inverse, because {self.without_inverse or 'the script has none'}"
        alone = len(self.inverses) == 1
        counts = (
            f"{i.branches} branch{'es' if i.branches > 1 else ''}"
            + ("" if alone else f" of {i.function}")
            for i in self.inverses
        )
        return f"{', '.join(counts)} proved"

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Proof:
        return cls(
            data["name"],
            data["paper"],
            tuple(data["steps"]),
            data["identities"],
            tuple(
                InverseResult(
                    **{**i, "assumptions": tuple(i["assumptions"]), "lemmas": tuple(i["lemmas"])}
                )
                for i in data["inverses"]
            ),
            tuple(
                ClaimResult(**{**c, "readings": tuple(ReadingResult(**r) for r in c["readings"])})
                for c in data["claims"]
            ),
            tuple(ErratumResult(**e) for e in data["errata"]),
            data["without_inverse"],
        )


def prove(derivation: Derivation, progress: Progress = lambda _: None) -> Proof:
    """Prove every step and inverse of a derivation, and judge its claims."""
    if derivation.inverses and derivation.without_inverse:
        raise ProofError(
            f"{derivation.name}: the script gives an inverse, but says that there is none, because "
            f"{derivation.without_inverse}: remove the call of d.no_inverse"
        )
    forget_decisions()
    forget_counts()
    forget_solutions()

    def begin(what: str) -> None:
        progress(what)
        certificates.place(what)

    identities = 0
    for step in derivation.steps:
        begin(f"step: {step.title}")
        for difference in step.vanishes:
            fault = f"{derivation.name}, step {step.title!r}: the sides of an equation differ"
            require(difference, step.nonnegative, fault)
            identities += 1
    inverses = []
    for inverse in derivation.inverses:
        begin(f"inverse: {inverse.function}")
        inverses.append(prove_inverse(derivation, inverse))
    claims = []
    for claim in derivation.claims:
        begin(f"claim: {claim.label}")
        before = certificates.proofs()
        try:
            claims.append(judge(claim, derivation.errata))
        except (Undecided, ValueError) as error:
            raise ProofError(f"{derivation.name}, claim {claim.label}: {error}") from error
        except Exception as error:  # a check may call anything that its author wrote
            what = f"{type(error).__name__}: {error}"
            raise ProofError(f"{derivation.name}, claim {claim.label}: {what}") from error
        if certificates.proofs() == before and claims[-1].kind != NOT_DECIDABLE:
            certificates.lack("claims decided by enumeration or inequalities")
    require_shown(derivation.errata, claims)
    return Proof(
        derivation.name,
        derivation.paper.key,
        tuple(s.title for s in derivation.steps),
        identities,
        tuple(inverses),
        tuple(claims),
        tuple(map(erratum_result, derivation.errata)),
        derivation.without_inverse,
    )


def prove_inverse(derivation: Derivation, inverse: Inverse) -> InverseResult:
    """Prove that all branches satisfy the equations and that there are no other solutions."""
    function = derivation[inverse.function]
    if inverse.chain:
        return _prove_by_chain(derivation, function, inverse)
    if inverse.reduction:
        return _prove_by_reduction(derivation, function, inverse)
    assumptions = _prove_sound(derivation, function, inverse)
    for continuum in inverse.continua:
        _prove_continuum(derivation, function, inverse, continuum)
    lemmas = _prove_steps_follow(derivation, inverse)
    counts, method = _count(inverse)
    count = math.prod(c.count for c in counts)
    how = "step by step" if method == "step by step" else "from a Groebner basis"
    found = f"the system has {count} solutions (counted {how})"
    branches = _require_all_branches(derivation, function, inverse, count, found)
    certificates.add_inverse(function.name, branches, [(c.certificate, 0) for c in counts])
    return InverseResult(
        function.name,
        branches,
        len(inverse.continua),
        count,
        method,
        tuple(str(a) for a in assumptions),
        lemmas,
    )


def _require_all_branches(
    derivation: Derivation, function: Function, inverse: Inverse, count: int, found: str
) -> int:
    """The number of branches; raises if it is not ``count``, with a posture that is not covered."""
    branches = len(function.branches) if function.branches else 1
    if count != branches:
        raise ProofError(
            f"{derivation.name}.{function.name}: {found}, but {branches} "
            f"branch{'es are' if branches > 1 else ' is'} given. "
            f"{uncovered(derivation, function, inverse)}".rstrip()
        )
    return branches


def _prove_by_chain(derivation: Derivation, function: Function, inverse: Inverse) -> InverseResult:
    count, assumptions, continua = prove_chain(derivation, inverse)
    found = f"the lemmas have {count} solutions together"
    return InverseResult(
        function.name,
        _require_all_branches(derivation, function, inverse, count, found),
        continua,
        count,
        "lemma by lemma",
        tuple(str(a) for a in assumptions),
        tuple(dict.fromkeys(link.lemma.name for link in inverse.chain)),
    )


def _prove_by_reduction(
    derivation: Derivation, function: Function, inverse: Inverse
) -> InverseResult:
    branches, method, lemmas = prove_reduction(derivation, function, inverse)
    return InverseResult(function.name, branches, 0, branches, method, (), lemmas)


def _targets(inverse: Inverse) -> dict[sp.Symbol, sp.Expr]:
    """Dependent targets in terms of free parameters; empty if the targets are independent."""
    if not inverse.parametrisation:
        return {}
    return dict(zip(inverse.targets, inverse.parametrisation, strict=True))


def _prove_sound(
    derivation: Derivation, function: Function, inverse: Inverse
) -> tuple[sp.Expr, ...]:
    used: list[sp.Expr] = []
    given = _targets(inverse)
    for label, signs in function.cases():
        where = f"{derivation.name}.{function.name}, branch {label or 'only'}"
        found = _prove_case(function, inverse, _Case(signs, {}, {}, given, where))
        used += [a for a in found if a not in used]
    return tuple(used)


def _prove_continuum(
    derivation: Derivation, function: Function, inverse: Inverse, continuum: Continuum
) -> None:
    """Prove that a flagged case returns a solution on its locus."""
    for label, signs in function.cases():
        if continuum.branches and label not in continuum.branches:
            continue
        flags = dict.fromkeys((continuum.flag, *continuum.also), True)
        where = f"{derivation.name}.{function.name}, {continuum.flag}, branch {label}"
        locus = continuum.locus
        _prove_case(function, inverse, _Case(signs, flags, locus, locus, where))


@dataclass(frozen=True)
class _Case:
    """A branch of an inverse with some flags true, on a locus; ``given`` replaces its targets."""

    signs: Mapping[sp.Symbol, int]
    flags: Mapping[sp.Symbol, bool]
    locus: Mapping[sp.Symbol, sp.Expr]
    given: Mapping[sp.Symbol, sp.Expr]
    where: str


def _prove_case(function: Function, inverse: Inverse, case: _Case) -> tuple[sp.Expr, ...]:
    """Prove that the outputs satisfy the equations; return the assumptions."""
    outputs = [e for a in function.outputs for e in a.entries]
    solved = dict(zip(inverse.unknowns, outputs, strict=True))
    values = function.at(case.signs, case.flags, case.locus)
    solution = dict(zip(solved, values, strict=True))
    difference = sp.Matrix(
        [substitute(substitute(e, solution), case.given) for e in inverse.equations]
    )
    bounds = tuple(substitute(b, case.given) for b in function.bounds(case.signs))
    return require(difference, bounds, f"{case.where}: {MISSED}", _names_of(inverse)).assumptions


def _names_of(inverse: Inverse) -> list[str]:
    """The name of each equation of an inverse, to tell a user which one fails."""
    names = []
    for k, x in enumerate(inverse.targets, 1):
        name = str(x) if isinstance(x, sp.Symbol) else f"equation {k}"
        names += [f"cos({name})", f"sin({name})"] if x in inverse.angles else [name]
    return names


def _prove_steps_follow(derivation: Derivation, inverse: Inverse) -> tuple[str, ...]:
    """Prove that the equation of each lemma holds on the graph of the forward map."""
    graph = dict(zip(inverse.targets, inverse.forward, strict=True))
    lemmas = []
    for solved in derivation.solved:
        if solved.function != inverse.function:
            continue
        fault = (
            f"{derivation.name}.{inverse.function}: the equation solved for {solved.unknown} by "
            f"the lemma {solved.lemma.name!r} does not follow from the forward map"
        )
        try:
            require_shape(solved.lemma.name, solved.equation, solved.unknown)
        except ShapeError as error:
            raise ProofError(f"{derivation.name}.{inverse.function}: {error}") from error
        posture = graph if solved.posture is None else solved.posture
        require(substitute(solved.equation, posture), (), fault)
        lemmas.append(solved.lemma.name)
    return tuple(dict.fromkeys(lemmas))


def _count(inverse: Inverse) -> tuple[list[SolutionCount], str]:
    if inverse.stages:
        return _count_in_stages(inverse), "step by step"
    given = _targets(inverse)
    equations = []
    for equation in (substitute(e, given) for e in inverse.equations):
        if equation.has(*inverse.unknowns):
            equations.append(equation)
        else:
            fault = f"{inverse.function}: an equation without unknowns does not hold"
            require(equation, (), fault)
    squares = {u: sp.sqrt(real(f"{u}_squared")) for u in inverse.nonnegative}
    equations = [sp.expand(e).xreplace({u**2: s**2 for u, s in squares.items()}) for e in equations]
    if odd := [u for u in squares if any(e.has(u) for e in equations)]:
        raise ProofError(
            f"{inverse.function}: the equations hold {odd[0]} itself, not its square alone, so its "
            f"sign matters; take it out of nonnegative"
        )
    unknowns = [s**2 for s in squares.values()]
    unknowns += [u for u in inverse.unknowns if u not in squares]
    try:
        counted = count_solutions(equations, unknowns)
    except InfinitelyManyError as error:
        raise ProofError(f"{inverse.function}: {error}") from error
    return [counted], counted.method


def _count_in_stages(inverse: Inverse) -> list[SolutionCount]:
    """The counts, which multiply, each over the field of the inputs and the earlier unknowns."""
    where = f"{inverse.function}: the stages of the count"
    used = [i for stage in inverse.stages for i in stage.equations]
    solved = [u for stage in inverse.stages for u in stage.unknowns]
    if sorted(used) != list(range(len(inverse.equations))) or set(solved) != set(inverse.unknowns):
        raise ProofError(f"{where} do not take every equation and every unknown exactly once")
    counts, before = list[SolutionCount](), 0
    for k, stage in enumerate(inverse.stages):
        equations = [substitute(inverse.equations[i], stage.given) for i in stage.equations]
        depends = [s for s in inverse.stages[:k] if any(e.has(*s.unknowns) for e in equations)]
        for i in (i for s in depends for i in s.equations):
            earlier = substitute(inverse.equations[i], stage.given)
            fault = f"{where}: what stage {k + 1} is given does not satisfy an earlier equation"
            require(earlier, (), fault)
        before += len(stage.unknowns)
        if any(e.has(*solved[before:]) for e in equations if solved[before:]):
            raise ProofError(f"{where}: an equation holds an unknown of a later stage")
        constant = [e for e in equations if not e.has(*stage.unknowns)]
        if constant:
            require(sp.Matrix(constant), (), f"{where}: an equation without unknowns does not hold")
        try:
            turning = [e for e in equations if e.has(*stage.unknowns)]
            counts.append(count_solutions(turning, stage.unknowns))
        except InfinitelyManyError as error:
            raise ProofError(f"{where}: {error}") from error
    return counts
