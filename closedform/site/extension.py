"""The Sphinx extension of the pages: formulas as MathML, and directives for what is not text."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path
from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from sphinx.writers.html5 import HTML5Translator

from closedform.emit.markup import escaped, inline
from closedform.site.node import Renderer

BAR = re.compile(r"(?<![`\\])\|(?!`)")


def renderer(app: Sphinx) -> Renderer:
    """The one process of a build that sets formulas."""
    if not hasattr(app, "closedform_renderer"):
        app.closedform_renderer = Renderer(Path(app.config.closedform_node))  # type: ignore[attr-defined]
    found: Renderer = app.closedform_renderer  # type: ignore[attr-defined]
    return found


def _formula(self: HTML5Translator, node: nodes.math) -> None:
    text = renderer(self.builder.app).formula(node.astext(), wrap=True)
    self.body.append(text)
    raise nodes.SkipNode


def _block(self: HTML5Translator, node: nodes.math_block) -> None:
    text = renderer(self.builder.app).formula(node.astext(), display=True)
    self.body.append(f'<div class="display">{text}</div>')
    raise nodes.SkipNode


class Display(SphinxDirective):
    """Equations that are aligned, with their numbers."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        text = renderer(self.env.app).formula("\n".join(self.content), display=True)
        return [_raw(f'<div class="display" tabindex="0">{text}</div>')]


class Paragraph(SphinxDirective):
    """A formula that breaks like text where it is too long."""

    has_content = True
    option_spec: ClassVar[dict[str, Any]] = {
        "number": directives.unchanged,
        "name": directives.unchanged,
    }

    def run(self) -> list[nodes.Node]:
        set_ = renderer(self.env.app).formula
        text = set_(rf"\displaystyle {' '.join(self.content)}", wrap=True)
        number, name = self.options.get("number"), self.options.get("name", "")
        mark = f'<span class="number">({number})</span>' if number else ""
        name = f' id="{html.escape(name)}"' if name else ""
        return [_raw(f'<div class="paragraph"{name}><div tabindex="0">{text}</div>{mark}</div>')]


class Details(SphinxDirective):
    """Text that unfolds under a summary."""

    has_content = True
    required_arguments = 1
    final_argument_whitespace = True
    option_spec: ClassVar[dict[str, Any]] = {"class": directives.unchanged}

    def run(self) -> list[nodes.Node]:
        text, messages = self.state.inline_text(self.arguments[0], self.lineno)
        inner = nodes.container(classes=["inner"])
        self.state.nested_parse(self.content, self.content_offset, inner)
        kind = html.escape(self.options.get("class", ""))
        return [
            _raw(f'<details class="{kind}"><summary>'),
            *messages,
            _Summary("", "", *text),
            _raw("</summary>"),
            inner,
            _raw("</details>"),
        ]


class _Summary(nodes.inline):  # type: ignore[misc]
    """What stands in a summary: without a paragraph around it."""


class Explorer(SphinxDirective):
    """The explorer of a mechanism; the content is what it is told of the mechanism, as JSON."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        info = json.loads("\n".join(self.content))
        info |= shown(info["name"])
        info = typeset(info, renderer(self.env.app))
        up = "../" * self.env.docname.count("/")
        data = json.dumps(info, ensure_ascii=False).replace("<", "\\u003c")
        name = html.escape(info["name"])
        return [
            _raw(
                f'<div class="explorer" data-robot="{name}">'
                f'<script type="application/json" class="explorer-info">{data}</script></div>\n'
                f'<script defer src="{up}_static/explorer/{name}.js"></script>'
            )
        ]


def shown(name: str) -> dict[str, Any]:
    """How a mechanism is shown: its postures and the section of its workspace."""
    from importlib import import_module

    from closedform.derivations.figures import view
    from closedform.plot.robot import Robot

    module = import_module(f"closedform.generated.numpy.{name}")
    found = view(name)
    general = found.general if found.general is not None else Robot.of(module).posture()
    home = found.home if found.home is not None else [0.0] * len(module.JOINTS)
    answer: dict[str, Any] = {
        "home": [float(v) for v in home],
        "general": [float(v) for v in general],
        "faint": list(found.faint),
        "about": Robot.of(module).centre,
        "rails": Robot.of(module).rails,
        "mode": found.mode,
    }
    if found.plane:
        answer["plane"] = list(found.plane)
    return answer


def typeset(info: Any, render: Renderer) -> Any:
    """The same with its formulas as MathML."""
    if isinstance(info, list):
        return [typeset(part, render) for part in info]
    if not isinstance(info, dict):
        return info
    return {
        key: render.formula(part) if key == "formula" else typeset(part, render)
        for key, part in info.items()
    }


class Graph(SphinxDirective):
    """A graph in the language of Graphviz."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        text = renderer(self.env.app).graph("\n".join(self.content))
        text = text[text.index("<svg") :]
        text = re.sub(r'<polygon fill="white" stroke="none"[^>]*/>', "", text, count=1)
        text = re.sub(r"<title>.*?</title>", "", text, flags=re.DOTALL)
        label = "What rests on what"
        text = text.replace("<svg ", f'<svg role="group" aria-label="{label}" ', 1)
        return [_raw(f'<div class="graph" tabindex="0">{text}</div>')]


class Figures(SphinxDirective):
    """The figures of a mechanism, with their captions."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        name = self.arguments[0]
        folder = Path(self.env.srcdir) / "figures"
        captions = json.loads((folder / "captions.json").read_text("utf-8"))
        found: list[nodes.Node] = []
        for key, caption in captions.items():
            owner, _, figure = key.rpartition("-")
            if owner == name and (folder / f"{key}.svg").is_file():
                picture = nodes.figure(classes=["drawing"])
                picture += nodes.image(uri=f"/figures/{key}.svg", alt=figure, loading="lazy")
                parts = caption.split("$")
                marked = (inline(t) if k % 2 else escaped(t) for k, t in enumerate(parts))
                text, _ = self.state.inline_text("".join(marked), self.lineno)
                picture += nodes.caption(caption, "", *text)
                found.append(picture)
        return found


def _raw(text: str) -> nodes.raw:
    return nodes.raw("", text, format="html")


def _nothing(self: HTML5Translator, node: nodes.Node) -> None:
    pass


def _bars(_app: Sphinx, *documented: Any) -> None:
    """Absolute values in docstrings, the last argument, which are not references."""
    lines = documented[-1]
    lines[:] = [BAR.sub(r"\|", line) for line in lines]


def _without_design(
    _app: Sphinx, _page: str, _template: str, context: dict[str, Any], _tree: Any
) -> None:
    """Leave out styles and scripts of cards and tabs where a page has none."""
    if 'class="sd-' not in context.get("body", ""):
        for kind in ("css_files", "script_files"):
            files = context[kind]
            context[kind] = [f for f in files if "design" not in str(getattr(f, "filename", f))]


def setup(app: Sphinx) -> dict[str, Any]:
    app.add_config_value("closedform_node", "", "")
    app.add_config_value("closedform_code", "", "env")
    app.add_html_math_renderer("mathml", (_formula, None), (_block, None))
    app.add_node(_Summary, html=(_nothing, _nothing))
    for directive in (Display, Paragraph, Details, Explorer, Graph, Figures):
        app.add_directive(directive.__name__.lower(), directive)
    app.connect("autodoc-process-docstring", _bars)
    app.connect("html-page-context", _without_design)
    app.connect("build-finished", lambda app, _error: renderer(app).close())
    return {"parallel_read_safe": False, "parallel_write_safe": False}
