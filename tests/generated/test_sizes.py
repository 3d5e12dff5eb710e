"""A mechanism of any size gives the answers of one of an ordinary size, to the last bit."""

import importlib

import numpy as np
import pytest
from sizes import LENGTHS, lengths, powers, resized, scaled

from closedform.lower.degrees import degrees
from closedform.lower.graph import Graph
from closedform.model.tolerances import DOUBLE, FLOAT, HIGHEST_DEGREE

ROBOTS = [
    *LENGTHS, "four_bar", "irb2400", "opw_arm", "puma560", "ur_arm", "srs_arm", "franka_arm",
    "spherical_wrist",
]  # fmt: skip
ANGLES = ("alpha", "beta", "gamma")
"""How the names of parameters begin that are angles."""
EXPONENTS = (-900, -700, -300, -100, 8, 100, 300, 700, 1000)
POSTURES = 60


def inputs_of(robot: str) -> dict[str, np.ndarray]:
    """Random joints and the targets that they reach, as planes; some of it not a number."""
    module = importlib.import_module(f"closedform.generated.numpy.{robot}")
    random = np.random.default_rng(0)
    q = random.uniform(-2, 2, (POSTURES, len(module.JOINTS)))
    q[:, lengths(robot, "q")] += 3
    x = module.fk(q) if hasattr(module, "fk") else q - 3
    if module.ASSEMBLY_MODES:
        x = x.p[:, 0]
        x[np.isnan(x)] = 1
    x = x.reshape(POSTURES, -1).copy()
    q[0] = 0
    if hasattr(module, "fk"):  # else a length that is not finite, and some entries do not use it
        q[1, 0], x[2, 0], x[3, 0] = np.nan, np.nan, np.inf
    x[4:6] *= 1.9
    return {"q": q.T, "x": x.T}


def entries(result: object) -> list[np.ndarray]:
    return [np.asarray(r) for r in (result if isinstance(result, tuple) else (result,))]


@pytest.mark.parametrize("language", ["numpy", "c"])
@pytest.mark.parametrize("robot", ROBOTS)
def test_a_mechanism_of_any_size(robot: str, language: str) -> None:
    """Angles and statuses stay the same; lengths scale once, areas twice.

    In C a posture of another size is computed alone, even in a batch.
    """
    source = importlib.import_module(f"closedform.generated.numpy.{robot}")
    module = importlib.import_module(f"closedform.generated.{language}.{robot}")
    given = inputs_of(robot)
    random = np.random.default_rng(1)
    names = [name for name in module.__all__ if name[0].islower()]
    for name in names:
        kernel = getattr(source, f"_{name.upper()}")
        planes = []
        for a in kernel.inputs:
            known = given.get(a.name, given["x"])
            fits = len(known) == a.size
            planes.append(known if fits else random.uniform(-1, 1, (a.size, POSTURES)))

        def evaluated(exponent: int, single: bool = False) -> list[np.ndarray]:
            fields, example = module.Parameters._fields, np.array(module.Parameters())
            dimensions = module.Parameters(*resized(fields, example, exponent).tolist())
            arrays = [
                scaled(p, lengths(robot, a.name) or translations(a, robot), exponent).T.reshape(
                    -1, *a.shape
                )
                for p, a in zip(planes, kernel.inputs, strict=True)  # noqa: B023
            ]
            function = getattr(module, name)  # noqa: B023
            if not single or not arrays:
                return entries(function(*arrays, params=dimensions))
            rows = [entries(function(*row, params=dimensions)) for row in zip(*arrays, strict=True)]
            return [np.array(column) for column in zip(*rows, strict=True)]

        plain, larger = evaluated(0), evaluated(4)
        alone, alone_larger = evaluated(0, single=True), evaluated(4, single=True)
        # rounding differs between one call and a batch, so zero may be zero in one of them alone
        degree = [
            np.where(a == 0, powers(d, c), powers(b, a))
            if a.dtype == np.float64
            else np.zeros(a.shape, np.int32)
            for a, b, c, d in zip(plain, larger, alone, alone_larger, strict=True)
        ]
        for exponent in EXPONENTS:
            results = zip(
                evaluated(exponent),
                evaluated(exponent, single=True),
                plain,
                alone,
                degree,
                strict=True,
            )
            for batch, single, expected, expected_alone, d in results:
                if batch.dtype != np.float64:
                    np.testing.assert_array_equal(batch, expected, f"{name} {exponent}")
                    np.testing.assert_array_equal(single, expected, f"{name} {exponent}")
                    continue
                with np.errstate(over="ignore", under="ignore"):
                    one = np.ldexp(expected_alone, exponent * d)
                    many = np.ldexp(expected, exponent * d)
                np.testing.assert_array_equal(single, one, f"{name} {exponent}")
                same = (batch == many) | (batch == one)
                assert (same | (np.isnan(batch) & np.isnan(one))).all(), (name, exponent)


def translations(array: object, robot: str) -> list[int]:
    """The places of the translation in a pose, whatever its name; none in other arrays."""
    pose = array.shape == (4, 4)  # type: ignore[attr-defined]
    return [3, 7, 11] if pose else []


@pytest.mark.parametrize("language", ["numpy", "c"])
def test_links_of_very_different_sizes(language: str) -> None:
    arm = importlib.import_module(f"closedform.generated.{language}.planar_2r")
    q, status = arm.ik((1e77, 1e77), arm.Parameters(1e77, 0.8e77))
    np.testing.assert_array_equal(status, arm.Status.OK)
    np.testing.assert_allclose(q, arm.ik((1, 1), arm.Parameters(1, 0.8)).q, rtol=1e-14)
    far = [(1e200, 1), (1e308, 1e308), (-1e155, 0)]
    np.testing.assert_array_equal(arm.ik(far, arm.Parameters(1, 1)).status, arm.Status.UNREACHABLE)
    # A link that is tiny compared with the other, and an arm of the smallest numbers.
    for short in (1e-300, 5e-324):
        for links in ((short, 1), (1, short)):
            q, status = arm.ik((0, 1), arm.Parameters(*links))
            np.testing.assert_array_equal(status, arm.Status.SINGULAR)
            np.testing.assert_allclose(arm.fk(q, arm.Parameters(*links)), [[0, 1]] * 2, atol=1e-15)
    q, status = arm.ik((0, 1e-323), arm.Parameters(5e-324, 5e-324))
    np.testing.assert_array_equal(status, arm.Status.OK)
    np.testing.assert_allclose(q, [[np.pi / 2, 0]] * 2)
    # In a batch, the ordinary postures stay as they are.
    x = np.random.default_rng(0).uniform(-15, 15, (1000, 2))
    mixed = x.copy()
    mixed[::7] = 1e100
    np.testing.assert_array_equal(arm.ik(mixed).q[1], arm.ik(x).q[1])
    assert (arm.ik(mixed).status[::7] == arm.Status.UNREACHABLE).all()
    out = (np.empty((1000, 2, 2)), np.empty((1000, 2), np.uint8))
    arm.ik(mixed, out=out)
    np.testing.assert_array_equal(out[0], arm.ik(mixed).q)


@pytest.mark.parametrize("language", ["numpy", "c"])
@pytest.mark.parametrize("single", [True, False])
@pytest.mark.parametrize("height", [1e155, -1e200, 1e308])
def test_a_height_far_beyond_the_links(language: str, single: bool, height: float) -> None:
    """It meets no other length, so that the elbow and the yaw do not depend on it."""
    scara = importlib.import_module(f"closedform.generated.{language}.scara")
    x = np.array([[0.3, 0.2, 0.1, 0.7], [0.1, -0.4, 0.0, 0.0]])
    far = x.copy()
    far[:, 2] = height
    near_q, near_status = scara.ik(x[0] if single else x)
    far_q, far_status = scara.ik(far[0] if single else far)
    assert (far_status == near_status).all()
    np.testing.assert_array_equal(far_q[..., [0, 1, 3]], near_q[..., [0, 1, 3]])
    np.testing.assert_array_equal(far_q[..., 2], -height)


def test_a_length_apart_from_those_with_powers() -> None:
    """It has no say in the size, and neither has what is computed of it alone."""
    graph = Graph()
    x, length, height = map(graph.input, ("x", "length", "height"))
    area = graph.node("mul", x, length)
    above = graph.node("add", height, graph.node("mul", height, graph.node("sin", graph.const(1))))
    found = degrees([[area, above]], {}, ["x", "length", "height"])
    assert found is not None
    assert (found.lengths, found.results, found.highest) == ({"x", "length"}, ((2, 0),), 2)
    together = degrees([[area, graph.node("add", above, x)]], {}, ["x", "length", "height"])
    assert together is not None
    assert together.lengths == {"x", "length", "height"}


def test_degrees_of_a_program() -> None:
    graph = Graph()
    x, length, angle = map(graph.input, ("x", "length", "angle"))
    square = graph.node("add", graph.node("mul", x, x), graph.node("mul", length, length))
    root = graph.node("sqrt", square)
    volume = graph.node("mul", square, graph.node("mul", root, graph.node("sin", angle)))
    ratio = graph.div(root, length)
    found = degrees([[root, volume], [ratio]], {"angle": 0}, ["length"])
    assert found is not None
    assert found.lengths == {"x", "length"}
    assert found.results == ((1, 3), (0,))
    assert found.highest == 3
    # A constant among the lengths: there is no counterpart of twice the size.
    assert degrees([[graph.node("add", root, graph.const(2))]], {}, ["length"]) == degrees(
        [[graph.node("add", root, graph.const(2))]], {"length": 0}, []
    )
    assert degrees([[graph.node("add", x, graph.const(2))]], {"x": 1}, []) is None


@pytest.mark.parametrize(("tolerances", "low", "high"), [(DOUBLE, -1022, 1024), (FLOAT, -126, 128)])
def test_powers_of_sizes_stay_in_the_range(tolerances, low: int, high: int) -> None:
    for degree in range(2, HIGHEST_DEGREE + 1):
        least, most = map(np.log2, tolerances.sizes(degree))
        assert low / 2 - 2 <= degree * least < degree * most < high - 10
