"""Tasks that are almost another one: their answers, presented with it, are false certificates."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from random import Random
from typing import Final

from serendipity.model import Condition, GroundAction, Result, Script, Task, Timing
from serendipity.model.task.script import Deed, TimedFact, Timeline
from serendipity_testing.generator.numbers import oddly_priced

Change = Callable[[Random, Task, Result], Task]
"""Another task, from a task and the answer to a call about it; dice decide."""

TRIFLES: Final = tuple(map(Fraction, ("1", "1/2", "1e-6", "1e-9", "1e-12")))
"""By how much figures are wrong."""


def _fewer_actions(dice: Random, task: Task, right: Result) -> Task:
    left_out = {_an_action(dice, task, right, 0.6), _an_action(dice, task, right, 0.1)}
    return replace(task, actions=tuple(action for action in task.actions if action.name not in left_out))


def _other_costs(dice: Random, task: Task, _: Result) -> Task:
    if dice.random() < 0.3:
        return oddly_priced(dice, task)
    costs = [action.cost for action in task.actions]
    dice.shuffle(costs)
    return _priced(task, {action.name: cost for action, cost in zip(task.actions, costs, strict=True)})


def _dearer(dice: Random, task: Task, right: Result) -> Task:
    name = _an_action(dice, task, right, 0.7)
    return _priced(task, {name: _cost(task, name) + dice.choice((*TRIFLES, Fraction(3)))})


def _cheaper(dice: Random, task: Task, right: Result) -> Task:
    name = _an_action(dice, task, right, 0.3)
    cost = _cost(task, name)
    return _priced(task, {name: max(Fraction(0), cost - dice.choice((*TRIFLES, cost)))})


def _other_goal(dice: Random, task: Task, _: Result) -> Task:
    if task.robot_goal and dice.random() < 0.4:
        return replace(task, robot_goal=Condition())
    goal = {**dict.fromkeys(task.goal.positive, True), **dict.fromkeys(task.goal.negative, False)}
    if goal and dice.random() < 0.5:
        goal.pop(dice.choice(sorted(goal)))
    if not goal or dice.random() < 0.5:
        fact = dice.randrange(len(task.facts))
        goal[fact] = fact not in task.init
    wanted, unwanted = (tuple(sorted(f for f in goal if goal[f] == true)) for true in (True, False))
    return replace(task, goal=Condition(wanted, unwanted))


def _other_person(dice: Random, task: Task, _: Result) -> Task:
    return replace(task, human=dice.choice(task.robots))


def _other_start(dice: Random, task: Task, _: Result) -> Task:
    return replace(task, init=task.init ^ {dice.randrange(len(task.facts))})


CHANGES: Final[Mapping[str, Change]] = {
    "fewer actions": _fewer_actions,
    "other costs": _other_costs,
    "one action dearer": _dearer,
    "one action cheaper": _cheaper,
    "another goal": _other_goal,
    "another person": _other_person,
    "another start": _other_start,
}


def _other_durations(dice: Random, task: Task, right: Result) -> Task:
    name = _an_action(dice, task, right, 0.7)

    def changed(action: GroundAction) -> GroundAction:
        if action.name != name:
            return action
        if action.timing is None:
            return replace(action, timing=Timing(2))
        longer = action.duration + (1 if action.duration == 2 else dice.choice((-1, 1)))
        return replace(action, timing=replace(action.timing, duration=longer))

    return replace(task, actions=tuple(map(changed, task.actions)))


def _other_script(dice: Random, task: Task, _: Result) -> Task:
    facts, deeds = [*task.script.facts], [*task.script.deeds]
    events: list[TimedFact | Deed] = [*facts, *deeds]
    if not events or dice.random() < 0.2:
        fact = f"{dice.choice(('', '!'))}{dice.choice(task.facts)}"
        return task.with_script(Script(facts=[(dice.randint(1, 6), fact)]))
    one = dice.choice(events)
    kept = [event for event in events if event is not one]
    if dice.random() < 0.7:
        kept.append(replace(one, epoch=max(1, one.epoch + dice.choice((-1, 1)))))
    facts = [event for event in kept if isinstance(event, TimedFact)]
    deeds = [event for event in kept if isinstance(event, Deed)]
    return replace(task, script=Timeline(tuple(facts), tuple(deeds), task.script.people))


IN_TIME: Final[Mapping[str, Change]] = {"other durations": _other_durations, "another script": _other_script}
"""More of them, for tasks in time."""


def _an_action(dice: Random, task: Task, right: Result, of_plan: float) -> str:
    """The name of an action, with some probability one of the answer's."""
    used = {step.action for step in right.plan or ()} if dice.random() < of_plan else set[str]()
    return dice.choice(sorted(used or task.named))


def _cost(task: Task, name: str) -> Fraction:
    return task.actions[task.named[name][0]].cost


def _priced(task: Task, prices: Mapping[str, Fraction]) -> Task:
    actions = tuple(replace(a, cost=prices.get(a.name, a.cost)) for a in task.actions)
    return replace(task, actions=actions, known_variables=task.variables)
