"""Every batch function of the generated C becomes vector code, and agrees with its single call."""

import ctypes
import platform
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

C = Path(__file__).resolve().parent.parent / "generated" / "c"
ROBOTS = sorted(path.stem for path in C.glob("*.c") if path.stem != "extension")
FLAGS = ["-std=c99", "-O3", "-fno-math-errno", "-fno-trapping-math", "-fPIC", "-shared"]
TYPES = {"double": (np.float64, []), "float": (np.float32, ["-DCLOSEDFORM_FLOAT"])}
POSTURES = 300  # more than a block, and a remainder that is no whole vector


def version_of_gcc() -> int:
    told = subprocess.run(["gcc", "--version"], capture_output=True, text=True).stdout
    number = re.search(r"^gcc.* (\d+)\.\d+\.\d+", told)
    return int(number[1]) if number else 0


pytestmark = pytest.mark.skipif(
    platform.machine() != "x86_64" or not shutil.which("gcc") or version_of_gcc() < 12,
    reason="gcc 12 for x86-64 is what the loops are written for",
)


def compile_robot(robot: str, target: Path, *flags: str) -> str:
    command = ["gcc", *FLAGS, *flags, str(C / f"{robot}.c"), "-o", str(target), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stderr


def batch_loops(source: str) -> dict[int, str]:
    """The loops over the postures of a block: their lines, and the functions they stand in."""
    loops, function = {}, ""
    for number, line in enumerate(source.splitlines(), 1):
        if definition := re.match(r"(?:CF_INLINE )?void (\w+)\(", line):
            function = definition[1]
        if re.search(r"\bfor \(size_t i = 0; i < m;", line):
            loops[number] = function
    return loops


@pytest.mark.parametrize("real", TYPES)
@pytest.mark.parametrize("cpu", ["x86-64-v3", "x86-64-v4"])
@pytest.mark.parametrize("robot", ROBOTS)
def test_every_batch_loop_becomes_vectors(robot, cpu, real, tmp_path):
    options = [f"-march={cpu}", "-ffp-contract=fast", "-fopt-info-loop-vec-optimized"]
    told = compile_robot(robot, tmp_path / "robot.so", *options, *TYPES[real][1])
    # A plane that is a copy of another becomes a call of memcpy.
    done = r"loop vectorized using|split to 0 loops and 1 library calls"
    vector = {int(n) for n in re.findall(rf"/{robot}\.c:(\d+):\d+: optimized:.*(?:{done})", told)}
    source = (C / f"{robot}.c").read_text()
    loops = batch_loops(source)
    batches = set(re.findall(r"^void (\w+_batch)\(", source, re.MULTILINE))
    assert batches and set(loops.values()) == batches
    assert {loops[line] for line in loops.keys() - vector} == set()


def parameters(arguments: str) -> list[tuple[str, bool, int]]:
    """Type, whether it is an input, and number of entries of every array of a single call."""
    found = re.findall(r"(const )?(real_t|uint8_t) \w+\[(\d+)\]", arguments)
    return [(kind, bool(const), int(size)) for const, kind, size in found]


@pytest.mark.parametrize("real", TYPES)
@pytest.mark.parametrize("robot", ROBOTS)
def test_batch_and_single_call_agree(robot, real, tmp_path):
    dtype, flags = TYPES[real]
    target = tmp_path / "robot.so"
    compile_robot(robot, target, "-DCLOSEDFORM_DISPATCH", "-ffp-contract=fast", *flags)
    library = ctypes.CDLL(str(target))
    header = " ".join((C / f"{robot}.h").read_text().split())
    fields = len(re.findall(r"real_t \w+; /\*", header))
    params = np.linspace(3, 2, fields).astype(dtype)
    random = np.random.default_rng(0)

    def pointer(array):
        return ctypes.c_void_p(array.ctypes.data)

    for name, arguments in re.findall(rf"void ({robot}_\w+)\(([^()]*)\);", header):
        if name.endswith("_batch"):
            continue
        arrays, strided = [], [ctypes.c_size_t(POSTURES), pointer(params)]
        for kind, is_input, size in parameters(arguments):
            plane = np.zeros((size, POSTURES), dtype if kind == "real_t" else np.uint8)
            if is_input:
                plane[:] = random.uniform(-3, 3, plane.shape)
                plane[:, ::50] = 0
                plane[0, ::70] = np.nan
            arrays.append((plane, is_input))
            strided += [pointer(plane), ctypes.c_size_t(POSTURES)]
        getattr(library, f"{name}_batch")(*strided)
        one = getattr(library, name)
        for i in range(POSTURES):
            columns = [np.ascontiguousarray(plane[:, i]) for plane, _ in arrays]
            results = [
                c if is_input else np.zeros_like(c)
                for c, (_, is_input) in zip(columns, arrays, strict=True)
            ]
            one(pointer(params), *map(pointer, results))
            for single, batch in zip(results, columns, strict=True):
                if single.dtype == np.uint8:
                    np.testing.assert_array_equal(single, batch, name)
                else:
                    eps = 16 * np.finfo(dtype).eps
                    np.testing.assert_allclose(single, batch, rtol=eps, atol=4 * eps, err_msg=name)
