"""What a program of a proof file is about, read from its name: which plans, of how many epochs."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from serendipity.model import Options, Result, Task

_NAME = re.compile(
    r"(all plans|every window|pi_H as planned), (\d+) epochs(, robots idle)?(, cost at most (-?\d+))?"
)


class NotMadeError(ValueError):
    """A question that is not made a second time; the text says why."""


@dataclass(frozen=True)
class PlansAsked:
    """Which plans are asked about, at what price.

    Attributes:
        human_plan: ``pi_H`` by ids; empty where there is none.
        rule: ``all plans``, ``every window``, or ``pi_H as planned``.
        suffixes: epochs and states from which the human's optimal plan is to be known (Def. 2.0a).
    """

    task: Task
    options: Options
    human_plan: Sequence[int]
    epochs: int
    rule: str
    robots: bool = True
    most_cost: Fraction | None = None
    suffixes: Sequence[tuple[int, frozenset[int]]] = ()


def require_no_time(task: Task, options: Options) -> None:
    """A NotMadeError for a call in time."""
    if task.needs_time or task.due or options.waiting_cost or options.head_start:
        raise NotMadeError("semantics 10")


def question_of(task: Task, result: Result, entry: Mapping[str, Any]) -> PlansAsked:
    """The question of a program; a NotMadeError for others, time, and one of the human's several plans."""
    told = _NAME.fullmatch(entry["name"])
    if told is None or "/" not in entry["unit"] or not int(told[2]):
        raise NotMadeError(f"{entry['name']}; unit {entry['unit']}")
    if len(result.ties or ()) > 1:
        raise NotMadeError("ties")
    require_no_time(task, result.options)
    numbers = {fact: f for f, fact in enumerate(task.facts)}
    suffixes = [
        (each["epoch"], frozenset(numbers[f] for f in each["state"])) for each in entry.get("suffixes", ())
    ]
    plan = task.plan_from_names(result.human_plan) if result.human_plan else ()
    most = None if told[5] is None else int(told[5]) * Fraction(entry["unit"])
    return PlansAsked(task, result.options, plan, int(told[2]), told[1], told[3] is None, most, suffixes)
