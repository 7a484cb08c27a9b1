"""The optimum of a call with time: durations, a script, plans with waiting (semantics 10)."""

from collections.abc import Iterator
from fractions import Fraction
from math import lcm

from serendipity.model import HumanPlan, Options, PlanError, Task, TimedPlan, UsageError, Window
from serendipity.model.keywords import Horizon
from serendipity.testing.oracle.alone_in_time import AloneInTime, human_plan
from serendipity.testing.oracle.answers import Solver, WindowPlan
from serendipity.testing.oracle.epochs import holds
from serendipity.testing.oracle.labels import NOTHING, Label, Layer, Moves, advance, front, plus
from serendipity.testing.oracle.moments import Moment, TimedWorld
from serendipity.testing.oracle.suffixes_in_time import SuffixesInTime


def shifted(task: Task, plan: HumanPlan, epochs: int) -> HumanPlan:
    """A plan with some epochs of waiting before it."""
    starts = tuple(start + epochs for start in task.starts_of(plan))
    return human_plan(task, tuple(plan), starts, task.epochs_of(plan) + epochs)


def waits_of(task: Task, plan: HumanPlan) -> int:
    """The epochs that the human waits in a plan before their last action."""
    if not plan:
        return 0
    last = task.starts_of(plan)[-1] + task.actions[plan[-1]].duration - 1
    return last - sum(task.actions[i].duration for i in plan)


class SolverInTime(Solver):
    """One call with one ``pi_H`` (None: the human has no plan alone).

    Raises:
        PlanError: ``pi_H`` can't be done beside the script.
        UsageError: what it reaches does not last until the horizon.
    """

    def __init__(self, task: Task, options: Options, human_plan: HumanPlan | None, *, given: bool) -> None:
        self.world = TimedWorld(task, strict=options.strict)
        self.in_time = AloneInTime(task, options.waiting_cost, strict=options.strict)
        self._starts = (
            {} if human_plan is None else dict(zip(task.starts_of(human_plan), human_plan, strict=True))
        )
        self._steps: dict[object, list[tuple[Moment, Label]]] = {}
        super().__init__(task, options, human_plan, given=given)
        self.unit = lcm(self.unit, options.waiting_cost.denominator)
        self._require_plan()

    # -- the human's plan

    def _length(self) -> int:
        return 0 if self.human_plan is None else self.task.epochs_of(self.human_plan)

    def _cost_of(self, plan: HumanPlan) -> Fraction:
        return self.task.cost_of(plan) + self.options.waiting_cost * waits_of(self.task, plan)

    def _renumbered(self) -> HumanPlan:
        plan = super()._renumbered()
        given = self.human_plan
        return TimedPlan(plan, given.starts, given.length) if isinstance(given, TimedPlan) else plan

    def _optimum(self) -> tuple[Fraction, int] | None:
        early = self.options.head_start
        now = self._idled(Moment(self.task.init), 0, early)
        worth = None if now is None else self.in_time.worth(now, early)
        if worth is None:
            return None
        cost, _, actions = worth
        return (cost + self.options.waiting_cost * early if actions else cost, actions)

    def _require_plan(self) -> None:
        if self.human_plan is None:
            return
        now: Moment | None = Moment(self.task.init)
        for epoch in range(1, self.length + 1):
            now = None if now is None else self.world.alone(now, epoch, self._starts.get(epoch))
        if now is None or not self.world.plan_is_over(now) or not holds(self.task.goal, now.state):
            raise PlanError("human plan: it can't be done, or misses the goal")
        last = self.length if self.horizon in (None, "inf") else int(self.horizon or 0)
        end = self._idled(now, self.length, last)
        if end is None or not holds(self.task.goal, end.state):
            raise UsageError("horizon: what the human's plan reaches does not last so long")

    def _idled(self, moment: Moment, epoch: int, last: int) -> Moment | None:
        """The moment after an epoch, everybody idle until then; None where a bystander is disturbed."""
        now: Moment | None = moment
        for following in range(epoch + 1, last + 1):
            now = None if now is None else self.world.alone(now, following)
        return now

    # -- enumeration

    def _baseline(self) -> Label | None:
        plan = self.human_plan
        if plan is None or not self.robots_goal:
            return super()._baseline()
        assert self.horizon is not None
        layer: Layer[Moment] = {Moment(self.task.init): (NOTHING,)}
        for epoch in range(1, self.length + 1):
            layer = advance(layer, self._moves_in("follow", epoch))
        labels = self._labels_at_the_end(layer, "follow", self.length, self.horizon)
        return min(labels, key=lambda label: label[1:], default=None)

    def _whole(self) -> Iterator[WindowPlan]:
        layer: Layer[Moment] = {Moment(self.task.init): (NOTHING,)}
        for label in self._labels_at_the_end(layer, "free", 0, self.horizon or 0):
            yield WindowPlan(label, label[0], None)

    def _labels_at_the_end(
        self, layer: Layer[Moment], phase: str, epoch: int, horizon: Horizon
    ) -> Iterator[Label]:
        """Labels of plans that reach the goals at ``T``; without a horizon after any epoch."""
        last = max(epoch, self.world.settled) if horizon == "inf" else int(horizon)
        while epoch < last:
            if horizon == "inf":
                yield from self._goal_labels_of(layer)
            epoch += 1
            layer = advance(layer, self._moves_in(phase, epoch))
        if horizon == "inf":
            layer = self._closure(layer, self._moves_in(phase, epoch + 1))
        yield from self._goal_labels_of(layer)

    def _closure(self, layer: Layer[Moment], moves: Moves[Moment]) -> Layer[Moment]:
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

    def _goal_labels_of(self, layer: Layer[Moment]) -> Iterator[Label]:
        for moment, labels in layer.items():
            if self._done(moment):
                yield from labels

    def _done(self, moment: Moment) -> bool:
        goal = self.task.robot_goal
        reached = holds(self.task.goal, moment.state) and (not self.robots_goal or holds(goal, moment.state))
        return reached and self.world.plan_is_over(moment)

    def _windows(self) -> Iterator[WindowPlan]:
        last = int(self.horizon or 0)
        suffixes = SuffixesInTime(self.task, self.options, self.human_plan or (), self.in_time, self, last)
        prefix: Layer[Moment] = {Moment(self.task.init): (NOTHING,)}
        for xi1 in range(1, self.length + 1):
            layer = prefix
            for xi2 in range(xi1 + 1, last + 2):
                if self.options.max_window is not None and xi2 - xi1 > self.options.max_window:
                    break
                layer = advance(layer, self._moves_in("free", xi2 - 1))
                yield from self._closed(layer, Window(xi1, xi2), suffixes)
            prefix = advance(prefix, self._moves_in("prefix", xi1))

    def _closed(self, layer: Layer[Moment], window: Window, suffixes: SuffixesInTime) -> Iterator[WindowPlan]:
        """The plans of a window that are at a moment when it closes: robots have ended what they began."""
        weight = self._units(self.options.window_weight) * len(window)
        for moment, labels in layer.items():
            if self.world.others_busy(moment):
                continue
            for rest in suffixes.of(moment, window.start, window.end - 1):
                for label in labels:
                    total = plus(label, rest)
                    yield WindowPlan(total, total[0] + weight, window)

    def _moves_in(self, phase: str, epoch: int) -> Moves[Moment]:
        fixed = self._starts.get(epoch) if phase != "free" else None
        key = (phase, fixed, min(epoch, self.world.settled + 1))

        def moves(moment: Moment) -> list[tuple[Moment, Label]]:
            if (key, moment) not in self._steps:
                self._steps[key, moment] = [*self._expand_in(moment, phase, fixed, epoch)]
            return self._steps[key, moment]

        return moves

    def _expand_in(
        self, moment: Moment, phase: str, fixed: int | None, epoch: int
    ) -> Iterator[tuple[Moment, Label]]:
        actions = self.task.actions
        steps: dict[Moment, list[Label]] = {}
        for chosen, onward in self.world.sets(moment, epoch, range(len(actions))):
            his = tuple(i for i in chosen if self.task.human in actions[i].participants)
            if (his and moment.retired) or (phase != "free" and not self._prefix_allows(phase, his, fixed)):
                continue
            step = NOTHING
            for i in chosen:
                step = plus(step, self._price(i))
            waits = not his and not self.world.busy(moment, self.task.human)
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

    def price(self, i: int) -> Label:
        """Objective, cost and count of one action."""
        return self._price(i)

    def waiting(self, epochs: int) -> Label:
        """Objective, cost and count of some epochs of waiting."""
        paid = self._units(self.options.waiting_cost * epochs)
        return (paid, paid, 0)

    def lasts(self, moment: Moment, epoch: int, last: int) -> bool:
        """Whether all goals hold after an epoch if everybody is idle until then."""
        end = self._idled(moment, epoch, last)
        return end is not None and self._ends_well(end)

    def _ends_well(self, moment: Moment) -> bool:
        return self._done(moment) and holds(self.task.robot_goal, moment.state)
