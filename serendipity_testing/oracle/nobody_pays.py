"""The rule that nobody pays, and that little is left behind, by brute force (semantics 12)."""

from fractions import Fraction

from serendipity.model import Condition, HumanPlan, Options, Task
from serendipity.model.task.leftovers import leftovers
from serendipity_testing.oracle.epochs import State, after, holds, usable
from serendipity_testing.oracle.moments import Going, Moment, OracleWorld


def counts_everybody(task: Task, options: Options) -> bool:
    """Whether nobody may pay for help."""
    return bool(task.script.people) if options.nobody_pays is None else options.nobody_pays


class LastMomentRule:
    """What a last moment has to be like.

    Args:
        world: of the task.
        options: in force.
        plan: the human's, or None without one.
        last: ``T``.
    """

    def __init__(self, world: OracleWorld, options: Options, plan: HumanPlan | None, last: int) -> None:
        self._world, self._task, self._last = world, world.task, last
        self._goals = dict(self._task.own_goals)
        idle = _idle(world, plan or (), last)
        self._variants: dict[int, int] = {}
        self._served = frozenset[int]()
        self._kept: dict[int, bool] = {}
        self._prices: dict[int, tuple[bool, Fraction]] = {}
        if idle is not None and counts_everybody(self._task, options):
            self._served = self._serves(idle)
        rest = leftovers(options)
        if idle is None or rest is None:
            return
        for fact, price in enumerate(rest.prices(self._task.facts)):
            if price is None:
                self._kept[fact] = fact in idle.state
            elif price:
                self._prices[fact] = (fact in idle.state, price)

    def keeps(self, end: Moment) -> bool:
        """Whether everybody is served who would be without help, and nothing else is left changed."""
        same = all((fact in end.state) is true for fact, true in self._kept.items())
        return same and self._served <= self._serves(end)

    def price(self, end: Moment) -> Fraction:
        """What is to be paid for what is left changed."""
        changed = (price for fact, (true, price) in self._prices.items() if (fact in end.state) is not true)
        return sum(changed, Fraction(0))

    def _serves(self, end: Moment) -> frozenset[int]:
        """The bystanders who can do the rest of their plans after a moment, and reach what they want.

        What each does is what they would without help, and all others do as they planned, too.
        """
        people = self._task.script.people
        ends = dict.fromkeys(people, self._last)
        for deed in self._task.script.deeds:
            if deed.agent in people:
                ends[deed.agent] = max(ends[deed.agent], deed.end)
        served, state, going = set(people), end.state, end.going
        for epoch in range(self._last, self._world.settled + 1):
            if epoch > self._last:
                state, going, disturbed = self._onward(state, going, epoch)
                served -= disturbed
            served -= {
                agent
                for agent, at in ends.items()
                if at == epoch and not holds(self._goals.get(agent, Condition()), state)
            }
        if self._last > self._world.settled:
            wants = {agent: self._goals.get(agent, Condition()) for agent in people}
            served = {agent for agent, goal in wants.items() if holds(goal, state)}
        return frozenset(served)

    def _onward(self, state: State, going: Going, epoch: int) -> tuple[State, Going, set[int]]:
        """An epoch in which everybody does as planned; and who can't."""
        world, script, disturbed = self._world, self._task.script, set[int]()
        happening = [*going]
        for number, deed in enumerate(script.deeds):
            if deed.epoch == epoch:
                if number not in self._variants:
                    ids = [world.number(action) for action in deed.variants]
                    possible = (i for i in ids if usable(world.parts(i)[0], state))
                    self._variants[number] = next(possible, ids[0])
                happening.append((self._variants[number], 0))
        parts = [world.parts(i)[k] for i, k in happening]
        for part in parts:
            if not usable(part, state):
                disturbed |= {*part.participants}
        state = after(state, parts)
        for change in script.facts:
            if change.epoch == epoch:
                state = state | {change.fact} if change.true else state - {change.fact}
        left = ((i, k + 1) for i, k in happening if k + 1 < len(world.parts(i)))
        return state, tuple(sorted(left)), disturbed


def unpriced(options: Options) -> Options:
    """The options by which nothing is paid for what is left: what people do alone is not priced."""
    rest = leftovers(options)
    free = ", ".join(f"{pattern}=0" for pattern, _ in rest.priced) if rest is not None else ""
    return options.but(leave_price=free or None)


def is_ruled(task: Task, options: Options) -> bool:
    """Whether a rule of help is in force."""
    asked = options.noticed or options.max_disturbance is not None or leftovers(options) is not None
    return asked or counts_everybody(task, options)


def unruled(options: Options) -> Options:
    """The options by which help keeps no rule."""
    return options.but(
        nobody_pays=False,
        leave_free=None,
        leave_price=None,
        noticed=False,
        max_disturbance=None,
        disturbance=None,
    )


def _idle(world: OracleWorld, plan: HumanPlan, last: int) -> Moment | None:
    """The moment after ``T`` if the human follows a plan, and robots do nothing; None if that can't be."""
    begun = dict(zip(world.task.starts_of(plan), plan, strict=True))
    now: Moment | None = Moment(world.task.init)
    for epoch in range(1, last + 1):
        now = None if now is None else world.alone(now, epoch, begun.get(epoch))
    return now
