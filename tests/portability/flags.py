"""Every combination of flags gives right values or is refused by the header."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .cases import cases, mismatches
from .driver import RefusedError, compile_driver

RELEASE = ("-O3", "-fno-math-errno", "-fno-trapping-math", "-ffp-contract=fast")
REASSOCIATING = ("-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math")
FLAGS: dict[str, tuple[str, ...]] = {
    "O0": ("-O0",),
    "O2": ("-O2",),
    "release": RELEASE,
    "native": (*RELEASE, "-march=native"),
    "no fma": (*RELEASE, "-mno-fma"),
    "no contraction": ("-O3", "-ffp-contract=off"),
    "rounding": ("-O2", "-frounding-math"),
    "lto": ("-O2", "-flto"),
    "unsafe": ("-O2", "-funsafe-math-optimizations"),
    "associative": ("-O2", *REASSOCIATING),
    "reciprocal": ("-O2", "-freciprocal-math"),
    "fast": ("-O2", "-ffast-math"),
    "Ofast": ("-Ofast",),
    "unsafe release": (*RELEASE, "-funsafe-math-optimizations"),
    "x87": ("-O2", "-m32", "-mno-sse", "-mfpmath=387"),
    "32 bits": ("-O2", "-m32"),
    "32 bits, SSE": ("-O2", "-m32", "-msse2", "-mfpmath=sse"),
}


def outcome(
    folder: Path, compiler: str, flags: Sequence[str], robots: Sequence[str], *, single: bool
) -> str:
    """``right``, ``refused``, or what is wrong."""
    try:
        program = compile_driver(folder, [compiler, "-std=c99", *flags], robots, single=single)
    except RefusedError:
        return "refused"
    wrong = list(mismatches(program, cases(robots, single=single), single=single))
    return "right" if not wrong else f"wrong: {wrong[0]}"
