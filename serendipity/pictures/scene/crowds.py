"""Who and what is in each place of a frame, as cards; and how large places have to be for them."""

from collections import defaultdict
from itertools import product
from typing import Final

from serendipity.pictures.map.cards import Card, agent_card, fits, thing_card
from serendipity.pictures.map.layout import CELL, Box
from serendipity.pictures.map.names import ems
from serendipity.pictures.scene.scene import Frame, Scene

FORMER_TOKEN: Final = "former"
"""The key of the human's token with the former plan."""
LEAST_LABEL: Final = 15.0
"""Smallest size of a place's name."""
LABEL_HEIGHT: Final = 30.0
TAG_HEIGHT: Final = 19.0
_EDGE: Final = 6.0  # between the wall of a place and what is in it
_SIDES: Final = (
    CELL,
    112.0,
    125.0,
    140.0,
    160.0,
    180.0,
    200.0,
    225.0,
    250.0,
    300.0,
    360.0,
    430.0,
    520.0,
    620.0,
)
_WIDEST_FOR_NAME: Final = 160.0
_HIGHER: Final = 1.15  # than wide, at most


def agent_key(agent: int) -> str:
    """The key of an agent's token."""
    return f"agent-{agent}"


def object_key(index: int) -> str:
    """The key of an object's token, by its index in the frame's objects."""
    return f"object-{index}"


def crowds(scene: Scene, frame: Frame) -> dict[str, tuple[Card, ...]]:
    """The cards of each place where there is anybody or anything; agents first, then what nobody has."""
    crowd = _Crowd(scene, frame)
    found: dict[str, list[Card]] = defaultdict(list)
    for agent in scene.lanes:
        if agent in frame.at and agent not in crowd.aboard:
            found[frame.at[agent]].append(crowd.agent(agent))
    if scene.deviates and frame.former_at not in (None, frame.at.get(scene.human)):
        found[str(frame.former_at)].append(
            agent_card(FORMER_TOKEN, f"{scene.agents[scene.human]} (former plan)")
        )
    for name in crowd.roots:
        where = frame.objects[name]
        if where.place is not None:
            found[where.place].append(crowd.thing(name))
    return {place: tuple(sorted(cards, key=lambda card: card.loose)) for place, cards in found.items()}


def room(box: Box, *, tagged: bool) -> tuple[float, float]:
    """The width and height that a place has for its crowd."""
    return box.width - 2 * _EDGE, box.height - LABEL_HEIGHT - _EDGE - (TAG_HEIGHT + 2 if tagged else 0)


def tagged_places(scene: Scene) -> frozenset[str]:
    """Places with a tag: somebody meets there."""
    return frozenset(meeting.place for meeting in scene.meetings if meeting.place is not None)


def cell_size(scene: Scene, places: tuple[str, ...]) -> tuple[float, float]:
    """The smallest width and height at which places have room for everything, else the largest."""
    tagged = tagged_places(scene)
    wanted = {
        (cards, place in tagged) for frame in scene.frames for place, cards in crowds(scene, frame).items()
    }
    name = max(map(ems, places)) * LEAST_LABEL + 14 + (24 if scene.goals else 0)
    sizes = sorted(product(_SIDES, _SIDES), key=lambda size: size[0] * size[1])
    for width, height in sizes:
        if height > _HIGHER * width or width < min(name, _WIDEST_FOR_NAME):
            continue
        box = Box(0, 0, width, height)
        if all(fits(cards, *room(box, tagged=tag)) for cards, tag in wanted):
            return width, height
    return sizes[-1]


class _Crowd:
    """The cards of a frame, with what is on them."""

    def __init__(self, scene: Scene, frame: Frame) -> None:
        self._scene = scene
        self._objects = frame.objects
        self._keys = {name: object_key(index) for index, name in enumerate(frame.objects)}
        self._held: dict[int, list[str]] = defaultdict(list)
        self._carried: dict[str, list[str]] = defaultdict(list)
        self.aboard = {agent for where in frame.objects.values() for agent in where.riders}
        self.roots = []
        for name, where in frame.objects.items():
            if where.carrier in frame.objects:
                self._carried[str(where.carrier)].append(name)
            elif where.holder is not None:
                self._held[where.holder].append(name)
            else:
                self.roots.append(name)

    def agent(self, agent: int) -> Card:
        """An agent with what it holds."""
        inside = tuple(self.thing(name) for name in self._held[agent])
        return agent_card(agent_key(agent), self._scene.agents[agent], inside)

    def thing(self, name: str) -> Card:
        """An object with who rides it and what it carries."""
        riders = tuple(self.agent(agent) for agent in self._objects[name].riders)
        inside = tuple(self.thing(each) for each in self._carried[name])
        return thing_card(self._keys[name], name, riders, inside)
