"""The best help beside each of the human's optimal plans, for all of them at once (semantics 3.1, ``ties``).

The plans share what can be shared.  In the prefix, what robots can have brought about by an epoch is the
same for all plans that lead there on ways that made no difference to it; such plans are one *strand*.  Once
a window is open, ``pi_H`` plays no part any more: what a state is still worth is worked out once for each
epoch, from the last one backwards, whichever plans lead to it.  So the work grows with states and strands,
where one plan after another would take the number of plans, which may be exponential in both.

Scores are one number each: ``objective * base + cost`` with a base that no cost reaches, so that the least is
the least objective and, of these, the least cost.
"""

from collections import Counter
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np

from serendipity.model import HumanPlan
from verify.base.execution import facts_of_his
from verify.base.optimal_plans import OptimalPlans
from verify.base.plan_graph import OptimalPlanGraph
from verify.base.relevance import Relevant, relevant_part
from verify.base.subproblem import Subproblem
from verify.base.undecided import during
from verify.exhaustive.epoch_by_epoch import OtherMethodError
from verify.exhaustive.team import TeamEpochs
from verify.exhaustive.team_problem import team_problem
from verify.limits import limits
from verify.packed.layout import Ints, Words
from verify.packed.least_paid import LeastPaid
from verify.packed.operators import FAR, OperatorTable
from verify.packed.problem import TooLargeError

Score = tuple[int, int]
"""Objective and cost, in units."""

_NEVER: Final = int(FAR)
_NONE: Final = np.zeros(0, np.int64)


def answers_all(question: Subproblem) -> bool:
    """True if the method knows a question's rules."""
    longest = question.options.max_window
    whole = longest is None or longest >= question.horizon
    unlimited = question.most_cost is None and not any(question.prices.talk)
    return question.has_plain_windows and whole and unlimited


class TeamStates(NamedTuple):
    """Different states of the team, and what was paid for each."""

    states: Words
    paid: Ints


@dataclass(slots=True)
class _Strand:
    """Prefixes of plans that lead to one state of the human's, beside which robots can do the same.

    Attributes:
        node: the state's number in the graph of plans.
        front: what robots can have brought about.
        best: the least score of a window that opens here.
        moves: by action, the strand that goes on; empty in the last epoch.
    """

    node: int
    front: TeamStates
    best: int = _NEVER
    moves: dict[int, int] = field(default_factory=dict)


class HelpBesidePlans:
    """The best help in a window beside every optimal plan of the human.

    Args:
        question: of one of the plans; which one does not matter.
        bounded: whether lower bounds spare the search states.

    Attributes:
        states: how many were looked at.
        scores: the number of plans by the best score beside them that undercuts leaving the human alone;
            None where nothing does.
    """

    def __init__(
        self, question: Subproblem, graph: OptimalPlanGraph, plans: OptimalPlans, *, bounded: bool
    ) -> None:
        if not answers_all(question):
            raise OtherMethodError("not all optimal plans can be searched beside at once")
        with during("preparing a search beside all optimal plans"):
            part = relevant_part(question)
            if part is None or len(part.actions) > limits().compared_actions:
                raise OtherMethodError(
                    f"the exhaustive method takes {limits().compared_actions} actions at most"
                )
            try:
                self._prepare(question, part, bounded=bounded)
            except TooLargeError:
                raise OtherMethodError("the task is too large for the exhaustive method") from None
        self._graph, self._plans = graph, plans
        self.states = 0
        with during("searching beside all optimal plans"):
            self._strands: list[list[_Strand]] = []
            self._openings: list[TeamStates] = []
            self._prefixes()
            self._value()
        self.scores = self._counted()

    def _prepare(self, question: Subproblem, part: Relevant, *, bounded: bool) -> None:
        self._question, self._deadline = question, question.deadline
        team = team_problem(question, part, bounded=bounded)
        self._problem, self._start = team.problem, team.start
        self._layout = self._problem.layout
        table = OperatorTable(self._layout, team.singles)
        strict = question.options.strict
        self._team = TeamEpochs(question.task, part.actions, table, self._deadline, strict=strict)
        self._numbers = {i: k for k, i in enumerate(part.actions)}
        alone = sum(question.prices.team[i] for i in question.human_plan)
        epoch = question.prices.epoch
        self._base = alone + epoch + 1
        self._unit = self._base + 1
        self._epoch = epoch * self._base
        self._limit = (alone + epoch) * self._base + alone
        own = [f for f in facts_of_his(question.task, self._deadline) if f in self._layout.place]
        self._mask = np.zeros(self._layout.words, np.uint64)
        for number in {self._layout.place[f].field for f in own}:
            of_his = self._layout.fields[number]
            self._mask[of_his.word] |= np.uint64(of_his.mask)
        self._constant = question.task.init - self._layout.place.keys()
        if self._limit + question.horizon * question.an_epoch * self._unit > limits().weight:
            raise TooLargeError

    # -- prefixes

    def _prefixes(self) -> None:
        """All strands, epoch by epoch, and the states that windows open in."""
        strands = [_Strand(0, TeamStates(self._start, np.zeros(1, np.int64)))]
        for epoch in range(len(self._graph)):
            self._strands.append(strands)
            self._openings.append(self._merged([strand.front for strand in strands]))
            if epoch + 1 < len(self._graph):
                strands = self._following(strands, epoch)

    def _following(self, strands: list[_Strand], epoch: int) -> list[_Strand]:
        known: dict[object, int] = {}
        following: list[_Strand] = []
        for strand in strands:
            for action, node in self._graph.moves[epoch][strand.node]:
                front = self._beside(strand.front, action)
                key = node, front.states.tobytes(), front.paid.tobytes()
                if key not in known:
                    known[key] = len(following)
                    following.append(_Strand(node, front))
                strand.moves[action] = known[key]
        return following

    def _beside(self, front: TeamStates, action: int) -> TeamStates:
        """The states, in order, that robots can have brought about when the human has done one more step."""
        self._deadline.check()
        if not len(front.states):
            return front
        if action not in self._numbers:
            raise OtherMethodError("an optimal plan has an action that has no bearing on its goal")
        his = np.array([self._numbers[action]], np.int64)
        pieces = self._team.steps(front.states, his, wait=False)
        after = [
            TeamStates(piece.after, front.paid[piece.before] + piece.cost * self._unit) for piece in pieces
        ]
        merged = self._hopeful(self._merged(after), self._epoch)
        order = np.lexsort(merged.states.T)
        return TeamStates(merged.states[order], merged.paid[order])

    # -- windows

    def _inside(self, before: list[TeamStates]) -> TeamStates:
        """The states after one more epoch of windows."""
        after = []
        for front in before:
            for piece in self._team.steps(front.states):
                paid = front.paid[piece.before] + piece.cost * self._unit + self._epoch
                after.append(self._hopeful(TeamStates(piece.after, paid), 0))
        return self._merged(after)

    def _merged(self, fronts: list[TeamStates]) -> TeamStates:
        """Each state once, at its least price."""
        known = self._table(fronts)
        self.states += len(known.paid)
        return TeamStates(known.states.copy(), known.paid)

    def _table(self, fronts: list[TeamStates]) -> LeastPaid:
        """The same, to be looked up by state."""
        known = LeastPaid(self._layout.words, self._deadline)
        for front in fronts:
            known.offer(front.states, front.paid)
        return known

    def _hopeful(self, front: TeamStates, rest: int) -> TeamStates:
        """The states that may still lead to a score within the limit; ``rest`` has to be paid in any case."""
        most = self._limit // self._unit + 1  # more than that is too much
        left = np.minimum(self._problem.bounds(front.states), most)
        total = front.paid + left * self._unit + rest
        kept = total < self._limit
        return TeamStates(front.states[kept], front.paid[kept])

    def _value(self) -> None:
        """The worth of each state in which a window may open, from the last epoch backwards."""
        horizon, nobody = (
            self._question.horizon,
            TeamStates(np.zeros((0, self._layout.words), np.uint64), _NONE),
        )
        inside = [nobody]
        for epoch in range(1, horizon + 1):
            openings = self._openings[epoch - 1 : epoch]
            inside.append(self._inside([front for front in (*openings, inside[-1]) if len(front.states)]))
        worth = nobody.paid
        for epoch in range(horizon, 0, -1):
            front = inside[epoch]
            ended = self._ended(front.states, horizon - epoch)
            if epoch < horizon:
                ended = np.minimum(ended, self._onward(front.states, inside[epoch + 1], worth))
            worth = ended
            if epoch <= len(self._openings):
                opening = self._openings[epoch - 1]
                self._open(self._strands[epoch - 1], opening, self._onward(opening.states, front, worth))

    def _onward(self, states: Words, following: TeamStates, worth: Ints) -> Ints:
        """The least score of one more epoch of the window and what follows."""
        known = self._table([TeamStates(following.states, worth)])
        least = np.full(len(states), FAR)
        for piece in self._team.steps(states):
            rest = known.of(piece.after)
            reached = rest < FAR
            total = rest[reached] + piece.cost[reached] * self._unit + self._epoch
            np.minimum.at(least, piece.before[reached], total)
        return least

    def _ended(self, states: Words, left: int) -> Ints:
        """The score of the human's own optimal plan, where the window is over and it fits."""
        found = np.full(len(states), FAR)
        own, of = np.unique(states & self._mask, axis=0, return_inverse=True)
        for number, row in enumerate(self._deadline.each(list(own))):
            worth = self._plans.alone.optimum(self._layout.facts_of(row) | self._constant)
            paid = None if worth is None or worth[1] > left else self._question.prices.units(worth[0])
            if paid is not None and paid < self._base:  # else it is beyond the limit
                found[of.ravel() == number] = paid * self._unit
        return found

    def _open(self, strands: list[_Strand], opening: TeamStates, worth: Ints) -> None:
        """The worth of windows that open now, beside each strand."""
        known = self._table([TeamStates(opening.states, worth)])
        for strand in strands:
            if len(strand.front.states):
                rest = known.of(strand.front.states)
                total = np.where(rest < FAR, rest + strand.front.paid, FAR)
                strand.best = int(total.min())

    # -- plans

    def beside(self, plan: HumanPlan) -> Score | None:
        """The best score beside an optimal plan; None where nothing undercuts leaving the human alone."""
        best, number = _NEVER, 0
        for strands, action in zip(self._strands, plan, strict=True):
            strand = strands[number]
            best = min(best, strand.best)
            number = strand.moves.get(action, 0)
        return self._score(best)

    def _counted(self) -> Counter[Score | None]:
        """The plans, counted by their scores: along the strands, with the best so far."""
        counts: dict[int, Counter[int]] = {0: Counter({_NEVER: 1})}
        for epoch, strands in enumerate(self._strands):
            after: dict[int, Counter[int]] = {}
            for number, ways in counts.items():
                strand = strands[number]
                best: Counter[int] = Counter()
                for score, count in ways.items():
                    best[min(score, strand.best)] += count
                for action, _ in self._graph.moves[epoch][strand.node]:
                    after.setdefault(strand.moves.get(action, 0), Counter()).update(best)
            counts = after
        found: Counter[Score | None] = Counter()
        for ways in counts.values():
            for score, count in ways.items():
                found[self._score(score)] += count
        return found

    def _score(self, score: int) -> Score | None:
        return divmod(score, self._base) if score < self._limit else None
