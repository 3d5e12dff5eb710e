"""Writes the guides in Python as notebooks that were run: ``python -m closedform.site.notebooks``.

A guide is one Markdown file; its text becomes cells of text and its code cells of code, which are
run in a Jupyter kernel.  A cell that fails stops everything.  Code whose fence names a library that
is not here is not run.
"""

from __future__ import annotations

import argparse
from importlib.util import find_spec
from pathlib import Path
from typing import Any

GUIDES = ("first-posture", "reading-a-derivation", "designing-a-five-bar")
DOCS = Path(__file__).parents[2] / "docs"
SECONDS = 300
"""The longest that one cell may take."""


def notebook(guide: str) -> Any:
    """A guide as a notebook that was run."""
    import jupytext
    from nbclient import NotebookClient
    from nbformat.v4 import new_raw_cell

    made = jupytext.read(DOCS / f"{guide}.md")
    made.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3"}
    made.cells = [
        new_raw_cell(cell.source)  # type: ignore[no-untyped-call]
        if any(map(_missing, cell.metadata))
        else cell
        for cell in made.cells
    ]
    NotebookClient(made, timeout=SECONDS, kernel_name="python3").execute()
    return made


def _missing(library: str) -> bool:
    return find_spec(library) is None


def main() -> None:
    import nbformat

    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("-o", "--output", type=Path, default=Path("build/notebooks"), metavar="DIR")
    folder: Path = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    for guide in GUIDES:
        nbformat.write(notebook(guide), folder / f"{guide}.ipynb")  # type: ignore[no-untyped-call]
        print(folder / f"{guide}.ipynb")


if __name__ == "__main__":
    main()
