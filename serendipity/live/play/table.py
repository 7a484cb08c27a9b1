"""Where rounds are played: every page shows the same one, and each event is recorded."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from serendipity.live.play.game import Game
from serendipity.live.play.records import Event, Records
from serendipity.live.play.setting import Setting
from serendipity.model import UsageError

Message = Mapping[str, Any]


class Table:
    """Rounds of one setting, again and again.

    Args:
        setting: what is played.
        file: where every event is written down when it happens; None: nowhere.
    """

    def __init__(self, setting: Setting, file: Path | None = None) -> None:
        self._setting = setting
        self._records = Records("player", file)
        self._round = 0
        self._begin()

    def view(self) -> dict[str, Any]:
        """What pages show."""
        return {"stage": "play", "round": self._round, "study": None, **self._game.view()}

    def do(self, message: Message) -> dict[str, Any] | None:
        """What a page asks for; an answer for it alone, or None where all pages are to be told.

        Raises:
            UsageError: it asks for what there is not.
        """
        what = message.get("do")
        if what == "act":
            return play(self._game, self._round, message, self._records)
        if what == "again":
            self._records.add("again", round=self._round)
            self._begin()
            return None
        if what == "panel":
            self._records.add(
                "panel", round=self._round, epoch=self._game.run.epoch, open=bool(message.get("open"))
            )
            return {}
        if what == "explain" and self._game.done:
            return {"kind": "explanation", "sentences": self._game.explanation()}
        raise UsageError(f"expected act, again, panel or, at the end, explain, got {what!r:.50}")

    def events(self) -> list[Event]:
        """All that has happened."""
        return list(self._records.events)

    def _begin(self) -> None:
        self._round += 1
        self._game = Game(self._setting)
        begun(self._game, self._round, self._records)


def begun(game: Game, number: int, records: Records) -> None:
    """Record that a round begins."""
    setting = game.setting
    records.add(
        "begun",
        round=number,
        scenario=setting.name,
        condition=setting.condition,
        view=setting.view,
        discount=str(setting.discount),
        alone_cost=game.alone,
    )


def play(game: Game, number: int, message: Message, records: Records) -> dict[str, Any] | None:
    """An action of the person, if it is about the epoch that is to come; another page may have been quicker.

    Raises:
        UsageError: there is no such action.
    """
    if message.get("round") != number or message.get("epoch") != game.run.epoch:
        return {}
    action = message.get("action")
    if action is not None and not isinstance(action, str):
        raise UsageError(f"action: expected a name, got {action!r:.50}")
    passed = game.act(action)
    records.add(
        "epoch",
        round=number,
        scenario=game.setting.name,
        condition=game.setting.condition,
        epoch=passed.epoch,
        action=passed.human or "wait",
        in_vain=passed.in_vain,
        steps=[f"{'+'.join(step.agents)}: {step.action}" for step in passed.steps],
        verdict=passed.decided.verdict,
        reason=passed.decided.reason,
        goals=dict(passed.decided.goals),
        offers=[step.action for step in passed.decided.offers],
        decision_seconds=round(passed.decided.seconds, 4),
        human_cost=passed.human_cost,
        team_cost=passed.cost,
        alone_cost=game.alone,
        done=passed.done,
    )
    return None
