"""The modules that a derivation imports, directly and indirectly.

The files are read, not run, so that a stored proof is found without importing SymPy.
"""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.resources import files
from pathlib import Path

from closedform.lazy import homes

PACKAGE = "closedform"
MAPPED = ("derivations", "generated", "templates")
"""Packages of ``closedform`` that are folders next to it in a checkout."""


def package() -> Path:
    """The folder of the toolkit."""
    return Path(str(files(PACKAGE)))


def sources_of(scripts: Iterable[Path]) -> list[Path]:
    """These scripts, and our modules that they import directly and indirectly.

    Our modules are those of closedform and those next to the script that imports them.
    """
    found: dict[Path, None] = {}
    pending = list(scripts)
    while pending:
        path = pending.pop()
        if path in found:
            continue
        found[path] = None
        pending += [p for p in _candidates(path.read_bytes(), path.parent) if p.is_file()]
    return sorted(found)


@cache
def _candidates(text: bytes, folder: Path) -> tuple[Path, ...]:
    """Where our modules that a script imports would be; kept, because scripts share most."""
    try:
        names = dict.fromkeys(_imported(ast.parse(text)))
    except SyntaxError:
        return ()
    return tuple(dict.fromkeys(_files_of(names, folder)))


def _imported(tree: ast.Module) -> Iterator[tuple[str, int]]:
    """The modules that a file may import, each with the number of its leading dots."""
    known = homes([str(package())])
    for node in _statements(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, 0) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = node.module or ""
            yield module, node.level
            for alias in node.names:
                own = module == PACKAGE and not node.level
                name = known.get(alias.name, "") if own else ""
                yield name or f"{module}.{alias.name}".lstrip("."), node.level


def _statements(block: ast.AST) -> Iterator[ast.AST]:
    """The statements below a node, at any depth; most nodes are expressions and left out."""
    for name in ("body", "handlers", "cases", "orelse", "finalbody"):
        below = getattr(block, name, ())
        for node in below if isinstance(below, list) else ():
            yield node
            yield from _statements(node)


def _files_of(names: Iterable[tuple[str, int]], folder: Path) -> Iterator[Path]:
    """The files that would hold these modules and the packages that they are in."""
    for name, level in names:
        parts = name.split(".")
        if level:
            root = [folder, *folder.parents][level - 1]
        elif parts[0] == PACKAGE and parts[1:2] and parts[1] in MAPPED:
            root, parts = Path(str(files(f"{PACKAGE}.{parts[1]}"))), parts[2:]
        elif parts[0] == PACKAGE:
            root, parts = package(), parts[1:]
        else:
            root = folder
        for depth in range(len(parts) + 1):
            yield root.joinpath(*parts[:depth], "__init__.py")
        if parts:
            yield root.joinpath(*parts).with_suffix(".py")


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
