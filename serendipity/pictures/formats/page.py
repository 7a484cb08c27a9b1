"""The page: one HTML file with everything in it, which plays a plan in any browser."""

import json
from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from string import Template
from typing import Any, Final

from serendipity.model.numbers import short
from serendipity.model.printable import markup, printable
from serendipity.pictures.formats.svg import path, svg
from serendipity.pictures.picture import timeline_picture as timeline
from serendipity.pictures.picture.drawing import Picture, agent_colours, on
from serendipity.pictures.picture.map_picture import MARGIN, Token, map_picture, tokens, trails
from serendipity.pictures.scene.crowds import agent_key
from serendipity.pictures.scene.scene import Frame, Scene, headline, scenario_lines, subtitle

_WIDE: Final = 1200.0
_SMALLEST: Final = 0.46  # nearly all of a building of nine cells on a phone
_SMALLEST_WIDE: Final = 0.65
_LARGEST: Final = 1.35


def page(scene: Scene, others: Iterable[Scene] = ()) -> str:
    """A scene as a self-contained HTML page; it asks for nothing from any network.

    Args:
        others: the same answer's other scenarios, which can be chosen on it.
    """
    return Template(_text("page.html")).substitute(
        title=markup(f"{scene.name}: {headline(scene)}"),
        headline=markup(headline(scene)),
        subtitle=markup(subtitle(scene)),
        scenarios=_scenarios(scene),
        style=_text("style.css"),
        script=_text("play.js"),
        played=_played(scene),
        others="".join(
            f'<template data-scenario="{one.scenario}">{_played(one)}</template>\n' for one in others
        ),
    )


def _played(scene: Scene) -> str:
    """What is shown of a scene, and all that moves it."""
    last = scene.frames[-1]
    city = map_picture(scene, 0)
    data = json.dumps(_data(scene), ensure_ascii=False, separators=(",", ":"))
    lanes = timeline.timeline_picture(scene, now=0)
    return Template(_text("played.html")).substitute(
        data=data.replace("<", "\\u003c"),  # it can't end the script element it stands in
        map="" if city is None else svg(city, inline=True, id="map"),
        sizes="" if city is None else _sizes(city),
        without_map="hidden" if city is None else "",
        legend=_legend(scene),
        last=last.epoch,
        labels=svg(timeline.lane_labels(scene), inline=True),
        lanes=svg(lanes, inline=True, id="lanes"),
        bars=_bars(scene),
        table=_table(scene),
    )


def _sizes(city: Picture) -> str:
    """How small and how large the map may get; a large one scrolls rather than shrink further."""
    least = _SMALLEST if city.width <= _WIDE else _SMALLEST_WIDE
    widest = 1560 if city.width > _WIDE else 1200
    sides = f"--least:{city.width * least:.0f}px;--most:{city.width * _LARGEST:.0f}px"
    return f"{sides};--aspect:{city.width / city.height:.3f};--stage:{widest}px"


@cache
def _text(name: str) -> str:
    return files("serendipity.pictures.formats").joinpath("page", name).read_text(encoding="utf-8")


def _data(scene: Scene) -> dict[str, Any]:
    return {
        "frames": [_frame(scene, frame) for frame in scene.frames],
        "trails": {key: [path(points)[1:] for points in steps] for key, steps in trails(scene).items()},
        "meetings": [{"epoch": meeting.epoch, "text": printable(meeting.text)} for meeting in scene.meetings],
        "column": timeline.column(scene),
        "margin": MARGIN,
        "most": max(float(scene.frames[-1].cost), float(scene.frames[-1].former_spent), 1e-9),
        "colours": {str(i): colour for i, colour in agent_colours(len(scene.agents), scene.human).items()},
        "human": agent_key(scene.human),
    }


def _frame(scene: Scene, frame: Frame) -> dict[str, Any]:
    last = scene.frames[-1]
    return {
        "caption": printable(frame.caption),
        "tokens": {key: _token(token) for key, token in tokens(scene, frame).items()},
        "cost": f"{short(frame.cost)} of {short(last.cost)}",
        "former": f"{short(frame.former_spent)} of {short(last.former_spent)}",
        "formerValue": float(frame.former_spent),
        "spent": [float(frame.spent[agent]) for agent in scene.lanes],
        "window": frame.in_window,
        "clock": scene.clock(frame.epoch),
        "made": [*map(printable, frame.made)],
        "undone": [*map(printable, frame.undone)],
    }


def _token(token: Token) -> list[float | int | str | None]:
    """Centre and holder; for frames also size and names."""
    spot = token.spot
    told: list[float | int | str | None] = [round(spot.x, 1), round(spot.y, 1), token.holder]
    if spot.names:
        told += [round(spot.width, 1), round(spot.height, 1), printable(", ".join(spot.names))]
    return told


def _scenarios(scene: Scene) -> str:
    """A line for each scenario, and the choice between them."""
    lines = list(scenario_lines(scene))
    told = "".join(f"<p{' class=played' * chosen}>{markup(line)}</p>" for line, chosen in lines)
    names = enumerate((entry.name for entry in scene.result.goals or ()), start=1)
    options = "".join(
        f'<option value="{i - 1}"{" selected" * chosen}>{i} {markup(name)}</option>'
        for (i, name), (_, chosen) in zip(names, lines, strict=False)
    )
    return f'{told}<p><label>Play <select id="scenario">{options}</select></label></p>' if lines else ""


def _legend(scene: Scene) -> str:
    colours = agent_colours(len(scene.agents), scene.human)
    items = []
    for agent in scene.lanes:
        kind = "person" if agent in scene.people else "machine"
        sample = f'<i class="{kind}" style="background:{colours[agent]};color:{on(colours[agent])}"></i>'
        items.append(f"{sample}{markup(scene.title(agent))}")
    texts = {kind: markup(text.replace("'s f", "’s f")) for kind, text in scene.legend.items()}
    items += [f'<i class="{kind}"></i>{text}' for kind, text in texts.items()]
    if scene.goals:
        items.append('<i class="goal"></i>goal')
    return "".join(f"<li>{item}</li>" for item in items)


def _bars(scene: Scene) -> str:
    """Two bars: the former plan's cost so far, and the team's, in the agents' colours."""
    colours = agent_colours(len(scene.agents), scene.human)
    part = '<span class="part" style="background:{}" title="{}"></span>'
    parts = "".join(part.format(colours[agent], markup(scene.agents[agent])) for agent in scene.lanes)
    rows = [("team", "this plan", parts, "cost")]
    if scene.former_acts:
        rows.append(("former", "former plan", '<span class="part former"></span>', "former-cost"))
    return "".join(
        f'<div class="bar" id="bar-{key}"><span class="name">{name}</span>'
        f'<span class="track" aria-hidden="true">{inside}</span><output id="{output}">0</output></div>'
        for key, name, inside, output in rows
    )


def _table(scene: Scene) -> str:
    """The plan as a table, full names and all."""
    head = "".join(f'<th scope="col">{markup(scene.title(agent))}</th>' for agent in scene.lanes)
    if scene.deviates:
        head += f'<th scope="col">{markup(scene.agents[scene.human])}’s former plan</th>'
    rows = []
    for frame in scene.frames[1:]:
        cells = []
        for agent in scene.lanes:
            acts = [a.action for a in scene.acts if a.epoch == frame.epoch and agent in a.agents]
            cells.append(", ".join(acts))
        if scene.deviates:
            cells.append(", ".join(a.action for a in scene.former_acts if a.epoch == frame.epoch))
        body = "".join(f"<td>{markup(cell)}</td>" for cell in cells)
        row_class = ' class="window"' if frame.in_window else ""
        rows.append(f'<tr{row_class}><th scope="row">{frame.epoch}</th>{body}</tr>')
    return f'<thead><tr><th scope="col">epoch</th>{head}</tr></thead><tbody>{"".join(rows)}</tbody>'
