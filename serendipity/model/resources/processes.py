"""Work that is done in several processes."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.connection import Connection, wait
from typing import TypeVar

from serendipity.model.errors import SerendipityError

A = TypeVar("A")
B = TypeVar("B")


def in_processes(
    work: Callable[[A], B], assignments: Sequence[A], jobs: int, lost: Callable[[A], B] | None = None
) -> Iterator[B]:
    """In ``jobs`` processes, in the order in which they are finished; they end where nobody asks for more.

    Where a process is killed, what may have been its assignment is done again, in a process of its own.

    Args:
        lost: what an assignment comes to whose process is killed again.

    Raises:
        SerendipityError: a process was killed twice, and there is no ``lost``.
    """
    left = list(assignments)
    while left:
        jobs = min(jobs, len(left))
        if not (yield from _in_pool(work, left, jobs)):
            return
        suspects, left = left[:jobs], left[jobs:]
        for suspect in suspects:
            if (yield from _in_pool(work, [suspect], 1)):
                if lost is None:
                    raise SerendipityError("a worker process was killed twice, perhaps for want of memory")
                yield lost(suspect)


def _in_pool(work: Callable[[A], B], left: list[A], workers: int) -> Generator[B, None, bool]:
    """The results of assignments, each taken off the list; returns whether a process was killed."""
    # Not forked: a thread of the progress display may hold a lock at that moment.
    context = multiprocessing.get_context("spawn")
    wanted, ours = context.Pipe(duplex=False)
    pool = ProcessPoolExecutor(workers, context, initializer=_end_with_parent, initargs=(wanted,))
    try:
        futures = {pool.submit(work, assignment): assignment for assignment in left}
        for future in as_completed(futures):
            done = future.result()
            left.remove(futures.pop(future))
            yield done
    except BrokenProcessPool:
        return True
    except BaseException:
        ours.close()  # workers don't finish what nobody waits for
        raise
    finally:
        pool.shutdown(cancel_futures=True)
    return False


def _end_with_parent(wanted: Connection) -> None:
    """A worker leaves Ctrl-C to the main process, and does not outlive it, nor the wish for its work."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:

        def watch(sentinel: int) -> None:
            wait([sentinel, wanted])
            os._exit(1)

        threading.Thread(target=watch, args=(parent.sentinel,), daemon=True).start()
