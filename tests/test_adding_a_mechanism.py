"""The guide for a new mechanism: every snippet is run, in order, as a reader would."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.usefixtures("compiled_quickly")

GUIDE = Path(__file__).parents[1] / "docs" / "adding-a-mechanism.md"
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


def test_every_snippet(tmp_path: Path) -> None:
    """Plain Python adds to jib.py; ``run`` and ``error`` are programs of their own."""
    script, failed = tmp_path / "jib.py", ""
    counts: dict[str, int] = {}
    for kind, name, text in BLOCK.findall(GUIDE.read_text("utf-8")):
        counts[f"{kind} {name}"] = counts.get(f"{kind} {name}", 0) + 1
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
            script.write_text(
                (script.read_text("utf-8") if script.exists() else "") + text, "utf-8"
            )
        elif kind == "text":
            assert text.strip() in failed
        else:
            pytest.fail(f"a snippet of unknown kind: {kind} {name}")
    assert counts["python "] == 7 and counts["python run"] == 5 and counts["python error"] == 4
    report = (tmp_path / "printed" / "jib-crosscheck.md").read_text("utf-8")
    assert "Nothing exceeds its tolerance." in report
    assert (tmp_path / "printed" / "c" / "lift.c").exists()
    assert shutil.which("cc") is None or "| c |" in report
