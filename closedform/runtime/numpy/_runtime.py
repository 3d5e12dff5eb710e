"""Statuses, result types and the evaluation of kernels for all generated NumPy modules."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from enum import IntEnum
from functools import cache, reduce
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

FEASIBILITY = 1e-12
VANISHING = 8.881784197001252e-16
DETERMINED = 0.0009765625
HALF_DIGITS = 2.384185791015625e-07
ROUNDING = 5.684341886080802e-14
ROTATION = 1e-06

BLOCK = 8000
"""Postures that a kernel computes at once: its intermediate arrays then stay in the cache.  A power of
two would make all arrays compete for the same part of the cache."""


class Status(IntEnum):
    """The status of one branch of an inverse."""

    OK = 0
    UNREACHABLE = 1
    SINGULAR = 2
    INVALID = 3


class Solutions(NamedTuple):
    """Joint values ``q`` of shape (..., branches, joints) and ``status`` (..., branches)."""

    q: NDArray[np.float64]
    status: NDArray[np.uint8]

    def __repr__(self) -> str:
        return _listed("Solutions", "q", self.q, self.status)


class Positions(NamedTuple):
    """Task values ``p`` of shape (..., assembly modes, coordinates) and their ``status``."""

    p: NDArray[np.float64]
    status: NDArray[np.uint8]

    def __repr__(self) -> str:
        return _listed("Positions", "p", self.p, self.status)


def _listed(kind: str, name: str, values: NDArray[np.float64], status: NDArray[np.uint8]) -> str:
    """A line for each branch of one posture; the arrays of several."""
    if np.ndim(values) != 2 or np.ndim(status) != 1:
        return f"{kind}({name}={values!r}, status={status!r})"
    rows = (f"\n    {v.tolist()} {Status(s).name}" for v, s in zip(values, status, strict=True))
    return f"{kind}({''.join(rows)}\n)"


class SkeletonJoint(NamedTuple):
    """A joint of a skeleton: its kind, and the points where it is, two for a slide."""

    kind: str
    points: tuple[str, ...]


class Skeleton(NamedTuple):
    """What ``skeleton`` draws.

    ``points`` are in the order of its values.  Each link is a polyline through points of one rigid
    body; the points of ``ground`` do not move.
    """

    points: tuple[str, ...]
    links: dict[str, tuple[str, ...]]
    joints: dict[str, SkeletonJoint]
    hand: str
    ground: tuple[str, ...]


class Array(NamedTuple):
    """An argument or a result of a kernel: its name, core shape and dtype."""

    name: str
    shape: tuple[int, ...]
    dtype: type = np.float64

    @property
    def size(self) -> int:
        size = 1
        for n in self.shape:
            size *= n
        return size


class Size(NamedTuple):
    """How planes scale with the size of a mechanism, its largest length.

    ``lengths`` are the indices of the input planes that are lengths.  ``degrees`` are pairs: the
    index of a result plane and the power of the size with which it scales.  The powers of sizes from
    ``least`` to ``most`` stay in the range of a double.
    """

    lengths: tuple[int, ...]
    degrees: tuple[tuple[int, int], ...]
    least: float
    most: float


class Kernel(NamedTuple):
    """A function of planes (one array for each coordinate), its arguments and its results.

    ``common``, if given, returns the same planes, valid unless something vanishes, and then a plane
    that says whether something does.  ``size`` is given if powers of lengths may leave the range of
    a double.
    """

    name: str
    compute: Callable[..., tuple[Any, ...]]
    inputs: tuple[Array, ...]
    outputs: tuple[Array, ...]
    fields: tuple[str, ...]
    used: tuple[str, ...]
    common: Callable[..., tuple[Any, ...]] | None = None
    size: Size | None = None


def sincos(angle: Any) -> tuple[Any, Any]:
    """Sine and cosine from the tangent of the half angle: four times as fast as ``np.sin``, ``np.cos``.

    The error is below 1.3 units in the last place of 1.  Near its zeros a cosine is therefore less
    accurate than that of libm; on the natural scale of a function of several angles the difference
    does not matter.
    """
    sine = np.tan(0.5 * angle)
    square = sine * sine
    cosine = 1.0 - square
    square += 1.0
    factor = 1.0 / square
    cosine *= factor
    sine += sine
    sine *= factor
    return sine, cosine


def sincos_as_in_c(angle: Any) -> tuple[Any, Any]:
    """Sine and cosine by the same operations in the same order as ``cf_sincos`` in ``closedform.h``.

    The results agree to the last bit, and so does a status that depends on them.
    """
    if np.ndim(angle) == 0:
        return _sincos_of_one(float(angle))
    size = np.abs(angle)
    shifted, sine, cosine = _sincos_of_rest(size)
    # The quadrant is at the end of the word.  Work on bits: np.where takes longer than all the above.
    quadrant, s, c = shifted.view(np.int64), sine.view(np.int64), cosine.view(np.int64)
    swap = -(quadrant & 1)
    swap &= s ^ c
    s ^= swap
    c ^= swap
    s ^= (quadrant & 2) << 62
    quadrant += 1
    c ^= (quadrant & 2) << 62
    sine *= np.copysign(1.0, angle)
    wide = size > 400000.0
    if np.count_nonzero(wide):
        for k in np.flatnonzero(wide):
            sine.flat[k], cosine.flat[k] = _sincos_of_one(float(angle.flat[k]))
    return sine, cosine


def _sincos_of_one(angle: float) -> tuple[Any, Any]:
    size = abs(angle)
    if not math.isfinite(size):
        return np.float64(np.nan), np.float64(np.nan)
    if size > 400000.0:
        return np.float64(math.sin(angle)), np.float64(math.cos(angle))
    shifted, sine, cosine = _sincos_of_rest(size)
    quadrant = int(shifted) & 3
    if quadrant & 1:
        sine, cosine = cosine, sine
    sine *= math.copysign(1.0, angle) * (1 - (quadrant & 2))
    cosine *= 1 - ((quadrant + 1) & 2)
    return np.float64(sine), np.float64(cosine)


def _sincos_of_rest(size: Any) -> tuple[Any, Any, Any]:
    """The quarter turns in ``size``, at the end of the word, and sine and cosine of the remainder."""
    shifted = size * 0.6366197723675814
    shifted += 4503599627370496.0
    n = shifted - 4503599627370496.0
    part = n * 2.5633441515839558e-12
    tail = size - n * 1.5707963267923333
    r = tail - part
    tail -= r
    tail -= part
    n *= 1.0562999066987428e-23
    tail -= n
    z = r * r
    z2 = z * z
    sine = z * 1.5895442710921173e-10
    sine += -2.5050734577586117e-08
    sine *= z2
    part = z * 2.7557313539658054e-06
    part += -0.00019841269829360994
    sine += part
    sine *= z2
    part = z * 0.008333333333321842
    part += -0.1666666666666663
    sine += part
    cosine = z * -1.1358749458908495e-11
    cosine += 2.087570540007036e-09
    cosine *= z2
    part = z * -2.7557314217063467e-07
    part += 2.4801587289002127e-05
    cosine += part
    cosine *= z2
    part = z * -0.0013888888888873342
    part += 0.041666666666666595
    cosine += part
    sine *= r * z
    part = 0.5 * z
    part = 1.0 - part
    part *= tail
    sine += part
    sine += r
    cosine *= z
    cosine -= 0.5
    cosine *= z
    tail *= r
    cosine -= tail
    cosine += 1.0
    return shifted, sine, cosine


def principal(angle: Any) -> Any:
    """The angle moved to [-pi, pi], up to rounding; a large angle loses no accuracy."""
    turns = np.rint(angle * (0.5 / np.pi))
    # 2 pi is split into three parts; the products with the first two are exact.
    near = angle - turns * (4 * 1.5707963267923333)
    near -= turns * (4 * 2.5633441515839558e-12)
    turns *= 4 * 1.0562999066987428e-23
    near -= turns
    wide = np.abs(angle) > 400000.0
    if np.count_nonzero(wide):
        return np.where(wide, np.arctan2(np.sin(angle), np.cos(angle)), near)
    return near


def wrap(angle: Any) -> Any:
    """The sum of a few angles moved to (-pi, pi]; a sum that is already there does not change."""
    turns = np.rint(angle * (0.5 / np.pi))
    wrapped = angle - turns * (2 * np.pi)
    turns *= 2.4492935982947064e-16
    wrapped -= turns
    return select(np.abs(wrapped) >= np.pi, np.pi, wrapped)


def wrap_cut(angle: Any) -> Any:
    """An angle in [-pi, pi], the range of ``atan2``, moved to (-pi, pi]."""
    return select(angle <= -np.pi, np.pi, angle)


def sign(value: Any) -> Any:
    """1 or -1; 1 for either zero."""
    return np.copysign(1.0, value + 0.0)


def select(rare: Any, a: Any, b: Any) -> Any:
    """``a`` if ``rare``, a condition that hardly ever holds, else ``b``."""
    if np.count_nonzero(rare):
        return np.where(rare, a, b)
    return np.float64(b) if isinstance(b, float) else b


def poison(failed: Any) -> Any:
    """NaN if ``failed``, else zero; added to each entry of an answer, it needs one selection."""
    return 0.0 / np.logical_not(failed) if np.count_nonzero(failed) else 0.0


def status(invalid: Any, unreachable: Any, singular: Any) -> Any:
    """The status of a branch: INVALID takes precedence over UNREACHABLE, and that over SINGULAR."""
    told = invalid | unreachable | singular
    if not np.count_nonzero(told):
        return np.zeros_like(told, np.uint8)
    reached = np.logical_not(unreachable)
    valid = np.uint8(1) * unreachable + np.uint8(2) * (singular & reached)
    return np.uint8(3) * invalid + np.logical_not(invalid) * valid


def evaluate(kernel: Kernel, args: Sequence[ArrayLike], params: Sequence[ArrayLike], out: Any) -> Any:
    """Apply a kernel to arrays whose leading axes broadcast; return an array or a tuple."""
    given = [
        arg if _is_plain(arg) else _converted(kernel, spec.name, arg)
        for spec, arg in zip(kernel.inputs, args, strict=True)
    ]
    fields = _parameters(kernel, params)
    arrays = [_core(kernel, spec, array) for spec, array in zip(kernel.inputs, given, strict=True)]
    lead = _leading_axes(kernel, arrays, fields)
    results = _results(kernel, lead, out)
    targets = results
    read = [*arrays, *fields]
    if out is not None and any(np.may_share_memory(r, a) for r in results for a in read):
        targets = [np.empty_like(r) for r in results]
    with np.errstate(all="ignore"):
        _fill(kernel, arrays, fields, lead, targets)
    if targets is not results:
        for result, target in zip(results, targets, strict=True):
            result[...] = target
    if out is not None:
        return out
    results = [r[()] if r.ndim == 0 else r for r in results]
    return results[0] if len(results) == 1 else tuple(results)


def _core(kernel: Kernel, spec: Array, array: NDArray[np.float64]) -> NDArray[np.float64]:
    """The argument with its core axes flattened to one."""
    split = array.ndim - len(spec.shape)
    if split < 0 or array.shape[split:] != spec.shape:
        expected = ", ".join(["...", *map(str, spec.shape)])
        raise ValueError(
            f"{kernel.name}: {spec.name} has shape {array.shape}, expected ({expected})"
        )
    return array.reshape((*array.shape[:split], spec.size))


def _parameters(kernel: Kernel, params: Sequence[ArrayLike]) -> list[NDArray[np.float64]]:
    if not isinstance(params, (tuple, list)) and not (isinstance(params, np.ndarray) and params.ndim):
        advice = "; write Parameters(**params)" if isinstance(params, dict) else ""
        raise TypeError(
            f"{kernel.name}: params must be Parameters or a sequence of its {len(kernel.fields)} "
            f"fields, not {type(params).__name__}{advice}"
        )
    values = tuple(params)  # converting one of them may change the list
    if len(values) != len(kernel.fields):
        raise ValueError(
            f"{kernel.name}: params has {len(values)} fields, expected {len(kernel.fields)} "
            f"({', '.join(kernel.fields)})"
        )
    return [
        np.asarray(value)
        if type(value) is float or _is_plain(value)
        else _converted(kernel, f"params.{name}", value)
        for name, value in zip(kernel.fields, values)
    ]


_DOUBLE = np.dtype(np.float64)


def _is_plain(arg: Any) -> bool:
    return type(arg) is np.ndarray and arg.dtype is _DOUBLE


def _converted(kernel: Kernel, name: str, arg: ArrayLike) -> NDArray[np.float64]:
    """An array of doubles, if the argument holds real numbers."""
    if _is_masked(arg):
        raise TypeError(f"{kernel.name}: {name} is a masked array, expected real numbers")
    array = np.asarray(arg)
    if array.dtype is _DOUBLE:
        return array
    if array.dtype.kind not in "biufO":
        raise TypeError(f"{kernel.name}: {name} has dtype {array.dtype}, expected real numbers")
    if array.dtype.kind == "O":
        for value in array.flat:
            if not _is_real(value):
                raise TypeError(
                    f"{kernel.name}: {name} holds {type(value).__name__}, expected real numbers"
                )
    with np.errstate(all="ignore"):
        return array.astype(np.float64)


def _is_masked(arg: Any) -> bool:
    """Whether the argument is a masked array; a conversion would drop its mask."""
    masked = sys.modules.get("numpy.ma")
    return masked is not None and isinstance(arg, masked.MaskedArray)


def _is_real(value: Any) -> bool:
    """Whether an object is a real number; text is not, although ``float`` would accept it."""
    if isinstance(value, np.generic):
        return value.dtype.kind in "biuf"
    known = hasattr(type(value), "__float__") or hasattr(type(value), "__index__")
    return known and not isinstance(value, complex)


def _leading_axes(
    kernel: Kernel, arrays: Sequence[NDArray[np.float64]], fields: Sequence[NDArray[np.float64]]
) -> tuple[int, ...]:
    shapes = [a.shape[:-1] for a in arrays] + [f.shape for f in fields]
    distinct = {s for s in shapes if s}
    if len(distinct) <= 1:
        return distinct.pop() if distinct else ()
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        names = [spec.name for spec in kernel.inputs] + [f"params.{n}" for n in kernel.fields]
        listed = ", ".join(f"{n} {s}" for n, s in zip(names, shapes, strict=True) if s)
        raise ValueError(f"{kernel.name}: leading axes do not broadcast: {listed}") from None


def _results(kernel: Kernel, lead: tuple[int, ...], out: Any) -> list[NDArray[Any]]:
    if out is None:
        return [np.empty((*lead, *spec.shape), spec.dtype) for spec in kernel.outputs]
    n = len(kernel.outputs)
    if n > 1 and not (isinstance(out, tuple) and len(out) == n):
        raise TypeError(f"{kernel.name}: out must be a tuple of {n} arrays")
    given = list(out) if n > 1 else [out]
    for spec, array in zip(kernel.outputs, given, strict=True):
        expected = (*lead, *spec.shape)
        if not isinstance(array, np.ndarray) or _is_masked(array):
            raise TypeError(
                f"{kernel.name}: out for {spec.name} must be an array, not {type(array).__name__}"
            )
        if array.shape != expected:
            raise ValueError(
                f"{kernel.name}: out for {spec.name} has shape {array.shape}, expected {expected}"
            )
        if array.dtype != spec.dtype:
            raise ValueError(
                f"{kernel.name}: out for {spec.name} has dtype {array.dtype}, "
                f"expected {np.dtype(spec.dtype)}"
            )
        if not array.flags.writeable:
            raise ValueError(f"{kernel.name}: out for {spec.name} is read-only")
        if _overlaps_itself(array):
            raise ValueError(f"{kernel.name}: out for {spec.name} overlaps itself")
    return given


def _overlaps_itself(array: NDArray[Any]) -> bool:
    """Whether two elements may share memory.

    Of the axes in the order of their strides, each must step over all that the shorter ones span;
    slices, transposes and fields of an array do.
    """
    if not array.size:
        return False
    axes = zip(array.strides, array.shape, strict=True)
    span = array.itemsize
    for step, length in sorted((abs(stride), n) for stride, n in axes if n > 1):
        if step < span:
            return True
        span += step * (length - 1)
    return False


def _fill(
    kernel: Kernel,
    arrays: Sequence[NDArray[np.float64]],
    fields: Sequence[NDArray[np.float64]],
    lead: tuple[int, ...],
    results: Sequence[NDArray[Any]],
) -> None:
    used = [f for name, f in zip(kernel.fields, fields, strict=True) if name in kernel.used]
    total = 1
    for n in lead:
        total *= n
    if total <= BLOCK:
        planes = [a[..., k] for a in arrays for k in range(a.shape[-1])]
        _store(kernel.outputs, results, _values(kernel, [*planes, *(f[()] for f in used)]))
        return
    arrays = [a if a.ndim == 1 else _rows(a, lead) for a in arrays]
    used = [f if f.ndim == 0 else _rows(f[..., None], lead)[:, 0] for f in used]
    flat = [
        r if len(lead) == 1 else r.reshape((-1, *spec.shape))
        for r, spec in zip(results, kernel.outputs, strict=True)
    ]
    _keep_freed_memory()
    for start in range(0, total, BLOCK):
        block = slice(start, start + BLOCK)
        planes = []
        for a in arrays:
            planes += list(a) if a.ndim == 1 else list(np.ascontiguousarray(a[block].T))
        constants = [f[()] if f.ndim == 0 else f[block] for f in used]
        _store(kernel.outputs, [r[block] for r in flat], _values(kernel, [*planes, *constants]))
    for result, rows in zip(results, flat, strict=True):
        if not np.may_share_memory(result, rows):
            result[...] = rows.reshape(result.shape)


def _keep_freed_memory() -> None:
    """Let each block reuse the memory of the block before.

    The C library of Linux returns memory to the system as soon as 128 KB are free, unless a larger
    piece has been freed before.  New pages for a block take as long as its computation.
    """
    np.empty(1 << 21)


def _values(kernel: Kernel, planes: Sequence[Any]) -> Sequence[Any]:
    """The planes of the results, for mechanisms of any size."""
    size = kernel.size
    if size is None or _is_ordinary(size, [planes[k] for k in size.lengths]):
        return _values_in_range(kernel, planes)
    sizes = reduce(np.maximum, (np.abs(planes[k]) for k in size.lengths))
    ordinary = (size.least <= sizes) & (sizes <= size.most) | ~np.isfinite(sizes)
    if np.all(ordinary):
        return _values_in_range(kernel, planes)
    exponents = np.frexp(sizes)[1]
    # Multiples of 4, so that roots of powers of lengths are also multiplied by powers of two.
    exponents = np.where(ordinary, np.int32(0), exponents - np.fmod(exponents, 4))
    scaled = list(planes)
    for k in size.lengths:
        scaled[k] = np.ldexp(planes[k], -exponents)
    values = list(_values_in_range(kernel, scaled))
    for k, degree in size.degrees:
        values[k] = np.ldexp(values[k], degree * exponents)
    return values


def _is_ordinary(size: Size, lengths: Sequence[Any]) -> bool:
    """Whether all sizes are known to be between the least and the most.

    The lengths that are shared by all postures must reach the least by themselves.  The sum of the
    squares of a plane bounds all its entries.
    """
    single = [abs(x) for x in lengths if not np.ndim(x)]
    planes = [x for x in lengths if np.ndim(x)]
    if not size.least <= max(single, default=0.0) <= size.most:
        return False
    return all(np.vdot(x, x) <= size.most * size.most for x in planes)


def _values_in_range(kernel: Kernel, planes: Sequence[Any]) -> Sequence[Any]:
    """The planes of the results, recomputed for the postures at which something vanishes."""
    if kernel.common is None:
        return kernel.compute(*planes)
    *values, rare = kernel.common(*planes)
    if not np.count_nonzero(rare):
        return values
    shape = np.broadcast_shapes(*map(np.shape, planes))
    if not shape:
        return kernel.compute(*planes)
    where = np.nonzero(np.broadcast_to(rare, shape))
    some = kernel.compute(*(np.broadcast_to(plane, shape)[where] for plane in planes))
    for k, value in enumerate(values):
        values[k] = np.array(np.broadcast_to(value, shape))
        values[k][where] = some[k]
    return values


def _rows(array: NDArray[Any], lead: tuple[int, ...]) -> NDArray[Any]:
    """``array`` broadcast to the leading axes, which become one; a view if possible."""
    return np.broadcast_to(array, (*lead, array.shape[-1])).reshape((-1, array.shape[-1]))


def _store(
    outputs: Sequence[Array], results: Sequence[NDArray[Any]], planes: Sequence[Any]
) -> None:
    """Write the planes, in order, into the entries of all results."""
    remaining = iter(planes)
    for spec, result in zip(outputs, results, strict=True):
        for index in _indices(spec.shape):
            result[index] = next(remaining)


@cache
def _indices(shape: tuple[int, ...]) -> list[tuple[Any, ...]]:
    """The index of every entry of a core, after all leading axes."""
    return [(..., *index) for index in np.ndindex(*shape)]
