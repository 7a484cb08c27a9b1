"""Rows as tables: what is decided, with how many expansions, how soon; and what can't be true.

In a cell, the figures of several contenders stand in the order of :func:`contenders_in`.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from statistics import median
from typing import Final

from serendipity.evaluation.benchmark.coverage.rows import Row
from serendipity.evaluation.measuring.tables import grouped, table
from serendipity.model.telling import Grid, Line

MOMENTS: Final = (0.1, 1.0, 2.0, 5.0, 20.0)
"""Seconds at which coverage is told."""

_OURS: Final = "search"
_Cell = Callable[[Sequence[Row]], str]


def contenders_in(rows: Iterable[Row]) -> list[str]:
    """Names of contenders, in the order of the rows."""
    return list(dict.fromkeys(row.contender for row in rows))


def tables(rows: Sequence[Row]) -> Iterator[Line | Grid]:
    """All tables, with their titles."""
    order = " / ".join(contenders_in(rows))
    titled = {
        f"Calls decided: {order}": decided(rows),
        f"Median seconds until the answer, reading left out: {order}": seconds(rows),
        "Median expansions where both have decided": expansions(rows),
        "Calls decided, and calls with a plan, after some seconds": over_time(rows),
    }
    for number, (title, grid) in enumerate(titled.items()):
        yield from [Line()] * (number > 0)
        yield from (Line(f"{title}."), Line(), grid)


def decided(rows: Sequence[Row]) -> Grid:
    """To how many calls each contender proves the answer; of how many where not all tasks are asked."""
    columns = {mode: partial(_each, mode=mode, figure=_decided) for mode in _modes(rows)}
    return _by_domain(rows, {"tasks": _tasks, "human's plan": _alone, **columns})


def seconds(rows: Sequence[Row]) -> Grid:
    """Median seconds until the answer; a call without a proof takes longer than any other."""
    return _by_domain(
        rows, {mode: partial(_each, mode=mode, figure=_median_seconds) for mode in _modes(rows)}
    )


def expansions(rows: Sequence[Row]) -> Grid:
    """Median expansions of the search and of each other contender, over calls that both have decided."""
    columns = {
        f"{mode}: {_OURS} : {other}": partial(_beside, mode=mode, other=other)
        for mode, of in grouped(rows, lambda row: row.mode).items()
        for other in contenders_in(of)
        if other != _OURS
    }
    return _by_domain(rows, columns)


def over_time(rows: Sequence[Row]) -> Grid:
    """Numbers of calls that are decided after some seconds, and that have a plan by then; peak memory."""
    header = ("mode", "contender", "calls", "", *(f"{moment:g} s" for moment in MOMENTS), "most MiB")
    lines: list[tuple[str, ...]] = []
    for mode, asked in grouped(rows, lambda row: row.mode).items():
        for name, of in grouped(asked, lambda row: row.contender).items():
            memory = [row.outcome.memory for row in of if row.outcome.memory is not None]
            most = f"{max(memory):.0f}" if memory else ""
            lines.append((mode, name, str(len(of)), "decided", *_counts(decision_times(of)), most))
            lines.append(("", "", "", "a plan", *_counts(plan_times(of)), ""))
    return Grid(header, lines)


def decision_times(rows: Iterable[Row]) -> list[float]:
    """When the calls that are decided were."""
    return [row.outcome.seconds for row in rows if row.outcome.proved]


def plan_times(rows: Iterable[Row]) -> list[float]:
    """When the calls that have a plan had the first one."""
    return [row.outcome.plan_seconds for row in rows if row.outcome.plan_seconds is not None]


def failures(rows: Iterable[Row]) -> list[str]:
    """Calls that could not be asked, and why, once for each reason."""
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


def _by_domain(rows: Sequence[Row], columns: Mapping[str, _Cell]) -> Grid:
    groups = grouped(rows, lambda row: (row.domain,))
    if len(groups) > 1:
        groups[("all",)] = list(rows)
    return table(("domain",), groups, columns)


def _tasks(rows: Iterable[Row]) -> str:
    return str(len({(row.domain, row.task) for row in rows}))


def _alone(rows: Iterable[Row]) -> str:
    return _tasks(row for row in rows if row.alone)


def _each(rows: Sequence[Row], mode: str, figure: _Cell) -> str:
    """A figure for each contender."""
    asked = (row for row in rows if row.mode == mode)
    return " / ".join(map(figure, grouped(asked, lambda row: row.contender).values()))


def _decided(rows: Sequence[Row]) -> str:
    return str(sum(row.outcome.proved for row in rows))


def _median_seconds(rows: Sequence[Row]) -> str:
    times = sorted(decision_times(rows))
    middle = len(rows) // 2
    return f"{times[middle]:.2g}" if middle < len(times) else "-"


def _beside(rows: Sequence[Row], mode: str, other: str) -> str:
    expanded = {
        name: {
            (row.domain, row.task): row.outcome.expanded
            for row in rows
            if row.outcome.proved and row.mode == mode and row.contender == name
        }
        for name in (_OURS, other)
    }
    both = expanded[_OURS].keys() & expanded[other].keys()
    if not both:
        return "-"
    ours, theirs = (median(expanded[name][task] for task in both) for name in (_OURS, other))
    return f"{ours:,.0f} : {theirs:,.0f} ({len(both)})"


def disagreements(rows: Sequence[Row]) -> list[str]:
    """Calls of which contenders have proved what can't all be true, in words."""
    calls = grouped(rows, lambda row: f"{row.domain} {row.task}, {row.mode}")
    return [f"{call}: {told}" for call, of in calls.items() if (told := _told(of))]


def _told(rows: Sequence[Row]) -> str:
    proved = {row.contender: row.outcome.cost for row in rows if row.outcome.proved}
    if len(set(proved.values())) > 1:
        told = (f"{name} {'no plan' if cost is None else cost}" for name, cost in proved.items())
        return f"the proved optima differ: {', '.join(told)}"
    costs = [(row.outcome.cost, row.contender) for row in rows if row.outcome.cost is not None]
    bounds = [(row.outcome.lower_bound, row.contender) for row in rows if row.outcome.lower_bound is not None]
    if len({name for _, name in (*costs, *bounds)}) > 1 and costs and bounds:
        (cost, who), (bound, other) = min(costs), max(bounds)
        if cost < bound:
            return f"a plan of {who} costs {cost}, and {other} says at least {bound}"
    return ""
