"""The pages name files that exist, and every page can be found from another."""

from __future__ import annotations

import importlib
import re
from pathlib import Path

import pytest
from places import ROOT

import closedform
from closedform.lazy import homes
from closedform.lemmas.registry import chain_lemmas

PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
FOLDERS = ("closedform", "derivations", "docs", "generated", "templates", "tests", "benchmarks")
HISTORY = {"CHANGELOG.md"}
"""The changelog also names files that are gone."""
MADE = {"tests/fuzz/cases/"}
"""Folders that exist only after something has failed."""


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_file_that_a_page_names_exists(page: Path) -> None:
    if page.name in HISTORY:
        pytest.skip("also names files that are gone")
    text = re.sub(r"```.*?```", "", page.read_text("utf-8"), flags=re.DOTALL)
    quoted = re.findall(rf"`((?:{'|'.join(FOLDERS)})/[\w./-]*)`", text)
    linked = re.findall(r"\]\((?!https?:)([^)#]+)\)", text)
    written = set(re.findall(r"^`([^`]+)`:$", text, flags=re.MULTILINE))  # by the page itself
    named = {p for p in quoted if not re.search("NAME|KIND", p)} - MADE - written
    missing = sorted(p for p in named if not (ROOT / p).exists())
    missing += [p for p in linked if not (page.parent / p).exists()]
    assert not missing


def test_the_index_lists_every_decision() -> None:
    folder = ROOT / "docs" / "decisions"
    listed = set(re.findall(r"\]\(([\w-]+\.md)\)", (folder / "README.md").read_text("utf-8")))
    assert listed == {page.name for page in folder.glob("*.md")} - {"README.md"}


def test_the_architecture_names_every_package() -> None:
    text = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    packages = {path.parent.name for path in (ROOT / "closedform").glob("*/__init__.py")}
    rows = re.findall(r"^\| `closedform/(\w+)/` \|", text, flags=re.MULTILINE)
    assert set(rows) == packages
    layers = re.search(r"^layers = \[(.*?)\]", (ROOT / "pyproject.toml").read_text(), re.M | re.S)
    assert layers
    assert rows == [name for name in re.findall(r'"(\w+)"', layers[1]) if name in packages]


def test_the_architecture_names_files_that_exist() -> None:
    """A path is below closedform/ or the root; a bare name is in the folder of the path before."""
    text = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    rows = [line for line in text.splitlines() if line.startswith("| ") and "`" in line]
    found = 0
    for row in rows:
        folder = ROOT
        for name in re.findall(r"`([\w./-]+(?:\.(?:py|js|h|jinja)|/))`", row):
            if "NAME" in name:
                continue
            places = [ROOT / name, ROOT / "closedform" / name] if "/" in name else [folder / name]
            path = next((p for p in places if p.exists()), None)
            assert path, f"{name} in {row}"
            folder = path if path.is_dir() else path.parent
            found += 1
    assert found > 100


def test_a_name_for_authors_is_the_one_of_its_module() -> None:
    for name, home in homes(closedform.__path__).items():
        assert getattr(closedform, name) is getattr(importlib.import_module(home), name)
        assert name in dir(closedform)


def test_the_guide_and_the_stub_have_every_lemma() -> None:
    text = (ROOT / "docs" / "adding-a-mechanism.md").read_text("utf-8")
    rows = re.findall(r"^\| `(\w+)\([^`]*\)` \| (.*?) \| (.*?) \|$", text, flags=re.MULTILINE)
    guide = {name: (equation.replace("`", ""), result) for name, equation, result in rows}
    for name, lemma in chain_lemmas().items():
        assert name in guide, f"docs/adding-a-mechanism.md has no row for the lemma {name}"
        assert hasattr(closedform, name), f"closedform/__init__.pyi does not import {name}"
        equation, result = guide.pop(name)
        assert equation.startswith(lemma.equation) and result == lemma.result
        assert getattr(closedform, name) is lemma.apply
    assert not guide, "rows without a lemma"
