"""Epochs as a partial order: what has to come before what, and nothing else.

Actions that share no agent, and of which neither changes what the other asks for or undoes what it
does, may come in any order.  So every order that the partial one allows is a plan, and they all
end in the same state.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, permutations

import networkx

from serendipity.model import GroundAction, PlanError, PlanStep, Task
from serendipity.model.task.actions import apply, disables


@dataclass(frozen=True, slots=True)
class Ordered:
    """The steps of a plan, one after another, and what has to come before what.

    Attributes:
        steps: in an order in which they can be executed.
        before: pairs of indices into ``steps``, without those that follow from others.
    """

    steps: tuple[PlanStep, ...]
    before: tuple[tuple[int, int], ...]


def ordered(task: Task, steps: Iterable[PlanStep]) -> Ordered:
    """The partial order of a plan.

    Raises:
        PlanError: a step is not applicable, or two actions of an epoch each spoil what the other one
            asks for, so that they can be done at once only.
    """
    state, done, actions = task.init, list[PlanStep](), list[GroundAction]()
    for epoch, group in groupby(sorted(steps, key=lambda step: step.epoch), lambda step: step.epoch):
        together = [(step, _variant(task, step, state)) for step in group]
        for step, action in _in_turn(epoch, together):
            done.append(step)
            actions.append(action)
        state = apply(state, *(action for _, action in together))
    graph = networkx.DiGraph()
    graph.add_nodes_from(range(len(done)))
    for second, later in enumerate(actions):
        graph.add_edges_from(
            (first, second) for first, earlier in enumerate(actions[:second]) if depend(earlier, later)
        )
    return Ordered(tuple(done), tuple(sorted(networkx.transitive_reduction(graph).edges)))


def depend(a: GroundAction, b: GroundAction) -> bool:
    """Whether two actions may not change places."""
    return bool(set(a.participants) & set(b.participants)) or _touches(a, b) or _touches(b, a)


def _touches(a: GroundAction, b: GroundAction) -> bool:
    """Whether what ``a`` does matters to ``b``, or is undone by it."""
    return not (
        set(a.add).isdisjoint((*b.pre, *b.neg, *b.delete))
        and set(a.delete).isdisjoint((*b.pre, *b.neg, *b.add))
    )


def _variant(task: Task, step: PlanStep, state: frozenset[int]) -> GroundAction:
    ids = task.named.get(step.action, ())
    for i in ids:
        if task.actions[i].applicable(state):
            return task.actions[i]
    what = "applicable" if ids else "an action of the problem"
    raise PlanError(f"epoch {step.epoch}: '{step.action}' is not {what}")


def _in_turn(
    epoch: int, together: Sequence[tuple[PlanStep, GroundAction]]
) -> Iterator[tuple[PlanStep, GroundAction]]:
    """Actions of an epoch, each before those that disable it."""
    graph = networkx.DiGraph()
    graph.add_nodes_from(range(len(together)))
    pairs = permutations(range(len(together)), 2)
    graph.add_edges_from((i, j) for i, j in pairs if disables(together[j][1], together[i][1]))
    circle = next((some for some in networkx.strongly_connected_components(graph) if len(some) > 1), None)
    if circle is not None:
        names = ", ".join(f"'{together[i][0].action}'" for i in sorted(circle))
        raise PlanError(
            f"epoch {epoch}: {names} can be done at once only, and no plan of unified-planning says so: "
            "plan with interference='strict'"
        )
    return (together[i] for i in networkx.lexicographical_topological_sort(graph))
