"""What is odd but no error is said once, in one line, and in the same words in every run."""

import subprocess
import sys
from pathlib import Path

import pytest

from serendipity import InputError
from tests.pddl.texts import action, domain, one, pair, problem, two

GO = domain(action("go", "(q)", "(p) (a ?o)", "?who - agent ?o - thing"))
CROWD = "h r r2 r3 - agent o1 o2 - thing"


@pytest.mark.parametrize(
    ("goal", "line"), [("", ""), ("(and)", ":5"), ("(and (and) (= o1 o1))", ":5"), ("()", ":5")]
)
def test_no_goal(tmp_path: Path, goal: str, line: str) -> None:
    task = one(tmp_path, GO, problem("(q)", goal))
    assert task.warnings == (f"{tmp_path / 'problem.pddl'}{line}: there is no goal: 'h' has nothing to do",)


def test_a_type_behind_no_object_is_an_empty_list(tmp_path: Path) -> None:
    text = problem("(q)", objects="h r - agent  - thing\n(:private h  - thing o1 - thing)  - agent")
    task = one(tmp_path, GO, text)
    places = [f"{tmp_path / 'problem.pddl'}:{line}" for line in (3, 4)]
    assert task.warnings == tuple(
        f"{place}: no object before '- TYPE': read as an empty list" for place in places
    )
    assert task.agents == ("h", "r")
    with pytest.raises(InputError, match=r"domain.pddl.*expected a variable, as \?x, got '-'"):
        one(tmp_path, GO.replace("?who - agent", "?who - agent - thing"), text)


def test_only_the_human_needs_a_goal(tmp_path: Path) -> None:
    mine = domain(action("go", "(q)", "(p)"))
    task = two(tmp_path, (mine, problem("(q)")), (mine, problem("(q)", goal="")))
    assert task.warnings == ()


def test_who_is_no_agent_of_the_call_is_named_once(tmp_path: Path) -> None:
    more = action("come", "(q)", "(p)") + "(:action rain :parameters (?o - thing) :effect (a ?o))"
    text = GO.replace("(:action", f"{more}(:action", 1)
    task = one(tmp_path, text, problem("(q)", objects=CROWD))
    assert task.warnings == (
        "'r2' is no agent of this call; 3 actions left out",
        "'r3' is no agent of this call; 3 actions left out",
        "action 'rain': no agent is among its arguments; 2 actions left out",
    )


def test_what_only_waits_is_not_missed(tmp_path: Path) -> None:
    wait = "(:action wait :parameters (?o - thing) :effect (and))"
    assert one(tmp_path, GO.replace("(:action", f"{wait}(:action", 1), problem("(q)")).warnings == ()


PROGRAM = """
import sys
from serendipity import SerendipityError, load_pddl
try:
    task = load_pddl(*sys.argv[1:3], human="h", robots=["r"])
    print(task.warnings, task.facts, task.actions, sorted(task.init), task.goal, sorted(task.waiting))
except SerendipityError as error:
    print(error)
"""


@pytest.mark.long
@pytest.mark.parametrize(
    ("text", "more"),
    [
        (GO, ""),
        (
            domain(
                action(
                    "go", "(b ?x ?y)", "(p) (increase (total-cost) (far ?y))", "?who - agent ?x ?y - thing"
                ),
                functions="(far ?y)",
                predicates="(p) (b ?x ?y)",
            ),
            "",
        ),
        (
            domain(
                action("go", "(q)", "(when (or (a o1) (r)) (p))"),
                action("set", "(q)", "(a ?x)", "?who - agent ?x"),
                predicates="(p) (q) (r) (a ?x) (b ?x ?y)",
            ),
            "",
        ),
        (GO, "(:goal-of nobody)"),
        (GO.replace("(p) (a ?o)", "(p) (c ?o)"), ""),
    ],
)
def test_every_run_says_the_same(tmp_path: Path, text: str, more: str) -> None:
    objects = (
        "h r " + " ".join(f"r{i}" for i in range(9)) + " - agent o1 o2 " + " ".join("xyzuvw") + " - thing"
    )
    init = " ".join(f"(b {a} {b})" for a in "xyzuvw" for b in "wvuzyx") if "(b ?x ?y)" in text else ""
    text = text.replace("(:predicates", "(:constants o1 o2 - thing)(:predicates")
    files = pair(
        tmp_path,
        text,
        problem(f"(q) {init}" if "(q)" in text else init, "(exists (?x - thing) (p))", objects, more),
    )
    said = [
        subprocess.run(
            [sys.executable, "-c", PROGRAM, *map(str, files)],
            capture_output=True,
            text=True,
            check=True,
            env={"PYTHONHASHSEED": seed},
        ).stdout
        for seed in ("1", "2", "3")
    ]
    assert said[0]
    assert said[0] == said[1] == said[2]
