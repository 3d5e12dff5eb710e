"""Processes that work through a list, each with a pipe of its own.

They share no lock, queue or thread, so a process that dies leaves nothing behind that the others,
or the one that started them, could wait for.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from typing import Any

from closedform.pipeline.memory import spend_memory

GRACE = 5.0
"""Seconds that a process has to end, once it was told to; then it is killed."""

Report = Callable[[str, str], None]


class WorkerError(Exception):
    """A process ended without a result."""


def each(
    job: Callable[..., Any], items: Sequence[Any], jobs: int, report: Report
) -> Iterator[tuple[Any, Any]]:
    """Run ``job(item, report=report)`` for all items in processes; yields each item and its result.

    An exception that a job raises is its result.
    """
    context = multiprocessing.get_context("spawn")
    waiting, workers = list(reversed(items)), []
    try:
        with _uninterrupted():
            for _ in range(min(jobs, len(items))):
                workers.append(_Worker(context, job))
        busy = {worker.connection: worker for worker in workers if worker.take(waiting)}
        while busy:
            for connection in wait(list(busy)):
                worker = busy[connection]
                kind, content = worker.receive()
                if kind == "report":
                    report(*content)
                    continue
                yield worker.item, content
                if not worker.take(waiting):
                    del busy[worker.connection]
        for worker in workers:
            worker.dismiss()
    finally:
        for worker in workers:
            worker.end()


class _Worker:
    def __init__(self, context: Any, job: Callable[..., Any]):
        self.connection, theirs = context.Pipe()
        self.item: Any = None
        self.process = context.Process(target=_work, args=(theirs, job), daemon=True)
        self.process.start()
        theirs.close()  # so that the end of the process is the end of the pipe

    def take(self, waiting: list[Any]) -> bool:
        """Start the next item, if one is left."""
        if waiting:
            self.item = waiting.pop()
            with contextlib.suppress(OSError):  # one that has died is found when it is read
                self.connection.send(self.item)
            return True
        return False

    def receive(self) -> tuple[str, Any]:
        try:
            message: tuple[str, Any] = self.connection.recv()
        except (EOFError, OSError) as error:
            self.process.join(GRACE)
            code = self.process.exitcode
            raise WorkerError(f"{self.item}: its process ended with exit code {code}") from error
        return message

    def dismiss(self) -> None:
        with contextlib.suppress(OSError):
            self.connection.send(None)
        self.process.join(GRACE)

    def end(self) -> None:
        """End the process at once, whatever it is doing."""
        self.connection.close()
        for stop in (self.process.terminate, self.process.kill):
            if self.process.is_alive():
                stop()
                self.process.join(GRACE)


def _work(connection: Connection, job: Callable[..., Any]) -> None:
    """The main loop of a process; it ends with its parent, however that ends."""
    spend_memory()
    parent = multiprocessing.parent_process()
    assert parent is not None
    threading.Thread(target=_end_with, args=(parent,), daemon=True).start()

    def report(name: str, what: str) -> None:
        connection.send(("report", (name, what)))

    with contextlib.suppress(EOFError, OSError):
        while (item := connection.recv()) is not None:
            try:
                result = job(item, report=report)
            except Exception as error:
                result = error
            connection.send(("result", result))


def _end_with(parent: Any) -> None:
    parent.join()
    os._exit(1)


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Keep Ctrl-C from processes that are started here; the parent ends them."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # which is started with the first process, and unblocks them
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


__all__ = ["WorkerError", "each"]
