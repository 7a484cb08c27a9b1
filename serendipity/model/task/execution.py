"""The steps of a plan: the action of a name, its participants, the cost of each agent (semantics 1, 2).

Written once for everything around the planner, as :func:`.actions.apply` is.  The verifier uses
neither: it executes plans with code of its own.
"""

from collections.abc import Iterable, Iterator
from fractions import Fraction

from serendipity.model.numbers import total
from serendipity.model.task.actions import GroundAction, State
from serendipity.model.task.plans import PlanStep, Step
from serendipity.model.task.task import Task


def actions_named(task: Task, name: str, agents: Iterable[str]) -> tuple[int, ...]:
    """Ids of the actions (variants, if several) of a canonical name in which just these take part."""
    wanted = sorted(agents)
    return tuple(
        i
        for i in task.named.get(name, ())
        if sorted(task.agents[agent] for agent in task.actions[i].participants) == wanted
    )


def variant_named(task: Task, name: str, agents: Iterable[str], state: State) -> int:
    """The first action of a name that is applicable in a state, or else the first one, or an IndexError."""
    ids = actions_named(task, name, agents)
    return next((i for i in ids if task.actions[i].applicable(state)), ids[0])


def steps_named(task: Task, steps: Iterable[PlanStep]) -> list[Step]:
    """The steps of a plan by action ids; of variants the first."""
    return [Step(step.epoch, actions_named(task, step.action, step.agents)[0]) for step in steps]


def participants(task: Task, action: GroundAction) -> tuple[str, ...]:
    """Names of the agents that take part in an action, in the task's order."""
    return tuple(task.agents[i] for i in action.participants)


def actions_of(task: Task, steps: Iterable[Step]) -> Iterator[GroundAction]:
    """The actions of some steps, in their order."""
    return (task.actions[step.action] for step in steps)


def shares(task: Task, actions: Iterable[GroundAction], discount: Fraction) -> dict[int, Fraction]:
    """The cost of each agent, by id: a joint action's cost to the team is shared equally."""
    found = dict.fromkeys(range(len(task.agents)), Fraction(0))
    alike: dict[tuple[int, ...], list[Fraction]] = {}
    for action in actions:
        alike.setdefault(action.participants, []).append(action.cost)
    for team, costs in alike.items():
        price = total(costs) if task.human in team else total(costs) * (1 - discount)
        for agent in team:
            found[agent] += price / len(team)
    return found
