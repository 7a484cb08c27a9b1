"""What it costs robots, at least, to provide what a touch needs.

One outside field is looked at together with the place of one robot at a time:
the robot that is *tracked*.  It walks (ops on its place), it acts on the field,
and where the next op on the field has other actors, tracking passes on: to a
robot that takes part in both ops, from where the first one left it, or, where
there is none, to any robot, anywhere, for nothing.  All other conditions are
dropped, so distances are admissible for any number of robots that relay.

Glossary: *place* - the value of the field that most of a robot's own ops ask
for; *label* - value of the field, team of the last op on it (0 at the start).
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from heapq import heappop, heappush
from typing import TypeVar

from search.backward import backward
from search.clock import Clock
from search.encoding import Encoding
from search.keys import INFINITE_KEY
from search.ops import Form, Op, forms_of, set_by, split
from search.touches import Need

Spot = tuple[int, int, int, int]
"""Value of the field, team of the last op on it, tracked robot's bit, its place.
Robot 0 stands for "any robot that did not take part in the last op"."""

Item = TypeVar("Item")

Edge = tuple[int, Spot]
"""Weight, and where it leads (or, backward, where it came from)."""


class Places:
    """The place field of each robot, and what moves it; kept with the packed task.

    Attributes:
        field: per robot's bit its place field, 0 where it has none.
        moves: per robot and place, -1 for anywhere, what sets its place: the place, and the op.
        walks: the same with the index of the op's cost.
    """

    def __init__(self, encoding: Encoding, clock: Clock) -> None:
        self.field: dict[int, int] = {}
        self.moves: dict[int, dict[int, list[tuple[int, Op]]]] = {}
        forms = (*encoding.own_forms, *encoding.joint_forms, *encoding.other_forms)
        for robot in encoding.task.robots:
            bit = 1 << robot
            mine = [form for form in encoding.other_forms if form.agents & bit]
            foreign = set_by(form for form in forms if not form.agents & bit)
            private = set_by(mine) & ~foreign
            counts = {
                field: sum(len(form.ops) for form in mine if form.need_mask & field)
                for field in encoding.fields
                if field & private
            }
            field = max(counts, key=lambda f: counts[f], default=0)
            self.field[bit] = field
            moves: dict[int, list[tuple[int, Op]]] = {}
            for form in mine:
                if not field & form.sets:
                    continue
                # Without a condition on the place it can be done from anywhere: key -1.
                anywhere = not form.need_mask & field
                for op in form.ops:
                    clock.tick()
                    moves.setdefault(-1 if anywhere else op.need & field, []).append((op.put & field, op))
            self.moves[bit] = moves
        self.walks = {bit: _walks(moves, frozenset()) for bit, moves in self.moves.items()}


class Acts:
    """Robots' ops as one outside field sees them; kept with the packed task.

    Attributes:
        walks: per robot and place what leads elsewhere without mentioning the field: the
            place, and the index of the cost.  Walks that are possible anywhere stand under -1.
    """

    def __init__(self, field: int, forms: Sequence[Form], places: Places) -> None:
        self._on = _by_value(field, forms)
        self._places = places.field
        self._here: dict[tuple[int, int], dict[int, list[Op]]] = {}
        self.walks = places.walks
        if any(
            form.agents & bit and form.sets & place for form in forms for bit, place in self._places.items()
        ):
            mentioning = {op.action for form in forms for op in form.ops}
            self.walks = {robot: _walks(moves, mentioning) for robot, moves in places.moves.items()}

    def on(self, value: int) -> list[Op]:
        """What robots can do to a value of the field."""
        return _with_anything(self._on, value)

    def from_place(self, robot: int, place: int) -> list[tuple[int, int]]:
        """Where a robot can walk from a place, with the index of the cost."""
        return _with_anything(self.walks[robot], place)

    def by_place(self, value: int, robot: int) -> dict[int, list[Op]]:
        """What a robot can do to a value of the field, by its place (-1: anywhere)."""
        found = self._here.get((value, robot))
        if found is None:
            found = self._here[value, robot] = {}
            place = self._places[robot]
            for op in self.on(value):
                if op.agents & robot:
                    found.setdefault(op.need & place if op.need_mask & place else -1, []).append(op)
        return found


class AllActs:
    """:class:`Acts` by field, made when first asked for; kept with the packed task."""

    def __init__(self, encoding: Encoding, clock: Clock) -> None:
        self._encoding = encoding
        self._places = encoding.derived(Places, clock)
        self._mentioning: dict[int, list[Form]] = {}
        by_lowest_bit = {field & -field: field for field in encoding.fields}
        for form in encoding.other_forms:
            for field in split(form.mentions, by_lowest_bit):
                self._mentioning.setdefault(field, []).append(form)
        self._known: dict[int, Acts] = {}

    def on(self, field: int) -> Acts:
        """What robots' ops are to a field."""
        if field not in self._known:
            forms = self._mentioning.get(field, ())
            self._known[field] = Acts(field, forms, self._places)
        return self._known[field]


class Provision:
    """Distances in the automaton of one outside field.

    Args:
        encoding: the packed task.
        field: the outside field.
        needs: ids of the needs that are judged by this field, with the needs.
        weights: key increment of a robots' op by the index of its cost.
        flips: ops of the human that may change the field on his way, for nothing.
        clock: asked for time.
    """

    def __init__(
        self,
        encoding: Encoding,
        field: int,
        needs: Sequence[tuple[int, Need]],
        weights: Sequence[int],
        flips: Iterable[Op],
        clock: Clock,
    ) -> None:
        self._places = encoding.derived(Places, clock)
        self._field = field
        self._weights = weights
        self._clock = clock
        self._initial = encoding.init
        self._encoding = encoding
        self._acts = encoding.derived(AllActs, clock).on(field)
        changing = (op for op in flips if field & ~op.keep)
        self._flips = _by_value(field, forms_of(changing, encoding.all_ones, clock))
        self._anyhow: dict[int, list[int]] = {}
        self._at_place: dict[tuple[int, int], dict[int, list[int]]] = {}
        self._detached: dict[int, list[tuple[int, int]]] = {}
        for i, need in needs:
            self._index(i, need)
        self._entries: dict[Spot, list[Edge]] = {}
        self._accepted: dict[int, list[Spot]] = {}
        self._stopped: set[tuple[int, int, int]] = set()
        self.cost: dict[int, int] = {}

    def explore(self, pays: Callable[[int], bool]) -> None:
        """Forward from the initial state, as long as the cost pays; fills ``cost`` per need id."""
        levels: dict[int, list[Spot]] = {0: []}
        value = self._initial & self._field
        for robot, place in self._places.field.items():
            levels[0].append((value, 0, robot, self._initial & place))
        queue = [0]
        settled: set[Spot] = set()
        open_exits: dict[tuple[int, int, int], set[int]] = {}

        while queue:
            self._clock.check()
            cost = heappop(queue)
            for spot in levels.pop(cost):
                if spot in settled:
                    continue
                settled.add(spot)
                self._accept(spot, cost)
                for weight, after in self._changes(spot) + self._elsewhere(spot, open_exits):
                    self._entries.setdefault(after, []).append((weight, spot))
                    if after in settled:
                        continue
                    level = levels.get(cost + weight)
                    if level is None:
                        level = levels[cost + weight] = []
                        if pays(cost + weight):
                            heappush(queue, cost + weight)
                    level.append(after)

    def _elsewhere(self, spot: Spot, open_exits: dict[tuple[int, int, int], set[int]]) -> list[Edge]:
        """Edges to other places, as long as not all places have been met where something can happen."""
        value, team, robot, place = spot
        if not robot:
            return []
        exits = open_exits.get((value, team, robot))
        if exits is None:
            exits = open_exits[value, team, robot] = self._exits(value, robot)
        exits.discard(place)
        exits.discard(-1)
        if not exits:
            self._stopped.add((value, team, robot))
            return []
        weights = self._weights
        return [
            (weights[index], (value, team, robot, there))
            for there, index in self._acts.from_place(robot, place)
        ]

    def _changes(self, spot: Spot) -> list[Edge]:
        """Edges that set the field, or hand over tracking."""
        value, team, robot, place = spot
        edges: list[Edge] = []
        if robot:
            ops = _with_anything(self._acts.by_place(value, robot), place)
        else:
            ops = [op for op in self._acts.on(value) if not op.agents & team]
        for op in ops:
            after = op.put & self._field if self._field & ~op.keep else value
            weight = self._weights[op.cost]
            for other, field in self._places.field.items():
                if op.agents & other:
                    here = place if other == robot else -1
                    edges += [
                        (weight, (after, op.agents, other, p)) for p in self._after(op, other, field, here)
                    ]
        for op in _with_anything(self._flips, value):
            edges.append((0, (op.put & self._field, team, robot, place)))
        if robot and team and len(self._places.field) > 1:
            edges.append((0, (value, team, 0, 0)))
        return edges

    def _after(self, op: Op, robot: int, field: int, place: int) -> list[int]:
        """Where a robot can be after an op: known, set by it, asked for by it, or anywhere."""
        if field & ~op.keep:
            return [op.put & field]
        if place >= 0:
            return [place]
        if op.need_mask & field:
            return [op.need & field]
        return self._encoding.values(field)

    def _index(self, i: int, need: Need) -> None:
        """By value and place, where a need is provided."""
        value = need.value & self._field
        robots = [robot for robot, field in self._places.field.items() if need.mask & field]
        for robot in robots:
            spots = self._at_place.setdefault((value, robot), {})
            spots.setdefault(need.value & self._places.field[robot], []).append(i)
        if robots:
            self._detached.setdefault(value, []).append((i, sum(robots)))
        else:
            self._anyhow.setdefault(value, []).append(i)

    def _exits(self, value: int, robot: int) -> set[int]:
        """Places in which something can happen to the value (-1: anywhere)."""
        return {*self._acts.by_place(value, robot), *self._at_place.get((value, robot), ())}

    def _accept(self, spot: Spot, cost: int) -> None:
        """Note the needs that are provided at a spot."""
        value, team, robot, place = spot
        found = list(self._anyhow.get(value, ()))
        if robot:
            found += self._at_place.get((value, robot), {}).get(place, ())
        else:
            found += [i for i, robots in self._detached.get(value, ()) if not robots & team]
        for i in found:
            self._accepted.setdefault(i, []).append(spot)
            self.cost.setdefault(i, cost)

    def distances(self, need: int) -> "Distances":
        """Backward from a need, over what :meth:`explore` has seen."""
        sources = [(0, spot) for spot in self._accepted.get(need, ())]
        found = backward(sources, [self._entries], self._clock)
        return Distances(self._field, self._places.field, found, self._stopped)


class Distances:
    """Least robots' weight from a packed state to provide one need; 0 where it is not known.

    What :meth:`Provision.explore` has not reached is too dear for a state in which robots
    have paid for getting there.  Where it stopped walking, since all that can happen to the
    field is within reach, the least of what it knows stands for the rest.
    """

    def __init__(
        self,
        field: int,
        places: dict[int, int],
        found: dict[Spot, int],
        stopped: set[tuple[int, int, int]],
    ) -> None:
        self._field = field
        self._tables = [(field | place, dict[int, int]()) for place in places.values()]
        self._fallback: dict[tuple[int, int], int] = {}
        table_of = dict(zip(places, self._tables, strict=True))
        open_ended: set[tuple[int, int]] = set()
        for (value, team, robot, place), weight in found.items():
            if not robot:
                continue
            mask, table = table_of[robot]
            spot = value | place
            table[spot] = min(weight, table.get(spot, weight))
            if (value, team, robot) in stopped:
                known = self._fallback.get((mask, value), weight)
                self._fallback[mask, value] = min(weight, known)
            else:
                open_ended.add((mask, value))
        for label in open_ended:
            self._fallback.pop(label, None)

    def __call__(self, state: int) -> int:
        """The bound from a packed state."""
        best = INFINITE_KEY
        for mask, table in self._tables:
            weight = table.get(state & mask)
            if weight is None:
                weight = self._fallback.get((mask, state & self._field), 0)
            if weight < best:
                best = weight
        return best

    def each(self, state: int) -> Iterator[int]:
        """The same for each robot, if it is the first to act; in the order of ``task.robots``."""
        for mask, table in self._tables:
            weight = table.get(state & mask)
            yield self._fallback.get((mask, state & self._field), 0) if weight is None else weight


def _with_anything(by_value: dict[int, list[Item]], value: int) -> list[Item]:
    """What stands under a value or a place, and what stands under all of them (-1)."""
    anything = by_value.get(-1)
    known = by_value.get(value, [])
    return known + anything if anything else known


def _walks(moves: dict[int, list[tuple[int, Op]]], but: AbstractSet[int]) -> dict[int, list[tuple[int, int]]]:
    """Moves with the index of their cost, some actions left out."""
    return {
        origin: [(there, op.cost) for there, op in ops if op.action not in but]
        for origin, ops in moves.items()
    }


def _by_value(field: int, forms: Iterable[Form]) -> dict[int, list[Op]]:
    """Ops by the value of a field that they ask for; under -1 where they don't."""
    found: dict[int, list[Op]] = {}
    for form in forms:
        if not form.need_mask & field:
            found.setdefault(-1, []).extend(form.ops)
            continue
        for op in form.ops:
            found.setdefault(op.need & field, []).append(op)
    return found
