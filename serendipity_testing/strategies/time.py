"""Small tasks and calls with time: durations, scripts, bystanders, plans with waiting (semantics 10)."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate
from typing import Final

from hypothesis import assume
from hypothesis import strategies as st

from serendipity.model import (
    Condition,
    HumanPlan,
    Options,
    PlanError,
    Script,
    Task,
    TimedPlan,
)
from serendipity.model.keywords import Mode
from serendipity_testing.call import Call
from serendipity_testing.generator.in_time import random_script, with_durations
from serendipity_testing.oracle import human_plans
from serendipity_testing.strategies.tasks import DICE, corridor_tasks, errand_tasks, strips_tasks

_DURATIONS: Final = (1, 1, 2, 2, 3)
_MODES: Final[tuple[Mode, ...]] = ("serendipity", "serendipity", "individual", "communication", "composite")
_LAST_EPOCH: Final = 5
_LONGEST: Final = 7


@st.composite
def timed_tasks(draw: st.DrawFn, *, of: st.SearchStrategy[Task] | None = None) -> Task:
    """Tasks, or small ones, whose actions take one to three epochs, with effects at any time of theirs."""
    built = draw(small_tasks() if of is None else of)
    return with_durations(draw(DICE), built, _DURATIONS)


def scripts(built: Task, *, most: int = 3) -> st.SearchStrategy[Script]:
    """Facts of a task that become true or false in its first epochs."""
    return DICE.map(lambda dice: random_script(dice, built, _LAST_EPOCH, 0, most))


@st.composite
def scripted_tasks(draw: st.DrawFn, *, of: st.SearchStrategy[Task] | None = None) -> Task:
    """Tasks, or small ones, with a script of facts; actions may take several epochs."""
    built = draw(st.one_of(small_tasks(), timed_tasks()) if of is None else of)
    return built.with_script(draw(scripts(built)))


@st.composite
def bystander_tasks(draw: st.DrawFn) -> Task:
    """Tasks in which one or two of the robots are bystanders: one to three actions, and maybe a goal."""
    several = strips_tasks(facts=(3, 4), robots=(2, 3))
    built = draw(st.one_of(several, timed_tasks(of=several)))
    people = draw(
        st.lists(st.sampled_from(built.robots), min_size=1, max_size=len(built.robots) - 1, unique=True)
    )
    goals = {agent: draw(_literals(built)) for agent in people if draw(st.booleans())}
    built = replace(built, own_goals=tuple(sorted(goals.items())), known_variables=built.variables)
    plans = {built.agents[agent]: draw(_deeds(built, agent)) for agent in people}
    return built.with_script(Script(people=plans))


@st.composite
def _deeds(draw: st.DrawFn, built: Task, agent: int) -> list[tuple[int, str]]:
    """Actions of an agent's own at their times."""
    own = [action for action in built.actions if action.participants == (agent,)]
    assume(own)
    epoch, plan = 1, list[tuple[int, str]]()
    for action in draw(st.lists(st.sampled_from(own), min_size=1, max_size=3)):
        epoch += draw(st.integers(0, 2))
        plan.append((epoch, action.name))
        epoch += action.duration
    return plan


@st.composite
def _literals(draw: st.DrawFn, built: Task) -> Condition:
    """One or two literals of a task."""
    facts = draw(st.lists(st.integers(0, len(built.facts) - 1), min_size=1, max_size=2, unique=True))
    true = {fact: draw(st.booleans()) for fact in sorted(facts)}
    return Condition(
        tuple(fact for fact in true if true[fact]), tuple(fact for fact in true if not true[fact])
    )


def tasks_in_time() -> st.SearchStrategy[Task]:
    """Any small task with time in it."""
    return st.one_of(timed_tasks(), timed_tasks(), scripted_tasks(), bystander_tasks())


@st.composite
def timed_plans(draw: st.DrawFn, task: Task, plan: HumanPlan) -> HumanPlan:
    """A plan of the human's, now and then with waiting in it where that leaves it one."""
    if draw(st.booleans()):
        return plan
    gaps = [draw(st.sampled_from([0, 0, 1, 2])) for _ in plan]
    starts = [start + gap for start, gap in zip(task.starts_of(plan), accumulate(gaps), strict=True)]
    waiting = TimedPlan(plan, starts, task.epochs_of(plan) + sum(gaps))
    try:
        task.replay_alone(waiting)
    except PlanError:
        return plan
    return waiting if any(gaps) else plan


@st.composite
def calls_in_time(
    draw: st.DrawFn, *, modes: Sequence[Mode] = _MODES, of: st.SearchStrategy[Task] | None = None
) -> Call:
    """A task with time, or any, a mode and options legal for it, often with a plan that is given."""
    task = draw(tasks_in_time() if of is None else of)
    mode = draw(st.sampled_from(modes))
    options = Options(
        mode=mode,
        discount=draw(st.sampled_from(["0", "0.5", "0.9"])),
        window_weight=draw(st.sampled_from(["1000", "0", "0.25", "1"])),
        max_window=draw(st.sampled_from([None, None, 1, 2])),
        suffix=draw(st.sampled_from(["replan", "replan", "subplan"])),
        preservation=draw(st.sampled_from(["kernel", "kernel", "state"])),
        interference=draw(st.sampled_from(["paper", "paper", "strict"])),
        waiting_cost=draw(st.sampled_from(["0", "0", "1", "0.5"])),
        head_start=draw(st.sampled_from([0, 0, 1, 2])),
        keep_prefix=mode == "communication" and draw(st.integers(0, 3)) == 0,
    )
    plan = next(human_plans(task), None)
    if plan is None or task.epochs_of(plan) > _LONGEST:
        if mode == "individual" or plan is not None:
            return Call(task, options)
        if mode == "composite" and draw(st.booleans()):
            return Call(task, options.but(horizon="inf"))
        return Call(task, options.but(horizon=draw(st.integers(1, 4))))
    given = draw(timed_plans(task, plan)) if draw(st.integers(0, 2)) == 0 else None
    if mode != "individual" and not task.robot_goal.holds(task.init):
        known = task.epochs_of(plan if given is None else given) + options.head_start
        options = options.but(horizon=known + draw(st.integers(0, 1)))
    return Call(task, options, given)


def small_tasks() -> st.SearchStrategy[Task]:
    """Tasks of one epoch each that stay small in time."""
    return st.one_of(strips_tasks(facts=(3, 4), robots=(1, 1)), corridor_tasks(), errand_tasks())
