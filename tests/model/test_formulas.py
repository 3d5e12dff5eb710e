"""Untrusted text: a formula is parsed, and anything else in a cell is refused."""

import ast
import json
import warnings
from dataclasses import replace
from pathlib import Path

import pytest
import sympy as sp

from closedform.algebra.formulas import FormulaError, formula, number
from closedform.cli.commands import main
from closedform.emit.backends.latex.article import Page
from closedform.emit.backends.latex.inverse import Told
from closedform.lemmas.chain import Chain
from closedform.mechanics.arm import from_dh, from_screws
from closedform.model.derivation import Derivation, Paper
from closedform.model.functions import Program, real
from closedform.pipeline.scripts import find, load
from closedform.proof.prove import InverseResult, Proof
from closedform.scaffold.source import source

HEADER = "a, alpha, d, theta\n"
MADE = "made"
"""The file that the texts below would write if anything ran them."""
OPEN = f"open('{MADE}','w')"
HEX = "ff" + OPEN.replace("(", "\x0c(").encode().hex()
BYTES = "((x1.name.encode)().fromhex)"
TEXT, MARK = (f"({BYTES}({digits}.name).decode)(latin1.name)" for digits in (HEX, "ff"))
BUILT = f"sin(({TEXT}.strip)({MARK}))"
"""The same call, from letters and digits alone."""
HOSTILE = [
    OPEN,
    f"__import__('os').system('touch {MADE}')",
    f'sin("{OPEN}")',
    f"sqrt({OPEN!r})",
    f"Abs({OPEN})",
    BUILT,
    "(x1.__class__)()",
    "(x1.func)(x1)",
    "x1.name",
    "x1.name.format",
    "x1 .name",
    "(lambda: 0)()",
    "(lambda x1: x1)(2)",
    "[].__class__",
    "().__class__.__bases__[0]",
    "{}.__class__",
    "x1[0]",
    f"f'{{{OPEN}}}'",
    "'x1'",
    '"x1" * 3',
    "b'x1'",
    "chr(120) + chr(49)",
    "eval(x1)",
    "exec(x1)",
    "type(x1)",
    "sin",
    "sin(x1)(x1)",
    "sin(x1, x1)",
    "sin()",
    "atan2(x1)",
    "sin(*x1)",
    "sin(x1 for x1 in x1)",
    "(x1 for x1 in x1)",
    "(x1 := 2)",
    "x1 if x1 else x1",
    "x1 and x1",
    "not x1",
    "x1 < 2",
    "x1 == 2",
    "x1 is x1",
    "x1 in x1",
    "await x1",
    "yield x1",
    "x1, x1",
    "x1; x1",
    "x1 = 2",
    "x1 // 2",
    "x1 % 2",
    "x1 @ x1",
    "x1 ^ 2",
    "~x1",
    "x1!",
    "2 x1",
    "2(x1)",
    "True",
    "None",
    "...",
    "1j",
    "1_000",
    "0x10",
    "0b1",
    "1if x1 else 2",
    "s\u0456n(x1)",
    "\u0445 + 1",
    "x1\u2028+ 1",
    "\uff11",
    "\u0663",
    "\u00b2",
    "x1\x00",
    "x1\x1b[31m",
    "x1 # + 1",
    "x1 \\",
    "x1\n+ 1",
    "nan",
    "inf",
    "oo",
    "1e999",
    "1e-999",
    "1e999999",
    "9**9**9",
    "x1**x1",
    "x1**99",
    "(((9**9)**9)**9)**9",
    "((((x1 + 1)**9)**9)**9)**9",
    "1/0",
    "1/(x1 - x1)",
    "0**-1",
    "tan(pi/2)",
    "sqrt(-1)",
    "sqrt(2) + sqrt(3) - sqrt(5 + 2*sqrt(6))",
    "",
    "(",
    ")",
    "9" * 400,
    "-" * 199 + "1",
    "sqrt(" * 32 + "x1" + ")" * 32,
    "(" * 10**6 + ")" * 10**6,
    "-" * 10**6,
    "1+" * 10**6 + "1",
    "9" * 10**6,
    "x" * 10**6,
]


def refused(folder: Path, kind: str, text: str, capsys: pytest.CaptureFixture[str]) -> str:
    """The command's complaint about a table: one printable line; no script, nothing was run."""
    table = folder / "table"
    table.write_text(text, "utf-8")
    assert main(["new", "arm", "--from", kind, str(table), "-o", str(folder)]) == 1
    said = capsys.readouterr().err
    assert said.startswith("closedform: ") and said.endswith("\n") and said[:-1].isprintable()
    assert len(said) < 500
    assert sorted(path.name for path in folder.iterdir()) == ["table"]
    return said


@pytest.mark.parametrize("text", HOSTILE, ids=lambda text: ascii(text)[:30])
def test_hostile_cells(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    text: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    warnings.simplefilter("error")
    with pytest.raises(FormulaError):
        formula(text, known)
    cell = '"' + text.replace('"', '""') + '"'
    for place in range(3):
        cells = ["0", "0", "0", "t"]
        cells[place] = cell
        refused(tmp_path, "dh", HEADER + ", ".join(cells), capsys)
    entry = json.dumps(text)
    axis = '[[axes]]\njoint = "t"\n'
    for body in (
        f"{axis}direction = [0, 0, 1]\npoint = [{entry}, 0, 0]\n[home]\nposition = [0, 0, 0]",
        f"{axis}direction = [0, {entry}, 1]\n[home]\nposition = [0, 0, 0]",
        f"{axis}direction = [0, 0, 1]\n[home]\nposition = [0, 0, {entry}]",
        f"[parameters]\nL = {entry}\n{axis}direction = [0, 0, 1]\n[home]\nposition = ['L', 0, 0]",
        f"[[axes]]\njoint = {entry}\ndirection = [0, 0, 1]\n[home]\nposition = [0, 0, 0]",
    ):
        refused(tmp_path, "screws", body, capsys)


def known(name: str) -> sp.Symbol:
    if name != "x1":
        raise FormulaError(name)
    return real(name)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.1", sp.Rational(1, 10)),
        (" -1.25e-3\t", sp.Rational(-1, 800)),
        (".5 + 5.", sp.Rational(11, 2)),
        ("2*sqrt(2)/4", sp.sqrt(2) / 2),
        ("-pi/2 + x1", real("x1") - sp.pi / 2),
        ("(x1 + 1)**2", (real("x1") + 1) ** 2),
        ("x1**-1", 1 / real("x1")),
        ("+x1**(1/2)", sp.sqrt(real("x1"))),
        ("atan2(3, 4) + atan(1)", sp.atan2(3, 4) + sp.pi / 4),
        ("tan(x1)", sp.sin(real("x1")) / sp.cos(real("x1"))),
        ("Abs(-2/3)", sp.Rational(2, 3)),
    ],
)
def test_a_formula_is_exact(text: str, value: sp.Expr) -> None:
    assert formula(text, known) == value


@pytest.mark.parametrize(
    "text", ["--1", "1/-2", "1.5/3", "1/0", "1/2/3", "\u0663", "1/\u0663", "1 2"]
)
def test_what_is_not_a_number(text: str) -> None:
    assert number("-9/20") == -number("0.45")
    with pytest.raises(FormulaError):
        number(text)


@pytest.mark.parametrize(
    ("kind", "text", "message"),
    [
        ("dh", HEADER + "0, 0, 0, t\n" * 10**6, "is too large"),
        ("dh", HEADER + "0, 0, 0, 0\n" * 1000 + "0, 0, 0, t\n", "more than 32 rows"),
        ("dh", HEADER + "".join(f"0, 0, 0, t{i}\n" for i in range(20)), "more than 16 joints"),
        ("dh", "#" + " " * 10**4 + "\n", "characters, more than 2000"),
        ("dh", "# L = 1" + " " * 1900 + ":" * 20 + "\n", "is empty"),
        ("dh", "# L = " + "9" * 1900 + "\n", "the value of L is"),
        ("dh", HEADER + '"0, 0, 0, t\n', "is not a line of CSV"),
        ("dh", "a\x1b[2J, alpha, d, theta\n0, 0, 0, t\n", "the column a is missing"),
        ("dh", "a, alpha, d, theta, \x1b[2J\n0, 0, 0, t, 0\n", r"column '\x1b[2J' is unknown"),
        ("screws", "a = 1\n" * 10**6, "is too large"),
        ("screws", "a = " + "[\n" * 20_000, "is nested too deeply"),
        ("screws", "a = " + "[\n" * 20_000 + "]\n" * 10_000, "is no"),
        ("screws", ".".join("a" * 900) + " = 1\n", "the key a is unknown"),
        ("screws", f"a = {'9' * 1900}\n", "the key a is unknown"),
        ("screws", f"axes = {'9' * 1900}\n", "there are no [[axes]]"),
        ("screws", f"[parameters]\nL = 0x{'f' * 1900}\n", "the value of L is"),
        ("screws", "[parameters]\nL = 2020-01-01\n", "the value of L is a date"),
        ("screws", '[parameters]\n"\\u001b[2J" = 1\n', "there are no [[axes]]"),
        ("screws", '"\\u001b[2J" = 1\n', r"the key '\x1b[2J' is unknown"),
        ("screws", "axes = [" + "[" * 90 + "]" * 90 + "]\n", "axis 1 must be a table"),
    ],
    ids=range(20),
)
def test_files_that_are_too_much(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], kind: str, text: str, message: str
) -> None:
    assert message in refused(tmp_path, kind, text, capsys)


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("0, 90°, 0, t\n", "cannot read '90°'; angles are in radians"),
        ("0, 0, 0, θ1\n", "cannot read 'θ1'; names have Latin letters"),
        ("0, 0, \u202e1, t\n", r"cannot read '\u202e1'"),
    ],
)
def test_a_cell_is_shown_as_it_was_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], row: str, message: str
) -> None:
    assert message in refused(tmp_path, "dh", HEADER + row, capsys)


TEXTS = [
    f'"); {OPEN}; ("',
    f"'); {OPEN}; ('",
    f"{{{OPEN}}}",
    "quotes \"'\"'",
    "# not a comment",
    "%s {} {0} $x",
]


@pytest.mark.parametrize("text", TEXTS)
def test_text_of_a_table_stays_text(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str
) -> None:
    """The script has the same statements, whatever the text about a parameter says."""
    monkeypatch.chdir(tmp_path)
    body = '[[axes]]\njoint = "t"\ndirection = [0, 0, 1]\n[home]\nposition = ["L", 0, 0]\n'
    trees = []
    for name, given in (("plain", "plain"), ("other", text)):
        table = tmp_path / f'table {len(trees)} \'; """ .toml'
        entry = f"{{ unit = {json.dumps(given)}, meaning = {json.dumps(given)} }}"
        table.write_text(f"[parameters]\nL = {entry}\n{body}", "utf-8")
        assert main(["new", name, "--from", "screws", str(table)]) == 0
        trees.append(ast.parse((tmp_path / f"{name}.py").read_text("utf-8")))
        (parameter,) = load(find([f"{name}.py"])[0]).parameters
        assert (parameter.unit, parameter.meaning) == (given, given)
    for tree in trees:
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant):
                node.value = None
    assert ast.dump(trees[0]) == ast.dump(trees[1])
    assert not (tmp_path / MADE).exists()


@pytest.mark.parametrize("name", ["__init__", "a/b", "..", "a.b", "if", "a b", "x/" * 999, "é"])
def test_the_name_of_a_script_stays_in_its_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    table = tmp_path / "t.csv"
    table.write_text(HEADER + "L, 0, 0, t\n", "utf-8")
    assert main(["new", name, "--from", "dh", str(table), "-o", str(tmp_path)]) == 1
    assert capsys.readouterr().err.startswith("closedform: ")
    assert list(tmp_path.iterdir()) == [table]


def test_nothing_is_written_through_a_link(tmp_path: Path) -> None:
    table = tmp_path / "t.csv"
    table.write_text(HEADER + "L, 0, 0, t\n", "utf-8")
    (tmp_path / "arm.py").symlink_to(tmp_path / "elsewhere.py")
    assert main(["new", "arm", "--from", "dh", str(table), "-o", str(tmp_path)]) == 1
    assert not (tmp_path / "elsewhere.py").exists()


def toy() -> tuple[Derivation, sp.Symbol, sp.Symbol]:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A.",)), "An arm.")
    return d, d.parameter("L", value=1, unit="m", meaning="link"), d.joint("t")


def test_expressions_are_not_read_from_text(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    d, L, t = toy()
    with pytest.raises(TypeError, match=r"must be an exact rational: write sympy\.Rational"):
        d.parameter("K", value=OPEN, unit="m", meaning="k")
    with pytest.raises(TypeError, match="is a string; write the expression without quotes"):
        from_dh(d, [(OPEN, 0, 0, t)])
    for use in (
        lambda: Program().let("x", OPEN),
        lambda: Chain(d, from_dh(d, [(L, 0, 0, t)]).pose).let("x", OPEN),
        lambda: d.function("f", "F.", {"q": [t]}, {"x": [OPEN]}),
        lambda: source(OPEN),
        lambda: from_screws(d, [(t, (OPEN, 0, 0), (0, 0, 0))], sp.eye(4)),
        lambda: from_screws(d, [(t, (1, 0, 0), (0, 0, 0))], [[OPEN] * 4] * 4),
    ):
        with pytest.raises((TypeError, sp.SympifyError)):
            use()
    assert not (tmp_path / MADE).exists()


def test_a_kept_proof_is_data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What an inverse assumes is kept as text, and read back for the LaTeX."""
    monkeypatch.chdir(tmp_path)
    d, L, t = toy()
    d.function("f", "F.", {"q": [t]}, {"x": [L * t]})
    page = Page(d, Proof("toy", "toy", (), 0, ()))
    result = InverseResult(
        function="f",
        branches=1,
        continua=0,
        solutions=1,
        method="",
        assumptions=("L - sqrt(t**2 + 0.5)",),
        lemmas=(),
    )
    told = Told(page, d["f"], page.algorithm(d["f"]), "")
    assert r"\sqrt{t^{2} + \frac{1}{2}}" in told.proved(result)["where"]
    with pytest.raises(FormulaError):
        told.proved(replace(result, assumptions=(OPEN,)))
    assert not (tmp_path / MADE).exists()


def test_a_line_of_a_script_holds_names_only() -> None:
    with pytest.raises(ValueError, match="is not a name"):
        source(sp.Symbol(OPEN) + 1)
