"""Prints nanoseconds a posture, and how many times the peer takes, as one table."""

import pytest

PEER = "lambdify"


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
    ours = [b for b in backends if b != PEER]
    header = ["function", "postures", *(f"{b}, ns" for b in backends)]
    header += [f"{PEER} / {b}" for b in ours]
    terminalreporter.section("median of one posture")
    terminalreporter.write_line("| " + " | ".join(header) + " |")
    terminalreporter.write_line("|---|---" + "|---:" * (len(header) - 2) + "|")
    for key, row in medians.items():
        cells = [f"{row.get(b, float('nan')):.1f}" for b in backends]
        cells += [f"{row.get(PEER, float('nan')) / row.get(b, float('nan')):.2g}" for b in ours]
        terminalreporter.write_line("| " + " | ".join([*key, *cells]) + " |")
