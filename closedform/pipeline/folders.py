"""Where the scripts, the generated files and the checkout are."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path


def generated() -> Path:
    """The folder of the generated package, in a checkout or as installed."""
    return Path(str(files("closedform.generated")))


def checkout() -> Path | None:
    """The root of the repository, or None if the package was installed from a wheel."""
    root = generated().parent
    return root if (root / "pyproject.toml").is_file() else None


def scripts() -> Path:
    """The folder of the derivation scripts."""
    return Path(str(files("closedform.derivations")))
