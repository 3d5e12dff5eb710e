"""Times competitors that take turns, so that what else the machine does touches them alike."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Mapping


def medians(runs: Mapping[str, Callable[[], float]], rounds: int) -> dict[str, float]:
    """The median of what each run returns, its time in any unit."""
    times: dict[str, list[float]] = {name: [] for name in runs}
    for _ in range(rounds):
        for name, run in runs.items():
            times[name].append(run())
    return {name: statistics.median(t) for name, t in times.items()}
