"""Growth of time and memory along one axis while the others stay: generated buildings.

Each task is answered from its PDDL files in a process of its own.  Of its row, ``domain`` is the axis and
``task`` the value on it.
"""

import statistics
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any, Final

from serendipity.evaluation.benchmark.contenders import searched
from serendipity.evaluation.benchmark.rows import BenchRow
from serendipity.evaluation.benchmark.side_by_side import MODES
from serendipity.evaluation.measuring.figures import power_law
from serendipity.evaluation.measuring.record import apart
from serendipity.evaluation.measuring.suites import chosen
from serendipity.evaluation.measuring.tables import grouped, table
from serendipity.model.errors import SerendipityError
from serendipity.model.telling import Grid
from serendipity.pddl import read_folder
from serendipity.scenarios.generate import generate_usar

_USUAL: Final[dict[str, Any]] = {"rooms": 210, "medkits": 2, "robots": 1, "corridors": None}
_LONG_CORRIDORS: Final = 16
"""A quarter of what chance makes of 840 rooms: plans come out from 13 to over 100 actions."""


@dataclass(frozen=True, slots=True)
class Axis:
    """One thing that varies.

    Attributes:
        title: what is varied, and what is fixed.
        values: of what it is called; none for the length of the human's plan, which is measured, not chosen.
        fixed: other things than usual; ``mode`` and ``discount``, too.
    """

    title: str
    values: tuple[Any, ...] = ()
    fixed: dict[str, Any] | None = None


AXES: Final[dict[str, Axis]] = {
    "rooms": Axis("rooms (2 medkits, 1 robot, 0.9)", (21, 42, 84, 210, 420, 840, 2100)),
    "medkits": Axis("medkits (210 rooms, 1 robot, 0.9)", (2, 4, 6, 8, 10)),
    "robots": Axis("robots (84 rooms, 4 medkits, 0.9)", (1, 2, 3), {"rooms": 84, "medkits": 4}),
    "length": Axis(
        "length of his plan (840 rooms, 16 corridors, 2 medkits, 1 robot, 0.9)",
        fixed={"rooms": 840, "corridors": _LONG_CORRIDORS},
    ),
    "modes": Axis("modes (84 rooms, 2 medkits, 1 robot, 0.9)", tuple(MODES), {"rooms": 84}),
    "discounts": Axis(
        "discounts (84 rooms, 2 medkits, communication)",
        ("0", "0.1", "0.3", "0.5", "0.7", "0.9"),
        {"rooms": 84, "mode": "communication"},
    ),
}
"""Axes of ``bench --scaling``."""

_OPTIONS: Final = {"modes": "mode", "discounts": "discount"}
"""Axes of which values are no numbers with a power law."""

_MORE_SEEDS: Final = 4
"""Tasks of one size differ in length by chance, so it takes more of them to see a trend."""


def scale(axes: Iterable[str], *, seeds: int = 5, time_limit: float = 20.0) -> Iterator[BenchRow]:
    """Answer the tasks of each axis, ``seeds`` of each value, one after another.

    Every second one's building has cycles: a connection more for each twenty rooms.  Errors are those of
    :func:`planned`, and a SerendipityError where a process fails.
    """
    for name, value, seed in planned(axes, seeds):
        size = {"mode": "serendipity", "discount": "0.9", **_USUAL, **(AXES[name].fixed or {})}
        size |= {} if value is None else {_OPTIONS.get(name, name): value}
        mode, discount = size.pop("mode"), size.pop("discount")
        with tempfile.TemporaryDirectory() as folder:
            generate_usar(folder, **size, seed=seed, extra_edges=size["rooms"] // 20 if seed % 2 else 0)
            load, options = partial(read_folder, folder), {"discount": discount, **MODES[mode]}
            try:
                outcome = apart(partial(searched, again=True), load, options, time_limit)
            except SerendipityError as error:
                raise SerendipityError(f"scaling: {size} with seed {seed} failed: {error}") from None
        at = max(1, outcome.length) if value is None else value
        yield BenchRow(name, str(at), "", "", True, mode, float(discount), "search", outcome)


def planned(axes: Iterable[str], seeds: int) -> list[tuple[str, Any, int]]:
    """The tasks of series: axis, value on it or None, seed; a UsageError where there is no such axis."""
    tasks: list[tuple[str, Any, int]] = []
    for name, axis in chosen(axes, AXES, "--scaling").items():
        if axis.values:
            tasks += [(name, value, seed) for value in axis.values for seed in range(seeds)]
        else:
            tasks += [(name, None, seed) for seed in range(seeds * _MORE_SEEDS)]
    return tasks


def is_numeric(axis: str) -> bool:
    """True if an axis has numbers with a power law."""
    return axis not in _OPTIONS


def first_seconds(row: BenchRow) -> float:
    """Seconds of the first call, once the task is prepared."""
    return row.outcome.seconds - row.outcome.prepare_seconds


def _before(row: BenchRow) -> float:
    return row.outcome.read_seconds + row.outcome.prepare_seconds


def scaling_table(rows: Sequence[BenchRow]) -> Grid:
    """A row for each value, medians but for the longest first call; measured axes are cut into quarters."""
    groups = {
        (axis, label): group
        for axis, of in grouped(rows, lambda row: row.domain).items()
        for label, group in _values(axis, of)
    }
    columns = {
        "tasks": len,
        "proved": lambda of: sum(row.outcome.proved for row in of),
        "first call": lambda of: _shown(statistics.median(map(first_seconds, of))),
        "longest": lambda of: _shown(max(map(first_seconds, of))),
        "again": lambda of: _shown(statistics.median(row.outcome.again_seconds or 0 for row in of)),
        "read + pack": lambda of: _shown(statistics.median(map(_before, of))),
        "MiB": lambda of: f"{max(row.outcome.memory or 0 for row in of):.0f}",
    }
    return table(("axis", "value"), groups, columns)


def _shown(seconds: float) -> str:
    return f"{seconds * 1000:.1f} ms"


def _values(axis: str, rows: Sequence[BenchRow]) -> Iterator[tuple[str, Sequence[BenchRow]]]:
    if AXES[axis].values:
        yield from grouped(rows, lambda row: row.task).items()
        return
    ordered = sorted(rows, key=lambda row: float(row.task))
    cuts = [round(len(ordered) * i / 4) for i in range(5)]
    groups = [ordered[a:b] for a, b in pairwise(cuts) if a < b]
    yield from ((f"{group[0].task}-{group[-1].task}", group) for group in groups)


def exponents(rows: Sequence[BenchRow]) -> Grid:
    """For each numeric axis the powers of time and memory, and their standard errors.

    Calls that met the limit count with the limit; ``>=`` marks a power that this makes too small.
    """

    def power(of: Sequence[BenchRow], figures: Iterable[float]) -> str:
        fit = power_law([float(row.task) for row in of], figures)
        return "" if fit is None else f"{fit.exponent:.2f} +- {fit.error:.2f}"

    def first_call(of: Sequence[BenchRow]) -> str:
        return f"{'>= ' * (not all(row.outcome.proved for row in of))}{power(of, map(first_seconds, of))}"

    columns = {
        "first call": first_call,
        "read + pack": lambda of: power(of, map(_before, of)),
        "memory": lambda of: power(of, (row.outcome.memory or 0 for row in of)),
    }
    numeric = (row for row in rows if is_numeric(row.domain))
    return table(("axis",), grouped(numeric, lambda row: (row.domain,)), columns)
