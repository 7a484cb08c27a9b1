"""The report on windows where epochs count: for each window what brute force finds."""

from fractions import Fraction

from hypothesis import given

import serendipity
from serendipity.model import PlanError, UsageError, Window
from serendipity.model.keywords import InterruptionOptions
from serendipity.testing.call import Call
from serendipity.testing.oracle.in_time import SolverInTime, shifted
from serendipity.testing.oracle.labels import Label
from serendipity.testing.strategies.time import calls_in_time


class _BothCosts(SolverInTime):
    """Labels whose first part is what the human pays, and whose second is what the team pays."""

    def _price(self, i: int) -> Label:
        action = self.task.actions[i]
        if self.task.human in action.participants:
            return (self._units(action.cost), self._units(action.cost), 1)
        return (0, self._units(action.cost * (1 - self.options.discount)), 1)


def _expected(call: Call) -> dict[Window, tuple[Fraction, Fraction]] | None:
    """Both least costs of each window that some plan fits; None where the human has no plan alone."""
    asked = call.options.but(mode="serendipity", window_weight=0, max_window=None, ties="fixed")
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
    solver = _BothCosts(call.task, asked, plan, given=True)
    labels: dict[Window, list[Label]] = {}
    if not call.task.robot_goal:
        cost = solver._units(solver._cost_of(plan))
        for start in range(1, solver.length + 1):
            for end in range(start + 1, int(solver.horizon or 0) + 2):
                labels[Window(start, end)] = [(cost, cost, 0)]
    for candidate in solver._windows():
        assert candidate.window is not None
        labels.setdefault(candidate.window, []).append(candidate.label)
    return {
        window: (solver._cost(min(one[0] for one in each)), solver._cost(min(one[1] for one in each)))
        for window, each in labels.items()
    }


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
