"""The runtime of the compiled extension, on a toy table, against plain NumPy.

The toy's kernels are in extension_toy/toy.c, and again in toy.py. Values are small binary
fractions, so that float32 and integer conversions are exact and results can be compared bit for
bit (except sines and cosines).
"""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from extension_toy.build import (
    INCLUDES,
    ROOT,
    RUNTIME,
    SANITIZED,
    TOY,
    compile_toy,
    function,
    loaded,
)
from extension_toy.toy import LAYOUTS, ROWS, STRIDED, Two, chain, check, polar, two, values
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import mutually_broadcastable_shapes

WARNINGS = ["-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]

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
    """Every length near that of a block or a tile, including planes 4096 bytes apart."""
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


@pytest.mark.parametrize("strides", [(8, 8), (0, 8), (16, 0), (-8, 8), (8, 16)])
def test_out_must_not_overlap_itself(native: Any, strides: tuple[int, int]) -> None:
    out = np.lib.stride_tricks.as_strided(np.zeros(16)[8:], (3, 2), strides)
    with pytest.raises(ValueError, match=r"polar: out for x overlaps itself"):
        function(native, "polar")(np.ones((3, 2)), out=out)


def test_out_may_be_any_view_whose_elements_are_apart(native: Any) -> None:
    q = values(np.random.default_rng(3), (3, 5, 2))
    memory = np.empty((7, 12, 9))
    views = (
        memory[:3, :5, :2],
        memory[2::-1, 8:3:-1, 8:5:-2],
        np.moveaxis(memory[:2, :3, :5], 0, -1),
        memory.T[:3, ::2, ::5][:, :5],
    )
    expected = polar(q.copy(), 1.0, 0.5)
    for out in views:
        assert function(native, "polar")(q, out=out) is out
        np.testing.assert_allclose(out, expected, 1e-14, 1e-14)
    empty = np.lib.stride_tricks.as_strided(np.zeros(1), (0, 2), (0, 0))
    assert function(native, "polar")(np.ones((0, 2)), out=empty) is empty


# The sources


@pytest.mark.skipif(bool(SANITIZED), reason="needs no second run")
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_sources_compile_without_a_warning(compiler: str) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler}")
    python_free = [RUNTIME / "closedform_rows.c", RUNTIME / "closedform_sweep.c", TOY]
    command = [compiler, "-std=c99", "-O1", "-fsyntax-only", *WARNINGS]
    sources = sorted(map(str, RUNTIME.glob("*.c")))
    subprocess.run([*command, *INCLUDES, *sources], check=True)
    subprocess.run([*command, "-pedantic", f"-I{RUNTIME}", *python_free], check=True)


@pytest.mark.skipif(bool(SANITIZED), reason="needs no second run")
@pytest.mark.skipif(platform.machine() != "x86_64", reason="the levels are those of x86-64")
@pytest.mark.parametrize(("level", "here"), [("sse2", True), ("avx5124fmaps", False)])
def test_a_module_for_another_processor_is_not_loaded(
    level: str, here: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No processor that was sold with 64 bits lacks the first, and two of Intel's have the last."""
    monkeypatch.delitem(sys.modules, "toy_native", raising=False)
    compile_toy(tmp_path, "-O0", f'-DCLOSEDFORM_PROCESSOR="{level}"')
    if here:
        assert function(loaded(tmp_path), "polar")
    else:
        with pytest.raises(ImportError, match=rf"the level {level}, .* run make here"):
            loaded(tmp_path)


@pytest.mark.skipif(bool(SANITIZED), reason="is the sanitized run")
def test_under_address_sanitizer() -> None:
    """The tests of values, shapes, out=, errors and objects again, with every access checked."""
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
        "CLOSEDFORM_TEST_SANITIZE": "address",
        "CC": gcc,
        "LD_PRELOAD": " ".join(libraries),
        "ASAN_OPTIONS": "detect_leaks=0",
    }
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-x"]
    command += map(str, sorted(Path(__file__).parent.glob("test_extension_runtime*.py")))
    run = subprocess.run(command, env=environment, cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout[-4000:] + run.stderr[-4000:]
