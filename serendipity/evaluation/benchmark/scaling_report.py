"""Scaling series as tables."""

import statistics
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

from serendipity.evaluation.benchmark.fit import power_law
from serendipity.evaluation.benchmark.scaling import AXES, Axis, Sample

SCALING_HEADER: Final = (
    *("axis", "value", "tasks", "proved", "first call", "longest", "again", "read + pack", "MiB"),
)
"""Headings of :func:`scaling_table`: medians, but for the longest first call."""


def scaling_table(samples: Sequence[Sample]) -> list[tuple[str, ...]]:
    """A row for each value; measured axes are cut into quarters."""
    rows = []
    for name in dict.fromkeys(sample.axis for sample in samples):
        members = sorted((s for s in samples if s.axis == name), key=lambda s: s.value)
        for label, group in _values(AXES[name], members):
            first = [s.search_seconds for s in group]
            times = (
                statistics.median(first),
                max(first),
                statistics.median(s.again_seconds for s in group),
                statistics.median(s.read_seconds + s.pack_seconds for s in group),
            )
            rows.append(
                (
                    *(name, label, str(len(group)), str(sum(s.solved for s in group))),
                    *(f"{seconds * 1000:.1f} ms" for seconds in times),
                    f"{max(s.memory for s in group):.0f}",
                )
            )
    return rows


def _values(axis: Axis, members: Sequence[Sample]) -> Iterator[tuple[str, Sequence[Sample]]]:
    if axis.measured:
        cuts = [round(len(members) * i / 4) for i in range(5)]
        groups = [members[a:b] for a, b in pairwise(cuts) if a < b]
        for group in groups:
            yield f"{group[0].value:g}-{group[-1].value:g}", group
        return
    for value in dict.fromkeys(s.value for s in members):
        label = f"{value:g}" if axis.numeric else axis.labels[int(value)]
        yield label, [s for s in members if s.value == value]


def exponents(samples: Sequence[Sample]) -> list[tuple[str, ...]]:
    """For each numeric axis the power of the first call's time, of reading's, and of memory.

    Calls that met the limit count with the limit; ``>=`` marks a power that this makes too small.
    """
    rows = []
    for name in dict.fromkeys(s.axis for s in samples if AXES[s.axis].numeric):
        members = [s for s in samples if s.axis == name]
        more = "" if all(s.solved for s in members) else ">= "
        cells = []
        for points in (
            [(s.value, s.search_seconds) for s in members],
            [(s.value, s.read_seconds + s.pack_seconds) for s in members],
            [(s.value, s.memory) for s in members],
        ):
            fit = power_law(points)
            cells.append("" if fit is None else f"{fit.exponent:.2f} +- {fit.error:.2f}")
        rows.append((name, more + cells[0], *cells[1:]))
    return rows


EXPONENTS_HEADER: Final = ("axis", "first call", "read + pack", "memory")
"""Headings of :func:`exponents`: the power, and its standard error."""
