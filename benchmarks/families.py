"""Seeded tasks of eight kinds for ablations: work that the human could do alone, and robots could ease.

Each kind is a function of dice and a size; nothing else about the planner was ever decided by them.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise, product
from random import Random
from typing import Final

from serendipity import Task
from serendipity_testing.builders import task

AGENTS: Final = ("h", "r", "s")

Actions = dict[str, str]
Edges = list[tuple[int, int]]


def _each(names: str, values: Iterable[object], *texts: str) -> Actions:
    """Actions for every agent, ``{a}`` in their texts, and every value, or tuple of values, of other names.

    Texts are ``action: body``, as :func:`serendipity_testing.builders.task` has it.
    """
    found = {}
    for agent, value in product(AGENTS, [*values]):
        named = dict(zip(names.split(), value if isinstance(value, tuple) else (value,), strict=True))
        for text in texts:
            name, _, body = text.format(a=agent, **named).partition(": ")
            found[name] = body
    return found


def _tree(dice: Random, places: int) -> Edges:
    """The edges of a random tree."""
    return [(dice.randrange(place), place) for place in range(1, places)]


def _row(places: int) -> Edges:
    """The edges between places in a row."""
    return list(pairwise(range(places)))


def _both_ways(edges: Iterable[tuple[int, int]]) -> Edges:
    return [pair for one, other in edges for pair in ((one, other), (other, one))]


def _walks(edges: Iterable[tuple[int, int]]) -> Actions:
    """Everybody walks along edges."""
    return _each("x y", _both_ways(edges), "go_{a}_{x}_{y} {a}: at_{a}_{x} -> at_{a}_{y} !at_{a}_{x}")


def kitchen(dice: Random, size: int) -> Task:
    """Things out of cupboards, which have to be opened, onto the table; each agent carries one."""
    actions = _walks(_tree(dice, 4))
    where = [dice.randrange(1, 4) for _ in range(size)]
    actions |= _each(
        "place", range(1, 4), "open_{a}_{place} {a}: at_{a}_{place} !open_{place} -> open_{place}"
    )
    actions |= _each(
        "thing place",
        enumerate(where),
        "take_{a}_{thing} {a}: at_{a}_{place} open_{place} in_{thing} empty_{a}"
        " -> has_{a}_{thing} !in_{thing} !empty_{a}",
        "put_{a}_{thing} {a}: at_{a}_0 has_{a}_{thing} -> on_{thing} !has_{a}_{thing} empty_{a}",
    )
    init = [f"at_{a}_{dice.randrange(4)} empty_{a}" for a in AGENTS] + [f"in_{t}" for t in range(size)]
    return _made(init, [f"on_{thing}" for thing in range(size)], actions)


def doors(dice: Random, size: int) -> Task:
    """A tree of rooms with locked doors, whose keys lie about; the human has to look into some of them."""
    edges = _tree(dice, size + 3)
    locked = dice.sample(edges[1:], k=max(1, size // 2))
    actions = _walks(edge for edge in edges if edge not in locked)
    actions |= _each(
        "x y door",
        [(x, y, max(x, y)) for x, y in _both_ways(locked)],
        "go_{a}_{x}_{y} {a}: at_{a}_{x} open_{door} -> at_{a}_{y} !at_{a}_{x}",
        "unlock_{a}_{door}_{x} {a}: at_{a}_{x} has_{a}_{door} -> open_{door} @ 2",
    )
    behind = {b for _, b in locked}
    shut = set[int]()
    for above, room in edges:  # from the root on
        if room in behind or above in shut:
            shut.add(room)
    start = [room for room in range(size + 3) if room not in shut]
    keys = {door: dice.choice(start) for door in behind}
    actions |= _each(
        "door room",
        keys.items(),
        "take_{a}_{door} {a}: at_{a}_{room} key_{door} -> has_{a}_{door} !key_{door}",
    )
    looked = dice.sample(range(1, size + 3), k=min(3, size))
    actions |= _each("room", looked, "look_{room} h: at_h_{room} -> seen_{room}")
    init = [f"at_{agent}_{dice.choice(start)}" for agent in AGENTS] + [f"key_{door}" for door in behind]
    return _made(init, [f"seen_{room}" for room in looked], actions)


def assembly(dice: Random, size: int) -> Task:
    """Parts are cut, drilled and painted, in their order, with tools of which there is one each."""
    stages = ("raw", "cut", "drilled", "painted")
    actions = _each(
        "tool",
        stages[1:],
        "pick_{a}_{tool} {a}: {tool}_there empty_{a} -> {tool}_{a} !{tool}_there !empty_{a}",
        "lay_{a}_{tool} {a}: {tool}_{a} -> {tool}_there empty_{a} !{tool}_{a}",
    ) | _each(
        "before tool part",
        [(*steps, part) for steps, part in product(pairwise(stages), range(size))],
        "do_{a}_{tool}_{part} {a}: {tool}_{a} {before}_p{part} -> {tool}_p{part} !{before}_p{part} @ 2",
    )
    init = [f"{tool}_there" for tool in stages[1:]] + [f"empty_{agent}" for agent in AGENTS]
    init += [f"{dice.choice(stages[:2])}_p{part}" for part in range(size)]
    return _made(init, [f"painted_p{part}" for part in range(size)], actions)


def garden(dice: Random, size: int) -> Task:
    """Beds along a path are weeded and watered; a can holds water for one, and is filled at the tap."""
    actions = _walks(_row(size + 1)) | _each(
        "bed",
        range(1, size + 1),
        "fill_{a} {a}: at_{a}_0 dry_{a} -> full_{a} !dry_{a}",
        "weed_{a}_{bed} {a}: at_{a}_{bed} wild_{bed} -> clean_{bed} !wild_{bed} @ 2",
        "water_{a}_{bed} {a}: at_{a}_{bed} clean_{bed} full_{a} -> wet_{bed} dry_{a} !full_{a}",
    )
    init = [f"at_{agent}_{dice.randrange(size + 1)} dry_{agent}" for agent in AGENTS]
    init += [dice.choice(("wild", "wild", "clean")) + f"_{bed}" for bed in range(1, size + 1)]
    return _made(init, [f"wet_{bed}" for bed in range(1, size + 1)], actions)


def library(dice: Random, size: int) -> Task:
    """Books go back to their shelves along an aisle; there is one trolley, which holds any number."""
    places = 4
    home = [dice.randrange(1, places) for _ in range(size)]
    push = "push_{a}_{x}_{y} {a}: at_{a}_{x} cart_{x} -> at_{a}_{y} cart_{y} !at_{a}_{x} !cart_{x}"
    actions = _walks(_row(places)) | _each("x y", _both_ways(_row(places)), push)
    actions |= _each(
        "book shelf place",
        [(*book, place) for book, place in product(enumerate(home), range(places))],
        "load_{a}_{book}_{place} {a}: at_{a}_{place} cart_{place} lies_{book}_{place}"
        " -> in_{book} !lies_{book}_{place}",
        "shelve_{a}_{book} {a}: at_{a}_{shelf} cart_{shelf} in_{book} -> home_{book} !in_{book}",
    )
    init = [f"at_{agent}_{dice.randrange(places)}" for agent in AGENTS] + [f"cart_{dice.randrange(places)}"]
    init += [f"lies_{book}_{dice.randrange(places)}" for book in range(size)]
    return _made(init, [f"home_{book}" for book in range(size)], actions)


def lift(dice: Random, size: int) -> Task:
    """Parcels to floors by a lift that whoever stands in it drives, or by stairs, which cost more."""
    floors = 3
    actions = _each(
        "x y",
        _both_ways(_row(floors)),
        "climb_{a}_{x}_{y} {a}: at_{a}_{x} -> at_{a}_{y} !at_{a}_{x} @ 3",
        "ride_{a}_{x}_{y} {a}: in_{a} lift_{x} -> lift_{y} !lift_{x}",
    )
    actions |= _each(
        "floor parcel",
        product(range(floors), range(size)),
        "enter_{a}_{floor} {a}: at_{a}_{floor} lift_{floor} room -> in_{a} !at_{a}_{floor} !room",
        "leave_{a}_{floor} {a}: in_{a} lift_{floor} -> at_{a}_{floor} room !in_{a}",
        "call_{a}_{floor} {a}: at_{a}_{floor} room lift_0 -> lift_{floor} !lift_0",
        "take_{a}_{parcel}_{floor} {a}: at_{a}_{floor} p_{parcel}_{floor}"
        " -> has_{a}_{parcel} !p_{parcel}_{floor}",
        "drop_{a}_{parcel}_{floor} {a}: at_{a}_{floor} has_{a}_{parcel}"
        " -> p_{parcel}_{floor} !has_{a}_{parcel}",
    )
    init = [f"at_{agent}_{dice.randrange(floors)}" for agent in AGENTS] + ["room", "lift_0"]
    ways = [dice.sample(range(floors), k=2) for _ in range(size)]
    init += [f"p_{parcel}_{start}" for parcel, (start, _) in enumerate(ways)]
    return _made(init, [f"p_{parcel}_{end}" for parcel, (_, end) in enumerate(ways)], actions)


def bridge(dice: Random, size: int) -> Task:
    """Stones over a narrow bridge, on which there is room for one agent."""
    narrow, shores = 2, (0, 1, 3, 4)
    actions = _walks(edge for edge in _row(5) if narrow not in edge) | _each(
        "x",
        (1, 3),
        "go_{a}_{x}_2 {a}: at_{a}_{x} clear -> at_{a}_2 !at_{a}_{x} !clear",
        "go_{a}_2_{x} {a}: at_{a}_2 -> at_{a}_{x} !at_{a}_2 clear",
    )
    actions |= _each(
        "stone place",
        product(range(size), shores),
        "lift_{a}_{stone}_{place} {a}: at_{a}_{place} s_{stone}_{place} empty_{a}"
        " -> has_{a}_{stone} !s_{stone}_{place} !empty_{a}",
        "lay_{a}_{stone}_{place} {a}: at_{a}_{place} has_{a}_{stone}"
        " -> s_{stone}_{place} empty_{a} !has_{a}_{stone}",
    )
    init = [f"at_{agent}_{dice.choice(shores)} empty_{agent}" for agent in AGENTS] + ["clear"]
    ways = [dice.choice(((0, 4), (1, 3), (4, 0), (3, 1), (0, 3))) for _ in range(size)]
    init += [f"s_{stone}_{start}" for stone, (start, _) in enumerate(ways)]
    return _made(init, [f"s_{stone}_{end}" for stone, (_, end) in enumerate(ways)], actions)


def laundry(dice: Random, size: int) -> Task:
    """Baskets are washed, hung up and folded; a machine takes one at a time, and anybody may switch it on."""
    actions = _each(
        "load",
        range(size),
        "fill_{a}_{load} {a}: dirty_{load} idle -> loaded_{load} !dirty_{load} !idle",
        "wash_{a}_{load} {a}: loaded_{load} -> washed_{load} !loaded_{load} @ 1",
        "empty_{a}_{load} {a}: washed_{load} -> wet_{load} idle !washed_{load}",
        "hang_{a}_{load} {a}: wet_{load} line -> dry_{load} !wet_{load} !line @ 2",
        "fold_{a}_{load} {a}: dry_{load} -> folded_{load} line !dry_{load} @ 2",
    )
    init = ["idle", "line"] + [dice.choice(("dirty", "dirty", "wet")) + f"_{load}" for load in range(size)]
    return _made(init, [f"folded_{load}" for load in range(size)], actions)


def _made(init: Sequence[str], goal: Sequence[str], actions: Actions) -> Task:
    return task(agents=" ".join(AGENTS), init=" ".join(init), goal=" ".join(goal), actions=actions)


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
