"""Rows as tables: what is decided, with how many expansions, how soon.

In a cell, the figures of several contenders stand in the order of :func:`contenders_in`.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from statistics import median
from typing import Final

from serendipity.evaluation.benchmark.coverage.rows import Row

Table = tuple[tuple[str, ...], list[tuple[str, ...]]]
"""Headings, and rows of cells."""

MOMENTS: Final = (0.1, 1.0, 2.0, 5.0, 20.0)
"""Seconds at which coverage is told."""

_OURS: Final = "search"
_Cell = Callable[[Sequence[Row]], str]


def contenders_in(rows: Iterable[Row]) -> list[str]:
    """Who is there, in order."""
    return list(dict.fromkeys(row.contender for row in rows))


def decided(rows: Sequence[Row]) -> Table:
    """To how many calls each contender proves the answer; of how many where not all tasks are asked."""
    columns = {mode: partial(_each, mode=mode, figure=_decided) for mode in _modes(rows)}
    return _by_domain(rows, {"tasks": _tasks, "human's plan": _alone, **columns})


def seconds(rows: Sequence[Row]) -> Table:
    """Median seconds until the answer; a call without a proof takes longer than any other."""
    return _by_domain(
        rows, {mode: partial(_each, mode=mode, figure=_median_seconds) for mode in _modes(rows)}
    )


def expansions(rows: Sequence[Row]) -> Table:
    """Median expansions of the search and of each other contender, over calls that both have decided."""
    columns = {
        f"{mode}: {_OURS} : {other}": partial(_beside, mode=mode, other=other)
        for mode in _modes(rows)
        for other in contenders_in(row for row in rows if row.mode == mode)
        if other != _OURS
    }
    return _by_domain(rows, columns)


def over_time(rows: Sequence[Row]) -> Table:
    """How many calls are decided after some seconds, and how many have a plan by then; peak memory."""
    header = ("mode", "contender", "calls", "", *(f"{moment:g} s" for moment in MOMENTS), "most MiB")
    lines = []
    for mode in _modes(rows):
        for name in contenders_in(row for row in rows if row.mode == mode):
            of = [row for row in rows if row.mode == mode and row.contender == name]
            memory = [row.outcome.memory for row in of if row.outcome.memory is not None]
            most = f"{max(memory):.0f}" if memory else ""
            lines.append((mode, name, str(len(of)), "decided", *_counts(decision_times(of)), most))
            lines.append(("", "", "", "a plan", *_counts(plan_times(of)), ""))
    return header, lines


def decision_times(rows: Iterable[Row]) -> list[float]:
    """When the calls that are decided were."""
    return [row.outcome.seconds for row in rows if row.decided]


def plan_times(rows: Iterable[Row]) -> list[float]:
    """When the calls that have a plan had the first one."""
    return [row.outcome.plan_seconds for row in rows if row.outcome.plan_seconds is not None]


def failures(rows: Iterable[Row]) -> list[str]:
    """What could not be asked, and why, once for each reason."""
    return list(
        dict.fromkeys(
            f"{row.contender} fails on {row.domain} {row.task}, {row.mode}: {row.outcome.reason}"
            for row in rows
            if row.outcome.status == "failed"
        )
    )


def errors(rows: Iterable[Row]) -> dict[str, str]:
    """By task what is broken in it."""
    return {f"{row.domain} {row.task}": row.outcome.reason for row in rows if row.outcome.status == "error"}


def _counts(times: Sequence[float]) -> Iterable[str]:
    return (str(sum(time <= moment for time in times)) for moment in MOMENTS)


def _modes(rows: Iterable[Row]) -> list[str]:
    return list(dict.fromkeys(row.mode for row in rows))


def _by_domain(rows: Sequence[Row], columns: Mapping[str, _Cell]) -> Table:
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(row.domain, []).append(row)
    if len(groups) > 1:
        groups["all"] = list(rows)
    lines = [(name, *(cell(of) for cell in columns.values())) for name, of in groups.items()]
    return ("domain", *columns), lines


def _tasks(rows: Iterable[Row]) -> str:
    return str(len({(row.domain, row.task) for row in rows}))


def _alone(rows: Iterable[Row]) -> str:
    return _tasks(row for row in rows if row.alone)


def _each(rows: Sequence[Row], mode: str, figure: _Cell) -> str:
    """A figure for each contender."""
    of = [row for row in rows if row.mode == mode]
    return " / ".join(figure([row for row in of if row.contender == name]) for name in contenders_in(of))


def _decided(rows: Sequence[Row]) -> str:
    return str(sum(row.decided for row in rows))


def _median_seconds(rows: Sequence[Row]) -> str:
    times = sorted(decision_times(rows))
    middle = len(rows) // 2
    return f"{times[middle]:.2g}" if middle < len(times) else "-"


def _beside(rows: Sequence[Row], mode: str, other: str) -> str:
    expanded = {
        name: {
            (row.domain, row.task): row.outcome.expanded
            for row in rows
            if row.decided and row.mode == mode and row.contender == name
        }
        for name in (_OURS, other)
    }
    both = expanded[_OURS].keys() & expanded[other].keys()
    if not both:
        return "-"
    ours, theirs = (median(expanded[name][task] for task in both) for name in (_OURS, other))
    return f"{ours:,.0f} : {theirs:,.0f} ({len(both)})"
