"""Answers with a window of one epoch, where longer ones can't be better: robots one by one, epoch by epoch.

Until the window the human follows ``pi_H``, and after it they go on alone; so all that robots can do for them
is what they leave behind.  For each epoch this is what each of them can have brought about on its own, put
together in every way, and what the human pays from there on their own, exactly.  Where robots need one
another, each may help itself to what others can have provided by then, for nothing: then it is a lower bound.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Final

from search.apart.conditions import are_apart, lost_values
from search.apart.outcomes import Outcomes, Together, outcomes
from search.apart.provision import by_others, provisions
from search.apart.rows import states
from search.apart.timeline import Timeline
from search.context import SearchContext
from search.engine.best_first import Incumbent
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operators import Operator
from search.spaces.from_composite import Suggestions
from serendipity.model.task.task import HumanPlan

_ACTION: Final = 1 << 24
"""Amounts are costs in these units, and a number of actions."""

_MOST_AMOUNT: Final = 1 << 62

_TRIALS: Final = 20
"""Of what costs least in an epoch so many are tried out, until one can be done."""


class ShortWindows:
    """Plans with a window of one epoch, by the epoch of the window.

    Args:
        context: of the call; its mode has windows after which the human replans.
        plan: ``pi_H``.
        horizon: ``T``.
        best: the call's incumbent, which is made better.

    Attributes:
        bound: no plan with a window of one epoch has a smaller key, but the incumbent.
    """

    def __init__(self, context: SearchContext, plan: HumanPlan, horizon: int, best: Incumbent) -> None:
        self._context = context
        self._plan = plan
        self._horizon = horizon
        self._best = best
        self._steps = [context.packed.op(action) for action in plan]
        packed = context.packed
        self._robots = sorted({op.agents for op in packed.others})
        self.bound = 0

    def answers(self) -> Iterator[None]:
        """Yield whenever the incumbent has become better; in the end the bound is as good as it gets.

        Raises:
            LimitReachedError: the deadline came, or there are too many states; what is known by then is kept.
        """
        context, packed = self._context, self._context.packed
        base, spent, least = packed.init, context.keys.epoch_weight, INFINITE_KEY
        lost, timelines = lost_values(packed), self._timelines()
        for epoch, step in enumerate(self._steps, 1):
            self.bound = min(least, spent)
            if spent >= self._best.key:
                return
            found = _Epoch(context, timelines, lost, base, self._best.key - spent)
            start = context.keys.of_start(epoch, self._horizon)
            cheap = found.cheapest(self._best.key - spent - start)
            least = min(least, spent + start + cheap[-1][0] if cheap else INFINITE_KEY)
            for _, place in cheap[: -_TRIALS - 1 : -1]:
                if self._try(found.ways(place)):
                    yield
                    break
            if epoch < len(self._steps):
                for timeline in timelines:
                    timeline.follow()
            base = base & step.keep | step.put
            spent += context.weights.team(step)
        self.bound = least

    def _timelines(self) -> list[Timeline]:
        context, packed = self._context, self._context.packed
        strict, deadline = context.options.strict, context.deadline
        provided = provisions(packed, self._steps, len(self._steps), deadline)
        return [
            Timeline(
                packed,
                robot,
                self._steps,
                by_others(provided, robot),
                self._amount,
                strict=strict,
                deadline=deadline,
            )
            for robot in self._robots
        ]

    def _amount(self, op: Operator) -> int:
        return self._context.weights.scaled_cost(op) * _ACTION + 1

    def _try(self, epochs: Sequence[Sequence[Operator]]) -> bool:
        """Whether robots can do this together, and it is the best so far."""
        best = self._best
        suggestions = Suggestions(self._context, self._plan, self._horizon, None, best.key)
        improved = False
        for found in suggestions.on_time(epochs):
            best.key, best.node, best.end, best.tail = found.key, found.node, found.end, found.tail
            improved = True
        return improved


class _Epoch:
    """What robots can have left behind if the window is in the next epoch.

    Args:
        context: of the call.
        timelines: robots, up to the window.
        lost: by field the values from which the human can't get to their goal.
        base: the packed state before it without them.
        limit: key from which on what they pay is too much.
    """

    def __init__(
        self,
        context: SearchContext,
        timelines: Sequence[Timeline],
        lost: Mapping[int, Collection[int]],
        base: int,
        limit: int,
    ) -> None:
        self._context = context
        self._timelines = timelines
        self._base = base
        deadline, fields = context.deadline, context.packed.fields
        relevant = context.relevant
        self._apart: list[Outcomes] = []
        self._shared: list[int] = []
        for timeline in timelines:
            others = 0
            for other in timelines:
                others |= 0 if other is timeline else other.changes
            own = [field for field in fields if field & timeline.changes & relevant]
            self._shared.append(others & sum(own))
            self._apart.append(outcomes(timeline.ends(), base, own, others, lost))
        most = _amount_of(context, limit)
        self._together = Together(self._apart, fields, most, deadline)

    def cheapest(self, limit: int) -> list[tuple[int, int]]:
        """Keys and places of what costs less than a limit, and than all before it.

        Args:
            limit: key that robots' costs and the rest of the human's have to stay below.
        """
        context, alone = self._context, self._context.alone
        found: list[tuple[int, int]] = []
        amounts = self._together.found.amounts
        order = amounts.argsort(kind="stable")
        left = states(self._together.found.rows)
        for place in order:
            context.deadline.tick()
            paid = context.amount_key(int(amounts[place]))
            if paid >= limit:
                break
            state = self._base ^ left[place]
            if paid + alone.least(state) < limit:
                rest = alone.key(state, limit - paid)
                if paid + rest < limit:
                    limit = paid + rest
                    found.append((limit, int(place)))
        return found

    def ways(self, place: int) -> list[list[Operator]]:
        """What robots do epoch by epoch for something that they leave behind."""
        epochs: list[list[Operator]] = [[] for _ in range(self._timelines[0].epochs + 1)]
        parts = self._together.parts(place)
        for timeline, apart, shared, part in zip(
            self._timelines, self._apart, self._shared, parts, strict=True
        ):
            change = states(apart.rows[:, part : part + 1])[0]
            mask = 0
            for field in self._context.packed.fields:
                if field & timeline.changes & self._context.relevant and (
                    change & field or not field & shared
                ):
                    mask |= field
            for epoch, op in enumerate(
                timeline.way(mask, (self._base ^ change) & mask, int(apart.amounts[part]))
            ):
                if op is not None:
                    epochs[epoch].append(op)
        return epochs


def _amount_of(context: SearchContext, key: int) -> int:
    """An amount from which on no key is below one."""
    return min((context.keys.scaled_cost(key) + 1) * _ACTION, _MOST_AMOUNT)


def short_windows(
    context: SearchContext, plan: HumanPlan, horizon: int, best: Incumbent
) -> ShortWindows | None:
    """Plans with a window of one epoch, robots one by one; None where they can't be looked at so.

    Args:
        context: of the call.
        plan: ``pi_H``.
        horizon: ``T``.
        best: the call's incumbent.

    Raises:
        LimitReachedError: the deadline came.
    """
    options, packed = context.options, context.packed
    plain = options.suffix == "replan" and options.preservation == "kernel" and not options.keep_prefix
    if not plain or options.max_cost is not None or context.task.robot_goal or not packed.others:
        return None
    if context.weights.announces or not are_apart(packed, context.deadline, strict=options.strict):
        return None
    dearest = max(map(context.weights.scaled_cost, packed.others))
    if dearest * _ACTION * len(plan) * len(context.task.robots) >= _MOST_AMOUNT:
        return None
    return ShortWindows(context, plan, horizon, best)
