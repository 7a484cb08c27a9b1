"""`plan --head-start`: robots begin before the person does, and the answer is checked like any other."""

import json

from tests.cli.conftest import Runs, assert_one_line


def test_the_former_plan_begins_after_it(run: Runs) -> None:
    done = run("plan --example room2 --discount 0.6 --head-start 2")
    rows = [line.split() for line in done.out.splitlines()]
    assert any(row[:1] == ["15"] and row[-3:] == ["conduct_triage", "commx", "room1"] for row in rows)
    assert "checker: proves replay, cost, window" in done.out


def test_who_has_longer_saves_no_less(run: Runs) -> None:
    costs = []
    for epochs in (0, 2, 6):
        answer = json.loads(
            run(f"plan --example room2 --discount 0.6 --format json --head-start {epochs}").out
        )
        costs.append(answer["cost"])
    assert costs == sorted(costs, reverse=True)


def test_what_it_says_is_proved_and_the_proof_is_accepted(run: Runs) -> None:
    run("plan --example room2 --discount 0.6 --head-start 2 -o begun.json")
    assert run("verify --example room2 begun.json --proof begun.proof").code == 0
    assert run("check-proof begun.proof --example room2 begun.json").code == 0
    assert "the head start is over at 2" in run("explain --example room2 begun.json").out


def test_a_head_start_is_a_number_of_epochs(run: Runs) -> None:
    assert_one_line(run("plan --example room2 --head-start soon"), "head_start", "whole number")
