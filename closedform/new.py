"""Writes the skeleton of a derivation from a table of joints.

The skeleton has pose, Jacobians and determinant, and is proved and printed as it stands.  Where the
structure of the arm is known, it holds the proposed inverse; else a place for it.

A Denavit-Hartenberg table is CSV with the columns ``a, alpha, d, theta`` and, if wanted,
``joint``, the name of the variable of a row: by default the symbol in ``theta``, or in ``d`` where
``theta`` is a number.  Screws are TOML with ``[[axes]]`` and ``[home]``.  Every other symbol is a
parameter; its value, unit and meaning come from comment lines ``# name = value unit: meaning`` or
from the table ``[parameters]``.
"""

from __future__ import annotations

import csv
import keyword
import re
import tomllib
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

import sympy as sp

from closedform.arm import Serial, from_dh, from_screws
from closedform.derivation import Derivation, Paper
from closedform.functions import real
from closedform.propose import NoChainError, propose, source

COLUMNS = ("a", "alpha", "d", "theta")
PARAMETER = re.compile(r"#\s*([A-Za-z_]\w*)\s*=\s*([-+\d./eE]+)\s*([^:]*?)\s*(?::\s*(.*))?$")
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


def new(name: str, kind: str, path: Path, *, modified: bool = False) -> str:
    """The source of a derivation called ``name``, from a table of the given kind."""
    if not name.isidentifier() or keyword.iskeyword(name):
        raise TableError(f"{name!r} is no name of a module: letters, digits and _ only")
    table = read_dh(path, modified=modified) if kind == "dh" else read_screws(path)
    for symbol in (*table.parameters, *table.joints):
        _check_name(symbol, path.name)
    for symbol, given in table.parameters.items():
        _check_value(symbol, given.get("value", "1"), path.name)
    return skeleton(name, table, path.name)


def _check_name(name: str, where: str) -> None:
    """A joint or a parameter becomes a variable of the script, which has some of its own."""
    taken = name in TAKEN or re.fullmatch(r"(alpha|link)\d+_?", name)
    if not name.isidentifier():
        raise TableError(f"{where}: {name!r} is no name: letters, digits and _ only")
    if taken or keyword.iskeyword(name):
        raise TableError(
            f"{where}: the name {name} has a meaning of its own in the script that is written; "
            f"choose another, such as {name}_0"
        )


def _check_value(name: str, value: str, where: str) -> None:
    try:
        Fraction(value)
    except (ValueError, ZeroDivisionError) as error:
        raise TableError(
            f"{where}: the value of {name} is {value!r}; it must be a number such as 0.45 or 9/20"
        ) from error


def _text(path: Path) -> str:
    try:
        return path.read_text("utf-8-sig")
    except UnicodeDecodeError as error:
        raise TableError(f"{path.name} is no text in UTF-8: save it as plain text") from error


def read_dh(path: Path, *, modified: bool = False) -> Table:
    """A Denavit-Hartenberg table from CSV."""
    table = Table(modified=modified)
    lines = _text(path).splitlines()
    numbered = []
    for number, line in enumerate(lines, 1):
        if found := PARAMETER.match(line.strip()):
            symbol, value, unit, meaning = found.groups()
            table.parameters[symbol] = {"value": value, "unit": unit, "meaning": meaning or ""}
        elif line.strip() and not line.lstrip().startswith("#"):
            numbered.append((number, next(csv.reader([line], skipinitialspace=True))))
    if not numbered:
        raise TableError(f"{path.name}: the table is empty")
    header = [h.strip() for h in numbered[0][1]]
    if missing := [c for c in COLUMNS if c not in header]:
        raise TableError(
            f"{path.name}, line {numbered[0][0]}: the column {missing[0]} is missing; the first "
            f"line must name the columns {', '.join(COLUMNS)}, with commas between them"
        )
    if unknown := [c for c in header if c not in (*COLUMNS, "joint")]:
        raise TableError(
            f"{path.name}, line {numbered[0][0]}: the column {unknown[0]} is unknown; there are "
            f"{', '.join(COLUMNS)} and, if wanted, joint"
        )
    if len(numbered) == 1:
        raise TableError(f"{path.name}: the table has no rows, only the names of its columns")
    for number, cells in numbered[1:]:
        where = f"{path.name}, line {number}"
        if len(cells) != len(header):
            raise TableError(f"{where}: {len(cells)} entries in {len(header)} columns")
        cell = dict(zip(header, (c.strip() for c in cells), strict=True))
        entries = {c: _expression(cell[c], f"{where}, column {c}") for c in COLUMNS}
        for column in ("alpha", "theta"):
            _check_angle(entries[column], cell[column], f"{where}, column {column}")
        joint, variable = _joint(cell.get("joint", ""), entries, where, table.parameters)
        if joint in table.joints:
            raise TableError(f"{where}: two joints have the name {joint}")
        table.joints[joint] = variable
        table.rows.append(tuple(entries[c] for c in COLUMNS))
    _other_symbols(table, [e for row in table.rows for e in row])
    return table


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
        raise TableError(f"{path.name}: {error}") from error
    table = Table()
    for name, entry in data.get("parameters", {}).items():
        entry = entry if isinstance(entry, dict) else {"value": entry}
        table.parameters[name] = {k: str(v) for k, v in entry.items()}
    if not data.get("axes"):
        raise TableError(f"{path.name}: there are no [[axes]]")
    for i, axis in enumerate(data["axes"], 1):
        where = f"{path.name}, axis {i}"
        for key in ("joint", "direction"):
            if key not in axis:
                raise TableError(f"{where}: {key} is missing")
        if axis["joint"] in table.joints:
            raise TableError(f"{where}: two joints have the name {axis['joint']}")
        table.joints[axis["joint"]] = axis.get("kind", "revolute")
        if axis.get("kind", "revolute") not in ("revolute", "prismatic"):
            raise TableError(f"{where}: the kind is revolute or prismatic, not {axis['kind']}")
        vectors = [
            [_expression(e, f"{where}, {key}") for e in axis.get(key, (0, 0, 0))]
            for key in ("direction", "point")
        ]
        table.axes.append((real(axis["joint"]), *vectors))
    home = data.get("home", {})
    R = sp.Matrix(
        [[_expression(e, "home") for e in row] for row in home.get("rotation", sp.eye(3).tolist())]
    )
    p = sp.Matrix([_expression(e, "home") for e in home.get("position", (0, 0, 0))])
    table.home = sp.Matrix.vstack(sp.Matrix.hstack(R, p), sp.Matrix([[0, 0, 0, 1]]))
    used = [e for _, *vectors in table.axes for v in vectors for e in v]
    _other_symbols(table, [*used, *table.home])
    return table


def _expression(text: Any, where: str) -> Any:
    """An exact expression; decimals are read as the fractions they are."""
    exact = re.sub(
        r"(?<![\w.])\d*\.\d+(?:[eE][-+]?\d+)?", lambda m: f"({Fraction(m[0])})", str(text)
    )
    names = {n: real(n) for n in re.findall(r"[A-Za-z_]\w*", exact) if n not in IMPORTED}
    for name in names:
        _check_name(name, where)
    called = [n for n in re.findall(r"([A-Za-z_]\w*)\s*\(", exact) if n not in IMPORTED]
    if called or not re.fullmatch(r"[\w\s.,+\-*/()]+", exact):
        raise TableError(
            f"{where}: cannot read {text!r}; a formula has symbols, numbers and + - * /"
        )
    try:
        value = sp.sympify(exact, names, rational=True)
    except (sp.SympifyError, SyntaxError, TypeError) as error:
        raise TableError(f"{where}: cannot read {text!r}") from error
    if not isinstance(value, sp.Expr) or value.has(sp.nan, sp.zoo, sp.oo):
        raise TableError(f"{where}: {text!r} is no number or formula")
    return value


def _other_symbols(table: Table, entries: Sequence[Any]) -> None:
    """Whatever is no joint is a parameter, in the order of its first use."""
    for entry in entries:
        for name in sorted(map(str, entry.free_symbols)):
            if name not in table.joints:
                table.parameters.setdefault(name, {})
    unused = [
        n for n in table.parameters if n not in {str(s) for e in entries for s in e.free_symbols}
    ]
    if unused:
        raise TableError(f"the parameter {unused[0]} stands nowhere in the table")


def skeleton(name: str, table: Table, origin: str) -> str:
    """The script, with the inverse that is proposed or a place for it."""
    d = Derivation(name, name, Paper("own", "own", ()), "")
    negative = [
        n for n, given in table.parameters.items() if given.get("value", "1").startswith("-")
    ]
    for symbol in table.parameters:
        d.parameter(symbol, value=1, unit="", meaning="", nonnegative=symbol not in negative)
    for joint, kind in table.joints.items():
        d.joint(joint, kind)  # type: ignore[arg-type]
    known = {s.name: s for s in (*(p.symbol for p in d.parameters), *d.actuated)}
    arm = _arm(d, table, known)
    title = name.replace("_", " ").capitalize()
    lines = [
        f'"""{title}: a derivation from {origin}."""',
        "",
        "IMPORTS",
        "",
        "d = Derivation(",
        f'    "{name}",',
        f'    "{title}",',
        f'    Paper("{name}", "{title}", ("the maker of the arm",)),',
        '    "Say here how the mechanism is built, where its zero is and which way it turns.",',
        ")",
    ]
    for symbol, given in table.parameters.items():
        value = Fraction(given.get("value") or "1")
        exact = f"{value.numerator}" if value.denominator == 1 else f'Rational("{value}")'
        sign = ", nonnegative=False" if symbol in negative else ""
        meaning = given.get("meaning") or "say what it measures"
        lines.append(
            f'{symbol} = d.parameter("{symbol}", value={exact}, unit="{given.get("unit") or "m"}", '
            f'meaning="{meaning}", source="{origin}"{sign})'
        )
    for joint, kind in table.joints.items():
        argument = ', "prismatic"' if kind == "prismatic" else ""
        lines.append(f'{joint} = d.joint("{joint}"{argument})')
    lines += ["", *_table_lines(table), "forward = arm.export(d)", ""]
    lines += _inverse_lines(arm)
    text = "\n".join(lines) + "\n"
    return text.replace("IMPORTS", _imports(text))


def _arm(d: Derivation, table: Table, known: Mapping[str, Any]) -> Serial:
    """The chain of the table, with the symbols of the derivation."""

    def own(e: Any) -> Any:
        e = sp.sympify(e)
        return e.xreplace({s: known[s.name] for s in e.free_symbols})

    if table.rows:
        return from_dh(d, [tuple(map(own, row)) for row in table.rows], modified=table.modified)
    axes = [(own(j), [own(e) for e in w], [own(e) for e in p]) for j, w, p in table.axes]
    return from_screws(d, axes, table.home.applyfunc(own))


def _table_lines(table: Table) -> list[str]:
    if table.rows:
        rows = [f"        ({', '.join(map(source, row))})," for row in table.rows]
        end = "    modified=True,\n)" if table.modified else ")"
        return ["arm = from_dh(", "    d,", "    [", *rows, "    ],", end]
    axes = [
        f"        ({joint}, ({', '.join(map(source, w))}), ({', '.join(map(source, p))})),"
        for joint, w, p in table.axes
    ]
    return [
        "arm = from_screws(",
        "    d,",
        "    [",
        *axes,
        "    ],",
        f"    {source(table.home)},",
        ")",
    ]


def _inverse_lines(arm: Serial) -> list[str]:
    task = arm.coordinates()
    angles = ', angles=["yaw"]' if task and "yaw" in task.names else ""
    chain = f"ik = Chain(d, forward{angles})"
    try:
        found = propose(arm)
    except NoChainError as error:
        reason = str(error).replace("\n", " ")
        return [
            f"# Inverse: {reason}.",
            "# Put it here, lemma by lemma; docs/adding-a-mechanism.md says how:",
            f"# {chain}",
            "# ik.solve(turn, theta1, a, b, c, {+1: 'left', -1: 'right'})",
            '# ik.finish("All solutions.")',
        ]
    return [
        f"# Inverse, as proposed for: {found.structure}.",
        "# Edit it as you like, and name the branches; the proof decides.",
        chain,
        *found.lines,
        'ik.finish("All solutions of the inverse kinematics.")',
    ]


def _imports(text: str) -> str:
    """What the script uses, in the order that linters want."""
    code = "\n".join(line for line in text.splitlines() if not line.startswith("#"))

    def used(names: Sequence[str]) -> list[str]:
        return [n for n in names if re.search(rf"(?<![\w.\"]){n}(?!\w)", code)]

    wanted = {
        "sympy": used(sorted(IMPORTED)),
        "closedform.arm": used(["from_dh", "from_screws"]),
        "closedform.chain": used(["Chain"]),
        "closedform.derivation": ["Derivation", "Paper"],
        "closedform.linklemmas": used(CHAIN),
        "closedform.pairs": used(["Pair"]),
    }
    lines = [
        f"from {module} import {', '.join(names)}" for module, names in wanted.items() if names
    ]
    return "\n".join(lines[:1] + ([""] if wanted["sympy"] else []) + lines[1:])
