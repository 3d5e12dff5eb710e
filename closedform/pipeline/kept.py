"""What was printed is kept on disk, so that only what changes is printed again."""

from __future__ import annotations

import hashlib
import io
import pickle
import sys
from collections.abc import Iterable, Sequence
from dataclasses import is_dataclass
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

from closedform.pipeline.disk import replace
from closedform.pipeline.imports import package

if TYPE_CHECKING:
    from closedform.emit.pages import Printed

OURS = "closedform"
KNOWN = (OURS, "pathlib")
RUNTIME = "runtime"
TOOLS = ("sympy", "python-flint", "jinja2")


class KeptPages:
    """The pages of mechanisms in a folder, each with a digest of everything that it depends on."""

    def __init__(self, folder: Path):
        self.folder = folder

    def get(self, robot: str, digested: str, backends: Sequence[str]) -> Printed | None:
        """The pages of a robot, if nothing has changed since they were printed."""
        try:
            known, printed = _Data(io.BytesIO(self._path(robot, backends).read_bytes())).load()
        except Exception:  # absent, cut short, or of another version: a pickle raises anything
            return None
        return printed if known == digested else None

    def put(self, robot: str, digested: str, backends: Sequence[str], printed: Printed) -> None:
        """Keep the pages of a robot; raises ``OSError`` if the disk is full or read-only."""
        replace(self._path(robot, backends), pickle.dumps((digested, printed)))

    def _path(self, robot: str, backends: Sequence[str]) -> Path:
        return self.folder / f"{robot}.{'+'.join(backends)}.pickle"


class _Data(pickle.Unpickler):
    """Reads paths and dataclasses of the toolkit, but runs no code that a file names."""

    def find_class(self, module: str, name: str) -> Any:
        found = super().find_class(module, name) if module.split(".")[0] in KNOWN else None
        if isinstance(found, type) and (is_dataclass(found) or issubclass(found, PurePath)):
            return found
        raise pickle.UnpicklingError(f"{module}.{name} is not data")


def keeps(backends: Iterable[str]) -> bool:
    """Whether all back ends belong to the toolkit: the digest covers no others."""
    return all("." not in name or name.startswith(f"{OURS}.") for name in backends)


def printing_digest(derived: str) -> str:
    """A digest of all that pages depend on: a derivation, given by its digest, and the toolkit."""
    found = [path for path in package().rglob("*.py") if path.is_file()]
    for folder in (package() / RUNTIME, Path(str(files(f"{OURS}.templates")))):
        found += [path for path in folder.rglob("*") if path.is_file() and path.suffix != ".pyc"]
    tools = [f"Python {sys.version}\n", *(f"{tool} {version(tool)}\n" for tool in TOOLS)]
    return digest_of(sorted(set(found)), [derived, *tools])


def digest_of(paths: Iterable[Path], lines: Iterable[str] = ()) -> str:
    """A digest of files, with their names, and of lines of text."""
    total = hashlib.sha256()
    for path in paths:
        content = path.read_bytes()
        total.update(f"{path.name} {len(content)}\n".encode())
        total.update(content)
    for line in lines:
        total.update(line.encode())
    return total.hexdigest()
