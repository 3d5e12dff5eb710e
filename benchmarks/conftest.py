"""Prints, after pytest-benchmark's own table, nanoseconds a posture and ratios to the peer."""

import os
from pathlib import Path

import pytest

RATIOS = Path(__file__).parent / "RESULTS.md"


def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> None:
    session = getattr(config, "_benchmarksession", None)
    if session is None or not session.benchmarks:
        return
    medians: dict[tuple[str, str], dict[str, float]] = {}
    for bench in session.benchmarks:
        if bench.has_error or not bench.stats.rounds:
            continue
        info = bench.extra_info
        row = medians.setdefault((info["case"], info["size"]), {})
        row[info["backend"]] = 1e9 * bench.stats.median / info["postures"]
    backends = list(dict.fromkeys(b for row in medians.values() for b in row))
    lines = [
        "| function | postures | "
        + " | ".join(f"{b}, ns" for b in backends)
        + " | best / lambdify |",
        "|---" * (len(backends) + 3) + "|",
    ]
    for (case, size), row in medians.items():
        peer = row.get("lambdify", float("nan"))
        best = min(v for b, v in row.items() if b != "lambdify")
        cells = [f"{row[b]:.1f}" if b in row else "" for b in backends]
        lines.append(f"| {case} | {size} | " + " | ".join(cells) + f" | {peer / best:.1f}x |")
    terminalreporter.write_line("")
    for line in lines:
        terminalreporter.write_line(line)
    if os.environ.get("CLOSEDFORM_WRITE_RESULTS"):
        RATIOS.write_text("\n".join([HEADER, *lines, ""]))


HEADER = """# Speed

Median time of one posture, measured by `make bench`. `lambdify` is `sympy.lambdify(cse=True)` with
NumPy, of the same expressions (for an inverse: all branches, no statuses). `(N, n)` are plain
arrays; `planes` are structures of arrays with `out=`.
"""
