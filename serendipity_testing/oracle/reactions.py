"""Brute force under a human model (semantics 6, 10.6): every sequence of robots' actions is played.

Equal (moment, belief, plan) after an epoch are merged, keeping the least (cost, actions).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction

from serendipity.model import HumanPlan, Options, Task, surroundings
from serendipity_testing.oracle.alone import Alone, human_plans
from serendipity_testing.oracle.epochs import State, holds, usable
from serendipity_testing.oracle.moments import Moment

Visible = Callable[[int, int, State], bool]

Slots = tuple[int | None, ...]
"""What the human means to do whenever they are free: an action, or (None) an epoch of waiting."""


@dataclass(frozen=True, slots=True)
class BeliefState:
    """How things are, what the human believes, what remains of their plan, epochs waited and not paid for."""

    moment: Moment
    belief: Moment
    plan: Slots
    waited: int = 0


@dataclass(frozen=True, slots=True)
class LeastCost:
    """Least (cost, number of actions) over all sequences; None if none reaches the goals."""

    cost: Fraction | None
    actions: int | None


def best_reaction(
    task: Task, options: Options, human_plan: HumanPlan | None = None, visible: Visible | None = None
) -> LeastCost:
    """The optimum over robots' action sequences of at most ``T`` epochs.

    Args:
        task: the task.
        options: discount, horizon, interference, head start, cost of waiting, ``human_model``, ``no_block``.
        human_plan: ``pi_H``, after its head start; None for the canonical one, which must exist.
        visible: what a local human sees.
    """
    if human_plan is None:
        asked = options.waiting_cost, options.head_start
        human_plan = next(human_plans(task, *asked, strict=options.strict), None)
    assert human_plan is not None, "brute force needs a plan of the human"
    horizon = task.epochs_of(human_plan) if options.horizon is None else int(options.horizon)
    world = _World(task, options, visible)
    reached: list[tuple[Fraction, int]] = []
    slots = _slots(task, task.starts_of(human_plan), human_plan, task.epochs_of(human_plan))
    start = Moment(task.init)
    layer = {BeliefState(start, start, slots): (Fraction(0), 0)}
    for epoch in range(horizon + 1):
        following: dict[BeliefState, tuple[Fraction, int]] = {}
        for now, (cost, actions) in layer.items():
            if epoch >= options.head_start and world.over(now.moment):
                reached.append((cost, actions))
            elif epoch < horizon:
                for chosen, onward in world.unfold(now, epoch):
                    paid = world.price(chosen) + world.waiting(now, onward)
                    label = (cost + paid, actions + len(chosen))
                    following[onward] = min(label, following.get(onward, label))
        layer = following
    return LeastCost(*min(reached)) if reached else LeastCost(None, None)


def _slots(task: Task, starts: tuple[int, ...], plan: HumanPlan, end: int, over: int = 0) -> Slots:
    """A plan as slots, from an epoch on."""
    slots: list[int | None] = []
    for start, action in zip(starts, plan, strict=True):
        slots += [None] * (start - over - 1)
        slots.append(action)
        over = start + task.actions[action].duration - 1
    return (*slots, *[None] * (end - over))


class _World:
    def __init__(self, task: Task, options: Options, visible: Visible | None) -> None:
        self.task = task
        self.options = options
        self.visible = visible
        self.places = surroundings(task)
        self.alone = Alone(task, options.waiting_cost, strict=options.strict)
        self.world = self.alone.world
        self.robots = [i for i, a in enumerate(task.actions) if task.human not in a.participants]
        self.joint = [i for i, a in enumerate(task.actions) if a.joint and task.human in a.participants]

    def over(self, moment: Moment) -> bool:
        reached = holds(self.task.goal, moment.state) and holds(self.task.robot_goal, moment.state)
        return reached and self.world.plan_is_over(moment)

    def price(self, chosen: tuple[int, ...]) -> Fraction:
        actions = (self.task.actions[i] for i in chosen)
        return sum((self.task.team_cost(a, self.options.discount) for a in actions), Fraction(0))

    def waiting(self, before: BeliefState, now: BeliefState) -> Fraction:
        """What they pay for waiting, who begin something after it (semantics 10.2)."""
        return self.options.waiting_cost * max(before.waited - now.waited, 0)

    def unfold(self, now: BeliefState, epoch: int) -> Iterator[tuple[tuple[int, ...], BeliefState]]:
        """Everything that robots can make of the epoch after some: what begins, and then."""
        for his, rest, believed in self._his_part(now, epoch):
            idle = not his and not self.world.at_work(now.moment, epoch + 1) and self.options.waiting_cost
            waited = 0 if his else now.waited + bool(idle)
            for chosen, onward in self.world.sets(now.moment, epoch + 1, [*his, *self.robots]):
                if chosen[: len(his)] == his and not self._forbidden(now.moment, epoch, his, onward):
                    yield chosen, BeliefState(onward, believed(onward), rest, waited)

    def _his_part(
        self, now: BeliefState, epoch: int
    ) -> Iterator[tuple[tuple[int, ...], Slots, Callable[[Moment], Moment]]]:
        """The human's part: a joint action that they would accept, or what they mean to do."""
        if self.world.busy(now.moment, self.task.human):
            yield (), now.plan, self._believing(now.belief, epoch, ())
            return
        if epoch < self.options.head_start:  # they are not up yet
            yield (), now.plan[1:], self._believing(now.belief, epoch, ())
            return
        there = self._look(now)
        kept, best, plan = self._cost_of(now.plan, there, epoch), self._alone(there, epoch), now.plan
        if best is not None and (kept is None or best < kept):
            plan = self._plan(there, epoch)
        for j in self.joint:
            after_it = self.world.after(there, epoch + 1, (j,))
            if after_it is not None and usable(self.task.actions[j], now.moment.state):
                rest = self._alone(after_it, epoch + 1)
                if best is None or (rest is not None and self.task.actions[j].cost + rest <= best):
                    yield (j,), plan, self._believing(there, epoch, (j,))
        if best is None or not plan:
            yield (), plan, self._believing(there, epoch, ())
        elif plan[0] is None:
            yield (), plan[1:], self._believing(there, epoch, ())
        elif usable(action := self.task.actions[plan[0]], now.moment.state):
            yield (plan[0],), plan[1:], self._believing(there, epoch, (plan[0],))
        else:
            truth = {*action.pre, *action.neg}
            learnt = frozenset((there.state - truth) | (now.moment.state & truth))
            yield (), plan, self._believing(there._replace(state=learnt), epoch, ())

    def _believing(self, belief: Moment, epoch: int, begun: tuple[int, ...]) -> Callable[[Moment], Moment]:
        """What they believe after one more epoch, by how things are: those who see everything, the truth."""
        if self.options.human_model == "observant":
            return lambda truth: truth
        onward = self.world.supposed(belief, epoch + 1, begun)
        return lambda _: onward

    def _forbidden(self, before: Moment, epoch: int, his: tuple[int, ...], onward: Moment) -> bool:
        if self.options.no_block is False or self._alone(before, epoch) is None:
            return False
        if self._alone(onward, epoch + 1) is not None:
            return False
        without_robots = self.world.after(before, epoch + 1, his)
        return without_robots is not None and self._alone(without_robots, epoch + 1) is not None

    def _look(self, now: BeliefState) -> Moment:
        state = now.moment.state
        if self.options.human_model == "observant":
            return now.moment
        assert self.visible is not None, "brute force is told what is visible"
        human = self.task.human
        seen = {f for f in range(len(self.task.facts)) if self.visible(human, f, state)}
        facts = frozenset((now.belief.state - seen) | (state & seen))
        near = self.places.near(human, state) if self.places.located else self.task.agents
        shown = {human, *self.task.script.people, *(i for i, a in enumerate(self.task.agents) if a in near)}
        return Moment(facts, self.world.seen(now.belief.going, now.moment.going, shown))

    def _alone(self, moment: Moment, epoch: int) -> Fraction | None:
        """What they still pay alone, once they are free."""
        now: Moment | None = moment
        while now is not None and self.world.busy(now, self.task.human):
            epoch += 1
            now = self.world.alone(now, epoch)
        worth = None if now is None else self.alone.worth(now, epoch)
        return None if worth is None else worth[0]

    def _plan(self, moment: Moment, epoch: int) -> Slots:
        """Their canonical plan from a moment in which they have one."""
        actions, starts, end = next(self.alone.plans(moment, epoch))
        return _slots(self.task, starts, actions, end, epoch)

    def _cost_of(self, plan: Slots, moment: Moment, epoch: int) -> Fraction | None:
        cost = waited = Fraction(0)
        now: Moment | None = moment
        for slot in plan:
            if now is None:
                return None
            if slot is None:
                waited += 0 if self.world.at_work(now, epoch + 1) else self.options.waiting_cost
                epoch, now = epoch + 1, self.world.alone(now, epoch + 1)
                continue
            done = self.alone.acted(now, epoch, slot)
            epoch, now = epoch + self.task.actions[slot].duration, None if done is None else done.moment
            cost, waited = cost + waited + self.task.actions[slot].cost, Fraction(0)
        return cost if now is not None and self.world.reached(now) else None
