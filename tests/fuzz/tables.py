"""Tables of joints and files of loops with mistakes and attacks in them.

Each is refused with a reason, or read as data.  It is read under guard.  Any effect on the machine
is a finding, and so are an exception other than the documented one and a long silence.
"""

from __future__ import annotations

import ast
import mmap
import os
import signal
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from closedform.scaffold.new import new

from .outcome import Failure, Outcome

NAME = "tables"
HELD_OUT = Path(__file__).parents[1] / "held_out_loops"
GUIDE = (Path(__file__).parents[2] / "docs" / "closed-loops.md").read_text("utf-8")
TABLES = 60
PATIENCE = 20
"""Seconds that one table may take."""

DH = """# L1 = 0.5 m: upper arm
# L2 = 0.4 m: forearm
a, alpha, d, theta
L1, 0, 0, t1
L2, 0, 0, t2
"""
SCARA = """# l1 = 0.3 m: first link
a, alpha, d, theta, joint
l1, 0, 0.2, t1, t1
1/4, pi, 0, t2, t2
0, 0, d3, 0, d3
0, 0, 0, t4, t4
"""
SCREWS = """[parameters]
L = {value = "0.5", unit = "m", meaning = "link"}

[[axes]]
joint = "t1"
direction = [0, 0, 1]

[[axes]]
joint = "t2"
direction = [0, 0, 1]
point = ["L", 0, 0]

[home]
position = ["2*L", 0, 0]
"""
LOOP = """hand = "P"
[parameters]
L0 = {value = "0.5", meaning = "distance of the pivots"}
[bodies.ground]
A1 = [0, 0]
A2 = ["L0", 0]
[bodies.crank1]
B1 = ["L1", 0]
[bodies.crank2]
B2 = ["L0 + L2", 0]
[bodies.rod1]
length = "L3"
[bodies.rod2]
length = "L4"
[joints.theta1]
between = ["ground", "crank1"]
at = "A1"
driven = true
[joints.theta2]
between = ["ground", "crank2"]
at = "A2"
driven = true
[joints.b1]
between = ["crank1", "rod1"]
at = "B1"
[joints.b2]
between = ["crank2", "rod2"]
at = "B2"
[joints.p]
between = ["rod1", "rod2"]
at = "P"
"""
SLIDER = """hand = "x"
[bodies.ground]
A = [0, 0]
C = [0, "e"]
[bodies.crank]
B = ["r", 0]
[bodies.rod]
length = "l"
[bodies.piston]
C = [0, "e"]
[joints.theta]
between = ["ground", "crank"]
at = "A"
driven = true
[joints.b]
between = ["crank", "rod"]
at = "B"
[joints.c]
between = ["rod", "piston"]
at = "C"
[joints.x]
kind = "prismatic"
between = ["ground", "piston"]
axis = [1, 0]
"""
LINKAGE = """hand = "psi"
[parameters]
r = {value = "0.1", meaning = "crank"}
[bodies]
ground = {O = [0, 0], C = ["g", 0], G = ["g + h", 0]}
crank = {O = [0, 0], A = ["r", 0]}
rod1 = {length = "l"}
lever = {C = [0, 0], B = ["s", 0], E = [0, "-s"]}
rod2 = {length = "e"}
flap = {G = ["g + h", 0], F = ["g + h + f", 0]}
[joints]
theta = {between = ["ground", "crank"], at = "O", driven = true}
psi = {between = ["ground", "flap"], at = "G"}
c = {between = ["ground", "lever"], at = "C"}
a = {between = ["crank", "rod1"], at = "A"}
b = {between = ["rod1", "lever"], at = "B"}
p = {between = ["lever", "rod2"], at = "E"}
q = {between = ["rod2", "flap"], at = "F"}
"""
BASES = (
    ("dh", DH),
    ("dh", SCARA),
    ("screws", SCREWS),
    ("loop", LOOP),
    ("loop", SLIDER),
    ("loop", LINKAGE),
    *(
        ("loop", (HELD_OUT / f"{name}.toml").read_text("utf-8"))
        for name in ("hexa", "tsai", "tripteron", "tricept")
    ),
    ("loop", GUIDE.partition("```toml par4.toml\n")[2].partition("```")[0]),
)

FRAGMENTS = (
    "(x.attr)()", "().__class__.__bases__[0].__subclasses__()", "__import__('os').system('true')",
    "sin('__import__(\"os\").system(\"true\")')", "(lambda: 0)()", "[x for x in (1,)]", "t1.func",
    "exec('1')", "eval('1')", "open('/etc/passwd')", "{}.get", "f'{1}'", "'a'*10", "x if 1 else y",
    "(((9**9)**9)**9)**9", "9**9**9", "1e999999", "2**(3**4)", "(" * 4000 + ")" * 4000,
    "-" * 5000 + "1", "1+" * 4000 + "1", "sqrt(" * 60 + "2" + ")" * 60, "1" * 5000, "0x10", "1j",
    "1_0", "True", "None", "nan", "inf", "oo", "zoo", "I", "E", "pi", "pi/7", "cos(pi/18)",
    "sin(1)", "atan2(1,2)", "atan2(1)", "sqrt(-1)", "1/0", "0**-1", "L1", "t1", "-t1", "2*t1",
    "t1+t2", "t1*t2", "t1**2", "lambda", "import", "class", "int", "double", "np", "self", "d",
    "ik", "Chain", "", " ", "\t", "\0", "\x1b[31m", "\u202e", "\uff10", "\u0430", "a.b", "a;b",
    "a:b", "a=b", "a:=1", "*x", "x[0]", '"""', "'''", "\\", "\\n", "*/", "/*", "//", "#", "%s",
    "{{ 1 }}", "{% x %}", "$(true)", "`true`", "90", "1.5708", "0.7071", "1e-300", "1e300", "-0",
    "--1", "1//2", "5 % 3", "1<2", "@",
)  # fmt: skip
NAMES = ("arm", "../x", "a/b", "", ".", "math", "os", "class", "1a", "a b", "a\nb", "\u0430", "np")
FORBIDDEN = ("os.system", "os.exec", "os.posix_spawn", "subprocess.Popen", "socket.connect",
             "os.remove", "os.rename", "shutil.rmtree", "ctypes.dlopen")  # fmt: skip


class AttackSucceededError(BaseException):
    """A table made the reader do more than read data."""


WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_watched = False
_seen = mmap.mmap(-1, 512)
"""What was reported, also by a process that the reader has started: those share this memory."""


def _watch(event: str, arguments: tuple[Any, ...]) -> None:
    if _watched and (event in FORBIDDEN or (event == "open" and _writes(*arguments))):
        problem = f"{event} {arguments[:2]}"
        _seen[:] = problem.encode("utf-8", "replace")[: len(_seen)].ljust(len(_seen), b"\0")
        raise AttackSucceededError(problem)


def _writes(_path: Any, mode: str | None, flags: int) -> bool:
    """Whether a file is opened to be changed; ``os.open`` has no mode."""
    return bool(set(mode or "") & set("wax+")) or bool(flags & WRITING)


sys.addaudithook(_watch)


@contextmanager
def _guarded() -> Iterator[None]:
    """Watch what happens.

    Python itself writes the bytecode of a module that is imported late, which no table can
    cause or prevent; so it keeps none meanwhile.
    """
    global _watched
    before, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    _seen[:] = bytes(len(_seen))
    _watched = True
    try:
        yield
    finally:
        _watched = False
        sys.dont_write_bytecode = before


def round(rng: np.random.Generator) -> Outcome:
    """Some dozen tables, each with a few changes."""
    outcome = Outcome()
    for _ in range(TABLES):
        case = _draw(rng)
        result, problem = _read(case)
        outcome.count(case["kind"], tables=1, **{result: 1})
        if problem:
            outcome.failures.append(Failure(NAME, problem, case))
    return outcome


def replay(case: Mapping[str, Any]) -> list[str]:
    """One saved table."""
    _, problem = _read(case)
    return [problem] if problem else []


def _draw(rng: np.random.Generator) -> dict[str, Any]:
    kind, text = BASES[rng.integers(0, len(BASES))]
    for _ in range(rng.integers(1, 4)):
        text = _changed(rng, text)
    name = NAMES[rng.integers(0, len(NAMES))] if rng.random() < 0.1 else "arm"
    return {"kind": kind, "name": name, "text": text, "modified": bool(rng.random() < 0.2)}


def _changed(rng: np.random.Generator, text: str) -> str:
    """One token, one line or one character replaced, dropped or doubled."""
    fragment = FRAGMENTS[rng.integers(0, len(FRAGMENTS))]
    where = int(rng.integers(0, 5))
    if where < 3:
        marks = [i for i, c in enumerate(text) if c in ',"[\n=: ']
        start = marks[rng.integers(0, len(marks))] + 1
        stop = next((i for i in range(start, len(text)) if text[i] in ',"]\n'), len(text))
        return text[:start] + fragment + text[stop:]
    lines = text.splitlines()
    place = int(rng.integers(0, max(1, len(lines))))
    if where == 3 and lines:
        lines[place : place + 1] = [lines[place]] * int(rng.integers(0, 3))
        return "\n".join(lines) + "\n"
    spot = int(rng.integers(0, len(text) + 1))
    return text[:spot] + fragment + text[spot:]


@contextmanager
def _bounded(seconds: int) -> Iterator[None]:
    def late(_signal: int, _frame: Any) -> None:
        raise AttackSucceededError(f"no end after {seconds} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def _read(case: Mapping[str, Any]) -> tuple[str, str]:
    """``read`` or ``refused``, and what is wrong, if anything is."""
    result, problem = _outcome(case)
    seen = _seen[:].rstrip(b"\0").decode("utf-8", "replace")
    return ("failed", problem or seen) if seen else (result, problem)


def _outcome(case: Mapping[str, Any]) -> tuple[str, str]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "table"
        path.write_text(case["text"], "utf-8", errors="surrogatepass")
        start = time.monotonic()
        try:
            with _bounded(PATIENCE), _guarded():
                text = new(case["name"], case["kind"], path, modified=_modified(case)).text
        except (ValueError, TypeError) as error:
            return "refused", _complaint(str(error))
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            passed = time.monotonic() - start
            return "failed", f"{type(error).__name__}: {str(error)[:200]} ({passed:.0f} s)"
    return "read", _script(text)


def _modified(case: Mapping[str, Any]) -> bool:
    return bool(case["modified"]) and case["kind"] == "dh"


def _complaint(message: str) -> str:
    """A refusal is one line that a person can read."""
    if not message or len(message) > 1500:
        return f"a message of {len(message)} characters: {message[:100]}"
    return "" if message.isprintable() else f"a message that does not print: {message[:200]!r}"


CALLED = frozenset({
    "Abs", "Chain", "Derivation", "Matrix", "Pair", "Paper", "Rational", "Reaching", "atan",
    "atan2", "cos", "from_dh", "from_screws", "sin", "sqrt", "tan", "acos", "asin",
})  # fmt: skip


def _script(text: str) -> str:
    """The script calls what the toolkit exports, and nothing else."""
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError) as error:
        return f"the script does not parse: {error}"
    exported = {
        alias.name
        for node in tree.body
        if isinstance(node, ast.ImportFrom) and node.module == "closedform"
        for alias in node.names
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = node.func
            while isinstance(name, ast.Attribute):
                if name.attr.startswith("_"):
                    return f"the script calls {ast.unparse(node)[:100]}"
                name = name.value
            allowed = isinstance(name, ast.Name) and (
                name.id in CALLED | exported or isinstance(node.func, ast.Attribute)
            )
            if not allowed:
                return f"the script calls {ast.unparse(node)[:100]}"
        elif isinstance(node, ast.Import):
            modules = [alias.name for alias in node.names]
            if modules != ["sympy"]:
                return f"the script imports {', '.join(modules)}"
    return ""
