"""The map behind a task: places, ways between them, and which facts say who or what is where.

An agent's own *moves* take away one fact and add another of the same predicate: ``at commx
hall1``, ``at commx hall2``.  Facts that moves connect, of which at most one is true initially
and whose common words speak of the agent or of nobody in particular, tell its position;
what differs between them is the place.  What agents move that is none of them (``at van hall1``),
by facts of the same predicate, is a vehicle: where it gets is a place, too.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain

import networkx as nx

from serendipity.model import GroundAction, Task
from serendipity.model.task.whole_actions import whole
from serendipity.pictures.map.names import Parts, common_ends, find, natural, parts, spellings, without


@dataclass(frozen=True, slots=True)
class Whereabouts:
    """Where an object is: in a place, in or on another one, held or ridden by somebody; and who rides it."""

    place: str | None = None
    holder: int | None = None
    carrier: str | None = None
    riders: tuple[int, ...] = ()


@dataclass(frozen=True)
class Places:
    """The map of a task; empty where the task has none.

    Attributes:
        names: of the places, sorted as people count.
        links: pairs of places that somebody can move between, each pair once.
        positions: for each agent with a position, the place by fact id.
        objects: for each object, what each fact id says about it.
        riding: for agents that can be in or on an object instead, the object by fact id.
        marks: facts true or false by themselves that name a place: the place by fact id.
    """

    names: tuple[str, ...] = ()
    links: tuple[tuple[str, str], ...] = ()
    positions: dict[int, dict[int, str]] = field(default_factory=dict)
    objects: dict[str, dict[int, Whereabouts]] = field(default_factory=dict)
    riding: dict[int, dict[int, str]] = field(default_factory=dict)
    marks: dict[int, str] = field(default_factory=dict)

    @cached_property
    def facts(self) -> frozenset[int]:
        """Ids of the facts that tell where somebody or something is."""
        return frozenset(chain(*self.positions.values(), *self.objects.values()))

    @property
    def vehicles(self) -> frozenset[str]:
        """Objects that others can be in or on."""
        carriers = {where.carrier for told in self.objects.values() for where in told.values()}
        ridden = {name for riding in self.riding.values() for name in riding.values()}
        return frozenset(name for name in carriers | ridden if name is not None)

    def goals(self, task: Task) -> tuple[str, ...]:
        """The places that the human's goal names."""
        own = self.positions.get(task.human, {})
        named = (self.marks.get(fact) or own.get(fact) for fact in task.goal.positive)
        return tuple(dict.fromkeys(place for place in named if place is not None))


def find_places(task: Task) -> Places:
    """The map of a task, from its actions and the names of its facts."""
    positions: dict[int, dict[int, str]] = {}
    links: set[tuple[str, str]] = set()
    moves = _moves(task)
    for agent, facts in _positions(task, moves).items():
        places = positions[agent] = _place_names(task, facts, task.agents[agent])
        links |= _links(moves[agent].subgraph(facts), places)
    every = nx.compose_all(moves.values())
    driven: set[str] = set()
    vehicles = list(_vehicles(task, every, positions))
    for facts in vehicles:
        places = _place_names(task, facts)
        driven.update(places.values())
        links |= _links(every.subgraph(facts), places)
    names = sorted(driven.union(*(told.values() for told in positions.values())), key=natural)
    if not names:
        return Places()
    told_by = {parts(task.facts[f])[0] for facts in (*positions.values(), *vehicles) for f in facts}
    finder = _PlaceFinder(task, names, told_by)
    finder.add_stops(positions)
    taken = {f for places in positions.values() for f in places}
    objects: dict[str, dict[int, Whereabouts]] = {}
    groups: dict[str, Sequence[int]] = {}
    for group in _groups(task, moves):
        name, told = finder.object(group) if taken.isdisjoint(group) else ("", {})
        if name and name not in objects and name not in task.agents:
            objects[name], groups[name] = told, group
    for name, group in groups.items():
        for fact in set(group) - objects[name].keys():
            carrier = _named(task.facts[fact], objects.keys() - {name})
            if carrier is not None:
                objects[name][fact] = Whereabouts(carrier=carrier)
    alone = [variable.facts[0] for variable in task.variables if variable.boolean]
    named = {fact: finder.place(parts(task.facts[fact])) for fact in alone}
    marks = {fact: place for fact, place in named.items() if place is not None}
    ordered = sorted(links, key=lambda link: (natural(link[0]), natural(link[1])))
    return Places(
        names=tuple(names),
        links=tuple(ordered),
        positions=dict(sorted(positions.items())),
        objects=objects,
        riding=_riding(task, positions, tuple(objects)),
        marks=marks,
    )


def _wholes(task: Task) -> Iterator[GroundAction]:
    """What can be done in a task, and what bystanders do."""
    deeds = (action for deed in task.script.deeds for action in deed.variants)
    return map(whole, chain(task.actions, deeds))


def _links(moves: "nx.Graph[int]", places: dict[int, str]) -> set[tuple[str, str]]:
    """The places that moves join."""
    joined = ((places[source], places[target]) for source, target in moves.edges)
    return {(a, b) if natural(a) < natural(b) else (b, a) for a, b in joined}


def _named(fact: str, names: Iterable[str]) -> str | None:
    """One of some names that a fact mentions after its predicate, or None."""
    words = parts(fact)
    return next((name for name in sorted(names) if find(tuple(name.split()), words) > 0), None)


def _moves(task: Task) -> "dict[int, nx.Graph[int]]":
    """By agent: the facts of equal predicates that actions of its own exchange."""
    words = [parts(fact) for fact in task.facts]
    found: dict[int, nx.Graph[int]] = {agent: nx.Graph() for agent in range(len(task.agents))}
    for action in _wholes(task):
        if action.joint:
            continue
        for fact in action.delete:
            gains = [g for g in action.add if words[g][0] == words[fact][0]]
            if fact in action.pre and gains:
                # Who pushes a crate exchanges two facts for two: the likest belong together.
                gain = max(gains, key=lambda g: sum(map(len, common_ends([words[fact], words[g]]))))
                found[action.participants[0]].add_edge(fact, gain)
    return found


def _positions(task: Task, moves: "dict[int, nx.Graph[int]]") -> dict[int, list[int]]:
    """By agent: the facts that tell its position.

    A group of facts is given to the agent whom it names, else to the one whose name is part
    of its words, else to the one who moves most in it.  An agent that several groups name is where
    other things can be, too: its fuel is low, but nothing else is in ``low``.
    """
    groups = [sorted(group) for group in nx.connected_components(nx.compose_all(moves.values()))]
    exchanged = {fact for group in groups for fact in group}
    others = {w for f, fact in enumerate(task.facts) if f not in exchanged for w in parts(fact)[1:]}
    ranked = []
    for facts in groups:
        words = [parts(task.facts[f]) for f in facts]
        start, end = common_ends(words)
        shared = start + end
        met = any(others.issuperset(value[len(start) : len(value) - len(end)]) for value in words)
        for agent, name in enumerate(task.agents):
            named = any(find(spelling, shared) >= 0 for spelling in spellings(name))
            own = moves[agent].subgraph(facts).number_of_edges()
            if own and len(task.init.intersection(facts)) <= 1 and (named or len(shared) == 1):
                inside = any(name in word for word in shared)
                ranked.append(((named, inside, met, own, -agent), facts))
    chosen: dict[int, list[int]] = {}
    for (*_, agent), facts in sorted(ranked, reverse=True):
        if -agent not in chosen and facts not in chosen.values():
            chosen[-agent] = facts
    return dict(sorted(chosen.items()))


def _vehicles(
    task: Task, moves: "nx.Graph[int]", positions: dict[int, dict[int, str]]
) -> Iterator[list[int]]:
    """Facts that tell where something is that agents move, in the words that tell where they are."""
    known = {fact for places in positions.values() for fact in places}
    predicates = {parts(task.facts[fact])[0] for fact in known}
    for group in nx.connected_components(moves):
        words = [parts(task.facts[fact]) for fact in group]
        fits = {name[0] for name in words} <= predicates and known.isdisjoint(group)
        if fits and len(common_ends(words)[0]) > 1 and len(task.init & group) <= 1:
            yield sorted(group)


def _groups(task: Task, moves: "dict[int, nx.Graph[int]]") -> Iterator[Sequence[int]]:
    """Facts of which exactly one is true, and such as moves exchange where that is not known."""
    for variable in task.variables:
        if not variable.boolean:
            yield variable.facts
    for group in nx.connected_components(nx.compose_all(moves.values())):
        if len(task.init & group) == 1:
            yield sorted(group)


def _place_names(task: Task, facts: list[int], agent: str = "") -> dict[int, str]:
    values = [parts(task.facts[f]) for f in facts]
    start, end = map(len, common_ends(values))
    for name in spellings(agent) if agent else ():
        at = find(name, values[0])
        if 0 <= at < start:
            start = at + len(name)  # the places' own common beginning belongs to their names
            break
    joint = " " if any(" " in task.facts[f] for f in facts) else "_"
    names = [joint.join(value[start : len(value) - end]) for value in values]
    if not all(names) or len(set(names)) < len(names):
        names = [task.facts[f] for f in facts]
    return dict(zip(facts, names, strict=True))


def _riding(
    task: Task, positions: dict[int, dict[int, str]], objects: tuple[str, ...]
) -> dict[int, dict[int, str]]:
    """Values of an agent's position that are no place, but name an object (``in prime car0``)."""
    found: dict[int, dict[int, str]] = {}
    for agent, places in positions.items():
        for variable in task.variables:
            if places.keys().isdisjoint(variable.facts):
                continue
            for fact in variable.facts:
                vehicle = _named(task.facts[fact], objects)
                if fact not in places and vehicle is not None:
                    found.setdefault(agent, {})[fact] = vehicle
    return found


class _PlaceFinder:
    """Finds what a fact's name mentions; some predicates say where a thing is, others who holds it."""

    def __init__(self, task: Task, places: list[str], predicates: set[str]) -> None:
        self.task = task
        self.predicates = predicates
        self.places = {spelling: place for place in places for spelling in (parts(place), (place,))}
        self.longest = max(map(len, self.places), default=0)
        self.agents = [(spelling, i) for i, name in enumerate(task.agents) for spelling in spellings(name)]

    def place(self, words: Parts) -> str | None:
        """The place that is named after the predicate, or None."""
        spelling = self._place(words)
        return None if spelling is None else self.places[spelling]

    def _place(self, words: Parts) -> Parts | None:
        for length in range(min(self.longest, len(words) - 1), 0, -1):
            for start in range(1, len(words) - length + 1):
                if words[start : start + length] in self.places:
                    return words[start : start + length]
        return None

    def add_stops(self, positions: dict[int, dict[int, str]]) -> None:
        """Add where agents are who got there in a vehicle: facts of theirs like those of who walks."""
        known = [fact for places in positions.values() for fact in places]
        predicates = {parts(self.task.facts[fact])[0] for fact in known}
        for fact, name in enumerate(self.task.facts):
            words = parts(name)
            place = self._place(words) if words[0] in predicates else None
            if place is not None:
                for spelling, agent in self.agents:
                    if words[1:] in (spelling + place, place + spelling):
                        positions.setdefault(agent, {})[fact] = self.places[place]

    def object(self, facts: Sequence[int]) -> tuple[str, dict[int, Whereabouts]]:
        """The object whose place or holder some facts tell, and how; an empty name if none."""
        told: dict[int, Whereabouts] = {}
        left: list[frozenset[str]] = []
        order: Parts = ()
        placed = False
        for fact in facts:
            words = parts(self.task.facts[fact])
            place = self._place(words)
            holder = next((agent for agent in self.agents if find(agent[0], words) > 0), None)
            held = holder is not None and holder[0] == place and words[0] not in self.predicates
            if place is not None and not held:
                placed = True
                told[fact] = Whereabouts(place=self.places[place])
                rest = without([place], words[1:])
            elif holder is not None:
                told[fact] = Whereabouts(holder=holder[1])
                rest = without([holder[0]], words[1:])
            else:
                rest = words[1:]
            left.append(frozenset(rest))
            order = order or rest
        shared = frozenset.intersection(*left)
        several = len(set(told.values())) > 1
        return (" ".join(w for w in order if w in shared) if placed and several else ""), told
