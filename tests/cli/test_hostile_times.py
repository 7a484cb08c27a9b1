"""Times that can't be, or are too many: an exit code and one line each, soon, and in little memory."""

from collections.abc import Mapping
from pathlib import Path
from time import monotonic

import pytest

from tests.cli.conftest import Runs

DOMAIN = """(define (domain home) (:requirements :typing :durative-actions :timed-initial-literals :fluents)
 (:types agent) (:predicates (open) (there ?a - agent) (out ?a - agent)) (:functions (pace ?a - agent))
 (:durative-action walk :parameters (?a - agent) :duration {duration}
  :effect (at end (there ?a)))
 (:durative-action leave :parameters (?a - agent) :duration (= ?duration 2)
  :condition (and (at start (there ?a)) (at start (open)) (over all (open))) :effect (at end (out ?a))))
"""
PROBLEM = """(define (problem day) (:domain home) (:objects ann bob carol - agent)
 (:init {init}
 ) (:goal (and {goal})))
"""
USUAL = {"duration": "(= ?duration 4)", "init": "(open)", "goal": "(out ann)", "plan": ""}
PLAN = "plan domain.pddl problem.pddl --human ann --robot bob"
CAROL = "--robot carol --bystander carol"
DONE = "--bystander carol=carol.plan"


ABOVE, MOST = "domain.pddl:3: action 'walk': expected a duration above 0", "expected at most 1,000,000"
TWICE = "problem.pddl:2: 'open' becomes true and false"
CAROLS, HIS = "carol.plan:1: plan of carol: ", "--human-plan carol.plan"


def duration(length: str) -> dict[str, str]:
    """Walks of that length."""
    return {"duration": f"(= ?duration {length})"}


def plan(text: str) -> dict[str, str]:
    return {"plan": text}


@pytest.mark.parametrize(
    ("given", "options", "code", "words"),
    [
        (duration("0"), "", 2, f"{ABOVE}, got 0"),
        (duration("-4"), "", 2, f"{ABOVE}, got -4"),
        (duration("(- 2 2)"), "", 2, f"{ABOVE}, got 0"),
        (duration("2.5"), "", 0, ""),
        (duration("2.5"), "--epoch 1", 0, "Warning: durations are rounded up to whole epochs of 1"),
        (duration("1000000000"), "", 2, f"takes 500,000,000 epochs of 2, {MOST}"),
        (duration("1000000000"), "--epoch 1e6", 0, "Warning: durations are rounded up"),
        (duration("1000000"), "", 2, "takes 500,000 epochs, expected at most 10,000: longer epochs"),
        (duration("0.000001"), "", 2, f"takes 2,000,000 epochs of 1e-06, {MOST}"),
        ({"init": "(open) (at 0 (there ann))"}, "", 2, "problem.pddl:2: initial state: expected a time"),
        ({"init": "(open) (at -3 (there ann))"}, "", 2, "expected a time above 0, got -3"),
        ({"init": "(at 2 (open)) (at 2 (there ann))"}, "", 0, ""),
        ({"init": "(at 2 (open)) (at 2 (open))"}, "", 0, ""),
        ({"init": "(at 2 (open)) (at 2 (not (open)))"}, "", 2, f"{TWICE} at 2"),
        ({"init": "(at 2 (open)) (at 1.5 (not (open)))"}, "--epoch 2", 2, f"{TWICE} with epoch 1 of 2"),
        ({"init": "(at 2000000 (open))"}, "", 2, "the script takes 1,000,000 epochs, expected"),
        ({"init": "(at 1e9 (open))"}, "", 2, f"takes 500,000,000 epochs of 2, {MOST}"),
        (plan("0: (fly carol)"), DONE, 2, f"{CAROLS}'fly carol' is not an action that carol can do alone"),
        (plan("0: (walk ann)"), DONE, 2, f"{CAROLS}'walk ann' is not an action that carol can do alone"),
        (
            plan("0: (walk carol)\n2: (leave carol)"),
            DONE,
            2,
            "carol.plan:2: plan of carol: 'leave carol' begins in epoch 2, but",
        ),
        (plan("; epoch 0\n(walk carol)"), DONE, 2, "carol.plan:2: plan of carol: expected an epoch from 1"),
        ({}, "--bystander carol=", 2, "--bystander: expected NAME or NAME=FILE, got no file after '='"),
        (plan("0: (walk carol) [7]"), DONE, 2, f"{CAROLS}expected [4], the duration of 'walk carol'"),
        (plan("1: (walk carol) [4]"), DONE, 2, f"{CAROLS}expected a multiple of 2"),
        (plan("9e9: (walk carol)"), DONE, 2, f"{CAROLS}expected one action"),
        (plan("4000000: (walk carol)"), DONE, 2, f"{CAROLS}{MOST[:26]}"),
        (plan("1900000: (walk carol)"), DONE, 2, "the script takes 950,002 epochs, expected at most 100"),
        (plan("0: (leave carol)"), DONE, 3, "are idle, epoch 1: 'leave carol' is not applicable"),
        (plan("[1]"), DONE, 2, "carol.plan"),
        ({}, "--bystander carol=nowhere", 2, "nowhere: can't be read"),
        ({}, "--bystander dave", 2, "dave"),
        ({}, "--bystander ann", 2, "bystander 'ann': is the human"),
        ({}, "--bystander carol --bystander CAROL=carol.plan", 2, "--bystander: expected each name once"),
        ({}, CAROL, 2, "bystander 'carol': has no goal in the task, so a plan has to be given"),
        ({"goal": "(out ann) (there carol)"}, CAROL, 0, ""),
        ({"init": "", "goal": "(there ann) (out carol)"}, CAROL, 2, "'carol': can't reach the goal alone"),
        ({}, "--human any", 2, "'any' is for tasks with files for each agent"),
        ({}, "--epoch 0", 2, "epoch: expected a number above 0, got 0"),
        ({}, "--epoch 1e-9", 2, f"{MOST}: longer epochs can be asked for with --epoch"),
        (plan("0: (walk ann)\n4.5: (leave ann)"), HIS, 2, "expected a multiple of 2"),
        (plan("0: (walk ann)\n1998: (leave ann)"), HIS, 0, ""),
        (plan("0: (walk ann)\n2: (leave ann)"), HIS, 2, "carol.plan:2: human plan"),
        (plan("-4: (walk ann)"), HIS, 2, "carol.plan:1: human plan: expected a time from 0 on, got -4"),
        ({}, "--waiting-cost -1", 2, "waiting_cost: expected a number of at least 0, got -1"),
        ({}, "--head-start 1000001", 2, "head_start: expected at most 1000000, got 1000001"),
    ],
)
def test_times(given: Mapping[str, str], options: str, code: int, words: str, run: Runs) -> None:
    texts = USUAL | given
    Path("domain.pddl").write_text(DOMAIN.format(**texts))
    Path("problem.pddl").write_text(PROBLEM.format(**texts))
    Path("carol.plan").write_text(texts["plan"])
    begun = monotonic()
    done = run(f"{PLAN} {options}")
    lines = [line for line in done.err.splitlines() if "no agent of this call" not in line]
    assert (done.code, len(lines)) == (code, bool(words)), done
    assert words in done.err
    assert bool(done.out) == (code != 2)
    assert monotonic() - begun < 5
