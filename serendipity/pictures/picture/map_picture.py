"""The map: places, ways, paths, and the tokens of one frame, which stand within the places."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, count, pairwise
from math import hypot
from typing import Final

from serendipity.pictures.map.cards import PILL_HEIGHT, RADIUS, Spot, pack, pill
from serendipity.pictures.map.layout import Box, MapLayout
from serendipity.pictures.map.names import ems
from serendipity.pictures.picture.drawing import (
    BOLD,
    CORRIDOR,
    FAINT_INK,
    FLOOR,
    FORMER,
    GOAL,
    INK,
    MEETING,
    PAPER,
    WALL,
    Circle,
    Picture,
    Point,
    Polyline,
    Rect,
    Shape,
    ShapeGroup,
    Style,
    Text,
    agent_colours,
    fitted,
    on,
)
from serendipity.pictures.scene.crowds import (
    FORMER_TOKEN,
    LABEL_HEIGHT,
    LEAST_LABEL,
    TAG_HEIGHT,
    agent_key,
    crowds,
    object_key,
    room,
    tagged_places,
)
from serendipity.pictures.scene.scene import Frame, Meeting, Scene


@dataclass(frozen=True, slots=True)
class Token:
    """Where a token stands, and the agent that holds the object, or whose card a frame is about."""

    spot: Spot
    holder: int | None = None

    @property
    def at(self) -> tuple[float, float]:
        """Its centre."""
        return self.spot.x, self.spot.y


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
        box = scene.layout.boxes[place]
        width, height = room(box, tagged=place in tagged)
        spots = pack(cards, width, height)
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


MARGIN: Final = 14.0
_DOOR: Final = 40.0
_ROOM: Final = 4.0  # between a lone place's outline and its cell
_LABEL_SIZE: Final = 23.0
_LABEL_AT: Final = 17.0  # below the wall
_LANE: Final = 7.0  # between neighbouring ones, in the picture's units
_LANES: Final = 0.36  # share of a place's smaller side that paths beside each other take
_CROWDED: Final = 3  # ways for each place from which on they are thin
_FAINT: Final = 0.28
_HIDDEN: Final = (-1000.0, -1000.0)

Steps = tuple[tuple[Point, ...], ...]


def map_picture(scene: Scene, epoch: int) -> Picture | None:
    """The map after an epoch; None where the task has none.

    Groups and lines that a page moves carry ``data-token`` and ``data-trail``.
    """
    layout = scene.layout
    if layout is None:
        return None
    content = (
        *_floor(layout),
        *_trails(scene, epoch),
        *_labels(scene, layout),
        *_meetings(scene, layout),
        *_tokens(scene, epoch),
    )
    shapes = (ShapeGroup(content, MARGIN, MARGIN),)
    where = "; ".join(f"{scene.agents[i]} in {place}" for i, place in scene.frames[epoch].at.items())
    description = f"Map of {len(layout.boxes)} places, epoch {epoch}: {where}"
    return Picture(layout.width + 2 * MARGIN, layout.height + 2 * MARGIN, shapes, description)


def trails(scene: Scene) -> dict[str, Steps]:
    """The lines of the former plan and of each agent, by token, as the points that each epoch adds."""
    layout = scene.layout
    if layout is None:
        return {}
    found: dict[str, Steps] = {}
    side = min(min(box.width, box.height) for box in layout.boxes.values())
    apart = min(1, _LANES * side / _LANE / (len(scene.lanes) + 1))
    if scene.deviates:
        found[FORMER_TOKEN] = _trail(layout, [frame.former_at for frame in scene.frames], 2 * apart)
    for n, agent in enumerate(scene.lanes):
        stops = [frame.at.get(agent) for frame in scene.frames]
        found[agent_key(agent)] = _trail(layout, stops, (1 if n == 0 else n + 2) * apart)
    return found


def _trail(layout: MapLayout, stops: Sequence[str | None], lane: float) -> tuple[tuple[Point, ...], ...]:
    """The points that each step adds to the line of an agent.

    Args:
        stops: its place after each epoch, from 0; None while it is nowhere.
        lane: from 1; how many lanes to the right of the middle; fractions lie between.

    Returns:
        for each epoch the points that its step adds; none where it stays.
    """
    found: list[tuple[Point, ...]] = [()]
    for here, there in pairwise(stops):
        if here is None or there is None or here == there:
            found.append(())
        else:
            found.append(tuple(_beside(layout.route(here, there), lane * _LANE)))
    return tuple(found)


def _beside(route: Sequence[Point], offset: float) -> Iterator[Point]:
    for (x1, y1), (x2, y2) in pairwise(route):
        length = hypot(x2 - x1, y2 - y1)
        if length:
            dx, dy = -(y2 - y1) / length * offset, (x2 - x1) / length * offset
            yield x1 + dx, y1 + dy
            yield x2 + dx, y2 + dy


def _floor(layout: MapLayout) -> Iterator[Shape]:
    in_plan = {place for door in layout.doors for place in door}
    lines = [link for link in layout.links if link not in layout.doors]
    crowded = len(lines) > _CROWDED * len(layout.boxes)
    way = Style(stroke=WALL, width=1.5, opacity=0.45) if crowded else Style(stroke=WALL, width=3)
    for a, b in lines:
        if a not in in_plan:
            yield Polyline(layout.route(a, b), way)
    for place, box in layout.boxes.items():
        yield _outline(box, in_plan=place in in_plan)
    for a, b in sorted(layout.doors):
        yield _door(layout, a, b)
    for a, b in lines:
        if a in in_plan:  # a passage that no floor plan of a tree has room for
            yield Polyline(layout.route(a, b), Style(stroke=WALL, width=6, dash=(2, 9)))


def _labels(scene: Scene, layout: MapLayout) -> Iterator[Shape]:
    """Above the paths, on the colour of the floor so that both can be read."""
    for place, box in layout.boxes.items():
        goal = place in scene.goals
        label, size = fitted(place, box.width - (38 if goal else 14), _LABEL_SIZE, LEAST_LABEL)
        x, y = box.x + (10 if goal else 0), box.top + _LABEL_AT
        width = ems(label) * size
        floor = Style(CORRIDOR if box.corridor else FLOOR)
        yield Rect(x - width / 2, y - size / 2, width, size, floor, round=4)
        yield ShapeGroup((Text(x, y, label, size, FAINT_INK),), title="" if label == place else place)
        if goal:
            yield flag(x - width / 2 - 18, y)


def _outline(box: Box, *, in_plan: bool) -> Rect:
    inset = 0 if in_plan else _ROOM
    return Rect(
        box.left + inset,
        box.top + inset,
        box.width - 2 * inset,
        box.height - 2 * inset,
        Style(CORRIDOR if box.corridor else FLOOR, WALL, 2 if in_plan else 3),
        round=0 if in_plan else 14,
    )


def _door(layout: MapLayout, a: str, b: str) -> Polyline:
    """The opening in the wall between two places, in the colour of the floor."""
    in_corridor = layout.boxes[a].corridor or layout.boxes[b].corridor
    (x, y), upright = layout.doorway(a, b)
    dx, dy = (0, _DOOR / 2) if upright else (_DOOR / 2, 0)
    floor = Style(stroke=CORRIDOR if in_corridor else FLOOR, width=5)
    return Polyline(((x - dx, y - dy), (x + dx, y + dy)), floor)


def flag(x: float, y: float) -> ShapeGroup:
    """The mark of a place that the goal is about, its pole at ``x``."""
    pole = Polyline(((x, y - 10), (x, y + 10)), Style(stroke=INK, width=2))
    cloth = Polyline(((x, y - 10), (x + 14, y - 5), (x, y)), Style(GOAL, INK, 1), closed=True)
    return ShapeGroup((pole, cloth), title="the human's goal")


def _trails(scene: Scene, epoch: int) -> Iterator[Shape]:
    colours = {agent_key(i): c for i, c in agent_colours(len(scene.agents), scene.human).items()}
    for key, steps in trails(scene).items():
        whole = tuple(chain.from_iterable(steps))
        if key == FORMER_TOKEN:
            yield Polyline(whole, Style(stroke=FORMER, width=4, dash=(9, 8)), data={"ghost": key})
            continue
        yield Polyline(whole, Style(stroke=colours[key], width=4, opacity=_FAINT))
        done = tuple(chain.from_iterable(steps[: epoch + 1]))
        yield Polyline(done, Style(stroke=colours[key], width=5), data={"trail": key})


def _meetings(scene: Scene, layout: MapLayout) -> Iterator[Shape]:
    """A frame and a tag for each place where somebody meets."""
    met: dict[str, list[tuple[int, Meeting]]] = defaultdict(list)
    for index, meeting in enumerate(scene.meetings):
        if meeting.place is not None:
            met[meeting.place].append((index, meeting))
    for place, several in met.items():
        box = layout.boxes[place]
        x, y = box.left, box.top
        frame = Rect(x + 4, y + 4, box.width - 8, box.height - 8, Style(stroke=MEETING, width=5), round=12)
        epochs = [str(epoch) for epoch in dict.fromkeys(meeting.epoch for _, meeting in several)]
        text, size = _fitting(epochs, box.width - 30)
        width, top = max(76, ems(text) * size * BOLD + 16), y + box.height - TAG_HEIGHT
        tag = Rect(box.x - width / 2, top, width, TAG_HEIGHT, Style(MEETING), round=TAG_HEIGHT / 2)
        words = Text(box.x, top + TAG_HEIGHT / 2, text, size, INK, bold=True)
        told = "; ".join(f"epoch {meeting.epoch}: {meeting.text}" for _, meeting in several)
        indices = " ".join(str(index) for index, _ in several)
        yield ShapeGroup((frame, tag, words), data={"meeting": indices}, title=told)


def _fitting(epochs: list[str], width: float) -> tuple[str, float]:
    """As many epochs as a tag has room for."""
    for shown in range(len(epochs), 0, -1):
        more = f" +{len(epochs) - shown}" if shown < len(epochs) else ""
        text = f"{'epochs' if len(epochs) > 1 else 'epoch'} {', '.join(epochs[:shown])}{more}"
        size = min(16, width / ems(text) / BOLD)
        if size >= LEAST_LABEL or shown == 1:
            break
    return text, size


def _tokens(scene: Scene, epoch: int) -> Iterator[Shape]:
    """All tokens that any frame shows; those that this one lacks stand outside the picture."""
    frame = scene.frames[epoch]
    now = tokens(scene, frame)
    ever = dict(chain.from_iterable(tokens(scene, each).items() for each in scene.frames))
    colours = agent_colours(len(scene.agents), scene.human)
    letters = initials(scene.agents)
    frames = [key for key in ever if key.startswith("frame-")]
    for key in sorted(frames, key=lambda key: ever[key].spot.depth):
        yield _frame(key, now.get(key, ever[key]), colours, shown=key in now)
    if FORMER_TOKEN in ever:
        shapes = _person(letters[scene.human], PAPER, FORMER, dashed=True)
        title = f"{scene.agents[scene.human]} with the former plan"
        yield _token(FORMER_TOKEN, now, shapes, title)
    for agent in scene.lanes:
        if agent_key(agent) in ever:
            paint = _person if agent in scene.people else _machine
            yield _token(agent_key(agent), now, paint(letters[agent], colours[agent]), scene.title(agent))
    for index, name in enumerate(frame.objects):
        key = object_key(index)
        if key in ever:
            holder = now[key].holder if key in now else None
            colour = None if holder is None else colours[holder]
            yield _token(key, now, _pill(name, colour, carries=name in scene.vehicles), name)


def _frame(key: str, token: Token, colours: dict[int, str], *, shown: bool) -> ShapeGroup:
    """The frame about who or what is together; a page changes its size."""
    spot = token.spot
    stroke = INK if token.holder is None else colours[token.holder]
    style = Style(PAPER, stroke, 2, opacity=0.8)
    sheet = Rect(-spot.width / 2, -spot.height / 2, spot.width, spot.height, style, round=10)
    at = token.at if shown else _HIDDEN
    return ShapeGroup((sheet,), *at, {"token": key}, ", ".join(spot.names))


def _pill(name: str, holder: str | None, *, carries: bool) -> tuple[Shape, ...]:
    """An object; its outline takes the colour of who holds it, what carries others has sharper corners."""
    text, size, width = pill(name)
    fill = CORRIDOR if carries else PAPER
    style = Style(fill, INK, 2) if holder is None else Style(fill, holder, 3)
    half = PILL_HEIGHT / 2
    outline = Rect(-width / 2, -half, width, PILL_HEIGHT, style, round=4 if carries else half)
    return outline, Text(0, 0, text, size, INK)


def _token(key: str, now: dict[str, Token], shapes: tuple[Shape, ...], title: str) -> ShapeGroup:
    x, y = now[key].at if key in now else _HIDDEN
    return ShapeGroup(shapes, x, y, {"token": key}, title)


def _person(letter: str, fill: str, stroke: str = PAPER, *, dashed: bool = False) -> tuple[Shape, ...]:
    style = Style(fill, stroke, 2.5, (5, 4) if dashed else ())
    return Circle(0, 0, RADIUS, style), _letter(letter, FORMER if dashed else on(fill))


def _machine(letter: str, fill: str) -> tuple[Shape, ...]:
    side = 2 * RADIUS - 2
    square = Rect(-side / 2, -side / 2, side, side, Style(fill, PAPER, 2.5), round=5)
    return square, _letter(letter, on(fill))


def _letter(letter: str, colour: str) -> Text:
    size = {1: 20.0, 2: 16.0}.get(len(letter), LEAST_LABEL)
    return Text(0, 0, letter, size, colour, bold=True)
