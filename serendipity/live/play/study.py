"""A study: one participant after the other, each with a condition, rounds in balanced order, questions."""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from serendipity.live.play.balance import condition, order
from serendipity.live.play.game import Game
from serendipity.live.play.questions import MOST, Texts
from serendipity.live.play.records import Event, Records, read
from serendipity.live.play.setting import CONDITIONS, Setting
from serendipity.live.play.table import Message, begun, play
from serendipity.model import UsageError

_FILE: Final = re.compile(r"P(\d{3,})\.jsonl")
_COMMENT: Final = 2_000
"""The longest comment, in characters."""


class Study:
    """Participants, rounds and questions; a file for each participant, written as they go on.

    Args:
        settings: of the scenarios; their conditions are those of the participants.
        folder: where the files are.
        texts: what participants read and are asked.
        seed: of the conditions' order.
    """

    def __init__(self, settings: Sequence[Setting], folder: Path, texts: Texts, seed: int) -> None:
        self._settings = tuple(settings)
        self._folder = folder
        self._texts = texts
        self._seed = seed
        self._stage = "consent"
        self._number = self._next_number()
        self._records: Records | None = None
        self._game: Game | None = None
        self._round = 0

    # -- what pages show

    def view(self) -> dict[str, Any]:
        """What pages show."""
        study = {
            "participant": self._name,
            "rounds": len(self._settings),
            "questions": list(self._texts.questions),
        }
        shown: dict[str, Any] = {"stage": self._stage, "round": self._round, "study": study}
        if self._stage == "consent":
            study["consent"] = list(self._texts.consent)
        elif self._stage == "play" and self._game is not None:
            told = {"thinking": None, "condition": None}  # which one it is, is not theirs to know
            shown |= {**self._game.view(), **told}
        return shown

    # -- what pages do

    def do(self, message: Message) -> dict[str, Any] | None:
        """What a page asks for; an answer for it alone, or None where all pages are to be told.

        Raises:
            UsageError: it asks for what there is not now.
        """
        what = message.get("do")
        if what == "act" and self._stage == "play":
            return self._act(message)
        steps = {"consent": self._consent, "questions": self._answer, "end": self._next}
        if what == "go on" and self._stage in steps:
            steps[self._stage](message)
            return None
        if what == "go on" and self._game is not None and self._game.done:
            self._stage = "questions"
            return None
        raise UsageError(f"expected something else at this point of the study, got {what!r:.50}")

    def events(self) -> list[Event]:
        """The events of all participants, as their files have them."""
        return [event for file in self._files() for event in read(file)]

    # -- from one point to the next

    def _consent(self, message: Message) -> None:
        if message.get("agree") is not True:
            raise UsageError("consent: nobody takes part without it")
        self._number = self._next_number()  # another server may use the folder, too
        self._records = Records(self._name, self._folder / f"{self._name}.jsonl")
        row = order(self._number // len(CONDITIONS), len(self._settings))
        self._order = row
        self._condition = condition(self._number, tuple(CONDITIONS), self._seed)
        names = [self._settings[i].name for i in row]
        self._records.add("consent", condition=self._condition, order=names, seed=self._seed)
        self._round = 0
        self._begin()

    def _begin(self) -> None:
        assert self._records is not None
        setting = replace(self._settings[self._order[self._round]], condition=self._condition)
        self._round += 1
        self._game = Game(setting)
        self._stage = "play"
        begun(self._game, self._round, self._records)

    def _act(self, message: Message) -> dict[str, Any] | None:
        assert self._game is not None
        assert self._records is not None
        return play(self._game, self._round, message, self._records)

    def _answer(self, message: Message) -> None:
        assert self._game is not None
        assert self._records is not None
        if message.get("round") != self._round:
            return  # another page was quicker
        answers, comment = message.get("answers"), message.get("comment", "")
        asked = self._texts.questions
        if not isinstance(answers, list) or len(answers) != len(asked):
            raise UsageError(f"answers: expected {len(asked)}")
        for answer in answers:
            if isinstance(answer, bool) or answer not in range(1, MOST + 1):
                raise UsageError(f"answers: expected whole numbers from 1 to {MOST}, got {answer!r:.50}")
        if not isinstance(comment, str) or len(comment) > _COMMENT:
            raise UsageError(f"comment: expected at most {_COMMENT} characters")
        about = {"round": self._round, "scenario": self._game.setting.name, "condition": self._condition}
        for question, answer in zip(asked, answers, strict=True):
            self._records.add("answer", **about, question=question, answer=answer)
        if comment.strip():
            self._records.add("answer", **about, question="comment", answer=comment.strip())
        if self._round < len(self._settings):
            self._begin()
        else:
            self._records.add("end", condition=self._condition)
            self._stage = "end"

    def _next(self, _message: Message) -> None:
        self._number, self._stage, self._game = self._next_number(), "consent", None

    @property
    def _name(self) -> str:
        return f"P{self._number + 1:03}"

    def _files(self) -> list[Path]:
        return sorted(file for file in self._folder.iterdir() if _FILE.fullmatch(file.name))

    def _next_number(self) -> int:
        numbers = [int(found[1]) for file in self._files() if (found := _FILE.fullmatch(file.name))]
        return max(numbers, default=0)
