"""The report lists, for each window, what brute force finds; and its plans do what it says."""

from fractions import Fraction

import pytest
from hypothesis import given

import serendipity
from serendipity import Task, UsageError, Window
from serendipity.facade.interruptibility import Interruption, InterruptionReport, removal
from serendipity_testing import cases
from serendipity_testing.oracle import action_sets, optimal_human_plan
from serendipity_testing.oracle.epochs import after, holds
from serendipity_testing.oracle.interruptions import best_by_window
from serendipity_testing.strategies import Call, calls


def report_of(call: Call) -> InterruptionReport:
    options = call.options
    return serendipity.interruptions(
        call.task,
        human_plan=call.human_plan_names,
        discount=options.discount,
        horizon=options.horizon,
        suffix=options.suffix,
        preservation=options.preservation,
        interference=options.interference,
    )


@pytest.mark.long
@given(calls(modes=("serendipity",), ties=False))
def test_every_window_is_as_good_as_brute_force_finds_it(call: Call) -> None:
    plan = call.human_plan or optimal_human_plan(call.task)
    try:
        report = report_of(call)
    except UsageError as error:
        assert "horizon" in str(error)
        return
    if plan is None:
        assert report.human_plan is None
        assert report.windows == ()
        return
    expected = best_by_window(call.task, call.options, plan)
    found = {w.window: (w.human_cost, w.team_cost) for w in report.windows if w.human_cost is not None}
    assert found == expected
    alone = call.task.cost_of(plan)
    assert report.interruptible == any(human < alone for human, _ in expected.values())
    for window in report.windows:
        if window.plan is not None:
            assert_fits(call, report, window)


def assert_fits(call: Call, report: InterruptionReport, entry: Interruption) -> None:
    """Its plan follows rules 1 and 3, every epoch is applicable, and the costs are those listed."""
    task, window = call.task, entry.window
    state, his_cost, executed = task.init, Fraction(0), []
    for epoch in range(1, (report.horizon or 0) + 1):
        names = [step.action for step in entry.plan if step.epoch == epoch]
        his = [step.action for step in entry.plan if step.epoch == epoch and report.human in step.agents]
        if epoch < window.start:
            assert his == list(report.human_plan[epoch - 1 : epoch])
        if epoch >= window.end:
            assert names == his
        chosen = next(
            ids
            for ids in action_sets(task, state, range(len(task.actions)), strict=call.options.strict)
            if sorted(task.actions[i].name for i in ids) == sorted(names)
        )
        state = after(state, [task.actions[i] for i in chosen])
        his_cost += sum(task.actions[i].cost for i in chosen if task.human in task.actions[i].participants)
        executed += his
    assert holds(task.goal, state)
    assert holds(task.robot_goal, state)
    assert his_cost == entry.human_cost
    assert entry.removal == removal(report.human_plan, tuple(executed))


@pytest.mark.parametrize(
    ("former", "executed", "first", "removed", "replacement"),
    [
        ("abcd", "abcd", 5, "", ""),
        ("abcd", "axd", 2, "bc", "x"),
        ("abcd", "ad", 2, "bc", ""),
        ("abcd", "abxcd", 3, "", "x"),
        ("aaa", "aa", 3, "a", ""),
        ("ab", "", 1, "ab", ""),
        ("", "x", 1, "", "x"),
        ("abab", "ab", 3, "ab", ""),
    ],
)
def test_common_beginning_and_end_are_stripped(
    former: str, executed: str, first: int, removed: str, replacement: str
) -> None:
    found = removal(tuple(former), tuple(executed))
    assert found.first == first
    assert found.last == first - 1 + len(removed)
    assert (found.removed, found.replacement) == (tuple(removed), tuple(replacement))


def window_of(task: Task, window: Window, **options: object) -> Interruption:
    report = serendipity.interruptions(task, **options)
    return next(entry for entry in report.windows if entry.window == window)


def test_case_1_is_handed_over_in_c() -> None:
    entry = window_of(cases.case_1(), Window(5, 6), discount="0.6")
    assert (entry.human_cost, entry.team_cost) == (8, Fraction("9.6"))
    assert entry.removal.replacement == ("hand_over rob h k2 c", "move h c d")
    assert (entry.removal.first, entry.removal.last) == (5, 8)


def test_other_options_are_refused() -> None:
    with pytest.raises(UsageError, match="'window_weight'"):
        serendipity.interruptions(cases.case_1(), window_weight=0)
