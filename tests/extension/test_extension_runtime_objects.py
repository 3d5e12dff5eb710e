"""The functions of the compiled extension as Python objects, on the toy table: what they refuse,
how they look, and that they neither leak memory nor stop other threads."""

from __future__ import annotations

import contextlib
import copy
import gc
import inspect
import os
import pickle
import sys
import threading
import time
import weakref
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from extension_toy.build import SANITIZED, function
from extension_toy.toy import ROWS, Mixed, Two, chain, check, polar, two, values
from portability import threads

# Errors

Q, U = np.ones(2), np.ones((3, 3))
ERRORS: list[tuple[str, tuple[Any, ...], dict[str, Any], type[Exception], str]] = [
    ("polar", (np.ones(3),), {}, ValueError, ": q has shape (3,), expected (..., 2)"),
    ("polar", ([1.0, 2.0, 3.0],), {}, ValueError, ": q has shape (3,), expected (..., 2)"),
    ("polar", (1.0,), {}, ValueError, ": q has shape (), expected (..., 2)"),
    ("polar", ([],), {}, ValueError, ": q has shape (0,), expected (..., 2)"),
    (
        "two",
        (Q, np.ones((4, 3, 2))),
        {},
        ValueError,
        ": u has shape (4, 3, 2), expected (..., 3, 3)",
    ),
    (
        "polar",
        (np.ones((3, 2)), (np.ones(4), 1.0)),
        {},
        ValueError,
        ": leading axes do not broadcast: q (3,), params.r0 (4,)",
    ),
    (
        "scalar",
        (np.ones((3, 0)), np.ones(2)),
        {},
        ValueError,
        ": leading axes do not broadcast: a (3, 0), b (2,)",
    ),
    ("polar", (Q, (1.0,)), {}, ValueError, ": params has 1 fields, expected 2 (r0, r1)"),
    (
        "polar",
        (Q, None),
        {},
        TypeError,
        ": params must be Parameters or a sequence of its 2 fields, not NoneType",
    ),
    (
        "polar",
        (Q, {"r0": 1.0}),
        {},
        TypeError,
        ": params must be Parameters or a sequence of its 2 fields, not dict; "
        "write Parameters(**params)",
    ),
    ("polar", (np.ma.ones(2),), {}, TypeError, ": q is a masked array, expected real numbers"),
    (
        "polar",
        (Q,),
        {"out": np.ma.ones(2)},
        TypeError,
        ": out for x must be an array, not MaskedArray",
    ),
    ("polar", (["1", 1 + 0j],), {}, TypeError, ": q has dtype <U64, expected real numbers"),
    ("polar", (), {}, TypeError, "() missing required argument: 'q'"),
    ("polar", (1, 2, 3), {}, TypeError, "() takes at most 2 positional arguments but 3 were given"),
    ("polar", (Q,), {"parms": 1}, TypeError, "() got an unexpected keyword argument 'parms'"),
    ("polar", (Q,), {"q": 1}, TypeError, "() got multiple values for argument 'q'"),
    ("two", (Q, U), {"params": ()}, TypeError, "() got an unexpected keyword argument 'params'"),
    ("polar", (1j * Q,), {}, TypeError, ": q has dtype complex128, expected real numbers"),
    (
        "polar",
        (Q, (1j, 2)),
        {},
        TypeError,
        ": params.r0 has dtype complex128, expected real numbers",
    ),
    ("polar", (["a", "b"],), {}, TypeError, ": q has dtype <U1, expected real numbers"),
    ("polar", ([object(), 1.0],), {}, TypeError, ": q holds object, expected real numbers"),
    ("polar", (Q, ([None], 1)), {}, TypeError, ": params.r0 holds NoneType, expected real numbers"),
    ("polar", ([[1.0, 2.0], [1.0]],), {}, ValueError, "inhomogeneous shape"),
    ("polar", ([10**400, 1],), {}, OverflowError, "too large"),
    ("polar", (Q, (10**400, 1)), {}, OverflowError, "too large"),
    ("polar", (Q,), {"out": np.ones(3)}, ValueError, ": out for x has shape (3,), expected (2,)"),
    (
        "polar",
        (np.ones((4, 2)),),
        {"out": np.ones(2)},
        ValueError,
        ": out for x has shape (2,), expected (4, 2)",
    ),
    (
        "polar",
        (Q,),
        {"out": np.ones(2, np.float32)},
        ValueError,
        ": out for x has dtype float32, expected float64",
    ),
    (
        "polar",
        (Q,),
        {"out": np.ones(2, ">f8")},
        ValueError,
        ": out for x has dtype >f8, expected float64",
    ),
    (
        "inside",
        (Q,),
        {"out": np.ones((), np.uint8)},
        ValueError,
        ": out for inside has dtype uint8, expected bool",
    ),
    ("polar", (Q,), {"out": [0, 0]}, TypeError, ": out for x must be an array, not list"),
    ("polar", (Q,), {"out": np.broadcast_to(1.0, 2)}, ValueError, ": out for x is read-only"),
    ("two", (Q, U), {"out": np.ones((2, 3))}, TypeError, ": out must be a tuple of 2 arrays"),
    (
        "two",
        (Q, U),
        {"out": (np.ones((2, 3)), np.ones(2))},
        ValueError,
        ": out for status has dtype float64, expected uint8",
    ),
]


@pytest.mark.parametrize(("name", "args", "kwargs", "error", "message"), ERRORS)
def test_errors(
    native: Any, name: str, *, args: Any, kwargs: Any, error: type[Exception], message: str
) -> None:
    with pytest.raises(error) as info:
        function(native, name)(*args, **kwargs)
    if message[0] in ":(":
        assert str(info.value) == f"toy.{name}{message}"
    assert message in str(info.value)


def test_too_many_axes_are_refused(native: Any) -> None:
    q = np.ones((1,) * 63 + (2,))
    assert function(native, "polar")(q).shape == q.shape
    with pytest.raises(ValueError, match="dimension"):
        function(native, "mixed")(np.ones((1,) * 63))


def test_code_run_by_a_conversion_may_raise_or_change_its_list(native: Any) -> None:
    class Awkward:
        def __init__(self, victim: list[Any]) -> None:
            self.victim = victim

        def __float__(self) -> float:
            self.victim.clear()
            return 2.0

    params: list[Any] = []
    params += [Awkward(params), 0.5]
    q = np.array([0.5, 0.25])
    check(ROWS["polar"], function(native, "polar")(q, params), polar(q, 2.0, 0.5))
    assert params == []


# Code of the caller that runs while its arguments are converted


def _resized(array: np.ndarray, *shape: int) -> None:
    array.resize(shape, refcheck=False)


CHANGES: dict[str, Callable[[np.ndarray], Any]] = {
    "no axes": lambda a: _resized(a),
    "one axis": lambda a: setattr(a, "shape", (-1,)),
    "other coordinates": lambda a: setattr(a, "shape", (*a.shape[::-1][:-1], -1, 1)),
    "fewer postures": lambda a: _resized(a, 1, *a.shape[1:]),
    "more postures": lambda a: _resized(a, 5000, *a.shape[1:]),
    "half the size": lambda a: setattr(a, "dtype", np.float32),
    "integers": lambda a: setattr(a, "dtype", np.int64),
    "nothing": lambda a: None,
}


class Hostile:
    """A number that changes an array while it is converted."""

    def __init__(self, victim: np.ndarray, change: Callable[[np.ndarray], Any]) -> None:
        self.victim, self.change = victim, change

    def __float__(self) -> float:
        self.change(self.victim)
        return 1.0


class HostileArray(Hostile):
    """The same by ``__array__``."""

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return np.full((3, 3), float(self))


class HostileSequence(Hostile):
    """The same by ``__len__`` and ``__getitem__``."""

    def __len__(self) -> int:
        return 2

    def __getitem__(self, k: int) -> float:
        if k > 1:
            raise IndexError
        return float(self)


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_an_array_may_change_while_what_follows_is_converted(native: Any, change: Any) -> None:
    """Each call uses the array as it ends up, or is refused; nothing is read beyond its end."""
    polar_, two_ = function(native, "polar"), function(native, "two")

    def attempts() -> list[tuple[np.ndarray, Callable[[np.ndarray], Any]]]:
        calls: list[Callable[[np.ndarray], Any]] = [
            lambda a: polar_(a, (Hostile(a, change), 1.0)),
            lambda a: polar_(a, (1.0, Hostile(a, change))),
            lambda a: polar_(a, HostileSequence(a, change)),
            lambda a: polar_(a, (Hostile(a, change), 1.0), out=np.empty((100, 2))),
            lambda a: polar_(a, (Hostile(a, change), 1.0), out=a),
            lambda a: two_(a, HostileArray(a, change)),
            lambda a: two_(a, np.array([[Hostile(a, change)] * 3] * 3, object)),
        ]
        fields: list[Callable[[np.ndarray], Any]] = [
            lambda a: polar_(np.ones((100, 2)), (a, Hostile(a, change))),
            lambda a: polar_(np.ones((100, 2)), (Hostile(a, change), a)),
        ]
        return [(np.ones((100, 2)), call) for call in calls] + [
            (np.ones(100), call) for call in fields
        ]

    for array, call in attempts():
        with contextlib.suppress(ValueError, TypeError):
            result = call(array)
            lead = len(result[0] if isinstance(result, tuple) else result)
            assert lead == 100 or lead == array.size / 2
    unchanged = np.ones((100, 2))
    assert polar_(unchanged, (Hostile(unchanged, lambda a: None), 1.0)).shape == (100, 2)


def test_a_copy_of_what_overlaps_runs_no_code_of_the_caller(native: Any) -> None:
    class Loud(np.ndarray):
        def __array_finalize__(self, _: Any) -> None:
            made.append(type(self))

    made: list[type] = []
    q = np.arange(8.0).reshape(4, 2).view(Loud)
    before = np.array(q)
    del made[:]
    out = q.view(np.ndarray)
    result = function(native, "polar")(q, (np.ones(4), 0.5), out=out[::-1])
    assert made == []
    check(ROWS["polar"], result, polar(before, 1.0, 0.5))


# The objects


def test_functions_look_like_functions(native: Any) -> None:
    f = function(native, "polar")
    assert (f.__name__, f.__qualname__) == ("polar", "polar")
    assert f.__module__ == "toy"
    assert f.__doc__ == "A point from an angle and a length."
    assert str(inspect.signature(f)) == "(q, params=(1.0, 0.5), *, out=None, threads=None)"
    assert str(inspect.signature(function(native, "two"))) == "(q, u, *, out=None, threads=None)"
    assert repr(f) == "<compiled function toy.polar>"
    assert inspect.isroutine(f)
    assert weakref.ref(f)() is f
    holder = type("Holder", (), {"f": f})
    assert holder().f is f
    assert native.names[:2] == ("toy.polar", "toy.two")


def test_functions_survive_copy_and_pickle(native: Any) -> None:
    f = function(native, "two")
    q, u = np.ones(2), np.eye(3)
    for g in (copy.deepcopy(f), pickle.loads(pickle.dumps(f))):
        check(ROWS["two"], g(q, u), two(q, u))


def test_results_classes_are_checked(native: Any) -> None:
    with pytest.raises(KeyError, match=r"toy\.nothing"):
        native.function("toy.nothing")
    with pytest.raises(TypeError, match="subclass of tuple"):
        native.function("toy.two", list)
    with pytest.raises(ValueError, match="fields"):
        native.function("toy.two", Mixed)
    with pytest.raises(ValueError, match="fields"):
        native.function("toy.polar", NamedTuple("X", [("x", float)]))
    with pytest.raises(TypeError):
        type(native.function("toy.polar"))()
    assert type(native.function("toy.two")(np.ones(2), np.eye(3))) is tuple


def test_keywords_need_not_be_interned(native: Any) -> None:
    keyword = "".join(["par", "ams"])
    assert function(native, "scalar")(a=1.0, b=2.0, **{keyword: (3.0,)}) == 1.0


# Resources


def exercise(functions: dict[str, Any]) -> None:
    """Take every path once: short, general, into given arrays, and every error."""
    rng = np.random.default_rng(0)
    for name, row in ROWS.items():
        f = functions[name]
        for lead in ((), (3,), (80,), (2, 50)):
            inputs = [values(rng, (*lead, *core)) for core in row.cores]
            f(*inputs)
            f(*(x.tolist() for x in inputs))
            params = tuple(values(rng, lead) for _ in row.defaults)
            result = f(*inputs, params) if params else f(*inputs)
            if lead and (row.cores or params):
                keep = {"params": params} if params else {}
                f(*inputs, **keep, out=result)
    for name, args, kwargs, error, _ in ERRORS:
        # pytest.raises keeps memory of its own
        with contextlib.suppress(error):
            functions[name](*args, **kwargs)


def refused(native: Any) -> None:
    for name, results in (("toy.nothing", tuple), ("toy.two", list), ("toy.two", Mixed)):
        with contextlib.suppress(KeyError, TypeError, ValueError):
            native.function(name, results)


def leaks(work: Callable[[], Any], rounds: int = 200, allowed: int = 100) -> bool:
    """Whether so many rounds leave more Python memory blocks behind each time.  A cache that fills
    up leaves none the second, third or fourth time."""

    def kept() -> int:
        gc.collect()
        before = sys.getallocatedblocks()
        for _ in range(rounds):
            work()
        gc.collect()
        return sys.getallocatedblocks() - before

    return all(kept() >= allowed for _ in range(4))


@pytest.mark.skipif(bool(SANITIZED), reason="counts memory by itself")
def test_nothing_leaks(native: Any) -> None:
    functions = {name: function(native, name) for name in ROWS}
    assert not leaks(lambda: exercise(functions))
    assert not leaks(lambda: [function(native, name) for name in ROWS])
    assert not leaks(lambda: refused(native))
    hoard: list[object] = []
    # three in a round, because what other tests left may be freed meanwhile
    assert leaks(lambda: hoard.extend((object(), object(), object())))


@pytest.mark.skipif(bool(SANITIZED) or sys.platform != "linux", reason="reads the resident size")
def test_scratch_is_freed(native: Any) -> None:
    def resident() -> int:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE")

    f, q = function(native, "chain"), np.ones((300, 6))
    out = f(q)
    before = resident()
    for _ in range(2000):
        f(q, out=out)
    assert resident() - before < 8e6  # each call uses 30 kB


def test_reference_counts_are_kept(native: Any) -> None:
    q, u, p = np.ones(2), np.eye(3), (2.0, 3.0)
    batch, out = np.ones((100, 2)), np.empty((100, 2))
    field = np.ones(100)
    dtypes = [np.dtype(float), np.dtype(np.uint8), np.dtype(bool)]
    objects = [q, u, p, batch, out, field, Two, p[0], *dtypes]
    polar_, two_ = function(native, "polar"), function(native, "two")
    scalar_, inside_ = function(native, "scalar"), function(native, "inside")

    def rounds(n: int) -> list[int]:
        for _ in range(n):
            polar_(q, p)
            polar_(batch, (field, 1.0), out=out)
            polar_(batch, out=batch)
            two_(q, u)
            two_(batch, u=u)
            polar_(np.float32(q), params=p)
            scalar_(1.0, 2.0)
            inside_(q)
            inside_(np.float32(q))
        gc.collect()
        return [sys.getrefcount(x) for x in objects]

    before = rounds(1)
    after = rounds(1000)
    # the descriptors of dtypes are shared by the whole process and may move by a few
    assert all(abs(a - b) < 20 for a, b in zip(after, before, strict=True)), (before, after)


def test_large_batches_release_the_gil(native: Any) -> None:
    ticks, stop = [0], threading.Event()

    def tick() -> None:
        while not stop.is_set():
            ticks[0] += 1
            time.sleep(0.0005)

    thread = threading.Thread(target=tick)
    q, out = np.ones((2_000_000, 2)), np.empty((2_000_000, 2))
    thread.start()
    try:
        before = ticks[0]
        function(native, "polar")(q, out=out)
        during = ticks[0] - before
    finally:
        stop.set()
        thread.join()
    assert during >= 10  # over 100 if released; held, a switch or two around the call


def test_threads_do_not_disturb_each_other(native: Any) -> None:
    f = function(native, "chain")
    right = []

    def work(seed: int) -> None:
        q = values(np.random.default_rng(seed), (3000, 6))
        expected = chain(q)
        right.append(
            all(
                np.array_equal(f(q), expected) and np.array_equal(f(q[0]), expected[0])
                for _ in range(30)
            )
        )

    threads = [threading.Thread(target=work, args=(seed,)) for seed in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert right == [True] * 4


@pytest.mark.parametrize(
    "attempt", ["shared_arrays", "shared_parameters", "changing_lists", "making_functions"]
)
def test_threads_may_share(native: Any, monkeypatch: pytest.MonkeyPatch, attempt: str) -> None:
    """``make portability`` repeats this without a GIL."""
    monkeypatch.setattr(threads, "ROUNDS", 10)
    getattr(threads, attempt)(native)
