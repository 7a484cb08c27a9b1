"""Claims of a planner, and faults in them.

Most planners of other people know neither help nor epochs.  What they can be asked is the best joint plan,
one action after another: ``composite`` with ``horizon="inf"`` and strict interference.  Those that know
help, too, say in which epoch each action is, and which window there is (``in_mode``).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from serendipity.model import Deadline, Task
from serendipity.model.numbers import exact, total
from serendipity.model.task.actions import apply
from serendipity_testing.call import Answered
from serendipity_testing.generator.calls import PlanCall

TIME_LIMIT: Final = "time limit"
"""The words of a claim to which a limit came first."""

_KEPT: Final = ("discount",)
"""Options of a random call that the joint question has, too."""

_UNASKED: Final = ("ties", "human_model", "no_block")
"""Options of a random call that nobody is asked about: the human's plan is given, and followed."""


@dataclass(frozen=True, slots=True)
class Proposal:
    """A planner's answer.

    Attributes:
        status: ``optimal``, ``feasible`` (a plan, perhaps not the best), ``infeasible``, or ``unknown``.
        plan: ids of actions in their order; None without a plan.
        words: of the planner's own, where there is neither a plan nor a proof.
        epochs: of each of these actions, where it knows epochs; None: one after another.
        window: ``(xi1, xi2)``, where it says that there is one.
    """

    status: str
    plan: tuple[int, ...] | None = None
    words: str = ""
    epochs: tuple[int, ...] | None = None
    window: tuple[int, int] | None = None


@dataclass(frozen=True, slots=True)
class OutsideJudge:
    """A planner of somebody else.

    Attributes:
        name: as the user gave it.
        answer: its claim about a call; what it raises is a disagreement.
        unit_costs: whether all that it counts is actions.
        every_mode: whether it knows help and epochs; else it is asked for joint plans.
    """

    name: str
    answer: Callable[[PlanCall, Deadline], Proposal]
    unit_costs: bool = False
    every_mode: bool = False

    def fitted(self, call: PlanCall) -> PlanCall:
        """The call as this planner can be asked it, or the joint question about its task."""
        if self.every_mode:
            asked = {name: value for name, value in call.options.items() if name not in _UNASKED}
            return replace(call, options=asked)
        options = {name: value for name, value in call.options.items() if name in _KEPT}
        options.update(mode="composite", horizon="inf", interference="strict")
        task = call.task
        if self.unit_costs:
            options["discount"] = "0"
            actions = tuple(replace(action, cost=Fraction(1)) for action in task.actions)
            task = replace(task, actions=actions, known_variables=task.variables)
        return replace(call, task=task, options=options, human_plan=None)


def fault_of_joint(call: PlanCall, claim: Proposal, result: Answered | None) -> str | None:
    """The fault in a claim about the joint question, or None.

    Args:
        result: a proved answer of another judge, or None.
    """
    known = result.cost if result is not None and result.status == "optimal" else None
    if claim.plan is None:
        if claim.status == "infeasible" and known is not None:
            return f"there is a plan of cost {known:g}"
        return None
    if claim.status not in ("optimal", "feasible"):
        return f"{claim.status}, with a plan"
    broken = _broken(call.task, claim.plan)
    if broken is not None:
        return broken
    if result is not None and result.status == "infeasible":
        return "its plan is one, where none was said to be"
    cost = float(cost_of(call, claim.plan))  # as results have it
    known = None if known is None else float(known)
    if known is not None and (cost < known or (claim.status == "optimal" and cost > known)):
        return f"its plan costs {cost:g}, where {known:g} is the least"
    return None


def said(call: PlanCall, claim: Proposal) -> str:
    """A claim in words."""
    words = (
        claim.status if claim.plan is None else f"{claim.status}, cost {float(cost_of(call, claim.plan)):g}"
    )
    if claim.window is not None:
        words += f", window [{claim.window[0]}, {claim.window[1]})"
    return f"{words} ({claim.words})" if claim.words else words


def cost_of(call: PlanCall, plan: tuple[int, ...]) -> Fraction:
    """The cost of a plan to the team."""
    discount = exact(call.options.get("discount", "0"), "discount")
    return total(call.task.team_cost(call.task.actions[i], discount) for i in plan)


def plan_of(task: Task, names: list[str]) -> tuple[int, ...]:
    """The actions that a list of names means: of one name the first that is applicable there.

    Raises:
        ValueError: there is no action of a name.
    """
    plan: list[int] = []
    state = task.init
    for name in names:
        plan.append(action_of(task, name, state))
        state = apply(state, task.actions[plan[-1]])
    return tuple(plan)


def action_of(task: Task, name: str, state: frozenset[int]) -> int:
    """The action that a name means in a state: the first that is applicable, else the first.

    Raises:
        ValueError: there is none.
    """
    ids = task.named.get(" ".join(name.lower().split()), ())
    if not ids:
        raise ValueError(f"there is no action '{name}'")
    return next((i for i in ids if task.actions[i].applicable(state)), ids[0])


def _broken(task: Task, plan: tuple[int, ...]) -> str | None:
    """The fault in a sequence that is no plan, or None."""
    state = task.init
    for step, i in enumerate(plan, start=1):
        action = task.actions[i]
        if not action.applicable(state):
            return f"step {step} of its plan, '{action.name}', is not applicable"
        state = apply(state, action)
    if not (task.goal.holds(state) and task.robot_goal.holds(state)):
        return "its plan misses a goal"
    return None
