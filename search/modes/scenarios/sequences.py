"""The best sequence of robots that see nothing: best first, beside it each scenario by itself (semantics 11).

Given what robots do by themselves, scenarios don't depend on each other, so a node holds for each of them all
places that it may have come to, and what it has paid by then.
"""

from collections.abc import Iterable, Iterator
from heapq import heappop, heappush
from itertools import count
from operator import itemgetter
from typing import Final, NamedTuple

from search.modes.scenarios.lines import Question, Way
from search.modes.scenarios.measure import INFINITE_WORTH, OVER, Member
from search.modes.scenarios.played import Course, Played
from search.packed.joint_actions import NOTHING, JointAction
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.plans import Step


class _Label(NamedTuple):
    """A place of a scenario, and how it came there.

    Attributes:
        paid: so far.
        way: of the last epoch; None before the first.
        before: the place before it, and its label.
    """

    paid: int
    way: Way | None = None
    before: "tuple[Member, _Label] | None" = None


_SHARE: Final = 0.8
"""The share of the time that is left for the scenarios one by one, and one more of them."""

_OFFER: Final = 0.1
"""The same for what is best beside one sequence."""

_NONE: Final = _Label(INFINITE_WORTH)
_Places = dict[Member, _Label]


class _Sequence(NamedTuple):
    """What robots do by themselves up to an epoch, what that is worth, and where it leaves each scenario."""

    epoch: int
    places: tuple[_Places, ...]
    steps: tuple[Step, ...]
    spent: int


class SequenceSearch:
    """The search for one call.

    Attributes:
        lower: no sequence is worth less.
        upper: of the best one known, or of leaving everybody alone.
    """

    def __init__(self, question: Question) -> None:
        self._question = question
        self._lines, self._horizon, self._deadline = question.lines, question.horizon, question.deadline
        self._floors = [line.least(m, 0) for line, m in zip(self._lines, question.members, strict=True)]
        self._best: _Sequence | None = None
        self.lower = 0
        self.upper = question.value([line.certain.alone(line.first().state, 0) for line in self._lines])
        self.expanded = self.generated = 0

    def guided(self) -> Iterator[None]:
        """Try what is best for each scenario, and idle robots; yield after each.  Bounds hold at a limit."""
        for i, line in enumerate(self._lines):
            deadline = self._deadline.part(_SHARE / (len(self._lines) - i + 1))
            self._floors[i], _ = line.certainly(line.first(), 0, deadline)
            self.lower = max(self.lower, self._question.value(self._floors))
            guide = line.guide(line.first(), 0, deadline)
            if guide is not None:
                epochs = range(1, self._horizon + 1)
                self._offer({epoch: guide.at(epoch)[0] for epoch in epochs})
            yield
        self._offer({})
        yield

    def _offer(self, robots: dict[int, JointAction]) -> None:
        """Play a sequence against every scenario, if there is time."""
        deadline = self._deadline.part(_OFFER)
        try:
            places = tuple(self._best_beside(i, robots, deadline) for i in range(len(self._lines)))
        except LimitReachedError:
            self._deadline.check()
            return
        if all(places):
            steps = tuple(Step(epoch, action) for epoch, done in robots.items() for action in done.actions)
            self._complete(_Sequence(self._horizon, places, steps, 0))

    def _best_beside(self, number: int, robots: dict[int, JointAction], deadline: Deadline) -> _Places:
        """Where the best that a scenario can do beside a sequence leads to; nowhere, if it is too dear."""
        line, tie = self._lines[number], count()
        limit, first = self._limit(number), line.first()
        last = max((epoch for epoch, done in robots.items() if done.actions), default=0)
        queue = [(line.least(first, 0), 0, next(tie), first, _Label(0))]
        paid = {(0, first): 0}
        while queue:
            _, late, _, at, label = heappop(queue)
            if at.phase == OVER or -late == self._horizon:
                return {at: label}
            epoch = 1 - late
            for way in line.ways(at, epoch, robots.get(epoch, NOTHING), limit - label.paid):
                deadline.tick()
                spent, place = label.paid + way.paid, (epoch, way.after)
                total = spent + line.least(way.after, epoch)
                is_idle_then = way.after.phase != OVER or epoch >= last
                if is_idle_then and total < limit and spent < paid.get(place, INFINITE_WORTH):
                    paid[place] = spent
                    heappush(queue, (total, -epoch, next(tie), way.after, _Label(spent, way, (at, label))))
        return {}

    def _limit(self, number: int) -> int:
        """What a scenario pays at which a sequence is no better than the best one known."""
        return self._question.measure.limit(self._question.members, self._floors, number, self.upper)

    def run(self) -> Iterator[None]:
        """Look for better sequences until there are none; yield for each; see :meth:`guided`."""
        tie, seen = count(), dict[object, int]()
        root = _Sequence(0, tuple({line.first(): _Label(0)} for line in self._lines), (), 0)
        queue = [(self._bound(root), 0, next(tie), root)]
        while queue and queue[0][0] < self.upper:
            least, _, _, node = heappop(queue)
            self.lower = max(self.lower, least)
            self._deadline.check()
            self.expanded += 1
            for robots in self._choices(node):
                child = self._child(node, robots)
                if child is None or not _is_new(child, seen):
                    continue
                bound = self._bound(child)
                if bound >= self.upper:
                    continue
                if child.epoch == self._horizon:
                    self._complete(child)
                    yield
                else:
                    heappush(queue, (bound, -child.epoch, next(tie), child))
        self.lower = self.upper

    def _choices(self, node: _Sequence) -> Iterable[JointAction]:
        """Robots' action sets that are possible in some place of the scenario with the fewest."""
        line, fewest = min(zip(self._lines, node.places, strict=True), key=lambda pair: len(pair[1]))
        offered: dict[tuple[int, ...], JointAction] = {(): NOTHING}
        for state in sorted({m.state for m in fewest if m.phase != OVER}):
            for option in line.begun(state):
                offered.setdefault(option.actions, option)
        return offered.values()

    def _child(self, node: _Sequence, robots: JointAction) -> _Sequence | None:
        """The sequence an epoch later; None if some scenario has no place left."""
        epoch, after = node.epoch + 1, []
        self.generated += 1
        for i, line in enumerate(self._lines):
            places: _Places = {}
            ended: list[tuple[int, Member, _Label]] = []
            limit = self._limit(i)
            for m, label in node.places[i].items():
                self._deadline.tick()
                if m.phase == OVER:  # the suffix goes on, as long as robots are idle
                    if not robots.actions:
                        ended.append((label.paid + line.least(m, epoch), m, label))
                    continue
                for way in line.ways(m, epoch, robots, limit - label.paid):
                    paid = label.paid + way.paid
                    total, found = paid + line.least(way.after, epoch), _Label(paid, way, (m, label))
                    if way.after.phase == OVER:
                        ended.append((total, way.after, found))
                    elif total < limit and paid < places.get(way.after, _NONE).paid:
                        places[way.after] = found
            if ended:  # it is known what is left, so one of them is best
                total, m, label = min(ended, key=itemgetter(0))
                if total < limit:
                    places[m] = label
            if not places:
                return None
            after.append(places)
        steps = (*node.steps, *(Step(epoch, action) for action in robots.actions))
        return _Sequence(epoch, tuple(after), steps, node.spent + self._lines[0].worth(robots))

    def _bound(self, node: _Sequence) -> int:
        totals = [
            max(floor, min(label.paid + line.least(m, node.epoch) for m, label in places.items()))
            for floor, line, places in zip(self._floors, self._lines, node.places, strict=True)
        ]
        return self._question.value(totals)

    def _complete(self, node: _Sequence) -> None:
        value = self._bound(node)
        if value < self.upper:
            self.upper, self._best = value, node

    # -- what happens

    def played(self) -> dict[int, Played]:
        """What happens in each scenario beside the best sequence known."""
        found, best = {}, self._best
        for line in self._lines:
            course, at, epoch = Course(line.variants), line.first(), 0
            if best is not None:
                places, ways = best.places[line.number], list[tuple[Member, Way]]()
                at = min(places, key=lambda m: places[m].paid + line.least(m, self._horizon))
                label = places[at]
                while label.before is not None and label.way is not None:
                    ways.append((label.before[0], label.way))
                    label = label.before[1]
                for number, (m, way) in enumerate(reversed(ways), start=1):
                    course.go_on(way, m, number)
                course.steps += best.steps
                epoch = self._horizon - (0 if at.tail is None else at.tail.left)
            course.finish(line, at, epoch, certain=False)
            found[line.number] = course.played
        return found


def _is_new(node: _Sequence, seen: dict[object, int]) -> bool:
    """Whether no sequence has led to the same places for at most as much."""
    labels = (frozenset((m, label.paid - node.spent) for m, label in p.items()) for p in node.places)
    same = (node.epoch, tuple(labels))
    known = seen.get(same)
    if known is not None and known <= node.spent:
        return False
    seen[same] = node.spent
    return True
