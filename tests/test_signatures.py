"""Calls that can be read: few arguments by position, and where they are many, each is described."""

import ast
import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from places import ROOT

from closedform import Chain, law_of_cosines, turn
from closedform.robots import Robot

MOST = 5
PACKAGE = ("closedform", "derivations")
Function = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
DOCUMENTED = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
SECTION = re.compile(r"^Parameters\n-+\n(.*?)(?=^\w[^\n]*\n--|\Z)", re.M | re.S)


def functions(text: str) -> Iterator[tuple[str, Function, tuple[DOCUMENTED, ...]]]:
    """Every function of a module, with its name and the classes and functions around it."""

    def inside(node: ast.AST, around: tuple[DOCUMENTED, ...]) -> Iterator:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, Function):
                yield getattr(child, "name", "lambda"), child, around
            yield from inside(child, (*around, child) if isinstance(child, DOCUMENTED) else around)

    return inside(ast.parse(text), ())


def parameters(function: Function, around: tuple[DOCUMENTED, ...]) -> tuple[list[str], list[str]]:
    """The parameters that may be given by position, and the others, without that of the object."""
    given = function.args
    positional = [a.arg for a in (*given.posonlyargs, *given.args)]
    decorators = [] if isinstance(function, ast.Lambda) else function.decorator_list
    static = any(isinstance(d, ast.Name) and d.id == "staticmethod" for d in decorators)
    if around and isinstance(around[-1], ast.ClassDef) and not static:
        positional = positional[1:]
    return positional, [a.arg for a in given.kwonlyargs]


def too_many(text: str) -> list[str]:
    """The functions with more than five parameters that may be given by position."""
    counts = (
        (name, f.lineno, len(parameters(f, around)[0])) for name, f, around in functions(text)
    )
    return [f"line {line}: {name} takes {n}" for name, line, n in counts if n > MOST]


def described(documented: ast.AST) -> set[str]:
    """The names at the left margin of the section on parameters of a docstring."""
    section = SECTION.search(ast.get_docstring(documented) or "")
    rows = re.findall(r"^(\w[\w, ]*)(?: :.*)?$", section[1] if section else "", re.M)
    return {name for row in rows for name in row.split(", ")}


def undocumented(text: str) -> list[str]:
    """The parameters without a description, of public functions with more than five."""
    missing = []
    for name, function, around in functions(text):
        names = (*(getattr(a, "name", "") for a in around), name)
        hidden = any(n.startswith("_") and n != "__init__" for n in names)
        within = any(isinstance(a, ast.FunctionDef | ast.AsyncFunctionDef) for a in around)
        listed = [n for group in parameters(function, around) for n in group]
        if hidden or within or len(listed) <= MOST or isinstance(function, ast.Lambda):
            continue
        known = described(around[-1] if name == "__init__" else function)
        missing += [f"line {function.lineno}: {name}: {n}" for n in listed if n not in known]
    return missing


def sources(*folders: str) -> list[Path]:
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]


@pytest.mark.parametrize("folder", [*PACKAGE, "benchmarks", "tests", "setup.py"])
def test_at_most_five_arguments_are_given_by_position(folder: str) -> None:
    found = [ROOT / folder] if folder.endswith(".py") else sources(folder)
    assert found
    wrong = {str(p.relative_to(ROOT)): too_many(p.read_text("utf-8")) for p in found}
    assert {path: lines for path, lines in wrong.items() if lines} == {}


@pytest.mark.parametrize("folder", [*PACKAGE, "benchmarks"])
def test_where_parameters_are_many_each_is_described(folder: str) -> None:
    wrong = {str(p.relative_to(ROOT)): undocumented(p.read_text("utf-8")) for p in sources(folder)}
    assert {path: lines for path, lines in wrong.items() if lines} == {}


def records(text: str) -> dict[str, list[str]]:
    """The dataclasses and named tuples of a module, and the fields of each."""
    return {
        node.name: [
            s.target.id
            for s in node.body
            if isinstance(s, ast.AnnAssign)
            and isinstance(s.target, ast.Name)
            and "ClassVar" not in ast.unparse(s.annotation)
        ]
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.ClassDef)
        and re.search(
            "dataclass|NamedTuple", " ".join(map(ast.unparse, node.decorator_list + node.bases))
        )
    }


def unnamed(text: str, known: dict[str, list[list[str]]]) -> list[str]:
    """Records made of more than five values by position, two of which do not say what they are.

    A variable with the name of its field says it.  Of a name with several meanings, the one is
    taken that fits best.
    """
    own = {name: [fields] for name, fields in records(text).items()}
    found = []
    for node in ast.walk(ast.parse(text)):
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Name)):
            continue
        given = [a.id if isinstance(a, ast.Name) else "" for a in node.args]
        several = {**known, **own}.get(node.func.id, [])
        silent = [sum(map(str.__ne__, given, f)) for f in several if len(f) >= len(given)]
        if len(given) > MOST and min(silent, default=0) > 1:
            found.append(f"line {node.lineno}: {node.func.id} takes {len(given)}")
    return found


@pytest.mark.parametrize("folder", [*PACKAGE, "benchmarks", "tests"])
def test_values_of_a_record_have_names(folder: str) -> None:
    texts = {p: p.read_text("utf-8") for p in sources(*PACKAGE, "benchmarks", "tests")}
    known: dict[str, list[list[str]]] = {}
    for text in texts.values():
        for name, fields in records(text).items():
            known.setdefault(name, []).append(fields)
    assert {"Crank", "Derivation", "Inverse"} <= set(known)
    wrong = {
        str(p.relative_to(ROOT)): unnamed(text, known)
        for p, text in texts.items()
        if p.is_relative_to(ROOT / folder)
    }
    assert {path: lines for path, lines in wrong.items() if lines} == {}


RECORD = (
    "@dataclass\nclass R:\n    a: int\n    b: int\n    c: int\n    d: int\n    e: int\n    f: int\n"
)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (f"{RECORD}R(1, 2, 3, 4, 5, 6)", ["line 9: R takes 6"]),
        (f"{RECORD}R(a, b, c, d, f, e)", ["line 9: R takes 6"]),
        (f"{RECORD.replace('@dataclass', '').replace('R:', 'R(NamedTuple):')}R(a, b, c, d, 5, 6)",
         ["line 9: R takes 6"]),
        (f"{RECORD}R(a, b, c, d, e, 6)", []),
        (f"{RECORD}R(1, 2, 3, 4, 5, f=6)", []),
        ("S(1, 2, 3, 4, 5, 6)", []),
    ],
)  # fmt: skip
def test_values_without_names_are_found(text: str, found: list[str]) -> None:
    assert unnamed(text, {}) == found


SIX = "a, b, c, d, e, f"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (f"def g({SIX}): ...", ["line 1: g takes 6"]),
        (f"def g(a, /, {SIX[3:]}): ...", ["line 1: g takes 6"]),
        (f"h = [lambda {SIX}: 0]", ["line 1: lambda takes 6"]),
        (f"def h():\n    async def g({SIX}): ...", ["line 2: g takes 6"]),
        (f"class C:\n    @staticmethod\n    def g({SIX}): ...", ["line 3: g takes 6"]),
        ("class C:\n    def g(self, a, b, c, d, e): ...", []),
        ("def g(a, b, c, d, e, *, f, g): ...", []),
        ("def g(*a, **b): ...", []),
    ],
)
def test_positions_are_counted(text: str, found: list[str]) -> None:
    assert too_many(text) == found


def documented(rows: str, names: str = "a, b, c, d, *, e, f") -> str:
    text = f"What.\n\n    Parameters\n    ----------\n{rows}\n\n    Returns\n    -------\n    f\n"
    return f'def g({names}):\n    """{text}    """'


@pytest.mark.parametrize(
    ("text", "missing"),
    [
        (documented("    a, b\n        f\n    c : int\n        c\n    d\n    e"), ["f"]),
        (documented("    a, b, c\n        x\n    d, e, f\n        y"), []),
        (documented("    a", "a, b, c, *, d, e"), []),
        ("def _g(a, b, c, *, d, e, f): ...", []),
        ('class C:\n    """Parameters\n    ----------\n    a, b, c, d, e\n    """\n\n'
         "    def __init__(self, a, b, c, *, d, e, f): ...", ["f"]),
        ("def g(a, b, c, d, e, *, f): ...", list("abcdef")),
    ],
)  # fmt: skip
def test_descriptions_are_found(text: str, missing: list[str]) -> None:
    assert [line.rpartition(" ")[2] for line in undocumented(text)] == missing


@pytest.mark.parametrize("call", [Robot, Robot.nearest, turn, law_of_cosines])
def test_help_shows_defaults_by_name(call) -> None:
    assert " object at " not in str(inspect.signature(call))


def test_help_on_a_chain_shows_only_what_an_author_gives() -> None:
    assert list(inspect.signature(Chain).parameters) == ["d", "forward", "angles", "name"]
