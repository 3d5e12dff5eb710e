"""How far apart the models of the H6AR are: the figures of docs/decisions/h6ar-models.md.

Run as a script it prints the tables of that page.
"""

import numpy as np
import pytest
from closedform.generated.numpy import h6ar, h6ar_loop_closed
from places import ROOT

PAGE = ROOT / "docs" / "decisions" / "h6ar-models.md"
ANGLES = (5, 10, 15, 20, 25, 30)
TIP = (0.75, 0.1, 0.6)
DIMENSIONS = h6ar.Parameters()
L1, L2, A3, D1, D = DIMENSIONS[:5]


def target(yaw: float, roll: float) -> np.ndarray:
    """A posture of the tip in the middle of the workspace."""
    return np.array([*TIP, np.deg2rad(yaw), np.deg2rad(roll), 0.2])


def elbow_up(model, x: np.ndarray) -> np.ndarray:
    q, status = model.ik(x)
    branch = next(k for k, name in enumerate(model.BRANCHES) if name.startswith("front_elbow_up"))
    assert status[branch] == 0
    return q[branch]


def arm(upper: float, fore: float) -> np.ndarray:
    """Eq. (1) in the plane of an arm, for absolute angles."""
    return np.array(
        [
            L1 * np.cos(upper) + L2 * np.sin(fore) + A3 * np.cos(fore),
            L1 * np.sin(upper) - L2 * np.cos(fore) + A3 * np.sin(fore),
        ]
    )


def averages(q: np.ndarray) -> tuple[float, float]:
    upper = (q[1] + q[3]) / 2
    return upper, upper + (q[2] + q[4]) / 2


def shortcut(x: np.ndarray) -> np.ndarray:
    """The inverse of the paper: the right arm from (1), the left one from the averages."""
    exact = elbow_up(h6ar, x)
    upper, fore = averages(exact)
    r, h = arm(upper, fore) + D * np.tan(x[3:5])  # (3) and (4)
    length = np.hypot(L2, A3)
    reach = np.hypot(r, h)
    bend = np.arccos((reach**2 - L1**2 - length**2) / (2 * L1 * length))
    if A3 * np.sin(fore - upper) < L2 * np.cos(fore - upper):
        bend = -bend
    right = np.arctan2(h, r) - np.arctan2(length * np.sin(bend), L1 + length * np.cos(bend))
    elbow = bend + np.arctan2(L2, A3)
    return np.array([exact[0], right, elbow, 2 * upper - right, 2 * (fore - upper) - elbow, x[5]])


def miss(model, q: np.ndarray, x: np.ndarray) -> tuple[float, float, float]:
    """The errors of a model's forward map: the tip in mm, yaw and roll in degrees."""
    off = model.fk(q) - x
    return 1e3 * np.linalg.norm(off[:3]), *np.rad2deg(off[3:5])


def models() -> list[str]:
    """The published inverse on the mechanism whose loop closes."""
    rows = []
    for yaw, roll in [(a, 0) for a in ANGLES] + [(0, a) for a in ANGLES] + [(a, a) for a in ANGLES]:
        x = target(yaw, roll)
        q, true = elbow_up(h6ar, x), elbow_up(h6ar_loop_closed, x)
        tip, psi, phi = miss(h6ar_loop_closed, q, x)
        joints = np.rad2deg(np.abs(np.angle(np.exp(1j * (q - true)))).max())
        gap = h6ar.invariant_point(q) - h6ar.arm_tips(q).mean(0)
        rows.append(
            f"| {yaw} | {roll} | {tip:.1f} | {psi:.2f} | {phi:.2f} | {joints:.2f} "
            f"| {1e3 * np.linalg.norm(gap):.2f} |"
        )
    return rows


def shortcuts() -> list[str]:
    """The paper's shortcut put into the published forward map."""
    rows = []
    for yaw in ANGLES:
        cells = []
        for roll in ANGLES:
            x = target(yaw, roll)
            tip, psi, phi = miss(h6ar, shortcut(x), x)
            cells.append(f"{tip:.2f}, {psi:.2f}, {phi:.2f}")
        rows.append(f"| {yaw} | " + " | ".join(cells) + " |")
    return rows


@pytest.mark.parametrize("rows", [models, shortcuts])
def test_the_page_has_these_figures(rows) -> None:
    page = PAGE.read_text("utf-8")
    assert [row for row in rows() if row not in page] == []


def test_the_shortcut_is_exact_without_yaw_and_roll_and_nowhere_else() -> None:
    assert max(map(abs, miss(h6ar, shortcut(target(0, 0)), target(0, 0)))) < 1e-9
    for yaw in ANGLES:
        for roll in ANGLES:
            x = target(yaw, roll)
            tip, psi, phi = miss(h6ar, shortcut(x), x)
            assert tip > 0.005 and max(abs(psi), abs(phi)) > 0.005
            assert max(map(abs, miss(h6ar, elbow_up(h6ar, x), x))) < 1e-9


def test_middle_and_averages_differ_as_the_bound_says() -> None:
    """Eq. (7) misses the middle of the tips by at most L1 (1 - cos alpha) + f (1 - cos beta)."""
    rng = np.random.default_rng(0)
    q = rng.uniform(-1, 1, (500, 6))
    q[:, 3:5] = q[:, 1:3] + rng.uniform(-0.3, 0.3, (500, 2))
    gap = h6ar.invariant_point(q) - h6ar.arm_tips(q).mean(-2)
    alpha = (q[:, 1] - q[:, 3]) / 2
    beta = alpha + (q[:, 2] - q[:, 4]) / 2
    bound = L1 * (1 - np.cos(alpha)) + np.hypot(L2, A3) * (1 - np.cos(beta))
    found = np.linalg.norm(gap, axis=-1)
    assert (found <= bound + 1e-15).all() and (found > 0.99 * bound).any()


if __name__ == "__main__":
    print("\n".join([*models(), "", *shortcuts()]))
