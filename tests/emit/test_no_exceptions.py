"""One call in C raises no floating-point exception that a controller may trap.

The targets are within reach, near right angles, and out of reach: there the common case of an
inverse divides by what vanishes, unless a condition that it already knows says so.
"""

import ctypes
import importlib
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from chains import arm, compiled, solved
from proposals import forward
from sympy import pi

from closedform.check.clibrary import CLibrary
from closedform.scaffold.chains.propose import propose

TRAPPED = 0x1 | 0x4 | 0x8
"""INVALID, DIVBYZERO and OVERFLOW, on x86."""
K, J = sp.symbols("k j", real=True)
ARMS: dict[str, tuple[list, dict[str, str]]] = {
    "three skew axes": ([(1, pi / 2, 1), (1, -pi / 2, 1), (1, pi / 2, 1), (1, 0, 1), (1, 0, 1),
                         (1, 0, 1)], {}),
    "a wrist with twists": ([(1, pi / 2, 1), (2, 0, 0), (1, pi / 2, 0), (0, K, 1), (0, J, 0),
                             (0, 0, 1)], {"k": "1", "j": "1"}),
}  # fmt: skip
linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="asks the C of Linux")


def hostile(joints: int, count: int) -> np.ndarray:
    """Joints of which most are near or at multiples of a quarter turn."""
    rng = np.random.default_rng(2)
    q = rng.uniform(-np.pi, np.pi, (count, joints))
    near = np.concatenate([[0], 10.0 ** np.arange(-12, -2)])
    turns = rng.integers(-2, 3, q.shape) * np.pi / 2 + rng.choice(near, q.shape)
    return np.where(rng.random(q.shape) < 0.6, turns, q)


@linux
@pytest.mark.parametrize("name", ARMS)
def test_an_arm_from_a_table_raises_nothing(name: str, tmp_path: Path) -> None:
    rows, angles = ARMS[name]
    d, serial = arm(rows, **angles)
    solved(d, serial, propose(serial).source)
    serial.export(d)
    library = compiled(d, tmp_path)
    plain = [[float(sp.sympify(e).subs({K: 1, J: 1})) for e in row] for row in rows]
    T = forward(plain, hostile(6, 3000))
    T[::7, :3, 3] *= 3
    parameters = [float(sp.Rational(v)) for v in angles.values()]
    assert not [k for k, target in enumerate(T) if raised(library, "arm", parameters, target)]


@linux
def test_an_arm_with_a_given_joint_raises_nothing(tmp_path: Path) -> None:
    code = importlib.import_module("closedform.generated.numpy.franka_arm")
    d = importlib.import_module("closedform.derivations.franka_arm").d
    library = compiled(d, tmp_path)
    q, parameters = hostile(7, 6000), [float(p) for p in code.Parameters()]
    given = zip(code.fk(q), q[:, 6:], strict=True)
    assert not [k for k, x in enumerate(given) if raised(library, d.name, parameters, *x)]


def raised(library: CLibrary, name: str, parameters: list[float], *inputs: np.ndarray) -> int:
    """The exceptions of one call of an inverse with eight branches."""
    flags: Any = ctypes.CDLL("libm.so.6")
    fields = (ctypes.c_double * max(1, len(parameters)))(*parameters)
    arrays = [*map(np.ascontiguousarray, inputs), np.empty((8, 7)), np.empty(8, np.uint8)]
    flags.feclearexcept(0x3F)
    places = (ctypes.c_void_p(a.ctypes.data) for a in arrays)
    getattr(library.compiled, f"{name}_ik")(ctypes.byref(fields), *places)
    return int(flags.fetestexcept(TRAPPED))
