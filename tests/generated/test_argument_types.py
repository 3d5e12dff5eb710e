"""NumPy and C refuse anything but an array of real numbers, with the same message."""

import decimal
import fractions
import importlib
import re
import warnings
from typing import Any, NamedTuple

import numpy as np
import pytest
import sympy as sp

ARM = [importlib.import_module(f"closedform.generated.{b}.planar_2r") for b in ("numpy", "c")]
Q = np.array([0.25, 0.5])


class Number:
    def __init__(self, value: Any) -> None:
        self.value = value

    def __float__(self) -> float:
        if isinstance(self.value, Exception):
            raise self.value
        return float(self.value)


class Index:
    def __index__(self) -> int:
        return 2


class Pair(NamedTuple):
    l1: Any
    l2: Any


def objects(*values: Any) -> np.ndarray:
    array = np.empty(len(values), object)
    array[:] = values
    return array


# Each is given for one of the two coordinates, or for both.
ACCEPTED: list[Any] = [
    [1, 2],
    (1, 2.5),
    [True, False],
    np.array([True, False]),
    np.array([1, 2], np.int8),
    np.array([1, 2**63], np.uint64),
    np.array([0.5, 0.25], np.float16),
    np.array([0.5, 0.25], np.float32),
    np.array([0.5, 0.25], ">f8"),
    np.array([1, 2], ">i4"),
    np.array(["1.5", "1e400"], np.longdouble),
    [fractions.Fraction(1, 3), 2],
    [decimal.Decimal("0.1"), 2.0],
    objects(fractions.Fraction(1, 3), np.float32(0.1)),
    objects(np.bool_(True), np.longdouble("0.1")),
    objects(Index(), Number(1.5)),
    [sp.Rational(1, 3), sp.pi],
    np.array([0.5, np.nan]),
    memoryview(np.array([0.5, 0.25])),
    range(2),
    [[0.5, 1.0]] * 3,
    np.zeros((0, 2)),
]
REFUSED: list[Any] = [
    1j * Q,
    [1j, 0],
    np.array([1, 2], np.complex64),
    objects(1j, 2),
    objects(np.complex128(1), 2),
    ["a", "b"],
    ["1.0", "2.0"],
    [1.0, "2.0"],
    "12",
    b"12",
    [b"1", b"2"],
    np.array(["1", "2"], "S1"),
    objects("1.0", "2.0"),
    objects(1.0, "2.0"),
    objects(1.0, b"2"),
    objects(np.str_("1"), 2),
    objects(1.0, None),
    [1.0, None],
    None,
    {},
    {"q": 1.0},
    {1.0, 2.0},
    object(),
    [object(), 1.0],
    np.array(["2020-01-01", "2021-01-01"], "M8[D]"),
    np.array([1, 2], "m8[s]"),
    np.datetime64("2020-01-01"),
    objects(np.datetime64("2020-01-01"), 1),
    np.zeros(2, [("a", float)]),
    np.zeros(2, "V8"),
    np.ma.masked_array([0.5, 0.25], [True, False]),
    np.ma.masked,
    iter([1.0, 2.0]),
    len,
    Q.astype(str),
]
OTHER: list[tuple[Any, type[Exception]]] = [
    ([10**400, 1], OverflowError),
    ([Number(ZeroDivisionError("no")), 1], ZeroDivisionError),
    ([[1.0, 2.0], [1.0]], ValueError),
    ([1.0, 2.0, 3.0], ValueError),
    (1.0, ValueError),
    ([], ValueError),
    (np.array([[1], [2]]), ValueError),
]


def outcome(call: Any) -> tuple[Any, ...]:
    """The results, or the error with its message; a warning is an error."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            result = call()
        except Exception as error:
            return type(error), str(error)
    arrays = result if isinstance(result, tuple) else (result,)
    return tuple((a.shape, a.dtype, np.asarray(a, float)) for a in arrays)


def both(call: Any) -> tuple[Any, ...]:
    numpy, c = (outcome(lambda m=m: call(m)) for m in ARM)
    if isinstance(numpy[0], type) or isinstance(c[0], type):
        assert numpy == c
        return numpy
    for (shape, dtype, values), expected in zip(numpy, c, strict=True):
        assert (shape, dtype) == expected[:2]
        np.testing.assert_allclose(values, expected[2], rtol=1e-9, atol=1e-9)
    return numpy


def label(value: Any) -> str:
    shown = re.sub(" at 0x[0-9a-f]+", "", repr(value))
    return f"{type(value).__name__}-{shown:.30}"


POSITIONS: dict[str, Any] = {
    "q": lambda m, v: m.fk(v),
    "keyword": lambda m, v: m.jacobian(q=v),
    "x": lambda m, v: m.ik(v),
    "with parameters": lambda m, v: m.fk(v, (1.0, np.ones(1))),
    "with out": lambda m, v: m.fk(v, out=np.empty(2)),
}


@pytest.mark.parametrize("position", POSITIONS)
@pytest.mark.parametrize("value", ACCEPTED, ids=label)
def test_real_numbers_are_accepted(value: Any, position: str) -> None:
    lead = np.shape(value)[:-1]
    found = both(lambda m: POSITIONS[position](m, value))
    if position != "with out":
        assert found[0][0][: len(lead)] == lead, found


@pytest.mark.parametrize("position", POSITIONS)
@pytest.mark.parametrize("value", REFUSED, ids=label)
def test_anything_else_is_refused(value: Any, position: str) -> None:
    error, message = both(lambda m: POSITIONS[position](m, value))
    assert error is TypeError
    assert message.startswith("planar_2r.") and message.endswith("expected real numbers")


@pytest.mark.parametrize("position", POSITIONS)
@pytest.mark.parametrize(("value", "error"), OTHER, ids=lambda v: label(v))
def test_other_errors(value: Any, error: type[Exception], position: str) -> None:
    assert both(lambda m: POSITIONS[position](m, value))[0] is error


SCALARS: list[Any] = [1, True, 2**63, np.float16(0.5), np.uint8(3), np.longdouble(0.1), Index()]
SCALARS += [fractions.Fraction(1, 3), decimal.Decimal("0.5"), Number(0.5), np.array([[1, 2]])]
SCALARS += [objects(1, 2.5), sp.sqrt(2), np.bool_(True), np.nan, [1.0, 2.0], range(3)]
BAD: list[Any] = [1j, "1", b"1", None, {}, object(), np.complex64(1), np.datetime64(1, "s")]
BAD += [np.str_("1"), ["a"], objects("1"), np.ma.masked, np.ma.ones(2), Q.astype(complex), 1j * Q]
BAD += [{1.0}, np.zeros(2, "V4"), [None]]


@pytest.mark.parametrize("k", [0, 1])
@pytest.mark.parametrize("value", SCALARS, ids=label)
def test_parameters_are_real_numbers(value: Any, k: int) -> None:
    for make in (tuple, list, lambda v: Pair(*v)):
        params = make([value, 2.0] if k == 0 else [2.0, value])
        both(lambda m, p=params: m.fk(Q, p))
        shape = both(lambda m, p=params: m.ik(Q, p))[0][0]
        assert shape == (*np.shape(value), 2, 2)


@pytest.mark.parametrize("k", [0, 1])
@pytest.mark.parametrize("value", BAD, ids=label)
def test_other_parameters_are_refused(value: Any, k: int) -> None:
    params = [value, 2.0] if k == 0 else [2.0, value]
    for given in (tuple(params), params):
        error, message = both(lambda m, p=given: m.fk(Q, p))
        assert error is TypeError
        assert message.startswith(f"planar_2r.fk: params.l{k + 1} ")
        assert message.endswith("expected real numbers")


@pytest.mark.parametrize(
    "params",
    [{"l1": 1.0, "l2": 2.0}, {1.0, 2.0}, 1.0, None, "ab", b"ab", np.array(1.0), np.float64(1),
     iter([1.0, 2.0]), object(), dict, {}.values(), range(2)],
    ids=label,
)  # fmt: skip
def test_parameters_are_a_sequence(params: Any) -> None:
    error, message = both(lambda m: m.fk(Q, params))
    assert error is TypeError
    assert message.startswith(
        f"planar_2r.fk: params must be Parameters or a sequence of its 2 fields, not "
        f"{type(params).__name__}"
    )
    assert message.endswith("; write Parameters(**params)") == isinstance(params, dict)


@pytest.mark.parametrize(
    "params", [(), (1.0,), (1.0, 2.0, 3.0), np.ones(3), [1.0], np.ones((3, 2))]
)
def test_parameters_have_a_number(params: Any) -> None:
    error, message = both(lambda m: m.fk(Q, params))
    assert error is ValueError and message.endswith("fields, expected 2 (l1, l2)")
    both(lambda m: m.fk(Q, np.array([1.0, 2.0])))
    both(lambda m: m.fk(Q, np.array([[1.0], [2.0]])))


OUT: list[Any] = [[0, 0], (0.0, 0.0), "ab", np.float64(0), np.zeros(3), np.empty(2, np.float32)]
OUT += [np.zeros(2, complex), np.empty(2, ">f8"), np.empty(2, object), np.broadcast_to(1.0, 2)]
OUT += [np.ma.ones(2), Pair(1, 2), object(), np.zeros(2, "V8"), np.zeros((1, 2)), {}, 0]


@pytest.mark.parametrize("out", OUT, ids=label)
def test_out_is_an_array(out: Any) -> None:
    assert both(lambda m: m.fk(Q, out=out))[0] in (TypeError, ValueError)
    assert both(lambda m: m.ik(Q, out=out))[0] is TypeError
    q, status = np.empty((2, 2)), np.empty(2, np.uint8)
    assert both(lambda m: m.ik(Q, out=(q, out)))[0] in (TypeError, ValueError)
    assert both(lambda m: m.ik(Q, out=(out, status)))[0] in (TypeError, ValueError)
    assert both(lambda m: m.ik(Q, out=[q, status]))[0] is TypeError


def with_out(strides: tuple[int, int]) -> tuple[Any, ...]:
    out = np.lib.stride_tricks.as_strided(np.zeros(16)[8:], (3, 2), strides)
    return both(lambda m: m.fk(np.ones((3, 2)), out=out))


@pytest.mark.parametrize("strides", [(8, 8), (0, 8), (16, 0), (-8, 8), (8, 16)])
def test_out_must_not_overlap_itself(strides: tuple[int, int]) -> None:
    assert with_out(strides) == (ValueError, "planar_2r.fk: out for x overlaps itself")


@pytest.mark.parametrize("strides", [(24, 8), (8, 24)])
def test_out_may_be_a_view(strides: tuple[int, int]) -> None:
    assert with_out(strides)[0][0] == (3, 2)


def test_several_mistakes_are_told_in_the_same_order() -> None:
    for call in (
        lambda m: m.fk("a", {"l1": 1}),
        lambda m: m.fk([1.0], {"l1": 1}),
        lambda m: m.fk(Q, ("a", 1j), out=0),
        lambda m: m.fk(np.ones((3, 2)), (np.ones(2), 1.0), out=0),
        lambda m: m.fk(np.ones((3, 2)), out=[0]),
    ):
        assert both(call)[0] in (TypeError, ValueError)


def test_numpy_scalars_and_large_batches_too() -> None:
    both(lambda m: m.fk(np.ones((9000, 2), np.float32)))
    both(lambda m: m.fk(np.ones((9000, 2)), (np.arange(9000), fractions.Fraction(1, 3))))
    assert both(lambda m: m.fk(np.ones((9000, 2)) + 0j))[0] is TypeError
