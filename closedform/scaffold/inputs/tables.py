"""Reads a table of joints: Denavit-Hartenberg rows from CSV, or axes at home from TOML.

A table is data: nothing in it is run, and :mod:`closedform.algebra.formulas` says what a cell may
contain.  Anything that cannot be read raises :class:`TableError`, which says where it is and how
to correct it.

A Denavit-Hartenberg table is CSV with the columns ``a, alpha, d, theta`` and optionally ``joint``,
the name of the variable of a row.  By default this is the symbol in ``theta``, or the one in ``d``
if ``theta`` is a number.  A row without a variable is a fixed transform.  A column ``motors`` says
what moves a joint that is not driven by a motor of its own, as ``m3 - m2`` for a parallelogram,
``m3/50`` for a gear, ``pitch/(2*pi)*m3`` for a screw, or ``-2*m2`` if a belt leads from another.
Screws are TOML with ``[[axes]]`` and ``[home]``.  Every other symbol is a parameter; its value,
unit and meaning come from comment lines ``# name = value unit: meaning`` or from the table
``[parameters]``.
"""

from __future__ import annotations

import csv
import re
import tomllib
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import sympy as sp

from closedform.algebra.formulas import TABLE, FormulaError, formula, number, shown
from closedform.model.functions import real
from closedform.model.names import check_symbol
from closedform.scaffold.inputs import exact
from closedform.scaffold.inputs.names import is_taken, names_in, symbol_of
from closedform.scaffold.inputs.spelling import PI, instead, rounded

COLUMNS = ("a", "alpha", "d", "theta")
LARGEST = 64_000
"""Maximum size of a table in bytes, far more than any arm needs."""
LONGEST = 2000
"""Maximum length of a line: the time to read it can grow with the square of its length."""
JOINTS = 16
ROWS = 32
DIGITS = re.compile(r"[-+0-9./eE]+")
EXAMPLE = (
    "write one in a line '# {} = 0.1 m: what it is'",
    "write one in [parameters], as {} = 0.1",
)
"""How to give a value to a parameter, in CSV and in TOML."""


class TableError(ValueError):
    """A table of joints that cannot be read; the message says where."""


@dataclass(frozen=True)
class Short:
    """A length that may not be meant: what it is, as a clause, and the ``--ignore`` without it."""

    told: str
    ignore: str


@dataclass
class Table:
    """The content of a table: joints in order with their kinds, parameters, and rows or axes."""

    joints: dict[str, str] = field(default_factory=dict)
    parameters: dict[str, dict[str, str]] = field(default_factory=dict)
    rows: list[tuple[Any, ...]] = field(default_factory=list)
    axes: list[tuple[Any, Any, Any]] = field(default_factory=list)
    """What turns or slides, a joint to which an angle may be added; its direction and a point."""
    home: Any = None
    base: Any = None
    """The pose of the frame from which axes and home are seen, if it is not the identity."""
    modified: bool = False
    limits: dict[str, tuple[str, str]] = field(default_factory=dict)
    """The least and the largest value of a joint, as decimals."""
    couplings: dict[str, Any] = field(default_factory=dict)
    """What drives joints: each as a sum of motors, with rational factors if it turns."""
    followers: dict[str, tuple[str, Any]] = field(default_factory=dict)
    """Joints that move with another one, which has a motor: its name and the factor."""
    notes: list[str] = field(default_factory=list)
    """Entries that were not taken literally, in words for the author of the table."""
    end: str = ""
    """The link at the end of a chain."""
    doubt: str = ""
    """A sentence on the end of the chain, which may not be meant, for an arm without an inverse."""
    short: list[Short] = field(default_factory=list)
    """Lengths that may not be meant, for an arm without an inverse."""


def check_names(table: Table, where: str) -> None:
    """Refuse names that clash, because joints and parameters become variables of the script."""
    for name in (*table.parameters, *table.joints):
        check_table_name(name, where)
    if both := [name for name in table.joints if name in table.parameters]:
        raise TableError(f"{where}: {both[0]} is a joint and a parameter; rename one of them")


def check_table_name(name: str, where: str) -> None:
    check_variable(name, where, taken=is_taken(name))


def check_variable(name: str, where: str, *, taken: bool) -> None:
    """Refuse a name that cannot be a variable of the script, or is ``taken`` there."""
    if taken:
        raise TableError(
            f"{where}: the written script uses the name {name} itself; "
            f"choose another, such as {name}_0"
        )
    try:
        check_symbol(name, where)
    except ValueError as error:
        raise TableError(str(error)) from error


def _check_value(name: str, value: str, where: str) -> None:
    """Refuse a value that floating point cannot represent, because it is printed as such."""
    try:
        given = number(value)
        if float(given) != 0 or given == 0:
            return
    except (FormulaError, OverflowError):
        pass
    raise TableError(
        f"{where}: the value of {shown_name(name)} is {shown(value)}; it must be a number such as "
        f"0.45 or 9/20"
    )


def shown_name(name: str) -> str:
    """A name in a message, quoted only if it is not an identifier."""
    return name if name.isascii() and name.isidentifier() and len(name) < 60 else shown(name)


def content_of(path: Path, largest: int, what: str) -> bytes:
    """The content of a file that is not trusted; raises if it has more than ``largest`` bytes."""
    try:
        with path.open("rb") as file:
            content = file.read(largest + 1)
    except OSError as error:
        raise TableError(f"cannot read {path}: {error.strerror}") from error
    if len(content) > largest:
        raise TableError(f"{path.name} is too large; {what} has at most {largest} bytes")
    return content


def text_of(path: Path) -> str:
    try:
        text = content_of(path, LARGEST, "a table of joints").decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise TableError(
            f"{path.name} is not UTF-8 text; save it as plain text in UTF-8"
        ) from error
    for i, line in enumerate(text.splitlines(), 1):
        if len(line) > LONGEST:
            raise TableError(
                f"{path.name}, line {i}: the line has {len(line)} characters, more than {LONGEST}"
            )
    return text


def _remark(line: str) -> tuple[str, str, str, str] | None:
    """The name, value, unit and meaning in a comment ``# name = value unit: meaning``."""
    name, equals, rest = line.lstrip("# \t").partition("=")
    words, _, meaning = rest.strip().partition(":")
    name, words = name.strip(), words.strip()
    if not (line.startswith("#") and equals and words and name.isidentifier()):
        return None
    digits = DIGITS.match(words)
    value = digits[0] if digits else words.split()[0]
    return name, value, words[len(value) :].strip(), meaning.strip()


def _cells(line: str, where: str) -> list[str]:
    try:
        (cells,) = csv.reader([line], skipinitialspace=True, strict=True)
    except (csv.Error, ValueError) as error:
        raise TableError(f"{where}: {shown(line)} is not a line of CSV: {error}") from error
    return cells


def read_dh(path: Path, *, modified: bool = False) -> Table:
    """A Denavit-Hartenberg table from CSV."""
    table = Table(modified=modified)
    numbered, unread = _split(path, table)
    if not numbered:
        raise TableError(f"{path.name}: the table is empty")
    header = _header(numbered[0][1], numbered[0][0])
    if len(numbered) == 1:
        raise TableError(f"{path.name}: the table has only column names and no rows")
    if len(numbered) > ROWS + 1:
        raise TableError(f"{path.name}: the table has more than {ROWS} rows")
    for where, cells in numbered[1:]:
        _read_row(table, header, cells, where)
    places = [where for where, _ in numbered[1:]]
    if not table.joints:
        raise TableError(
            f"{places[0]}: there is no joint, because neither theta nor d has a symbol without a "
            f"value; a revolute joint is a symbol in theta, such as theta1, a slide one in d"
        )
    _other_symbols(table, [e for row in table.rows for e in row], path.name)
    for name in table.parameters:
        if name in unread:
            where, value = unread[name]
            _check_value(name, value, where)
            raise TableError(f"{where}: write '# {name} = {value} unit: meaning'")
    angles = _angles(table)
    table.rows = [
        tuple(
            angles.read(entry, f"{where}, column {column}", angle=column in ("alpha", "theta"))
            for column, entry in zip(COLUMNS, row, strict=True)
        )
        for where, row in zip(places, table.rows, strict=True)
    ]
    _declare(table, angles)
    return table


def _split(
    path: Path, table: Table
) -> tuple[list[tuple[str, list[str]]], dict[str, tuple[str, str]]]:
    """The cells of every row, and remarks that may be values; the values go into the table.

    Each has its place in the file, for messages.
    """
    rows: list[tuple[str, list[str]]] = []
    unread: dict[str, tuple[str, str]] = {}
    for i, line in enumerate(text_of(path).splitlines(), 1):
        where = f"{path.name}, line {i}"
        if remark := _remark(line.strip()):
            symbol, value, unit, meaning = remark
            if not any(c.isdecimal() for c in value):  # perhaps a sentence, not a value
                unread[symbol] = where, value
                continue
            if symbol in table.parameters:
                raise TableError(f"{where}: the parameter {symbol} already has a value")
            _check_value(symbol, value, where)
            table.parameters[symbol] = {"value": value, "unit": unit, "meaning": meaning}
        elif line.strip() and not line.lstrip().startswith("#"):
            rows.append((where, _cells(line, where)))
    return rows, unread


def _read_row(table: Table, header: Sequence[str], cells: Sequence[str], where: str) -> None:
    """Add a row to a table, with its joint if it has one."""
    if len(cells) != len(header):
        raise TableError(
            f"{where}: {len(cells)} entries in {len(header)} columns; there must be one entry "
            f"for each of {', '.join(header)}"
        )
    cell = dict(zip(header, (c.strip() for c in cells), strict=True))
    places = {c: f"{where}, column {c}" for c in COLUMNS}
    names = names_in(cell[c] for c in COLUMNS)
    entries = {c: expression(cell[c], places[c], names) for c in COLUMNS}
    for column in ("alpha", "theta"):
        if what := rounded(entries[column], cell[column]):
            raise TableError(f"{places[column]}: {what}")
    held = {n for n in names - {*table.parameters} if symbol_of(n) in table.parameters}
    entries = _renamed(entries, held, table, where)
    given = cell.get("joint", "")
    found = _joint(symbol_of(given) if given in held else given, entries, where, table)
    if found:
        entries = _renamed(entries, {found[0]}, table, where)
        found = symbol_of(found[0]), found[1]
        add_joint(table, *found, where)
    for column, entry in entries.items():
        for symbol in sorted(map(str, entry.free_symbols)):
            check_table_name(symbol, places[column])
    if given := cell.get("motors", ""):
        _couple(table, found[0] if found else "", given, f"{where}, column motors")
    if not found:
        table.notes.append(f"{where}: the row has no joint, so it is a fixed transform")
    table.rows.append(tuple(entries[c] for c in COLUMNS))


def _renamed(
    entries: Mapping[str, Any], joints: Collection[str], table: Table, where: str
) -> dict[str, Any]:
    """The entries of a row with what the script calls some joints."""
    own = {
        real(name): real(own_name(name, table, f"{where}, joint {shown_name(name)}"))
        for name in sorted(joints)
    }
    return {column: entry.xreplace(own) for column, entry in entries.items()}


def _angles(table: Table) -> exact.Angles:
    names = {*table.joints, *table.parameters}
    return exact.Angles(lambda name: name in names)


def _declare(table: Table, angles: exact.Angles) -> None:
    """Declare each angle that got a name as a parameter."""
    for angle, symbol in angles.named.items():
        where, value = angles.places[angle], exact.decimal(angle)
        shown = value if angle.is_Rational else angle
        table.parameters[symbol.name] = {
            "value": value,
            "unit": "rad",
            "meaning": f"the angle {shown} of the table",
        }
        table.notes.append(
            f"{where}: the cosine of {shown} has no short form with square roots, so this angle "
            f"is the parameter {symbol.name} = {value} rad"
        )


def _couple(table: Table, joint: str, text: str, where: str) -> None:
    """Note the motors of a joint."""
    if not joint:
        raise TableError(f"{where}: the row has no joint that motors could drive")
    total = sp.expand(expression(text, where))
    motors = total.free_symbols - {real(name) for name in table.parameters}
    factors = [total.diff(motor) for motor in motors]
    if table.joints[joint] == "revolute" and not all(k.is_Rational for k in factors):
        raise TableError(
            f"{where}: {shown(text)} is not a sum of motors with integer or rational coefficients, "
            f"such as m3 - m2 or m3/50"
        )
    if (
        not motors
        or total.subs(dict.fromkeys(motors, 0)) != 0
        or any(k.free_symbols & motors for k in factors)
    ):
        raise TableError(
            f"{where}: {shown(text)} is not a sum of multiples of motors, such as "
            f"m3 + 0.02/(2*pi)*m4 for a screw"
        )
    table.couplings[joint] = total


def own_name(name: str, table: Table, where: str) -> str:
    """What the script calls a joint of the file; a note says so if that is another name."""
    own = symbol_of(name)
    if own != name:
        table.notes.append(f"{where}: it is called {own}")
    return own


def add_joint(table: Table, joint: str, kind: str, where: str) -> None:
    if joint in table.joints:
        raise TableError(
            f"{where}: two joints have the name {shown_name(joint)}; if one motor moves both, give "
            f"them different names, and write what moves each in a column motors"
        )
    if len(table.joints) == JOINTS:
        raise TableError(f"{where}: there are more than {JOINTS} joints")
    table.joints[joint] = kind


def _header(cells: Sequence[str], where: str) -> list[str]:
    given = [h.strip() for h in cells]
    header = [h.lower() for h in given]
    names = ", ".join(COLUMNS)
    if missing := [c for c in COLUMNS if c not in header]:
        raise TableError(
            f"{where}: the column {missing[0]} is missing; the first line must name the columns "
            f"{names}, separated by commas"
        )
    if unknown := [h for h in given if h.lower() not in (*COLUMNS, "joint", "motors")]:
        raise TableError(
            f"{where}: the column {shown_name(unknown[0])} is unknown; the columns are {names} "
            f"and optionally joint and motors"
        )
    if twice := [c for i, c in enumerate(header) if c in header[:i]]:
        raise TableError(f"{where}: there are two columns {shown_name(twice[0])}")
    return header


def _joint(
    given: str, entries: Mapping[str, Any], where: str, table: Table
) -> tuple[str, str] | None:
    """The joint of a row and its kind, or None if the row has none: one with a value is held."""
    given = "" if given in table.parameters else given
    for column, kind in (("theta", "revolute"), ("d", "prismatic")):
        held = sorted(map(str, entries[column].free_symbols))
        names = [n for n in held if n not in table.parameters]
        if given in held or (not given and len(names) == 1):
            return given or names[0], kind
        if not given and (earlier := [n for n in names if n in table.joints]):
            motors = entries[column].as_independent(*entries[column].free_symbols)[1]
            raise TableError(
                f"{where}: {column} has {', '.join(names)}, and {earlier[0]} is the joint of an "
                f"earlier row; if motors drive both, through a belt or a parallelogram, give this "
                f"joint a new name and write {motors} in a column motors; if the row keeps a hand "
                f"level, leave it out and add the lengths after it to the first row"
            )
        if names and not given:
            raise TableError(
                f"{where}: {column} has the symbols {', '.join(names)}, and only one can be the "
                f"joint; give the others values in lines '# {names[-1]} = 0.1 m: what it is', or "
                f"add a column joint with the name of the joint"
            )
    if given:
        raise TableError(
            f"{where}: there is no joint, because neither theta nor d has {shown_name(given)}; "
            f"a revolute joint is a symbol in theta, such as theta1, a slide one in d"
        )
    return None


def read_screws(path: Path) -> Table:
    """Axes and the pose at home from TOML."""
    try:
        data = tomllib.loads(text_of(path), parse_float=str)
    except TableError:
        raise
    except (ValueError, RecursionError) as error:
        why = "it is nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise TableError(f"{path.name} is not valid TOML: {why}") from error
    check_keys(data, ("parameters", "axes", "home"), path.name)
    table = Table()
    where = f"{path.name}, [parameters]"
    parameters = data.get("parameters", {})
    check_keys(parameters, None, where)
    for name, entry in parameters.items():
        table.parameters[name] = parameter(name, entry, where)
    axes = data.get("axes")
    if not isinstance(axes, list) or not axes:
        raise TableError(f"{path.name}: there are no [[axes]]; each joint needs one")
    for i, axis in enumerate(axes, 1):
        _read_axis(table, axis, f"{path.name}, axis {i}", f"theta{i}")
    table.home = _home(data.get("home", {}), f"{path.name}, [home]")
    used = [e for _, *vectors in table.axes for v in vectors for e in v]
    _other_symbols(table, [*used, *table.home], path.name)
    use_exact(table, path.name)
    return table


def _read_axis(table: Table, axis: Any, where: str, usual: str) -> None:
    """Add a joint to a table, which has a ``usual`` name in messages."""
    check_keys(axis, ("joint", "kind", "direction", "point", "motors"), where)
    for key in ("joint", "direction"):
        if key not in axis:
            raise TableError(f"{where}: {key} is missing")
    joint, kind = axis["joint"], axis.get("kind", "revolute")
    if not isinstance(joint, str):
        raise TableError(f'{where}: joint must be a name, such as "{usual}", not {shown(joint)}')
    if kind not in ("revolute", "prismatic"):
        raise TableError(f"{where}: kind must be revolute or prismatic, not {_plain(kind)}")
    if names_in([joint]) == {joint}:
        joint = own_name(joint, table, f"{where}, joint {shown_name(joint)}")
    add_joint(table, joint, kind, where)
    direction, point = (
        _vector(axis.get(key, [0, 0, 0]), f"{where}, {key}") for key in ("direction", "point")
    )
    table.axes.append((real(joint), direction, point))
    if "motors" in axis:
        _couple(table, joint, axis["motors"], f"{where}, motors")


def use_exact(table: Table, file: str) -> None:
    """Make directions and rotations in decimals exact, and name angles without square roots."""
    axes: list[tuple[Any, Any, Any]] = []
    directions: list[sp.Matrix] = []
    for i, (joint, direction, point) in enumerate(table.axes, 1):
        given = sp.Matrix(direction)
        if not given.free_symbols and not exact.orthonormal(given):
            unit = exact.unit_vector(given, directions)
            if unit is not None and unit != given:
                table.notes.append(
                    f"{file}, axis {i}: the direction {exact.decimals(given)} is rounded; the unit "
                    f"vector {exact.coordinates(unit)} is used instead"
                )
                given = unit
        directions.append(given)
        axes.append((joint, list(given), point))
    R = table.home[:3, :3]
    if not R.free_symbols and not exact.orthonormal(R):
        turned = exact.rotation(R, directions)
        if turned is not None and turned != R:
            table.home[:3, :3] = turned
            rows = ", ".join(exact.coordinates(turned.row(i)) for i in range(3))
            table.notes.append(
                f"{file}, [home]: the rotation is rounded; the rows {rows} are used instead"
            )
    angles = _angles(table)
    table.axes = [
        (
            angles.read(joint, f"{file}, axis {i}", angle=True),
            *([angles.read(e, f"{file}, axis {i}") for e in v] for v in vectors),
        )
        for i, (joint, *vectors) in enumerate(exact.straightened(axes), 1)
    ]
    table.home = table.home.applyfunc(lambda e: angles.read(e, f"{file}, [home]"))
    if table.base is not None:
        table.base = table.base.applyfunc(lambda e: angles.read(e, f"{file}, the mount"))
    _declare(table, angles)


def check_keys(given: Any, known: Sequence[str] | None, where: str) -> None:
    if not isinstance(given, dict):
        raise TableError(f"{where} must be a table of keys and values, not {_plain(given)}")
    if known is not None and (unknown := [key for key in given if key not in known]):
        raise TableError(
            f"{where}: the key {shown_name(unknown[0])} is unknown; the keys are {', '.join(known)}"
        )


def parameter(name: str, entry: Any, where: str) -> dict[str, str]:
    given = entry if isinstance(entry, dict) else {"value": entry}
    check_keys(given, ("value", "unit", "meaning"), f"{where}, {shown_name(name)}")
    for key in ("unit", "meaning"):
        if not isinstance(given.get(key, ""), str):
            raise TableError(
                f"{where}: the {key} of {shown_name(name)} must be a string, not "
                f"{_plain(given[key])}"
            )
    text = {key: given[key] for key in ("unit", "meaning") if key in given}
    if "value" in given:
        value = given["value"]
        if not isinstance(value, str | int) or isinstance(value, bool):
            raise TableError(
                f"{where}: the value of {shown_name(name)} is {shown(value)}; it must be a number"
            )
        text["value"] = _plain(value)
        _check_value(name, text["value"], where)
    return text


def _plain(value: Any) -> str:
    """A TOML value as text: a text or a number as it is, anything else by its kind."""
    if isinstance(value, str):
        return value
    if isinstance(value, int) and value.bit_length() <= TABLE.bits:
        return str(value)
    return shown(value)


def _home(given: Any, where: str) -> sp.Matrix:
    """The pose of the tool, 4x4, when all joints are zero."""
    check_keys(given, ("position", "rotation"), where)
    if "position" not in given:
        raise TableError(
            f"{where}: position is missing; it is the place of the tool when all joints are zero, "
            f"such as [1, 0, 0]"
        )
    rows = given.get("rotation", [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    if not isinstance(rows, list) or len(rows) != 3:
        raise TableError(f"{where}: rotation must have 3 rows of 3 entries, not {_plain(rows)}")
    R = sp.Matrix([_vector(row, f"{where}, rotation, row {i}") for i, row in enumerate(rows, 1)])
    p = sp.Matrix(_vector(given["position"], f"{where}, position"))
    return sp.Matrix.vstack(sp.Matrix.hstack(R, p), sp.Matrix([[0, 0, 0, 1]]))


def _vector(given: Any, where: str) -> list[Any]:
    """Three expressions."""
    if not isinstance(given, list) or len(given) != 3:
        raise TableError(f"{where} needs 3 coordinates, such as [0, 0, 1], not {shown(given)}")
    return [expression(entry, where) for entry in given]


def expression(text: Any, where: str, allowed: Collection[str] = ()) -> Any:
    """An exact expression; parameters may have ``allowed`` names, which the script uses too."""
    if not isinstance(text, str | int) or isinstance(text, bool):
        raise TableError(f"{where}: {shown(text)} is not a number or formula")
    try:
        return formula(_plain(text), lambda name: _symbol(name, where, allowed))
    except (FormulaError, TableError) as error:
        if what := instead(_plain(text)):
            raise TableError(f"{where}: cannot read {shown(text)}; {what}") from error
        raise TableError(f"{where}: {str(error).removeprefix(f'{where}: ')}") from error


def _symbol(name: str, where: str, allowed: Collection[str]) -> Any:
    if PI.fullmatch(name):
        raise TableError(f"{where}: write pi for the number, instead of {name}")
    if name not in allowed:
        check_table_name(name, where)
    return real(name)


def _other_symbols(table: Table, entries: Sequence[Any], where: str) -> None:
    """Add every symbol that is not a joint as a parameter, in the order of first use."""
    for entry in entries:
        for name in sorted(map(str, entry.free_symbols)):
            if name not in table.joints:
                table.parameters.setdefault(name, {})
    used = {str(s) for e in (*entries, *table.couplings.values()) for s in e.free_symbols}
    if untold := [n for n, given in table.parameters.items() if "value" not in given]:
        table.notes.append(
            f"{where}: no value is given for {', '.join(untold)}, so 1 is taken; "
            f"{EXAMPLE[where.endswith('.toml')].format(untold[0])}"
        )
    if unused := [n for n in table.parameters if n not in used]:
        raise TableError(f"{where}: the parameter {shown_name(unused[0])} is not used in the table")
