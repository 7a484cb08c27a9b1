"""Timings as log-log plots, by matplotlib (the optional extra ``plot``)."""

import io
from collections.abc import Sequence
from math import ceil, floor, log10
from typing import TYPE_CHECKING, Final, Literal

from serendipity.evaluation.benchmark.fit import power_law
from serendipity.evaluation.benchmark.measure import Timing
from serendipity.evaluation.benchmark.scaling import AXES, Sample
from serendipity.model.errors import UsageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SUFFIXES: Final = (".png", ".svg", ".pdf")
COLOURS: Final = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""The Okabe-Ito palette: told apart by everybody."""
_MARKERS: Final = "os^Dv<>"
_RATIOS: Final = (1, 10, 100, 1000, 10000)
_UNPROVED: Final = "x"


def check_suffix(suffix: str) -> None:
    """Complain before the work is done, not after.

    Raises:
        UsageError: plots have no such format, or matplotlib is not installed.
    """
    if suffix not in SUFFIXES:
        raise UsageError(f"--plot: expected a file that ends in {', '.join(SUFFIXES)}, got '{suffix}'")
    new_figure(1, 1)


def side_by_side(timings: Sequence[Timing], suffix: str) -> bytes:
    """What each contender takes over what the search takes, a point a call; crosses met the limit."""
    modes = list(dict.fromkeys(timing.mode for timing in timings))
    figure = new_figure(5 * len(modes), 4.6)
    for i, mode in enumerate(modes):
        members = [timing for timing in timings if timing.mode == mode]
        axes = figure.add_subplot(1, len(modes), i + 1)
        axes.set_title(mode)
        _scatter(axes, members)
    return as_bytes(figure, suffix)


def _scatter(axes: "Axes", timings: Sequence[Timing]) -> None:
    base = {(t.task, t.discount): t.seconds * 1000 for t in timings if t.contender == "search"}
    points = [(base[t.task, t.discount], t) for t in timings if (t.task, t.discount) in base]
    names = dict.fromkeys(t.contender for _, t in points if t.contender != "search")
    for name, colour, marker in zip(names, COLOURS, _MARKERS, strict=False):
        for solved, shape in ((True, marker), (False, _UNPROVED)):
            chosen = [(x, t.seconds * 1000) for x, t in points if t.contender == name and t.solved is solved]
            if chosen:
                xs, ys = zip(*chosen, strict=True)
                label = name if solved else f"{name}, at the limit"
                axes.scatter(xs, ys, s=14, c=colour, marker=shape, label=label, alpha=0.7, clip_on=False)
    if names:
        axes.legend(fontsize=8, loc="upper left")
    others = [t.seconds * 1000 for _, t in points if t.contender in names]
    if others:
        low, high = _decades(axes, "x", [x for x, _ in points])
        _, most = _decades(axes, "y", [*others, *base.values()])
        for ratio in _RATIOS:
            if high * ratio <= most:
                axes.plot([low, high], [low * ratio, high * ratio], color="grey", lw=0.7, ls="--", zorder=0)
                axes.annotate(f" {ratio:,} x", (high, high * ratio), fontsize=8, color="grey", va="center")
    axes.set_xlabel("search, ms")
    axes.set_ylabel("contender, ms")


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
    names = list(dict.fromkeys(sample.axis for sample in samples))
    figure = new_figure(4.6 * len(names), 7.4)
    for i, name in enumerate(names):
        members = [sample for sample in samples if sample.axis == name]
        upper = figure.add_subplot(2, len(names), i + 1)
        lower = figure.add_subplot(2, len(names), len(names) + i + 1)
        _points(upper, members, [s.search_seconds * 1000 for s in members], "first call, ms")
        upper.set_title(AXES[name].title, fontsize=9)
        _decades(upper, "y", [s.search_seconds * 1000 for s in members])
        fit = power_law([(s.value, s.search_seconds * 1000) for s in members]) if AXES[name].numeric else None
        if fit is not None:
            ends = [min(s.value for s in members), max(s.value for s in members)]
            upper.plot(
                ends, [fit.at(x) for x in ends], color="black", lw=1, label=f"exponent {fit.exponent:.2f}"
            )
            upper.legend(fontsize=8)
        _points(lower, members, [s.memory for s in members], "peak memory of the process, MiB")
        lower.set_ylim(0, 1.1 * max(s.memory for s in members))
    return as_bytes(figure, suffix)


def _points(axes: "Axes", samples: Sequence[Sample], values: Sequence[float], label: str) -> None:
    axis = AXES[samples[0].axis]
    for solved, marker in ((True, "o"), (False, _UNPROVED)):
        chosen = [(s.value, y) for s, y in zip(samples, values, strict=True) if s.solved is solved]
        if chosen:
            xs, ys = zip(*chosen, strict=True)
            axes.scatter(xs, ys, s=14, marker=marker, c=COLOURS[0 if solved else 1], alpha=0.7)
    if axis.numeric:
        from matplotlib.ticker import NullFormatter

        ticks = sorted({s.value for s in samples})
        axes.set_xscale("log")
        axes.set_xticks(_spread(ticks), [f"{tick:g}" for tick in _spread(ticks)])
        axes.xaxis.set_minor_formatter(NullFormatter())
    else:
        axes.set_xticks(range(len(axis.labels)), axis.labels, fontsize=8)
    axes.set_xlabel(axis.unit)
    axes.set_ylabel(label)


def _spread(ticks: Sequence[float]) -> list[float]:
    """At most eight of the values; the first and the last are among them."""
    step = max(1, -(-(len(ticks) - 1) // 7))
    return [*ticks[:-1:step], ticks[-1]]


def new_figure(width: float, height: float) -> "Figure":
    """An empty figure, in inches.

    Raises:
        UsageError: matplotlib is not installed.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise UsageError("plots need matplotlib: pip install serendipity-planner[plot]") from None
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def as_bytes(figure: "Figure", suffix: str) -> bytes:
    """A figure as a file with that suffix."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format=suffix.removeprefix("."), dpi=120)
    return buffer.getvalue()
