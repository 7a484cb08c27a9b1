"""The whole team as a problem over packed states: one action after the other, circles of actions as one."""

from collections.abc import Iterable
from dataclasses import dataclass

from serendipity.model import Deadline, GroundAction, Task
from verify.base.execution import fits, grouped
from verify.base.relevance import Relevant
from verify.base.subproblem import Subproblem
from verify.packed.layout import Words
from verify.packed.operators import PackedOperator
from verify.packed.problem import PackedProblem, StateSpace


def circles(actions: list[tuple[int, GroundAction]], task: Task, deadline: Deadline) -> list[tuple[int, ...]]:
    """Sets of actions that may share an epoch but in no order follow each other."""
    by_id = dict(actions)
    disables = all_disabled(actions, deadline)
    found: set[tuple[int, ...]] = set()

    def extend(chosen: tuple[int, ...]) -> None:
        deadline.tick()
        if len(chosen) > 1 and _strongly_connected(chosen, disables):
            found.add(tuple(sorted(chosen)))
        if len(chosen) < len(task.agents):
            beside = [by_id[i] for i in chosen]
            for j in {j for i in chosen for j in disables[i]} - set(chosen):
                if fits(by_id[j], beside, strict=False):
                    extend((*chosen, j))

    for i, _ in actions:
        extend((i,))
    return sorted(found)


def all_disabled(actions: list[tuple[int, GroundAction]], deadline: Deadline) -> dict[int, list[int]]:
    """For each action, those of which it falsifies a precondition."""
    needing = grouped((fact, j) for j, action in deadline.each(actions) for fact in action.pre)
    forbidding = grouped((fact, j) for j, action in deadline.each(actions) for fact in action.neg)
    found: dict[int, list[int]] = {}
    for i, action in deadline.each(actions):
        disabled: set[int] = set()
        for fact in action.delete:
            disabled.update(needing.get(fact, ()))
        for fact in action.add:
            disabled.update(forbidding.get(fact, ()))
        found[i] = sorted(disabled - {i})
    return found


def _strongly_connected(chosen: tuple[int, ...], disables: dict[int, list[int]]) -> bool:
    """Whether each of the actions leads to each other one along ``disables``."""
    members = set(chosen)
    for start in chosen:
        reached, pending = {start}, [start]
        while pending:
            for j in disables[pending.pop()]:
                if j in members and j not in reached:
                    reached.add(j)
                    pending.append(j)
        if reached != members:
            return False
    return True


@dataclass(frozen=True, slots=True)
class TeamProblem:
    """The team's planning problem over packed states.

    Attributes:
        space: what may be true.
        problem: cheapest ways to all goals.
        singles: the relevant actions as operators, in their order.
        sets: the actions that each operator of the problem stands for.
        goal: facts that have to be true, and false, in the end.
        start: the initial state.
    """

    space: StateSpace
    problem: PackedProblem
    singles: list[PackedOperator]
    sets: list[tuple[int, ...]]
    goal: tuple[tuple[int, ...], tuple[int, ...]]
    start: Words


def team_space(question: Subproblem, part: Relevant) -> tuple[StateSpace, list[tuple[int, ...]]]:
    """The facts that may be true together, and the sets of actions that only work together."""
    task, deadline = question.task, question.deadline
    actions = [(i, task.actions[i]) for i in part.actions]
    together = [] if question.options.strict else circles(actions, task, deadline)
    as_one = [as_operator((task.actions[i] for i in circle), 0) for circle in together]
    return StateSpace(len(task.facts), task.init, [*task.actions, *as_one], deadline), together


def team_problem(question: Subproblem, part: Relevant, *, bounded: bool, exact: bool = False) -> TeamProblem:
    """The team's problem of a question."""
    task, deadline, prices = question.task, question.deadline, question.prices
    space, together = team_space(question, part)
    sets = [*((i,) for i in part.actions), *together]
    operators = [
        as_operator((task.actions[i] for i in each), sum(prices.team[i] + prices.talk[i] for i in each))
        for each in deadline.each(sets)
    ]
    goal = question.goal.positive, question.goal.negative
    problem = PackedProblem(space, part.facts, operators, goal, deadline, bounded=bounded, exact=exact)
    kept = [one for one, operator in zip(sets, operators, strict=True) if space.pairs.possible(operator.pre)]
    start = problem.pack([task.init])
    assert start is not None, "the initial state is reached"
    return TeamProblem(space, problem, operators[: len(part.actions)], kept, goal, start)


def as_operator(together: Iterable[GroundAction], weight: int) -> PackedOperator:
    """Actions as one."""
    chosen = tuple(together)

    def union(sets: Iterable[tuple[int, ...]]) -> tuple[int, ...]:
        return tuple(sorted({fact for facts in sets for fact in facts}))

    return PackedOperator(
        union(a.pre for a in chosen),
        union(a.neg for a in chosen),
        union(a.add for a in chosen),
        union(a.delete for a in chosen),
        weight,
    )
