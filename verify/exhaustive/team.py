"""The team's actions over packed states: which sets may share an epoch, and what comes of them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from serendipity.model import Deadline, GroundAction, Task
from verify.base.execution import awake, is_last
from verify.limits import limits
from verify.packed.layout import Ints, PackedLayout, Words
from verify.packed.operators import OperatorTable

Bools = NDArray[np.bool_]

_AT_ONCE: Final = 100_000
"""Sets of actions that are looked at before the deadline is, again."""

NOBODY: Final = -1
"""In the place of an action: the agent waits."""


@dataclass(frozen=True, slots=True)
class Steps:
    """Epochs from some states.

    Attributes:
        before: the row of the state that each starts in.
        sets: by agent, in the order of :class:`TeamEpochs`, the action that they are first in; or ``NOBODY``.
        after: the states that they lead to.
        cost: what they add to the objective.
    """

    before: Ints
    sets: Ints
    after: Words
    cost: Ints

    def only(self, kept: Bools) -> "Steps":
        """Some of them."""
        return Steps(self.before[kept], self.sets[kept], self.after[kept], self.cost[kept])


class TeamEpochs:
    """Sets of actions by which the agents spend an epoch.

    Args:
        actions: ids of those that may occur, as the table has them.
        table: the same as operators, whose weights are what they add to the objective.

    Attributes:
        order: the human, then the robots, then bystanders, and the clock last, as its actions take effect.
        of_human: the actions in which the human takes part, by the table's numbers.
    """

    def __init__(
        self, task: Task, actions: Sequence[int], table: OperatorTable, deadline: Deadline, *, strict: bool
    ) -> None:
        self._table = table
        self._deadline = deadline
        self.order = (task.human, *task.robots, *sorted(task.script.people))
        chosen = [task.actions[i] for i in actions]
        self._due = DueEpochs(task, actions, table.layout) if task.due else None
        self._free = np.array([i in task.of_bystanders for i in actions], bool)
        costly = [fact for fact in awake(task) if fact in table.layout.place]
        self._awake = table.test(costly, ()) if costly else None
        self._with_human = np.array([task.human in action.participants for action in chosen], bool)
        self.of_human = np.flatnonzero(self._with_human)
        rank = {agent: k for k, agent in enumerate(self.order)}
        self._first = np.array([min(rank[a] for a in action.participants) for action in chosen], np.int64)
        self._apart = excluding(chosen, len(task.facts), len(task.agents), strict=strict)

    def is_calm(self, states: Words) -> Bools:
        """By state whether nothing happens from it on unless somebody does it."""
        return np.ones(len(states), bool) if self._due is None else self._due.is_calm(states)

    def steps(
        self,
        states: Words,
        of_human: Ints | None = None,
        *,
        wait: bool = True,
        robots: bool = True,
        free: bool = False,
    ) -> Iterator[Steps]:
        """All epochs from some states, in pieces.

        Args:
            of_human: what the human may take part in, by the table's numbers; None: anything.
            wait: whether the human may do nothing.
            robots: whether robots may act without the human; bystanders do in any case.
            free: whether the human may do nothing even where waiting costs.
        """
        at_once = limits().states_at_once
        for first in range(0, len(states), at_once):
            self._deadline.check()
            some = states[first : first + at_once]
            for steps in self._steps(some, of_human, wait=wait, robots=robots):
                if self._awake is not None and not free:
                    acting = (steps.sets[:, 0] != NOBODY) | ~self._awake(some[steps.before])
                    steps = steps.only(acting)
                yield replace(steps, before=steps.before + first)

    def _steps(self, states: Words, of_human: Ints | None, *, wait: bool, robots: bool) -> Iterator[Steps]:
        rows, operators = self._table.applicable(states)
        if of_human is not None or not robots:
            his = self._with_human[operators] if of_human is None else np.isin(operators, of_human)
            fits = his | (~self._with_human[operators] if robots else self._free[operators])
            rows, operators = rows[fits], operators[fits]
        lists = []
        product = np.ones(len(states), np.int64)
        for k in range(len(self.order)):
            mine = np.flatnonzero(self._first[operators] == k)
            mine = mine[np.argsort(rows[mine], kind="stable")]
            counts = np.bincount(rows[mine], minlength=len(states))
            starts = np.cumsum(counts) - counts
            lists.append((operators[mine], starts, counts))
            product *= counts + (wait or k > 0)
        pieces = np.cumsum(product) // _AT_ONCE
        cuts = np.flatnonzero(np.diff(pieces)) + 1
        for piece in np.split(np.arange(len(states)), cuts):
            self._deadline.check()
            if len(piece):
                yield self._piece(states, piece, lists, wait=wait)

    def _piece(
        self, states: Words, before: Ints, lists: list[tuple[Ints, Ints, Ints]], *, wait: bool
    ) -> Steps:
        sets = np.full((len(before), 0), NOBODY)
        for k, (operators, starts, counts) in enumerate(lists):
            idle = 1 if wait or k > 0 else 0
            sizes = counts[before] + idle
            ends = np.cumsum(sizes)
            which = np.repeat(np.arange(len(before)), sizes)
            offset = np.arange(len(which)) - np.repeat(ends - sizes, sizes) - idle
            before = before[which]
            own = np.full(len(which), NOBODY)
            acts = offset >= 0
            own[acts] = operators[starts[before[acts]] + offset[acts]]
            fits = np.ones(len(which), bool)
            for others in sets[which].T:
                both = acts & (others != NOBODY)
                fits[both] &= ~self._apart[own[both], others[both]]
            before = before[fits]
            sets = np.concatenate((sets[which][fits], own[fits, None]), axis=1)
        after, cost = states[before], np.zeros(len(before), self._table.weight.dtype)
        for own in sets.T:
            acts = own != NOBODY
            after[acts] = self._table.after(after[acts], own[acts])
            cost[acts] += self._table.weight[own[acts]]
        steps = Steps(before, sets, after, cost)
        return steps if self._due is None else self._due.only_met(states, steps)


class DueEpochs:
    """What is due in packed states (semantics 10): epochs without it are none.

    Args:
        layout: where facts stand; what is due for another fact does not matter.
    """

    def __init__(self, task: Task, actions: Sequence[int], layout: PackedLayout) -> None:
        number = {i: k for k, i in enumerate(actions)}
        self._lasting: dict[int, Bools] = {}
        self._values = layout.values
        self._begun: list[tuple[int, int, Ints]] = []
        for fact, groups in task.due_for.items():
            place = layout.place.get(fact)
            if place is None:
                continue
            values = self._lasting.setdefault(place.field, np.zeros(layout.fields[place.field].size, bool))
            values[place.value] = True
            for variants in groups:
                if fact not in task.actions[variants[0]].delete:  # it begins beside what takes the fact away
                    numbers = np.array([number[i] for i in variants if i in number], np.int64)
                    self._begun.append((place.field, place.value, numbers))

    def only_met(self, states: Words, steps: Steps) -> Steps:
        """The epochs that contain what is due: the facts that it is due for do not last."""
        before, kept = states[steps.before], np.ones(len(steps.before), bool)
        for field, due in self._lasting.items():
            values = self._values(field, before)
            kept &= ~due[values] | (values != self._values(field, steps.after))
        for field, value, numbers in self._begun:
            kept &= (self._values(field, before) != value) | np.isin(steps.sets, numbers).any(axis=1)
        return steps.only(kept)

    def is_calm(self, states: Words) -> Bools:
        """By state whether nothing is due in it."""
        calm = np.ones(len(states), bool)
        for field, due in self._lasting.items():
            calm &= ~due[self._values(field, states)]
        return calm


def excluding(actions: Sequence[GroundAction], facts: int, agents: int, *, strict: bool) -> Bools:
    """Which actions can't share an epoch with which others (eq. 5, 6, 10), all declared effects counted.

    Args:
        strict: whether none may falsify a precondition of another either.
    """

    def table(sets: Sequence[tuple[int, ...]], size: int) -> NDArray[np.float32]:
        found = np.zeros((len(sets), size), np.float32)
        for row, members in enumerate(sets):
            found[row, list(members)] = 1
        return found

    adds = table([action.add for action in actions], facts)
    deletes = table([action.delete for action in actions], facts)
    busy = table([action.participants for action in actions], agents)
    apart = (deletes @ deletes.T > 0) | (busy @ busy.T > 0)
    one_way = deletes @ adds.T > 0
    if strict:
        one_way |= deletes @ table([action.pre for action in actions], facts).T > 0
        one_way |= adds @ table([action.neg for action in actions], facts).T > 0
    found = np.asarray(apart | one_way | one_way.T)
    last = [k for k, action in enumerate(actions) if is_last(action)]
    found[last, :] = found[:, last] = False  # nobody is in the script's way
    return found
