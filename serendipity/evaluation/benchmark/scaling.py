"""Growth of time and memory along one axis while the others stay: generated buildings.

Each task is answered from its PDDL files in a process of its own.
"""

import statistics
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any, Final

from serendipity.evaluation.benchmark.child import in_child
from serendipity.evaluation.benchmark.measure import MODES
from serendipity.evaluation.measuring.figures import power_law
from serendipity.evaluation.measuring.tables import Proved, grouped, table
from serendipity.model.errors import SerendipityError, UsageError
from serendipity.model.telling import Grid
from serendipity.scenarios.generate import generate_usar

_LONG_CORRIDORS: Final = 16
"""A quarter of what chance makes of 840 rooms: plans come out from 13 to over 100 actions."""


@dataclass(frozen=True, slots=True)
class Size:
    """Size of a generated task, and the mode and discount that it is planned with."""

    rooms: int = 210
    medkits: int = 2
    robots: int = 1
    corridors: int | None = None
    mode: str = "serendipity"
    discount: str = "0.9"


@dataclass(frozen=True, slots=True)
class Axis:
    """One thing that varies.

    Attributes:
        title: what is varied, and what is fixed.
        unit: of its values.
        sizes: a value and the tasks of that value; ``length`` is measured, not chosen.
        labels: names of the values 0, 1, ... where they are no numbers.
    """

    title: str
    unit: str
    sizes: tuple[tuple[float, Size], ...]
    labels: tuple[str, ...] = ()
    measured: bool = False

    @property
    def numeric(self) -> bool:
        """True if its values are numbers with a power law."""
        return not self.labels


def _axis(title: str, field: str, values: Iterable[Any], **fixed: Any) -> Axis:
    """An axis of the values of one field of :class:`Size`, the others ``fixed``."""
    sizes = [(value, Size(**fixed, **{field: value})) for value in values]
    if isinstance(sizes[0][0], str):
        return Axis(title, field, tuple((i, size) for i, (_, size) in enumerate(sizes)), tuple(values))
    return Axis(title, field, tuple(sizes))


AXES: Final[dict[str, Axis]] = {
    "rooms": _axis("rooms (2 medkits, 1 robot, 0.9)", "rooms", (21, 42, 84, 210, 420, 840, 2100)),
    "medkits": _axis("medkits (210 rooms, 1 robot, 0.9)", "medkits", (2, 4, 6, 8, 10)),
    "robots": _axis("robots (84 rooms, 4 medkits, 0.9)", "robots", (1, 2, 3), rooms=84, medkits=4),
    "length": Axis(
        "length of his plan (840 rooms, 16 corridors, 2 medkits, 1 robot, 0.9)",
        "actions",
        ((0, Size(rooms=840, corridors=_LONG_CORRIDORS)),),
        measured=True,
    ),
    "modes": _axis("modes (84 rooms, 2 medkits, 1 robot, 0.9)", "mode", MODES, rooms=84),
    "discounts": _axis(
        "discounts (84 rooms, 2 medkits, communication)",
        "discount",
        ("0", "0.1", "0.3", "0.5", "0.7", "0.9"),
        rooms=84,
        mode="communication",
    ),
}
"""Axes of ``bench --scaling``."""

_MORE_SEEDS: Final = 4
"""Tasks of one size differ in length by chance, so it takes more of them to see a trend."""


@dataclass(frozen=True, slots=True)
class Sample(Proved):
    """One task of a series.

    Attributes:
        axis: a key of ``AXES``.
        value: on that axis; the index of a label where it has labels.
        actions: ground actions.
        length: actions of the human's plan, 0 where they have none.
        read_seconds: parsing, uniting, grounding.
        pack_seconds: finite-domain variables and packed actions, once a task.
        search_seconds: the first call.
        again_seconds: the same call again.
        memory: peak of the process, in MiB.
        status: as in results; the first call's.
    """

    axis: str
    value: float
    rooms: int
    medkits: int
    robots: int
    corridors: int | None
    mode: str
    discount: str
    seed: int
    actions: int
    length: int
    read_seconds: float
    pack_seconds: float
    search_seconds: float
    again_seconds: float
    memory: float
    status: str
    cost: float | None
    expanded: int

    @property
    def before_seconds(self) -> float:
        """Of what is done before the first call."""
        return self.read_seconds + self.pack_seconds


def scale(axes: Iterable[str], *, seeds: int = 5, time_limit: float = 20.0) -> Iterator[Sample]:
    """Answer the tasks of each axis, one after another.

    Args:
        axes: names in ``AXES``.
        seeds: tasks for each value.  Every second one's building has cycles: a
            connection more for each twenty rooms.
        time_limit: seconds for each call.

    Raises:
        UsageError: there is no such axis.
        SerendipityError: a process fails.
    """
    for name, value, size, seed in planned(axes, seeds):
        options = {"discount": size.discount, **MODES[size.mode]}
        building = {name: getattr(size, name) for name in ("rooms", "medkits", "robots", "corridors")}
        with tempfile.TemporaryDirectory() as folder:
            generate_usar(folder, **building, seed=seed, extra_edges=size.rooms // 20 if seed % 2 else 0)
            try:
                found = in_child("series", folder=folder, options=options, time_limit=time_limit)
            except SerendipityError as error:
                raise SerendipityError(f"scaling: {size} with seed {seed} failed: {error}") from None
        at = max(1, found["length"]) if AXES[name].measured else value
        yield Sample(axis=name, value=at, seed=seed, **asdict(size), **found)


def planned(axes: Iterable[str], seeds: int) -> list[tuple[str, float, Size, int]]:
    """The tasks of series: axis, value on it, what to generate from, seed.

    Raises:
        UsageError: there is no such axis.
    """
    tasks = []
    for name in axes:
        if name not in AXES:
            raise UsageError(f"--scaling: expected some of {', '.join(AXES)}, got '{name}'")
        axis = AXES[name]
        each = range(seeds * _MORE_SEEDS if axis.measured else seeds)
        tasks += [(name, value, size, seed) for value, size in axis.sizes for seed in each]
    return tasks


def scaling_table(samples: Sequence[Sample]) -> Grid:
    """A row for each value, medians but for the longest first call; measured axes are cut into quarters."""
    return table(
        ("axis", "value"),
        {
            (name, label): group
            for name, members in grouped(samples, lambda sample: sample.axis).items()
            for label, group in _values(AXES[name], sorted(members, key=lambda sample: sample.value))
        },
        {
            "tasks": len,
            "proved": lambda of: sum(sample.proved for sample in of),
            "first call": lambda of: _shown(statistics.median(s.search_seconds for s in of)),
            "longest": lambda of: _shown(max(s.search_seconds for s in of)),
            "again": lambda of: _shown(statistics.median(s.again_seconds for s in of)),
            "read + pack": lambda of: _shown(statistics.median(s.before_seconds for s in of)),
            "MiB": lambda of: f"{max(s.memory for s in of):.0f}",
        },
    )


def _shown(seconds: float) -> str:
    return f"{seconds * 1000:.1f} ms"


def _values(axis: Axis, members: Sequence[Sample]) -> Iterator[tuple[str, Sequence[Sample]]]:
    if axis.measured:
        cuts = [round(len(members) * i / 4) for i in range(5)]
        groups = [members[a:b] for a, b in pairwise(cuts) if a < b]
        yield from ((f"{group[0].value:g}-{group[-1].value:g}", group) for group in groups)
        return
    for value, group in grouped(members, lambda sample: sample.value).items():
        yield f"{value:g}" if axis.numeric else axis.labels[int(value)], group


def exponents(samples: Sequence[Sample]) -> Grid:
    """For each numeric axis the powers of time and memory, and their standard errors.

    Calls that met the limit count with the limit; ``>=`` marks a power that this makes too small.
    """
    numeric = (sample for sample in samples if AXES[sample.axis].numeric)
    return table(
        ("axis",),
        grouped(numeric, lambda sample: (sample.axis,)),
        {
            "first call": lambda of: (
                ("" if all(s.proved for s in of) else ">= ")
                + _power([(s.value, s.search_seconds) for s in of])
            ),
            "read + pack": lambda of: _power([(s.value, s.before_seconds) for s in of]),
            "memory": lambda of: _power([(s.value, s.memory) for s in of]),
        },
    )


def _power(points: Sequence[tuple[float, float]]) -> str:
    fit = power_law(points)
    return "" if fit is None else f"{fit.exponent:.2f} +- {fit.error:.2f}"
