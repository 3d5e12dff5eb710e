"""Arms with links of very different or zero lengths: the inverse loses no posture of `fk`."""

import importlib

import numpy as np
import pytest
from fuzz import postures, robots
from fuzz.lengths import draw_lengths, draw_postures

OK, SINGULAR = 0, 2
OFF = (0.0, *(10.0**-k for k in range(16)))


def dimensions(rng: np.random.Generator, n: int, k: int) -> np.ndarray:
    """Lengths from 1e-4 to 1e4, a third of them with zeros, a third with equal ones."""
    lengths = 10.0 ** rng.uniform(-4, 4, (n, k))
    kind = rng.integers(0, 3, (n, 1))
    lengths = np.where((kind == 0) & (rng.random((n, k)) < 0.4), 0.0, lengths)
    same = (kind == 1) & (rng.random((n, k)) < 0.5)
    return np.where(same, lengths[:, :1], lengths)


def near(rng: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    """Deviations from 1 down to 1e-15, and zero."""
    return rng.choice(OFF, shape) * rng.uniform(-1, 1, shape)


def joints(rng: np.random.Generator, n: int, k: int) -> np.ndarray:
    """Any angle, or a multiple of a right one up to a small deviation."""
    corner = rng.choice([-np.pi, -np.pi / 2, 0, np.pi / 2, np.pi], (n, k)) + near(rng, (n, k))
    share = rng.choice([0.0, 0.3, 0.7], (n, 1))
    return np.where(rng.random((n, k)) < share, corner, rng.uniform(-np.pi, np.pi, (n, k)))


def puma560(rng: np.random.Generator, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Stretched, folded and with the wrist over the shoulder as well."""
    lengths, q = dimensions(rng, n, 4), joints(rng, n, 6)
    a2, a3, _, d4 = lengths.T
    straight = rng.choice([0, np.pi], n) - np.arctan2(d4, a3) + near(rng, (n,))
    q[:, 2] = np.where(rng.random(n) < 0.5, straight, q[:, 2])
    ahead = np.angle(a2 + (a3 + 1j * d4) * np.exp(1j * q[:, 2]))
    above = rng.choice([-1, 1], n) * np.pi / 2 - ahead + near(rng, (n,))
    q[:, 1] = np.where(rng.random(n) < 0.3, above, q[:, 1])
    return lengths, q


def stanford_arm(rng: np.random.Generator, n: int) -> tuple[np.ndarray, np.ndarray]:
    lengths, q = dimensions(rng, n, 1), joints(rng, n, 6)
    q[:, 2] = near(rng, (n,)) * 10.0 ** rng.uniform(-4, 4, n)
    return lengths, q


def scara(rng: np.random.Generator, n: int) -> tuple[np.ndarray, np.ndarray]:
    return dimensions(rng, n, 3), joints(rng, n, 4)


def irb260(rng: np.random.Generator, n: int) -> tuple[np.ndarray, np.ndarray]:
    return dimensions(rng, n, 6), joints(rng, n, 4)


def planar_2r(rng: np.random.Generator, n: int) -> tuple[np.ndarray, np.ndarray]:
    return dimensions(rng, n, 2), joints(rng, n, 2)


def reached(robot: str, backend: str, lengths: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Whether each posture is returned, after a check of the answers."""
    module = importlib.import_module(f"closedform.generated.{backend}.{robot}")
    x = module.fk(q, module.Parameters(*lengths.T))
    found, status = module.ik(x, module.Parameters(*lengths.T))
    good = np.isin(status, (OK, SINGULAR))
    again = module.fk(np.nan_to_num(found), module.Parameters(*lengths.T[..., None]))
    missed = np.abs(again - x[:, None])
    size = lengths.sum(axis=1) + (np.abs(q[:, 2]) if robot in ("stanford_arm", "scara") else 0)
    pose = x.ndim == 3
    far = missed[..., :3, 3].max(axis=-1) if pose else missed[..., :3].max(axis=-1)
    assert (far <= 1e-12 * size[:, None])[good].all()
    assert not pose or (missed[..., :3, :3].max(axis=(-1, -2)) <= 1e-12)[good].all()
    return good.any(axis=1)


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("draw", [puma560, stanford_arm, scara, irb260, planar_2r])
def test_lengths_from_1e_minus_4_to_1e4_and_zeros(draw, backend: str) -> None:
    lengths, q = draw(np.random.default_rng(3), 60_000)
    assert reached(draw.__name__, backend, lengths, q).all()


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize(
    ("lengths", "straight"),
    [((1e-4, 0.0, 1.0, 1e-4), True), ((1e-4, 0.0, 1.0, 1e-4), False), ((0, 0, 5.05, 0), False)],
)
def test_puma_far_beside_its_plane(lengths, straight: bool, backend: str) -> None:
    rng = np.random.default_rng(4)
    q = rng.uniform(-np.pi, np.pi, (20_000, 6))
    if straight:
        q[:, 2] = -np.pi / 2
    assert reached("puma560", backend, np.tile(lengths, (len(q), 1)), q).all()


UR = (0.089159, 0.425, 0.39225, 0.10915, 0.09465, 0.0823)


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize(
    ("changed", "event"),
    [
        ({2: 0.0}, "wrist"),
        ({1: 0.01, 2: 0.01, 3: 1.0}, "straight"),
        ({1: 0.01, 2: 0.0, 3: 1.0}, "straight"),
        ({3: 0.0, 2: 0.0}, "on axis"),
        ({1: 0.0, 2: 0.0}, ""),
        ({1: 1e-4, 2: 1e-4, 3: 1e4}, "straight"),
    ],
)
def test_ur_arm_with_short_links(changed: dict[int, float], event: str, backend: str) -> None:
    rng, n = np.random.default_rng(5), 20_000
    lengths = np.tile(UR, (n, 1))
    for k, length in changed.items():
        lengths[:, k] = length
    q = rng.uniform(-np.pi, np.pi, (n, 6))
    if event == "wrist":
        q[:, 4] = near(rng, (n,))
    if event == "straight":
        q[:, 2] = near(rng, (n,))
    if event == "on axis":
        _, a, _, _, e, _ = lengths.T
        sine = a * np.cos(q[:, 1]) / e
        lengths, q, sine = lengths[abs(sine) < 1], q[abs(sine) < 1], sine[abs(sine) < 1]
        q[:, 3] = np.arcsin(sine) - q[:, 1] - q[:, 2]
    assert reached("ur_arm", backend, lengths, q).all()


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_ur_arm_with_dissimilar_lengths(backend: str) -> None:
    rng, n = np.random.default_rng(6), 60_000
    lengths, q = dimensions(rng, n, 6), rng.uniform(-np.pi, np.pi, (n, 6))
    assert reached("ur_arm", backend, lengths, q).all()


def test_ur_arm_with_several_events() -> None:
    """A straight arm, a wrist in line and a tangent shoulder at once, with dissimilar lengths."""
    rng, n = np.random.default_rng(100), 20_000
    lengths = draw_lengths(rng, robots.robot("ur_arm"), n)
    corners = rng.choice((-np.pi, -np.pi / 2, 0, np.pi / 2, np.pi), (n, 6)) + near(rng, (n, 6))
    share = rng.choice([0.5, 0.8, 1.0], (n, 1))
    q = np.where(rng.random((n, 6)) < share, corners, rng.uniform(-np.pi, np.pi, (n, 6)))
    assert reached("ur_arm", "numpy", lengths, q).all()


@pytest.mark.parametrize("robot", ["h6ar", "h6ar_loop_closed"])
def test_twin_arms_with_dissimilar_lengths(robot: str) -> None:
    """OK answers hold to what the docstring says: 2^-46 of the lengths over d, or 1e-12."""
    rng, subject = np.random.default_rng(8), robots.robot(robot)
    lengths = draw_lengths(rng, subject, 20_000)
    q, _ = draw_postures(rng, subject, lengths)
    assert postures.check(subject, lengths, q) == []
