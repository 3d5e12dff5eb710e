"""Real arms whose wrist comes to the axis of a joint before it, where joints lose their digits."""

from typing import Any

import numpy as np
import pytest
from arms import OK, SINGULAR, misses
from chains import printed
from places import ROOT
from test_urdf import forward

from closedform.pipeline import scripts
from closedform.pipeline.trial import fault
from closedform.scaffold.new import InverseSearch, new

FOLDER = ROOT / "benchmarks" / "arms"
NEARLY = {"talos_left": [(2,), (1, 2), (1, 2, 4)], "rm75": [(3,), (1, 3), (1, 3, 5)]}
"""Joints that are brought near 0 together: the elbow, the shoulder and the wrist."""
GIVEN = {"talos_left": {}, "rm75": {"joint3": 2}}


@pytest.fixture(scope="module", params=NEARLY)
def robot(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple:
    name, folder = request.param, tmp_path_factory.mktemp(request.param)
    script = new(name, "urdf", FOLDER / f"{name}.urdf", search=InverseSearch(fault=fault))
    path = folder / f"{name}.py"
    path.write_text(script.text, "utf-8")
    (source,) = scripts.find([str(path)])
    return name, printed(scripts.load(source), folder / "printed")


def solved(name: str, module: Any, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    T = module.pose(q)
    answers, status = module.ik(T, **{joint: q[:, k] for joint, k in GIVEN[name].items()})
    return T, answers, status


def test_the_pose_is_that_of_the_file(robot: tuple) -> None:
    name, module = robot
    text = (FOLDER / f"{name}.urdf").read_text("utf-8")
    for q in np.random.default_rng(1).uniform(-3, 3, (20, len(module.JOINTS))):
        # 1.5708 stands for pi/2
        np.testing.assert_allclose(module.pose(q), forward(text, q), atol=2e-5)


def test_every_posture_is_among_its_solutions(robot: tuple) -> None:
    name, module = robot
    q = np.random.default_rng(2).uniform(-3, 3, (2000, len(module.JOINTS)))
    T, answers, status = solved(name, module, q)
    away, turned = misses(module.pose(answers), T, status)
    assert away < 1e-12 and turned < 1e-12
    same = np.abs(np.exp(1j * answers) - np.exp(1j * q[:, None])).max(axis=-1)
    assert np.nanmin(same, axis=-1).max() < 1e-9


def test_near_straight_elbows_every_pose_has_solutions_that_reach_it(robot: tuple) -> None:
    name, module = robot
    rng = np.random.default_rng(3)
    for joints in NEARLY[name]:
        q = rng.uniform(-3, 3, (2000, len(module.JOINTS)))
        for k in joints:
            q[:, k] = rng.choice([-1, 1], 2000) * 10.0 ** rng.uniform(-14, -2, 2000)
        T, answers, status = solved(name, module, q)
        assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
        away, turned = misses(module.pose(answers), T, status)
        assert away < 5e-13 and turned < 5e-13
