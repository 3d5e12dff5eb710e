"""The derivation scripts: where they are, how one is found by its name, and how it is loaded.

SymPy is imported only when a derivation is loaded, so that listing works without it.
"""

from __future__ import annotations

import ast
import importlib
import importlib.util
import sys
import traceback
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from closedform.pipeline import folders
from closedform.pipeline.imports import digest_of, package, sources_of

if TYPE_CHECKING:
    from closedform.model.derivation import Derivation


class DerivationError(Exception):
    """A derivation that cannot be loaded or proved: its name, and what is wrong."""

    def __str__(self) -> str:
        name, message = self.args
        return f"{name}: {message}"


class UnknownNameError(Exception):
    """There is no derivation of this name."""


@dataclass(frozen=True)
class Source:
    """A derivation script; ``module`` is empty for a file outside the package."""

    name: str
    path: Path
    module: str = ""

    @property
    def title(self) -> str:
        """The first line of the script's docstring."""
        docstring = ast.get_docstring(ast.parse(self.path.read_bytes())) or ""
        return docstring.partition("\n")[0]


def sources() -> list[Source]:
    """The derivation scripts of the package, by name."""
    return [
        Source(path.stem, path, f"closedform.derivations.{path.stem}")
        for path in sorted(folders.scripts().glob("*.py"))
        if _assigns_d(path.read_bytes())
    ]


def find(names: Sequence[str]) -> list[Source]:
    """The scripts with these names or paths; all scripts of the package if none is given."""
    known = {source.name: source for source in sources()}
    if not names:
        return list(known.values())
    return [_find(name, known) for name in dict.fromkeys(names)]


def _find(name: str, known: Mapping[str, Source]) -> Source:
    if name in known:
        return known[name]
    path = Path(name)
    if path.suffix != ".py":
        raise UnknownNameError(name)
    path = path.resolve()
    for source in known.values():
        if source.path.resolve() == path:
            return source
    if not path.is_file():
        raise UnknownNameError(name)
    return Source(path.stem, path)


@cache
def _assigns_d(text: bytes) -> bool:
    """Whether a script assigns ``d``.  If it does not parse, True: the error is reported later."""
    try:
        statements = ast.parse(text).body
    except SyntaxError:
        return True
    targets: list[ast.expr] = []
    for statement in statements:
        if isinstance(statement, ast.Assign):
            targets += statement.targets
        elif isinstance(statement, ast.AnnAssign):
            targets.append(statement.target)
    return any(isinstance(t, ast.Name) and t.id == "d" for t in targets)


# Loading


def same_choices() -> None:
    """Let SymPy try the same points every time: where it factors, an unlucky one takes minutes."""
    from sympy.core import random

    random.seed(0)


def load(source: Source) -> Derivation:
    """Run a derivation script."""
    from closedform.model.derivation import Derivation

    same_choices()
    try:
        module = _module(source)
    except Exception as error:
        raise DerivationError(source.name, _located(error, source.path)) from error
    derivation = getattr(module, "d", None)
    if not isinstance(derivation, Derivation):
        raise DerivationError(source.name, f"{source.path.name} must assign a Derivation to d")
    if derivation.name != source.name:
        raise DerivationError(
            source.name,
            f"the derivation calls itself {derivation.name}; name the file {derivation.name}.py",
        )
    return derivation


def _module(source: Source) -> Any:
    if source.module:
        return importlib.import_module(source.module)
    digested = digest_of(sources_of([source.path]))
    if (known := _modules.get(source.path)) and known[0] == digested:
        return known[1]
    folder = str(source.path.parent)
    if folder not in sys.path:
        sys.path.append(folder)
    spec = importlib.util.spec_from_file_location(f"_derivation_{source.name}", source.path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    _modules[source.path] = digested, module
    return module


_modules: dict[Path, tuple[str, Any]] = {}
"""Scripts outside the package that were run, each with a digest of its sources."""


def _located(error: Exception, path: Path) -> str:
    """An error with the last line of the script that led to it."""
    lines = [
        frame.lineno
        for frame in traceback.extract_tb(error.__traceback__)
        if frame.filename == str(path)
    ]
    place = f"{path.name}, line {lines[-1]}: " if lines else ""
    return f"{place}{type(error).__name__}: {error}"


def digest(source: Source) -> str:
    """A digest of the script, of everything that it and the proof import, and of the algebra."""
    algebra = [f"{package} {version(package)}\n" for package in ("sympy", "python-flint")]
    return digest_of(sources_of([source.path, package() / "proof" / "prove.py"]), algebra)
