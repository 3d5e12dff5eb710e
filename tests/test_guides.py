"""The guides: every snippet is run, in order, as a reader would."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.usefixtures("compiled_quickly")

DOCS = Path(__file__).parents[1] / "docs"
COUNTS = {
    "adding-a-mechanism": {"python": 12, "run": 9, "error": 4},
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


@pytest.mark.parametrize("guide", COUNTS)
def test_every_snippet(tmp_path: Path, guide: str) -> None:
    """Plain Python adds to a script; ``run`` and ``error`` are programs of their own."""
    failed = ""
    counts: dict[str, int] = {}
    for kind, name, text in BLOCK.findall((DOCS / f"{guide}.md").read_text("utf-8")):
        if kind == "python":
            way = name if name in ("run", "error") else kind
            counts[way] = counts.get(way, 0) + 1
        if kind in ("csv", "toml"):
            (tmp_path / name).write_text(text, "utf-8")
        elif kind == "sh":
            said = []
            for line in text.splitlines():
                done = run("sh", "-c", f"{sys.executable} -m {line}", folder=tmp_path)
                assert done.returncode == 0, f"{line}\n{done.stderr}"
                said.append(done.stdout.splitlines()[-1])
        elif kind == "console":
            assert text.splitlines() == said
        elif kind == "python" and name == "run":
            done = run(sys.executable, "-c", text, folder=tmp_path)
            assert done.returncode == 0, f"{text}\n{done.stderr}"
        elif kind == "python" and name == "error":
            done = run(sys.executable, "-c", text, folder=tmp_path)
            assert done.returncode != 0, text
            failed = done.stderr
        elif kind == "python":
            script = tmp_path / (name or "jib.py")
            script.write_text(
                (script.read_text("utf-8") if script.exists() else "") + text, "utf-8"
            )
        elif kind == "text":
            assert text.strip() in failed
        else:
            pytest.fail(f"a snippet of unknown kind: {kind} {name}")
    assert counts == COUNTS[guide]
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
