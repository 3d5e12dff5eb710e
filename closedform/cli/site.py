"""The command ``closedform site``: the pages of the site, its figures, and the build."""

from __future__ import annotations

import argparse
import hashlib
import json
from collections.abc import Callable, Iterable
from pathlib import Path

from closedform.cli.figures import CAPTIONS, draw_all
from closedform.pipeline.run import Files
from closedform.pipeline.scripts import Source

BACKEND = "closedform.site.backend"
DRAWN_BY = ("closedform/plot/*.py", "derivations/figures/*.py")


def add_options(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "-o", "--output", metavar="DIR", type=Path, default=Path("build/site"),
        help="for the pages; default: build/site",
    )  # fmt: skip
    parser.add_argument(
        "--work", metavar="DIR", type=Path, default=Path("build/site-work"),
        help="for intermediate files; default: build/site-work",
    )  # fmt: skip
    parser.add_argument(
        "--no-figures", action="store_true", help="use only the drawings in docs/figures"
    )


def write(
    options: argparse.Namespace,
    printed: Files,
    sources: Iterable[Source],
    root: Path,
    report: Callable[[str], None],
) -> int:
    """Draw the figures that changed and build the pages; the number of warnings."""
    from closedform.site.build import assemble, build

    source: Path = options.work / "source"
    figures = source / "figures"
    figures.mkdir(parents=True, exist_ok=True)
    if options.no_figures:
        (figures / CAPTIONS).write_text(json.dumps({}))
    else:
        draw(figures, sources, root, report)
    assemble(root, source, printed)
    return build(source.absolute(), options.output, (options.work / "node").absolute(), report)


def draw(
    folder: Path, sources: Iterable[Source], root: Path, report: Callable[[str], None]
) -> None:
    """Draw the figures of each mechanism, unless those that are there are of the same code."""
    common = sorted(p for pattern in DRAWN_BY for p in root.glob(pattern))
    for source in sources:
        digest = hashlib.sha256()
        for path in (*common, root / "generated" / "numpy" / f"{source.name}.py"):
            digest.update(path.read_bytes())
        stamp = folder / f"{source.name}.drawn"
        if stamp.is_file() and stamp.read_text() == digest.hexdigest():
            continue
        for line in draw_all(folder, [source.name], ".svg"):
            report(f"drawn: {line.rstrip()}")
        stamp.write_text(digest.hexdigest())
