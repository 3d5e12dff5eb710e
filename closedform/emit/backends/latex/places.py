"""Where an article shows figures: in its sections and at steps of its derivation."""

from __future__ import annotations

import re

SECTIONS = ("", "ik")
"""The sections that have figures: that of the mechanism, without a name, and that of ``ik``."""


def place(step: str) -> str:
    """How the articles call a step with figures: by its title, in letters that TeX takes."""
    return "step-" + re.sub(r"[^A-Za-z0-9]+", "-", step).strip("-").lower()
