"""What an attack reports, and how a failing case is kept."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

CASES = Path(__file__).parent / "cases"


@dataclass(frozen=True)
class Failure:
    """A failing case: what went wrong, and everything needed to try it again."""

    attack: str
    problem: str
    case: Mapping[str, Any]

    def save(self, folder: Path = CASES) -> Path:
        """Write the case to a file that is named after its content."""
        text = json.dumps({"attack": self.attack, "problem": self.problem, **self.case}, indent=1)
        mark = hashlib.sha256(text.encode()).hexdigest()[:12]
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / f"{self.attack}-{mark}.json"
        path.write_text(text + "\n", "utf-8")
        return path


@dataclass
class Outcome:
    """One round of an attack: how often each thing was tried, by subject, and what failed."""

    counts: dict[str, Counter[str]] = field(default_factory=dict)
    failures: list[Failure] = field(default_factory=list)

    def count(self, subject: str, **numbers: int) -> None:
        self.counts.setdefault(subject, Counter()).update(numbers)

    def add(self, other: Outcome) -> None:
        for subject, numbers in other.counts.items():
            self.counts.setdefault(subject, Counter()).update(numbers)
        self.failures += other.failures


def hexed(values: Any) -> list[str]:
    """Floats as text that reads back exactly."""
    return [float(v).hex() for v in values]


def unhexed(texts: Any) -> list[float]:
    return [float.fromhex(t) for t in texts]
