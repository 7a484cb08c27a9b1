"""From a task and options to answers: which space, from which incumbent (semantics 3)."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction

from search.composite import CompositeCall, Known, team_for
from search.call.context import SearchContext
from search.engine.best_first import Incumbent, Progress, best_first
from search.engine.paths import path_sets, path_steps, plan_steps
from search.engine.until import EnoughError
from search.bounds.first_interaction import no_team_bound
from search.improvements import Improvements, is_settled
from search.packed.cost_vector import INFINITE_KEY
from search.packed.parallelise import schedule
from search.prediction import AtHand, Prediction, expected_plan, individual_answers
from search.call.prepared_task import PreparedTask
from search.spaces.fixed_human_plan import FixedHumanPlan
from search.strategies.warm_start import WarmStart, replayed
from serendipity.model.answers.answer import Answer, Status, saved
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.options import INFINITE, Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.horizon import horizon_of
from serendipity.model.task.plans import Step, Window
from serendipity.model.task.task import HumanPlan


def solve(
    prepared: PreparedTask,
    options: Options,
    *,
    human_plan: HumanPlan | None = None,
    deadline: Deadline | None = None,
    warm: WarmStart | None = None,
) -> Iterator[Answer]:
    """Answers with falling objective and rising lower bound; the last one is the best known.

    Args:
        prepared: the task.
        options: options in force; ``mode`` is not ``assistance``.
        human_plan: ``pi_H``, already replayed, or None to predict it.
        deadline: deadline and cancellation.
        warm: what is known before.

    Raises:
        UsageError: the horizon is shorter than ``pi_H``, or one is missing.
    """
    deadline, warm = deadline or Deadline(options.time_limit), warm or WarmStart()
    at_hand: AtHand | None = None
    try:
        context = SearchContext(prepared, options, deadline)
        team = team_for(context)
        if team is not None:
            yield from CompositeCall(context, team, human_plan, _known(context, warm)).answers()
            return
        if options.mode == "individual":
            yield from individual_answers(context, human_plan, warm)
            return
        at_hand = AtHand(context, human_plan, warm)
        yield from at_hand.answers()
        expected = expected_plan(context, human_plan, at_hand)
        team = team_for(context, otherwise=True) if expected is None else None
        if expected is None and (options.mode == "serendipity" or options.keep_prefix):
            answers = iter((Answer("infeasible", reason="no-human-plan"),))
        elif team is not None:
            answers = CompositeCall(context, team, human_plan, _known(context, warm)).answers()
        else:
            answers = _answers(_Call(context, expected, warm, given=human_plan is not None))
    except LIMITS as limit:
        if at_hand is None:
            answers = iter((Answer("unknown", reason=limit_reason(limit)),))
        else:
            answers = iter((_at_limit(context, at_hand, warm, limit_reason(limit)),))
    yield from answers


def _at_limit(context: SearchContext, at_hand: AtHand, warm: WarmStart, limit: str) -> Answer:
    """The answer beside a plan of the human's that is at hand: what was known before, or doing nothing."""
    with suppress(*LIMITS):  # nothing is looked for any more, but it has to be put together
        if warm.steps and (plan := at_hand.best) is not None:
            *_, answer = _Call(context, Prediction(plan, optimal=False), warm, given=False).answers()
            return answer
    return at_hand.last(limit)


def _answers(call: "_Call") -> Iterator[Answer]:
    """Answers to a call; the kernel goes on where private distances turn out to say little."""
    try:
        yield from call.answers()
    except EnoughError:
        team = team_for(call.context, otherwise=True)
        assert team is not None, "it can go on"
        yield from CompositeCall(
            call.context, team, call.plan if call.given else None, call.known()
        ).answers()


def _known(context: SearchContext, warm: WarmStart) -> Known:
    """What another search leaves that was about an earlier moment."""
    found, keys, bound = replayed(context, (), None, None, warm), context.keys, warm.least(INFINITE)
    least = 0 if bound is None else keys.of_objective(bound)
    if found is None:
        return Known(None, least)
    is_best = warm.is_best and keys.objective(found.key) == bound
    return Known(warm.sets, least, is_old=True, is_best=is_best)


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
    expected = expected_plan(context, human_plan, AtHand(context, human_plan))
    if expected is None:
        return None
    call = _Call(context, expected, WarmStart(), given=human_plan is not None)
    call.leave_alone()
    key = call.baseline.key
    return LeftAlone(expected.actions, int(call.horizon), call.keys.cost(key) if key < INFINITE_KEY else None)


class _Call:
    """One planning call: its incumbents and its bound.

    ``baseline`` leaves the human alone; ``idle`` is the best with all robots idle, or with a goal
    of theirs the baseline; ``unaided`` is the best in which no robot acts, where an opportunity has
    to beat that, too; ``best`` is the incumbent over everything.
    """

    def __init__(
        self, context: SearchContext, expected: Prediction | None, warm: WarmStart, *, given: bool
    ) -> None:
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
        self.warm = warm
        known = warm.least(self.horizon)
        self.floor = 0 if known is None else self.keys.of_objective(known)
        """Key that no plan is below, as was known before."""
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
        """Each better answer, then the last one with what is proved of it.

        Raises:
            EnoughError: the kernel should go on.
        """
        try:
            self.leave_alone()
            improvements = Improvements(
                self.context, self.plan, self.epochs, self.baseline.key, self.best, self.progress
            )
            known = replayed(self.context, self.plan or (), self.epochs, improvements.most_cost, self.warm)
            try:
                self._improve_alone(improvements)
            finally:  # what robots gain has to beat that, and is known all the same
                self._begin_with(known)
            self.progress.bound = self._least()
            if self._answer().key < INFINITE_KEY:
                yield self._outcome("feasible")
            if not self._is_known_best() and (self.epochs != 0 or self._answer().key == INFINITE_KEY):
                for _ in improvements.each():
                    yield self._outcome(self._unfinished())
            self.progress.bound = self.best.key
            status: Status = "infeasible"
            if self._answer().key < INFINITE_KEY:
                status = "optimal" if self.settled else "feasible"
        except LIMITS as limit:
            self.limit = limit_reason(limit)
            self.progress.bound = max(self.progress.bound, self.floor)
            is_best = self.settled and (
                self._is_known_best() or is_settled(self.context, self.best, self.progress)
            )
            status = "optimal" if is_best else self._unfinished()
        yield self._outcome(status)

    def _begin_with(self, known: Incumbent | None) -> None:
        """The plan that was known before is the incumbent, where it is one and better."""
        best = self.best
        if known is not None and known.key < best.key:
            best.key, best.node, best.end, best.tail = known.key, known.node, known.end, known.tail

    def _is_known_best(self) -> bool:
        """Whether nothing is better than the incumbent, as was known before."""
        shift = self.keys.objective_shift
        return self.warm.is_best and bool(self.floor) and self.best.key >> shift <= self.floor >> shift

    def known(self) -> Known:
        """What another search of all plans without a window could go on with."""
        best, sets = self.best, None
        if best.key < INFINITE_KEY:
            alone: list[tuple[int, ...]] = [(action,) for action in self.plan or ()]
            sets = alone if best.node is None else path_sets(best.node)
        return Known(sets, self.progress.bound, self.progress.expanded, self.progress.generated)

    def _unfinished(self) -> Status:
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

    def _improve_alone(self, improvements: Improvements) -> None:
        """A given plan may not be optimal: what the human gains alone (semantics 1)."""
        if not self.given or self.plan is None:
            return
        optimum = self.context.alone.key(self.context.packed.init)
        self.improvable = self.task.cost_of(self.plan) > self.keys.cost(optimum)
        if self.improvable and self._may_turn_at_once(optimum):
            # Then what they gain alone is known, and what robots gain has to have a smaller objective.
            window = self.keys.epoch_weight + self.keys.of_start(len(self.plan), int(self.horizon))
            self.best.key = self.idle.key = optimum + window
        elif self.improvable:
            known = self.best.key
            for _ in best_first(improvements.space(idle=True), self.best, Progress(), self.deadline):
                pass
            if not self.task.robot_goal:
                self.idle = replace(self.best)
            elif self.best.key < known:
                self.unaided = replace(self.best)
        self.settled = True

    def _may_turn_at_once(self, optimum: int) -> bool:
        """Whether they may turn to an optimal plan in a window of one epoch, and robots have no goal."""
        options = self.options
        any_suffix = options.suffix == "replan" and options.preservation == "kernel"
        free = options.mode == "serendipity" and any_suffix and options.max_cost is None
        fits = self.epochs is not None and self.keys.actions(optimum) <= self.epochs
        return free and fits and not self.task.robot_goal

    def _helps(self) -> bool:
        """Whether the incumbent is an opportunity: cheaper than the best with robots idle."""
        if self.best.key == INFINITE_KEY or self.plan is None:
            return False
        if not self.settled:
            return self._surely_helps()
        if self.unaided.key < INFINITE_KEY and self._score(self.best) >= self._score(self.unaided):
            return False
        return self.idle.key == INFINITE_KEY or self.keys.cost(self.best.key) < self.keys.cost(self.idle.key)

    def _surely_helps(self) -> bool:
        """Whether the incumbent beats a bound on what the human pays alone, as long as no more is known."""
        if self.given and self.task.robot_goal:
            return False  # what robots do for it without helping counts, too
        alone = INFINITE_KEY
        with suppress(*LIMITS):
            alone = self.context.alone.least(self.context.packed.init)
        if alone >= INFINITE_KEY:
            return False
        gains = self.keys.cost(self.best.key) < self.keys.cost(alone)
        # A human who turns to a better plan alone needs a window, too, and the best objective is answered.
        return gains and (not self.given or self._score(self.best)[0] < self._turned(alone))

    def _turned(self, alone: int) -> Fraction:
        """The least objective of a human who turns to a plan alone that costs no less than a key."""
        return self.keys.objective(alone) + self.options.window_weight

    def _score(self, answer: Incumbent) -> tuple[Fraction, Fraction]:
        return self.keys.objective(answer.key), self.keys.cost(answer.key)

    def _answer(self) -> Incumbent:
        """What is answered: with windows the baseline, where there is no opportunity."""
        return self.baseline if self.options.windowed and not self._helps() else self.best

    def _outcome(self, status: Status) -> Answer:
        helps, answer = self._helps(), self._answer()
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

    def _reason(self, status: Status) -> str | None:
        if status == "infeasible":
            return "no-plan" if self.epochs is None else "no-plan-within-horizon"
        return self.limit if status == "unknown" else None

    def _lower_bound(self, status: Status, answer: Incumbent) -> Fraction | None:
        """On the answer's objective; net of one epoch of window where it has none, or may lose it."""
        if status == "optimal":
            return self.keys.objective(answer.key)
        if status == "infeasible":
            return None
        bound = self.keys.objective(min(max(self.progress.bound, self.floor), self.best.key))
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
