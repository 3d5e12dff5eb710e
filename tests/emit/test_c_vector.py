"""Every batch function of the generated C is vectorised and agrees with the single call."""

import ctypes
import re
from importlib import import_module

import numpy as np
import pytest
from libraries import FORWARD, ROBOTS, C, compiles, library, runs
from sizes import ANGLES, lengths, powers, resized, scaled

TYPES = (np.float64, np.float32)
POSTURES = 300  # more than a block, and a remainder that is no whole vector


pytestmark = [
    pytest.mark.skipif(not compiles(), reason="no gcc 12 for x86-64"),
    pytest.mark.parametrize("robot", ROBOTS),
    pytest.mark.parametrize("real", TYPES),
]


@pytest.fixture(scope="module")
def build(tmp_path_factory):
    """The library of a robot for a type, and what gcc tells of it."""
    return lambda robot, real: library(tmp_path_factory, robot, single=real == np.float32)


def batch_loops(source: str) -> dict[int, str]:
    """The loops over the postures of a block: their lines, and the functions they serve."""
    loops, function = {}, ""
    for number, line in enumerate(source.splitlines(), 1):
        if definition := re.match(r"(?:CF_INLINE )?void (\w+)\(", line):
            function = definition[1].replace("_common", "")
        if re.search(r"\bfor \(size_t i = 0; i < length;", line):
            loops[number] = function
    return loops


def test_every_batch_loop_becomes_vectors(robot, real, build):
    _, told = build(robot, real)
    # Full vectors, not those of the remainder. A mere copy of a plane becomes a call of memcpy.
    width = max(map(int, re.findall(r"loop vectorized using (\d+) byte", told)))
    assert width >= 32
    done = f"loop vectorized using {width} byte|split to 0 loops and 1 library calls"
    vector = {int(n) for n in re.findall(rf"/{robot}\.c:(\d+):\d+: optimized:.*(?:{done})", told)}
    source = (C / f"{robot}.c").read_text()
    loops = batch_loops(source)
    batches = set(re.findall(r"^void (\w+_batch)\(", source, re.MULTILINE))
    assert batches and set(loops.values()) == batches
    assert {loops[line] for line in loops.keys() - vector} == set()


def test_a_batch_computes_the_angles_of_its_parameters_once(robot, real):
    """In a batch all postures have the same parameters: no loop over postures reads an angle."""
    source = (C / f"{robot}.c").read_text()
    blocks = re.findall(r"\n    for \(size_t start = 0;.*?\n    }\n", source, re.DOTALL)
    assert len(blocks) >= len(set(batch_loops(source).values()))
    assert not [block for block in blocks if "params->" in block]


def planes_of(arguments: str, real: type, known: dict[str, np.ndarray]) -> list[np.ndarray]:
    """Planes for every array of a single call, the inputs filled: with an output of that name of an
    earlier function, so that an inverse gets what can be reached, or else at random.  A loop has
    an image for each assembly mode, called p; the first one is taken."""
    random = np.random.default_rng(0)
    arrays = []
    for const, kind, name, size in re.findall(
        r"(const )?(real_t|uint8_t) (\w+)\[(\d+)\]", arguments
    ):
        planes = np.zeros((int(size), POSTURES), real if kind == "real_t" else np.uint8)
        if const:
            image = known.get(name, known.get("p") if name in ("x", "R") else None)
            planes[:] = random.uniform(-3, 3, planes.shape)
            if image is not None:  # there is none if the loop does not close
                image = image[: len(planes)]
                planes[:] = np.where(np.isnan(image), planes, image)
            planes[:, ::50] = 0
            planes[0, ::70] = np.nan
        known.setdefault(name, planes)
        arrays.append(planes)
    return arrays


def dimensions_of(robot: str, header: str, real: type) -> tuple[list[str], np.ndarray]:
    """The names of the parameters, and values: lengths between 3 and 2, angles of the example."""
    fields = re.findall(r"real_t (\w+); /\*", header)
    example = import_module(f"closedform.generated.numpy.{robot}").Parameters()
    values = np.linspace(3, 2, len(fields))
    for k, name in enumerate(fields):
        if name.startswith(ANGLES):
            values[k] = example[k]
    return fields, values.astype(real)


def pointer(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)


@pytest.mark.skipif(not runs(), reason="a processor without AVX2")
def test_batch_and_single_call_agree(robot, real, build):
    loaded = ctypes.CDLL(str(build(robot, real)[0]))
    header = " ".join((C / f"{robot}.h").read_text().split())
    params = dimensions_of(robot, header, real)[1]
    # A long chain of steps enlarges what a fused multiplication rounds differently, without bound
    # where the virtual arm of the H6AR is folded, or where the assembly modes of a loop meet.
    long_chain = robot.startswith("h6ar") or robot in (
        "delta", "four_bar", "spherical_five_bar", "three_prs",
    )  # fmt: skip
    few_ulps = (128 if long_chain else 16) * np.finfo(real).eps

    functions = re.findall(rf"void ({robot}_\w+)\(([^()]*)\);", header)
    known: dict[str, np.ndarray] = {}
    for name, arguments in functions:
        if name.endswith("_batch"):
            continue
        batch = planes_of(arguments, real, known)
        single = [np.ascontiguousarray(planes.T) for planes in batch]
        strided = [x for a in batch for x in (pointer(a), ctypes.c_size_t(POSTURES))]
        loaded[f"{name}_batch"](ctypes.c_size_t(POSTURES), pointer(params), *strided)
        for rows in zip(*single, strict=True):
            loaded[name](pointer(params), *map(pointer, rows))
        inverse = name.endswith(("_ik", "_ik_pose"))
        for one, many in zip(single, batch, strict=True):
            if many.dtype == np.uint8 or not (inverse or long_chain):
                np.testing.assert_allclose(one.T, many, few_ulps, few_ulps, err_msg=name)
                continue
            if inverse:  # ill-conditioned at a boundary, and close to pi it may be -pi
                apart = np.abs(np.exp(1j * one.T) - np.exp(1j * many))
            else:
                apart = np.abs(one.T - many) / (1 + np.abs(many))
            np.testing.assert_array_equal(np.isnan(one.T), np.isnan(many), name)
            assert np.nanmax(apart) < np.sqrt(few_ulps), name
            assert np.nanquantile(apart, 0.98) < few_ulps, name
        if inverse:
            least = 0.5 if robot in FORWARD else 0.1  # targets of fk, or random ones
            assert np.mean((batch[-1] == 0).any(axis=0)) > least, name


@pytest.mark.skipif(not runs(), reason="a processor without AVX2")
def test_a_mechanism_of_any_size(robot, real, build):
    """Of one that is much larger or smaller, a call gives the same to the last bit; a batch gives
    what a call does."""
    loaded = ctypes.CDLL(str(build(robot, real)[0]))
    header = " ".join((C / f"{robot}.h").read_text().split())
    fields, dimensions = dimensions_of(robot, header, real)
    ends = (-900, -300, 300, 1000) if real == np.float64 else (-68, -40, 40, 120)
    known: dict[str, np.ndarray] = {}
    for name, arguments in re.findall(rf"void ({robot}_\w+)\(([^()]*)\);", header):
        if name.endswith("_batch"):
            continue
        names = re.findall(r"(?:real_t|uint8_t) (\w+)\[", arguments)
        plain = [np.ascontiguousarray(a[:, :60]) for a in planes_of(arguments, real, known)]
        if robot not in FORWARD:  # a length that is NaN has no size, and some entries do not use it
            plain = [np.nan_to_num(a) for a in plain]
        n_in = arguments.count("const real_t")
        n = plain[-1].shape[1]

        def evaluated(exponent: int, batch: bool = False) -> list[np.ndarray]:
            params = resized(fields, dimensions, exponent)
            arrays = [
                scaled(a, lengths(robot, label), exponent) if k < n_in else np.zeros_like(a)  # noqa: B023
                for k, (a, label) in enumerate(zip(plain, names, strict=True))  # noqa: B023
            ]
            if batch:
                strided = [x for a in arrays for x in (pointer(a), ctypes.c_size_t(n))]  # noqa: B023
                loaded[f"{name}_batch"](ctypes.c_size_t(n), pointer(params), *strided)  # noqa: B023
                return arrays[n_in:]  # noqa: B023
            rows = [np.ascontiguousarray(a.T) for a in arrays]
            for row in zip(*rows, strict=True):
                loaded[name](pointer(params), *map(pointer, row))  # noqa: B023
            return [r.T for r in rows[n_in:]]  # noqa: B023

        single, many = evaluated(0), evaluated(0, batch=True)
        degree = [
            powers(b, a) if a.dtype == real else np.zeros(a.shape, np.int32)
            for a, b in zip(single, evaluated(4), strict=True)
        ]
        for exponent in ends:
            for one, batch, alone, together, d in zip(
                evaluated(exponent), evaluated(exponent, batch=True), single, many, degree,
                strict=True,
            ):  # fmt: skip
                if one.dtype == np.uint8:
                    np.testing.assert_array_equal(one, alone, f"{name} {exponent}")
                    np.testing.assert_array_equal(batch, together, f"{name} {exponent}")
                    continue
                with np.errstate(over="ignore", under="ignore"):
                    expected, other = (np.ldexp(v, exponent * d) for v in (alone, together))
                np.testing.assert_array_equal(one, expected, f"{name} {exponent}")
                same = (batch == one) | (batch == other) | (np.isnan(batch) & np.isnan(one))
                assert same.all(), (name, exponent)
