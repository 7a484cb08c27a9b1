"""Seeded random calls in time: actions that take a while, facts that change by themselves (semantics 10)."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from random import Random
from typing import Final

from serendipity.model import Condition, GroundAction, Script, Task, Timing
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.generator.human_plans import with_times
from serendipity_testing.generator.tasks import corridor, errands, random_task, varied
from serendipity_testing.oracle import optimal_human_plan

_DURATIONS: Final = (1, 1, 1, 2, 2, 3)
_LAST_EPOCH: Final = 6
_LONGEST: Final = 8
"""Epochs of the human's plan: to prove what is best beside a longer one may take a minute."""

_LONGEST_LOCAL: Final = 6
"""The same of who sees what is where they are: what they believe makes for many more moments."""

_BYSTANDERS, _OBSERVANT = 0.3, 0.25
"""Shares of tasks with a bystander, among those with several robots, and of calls about who replans."""

_MODES: Final = ("serendipity", "serendipity", "communication", "composite", "individual")
_CHOICES: Final[dict[str, tuple[str, ...]]] = {
    "discount": ("0", "0.5", "0.9", "1"),
    "window_weight": ("1000", "0", "0.25", "1"),
    "max_window": ("", "", "1", "2"),
    "suffix": ("", "", "subplan"),
    "interference": ("", "", "strict"),
    "waiting_cost": ("", "", "1", "0.5"),
    "head_start": ("", "", "1", "2"),
}


def random_call_in_time(seed: int) -> PlanCall:
    """A small random task in time with random options; equal seeds give equal calls."""
    dice, others = Random(f"in time {seed}"), Random(f"others in time {seed}")
    while True:
        task = _in_time(dice, replace(random_task(dice), robot_goal=Condition()))
        if others.random() < _BYSTANDERS:
            task = _with_bystander(others, task)
        plan = optimal_human_plan(task)
        if plan is None or task.epochs_of(plan) <= _LONGEST:
            break
    options = {"mode": dice.choice(_MODES)}
    options |= {name: value for name, values in _CHOICES.items() if (value := dice.choice(values))}
    if task.script.people:
        options["nobody_pays"] = "false"  # the rule is no part of what all methods know
    if plan is None and options["mode"] in ("communication", "composite"):
        options["horizon"] = dice.choice(("3", "4", "5"))
    given = None
    if plan is not None and dice.random() < 0.25:
        given = with_times(task, plan, dice.choice((0, 0, 1, 2)), strict="interference" in options)
    if options["mode"] == "serendipity" and others.random() < _OBSERVANT:
        options |= {"human_model": "observant", "no_block": others.choice(("true", "true", "false"))}
    return PlanCall(task, options, given, seed)


def random_local_call(seed: int) -> PlanCall:
    """A small random call in time about who sees what is where they are; equal seeds give equal calls."""
    dice = Random(f"local in time {seed}")
    while True:
        plain = varied(dice, dice.choice((corridor, corridor, errands))(dice), robots_want=0)
        task = _in_time(dice, sighted(dice, plain))
        if dice.random() < _BYSTANDERS:
            task = _with_bystander(dice, task)
        plan = optimal_human_plan(task)
        if task.needs_time and (plan is None or task.epochs_of(plan) <= _LONGEST_LOCAL):
            break
    options = {
        "mode": "serendipity",
        "human_model": "local",
        "no_block": dice.choice(("true", "true", "false")),
    }
    for name in ("discount", "interference", "head_start", "waiting_cost"):
        if value := dice.choice(_CHOICES[name]):
            options[name] = value
    if task.script.people:
        options["nobody_pays"] = "false"
    return PlanCall(task, options, None, seed)


def sighted(dice: Random, task: Task) -> Task:
    """The task with places: facts that are about where the human is, robots about, or something there."""
    places = [f"p{i}" for i in range(sum(fact.startswith("at") for fact in task.facts) or 2)]
    human, robots = task.agents[task.human], [task.agents[i] for i in task.robots]

    def named(fact: str) -> str:
        who = next((name for name in (human, *robots) if fact.startswith(name)), None)
        if fact.startswith("at"):
            return f"at {human} p{fact[2:]}"
        if who is not None and fact[len(who) :].isdecimal():
            return f"at {who} p{fact[len(who) :]}"
        return f"{fact} {dice.choice((*places, *robots, human))}"

    facts = [named(fact) for fact in task.facts]
    still = [f"at {robot} {place}" for robot in robots for place in places]
    still = [fact for fact in still if not any(f.startswith(fact.rpartition(" ")[0]) for f in facts)]
    ids = {fact: len(facts) + i for i, fact in enumerate(still)}
    actions, init = [*task.actions], set(task.init)
    for agent, robot in zip(task.robots, robots, strict=True):
        own = [ids[fact] for fact in still if fact.startswith(f"at {robot} ")]
        if own:
            init.add(dice.choice(own))
            cost = dice.choice((Fraction(0), Fraction(1)))
            actions += [
                GroundAction(f"go {robot} {i} {j}", (agent,), (a,), (), (b,), (a,), cost)
                for i, a in enumerate(own)
                for j, b in enumerate(own)
                if abs(i - j) == 1
            ]
            actions = [
                replace(one, pre=tuple(sorted({*one.pre, dice.choice(own)})))
                if one.participants == (agent,) and not one.name.startswith("go ") and dice.random() < 0.5
                else one
                for one in actions
            ]
    every = tuple(sorted(actions, key=lambda action: action.key))
    return replace(task, facts=(*facts, *still), init=frozenset(init), actions=every)


def _in_time(dice: Random, task: Task) -> Task:
    """The task with durations, or a script, or both."""
    if (share := dice.random()) < 0.8:
        task = with_durations(dice, task, _DURATIONS)
    return task.with_script(random_script(dice, task, _LAST_EPOCH)) if share > 0.5 else task


def with_durations(dice: Random, task: Task, durations: Sequence[int]) -> Task:
    """The task with actions of some durations, conditions and effects at any time of theirs.

    Which variant of one action is meant is known when it begins: they stay as they are.
    """
    times = Counter((action.name, action.participants) for action in task.actions)
    actions = (
        one if times[one.name, one.participants] > 1 else _longer(dice, one, dice.choice(durations))
        for one in task.actions
    )
    return replace(task, actions=tuple(actions))


def random_script(dice: Random, task: Task, last: int, least: int = 1, most: int = 3) -> Script:
    """Some facts of a task that become true or false up to an epoch."""
    number = dice.randint(least, most)
    moments = {(dice.randint(1, last), dice.choice(task.facts)) for _ in range(number)}
    return Script(facts=[(epoch, f"{dice.choice(('', '!'))}{fact}") for epoch, fact in sorted(moments)])


def _with_bystander(dice: Random, task: Task) -> Task:
    """The task with one of several robots as a bystander, who begins something that they may."""
    who = dice.choice(task.robots)
    own = [a for a in task.actions if a.participants == (who,) and a.applicable(task.init)]
    if len(task.robots) < 2 or not own:
        return task
    plan = [(dice.randint(1, 3), dice.choice(own).name)]
    return task.with_script(Script(people={task.agents[who]: plan}))


def _longer(dice: Random, action: GroundAction, duration: int) -> GroundAction:
    """The action with a duration, and some of its conditions and effects moved within it."""
    if duration == 1:
        return action
    (pre, over, end), (neg, over_neg, end_neg) = _parted(dice, action.pre, 3), _parted(dice, action.neg, 3)
    (add, begun), (delete, gone) = _parted(dice, action.add, 2), _parted(dice, action.delete, 2)
    timing = Timing(duration, Condition(over, over_neg), Condition(end, end_neg), begun, gone)
    return replace(action, pre=pre, neg=neg, add=add, delete=delete, timing=timing)


def _parted(dice: Random, facts: Sequence[int], parts: int) -> list[tuple[int, ...]]:
    """Facts in some parts, of which the first has most."""
    place = {fact: dice.choice((0, *range(parts))) for fact in facts}
    return [tuple(fact for fact in facts if place[fact] == part) for part in range(parts)]
