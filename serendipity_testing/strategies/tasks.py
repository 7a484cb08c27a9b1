"""Small tasks: random actions, walks, buildings, errands, families."""

from collections.abc import Sequence
from dataclasses import replace
from random import Random
from typing import Final

from hypothesis import strategies as st

from serendipity.model import Condition, Task
from serendipity_testing.builders import usar
from serendipity_testing.generator.families import AGENTS, FAMILIES, SMALL
from serendipity_testing.generator.numbers import oddly_priced
from serendipity_testing.generator.tasks import COSTS, corridor, errands, strips, varied
from serendipity_testing.oracle import Alone, Moment

DICE: Final = st.randoms(use_true_random=False)
"""They shrink what is made of them."""


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
        robots: how many, from and to; at most 3.
        costs: what the human's and joint actions may cost.
    """
    dice = draw(DICE)
    built = strips(dice, facts, range(robots[0] + 1, robots[1] + 2), costs)
    return varied(dice, draw(_with_goals(built)))


def corridor_tasks() -> st.SearchStrategy[Task]:
    """A human who walks between places; robots open shortcuts, block ways or carry them."""
    return DICE.map(lambda dice: varied(dice, corridor(dice)))


def errand_tasks() -> st.SearchStrategy[Task]:
    """Two robots in a building of their own: they walk, push together, and do what helps or hinders."""
    return DICE.map(lambda dice: varied(dice, errands(dice)))


@st.composite
def usar_tasks(draw: st.DrawFn) -> Task:
    """USAR on a random tree or cycle of 3-5 rooms with 1-2 medkits and 1-2 robots."""
    robots = ["rob", "bot"][: draw(st.sampled_from([1, 1, 1, 2]))]
    count = draw(st.integers(3, 5 if len(robots) == 1 else 3))
    rooms = [f"p{i}" for i in range(count)]
    edges = [f"{rooms[draw(st.integers(0, i - 1))]}-{rooms[i]}" for i in range(1, count)]
    if draw(st.integers(0, 3)) == 0:
        edges.append(f"{rooms[0]}-{draw(st.sampled_from(rooms[1:]))}")
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


@st.composite
def walks(draw: st.DrawFn, built: Task, most: int) -> frozenset[int]:
    """The state after a random walk of the human's alone: at least an action, if any changes anything."""
    now, alone = Moment(built.init), Alone(built)
    for _ in range(draw(st.integers(1, most))):
        ways = [way.moment for way in alone.ways(now) if way.moment != now]
        if not ways:
            break
        now = draw(st.sampled_from(ways))
    return now.state


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
    return replace(built, goal=goal)
