"""The command ``closedform figures``: every figure of mechanisms, and the page about them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from closedform.cli.plot import catalogue, drawings, module, write
from closedform.pipeline import scripts

CAPTIONS, PLACES = "captions.json", "places.json"
"""The captions of figures, and where articles show them."""
PAGE = "figures.md"
BUILT = Path("build", "figures")
OPENING = ("puma560", "branches")
"""The picture at the top of the README."""


def names() -> list[str]:
    return [source.name for source in scripts.sources()]


def place(chosen: list[str]) -> Path:
    """Where to draw: beside the article, if the mechanism was printed into a folder of its own."""
    printed = [Path(name) for name in chosen if name.endswith(".py")]
    beside = printed[0].parent.parent / "latex" if printed else BUILT
    return beside if beside.is_dir() else BUILT


def draw_all(
    folder: Path, chosen: list[str], suffix: str = ".pdf", docs: Path | None = None
) -> Iterator[str]:
    """Draw all figures of mechanisms, with their captions; a line for each mechanism.

    A mechanism is chosen by its name, or by the file of a NumPy module that ``derive`` printed.
    Articles find the figures that are PDF.  What the pages in ``docs`` show is written there too,
    with a thumbnail of each mechanism.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if docs is not None:
        (docs / "figures").mkdir(parents=True, exist_ok=True)
    captions, places = read(folder / CAPTIONS), read(folder / PLACES)
    for which in chosen or names():
        robot, name = module(which), Path(which).stem
        captions, places = (
            {k: t for k, t in texts.items() if not k.startswith(f"{name}-")}
            for texts in (captions, places)
        )
        drawn = catalogue(name, robot)
        for figure in drawn:
            targets = [folder / f"{name}-{figure.name}{suffix}"]
            if docs is not None and (name, figure.name) in shown():
                targets.append(docs / "figures" / f"{name}-{figure.name}.svg")
            write(partial(figure.draw, robot), *targets)
            captions[f"{name}-{figure.name}"] = figure.caption
            places[f"{name}-{figure.name}"] = figure.step
        for target, texts in ((CAPTIONS, captions), (PLACES, places)):
            text = json.dumps(texts, indent=2, ensure_ascii=False)
            (folder / target).write_text(text + "\n", "utf-8")
        _tell_articles(folder, captions, places)
        if docs is not None:
            write(partial(thumbnail, name, robot), docs / "figures" / f"{name}.svg")
        yield f"{name}: {', '.join(f.name for f in drawn)}\n"


def _tell_articles(folder: Path, captions: dict[str, str], places: dict[str, str]) -> None:
    """Write what TeX includes; without SymPy there are no articles either."""
    with suppress(ModuleNotFoundError):
        from closedform.emit.backends.latex.figures import write as tell

        tell(folder, captions, places)


def read(target: Path) -> dict[str, str]:
    """The texts that an earlier run wrote."""
    return json.loads(target.read_text("utf-8")) if target.exists() else {}


def thumbnail(name: str, robot: Any) -> Any:
    """A small drawing without labels."""
    from closedform import plot
    from closedform.plot.catalogue import pictured
    from closedform.plot.robot import Robot

    view = drawings().view(name)
    small = plot.new_axes(not Robot.of(robot).flat, (1.6, 1.4))
    return pictured(robot, view, view.general, labels=False, axes=False, ax=small)


def shown() -> set[tuple[str, str]]:
    """The mechanism and the name of each figure that a page shows."""
    papers = {
        (name, figure.name) for paper in drawings().PAPERS for name, figure in paper.drawn.values()
    }
    return papers | {OPENING}


def page() -> str:
    """The page that lists the figures of the papers."""
    lines = [
        "# Figures",
        "",
        "`make figures` draws all figures of all mechanisms as PDF in `build/figures/`, with their",
        "captions in `captions.json`, and those that these pages show as SVG in `docs/figures/`.",
        "It also writes this page. `closedform plot` draws a single one:",
        "",
        "```sh",
        "closedform plot irb260 workspace -o workspace.pdf",
        "closedform plot hybrid_five_bar fig15 -o fig15.svg",
        "```",
        "",
        "Every point, length and curve is computed by the generated modules. The papers give few",
        "dimensions; unless the caption says otherwise, the drawings use the default parameters,",
        "whose docstrings name their source.",
        "",
        "## Figures of the mechanisms",
        "",
        "A map needs two joints; a mechanism with one joint shows its motion. There is no map of",
        "the workspace of a hand that only turns.",
        "",
        *_of_mechanisms(),
        "",
        "## Figures of the papers",
    ]
    for paper in drawings().PAPERS:
        lines += ["", *_of_paper(paper)]
    return "\n".join(lines) + "\n"


def _of_mechanisms() -> Iterator[str]:
    """The figures that most mechanisms have, with exceptions, and the further ones."""
    drawn = {name: catalogue(name) for name in names()}
    usual = {f.name: f.caption for f in drawn["planar_2r"] if ("planar_2r", f.name) not in shown()}
    for figure, caption in usual.items():
        without = [n for n, figures in drawn.items() if figure not in {f.name for f in figures}]
        listed = f" Not for {', '.join(f'`{n}`' for n in without)}." if without else ""
        yield f"- `{figure}`: {caption}{listed}"
    further: dict[tuple[str, str], list[str]] = {}
    for name, figures in drawn.items():
        for f in figures:
            if f.name not in usual and (name, f.name) not in shown():
                further.setdefault((f.name, f.caption), []).append(f"`{name}`")
    for (figure, caption), of in further.items():
        yield f"- `{figure}`, of {' and '.join(of)} only: {caption}"


def _of_paper(paper: Any) -> Iterator[str]:
    yield f"### {paper.heading}"
    yield ""
    yield f"{len(paper.drawn)} of {paper.count} figures."
    for number in range(1, paper.count + 1):
        yield ""
        if number in paper.drawn:
            name, figure = paper.drawn[number]
            yield f"**{number}.** {figure.caption}"
            if number in paper.contradicted:
                yield ""
                yield f"Contradicted: {paper.contradicted[number]}"
            yield ""
            yield f"![Figure {number}](figures/{name}-{figure.name}.svg)"
        else:
            yield f"**{number}.** Not reproduced: {paper.missing[number]}."
