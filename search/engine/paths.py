"""The steps of a plan from the node that it ended in."""

from collections.abc import Iterator

from search.engine.best_first import Incumbent, Node
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan


def plan_steps(plan: HumanPlan, first_epoch: int = 1) -> tuple[Step, ...]:
    """One action an epoch from ``first_epoch`` on."""
    return tuple(Step(epoch, action) for epoch, action in enumerate(plan, start=first_epoch))


def whole_plan(found: Incumbent) -> tuple[Step, ...]:
    """The steps of a plan that has a last node, in order of epoch and action."""
    assert found.node is not None, "an incumbent of a search has one"
    before = (Step(at.epoch, action) for at in _back_from(found.node) for action in at.actions)
    return tuple(sorted((*before, *plan_steps(found.tail, found.end))))


def path_sets(node: Node) -> list[tuple[int, ...]]:
    """The non-empty action sets that lead to a node, in order."""
    return [at.actions for at in _back_from(node) if at.actions][::-1]


def _back_from(node: Node) -> Iterator[Node]:
    """A node and those that lead to it, the last one first."""
    at: Node | None = node
    while at is not None:
        yield at
        at = at.parent
