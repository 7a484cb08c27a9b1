"""Work that is done in several processes."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.connection import Connection, wait
from typing import TypeVar

from serendipity.model.errors import SerendipityError

A = TypeVar("A")
B = TypeVar("B")


def in_processes(
    work: Callable[[A], B], assignments: Sequence[A], jobs: int, *, advice: str = ""
) -> Iterator[B]:
    """In ``jobs`` processes, in the order in which they are finished; they end where nobody asks for more.

    Args:
        work: a function of a module, which is done for each assignment.
        assignments: what to do.
        jobs: how many processes.
        advice: what to do if one of them is killed, for the error.

    Raises:
        SerendipityError: a process was killed.
    """
    # Not forked: a thread of the progress display may hold a lock at that moment.
    context = multiprocessing.get_context("spawn")
    workers = min(jobs, len(assignments))
    wanted, ours = context.Pipe(duplex=False)
    pool = ProcessPoolExecutor(workers, context, initializer=_end_with_parent, initargs=(wanted,))
    try:
        for future in as_completed([pool.submit(work, assignment) for assignment in assignments]):
            yield future.result()
    except BrokenProcessPool:
        raise SerendipityError(f"a worker process was killed, perhaps for want of memory{advice}") from None
    except BaseException:
        ours.close()  # workers don't finish what nobody waits for
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def _end_with_parent(wanted: Connection) -> None:
    """A worker leaves Ctrl-C to the main process, and does not outlive it, nor the wish for its work."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:

        def watch(sentinel: int) -> None:
            wait([sentinel, wanted])
            os._exit(1)

        threading.Thread(target=watch, args=(parent.sentinel,), daemon=True).start()
