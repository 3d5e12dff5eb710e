"""One call in C raises no floating-point exception that a controller may trap."""

import ctypes
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from chains import arm, solved
from proposals import forward
from sympy import pi

from closedform.check.clibrary import CLibrary, compiler
from closedform.check.failures import UnavailableError
from closedform.emit.backend import Mechanism
from closedform.emit.backends import c
from closedform.pipeline.run import write
from closedform.proof.prove import Proof
from closedform.scaffold.chains.propose import propose

TRAPPED = 0x1 | 0x4 | 0x8
"""INVALID, DIVBYZERO and OVERFLOW, on x86."""
ROWS = [(1, pi / 2, 1), (1, -pi / 2, 1), (1, pi / 2, 1), (1, 0, 1), (1, 0, 1), (1, 0, 1)]
"""Three skew axes, and three parallel ones: an equation of degree four."""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="asks the C library of Linux")
def test_targets_within_and_out_of_reach_raise_nothing(tmp_path: Path) -> None:
    try:
        compiler()
    except UnavailableError as error:
        pytest.skip(str(error))
    d, serial = arm(ROWS)
    solved(d, serial, propose(serial).source)
    serial.export(d)
    pages = c.BACKEND.pages(Mechanism(d, Proof(d.name, "own", (), 0, ()))).files
    write(tmp_path, {**pages, **c.BACKEND.shared([])})
    library = CLibrary(d, tmp_path / "c", tmp_path)
    T = forward(ROWS, np.random.default_rng(2).uniform(-np.pi, np.pi, (3000, 6)))
    T[::3, :3, 3] *= 2
    assert not [k for k, target in enumerate(T) if raised(library, target)]


def raised(library: CLibrary, T: np.ndarray) -> int:
    flags: Any = ctypes.CDLL("libm.so.6")
    T, answers, status = np.ascontiguousarray(T), np.empty((8, 6)), np.empty(8, np.uint8)
    places = [ctypes.c_void_p(a.ctypes.data) for a in (T, answers, status)]
    flags.feclearexcept(0x3F)
    library.compiled.arm_ik(ctypes.byref(ctypes.c_double()), *places)
    return int(flags.fetestexcept(TRAPPED))
