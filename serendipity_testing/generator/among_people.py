"""Seeded random calls among people of whom one is helped, by rules of help (semantics 12 to 14)."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from random import Random
from typing import Final

from serendipity.facade.call import options_from
from serendipity.model import (
    Condition,
    GroundAction,
    Script,
    Task,
    UsageError,
    surroundings,
)
from serendipity.model.task.actions import apply
from serendipity.model.task.gate import is_bound
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.generator.families import AGENTS
from serendipity_testing.generator.human_plans import with_times
from serendipity_testing.generator.in_time import sighted, with_durations
from serendipity_testing.generator.tasks import corridor, strips, varied
from serendipity_testing.oracle import human_plans, optimal_human_plan
from serendipity_testing.oracle.alone import with_predicted

MOST_PEOPLE: Final = len(AGENTS) - 1
"""One of the agents is a robot."""

_LONGEST: Final = 4
"""Epochs of the human's plan: among several people each of them may be anywhere in theirs."""

_PREDICTED, _WANTING, _IN_PLACES, _SLOW, _ROBOTS_WANT, _GIVEN = 0.5, 0.6, 0.3, 0.3, 0.15, 0.15
"""Shares of bystanders that are predicted, and of the others that want anything; of tasks with places, with
actions of several epochs, with a goal of the robots'; of calls with a plan that is given."""

_MODES: Final = ("serendipity", "serendipity", "serendipity", "communication", "composite")
_CHOICES: Final[dict[str, tuple[str, ...]]] = {
    "discount": ("0.5", "0.9", "0.9", "1"),
    "window_weight": ("0", "0", "0.25", "1000"),
    "max_window": ("", "", "", "1", "2"),
    "suffix": ("", "", "", "subplan"),
    "preservation": ("", "", "", "", "state"),
    "interference": ("", "", "", "strict"),
    "waiting_cost": ("", "", "", "", "0.5"),
    "head_start": ("", "", "", "", "1"),
    "disturbance": ("", "", "", "sight=2", "ask=0.5, meet=1"),
    "max_disturbance": ("", "", "0", "1", "2"),
    "ties": ("", "", "", "", "", "", "", "optimistic", "robust", "expected"),
}
_PRICES: Final = ("*=0.3", "f0=0.2, f1=1.5, *=0", "open*=0.4, at *=0, *=2")
_METERED: Final = ("suffix", "preservation", "waiting_cost")
"""Options that leave the rule no way to count what the human pays, where robots have a goal of their own."""


def random_call_among(people: int, seed: int) -> PlanCall:
    """A small random call among so many people, under rules of help; equal arguments give equal calls.

    Bystanders do what they are going to anyway, or by their goal what is best for them.

    Args:
        people: from one to ``MOST_PEOPLE``, with the human who is helped.
        seed: decides all else.
    """
    dice = Random(f"among {people} {seed}")
    while True:
        task = _task(dice, people)
        plan = None if task is None else optimal_human_plan(task)
        if task is not None and (plan is None or task.epochs_of(plan) <= _LONGEST):
            break
    options = _options(dice, task, people)
    early = int(options.get("head_start", "0"))  # after which there may be no plan any more
    if plan is None:
        options["horizon"] = dice.choice(("2", "3", "4"))
    elif dice.random() < 0.4 or not plan or next(human_plans(task, head_start=early), None) is None:
        options["horizon"] = str(task.epochs_of(plan) + early + dice.choice((0, 1, 2)))
    given = None
    if plan and "interference" not in options and dice.random() < _GIVEN:
        given = with_times(task, plan, dice.choice((0, 0, 1)))
    return PlanCall(task, options, given, seed)


def _task(dice: Random, people: int) -> Task | None:
    """A task of several robots of which some are people; None where one of these has nothing to do."""
    crowds = sorted({people + 1, min(people + 2, len(AGENTS))})
    task = strips(dice, (3, 5), crowds) if dice.random() < 0.6 else corridor(dice, crowds, (3, 4))
    task = varied(dice, task, robots_want=_ROBOTS_WANT)
    if dice.random() < _IN_PLACES:
        task = sighted(dice, task)
    if people > 1 and dice.random() < _SLOW:
        task = with_durations(dice, task, (1, 1, 1, 2))
    several = dice.sample(task.robots, len(task.robots))
    persons = sorted(several, key=lambda agent: len(_own(task, agent)))[: people - 1]  # robots can do most
    for person in persons:
        predicted = dice.random() < _PREDICTED
        beside = _predicted(dice, task, person) if predicted else _planned(dice, task, person)
        if beside is None:
            return None
        task = beside
    return task


def _predicted(dice: Random, task: Task, person: int) -> Task | None:
    """The task beside somebody with a goal; None if they can't reach it alone, or have it."""
    goal = _wish(dice, task, person)
    if goal.holds(task.init):
        return None
    try:
        return with_predicted(task, {task.agents[person]: goal})
    except UsageError:
        return None


def _planned(dice: Random, task: Task, person: int) -> Task | None:
    """The task beside somebody with a plan, and maybe a goal; None if there is nothing that they may do."""
    plan = [*_deeds(dice, task, person)]
    if not plan:
        return None
    if dice.random() < _WANTING:
        goals = {**dict(task.own_goals), person: _wish(dice, task, person)}
        task = replace(task, own_goals=tuple(sorted(goals.items())), known_variables=task.variables)
    return task.with_script(Script(people={task.agents[person]: plan}))


def _wish(dice: Random, task: Task, person: int) -> Condition:
    """A literal, mostly of a fact that somebody changes themselves."""
    own = [a for a in _own(task, person) for a in a.moments]
    theirs = sorted({fact for action in own for fact in (*action.add, *action.delete)})
    fact = dice.choice(theirs if theirs and dice.random() < 0.8 else range(len(task.facts)))
    return Condition((), (fact,)) if dice.random() < 0.25 else Condition((fact,))


def _deeds(dice: Random, task: Task, person: int) -> Iterator[tuple[int, str]]:
    """What somebody might do one after another, were they alone, with breaks."""
    state, epoch = task.init, dice.choice((1, 1, 2, 3, 4))
    for _ in range(dice.choice((1, 1, 2, 3))):
        ways = [action for action in _own(task, person) if action.applicable(state)]
        if not ways:
            return
        action = dice.choice(ways)
        yield epoch, action.name
        epoch += action.duration + dice.choice((0, 0, 1, 2))
        for moment in action.moments:
            state = apply(state, moment)


def _own(task: Task, person: int) -> Sequence[GroundAction]:
    return [action for action in task.actions if action.participants == (person,)]


def _options(dice: Random, task: Task, people: int) -> dict[str, str]:
    """A mode and options that go with each other."""
    options = {"mode": dice.choice(_MODES)}
    options |= {name: value for name, values in _CHOICES.items() if (value := dice.choice(values))}
    rule = dice.choice(("true", "true", "") if people == 1 else ("", "", "", "true", "false"))
    if rule:
        options["nobody_pays"] = rule
    if dice.random() < 0.3:
        facts = dice.sample(task.facts, dice.randint(0, len(task.facts)))
        options["leave_free"] = ", ".join(facts) or "nothing"
    if not task.robot_goal and dice.random() < 0.25:
        options["leave_price"] = dice.choice(_PRICES)
    metered = bool(task.robot_goal)
    if options["mode"] == "serendipity" and dice.random() < 0.25 and not _is_moved(task):
        options["noticed"], metered = "true", True
    left_out = _METERED if metered else ()
    if "noticed" in options or "max_disturbance" in options:
        left_out = (*left_out, "interference")  # where effects can't say what it forbids it is refused
    options = {name: value for name, value in options.items() if name not in left_out}
    if not is_bound(task, options_from(PlanCall(task, options).keywords())):
        options.pop("ties", None)  # which programs do not know in time
    return options


def _is_moved(task: Task) -> bool:
    """Whether others change where the human is, which who has to notice help must do themselves."""
    located, human = surroundings(task).located, task.agents[task.human]
    deeds = (action for deed in task.script.deeds for action in deed.variants)
    others = (action for action in (*task.actions, *deeds) if task.human not in action.participants)
    changed = (f for one in others for moment in one.moments for f in (*moment.add, *moment.delete))
    return any(located[f][0] == human for f in changed if f in located)
