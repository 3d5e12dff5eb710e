"""Which coordinates of a mechanism are lengths, for the tests that scale all of them."""

from collections.abc import Sequence

import numpy as np

ANGLES = ("alpha", "beta", "gamma")
"""How the names of parameters begin that are angles."""
LENGTHS = {
    "planar_2r": {"x": [0, 1]},
    "rpr_planar": {"x": [0, 1], "q": [0, 1], "p": [0, 1]},
    "five_bar": {"x": [0, 1], "p": [0, 1]},
    "delta": {"x": [0, 1, 2], "p": [0, 1, 2]},
    "linear_delta": {"x": [0, 1, 2], "q": [0, 1, 2], "p": [0, 1, 2]},
    "orthoglide": {"x": [0, 1, 2], "q": [0, 1, 2], "p": [0, 1, 2]},
    "three_prs": {"x": [0], "q": [0, 1, 2]},
    "spherical_five_bar": {"x": [0, 1, 2], "p": [0, 1, 2]},
    "slider_crank": {"x": [0], "p": [0]},
    "scara": {"x": [0, 1, 2], "q": [2]},
    "stanford_arm": {"q": [2]},
    "irb260": {"x": [0, 1, 2], "p": [0, 1, 2]},
    "hybrid_five_bar": {"x": [0, 1, 2], "p": [0, 1, 2]},
    "h6ar": {"x": [0, 1, 2]},
    "h6ar_loop_closed": {"x": [0, 1, 2]},
}


def lengths(robot: str, name: str) -> list[int]:
    """The places of lengths in the input of this name, counting its entries in order."""
    return [3, 7, 11] if name == "T" else LENGTHS.get(robot, {}).get(name, [])


def scaled(planes: np.ndarray, places: list[int], exponent: int) -> np.ndarray:
    """Planes of entries; those at the given places are multiplied by a power of two."""
    result = planes.copy()
    result[places] = np.ldexp(planes[places], exponent)
    return result


def resized(names: Sequence[str], values: np.ndarray, exponent: int) -> np.ndarray:
    """Parameters of these names; those that are lengths are multiplied by a power of two."""
    angles = np.array([name.startswith(ANGLES) for name in names], bool)
    return np.where(angles, values, np.ldexp(values, exponent))


def powers(larger: np.ndarray, values: np.ndarray) -> np.ndarray:
    """For every entry, the power of the lengths in it, found by multiplying the lengths by 16."""
    with np.errstate(all="ignore"):
        found = np.log2(larger / values) / 4
    plain = np.isnan(values) | np.isinf(values) | (values == 0)
    np.testing.assert_array_equal(np.isnan(larger), np.isnan(values))
    assert np.isin(found[~plain], range(-3, 6)).all()
    return np.where(plain, 0, found).astype(np.int32)
