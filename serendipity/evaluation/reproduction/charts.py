"""Small charts of a report, as elements of its page: lines and grouped bars."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING, Final

from serendipity.evaluation.measuring.plots import COLOURS, as_svg, figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DASHES: Final = ("-", "--", ":", "-.")
"""Series are told apart by colour, by dashes, and by their names."""

_BARS: Final = 0.8
"""The share of a group's room that its bars take."""

Points = Sequence[tuple[float, float]]


@dataclass(frozen=True, slots=True)
class Labels:
    """The words of a chart: its title, and what its axes show."""

    title: str
    x: str
    y: str


def lines(labels: Labels, series: Mapping[str, Points], *, log_x: bool = False) -> str:
    """A line chart; with ``log_x`` the horizontal axis is logarithmic.

    Raises:
        UsageError: matplotlib is not installed.
    """
    chart, axes = _empty(labels)
    for (name, points), colour, dash in zip(series.items(), cycle(COLOURS), cycle(_DASHES), strict=False):
        axes.plot(*zip(*points, strict=True), color=colour, linestyle=dash, label=name)
    if log_x:
        axes.set_xscale("log")
    return _finished(chart, axes, [y for points in series.values() for _, y in points])


def bars(labels: Labels, groups: Sequence[str], series: Mapping[str, Sequence[float]]) -> str:
    """Bars side by side: for each group one of each series; errors as of :func:`lines`."""
    chart, axes = _empty(labels)
    width = _BARS / len(series)
    for i, ((name, values), colour) in enumerate(zip(series.items(), cycle(COLOURS), strict=False)):
        left = [group - _BARS / 2 + i * width for group in range(len(groups))]
        axes.bar(left, values, width, align="edge", color=colour, label=name)
    axes.set_xticks(range(len(groups)), groups)
    return _finished(chart, axes, [y for values in series.values() for y in values])


def _empty(labels: Labels) -> "tuple[Figure, Axes]":
    chart = figure(7, 3.6)
    axes = chart.add_subplot()
    axes.set_title(labels.title, fontweight="bold", loc="left")
    axes.set(xlabel=labels.x, ylabel=labels.y)
    return chart, axes


def _finished(chart: "Figure", axes: "Axes", heights: Sequence[float]) -> str:
    from matplotlib.ticker import MaxNLocator

    if all(isinstance(height, int) for height in heights):  # nobody has half a task
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    axes.grid(axis="y", alpha=0.3)
    chart.legend(*axes.get_legend_handles_labels(), loc="outside right upper")
    return as_svg(chart, axes.get_title(loc="left"))
