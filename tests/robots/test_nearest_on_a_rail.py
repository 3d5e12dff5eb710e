"""The nearest posture of an arm on a rail, whose place is given: a length, not an angle."""

import ctypes
import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from chains import arm, solved
from sympy import Rational, pi

from closedform.check.runners.python import module
from closedform.emit.pages import pages, shared_files
from closedform.pipeline.run import write
from closedform.proof.prove import Proof
from closedform.robots import Robot
from closedform.scaffold.chains.propose import propose

LANGUAGES = ("numpy", "c", "js")
ROOM = Rational(1, 2)
ROWS = [
    *((0, -pi / 2, None, 0), (ROOM, -pi / 2, 1), (2, 0, 0), (ROOM, -pi / 2, 0)),
    *((0, pi / 2, 2), (0, -pi / 2, 0), (0, 0, 1)),
]
Q = np.array([17.0, 0.3, -0.5, 0.4, 0.6, 0.0, 0.8])
"""The wrist is aligned: theta5 of the arm is free."""
CALL = """
#include "arm_nearest.h"
int call(const real_t *T, const real_t *d1, const real_t *seed, real_t *q, uint8_t *status);
int call(const real_t *T, const real_t *d1, const real_t *seed, real_t *q, uint8_t *status)
{
    const arm_params arm = ARM_DEFAULTS;
    return arm_nearest(&arm, T, d1, seed, NULL, NULL, q, status, NULL);
}
"""
SCRIPT = """
import { nearest } from "FOLDER/_nearest.js";
import * as arm from "FOLDER/arm.js";
import { readFileSync } from "node:fs";
const { T, seed, given } = JSON.parse(readFileSync(0, "utf8"));
process.stdout.write(JSON.stringify(nearest(arm, T, seed, { given })));
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("rail")
    d, serial = arm(ROWS, "d1 t2 t3 t4 t5 t6 t7")
    solved(d, serial, propose(serial).source)
    serial.export(d)
    own = pages(d, Proof(d.name, "own", (), 0, ()), LANGUAGES)
    write(folder, {**own.files, **shared_files([own.share], LANGUAGES)})
    return folder


def by_numpy(folder: Path, T: np.ndarray, seed: np.ndarray, given: float) -> tuple[Any, int]:
    found = Robot(module(folder / "numpy", "arm")).nearest(T, seed, given=given)
    return found.q, int(found.status)


def by_c(folder: Path, T: np.ndarray, seed: np.ndarray, given: float) -> tuple[Any, int]:
    compiler = shutil.which("cc") or pytest.skip("there is no C compiler")
    (folder / "call.c").write_text(CALL, "utf-8")
    sources = [str(folder / "call.c"), str(folder / "c" / "arm.c")]
    options = ["-O0", "-fPIC", "-shared", "-Wall", "-Wextra", "-Werror", f"-I{folder / 'c'}"]
    subprocess.run([compiler, *options, *sources, "-lm", "-o", str(folder / "call.so")], check=True)
    q, status = np.empty(7), np.zeros(1, np.uint8)
    arrays = [np.ascontiguousarray(a, float) for a in (T, [given], seed)]
    pointers = [ctypes.c_void_p(a.ctypes.data) for a in (*arrays, q, status)]
    ctypes.CDLL(str(folder / "call.so")).call(*pointers)
    return q, int(status[0])


def by_javascript(folder: Path, T: np.ndarray, seed: np.ndarray, given: float) -> tuple[Any, int]:
    node = shutil.which("node") or pytest.skip("Node is not installed")
    done = subprocess.run(
        [node, "--input-type=module", "-e", SCRIPT.replace("FOLDER", str(folder / "js"))],
        input=json.dumps({"T": T.ravel().tolist(), "seed": seed.tolist(), "given": given}),
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    found = json.loads(done.stdout)
    return np.array(found["q"]), found["status"]


@pytest.mark.parametrize("search", [by_numpy, by_c, by_javascript])
def test_the_place_on_the_rail_is_kept_to_the_length(folder: Path, search: Any) -> None:
    """Also from a seed elsewhere, such as 2 pi away, which would be none for an angle."""
    robot = module(folder / "numpy", "arm")
    T = np.asarray(robot.fk(Q))
    for rail in (0.0, 0.05, -2 * np.pi):
        seed = Q + np.array([rail, 0.02, -0.03, 0.01, 0.3, 0.0, 0.1])
        q, status = search(folder, T, seed, 17.0)
        assert status == 2 and q[0] == 17.0 and q[4] == seed[4]
        assert np.abs(robot.fk(q) - T).max() < 1e-10
        assert np.abs(q - Q).max() < 0.31
