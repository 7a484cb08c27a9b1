"""Why no help is possible: what would be, if one rule were relaxed."""

from dataclasses import dataclass
from typing import Any, Final

from serendipity.explanation.ask import Ask
from serendipity.facade.interruptibility import InterruptionReport, Removal, removal
from serendipity.model import Result, Window
from serendipity.model.answers.fields import written

RULES: Final = {
    "window-length": "a longer interruption (window_weight 0)",
    "prefix": "telling the human (communication mode)",
    "max_window": "longer windows (no max_window)",
    "suffix": "letting the human replan after the window (suffix replan)",
    "preservation": "keeping only what the human needs (preservation kernel)",
    "interference": "the paper's interference rule",
    "max_cost": "dearer plans (no max_cost)",
}
"""The rules that can be relaxed, and what that means."""

_LOOSEST: Final = {
    "max_window": None,
    "suffix": "replan",
    "preservation": "kernel",
    "interference": "paper",
    "max_cost": None,
}
"""The loosest value of each option that restricts plans."""


@dataclass(frozen=True, slots=True)
class Miss:
    """What relaxing one rule would give.

    Attributes:
        rule: a key of ``RULES``.
        cost: of the answer then.
        saving: against the human's own plan.
        window: of the answer then, or the shortest that its cost needs.
        removal: what would disappear from their plan, and what would replace it.
    """

    rule: str
    cost: float
    saving: float
    window: Window | None
    removal: Removal

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return {
            **written(self, ("rule", "cost", "saving", "window")),
            "removed": list(self.removal.removed),
            "replacement": list(self.removal.replacement),
        }


def misses(ask: Ask, report: InterruptionReport | None) -> tuple[Miss, ...]:
    """For each rule the answer without it, where that is an opportunity; cheapest first."""
    found = []
    for rule, changes in _relaxations(ask):
        answer = ask(**changes)
        if answer.opportunity and answer.cost is not None and answer.saving is not None:
            window = answer.window or _shortest(report, answer)
            found.append(Miss(rule, answer.cost, answer.saving, window, removal_of(answer)))
    return tuple(sorted(found, key=lambda miss: miss.cost))


def removal_of(answer: Result) -> Removal:
    """What an answer takes out of the human's plan, and what they do instead."""
    steps = sorted(answer.plan or (), key=lambda step: step.epoch)
    executed = tuple(step.action for step in steps if answer.human in step.agents)
    return removal(answer.human_plan or (), executed)


def _relaxations(ask: Ask) -> list[tuple[str, dict[str, Any]]]:
    options = ask.options
    wanted: list[tuple[str, dict[str, Any]]] = []
    if options.windowed and options.window_weight > 0:
        wanted.append(("window-length", {"window_weight": 0}))
    if options.mode == "serendipity":
        wanted.append(("prefix", {"mode": "communication", "keep_prefix": False}))
    for name, loosest in _LOOSEST.items():
        if getattr(options, name) != loosest:
            wanted.append((name, {name: loosest}))
    return wanted


def _shortest(report: InterruptionReport | None, answer: Result) -> Window | None:
    """The shortest window in which the team can have the answer's cost."""
    windows = [
        entry.window
        for entry in (report.windows if report else ())
        if entry.team_cost is not None and float(entry.team_cost) == answer.cost
    ]
    return min(windows, key=lambda window: (len(window), -window.start), default=None)
