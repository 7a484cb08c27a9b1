"""Planning calls: a task, options that are legal for it, and now and then a plan that is given."""

from dataclasses import fields, replace
from itertools import islice
from typing import Final

from hypothesis import strategies as st

from serendipity.facade.planning import plan as plan_of
from serendipity.model import HumanPlan, Options, Result, Task
from serendipity.model.keywords import Horizon, Mode
from serendipity.testing.call import Call
from serendipity.testing.oracle import Alone, human_plans, optimal_human_plan
from serendipity.testing.oracle.epochs import after
from serendipity.testing.strategies.tasks import tasks

MODES: Final[tuple[Mode, ...]] = ("serendipity", "individual", "communication", "composite")
_DISCOUNTS: Final = ("0", "0.25", "0.5", "0.6", "0.9", "1")
_WEIGHTS: Final = ("1000", "1000", "0", "0", "0.25", "0.75", "1", "2")
_LONGEST_PLAN: Final = 8
_MOST_TIES: Final = 6
_TIES: Final = ("fixed", "fixed", "optimistic", "robust", "expected")


@st.composite
def calls(
    draw: st.DrawFn,
    *,
    modes: tuple[Mode, ...] = MODES,
    ties: bool = True,
    of: st.SearchStrategy[Task] | None = None,
) -> Call:
    """A task, a mode and every option that semantics 3 gives it, often with a given human plan.

    Args:
        modes: drawn from.
        ties: whether ``ties`` other than ``fixed`` are drawn.
        of: tasks, or None for any.
    """
    task = draw(tasks() if of is None else of)
    mode = draw(st.sampled_from(modes))
    tied = list(islice(human_plans(task), _MOST_TIES + 1))
    plan = tied[0] if tied else None
    given: HumanPlan | None = None
    if plan is not None and mode != "individual" and draw(st.integers(0, 3)) == 0:
        given = plan = draw(_other_plans(task, plan))
    open_goal = not task.robot_goal.holds(task.init)
    chosen = draw(_options(mode, None if plan is None else len(plan), open_goal=open_goal))
    if ties and given is None and 1 < len(tied) <= _MOST_TIES:
        chosen = chosen.but(
            ties=draw(st.sampled_from(["fixed", "fixed", "optimistic", "robust", "expected"]))
        )
    return Call(task, chosen, given)


@st.composite
def options(draw: st.DrawFn, task: Task, *, modes: tuple[Mode, ...] = MODES) -> Options:
    """Options that are legal for a task, its human plan being predicted.

    Args:
        task: the task.
        modes: drawn from.
    """
    plan = optimal_human_plan(task)
    open_goal = not task.robot_goal.holds(task.init)
    mode = draw(st.sampled_from(modes))
    return draw(_options(mode, None if plan is None else len(plan), open_goal=open_goal))


@st.composite
def plans(draw: st.DrawFn, task: Task) -> HumanPlan | None:
    """A plan of the human alone, optimal or with a detour; None where there is none."""
    plan = optimal_human_plan(task)
    return None if plan is None else draw(_other_plans(task, plan))


@st.composite
def results(draw: st.DrawFn, *, of: st.SearchStrategy[Call] | None = None) -> tuple[Task, Result]:
    """A task with the planner's answer to a call about it.

    Args:
        of: calls, or None for any.
    """
    call = draw(calls() if of is None else of)
    given = {field.name: getattr(call.options, field.name) for field in fields(Options)}
    return call.task, plan_of(call.task, human_plan=call.human_plan_names, **given)


@st.composite
def _options(draw: st.DrawFn, mode: Mode, length: int | None, *, open_goal: bool) -> Options:
    keep_prefix = mode == "communication" and length is not None and draw(st.integers(0, 2)) == 0
    numbers = [str(n / 2) for n in range(17)]
    limits = [None] * 6 + ["human", draw(st.sampled_from(numbers))]
    weight = draw(st.sampled_from(["0", "0", "0.25", "1", "2"])) if mode == "communication" else "0"
    return Options(
        mode=mode,
        discount=draw(st.sampled_from(_DISCOUNTS)),
        horizon=draw(_horizons(mode, length, open_goal=open_goal)),
        window_weight=draw(st.sampled_from(_WEIGHTS)),
        max_window=draw(st.sampled_from([None, None, None, 1, 2, 3])),
        suffix=draw(st.sampled_from(["replan", "replan", "subplan"])),
        preservation=draw(st.sampled_from(["kernel", "kernel", "kernel", "state"])),
        interference=draw(st.sampled_from(["paper", "paper", "strict"])),
        max_cost=draw(st.sampled_from(limits)),
        communication_weight=weight,
        keep_prefix=keep_prefix,
    )


@st.composite
def _horizons(draw: st.DrawFn, mode: str, length: int | None, *, open_goal: bool) -> Horizon | None:
    """Never shorter than the human's plan; given where a call without it is an error."""
    if mode == "individual":
        return None
    if length is None:
        return (
            draw(st.integers(1, 4)) if mode != "composite" else draw(st.sampled_from([None, "inf", 1, 2, 3]))
        )
    longer = [length, length + 1, length + 2]
    if open_goal and length == 0:
        return draw(st.sampled_from(longer))
    return draw(st.sampled_from([None, None, *longer, *(["inf"] if mode == "composite" else [])]))


@st.composite
def _other_plans(draw: st.DrawFn, task: Task, plan: HumanPlan) -> HumanPlan:
    """A plan of the human alone: ``plan``, or one with a detour of at least one action."""
    if draw(st.integers(0, 2)) == 0:
        return plan
    alone = Alone(task)
    cut = draw(st.integers(0, len(plan)))
    state = task.init
    for i in plan[:cut]:
        state = after(state, [task.actions[i]])
    ways = list(alone.successors(state))
    if not ways:
        return plan
    i, state = draw(st.sampled_from(ways))
    if alone.worth(state) is None:
        return plan
    rest = next(human_plans(replace(task, init=state)))
    detour = (*plan[:cut], i, *rest)
    return detour if len(detour) <= _LONGEST_PLAN else plan
