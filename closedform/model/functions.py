"""The exported functions of a derivation: short programs of exact expressions.

A :class:`Function` is a list of statements and the outputs computed from them.  The proofs, the Arb
reference and the lowering all read this exact form; nothing in it is approximate.  The six
statements are

``Let``
    names an expression;
``Bound``
    names a quantity that must not be negative; if it is, the target is UNREACHABLE;
``Match``
    a quantity that must vanish; if it does not, the target is UNREACHABLE;
``Vanishes``
    a flag that is true if a nonnegative quantity vanishes; it may free a joint (SINGULAR);
    generated code is fastest if no flag holds;
``Determined``
    a quantity that vanishes if the joints do not determine the posture (a parallel singularity); if
    it is too small for the round trip in floating-point numbers, the answer is SINGULAR;
``Require``
    a condition on the input itself; if it fails, the input is INVALID.

Tolerances are not part of a derivation.  A statement has the natural scale of its quantity, and
:mod:`closedform.model.tolerances` defines which fraction of the scale counts as zero.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any, TypeAlias

import sympy as sp

from closedform.model.expressions import free_symbols, substitute
from closedform.model.names import check_identifier, check_labels, check_text

Number: TypeAlias = Any  # an exact SymPy expression or an int; SymPy's annotations are partial


def real(name: str, **assumptions: bool) -> sp.Symbol:
    """A real symbol; ``assumptions`` may narrow it, as in ``real("r", nonnegative=True)``."""
    return sp.Symbol(name, **({"real": True} | assumptions))


def reject_text(value: Any, where: str) -> None:
    """Raise ``TypeError`` if a text is given as an expression: SymPy would run it as Python."""
    if isinstance(value, str):
        raise TypeError(f"{where}: {value!r} is a string; write the expression without quotes")
    if isinstance(value, list | tuple):
        for part in value:
            reject_text(part, where)


def reject_floats(expr: sp.Basic, where: str) -> None:
    """Raise ``TypeError`` if ``expr`` contains a floating-point number."""
    floats = [e for e in _parts(expr) if isinstance(e, sp.Float)]
    if floats:
        raise TypeError(
            f"{where}: the float {min(map(str, floats))} occurs in an exact expression; "
            f"write an integer or sympy.Rational instead"
        )


def _parts(expr: sp.Basic) -> Iterator[sp.Basic]:
    """The parts of an expression; one that occurs in several places is visited once."""
    seen: set[int] = set()
    pending = [expr]
    while pending:
        e = pending.pop()
        if id(e) not in seen:
            seen.add(id(e))
            yield e
            pending += e.args


@dataclass(frozen=True)
class Let:
    """``symbol = value``."""

    symbol: sp.Symbol
    value: sp.Expr


@dataclass(frozen=True)
class Bound:
    """``symbol = value``; a negative ``value`` means that the target is out of reach.

    Generated code clamps the value at zero.  With a scale ``above`` it clamps just above zero,
    because a zero would lose the side to which an arm is bent: the value over this scale is the
    square of an angle, which stays larger than the rounding of a joint.
    """

    symbol: sp.Symbol
    value: sp.Expr
    scale: sp.Expr
    meaning: str
    above: sp.Expr | None = None


@dataclass(frozen=True)
class Match:
    """``value`` must be zero up to a ``rounding`` error; otherwise the target is out of reach."""

    value: sp.Expr
    scale: sp.Expr
    meaning: str
    rounding: sp.Expr = sp.S.Zero


@dataclass(frozen=True)
class Vanishes:
    """``symbol`` is true if the nonnegative ``value`` is zero; then ``free`` joints are free.

    With ``squares``, the value and its scale are squares of such quantities.
    """

    symbol: sp.Symbol
    value: sp.Expr
    scale: sp.Expr
    meaning: str
    free: tuple[sp.Symbol, ...] = ()
    squares: bool = False


@dataclass(frozen=True)
class Determined:
    """Rounded joints determine the posture unless ``value`` is small compared with ``scale``.

    Both are nonnegative, and the forward map amplifies rounding errors by up to ``scale / value``;
    with ``squares`` they are squares of such quantities.  If this amplification is too large for
    the round trip, the status is SINGULAR; the answer does not change.  The article prints the
    value as ``name`` and the scale as ``scale_name``, which are LaTeX, if it has them.

    It also amplifies ``missed``, the length by which the rods miss a target just outside of the
    workspace, relative to ``size``, the sum of all lengths.
    """

    value: sp.Expr
    scale: sp.Expr
    meaning: str
    squares: bool = False
    name: str = ""
    scale_name: str = ""
    missed: sp.Expr = sp.S.Zero
    size: sp.Expr = sp.S.One


@dataclass(frozen=True)
class Require:
    """All ``values`` must be zero, or the input is INVALID."""

    values: tuple[sp.Expr, ...]
    scale: sp.Expr
    meaning: str


Statement = Let | Bound | Match | Vanishes | Determined | Require


@dataclass(frozen=True)
class Array:
    """An argument or a result: its name, its core shape and its entries in row-major order."""

    name: str
    shape: tuple[int, ...]
    entries: tuple[sp.Expr, ...]

    @property
    def size(self) -> int:
        return len(self.entries)


def array(name: str, value: Any) -> Array:
    """An :class:`Array` from a scalar, a (nested) sequence, a matrix or an N-dimensional array.

    Column matrices are vectors: a shape of ``(n, 1)`` becomes ``(n,)``.
    """
    reject_text(value, name)
    if isinstance(value, sp.MatrixBase):
        shape: tuple[int, ...] = value.shape if value.shape[1] != 1 else (value.shape[0],)
        entries = list(value)
    elif isinstance(value, (sp.Basic, int)):
        shape, entries = (), [value]
    else:
        nested = sp.ImmutableDenseNDimArray(value)
        shape, entries = tuple(map(int, nested.shape)), list(sp.flatten(nested.tolist()))
    exact = tuple(sp.sympify(e, strict=True) for e in entries)
    for entry in exact:
        reject_floats(entry, name)
    return Array(name, shape, exact)


@dataclass(frozen=True)
class Branches:
    """The named branches of an inverse (or the assembly modes of a loop), in their fixed order."""

    labels: tuple[str, ...]
    signs: tuple[Mapping[sp.Symbol, int], ...]

    def __post_init__(self) -> None:
        check_labels(self.labels, "branches")

    def __len__(self) -> int:
        return len(self.labels)


SINGLE = Branches(("only",), ({},))
"""One branch without a choice, for an inverse that has exactly one solution."""


def branches(*choices: tuple[sp.Symbol, Mapping[int, str]]) -> Branches:
    """All combinations of sign choices; the last choice varies fastest.

    >>> elbow = real("sigma_elbow")
    >>> branches((elbow, {+1: "elbow_down", -1: "elbow_up"})).labels
    ('elbow_down', 'elbow_up')
    """
    labels, signs = [], []
    for combination in product(*(options.items() for _, options in choices)):
        labels.append("_".join(label for _, label in combination))
        signs.append(
            {symbol: sign for (symbol, _), (sign, _) in zip(choices, combination, strict=True)}
        )
    return Branches(tuple(labels), tuple(signs))


@dataclass(frozen=True)
class Function:
    """One exported function.

    With ``branches``, every output gets a leading axis over the branches.  If ``result`` is
    ``"Solutions"`` or ``"Positions"``, a status per branch is returned with the single output.
    """

    name: str
    summary: str
    inputs: tuple[Array, ...]
    outputs: tuple[Array, ...]
    body: tuple[Statement, ...] = ()
    branches: Branches | None = None
    result: str | None = None
    source: str = ""
    notes: tuple[str, ...] = ()
    boolean: bool = False
    equation: str = ""
    """The left-hand side, as a step shows it, of the equation that this function evaluates."""
    entries: tuple[sp.Symbol, ...] = ()
    """Names of the entries of the result, if they do not follow from its own name."""

    def __post_init__(self) -> None:
        known: set[sp.Basic] = set()
        for argument in self.inputs:
            for entry in argument.entries:
                if not isinstance(entry, sp.Symbol) or entry in known:
                    raise ValueError(
                        f"{self.name}: the entry {entry} of the input {argument.name} must be a "
                        f"symbol that does not occur in any other entry"
                    )
                known.add(entry)
        names = [s.symbol.name for s in self.body if isinstance(s, (Let, Bound, Vanishes))]
        names += [str(k) for k in known]
        names += sorted({str(s) for _, signs in self.cases() for s in signs})
        for name in names:
            check_identifier(name, self.name)
        for statement in self.body:
            check_text(self.name, getattr(statement, "meaning", ""))
        repeated = sorted({n for n in names if names.count(n) > 1})
        if repeated:
            raise ValueError(f"{self.name}: the name {repeated[0]} is given twice")

    @property
    def has_status(self) -> bool:
        return self.result is not None

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """The input symbols in order."""
        return tuple(e for a in self.inputs for e in a.entries if isinstance(e, sp.Symbol))

    def cases(self) -> Iterator[tuple[str, Mapping[sp.Symbol, int]]]:
        """The branches, or one case without a name if there are none."""
        if self.branches is None:
            yield "", {}
        else:
            yield from zip(self.branches.labels, self.branches.signs, strict=True)

    @property
    def signs(self) -> tuple[sp.Symbol, ...]:
        """The symbols whose signs tell the branches apart."""
        return tuple(dict.fromkeys(s for _, signs in self.cases() for s in signs))

    def values(self, signs: Mapping[sp.Symbol, int]) -> tuple[sp.Expr, ...]:
        """The outputs of one branch as explicit expressions of inputs and parameters.

        All flags are false: this is the generic case.  See :meth:`at` for the other cases.
        """
        return self.at(signs, {})

    def at(
        self,
        signs: Mapping[sp.Symbol, int],
        flags: Mapping[sp.Symbol, bool],
        locus: Mapping[sp.Symbol, sp.Expr] | None = None,
    ) -> tuple[sp.Expr, ...]:
        """The outputs of a branch if the given ``flags`` hold; ``locus`` is a substitution."""
        outputs = [e for a in self.outputs for e in a.entries]
        return self.explicit(outputs, signs, flags, locus)[0]

    def bounds(self, signs: Mapping[sp.Symbol, int]) -> tuple[sp.Expr, ...]:
        """The explicit expressions that are nonnegative if this branch exists."""
        every = [s.symbol for s in self.body if isinstance(s, Bound)]
        return self.explicit(every, signs)[1]

    def explicit(
        self,
        exprs: Sequence[sp.Expr],
        signs: Mapping[sp.Symbol, int],
        flags: Mapping[sp.Symbol, bool] | None = None,
        locus: Mapping[sp.Symbol, sp.Expr] | None = None,
    ) -> tuple[tuple[sp.Expr, ...], tuple[sp.Expr, ...]]:
        """Expressions without the names of the body, and the bounds that they depend on.

        Flags that are not in ``flags`` are false.  ``locus`` replaces inputs and parameters.
        """
        return explicit(self.body, exprs, {**signs, **(flags or {}), **(locus or {})})


def explicit(
    body: Sequence[Statement], exprs: Sequence[sp.Expr], given: Mapping[sp.Basic, Any]
) -> tuple[tuple[sp.Expr, ...], tuple[sp.Expr, ...]]:
    """Expressions without the names of a body, and the bounds that they depend on.

    ``given`` replaces symbols; flags that are not in it are false.
    """
    known = {s: sp.sympify(e, strict=True) for s, e in given.items()}
    # what only another case needs is not even written out
    flags = {s.symbol: known.get(s.symbol, sp.false) for s in body if isinstance(s, Vanishes)}
    exprs = [substitute(e, flags) for e in exprs]
    values = {s.symbol: substitute(s.value, flags) for s in body if isinstance(s, (Let, Bound))}
    needed = free_symbols(exprs) - known.keys()
    for symbol, value in reversed(values.items()):
        if symbol in needed:
            needed |= free_symbols([value]) - known.keys()
    bounds = []
    for statement in body:
        if isinstance(statement, (Let, Bound)) and statement.symbol in needed:
            symbol = statement.symbol
            value = known[symbol] = substitute(values[symbol], known)
            sum_of_squares = value.is_Add and symbol.is_nonnegative
            if isinstance(statement, Bound) or (sum_of_squares and value.is_nonnegative):
                bounds.append(value)
    return tuple(substitute(e, known) for e in exprs), tuple(bounds)


@dataclass
class Program:
    """The statements of a function, in the order in which a derivation makes them."""

    body: list[Statement] = field(default_factory=list)
    taken: frozenset[str] = frozenset()
    """Names that are taken; a statement that would use one gets a longer name."""
    suffix: str = ""
    """What the names of statements end in, so that a lemma may be applied several times."""

    def _symbol(self, name: str, **assumptions: bool) -> sp.Symbol:
        name += self.suffix
        while name in self.taken:
            name += "_0"
        return sp.Symbol(name, **assumptions)

    def let(self, name: str, value: Number, **assumptions: bool) -> sp.Symbol:
        symbol = self._symbol(name, real=True, **assumptions)
        value = sp.sympify(value, strict=True)
        reject_floats(value, name)
        self.body.append(Let(symbol, value))
        return symbol

    def bound(
        self,
        name: str,
        value: sp.Expr,
        scale: sp.Expr,
        meaning: str,
        *,
        above: sp.Expr | None = None,
    ) -> sp.Symbol:
        symbol = self._symbol(name, real=True, nonnegative=True)
        reject_floats(sp.sympify(value, strict=True), name)
        self.body.append(Bound(symbol, value, scale, meaning, above))
        return symbol

    def match(
        self, value: sp.Expr, scale: sp.Expr, meaning: str, *, rounding: sp.Expr | int = 0
    ) -> None:
        self.body.append(Match(value, scale, meaning, sp.sympify(rounding, strict=True)))

    def vanishes(
        self,
        name: str,
        value: sp.Expr,
        scale: Number,
        meaning: str,
        free: Sequence[sp.Symbol] = (),
        *,
        squares: bool = False,
    ) -> sp.Symbol:
        """A flag that a nonnegative value counts as zero.

        Parameters
        ----------
        name
            that of the flag
        value
            what is compared with zero
        scale
            the natural scale of its rounding
        meaning
            what is the case then, in words
        free
            the joints that are free then
        squares
            whether value and scale are squares
        """
        symbol = self._symbol(name)
        exact = sp.sympify(scale, strict=True)
        self.body.append(
            Vanishes(
                symbol=symbol,
                value=value,
                scale=exact,
                meaning=meaning,
                free=tuple(free),
                squares=squares,
            )
        )
        return symbol

    def determined(
        self,
        value: sp.Expr,
        scale: Number,
        meaning: str,
        *,
        squares: bool = False,
        name: str = "",
        scale_name: str = "",
        missed: sp.Expr = sp.S.Zero,
        size: sp.Expr = sp.S.One,
    ) -> None:
        """Report SINGULAR where rounded joints do not determine the posture.

        Parameters
        ----------
        value, scale
            the forward map amplifies rounding errors by up to ``scale / value``
        meaning
            what is the case where the value vanishes, in words
        squares
            whether value and scale are squares of such quantities
        name, scale_name
            how the article prints them, in LaTeX
        missed, size
            the length by which the rods miss a target, and the sum of all lengths
        """
        exact, more = sp.sympify(scale, strict=True), (squares, name, scale_name, missed, size)
        self.body.append(Determined(value, exact, meaning, *more))

    def require(self, values: Sequence[sp.Expr], scale: Number, meaning: str) -> None:
        self.body.append(Require(tuple(values), sp.sympify(scale, strict=True), meaning))

    def explicit(self, value: Any) -> Any:
        """An expression or a matrix with the names of the program replaced by their values."""
        known: dict[sp.Basic, sp.Basic] = {}
        for statement in self.body:
            if isinstance(statement, (Let, Bound)):
                known[statement.symbol] = substitute(statement.value, known)
        if isinstance(value, sp.MatrixBase):
            return value.applyfunc(lambda e: substitute(e, known))
        return substitute(value, known)

    def needed_for(self, values: Iterable[sp.Expr]) -> Program:
        """The names that some expressions need, and no others; for a program of names alone."""
        needed = {s for e in values for s in e.free_symbols}
        kept: list[Statement] = []
        for statement in reversed(self.body):
            if isinstance(statement, Let) and statement.symbol in needed:
                needed |= statement.value.free_symbols
                kept.insert(0, statement)
        return Program(kept, self.taken)

    def matrix(self, name: str, matrix: sp.Matrix) -> sp.Matrix:
        """Name the entries that are sums or products, so that later products stay short."""
        named = sp.zeros(*matrix.shape)
        for i in range(matrix.shape[0]):
            for j in range(matrix.shape[1]):
                entry = matrix[i, j]
                atomic = entry.is_Atom or (-entry).is_Atom or isinstance(entry, (sp.sin, sp.cos))
                named[i, j] = entry if atomic else self.let(f"{name}_{i + 1}{j + 1}", entry)
        return named


def choose(flag: sp.Basic, when_true: Number, otherwise: Number) -> sp.Expr:
    """``when_true`` if a flag, or a condition on flags, holds; else ``otherwise``.

    Raises ``ValueError`` if the flag itself contains a choice, of which SymPy would drop a part.
    """
    if flag.has(sp.Piecewise):
        raise ValueError(f"this condition contains a choice; give it a name with let first: {flag}")
    return sp.Piecewise((when_true, flag), (otherwise, True))


def sign_of(value: Number) -> sp.Expr:
    """1 if ``value`` is not negative, else -1."""
    return choose(sp.sympify(value, strict=True) >= 0, 1, -1)


def used_up(margin: Number) -> sp.Expr:
    """A nonnegative expression that counts as zero if ``margin`` is zero or slightly negative."""
    return sp.Max(margin, -margin / 2**40)


__all__ = [
    "SINGLE",
    "Array",
    "Bound",
    "Branches",
    "Determined",
    "Function",
    "Let",
    "Match",
    "Program",
    "Require",
    "Statement",
    "Vanishes",
    "array",
    "branches",
    "choose",
    "explicit",
    "real",
    "reject_floats",
    "sign_of",
    "used_up",
]
