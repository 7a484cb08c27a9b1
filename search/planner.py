"""From a task and options to answers: which space, from which incumbent (semantics 3)."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final

from search.classical.problem import NO_PLAN
from search.composite import CompositeCall, team_for
from search.context import SearchContext
from search.engine.best_first import Incumbent, Node, Progress, Space, best_first
from search.engine.dominance import ParetoFront
from search.engine.paths import path_sets, path_steps, plan_steps
from search.heuristics.first_interaction import no_team_bound
from search.human.plan_graph import PlanGraph
from search.packed.cost_vector import INFINITE_KEY
from search.packed.parallelise import schedule
from search.prediction import Prediction, individual_answers, predicted
from search.prepared_task import PreparedTask
from search.spaces.factory import free_bounds, no_worse, window_space
from search.spaces.fixed_human_plan import FixedHumanPlan
from search.spaces.from_composite import as_incumbent
from search.spaces.stepwise import Stepwise
from search.spaces.unrestricted import Unrestricted
from serendipity.model.answers.answer import Answer, saved
from serendipity.model.errors import LIMITS, LimitReachedError, limit_reason
from serendipity.model.options import INFINITE, Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.horizon import horizon_of
from serendipity.model.task.plans import Step, Window
from serendipity.model.task.task import HumanPlan

_TEAM_SHARE: Final = 0.4
"""What of the time that is left the joint optimum without a horizon may take, where it may be the answer."""

_SOON: Final = 0.2
"""The same for a greedy search, for the sake of an answer on the way."""

_FEW: Final = 1_000
"""Nodes for the sake of a better window for the same objective."""

_GREED: Final = 5
"""What its bound counts for."""

_LITTLE: Final = 0.05
"""The same where it only bounds the answer."""


def solve(
    prepared: PreparedTask,
    options: Options,
    *,
    human_plan: HumanPlan | None = None,
    deadline: Deadline | None = None,
) -> Iterator[Answer]:
    """Answers with falling objective and rising lower bound; the last one is the best known.

    Args:
        prepared: the task.
        options: options in force; ``mode`` is not ``assistance``.
        human_plan: ``pi_H``, already replayed, or None to predict it.
        deadline: deadline and cancellation.

    Raises:
        UsageError: the horizon is shorter than ``pi_H``, or one is missing.
    """
    deadline = deadline or Deadline(options.time_limit)
    try:
        context = SearchContext(prepared, options, deadline)
        team = team_for(context)
        if team is not None:
            yield from CompositeCall(context, team, human_plan).answers()
            return
        if options.mode == "individual":
            yield from individual_answers(context, human_plan)
            return
        expected = predicted(context) if human_plan is None else Prediction(human_plan, optimal=False)
        if expected is None and (options.mode == "serendipity" or options.keep_prefix):
            answers = iter((Answer("infeasible", reason="no-human-plan"),))
        else:
            answers = _Call(context, expected, given=human_plan is not None).answers()
    except LIMITS as limit:
        answers = iter((Answer("unknown", reason=limit_reason(limit)),))
    yield from answers


def optimal_human_plans(prepared: PreparedTask, deadline: Deadline | None = None) -> PlanGraph | None:
    """All optimal plans of the human alone, or None where they have none.

    Raises:
        LimitReachedError: the deadline ran out.
    """
    return SearchContext(prepared, Options(), deadline or Deadline()).optimal_plans()


def canonical_human_plan(prepared: PreparedTask, deadline: Deadline) -> HumanPlan | None:
    """The canonical plan of the human alone (semantics 1), or None where they have none.

    Raises:
        LimitReachedError: the deadline ran out.
    """
    optimal = SearchContext(prepared, Options(), deadline).canonical_plan()
    return None if optimal is None else optimal.actions


@dataclass(frozen=True, slots=True)
class LeftAlone:
    """What happens where nobody helps.

    Attributes:
        plan: ``pi_H``.
        horizon: ``T``.
        cost: what it costs the team, or None where robots can't reach their own goal meanwhile.
    """

    plan: HumanPlan
    horizon: int
    cost: Fraction | None


def left_alone(context: SearchContext, human_plan: HumanPlan | None) -> LeftAlone | None:
    """Doing nothing for the human, in a mode with windows; None where they have no plan alone.

    Args:
        context: of the call.
        human_plan: ``pi_H``, already replayed, or None to predict it.

    Raises:
        UsageError: the horizon is shorter than ``pi_H``, or one is missing.
        LimitReachedError: the deadline ran out.
    """
    expected = predicted(context) if human_plan is None else Prediction(human_plan, optimal=False)
    if expected is None:
        return None
    call = _Call(context, expected, given=human_plan is not None)
    call.leave_alone()
    key = call.baseline.key
    return LeftAlone(expected.actions, int(call.horizon), call.keys.cost(key) if key < INFINITE_KEY else None)


class _Call:
    """One planning call: its incumbents and its bound.

    ``baseline`` leaves the human alone; ``idle`` is the best with all robots idle, or with a goal
    of theirs the baseline; ``unaided`` is the best in which no robot acts, where an opportunity has
    to beat that, too; ``best`` is the incumbent over everything.
    """

    def __init__(self, context: SearchContext, expected: Prediction | None, *, given: bool) -> None:
        plan = None if expected is None else expected.actions
        self.task = context.task
        self.options = context.options
        self.deadline = context.deadline
        self.plan = plan
        self.given = given
        self.horizon = horizon_of(self.task, self.options, plan)
        self.epochs = None if self.horizon == INFINITE else int(self.horizon)
        self.context = context.for_plan(plan or ())
        self.keys = self.context.keys
        self.progress = Progress()
        self.baseline = Incumbent(INFINITE_KEY)
        self.idle = Incumbent(INFINITE_KEY)
        self.unaided = Incumbent(INFINITE_KEY)
        self.best = Incumbent(INFINITE_KEY)
        self.settled = not given and (expected is None or expected.optimal)
        """Whether it is known what the human gains alone."""
        self.improvable = False
        """Whether a given plan costs more than an optimal one."""
        self.limit: str | None = None

    def answers(self) -> Iterator[Answer]:
        """Each better answer, then the last one with what is proved of it."""
        try:
            self.leave_alone()
            self._improve_alone()
            self.progress.bound = self._least()
            if self._answer().key < INFINITE_KEY:
                yield self._outcome("feasible")
            if self.epochs != 0 or self._answer().key == INFINITE_KEY:
                for _ in self._improvements():
                    yield self._outcome(self._unfinished())
            self.progress.bound = self.best.key
            status = "infeasible"
            if self._answer().key < INFINITE_KEY:
                status = "optimal" if self.settled else "feasible"
        except LIMITS as limit:
            self.limit = limit_reason(limit)
            status = "optimal" if self.settled and self._is_settled() else self._unfinished()
        yield self._outcome(status)

    def _improvements(self) -> Iterator[Incumbent]:
        """Each better incumbent, and now and then the same one; on return it is optimal."""
        if self.context.is_shared:
            self._ask_team()
            yield self.best
            if not self._is_settled() and self._composite_decides():
                yield from self._by_composite()
            if self._is_settled():
                yield from self._settle_ties()
                return
        for _ in best_first(self._space(), self.best, self.progress, self.deadline):
            yield self.best
            if self._is_settled():
                return

    def _ask_team(self) -> None:
        """The joint optimum without a horizon bounds every mode's answer, and may be it."""
        team, left = self.context.team, self.deadline.left()
        if team is None:
            return
        share = _TEAM_SHARE if self._composite_decides() else _LITTLE
        part = self.deadline if left is None else self.deadline.within(share * left)
        try:
            first = team.first_plan(self.context.packed.init, part)
            if first is not None:
                self._offer(schedule(self.task, first))
            best = team.best_plan(self.context.packed.init, part, self._raise)
        except LimitReachedError:
            self.deadline.check()
            return
        if best is None:
            self._raise(NO_PLAN)
            return
        self._raise(team.planner.cheapest(self.context.packed.init, self.deadline))
        self._offer(schedule(self.task, best))

    def _settle_ties(self) -> Iterator[Incumbent]:
        """Better windows and fewer actions for the same objective, if they come soon."""
        yield from best_first(self._space(), self.best, Progress(), self.deadline, _FEW)

    def _raise(self, amount: int) -> None:
        """No composite plan costs the team less than an amount."""
        self._raise_key(self.context.amount_key(amount))

    def _raise_key(self, key: int) -> None:
        window = self.keys.epoch_weight if self.options.windowed and self.plan else 0
        self.progress.bound = max(self.progress.bound, min(key + window, INFINITE_KEY))

    def _composite_decides(self) -> bool:
        """Whether every composite plan within ``T`` keeps the mode's rules, and its objective is its cost."""
        options = self.options
        if self.epochs is None or options.max_cost is not None or self.context.weights.announces:
            return False
        if not options.windowed:
            return True
        free = options.suffix == "replan" and options.preservation == "kernel" and not options.keep_prefix
        return free and not options.window_weight and options.max_window is None and not self.task.robot_goal

    def _by_composite(self) -> Iterator[Incumbent]:
        """The best composite plan within ``T``, which is the answer but for its window."""
        joint = Incumbent(min(self.baseline.key, self.best.key)) if self.options.windowed else self.best
        left = self.deadline.left()
        part = self.deadline if left is None else self.deadline.within(_SOON * left)
        if left is not None:
            with suppress(LimitReachedError):
                for _ in best_first(self._composite_space(joint.key, _GREED), joint, Progress(), part):
                    self._offer_joint(joint)
                    yield self.best
        self.deadline.check()
        progress = Progress(self.progress.bound, told_at=self.deadline.elapsed())
        for _ in best_first(self._composite_space(joint.key), joint, progress, self.deadline):
            self.progress.expanded, self.progress.generated = progress.expanded, progress.generated
            self._raise_key(progress.bound)
            self._offer_joint(joint)
            yield self.best
            if self._is_settled():
                return
        self._raise_key(joint.key)

    def _offer_joint(self, joint: Incumbent) -> None:
        if joint is not self.best and joint.node is not None:
            self._offer(path_steps(joint.node))

    def _composite_space(self, limit: int, greed: int = 1) -> Space[Any, Incumbent]:
        assert self.epochs is not None, "only with a horizon"
        if self.context.team is None:
            return self._unrestricted(limit)
        return Stepwise(
            initial=self.context.packed.init,
            horizon=self.epochs,
            goals=self.context.goals,
            successors=self.context.successors(),
            bounds=free_bounds(self.context, self.epochs, limit, idle=False),
            labels=ParetoFront(),
            greed=greed,
        )

    def _offer(self, steps: Sequence[Step]) -> None:
        """A composite plan, which may be the best so far in this mode."""
        if not self._composite_decides() or self.epochs is None:
            return
        found = as_incumbent(self.context, steps, self.plan or (), self.epochs)
        if found is not None and found.key < self.best.key:
            self.best.key, self.best.node = found.key, found.node
            self.best.end, self.best.tail = found.end, found.tail

    def _is_settled(self) -> bool:
        """Whether the incumbent's objective can't be beaten."""
        best, bound = self.best.key, self.progress.bound
        return best < INFINITE_KEY and self.keys.objective(best) <= self.keys.objective(bound)

    def _unfinished(self) -> str:
        """The status while nothing is proved; an infinite bound is a proof."""
        if self._answer().key < INFINITE_KEY:
            return "feasible"
        return "unknown" if self.progress.bound < INFINITE_KEY else "infeasible"

    def leave_alone(self) -> None:
        """The first incumbent: the human follows ``pi_H``; robots, without the human, see to ``G_R``."""
        plan, epochs = self.plan, self.epochs
        if plan is not None and (epochs is None or len(plan) <= epochs):
            if not self.task.robot_goal:
                self.baseline.key = sum(option.weight for _, option in self.context.followed(plan))
            else:
                self._pursue_robot_goal(plan)
        self.idle = replace(self.baseline, key=self.baseline.key + self._window_of_nothing())
        # With a goal of the robots' own, leaving the human alone is what a plan with a window is
        # compared with, but it is not itself one that fits every window (semantics 3.1).
        if not (self.options.windowed and self.task.robot_goal):
            self.best = replace(self.idle)

    def _pursue_robot_goal(self, plan: HumanPlan) -> None:
        space = FixedHumanPlan(
            initial=self.context.packed.init,
            horizon=self.epochs,
            steps=self.context.followed(plan),
            goals=self.context.goals,
            successors=self.context.successors(),
        )
        found = Incumbent(INFINITE_KEY)
        for _ in best_first(space, found, Progress(), self.deadline):
            pass
        self.baseline = found  # what savings are counted from has to be the least there is

    def _window_of_nothing(self) -> int:
        """Doing nothing fits every window; its best is the shortest and latest (semantics 3.1)."""
        if not self.options.windowed or not self.plan or self.epochs is None:
            return 0
        if self.baseline.key == INFINITE_KEY:
            return 0
        return self.keys.epoch_weight + self.keys.of_start(len(self.plan), self.epochs)

    def _least(self) -> int:
        """A first bound, before there is any of the robots: what the human has to do themselves."""
        window = self.keys.epoch_weight if self._window_of_nothing() else 0
        context, init = self.context, self.context.packed.init
        team = context.team_bound
        return (context.bound(init) if team is no_team_bound else team(init)) + window

    def _improve_alone(self) -> None:
        """A given plan may not be optimal: what the human gains alone (semantics 1)."""
        if not self.given or self.plan is None:
            return
        optimum = self.context.alone.key(self.context.packed.init)
        self.improvable = self.task.cost_of(self.plan) > self.keys.cost(optimum)
        if self.improvable:
            known = self.best.key
            for _ in best_first(self._space(idle=True), self.best, Progress(), self.deadline):
                pass
            if not self.task.robot_goal:
                self.idle = replace(self.best)
            elif self.best.key < known:
                self.unaided = replace(self.best)
        self.settled = True

    def _space(self, *, idle: bool = False) -> Space[Node, Incumbent]:
        if self.options.windowed:
            assert self.plan is not None and self.epochs is not None
            most_cost = self._most_cost()
            return window_space(self.context, self.plan, self.epochs, most_cost, self.best.key, idle=idle)
        return self._unrestricted(self.best.key, idle=idle)

    def _unrestricted(self, limit: int, *, idle: bool = False) -> Space[Node, Incumbent]:
        most_cost = self._most_cost()
        # What is announced may make a cheap node look dearer than one that exceeds max_cost in the end.
        announces = self.context.weights.announces
        compared = no_worse(self.keys, self.options, most_cost) if announces else None
        return Unrestricted(
            initial=self.context.packed.init,
            horizon=self.epochs,
            most_cost=most_cost,
            goals=self.context.goals,
            keys=self.keys,
            successors=self.context.successors(idle=idle),
            bounds=free_bounds(self.context, self.epochs, limit, idle=idle),
            labels=ParetoFront(compared),
        )

    def _most_cost(self) -> int | None:
        """``max_cost`` (eq. 11), scaled and rounded down."""
        return self.keys.most_cost(self.options.max_cost, self.baseline.key)

    def _helps(self) -> bool:
        """Whether the incumbent is an opportunity: cheaper than the best with robots idle."""
        if self.best.key == INFINITE_KEY or self.plan is None:
            return False
        if not self.settled:  # then at least what is known of the human alone decides
            alone = INFINITE_KEY if self.given else self.context.alone.least(self.context.packed.init)
            return alone < INFINITE_KEY and self.keys.cost(self.best.key) < self.keys.cost(alone)
        if self.unaided.key < INFINITE_KEY and self._score(self.best) >= self._score(self.unaided):
            return False
        return self.idle.key == INFINITE_KEY or self.keys.cost(self.best.key) < self.keys.cost(self.idle.key)

    def _score(self, answer: Incumbent) -> tuple[Fraction, Fraction]:
        return self.keys.objective(answer.key), self.keys.cost(answer.key)

    def _answer(self) -> Incumbent:
        """What is answered: with windows the baseline, where there is no opportunity."""
        return self.baseline if self.options.windowed and not self._helps() else self.best

    def _outcome(self, status: str) -> Answer:
        helps = self._helps()
        answer = self._answer()
        has_plan = answer.key < INFINITE_KEY and status in ("optimal", "feasible")
        cost = self.keys.cost(answer.key) if has_plan else None
        baseline = self.keys.cost(self.baseline.key) if self.baseline.key < INFINITE_KEY else None
        saving_alone = None
        if baseline is not None and self.settled and has_plan:
            saving_alone = baseline - self.keys.cost(self.idle.key)
        return Answer(
            status,
            human_plan=self.plan,
            horizon=self.horizon,
            reason=self._reason(status),
            steps=self._steps(answer) if has_plan else None,
            window=Window(answer.node.start, answer.end) if answer.node and answer.end and has_plan else None,
            cost=cost,
            objective=self.keys.objective(answer.key) if has_plan else None,
            lower_bound=self._lower_bound(status, answer),
            baseline=baseline,
            saving=saved(baseline, cost, opportunity=helps),
            saving_alone=saving_alone,
            opportunity=helps,
            expanded=self.progress.expanded,
            generated=self.progress.generated,
        )

    def _reason(self, status: str) -> str | None:
        if status == "infeasible":
            return "no-plan" if self.epochs is None else "no-plan-within-horizon"
        return self.limit if status == "unknown" else None

    def _lower_bound(self, status: str, answer: Incumbent) -> Fraction | None:
        """On the answer's objective; net of one epoch of window where it has none, or may lose it."""
        if status == "optimal":
            return self.keys.objective(answer.key)
        if status == "infeasible":
            return None
        bound = self.keys.objective(min(self.progress.bound, self.best.key))
        if self.options.windowed and (not answer.end or self.task.robot_goal or self.improvable):
            # The answer is the baseline, which has no K, or may become it: not every plan is an opportunity.
            bound = min(bound - self.options.window_weight, self.keys.objective(self.baseline.key))
        if answer.key < INFINITE_KEY:
            bound = min(bound, self.keys.objective(answer.key))
        return max(bound, Fraction(0))

    def _steps(self, answer: Incumbent) -> tuple[Step, ...]:
        if answer.node is None:
            return plan_steps(self.plan or ())
        if self.epochs is None:
            return schedule(self.task, path_sets(answer.node))
        steps = path_steps(answer.node) + plan_steps(answer.tail, answer.end)
        walks = self.context.walks(self.plan or ()) if answer.node.idle else None
        return steps if walks is None else tuple(sorted((*steps, *walks.steps(answer.node))))
