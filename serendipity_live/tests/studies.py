"""A study of two scenarios, and those who take part in it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import serendipity
from serendipity_live.study.design import Design, open_design
from serendipity_live.study.participant import Participant
from serendipity_live.study.study import Study

PLAIN = """
practice = false
conditions = ["none", "silent"]
[[questions]]
text = "Was it good?"
[[questions]]
text = "Why?"
kind = "text"
required = false
[[closing]]
text = "Who are you?"
kind = "choice"
choices = ["me", "you"]
[[scenarios]]
name = "handed over"
example = "room2"
[[scenarios]]
name = "in the way"
example = "taxis"
"""


def opened(folder: Path, **given: Any) -> Study:
    return Study(open_design(folder, **given), folder)


def join(study: Study, **more: Any) -> Participant:
    lobby = study.room("")
    answer = lobby.do({"do": "join", "agree": True, **more})
    room = study.room(answer["to"].removeprefix("/s/"))
    assert isinstance(room, Participant)
    return room


def say(room: Participant, what: str, **more: Any) -> Mapping[str, Any]:
    room.do({"do": what, "moment": room.view()["moment"], "took": 1500, **more})
    return room.view()


def act_along(room: Participant, design: Design, epochs: int | None = None) -> None:
    """The way that is best alone."""
    events = [event for event in room.events() if event["event"] == "begun"]
    task = design.scenarios[events[-1]["scenario"]].task
    for action in (serendipity.plan(task, mode="individual").human_plan or ())[:epochs]:
        say(room, "act", action=action)


def finish(room: Participant, design: Design, **by_text: object) -> None:
    """Go on to the end; ``by_text`` answers questions by their first word."""
    while not room.over:
        view = room.view()
        if view["stage"] == "play" and not view["done"]:
            act_along(room, design)
        elif view["stage"] in ("play", "instructions"):
            say(room, "go on")
        else:
            answer(room, **by_text)


def answer(room: Participant, **by_text: object) -> None:
    usual = {"scale": 6, "choice": "me", "text": "so"}
    asked = room.view()["study"]["questions"]
    say(room, "answer", answers=[by_text.get(q["text"].split()[0], usual[q["kind"]]) for q in asked])
