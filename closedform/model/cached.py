"""What is made of the same objects is made once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")

KEPT = 32
"""The number of results that are kept for the next back end, such as those of one mechanism."""


def cached(make: Callable[..., T]) -> Callable[..., T]:
    """Make something once for the same objects, which need not be hashable."""
    made: dict[tuple[int, ...], tuple[tuple[Any, ...], T]] = {}

    def find(*arguments: Any) -> T:
        key = tuple(map(id, arguments))
        if key not in made:
            if len(made) >= KEPT:
                del made[next(iter(made))]
            made[key] = arguments, make(*arguments)
        return made[key][1]

    return find


__all__ = ["KEPT", "cached"]
