"""semantics 6, step by step: what becomes of a plan with a human who replans.

In time (10.6) what somebody is at goes on, and the human looks up when they are up and free.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from serendipity.model import Options, Step, Task, Visible
from serendipity.model.keywords import Horizon
from verify.base.due import onward
from verify.base.execution import State, after, applicable, fits, grouped, idling, met, price, unchosen
from verify.base.optimal_plans import OptimalPlans
from verify.certificate.simulator.sight import LocalSight


@dataclass(frozen=True, slots=True)
class PlayedEpoch:
    """An epoch as it turned out: what took place, and what the plan says and did not.

    Attributes:
        executed: action ids, ascending.
        skipped: action ids that were inapplicable, in conflict, refused or broken off, ascending.
        blocks: whether robots took the human's last plan away.
        waited: epochs of waiting before it that the human pays for, who begins something (semantics 10.2).
    """

    executed: tuple[int, ...]
    skipped: tuple[int, ...]
    blocks: bool
    waited: int


class MomentOfPlay(NamedTuple):
    """Between two epochs: the true state, the human's belief, and ``rho``, what remains of their plan.

    ``asleep`` is what is left of their head start, ``waited`` what they pay for once they begin something.
    """

    state: State
    belief: State
    rho: tuple[int, ...]
    asleep: int = 0
    waited: int = 0


class Look(NamedTuple):
    """The moment after step 1, with ``h`` (None: infinite), and whether they did look."""

    now: MomentOfPlay
    best: Fraction | None
    up: bool = True


@dataclass(frozen=True, slots=True)
class PlayedOut:
    """A plan as it turned out.

    Attributes:
        deeds: by epoch from 1, until the goals hold, ``T``, or nothing happens any more.
        cost: of what took place, for the team.
    """

    deeds: tuple[PlayedEpoch, ...]
    goals_hold: bool
    cost: Fraction

    def realised(self, promised: Fraction) -> bool:
        """Goals hold, nothing was skipped or refused, and it costs at most what was promised."""
        return self.goals_hold and self.cost <= promised and not any(deed.skipped for deed in self.deeds)

    @property
    def steps(self) -> list[Step]:
        """What took place, in order."""
        return [Step(t, i) for t, deed in enumerate(self.deeds, start=1) for i in deed.executed]

    @property
    def blocked(self) -> int | None:
        """The first epoch in which robots took the human's last plan away, or None."""
        return next((t for t, deed in enumerate(self.deeds, start=1) if deed.blocks), None)


def play(
    task: Task,
    options: Options,
    human_plan: Sequence[int],
    steps: Sequence[Step],
    *,
    human_model: str,
    horizon: Horizon | None,
    visible: Visible | None = None,
    plans: OptimalPlans | None = None,
) -> PlayedOut:
    """Play the robots' part of a plan against the human.

    Args:
        steps: the composite plan; what they do alone in it is not looked at.
        visible: what a local human sees; None for the default.
        plans: the human's own, where they are known from an earlier question.
    """
    not_theirs = unchosen(task).union(task.human_actions)
    orders = grouped((step.epoch, step.action) for step in steps if step.action not in not_theirs)
    plans = plans or OptimalPlans(task)
    deadline = plans.deadline
    sight = LocalSight(task, visible, deadline.tick) if human_model == "local" else None
    game = Play(task, options, plans, sight)
    last = max(orders, default=0)
    now, deeds = game.start(human_plan), list[PlayedEpoch]()
    while not game.done(now) and len(deeds) != horizon:
        deadline.check()
        before = now
        deed, now = game.act(game.look(now), orders.get(len(deeds) + 1, ()))
        deeds.append(deed)
        expected = now._replace(belief=game.looked(now), waited=before.waited)
        if len(deeds) >= last and before == expected and not deed.executed:
            break  # nothing will ever change again
    done = (i for deed in deeds for i in deed.executed)
    cost = sum((price(task, task.actions[i], options.discount) for i in done), Fraction(0))
    cost += options.waiting_cost * sum(deed.waited for deed in deeds)
    return PlayedOut(tuple(deeds), game.done(now), cost)


class Play:
    """The rules of semantics 6 for one task and one human.

    Args:
        sight: how they see; None for everything.
    """

    def __init__(self, task: Task, options: Options, plans: OptimalPlans, sight: LocalSight | None) -> None:
        self.task = task
        self.strict = options.strict
        self.plans = plans
        self.sight = sight
        self.waiting = idling(task)
        self._unchosen = unchosen(task)
        self._prices_waiting = bool(options.waiting_cost)
        self._head_start = options.head_start

    def start(self, human_plan: Sequence[int]) -> MomentOfPlay:
        """Before the first epoch, with ``pi_H`` in the human's mind."""
        return MomentOfPlay(self.task.init, self.task.init, tuple(human_plan), self._head_start)

    def done(self, now: MomentOfPlay) -> bool:
        """Whether the goals hold, the human is up, and nobody but bystanders is at anything."""
        task, state = self.task, now.state
        reached = task.goal.holds(state) and task.robot_goal.holds(state)
        return reached and not now.asleep and state.issuperset(task.at_rest)

    def looked(self, now: MomentOfPlay) -> State:
        """The human's belief after a look: all of the state, or what is visible of it."""
        return now.state if self.sight is None else self.sight.looked(now.belief, now.state)

    def look(self, now: MomentOfPlay) -> Look:
        """Step 1: ``rho`` is kept or replaced."""
        if now.asleep or any(map(self.with_him, met(self.task, now.state, ()))):
            return Look(now, None, up=False)
        belief, rho = self.looked(now), now.rho
        kept, best = self.plans.cost_of(rho, belief, strict=self.strict), self.plans.cost(belief)
        if best is not None and (kept is None or best < kept):
            rho = self.plans.canonical(belief) or ()
        return Look(now._replace(belief=belief, rho=rho), best)

    def act(self, look: Look, offers: Sequence[int]) -> tuple[PlayedEpoch, MomentOfPlay]:
        """Steps 2 to 4, in an epoch in which robots try the actions ``offers``, joint ones included."""
        now = look.now
        offers = [self._as_possible(i, now.state) for i in sorted(offers)]
        joint = self._accepted(offers, look) if look.up else None
        his, learned = self._own_step(look) if joint is None else (joint, None)
        going_on = met(self.task, now.state, () if his is None or his in self.waiting else (his,))
        executed: list[int] = []
        skipped = [i for i in offers if self.with_him(i)]
        if joint is not None:
            skipped.remove(joint)  # said twice it happens once
        for i in going_on:
            (executed if self._fits(i, executed, now.state) else skipped).append(i)
        alone = self._after(now.state, executed)
        for i in offers:
            if not self.with_him(i):
                (executed if self._fits(i, executed, now.state) else skipped).append(i)
        belief = now.belief if learned is None else learned
        if self.sight is not None:
            belief = self._after(belief, met(self.task, belief, () if his is None else (his,)))
        state = self._after(now.state, executed)
        blocks = self._stuck(state) and not self._stuck(now.state) and not self._stuck(alone)
        theirs = [i for i in executed if self.with_him(i)]
        begins = self._prices_waiting and not self._unchosen.issuperset(theirs)
        deed = PlayedEpoch(
            tuple(sorted(executed)), tuple(sorted(skipped)), blocks, now.waited if begins else 0
        )
        waited = 0 if begins else now.waited + (self._prices_waiting and not theirs)
        rho = now.rho[1:] if now.rho[:1] == (his,) and joint is None else now.rho
        return deed, MomentOfPlay(state, belief, rho, max(0, now.asleep - 1), waited)

    def with_him(self, i: int) -> bool:
        """Whether the human takes part in an action."""
        return self.task.human in self._team(i)

    def _accepted(self, offers: Sequence[int], look: Look) -> int | None:
        """Step 2: the joint action that the human takes part in."""
        each = ((i, self.task.actions[i]) for i in offers if self.with_him(i))
        known = (i for i, one in each if applicable(one, look.now.state) and applicable(one, look.now.belief))
        return next((i for i in known if self._worth_it(i, look)), None)

    def _worth_it(self, joint: int, look: Look) -> bool:
        begun = onward(self.task, look.now.belief, (joint,), strict=self.strict)
        if begun is None or look.best is None:
            return begun is not None
        rest = self.plans.cost(begun)
        return rest is not None and self.task.actions[joint].cost + rest <= look.best

    def _own_step(self, look: Look) -> tuple[int | None, State | None]:
        """Step 3: what the human does alone; where it fails, what they believe then."""
        now = look.now
        if not look.up:
            going_on = next(filter(self.with_him, met(self.task, now.state, ())), None)
            return now.rho[0] if going_on is None and now.rho else going_on, None
        if look.best is None or not now.rho:
            return None, None
        action = self.task.actions[now.rho[0]]
        if applicable(action, now.state):
            return now.rho[0], None
        tested = frozenset((*action.pre, *action.neg))
        return None, (now.belief - tested) | (now.state & tested)

    def _fits(self, i: int, executed: Sequence[int], state: State) -> bool:
        """Whether robots can do it beside what is being done."""
        action = self.task.actions[i]
        others = (self.task.actions[j] for j in executed)
        return applicable(action, state) and fits(action, others, strict=self.strict)

    def _as_possible(self, i: int, state: State) -> int:
        """Several ground actions may be one action by name: one that is applicable."""
        action = self.task.actions[i]
        same = [j for j in self.task.named[action.name] if self._team(j) == action.participants]
        possible = [j for j in [i, *same] if applicable(self.task.actions[j], state)]
        return possible[0] if possible else i

    def _team(self, i: int) -> tuple[int, ...]:
        return self.task.actions[i].participants

    def _after(self, state: State, chosen: Sequence[int]) -> State:
        return after(state, *(self.task.actions[i] for i in chosen))

    def _stuck(self, state: State) -> bool:
        return self.plans.cost(state) is None
