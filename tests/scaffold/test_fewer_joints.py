"""Arms of four and five joints whose target is a pose: what the last axis says of the first joint.

Where the wrist is on the first axis, its position says nothing of the first joint.  If the joints
between are parallel, the direction of the last axis does.
"""

import importlib
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from arms import OK, SINGULAR, link
from sharing import compile_quickly

from closedform.cli.commands import main

QUARTER = np.pi / 2
# rows of a, alpha, d as the table says them, and as numbers; the number of branches
ARMS = {
    "in_line": ("0 pi/2 .1; .306 0 0; .3 0 0; 0 pi/2 0; 0 0 .136", 4),
    "offsets": ("0.03 pi/2 .1; .116 0 .04; .135 0 0; 0 pi/2 .01; 0 0 .15", 4),
    "apart": ("0.03 pi/2 .1; .116 0 0; .135 0 0; .02 pi/2 0; 0 0 .15", 4),
    "oblique": ("0 pi/3 .1; .3 0 0; .25 0 0; 0 pi/3 0; 0 0 .1", 4),
    "all_parallel": ("0.05 pi/2 .1; .3 0 .02; .25 0 0; .1 0 0", 2),
    "pointed": ("0 pi/2 .1; .3 0 0; .25 pi/2 0; 0 0 .1", 2),
    "from_the_tool": ("0 pi/2 .1; .116 0 .05; .135 0 0; .02 pi/3 0; 0 0 .15", 4),
}
NEAR = np.array([0, 1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2])


def numbers(rows: str) -> np.ndarray:
    angles = {"pi/2": np.pi / 2, "pi/3": np.pi / 3}
    return np.array([[angles.get(e) or float(e) for e in row.split()] for row in rows.split(";")])


def pose(rows: np.ndarray, q: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    for (a, alpha, d), angle in zip(rows, np.moveaxis(q, -1, 0), strict=True):
        T = T @ link(a, alpha, d, angle)
    return T


def on_first_axis(rows: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Postures whose origin of the third frame is at most as far from the first axis as NEAR."""
    grid = np.linspace(-np.pi, np.pi, 721)
    turned = pose(rows[:1], q[:, :1])[:, :3, 0]

    def beside(angles: np.ndarray) -> np.ndarray:
        """How far it is from the axis, with each row's angles of the second joint."""
        moved = np.repeat(q[:, None, :3], angles.shape[1], axis=1)
        moved[..., 1] = angles
        return np.einsum("ni,nki->nk", turned, pose(rows[:3], moved)[..., :3, 3])

    values = beside(np.tile(grid, (len(q), 1)))
    crosses = values[:, 1:] * values[:, :-1] < 0
    first = crosses.argmax(axis=1)[:, None]
    low, high = grid[first], grid[first + 1]
    start = np.sign(beside(low))
    for _ in range(60):
        middle = (low + high) / 2
        same = np.sign(beside(middle)) == start
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    found = crosses.any(axis=1)
    out = np.repeat(q[found, None], len(NEAR), axis=1)
    out[..., 1] = low[found] + NEAR
    return out.reshape(-1, q.shape[1])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("fewer")


@pytest.fixture(scope="module", params=ARMS)
def derived(request: pytest.FixtureRequest, folder: Path) -> tuple[ModuleType, str]:
    """Derived and cross-checked in C and NumPy, both float types."""
    name = request.param
    lines = [
        ", ".join([*row.split(), f"t{k}"]) for k, row in enumerate(ARMS[name][0].split(";"), 1)
    ]
    table = folder / f"{name}.csv"
    table.write_text("a, alpha, d, theta\n" + "\n".join(lines), "utf-8")
    assert main(["new", name, "--from", "dh", str(table), "-o", str(folder)]) == 0
    backends = ["--backend", "numpy", "--backend", "c"]
    out = ["-o", str(folder / f"out_{name}")]
    patch = pytest.MonkeyPatch()
    compile_quickly(patch, folder)
    assert main(["derive", str(folder / f"{name}.py"), *out, *backends]) == 0
    patch.syspath_prepend(str(folder))
    importlib.invalidate_caches()
    module = importlib.import_module(f"out_{name}.numpy.{name}")
    patch.undo()
    return module, name


def test_no_posture_is_lost_at_the_first_axis_or_at_an_elbow(
    derived: tuple[ModuleType, str],
) -> None:
    arm, name = derived
    rows = numbers(ARMS[name][0])
    assert len(arm.BRANCHES) == ARMS[name][1]
    rng = np.random.default_rng(5)
    q = rng.uniform(-3, 3, (2000, len(rows)))
    near = rng.choice(NEAR, q.shape)
    corners = rng.choice([-2, -1, 0, 1, 2], q.shape) * QUARTER + near
    postures = [q, corners, np.where(rng.random(q.shape) < 0.5, corners, q)]
    above = on_first_axis(rows, q[:60])
    assert len(above) > 100
    for some in (*postures, above):
        T = pose(rows, some)
        solutions, status = arm.ik(T)
        assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
        missed = np.abs(pose(rows, np.nan_to_num(solutions)) - T[:, None])
        missed[..., :3, 3] /= np.abs(rows[:, [0, 2]]).sum()
        assert missed[np.isin(status, (OK, SINGULAR))].max() <= 1e-12
    solutions, status = arm.ik(pose(rows, q))
    apart = np.abs(np.angle(np.exp(1j * (solutions - q[:, None])))).max(axis=-1)
    assert (np.where(status == OK, apart, np.inf).min(axis=-1) < 1e-6).all()
