"""From derivation scripts to files: find, prove and print them, and write what changed.

SymPy is imported only when a derivation is loaded, so that listing works without it.
"""

from __future__ import annotations

import ast
import contextlib
import hashlib
import importlib
import importlib.util
import json
import os
import re
import sys
import time
import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from closedform.emit.backends import names as backend_names
from closedform.pipeline.disk import replace
from closedform.pipeline.imports import package, sources_of
from closedform.pipeline.kept import KeptPages, digest_of, keeps, printing_digest
from closedform.pipeline.workers import each

if TYPE_CHECKING:
    from closedform.algebra.certificates import Record
    from closedform.emit.pages import Printed as Pages
    from closedform.emit.pages import Share
    from closedform.model.derivation import Derivation
    from closedform.proof.prove import Proof

BACKENDS = backend_names()
EXTRA = ("sympy", "flint", "jinja2")
COMPILED = frozenset({".so", ".pyd", ".pyc"})
NOT_PROVED = (ValueError, TypeError, ArithmeticError, NotImplementedError)
"""What is raised if a proof fails or cannot be carried out."""

Files = dict[Path, str]
Report = Callable[[str, str], None]


class DerivationError(Exception):
    """A derivation that cannot be loaded or proved: its name, and what is wrong."""

    def __str__(self) -> str:
        name, message = self.args
        return f"{name}: {message}"


class UnknownNameError(Exception):
    """There is no derivation of this name."""


@dataclass(frozen=True)
class Source:
    """A derivation script; ``module`` is empty for a file outside the package."""

    name: str
    path: Path
    module: str = ""

    @property
    def title(self) -> str:
        """The first line of the script's docstring."""
        docstring = ast.get_docstring(ast.parse(self.path.read_bytes())) or ""
        return docstring.partition("\n")[0]


@dataclass(frozen=True)
class Printed:
    """One robot: its proof, the seconds it took, whether it was stored, and the files."""

    name: str
    proof: Proof
    seconds: float
    stored: bool
    files: Files
    share: Share
    given_up: bool = False
    """Whether it has no inverse because the limit of time was reached."""

    def line(self, width: int = 0) -> str:
        taken = f"{self.seconds:.1f} s{' (unchanged)' if self.stored else ''}"
        return f"{self.name:<{width}}  {self.proof.summary()}; {taken}"


@dataclass(frozen=True)
class Result:
    """Every robot that was printed, the files they share, and what failed.

    A neighbour is a robot that was not chosen but shares files with those that were.  If any robot
    fails, ``shared`` is empty.
    """

    robots: tuple[Printed, ...]
    shared: Files
    failures: tuple[DerivationError, ...]
    neighbours: tuple[DerivationError, ...] = ()

    @property
    def files(self) -> Files:
        robots = {path: text for robot in self.robots for path, text in robot.files.items()}
        return {**robots, **self.shared}


# Where things are


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


def sources() -> list[Source]:
    """The derivation scripts of the package, by name."""
    return [
        Source(path.stem, path, f"closedform.derivations.{path.stem}")
        for path in sorted(scripts().glob("*.py"))
        if _assigns_d(path.read_bytes())
    ]


def find(names: Sequence[str]) -> list[Source]:
    """The scripts with these names or paths; all scripts of the package if none is given."""
    known = {source.name: source for source in sources()}
    if not names:
        return list(known.values())
    return [_find(name, known) for name in dict.fromkeys(names)]


def _find(name: str, known: Mapping[str, Source]) -> Source:
    if name in known:
        return known[name]
    path = Path(name)
    if path.suffix != ".py":
        raise UnknownNameError(name)
    path = path.resolve()
    for source in known.values():
        if source.path.resolve() == path:
            return source
    if not path.is_file():
        raise UnknownNameError(name)
    return Source(path.stem, path)


@cache
def _assigns_d(text: bytes) -> bool:
    """Whether a script assigns ``d``.  If it does not parse, True: the error is reported later."""
    try:
        statements = ast.parse(text).body
    except SyntaxError:
        return True
    targets: list[ast.expr] = []
    for statement in statements:
        if isinstance(statement, ast.Assign):
            targets += statement.targets
        elif isinstance(statement, ast.AnnAssign):
            targets.append(statement.target)
    return any(isinstance(t, ast.Name) and t.id == "d" for t in targets)


# Loading and proving


def _same_choices() -> None:
    """Let SymPy try the same points every time: where it factors, an unlucky one takes minutes."""
    from sympy.core import random

    random.seed(0)


def load(source: Source) -> Derivation:
    """Run a derivation script."""
    from closedform.model.derivation import Derivation

    _same_choices()
    try:
        module = _module(source)
    except Exception as error:
        raise DerivationError(source.name, _located(error, source.path)) from error
    derivation = getattr(module, "d", None)
    if not isinstance(derivation, Derivation):
        raise DerivationError(source.name, f"{source.path.name} must assign a Derivation to d")
    if derivation.name != source.name:
        raise DerivationError(
            source.name,
            f"the derivation calls itself {derivation.name}; name the file {derivation.name}.py",
        )
    return derivation


def _module(source: Source) -> Any:
    if source.module:
        return importlib.import_module(source.module)
    digested = digest_of(sources_of([source.path]))
    if (known := _modules.get(source.path)) and known[0] == digested:
        return known[1]
    folder = str(source.path.parent)
    if folder not in sys.path:
        sys.path.append(folder)
    spec = importlib.util.spec_from_file_location(f"_derivation_{source.name}", source.path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    _modules[source.path] = digested, module
    return module


_modules: dict[Path, tuple[str, Any]] = {}
"""Scripts outside the package that were run, each with a digest of its sources."""


def _located(error: Exception, path: Path) -> str:
    """An error with the last line of the script that led to it."""
    lines = [
        frame.lineno
        for frame in traceback.extract_tb(error.__traceback__)
        if frame.filename == str(path)
    ]
    place = f"{path.name}, line {lines[-1]}: " if lines else ""
    return f"{place}{type(error).__name__}: {error}"


def _proved(derivation: Derivation, report: Report) -> tuple[Proof, Record]:
    from closedform.algebra.certificates import recording
    from closedform.proof.prove import prove

    _same_choices()
    try:
        with recording() as record:
            proof = prove(derivation, lambda what: report(derivation.name, f"proving {what}"))
        return proof, record
    except NOT_PROVED as error:
        message = str(error).removeprefix(derivation.name).lstrip(",.: ")
        raise DerivationError(derivation.name, f"not proved: {message}") from error


# Proofs are kept


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

    def pages(self, source: Source, digested: str, backends: Sequence[str]) -> Pages | None:
        """What was printed of a script, if nothing has changed since; not of foreign back ends."""
        if self._pages and keeps(backends):
            return self._pages.get(source.name, digested, backends)
        return None

    def put_pages(
        self, source: Source, digested: str, backends: Sequence[str], printed: Pages
    ) -> None:
        """Keep what was printed.  If the disk is read-only, it is printed again the next time."""
        if self._pages and keeps(backends):
            with contextlib.suppress(OSError):
                self._pages.put(source.name, digested, backends, printed)

    @property
    def _pages(self) -> KeptPages | None:
        return KeptPages(self.folder.with_name("pages")) if self.folder else None

    def _path(self, source: Source) -> Path:
        if self.folder is None:
            raise FileNotFoundError
        return self.folder / f"{source.name}.json"


def default_store() -> Store:
    """The store in ``build/`` of a checkout; an installed package keeps nothing."""
    root = checkout()
    return Store(root / "build" / "proofs" if root else None)


def digest(source: Source) -> str:
    """A digest of the script, of everything that it and the proof import, and of the algebra."""
    algebra = [f"{package} {version(package)}\n" for package in ("sympy", "python-flint")]
    return digest_of(sources_of([source.path, package() / "proof" / "prove.py"]), algebra)


# Printing


def print_robot(
    source: Source,
    backends: Sequence[str],
    *,
    store: Store,
    report: Report,
    fresh: bool = False,
    timeout: float = 0,
) -> Printed:
    """Prove one robot, unless its stored proof is still valid, and print its files.

    Parameters
    ----------
    source
        the script
    backends
        the names of what is printed
    store
        where proofs are kept
    report
        is told the robot and what is being done
    fresh
        whether it is proved in any case
    timeout
        after so many seconds of computing, its inverse is given up; then it has as many seconds
        without one; 0 is no limit
    """
    from closedform.scaffold.limit import LimitError, bounded

    doing = ["starting"]

    def say(what: str) -> None:
        doing[0] = what
        report(source.name, what)

    def attempt(reason: str = "") -> Printed:
        def work(report: Callable[[str], None]) -> Printed:
            return _printed(
                source,
                backends,
                store=store,
                fresh=fresh,
                report=lambda _, what: report(what),
                given_up=reason,
            )

        return bounded(timeout, work, say)

    try:
        return attempt()
    except LimitError:
        reason = f"the limit of {timeout:g} s was reached while {doing[0]}"
    try:
        return attempt(reason)
    except LimitError:
        message = f"{reason}, and again without the inverse; allow more time with --timeout"
        raise DerivationError(source.name, message) from None


def _printed(
    source: Source,
    backends: Sequence[str],
    *,
    store: Store,
    fresh: bool,
    report: Report,
    given_up: str,
) -> Printed:
    """Print one robot; without its inverse if that was ``given_up`` for a reason."""
    start = time.perf_counter()
    digested = f"{digest(source)} {given_up}".rstrip()
    printing = printing_digest(digested)
    known = None if fresh else store.get(source, digested)
    stored = known is not None
    pages = store.pages(source, printing, backends) if known else None
    if known is None or pages is None:
        report(source.name, "deriving")
        derivation = load(source)
        if given_up:
            derivation.give_up_inverses(given_up)
        if known is None:
            report(source.name, "proving")
            proof, record = _proved(derivation, report)
            known = proof, time.perf_counter() - start
            store.put(source, digested, proof, record, known[1])
        report(source.name, "generating")
        pages = _pages(derivation, known[0], backends)
        store.put_pages(source, printing, backends, pages)
    proof, seconds = known
    return Printed(
        name=source.name,
        proof=proof,
        seconds=seconds,
        stored=stored,
        files=pages.files,
        share=pages.share,
        given_up=bool(given_up),
    )


def _pages(derivation: Derivation, proof: Proof, backends: Sequence[str]) -> Pages:
    from closedform.emit.pages import pages

    _same_choices()
    try:
        return pages(derivation, proof, backends)
    except (ValueError, TypeError, KeyError, NotImplementedError) as error:
        raise DerivationError(derivation.name, f"not printed: {error}") from error


def run(
    chosen: Sequence[Source],
    backends: Sequence[str] = BACKENDS,
    *,
    together: Sequence[Source] | None = None,
    store: Store | None = None,
    fresh: bool = False,
    jobs: int = 1,
    timeout: float = 0,
    report: Report = lambda _name, _what: None,
) -> Result:
    """Print the chosen robots, and the files that all robots share.

    Parameters
    ----------
    chosen
        the scripts to print
    backends
        the names of what is printed
    together
        the scripts that share files, by default the chosen ones
    store
        where proofs are kept, by default the usual place
    fresh
        whether robots are proved whose stored proof is valid
    jobs
        how many robots are printed at a time
    timeout
        that of :func:`print_robot`; with one, robots are printed one after another
    report
        is told the robot and what is being done
    """
    from closedform.emit.pages import shared_files

    store = store or default_store()
    together = chosen if together is None else together
    everyone = list(dict.fromkeys([*chosen, *together]))
    job = partial(print_robot, backends=backends, store=store, fresh=fresh, timeout=timeout)
    robots, failures = _each(job, everyone, 1 if timeout else min(jobs, len(everyone)), report)
    shared: Files = {}
    if not failures:
        report("", "generating shared files")
        shares = {robot.name: robot.share for robot in robots}
        try:
            shared = shared_files([shares[s.name] for s in together], backends)
        except ValueError as error:
            raise DerivationError("shared files", f"not printed: {error}") from error
    names = {source.name for source in chosen}
    return Result(
        tuple(r for r in robots if r.name in names),
        shared,
        tuple(f for f in failures if f.args[0] in names),
        tuple(f for f in failures if f.args[0] not in names),
    )


def _each(
    job: Callable[..., Printed], chosen: Sequence[Source], jobs: int, report: Report
) -> tuple[list[Printed], list[DerivationError]]:
    outcomes: dict[str, Printed | DerivationError] = {}
    if jobs > 1:
        for source, outcome in each(job, sorted(chosen, key=_length, reverse=True), jobs, report):
            if not isinstance(outcome, Printed | DerivationError):
                raise outcome
            outcomes[source.name] = outcome
            report(source.name, "")
    else:
        for source in chosen:
            try:
                outcomes[source.name] = job(source, report=report)
            except DerivationError as error:
                outcomes[source.name] = error
            report(source.name, "")
    ordered = [outcomes[source.name] for source in chosen]
    return (
        [o for o in ordered if isinstance(o, Printed)],
        [o for o in ordered if isinstance(o, DerivationError)],
    )


def _length(source: Source) -> int:
    """A guess at how long a proof takes; the longest comes first."""
    return sum(path.stat().st_size for path in sources_of([source.path]))


def default_jobs() -> int:
    """One process for each core, or as many as ``make -j N`` allows."""
    flags = os.environ.get("MAKEFLAGS", "") if "MAKELEVEL" in os.environ else ""
    match = re.search(r"(?:^|\s)-j ?(\d+)(?=\s|$)", flags)
    return int(match[1]) if match else os.cpu_count() or 1


# Writing and comparing


def write(root: Path, printed: Files) -> list[Path]:
    """Write only the files that differ, because make goes by timestamps.  Return their paths."""
    written = []
    for path, text in sorted(printed.items()):
        target, content = root / path, text.encode()
        if not target.is_file() or target.read_bytes() != content:
            replace(target, content)
            written.append(path)
    return written


def extra_files(root: Path, printed: Iterable[Path], backends: Sequence[str]) -> list[Path]:
    """Files in ``generated/`` that no derivation prints any more."""

    expected = set(printed)
    present = [
        path.relative_to(root)
        for backend in backends
        for path in sorted((root / backend).rglob("*"))
        if path.is_file() and path.suffix not in COMPILED and path.name != "__init__.py"
    ]
    return [path for path in present if path not in expected]
