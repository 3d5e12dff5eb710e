"""The modules for any array library: the contract, with NumPy and with a library that is strict.

``array_api_strict`` has what the array API standard has, and nothing else.
"""

from __future__ import annotations

import importlib
import inspect
import subprocess
import sys
import warnings
from dataclasses import replace
from types import ModuleType
from typing import Any

import array_api_strict as strict
import numpy as np
import pytest
from closedform.generated.array import hybrid_five_bar, planar_2r, spherical_wrist
from closedform.generated.numpy import planar_2r as reference
from sizes import LENGTHS, lengths
from test_array_gradients import ROBOTS, modules, postures, targets
from test_array_gradients import given as beside

from closedform.emit import sines
from closedform.emit.backends import array as backend
from closedform.model.tolerances import DOUBLE, FLOAT

TOLERANCES = {"DOUBLE": DOUBLE, "FLOAT": FLOAT}
all_robots = pytest.mark.parametrize("robot", ROBOTS)


def functions(module: ModuleType) -> list[str]:
    return [name for name in module.__all__ if name[0].islower()]


def parts(result: Any) -> tuple[Any, ...]:
    return tuple(result) if isinstance(result, tuple) else (result,)


def given(numpy: ModuleType, robot: str, name: str) -> list[np.ndarray]:
    """Arguments of a function: postures, targets, or any numbers of the right shape."""
    known = {"q": postures(robot)[:8], "x": targets(robot)[:8]}
    arrays = []
    for spec in getattr(numpy, f"_{name.upper()}").inputs:
        fits = known.get(spec.name, known["x"])
        if fits.shape[1:] != spec.shape:
            fits = np.random.default_rng(3).uniform(-1, 1, (8, *spec.shape))
        arrays.append(fits)
    return arrays


@all_robots
def test_the_names_are_those_of_numpy(robot: str) -> None:
    array, numpy = modules(robot)
    assert array.__all__ == numpy.__all__
    assert array.Parameters() == tuple(numpy.Parameters())
    assert array.Parameters._fields == numpy.Parameters._fields
    for name in ("JOINTS", "TASK", "BRANCHES", "ASSEMBLY_MODES", "SINGULARITIES", "SKELETON"):
        assert getattr(array, name) == getattr(numpy, name)
    for name in functions(numpy):
        arguments = [*inspect.signature(getattr(numpy, name)).parameters]
        assert [*inspect.signature(getattr(array, name)).parameters, "out"] == arguments
    assert dict(array.Status.__members__) == dict(numpy.Status.__members__)


@all_robots
def test_the_strict_library_goes_in_and_comes_out(robot: str) -> None:
    """With the values of NumPy, of the same type, and on the same device; nothing warns."""
    array, numpy = modules(robot)
    device = strict.Device("device1")
    for name in functions(numpy):
        arguments = given(numpy, robot, name)
        expected = parts(getattr(numpy, name)(*arguments))
        on_device = [strict.asarray(a, device=device) for a in arguments]
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = parts(getattr(array, name)(*on_device))
        for f, e in zip(found, expected, strict=True):
            if arguments:
                assert isinstance(f, type(on_device[0])) and f.device == device
            values = np.asarray(strict.asarray(f, device=strict.Device("CPU_DEVICE")))
            assert values.dtype == e.dtype and values.shape == e.shape
            np.testing.assert_allclose(values, e, rtol=1e-9, atol=1e-9)


@all_robots
def test_statuses_are_those_of_numpy(robot: str) -> None:
    array, numpy = modules(robot)
    inputs = targets(robot), *beside(robot)
    found, expected = array.ik(*inputs), numpy.ik(*inputs)
    np.testing.assert_array_equal(found.status, expected.status)
    np.testing.assert_array_equal(np.isnan(found.q), np.isnan(expected.q))
    assert found.status.dtype == np.uint8


@all_robots
def test_single_precision_stays(robot: str) -> None:
    array, _ = modules(robot)
    q = strict.asarray(postures(robot)[:20], dtype=strict.float32)
    if hasattr(array, "fk"):
        assert parts(array.fk(q))[0].dtype == strict.float32
    inputs = [v[:20] for v in (targets(robot), *beside(robot))]
    found = array.ik(*(strict.asarray(v, dtype=strict.float32) for v in inputs))
    assert found.q.dtype == strict.float32 and found.status.dtype == strict.uint8


@pytest.mark.parametrize("robot", ["planar_2r", "scara", "hybrid_five_bar", "rpr_planar"])
@pytest.mark.parametrize("exponent", [-900, -300, 300, 900])
def test_a_mechanism_of_any_size(robot: str, exponent: int) -> None:
    """Statuses and angles stay, and distances grow as the mechanism does."""
    array, numpy = modules(robot)
    x = targets(robot)[:-4]
    large = x.copy()
    large[:, LENGTHS[robot]["x"]] = np.ldexp(x[:, LENGTHS[robot]["x"]], exponent)
    dimensions = [float(np.ldexp(v, exponent)) for v in numpy.Parameters()]
    found, expected = array.ik(large, dimensions), numpy.ik(x)
    np.testing.assert_array_equal(found.status, expected.status)
    q = found.q.copy()
    scaled = lengths(robot, "q")
    q[..., scaled] = np.ldexp(q[..., scaled], -exponent)
    np.testing.assert_allclose(q, expected.q, rtol=1e-6, atol=1e-6)
    ok = found.status == 0
    there = np.broadcast_to(large[:, None], (*ok.shape, large.shape[-1]))[ok]
    hands = parts(array.fk(found.q[ok], dimensions))[0].reshape(len(there), -1, there.shape[-1])
    missed = np.nanmin(abs(hands - there[:, None]).max(-1) / abs(there).max(), axis=1)
    assert missed.max() < 1e-9


def test_single_precision_of_any_size() -> None:
    """In millimetres the fourth power of a length leaves the range of a float."""
    for unit in (1.0, 1e3, 1e9, 1e-9):
        arm = planar_2r.Parameters(0.4 * unit, 0.3 * unit)
        x = np.array([[0.5, 0.1], [0.1, -0.2], [0.9, 0.0]], np.float32) * np.float32(unit)
        found = planar_2r.ik(x, arm)
        assert found.status.tolist() == [[0, 0], [0, 0], [1, 1]]
        back = planar_2r.fk(found.q[:2], arm)
        assert abs(back - x[:2, None]).max() < FLOAT.forward * 0.7 * unit


def test_a_rod_at_right_angles_to_its_crank() -> None:
    """In single precision too the rod of an OK answer ends at the target."""
    delta = importlib.import_module("closedform.generated.array.delta")
    n, rng = 20_000, np.random.default_rng(1)
    f, L, l = rng.uniform(0.05, 0.5, (3, n))
    parts = [f, np.full(n, 0.04), L, l, *(np.full(n, k * 2.0943951023931953) for k in range(3))]
    lengths = [p.astype(np.float32) for p in parts]
    f, e, L, l = (p.astype(float) for p in lengths[:4])
    aside = l * (1 - 10 ** rng.uniform(-8, -2, n))
    reach = L * (1 + rng.choice([-1, 1], n) * 10 ** rng.uniform(-6, 0, n))
    way = rng.uniform(-np.pi, np.pi, n)
    p = np.stack([f - e + reach * np.cos(way), aside, -reach * np.sin(way)], -1).astype(np.float32)
    found = delta.ik(p, lengths)
    theta = found.q[..., 0].astype(float)
    end = [f[:, None] + L[:, None] * np.cos(theta), 0 * theta, -L[:, None] * np.sin(theta)]
    rod = np.stack(end, -1) - (p + np.stack([e, 0 * e, 0 * e], -1))[:, None]
    missed = abs(np.linalg.norm(rod, axis=-1) - l[:, None]) / (f + e + L + l)[:, None]
    ok = found.status == 0
    assert ok.sum() > n / 2
    assert missed[ok].max() < FLOAT.forward


def test_tolerances_follow_the_type() -> None:
    """Out of reach by half of a millionth is at full stretch in single precision, not in double."""
    x = np.array([18.0 * (1 + 5e-7), 0.0])
    assert planar_2r.ik(x.astype(np.float32)).status.tolist() == [0, 0]
    assert planar_2r.ik(x).status.tolist() == [1, 1]


def test_dimensions_broadcast() -> None:
    l1 = np.array([[1.0], [2.0]])
    q = np.array([[0.1, 0.2], [0.3, 0.4], [0.5, 0.6]])
    np.testing.assert_allclose(planar_2r.fk(q, (l1, 1.0)), reference.fk(q, (l1, 1.0)), rtol=1e-14)
    one = np.stack([[1.0, 2.0, 3.0], [1.0, 1.0, 1.0]])
    np.testing.assert_allclose(planar_2r.fk(q, one), reference.fk(q, one), rtol=1e-14)
    assert planar_2r.workspace_radii((strict.asarray(l1), 1.0)).shape == (2, 1, 2)
    assert planar_2r.fk(np.empty((0, 2))).shape == (0, 2)


def test_numbers_follow_the_arrays_among_them() -> None:
    """Lists may hold arrays; numbers and integers take the type of what they meet."""
    angle = strict.asarray(0.5, dtype=strict.float32)
    found = planar_2r.fk([angle, 1], planar_2r.Parameters(l1=np.float64(2.0)))
    assert found.dtype == strict.float32
    np.testing.assert_allclose(np.asarray(found), reference.fk([0.5, 1], (2.0, 8.0)), rtol=1e-6)
    assert planar_2r.fk([0.5, 1]).dtype == np.float64
    assert planar_2r.fk(np.array([0, 1])).dtype == np.float64
    mixed = planar_2r.fk(np.float32([0, 1]), (np.array(1.0), 2))
    assert mixed.dtype == np.float64


WRONG = {
    "planar_2r.fk: q has shape (3,), expected (..., 2)": (ValueError, (np.zeros(3),)),
    "planar_2r.fk: q has dtype complex128, expected real numbers": (TypeError, (np.zeros(2) + 0j,)),
    "planar_2r.fk: q has dtype <U1, expected real numbers": (TypeError, ("a",)),
    "planar_2r.fk: dtype float16, expected float32 or float64": (TypeError, (np.float16([1, 2]),)),
    "planar_2r.fk: q is a masked array": (TypeError, (np.ma.array([1.0, 2.0]),)),
    "planar_2r.fk: q is not of a rectangular shape": (ValueError, ([[1], [1, 2]],)),
    "planar_2r.fk: params has 1 fields, expected 2 (l1, l2)": (ValueError, ([1, 2], [1])),
    "write Parameters(**params)": (TypeError, ([1, 2], {"l1": 1})),
    "params must be Parameters": (TypeError, ([1, 2], 3.0)),
    "leading axes do not broadcast: q (3,), params.l1 (2,)": (
        ValueError,
        (np.zeros((3, 2)), (np.ones(2), 1)),
    ),
    "the arrays belong to several libraries: array_api_strict._array_object.Array, numpy.ndarray": (
        TypeError,
        (np.zeros(2), (strict.asarray(1.0), 1)),
    ),
}


@pytest.mark.parametrize("message", WRONG)
def test_an_argument_of_the_wrong_kind(message: str) -> None:
    error, arguments = WRONG[message]
    with pytest.raises(error) as raised:
        planar_2r.fk(*arguments)
    assert message in str(raised.value)


def test_only_angles_in_the_half_open_range_come_out() -> None:
    """Also in single precision, where the number nearest to pi is above it."""
    for dtype in (np.float32, np.float64):
        pi = dtype(np.pi)
        angles = np.array([[pi, 0], [-pi, 0], [pi, pi], [3 * pi, -pi], [-0.0, 0.0]], dtype)
        found = planar_2r.orientation(angles)
        assert found.dtype == dtype
        assert (found > -pi).all() and (found <= pi).all()
        assert planar_2r.ik(np.array([-5.0, -0.0], dtype)).q.max() <= pi
    turned = spherical_wrist.ik(np.diag([-1.0, -1.0, 1.0]))
    assert turned.status.tolist() == [2, 2]


def test_what_has_no_value_is_not_a_number() -> None:
    """A parallel singularity has an infinite condition number, a missing mode none."""
    apart = hybrid_five_bar.condition_number([0.0, np.pi, 0.0])
    numpy = importlib.import_module("closedform.generated.numpy.hybrid_five_bar")
    np.testing.assert_array_equal(apart, numpy.condition_number([0.0, np.pi, 0.0]))


def test_neither_torch_nor_jax_is_imported() -> None:
    code = (
        "import sys; from closedform.generated.array import planar_2r; planar_2r.ik([1, 2]);"
        "print({'torch', 'jax', 'dask', 'cupy', 'sympy'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_the_extra_is_named_if_it_is_missing() -> None:
    code = (
        "import sys; sys.modules['array_api_compat'] = None\n"
        "from closedform.generated.array import planar_2r"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "pip install 'closedform[array]'" in done.stderr.splitlines()[-1]


def test_the_numbers_of_the_runtime_are_those_of_the_toolkit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A number that is changed in one place only is noticed when the runtime is printed."""
    backend.BACKEND.shared([])
    changes = [
        (sines, "LIMIT", 1.0),
        (sines, "RIGHT_ANGLE", (1.0, 0.0, 0.0)),
        *((backend, name, replace(t, vanishing=1.0)) for name, t in TOLERANCES.items()),
        *((backend, name, replace(t, least_exponent=-1)) for name, t in TOLERANCES.items()),
    ]
    for home, name, value in changes:
        with monkeypatch.context() as patch:
            patch.setattr(home, name, value)
            with pytest.raises(ValueError, match="must hold"):
                backend.BACKEND.shared([])
