"""Search for a better robots' plan for all goals at once (semantics 8), independent of ``search``.

Two ways to a proof.  What each goal by itself would allow adds up to a bound: where the
answer reaches it, nothing is better.  Otherwise the robots' sequences are played, epoch by epoch;
beside each sequence every goal keeps all that can have happened so far, and what a goal by itself
allows, with distances in the human's automaton, cuts off what can't be better than the answer.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from serendipity.model import Step
from verify.base.execution import State, after, applicable, fits, sets_beside
from verify.base.relevance import relevant_part
from verify.base.subproblem import FREE, least
from verify.base.undecided import UndecidedError
from verify.calls.answer import best_plan
from verify.calls.call import ExaminedCall, Score
from verify.exhaustive.without_epochs import LeastLeft
from verify.limits import limits
from verify.programs.effort import Attempt

Label = tuple[int, State]
"""First epoch of the window (0: not open yet), and the state."""
Rank = tuple[Fraction, Fraction]
"""Expected objective and cost."""
Robots = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Better:
    """A robots' plan that ranks before the one asked about."""

    rank: Rank
    robots: tuple[Step, ...]


@dataclass(frozen=True, slots=True)
class _Line:
    """What can have happened so far if one goal is the human's.

    Attributes:
        labels: least (objective, cost) by window and state, while robots may still act.
        ended: the best whose window is over; robots must not act any more.
    """

    labels: dict[Label, Score]
    ended: Score | None


class _Node(NamedTuple):
    """What robots have done, what it cost them, and what can have happened beside it, goal by goal."""

    lines: tuple[_Line, ...]
    spent: int
    steps: tuple[Step, ...]


@dataclass(slots=True)
class _Incumbent:
    """The best plan so far.

    Attributes:
        than: what a plan has to rank before.
        best: the plan that does; None: none has been found.
        looked_at: number of nodes so far.
    """

    than: Rank
    best: Better | None = None
    looked_at: int = 0

    def offer(self, rank: Rank | None, robots: tuple[Step, ...]) -> None:
        """Take a plan if it is better; a rank of None: it misses a goal."""
        if rank is not None and rank < self.than:
            self.best, self.than = Better(rank, robots), rank


class AllGoals:
    """All considered goals of one answer.

    Args:
        calls: one for each goal, with the human's plan for it and the same horizon.
        weights: their probabilities; they add up to 1.
    """

    def __init__(self, calls: Sequence[ExaminedCall], weights: Sequence[Fraction]) -> None:
        self._calls = calls
        self._weights = weights
        self._units = calls[0].prices
        self._horizon = int(calls[0].horizon)
        self._floors = [_floor(call) for call in calls]
        self._left = [_left(call) for call in calls]
        robots = {
            i
            for i, action in enumerate(calls[0].task.actions)
            if calls[0].task.human not in action.participants
        }
        self._robots = sorted(robots)
        self._his = [i for i in range(len(calls[0].task.actions)) if i not in robots]

    def floor(self) -> Rank:
        """The value that no plan of the robots undercuts: the answers to each goal by itself."""
        return self._mean(self._floors)

    def idle(self) -> Rank:
        """The best with idle robots; it differs from the human's plans only if they are not optimal.

        Raises:
            UndecidedError: it could not be proved.
        """
        return self._mean([_idle(call) for call in self._calls])

    def better(self, than: Rank) -> Better | None:
        """The best robots' plan that ranks before ``than``; None: proved that there is none.

        Raises:
            UndecidedError: it takes too long, or a rule of the options is not covered.
        """
        if self.floor() >= than:
            return None
        if not all(call.question.replans for call in self._calls):
            raise UndecidedError(
                "several goals are examined under suffix replan and preservation kernel only"
            )
        return self._search(than)

    def _search(self, than: Rank) -> Better | None:
        """All robots' plans, epoch by epoch; the last one's are ranked as they come."""
        layer = [_Node(tuple(_Line({(0, call.task.init): (0, 0)}, None) for call in self._calls), 0, ())]
        incumbent = _Incumbent(than)
        if not self._horizon:
            return None
        for epoch in range(1, self._horizon):
            layer = list(self._following(layer, epoch, incumbent))
        for node in self._following(layer, self._horizon, incumbent):
            incumbent.offer(self._rank(node.lines), node.steps)
        played = Attempt("played", decided=True, states=incumbent.looked_at)
        self._calls[0].effort.attempts.append(played)
        return incumbent.best

    def _following(self, layer: Sequence[_Node], epoch: int, incumbent: _Incumbent) -> Iterator[_Node]:
        """What can come of an epoch and still rank before the incumbent; of equal lines only the cheaper.

        Raises:
            UndecidedError: there are too many robots' plans.
            LimitReachedError: the deadline came first.
        """
        deadline = self._calls[0].effort.deadline
        seen: dict[object, int] = {}
        for node in layer:
            incumbent.looked_at += 1
            deadline.check()
            if incumbent.looked_at > limits().robots_plans:
                raise UndecidedError(f"more than {limits().robots_plans} robots' plans")
            for robots in self._choices(node.lines):
                deadline.check()
                lines = self._after(node.lines, epoch, robots, incumbent.than)
                if lines is None:
                    continue
                spent = node.spent + sum(self._units.team[i] for i in robots)
                key = _key(lines, spent)
                if spent < seen.get(key, spent + 1):
                    seen[key] = spent
                    yield _Node(lines, spent, (*node.steps, *(Step(epoch, i) for i in robots)))

    def _choices(self, lines: Sequence[_Line]) -> Iterator[Robots]:
        """Sets of robots' actions that are possible on some label of the goal with the fewest."""
        fewest = min(lines, key=lambda line: len(line.labels))
        offered: dict[Robots, None] = {(): None}
        for _, state in fewest.labels:
            offered |= dict.fromkeys(self._offers(state))
        yield from offered

    def _offers(self, state: State) -> Iterator[Robots]:
        call = self._calls[0]
        deadline, actions = call.effort.deadline, call.task.actions
        candidates = [i for i in deadline.each(self._robots) if applicable(actions[i], state)]
        return sets_beside(call.task, (), candidates, deadline, strict=call.options.strict)

    def _after(
        self, lines: Sequence[_Line], epoch: int, robots: Robots, than: Rank
    ) -> tuple[_Line, ...] | None:
        """Every goal's line after an epoch; None if one has nothing left, or it can't rank before."""
        found, bounds = [], []
        for k, line in enumerate(lines):
            after = self._play(k, line, epoch, robots)
            bound = self._bound(k, after)
            if bound is None:
                return None
            found.append(after)
            bounds.append(max(bound, self._floors[k]))
        return tuple(found) if self._mean(bounds) < than else None

    def _play(self, k: int, line: _Line, epoch: int, robots: Robots) -> _Line:
        call, team = self._calls[k], self._units.team
        labels: dict[Label, Score] = {}
        ended = None if robots else line.ended
        price = sum(team[i] for i in robots)
        for (start, state), (objective, cost) in call.effort.deadline.each(line.labels.items()):
            for his, begin in self._parts(call, start, epoch):
                after = self._together(state, his, robots)
                if after is None:
                    continue
                paid = price + (0 if his is None else team[his])
                score = objective + paid + (self._units.epoch if begin else 0), cost + paid
                if begin:
                    ended = least(ended, self._closed(call, after, epoch, score))
                    if epoch + 1 - begin == call.options.max_window:
                        continue
                label = begin, after
                labels[label] = min(score, labels.get(label, score))
        return _Line(labels, ended)

    def _parts(self, call: ExaminedCall, start: int, epoch: int) -> Iterator[tuple[int | None, int]]:
        """What the human may do in an epoch, and the window's start then (rules 1 and 2)."""
        plan = call.human_plan or ()
        if not start:
            yield (plan[epoch - 1] if epoch <= len(plan) else None), 0
            if epoch > len(plan):
                return
        begin = start or epoch
        yield None, begin
        for i in self._his:
            yield i, begin

    def _together(self, state: State, his: int | None, robots: Robots) -> State | None:
        task, strict = self._calls[0].task, self._calls[0].options.strict
        chosen = [task.actions[i] for i in (*robots, *(() if his is None else (his,)))]
        if not all(applicable(action, state) for action in chosen):
            return None
        if his is not None and not fits(chosen[-1], chosen[:-1], strict=strict):
            return None
        return after(state, *chosen)

    def _closed(self, call: ExaminedCall, state: State, epoch: int, score: Score) -> Score | None:
        """Rule 3: the window ends after the epoch, and the human goes on with an optimal plan that fits."""
        worth = call.plans.worth(state)
        if worth is None or worth[1] > self._horizon - epoch:
            return None
        rest = self._units.units(worth[0])
        return score[0] + rest, score[1] + rest

    def _bound(self, k: int, line: _Line) -> Score | None:
        """The least that the goal's timeline can come to; None: nothing fits."""
        bound = line.ended
        for (start, state), (objective, cost) in line.labels.items():
            left = self._left[k](state)
            if left is None:
                continue
            wait = 0 if start else self._units.epoch
            bound = least(bound, (objective + left + wait, cost + left))
        return bound

    def _rank(self, lines: Sequence[_Line]) -> Rank | None:
        """After the last epoch."""
        ends = []
        for call, line in zip(self._calls, lines, strict=True):
            end = line.ended
            for (start, state), (objective, cost) in line.labels.items():
                if not start and call.task.goal.holds(state):
                    end = least(end, (objective + self._units.epoch, cost))
            if end is None:
                return None
            ends.append(end)
        return self._mean(ends)

    def _mean(self, scores: Sequence[Score]) -> Rank:
        pairs = list(zip(self._weights, scores, strict=True))
        objective, cost = (sum((w * s[part] for w, s in pairs), Fraction(0)) for part in (0, 1))
        return objective / self._units.scale, cost / self._units.scale


def _left_alone(call: ExaminedCall) -> Score:
    """The human's plan and idle robots; that counts as one epoch of window, whatever the plan's length."""
    assert call.baseline is not None, "only goals with a plan are considered"
    return call.baseline + call.prices.epoch, call.baseline


def _floor(call: ExaminedCall) -> Score:
    """What the goal by itself allows."""
    best = best_plan(call) if call.human_plan else None
    return _left_alone(call) if best is None else (best.objective, best.cost)


def _idle(call: ExaminedCall) -> Score:
    if call.is_optimal:
        return _left_alone(call)
    best = call.best(call.question.but(robots=False), _left_alone(call))
    return _left_alone(call) if best is None else (best.objective, best.cost)


def _left(call: ExaminedCall) -> LeastLeft:
    question = call.question.but(rule=FREE)
    part = relevant_part(question)
    assert part is not None, "only goals that he can reach are considered"
    return LeastLeft(question, part)


def _key(lines: Sequence[_Line], paid: int) -> object:
    """What can still happen, and what it costs beside what robots have spent."""
    return tuple(
        (
            frozenset((label, o - paid, c - paid) for label, (o, c) in line.labels.items()),
            None if line.ended is None else (line.ended[0] - paid, line.ended[1] - paid),
        )
        for line in lines
    )
