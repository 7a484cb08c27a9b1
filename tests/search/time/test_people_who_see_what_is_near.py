"""Plans in time beside somebody who sees what is where they are: those of brute force, and they happen."""

from dataclasses import replace
from itertools import count
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from search.modes.simulation.eyes import SeesWork
from serendipity.model import Result, Task, UsageError, surroundings
from serendipity.model.task.plans_in_time import cost_alone
from serendipity_testing.builders import Builder
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.generator.in_time import random_local_call
from serendipity_testing.oracle.alone import human_plans
from serendipity_testing.oracle.reactions import best_reaction

SEEDS = st.integers(0, 10**6)

_FEW = 12


def answered(call: PlanCall) -> Result:
    options: dict[str, Any] = {**call.options, "no_block": call.options["no_block"] == "true"}
    if "nobody_pays" in options:
        options["nobody_pays"] = False
    return serendipity.plan(call.task, **options | {"head_start": int(options.get("head_start", 0))})


@pytest.mark.long
@given(SEEDS)
def test_answers_are_those_of_brute_force_proved_and_happen(seed: int) -> None:
    calls = map(random_local_call, count(seed))
    call = next(one for one in calls if len(one.task.actions) <= _FEW)  # else brute force takes long
    found, task = answered(call), call.task
    price, late = found.options.waiting_cost, found.options.head_start
    plan = next(human_plans(task, price, late, strict=found.options.strict), None)
    if plan is None:
        assert found.status == "infeasible"
        return
    least = best_reaction(task, found.options, plan, surroundings(task).visible).cost
    costs = [cost for cost in (least, cost_alone(task, plan, price)) if cost is not None]
    assert (found.status, found.cost) == ("optimal", float(min(costs)))
    assert serendipity.simulate(task, found, "local").realised
    assert serendipity.verify(task, found).verdict == "proved"


def kitchen(*, walk: int = 1) -> Task:
    """Ann goes from the hall to the kitchen, and cooks there; so may a robot, which takes a while."""
    built = Builder(("ann", "bot"), separator=",")
    asked, effects = "at ann hall / /", "!at ann hall / at ann kitchen"
    if walk == 1:
        asked, effects = "at ann hall", "at ann kitchen, !at ann hall"
    built.named("walk ann hall kitchen", (0,), asked, effects, "1", walk)
    built.named("cook ann", (0,), "at ann kitchen / /", " / warm soup", "6", 3)
    built.named("eat ann", (0,), "at ann kitchen, warm soup", "fed ann")
    built.named("cook bot", (1,), "at bot kitchen / /", " / warm soup", "4", 3)
    built.named("leave bot", (1,), "at bot kitchen", "at bot yard, !at bot kitchen", "0")
    built.named("come bot", (1,), "at bot yard", "at bot kitchen, !at bot yard", "0")
    return built.task("at ann hall, at bot kitchen", "fed ann")


@pytest.mark.parametrize("walk", [1, 3])
def test_they_see_what_those_are_at_who_are_there(walk: int) -> None:
    task = kitchen(walk=walk)
    found = serendipity.plan(task, discount="0.5", human_model="local")
    assert (found.cost, found.opportunity) == (4, True)
    played = serendipity.simulate(task, found, "local")
    assert played.realised
    if walk == 1:  # they wait for what they see that it is at
        assert [epoch.did for epoch in played.epochs] == ["walk ann hall kitchen", None, None, "eat ann"]
    assert serendipity.verify(task, found).verdict == "proved"


def test_they_pay_for_waiting_for_what_they_see() -> None:
    """Two epochs beside the stove, which are worth it at a price of less than 2."""
    costs = []
    for price in ("0.5", "1.5", "2"):
        found = serendipity.plan(kitchen(), discount="0.5", human_model="local", waiting_cost=price)
        played = serendipity.simulate(kitchen(), found, "local")
        assert played.realised and serendipity.verify(kitchen(), found).verdict == "proved"
        assert played.cost == found.cost
        costs.append((found.cost, found.opportunity))
    assert costs == [(5, True), (7, True), (8, False)]


def test_where_they_are_is_known_though_they_are_on_the_way_for_a_while() -> None:
    assert {place for _, place in surroundings(kitchen(walk=3)).located.values()} == {"hall", "kitchen"}


def test_nobody_knows_what_is_begun_out_of_sight() -> None:
    """While Ann sleeps a robot begins to open the roof, which would spare her the climb."""
    built = Builder(("ann", "bot"), separator=",")
    built.named("walk ann hall attic", (0,), "at ann hall", "at ann attic, !at ann hall")
    built.named("climb ann", (0,), "at ann hall", "at ann roof, !at ann hall", "2")
    built.named("look ann attic", (0,), "at ann attic, open roof", "done ann", "0")
    built.named("look ann roof", (0,), "at ann roof", "done ann", "1")
    built.named("open bot", (1,), "at bot roof / /", " / open roof", "1", 2)
    built.named("go bot", (1,), "at bot roof", "at bot attic, !at bot roof", "1")
    task = built.task("at ann hall, at bot roof", "done ann")
    costs = {
        model: serendipity.plan(task, discount="0.9", human_model=model, head_start=1).cost
        for model in ("observant", "local")
    }
    assert costs == {"observant": 1.1, "local": 3}


@pytest.mark.parametrize(
    ("name", "bug", "seed"),
    [
        ("they see nobody's work", lambda eyes, belief, state: eyes._facts.look(belief, state), 56),
        ("they see all", lambda _eyes, _belief, state: state, 28),
    ],
)
def test_who_is_wrong_about_what_they_believe_is_refuted(
    name: str, bug: Any, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    call = random_local_call(seed)
    monkeypatch.setattr(SeesWork, "look", bug)
    wrong = answered(call)
    monkeypatch.undo()
    right = answered(call)
    verdicts = [serendipity.verify(call.task, found).verdict for found in (wrong, right)]
    assert verdicts == ["refuted", "proved"], name


def test_they_try_the_variant_that_they_believe_to_be_possible() -> None:
    call = random_local_call(2750)
    call.options.pop("waiting_cost", None)
    found = answered(call)
    assert (found.cost, serendipity.simulate(call.task, found, "local").realised) == (3, True)


def test_a_doctored_answer_is_refuted() -> None:
    task = kitchen()
    found = serendipity.plan(task, discount="0.5", human_model="local")
    assert found.plan is not None
    later = tuple(replace(step, epoch=step.epoch + (step.action == "cook bot")) for step in found.plan)
    for wrong in (replace(found, plan=later), replace(found, cost=3.5, objective=3.5, lower_bound=3.5)):
        assert serendipity.verify(task, wrong).verdict == "refuted"


def test_what_is_not_settled_is_refused() -> None:
    with pytest.raises(UsageError, match="visible: is not known where actions take time"):
        serendipity.plan(kitchen(), human_model="local", visible=lambda *_: True)
    with pytest.raises(UsageError, match="visible: is not known where actions take time"):
        serendipity.simulate(kitchen(), serendipity.plan(kitchen()), "local", visible=lambda *_: True)
