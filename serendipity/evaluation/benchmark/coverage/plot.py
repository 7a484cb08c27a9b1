"""Coverage over time as a picture."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Final

from serendipity.evaluation.benchmark.coverage.report import contenders_in, decision_times, plan_times
from serendipity.evaluation.benchmark.coverage.rows import Row
from serendipity.evaluation.benchmark.plot import COLOURS, as_bytes, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SOONEST: Final = 0.001
"""Seconds at which the axis starts: what is sooner is figure there."""


def over_time(rows: Sequence[Row], suffix: str) -> bytes:
    """Calls decided over seconds, a line a contender; dotted: those that have a plan."""
    modes = list(dict.fromkeys(row.mode for row in rows))
    figure = new_figure(4.2 * len(modes), 3.8)
    for i, mode in enumerate(modes):
        axes = figure.add_subplot(1, len(modes), i + 1)
        for name, colour in zip(contenders_in(rows), COLOURS, strict=False):
            of = [row for row in rows if row.mode == mode and row.contender == name]
            if of:
                _curve(axes, decision_times(of), color=colour, label=name)
                _curve(axes, plan_times(of), color=colour, linestyle=":", label=f"{name}, a plan")
        axes.set(title=mode, xscale="log", xlabel="seconds", ylabel="calls")
        axes.set_ylim(0, None)
        axes.legend(fontsize=8, loc="upper left")
    return as_bytes(figure, suffix)


def _curve(axes: "Axes", times: Iterable[float], **style: str) -> None:
    ordered = sorted(max(time, _SOONEST) for time in times)
    axes.step([_SOONEST, *ordered], range(len(ordered) + 1), where="post", **style)
