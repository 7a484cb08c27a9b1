"""Processor time and memory of this process and its children."""

import resource
from pathlib import Path

_STATUS = Path("/proc/self/status")


def children_seconds() -> float:
    """Processor time of all children that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def peak_memory() -> float:
    """The most memory that this process ever had, in MiB.

    Linux counts for ``getrusage`` what the process that started this one had at that
    moment; its own peak is in ``/proc``.
    """
    if _STATUS.exists():
        for line in _STATUS.read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
