"""Help that costs nobody anything, and leaves little behind (semantics 12): as brute force has it."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import serendipity
from serendipity import Condition, PlanError, Result, Script, Task, UsageError
from serendipity.facade import one_plan
from serendipity_testing.builders import task as build
from serendipity_testing.call import Call
from serendipity_testing.oracle import best
from serendipity_testing.oracle.answers import Solver
from serendipity_testing.strategies import calls
from serendipity_testing.strategies.time import bystander_tasks, calls_in_time
from tests.search.exact_answers import proved

_MODES = ("serendipity", "serendipity", "communication", "composite")


def tea() -> Task:
    """Ann fetches a cup; the robot can bring the near one, which is Carol's, or the far one."""
    kitchen = build(
        agents="h r c",
        init="at0 near far",
        goal="cup",
        actions={
            "walk h": "at0 -> at1 !at0 @ 2",
            "fetch h": "at1 -> cup @ 3",
            "take h": "brought -> cup @ 1",
            "bring-near r": "near -> brought !near @ 1",
            "bring-far r": "far -> brought !far @ 2",
            "wait-for-it c": "-> waited @ 0",
            "drink c": "near waited -> drunk @ 1",
        },
    )
    carol = kitchen.agents.index("c")
    wants = Condition((kitchen.facts.index("drunk"),))
    kitchen = replace(kitchen, own_goals=((carol, wants),), known_variables=kitchen.variables)
    return kitchen.with_script(Script(people={"c": [(3, "wait-for-it c"), (4, "drink c")]}))


def brings(answer: Result) -> list[str]:
    return [step.action for step in answer.plan or () if step.action.startswith("bring")]


def test_a_bystander_does_not_pay_and_the_price_of_that_is_told() -> None:
    kind = proved(tea(), discount="0.5", window_weight=0)
    assert (kind.cost, brings(kind)) == (2.0, ["bring-far r"])
    assert (kind.figure("rule_price"), kind.statistics["rule_binds"]) == (0.5, True)
    assert "what help has to keep to costs 0.5" in str(kind)
    careless = proved(tea(), discount="0.5", window_weight=0, nobody_pays=False)
    assert (careless.cost, brings(careless)) == (1.5, ["bring-near r"])
    assert "rule_binds" not in careless.statistics


def test_an_answer_at_somebodys_cost_is_refuted() -> None:
    careless = serendipity.plan(tea(), discount="0.5", window_weight=0, nobody_pays=False)
    for binds in (True, False):
        told = replace(
            careless, options=careless.options.but(nobody_pays=True), statistics={"rule_binds": binds}
        )
        for certificate in (serendipity.verify(tea(), told), serendipity.check(tea(), told)):
            assert certificate.verdict == "refuted"
            assert "near" in str(certificate)


@pytest.mark.parametrize("ties", ["optimistic", "robust", "expected"])
def test_rules_alone_leave_no_doubt_of_an_answer_over_ties(ties: Any) -> None:
    """It was undecided whether its plan can be replayed."""
    kind = serendipity.plan(tea(), discount="0.5", ties=ties)
    assert (brings(kind), serendipity.check(tea(), kind).verdict) == (["bring-far r"], "proved")
    careless = serendipity.plan(tea(), discount="0.5", ties=ties, nobody_pays=False)
    told = replace(careless, options=careless.options.but(nobody_pays=True))
    assert serendipity.check(tea(), told).verdict == "refuted"


def test_an_answer_that_is_kinder_than_it_needs_to_be_is_refuted() -> None:
    """The dearer help is no optimum where nobody is spared by it."""
    kind = serendipity.plan(tea(), discount="0.5", window_weight=0)
    told = replace(kind, statistics={"rule_binds": False})
    assert serendipity.verify(tea(), told).verdict == "refuted"


def test_the_human_pays_no_more_for_what_robots_want() -> None:
    shop = build(
        init="here",
        goal="home",
        robot_goal="parcel",
        actions={
            "go h": "here -> home !here @ 2",
            "carry h": "here -> parcel @ 3",
            "fetch r": "-> parcel @ 20",
        },
    )
    options = {"horizon": 3, "window_weight": 0}
    assert proved(shop, **options).agent_costs == {"h": 5.0, "r": 0.0}
    fair = proved(shop, nobody_pays=True, **options)
    assert fair.agent_costs == {"h": 2.0, "r": 20.0}
    assert fair.figure("rule_price") == 17


def test_what_is_changed_is_put_back_unless_it_is_free() -> None:
    drawer = build(
        init="shut full at0",
        goal="done",
        actions={
            "work h": "at0 -> done !at0 @ 5",
            "use h": "handed -> done !handed @ 1",
            "open r": "shut -> !shut",
            "take r": "!shut full -> handed !full",
            "shut r": "!shut -> shut",
        },
    )
    options = {"discount": "0.9", "window_weight": 0, "horizon": 4}
    assert len(proved(drawer, **options).plan or ()) == 3
    tidy = proved(drawer, leave_free="at0, full", **options)
    assert [step.action for step in tidy.plan or ()][-1] in ("use h", "shut r")
    assert (len(tidy.plan or ()), round(tidy.figure("rule_price") or 0, 9)) == (4, 0.1)
    assert not proved(drawer, leave_free="at0", **options).opportunity  # the drawer is not full again


def test_nothing_is_left_changed_in_a_scenario_that_is_over() -> None:
    """The robot smears what will be smeared anyway, if the human works; if they only walk it stays so."""
    task = build(
        init="at0",
        goal="done",
        actions={
            "walk h": "at0 -> at1 !at0",
            "work h": "at1 -> done smear @ 3",
            "work-quickly h": "at1 smear -> done @ 0",
            "smear r": "-> smear",
        },
    )
    plans = [
        {"name": "work", "probability": "0.9", "goal": ["done"], "plan": ["walk h", "work h"]},
        {"name": "walk", "probability": "0.1", "goal": ["at1"], "plan": ["walk h"]},
    ]
    assert proved(task, plans=plans, discount="0.9", window_weight=0).opportunity
    assert not proved(task, plans=plans, discount="0.9", window_weight=0, leave_free="nothing").opportunity


@st.composite
def ruled(draw: st.DrawFn, asked: st.SearchStrategy[Call]) -> Call:
    """A call under the rule; patterns name any of its facts."""
    call = draw(asked)
    free = draw(st.one_of(st.none(), st.none(), st.lists(st.sampled_from(call.task.facts), unique=True)))
    leave = None if free is None else ", ".join(free) or "nothing"
    assume(call.options.horizon != "inf")
    return replace(call, options=call.options.but(nobody_pays=draw(st.booleans()), leave_free=leave))


_BESIDE = bystander_tasks().flatmap(lambda task: calls_in_time(modes=_MODES, of=st.just(task)))


@pytest.mark.long
@given(ruled(st.one_of(_BESIDE, calls(modes=_MODES))))
@settings(max_examples=50)
def test_answers_are_those_of_brute_force(call: Call) -> None:
    try:
        if call.human_plan and Solver(call.task, call.options, call.human_plan, given=True).improvable:
            return  # beside a plan that is not optimal the answer without the rule comes first
        expected = best(call.task, call.options, call.human_plan)
    except (UsageError, PlanError):
        return
    try:
        answer = serendipity.plan(call.task, human_plan=call.human_entries, **call.keywords())
    except UsageError as error:
        assert "by which nobody may have paid" in str(error)
        return
    told = (None if figure is None else float(figure) for figure in (expected.cost, expected.objective))
    found = (answer.status, answer.cost, answer.objective, answer.opportunity)
    assert found == (expected.status, *told, expected.opportunity)
    assert serendipity.check(call.task, answer).refuted is None
    assert serendipity.verify(call.task, answer).verdict == "proved"


@pytest.mark.parametrize(("task", "all_of_it"), [(serendipity.example("room2"), True), (tea(), False)])
def test_the_call_without_the_rule_has_all_the_time_while_its_answer_keeps_it(
    task: Task, all_of_it: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    left: list[float] = []
    solve = one_plan._without_rule

    def watched(call: Any, plan: Any) -> Iterator[Any]:
        for answer in solve(call, plan):
            yield answer
            left.append(call.deadline.left())

    monkeypatch.setattr(one_plan, "_without_rule", watched)
    with_idle = serendipity.plan(task, discount="0.9", time_limit=1000, nobody_pays=True)
    assert with_idle.opportunity
    assert (min(left) > 900) is all_of_it
