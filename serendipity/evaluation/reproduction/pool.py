"""A Dask cluster, on which assignments are worked on instead of processes of this machine."""

import logging
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from time import perf_counter
from typing import Any, Final

from serendipity.evaluation.reproduction.work import Assignment, TaskRows, killed
from serendipity.model import SerendipityError, UsageError

log = logging.getLogger("serendipity.reproduce")

_AGAIN: Final = "run the same command to go on"

_CHUNK: Final = 1.0
"""Seconds after which a worker hands back what it has done, and what it has not come to."""

_AHEAD: Final = 2
"""Chunks for each thread of the cluster at a time: what is not sent yet is in nobody's memory there."""

_CONFIG: Final = {
    "distributed.worker.profile.enabled": False,  # 10 MiB a minute, for an hour
    "distributed.admin.low-level-log-length": 10,  # messages, with all that is in them
    "distributed.admin.system-monitor.log-length": 100,  # samples, two a second
    "distributed.deploy.lost-worker-timeout": "1h",  # one that takes longer to start again never does
}
"""What Dask keeps for those who look into it, and how long workers of this machine may be gone."""

Work = Callable[[Assignment], TaskRows]


def on_dask(work: Work, assignments: Sequence[Assignment], address: str, jobs: int) -> Iterator[TaskRows]:
    """On a Dask cluster, in the order in which they are finished, in chunks of about a second.

    The workers need the program and the folder of tasks under the same path.

    Args:
        address: of a scheduler, or ``local`` for a cluster of ``jobs`` processes on this machine.

    Raises:
        UsageError: Dask is not installed, or there is no scheduler at the address.
        SerendipityError: the scheduler is gone.
    """
    with _client(address, jobs) as client:
        from distributed import KilledWorker
        from distributed import as_completed as completed

        left, suspects, size = [*reversed(assignments)], list[Assignment](), 1
        sent, done = dict[Any, tuple[list[Assignment], bool]](), completed()

        def send(chunk: list[Assignment], *, alone: bool = False) -> None:
            future = client.submit(_done_in_time, work, chunk, pure=False)
            sent[future] = chunk, alone
            done.add(future)

        def send_more() -> None:
            for _ in range(_AHEAD * max(1, sum(client.nthreads().values())) - len(sent)):
                if left:
                    chunk = [*reversed(left[-size:])]
                    del left[-size:]
                    send(chunk)
            if suspects and not sent:
                send([suspects.pop()], alone=True)

        try:
            send_more()
            for future in done:
                chunk, alone = sent.pop(future)
                try:
                    records = future.result()
                except KilledWorker:  # it may be another one's fault
                    if alone:
                        yield killed(*chunk)
                    else:
                        suspects += chunk
                else:
                    left += reversed(chunk[len(records) :])
                    size = len(records) * (2 if len(records) == len(chunk) else 1)
                    yield from records
                send_more()
        except (OSError, CancelledError):  # of which Dask's own are kinds
            raise SerendipityError(f"--dask: no scheduler any more at '{address}': {_AGAIN}") from None


def _done_in_time(work: Work, chunk: Sequence[Assignment]) -> list[TaskRows]:
    """The first assignments of a chunk, as many as are begun within its time."""
    start, records = perf_counter(), list[TaskRows]()
    for assignment in chunk:
        records.append(work(assignment))
        if perf_counter() - start > _CHUNK:
            break
    return records


@contextmanager
def _hushed() -> Iterator[None]:
    """Silence about workers and schedulers that are gone: Dask's tracebacks are for those who debug."""
    if log.isEnabledFor(logging.DEBUG):
        yield
        return
    names = [name for name in logging.Logger.manager.loggerDict if name.partition(".")[0] == "distributed"]
    levels = {logger: logger.level for logger in map(logging.getLogger, names)}
    for logger in levels:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in levels.items():
            logger.setLevel(level)


@contextmanager
def _client(address: str, jobs: int) -> Iterator[Any]:
    try:
        import dask
        import distributed  # noqa: F401  (sets what is changed below)
    except ImportError:
        raise UsageError("--dask: needs Dask: install serendipity-planner[dask]") from None
    with dask.config.set(_CONFIG):
        client = _connected(address, jobs)
        with _hushed():
            try:
                yield client
            finally:
                with suppress(OSError, TimeoutError):  # of a cluster that is gone
                    client.close()
                    if address == "local":
                        client.cluster.close()


def _connected(address: str, jobs: int) -> Any:
    from distributed import Client, LocalCluster

    if address == "local":
        return Client(LocalCluster(n_workers=jobs, threads_per_worker=1, dashboard_address="127.0.0.1:0"))
    try:
        return Client(address, timeout="10s")
    except (OSError, ValueError) as error:
        raise UsageError(f"--dask: no scheduler at '{address}': {error}") from None
