"""closedform.h, compiled in both ways by each compiler and compared with Arb and long double."""

import ctypes
import math
import platform
import re
import shutil
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from closedform.generated.numpy import _runtime
from compiling import compiled
from flint import arb, ctx
from places import ROOT

HEADER = ROOT / "generated" / "c"
DRIVER = ROOT / "tests" / "c" / "header_driver.c"
WARNINGS = [
    "-pedantic",
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Wdouble-promotion",
    "-Wshadow",
    "-Werror",
]
OPTIMISED = ["-O3", "-fno-math-errno", "-fno-trapping-math"]
MAX_ULP = 2.0

COMPILERS = [name for name in ("gcc", "clang") if shutil.which(name)]
pytestmark = pytest.mark.skipif(not COMPILERS, reason="no C compiler")

# The error bounds must hold for separate multiplications and additions and for fused ones.
CODE = {
    "separate": ["-ffp-contract=off"],
    "shipped": ["-DCLOSEDFORM_DISPATCH", "-ffp-contract=fast"],
}
CPU = Path("/proc/cpuinfo")
if platform.machine() == "x86_64" and CPU.exists() and " fma " in CPU.read_text():
    CODE["fused"] = ["-mfma", "-ffp-contract=fast"]
BUILDS = [
    (compiler, code, real)
    for compiler in COMPILERS
    for code in CODE
    for real in (np.float64, np.float32)
    if (compiler, code) != ("clang", "shipped")  # it has no dispatch: nothing but "separate" again
]


def run(*command) -> str:
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    assert done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stderr}"
    return done.stdout + done.stderr


def real_flags(real) -> list[str]:
    return ["-DCLOSEDFORM_FLOAT"] if real is np.float32 else []


@dataclass
class Header:
    """The compiled driver: each function takes and returns arrays of `real`."""

    library: ctypes.CDLL
    real: type

    def __call__(self, name: str, *inputs, outputs: int = 1):
        arrays = [np.ascontiguousarray(values, self.real) for values in inputs]
        results = [np.empty_like(arrays[0]) for _ in range(outputs)]
        pointers = [array.ctypes.data_as(ctypes.c_void_p) for array in arrays + results]
        getattr(self.library, name)(ctypes.c_size_t(arrays[0].size), *pointers)
        return results[0] if outputs == 1 else results

    @property
    def constants(self) -> np.ndarray:
        """CF_TRIG_LIMIT, CF_PI, CLOSEDFORM_NAN, cf_sqrt(2)."""
        values = np.empty(4, self.real)
        self.library.constants(values.ctypes.data_as(ctypes.c_void_p))
        return values


@pytest.fixture(scope="module", params=BUILDS, ids=lambda b: f"{b[0]}-{b[1]}-{b[2].__name__}")
def header(request, tmp_path_factory):
    compiler, code, real = request.param
    target = tmp_path_factory.mktemp("header") / "header.so"
    flags = ["-std=c99", *WARNINGS, *OPTIMISED, *CODE[code], *real_flags(real)]
    compiled([compiler, *flags, "-I", HEADER, "-shared", "-fPIC", DRIVER, "-lm"], target)
    return Header(ctypes.CDLL(str(target)), real)


def patterns(real, count: int, seed: int) -> np.ndarray:
    """Finite numbers of either sign; every exponent, denormals included, is equally likely."""
    info = np.finfo(real)
    word = np.uint32 if real is np.float32 else np.uint64
    random = np.random.default_rng(seed)
    exponent = random.integers(0, 2**info.iexp - 1, count).astype(word)
    mantissa = random.integers(0, 2**info.nmant, count).astype(word)
    sign = random.integers(0, 2, count).astype(word)
    bits = (sign << word(info.bits - 1)) | (exponent << word(info.nmant)) | mantissa
    return bits.view(real)


@cache
def near_right_angles(real) -> np.ndarray:
    """The numbers nearest to k pi/2 and their neighbours, for which the reduction cancels most."""
    if real is np.float32:
        k = np.arange(1, 70_000)
    else:
        # Below the limit, 29, 87981 and 204551 come closest to a double or reduce worst.
        k = np.unique(np.r_[1:2000, 87981, 204551, 200_000:270_000:137, 10**6 : 10**7 : 999_983])
    ctx.prec = 160
    half_pi = arb.pi() / 2
    x = np.array([float((half_pi * int(n)).mid()) for n in k]).astype(real)
    inf = real(np.inf)
    return np.r_[x, np.nextafter(x, -inf), np.nextafter(x, inf), -x]


def spacing(value: np.ndarray, real) -> np.ndarray:
    """One ulp of `real` in the binade of the exact value, even if it rounds to the next."""
    info = np.finfo(real)
    _, exponent = np.frexp(np.abs(value))
    return np.ldexp(np.ones_like(value), np.maximum(exponent - 1, info.minexp) - info.nmant)


def ulps(got: np.ndarray, exact: np.ndarray) -> float:
    """`exact` in a wider type."""
    return float(np.max(np.abs(got.astype(exact.dtype) - exact) / spacing(exact, got.dtype.type)))


def ulps_arb(got: np.ndarray, exact: list[arb]) -> float:
    assert np.isfinite(got).all()
    worst = 0.0
    unit = spacing(np.array([float(value) for value in exact]), got.dtype.type)
    for g, e, u in zip(got.tolist(), exact, unit.tolist(), strict=True):
        worst = max(worst, float(abs((arb(g) - e) / arb(u)).mid()))
    return worst


def wide(x: np.ndarray) -> np.ndarray:
    return x.astype(np.float64 if x.dtype == np.float32 else np.longdouble)


needs_long_double = pytest.mark.skipif(
    np.finfo(np.longdouble).nmant < 63, reason="long double is no wider than double"
)


def test_sincos_against_arb(header):
    near = near_right_angles(header.real)
    x = np.r_[patterns(header.real, 1500, 1), near[:: near.size // 1500]]
    s, c = header("sincos_block", x, outputs=2)
    ctx.prec = 160
    exact = [arb(value) for value in x.tolist()]
    assert ulps_arb(s, [e.sin() for e in exact]) <= MAX_ULP
    assert ulps_arb(c, [e.cos() for e in exact]) <= MAX_ULP


@needs_long_double
def test_sincos_in_bulk(header):
    random = np.random.default_rng(2)
    limit = header.constants[0]
    x = np.concatenate(
        [
            random.uniform(-4, 4, 150_000),
            random.uniform(-limit, limit, 150_000),
            [limit, -limit, np.nextafter(limit, header.real(np.inf))],
        ]
    ).astype(header.real)
    x = np.r_[x, near_right_angles(header.real)]
    s, c = header("sincos_block", x, outputs=2)
    assert ulps(s, np.sin(wide(x))) <= MAX_ULP
    assert ulps(c, np.cos(wide(x))) <= MAX_ULP
    assert np.max(np.abs(s)) <= 1 and np.max(np.abs(c)) <= 1
    s_odd, c_even = header("sincos_block", -x, outputs=2)
    np.testing.assert_array_equal(s_odd, -s)
    np.testing.assert_array_equal(c_even, c)


@pytest.mark.parametrize("name", ["sincos_block_rounded", "sincos_lanes_rounded"])
def test_rounded_sincos_is_that_of_numpy(header, name):
    """Equal to the last bit, with and without fused operations: statuses depend on it."""
    if header.real is np.float32:
        pytest.skip("NumPy computes in double precision")
    random = np.random.default_rng(4)
    x = np.r_[
        near_right_angles(np.float64),
        random.uniform(-4, 4, 100_000),
        random.uniform(-1, 1, 20_000) * 10.0 ** random.uniform(-20, 15, 20_000),
        patterns(np.float64, 10_000, 5),
        [0.0, -0.0, np.inf, -np.inf, np.nan, 400000.0, np.nextafter(400000.0, np.inf)],
    ]
    x = np.r_[x, np.zeros(-x.size % 12)]
    with np.errstate(all="ignore"):
        expected = _runtime.sincos_as_in_c(x)
    for got, values in zip(header(name, x, outputs=2), expected, strict=True):
        np.testing.assert_array_equal(got, values)
        np.testing.assert_array_equal(np.signbit(got)[x == 0], np.signbit(values)[x == 0])


def test_rounded_sincos_of_one_number():
    random = np.random.default_rng(6)
    x = np.r_[
        random.uniform(-7, 7, 2000), random.uniform(-1e6, 1e6, 500), patterns(np.float64, 500, 7)
    ]
    x = np.r_[x, 0.0, -0.0, np.inf, -np.inf, np.nan]
    with np.errstate(all="ignore"):
        expected = _runtime.sincos_as_in_c(x)
        single = np.array([_runtime.sincos_as_in_c(angle) for angle in x]).T
    np.testing.assert_array_equal(single, expected)
    np.testing.assert_array_equal(np.signbit(single[0][x == 0]), np.signbit(x[x == 0]))


def test_sincos_of_special_values(header):
    tiny = float(np.finfo(header.real).smallest_subnormal)
    x = np.array([0.0, -0.0, np.inf, -np.inf, np.nan, tiny, -tiny, 1.0], header.real)
    for name in ("sincos_block", "sincos_lanes"):
        s, c = header(name, x, outputs=2)
        assert s[0] == 0 and not np.signbit(s[0]) and s[1] == 0 and np.signbit(s[1])
        assert np.isnan(s[2:5]).all() and np.isnan(c[2:5]).all()
        assert (c[[0, 1, 5, 6]] == 1).all() and (s[5:7] == x[5:7]).all()
        assert abs(s[7] - math.sin(1)) < 2e-7 and abs(c[7] - math.cos(1)) < 2e-7


def test_one_lane_out_of_range_leaves_the_others_alone(header):
    random = np.random.default_rng(3)
    x = random.uniform(-4, 4, (64, 8)).astype(header.real)
    s, c = header("sincos_lanes", x, outputs=2)
    y = x.copy()
    y[np.arange(64), np.arange(64) % 8] = header.real(1e30)
    t, d = header("sincos_lanes", y, outputs=2)
    same = y == x
    np.testing.assert_array_equal(t[same], s[same])
    np.testing.assert_array_equal(d[same], c[same])
    big = wide(y[~same])
    assert ulps(t[~same], np.sin(big)) <= MAX_ULP and ulps(d[~same], np.cos(big)) <= MAX_ULP


@pytest.mark.parametrize("length", [0, 1, 3, 7, 8, 9, 255])
def test_a_block_of_any_length(header, length):
    x = np.linspace(-9, 9, 255).astype(header.real)
    whole = header("sincos_block", x, outputs=2)
    part = header("sincos_block", x[:length], outputs=2)
    # A remainder loop may contract differently from the vector loop.
    for w, p in zip(whole, part, strict=True):
        np.testing.assert_allclose(p, w[:length], rtol=2 * np.finfo(header.real).eps)


def atan2_pairs(real, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Random exponents; equal and neighbouring magnitudes; moderate ratios, where errors show."""
    random = np.random.default_rng(4)
    y, x = patterns(real, count, 5), patterns(real, count, 6)
    with np.errstate(over="ignore", under="ignore"):
        ratio = (x * random.uniform(-4, 4, count)).astype(real)
    close = np.nextafter(x, real(0)) * random.choice([-1, 1], count).astype(real)
    moderate = random.uniform(-1, 1, (2, 2 * count)).astype(real)
    ys, xs = np.r_[y, ratio, close, moderate[0]], np.r_[x, x, x, moderate[1]]
    finite = np.isfinite(ys)
    return ys[finite], xs[finite]


def arb_atan2(y: float, x: float) -> arb:
    """Arb has no signed zeros, and on an axis math.atan2 is the nearest double, so not exact."""
    if x == 0 or y == 0:
        half_turns = round(math.atan2(y, x) / (math.pi / 2))
        return arb.pi() / 2 * half_turns
    return arb.atan2(arb(y), arb(x))


def test_atan2_against_arb(header):
    y, x = atan2_pairs(header.real, 700)
    angle = header("atan2_all", y, x)
    ctx.prec = 160
    exact = [arb_atan2(*pair) for pair in zip(y.tolist(), x.tolist(), strict=True)]
    assert ulps_arb(angle, exact) <= MAX_ULP


@needs_long_double
def test_atan2_in_bulk(header):
    y, x = atan2_pairs(header.real, 60_000)
    angle = header("atan2_all", y, x)
    assert ulps(angle, np.arctan2(wide(y), wide(x))) <= MAX_ULP
    pi = header.real(np.pi)
    assert angle.max() <= pi and angle.min() >= -pi
    np.testing.assert_array_equal(header("atan2_all", -y, x), -angle)


def test_atan2_of_special_values_is_that_of_c99(header):
    info = np.finfo(header.real)
    sizes = [0.0, float(info.smallest_subnormal), float(info.tiny), 1.0, float(info.max), np.inf]
    values = np.array([*sizes, *(-v for v in sizes), np.nan], header.real)
    y, x = (grid.ravel() for grid in np.meshgrid(values, values))
    with np.errstate(under="ignore"):
        libm = np.array(list(map(math.atan2, y.tolist(), x.tolist()))).astype(header.real)
    angle = header("atan2_all", y, x)
    number = ~np.isnan(libm)
    np.testing.assert_array_equal(np.isnan(angle), ~number)
    np.testing.assert_array_equal(np.signbit(angle)[number], np.signbit(libm)[number])
    np.testing.assert_array_max_ulp(angle[number], libm[number], 1, header.real)


@pytest.mark.parametrize(("name", "turns"), [("wrap", 4), ("wrap_cut", 0.5)])
def test_wrap_stays_in_the_half_open_interval(header, name, turns):
    pi = header.real(np.pi)
    ends = np.arange(-8, 9, dtype=header.real) * pi
    near = [np.nextafter(ends, header.real(99)), np.nextafter(ends, header.real(-99))]
    inside = np.random.default_rng(7).uniform(-25, 25, 3000).astype(header.real)
    x = np.concatenate([ends, *near, inside])
    x = x[np.abs(x) <= 2 * header.real(turns) * pi]
    wrapped = header(f"{name}_all", x)
    assert wrapped.max() <= pi and wrapped.min() > -pi
    ctx.prec = 160
    for angle, result in zip(x.tolist(), wrapped.tolist(), strict=True):
        whole = round((angle - result) / (2 * math.pi))
        error = abs(arb(angle) - 2 * arb.pi() * whole - arb(result))
        assert error <= float(np.spacing(header.real(max(abs(angle), math.pi))))
        assert not -pi < angle < min(float(pi), math.pi) or result == angle
    assert header(f"{name}_all", [-0.0])[0] == 0
    assert np.isnan(header(f"{name}_all", [np.nan]))[0]


def test_principal_values_are_as_accurate_of_large_angles(header):
    """Results are within two units in the last place of pi, and may round to just beyond pi."""
    random = np.random.default_rng(9)
    x = np.concatenate([random.uniform(-r, r, 1500) for r in (3, 30, 199, 4e5, 1e9, 1e30)])
    ends = np.arange(-64, 65) * np.pi
    x = np.concatenate([x, ends, np.nextafter(ends, 1e9)]).astype(header.real)
    turned = header("principal_all", x)
    unit = float(np.spacing(header.real(np.pi)))
    ctx.prec = 200
    for angle, result in zip(x.tolist(), turned.tolist(), strict=True):
        gap = arb(angle) - arb(result)
        turns = (gap / (2 * arb.pi()) + 0.5).floor()
        assert abs(gap - 2 * arb.pi() * turns) <= unit
    assert np.abs(turned).max() < 3.15
    small = np.abs(x) < 3.14
    np.testing.assert_array_equal(turned[small], x[small])
    assert np.isnan(header("principal_all", [np.nan, np.inf, -np.inf, 1.0])[:3]).all()
    x = x[: len(x) // 10 * 10]
    sines, cosines, lanes = header("turned_lanes", x, outputs=3)
    apart = np.sin((lanes - turned[: len(x)]).astype(float))  # beside pi it may be -pi
    np.testing.assert_allclose(apart, 0, rtol=0, atol=2 * unit)
    s, c = header("sincos_block", x, outputs=2)
    np.testing.assert_allclose(sines, s, rtol=0, atol=unit)
    np.testing.assert_allclose(cosines, c, rtol=0, atol=unit)


def test_lanes_are_what_one_after_the_other_gives(header):
    y, x = np.random.default_rng(8).uniform(-9, 9, (2, 240)).astype(header.real)
    sines, cosines, angles = header("lanes_all", y, x, outputs=3)
    s, c = header("sincos_plain", y, outputs=2)
    few = 4 * np.finfo(header.real).eps  # a vector may be given fused multiplications
    np.testing.assert_allclose(sines, s, rtol=0, atol=few)
    np.testing.assert_allclose(cosines, c, rtol=0, atol=few)
    np.testing.assert_allclose(angles, header("atan2_all", y, x), rtol=few)


def test_finite_max_min_and_constants(header):
    info = np.finfo(header.real)
    x = np.array([0, info.max, -info.max, info.smallest_subnormal, np.inf, -np.inf, np.nan, 1])
    np.testing.assert_array_equal(header("nought_all", x) == 0, np.isfinite(x))
    nan = np.nan
    larger, smaller = header("max_min_all", [1, 2, nan, 1, nan], [2, 1, 1, nan, nan], outputs=2)
    np.testing.assert_array_equal(larger, [2, 2, 1, nan, nan])  # the second, if either is NaN
    np.testing.assert_array_equal(smaller, [1, 1, 1, nan, nan])
    _, pi, not_a_number, root_two = header.constants
    assert pi == header.real(np.pi) and np.isnan(not_a_number)
    assert root_two == header.real(math.sqrt(2))


both_types = pytest.mark.parametrize("real", [np.float64, np.float32])


@both_types
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("level", ["-O0", "-O2"])
def test_sanitizers_find_nothing(real, compiler, level, tmp_path):
    program = tmp_path / "main"
    checks = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    flags = ["-std=c99", *WARNINGS, level, *checks, *real_flags(real), "-I", HEADER]
    probe = [compiler, *checks, "-x", "c", "-", "-o", program]
    if subprocess.run(probe, input=b"int main(void) { return 0; }", capture_output=True).returncode:
        pytest.skip(f"{compiler} has no sanitizers")
    compiled([compiler, *flags, DRIVER.with_name("header_main.c"), "-lm"], program)
    assert run(program) == "784\n"


@both_types
@pytest.mark.parametrize("compiler", [c for c in ("g++", "clang++") if shutil.which(c)])
def test_it_is_also_cpp(real, compiler, tmp_path):
    source = tmp_path / "use.cpp"
    source.write_text('#include "closedform.h"\nreal_t f(real_t x) { return cf_atan2(x, 1); }\n')
    flags = ["-std=c++17", *WARNINGS, "-O1", *real_flags(real), "-I", HEADER]
    run(compiler, *flags, "-c", source, "-o", tmp_path / "use.o")


@pytest.mark.parametrize("flag", ["-ffast-math", "-ffinite-math-only"])
@pytest.mark.parametrize("compiler", COMPILERS)
def test_fast_math_is_refused(compiler, flag):
    command = [compiler, flag, "-I", HEADER, "-fsyntax-only", DRIVER]
    assert subprocess.run(command, capture_output=True).returncode != 0


@pytest.mark.parametrize("compiler", COMPILERS)
def test_zeros_and_huge_angles_raise_no_exception(compiler, tmp_path):
    source = tmp_path / "main.c"
    source.write_text(
        """#include <fenv.h>
#include "closedform.h"
int main(void)
{
    static const real_t y[8] = { 0, -0.0f, 0, 0, 1, 0, -3, 0 }, x[8] = { 0, 0, -0.0f, 1, 0, 0, 2 };
    static const real_t angle[8] = { 0, 300, 5e5f, -1e7f, 1e9f, -1e10f, 4, 0 };
    real_t s[8], c[8], turned[8], all[8];
    feclearexcept(FE_ALL_EXCEPT);
    cf_atan2_lanes(8, y, x, all);
    for (int i = 0; i < 8; ++i) all[i] += cf_atan2(y[i], x[i]);
    cf_turned_lanes(8, angle, s, c, turned);
    cf_sincos_block(8, angle, s, c);
    return fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
}
"""
    )
    for flags in (OPTIMISED, ["-O0"]):
        for real in (np.float64, np.float32):
            program = tmp_path / "main"
            run(compiler, "-std=c99", *flags, *real_flags(real), "-I", HEADER, source,
                "-o", program, "-lm")  # fmt: skip
            run(program)


@both_types
@pytest.mark.skipif(
    "gcc" not in COMPILERS or platform.machine() != "x86_64", reason="not the target of dispatch"
)
def test_every_loop_becomes_vectors_in_every_clone(real, tmp_path):
    if int(run("gcc", "-dumpversion").split(".")[0]) < 12:
        pytest.skip("gcc before 12 has no clones for x86-64-v3 and v4")
    flags = ["-std=c99", *OPTIMISED, *CODE["shipped"], *real_flags(real), "-I", HEADER]
    told = run("gcc", *flags, "-fopt-info-vec-optimized", "-c", DRIVER, "-o", tmp_path / "o.o")
    loops: dict[str, set[str]] = {}
    for line, width in re.findall(r"(\S+:\d+):\d+: .*loop vectorized using (\d+) byte", told):
        loops.setdefault(width, set()).add(line)
    # The header's loops over a block, and six of the driver.
    assert len(loops["64"]) == 8
    assert loops["64"] <= loops["32"] and loops["64"] <= loops["16"]
