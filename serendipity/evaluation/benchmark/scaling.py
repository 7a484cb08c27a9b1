"""How time and memory grow along one axis while the others stay: generated buildings.

Each task is answered in a process of its own, from its PDDL files, so that its peak memory
is its own and no call is warmed up by another.
"""

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final

from serendipity.evaluation.benchmark.measure import MODES
from serendipity.model.errors import SerendipityError, UsageError
from serendipity.scenarios.generate import generate_usar

_DISCOUNTS: Final = ("0", "0.1", "0.3", "0.5", "0.7", "0.9")

_LONG_CORRIDORS: Final = 16
"""A quarter of what chance makes of 840 rooms: plans come out from 13 to over 100 actions."""


@dataclass(frozen=True, slots=True)
class Size:
    """What a task is generated from, and what is asked of it."""

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
        """Whether its values are numbers with a power law."""
        return not self.labels


AXES: Final[dict[str, Axis]] = {
    "rooms": Axis(
        "rooms (2 medkits, 1 robot, 0.9)",
        "rooms",
        tuple((n, Size(rooms=n)) for n in (21, 42, 84, 210, 420, 840, 2100)),
    ),
    "medkits": Axis(
        "medkits (210 rooms, 1 robot, 0.9)",
        "medkits",
        tuple((n, Size(medkits=n)) for n in (2, 4, 6, 8, 10)),
    ),
    "robots": Axis(
        "robots (84 rooms, 4 medkits, 0.9)",
        "robots",
        tuple((n, Size(rooms=84, medkits=4, robots=n)) for n in (1, 2, 3)),
    ),
    "length": Axis(
        "length of his plan (840 rooms, 16 corridors, 2 medkits, 1 robot, 0.9)",
        "actions",
        ((0, Size(rooms=840, corridors=_LONG_CORRIDORS)),),
        measured=True,
    ),
    "modes": Axis(
        "modes (84 rooms, 2 medkits, 1 robot, 0.9)",
        "mode",
        tuple((i, Size(rooms=84, mode=mode)) for i, mode in enumerate(MODES)),
        labels=tuple(MODES),
    ),
    "discounts": Axis(
        "discounts (84 rooms, 2 medkits, communication)",
        "discount",
        tuple((i, Size(rooms=84, mode="communication", discount=d)) for i, d in enumerate(_DISCOUNTS)),
        labels=_DISCOUNTS,
    ),
}
"""What ``bench --scaling`` can vary."""

_MORE_SEEDS: Final = 4
"""Tasks of one size differ in length by chance, so it takes more of them to see a trend."""


@dataclass(frozen=True, slots=True)
class Sample:
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
    def solved(self) -> bool:
        """Whether it is proved."""
        return self.status in ("optimal", "infeasible")


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
        found = _answered(size, seed, time_limit)
        at = max(1, found["length"]) if AXES[name].measured else value
        yield Sample(axis=name, value=at, seed=seed, **_fields(size), **found)


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


def _fields(size: Size) -> dict[str, Any]:
    return {name: getattr(size, name) for name in Size.__dataclass_fields__}


def _answered(size: Size, seed: int, time_limit: float) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        generate_usar(
            folder,
            rooms=size.rooms,
            medkits=size.medkits,
            robots=size.robots,
            corridors=size.corridors,
            seed=seed,
            extra_edges=size.rooms // 20 if seed % 2 else 0,
        )
        arguments = [folder, size.mode, size.discount, str(time_limit)]
        command = [sys.executable, "-m", "serendipity.evaluation.benchmark.child", *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        last = done.stderr.strip().rpartition("\n")[2] or f"exit code {done.returncode}"
        raise SerendipityError(f"scaling: {size} with seed {seed} failed: {last}")
    return json.loads(done.stdout)  # type: ignore[no-any-return]
