"""Exhaustive search of a question epoch by epoch: dynamic programming over states with what was paid.

A layer holds the states after an epoch that share a *stage*: what the human may do from there on, as their
control automaton has it (:mod:`verify.base.control`).  Each state is kept once, at its least cost; where cost
is limited beside the objective, stages also tell apart how much of the objective is no cost, so that the
cheapest way is the best for both.  Wherever the rest of a plan may be waiting for nothing, a state that an
earlier epoch had at no higher cost is left out: whoever can wait loses nothing by being early (semantics 1).
Suffixes that are replanned are no stages: from the ends of windows on the human is alone, so one search from
all of them, each with what was paid there, finds the cheapest completion.

States are left out whose cost and a lower bound on what follows pass the question's limit.  The bounds are
those of ``verify.packed``: everybody's actions one after the other, with actions that only work together
as one.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from serendipity.model import Step, Window
from serendipity.model.errors import LIMITS
from serendipity.model.options import MAX_EPOCH
from verify.base.control import ALL, INSIDE, OWN, PREFIX, SUFFIX, Control, HumanControl, Leg
from verify.base.due import filled
from verify.base.execution import State
from verify.base.optimal_plans import OptimalPlans
from verify.base.relevance import Relevant
from verify.base.subproblem import EXACT, FREE, WINDOW, PricedPlan, Subproblem
from verify.base.undecided import UndecidedError, why
from verify.exhaustive.layers import EpochLayer, advance, first
from verify.exhaustive.team import NOBODY, Bools, Steps, TeamEpochs
from verify.exhaustive.team_problem import as_operator, team_problem
from verify.limits import limits
from verify.packed.cheapest_path import SumTooLargeError, TooManyPackedStatesError
from verify.packed.layout import Ints, Words
from verify.packed.least_paid import LeastPaid
from verify.packed.operators import FAR, OperatorTable, PackedOperator
from verify.packed.problem import PackedProblem
from verify.programs.effort import Minimum
from verify.programs.mending import best_suffix, replay


class OtherMethodError(UndecidedError):
    """A question that this method does not answer."""


class PlanStage(NamedTuple):
    """A part of the plan that the states of a layer share.

    Attributes:
        control: the human's control state.
        extra: units of the objective that are no cost, where a limit on cost tells them apart; else 0.
    """

    control: Control
    extra: int = 0


class EpochSearch:
    """One question.

    Attributes:
        states: how many were looked at.
    """

    def __init__(
        self,
        question: Subproblem,
        part: Relevant,
        control: HumanControl,
        plans: OptimalPlans,
        *,
        bounded: bool,
        exact: bool,
    ) -> None:
        task, deadline, actions, prices = question.task, question.deadline, part.actions, question.prices
        self._question, self._plans, self._deadline = question, plans, deadline
        self._control, self._facts, self._actions = control, part.facts, actions
        self.states = 0
        self._whole = team_problem(question, part, bounded=bounded, exact=exact)
        self._problem, self._layout = self._whole.problem, self._whole.problem.layout
        self._table = OperatorTable(self._layout, self._whole.singles, exact=exact)
        self._team = TeamEpochs(task, actions, self._table, deadline, strict=question.options.strict)
        self._own = [i for i in actions if task.actions[i].participants == (task.human,)]
        self._unit = question.horizon + 1  # weighs more than all actions that there is time for
        own = [as_operator((task.actions[i],), prices.team[i] * self._unit + 1) for i in self._own]
        goal = task.goal.positive, task.goal.negative
        self._endless = question.horizon == MAX_EPOCH  # a plan ends then as soon as it has reached its goals
        self._beside_script = bool(task.of_bystanders)
        self._alone = self._alike(own, goal) if question.replans and not self._beside_script else None
        self._most = question.largest
        self._epoch = prices.epoch if question.rule == WINDOW else 0
        self._talk = prices.talk if any(prices.talk) else None
        self._told_apart = question.most_cost is not None and bool(self._epoch or self._talk)
        self._layers: list[EpochLayer] = []
        self._stages: list[PlanStage] = []
        self._earlier: dict[PlanStage, LeastPaid] = {}
        self._known: int | None = None
        self._best: PricedPlan | None = None

    # -- the whole

    def run(self) -> Minimum:
        """The plan of least objective."""
        return self._answered(self._run)

    def run_on(self) -> Minimum:
        """The cheapest plan if robots go on after the last epoch, for as long as they like."""
        return self._answered(self._run_on)

    def _answered(self, ask: Callable[[], Minimum]) -> Minimum:
        try:
            return ask()
        except SumTooLargeError:
            raise
        except LIMITS as limit:
            reason = why(limit, f"searching exhaustively, {self.states:,} states so far")
        except TooManyPackedStatesError as error:
            reason = str(error) or "there are too many states"
        bound = None if self._known is None else min(self._known, self._limit() + 1)
        return Minimum("undecided", self._best, bound, reason)

    def _run(self) -> Minimum:
        least_left = int(self._problem.bounds(self._whole.start)[0])
        if least_left >= FAR:
            return Minimum("none")
        self._known = least_left + self._epoch
        if self._question.rule == FREE and self._none_without_epochs():
            return Minimum("none")
        ends = self._all_epochs()
        for extra, places in ends.items():
            self._complete(places, extra)
        return Minimum("none") if self._best is None else Minimum("found", self._best, self._best.objective)

    def _run_on(self) -> Minimum:
        if self._question.task.due:
            raise OtherMethodError("what goes on by itself is not searched for without a horizon")
        self._most, task = self._table.far, self._question.task
        self._all_epochs()
        last = len(self._layers) - 1
        if last < self._question.horizon:
            return Minimum("none")
        layer, every = self._layers[last], zip(self._whole.sets, self._problem.table.operators, strict=True)
        left = [
            (i, one) for i, one in every if not any(task.human in task.actions[k].participants for k in i)
        ]
        problem = self._alike([one for _, one in left], self._whole.goal)
        search, found = problem.search(layer.states, layer.paid)
        if found is None:
            return Minimum("none")
        begin, path = search.path(found)
        row = int(np.flatnonzero((layer.states == search.row(begin)).all(axis=1))[0])
        after = enumerate((left[k][0] for k in path), start=last + 1)
        steps = self._steps(last, row) + tuple(Step(epoch, i) for epoch, chosen in after for i in chosen)
        cost = search.paid(found)
        return Minimum("found", PricedPlan(steps, None, cost, cost), cost)

    def _alike(
        self, operators: Sequence[PackedOperator], goal: tuple[Sequence[int], Sequence[int]]
    ) -> PackedProblem:
        """A problem over the same states: what some of the agents may do, one action after the other."""
        whole = self._problem
        bounded, exact = whole.bounded, whole.exact
        space, deadline = self._whole.space, self._deadline
        found = PackedProblem(space, self._facts, operators, goal, deadline, bounded=bounded, exact=exact)
        assert self._layout.place == found.layout.place, "the same facts"
        return found

    def _none_without_epochs(self) -> bool:
        """True if there is no plan even if epochs did not count: one action after the other."""
        below = (self._limit_with(0) if self._talk is None else self._limit()) + 1
        search, found = self._problem.search(self._whole.start, np.zeros(1, np.int64), below)
        self.states += search.states
        if found is not None:
            self._known = search.paid(found)
        return found is None

    def _limit(self) -> int:
        """The greatest objective that is still asked for."""
        return self._most if self._best is None else min(self._most, self._best.objective - 1)

    def _limit_with(self, extra: int) -> int:
        """The same for plans of whose objective so much is no cost."""
        most_cost = self._question.most_cost
        return self._limit() if most_cost is None else min(self._limit(), most_cost + extra)

    # -- epochs

    def _all_epochs(self) -> dict[int, list[tuple[int, int]]]:
        """All layers; the ends of windows after which the human replans, as layers and epochs, by extra."""
        self._layers.append(first(self._whole.start, len(self._team.order)))
        self._stages.append(PlanStage(self._control.start))
        if self._endless:
            self._end(0, 0)
        here = [0]
        completed: dict[int, list[tuple[int, int]]] = {}
        for epoch in range(1, self._question.horizon + 1):
            following: dict[PlanStage, list[tuple[int, EpochLayer, Iterator[Steps]]]] = {}
            for number in here:
                for stage, steps in self._onward(number, epoch):
                    following.setdefault(stage, []).append((number, self._layers[number], steps))
            here = []
            for stage, sources in following.items():
                layer = self._advanced(stage, sources)
                if len(layer):
                    here.append(len(self._layers))
                    self._layers.append(layer)
                    self._stages.append(stage)
                    self._end(here[-1], epoch)
                    if self._question.replans and stage.control[0] == INSIDE:
                        completed.setdefault(stage.extra, []).append((here[-1], epoch))
            if not here:
                break
        return completed

    def _onward(self, number: int, epoch: int) -> Iterator[tuple[PlanStage, Iterator[Steps]]]:
        """The stages that may follow a layer, each with the epochs that lead to it."""
        stage = self._stages[number]
        for leg in self._control.legs(stage.control, epoch):
            if leg.after[0] == SUFFIX and self._question.replans:
                continue
            for talk, of_human in self._said(self._numbers(leg)):
                extra = stage.extra + leg.weight + talk if self._told_apart else 0
                wait = leg.wait and not talk
                yield PlanStage(leg.after, extra), self._steps_of(number, leg, of_human, wait=wait)

    def _numbers(self, leg: Leg) -> Ints | None:
        """The actions that the human may take part in, as the table numbers them; None: any."""
        if leg.actions == ALL:
            return None
        allowed = self._own if leg.actions == OWN else leg.actions
        return np.array([k for k, i in enumerate(self._actions) if i in allowed], np.int64)

    def _said(self, of_human: Ints | None) -> Iterator[tuple[int, Ints | None]]:
        """The same by the cost of communication, where that is told apart."""
        if self._talk is None or not self._told_apart:
            yield 0, of_human
            return
        talk = np.array([self._talk[i] for i in self._actions], self._table.weight.dtype)
        numbers = self._team.of_human if of_human is None else of_human
        for amount in sorted({0, *talk[numbers].tolist()}):
            yield amount, numbers[talk[numbers] == amount]

    def _steps_of(self, number: int, leg: Leg, of_human: Ints | None, *, wait: bool) -> Iterator[Steps]:
        """The epochs from a layer that a leg allows."""
        states = self._layers[number].states
        rows = np.arange(len(states))
        needs = leg.needs & self._facts
        if needs:
            rows = np.flatnonzero(self._table.test(sorted(needs), ())(states))
        robots = leg.after[0] != SUFFIX
        for steps in self._team.steps(states[rows], of_human, wait=wait, robots=robots, free=leg.free):
            yield replace(steps, before=rows[steps.before], cost=steps.cost + leg.weight)

    def _advanced(
        self, stage: PlanStage, sources: list[tuple[int, EpochLayer, Iterator[Steps]]]
    ) -> EpochLayer:
        def hopeful(states: Words, paid: Ints) -> Ints:
            self.states += len(states)
            window = self._epoch if stage.control[0] == PREFIX else 0
            total = paid + self._problem.bounds(states)
            cost = total if self._talk is None else paid  # with talk the bound is none on cost alone
            return np.flatnonzero((total + window <= self._limit()) & (cost <= self._limit_with(stage.extra)))

        layer = advance(sources, hopeful, self._table, len(self._team.order), self._deadline)
        return self._improved(stage, layer) if self._may_rest(stage.control) else layer

    def _may_rest(self, control: Control) -> bool:
        """True if all that is left of a plan may be waiting, for nothing."""
        rule = self._question.rule
        return rule != EXACT if rule != WINDOW else control[0] != PREFIX

    def _improved(self, stage: PlanStage, layer: EpochLayer) -> EpochLayer:
        """The states of a layer that no earlier epoch had in this stage at no higher cost."""
        if stage not in self._earlier:
            dtype = self._table.weight.dtype
            self._earlier[stage] = LeastPaid(self._layout.words, self._deadline, dtype=dtype)
        _, better = self._earlier[stage].offer(layer.states, layer.paid)
        return layer.only(np.sort(better))

    # -- ends

    def _end(self, number: int, epoch: int) -> None:
        """The best plan of which all that is left after an epoch is waiting."""
        control, layer = self._stages[number].control, self._layers[number]
        if epoch < self._question.horizon and not self._may_rest(control):
            return
        there = self._problem.goal(layer.states)
        if epoch < self._question.horizon and not self._endless:
            there &= self._team.is_calm(layer.states)
        for needs in self._control.accepts(control):
            test = self._table.test(sorted(needs & self._facts), ())
            reached = np.flatnonzero(there & test(layer.states))
            if len(reached):
                self._offer(number, int(reached[np.argmin(layer.paid[reached])]), epoch, ())

    def _complete(self, places: list[tuple[int, int]], extra: int) -> None:
        """The cheapest of all ends with what the human pays from there on, alone."""
        if self._alone is None:
            self._complete_one_by_one(places)
            return
        layers = [self._layers[number] for number, _ in places]
        states = np.concatenate([layer.states for layer in layers])
        paid = np.concatenate([layer.paid for layer in layers])
        numbers, epochs = np.repeat(places, [*map(len, layers)], axis=0).T
        within = np.concatenate([np.arange(len(layer)) for layer in layers])
        still = (epochs < self._question.horizon) & self._robots_rest(states)
        for _ in range(limits().misfits):
            rows = np.flatnonzero(still)
            if not len(rows):
                return
            below = (self._limit_with(extra) + 1) * self._unit
            search, found = self._alone.search(states[rows], paid[rows] * self._unit, below)
            self.states += search.states
            if found is None:
                return
            begin, _ = search.path(found)
            same = rows[(states[rows] == search.row(begin)).all(axis=1)]
            row = int(same[np.argmin(paid[same])])
            still[row] = False
            number, place, epoch = int(numbers[row]), int(within[row]), int(epochs[row])
            state = self._whole_state(number, place)
            suffix = best_suffix(self._question, state, epoch + 1, self._plans)
            if suffix is not None:
                self._offer(number, place, epoch, suffix)
        raise UndecidedError("too many ends of windows from which the human's plan takes too long")

    def _robots_rest(self, states: Words) -> Bools:
        """By state whether no robot is at anything: before that no window ends (semantics 10.1)."""
        return self._table.test([f for f in self._question.task.at_rest if f in self._facts], ())(states)

    def _complete_one_by_one(self, places: list[tuple[int, int]]) -> None:
        """The same beside a script, where the human's way depends on the epoch: one end after the other."""
        alone = self._plans.alone
        for number, epoch in places:
            layer, hopeless = self._layers[number], set[int | State]()
            rests = self._robots_rest(layer.states) & (epoch < self._question.horizon)
            order = np.argsort(layer.paid, kind="stable")
            for row in order[rests[order]].tolist():
                self._deadline.check()
                left = self._limit() - int(layer.paid[row])
                if left < 0:
                    break
                state, most = self._whole_state(number, row), self._question.prices.cost(left)
                if alone.sight(state) in hopeless or not alone.within(state, alone.own.heaviest(most)):
                    hopeless.add(alone.sight(state))
                    continue
                suffix = best_suffix(self._question, state, epoch + 1, self._plans)
                if suffix is not None:
                    self._offer(number, row, epoch, suffix)

    def _whole_state(self, number: int, row: int) -> State:
        """The facts that are true in a state of a layer, as far as any matters."""
        constant = self._question.task.init - self._layout.place.keys()
        return self._layout.facts_of(self._layers[number].states[row]) | constant

    def _way(self, number: int, row: int) -> list[tuple[int, int]]:
        """The layers, by number, that lead to a state of one of them, each with the row there, in order."""
        found: list[tuple[int, int]] = []
        while number > 0:
            found.append((number, row))
            layer = self._layers[number]
            number, row = int(layer.source[row]), int(layer.before[row])
        return found[::-1]

    def _steps(self, number: int, row: int) -> tuple[Step, ...]:
        """The steps that lead to a state of a layer."""
        steps: list[Step] = []
        for epoch, (n, r) in enumerate(self._way(number, row), start=1):
            chosen = sorted(self._actions[k] for k in self._layers[n].sets[r].tolist() if k != NOBODY)
            steps += [Step(epoch, i) for i in chosen]
        return tuple(steps)

    def _offer(self, number: int, row: int, epoch: int, suffix: tuple[int, ...]) -> None:
        """A plan, which may be better than the best so far; it is executed once more with sets of facts."""
        question = self._question
        steps = self._steps(number, row) + tuple(Step(epoch + 1 + k, i) for k, i in enumerate(suffix))
        end = epoch + len(suffix) if self._endless else question.horizon
        if self._beside_script:
            steps = filled(question.task, steps, end, strict=question.options.strict)
        if replay(question.but(horizon=end), steps) is None:
            raise UndecidedError("a plan of the exhaustive search does not replay")
        window = self._window(number, row)
        objective, cost = question.measure(steps, window)
        if question.most_cost is not None and cost > question.most_cost:
            return
        if objective <= self._limit():
            self._best = PricedPlan(steps, window, objective, cost)

    def _window(self, number: int, row: int) -> Window | None:
        """The window of a plan that leads to a state of a layer."""
        way = enumerate(self._way(number, row), start=1)
        inside = [epoch for epoch, (n, _) in way if self._stages[n].control[0] == INSIDE]
        return Window(inside[0], inside[-1] + 1) if inside else None
