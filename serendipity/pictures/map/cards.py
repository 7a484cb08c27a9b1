"""Cards: what stands in one place, packed in rows; what is in or on something, in a card with it.

What does not fit is counted: ``+3``.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Final

from serendipity.pictures.map.names import ems, shortened

RADIUS: Final = 16.0
"""Of the token of an agent, in the picture's units."""
PILL_SIZES: Final = (17.0, 15.0, 13.0)
"""Font sizes of the names of objects: the largest at which a name fits."""
PILL_HEIGHT: Final = 22.0
_WIDEST: Final = 110.0  # name of an object
_LEAST_PILL: Final = 34.0
_GAP: Final = 4.0
_PAD: Final = 4.0  # between the frame of a card and what is in it
_COLUMNS: Final = (1, 2, 3)


@dataclass(frozen=True, slots=True)
class Card:
    """A thing or an agent, and what is with it.

    Attributes:
        key: of its token.
        name: in full.
        width, height: of itself.
        beside: who rides it; they stand in its first row.
        inside: what it carries.
        loose: whether it may be counted among others, where there is no room.
        agent: whether it is an agent; they are the last to be counted.
    """

    key: str
    name: str
    width: float
    height: float
    beside: "tuple[Card, ...]" = ()
    inside: "tuple[Card, ...]" = ()
    loose: bool = False
    agent: bool = False

    @property
    def framed(self) -> bool:
        """Whether anything is with it."""
        return bool(self.beside or self.inside)

    def names(self) -> Iterator[str]:
        """The names of all that is on the card."""
        yield self.name
        for card in (*self.beside, *self.inside):
            yield from card.names()


@dataclass(frozen=True, slots=True)
class Spot:
    """Where something stands: its centre and size.

    Attributes:
        key: of its token; ``frame-...`` is the frame of a card, ``more-...`` counts what has no room.
        x, y, width, height: in the picture's units.
        depth: in how many frames it is.
        names: of what a frame holds or a count counts.
    """

    key: str
    x: float
    y: float
    width: float
    height: float
    depth: int = 0
    names: tuple[str, ...] = ()

    def moved(self, dx: float, dy: float, deeper: int = 0) -> "Spot":
        """The same spot elsewhere."""
        return replace(self, x=self.x + dx, y=self.y + dy, depth=self.depth + deeper)


@dataclass(frozen=True, slots=True)
class _Block:
    """Spots that stay together, from (0, 0) to (width, height)."""

    width: float
    height: float
    spots: tuple[Spot, ...]


def pill(name: str) -> tuple[str, float, float]:
    """The text of an object's token, its font size, and the token's width."""
    size = next((size for size in PILL_SIZES if ems(name) * size <= _WIDEST), PILL_SIZES[-1])
    text = shortened(name, _WIDEST / size)
    return text, size, max(_LEAST_PILL, ems(text) * size + 14)


def agent_card(key: str, name: str, inside: tuple[Card, ...] = ()) -> Card:
    """The card of an agent with what it holds."""
    return Card(key, name, 2 * RADIUS, 2 * RADIUS, inside=inside, agent=True)


def thing_card(key: str, name: str, beside: tuple[Card, ...] = (), inside: tuple[Card, ...] = ()) -> Card:
    """The card of an object, with who rides it and what it carries."""
    return Card(key, name, pill(name)[-1], PILL_HEIGHT, beside, inside, loose=not beside)


def fits(cards: tuple[Card, ...], width: float, height: float) -> bool:
    """Whether cards have room for all that is on them."""
    return _arranged(cards, width, height) is not None


@lru_cache(maxsize=4096)
def pack(cards: tuple[Card, ...], width: float, height: float, owner: str) -> tuple[Spot, ...]:
    """The spots of cards in rows about (0, 0), all within an area; what has no room is counted.

    Args:
        cards: from the most important on.
        width, height: of the area.
        owner: whose count it is, for the key of the last ``+3``.
    """
    for fewer in _shortened(cards, owner):
        block = _arranged(fewer, width, height)
        if block is not None:
            return tuple(spot.moved(-block.width / 2, -block.height / 2) for spot in block.spots)
    return ()


def _arranged(cards: Sequence[Card], width: float, height: float) -> _Block | None:
    """Cards in rows, the loose ones last, in few columns if that does; None where there is no room."""
    for columns in _COLUMNS:
        first, loose = (
            [_block(card, columns) for card in cards if card.loose is free] for free in (False, True)
        )
        if all(block.width <= width for block in (*first, *loose)):
            found = _rows(_broken(first, width) + _broken(loose, width))
            if found.height <= height:
                return found
    return None


def _block(card: Card, columns: int) -> _Block:
    """A card with all that is on it."""
    names = tuple(card.names()) if card.key.startswith("more-") else ()
    own = _Block(
        card.width,
        card.height,
        (Spot(card.key, card.width / 2, card.height / 2, card.width, card.height, names=names[1:]),),
    )
    if not card.framed or names:
        return own
    inside = [_block(each, columns) for each in card.inside]
    rows = [[*(_block(each, columns) for each in card.beside), own]]
    rows += [inside[i : i + columns] for i in range(0, len(inside), columns)]
    content = _rows(rows)
    width, height = content.width + 2 * _PAD, content.height + 2 * _PAD
    frame = Spot(f"frame-{card.key}", width / 2, height / 2, width, height, names=tuple(card.names()))
    return _Block(width, height, (frame, *(spot.moved(_PAD, _PAD, 1) for spot in content.spots)))


def _broken(blocks: Sequence[_Block], width: float) -> list[list[_Block]]:
    """Blocks in rows of a width."""
    rows: list[list[_Block]] = []
    left = 0.0
    for block in blocks:
        if not rows or block.width + _GAP > left:
            rows.append([])
            left = width + _GAP
        rows[-1].append(block)
        left -= block.width + _GAP
    return rows


def _rows(rows: Sequence[Sequence[_Block]]) -> _Block:
    """Rows below each other, each about the middle; blocks beside each other are, too."""
    widths = [sum(block.width for block in row) + _GAP * (len(row) - 1) for row in rows]
    widest = max(widths, default=0.0)
    spots: list[Spot] = []
    y = 0.0
    for row, wide in zip(rows, widths, strict=True):
        x, high = (widest - wide) / 2, max(block.height for block in row)
        for block in row:
            spots += [spot.moved(x, y + (high - block.height) / 2) for spot in block.spots]
            x += block.width + _GAP
        y += high + _GAP
    return _Block(widest, max(0.0, y - _GAP), tuple(spots))


def _shortened(cards: tuple[Card, ...], owner: str) -> Iterator[tuple[Card, ...]]:
    """Cards with all that is on them, then with ever fewer things, then agents alone, then fewer of them."""
    yield cards
    most = max([len(card.inside) for card in cards] + [sum(card.loose for card in cards)], default=0)
    for shown in range(most - 1, -1, -1):
        yield _fewer(tuple(_lighter(card, shown) for card in cards), shown, owner)
    agents = tuple(agent for card in cards for agent in _agents(card))
    things = tuple(replace(card, beside=(), inside=()) for card in _things_on(cards))
    for kept in range(len(agents), -1, -1):
        rest = (*agents[kept:], *things)
        yield (*agents[:kept], _count(rest, owner)) if rest else agents


def _agents(card: Card) -> Iterator[Card]:
    """The agents of a card, with nothing in their hands."""
    if card.agent:
        yield replace(card, inside=())
    for each in (*card.beside, *card.inside):
        yield from _agents(each)


def _things_on(cards: Sequence[Card]) -> Iterator[Card]:
    """All things on some cards."""
    for card in cards:
        if not card.agent:
            yield card
        yield from _things_on((*card.beside, *card.inside))


def _lighter(card: Card, shown: int) -> Card:
    """A card that names at most so many things that it carries."""
    if len(card.inside) <= shown:
        return card
    return replace(card, inside=(*card.inside[:shown], _count(card.inside[shown:], card.key)))


def _fewer(cards: tuple[Card, ...], shown: int, owner: str) -> tuple[Card, ...]:
    """Cards of which at most so many loose ones are named."""
    loose = [card for card in cards if card.loose]
    if len(loose) <= shown:
        return cards
    return (*(c for c in cards if not c.loose), *loose[:shown], _count(tuple(loose[shown:]), owner))


def _count(cards: tuple[Card, ...], owner: str) -> Card:
    """The card that says how many have no room."""
    number = sum(1 for card in cards for _ in card.names())
    return Card(f"more-{owner}", "", pill(f"+{number}")[-1], PILL_HEIGHT, inside=cards, loose=True)
