"""A search-and-rescue task (the paper's section II): who and what is where, and all of it as PDDL text.

It has the semantics of the paper's 200 problems.  Every action costs 1 (the domain has no costs).
``conduct_triage`` is the human's alone and does not use the kit up; ``hand_over`` is joint, between two
agents in one place.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from random import Random
from typing import Final

from serendipity.model import UsageError
from serendipity.model.keywords import require_one_of

_HALLS_PER_LOCATION = 8 / 21  # as in Figure 2
_NEW_CORRIDOR = 0.2  # chance that a hall starts a corridor instead of prolonging the last one
_ROOM_BEHIND_ROOM = 0.15  # Figure 2 has 2 such rooms of 13


@dataclass(frozen=True, slots=True)
class Building:
    """A connected map.

    Attributes:
        locations: names, unique, in the order in which they are written down.
        connections: pairs of locations; ``move`` goes along one, ``move_reverse`` against it.

    Raises:
        UsageError: a name comes twice, a connection names no location or joins one to
            itself, two connections join the same locations.
    """

    locations: tuple[str, ...]
    connections: tuple[tuple[str, str], ...]

    def __post_init__(self) -> None:
        known = set(self.locations)
        if len(known) < len(self.locations):
            raise UsageError("building: two locations have the same name")
        if any(a == b or a not in known or b not in known for a, b in self.connections):
            raise UsageError("building: a connection joins two different locations of the building")
        if len({frozenset(pair) for pair in self.connections}) < len(self.connections):
            raise UsageError("building: two connections join the same locations")


def figure2() -> Building:
    """The building of the paper's Figure 2: 21 locations, 20 connections, a tree (semantics 5)."""
    halls = [f"hall{i}" for i in range(1, 9)]
    rooms = [f"room{i}" for i in range(1, 14)]
    doors = {
        "hall1": ("room1", "room9", "room10"),
        "hall2": ("room2",),
        "hall4": ("room4", "room11"),
        "room4": ("room3",),
        "hall5": ("room5", "room12"),
        "hall7": ("room7",),
        "room7": ("room6",),
        "hall8": ("room8", "room13"),
    }
    corridor = list(pairwise(halls))
    return Building(
        tuple(halls + rooms),
        tuple(corridor + [(room, place) for place, beyond in doors.items() for room in beyond]),
    )


def random_building(
    locations: int, *, seed: int = 0, extra_edges: int = 0, corridors: int | None = None
) -> Building:
    """A random building in the manner of Figure 2: corridors of halls, with rooms off them.

    Args:
        locations: how many halls and rooms together, at least 2.
        extra_edges: connections beyond the tree; each closes a cycle.
        corridors: how many the halls form; 1 is what Figure 2 has.  By default each hall starts one with a
            chance of a fifth.

    Raises:
        UsageError: too few locations, or more extra connections or corridors than there is room for.
    """
    if locations < 2:
        raise UsageError(f"rooms: expected at least 2, got {locations}")
    free = (locations - 1) * (locations - 2) // 2
    if not 0 <= extra_edges <= free:
        raise UsageError(f"extra_edges: expected from 0 to {free} for {locations} rooms, got {extra_edges}")
    halls = [f"hall{i}" for i in range(1, max(1, round(locations * _HALLS_PER_LOCATION)) + 1)]
    if corridors is not None and not 1 <= corridors <= len(halls):
        raise UsageError(
            f"corridors: expected from 1 to {len(halls)} for {locations} rooms, got {corridors!r:.50}"
        )
    random = Random(f"building {seed}")
    rooms = [f"room{i}" for i in range(1, locations - len(halls) + 1)]
    tree = _corridors(halls, corridors, random) + _doors(halls, rooms, random)
    return Building(tuple(halls + rooms), tuple(tree + _extra(halls + rooms, tree, extra_edges, random)))


def _corridors(halls: list[str], wanted: int | None, random: Random) -> list[tuple[str, str]]:
    first = None if wanted is None else set(random.sample(range(1, len(halls)), wanted - 1))
    connections = []
    for i in range(1, len(halls)):
        starts = random.random() < _NEW_CORRIDOR if first is None else i in first
        before = random.randrange(i) if starts else i - 1
        connections.append((halls[before], halls[i]))
    return connections


def _doors(halls: list[str], rooms: list[str], random: Random) -> list[tuple[str, str]]:
    connections = []
    for i, room in enumerate(rooms):
        behind = i > 0 and random.random() < _ROOM_BEHIND_ROOM
        place = rooms[random.randrange(i)] if behind else halls[random.randrange(len(halls))]
        connections.append((room, place))
    return connections


def _extra(
    locations: list[str], tree: list[tuple[str, str]], wanted: int, random: Random
) -> list[tuple[str, str]]:
    taken = {frozenset(pair) for pair in tree}
    extra: list[tuple[str, str]] = []
    if wanted * 4 > len(locations) ** 2:  # dense: drawing at random would repeat itself
        pairs = [(a, b) for i, a in enumerate(locations) for b in locations[i + 1 :]]
        free = [pair for pair in pairs if frozenset(pair) not in taken]
        return random.sample(free, wanted)
    while len(extra) < wanted:
        pair = (locations[random.randrange(len(locations))], locations[random.randrange(len(locations))])
        if pair[0] != pair[1] and frozenset(pair) not in taken:
            taken.add(frozenset(pair))
            extra.append(pair)
    return extra


HUMAN: Final = "commx"


@dataclass(frozen=True, slots=True)
class Usar:
    """A building, its agents, its medkits, and where the human has to conduct triage.

    Attributes:
        robots: names of the robots; the human is ``commx``.
        agents_at: location of each agent, the human first.
        medkits_at: location of each medkit: ``mk1``, ``mk2``...

    Raises:
        UsageError: a location is not in the building, or positions and agents differ in number.
    """

    name: str
    building: Building
    robots: tuple[str, ...]
    agents_at: tuple[str, ...]
    medkits_at: tuple[str, ...]
    triage_in: str

    def __post_init__(self) -> None:
        if len(self.agents_at) != len(self.robots) + 1:
            raise UsageError("usar: expected one position for each agent")
        known = set(self.building.locations)
        for place in (*self.agents_at, *self.medkits_at, self.triage_in):
            if place not in known:
                raise UsageError(f"usar: there is no location '{place}' in the building")

    @property
    def agents(self) -> dict[str, str]:
        """Location of each agent by name, the human first."""
        return dict(zip((HUMAN, *self.robots), self.agents_at, strict=True))

    @property
    def medkits(self) -> dict[str, str]:
        """Location of each medkit by name."""
        return {f"mk{i}": place for i, place in enumerate(self.medkits_at, start=1)}


_DOMAIN: Final = Path(__file__).parent / "data" / "usar" / "domain.pddl"
"""The domain of all agents; blank lines separate its head and its actions, and hand-over is the last."""


def pddl_files(task: Usar, layout: str = "agents") -> dict[str, str]:
    """The PDDL texts of a task by path in its folder; a UsageError where there is no such layout."""
    require_one_of("layout", layout, LAYOUTS)
    return LAYOUTS[layout](task)


def _pair(task: Usar) -> dict[str, str]:
    return {
        "domain.pddl": _DOMAIN.read_text(encoding="utf-8"),
        "problem.pddl": _problem(task, "usar", task.agents),
    }


def _folders(task: Usar) -> dict[str, str]:
    files: dict[str, str] = {}
    for agent, place in task.agents.items():
        files[f"{agent}/domain.pddl"] = _own_domain(agent)
        files[f"{agent}/problem.pddl"] = _problem(task, f"usar-{agent}", {agent: place})
    return files | {f"superagent/{path}": text for path, text in _pair(task).items()}


LAYOUTS: Final[dict[str, Callable[[Usar], dict[str, str]]]] = {"agents": _folders, "pair": _pair}
"""``agents``, the default: a folder per agent and ``superagent/``.  ``pair``: one domain and
one problem, agents are objects."""


def _own_domain(agent: str) -> str:
    """The domain of what one agent can do alone, which compares no objects."""
    head, *actions, _ = _DOMAIN.read_text(encoding="utf-8").split("\n\n")
    head = head.replace("usar", f"usar-{agent}").replace(" :equality :negative-preconditions", "")
    own = [action for action in actions if agent == HUMAN or "conduct_triage" not in action]
    return "\n\n".join([head, *own]) + ")\n"


def _problem(task: Usar, domain: str, agents: dict[str, str]) -> str:
    """The problem as these agents know it; the goal is the human's."""
    lines = [f"(define (problem {task.name})", f"  (:domain {domain})", "  (:objects"]
    for kind, names in (
        ("location", task.building.locations),
        ("medkit", task.medkits),
        ("machine", [agent for agent in agents if agent != HUMAN]),
        ("person", [agent for agent in agents if agent == HUMAN]),
    ):
        lines += _wrapped(names, last=f"- {kind}")
    lines += ["  )", "  (:init"]
    lines += [f"    (connected {a} {b})" for a, b in task.building.connections]
    lines += [f"    (at {what} {place})" for what, place in (agents | task.medkits).items()]
    goal = f" (conducted_triage {HUMAN} {task.triage_in})" if HUMAN in agents else ""
    return "\n".join([*lines, "  )", f"  (:goal (and{goal})))"]) + "\n"


def _wrapped(names: Iterable[str], *, last: str, width: int = 12) -> list[str]:
    """Names over lines of ``width`` words, indented, closed by ``last``; none for no names."""
    words = list(names)
    if not words:
        return []
    words.append(last)
    return ["    " + " ".join(words[i : i + width]) for i in range(0, len(words), width)]
