"""Compares the inverse of the Puma 560 with other analytic solvers, on the same poses.

Each solver is first examined in its own process, so that none can stop the others by failing,
crashing or hanging: does it find all branches, how exact are they, which poses does it lose at the
singularities, and what does it do with a matrix that is not a pose. Those that pass are timed in
turns. ``python -m benchmarks.inverses EAIK`` examines one solver.
"""

from __future__ import annotations

import itertools
import json
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from closedform.generated.c import puma560 as compiled

from . import native
from .cases import check
from .solvers import (
    CASE,
    MOST,
    PEERS,
    SOLVERS,
    TOOLBOX_C,
    A,
    Answers,
    D,
    InvalidPoseError,
    Solver,
    pose,
    toolbox_run,
)

TOLERANCE = 1e-6  # m and rad: a solution or a branch further away does not count
SECONDS = 300  # time limit for the examination of one solver
SINGULAR_POSES = 200
SINGULARITIES = ("elbow", "shoulder", "wrist")
BATCH = 50_000
ROOT = Path(__file__).parents[1]

__all__ = ["PEERS", "compare"]


def residuals(q: np.ndarray, T: np.ndarray) -> Answers:
    """Distance in m and angle in rad between the poses of joints (n, k, 6) and T (n, 4, 4)."""
    gap = pose(q) - T[:, None]
    turn = np.linalg.norm(gap[..., :3, :3], axis=(-2, -1)) / np.sqrt(8)
    return np.linalg.norm(gap[..., :3, 3], axis=-1), 2 * np.arcsin(np.minimum(turn, 1))


def random_poses(n: int) -> tuple[np.ndarray, np.ndarray]:
    q = np.random.default_rng(11).uniform(-np.pi, np.pi, (n, 6))
    return q, compiled.fk(q)


def singular_poses(name: str, near: bool) -> np.ndarray:
    """Poses on a singularity to the last digit of the joints, or within 1e-6 at all scales."""
    rng = np.random.default_rng(5)
    q = rng.uniform(-np.pi, np.pi, (SINGULAR_POSES, 6))
    other = np.pi * (np.arange(len(q)) % 2)  # stretched or folded, before or behind, 0 or pi
    off = rng.choice([-1, 1], len(q)) * 10 ** rng.uniform(-12, -6, len(q)) * near
    a2, a3, d4 = A[1], A[2], D[3]
    c, s = np.cos(q[:, 2]), np.sin(q[:, 2])
    if name == "elbow":
        q[:, 2] = np.arctan2(-d4, a3) + other + off
    elif name == "shoulder":
        q[:, 1] = np.arctan2(a2 + a3 * c - d4 * s, a3 * s + d4 * c) + other + off
    else:
        q[:, 4] = other + off
    return compiled.fk(q)


def same(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return (abs(np.remainder(a - b + np.pi, 2 * np.pi) - np.pi) < TOLERANCE).all(axis=-1)


def all_branches(q: np.ndarray, T: np.ndarray) -> np.ndarray:
    """Eight different solutions of each pose (the maximum), verified with the table."""
    branches, _ = compiled.ik(T)
    distance, turn = residuals(branches, T)
    twins = same(branches[:, :, None], branches[:, None]).sum(axis=(1, 2)) != 8
    known = same(branches, q[:, None]).any(axis=1)
    if not (known.all() and not twins.any() and max(distance.max(), turn.max()) < TOLERANCE):
        raise AssertionError("the eight branches to compare with are wrong")
    return branches


def on_random_poses(solver: Solver) -> dict[str, Any]:
    missing, wrong, worst = 0, 0, [0.0, 0.0]
    joints, poses = random_poses(solver.poses)
    for i in range(0, len(poses), 2000):
        T = poses[i : i + 2000]
        branches = all_branches(joints[i : i + 2000], T)
        q, exact = solver.many(T)
        missing += int((~same(branches[:, :, None], q[:, None]).any(axis=2)).sum())
        distance, turn = residuals(q, T)
        wrong += int((exact & ~((distance < TOLERANCE) & (turn < TOLERANCE))).sum())
        for k, size in enumerate((distance, turn)):
            worst[k] = max(worst[k], float(size[exact].max(initial=0)))
    return {"poses": len(poses), "missing": missing, "wrong": wrong, "m": worst[0], "rad": worst[1]}


def on_singularities(solver: Solver) -> dict[str, Any]:
    """The number of lost poses, and the largest residuals of the best answers to the others.

    A second number in parentheses counts poses without a solution that is said to be exact.
    """
    figures: dict[str, Any] = {"m, singular": 0.0, "rad, singular": 0.0}
    for kind, near in itertools.product(SINGULARITIES, ("", " near")):
        T = singular_poses(kind, bool(near))
        q, exact = solver.many(T)
        distance, turn = residuals(q, T)
        solved = (distance < TOLERANCE) & (turn < TOLERANCE)
        some, said = (len(T) - found.any(axis=1).sum() for found in (solved, solved & exact))
        figures[kind + near] = f"{some}" if some == said else f"{some} ({said})"
        for key, size in (("m, singular", distance), ("rad, singular", turn)):
            best = np.where(solved, size, np.inf).min(axis=1)
            figures[key] = max(figures[key], float(best[solved.any(axis=1)].max(initial=0)))
    return figures


def verdicts(solver: Solver, T: np.ndarray) -> str:
    """The results for matrices that are not poses, and how often each occurs."""
    counts: Counter[str] = Counter()
    for matrix in T:
        try:
            q, exact = solver.many(matrix[None])
        except InvalidPoseError:
            counts["INVALID"] += 1
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # a Rust panic is not an Exception
            counts[type(error).__name__] += 1
        else:
            finite = np.isfinite(q).all(axis=-1)
            said = "solutions" if (exact & finite).any() else "NaN" if exact.any() else "none"
            counts["least squares" if said == "none" and finite.any() else said] += 1
    return ", ".join(f"{n} {said}" if len(counts) > 1 else said for said, n in counts.items())


def examine(name: str) -> dict[str, Any]:
    solver = SOLVERS[name]()
    figures = on_random_poses(solver) | on_singularities(solver)
    T = random_poses(12)[1]
    broken = T.copy()
    broken.reshape(-1, 16)[np.arange(12), np.arange(12)] = np.nan
    mirror = T @ np.diag([1.0, 1, -1, 1])
    return {**figures, "mirrored": verdicts(solver, mirror), "NaN": verdicts(solver, broken)}


def examined(name: str) -> dict[str, Any]:
    command = [sys.executable, "-m", "benchmarks.inverses", name]
    done = subprocess.run(
        command, cwd=ROOT, capture_output=True, text=True, timeout=SECONDS, check=False
    )
    if done.returncode:
        said = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
        raise RuntimeError(said[-1])
    figures: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return figures


def rows(report: Any, found: dict[str, dict[str, Any]], columns: dict[str, str]) -> None:
    report.write("\n| solver | " + " | ".join(columns) + " |")
    report.write("|---|" + "---:|" * len(columns))
    for name, figures in found.items():
        cells = (figures[key] for key in columns.values())
        words = (
            f"{c:.1e}" if isinstance(c, float) else f"{c:,}" if isinstance(c, int) else c
            for c in cells
        )
        report.write(f"| {name} | " + " | ".join(words) + " |")


def clock(run: Callable[[], object], poses: int) -> Callable[[], float]:
    def timed() -> float:
        run()  # brings its code and data back into the caches after the others' turns
        start = time.perf_counter_ns()
        run()
        return (time.perf_counter_ns() - start) / poses / 1000

    return timed


def from_c(report: Any, rounds: int, peer: bool) -> None:
    inputs = np.ascontiguousarray(random_poses(512)[1].reshape(512, 16))
    for label, target in native.TARGETS.items():
        with tempfile.TemporaryDirectory() as folder:
            ours, values = native.timer("closedform", CASE, target, Path(folder), inputs)
        check(CASE, values, CASE.values(inputs))
        competitors = {"closedform C": lambda ours=ours: ours() / 1000}
        if peer:
            run, out = toolbox_run(target), np.empty(MOST * 6 + 1)
            competitors[TOOLBOX_C] = lambda run=run, out=out: (
                run(inputs, out, 16, 0, 512, 20) / 1000
            )
        report.table(f"one call from C, {label}", "us per pose", competitors, rounds)


def compare(report: Any, rounds: int) -> None:
    report.write("\n## All eight solutions of a pose of the Puma 560\n")
    found, failures = {}, []
    for name in SOLVERS:
        try:
            found[name] = examined(name)
        except subprocess.TimeoutExpired:
            failures.append(f"- {name}: not examined within {SECONDS} s")
        except Exception as error:
            failures.append(f"- {name}: {str(error)[:150]}")
    report.write(
        "Random poses: a branch is missing if no answer is within 1e-6 rad of it. An answer is "
        "wrong if the solver says that it is exact, but it is more than 1e-6 m or rad away from "
        "the pose. Singularities: the best answer to each pose."
    )
    columns = {"poses": "poses", "missing branches": "missing", "wrong answers": "wrong"}
    columns |= {"largest residual, m": "m", "rad": "rad"}
    columns |= {"at singularities, m": "m, singular", " rad": "rad, singular"}
    rows(report, found, columns)
    report.write(
        f"\nLost poses, of {SINGULAR_POSES}, exactly on the singularity and within 1e-6 rad of it: "
        "no answer is within 1e-6 m and rad. The number in brackets also counts poses for which "
        "only least-squares answers are that close. The last columns show the result for a "
        "mirrored rotation and for NaN."
    )
    kinds = [kind + near for kind in SINGULARITIES for near in ("", " near")]
    rows(report, found, {kind: kind for kind in [*kinds, "mirrored", "NaN"]})
    report.write()
    for failure in failures:
        report.write(failure)
    try:
        from_c(report, rounds, TOOLBOX_C in found)
    except Exception as error:
        report.write(f"- one call from C: {error}")
    for batch, title in ((False, "one call from Python"), (True, f"batch of {BATCH:,}")):
        T = random_poses(BATCH if batch else 200)[1]
        competitors = {}
        for name in found:
            try:
                solver = SOLVERS[name]()
                if solver.batch == batch and name != TOOLBOX_C:
                    competitors[name] = clock(solver.timed(T), len(T))
            except Exception as error:
                report.write(f"- {name}: {error}")
        report.table(title, "us per pose", competitors, rounds)


if __name__ == "__main__":
    print(json.dumps(examine(sys.argv[1])))
