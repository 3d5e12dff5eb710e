"""Formulas as MathML and graphs as SVG, by libraries that run under Node."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

MODULES = "node_modules"


class NodeError(RuntimeError):
    """Node or a library is missing, or a text could not be set."""


def install(folder: Path) -> None:
    """Put the libraries into a folder, unless those of this version are there."""
    source = Path(str(files("closedform.site"))) / "node"
    folder.mkdir(parents=True, exist_ok=True)
    listed = folder / "package.json"
    wanted = (source / "package.json").read_bytes()
    for script in ("render.mjs", "bundle.mjs"):
        shutil.copyfile(source / script, folder / script)
    if (folder / MODULES / "temml").is_dir() and listed.is_file() and listed.read_bytes() == wanted:
        return
    if not shutil.which("node") or not shutil.which("npm"):
        raise NodeError("the site needs Node and npm; on Debian: apt install nodejs npm")
    listed.write_bytes(wanted)
    command = ["npm", "install", "--no-audit", "--no-fund", "--no-package-lock", "--silent"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        listed.unlink()
        raise NodeError(f"npm install failed: {(done.stderr or done.stdout).strip()[-500:]}")


def bundle(
    folder: Path, explorer: Path, printed: Path, static: Path, robots: Mapping[str, str]
) -> None:
    """Write a script for each mechanism: the explorer with the printed code that it runs.

    ``robots`` are the names, each with the mechanism that it is compared with, or nothing.
    """
    request = {
        "explorer": str(explorer),
        "printed": str(printed),
        "cases": str(static / "published"),
        "maps": str(static / "maps"),
        "target": str(static / "explorer"),
        "robots": robots,
    }
    command = ["node", "bundle.mjs", json.dumps(request)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise NodeError(f"the explorer cannot be bundled: {done.stderr.strip()[-2000:]}")


class Renderer:
    """A process that answers one request after another."""

    def __init__(self, folder: Path):
        self.process = subprocess.Popen(
            ["node", "render.mjs"],
            cwd=folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            encoding="utf-8",
        )

    @cache  # noqa: B019  (one renderer lives as long as the build)
    def formula(self, text: str, display: bool = False, wrap: bool = False) -> str:
        """A formula as MathML; ``wrap`` lets it break at relations and signs."""
        return self._answer(kind="formula", text=text, display=display, wrap=wrap)

    def graph(self, text: str) -> str:
        """A graph in the language of Graphviz as SVG."""
        return self._answer(kind="graph", text=text)

    def _answer(self, **request: Any) -> str:
        assert self.process.stdin and self.process.stdout
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            raise NodeError("the process that sets formulas has ended")
        answer = json.loads(line)
        if "error" in answer:
            raise NodeError(f"{answer['error']}, in {request['text']!r}")
        return str(answer["text"])

    def close(self) -> None:
        assert self.process.stdin
        self.process.stdin.close()
        self.process.wait(timeout=10)
