"""Compiler flags: with each of them the generated C gives right values or does not compile."""

import shutil
import subprocess
from pathlib import Path

import pytest
from portability.flags import FLAGS, outcome

COMPILERS = [name for name in ("gcc", "clang") if shutil.which(name)]
REFUSED = {"fast", "Ofast", "x87"}  # by whatever compiler
RIGHT = {"O0", "O2", "release", "native", "no fma", "no contraction", "rounding", "32 bits, SSE"}
IN_FLOAT = ("release", "unsafe", "associative", "32 bits", "32 bits, SSE")
TRIED = [
    (compiler, flags, single)
    for compiler in COMPILERS
    for flags in FLAGS
    for single in (False, True)
    if not single or flags in IN_FLOAT
]

pytestmark = pytest.mark.skipif(not COMPILERS, reason="there is neither gcc nor clang")


@pytest.mark.parametrize(("compiler", "flags", "single"), TRIED)
def test_values_are_right_or_refused(
    tmp_path: Path, compiler: str, flags: str, single: bool
) -> None:
    probe = [compiler, *FLAGS[flags], "-x", "c", "-", "-o", str(tmp_path / "probe"), "-lm"]
    source = b"#include <math.h>\nint main(int n, char **v) { return v[n] ? (int)sin(n) : 0; }"
    if subprocess.run(probe, input=source, capture_output=True).returncode:
        pytest.skip(f"{compiler} does not build for {' '.join(FLAGS[flags])} here")
    found = outcome(tmp_path, compiler, FLAGS[flags], ["planar_2r"], single=single)
    allowed = {"refused"} if flags in REFUSED else {"right", "refused"}
    assert found in ({"right"} if flags in RIGHT else allowed)
