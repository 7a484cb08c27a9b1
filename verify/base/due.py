"""Plans where something happens without being chosen: parts of actions that go on, the script (semantics 10).

All this is about tasks in single epochs (:mod:`serendipity.model.task.unit_steps`).
"""

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property

from serendipity.model import GroundAction, HumanPlan, Step, Task
from serendipity.model.task.unit_steps import RESTING, WAITING
from verify.base.execution import State, applicable, executed, grouped, idling, is_calm, met


def onward(task: Task, state: State, chosen: Iterable[int], *, strict: bool) -> State | None:
    """The state after an epoch of actions and what is due; None if that is impossible."""
    return executed(state, [task.actions[i] for i in met(task, state, chosen)], strict=strict)


def waited(task: Task, state: State, epochs: int, *, strict: bool, plan: Sequence[int] = ()) -> State | None:
    """The state after some epochs of a plan and what is due; None if that is impossible."""
    here: State | None = state
    for epoch in range(epochs):
        if here is None or (epoch >= len(plan) and is_calm(task, here)):
            break
        here = onward(task, here, plan[epoch : epoch + 1], strict=strict)
    return here


def going_on(task: Task, epochs: int, *, strict: bool) -> HumanPlan:
    """What the human is at in the beginning, epoch by epoch, for some epochs at most."""
    state: State | None = task.init
    found: HumanPlan = ()
    while state is not None and len(found) < epochs:
        his = [i for i in met(task, state, ()) if task.human in task.actions[i].participants]
        if not his:
            break
        found, state = (*found, his[0]), onward(task, state, (), strict=strict)
    return found


def after_waiting(task: Task, plan: HumanPlan, epochs: int, *, strict: bool) -> HumanPlan:
    """A human plan from some epochs on, with waiting before it, once they are free.

    Who does nothing then has not waited for that.
    """
    acts, busy = not idling(task).issuperset(plan), going_on(task, epochs, strict=strict)
    waiting = (not acts and task.named.get(RESTING)) or task.named.get(WAITING, ())
    return busy + waiting[:1] * (epochs - len(busy)) + plan


def turns(task: Task, plan: Sequence[int], xi1: int) -> list[int]:
    """The epochs of a human plan whose state a window from ``xi1`` on may preserve (semantics 3.3).

    With them ``pi_H[1..j]`` is over, for each j; what is begun before ``xi1`` is part of that.
    """
    going_on, waiting = {i for _, i in task.due}, idling(task)
    acted = [0, *(k for k, i in enumerate(plan, start=1) if i not in waiting)]
    begun = max(k for k in acted if k < xi1)
    return [k for k in acted if k >= begun and (k in (0, len(plan)) or plan[k] not in going_on)]


def filled(task: Task, steps: Iterable[Step], last: int, *, strict: bool) -> tuple[Step, ...]:
    """A plan with all that is due; where it can't be executed any more what is left stays as it is."""
    sets = grouped((step.epoch, step.action) for step in steps)
    state: State | None = task.init
    found: list[Step] = []
    epoch = 0
    while state is not None and epoch != last and (sets or not is_calm(task, state)):
        epoch += 1
        chosen = met(task, state, sets.pop(epoch, ()))
        found += [Step(epoch, i) for i in chosen]
        state = executed(state, [task.actions[i] for i in chosen], strict=strict)
    return (*found, *(Step(epoch, i) for epoch in sorted(sets) for i in sets[epoch]))


class Moments:
    """Epochs in which nobody begins anything: those in which nothing but time passes are taken at once."""

    def __init__(self, task: Task, *, strict: bool) -> None:
        self._task, self._strict = task, strict

    def next(self, state: State, most: int = 1 << 60) -> tuple[int, State | None]:
        """Some epochs in which nobody begins anything, and the state after them; None: the first can't be."""
        due = frozenset(state & self._task.due_for.keys())
        epochs = min([most, *(self._runs[fact][1] for fact in due)])
        if not epochs:
            return 1, onward(self._task, state, (), strict=self._strict)
        possible = all(applicable(one, state) for one in self._actions(due))
        return epochs, state - due | self._later(due, epochs) if possible else None

    def after(self, state: State | None, epochs: int) -> State | None:
        """The state after some epochs in which nobody begins anything; None: one of them is impossible."""
        while epochs and state is not None:
            passed, state = self.next(state, epochs)
            epochs -= passed
        return state

    def ahead(self, due: State) -> Iterator[tuple[int, State]]:
        """Epochs from now in which more happens than that time passes, each with the facts at stake then.

        They are those whatever else is done, as long as all that is due can be.
        """
        epoch = 0
        while due:
            passed = min(self._runs[fact][1] for fact in due)
            now = self._actions(due := self._later(due, passed))
            due = frozenset(f for one in now for f in one.add if f in self._task.due_for)
            changed = (fact for one in now for fact in (*one.add, *one.delete))
            asked = (fact for one in (*now, *self._actions(due)) for fact in (*one.pre, *one.neg))
            yield epoch + passed, frozenset((*changed, *asked))
            epoch += passed + 1

    def _actions(self, due: State) -> list[GroundAction]:
        every = (i for fact in due for variants in self._task.due_for[fact] for i in variants)
        return [self._task.actions[i] for i in every]

    def _later(self, due: State, epochs: int) -> State:
        return frozenset(run[place - epochs] for run, place in map(self._runs.__getitem__, due))

    @cached_property
    def _runs(self) -> dict[int, tuple[list[int], int]]:
        """By fact that says what is due, it and what it becomes while time passes, last first; and its place.

        As long as only that changes, the same is asked for.
        """
        runs, asks = dict[int, tuple[list[int], int]](), dict[int, object]()
        for fact, groups in reversed([*self._task.due_for.items()]):
            one, runs[fact] = self._task.actions[groups[0][0]], ([fact], 0)
            single = len(groups) == len(groups[0]) == len(one.add) == 1 and one.delete == (fact,)
            if single and not one.cost and (following := one.add[0]) in runs:
                run, mine = runs[following][0], (set(one.pre) - {fact}, set(one.neg))
                if run[-1] != following or asks.get(following, mine) != mine:
                    run = [following]
                run.append(fact)
                runs[fact], asks[fact] = (run, len(run) - 1), mine
        return runs
