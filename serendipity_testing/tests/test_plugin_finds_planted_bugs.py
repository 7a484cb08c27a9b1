"""The kit as a stranger would try it: a new planner of 60 lines, with nothing wrong in it and with bugs."""

import re
import shlex
from dataclasses import replace
from pathlib import Path

import pytest

from serendipity.model import Task
from serendipity_testing import Answer, PlannerError, check_planner, random_call
from serendipity_testing.builders import task as build
from serendipity_testing.crosscheck import JUDGES, compare
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.judges import by_function
from serendipity_testing.tests import stranger

SEARCH = {"search": JUDGES["search"]}
TEXT = Path(stranger.__file__).read_text(encoding="utf-8")

BUGS = {
    "the discount is the wrong way round": ("team_cost(a, discount)", "team_cost(a, 1 - discount)"),
    "what the human's later plan must not meet is ignored": (
        "            if usable(a, state):",
        "            if state.issuperset(a.pre):",
    ),
    "a window costs its weight once": ("window_weight * (end - start)", "window_weight"),
}


@pytest.fixture(autouse=True)
def _plugin_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")


def checked(pytester: pytest.Pytester, text: str, *words: str) -> pytest.RunResult:
    pytester.makepyfile(planner=text)
    named = ("-p", "serendipity_testing.plugin", "--serendipity-planner", "planner:plan")
    return pytester.runpytest_inprocess(*named, *words)


def test_nothing_is_found_where_nothing_is_wrong(pytester: pytest.Pytester) -> None:
    done = checked(pytester, TEXT, "--serendipity-count", "8")
    done.assert_outcomes(passed=7)
    done.stdout.fnmatch_lines(["collected 7 items"])
    assert not (pytester.path / "serendipity-cases").exists()


@pytest.mark.slow
def test_nothing_is_found_in_all_calls_of_the_default(pytester: pytest.Pytester) -> None:
    checked(pytester, TEXT).assert_outcomes(passed=7)


@pytest.mark.long
@pytest.mark.parametrize(("bug", "ci"), [*((bug, "") for bug in BUGS), (next(iter(BUGS)), "true")])
def test_each_bug_is_found_and_its_smallest_case_shown(
    bug: str, ci: str, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CI", ci)  # where it is set, pytest repeats a failure's whole text in its summary
    right, wrong = BUGS[bug]
    assert TEXT.count(right) == 1
    done = checked(pytester, TEXT.replace(right, wrong), "-k", "brute-force")
    done.assert_outcomes(failed=1, deselected=6)
    shown = done.stdout.str()
    done.stdout.fnmatch_lines(["*planner:plan is wrong*", "  task(", "  brute force: optimal*", "in PDDL: *"])
    actions = re.findall(r"^          '[^']+': '[^']*->", case_shown(done), re.MULTILINE)
    assert 1 <= len(actions) <= 5

    (folder,) = (pytester.path / "serendipity-cases").iterdir()
    assert {path.name for path in folder.iterdir()} == {"commands.txt", "hum", "superagent"} | {
        path.name for path in folder.iterdir() if path.name in ("rob", "bot")
    }
    again = shlex.split(re.search(r"^again: pytest (.*)$", shown, re.MULTILINE)[1])
    assert again[again.index("--serendipity-count") + 1] == "1"
    once_more = pytester.runpytest_inprocess("-p", "serendipity_testing.plugin", *again)
    assert case_shown(once_more) == case_shown(done)


def case_shown(done: pytest.RunResult) -> str:
    """The first case that it shows."""
    shown = done.stdout.str()
    return shown[shown.index("  task(") : shown.index("again: ")]


@pytest.mark.long
def test_a_law_finds_one_without_brute_force(pytester: pytest.Pytester) -> None:
    right, wrong = BUGS["a window costs its weight once"]
    done = checked(pytester, TEXT.replace(right, wrong), "-k", "discount", "--serendipity-count", "5")
    done.assert_outcomes(failed=1, deselected=6)
    done.stdout.fnmatch_lines(["*breaks the law 'discount'*", "*planner:plan: objective * with discount *"])


def test_what_a_planner_does_not_know_is_left_out(pytester: pytest.Pytester) -> None:
    done = checked(pytester, TEXT, "--serendipity-modes", "composite", "-k", "brute", "-rs")
    done.assert_outcomes(skipped=1, deselected=6)
    done.stdout.fnmatch_lines(["*planner:plan has no answer to any of the 100 calls"])


def test_a_crash_is_found(pytester: pytest.Pytester) -> None:
    text = "def plan(task, options, human_plan):\n    return human_plan and [human_plan[7]]\n"
    done = checked(pytester, text, "-k", "brute")
    done.assert_outcomes(failed=1, deselected=6)
    done.stdout.fnmatch_lines(["*planner:plan: raised IndexError: *"])


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["--serendipity-planner", "planner:nobody"], "* has no attribute 'nobody'"),
        (["--serendipity-planner", "planner:one"], "*, got one of 1 arguments"),
        (["--serendipity-modes", "assistance"], "modes: expected some of serendipity, *, got 'assistance'"),
        (["--serendipity-modes", ""], "modes: expected some of *, got none"),
        (["--serendipity-options", "discount,speed"], "options: expected some of *, got 'speed'"),
    ],
)
def test_bad_options_are_told_in_a_line(words: list[str], why: str, pytester: pytest.Pytester) -> None:
    done = checked(pytester, TEXT + "\ndef one(task):\n    return None\n", *words)
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    done.stderr.fnmatch_lines(
        [f"*serendipity: {why}*".replace("has no", "*has no").replace("got one", "*got one")]
    )


def idle(task: Task, options: object, human_plan: list[str] | None) -> list[str] | None:
    """A planner that never helps."""
    if task.robot_goal:
        raise NotImplementedError
    return human_plan


def test_a_function_is_checked_in_a_test_of_ones_own(tmp_path: Path) -> None:
    check_planner(stranger.plan, count=5)
    with pytest.raises(PlannerError, match=r"idle is wrong, in call \d+") as raised:
        check_planner(idle, cases=tmp_path)
    assert "it leaves the human alone, where help makes the objective" in str(raised.value)
    assert (tmp_path / "idle-brute-force-serendipity" / "commands.txt").exists()


def test_who_knows_help_is_a_judge_of_crosscheck_in_every_mode() -> None:
    honest = by_function(stranger.plan)
    asked = [replace(random_call(seed), options={"mode": "serendipity"}) for seed in range(6)]
    assert [compare(call, SEARCH, {}, outside=[honest]) for call in asked] == [None] * 6
    found = compare(HELP, SEARCH, {}, outside=[by_function(idle)])
    assert "it leaves the human alone" in found.said["idle"]


HELP = PlanCall(
    build(
        init="a", goal="b", actions={"slow h": "a -> b @ 9", "quick h": "a open -> b", "open r": "-> open"}
    ),
    {"mode": "serendipity", "discount": "1", "horizon": "2"},
)
CLAIMS: tuple[tuple[object, str], ...] = (
    (Answer([["open r"], ["quick h"]], (1, 2)), ""),
    (Answer([["open r"], ["quick h"]], (1, 3)), "its objective is 2001, where 1001 is the least"),
    (Answer([["open r"], ["quick h"]]), "breaks a rule: idle-answer"),
    (Answer([["quick h"], ["open r"]], (1, 2)), "breaks a rule: precondition"),
    (Answer([["open r"], ["quick h"]], (2, 3)), "breaks a rule: window-range"),
    (Answer([["open r"]], (1, 2)), "breaks a rule: human-goal"),
    (Answer([["open r"], ["quick h"]], (2, 2)), "expected 1 <= xi1 < xi2"),
    (Answer([["fly h"]], (1, 2)), "there is no action 'fly h'"),
    (["slow h"], "it leaves the human alone, where help makes the objective 1001"),
    (None, "there is a plan of cost 1"),
)


@pytest.mark.parametrize(("answer", "why"), CLAIMS)
def test_what_can_not_be_so_is_said(answer: object, why: str) -> None:
    def says_so(task: object, options: object, human_plan: object) -> object:
        return answer

    found = compare(HELP, SEARCH, {}, outside=[by_function(says_so, "one")])
    if not why:
        assert found is None
    else:
        assert why in found.said["one"]
