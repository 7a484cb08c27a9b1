"""Recorded rounds, and those of the page that everybody who opens it shares."""

from collections.abc import Mapping
from itertools import takewhile
from pathlib import Path
from types import MappingProxyType
from typing import Any

from serendipity.model import InputError, UsageError
from serendipity_live.play.records import Download, Event, Records, as_csv, as_json, read
from serendipity_live.play.round import Round, RoundSetting

Message = Mapping[str, Any]


class RecordedRounds:
    """Rounds of somebody that follow from a record: so they outlive the server.

    What is not recorded has not happened.

    Attributes:
        round: the number of the round that was begun last; 0 before, and for practice.
    """

    def __init__(self, records: Records) -> None:
        self._records = records
        self._begun: Event = {}
        self._epochs: list[Event] = []
        self._now: Round | None = None
        self.round = 0

    def events(self) -> list[Event]:
        """All that has happened."""
        return list(self._records.events)

    def _setting(self, number: int) -> RoundSetting:
        """What is played in a round."""
        raise NotImplementedError

    def _playing(self) -> Round:
        """The round, as far as it is recorded."""
        if self._now is None:
            played, file = Round(self._setting(self.round)), self._records.file
            if not self._beginning(played, self.round).items() <= self._begun.items():
                raise InputError("can't go on with it: it is of another task, or was played otherwise", file)
            for event in self._epochs:
                played.again(event, file)
            self._now = played
        return self._now

    def _begin(self, number: int) -> None:
        new = Round(self._setting(number))
        self._add("begun", **self._beginning(new, number))
        self._now = new

    def _about(self) -> Event:
        """What is recorded with all that happens in a round."""
        setting = self._setting(self.round)
        return {"round": self.round, "scenario": setting.name, "condition": setting.condition}

    def _beginning(self, played: Round, number: int) -> Event:
        """What is recorded of a round that begins."""
        setting = played.setting
        about = {"round": number, "scenario": setting.name, "condition": setting.condition}
        how = {"view": setting.view, "discount": str(setting.discount), "alone_cost": played.alone}
        return about | how

    def _act(self, action: Any, **more: Any) -> None:
        done = self._playing().act(action)
        self._add("epoch", **self._about(), **more, **done)

    def _add(self, event: str, **told: Any) -> None:
        try:
            happened = self._records.add(event, **told)
        except UsageError:
            self._now = None  # which may be ahead of what is recorded
            raise
        self._happened(happened)

    def _happened(self, event: Event) -> None:
        """Move on by what is recorded."""
        if event["event"] == "begun":
            self.round, self._begun, self._epochs, self._now = event["round"], event, [], None
        elif event["event"] == "epoch":
            self._epochs.append(event)


class SharedRounds(RecordedRounds):
    """Rounds of one setting, again and again, for whoever opens the page: every page shows the same one.

    Args:
        file: where every event is written down when it happens; None: nowhere.  A round in it that is not
            over goes on.
    """

    @property
    def texts(self) -> Mapping[str, str]:
        """None: the page is in English."""
        return MappingProxyType({})

    def __init__(self, setting: RoundSetting, file: Path | None = None) -> None:
        events, faults = ([], []) if file is None or not file.exists() else read(file)
        if faults:
            raise InputError(faults[0].partition(": ")[2], file)
        super().__init__(Records("player", file, events))
        self._shared = setting
        try:
            for event in events:
                self._happened(event)
        except KeyError as error:
            raise InputError(f"can't go on with it: {error} is missing", file) from None
        later = takewhile(lambda event: event["event"] != "begun", reversed(events))
        left = any(event["event"] == "again" for event in later)
        if not self.round or left or self._playing().done:
            self._begin(self.round + 1)

    def _setting(self, number: int) -> RoundSetting:
        return self._shared

    # -- the pages

    def room(self, token: str) -> "SharedRounds | None":
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
        shown = {"stage": "play", "moment": self._moment, "round": self.round, "study": None}
        return {**shown, **self._playing().view()}

    def do(self, message: Message) -> dict[str, Any] | None:
        """What a page asks for; an answer for it alone, or None where all pages are to be told."""
        what = message.get("do")
        if what == "hello":
            return {}
        if what == "act":
            if message.get("moment") != self._moment:
                return {}  # a double click, or another page was quicker
            self._act(message.get("action"))
            return None
        if what == "again":
            self._add("again", round=self.round)
            self._begin(self.round + 1)
            return None
        if what == "panel":
            epoch, open_ = self._playing().run.epoch, bool(message.get("open"))
            self._add("panel", round=self.round, epoch=epoch, open=open_)
            return {}
        if what == "explain" and self._playing().done:
            return {"kind": "explanation", "sentences": self._playing().explanation()}
        raise UsageError(f"expected act, again, panel or, at the end, explain, got {what!r:.50}")

    @property
    def _moment(self) -> str:
        return f"{self.round}.{self._playing().run.epoch}"
