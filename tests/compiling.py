"""A compiler that remembers: the same source is not compiled twice with the same flags.

The results are kept in build/compiled from one run of the tests to the next. One is found by what
decides it: the compiler, its flags, the sources and the preprocessed text with all macros, which
tells processors apart too where a flag names the one at hand.

``python compiling.py cc ...`` is that compiler as a program.
"""

import contextlib
import hashlib
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from closedform.pipeline.disk import locked, replace

KEPT = Path(__file__).resolve().parents[1] / "build" / "compiled"
UNUSED = 14 * 24 * 3600  # seconds after which a result that nobody asked for is removed


class CompilerError(Exception):
    """What the compiler said to a source that it refused."""


def compiled(command: Sequence[str | Path], target: Path, kept: Path = KEPT) -> str:
    """Run a compiler that writes ``target``, or copy what it wrote before; returns what it said.

    ``command`` names the compiler, flags and C sources, but neither objects nor the output.
    """
    words = [str(word) for word in command]
    name = _digest(words)
    result, said = kept / name, kept / f"{name}.txt"
    kept.mkdir(parents=True, exist_ok=True)
    with locked(kept / f"{name}.lock"):
        if not result.exists():
            _remove_unused(kept)
            unfinished = kept / f"{name}.{os.getpid()}"
            done = subprocess.run([*words, "-o", str(unfinished)], capture_output=True, text=True)
            if done.returncode:
                raise CompilerError(done.stderr)
            replace(said, done.stderr.encode())
            unfinished.replace(result)
        os.utime(result)
        shutil.copy(result, target)
        return said.read_text("utf-8")


def _digest(words: Sequence[str]) -> str:
    linked = [w for w in words if w in ("-c", "-shared") or w.startswith(("-l", "-Wl,"))]
    preprocess = [*(word for word in words if word not in linked), "-E", "-P", "-dD"]
    done = subprocess.run(preprocess, capture_output=True)
    if done.returncode:
        raise CompilerError(done.stderr.decode(errors="replace"))
    total = hashlib.sha256(_version(words[0]).encode())
    for word in words[1:]:
        if os.path.isfile(word):  # with its lines, which messages number
            total.update(Path(word).name.encode() + Path(word).read_bytes())
        elif not word.startswith("-I"):
            total.update(word.encode() + b"\0")
    total.update(done.stdout)
    return total.hexdigest()


@cache
def _version(compiler: str) -> str:
    """The compiler and its version, down to the build."""
    said = subprocess.run([compiler, "-v"], capture_output=True, text=True)
    return f"{compiler}\n{said.stdout}{said.stderr}"


def _remove_unused(kept: Path) -> None:
    oldest = time.time() - UNUSED
    for path in kept.iterdir():
        with contextlib.suppress(OSError):  # another process may remove it, too
            if path.stat().st_mtime < oldest:
                path.unlink()


def main(command: list[str]) -> None:
    """Compile C sources with ``-o``; the compiler itself is run for whatever else is asked."""
    sources = [word for word in command if word.endswith(".c")]
    others = [word for word in command if word.endswith((".o", ".a", ".so"))]
    if sources and command.count("-o") == 1:
        at = command.index("-o")
        target = command[at + 1]
        if not {"-E", "-S", "-"} & {*command} and {*others} <= {target}:
            with contextlib.suppress(CompilerError):  # the compiler says it itself
                sys.stderr.write(compiled(command[:at] + command[at + 2 :], Path(target)))
                return
    os.execvp(command[0], command)


if __name__ == "__main__":
    main(sys.argv[1:])
