"""The command line on terminals without Unicode, and on closed, full or broken streams."""

import io
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from derivations_for_tests import SLIDER

from closedform.cli import console, main
from closedform.pipeline import scripts, versions

COMMANDS = [["list"], ["errata"], ["--help"], ["--version"], ["derive", "--help"]]
FULL = Path("/dev/full")
ESCAPE = re.compile(r"\\u[0-9a-f]{4}|\\x[0-9a-f]{2}")


@pytest.fixture(autouse=True)
def no_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep stderr independent of the time that a command takes."""
    monkeypatch.setattr("closedform.cli.console.PATIENCE", float("inf"))


def call(*arguments: str) -> int:
    try:
        return main(arguments)
    except SystemExit as stop:
        assert isinstance(stop.code, int)
        return stop.code


def in_ascii(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> str:
    """The output of a command if the encoding is ASCII."""
    written = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(written, encoding="ascii"))
    assert call(*arguments) == 0
    return written.getvalue().decode("ascii")


@pytest.mark.parametrize("arguments", COMMANDS, ids=" ".join)
def test_a_terminal_without_unicode(arguments: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    text = in_ascii(monkeypatch, *arguments)
    assert text and not ESCAPE.search(text)


@pytest.mark.parametrize("form", ["text", "latex"])
def test_show_on_a_terminal_without_unicode(
    script: Path, form: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scripts, "find", lambda names: [scripts.Source("slider", script)])
    text = in_ascii(monkeypatch, "show", "slider", "--format", form)
    assert not ESCAPE.search(text)
    if form == "text":
        assert "sqrt" not in text and "\\/" in text  # a root, drawn
        assert "Angle alpha <= 90 deg - so far" in text
        assert "R = [1, 0]" in text


@pytest.fixture
def script(tmp_path: Path) -> Path:
    """Greek letters, dashes, a root and a step that is given as LaTeX."""
    path = tmp_path / "slider.py"
    steps = (
        'd.step("Angle α ≤ 90° – so far", "Reason.", {"x": sp.sqrt(a + 1)})\n'
        'd.step("Matrix", "As printed.", {"R": r"\\begin{bmatrix} 1 & 0 \\end{bmatrix}"})\n'
    )
    path.write_text(SLIDER + steps, "utf-8")
    return path


@pytest.mark.skipif(not FULL.exists(), reason="there is no /dev/full")
@pytest.mark.parametrize("arguments", COMMANDS, ids=" ".join)
def test_a_full_output(
    arguments: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with FULL.open("w") as full:
        monkeypatch.setattr(sys, "stdout", full)
        assert call(*arguments) == 1
    message = "closedform: cannot write to the standard output: No space left on device\n"
    assert capsys.readouterr().err == message


@pytest.mark.parametrize("arguments", COMMANDS, ids=" ".join)
def test_a_closed_output(
    arguments: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "stdout", None)
    assert call(*arguments) == 1
    assert capsys.readouterr().err.endswith("closedform: the standard output is closed\n")


@pytest.mark.skipif(not FULL.exists(), reason="there is no /dev/full")
@pytest.mark.parametrize(
    ("redirections", "code", "errors"),
    [
        (">/dev/full", 1, "closedform: cannot write to the standard output: No space left"),
        (">&-", 1, "closedform: the standard output is closed"),
        ("2>&-", 0, ""),
        ("2>&- >&-", 1, ""),
        ("2>/dev/full >/dev/full", 1, ""),
    ],
)
def test_streams_of_the_shell(redirections: str, code: int, errors: str) -> None:
    """Python does not complain either when it ends."""
    done = subprocess.run(
        f'exec "{sys.executable}" -m closedform list {redirections}',
        shell=True,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == code
    assert done.stderr.startswith(errors) and done.stderr.count("\n") == (1 if errors else 0)


def test_a_reader_that_has_gone() -> None:
    read, write = os.pipe()
    os.close(read)
    command = [sys.executable, "-m", "closedform", "errata"]
    done = subprocess.run(command, stdout=write, stderr=subprocess.PIPE, text=True, check=False)
    os.close(write)
    assert (done.returncode, done.stderr) == (1, "")


def test_errors_that_cannot_be_told(monkeypatch: pytest.MonkeyPatch) -> None:
    for stream in (None, io.TextIOWrapper(io.BytesIO(), encoding="ascii")):
        monkeypatch.setattr(sys, "stderr", stream)
        assert main(["show", "nöwhere"]) == 2


def test_the_current_folder_is_gone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "gone"
    folder.mkdir()
    monkeypatch.chdir(folder)
    folder.rmdir()
    assert main(["derive", "planar_2r", "-o", "out"]) == 1
    assert capsys.readouterr().err == "closedform: the current folder no longer exists\n"


def test_a_file_is_not_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The warning comes before anything is proved."""
    (tmp_path / "out").touch()
    assert main(["derive", "planar_2r", "-o", str(tmp_path / "out")]) == 1
    assert capsys.readouterr().err.endswith("out: it is not a folder\n")


def test_characters_in_ascii() -> None:
    console.open_streams()
    text = "θ₁ ≤ ½π – “Mü” ☃"
    assert text.encode("ascii", "closedform") == b'theta1 <= 12pi - "Mu" \\u2603'


@pytest.mark.parametrize(
    ("installed", "warned"),
    [
        ({"sympy": "1.14.0", "python-flint": "0.8.0"}, []),
        ({"sympy": "1.14.0", "python-flint": "0.10.1"}, []),
        ({"sympy": "1.13.3", "python-flint": "0.8"}, ["sympy 1.13.3 is installed, not 1.14.0; "]),
        ({"sympy": "1.15.0.dev0", "python-flint": "1.0"}, ["sympy 1.15.0.dev0 is installed, not"]),
        (
            {"sympy": "1.14.0", "python-flint": "0.7.1"},
            ["python-flint 0.7.1 is installed, but 0.8 or"],
        ),
    ],
)
def test_another_algebra_is_mentioned(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    installed: dict[str, str],
    warned: list[str],
) -> None:
    sympy, flint = "sympy==1.14.0; extra == 'derive'", 'python-flint>=0.8; extra == "derive"'
    needed = ["numpy>=1.26", sympy, flint]
    monkeypatch.setattr(versions, "requires", lambda name: needed)
    monkeypatch.setattr(versions, "version", installed.__getitem__)
    found = versions.warnings()
    assert [w for w, start in zip(found, warned, strict=True) if w.startswith(start)] == found
    monkeypatch.setattr(scripts, "load", stop)
    assert main(["show", "planar_2r"]) == 1
    assert capsys.readouterr().err == "".join(
        f"closedform: {line}\n" for line in [*(f"warning: {w}" for w in found), "planar_2r: enough"]
    )


def stop(source: scripts.Source) -> None:
    raise scripts.DerivationError(source.name, "enough")


def test_the_installed_algebra_is_the_one_that_is_asked_for() -> None:
    assert versions.warnings() == []
