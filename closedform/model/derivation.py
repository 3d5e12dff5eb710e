"""The vocabulary in which a derivation script is written.

A script builds one :class:`Derivation`: it names the paper, the parameters and the joints, proceeds
in steps, solves for the unknowns with named lemmas, exports functions and transcribes the claims of
the paper.  All later stages (proof, lowering, emission, LaTeX, reference) read only this object.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from types import MappingProxyType
from typing import Any, Literal

import sympy as sp

from closedform.model.alike import Alike
from closedform.model.claims import Check, Claim, Erratum, Gravity, Reading
from closedform.model.display import Shown
from closedform.model.functions import (
    Branches,
    Function,
    Number,
    Program,
    array,
    real,
)
from closedform.model.inverse import Inverse
from closedform.model.lemma import Lemma
from closedform.model.names import (
    check_argument,
    check_function,
    check_identifier,
    check_labels,
    check_own,
    check_robot,
    check_symbol,
    check_text,
)
from closedform.model.notation import Notation
from closedform.model.paper import Paper as Paper
from closedform.model.skeleton import Skeleton
from closedform.model.step import Pairs, Step, check_exact, differences


@dataclass(frozen=True)
class Parameter:
    """A dimension of the mechanism, constant while it moves."""

    symbol: sp.Symbol
    unit: str
    value: sp.Rational
    meaning: str
    source: str
    nonnegative: bool

    @property
    def name(self) -> str:
        return str(self.symbol.name)


@dataclass(frozen=True)
class Joint:
    """A joint variable.

    The other joints move a passive joint; a coupled joint is a function of the other joints.
    """

    symbol: sp.Symbol
    kind: Literal["revolute", "prismatic"]
    passive: bool = False
    coupling: sp.Expr | None = None
    twin_of: sp.Symbol | None = None
    """A joint that this one stays close to, as in a twin arm; samples respect this."""
    limits: tuple[float, float] | None = None
    """The smallest and the largest value; nothing in a derivation depends on them."""

    @property
    def name(self) -> str:
        return str(self.symbol.name)


@dataclass(frozen=True)
class Written:
    """How a symbol is written in formulas, and what it means (plain text)."""

    latex: str
    meaning: str
    same: str = ""
    """A symbol of the same quantity, which may be written alike."""


@dataclass(frozen=True)
class Solved:
    """An unknown solved by a lemma from an equation that follows from the system."""

    function: str
    unknown: sp.Symbol
    lemma: Lemma
    equation: sp.Expr
    posture: Mapping[sp.Symbol, sp.Expr] | None = None
    """The inputs in terms of the joints (including passive ones), unless the inverse gives them."""


@dataclass(frozen=True)
class Table:
    """A table of numbers: ``columns`` of expressions in one ``variable``, and a row for each value.

    The parameters have their example values.  The header of a column gives its unit.
    """

    name: str
    header: str
    variable: sp.Symbol
    values: tuple[sp.Rational, ...]
    columns: Mapping[str, sp.Expr]

    def __post_init__(self) -> None:
        check_identifier(self.name, "name of a table")
        check_text(f"header of the table {self.name}", self.header, *self.columns)


RESULTS = {"Solutions": "q", "Positions": "p"}
"""The results with a status, and the name of the values of each."""


@dataclass
class Derivation(Shown):
    """The derivation of one mechanism.

    Parameters
    ----------
    name, title
        the name of the script and of the printed modules; in one line, what the mechanism is
    paper, mechanism
        the paper that it is from; the mechanism in a few sentences
    task, branches, assembly_modes, singularities
        names, in order: of the coordinates of a target, and of what the functions return

    A script leaves out the other arguments; the methods fill them.
    """

    name: str
    title: str
    paper: Paper
    mechanism: str
    parameters: list[Parameter] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    task: list[str] = field(default_factory=list)
    branches: tuple[str, ...] = ()
    assembly_modes: tuple[str, ...] = ()
    singularities: tuple[str, ...] = ()
    poles: tuple[str, ...] = ()
    """The singularities where the Jacobian is unbounded; at the others it loses rank."""
    steps: list[Step] = field(default_factory=list)
    solved: list[Solved] = field(default_factory=list)
    inverses: list[Inverse] = field(default_factory=list)
    functions: list[Function] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)
    claims: list[Claim] = field(default_factory=list)
    errata: list[Erratum] = field(default_factory=list)
    skeleton: Skeleton | None = None
    """The points, links and joints that the function ``skeleton`` draws."""
    written: dict[str, Written] = field(default_factory=dict)
    """Symbols that are not written as their name says, or whose meaning no equation gives."""
    explained: dict[str, str] = field(default_factory=dict)
    """What names of equations mean (plain text), by their LaTeX."""
    loop: Step | None = None
    """The step that states the equations of the loop, which the inverses solve."""
    given_by: dict[str, Step] = field(default_factory=dict)
    """The step with the equations for a coordinate of the task, if none has it on its left side."""
    means: dict[sp.Symbol, sp.Expr] = field(default_factory=dict)
    """Names of programs that are the sine or the cosine of an angle that no lemma finds."""
    alike: Alike | None = None
    """The legs, if they differ in the names of their symbols alone."""
    without_inverse: str = ""
    """Why there is no inverse, as a clause; empty if there is one or no reason was given."""

    def parameter(
        self,
        name: str,
        *,
        value: Number,
        unit: str,
        meaning: str,
        source: str = "the paper's example",
        nonnegative: bool = True,
    ) -> sp.Symbol:
        """Declare a parameter.

        In the algebra a nonnegative parameter counts as positive: an identity that holds on the
        open set also holds on its closure.  The flags of the inverse handle a zero length.

        Parameters
        ----------
        name
            that of the symbol
        value, source
            an example, which is exact, and where it is from
        unit, meaning
            ``m``, ``rad``, ..., and what it is, in words
        nonnegative
            whether it is never negative, as a length
        """
        self._check_new(name)
        check_text(f"{self.name}: {name}", meaning, unit, source)
        symbol = real(name, positive=True) if nonnegative else real(name)
        exact = sp.nan if isinstance(value, str) else sp.sympify(value, strict=True)
        if not exact.is_Rational:
            hint = f": write sympy.Rational('{value}')" if isinstance(value, float | str) else ""
            raise TypeError(f"{self.name}: the value of {name} must be an exact rational{hint}")
        self.parameters.append(Parameter(symbol, unit, exact, meaning, source, nonnegative))
        return symbol

    def joint(
        self,
        name: str,
        kind: Literal["revolute", "prismatic"] = "revolute",
        *,
        passive: bool = False,
        coupling: sp.Expr | None = None,
        twin_of: sp.Symbol | None = None,
        limits: tuple[Any, Any] | None = None,
    ) -> sp.Symbol:
        """Declare a joint variable.

        Parameters
        ----------
        name, kind
            that of the symbol, and whether it turns or slides
        passive
            whether the other joints move it
        coupling
            the joint as a function of earlier ones, as in
            ``joint("theta4", coupling=-(theta2 + theta3))``; :meth:`couple` substitutes it
        twin_of
            a joint that this one stays close to, as in a twin arm
        limits
            its least and largest value, exported as ``LIMITS``; the inverse ignores them
        """
        self._check_new(name)
        if kind not in ("revolute", "prismatic"):
            raise ValueError(f"{self.name}: {name} must be revolute or prismatic, not {kind!r}")
        symbol = real(name)
        between = None if limits is None else self._limits(name, limits)
        self.joints.append(Joint(symbol, kind, passive, coupling, twin_of, between))
        return symbol

    def _limits(self, name: str, given: tuple[Any, Any]) -> tuple[float, float]:
        try:
            least, most = (float(sp.sympify(e, strict=True)) for e in given)
        except (TypeError, ValueError) as error:
            raise ValueError(f"{self.name}: {name} needs two numbers as limits") from error
        if not least <= most:
            raise ValueError(f"{self.name}: the limits of {name} are in the wrong order")
        return least, most

    def write(
        self, symbol: sp.Symbol | str, latex: str = "", meaning: str = "", *, same: str = ""
    ) -> None:
        """Say how formulas write a symbol, as in ``write("rS", r"\\varrho_S")``, and what it is.

        ``same`` names a symbol of the same quantity, which is written in the same way.
        """
        name = str(symbol)
        check_text(f"{self.name}: {name}", latex, meaning)
        if name in self.written:
            raise ValueError(f"{self.name}: the symbol {name} is described twice")
        self.written[name] = Written(latex, meaning, same)

    def explain(self, meanings: Mapping[str, str]) -> None:
        """Say what names mean that equations define, as in ``explain({"R_{03}": "..."})``."""
        for latex, meaning in meanings.items():
            check_text(f"{self.name}: {latex}", latex, meaning)
            if latex in self.explained:
                raise ValueError(f"{self.name}: the symbol {latex} is explained twice")
            self.explained[latex] = meaning

    def couple(self, expr: Any) -> Any:
        """``expr`` with every coupled joint replaced by its coupling."""
        couplings = {j.symbol: j.coupling for j in self.joints if j.coupling is not None}
        return expr.xreplace(couplings)

    @property
    def limits(self) -> tuple[tuple[float, ...], tuple[float, ...]] | None:
        """The least and the largest values of the actuated joints; None if no joint has limits."""
        given = {j.symbol: j.limits for j in self.joints}
        if not any(given[s] for s in self.actuated):
            return None
        pairs = [given[s] or (-math.inf, math.inf) for s in self.actuated]
        least, most = zip(*pairs, strict=True)
        return tuple(least), tuple(most)

    @property
    def actuated(self) -> tuple[sp.Symbol, ...]:
        return tuple(j.symbol for j in self.joints if not j.passive and j.coupling is None)

    @property
    def has_forward_map(self) -> bool:
        """Whether the joints give the hand by a formula."""
        return any(f.name == "fk" for f in self.functions)

    def program(self) -> Program:
        """A program whose names differ from those of joints, parameters and the task."""
        symbols = [p.symbol for p in self.parameters] + [j.symbol for j in self.joints]
        return Program(taken=frozenset(map(str, [*symbols, *self.task])))

    def step(
        self,
        title: str,
        reason: str,
        shown: Mapping[str, Any],
        *,
        published: Sequence[str] = (),
        equal: Pairs | Callable[[], Pairs] = (),
        nonnegative: Sequence[sp.Expr] = (),
        rows: Sequence[Sequence[Any]] = (),
        proves: str = "",
        uses: Sequence[Step] = (),
        solves: Mapping[str, Sequence[sp.Symbol]] = MappingProxyType({}),
    ) -> Step:
        """Record a step.

        Parameters
        ----------
        title, reason
            a heading, and sentences of reasoning
        shown
            a LaTeX left-hand side for each derived expression
        published
            the numbers of the equations of the paper
        equal
            pairs that are proved to be equal; the build fails if the proof does.  Pairs that take
            long to compute are given by a function, which is called when they are needed
        nonnegative
            expressions of which the proof may assume that they are not negative
        rows
            a table, see :class:`Step`
        proves
            what the equalities mean, in sentences
        uses
            the steps, as ``step`` returned them, to whose equations the text refers
        solves
            for each inverse of which this step gives reasons, the unknowns that it explains; none
            if it explains the inverse as a whole.  The inverse refers to the step
        """
        where = f"{self.name}, step {title!r}"
        check_exact([*shown.values()], where)
        check_text(f"{self.name}, title of a step", title)
        check_text(where, reason, proves, lines=True)
        if any(step not in self.steps for step in uses):
            raise ValueError(f"{where}: it can only use earlier steps of {self.name}")
        check_text(where, *shown, *published, *(c for r in rows for c in r if isinstance(c, str)))
        given = equal if callable(equal) else differences(equal, where)  # errors tell the line
        step = Step(
            title=title,
            reason=reason,
            shown=tuple(shown.items()),
            published=tuple(published),
            differences=lambda: differences(given(), where) if callable(given) else given,
            nonnegative=tuple(nonnegative),
            rows=tuple(map(tuple, rows)),
            proves=proves,
            uses=tuple(uses),
            solves=tuple((name, tuple(unknowns)) for name, unknowns in solves.items()),
        )
        self.steps.append(step)
        return step

    def function(
        self,
        name: str,
        summary: str,
        inputs: Mapping[str, Any],
        outputs: Mapping[str, Any],
        *,
        program: Program | None = None,
        branches: Branches | None = None,
        result: str | None = None,
        source: str = "",
        notes: Sequence[str] = (),
        boolean: bool = False,
        equation: str = "",
        entries: Sequence[sp.Symbol] = (),
    ) -> Function:
        """Export a function.

        Parameters
        ----------
        name, summary
            its name, and the first sentence of its documentation
        inputs, outputs
            named scalars, vectors, matrices or arrays
        program
            the statements before the outputs
        branches
            the signs of the branches, and their names
        result
            the name of the tuple with a status that it returns
        source
            where the paper has it
        notes
            further sentences of the documentation
        boolean
            whether the output is true or false
        equation, entries
            for readers, see :class:`Function`
        """
        self._check_function(name, [*inputs, *outputs], result)
        check_text(f"{self.name}.{name}", summary, source)
        check_text(f"{self.name}.{name}", *notes, lines=True)
        function = Function(
            name=name,
            summary=summary,
            inputs=tuple(array(k, v) for k, v in inputs.items()),
            outputs=tuple(array(k, v) for k, v in outputs.items()),
            body=tuple(program.body) if program else (),
            branches=branches,
            result=result,
            source=source,
            notes=tuple(notes),
            boolean=boolean,
            equation=equation,
            entries=tuple(entries),
        )
        self._check_symbols(function)
        self.functions.append(function)
        return function

    def claim(
        self,
        label: str,
        printed: str,
        check: Callable[..., Check] | None = None,
        *,
        where: str = "",
        notation: Notation | None = None,
        means: Mapping[str, Any] | None = None,
        phrases: Sequence[Mapping[str, Any]] = (),
        opposites: Mapping[str, str] | None = None,
        corrected: str = "",
        readings: Sequence[Reading] = (),
        erratum: str = "",
        paraphrase: bool = False,
        fixed: str = "",
    ) -> None:
        """Transcribe a statement of the paper, as printed.

        Parameters
        ----------
        label
            the number of the equation, or the place
        printed
            the text
        check
            how it is judged; without one, the formulas are equations that hold for all values of
            their symbols
        notation, means
            what the symbols mean, by default as in the whole paper, and more of it for this claim
        where, phrases, opposites, corrected, readings, erratum, paraphrase, fixed
            as the fields of :class:`Claim`
        """
        self.claims.append(
            Claim(
                label=label,
                printed=printed,
                check=check,
                where=where,
                notation=(notation or Notation({})).extended(means or {}),
                phrases=tuple(phrases),
                opposites=opposites or {},
                corrected=corrected,
                readings=tuple(readings),
                erratum=erratum,
                paraphrase=paraphrase,
                fixed=fixed,
            )
        )

    def erratum(
        self,
        key: str,
        title: str,
        gravity: Gravity,
        *,
        why: str,
        use: str,
        numbers: Mapping[str, tuple[Any, int]] | None = None,
    ) -> None:
        """Describe an error of the paper; claims that show it name its key.

        Parameters
        ----------
        key
            what claims call it
        title, gravity, why, use, numbers
            the fields of :class:`Erratum`
        """
        if key in [e.key for e in self.errata]:
            raise ValueError(f"{self.name}: the erratum {key} is described twice")
        self.errata.append(Erratum(key, title, gravity, why, use, numbers or {}))

    def no_inverse(self, because: str) -> None:
        """Give the reason why there is no inverse, such as ``"axes 5 and 6 do not intersect"``."""
        check_text(f"{self.name}: no_inverse", because)
        self.without_inverse = because

    def give_up_inverses(self, because: str) -> None:
        """Leave out all inverses, and say why."""
        names = {inverse.function for inverse in self.inverses}
        self.functions[:] = [f for f in self.functions if f.name not in names]
        self.solved[:] = [s for s in self.solved if s.function not in names]
        self.inverses.clear()
        self.branches = ()
        self.no_inverse(because)

    def __getitem__(self, name: str) -> Function:
        for function in self.functions:
            if function.name == name:
                return function
        raise KeyError(f"{self.name} has no function {name}")

    def __setattr__(self, attribute: str, value: Any) -> None:
        """Check names and texts on every assignment, not only in the constructor."""
        where = f"{attribute} of {value if attribute == 'name' else self.name}"
        if attribute == "name":
            check_robot(value)
        elif attribute == "title":
            check_text(where, value)
        elif attribute == "mechanism":
            check_text(where, value, lines=True)
        elif attribute in ("singularities", "poles"):
            check_text(where, *value)
        elif attribute in ("task", "branches", "assembly_modes"):
            check_labels(value, where)
        super().__setattr__(attribute, value)

    def _check_function(self, name: str, arrays: Sequence[str], result: str | None) -> None:
        known = [f.name for f in self.functions]
        where = f"{self.name}.{name}"
        if name in known:
            raise ValueError(f"{self.name}: the function {name} is defined twice")
        check_function(name, known, self.name)
        if result is not None and result not in RESULTS:
            raise ValueError(f"{where}: a result is one of {', '.join(RESULTS)}, not {result!r}")
        if result is not None and arrays[-1] != RESULTS[result]:
            raise ValueError(f"{where}: the output of {result} is called {RESULTS[result]}")
        statuses = ["status"] if result else []
        for k, array_name in enumerate(arrays):
            others = [*arrays[:k], *arrays[k + 1 :], *statuses]
            check_argument(array_name, others, where)
            check_own(array_name, self.name, [*known, name], where)

    def _check_new(self, name: str) -> None:
        check_symbol(name, self.name)
        check_own(name, self.name, [], self.name)
        kinds = {p.name: "parameter" for p in self.parameters}
        kinds |= {j.name: "joint" for j in self.joints}
        if name in kinds:
            raise ValueError(
                f"{self.name}: the name {name} is declared twice: there is a {kinds[name]} {name} "
                f"already; every joint and parameter needs a name of its own"
            )

    def _check_symbols(self, function: Function) -> None:
        own = {str(s) for s in function.symbols}
        own |= {str(s) for _, signs in function.cases() for s in signs}
        own |= {str(getattr(s, "symbol", "")) for s in function.body}
        if both := sorted(own & {p.name for p in self.parameters}):
            raise ValueError(
                f"{self.name}.{function.name}: {both[0]} is a parameter already; call the symbol "
                f"of the function {both[0]}_0, say"
            )
        known: set[sp.Basic] = {p.symbol for p in self.parameters} | set(function.symbols)
        if function.branches:
            known |= {s for signs in function.branches.signs for s in signs}
        for statement in function.body:
            used = [getattr(statement, "value", None), *getattr(statement, "values", ())]
            free = {s for e in used if e is not None for s in e.free_symbols}
            self._require_known(function, free - known)
            symbol = getattr(statement, "symbol", None)
            if symbol is not None:
                known.add(symbol)
        free = {s for a in function.outputs for e in a.entries for s in e.free_symbols}
        self._require_known(function, free - known)

    def _require_known(self, function: Function, unknown: set[sp.Basic]) -> None:
        if unknown:
            name = sorted(map(str, unknown))[0]
            declared = [p.name for p in self.parameters] + [j.name for j in self.joints]
            close = get_close_matches(name, [*declared, *map(str, function.symbols)], 1)
            hint = f"; did you mean {close[0]}?" if close and close[0] != name else ""
            if name in declared and name not in map(str, function.symbols):
                hint = f"; it is a joint: name it among the inputs of {function.name}"
            raise ValueError(
                f"{self.name}.{function.name}: the symbol {name} is neither a parameter nor an "
                f"input nor defined by an earlier statement{hint}"
            )
