"""The one suffix that the human takes after a window: the canonical one of rule 3 (semantics 3.1, 11)."""

from collections.abc import Callable
from fractions import Fraction
from functools import cache

from serendipity.model import Deadline, HumanPlan, Options, Task
from verify.base.due import waited
from verify.base.execution import State, after, applicable, facts_of_his, states_of_pi_h
from verify.base.optimal_plans import OptimalPlans

Suffix = Callable[[State, int, int], HumanPlan | None]
"""What the human does from a state on, epoch by epoch, given the first epoch of the window and how many more
there are after it; None: nothing fits."""


class PlannedSuffix:
    """What is left of ``pi_H``: the cheapest part, of those the shortest, then the first by names.

    Args:
        literal: whether the state has to be as the plan would have made it, and all that follows is done.
    """

    def __init__(self, task: Task, plan: HumanPlan, deadline: Deadline, *, literal: bool) -> None:
        self._task, self._plan, self._literal = task, plan, literal
        his = facts_of_his(task, deadline)
        self._expected = [state & his for state in states_of_pi_h(task, plan, deadline)]
        self._rest = cache(self._best)

    def __call__(self, state: State, start: int, left: int) -> HumanPlan | None:
        """See :data:`Suffix`."""
        indices = range(start - 1, len(self._plan) + 1) if self._literal else (0,)
        begun = (k for k in indices if not self._literal or state >= self._expected[k])
        rests = [rest for k in begun if (rest := self._rest(state, k, left)) is not None]
        return min(rests, key=self._order, default=None)

    def _best(self, state: State, index: int, left: int) -> HumanPlan | None:
        """What the human still does, from an index on; None: that is no way to the goal."""
        size, found = len(self._plan), list[HumanPlan]()
        if self._task.goal.holds(state) and (index == size or not self._literal):
            found.append(())
        for k in range(index, min(size, index + 1 if self._literal else size) if left else 0):
            action = self._task.actions[self._plan[k]]
            if applicable(action, state):
                rest = self._rest(after(state, action), k + 1, left - 1)
                if rest is not None:
                    found.append((self._plan[k], *rest))
        return min(found, key=self._order, default=None)

    def _order(self, rest: HumanPlan) -> tuple[Fraction, int, list[str]]:
        return self._task.cost_of(rest), len(rest), [self._task.actions[i].name for i in rest]


def suffix_of(task: Task, options: Options, plan: HumanPlan, plans: OptimalPlans) -> tuple[Suffix, State]:
    """The rule that is in force in a scenario, whose plan is ``plan``, and all facts that matter to it."""
    suffix, facts = _by_rule_3(task, options, plan, plans)
    if not task.robot_goal:
        return suffix, facts

    def keeping(state: State, start: int, left: int) -> HumanPlan | None:
        rest = suffix(state, start, left)
        end = state if rest is None else waited(task, state, left, strict=options.strict, plan=rest)
        return rest if end is not None and task.robot_goal.holds(end) else None

    return keeping, frozenset(range(len(task.facts)))


def _by_rule_3(task: Task, options: Options, plan: HumanPlan, plans: OptimalPlans) -> tuple[Suffix, State]:
    literal, every = options.preservation == "state", frozenset(range(len(task.facts)))
    if literal or options.suffix == "subplan":
        return PlannedSuffix(task, plan, plans.deadline, literal=literal), every
    facts = every if task.of_bystanders else plans.alone.own.facts
    return lambda state, _, left: plans.lasting(state, left, task.goal, strict=options.strict), facts
