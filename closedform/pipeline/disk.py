"""Files that are complete or absent, and locks that end with the process that holds them."""

from __future__ import annotations

import contextlib
import math
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import IO


def replace(target: Path, content: bytes) -> None:
    """Write a file completely, or not at all if the disk is full or the process is killed."""
    target = Path(os.path.realpath(target))
    target.parent.mkdir(parents=True, exist_ok=True)
    unfinished = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        unfinished.write_bytes(content)
        unfinished.replace(target)
    except BaseException:
        with contextlib.suppress(OSError):
            unfinished.unlink()
        raise


@contextlib.contextmanager
def locked(path: Path, patience: float = math.inf) -> Iterator[None]:
    """Hold a lock, after other processes release it; do nothing if the system has no locks.

    Raises ``TimeoutError`` if that takes more seconds than ``patience``.
    """
    with contextlib.ExitStack() as stack:
        try:
            import fcntl

            path.parent.mkdir(parents=True, exist_ok=True)
            file = stack.enter_context(path.open("w"))
        except (ImportError, OSError):
            yield
            return
        end = time.monotonic() + patience
        while not _taken(file, fcntl.LOCK_EX | fcntl.LOCK_NB):
            if time.monotonic() > end:
                raise TimeoutError(f"another process has held {path} for {patience:.0f} s")
            time.sleep(0.05)
        yield


def _taken(file: IO[str], how: int) -> bool:
    """Whether the lock was taken, or the system cannot lock."""
    import fcntl

    try:
        fcntl.flock(file, how)
    except BlockingIOError:
        return False
    except OSError:
        pass
    return True
