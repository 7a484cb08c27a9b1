"""A plan in time played beside somebody observant is what an execution makes of it."""

from collections.abc import Iterable, Mapping, Sequence

import pytest
from hypothesis import assume, given

import serendipity
from serendipity.execution import Decided, Execution, Outlook, moment_of, person_of
from serendipity.facade.person.follower import Follower
from serendipity.facade.person.ways import Ways, entries_of
from serendipity.model import Condition, Deadline, Options, PlanStep, Script, UsageError
from serendipity.testing.builders import task
from serendipity.testing.call import Call
from serendipity.testing.strategies import calls_in_time


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
    if result.plan is None or result.human_plan is None:
        return
    trace = serendipity.simulate(task, result)
    run = Execution(task, discount=call.options.discount, robots=Stubborn(result.plan, result.human))
    person = person_of(task)
    while not run.done and run.epoch <= len(trace.epochs):
        run.step(person.choose(moment_of(run)))
    assume(not any(missed.why == "broken" for passed in run.passed for missed in passed.unfinished))
    assert [{*epoch.steps} for epoch in trace.epochs] == [{*passed.steps} for passed in run.passed]
    assert trace.goals_hold == run.done and trace.cost == float(run.cost)
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
