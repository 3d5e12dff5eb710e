"""The guides: every snippet is run, in order, as a reader would."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from places import ROOT

from closedform.cli.commands import main

pytestmark = pytest.mark.usefixtures("compiled_quickly")

DOCS = ROOT / "docs"
COUNTS = {
    "adding-a-mechanism": {"python": 10, "run": 6, "error": 4},
    "closed-loops": {"python": 3, "run": 27},
    "adding-a-lemma": {"python": 1, "run": 1, "error": 1},
}
"""How many snippets of each kind a guide has, so that none is overlooked."""
BLOCK = re.compile(r"^```(\w+) ?([\w.]*)\n(.*?)^```", re.M | re.S)


def run(*command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join([str(folder), str(Path(sys.executable).parent)])
    return subprocess.run(
        command,
        cwd=folder,
        env={
            **os.environ,
            "PYTHONPATH": str(folder),
            "PATH": f"{path}{os.pathsep}{os.environ['PATH']}",
        },
        capture_output=True,
        text=True,
    )


class Snippets:
    """The snippets of a guide, run one after another; a method for each kind."""

    def __init__(self, folder: Path, output: pytest.CaptureFixture[str]) -> None:
        self.folder = folder
        self.output = output
        self.counts: dict[str, int] = {}
        self.failed = ""
        self.said: list[str] = []

    def file(self, name: str, text: str) -> None:
        (self.folder / name).write_text(text, "utf-8")

    csv = toml = file

    def sh(self, _: str, text: str) -> None:
        """Commands, in this process, because each would need seconds to load SymPy."""
        self.said = []
        for line in text.splitlines():
            program, *words = shlex.split(line)
            assert program == "closedform"
            status = main(words)
            said = self.output.readouterr()
            assert status == 0, f"{line}\n{said.err}"
            self.said.append(said.out.splitlines()[-1])

    def console(self, _: str, text: str) -> None:
        assert text.splitlines() == self.said

    def text(self, _: str, text: str) -> None:
        assert text.strip() in self.failed

    def python(self, name: str, text: str) -> None:
        """Plain Python adds to a script; ``run`` and ``error`` are programs of their own."""
        way = name if name in ("run", "error") else "python"
        self.counts[way] = self.counts.get(way, 0) + 1
        if way == "python":
            with (self.folder / (name or "jib.py")).open("a", encoding="utf-8") as script:
                script.write(text)
            return
        done = run(sys.executable, "-c", text, folder=self.folder)
        assert (done.returncode == 0) == (way == "run"), f"{text}\n{done.stderr}"
        if way == "error":
            self.failed = done.stderr


@pytest.mark.parametrize("guide", COUNTS)
def test_every_snippet(
    tmp_path: Path,
    guide: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    snippets = Snippets(tmp_path, capsys)
    for kind, name, text in BLOCK.findall((DOCS / f"{guide}.md").read_text("utf-8")):
        try:
            follow = getattr(snippets, kind)
        except AttributeError:
            pytest.fail(f"a snippet of unknown kind: {kind} {name}")
        follow(name, text)
    assert snippets.counts == COUNTS[guide]
    if guide == "adding-a-mechanism":
        report = (tmp_path / "printed" / "jib-crosscheck.md").read_text("utf-8")
        assert "Nothing exceeds its tolerance." in report
        assert (tmp_path / "printed" / "c" / "lift.c").exists()
        assert shutil.which("cc") is None or "| c |" in report


def test_the_control_loop_of_the_page_is_the_one_that_is_run():
    page = (DOCS / "in-a-controller.md").read_text("utf-8")
    [code] = re.findall(r"```c\n(.*?)```", page, re.DOTALL)
    assert code == (DOCS.parent / "tests" / "c" / "control_loop.c").read_text("utf-8")


@pytest.mark.parametrize(
    ("page", "kind", "printed"),
    [
        (
            "first-posture",
            "python",
            ["[ 0.591 -0.097]", "elbow_up [ 0.3 -1.1] OK", "[1 1]", "[2 2]"],
        ),
        (
            "reading-a-derivation",
            "python",
            ["4 Jacobian and its determinant", "(1 difference)", "refuted at $l_1 = 1$", "proved"],
        ),
        ("designing-a-five-bar", "python", ["pivots 0.00: at least 0.955"]),
        ("designing-a-five-bar", "python jax", ["from 0.811 to 0.947"]),
    ],
)
def test_the_lines_of_a_page_print_what_it_says(page, kind, printed):
    if kind.endswith("jax"):
        pytest.importorskip("jax", reason="JAX is not installed")
    text = (DOCS / f"{page}.md").read_text("utf-8")
    code = "\n".join(re.findall(rf"```{kind}\n(.*?)```", text, re.DOTALL))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert all(line in done.stdout for line in printed), done.stdout
