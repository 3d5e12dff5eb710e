"""The command line: one function for each command.

Results go to stdout, progress and errors to stderr.  The exit code is 0 on success, 1 if a proof or
a comparison failed, and 2 if the command was called wrongly.
"""

from __future__ import annotations

import argparse
import contextlib
import difflib
import importlib.util
import os
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path

from closedform import robots
from closedform._version import __version__
from closedform.cli import claims, console, figures, parsers, plot, site
from closedform.cli.console import Progress
from closedform.pipeline import folders, scripts, versions
from closedform.pipeline import run as pipeline
from closedform.pipeline.disk import locked
from closedform.pipeline.memory import spend_memory
from closedform.pipeline.store import default_store
from closedform.pipeline.workers import WorkerError

DIFF_LINES = 20
PATIENCE = 120.0
"""Seconds to wait for another process that writes to the generated package, which takes one."""
NAMED = 4
"""At most this many changed files are named."""
PRETTY = "─│⎡⎣√θ₁"
"""Characters that draw a formula in two dimensions; a terminal without them gets ASCII."""


class CommandError(Exception):
    """A command that failed: what to tell the user, and the exit code."""

    def __init__(self, message: str, code: int = 1):
        super().__init__(message)
        self.code = code


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code."""
    console.open_streams()
    spend_memory()
    try:
        options = _parsed(arguments)
        command: Callable[[argparse.Namespace], None] = options.command
        command(options)
    except CommandError as error:
        return _complain(str(error), error.code)
    except (scripts.DerivationError, console.StreamError, WorkerError) as error:
        return _complain(str(error))
    except BrokenPipeError:
        return 1
    except OSError as error:
        return _complain(_reason(error))
    except KeyboardInterrupt:
        return _complain("interrupted", 130)
    return 0


def _parsed(arguments: Sequence[str] | None) -> argparse.Namespace:
    try:
        return parser().parse_args(arguments)
    except SystemExit as stop:
        if not stop.code:
            console.write("")  # argparse ignores a help text that could not be written
        raise


def _complain(message: str, code: int = 1) -> int:
    console.say(f"closedform: {message}")
    return code


def _reason(error: OSError) -> str:
    """What failed, and on which file."""
    try:
        os.getcwd()
    except OSError:
        return "the current folder no longer exists"
    reason = error.strerror or str(error)
    return f"{error.filename}: {reason}" if error.filename else reason


def parser() -> argparse.ArgumentParser:
    """The commands and their options."""
    top = argparse.ArgumentParser(
        prog="closedform",
        description="Proved closed-form kinematics of published mechanisms.",
        epilog="Begin with: closedform show planar_2r.  Your own arm: closedform new my_arm --from "
        "dh table.csv, then closedform derive my_arm.py -o out.",
    )
    top.add_argument("--version", action="version", version=f"closedform {__version__}")
    commands = top.add_subparsers(required=True, metavar="COMMAND")

    def command(
        name: str, function: Callable[[argparse.Namespace], None]
    ) -> argparse.ArgumentParser:
        summary = (function.__doc__ or "").partition("\n")[0]
        added = commands.add_parser(name, help=summary, description=function.__doc__)
        added.set_defaults(command=function)
        return added

    # first what is there, then a mechanism of one's own, then what a checkout is for
    parsers.list_options(command("list", list_command))
    parsers.show_options(command("show", show_command))
    plot.add_options(command("plot", plot_command))
    parsers.errata_options(command("errata", errata_command))
    parsers.new_options(command("new", new_command))
    parsers.derive_options(command("derive", derive_command))
    claims.add_options(command("claims", claims_command))
    parsers.verify_options(command("verify", verify_command))
    parsers.check_options(command("check", check_command))
    parsers.figures_options(command("figures", figures_command))
    built = command("site", site_command)
    site.add_options(built)
    parsers.jobs_option(built)
    return top


def robots_listed(sources: bool) -> str:
    """A line for each ready robot, and below it the sources of its numbers."""
    entries, lines = robots.entries(), []
    width = max(map(len, entries))
    families = max(len(entry["family"]) for entry in entries.values())
    for name, entry in entries.items():
        lines.append(f"{name:<{width}}  {entry['family']:<{families}}  {entry['title']}")
        if sources:
            lines.append(f"    parameters: {entry['source']}")
            parts = [part for part in ("limits", "zero", "base", "tool") if part in entry]
            lines += [f"    {part}: {entry[part]['source']}" for part in parts]
    return "".join(f"{line}\n" for line in lines)


def list_command(options: argparse.Namespace) -> None:
    """List the derivations, or the ready robots."""
    if options.sources and not options.robots:
        raise CommandError("--sources is for --robots: closedform list --robots --sources", 2)
    if options.robots:
        console.write(robots_listed(options.sources))
        return
    sources = scripts.sources()
    width = max((len(s.name) for s in sources), default=0)
    console.write("".join(f"{s.name:<{width}}  {s.title}\n" for s in sources))


def show_command(options: argparse.Namespace) -> None:
    """Show one derivation, with its verdicts if it has been proved."""
    (source,) = _find([options.name])
    _require_extra()
    from closedform.emit.show import show

    with Progress() as progress:
        progress(source.name, "deriving")
        derivation = scripts.load(source)
        kept = default_store().get(source)
        pretty = console.has(PRETTY)
        text = show(derivation, kept[0] if kept else None, options.format, pretty=pretty)
    console.write(text.rstrip("\n") + "\n")


def derive_command(options: argparse.Namespace) -> None:
    """Derive, prove and print; NAME is a derivation or the path of a script."""
    chosen = _find(options.names)
    backends = tuple(b for b in pipeline.BACKENDS if b in (options.backend or pipeline.BACKENDS))
    root = options.output or folders.generated()
    own = root.resolve() == folders.generated().resolve()
    if own:
        _require_checkout(chosen)
    elif root.exists() and not root.is_dir():
        raise CommandError(f"cannot write to {root}: it is not a folder")
    result = _run(options, chosen, backends, scripts.sources() if own else chosen)
    if own:
        _update(root, result.files, backends if not options.names else ())
    else:
        from closedform.emit.pages import standalone

        _write(root, standalone(result.files))
    for failure in result.neighbours:
        console.say(f"closedform: warning: {failure}")
    if result.neighbours:
        console.say("closedform: warning: the files that all robots share were not changed")
    if not own and not options.no_crosscheck:
        _crosscheck(root, chosen, backends)
    width = max(len(robot.name) for robot in result.robots)
    lines = [robot.line(width) for robot in result.robots]
    if not own:
        for robot, source in zip(result.robots, chosen, strict=True):
            lines.append(f"{robot.proof.outcome()}; next: {_next(robot, source, root, backends)}")
    console.write("".join(f"{line}\n" for line in lines))


def _update(root: Path, printed: pipeline.Files, whole: Sequence[str]) -> None:
    """Bring the generated package up to date; remove stale files of the ``whole`` back ends."""
    with _alone():
        changed = _write(root, printed)
        for path in pipeline.extra_files(root, printed, whole):
            (root / path).unlink(missing_ok=True)
            changed.append(path)
    if changed:
        names = ", ".join(str(path) for path in changed[:NAMED])
        more = f" and {len(changed) - NAMED} more" if len(changed) > NAMED else ""
        console.say(f"closedform: changed in {root}: {names}{more}")


def _next(
    robot: pipeline.Printed, source: scripts.Source, root: Path, backends: Sequence[str]
) -> str:
    """What to do next with a robot that was printed into a folder of the user."""
    if robot.given_up:
        return "allow more time with --timeout, or name lengths and angles in the table"
    if not robot.proof.inverses:
        return f"write the inverse in {source.path.name}; docs/adding-a-mechanism.md says how"
    from closedform.emit.backends import load

    first = [load(backend).first_file(robot.name) for backend in backends]
    *others, last = [str(root / path) for path in first if path] or [str(root)]
    return f"use {', '.join(others)} and {last}" if others else f"use {last}"


def _crosscheck(root: Path, chosen: Sequence[scripts.Source], backends: Sequence[str]) -> None:
    """Compare what was printed with the symbolic source, and write the report."""
    from closedform.check.failures import FailedError
    from closedform.check.report import report

    with Progress() as progress:
        for source in chosen:
            progress(source.name, "cross-checking")
            try:
                found = report(scripts.load(source), root, backends)
            except FailedError as error:
                raise CommandError(f"{source.name}: {error}") from error
            path = Path(f"{source.name}-crosscheck.md")
            _write(root, {path: found.page})
            if found.failures:
                raise CommandError(
                    f"{source.name}: the generated code differs from its symbolic source; see "
                    f"{root / path}: {found.failures[0]}"
                )
            if found.limits:
                console.say(
                    f"closedform: note: {source.name}: the digits of single precision do not "
                    f"suffice for some targets; see {root / path}"
                )


def check_command(options: argparse.Namespace) -> None:
    """Print everything again and compare it byte for byte with generated/."""
    root = folders.generated()
    printed = _run(options, scripts.sources(), pipeline.BACKENDS, scripts.sources()).files
    with _alone():
        differences = list(_differences(root, printed))
    if differences:
        console.write("\n".join(differences) + "\n")
        raise CommandError(f"{root} differs from what the derivations print; run make")
    console.write(f"{len(printed)} generated files are up to date\n")


def verify_command(options: argparse.Namespace) -> None:
    """Check the certificates of the proofs with a program that is independent of the prover."""
    from closedform.pipeline.verified import verify_all

    chosen, store = _find(options.names), default_store()
    if store.folder is None:
        raise CommandError("an installed package keeps no certificates; use a checkout")
    _require_extra()
    with Progress() as progress:
        results = verify_all(chosen, store, options.jobs or pipeline.default_jobs(), progress)
    width = max(len(result.name) for result in results)
    console.write("".join(f"{result.line(width)}\n" for result in results))
    if failed := [result.name for result in results if result.failure]:
        raise CommandError(f"not verified: {', '.join(failed)}")


def _check_file(options: argparse.Namespace, kind: str, path: Path) -> None:
    """Refuse a file that ``new`` cannot read, and options that are for other files."""
    if kind not in {given.split()[0] for given in parsers.FILES}:
        raise CommandError(f"--from takes {parsers.READ}, not {kind}", 2)
    if not path.is_file():
        problem = f"{path} is not a file" if path.exists() else f"there is no file {path}"
        raise CommandError(problem, 2)
    if options.modified and kind != "dh":
        raise CommandError(
            "--modified is for --from dh; the other files have one convention only", 2
        )
    of_tree = options.base or options.tool or options.ignore or options.hold
    if of_tree and kind not in ("urdf", "mjcf"):
        raise CommandError("--base, --tool, --ignore and --hold are for a URDF or MJCF file", 2)


def new_command(options: argparse.Namespace) -> None:
    """Write the derivation of an arm or a closed loop from a table or a file, with an inverse."""
    kind, path = options.table[0], Path(options.table[1])
    _check_file(options, kind, path)
    _require_extra()
    from closedform.pipeline import trial
    from closedform.scaffold.inputs.tree import Choice
    from closedform.scaffold.new import InverseSearch, check_name, new

    hold = {name: value or "0" for name, _, value in (j.partition("=") for j in options.hold)}
    try:
        check_name(options.name)
        target = options.output / f"{options.name}.py"
        if os.path.lexists(target):
            raise CommandError(f"{target} already exists; remove it, or choose another name")
        with Progress() as progress:
            search = InverseSearch(
                options.given, options.timeout, options.explain, fault=trial.fault
            )
            search.say = partial(progress, options.name)
            script = new(
                options.name,
                kind,
                path,
                modified=options.modified,
                choice=Choice(options.base, options.tool, options.ignore, hold),
                search=search,
            )
    except (ValueError, TypeError) as error:
        raise CommandError(str(error)) from error
    for note in script.notes:
        console.say(f"closedform: note: {note}")
    if script.advice:
        console.say(f"closedform: note: {script.advice}")
    if options.explain:
        console.write("".join(f"{line}\n" for line in script.explained))
    _write(options.output, {Path(target.name): script.text})
    console.write(f"{target}: {script.inverse}; next: closedform derive {target} -o out\n")
    if kind in ("urdf", "mjcf"):
        console.write(_then(options.name, "ik" if script.structure else "fk"))


def _then(name: str, function: str) -> str:
    """What to do after ``derive`` with a robot from a file: draw it, and see how to call it."""
    return (
        f"then: closedform figures {Path('out', 'numpy', name)}.py\n"
        f'then: python -c "from out.numpy import {name} as arm; help(arm.{function})"\n'
    )


def claims_command(options: argparse.Namespace) -> None:
    """Judge the claims of a derivation, also with changed texts; or compare them with the paper."""
    (source,) = _find([options.name])
    _require_extra()
    with Progress() as progress:
        progress(source.name, "deriving")
        derivation = scripts.load(source)
    for line in claims.report(options, derivation):
        console.write(f"{line}\n")


def plot_command(options: argparse.Namespace) -> None:
    """Draw a figure of a mechanism, listed or printed by derive."""
    try:
        console.write(plot.draw(options))
    except (ModuleNotFoundError, ValueError) as error:
        raise CommandError(str(error)) from error


def figures_command(options: argparse.Namespace) -> None:
    """Draw every figure of mechanisms, which their articles then show."""
    folder = options.output or figures.place(options.names)
    try:
        for line in figures.draw_all(folder, options.names, docs=options.docs):
            console.write(line)
        if options.docs is not None:
            (options.docs / figures.PAGE).write_text(figures.page(), "utf-8")
    except (ModuleNotFoundError, ValueError) as error:
        raise CommandError(str(error)) from error


def site_command(options: argparse.Namespace) -> None:
    """Build the site: a page for each mechanism, the documents, the explorer."""
    _require_extra()
    from closedform.site.node import NodeError

    root = folders.checkout()
    if root is None:
        raise CommandError("the site is built in a checkout of the project")
    sources = scripts.sources()
    printed = _run(options, sources, (site.BACKEND,), sources).files
    try:
        warnings = site.write(options, printed, sources, root, _line)
    except ModuleNotFoundError as error:
        message = f"the site needs {error.name}; run: pip install 'closedform[site]'"
        raise CommandError(message) from error
    except NodeError as error:
        raise CommandError(str(error)) from error
    if warnings:
        raise CommandError(f"{warnings} warnings; the site in {options.output} is not complete")
    console.write(f"{options.output / 'index.html'}\n")


def _line(text: str) -> None:
    console.write(f"{text}\n")


def errata_command(options: argparse.Namespace) -> None:
    """Print the errors of all papers or of one, with their numbers and all verdicts."""
    default = "text" if console.is_terminal() else "markdown"
    name = {"text": "errata.txt", "markdown": "errata.md"}[options.format or default]
    console.write(_errata_of(options, name) if options.paper else _errata(name))


def _errata(name: str) -> str:
    path = folders.generated() / name
    if not path.is_file():
        raise CommandError(f"{path} is missing; run make")
    return path.read_text("utf-8")


def _errata_of(options: argparse.Namespace, name: str) -> str:
    _require_extra()
    derivations = {source: scripts.load(source) for source in scripts.sources()}
    papers = sorted({d.paper.key for d in derivations.values()})
    chosen = {s: d for s, d in derivations.items() if d.paper.key == options.paper}
    if not chosen:
        raise CommandError(_unknown("paper", options.paper, papers), 2)
    return _run(options, list(chosen), ("latex",), list(chosen)).shared[Path(name)]


def _require_extra() -> None:
    missing = [name for name in pipeline.EXTRA if importlib.util.find_spec(name) is None]
    if missing:
        raise CommandError(
            f"this command needs {', '.join(missing)}; run: pip install 'closedform[derive]'"
        )
    for difference in versions.warnings():
        console.say(f"closedform: warning: {difference}")


def _find(names: Sequence[str]) -> list[scripts.Source]:
    try:
        return scripts.find(names)
    except scripts.UnknownNameError as error:
        known = [source.name for source in scripts.sources()]
        raise CommandError(_unknown("derivation", str(error), known), 2) from error


def _unknown(kind: str, name: str, known: Sequence[str]) -> str:
    if name.endswith(".py"):
        return f"there is no file {name}"
    if Path(name).is_file():
        return (
            f"{name} is not a script; write one from it: closedform new NAME --from KIND {name}, "
            f"where KIND FILE is one of {parsers.READ}"
        )
    close = difflib.get_close_matches(name, known)
    hint = f"did you mean {' or '.join(close)}?" if close else f"known: {', '.join(known)}"
    return f"unknown {kind} {name}; {hint}"


def _require_checkout(chosen: Sequence[scripts.Source]) -> None:
    """Refuse to write the generated package except in a checkout and from its own scripts."""
    if folders.checkout() is None:
        raise CommandError(
            "this is an installed package, not a checkout; give a folder with -o DIR", 2
        )
    for source in chosen:
        if not source.module:
            raise CommandError(
                f"{source.path} is not in {folders.scripts()}; give a folder with -o DIR", 2
            )


def _run(
    options: argparse.Namespace,
    chosen: Sequence[scripts.Source],
    backends: Sequence[str],
    together: Sequence[scripts.Source],
) -> pipeline.Result:
    _require_extra()
    with Progress() as progress:
        progress("", "starting")
        result = pipeline.run(
            chosen,
            backends,
            together=together,
            fresh=getattr(options, "fresh", False),
            jobs=getattr(options, "jobs", None) or pipeline.default_jobs(),
            timeout=getattr(options, "timeout", 0.0),
            report=progress,
        )
    if result.failures:
        raise CommandError("\nclosedform: ".join(map(str, result.failures)))
    return result


def _write(root: Path, printed: pipeline.Files) -> list[Path]:
    try:
        return pipeline.write(root, printed)
    except OSError as error:
        where = f"cannot write to {root}: "
        raise CommandError(where + _reason(error).removeprefix(f"{root}: ")) from error


def _alone() -> contextlib.AbstractContextManager[None]:
    """Keep other processes from changing the generated package."""
    root = folders.checkout()
    if root is None:
        return contextlib.nullcontext()
    return locked(root / "build" / "generated.lock", patience=PATIENCE)


def _differences(root: Path, printed: pipeline.Files) -> Iterable[str]:
    for path, text in sorted(printed.items()):
        target = root / path
        if not target.is_file():
            yield f"missing: {target}"
        elif target.read_bytes() != text.encode():
            yield f"differs: {target}"
            diff = difflib.unified_diff(
                target.read_bytes().decode(errors="replace").splitlines(),
                text.splitlines(),
                "committed",
                "printed now",
                lineterm="",
            )
            yield from list(diff)[:DIFF_LINES]
    for path in pipeline.extra_files(root, printed, pipeline.BACKENDS):
        yield f"extra: {root / path}"
