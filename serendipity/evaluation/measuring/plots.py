"""Figures by matplotlib (the optional extra ``plot``), and the files and pages that they go to."""

import io
import re
from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Final, NamedTuple

from serendipity.model.printable import markup
from serendipity.pictures.formats.png import empty_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS: Final = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""The Okabe-Ito palette: told apart by everybody."""

SUFFIXES: Final = (".png", ".svg", ".pdf")

_DASHES: Final = ("-", "--", ":", "-.")
"""Series are told apart by colour, by dashes, and by their names."""

_BARS: Final = 0.8
"""The share of a group's room that its bars take."""


class Labels(NamedTuple):
    """The words of a chart: its title, and what its axes show."""

    title: str
    x: str
    y: str


def figure(width: float, height: float) -> "Figure":
    """An empty figure, in inches; a UsageError where matplotlib is not installed."""
    return empty_figure("plots", figsize=(width, height), layout="constrained")


def as_bytes(drawn: "Figure", suffix: str) -> bytes:
    """A figure as a file with that suffix."""
    buffer = io.BytesIO()
    drawn.savefig(buffer, format=suffix.removeprefix("."), dpi=120)
    return buffer.getvalue()


def lines(labels: Labels, series: Mapping[str, Sequence[tuple[float, float]]], *, log_x: bool = False) -> str:
    """A line chart as an element of a page; with ``log_x`` the horizontal axis is logarithmic."""
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
    axes = chart.add_subplot(xlabel=labels.x, ylabel=labels.y)
    axes.set_title(labels.title, fontweight="bold", loc="left")
    return chart, axes


def _finished(chart: "Figure", axes: "Axes", heights: Sequence[float]) -> str:
    """The chart as an element of a page, on which no other one has its title: by that its parts are named."""
    from matplotlib import rc_context
    from matplotlib.ticker import MaxNLocator

    if all(isinstance(height, int) for height in heights):  # nobody has half a task
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    axes.grid(axis="y", alpha=0.3)
    chart.legend(*axes.get_legend_handles_labels(), loc="outside right upper")
    title = axes.get_title(loc="left")
    with rc_context({"svg.fonttype": "none", "svg.hashsalt": title}):
        text = as_bytes(chart, ".svg").decode()
    element = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.S)
    own = re.sub(r"\W+", "-", title)
    element = re.sub(r'(\bid="|href="#|url\(#)', rf"\1{own}-", element)
    return element.replace("<svg", f'<svg role="img" aria-label="{markup(title)}"', 1)
