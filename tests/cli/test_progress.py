"""What the command line shows while it works, and that it never waits for what does not come."""

import os
import select
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from closedform.cli.commands import main
from closedform.pipeline.disk import locked
from closedform.pipeline.workers import WorkerError, each

SCRIPT = """
import sys
from closedform import cli
from closedform.cli import console
console.PATIENCE, console.INTERVAL = float(sys.argv.pop(1)), 0.01
sys.exit(cli.main(sys.argv[1:]))
"""
PHASES = ("deriving", "proving", "generating", "cross-checking")


def on_a_terminal(*arguments: str) -> str:
    """What a command shows on a terminal of 60 columns."""
    import pty

    ours, theirs = pty.openpty()
    environment = {**os.environ, "COLUMNS": "60"}
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, *arguments],
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        env=environment,
    )
    os.close(theirs)
    shown = b""
    with process:
        while select.select([ours], [], [], 120)[0]:
            try:
                shown += os.read(ours, 4096)
            except OSError:  # Linux says so where the other end is closed
                break
    os.close(ours)
    assert process.returncode == 0, shown
    return shown.decode()


@pytest.mark.usefixtures("compiled_quickly")
@pytest.mark.skipif(os.name != "posix", reason="terminals are those of POSIX")
def test_progress_is_one_line_of_a_terminal(tmp_path: Path) -> None:
    shown = on_a_terminal("0", "derive", "planar_2r", "--fresh", "-o", str(tmp_path))
    progress, _, result = shown.rpartition("\r\x1b[K")
    lines = [line for line in progress.split("\r\x1b[K") if line]
    assert lines and all(len(line) < 60 and "\n" not in line for line in lines)
    told = [phase for phase in PHASES if any(f"planar_2r: {phase}" in line for line in lines)]
    assert {"deriving", "proving", "cross-checking"} <= {*told}
    assert result.startswith("planar_2r") and "\x1b" not in result


@pytest.mark.skipif(os.name != "posix", reason="terminals are those of POSIX")
def test_nothing_is_shown_of_what_takes_no_time() -> None:
    assert "\x1b" not in on_a_terminal("60", "show", "planar_2r")


def test_nothing_is_shown_where_there_is_no_terminal() -> None:
    command = [sys.executable, "-c", SCRIPT, "0", "show", "planar_2r"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stderr == "" and "\x1b" not in done.stdout


def half(n: int, report: Callable[[str, str], None]) -> int:
    """A job: one that is given 13 dies, as if it were killed; what is odd has no half."""
    report(str(n), "halving")
    if n == 13:
        os._exit(3)
    if n % 2:
        raise ValueError(n)
    return n // 2


def test_each_item_has_a_result() -> None:
    told: list[tuple[str, str]] = []
    found = dict(each(half, [2, 4, 5, 8, 10], 2, lambda *what: told.append(what)))
    assert isinstance(found.pop(5), ValueError)
    assert found == {2: 1, 4: 2, 8: 4, 10: 5}
    assert sorted(told) == sorted((str(n), "halving") for n in (2, 4, 5, 8, 10))


def test_a_process_that_dies_is_not_waited_for() -> None:
    with pytest.raises(WorkerError, match="13: its process ended with exit code 3"):
        list(each(half, [2, 13, 4], 2, lambda *_: None))


def test_a_lock_that_is_not_given_back_is_not_waited_for(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    pytest.importorskip("fcntl")
    root = tmp_path / "checkout"
    monkeypatch.setattr("closedform.cli.commands.PATIENCE", 0.2)
    monkeypatch.setattr("closedform.pipeline.folders.checkout", lambda: root)
    monkeypatch.setattr("closedform.pipeline.scripts.sources", list)
    with locked(root / "build" / "generated.lock"):
        assert main(["check", "-j", "1"]) == 1
    assert "another process has held" in capsys.readouterr().err
