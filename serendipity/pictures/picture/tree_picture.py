"""The histories of an answer over scenarios above a timeline: a bar for each, on the timeline's axis."""

from collections.abc import Iterable, Iterator
from typing import Final

from serendipity.model.answers.histories import History
from serendipity.model.task.plans import PlanStep
from serendipity.pictures.map.names import ems
from serendipity.pictures.picture import drawing
from serendipity.pictures.picture.drawing import INK, PAPER, WALL, Rect, Shape, Style, Text
from serendipity.pictures.scene.scene import Scene

_WORDS: Final = 22.0
_ACT: Final = 60.0
_IDLE: Final = 18.0
_GAP: Final = 14.0
_SIZE: Final = 13.0


def tree_height(scene: Scene) -> float:
    """How high all rows are together; 0 where nothing branches."""
    return sum(_WORDS + bar + _GAP for _, _, bar in _rows(scene, 0))


def tree_labels(scene: Scene, top: float, width: float) -> Iterator[Shape]:
    """Which scenarios the rows are about: the name of one, the numbers of several."""
    for history, y, bar in _rows(scene, top):
        one = (scene.result.goals or ())[history.scenarios[0]].name if len(history.scenarios) == 1 else ""
        text = f"{_numbers(history.scenarios)} {one}" if one else f"may be {_numbers(history.scenarios)}"
        lines, size = drawing.wrapped(text, width - 12, (13, 12, 11, 10), 3)
        middles = drawing.stacked(len(lines), y + (_WORDS + bar) / 2, size + 2)
        label = (Text(8, at, line, size, INK, "start") for line, at in zip(lines, middles, strict=True))
        yield drawing.ShapeGroup(tuple(label), title=text)


def tree(scene: Scene, top: float, first: int, last: int, column: float) -> Iterator[Shape]:
    """The rows between two epochs; a line leads from each bar to those that may follow it."""
    width = (last - first + 1) * column
    rows = list(_rows(scene, top))
    middles = {history.scenarios: y + _WORDS + bar / 2 for history, y, bar in rows}
    for history, _, _ in rows:
        x, middle = (history.end - first) * column, middles[history.scenarios]
        for branch in history.branches if 0 <= x <= width else ():
            end = middles[branch.scenarios]
            points = ((x - 2, middle), (x, middle), (x, end), (x + 2, end))
            yield drawing.Polyline(points, Style(stroke=WALL, width=2))
    for history, y, bar in rows:
        start, end = max(first, history.start), min(last + 1, history.end)
        if start < end:
            x, long = (start - first) * column, (end - start) * column
            colour = drawing.HUMAN if scene.scenario in history.scenarios else WALL
            paint = Style(drawing.tint(colour, 0.1), colour, 1.5)
            yield Rect(x + 1, y + _WORDS, long - 2, bar, paint, round=8)
            ends = ((one.end - first) * column for one in scene.histories if one.end < history.start)
            left = max([0.0, *ends]) + 6
            yield from _words(scene, history, x, y + _WORDS / 2, left, width)
            yield from _acts(scene, history, y + _WORDS, range(first, last + 1), column)


def _rows(scene: Scene, top: float) -> Iterator[tuple[History, float, float]]:
    """Each history, where its row begins, and how high its bar is."""
    for history in scene.histories:
        bar = (max((level for _, level in _piled(history)), default=-1) + 1) * _ACT or _IDLE
        yield history, top, bar
        top += _WORDS + bar + _GAP


def _piled(history: History) -> Iterator[tuple[PlanStep, int]]:
    """What robots do, each with its place in the pile of what goes on at the same time."""
    ends: list[int] = []
    for step in history.robots:
        level = next((i for i, end in enumerate(ends) if end <= step.epoch), len(ends))
        ends[level : level + 1] = [step.epoch + step.duration]
        yield step, level


def _numbers(scenarios: Iterable[int]) -> str:
    return ", ".join(str(i + 1) for i in scenarios)


def _words(scene: Scene, history: History, x: float, y: float, left: float, width: float) -> Iterator[Shape]:
    """Which scenarios are possible, how probable they are, and what the human did by which that is known.

    Args:
        x: where its bar begins.
        left: from where on there is no other line before that.
    """
    goals = scene.result.goals or ()
    may = f"{_numbers(history.scenarios)} · {sum(goals[i].probability for i in history.scenarios):.4g}"
    act = None if history.seen is None else scene.told[history.seen]
    sign = "" if history.start == 1 else "seen: wait" if act is None else f"seen: {act.verb} {act.detail}"
    wide = ems(may) * _SIZE * drawing.BOLD + 10
    long, before, after = wide + ems(sign) * _SIZE, x - 6 - left, width - x - 6
    leads = long > after and before > after  # before the line that leads here, where there is more room
    long = min(long, before if leads else after)
    x = x - 6 - long if leads else x + 6
    yield Rect(x, y - 9, long, 18, Style(PAPER))
    yield Text(x, y, *drawing.fitted(may, long, _SIZE, 9, bold=True), INK, "start", bold=True)
    if long - wide > 4 * _SIZE:
        yield Text(x + wide, y, *drawing.fitted(sign, long - wide, _SIZE, 9), drawing.FAINT_INK, "start")


def _acts(scene: Scene, history: History, top: float, seen: range, column: float) -> Iterator[Shape]:
    """What robots do in a bar, and in which scenarios where that is not all."""
    goals = scene.result.goals or ()
    colours = drawing.agent_colours(len(scene.agents), scene.human)
    for step, level in _piled(history):
        act, middle = scene.told[step], top + (level + 0.5) * _ACT
        if step.epoch in seen:
            paint = drawing.act_style(colours[max(act.agents, key=scene.human.__ne__)], len(act.agents) > 1)
            having = [i for i in history.scenarios if step in (goals[i].plan or ())]
            only = "" if len(having) == len(history.scenarios) else f"{_numbers(having)}: "
            wide = column * step.duration
            shapes = drawing.box(only + act.verb, act.detail, wide, middle, _ACT - 8, paint, INK)
            x = (step.epoch - seen[0]) * column
            yield drawing.ShapeGroup(tuple(shapes), x, 0, {"act": str(step.epoch)}, act.action)
