"""The tables of the benchmarks as bar charts; shorter is better."""

from __future__ import annotations

import html
import re
from collections.abc import Sequence

HEAD = re.compile(r"^\| (?P<title>.*) \| median, (?P<unit>\w+) \| times closedform \|$")
ROW = re.compile(r"^\| (?P<name>[^|]*) \| (?P<value>[0-9.]+) \|")


def with_bars(text: str) -> str:
    """The page of results with a chart above each of its tables."""
    lines: list[str] = []
    rest = text.splitlines()
    for k, line in enumerate(rest):
        if found := HEAD.match(line):
            rows = []
            for other in rest[k + 2 :]:
                row = ROW.match(other)
                if row is None:
                    break
                rows.append((row["name"].strip(), float(row["value"])))
            lines += [_chart(found["title"], found["unit"], rows), ""]
        lines.append(line)
    return "\n".join(lines) + "\n"


def _chart(title: str, unit: str, rows: Sequence[tuple[str, float]]) -> str:
    most = max((value for _, value in rows), default=1.0)
    bars = "".join(_bar(name, value, unit, value / most) for name, value in rows)
    label = html.escape(f"{title}, {unit}; the numbers are in the table", quote=True)
    return f'<div class="bars" role="img" aria-label="{label}">{bars}</div>'


def _bar(name: str, value: float, unit: str, share: float) -> str:
    kind = "bar ours" if name == "closedform" else "bar"
    width = f'<i style="width:{60 * share:.1f}%"></i>'
    told = f"<b>{value:g} {html.escape(unit)}</b>"
    return f'<div class="{kind}"><span>{html.escape(name)}</span>{width}{told}</div>'
