"""A policy in time that was worked out by hand is proved, and refuted once anything in it is changed.

Who goes over a begins at once, who goes over b an epoch later, and again before they rest, for two epochs.
Lifting takes two epochs, too, and makes either way 3 cheaper.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import pytest

import serendipity
from serendipity.model import Options, PlanStep, PlanTimes, Result, Script, Task, Timing, Window
from serendipity.model.answers.result_parts import GoalAnswer
from tests.verify.scenarios.edit import Edit, assert_refuted, certified, edit
from tests.verify.scenarios.studio import two_roads

A, B = "statistics.goals.0", "statistics.goals.1"
_LONG: Final = ("rest h", "lift_a r", "lift_b r")


def slow_roads() -> Task:
    """Two roads on which resting and lifting take two epochs."""
    task = two_roads()
    actions = tuple(replace(a, timing=Timing(2)) if a.name in _LONG else a for a in task.actions)
    return replace(task, actions=actions)


def _step(epoch: int, action: str, cost: float = 1.0) -> PlanStep:
    return PlanStep(epoch, (action.split()[1],), action, cost, 2 if action in _LONG else 1)


def _scenario(name: str, share: float, start: int, lift: int, window: Window) -> GoalAnswer:
    """Somebody who goes over a road, and is helped there."""
    rest, end = start + 1 + (name == "b"), start + 3 + (name == "b")
    times = PlanTimes((start, rest, end), (1, 2, 1), end)
    names = f"go_{name} h", "rest h", f"end_{name} h"
    late = max(end, lift + 2)
    steps = [_step(start, names[0]), _step(rest, names[1]), _step(lift, f"lift_{name} r")]
    plan = tuple(sorted((*steps, _step(late, f"short_{name} h")), key=lambda step: (step.epoch, step.action)))
    return GoalAnswer(name, share, names, 4.0, window, plan, times)


def answer() -> Result:
    """What robots do who watch: from epoch 2 on they know who it is."""
    return Result(
        "serendipity",
        "optimal",
        "h",
        Options(window_weight=1000),
        human_cost=6.0,
        opportunity=True,
        cost=4.0,
        saving=2.0,
        objective=1004.0,
        lower_bound=1004.0,
        horizon=6,
        saving_alone=0.0,
        plan=(),
        agent_costs={"h": 3.0, "r": 1.0},
        goals=(_scenario("a", 0.25, 1, 2, Window(3, 4)), _scenario("b", 0.75, 2, 2, Window(4, 5))),
    )


def test_it_is_proved_and_its_proof_is_accepted(tmp_path: Path) -> None:
    assert all(claim.verdict != "refuted" for claim in serendipity.check(slow_roads(), answer()).claims)
    file = tmp_path / "proof.json"
    assert serendipity.verify(slow_roads(), answer(), proof=file).verdict == "proved"
    assert serendipity.check_proof(file, slow_roads(), answer()).verdict == "accepted"


@pytest.mark.parametrize("policy", ["watching", "fixed"])
def test_what_goes_on_where_nobody_is_helped_is_paid_for(policy: str) -> None:
    """Committed robots lift for the likelier road, and go on lifting whoever it turns out to be."""
    library = [
        {"name": "a", "probability": "1/3", "plan": ["go_a h", "rest h", "end_a h"]},
        {"name": "b", "probability": "2/3", "plan": [(2, "go_b h"), (4, "rest h"), (6, "end_b h")]},
    ]
    said = serendipity.plan(slow_roads(), plans=library, policy=policy)
    for goal in said.goals or ():
        assert goal.cost == sum(step.cost for step in goal.plan or ())
    assert certified(slow_roads(), said).verdict == "proved"


def _lifted(scenario: str, epoch: int) -> Edit:
    """A robot that lifts in another epoch."""

    def change(said: dict[str, Any]) -> None:
        goal = next(one for one in said["statistics"]["goals"] if one["name"] == scenario)
        for step in goal["plan"]:
            if step["action"] == f"lift_{scenario} r":
                step["epoch"] = epoch

    return change


DOCTORED: dict[str, tuple[tuple[Edit, ...], str, str]] = {
    "lifting before anything is seen": ((_lifted("a", 1),), "replay", "epoch 1: robots do not do the same"),
    "lifting before both are known apart": ((_lifted("b", 1),), "replay", "epoch 1: robots do not do"),
    "still lifting when the window is over": (
        (edit(f"{A}.window", {"start": 2, "end": 3}),),
        "window",
        "robot-in-suffix",
    ),
    "what is lifted too late": ((_lifted("a", 3),), "replay", "in-time"),
    "times of the plan": ((edit(f"{A}.human_plan_times.starts", [2, 3, 5]),), "replay", "times"),
    "times of the whole plan": (
        (edit(f"{A}.human_plan_times.starts", [2, 3, 5]), edit(f"{A}.human_plan_times.epochs", 5)),
        "window",
        "prefix",
    ),
    "no times": ((edit(f"{B}.human_plan_times", None),), "replay", "the horizon is 4"),
    "an epoch of what they do": ((edit(f"{A}.plan.0.epoch", 2),), "replay", "in-time"),
    "a duration": ((edit(f"{A}.plan.1.duration", 1),), "replay", "duration"),
    "a later horizon": ((edit("horizon", 7),), "replay", "the horizon is 6"),
    "a bystander": ((edit("bystanders", {"h": []}),), "replay", "bystanders"),
    "waiting that costs": ((edit("options.waiting_cost", 1.0),), "replay", "waiting_cost"),
    "a head start": ((edit("options.head_start", 1),), "replay", "head start"),
}


@pytest.mark.parametrize("way", DOCTORED)
def test_it_is_refuted_once_changed(way: str) -> None:
    changes, claim, words = DOCTORED[way]
    assert_refuted(certified(slow_roads(), answer(), *changes), claim, words)


def test_a_fact_of_the_script_that_nobody_reckons_with() -> None:
    """Who is told apart, helped, and done: and then it is undone."""
    undone = slow_roads().with_script(Script(facts=[(6, "!p")]))
    assert_refuted(certified(undone, answer()), "replay", "human-goal")
    shut = slow_roads().with_script(Script(facts=[(6, "!p"), (5, "p")]))
    assert certified(shut, answer()).verdict == "refuted"


def test_idle_robots_are_refuted_by_what_they_do_until_they_see_more() -> None:
    """Lifting that takes three epochs has to begin before anything is seen, for the likelier road."""
    actions = tuple(
        replace(a, timing=Timing(5)) if a.name.startswith("lift") else a for a in slow_roads().actions
    )
    task = replace(slow_roads(), actions=actions)
    goals = []
    for goal in answer().goals or ():
        assert goal.human_plan_times is not None and goal.human_plan is not None
        steps = zip(goal.human_plan_times.starts, goal.human_plan, (1.0, 1.0, 4.0), strict=True)
        plan = tuple(_step(*step) for step in steps)
        goals.append(replace(goal, cost=6.0, window=None, plan=plan))
    idle = replace(
        answer(),
        goals=tuple(goals),
        opportunity=False,
        cost=6.0,
        objective=6.0,
        lower_bound=6.0,
        saving=0.0,
        agent_costs={"h": 6.0, "r": 0.0},
    )
    refuted = assert_refuted(certified(task, idle), "no_opportunity", "a better policy: cost 4")
    assert [(s.epoch, s.action, s.duration) for s in refuted.counterexample or ()] == [(1, "lift_b r", 5)]
