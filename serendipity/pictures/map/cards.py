"""Cards: what stands in one place, packed in rows; what is in or on something, in a card with it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import inf
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
    """A thing or agent with its riders in the first row and what it carries; ``loose`` ones stand last."""

    key: str
    name: str
    width: float
    height: float
    beside: "tuple[Card, ...]" = ()
    inside: "tuple[Card, ...]" = ()
    loose: bool = False

    def names(self) -> Iterator[str]:
        """The names of all that is on the card."""
        yield self.name
        for card in (*self.beside, *self.inside):
            yield from card.names()


@dataclass(frozen=True, slots=True)
class Spot:
    """Where something stands: its centre and size.

    Attributes:
        key: of its token; ``frame-...`` is the frame of a card.
        depth: in how many frames it is.
        names: of what a frame holds.
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
    return Card(key, name, 2 * RADIUS, 2 * RADIUS, inside=inside)


def thing_card(key: str, name: str, beside: tuple[Card, ...] = (), inside: tuple[Card, ...] = ()) -> Card:
    """The card of an object, with who rides it and what it carries."""
    return Card(key, name, pill(name)[-1], PILL_HEIGHT, beside, inside, loose=not beside)


def fits(cards: tuple[Card, ...], width: float, height: float) -> bool:
    """Whether cards have room for all that is on them."""
    return _arranged(cards, width, height) is not None


@lru_cache(maxsize=4096)
def pack(cards: tuple[Card, ...], width: float, height: float) -> tuple[Spot, ...]:
    """The spots of cards in rows about (0, 0), all within an area that is large enough, else in one row."""
    block = _arranged(cards, width, height) or _arranged(cards, inf, inf)
    assert block is not None, "there is room for one row"
    return tuple(spot.moved(-block.width / 2, -block.height / 2) for spot in block.spots)


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
    spot = Spot(card.key, card.width / 2, card.height / 2, card.width, card.height)
    own = _Block(card.width, card.height, (spot,))
    if not card.beside and not card.inside:
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
