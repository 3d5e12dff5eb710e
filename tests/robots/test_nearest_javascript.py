"""``nearest`` of the JavaScript package: the answers of the Python robots."""

from __future__ import annotations

import json
import shutil
import subprocess

import numpy as np
import pytest
from places import ROOT

import closedform
from closedform.robots import Robot

INDEX = ROOT / "generated" / "js" / "index.js"
SEVEN = ("franka_arm", "srs_arm")
"""Those whose inverse takes a number besides the target."""
NAMES = ("hybrid_five_bar", "irb260", "planar_2r", "puma560", "spherical_wrist", "ur_arm")
SCRIPT = """
import * as closedform from "INDEX";
import { readFileSync } from "node:fs";
const cases = JSON.parse(readFileSync(0, "utf8"));
const found = cases.map(({ name, x, seed, limits, weights, parameters, given }) =>
    closedform.nearest(closedform[name], x, seed, { limits, weights, given }, parameters));
process.stdout.write(JSON.stringify(found));
"""
pytestmark = pytest.mark.skipif(shutil.which("node") is None, reason="Node is not installed")


def answers(cases: list[dict[str, object]]) -> list[dict[str, object]]:
    script = SCRIPT.replace("INDEX", INDEX.as_uri())
    done = subprocess.run(
        ["node", "--input-type=module", "-e", script],
        input=json.dumps(cases), capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def robot(name: str, parameters: dict[str, float] | None = None) -> Robot:
    module = getattr(closedform, name)
    n = len(module.JOINTS)
    return Robot(module, parameters, limits=(np.full(n, -4.0), np.full(n, 4.5)))


def case(arm: Robot, x: np.ndarray, seed: np.ndarray, weights: np.ndarray) -> dict[str, object]:
    return {
        "name": arm.name,
        "x": np.asarray(x).ravel().tolist(),
        "seed": list(seed),
        "limits": [arm.limits.lower.tolist(), arm.limits.upper.tolist()],
        "weights": list(weights),
        "parameters": arm.parameters._asdict(),
    }


def giving(arm: Robot, q: np.ndarray) -> dict[str, float]:
    return {"given": float(arm.given_at(q))} if arm.given else {}


def test_regular_targets() -> None:
    rng = np.random.default_rng(0)
    cases, expected = [], []
    for name in NAMES + SEVEN:
        arm = robot(name)
        for _ in range(20):
            q = rng.uniform(-1, 1, len(arm.joints))
            x = arm.fk(q)
            x = x.p[0] if hasattr(x, "p") else x
            if not np.isfinite(x).all():
                continue
            n = len(arm.joints)
            seed, weights = rng.uniform(-5, 5, n), rng.uniform(0.5, 2, n)
            for given in (giving(arm, q), {}) if arm.given else ({},):
                cases.append(case(arm, x, seed, weights) | given)
                expected.append(arm.nearest(x, seed, weights=weights, **given))
    for found, right in zip(answers(cases), expected, strict=True):
        assert found["branch"] == right.branch and found["status"] == right.status
        assert found["outside"] == right.outside.tolist()
        if right.branch >= 0:
            assert np.abs(np.array(found["q"]) - right.q).max() < 1e-8
            assert found["distance"] == pytest.approx(right.distance)


def test_free_joints_keep_their_values() -> None:
    rng = np.random.default_rng(1)
    chosen = [
        ("puma560", None, [0.3, -0.5, 0.4, 0.6, 0.0, 0.8], 3),
        ("spherical_wrist", None, [0.6, 0.0, 0.8], 0),
        ("planar_2r", {"l1": 1.0, "l2": 1.0}, [0.4, np.pi], 0),
        ("ur_arm", None, [0.3, -1.1, 0.9, 0.4, 0.0, 0.7], None),
        ("franka_arm", None, [0.3, 0.0, 0.4, -1.6, 0.7, 1.9, 0.8], 0),
        ("franka_arm", None, [0.3, 0.5, 0.4, 0.0, 0.7, 1.9, 0.8], None),
        ("srs_arm", None, [0.3, 0.0, 0.4, -1.2, 0.7, 0.9, 0.8], 0),
        ("srs_arm", None, [0.3, 0.7, 0.4, -1.2, 0.7, 0.0, 0.8], 4),
        ("srs_arm", None, [0.3, 0.0, 0.4, -1.2, 0.7, 0.0, 0.8], None),
    ]
    cases, expected = [], []
    for name, parameters, q, kept in chosen:
        arm = robot(name, parameters)
        seed = np.array(q) + rng.normal(0, 0.05, len(q))
        cases.append(case(arm, arm.fk(q), seed, np.ones(len(q))) | giving(arm, q))
        expected.append((arm, arm.fk(q), seed, kept))
    arm = robot("irb260")
    x, seed = np.array([0.0, 0.0, 0.9, 0.4]), np.array([1.0, 0.6, 2.3, -0.5])
    cases.append(case(arm, x, seed, np.ones(4)))
    expected.append((arm, x, seed, 0))
    for one, found, (arm, x, seed, kept) in zip(cases, answers(cases), expected, strict=True):
        q, given = np.array(found["q"]), one.get("given")
        assert found["status"] == 2 and np.abs(arm.fk(q) - x).max() < 1e-11
        assert kept is None or q[kept] == seed[kept]
        assert given is None or abs(arm.given_at(q) - given) < 1e-11
        assert found["distance"] <= arm.nearest(x, seed, given=given).distance * 1.001 + 1e-9


@pytest.mark.parametrize("given", [{}, {"given": 0.0}, {"given": 0.8}])
def test_a_wrist_above_the_shoulder_has_no_arm_angle_but_a_posture(given: dict) -> None:
    arm = robot("srs_arm")
    q = np.array([0.5, np.arctan2(np.sin(1.4), 1 + np.cos(1.4)), 0.0, 1.4, 0.0, 0.9, 0.0])
    seed = q + 0.1 * np.eye(7)[0]  # the elbow can go round: theta1 is free
    (found,) = answers([case(arm, arm.fk(q), seed, np.ones(7)) | given])
    assert found["status"] == 2 and found["q"][0] == seed[0]
    assert np.abs(arm.fk(found["q"]) - arm.fk(q)).max() < 1e-11
    assert np.abs(found["q"] - q).max() < 0.2


def test_what_is_not_a_target() -> None:
    arm = robot("planar_2r")
    far = case(arm, np.array([99.0, 0.0]), np.zeros(2), np.ones(2))
    (found,) = answers([far])
    assert (found["branch"], found["status"]) == (-1, 1) and found["q"] == [None, None]
    with pytest.raises(AssertionError, match="nearest: seed has length 3, expected 2"):
        answers([{**far, "seed": [0, 0, 0]}])
    with pytest.raises(AssertionError, match="nearest: the inverse takes the target only"):
        answers([{**far, "given": 0.1}])


def test_rounding_of_a_singular_target_does_not_turn_the_wrist() -> None:
    arm = robot("puma560")
    q = np.random.default_rng(3).uniform(-2.5, 2.5, (20000, 6)) * [1, 1, 1, 1, 0, 1]
    others = np.abs(arm.singularities(q)[:, :2]).min(-1)
    q = q[(others > 1e-3) & (others < 0.03)]
    found = answers([case(arm, x, seed, np.ones(6)) for x, seed in zip(arm.fk(q), q, strict=True)])
    assert {one["status"] for one in found} == {0, 2}
    assert np.abs(np.array([one["q"] for one in found]) - q).max() < 1e-5


@pytest.mark.parametrize("name", ["puma560", "ur_arm"])
def test_a_seed_close_by_does_not_hide_a_nearer_posture(name: str) -> None:
    """Rounding of the target hides that the wrist is aligned, and the seed is near all the same."""
    arm, random = robot(name), np.random.default_rng(4)
    q = random.uniform(-1.5, 1.5, (60, 6))
    q[:, 4] = 10 ** random.uniform(-15, -13, 60)
    x, seeds = arm.fk(q), q + random.uniform(-2e-3, 2e-3, (60, 6))
    found = answers([case(arm, *each, np.ones(6)) for each in zip(x, seeds, strict=True)])
    distances = np.linalg.norm(np.array([one["q"] for one in found]) - seeds, axis=1)
    assert (distances < arm.nearest(x, seeds).distance + 1e-6).all()
    assert sum(one["status"] == 0 for one in found) > 5
