"""The same tasks, in one run, side by side: the search, our integer program, the paper's."""

import gc
import os
import platform
import statistics
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from search import Clock, prepare, solve
from serendipity.model.errors import UsageError
from serendipity.model.options import Options
from serendipity.model.task import Task


@dataclass(frozen=True, slots=True)
class Timing:
    """One contender's answer to one call.

    Attributes:
        seconds: wall-clock; for the search the median of the repetitions, with every table
            built inside but the packed task.
        cost: None where there is none, or the limit came first.
    """

    task: str
    mode: str
    discount: str
    contender: str
    seconds: float
    status: str
    cost: float | None


def _search(task: Task, options: Options, repeat: int) -> tuple[float, str, float | None]:
    times = []
    for _ in range(repeat + 1):  # the first is the warm-up
        prepare(task, afresh=True)
        start = time.perf_counter()
        *_, outcome = solve(task, options, clock=Clock(options.time_limit))
        times.append(time.perf_counter() - start)
    cost = None if outcome.cost is None else float(outcome.cost)
    return statistics.median(times[1:]), outcome.status, cost


def _program(encoding: str) -> Callable[[Task, Options, int], tuple[float, str, float | None]]:
    def once(task: Task, options: Options, _repeat: int) -> tuple[float, str, float | None]:
        from verify.solve import solve as by_program  # loads a solver

        start = time.perf_counter()
        result = by_program(task, options, encoding=encoding)
        return time.perf_counter() - start, result.status, result.cost

    return once


CONTENDERS: Final[dict[str, Callable[[Task, Options, int], tuple[float, str, float | None]]]] = {
    "search": _search,
    "automata": _program("automata"),
    "paper": _program("paper"),
}
"""What can be measured: our search, our integer program, the paper's integer program."""


def measure(
    tasks: Iterable[Task],
    modes: Iterable[str],
    discounts: Iterable[str],
    contenders: Iterable[str],
    *,
    repeat: int = 5,
    time_limit: float | None = None,
) -> Iterator[Timing]:
    """Time each contender on each call, one after another.

    Args:
        tasks: the tasks; they are packed before the clock starts.
        modes: of planning.
        discounts: as texts, so that they stay exact.
        contenders: names in ``CONTENDERS``.
        repeat: calls of the search per figure, after a warm-up.
        time_limit: seconds for each call.

    Raises:
        UsageError: a contender is unknown, or two that proved an optimum disagree.
    """
    chosen = list(contenders)
    for name in chosen:
        if name not in CONTENDERS:
            raise UsageError(f"contenders: expected some of {', '.join(CONTENDERS)}, got '{name}'")
    modes, discounts = list(modes), list(discounts)
    gc.collect()
    gc.freeze()
    for task in tasks:
        for mode in modes:
            for discount in discounts:
                options = Options(mode=mode, discount=Fraction(discount), time_limit=time_limit)
                found = [
                    Timing(task.name, mode, discount, name, *CONTENDERS[name](task, options, repeat))
                    for name in chosen
                ]
                costs = {timing.cost for timing in found if timing.status == "optimal"}
                if len(costs) > 1:
                    raise UsageError(f"{task.name}, {mode} at {discount}: the proved optima differ: {costs}")
                yield from found


def summary(timings: list[Timing]) -> list[tuple[str, ...]]:
    """Per mode and contender: ratio of medians to the search, calls, solved, median, 95 %, largest."""
    rows = []
    groups: dict[tuple[str, str], list[Timing]] = {}
    for timing in timings:
        groups.setdefault((timing.mode, timing.contender), []).append(timing)
    for (mode, contender), members in groups.items():
        seconds = sorted(timing.seconds for timing in members)
        own = statistics.median(seconds)
        base = groups.get((mode, "search"))
        ratio = "" if base is None else f"{own / statistics.median(t.seconds for t in base):.1f} x"
        solved = sum(timing.status in ("optimal", "infeasible") for timing in members)
        p95 = seconds[min(len(seconds) - 1, int(len(seconds) * 0.95))]
        figures = tuple(f"{value * 1000:.2f} ms" for value in (own, p95, seconds[-1]))
        rows.append((mode, contender, ratio, str(len(members)), str(solved), *figures))
    return rows


def machine() -> str:
    """What the figures were measured on."""
    python = platform.python_version()
    return f"{platform.system()} on {platform.machine()}, {os.cpu_count()} cores, Python {python}"
