"""Builders of small tasks in Python, from readable text; no PDDL is involved.

A literal is a fact's name, with ``!`` in front for its negation.  Names of facts
in ``task`` are single words; those of ``usar`` are PDDL atoms (``at h a0``).
"""

from collections.abc import Iterable, Mapping
from fractions import Fraction
from itertools import pairwise, permutations
from typing import NamedTuple

from serendipity.model import Condition, GroundAction, Task, Timing


class Builder:
    """A task put together action by action, with facts by name, numbered as they come up.

    Args:
        agents: their names; an agent's id is its index.
        separator: between literals; None for blanks.
        alphabetical: whether facts are numbered in the order of their names instead.
    """

    def __init__(
        self,
        agents: tuple[str, ...],
        name: str = "random",
        separator: str | None = None,
        *,
        alphabetical: bool = False,
    ) -> None:
        self.agents = agents
        self._name = name
        self._separator = separator
        self._alphabetical = alphabetical
        self._facts: dict[str, None] = {}
        self._actions: list[_Action] = []

    def action(self, name: str, agents: tuple[int, ...], pre: str, effects: str, cost: str) -> None:
        """Add an action whose name ends in its agents'."""
        self.named(" ".join((name, *(self.agents[i] for i in agents))), agents, pre, effects, cost)

    def named(
        self, name: str, agents: tuple[int, ...], pre: str, effects: str, cost: str = "1", duration: int = 1
    ) -> None:
        """Add an action of that very name.

        Args:
            pre: precondition literals; of an action of several epochs ``at start / over all / at end``.
            effects: effect literals; of an action of several epochs ``at start / at end``, or at end alone.
            duration: in epochs.
        """
        conditions = [*map(self._words, pre.split("/")), ([], []), ([], [])][:3]
        changes = [([], []), *map(self._words, effects.split("/"))][-2:]
        self._actions.append(_Action(name, agents, conditions, changes, Fraction(cost), duration))

    def task(self, init: str, goal: str, robot_goal: str = "", human: int = 0) -> Task:
        """All actions so far as a task.

        Args:
            init: names of the facts that are true.
            goal: literals of ``G_H``.
            robot_goal: literals of ``G_R``.
            human: id of the human.
        """
        wanted, theirs = self._words(goal), self._words(robot_goal)
        start, _ = self._words(init)
        facts = sorted(self._facts) if self._alphabetical else [*self._facts]
        ids = {fact: i for i, fact in enumerate(facts)}

        def numbers(words: list[str], but: tuple[int, ...] = ()) -> tuple[int, ...]:
            return tuple(sorted({ids[word] for word in words}.difference(but)))

        ground = []
        for name, who, conditions, changes, cost, duration in self._actions:
            pre, over, end = (Condition(numbers(true), numbers(false)) for true, false in conditions)
            sooner, later = ((add := numbers(true), numbers(false, add)) for true, false in changes)
            timing = None if duration == 1 else Timing(duration, over, end, *sooner)
            ground.append(GroundAction(name, who, pre.positive, pre.negative, *later, cost, timing))
        return Task(
            name=self._name,
            agents=self.agents,
            human=human,
            facts=tuple(facts),
            init=frozenset(numbers(start)),
            goal=Condition(*map(numbers, wanted)),
            robot_goal=Condition(*map(numbers, theirs)),
            actions=tuple(sorted(ground, key=lambda action: action.key)),
        )

    def _words(self, text: str) -> "_Words":
        """The facts that literals want to be true, and to be false."""
        words = [word.strip() for word in text.split(self._separator) if word.strip()]
        found = [w for w in words if w[0] != "!"], [w[1:] for w in words if w[0] == "!"]
        self._facts.update(dict.fromkeys((*found[0], *found[1])))
        return found


_Words = tuple[list[str], list[str]]


class _Action(NamedTuple):
    name: str
    agents: tuple[int, ...]
    conditions: list[_Words]
    changes: list[_Words]
    cost: Fraction
    duration: int


def task(
    *,
    agents: str = "h r",
    human: str = "h",
    init: str = "",
    goal: str = "",
    robot_goal: str = "",
    actions: Mapping[str, str],
    name: str = "built",
) -> Task:
    """A task from text.

    Args:
        agents: names, separated by blanks.
        human: the human's name.
        init: facts true initially.
        goal: literals of ``G_H``.
        robot_goal: literals of ``G_R``.
        actions: by name, e.g. ``{"do h": "p !q -> r !p @ 3"}``: precondition literals,
            ``->``, effect literals, ``@`` and the cost (1 without one).  Participants are
            the agents among the words of the name.  ``|`` stands between variants of one action.
            ``"p / q / q -> !p / r @ 3 [4]"`` takes 4 epochs: conditions at start, over all and at end,
            effects at start and at end (of fewer, the first conditions and the last effects).

    Facts are all words that occur, in alphabetical order.
    """
    builder = Builder(tuple(agents.split()), name, alphabetical=True)
    for key, texts in actions.items():
        who = tuple(i for i, agent in enumerate(builder.agents) if agent in key.split())
        for text in texts.split("|"):
            builder.named(key, who, *_parsed(text))
    return builder.task(init, goal, robot_goal, builder.agents.index(human))


def usar(
    edges: str,
    *,
    human: str,
    robots: Mapping[str, str],
    kits: Mapping[str, str],
    triage: str,
    human_name: str = "h",
    delivered: bool = True,
    triage_everywhere: bool = True,
) -> Task:
    """A task with the USAR schemas (semantics 5), one ``move``, unit costs.

    Args:
        edges: undirected connections, e.g. ``"a-b-c b-s"``; a chain is several.
        human: their room.
        robots: room by robot's name.
        kits: room by medkit's name; ``"@rob"`` for one that agent ``rob`` holds.
        triage: the goal's room.
        delivered: whether dropping records the fact ``delivered``.
        triage_everywhere: whether triage can be conducted in other rooms too.

    As in the authors' files, ``loc_has_medkit`` is false initially.
    """
    pairs = _pairs(edges)
    rooms = sorted({room for pair in pairs for room in pair} | {human, triage})
    agents = (human_name, *robots)
    actions: dict[str, tuple[tuple[str, ...], str, str]] = {}
    for agent in agents:
        for a, b in pairs:
            actions[f"move {agent} {a} {b}"] = (
                (agent,),
                f"at {agent} {a}",
                f"at {agent} {b}, !at {agent} {a}",
            )
        for kit in kits:
            for room in rooms:
                _handling(actions, agent, kit, room, delivered=delivered)
    for giver, taker in permutations(agents, 2):
        for kit in kits:
            for room in rooms:
                actions[f"hand_over {giver} {taker} {kit} {room}"] = (
                    (giver, taker),
                    f"has_medkit {giver}, has {giver} {kit}, at {taker} {room}, at {giver} {room}",
                    f"has_medkit {taker}, has {taker} {kit}, !has {giver} {kit}, !has_medkit {giver}",
                )
    for room in rooms if triage_everywhere else [triage]:
        actions[f"conduct_triage {human_name} {room}"] = (
            (human_name,),
            f"has_medkit {human_name}, at {human_name} {room}",
            f"conducted_triage {human_name} {room}",
        )
    init = [f"at {human_name} {human}", *(f"at {robot} {room}" for robot, room in robots.items())]
    for kit, place in kits.items():
        holder = place.removeprefix("@")
        init += [f"has {holder} {kit}", f"has_medkit {holder}"] if place[0] == "@" else [f"at {kit} {place}"]
    return _atom_task(agents, init, f"conducted_triage {human_name} {triage}", actions)


def _handling(
    actions: dict[str, tuple[tuple[str, ...], str, str]], agent: str, kit: str, room: str, *, delivered: bool
) -> None:
    record = f", delivered {agent} {kit} {room}" if delivered else ""
    actions[f"pick_up_medkit {agent} {kit} {room}"] = (
        (agent,),
        f"at {kit} {room}, at {agent} {room}",
        f"has_medkit {agent}, has {agent} {kit}, !at {kit} {room}, !loc_has_medkit {room}",
    )
    actions[f"drop_off {agent} {kit} {room}"] = (
        (agent,),
        f"has {agent} {kit}, at {agent} {room}",
        f"loc_has_medkit {room}, at {kit} {room}, !has {agent} {kit}, !has_medkit {agent}{record}",
    )


def _atom_task(
    agents: tuple[str, ...],
    init: Iterable[str],
    goal: str,
    actions: Mapping[str, tuple[tuple[str, ...], str, str]],
) -> Task:
    builder = Builder(agents, "usar", ",", alphabetical=True)
    for key, (who, pre, effects) in actions.items():
        builder.named(key, tuple(sorted(map(agents.index, who))), pre, effects)
    return builder.task(",".join(init), goal)


def _pairs(edges: str) -> list[tuple[str, str]]:
    """Both directions of each connection."""
    pairs = []
    for chain in edges.replace(",", " ").split():
        rooms = chain.split("-")
        for a, b in pairwise(rooms):
            pairs += [(a, b), (b, a)]
    return pairs


def _parsed(text: str) -> tuple[str, str, str, int]:
    text, _, duration = text.partition("[")
    body, _, cost = text.partition("@")
    pre, arrow, effects = body.partition("->")
    if not arrow:
        raise ValueError(f"expected 'precondition -> effects', got {text!r}")
    return pre, effects, cost.strip() or "1", int(duration.strip(" ]") or 1)
