"""Shared by the tests: repeatable examples, the toy extension, the site, the worst errors."""

from __future__ import annotations

import importlib.util
import os
import pickle
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from extension_toy.build import compile_toy, loaded
from hypothesis import settings
from sharing import compile_quickly, shared

from closedform.pipeline.memory import spend_memory

if TYPE_CHECKING:  # most processes that run pytest need no SymPy for it
    from closedform.check.finding import Finding

# The same examples on every run: a failure can be repeated, and a build is stable.
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")
spend_memory()

ROOT = Path(__file__).parents[1]
FINDINGS = pytest.StashKey["list[Finding]"]()


@pytest.fixture(scope="session")
def findings(pytestconfig: pytest.Config) -> list[Finding]:
    """Collects what the cross-checks find, for the table at the end."""
    return pytestconfig.stash.setdefault(FINDINGS, [])


@pytest.fixture(scope="session")
def native(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The toy extension, for the tests of the runtime."""
    return loaded(shared(tmp_path_factory, "toy", compile_toy))


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the site, built once for all tests, without the figures.

    ``CLOSEDFORM_SITE=build/site`` takes one that is there.
    """
    if there := os.environ.get("CLOSEDFORM_SITE"):
        return Path(there).absolute()
    if not (shutil.which("node") and shutil.which("npm")):
        pytest.skip("Node or npm is not installed")
    if importlib.util.find_spec("sphinx") is None:
        pytest.skip("Sphinx is not installed")

    def build(target: Path) -> None:
        command = [sys.executable, "-m", "closedform", "site", "--no-figures", "-j", "2"]
        done = subprocess.run(
            [*command, "-o", str(target / "site"), "--work", str(target / "work")],
            capture_output=True,
            text=True,
            cwd=ROOT,
        )
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]

    return shared(tmp_path_factory, "site", build) / "site"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The tests of the site come first, so that none waits at the end until it is built."""
    items.sort(key=lambda item: "site" not in getattr(item, "fixturenames", ()))


@pytest.fixture
def compiled_quickly(
    tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is printed for a test is cross-checked with little optimisation."""
    compile_quickly(monkeypatch, tmp_path_factory.mktemp("cc"))


def pytest_sessionfinish(session: pytest.Session) -> None:
    """With several processes (-n), each passes its findings to the first."""
    output = getattr(session.config, "workeroutput", None)
    if output is not None:
        output["findings"] = pickle.dumps(session.config.stash.get(FINDINGS, [])).hex()


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    output = getattr(node, "workeroutput", {})
    if "findings" in output:
        found = pickle.loads(bytes.fromhex(output["findings"]))
        node.config.stash.setdefault(FINDINGS, []).extend(found)


def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> None:
    found = config.stash.get(FINDINGS, [])
    if found:
        from closedform.check.finding import table

        terminalreporter.section("worst error of each generated function")
        found.sort(key=lambda f: (f.robot, f.function, f.backend))
        for line in table(found):
            terminalreporter.write_line(line)
