"""Texts and names that could break or enter the printed code, in every place that takes them."""

import ast
import builtins
import io
import json
import re
import shutil
import subprocess
import sys
import tokenize
import types
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from places import ROOT

from closedform import Crank, parallel
from closedform.check.clibrary import compiler
from closedform.check.report import _page
from closedform.emit.pages import pages, shared_files
from closedform.mechanics.frames import merge_angles
from closedform.model.claims import Gravity
from closedform.model.derivation import Derivation, Paper, Table
from closedform.model.functions import Branches, Program, branches, choose, real
from closedform.model.inverse import Inverse
from closedform.model.names import check_symbol
from closedform.proof.checks.statements import Undecidable
from closedform.proof.claims import ClaimResult, erratum_result
from closedform.proof.prove import Proof

pytestmark = pytest.mark.usefixtures("compiled_quickly")

Strings = Callable[[str], str]
PACKAGE = ROOT / "closedform"
HEADER = PACKAGE.parent / "generated" / "c" / "closedform.h"


needs_node = pytest.mark.skipif(
    shutil.which("node") is None, reason="Node is not installed: the JavaScript is not run"
)


def slider(text: Strings = lambda field: field, name: Strings = lambda field: field) -> Derivation:
    """A slide and a turn, with every text and name chosen by the caller."""
    paper = Paper(name("key"), text("paper"), (text("author"), "B."), text("reference"))
    d = Derivation(name("robot"), text("title"), paper, text("mechanism"), task=[name("task"), "b"])
    d.branches = (name("plus"), "minus")
    d.singularities = (text("singularity"),)
    h = d.parameter(
        name("h"), value=2, unit=text("unit"), meaning=text("meaning"), source=text("source")
    )
    theta, s = d.joint(name("theta")), d.joint("s", "prismatic")
    d.step(
        text("step"),
        text("reason"),
        {"x": theta},
        published=[text("published")],
        rows=[[text("cell"), "b"], [text("cell"), theta]],
    )
    x, y, sigma = real(name("x_entry")), real("y_entry"), real(name("sigma"))
    p = Program()
    r = p.let(name("r"), sp.sqrt(x**2 + y**2), nonnegative=True)
    rest = p.bound(name("rest"), r - h, h, text("bound"))
    p.match(x - x + h - h, h, text("match"))
    p.require([h - h], h, text("require"))
    free = p.vanishes(name("flag"), r, h, text("flag"), free=(theta,))
    sides = branches((sigma, {+1: name("plus"), -1: "minus"}))
    d.function(
        name("forward"),
        text("summary"),
        {name("q"): (theta, s)},
        {name("p"): [s * sp.cos(theta) + h, s * sp.sin(theta)]},
        source=text("function source"),
        notes=[text("note")],
    )
    d.function(
        "ik",
        text("summary"),
        {name("target"): (x, y)},
        {"q": [choose(free, 0, sp.atan2(sigma * y, sigma * x)), sigma * rest]},
        program=p,
        branches=sides,
        result="Solutions",
        notes=[text("note")],
    )
    d.inverses.append(Inverse("ik", (theta, s), (x, y), (h, h)))
    d.tables.append(Table(name("table"), text("header"), s, (sp.S.One,), {text("column"): s**2}))
    printed = re.sub(r"[${}]", "", text("printed"))  # these begin a formula or a phrase
    d.claim(text("label"), printed, lambda: Undecidable("a figure"), where=text("where"))
    error, why, use = (text(f).replace("$", "") for f in ("error", "why", "use"))
    d.erratum("key", error, Gravity.RESULT, why=why, use=use)
    return d


def printed(d: Derivation, evidence: str = "evidence") -> dict[Path, str]:
    """All files, printed without a proof."""
    claims = [
        ClaimResult(
            label=c.label,
            where=c.where,
            printed=c.printed,
            kind="refuted",
            evidence=evidence,
            corrected="",
            readings=(),
            erratum="key",
        )
        for c in d.claims
    ]
    errata = tuple(map(erratum_result, d.errata))
    proof = Proof(
        name=d.name,
        paper=d.paper.key,
        steps=(),
        identities=0,
        inverses=(),
        claims=tuple(claims),
        errata=errata,
    )
    own = pages(d, proof)
    return own.files | shared_files([own.share])


HOSTILE = [
    "a */ int evil; /* b",
    "*/",
    "/*/",
    "*/*/",
    "ends with *",
    "/ begins",
    "// and ??/",
    '"""',
    '\\"""',
    "'''",
    'ends with "',
    "ends with \\",
    "\\",
    r"\N{DASH} \x00 \u12 \777",
    "%s %d % %n",
    "coding: utf-16",
    "-*- coding=latin-1 -*-",
    "{{ 7*7 }} {% raw %} {# #}",
    '"; system("x"); "',
    "#define int char",
    "`x` <script>alert(1)</script> ![a](b) [a](javascript:b)",
    r"\input{/etc/passwd} \write18{ls} \end{document}",
    r"(\input{x} % theta1 = 1)",
    r"theta1 = 2*(\write18{x})",
    r"|\input{x}| = 1",
    r"x = 2**{\input{y} %}",
    r"[\input{x} +/- 1] = 2",
    "_ & # ~ ^ { } } {",
    "[3pt] or *",
    "* [3pt]",
    "a $ b",
    "é ß 𝛼 日本 😀 “quoted”",
]
REFUSED = ["\0", "\a", "\t", "\r", "\x1b[31m", "\x7f", "\u202e", "\u2066", "\u2028", "\ud800"]
TEXTS: list[str] = []
slider(text=lambda field: TEXTS.append(field) or field)
TEXTS = list(dict.fromkeys(TEXTS))
SEVERAL_LINES = {"mechanism", "reason", "note"}

COMMENT_OR_STRING = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"', re.DOTALL)


def c_tokens(code: str) -> list[str]:
    return re.findall(r"\w+|\S", COMMENT_OR_STRING.sub(lambda m: '""' * (m[0][0] == '"'), code))


def python_tokens(code: str) -> list[tuple[int, str]]:
    """The code without comments, and with a placeholder for each string."""
    dropped = (tokenize.COMMENT, tokenize.NL)
    return [
        (t.type, "" if t.type == tokenize.STRING else t.string)
        for t in tokenize.tokenize(io.BytesIO(code.encode()).readline)
        if t.type not in dropped
    ]


ESCAPED = {"textbackslash", "textasciitilde", "textasciicircum", "backslash", "sim", "wedge"}
ESCAPED |= {*r"\&%$#_{},", "mathrm", "textquotedbl", "pm", "operatorname"}


def tex_commands(code: str) -> list[str]:
    """Commands with an effect, the ends of comments, and the depth of braces at the end."""
    commands = re.findall(r"\\([A-Za-z]+|.)", code)
    kept = sorted({c for c in commands if c not in ESCAPED and not re.fullmatch(r"x\d*", c)})
    plain = re.sub(r"\\.", "", code)
    lines = [line for line in plain.splitlines() if "%" in line]
    return [*kept, str(len(lines)), str(plain.count("{") - plain.count("}"))]


def tokens(files: dict[Path, str]) -> dict[Path, Any]:
    readers = {
        ".c": c_tokens,
        ".h": c_tokens,
        ".js": c_tokens,  # comments and strings are written alike
        ".py": python_tokens,
        ".tex": tex_commands,
    }
    return {p: readers[p.suffix](t) for p, t in files.items() if p.suffix in readers}


@pytest.fixture(scope="module")
def harmless() -> dict[Path, Any]:
    return tokens(printed(slider()))


@cache
def runtime_of_the_modules(backend: str) -> types.ModuleType:
    module = types.ModuleType("hostile._runtime")
    exec(shared_files([], [backend])[Path(backend, "_runtime.py")], module.__dict__)
    return module


def imported(code: str, backend: str = "numpy") -> dict[str, Any]:
    """A printed Python module, run beside the runtime."""
    package = types.ModuleType("hostile")
    package.__path__ = []
    runtime_module = runtime_of_the_modules(backend)
    sys.modules |= {"hostile": package, "hostile._runtime": runtime_module}
    package._runtime = runtime_module  # type: ignore[attr-defined]
    names: dict[str, Any] = {"__name__": "hostile.robot", "__package__": "hostile"}
    exec(compile(code, "robot.py", "exec"), names)
    return names


def words(text: str) -> str:
    return " ".join(text.split())


@pytest.mark.parametrize("text", HOSTILE)
def test_a_text_changes_nothing_but_itself(text: str, harmless: dict[Path, Any]) -> None:
    """In all fields at once: the code is that of harmless texts, and repeats the text exactly."""
    files = printed(slider(text=lambda _: text), evidence=text)
    found = tokens(files)
    assert found.keys() == harmless.keys()
    for path, expected in harmless.items():
        assert found[path] == expected, path
    module = imported(files[Path("numpy", "robot.py")])
    assert words(text) in words(module["__doc__"])
    assert text in module["Parameters"].h.__doc__
    assert words(text) in words(module["forward"].__doc__)
    ast.parse(files[Path("c", "robot.py")])
    table = files[Path("data", "table.csv")]
    assert len(table.splitlines()) == 2


def test_hostile_texts_compile(tmp_path: Path) -> None:
    """As C, with the warnings of comments and strings; the extension's table as well."""
    sources = []
    for k, text in enumerate(HOSTILE):
        files = printed(slider(text=lambda _, text=text: text))
        folder = tmp_path / str(k)
        folder.mkdir()
        for path, code in files.items():
            if path.parts[0] == "c" and path.suffix in (".c", ".h"):
                (folder / path.name).write_text(code)
        sources += [folder / "robot.c", folder / "extension.c"]
    compile_c(sources)


@needs_node
def test_hostile_texts_are_modules_of_javascript(tmp_path: Path) -> None:
    """Which run, and say the texts as they are."""
    for k, text in enumerate(HOSTILE):
        write_javascript(tmp_path / str(k), printed(slider(text=lambda _, text=text: text)))
    run_javascript(
        tmp_path,
        len(HOSTILE),
        f"""
        const expected = {json.dumps(HOSTILE)}[k];
        if (m.SINGULARITIES[0] !== expected) throw new Error(`${{m.SINGULARITIES}}`);
        """,
    )


def write_javascript(folder: Path, files: dict[Path, str]) -> None:
    folder.mkdir()
    (folder / "package.json").write_text('{ "type": "module" }')
    for path, code in files.items():
        if path.suffix == ".js":
            (folder / path.name).write_text(code, "utf-8")


def run_javascript(root: Path, n: int, code: str) -> None:
    """Import the one robot of each folder, and run code with it."""
    script = root / "all.mjs"
    script.write_text(
        f"""
import {{ readdirSync }} from "node:fs";
for (let k = 0; k < {n}; ++k) {{
    const folder = new URL(`${{k}}/`, import.meta.url);
    for (const name of readdirSync(folder).filter((f) => /^[^_].*\\.js$/.test(f))) {{
        const m = await import(new URL(name, folder));
        if (name === "index.js") continue;
        try {{
            {code}
        }} catch (cause) {{
            throw new Error(`${{k}} ${{name}}`, {{ cause }});
        }}
    }}
}}
"""
    )
    run = subprocess.run(["node", script], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr[:3000]


def compile_c(sources: list[Path], *flags: str) -> None:
    runtime = ROOT / "closedform" / "runtime"
    headers = [f"-I{runtime / name}" for name in ("extension", "c")]
    command = [compiler(), "-std=c99", "-fsyntax-only", "-Wall", "-Wextra", "-Wcomment"]
    command += ["-Wtrigraphs", "-Wshadow", "-Werror", *headers, *flags]
    run = subprocess.run([*command, *map(str, sources)], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr[:3000]


@pytest.mark.parametrize("field", TEXTS)
def test_control_characters_are_refused(field: str) -> None:
    for character in REFUSED:
        with pytest.raises(ValueError, match=r"printable.*U\+"):
            slider(text=lambda f, c=character: f"a{c}b" if f == field else "harmless")


@pytest.mark.parametrize("field", TEXTS)
def test_only_prose_may_have_several_lines(field: str, harmless: dict[Path, Any]) -> None:
    def text(f: str) -> str:
        return "one\n\ntwo\n*/ x = 1" if f == field else f

    if field not in SEVERAL_LINES:
        with pytest.raises(ValueError, match=r"one line of printable text.*U\+000A"):
            slider(text=text)
        return
    for path, found in tokens(printed(slider(text=text))).items():
        assert found == harmless[path], path


def test_markdown_is_escaped() -> None:
    text = "# <b> [a](b) `c` *d* _e_"
    files = printed(slider(text=lambda _: text), evidence=text)
    for line in files[Path("errata.md")].splitlines():
        assert not re.search(r"(?<!\\)<b>|(?<!\\)\]\((?!#key)", line), line
    page = _page(slider(text=lambda _: text), [], [], [])
    assert page.startswith(r"# \# \<b\> \[a\]")


# Names

TAKEN = """import lambda None np out params Any Parameters Status JOINTS _runtime double real_t
uint8_t linux unix M_PI I errno NAN INT_MAX CF_PI cf_sqrt CLOSEDFORM_C closedform extension _native
math stdint Stdio string CON n k start rare sines steady angle_0 single default runtime fields
values status ik ik_batch ik_whole_kernel forward_batch robot_params ROBOT_DEFAULTS robot_ik_batch q
q_stride q_i target_i nan result np_2 sin gamma y1 self list count theta s h x_entry r Forward
delete function typeof let yield eval parameters v o found index package fk_batch Math NaN"""
NAMES = TAKEN.split()
BAD = ["", "a b", "../x", "a;b", "é", "1x", "-x", "a-b", "x" * 300, "a\nb", "{{ x }}", 'a"b', "a%b"]
FIELDS: list[str] = []
slider(name=lambda field: FIELDS.append(field) or field)
FIELDS = list(dict.fromkeys(FIELDS))
LABELS = {"plus", "task", "key"}
NOTHING_PROVED = Proof("robot", "key", (), 0, ())
TOLD = {
    "robot": "math stdint Stdio string closedform extension _native CON import index",
    "h": "linux unix M_PI CF_PI cf_sqrt errno I np import lambda Parameters ROBOT_DEFAULTS",
    "theta": "linux M_PI np out lambda h nan delete typeof let Math",
    "forward": "import np Parameters default runtime fields ik ik_batch ik_whole_kernel Forward",
    "q": "out params lambda n sines Status robot_params np parameters yield eval",
    "target": "q q_i status linux",
    "table": "_native",
}
"""Names that must be refused, at least, in a place."""


def named(field: str, value: str) -> Derivation:
    return slider(name=lambda f: value if f == field else f)


@pytest.mark.parametrize("field", FIELDS)
def test_a_bad_name_is_refused(field: str) -> None:
    for value in BAD:
        allowed = {"plus": ["1x"], "task": ["1x"], "key": ["", "1x", "-x", "a-b"]}
        if value in allowed.get(field, []) or (len(value) == 300 and field in LABELS):
            continue
        with pytest.raises(ValueError) as error:
            named(field, value)
        assert value[:3] in str(error.value) or repr(value) in str(error.value)


@cache
def accepted() -> dict[str, list[str]]:
    """The names that are not refused in each place."""
    found: dict[str, list[str]] = {}
    for field in FIELDS:
        for value in NAMES:
            try:
                named(field, value)
            except ValueError as error:
                assert value in str(error)
            else:
                found.setdefault(field, []).append(value)
    return found


@pytest.mark.parametrize("field", FIELDS)
def test_a_name_that_breaks_a_language_is_refused(field: str) -> None:
    assert not set(accepted().get(field, [])) & set(TOLD.get(field, "").split())


def combinations() -> Iterator[tuple[dict[str, str], Derivation]]:
    """Derivations in which every accepted name stands once in each place.

    Each has a name in as many places as possible; where two do not go together, one waits.
    """
    waiting = {field: list(names) for field, names in accepted().items()}
    while any(waiting.values()):
        names: dict[str, str] = {}
        d = slider()
        for field in waiting:
            for value in [v for v in waiting[field] if v not in names.values()][:3]:
                try:
                    d = slider(name=lambda f: {**names, field: value}.get(f, f))  # noqa: B023
                except ValueError:
                    continue
                names[field] = value
                waiting[field].remove(value)
                break
        yield names, d


def test_a_name_that_is_not_refused_works(tmp_path: Path) -> None:
    """It compiles, and changes no result."""
    sources = []
    (tmp_path / "js").mkdir()
    target = np.array([3.0, 4.0])
    for k, (names, d) in enumerate(combinations()):
        assert names, "a name that is accepted alone goes with no other"
        own = pages(d, NOTHING_PROVED, ("array", "numpy", "c", "data", "js"))
        files = own.files
        assert all(len(p.parts) == 2 and ".." not in p.parts for p in files)
        folder = tmp_path / str(k)
        folder.mkdir()
        for path, code in files.items():
            if path.suffix in (".c", ".h"):
                (folder / path.name).write_text(code)
        sources.append(folder / f"{d.name}.c")
        forms = {**files, **shared_files([own.share], ["js"])}
        write_javascript(tmp_path / "js" / str(k), forms)
        for backend in ("array", "numpy"):
            module = imported(files[Path(backend, f"{d.name}.py")], backend)
            assert set(module["__all__"]) <= module.keys()
            solutions = module["ik"](target)
            np.testing.assert_allclose(
                solutions.q[0], [np.arctan2(4, 3), 3], atol=1e-12, err_msg=str(names)
            )
            forward = module[names.get("forward", "forward")]
            np.testing.assert_allclose(forward([0.0, 1.0]), [3, 0], err_msg=str(names))
    shutil.copy(HEADER, tmp_path)
    headers = ["-include", "errno.h", "-include", "complex.h", "-include", "stdio.h"]
    compile_c(sources, "-std=gnu17", "-D_GNU_SOURCE", f"-I{tmp_path}", *headers)
    if shutil.which("node"):
        answers = "String(m.ik([3, 4]).q[0].map((x) => x.toFixed(12)))"
        expected = f"{np.arctan2(4, 3):.12f},{3:.12f}"
        code = f'if ({answers} !== "{expected}") throw new Error({answers});'
        run_javascript(tmp_path / "js", len(sources), code)


def test_two_labels_and_two_arguments_differ() -> None:
    with pytest.raises(ValueError, match="the name up is given twice"):
        Branches(("up", "up"), ({}, {}))
    with pytest.raises(ValueError, match="minus is given twice"):
        named("plus", "minus")
    with pytest.raises(ValueError, match="the name p is taken"):
        named("q", "p")
    with pytest.raises(ValueError, match="the name q_stride is taken"):
        slider(name=lambda f: {"p": "q_stride"}.get(f, f))
    d = slider()
    with pytest.raises(ValueError, match="the output of Solutions is called q"):
        d.function("g", "", {"x": d.actuated}, {"y": [1, 2]}, result="Solutions")
    with pytest.raises(ValueError, match="revolute or prismatic"):
        d.joint("t", "screw")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="write a tuple"):
        Paper("a", "A", "A. Nonymous")  # type: ignore[arg-type]


def test_later_changes_are_checked() -> None:
    d = slider()
    for field, value in (("title", "a\nb"), ("task", ["a b"]), ("branches", ("", ""))):
        with pytest.raises(ValueError, match=f"{field} of robot"):
            setattr(d, field, value)


@pytest.mark.parametrize(
    "flags", [["-std=gnu17", "-D_GNU_SOURCE"], ["-std=c99"], ["-std=gnu99", "-DCLOSEDFORM_FLOAT"]]
)
def test_macros_of_headers_are_no_names(flags: list[str], tmp_path: Path) -> None:
    """Every macro that needs no parentheses, of the headers that the C includes."""
    shutil.copy(HEADER, tmp_path)
    (tmp_path / "a.c").write_text(
        '#include "closedform.h"\n#include <stdio.h>\n#include <float.h>\n'
    )
    command = [compiler(), *flags, "-dM", "-E", str(tmp_path / "a.c")]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    macros = {*re.findall(r"^#define ([A-Za-z]\w*) ", run.stdout, re.M)}
    macros -= {"always_inline"}  # of the quick compiler of the tests
    assert len(macros) > 40
    for macro in macros:
        with pytest.raises(ValueError):
            check_symbol(macro, "a parameter")


def test_the_module_uses_no_name_of_python_that_a_function_may_have() -> None:
    """A function called like a builtin hides it from the whole module."""
    tree = ast.parse(printed(slider())[Path("numpy", "robot.py")])
    used = {n.id for n in ast.walk(tree) if isinstance(n, ast.Name)}
    assert used & set(dir(builtins)) <= {"list", "str"}


def test_no_text_is_evaluated_anywhere_in_the_toolkit() -> None:
    """``sympify`` turns text into code unless it is strict."""
    found = []
    for path in sorted(PACKAGE.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call):
                name = node.func.attr if isinstance(node.func, ast.Attribute) else ""
                name = node.func.id if isinstance(node.func, ast.Name) else name
                strict = any(
                    k.arg == "strict" and isinstance(k.value, ast.Constant) and k.value.value
                    for k in node.keywords
                )
                if name in ("parse_expr", "eval", "exec") or (name == "sympify" and not strict):
                    found.append(f"{path.relative_to(PACKAGE)}:{node.lineno}")
    assert not found


@pytest.mark.parametrize(
    "evaluate",
    [
        lambda text: Program().determined(real("x"), text, "small"),
        lambda text: merge_angles(text),
        lambda text: (
            Crank(real("q"), 1, text, pivot=(0, 0), along=(1, 0), across=(0, 1)) and _two_legs(text)
        ),
    ],
)
def test_a_text_in_place_of_an_expression_is_refused(evaluate: Any, tmp_path: Path) -> None:
    trace = tmp_path / "trace"
    with pytest.raises((sp.SympifyError, TypeError, ValueError)):
        evaluate(f"__import__('pathlib').Path({str(trace)!r}).touch()")
    assert not trace.exists()


def _two_legs(rod: Any) -> None:
    d = Derivation("arm", "Arm", Paper("arm", "Arm", ("nobody",)), "Two legs.", task=["x", "y"])
    legs = [
        Crank(d.joint(f"q{k}"), 1, rod, pivot=(0, k), along=(1, 0), across=(0, 1)) for k in (1, 2)
    ]
    parallel(d, (real("x"), real("y")), legs, {+1: "a", -1: "b"})
