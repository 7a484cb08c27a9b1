"""A run as one HTML page that needs nothing else: tables and charts."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import floor
from typing import Final

from serendipity.evaluation.measuring.tables import grouped
from serendipity.evaluation.reproduction.charts import Labels, Points, bars, lines
from serendipity.evaluation.reproduction.run import Reproduction
from serendipity.evaluation.reproduction.tables import Entry, ExampleAnswer, Tables, Times
from serendipity.model.errors import UsageError
from serendipity.model.printable import markup
from serendipity.model.telling import Grid

_STYLE: Final = """
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; margin: 1rem 0; }
.wide { overflow-x: auto; }
th, td { padding: .25rem .75rem; text-align: right; border-bottom: 1px solid #8886; white-space: nowrap; }
th { white-space: normal; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; }
svg { width: 100%; min-width: 36rem; max-width: 44rem; height: auto; }
"""
_MOST_BINS: Final = 16
_WIDTHS: Final = tuple(Fraction(10) ** power * factor for power in range(-6, 12) for factor in (1, 2, 5))
_LEAST_SECONDS: Final = 1e-6


def html_report(run: Reproduction, tables: Tables) -> str:
    """The page; its charts need matplotlib."""
    tests = len({row.test for row in run.rows})
    body = [
        "<h1>Planning for serendipity: a reproduction</h1>",
        f"<p>{tests} tasks, modes {markup(', '.join(run.modes))}.</p>",
        "<h2>Table I: cost, and tasks in which a robot helps</h2>",
        _table(table_1_grid(tables.costs)),
        "<h2>Table II: seconds of a planning call</h2>",
        _table(table_2_grid(tables.times)),
        "<h2>The examples of sections III-B to III-D</h2>",
        _table(examples_grid(tables.examples)),
        "<h2>Charts</h2>",
        *_charts(run, tables.costs),
    ]
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>Planning for serendipity: a reproduction</title><style>{_STYLE}</style></head>\n"
        "<body>\n" + "\n".join(body) + "\n</body></html>\n"
    )


def table_1_grid(entries: Sequence[Entry]) -> Grid:
    """Table I: a row per discount, a column per variant, the paper's figures beside."""
    variants = list(dict.fromkeys(entry.variant for entry in entries))
    found = {(entry.discount, entry.variant): entry for entry in entries}
    printed = {entry.variant for entry in entries if entry.paper_mean_cost is not None}
    header = ["discount"]
    for variant in variants:
        header.append(variant)
        if variant in printed:
            header.append("paper")
    rows = []
    for discount in dict.fromkeys(entry.discount for entry in entries):
        row = [f"{float(discount):.10g}"]
        for variant in variants:
            entry = found[discount, variant]
            mean, theirs = entry.mean_cost, entry.paper_mean_cost
            row.append("-" if mean is None else f"{float(mean):.6g} ({entry.improved})")
            if variant in printed:
                row.append("-" if theirs is None else f"{float(theirs):.2f} ({entry.paper_improved})")
        rows.append(row)
    return Grid(header, rows)


def table_2_grid(times: Sequence[Times]) -> Grid:
    """Table II: a row per mode."""
    header = ["mode", "calls", "mean", "median", "max"]
    printed = any(time.paper_2015_seconds is not None for time in times)
    rows = []
    for time in times:
        row = [
            time.mode,
            str(time.calls),
            *(f"{x:.6f}" for x in (time.mean_seconds, time.median_seconds, time.max_seconds)),
        ]
        if printed:
            row.append("-" if time.paper_2015_seconds is None else f"{time.paper_2015_seconds:.2f}")
        rows.append(row)
    return Grid([*header, *(["paper (2015, its machine)"] if printed else [])], rows)


def examples_grid(answers: Sequence[ExampleAnswer]) -> Grid:
    """The paper's examples: a row per example, mode and discount."""
    rows = []
    for answer in answers:
        window = "" if answer.window is None else f"[{answer.window.start}, {answer.window.end})"
        costs = [f"{cost:.10g}" if cost is not None else "-" for cost in (answer.human_cost, answer.cost)]
        name = f"{answer.section} ({answer.example})"
        rows.append([name, answer.mode, f"{float(answer.discount):.10g}", *costs, window])
    return Grid(["example", "mode", "discount", "alone", "cost", "window"], rows)


def _table(grid: Grid) -> str:
    head = "".join(f"<th>{markup(cell)}</th>" for cell in grid.header)
    body = "".join(
        "<tr>" + "".join(f"<td>{markup(cell)}</td>" for cell in row) + "</tr>\n" for row in grid.rows
    )
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead>\n<tbody>{body}</tbody></table></div>'


def _charts(run: Reproduction, entries: Sequence[Entry]) -> list[str]:
    """Charts that scroll by themselves, so that the page fits narrow screens; without matplotlib a hint."""
    shown = [entry for entry in entries if entry.mean_cost is not None]
    helped = [entry for entry in shown if entry.variant != "individual"]
    try:
        charts = [
            _by_discount("Mean cost", "mean cost", shown, lambda entry: float(entry.mean_cost or 0)),
            _by_discount("Opportunities", "tasks", helped, lambda entry: entry.improved),
            _chart_of_savings(run),
            _chart_of_times(run),
        ]
    except UsageError as error:
        return [f"<p>{markup(str(error))}</p>"]
    return [f'<div class="wide">{chart}</div>' for chart in charts if chart]


def _by_discount(title: str, y: str, entries: Sequence[Entry], figure: Callable[[Entry], float]) -> str:
    series = {
        variant: [(float(entry.discount), figure(entry)) for entry in of]
        for variant, of in grouped(entries, lambda entry: entry.variant).items()
    }
    return lines(Labels(f"{title} against discount", "discount", y), series) if series else ""


def _chart_of_savings(run: Reproduction) -> str:
    """Histogram of savings at the greatest discount, where something is saved."""
    most = max(run.discounts)
    saved: dict[str, list[Fraction]] = {}
    for row in run.rows:
        if row.discount == most and row.opportunity and row.cost is not None and row.human_cost is not None:
            saved.setdefault(row.mode, []).append(row.human_cost - row.cost)
    if not saved:
        return ""
    width = _width(max(max(values) for values in saved.values()))
    last = max(floor(value / width) for values in saved.values() for value in values)
    groups = [f"{float(i * width):g}-" for i in range(last + 1)]
    series = {
        mode: [sum(floor(value / width) == i for value in saved[mode]) for i in range(last + 1)]
        for mode in run.modes
        if mode in saved
    }
    labels = Labels(f"Savings at discount {float(most):g}", "saved cost, from", "tasks")
    return bars(labels, groups, series)


def _width(most: Fraction) -> Fraction:
    """The finest round width that makes no more than ``_MOST_BINS`` bins."""
    return next(width for width in _WIDTHS if most / width < _MOST_BINS)


def _chart_of_times(run: Reproduction) -> str:
    series: dict[str, Points] = {}
    for mode in run.modes:
        seconds = sorted(max(row.seconds, _LEAST_SECONDS) for row in run.rows if row.mode == mode)
        series[mode] = [(value, 100 * (i + 1) / len(seconds)) for i, value in enumerate(seconds)]
    labels = Labels("Planning calls answered within a time", "seconds", "percent of calls")
    return lines(labels, series, log_x=True)
