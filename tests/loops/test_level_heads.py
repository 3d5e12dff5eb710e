"""A head that parallelograms keep level, as that of a palletizing arm."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of
from places import TESTS

from closedform import prove

TEXT = (TESTS / "held_out_loops" / "palletizer.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR = range(3)


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


def test_a_relay_rod_that_stays_parallel_has_an_inverse(tmp_path: Path) -> None:
    """Its joint turns on the circle of the pitman arm, moved along the relay rod."""
    text = (TESTS / "held_out_loops" / "idler_steering.toml").read_text("utf-8")
    gear = derived("gear", script_of("gear", text, tmp_path), tmp_path, crosscheck=True)
    q = np.random.default_rng(5).uniform(-np.pi, np.pi, 2000)
    joint = -0.3 - 0.15j * np.exp(1j * q) + 0.15 - 0.02j
    away, arm = joint + 0.7, np.abs(0.05 - 0.14j)
    share = (arm**2 + np.abs(away) ** 2 - 0.5**2) / (2 * arm * np.abs(away))
    reached = np.abs(share) < 1
    count = 0
    for sign in (1, -1):
        swing = sign * np.arccos(share[reached]) - np.angle(0.05 - 0.14j)
        turn = np.angle(away[reached]) + swing
        answers, status = gear.ik(turn[:, None])
        assert (status <= SINGULAR).all() and (status != UNREACHABLE).all()
        off = np.abs(np.angle(np.exp(1j * (answers[..., 0] - q[reached, None]))))
        assert (off.min(axis=1) < 1e-6).all() and np.median(off.min(axis=1)) < 1e-14
        again = gear.fk(answers[status == OK]).p[..., 0]
        at = np.repeat(turn[:, None], 2, axis=1)[status == OK]
        gap = np.abs(np.angle(np.exp(1j * (again - at[:, None]))))
        assert (np.nanmin(gap, axis=1) < 1e-12).all()
        count += len(again)
    assert count > 2000


def test_arms_that_no_motor_turns_carry_a_level_table(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops" / "tail_lift.toml").read_text("utf-8")
    lift = derived("tail", script_of("tail", text, tmp_path), tmp_path)
    arm = np.random.default_rng(6).uniform(-1, 1, 500)
    end = 0.8 * np.exp(1j * arm)
    q = np.abs(end - 1 + 0.4j)
    away = end + 0.4 + 0.1j - 1.6  # the rod, from the pivot of the lever
    share = (0.3**2 + np.abs(away) ** 2 - 0.5**2) / (2 * 0.3 * np.abs(away))
    met = np.abs(share) < 1
    psi = np.angle(away[met]) + np.arccos(share[met]) - np.pi / 2
    answers, status = lift.ik(psi[:, None])
    assert met.sum() > 100 and (status != UNREACHABLE).any(axis=1).all()
    assert (np.abs(answers[..., 0] - q[met, None]).min(axis=1) < 1e-9).all()
