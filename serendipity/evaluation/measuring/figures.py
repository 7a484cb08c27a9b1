"""Figures: processor time, memory, the machine; percentiles, and powers that describe how a time grows."""

import math
import os
import platform
import resource
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeVar

from search.kernel.library import library
from serendipity.model.resources.collection import no_collection

T = TypeVar("T")

_STATUS: Final = Path("/proc/self/status")
_CPU_INFO: Final = Path("/proc/cpuinfo")


def children_seconds() -> float:
    """Processor time of all children that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def timed(work: Callable[[], T]) -> tuple[T, float]:
    """Result of some work, and its processor seconds, those of children that have ended (solvers) included.

    There is no garbage collection meanwhile, as in `plan`.
    """
    with no_collection():
        start = time.process_time() + children_seconds()
        done = work()
        return done, time.process_time() + children_seconds() - start


def peak_memory() -> float:
    """The most memory that this process ever had, in MiB.

    Linux counts for ``getrusage`` what the process that started this one had at that
    moment; its own peak is in ``/proc``.
    """
    found = _line_of(_STATUS, "VmHWM:")
    kibibytes = int(found.split()[0]) if found else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return kibibytes / 1024


def children_memory() -> float:
    """The most memory that one of the children that have ended ever had, in MiB."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024


def machine() -> str:
    """Machine, Python and kernel that figures are measured on, in one line."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    processor = _line_of(_CPU_INFO, "model name").lstrip("\t: ") or platform.machine()
    return (
        f"{platform.system()} on {processor}, {os.cpu_count()} cores, {memory:.0f} GiB, "
        f"Python {platform.python_version()}, {'compiled' if library() else 'no compiled'} kernel"
    )


def _line_of(file: Path, name: str) -> str:
    """The rest of the first line that begins so; empty without one."""
    lines = file.read_text().splitlines() if file.exists() else []
    return next((line.removeprefix(name).strip() for line in lines if line.startswith(name)), "")


def percentile(values: Sequence[float], share: float) -> float:
    """The value below which a share of them lies."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(len(ordered) * share))]


@dataclass(frozen=True, slots=True)
class PowerLaw:
    """``y = factor * x ** exponent``; ``error`` is the exponent's standard error."""

    exponent: float
    factor: float
    error: float


def power_law(xs: Iterable[float], ys: Iterable[float]) -> PowerLaw | None:
    """The power law of least squares of logarithms; None for fewer than three points, or a single x."""
    at, found = [math.log(x) for x in xs], [math.log(y) for y in ys]
    if len(at) < 3 or len({*at}) < 2:
        return None
    import numpy  # here: what is measured in this process may do without

    (exponent, start), spread = numpy.polyfit(at, found, 1, cov=True)
    return PowerLaw(float(exponent), math.exp(start), math.sqrt(max(spread[0][0], 0.0)))
