"""Parts of a mechanism that are alike, such as the equal legs of a robot: one stands for each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from itertools import takewhile
from typing import Any, TypeVar

import sympy as sp

_T = TypeVar("_T")
INDEX = "i"


@dataclass(frozen=True)
class Alike:
    """Parts that differ in the names of their symbols alone.

    ``symbols`` has a row for each part, and corresponding symbols stand below each other.  What
    holds of a part in its own symbols holds of part i in the symbols of :attr:`any_part`.
    """

    kind: str
    """What the parts are: ``leg``."""
    symbols: tuple[tuple[sp.Symbol, ...], ...]

    @property
    def any_part(self) -> tuple[sp.Symbol, ...]:
        """The symbols of part i: ``theta_i`` for ``theta1``, ``theta2`` and ``theta3``."""
        return tuple(map(with_index, zip(*self.symbols, strict=True)))

    def names(self, part: int) -> dict[sp.Symbol, sp.Symbol]:
        """The symbols of part i for those of a part."""
        return dict(zip(self.symbols[part], self.any_part, strict=True))


def with_index(symbols: Sequence[sp.Symbol]) -> sp.Symbol:
    """One symbol for several that differ in a number, which gives way to the index."""
    names = [str(s.name) for s in symbols]
    stem = _shared_start(names)
    after = _shared_start([name[len(stem) :][::-1] for name in names])[::-1]
    return sp.Symbol(f"{stem.rstrip('_')}_{INDEX}{after}", **symbols[0].assumptions0)


def _shared_start(texts: Sequence[str]) -> str:
    columns = takewhile(lambda letters: len(set(letters)) == 1, zip(*texts, strict=False))
    return "".join(letters[0] for letters in columns)


def renamed(value: _T, names: Mapping[sp.Symbol, sp.Symbol]) -> _T:
    """The same expression, record or collection with other symbols."""
    found: Any = value
    if isinstance(value, sp.Basic | sp.MatrixBase):
        found = value.xreplace(names)
    elif isinstance(value, tuple | list):
        found = type(value)(renamed(v, names) for v in value)
    elif isinstance(value, Mapping):
        found = {renamed(k, names): renamed(v, names) for k, v in value.items()}
    elif is_dataclass(value) and not isinstance(value, type):
        changed = {f.name: renamed(getattr(value, f.name), names) for f in fields(value)}
        found = replace(value, **changed)
    return found  # type: ignore[no-any-return]


def symbols_in(value: Any) -> set[sp.Symbol]:
    """The symbols in an expression, a record or a collection."""
    if isinstance(value, sp.Basic | sp.MatrixBase):
        return set(value.free_symbols)
    parts: Sequence[Any] = value if isinstance(value, tuple | list) else ()
    if is_dataclass(value):
        parts = [getattr(value, f.name) for f in fields(value)]
    return set().union(*map(symbols_in, parts))


def alike(
    kind: str, parts: Sequence[Any], declared: Sequence[sp.Symbol], more: Sequence[sp.Symbol]
) -> Alike | None:
    """The symbols of records that differ in these alone; ``more`` has a further one for each.

    Symbols correspond if they are in the same place among those ``declared``.
    """
    found = [symbols_in(part) for part in parts]
    shared = set.intersection(*found)
    own = [tuple(s for s in declared if s in held - shared) for held in found]
    distinct = len({s for symbols in own for s in symbols}) == sum(map(len, own))
    if len({len(symbols) for symbols in own}) > 1 or len(parts) < 2 or not distinct:
        return None
    result = Alike(kind, tuple((*s, sign) for s, sign in zip(own, more, strict=True)))
    told = [renamed(part, result.names(k)) for k, part in enumerate(parts)]
    return result if all(part == told[0] for part in told) else None


__all__ = ["INDEX", "Alike", "alike", "renamed", "symbols_in", "with_index"]
