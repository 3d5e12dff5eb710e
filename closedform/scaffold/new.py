"""Writes the skeleton of a derivation from a table of joints.

The skeleton has pose, Jacobians and determinant, and can be proved and printed as it is.  If the
structure of the arm is known, it also has the proposed inverse; otherwise a place for one.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

from closedform.algebra.formulas import number
from closedform.mechanics.arm import RowError, Serial, from_dh, from_screws
from closedform.mechanics.mobility import SingularEverywhereError
from closedform.model.derivation import Derivation
from closedform.model.functions import real
from closedform.model.names import check_robot, check_text, listed
from closedform.model.paper import Paper
from closedform.scaffold.chains.proposal import Tried
from closedform.scaffold.chains.propose import NoChainError, propose
from closedform.scaffold.chains.recognise import recognised
from closedform.scaffold.inputs.followers import declared, follow
from closedform.scaffold.inputs.mjcf import read_mjcf
from closedform.scaffold.inputs.motors import geared, motors_of
from closedform.scaffold.inputs.names import AUTHOR, CHAIN, IMPORTED
from closedform.scaffold.inputs.spelling import mistaken_units
from closedform.scaffold.inputs.tables import (
    Table,
    TableError,
    check_names,
    read_dh,
    read_screws,
)
from closedform.scaffold.inputs.tree import DEFAULT, Choice
from closedform.scaffold.inputs.urdf import read_urdf
from closedform.scaffold.limit import LimitError, bounded
from closedform.scaffold.loops.file import read_loop
from closedform.scaffold.loops.script import loop_script
from closedform.scaffold.source import LINE, file_name, fitted, literal, source, wrapped_literal

TIMEOUT = 60.0
"""Seconds after which a script is written without what was not found by then."""
LONGER = (
    "Allow more time with --timeout, or name lengths and angles in the table, which keeps the "
    "expressions short.  The forward map is in this script; to derive it may take long too."
)
FAILED = "Write the chain yourself, and report the table: a proposed chain should be proved."
IMPORTS = frozenset({"numpy", "sympy", "flint", "jinja2"})
"""Modules that a script of the same name would shadow."""
GEARED = (
    "The angles are taken as they are given, and not reduced: a whole turn of a joint need not be "
    "one of its motor."
)
"""A note on motors with gears."""
MOST_JOINTS = 7
"""Of an arm with an inverse; of seven joints one is given."""


@dataclass(frozen=True)
class Script:
    """The source of a derivation, and a clause on the inverse that it proposes or lacks.

    The ``notes`` say which entries of the table were not taken literally.
    """

    text: str
    inverse: str
    notes: tuple[str, ...] = ()
    explained: tuple[str, ...] = ()
    """What was recognised about the axes, and which chains were tried."""
    advice: str = ""
    """What to do if no inverse is proposed, or if the table may lack a tool."""
    structure: str = ""
    lemmas: tuple[str, ...] = ()
    """The structure that was recognised and the lemmas that solve it, if an inverse is proposed."""


@dataclass
class InverseSearch:
    """How to search for an inverse: the joint that is ``given``, and a limit of time in seconds.

    ``say`` is called with a description of each step.  ``fault`` is called with the name and the
    text of a script; it returns a clause on why the inverse in it is not proved, or an empty
    string.  After a clause the next chain is tried.  By default no proof is tried.
    """

    given: str = ""
    timeout: float = TIMEOUT
    explain: bool = False
    count: bool = True
    """Whether to count the solutions of an arm for which no chain is known."""
    say: Callable[[str], None] = lambda _: None
    fault: Callable[[str, str], str] = lambda *_: ""
    doing: str = "reading the table"

    def progress(self, what: str) -> None:
        self.doing = what
        self.say(what)


def check_name(name: str) -> None:
    """Raise ``ValueError`` unless a script may have this name."""
    check_robot(name)
    if name in IMPORTS or name in sys.stdlib_module_names:
        raise ValueError(f"{name} is a Python module; choose another name, such as {name}_arm")


def new(
    name: str,
    kind: str,
    path: Path,
    *,
    modified: bool = False,
    choice: Choice = DEFAULT,
    search: InverseSearch | None = None,
) -> Script:
    """A derivation called ``name``, from a table of the given kind.

    Raises ``ValueError`` if the name or the table cannot be used; it says where and how to correct
    it.

    Parameters
    ----------
    name
        that of the derivation
    kind
        ``"dh"``, ``"screws"``, ``"urdf"``, ``"mjcf"`` or ``"loop"`` (bodies and joints)
    path
        the file with the table
    modified
        whether Denavit-Hartenberg rows are in Craig's convention
    choice
        the chain to take of a URDF or MJCF file
    search
        how to search for an inverse
    """
    search = search or InverseSearch()
    search.progress("reading the table")
    check_name(name)
    if kind == "loop":
        loop = read_loop(path)
        text, kind = loop_script(name, loop, path.name)
        return Script(text, f"{kind}, of {len(loop.joints)} joints", tuple(loop.notes))
    read_tree = {"urdf": read_urdf, "mjcf": read_mjcf}.get(kind)
    if read_tree:
        table = read_tree(path, choice)
    else:
        table = read_dh(path, modified=modified) if kind == "dh" else read_screws(path)
        follow(table, path.name)
    check_names(table, path.name)
    if mistaken := mistaken_units(table.parameters):
        raise TableError(f"{path.name}: {mistaken}")
    for symbol, given in table.parameters.items():
        check_text(f"{path.name}: {symbol}", given.get("meaning", ""), given.get("unit", ""))
    try:
        script = skeleton(name, table, path.name, search)
    except (RowError, SingularEverywhereError) as error:
        raise TableError(f"{path.name}: {str(error).removeprefix(f'{name}: ')}") from error
    if script.structure or not read_tree:
        return script

    def without(length: str, told: InverseSearch) -> Script:
        return skeleton(
            name, read_tree(path, replace(choice, ignore=float(length))), path.name, told
        )

    tried = without_short(table, search, without)
    return replace(script, advice=f"{script.advice}  {tried}".strip())


def without_short(
    table: Table, search: InverseSearch, without: Callable[[str, InverseSearch], Script]
) -> str:
    """A sentence on what becomes of an arm ``without`` its short lengths, each of which is tried.

    Nothing is tried if there are too many joints.
    """
    if not table.short or len(table.joints) - len(table.followers) > MOST_JOINTS:
        return ""

    def first(say: Callable[[str], None]) -> str:
        for short in table.short:
            say(f"trying --ignore {short.ignore}")
            told = replace(search, timeout=0, explain=False, count=False, say=lambda _: None)
            with suppress(ValueError):
                found = without(short.ignore, told)
                if found.structure:
                    return (
                        f"{short.told}; if that is not meant, leave it out with "
                        f"--ignore {short.ignore}: then {found.inverse}."
                    )
        return f"Without short lengths there is no inverse either; {lengths} {were} tried."

    lengths = listed([f"--ignore {short.ignore}" for short in table.short])
    were = "were" if len(table.short) > 1 else "was"
    try:
        return bounded(search.timeout, first, search.progress)
    except LimitError:
        return (
            f"The limit of {search.timeout:g} s was reached while it was tried whether there is an "
            f"inverse without short lengths; {search.doing.removeprefix('trying ')} was the last."
        )


def _comment(text: str) -> str:
    """A text as a comment of one line."""
    line = " ".join(text.split())
    return "# " + "".join(c if c.isprintable() else "?" for c in line)


def skeleton(name: str, table: Table, origin: str, search: InverseSearch) -> Script:
    """The script, with the proposed inverse or a place for one."""
    origin = file_name(origin)
    negative = _negative(table)

    def made(told: InverseSearch) -> Serial:
        told.progress("deriving the forward map")
        d = Derivation(name, name, Paper("own", "own", ()), "")
        for symbol in table.parameters:
            d.parameter(symbol, value=1, unit="", meaning="", nonnegative=symbol not in negative)
        for joint, kind, coupling in declared(table):
            d.joint(joint, kind, coupling=coupling)  # type: ignore[arg-type]
        symbols = [*(p.symbol for p in d.parameters), *(j.symbol for j in d.joints)]
        known = {symbol.name: symbol for symbol in symbols}
        return _arm(d, table, known)

    head = _head(name, table, origin, negative)
    try:
        inverse = _searched(name, made, head, search)
    except LimitError:
        reason = f"the limit of {search.timeout:g} s was reached while {search.doing}"
        inverse = _without_inverse(reason, LONGER, "ik = Chain(d, forward)")
    return Script(
        text=_script(head, inverse),
        inverse=inverse.outcome,
        notes=tuple(table.notes),
        explained=tuple(inverse.explained),
        advice=inverse.advice if inverse.structure else f"{inverse.advice}  {table.doubt}".strip(),
        structure=inverse.structure,
        lemmas=inverse.lemmas,
    )


def _head(name: str, table: Table, origin: str, negative: Sequence[str]) -> list[str]:
    """The lines up to the inverse; one says where the imports belong."""
    title = name.replace("_", " ").capitalize()
    lines = [
        f'"""{title}: a derivation from {origin}."""',
        "",
        "IMPORTS",
        "",
        "d = Derivation(",
        f'    "{name}",',
        f'    "{title}",',
        f'    Paper("{name}", "{title}", ("the file {origin}",)),',
        *wrapped_literal(_told(table)),
        ")",
    ]
    lines += [_comment(f"{note}.") for note in table.notes]
    for symbol, given in table.parameters.items():
        value = number(given.get("value") or "1")
        exact = f"{value.numerator}" if value.denominator == 1 else f'Rational("{value}")'
        sign = ", nonnegative=False" if symbol in negative else ""
        unit, meaning = (
            literal(given.get(key) or default)
            for key, default in (("unit", "m"), ("meaning", "say what it measures"))
        )
        lines.append(
            f'{symbol} = d.parameter("{symbol}", value={exact}, unit={unit}, '
            f'meaning={meaning}, source="{origin}"{sign})'
        )
    for joint, kind, coupling in declared(table):
        argument = ', "prismatic"' if kind == "prismatic" else ""
        if coupling is not None:
            argument += f", coupling={source(coupling)}"
        if joint in table.limits:
            least, most = (f'Rational("{value}")' for value in table.limits[joint])
            argument += f", limits=({least}, {most})"
        lines.append(f'{joint} = d.joint("{joint}"{argument})')
    return [
        *lines,
        "",
        *_table_lines(table),
        "forward = arm.export(d)",
        *_motor_lines(table, origin),
    ]


def _told(table: Table) -> str:
    """What the article says of the arm, for the author to extend."""
    slides, count = sum(k == "prismatic" for k in table.joints.values()), len(table.joints)
    kinds = f", of which {slides} {'slides' if slides == 1 else 'slide'}" if slides else ""
    if moved := len(table.followers):
        kinds += f"; {moved} of them {'follow' if moved > 1 else 'follows'} others"
    arm = f"An arm of {count} {'joint' if count == 1 else 'joints'}{kinds}"
    if table.rows:
        kind = "modified (Craig's)" if table.modified else "standard"
        return (
            f"{arm}.  Its table of Denavit and Hartenberg is in the {kind} convention, and gives "
            "zero and the positive sense of each joint."
        )
    return (
        f"{arm}.  All are zero in the posture of the file, and move about or along the axes that "
        "it gives."
    )


def _script(head: Sequence[str], inverse: _Inverse) -> str:
    text = "\n".join([*head, "", *inverse.lines])
    imported = text.replace("IMPORTS", _imports(text), 1).split("\n")
    return "\n".join(part for line in imported for part in fitted(line)) + "\n"


def _negative(table: Table) -> list[str]:
    """The parameters that may be negative: angles, slides that are held, those whose value is."""
    return [
        n
        for n, given in table.parameters.items()
        if given.get("value", "1").startswith("-")
        or given.get("unit") == "rad"
        or "signed" in given
    ]


def _arm(d: Derivation, table: Table, known: Mapping[str, Any]) -> Serial:
    """The chain of the table, with the symbols of the derivation."""

    def own(e: Any) -> Any:
        return e.xreplace({s: known[s.name] for s in e.free_symbols})

    if table.rows:
        return from_dh(d, [tuple(map(own, row)) for row in table.rows], modified=table.modified)
    axes = [(own(j), [own(e) for e in w], [own(e) for e in p]) for j, w, p in table.axes]
    base = None if table.base is None else table.base.applyfunc(own)
    return from_screws(d, axes, table.home.applyfunc(own), base=base)


def _table_lines(table: Table) -> list[str]:
    if table.rows:
        rows = [f"        ({', '.join(map(source, row))})," for row in table.rows]
        end = "    modified=True,\n)" if table.modified else ")"
        return ["arm = from_dh(", "    d,", "    [", *rows, "    ],", end]
    axes = [
        f"        ({source(joint)}, ({', '.join(map(source, w))}), ({', '.join(map(source, p))})),"
        for joint, w, p in table.axes
    ]
    return [
        "arm = from_screws(",
        "    d,",
        "    [",
        *axes,
        "    ],",
        f"    {source(table.home)},",
        *([] if table.base is None else [f"    base={source(table.base)},"]),
        ")",
    ]


def _motor_lines(table: Table, origin: str) -> list[str]:
    """The functions between motors and joints, if some joints are coupled."""
    if not table.couplings:
        return []
    names, matrix = motors_of(table, origin)
    if through := _through_parallelograms(table):
        driven = ", ".join(f"{q}: ({before}, {source(a)})" for q, (before, a) in through.items())
        motors = ", ".join(f'"{name}"' for name in names)
        return ["", f"parallelogram_drive(d, {{{driven}}}, [{motors}])"]
    joints = ", ".join(joint for joint, _, coupling in declared(table) if coupling is None)
    note = [f"    notes=[{literal(GEARED)}],"] if geared(table, matrix) else []
    symbols = ", ".join(f'real("{name}")' for name in names)
    return [
        "",
        "# The motors: a joint without a coupling has one of its own.",
        f"motors = Matrix([{symbols}])",
        f"coupling = {source(matrix)}",
        "d.function(",
        '    "joints_from_motors",',
        '    "The angles of the joints from those of their motors.",',
        '    {"motors": motors},',
        '    {"q": coupling * motors},',
        *note,
        ")",
        "d.function(",
        '    "motors_from_joints",',
        '    "The angles of the motors from those of the joints.",',
        f'    {{"q": Matrix([{joints}])}},',
        f'    {{"motors": coupling.inv() * Matrix([{joints}])}},',
        *note,
        ")",
    ]


def _through_parallelograms(table: Table) -> dict[str, tuple[str, Any]]:
    """The joint before each joint that a parallelogram drives, and the length of the link between.

    Empty unless each coupling is the difference of two motors, and the axes of both joints are
    parallel.
    """
    through: dict[str, tuple[str, Any]] = {}
    own = {q: table.couplings.get(q, real(f"m_{q}")) for q in table.joints}
    rows = {str(s): k for k, row in enumerate(table.rows) for s in row[-1].free_symbols}
    for before, q in pairwise(table.joints):
        if own[q].is_Symbol:
            continue
        a, alpha = table.rows[rows[before]][:2] if before in rows else (0, 0)
        beside = rows.get(q) == rows.get(before, -2) + 1 and alpha == 0 and a != 0
        motor = own[q] + own[before]
        if table.modified or not beside or not (own[before].is_Symbol and motor.is_Symbol):
            return {}
        through[q] = (before, a)
    return through


@dataclass(frozen=True)
class _Inverse:
    """The lines for the inverse, a clause on what they contain, and how the chain was chosen."""

    lines: list[str]
    outcome: str
    explained: list[str] = field(default_factory=list)
    advice: str = ""
    structure: str = ""
    lemmas: tuple[str, ...] = ()
    name: str = ""
    """The name of the chain that was taken."""


def _searched(
    name: str, made: Callable[[InverseSearch], Serial], head: Sequence[str], search: InverseSearch
) -> _Inverse:
    """The lines of the first chain that is proved; it counts too if the time ends the proof."""
    refused: list[Tried] = []

    def proposed(say: Callable[[str], None]) -> _Inverse:
        told = replace(search, say=say)
        arm = made(told)
        told.progress("looking for a regular posture")
        arm.require_regular(name)
        told.progress("looking for an inverse")
        return _inverse_lines(arm, told, refused)

    def fault_of(inverse: _Inverse, say: Callable[[str], None]) -> str:
        say("proving the inverse")
        return search.fault(name, _script(head, inverse))

    while True:
        inverse = bounded(search.timeout, proposed, search.progress)
        if not inverse.structure:
            return inverse
        try:
            wrong = bounded(search.timeout, partial(fault_of, inverse), search.progress)
        except LimitError:
            return inverse
        if not wrong:
            return inverse
        error = NoChainError(f"its proof fails: {wrong}", FAILED)
        refused.append(Tried(inverse.name, error))


def _inverse_lines(arm: Serial, search: InverseSearch, refused: Sequence[Tried]) -> _Inverse:
    task = arm.coordinates()
    angles = ', angles=["yaw"]' if task and "yaw" in task.names else ""
    chain = f"ik = Chain(d, forward{angles})"
    explained = recognised(arm) if search.explain else []
    try:
        found = propose(arm, search.given, search.progress, refused, count=search.count)
    except NoChainError as error:
        explained += [f"tried: {t.name}: no, because {t.error.found}" for t in error.tried]
        return _without_inverse(error.found, error.needed, chain, explained)
    explained += [f"tried: {t.name}: no, because {t.error.found}" for t in found.tried]
    explained.append(f"taken: {found.structure}")
    count = f"{found.branches} branch{'es' if found.branches > 1 else ''}"
    lines = [
        _comment(f"The inverse proposed for this structure: {found.structure}."),
        "# Edit it as you like, and name the branches; the proof decides.",
        chain,
        *found.lines,
        'ik.finish("All solutions of the inverse kinematics.")',
    ]
    outcome = f"an inverse with {count} is proposed ({found.structure})"
    return _Inverse(
        lines=lines,
        outcome=outcome,
        explained=explained,
        advice=found.doubt or _only_turned(arm),
        structure=found.structure,
        lemmas=found.lemmas,
        name=found.name,
    )


def _only_turned(arm: Serial) -> str:
    """What to do if the last joint of a short arm does not move the origin of the tool."""
    if len(arm.joints) > 4 or arm.coordinates() is not None:
        return ""
    *others, last = (arm.geometric[:3, k].is_zero_matrix for k in range(len(arm.joints)))
    if not last or all(others):
        return ""
    return (
        f"The origin of the tool is on the axis of {arm.joints[-1]}, which only turns the tool.  "
        f"If the tool is farther away, add it to the table, or choose its link with --tool."
    )


def _without_inverse(
    found: str, needed: str, chain: str, explained: Sequence[str] = ()
) -> _Inverse:
    reason = f"No inverse is proposed, because {found}.  {needed}"
    lines = [
        _comment(reason),
        "# Write it here, lemma by lemma, instead of the last line of this file;",
        "# docs/adding-a-mechanism.md says how:",
        f"# {chain}",
        "# ik.solve(turn, theta1, (a, b, c), {+1: 'left', -1: 'right'})",
        '# ik.finish("All solutions.")',
        f"d.no_inverse({literal(found)})",
    ]
    return _Inverse(lines, f"no inverse, because {found}", list(explained), needed)


def _imports(text: str) -> str:
    """The imports that the script needs, in the order that linters want."""
    code = "\n".join(line for line in text.splitlines() if not line.startswith("#"))

    def used(names: Sequence[str]) -> list[str]:
        return [n for n in names if re.search(rf"(?<![\w.\"]){n}(?!\w)", code)]

    symbolic = used(sorted(IMPORTED))
    ours = used(sorted((*AUTHOR, *CHAIN), key=lambda name: (name.islower(), name)))
    lines = [f"from sympy import {', '.join(symbolic)}", ""] if symbolic else []
    return "\n".join([*lines, *_folded(f"from closedform import {', '.join(ours)}")])


def _folded(statement: str) -> list[str]:
    """An import, on several lines if it is too long for one."""
    if len(statement) <= LINE:
        return [statement]
    start, _, names = statement.partition("import ")
    return [f"{start}import (", *(f"    {name}," for name in names.split(", ")), ")"]
