"""Deltas against the formulas of printers' firmware, such as Marlin and Klipper."""

import numpy as np
import pytest
from test_loops import OK, robot


def test_linear_delta_as_firmware_computes_it() -> None:
    """Carriages stand above the hand: the height of the hand, and a leg of a right triangle."""
    module, rng = robot("linear_delta"), np.random.default_rng(9)
    f, e, l = module.Parameters()
    p = np.concatenate([rng.uniform(-0.07, 0.07, (500, 2)), rng.uniform(0, 0.3, (500, 1))], axis=1)
    alpha = 2 * np.pi / 3 * np.arange(3)
    towers = (f - e) * np.stack([np.cos(alpha), np.sin(alpha)], axis=-1)
    square = ((p[:, None, :2] - towers) ** 2).sum(axis=-1)
    carriages = p[:, 2:] + np.sqrt(l**2 - square)
    answers = module.ik(p)
    above = module.BRANCHES.index("minus_minus_minus")
    np.testing.assert_allclose(answers.q[:, above], carriages, rtol=0, atol=1e-15)


def test_rotary_delta_as_it_is_usually_computed() -> None:
    """An arm in the plane x z: the elbow is where two circles meet."""
    module, rng = robot("delta"), np.random.default_rng(10)
    f, e, L, l, *alphas = module.Parameters()
    p = np.concatenate([rng.uniform(-0.1, 0.1, (500, 2)), rng.uniform(-0.4, -0.25, (500, 1))], 1)
    outer = module.BRANCHES.index("plus_plus_plus")
    found = module.ik(p)
    for k, alpha in enumerate(alphas):
        x = p[:, 0] * np.cos(alpha) + p[:, 1] * np.sin(alpha) + e - f
        y, z = p[:, 1] * np.cos(alpha) - p[:, 0] * np.sin(alpha), p[:, 2]
        short = np.sqrt(l**2 - y**2)
        reach = np.hypot(x, z)
        bend = np.arccos((L**2 + reach**2 - short**2) / (2 * L * reach))
        angles = np.stack([np.arctan2(-z, x) - bend, np.arctan2(-z, x) + bend])
        gap = np.abs(np.angle(np.exp(1j * (angles - found.q[:, outer, k]))))
        assert gap.min(axis=0).max() < 1e-12


def near_ends(name: str, q: np.ndarray) -> np.ndarray:
    """The near ends of the rods, less the places of their far ends on the hand."""
    f, e, *rest = robot(name).Parameters()
    alpha = 2 * np.pi / 3 * np.arange(3)
    out, up = np.full_like(q, f - e), q
    if name == "delta":
        out, up = out + rest[0] * np.cos(q), -rest[0] * np.sin(q)
    return np.stack([out * np.cos(alpha), out * np.sin(alpha), up], axis=-1)


@pytest.mark.parametrize("name", ["linear_delta", "delta"])
def test_forward_as_firmware_computes_it(name: str) -> None:
    """Trilateration: a frame of the first two centres and the third, and the hand below it."""
    module, rng = robot(name), np.random.default_rng(11)
    low, high = {"linear_delta": (0.3, 0.5), "delta": (-1, 1)}[name]
    q = rng.uniform(low, high, (100_000, 3))
    centres, rod = near_ends(name, q), module.Parameters().l
    first, second, third = np.moveaxis(centres, -2, 0)

    def length(v: np.ndarray) -> np.ndarray:
        return np.linalg.norm(v, axis=-1, keepdims=True)

    across = length(second - first)
    ex = (second - first) / across
    along = (ex * (third - first)).sum(axis=-1, keepdims=True)
    aside = third - first - along * ex
    ey = aside / length(aside)
    x = across / 2
    y = (along**2 + length(aside) ** 2 - 2 * along * x) / (2 * length(aside))
    with np.errstate(invalid="ignore"):
        z = np.sqrt(rod**2 - x**2 - y**2)
    expected = first + x * ex + y * ey - z * np.cross(ex, ey)
    found = module.fk(q)
    below = module.ASSEMBLY_MODES.index("below")
    met = np.isfinite(z[:, 0])
    assert met.mean() > 0.9
    np.testing.assert_array_equal(found.status[met, below], OK)
    apart = np.abs(found.p[met, below] - expected[met]) * z[met]
    assert apart.max() < 1e-14
