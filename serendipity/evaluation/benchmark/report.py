"""Timings as tables: what the others take over what the search takes, then the times themselves.

``>=`` marks figures that would be, or might be, larger if calls had not met their limit.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

from serendipity.evaluation.benchmark.measure import SEARCHES, MeasuredCall
from serendipity.evaluation.measuring.figures import percentile
from serendipity.evaluation.measuring.tables import grouped
from serendipity.model.telling import Grid

_RATIOS: Final = (
    *("mode", "contender", "over", "calls", "of medians", "of 95 %"),
    *("call by call: 50 %", "95 %", "least"),
)
_TIMES: Final = ("mode", "contender", "calls", "proved", "median", "95 %", "longest", "min-max")


@dataclass(frozen=True, slots=True)
class _Figure:
    """A time or a ratio; ``cut``: a limit made it too small."""

    value: float
    cut: bool = False


def ratios(timings: Sequence[MeasuredCall]) -> Grid:
    """Times of each contender as multiples of each way to call the search, on the same calls.

    First the ratios of medians and of 95th percentiles, then percentiles of the ratios of
    single calls.  Calls that met the limit count with what they had taken by then.  Calls that the
    search itself did not prove are left out: ``calls`` says how many are counted, of how many.
    """
    groups = _groups(timings)
    rows = [
        (mode, contender, search, *_ratios(members, groups[mode, search]))
        for (mode, contender), members in groups.items()
        for search in (SEARCHES if contender not in SEARCHES else ())
        if (mode, search) in groups
    ]
    return Grid(_RATIOS, rows)


def _ratios(members: Sequence[MeasuredCall], searches: Sequence[MeasuredCall]) -> Iterator[str]:
    base = {(timing.task, timing.discount): timing.seconds for timing in searches if timing.proved}
    pairs = [(_figure(t), base[t.task, t.discount]) for t in members if (t.task, t.discount) in base]
    yield str(len(members)) if len(pairs) == len(members) else f"{len(pairs)} of {len(members)}"
    if not pairs:
        yield from ("",) * 5
        return
    theirs = [figure for figure, _ in pairs]
    ours = [_Figure(seconds) for _, seconds in pairs]
    for share in (0.5, 0.95):
        figure = _percentile(theirs, share)
        yield _ratio(replace(figure, value=figure.value / _percentile(ours, share).value))
    single = [replace(figure, value=figure.value / seconds) for figure, seconds in pairs]
    yield from (_ratio(_percentile(single, share)) for share in (0.5, 0.95, 0.0))


def times(timings: Sequence[MeasuredCall]) -> Grid:
    """A row for each mode and contender: of the median times of each call, but for min-max."""
    return Grid(_TIMES, [(*key, *_times(members)) for key, members in _groups(timings).items()])


def _times(members: Sequence[MeasuredCall]) -> Iterator[str]:
    yield from (str(len(members)), str(sum(timing.proved for timing in members)))
    figures = [_figure(timing) for timing in members]
    for share in (0.5, 0.95, 1.0):
        figure = _percentile(figures, share)
        yield f"{_mark(figure)}{figure.value * 1000:.2f} ms"
    least = min(timing.fastest for timing in members)
    most = max(timing.slowest for timing in members)
    yield f"{least * 1000:.2f}-{most * 1000:.2f} ms"


def _groups(timings: Sequence[MeasuredCall]) -> dict[tuple[str, str], list[MeasuredCall]]:
    """Timings by mode and contender; an outside process is a contender beside what it says of itself."""
    return grouped(_with_processes(timings), lambda timing: (timing.mode, timing.contender))


def _with_processes(timings: Sequence[MeasuredCall]) -> Iterator[MeasuredCall]:
    for timing in timings:
        yield timing
        seconds = timing.process_seconds
        if seconds is not None:
            name = f"{timing.contender}, process"
            yield replace(timing, contender=name, seconds=seconds, fastest=seconds, slowest=seconds)


def _figure(timing: MeasuredCall) -> _Figure:
    return _Figure(timing.seconds, cut=not timing.proved)


def _percentile(figures: Sequence[_Figure], share: float) -> _Figure:
    """The figure below which a share of them lies; cut if it could be larger without a limit."""
    value = percentile([figure.value for figure in figures], share)
    return _Figure(value, cut=any(figure.cut and figure.value <= value for figure in figures))


def _ratio(figure: _Figure) -> str:
    digits = 2 if figure.value < 10 else 0
    return f"{_mark(figure)}{figure.value:,.{digits}f} x"


def _mark(figure: _Figure) -> str:
    return ">= " if figure.cut else ""
