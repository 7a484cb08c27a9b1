"""One participant: where they are in the study follows from their record, so it outlives the server."""

from collections.abc import Mapping
from time import perf_counter
from typing import Any, Final
from urllib.parse import quote

import serendipity
from serendipity.model import InputError, UsageError
from serendipity_live.play.records import Event, Records
from serendipity_live.play.round import Round, RoundSetting
from serendipity_live.play.rounds import RecordedRounds
from serendipity_live.study.design import Design
from serendipity_live.study.texts import Item

_SHOWN: Final = (
    "sight",
    "human",
    "goal",
    "epoch",
    "clock",
    "busy",
    "going",
    "map",
    "legend",
    "facts",
    "can",
    "paid",
    "log",
    "said",
    "done",
)
"""What of a round a participant's page is told: nothing of what robots think, or are worth."""

_ASKED: Final = ("comprehension", "questions", "closing")
"""Stages with questions, each called as in the file of the study."""

_OVER: Final = ("end", "withdrawn")


class Participant(RecordedRounds):
    """Somebody who takes part.

    Attributes:
        stage: ``instructions``, ``comprehension``, ``play``, ``questions``, ``closing``, ``end`` or
            ``withdrawn``.
    """

    def __init__(self, design: Design, records: Records) -> None:
        super().__init__(records)
        self._design = design
        self.stage = "instructions"
        self._left: str | None = None
        self._tries, self._understood = 0, False
        self._since = perf_counter()
        self.joined: Event = {}
        try:
            for event in records.events:
                self._happened(event)
            known = self._design.scenarios.keys() >= set(self.joined["order"])
            if not known or not all(isinstance(self.joined[key], str) for key in ("token", "condition")):
                raise InputError("it is of another study")
        except (KeyError, TypeError, InputError) as error:
            raise InputError(f"can't be gone on with: {error}") from None
        self._go_on()

    # -- what pages show

    @property
    def name(self) -> str:
        """Their number."""
        return str(self.joined["participant"])

    @property
    def over(self) -> bool:
        """Whether they have come to the end, or withdrawn."""
        return self.stage in _OVER

    @property
    def last(self) -> str:
        """When anything was heard of them."""
        return str(self._records.events[-1]["time"])

    def view(self) -> dict[str, Any]:
        """What their pages show."""
        study: dict[str, Any] = {"participant": self.name, "rounds": len(self.joined["order"])}
        shown = {"stage": self.stage, "moment": self._moment, "round": self.round, "study": study}
        if self.stage == "instructions":
            study |= {"text": self._design.instructions(), "again": self._tries > 0}
        elif self.stage == "play":
            played = self._playing()
            view = played.view()
            shown |= {key: view[key] for key in _SHOWN} | {"end": self._end(played) if played.done else None}
        elif self.stage in _ASKED:
            study["questions"] = [question.model_dump(exclude={"expect"}) for question in self._questions()]
        elif self.stage == "end":
            study |= {"code": self._design.code, "link": self._link()}
        return shown

    def _link(self) -> str | None:
        """To where the study says that they are through."""
        link, told = self._design.texts.completion_link, self.joined.get("outside_id") or ""
        if link is None:
            return None
        return link.replace("{code}", quote(self._design.code, "")).replace("{id}", quote(told, ""))

    def _end(self, played: Round) -> dict[str, Any]:
        run = played.run
        told = {"paid": float(run.human_cost), "epochs": len(run.passed), "reached": run.done}
        return told if self.round else {**told, "alone": played.alone}

    # -- what pages do

    def do(self, message: Mapping[str, Any]) -> dict[str, Any] | None:
        """What a page asks for; an answer for it alone, or None where all of theirs are to be told."""
        if message.get("do") == "hello":
            self._add("opened", version=serendipity.__version__, **page_facts(message))
            return {}
        if message.get("moment") != self._moment:
            return {}  # a double click, a message that is sent again, or another page was quicker
        if self._left is None:  # else only what comes next could not be recorded
            self._hear(message)
        self._go_on()
        return None

    def _hear(self, message: Mapping[str, Any]) -> None:
        what, took = message.get("do"), _took(message.get("took"))
        if what == "withdraw" and not self.over:
            self._add("withdrawn", stage=self.stage, round=self.round)
        elif what == "act" and self.stage == "play":
            self._act(message.get("action"), **took, **self._seconds())
        elif what == "go on" and self.stage == "instructions":
            self._add("instructed", **took, **self._seconds(), text=self._design.instructions())
        elif what == "go on" and self.stage == "play" and self._playing().done:
            self._add("round over", **self._about(), **took, **self._playing().robots())
        elif what == "answer" and self.stage in _ASKED:
            self._answer(message, took)
        else:
            raise UsageError(f"expected something else at this point of the study, got {what!r:.50}")

    def _answer(self, message: Mapping[str, Any], took: Event) -> None:
        asked, answers, times = self._questions(), message.get("answers"), message.get("times")
        if not isinstance(answers, list) or len(answers) != len(asked):
            raise UsageError(f"answers: expected {len(asked)}")
        if not isinstance(times, list) or len(times) != len(asked):
            times = [None] * len(asked)
        for question, answer in zip(asked, answers, strict=True):
            if wrong := question.fault(answer):
                raise UsageError(f"answers: {wrong}, got {answer!r:.50}")
        told = [
            {"question": one.text, "answer": answer, **_right(one, answer), **_took(time)}
            for one, answer, time in zip(asked, answers, times, strict=True)
        ]
        when = self._about() if self.stage == "questions" else {"condition": self.joined["condition"]}
        self._add("answers", **when, about=self.stage, **took, **self._seconds(), answers=told)

    # -- from one point to the next

    @property
    def _moment(self) -> str:
        again = f".{self._tries}" if self._tries else ""
        return f"{self.stage}.{self.round}.{len(self._epochs)}{again}"

    def _happened(self, event: Event) -> None:
        """Move on by what is recorded."""
        super()._happened(event)
        what = event["event"]
        if what == "opened":
            return
        self._since = perf_counter()
        self._left = what if what in ("instructed", "round over", "answers") else None
        if what == "joined":
            self.joined = event
        elif what == "begun":
            self.stage = "play"
        elif what == "asked":
            self.stage = event["about"]
        elif what == "read again":
            self.stage = "instructions"
        elif what == "answers" and event["about"] == "comprehension":
            self._tries += 1
            self._understood = all(told["right"] for told in event["answers"])
        elif what in _OVER:
            self.stage, self._now = what, None

    def _go_on(self) -> None:
        """Begin what comes next, where something has come to its end."""
        left, asks = self._left, self._design.texts
        if left is None:
            return
        if left == "instructed" and asks.comprehension:
            self._add("asked", condition=self.joined["condition"], about="comprehension")
        elif self.stage == "comprehension" and not self._understood and self._tries < asks.tries:
            self._add("read again", tries=self._tries)
        elif left == "instructed" or self.stage == "comprehension":
            self._begin(0 if self._design.practice is not None else 1)
        elif left == "round over" and self.round and asks.questions:
            self._add("asked", **self._about(), about="questions")
        elif self.stage != "closing" and self.round < len(self.joined["order"]):
            self._begin(self.round + 1)
        elif self.stage != "closing" and asks.closing:
            self._add("asked", condition=self.joined["condition"], about="closing")
        else:
            self._add("end", condition=self.joined["condition"], code=self._design.code)

    def _questions(self) -> list[Item]:
        asked: list[Item] = getattr(self._design.texts, self.stage)
        return asked

    def _setting(self, number: int) -> RoundSetting:
        """What is played in a round."""
        if number:
            return self._design.setting(self.joined["order"][number - 1], self.joined["condition"])
        assert self._design.practice is not None, "else rounds begin with 1"
        return self._design.practice

    def _seconds(self) -> Event:
        """How long what is answered now has been there."""
        return {"seconds": round(perf_counter() - self._since, 3)}


def _right(question: Item, answer: object) -> Event:
    """Whether an answer is right, where one is expected."""
    right = question.right(answer)
    return {} if right is None else {"right": right}


def page_facts(message: Mapping[str, Any]) -> Event:
    """What a page says of itself, as far as it has the form that is expected."""
    page = message.get("page")
    if not isinstance(page, dict):
        return {}
    texts = {key: page[key][:300] for key in ("browser", "language") if isinstance(page.get(key), str)}
    sizes = {key: page[key][:30] for key in ("screen", "window") if isinstance(page.get(key), str)}
    return {**texts, **sizes}


def _took(milliseconds: object) -> Event:
    """How long it took on the page, where that says so."""
    if isinstance(milliseconds, (int, float)) and 0 <= milliseconds < 1e9:
        return {"page_seconds": round(milliseconds / 1000, 3)}
    return {}
