"""Small tasks: random actions, walks, buildings, errands, families."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from random import Random
from typing import Final

from hypothesis import strategies as st

from serendipity.model import Condition, Task
from serendipity.testing.builders import task as build
from serendipity.testing.builders import usar
from serendipity.testing.generator.families import AGENTS, FAMILIES, SMALL
from serendipity.testing.generator.numbers import oddly_priced
from serendipity.testing.oracle import Alone

COSTS: Final = ("1", "1", "1", "2", "3", "4", "0", "0.5", "0.1", "2.5")
_CHEAP: Final = ("1", "1", "0.5", "0.1", "0")


@st.composite
def strips_tasks(
    draw: st.DrawFn,
    *,
    facts: tuple[int, int] = (3, 7),
    robots: tuple[int, int] = (1, 2),
    costs: Sequence[str] = COSTS,
) -> Task:
    """Random actions, negative preconditions included, joint actions, and goals that can mostly be reached.

    Args:
        facts: how many, from and to; at least 3.
        robots: how many, from and to; at most 2.
        costs: what the human's and joint actions may cost.
    """
    names = [f"f{i}" for i in range(draw(st.integers(*facts)))]
    agents = ["h", "r", "q"][: 1 + draw(st.integers(*robots))]
    actions: dict[str, str] = {}
    for k in range(draw(st.integers(2, 6))):
        actions[f"a{k} h"] = draw(_varied(_action_texts(names, most_needs=2, costs=costs), names))
    for robot in agents[1:]:
        for k in range(draw(st.integers(1, 4))):
            actions[f"b{k} {robot}"] = draw(_action_texts(names, most_needs=1, costs=_CHEAP))
    for k in range(draw(st.integers(0, 2))):
        team = draw(st.sampled_from(_teams(agents)))
        actions[f"c{k} {' '.join(team)}"] = draw(_action_texts(names, most_needs=1, costs=costs))
    init = draw(st.lists(st.sampled_from(names), max_size=3, unique=True))
    built = build(agents=" ".join(agents), init=" ".join(init), actions=actions)
    return draw(_with_goals(built))


@st.composite
def corridor_tasks(draw: st.DrawFn) -> Task:
    """A human who walks between places; robots open shortcuts, block ways or carry them."""
    places = [f"p{i}" for i in range(draw(st.integers(3, 5)))]
    agents = ["h", "r", "q"][: draw(st.sampled_from([2, 2, 3]))]
    actions: dict[str, str] = {}
    for i, (a, b) in enumerate(pairwise(places)):
        cost = draw(st.sampled_from(["1", "2", "3"]))
        blocked = " !blocked" if draw(st.integers(0, 4)) == 0 else ""
        actions[f"walk{i} h"] = f"{a}{blocked} -> {b} !{a} @ {cost}"
        if draw(st.integers(0, 3)) == 0:
            actions[f"walk{i}b h"] = f"{a} -> {b} !{a} @ {cost}"
        if draw(st.booleans()):
            actions[f"back{i} h"] = f"{b} -> {a} !{b} @ {cost}"
    for k in range(draw(st.integers(1, 2))):
        a, b = draw(_ordered_pairs(places))
        actions[f"jump{k} h"] = f"{a} open{k} -> {b} !{a} @ {draw(st.sampled_from(_CHEAP))}"
        actions[f"open{k} {draw(st.sampled_from(agents[1:]))}"] = (
            f"{draw(st.sampled_from(['', 'ready', '!tired']))} -> open{k} @ {draw(st.sampled_from(COSTS))}"
        )
    for robot in agents[1:]:
        effect = draw(st.sampled_from(["ready", "blocked", "!blocked", "!ready tired", "open0", "!open0"]))
        actions[f"prepare {robot}"] = f" -> {effect} @ {draw(st.sampled_from(_CHEAP))}"
    if draw(st.booleans()):
        a, b = draw(_ordered_pairs(places))
        team = draw(st.sampled_from(_teams(agents)))
        effect = f"{b} !{a}" if "h" in team else "open0"
        actions[f"carry {' '.join(team)}"] = f"{a} -> {effect} @ {draw(st.sampled_from(COSTS))}"
    init = [places[0], *draw(st.lists(st.sampled_from(["ready", "blocked", "tired"]), max_size=1))]
    built = build(agents=" ".join(agents), init=" ".join(init), goal=places[-1], actions=actions)
    return draw(_with_robot_goal(built))


@st.composite
def usar_tasks(draw: st.DrawFn) -> Task:
    """USAR on a random tree or cycle of 3-5 rooms with 1-2 medkits and 1-2 robots."""
    robots = ["rob", "bot"][: draw(st.sampled_from([1, 1, 1, 2]))]
    count = draw(st.integers(3, 5 if len(robots) == 1 else 3))
    rooms = [f"p{i}" for i in range(count)]
    edges = [f"{rooms[draw(st.integers(0, i - 1))]}-{rooms[i]}" for i in range(1, count)]
    if draw(st.integers(0, 3)) == 0:
        edges.append("-".join(draw(_ordered_pairs(rooms))))
    kits = ["k1", "k2"][: draw(st.integers(1, 2 if len(robots) == 1 and count < 5 else 1))]
    place = st.sampled_from(rooms)
    spots = {kit: draw(st.one_of(place, place, place, st.just(f"@{robots[0]}"))) for kit in kits[:1]}
    spots |= {kit: draw(place) for kit in kits[1:]}
    return usar(
        " ".join(edges),
        human=draw(place),
        robots={robot: draw(place) for robot in robots},
        kits=spots,
        triage=draw(place),
        delivered=False,
        triage_everywhere=False,
    )


@st.composite
def errand_tasks(draw: st.DrawFn) -> Task:
    """Two robots in a building of their own: they walk, push together, and do what helps or hinders."""
    agents, actions = ["h", "r", "q"], dict[str, str]()
    places = [f"p{i}" for i in range(draw(st.integers(2, 4)))]
    for i, (a, b) in enumerate(pairwise(places)):
        actions[f"walk{i} h"] = f"{a} -> {b} !{a} @ {draw(st.sampled_from(['1', '2', '3']))}"
    rooms = ["0", "1", "2"][: draw(st.integers(2, 3))]
    start = [places[0]]
    for mover in draw(st.lists(st.sampled_from(["r", "q", "r q"]), min_size=1, max_size=2, unique=True)):
        thing = mover.replace(" ", "")
        start.append(f"{thing}{draw(st.sampled_from(rooms))}")
        step = draw(st.sampled_from(_CHEAP))
        for a, b in pairwise(rooms):
            for here, there in ((a, b), (b, a)):
                actions[f"go{here}{there} {mover}"] = (
                    f"{thing}{here} -> {thing}{there} !{thing}{here} @ {step}"
                )
        for k in range(draw(st.integers(1, 2))):
            needs = draw(st.sampled_from(["", "", "ready", "!tired", "box"]))
            effect = draw(st.sampled_from(["open0", "open0", "open1", "ready", "box !ready", "open1 tired"]))
            cost = draw(st.sampled_from(COSTS))
            actions[f"deed{k} {mover}"] = (
                f"{thing}{draw(st.sampled_from(rooms))} {needs} -> {effect} @ {cost}"
            )
    for k in range(2):
        a, b = draw(_ordered_pairs(places))
        actions[f"jump{k} h"] = f"{a} open{k} -> {b} !{a} @ {draw(st.sampled_from(_CHEAP))}"
    init = " ".join([*start, *draw(st.lists(st.sampled_from(["ready", "tired", "box"]), max_size=1))])
    built = build(agents=" ".join(agents), init=init, goal=places[-1], actions=actions)
    return draw(_with_robot_goal(built))


@st.composite
def family_tasks(
    draw: st.DrawFn,
    *,
    families: Sequence[str] = tuple(sorted(FAMILIES)),
    sizes: Sequence[tuple[int, int]] | None = None,
) -> Task:
    """Goals on what robots change, too.  A seed decides all but the size.

    Args:
        families: some of ``blocks``, ``logistics`` and ``switches``.
        sizes: numbers of blocks, parcels or switches, each with a number of agents (2 or 3); None takes
            sizes that brute force answers.
    """
    family = draw(st.sampled_from(families))
    size, agents = draw(st.sampled_from(SMALL[family] if sizes is None else sizes))
    return FAMILIES[family](Random(draw(st.integers(0, 10**9))), size, AGENTS[:agents])


@st.composite
def oddly_priced_tasks(draw: st.DrawFn) -> Task:
    """Tasks with costs that are hard to add up: long denominators, huge ones, both in one task."""
    task = draw(st.one_of(strips_tasks(), corridor_tasks(), errand_tasks()))
    return oddly_priced(Random(draw(st.integers(0, 10**9))), task)


def tasks() -> st.SearchStrategy[Task]:
    """Any small task."""
    return st.one_of(
        strips_tasks(), corridor_tasks(), corridor_tasks(), usar_tasks(), errand_tasks(), family_tasks()
    )


def _teams(agents: list[str]) -> list[list[str]]:
    teams = [["h", "r"]]
    if len(agents) > 2:
        teams += [["h", "q"], ["q", "r"], ["h", "q", "r"]]
    return teams


@st.composite
def _ordered_pairs(draw: st.DrawFn, things: list[str]) -> tuple[str, str]:
    first = draw(st.integers(0, len(things) - 2))
    return things[first], things[draw(st.integers(first + 1, len(things) - 1))]


@st.composite
def _action_texts(draw: st.DrawFn, facts: list[str], *, most_needs: int, costs: Sequence[str]) -> str:
    fact = st.sampled_from(facts)
    needs = draw(st.lists(fact, max_size=most_needs, unique=True))
    pre = [("!" if draw(st.integers(0, 3)) == 0 else "") + name for name in needs]
    adds = draw(st.lists(fact, min_size=1, max_size=2, unique=True))
    deletes = draw(st.lists(fact, max_size=1))
    effects = [*adds, *(f"!{name}" for name in deletes if name not in adds)]
    return f"{' '.join(pre)} -> {' '.join(effects)} @ {draw(st.sampled_from(costs))}"


@st.composite
def _varied(draw: st.DrawFn, texts: st.SearchStrategy[str], facts: list[str]) -> str:
    """An action; now and then as two variants, by what it asks for or by what it does."""
    text = draw(texts)
    kind = draw(st.integers(0, 11))
    if kind > 1:
        return text
    body, _, cost = text.partition(" @ ")
    pre, _, effects = body.partition(" -> ")
    fact = draw(st.sampled_from(facts))
    if kind == 0:  # (or ...)
        return f"{text} | {fact} -> {effects} @ {cost}"
    others = [name for name in facts if name not in effects.replace("!", "").split()]
    if not others or fact in pre.replace("!", "").split():
        return text
    more = draw(st.sampled_from(others))  # (when ...)
    return f"{pre} {fact} -> {effects} {more} @ {cost} | {pre} !{fact} -> {effects} @ {cost}"


@st.composite
def walks(draw: st.DrawFn, built: Task, most: int) -> frozenset[int]:
    """The state after a random walk of the human's, alone.

    Args:
        most: actions, at least one where any changes anything.
    """
    state, alone = built.init, Alone(built)
    for _ in range(draw(st.integers(1, most))):
        ways = [way for way in alone.successors(state) if way[1] != state]
        if not ways:
            break
        state = draw(st.sampled_from(ways))[1]
    return state


@st.composite
def _with_goals(draw: st.DrawFn, built: Task) -> Task:
    """A human goal that a random walk of the human's reaches (now and then any literal at all)."""
    state = draw(walks(built, 5))
    changed = sorted(state ^ built.init)
    facts = changed if changed and draw(st.integers(0, 9)) > 0 else list(range(len(built.facts)))
    chosen = draw(st.lists(st.sampled_from(facts), min_size=1, max_size=2, unique=True))
    goal = Condition(
        tuple(f for f in sorted(chosen) if f in state), tuple(f for f in sorted(chosen) if f not in state)
    )
    return draw(_with_robot_goal(replace(built, goal=goal)))


@st.composite
def _with_robot_goal(draw: st.DrawFn, built: Task) -> Task:
    """Sometimes a goal of the robots' own on a fact that they change; it may hold already."""
    if draw(st.integers(0, 4)):
        return built
    theirs = {f for a in built.actions if built.human not in a.participants for f in (*a.add, *a.delete)}
    facts = sorted(theirs - set(built.goal.positive) - set(built.goal.negative))
    if not facts:
        return built
    fact, reached = draw(st.sampled_from(facts)), draw(st.integers(0, 4)) == 0
    wanted = Condition((fact,), ()) if (fact in built.init) == reached else Condition((), (fact,))
    return replace(built, robot_goal=wanted)
