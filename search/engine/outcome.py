"""What a search answers, in the model's terms."""

from dataclasses import dataclass
from fractions import Fraction

from search.engine.best_first import Node
from serendipity.model.plans import Step, Window
from serendipity.model.task import HumanPlan


@dataclass(frozen=True, slots=True)
class Outcome:
    """An answer, proved or on the way to it.

    Attributes:
        status: as in :class:`serendipity.model.Result`.
        human_plan: ``pi_H``, or None where the human has no plan alone.
        horizon: ``T``, ``"inf"``, or None where none was needed.
        reason: why there is no plan.
        steps: the composite plan, or None.
        window: its window, or None.
        cost: what it costs the team.
        objective: cost, window and communication.
        lower_bound: no answer has a smaller objective.
        baseline: cost of doing nothing for the human, or None if that is impossible.
        saving_alone: cost(pi_H) - cost of the answer with robots idle; None while that is not known.
        opportunity: the answer is cheaper than doing nothing, thanks to a robot.
        expanded: nodes expanded.
        generated: nodes generated.
    """

    status: str
    human_plan: HumanPlan | None = None
    horizon: int | str | None = None
    reason: str | None = None
    steps: tuple[Step, ...] | None = None
    window: Window | None = None
    cost: Fraction | None = None
    objective: Fraction | None = None
    lower_bound: Fraction | None = None
    baseline: Fraction | None = None
    saving_alone: Fraction | None = None
    opportunity: bool = False
    expanded: int = 0
    generated: int = 0

    @property
    def saving(self) -> Fraction | None:
        """What an opportunity costs less than the baseline, else 0; None without a baseline."""
        if self.baseline is None or self.cost is None:
            return None
        return self.baseline - self.cost if self.opportunity else Fraction(0)


def plan_steps(plan: HumanPlan, first_epoch: int = 1) -> tuple[Step, ...]:
    """One action an epoch from ``first_epoch`` on."""
    return tuple(Step(epoch, action) for epoch, action in enumerate(plan, start=first_epoch))


def path_steps(node: Node) -> tuple[Step, ...]:
    """The steps that lead to a node, in order of epoch and action."""
    steps: list[Step] = []
    at: Node | None = node
    while at is not None:
        steps.extend(Step(at.epoch, action) for action in at.actions)
        at = at.parent
    return tuple(sorted(steps))


def path_sets(node: Node) -> list[tuple[int, ...]]:
    """The non-empty action sets that lead to a node, in order."""
    sets: list[tuple[int, ...]] = []
    at: Node | None = node
    while at is not None:
        if at.actions:
            sets.append(at.actions)
        at = at.parent
    return sets[::-1]
