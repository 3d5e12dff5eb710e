"""Peers that print C or C++; each is a shared library, timed by a common loop in C."""

from __future__ import annotations

import ctypes
import importlib
import inspect
import logging
import platform
import subprocess
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import sympy as sp

from .cases import Case, NotApplicableError

HERE = Path(__file__).parent
GENERATED = HERE.parent / "generated" / "c"
FLAGS = ["-O3", "-fno-math-errno", "-fno-trapping-math", "-ffp-contract=fast"]
LIBRARY = ["-fPIC", "-shared", "-fno-semantic-interposition"]
TARGETS = {"AVX-512": "x86-64-v4", "AVX2": "x86-64-v3"}


MOST = 24
"""Arctangents, or angles brought into range, in one kernel that is written by hand."""


def widest() -> str:
    """The target with the widest vectors of this machine; gcc may use only half their width."""
    info = Path("/proc/cpuinfo")
    wide = info.exists() and " avx512vl " in info.read_text()
    return TARGETS["AVX-512" if wide else "AVX2"]


def processor() -> str:
    """The name of the processor."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, platform.processor() or platform.machine())


LOOP = """
#include <time.h>
#ifdef __cplusplus
extern "C" {
#endif
void evaluate(const double *in, double *out);
double run(const double *in, double *out, int n_in, int n_out, int rows, int rounds)
{
    struct timespec a, b;
    clock_gettime(CLOCK_MONOTONIC, &a);
    for (int k = 0; k < rounds; ++k)
        for (int i = 0; i < rows; ++i)
            evaluate(in + i * n_in, out + i * n_out);
    clock_gettime(CLOCK_MONOTONIC, &b);
    return (1e9 * (double)(b.tv_sec - a.tv_sec) + (double)(b.tv_nsec - a.tv_nsec)) / rounds / rows;
}
#ifdef __cplusplus
}
#endif
"""


def ours(case: Case) -> str:
    n = len(case.source.symbols)
    values = case.width
    status = f", (unsigned char *)(out + {values})" if case.source.has_status else ""
    return f"""
#include "{case.robot}.c"
__attribute__((noinline)) void evaluate(const double *in, double *out)
{{
    {case.full}((const {case.robot}_params *)(in + {n}), in, out{status});
}}
"""


def by_hand(case: Case) -> str:
    """The body of the hand-written kernel for this function, without its trigonometry."""
    source = HERE / "limits" / f"{case.full}.c"
    if not source.exists():
        raise NotApplicableError("no kernel written by hand")
    return f'#include "closedform.h"\n#include "{source}"\n'


def limit(case: Case) -> str:
    """A hand-written kernel for one posture, with one eight-lane sincos."""
    return f"""
#define ARCTANGENTS(n, lanes, y, x, angle) cf_atan2_lanes(lanes, y, x, angle)
#define WRAPPED(n, lanes, angle) for (int k = 0; k < lanes; ++k) angle[k] = cf_wrap(angle[k])
{by_hand(case)}
__attribute__((noinline)) void evaluate(const double *in, double *out)
{{
    enum {{ LANES = ANGLES <= 4 ? 4 : 8 }};
    double angles[LANES] = {{ 0 }}, s[LANES], c[LANES];
    angles_of(in, angles);
    if (ANGLES) cf_sincos_lanes(LANES, angles, s, c);
    body(in, s, c, out);
}}
"""


def each(macro: str, statements: Iterable[str]) -> str:
    """Macros that do the first statement, the first two, ..."""
    done: list[str] = []
    lines: list[str] = []
    for n, statement in enumerate(statements, 1):
        done.append(statement)
        lines.append(f"#define {macro.format(n=n)} {', '.join(done)}\n")
    return "".join(lines)


def limit_of_planes(case: Case) -> str:
    """The hand-written kernel for planes: works in blocks, with the sines and cosines first."""
    n, width = len(case.source.symbols), case.width
    coordinates = [f"x[{k} * xs + at + i]" for k in range(n)]
    inputs = ", ".join([*coordinates, *(f"p[{k}]" for k in range(len(case.parameters)))])
    sines, cosines = (", ".join(f"{f}[{k}][i]" for k in range(8)) for f in "sc")
    angles = " ".join(f"a[{k}][i] = t[{k}];" for k in range(8))
    # writing many planes at once misses the address cache, so they are written one by one
    one_by_one = width > 16
    place = "r[{k}][i]" if one_by_one else "y[{k} * ys + at + i]"
    stores = " ".join(f"{place.format(k=k)} = out[{k}];" for k in range(width))
    # one by one, because compilers do not vectorise a loop around loops
    arctangents = (f"angle[{k}] = cf_atan2(y[{k}], x[{k}])" for k in range(MOST))
    wrapped = (f"angle[{k}] = cf_wrap(angle[{k}])" for k in range(MOST))
    unrolled = each("ARCTANGENTS_{n}(y, x, angle)", arctangents)
    unrolled += each("WRAPPED_{n}(angle)", wrapped)
    copies = (
        f"for (int k = 0; k < {width}; ++k) memcpy(y + k * ys + at, r[k], length * sizeof **r);"
    )
    return f"""
{unrolled}
#define ARCTANGENTS(n, lanes, y, x, angle) ARCTANGENTS_##n(y, x, angle)
#define WRAPPED(n, lanes, angle) WRAPPED_##n(angle)
{by_hand(case)}
void evaluate(size_t n, const double *p, const double *x, size_t xs, double *y, size_t ys)
{{
    enum {{ BLOCK = {512 if one_by_one else 256} }};
    double a[8][BLOCK], s[8][BLOCK], c[8][BLOCK];
    {f"double r[{width}][BLOCK + 8];" if one_by_one else ""}
    for (size_t at = 0; at < n; at += BLOCK) {{
        const size_t length = n - at < BLOCK ? n - at : BLOCK;
        #pragma GCC ivdep
        for (size_t i = 0; i < length && ANGLES; ++i) {{
            const double in[] = {{ {inputs} }};
            double t[8];
            angles_of(in, t);
            {angles}
        }}
        for (int k = 0; k < ANGLES; ++k)
            cf_sincos_block(length, a[k], s[k], c[k]);
        #pragma GCC ivdep
        for (size_t i = 0; i < length; ++i) {{
            const double in[] = {{ {inputs} }}, si[] = {{ {sines} }}, ci[] = {{ {cosines} }};
            double out[{width}];
            body(in, si, ci, out);
            {stores}
        }}
        {copies if one_by_one else ""}
    }}
}}
"""


def writing_of_planes(case: Case) -> str:
    """Writes as many planes without computing anything: the limit that memory sets."""
    n = len(case.source.symbols)
    return f"""
#include <stddef.h>
void evaluate(size_t n, const double *p, const double *x, size_t xs, double *y, size_t ys)
{{
    enum {{ BLOCK = 512 }};
    for (size_t at = 0; at < n; at += BLOCK)
        for (size_t k = 0; k < {case.width}; ++k)
            for (size_t i = at; i < n && i < at + BLOCK; ++i)
                y[k * ys + i] = x[k % {n} * xs + i] + p[0];
}}
"""


def sympy_c(case: Case) -> str:
    temporaries, results = case.program
    lines = [f"const double {s} = in[{k}];" for k, s in enumerate(case.symbols)]
    lines += [f"const double {s} = {sp.ccode(e)};" for s, e in temporaries]
    lines += [f"out[{k}] = {sp.ccode(e)};" for k, e in enumerate(results)]
    body = "\n    ".join(lines)
    return (
        "#include <math.h>\n__attribute__((noinline)) "
        f"void evaluate(const double *in, double *out)\n{{\n    {body}\n}}\n"
    )


def casadi_names() -> dict[str, Any]:
    import casadi as ca

    return {
        **{n: getattr(ca, n) for n in ("sin", "cos", "atan2", "sqrt")},
        "abs": ca.fabs,
        "nonnegative": lambda x: ca.if_else(x >= 0, 1, 0),
    }


def casadi(case: Case) -> str:
    import casadi as ca

    x = ca.SX.sym("x", len(case.symbols))
    values = case.translate(casadi_names())(*ca.vertsplit(x))
    function = ca.Function("peer", [x], [ca.vertcat(*values)], {"cse": True})
    with tempfile.TemporaryDirectory() as folder:
        generator = ca.CodeGenerator("peer.c")
        generator.add(function)
        generator.generate(folder + "/")
        code = Path(folder, "peer.c").read_text()
    return (
        code + "\n__attribute__((noinline)) void evaluate(const double *in, double *out)\n"
        "{ const double *arg[] = { in }; double *res[] = { out }; peer(arg, res, 0, 0, 0); }\n"
    )


def symforce(case: Case) -> str:
    logging.disable(logging.WARNING)
    sf = importlib.import_module("symforce.symbolic")
    codegen = importlib.import_module("symforce.codegen")
    values_type = importlib.import_module("symforce.values").Values

    names = {
        "sin": sf.sin,
        "cos": sf.cos,
        "sqrt": sf.sqrt,
        "abs": sf.Abs,
        "atan2": lambda y, x: sf.atan2(y, x, epsilon=0),
        "nonnegative": lambda x: (1 + sf.sign_no_zero(x)) / 2,
    }
    x = sf.Matrix([sf.Symbol(f"x{k}") for k in range(len(case.symbols))])
    out = sf.Matrix(case.translate(names)(*x))
    generator = codegen.Codegen(
        inputs=values_type(x=x),
        outputs=values_type(out=out),
        config=codegen.CppConfig(),
        name="peer",
    )
    with tempfile.TemporaryDirectory() as folder:
        paths = generator.generate_function(output_dir=folder, skip_directory_nesting=True)
        code = Path(paths.function_dir, "peer.h").read_text()
    n, m = len(case.symbols), case.width
    return code.replace("#pragma once", "#include <cmath>") + (
        '\nextern "C" __attribute__((noinline)) void evaluate(const double *in, double *out)\n{\n'
        f"    const Eigen::Matrix<double, {n}, 1> x(in);\n"
        f"    Eigen::Matrix<double, {m}, 1> y;\n    sym::Peer<double>(x, &y);\n"
        f"    for (int i = 0; i < {m}; ++i) out[i] = y[i];\n}}\n"
    )


def wrenfold(case: Case) -> str:
    from wrenfold import code_generation, sym, type_annotations

    names = {n: getattr(sym, n) for n in ("sin", "cos", "atan2", "sqrt", "abs")}
    names["nonnegative"] = lambda x: sym.where(x >= 0, 1, 0)
    translated = case.translate(names)

    def peer(**arguments):
        values = translated(*arguments.values())
        return [code_generation.OutputArg(e, name=f"out{k}") for k, e in enumerate(values)]

    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
    scalar = type_annotations.FloatScalar
    symbols = [f"x{k}" for k in range(len(case.symbols))]
    peer.__annotations__ = dict.fromkeys(symbols, scalar)
    peer.__signature__ = inspect.Signature(
        [inspect.Parameter(s, kind, annotation=scalar) for s in symbols]
    )
    code = code_generation.generate_function(peer, code_generation.CppGenerator())
    arguments = [f"in[{k}]" for k in range(len(symbols))]
    arguments += [f"out[{k}]" for k in range(case.width)]
    return (
        f"#include <cmath>\n#include <cstdint>\n{code}\n"
        'extern "C" __attribute__((noinline)) void evaluate(const double *in, double *out)\n'
        f"{{ peer<double>({', '.join(arguments)}); }}\n"
    )


SOURCES: dict[str, tuple[Callable[[Case], str], str]] = {
    "closedform": (ours, "c"),
    "limit": (limit, "c"),
    "sympy.cse": (sympy_c, "c"),
    "casadi": (casadi, "c"),
    "symforce": (symforce, "c++"),
    "wrenfold": (wrenfold, "c++"),
}


def build(name: str, case: Case, target: str, folder: Path) -> ctypes.CDLL:
    """The library of one competitor, compiled for ``target``."""
    printer, language = SOURCES[name]
    suffix, compiler = ("c", ["gcc", "-std=gnu99"]) if language == "c" else ("cc", ["g++"])
    stem = folder / f"{name.replace('.', '_')}_{case.full}_{target}"
    loop = folder / f"loop.{suffix}"
    loop.write_text(LOOP)
    return compiled(compiler, stem.with_suffix(f".{suffix}"), printer(case), target, loop)


def compiled(
    compiler: list[str], source: Path, code: str, target: str, *others: Path
) -> ctypes.CDLL:
    source.write_text(code)
    library = source.with_suffix(".so")
    command = [*compiler, *FLAGS, *LIBRARY, f"-march={target}", f"-I{GENERATED}"]
    command += ["-I/usr/include/eigen3", "-o", str(library), str(source), *map(str, others), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        told = done.stderr.strip().splitlines()
        raise RuntimeError(next((line for line in told if "error:" in line), told[0]))
    return ctypes.CDLL(str(library))


def running(library: ctypes.CDLL) -> Callable[..., float]:
    """The loop of a library, which returns nanoseconds per call."""
    run = library.run
    run.restype = ctypes.c_double
    pointer = np.ctypeslib.ndpointer(np.float64, flags="C")
    run.argtypes = [pointer, pointer, *[ctypes.c_int] * 4]
    return run


def timer(
    name: str, case: Case, target: str, folder: Path, inputs: np.ndarray
) -> tuple[Callable[[], float], np.ndarray]:
    """A function that returns nanoseconds per call, and the values of one pass."""
    run = running(build(name, case, target, folder))
    rows = np.hstack([inputs, np.tile(list(case.parameters.values()), (len(inputs), 1))])
    width = case.width
    out = np.full((len(inputs), width + 8), np.nan)
    run(rows, out, rows.shape[1], out.shape[1], len(rows), 1)
    values = out[:, :width].copy()
    return lambda: run(rows, out, rows.shape[1], out.shape[1], len(rows), 20), values
