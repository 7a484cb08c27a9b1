"""The facade over silent assistance (semantics 7): answers of the game as results."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial
from importlib import import_module

from search import PreparedTask
from search.assistance import Assistance, assist
from serendipity.model.deadline import Deadline
from serendipity.model.options import Options
from serendipity.model.plans import Step
from serendipity.model.policy import Costs
from serendipity.model.result import PlanStep, Result
from serendipity.model.task import Task


def load_arrays() -> None:
    """Load what only large tasks need, and takes longer than a short time limit."""
    import_module("search.assistance.distances.layers")
    import_module("search.assistance.distances.perimeter")


def assistance_answers(
    prepared: PreparedTask, options: Options, deadline: Deadline
) -> Iterator[Callable[[], Result]]:
    """Answers of falling value, put into words when called; the last one is the best known.

    ``cost`` and ``objective`` are the sum of both totals, ``lower_bound`` bounds that sum for
    the lexicographic optimum; ``saving`` is what the human saves.  The pairs themselves
    are in ``statistics["bounds"]``, as exact texts.

    Args:
        prepared: the task, prepared.
        options: options in force.
        deadline: polled.

    Raises:
        UsageError: there is not exactly one robot.
    """
    for answer in assist(prepared, options, deadline):
        yield partial(_result, prepared.task, options, answer, deadline)


def _result(task: Task, options: Options, answer: Assistance, deadline: Deadline) -> Result:
    human_cost = None if answer.human_plan is None else task.cost_of(answer.human_plan)
    names = None if answer.human_plan is None else tuple(task.actions[i].name for i in answer.human_plan)
    upper = answer.upper
    total = None if upper is None else float(sum(upper))
    saving = None if human_cost is None or upper is None else human_cost - upper[0]
    steps = None if answer.plan is None else tuple(_step(task, step) for step in answer.plan)
    return Result(
        mode=options.mode,
        status=answer.status,
        human=task.agents[task.human],
        options=options,
        human_plan=names,
        human_cost=None if human_cost is None else float(human_cost),
        opportunity=saving is not None and saving > 0,
        cost=total,
        saving=None if saving is None else float(saving),
        objective=total,
        lower_bound=None if answer.status == "infeasible" else float(_least_sum(answer.lower, upper)),
        horizon=None,
        reason=answer.reason,
        saving_alone=None if human_cost is None else 0.0,
        plan=steps,
        agent_costs={} if upper is None else _totals(task, upper),
        statistics={
            "elapsed_seconds": deadline.elapsed(),
            "expanded": answer.expanded,
            "bounds": {"lower": _texts(answer.lower), "upper": None if upper is None else _texts(upper)},
        },
        policy=answer.policy,
    )


def _least_sum(lower: Costs, upper: Costs | None) -> Fraction:
    """What the sum is at least, the human's cost coming first."""
    return sum(lower, Fraction(0)) if upper is not None and lower[0] == upper[0] else lower[0]


def _totals(task: Task, value: Costs) -> dict[str, float]:
    """The two totals, the human's first."""
    supporter = task.agents[task.robots[0]]
    return {task.agents[task.human]: float(value[0]), supporter: float(value[1])}


def _texts(value: Costs) -> list[str]:
    return [str(cost) for cost in value]


def _step(task: Task, step: Step) -> PlanStep:
    action = task.actions[step.action]
    agents = tuple(task.agents[i] for i in action.participants)
    return PlanStep(step.epoch, agents, action.name, float(action.cost))
