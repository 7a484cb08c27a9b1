"""One robots' plan for all candidate goals: least expected cost, every human plan kept intact.

The robots commit to a sequence of action sets of their own, whatever the goal is.  Beside it
each candidate has a timeline of its own (rules 1-3 of semantics 3.1, with its own window); a joint
action with the human takes place on the timelines that want it, if its robots are idle in
their own sequence then.  Given the sequence, timelines are independent of each other, so their
best completions add up: the search is over sequences only, best first, and exact.

What it does not cover: robots that watch the human and change their plan in mid-course.  They
stay committed, so they can help in different windows only as far as one sequence allows it;
and as no robot acts after a window (rule 3), no window ends before the robots' last action.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from heapq import heappop, heappush
from itertools import count

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.engine.paths import path_steps, plan_steps
from search.modes.goals.expectation import Expectation, Rank
from search.modes.goals.timeline import Ended, GoalTimeline, Situation
from search.packed.cost_vector import INFINITE_KEY
from search.packed.joint_actions import NOTHING, JointAction, as_option, together
from search.packed.packings import asked_facts, human_facts
from search.packed.successor_generator import Successors
from search.strategies.portfolio import solve
from serendipity.model.answers.answer import Answer, ServedGoal, Status, saved
from serendipity.model.errors import LIMITS
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.horizon import common_horizon
from serendipity.model.task.plans import Step, Window
from serendipity.model.task.task import HumanPlan

_SAME = 2
"""How many components of a rank decide; later ones only choose among what was met first."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A goal that the human may have.

    Attributes:
        goal: the goal.
        plan: their current plan, if that is their goal.
        weight: its probability, more than 0.
        name: for people.
    """

    goal: Condition
    plan: HumanPlan
    weight: Fraction
    name: str = ""


def solve_expected(
    prepared: PreparedTask,
    options: Options,
    candidates: Sequence[Candidate],
    deadline: Deadline | None = None,
) -> Answer:
    """The robots' plan of least expected objective, or doing nothing if none is cheaper than that.

    Costs are expectations, ``steps`` is what robots do by themselves whatever the goal is, and ``goals``
    what happens then for each candidate; nodes expanded for single candidates count as well.

    Args:
        prepared: the task; its own goal plays no part, and robots have none.
        options: mode ``serendipity``; ``horizon`` None means the length of the longest plan.
        candidates: at least one; weights add up to 1.
        deadline: deadline and cancellation.

    Raises:
        UsageError: the horizon is shorter than the longest plan.
    """
    search = _SequenceSearch(prepared, options, candidates, deadline or Deadline(options.time_limit))
    try:
        search.prepare()
        search.run()
    except LIMITS:
        return search.answer("feasible")
    return search.answer("optimal")


@dataclass(frozen=True, slots=True)
class _GoalsNode:
    """A robots' plan up to an epoch, and what can have happened beside it."""

    epoch: int
    situations: tuple[Situation, ...]
    robots: JointAction
    spent: int
    """Key of the robots' own actions."""
    parent: "_GoalsNode | None"


@dataclass(frozen=True, slots=True)
class _BestSequence:
    """A complete robots' plan."""

    rank: Rank
    ends: tuple[Ended, ...]
    robots: tuple[Step, ...]


class _SequenceSearch:
    """One call."""

    def __init__(
        self, prepared: PreparedTask, options: Options, candidates: Sequence[Candidate], deadline: Deadline
    ) -> None:
        self._prepared = prepared
        self._candidates = candidates
        self._horizon = common_horizon(options, [candidate.plan for candidate in candidates])
        self._options = options.but(horizon=self._horizon, time_limit=None)
        self._deadline = deadline
        self._floors: list[Rank] = [(0, 0)] * len(candidates)
        self._idle: _BestSequence | None = None
        self._best: _BestSequence | None = None
        self._bound: Rank = (0, 0)
        self._expanded = self._generated = 0

    # -- what the search starts from

    def prepare(self) -> None:
        """Tables, incumbents and floors: what each candidate alone would allow."""
        context = [SearchContext(own, self._options, self._deadline) for own in self._over_one_packing()]
        self._keys = context[0].keys
        self._expected = Expectation([candidate.weight for candidate in self._candidates], self._keys)
        self._team = context[0].weights.team
        self._packed = context[0].packed
        self._acting = context[0].successors()
        self._timelines = [
            GoalTimeline(own, candidate.plan, self._horizon)
            for own, candidate in zip(context, self._candidates, strict=True)
        ]
        self._offer({}, context[0].successors(idle=True))
        self._idle = self._best
        self._offer({}, self._acting)
        for i, candidate in enumerate(self._candidates):
            outcome = self._alone_known(candidate)
            self._floors[i] = self._floor(outcome)
            self._offer(self._own_actions(outcome), self._acting)

    def _over_one_packing(self) -> list[PreparedTask]:
        """The task with each candidate as its goal, packed with what any of them or its plan asks for."""
        task = self._prepared.task
        asked = asked_facts(task, (action for candidate in self._candidates for action in candidate.plan))
        if self._options.preservation == "state":
            asked |= human_facts(task)
        goals = [candidate.goal for candidate in self._candidates]
        return self._prepared.with_goals(goals, asked, self._deadline)

    def _alone_known(self, candidate: Candidate) -> Answer:
        """The answer of section 3, were this the goal for certain."""
        own = self._prepared.with_goal(candidate.goal)
        *_, last = solve(own, self._options, human_plan=candidate.plan, deadline=self._deadline)
        self._expanded += last.expanded or 0
        self._generated += last.generated or 0
        return last

    def _floor(self, outcome: Answer) -> Rank:
        """No timeline of the candidate ranks below this: committed robots can do no better."""
        self._deadline.check()
        window = self._options.window_weight
        if outcome.status != "optimal" or outcome.cost is None or outcome.objective is None:
            return (0, 0)
        if outcome.opportunity:
            return self._expected.scaled(outcome.objective), self._expected.scaled(outcome.cost)
        if outcome.saving_alone:  # not the best with idle robots: the answer bounds nothing
            return (0, 0)
        return self._expected.scaled(outcome.cost + window), self._expected.scaled(outcome.cost)

    def _own_actions(self, outcome: Answer) -> dict[int, JointAction]:
        """What robots do by themselves in an answer, by epoch."""
        found: dict[int, JointAction] = {}
        for step in outcome.steps or ():
            if self._prepared.task.human not in self._prepared.task.actions[step.action].participants:
                op = self._packed.op(step.action)
                found[step.epoch] = together(found.get(step.epoch, NOTHING), as_option(op, self._team(op)))
        return found

    def _offer(self, robots: dict[int, JointAction], acting: Successors) -> None:
        """Play a robots' plan against every candidate; keep it if it is the best so far."""
        node: _GoalsNode | None = self._root()
        for epoch in range(1, self._horizon + 1):
            assert node is not None
            node = self._child(node, robots.get(epoch, NOTHING), acting)
            if node is None:
                return
        assert node is not None
        self._complete(node)

    # -- the search

    def run(self) -> None:
        """Best first over robots' plans; on return the incumbent is optimal."""
        tie = count()
        root = self._root()
        queue = [(self._rank_bound(root), 0, next(tie), root)]
        seen: dict[object, int] = {}
        while queue and queue[0][0] < self._decisive():
            self._bound, _, _, node = heappop(queue)
            self._deadline.check()
            self._expanded += 1
            for robots in self._choices(node):
                child = self._child(node, robots, self._acting)
                self._generated += 1
                if child is None or not _is_new(child, seen):
                    continue
                bound = self._rank_bound(child)
                if bound >= self._decisive():
                    continue
                if child.epoch == self._horizon:
                    self._complete(child)
                else:
                    heappush(queue, (bound, -child.epoch, next(tie), child))
        self._bound = self._decisive()

    def _root(self) -> _GoalsNode:
        return _GoalsNode(0, tuple(line.first() for line in self._timelines), NOTHING, 0, None)

    def _choices(self, node: _GoalsNode) -> Iterator[JointAction]:
        """Robots' action sets that are possible on some label of the candidate with the fewest."""
        if node.epoch == self._horizon:
            return
        fewest = min(node.situations, key=lambda now: len(now.inside))
        states = {label.state for label in fewest.inside.values()}
        if fewest.follows is not None:
            states.add(fewest.follows.state)
        offered: dict[tuple[int, ...], JointAction] = {
            (): NOTHING
        }  # also where all that is left is the end of a window
        for state in sorted(states):
            for option in self._acting.robots(state):
                offered.setdefault(option.actions, option)
        yield from offered.values()

    def _child(self, node: _GoalsNode, robots: JointAction, acting: Successors) -> _GoalsNode | None:
        after = []
        self._deadline.tick()
        for i, line in enumerate(self._timelines):
            situation = line.after(node.situations[i], node.epoch + 1, robots, acting, self._limit(i))
            if situation is None:
                return None
            after.append(situation)
        return _GoalsNode(node.epoch + 1, tuple(after), robots, node.spent + robots.weight, node)

    def _limit(self, candidate: int) -> int:
        """Key at which a candidate alone makes every robots' plan worse than the incumbent."""
        if self._best is None:
            return INFINITE_KEY
        others = sum(
            share * floor[0]
            for i, (share, floor) in enumerate(zip(self._expected.shares, self._floors, strict=True))
            if i != candidate
        )
        most = (self._best.rank[0] - others) // self._expected.shares[candidate]
        return (most + 1) << self._keys.objective_shift

    def _complete(self, node: _GoalsNode) -> None:
        ends = []
        for line, last in zip(self._timelines, node.situations, strict=True):
            end = line.complete(last)
            if end is None:
                return
            ends.append(end)
        rank = self._expected.weighted([self._expected.rank(end.key) for end in ends])
        if self._best is None or rank < self._best.rank:
            self._best = _BestSequence(rank, tuple(ends), _robots_steps(node))

    def _rank_bound(self, node: _GoalsNode) -> Rank:
        ranks = [self._expected.rank(now.bound)[:_SAME] for now in node.situations]
        return self._expected.weighted([max(pair) for pair in zip(ranks, self._floors, strict=True)])

    def _decisive(self) -> Rank:
        assert self._best is not None, "leaving the human alone is always possible"
        return self._best.rank[:_SAME]

    # -- the answer

    def answer(self, status: Status) -> Answer:
        """The incumbent if it is cheaper than idle robots, else: do nothing."""
        plans = [(c.weight, self._prepared.task.cost_of(c.plan)) for c in self._candidates]
        baseline = sum((weight * cost for weight, cost in plans), Fraction(0))
        best = self._best
        helps = best is not None and self._idle is not None and best.rank[1] < self._idle.rank[1]
        saving_alone = (
            Fraction(0) if self._idle is None else baseline - self._expected.unscaled(self._idle.rank[1])
        )
        if helps:
            assert best is not None
            served = tuple(map(self._served, self._candidates, best.ends))
            cost, objective = self._expected.unscaled(best.rank[1]), self._expected.unscaled(best.rank[0])
            bound = objective if status == "optimal" else self._expected.unscaled(self._bound[0])
        else:
            served = tuple(
                ServedGoal(c.name, c.weight, c.plan, plan_steps(c.plan), None, cost)
                for c, (_, cost) in zip(self._candidates, plans, strict=True)
            )
            cost = objective = bound = baseline
            if status != "optimal":  # net of the one epoch that every window has
                bound = min(cost, max(Fraction(0), self._lower() - self._options.window_weight))
        return Answer(
            status,
            horizon=self._horizon,
            steps=best.robots if helps and best is not None else (),
            goals=served,
            cost=cost,
            baseline=baseline,
            saving=saved(baseline, cost, opportunity=helps),
            saving_alone=saving_alone,
            objective=objective,
            lower_bound=bound,
            opportunity=helps,
            expanded=self._expanded,
            generated=self._generated,
            realised={},
        )

    def _lower(self) -> Fraction:
        return Fraction(0) if self._best is None else self._expected.unscaled(self._bound[0])

    def _served(self, candidate: Candidate, end: Ended) -> ServedGoal:
        window = Window(end.node.start, end.end) if end.end else None
        steps = path_steps(end.node) + plan_steps(end.tail, end.end)
        cost = self._keys.cost(end.key)
        return ServedGoal(candidate.name, candidate.weight, candidate.plan, steps, window, cost)


def _is_new(node: _GoalsNode, seen: dict[object, int]) -> bool:
    """Whether no robots' plan has led to the same labels for at most as much."""
    same = (node.epoch, tuple(_labels(now, node.spent) for now in node.situations))
    known = seen.get(same)
    if known is not None and known <= node.spent:
        return False
    seen[same] = node.spent
    return True


def _labels(now: Situation, spent: int) -> object:
    """What can still happen, and what it costs beside the robots' own actions."""
    return (
        None if now.follows is None else now.follows.state,
        frozenset((place, node.key - spent) for place, node in now.inside.items()),
        None if now.ended is None else now.ended.key - spent,
    )


def _robots_steps(node: _GoalsNode) -> tuple[Step, ...]:
    steps: list[Step] = []
    at: _GoalsNode | None = node
    while at is not None:
        steps.extend(Step(at.epoch, action) for action in at.robots.actions)
        at = at.parent
    return tuple(sorted(steps))
