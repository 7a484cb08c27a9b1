"""Jobs: done one after another or in processes, and not again where a record has what they came to."""

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import Any, TypeVar

from serendipity.evaluation.measuring.record import Record
from serendipity.model.resources.processes import in_processes

J = TypeVar("J")
T = TypeVar("T")


def measured(
    jobs: Iterable[J], work: Callable[[J], Any], record: Record, *, processes: int = 1
) -> Iterator[tuple[J, Any]]:
    """Each job and what it came to: plain values, as JSON has them.

    Args:
        jobs: values that are told apart by their ``repr``.
        work: a function of a module.
        record: of what is done.
        processes: how many; with several, jobs come as they are finished.
    """
    todo = []
    for job in jobs:
        if repr(job) in record:
            yield job, record[repr(job)]
        elif processes > 1:
            todo.append(job)
        else:
            yield _noted(record, job, work(job))
    for job, found in in_processes(partial(_with_job, work), todo, processes):
        yield _noted(record, job, found)


def _noted(record: Record, job: J, found: Any) -> tuple[J, Any]:
    record.add(repr(job), found)
    return job, found


def _with_job(work: Callable[[J], Any], job: J) -> tuple[J, Any]:
    return job, work(job)


def apart(work: Callable[..., T], *given: Any) -> T:
    """Result of a function of a module in a process of its own, whose memory is its own."""
    (found,) = in_processes(partial(_called, work), [given], 1)
    return found


def _called(work: Callable[..., T], given: tuple[Any, ...]) -> T:
    return work(*given)
