"""``python -m benchmarks.accuracy``: the worst error of sincos and atan2 of the shared C header.

``accuracy.c`` draws bit patterns with uniform exponents: half of them over all finite numbers, and
half over the exponents for which the answer is neither the argument nor a constant. It compares
both float types, with fused and with separate multiply-adds, with the libm of the next wider type.
Sine and cosine of a float are compared for every finite bit pattern. The worst arguments are then
evaluated again in Arb balls, so the printed figures are upper bounds of the errors there. They are
in units in the last place (the spacing of the type in the binade of the exact value).
"""

from __future__ import annotations

import argparse
import math
import platform
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from flint import arb, ctx

HERE = Path(__file__).parent
SOURCE = HERE / "accuracy.c"
HEADER = HERE.parent / "generated" / "c"
FLAGS = ["-std=c99", "-O3", "-fno-math-errno", "-fno-trapping-math"]
CPU = Path("/proc/cpuinfo")
FMA = (
    ["-mavx2", "-mfma"]
    if platform.machine() == "x86_64" and CPU.exists() and " fma " in CPU.read_text()
    else []
)
BUILDS = {"fused": [*FMA, "-ffp-contract=fast"], "separate": ["-ffp-contract=off"]}
TYPES = {"double": ("<Q", "<d", 52, -1022), "float": ("<I", "<f", 23, -126)}

# With this many samples, trying every float takes no longer than drawing samples.
EXHAUSTIVE = 10**9

# The reduction of the largest double cancels 1,077 bits of pi/2.
ctx.prec = 1400


def build(real: str, folder: Path) -> Path:
    """The program for ``double`` or ``float``, which contains both builds of the header."""
    program = folder / f"accuracy_{real}"
    flags = [*FLAGS, f"-I{HEADER}", *(["-DCLOSEDFORM_FLOAT"] if real == "float" else [])]
    parts = []
    for name, extra in BUILDS.items():
        parts.append(folder / f"{real}_{name}.o")
        tested = [*extra, f"-DEVALUATE={name}", "-c", str(SOURCE), "-o", str(parts[-1])]
        subprocess.run(["gcc", *flags, *tested], check=True)
    command = [*flags, str(SOURCE), *map(str, parts), "-o", str(program), "-lm"]
    subprocess.run(["gcc", *command], check=True)
    return program


def decoded(word: str, real: str) -> float:
    bits, kind, _, _ = TYPES[real]
    return float(struct.unpack(kind, struct.pack(bits, int(word, 16)))[0])


def exact(output: str, x: float, y: float) -> arb:
    if output == "atan2":
        return arb.atan2(arb(y), arb(x))
    return arb(x).sin() if output == "sin" else arb(x).cos()


def ulps(got: float, value: arb, real: str) -> float:
    """An upper bound of the error, in units of the spacing at the ball's end nearer to 0."""
    _, _, mantissa, lowest = TYPES[real]
    size = value.abs_lower()
    exponent = math.frexp(float(size))[1] - 1 if float(size) else lowest
    if arb(2) ** exponent > size:  # the conversion to float rounded up to a power of two
        exponent -= 1
    unit = arb(2) ** (max(exponent, lowest) - mantissa)
    error = abs(arb(got) - value) / unit
    return float(error.abs_upper()) if error.is_finite() else float("inf")


def recheck(lines: list[str], real: str) -> tuple[dict[tuple[str, str], tuple[float, str]], float]:
    """The worst bound of each output and build, its argument, and the gap to libm's estimate."""
    worst: dict[tuple[str, str], tuple[float, str]] = {}
    gap = 0.0
    for line in lines:
        output, name, estimate, *words = line.split()
        x, y, got = (decoded(word, real) for word in words)
        bound = ulps(got, exact(output, x, y), real)
        gap = max(gap, abs(bound - float(estimate)))
        where = f"({y!r}, {x!r})" if output == "atan2" else repr(x)
        worst[output, name] = max(worst.get((output, name), (0.0, "")), (bound, where))
    return worst, gap


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.accuracy", description=__doc__)
    parser.add_argument("--samples", type=int, default=10**9, help="for each function and type")
    parser.add_argument("--keep", type=int, default=1000, help="worst arguments to evaluate in Arb")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    print("| type | function | arithmetic | arguments | worst, ulp | at |")
    print("|---|---|---|---:|---:|---|")
    limit, differences = 0.0, 0.0
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        for real in TYPES:
            program = build(real, Path(folder))
            every = real == "float" and arguments.samples >= EXHAUSTIVE
            for function in ("all" if every else "sincos", "atan2"):
                count = 2 * 255 * 2**23 if function == "all" else arguments.samples
                command = [program, function, count, arguments.seed, arguments.keep]
                done = subprocess.run(
                    [*map(str, command)], capture_output=True, text=True, check=True
                )
                worst, gap = recheck(done.stdout.splitlines(), real)
                differences = max(differences, gap)
                for (output, name), (bound, where) in worst.items():
                    limit = max(limit, bound)
                    print(
                        f"| {real} | {output} | {name} | {count:,} | {bound:.4f} | {where} |",
                        flush=True,
                    )
    seconds = time.monotonic() - start
    print(f"\nAt the worst {arguments.keep} arguments of each function, the estimate of libm is")
    print(f"within {differences:.2g} ulp of the bound in ball arithmetic. {seconds:.0f} s.")
    return 0 if limit < 2 else 1


if __name__ == "__main__":
    sys.exit(main())
