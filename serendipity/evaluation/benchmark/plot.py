"""Timings as pictures, by matplotlib (the optional extra ``plot``)."""

from collections.abc import Iterable, Sequence
from math import ceil, floor, log10
from typing import TYPE_CHECKING, Final, Literal

from serendipity.evaluation.benchmark.coverage.report import contenders_in, decision_times, plan_times
from serendipity.evaluation.benchmark.coverage.rows import Row
from serendipity.evaluation.benchmark.measure import MeasuredCall
from serendipity.evaluation.benchmark.scaling import AXES, Sample
from serendipity.evaluation.measuring.figures import power_law
from serendipity.evaluation.measuring.plots import COLOURS, SUFFIXES, as_bytes, figure
from serendipity.evaluation.measuring.tables import grouped
from serendipity.model.errors import UsageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MARKERS: Final = "os^Dv<>"
_UNPROVED: Final = "x"
_RATIOS: Final = (1, 10, 100, 1000, 10000)
_SOONEST: Final = 0.001
"""Seconds at which an axis of time starts: what is sooner is drawn there."""


def check_suffix(suffix: str) -> None:
    """Complain before the work is done, not after.

    Raises:
        UsageError: plots have no such format, or matplotlib is not installed.
    """
    if suffix not in SUFFIXES:
        raise UsageError(f"--plot: expected a file that ends in {', '.join(SUFFIXES)}, got '{suffix}'")
    figure(1, 1)


def side_by_side(timings: Sequence[MeasuredCall], suffix: str) -> bytes:
    """Time of each contender over that of the search, a point a call; crosses met the limit."""
    modes = grouped(timings, lambda timing: timing.mode)
    drawn = figure(5 * len(modes), 4.6)
    for i, (mode, members) in enumerate(modes.items()):
        axes = drawn.add_subplot(1, len(modes), i + 1)
        axes.set(title=mode, xlabel="search, ms", ylabel="contender, ms")
        _scatter(axes, members)
    return as_bytes(drawn, suffix)


def _scatter(axes: "Axes", timings: Sequence[MeasuredCall]) -> None:
    base = {(t.task, t.discount): t.seconds * 1000 for t in timings if t.contender == "search"}
    points = [(base[t.task, t.discount], t) for t in timings if (t.task, t.discount) in base]
    others = grouped((point for point in points if point[1].contender != "search"), lambda p: p[1].contender)
    for (name, of), colour, marker in zip(others.items(), COLOURS, _MARKERS, strict=False):
        for solved, shape in ((True, marker), (False, _UNPROVED)):
            chosen = [(x, t.seconds * 1000) for x, t in of if t.proved is solved]
            if chosen:
                label = name if solved else f"{name}, at the limit"
                xs, ys = zip(*chosen, strict=True)
                axes.scatter(xs, ys, s=14, c=colour, marker=shape, label=label, alpha=0.7, clip_on=False)
    if others:
        axes.legend(fontsize=8, loc="upper left")
        low, high = _decades(axes, "x", [x for x, _ in points])
        seconds = [t.seconds * 1000 for of in others.values() for _, t in of]
        _, most = _decades(axes, "y", [*seconds, *base.values()])
        for ratio in _RATIOS:
            if high * ratio <= most:
                axes.plot([low, high], [low * ratio, high * ratio], color="grey", lw=0.7, ls="--", zorder=0)
                axes.annotate(f" {ratio:,} x", (high, high * ratio), fontsize=8, color="grey", va="center")


def _decades(axes: "Axes", which: Literal["x", "y"], values: Sequence[float]) -> tuple[float, float]:
    """Make an axis logarithmic, from a power of ten to another, written out."""
    from matplotlib.ticker import FuncFormatter, NullFormatter

    low, high = 10 ** floor(log10(min(values))), 10 ** ceil(log10(max(values)))
    axes.set(**{f"{which}scale": "log", f"{which}lim": (low, max(high, low * 10))})
    axis = axes.xaxis if which == "x" else axes.yaxis
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())
    return low, max(high, low * 10)


def series(samples: Sequence[Sample], suffix: str) -> bytes:
    """Search time and peak memory over each axis, with the fitted power of the time."""
    axes_of = grouped(samples, lambda sample: sample.axis)
    drawn = figure(4.6 * len(axes_of), 7.4)
    for i, (name, members) in enumerate(axes_of.items()):
        upper, lower = (drawn.add_subplot(2, len(axes_of), row * len(axes_of) + i + 1) for row in (0, 1))
        times = [s.search_seconds * 1000 for s in members]
        _points(upper, members, times, "first call, ms")
        upper.set_title(AXES[name].title, fontsize=9)
        _decades(upper, "y", times)
        values = [s.value for s in members]
        fit = power_law([*zip(values, times, strict=True)]) if AXES[name].numeric else None
        if fit is not None:
            ends = [min(values), max(values)]
            label = f"exponent {fit.exponent:.2f}"
            upper.plot(ends, [fit.at(x) for x in ends], color="black", lw=1, label=label)
            upper.legend(fontsize=8)
        _points(lower, members, [s.memory for s in members], "peak memory of the process, MiB")
        lower.set_ylim(0, 1.1 * max(s.memory for s in members))
    return as_bytes(drawn, suffix)


def _points(axes: "Axes", samples: Sequence[Sample], values: Sequence[float], label: str) -> None:
    axis = AXES[samples[0].axis]
    for solved, marker in ((True, "o"), (False, _UNPROVED)):
        chosen = [(s.value, y) for s, y in zip(samples, values, strict=True) if s.proved is solved]
        if chosen:
            colour = COLOURS[0 if solved else 1]
            xs, ys = zip(*chosen, strict=True)
            axes.scatter(xs, ys, s=14, marker=marker, c=colour, alpha=0.7)
    if axis.numeric:
        from matplotlib.ticker import NullFormatter

        ticks = _spread(sorted({s.value for s in samples}))
        axes.set_xscale("log")
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.xaxis.set_minor_formatter(NullFormatter())
    else:
        axes.set_xticks(range(len(axis.labels)), axis.labels, fontsize=8)
    axes.set(xlabel=axis.unit, ylabel=label)


def _spread(ticks: Sequence[float]) -> list[float]:
    """At most eight of the values; the first and the last are among them."""
    step = max(1, -(-(len(ticks) - 1) // 7))
    return [*ticks[:-1:step], ticks[-1]]


def over_time(rows: Sequence[Row], suffix: str) -> bytes:
    """Calls decided over seconds, a line a contender; dotted: those that have a plan."""
    modes = grouped(rows, lambda row: row.mode)
    drawn = figure(4.2 * len(modes), 3.8)
    for i, (mode, asked) in enumerate(modes.items()):
        axes = drawn.add_subplot(1, len(modes), i + 1)
        for name, colour in zip(contenders_in(rows), COLOURS, strict=False):
            of = [row for row in asked if row.contender == name]
            if of:
                _curve(axes, decision_times(of), color=colour, label=name)
                _curve(axes, plan_times(of), color=colour, linestyle=":", label=f"{name}, a plan")
        axes.set(title=mode, xscale="log", xlabel="seconds", ylabel="calls")
        axes.set_ylim(0, None)
        axes.legend(fontsize=8, loc="upper left")
    return as_bytes(drawn, suffix)


def _curve(axes: "Axes", times: Iterable[float], **style: str) -> None:
    ordered = sorted(max(time, _SOONEST) for time in times)
    axes.step([_SOONEST, *ordered], range(len(ordered) + 1), where="post", **style)
