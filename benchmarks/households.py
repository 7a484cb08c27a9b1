"""Households with habits: how much of somebody's work a robot saves that has watched them for a while.

    python -m benchmarks.households [--households N] [--learnt DAYS] [--helped DAYS] [--most PLANS]

Ann has five activities: she makes her bed, has breakfast and coffee, does the laundry and waters the plants,
each where it belongs and with a thing that is kept elsewhere.  How likely each is depends on whether it is a
weekday; sometimes she starts with a stroll.  A robot has seen some weeks of that (``serendipity learn``) and
helps on days that it has not seen; what it does is decided before the day begins.

The table has in the mean per day: her actions that are saved, if she only sees what was moved (``looking``),
or is told of the robot's plan (``knowing``); what was promised, over scenarios in their mean; and what the
decision's lower bound says can be saved at most.
"""

import os
import tempfile
import time
from collections.abc import Callable, Iterable, Sequence
from datetime import date, timedelta
from functools import partial
from pathlib import Path
from random import Random
from statistics import fmean
from typing import Final, NamedTuple

import serendipity
from benchmarks.problems import run
from serendipity.evaluation.measuring.tables import as_markdown, table
from serendipity.execution import Habits, learn
from serendipity.model import Condition, PlanStep, Result, Script, Task
from serendipity.model.task.actions import apply
from serendipity.model.task.facts import Facts
from serendipity_testing.builders import Builder

_ROOMS: Final = ("bed", "bath", "kitchen", "balcony", "store")
_PLACES: Final = (*_ROOMS, "hall")


class Activity(NamedTuple):
    """Something that Ann does: where, with what, and how likely on weekdays and at weekends."""

    name: str
    place: str
    thing: str
    weekday: float
    weekend: float


ACTIVITIES: Final = (
    Activity("make_bed", "bed", "sheets", 0.5, 0.9),
    Activity("breakfast", "kitchen", "bowl", 0.9, 0.6),
    Activity("coffee", "kitchen", "cup", 0.8, 0.9),
    Activity("laundry", "bath", "basket", 0.1, 0.8),
    Activity("plants", "balcony", "can", 0.2, 0.6),
)
_STROLL: Final = ("walk ann bed hall", "walk ann hall bed")
_MONDAY: Final = date(2026, 1, 5)


class Day(NamedTuple):
    """A day of Ann's: what she does, by which plan, whether she strolls, and on what kind of day."""

    activities: tuple[str, ...]
    plan: tuple[str, ...]
    stroll: bool
    kind: str


def household(seed: int, days: int) -> tuple[Task, list[Day]]:
    """A home whose things lie about, without a goal, and days of somebody with habits near the usual ones."""
    dice, task = Random(f"household {seed}"), _home(seed)
    chances = {a.name: [min(x + dice.uniform(-0.1, 0.1), 0.95) for x in a[3:]] for a in ACTIVITIES}
    best, found = dict[tuple[str, ...], list[str]](), list[Day]()
    for day in range(days):
        weekend = (_MONDAY + timedelta(day)).weekday() >= 5
        names = tuple(name for name, chance in chances.items() if dice.random() < chance[weekend])
        if names not in best:
            best[names] = _way(task, task.init, _done(task, names))
        kind = "weekend" if weekend else "weekday"
        found.append(Day(names, tuple(best[names]), dice.random() < 0.2, kind))
    return task, found


def _home(seed: int) -> Task:
    dice, built = Random(f"home {seed}"), Builder(("ann", "robot"), f"household-{seed}")
    kept = {a: (dice.choice([p for p in _PLACES if p != a.place]), a.place) for a in ACTIVITIES}
    for who, name in enumerate(built.agents):
        for here, there in (way for room in _ROOMS for way in ((room, "hall"), ("hall", room))):
            effects = f"at_{name}_{there} !at_{name}_{here}"
            built.named(f"walk {name} {here} {there}", (who,), f"at_{name}_{here}", effects)
        for activity, places in kept.items():
            for place in places:
                thing = activity.thing
                free, there, held = f"free_{name}", f"{thing}_{place}", f"{name}_has_{thing}"
                take, put = f"take {name} {thing} {place}", f"put {name} {thing} {place}"
                built.named(take, (who,), f"at_{name}_{place} {free} {there}", f"{held} !{free} !{there}")
                built.named(put, (who,), f"at_{name}_{place} {held}", f"!{held} {free} {there}")
    for name, place, thing, *_ in ACTIVITIES:
        built.named(f"{name} ann", (0,), f"at_ann_{place} {thing}_{place} free_ann", f"done_{name}")
    things = " ".join(f"{activity.thing}_{place}" for activity, (place, _) in kept.items())
    return built.task(f"at_ann_bed at_robot_store free_ann free_robot {things}", "")


def log(days: Iterable[Day], seed: int) -> str:
    """The days as CSV."""
    dice, rows = Random(f"clock {seed}"), ["day,time,actor,action"]
    for number, day in enumerate(days):
        for minute, action in enumerate((*_STROLL * day.stroll, *day.plan), start=dice.randint(390, 480)):
            rows.append(f"{_MONDAY + timedelta(number)},{minute // 60:02}:{minute % 60:02},ann,{action}")
    return "".join(f"{row}\n" for row in rows)


class Decision(NamedTuple):
    """What the robot does, by epoch, and what comes of it: saved as is promised, and at most."""

    steps: dict[int, str]
    promised: float | None = None
    most: float | None = None


Policy = Callable[[Day], Decision]


def by_frequency(task: Task, habits: Habits) -> Decision:
    """Things are brought to where they are needed, the most frequent first, if more often than not."""
    state, steps, robot = task.init, list[str](), task.with_human("robot")
    often = {
        each: sum(plan.probability for plan in habits.plans if f"{each.name} ann" in plan.plan)
        for each in ACTIVITIES
    }
    for activity, share in sorted(often.items(), key=lambda one: -one[1]):
        if share > 0.5:
            wanted = Facts(robot.facts).condition([f"{activity.thing}_{activity.place}", "free_robot"])
            for action in _way(robot, state, wanted):
                steps.append(action)
                state = apply(state, robot.actions[robot.named[action][0]])
    return Decision(dict(enumerate(steps, start=1)))


def over_scenarios(task: Task, habits: Habits, most: int, seconds: float) -> Policy:
    """Help for the likeliest plans, on a day that for the one that begins most like hers."""
    likely = habits.plans[:most]
    plans = [plan.to_dict() for plan in likely]
    result = serendipity.plan(task, discount=1, time_limit=seconds, plans=plans, window_weight=0)
    alone = sum(p.probability * len(p.plan) for p in likely) / sum(p.probability for p in likely)
    told = {goal.name: goal.plan or () for goal in result.goals or ()}

    def decided(day: Day) -> Decision:
        done = (*_STROLL * day.stroll, *day.plan)
        alike = max(likely, key=lambda one: len(os.path.commonprefix([one.plan, done])))  # noqa: RUF071
        return _decided(result, told.get(alike.name, ()), alone)

    return decided


def knowing(task: Task, day: Day, seconds: float) -> Decision:
    """Help for what Ann does on that very day."""
    aimed = task.with_goal(_done(task, day.activities))
    result = serendipity.plan(aimed, human_plan=day.plan, discount=1, window_weight=0, time_limit=seconds)
    return _decided(result, result.plan or (), len(day.plan))


def paid_knowing(task: Task, day: Day, decision: Decision) -> int:
    """How many actions the day takes Ann, if she is told what the robot does when."""
    script = Script(people={"robot": tuple(sorted(decision.steps.items()))})
    beside = task.with_goal(_done(task, day.activities)).with_script(script)
    return len(serendipity.plan(beside, mode="individual").human_plan or day.plan)


def paid_looking(task: Task, day: Day, decision: Decision) -> int:
    """How many actions the day takes Ann, if she plans anew where she sees that something was moved."""
    state, plan = task.init, [*day.plan]
    goal, epoch, count = _done(task, day.activities), 0, 0
    by_name = {action.name: action for action in task.actions}
    hers = {i for i, fact in enumerate(task.facts) if "robot" not in fact}
    while not goal.holds(state):
        epoch += 1
        if plan and by_name[plan[0]].applicable(state):
            state = apply(state, by_name[plan.pop(0)])
            count += 1
        others = by_name.get(decision.steps.get(epoch, ""))
        if others is not None and others.applicable(state):
            moved = apply(state, others)
            if hers & (state ^ moved):  # she plans anew, if what she needs is not being carried
                plan = _way(task, moved, goal) or plan
            state = moved
    return count


def _decided(result: Result, plan: Iterable[PlanStep], alone: float) -> Decision:
    steps = {step.epoch: step.action for step in plan if step.agents == ("robot",)}
    saved = (None if cost is None else alone - cost for cost in (result.cost, result.lower_bound))
    return Decision(steps, *saved)


def _way(task: Task, state: frozenset[int], goal: Condition) -> list[str]:
    """The actions of the best way from a state to a goal; empty where there is none now."""
    return [*(serendipity.plan(task.at(state).with_goal(goal), mode="individual").human_plan or ())]


def _done(task: Task, activities: Iterable[str]) -> Condition:
    return Facts(task.facts).condition(f"done_{name}" for name in activities)


def main(
    households: int = 3, learnt: int = 60, helped: int = 10, most: int = 2, time_limit: float = 10
) -> None:
    """Print a table for each household, a line for each policy."""
    for seed in range(households):
        task, days = household(seed, learnt + helped)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "days.csv"
            file.write_text(log(days[:learnt], seed))
            habits = {on: learn(task, file, on=on) for on in ("weekday", "weekend")}
        lines = {}
        for name in ("does nothing", "frequencies", "scenarios", "knows the day"):
            began = time.process_time()
            policies = {on: _policy(name, task, known, most, time_limit) for on, known in habits.items()}
            made = [(day, policies[day.kind](day)) for day in days[learnt:]]
            took = (time.process_time() - began) / helped
            lines[str(seed), name] = [(*_figures(task, day, one), took) for day, one in made]
        print(as_markdown([table(("household", "robot"), lines, COLUMNS)]), flush=True)


def _policy(name: str, task: Task, habits: Habits, most: int, seconds: float) -> Policy:
    if name == "scenarios":
        return over_scenarios(task, habits, most, seconds)
    if name == "knows the day":
        return lambda day: knowing(task, day, seconds)
    decision = by_frequency(task, habits) if name == "frequencies" else Decision({})
    return lambda _: decision


def _figures(task: Task, day: Day, one: Decision) -> tuple[float | None, ...]:
    """What is saved, promised, and can be saved at most."""
    paid = (pays(task, day, one) for pays in (paid_looking, paid_knowing))
    return (*(len(day.plan) - each for each in paid), one.promised, one.most)


def _mean(of: Sequence[tuple[float | None, ...]], figure: int) -> str:
    found = [each for row in of if (each := row[figure]) is not None]
    return f"{fmean(found):.2f}" if len(found) == len(of) else "-"


COLUMNS: Final = {
    head: partial(_mean, figure=i)
    for i, head in enumerate(("looking", "knowing", "promised", "at most", "seconds"))
}


if __name__ == "__main__":
    run(main, __doc__)
