"""Where assignments are worked on: this process, several, or a Dask cluster."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.connection import Connection, wait
from typing import Any

from serendipity.evaluation.reproduction.work import Assignment, TaskRows
from serendipity.model import SerendipityError, UsageError

Work = Callable[[Assignment], TaskRows]


def in_turn(work: Work, assignments: Sequence[Assignment]) -> Iterator[TaskRows]:
    """One after the other, in this process."""
    return map(work, assignments)


def in_processes(work: Work, assignments: Sequence[Assignment], jobs: int) -> Iterator[TaskRows]:
    """In ``jobs`` processes, in the order in which they are finished; they end where nobody asks for more.

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
        raise SerendipityError(
            "a worker process was killed, perhaps for want of memory: run the same command to go on"
        ) from None
    except BaseException:
        ours.close()  # workers don't finish what nobody waits for
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def on_dask(work: Work, assignments: Sequence[Assignment], address: str, jobs: int) -> Iterator[TaskRows]:
    """On a Dask cluster, in the order in which they are finished.

    The workers need the program and the folder of tasks under the same path.

    Args:
        work: done for each assignment.
        assignments: what to do.
        address: of a scheduler, or ``local`` for a cluster of ``jobs`` processes on this machine.
        jobs: see ``address``.

    Raises:
        UsageError: Dask is not installed, or there is no scheduler at the address.
    """
    client = _client(address, jobs)
    from distributed import as_completed as completed

    try:
        futures = client.map(work, assignments, pure=False)
        for future in completed(futures):
            yield future.result()
    finally:
        client.close()
        if address == "local":
            client.cluster.close()


def _client(address: str, jobs: int) -> Any:
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        raise UsageError("--dask: needs Dask: install serendipity[dask]") from None
    if address == "local":
        cluster = LocalCluster(n_workers=jobs, threads_per_worker=1, dashboard_address=None)
        return Client(cluster)
    try:
        return Client(address, timeout="10s")
    except (OSError, ValueError) as error:
        raise UsageError(f"--dask: no scheduler at '{address}': {error}") from None


def _end_with_parent(wanted: Connection) -> None:
    """A worker leaves Ctrl-C to the main process, and does not outlive it, nor the wish for its work."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:

        def watch(sentinel: int) -> None:
            wait([sentinel, wanted])
            os._exit(1)

        threading.Thread(target=watch, args=(parent.sentinel,), daemon=True).start()
