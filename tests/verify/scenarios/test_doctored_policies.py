"""Policies that are none, or that are not what an answer says of them, are refuted for the right reason."""

from typing import Any

import pytest

import serendipity
from serendipity.model import Result
from serendipity_testing.builders import task as build
from tests.verify.scenarios.edit import Edit, assert_refuted, certified, edit, together
from tests.verify.scenarios.studio import TWO_ROADS, helped, studio, two_roads

P, Z = "statistics.goals.0", "statistics.goals.1"


def _step(epoch: int, action: str, cost: float) -> dict[str, Any]:
    agents = action.split()[1:]
    return {"epoch": epoch, "agents": agents, "action": action, "cost": cost}


def _without(action: str, plan: str) -> Edit:
    return edit(plan, lambda steps: [step for step in steps if step["action"] != action])


def _with(plan: str, *steps: dict[str, Any]) -> Edit:
    return edit(plan, lambda old: [*old, *steps])


def _figures(cost: float, objective: float, saving: float, human: float, robot: float) -> Edit:
    """The figures of the whole, and a bound that goes with them."""
    said = {"cost": cost, "objective": objective, "lower_bound": objective, "saving": saving}
    shares = edit("agent_costs", {"h": human, "r": robot})
    return together(*(edit(name, value) for name, value in said.items()), shares)


_ALONE_P = together(
    edit(f"{P}.window", None),
    edit(f"{P}.plan", [_step(1, "begin_p h", 1.0), _step(2, "do_p h", 5.0)]),
    edit(f"{P}.cost", 6.0),
)
_ALONE_Z = together(
    edit(f"{Z}.window", None),
    edit(f"{Z}.plan", [_step(1, "begin_z h", 1.0), _step(2, "do_z h", 5.0)]),
    edit(f"{Z}.cost", 6.0),
)
_IDLE = together(_ALONE_P, _ALONE_Z, edit("plan", []), edit("opportunity", False))
_JOINT_ALONE = together(  # nobody thinks of power, so p is left alone
    _ALONE_P, _without("power r", f"{Z}.plan"), edit(f"{Z}.cost", 4.0), edit("plan", [])
)

DOCTORED: dict[str, dict[str, tuple[Edit, str]]] = {
    "replay": {
        "power for one only": (
            together(_without("power r", f"{Z}.plan"), edit(f"{Z}.cost", 4.0)),
            "epoch 1: robots do not do the same in 'p' and 'z', which are not told apart",
        ),
        "power later for one": (edit(f"{Z}.plan.1.epoch", 3), "epoch 1: robots do not do the same"),
        "power at the time of the joint action": (edit(f"{Z}.plan.1.epoch", 2), "agent-busy-twice"),
        "fetching without power": (edit(f"{P}.plan.2.epoch", 1), "precondition"),
        "joint, and busy besides": (_with(f"{Z}.plan", _step(2, "fetch r", 1.0)), "agent-busy-twice"),
        "joint for the other": (_with(f"{P}.plan", _step(2, "together h r", 3.0)), "precondition"),
        "joint too early": (edit(f"{Z}.plan.2.epoch", 1), "precondition"),
        "robots that see nothing": (edit("options.policy", "fixed"), "epoch 2: robots do not do the same"),
        "the plan without its only step": (edit("plan", []), "by themselves up to epoch 1"),
        "the plan with more": (_with("plan", _step(2, "fetch r", 1.0)), "by themselves up to epoch 1"),
        "another plan": (edit("plan.0.epoch", 2), "by themselves up to epoch 1"),
        "the human in the plan": (_with("plan", _step(1, "begin_p h", 1.0)), "without the human"),
        "the joint action in the plan": (_with("plan", _step(2, "together h r", 3.0)), "without the human"),
        "a probability": (edit(f"{P}.probability", 0.75), "the probability is 0.5"),
        "both probabilities": (
            together(edit(f"{P}.probability", 0.75), edit(f"{Z}.probability", 0.25)),
            "the probability is 0.5",
        ),
        "a scenario left out": (edit("statistics.goals", lambda old: old[:1]), "to consider are p, z"),
        "a scenario twice": (edit("statistics.goals", lambda old: [*old, old[0]]), "to consider are p, z"),
        "scenarios in another order": (
            edit("statistics.goals", lambda old: old[::-1]),
            "to consider are p, z",
        ),
        "another name": (edit(f"{P}.name", "q"), "to consider are p, z"),
        "another goal": (edit(f"{P}.goal", ["z"]), "its goal is another one"),
        "an unknown goal": (edit(f"{P}.goal", ["x"]), "no fact 'x'"),
        "another plan of theirs": (edit(f"{P}.human_plan", ["begin_p h"]), "not the optimal plan"),
        "no plan of theirs": (edit(f"{P}.human_plan", None), "not the optimal plan"),
        "no window": (edit(f"{P}.window", None), "left alone, but the human does something else"),
        "a suffix lost": (_without("use_p h", f"{P}.plan"), "human-goal"),
        "an unknown action": (edit(f"{P}.plan.2.action", "bring r"), "unknown-action"),
        "another agent": (edit(f"{P}.plan.2.agents", ["h"]), "wrong-agents"),
        "beyond the horizon": (edit(f"{P}.plan.3.epoch", 4), "epoch-range"),
        "another horizon": (edit("horizon", 4), "the horizon is 3"),
        "a window of the whole": (edit("window", {"start": 2, "end": 3}), "single scenarios"),
        "a plan of the whole": (edit("human_plan", ["begin_p h", "do_p h"]), "single scenarios"),
        "a reason": (edit("reason", "no-plan"), "with a reason"),
        "infeasible": (edit("status", "infeasible"), "leaving the human alone is always an answer"),
        "another beginning": (
            together(_with(f"{P}.plan", _step(1, "begin_z h", 1.0)), _without("begin_p h", f"{P}.plan")),
            "precondition",
        ),
    },
    "window": {
        "a window before the help": (edit(f"{P}.window", {"start": 1, "end": 2}), "robot-in-suffix"),
        "a window after the plan": (edit(f"{P}.window", {"start": 3, "end": 4}), "window-range"),
        "a window beyond the horizon": (
            together(edit(f"{Z}.window", {"start": 2, "end": 5}), _figures(4.5, 2004.5, 1.5, 2.25, 2.25)),
            "window-range",
        ),
        "joint after the window": (edit(f"{Z}.window", {"start": 1, "end": 2}), "robot-in-suffix"),
        "a dear suffix": (
            together(
                edit(f"{P}.plan.3", _step(3, "do_p h", 5.0)),
                edit(f"{P}.cost", 8.0),
                _figures(6.5, 1006.5, -0.5, 4.25, 2.25),
            ),
            "suffix-replan",
        ),
        "another suffix that is as good": (
            edit(f"{P}.plan.3.action", "wield_p h"),
            "does not do the canonical plan",
        ),
    },
    "cost": {
        "a step's cost": (edit(f"{P}.plan.2.cost", 0.5), "step-cost"),
        "a scenario's cost": (edit(f"{P}.cost", 3.0), "scenario 'p': cost"),
        "the cost": (edit("cost", 4.0), "expected cost is 4.5"),
        "the human's cost": (edit("human_cost", 5.0), "expected human_cost is 6"),
        "the objective": (edit("objective", 504.5), "expected objective is 1004.5"),
        "the saving": (edit("saving", 2.0), "expected saving is 1.5"),
        "what is saved alone": (edit("saving_alone", 1.0), "saving_alone is 0"),
        "an agent's share": (edit("agent_costs.r", 2.0), "agent_costs of r is 2.25"),
        "a longer window": (edit(f"{P}.window", {"start": 2, "end": 4}), "expected objective is 1504.5"),
        "K": (edit("options.window_weight", 1.0), "expected objective is 5.5"),
        "the discount": (edit("options.discount", 0.5), "step-cost"),
        "the worst for the mean": (edit("options.risk", "worst"), "greatest cost is 5"),
        "regret for the mean": (edit("options.risk", "regret"), "regret's cost is 1"),
    },
    "lower_bound": {"a bound": (edit("lower_bound", 1004.0), "the objective 1004.5")},
    "optimal": {
        "a longer window, summed up": (
            together(
                edit(f"{P}.window", {"start": 2, "end": 4}),
                edit("objective", 1504.5),
                edit("lower_bound", 1504.5),
            ),
            "a better policy: cost 4.5, objective 1004.5",
        ),
        "help for one only": (
            together(_JOINT_ALONE, _figures(5.0, 1005.0, 1.0, 4.25, 0.75)),
            "a better policy: cost 4.5, objective 1004.5",
        ),
    },
    "no_opportunity": {
        "help denied": (
            together(_IDLE, _figures(6.0, 6.0, 0.0, 6.0, 0.0)),
            "a better policy: cost 4.5, objective 1004.5",
        )
    },
}
"""What has to fall, by the claim that it falls with."""


@pytest.mark.parametrize(("claim", "way"), [(claim, way) for claim in DOCTORED for way in DOCTORED[claim]])
def test_doctored_policies_are_refuted(claim: str, way: str) -> None:
    change, words = DOCTORED[claim][way]
    assert_refuted(certified(studio(), helped(), change), claim, words)


@pytest.mark.parametrize("policy", ["watching", "fixed"])
@pytest.mark.parametrize(
    ("risk", "watching", "fixed", "idle"), [("mean", 4.5, 5, 6), ("worst", 5, 6, 6), ("regret", 1, 2, 2)]
)
def test_what_is_found_is_proved_and_no_other_cost(
    risk: str, policy: str, watching: float, fixed: float, idle: float
) -> None:
    answer = helped(risk=risk, policy=policy)
    cost = watching if policy == "watching" else fixed
    assert (answer.cost, answer.human_cost, answer.opportunity) == (cost, idle, cost < idle)
    assert certified(studio(), answer).verdict == "proved"
    for name in ("cost", "human_cost"):
        assert_refuted(certified(studio(), answer, edit(name, lambda old: old + 1)), "cost")


@pytest.mark.parametrize(("risk", "idle"), [("worst", 6.0), ("regret", 2.0)])
def test_help_that_is_denied_at_any_risk(risk: str, idle: float) -> None:
    change = together(_IDLE, _figures(idle, idle, 0.0, 6.0, 0.0))
    assert_refuted(certified(studio(), helped(risk=risk), change), "no_opportunity")


def test_robots_that_are_free_are_idle_without_an_opportunity() -> None:
    actions = {"do_p h": "-> p", "do_z h": "-> z", "work r": "-> done"}
    task = build(goal="p", actions=actions)
    goals = [{"goal": [name]} for name in ("p", "z")]
    answer = serendipity.plan(task, goals=goals, horizon=2, discount=1)
    assert certified(task, answer).verdict == "proved"
    works = certified(task, answer, _with(f"{P}.plan", _step(2, "work r", 0.0)))
    assert_refuted(works, "cost", "no opportunity, but robots act")


def test_the_counterexample_is_what_robots_do_until_they_see_more() -> None:
    denied = certified(studio(), helped(), DOCTORED["no_opportunity"]["help denied"][0])
    refuted = assert_refuted(denied, "no_opportunity")
    assert [(s.epoch, s.action) for s in refuted.counterexample or ()] == [(1, "power r")]


# -- bounds


@pytest.mark.parametrize(("bound", "verdict"), [(1004.5, "proved"), (900.0, "proved"), (1004.6, "refuted")])
def test_bounds_of_unfinished_answers(bound: float, verdict: str) -> None:
    worse = together(
        DOCTORED["optimal"]["help for one only"][0], edit("status", "feasible"), edit("lower_bound", bound)
    )
    certificate = certified(studio(), helped(), worse)
    assert certificate.verdict == verdict
    assert {claim.claim for claim in certificate.claims} == {"replay", "cost", "window", "lower_bound"}


# -- scenarios that are no goals


def _library(**options: Any) -> Result:
    return serendipity.plan(two_roads(), plans=TWO_ROADS, **options)


def _watched(**options: Any) -> Result:
    return serendipity.plan(two_roads(), ties="watched", **options)


@pytest.mark.parametrize("policy", ["watching", "fixed"])
@pytest.mark.parametrize("risk", ["mean", "worst", "regret"])
def test_plans_that_are_given_or_tied(risk: str, policy: str) -> None:
    for answer, words in (
        (_library(risk=risk, policy=policy), "plans and probabilities are taken as given"),
        (_watched(risk=risk, policy=policy), "the plans are the human's optimal ones"),
    ):
        certificate = certified(two_roads(), answer)
        assert certificate.verdict == "proved", certificate
        assert certificate.claims[0].reason.startswith(words)


def test_one_plan_with_a_goal_of_its_own() -> None:
    answer = serendipity.plan(two_roads(), plans=[{"probability": 1, "goal": ["a"], "plan": ["go_a h"]}])
    assert [scenario.goal for scenario in answer.goals or ()] == [("a",)]
    assert certified(two_roads(), answer).verdict == "proved"
    assert certified(two_roads(), answer, edit(f"{P}.goal", ["b"])).verdict == "refuted"


LIBRARIES: dict[str, tuple[Edit, str]] = {
    "a share": (edit(f"{P}.probability", 0.5), "the probabilities do not add up to 1"),
    "no share": (together(edit(f"{P}.probability", 0.0), edit(f"{Z}.probability", 1.0)), "above 0"),
    "one name": (edit(f"{P}.name", "b"), "two scenarios have one name"),
    "no plan": (edit(f"{P}.human_plan", None), "expected a plan"),
    "half a plan": (edit(f"{P}.human_plan", ["go_a h", "rest h"]), "human-plan"),
    "a robot's plan": (edit(f"{P}.human_plan", ["lift_a r"]), "human-plan"),
    "another goal": (edit(f"{P}.goal", ["lb"]), "human-plan"),
}


@pytest.mark.parametrize("way", LIBRARIES)
def test_doctored_libraries_are_refuted(way: str) -> None:
    change, words = LIBRARIES[way]
    assert_refuted(certified(two_roads(), _library(), change), "replay", words)


TIED: dict[str, tuple[Edit, str]] = {
    "a plan left out": (edit("statistics.goals", lambda old: old[:3]), "the scenarios to consider are"),
    "a share": (edit(f"{P}.probability", 0.1), "the probability is"),
    "two plans exchanged": (
        edit("statistics.goals", lambda old: [old[1], old[0], *old[2:]]),
        "the scenarios to consider are plan 1, plan 2, plan 3, plan 4",
    ),
    "a plan twice": (edit(f"{P}.human_plan", ["go_b h", "rest h", "end_b h"]), "not the optimal plan"),
    "too many": (edit("options.max_ties", 3), "more than 3 optimal plans"),
    "none of them": (edit("statistics.goals", []), "the scenarios to consider are"),
    "not all of them": (edit("options.ties", "robust"), "other ties"),
}


@pytest.mark.parametrize("way", TIED)
def test_doctored_ties_are_refuted(way: str) -> None:
    change, words = TIED[way]
    assert_refuted(certified(two_roads(), _watched(), change), "replay", words)
