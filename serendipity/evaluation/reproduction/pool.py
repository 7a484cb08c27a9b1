"""Where assignments are worked on beside processes of this machine: a Dask cluster."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from serendipity.evaluation.reproduction.work import Assignment, TaskRows
from serendipity.model import UsageError

Work = Callable[[Assignment], TaskRows]


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
        raise UsageError("--dask: needs Dask: install serendipity-planner[dask]") from None
    if address == "local":
        cluster = LocalCluster(n_workers=jobs, threads_per_worker=1, dashboard_address=None)
        return Client(cluster)
    try:
        return Client(address, timeout="10s")
    except (OSError, ValueError) as error:
        raise UsageError(f"--dask: no scheduler at '{address}': {error}") from None
