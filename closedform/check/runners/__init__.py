"""How printed code is run: one module a kind, found by the name that a back end gives.

A runner has a function ``run(name, derivation, folder, scratch)``, which yields a
:class:`closedform.check.crosscheck.Backend` for each way to call what the back end ``name`` printed
to ``folder``.  What it starts lives until the next is asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from closedform.check.crosscheck import Backend
    from closedform.model.derivation import Derivation

    Run = Callable[[str, Derivation, Path, Path], Iterator[Backend]]


def load(kind: str) -> Run:
    """The runner of this kind."""
    run: Run = import_module(f"{__name__}.{kind}").run
    return run
