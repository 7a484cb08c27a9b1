"""Observations that may be wrong, of actions that may be missed: by hand, and against every reading.

And goals by what somebody began, where actions take time.
"""

import heapq
import itertools
import math
from dataclasses import replace
from fractions import Fraction
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from search.modes.scenarios import Candidate
from serendipity.model import Condition, Script, Task, UsageError
from serendipity.recognition import Noise
from serendipity_testing.builders import task as build
from serendipity_testing.oracle import Alone, Moment
from serendipity_testing.oracle.observed import costs_of_observed
from serendipity_testing.oracle.scenarios import best_policy
from serendipity_testing.strategies import tasks
from serendipity_testing.strategies.time import tasks_in_time, timed_tasks
from tests.search.exact_answers import proved
from tests.verify.scenarios.three_ways import is_small

WAYS = {f"go h {a} {b}": f"{a} -> {b} !{a}" for a, b in ("ab", "bc", "ad", "de")}
WAYS["go h a c"] = "a -> c !a @ 4"
LINE = build(init="a", goal="c", actions=WAYS)
"""To c by b (2) or directly (4), to e by d."""
HELPED = build(init="a", goal="c", actions=WAYS | {"lift r": "-> up", "ride h r": "a up -> c !a @ 0.5"})
"""The same with a robot who may help to c."""
C, E = {"goal": ["c"], "name": "c"}, {"goal": ["e"], "name": "e"}


def test_a_wrong_observation_by_hand() -> None:
    """What speaks for c twice and once for e can't be a way to e, unless two of three are wrong."""
    seen = ["go h a b", "go h d e", "go h b c"]
    assert not serendipity.recognise(LINE, [C, E], seen).explained
    known = serendipity.recognise(LINE, [C, E], seen, noise="wrong=0.1")
    c, e = known.goals
    assert c.errors is not None and e.errors is not None
    assert (c.errors.wrong, c.errors.missed, c.errors.cost, c.plan) == (1, 0, 2, ("go h a b", "go h b c"))
    assert (e.errors.wrong, e.errors.missed) == (2, 1)
    assert (c.likelihood, e.likelihood) == pytest.approx((0.1, 0.01))
    assert known.to_dict()["goals"][0]["errors"] == {"cost": 2.0, "wrong": 1, "missed": 0}
    assert known.to_dict()["noise"] == {"miss": 0.0, "wrong": 0.1}


def test_nothing_is_missed_where_all_is_wrong() -> None:
    """Where gaps weigh nothing, actions before observations that are wrong were counted as missed."""
    (c,) = serendipity.recognise(LINE, [C], ["go h d e", "go h d e"], noise="wrong=0.1").goals
    assert c.errors is not None
    assert (c.errors.wrong, c.errors.missed, c.plan) == (2, 0, ("go h a b", "go h b c"))


def test_plans_weigh_goals_by_what_may_be_wrong() -> None:
    """Without noise nothing is explained, and the posterior is the prior."""
    home = replace(HELPED, goal=Condition((HELPED.facts.index("e"),)))
    seen = ["go h a b", "go h d e", "go h b c"]
    known = serendipity.recognise(home, [C, E], seen, noise="wrong=0.1")
    found = proved(home, goals=[C, E], observed=seen, noise=Noise(wrong=0.1), discount="0.5")
    goals = found.goals or ()
    assert [one.probability for one in goals] == [one.posterior for one in known.goals]
    assert [one.human_plan for one in goals] == [one.plan for one in known.goals]
    assert found.recognition is not None and found.recognition.to_dict() == known.to_dict()
    plain = serendipity.plan(home, goals=[C, E], observed=seen, discount="0.5").goals or ()
    assert [one.probability for one in plain] == [0.5, 0.5]
    session = serendipity.Session(home, discount="0.5")
    costs = [session.plan(goals=[C, E], observed=seen, noise=noise).cost for noise in (None, "wrong=0.1")]
    assert costs == [serendipity.plan(home, goals=[C, E], observed=seen, discount="0.5").cost, found.cost]


def test_one_goal_that_is_left_has_the_plan_of_its_reading() -> None:
    seen = ["go h a d", "go h b c"]
    found = proved(HELPED, goals=[C], observed=seen, noise="wrong=0.1", discount="0.5")
    assert found.human_plan == ("go h a b", "go h b c")


def test_a_loop_weighs_goals_by_what_may_be_wrong() -> None:
    """Going to d rules c out, unless that was seen wrongly."""
    plain, noisy = (serendipity.Execution(HELPED, goals=[C, E], noise=noise) for noise in (None, "wrong=0.4"))
    for run in (plain, noisy):
        run.step("go h a d")
    seen = serendipity.recognise(HELPED, [C, E], ["go h a d"], noise="wrong=0.4").goals
    assert plain.decided.goals == {"c": 0, "e": 1}
    assert noisy.decided.goals == pytest.approx({one.name: one.posterior for one in seen})
    assert noisy.decided.goals["c"] > 0.2


def test_a_missed_action_by_hand() -> None:
    """Gaps weigh nothing, unless it is said how often actions are missed."""
    (free,) = serendipity.recognise(LINE, [C], ["go h b c"]).goals
    (noisy,) = serendipity.recognise(LINE, [C], ["go h b c"], noise=Noise(miss=0.2)).goals
    assert free.likelihood == pytest.approx(1 / (1 + math.exp(-2)))
    assert noisy.likelihood == pytest.approx((free.likelihood or 0) * 0.2)
    assert noisy.errors is not None and noisy.errors.missed == 1
    (ahead,) = serendipity.recognise(LINE, [C], ["go h a b"], noise="miss=0.2").goals
    assert ahead.likelihood == pytest.approx(free.likelihood)  # what comes later is not missed


def test_dear_plans_lose_to_readings_with_errors() -> None:
    """The direct way costs 2 more: e^-2 is less likely than that a glance was wrong."""
    (known,) = serendipity.recognise(LINE, [C], ["go h a c"], noise="wrong=0.5").goals
    assert known.plan == ("go h a b", "go h b c")
    (strict,) = serendipity.recognise(LINE, [C], ["go h a c"], noise="wrong=0.01").goals
    assert strict.plan == ("go h a c",)


@st.composite
def watched(draw: st.DrawFn) -> tuple[Task, list[str]]:
    """Some of what the human did, and some of what they did not."""
    task = replace(draw(tasks()), robot_goal=Condition())
    alone, now, names = Alone(task), Moment(task.init), []
    for _ in range(draw(st.integers(0, 3))):
        ways = list(alone.ways(now))
        if not ways:
            break
        action, _, now, _ = draw(st.sampled_from(ways))
        names += [task.actions[action].name] * draw(st.integers(0, 1))
        if draw(st.integers(0, 2)) == 0:
            names.append(task.actions[draw(st.sampled_from(task.human_actions))].name)
    return task, names


@given(watched(), st.sampled_from([0.0, 0.1, 0.6, 1.0]), st.sampled_from([0.0, 0.02, 0.5]))
def test_likelihoods_equal_those_of_every_reading(
    case: tuple[Task, list[str]], miss: float, wrong: float
) -> None:
    task, names = case
    goals = [{"goal": [*(task.facts[i] for i in task.goal.positive)]}]
    goals[0]["goal"] += [f"!{task.facts[i]}" for i in task.goal.negative]
    plain = serendipity.recognise(task, goals, names)
    noisy = serendipity.recognise(task, goals, names, noise=Noise(miss, wrong))
    if not miss and not wrong:
        assert noisy.to_json() == plain.to_json()
        return
    costs = [plain.goals[0].with_observed, plain.goals[0].without_observed]
    whole = math.fsum(math.exp(-cost) for cost in costs if cost is not None)
    best = max((_likeliest(task, read, len(names), wrong, miss) for read in _choices(names)), default=0)
    if not whole:
        assert noisy.goals[0].likelihood is None
    else:
        assert noisy.goals[0].likelihood == pytest.approx(best / whole, rel=1e-4)
        assert best / whole <= 1 + 1e-9


def _choices(names: list[str]) -> list[tuple[str, ...]]:
    every = range(len(names) + 1)
    return [kept for count in every for kept in itertools.combinations(names, count)]


def _likeliest(task: Task, right: tuple[str, ...], seen: int, wrong: float, miss: float) -> float:
    """The greatest weight of a plan in which exactly some observations are actions, by Dijkstra."""
    alone = Alone(task)
    price = -math.log(miss) if miss else 0.0
    queue = [(0.0, 0, 0, task.init)]
    closed, number = set(), 1
    while queue:
        spent, read, _, state = heapq.heappop(queue)
        if (read, state) in closed:
            continue
        closed.add((read, state))
        if read == len(right) and task.goal.holds(state):
            return math.exp(-spent) * wrong ** (seen - len(right))
        for action, _, (after, *_), _ in alone.ways(Moment(state)):
            cost = spent + float(task.actions[action].cost)
            ways = [(read, cost + (price if read < len(right) else 0))]
            if read < len(right) and task.actions[action].name == right[read]:
                ways.append((read + 1, cost))
            for now, paid in ways:
                heapq.heappush(queue, (paid, now, number, after))
                number += 1
    return 0.0


def test_noise_is_a_text_or_noise() -> None:
    with pytest.raises(UsageError, match="noise: expected Noise, or a text"):
        serendipity.recognise(LINE, [C], noise=0.1)  # type: ignore[arg-type]


SLOW_WAYS = {
    "go h a b": "a -> b !a @ 1 [3]",
    "go h b c": "b -> c !b @ 1 [2]",
    "go h a d": "a -> d !a @ 1",
    "go h a c": "a -> c !a @ 4 [4]",
}
SLOW_LINE = build(init="a", goal="c", actions=SLOW_WAYS)
GOALS = [{"name": name, "goal": [name]} for name in "cd"]


def test_what_was_begun_tells_goals_apart() -> None:
    known = serendipity.recognise(SLOW_LINE, GOALS, ["go h a b"])
    c, d = known.goals
    assert (c.posterior, d.posterior) == (1, 0)
    assert (c.with_observed, c.without_observed, c.plan) == (2, 4, ("go h a b", "go h b c"))
    quick = build(init="a", goal="c", actions={name: text.split(" [")[0] for name, text in SLOW_WAYS.items()})
    noisy = {"observed": ["go h a c", "go h b c"], "noise": "wrong=0.1"}
    assert (
        serendipity.recognise(SLOW_LINE, GOALS, **noisy).goals
        == serendipity.recognise(quick, GOALS, **noisy).goals
    )


@pytest.mark.long
@given(timed_tasks(), st.randoms(use_true_random=False))
def test_costs_are_those_of_plans_in_time(task: Task, dice: Random) -> None:
    task = replace(task, robot_goal=Condition(), known_variables=task.variables)
    seen = [task.actions[dice.choice(task.human_actions)].name] if task.human_actions else []
    goals = [{"name": fact, "goal": [fact]} for fact in task.facts[:3]]
    for one in serendipity.recognise(task, goals, seen).goals:
        aimed = task.with_goal(Condition((task.facts.index(one.name),)))
        costs = [cost for cost in (one.with_observed, one.without_observed) if cost is not None]
        alone = serendipity.plan(aimed, mode="individual").cost
        assert (float(min(costs)) if costs else None) == alone


SHOP = build(
    init="a",
    goal="c",
    actions={
        "go h a b": "a -> b !a @ 1",
        "go h a c": "a -> c !a @ 3",
        "enter h": "b open -> c !b @ 1",
        "go h a d": "a -> d !a @ 1",
    },
).with_script(Script(facts=[(3, "open")]))
"""It opens with epoch 3; who is at the door before waits."""


def test_who_goes_to_a_closed_shop_waits_until_it_opens() -> None:
    c, d = serendipity.recognise(SHOP, GOALS, ["go h a b"]).goals
    assert (c.with_observed, c.without_observed, d.with_observed) == (2, 3, None)
    answer = serendipity.plan(SHOP, goals=GOALS, observed=["go h a b"])
    assert answer.human_entries == ((1, "go h a b"), (4, "enter h"))
    assert [one.posterior for one in answer.recognition.goals] == [1, 0]
    with pytest.raises(UsageError, match="noise: where a script or durations count"):
        serendipity.recognise(SHOP, GOALS, ["go h a b"], noise="miss=0.1")


@pytest.mark.long
@settings(max_examples=settings().max_examples // 5)
@given(tasks_in_time(), st.randoms(use_true_random=False))
def test_costs_and_answers_equal_brute_force(task: Task, dice: Random) -> None:
    task = replace(task, robot_goal=Condition(), known_variables=task.variables)
    own = [task.actions[i].name for i in task.human_actions]
    seen = [dice.choice(own) for _ in range(dice.choice((1, 2)))] if own else []
    goals = [{"name": fact, "goal": [fact]} for fact in task.facts[:3]]
    aims = [Condition((fact,)) for fact in range(len(goals))]
    found = serendipity.recognise(task, goals, seen)
    for aim, one in zip(aims, found.goals if seen else (), strict=False):
        assert (one.with_observed, one.without_observed) == costs_of_observed(task, aim, seen)
    try:
        answer = serendipity.plan(task, goals=goals, observed=seen, discount=0.5, nobody_pays=False)
    except UsageError:
        return  # what a plan reaches does not last
    scenarios = []
    for entry in answer.goals or ():
        aim, times = aims[task.facts.index(entry.name)], entry.human_plan_times
        names = entry.human_plan if times is None else times.entries(entry.human_plan)
        plan = task.with_goal(aim).plan_from_names(names)
        scenarios.append(Candidate(aim, plan, Fraction(entry.probability)))
        (known,) = (one for one in found.goals if one.name == entry.name)
        assert not found.explained or task.cost_of(plan) == known.with_observed
    if is_small((task, scenarios, answer.options)):
        assert answer.cost == pytest.approx(float(best_policy(task, answer.options, scenarios).cost))
