"""Trees as floor plans: the longest row of halls is a corridor, what branches off lies beside it.

All boxes are in units of one cell; a room is as wide as what lies behind it, so that
every two connected places share a wall.
"""

from dataclasses import dataclass

import networkx as nx

from serendipity.pictures.map.names import natural


@dataclass(frozen=True, slots=True)
class Cell:
    """A rectangle of the plan in cells: centre, width and height 1."""

    x: float
    y: float
    width: float
    corridor: bool


def floor_plan(tree: "nx.Graph[str]") -> dict[str, Cell]:
    """The cells of a tree's places; the corridor is row 0, ``y`` grows downwards."""
    row = corridor(tree)
    cells: dict[str, Cell] = {}
    on_row = set(row)
    column = 0.0
    for i, place in enumerate(row):
        branches = sorted((p for p in tree.neighbors(place) if p not in on_row), key=natural)
        at_end = i in (0, len(row) - 1) and len(row) > 1
        beyond = _end_branch(tree, place, branches) if at_end else None
        if beyond is not None:
            branches.remove(beyond)
        above, below = _sides(tree, place, branches)
        if beyond is not None and i == 0:
            cells[beyond] = Cell(column + 0.5, 0, 1, corridor=False)
            column += 1
        spans = [sum(_span(tree, place, p) for p in side) for side in (above, below)]
        width = max(1, *spans)
        cells[place] = Cell(column + width / 2, 0, width, corridor=True)
        for side, span, direction in ((above, spans[0], -1), (below, spans[1], 1)):
            _place_row(tree, place, side, column + (width - span) / 2, direction, direction, cells)
        column += width
        if beyond is not None and i > 0:
            cells[beyond] = Cell(column + 0.5, 0, 1, corridor=False)
            column += 1
    return cells


def corridor(tree: "nx.Graph[str]") -> list[str]:
    """The longest path among the places that are no dead ends; of several, the one with most doors."""
    inner = [place for place in tree if tree.degree(place) > 1]
    core = tree.subgraph(inner or list(tree)[:1])
    first = _farthest(tree, core, min(core, key=natural))[-1]
    row = _farthest(tree, core, first)
    return min(row, row[::-1], key=lambda path: natural(path[0]))


def _farthest(tree: "nx.Graph[str]", core: "nx.Graph[str]", start: str) -> list[str]:
    """The path from ``start`` with most places, then most doors."""
    paths = nx.single_source_shortest_path(core, start)
    return max(
        (paths[end] for end in sorted(paths, key=natural)),
        key=lambda path: (len(path), sum(tree.degree(place) for place in path)),
    )


def _end_branch(tree: "nx.Graph[str]", place: str, branches: list[str]) -> str | None:
    """The dead end that lies straight on at an end of the corridor, if its sides can spare one."""
    if len(branches) == 2:
        return None
    return next((p for p in branches if _span(tree, place, p) == _depth(tree, place, p) == 1), None)


def _sides(tree: "nx.Graph[str]", place: str, branches: list[str]) -> tuple[list[str], list[str]]:
    """Branches above and below: the widest first, each where there is less so far."""
    above: list[str] = []
    below: list[str] = []
    load = [0, 0]
    for branch in sorted(branches, key=lambda p: -_span(tree, place, p) * _depth(tree, place, p)):
        side = 0 if load[0] <= load[1] else 1
        (above, below)[side].append(branch)
        load[side] += _span(tree, place, branch)
    return above, below


def _place_row(
    tree: "nx.Graph[str]",
    parent: str,
    row: list[str],
    column: float,
    y: int,
    direction: int,
    cells: dict[str, Cell],
) -> None:
    for place in row:
        width = _span(tree, parent, place)
        cells[place] = Cell(column + width / 2, y, width, corridor=False)
        beyond = sorted((p for p in tree.neighbors(place) if p != parent), key=natural)
        _place_row(tree, place, beyond, column, y + direction, direction, cells)
        column += width


def _span(tree: "nx.Graph[str]", parent: str, place: str) -> int:
    """How many cells wide a place and everything behind it are."""
    return max(1, sum(_span(tree, place, p) for p in tree.neighbors(place) if p != parent))


def _depth(tree: "nx.Graph[str]", parent: str, place: str) -> int:
    return 1 + max((_depth(tree, place, p) for p in tree.neighbors(place) if p != parent), default=0)
