"""``serendipity execute``: text, JSON and CSV, logs and replays, and what it complains about."""

import json
from pathlib import Path

from tests.cli.conftest import Runs, assert_one_line

CALL = "execute --example room2 --discount 0.6"


def test_text_tells_the_story(run: Runs) -> None:
    told = run(CALL)
    assert told.code == 0
    lines = told.out.splitlines()
    assert lines[0] == "epoch 1: commx move commx room13 hall8"
    assert "epoch 6: commx hand_over robot commx mk2 hall4" in lines
    assert "in the mean 11 instead of 13; the team 12.6" in lines


def test_json_says_its_schema_and_rows_can_be_written(run: Runs) -> None:
    told = json.loads(run(f"{CALL} --human noisy:0.2 --runs 3 --seed 4 --format json").out)
    assert told["schema"] == "serendipity.executions/1" and told["summary"]["runs"] == 3
    assert run(f"{CALL} -o rows.csv").code == 0 and Path("rows.csv").read_text().startswith(
        "run,seed,reached"
    )


def test_who_does_not_arrive_is_no_answer(run: Runs) -> None:
    told = run(f"{CALL} --epochs 2")
    assert told.code == 1 and "not reached in 1 of 1 run, so nothing is saved" in told.out.splitlines()


def test_a_log_is_played_again(run: Runs) -> None:
    assert run(f"{CALL} --runs 2 --faults fail=0.2,drop=0.05 --log runs.jsonl").code == 0
    again = run("execute --example room2 --replay runs.jsonl")
    assert again.code == 0 and [line[:21] for line in again.out.splitlines()] == [
        "run 1: the same again",
        "run 2: the same again",
    ]
    log = Path("runs.jsonl")
    log.write_text(log.read_text().replace('"human_cost": 2.0', '"human_cost": 1.0', 1))
    changed = run("execute --example room2 --replay runs.jsonl")
    assert changed.code == 1 and "runs.jsonl:3: log: human_cost: comes out as 2.0" in changed.out


def test_a_log_that_is_nested_too_deeply(run: Runs) -> None:
    Path("runs.jsonl").write_text("[" * 100_000)
    assert_one_line(run("execute --example room2 --replay runs.jsonl"), "runs.jsonl:1: log: expected a JSON")


def test_a_record_may_stand_behind_the_task(run: Runs) -> None:
    Path("record").write_text("noop\nmove commx room13 hall8\n")
    first, second = (
        run(f"execute --example room2 --human {words}").out.partition("\nrun ")[0]
        for words in ("recorded record", "recorded:record")
    )
    assert first == second and first.startswith("epoch 1: commx waits\n")


def test_a_person_who_is_not_named_is_asked_for_by_the_commands_own_option(run: Runs) -> None:
    Path("domain.pddl").write_text("(define (domain d) (:predicates (p)))")
    Path("problem.pddl").write_text("(define (problem p) (:domain d) (:init) (:goal (p)))")
    told = run("execute domain.pddl problem.pddl --human ann --robot bot")
    assert (told.code, "name --human H (`execute`: --person H) and --robot R" in told.err) == (2, True)
