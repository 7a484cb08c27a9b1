"""All plans of a question, epoch by epoch: dynamic programming over states with what was paid.

Every state that some plan leads to is kept once for each epoch and part of the plan (prefix, window), at
its least cost.  Within a window a state that was there in an earlier epoch at no higher cost is left out:
whoever can wait loses nothing by being early (semantics 1).  From the ends of windows on the human is
alone: one search from all of them, each with what was paid there, finds the cheapest completion.

States are left out whose cost and a lower bound on what follows pass the question's limit.  The bounds are
those of ``verify.packed``: everybody's actions one after the other, with actions that only work together
as one.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from serendipity.model import LimitReachedError, Step, Window
from serendipity.model.errors import LIMITS, limit_reason
from verify.base.execution import State, states_along
from verify.base.optimal_plans import OptimalPlans
from verify.base.relevance import Relevant, relevant_part
from verify.base.subproblem import EXACT, FREE, WINDOW, PricedPlan, Subproblem, in_plan
from verify.base.undecided import UndecidedError, during
from verify.exhaustive.layers import EpochLayer, advance, first
from verify.exhaustive.team import NOBODY, Steps, TeamEpochs
from verify.exhaustive.team_problem import as_operator, team_problem
from verify.limits import limits
from verify.packed.cheapest_path import TooManyPackedStatesError
from verify.packed.layout import Words
from verify.packed.operators import Ints, OperatorTable
from verify.packed.pattern import FAR
from verify.packed.problem import PackedProblem, TooLargeError
from verify.packed.state_table import StateTable
from verify.programs.effort import Minimum
from verify.programs.mending import best_suffix, replay


class OtherMethodError(UndecidedError):
    """A question that this method does not answer."""


def answers(question: Subproblem) -> bool:
    """Whether the method knows the question's rules."""
    return question.replans or question.rule in (FREE, EXACT)


def cheapest_by_epochs(question: Subproblem, plans: OptimalPlans, *, bounded: bool) -> Minimum:
    """The plan of least objective.

    Args:
        question: with a horizon of at least 1.
        plans: the human's optimal plans.
        bounded: whether lower bounds spare the search states; else only what was paid does.

    Raises:
        OtherMethodError: the question is not one for this method.
        LimitReachedError: the deadline came before the search began.
    """
    if not answers(question):
        raise OtherMethodError("the exhaustive method replans suffixes, and preserves kernels")
    with during("preparing an exhaustive search"):
        part = relevant_part(question)
        if part is None:
            return Minimum("none")
        if len(part.actions) > limits().compared_actions:
            raise OtherMethodError(f"the exhaustive method takes {limits().compared_actions} actions at most")
        try:
            search = _Search(question, part, plans, bounded=bounded)
        except TooLargeError:
            raise OtherMethodError("the task is too large for the exhaustive method") from None
    return replace(search.run(), states=search.states)


class _Search:
    """One question.

    Attributes:
        states: how many were looked at.
    """

    def __init__(self, question: Subproblem, part: Relevant, plans: OptimalPlans, *, bounded: bool) -> None:
        actions, facts = part.actions, part.facts
        task, deadline = question.task, question.deadline
        self._question, self._plans, self._deadline = question, plans, deadline
        self.states = 0
        self._actions = actions
        self._numbers = {i: k for k, i in enumerate(actions)}
        strict = question.options.strict
        team = team_problem(question, part, bounded=bounded)
        singles, space, self._team_problem = team.singles, team.space, team.problem
        self._goal = self._team_problem.goal
        self._layout = self._team_problem.layout
        # a unit of cost weighs more than all actions that there is time for
        self._unit = question.horizon + 1
        if (question.largest + question.an_epoch + 1) * self._unit > limits().weight:
            raise TooLargeError
        table = OperatorTable(self._layout, singles)
        self._team = TeamEpochs(task, actions, table, deadline, strict=strict)
        self._table = table
        his = [i for i in actions if task.actions[i].participants == (task.human,)]
        own = [as_operator((task.actions[i],), question.prices.team[i] * self._unit + 1) for i in his]
        alone = list(task.goal.positive), list(task.goal.negative)
        self._alone = PackedProblem(space, facts, own, alone, deadline, bounded=bounded)
        assert not self._layout.differs(self._alone.layout), "the same facts"
        self._epoch = question.prices.epoch if question.rule == WINDOW else 0
        self._free = question.rule == FREE or question.is_free
        self._layers: list[EpochLayer] = []
        self._known: int | None = None
        self._prefixes = {0}
        self._best: PricedPlan | None = None

    # -- the whole

    def run(self) -> Minimum:
        """Answer the question."""
        try:
            return self._run()
        except LIMITS as limit:
            doing = f"searching exhaustively, {self.states:,} states so far"
            reason = str(LimitReachedError(limit_reason(limit), doing))
            return Minimum("undecided", self._best, self._bound(), reason)
        except TooManyPackedStatesError as error:
            reason = str(error) or "there are too many states"
            return Minimum("undecided", self._best, self._bound(), reason)

    def _bound(self) -> int | None:
        """What is known of the objective before all was looked at."""
        return None if self._known is None else min(self._known, self._limit(self._question.horizon) + 1)

    def _run(self) -> Minimum:
        question = self._question
        start = self._team_problem.pack([question.task.init])
        assert start is not None, "the initial state is reached"
        least = int(self._team_problem.bounds(start)[0])
        if least >= FAR:
            return Minimum("none")
        self._known = least + self._epoch
        begin = first(start, len(self._team.order))
        if self._free:
            if self._without_epochs(start):
                return Minimum("none")
            self._windows(begin)
        elif question.rule == EXACT:
            self._exactly(begin)
        else:
            self._windows(begin)
        return Minimum("none") if self._best is None else Minimum("found", self._best, self._best.objective)

    def _without_epochs(self, start: Words) -> bool:
        """Whether there is no plan even if epochs did not count: one action after the other."""
        below = self._limit(0) + 1
        search, found = self._team_problem.search(start, np.zeros(1, np.int64), below)
        self.states += search.states
        if found is not None:
            self._known = search.paid(found)
        return found is None

    def _ages(self) -> int | None:
        """The greatest length where windows of different lengths have to be told apart; else None."""
        question = self._question
        longest = question.options.max_window
        counted = question.rule == WINDOW and longest is not None and longest < question.horizon
        if counted or (question.most_cost is not None and self._epoch):
            return min(longest or question.horizon, question.horizon)
        return None

    def _limit(self, length: int) -> int:
        """The greatest objective that is still asked for, with a window of some length, or less."""
        question = self._question
        given = [question.largest]
        if question.most_cost is not None and not any(question.prices.talk):
            given.append(question.most_cost + self._epoch * length)
        if self._best is not None:
            given.append(self._best.objective - 1)
        return min(given)

    # -- epochs

    def _hopeful(self, states: Words, paid: Ints, rest: int, limit: int) -> Ints:
        """The states that may lead to an objective within the limit."""
        self.states += len(states)
        total = paid + self._team_problem.bounds(states) + rest
        return np.flatnonzero(total <= limit)

    def _exactly(self, begin: EpochLayer) -> None:
        """The human executes ``pi_H``; robots reach all goals."""
        self._layers = [begin]
        for epoch in range(1, self._question.horizon + 1):
            self._layers.append(self._prefix(epoch - 1, epoch))
        self._close([(self._question.horizon, self._question.horizon)], 0)

    def _windows(self, begin: EpochLayer) -> None:
        """All windows; without rules the window is all there is.

        Where lengths of windows are told apart, there is a layer for each; else all are in one.
        """
        question, oldest = self._question, self._ages()
        self._layers = [begin]
        prefix = 0
        self._prefixes = {0}
        inside: dict[int, int] = {}
        ends: dict[int, list[tuple[int, int]]] = {}
        known, least = StateTable(self._layout.words, self._deadline), np.zeros(0, np.int64)
        for epoch in range(1, question.horizon + 1):
            opens = epoch == 1 if self._free else epoch <= len(question.human_plan)
            before, inside = inside, {}
            for age in range(1, (oldest or 1) + 1):
                sources = [before[age - (oldest is not None)]] if age - (oldest is not None) in before else []
                if opens and age == 1:
                    sources.append(prefix)
                layer = self._inside([n for n in sources if len(self._layers[n])], age if oldest else None)
                if oldest is None:
                    layer, least = self._improved(layer, known, least)
                if len(layer):
                    inside[age] = len(self._layers)
                    ends.setdefault(age, []).append((len(self._layers), epoch))
                    self._layers.append(layer)
            if not self._free:
                following = self._prefix(prefix, epoch)
                prefix = len(self._layers)
                self._prefixes.add(prefix)
                self._layers.append(following)
            if not inside and (self._free or not len(self._layers[prefix])):
                break
        for age, places in ends.items():
            self._close(places, age if oldest else question.horizon)

    def _inside(self, sources: list[int], age: int | None) -> EpochLayer:
        """The states after one more epoch of windows."""
        limit = self._limit(self._question.horizon if age is None else age)
        return self._advance(
            [(n, self._layers[n], self._team.steps(self._layers[n].states)) for n in sources],
            self._epoch,
            lambda states, paid: self._hopeful(states, paid, 0, limit),
        )

    def _prefix(self, number: int, epoch: int) -> EpochLayer:
        """The states after an epoch of the prefix."""
        question, layer = self._question, self._layers[number]
        limit, rest = self._limit(question.horizon), self._epoch
        own: frozenset[int] | set[int] = frozenset()
        wait = True
        if question.options.keep_prefix and question.rule == WINDOW:
            own = in_plan(question.task, question.human_plan).intersection(question.task.human_actions)
        elif epoch <= len(question.human_plan):
            own, wait = {question.human_plan[epoch - 1]}, False
        allowed = np.array(sorted(self._numbers[i] for i in own if i in self._numbers), np.int64)
        return self._advance(
            [(number, layer, self._team.steps(layer.states, allowed, wait=wait))],
            0,
            lambda states, paid: self._hopeful(states, paid, rest, limit),
        )

    def _advance(
        self,
        steps: list[tuple[int, EpochLayer, Iterator[Steps]]],
        extra: int,
        hopeful: Callable[[Words, Ints], Ints],
    ) -> EpochLayer:
        agents = len(self._team.order)
        return advance(steps, extra, hopeful, self._layout.words, agents, self._deadline)

    def _improved(self, layer: EpochLayer, known: StateTable, least: Ints) -> tuple[EpochLayer, Ints]:
        """The states of a layer that no earlier epoch had at no higher cost; and the least costs so far."""
        numbers, new = known.numbers(layer.states)
        least = np.concatenate((least, np.full(len(new), FAR)))
        better = np.flatnonzero(layer.paid < least[numbers])
        least[numbers[better]] = layer.paid[better]
        return layer.only(better), least

    # -- ends

    def _close(self, places: list[tuple[int, int]], length: int) -> None:
        """The best plan whose window, of this length at most, ends with one of some layers."""
        for number, epoch in places:
            layer = self._layers[number]
            reached = np.flatnonzero(self._goal(layer.states))
            if len(reached):
                row = int(reached[np.argmin(layer.paid[reached])])
                self._offer(number, row, epoch, ())
        if self._free or self._question.rule != WINDOW:
            return
        layers = [(self._layers[number], number, epoch) for number, epoch in places]
        states = np.concatenate([layer.states for layer, _, _ in layers])
        paid = np.concatenate([layer.paid for layer, _, _ in layers])
        where = np.concatenate(
            [
                np.stack([np.full(len(la), n), np.arange(len(la)), np.full(len(la), e)], 1)
                for la, n, e in layers
            ]
        )
        self._complete(states, paid, where, length)

    def _complete(self, states: Words, paid: Ints, where: Ints, length: int) -> None:
        """The cheapest of all ends with what the human pays from there on, alone."""
        still = where[:, 2] < self._question.horizon
        for _ in range(limits().misfits):
            limit = self._limit(length)
            rows = np.flatnonzero(still)
            if not len(rows):
                return
            below = (limit + 1) * self._unit
            search, found = self._alone.search(states[rows], paid[rows] * self._unit, below)
            self.states += search.states
            if found is None:
                return
            begin, _ = search.path(found)
            same = rows[(states[rows] == search.row(begin)).all(axis=1)]
            row = int(same[np.argmin(paid[same])])
            still[row] = False
            number, place, epoch = where[row].tolist()
            state = self._whole_state(number, place)
            suffix = best_suffix(self._question, state, epoch + 1, self._plans)
            if suffix is not None:
                self._offer(number, place, epoch, suffix)
        raise UndecidedError("too many ends of windows from which the human's plan takes too long")

    def _whole_state(self, number: int, row: int) -> State:
        """All facts that are true in a state of a layer."""
        steps = self._steps(number, row)
        epochs: dict[int, list[int]] = {}
        for step in steps:
            epochs.setdefault(step.epoch, []).append(step.action)
        count = max(epochs, default=0)
        strict = self._question.options.strict
        states = states_along(
            self._question.task, (epochs.get(t, ()) for t in range(1, count + 1)), strict=strict
        )
        if states is None:
            raise UndecidedError("a plan of the exhaustive search does not replay")
        return states[-1]

    def _steps(self, number: int, row: int) -> tuple[Step, ...]:
        """What leads to a state of a layer."""
        sets: list[list[int]] = []
        while number > 0:
            layer = self._layers[number]
            sets.append([self._actions[k] for k in layer.sets[row].tolist() if k != NOBODY])
            number, row = int(layer.source[row]), int(layer.before[row])
        epochs = enumerate(reversed(sets), start=1)
        return tuple(Step(epoch, i) for epoch, chosen in epochs for i in sorted(chosen))

    def _offer(self, number: int, row: int, epoch: int, suffix: tuple[int, ...]) -> None:
        """A plan, which may be better than the best so far; it is executed once more with sets of facts."""
        question = self._question
        steps = self._steps(number, row) + tuple(Step(epoch + 1 + k, i) for k, i in enumerate(suffix))
        if replay(question, steps) is None:
            raise UndecidedError("a plan of the exhaustive search does not replay")
        window = self._window(number, row, epoch) if question.rule == WINDOW else None
        objective, cost = question.measure(steps, window)
        limits = (question.most is None or objective <= question.most) and (
            question.most_cost is None or cost <= question.most_cost
        )
        if not limits:
            if question.most_cost is not None and any(question.prices.talk):
                raise UndecidedError("a limit on cost, and communication that costs")
            return
        if self._best is None or objective < self._best.objective:
            self._best = PricedPlan(steps, window, objective, cost)

    def _window(self, number: int, row: int, epoch: int) -> Window:
        """The window of a plan: its prefix ends with the last layer of prefixes that it goes through."""
        if self._free:
            return Window(1, self._question.horizon + 1)
        length = 0
        while number not in self._prefixes:
            layer = self._layers[number]
            number, row, length = int(layer.source[row]), int(layer.before[row]), length + 1
        return Window(epoch + 1 - length, epoch + 1)
