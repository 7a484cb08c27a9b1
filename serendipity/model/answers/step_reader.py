"""Reading plans and windows from JSON, with one clear line for what is wrong."""

from typing import Any

from serendipity.model.answers.fields import finite, names
from serendipity.model.errors import InputError
from serendipity.model.options import MAX_EPOCH
from serendipity.model.task.plans import PlanStep, Window


class StepReader:
    """Reads values of a result.

    Args:
        file: named in errors.
    """

    def __init__(self, file: object) -> None:
        self.file = file

    def error(self, message: str) -> InputError:
        """What to raise."""
        return InputError(f"result: {message}", self.file)

    def finite(self, value: Any, where: str, *, signed: bool = False) -> float:
        """A finite number, at least 0 unless it is ``signed``.

        Raises:
            InputError: it is something else; so do all other methods.
        """
        number = finite(value)
        if number is None:
            raise self.error(f"{where}: expected a finite number, got {value!r:.50}")
        if number < 0 and not signed:
            raise self.error(f"{where}: expected a number of at least 0, got {value!r:.50}")
        return number

    def epoch(self, value: Any, where: str) -> int:
        """An epoch."""
        if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= MAX_EPOCH:
            raise self.error(f"{where}: expected an epoch from 1 to {MAX_EPOCH}, got {value!r:.50}")
        return value

    def window(self, value: Any) -> Window | None:
        """A window; None for null."""
        if value is None:
            return None
        if not isinstance(value, dict) or set(value) != {"start", "end"}:
            raise self.error(f"window: expected an object with 'start' and 'end', got {value!r:.50}")
        start = self.epoch(value["start"], "window.start")
        end = self.epoch(value["end"], "window.end")
        if start >= end:
            raise self.error(f"window: expected start < end, got [{start}, {end})")
        return Window(start, end)

    def plan(self, value: Any) -> tuple[PlanStep, ...] | None:
        """The steps of a plan; None for null."""
        if value is None:
            return None
        if not isinstance(value, list):
            raise self.error(f"plan: expected a list of steps, got {value!r:.50}")
        return tuple(self._step(step, f"plan[{i}]") for i, step in enumerate(value))

    def _step(self, step: Any, where: str) -> PlanStep:
        if not isinstance(step, dict) or set(step) != {"epoch", "agents", "action", "cost"}:
            raise self.error(f"{where}: expected an object with epoch, agents, action and cost only")
        agents, action = names(step["agents"]), step["action"]
        if agents is None or not isinstance(step["agents"], list):
            raise self.error(f"{where}.agents: expected a list of names, got {step['agents']!r:.50}")
        if not isinstance(action, str):
            raise self.error(f"{where}.action: expected a text, got {action!r:.50}")
        cost = self.finite(step["cost"], f"{where}.cost")
        return PlanStep(self.epoch(step["epoch"], f"{where}.epoch"), agents, action, cost)
