"""Help for a human of whom only scenarios are known, by robots that watch or not (semantics 11)."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.engine.paths import plan_steps
from search.modes.scenarios.lines import Line, Moves, Question
from search.modes.scenarios.measure import INFINITE_WORTH, Worths, measure_of
from search.modes.scenarios.played import Played
from search.modes.scenarios.policies import PolicySearch
from search.modes.scenarios.remainder import Scenario
from search.modes.scenarios.sequences import SequenceSearch
from search.modes.scenarios.variants import Variants
from search.packed.packings import asked_facts, human_facts
from serendipity.model.answers.answer import Answer, ServedGoal, Status, saved
from serendipity.model.errors import LIMITS
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.horizon import common_horizon
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan


@dataclass(frozen=True, slots=True)
class Candidate:
    """What the human may want, and do; those are equal that differ in name and weight only.

    Attributes:
        weight: the probability, more than 0.
        name: for people.
        kept: what else has to hold in the end: robots see to it.
        own: a task of its own, by whose ids goals and plan are: the shared one under rules of help.
        original: by action of that task the one of the shared task.
        ahead: objective and cost that it begins with, where the greatest counts and the best policy is asked
            for whether it helps or not.
    """

    goal: Condition
    plan: HumanPlan
    weight: Fraction = field(compare=False)
    name: str = field(default="", compare=False)
    kept: Condition = field(default_factory=Condition)
    own: PreparedTask | None = None
    original: Sequence[int] = field(default=(), compare=False)
    ahead: tuple[Fraction, Fraction] | None = None

    @property
    def shared(self) -> HumanPlan:
        """The plan by ids of the shared task."""
        return tuple(self.original[i] for i in self.plan) if self.original else self.plan


def solve_scenarios(
    prepared: PreparedTask,
    options: Options,
    candidates: Sequence[Candidate],
    deadline: Deadline | None = None,
) -> Iterator[Answer]:
    """Policies that get better, idle robots first; the last is the best, or the best known at a limit.

    Figures are by the ``risk`` of the options, ``steps`` is what robots do by themselves before any
    scenarios are told apart, and ``goals`` what happens in each.

    Args:
        prepared: the task that they share; its own goals play no part.
        options: mode ``serendipity``; ``horizon`` None means the length of the longest plan.
        candidates: at least one; weights add up to 1.

    Raises:
        UsageError: the horizon is shorter than the longest plan.
    """
    horizon = common_horizon(options, [candidate.plan for candidate in candidates])
    call = _ScenarioCall(prepared, options, candidates, horizon, deadline or Deadline(options.time_limit))
    best = call.answer("feasible")
    yield best
    try:
        for _ in call.improved():
            known, best = best, call.answer("feasible")
            if (best.objective, best.cost) != (known.objective, known.cost):
                yield best
        best = call.answer("optimal" if call.is_exact else "feasible")
    except LIMITS:
        with suppress(*LIMITS):  # what is done after a window may not have been put together yet
            best = call.answer("feasible")
    yield best


@dataclass(eq=False)
class _ScenarioCall:
    """One call."""

    prepared: PreparedTask
    options: Options
    given: Sequence[Candidate]
    horizon: int
    deadline: Deadline

    def __post_init__(self) -> None:
        self._candidates = _merged(self.given)
        self._differ = any(one.own is not self.given[0].own for one in self.given)
        self._question: Question | None = None
        self._searches: list[SequenceSearch | PolicySearch] = []
        """Those that have begun."""
        self._idle: int | None = None
        self.is_exact = True

    def improved(self) -> Iterator[None]:
        """Look for better policies until a limit comes; yield whenever there may be one."""
        scenarios, deadline = self._scenarios(), self.deadline
        context = scenarios[0].context
        given = [c.ahead for c in self._candidates if c.ahead is not None]
        amounts = (amount * context.keys.scale for pair in given for amount in pair)
        measure = measure_of(self.options.risk, [c.weight for c in self._candidates], amounts)
        self._worths = Worths(context.keys, measure.parts)
        differing = scenarios if self._differ else scenarios[:1]
        moves = [Moves(one.context.successors(), self._worths) for one in differing]
        lines = [Line(s, i, moves[i % len(moves)], self._worths) for i, s in enumerate(scenarios)]
        known = (
            [line.certainly(line.first(), 0, deadline) for line in lines]
            if self.options.risk == "regret"
            else [(0, 0)] * len(lines)
        )
        self.is_exact = all(least == worth for least, worth in known)
        ahead = [self._worths.value(*pair) for pair in given] or [-least for least, _ in known]
        members = tuple(line.first()._replace(ahead=a) for line, a in zip(lines, ahead, strict=True))
        question = Question(lines, members, measure, self.horizon, deadline)
        self._question = question
        self._idle = question.value([line.certain.idle(deadline) for line in lines])
        sequences = SequenceSearch(question)
        self._searches.append(sequences)
        yield from sequences.guided()
        if self.options.policy == "watching":
            self._searches.append(PolicySearch(question, sequences.upper))
        yield from self._searches[-1].run()

    def _scenarios(self) -> list[Scenario]:
        """The task with each candidate's goal, packed with what any of them or its plan asks for.

        Where they have tasks that differ, with all facts of the shared one: robots may do the same in each.
        """
        options = self.options.but(
            horizon=self.horizon, time_limit=None, policy="watching", risk="mean", ties="fixed"
        )
        facts = len(self.prepared.task.facts) if self._differ else None
        parts = [[one] for one in self._candidates] if self._differ else [self._candidates]
        found = []
        for part in parts:
            prepared = part[0].own or self.prepared
            asked = asked_facts(prepared.task, (action for one in part for action in one.plan))
            asked |= frozenset(range(facts or 0))
            if options.preservation == "state":
                asked |= human_facts(prepared.task)
            goals = [(one.goal, one.kept) for one in part]
            for packed, one in zip(prepared.with_goals(goals, asked, self.deadline), part, strict=True):
                context = SearchContext(packed, options, self.deadline)
                variants = Variants(context, one.original, facts)
                plain = prepared.with_goal(one.goal, one.kept)
                found.append(Scenario(plain, context, one.plan, self.horizon, variants))
        return found

    # -- the answer

    def answer(self, status: Status) -> Answer:
        """The best policy if it is cheaper than idle robots, else these."""
        searches, baseline = self._searches, self._baseline()
        if not searches or self._idle is None:
            return self._told(status, baseline)
        best = min(searches, key=lambda search: search.upper)
        _, idle = self._worths.figures(self._idle)
        lower, _ = self._worths.figures(max(search.lower for search in searches))
        least = max(lower, Fraction(0))
        if best.upper < INFINITE_WORTH:
            objective, cost = self._worths.figures(best.upper)
            if cost < idle or self._candidates[0].ahead is not None:
                figures = cost, objective, least if self.is_exact else Fraction(0)
                return self._told(
                    status, baseline, figures, played=best.played(), saving_alone=baseline - idle
                )
        bound = baseline
        if status != "optimal":  # net of the one epoch that every window has
            window = self.options.window_weight if self.options.risk != "regret" else 0
            bound = min(baseline, max(Fraction(0), least - window)) if self.is_exact else Fraction(0)
        return self._told(status, baseline, (baseline, baseline, bound), saving_alone=baseline - idle)

    def _baseline(self) -> Fraction:
        """What it costs to leave the human alone; for regret at most so much, before more is known."""
        if self._question is not None:
            alone = [line.certain.alone(line.first().state, 0) for line in self._question.lines]
            return self._worths.figures(self._question.value(alone))[1]
        costs = [(c.weight, self.prepared.task.cost_of(c.shared)) for c in self._candidates]
        if self.options.risk == "mean":
            return sum((weight * cost for weight, cost in costs), Fraction(0))
        return max(cost for _, cost in costs)

    def _told(
        self,
        status: Status,
        baseline: Fraction,
        figures: tuple[Fraction, Fraction, Fraction] | None = None,
        *,
        played: dict[int, Played] | None = None,
        saving_alone: Fraction | None = None,
    ) -> Answer:
        """The answer with what happens in each scenario, or with idle robots.

        Args:
            figures: cost, objective and a bound on it; None where no more is known than the baseline.
            played: what happens, where robots help.
            saving_alone: None before it is known.
        """
        cost, objective, bound = figures or (baseline, baseline, Fraction(0))
        happens = played or {}
        lines = () if self._question is None else self._question.lines
        counted = [*(line.certain for line in lines), *self._searches]
        return Answer(
            status,
            horizon=self.horizon,
            steps=self._before_told_apart(happens) if happens else (),
            goals=tuple(self._served(candidate, happens) for candidate in self.given),
            cost=cost,
            baseline=baseline,
            saving=saved(baseline, cost, opportunity=bool(happens)),
            saving_alone=saving_alone,
            objective=objective,
            lower_bound=bound,
            opportunity=bool(happens),
            expanded=sum(one.expanded for one in counted),
            generated=sum(one.generated for one in counted),
            realised={},
        )

    def _before_told_apart(self, happens: dict[int, Played]) -> tuple[Step, ...]:
        """What robots do by themselves as long as they can't tell any scenarios apart."""
        task, horizon = self.prepared.task, self.horizon
        if self.options.policy == "watching":
            seen = [
                {s.epoch: task.actions[s.action].name for s in self._begun(played.steps)}
                for played in happens.values()
            ]
            epochs = range(1, horizon + 1)
            differ = (epoch for epoch in epochs if len({one.get(epoch) for one in seen}) > 1)
            horizon = next(differ, horizon)
        steps = next(iter(happens.values())).steps
        human = task.human
        return tuple(
            s for s in steps if s.epoch <= horizon and human not in task.actions[s.action].participants
        )

    def _begun(self, steps: Iterable[Step]) -> tuple[Step, ...]:
        """The human's actions of some steps; they wait, or go on with these, in the other epochs."""
        assert self._question is not None, "something is known to happen"
        task, begins = self.prepared.task, self._question.lines[0].variants.begins
        return tuple(
            s for s in steps if task.human in task.actions[s.action].participants and begins(s.action)
        )

    def _served(self, candidate: Candidate, happens: dict[int, Played]) -> ServedGoal:
        """What happens in a scenario."""
        task = self.prepared.task
        number = self._candidates.index(candidate)
        as_planned = plan_steps(candidate.shared)
        found = happens.get(number, Played(as_planned, None))
        discount = self.options.discount
        if happens and self._begun(found.steps) == self._begun(as_planned):
            found = Played(found.steps, None)  # a window in which they do as planned is none
        cost = sum((task.team_cost(task.actions[s.action], discount) for s in found.steps), Fraction(0))
        plan = candidate.shared
        return ServedGoal(candidate.name, candidate.weight, plan, found.steps, found.window, cost)


def _merged(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Candidates that are the same in all but name, as one: what is best for one is best for both."""
    weights: dict[Candidate, Fraction] = {}
    for candidate in candidates:
        weights[candidate] = weights.get(candidate, Fraction(0)) + candidate.weight
    found = (replace(candidate, weight=weight) for candidate, weight in weights.items())
    return sorted(found, key=lambda candidate: -candidate.weight)
