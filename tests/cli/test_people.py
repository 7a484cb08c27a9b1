"""A morning for two people and a robot on the command line: bystanders, whoever is helped, plan files."""

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Runs, assert_one_line

DOMAIN = """(define (domain morning) (:requirements :durative-actions)
 (:predicates (free) (washed_{who}) (coffee) (fed_{who}))
 (:durative-action wash_{who} :parameters () :duration (= ?duration 10)
  :condition (at start (free)) :effect (and (at start (not (free))) (at end (free)) (at end (washed_{who}))))
 (:durative-action brew_{who} :parameters () :duration (= ?duration {brews}) :effect (at end (coffee)))
 (:durative-action drink_{who} :parameters () :duration (= ?duration 5)
  :condition (and (at start (coffee)) (at start (washed_{who}))) :effect (at end (fed_{who}))))
"""
PROBLEM = "(define (problem day) (:domain morning) (:init (free)) (:goal (and {goal})))"
HELP = "--discount 0.9 --window-weight 0.1"


@pytest.fixture
def house(tmp_path: Path) -> str:
    """Ann brews coffee for 25 minutes, Bob for 10; each wants to be washed and fed."""
    for who, brews in (("ann", 25), ("bob", 10), ("rob", 5)):
        folder = tmp_path / "house" / who
        folder.mkdir(parents=True)
        goal = "" if who == "rob" else f"(washed_{who}) (fed_{who})"
        (folder / "domain.pddl").write_text(DOMAIN.format(who=who, brews=brews))
        (folder / "problem.pddl").write_text(PROBLEM.format(goal=goal))
    return "house"


def test_whoever_is_helped_is_told_and_can_be_verified(house: str, run: Runs) -> None:
    done = run(f"plan {house} --human any {HELP} --save-plan day.plan -o day.json")
    assert (done.code, done.out, done.err) == (0, "", "")
    answer = json.loads(Path("day.json").read_text())
    helped = answer["human"]
    (other,) = {"ann", "bob"} - {helped}
    saved = {one["human"]: one["saving"] for one in answer["statistics"]["humans"]}
    assert answer["saving"] == max(saved.values()) == saved[helped]
    assert all(step["agents"] == [other] for step in answer["bystanders"][other])
    proved = run(f"verify {house} --human {helped} --bystander {other} day.json")
    assert proved.code == 0, proved
    assert f"; {other}: 0.000: " in Path("day.plan").read_text()
    assert f"{helped} is helped, as whoever saves most: ann " in run(f"plan {house} --human any {HELP}").out
    for command in ("verify", "explain"):
        assert_one_line(run(f"{command} {house} --human any day.json"), "--human any: goes with `plan` only")


def test_a_bystander_lives_beside_whom_robots_help(house: str, run: Runs) -> None:
    done = run(f"execute {house} --person ann --bystander bob --discount 0.9 --log day.jsonl --format json")
    assert (done.code, done.err) == (0, "") and json.loads(done.out)["rows"][0]["reached"]
    lived = [json.loads(line) for line in Path("day.jsonl").read_text().splitlines()]
    assert "coffee" in lived[2]["changes"], "Bob has made some"
    again = run(f"execute {house} --person ann --bystander bob --replay day.jsonl")
    assert again.code == 0 and "the same again" in again.out


def test_what_is_predicted_for_a_bystander_can_be_given(house: str, run: Runs) -> None:
    predicted = run(f"plan {house} --human ann --bystander bob {HELP} -o predicted.json")
    alone = run(f"plan {house} --human bob --mode individual --save-plan bob.plan")
    given = run(f"plan {house} --human ann --bystander bob=bob.plan {HELP} -o given.json")
    assert (predicted.code, alone.code, given.code) == (0, 0, 0)
    answers = [json.loads(Path(name).read_text()) for name in ("predicted.json", "given.json")]
    for name in ("bystanders", "plan", "cost", "human_plan", "human_plan_times", "horizon"):
        assert answers[0].get(name) == answers[1].get(name)
