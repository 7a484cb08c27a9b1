"""What executions with a simulated person came to, run by run and over all of them."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any, Final

from serendipity.execution.decided import event_lines
from serendipity.model import Table
from serendipity.model.numbers import plain
from serendipity.model.table import Tabular, table_of
from serendipity.model.telling import Grid, Line, Output

SCHEMA: Final = "serendipity.executions/1"


@dataclass(frozen=True, slots=True)
class Run:
    """What one execution came to.

    Attributes:
        run: its number, from 1.
        seed: of its dice.
        reached: whether the person's goal holds in the end.
        epochs: how many there were.
        alone: what the person would have paid alone by an optimal plan; None where they have none.
        human_cost: what the person paid, undiscounted.
        cost: what the team paid.
        helped: the number of epochs in which robots did something, or something with the person.
        spoilt: the number of epochs in which what robots did made the plan that the person had in
            mind impossible.
        stopped: the number of epochs in which help that had begun was given up, or had been.
        late: the number of epochs without a decision within the deadline.
        open: the number of epochs whose decision is the best that was found in time, and not proved to
            be the best.
        left: what robots have not done of goals of their own, or left otherwise than they may.
        slowest: seconds of the longest decision.
        known: the epoch from which on the posterior of the person's goal was at least 0.9; None
            where it never was, or there was nothing to recognise.
        leads: the same for the epoch from which on it was the most probable one.
        wrong: the number of epochs in which robots did something while they held another goal than
            the person's for the most probable one.
    """

    run: int
    seed: int
    reached: bool
    epochs: int
    alone: float | None
    human_cost: float
    cost: float
    helped: int
    spoilt: int
    stopped: int
    late: int
    open: int
    left: int
    slowest: float
    known: int | None
    leads: int | None
    wrong: int

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return asdict(self)


@dataclass(frozen=True, slots=True, repr=False)
class Runs(Tabular, Output):
    """Several executions of one task.

    Attributes:
        human: who the person was, as ``execute`` takes it.
        rows: one a run.
        logs: the lines of each run's log.
    """

    human: str
    rows: tuple[Run, ...]
    logs: tuple[tuple[dict[str, Any], ...], ...]

    def table(self) -> Table:
        """The runs, one a row."""
        return table_of(Run, self.rows)

    def summary(self) -> dict[str, Any]:
        """Figures over all runs: shares are of runs, ``kept`` is of epochs, costs are means.

        What people pay is counted where they get there; who never does has saved nothing.
        """
        count, epochs = len(self.rows), sum(row.epochs for row in self.rows)
        arrived = [row for row in self.rows if row.reached]
        pairs = [(row.human_cost, row.alone) for row in arrived if row.alone is not None]
        compared = {
            "less": [paid < alone for paid, alone in pairs],
            "same": [paid == alone for paid, alone in pairs],
            "more": [paid > alone for paid, alone in pairs],
        }
        return {
            "runs": count,
            "reached": len(arrived) / count,
            **{name: _mean(found) for name, found in compared.items()},
            "alone": _mean([alone for _, alone in pairs]),
            "human_cost": _mean([row.human_cost for row in arrived]),
            "cost": _mean([row.cost for row in arrived]),
            "helped": sum(row.helped > 0 for row in self.rows) / count,
            "stopped": sum(row.stopped > 0 for row in self.rows) / count,
            "spoilt": sum(row.spoilt for row in self.rows),
            "kept": 1 - sum(row.late for row in self.rows) / epochs if epochs else 1.0,
        }

    def summary_lines(self) -> Iterator[str]:
        """The same in words."""
        found = self.summary()
        runs = "run" if found["runs"] == 1 else "runs"
        yield f"{found['runs']} {runs}, person: {self.human}; goal reached in {found['reached']:.2%}"
        arrived = sum(row.reached for row in self.rows)
        if arrived < found["runs"]:
            left_out = "; what was paid is counted in the others only" if arrived else ", so nothing is saved"
            yield f"not reached in {found['runs'] - arrived} of {found['runs']} {runs}{left_out}"
        if found["alone"] is not None:
            shares = ", ".join(f"{name} in {found[name]:.2%}" for name in ("less", "same", "more"))
            yield f"the person pays {shares} of the runs than alone"
            yield (
                f"in the mean {plain(found['human_cost'])} instead of {plain(found['alone'])}; "
                f"the team {plain(found['cost'])}"
            )
        yield f"a decision within the deadline in {found['kept']:.2%} of the epochs"

    def told(self) -> Iterator[Line | Grid]:
        """What ``execute`` prints: the story of a single run, the rows, the figures over all of them."""
        if len(self.rows) == 1:
            yield from (*map(Line, self.story()), Line())
        columns = [field.name for field in fields(Run)]
        yield Grid(columns, [[_cell(getattr(row, name)) for name in columns] for row in self.rows])
        yield from (Line(), *map(Line, self.summary_lines()))

    def _in_short(self) -> Iterator[str]:
        found = self.summary()
        yield f"{found['runs']} of a person who is {self.human}"
        yield f"goal reached in {found['reached']:.2%}"
        yield f"mean cost {plain(found['human_cost'])}, alone {plain(found['alone'])}"

    def story(self) -> Iterator[str]:
        """The runs in words, epoch by epoch."""
        for first, *events in self.logs:
            for event in events:
                yield from event_lines(event, first["human"])

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        return {
            "schema": SCHEMA,
            "human": self.human,
            "rows": [row.to_dict() for row in self.rows],
            "summary": self.summary(),
        }


def _mean(figures: Sequence[float]) -> float | None:
    """The mean, if there is anything."""
    return sum(figures) / len(figures) if figures else None


def _cell(value: object) -> str:
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
