"""Where the tokens of agents and objects stand within the places of a frame."""

from dataclasses import dataclass
from itertools import count

from serendipity.pictures.map.cards import Spot, pack
from serendipity.pictures.scene.crowds import (
    FORMER,
    LABEL_HEIGHT,
    TAG_HEIGHT,
    agent_key,
    crowds,
    object_key,
    room,
    tagged_places,
)
from serendipity.pictures.scene.scene import Frame, Scene

__all__ = ["FORMER", "TAG_HEIGHT", "Token", "agent_key", "initials", "object_key", "tokens"]


@dataclass(frozen=True, slots=True)
class Token:
    """Where a token stands.

    Attributes:
        spot: its centre and size on the map.
        holder: the agent that holds the object, or whose card a frame is about.
    """

    spot: Spot
    holder: int | None = None

    @property
    def at(self) -> tuple[float, float]:
        """Its centre."""
        return self.spot.x, self.spot.y

    @property
    def text(self) -> str:
        """What a count says."""
        return f"+{len(self.spot.names)}"


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
    holders = _holders(frame)
    tagged = tagged_places(scene)
    found: dict[str, Token] = {}
    for place, cards in crowds(scene, frame).items():
        if place not in scene.layout.boxes:  # of a picture that shows a part of the map
            continue
        box = scene.layout.boxes[place]
        width, height = room(box, tagged=place in tagged)
        spots = pack(cards, width, height, f"place-{place}")
        spare = height / 2 - max((spot.y + spot.height / 2 for spot in spots), default=0.0)
        lower = LABEL_HEIGHT + (height - box.height) / 2  # the middle of the room, below that of the box
        y = box.y + max(0, lower - spare) + min(0, lower + spare)
        for spot in spots:
            found[spot.key] = Token(spot.moved(box.x, y), holders.get(spot.key.removeprefix("frame-")))
    return found


def _holders(frame: Frame) -> dict[str, int]:
    """By key of a token: the agent that holds or rides the object; an agent's own for its frame."""
    found = {agent_key(agent): agent for agent in frame.at}
    for index, where in enumerate(frame.objects.values()):
        holder = where.riders[0] if where.riders else where.holder
        if holder is not None:
            found[object_key(index)] = holder
    return found
