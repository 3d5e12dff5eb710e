"""Proves a derivation: its steps, its inverses, the lemmas they use, and the claims of the paper.

Every proof uses the exact zero test of :mod:`closedform.algebra.normal_form` or a count of
solutions by a Groebner basis.  A step or an inverse that does not hold raises :class:`ProofError`;
a claim that does not hold gets its verdict.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from closedform.algebra import certificates
from closedform.algebra.normal_form import Undecided
from closedform.model.claims import NOT_DECIDABLE, VERDICTS
from closedform.model.derivation import Derivation
from closedform.proof.checks.solutions import forget_solutions
from closedform.proof.claims import (
    ClaimResult,
    ErratumResult,
    ReadingResult,
    erratum_result,
    judge,
    require_shown,
)
from closedform.proof.inverse import InverseResult, prove_inverse
from closedform.proof.links import forget_counts
from closedform.proof.require import ProofError, forget_decisions, require

Progress = Callable[[str], None]


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
        parts.append(inverses if inverses and not self.without_inverse else self.outcome())
        return "; ".join(p for p in [*parts, f"claims: {claims}" if claims else ""] if p)

    def outcome(self) -> str:
        """The number of proved branches, or the reason why there is no inverse."""
        none = f"no inverse, because {self.without_inverse or 'the script has none'}"
        if not self.inverses:
            return none
        alone = len(self.inverses) == 1
        counts = (
            f"{i.branches} branch{'es' if i.branches > 1 else ''}"
            + ("" if alone else f" of {i.function}")
            for i in self.inverses
        )
        return f"{', '.join(counts)} proved" + f"; {none}" * bool(self.without_inverse)

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
    given = [i for i in derivation.inverses if derivation[i.function].result == "Solutions"]
    if given and derivation.without_inverse:
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
        name=derivation.name,
        paper=derivation.paper.key,
        steps=tuple(s.title for s in derivation.steps),
        identities=identities,
        inverses=tuple(inverses),
        claims=tuple(claims),
        errata=tuple(map(erratum_result, derivation.errata)),
        without_inverse=derivation.without_inverse,
    )
