"""A head that parallelograms keep level, as that of a palletizing arm."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of
from places import TESTS

from closedform import prove

TEXT = (TESTS / "held_out_loops" / "palletizer.toml").read_text("utf-8")
OK = 0


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("palletizer")
    return derived("palletizer", script_of("palletizer", TEXT, folder), folder)


def missed(v, p: np.ndarray, u: np.ndarray) -> list[float]:
    """By how much the upper arm, the forearm and its rod miss, if the head is level."""
    q, forearm = u[:2], u[2]
    upper, lever, ahead = np.exp(1j * np.array([q[0] + np.pi / 2, q[1], forearm]))
    wrist = complex(*p) - v.c + 1j * v.a
    gap = v.u * upper + v.f * ahead - wrist
    rod = v.u * upper - v.a * ahead + v.a * lever
    return [gap.real, gap.imag, abs(rod) - v.u]


def targets(count: int) -> np.ndarray:
    return np.random.default_rng(1).uniform((0.3, -0.5), (1.6, 1.2), (count, 2))


def test_newton_finds_no_joints_that_the_closed_form_lacks(arm: ModuleType) -> None:
    rng, v, met = np.random.default_rng(2), arm.Parameters(), 0
    for p in targets(25):
        q, status = arm.ik(p)
        assert q.shape == (4, 2) and (status != OK).sum() % 2 == 0
        for start in rng.uniform(-3, 3, (8, 3)):
            u = newton(lambda u: np.array(missed(v, p, u)), start)  # noqa: B023
            if u is not None:
                met += 1
                assert np.nanmin(np.abs(np.exp(1j * q) - np.exp(1j * u[:2])).max(axis=1)) < 1e-6
    assert met > 80


def test_all_level_postures_lead_back(arm: ModuleType) -> None:
    wrist, tip = (arm.SKELETON.points.index(name) for name in "WP")
    v, level = arm.Parameters(), 0
    for q in np.random.default_rng(3).uniform(-3, 3, (40, 2)):
        p, status = arm.fk(q)
        for x, at in zip(p[status == OK], arm.skeleton(q)[status == OK], strict=True):
            if np.allclose((at[tip] - at[wrist])[:2], [v.c, -v.a], atol=1e-9):
                level += 1
                back, _ = arm.ik(x)
                assert np.nanmin(np.abs(np.exp(1j * back) - np.exp(1j * q)).max(axis=1)) < 1e-6
                for row in back[np.isfinite(back).all(axis=1)]:
                    assert np.nanmin(np.abs(arm.fk(row).p - x).max(axis=1)) < 1e-9
    assert level > 60


def test_sides_of_other_lengths_keep_nothing_level(tmp_path: Path) -> None:
    text = TEXT.replace('r2 = {length = "f"}', 'r2 = {length = "u"}')
    d = read_script(script_of("bent", text, tmp_path))
    assert [i.function for i in prove(d).inverses] == ["fk"]
