"""Rules of help over scenarios (semantics 11 to 14): answers as brute force has them, and proved."""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import islice
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import serendipity
from search import PreparedTask
from search.modes.scenarios import Candidate
from serendipity import Condition, Options, Result, Task, Window
from serendipity.facade import leftovers_over_scenarios
from serendipity.model import Deadline
from serendipity_testing.builders import task as build
from serendipity_testing.countdown import Countdown
from serendipity_testing.generator import random_call_in_time
from serendipity_testing.oracle import human_plans
from serendipity_testing.oracle.scenarios import best_policy
from tests.endings import endings
from tests.facade.rules import RULES, policy_as_brute_force_has_it, rooms
from tests.facade.test_rules_of_help import messy
from tests.search.exact_answers import proved
from tests.search.modes.scenarios.strategies import options_over, scenarios
from tests.search.modes.scenarios.test_in_time import library


@st.composite
def in_rooms(draw: st.DrawFn) -> tuple[Task, list[Candidate]]:
    """Somebody who may go to one of some rooms, or work."""
    task, found = draw(rooms(timed=False)), []
    shares = draw(st.sampled_from([(1, 1), (1, 2), (9, 1), (1, 2, 3)]))
    wanted = [fact for fact in task.facts if fact.startswith("at h") or fact == "done"]
    for number, share in enumerate(shares):
        goal = Condition((task.facts.index(draw(st.sampled_from(wanted))),))
        ways = [*islice(human_plans(replace(task, goal=goal)), 3)]
        assume(ways)
        plan = draw(st.sampled_from(ways))
        found.append(Candidate(goal, plan, Fraction(share, sum(shares)), f"s{number}"))
    return task, found


@pytest.mark.long
@pytest.mark.parametrize("rule", RULES)
@given(st.one_of(in_rooms(), in_rooms(), scenarios()), st.data())
@settings(max_examples=25)
def test_answers_are_those_of_brute_force(
    rule: str, asked: tuple[Task, list[Candidate]], data: st.DataObject
) -> None:
    task, candidates = asked
    assume(len(candidates) > 1)
    options = data.draw(options_over(candidates)).but(**data.draw(RULES[rule]))
    if rule != "nobody pays" and (options.suffix, options.preservation) == ("replan", "kernel"):
        options = options.but(nobody_pays=data.draw(st.sampled_from([None, None, True])))
    horizon = int(options.horizon or max(len(one.plan) for one in candidates))
    assume(horizon <= 4 and len(task.actions) * horizon <= 60)
    answer = policy_as_brute_force_has_it(task, options, candidates, horizon)
    assert answer is None or serendipity.verify(task, answer).verdict == "proved"


def two_doors() -> Task:
    """The human turns left or right, and a robot can open the door there beforehand, or light the hall."""
    actions = {"walk h": "a -> b !a @ 0"}
    for way in ("left", "right"):
        actions |= {
            f"turn-{way} h": f"b -> {way} !b @ 0",
            f"force h {way}": f"{way} -> out-{way} @ 9",
            f"pass h {way}": f"{way} open-{way} -> out-{way} @ 0",
            f"open r {way}": f" -> open-{way} @ 1",
        }
    return build(agents="h r", init="a", goal="out-left", actions=actions)


def _plans(**shares: str) -> list[dict[str, Any]]:
    return [
        {
            "name": way,
            "probability": share,
            "goal": [f"out-{way}"],
            "plan": ["walk h", f"turn-{way} h", f"force h {way}"],
        }
        for way, share in shares.items()
    ]


def asked(**options: Any) -> Result:
    plans = _plans(left="0.75", right="0.25")
    return serendipity.plan(two_doors(), plans=plans, discount="0", window_weight=0, horizon=4, **options)


def test_what_is_left_costs_in_each_scenario() -> None:
    """Each door that is open costs 2: with the work of opening it 3 of the 9 that forcing it takes."""
    answer = asked(leave_price="open*=2, *=0")
    assert (answer.cost, answer.human_cost) == (3.0, 9.0)
    assert answer.statistics["left"] == {"open-left": 1.5, "open-right": 0.5}
    assert [one.cost for one in answer.goals or ()] == [3.0, 3.0]
    assert not asked(leave_price="open*=8, *=0").opportunity


@pytest.mark.parametrize(("name", "by"), [("cost", 0.5), ("objective", 0.5), ("saving", 0.5)])
def test_edited_figures_are_refuted(name: str, by: float) -> None:
    answer = asked(leave_price="open*=2, *=0")
    told = replace(answer, **{name: getattr(answer, name) + by})
    task = two_doors()
    assert serendipity.verify(task, told).verdict == serendipity.check(task, told).verdict == "refuted"


def test_help_that_costs_more_by_what_it_leaves_is_refuted() -> None:
    answer = asked(leave_price="open*=2, *=0")
    dear = answer.options.but(leave_price="open*=8.5, *=0")
    goals = tuple(replace(one, cost=9.5) for one in answer.goals or ())
    told = replace(answer, options=dear, goals=goals, cost=9.5, objective=9.5, lower_bound=9.5, saving=-0.5)
    assert serendipity.verify(two_doors(), told).verdict == "refuted"


def test_what_the_human_would_do_alone_has_no_price() -> None:
    """Of two likely goals one is a detour, by which they gain 1 alone; help that costs 8.7 there is none."""
    task = messy()
    plan = (next(i for i, action in enumerate(task.actions) if action.name == "long h"),)
    candidates = [
        Candidate(task.goal, plan, Fraction(1, 2), "done"),
        Candidate(Condition(), (), Fraction(1, 2), "nothing"),
    ]
    options = Options(discount="1", window_weight=0, leave_price="mess=3, *=0.5")
    answer = serendipity.plan(
        task,
        plans=library(task, candidates),
        discount="1",
        window_weight=0,
        leave_price="mess=3, *=0.5",
    )
    assert (answer.cost, answer.opportunity, answer.saving_alone) == (4.5, False, 0.5)
    expected = best_policy(task, options, candidates, 1)
    assert (expected.cost, expected.opportunity, expected.idle) == (Fraction(9, 2), False, (4, 4))


@pytest.mark.parametrize(
    ("risk", "price", "cost", "human_cost"),
    [
        ("worst", 2, 3, 9),
        ("worst", 8, 9, 9),  # the left door is no help, and nothing less dear than it counts
        ("regret", 2, 0, 6),  # either door is worth 6 to whom it is for
        ("regret", 8, 0, 6),  # only the right one is
    ],
)
def test_what_is_left_costs_where_the_greatest_counts(
    risk: str, price: int, cost: float, human_cost: float
) -> None:
    answer = asked(leave_price=f"open-left={price}, open-right=2, *=0", risk=risk)
    assert (answer.cost, answer.human_cost, answer.status) == (cost, human_cost, "optimal")
    assert answer.opportunity is (cost < human_cost)
    assert serendipity.verify(two_doors(), answer).verdict == "proved"
    dearer = replace(answer, cost=cost + 0.5, objective=cost + 0.5, lower_bound=cost + 0.5)
    assert serendipity.verify(two_doors(), dearer).verdict == "refuted"


@pytest.mark.parametrize("risk", ["mean", "worst", "regret"])
@pytest.mark.parametrize("rule", [{"leave_free": "at r*"}, {"leave_price": "*=9"}])
def test_a_suffix_is_chosen_whatever_it_leaves(risk: str, rule: dict[str, Any]) -> None:
    """With what they need at hand they stay where they are, and would have to be where they meant to go."""
    actions = {"give h r": "mid !done -> done @ 1"}
    for side in ("left", "right"):
        actions |= {f"go h {side}": f"mid -> {side} !mid @ 1", f"work h {side}": f"{side} -> done @ 5"}
    task = build(agents="h r", init="mid", goal="done", actions=actions)
    plans = [
        {"name": s, "probability": "0.5", "plan": [f"go h {s}", f"work h {s}"]} for s in ("left", "right")
    ]
    options = {"discount": "1", "window_weight": "0.25", "suffix": "subplan", "horizon": 2, "risk": risk}
    answer = proved(task, plans=plans, **options, **rule)
    assert {goal.window for goal in answer.goals or ()} == {Window(1, 3)}


def test_each_scenario_is_held_to_what_may_disturb_in_it() -> None:
    task = serendipity.example("room2")
    goals = [
        {"name": "triage", "goal": ["conducted_triage commx room1"]},
        {"name": "home", "goal": ["at commx hall1"]},
    ]
    free = serendipity.plan(task, goals=goals, discount="0.9", window_weight=0)
    calm = proved(task, goals=goals, discount="0.9", window_weight=0, max_disturbance=0)
    assert free.opportunity
    assert (free.cost or 0) <= (calm.cost or 0)
    told = replace(free, options=calm.options)
    assert "scenario 'triage': disturbance (semantics 13)" in str(serendipity.verify(task, told))


def _regretted(seed: int, *goals: str, **options: Any) -> tuple[Task, Result]:
    """What is answered in time, at a price for what is left, where regret counts."""
    task = replace(random_call_in_time(seed).task, robot_goal=Condition())
    asked = {"leave_price": "*=0.1", "discount": "0.9", "window_weight": 0, **options}
    wanted = [{"name": name, "goal": [name]} for name in goals]
    return task, serendipity.plan(task, goals=wanted, risk="regret", **asked)


@pytest.mark.long
def test_what_robots_go_on_with_is_paid_for_in_each_scenario() -> None:
    """Its second epoch, which costs 0.2, is no step of theirs: regret was counted without it."""
    task, answer = _regretted(7153, "at2", "at1")
    assert (answer.cost, answer.human_cost, answer.saving) == (0, 1.5, 1.5)
    assert serendipity.verify(task, answer).verdict == "proved"


class _Apart(Deadline):
    """Leaves what a scenario allows by itself so many looks, and all else as much time as it needs."""

    looks = 0

    def part(self, share: float) -> Deadline:
        """See :class:`Deadline`."""
        return Countdown(self.looks) if share == 0.25 else self


@pytest.mark.long
@pytest.mark.parametrize(("seed", "goals"), [(7004, ("f0", "f1")), (7027, ("at1", "at2"))])
def test_regret_at_a_limit_is_no_less_than_it_is(seed: int, goals: tuple[str, ...]) -> None:
    """What a scenario allows was taken for proved there; what is saved was to be known, and it crashed."""

    def unsure(looks: int) -> tuple[Task, Result]:
        limit = _Apart()
        limit.looks = looks
        return _regretted(seed, *goals, deadline=limit)

    found = endings(lambda limit: _regretted(seed, *goals, deadline=limit), sparser=5)
    results = [ending for ending in found if isinstance(ending, tuple)]
    results += [unsure(2**k) for k in range(13)]
    told = {(one.status, one.cost, one.human_cost, one.saving): (task, one) for task, one in results}
    assert {status for status, *_ in told} == {"unknown", "feasible", "optimal"}
    for task, one in told.values():
        assert one.goals is None or serendipity.verify(task, one).refuted is None


def test_what_a_limit_leaves_open_of_one_scenario_proves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search calls it optimal, with a bound below; regret was counted from it, and called proved."""
    solve = leftovers_over_scenarios.solve_scenarios

    def limited(prepared: PreparedTask, options: Options, candidates: Any, *rest: Any) -> Iterator[Any]:
        for found in solve(prepared, options, candidates, *rest):
            yield found if len(candidates) > 1 else found._replace(lower_bound=Fraction(0))

    monkeypatch.setattr(leftovers_over_scenarios, "solve_scenarios", limited)
    assert asked(leave_price="open*=2, *=0", risk="regret").status == "feasible"
