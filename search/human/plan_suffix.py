"""Rules for the suffix that keep actions of ``pi_H`` (semantics 3.1 rule 3, 3.3).

The human ends what they are at.  Then each action that is left is begun at once or, as long as a script goes
on, after some waiting, and its epochs follow each other (semantics "Time").
"""

from collections.abc import Callable, Collection, Iterator, Sequence
from typing import NamedTuple

from search.packed.cost_vector import INFINITE_KEY
from search.packed.due import Due
from search.packed.joint_actions import NOTHING, JointAction, as_option
from search.packed.operators import Operator, applicable
from search.packed.packed_task import PackedGoal, PackedTask
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.task import HumanPlan


class _Rest(NamedTuple):
    """A point between two actions.

    Attributes:
        begun: the first action of ``pi_H`` that is left.
        left: how many epochs are left.
        skips: whether actions may be left out.
    """

    begun: int
    state: int
    left: int
    skips: bool


class _Way(NamedTuple):
    """A way on: what it costs, the actions of its epochs, the point that it leads to."""

    weight: int
    actions: tuple[int, ...]
    rest: _Rest


class PlanSuffix:
    """A suffix of actions of ``pi_H``: any subsequence (Def. 2.0, eq. 9), or all from one on (Def. 3.1).

    Args:
        plan: ``pi_H``, in single epochs.
        weight: key increment of an op.
        due: what happens whatever is chosen.
        own: facts of the human's own domain, where the state decides which actions are left (semantics 3.3);
            None for any subsequence.
    """

    def __init__(
        self,
        packed: PackedTask,
        plan: HumanPlan,
        weight: Callable[[Operator], int],
        due: Due,
        goals: Sequence[PackedGoal],
        own: Collection[int] | None,
        deadline: Deadline,
    ) -> None:
        self._packed = packed
        self._due = due
        self._goals = goals
        self._deadline = deadline
        begun = [(epoch, packed.op(i)) for epoch, i in enumerate(plan, start=1) if packed.counted(i)]
        self._starts = [epoch for epoch, _ in begun]
        self._first = [as_option(op, weight(op)) for _, op in begun]
        waiting = map(packed.op, packed.idling[:1])
        priced = (as_option(op, weight(op) if packed.prices_waiting else 0) for op in waiting)
        self._waiting = next(priced, NOTHING)
        self._expected = None if own is None else [self._seen(state, own) for state in self._ended(plan)]
        self._known: dict[_Rest, tuple[int, _Way | None]] = {}

    def _ended(self, plan: HumanPlan) -> list[int]:
        """The packed states in which each of the first ``j`` actions has ended, robots idle."""
        states = [state := self._packed.init]
        for epoch, action in enumerate(plan, start=1):
            after = self._due.after_all(state, (action,))
            assert after is not None, "pi_H is a plan"
            state = after
            if self._due.human(state) is None and len(states) <= sum(s <= epoch for s in self._starts):
                states.append(state)
        return states

    def _seen(self, state: int, own: Collection[int]) -> PackedGoal:
        """What holds in a state of the human's own facts."""
        bits = ((fact, self._packed.fact_bits[fact]) for fact in sorted(own))
        return self._packed.condition(
            Condition(tuple(fact for fact, at in bits if at is not None and state & at[0] == at[1]))
        )

    def key(self, state: int, epochs: int, start: int, limit: int) -> int:
        """See :class:`.Replan`."""
        ends = (paid + self._best(rest)[0] for paid, rest in self._begins(state, epochs, start))
        return min(min(ends, default=INFINITE_KEY), INFINITE_KEY)

    def actions(self, state: int, epochs: int, start: int) -> tuple[int, ...]:
        """See :class:`.Replan`."""
        _, rest = min(self._begins(state, epochs, start), key=lambda begun: self._best(begun[1])[0])
        found = [*self._packed.idling[-1:]] * (epochs - rest.left)  # which is told apart by nobody
        while (way := self._best(rest)[1]) is not None:
            found += way.actions
            rest = way.rest
        return tuple(found)

    def _begins(self, state: int, epochs: int, start: int) -> list[tuple[int, _Rest]]:
        """The points at which the suffix may begin, once the human is free; what they have paid by then."""
        if not self._packed.at_rest.holds(state):
            return []
        finished = self._due.finished(state)
        if finished is None or len(finished[2]) > epochs:
            return []
        state, paid, following = finished
        epochs -= len(following)
        if not self._packed.in_time:  # then waiting at the end makes no difference
            epochs = min(epochs, len(self._first))
        if self._expected is None:
            return [(paid, _Rest(0, state, epochs, True))]
        first = sum(first < start for first in self._starts)
        expected = list(enumerate(self._expected))[first:]
        return [(paid, _Rest(j, state, epochs, False)) for j, at in expected if at.holds(state)]

    def _best(self, wanted: _Rest) -> tuple[int, _Way | None]:
        """The least key from a point on, and the way that it takes; None where the plan ends there."""
        known = self._known
        pending = [wanted]  # plans may be longer than Python's stack is deep
        while pending:
            self._deadline.tick()
            at = pending[-1]
            ways = [] if at in known else [*self._ways(at)]
            missing = [way.rest for way in ways if way.rest not in known]
            if missing:
                pending += missing
                continue
            if at not in known:
                known[at] = self._cheapest(at, ways)
            pending.pop()
        return known[wanted]

    def _cheapest(self, at: _Rest, ways: list[_Way]) -> tuple[int, _Way | None]:
        best: tuple[int, _Way | None] = INFINITE_KEY, None
        if at.begun == len(self._first) and self._due.lasting(at.state, at.left, self._goals):
            best = 0, None
        for way in ways:
            key = way.weight + self._known[way.rest][0]
            if key < best[0]:
                best = key, way
        return best

    def _ways(self, at: _Rest) -> Iterator[_Way]:
        """Leaving an action out, doing it, if that is possible, and waiting, while the script lasts."""
        if at.begun == len(self._first):
            return
        if at.skips:
            yield _Way(0, (), at._replace(begun=at.begun + 1))
        way = self._done(at, self._first[at.begun])
        if way is not None:
            yield way
        if self._due.last(at.state) is not None and at.left > 1:
            after = self._wait(at.state)
            if after is not None:
                rest = at._replace(state=after, left=at.left - 1)
                yield _Way(self._waiting.weight, self._waiting.actions, rest)

    def _wait(self, state: int) -> int | None:
        possible = applicable(self._packed.op(self._waiting.actions[0]), state)
        return self._due.after(state, (self._waiting,)) if possible else None

    def _done(self, at: _Rest, part: JointAction) -> _Way | None:
        """An action from its first epoch to its last."""
        if not at.left or not applicable(self._packed.op(part.actions[0]), at.state):
            return None
        begun = self._due.after(at.state, (part,))
        finished = None if begun is None else self._due.finished(begun)
        if finished is None or len(finished[2]) >= at.left:
            return None
        state, weight, following = finished
        rest = _Rest(at.begun + 1, state, at.left - 1 - len(following), at.skips)
        return _Way(part.weight + weight, part.actions + following, rest)
