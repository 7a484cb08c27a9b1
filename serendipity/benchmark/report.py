"""Timings as a table, ratios first."""

import os
import platform
import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from serendipity.benchmark.measure import Timing

HEADER: Final = (
    *("mode", "contender", "ratio of medians", "ratio 50 %", "ratio 95 %", "least ratio"),
    *("calls", "proved", "median", "min-max"),
)
"""Headings of :func:`summary`."""

_PROCESS: Final = ", process"
_CPU_INFO: Final = Path("/proc/cpuinfo")

_Call = tuple[str, str, str]
"""Task, mode, discount."""


def summary(timings: Sequence[Timing]) -> list[tuple[str, ...]]:
    """A row for each mode and contender, against the search on the same calls.

    ``ratio of medians`` compares medians, the other ratios are percentiles over the calls
    of what a contender takes as a multiple of the search.  Calls that met the limit count
    with what they had taken by then; ``>=`` marks the figures that this makes too small.
    """
    base = {_call(timing): timing.seconds for timing in timings if timing.contender == "search"}
    groups: dict[tuple[str, str], list[Timing]] = {}
    for timing in timings:
        groups.setdefault((timing.mode, timing.contender), []).append(timing)
    rows = []
    for (mode, contender), members in groups.items():
        rows.append((mode, contender, *_row(members, base)))
        if any(timing.process_seconds is not None for timing in members):
            rows.append((mode, contender + _PROCESS, *_row([_of_process(t) for t in members], base)))
    return rows


def _of_process(timing: Timing) -> Timing:
    """The timing of the whole process in place of what it says of itself."""
    seconds = timing.seconds if timing.process_seconds is None else timing.process_seconds
    return replace(timing, seconds=seconds, fastest=seconds, slowest=seconds)


def _row(members: Sequence[Timing], base: Mapping[_Call, float]) -> Iterator[str]:
    own = statistics.median(timing.seconds for timing in members)
    proved = sum(timing.solved for timing in members)
    more = "" if proved == len(members) else ">= "
    if all(_call(timing) in base for timing in members):
        against = statistics.median(base[_call(timing)] for timing in members)
        ratios = sorted(timing.seconds / base[_call(timing)] for timing in members)
        yield f"{more}{own / against:.1f} x"
        yield from (f"{more}{percentile(ratios, share):.1f} x" for share in (0.5, 0.95, 0.0))
    else:
        yield from ("",) * 4
    yield from (str(len(members)), str(proved), f"{own * 1000:.2f} ms")
    least = min(timing.fastest for timing in members)
    most = max(timing.slowest for timing in members)
    yield f"{least * 1000:.2f}-{most * 1000:.2f} ms"


def percentile(ordered: Sequence[float], share: float) -> float:
    """The value below which a share of ascending values lies; one of the values."""
    return ordered[min(len(ordered) - 1, int(len(ordered) * share))]


def _call(timing: Timing) -> _Call:
    return timing.task, timing.mode, timing.discount


def machine() -> str:
    """What the figures were measured on."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    return (
        f"{platform.system()} on {_processor()}, {os.cpu_count()} cores, {memory:.0f} GiB, "
        f"Python {platform.python_version()}"
    )


def _processor() -> str:
    if _CPU_INFO.exists():
        for line in _CPU_INFO.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.machine()
