"""A plan as it turned out beside a human who replans, exact: the search and the facade play such plans."""

from fractions import Fraction
from typing import NamedTuple

from serendipity.model.task.plans import Step

INAPPLICABLE, CONFLICT, REFUSED = "inapplicable", "conflict", "refused"


class Skipped(NamedTuple):
    """An action of the plan that did not happen: its id, and why."""

    action: int
    why: str


class SimulatedEpoch(NamedTuple):
    """The events of one epoch.

    Attributes:
        epoch: from 1.
        saw: ids of the facts that the human found other than expected, with their truth.
        kept: ``c``: cost of their former plan where it still works, undiscounted.
        best: ``h``: their optimal cost alone.
        replanned: whether they have made another plan.
        plan: what they mean to do, from this epoch on.
        accepted: the joint action that they take part in, or None.
        own: what they do alone, or None.
        failed: whether ``own`` turned out to be impossible.
        robots: what robots do without them.
        skipped: what the plan says and does not happen.
    """

    epoch: int
    saw: tuple[tuple[int, bool], ...]
    kept: Fraction | None
    best: Fraction | None
    replanned: bool
    plan: tuple[int, ...]
    accepted: int | None
    own: int | None
    failed: bool
    robots: tuple[int, ...]
    skipped: tuple[Skipped, ...]

    @property
    def executed(self) -> tuple[int, ...]:
        """Ids of the actions that took place."""
        his = () if self.own is None or self.failed else (self.own,)
        return (*his, *(() if self.accepted is None else (self.accepted,)), *self.robots)


class Simulation(NamedTuple):
    """A plan as it turned out.

    Attributes:
        epochs: until the goals hold, the horizon, or nothing can happen any more.
        goals_hold: whether the goals hold after the last of them.
        cost: of the actions that took place, for the team.
        limit: which limit came before the end (as ``Result.reason`` has it), or None.
    """

    epochs: tuple[SimulatedEpoch, ...]
    goals_hold: bool
    cost: Fraction
    limit: str | None = None

    @property
    def steps(self) -> tuple[Step, ...]:
        """The actions that took place."""
        return tuple(Step(e.epoch, i) for e in self.epochs for i in sorted(e.executed))

    def realised(self, promised: Fraction) -> bool | None:
        """Whether the plan works out at the promised cost or less; None where a limit left that open."""
        if self.cost > promised or any(epoch.skipped for epoch in self.epochs):
            return False
        return self.goals_hold if self.limit is None else None
