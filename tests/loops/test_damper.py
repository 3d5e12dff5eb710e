"""A hand that two arms and a rod hold, whose first arm a damper turns.

The other route is the same suspension with this arm driven: the distance of the ends of the damper
is its length.
"""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, script_of
from places import TESTS

from closedform.algebra.shapes import ShapeError
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "damper_suspension.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR = range(3)
UPPER = TEXT.replace('E = [0.01, "s", 0.02]', "").replace("0], }", "0]}").replace('"l", 0], }', "")
UPPER = UPPER.replace('C = [0.03, "u", 0]}', 'C = [0.03, "u", 0], E = [0.02, 0.15, 0.03]}')
UPPER = UPPER.replace('["rod", "lower"]', '["rod", "upper"]').replace("[1, 0, 0]", "[0.8, 0.6, 0]")
UPPER = "\n".join(line for line in UPPER.splitlines() if not line.startswith("s = {value"))
CASES = {"lower": (TEXT, "l1"), "upper": (UPPER, "a")}


def with_arm(text: str, hinge: str) -> str:
    """The suspension without its damper, with the arm on a hinge driven."""
    kept = [
        line
        for line in text.splitlines()
        if not any(line.startswith(name) for name in ("tube", "rod", "d =", "q =", "f ="))
    ]
    named = {"l1": ("L", "lower"), "a": ("U", "upper")}[hinge]
    found = "\n".join(kept).replace(
        f'{hinge} = {{between = ["ground", "{named[1]}"]',
        f'{hinge} = {{driven = true, between = ["ground", "{named[1]}"]',
    )
    if hinge == "l1":  # where they are when the arm is at zero
        return found.replace('L = [0, 0, 0], B = [0, "l", 0]', 'B = [0, "0.25 + l", 0]').replace(
            ', E = [0.01, "s", 0.02]', ""
        )
    return found.replace(
        'U = [0, 0, 0], C = [0.03, "u", 0], E = [0.02, 0.15, 0.03]', 'C = [0.01, "0.3 + u", 0.2]'
    )


def turned(axis: np.ndarray, v: np.ndarray, angle: np.ndarray) -> np.ndarray:
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return c * v + s * np.cross(axis, v) + (1 - c) * axis * (axis @ v)


def length(hinge: str, angle: np.ndarray) -> np.ndarray:
    if hinge == "l1":
        axis, base, arm = np.array([1, 0, 0]), [0, 0.25, 0], np.array([0.01, 0.25, 0.02])
    else:
        axis, base, arm = np.array([0.8, 0.6, 0]), [-0.02, 0.3, 0.2], np.array([0.02, 0.15, 0.03])
    return np.linalg.norm(turned(axis, arm, angle) + base - [0.02, 0.32, 0.45], axis=-1)


@pytest.fixture(scope="module", params=CASES)
def case(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple:
    (text, hinge), folder = CASES[request.param], tmp_path_factory.mktemp("damper")
    name = f"damper_{request.param}"
    pushed = derived(name, script_of(name, text, folder), folder, crosscheck=hinge == "l1")
    other = f"{name}_arm"
    arm = derived(other, script_of(other, with_arm(text, hinge), folder), folder)
    return pushed, arm, hinge


def drawn(rows: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return rng.uniform(-3, 3, rows), rng.uniform(-0.05, 0.05, rows)


def order_of(pushed: ModuleType, q: np.ndarray, rack: np.ndarray) -> np.ndarray:
    columns = {"q": q, "r": rack}
    return np.stack([columns[name] for name in pushed.JOINTS], -1)


def order_of_arm(arm: ModuleType, hinge: str, angle: np.ndarray, rack: np.ndarray) -> np.ndarray:
    columns = {hinge: angle, "r": rack}
    return np.stack([columns[name] for name in arm.JOINTS], -1)


def test_its_modes_are_those_of_both_angles_of_the_arm(case: tuple) -> None:
    pushed, arm, hinge = case
    angle, rack = drawn(3000, 1)
    rows = order_of(pushed, length(hinge, angle), rack)
    p, status = pushed.fk(rows)
    assert p.shape == (3000, 8, 4, 4)
    mine, there = arm.fk(order_of_arm(arm, hinge, angle, rack))
    found = 0
    for k in range(4):
        rows_ = there[:, k] == OK
        gaps = np.abs(p[rows_] - mine[rows_, k][:, None]).max(axis=(2, 3))
        gaps = np.where(np.isnan(gaps), np.inf, gaps).min(axis=1)
        assert np.median(gaps) < 1e-14 and np.quantile(gaps, 0.99) < 1e-9 and gaps.max() < 1e-4
        found += rows_.sum()
    assert found > 1000
    # the squared length is a + b*cos + c*sin of the angle, so that of the other mode is known
    f0, f1, f2 = length(hinge, np.array([0, np.pi / 2, np.pi])) ** 2
    middle = np.arctan2(f1 - (f0 + f2) / 2, (f0 - f2) / 2)
    other = arm.fk(order_of_arm(arm, hinge, 2 * middle - angle, rack)).status
    both = np.count_nonzero(there == OK, axis=1) + np.count_nonzero(other == OK, axis=1)
    assert np.mean(np.count_nonzero(status == OK, axis=1) == both) > 0.999


def test_its_jacobian_is_the_derivative(case: tuple) -> None:
    pushed, _, hinge = case
    angle, rack = drawn(500, 2)
    q = order_of(pushed, length(hinge, angle), rack)
    J, fk = pushed.jacobian(q), pushed.fk(q)
    good = (fk.status == OK) & (np.abs(J).max((-1, -2)) < 20)
    assert good.sum() > 100
    for k, step in enumerate(1e-6 * np.eye(2)):
        ahead, behind = pushed.fk(q + step), pushed.fk(q - step)
        rate = (ahead.p - behind.p) / 2e-6
        W = rate[..., :3, :3] @ fk.p[..., :3, :3].swapaxes(-1, -2)
        turns = [W[..., 2, 1], W[..., 0, 2], W[..., 1, 0]]
        twist = np.stack([*np.moveaxis(rate[..., :3, 3], -1, 0), *turns], -1)
        here = good & (ahead.status == OK) & (behind.status == OK)
        assert np.allclose(twist[here], J[here][:, :, k], atol=1e-5, rtol=1e-5)


def test_the_signs_of_the_factors_name_the_modes(case: tuple) -> None:
    pushed, _, hinge = case
    angle, rack = drawn(500, 3)
    q = order_of(pushed, length(hinge, angle), rack)
    whole = (pushed.fk(q).status == OK).all(axis=1)
    assert whole.sum() > 10
    (modes,) = np.unique(np.sign(pushed.singularities(q)[whole]), axis=0)
    assert len(np.unique(modes, axis=0)) == 8


def test_a_damper_in_line_with_the_hinge_is_singular_and_too_long_unreachable(case: tuple) -> None:
    pushed, _, hinge = case
    angle = np.linspace(-np.pi, np.pi, 200001)
    lengths = length(hinge, angle)
    rack = np.zeros(1)
    for end, way in ((lengths.max(), 1), (lengths.min(), -1)):
        status = pushed.fk(order_of(pushed, np.array([end + way * 1e-4]), rack)).status
        assert (status == UNREACHABLE).all()
        (factors,) = pushed.singularities(order_of(pushed, np.array([end - way * 1e-9]), rack))
        assert not (np.abs(factors[:, 0]) > 1e-4).any()


def test_what_a_damper_turns_is_an_arm(tmp_path: Path) -> None:
    script = script_of("t", TEXT, tmp_path)
    assert "Damper(" in script
    slider = script.replace("Crank(\n        l1", "Slide(\n        l1", 1)
    assert slider != script
    with pytest.raises((ShapeError, TypeError)):
        exec(compile(slider, "script.py", "exec"), {})
    with pytest.raises(TableError, match="lower has no point L"):
        script_of("t", TEXT.replace("lower = {L = [0, 0, 0], ", "lower = {"), tmp_path)


def test_a_strut_in_space_that_is_driven_is_told_what_to_drive(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops" / "macpherson_strut.toml").read_text("utf-8")
    text = text.replace("axis = [1, 0, 0], driven = true", "axis = [1, 0, 0]")
    text = text.replace("axis = [-0.05, -0.15, 1]", "axis = [-0.05, -0.15, 1], driven = true")
    with pytest.raises(
        TableError, match=r"s is the slide of a strut, .* Drive the hinge of the arm"
    ):
        script_of("t", text, tmp_path)
