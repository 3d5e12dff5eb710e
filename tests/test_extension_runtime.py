"""The runtime of the compiled extension, on a toy table, against plain NumPy.

The toy's kernels are in extension_toy/toy.c, and again in toy.py. Values are small binary
fractions, so that float32 and integer conversions are exact and results can be compared bit for
bit (but for sines and cosines).
"""

from __future__ import annotations

import contextlib
import copy
import gc
import importlib.util
import inspect
import os
import pickle
import shutil
import subprocess
import sys
import sysconfig
import threading
import time
import warnings
import weakref
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from extension_toy.toy import LAYOUTS, ROWS, STRIDED, Mixed, Two, chain, check, polar, two, values
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import mutually_broadcastable_shapes

ROOT = Path(__file__).parents[1]
RUNTIME = ROOT / "closedform" / "extension"
TOY = Path(__file__).parent / "extension_toy" / "toy.c"
SANITIZED = bool(os.environ.get("CLOSEDFORM_TEST_SANITIZE"))
SANITIZE = ["-fsanitize=address,undefined", "-fno-sanitize-recover=undefined", "-O1"]
WARNINGS = ["-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]
INCLUDES = [
    f"-I{RUNTIME}",
    "-isystem",
    sysconfig.get_paths()["include"],
    "-isystem",
    np.get_include(),
]


@pytest.fixture(scope="module")
def native(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The toy extension, compiled from the runtime's sources."""
    folder = tmp_path_factory.mktemp("toy")
    target = folder / ("toy_native" + sysconfig.get_config_var("EXT_SUFFIX"))
    command = [os.environ.get("CC", "cc"), "-std=c99", "-O2", "-fPIC", "-shared"]
    command += ["-fno-math-errno", "-fno-trapping-math", "-DCF_MODULE_NAME=toy_native"]
    command += SANITIZE if SANITIZED else []
    command += [*INCLUDES, *map(str, sorted(RUNTIME.glob("*.c"))), str(TOY), "-lm"]
    subprocess.run([*command, "-o", str(target)], check=True)
    spec = importlib.util.spec_from_file_location("toy_native", target)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["toy_native"] = module
    spec.loader.exec_module(module)
    return module


def function(native: Any, name: str) -> Any:
    return native.function(f"toy.{name}", ROWS[name].results)


# Values and shapes


@settings(
    max_examples=60 if SANITIZED else 300,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
@given(data=st.data())
def test_any_shapes_and_layouts(native: Any, data: st.DataObject) -> None:
    name = data.draw(st.sampled_from(sorted(ROWS)))
    row = ROWS[name]
    n_in, n_params = len(row.cores), len(row.defaults)
    shapes = data.draw(
        mutually_broadcastable_shapes(
            num_shapes=n_in + n_params, min_dims=0, max_dims=4, min_side=0, max_side=6
        )
    ).input_shapes
    rng = np.random.default_rng(data.draw(st.integers(0, 1000)))
    plain, given_in = [], []
    for core, lead in zip(row.cores, shapes, strict=False):
        x = values(rng, (*lead, *core))
        plain.append(x)
        given_in.append(LAYOUTS[data.draw(st.sampled_from(sorted(LAYOUTS)))](x, len(core)))
    fields, given_fields = [], []
    for lead in shapes[n_in:]:
        x = values(rng, lead)
        fields.append(x)
        layout = data.draw(st.sampled_from(sorted(LAYOUTS)))
        given_fields.append(LAYOUTS[layout](x, 0))
    params = {"params": tuple(given_fields)} if n_params else {}
    check(row, function(native, name)(*given_in, **params), row.expected(*plain, *fields))


@pytest.mark.parametrize("n", [0, 1, 3, 4, 5, 15, 17, 63, 64, 511, 512, 513, 2048, 5001])
@pytest.mark.parametrize("name", sorted(ROWS))
@pytest.mark.parametrize("layout", sorted(STRIDED))
def test_batches_in_all_memory_layouts(native: Any, name: str, layout: str, n: int) -> None:
    """Every length around a block or a tile; planes 4096 bytes apart among them."""
    row, f = ROWS[name], function(native, name)
    rng = np.random.default_rng(n)
    plain = [values(rng, (n, *core)) for core in row.cores]
    inputs = [STRIDED[layout](x, len(core)) for x, core in zip(plain, row.cores, strict=True)]
    fields = [np.float64(p) for p in row.defaults]
    if not row.cores:
        fields[0] = values(rng, (n,))
    params = {"params": tuple(fields)} if fields else {}
    expected = row.expected(*plain, *fields)
    check(row, f(*inputs, **params), expected)

    sentinel = [
        STRIDED[layout](np.full((n, *core), 99).astype(kind), len(core))
        for core, kind in row.outputs
    ]
    out = sentinel[0] if len(sentinel) == 1 else row.results(*sentinel)
    assert f(*inputs, **params, out=out) is out
    check(row, out, expected)
    for array in sentinel:
        if layout == "strided" and array.base is not None and array.size:
            outside = np.ones(array.base.shape, bool)
            outside[(slice(1, None, 3),) * array.ndim] = False
            assert (array.base[outside] == np.array(77).astype(array.dtype)).all()


@pytest.mark.parametrize(
    ("lead_q", "lead_r0", "lead_r1"),
    [
        ((700,), (), (1,)),
        ((700,), (700,), ()),
        ((9, 130), (9, 1), ()),
        ((9, 130), (130,), (1, 1)),
        ((130,), (9, 1), (1, 130)),
        ((5, 1, 90), (7, 1), (1,)),
        ((600, 3), (3,), ()),
        ((2, 3, 4, 5), (3, 1, 1), (2, 1, 1, 1)),
        ((), (40,), ()),
        ((1,) * 60, (2, 1, 1), (3,)),
    ],
)
def test_parameter_fields_vary_along_any_axes(
    native: Any, lead_q: Any, lead_r0: Any, lead_r1: Any
) -> None:
    rng = np.random.default_rng(1)
    q, r0, r1 = values(rng, (*lead_q, 2)), values(rng, lead_r0), values(rng, lead_r1)
    f = function(native, "polar")
    check(ROWS["polar"], f(q, (r0, r1)), polar(q, r0, r1))
    check(ROWS["polar"], f(q[..., ::-1], [r0, r1]), polar(q[..., ::-1], r0, r1))


@pytest.mark.parametrize(
    ("lead_q", "lead_u"),
    [((300, 3), (3,)), ((3, 300), (3, 1)), ((4, 5, 6), (4, 1, 6)), ((1, 70), (70, 1)), ((), (99,))],
)
@pytest.mark.parametrize("order", ["C", "F"])
def test_inputs_broadcast_against_each_other(
    native: Any, lead_q: Any, lead_u: Any, order: Any
) -> None:
    rng = np.random.default_rng(2)
    q, u = values(rng, (*lead_q, 2)), values(rng, (*lead_u, 3, 3))
    q, u = np.array(q, order=order), np.array(u, order=order)
    check(ROWS["two"], function(native, "two")(q, u), two(q, u))


def test_broadcast_views_and_planes_without_stride(native: Any) -> None:
    f = function(native, "chain")
    row = np.broadcast_to(np.arange(6.0), (1000, 6))
    check(ROWS["chain"], f(row), chain(row))
    column = np.broadcast_to(np.arange(1000.0)[:, None], (1000, 6))
    check(ROWS["chain"], f(column), chain(column))


def test_single_posture_forms_agree(native: Any) -> None:
    f, row = function(native, "polar"), ROWS["polar"]
    q = np.array([0.5, 0.25])
    for form in (q, [0.5, 0.25], (0.5, 0.25), list(q), q[None][0], np.float32(q)):
        check(row, f(form), polar(q, 1.0, 0.5))
        check(row, f(form, (2.0, 3)), polar(q, 2.0, 3.0))
        check(row, f(q=form, params=[np.float64(2), np.array(3)]), polar(q, 2.0, 3.0))
    check(row, f([1, 2]), polar(np.array([1.0, 2.0]), 1.0, 0.5))
    check(row, f([True, False]), polar(np.array([1.0, 0.0]), 1.0, 0.5))


def test_scalars_are_numpy_scalars(native: Any) -> None:
    assert type(function(native, "scalar")(1, 2.0)) is np.float64
    assert type(function(native, "scalar")(np.array(1.0), np.float32(2))) is np.float64
    assert type(function(native, "inside")([0.5, 0.5])) is np.bool_
    assert type(function(native, "inside")([[0.5, 0.5]])[0]) is np.bool_
    assert function(native, "volume")() == 0.5
    assert function(native, "volume")((3.0, 2.0)) == 18.0
    y, flag, w = function(native, "mixed")(1.0)
    assert (type(y), type(flag), w.shape) == (np.float64, np.bool_, (2, 3, 2))


def test_non_finite_values_pass_silently(native: Any) -> None:
    q = np.array([[np.nan, 1.0], [np.inf, 0.0], [1e308, 1e308]] * 30)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = function(native, "polar")(q, (1e308, 10.0))
    assert np.isnan(result[0]).all() and np.isnan(result[1]).all()


# out=


def test_out_is_returned(native: Any) -> None:
    q, u = np.ones(2), np.ones((3, 3))
    x = np.empty(2)
    assert function(native, "polar")(q, out=x) is x
    assert function(native, "polar")(q, out=None) is not x
    arrays = (np.empty((2, 3)), np.empty(2, np.uint8))
    result = function(native, "two")(q, u, out=arrays)
    assert type(result) is Two and result.v is arrays[0] and result.status is arrays[1]
    given_results = Two(*arrays)
    assert function(native, "two")(q, u, out=given_results) is given_results
    assert native.function("toy.two")(q, u, out=arrays) is arrays
    y = np.empty(())
    assert function(native, "scalar")(1.0, 2.0, out=y) is y and y == -4.0


@pytest.mark.parametrize("shift", [-3, -1, 0, 1, 2])
@pytest.mark.parametrize("n", [1, 3, 700])
def test_out_may_overlap_an_input(native: Any, shift: int, n: int) -> None:
    memory = np.arange(2.0 * n + 16) / 8
    q = memory[8 : 8 + 2 * n].reshape(n, 2)
    x = memory[8 + shift : 8 + shift + 2 * n].reshape(n, 2)
    expected = polar(q.copy(), 1.0, 0.5)
    np.testing.assert_allclose(function(native, "polar")(q, out=x), expected, 1e-14, 1e-14)


@pytest.mark.parametrize("lead", [(), (50,)])
def test_out_may_overlap_a_matrix_or_a_parameter(native: Any, lead: tuple[int, ...]) -> None:
    rng = np.random.default_rng(3)
    q, u = values(rng, (*lead, 2)), values(rng, (*lead, 3, 3))
    expected = two(q.copy(), u.copy())
    v = u.reshape(*lead, 9)[..., 3:].reshape(*lead, 2, 3)
    if lead:
        v = u[..., 1:, :]
    out = Two(v, np.empty((*lead, 2), np.uint8))
    check(ROWS["two"], function(native, "two")(q, u, out=out), expected)

    r = values(rng, (64, 2))
    expected = polar(np.ones(2), r[:, 0].copy(), 0.5)
    result = function(native, "polar")(np.ones(2), (r[:, 0], 0.5), out=r)
    np.testing.assert_allclose(result, expected, 1e-14, 1e-14)


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
    ("polar", (Q, None), {}, TypeError, "'NoneType' object is not iterable"),
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
    ("polar", ([object(), 1.0],), {}, TypeError, "must be a string or a real number"),
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
    native: Any, name: str, args: Any, kwargs: Any, error: type[Exception], message: str
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


# The objects


def test_functions_look_like_functions(native: Any) -> None:
    f = function(native, "polar")
    assert (f.__name__, f.__qualname__) == ("polar", "polar")
    assert f.__module__ == "toy"
    assert f.__doc__ == "A point from an angle and a length."
    assert str(inspect.signature(f)) == "(q, params=(1.0, 0.5), *, out=None)"
    assert str(inspect.signature(function(native, "two"))) == "(q, u, *, out=None)"
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
    """All paths once: short, general, into given arrays, and every error."""
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


def blocks_kept(work: Callable[[], Any], rounds: int = 200) -> int:
    """Memory blocks of Python that so many rounds leave behind each time: what only fills a cache
    is not left again."""
    kept = []
    for _ in range(4):
        gc.collect()
        before = sys.getallocatedblocks()
        for _ in range(rounds):
            work()
        gc.collect()
        kept.append(sys.getallocatedblocks() - before)
    return min(kept)


@pytest.mark.skipif(SANITIZED, reason="counts memory by itself")
def test_nothing_leaks(native: Any) -> None:
    functions = {name: function(native, name) for name in ROWS}
    assert blocks_kept(lambda: exercise(functions)) < 100
    assert blocks_kept(lambda: [function(native, name) for name in ROWS]) < 100
    assert blocks_kept(lambda: refused(native)) < 100


@pytest.mark.skipif(SANITIZED or sys.platform != "linux", reason="reads the resident size")
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


# The sources


@pytest.mark.skipif(SANITIZED, reason="needs no second run")
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_sources_compile_without_a_warning(compiler: str) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler}")
    python_free = [str(RUNTIME / "closedform_sweep.c"), str(TOY)]
    command = [compiler, "-std=c99", "-O1", "-fsyntax-only", *WARNINGS]
    sources = sorted(map(str, RUNTIME.glob("*.c")))
    subprocess.run([*command, *INCLUDES, *sources], check=True)
    subprocess.run([*command, "-pedantic", f"-I{RUNTIME}", *python_free], check=True)


@pytest.mark.skipif(SANITIZED, reason="is the sanitized run")
def test_under_address_sanitizer() -> None:
    """The tests of values, shapes, out= and errors again, with every access checked."""
    gcc = shutil.which("gcc")
    if gcc is None or sys.platform != "linux":
        pytest.skip("needs gcc on Linux")
    libraries = [
        subprocess.run(
            [gcc, f"-print-file-name={name}"], capture_output=True, text=True
        ).stdout.strip()
        for name in ("libasan.so", "libubsan.so")
    ]
    if not all(os.path.isabs(path) for path in libraries):
        pytest.skip("gcc has no sanitizers")
    environment = os.environ | {
        "CLOSEDFORM_TEST_SANITIZE": "1",
        "CC": gcc,
        "LD_PRELOAD": " ".join(libraries),
        "ASAN_OPTIONS": "detect_leaks=0",
    }
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-x", __file__]
    run = subprocess.run(command, env=environment, cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout[-4000:] + run.stderr[-4000:]
