"""The interruptibility report by brute force (semantics 3.2)."""

from fractions import Fraction

from serendipity.model import HumanPlan, Options, Task, Window
from serendipity_testing.oracle.labels import Label
from serendipity_testing.oracle.plans import Plans

Best = tuple[Fraction, Fraction]
"""Least cost for the human, and least cost for the team."""


def best_by_window(task: Task, options: Options, human_plan: HumanPlan) -> dict[Window, Best]:
    """Both least costs over all plans that fit each window; windows that nothing fits are left out."""
    asked = options.but(
        mode="serendipity",
        window_weight=0,
        max_cost=None,
        max_window=None,
        keep_prefix=False,
        nobody_pays=False,
        leave_free=None,
        max_disturbance=None,
    )
    plans = _BothCosts(task, asked, human_plan)
    found: dict[Window, list[Label]] = {}
    if not task.robot_goal:  # pi_H with idle robots fits every window
        cost = plans.units(plans.cost_of_plan())
        last = int(plans.horizon or 0)
        for start in range(1, plans.length + 1):
            for end in range(start + 1, last + 2):
                found[Window(start, end)] = [(cost, cost, 0, 0, 0)]
    for candidate in plans.windows():
        assert candidate.window is not None
        found.setdefault(candidate.window, []).append(candidate.label)
    return {
        window: (
            plans.cost(min(label[0] for label in labels)),
            plans.cost(min(label[1] for label in labels)),
        )
        for window, labels in found.items()
    }


class _BothCosts(Plans):
    """Labels whose first part is what the human pays, and whose second is what the team pays."""

    def price(self, i: int) -> Label:
        """See :class:`Plans`."""
        action = self.task.actions[i]
        if self.task.human in action.participants:
            return (self.units(action.cost), self.units(action.cost), 1, 0, 0)
        return (0, self.units(action.cost * (1 - self.options.discount)), 1, 0, 0)
