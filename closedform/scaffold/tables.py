"""Reads a table of joints: Denavit-Hartenberg rows from CSV, or axes at home from TOML.

A table is data: nothing in it is run, and :mod:`closedform.algebra.formulas` says what a cell may
hold.  Whatever cannot be read raises :class:`TableError`, which names the place and the remedy.

A Denavit-Hartenberg table is CSV with the columns ``a, alpha, d, theta`` and, if wanted,
``joint``, the name of the variable of a row: by default the symbol in ``theta``, or in ``d`` where
``theta`` is a number.  A row without a variable is a fixed transform.  Screws are TOML with
``[[axes]]`` and ``[home]``.  Every other symbol is a parameter; its value, unit and meaning come
from comment lines ``# name = value unit: meaning`` or from the table ``[parameters]``.
"""

from __future__ import annotations

import csv
import re
import tomllib
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import sympy as sp

from closedform.algebra.formulas import BITS, FormulaError, formula, number, shown
from closedform.model.functions import real
from closedform.model.names import check_symbol
from closedform.scaffold import exact
from closedform.scaffold.source import source

COLUMNS = ("a", "alpha", "d", "theta")
LARGEST = 64_000
"""Characters in a table, far more than any arm needs."""
LONGEST = 2000
"""Characters in a line: the time to read one can grow with the square of its length."""
JOINTS = 16
ROWS = 32
DIGITS = re.compile(r"[-+0-9./eE]+")
IMPORTED = ("Abs", "cos", "pi", "sin", "sqrt", "Matrix", "Rational", "atan", "atan2")
CHAIN = ("Reaching", "polar", "remainder", "slide", "turn", "turned", "two_links", "zyz")
AUTHOR = (
    "Chain", "Derivation", "Links", "LinksAndWrist", "LinksAtHeight", "Pair", "Paper", "from_dh",
    "from_screws",
)  # fmt: skip
SCRIPT = {"arm", "d", "forward", "links"}
LINES = {
    "M",
    "ahead",
    "ik",
    "p",
    "q",
    "reaching",
    "turn1",
    "turn2",
    "wx",
    "wy",
    "x",
    "y",
    "yaw",
    "z",
    "rho",
}
TAKEN = SCRIPT | LINES | {*IMPORTED, *AUTHOR, *CHAIN}
"""What the written script calls its own."""


class TableError(ValueError):
    """A table of joints that cannot be read, and where."""


@dataclass
class Table:
    """What was read: joints in order with their kinds, parameters, and the rows or axes."""

    joints: dict[str, str] = field(default_factory=dict)
    parameters: dict[str, dict[str, str]] = field(default_factory=dict)
    rows: list[tuple[Any, ...]] = field(default_factory=list)
    axes: list[tuple[Any, Any, Any]] = field(default_factory=list)
    home: Any = None
    modified: bool = False
    notes: list[str] = field(default_factory=list)
    """What was read otherwise than it is written, to be told to whoever wrote the table."""


def check_names(table: Table, where: str) -> None:
    """Each joint and each parameter becomes a variable of the script, which has some of its own."""
    for name in (*table.parameters, *table.joints):
        _check_name(name, where)
    if both := [name for name in table.joints if name in table.parameters]:
        raise TableError(f"{where}: {both[0]} is a joint and a parameter; name one of them anew")


def _check_name(name: str, where: str) -> None:
    if name in TAKEN or re.fullmatch(r"(alpha|link)\d+_?", name):
        raise TableError(
            f"{where}: the name {name} has a meaning of its own in the script that is written; "
            f"choose another, such as {name}_0"
        )
    try:
        check_symbol(name, where)
    except ValueError as error:
        raise TableError(str(error)) from error


def _check_value(name: str, value: str, where: str) -> None:
    """A value is printed as a floating-point number, so it must have one."""
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
    """A name in a message: quoted only where it is not one."""
    return name if name.isascii() and name.isidentifier() and len(name) < 60 else shown(name)


def _text(path: Path) -> str:
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST + 1)
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        if len(content) > LARGEST:
            raise _too_large(path) from error
        raise TableError(f"{path.name} is no text in UTF-8: save it as plain text") from error
    except OSError as error:
        raise TableError(f"cannot read {path}: {error.strerror}") from error
    if len(content) > LARGEST:
        raise _too_large(path)
    for i, line in enumerate(text.splitlines(), 1):
        if len(line) > LONGEST:
            raise TableError(
                f"{path.name}, line {i}: a line has at most {LONGEST} characters, not {len(line)}"
            )
    return text


def _too_large(path: Path) -> TableError:
    return TableError(f"{path.name} is too large: a table of joints has at most {LARGEST} bytes")


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
    unread: dict[str, tuple[str, str]] = {}
    numbered, places = [], []
    for i, line in enumerate(_text(path).splitlines(), 1):
        where = f"{path.name}, line {i}"
        if remark := _remark(line.strip()):
            symbol, value, unit, meaning = remark
            if not any(c.isdecimal() for c in value):  # not a value, perhaps a sentence
                unread[symbol] = where, value
                continue
            if symbol in table.parameters:
                raise TableError(f"{where}: the parameter {symbol} has a value already")
            _check_value(symbol, value, where)
            table.parameters[symbol] = {"value": value, "unit": unit, "meaning": meaning}
        elif line.strip() and not line.lstrip().startswith("#"):
            numbered.append((i, _cells(line, where)))
    if not numbered:
        raise TableError(f"{path.name}: the table is empty")
    header = _header(numbered[0][1], f"{path.name}, line {numbered[0][0]}")
    if len(numbered) == 1:
        raise TableError(f"{path.name}: the table has no rows, only the names of its columns")
    if len(numbered) > ROWS + 1:
        raise TableError(f"{path.name}: the table has more than {ROWS} rows")
    for i, cells in numbered[1:]:
        where = f"{path.name}, line {i}"
        if len(cells) != len(header):
            raise TableError(
                f"{where}: {len(cells)} entries in {len(header)} columns; there must be one for "
                f"each of {', '.join(header)}"
            )
        cell = dict(zip(header, (c.strip() for c in cells), strict=True))
        entries = {c: _expression(cell[c], f"{where}, column {c}") for c in COLUMNS}
        for column in ("alpha", "theta"):
            _check_angle(entries[column], cell[column], f"{where}, column {column}")
        if found := _joint(cell.get("joint", ""), entries, where, table.parameters):
            _add_joint(table, *found, where)
        else:
            table.notes.append(f"{where}: the row has no joint, so it is a fixed transform")
        table.rows.append(tuple(entries[c] for c in COLUMNS))
        places.append(where)
    if not table.joints:
        raise TableError(
            f"{places[0]}: no joint: neither theta nor d holds a symbol without a value; a "
            f"revolute joint is a symbol in theta, such as theta1, a slide one in d"
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


def _angles(table: Table) -> exact.Angles:
    names = {*table.joints, *table.parameters}
    return exact.Angles(lambda name: name in names)


def _declare(table: Table, angles: exact.Angles) -> None:
    """Each angle that got a name becomes a parameter."""
    for angle, symbol in angles.named.items():
        where, value = angles.places[angle], exact.decimal(angle)
        table.parameters[symbol.name] = {
            "value": value,
            "unit": "rad",
            "meaning": f"the angle {angle} of the table",
        }
        table.notes.append(
            f"{where}: the cosine of {angle} has no form in square roots, so this angle is the "
            f"parameter {symbol.name} = {value} rad"
        )


def _add_joint(table: Table, joint: str, kind: str, where: str) -> None:
    if joint in table.joints:
        raise TableError(f"{where}: two joints have the name {shown_name(joint)}")
    if len(table.joints) == JOINTS:
        raise TableError(f"{where}: there are more than {JOINTS} joints")
    table.joints[joint] = kind


def _header(cells: Sequence[str], where: str) -> list[str]:
    header = [h.strip() for h in cells]
    names = ", ".join(COLUMNS)
    if missing := [c for c in COLUMNS if c not in header]:
        raise TableError(
            f"{where}: the column {missing[0]} is missing; the first line must name the columns "
            f"{names}, with commas between them"
        )
    if unknown := [c for c in header if c not in (*COLUMNS, "joint")]:
        raise TableError(
            f"{where}: the column {shown_name(unknown[0])} is unknown; there are {names} "
            f"and, if wanted, joint"
        )
    if twice := [c for i, c in enumerate(header) if c in header[:i]]:
        raise TableError(f"{where}: there are two columns {shown_name(twice[0])}")
    return header


def _check_angle(angle: Any, text: str, where: str) -> None:
    """Angles are in radians: a whole number is in degrees, 1.5708 stands for pi/2."""
    value = angle.as_coeff_Add()[0]
    if not value.is_Rational or value == 0:
        return
    turns = {sp.Rational(k, 12) * sp.pi for k in range(-24, 25)}
    near = [t for t in turns if abs(t - value) < sp.Rational(1, 500)]
    if value.is_Integer or abs(value) > 2 * sp.pi:
        near = [value * sp.pi / 180]
    if near:
        raise TableError(
            f"{where}: angles are in radians and exact, as multiples of pi: write "
            f"{source(angle - value + near[0])} instead of {text}"
        )


def _joint(
    given: str, entries: Mapping[str, Any], where: str, parameters: Container[str]
) -> tuple[str, str] | None:
    """The joint of a row and its kind; a symbol that has a value is a parameter.

    None where the row holds no joint.
    """
    for column, kind in (("theta", "revolute"), ("d", "prismatic")):
        held = sorted(map(str, entries[column].free_symbols))
        names = [n for n in held if n not in parameters]
        if given in held or (not given and len(names) == 1):
            return given or names[0], kind
        if names and not given:
            raise TableError(
                f"{where}: {', '.join(names)} stand in {column}, and only one can be the joint: "
                f"give the others their values in lines '# {names[-1]} = 0.1 m: what it is', or "
                f"add a column joint with the name of the joint"
            )
    if given:
        raise TableError(
            f"{where}: no joint: neither theta nor d holds {shown_name(given)}; a revolute joint "
            f"is a symbol in theta, such as theta1, a slide one in d"
        )
    return None


def read_screws(path: Path) -> Table:
    """Axes and the pose at home from TOML."""
    try:
        data = tomllib.loads(_text(path), parse_float=str)
    except TableError:
        raise
    except (ValueError, RecursionError) as error:
        why = "it is nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise TableError(f"{path.name} is no TOML: {why}") from error
    _check_keys(data, ("parameters", "axes", "home"), path.name)
    table = Table()
    where = f"{path.name}, [parameters]"
    parameters = data.get("parameters", {})
    _check_keys(parameters, None, where)
    for name, entry in parameters.items():
        table.parameters[name] = _parameter(name, entry, where)
    axes = data.get("axes")
    if not isinstance(axes, list) or not axes:
        raise TableError(f"{path.name}: there are no [[axes]]; each joint needs one")
    for i, axis in enumerate(axes, 1):
        where = f"{path.name}, axis {i}"
        _check_keys(axis, ("joint", "kind", "direction", "point"), where)
        for key in ("joint", "direction"):
            if key not in axis:
                raise TableError(f"{where}: {key} is missing")
        joint, kind = axis["joint"], axis.get("kind", "revolute")
        if not isinstance(joint, str):
            raise TableError(f'{where}: a joint has a name, such as "theta{i}", not {shown(joint)}')
        if kind not in ("revolute", "prismatic"):
            raise TableError(f"{where}: the kind is revolute or prismatic, not {_plain(kind)}")
        _add_joint(table, joint, kind, where)
        direction, point = (
            _vector(axis.get(key, [0, 0, 0]), f"{where}, {key}") for key in ("direction", "point")
        )
        table.axes.append((real(joint), direction, point))
    table.home = _home(data.get("home", {}), f"{path.name}, [home]")
    used = [e for _, *vectors in table.axes for v in vectors for e in v]
    _other_symbols(table, [*used, *table.home], path.name)
    _use_exact(table, path.name)
    return table


def _use_exact(table: Table, file: str) -> None:
    """Directions and rotations in decimals are made exact, and angles without roots get names."""
    axes: list[tuple[Any, Any, Any]] = []
    directions: list[sp.Matrix] = []
    for i, (joint, direction, point) in enumerate(table.axes, 1):
        given = sp.Matrix(direction)
        if not given.free_symbols and given.dot(given) != 1:
            unit = exact.unit_vector(given, directions)
            if unit is not None and unit != given:
                table.notes.append(
                    f"{file}, axis {i}: the direction {_decimals(given)} is rounded; the unit "
                    f"vector {_listed(unit)} is taken for it"
                )
                given = unit
        directions.append(given)
        axes.append((joint, list(given), point))
    R = table.home[:3, :3]
    if not R.free_symbols and (R.T * R).applyfunc(sp.expand) != sp.eye(3):
        turned = exact.rotation(R, directions)
        if turned is not None and turned != R:
            table.home[:3, :3] = turned
            rows = ", ".join(_listed(turned.row(i)) for i in range(3))
            table.notes.append(
                f"{file}, [home]: the rotation is rounded; the rows {rows} are taken for it"
            )
    angles = _angles(table)
    table.axes = [
        (joint, *([angles.read(e, f"{file}, axis {i}") for e in v] for v in vectors))
        for i, (joint, *vectors) in enumerate(axes, 1)
    ]
    table.home = table.home.applyfunc(lambda e: angles.read(e, f"{file}, [home]"))
    _declare(table, angles)


def _listed(vector: Any) -> str:
    return f"({', '.join(map(str, vector))})"


def _decimals(vector: Any) -> str:
    return f"({', '.join(f'{float(e):.12g}' for e in vector)})"


def _check_keys(given: Any, known: Sequence[str] | None, where: str) -> None:
    if not isinstance(given, dict):
        raise TableError(f"{where} must be a table of keys and values, not {_plain(given)}")
    if known is not None and (unknown := [key for key in given if key not in known]):
        raise TableError(
            f"{where}: the key {shown_name(unknown[0])} is unknown; there are {', '.join(known)}"
        )


def _parameter(name: str, entry: Any, where: str) -> dict[str, str]:
    given = entry if isinstance(entry, dict) else {"value": entry}
    _check_keys(given, ("value", "unit", "meaning"), f"{where}, {shown_name(name)}")
    for key in ("unit", "meaning"):
        if not isinstance(given.get(key, ""), str):
            raise TableError(
                f"{where}: the {key} of {shown_name(name)} is a text, not {_plain(given[key])}"
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
    """A value of TOML as text: a text or a number as it is, anything else by its kind."""
    if isinstance(value, str):
        return value
    if isinstance(value, int) and value.bit_length() <= BITS:
        return str(value)
    return shown(value)


def _home(given: Any, where: str) -> sp.Matrix:
    """The pose of the tool, 4x4, where all joints are zero."""
    _check_keys(given, ("position", "rotation"), where)
    if "position" not in given:
        raise TableError(
            f"{where}: position is missing; it is where the tool is while all joints are zero, "
            f"such as [1, 0, 0]"
        )
    rows = given.get("rotation", [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    if not isinstance(rows, list) or len(rows) != 3:
        raise TableError(f"{where}: rotation has 3 rows of 3 entries, not {_plain(rows)}")
    R = sp.Matrix([_vector(row, f"{where}, rotation, row {i}") for i, row in enumerate(rows, 1)])
    p = sp.Matrix(_vector(given["position"], f"{where}, position"))
    return sp.Matrix.vstack(sp.Matrix.hstack(R, p), sp.Matrix([[0, 0, 0, 1]]))


def _vector(given: Any, where: str) -> list[Any]:
    """Three expressions."""
    if not isinstance(given, list) or len(given) != 3:
        raise TableError(f"{where} needs 3 coordinates, such as [0, 0, 1], not {shown(given)}")
    return [_expression(entry, where) for entry in given]


def _expression(text: Any, where: str) -> Any:
    """An exact expression; decimals are read as the fractions they are."""
    if not isinstance(text, str | int) or isinstance(text, bool):
        raise TableError(f"{where}: {shown(text)} is not a number or formula")
    try:
        return formula(_plain(text), lambda name: _symbol(name, where))
    except FormulaError as error:
        raise TableError(f"{where}: {error}") from error


def _symbol(name: str, where: str) -> Any:
    _check_name(name, where)
    return real(name)


def _other_symbols(table: Table, entries: Sequence[Any], where: str) -> None:
    """Whatever is no joint is a parameter, in the order of its first use."""
    for entry in entries:
        for name in sorted(map(str, entry.free_symbols)):
            if name not in table.joints:
                table.parameters.setdefault(name, {})
    used = {str(s) for e in entries for s in e.free_symbols}
    if unused := [n for n in table.parameters if n not in used]:
        raise TableError(
            f"{where}: the parameter {shown_name(unused[0])} stands nowhere in the table"
        )
