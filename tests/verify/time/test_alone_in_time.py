"""The human alone in time, from action to action: as epoch by epoch, and in long days."""

from dataclasses import replace
from fractions import Fraction
from random import Random

import pytest
from hypothesis import given

import serendipity
from serendipity.model import Deadline, Options, Script, Task
from serendipity.model.task.unit_steps import unit_steps
from serendipity_testing.builders import task as build
from serendipity_testing.generator import random_call_in_time
from serendipity_testing.oracle import optimal_human_plan
from serendipity_testing.strategies.time import tasks_in_time
from tests.search.time.days import day, with_a_robot_at_work
from verify.base.beside_script import AloneBesideScript, alone_of
from verify.base.due import onward
from verify.base.execution import State, applicable, unchosen
from verify.base.shortest_paths import PathSearch
from verify.limits import limited


@given(tasks_in_time())
def test_what_the_human_pays_alone_is_what_brute_force_says(built: Task) -> None:
    worth, plan = alone_of(unit_steps(built).task).predicted(), optimal_human_plan(built)
    assert worth == (None if plan is None else (built.cost_of(plan), built.epochs_of(plan)))


def epoch_by_epoch(alone: AloneBesideScript, task: Task, state: State) -> int | None:
    """What the human's own optimum weighs, if each epoch is looked at."""

    def edges(here: State) -> list[tuple[State, int, int]]:
        return [(after, alone.own.weight(i), i) for i, after in alone.moves(here)]

    search = PathSearch(state, edges, lambda _: 0, Deadline())
    return next((search.distance[here] for here, _ in search if task.goal.holds(here)), None)


def met(task: Task, dice: Random, *, strict: bool) -> set[State]:
    """States that the team meets if everybody does anything."""
    found, begun = set[State](), unchosen(task) | task.of_bystanders
    for _ in range(4):
        state: State | None = task.init
        for _ in range(14):
            if state is not None:
                found.add(state)
                able = [i for i, one in enumerate(task.actions) if applicable(one, state) and i not in begun]
                chosen = [dice.choice(able)] if able and dice.random() < 0.7 else []
                state = onward(task, state, chosen, strict=strict)
    return found


@pytest.mark.parametrize("seed", [*range(60), 31000761, 31300181])
def test_from_action_to_action_is_as_good_as_epoch_by_epoch(seed: int) -> None:
    dice = Random(seed)
    built = with_a_robot_at_work(random_call_in_time(seed).task, dice)
    price = dice.choice([Fraction(0), Fraction(1, 2), Fraction(1)])
    options = Options(
        interference=dice.choice(["paper", "strict"]),
        human_model=dice.choice(["omniscient", "observant"]),
        waiting_cost=price,
    )
    task = unit_steps(built, waiting_cost=price).task
    with limited(projected_states=dice.choice([0, 3, 20_000])):
        alone = alone_of(task, None, options)
        for state in met(task, dice, strict=options.strict):
            if isinstance(alone, AloneBesideScript):
                assert alone.weight(state) == epoch_by_epoch(alone, task, state)


@pytest.mark.parametrize(
    ("seed", "activities"), [(0, 4), *(pytest.param(seed, 10, marks=pytest.mark.long) for seed in (0, 3, 5))]
)
def test_a_day_of_a_thousand_epochs_is_proved(seed: int, activities: int) -> None:
    """The human's own problem was too large: each epoch of a day was looked at."""
    home = day(seed, activities)
    right = serendipity.plan(home, mode="individual")
    certificate = serendipity.verify(home, right)
    assert certificate.verdict == "proved", certificate
    assert "the human's canonical optimal plan" in certificate.claims[0].reason
    assert right.cost is not None
    for cost in (right.cost - 1, right.cost + 1):
        wrong = replace(right, cost=cost, objective=cost, lower_bound=cost, human_cost=cost)
        assert serendipity.verify(home, wrong).verdict == "refuted"


@pytest.mark.long
def test_help_in_a_day_is_proved() -> None:
    """Ends of windows were looked at one by one, each with all plans of the human's own from there on."""
    home = day(3, 5)
    right = serendipity.plan(home, discount="0.9")
    assert right.opportunity
    certificate = serendipity.verify(home, right)
    assert certificate.verdict == "proved", certificate


def test_plans_of_more_epochs_than_calls_may_be_nested_are_proved() -> None:
    """What is optimal was followed by a call for each epoch."""
    short, long = (
        {"a h": "open -> g", "b r": "-> f"},
        {"a h": "-> f [600]", "b h": "f -> g [600]", "c r": "-> f"},
    )
    waits = build(goal="g", actions=short).with_script(Script(facts=[(1_200, "open")]))
    for one in (waits, build(goal="g", actions=long)):
        certificate = serendipity.verify(one, serendipity.plan(one, mode="individual"))
        assert certificate.verdict == "proved", certificate
        assert "canonical" in certificate.claims[0].reason


@pytest.mark.parametrize("told", ["suppose", "learn"])
def test_what_is_known_of_an_epoch_is_not_known_of_others(told: str) -> None:
    """A plan through a door that closes for good was known to be there once it is closed, too."""
    built = build(agents="h r", human="h", goal="g", actions={"a h": "open -> g", "c r": "-> open"})
    task = unit_steps(built.with_script(Script(facts=[(2, "open"), (5, "!open")]))).task
    alone = alone_of(task)
    state: State | None = task.init
    wait, act = task.named["~noop"][0], task.named["a h"][0]
    getattr(alone, told)((wait, wait, act))
    assert alone.optimum(task.init) == (1, 3)
    for _ in range(6):
        state = None if state is None else onward(task, state, (), strict=False)
    assert state is not None
    assert alone.weight(state) is None
