"""A controller that traps floating-point exceptions survives every single call."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from portability.driver import ROBOTS, Program, compile_driver
from portability.exceptions import requests
from portability.flags import RELEASE

COMPILER = next((name for name in ("gcc", "clang") if shutil.which(name)), None)
# The radicand of these may be negative: then the answer is NaN, by the square root itself.
NAN_BY_ROOT = {("rpr_planar", name) for name in ("fk", "passive_angles", "singularities")} | {
    ("h6ar_loop_closed", "ik")
}

pytestmark = pytest.mark.skipif(COMPILER is None, reason="there is neither gcc nor clang")


def trap_safe(program: Program, robot: str, *, single: bool, batch: bool) -> None:
    asked = [r for r in requests(robot, single=single) if r.name not in NAN_BY_ROOT]
    for request, answer in zip(asked, program.ask(asked), strict=True):
        finite = np.isfinite(answer.single).all(axis=1)
        for row, raised, defined in zip(request.rows, answer.exceptions, finite, strict=True):
            # where no status can tell, what has no finite value may say so by an exception
            told = request.name[1].startswith("ik") or request.name[1] == "fk"
            assert not raised or not (defined or told), (request.name, row, request.parameters)
        if batch and finite.all():
            assert not answer.batch_exceptions, request.name


BUILDS = [*((robot, False) for robot in ROBOTS), ("planar_2r", True), ("spherical_wrist", True)]


@pytest.mark.parametrize(("robot", "single"), BUILDS)
def test_single_calls_raise_none(tmp_path: Path, robot: str, single: bool) -> None:
    command = [str(COMPILER), "-std=c99", *RELEASE]
    program = compile_driver(tmp_path, command, [robot], single=single)
    trap_safe(program, robot, single=single, batch=False)


def test_batches_raise_none_if_asked(tmp_path: Path) -> None:
    command = [str(COMPILER), "-std=c99", *RELEASE, "-DCLOSEDFORM_TRAP_SAFE"]
    program = compile_driver(tmp_path, command, ["spherical_wrist"])
    trap_safe(program, "spherical_wrist", single=False, batch=True)


def test_a_program_that_traps_is_not_stopped(tmp_path: Path) -> None:
    command = [str(COMPILER), "-std=c99", *RELEASE, "-DCLOSEDFORM_TRAP_SAFE"]
    program = compile_driver(tmp_path, command, ["planar_2r"])
    assert program.ask(list(requests("planar_2r", single=False)), "trap")
