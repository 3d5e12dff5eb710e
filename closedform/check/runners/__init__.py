"""How printed code is run: one module for each kind, named by the back ends.

A runner has a function ``run(name, derivation, folder, scratch)``, which yields a
:class:`closedform.check.crosscheck.Backend` for each way to call what the back end ``name`` printed
to ``folder``; there it calls a function by its name, with an array for each input, whose leading
axis is that of the postures, and a tuple of parameters.  What it starts lives until the next is
asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from closedform.model.functions import Function

if TYPE_CHECKING:
    from closedform.check.finding import Backend
    from closedform.model.derivation import Derivation

    Run = Callable[[str, Derivation, Path, Path], Iterator[Backend]]


def load(kind: str) -> Run:
    """The runner of this kind."""
    run: Run = import_module(f"{__name__}.{kind}").run
    return run


def shaped(function: Function, rows: NDArray[Any]) -> Any:
    """The results as the cross-check takes them, from a row of all their numbers for each posture.

    A single result is an array, several are a tuple.
    """
    lead = rows.shape[:1] if function.inputs else ()
    each = (*lead, len(function.branches)) if function.branches else lead
    kind = np.bool_ if function.boolean else np.float64
    results = [((*each, *map(int, a.shape)), kind) for a in function.outputs]
    if function.has_status:
        results.append((each, np.uint8))
    sizes = [prod(shape) // len(rows) for shape, _ in results]
    parts = np.split(rows, np.cumsum(sizes)[:-1], axis=1)
    found: list[Any] = [
        p.reshape(shape).astype(k) for p, (shape, k) in zip(parts, results, strict=True)
    ]
    return found[0] if len(found) == 1 else tuple(found)
