"""The optimum of a call, in every mode (semantics 3)."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from math import lcm

from serendipity.model import HumanPlan, Options, Task, UsageError, Window
from serendipity.model.keywords import Horizon
from serendipity.testing.oracle.alone import Alone
from serendipity.testing.oracle.epochs import State, action_sets, after, holds
from serendipity.testing.oracle.labels import NOTHING, Label, Layer, Moves, advance, front, plus
from serendipity.testing.oracle.suffixes import suffix_rule


@dataclass(frozen=True, slots=True)
class Optimum:
    """The answer of an exact planner; costs as in ``Result``, but exact.

    ``actions`` counts the plan's actions; None where the answer is a mean over ties.
    """

    status: str
    cost: Fraction | None = None
    objective: Fraction | None = None
    window: Window | None = None
    actions: int | None = None
    opportunity: bool = False
    human_cost: Fraction | None = None
    saving: Fraction | None = None
    saving_alone: Fraction | None = None
    reason: str | None = None


@dataclass(frozen=True, slots=True)
class WindowPlan:
    """The best plan of one window, or of a mode without windows."""

    label: Label
    objective: int
    window: Window | None

    def order(self) -> tuple[int, int, int, int, int]:
        """Ties of semantics 3.1: objective, cost, shorter window, later xi1, fewer actions."""
        length, start = (0, 0) if self.window is None else (len(self.window), self.window.start)
        return (self.objective, self.label[1], length, -start, self.label[2])


class Solver:
    """One call with one ``pi_H`` (None: the human has no plan alone)."""

    def __init__(self, task: Task, options: Options, human_plan: HumanPlan | None, *, given: bool) -> None:
        self.task = task
        self.options = options
        self.human_plan = human_plan
        self.given = given
        self.alone = Alone(task)
        self.length = self._length()
        self.robots_goal = bool(task.robot_goal) and options.mode != "individual"
        self.horizon = self._horizon()
        self.unit = smallest_unit(task, options)
        self._memo: dict[tuple[object, State], list[tuple[State, Label]]] = {}

    def solve(self) -> Optimum:
        """The optimum."""
        if self.options.mode == "individual":
            return self._individual()
        if self.human_plan is None and self.options.mode == "serendipity":
            return Optimum("infeasible", reason="no-human-plan")
        baseline = self._baseline()
        found = min(self._candidates(baseline), key=WindowPlan.order, default=None)
        helps = found is not None and self._helps(found, baseline)
        return self._answer(found, baseline, helps=helps)

    # -- what is compared

    def _candidates(self, baseline: Label | None) -> Iterator[WindowPlan]:
        yield from self._limited(baseline)
        if baseline is not None and not (self.robots_goal and self.options.windowed):
            yield self._do_nothing(baseline)

    def _limited(self, baseline: Label | None) -> Iterator[WindowPlan]:
        """All plans within ``max_cost``."""
        limit = self._max_cost(baseline)
        for candidate in self._windows() if self.options.windowed else self._whole():
            if limit is None or candidate.label[1] <= limit:
                yield candidate

    def _do_nothing(self, baseline: Label) -> WindowPlan:
        """The baseline: no limit rejects it, and with idle robots it fits the window of its last action."""
        assert self.human_plan is not None
        if not self.options.windowed or not self.length:
            return WindowPlan(baseline, baseline[1], None)
        window = Window(self.length, self.length + 1)
        return WindowPlan(baseline, baseline[1] + self._units(self.options.window_weight), window)

    def _baseline(self) -> Label | None:
        """The cost of doing nothing: ``pi_H`` alone, or with robots that reach ``G_R`` (semantics 3.1)."""
        plan = self.human_plan
        if plan is None:
            return None
        if not self.robots_goal:
            cost = self._units(self._cost_of(plan))
            return (cost, cost, len(plan))
        layer: Layer[State] = {self.task.init: (NOTHING,)}
        assert self.horizon is not None
        epochs = self.horizon
        for t in range(1, len(plan) + 1):
            layer = advance(layer, self._moves("follow", t))
        idle_human = self._moves("follow", len(plan) + 1)
        layer = _advanced(layer, idle_human, None if epochs == "inf" else int(epochs) - len(plan))
        return min(self._goal_labels(layer), key=lambda label: label[1:], default=None)

    def _helps(self, found: WindowPlan, baseline: Label | None) -> bool:
        """Whether it is an opportunity (semantics 1, 3.1): cheaper than without robots."""
        if self.human_plan is None:
            return False
        idle = self._idle(baseline)
        if idle is not None and found.label[1] >= idle:
            return False
        if not self.robots_goal or not self._improvable:
            return True
        unaided = min(self._without_robots()._limited(baseline), key=WindowPlan.order, default=None)
        return unaided is None or (found.objective, found.label[1]) < (unaided.objective, unaided.label[1])

    def _idle(self, baseline: Label | None) -> int | None:
        """Cost of the answer with all robots idle: less than the baseline if a given plan can be improved."""
        if baseline is None or self.robots_goal or not self._improvable:
            return None if baseline is None else baseline[1]
        found = min(self._without_robots()._candidates(baseline), key=WindowPlan.order)
        return found.label[1]

    @property
    def _improvable(self) -> bool:
        """Whether a plan is given that costs more than an optimal one."""
        worth = self._optimum()
        return self.given and worth is not None and worth[0] < self._cost_of(self.human_plan or ())

    def _without_robots(self) -> "Solver":
        """The same call, were there no robots."""
        alone = type(self)(_without_robots(self.task), self.options, self._renumbered(), given=False)
        alone.unit = self.unit
        return alone

    def _renumbered(self) -> HumanPlan:
        """The human's plan where their own actions are all there is."""
        return tuple(self.task.human_actions.index(i) for i in self.human_plan or ())

    def _length(self) -> int:
        """The number of epochs of the human's plan."""
        return len(self.human_plan or ())

    def _cost_of(self, plan: HumanPlan) -> Fraction:
        """The cost of the human's plan."""
        return self.task.cost_of(plan)

    def _optimum(self) -> tuple[Fraction, int] | None:
        """Cost and number of actions of an optimal plan of the human alone."""
        return self.alone.worth(self.task.init)

    def _max_cost(self, baseline: Label | None) -> int | None:
        limit = self.options.max_cost
        if limit == "human":
            return None if baseline is None else baseline[1]
        assert not isinstance(limit, str)
        return None if limit is None else self._units(limit)

    # -- answers

    def _individual(self) -> Optimum:
        worth = self._optimum()
        if worth is None:
            return Optimum("infeasible", reason="no-human-plan")
        cost, length = worth
        human_cost = self._cost_of(self.human_plan or ())
        return Optimum(
            "optimal",
            cost,
            cost,
            None,
            length,
            human_cost=human_cost,
            saving=Fraction(0),
            saving_alone=human_cost - cost,
        )

    def _answer(self, found: WindowPlan | None, baseline: Label | None, *, helps: bool) -> Optimum:
        human_cost = None if self.human_plan is None else self._cost_of(self.human_plan)
        known = Optimum("optimal", human_cost=human_cost)
        if baseline is not None:
            idle = self._idle(baseline)
            assert idle is not None
            known = replace(known, saving=Fraction(0), saving_alone=self._cost(baseline[1] - idle))
        if found is not None and (helps or not self.options.windowed):
            _, spent, actions = found.label
            saving = None if baseline is None else self._cost(baseline[1] - spent if helps else 0)
            return replace(
                known,
                cost=self._cost(spent),
                objective=self._cost(found.objective),
                window=found.window,
                actions=actions,
                opportunity=helps,
                saving=saving,
            )
        if baseline is None:
            return replace(known, status="infeasible")
        cost = self._cost(baseline[1])
        return replace(known, cost=cost, objective=cost, actions=baseline[2])

    # -- enumeration

    def _whole(self) -> Iterator[WindowPlan]:
        """All composite plans within T, or without an end (semantics 3.4)."""
        epochs = None if self.horizon == "inf" else int(self.horizon or 0)
        layer = _advanced({self.task.init: (NOTHING,)}, self._moves("free", 0), epochs)
        for label in self._goal_labels(layer):
            yield WindowPlan(label, label[0], None)

    def _windows(self) -> Iterator[WindowPlan]:
        """All windows and all plans that fit them (semantics 3.1)."""
        plan = self.human_plan or ()
        last = int(self.horizon or 0)
        suffix = suffix_rule(self.task, self.options, plan, self.alone, self._price)
        prefix: Layer[State] = {self.task.init: (NOTHING,)}
        for xi1 in range(1, len(plan) + 1):
            layer = prefix
            for xi2 in range(xi1 + 1, last + 2):
                if self.options.max_window is not None and xi2 - xi1 > self.options.max_window:
                    break
                layer = advance(layer, self._moves("free", 0))
                weight = self._units(self.options.window_weight) * (xi2 - xi1)
                for state, labels in layer.items():
                    for rest in suffix(state, xi1, last - xi2 + 1):
                        for label in labels:
                            total = plus(label, rest)
                            yield WindowPlan(total, total[0] + weight, Window(xi1, xi2))
            prefix = advance(prefix, self._moves("prefix", xi1))

    def _goal_labels(self, layer: Layer[State]) -> Iterator[Label]:
        for state, labels in layer.items():
            if holds(self.task.goal, state) and (not self.robots_goal or holds(self.task.robot_goal, state)):
                yield from labels

    def _moves(self, phase: str, epoch: int) -> Moves[State]:
        """All action sets that a phase allows, as (next state, label)."""
        plan = self.human_plan or ()
        fixed = plan[epoch - 1] if phase != "free" and epoch <= len(plan) else None
        key = (phase, fixed)

        def moves(state: State) -> list[tuple[State, Label]]:
            if (key, state) not in self._memo:
                self._memo[key, state] = list(self._expand(state, phase, fixed))
            return self._memo[key, state]

        return moves

    def _expand(self, state: State, phase: str, fixed: int | None) -> Iterator[tuple[State, Label]]:
        actions = self.task.actions
        everything: Iterable[int] = range(len(actions))
        steps: dict[State, list[Label]] = {}
        for chosen in action_sets(self.task, state, everything, strict=self.options.strict):
            his = tuple(i for i in chosen if self.task.human in actions[i].participants)
            if phase != "free" and not self._prefix_allows(phase, his, fixed):
                continue
            step = NOTHING
            for i in chosen:
                step = plus(step, self._price(i))
            steps.setdefault(after(state, [actions[i] for i in chosen]), []).append(step)
        for next_state, labels in steps.items():
            for label in front(labels):
                yield next_state, label

    def _prefix_allows(self, phase: str, his: tuple[int, ...], fixed: int | None) -> bool:
        if phase == "prefix" and self.options.keep_prefix:
            return all(self._planned(i) and not self.task.actions[i].joint for i in his)
        return his == (() if fixed is None else (fixed,))

    def _price(self, i: int) -> Label:
        """Objective, cost and count of one action: semantics 1 and Def. 3.2."""
        action = self.task.actions[i]
        if self.task.human not in action.participants:
            cost = self._units(action.cost * (1 - self.options.discount))
            return (cost, cost, 1)
        off_plan = self.options.mode == "communication" and not self._planned(i)
        talk = self.options.communication_weight * action.cost if off_plan else Fraction(0)
        return (self._units(action.cost + talk), self._units(action.cost), 1)

    def _planned(self, i: int) -> bool:
        """Whether an action is in ``pi_H``, by name."""
        actions = self.task.actions
        return any(actions[i].name == actions[j].name for j in self.human_plan or ())

    def _units(self, amount: Fraction) -> int:
        whole = amount * self.unit
        assert whole.denominator == 1
        return whole.numerator

    def _cost(self, units: int) -> Fraction:
        return Fraction(units, self.unit)

    def _horizon(self) -> Horizon | None:
        options, plan = self.options, self.human_plan
        if options.mode == "individual" or (plan is None and options.windowed):
            return None
        if options.horizon is None:
            idle = plan is not None and not self.length
            if self.robots_goal and idle and not holds(self.task.robot_goal, self.task.init):
                raise UsageError("horizon: must be given, the human has nothing to do")
            if plan is not None:
                return self.length
            if options.mode == "composite":
                return "inf"
            raise UsageError("horizon: must be given, the human has no plan alone")
        if plan is not None and options.horizon != "inf" and int(options.horizon) < self.length:
            raise UsageError("horizon: shorter than the human's plan")
        return options.horizon


def _advanced(layer: Layer[State], moves: Moves[State], epochs: int | None) -> Layer[State]:
    """The layer after some epochs; with None, when waiting longer changes nothing."""
    done = 0
    while epochs is None or done < epochs:
        following = advance(layer, moves)
        if following == layer:
            break
        layer = following
        done += 1
    return layer


def smallest_unit(task: Task, options: Options) -> int:
    """The number of units in a cost of 1, so that all that is added up is whole."""
    amounts = [options.window_weight]
    if isinstance(options.max_cost, Fraction):
        amounts.append(options.max_cost)
    for action in task.actions:
        amounts += [
            action.cost,
            action.cost * (1 - options.discount),
            action.cost * options.communication_weight,
        ]
    return lcm(*(amount.denominator for amount in amounts))


def _without_robots(task: Task) -> Task:
    return replace(task, actions=tuple(task.actions[i] for i in task.human_actions))
