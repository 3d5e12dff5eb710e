"""Robots whose tables were set aside while the chains were written, in ``tests/held_out``.

A few are derived here; ``python -m benchmarks.robots`` derives those in ``benchmarks/arms``.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arms import OK, SINGULAR, misses
from chains import printed
from places import TESTS

from closedform.pipeline import scripts
from closedform.pipeline.trial import fault
from closedform.scaffold.new import InverseSearch, Script, new

FOLDER = TESTS / "held_out"
FOUND = {
    "al5d": ("axes 2 and 3 parallel, and 1 joint that turns the tool", 2),
    "hp6": ("turret and two parallel joints, with a spherical wrist", 8),
    "m16ib": ("turret and two parallel joints, with a spherical wrist", 8),
    "nao_arm": ("a turret and a joint, and 2 joints that turn the tool", 2),
    "nao_leg": ("spherical shoulder, axes 5 and 4 parallel", 8),
    "pr2": ("spherical wrist, axes 3 and 4 meet, with t1 given", 8),
    "phantomx": ("axes 2 and 3 parallel, and 1 joint that turns the tool", 2),
    "s4_abb_2p8": ("turret and two parallel joints, with a spherical wrist", 8),
    "wam": ("spherical wrist, axes 1 and 2 meet, with t3 given", 8),
    "youbot": ("axes 2 and 3 parallel, and 2 joints that turn the tool", 4),
}
REFUSED = {
    "baxter": "none of its seven joints, if it is given, leaves a spherical wrist or shoulder",
    "mico": "no three neighbouring axes meet in a point or are parallel",
    "sawyer": "none of its seven joints, if it is given, leaves a spherical wrist or shoulder",
}
DERIVED = ("nao_arm", "nao_leg", "youbot")
"""Those that the tests print and run."""


def script(name: str, given: str = "") -> Script:
    path = FOLDER / f"{name}.csv"
    modified = "# convention: modified" in path.read_text("utf-8")
    return new(name, "dh", path, modified=modified, search=InverseSearch(fault=fault, given=given))


def test_every_file_has_a_source_and_an_outcome() -> None:
    files = {path.stem: path.read_text("utf-8") for path in FOLDER.iterdir()}
    assert files.keys() == FOUND.keys() | REFUSED.keys()
    assert all("# source: https://" in text for text in files.values())


@pytest.mark.parametrize("name", sorted(FOUND.keys() - set(DERIVED)))
def test_an_inverse_is_proposed_and_proved(name: str) -> None:
    """``new`` proves what it proposes."""
    structure, branches = FOUND[name]
    found = script(name)
    assert found.structure == structure
    assert f"{branches} branches" in found.inverse


def test_the_upper_arm_of_a_pr2_may_be_given() -> None:
    """Whether its elbow can come to the second axis was asked of sines that had no number."""
    found = script("pr2", "t3")
    assert found.structure.endswith("axes 1, 2 and 4 neither meet nor are parallel, with t3 given")
    assert "8 branches" in found.inverse


@pytest.mark.parametrize("name", REFUSED)
def test_an_arm_without_a_known_chain_is_told_why(name: str) -> None:
    found = script(name)
    assert REFUSED[name] in found.inverse
    assert "ssik" in found.advice


def table(name: str) -> list[list[Any]]:
    lines = (FOLDER / f"{name}.csv").read_text("utf-8").splitlines()
    return [line.split(", ") for line in lines if not line.startswith("#")][1:]


def pose(name: str, q: np.ndarray) -> np.ndarray:
    """The pose, read from the file as numbers."""
    modified = "# convention: modified" in (FOLDER / f"{name}.csv").read_text("utf-8")
    joints = {f"t{k + 1}": q[..., k] for k in range(q.shape[-1])}
    T = np.eye(4)
    for row in table(name):
        a, alpha, d, theta = (
            eval(cell, {"pi": np.pi} | joints) * np.ones(q.shape[:-1]) for cell in row
        )
        along, about = motion(a, alpha, 0), motion(d, theta, 2)
        T = T @ (along @ about if modified else about @ along)
    return T


def motion(length: np.ndarray, angle: np.ndarray, axis: int) -> np.ndarray:
    """A turn about x (0) or z (2), and a shift along it."""
    T = np.zeros((*np.shape(angle), 4, 4))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    c, s = np.cos(angle), np.sin(angle)
    T[..., i, i], T[..., i, j], T[..., j, i], T[..., j, j] = c, -s, s, c
    T[..., axis, axis] = T[..., 3, 3] = 1
    T[..., axis, 3] = length
    return T


@pytest.mark.parametrize("name", DERIVED)
def test_the_printed_inverse_returns_to_every_posture(name: str, tmp_path: Path) -> None:
    structure, branches = FOUND[name]
    found = script(name)
    assert found.structure == structure
    path = tmp_path / f"{name}.py"
    path.write_text(found.text, "utf-8")
    (source,) = scripts.find([str(path)])
    module = printed(scripts.load(source), tmp_path / "printed")
    q = np.random.default_rng(11).uniform(-3, 3, (200, len(module.JOINTS)))
    T = pose(name, q)
    np.testing.assert_allclose(module.pose(q), T, atol=1e-14)
    answers, status = module.ik(T)
    assert len(module.BRANCHES) == branches
    assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
    away, turned = misses(pose(name, answers), T, status)
    assert away < 1e-12 and turned < 1e-12
    same = np.abs(np.exp(1j * answers) - np.exp(1j * q[:, None])).max(axis=-1)
    assert (np.nanmin(same, axis=-1) < 1e-6).all()
