"""Seeded tasks of eight kinds for ablations: work that the human could do alone, and robots could ease.

Each kind is a function of dice and a size; nothing else about the planner was ever decided by them.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise
from random import Random
from typing import Final

from serendipity import Task
from serendipity.testing.builders import task

ROBOTS: Final = ("r", "s")

Actions = dict[str, str]


def _tree(dice: Random, places: int) -> list[tuple[int, int]]:
    """The edges of a random tree."""
    return [(dice.randrange(place), place) for place in range(1, places)]


def _walks(
    agents: Sequence[str], edges: Sequence[tuple[int, int]], needs: Callable[[int, int], str]
) -> Actions:
    """Everybody walks along edges, where what an edge needs holds."""
    return {
        f"go_{agent}_{a}_{b} {agent}": f"at_{agent}_{a} {needs(a, b)} -> at_{agent}_{b} !at_{agent}_{a}"
        for agent in agents
        for one, other in edges
        for a, b in ((one, other), (other, one))
    }


def _beside(places: int) -> list[tuple[int, int]]:
    """Places in a row, and those beside them."""
    return [(a, b) for a in range(places) for b in (a - 1, a + 1) if 0 <= b < places]


def _free(_: int, __: int) -> str:
    return ""


def kitchen(dice: Random, size: int) -> Task:
    """Things out of cupboards, which have to be opened, onto the table; each agent carries one."""
    agents, edges = ("h", *ROBOTS), _tree(dice, 4)
    actions = _walks(agents, edges, _free)
    where = [dice.randrange(1, 4) for _ in range(size)]
    for agent in agents:
        for place in range(1, 4):
            actions[f"open_{agent}_{place} {agent}"] = f"at_{agent}_{place} !open_{place} -> open_{place}"
        for thing, place in enumerate(where):
            actions[f"take_{agent}_{thing} {agent}"] = (
                f"at_{agent}_{place} open_{place} in_{thing} empty_{agent} "
                f"-> has_{agent}_{thing} !in_{thing} !empty_{agent}"
            )
            actions[f"put_{agent}_{thing} {agent}"] = (
                f"at_{agent}_0 has_{agent}_{thing} -> on_{thing} !has_{agent}_{thing} empty_{agent}"
            )
    init = [f"at_{a}_{dice.randrange(4)} empty_{a}" for a in agents] + [f"in_{t}" for t in range(size)]
    return _made(agents, init, [f"on_{thing}" for thing in range(size)], actions)


def doors(dice: Random, size: int) -> Task:
    """A tree of rooms with locked doors, whose keys lie about; the human has to look into some of them."""
    agents, edges = ("h", *ROBOTS), _tree(dice, size + 3)
    locked = dice.sample(edges[1:], k=max(1, size // 2))

    def needs(a: int, b: int) -> str:
        return f"open_{max(a, b)}" if (min(a, b), max(a, b)) in locked else ""

    actions = _walks(agents, edges, needs)
    behind = {b for _, b in locked}
    start = [room for room in range(size + 3) if not _is_behind(room, edges, behind)]
    keys = {door: dice.choice(start) for door in behind}
    for agent in agents:
        for (a, b), door in [(edge, edge[1]) for edge in locked]:
            actions[f"take_{agent}_{door} {agent}"] = (
                f"at_{agent}_{keys[door]} key_{door} -> has_{agent}_{door} !key_{door}"
            )
            for side in (a, b):
                actions[f"unlock_{agent}_{door}_{side} {agent}"] = (
                    f"at_{agent}_{side} has_{agent}_{door} -> open_{door} @ 2"
                )
    looked = dice.sample(range(1, size + 3), k=min(3, size))
    for room in looked:
        actions[f"look_{room} h"] = f"at_h_{room} -> seen_{room}"
    init = [f"at_{agent}_{dice.choice(start)}" for agent in agents] + [f"key_{door}" for door in behind]
    return _made(agents, init, [f"seen_{room}" for room in looked], actions)


def _is_behind(room: int, edges: Sequence[tuple[int, int]], doors: set[int]) -> bool:
    above = {b: a for a, b in edges}
    while room:
        if room in doors:
            return True
        room = above[room]
    return False


def assembly(dice: Random, size: int) -> Task:
    """Parts are cut, drilled and painted, in their order, with tools of which there is one each."""
    agents, stages = ("h", *ROBOTS), ("raw", "cut", "drilled", "painted")
    actions: Actions = {}
    for agent in agents:
        for tool in stages[1:]:
            actions[f"pick_{agent}_{tool} {agent}"] = (
                f"{tool}_there empty_{agent} -> {tool}_{agent} !{tool}_there !empty_{agent}"
            )
            actions[f"lay_{agent}_{tool} {agent}"] = (
                f"{tool}_{agent} -> {tool}_there empty_{agent} !{tool}_{agent}"
            )
            for part in range(size):
                before = stages[stages.index(tool) - 1]
                actions[f"do_{agent}_{tool}_{part} {agent}"] = (
                    f"{tool}_{agent} {before}_p{part} -> {tool}_p{part} !{before}_p{part} @ 2"
                )
    init = [f"{tool}_there" for tool in stages[1:]] + [f"empty_{agent}" for agent in agents]
    init += [f"{dice.choice(stages[:2])}_p{part}" for part in range(size)]
    return _made(agents, init, [f"painted_p{part}" for part in range(size)], actions)


def garden(dice: Random, size: int) -> Task:
    """Beds along a path are weeded and watered; a can holds water for one, and is filled at the tap."""
    agents, edges = ("h", *ROBOTS), list(pairwise(range(size + 1)))
    actions = _walks(agents, edges, _free)
    for agent in agents:
        actions[f"fill_{agent} {agent}"] = f"at_{agent}_0 dry_{agent} -> full_{agent} !dry_{agent}"
        for bed in range(1, size + 1):
            actions[f"weed_{agent}_{bed} {agent}"] = (
                f"at_{agent}_{bed} wild_{bed} -> clean_{bed} !wild_{bed} @ 2"
            )
            actions[f"water_{agent}_{bed} {agent}"] = (
                f"at_{agent}_{bed} clean_{bed} full_{agent} -> wet_{bed} dry_{agent} !full_{agent}"
            )
    init = [f"at_{agent}_{dice.randrange(size + 1)} dry_{agent}" for agent in agents]
    init += [dice.choice(("wild", "wild", "clean")) + f"_{bed}" for bed in range(1, size + 1)]
    return _made(agents, init, [f"wet_{bed}" for bed in range(1, size + 1)], actions)


def library(dice: Random, size: int) -> Task:
    """Books go back to their shelves along an aisle; there is one trolley, which holds any number."""
    agents, places = ("h", *ROBOTS), 4
    actions = _walks(agents, list(pairwise(range(places))), _free)
    home = [dice.randrange(1, places) for _ in range(size)]
    for agent in agents:
        for a, b in _beside(places):
            actions[f"push_{agent}_{a}_{b} {agent}"] = (
                f"at_{agent}_{a} cart_{a} -> at_{agent}_{b} cart_{b} !at_{agent}_{a} !cart_{a}"
            )
        for book, shelf in enumerate(home):
            for place in range(places):
                actions[f"load_{agent}_{book}_{place} {agent}"] = (
                    f"at_{agent}_{place} cart_{place} lies_{book}_{place} -> in_{book} !lies_{book}_{place}"
                )
            actions[f"shelve_{agent}_{book} {agent}"] = (
                f"at_{agent}_{shelf} cart_{shelf} in_{book} -> home_{book} !in_{book}"
            )
    init = [f"at_{agent}_{dice.randrange(places)}" for agent in agents] + [f"cart_{dice.randrange(places)}"]
    init += [f"lies_{book}_{dice.randrange(places)}" for book in range(size)]
    return _made(agents, init, [f"home_{book}" for book in range(size)], actions)


def lift(dice: Random, size: int) -> Task:
    """Parcels to floors by a lift that whoever stands in it drives, or by stairs, which cost more."""
    agents, floors = ("h", *ROBOTS), 3
    actions: Actions = {}
    for agent in agents:
        for a, b in _beside(floors):
            actions[f"climb_{agent}_{a}_{b} {agent}"] = (
                f"at_{agent}_{a} -> at_{agent}_{b} !at_{agent}_{a} @ 3"
            )
            actions[f"ride_{agent}_{a}_{b} {agent}"] = f"in_{agent} lift_{a} -> lift_{b} !lift_{a}"
        for floor in range(floors):
            actions[f"enter_{agent}_{floor} {agent}"] = (
                f"at_{agent}_{floor} lift_{floor} room -> in_{agent} !at_{agent}_{floor} !room"
            )
            actions[f"leave_{agent}_{floor} {agent}"] = (
                f"in_{agent} lift_{floor} -> at_{agent}_{floor} room !in_{agent}"
            )
            actions[f"call_{agent}_{floor} {agent}"] = (
                f"at_{agent}_{floor} room lift_0 -> lift_{floor} !lift_0"
            )
            for parcel in range(size):
                actions[f"take_{agent}_{parcel}_{floor} {agent}"] = (
                    f"at_{agent}_{floor} p_{parcel}_{floor} -> has_{agent}_{parcel} !p_{parcel}_{floor}"
                )
                actions[f"drop_{agent}_{parcel}_{floor} {agent}"] = (
                    f"at_{agent}_{floor} has_{agent}_{parcel} -> p_{parcel}_{floor} !has_{agent}_{parcel}"
                )
    init = [f"at_{agent}_{dice.randrange(floors)}" for agent in agents] + ["room", "lift_0"]
    goal = []
    for parcel in range(size):
        start, end = dice.sample(range(floors), k=2)
        init.append(f"p_{parcel}_{start}")
        goal.append(f"p_{parcel}_{end}")
    return _made(agents, init, goal, actions)


def bridge(dice: Random, size: int) -> Task:
    """Stones over a narrow bridge, on which there is room for one agent."""
    agents, places = ("h", *ROBOTS), 5
    actions: Actions = {}
    for agent in agents:
        for a, b in _beside(places):
            needs, gives = ("clear" if b == 2 else ""), ("clear" if a == 2 else "")
            takes = "!clear" if b == 2 else ""
            actions[f"go_{agent}_{a}_{b} {agent}"] = (
                f"at_{agent}_{a} {needs} -> at_{agent}_{b} !at_{agent}_{a} {gives} {takes}"
            )
        for stone in range(size):
            for place in (0, 1, 3, 4):
                actions[f"lift_{agent}_{stone}_{place} {agent}"] = (
                    f"at_{agent}_{place} s_{stone}_{place} empty_{agent} "
                    f"-> has_{agent}_{stone} !s_{stone}_{place} !empty_{agent}"
                )
                actions[f"lay_{agent}_{stone}_{place} {agent}"] = (
                    f"at_{agent}_{place} has_{agent}_{stone} "
                    f"-> s_{stone}_{place} empty_{agent} !has_{agent}_{stone}"
                )
    init = [f"at_{agent}_{dice.choice((0, 1, 3, 4))} empty_{agent}" for agent in agents] + ["clear"]
    goal = []
    for stone in range(size):
        start, end = dice.choice(((0, 4), (1, 3), (4, 0), (3, 1), (0, 3)))
        init.append(f"s_{stone}_{start}")
        goal.append(f"s_{stone}_{end}")
    return _made(agents, init, goal, actions)


def laundry(dice: Random, size: int) -> Task:
    """Baskets are washed, hung up and folded; a machine takes one at a time, and anybody may switch it on."""
    agents = ("h", *ROBOTS)
    actions: Actions = {}
    for agent in agents:
        for load in range(size):
            actions[f"fill_{agent}_{load} {agent}"] = (
                f"dirty_{load} idle -> loaded_{load} !dirty_{load} !idle"
            )
            actions[f"wash_{agent}_{load} {agent}"] = f"loaded_{load} -> washed_{load} !loaded_{load} @ 1"
            actions[f"empty_{agent}_{load} {agent}"] = f"washed_{load} -> wet_{load} idle !washed_{load}"
            actions[f"hang_{agent}_{load} {agent}"] = f"wet_{load} line -> dry_{load} !wet_{load} !line @ 2"
            actions[f"fold_{agent}_{load} {agent}"] = f"dry_{load} -> folded_{load} line !dry_{load} @ 2"
    init = ["idle", "line"] + [dice.choice(("dirty", "dirty", "wet")) + f"_{load}" for load in range(size)]
    return _made(agents, init, [f"folded_{load}" for load in range(size)], actions)


def _made(agents: Sequence[str], init: Sequence[str], goal: Sequence[str], actions: Actions) -> Task:
    return task(agents=" ".join(agents), init=" ".join(init), goal=" ".join(goal), actions=actions)


FAMILIES: Final = {
    "kitchen": (kitchen, (3, 5, 7, 9)),
    "doors": (doors, (7, 11, 15, 19)),
    "assembly": (assembly, (4, 5, 6, 7)),
    "garden": (garden, (4, 6, 8, 10)),
    "library": (library, (4, 6, 8, 10)),
    "lift": (lift, (3, 5, 7, 9)),
    "bridge": (bridge, (3, 5, 6, 7)),
    "laundry": (laundry, (5, 7, 9, 11)),
}
"""The kinds, each with sizes from easy to hard."""
