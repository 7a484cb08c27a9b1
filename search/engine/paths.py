"""The steps of a plan from the node that it ended in."""

from search.engine.best_first import Node
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan


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
