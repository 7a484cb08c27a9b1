"""The map behind a task: places, ways between them, and which facts say who or what is where.

A variable is an agent's *position* where his own moves take it from value to value: actions
of his alone that consume one value, add another and otherwise change facts that are true or
false by themselves (a cell has been visited), and where all its values share a predicate
(``at commx hall1``, ``at commx hall2``).  What differs between the values is the place.
"""

from collections import defaultdict
from dataclasses import dataclass

from serendipity.model import Task
from serendipity.model.variables import Variable
from serendipity.show.names import Parts, common_start, find, natural, parts, spellings, without


@dataclass(frozen=True, slots=True)
class Whereabouts:
    """What a fact says about an agent or an object: it is in a place, or somebody holds it."""

    place: str | None = None
    holder: int | None = None


@dataclass(frozen=True, slots=True)
class Places:
    """The map of a task; empty where the task has none.

    Attributes:
        names: of the places, sorted as people count.
        links: pairs of places that somebody can move between, each pair once.
        positions: for each agent with a position, the place by fact id.
        objects: for each object, what each fact id says about it.
        marks: facts true or false by themselves that name a place: the place by fact id.
    """

    names: tuple[str, ...]
    links: tuple[tuple[str, str], ...]
    positions: dict[int, dict[int, str]]
    objects: dict[str, dict[int, Whereabouts]]
    marks: dict[int, str]


def find_places(task: Task) -> Places:
    """The map of a task, from its actions and the names of its facts."""
    moves = _moves(task)
    positions: dict[int, dict[int, str]] = {}
    chosen: set[Variable] = set()
    links: set[tuple[str, str]] = set()
    for agent in range(len(task.agents)):
        candidates = [
            (len(pairs), variable)
            for (owner, variable), pairs in moves.items()
            if owner == agent and variable not in chosen and _tells_place(task, agent, variable)
        ]
        if not candidates:
            continue
        _, variable = max(candidates, key=lambda found: found[0])
        chosen.add(variable)
        places = positions[agent] = _place_names(task, agent, variable)
        for source, target in moves[agent, variable]:
            a, b = sorted((places[source], places[target]), key=natural)
            links.add((a, b))
    names = sorted({place for places in positions.values() for place in places.values()}, key=natural)
    finder = _PlaceFinder(task, names)
    objects: dict[str, dict[int, Whereabouts]] = {}
    marks: dict[int, str] = {}
    for variable in task.variables:
        if variable.boolean:
            place = finder.place(parts(task.facts[variable.facts[0]]))
            if place is not None:
                marks[variable.facts[0]] = place
        elif variable not in chosen:
            name, told = finder.object(variable)
            if name and name not in objects:
                objects[name] = told
    ordered = sorted(links, key=lambda link: (natural(link[0]), natural(link[1])))
    return Places(tuple(names), tuple(ordered), positions, objects, marks)


def _moves(task: Task) -> dict[tuple[int, Variable], set[tuple[int, int]]]:
    """By agent and variable: the value pairs that moves of the agent alone connect."""
    variable_of = {f: v for v in task.variables for f in v.facts}
    found: dict[tuple[int, Variable], set[tuple[int, int]]] = defaultdict(set)
    for action in task.actions:
        if action.joint:
            continue
        changed = [f for f in (*action.add, *action.delete) if not variable_of[f].boolean]
        touched = {variable_of[f] for f in changed}
        if len(touched) != 1:
            continue
        (variable,) = touched
        sources = [f for f in action.pre if f in variable.facts]
        targets = [f for f in action.add if f in variable.facts]
        if len(sources) == len(targets) == 1 and sources != targets:
            found[action.participants[0], variable].add((sources[0], targets[0]))
    return found


def _tells_place(task: Task, agent: int, variable: Variable) -> bool:
    """Whether the values share a predicate and speak of the agent, or of nobody in particular."""
    values = [parts(task.facts[f]) for f in variable.facts]
    shared = common_start(values)
    named = any(find(name, shared) >= 0 for name in spellings(task.agents[agent]))
    return named or len(shared) == 1


def _place_names(task: Task, agent: int, variable: Variable) -> dict[int, str]:
    values = [parts(task.facts[f]) for f in variable.facts]
    start = len(common_start(values))
    for name in spellings(task.agents[agent]):
        at = find(name, values[0])
        if 0 <= at < start:
            start = at + len(name)  # the places' own common beginning belongs to their names
            break
    joint = " " if any(" " in task.facts[f] for f in variable.facts) else "_"
    names = [joint.join(value[start:]) for value in values]
    if not all(names) or len(set(names)) < len(names):
        names = [task.facts[f] for f in variable.facts]
    return dict(zip(variable.facts, names, strict=True))


class _PlaceFinder:
    """Finds the place, agent or object that a fact's name mentions."""

    def __init__(self, task: Task, places: list[str]) -> None:
        self.task = task
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

    def object(self, variable: Variable) -> tuple[str, dict[int, Whereabouts]]:
        """The object whose place or holder a variable tells, and how; an empty name if none."""
        told: dict[int, Whereabouts] = {}
        left: list[frozenset[str]] = []
        order: Parts = ()
        placed = False
        for fact in variable.facts:
            words = parts(self.task.facts[fact])
            place = self._place(words)
            holder = next((agent for agent in self.agents if find(agent[0], words) > 0), None)
            if place is not None:
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
