"""Proofs and printed pages on disk, so that only what changes is proved and printed again."""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import pickle
import sys
from collections.abc import Sequence
from dataclasses import is_dataclass
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

from closedform.pipeline import folders
from closedform.pipeline.disk import replace
from closedform.pipeline.imports import digest_of, package
from closedform.pipeline.scripts import Source, digest

if TYPE_CHECKING:
    from closedform.algebra.certificates import Record
    from closedform.emit.pages import Printed
    from closedform.proof.prove import Proof

OURS = "closedform"
KNOWN = (OURS, "pathlib")
RUNTIME = "runtime"


class Store:
    """Proofs on disk, each with a digest of everything that it depends on.

    Certificates and printed pages are in folders next to that of the proofs.
    """

    def __init__(self, folder: Path | None):
        self.folder = folder

    def get(self, source: Source, digested: str | None = None) -> tuple[Proof, float] | None:
        """The proof of a script and the seconds it took, if nothing has changed since."""
        from closedform.proof.prove import Proof

        try:
            data = self.read(source)
            certified = hashlib.sha256(self.certificates(source).read_bytes()).hexdigest()
            if data["digest"] == (digested or digest(source)) and data["certificates"] == certified:
                return Proof.from_dict(data["proof"]), float(data["seconds"])
        except (OSError, ValueError, KeyError, TypeError):
            pass
        return None

    def put(
        self, source: Source, digested: str, proof: Proof, record: Record, seconds: float
    ) -> None:
        """Keep a proof.  If the disk is read-only, the script is proved again the next time.

        ``digested`` is the digest from before the proof, because a script may be edited meanwhile.
        """
        certificates = record.text(source.name, digested).encode()
        data = {
            "digest": digested,
            "certificates": hashlib.sha256(certificates).hexdigest(),
            "seconds": seconds,
            "proof": proof.as_dict(),
        }
        with contextlib.suppress(OSError):
            replace(self.certificates(source), certificates)
            replace(self._path(source), (json.dumps(data, indent=1) + "\n").encode())

    def read(self, source: Source) -> dict[str, Any]:
        """What is stored of a proof, even if something has changed since."""
        data: dict[str, Any] = json.loads(self._path(source).read_text("utf-8"))
        return data

    def certificates(self, source: Source) -> Path:
        """The file with the certificates of a proof."""
        return self._path(source).parent.with_name("certificates") / f"{source.name}.json"

    def pages(self, source: Source, digested: str, backends: Sequence[str]) -> Printed | None:
        """What was printed of a script, if nothing has changed since."""
        try:
            file = io.BytesIO(self._pages(source, backends).read_bytes())
            known, printed = _Data(file).load()
        except Exception:  # absent, cut short, or of another version: a pickle raises anything
            return None
        return printed if known == digested else None

    def put_pages(
        self, source: Source, digested: str, backends: Sequence[str], printed: Printed
    ) -> None:
        """Keep what was printed, unless the disk is read-only or a back end is of someone else.

        The digest covers only back ends of the toolkit.
        """
        if all("." not in name or name.startswith(f"{OURS}.") for name in backends):
            with contextlib.suppress(OSError):
                replace(self._pages(source, backends), pickle.dumps((digested, printed)))

    def _pages(self, source: Source, backends: Sequence[str]) -> Path:
        name = f"{source.name}.{'+'.join(backends)}.pickle"
        return self._path(source).parent.with_name("pages") / name

    def _path(self, source: Source) -> Path:
        if self.folder is None:
            raise FileNotFoundError
        return self.folder / f"{source.name}.json"


def default_store() -> Store:
    """The store in ``build/`` of a checkout; an installed package keeps nothing."""
    root = folders.checkout()
    return Store(root / "build" / "proofs" if root else None)


class _Data(pickle.Unpickler):
    """Reads paths and dataclasses of the toolkit, but runs no code that a file names."""

    def find_class(self, module: str, name: str) -> Any:
        found = super().find_class(module, name) if module.split(".")[0] in KNOWN else None
        if isinstance(found, type) and (is_dataclass(found) or issubclass(found, PurePath)):
            return found
        raise pickle.UnpicklingError(f"{module}.{name} is not data")


def printing_digest(derived: str) -> str:
    """A digest of all that pages depend on: a derivation, given by its digest, and the toolkit.

    The digest of the derivation has the versions of SymPy and python-flint.
    """
    found = [path for path in package().rglob("*.py") if path.is_file()]
    for folder in (package() / RUNTIME, Path(str(files(f"{OURS}.templates")))):
        found += [path for path in folder.rglob("*") if path.is_file() and path.suffix != ".pyc"]
    tools = [f"Python {sys.version}\n", f"jinja2 {version('jinja2')}\n"]
    return digest_of(sorted(set(found)), [derived, *tools])
