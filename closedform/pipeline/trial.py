"""Tries the script of a derivation before it is written: runs it, and proves its inverse."""

from __future__ import annotations

import tempfile
from pathlib import Path

from closedform.algebra.solutions import NotRationalError
from closedform.mechanics.arm import FORWARD_ALONE
from closedform.pipeline.run import NOT_PROVED
from closedform.pipeline.scripts import DerivationError, Source, load
from closedform.proof.inverse import prove_inverse


def fault(name: str, script: str) -> str:
    """A clause on why the inverse in a script is not proved; empty if it is.

    Where the proof cannot be carried out, because a parameter is below a root, nothing is known.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{name}.py"
        path.write_text(script, "utf-8")
        held = FORWARD_ALONE.set(True)
        try:
            d = load(Source(name, path))
            prove_inverse(d, d.inverses[-1])
        except (DerivationError, *NOT_PROVED) as error:
            cause = error.__cause__ if isinstance(error, DerivationError) else error
            if isinstance(cause, NotRationalError):
                return ""
            return str(cause or error).removeprefix(f"{name}.ik: ").partition(". ")[0]
        finally:
            FORWARD_ALONE.reset(held)
    return ""


__all__ = ["fault"]
