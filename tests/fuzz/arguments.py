"""Arguments of every kind for the NumPy modules and the extension, which must answer alike.

The calls run in a process of their own, so that a crash is a finding and does not end the attack.
An argument is described by data, from which it can be made again.
"""

from __future__ import annotations

import contextlib
import decimal
import fractions
import json
import subprocess
import sys
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .outcome import Failure, Outcome

NAME = "arguments"
CALLS = 1500
PATIENCE = 120
"""Seconds after which a round counts as hanging."""

AWKWARD = (0.0, -0.0, 1.0, -1.0, 0.5, np.pi, 1e-300, -1e-12, 5e-324, 1e22, -1e308, np.inf, -np.inf)
AWKWARD += (np.nan, 18.0, 2.0)
DTYPES = ("f8", "f8", "f8", "f8", ">f8", "f4", "f2", "g", "i8", "u1", "?", "c16", "O", "U3", "S3")
DTYPES += ("M8[s]", "m8[s]", "f8,f8")
LAYOUTS = ("plain", "plain", "strided", "reversed", "fortran", "read-only", "unaligned", "repeated")
LEADS: tuple[tuple[int, ...], ...] = ((), (), (1,), (3,), (7,), (2, 3), (0,), (1, 3), (40,))
OBJECTS = (
    "None", "text", "bytes", "dict", "generator", "nested", "ragged", "huge", "decimal",
    "fraction", "complex", "masked", "memory", "deep", "shrinking", "raising", "number-like",
    "lying", "array-like",
)  # fmt: skip


def round(rng: np.random.Generator) -> Outcome:
    """Some thousand calls in one process."""
    outcome = Outcome()
    plan = [_draw(rng) for _ in range(CALLS)]
    problems, crash = _in_process(plan)
    outcome.count("NumPy and the extension", calls=CALLS, failed=len(problems))
    for place, message in problems:
        outcome.failures.append(Failure(NAME, message, {"call": plan[place]}))
    if crash is not None:
        place, message = crash
        outcome.failures.append(Failure(NAME, message, {"call": plan[place]}))
    return outcome


def replay(case: Mapping[str, Any]) -> list[str]:
    """One saved call, in a process of its own."""
    problems, crash = _in_process([case["call"]])
    return [message for _, message in [*problems, *([crash] if crash else [])]]


def _in_process(
    plan: list[dict[str, Any]],
) -> tuple[list[tuple[int, str]], tuple[int, str] | None]:
    """The problems by their place in the plan, and where the process died, if it did."""
    command = [sys.executable, "-m", "fuzz.arguments"]
    try:
        done = subprocess.run(
            command,
            input=json.dumps(plan),
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            cwd=Path(__file__).parent.parent,
        )
        output, error, code = done.stdout, done.stderr, done.returncode
    except subprocess.TimeoutExpired as late:
        raw = late.stdout or b""
        output = raw.decode() if isinstance(raw, bytes) else raw
        error, code = f"no end after {PATIENCE} s", 1
    lines = [json.loads(line) for line in output.splitlines()]
    problems = [(line["place"], line["problem"]) for line in lines if "problem" in line]
    begun = [line["place"] for line in lines if "problem" not in line]
    if code:
        last = error.strip().splitlines()[-1] if error.strip() else ""
        return problems, (begun[-1] if begun else 0, f"the process ended with {code}: {last}")
    return problems, None


# Drawing


def _draw(rng: np.random.Generator) -> dict[str, Any]:
    """One call as data: a function, its arguments, parameters and output."""
    robot, name, shapes, fields = _functions()[rng.integers(0, len(_functions()))]
    hostile = rng.random() < 0.5
    lead = LEADS[rng.integers(0, len(LEADS))]
    arguments = [_array(rng, (*lead, *shape), hostile) for shape in shapes]
    params: Any = None
    if rng.random() < 0.6:
        params = [_array(rng, lead if rng.random() < 0.3 else (), hostile) for _ in range(fields)]
        if hostile and rng.random() < 0.1:
            params = _object(rng)
        elif hostile and rng.random() < 0.1:
            params = params[:-1]
    return {"robot": robot, "function": name, "arguments": arguments, "params": params}


def _array(rng: np.random.Generator, shape: tuple[int, ...], hostile: bool) -> dict[str, Any]:
    if hostile and rng.random() < 0.15:
        return _object(rng) | {"shape": list(shape)}
    if hostile and shape and rng.random() < 0.15:
        wrong = list(shape)
        wrong[rng.integers(0, len(wrong))] += int(rng.integers(-1, 2))
        shape = tuple(max(0, n) for n in wrong)
    return {
        "kind": "array",
        "shape": list(shape),
        "dtype": DTYPES[rng.integers(0, len(DTYPES))] if hostile else "f8",
        "layout": LAYOUTS[rng.integers(0, len(LAYOUTS))],
        "seed": int(rng.integers(0, 1 << 30)),
        "awkward": bool(rng.random() < 0.3),
        "list": bool(rng.random() < 0.1),
    }


def _object(rng: np.random.Generator) -> dict[str, Any]:
    return {"kind": OBJECTS[rng.integers(0, len(OBJECTS))], "shape": []}


def _functions() -> list[tuple[str, str, list[tuple[int, ...]], int]]:
    """Every generated function: its robot, name, core shapes and number of parameters."""
    if not _FUNCTIONS:
        import importlib
        import pkgutil

        import closedform.generated.numpy as package

        for module in pkgutil.iter_modules(package.__path__):
            if module.name.startswith("_"):
                continue
            robot = importlib.import_module(f"{package.__name__}.{module.name}")
            fields = len(robot.Parameters._fields)
            for value in vars(robot).values():
                if type(value).__name__ == "Kernel":
                    shapes = [tuple(a.shape) for a in value.inputs]
                    name = value.name.rpartition(".")[2]
                    if shapes:
                        _FUNCTIONS.append((module.name, name, shapes, fields))
    return _FUNCTIONS


_FUNCTIONS: list[tuple[str, str, list[tuple[int, ...]], int]] = []


# Making and calling


class _Shrinking(list[Any]):
    """A sequence whose length changes while it is read."""

    def __getitem__(self, place: Any) -> Any:
        if len(self) > 1:
            self.pop()
        return super().__getitem__(place)

    def __iter__(self) -> Any:
        while self:
            yield self.pop()


class _Raising:
    def __float__(self) -> float:
        raise RuntimeError("no number")

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        raise RuntimeError("no array")


class _NumberLike:
    def __float__(self) -> float:
        return 0.5


class _Lying(list[Any]):
    def __len__(self) -> int:
        return 1_000_000


class _ArrayLike:
    def __init__(self, array: Any):
        self.array = array

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        return np.asarray(self.array, dtype=dtype)


class _Resizing:
    """A number that changes the shape of an array while it is converted."""

    def __init__(self, victim: Any):
        self.victim = victim

    def __float__(self) -> float:
        with contextlib.suppress(ValueError, AttributeError):
            self.victim.resize((1,), refcheck=False)
        return 1.0


def _make(spec: Mapping[str, Any], victim: Any = None) -> Any:
    kind, shape = spec["kind"], tuple(spec["shape"])
    if kind == "array":
        return _made_array(spec, shape)
    plain = np.zeros(shape)
    made: dict[str, Any] = {
        "None": None,
        "text": "0.5",
        "bytes": b"0.5",
        "dict": {"l1": 1.0},
        "generator": (x for x in (1.0, 2.0)),
        "nested": plain.tolist(),
        "ragged": [[1.0], [1.0, 2.0]],
        "huge": [10**400],
        "decimal": decimal.Decimal("0.5"),
        "fraction": fractions.Fraction(1, 2),
        "complex": 1j,
        "masked": np.ma.masked_array(plain, mask=plain == 0),
        "memory": memoryview(np.ones(3)),
        "deep": _deep(),
        "shrinking": _Shrinking(plain.tolist() if shape else [1.0, 2.0, 3.0]),
        "raising": _Raising(),
        "number-like": _Resizing(victim) if victim is not None else _NumberLike(),
        "lying": _Lying([1.0, 2.0]),
        "array-like": _ArrayLike(plain),
    }
    return made[kind]


def _deep() -> list[Any]:
    value: list[Any] = []
    for _ in range(200):
        value = [value]
    return value


def _made_array(spec: Mapping[str, Any], shape: tuple[int, ...]) -> Any:
    rng = np.random.default_rng(spec["seed"])
    values = rng.uniform(-2, 2, shape)
    if spec["awkward"]:
        values = rng.choice(AWKWARD, shape)
    dtype = np.dtype(spec["dtype"])
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        if dtype.names:
            array = np.zeros(shape, dtype)
        elif dtype.kind in "mMiu":
            array = np.asarray(np.nan_to_num(values)).astype("i4").astype(dtype)
        else:
            array = np.asarray(values).astype(dtype)
    if spec["list"]:
        return array.tolist()
    return _laid_out(array, spec["layout"])


def _laid_out(array: Any, layout: str) -> Any:
    if layout == "fortran":
        return np.asfortranarray(array)
    if layout == "read-only":
        array.flags.writeable = False
    elif layout == "repeated":
        return np.broadcast_to(array, array.shape)
    elif layout == "strided" and array.ndim:
        wide = np.zeros((2 * array.shape[0], *array.shape[1:]), array.dtype)
        wide[::2] = array
        return wide[::2]
    elif layout == "reversed" and array.ndim:
        return array[::-1].copy()[::-1]
    elif layout == "unaligned" and not array.dtype.hasobject:
        raw = np.zeros(array.nbytes + 1, np.uint8)
        shifted = raw[1:].view(array.dtype).reshape(array.shape)
        shifted[...] = array
        return shifted
    return array


def _answer(function: Any, call: Mapping[str, Any]) -> tuple[str, Any]:
    """The type of what was raised, or the arrays."""
    arguments = [_make(a) for a in call["arguments"]]
    # NumPy itself dies of a read-only array of objects that was resized from no elements
    owned = [a for a in arguments if isinstance(a, np.ndarray) and a.flags.owndata]
    victim = next((a for a in owned if not a.dtype.hasobject), None)
    given = call["params"]
    if given is not None:
        made = [_make(p, victim) for p in given] if isinstance(given, list) else _make(given)
        arguments.append(tuple(made) if isinstance(made, list) else made)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            result = function(*arguments)
    except Exception as error:
        return type(error).__name__, str(error)
    return "", [np.asarray(r) for r in (result if isinstance(result, tuple) else (result,))]


def _compare(call: Mapping[str, Any]) -> str:
    import importlib

    answers = {}
    for backend in ("numpy", "c"):
        robot = importlib.import_module(f"closedform.generated.{backend}.{call['robot']}")
        answers[backend] = _answer(getattr(robot, call["function"]), call)
    (kind, a), (other, b) = answers["numpy"], answers["c"]
    name = f"{call['robot']}.{call['function']}"
    if kind != other:
        return f"{name}: NumPy {kind or 'answers'} {a if kind else ''}, C {other or 'answers'} " + (
            str(b) if other else ""
        )
    if kind:
        allowed = ("ValueError", "TypeError", "OverflowError", "RuntimeError")
        return "" if kind in allowed else f"{name}: {kind} {a}"
    if [r.shape for r in a] != [r.shape for r in b] or [r.dtype for r in a] != [r.dtype for r in b]:
        return f"{name}: NumPy gives {[r.shape for r in a]}, C {[r.shape for r in b]}"
    if len(a) == 2 and (a[1] != b[1]).any():
        return f"{name}: NumPy has the statuses {a[1].tolist()}, C {b[1].tolist()}"
    return ""


def main() -> None:
    for place, call in enumerate(json.load(sys.stdin)):
        print(json.dumps({"place": place}), flush=True)
        if problem := _compare(call):
            print(json.dumps({"place": place, "problem": problem}), flush=True)


if __name__ == "__main__":
    main()
