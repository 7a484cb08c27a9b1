"""Plans beside somebody observant where actions take time: those of brute force, and they happen."""

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import serendipity
from search.modes.simulation.human import Human
from search.modes.simulation.in_time import BesideOthers, HumanInTime
from serendipity.model import Options, PlanError, Result, Script, Task, TimedPlan, UsageError
from serendipity.model.task.plans_in_time import cost_alone
from serendipity_testing.builders import task
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.generator.in_time import random_call_in_time
from serendipity_testing.oracle.alone import human_plans
from serendipity_testing.oracle.reactions import best_reaction

_KEPT = ("discount", "interference", "head_start")

SEEDS = st.integers(0, 10**6)


def _blind(person: BesideOthers, state: int, limit: int = 0) -> int:
    return person._later._least_from(state & person._later.mask)


def observed(call: PlanCall, **more: object) -> tuple[Result, Options]:
    """The answer beside somebody observant, and its options; calls that are refused don't count."""
    options = {name: value for name, value in call.options.items() if name in _KEPT}
    try:
        found = serendipity.plan(
            call.task, human_plan=call.human_plan, human_model="observant", **options, **more
        )
    except (UsageError, PlanError):
        assume(False)
    return found, found.options


@pytest.mark.long
@settings(max_examples=3 * settings().max_examples)
@given(SEEDS, st.booleans(), st.sampled_from([None, 5, 7, 9]), st.sampled_from(["0", "0", "0.1", "0.5", "1"]))
def test_answers_are_those_of_brute_force_proved_and_happen(
    seed: int, no_block: bool, horizon: int | None, price: str
) -> None:
    call = random_call_in_time(seed)
    about = call.task
    if price != "0":
        call = replace(call, human_plan=None)
    found, options = observed(call, no_block=no_block, horizon=horizon, waiting_cost=price)
    late, price_of_one = options.head_start, options.waiting_cost
    plan = next(human_plans(about, price_of_one, late, strict=options.strict), None)
    if call.human_plan is not None:
        given = about.plan_from_names(call.human_plan)
        starts = [start + late for start in about.starts_of(given)]
        plan = TimedPlan(given, starts, about.epochs_of(given) + late)
    if plan is None:
        assert found.status == "infeasible"
        return
    costs = [best_reaction(about, options, plan).cost, cost_alone(about, plan, price_of_one)]
    least = min(cost for cost in costs if cost is not None)
    assert (found.status, found.cost) == ("optimal", float(least))
    assert serendipity.simulate(about, found).realised
    assert serendipity.verify(about, found).verdict == "proved"


def test_what_was_waited_costs_nothing_where_nothing_is_begun() -> None:
    """She waits for the door, and needs it no more: a robot has brought what she wants."""
    actions = {"fetch h": "open -> g @ 2", "bring r": "-> g @ 2 [3]", "show h r": "open -> g @ 1"}
    door = task(agents="h r", human="h", goal="g", actions=actions).with_script(Script(facts=[(4, "open")]))
    call: dict[str, Any] = {"human_model": "observant", "waiting_cost": "0.5", "discount": "0.5"}
    helped = serendipity.plan(door, **call)
    assert (helped.human_cost, helped.cost, helped.horizon) == (4, 1, 5)
    assert serendipity.verify(door, helped).verdict == "proved"
    door = replace(door, actions=tuple(a for a in door.actions if a.name != "bring r"))
    asked = serendipity.plan(door, **call)
    assert (asked.cost, serendipity.verify(door, asked).verdict) == (3, "proved")


@pytest.mark.parametrize(
    ("name", "owner", "method", "bug", "seed"),
    [
        ("nobody does anything with robots", Human, "accepts", lambda *_: False, 0),
        ("they look up before they are up", HumanInTime, "unasked", lambda *_: None, 26),
        ("they see nothing that robots are at", BesideOthers, "_least_from", _blind, 65),
    ],
)
def test_who_forgets_what_the_human_knows_is_refuted(
    name: str, owner: type, method: str, bug: Any, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    call = random_call_in_time(seed)
    monkeypatch.setattr(owner, method, bug)
    wrong, _ = observed(call)
    monkeypatch.undo()
    right, _ = observed(call)
    verdicts = [serendipity.verify(call.task, found).verdict for found in (wrong, right)]
    assert verdicts == ["refuted", "proved"], name


def test_a_joint_action_is_proved_while_the_script_goes_on() -> None:
    call = random_call_in_time(1396)
    found, _ = observed(call)
    assert (found.cost, serendipity.verify(call.task, found).verdict) == (0.1, "proved")


def test_an_answer_ends_before_the_script_undoes_it() -> None:
    call = random_call_in_time(244)
    found, _ = observed(call)
    assert (found.opportunity, serendipity.verify(call.task, found).verdict) == (True, "proved")


def test_a_joint_action_is_not_skipped_for_its_variants() -> None:
    found, _ = observed(random_call_in_time(1186))
    (epoch,) = serendipity.simulate(random_call_in_time(1186).task, found).epochs
    assert (epoch.did, epoch.skipped) == ("carry hum rob", ())


def gate(*, opening: int, init: str = "a") -> Task:
    """From a to b to d, the second part long, or short through a gate that a robot may open."""
    return task(
        init=init,
        goal="d",
        actions={
            "go h a b": "a -> b !a @ 1",
            "go h b d": "b -> d !b @ 5 [2]",
            "through h b d": "b open -> d !b @ 1",
            "open r": f" -> open @ 1/2 [{opening}]",
        },
    )


def test_they_wait_for_what_robots_are_at() -> None:
    for opening, cost in ((2, 2.5), (3, 6)):  # which is too late
        found = serendipity.plan(gate(opening=opening), human_model="observant", discount=0)
        assert (found.status, found.cost, found.opportunity) == ("optimal", cost, cost < 6)
    found = serendipity.plan(gate(opening=2), human_model="observant", discount=0)
    begun = [(step.epoch, step.action) for step in found.plan or ()]
    assert begun == [(1, "go h a b"), (1, "open r"), (3, "through h b d")]
    assert found.window is None
    played = serendipity.simulate(gate(opening=2), found)
    assert played.realised and [epoch.did for epoch in played.epochs] == ["go h a b", None, "through h b d"]


def test_nobody_looks_up_before_they_are_up() -> None:
    found = serendipity.plan(gate(opening=2), human_model="observant", head_start=4)
    began = [step.epoch for step in found.plan or () if step.action == "go h a b"]
    assert (began, found.horizon, found.opportunity) == ([5], 7, True)


def test_nobody_takes_part_before_they_are_up_where_nothing_takes_longer() -> None:
    about = task(init="a", goal="d", actions={"go h": "a -> d !a @ 5", "lift h r": "a -> d !a @ 1"})
    for late in range(3):
        found = serendipity.plan(about, human_model="observant", head_start=late)
        assert [step.epoch for step in found.plan or ()] == [late + 1]
        assert serendipity.verify(about, found).verdict == "proved"


@pytest.mark.parametrize("model", ["observant", "local"])
def test_what_was_waited_is_part_of_what_a_simulation_costs(model: Any) -> None:
    """It was refused: the door opens with epoch 6, or when a robot opens it."""
    about = task(init="a", goal="d", actions={"go h": "a open -> d !a @ 1", "open r": " -> open @ 2"})
    about = about.with_script(Script(facts=[(6, "open")]))
    for found, cost in (
        (serendipity.plan(about, human_model=model, waiting_cost=1, discount="0.5"), 3),
        (serendipity.plan(about, mode="individual", waiting_cost=1), 7),
    ):
        played = serendipity.simulate(about, found, model)
        assert (played.realised, played.cost, found.cost) == (True, cost, cost)
        assert played.epochs[-1].best_cost == 1, "what was waited is not still to come"
