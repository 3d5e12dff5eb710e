"""Calls the toy extension from several threads on shared parameters and outputs.

    python tests/portability/threads.py FOLDER

It is compiled for the interpreter that runs this, into the folder.  Only NumPy is needed.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2]))  # the project, which is not installed
sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from extension_toy.build import compile_toy, function, loaded
from extension_toy.toy import chain, polar, values

THREADS, ROUNDS, POSTURES = 4, 200, 300


def gil() -> bool:
    """Whether this interpreter has a GIL now."""
    return bool(getattr(sys, "_is_gil_enabled", lambda: True)())


def at_once(work: Callable[[int], None]) -> None:
    """Run the work in all threads, which start together."""
    barrier = threading.Barrier(THREADS)
    failures: list[BaseException] = []

    def run(k: int) -> None:
        barrier.wait()
        try:
            work(k)
        except BaseException as error:
            failures.append(error)

    threads = [threading.Thread(target=run, args=(k,)) for k in range(THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if failures:
        raise failures[0]


def shared_arrays(native: Any) -> None:
    """All threads read the same inputs and write to parts of the same output."""
    f = function(native, "chain")
    q = values(np.random.default_rng(0), (POSTURES, 6))
    right = chain(q)
    out = np.empty((THREADS, *right.shape))

    def work(k: int) -> None:
        for row in range(ROUNDS):
            out[k] = np.nan
            assert f(q, out=out[k]) is not None
            np.testing.assert_array_equal(out[k], right)
            one = row % POSTURES
            f(q[one], out=out[k, one])
            np.testing.assert_array_equal(f(q[one]), right[one])

    at_once(work)


def shared_parameters(native: Any) -> None:
    """All threads use one tuple of parameters, numbers and arrays."""
    f = function(native, "polar")
    rng = np.random.default_rng(1)
    q, params = values(rng, (POSTURES, 2)), (1.5, values(rng, (POSTURES,)))
    right = polar(q, *params)

    def work(_k: int) -> None:
        for _ in range(ROUNDS):
            np.testing.assert_allclose(f(q, params), right, rtol=1e-14)
            np.testing.assert_allclose(f(q[:1], list(params))[0], right[0], rtol=1e-14)

    at_once(work)


def changing_lists(native: Any) -> None:
    """One thread changes a list that the others pass; they see it before or after a change."""
    f = function(native, "chain")
    numbers = [float(k) for k in range(6)]
    right = chain(np.array(numbers))

    def work(k: int) -> None:
        for row in range(ROUNDS * 20):
            if k == 0:
                numbers.append(float(row))
                numbers.pop()
                numbers[:] = [*range(6)]
                continue
            try:
                got = f(numbers)
            except ValueError as error:
                assert "shape" in str(error)
            else:
                np.testing.assert_array_equal(got, right)

    at_once(work)


def making_functions(native: Any) -> None:
    """Functions are made, used, given attributes and dropped in all threads at once."""
    q = np.zeros(6)

    def work(k: int) -> None:
        for row in range(ROUNDS):
            f = function(native, "chain")
            f.mark = row
            assert f.mark == row
            f(q)
            assert native.names

    at_once(work)


def main() -> int:
    folder = Path(sys.argv[1])
    compile_toy(folder)
    before = gil()
    native = loaded(folder)
    if gil() != before:
        print("the import of the extension has switched the GIL on")
        return 1
    for attempt in (shared_arrays, shared_parameters, changing_lists, making_functions):
        attempt(native)
    print(f"NumPy {np.__version__}, {'with' if gil() else 'without'} a GIL")
    return 0


if __name__ == "__main__":
    sys.exit(main())
