"""The human alone beside a script (semantics 10.3): (cost, epochs) of an optimal plan from a state on.

They are looked at from action to action.  Waiting matters where something else happens: between two epochs
in which what an action asks or changes is at stake it is the same whenever the action begins, so it begins as
soon as it can; and what changes nothing that others ask for or change begins as soon as that is possible.
"""

from collections.abc import Iterable, Iterator
from functools import cached_property

from serendipity.model import Condition, Deadline, GroundAction, Options, Task
from verify.base.bit_distances import BitDistances
from verify.base.due import Moments, going_on, onward, waited
from verify.base.execution import State, applicable, awake, due, idling, is_calm
from verify.base.individual import Graph, IndividualOptimum
from verify.base.shortest_paths import PathSearch
from verify.base.undecided import SEARCHING, HumanTooLargeError, during
from verify.limits import limits


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
        self._waiting, parts = idling(task), {i for _, i in task.due}
        self._to_begin = [i for i in task.human_actions if i not in parts]
        self._moments = Moments(task, strict=self._strict)
        self._known_begins: dict[tuple[State, int], tuple[list[int], bool]] = {}

    @property
    def start(self) -> State | None:
        """See :class:`IndividualOptimum`; nobody pays for a head start who gets by resting what they want."""
        state = waited(self._task, self._task.init, self._head_start, strict=self._strict)
        rest = state - awake(self._task) if state is not None and self.head_start_cost else None
        return state if rest is None or self.weight(rest) is None else rest

    def moves(self, state: State) -> Iterator[tuple[int, State]]:
        """See :class:`IndividualOptimum`; waiting is one of them while anything happens."""
        task, his = self._task, self._going_on(state)
        if his is None:
            return  # a robot is at something
        free = (i for i in self._to_begin if i not in self._waiting or not is_calm(task, state))
        for i in his or free:
            if applicable(task.actions[i], state):
                after = onward(task, state, (i,), strict=self._strict)
                if after is not None:
                    yield i, after

    def _going_on(self, state: State) -> tuple[int, ...] | None:
        """The variants of what the human is at; None if a robot is, and there is no plan beside it."""
        actions, others = self._task.actions, self._task.of_bystanders
        begun = [variants for variants in due(self._task, state) if variants[0] not in others]
        alone = (self._task.human,)
        if not self._beside_robots and any(actions[one[0]].participants != alone for one in begun):
            return None
        return next((one for one in begun if self._task.human in actions[one[0]].participants), ())

    # -- until they are free

    def weight(self, state: State) -> int | None:
        """See :class:`IndividualOptimum`; waiting counts as epochs, and is no action."""
        paid, free = self._free(state)
        rest = None if free is None else super().weight(free)
        return None if rest is None else paid + rest

    def within(self, state: State, most: int) -> bool:
        """See :class:`IndividualOptimum`."""
        paid, free = self._free(state)
        return free is not None and super().within(free, most - paid)

    def _free(self, state: State) -> tuple[int, State | None]:
        """What the human is at weighs, and the state once they are free; None: they can't go on, or never."""
        paid, here = 0, state
        while his := self._going_on(here):
            part = next((i for i in his if applicable(self._task.actions[i], here)), his[0])
            epochs, after = self._moments.next(here)
            if after is None:
                return paid, None
            paid, here = paid + epochs * self.own.weight(part), after
        return paid, None if his is None and not self._task.goal.holds(here) else here

    # -- from action to action

    def sight(self, state: State) -> int | State:
        """See :class:`IndividualOptimum`; what happens anyway does, too."""
        return super().sight(state) if is_calm(self._task, state) else state & self._matters

    @during(SEARCHING)
    def _least(self, state: State, below: int | None) -> int | None:
        if is_calm(self._task, state):
            return super()._least(state, below)
        search = PathSearch(state, self._edges, self._bound, self.deadline, below)
        for expansions, (here, _) in enumerate(search):
            if self._task.goal.holds(here):
                return search.distance[here]
            if expansions >= limits().own_states:
                raise HumanTooLargeError
        return None

    def _bound(self, state: State) -> int | None:
        """What is left at least if what others change is always as it has to be."""
        bits = self.own.bits.of(state)
        known, least = self._table.tabled(bits)
        return least if known else self._projection.bound(bits)

    @cached_property
    def _table(self) -> BitDistances:
        return self._without_others(self.own.facts - self._changed_by_others)

    @cached_property
    def _matters(self) -> State:
        happens = (self._task.actions[i] for _, i in self._task.due)
        asked = (fact for one in happens for fact in (*one.pre, *one.neg))
        return self.own.facts.union(asked, awake(self._task))

    @cached_property
    def _changed_by_others(self) -> State:
        actions, task = self._task.actions, self._task
        others = {i for _, i in task.due} if self._beside_robots else task.of_bystanders
        theirs = (actions[i] for i in others if actions[i].participants != (task.human,))
        return frozenset(fact for one in theirs for fact in (*one.add, *one.delete))

    @cached_property
    def _wholes(self) -> list[tuple[int, list[GroundAction], int, int]]:
        """What the human may begin, by ids, each with all that is due after it, in all its ways."""
        chosen = (i for i in self._to_begin if i not in self._waiting)
        each = ((i, self.own.wholes(i)) for i in self.deadline.each(chosen))
        return [(i, [whole[0] for whole in ways], *ways[0][1:]) for i, ways in each]

    def graph(self) -> Graph:
        """See :class:`IndividualOptimum`; they are free there."""
        start = self.start
        return None if start is None else self._free(start)[1], self._edges, self._task.goal.holds

    def _edges(self, state: State) -> Iterator[tuple[State, int, int | None]]:
        """From who is free to who is free again, or has what they want without an action."""
        task, moments, costs = self._task, self._moments, sorted(map(self.own.weight, self._waiting))
        epochs, here = 0, state if self._may_hold(task.goal, state) else None
        while here is not None and not is_calm(task, here):
            passed, here = moments.next(here)
            epochs += passed
            if here is not None and task.goal.holds(here):
                yield here, epochs * costs[0], None
                break
        for i, ways, weight, length in self._wholes:
            if self._may_hold(Condition(task.actions[i].pre, task.actions[i].neg), state):
                due = frozenset(state & task.due_for.keys())
                begins, first_will_do = self._begins(due, i, length, ways)
                epochs, here = 0, state
                for begin in begins:
                    here, epochs = moments.after(here, begin - epochs), begin
                    done = None if here is None else onward(task, here, (i,), strict=self._strict)
                    after = moments.after(done, length - 1)
                    if after is not None:
                        yield after, epochs * costs[-1] + weight, i
                    if here is None or (after is not None and first_will_do):
                        break

    def _may_hold(self, condition: Condition, state: State) -> bool:
        """Whether others might make a condition true."""
        lacking = condition.open(state)
        return self._changed_by_others.issuperset((*lacking.positive, *lacking.negative))

    def _begins(
        self, due: State, action: int, length: int, ways: Iterable[GroundAction]
    ) -> tuple[list[int], bool]:
        """Epochs from now with which an action may have to begin; whether the first possible one will do."""
        if (due, action) not in self._known_begins:
            sets = frozenset(fact for whole in ways for fact in (*whole.add, *whole.delete))
            stakes = sets.union(fact for whole in ways for fact in (*whole.pre, *whole.neg))
            begins, alone = {0}, True
            for epoch, facts in self._moments.ahead(due):
                if not facts.isdisjoint(stakes):
                    begins.update(epoch - before for before in (length - 1, length - 2, 0, -1))
                    alone = alone and facts.isdisjoint(sets)
            self._known_begins[due, action] = sorted(each for each in begins if each >= 0), alone
        return self._known_begins[due, action]


def alone_of(
    task: Task, deadline: Deadline | None = None, options: Options | None = None
) -> IndividualOptimum:
    """What is to be known of the human alone, with a script or without; ``options`` are a call's."""
    asked = options or Options()
    beside = task.of_bystanders or (task.due and asked.human_model != "omniscient")
    found = AloneBesideScript(task, deadline, asked) if beside else IndividualOptimum(task, deadline)
    if asked.waiting_cost:
        busy = len(going_on(task, asked.head_start, strict=asked.strict))
        found.head_start_cost = asked.waiting_cost * (asked.head_start - busy)
    return found
