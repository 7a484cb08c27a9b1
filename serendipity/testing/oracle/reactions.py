"""Brute force under a human model (semantics 6): every sequence of robots' actions is played.

Equal (state, belief, plan) after an epoch are merged, keeping the least (cost, actions).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from serendipity.model import HumanPlan, Options, Task
from serendipity.testing.oracle.alone import Alone, optimal_human_plan
from serendipity.testing.oracle.epochs import State, after, holds, usable
from serendipity.testing.oracle.moments import Moment

Visible = Callable[[int, int, State], bool]


@dataclass(frozen=True, slots=True)
class BeliefState:
    """True state, what the human believes, what remains of their plan."""

    state: State
    belief: State
    plan: HumanPlan


@dataclass(frozen=True, slots=True)
class Best:
    """Least (cost, number of actions) over all sequences; None if none reaches the goals."""

    cost: Fraction | None
    actions: int | None


def best_reaction(
    task: Task, options: Options, human_plan: HumanPlan | None = None, visible: Visible | None = None
) -> Best:
    """The optimum over robots' action sequences of at most ``T`` epochs.

    Args:
        task: the task.
        options: discount, horizon, interference, ``human_model`` and ``no_block``.
        human_plan: ``pi_H``; None for the canonical one, which must exist.
        visible: what a local human sees.
    """
    plan = optimal_human_plan(task) if human_plan is None else human_plan
    assert plan is not None, "brute force needs a plan of the human"
    horizon = len(plan) if options.horizon is None else int(options.horizon)
    world = _World(task, options, visible)
    reached: list[tuple[Fraction, int]] = []
    layer = {BeliefState(task.init, task.init, plan): (Fraction(0), 0)}
    for epoch in range(horizon + 1):
        following: dict[BeliefState, tuple[Fraction, int]] = {}
        for moment, (cost, actions) in layer.items():
            if world.over(moment.state):
                reached.append((cost, actions))
            elif epoch < horizon:
                for chosen, onward in world.unfold(moment):
                    label = (cost + world.price(chosen), actions + len(chosen))
                    following[onward] = min(label, following.get(onward, label))
        layer = following
    return Best(*min(reached)) if reached else Best(None, None)


class _World:
    def __init__(self, task: Task, options: Options, visible: Visible | None) -> None:
        self.task = task
        self.options = options
        self.visible = visible
        self.alone = Alone(task, strict=options.strict)
        self.world = self.alone.world
        self.robots = [i for i, a in enumerate(task.actions) if task.human not in a.participants]
        self.joint = [i for i, a in enumerate(task.actions) if a.joint and task.human in a.participants]

    def over(self, state: State) -> bool:
        return holds(self.task.goal, state) and holds(self.task.robot_goal, state)

    def price(self, chosen: tuple[int, ...]) -> Fraction:
        actions = (self.task.actions[i] for i in chosen)
        return sum((self.task.team_cost(a, self.options.discount) for a in actions), Fraction(0))

    def unfold(self, now: BeliefState) -> Iterator[tuple[tuple[int, ...], BeliefState]]:
        """Everything that robots can make of the next epoch: what is executed, and then."""
        belief = self._look(now)
        kept, best = self._cost_of(now.plan, belief), self._alone(belief)
        plan = now.plan
        if best is not None and (kept is None or best < kept):
            plan = self._plan(belief)
        for his, rest, believed in self._his_part(now.state, belief, plan, best):
            for chosen in self._sets(now.state, his):
                state = self._after(now.state, chosen)
                if self._forbidden(now.state, self._after(now.state, his), state):
                    continue
                yield chosen, BeliefState(state, believed, rest)

    def _his_part(
        self, state: State, belief: State, plan: HumanPlan, best: Fraction | None
    ) -> Iterator[tuple[tuple[int, ...], HumanPlan, State]]:
        """The human's part: a joint action that they would accept, or what they mean to do."""
        for j in self.joint:
            action = self.task.actions[j]
            if usable(action, state) and usable(action, belief):
                onward = self._after(belief, (j,))
                rest = self._alone(onward)
                if best is None or (rest is not None and action.cost + rest <= best):
                    yield (j,), plan, onward
        if best is None or not plan:
            yield (), plan, belief
            return
        action = self.task.actions[plan[0]]
        if usable(action, state):
            yield plan[:1], plan[1:], self._after(belief, plan[:1])
        else:
            truth = {*action.pre, *action.neg}
            yield (), plan, frozenset((belief - truth) | (state & truth))

    def _sets(self, state: State, his: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        """The human's action with each set of robots' actions that may share its epoch."""
        for chosen, _ in self.world.sets(Moment(state), 1, [*his, *self.robots]):
            if chosen[: len(his)] == his:
                yield chosen

    def _forbidden(self, before: State, without_robots: State, state: State) -> bool:
        if self.options.no_block is False or self._alone(before) is None or self._alone(state) is not None:
            return False
        return self._alone(without_robots) is not None

    def _look(self, now: BeliefState) -> State:
        if self.options.human_model == "observant":
            return now.state
        assert self.visible is not None, "brute force is told what is visible"
        human = self.task.human
        seen = {f for f in range(len(self.task.facts)) if self.visible(human, f, now.state)}
        return frozenset((now.belief - seen) | (now.state & seen))

    def _alone(self, state: State) -> Fraction | None:
        worth = self.alone.worth(Moment(state))
        return None if worth is None else worth[0]

    def _plan(self, state: State) -> HumanPlan:
        if holds(self.task.goal, state):
            return ()
        return optimal_human_plan(replace(self.task, init=state)) or ()

    def _cost_of(self, plan: HumanPlan, state: State) -> Fraction | None:
        cost = Fraction(0)
        for i in plan:
            action = self.task.actions[i]
            if not usable(action, state):
                return None
            state = self._after(state, (i,))
            cost += action.cost
        return cost if holds(self.task.goal, state) else None

    def _after(self, state: State, chosen: tuple[int, ...]) -> State:
        return after(state, [self.task.actions[i] for i in chosen])
