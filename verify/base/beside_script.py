"""The human alone beside a script (semantics 10.3): (cost, epochs) of an optimal plan from a state on."""

from collections.abc import Iterator
from typing import Final

from serendipity.model import Options, Task
from serendipity.model.resources.deadline import Deadline
from verify.base.due import going_on, onward, waited
from verify.base.execution import State, applicable, awake, due, idling, is_calm
from verify.base.individual import IndividualOptimum
from verify.base.shortest_paths import PathSearch
from verify.base.undecided import TooManyStatesError, during
from verify.limits import limits

_OVER: Final[State] = frozenset((-1,))
"""Where the human is once they have done the rest alone, and nothing else happens any more."""


class AloneBesideScript(IndividualOptimum):
    """The same as for any human alone, where states go on by themselves as long as the script runs.

    The clock is part of a state, so that what is known of a state is known of its epoch.  Who replans knows
    what robots are at, too, and lets it go on (semantics 10.6); else there is no plan beside it.

    Args:
        options: its head start, its human model, and its interference, which says what disturbs a bystander.
    """

    def __init__(self, task: Task, deadline: Deadline | None, options: Options) -> None:
        super().__init__(task, deadline)
        self._head_start, self._strict = options.head_start, options.strict
        self._beside_robots = options.human_model != "omniscient"
        self._waiting = idling(task)
        self._weight: dict[State, int | None] = {}

    @property
    def start(self) -> State | None:
        """See :class:`IndividualOptimum`; nobody pays for a head start who gets by resting what they want."""
        state = waited(self._task, self._task.init, self._head_start, strict=self._strict)
        rest = state - awake(self._task) if state is not None and self.head_start_cost else None
        return state if rest is None or self.weight(rest) is None else rest

    def moves(self, state: State) -> Iterator[tuple[int, State]]:
        """See :class:`IndividualOptimum`; waiting is one of them while anything happens."""
        task = self._task
        begun = [variants for variants in due(task, state) if variants[0] not in task.of_bystanders]
        his = [variants for variants in begun if task.human in task.actions[variants[0]].participants]
        if not self._beside_robots and any(
            task.actions[one[0]].participants != (task.human,) for one in begun
        ):
            return  # a robot is at something
        free = (i for i in task.human_actions if i not in self._waiting or not is_calm(task, state))
        for i in his[0] if his else free:
            if applicable(task.actions[i], state):
                after = onward(task, state, (i,), strict=self._strict)
                if after is not None:
                    yield i, after

    def weight(self, state: State) -> int | None:
        """See :class:`IndividualOptimum`; waiting counts as epochs, and is no action."""
        if state not in self._weight:
            with during("searching for what the human can do alone"):
                self._weight[state] = self._found(state)
        return self._weight[state]

    def _found(self, state: State) -> int | None:
        search = PathSearch(state, self._edges, lambda _: 0, self.deadline)
        for expansions, (here, _) in enumerate(search):
            if here is _OVER or self._task.goal.holds(here):
                return search.distance[here]
            if expansions >= limits().own_states:
                raise TooManyStatesError
        return None

    def _edges(self, state: State) -> Iterator[tuple[State, int, int | None]]:
        if is_calm(self._task, state):
            rest = super().weight(state)
            if rest is not None:
                yield _OVER, rest, None
            return
        for i, after in self.moves(state):
            yield after, self.own.weight(i), i

    def within(self, state: State, most: int) -> bool:
        """See :class:`IndividualOptimum`."""
        if is_calm(self._task, state):
            return super().within(state, most)
        found = self.weight(state)
        return found is not None and found <= most


def alone_of(
    task: Task, deadline: Deadline | None = None, options: Options | None = None
) -> IndividualOptimum:
    """What is to be known of the human alone, with a script or without; ``options`` are a call's."""
    asked = options or Options()
    if task.of_bystanders or (task.due and asked.human_model != "omniscient"):
        found: IndividualOptimum = AloneBesideScript(task, deadline, asked)
    else:
        found = IndividualOptimum(task, deadline)
    if asked.waiting_cost:
        busy = len(going_on(task, asked.head_start, strict=asked.strict))
        found.head_start_cost = asked.waiting_cost * (asked.head_start - busy)
    return found
