"""Reads a table of joints: Denavit-Hartenberg rows from CSV, or axes at home from TOML.

Whatever cannot be read raises :class:`TableError`, which names the place and the remedy.

A Denavit-Hartenberg table is CSV with the columns ``a, alpha, d, theta`` and, if wanted,
``joint``, the name of the variable of a row: by default the symbol in ``theta``, or in ``d`` where
``theta`` is a number.  Screws are TOML with ``[[axes]]`` and ``[home]``.  Every other symbol is a
parameter; its value, unit and meaning come from comment lines ``# name = value unit: meaning`` or
from the table ``[parameters]``.
"""

from __future__ import annotations

import csv
import re
import tomllib
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

import sympy as sp

from closedform.functions import real
from closedform.names import NOT_FINITE, check_symbol
from closedform.propose import source

COLUMNS = ("a", "alpha", "d", "theta")
NAMED = re.compile(r"#\s*([A-Za-z_]\w*)\s*=\s*(\S+)")
PARAMETER = re.compile(r"#\s*([A-Za-z_]\w*)\s*=\s*([-+\d./eE]+)\s*([^:]*?)\s*(?::\s*(.*))?$")
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d{1,3})?(/\d+)?")
DECIMAL = re.compile(r"(?<![\w.])\d*\.\d+(?:[eE][-+]?\d{1,3}(?!\d))?")
UNBOUNDED = re.compile(r"\*\*(?!\s*[2-9](?!\s*\*\*|[\w.]))|(?<![A-Za-z_])\d[eE][-+]?\d{4}")
"""Powers and numbers that would take for ever to be written out."""
IMPORTED = ("Abs", "cos", "pi", "sin", "sqrt", "Matrix", "Rational", "atan", "atan2")
CHAIN = ("Reaching", "polar", "remainder", "slide", "turn", "turned", "two_links", "zyz")
SCRIPT = {"Chain", "Derivation", "Paper", "Pair", "arm", "d", "forward", "from_dh", "from_screws"}
LINES = {"M", "ahead", "ik", "p", "q", "reaching", "turn1", "wx", "wy", "x", "y", "yaw", "z", "rho"}
TAKEN = SCRIPT | LINES | {*IMPORTED, *CHAIN}
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
        exact = Fraction(value) if NUMBER.fullmatch(value) else None
        if exact is not None and (float(exact) != 0 or exact == 0):
            return
    except ArithmeticError:
        pass
    raise TableError(
        f"{where}: the value of {name} is {value!r}; it must be a number such as 0.45 or 9/20"
    )


def _text(path: Path) -> str:
    try:
        return path.read_text("utf-8-sig")
    except UnicodeDecodeError as error:
        raise TableError(f"{path.name} is no text in UTF-8: save it as plain text") from error
    except OSError as error:
        raise TableError(f"cannot read {path}: {error.strerror}") from error


def read_dh(path: Path, *, modified: bool = False) -> Table:
    """A Denavit-Hartenberg table from CSV."""
    table = Table(modified=modified)
    unread: dict[str, tuple[str, str]] = {}
    numbered = []
    for number, line in enumerate(_text(path).splitlines(), 1):
        where = f"{path.name}, line {number}"
        if found := PARAMETER.match(line.strip()):
            symbol, value, unit, meaning = found.groups()
            if symbol in table.parameters:
                raise TableError(f"{where}: the parameter {symbol} has a value already")
            _check_value(symbol, value, where)
            table.parameters[symbol] = {"value": value, "unit": unit, "meaning": meaning or ""}
        elif found := NAMED.match(line.strip()):
            unread[found[1]] = where, found[2]
        elif line.strip() and not line.lstrip().startswith("#"):
            numbered.append((number, next(csv.reader([line], skipinitialspace=True))))
    if not numbered:
        raise TableError(f"{path.name}: the table is empty")
    header = _header(numbered[0][1], f"{path.name}, line {numbered[0][0]}")
    if len(numbered) == 1:
        raise TableError(f"{path.name}: the table has no rows, only the names of its columns")
    for number, cells in numbered[1:]:
        where = f"{path.name}, line {number}"
        if len(cells) != len(header):
            raise TableError(
                f"{where}: {len(cells)} entries in {len(header)} columns; there must be one for "
                f"each of {', '.join(header)}"
            )
        cell = dict(zip(header, (c.strip() for c in cells), strict=True))
        entries = {c: _expression(cell[c], f"{where}, column {c}") for c in COLUMNS}
        for column in ("alpha", "theta"):
            _check_angle(entries[column], cell[column], f"{where}, column {column}")
        joint, variable = _joint(cell.get("joint", ""), entries, where, table.parameters)
        if joint in table.joints:
            raise TableError(f"{where}: two joints have the name {joint}")
        table.joints[joint] = variable
        table.rows.append(tuple(entries[c] for c in COLUMNS))
    _other_symbols(table, [e for row in table.rows for e in row], path.name)
    for name in table.parameters:
        if name in unread:
            where, value = unread[name]
            _check_value(name, value, where)
            raise TableError(f"{where}: write '# {name} = {value} unit: meaning'")
    return table


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
            f"{where}: the column {unknown[0]} is unknown; there are {names} and, if wanted, joint"
        )
    if twice := [c for i, c in enumerate(header) if c in header[:i]]:
        raise TableError(f"{where}: there are two columns {twice[0]}")
    return header


def _check_angle(angle: Any, text: str, where: str) -> None:
    """Angles are multiples of pi: a decimal is not exact, a whole number is in degrees."""
    number = angle.as_coeff_Add()[0]
    if not number.is_Rational or number == 0:
        return
    turns = {sp.Rational(k, 12) * sp.pi for k in range(-24, 25)}
    degrees = number * sp.pi / 180
    near = [t for t in turns if t == degrees or abs(t - number) < sp.Rational(1, 500)]
    hint = "a symbol, with its value in a line '# name = value rad: what it is'"
    if near:
        hint = source(angle - number + near[0])
    raise TableError(
        f"{where}: angles are in radians and exact, as multiples of pi: write {hint} instead of "
        f"{text}"
    )


def _joint(
    given: str, entries: Mapping[str, Any], where: str, parameters: Container[str]
) -> tuple[str, str]:
    """The joint of a row and its kind; a symbol that has a value is a parameter."""
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
    raise TableError(
        f"{where}: no joint: neither theta nor d holds {given or 'a symbol without a value'}; a "
        f"revolute joint is a symbol in theta, such as theta1, a slide one in d"
    )


def read_screws(path: Path) -> Table:
    """Axes and the pose at home from TOML."""
    try:
        data = tomllib.loads(_text(path), parse_float=str)
    except tomllib.TOMLDecodeError as error:
        raise TableError(f"{path.name} is no TOML: {error}") from error
    _check_keys(data, ("parameters", "axes", "home"), path.name)
    table = Table()
    where = f"{path.name}, [parameters]"
    parameters = data.get("parameters", {})
    _check_keys(parameters, tuple(parameters), where)
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
            raise TableError(f'{where}: a joint has a name, such as "theta{i}", not {joint!r}')
        if joint in table.joints:
            raise TableError(f"{where}: two joints have the name {joint}")
        if kind not in ("revolute", "prismatic"):
            raise TableError(f"{where}: the kind is revolute or prismatic, not {kind}")
        table.joints[joint] = kind
        direction, point = (
            _vector(axis.get(key, [0, 0, 0]), f"{where}, {key}") for key in ("direction", "point")
        )
        table.axes.append((real(joint), direction, point))
    table.home = _home(data.get("home", {}), f"{path.name}, [home]")
    used = [e for _, *vectors in table.axes for v in vectors for e in v]
    _other_symbols(table, [*used, *table.home], path.name)
    return table


def _check_keys(given: Any, known: Sequence[str], where: str) -> None:
    if not isinstance(given, dict):
        raise TableError(f"{where} must be a table of keys and values, not {given!r}")
    if unknown := [key for key in given if key not in known]:
        raise TableError(f"{where}: the key {unknown[0]} is unknown; there are {', '.join(known)}")


def _parameter(name: str, entry: Any, where: str) -> dict[str, str]:
    given = entry if isinstance(entry, dict) else {"value": entry}
    _check_keys(given, ("value", "unit", "meaning"), f"{where}, {name}")
    for key in ("unit", "meaning"):
        if not isinstance(given.get(key, ""), str):
            raise TableError(f"{where}: the {key} of {name} is a text, not {given[key]!r}")
    text = {key: str(value) for key, value in given.items()}
    _check_value(name, text.get("value", "1"), where)
    return text


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
        raise TableError(f"{where}: rotation has 3 rows of 3 entries, not {rows!r}")
    R = sp.Matrix([_vector(row, f"{where}, rotation, row {i}") for i, row in enumerate(rows, 1)])
    p = sp.Matrix(_vector(given["position"], f"{where}, position"))
    return sp.Matrix.vstack(sp.Matrix.hstack(R, p), sp.Matrix([[0, 0, 0, 1]]))


def _vector(given: Any, where: str) -> list[Any]:
    """Three expressions."""
    if not isinstance(given, list) or len(given) != 3:
        raise TableError(f"{where} needs 3 coordinates, such as [0, 0, 1], not {given!r}")
    return [_expression(entry, where) for entry in given]


def _expression(text: Any, where: str) -> Any:
    """An exact expression; decimals are read as the fractions they are."""
    if not isinstance(text, str | int) or isinstance(text, bool):
        raise TableError(f"{where}: {text!r} is no number or formula")
    exact = DECIMAL.sub(lambda m: f"({Fraction(m[0])})", str(text))
    names = {n: real(n) for n in re.findall(r"[A-Za-z_]\w*", exact) if n not in IMPORTED}
    if unbounded := [n for n in names if n.lower() in NOT_FINITE]:
        raise TableError(f"{where}: {unbounded[0]} is no finite number")
    if UNBOUNDED.search(exact):
        raise TableError(
            f"{where}: cannot read {text!r}; powers are from 2 to 9, a root is sqrt(...), and an "
            f"exponent of ten has at most three digits"
        )
    called = [n for n in re.findall(r"([A-Za-z_]\w*)\s*\(", exact) if n not in IMPORTED]
    if called or not re.fullmatch(r"[\w\s.,+\-*/()]+", exact):
        raise TableError(
            f"{where}: cannot read {text!r}; a formula has symbols, numbers and + - * /"
        )
    for name in names:
        _check_name(name, where)
    try:
        value = sp.sympify(exact, names, rational=True)
    except (sp.SympifyError, SyntaxError, TypeError, AttributeError) as error:
        raise TableError(
            f"{where}: cannot read {text!r}; a formula has symbols, numbers and + - * /"
        ) from error
    if not isinstance(value, sp.Expr) or value.has(sp.nan, sp.zoo, sp.oo, sp.I):
        raise TableError(f"{where}: {text!r} is no number or formula")
    return value


def _other_symbols(table: Table, entries: Sequence[Any], where: str) -> None:
    """Whatever is no joint is a parameter, in the order of its first use."""
    for entry in entries:
        for name in sorted(map(str, entry.free_symbols)):
            if name not in table.joints:
                table.parameters.setdefault(name, {})
    used = {str(s) for e in entries for s in e.free_symbols}
    if unused := [n for n in table.parameters if n not in used]:
        raise TableError(f"{where}: the parameter {unused[0]} stands nowhere in the table")
