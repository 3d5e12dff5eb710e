"""From derivation scripts to files: prove and print them, and write what changed."""

from __future__ import annotations

import os
import re
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from closedform.emit.backends import names as backend_names
from closedform.pipeline.disk import replace
from closedform.pipeline.imports import sources_of
from closedform.pipeline.scripts import DerivationError, Source, digest, load, same_choices
from closedform.pipeline.store import Store, default_store, printing_digest
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


def _proved(derivation: Derivation, report: Report) -> tuple[Proof, Record]:
    from closedform.algebra.certificates import recording
    from closedform.proof.prove import prove

    same_choices()
    try:
        with recording() as record:
            proof = prove(derivation, lambda what: report(derivation.name, f"proving {what}"))
        return proof, record
    except NOT_PROVED as error:
        message = str(error).removeprefix(derivation.name).lstrip(",.: ")
        raise DerivationError(derivation.name, f"not proved: {message}") from error


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

    same_choices()
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
