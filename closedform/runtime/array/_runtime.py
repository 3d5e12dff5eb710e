"""Statuses, result types and the evaluation of kernels, for arrays of any library.

Only functions of the array API standard are called, and control flow does not depend on values.  So
functions can be traced, compiled, mapped and differentiated by the library.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import nullcontext
from enum import IntEnum
from itertools import product, zip_longest
from numbers import Real
from typing import Any, NamedTuple

import numpy as np

try:
    import array_api_compat as compat
except ImportError as error:
    raise ImportError(
        "closedform.generated.array needs array-api-compat: pip install 'closedform[array]'"
    ) from error

Array = Any
"""An array of any library."""


class Precision(NamedTuple):
    """What depends on the floating-point type.

    ``turn`` and ``turn_tail`` add up to 2 pi, as do the three ``parts``, of which multiples are
    exact for angles up to ``limit``.  ``half_turn`` is the largest number that is not above pi.
    The powers of sizes stay between 2 to the powers ``least`` and ``most``; sizes beyond are
    multiplied by 2 to the powers ``steps``, or divided.
    """

    feasibility: float
    vanishing: float
    determined: float
    half_digits: float
    rounding: float
    rotation: float
    turn: float
    turn_tail: float
    half_turn: float
    parts: tuple[float, float, float]
    limit: float
    least: int
    most: int
    steps: tuple[int, ...]


FLOAT64 = Precision(
    feasibility=1e-12,
    vanishing=8.881784197001252e-16,
    determined=0.0009765625,
    half_digits=2.384185791015625e-07,
    rounding=5.684341886080802e-14,
    rotation=1e-06,
    turn=6.283185307179586,
    turn_tail=2.4492935982947064e-16,
    half_turn=3.141592653589793,
    parts=(4 * 1.5707963267923333, 4 * 2.5633441515839558e-12, 4 * 1.0562999066987428e-23),
    limit=400000.0,
    least=-512,
    most=1000,
    steps=(512, 256, 128, 64, 32, 16, 8),
)
FLOAT32 = Precision(
    feasibility=1e-06,
    vanishing=4.76837158203125e-07,
    determined=0.015625,
    half_digits=0.000244140625,
    rounding=7.62939453125e-06,
    rotation=0.0001,
    turn=6.2831854820251465,
    turn_tail=-1.7484555314695172e-07,
    half_turn=3.141592502593994,
    parts=(4 * 1.5707855224609375, 4 * 1.0804273188114166e-05, 4 * 6.07710062827671e-11),
    limit=200.0,
    least=-64,
    most=112,
    steps=(64, 32, 16, 8, 4, 2),
)


class Status(IntEnum):
    """The status of one branch of an inverse."""

    OK = 0
    UNREACHABLE = 1
    SINGULAR = 2
    INVALID = 3


class Solutions(NamedTuple):
    """Joint values ``q`` of shape (..., branches, joints) and ``status`` (..., branches)."""

    q: Array
    status: Array


class Positions(NamedTuple):
    """Task values ``p`` of shape (..., assembly modes, coordinates) and their ``status``."""

    p: Array
    status: Array


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


class Spec(NamedTuple):
    """An argument or a result of a kernel: its name, core shape, and kind of numbers."""

    name: str
    shape: tuple[int, ...]
    kind: str = "real"


class Size(NamedTuple):
    """How planes scale with the size of a mechanism, its largest length.

    ``lengths`` are the indices of the input planes that are lengths.  ``degrees`` are pairs: the
    index of a result plane and the power of the size with which it scales.  ``highest`` is the
    highest power of the size on the way, that of derivatives included.
    """

    lengths: tuple[int, ...]
    degrees: tuple[tuple[int, int], ...]
    highest: int


class Kernel(NamedTuple):
    """A function of operations and planes (one array for each coordinate).

    ``size`` is given if powers of lengths may leave the range of a floating-point type.
    """

    name: str
    compute: Callable[..., tuple[Any, ...]]
    inputs: tuple[Spec, ...]
    outputs: tuple[Spec, ...]
    fields: tuple[str, ...]
    used: tuple[str, ...]
    size: Size | None = None


class Operations:
    """What kernels call: operations on arrays of one library, type and device.

    The derivatives of all operations are finite where their values are, except for ``div``.
    """

    def __init__(self, xp: Any, dtype: Any, device: Any):
        self.xp, self.dtype, self.device = xp, dtype, device
        self._numbers: dict[float | None, Array] = {}
        self.precision = FLOAT32 if dtype == xp.float32 else FLOAT64
        self.feasibility = self.precision.feasibility
        self.vanishing = self.precision.vanishing
        self.determined = self.precision.determined
        self.half_digits = self.precision.half_digits
        self.rounding = self.precision.rounding
        self.rotation = self.precision.rotation
        self.nan = math.nan

    def number(self, value: Any) -> Array:
        """The array of a number in the code, or the array itself."""
        if not isinstance(value, float):
            return value
        key = value if value == value else None
        if key not in self._numbers:
            self._numbers[key] = self.xp.asarray(value, dtype=self.dtype, device=self.device)
        return self._numbers[key]

    def truth(self, value: bool) -> Array:
        return self.xp.asarray(value, device=self.device)

    def sin(self, angle: Array) -> Array:
        return self.xp.sin(self.number(angle))

    def cos(self, angle: Array) -> Array:
        return self.xp.cos(self.number(angle))

    def abs(self, x: Array) -> Array:
        return self.xp.abs(self.number(x))

    def max(self, a: Array, b: Array) -> Array:
        return self.xp.maximum(self.number(a), self.number(b))

    def min(self, a: Array, b: Array) -> Array:
        return self.xp.minimum(self.number(a), self.number(b))

    def finite(self, *values: Array) -> Array:
        every = self.xp.isfinite(self.number(values[0]))
        for value in values[1:]:
            every = every & self.xp.isfinite(self.number(value))
        return every

    def opposite(self, condition: Array) -> Array:
        return self.xp.logical_not(condition)

    def select(self, condition: Array, a: Array, b: Array) -> Array:
        return self.xp.where(condition, self.number(a), self.number(b))

    def sqrt(self, x: Array) -> Array:
        """The root; its derivative at zero, where it is infinite, counts as zero."""
        root = self.xp.sqrt(self.select(x == 0.0, 1.0, x))
        return self.select(x == 0.0, 0.0, root)

    def atan2(self, y: Array, x: Array) -> Array:
        """The angle; that of a point at the origin is 0, and its derivative counts as zero."""
        y, x = self.number(y), self.number(x)
        return self.xp.atan2(y, self.select((x == 0.0) & (y == 0.0), 1.0, x))

    def sign(self, x: Array) -> Array:
        """1 or -1; 1 for either zero."""
        return self.select(x < 0.0, -1.0, 1.0)

    def principal(self, angle: Array) -> Array:
        """The angle moved to [-pi, pi], up to rounding; a large angle loses no accuracy."""
        turns = self._turns(angle)
        near = angle
        for part in self.precision.parts:
            near = near - turns * part
        wide = self.xp.abs(angle) > self.precision.limit
        return self.select(wide, self.xp.atan2(self.xp.sin(angle), self.xp.cos(angle)), near)

    def wrap(self, angle: Array) -> Array:
        """The sum of a few angles moved to (-pi, pi]; a sum that is already there stays."""
        near = self._turned(angle, self._turns(angle))
        above = self.select(near > self.precision.half_turn, 1.0, 0.0)
        return self.wrap_cut(self._turned(near, above))

    def wrap_cut(self, angle: Array) -> Array:
        """An angle in [-pi, pi], the range of ``atan2``, moved to (-pi, pi].

        A turn is added, rather than a constant selected, so that the derivative is kept.
        """
        turn = self.precision.turn
        return angle + self.select(angle <= -0.5 * turn, turn, 0.0)

    def _turns(self, angle: Array) -> Array:
        return self.xp.round(angle * (1.0 / self.precision.turn))

    def _turned(self, angle: Array, turns: Array) -> Array:
        return (angle - turns * self.precision.turn) - turns * self.precision.turn_tail

    def poison(self, failed: Array) -> Array:
        """NaN if ``failed``, else zero."""
        return self.select(failed, math.nan, 0.0)

    def status(self, invalid: Array, unreachable: Array, singular: Array) -> Array:
        """The status of a branch: INVALID comes before UNREACHABLE, and that before SINGULAR."""
        reached = self.xp.where(singular, self.code(Status.SINGULAR), self.code(Status.OK))
        valid = self.xp.where(unreachable, self.code(Status.UNREACHABLE), reached)
        return self.xp.where(invalid, self.code(Status.INVALID), valid)

    def code(self, status: Status) -> Array:
        return self.xp.asarray(int(status), dtype=self.xp.uint8, device=self.device)


def evaluate(kernel: Kernel, args: Sequence[Any], params: Any) -> Any:
    """Apply a kernel to arrays whose leading axes broadcast; return an array or a tuple."""
    fields = _fields(kernel, params)
    names = [spec.name for spec in kernel.inputs] + [f"params.{name}" for name in kernel.fields]
    arrays, ops = _converted(kernel, names, [*args, *fields])
    cores = [spec.shape for spec in kernel.inputs] + [()] * len(fields)
    leads = [_lead(kernel, n, a, c) for n, a, c in zip(names, arrays, cores, strict=True)]
    lead = _broadcast(kernel, names, leads)
    tensors = any(map(_is_tensor, arrays))
    if not tensors and compat.is_dask_namespace(ops.xp):
        return _by_chunks(kernel, arrays, ops)
    planes = [
        array[(..., *index)]
        for spec, array in zip(kernel.inputs, arrays, strict=False)
        for index in _indices(spec.shape)
    ]
    given = dict(zip(kernel.fields, arrays[len(kernel.inputs) :], strict=True))
    with nullcontext() if tensors else np.errstate(all="ignore"):
        values = iter(_values(ops, kernel, [*planes, *(given[name] for name in kernel.used)]))
    results = [_stacked(ops, spec, lead, values) for spec in kernel.outputs]
    return results[0] if len(results) == 1 else tuple(results)


def _by_chunks(kernel: Kernel, arrays: Sequence[Array], ops: Operations) -> Any:
    """The same for arrays of Dask: one task for each chunk, which evaluates the kernel."""

    def axes(spec: Spec, label: str) -> list[str]:
        return [f"{spec.name}_{label}_{k}" for k in range(len(spec.shape))]

    def one(*chunks: Any) -> Any:
        return evaluate(kernel, chunks[:count], list(chunks[count:]))

    count = len(kernel.inputs)
    given = [axes(spec, "given") for spec in kernel.inputs] + [[] for _ in kernel.fields]
    found = [axes(spec, "found") for spec in kernel.outputs]
    left, right = (",".join(f"({','.join(names)})" for names in side) for side in (given, found))
    types = {"real": np.dtype(ops.dtype), "status": np.dtype("uint8"), "bool": np.dtype("bool")}
    dask: Any = sys.modules["dask.array"]
    return dask.apply_gufunc(
        one,
        f"{left}->{right}",
        *arrays,
        output_dtypes=[types[spec.kind] for spec in kernel.outputs],
        output_sizes={
            name: size
            for spec, names in zip(kernel.outputs, found, strict=True)
            for name, size in zip(names, spec.shape, strict=True)
        },
    )


def _fields(kernel: Kernel, params: Any) -> list[Any]:
    """The dimensions, one after another."""
    listed = isinstance(params, (tuple, list))
    if not listed and not (_is_array(params) and params.ndim):
        advice = "; write Parameters(**params)" if isinstance(params, dict) else ""
        raise TypeError(
            f"{kernel.name}: params must be Parameters or a sequence of its {len(kernel.fields)} "
            f"fields, not {type(params).__name__}{advice}"
        )
    length = len(params) if listed else params.shape[0]
    if length != len(kernel.fields):
        raise ValueError(
            f"{kernel.name}: params has {length} fields, expected {len(kernel.fields)} "
            f"({', '.join(kernel.fields)})"
        )
    return list(params) if listed else [params[k, ...] for k in range(length)]


def _is_array(value: Any) -> bool:
    """Whether a value decides the library; the scalars of NumPy are mere numbers."""
    if isinstance(value, (Real, list, tuple)):
        return False
    return _is_tensor(value) or bool(compat.is_array_api_obj(value))


def _is_tensor(value: Any) -> bool:
    """Whether a value belongs to PyTorch, found in a way that its compiler understands."""
    torch = sys.modules.get("torch")
    return torch is not None and isinstance(value, torch.Tensor)


def _device(array: Array) -> Any:
    return array.device if _is_tensor(array) else compat.device(array)


def _arrays_in(value: Any) -> Iterator[Array]:
    if _is_array(value):
        yield value
    elif isinstance(value, (list, tuple)):
        for entry in value:
            yield from _arrays_in(entry)


def _library(kernel: Kernel, arrays: Sequence[Array]) -> Any:
    """The namespace that all arrays have in common; that of NumPy if there are none."""
    if arrays and all(map(_is_tensor, arrays)):
        from array_api_compat import torch  # in a way that its compiler understands, too

        return torch
    try:
        return compat.array_namespace(*arrays or (np.empty(0),))
    except TypeError:
        kinds = sorted({f"{type(a).__module__}.{type(a).__qualname__}" for a in arrays})
        raise TypeError(
            f"{kernel.name}: the arrays belong to several libraries: {', '.join(kinds)}"
        ) from None


def _converted(
    kernel: Kernel, names: Sequence[str], values: Sequence[Any]
) -> tuple[list[Array], Operations]:
    """All arguments as real arrays of one library, type and device, and the operations on them."""
    found = [array for value in values for array in _arrays_in(value)]
    xp = _library(kernel, found)
    dtypes = [a.dtype for a in found if xp.isdtype(a.dtype, "real floating")]
    dtype = xp.result_type(*dtypes) if dtypes else xp.asarray(0.0).dtype
    if dtype not in (xp.float32, xp.float64):
        raise TypeError(f"{kernel.name}: dtype {dtype}, expected float32 or float64")
    ops = Operations(xp, dtype, _device(found[0]) if found else None)
    return [_array(kernel, ops, n, v) for n, v in zip(names, values, strict=True)], ops


def _array(kernel: Kernel, ops: Operations, name: str, value: Any) -> Array:
    """A real array; the entries of a list may be arrays."""
    xp = ops.xp
    if _is_array(value):
        if _is_masked(value):
            raise TypeError(f"{kernel.name}: {name} is a masked array, expected real numbers")
        if value.dtype == ops.dtype:
            return value
        if not xp.isdtype(value.dtype, ("bool", "integral", "real floating")):
            raise TypeError(f"{kernel.name}: {name} has dtype {value.dtype}, expected real numbers")
        return xp.astype(value, ops.dtype)
    if isinstance(value, Real):
        return xp.asarray(float(value), dtype=ops.dtype, device=ops.device)
    if list(_arrays_in(value)):
        return xp.stack([_array(kernel, ops, name, entry) for entry in value])
    try:
        plain = np.asarray(value)
    except ValueError:
        raise ValueError(f"{kernel.name}: {name} is not of a rectangular shape") from None
    if plain.dtype.kind not in "biuf":
        raise TypeError(f"{kernel.name}: {name} has dtype {plain.dtype}, expected real numbers")
    return xp.asarray(plain.astype(float).tolist(), dtype=ops.dtype, device=ops.device)


def _is_masked(value: Any) -> bool:
    """Whether the argument is a masked array; its mask would be lost."""
    masked = sys.modules.get("numpy.ma")
    return masked is not None and isinstance(value, masked.MaskedArray)


def _lead(kernel: Kernel, name: str, array: Array, core: tuple[int, ...]) -> tuple[int, ...]:
    """The leading axes of an argument."""
    shape = tuple(array.shape)
    split = len(shape) - len(core)
    if split < 0 or shape[split:] != core:
        expected = ", ".join(["...", *map(str, core)])
        raise ValueError(f"{kernel.name}: {name} has shape {shape}, expected ({expected})")
    return shape[:split]


def _broadcast(
    kernel: Kernel, names: Sequence[str], leads: Sequence[tuple[int, ...]]
) -> tuple[int, ...]:
    """The leading axes of all arguments together."""
    lead = []
    for sizes in zip_longest(*map(reversed, leads), fillvalue=1):
        wide = {n for n in sizes if n != 1}
        if len(wide) > 1:
            listed = ", ".join(f"{n} {s}" for n, s in zip(names, leads, strict=True) if s)
            raise ValueError(f"{kernel.name}: leading axes do not broadcast: {listed}")
        lead.append(wide.pop() if wide else 1)
    return tuple(reversed(lead))


def _indices(shape: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
    return product(*map(range, shape))


def _values(ops: Operations, kernel: Kernel, planes: Sequence[Array]) -> Sequence[Any]:
    """The planes of the results, for mechanisms of any size.

    If an input is not finite, a function with a status is evaluated at another point: NaN in one
    posture would otherwise become NaN in the derivative by dimensions that others share.
    """
    kinds = [spec.kind for spec in kernel.outputs for _ in _indices(spec.shape)]
    if "status" not in kinds:
        return _scaled(ops, kernel, planes)
    valid = ops.finite(*planes)
    values = _scaled(ops, kernel, [ops.select(valid, plane, 1.0) for plane in planes])
    invalid = ops.code(Status.INVALID)
    return [
        ops.xp.where(valid, v, invalid) if kind == "status" else ops.select(valid, v, math.nan)
        for kind, v in zip(kinds, values, strict=True)
    ]


def _scaled(ops: Operations, kernel: Kernel, planes: Sequence[Array]) -> Sequence[Any]:
    """The planes of the results, computed at a size at which no power of it leaves the range."""
    size = kernel.size
    if size is None:
        return kernel.compute(ops, *planes)
    sizes = ops.abs(planes[size.lengths[0]])
    for k in size.lengths[1:]:
        sizes = ops.max(sizes, ops.abs(planes[k]))
    least, most = -(-ops.precision.least // size.highest), ops.precision.most // size.highest
    ordinary = (2.0**least <= sizes) & (sizes <= 2.0**most)
    up = down = ops.number(1.0)
    for step in ops.precision.steps:
        large, small = sizes * up > 2.0**step, sizes * up < 2.0**-step
        up = up * ops.select(large, 2.0**-step, ops.select(small, 2.0**step, 1.0))
        down = down * ops.select(large, 2.0**step, ops.select(small, 2.0**-step, 1.0))
        if step <= most and -step >= least:
            break
    up, down = ops.select(ordinary, 1.0, up), ops.select(ordinary, 1.0, down)
    scaled = list(planes)
    for k in size.lengths:
        scaled[k] = planes[k] * up
    values = list(kernel.compute(ops, *scaled))
    for k, degree in size.degrees:
        for _ in range(abs(degree)):
            values[k] = values[k] * (down if degree > 0 else up)
    return values


def _stacked(ops: Operations, spec: Spec, lead: tuple[int, ...], values: Iterator[Any]) -> Array:
    """The next planes as one array."""
    planes = [next(values) for _ in _indices(spec.shape)]
    parts = [ops.xp.broadcast_to(ops.number(plane), lead) for plane in planes]
    if compat.is_jax_namespace(ops.xp):
        for inner, length in enumerate(reversed(spec.shape)):
            groups = range(0, len(parts), length)
            parts = [_selected(ops, parts[k : k + length], inner) for k in groups]
        return parts[0]
    if not spec.shape:
        return parts[0]
    return ops.xp.reshape(ops.xp.stack(parts, axis=-1), (*lead, *spec.shape))


def _selected(ops: Operations, parts: Sequence[Array], inner: int) -> Array:
    """The parts along a new axis, which ``inner`` axes follow, by selections.

    The compiler of JAX would evaluate the planes of a stack once more for each of its entries.
    """
    xp = ops.xp
    place = xp.reshape(xp.arange(len(parts), device=ops.device), (-1, *[1] * inner))
    spread = [xp.expand_dims(part, axis=part.ndim - inner) for part in parts]
    total = spread[0]
    for k, part in enumerate(spread[1:], 1):
        total = xp.where(place == k, part, total)
    return total
