"""What is left of one scenario that is known for certain: the ordinary call from there (semantics 11).

Where the window is still to come it is a call of section 3 from the state, with the rest of the human's plan,
and its strategies answer it.  Where it is open, or the suffix looks back at the whole plan, the space of
windows is searched as it is.
"""

from contextlib import suppress
from dataclasses import dataclass
from functools import reduce
from typing import Final, NamedTuple

from search.bounds.first_interaction import Bounds, no_bound
from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.engine.best_first import Incumbent, Progress, Space, best_first, solve_space
from search.engine.dominance import ParetoFront
from search.engine.paths import plan_steps, whole_plan
from search.human.suffix_rules import Asked, Suffix
from search.modes.scenarios.measure import FOLLOWING, INFINITE_WORTH, Member, Worths
from search.modes.scenarios.variants import Variants
from search.packed.cost_vector import INFINITE_KEY
from search.packed.due import Due
from search.packed.joint_actions import NOTHING, as_option, together
from search.packed.operators import applicable
from search.spaces.factory import no_worse, suffix_rule
from search.spaces.fixed_human_plan import FixedHumanPlan
from search.spaces.windowed import InLayers, PrivateRest, Windowed
from search.strategies.outcome import steps_of
from search.strategies.portfolio import TURNS, best_plan
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.plans import Step, Window
from serendipity.model.task.task import HumanPlan

_TURNS: Final = tuple(turn for turn in TURNS if turn.name not in ("alone", "ties", "saving"))
"""What the human gains alone is part of the search, and ties are not told apart."""


class Remainder(NamedTuple):
    """The best known of what is left.

    Attributes:
        least: no plan is worth less.
        worth: of the plan; infinite without one.
        steps: what everybody does from then on, and maybe did in the epochs before.
        window: of the plan; None without one.
    """

    least: int
    worth: int
    steps: tuple[Step, ...] = ()
    window: Window | None = None

    def goes_on(self, epoch: int, *, inside: bool) -> bool:
        """Whether it has more epochs of its window after one, or the window is still to come."""
        window = self.window
        if window is None:
            return not inside
        return (window.start <= epoch) == inside and window.end > epoch + 1

    def after(self, paid: int) -> "Remainder":
        """What is left once its first epoch has been paid."""
        return self._replace(least=max(self.least - paid, 0), worth=self.worth - paid)


_UNKNOWN: Final = Remainder(0, INFINITE_WORTH)


@dataclass(frozen=True, slots=True)
class Scenario:
    """A plan of the human's that the robots hold possible.

    Attributes:
        plain: the task with the goal, packed by itself.
        context: of the call, packed like those of the other scenarios unless it has a task of its own.
        plan: the human's.
        variants: its actions, and those of the task that scenarios share.
    """

    plain: PreparedTask
    context: SearchContext
    plan: HumanPlan
    horizon: int
    variants: Variants


class Certain:
    """Remainders of one scenario, by where they begin.

    Attributes:
        steps: the packed actions of the human's plan, and what they do.
        suffix: rule 3.
        max_window: most epochs of a window.
    """

    def __init__(self, scenario: Scenario, worths: Worths) -> None:
        self._scenario = scenario
        context = scenario.context
        self._options = context.options
        self._packed = context.packed
        self._worths = worths
        self.steps = context.followed(scenario.plan)
        self.max_window = self._options.max_window or scenario.horizon
        self._ordinary = self._options.suffix == "replan" and self._options.preservation == "kernel"
        self._due = Due(self._packed, context.weights.team, strict=self._options.strict)
        self._keeps = bool(context.task.robot_goal)
        self.suffix: Suffix = suffix_rule(context, scenario.plan)
        if self._keeps:
            chosen = suffix_rule(context, scenario.plan, aside=True)
            self.suffix = Asked(chosen, context.goals, self._due)
        task, bits = context.task, self._packed.fact_bits
        self._facts = [(fact, *found) for fact, found in enumerate(bits) if found is not None]
        self._others = frozenset(fact for fact in task.init if bits[fact] is None)
        self._known: dict[tuple[int, int, int], Remainder] = {}
        self._floors: dict[tuple[int, int, int], int] = {}
        self._asked: dict[tuple[int, int, int], int] = {}
        self.expanded = self.generated = 0

    def known(self, at: Member, epoch: int) -> Remainder | None:
        """A remainder that was asked for before."""
        return self._known.get(_beginning(at, epoch))

    def remainder(
        self,
        at: Member,
        epoch: int,
        deadline: Deadline,
        most: int = INFINITE_WORTH,
        *,
        again: bool = True,
    ) -> Remainder:
        """The remainder after an epoch, its suffix not begun, or what is known of it at the deadline.

        Args:
            most: what is worth as much or more need not be told apart.
            again: whether to go on where a deadline came before.
        """
        beginning = _beginning(at, epoch)
        known = self._known.get(beginning, _UNKNOWN)
        if known.least < min(known.worth, most) and (again or self._asked.get(beginning, 0) < most):
            self._asked[beginning] = most
            found = _UNKNOWN
            with suppress(LimitReachedError):
                found = self._find(*beginning, deadline, min(known.worth, most))
            best = min(known, found, key=lambda one: one.worth)
            known = best._replace(least=min(max(known.least, found.least), best.worth))
            self._known[beginning] = known
        return known

    def floor(self, at: Member, epoch: int) -> int:
        """A bound on a remainder, as far as one was asked for, or follows from another one; else 0."""
        beginning = _beginning(at, epoch)
        known = self._known.get(beginning, _UNKNOWN)
        return max(known.least, self._floors.get(beginning, 0))

    def raise_floor(self, at: Member, epoch: int, least: int) -> None:
        """Note that a remainder is worth no less."""
        beginning = _beginning(at, epoch)
        if least > self._floors.get(beginning, 0):
            self._floors[beginning] = least

    def learn(self, at: Member, epoch: int, found: Remainder) -> None:
        """Note a remainder that follows from another one."""
        self._known.setdefault(_beginning(at, epoch), found)

    def _find(self, epoch: int, state: int, start: int, deadline: Deadline, most: int) -> Remainder:
        """The remainder, if it is worth less than so much; else that nothing is."""
        if start:
            return self._in_space(state, epoch, start, deadline, most)
        if not self.follows(state, epoch):  # robots are in the way
            found = (
                self._in_space(state, epoch, 0, deadline, most),
                self._mended(state, epoch, deadline, most),
            )
            best = min(found, key=lambda one: one.worth)
            return best._replace(least=min(one.least for one in found))
        if epoch >= len(self.steps):
            alone = self.alone(state, epoch)
            return Remainder(alone, alone)
        all_are_free = self._packed.at_rest.holds(state) and self._due.human(state) is None  # but bystanders
        if self._ordinary and all_are_free:
            alone = self.alone(state, epoch)
            helped = self._by_strategies(state, epoch, deadline, most)
            if self._keeps and not self._ends_canonically(state, epoch, helped):
                helped = self._in_space(state, epoch, 0, deadline, most)
            if alone >= helped.worth:
                return helped
            left = plan_steps(self._scenario.plan[epoch:], epoch + 1)  # which no strategy counts beside G_R
            return Remainder(min(helped.least, alone), alone, left)
        return self._in_space(state, epoch, 0, deadline, most)

    def _ends_canonically(self, state: int, epoch: int, found: Remainder) -> bool:
        """Whether the human does after a window what they would whatever robots have to keep."""
        if found.window is None:
            return True
        packed, (start, end), done = self._packed, (found.window.start, found.window.end), list[int]()
        for step in found.steps:
            if step.epoch >= end and packed.counted(step.action):
                done.append(step.action)
        for now in range(epoch + 1, end):
            begun = (step.action for step in found.steps if step.epoch == now and packed.counted(step.action))
            all_of_them = reduce(together, (as_option(packed.op(action), 0) for action in begun), NOTHING)
            going_on = self._due.human(state) or (NOTHING,)
            after = self._due.after(state, [together(all_of_them, part) for part in going_on])
            assert after is not None, "it is a plan"
            state = after
        left = self._scenario.horizon + 1 - end
        if self.suffix.key(state, left, start, INFINITE_KEY) >= INFINITE_KEY:
            return False
        return done == [i for i in self.suffix.actions(state, left, start) if packed.counted(i)]

    def _mended(self, state: int, epoch: int, deadline: Deadline, most: int) -> Remainder:
        """The human follows their plan to its end, and robots make that possible again."""
        context = self._scenario.context.under(deadline)
        space = FixedHumanPlan(
            initial=state,
            horizon=self._scenario.horizon,
            steps=self.steps,
            goals=context.goals,
            successors=context.successors(),
            begins=epoch,
        )
        window = self._worths.epoch
        best = Incumbent(self._worths.key(most if most >= INFINITE_WORTH else max(most - window, 0)))
        least, worth = self._searched(space, best, deadline)
        steps = whole_plan(best) if best.node is not None else ()
        return Remainder(min(least + window, INFINITE_WORTH), min(worth + window, INFINITE_WORTH), steps)

    def _searched(self, space: Space, best: Incumbent, deadline: Deadline) -> tuple[int, int]:
        """Bound and worth of the best plan of a space that is found by a deadline."""
        progress = Progress()
        with suppress(LimitReachedError):
            for _ in best_first(space, best, progress, deadline):
                pass
        self.expanded += progress.expanded
        self.generated += progress.generated
        least = min(progress.bound, best.key)  # equal at its end
        worth = INFINITE_WORTH if best.node is None else self._worths.of_key(best.key)
        return self._worths.of_key(least), worth

    def follows(self, state: int, epoch: int) -> bool:
        """Whether the rest of their plan works, and reaches the goal, if nobody does anything else."""
        for op, part in self.steps[epoch:]:
            after = self._due.after(state, (part,)) if applicable(op, state) else None
            if after is None:
                return False
            state = after
        left = self._scenario.horizon - max(epoch, len(self.steps))
        return self._due.lasting(state, left, self._scenario.context.goals)

    def alone(self, state: int, epoch: int) -> int:
        """What the rest of their plan is worth if they are left alone, and robots end what they are at."""
        return self._worths.epoch + self._worths.of_key(self._left_alone(state, epoch))

    def _left_alone(self, state: int, epoch: int) -> int:
        return self._due.pending(state) + sum(part.weight for _, part in self.steps[epoch:])

    def idle(self, deadline: Deadline) -> int:
        """What the scenario is worth with idle robots; the human may do better than their plan alone."""
        scenario, alone = self._scenario, self.alone(self._packed.init, 0)
        optimum = scenario.context.alone.key(self._packed.init)
        if scenario.context.keys.cost(optimum) >= scenario.context.task.cost_of(scenario.plan):
            return alone
        best = Incumbent(INFINITE_KEY)
        space = self._space(scenario.context.under(deadline), self._packed.init, 0, 0, idle=True)
        return min(alone, self._worths.of_key(solve_space(space, best, deadline).key))

    def _by_strategies(self, state: int, epoch: int, deadline: Deadline, most: int) -> Remainder:
        scenario = self._scenario
        facts = self._others.union(fact for fact, mask, value in self._facts if state & mask == value)
        prepared = scenario.plain if not epoch and state == self._packed.init else scenario.plain.at(facts)
        options = self._options.but(horizon=scenario.horizon - epoch)
        scale = self._worths.scale
        plan, limit = scenario.plan[epoch:], lambda keys: Worths(keys, scale).above(most)
        call = best_plan(prepared, options, plan, deadline, _TURNS, limit)
        if call is None:
            return Remainder(0, INFINITE_WORTH)
        self.expanded += call.progress.expanded
        self.generated += call.progress.generated
        worths, best = Worths(call.keys, scale), call.best
        worth = most if best.node is None else worths.of_key(best.key)
        is_best = call.is_done or call.is_settled
        least = worth if is_best else min(worth, worths.of_key(call.progress.bound))
        if best.node is None:
            return Remainder(least, INFINITE_WORTH)
        window = Window(best.node.start + epoch, best.end + epoch) if best.end else None
        steps = tuple(Step(step.epoch + epoch, step.action) for step in steps_of(call, best))
        return Remainder(least, worth, steps, window)

    def _in_space(self, state: int, epoch: int, start: int, deadline: Deadline, most: int) -> Remainder:
        context = self._scenario.context.under(deadline)
        space = self._space(context, state, epoch, start)
        best = Incumbent(self._worths.key(most))
        is_left_alone = False
        if not start and self.follows(state, epoch):
            alone = self._left_alone(state, epoch) + context.keys.epoch_weight
            alone += context.keys.of_start(len(self.steps), space.horizon)
            is_left_alone = alone < best.key
            best.key = min(alone, best.key)
        least, worth = self._searched(space, best, deadline)
        if best.node is not None:
            return Remainder(least, worth, whole_plan(best), Window(best.node.start, best.end))
        if is_left_alone:
            worth = self._worths.of_key(best.key)
            return Remainder(least, worth, plan_steps(self._scenario.plan[epoch:], epoch + 1))
        return Remainder(least, worth)

    def _space(
        self, context: SearchContext, state: int, epoch: int, start: int, *, idle: bool = False
    ) -> Windowed:
        options, keys, horizon, last = context.options, context.keys, self._scenario.horizon, len(self.steps)
        return Windowed(
            initial=state,
            horizon=horizon,
            last=last,
            max_window=self.max_window,
            keys=keys,
            successors=context.successors(idle=idle),
            bounds=Bounds(context.bound, context.steps, no_bound, None, self._scenario.context.team_bound),
            prefix=InLayers([[step] for step in self.steps]),
            on_the_way=PrivateRest(last, context.bound, keys, horizon),
            suffix=self.suffix,
            labels=ParetoFront(no_worse(keys, options, None)),
            relevant=context.relevant,
            begins=epoch,
            opened=start,
        )


def _beginning(at: Member, epoch: int) -> tuple[int, int, int]:
    """What tells remainders apart: the epoch, the state, and ``xi1`` of an open window.

    That is any epoch that is over where it does not matter, and 0 where the human has followed their plan.
    """
    return epoch, at.state, 0 if at.phase == FOLLOWING else at.start or epoch
