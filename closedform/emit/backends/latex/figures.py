"""What TeX reads of the figures that ``make figures`` has drawn, for the articles and the book.

``python -m closedform.emit.backends.latex.figures FOLDER`` reads ``captions.json``, which maps
``ROBOT-what`` to a caption in the order of the pages, and writes ``ROBOT-figures.tex`` for each
mechanism that has drawings ``ROBOT-what.pdf``.  Without them an article has no figures.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from closedform.emit.backends.latex.prose import mixed


def pages(captions: Mapping[str, str], drawn: Sequence[str]) -> dict[str, str]:
    """The figures of each mechanism that were drawn and have a caption."""
    found: dict[str, str] = {}
    for name, caption in captions.items():
        if name in drawn:
            robot = name.partition("-")[0]
            page = rf"\drawing{{{name}}}{{{mixed(caption)}}}" + "\n"
            found[robot] = found.get(robot, "") + page
    return found


def main(folder: Path) -> None:
    known = folder / "captions.json"
    captions = json.loads(known.read_text("utf-8")) if known.is_file() else {}
    for robot, text in pages(captions, [p.stem for p in folder.glob("*.pdf")]).items():
        (folder / f"{robot}-figures.tex").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
