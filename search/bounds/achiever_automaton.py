"""The automaton behind achiever costs: least costs for robots to provide what a touch needs.

One outside field is looked at together with the place of one robot at a time:
the robot that is *tracked*.  It walks (ops on its place), it acts on the field,
and where the next op on the field has other actors, tracking passes on: to a
robot that takes part in both ops, from where the first one left it, or, where
there is none, to any robot, anywhere, for nothing.  All other conditions are
dropped, so distances are admissible for any number of robots that relay.

An example: robot R stands in room a, robot S in room c of the corridor a - b - c, whose door is
closed.  A step costs 1; to open the door, which is done in c, costs 2.  The outside field is the door.
Forward from (closed, nobody, S, c), cost 0, opening leads to (open, {S}, S, c), cost 2; from
(closed, nobody, R, a) it takes two steps first, cost 4 in all.  A need "the door is open" is provided at
both, so its bound is min(2, 4) = 2.  A need "the door is open and R is in a" is not provided where S is
tracked, for R's place is unknown there; but tracking passes on for nothing, to (open, {S}, 0, -),
where any robot but S may be anywhere: R may be in a, so its bound is 2 as well, which is exact.  If R were
alone, it would have to walk back: (open, {R}, R, c), cost 4, and two steps to (open, {R}, R, a), cost 6.
Backward from the need these are the distances of all spots on the way: 6 at the start, 4 once R is in c.

Glossary: *place* - see :mod:`search.robots.transition_graphs`; *label* - value of the field, team of the
last op on it (0 at the start).
"""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from itertools import chain

from search.bounds.achiever_costs import AchieverCosts, AutomatonNode, Label, Spot, Teams
from search.bounds.interactions import Need
from search.engine.shortest_paths import LevelQueue
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operator_index import by_variable
from search.packed.operators import Operator, forms_of
from search.packed.packed_task import PackedTask
from search.robots.transition_graphs import TransitionGraphs
from serendipity.model.resources.deadline import Deadline

Edge = tuple[int, Spot]
"""Weight, and where it leads."""


class AchieverAutomaton:
    """Distances in the automaton of one outside field.

    Args:
        transitions: what robots' ops do to each variable.
        field: the outside field.
        needs: ids of the needs that are judged by this field, with the needs.
        weights: key increment of a robots' op by the index of its cost.
        flips: ops of the human that may change the field on their way, for nothing.

    Attributes:
        places: place field by robot's bit.
        cost: least cost from the initial state by need id.
        unchanged: the initial value of the field, or -1 where some walks mention the field.
    """

    def __init__(
        self,
        packed: PackedTask,
        transitions: TransitionGraphs,
        field: int,
        needs: Sequence[tuple[int, Need]],
        weights: Sequence[int],
        flips: Iterable[Operator],
        deadline: Deadline,
    ) -> None:
        self.places = transitions.places.field
        self.field = field
        self._weights = weights
        self._deadline = deadline
        self._initial = packed.init
        self._packed = packed
        self._acts = transitions.on(field)
        changing = (op for op in flips if field & ~op.keep)
        self._flips = by_variable(field, forms_of(changing, packed.all_ones, deadline))
        self._anyhow: dict[int, list[int]] = {}
        self._at_place: dict[tuple[int, int], dict[int, list[int]]] = {}
        self._detached: dict[int, list[tuple[int, int]]] = {}
        self._robots: dict[int, list[int]] = {}
        for i, need in deadline.each(needs):
            self._index(i, need)
        self._nodes: dict[Spot, AutomatonNode] = {}  # in the order in which they were met
        self._accepted: dict[int, list[AutomatonNode]] = {}
        self._open_exits: dict[Label, set[int]] = {}
        self._stopped: dict[Label, list[AutomatonNode]] = {}
        self._too_dear = INFINITE_KEY
        self._steps: dict[Label, int] = {}
        self.cost: dict[int, int] = {}
        self.unchanged = -1 if self._acts.walks_mention else self._initial & field

    def explore(self, pays: Callable[[int], bool]) -> None:
        """Forward from the initial state, as long as the cost pays; fills ``cost`` per need id."""
        value = self._initial & self.field
        for robot, place in self.places.items():
            spot = value, 0, robot, self._initial & place
            self._nodes[spot] = AutomatonNode(spot)
        queue = LevelQueue((0, node) for node in self._nodes.values())
        for cost, level in queue:
            for node in level:
                if node.cost >= 0:
                    continue
                node.cost = cost
                self._deadline.tick()
                self._accept(node)
                edges = self._changes(node.spot)
                if node.spot[2]:
                    edges += self._walks(node)
                for weight, after in edges:
                    self._relax(queue, node, weight, after, pays)

    def settled(self, spot: Spot) -> AutomatonNode | None:
        """What is known of a spot that was explored."""
        node = self._nodes.get(spot)
        return None if node is None or node.cost < 0 else node

    def _relax(
        self,
        queue: LevelQueue[AutomatonNode],
        before: AutomatonNode,
        weight: int,
        after: Spot,
        pays: Callable[[int], bool],
    ) -> None:
        """Record an edge, and look at where it leads as long as the cost pays."""
        node = self._nodes.get(after)
        if node is None:
            node = self._nodes[after] = AutomatonNode(after)
        node.edges.append((weight, before))
        cost = before.cost + weight
        if node.cost < 0 and cost < self._too_dear:
            level = queue.levels.get(cost)
            if level is not None:
                level.append(node)  # what costs as much does pay
            elif pays(cost):
                queue.push(cost, node)
            else:
                self._too_dear = cost  # nor does what costs more

    def _walks(self, node: AutomatonNode) -> list[Edge]:
        """Walks of the tracked robot; only those to known spots, if there is nowhere left to go.

        Where else the robot may walk to is left open then (see :meth:`distances`).
        """
        value, team, robot, place = node.spot
        label = value, team, robot
        exits = self._open_exits.get(label)
        if exits is None:
            exits = self._open_exits[label] = self._exits(value, robot)
        exits.discard(place)
        weights = self._weights
        walks = [
            (weights[op.cost], (value, team, robot, there)) for there, op in self._acts.walks[robot].at(place)
        ]
        if exits:
            return walks
        known = [(weight, after) for weight, after in walks if self.settled(after)]
        if len(known) < len(walks):
            self._stopped.setdefault(label, []).append(node)
            if label not in self._steps:
                self._steps[label] = self._least_step(label)
        return known

    def _changes(self, spot: Spot) -> list[Edge]:
        """Edges that set the field, or hand over tracking."""
        value, team, robot, place = spot
        edges: list[Edge] = []
        if robot:
            ops = self._acts.by_place(value, robot).at(place)
        else:
            ops = [op for op in self._acts.on(value) if not op.agents & team]
        for op in ops:
            after = op.put & self.field if self.field & ~op.keep else value
            weight = self._weights[op.cost]
            for other, field in self.places.items():
                if op.agents & other:
                    here = place if other == robot else -1
                    edges += [(weight, (after, op.agents, other, p)) for p in self._after(op, field, here)]
        edges += [(0, (op.put & self.field, team, robot, place)) for op in self._flips.at(value)]
        if robot and team and len(self.places) > 1:
            edges.append((0, (value, team, 0, 0)))
        return edges

    def _after(self, op: Operator, field: int, place: int) -> list[int]:
        """Where a robot can be after an op: known, set by it, asked for by it, or anywhere."""
        if field & ~op.keep:
            return [op.put & field]
        if place >= 0:
            return [place]
        if op.need_mask & field:
            return [op.need & field]
        return self._packed.values(field)

    def _index(self, i: int, need: Need) -> None:
        """The values and places at which a need is provided."""
        value = need.value & self.field
        robots = self._robots.get(need.mask)
        if robots is None:
            robots = self._robots[need.mask] = [r for r, field in self.places.items() if need.mask & field]
        for robot in robots:
            spots = self._at_place.setdefault((value, robot), {})
            spots.setdefault(need.value & self.places[robot], []).append(i)
        if robots:
            self._detached.setdefault(value, []).append((i, sum(robots)))
        else:
            self._anyhow.setdefault(value, []).append(i)

    def _exits(self, value: int, robot: int) -> set[int]:
        """Places in which something can happen to the value, and that not everywhere.

        What can happen everywhere leaves the robot where it is, so places count in which something
        can happen to the next value, too.
        """
        found: set[int] = set()
        pending, seen = [value], {value}
        while pending:
            at = pending.pop()
            acts = self._acts.by_place(at, robot)
            found.update(acts.by_value, self._at_place.get((at, robot), ()))
            for op in (*acts.always, *self._flips.at(at)):
                after = op.put & self.field if self.field & ~op.keep else at
                if after not in seen:
                    seen.add(after)
                    pending.append(after)
        return found

    def _least_step(self, label: Label) -> int:
        """The least that a robot pays from where no exit is; 0 where it need not walk to go on."""
        value, team, robot = label
        if team or self._flips.at(value) or self._acts.by_place(value, robot).always:
            return 0
        walks = self._acts.walks[robot]
        listed = chain(walks.always, *walks.by_value.values())
        return min((self._weights[op.cost] for _, op in listed), default=0)

    def _accept(self, node: AutomatonNode) -> None:
        """Note the needs that are provided at a spot."""
        value, team, robot, place = node.spot
        there: Iterable[int]
        if robot:
            there = self._at_place.get((value, robot), {}).get(place, ())
        else:
            there = [i for i, robots in self._detached.get(value, ()) if not robots & team]
        for i in chain(self._anyhow.get(value, ()), there):
            self._accepted.setdefault(i, []).append(node)
            self.cost.setdefault(i, node.cost)

    def distances(self, need: int, slack: int) -> AchieverCosts:
        """Backward from a need, over what :meth:`explore` has seen.

        Args:
            need: its id.
            slack: a key increment; if robots pay as much or more from the initial state on, it is too dear.
        """
        queue = LevelQueue((0, node) for node in self._accepted.get(need, ()))
        found: dict[AutomatonNode, int] = {}
        elsewhere: dict[Label, int] = {}
        for cost, level in queue:
            latest = slack - cost
            for node in level:
                if node in found or node.cost >= latest:
                    continue
                found[node] = cost
                self._deadline.tick()
                label = node.spot[:3]
                if label in self._stopped and label not in elsewhere:
                    # From beyond where it stopped walking this is in reach, at the least.
                    step = 0 if need in self._anyhow.get(label[0], ()) else self._steps[label]
                    elsewhere[label] = cost + step
                    queue.relax(cost, ((2 * step, before) for before in self._stopped[label]), found)
                queue.relax(cost, node.edges, found)
        return AchieverCosts(self, found, elsewhere)

    def teams(self, value: int) -> Teams:
        """The teams that may have been the last to act on the field, by its value.

        Where the field is as it was initially, what a robot can do next does not depend on
        whether others have changed it meanwhile.
        """
        if value == self.unchanged:
            return ((0, tuple(range(len(self.places))), False),)
        return self._changed.get(value, ())

    @cached_property
    def _changed(self) -> dict[int, Teams]:
        found: dict[int, set[int]] = {}
        for (value, team, _, _), node in self._nodes.items():
            if node.cost >= 0:
                found.setdefault(value, set()).add(team)
        return {value: tuple(self._team(value, team) for team in teams) for value, teams in found.items()}

    def _team(self, value: int, team: int) -> tuple[int, tuple[int, ...], bool]:
        """An entry of :data:`Teams`.

        What happens next without the whole team is known by any robot.  If every other thing
        that can happen has the same robot of the team in it, then it is enough to track that
        one, and what it needs is a bound by itself.
        """
        robots = list(enumerate(self.places))
        if not team:
            return 0, tuple(j for j, _ in robots), False
        needed = [op.agents for op in self._acts.on(value)]
        needed += [who for _, who in self._detached.get(value, ())]
        meeting = [who for who in needed if who & team]
        always = tuple(j for j, robot in robots if robot & team and all(who & robot for who in meeting))
        members = tuple(j for j, robot in robots if robot & team)
        return team, always or members, bool(always)
