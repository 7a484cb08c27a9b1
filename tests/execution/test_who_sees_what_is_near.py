"""Executions in time beside somebody who sees what is where they are (semantics 10.6)."""

from fractions import Fraction
from itertools import count, islice
from random import Random

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import serendipity
from serendipity.execution import Execution, moment_of, person_of
from serendipity.model import Condition, Script, Task
from serendipity.robot import Simulated
from serendipity.testing.builders import Builder
from serendipity.testing.generator.in_time import random_local_call
from serendipity.testing.oracle import human_plans
from tests.execution.living import lived, lived_short_of_a_robot, other_goals, replayed
from tests.execution.test_simulation_in_time import Stubborn
from tests.search.time.test_people_who_see_what_is_near import answered, kitchen

SEEDS = st.integers(0, 10**6)

_MOST_EPOCHS = 40
_FEW = 14
"""Actions of a task: more take long."""


def _lived(seed: int) -> tuple[Task, Fraction]:
    """A small random task with somebody who sees what is near, and what they pay alone."""
    tasks = (random_local_call(number).task for number in count(seed))
    few = (task for task in tasks if len(task.actions) <= _FEW)
    return next((task, task.cost_of(plan)) for task in few for plan in islice(human_plans(task), 1))


def _near(task: Task, **settings: object) -> Execution:
    """A run in which robots know that the person sees what is where they are."""
    run = Execution(task, **{"discount": "0.5", "human_model": "local", **settings})  # type: ignore[arg-type]
    return lived(run, person_of(task, "local"), _MOST_EPOCHS)


@pytest.mark.long
@given(SEEDS)
def test_they_never_pay_more_than_alone_and_their_runs_replay(seed: int) -> None:
    task, alone = _lived(seed)
    run = _near(task, discount=("0", "0.5", "0.9", "1")[seed % 4])
    assert run.done and run.human_cost <= alone
    assert not any(missed.why == "broken" for passed in run.passed for missed in passed.unfinished)
    replayed(task, run)


@pytest.mark.long
@given(SEEDS)
def test_nor_do_they_pay_for_robots_own_goals(seed: int) -> None:
    task, alone = _lived(seed)
    fact = Random(seed).randrange(len(task.facts))
    run = _near(task.with_goal(task.goal, Condition((), (fact,)) if seed % 2 else Condition((fact,))))
    assert run.done and run.human_cost <= alone


@pytest.mark.long
@given(SEEDS)
def test_nor_where_robots_do_not_know_what_they_want(seed: int) -> None:
    task, alone = _lived(seed)
    run = _near(task, goals=other_goals(task, Random(seed)))
    assert run.done and run.human_cost <= alone
    replayed(task, run)


@pytest.mark.long
@given(SEEDS)
def test_a_run_is_what_simulate_makes_of_the_plan(seed: int) -> None:
    """Names of several variants are left out: by a name the world does what is possible."""
    call = random_local_call(seed)
    task = call.task
    assume(all(len(ids) == 1 for ids in task.named.values()) and "interference" not in call.options)
    for name in ("head_start", "waiting_cost"):  # which an execution does not know
        call.options.pop(name, None)
    for found in (answered(call), serendipity.plan(task, discount="0.5", nobody_pays=False)):
        if found.plan is None or found.human_plan is None:
            continue
        trace = serendipity.simulate(task, found, "local")
        run = Execution(task, discount=found.options.discount, robots=Stubborn(found.plan, found.human))
        person = person_of(task, "local")
        while not run.done and run.epoch <= len(trace.epochs):
            run.step(person.choose(moment_of(run)))
        if any(missed.why == "broken" for passed in run.passed for missed in passed.unfinished):
            continue
        assert [{*epoch.steps} for epoch in trace.epochs] == [{*passed.steps} for passed in run.passed]
        assert trace.goals_hold == run.done and trace.cost == float(run.cost)


@pytest.mark.long
@given(SEEDS)
def test_a_log_of_robots_that_fail_replays(seed: int) -> None:
    (task, _), dice = _lived(seed), Random(seed)
    robots = Simulated(dice, fail=0.3, slow=0.3)
    run = Execution(task, discount="0.5", human_model="local", adapter=robots)
    replayed(task, lived_short_of_a_robot(task, run, person_of(task, "local", dice)))


@pytest.mark.parametrize("walk", [1, 3])
def test_a_day_that_goes_as_planned_costs_what_was_planned(walk: int) -> None:
    task = kitchen(walk=walk)
    found = serendipity.plan(task, discount="0.5", human_model="local")
    run = _near(task)
    assert (float(run.cost), run.done) == (found.cost, True)
    assert {step for passed in run.passed for step in passed.steps} == {*(found.plan or ())}


def _two_cups() -> Task:
    """Ann drinks in the kitchen or the cellar; a robot may wash the cellar's cup, in epoch 1 only."""
    built = Builder(("ann", "bot"), separator=",")
    built.named("go ann bed hall", (0,), "at ann bed / /", "!at ann bed / at ann hall", "1", 2)
    ways = ("hall kitchen 1", "hall cellar 1", "kitchen cellar 3", "cellar kitchen 3")
    for here, there, cost in map(str.split, ways):
        built.named(f"go ann {here} {there}", (0,), f"at ann {here}", f"at ann {there}, !at ann {here}", cost)
    for room in ("kitchen", "cellar"):
        built.named(f"drink ann {room}", (0,), f"at ann {room}, cup {room}, late", "glad ann", "1")
    built.named("wash bot cellar", (1,), "cup cellar, water", "!cup cellar", "1")
    task = built.task("at ann bed, cup kitchen, cup cellar, water", "glad ann")
    task = task.with_goal(task.goal, Condition((), (task.facts.index("cup cellar"),)))
    return task.with_script(Script(facts=[(1, "!water"), (6, "late")]))


def test_robots_take_nothing_away_that_they_would_look_for_in_vain() -> None:
    """Who sees everything turns to the kitchen, which is as near; who does not would go back for 3."""
    task = _two_cups()
    seen = lived(Execution(task, discount="0.5"), person_of(task), _MOST_EPOCHS)
    assert (seen.human_cost, seen.left) == (3, ())
    run = _near(task)
    assert (run.human_cost, run.left) == (3, ("!cup cellar",))
    in_vain = lived(Execution(task, discount="0.5"), person_of(task, "local"), _MOST_EPOCHS)
    assert (in_vain.human_cost, in_vain.left) == (6, ())


@pytest.mark.long
def test_the_days_of_the_guide_happen() -> None:
    costs = {}
    for name in ("morning", "office"):
        (row,) = serendipity.execute(serendipity.example(name), "local", discount="0.5").rows
        assert (row.reached, row.spoilt) == (True, 0)
        costs[name] = row.cost, row.human_cost
    assert costs == {"morning": (37, 32), "office": (30, 26)}
