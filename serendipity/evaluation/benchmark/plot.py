"""Rows as pictures, by matplotlib (the optional extra ``plot``)."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Final

from serendipity.evaluation.benchmark.coverage import contenders_in, decision_times, plan_times
from serendipity.evaluation.benchmark.rows import BenchRow
from serendipity.evaluation.benchmark.scaling import AXES, first_seconds, is_numeric
from serendipity.evaluation.measuring.figures import power_law
from serendipity.evaluation.measuring.plots import COLOURS, SUFFIXES, as_bytes, figure
from serendipity.evaluation.measuring.tables import grouped
from serendipity.model.errors import UsageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MARKERS: Final = "os^Dv<>"
_RATIOS: Final = (1, 10, 100, 1000, 10000)
_SOONEST: Final = 0.001
"""Seconds at which an axis of time starts: what is sooner is drawn there."""


def check_suffix(suffix: str) -> None:
    """A UsageError, before the work is done, where plots have no such format, or matplotlib is missing."""
    if suffix not in SUFFIXES:
        raise UsageError(f"--plot: expected a file that ends in {', '.join(SUFFIXES)}, got '{suffix}'")
    figure(1, 1)


def side_by_side(rows: Sequence[BenchRow], suffix: str) -> bytes:
    """Time of each contender over that of the search, a point a call; crosses met the limit."""
    modes = grouped(rows, lambda row: row.mode)
    drawn = figure(5 * len(modes), 4.6)
    for i, (mode, of) in enumerate(modes.items(), start=1):
        axes = drawn.add_subplot(1, len(modes), i, title=mode, xscale="log", yscale="log")
        axes.set(xlabel="search, ms (dashed: 1, 10, 100 ... times as long)", ylabel="contender, ms")
        base = {(row.task, row.discount): row for row in of if row.contender == "search"}
        others = grouped((row for row in of if row.contender != "search"), lambda row: row.contender)
        for (name, theirs), colour, marker in zip(others.items(), COLOURS, _MARKERS, strict=False):
            pairs = [(base[at], row) for row in theirs if (at := (row.task, row.discount)) in base]
            points = [(1000 * ours.outcome.seconds, 1000 * row.outcome.seconds, row) for ours, row in pairs]
            _points(axes, points, (marker, colour), (name, f"{name}, at the limit"))
        for ratio in _RATIOS:
            axes.axline((1, ratio), (10, 10 * ratio), color="grey", lw=0.7, ls="--", zorder=0)
        _legend(axes)
    return as_bytes(drawn, suffix)


def series(rows: Sequence[BenchRow], suffix: str) -> bytes:
    """Search time and peak memory over each axis, with the fitted power of the time."""
    axes_of = grouped(rows, lambda row: row.domain)
    drawn = figure(4.6 * len(axes_of), 7.4)
    for i, (name, of) in enumerate(axes_of.items(), start=1):
        numeric = is_numeric(name)
        xs: list[Any] = [float(row.task) if numeric else row.task for row in of]
        times = [1000 * first_seconds(row) for row in of]
        upper = drawn.add_subplot(2, len(axes_of), i, ylabel="first call, ms", yscale="log")
        upper.set_title(AXES[name].title, fontsize=9)
        lower = drawn.add_subplot(2, len(axes_of), len(axes_of) + i, xlabel=name)
        lower.set_ylabel("peak memory of the process, MiB")
        for axes, ys in ((upper, times), (lower, [row.outcome.memory or 0 for row in of])):
            if numeric:
                axes.set_xscale("log")
            _points(axes, [*zip(xs, ys, of, strict=True)], ("o", COLOURS[0]), ("", ""))
        lower.set_ylim(0, None)
        if numeric and (fit := power_law(xs, times)) is not None:
            ends, fitted = (min(xs), max(xs)), f"exponent {fit.exponent:.2f}"
            upper.plot(ends, [fit.factor * x**fit.exponent for x in ends], color="black", label=fitted)
        _legend(upper)
    return as_bytes(drawn, suffix)


def over_time(rows: Sequence[BenchRow], suffix: str) -> bytes:
    """Calls decided over seconds, a line a contender; dotted: those that have a plan."""
    modes = grouped(rows, lambda row: row.mode)
    drawn = figure(4.2 * len(modes), 3.8)
    for i, (mode, asked) in enumerate(modes.items(), start=1):
        axes = drawn.add_subplot(1, len(modes), i, title=mode, xscale="log", xlabel="seconds", ylabel="calls")
        for name, colour in zip(contenders_in(rows), COLOURS, strict=False):
            of = [row for row in asked if row.contender == name]
            if of:
                _curve(axes, decision_times(of), color=colour, label=name)
                _curve(axes, plan_times(of), color=colour, linestyle=":", label=f"{name}, a plan")
        axes.set_ylim(0, None)
        _legend(axes)
    return as_bytes(drawn, suffix)


def _points(
    axes: "Axes", points: Sequence[tuple[Any, float, BenchRow]], look: tuple[str, str], names: tuple[str, str]
) -> None:
    """Points of rows that are proved, and as crosses of those that are not, each with its name."""
    marker, colour = look
    for proved, shape, name in ((True, marker, names[0]), (False, "x", names[1])):
        of = [(x, y) for x, y, row in points if row.outcome.proved is proved]
        if of:
            xs, ys = zip(*of, strict=True)
            axes.scatter(xs, ys, s=14, c=colour, marker=shape, label=name, alpha=0.7)


def _curve(axes: "Axes", times: Iterable[float], **style: str) -> None:
    ordered = sorted(max(time, _SOONEST) for time in times)
    axes.step([_SOONEST, *ordered], range(len(ordered) + 1), where="post", **style)


def _legend(axes: "Axes") -> None:
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=8, loc="upper left")
