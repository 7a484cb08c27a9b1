"""Where the tokens of agents and objects stand within the places of a frame."""

from collections import defaultdict
from dataclasses import dataclass
from itertools import count
from typing import Final

from serendipity.show.map.layout import Box, Layout
from serendipity.show.map.names import shortened
from serendipity.show.picture.drawing import LETTER, Point
from serendipity.show.scene.scene import Frame, Scene

FORMER: Final = "former"
RADIUS: Final = 16.0
PILL_SIZE: Final = 20.0
PILL_HEIGHT: Final = 24.0
_AGENTS_AT: Final = -7.0  # below the middle of a box
_OBJECTS_AT: Final = 20.0


@dataclass(frozen=True, slots=True)
class Token:
    """Where a token stands; ``holder`` is the agent that holds the object."""

    at: Point
    holder: int | None = None


def agent_key(agent: int) -> str:
    """The key of an agent's token."""
    return f"agent-{agent}"


def object_key(index: int) -> str:
    """The key of an object's token, by its index in the frame's objects."""
    return f"object-{index}"


def pill(name: str) -> tuple[str, float]:
    """The text of an object's token, and its width."""
    text = shortened(name, 8)
    return text, max(40.0, len(text) * PILL_SIZE * LETTER + 18)


def initials(agents: tuple[str, ...]) -> tuple[str, ...]:
    """Up to three letters that tell the agents apart: ``C``, ``R1``, ``R2``."""
    wanted = [name[:1].upper() + "".join(filter(str.isdigit, name))[-2:] for name in agents]
    found: list[str] = []
    for text in wanted:
        if wanted.count(text) > 1:
            numbered = (f"{text[0]}{number}" for number in count(1))
            text = next(other for other in numbered if other not in wanted and other not in found)
        found.append(text)
    return tuple(found)


def tokens(scene: Scene, frame: Frame) -> dict[str, Token]:
    """The tokens that a frame shows, by key; what is in no place is left out."""
    if scene.layout is None:
        return {}
    crowd: dict[str, list[str]] = defaultdict(list)
    for agent in scene.lanes:
        if agent in frame.at:
            crowd[frame.at[agent]].append(agent_key(agent))
    if scene.deviates and frame.former_at not in (None, frame.at.get(scene.human)):
        crowd[str(frame.former_at)].append(FORMER)
    found: dict[str, Token] = {}
    for place, keys in crowd.items():
        if place not in scene.layout.boxes:  # of a picture that shows a part of the map
            continue
        box = scene.layout.boxes[place]
        for key, x in zip(keys, _row(box, len(keys), 2 * RADIUS + 10), strict=True):
            found[key] = Token((x, box.y + _AGENTS_AT))
    return found | _objects(scene, frame, scene.layout)


def _objects(scene: Scene, frame: Frame, layout: Layout) -> dict[str, Token]:
    """Objects below the agents, in a second row if need be; those that are held first, as their holders."""
    heaps: dict[str, list[tuple[int, int, str, int | None]]] = defaultdict(list)
    for index, (name, where) in enumerate(frame.objects.items()):
        place = where.place if where.holder is None else frame.at.get(where.holder)
        if place in layout.boxes:
            order = len(scene.lanes) if where.holder is None else scene.lanes.index(where.holder)
            heaps[str(place)].append((order, index, name, where.holder))
    found = {}
    for place, heap in heaps.items():
        box = layout.boxes[place]
        widest = max(pill(name)[1] for _, _, name, _ in heap)
        heap.sort(key=lambda entry: entry[:2])
        first = len(heap) if len(heap) < 3 or len(heap) * widest <= box.width else (len(heap) + 1) // 2
        for row, part in enumerate((heap[:first], heap[first:])):
            for (_, index, _, holder), x in zip(part, _row(box, len(part), widest + 4), strict=True):
                found[object_key(index)] = Token((x, box.y + _OBJECTS_AT + row * PILL_HEIGHT), holder)
    return found


def _row(box: Box, count: int, step: float) -> list[float]:
    """``count`` positions about the middle of a box, closer where they would not fit."""
    step = min(step, (box.width - 2 * RADIUS) / max(1, count - 1))
    return [box.x + (i - (count - 1) / 2) * step for i in range(count)]
