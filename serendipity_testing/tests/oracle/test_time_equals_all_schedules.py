"""Brute force with time against something plainer still: every schedule, played by the model."""

from collections.abc import Iterator
from fractions import Fraction
from itertools import combinations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from serendipity.model import HumanPlan, Options, Task, UsageError
from serendipity.model.task.course import BrokenPlanError, PlayedPlan
from serendipity_testing.oracle import best, human_plans
from serendipity_testing.strategies import scripted_tasks, strips_tasks, timed_tasks

LAST = 3

Schedule = tuple[tuple[int, ...], ...]
"""What begins in each epoch."""


def tiny_tasks() -> st.SearchStrategy[Task]:
    """Tasks of one robot, with durations, a script, or both."""
    few = strips_tasks(facts=(3, 3), robots=(1, 1))
    return st.one_of(timed_tasks(of=few), scripted_tasks(of=few), scripted_tasks(of=timed_tasks(of=few)))


def played(task: Task, schedule: Schedule, strict: bool) -> PlayedPlan | None:
    """The course of a schedule, or None where it can't be."""
    course = PlayedPlan(task.facts, task.init, task.script, strict=strict)
    try:
        for begun in schedule:
            course.begin([task.actions[i] for i in begun])
    except BrokenPlanError:
        return None
    return course


def schedules(task: Task, epochs: int, strict: bool, schedule: Schedule = ()) -> Iterator[Schedule]:
    """Every schedule of so many epochs at whose end nothing is under way."""
    if len(schedule) == epochs:
        course = played(task, schedule, strict)
        if course is not None and not [*course.under_way()]:
            yield schedule
        return
    for size in range(len(task.agents) + 1):
        for begun in combinations(range(len(task.actions)), size):
            more = (*schedule, begun)
            if played(task, more, strict) is not None:
                yield from schedules(task, epochs, strict, more)


def cost(task: Task, schedule: Schedule, options: Options) -> Fraction:
    """What a schedule costs the team, waiting included."""
    busy, last = set[int](), 0
    spent = Fraction(0)
    for epoch, begun in enumerate(schedule, start=1):
        for action in map(task.actions.__getitem__, begun):
            spent += task.team_cost(action, options.discount)
            if task.human in action.participants:
                busy |= {*range(epoch, epoch + action.duration)}
                last = epoch
    return spent + options.waiting_cost * sum(epoch not in busy for epoch in range(1, last))


def reaches(task: Task, schedule: Schedule, strict: bool) -> bool:
    course = played(task, schedule, strict)
    assert course is not None, "it was played before"
    return task.goal.holds(course.state) and task.robot_goal.holds(course.state)


def windows(task: Task, schedule: Schedule, plan: HumanPlan, epochs: int) -> Iterator[tuple[int, int]]:
    """The windows that a schedule fits, the human's suffix being a part of their plan (semantics 10.1)."""
    begins = dict(zip(task.starts_of(plan), plan, strict=True))
    his = [tuple(i for i in begun if task.human in task.actions[i].participants) for begun in schedule]
    ends = [
        epoch + task.actions[i].duration - 1
        for epoch, begun in enumerate(schedule, start=1)
        for i in begun
        if set(task.robots).intersection(task.actions[i].participants)
    ]
    for start in range(1, task.epochs_of(plan) + 1):
        before = range(1, start)
        if any(his[epoch - 1] != tuple(i for e, i in begins.items() if e == epoch) for epoch in before):
            continue
        for end in range(start + 1, epochs + 2):
            rest = [i for begun in his[end - 1 :] for i in begun]
            left = iter(plan)
            if max(ends, default=0) < end and all(i in left for i in rest):
                yield start, end


@pytest.mark.long
@settings(max_examples=30, deadline=None)
@given(tiny_tasks(), st.sampled_from(["0", "1"]), st.booleans())
def test_the_joint_optimum_is_that_of_the_cheapest_schedule(task: Task, waiting: str, strict: bool) -> None:
    options = Options(
        mode="composite",
        discount="0.5",
        horizon=LAST,
        waiting_cost=waiting,
        interference="strict" if strict else "paper",
    )
    try:
        answer = best(task, options)
    except UsageError:  # the human's own plan is longer, or does not last so long
        return
    costs = [cost(task, one, options) for one in schedules(task, LAST, strict) if reaches(task, one, strict)]
    assert answer.cost == min(costs, default=None)


@settings(max_examples=40, deadline=None)
@given(tiny_tasks(), st.sampled_from(["0", "0.25", "1000"]))
def test_the_best_window_is_that_of_the_best_schedule(task: Task, weight: str) -> None:
    plan = next(human_plans(task), None)
    if plan is None or not 0 < task.epochs_of(plan) <= LAST or task.robot_goal:
        return
    epochs = task.epochs_of(plan)
    options = Options(discount="0.5", suffix="subplan", window_weight=weight)
    alone = task.cost_of(plan)
    found = [(alone + options.window_weight, alone)]
    together = [alone]
    for schedule in schedules(task, epochs, strict=False):
        if reaches(task, schedule, strict=False):
            spent = cost(task, schedule, options)
            together.append(spent)
            for start, end in windows(task, schedule, plan, epochs):
                found.append((spent + options.window_weight * (end - start), spent))
    objective, least = min(found)
    answer = best(task, options)
    assert answer.opportunity is (least < alone)
    assert answer.cost == (least if answer.opportunity else alone)
    assert answer.objective == (objective if answer.opportunity else alone)
    assert best(task, options.but(mode="composite")).cost == min(together)
