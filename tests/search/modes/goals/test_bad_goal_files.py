"""Files of goals and observations that are wrong: one line, with file and line."""

from pathlib import Path

import pytest

from serendipity.pddl.write import write_pddl
from serendipity_testing.builders import task as build
from tests.cli.conftest import Runs, assert_one_line

TRIAGE = "conducted_triage commx room1"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["goals.txt", "at least one goal"]),
        ("# nothing\n\n; at all\n", ["goals.txt", "at least one goal"]),
        ("[]", ["goals.txt", "at least one goal"]),
        ("1: conducted_triage room1\n", ["goals.txt:1", "perhaps 'conducted_triage commx room1'"]),
        ("1: condcted_triage room1\n", ["goals.txt:1", "perhaps 'conducted_triage commx room1'"]),
        (f"1: {TRIAGE}\n2: no such fact\n", ["goals.txt:2", "there is no fact 'no such fact'"]),
        (f'[{{"goal": ["{TRIAGE}"]}},\n {{"goal": ["nix"]}}]', ["goals.txt:2", "there is no fact 'nix'"]),
        (f"-1: {TRIAGE}", ["goals.txt:1", "prior", "at least 0"]),
        (f"0: {TRIAGE}", ["goals.txt", "sum above 0"]),
        (f"often: {TRIAGE}", ["goals.txt:1", "prior", "'often'"]),
        (f"inf: {TRIAGE}", ["goals.txt:1", "prior", "finite"]),
        (f"1: {TRIAGE},,", ["goals.txt:1", "prior: fact, fact"]),
        (f"1: {TRIAGE}\n1: {TRIAGE}", ["goals.txt:2", "two goals named"]),
        ('{"goal": []}', ["goals.txt", "JSON list"]),
        ('["a"]', ["goals.txt:1", "expected an object"]),
        ('[{"goal": "a"}]', ["goals.txt:1", "list of facts"]),
        ('[{"goal": [], "weight": 1}]', ["goals.txt:1", "unknown field 'weight'"]),
        ('[{"goal": [], "name": 1}]', ["goals.txt:1", "name: expected a text"]),
        ('[{"goal": [], "prior": NaN}]', ["goals.txt", "finite number"]),
        ('[{"goal": [], "prior": true}]', ["goals.txt:1", "prior"]),
        ('[\n{"goal": [}]', ["goals.txt:2", "expected JSON"]),
        ("[" * 100_000, ["goals.txt", "JSON"]),
        ("\x00", ["goals.txt", "not text"]),
    ],
)
def test_goals(text: str, words: list[str], run: Runs) -> None:
    Path("goals.txt").write_text(text)
    assert_one_line(run("recognise --example room2 --goals goals.txt"), *words)
    assert_one_line(run("plan --example room2 --goals goals.txt"), *words)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("move commx room13 hall8\nfly commx\n", ["seen.txt:2", "there is no such action"]),
        ("move_reverse robot room4 room3", ["seen.txt:1", "that commx can do alone"]),
        ("(move commx", ["seen.txt:1", "expected one action"]),
        ('[\n"fly commx"]', ["seen.txt:2", "there is no such action"]),
        ("[1]", ["seen.txt:1", "name of an action"]),
        (f"[{'1' * 5000}]", ["seen.txt", "4300 digits"]),
    ],
)
def test_observations(text: str, words: list[str], run: Runs) -> None:
    Path("goals.txt").write_text(f"1: {TRIAGE}")
    Path("seen.txt").write_text(text)
    assert_one_line(run("recognise --example room2 --goals goals.txt --observed seen.txt"), *words)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("--goals none.txt", ["none.txt", "no such file"]),
        ("--goals .", ["can't be read"]),
        ("--observed goals.txt", ["--observed", "--goals"]),
        ("--beta 1", ["--beta", "--goals"]),
        ("--noise wrong=0.1", ["--noise", "--goals"]),
        ("--goals goals.txt --noise wrong=2", ["wrong: expected a probability"]),
        ("--goals goals.txt --beta -1", ["beta", "at least 0"]),
        ("--goals goals.txt --mode composite", ["goals", "serendipity"]),
        ("--goals two.txt --ties robust", ["ties", "fixed"]),
        ("--goals two.txt --human-model local", ["human_model", "omniscient"]),
        ("--goals two.txt --max-cost 5", ["max_cost", "None"]),
        ("--goals two.txt --horizon inf", ["horizon", "composite"]),
        ("--goals two.txt --horizon 3", ["horizon", "at least"]),
    ],
)
def test_options(options: str, words: list[str], run: Runs) -> None:
    Path("goals.txt").write_text(f"1: {TRIAGE}")
    Path("two.txt").write_text(f"1: {TRIAGE}\n1: conducted_triage commx room7")
    assert_one_line(run(f"plan --example room2 {options}"), *words)


@pytest.mark.parametrize("command", ["recognise", "plan"])
def test_what_no_goal_explains_is_said(command: str, run: Runs) -> None:
    roads = {"near h": "a -> b !a", "far h": "a -> c !a", "on h": "b -> c !b", "wave r": "-> waved"}
    write_pddl(build(init="a", goal="c", actions=roads), "roads")
    Path("goals.txt").write_text("3: c\n1: b, !waved")
    Path("seen.txt").write_text("(far_h)\n(on_h)  ; there is no way back\n")
    task = "roads --human h --goals goals.txt"
    done = run(f"{command} {task} --observed seen.txt")
    assert (done.code, done.err) == (0, "")
    assert "the posterior is the prior" in done.out
    assert "0.7500" in done.out
    assert "the posterior is the prior" not in run(f"{command} {task}").out
