"""Attack the project with random input for a limited time, and print what was tried.

Failures are printed and saved in ``tests/fuzz/cases``; ``make test`` tries every saved case again.
The exit code is 1 if anything failed.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

import numpy as np

from . import ATTACKS
from .outcome import CASES, Outcome

SAVED = 40
"""The most failures that one run saves; more would say nothing new."""
START, END = "<!-- what was tried -->\n", "<!-- end -->\n"


def main(arguments: Sequence[str] | None = None) -> int:
    options = _parser().parse_args(arguments)
    chosen = options.attack or list(ATTACKS)
    heading = f"seed {options.seed}, {options.seconds:g} s, attacks: {', '.join(chosen)}"
    print(heading, flush=True)
    total = attack([ATTACKS[name] for name in chosen], options.seed, options.seconds)
    lines = table(total)
    print("\n".join(lines))
    if options.write:
        _write(options.write, [f"`make fuzz`, {heading}:", *lines])
    return int(any(outcome.failures for outcome in total.values()))


def attack(
    attacks: Sequence[ModuleType], seed: int, seconds: float, folder: Path = CASES
) -> dict[str, Outcome]:
    """Rounds of all attacks, each for its share of the time and at least once."""
    total = {module.NAME: Outcome() for module in attacks}
    spent = dict.fromkeys(total, 0.0)
    rounds = dict.fromkeys(total, 0)
    end, saved = time.monotonic() + seconds, 0
    while time.monotonic() < end or not all(rounds.values()):
        module = min(attacks, key=lambda a: spent[a.NAME])
        name, start = module.NAME, time.monotonic()
        outcome = module.round(np.random.default_rng([seed, *name.encode(), rounds[name]]))
        rounds[name] += 1
        spent[name] += time.monotonic() - start
        total[name].add(outcome)
        for failure in outcome.failures[: SAVED - saved]:
            print(f"{failure.save(folder)}: {failure.problem}", flush=True)
            saved += 1
    return total


def table(total: dict[str, Outcome]) -> list[str]:
    """What was tried, as Markdown."""
    lines = []
    for name, outcome in total.items():
        columns = list(dict.fromkeys(c for n in outcome.counts.values() for c in n))
        lines += ["", f"| {name} | " + " | ".join(columns) + " |"]
        lines.append("|---|" + "---:|" * len(columns))
        for subject, numbers in outcome.counts.items():
            lines.append(f"| {subject} | " + " | ".join(f"{numbers[c]:,}" for c in columns) + " |")
        if len(outcome.counts) > 1:
            sums = [sum(n[c] for n in outcome.counts.values()) for c in columns]
            lines.append("| together | " + " | ".join(f"{s:,}" for s in sums) + " |")
    return lines


def _write(path: Path, lines: Sequence[str]) -> None:
    """Put the lines between the marks of a page."""
    before, _, rest = path.read_text("utf-8").partition(START)
    _, _, after = rest.partition(END)
    path.write_text(before + START + "\n".join(lines) + "\n\n" + END + after, "utf-8")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="make fuzz ARGS=...", description=__doc__)
    parser.add_argument("--seconds", type=float, default=60, help="how long to go on (60)")
    parser.add_argument("--seed", type=int, default=1, help="the same seed draws the same (1)")
    parser.add_argument("--attack", action="append", choices=ATTACKS, help="repeatable; all")
    parser.add_argument("--write", type=Path, metavar="PAGE", help="put the tables into a page")
    return parser


if __name__ == "__main__":
    sys.exit(main())
