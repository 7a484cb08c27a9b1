"""Memory that this process uses, and that is left to it."""

import sys
from pathlib import Path
from typing import Final

try:
    import resource
except ImportError:  # not on Windows
    resource = None  # type: ignore[assignment]

_PROC: Final = Path("/proc")
_STATM: Final = _PROC / "self/statm"
_MEMINFO: Final = Path("/proc/meminfo")
_CGROUP: Final = Path("/sys/fs/cgroup")

_SHARE: Final = 0.9
"""The share of the machine's free memory that is ours to take."""


def resident(pid: int | None = None) -> int | None:
    """Bytes of this process in memory: now on Linux, at most so far on other Unixes; None elsewhere.

    With ``pid`` those of another process, on Linux only.
    """
    if resource is None:
        return None
    statm = _STATM if pid is None else _PROC / str(pid) / "statm"
    try:
        return int(statm.read_bytes().split()[1]) * resource.getpagesize()
    except (OSError, IndexError, ValueError):
        if pid is not None:
            return None
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        return peak if sys.platform == "darwin" else peak * 1024


def available() -> float | None:
    """Bytes that machine, container and ``ulimit -v`` leave this process; None if that is not known."""
    rooms = [room for room in (_of_machine(), _of_container(), _of_ulimit()) if room is not None]
    return max(_SHARE * min(rooms), 0.0) if rooms else None


def _of_machine() -> int | None:
    try:
        lines = _MEMINFO.read_text().splitlines()
        return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("MemAvailable:"))
    except (OSError, StopIteration, IndexError, ValueError):
        return None


def _of_container() -> int | None:
    try:
        most = int((_CGROUP / "memory.max").read_text())
        return most - int((_CGROUP / "memory.current").read_text())
    except (OSError, ValueError):  # no container, or "max"
        return None


def _of_ulimit() -> int | None:
    if resource is None:
        return None
    most, _ = resource.getrlimit(resource.RLIMIT_AS)
    if most == resource.RLIM_INFINITY:
        return None
    try:
        return most - int(_STATM.read_bytes().split()[0]) * resource.getpagesize()
    except (OSError, IndexError, ValueError):
        return most
