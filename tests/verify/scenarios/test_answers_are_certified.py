"""Answers over goals are proved by code of the verifier's own; doctored ones are refuted."""

import json
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from search.modes.scenarios import Candidate
from serendipity.model import Certificate, Condition, Deadline, InputError, Options, Result, Task
from serendipity.testing.builders import task as build
from tests.cli.conftest import Runs
from tests.recognition.test_noise import HELPED
from tests.search.modes.goals.strategies import FIXED_OPTIONS, literals, rivals
from tests.search.modes.goals.test_worked_cases import helped, workshop
from tests.verify.scenarios.edit import assert_refuted, edit
from verify.base.optimal_plans import OptimalPlans
from verify.limits import limited
from verify.scenarios.beliefs import compiled


def _verdicts(certificate: Certificate) -> dict[str, tuple[str, str]]:
    return {claim.claim: (claim.verdict, claim.reason) for claim in certificate.claims}


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
    assert _verdicts(certificate)["infeasible" if answer.cost is None else wanted][0] == "proved"


def test_observations_become_a_counter() -> None:
    """With z's action seen, p costs 10: it has to be done on the way; without it, 5."""
    task = workshop("!q -> z @ 5")
    p = Condition((task.facts.index("p"),))
    costs = {}
    for embed in (True, False):
        own = compiled(task, p, ["keep h"], Deadline(), embed=embed)
        worth = OptimalPlans(own).alone.optimum(own.init)
        costs[embed] = None if worth is None else worth[0]
    assert costs == {True: 10, False: 5}


def _answer() -> tuple[Task, dict[str, Any]]:
    task = workshop("!q -> z @ 5")
    answer = helped(task, 1, 1)
    assert serendipity.verify(task, answer).verdict == "proved"
    return task, deepcopy(answer.to_dict())


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


DOCTORED: dict[str, tuple[Callable[[dict[str, Any]], None], str, str]] = {
    "a prior": (edit("statistics.recognition.goals.0.prior", 0.6), "replay", "priors do not add up"),
    "noise": (
        edit("statistics.recognition.noise", {"miss": 0.1, "wrong": 0.1}),
        "replay",
        "likeliest reading",
    ),
    "a posterior": (edit("statistics.recognition.goals.0.posterior", 0.6), "replay", "posterior is 0.5"),
    "a likelihood": (edit("statistics.recognition.goals.0.likelihood", 0.5), "replay", "likelihood is 1"),
    "a cost of recognition": (
        edit("statistics.recognition.goals.0.cost_with_observed", 4.0),
        "replay",
        "cost with the observations is 5.0",
    ),
    "a plan of recognition": (
        edit("statistics.recognition.goals.0.plan", ["prepare h", "do1 h"]),
        "replay",
        "not the canonical one",
    ),
    "an observation made up": (
        edit("statistics.recognition.observed", ["keep h"]),
        "replay",
        "cost with the observations is 10.0",
    ),
    "a strange observation": (edit("statistics.recognition.observed", ["lift r"]), "replay", "does alone"),
    "explained denied": (edit("statistics.recognition.explained", False), "replay", "explained is true"),
    "an unknown fact": (edit("statistics.recognition.goals.0.goal", ["x"]), "replay", "no fact 'x'"),
    "a field lost": (
        edit("statistics.recognition.goals.0.prior", None),
        "replay",
        "prior: expected a finite number",
    ),
    "no recognition": (edit("statistics.recognition", None), "replay", "recognition: expected an object"),
    "goals of another form": (edit("statistics.goals", {}), "replay", "goals: expected a list"),
    "another plan of his": (edit("statistics.goals.1.human_plan", ["do1 h"]), "replay", "human_plan"),
    "an action too late": (edit("statistics.goals.0.plan.0.epoch", 2), "replay", "precondition"),
    "an action lost": (edit("statistics.goals.1.plan", lambda old: old[1:]), "replay", "goal does not hold"),
    "help for one goal only": (_only_for_one, "replay", "robots do not do the same"),
    "his action in the plan": (_shared_help, "replay", "what robots do without the human"),
    "an opportunity denied": (_left_alone, "no_opportunity", "cost 4, objective 1004"),
}


@pytest.mark.parametrize("way", DOCTORED)
def test_doctored_answers_are_refuted(way: str) -> None:
    task, answer = _answer()
    doctor, claim, words = DOCTORED[way]
    doctor(answer)
    assert_refuted(serendipity.verify(task, Result.from_dict(answer)), claim, words)


def test_a_plan_that_is_broken() -> None:
    """Lifting in epoch 1 makes the second action of the human's plan for z inapplicable."""
    task = workshop("ready !q -> z @ 4")
    answer = deepcopy(helped(workshop("!q -> z @ 5"), 1, 1).to_dict())
    entry = answer["statistics"]["goals"][1]
    entry["human_plan"] = ["prepare h", "keep h"]
    entry["plan"] = [
        {"epoch": 1, "agents": ["r"], "action": "lift r", "cost": 1.0},
        {"epoch": 1, "agents": ["h"], "action": "prepare h", "cost": 1.0},
        {"epoch": 2, "agents": ["h"], "action": "keep h", "cost": 4.0},
    ]
    answer["statistics"]["recognition"]["goals"][1]["plan"] = ["prepare h", "keep h"]
    words = "scenario 'z': precondition (semantics 2): epoch 2: 'keep h': precondition: 'q' is true"
    assert_refuted(serendipity.verify(task, Result.from_dict(answer)), "replay", words)


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
    task, answer = _answer()
    verdicts = _verdicts(serendipity.check(task, Result.from_dict(answer)))
    assert {name: verdict for name, (verdict, _) in verdicts.items()} == {
        "replay": "proved",
        "cost": "proved",
        "window": "proved",
        "optimal": "not_in_scope",
        "lower_bound": "not_in_scope",
    }
    answer["cost"] = 1.0
    assert serendipity.check(task, Result.from_dict(answer)).verdict == "refuted"


def test_one_goal_is_section_3() -> None:
    task = workshop("!q -> z @ 5")
    answer = helped(task, 1, 0)
    assert serendipity.verify(task, answer).verdict == "proved"
    doctored = deepcopy(answer.to_dict())
    doctored["statistics"]["goals"][0]["cost"] = 1.0
    refuted = serendipity.verify(task, Result.from_dict(doctored)).refuted
    assert refuted.reason == "scenario 'p': the entry is not the answer"


def test_nobody_reaches_anything() -> None:
    task = workshop("nothing -> z")
    answer = serendipity.plan(task, goals=[{"goal": ["z"]}, {"goal": ["nothing"]}])
    assert (answer.status, answer.reason) == ("infeasible", "no-human-plan")
    assert _verdicts(serendipity.verify(task, answer))["infeasible"][0] == "proved"
    possible = deepcopy(answer.to_dict())
    for name in ("recognition", "goals"):
        possible["statistics"][name] = helped(workshop("!q -> z @ 5"), 1, 1).to_dict()["statistics"][name]
    assert serendipity.verify(workshop("!q -> z @ 5"), Result.from_dict(possible)).verdict == "refuted"


def test_limits_leave_it_undecided() -> None:
    task, doctored = _answer()
    answer = helped(task, 1, 1)
    assert _verdicts(serendipity.verify(task, answer, time_limit=0))["optimal"][0] == "undecided"
    _left_alone(doctored)  # what each goal by itself allows does not settle it
    with limited(policies=0):
        certificate = serendipity.verify(task, Result.from_dict(doctored))
    assert _verdicts(certificate)["no_opportunity"] == (
        "undecided",
        "more than 0 groups of scenarios and what they do",
    )


def test_bounds_of_unfinished_answers() -> None:
    task, answer = _answer()
    answer |= {"status": "feasible", "lower_bound": 1003.0}
    assert serendipity.verify(task, Result.from_dict(answer)).verdict == "proved"
    _left_alone(answer)
    answer["lower_bound"] = 4.0
    assert serendipity.verify(task, Result.from_dict(answer)).verdict == "proved"
    answer["lower_bound"] = 4.5
    assert _verdicts(serendipity.verify(task, Result.from_dict(answer)))["lower_bound"][0] == "refuted"


def test_another_human_is_bad_input() -> None:
    task, answer = _answer()
    answer["human"] = "r"
    with pytest.raises(InputError, match="another task"):
        serendipity.verify(task, Result.from_dict(answer))


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
        assert (
            serendipity.verify(dear, Result.from_dict(json.loads(json.dumps(answer.to_dict())))).verdict
            == "proved"
        )


def test_nothing_observed_with_noise() -> None:
    """The plan of a reading need not be the canonical one, and was taken for it."""
    ways = {"a h": "-> p @ 2", "b h": "-> p @ 2", "end h": "-> z", "lift r": "-> z"}
    task = build(goal="p", actions=ways)
    goals = [{"name": name, "goal": [name]} for name in "pz"]
    assert (
        serendipity.verify(task, serendipity.plan(task, goals=goals, noise="wrong=0.1")).verdict == "proved"
    )


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
    read = Result.from_dict(json.loads(json.dumps(answer.to_dict())))
    assert serendipity.verify(task, read).verdict == "proved", answer


_NOISY: dict[str, tuple[Callable[[dict[str, Any]], None], str]] = {
    "another rate": (edit("statistics.recognition.noise.wrong", 0.3), "the likelihood is 0.3"),
    "no probability": (edit("statistics.recognition.noise.miss", 2.0), "expected probabilities"),
    "no noise": (edit("statistics.recognition.noise", None), "no errors without any"),
    "one more wrong": (edit("statistics.recognition.goals.0.errors.wrong", 2), "likeliest reading"),
    "one more missed": (edit("statistics.recognition.goals.0.errors.missed", 1), "likeliest reading"),
    "a cheaper reading": (edit("statistics.recognition.goals.0.errors.cost", 1.0), "likeliest reading"),
    "no reading": (edit("statistics.recognition.goals.0.errors", None), "likeliest reading"),
    "another plan": (edit("statistics.recognition.goals.0.plan", ["go h a c"]), "likeliest reading"),
    "no plan at all": (edit("statistics.recognition.goals.0.plan", ["go h a b"]), "goal does not hold"),
    "a posterior": (edit("statistics.recognition.goals.0.posterior", 0.5), "posterior is 0.9"),
    "a plan of a scenario": (edit("statistics.goals.0.human_plan", ["go h a c"]), "human_plan"),
}


@pytest.mark.parametrize("way", _NOISY)
def test_doctored_posteriors_with_noise_are_refuted(way: str) -> None:
    """Two of three observations speak for c, one for e."""
    seen, goals = ["go h a b", "go h d e", "go h b c"], [{"name": f, "goal": [f]} for f in "ce"]
    answer = deepcopy(serendipity.plan(HELPED, goals=goals, observed=seen, noise="wrong=0.1").to_dict())
    doctor, words = _NOISY[way]
    doctor(answer)
    assert_refuted(serendipity.verify(HELPED, Result.from_dict(answer)), "replay", words)


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
