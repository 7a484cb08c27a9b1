"""Seeded search-and-rescue tasks of any size, and the worked examples of the paper."""

from pathlib import Path
from random import Random
from typing import Final, Literal

from serendipity.model import UsageError
from serendipity.model.arguments import PATH, TEXT, WHOLE, expect, expect_or_none
from serendipity.model.keywords import require_one_of
from serendipity.scenarios.usar import Building, Usar, figure2, pddl_files, random_building
from serendipity.writing.together import write_together

_WORKED_EXAMPLES: Final = ("room2", "room5", "room7")
"""Sections III-B to III-D of the paper, by where medkit 1 lies; all else is the same (semantics 5)."""

PRESETS: Final = ("figure2", *_WORKED_EXAMPLES)
"""``figure2``: the building, positions by the seed; the others: worked examples in it."""

_MOST: Final = 1_000_000
"""Places, connections and medkits in all agents' files together: some 40 MB, written in seconds."""


def worked_example(name: str) -> Usar:
    """One of the paper's examples in Figure 2: commx in room13, the robot in room4 (semantics 5)."""
    return Usar(
        name=f"usar-{name}",
        building=figure2(),
        robots=("robot",),
        agents_at=("room13", "room4"),
        medkits_at=(name, "room3"),
        triage_in="room1",
    )


def random_usar(building: Building, *, name: str, medkits: int = 2, robots: int = 1, seed: int = 0) -> Usar:
    """A task at random in a building, as the paper's 200; a UsageError without medkits or robots."""
    if medkits < 1:
        raise UsageError(f"medkits: expected at least 1, got {medkits}")
    if robots < 1:
        raise UsageError(f"robots: expected at least 1, got {robots}")
    random = Random(f"positions {seed}")
    places = building.locations
    draw = [places[random.randrange(len(places))] for _ in range(robots + 1 + medkits + 1)]
    return Usar(
        name=name,
        building=building,
        robots=("robot",) if robots == 1 else tuple(f"robot{i}" for i in range(1, robots + 1)),
        agents_at=tuple(draw[: robots + 1]),
        medkits_at=tuple(draw[robots + 1 : -1]),
        triage_in=draw[-1],
    )


def make_usar(
    *,
    rooms: int = 21,
    medkits: int = 2,
    robots: int = 1,
    seed: int = 0,
    extra_edges: int = 0,
    corridors: int | None = None,
    preset: str | None = None,
) -> Usar:
    """A seeded search-and-rescue task; equal arguments give equal tasks.

    Args:
        rooms: how many locations, halls included.
        corridors: how many the halls form; fewer are longer.  By default by chance, a fifth
            as many as halls.
        preset: ``figure2`` (the paper's building instead of a random one: ``rooms``,
            ``extra_edges`` and ``corridors`` do not count) or a worked example (nothing else
            counts).

    Raises:
        UsageError: a number is out of range, or there is no such preset.
    """
    expect(WHOLE, rooms=rooms, medkits=medkits, robots=robots, seed=seed, extra_edges=extra_edges)
    expect_or_none(WHOLE, corridors=corridors)
    expect_or_none(TEXT, preset=preset)
    size = (max(rooms, 1) + max(medkits, 1) + max(extra_edges, 0)) * max(robots, 1)
    if size > _MOST:
        most = f"at most {_MOST:,} together, once a robot"
        raise UsageError(f"rooms, medkits, extra_edges: expected {most}, got {f'{size:,}':.50}")
    if preset in _WORKED_EXAMPLES:
        return worked_example(preset)
    if preset == "figure2":
        name = f"usar-figure2-m{medkits}-k{robots}-s{seed}"
        return random_usar(figure2(), name=name, medkits=medkits, robots=robots, seed=seed)
    if preset is not None:
        require_one_of("preset", preset, PRESETS)
    shape = f"e{extra_edges}" if corridors is None else f"e{extra_edges}-c{corridors}"
    name = f"usar-r{rooms}-m{medkits}-k{robots}-{shape}-s{seed}"
    building = random_building(rooms, seed=seed, extra_edges=extra_edges, corridors=corridors)
    return random_usar(building, name=name, medkits=medkits, robots=robots, seed=seed)


def generate_usar(
    folder: str | Path,
    *,
    rooms: int = 21,
    medkits: int = 2,
    robots: int = 1,
    seed: int = 0,
    extra_edges: int = 0,
    corridors: int | None = None,
    preset: Literal["figure2", "room2", "room5", "room7"] | None = None,
    layout: Literal["agents", "pair"] = "agents",
) -> tuple[Path, ...]:
    """Write a seeded search-and-rescue task as PDDL; see :func:`make_usar` for the numbers.

    Args:
        folder: made where it is missing; files of the same name are replaced.
        rooms: how many locations, halls included.
        medkits: how many medkits.
        robots: how many robots.
        seed: of the building and of the positions.
        extra_edges: connections beyond a tree.
        corridors: how many the halls form; by default by chance.
        preset: ``figure2``, ``room2``, ``room5`` or ``room7``.
        layout: ``agents`` or ``pair``; see ``usar_pddl.LAYOUTS``.

    Returns:
        The files written.

    Raises:
        UsageError: an argument is out of range, or a file can't be written.
    """
    expect(PATH, folder=folder)
    expect(TEXT, layout=layout)
    task = make_usar(
        rooms=rooms,
        medkits=medkits,
        robots=robots,
        seed=seed,
        extra_edges=extra_edges,
        corridors=corridors,
        preset=preset,
    )
    files = {Path(folder, path): text.encode() for path, text in pddl_files(task, layout).items()}
    try:
        write_together(files)
    except OSError as error:
        raise UsageError(f"{error.filename or folder}: {error.strerror}") from None
    return tuple(files)
