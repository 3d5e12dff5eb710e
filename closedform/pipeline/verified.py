"""Checks the certificates that proofs have left, without repeating the proofs."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from closedform.pipeline.run import Report
from closedform.pipeline.scripts import Source, digest
from closedform.pipeline.store import Store
from closedform.pipeline.workers import each


@dataclass(frozen=True)
class Verified:
    """The result for one mechanism; ``failure`` is empty if every certificate is right."""

    name: str
    identities: int = 0
    completeness: int = 0
    points: int = 0
    """Refutations and ranks: what differs from zero at a point."""
    missing: Mapping[str, int] = field(default_factory=dict)
    """Reasons why proofs have no certificate, with their number."""
    failure: str = ""

    def line(self, width: int = 0) -> str:
        name = f"{self.name:<{width}}  "
        if self.failure:
            return f"{name}FAILED: {self.failure}"
        reasons = ", ".join(f"{n} {reason}" for reason, n in self.missing.items())
        return (
            f"{name}{self.identities:3} identities, {self.completeness:2} completeness proofs, "
            f"{self.points:2} refutations and ranks"
            f"; not exported: {reasons or 'none'}"
        )


def verify(source: Source, store: Store, report: Report) -> Verified:
    """Check the certificates of one script."""
    from closedform.verify import Refused, check

    report(source.name, "verifying")
    again = f"run closedform derive {source.name}"
    try:
        proof = store.read(source)
        content = store.certificates(source).read_bytes()
    except (OSError, ValueError):
        return Verified(source.name, failure=f"its proof or its certificates are missing; {again}")
    if proof.get("digest") != digest(source):
        return Verified(source.name, failure=f"what it depends on has changed; {again}")
    try:
        if proof["certificates"] != hashlib.sha256(content).hexdigest():
            raise Refused("the file is not the one that the proof wrote")
        document = json.loads(content)
        _require_all(document, source.name, proof)
        check(document)
    except (LookupError, TypeError, ValueError) as error:
        return Verified(source.name, failure=str(error))
    kinds = Counter(certificate["kind"] for certificate in document["certificates"])
    identities, points = kinds.pop("identity", 0), kinds.pop("point", 0)
    missing = {**document["not exported"]}
    missing |= {f"inverse ({f})": 1 for f in document["inverses not exported"]}
    return Verified(source.name, identities, kinds.total(), points, missing)


def _require_all(document: Mapping[str, Any], name: str, proof: Mapping[str, Any]) -> None:
    """The certificates belong to the proof, and every inverse that it lists has one."""
    from closedform.verify import require

    require(document["name"] == name, "the certificates are those of another mechanism")
    require(document["digest"] == proof["digest"], "the certificates are those of another proof")
    certified = {
        c["function"]: c["branches"] for c in document["certificates"] if c["kind"] == "inverse"
    }
    for inverse in proof["proof"]["inverses"]:
        function = inverse["function"]
        if function not in document["inverses not exported"]:
            same = certified.get(function) == inverse["branches"]
            require(same, f"no certificate says how many branches {function} has")


def verify_all(chosen: Sequence[Source], store: Store, jobs: int, report: Report) -> list[Verified]:
    """Check the certificates of all chosen scripts, in processes."""
    if jobs == 1 or len(chosen) < 2:
        return [verify(source, store, report) for source in chosen]
    job = partial(verify, store=store)
    outcomes: dict[str, Verified] = {}
    for source, outcome in each(job, chosen, min(jobs, len(chosen)), report):
        if isinstance(outcome, Exception):
            raise outcome
        outcomes[source.name] = outcome
        report(source.name, "")
    return [outcomes[source.name] for source in chosen]
