"""What a page shows of time: the clock, what goes on, what happens by itself (semantics 10.6)."""

from collections.abc import Iterable
from typing import Any

from serendipity.execution import Execution
from serendipity.model import PlanStep, Task
from serendipity.model.numbers import plain
from serendipity_live.play.labels import Phrases
from serendipity_live.play.language import Language


class ClockView:
    """Time as the person sees it, and what happens in it."""

    def __init__(self, task: Task, words: Phrases, say: Language) -> None:
        self._task = task
        self._words = words
        self._say = say
        self._human = task.agents[task.human]
        self._others: frozenset[tuple[int, str]] = frozenset()
        """What bystanders were at in the epoch before."""

    def view(self, run: Execution) -> dict[str, Any]:
        """The time when the epoch begins, whether the person is at something, and what others are at."""
        going = run.going
        others = [step for step in going if self._human not in step.agents]
        return {
            "clock": plain((run.epoch - 1) * self._task.epoch) if self._task.needs_time else None,
            "busy": self.busy(going) is not None,
            "going": [
                f"{self._words.robots(step)}: {self.lasting(self._words.step(step), step.duration)}"
                for step in others
            ],
        }

    def busy(self, going: Iterable[PlanStep]) -> PlanStep | None:
        """What the person is at, of what goes on."""
        return next((step for step in going if self._human in step.agents), None)

    def lasting(self, text: str, epochs: int) -> str:
        """An action in words, with the epochs that it takes."""
        return text if epochs == 1 else self._say("{action} ({epochs} epochs)", action=text, epochs=epochs)

    def happened(self, before: Task) -> list[str]:
        """What bystanders have begun in an epoch, and what the script has changed, by the task before it."""
        script, words = before.script, self._words
        deeds = [deed for deed in script.begun(1) if deed.agent in script.people]
        begun = [deed for deed in deeds if (deed.agent, deed.name) not in self._others]
        self._others = frozenset((deed.agent, deed.name) for deed in deeds)
        (true, false), state = script.changes(1), before.init
        return [
            *(f"{words.thing(before.agents[d.agent])}: {words.action(d.variants[0])}" for d in begun),
            *(self._say("now: {fact}", fact=words.fact(fact)) for fact in sorted(true - state)),
            *(self._say("no longer: {fact}", fact=words.fact(fact)) for fact in sorted(false & state)),
        ]
