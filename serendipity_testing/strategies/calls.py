"""Planning calls: a task, options that are legal for it, and now and then a plan that is given."""

from dataclasses import fields
from itertools import islice
from typing import Any, Final

from hypothesis import strategies as st

from serendipity.facade.call import options_from
from serendipity.facade.planning import plan as plan_of
from serendipity.model import HumanPlan, Options, Result, Task
from serendipity.model.keywords import Horizon, Mode
from serendipity_testing.asking import call_of
from serendipity_testing.call import Call
from serendipity_testing.generator.among_people import MOST_PEOPLE, random_call_among
from serendipity_testing.generator.calls import random_options
from serendipity_testing.generator.human_plans import plan_after_detour
from serendipity_testing.oracle import human_plans, optimal_human_plan
from serendipity_testing.strategies.tasks import DICE, tasks

MODES: Final[tuple[Mode, ...]] = ("serendipity", "individual", "communication", "composite")
_TAKEN: Final = {
    *("mode", "discount", "window_weight", "max_window", "suffix", "preservation", "interference"),
    *("max_cost", "communication_weight"),
}
"""Of the generator's options."""
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
        chosen = chosen.but(ties=draw(st.sampled_from(_TIES)))
    return Call(task, chosen, given)


@st.composite
def calls_among_people(draw: st.DrawFn, *, people: tuple[int, int] = (1, MOST_PEOPLE)) -> Call:
    """A call under rules of help: that nobody pays, or little is left changed, or disturbs, and more.

    Args:
        people: how many, from and to, with the human; the others are bystanders. A seed decides the rest.
    """
    number = draw(st.integers(*people))
    return call_of(random_call_among(number, draw(st.integers(0, 10**9))))


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
    chosen = random_options(draw(DICE), mode)
    found: dict[str, Any] = {name: chosen[name] for name in chosen.keys() & _TAKEN}
    if length is not None and "keep_prefix" in chosen:
        found["keep_prefix"] = True
    return options_from({**found, "horizon": draw(_horizons(mode, length, open_goal=open_goal))})


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


def _other_plans(task: Task, plan: HumanPlan) -> st.SearchStrategy[HumanPlan]:
    """Plans of the human alone: ``plan``, and others that begin with a detour of up to three actions."""
    return st.one_of(st.just(plan), DICE.map(lambda dice: plan_after_detour(dice, task) or plan))
