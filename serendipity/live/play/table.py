"""Rounds for whoever opens the page: every page shows the same one, and each event is recorded."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from serendipity.live.play.game import Game
from serendipity.live.play.records import Event, Records, as_csv, read
from serendipity.live.play.setting import Setting
from serendipity.model import InputError, UsageError

Message = Mapping[str, Any]


class Download(NamedTuple):
    """A file that is answered: its text, its media type, and its name where it is to be saved."""

    text: str
    kind: str
    name: str | None = None


class Table:
    """Rounds of one setting, again and again.

    Args:
        setting: what is played.
        file: where every event is written down when it happens; None: nowhere.  A round in it that is not
            over goes on.

    Raises:
        InputError: the file is of other rounds.
    """

    def __init__(self, setting: Setting, file: Path | None = None) -> None:
        self._setting = setting
        self._file = file
        events, faults = ([], []) if file is None or not file.exists() else read(file)
        if faults:
            raise InputError(faults[0].partition(": ")[2], file)
        self._records = Records("player", file, events)
        self._round = max((event.get("round", 0) for event in events), default=0)
        if not self._go_on():
            self._begin()

    # -- the pages

    def room(self, token: str) -> "Table | None":
        """What a page shows whose address ends in a token: there is one room, without one."""
        return None if token else self

    def file(self, path: str) -> Download | None:
        """What there is to be saved."""
        if path == "export.json":
            return as_json(self._records.events, "serendipity.json")
        if path == "export.csv":
            return Download(as_csv(self._records.events), "text/csv; charset=utf-8", "serendipity.csv")
        return None

    def view(self) -> dict[str, Any]:
        """What pages show."""
        return {
            "stage": "play",
            "moment": self._moment,
            "round": self._round,
            "study": None,
            **self._game.view(),
        }

    def do(self, message: Message) -> dict[str, Any] | None:
        """What a page asks for; an answer for it alone, or None where all pages are to be told.

        Raises:
            UsageError: it asks for what there is not.
        """
        what = message.get("do")
        if what == "hello":
            return {}
        if what == "act":
            if message.get("moment") != self._moment:
                return {}  # a double click, or another page was quicker
            self._act(message.get("action"))
            return None
        if what == "again":
            self._records.add("again", round=self._round)
            self._begin()
            return None
        if what == "panel":
            epoch, open_ = self._game.run.epoch, bool(message.get("open"))
            self._records.add("panel", round=self._round, epoch=epoch, open=open_)
            return {}
        if what == "explain" and self._game.done:
            return {"kind": "explanation", "sentences": self._game.explanation()}
        raise UsageError(f"expected act, again, panel or, at the end, explain, got {what!r:.50}")

    def events(self) -> list[Event]:
        """All that has happened."""
        return list(self._records.events)

    @property
    def _moment(self) -> str:
        return f"{self._round}.{self._game.run.epoch}"

    def _act(self, action: str | None) -> None:
        passed = self._game.act(action)
        try:
            self._records.add("epoch", **about(self._setting, self._round), **passed)
        except UsageError:
            self._go_on()  # what is not recorded has not happened
            raise

    def _begin(self) -> None:
        game = Game(self._setting)
        self._records.add("begun", **begun(game, self._round + 1))
        self._round, self._game = self._round + 1, game

    def _go_on(self) -> bool:
        """Play what there is of the last round; whether there is one, and anything left of it."""
        events = self._records.events
        begins = [place for place, event in enumerate(events) if event["event"] == "begun"]
        if not begins:
            return False
        first, *later = events[begins[-1] :]
        self._game = Game(self._setting)
        if any(first.get(key) != value for key, value in begun(self._game, self._round).items()):
            raise InputError(
                "can't go on with it: it is of another task, or was played otherwise", self._file
            )
        for event in later:
            if event["event"] == "epoch":
                self._game.again(event, self._file)
        return not self._game.done and all(event["event"] != "again" for event in later)


def about(setting: Setting, number: int) -> Event:
    """What is recorded with all that happens in a round."""
    return {"round": number, "scenario": setting.name, "condition": setting.condition}


def begun(game: Game, number: int) -> Event:
    """What is recorded of a round that begins."""
    setting = game.setting
    how = {"view": setting.view, "discount": str(setting.discount), "alone_cost": game.alone}
    return {**about(setting, number), **how}


def as_json(value: object, name: str) -> Download:
    """A value, to be saved as JSON."""
    return Download(json.dumps(value, ensure_ascii=False, indent=1), "application/json", name)
