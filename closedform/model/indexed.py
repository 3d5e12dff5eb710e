"""The values of a printed name with a free index, such as ``\\xi_i``: one for each index."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class Indexed:
    """A value for each of some indices; sums and products are taken index by index.

    ``at`` computes the value at one index when it is asked for.
    """

    _op_priority = 100.0  # SymPy's matrices then leave a product to this class
    shape = ("indexed",)

    def __init__(self, indices: tuple[int, ...], at: Callable[[int], Any]):
        self.indices = indices
        self.at = at

    def map(self, function: Callable[[Any], Any]) -> Indexed:
        """The function of each value."""
        return Indexed(self.indices, lambda k: function(self.at(k)))

    def _with(self, other: Any, join: Callable[[Any, Any], Any]) -> Indexed:
        return Indexed(self.indices, lambda k: join(self.at(k), at_index(other, k)))

    def __add__(self, other: Any) -> Indexed:
        return self._with(other, lambda a, b: a + b)

    def __radd__(self, other: Any) -> Indexed:
        return self._with(other, lambda a, b: b + a)

    def __mul__(self, other: Any) -> Indexed:
        return self._with(other, lambda a, b: a * b)

    def __rmul__(self, other: Any) -> Indexed:
        return self._with(other, lambda a, b: b * a)


def at_index(value: Any, index: int) -> Any:
    """The value at an index; a value without an index is the same at all of them."""
    return value.at(index) if isinstance(value, Indexed) else value
