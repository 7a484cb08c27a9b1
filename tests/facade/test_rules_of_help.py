"""What rules of help allow (semantics 12 to 14): as brute force has it, and proved; and the front.

It leaves a person in peace, they notice it before they act on it, and what it leaves changed has a price.
"""

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from serendipity import Condition, Options, Result, Task
from serendipity.facade.front import drawn
from serendipity_testing import strategies
from serendipity_testing.builders import Builder
from serendipity_testing.builders import task as build
from serendipity_testing.generator import random_call
from serendipity_testing.oracle import best
from serendipity_testing.oracle.truth import Truth
from serendipity_testing.strategies.time import tasks_in_time
from tests.endings import endings
from tests.facade.rules import RULES, proved_as_brute_force_has_it, rooms, rooms_in_time
from tests.search.exact_answers import proved

_ASKED = {
    "discount": st.sampled_from(["0.5", "0.9", "1"]),
    "window_weight": st.sampled_from(["0", "0.25", "1000"]),
}
_MODES = {
    "mode": st.sampled_from(["serendipity", "serendipity", "communication", "composite"]),
    "suffix": st.sampled_from(["replan", "subplan"]),
}
_STRICT = {"interference": st.sampled_from(["paper", "strict"])}
CALLS = {
    "noticed": (st.one_of(rooms(timed=False), strategies.tasks()), _ASKED | _STRICT),
    "disturbance": (rooms(), _ASKED | _STRICT | _MODES),
    "leftovers": (st.one_of(rooms(), strategies.tasks()), _ASKED | _MODES),
}
"""Tasks and options to ask for each rule with."""


@pytest.mark.long
@pytest.mark.parametrize("rule", CALLS)
@given(st.data())
@settings(max_examples=60)
def test_answers_are_those_of_brute_force(rule: str, data: st.DataObject) -> None:
    tasks, asked = CALLS[rule]
    task, options = data.draw(tasks), Options(**data.draw(st.fixed_dictionaries(asked)))
    if rule == "leftovers":
        task = replace(task, robot_goal=Condition(), known_variables=task.variables)
        alone = serendipity.plan(task, mode="individual").cost
        options = options.but(horizon=4 if alone is None else None)
    answer = proved_as_brute_force_has_it(task, options.but(**data.draw(RULES[rule])))
    most = answer.options.max_disturbance
    assert most is None or (answer.figure("disturbance") or 0) <= most


def test_a_plan_that_disturbs_more_than_it_may_is_refuted() -> None:
    task = serendipity.example("room2")
    answer = serendipity.plan(task, discount="0.9", max_disturbance=1)
    assert answer.figure("disturbance") == 1
    told = replace(answer, options=answer.options.but(max_disturbance=0))
    for certificate in (serendipity.verify(task, told), serendipity.check(task, told)):
        assert "help disturbs the human by 1, and may by 0" in str(certificate)


@pytest.mark.parametrize(
    "name", ["room2", "room7", pytest.param("flights", marks=pytest.mark.long), "parcels", "office"]
)
def test_each_point_of_a_front_is_proved_and_none_dominated(name: str) -> None:
    task, options = serendipity.example(name), {"discount": "0.9", "window_weight": 0}
    front = serendipity.front(task, discount="0.9", verify=True)
    assert front.complete
    assert all(point.certificate and point.certificate.verdict == "proved" for point in front.points)
    assert all(a.disturbance < b.disturbance and a.saving < b.saving for a, b in pairwise(front.points))
    assert front.points[-1].result.cost == serendipity.plan(task, **options).cost
    assert front.points[0].result.cost == serendipity.plan(task, max_disturbance=0, **options).cost
    assert drawn(front, ".svg").count("<circle") == len(front.points)


def test_each_point_of_a_front_over_goals_is_proved() -> None:
    """What disturbs is the most of either goal; each end is what the single calls say."""
    task, options = serendipity.example("room2"), {"discount": "0.9", "window_weight": 0}
    goals = [
        {"name": "triage", "goal": ["conducted_triage commx room1"]},
        {"name": "home", "goal": ["at commx hall1"]},
    ]
    front = serendipity.front(task, goals=goals, discount="0.9", verify=True)
    assert front.complete and len(front.points) > 1
    assert all(point.certificate and point.certificate.verdict == "proved" for point in front.points)
    assert all(a.disturbance < b.disturbance and a.saving < b.saving for a, b in pairwise(front.points))
    ends = {0: {"max_disturbance": 0}, -1: {}}
    for at, most in ends.items():
        assert front.points[at].result.cost == serendipity.plan(task, goals=goals, **options, **most).cost


_LATE = {"head_start": st.sampled_from([0, 0, 0, 1, 2]), "waiting_cost": st.sampled_from(["0", "0", "0.5"])}


@pytest.mark.long
@given(
    st.one_of(rooms(), rooms_in_time(), rooms_in_time(), tasks_in_time()),
    st.fixed_dictionaries(_ASKED | _STRICT | _LATE),
    RULES["noticed"],
)
def test_what_is_noticed_in_time_is_that_of_brute_force(
    task: Task, asked: dict[str, Any], rule: dict[str, Any]
) -> None:
    robots = task.with_goal(task.goal, Condition())
    proved_as_brute_force_has_it(robots, Options(**asked | rule))


def test_they_do_not_go_for_what_is_brought_elsewhere_at_that_moment() -> None:
    """In ``room5`` they pass by room5 in the epoch in which the robot drops the medkit elsewhere."""
    task = serendipity.example("room5")
    free = serendipity.plan(task, discount="0.9")
    bound = serendipity.plan(task, discount="0.9", noticed=True)
    assert (free.cost, bound.cost, bound.figure("rule_price")) == (11.5, 13, 1.5)
    told = replace(free, options=free.options.but(noticed=True))
    for certificate in (serendipity.verify(task, told), serendipity.check(task, told)):
        assert "noticed (semantics 14): the human has not seen" in str(certificate)


def _lit(epochs: int) -> Task:
    """Work is quick by the lamp of p0, where Ann is until her walk begins; to light it takes some epochs."""
    made = Builder(("ann", "bot"))
    made.named("walk ann p0 p1", (0,), "at_ann_p0", "!at_ann_p0 / at_ann_p1", "1", 2)
    made.named("walk ann p1 p0", (0,), "at_ann_p1", "!at_ann_p1 / at_ann_p0", "1", 2)
    made.named("work ann p1", (0,), "at_ann_p1", "done", "5")
    made.named("work-lit ann p1", (0,), "at_ann_p1 lit_p0", "done", "1")
    made.named("light bot p0", (1,), "", "lit_p0", "1", epochs)
    return made.task("at_ann_p0", "done")


@pytest.mark.parametrize(("epochs", "cost"), [(1, 2.5), (2, 6)])
def test_they_see_what_ends_before_their_walk_begins(epochs: int, cost: float) -> None:
    task = _lit(epochs)
    free = serendipity.plan(task, discount="0.5", window_weight=0)
    bound = serendipity.plan(task, discount="0.5", window_weight=0, noticed=True)
    assert (free.cost, bound.cost) == (2.5, cost)
    told = replace(free, options=bound.options)
    verdict = "proved" if epochs == 1 else "refuted"
    assert serendipity.verify(task, told).verdict == serendipity.check(task, told).verdict == verdict


@pytest.mark.parametrize("ties", ["fixed", "robust"])
def test_who_has_left_their_plan_goes_on_with_what_they_begin(ties: str) -> None:
    """What is due after it has a variant on their plan and one off it; the verifier looked at the first."""
    ways = {"walk h": "-> b !a @ 3", "go h": "b -> c !b [2]", "end h": "c -> d", "jump h": "k -> c"}
    help_ = {"carry h r": "-> b !a", "open r": "-> k"}
    carried = build(agents="h r", human="h", init="a", goal="d", actions=ways | help_)
    assert proved(carried, leave_free="nothing", noticed=True, ties=ties).cost == 3


def test_who_passes_by_is_in_nobodys_way() -> None:
    """The bot may work where Ann is on her way to, but not take what she takes up in that epoch."""
    actions = {
        "leave ann": "at_ann_p0 key -> at_ann_p1 !at_ann_p0 @ 1",
        "work ann": "at_ann_p1 -> done @ 5",
        "work-lit ann": "at_ann_p1 lit_p1 -> done @ 1",
        "light bot": "-> lit_p1 @ 1",
        "lose bot": "-> lit_p1 !key @ 0",
    }
    task = build(agents="ann bot", human="ann", init="at_ann_p0 key", goal="done", actions=actions)
    asked = {"discount": "0", "window_weight": 0, "max_disturbance": 0}
    costs = {}
    for interference in ("paper", "strict"):
        costs[interference] = proved(task, **asked, interference=interference).cost
    assert costs == {"paper": 2, "strict": 3}


def test_what_is_handed_over_needs_no_notice() -> None:
    answer = serendipity.plan(serendipity.example("room2"), discount="0.9", noticed=True)
    assert (answer.cost, answer.statistics["rule_binds"]) == (11.4, False)


_KITE = "at kite *=0.5, *=0"


def test_what_is_left_is_told_and_paid_for() -> None:
    answer = serendipity.plan(serendipity.example("flights"), discount="0.9", leave_price=_KITE)
    free = serendipity.plan(serendipity.example("flights"), discount="0.9")
    assert (free.cost, answer.cost, answer.figure("rule_price")) == (10.8, 11.8, 1)
    assert answer.statistics["left"] == {"at kite harbour": 0.5, "at kite ridge": 0.5}
    assert "left changed, at a price: at kite harbour (0.5), at kite ridge (0.5)" in str(answer)


@pytest.mark.parametrize(("name", "by"), [("cost", 0.5), ("objective", 0.5), ("saving", 0.5)])
def test_edited_figures_are_refuted(name: str, by: float) -> None:
    task = serendipity.example("flights")
    answer = serendipity.plan(task, discount="0.9", leave_price=_KITE)
    told = replace(answer, **{name: getattr(answer, name) + by})
    assert serendipity.verify(task, told).verdict == serendipity.check(task, told).verdict == "refuted"


def test_a_dearer_answer_is_refuted() -> None:
    """Doing nothing, where help pays with what it leaves; and help, where with that it does not."""
    task = serendipity.example("flights")
    nothing = serendipity.plan(task, discount="0.9", leave_price="at kite *=9, *=0")
    assert not nothing.opportunity
    options = nothing.options.but(leave_price=_KITE)
    assert serendipity.verify(task, replace(nothing, options=options)).verdict == "refuted"
    helped = serendipity.plan(task, discount="0.9", leave_price=_KITE)
    told = replace(helped, cost=28.8, objective=1028.8, lower_bound=1028.8, saving=-10.8)
    assert serendipity.verify(task, replace(told, options=nothing.options)).verdict == "refuted"


@pytest.mark.parametrize("mode", ["serendipity", "communication"])
def test_what_a_given_plan_wastes_is_told_where_something_is_put_back(mode: str) -> None:
    task = build(
        init="home",
        goal="done",
        actions={
            "long h": " -> done @ 9",
            "short h": " -> done @ 8",
            "quick h": "open -> done @ 1",
            "wait h": " -> waited @ 0",
            "go r": "home -> away !home @ 0",
            "open r": "away -> open",
            "back r": "away -> home !away @ 0",
        },
    )
    plan = ["wait h", "wait h", "long h"]
    answer = proved(task, mode=mode, human_plan=plan, leave_price="home=2, *=0.5")
    assert answer.statistics["left"] == {"open": 0.5}
    assert (answer.cost, answer.saving, answer.saving_alone) == (2.5, 6.5, 1)


def messy() -> Task:
    """The human's plan is dearer than a way that leaves a mess; what a robot opens makes possible a third."""
    return build(
        goal="done",
        actions={
            "long h": " -> done @ 9",
            "short h": " -> done mess @ 8",
            "quick h": "open -> done @ 8.2",
            "open r": " -> open @ 0",
        },
    )


def test_what_the_human_would_do_alone_has_no_price() -> None:
    """They gain 1 alone, whatever they leave then; help that costs 8.7 is no match for that."""
    asked = {"discount": "1", "window_weight": 0, "leave_price": "mess=3, *=0.5"}
    answer = proved(messy(), human_plan=["long h"], **asked)
    assert (answer.cost, answer.opportunity, answer.saving_alone) == (9, False, 1)
    plan = (next(i for i, action in enumerate(messy().actions) if action.name == "long h"),)
    expected = best(messy(), Options(**asked), plan)
    assert (expected.cost, expected.opportunity, expected.saving_alone) == (9, False, 1)


@pytest.mark.parametrize(
    ("short", "expected"),
    [
        pytest.param("5", (2, True, 4), id="the-rule-binds-and-help-beats-them"),
        pytest.param("1.8", (9, False, Fraction("7.2")), id="it-binds-and-they-do-better-alone"),
        pytest.param("1", (9, False, 8), id="nothing-helps-with-it-or-without"),
    ],
)
@pytest.mark.parametrize(
    "rule", [{"leave_free": "nothing"}, {"leave_price": "*=9"}, {"leave_price": "open=3"}]
)
def test_what_they_gain_alone_keeps_no_rule(
    short: str, expected: tuple[Any, ...], rule: dict[str, str]
) -> None:
    """Their short way leaves a mess: it is what help has to beat, though help may leave none."""
    task = build(
        goal="done",
        actions={
            "long h": " -> done @ 9",
            "short h": f" -> done mess @ {short}",
            "quick h": "open -> done @ 1",
            "open r": " -> open",
            "shut r": "open -> !open",
        },
    )
    asked = {"discount": "0.5", "window_weight": 0, "horizon": 3, **rule}
    answer = proved(task, human_plan=["long h"], **asked)
    assert (answer.cost, answer.opportunity, answer.saving_alone) == tuple(map(float, expected))
    plan = (next(i for i, action in enumerate(task.actions) if action.name == "long h"),)
    found = best(task, Options(**asked), plan)
    assert (found.cost, found.opportunity, found.saving_alone) == expected
    told = replace(answer, saving_alone=(answer.saving_alone or 0) - 0.5)
    assert serendipity.verify(task, told).verdict == "refuted"


@pytest.mark.parametrize(
    ("seed", "rule"),
    [
        (33, {"nobody_pays": True, "leave_free": "*0*"}),
        (484, {"leave_free": "nothing"}),
        (515, {"leave_free": "*1*"}),
        (901, {"leave_free": "nothing"}),
        (1480, {"leave_price": "*0*=0.07, *1*=1.13"}),
    ],
)
def test_what_they_gain_alone_is_what_brute_force_says(seed: int, rule: dict[str, Any]) -> None:
    call = random_call(seed)
    task = replace(call.task, robot_goal=Condition())
    answer = proved(task, **call.keywords() | {"ties": "fixed"} | rule, human_plan=call.human_plan)
    assert Truth(task).fault(answer) is None


@pytest.mark.long
@pytest.mark.parametrize("seed", [33, 1480])
def test_what_they_gain_alone_is_told_at_a_limit_only_where_it_is_known(seed: int) -> None:
    call, rule = random_call(seed), {"ties": "fixed", "leave_price": "*0*=0.07, *1*=1.13"}
    task = replace(call.task, robot_goal=Condition())
    asked = {**call.keywords(), **rule, "human_plan": call.human_plan}
    *found, last = endings(lambda limit: serendipity.plan(replace(task), deadline=limit, **asked))
    for result in found:
        if isinstance(result, Result) and result.status != "unknown":
            assert result.saving_alone in (None, last.saving_alone)
            assert serendipity.verify(task, result).refuted is None


def test_a_price_that_makes_help_a_tie_is_proved() -> None:
    """Joint plans of the same total were refuted: without the price of what they leave they would be help."""
    built = build(
        agents="hum bot",
        human="hum",
        init="at0",
        goal="at2",
        actions={
            "open0 bot": "-> open0 tired",
            "stroll0 hum": "-> at1 !at0",
            "walk1 hum": "at1 -> at2 !at1 @ 3 | open0 -> at2 !at1 @ 3",
        },
    )
    asked = {"discount": "0.9", "window_weight": 0, "leave_price": "*=0.3"}
    for mode in ("composite", "communication", "serendipity"):
        answer = proved(built, mode=mode, **asked)
        assert (answer.cost, answer.saving, answer.opportunity) == (4, 0, False)
        for told in (replace(answer, saving=0.5), replace(answer, opportunity=True)):
            assert serendipity.verify(built, told).verdict == "refuted"
