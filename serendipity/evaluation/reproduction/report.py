"""A run as tables for people, and as one HTML page that needs nothing else: tables and charts."""

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from math import floor
from typing import Final

from serendipity.evaluation.measuring.plots import Labels, bars, lines
from serendipity.evaluation.measuring.tables import grouped
from serendipity.evaluation.reproduction.run import Reproduction
from serendipity.evaluation.reproduction.tables import Entry, Tables
from serendipity.model.errors import UsageError
from serendipity.model.printable import markup
from serendipity.model.telling import Grid, as_html, as_page, wide

_TITLE: Final = "Planning for serendipity: a reproduction"
_MOST_BINS: Final = 16
_WIDTHS: Final = tuple(Fraction(10) ** power * factor for power in range(-6, 12) for factor in (1, 2, 5))
_LEAST_SECONDS: Final = 1e-6


def html_report(run: Reproduction, tables: Tables) -> str:
    """The page; its charts need matplotlib, and scroll by themselves, so that it fits narrow screens."""
    parts = "\n".join(f"<h2>{title}</h2>\n{wide(as_html([grid]))}" for title, grid in titled(tables))
    try:
        charts = "\n".join(map(wide, _charts(run, tables.costs)))
    except UsageError as error:
        charts = f"<p>{markup(str(error))}</p>"
    tests = len({row.test for row in run.rows})
    intro = f"<p>{tests} tasks, modes {markup(', '.join(run.modes))}.</p>"
    return as_page(_TITLE, f"{intro}\n{parts}\n<h2>Charts</h2>\n{charts}")


def titled(tables: Tables) -> Iterator[tuple[str, Grid]]:
    """Each of the tables under its title."""
    if any(of.tasks for of in tables.costs):
        yield "Table I: mean cost (number of tasks in which a robot helps)", _table_1(tables.costs)
    header, rows = ["mode", "calls", "mean", "median", "max", "paper (2015, its machine)"], []
    printed = any(of.paper_2015_seconds is not None for of in tables.times)
    for of in (one for one in tables.times if one.calls):
        seconds = (f"{x:.6f}" for x in (of.mean_seconds, of.median_seconds, of.max_seconds))
        rows.append([of.mode, str(of.calls), *seconds, _shown(of.paper_2015_seconds, ".2f")][: 5 + printed])
    if rows:
        yield "Table II: seconds of a planning call", Grid(header[: 5 + printed], rows)
    header, rows = ["example", "mode", "discount", "alone", "cost", "window"], []
    for one in tables.examples:
        window = "[{start}, {end})".format(**one["window"]) if one["window"] else ""
        figures = (_shown(one[name], ".10g") for name in ("discount", "human_cost", "cost"))
        rows.append([f"{one['section']} ({one['example']})", one["mode"], *figures, window])
    yield "The paper's examples, sections III-B to III-D", Grid(header, rows)


def _table_1(entries: Sequence[Entry]) -> Grid:
    """A row per discount, a column per variant, the paper's figures beside."""
    header, rows = ["discount"], []
    for variant, of in grouped(entries, lambda entry: entry.variant).items():
        header += [variant, *["paper"] * any(entry.paper_mean_cost is not None for entry in of)]
    printed = {entry.variant for entry in entries if entry.paper_mean_cost is not None}
    for discount, of in grouped(entries, lambda entry: entry.discount).items():
        row = [f"{float(discount):.10g}"]
        for entry in of:
            row.append(_shown(entry.mean_cost, ".6g", entry.improved))
            row += [_shown(entry.paper_mean_cost, ".2f", entry.paper_improved)] * (entry.variant in printed)
        rows.append(row)
    return Grid(header, rows)


def _shown(value: float | Fraction | None, form: str, count: int | None = None) -> str:
    """A figure, and a count in brackets."""
    told = "" if count is None else f" ({count})"
    return "-" if value is None else f"{float(value):{form}}{told}"


def _charts(run: Reproduction, entries: Sequence[Entry]) -> Iterator[str]:
    shown = [entry for entry in entries if entry.mean_cost is not None]
    helped = [entry for entry in shown if entry.variant != "individual"]
    yield from _by_discount("Mean cost", "mean cost", shown, lambda entry: float(entry.mean_cost or 0))
    yield from _by_discount("Opportunities", "tasks", helped, lambda entry: entry.improved)
    yield from _savings(run)
    series = {}
    for mode, of in grouped(run.rows, lambda row: row.mode).items():
        seconds = sorted(max(row.seconds, _LEAST_SECONDS) for row in of)
        series[mode] = [(value, 100 * (i + 1) / len(seconds)) for i, value in enumerate(seconds)]
    labels = Labels("Planning calls answered within a time", "seconds", "percent of calls")
    yield lines(labels, series, log_x=True)


def _by_discount(
    title: str, y: str, entries: Sequence[Entry], figure: Callable[[Entry], float]
) -> Iterator[str]:
    variants = grouped(entries, lambda entry: entry.variant)
    series = {name: [(float(entry.discount), figure(entry)) for entry in of] for name, of in variants.items()}
    if series:
        yield lines(Labels(f"{title} against discount", "discount", y), series)


def _savings(run: Reproduction) -> Iterator[str]:
    """A histogram of savings at the greatest discount, where something is saved."""
    most = max(run.discounts)
    helped = [row for row in run.rows if row.discount == most and row.opportunity and row.human_cost]
    saved = {
        mode: [(row.human_cost or 0) - (row.cost or 0) for row in of]
        for mode, of in grouped(helped, lambda row: row.mode).items()
    }
    if saved:
        greatest = max(value for values in saved.values() for value in values)
        width = next(width for width in _WIDTHS if greatest / width < _MOST_BINS)
        bins = range(floor(greatest / width) + 1)
        series = {
            mode: [sum(floor(value / width) == i for value in values) for i in bins]
            for mode, values in saved.items()
        }
        labels = Labels(f"Savings at discount {float(most):g}", "saved cost, from", "tasks")
        yield bars(labels, [f"{float(i * width):g}-" for i in bins], series)
