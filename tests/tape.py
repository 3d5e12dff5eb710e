"""A small array library with derivatives, for the tests: NumPy arrays that remember their operands.

It has what the array API standard has and the generated modules need, and nothing else.  The
derivatives are those of the textbook, evaluated as they stand: zero times infinity is NaN.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

float32, float64, uint8 = np.dtype("float32"), np.dtype("float64"), np.dtype("uint8")
Back = Callable[[np.ndarray], np.ndarray]


class Array:
    """A value, and for each operand the map from the derivative of the value to that of it."""

    def __init__(self, value: Any, operands: Sequence[tuple[Array, Back]] = ()):
        self.value, self.operands = np.asarray(value), operands

    dtype = property(lambda self: self.value.dtype)
    shape = property(lambda self: self.value.shape)
    ndim = property(lambda self: self.value.ndim)
    device = property(lambda self: "tape")

    def __array_namespace__(self, api_version: str | None = None) -> Any:
        return sys.modules[__name__]

    def __bool__(self) -> bool:
        raise TypeError("a value is not known while it is traced")

    def __getitem__(self, key: Any) -> Array:
        def back(d: np.ndarray) -> np.ndarray:
            whole = np.zeros(self.shape, d.dtype)
            whole[key] = d
            return whole

        return Array(self.value[key], [(self, back)])

    def __neg__(self) -> Array:
        return Array(-self.value, [(self, lambda d: -d)])

    def __add__(self, other: Any) -> Array:
        return elementwise(np.add, (self, other), lambda a, b, d: (d, d))

    def __sub__(self, other: Any) -> Array:
        return elementwise(np.subtract, (self, other), lambda a, b, d: (d, -d))

    def __mul__(self, other: Any) -> Array:
        return elementwise(np.multiply, (self, other), lambda a, b, d: (d * b, d * a))

    def __truediv__(self, other: Any) -> Array:
        return elementwise(np.divide, (self, other), lambda a, b, d: (d / b, -d * a / b / b))

    def __rsub__(self, other: float) -> Array:
        return -self + other

    def __rtruediv__(self, other: float) -> Array:
        return asarray(other, dtype=self.dtype) / self

    __radd__, __rmul__ = __add__, __mul__


def _operator(function: Callable[..., Any]) -> Callable[..., Array]:
    return lambda a, b: Array(function(a.value, b.value if isinstance(b, Array) else b))


for name, function in (
    *((f"__{n}__", getattr(np, w)) for n, w in (("lt", "less"), ("le", "less_equal"))),
    *((f"__{n}__", getattr(np, w)) for n, w in (("gt", "greater"), ("ge", "greater_equal"))),
    *((f"__{n}__", getattr(np, f"logical_{n}")) for n in ("and", "or")),
    ("__eq__", np.equal),
):
    setattr(Array, name, _operator(function))


def elementwise(function: Any, operands: Sequence[Any], derivatives: Any) -> Array:
    """A function of arrays that broadcast, and the derivatives by each, times that of the value."""
    arrays = [x for x in operands if isinstance(x, Array)]
    (dtype,) = {a.dtype for a in arrays}
    values = [x.value if isinstance(x, Array) else dtype.type(x) for x in operands]

    def back(k: int) -> Back:
        return lambda d: _summed(derivatives(*values, d)[k], operands[k].shape)

    with np.errstate(all="ignore"):
        value = function(*values)
    return Array(value, [(x, back(k)) for k, x in enumerate(operands) if isinstance(x, Array)])


def _summed(d: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """The derivative by an operand that was broadcast."""
    d = d.sum(axis=tuple(range(d.ndim - len(shape))))
    return d.sum(axis=tuple(k for k, n in enumerate(shape) if n == 1 < d.shape[k]), keepdims=True)


# The functions of the standard that are used


def asarray(value: Any, *, dtype: Any = None, device: Any = None) -> Array:
    return Array(np.asarray(value, dtype))


def astype(x: Array, dtype: Any) -> Array:
    return Array(x.value.astype(dtype))


def result_type(*dtypes: Any) -> Any:
    return np.result_type(*dtypes)


def isdtype(dtype: Any, kind: Any) -> bool:
    return bool(np.isdtype(dtype, kind))


def sin(x: Array) -> Array:
    return elementwise(np.sin, (x,), lambda a, d: (d * np.cos(a),))


def cos(x: Array) -> Array:
    return elementwise(np.cos, (x,), lambda a, d: (-d * np.sin(a),))


def sqrt(x: Array) -> Array:
    return elementwise(np.sqrt, (x,), lambda a, d: (d * 0.5 / np.sqrt(a),))


def atan2(y: Array, x: Array) -> Array:
    def derivatives(y: Any, x: Any, d: Any) -> Any:
        return d * x / (x * x + y * y), -d * y / (x * x + y * y)

    return elementwise(np.arctan2, (y, x), derivatives)


def abs(x: Array) -> Array:
    return elementwise(np.abs, (x,), lambda a, d: (d * np.sign(a),))


def maximum(a: Array, b: Array) -> Array:
    return elementwise(np.maximum, (a, b), lambda a, b, d: (d * (a >= b), d * (a < b)))


def minimum(a: Array, b: Array) -> Array:
    return elementwise(np.minimum, (a, b), lambda a, b, d: (d * (a <= b), d * (a > b)))


def round(x: Array) -> Array:
    return Array(np.round(x.value))


def isfinite(x: Array) -> Array:
    return Array(np.isfinite(x.value))


def logical_not(x: Array) -> Array:
    return Array(np.logical_not(x.value))


def where(condition: Array, a: Array, b: Array) -> Array:
    c = condition.value
    return elementwise(
        lambda a, b: np.where(c, a, b),
        (a, b),
        lambda a, b, d: (np.where(c, d, 0), np.where(c, 0, d)),
    )


def stack(arrays: Sequence[Array], *, axis: int = 0) -> Array:
    def back(k: int) -> Back:
        return lambda d: np.take(d, k, axis=axis)

    return Array(
        np.stack([a.value for a in arrays], axis), [(a, back(k)) for k, a in enumerate(arrays)]
    )


def reshape(x: Array, shape: tuple[int, ...]) -> Array:
    return Array(x.value.reshape(shape), [(x, lambda d: d.reshape(x.shape))])


def broadcast_to(x: Array, shape: tuple[int, ...]) -> Array:
    return Array(np.broadcast_to(x.value, shape), [(x, lambda d: _summed(d, x.shape))])


def gradients(result: Array, weights: Any, by: Sequence[Array]) -> list[np.ndarray]:
    """The derivatives of the sum of a result times weights."""
    order: list[Array] = []
    seen: set[int] = set()
    stack = [(result, False)]
    while stack:
        node, done = stack.pop()
        if done:
            order.append(node)
        elif id(node) not in seen:
            seen.add(id(node))
            stack += [(node, True), *((x, False) for x, _ in node.operands)]
    found = {id(result): np.broadcast_to(weights, result.shape).astype(float)}
    with np.errstate(all="ignore"):
        for node in reversed(order):
            d = found.get(id(node))
            for operand, back in node.operands if d is not None else ():
                found[id(operand)] = found.get(id(operand), 0.0) + back(d)
    return [found.get(id(x), np.zeros(x.shape)) for x in by]
