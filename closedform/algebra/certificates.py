"""Writes certificates of proofs, for :mod:`closedform.verify`.

While a :func:`recording` is open, every identity that :func:`closedform.algebra.normal_form.decide`
proves and every count of :func:`closedform.algebra.solutions.count_solutions` is added to it.
docs/certificates.md describes the format.
"""

from __future__ import annotations

import contextlib
import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextvars import ContextVar
from typing import Any, TypeAlias

import sympy as sp
from flint import fmpq_mpoly
from sympy.core.function import AppliedUndef

from closedform import verify
from closedform.algebra.basis import logged_basis
from closedform.algebra.tower import Tower, entries_of, sign_of
from closedform.algebra.trace import factors_of, terms_of

Expr: TypeAlias = Any  # SymPy's annotations are partial

_FUNCTIONS = {
    sp.sin: "sin",
    sp.cos: "cos",
    sp.tan: "tan",
    sp.atan: "atan",
    sp.acos: "acos",
    sp.asin: "asin",
    sp.atan2: "atan2",
    sp.Abs: "abs",
}
_RECIPROCALS = {sp.sec: sp.cos, sp.csc: sp.sin, sp.cot: sp.tan}


class _Unwritable(ValueError):  # noqa: N818
    """The format has no words for an expression."""


class Record:
    """The certificates of one mechanism."""

    def __init__(self) -> None:
        self.place = ""
        """What is being proved; every certificate says it."""
        self.nodes: list[Any] = []
        self.certificates: list[dict[str, Any]] = []
        self.missing: Counter[str] = Counter()
        """Why a proof has no certificate, and how many have none."""
        self._known: dict[Expr, int] = {}
        self._names: Counter[str] = Counter()
        self._written: dict[str, int] = {}

    def document(self, name: str, digest: str) -> dict[str, Any]:
        """Everything as plain data; ``digest`` is that of the proof."""
        return {
            "format": verify.FORMAT,
            "name": name,
            "digest": digest,
            "not exported": dict(sorted(self.missing.items())),
            "nodes": self.nodes,
            "certificates": self.certificates,
        }

    def identity(self, problem: Expr, assumptions: Iterable[Expr], tower: Tower) -> None:
        """The entries of a problem vanish."""
        trace = tower.trace
        try:
            zero = sorted({self.node(e) for e in entries_of(problem)})
            generators = [
                [kind, terms_of(about)] if kind in verify.ROOTS else [kind, self.node(about), *n]
                for kind, about, *n in trace.generators
            ]
            assumed = [
                [self.node(a), str(trace.guards[a][0]), factors_of(trace.guards[a][1])]
                for a in assumptions
            ]
        except _Unwritable as reason:
            self.missing[str(reason)] += 1
            return
        roots = [factors_of(factors) for factors in trace.roots]
        self._add(
            kind="identity",
            zero=zero,
            assumed=assumed,
            generators=generators,
            roots=[r for i, r in enumerate(roots) if r not in roots[:i]],
            nonzero=[terms_of(p) for p in tower.inverted()],
        )

    def _add(self, **content: Any) -> int:
        """The number of a certificate; what was recorded before is not repeated."""
        text = json.dumps(content, sort_keys=True)
        if text not in self._written:
            self._written[text] = len(self.certificates)
            self.certificates.append({"of": self.place, **content})
        return self._written[text]

    # Expressions

    def node(self, e: Expr) -> int:
        """The index of an expression in the table of nodes."""
        if e not in self._known:
            node = self._node(e)
            self._known[e] = len(self.nodes)
            self.nodes.append(node)
        return self._known[e]

    def _node(self, e: Expr) -> Any:
        if e.is_Rational:
            return str(e)
        if e.is_Add or e.is_Mul:
            return ["+" if e.is_Add else "*", *map(self.node, e.args)]
        if e.is_Pow:
            base, exponent = e.args
            if exponent.is_Integer:
                return ["^", self.node(base), int(exponent)]
            if exponent == sp.Rational(1, 2):
                return ["sqrt", self.node(base)]
            if exponent.is_Rational and exponent.q == 2:
                return ["^", self.node(sp.Pow(base, sp.Rational(1, 2))), int(exponent.p)]
        if e.func in _FUNCTIONS:
            return [_FUNCTIONS[e.func], *map(self.node, e.args)]
        if e.func in _RECIPROCALS:
            return ["^", self.node(_RECIPROCALS[e.func](*e.args)), -1]
        if e == sp.pi:
            return ["pi"]
        if isinstance(e, sp.Symbol | AppliedUndef | sp.Derivative):
            self._names[str(e)] += 1
            uses = self._names[str(e)]
            return ["name", f"{e}#{uses}" if uses > 1 else str(e), sign_of(e)]
        raise _Unwritable(f"an expression contains {type(e).__name__}")


_open: ContextVar[Record | None] = ContextVar("record", default=None)


@contextlib.contextmanager
def recording() -> Iterator[Record]:
    """Collect the certificates of everything that is proved meanwhile."""
    record = Record()
    token = _open.set(record)
    try:
        yield record
    finally:
        _open.reset(token)


def open_record() -> Record | None:
    """The open recording, if there is one."""
    return _open.get()


def place(text: str) -> None:
    """Say what is being proved."""
    if record := open_record():
        record.place = text
