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
from dataclasses import dataclass
from typing import Any, TypeAlias

import sympy as sp
from flint import ctx
from sympy.core.function import AppliedUndef

from closedform.algebra.balls import pivot_rows
from closedform.algebra.basis import TooLargeError, logged_basis
from closedform.algebra.expressions import (
    QUOTIENTS,
    TRIGONOMETRIC,
    angle_terms,
    entries_of,
    sign_of,
)
from closedform.algebra.tower import Tower
from closedform.algebra.trace import factors_of, terms_of
from closedform.verify import (
    FORMAT,
    Field,
    Polynomial,
    Refused,
    inverted_in,
    matrix_of,
    staircase,
    system_of,
)

Expr: TypeAlias = Any  # SymPy's annotations are partial


class _Unwritable(ValueError):  # noqa: N818
    """An expression that the format cannot express."""


@dataclass(frozen=True)
class System:
    """A system of equations, as :func:`closedform.algebra.solutions.count_solutions` has it."""

    equations: Sequence[Expr]
    nonzero: Sequence[Expr]
    given: Mapping[sp.Symbol, Expr]
    """Symbols that stand for expressions in free parameters."""
    angles: Mapping[sp.Symbol, Sequence[int]]
    """Unknown angles, as combinations of the angles whose sines and cosines are unknown."""
    unknowns: Sequence[sp.Symbol]
    """Unknowns that are not angles."""


@dataclass(frozen=True)
class Counted:
    """A certified number of solutions, and the Groebner basis that gives it."""

    number: int
    """That of the certificate."""
    count: int | None
    """None if there are infinitely many."""
    field: Field
    basis: Sequence[Polynomial]


class Record:
    """The certificates of one mechanism."""

    def __init__(self) -> None:
        self.place = ""
        """What is being proved; every certificate says it."""
        self.nodes: dict[int, list[Any]] = {}
        self.certificates: list[dict[str, Any]] = []
        self.missing: Counter[str] = Counter()
        """Why a proof has no certificate, and how many have none."""
        self.proofs = 0
        """The number of identities and counts so far, with those that are repeated."""
        self.uncounted: list[str] = []
        """The inverses of which a count has no certificate."""
        self._known: dict[Any, int] = {}
        self._names: Counter[str] = Counter()
        self._written: dict[str, int] = {}

    def document(self, name: str, digest: str) -> dict[str, Any]:
        """Everything as plain data; ``digest`` is that of the proof."""
        return {
            "format": FORMAT,
            "name": name,
            "digest": digest,
            "not exported": dict(sorted(self.missing.items())),
            "inverses not exported": self.uncounted,
            "nodes": [*self.nodes.values()],
            "certificates": self.certificates,
        }

    def text(self, name: str, digest: str) -> str:
        """Everything as JSON, with a line for each node and each certificate."""

        def written(value: Any) -> str:
            if isinstance(value, list) and value:
                return "[\n" + ",\n".join(map(json.dumps, value)) + "\n]"
            return json.dumps(value)

        content = self.document(name, digest).items()
        return "{\n" + ",\n".join(f'"{key}": {written(v)}' for key, v in content) + "\n}\n"

    def identity(self, problem: Expr, assumptions: Iterable[Expr], tower: Tower) -> None:
        """Certify that the entries of a problem vanish."""
        self.proofs += 1
        trace = tower.trace
        if trace.unwritable:
            self.missing[trace.unwritable] += 1
            return
        try:
            zero = sorted({self.node(e) for e in entries_of(problem)})
            assumed = {g for g, rooted in trace.guards.items() if rooted} | {*assumptions}
            steps = [
                [kind, *self._step(kind, *about)]
                for kind, *about in trace.steps
                if kind != "known" or about[0] in assumed or about[0] not in trace.guards
            ]
            content: dict[str, Any] = {
                "zero": zero,
                "assumed": [self.node(g) for g in trace.guards if g in assumed],
                "field": _first(steps),
            }
            inverted = inverted_in(Field(self.nodes, content), zero)
        except (_Unwritable, Refused, LookupError) as reason:
            self.missing[str(reason)] += 1
            return
        factors = {str(f): f for p in inverted for f, _ in p.factor()[1]}
        self._add(kind="identity", **content, nonzero=[terms_of(f) for f in factors.values()])

    def _step(self, kind: str, about: Any, *rest: Any) -> list[Any]:
        """A step of a conversion as plain data."""
        if kind == "root":
            return [terms_of(about), *rest]
        if kind == "known":
            return [self.node(about), terms_of(rest[0]), factors_of(rest[1])]
        return [self.node(about), *(map(factors_of, rest) if kind == "value" else rest)]

    def count(self, system: System) -> Counted | None:
        """Certify the number of solutions of a system; None if no certificate can be written."""
        self.proofs += 1
        try:
            content = self._system(system)
            field, polynomials = system_of(self.nodes, content)
        except (_Unwritable, Refused, LookupError) as reason:
            self.missing[f"counts of solutions ({reason})"] += 1
            return None
        try:
            found = logged_basis(field, polynomials)
        except TooLargeError:
            self.missing["counts of solutions whose basis is too large"] += 1
            return None
        count = staircase(found.leads, len(field.unknowns))
        number = self._add(
            kind="count", **content, steps=found.steps, basis=found.basis, count=count
        )
        return Counted(number, count, field, found.elements)

    def inverse(
        self, function: str, branches: int, counts: Sequence[tuple[int | None, int]], each: int
    ) -> None:
        """Certify that the counts of the steps of an inverse multiply to its branches."""
        if any(count is None for count, _ in counts):
            self.uncounted.append(function)
            return
        self._add(
            kind="inverse",
            function=function,
            branches=branches,
            counts=[list(pair) for pair in counts],
            **{"per branch": each},
        )

    def point(
        self, rows: Sequence[Sequence[Expr]], at: Mapping[Expr, Expr], assumed: Iterable[Expr] = ()
    ) -> bool:
        """Certify that a matrix has full column rank at a point.

        Nothing in ``assumed`` is negative there.  Returns whether a certificate could be written.
        """
        self.proofs += 1
        rows = [[sp.sympify(e, strict=True) for e in row] for row in rows]
        conditions = [sp.sympify(e, strict=True) for e in assumed]
        used = {s for e in (*conditions, *(e for row in rows for e in row)) for s in e.free_symbols}
        try:
            given = {s: sp.sympify(value, strict=True) for s, value in at.items() if s in used}
            content: dict[str, Any] = {
                "at": [[self.node(s), self.node(value)] for s, value in given.items()],
                "assumed": [self.node(e) for e in conditions],
                "matrix": [[self.node(e) for e in row] for row in rows],
            }
            with ctx.workprec(300):
                chosen = pivot_rows(matrix_of(self.nodes, content))
        except (_Unwritable, Refused, LookupError):
            return False
        if len(chosen) < len(rows[0]):
            return False
        content["matrix"] = [content["matrix"][j] for j in chosen]
        self._add(kind="point", **content)
        return True

    def _system(self, system: System) -> dict[str, Any]:
        """The equations of a system, their unknowns and their parameters."""
        unknown = {*system.unknowns, *system.angles}
        equations = [sp.sympify(e, strict=True) for e in system.equations]
        inverses: list[sp.Symbol] = []
        numerators, denominators = zip(*(_quotient(e, unknown) for e in equations), strict=True)
        for factor in dict.fromkeys([*system.nonzero, *(f for d in denominators for f in d)]):
            inverses.append(sp.Symbol(f"1/({factor})", real=True))
            numerators += (inverses[-1] * factor - 1,)
        given = [[self.node(x), self.node(e)] for x, e in system.given.items()]
        split = [
            _split_symbols(sp.sympify(e, strict=True))
            for e in (*numerators, *system.given.values())
        ]
        plain = {s for outside, _ in split for s in outside}
        turning = {s for _, inside in split for s in inside}
        plain -= {*unknown, *inverses, *system.given}
        turning -= {*unknown, *system.given}
        halves = {s: sp.Symbol(f"tan({s}/2)", real=True) for s in sorted(turning, key=str)}
        given += [[self.node(s), self.node(2 * sp.atan(t))] for s, t in halves.items()]
        return {
            "equations": [self.node(e) for e in numerators],
            "given": given,
            "angles": [[self.node(a), row[::-1]] for a, row in system.angles.items()],
            "field": [
                *(["name", self.node(s)] for s in sorted(plain, key=str)),
                *(["name", self.node(t)] for t in halves.values()),
                *(["unknown", self.node(s)] for s in inverses),
                *(["unknown", self.node(s)] for s in reversed(system.unknowns)),
                *(["circle"] for _ in system.angles),
            ],
        }

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
            self._known[e] = self._node(e)
        return self._known[e]

    def _entry(self, op: str, *args: Any) -> int:
        """The index of a node."""
        node = [op, *args]
        key = tuple(node)
        if key not in self._known:
            self._known[key] = len(self.nodes)
            self.nodes[len(self.nodes)] = node
        return self._known[key]

    def _node(self, e: Expr) -> int:
        """The index of an expression; functions that the format lacks are rewritten."""
        if e.is_Rational:
            return self._entry("number", str(e))
        if e.is_Add or e.is_Mul:
            return self._entry("+" if e.is_Add else "*", *map(self.node, e.args))
        if e.is_Pow:
            return self._power(*e.args)
        if isinstance(e, sp.sin | sp.cos):
            return self._entry("sin" if isinstance(e, sp.sin) else "cos", self._angle(e.args[0]))
        if isinstance(e, TRIGONOMETRIC):
            return self.node(QUOTIENTS[e.func](e.args[0]))
        if isinstance(e, sp.Abs):
            return self._entry("abs", self.node(e.args[0]))
        if isinstance(e, sp.atan2 | sp.atan | sp.acos | sp.asin):
            return self._arc(e)
        if e == sp.pi:
            return self._entry("pi")
        if isinstance(e, sp.Symbol | AppliedUndef | sp.Derivative):
            self._names[str(e)] += 1
            uses = self._names[str(e)]
            return self._entry("name", f"{e}#{uses}" if uses > 1 else str(e), sign_of(e))
        raise _Unwritable(f"expressions with {type(e).__name__}")

    def _arc(self, e: Expr) -> int:
        """An angle by its sine, cosine or tangent, as that of a vector."""
        if isinstance(e, sp.atan2):
            return self._entry("atan2", *map(self.node, e.args))
        x = self.node(e.args[0])
        if isinstance(e, sp.atan):
            return self._entry("atan2", x, self.node(sp.S.One))
        other = self._power(1 - e.args[0] ** 2, sp.S.Half)
        return self._entry("atan2", *((other, x) if isinstance(e, sp.acos) else (x, other)))

    def _power(self, base: Expr, exponent: Expr) -> int:
        if exponent.is_Rational and exponent.q == 2:
            root = self._entry("sqrt", self.node(base))
            return root if exponent.p == 1 else self._entry("^", root, int(exponent.p))
        if exponent.is_Integer:
            return self._entry("^", self.node(base), int(exponent))
        raise _Unwritable("expressions with other powers")

    def _angle(self, e: Expr) -> int:
        """A sum of multiples of angles; no term is a multiple of another."""
        terms = [
            self.node(atom) if q == 1 else self._entry("*", self.node(q), self.node(atom))
            for atom, q in angle_terms(e).items()
        ]
        return terms[0] if len(terms) == 1 else self._entry("+", *terms)


def _first(steps: Iterable[list[Any]]) -> list[list[Any]]:
    """The steps without repetitions: a fact needs only one reason."""
    found: dict[str, list[Any]] = {}
    for step in steps:
        found.setdefault(json.dumps(step[2] if step[0] == "known" else step), step)
    return list(found.values())


def _quotient(e: Expr, unknown: set[Expr]) -> tuple[Expr, list[Expr]]:
    """An expression without its denominators that contain an unknown, and these denominators."""
    e = e.replace(lambda f: isinstance(f, tuple(QUOTIENTS)), lambda f: QUOTIENTS[f.func](*f.args))
    powers = (f for f in e.atoms(sp.Pow) if f.exp.could_extract_minus_sign())
    if not any(f.free_symbols & unknown for f in powers):
        return e, []
    numerator, denominator = sp.fraction(sp.together(e))
    factors = (f.as_base_exp()[0] for f in sp.Mul.make_args(denominator))
    return numerator, [f for f in factors if f.free_symbols & unknown]


def _split_symbols(e: Expr) -> tuple[set[Expr], set[Expr]]:
    """The symbols of an expression outside of sines and cosines, and those inside of them."""
    turned = {f: sp.Dummy() for f in e.atoms(*TRIGONOMETRIC)}
    outside = e.xreplace(turned).free_symbols - set(turned.values())
    return outside, {s for f in turned for s in f.free_symbols}


_open: ContextVar[Record | None] = ContextVar("record", default=None)


@contextlib.contextmanager
def recording() -> Iterator[Record]:
    """Collect the certificates of everything that is proved in the body."""
    record = Record()
    token = _open.set(record)
    try:
        yield record
    finally:
        _open.reset(token)


def open_record() -> Record | None:
    """The open recording, if there is one."""
    return _open.get()


def add_inverse(
    function: str, branches: int, counts: Sequence[tuple[int | None, int]], each: int = 1
) -> None:
    """Record that an inverse is complete.

    Each of ``counts`` is a certificate and the number of its solutions that are excluded; ``each``
    is the number of solutions of the lemmas for every branch.
    """
    if record := open_record():
        record.inverse(function, branches, counts, each)


def point(
    rows: Sequence[Sequence[Expr]],
    at: Mapping[Expr, Expr],
    what: str,
    assumed: Iterable[Expr] = (),
) -> None:
    """Record that a matrix has full column rank at a point; ``what`` describes it in messages."""
    if (record := open_record()) and not record.point(rows, at, assumed):
        record.missing[what] += 1


def lack(what: str) -> None:
    """Record that a proof has no certificate; ``what`` describes what it shows."""
    if record := open_record():
        record.missing[what] += 1


def proofs() -> int:
    """The number of proofs that the open recording has seen."""
    record = open_record()
    return record.proofs if record else 0


def place(text: str) -> None:
    """Say what is being proved; the certificates repeat it."""
    if record := open_record():
        record.place = text
