"""The benchmarks: the comparison of inverses notices errors, and the accuracy is bounded."""

import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import libraries
import numpy as np
import pytest
from closedform.generated.numpy import puma560
from flint import arb
from places import ROOT

from benchmarks import accuracy, batches, inverses, native, solvers
from benchmarks.cases import CASES, check


def test_table_is_the_arm():
    q = np.random.default_rng(0).uniform(-3, 3, (20, 6))
    np.testing.assert_allclose(solvers.pose(q), puma560.fk(q), atol=1e-14)


@pytest.mark.parametrize("near", [False, True])
@pytest.mark.parametrize("kind", inverses.SINGULARITIES)
def test_poses_are_singular(kind, near):
    T = inverses.singular_poses(kind, near)
    q, _ = puma560.ik(T)
    factors = np.array(puma560.singularities(q))[..., puma560.SINGULARITIES.index(kind)]
    # At the shoulder and the elbow the factor is the root of how far the pose is out of reach.
    least = np.nanmin(abs(factors), axis=-1)
    assert least.max() < 2e-6
    assert (least > 1e-13).any() or not near


BY_HAND = [case for case in CASES if Path(native.HERE, "limits", f"{case.full}.c").exists()]


@pytest.mark.skipif(not libraries.compiles(), reason="needs gcc for x86-64")
@pytest.mark.parametrize("case", BY_HAND, ids=lambda case: case.full)
def test_kernels_by_hand_agree(tmp_path, case):
    """With the printed NumPy, one posture at a time and as planes, in blocks that are not full."""
    inputs = case.inputs(1000)
    expected = case.values(inputs)
    _, values = native.timer("limit", case, "x86-64", tmp_path, inputs)
    assert np.isfinite(expected).any() and values.shape == expected.shape
    check(case, values, expected)
    _, planes = batches.of_planes(native.limit_of_planes, case, "planes", inputs)
    check(case, planes(), expected)


def test_all_functions_have_a_kernel_by_hand():
    assert BY_HAND == CASES


def test_our_inverse_passes():
    solver = replace(solvers.ours_single(), poses=500)
    figures = inverses.on_random_poses(solver) | inverses.on_singularities(solver)
    assert figures["missing"] == figures["wrong"] == 0
    assert all(
        figures[kind + near] == "0" for kind in inverses.SINGULARITIES for near in ("", " near")
    )
    assert max(figures["m"], figures["m, singular"]) < 1e-12
    assert max(figures["rad"], figures["rad, singular"]) < 1e-10


def test_a_flawed_inverse_is_seen():
    whole = solvers.ours_batch(puma560, "numpy", "rows")

    def many(T):
        q, exact = whole.many(T)
        q = q.copy()
        q[:, 1] = np.nan  # a branch is missing
        q[:, 2, 5] += 1e-4  # a branch is not exact, so it counts as missing too
        return q, exact & np.isfinite(q).all(axis=-1)

    figures = inverses.on_random_poses(replace(whole, many=many, poses=50))
    assert (figures["missing"], figures["wrong"]) == (100, 50)
    assert figures["rad"] == pytest.approx(1e-4, rel=1e-3)


def test_inverses_can_be_timed():
    T = np.tile(np.eye(4), (3, 1, 1))
    for solver in (solvers.ours_single(), solvers.ours_batch(puma560, "numpy", "rows")):
        assert inverses.clock(solver.timed(T), len(T))() > 0


def test_tables_of_batches_and_calls():
    """The tables have the peers that are installed; the others are listed with their error."""
    command = [sys.executable, "-m", "benchmarks", "--only", "batch", "--only", "single"]
    command += ["--rounds", "1", "--batch", "2000", "2R"]
    told = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert told.count("| closedform C |") == told.count("| lambdify |") == 3
    assert "| writing alone |" in told or not shutil.which("gcc")


def test_tables_of_array_libraries_and_threads():
    command = [sys.executable, "-m", "benchmarks", "--only", "array", "--only", "threads"]
    command += ["--rounds", "1", "--batch", "2000", "2R"]
    told = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert told.count("| array, NumPy |") == 1 and told.count("| closedform NumPy |") == 2
    assert told.count("| closedform C, 1 |") == 2
    for peer in ("array, jax.jit", "numba, 1"):
        assert f"| {peer} |" in told or f"- {peer}: ModuleNotFoundError" in told


def test_what_is_no_pose():
    mirrored = np.diag([1.0, 1, -1, 1])[None]
    assert inverses.verdicts(solvers.ours_single(), mirrored) == "INVALID"


def test_ulps_at_a_power_of_two():
    below = arb(1) / 2 - arb(2) ** -200  # its binade has half the spacing of that of 1/2
    assert accuracy.ulps(0.5 + 2**-53, below, "double") == pytest.approx(2)
    assert accuracy.ulps(0.5 + 2**-53, arb(1) / 2, "double") == pytest.approx(1)
    assert accuracy.ulps(5e-324, arb(0), "double") == pytest.approx(1)
    assert accuracy.ulps(1e-45, arb(0), "float") < 1


@pytest.mark.skipif(
    not shutil.which("gcc") or np.finfo(np.longdouble).nmant < 63, reason="no gcc or no wider type"
)
def test_accuracy_of_a_small_sample():
    command = [sys.executable, "-m", "benchmarks.accuracy", "--samples", "100000", "--keep", "20"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("| 100,000 |") == 12
