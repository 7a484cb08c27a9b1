"""Answers over goals are proved by code of the verifier's own; doctored ones are refuted."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from search.modes.scenarios import Candidate
from serendipity.model import Certificate, Condition, Deadline, InputError, Options, Result, Task
from serendipity_testing.builders import task as build
from tests.cli.conftest import Runs
from tests.recognition.test_noise import HELPED
from tests.search.modes.goals.strategies import FIXED_OPTIONS, literals, rivals
from tests.search.modes.goals.test_worked_cases import helped, workshop
from tests.verify.claims import claim_of, verdicts
from tests.verify.scenarios.edit import Edit, assert_refuted, certified, edit, edited, together
from verify.base.optimal_plans import OptimalPlans
from verify.limits import limited
from verify.scenarios.beliefs import compiled

TASK = workshop("!q -> z @ 5")


@pytest.mark.long
@given(rivals(), FIXED_OPTIONS, st.data())
@settings(max_examples=50)
def test_every_answer_is_proved(
    rivalry: tuple[Task, list[Candidate]], options: Options, data: st.DataObject
) -> None:
    task, candidates = rivalry
    goals = [
        {"name": f"goal {k}", "goal": literals(task, c.goal), "prior": str(c.weight)}
        for k, c in enumerate(candidates)
    ]
    his = sorted({task.actions[i].name for c in candidates for i in c.plan})
    seen = data.draw(st.lists(st.sampled_from(his), max_size=2)) if his else []
    given_options = {k: v for k, v in options.to_dict().items() if k != "mode"}
    answer = serendipity.plan(task, goals=goals, observed=seen, **given_options)
    certificate = serendipity.verify(task, answer)
    assert certificate.verdict == "proved", (answer, certificate)
    wanted = "optimal" if answer.opportunity else "no_opportunity"
    assert verdicts(certificate)["infeasible" if answer.cost is None else wanted] == "proved"


def test_observations_become_a_counter() -> None:
    """With z's action seen, p costs 10: it has to be done on the way; without it, 5."""
    p = Condition((TASK.facts.index("p"),))
    costs = {}
    for embed in (True, False):
        own = compiled(TASK, p, ["keep h"], Deadline(), embed=embed)
        worth = OptimalPlans(own).alone.optimum(own.init)
        costs[embed] = None if worth is None else worth[0]
    assert costs == {True: 10, False: 5}


def _said(*changes: Edit) -> Certificate:
    """What the verifier says of the answer with these changes."""
    return certified(TASK, helped(TASK, 1, 1), *changes)


def _left_alone(answer: dict[str, Any]) -> None:
    """The answer that nothing helps."""
    for entry, cost in zip(answer["statistics"]["goals"], (5.0, 5.0), strict=True):
        human = [{"epoch": 1, "agents": ["h"], "action": entry["human_plan"][0], "cost": 5.0}]
        entry |= {"cost": cost, "window": None, "plan": human}
    answer |= {"plan": [], "cost": 5.0, "objective": 5.0, "lower_bound": 5.0, "saving": 0.0}
    answer |= {"opportunity": False, "agent_costs": {"h": 5.0, "r": 0.0}}


def _only_for_one(answer: dict[str, Any]) -> None:
    """Robots are said to idle if the goal is z."""
    entry = answer["statistics"]["goals"][1]
    entry["plan"] = [step for step in entry["plan"] if step["agents"] != ["r"]]
    entry["cost"] = 5.0


def _shared_help(answer: dict[str, Any]) -> None:
    """What robots do for all goals is said to be done with the human."""
    answer["plan"].append({"epoch": 2, "agents": ["h"], "action": "prepare h", "cost": 1.0})


SAID, FIRST = "statistics.recognition", "statistics.recognition.goals.0"

DOCTORED: dict[str, tuple[Edit, str]] = {
    "a prior": (edit(f"{FIRST}.prior", 0.6), "priors do not add up"),
    "noise": (edit(f"{SAID}.noise", {"miss": 0.1, "wrong": 0.1}), "likeliest reading"),
    "a posterior": (edit(f"{FIRST}.posterior", 0.6), "posterior is 0.5"),
    "a likelihood": (edit(f"{FIRST}.likelihood", 0.5), "likelihood is 1"),
    "a cost of recognition": (edit(f"{FIRST}.cost_with_observed", 4.0), "cost with the observations is 5.0"),
    "a plan of recognition": (edit(f"{FIRST}.plan", ["prepare h", "do1 h"]), "not the canonical one"),
    "an observation made up": (edit(f"{SAID}.observed", ["keep h"]), "cost with the observations is 10.0"),
    "a strange observation": (edit(f"{SAID}.observed", ["lift r"]), "does alone"),
    "explained denied": (edit(f"{SAID}.explained", False), "explained is true"),
    "an unknown fact": (edit(f"{FIRST}.goal", ["x"]), "no fact 'x'"),
    "a field lost": (edit(f"{FIRST}.prior", None), "prior: expected a finite number"),
    "no recognition": (edit(SAID, None), "recognition: expected an object"),
    "goals of another form": (edit("statistics.goals", {}), "goals: expected a list"),
    "another plan of his": (edit("statistics.goals.1.human_plan", ["do1 h"]), "human_plan"),
    "an action too late": (edit("statistics.goals.0.plan.0.epoch", 2), "precondition"),
    "an action lost": (edit("statistics.goals.1.plan", lambda old: old[1:]), "goal does not hold"),
    "help for one goal only": (_only_for_one, "robots do not do the same"),
    "his action in the plan": (_shared_help, "what robots do without the human"),
}


def test_right_answers_are_proved() -> None:
    assert _said().verdict == "proved"


@pytest.mark.parametrize("way", DOCTORED)
def test_doctored_answers_are_refuted(way: str) -> None:
    change, words = DOCTORED[way]
    assert_refuted(_said(change), "replay", words)


def test_help_that_is_denied_is_found() -> None:
    assert_refuted(_said(_left_alone), "no_opportunity", "cost 4, objective 1004")


def test_a_plan_that_is_broken() -> None:
    """Lifting in epoch 1 makes the second action of the human's plan for z inapplicable."""
    theirs = ["prepare h", "keep h"]
    steps = [
        {"epoch": 1, "agents": ["r"], "action": "lift r", "cost": 1.0},
        {"epoch": 1, "agents": ["h"], "action": "prepare h", "cost": 1.0},
        {"epoch": 2, "agents": ["h"], "action": "keep h", "cost": 4.0},
    ]
    entry = together(edit("statistics.goals.1.human_plan", theirs), edit("statistics.goals.1.plan", steps))
    known = edit(f"{SAID}.goals.1.plan", theirs)
    words = "scenario 'z': precondition (semantics 2): epoch 2: 'keep h': precondition: 'q' is true"
    task = workshop("ready !q -> z @ 4")
    assert_refuted(certified(task, helped(TASK, 1, 1), entry, known), "replay", words)


def test_dearer_help_is_not_the_best() -> None:
    actions = {
        "do1 h": "-> p @ 5",
        "do2 h": "q -> p @ 1",
        "keep h": "!q -> z @ 5",
        "strain r": "-> q @ 2",
        "prepare h": "-> ready @ 1",
    }
    dear = helped(build(goal="p", actions=actions), 3, 1)
    task = build(goal="p", actions=actions | {"lift r": "-> q @ 1"})
    words = "a better policy: cost 3, objective 1003"
    refuted = assert_refuted(serendipity.verify(task, dear), "optimal", words)
    assert [(step.epoch, step.action) for step in refuted.counterexample or ()] == [(1, "lift r")]


def test_rules_alone() -> None:
    answer = helped(TASK, 1, 1)
    assert verdicts(serendipity.check(TASK, answer)) == {
        "replay": "proved",
        "cost": "proved",
        "window": "proved",
        "optimal": "not_in_scope",
        "lower_bound": "not_in_scope",
    }
    assert serendipity.check(TASK, edited(answer, edit("cost", 1.0))).verdict == "refuted"


def test_one_goal_is_section_3() -> None:
    answer = helped(TASK, 1, 0)
    assert certified(TASK, answer).verdict == "proved"
    doctored = certified(TASK, answer, edit("statistics.goals.0.cost", 1.0))
    assert doctored.refuted.reason == "scenario 'p': the entry is not the answer"


def test_nobody_reaches_anything() -> None:
    task = workshop("nothing -> z")
    answer = serendipity.plan(task, goals=[{"goal": ["z"]}, {"goal": ["nothing"]}])
    assert (answer.status, answer.reason) == ("infeasible", "no-human-plan")
    assert verdicts(serendipity.verify(task, answer))["infeasible"] == "proved"
    possible = helped(TASK, 1, 1).to_dict()["statistics"]
    goals = edit("statistics.goals", possible["goals"])
    assert certified(TASK, answer, goals, edit(SAID, possible["recognition"])).verdict == "refuted"


def test_limits_leave_it_undecided() -> None:
    late = serendipity.verify(TASK, helped(TASK, 1, 1), time_limit=0)
    assert verdicts(late)["optimal"] == "undecided"
    with limited(policies=0):  # what each goal by itself allows does not settle it
        found = claim_of(_said(_left_alone), "no_opportunity")
    said = "more than 0 groups of scenarios and what they do"
    assert (found.verdict, found.reason) == ("undecided", said)


def test_bounds_of_unfinished_answers() -> None:
    feasible = edit("status", "feasible")
    assert _said(feasible, edit("lower_bound", 1003.0)).verdict == "proved"
    assert _said(feasible, _left_alone, edit("lower_bound", 4.0)).verdict == "proved"
    too_high = _said(feasible, _left_alone, edit("lower_bound", 4.5))
    assert verdicts(too_high)["lower_bound"] == "refuted"


def test_another_human_is_bad_input() -> None:
    with pytest.raises(InputError, match="another task"):
        _said(edit("human", "r"))


def test_command_line(run: Runs) -> None:
    Path("goals.txt").write_text("9: conducted_triage commx room1\n1: conducted_triage commx hall1\n")
    call = "plan --example room2 --discount 0.9 --goals goals.txt"
    text = run(f"{call} --verify").out
    assert "checker: proves replay" in text
    assert "expected cost 11.3, 1.6 less than 12.9 (proved)" in text
    saved = run(f"{call} --verify -o answer.json")
    assert (saved.code, saved.out) == (0, "")
    answer = json.loads(Path("answer.json").read_text())
    assert answer["certificate"]["verdict"] == "proved"
    assert Result.from_dict(answer).cost == 11.3
    done = run("verify --example room2 answer.json --format json")
    assert (done.code, done.err) == (0, "")
    assert json.loads(done.out)["verdict"] == "proved"
    answer["saving"] += 1
    Path("answer.json").write_text(json.dumps(answer))
    assert run("verify --example room2 answer.json").code == 1


@pytest.mark.parametrize("unit", [1, 10**6, 10**9, 10**12])
def test_posteriors_of_dear_tasks_are_certified(unit: int) -> None:
    """Their costs differ by little, or by so much that priors are lost beside the logarithms."""
    dear = build(
        agents="hum rob",
        human="hum",
        init="at_start",
        goal="left",
        actions={
            "left hum": f"at_start -> left @ {unit + 1}/3",
            "right hum": f"at_start -> right @ {unit}",
            "back hum": f"right -> left @ {unit}",
            "on hum": f"left -> right @ {unit}/7",
            "look hum": f"!seen -> seen @ {unit}/3",
            "carry rob": f"-> left @ {unit}/11",
        },
    )
    goals = [{"name": name, "goal": [name], "prior": prior} for name, prior in (("left", 7), ("right", 0.3))]
    for observed in (["left hum"], ["right hum"], ["look hum"], ["look hum", "back hum"]):
        answer = serendipity.plan(dear, goals=goals, observed=observed, discount="0.9", beta=0.37)
        assert certified(dear, answer).verdict == "proved"


def test_nothing_observed_with_noise() -> None:
    """The plan of a reading need not be the canonical one, and was taken for it."""
    ways = {"a h": "-> p @ 2", "b h": "-> p @ 2", "end h": "-> z", "lift r": "-> z"}
    task = build(goal="p", actions=ways)
    goals = [{"name": name, "goal": [name]} for name in "pz"]
    answer = serendipity.plan(task, goals=goals, noise="wrong=0.1")
    assert serendipity.verify(task, answer).verdict == "proved"


@pytest.mark.long
@given(rivals(), st.sampled_from(["wrong=0.1", "miss=0.2", "miss=0.3,wrong=0.2"]), st.data())
@settings(max_examples=40)
def test_posteriors_with_noise_are_worked_out_again(
    rivalry: tuple[Task, list[Candidate]], noise: str, data: st.DataObject
) -> None:
    task, candidates = rivalry
    goals = [{"goal": literals(task, c.goal), "prior": str(c.weight)} for c in candidates]
    for number, goal in enumerate(goals):
        goal["name"] = f"goal {number}"
    his = sorted({action.name for action in task.actions if action.participants == (task.human,)})
    seen = data.draw(st.lists(st.sampled_from(his), max_size=3)) if his else []
    answer = serendipity.plan(task, goals=goals, observed=seen, noise=noise, discount="0.5")
    assert certified(task, answer).verdict == "proved", answer


_NOISY: dict[str, tuple[Edit, str]] = {
    "another rate": (edit(f"{SAID}.noise.wrong", 0.3), "the likelihood is 0.3"),
    "no probability": (edit(f"{SAID}.noise.miss", 2.0), "expected probabilities"),
    "no noise": (edit(f"{SAID}.noise", None), "no errors without any"),
    "one more wrong": (edit(f"{FIRST}.errors.wrong", 2), "likeliest reading"),
    "one more missed": (edit(f"{FIRST}.errors.missed", 1), "likeliest reading"),
    "a cheaper reading": (edit(f"{FIRST}.errors.cost", 1.0), "likeliest reading"),
    "no reading": (edit(f"{FIRST}.errors", None), "likeliest reading"),
    "another plan": (edit(f"{FIRST}.plan", ["go h a c"]), "likeliest reading"),
    "no plan at all": (edit(f"{FIRST}.plan", ["go h a b"]), "goal does not hold"),
    "a posterior": (edit(f"{FIRST}.posterior", 0.5), "posterior is 0.9"),
    "a plan of a scenario": (edit("statistics.goals.0.human_plan", ["go h a c"]), "human_plan"),
}


@pytest.mark.parametrize("way", _NOISY)
def test_doctored_posteriors_with_noise_are_refuted(way: str) -> None:
    """Two of three observations speak for c, one for e."""
    seen, goals = ["go h a b", "go h d e", "go h b c"], [{"name": f, "goal": [f]} for f in "ce"]
    answer = serendipity.plan(HELPED, goals=goals, observed=seen, noise="wrong=0.1")
    change, words = _NOISY[way]
    assert_refuted(certified(HELPED, answer, change), "replay", words)


def test_noisy_goals_out_of_reach_are_not_told() -> None:
    """The answer had no posterior then, and named no goal: it was refuted, since nothing adds up to 1."""
    task = build(goal="f", actions={"do h": " -> f", "look r": " -> seen"})
    asked = {"goals": [{"goal": ["seen"]}], "observed": ["do h"]}
    for noise in ("wrong=0.2", None):
        answer = serendipity.plan(task, **asked, noise=noise)
        certificate = serendipity.verify(task, answer)
        assert (answer.status, certificate.verdict) == ("infeasible", "proved")
        assert serendipity.check(task, answer).verdict != "refuted"
        said = replace(answer, status="optimal", reason=None)
        assert serendipity.verify(task, said).verdict == "refuted"


def test_a_goal_may_be_named_like_a_plan_to_another_one() -> None:
    actions = {"left h": "!l !r -> l", "right h": "!l !r -> r", "lg h": "l -> g", "rg h": "r -> g"}
    other = {"other h": "!l !r -> o @ 2", "oo h": "o -> z @ 2", "fix r": "-> d"}
    task = build(goal="g", actions=actions | other)
    goals = [{"name": "a", "goal": ["g"]}, {"name": "a 1", "goal": ["z"]}]
    answer = serendipity.plan(task, goals=goals, ties="watched", discount=0.9, window_weight=0)
    assert [one.name for one in answer.goals] == ["a 2", "a 3", "a 1"]
    assert serendipity.verify(task, answer).verdict == "proved"
