"""The best that happens with a human who replans (semantics 6): all that could cost less is played.

Layer by layer over the epochs, the robots try every set of actions that may share an epoch,
and the verifier's simulator says what comes of it.  Two things keep it small: nothing is
played on that must cost more than what is asked for, by distances in the human's automaton;
and of equal states and minds only the cheapest is played on (an earlier one at the same cost is no
worse, since robots can do the same from it, only sooner).
"""

from collections.abc import Iterable, Iterator

from serendipity.model import Step
from serendipity.model.errors import LIMITS
from verify.base.execution import State, applicable, grouped, sets_beside, unchosen
from verify.base.relevance import relevant_part
from verify.base.subproblem import FREE, PricedPlan
from verify.base.undecided import during, why
from verify.calls.call import ExaminedCall
from verify.certificate.simulator import LocalSight, MomentOfPlay, Play
from verify.exhaustive.without_epochs import LeastLeft
from verify.limits import limits
from verify.programs.effort import Attempt, Minimum


def cheapest_reaction(call: ExaminedCall, most: int | None) -> Minimum:
    """The cheapest plan that happens under the options' human model."""
    with during("preparing to play what robots can do"):
        question = call.question.but(rule=FREE).below(most)
        part = relevant_part(question)
        if part is None:
            return Minimum("none")
        played = _Reactions(call, LeastLeft(question, part), question.most, question.most_cost)
    return played.run()


class _Reactions:
    def __init__(self, call: ExaminedCall, left: LeastLeft, *limits: int | None) -> None:
        task, options = call.task, call.options
        self.call = call
        self.deadline = call.effort.deadline
        sight = LocalSight(task, None, self.deadline.tick) if options.human_model == "local" else None
        self.game = Play(task, options, call.plans, sight)
        self.left = left
        self.most = min((limit for limit in limits if limit is not None), default=None)
        self.may_block = options.no_block is False
        self.epoch_of_waiting = call.prices.units(options.waiting_cost)
        self.known: dict[MomentOfPlay, int] = {}
        self.before: dict[tuple[int, MomentOfPlay], tuple[MomentOfPlay, tuple[int, ...]]] = {}
        going_on, every = unchosen(task), enumerate(self.deadline.each(task.actions))
        theirs = ((i, a) for i, a in every if i not in going_on and a.participants != (task.human,))
        self.offered = grouped((min(action.pre, default=-1), i) for i, action in theirs)

    def run(self) -> Minimum:
        """Play the layers until nothing is left that could cost less."""
        try:
            found = self._run()
        except LIMITS as limit:
            doing = f"playing what robots can do, {len(self.known):,} states and minds so far"
            return Minimum("undecided", reason=why(limit, doing))
        decided = found.status != "undecided"
        self.call.effort.attempts.append(Attempt("played", decided, states=len(self.known)))
        return found

    def _run(self) -> Minimum:
        start = self.game.start(self.call.human_plan or ())
        if self.game.done(start):
            affordable = self.most is None or self.most >= 0
            return Minimum("found", PricedPlan((), None, 0, 0), 0) if affordable else Minimum("none")
        self.known[start] = 0
        best: PricedPlan | None = None
        layer = {start: 0}
        for epoch in range(1, self.call.question.horizon + 1):
            following: dict[MomentOfPlay, int] = {}
            for now, spent in layer.items():
                if len(self.known) > limits().moments:
                    return Minimum("undecided", best, reason=f"more than {limits().moments} states and minds")
                for after, total in self._play(epoch, now, spent):
                    if self.game.done(after):
                        best = PricedPlan(tuple(self._steps(epoch, after)), None, total, total)
                        self.most = total - 1
                    else:
                        self.known[after] = total
                        following[after] = total
            layer = following
        return Minimum("none") if best is None else Minimum("found", best, best.cost)

    def _play(self, epoch: int, now: MomentOfPlay, spent: int) -> Iterator[tuple[MomentOfPlay, int]]:
        """What can come of an epoch, where it is worth going on, with the cost so far."""
        look, team = self.game.look(now), self.call.prices.team
        for offers in self._offers(now.state):
            self.deadline.tick()
            deed, after = self.game.act(look, offers)
            if deed.skipped or (deed.blocks and not self.may_block):
                continue  # without what is skipped the set is tried, too
            if self.game.sight is None:
                after = after._replace(belief=after.state)
            total = spent + sum(team[i] for i in deed.executed) + deed.waited * self.epoch_of_waiting
            left = self.left(after.state)
            if left is None or (self.most is not None and total + left > self.most):
                continue
            if total < self.known.get(after, total + 1):
                self.before[epoch, after] = now, deed.executed
                yield after, total

    def _offers(self, state: State) -> Iterator[tuple[int, ...]]:
        """All sets of actions that may share the next epoch, the empty one first."""
        task = self.call.task
        found = (i for f in (-1, *state) for i in self.offered.get(f, ()))
        candidates = [i for i in self.deadline.each(found) if applicable(task.actions[i], state)]
        return sets_beside(task, (), candidates, self.deadline, strict=self.call.options.strict)

    def _steps(self, epoch: int, moment: MomentOfPlay) -> Iterable[Step]:
        steps = []
        for t in range(epoch, 0, -1):
            moment, executed = self.before[t, moment]
            steps += [Step(t, i) for i in executed]
        return sorted(steps)
