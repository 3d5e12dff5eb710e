"""A controller that traps floating-point exceptions survives every single call."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from libraries import shipped
from portability.driver import ROBOTS, Answer, Program, Request, compile_driver
from portability.exceptions import requests
from portability.flags import RELEASE

COMPILER = next((name for name in ("gcc", "clang") if shutil.which(name)), None)
OVERFLOW, INVALID = 4, 3

pytestmark = pytest.mark.skipif(COMPILER is None, reason="there is neither gcc nor clang")


def build(folder: Path, robots: tuple[str, ...], level: str, *flags: str, single: bool) -> Program:
    """The driver; without a level for the robots, with what ``make`` compiled, where it did."""
    found = {} if level or single else {robot: shipped(robot) for robot in robots}
    made = {robot: there[0] for robot, there in found.items() if there}
    command = [str(COMPILER), "-std=c99", *RELEASE[1:], level or "-O1", *flags]
    return compile_driver(folder, command, robots, single=single, made=made)


def answers(program: Program, *, single: bool) -> Iterator[tuple[Request, Answer]]:
    asked = [r for robot in program.robots for r in requests(robot, single=single)]
    return zip(asked, program.ask(asked), strict=True)


def raised(request: Request, answer: Answer) -> Iterator[str]:
    """Only values too large for the type may overflow; INVALID input may raise anything."""
    finite = np.isfinite(answer.single).all(axis=1)
    invalid = (answer.single == INVALID).any(axis=1) & ~finite
    rows = zip(request.rows, answer.exceptions, finite, invalid, strict=True)
    for row, flags, defined, refused in rows:
        if flags & ~(0 if defined else OVERFLOW) and not refused:
            yield f"{request.name} {flags} at {row.tolist()}, {request.parameters}"


def test_single_calls_raise_none(tmp_path: Path) -> None:
    """Answers are not made up either: they are finite if those of a batch are.

    One test for both types, because most of its time goes into loading the derivations.
    """
    for kind, single in (("double", False), ("float", True)):
        program = build(tmp_path / kind, ROBOTS, "", single=single)
        for request, answer in answers(program, single=single):
            assert not list(raised(request, answer)), (kind, request)
            finite = np.isfinite(answer.single)
            assert np.array_equal(finite, np.isfinite(answer.batch)), (kind, request)


@pytest.mark.parametrize(
    ("robot", "single"), [("planar_2r", False), ("planar_2r", True), ("puma560", False)]
)
def test_single_calls_raise_none_as_released(tmp_path: Path, robot: str, single: bool) -> None:
    program = build(tmp_path, (robot,), "-O3", single=single)
    for request, answer in answers(program, single=single):
        assert not list(raised(request, answer))


def test_batches_raise_none_if_asked(tmp_path: Path) -> None:
    robots = ("hybrid_five_bar", "rpr_planar", "spherical_wrist", "stanford_arm")
    program = build(tmp_path, robots, "-O1", "-DCLOSEDFORM_TRAP_SAFE", single=False)
    for request, answer in answers(program, single=False):
        allowed = 0 if np.isfinite(answer.batch).all() else OVERFLOW
        assert not answer.batch_exceptions & ~allowed, request


def test_a_program_that_traps_is_not_stopped(tmp_path: Path) -> None:
    program = build(tmp_path, ("planar_2r",), "-O3", "-DCLOSEDFORM_TRAP_SAFE", single=False)
    asked = list(requests("planar_2r", single=False))
    assert len(program.ask(asked, "trap")) == len(asked)
