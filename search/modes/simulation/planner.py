"""The best help that happens, with a human who replans on sight (semantics 6)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.engine.best_first import Incumbent, Progress, best_first, solve_space
from search.engine.paths import plan_steps, whole_plan
from search.human.individual_planner import FoundPlan
from search.modes.simulation.human import Human
from search.modes.simulation.in_time import HumanInTime
from search.modes.simulation.simulator import way_on
from search.modes.simulation.space import Reactive
from search.packed.cost_vector import INFINITE_KEY
from search.spaces.fixed_human_plan import follow_plan
from search.strategies.first_answer import FirstAnswer, plan_alone
from search.strategies.warm_start import WarmStart
from serendipity.model.answers.answer import Answer, Status, saved
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.horizon import horizon_of
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan
from serendipity.model.task.visibility import Visible


def solve_for_human(
    prepared: PreparedTask,
    options: Options,
    *,
    human_plan: HumanPlan | None = None,
    visible: Visible | None = None,
    deadline: Deadline | None = None,
    warm: WarmStart | None = None,
) -> Iterator[Answer]:
    """Answers with falling cost and rising lower bound; the last one is the best known.

    The minimum is over the robots' action sequences of at most ``T`` epochs.  The human
    produces prefix, window and suffix unasked, so an answer has no window, and ``K``
    does not count.

    Args:
        options: options in force; ``human_model`` is not ``omniscient``.
        human_plan: ``pi_H``, already replayed, or None to predict it.
        visible: what a local human sees; None for the default.

    Raises:
        UsageError: the horizon is shorter than ``pi_H``, or one is missing.
    """
    task, deadline = prepared.task, deadline or Deadline(options.time_limit)
    first: FirstAnswer | None = None
    plan = human_plan
    try:
        if plan is None:
            context = SearchContext(prepared, options, deadline)
            first = FirstAnswer(context, None)
            yield from first.answers()
            predicted = context.canonical_plan()
            plan = None if predicted is None else predicted.actions
    except LIMITS as limit:
        reason = limit_reason(limit)
        yield Answer("unknown", reason=reason) if first is None else first.last(reason)
        return
    if plan is None:
        yield Answer("infeasible", reason="no-human-plan")
        return
    epochs = int(horizon_of(task, options, plan))
    least = Fraction(0) if first is None else first.least
    try:
        if not task.robot_goal:
            idle = plan_alone(task, FoundPlan(plan, 0, 0), least)
            gain = Fraction(0) if human_plan is None else None  # known only of an optimal plan
            yield idle._replace(horizon=epochs, saving_alone=gain)
        actions = human_plan or ()
        if task.due or options.head_start:
            human: Human = HumanInTime(prepared, options, deadline, actions=actions)
        else:
            model = options.human_model
            human = Human(prepared, options, deadline, human_model=model, actions=actions, visible=visible)
            if human_plan is None:
                human.alone.proved(human.packed.init, plan)
    except LIMITS as limit:
        if task.robot_goal:
            yield Answer("unknown", human_plan=plan, horizon=epochs, reason=limit_reason(limit))
        return
    known = () if warm is None else warm.steps
    call = _Call(human, plan, epochs, known, given=human_plan is not None)
    for answer in call.answers():
        bound = answer.lower_bound
        yield answer._replace(lower_bound=None if bound is None else max(least, bound))


@dataclass(eq=False)
class _Call:
    """One planning call: its incumbents and its bound.

    ``baseline`` leaves the human alone (or, with ``G_R``, follows ``pi_H`` beside the robots);
    ``idle`` is what they do alone, if it reaches all goals; ``best`` is the incumbent over everything.
    """

    human: Human
    plan: HumanPlan
    epochs: int
    known: Sequence[Step]
    given: bool
    settled: bool = False
    """Whether it is known what the human does alone."""
    limit: str | None = None

    def __post_init__(self) -> None:
        context = self.human.context
        self.task, self.options, self.deadline = context.task, context.options, context.deadline
        self.progress = Progress()
        self.baseline, self.idle, self.best = (Incumbent(INFINITE_KEY) for _ in range(3))

    def answers(self) -> Iterator[Answer]:
        """Each better answer, then the last one with what is proved of it."""
        try:
            follow_plan(self.human.context, self.plan, self.epochs, self.baseline)
            solve_space(self._space(idle=True), self.idle, self.deadline)
            self.settled = True
            if not self.task.robot_goal:
                self.best = replace(self.idle)
            self._begin_with_known()
            if self._has_answer():
                yield self._outcome("feasible")
            for _ in best_first(self._space(idle=False), self.best, self.progress, self.deadline):
                yield self._outcome(self._unfinished())
            status: Status = "optimal" if self._has_answer() else "infeasible"
        except LIMITS as limit:
            self.limit = limit_reason(limit)
            status = self._unfinished()
        yield self._outcome(status)

    def _begin_with_known(self) -> None:
        """The plan that was known before is the incumbent, where it works out and is better."""
        if self.task.due:
            return
        human, guarded = self.human, self.options.no_block is not False
        found = way_on(human.start(self.plan), human, self.known, guarded=guarded)
        if found is None or found.node is None or found.node.epoch > self.epochs:
            return
        if found.key < self.best.key and not human.keys.exceeds(found.key, self._most_cost()):
            self.best = found

    def _space(self, *, idle: bool) -> Reactive:
        return Reactive(
            self.human,
            self.human.context.successors(idle=idle),
            start=self.human.start(self.plan),
            horizon=self.epochs,
            no_block=self.options.no_block is not False,
            most_cost=None if idle else self._most_cost(),
        )

    def _most_cost(self) -> int | None:
        """``max_cost`` (eq. 11), scaled and rounded down."""
        return self.human.keys.most_cost(self.options.max_cost, self.baseline.key)

    def _unfinished(self) -> Status:
        return "feasible" if self._has_answer() else "unknown"

    def _has_answer(self) -> bool:
        """Without ``G_R``, leaving the human alone is always an answer."""
        return self.best.key < INFINITE_KEY or not self.task.robot_goal

    def _helps(self) -> bool:
        """Whether the incumbent costs less than ``pi_H``, and than what the human does alone."""
        keys, found = self.human.keys, self.best.key
        if found >= self.idle.key or not self.settled:
            return False
        rivals = [key for key in (self.baseline.key, self.idle.key) if key < INFINITE_KEY]
        return all(keys.cost(found) < keys.cost(key) for key in rivals)

    def _outcome(self, status: Status) -> Answer:
        helps, keys = self._helps(), self.human.keys
        answer = self.best if helps or self.task.robot_goal else self.baseline
        known = answer.key < INFINITE_KEY and status in ("optimal", "feasible")
        steps = plan_steps(self.plan) if answer.node is None else whole_plan(answer)
        baseline = None if self.baseline.key == INFINITE_KEY else keys.cost(self.baseline.key)
        cost = keys.cost(answer.key) if known else None
        return Answer(
            status,
            human_plan=self.plan,
            horizon=self.epochs,
            reason={"infeasible": "no-plan-within-horizon", "unknown": self.limit}.get(status),
            steps=steps if known else None,
            cost=cost,
            objective=cost,
            lower_bound=cost if status == "optimal" else self._lower_bound(status),
            baseline=baseline,
            saving=saved(baseline, cost, opportunity=helps),
            saving_alone=self._saving_alone(baseline) if known else None,
            opportunity=helps,
            expanded=self.progress.expanded,
            generated=self.progress.generated,
        )

    def _saving_alone(self, baseline: Fraction | None) -> Fraction | None:
        """What the human gains alone; not compared where robots have goals."""
        if baseline is None or (not self.settled and (self.given or self.task.robot_goal)):
            return None
        if not self.given or self.task.robot_goal or self.idle.key == INFINITE_KEY:
            return Fraction(0)
        return max(baseline - self.human.keys.cost(self.idle.key), Fraction(0))

    def _lower_bound(self, status: Status) -> Fraction | None:
        if status == "infeasible":
            return None
        return self.human.keys.objective(min(self.progress.bound, self.best.key, self.baseline.key))
