"""A limit of time for computations that may take any time."""

from __future__ import annotations

import math
import multiprocessing
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any, TypeVar

Result = TypeVar("Result")
Say = Callable[[str], None]

GRACE = 3
"""Seconds of computing after which a process that does not answer the signal is killed."""


class LimitError(BaseException):
    """The time is up; not an ``Exception``, which a library on the way might catch."""


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Raise :class:`LimitError` in the body after so many seconds of computing; 0 means no limit.

    The seconds are CPU time of this process, so a busy machine does not decide what is found.
    There is no limit on a system without such timers, or in a thread.
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


def bounded(seconds: float, work: Callable[[Say], Result], say: Say) -> Result:
    """The result of ``work``; :class:`LimitError` after so many seconds of computing.

    The work is done in a process of its own, which the system can end: a product of long integers
    does not react to a signal.  It reports to ``say`` what it is doing.  An exception in it is
    raised here.
    """
    main = threading.current_thread() is threading.main_thread()
    forks = "fork" in multiprocessing.get_all_start_methods()
    if not (seconds > 0 and main and forks and hasattr(signal, "setitimer")):
        return work(say)
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(seconds, work, theirs), daemon=True)
    process.start()
    theirs.close()
    try:
        while True:
            kind, content = ours.recv()
            if kind == "say":
                say(content)
            elif kind == "error":
                raise content
            else:
                found: Result = content
                return found
    except EOFError:
        raise LimitError from None
    finally:
        ours.close()
        process.kill()
        process.join()


def _work(seconds: float, work: Callable[[Say], Any], answers: Any) -> None:
    import resource

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    most = resource.getrlimit(resource.RLIMIT_CPU)[1]
    used = sum(resource.getrusage(resource.RUSAGE_SELF)[:2])
    resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(used + seconds) + GRACE, most))
    with suppress(LimitError, BrokenPipeError):
        try:
            with limited(seconds):
                answer = "result", work(lambda what: answers.send(("say", what)))
        except Exception as error:
            answer = "error", error
        answers.send(answer)


__all__ = ["LimitError", "bounded", "limited"]
