"""A limit of time for computations that may take any time."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


class LimitError(BaseException):
    """The time is up; not an ``Exception``, which a library on the way might catch."""


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Raise :class:`LimitError` in the body after so many seconds of computing; 0 means no limit.

    They are those of this process, so that a busy machine does not decide what is found.  A system
    without such timers, and a thread, have no limit.
    """
    main = threading.current_thread() is threading.main_thread()
    if not (seconds > 0 and main and hasattr(signal, "setitimer")):
        yield
        return

    def stop(*_: Any) -> None:
        raise LimitError

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


__all__ = ["LimitError", "limited"]
