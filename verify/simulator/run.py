"""SPEC 6, step by step: what becomes of a plan with a human who replans."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from serendipity.model import Options, Step, Task, Visible, surroundings
from verify.alone import OptimalPlans
from verify.alone import State as Facts
from verify.epochs import applicable, conflicting
from verify.simulator.person import Person


@dataclass(frozen=True, slots=True)
class Deed:
    """An epoch as it turned out: what took place, and what the plan says and did not.

    Attributes:
        executed: action ids, ascending.
        skipped: action ids that were inapplicable, in conflict or refused, ascending.
    """

    executed: tuple[int, ...]
    skipped: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Played:
    """A plan as it turned out.

    Attributes:
        deeds: by epoch from 1, until the goals hold, ``T``, or nothing happens any more.
        goals_hold: whether the goals hold at the end.
        cost: of what took place, for the team.
        blocked: the first epoch in which robots took the human's last plan away, or None.
    """

    deeds: tuple[Deed, ...]
    goals_hold: bool
    cost: Fraction
    blocked: int | None

    def realised(self, promised: Fraction) -> bool:
        """Goals hold, nothing was skipped or refused, and it costs at most what was promised."""
        return self.goals_hold and self.cost <= promised and not any(deed.skipped for deed in self.deeds)

    @property
    def steps(self) -> list[Step]:
        """What took place, in order."""
        return [Step(t, i) for t, deed in enumerate(self.deeds, start=1) for i in deed.executed]


def play(
    task: Task,
    options: Options,
    human_plan: Sequence[int],
    steps: Sequence[Step],
    *,
    human_model: str,
    horizon: int | None,
    visible: Visible | None = None,
    person: Person | None = None,
) -> Played:
    """Play the robots' part of a plan against the human.

    Args:
        task: the task.
        options: discount and interference.
        human_plan: his plan at the beginning.
        steps: the composite plan; what he does alone in it is not looked at.
        human_model: ``observant`` or ``local``.
        horizon: ``T``, or None for any.
        visible: what a local human sees; None for the default.
        person: his costs, where they are known from an earlier question.

    Raises:
        TooManyStatesError: his own problem is too large for this checker.
    """
    orders: dict[int, list[int]] = {}
    for step in steps:
        if task.actions[step.action].participants != (task.human,):
            orders.setdefault(step.epoch, []).append(step.action)
    sees = (visible or surroundings(task).visible) if human_model == "local" else None
    return _Game(task, options, person or Person(task, OptimalPlans(task)), sees, orders).play(
        list(human_plan), horizon
    )


class _Game:
    def __init__(
        self,
        task: Task,
        options: Options,
        person: Person,
        sees: Visible | None,
        orders: Mapping[int, list[int]],
    ) -> None:
        self.task = task
        self.strict = options.strict
        self.discount = options.discount
        self.person = person
        self.sees = sees
        self.orders = orders
        self.state: Facts = task.init
        self.belief: Facts = task.init
        self.rho: list[int] = []
        self.blocked: int | None = None

    def play(self, human_plan: list[int], horizon: int | None) -> Played:
        self.rho = human_plan
        last = max(self.orders, default=0)
        deeds: list[Deed] = []
        while not self._done() and len(deeds) != horizon:
            before = self.state, self.belief
            deeds.append(self._epoch(len(deeds) + 1))
            if len(deeds) >= last and before == (self.state, self._looked()) and not deeds[-1].executed:
                break
        cost = sum((self._price(i) for deed in deeds for i in deed.executed), Fraction(0))
        return Played(tuple(deeds), self._done(), cost, self.blocked)

    def _epoch(self, epoch: int) -> Deed:
        had_plan = not self._stuck(self.state)
        self.belief = self._looked()
        best = self._make_up_mind()
        offers = [self._as_possible(i) for i in sorted(self.orders.get(epoch, ()))]
        joint = self._accepted(offers, best)
        his, learned = self._own_step(best) if joint is None else (joint, None)
        executed = [] if his is None else [his]
        skipped = [i for i in offers if self._with_him(i) and i != joint]
        for i in offers:
            if not self._with_him(i):
                (executed if self._fits(i, executed) else skipped).append(i)
        if learned is not None:
            self.belief = learned
        elif his is not None:
            self.belief = self._after(self.belief, [his])
        alone = self._after(self.state, [] if his is None else [his])
        self.state = self._after(self.state, executed)
        if self.blocked is None and had_plan and self._stuck(self.state) and not self._stuck(alone):
            self.blocked = epoch
        return Deed(tuple(sorted(executed)), tuple(sorted(skipped)))

    def _looked(self) -> Facts:
        """His belief after a look: all of the state, or what is visible of it."""
        if self.sees is None:
            return self.state
        doubtful = self.state ^ self.belief
        human = self.task.human
        return self.belief ^ frozenset(f for f in doubtful if self.sees(human, f, self.state))

    def _make_up_mind(self) -> Fraction | None:
        """Step 1: ``rho`` is kept or replaced; returns ``h``."""
        kept, best = self.person.cost_of(self.rho, self.belief), self.person.cost(self.belief)
        if best is not None and (kept is None or best < kept):
            self.rho = self.person.plan(self.belief)
        return best

    def _accepted(self, offers: Sequence[int], best: Fraction | None) -> int | None:
        """Step 2: the joint action that he takes part in."""
        return next((i for i in self._joint_offers(offers) if self._worth_it(i, best)), None)

    def _joint_offers(self, offers: Sequence[int]) -> Iterator[int]:
        for i in offers:
            action = self.task.actions[i]
            if self._with_him(i) and applicable(action, self.state) and applicable(action, self.belief):
                yield i

    def _worth_it(self, joint: int, best: Fraction | None) -> bool:
        if best is None:
            return True
        rest = self.person.cost(self._after(self.belief, [joint]))
        return rest is not None and self.task.actions[joint].cost + rest <= best

    def _own_step(self, best: Fraction | None) -> tuple[int | None, Facts | None]:
        """Step 3: what he does by himself; where it fails, what he believes then."""
        if best is None or not self.rho:
            return None, None
        action = self.task.actions[self.rho[0]]
        if applicable(action, self.state):
            return self.rho.pop(0), None
        tested = frozenset((*action.pre, *action.neg))
        return None, (self.belief - tested) | (self.state & tested)

    def _fits(self, i: int, executed: Sequence[int]) -> bool:
        """Whether robots can do it beside what is being done."""
        action = self.task.actions[i]
        others = (self.task.actions[j] for j in executed)
        return applicable(action, self.state) and not any(
            conflicting(action, other, strict=self.strict) for other in others
        )

    def _as_possible(self, i: int) -> int:
        """Several ground actions may be one action by name: one that is applicable."""
        action = self.task.actions[i]
        same = [j for j in self.task.named[action.name] if self._team(j) == action.participants]
        possible = [j for j in [i, *same] if applicable(self.task.actions[j], self.state)]
        return possible[0] if possible else i

    def _team(self, i: int) -> tuple[int, ...]:
        return self.task.actions[i].participants

    def _with_him(self, i: int) -> bool:
        return self.task.human in self._team(i)

    def _after(self, state: Facts, chosen: Sequence[int]) -> Facts:
        actions = [self.task.actions[i] for i in chosen]
        for action in actions:
            state = state.difference(action.delete)
        return state.union(*(action.add for action in actions))

    def _stuck(self, state: Facts) -> bool:
        return self.person.cost(state) is None

    def _price(self, i: int) -> Fraction:
        return self.task.team_cost(self.task.actions[i], self.discount)

    def _done(self) -> bool:
        return self.task.goal.holds(self.state) and self.task.robot_goal.holds(self.state)
