"""More memory for less computing time: the settings of a process that does long algebra."""

import gc
import os

CACHED = 50_000
"""Results that SymPy remembers of each of its functions; its 1000 are lost before they recur."""
YOUNG, MIDDLE, OLD = 50_000, 20, 100
"""New objects after which Python looks for cycles, of which expressions have few."""


def spend_memory() -> None:
    """Apply the settings to this process and those that it starts; call it before SymPy loads."""
    os.environ.setdefault("SYMPY_CACHE_SIZE", str(CACHED))
    gc.set_threshold(YOUNG, MIDDLE, OLD)


__all__ = ["spend_memory"]
