"""A batch on several threads: the same bits, the same errors, no thread left behind."""

from __future__ import annotations

import inspect
import os
import shutil
import subprocess
import sys
import threading
import time
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from extension_toy.build import SANITIZED, function
from extension_toy.toy import chain, values
from given import beside
from places import ROOT, TESTS

ROBOTS = sorted(
    path.stem for path in (ROOT / "generated" / "c").glob("*.py") if not path.stem.startswith("_")
)
SIZES = (1, 3, 4, 31, 32, 33, 63, 65, 127, 129, 511, 513, 1025, 4099)


def outputs(result: Any) -> tuple[np.ndarray, ...]:
    return result if isinstance(result, tuple) else (result,)


def same_bits(a: Any, b: Any) -> bool:
    pairs = zip(outputs(a), outputs(b), strict=True)
    return all(np.asarray(x).tobytes() == np.asarray(y).tobytes() for x, y in pairs)


@pytest.mark.parametrize("planes", [False, True])
@pytest.mark.parametrize("size", [*SIZES, 140_001])
def test_values(native: Any, size: int, planes: bool) -> None:
    q = values(np.random.default_rng(size), (size, 6))
    given = np.asfortranarray(q) if planes else q
    for n in (1, 2, 3, 7, None):
        assert np.array_equal(function(native, "chain")(given, threads=n), chain(q))


def test_parameters_that_vary(native: Any) -> None:
    """Threads divide the outer axis too, also when each posture has parameters of its own."""
    rng = np.random.default_rng(0)
    f = function(native, "polar")
    for shape, lengths in [((7, 300, 2), (7, 1)), ((501, 2), (501,)), ((3, 1000, 2), (1, 1))]:
        q, l1, l2 = values(rng, shape), values(rng, lengths), values(rng, lengths)
        one = f(q, (l1, l2), threads=1)
        for n in (2, 3, 7, 2**70):
            assert same_bits(f(q, (l1, l2), threads=n), one)


def test_out(native: Any) -> None:
    q = values(np.random.default_rng(1), (5000, 6))
    wide = np.zeros((5000, 2, *chain(q).shape[1:]))
    out = wide[:, 0]
    assert function(native, "chain")(q, out=out, threads=3) is out
    assert np.array_equal(out, chain(q))
    assert not wide[:, 1].any()


@pytest.mark.parametrize("wrong", [0, -1, -(2**70)])
def test_too_few(native: Any, wrong: int) -> None:
    for q in (np.zeros(6), np.zeros((9, 6))):
        with pytest.raises(ValueError, match=r"threads is -?[0-9]+, expected at least 1"):
            function(native, "chain")(q, threads=wrong)


@pytest.mark.parametrize("wrong", [True, False, 2.0, "2", np.array([1, 2]), np.True_])
def test_no_integer(native: Any, wrong: Any) -> None:
    with pytest.raises(TypeError):
        function(native, "chain")(np.zeros((9, 6)), threads=wrong)


def test_several_callers(native: Any) -> None:
    f, right = function(native, "chain"), []

    def work(seed: int) -> None:
        q = values(np.random.default_rng(seed), (3000, 6))
        expected = chain(q)
        right.append(all(np.array_equal(f(q, threads=3), expected) for _ in range(20)))

    callers = [threading.Thread(target=work, args=(seed,)) for seed in range(4)]
    for caller in callers:
        caller.start()
    for caller in callers:
        caller.join()
    assert right == [True] * 4


@pytest.mark.skipif(not os.path.isdir("/proc/self/task"), reason="needs /proc")
def test_no_thread_stays(native: Any) -> None:
    before = len(os.listdir("/proc/self/task"))
    function(native, "chain")(np.zeros((100_000, 6)), threads=7)
    for _ in range(500):  # the list still holds a thread for a moment after it has been joined
        if len(os.listdir("/proc/self/task")) <= before:
            return
        time.sleep(0.01)
    pytest.fail("threads are left")


RACE = """
#include <pthread.h>
static int shared;
static void *add(void *unused) { for (int i = 0; i < 1000; ++i) ++shared; return unused; }
void race(void)
{
    pthread_t a, b;
    pthread_create(&a, 0, add, 0);
    pthread_create(&b, 0, add, 0);
    pthread_join(a, 0);
    pthread_join(b, 0);
}
"""


def sanitizer() -> dict[str, str]:
    """The environment in which ThreadSanitizer watches Python; skips where there is none."""
    gcc = shutil.which("gcc")
    if gcc is None or sys.platform != "linux":
        pytest.skip("needs gcc on Linux")
    asked = [gcc, "-print-file-name=libtsan.so"]
    library = subprocess.run(asked, capture_output=True, text=True).stdout.strip()
    if not os.path.isabs(library):
        pytest.skip("gcc has no ThreadSanitizer")
    environment = {"LD_PRELOAD": library, "TSAN_OPTIONS": "exitcode=66", "CC": gcc}
    outside = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST_")}
    found = {**outside, **environment, "CLOSEDFORM_TEST_SANITIZE": "thread"}
    started = subprocess.run([sys.executable, "-c", "print(1)"], env=found, capture_output=True)
    if started.returncode:
        pytest.skip("ThreadSanitizer does not run here")
    return found


@pytest.mark.skipif(bool(SANITIZED), reason="is the sanitized run")
def test_under_thread_sanitizer(tmp_path: Path) -> None:
    """No two threads touch a place at once, neither those of a batch nor several callers."""
    environment = sanitizer()
    (tmp_path / "race.c").write_text(RACE)
    race = tmp_path / "race.so"
    build = [environment["CC"], "-O1", "-fPIC", "-shared", "-fsanitize=thread", "-pthread"]
    subprocess.run([*build, str(tmp_path / "race.c"), "-o", str(race)], check=True)
    racing = f"import ctypes; ctypes.CDLL({str(race)!r}).race()"
    pytest_here = ["-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist", __file__]
    runs = {
        "a race": (["-c", racing], 66),
        "batches": ([*pytest_here, "-k", "not every_mechanism"], 0),
        "callers": ([str(TESTS / "portability" / "threads.py"), str(tmp_path)], 0),
    }
    for name, (arguments, expected) in runs.items():
        run = subprocess.run(
            [sys.executable, *arguments], env=environment, cwd=TESTS, capture_output=True, text=True
        )
        said = run.stdout[-3000:] + run.stderr[-3000:]
        assert run.returncode == expected, f"{name}: {said}"
        assert ("data race" in run.stderr) == (name == "a race"), f"{name}: {said}"


@pytest.mark.skipif(bool(SANITIZED), reason="the toy is what is sanitized")
@pytest.mark.parametrize("robot", ROBOTS)
def test_every_mechanism(robot: str) -> None:
    module = import_module(f"closedform.generated.c.{robot}")
    rng = np.random.default_rng(0)
    for name in filter(str.islower, module.__all__):
        f = getattr(module, name)
        needed = [p for p in inspect.signature(f).parameters.values() if p.default is p.empty]
        if [p.name for p in needed] != ["q"]:
            continue
        for size in SIZES:
            q = rng.uniform(-3, 3, (size, len(module.JOINTS)))
            for given in (q, np.asfortranarray(q)):
                one = f(given, threads=1)
                assert all(same_bits(f(given, threads=n), one) for n in (2, 3, 7, None))
    q = rng.uniform(-3, 3, (1025, len(module.JOINTS)))
    if hasattr(module, "fk"):
        x = outputs(module.fk(q))[0]
        x = x[:, 0] if module.ASSEMBLY_MODES else x
    else:
        x = rng.uniform(-0.5, 0.5, (1025, len(module.TASK)))
    more = beside(module, q)
    one = module.ik(x, *more, threads=1)
    assert all(same_bits(module.ik(x, *more, threads=n), one) for n in (2, 3, 7))
