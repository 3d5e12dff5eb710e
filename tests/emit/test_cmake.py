"""The generated CMake project is built and installed, and a consumer finds and uses it."""

import shutil
import subprocess
from pathlib import Path

import pytest
from places import TESTS
from sharing import remembering

from closedform.pipeline.folders import generated

CONSUMER = TESTS / "consumer"

pytestmark = pytest.mark.skipif(
    shutil.which("cmake") is None, reason="cmake is not installed: the CMake project is not tried"
)


def run(*command: str | Path) -> str:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def build(source: Path, folder: Path, *options: str) -> None:
    # Neither optimised nor with the lines of the sources, to save time; make check tries the flags
    # of a release.
    launcher = remembering(folder.with_suffix(".sh"))
    options = (*options, f"-DCMAKE_C_COMPILER_LAUNCHER={launcher}", "-DCMAKE_C_FLAGS_DEBUG=-O0")
    run("cmake", "-S", source, "-B", folder, "-DCMAKE_BUILD_TYPE=Debug", *options)
    run("cmake", "--build", folder, "--parallel", "2")


@pytest.mark.parametrize(
    ("real", "shared", "size", "tolerance"),
    [("double", "OFF", 8, 1e-6), ("float", "ON", 4, 1e-4)],
)
def test_a_consumer_finds_and_uses_the_library(
    tmp_path: Path, real: str, shared: str, size: int, tolerance: float
) -> None:
    library, prefix, consumer = tmp_path / "library", tmp_path / "prefix", tmp_path / "consumer"
    use_float = "ON" if real == "float" else "OFF"
    build(
        generated() / "c",
        library,
        f"-DCLOSEDFORM_FLOAT={use_float}",
        f"-DBUILD_SHARED_LIBS={shared}",
        f"-DCMAKE_INSTALL_PREFIX={prefix}",
    )
    run("cmake", "--install", library)
    build(CONSUMER, consumer, f"-DCMAKE_PREFIX_PATH={prefix}")
    lines = run(consumer / "consumer").splitlines()
    assert lines[0] == f"real_t has {size} bytes"
    assert [float(word) for word in lines[1].split()[1:]] == pytest.approx(
        [15.127019, -2.783647], abs=10 * tolerance
    )
    angles = [[float(word) for word in line.split()[-2:]] for line in lines[2:]]
    assert angles == [
        pytest.approx([-0.663965, 1.1], abs=tolerance),
        pytest.approx([0.3, -1.1], abs=tolerance),
    ]


def test_the_library_does_not_contain_the_binding_to_python(tmp_path: Path) -> None:
    text = (generated() / "c" / "CMakeLists.txt").read_text("utf-8")
    assert "extension.c" not in text
    headers = {path.name for path in (generated() / "c").glob("*.h")}
    assert all(header in text for header in headers)
