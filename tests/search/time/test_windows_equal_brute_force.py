"""The report on windows where epochs count: for each window what brute force finds."""

from fractions import Fraction

import pytest
from hypothesis import given

import serendipity
from serendipity.model import PlanError, UsageError, Window
from serendipity.model.keywords import InterruptionOptions
from serendipity_testing.call import Call
from serendipity_testing.oracle.best import shifted
from serendipity_testing.oracle.interruptions import best_by_window
from serendipity_testing.strategies.time import calls_in_time


def _expected(call: Call) -> dict[Window, tuple[Fraction, Fraction]] | None:
    """Both least costs of each window that some plan fits; None where the human has no plan alone."""
    plan = call.human_plan
    if plan is None:
        names = ("waiting_cost", "head_start", "interference")
        alike = {name: getattr(call.options, name) for name in names}
        found = serendipity.plan(call.task, mode="individual", **alike)
        plan = None if found.human_entries is None else call.task.plan_from_names(found.human_entries)
    elif call.options.head_start:
        plan = shifted(call.task, plan, call.options.head_start)
    if plan is None:
        return None
    return best_by_window(call.task, call.options, plan)


@pytest.mark.long
@given(calls_in_time(modes=("serendipity",)))
def test_every_window_is_as_good_as_brute_force_finds_it(call: Call) -> None:
    asked = {name: getattr(call.options, name) for name in InterruptionOptions.__annotations__}
    try:
        report = serendipity.interruptions(call.task, human_plan=call.human_entries, **asked)
    except (UsageError, PlanError):
        try:
            _expected(call)
        except (UsageError, PlanError):
            return
        raise
    expected = _expected(call)
    found = {w.window: (w.human_cost, w.team_cost) for w in report.windows if w.human_cost is not None}
    assert found == (expected or {}), report.to_dict()
    assert (report.human_plan is None) == (expected is None)
