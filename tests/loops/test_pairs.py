"""The degree of three pairs of legs, against the complex postures that Newton's method finds."""

from pathlib import Path

import numpy as np
import pytest
from loop_files import read_script, script_of

from closedform.loops.pairs import degree_of_pairs

OCTAHEDRON = """
hand = "P"
copies = 3
[bodies]
ground = {A1 = [1, 0, 0], B1 = [-0.5, "sqrt(3)/2", 0]}
hand = {P = [0, 0, 0], C1 = [0.25, "sqrt(3)/4", 0]}
t1 = {}
t2 = {}
p1 = {}
p2 = {}
[joints]
a1 = {between = ["ground", "t1"], at = "A1", kind = "universal"}
a2 = {between = ["ground", "t2"], at = "B1", kind = "universal"}
q1 = {between = ["t1", "p1"], at = "A1", kind = "prismatic", driven = true}
q2 = {between = ["t2", "p2"], at = "B1", kind = "prismatic", driven = true}
c1 = {between = ["p1", "hand"], at = "C1", kind = "spherical"}
c2 = {between = ["p2", "hand"], at = "C1", kind = "spherical"}
"""


def found(pairs: list[tuple[int, int]], rng: np.random.Generator) -> int:
    """How many complex postures there are: angles on the circles, by their cosines and sines."""
    near = rng.normal(size=(6, 3))
    circles = []
    for a, b in pairs:
        along = (near[b] - near[a]) / np.linalg.norm(near[b] - near[a])
        x = np.cross(along, rng.normal(size=3))
        x /= np.linalg.norm(x)
        centre, size = near[a] + rng.uniform(0.2, 1) * along, rng.uniform(0.5, 1.5)
        circles.append((centre, size * x, size * np.cross(along, x)))
    squares = rng.uniform(1, 3, 3)

    def missed(u: np.ndarray) -> np.ndarray:
        """For rows of three pairs of a cosine and a sine."""
        at = [
            c + u[:, 2 * k, None] * x + u[:, 2 * k + 1, None] * y
            for k, (c, x, y) in enumerate(circles)
        ]
        gaps = [((at[i] - at[j]) ** 2).sum(-1) for i, j in ((0, 1), (1, 2), (2, 0))]
        units = [u[:, 2 * k] ** 2 + u[:, 2 * k + 1] ** 2 - 1 for k in range(3)]
        return np.stack([*(g - s for g, s in zip(gaps, squares, strict=True)), *units], -1)

    u = rng.normal(size=(4000, 6)) + 1j * rng.normal(size=(4000, 6))
    with np.errstate(all="ignore"):
        for _ in range(60):
            steps = 1e-6 * np.eye(6)
            J = np.stack([(missed(u + s) - missed(u - s)) / 2e-6 for s in steps], -1)
            good = np.isfinite(J).all(axis=(1, 2)) & (np.abs(np.linalg.det(J)) > 1e-12)
            u, J = u[good], J[good]
            u = u - np.linalg.solve(J, missed(u)[..., None])[..., 0]
    u = u[np.isfinite(u).all(axis=1)]
    u = u[(np.abs(missed(u)).max(axis=1) < 1e-9) & (np.abs(u).max(axis=1) < 1e3)]
    distinct: list[np.ndarray] = []
    for row in u:
        if all(np.abs(row - other).max() > 1e-5 for other in distinct):
            distinct.append(row)
    return len(distinct)


@pytest.mark.parametrize(
    ("pairs", "degree"),
    [
        ([(0, 1), (2, 3), (4, 5)], 16),
        ([(0, 1), (1, 2), (2, 0)], 16),
        ([(0, 1), (0, 2), (0, 3)], 16),
        ([(0, 1), (0, 1), (2, 3)], 8),
    ],
)
def test_newton_finds_as_many_complex_postures(pairs: list, degree: int) -> None:
    assert degree_of_pairs(pairs) == degree
    assert found(pairs, np.random.default_rng(degree)) == degree


def test_an_octahedral_platform_is_told_its_degree(tmp_path: Path) -> None:
    d = read_script(script_of("octahedron", OCTAHEDRON, tmp_path))
    (step,) = (s for s in d.steps if s.title.startswith("Forward"))
    assert step.title == "Forward: an equation of degree 16"
    assert "degree 16" in next(f.notes[-1] for f in d.functions if f.name == "ik")
