"""Executions in time beside somebody who sees what is where they are (semantics 10.6).

And a plan in time played beside somebody who replans is what an execution makes of it.
"""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from itertools import count, islice
from random import Random

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import serendipity
from serendipity import Trace
from serendipity.execution import Decided, Execution, Outlook, person_of
from serendipity.facade.person.follower import Follower
from serendipity.facade.person.ways import Ways, entries_of
from serendipity.model import Condition, Deadline, Options, PlanStep, Result, Script, Task, UsageError
from serendipity.robot import Simulated
from serendipity_testing.builders import Builder, task
from serendipity_testing.call import Call
from serendipity_testing.generator.in_time import random_local_call
from serendipity_testing.oracle import human_plans
from serendipity_testing.strategies import calls_in_time
from tests.execution.living import lived, lived_short_of_a_robot, other_goals, replayed
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
        if found.plan is not None and found.human_plan is not None:
            goes_as_in_an_execution(task, found, "local")


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


class Stubborn:
    """Robots that do their part of a plan, whatever the person does."""

    goals: Mapping[str, float] = {}

    def __init__(self, plan: Sequence[PlanStep], human: str) -> None:
        self._plan, self._human = plan, human

    def decide(self, outlook: Outlook, _deadline: Deadline) -> Decided:
        steps = [step for step in self._plan if step.epoch == outlook.epoch]
        own = tuple(step for step in steps if self._human not in step.agents)
        offers = tuple(step for step in steps if self._human in step.agents and len(step.agents) > 1)
        return Decided(outlook.epoch, "helps", "", actions=own, offers=offers)

    def saw(self, own: int | None, executed: Sequence[int], tried: int | None = None) -> None:
        """Nothing is learnt."""

    def surprised(self) -> None:
        """Nothing is."""

    def drop(self, robots: Iterable[int]) -> None:
        """Nobody does."""

    def unable(self, actions: Iterable[int]) -> None:
        """They are."""


def goes_as_in_an_execution(task: Task, result: Result, human: str) -> Trace:
    """A trace that is what an execution makes of the plan, unless something is broken off there."""
    trace = serendipity.simulate(task, result, human)
    run = Execution(task, discount=result.options.discount, robots=Stubborn(result.plan or (), result.human))
    lived(run, person_of(task, human), len(trace.epochs) + 1)
    if not any(missed.why == "broken" for passed in run.passed for missed in passed.unfinished):
        assert [{*epoch.steps} for epoch in trace.epochs] == [{*passed.steps} for passed in run.passed]
        assert trace.goals_hold == run.done and trace.cost == float(run.cost)
    return trace


@pytest.mark.long
@given(calls_in_time(modes=("serendipity", "composite")))
def test_it_goes_as_in_an_execution(call: Call) -> None:
    keywords = {**call.keywords(), "head_start": 0, "waiting_cost": 0, "horizon": None, "human_plan": None}
    task = call.task.with_goal(call.task.goal, Condition())
    assume(task.needs_time and not call.options.strict)
    try:
        result = serendipity.plan(task, **keywords)
    except UsageError:
        return
    assume(result.plan is not None and result.human_plan is not None)
    trace = goes_as_in_an_execution(task, result, "observant")
    if trace.realised:
        assert trace.goals_hold and trace.cost <= result.cost


def test_the_talk_is_realised_and_told() -> None:
    task = serendipity.example("office")
    trace = serendipity.simulate(task, serendipity.plan(task, discount=0.5))
    assert trace.realised and (trace.cost, trace.promised_cost) == (30, 30)
    told = trace.text()
    assert "eve replans: 8 instead of 16" in told and "eve: goes on with ride eve lobby landing" in told


def test_somebody_without_a_plan_waits_until_robots_give_them_one() -> None:
    """What robots begin last may be what gives the person a plan."""
    about = task(init="a", goal="d", actions={"go h": "a gate -> d !a @ 1 [3]", "open r": " -> gate @ 1"})
    answer = serendipity.plan(about, mode="composite")
    for model in ("observant", "local"):
        played = serendipity.simulate(about, answer, model)
        assert (played.realised, len(played.epochs)) == (True, 4)


@pytest.mark.parametrize("model", ["observant", "local"])
def test_waiting_at_the_end_is_kept_like_the_rest_of_a_plan(model: str) -> None:
    """What comes by itself need not be done: the plan works, though no action of it reaches the goal."""
    actions = {"bread h": " -> fed @ 1", "soup h": " -> fed @ 1", "roll r": "idle -> !idle @ 1"}
    about = task(init="idle", goal="fed post", actions=actions).with_script(Script(facts=[(4, "post")]))
    answer = serendipity.plan(about, human_plan=[(2, "soup h"), (4, "noop")])
    trace = serendipity.simulate(about, answer, model)
    assert [(epoch.did, epoch.decision) for epoch in trace.epochs] == [
        (None, "keeps"), ("soup h", "keeps"), (None, "keeps"), (None, "keeps"),
    ]  # fmt: skip


def test_a_habit_that_ends_with_waiting_is_followed() -> None:
    actions = {"bread h": " -> fed @ 1", "soup h": " -> fed @ 2"}
    about = task(init="", goal="fed post", actions=actions).with_script(Script(facts=[(4, "post")]))
    mind = Follower(Ways(Options()))
    mind.rest, mind.faithful = entries_of(about, about.plan_from_names([(2, "soup h"), (4, "noop")])), True
    way = mind.look(about, Deadline())
    assert way is not None and [name for _, name in way.plan] == ["soup h", "noop"]
