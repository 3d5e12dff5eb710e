"""The files that the back ends print."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from closedform.emit.backend import Files, Mechanism
from closedform.emit.backends import load, names
from closedform.model.derivation import Derivation
from closedform.proof.prove import Proof

Share = Mapping[str, Any]
"""The contribution of one mechanism to the shared files, by back end."""


@dataclass(frozen=True)
class Printed:
    """The files of one mechanism, and its contribution to shared files."""

    files: Files
    share: Share


def pages(derivation: Derivation, proof: Proof, backends: Sequence[str] = names()) -> Printed:
    """Print one mechanism."""
    mechanism = Mechanism(derivation, proof)
    printed = {name: load(name).pages(mechanism) for name in backends}
    return Printed(
        {path: text for own in printed.values() for path, text in own.files.items()},
        {name: own.share for name, own in printed.items()},
    )


def shared_files(shares: Sequence[Share], backends: Sequence[str] = names()) -> Files:
    """The files that all mechanisms share, from what each of them reported."""
    printed: Files = {}
    for name in backends:
        printed |= load(name).shared([share[name] for share in shares])
    return printed


def standalone(printed: Files) -> Files:
    """Without the files that only work inside the Python package."""
    backends = names()
    return {
        path: text
        for path, text in printed.items()
        if path.parts[0] not in backends or load(path.parts[0]).works_alone(path)
    }
