"""Output of the command line: any character on any terminal, stream errors, progress."""

from __future__ import annotations

import codecs
import contextlib
import io
import os
import re
import shutil
import sys
import threading
import time
import unicodedata
from types import TracebackType
from typing import TextIO

PATIENCE = 1.0
"""Seconds of silence before progress is shown."""
INTERVAL = 0.2
"""Seconds between two looks at what is going on."""
ASCII = {
    "·": "*", "−": "-", "–": "-", "—": "-", "‘": "'", "’": "'", "“": '"', "”": '"', "«": '"',
    "»": '"',
}  # fmt: skip
ASCII |= {
    "≤": "<=",
    "≥": ">=",
    "≠": "!=",
    "±": "+/-",
    "×": "x",
    "°": " deg",
    "→": "->",
    "®": "(R)",
    "§": "sec. ",
}


class StreamError(Exception):
    """The standard output cannot be written to; the message says why."""


def open_streams() -> None:
    """Make the standard streams usable, whatever the caller has done to them.

    The output of a closed stream is discarded, and no file that is opened later gets its number.
    Characters that the encoding of a stream lacks are written in ASCII.
    """
    if None in (sys.stdout, sys.stderr):
        while os.open(os.devnull, os.O_RDWR) < 2:
            pass
    if sys.stderr is None:
        sys.stderr = io.StringIO()
    codecs.register_error("closedform", _ascii)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="closedform")


def write(text: str) -> None:
    """Write to the standard output.  Raises ``BrokenPipeError`` if nobody reads it any more."""
    if sys.stdout is None:
        raise StreamError("the standard output is closed")
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except OSError as error:
        _discard(sys.stdout)
        if isinstance(error, BrokenPipeError):
            raise
        raise StreamError(f"cannot write to the standard output: {error.strerror}") from error


def say(text: str) -> None:
    """Write a line to the standard error; ignore a failure to do so."""
    _show(f"{text}\n")


def has(characters: str) -> bool:
    """Whether the standard output can show these characters."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    try:
        characters.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True


def is_terminal() -> bool:
    """Whether somebody reads the standard output as it is written."""
    return sys.stdout is not None and sys.stdout.isatty()


def _show(text: str) -> None:
    try:
        sys.stderr.write(text)
        sys.stderr.flush()
    except OSError:
        _discard(sys.stderr)


def _discard(stream: TextIO) -> None:
    """Discard what is left in a stream, so that Python does not fail on it when it exits."""
    with contextlib.suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _ascii(error: UnicodeError) -> tuple[str, int]:
    """Characters that an encoding lacks, in ASCII: Greek letters by name, no accents."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    text = error.object[error.start : error.end]
    return "".join(map(_plain, text)), error.end


def _plain(character: str) -> str:
    if character in ASCII:
        return ASCII[character]
    name = unicodedata.name(character, "")
    if match := re.fullmatch(r"GREEK (SMALL|CAPITAL) LETTER (\w+)", name):
        return match[2].lower() if match[1] == "SMALL" else match[2].capitalize()
    decomposed = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    return decomposed or character.encode("ascii", "backslashreplace").decode()


class Progress:
    """Shows what is going on, on one line of a terminal, once it takes long.

    It says nothing unless both stdout and stderr are terminals.
    """

    def __init__(self) -> None:
        self.start = time.monotonic()
        self.current: dict[str, str] = {}
        self.terminal = all(s is not None and s.isatty() for s in (sys.stdout, sys.stderr))
        self.shown = False
        self.finished = threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)

    def __call__(self, name: str, what: str) -> None:
        if name:
            self.current.pop("", None)
        if what:
            self.current[name] = what
        else:
            self.current.pop(name, None)

    def __enter__(self) -> Progress:
        if self.terminal:
            self.thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.finished.set()
        if self.terminal:
            self.thread.join()
        if self.shown:
            _show("\r\x1b[K")

    def _run(self) -> None:
        while not self.finished.wait(INTERVAL):
            passed = time.monotonic() - self.start
            if passed >= PATIENCE and self.current:
                self.shown = True
                self._line(passed)

    def _line(self, passed: float) -> None:
        doing = [f"{n}: {what}" if n else what for n, what in sorted(self.current.copy().items())]
        line = f"[{passed:4.0f} s] {' | '.join(doing)}"
        _show(f"\r\x1b[K{line[: shutil.get_terminal_size().columns - 1]}")
