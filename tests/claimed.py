"""The claims of each mechanism with their verdicts, which are judged once for all tests."""

from collections.abc import Mapping
from functools import cache

from closedform.model.claims import Claim
from closedform.model.derivation import Derivation
from closedform.pipeline.scripts import find, load
from closedform.pipeline.store import default_store
from closedform.proof.claims import ClaimResult, judge


@cache
def derivation(name: str) -> Derivation:
    (source,) = find([name])
    return load(source)


@cache
def claims(name: str) -> Mapping[str, Claim]:
    """The claims by their labels."""
    return {c.label: c for c in derivation(name).claims}


def result(name: str, label: str) -> ClaimResult:
    """The verdict of a claim: from the stored proof, unless something has changed since."""
    return _stored(name).get(label) or _judged(name, label)


def results(name: str) -> dict[str, ClaimResult]:
    """The verdicts of all claims."""
    return _stored(name) or {label: _judged(name, label) for label in claims(name)}


@cache
def _stored(name: str) -> dict[str, ClaimResult]:
    (source,) = find([name])
    kept = default_store().get(source)
    return {c.label: c for c in kept[0].claims} if kept else {}


@cache
def _judged(name: str, label: str) -> ClaimResult:
    return judge(claims(name)[label], derivation(name).errata)
