"""Where each place lies on the picture.

Trees, and graphs that are nearly one, become floor plans; other graphs are laid out by networkx.  In a floor
plan the longest row of halls is a corridor, and what branches off lies beside it, as wide as what lies behind
it, so that every two connected places share a wall.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Final

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from serendipity.pictures.map.names import natural
from serendipity.pictures.map.places import Places

CELL: Final = 100.0
"""Least side of a cell in the picture's units."""


@dataclass(frozen=True, slots=True)
class Box:
    """A place on the picture: its centre and size, and whether it belongs to a corridor."""

    x: float
    y: float
    width: float = CELL
    height: float = CELL
    corridor: bool = False

    @property
    def left(self) -> float:
        """Its edges, like the others."""
        return self.x - self.width / 2

    @property
    def right(self) -> float:
        """See ``left``."""
        return self.x + self.width / 2

    @property
    def top(self) -> float:
        """See ``left``."""
        return self.y - self.height / 2

    @property
    def bottom(self) -> float:
        """See ``left``."""
        return self.y + self.height / 2

    def moved(self, dx: float, dy: float) -> "Box":
        """The same box elsewhere."""
        return replace(self, x=self.x + dx, y=self.y + dy)


def floor_plan(tree: "nx.Graph[str]") -> dict[str, Box]:
    """The places of a tree, in cells of side 1; the corridor is row 0, ``y`` grows downwards."""
    row = corridor(tree)
    cells: dict[str, Box] = {}
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
            cells[beyond] = Box(column + 0.5, 0, 1, 1)
            column += 1
        spans = [sum(_span(tree, place, p) for p in side) for side in (above, below)]
        width = max(1, *spans)
        cells[place] = Box(column + width / 2, 0, width, 1, corridor=True)
        for side, span, direction in ((above, spans[0], -1), (below, spans[1], 1)):
            _place_row(tree, place, side, column + (width - span) / 2, direction, direction, cells)
        column += width
        if beyond is not None and i > 0:
            cells[beyond] = Box(column + 0.5, 0, 1, 1)
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
    cells: dict[str, Box],
) -> None:
    for place in row:
        width = _span(tree, parent, place)
        cells[place] = Box(column + width / 2, y, width, 1)
        beyond = sorted((p for p in tree.neighbors(place) if p != parent), key=natural)
        _place_row(tree, place, beyond, column, y + direction, direction, cells)
        column += width


def _span(tree: "nx.Graph[str]", parent: str, place: str) -> int:
    """How many cells wide a place and everything behind it are."""
    return max(1, sum(_span(tree, place, p) for p in tree.neighbors(place) if p != parent))


def _depth(tree: "nx.Graph[str]", parent: str, place: str) -> int:
    return 1 + max((_depth(tree, place, p) for p in tree.neighbors(place) if p != parent), default=0)


_SPREAD: Final = 1.45  # usual distance of the closest places of a graph, in cells
_APART: Final = 1.2  # their least distance, across or along
_WAY: Final = 20.0  # between large places, in the picture's units
_MOST_PASSAGES: Final = 0.1  # connections beyond a tree for each place of a floor plan
_GAP: Final = 0.5  # between parts that no way connects, in cells

Point = tuple[float, float]
Size = tuple[float, float]
"""Width and height."""


@dataclass(frozen=True, slots=True)
class MapLayout:
    """All places, from (0, 0) to (width, height); doors are links through a wall that both share."""

    boxes: dict[str, Box]
    links: tuple[tuple[str, str], ...]
    doors: frozenset[tuple[str, str]]
    width: float
    height: float

    def doorway(self, a: str, b: str) -> tuple[Point, bool]:
        """The middle of the wall that two places share, and whether it is upright: they are side by side."""
        one, other = self.boxes[a], self.boxes[b]
        across = abs(one.x - other.x) - (one.width + other.width) / 2
        along = abs(one.y - other.y) - (one.height + other.height) / 2
        if abs(across) < abs(along):
            middle = (max(one.top, other.top) + min(one.bottom, other.bottom)) / 2
            return (one.right if other.x > one.x else one.left, middle), True
        middle = (max(one.left, other.left) + min(one.right, other.right)) / 2
        return (middle, one.bottom if other.y > one.y else one.top), False

    def route(self, source: str, target: str) -> tuple[Point, ...]:
        """The way from the middle of one place to the middle of the other, round the corner."""
        a, b = self.boxes[source], self.boxes[target]
        if self.doors.isdisjoint(((source, target), (target, source))):
            return (a.x, a.y), (b.x, b.y)
        wide = a if a.width > b.width else b
        corner = (b.x, a.y) if wide is a else (a.x, b.y)
        return tuple(dict.fromkeys([(a.x, a.y), corner, (b.x, b.y)]))


def lay_out(places: Places, size: Size = (CELL, CELL)) -> MapLayout:
    """Lay out a map in cells of a size; parts that no way connects stand side by side."""
    graph: nx.Graph[str] = nx.Graph()
    graph.add_nodes_from(places.names)
    graph.add_edges_from(places.links)
    boxes: dict[str, Box] = {}
    doors: list[tuple[str, str]] = []
    right = 0.0
    for component in sorted(nx.connected_components(graph), key=lambda c: min(map(natural, c))):
        part = nx.Graph()
        part.add_nodes_from(sorted(component, key=natural))  # an order that does not depend on hashing
        part.add_edges_from(link for link in places.links if link[0] in component)
        plan = len(part.edges) - len(part) + 1 <= len(part) * _MOST_PASSAGES
        tree = nx.minimum_spanning_tree(part) if plan else part
        found = _plan_boxes(tree, size) if plan else _graph_boxes(part, size)
        left, top = min(box.left for box in found.values()), min(box.top for box in found.values())
        boxes |= {place: box.moved(right - left, -top) for place, box in found.items()}
        right = max(boxes[place].right for place in found) + _GAP * CELL
        walls = {frozenset(edge) for edge in tree.edges} if plan else set()
        doors += [link for link in places.links if frozenset(link) in walls]
    return MapLayout(boxes, places.links, frozenset(doors), *_extent(boxes.values()))


def _extent(boxes: Iterable[Box]) -> Point:
    kept = list(boxes)
    return max((box.right for box in kept), default=0.0), max((box.bottom for box in kept), default=0.0)


def _plan_boxes(tree: "nx.Graph[str]", size: Size) -> dict[str, Box]:
    width, height = size
    return {
        place: Box(cell.x * width, cell.y * height, cell.width * width, height, cell.corridor)
        for place, cell in floor_plan(tree).items()
    }


def _graph_boxes(graph: "nx.Graph[str]", size: Size) -> dict[str, Box]:
    """A spring layout that starts from the graph's spectrum; no chance is involved."""
    start = nx.spectral_layout(graph) if len(graph) > 3 else nx.circular_layout(graph)
    sprung = nx.spring_layout(graph, pos=start, iterations=200, seed=0)
    spread = _spread(_level(np.array([sprung[place] for place in graph])))
    step_x, step_y = (max(CELL, (side + _WAY) / _APART) for side in size)
    return {
        place: Box(float(x) * step_x, float(y) * step_y, *size)
        for place, (x, y) in zip(graph, spread, strict=True)
    }


def _level(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points, float64 of shape (n, 2), turned so that their longest axis lies flat."""
    centred = points - points.mean(axis=0)
    _, _, axes = np.linalg.svd(centred, full_matrices=False)
    return np.asarray(centred @ axes.T)


def _spread(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points, float64 of shape (n, 2) in cells, scaled and pushed apart until no two boxes overlap."""
    distances = np.linalg.norm(points[:, None] - points[None], axis=2)
    np.fill_diagonal(distances, np.inf)
    points = points * (_SPREAD / max(float(np.median(distances.min(axis=1))), 1e-9))
    for _ in range(300):
        apart = points[:, None] - points[None]
        overlap = np.clip(_APART - np.abs(apart).max(axis=2), 0, None)
        np.fill_diagonal(overlap, 0)
        if not overlap.any():
            break
        order = np.sign(np.arange(len(points))[:, None] - np.arange(len(points))[None])
        direction = np.where(apart == 0, order[..., None] * 1e-3, apart)
        length = np.linalg.norm(direction, axis=2, keepdims=True)
        length[length == 0] = 1
        points = points + (direction / length * overlap[..., None]).sum(axis=1) * 0.3
    return points
