"""The toy of toy.c in plain NumPy, and the many layouts of an array in memory."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np


class Two(NamedTuple):
    v: np.ndarray
    status: np.ndarray


class Mixed(NamedTuple):
    y: Any
    flag: Any
    w: np.ndarray


def polar(q: Any, r0: Any, r1: Any) -> Any:
    a, b = q[..., 0], q[..., 1]
    return np.stack([r0 * np.cos(a) + r1 * b, r0 * np.sin(a) - r1 * b], axis=-1)


def two(q: Any, u: Any) -> Any:
    v = q[..., :, None] * u[..., :2, :] + u[..., 2:, :]
    status = np.where(q < 0, 1, np.where(q == 0, 2, 0)).astype(np.uint8)
    lead = v.shape[:-2]
    return v, np.broadcast_to(status, (*lead, 2))


def scalar(a: Any, b: Any, k: Any) -> Any:
    return k * a - b


def inside(p: Any, r: Any) -> Any:
    return np.hypot(p[..., 0], p[..., 1]) <= r


def volume(r0: Any, r1: Any) -> Any:
    return r0 * r0 * r1


def mixed(a: Any, k: Any) -> Any:
    y = a + k
    ones = np.ones_like(y)
    return y, a * ones > 0, (a * ones)[..., None, None, None] * np.arange(12.0).reshape(2, 3, 2)


def chain(q: Any) -> Any:
    return (q + np.roll(q, -1, axis=-1))[..., np.arange(12) % 6].reshape(*q.shape[:-1], 3, 4)


class Row(NamedTuple):
    """What the tests know of a function."""

    expected: Callable[..., Any]
    cores: tuple[tuple[int, ...], ...]
    defaults: tuple[float, ...]
    outputs: tuple[tuple[tuple[int, ...], type], ...]
    results: type = tuple


ROWS = {
    "polar": Row(polar, ((2,),), (1.0, 0.5), (((2,), float),)),
    "two": Row(two, ((2,), (3, 3)), (), (((2, 3), float), ((2,), np.uint8)), Two),
    "scalar": Row(scalar, ((), ()), (-2.0,), (((), float),)),
    "inside": Row(inside, ((2,),), (1.0,), (((), bool),)),
    "volume": Row(volume, (), (1.0, 0.5), (((), float),)),
    "mixed": Row(mixed, ((),), (-2.0,), (((), float), ((), bool), ((2, 3, 2), float)), Mixed),
    "chain": Row(chain, ((6,),), (), (((3, 4), float),)),
}


def values(rng: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    return np.asarray(rng.integers(-16, 17, shape) / 8.0)


# The same values in different memory


def _planes(x: np.ndarray, core: int) -> np.ndarray:
    last, first = tuple(range(-core, 0)), tuple(range(core))
    return np.moveaxis(np.array(np.moveaxis(x, last, first), order="C"), first, last)


def _reversed(x: np.ndarray, core: int) -> np.ndarray:
    back = (slice(None, None, -1),) * x.ndim
    return np.array(x[back], order="C")[back] if x.ndim else x.copy()


def _strided(x: np.ndarray, core: int) -> np.ndarray:
    wide = np.full(tuple(3 * n for n in x.shape), 77, x.dtype)
    view = wide[(..., *(slice(1, None, 3),) * x.ndim)]
    view[...] = x
    return view


def _unaligned(x: np.ndarray, core: int) -> np.ndarray:
    raw = np.zeros(x.nbytes + 1, np.uint8)[1:]
    view = raw[: x.nbytes].view(x.dtype).reshape(x.shape)
    view[...] = x
    return view


STRIDED: dict[str, Callable[[np.ndarray, int], np.ndarray]] = {
    "c": lambda x, core: x.copy(),
    "f": lambda x, core: np.array(x, order="F"),
    "planes": _planes,
    "reversed": _reversed,
    "strided": _strided,
    "unaligned": _unaligned,
}
LAYOUTS: dict[str, Callable[[np.ndarray, int], Any]] = STRIDED | {
    "float32": lambda x, core: x.astype(np.float32),
    "swapped": lambda x, core: x.astype(">f8"),
    "object": lambda x, core: x.astype(object),
    "list": lambda x, core: x.tolist() if x.size else x.copy(),
    "matrix": lambda x, core: x.copy().view(type("Sub", (np.ndarray,), {})),
    "scalar": lambda x, core: np.float64(x) if x.ndim == 0 else x.copy(),
}


def check(row: Row, result: Any, expected: Any) -> None:
    """Same types, shapes and values."""
    if len(row.outputs) == 1:
        result, expected = (result,), (expected,)
    else:
        assert type(result) is row.results
    for got, want, (core, kind) in zip(result, expected, row.outputs, strict=True):
        want = np.asarray(want)
        lead = want.shape[: want.ndim - len(core)]
        assert got.dtype == np.dtype(kind)
        assert got.shape == (*lead, *core)
        assert isinstance(got, np.ndarray) == bool(got.shape)
        if row.expected is polar:
            np.testing.assert_allclose(got, want, rtol=1e-14, atol=1e-14)
        else:
            np.testing.assert_array_equal(got, want)
