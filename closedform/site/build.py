"""The site: the pages of the mechanisms and the documents of the project, built by Sphinx."""

from __future__ import annotations

import hashlib
import re
import shutil
from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from pathlib import Path
from typing import IO, Any, cast

import closedform
from closedform.lazy import homes
from closedform.pipeline.folders import generated
from closedform.pipeline.run import Files, write
from closedform.pipeline.scripts import sources
from closedform.site.bars import with_bars
from closedform.site.node import MODULES, bundle, install

DOCUMENTS = (
    "docs/*.md",
    "docs/figures/*.svg",
    "docs/decisions/*.md",
    "generated/errata.md",
    "benchmarks/RESULTS.md",
    "SECURITY.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
)
"""Documents that are copied to the same places as in the repository, so that links work."""

SHARED = ("Solutions", "Positions", "Status", "Skeleton", "SkeletonJoint")
"""What all generated modules have in common."""
SIGNS = (
    "U+20-7E,U+A0-FF,U+302,U+307,U+370-3FF,U+2010-2044,U+2061-2064,U+20D0-20FF,U+210E,U+2190-22FF,"
    "U+2308-230B,U+23DC-23E1,U+25A0-25FF,U+27E8-27E9,U+2A7D-2A7E,U+1D400-1D467,U+1D6A4-1D71B"
)
LANDMARKS = {
    '<aside class="sidebar-drawer">': 'aria-label="All pages"',
    '<aside class="toc-drawer">': 'aria-label="Contents of this page"',
    '<aside class="toc-drawer no-toc">': 'aria-label="Contents of this page"',
    '<p class="caption" role="heading">': 'aria-level="2"',
}
HERE = re.compile(r"\[([^\]]*)\]\(#([\w-]+)\)")
INLINE = re.compile(r"\$`([^`]*)`\$")
TO_CODE = re.compile(r"\[([^\]]*)\]\([^)\s]*\.(?:py|cff)\)|\[([^\]]*)\]\([^)\s]*LICENSE\)")

CONFIGURATION: dict[str, Any] = {
    "project": "closedform",
    "author": "The closedform authors",
    "copyright": "The closedform authors, MIT licence",
    "extensions": [
        "myst_parser",
        "sphinx_design",
        "sphinx.ext.autodoc",
        "sphinx.ext.napoleon",
        "closedform.site.extension",
    ],
    "html_theme": "furo",
    "html_title": "closedform",
    "html_favicon": "_static/favicon.svg",
    "html_static_path": ["_static"],
    "html_css_files": ["formulas.css", "site.css", "explorer.css"],
    "html_math_renderer": "mathml",
    "html_show_sphinx": False,
    "html_copy_source": False,
    "html_show_sourcelink": False,
    "html_theme_options": {"source_repository": "", "navigation_with_keys": False},
    "myst_enable_extensions": ["colon_fence", "attrs_inline", "dollarmath"],
    "myst_heading_anchors": 4,
    "smartquotes": False,
    "autodoc_member_order": "bysource",
    "autodoc_typehints": "none",
    "napoleon_google_docstring": False,
    "highlight_language": "none",
    "toc_object_entries": False,
}


def assemble(root: Path, source: Path, printed: Files) -> None:
    """Bring all pages together below ``source``; ``root`` is the checkout."""
    pages: Files = dict(printed)
    for pattern in DOCUMENTS:
        for found in sorted(root.glob(pattern)):
            text = found.read_text("utf-8")
            pages[found.relative_to(root)] = for_sphinx(text) if found.suffix == ".md" else text
    results = Path("benchmarks", "RESULTS.md")
    pages[results] = with_bars(pages[results])
    for name, text in references().items():
        pages[Path("reference", f"{name}.md")] = text
    for stale in source.rglob("*.md"):
        if stale.relative_to(source) not in pages:
            stale.unlink()
    write(source, pages)  # only what has changed, because Sphinx reads that again
    shutil.copytree(Path(__file__).parent / "static", source / "_static", dirs_exist_ok=True)


def for_sphinx(text: str) -> str:
    """A document as GitHub shows it, for Sphinx: its formulas, and no links to code."""
    text = INLINE.sub(r"{math}`\1`", text).replace("```math", "```{math}")
    text = text.replace("```csv", "```text")  # no highlighter knows it
    marks = set(re.findall(r'<a id="([^"]+)"></a>', text))
    text = HERE.sub(lambda m: f'<a href="#{m[2]}">{m[1]}</a>' if m[2] in marks else m[0], text)
    return TO_CODE.sub(lambda m: m[1] or m[2], text)


def references() -> dict[str, str]:
    """The pages of what is written by hand, from its docstrings."""
    runtime = "closedform.generated.numpy._runtime"
    return {
        "toolkit": reference("closedform", sorted(homes(closedform.__path__))),
        "robots": reference("closedform.robots"),
        "plot": reference("closedform.plot"),
        "shared": reference(runtime, SHARED, "What all generated modules share"),
    }


def reference(module: str, names: Sequence[str] = (), title: str = "") -> str:
    """The page of a module: these names, or what it exports."""
    lines = [f"# {title or f'`{module}`'}", "", "```{eval-rst}"]
    lines += [] if title else [f".. automodule:: {module}"]
    found = import_module(module)
    for name in names or found.__all__:
        value = getattr(found, name)
        if callable(value):
            kind = "class" if isinstance(value, type) else "function"
            lines += ["", f".. auto{kind}:: {module}.{name}"]
            lines += ["   :members:"] if kind == "class" else []
    return "\n".join([*lines, "```", ""])


def build(source: Path, target: Path, node: Path, report: Callable[[str], None]) -> int:
    """Run Sphinx; the number of its warnings, each of which is reported."""
    from sphinx.application import Sphinx
    from sphinx.util.docutils import docutils_namespace, patch_docutils

    install(node)
    warnings = _Lines(report)
    libraries, static = node / MODULES, source / "_static"
    shutil.copyfile(libraries / "temml/dist/Temml-STIX2.css", static / "formulas.css")
    package = libraries / "@fontsource/stix-two-math"
    [font] = (package / "files").glob("*-400-normal.woff2")
    subset_font(font, static / "STIXTwoMath.woff2")
    shutil.copyfile(package / "LICENSE", static / "STIXTwoMath-LICENSE.txt")
    bundle(node, Path(__file__).parent / "explorer", generated() / "js", static, compared())
    with patch_docutils(), docutils_namespace():
        app = Sphinx(
            srcdir=source,
            confdir=None,
            outdir=target,
            doctreedir=source.parent / "doctrees",
            buildername="html",
            confoverrides={
                **CONFIGURATION,
                "closedform_node": str(node),
                "closedform_code": _digest(Path(__file__).parent.glob("*.py")),
            },
            status=None,
            warning=cast(IO[str], warnings),
        )
        app.build()
    for page in target.rglob("*.html"):
        name_landmarks(page)
    return warnings.count


def compared() -> dict[str, str]:
    """Each mechanism, with the one that models it as its paper does, or nothing."""
    from closedform.derivations.figures import view

    return {source.name: view(source.name).published for source in sources()}


def _digest(paths: Iterable[Path]) -> str:
    """A digest of the code; if it changes, all pages are read again."""
    return hashlib.sha256(b"".join(p.read_bytes() for p in sorted(paths))).hexdigest()


def subset_font(source: Path, target: Path) -> None:
    """The signs that formulas use, a quarter of the font."""
    from fontTools.subset import main

    if not target.is_file():
        features = "--layout-features=*"
        main(
            [
                str(source),
                f"--unicodes={SIGNS}",
                features,
                "--flavor=woff2",
                f"--output-file={target}",
            ]
        )


def name_landmarks(page: Path) -> None:
    """Give the parts of a page the names that a screen reader tells, where the theme has none."""
    text = found = page.read_text("utf-8")
    for part, name in LANDMARKS.items():
        text = text.replace(part, f"{part[:-1]} {name}>")
    if text != found:
        page.write_text(text, "utf-8")


class _Lines:
    """A stream that hands on each line."""

    def __init__(self, report: Callable[[str], None]):
        self.report, self.count = report, 0

    def write(self, text: str) -> None:
        for line in text.splitlines():
            if line.strip():
                self.count += 1
                self.report(line)

    def flush(self) -> None:
        pass
