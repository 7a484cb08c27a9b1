"""Builders of small tasks in Python, from readable text; no PDDL is involved.

A literal is a fact's name, with ``!`` in front for its negation.  Names of facts
in ``task`` are single words; those of ``usar`` are PDDL atoms (``at h a0``).
"""

from collections.abc import Iterable, Mapping
from fractions import Fraction
from itertools import pairwise, permutations

from serendipity.model import Condition, GroundAction, Task


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

    Facts are all words that occur, in alphabetical order.
    """
    roster = tuple(agents.split())
    specs = [(key, *_parse_action(text)) for key, texts in actions.items() for text in texts.split("|")]
    words: set[str] = set(init.split()) | _atoms(goal) | _atoms(robot_goal)
    for _, pre, effects, _ in specs:
        words |= _atoms(pre) | _atoms(effects)
    facts = tuple(sorted(words))
    ids = {fact: i for i, fact in enumerate(facts)}
    ground = []
    for key, pre, effects, cost in specs:
        participants = tuple(i for i, agent in enumerate(roster) if agent in key.split())
        ground.append(_action(key, participants, _condition(pre, ids), _condition(effects, ids), cost))
    return Task(
        name=name,
        agents=roster,
        human=roster.index(human),
        facts=facts,
        init=frozenset(ids[word] for word in init.split()),
        goal=_condition(goal, ids),
        robot_goal=_condition(robot_goal, ids),
        actions=tuple(sorted(ground, key=lambda action: action.key)),
    )


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
    words = {goal, *init}
    for _, pre, effects in actions.values():
        words |= {text.strip().removeprefix("!") for text in f"{pre}, {effects}".split(",")}
    facts = tuple(sorted(words))
    ids = {fact: i for i, fact in enumerate(facts)}
    ground = [
        _action(
            key,
            tuple(sorted(agents.index(agent) for agent in who)),
            _condition(pre, ids, ","),
            _condition(effects, ids, ","),
            Fraction(1),
        )
        for key, (who, pre, effects) in actions.items()
    ]
    return Task(
        name="usar",
        agents=agents,
        human=0,
        facts=facts,
        init=frozenset(ids[fact] for fact in init),
        goal=_condition(goal, ids, ","),
        actions=tuple(sorted(ground, key=lambda action: action.key)),
    )


def _pairs(edges: str) -> list[tuple[str, str]]:
    """Both directions of each connection."""
    pairs = []
    for chain in edges.replace(",", " ").split():
        rooms = chain.split("-")
        for a, b in pairwise(rooms):
            pairs += [(a, b), (b, a)]
    return pairs


def _parse_action(text: str) -> tuple[str, str, Fraction]:
    body, _, cost = text.partition("@")
    pre, arrow, effects = body.partition("->")
    if not arrow:
        raise ValueError(f"expected 'precondition -> effects', got {text!r}")
    return pre, effects, Fraction(cost.strip() or 1)


def _atoms(literals: str) -> set[str]:
    return {word.removeprefix("!") for word in literals.split()}


def _condition(literals: str, ids: Mapping[str, int], separator: str | None = None) -> Condition:
    words = [word.strip() for word in literals.split(separator) if word.strip()]
    return Condition(
        tuple(sorted({ids[word] for word in words if word[0] != "!"})),
        tuple(sorted({ids[word[1:]] for word in words if word[0] == "!"})),
    )


def _action(
    name: str, participants: tuple[int, ...], pre: Condition, effects: Condition, cost: Fraction
) -> GroundAction:
    delete = tuple(f for f in effects.negative if f not in effects.positive)
    return GroundAction(name, participants, pre.positive, pre.negative, effects.positive, delete, cost)
