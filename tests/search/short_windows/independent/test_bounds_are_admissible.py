"""Robots one by one: bounds on short windows against brute force, and answers where nothing else is asked."""

import threading
from dataclasses import replace
from fractions import Fraction
from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from search.call.context import SearchContext
from search.engine.best_first import Incumbent
from search.short_windows.independent import timeline
from search.short_windows.independent.short_windows import ShortWindows, short_windows
from search.spaces.windowed import Windowed
from serendipity.model import Options, Task
from serendipity.model.resources.deadline import Deadline
from serendipity_testing.builders import task as build
from serendipity_testing.generator.families import AGENTS, FAMILIES, SMALL
from serendipity_testing.oracle import best
from serendipity_testing.strategies import Call, calls, family_tasks
from tests.search.exact_answers import assert_answered
from tests.search.small_tasks import ONE_EPOCH, beside_the_plan, of_a_family


def _asked(task: Task, options: Options) -> tuple[SearchContext, ShortWindows, Incumbent] | None:
    """Short windows of a task, with ``pi_H`` as the incumbent; None where there are none."""
    found = None if task.robot_goal else beside_the_plan(task, options)
    if found is None:
        return None
    context, incumbent, question = found
    windows = short_windows(question)
    return None if windows is None else (context, windows, incumbent)


def bound_and_cost(task: Task, options: Options) -> tuple[Fraction, Fraction] | None:
    """The least that a plan with a window of one epoch may cost, and what the best that was found does."""
    asked = _asked(task, options)
    if asked is None:
        return None
    context, windows, incumbent = asked
    for _ in windows.answers():
        pass
    bound = context.keys.objective(min(windows.bound, incumbent.key)) - options.window_weight
    return bound, context.keys.cost(incumbent.key)


def admissible_bound(task: Task, options: Options) -> tuple[Fraction, Fraction] | None:
    """That bound and the optimum, where windows can be looked at so: the one is not above the other."""
    found = bound_and_cost(task, options)
    if found is None:
        return None
    optimum = best(task, options).cost
    assert optimum is not None
    assert found[0] <= optimum <= found[1]
    return found[0], optimum


def test_no_bound_is_above_the_optimum() -> None:
    exact = asked = 0
    for seed in range(150):
        dice = Random(seed)
        task = of_a_family(dice)
        options = ONE_EPOCH.but(
            discount=dice.choice(["0", "1/2", "9/10", "1"]), interference=dice.choice(["paper", "strict"])
        )
        found = admissible_bound(task, options)
        if found is not None:
            asked, exact = asked + 1, exact + (found[0] == found[1])
    assert asked > 40
    assert exact > asked * 3 / 4


@pytest.mark.long
@pytest.mark.parametrize("most", [1, 4])
def test_bounds_where_robots_have_too_many_states(monkeypatch: pytest.MonkeyPatch, most: int) -> None:
    """Then what they have for themselves is forgotten, or nothing is said of later windows."""
    forgotten = []
    forget = timeline.RobotLayers._forget
    monkeypatch.setattr(timeline, "MOST_STATES", most)
    monkeypatch.setattr(timeline.RobotLayers, "_forget", lambda self: forget(self) or forgotten.append(self))
    for seed in range(40):
        task = _errands(1 + seed % 2, 3)
        if seed > 1:
            family = sorted(FAMILIES)[seed % len(FAMILIES)]
            size, agents = SMALL[family][seed % len(SMALL[family])]
            task = FAMILIES[family](Random(seed), size, AGENTS[:agents])
        admissible_bound(task, ONE_EPOCH.but(discount="9/10"))
    assert forgotten or most == 1


def test_answers_equal_brute_force() -> None:
    """Robots one by one from the first node on, in every option."""

    @given(calls(modes=("serendipity",), of=family_tasks(), ties=False))
    def law(call: Call) -> None:
        assert_answered(replace(call, options=call.options.but(strategies="-few-nodes")))

    law()


def _errands(robots: int, places: int) -> Task:
    """Each agent goes from place to place and does something there, a robot with a tool."""
    agents = ["h", *(f"r{i}" for i in range(robots))]
    init = [f"at_{agent}_0" for agent in agents]
    actions: dict[str, str] = {}
    for agent in agents:
        tool = "" if agent == "h" else f" tool_{agent}"
        if tool:
            actions[f"take_{agent} {agent}"] = f"at_{agent}_0 ->{tool} @ 1"
        for place in range(places):
            actions[f"do_{agent}_{place} {agent}"] = f"at_{agent}_{place}{tool} -> done_{place} @ 1"
            for other in range(places):
                if place != other:
                    actions[f"go_{agent}_{place}_{other} {agent}"] = (
                        f"at_{agent}_{place} -> at_{agent}_{other} !at_{agent}_{place} @ 1"
                    )
    goal = " ".join(f"done_{place}" for place in range(1, places))
    return build(agents=" ".join(agents), init=" ".join(init), goal=goal, actions=actions)


@pytest.mark.parametrize(
    ("robots", "places", "cost"), [(1, 4, "4.3"), (2, 4, "2.6"), (2, 5, "4.5"), (2, 6, "4.8")]
)
def test_robots_who_do_not_need_one_another(robots: int, places: int, cost: str) -> None:
    """Then the bound is what the best answer costs; brute force says the same of the first three."""
    found = bound_and_cost(_errands(robots, places), ONE_EPOCH.but(discount="9/10"))
    assert found[0] == found[1] == Fraction(cost)


def test_a_call_that_robots_one_by_one_settle() -> None:
    task = _errands(2, 5)
    answer = serendipity.plan(task, discount="0.9", strategies="human-plan,bound,joint-bound,robots-apart")
    assert (answer.status, answer.cost) == ("optimal", 4.5)
    assert serendipity.check(task, answer).verdict != "refuted"


def test_an_epoch_of_many_ways_is_left_when_the_time_for_it_is_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """The short search looked at its time between nodes only, and one node may have 10,000 ways to act."""
    actions = {
        f"paint_{agent}_{thing} {agent}": f"raw_{thing} -> done_{thing} !raw_{thing} @ {cost}"
        for agent, cost in (("h", 9), ("r", 5), ("s", 7))
        for thing in range(20)
    }
    init, goal = (" ".join(name.format(thing) for thing in range(20)) for name in ("raw_{}", "done_{}"))
    task = build(agents="h r s", init=init, goal=goal, actions=actions)
    up = threading.Event()
    ends = []
    end = Windowed._end

    def offered(self: Windowed, *arguments: Any) -> None:
        ends.append(arguments)
        up.set()
        end(self, *arguments)

    monkeypatch.setattr(Windowed, "_end", offered)
    monkeypatch.setattr(Deadline, "part", lambda self, _: self.within(cancelled=up))
    answer = serendipity.plan(task, discount="0.9", strategies="human-plan,bound,few-nodes")
    assert answer.status == "feasible"
    assert 0 < len(ends) < 2_000


def test_what_another_robot_has_to_do_first() -> None:
    """It may be asked for as soon as it can have been done, for nothing."""
    task = build(
        agents="h r s",
        goal="end",
        actions={
            "one h": "-> a @ 3",
            "two h": "a -> b @ 3",
            "three h": "b -> end @ 3",
            "open s": "-> gate @ 1",
            "reach r": "gate -> end @ 1",
        },
    )
    options = ONE_EPOCH.but(discount="9/10")
    assert best(task, options).cost == Fraction("3.2")
    found = bound_and_cost(task, options)
    assert found[0] == Fraction("3.1")


@given(st.integers(0, 10**6))
def test_a_limit_leaves_a_bound(seed: int) -> None:
    """However soon it ends, no plan with a short window has a smaller key."""
    task = FAMILIES["switches"](Random(seed), 4, AGENTS[:2])
    asked = _asked(task, ONE_EPOCH)
    if asked is None:
        return
    context, windows, incumbent = asked
    optimum = best(task, ONE_EPOCH).cost
    answers = windows.answers()
    next(answers, None)
    assert optimum is not None
    bound = context.keys.objective(min(windows.bound, incumbent.key))
    assert bound <= optimum + ONE_EPOCH.window_weight
