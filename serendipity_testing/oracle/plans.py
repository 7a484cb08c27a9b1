"""Plans of a call by brute force: every epoch, every set of actions, every window (semantics 2, 3, 10)."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from math import lcm

from serendipity.model import HumanPlan, Options, PlanError, Task, UsageError, Window
from serendipity.model.keywords import Horizon
from serendipity.model.task.leftovers import leftovers
from serendipity_testing.oracle.alone import Alone
from serendipity_testing.oracle.disturbing import Disturbing
from serendipity_testing.oracle.epochs import holds
from serendipity_testing.oracle.labels import NOTHING, Label, Layer, Moves, advance, front, plus
from serendipity_testing.oracle.moments import Moment
from serendipity_testing.oracle.nobody_pays import LastMomentRule, counts_everybody
from serendipity_testing.oracle.noticing import Notices
from serendipity_testing.oracle.suffixes import Suffixes


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


class Plans:
    """All plans of a call with one ``pi_H`` (None: the human has no plan alone).

    Args:
        task: the task.
        options: in force.
        human_plan: ``pi_H``.
        unit: how many units a cost of 1 has; None: as few as do.

    Raises:
        PlanError: ``pi_H`` can't be done beside the script.
        UsageError: the horizon is missing or too short, or what ``pi_H`` reaches does not last so long.
    """

    def __init__(
        self, task: Task, options: Options, human_plan: HumanPlan | None, unit: int | None = None
    ) -> None:
        self.task = task
        self.options = options
        self.human_plan = human_plan
        notices = Notices(task, human_plan) if options.noticed and human_plan is not None else None
        self.alone = Alone(task, options.waiting_cost, strict=options.strict, notices=notices)
        self.world = self.alone.world
        self._busy = task.script.busy(task.human)
        self.length = 0 if human_plan is None else task.epochs_of(human_plan)
        self.robots_goal = bool(task.robot_goal) and options.mode != "individual"
        self.horizon = self._horizon()
        self.unit = smallest_unit(task, options) if unit is None else unit
        self._starts = dict(zip(task.starts_of(human_plan), human_plan, strict=True)) if human_plan else {}
        self._steps: dict[object, list[tuple[Moment, Label]]] = {}
        self._priced = cache(self.price)
        self._require_plan()
        self._rule: LastMomentRule | None = None
        self._disturbing = Disturbing(self.world, options)
        self._most: int | None = None
        self._set_rule()

    def _set_rule(self) -> None:
        """Semantics 12, where it is in force."""
        options, last = self.options, self.horizon
        nobody_pays = options.mode != "individual" and counts_everybody(self.task, options)
        plain = options.suffix == "replan" and options.preservation == "kernel" and not options.waiting_cost
        if nobody_pays and self.robots_goal and not plain:
            raise UsageError("nobody_pays: not with these options")
        if options.mode == "individual" or not isinstance(last, int):
            return
        if nobody_pays or leftovers(options) is not None:
            self._rule = LastMomentRule(self.world, options, self.human_plan, last)
        if nobody_pays and self.human_plan is not None:
            self._most = self.units(self.cost_of_plan())

    def windows(self) -> Iterator[WindowPlan]:
        """All windows and all plans that fit them (semantics 3.1)."""
        last = int(self.horizon or 0)
        suffixes = Suffixes(self.task, self.options, self.human_plan or (), self.alone, self, last)
        prefix: Layer[Moment] = {Moment(self.task.init): (NOTHING,)}
        for xi1 in range(1, self.length + 1):
            layer = prefix
            for xi2 in range(xi1 + 1, last + 2):
                if self.options.max_window is not None and xi2 - xi1 > self.options.max_window:
                    break
                layer = advance(layer, self._moves("free", xi2 - 1))
                yield from self._closed(layer, Window(xi1, xi2), suffixes)
            prefix = advance(prefix, self._moves("prefix", xi1))

    def whole(self) -> Iterator[WindowPlan]:
        """All composite plans within T, or without an end (semantics 3.4)."""
        start: Layer[Moment] = {Moment(self.task.init): (NOTHING,)}
        for label in self._labels_at_the_end(start, "free", 0, self.horizon or 0):
            yield WindowPlan(label, label[0], None)

    def beside_plan(self) -> Iterator[Label]:
        """Labels of plans in which the human does what ``pi_H`` says, and robots what they like."""
        assert self.horizon is not None
        layer: Layer[Moment] = {Moment(self.task.init): (NOTHING,)}
        for epoch in range(1, self.length + 1):
            layer = advance(layer, self._moves("follow", epoch))
        return self._labels_at_the_end(layer, "follow", self.length, self.horizon)

    def cost_of_plan(self) -> Fraction:
        """The cost of the human's plan, waiting before its last action included."""
        plan = self.human_plan
        if not plan:
            return Fraction(0)
        last = self.task.starts_of(plan)[-1] + self.task.actions[plan[-1]].duration - 1
        waits = last - sum(self.task.actions[i].duration for i in plan)
        return self.task.cost_of(plan) + self.options.waiting_cost * (waits - self._busy)

    def optimum_alone(self) -> tuple[Fraction, int] | None:
        """Cost and number of actions of an optimal plan of the human alone."""
        early = self.options.head_start
        now = self.world.idled(Moment(self.task.init), 0, early)
        worth = None if now is None else self.alone.worth(now, early)
        if now is None or worth is None:
            return None
        cost, _, actions = worth
        paid = self.options.waiting_cost * max(0, early - self._busy)
        if paid and self.alone.resting(now, early) is not None:
            return (Fraction(0), 0)
        return (cost + paid if actions else cost, actions)

    def price(self, i: int) -> Label:
        """Objective, cost and count of one action: semantics 1 and Def. 3.2."""
        action = self.task.actions[i]
        if self.task.human not in action.participants:
            cost = self.units(action.cost * (1 - self.options.discount))
            return (cost, cost, 1, 0, 0)
        off_plan = self.options.mode == "communication" and not self._planned(i)
        talk = self.options.communication_weight * action.cost if off_plan else Fraction(0)
        paid = self.units(action.cost)
        return (self.units(action.cost + talk), paid, 1, 0 if self._most is None else paid, 0)

    def waiting(self, epochs: int) -> Label:
        """Objective, cost and count of some epochs of waiting."""
        paid = self.units(self.options.waiting_cost * epochs)
        return (paid, paid, 0, 0 if self._most is None else paid, 0)

    def ended(self, moment: Moment, epoch: int, last: int) -> Label | None:
        """What the end costs if everybody is idle until epoch ``last``; None if not all goals hold then."""
        end = self.world.idled(moment, epoch, last)
        lasts = end is not None and self._done(end) and holds(self.task.robot_goal, end.state)
        return self._left(end) if end is not None and lasts else None

    def _left(self, end: Moment) -> Label:
        price = Fraction(0) if self._rule is None else self._rule.price(end)
        return (self.units(price), self.units(price), 0, 0, 0) if price else NOTHING

    def pays(self, label: Label) -> bool:
        """Whether the human pays no more than they may, and is disturbed no more."""
        most = self.options.max_disturbance
        calm = most is None or label[4] <= self._disturbing.scale * most
        return calm and (self._most is None or label[3] <= self._most)

    def units(self, amount: Fraction) -> int:
        """An amount in the smallest unit of cost."""
        whole = amount * self.unit
        assert whole.denominator == 1
        return whole.numerator

    def cost(self, units: int) -> Fraction:
        """An amount that is given in the smallest unit of cost."""
        return Fraction(units, self.unit)

    # -- the end of plans

    def _labels_at_the_end(
        self, layer: Layer[Moment], phase: str, epoch: int, horizon: Horizon
    ) -> Iterator[Label]:
        """Labels of plans that reach the goals at ``T``; without a horizon after any epoch."""
        last = max(epoch, self.world.settled) if horizon == "inf" else int(horizon)
        while epoch < last:
            if horizon == "inf":
                yield from self._goal_labels(layer, epoch)
            epoch += 1
            layer = advance(layer, self._moves(phase, epoch))
        if horizon == "inf":
            layer = _closure(layer, self._moves(phase, epoch + 1))
        yield from self._goal_labels(layer, epoch)

    def _goal_labels(self, layer: Layer[Moment], epoch: int) -> Iterator[Label]:
        deeds = () if epoch else self.task.script.begun(1)
        if any(deed.agent not in self.task.script.people for deed in deeds):
            return  # somebody is in the middle of something
        for moment, labels in layer.items():
            if self._done(moment):
                yield from (plus(label, self._left(moment)) for label in labels if self.pays(label))

    def _done(self, moment: Moment) -> bool:
        goal = self.task.robot_goal
        reached = self.world.reached(moment) and (not self.robots_goal or holds(goal, moment.state))
        over = reached and self.world.plan_is_over(moment)
        return over and (self._rule is None or self._rule.keeps(moment))

    def _closed(self, layer: Layer[Moment], window: Window, suffixes: Suffixes) -> Iterator[WindowPlan]:
        """The plans of a window that are at a moment when it closes: robots have ended what they began."""
        weight = self.units(self.options.window_weight) * len(window)
        for moment, labels in layer.items():
            if self.world.others_busy(moment):
                continue
            for rest in suffixes.of(moment, window.start, window.end - 1):
                for label in labels:
                    total = plus(label, rest)
                    if not self.pays(total):
                        continue
                    yield WindowPlan(total, total[0] + weight, window)

    # -- one epoch

    def _moves(self, phase: str, epoch: int) -> Moves[Moment]:
        """All action sets that a phase allows, as (next moment, label)."""
        fixed = self._starts.get(epoch) if phase != "free" else None
        key = (phase, fixed, min(epoch, self.world.settled + 1))

        def moves(moment: Moment) -> list[tuple[Moment, Label]]:
            if (key, moment) not in self._steps:
                self._steps[key, moment] = [*self._expand(moment, phase, fixed, epoch)]
            return self._steps[key, moment]

        return moves

    def _expand(
        self, moment: Moment, phase: str, fixed: int | None, epoch: int
    ) -> Iterator[tuple[Moment, Label]]:
        actions = self.task.actions
        steps: dict[Moment, list[Label]] = {}
        for chosen, onward in self.world.sets(moment, epoch, range(len(actions))):
            his = tuple(i for i in chosen if self.task.human in actions[i].participants)
            if (his and moment.retired) or (phase != "free" and not self._prefix_allows(phase, his, fixed)):
                continue
            step = NOTHING
            if self.options.max_disturbance is not None:
                step = (0, 0, 0, 0, self._disturbing.by(moment, chosen))
            for i in chosen:
                step = plus(step, self._priced(i))
            waits = not his and not self.world.at_work(moment, epoch)
            for then, paid in self._waited(onward, waits=waits):
                steps.setdefault(then, []).append(plus(step, paid))
        for then, labels in steps.items():
            for label in front(labels):
                yield then, label

    def _waited(self, moment: Moment, *, waits: bool) -> Iterator[tuple[Moment, Label]]:
        """A moment after an epoch in which the human waits or not; they may do nothing more from there on."""
        if not waits or moment.retired or not self.options.waiting_cost:
            yield moment, NOTHING
            return
        yield moment, self.waiting(1)
        yield moment._replace(retired=True), NOTHING

    def _prefix_allows(self, phase: str, his: tuple[int, ...], fixed: int | None) -> bool:
        if phase == "prefix" and self.options.keep_prefix:
            return all(self._planned(i) and not self.task.actions[i].joint for i in his)
        return his == (() if fixed is None else (fixed,))

    def _planned(self, i: int) -> bool:
        """Whether an action is in ``pi_H``, by name."""
        actions = self.task.actions
        return any(actions[i].name == actions[j].name for j in self.human_plan or ())

    # -- what is required

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

    def _require_plan(self) -> None:
        if self.human_plan is None:
            return
        now: Moment | None = Moment(self.task.init)
        for epoch in range(1, self.length + 1):
            now = None if now is None else self.world.alone(now, epoch, self._starts.get(epoch))
        at_it = now is None or self.world.busy(now, self.task.human)
        if now is None or at_it or not holds(self.task.goal, now.state):
            raise PlanError("human plan: it can't be done, or misses the goal")
        last = self.length if self.horizon in (None, "inf") else int(self.horizon or 0)
        end = self.world.idled(now, self.length, last)
        if end is None or not holds(self.task.goal, end.state):
            raise UsageError("horizon: what the human's plan reaches does not last so long")


def _closure(layer: Layer[Moment], moves: Moves[Moment]) -> Layer[Moment]:
    """All that can be reached in any number of epochs after the script, with what it takes."""
    known, fresh = {**layer}, layer
    while fresh:
        better: Layer[Moment] = {}
        for moment, labels in advance(fresh, moves).items():
            kept = front((*known.get(moment, ()), *labels))
            if kept != known.get(moment):
                better[moment] = tuple(label for label in kept if label not in known.get(moment, ()))
                known[moment] = kept
        fresh = better
    return known


def smallest_unit(task: Task, options: Options) -> int:
    """The number of units in a cost of 1, so that all that is added up is whole."""
    amounts = [options.window_weight, options.waiting_cost]
    rest = leftovers(options)
    amounts += [price for _, price in rest.priced] if rest is not None else []
    if isinstance(options.max_cost, Fraction):
        amounts.append(options.max_cost)
    for action in task.actions:
        amounts += [
            action.cost,
            action.cost * (1 - options.discount),
            action.cost * options.communication_weight,
        ]
    return lcm(*(amount.denominator for amount in amounts))
