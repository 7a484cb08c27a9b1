"""A Dask cluster, on which assignments are worked on instead of processes of this machine."""

import logging
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from typing import Any, Final

from serendipity.evaluation.reproduction.work import Assignment, TaskRows, killed
from serendipity.model import SerendipityError, UsageError

log = logging.getLogger("serendipity.reproduce")

_AGAIN: Final = "run the same command to go on"

Work = Callable[[Assignment], TaskRows]


def on_dask(work: Work, assignments: Sequence[Assignment], address: str, jobs: int) -> Iterator[TaskRows]:
    """On a Dask cluster, in the order in which they are finished.

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

        try:
            futures = dict(zip(client.map(work, assignments, pure=False), assignments, strict=True))
            for future in completed(futures):
                try:
                    yield future.result()
                except KilledWorker:
                    yield killed(futures[future])
        except (OSError, CancelledError):  # of which Dask's own are kinds
            raise SerendipityError(f"--dask: no scheduler any more at '{address}': {_AGAIN}") from None


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
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        raise UsageError("--dask: needs Dask: install serendipity-planner[dask]") from None
    if address == "local":
        cluster = LocalCluster(n_workers=jobs, threads_per_worker=1, dashboard_address=None)
        return Client(cluster)
    try:
        return Client(address, timeout="10s")
    except (OSError, ValueError) as error:
        raise UsageError(f"--dask: no scheduler at '{address}': {error}") from None
