"""The best policy over scenarios: a search of the AND-OR tree of what robots may have seen (semantics 11).

A group holds the scenarios that are not told apart after an epoch; robots choose what they do by themselves
(OR), and what the human then does splits the group (AND).  Where one scenario is left, the ordinary call
answers, unless all states beside its plan are tabulated.  Values of groups are kept between two bounds, which
are brought together depth first, most promising choice first (learning depth-first search, Bonet and Geffner
2006); scenarios one by one are a lower bound.
"""

from collections.abc import Iterable, Iterator, Sequence
from heapq import heapify, heapreplace
from operator import itemgetter
from typing import Final

from search.modes.scenarios.groups import Choice, Group
from search.modes.scenarios.lines import Guide, Question, Way, undominated
from search.modes.scenarios.measure import FOLLOWING, INFINITE_WORTH, INSIDE, OVER, Member
from search.modes.scenarios.played import Course, Played
from search.packed.joint_actions import NOTHING, JointAction

_SHARE: Final = 0.2
"""The share of the time that is left for a first look at each scenario of a group by itself."""

_TABLES: Final = 0.7
"""The same for tables of the states beside all plans."""


class PolicySearch:
    """The search for one call.

    Args:
        known: of a policy that is known; one with a first choice of its own has to be better.

    Attributes:
        root: all scenarios, before the first epoch.
    """

    def __init__(self, question: Question, known: int) -> None:
        self._lines, self._measure = question.lines, question.measure
        self._horizon, self._deadline = question.horizon, question.deadline
        self._groups: dict[tuple[int, tuple[Member, ...]], Group] = {}
        self._looked: dict[Group, int] = {}
        self.root = self._group(0, question.members)
        self.root.offer(known, None)
        self.expanded = self.generated = 0

    @property
    def lower(self) -> int:
        """No policy is worth less."""
        return self.root.lower

    @property
    def upper(self) -> int:
        """The worth of the best one known; infinite without one."""
        return self.root.upper

    def run(self) -> Iterator[None]:
        """Bring the bounds of the root together, to a limit; yield whenever they have changed much."""
        self._look(self.root)
        yield
        yield from self._probes(asks=False)
        self._tabulate()
        if not self._is_tabulated(self.root, wholly=True):
            yield from self._probes(asks=True)
        yield from self._search()

    def _tabulate(self) -> None:
        """Bound the states beside each plan, as far as a better policy may come to them."""
        members = self.root.members
        least = [line.least(m, 0) for line, m in zip(self._lines, members, strict=True)]
        deadline = self._deadline.part(_TABLES)
        for i, line in enumerate(self._lines):
            limit = self._measure.limit(members, least, i, self.root.upper)
            line.tabulate(least[i], limit, deadline.part(1 / (len(members) - i)))
        self._groups.clear()  # what came before was bounded without

    # -- groups

    def _group(self, epoch: int, members: tuple[Member, ...]) -> Group:
        known = self._groups.get((epoch, members))
        if known is None:
            rests = [self._lines[m.scenario].least(m, epoch) for m in members]
            known = self._groups[epoch, members] = Group(epoch, members, self._measure.value(members, rests))
            if epoch == self._horizon or all(m.phase == OVER for m in members):
                known.upper = known.lower
        return known

    def _look(self, group: Group, most: int = INFINITE_WORTH, share: float = 1) -> bool:
        """Bound a group by its scenarios one by one; whether only one is left, of which no more is known.

        Args:
            most: what is worth as much or more need not be told apart.
            share: of the time that is left, for one that goes on for certain.
        """
        members, epoch, single = group.members, group.epoch, len(group.members) == 1
        most = min(most, group.upper)
        if not single and self._looked.get(group, 0) >= most:
            return False
        first = group not in self._looked
        self._looked[group] = most
        if self._is_tabulated(group, wholly=single):
            self._leave_alone(group)
            return False
        deadline = self._deadline.part(_SHARE if first else share)
        least = [self._lines[m.scenario].least(m, epoch) for m in members]
        worth = INFINITE_WORTH
        for i, m in enumerate(members):
            limit = self._measure.limit(members, least, i, most)
            if limit <= least[i]:
                break
            least[i], worth = self._lines[m.scenario].certainly(m, epoch, deadline, limit, again=single)
        group.lower = max(group.lower, self._measure.value(members, least))
        if single:
            group.offer(self._measure.value(members, [worth]), None)
        else:
            self._leave_alone(group)
        return single

    def _is_tabulated(self, group: Group, *, wholly: bool) -> bool:
        """Whether all that a group may come to is bounded, without ordinary calls."""
        lines = [self._lines[m.scenario] for m in group.members if m.phase != INSIDE]
        return len(lines) == len(group.members) and all(line.is_tabulated(wholly=wholly) for line in lines)

    def _leave_alone(self, group: Group) -> None:
        """Offer that nobody in a group is helped any more, or what is known of the only one there."""
        worths = [self._alone(m, group.epoch) for m in group.members]
        group.offer(self._measure.value(group.members, worths), None)
        group.offer(self._known(group), None)

    def _known(self, group: Group) -> int:
        """What the best plan that an ordinary call has found is worth, where one scenario is left."""
        at, *others = group.members
        found = self._lines[at.scenario].certain.known(at, group.epoch)
        if found is None or others or at.phase == OVER:
            return INFINITE_WORTH
        return self._measure.value(group.members, [found.worth])

    def _alone(self, at: Member, epoch: int) -> int:
        """What a scenario is worth from here with idle robots and no window to come."""
        certain = self._lines[at.scenario].certain
        if at.phase == OVER:
            return self._lines[at.scenario].least(at, epoch)
        follows = at.phase == FOLLOWING and certain.follows(at.state, epoch)
        return certain.alone(at.state, epoch) if follows else INFINITE_WORTH

    # -- choices

    def _choices(self, group: Group) -> Iterator[Choice]:
        """All that a group may do in its next epoch, and may be worth less than its reach."""
        members, epoch = group.members, group.epoch + 1
        floors = [self._lines[m.scenario].least(m, group.epoch) for m in members]
        for robots in self._robots(group):
            each, least = list[list[tuple[int, Way]]](), [*floors]
            for i, (m, floor) in enumerate(zip(members, floors, strict=True)):
                most = self._measure.limit(members, least, i, group.reach)
                line, bounded = self._lines[m.scenario], list[tuple[int, Way]]()
                for way in line.ways(m, epoch, robots, most):
                    line.raise_floor(way, epoch, floor)
                    worth = max(floor, way.paid + line.least(way.after, epoch))
                    if worth < most:
                        bounded.append((worth, way))
                if not bounded:
                    break
                least[i] = min(bounded, key=itemgetter(0))[0]
                each.append(bounded)
            else:
                for ways in self._combined(group, undominated(self._lines, each)):
                    yield self._choice(group, robots, ways)

    def _robots(self, group: Group) -> Iterable[JointAction]:
        """What robots may begin by themselves, cheapest first."""
        if any(m.phase == OVER for m in group.members):
            return (NOTHING,)
        first = group.members[0]
        return self._lines[first.scenario].begun(first.state)

    def _combined(self, group: Group, each: Sequence[Sequence[tuple[int, Way]]]) -> Iterator[tuple[Way, ...]]:
        """A way for each scenario, as far as they may be worth less together than the reach."""
        members, measure = group.members, self._measure
        least = [ways[0][0] for ways in each]
        chosen: list[int] = []

        def extend(k: int) -> Iterator[tuple[Way, ...]]:
            self._deadline.tick()
            if measure.value(members, [*chosen, *least[k:]]) >= group.reach:
                return
            if k == len(members):
                yield ()
                return
            for bound, way in each[k]:
                chosen.append(bound)
                for rest in extend(k + 1):
                    yield (way, *rest)
                chosen.pop()

        return extend(0)

    def _choice(self, group: Group, robots: JointAction, ways: tuple[Way, ...]) -> Choice:
        """A choice, with the groups that it leads to."""
        parts: dict[tuple[str | None, object], list[Way]] = {}
        for way in ways:
            parts.setdefault(self._lines[way.after.scenario].seen(way), []).append(way)
        branches = []
        for together in parts.values():
            paid, after = self._measure.pay([w.after for w in together], [w.paid for w in together])
            branches.append((paid, self._group(group.epoch + 1, after)))
        self.generated += 1
        return Choice(robots, ways, tuple(branches))

    def _lower(self, choice: Choice) -> int:
        return self._measure.together(paid + group.lower for paid, group in choice.branches)

    def _upper(self, choice: Choice) -> int:
        return self._measure.together(paid + group.upper for paid, group in choice.branches)

    # -- policies that suggest themselves

    def _probes(self, *, asks: bool) -> Iterator[None]:
        """Value the policies that help one scenario, or nobody, as long as others are possible.

        Args:
            asks: whether by ordinary calls, or by what is known.
        """
        for scenario in (*(line.number for line in self._lines), None):
            if not self.root.is_settled:
                guide = None if scenario is None else self._guide(self.root, scenario, asks=asks)
                self._probe(self.root, guide, asks=asks)
                yield

    def _probe(self, group: Group, guide: Guide | None, *, asks: bool) -> None:
        """Value the one that follows a guide as long as its scenario is possible."""
        trail: list[tuple[Group, Choice]] = []
        pending = [(group, guide, self.root.upper)]
        try:
            while pending:
                at, followed, most = pending.pop()
                if at.lower >= min(most, at.upper):
                    continue
                if len(at.members) == 1 and asks:
                    self._look(at, most, _SHARE)
                    continue
                self._leave_alone(at)
                if followed is not None and followed.line.number not in {m.scenario for m in at.members}:
                    followed = self._guide(at, at.members[0].scenario, asks=asks)
                if followed is None and not asks:
                    continue
                choice = self._guided(at, followed)
                if choice is not None:
                    trail.append((at, choice))
                    value = self._lower(choice)
                    pending += [
                        (after, followed, self._measure.branch(most, paid, value, after.lower))
                        for paid, after in choice.branches
                    ]
        finally:
            for at, choice in reversed(trail):
                at.offer(self._upper(choice), choice)

    def _guide(self, group: Group, scenario: int, *, asks: bool) -> Guide | None:
        """The best plan for one of a group, were it the only one."""
        at = next(m for m in group.members if m.scenario == scenario)
        deadline = self._deadline.part(_SHARE) if asks else None
        return None if at.phase == OVER else self._lines[scenario].guide(at, group.epoch, deadline)

    def _guided(self, group: Group, guide: Guide | None) -> Choice | None:
        """The next epoch of a group, all but the guided one left alone; None where that is impossible."""
        epoch = group.epoch + 1
        robots, part, phase = (NOTHING, None, None) if guide is None else guide.at(epoch)
        ways = []
        for m in group.members:
            line = self._lines[m.scenario]
            is_guided = guide is not None and line is guide.line
            found = line.ways(m, epoch, robots, only=part if is_guided else None)
            if is_guided:
                wanted = (w for w in found if w.part.actions == part and w.after.phase == phase)
            else:
                wanted = (w for w in found if w.after.phase == m.phase and not w.opens)
            way = next(wanted, None)
            if way is None:
                return None
            if is_guided:
                line.learn(m, epoch, way, robots)
            ways.append(way)
        return self._choice(group, robots, tuple(ways))

    # -- the search

    def _search(self) -> Iterator[None]:
        """Look at the most promising choice of each group first, until the root is settled."""
        stack = [(self.root, INFINITE_WORTH, INFINITE_WORTH)]
        try:
            while stack:
                after = self._next(*stack[-1])
                if after is None:
                    stack.pop()
                    yield
                else:
                    stack.append(after)
        finally:
            for group, *_ in reversed(stack):
                self._raise(group)

    def _next(self, group: Group, limit: int, most: int) -> tuple[Group, int, int] | None:
        """The group to look at next for the sake of this one, and the bounds up to which that matters.

        Args:
            limit: beyond it something else is more promising.
            most: beyond it nothing is better than the policy that is known.
        """
        self._deadline.check()
        most, limit = min(most, group.upper), min(limit, most, group.upper)
        if group.lower >= limit:
            return None
        if group.choices is None and (self._look(group, most) or group.lower >= min(limit, group.upper)):
            return None
        if group.choices is None or group.lower >= group.reach:
            self.expanded += 1
            group.reach = min(most, group.upper)
            choices = [(self._lower(c), n, c) for n, c in enumerate(self._choices(group))]
            group.choices = [entry for entry in choices if entry[0] < group.reach]
            heapify(group.choices)
        self._raise(group)
        limit = min(limit, group.upper)
        if group.lower >= limit:
            return None
        if group.lower >= group.reach:
            return group, limit, most
        assert group.choices, "a group without choices is settled"
        value, _, best = group.choices[0]
        paid, after = max((b for b in best.branches if not b[1].is_settled), key=lambda b: b[0] + b[1].upper)
        second = min((entry[0] for entry in group.choices[1:3]), default=group.reach)
        most = self._measure.branch(min(most, group.upper), paid, value, after.lower)
        return after, after.lower + max(min(second, group.reach, limit) - value, 0) + 1, most

    def _raise(self, group: Group) -> None:
        """Bring the bounds of a group up to date with those of its most promising choices."""
        choices = group.choices
        if choices is None:
            return
        while choices:
            known, number, best = choices[0]
            group.offer(self._upper(best), best)
            value = self._lower(best)
            if value <= known:
                break
            heapreplace(choices, (value, number, best))
        least = min(choices[0][0], group.reach) if choices else group.reach
        group.lower = max(group.lower, min(least, group.upper))

    # -- what happens

    def played(self) -> dict[int, Played]:
        """What happens in each scenario under the best policy known."""
        root, lines = self.root, self._lines
        courses = {m.scenario: Course(lines[m.scenario].variants) for m in root.members}
        pending = [root]
        while pending:
            group = pending.pop()
            for number, at in enumerate(group.members):
                course = courses[at.scenario]
                if group.choice is None:
                    certain = self._known(group) == group.upper
                    course.finish(lines[at.scenario], at, group.epoch, certain=certain)
                else:
                    course.go_on(group.choice.ways[number], at, group.epoch + 1, group.choice.robots)
            if group.choice is not None:
                pending += [after for _, after in group.choice.branches]
        return {scenario: course.played for scenario, course in courses.items()}
