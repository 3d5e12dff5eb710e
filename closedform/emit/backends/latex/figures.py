"""What TeX reads of the figures that were drawn, for the articles and the book.

Captions map ``ROBOT-what`` to a caption in the order of the pages, and places map it to the title
of the step or to the section that it belongs to.  Each mechanism that has drawings
``ROBOT-what.pdf`` gets a file ``ROBOT-figures.tex``.  Without it an article has no figures.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from closedform.emit.backends.latex.places import SECTIONS, place
from closedform.emit.backends.latex.prose import mixed
from closedform.model.names import listed


def pages(
    captions: Mapping[str, str], drawn: Sequence[str], places: Mapping[str, str]
) -> dict[str, str]:
    """The figures of each mechanism that were drawn and have a caption, place by place."""
    found: dict[str, dict[str, list[str]]] = {}
    for name in captions:
        if name in drawn:
            of_robot = found.setdefault(name.partition("-")[0], {})
            where = places.get(name, "")
            key = where or "mechanism" if where in SECTIONS else place(where)
            of_robot.setdefault(key, []).append(name)
    return {
        robot: "".join(_at(where, names, captions) for where, names in of_robot.items())
        for robot, of_robot in found.items()
    }


def _at(where: str, names: Sequence[str], captions: Mapping[str, str]) -> str:
    marks = listed([rf"\ref{{figure:{name}}}" for name in names])
    told = f"See Figure{'s' * (len(names) > 1)}~{marks}."
    drawings = [rf"\drawing{{{name}}}{{{mixed(captions[name])}}}" for name in names]
    return "\n".join([rf"\figures{{{where}}}{{{told}", *drawings]) + "}\n"


def write(folder: Path, captions: Mapping[str, str], places: Mapping[str, str]) -> None:
    """Write the file of each mechanism whose figures are in a folder."""
    drawn = [p.stem for p in folder.glob("*.pdf")]
    for robot, text in pages(captions, drawn, places).items():
        (folder / f"{robot}-figures.tex").write_text(text, encoding="utf-8")
