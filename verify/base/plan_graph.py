"""All optimal plans of the human as ways through a graph, which may have far fewer states than ways."""

from collections.abc import Iterator
from itertools import islice

from serendipity.model import HumanPlan, Options, Task, UsageError
from verify.base.due import after_waiting
from verify.base.execution import State
from verify.base.optimal_plans import OptimalPlans, along

Move = tuple[int, int]
"""An action, and the number of the state behind it, in the next layer."""


class OptimalPlanGraph:
    """The states that the human's optimal plans lead through, layer by layer.

    All optimal plans have the same number of actions, so a layer is an epoch.  Of several actions of one
    name, only the first begins a plan (semantics 1): ways and plans are the same.

    Args:
        most: how many there may be.

    Attributes:
        waits: whether plans may wait: then they are known one by one, and there are no moves.
        moves: by epoch (from 0) and state, what optimal plans do next, by name.
        count: the number of plans; 0 where the human can't reach their goal.

    Raises:
        UsageError: there are more than ``most``.
    """

    waits = False

    def __init__(self, task: Task, plans: OptimalPlans, most: int) -> None:
        self._task = task
        self.moves: list[list[list[Move]]] = []
        worth = plans.alone.optimum(task.init)
        self.count = 0
        if worth is None:
            return
        layer: dict[State, int] = {task.init: 0}
        ways = [1]  # that lead to each state; all of them go on
        for _ in range(worth[1]):
            after: dict[State, int] = {}
            moves = []
            for state in layer:
                steps = plans.steps(state)
                moves.append([(i, after.setdefault(reached, len(after))) for i, reached in steps])
            self.moves.append(moves)
            before, ways = ways, [0] * len(after)
            for count, onward in zip(before, moves, strict=True):
                for _, number in onward:
                    ways[number] += count
            layer = after
            if sum(ways) > most:
                raise UsageError(f"max_ties: the human has more than {most} optimal plans")
        self.count = sum(ways)

    def __len__(self) -> int:
        """The number of actions of a plan."""
        return len(self.moves)

    def plans(self) -> Iterator[HumanPlan]:
        """All plans, the canonical one first."""
        return along((0, 0), self._onward, lambda place: place[0] == len(self)) if self.count else iter(())

    def named(self, names: tuple[str, ...]) -> HumanPlan | None:
        """The plan of these names; None if it is no optimal one."""
        if not self.count or len(names) != len(self):
            return None
        plan: HumanPlan = ()
        state = 0
        for moves, name in zip(self.moves, names, strict=True):
            chosen = next(((i, n) for i, n in moves[state] if self._task.actions[i].name == name), None)
            if chosen is None:
                return None
            plan, state = (*plan, chosen[0]), chosen[1]
        return plan

    def _onward(self, place: tuple[int, int]) -> Iterator[tuple[int, tuple[int, int]]]:
        """What optimal plans do after an epoch, from a state by number."""
        epoch, state = place
        return (
            (i, (epoch + 1, after)) for i, after in (self.moves[epoch][state] if epoch < len(self) else ())
        )


class OptimalPlanList(OptimalPlanGraph):
    """The same plan by plan, where they may wait: beside a script, or before they are up (semantics 10.3)."""

    waits = True

    def __init__(self, task: Task, plans: OptimalPlans, options: Options) -> None:
        start, most = plans.alone.start, options.max_ties
        found = () if start is None else islice(plans.earliest(start), most + 1)
        late = (after_waiting(task, plan, options.head_start, strict=options.strict) for plan in found)
        self._named = {tuple(task.actions[i].name for i in plan): plan for plan in late}
        self.count = len(self._named)
        if self.count > most:
            raise UsageError(f"max_ties: the human has more than {most} optimal plans")

    def plans(self) -> Iterator[HumanPlan]:
        """See :class:`OptimalPlanGraph`."""
        yield from self._named.values()

    def named(self, names: tuple[str, ...]) -> HumanPlan | None:
        """See :class:`OptimalPlanGraph`."""
        return self._named.get(names)


def plan_graph(task: Task, plans: OptimalPlans, options: Options) -> OptimalPlanGraph:
    """The human's optimal plans, as a graph if all of them begin at once and never wait."""
    if task.of_bystanders or options.head_start:
        return OptimalPlanList(task, plans, options)
    return OptimalPlanGraph(task, plans, options.max_ties)
