"""The command line: list, show, derive, check, new, errata.

Results go to stdout, progress and errors to stderr.  The exit code is 0 on success, 1 where a proof
or a comparison failed, 2 where the command was called wrongly.
"""

from __future__ import annotations

import argparse
import difflib
import importlib.util
import os
import shutil
import sys
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from types import TracebackType

from closedform import __version__, pipeline

DIFF_LINES = 20
PATIENCE = 1.0
"""Seconds of silence before progress is shown."""
INTERVAL = 5.0
"""Seconds between two lines of progress where the output is no terminal."""


class CommandError(Exception):
    """The command did not succeed; the exit code and what to tell the user."""

    def __init__(self, message: str, code: int = 1):
        super().__init__(message)
        self.code = code


class Progress:
    """Says on stderr what is going on, once it takes long."""

    def __init__(self) -> None:
        self.start = time.monotonic()
        self.current: dict[str, str] = {}
        self.terminal = sys.stderr.isatty()
        self.shown = 0.0
        self.finished = threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)

    def __call__(self, name: str, what: str) -> None:
        if what:
            self.current[name] = what
        else:
            self.current.pop(name, None)

    def __enter__(self) -> Progress:
        self.thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.finished.set()
        self.thread.join()
        if self.terminal and self.shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)

    def _run(self) -> None:
        while not self.finished.wait(0.2):
            passed = time.monotonic() - self.start
            due = self.terminal or not self.shown or passed - self.shown >= INTERVAL
            if passed >= PATIENCE and due and self.current:
                self.shown = passed
                self._show(passed)

    def _show(self, passed: float) -> None:
        doing = [f"{n}: {what}" if n else what for n, what in sorted(self.current.copy().items())]
        line = f"[{passed:4.0f} s] {' | '.join(doing)}"
        if self.terminal:
            line = line[: shutil.get_terminal_size().columns - 1]
            print(f"\r\x1b[K{line}", end="", file=sys.stderr, flush=True)
        else:
            print(line, file=sys.stderr, flush=True)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code."""
    options = parser().parse_args(arguments)
    command: Callable[[argparse.Namespace], None] = options.command
    try:
        command(options)
        sys.stdout.flush()
    except CommandError as error:
        return _complain(str(error), error.code)
    except pipeline.DerivationError as error:
        return _complain(str(error))
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except KeyboardInterrupt:
        return _complain("interrupted", 130)
    return 0


def _complain(message: str, code: int = 1) -> int:
    print(f"closedform: {message}", file=sys.stderr)
    return code


def parser() -> argparse.ArgumentParser:
    """The commands and their options."""
    top = argparse.ArgumentParser(
        prog="closedform",
        description="Published mechanisms as proved, fast, closed-form kinematics.",
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

    command("list", list_command)
    show = command("show", show_command)
    show.add_argument("name", metavar="NAME")
    show.add_argument("--format", choices=("text", "latex"), default="text")
    derive = command("derive", derive_command)
    derive.add_argument("names", metavar="NAME", nargs="*", help="all if none is given")
    derive.add_argument("-o", "--output", metavar="DIR", type=Path)
    derive.add_argument(
        "--backend", action="append", choices=pipeline.BACKENDS, help="repeatable; all by default"
    )
    derive.add_argument(
        "--no-crosscheck",
        action="store_true",
        help="with -o: do not compare the printed code with the symbolic source",
    )
    check = command("check", check_command)
    for added in (derive, check):
        added.add_argument("-j", "--jobs", type=_positive, metavar="N", help="processes to use")
        added.add_argument("--fresh", action="store_true", help="prove everything again")
    new = command("new", new_command)
    new.add_argument("name", metavar="NAME")
    new.add_argument(
        "--from",
        dest="table",
        nargs=2,
        required=True,
        metavar=("KIND", "FILE"),
        help="dh TABLE.csv, or screws FILE.toml",
    )
    new.add_argument("--modified", action="store_true", help="the dh table is Craig's (proximal)")
    new.add_argument(
        "-o", "--output", metavar="DIR", type=Path, default=Path(), help="by default the current"
    )
    errata = command("errata", errata_command)
    errata.add_argument("paper", metavar="PAPER", nargs="?", help="the key of one paper")
    return top


def _positive(text: str) -> int:
    value = int(text)
    if value < 1:
        raise ValueError
    return value


def list_command(options: argparse.Namespace) -> None:
    """List the derivations."""
    sources = pipeline.sources()
    width = max((len(s.name) for s in sources), default=0)
    for source in sources:
        print(f"{source.name:<{width}}  {source.title}")


def show_command(options: argparse.Namespace) -> None:
    """Show one derivation, with what was proved if it has been."""
    (source,) = _find([options.name])
    _require_extra()
    from closedform.emit.show import show

    with Progress() as progress:
        progress(source.name, "derivation")
        derivation = pipeline.load(source)
        kept = pipeline.default_store().get(source)
        text = show(derivation, kept[0] if kept else None, options.format)
    print(text.rstrip("\n"))


def derive_command(options: argparse.Namespace) -> None:
    """Derive, prove and print; NAME is a derivation or the path of a script."""
    chosen = _find(options.names)
    backends = tuple(b for b in pipeline.BACKENDS if b in (options.backend or pipeline.BACKENDS))
    root = options.output or pipeline.generated()
    own = root.resolve() == pipeline.generated().resolve()
    if own:
        _require_checkout(chosen)
    result = _run(options, chosen, backends, pipeline.sources() if own else chosen)
    printed = result.files if own else pipeline.standalone(result.files)
    _write(root, printed)
    for failure in result.neighbours:
        print(f"closedform: warning: {failure}", file=sys.stderr)
    if result.neighbours:
        print(
            "closedform: warning: the files that all robots share were left as they are",
            file=sys.stderr,
        )
    if not own and not options.no_crosscheck:
        _crosscheck(root, chosen, backends)
    width = max(len(robot.name) for robot in result.robots)
    for robot in result.robots:
        print(robot.line(width))
    if not own:
        for robot, source in zip(result.robots, chosen, strict=True):
            print(f"{robot.proof.outcome()}; next: {_next(robot, source, root, backends)}")
    if own and not options.names:
        for path in pipeline.extra_files(root, printed, backends):
            (root / path).unlink()


def _next(
    robot: pipeline.Printed, source: pipeline.Source, root: Path, backends: Sequence[str]
) -> str:
    """What to do with one robot that was printed into a folder of the user's."""
    if not robot.proof.inverses:
        return f"write the inverse in {source.path.name}; docs/adding-a-mechanism.md says how"
    names = {"numpy": f"{robot.name}.py", "c": f"{robot.name}.c", "latex": f"{robot.name}.tex"}
    printed = [str(root / b / names[b]) for b in backends if b in names]
    return f"use {' and '.join(printed) or root}"


def _crosscheck(root: Path, chosen: Sequence[pipeline.Source], backends: Sequence[str]) -> None:
    """Compare what was printed with the symbolic source, and write down what was found."""
    from closedform.clibrary import CompileError
    from closedform.report import report

    with Progress() as progress:
        for source in chosen:
            progress(source.name, "cross-check")
            try:
                text, failures = report(pipeline.load(source), root, backends)
            except CompileError as error:
                raise CommandError(f"{source.name}: {error}") from error
            _write(root, {Path(f"{source.name}-crosscheck.md"): text})
            if failures:
                raise CommandError(
                    f"{source.name}: the generated code differs from its symbolic source; see "
                    f"{root / f'{source.name}-crosscheck.md'}: {failures[0]}"
                )


def check_command(options: argparse.Namespace) -> None:
    """Print everything anew and compare it, byte for byte, with what is in generated/."""
    root = pipeline.generated()
    printed = _run(options, pipeline.sources(), pipeline.BACKENDS, pipeline.sources()).files
    differences = list(_differences(root, printed))
    if differences:
        print("\n".join(differences))
        raise CommandError(f"{root} is not what the derivations print: run make")
    print(f"{len(printed)} generated files are up to date")


def new_command(options: argparse.Namespace) -> None:
    """Write the skeleton of a derivation, with pose, Jacobians and a proposed inverse."""
    kind, path = options.table[0], Path(options.table[1])
    if kind not in ("dh", "screws"):
        raise CommandError(f"--from dh TABLE.csv or --from screws FILE.toml, not {kind}", 2)
    if not path.is_file():
        raise CommandError(f"{path} is no file" if path.exists() else f"there is no file {path}", 2)
    if options.modified and kind != "dh":
        raise CommandError("--modified goes with --from dh: axes have no convention", 2)
    _require_extra()
    from closedform.new import new

    target = options.output / f"{options.name}.py"
    if target.exists():
        raise CommandError(f"{target} exists already")
    try:
        script = new(options.name, kind, path, modified=options.modified)
    except (ValueError, TypeError) as error:
        raise CommandError(str(error)) from error
    _write(options.output, {Path(target.name): script.text})
    print(f"{target}: {script.inverse}; next: closedform derive {target} -o out")


def errata_command(options: argparse.Namespace) -> None:
    """Print every claim of the papers, or of one, that is not simply proved."""
    print(_errata_of(options) if options.paper else _errata(), end="")


def _errata() -> str:
    path = pipeline.generated() / "errata.md"
    if not path.is_file():
        raise CommandError(f"{path} is missing: run make")
    return path.read_text("utf-8")


def _errata_of(options: argparse.Namespace) -> str:
    _require_extra()
    derivations = {source: pipeline.load(source) for source in pipeline.sources()}
    papers = sorted({d.paper.key for d in derivations.values()})
    chosen = {s: d for s, d in derivations.items() if d.paper.key == options.paper}
    if not chosen:
        raise CommandError(_unknown("paper", options.paper, papers), 2)
    return _run(options, list(chosen), ("latex",), list(chosen)).shared[Path("errata.md")]


def _require_extra() -> None:
    missing = [name for name in pipeline.EXTRA if importlib.util.find_spec(name) is None]
    if missing:
        raise CommandError(
            f"this needs {', '.join(missing)}, not installed: pip install 'closedform[derive]'"
        )


def _find(names: Sequence[str]) -> list[pipeline.Source]:
    try:
        return pipeline.find(names)
    except pipeline.UnknownNameError as error:
        known = [source.name for source in pipeline.sources()]
        raise CommandError(_unknown("derivation", str(error), known), 2) from error


def _unknown(kind: str, name: str, known: Sequence[str]) -> str:
    close = difflib.get_close_matches(name, known)
    hint = f"did you mean {' or '.join(close)}?" if close else f"known: {', '.join(known)}"
    if name.endswith(".py"):
        hint = f"there is no such file; {hint}"
    return f"unknown {kind} {name}; {hint}"


def _require_checkout(chosen: Sequence[pipeline.Source]) -> None:
    """The generated package is only written in a checkout, and only from its own scripts."""
    if pipeline.checkout() is None:
        raise CommandError(
            "this is an installed package, not a checkout: give a folder with -o DIR", 2
        )
    for source in chosen:
        if not source.module:
            raise CommandError(
                f"{source.path} is not in {pipeline.scripts()}: give a folder with -o DIR", 2
            )


def _run(
    options: argparse.Namespace,
    chosen: Sequence[pipeline.Source],
    backends: Sequence[str],
    together: Sequence[pipeline.Source],
) -> pipeline.Result:
    _require_extra()
    with Progress() as progress:
        result = pipeline.run(
            chosen,
            backends,
            together=together,
            fresh=getattr(options, "fresh", False),
            jobs=getattr(options, "jobs", None) or pipeline.default_jobs(),
            report=progress,
        )
    if result.failures:
        raise CommandError("\nclosedform: ".join(map(str, result.failures)))
    return result


def _write(root: Path, printed: pipeline.Files) -> None:
    try:
        pipeline.write(root, printed)
    except OSError as error:
        raise CommandError(f"cannot write to {root}: {error.strerror}") from error


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
