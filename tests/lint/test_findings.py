"""What `check-task` finds is so: against planning on random tasks, and rule by rule on small ones."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.lint.task_rules import relevant
from serendipity.model import Condition, Deadline, Script, Task
from serendipity_testing import cases
from serendipity_testing.builders import task as built
from serendipity_testing.strategies import tasks
from serendipity_testing.strategies.time import bystander_tasks, scripted_tasks
from tests.pddl.texts import action, domain, pair, problem
from tests.show.conftest import WARDS

Rules = Callable[..., dict[str, str]]


def rules(task: Task) -> set[str]:
    return {finding.rule for finding in serendipity.check_task(task).findings}


def best(task: Task, mode: str = "composite") -> tuple[str, float | None]:
    result = serendipity.plan(task, mode=mode, **({"horizon": "inf"} if mode == "composite" else {}))
    return result.status, result.cost


@given(tasks())
def test_what_is_out_of_reach_cannot_be_planned(task: Task) -> None:
    found = rules(task)
    if "goal-unreachable" in found:
        assert best(task)[0] == "infeasible"
    if "goal-needs-help" in found:
        assert best(task, "individual")[0] == "infeasible"


@given(tasks())
def test_what_does_not_matter_can_be_left_out(task: Task) -> None:
    kept = [
        action for action, matters in zip(task.actions, relevant(task, Deadline()), strict=True) if matters
    ]
    assert best(replace(task, actions=tuple(kept))) == best(task)


@given(st.one_of(scripted_tasks(), bystander_tasks()))
def test_what_the_script_changes_for_nothing_can_be_left_out(task: Task) -> None:
    useless = {"script-changes-nothing", "script-never-matters"} & rules(task)
    script = task.script
    for one in script.facts:
        left = replace(script, facts=tuple(other for other in script.facts if other != one))
        without = replace(task, script=left)
        if useless and rules(without) < rules(task):  # it was the only one
            assert best(without, "individual") == best(task, "individual")
            assert best(without) == best(task)


def walk(**changes: object) -> Task:
    """Somebody who goes through a door, and Carol, who shuts it behind her."""
    actions = {"go h": "open -> in @ 1 [3]", "shut carol": "open -> !open", "sing carol": "moon -> song"}
    built_in = built(agents="h r carol", init="open", goal="in", actions=actions | {"help r": "-> !open"})
    return built_in.with_script(Script(**changes))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("script", "rule", "words"),
    [
        ({"facts": [(3, "!moon"), (9, "open")]}, "script-changes-nothing", "nothing: epoch 3 not moon"),
        ({"facts": [(3, "moon"), (5, "moon")]}, "script-changes-nothing", "nothing: epoch 5 moon"),
        ({"facts": [(3, "song")]}, "script-never-matters", "nobody asks for: epoch 3 song"),
        ({"people": {"carol": ["sing carol"]}}, "bystander-impossible", "can never do this: sing carol"),
        (
            {"people": {"carol": ["shut carol", "shut carol"]}, "facts": [(9, "open")]},
            "bystander-needs-help",
            "plans say: epoch 2: 'shut carol' is not applicable: 'open' is false",
        ),
    ],
)
def test_scripts(script: dict[str, object], rule: str, words: str) -> None:
    report = serendipity.check_task(walk(**script))
    assert words in {finding.rule: finding.text for finding in report.findings}[rule]
    assert report.right == (rule != "bystander-impossible")


def test_what_takes_too_long_to_be_planned_is_told() -> None:
    """`plan` refused it, and `check-task` found nothing."""
    for epochs, few in ((10_000, True), (10_001, False)):
        long = built(goal="in", actions={"go h": f"-> in @ 1 [{epochs}]", "help r": "in ->"})
        found = {finding.rule: finding.text for finding in serendipity.check_task(long).findings}
        assert ("too-many-epochs" not in found) is few
    assert "'go h' takes 10,001 epochs, expected at most 10,000" in found["too-many-epochs"]
    assert "too-many-epochs" in rules(walk(facts=[(100_001, "moon")]))


def test_the_time_of_a_task_is_told() -> None:
    task = walk(facts=[(3, "moon"), (12, "!open")], people={"carol": [(4, "sing carol")]})
    report = serendipity.check_task(replace(task, epoch=Fraction(5, 2)))
    assert report.to_dict()["time"] == {
        "epoch": 2.5,
        "longest": 3,
        "script_epochs": 12,
        "script_facts": 2,
        "bystanders": {"carol": 1},
    }
    assert str(report).splitlines()[1:4] == [
        "an epoch is 2.5 long, the longest action takes 3 epochs",
        "script: 2 changes of facts, until epoch 12",
        "bystander carol: 1 action",
    ]
    assert "time" not in serendipity.check_task(serendipity.example("room2")).to_dict()


def test_a_sound_task_has_no_finding() -> None:
    report = serendipity.check_task(serendipity.example("room2"))
    assert report.findings == ()
    assert report.right
    assert report.actions["move"] == 40
    assert sum(report.actions.values()) == 353
    assert report.agents == {"commx": 229, "robot": 208}


@pytest.mark.parametrize(
    ("changes", "rule", "words", "right"),
    [
        ({"goal": ""}, "goal-missing", "h has no goal", True),
        ({"goal": "q"}, "goal-holds", "h's goal holds", True),
        ({"goal": "p never"}, "goal-unreachable", "never", False),
        ({"goal": "!lasting"}, "goal-unreachable", "not lasting", False),
        ({"goal": "given"}, "goal-needs-help", "alone: given", True),
        ({"robot_goal": "never"}, "goal-unreachable", "the robots' goal", False),
        ({"agents": "h r s"}, "agent-idle", "s can do nothing", True),
        ({}, "agent-irrelevant", "nothing that r can do", True),
    ],
)
def test_goals_and_agents(changes: dict[str, str], rule: str, words: str, right: bool) -> None:
    parts = {
        "init": "q lasting",
        "goal": "p",
        "actions": {"do h": "q -> p", "turn r": "q -> !q given", "keep h": "lasting !never -> p"},
    }
    report = serendipity.check_task(built(**(parts | changes)))  # type: ignore[arg-type]
    texts = {finding.rule: finding.text for finding in report.findings}
    assert words in texts[rule]
    assert report.right == right


def test_two_robots_that_lift_together_matter() -> None:
    assert "agent-irrelevant" not in rules(cases.case_10())


def test_errors_come_first() -> None:
    task = replace(cases.case_10(), goal=Condition(), robot_goal=Condition())
    levels = [finding.level for finding in serendipity.check_task(replace(task, warnings=("odd",))).findings]
    assert levels == sorted(levels, key=["error", "warning", "note"].index)


@pytest.fixture
def found(tmp_path: Path) -> Rules:
    def finds(domain_text: str, problem_text: str) -> dict[str, str]:
        files = pair(tmp_path, domain_text, problem_text)
        task = serendipity.load_pddl(*files, "h", ["r"])
        return {f.rule: f.text for f in serendipity.check_task(task, [files]).findings}

    return finds


DO = action("do", "(q)", "(p)")


@pytest.mark.parametrize(
    ("texts", "rule", "words"),
    [
        (((DO,), {}), "predicate-unused", "a, b, has and 1 more"),
        (((DO, action("note", "(q)", "(r)")), {}), "predicate-unread", "never asked for: r"),
        (((DO, action("wish", "(r)", "(p)")), {}), "predicate-false", "never true: r"),
        (((DO, action("wish", "(r)", "(p)")), {}), "action-never-applied", "wish"),
        (((DO,), {"functions": "(weight ?x) (size)"}), "function-unread", "size, weight"),
    ],
)
def test_names(texts: tuple[tuple[str, ...], dict[str, str]], rule: str, words: str, found: Rules) -> None:
    actions, more = texts
    assert words in found(domain(*actions, **more), problem("(q)"))[rule]


def test_a_missing_goal_is_named(found: Rules) -> None:
    assert "no :goal" in found(domain(DO), problem("(q)", goal=""))["goal-missing"]


@pytest.mark.parametrize(
    ("requirements", "precondition", "rule", "words"),
    [
        (":strips :typing", "(and (q) (not (r)))", "requirement-missing", ":negative-preconditions"),
        (":strips :typing", "(or (q) (r))", "requirement-missing", ":disjunctive-preconditions"),
        (":strips :typing :equality", "(q)", "requirement-unused", ":equality"),
        (":typing :conditional-effects", "(q)", "requirement-unused", ":conditional-effects"),
        (":typing", "(exists (?x - thing) (b ?x))", "requirement-missing", ":existential-preconditions"),
        (":adl", "(and (or (q) (not (r))) (= ?who ?who))", None, None),
        (":typing :quantified-preconditions", "(and (q) (forall (?x - thing) (q)))", None, None),
    ],
)
def test_requirements(
    requirements: str, precondition: str, rule: str | None, words: str | None, found: Rules
) -> None:
    text = domain(action("do", precondition, "(p)"))
    text = text.replace("(:types", f"(:requirements {requirements}) ; (:requirements :fluents)\n(:types")
    texts = found(text, problem("(q) (b o1)"))
    if rule is None:
        assert not {name for name in texts if name.startswith("requirement")}
    else:
        assert words is not None
        assert words in texts[rule]


def test_a_newcomers_domain() -> None:
    files = (WARDS / "domain.pddl", WARDS / "problem.pddl")
    task = serendipity.load_pddl(*files, "eva", ["carta", "cartb"])
    report = serendipity.check_task(task, [files])
    assert {finding.rule: finding.level for finding in report.findings} == {
        "predicate-unused": "note",
        "predicate-unread": "note",
    }
    assert report.actions["hand"] == 198
