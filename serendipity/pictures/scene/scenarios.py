"""One scenario of an answer over several (semantics 11), as a scene plays it."""

from dataclasses import replace

from serendipity.model import Result, Task, UsageError
from serendipity.model.answers.histories import History, histories
from serendipity.model.answers.over_scenarios import goal_of
from serendipity.model.task.facts import Facts


def find_scenario(result: Result, name: str | None) -> int | None:
    """The place in a result of a scenario by name or number, by default the most probable one's."""
    entries = result.goals or ()
    found = [i for i, entry in enumerate(entries) if name in (None, entry.name, str(i + 1))]
    if name is not None and not found:
        known = ", ".join(entry.name or str(i) for i, entry in enumerate(entries, start=1))
        expected = f"one of {known}" if known else "none, for the result is about no scenarios"
        raise UsageError(f"scenario: expected {expected}; got '{name!s:.50}'")
    return max(found, key=lambda i: (entries[i].name == name, entries[i].probability), default=None)


def played(task: Task, result: Result, scenario: int) -> tuple[Task, Result]:
    """The task with the goal of a scenario, and the result with what happens in it; its figures stay."""
    entry = (result.goals or ())[scenario]
    goal = goal_of(result, entry)
    own = replace(result, plan=entry.plan, human_plan=entry.human_plan, window=entry.window)
    there = task if goal is None else task.with_goal(Facts(task.facts).condition(goal))
    return there, replace(own, human_plan_times=entry.human_plan_times)


def find_histories(result: Result, last: int) -> tuple[History, ...]:
    """The histories of a result over several scenarios up to an epoch, each before its branches."""
    goals, watching = result.goals or (), result.options.policy == "watching"
    return tuple(histories(goals, result.human, last, watching=watching)) if len(goals) > 1 else ()
