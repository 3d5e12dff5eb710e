"""The rotation that is left to the last joints, as the product of two matrices.

A program turns the rotation of the target joint by joint, entry by entry.  If a step of the
derivation has the matrix by which it is turned, a reader multiplies by that.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import permutations

import sympy as sp

from closedform.emit.backends.latex.names import MATRIX_ENTRY
from closedform.model.expressions import substitute
from closedform.model.functions import Bound, Function, Let, Statement, Vanishes

Place = tuple[int, tuple[int, int]]
"""The sign, the row and the column of an entry."""
LETTER = "R'"
"""What the product is called."""


class Entry(sp.Symbol):  # type: ignore[misc]
    """An entry of the product."""


def is_turned(symbol: sp.Basic) -> bool:
    return isinstance(symbol, Entry)


@dataclass(frozen=True)
class Product:
    """A function with a product of rotations in place of the entries of its matrices."""

    function: Function
    names: Mapping[sp.Basic, sp.Basic]
    """What stands for the former entries."""
    letters: Mapping[sp.Symbol, str]
    """How the entries of the product are written, row by row."""
    text: str
    """The product, in LaTeX."""


def product(
    function: Function,
    rotations: Mapping[str, sp.MatrixBase],
    angles: Mapping[sp.Basic, sp.Expr],
) -> Product | None:
    """The product that the function needs, if its factors are one or two of the ``rotations``.

    ``angles`` writes those of the rotations as the function does, where that differs.
    """
    target = next((a for a in function.inputs if a.shape == (4, 4)), None)
    found = _Entries(function)
    if target is None or not found.outside:
        return None
    R = sp.Matrix(3, 3, [target.entries[4 * i + j] for i in range(3) for j in range(3)])
    known = {n: S.xreplace(dict(angles)) for n, S in rotations.items()}
    factors: list[tuple[tuple[str, ...], sp.MatrixBase]] = [((n,), S) for n, S in known.items()]
    factors += [((m, n), known[m] * known[n]) for m, n in permutations(known, 2)]
    for names, S in factors:
        turned = " ".join(f"{n}^T" for n in reversed(names))
        for value, text in ((S.T * R, f"{turned} R"), (R * S.T, rf"R\,{turned}")):
            if places := found.among(value):
                return found.replaced(value, places, rf"{LETTER} = {text}")
    return None


class _Entries:
    """The names of the entries of matrices in a function, and their values in the target."""

    def __init__(self, function: Function):
        self.function = function
        flags = {s.symbol: sp.false for s in function.body if isinstance(s, Vanishes)}
        lets = [s for s in function.body if isinstance(s, Let | Bound)]
        values = {s.symbol: substitute(s.value, flags) for s in lets}
        named = {n: e for n, e in values.items() if MATRIX_ENTRY.fullmatch(str(n.name))}
        own = {s for a in function.inputs for s in a.entries} | named.keys()
        self.values = {
            n: e
            for n, e in named.items()
            if not e.as_coeff_Mul()[1].is_Symbol or e.free_symbols <= own
        }
        needed = {s for a in function.outputs for e in a.entries for s in e.free_symbols}
        for statement in reversed(lets):
            used = statement.symbol in needed or isinstance(statement, Bound)
            if used and statement.symbol not in self.values:
                needed |= values[statement.symbol].free_symbols
        self.outside = [n for n in self.values if n in needed]

    def among(self, matrix: sp.MatrixBase) -> dict[sp.Basic, Place]:
        """Which entry of a matrix each name is; nothing if one that is needed is none of them."""
        places = {sp.expand(matrix[i, j]): (i, j) for i in range(3) for j in range(3)}
        signed = {e: (1, place) for e, place in places.items()}
        signed |= {-e: (-1, place) for e, place in places.items()}
        found = {}
        for name in [*self.outside, *(n for n in self.values if n not in self.outside)]:
            value = self.values[name]
            while value.free_symbols & self.values.keys():
                value = substitute(value, self.values)
            place = signed.get(sp.expand(value))
            if place is not None:
                found[name] = place
            elif name in self.outside:
                return {}
        return found

    def replaced(
        self,
        matrix: sp.MatrixBase,
        places: Mapping[sp.Basic, Place],
        text: str,
    ) -> Product:
        entries = {
            (i, j): Entry(f"turned_{i + 1}{j + 1}", real=True) for i in range(3) for j in range(3)
        }
        names = {n: sign * entries[place] for n, (sign, place) in places.items()}
        body: list[Statement] = []
        last = max(self.outside, key=list(self.values).index)
        for statement in self.function.body:
            name = getattr(statement, "symbol", None)
            if name == last:
                body += [Let(e, matrix[i, j]) for (i, j), e in entries.items()]
            if name not in self.values:
                body.append(_renamed(statement, names))
        outputs = tuple(
            replace(a, entries=tuple(substitute(e, names) for e in a.entries))
            for a in self.function.outputs
        )
        letters = {e: rf"R^{{\prime}}_{{{i + 1}{j + 1}}}" for (i, j), e in entries.items()}
        function = replace(self.function, body=tuple(body), outputs=outputs)
        return Product(function, names, letters, text)


def _renamed(statement: Statement, names: Mapping[sp.Basic, sp.Basic]) -> Statement:
    changes = {
        name: substitute(value, names)
        for name in ("value", "scale")
        if isinstance(value := getattr(statement, name, None), sp.Expr)
    }
    return replace(statement, **changes) if changes else statement


__all__ = ["Product", "is_turned", "product"]
