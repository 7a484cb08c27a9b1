"""Planning calls as values, and seeded random ones."""

from dataclasses import dataclass, field
from random import Random
from typing import Any

from serendipity.model import Task
from serendipity.model.task.plans import PlanEntry
from serendipity_testing.generator.families import FAMILIES
from serendipity_testing.generator.human_plans import plan_after_detour, random_human_plan
from serendipity_testing.generator.numbers import odd_options, oddly_priced
from serendipity_testing.generator.tasks import random_task
from verify.base.optimal_plans import OptimalPlans

_DISCOUNTS = ("0", "0.25", "1/3", "0.5", "0.6", "0.9", "1")
_MODES = ("serendipity", "serendipity", "communication", "communication", "composite", "individual")
_CHOICES: dict[str, tuple[str, ...]] = {
    "window_weight": ("1000", "1000", "0", "0.25", "0.75", "2"),
    "max_window": ("", "", "1", "2"),
    "suffix": ("", "", "subplan"),
    "preservation": ("", "", "", "state"),
    "interference": ("", "", "strict"),
    "max_cost": ("", "", "", "", "human", "1", "2", "3"),
    "ties": ("", "", "", "optimistic", "robust", "expected"),
}
_ODD = 0.2
"""The share of calls with numbers that are hard to add up."""

_FLAGS = {"keep_prefix": "", "no_block": "--allow-block", "nobody_pays": "--somebody-pays", "noticed": ""}
"""Options that are true or false, each with what says that it is false."""


@dataclass(frozen=True)
class PlanCall:
    """A task and the options of ``plan`` that are not the default, as text.

    Attributes:
        human_plan: names of the actions of ``pi_H`` where it is given, in time with their epochs.
        seed: what :func:`random_call` made it from, and what is asked beside it; None if nothing has.
    """

    task: Task
    options: dict[str, str] = field(default_factory=dict)
    human_plan: tuple[PlanEntry, ...] | None = None
    seed: int | None = None

    def keywords(self) -> dict[str, Any]:
        """The options as the facade takes them."""
        return {name: value == "true" if name in _FLAGS else value for name, value in self.options.items()}

    def command_words(self) -> list[str]:
        """The options as the command line takes them."""
        words = []
        for name, value in self.options.items():
            option = name.replace("_", "-")
            if name not in _FLAGS:
                words += [f"--{option}", value]
            elif value == "true":
                words.append(f"--{option}")
            elif _FLAGS[name]:
                words.append(_FLAGS[name])
        return words


def random_call(seed: int) -> PlanCall:
    """A small random task, half the time of a family, with random options; equal seeds give equal calls.

    One in five has numbers that are hard to add up; which, and what numbers, has dice of its own.
    """
    numbers = Random(f"numbers {seed}")
    odd = numbers.random() < _ODD
    family = Random(f"family {seed}").choice(("",) * len(FAMILIES) + tuple(FAMILIES))
    dice = Random(f"crosscheck {seed}")
    task = random_task(dice, family)
    options = random_options(dice)
    if odd:
        task, options = oddly_priced(numbers, task), odd_options(numbers, options)
    plan = None
    if dice.random() < 0.25:
        plan = (plan_after_detour if family else random_human_plan)(dice, task)
    known = OptimalPlans(task).canonical() if family and plan is None else plan
    length = 0 if known is None else len(known)
    if options.get("horizon", "inf") != "inf" and (plan is not None or length > int(options["horizon"])):
        options["horizon"] = str(length + dice.choice((0, 0, 1, 2)))
    names = None if plan is None else tuple(task.actions[i].name for i in plan)
    return PlanCall(task, options, names, seed)


def random_options(dice: Random, mode: str = "") -> dict[str, str]:
    """A mode, if none is given, and options that it takes."""
    mode = mode or dice.choice(_MODES)
    chosen = {"mode": mode, "discount": dice.choice(_DISCOUNTS)}
    for name, values in _CHOICES.items():
        value = dice.choice(values)
        if value:
            chosen[name] = value
    if mode == "communication":
        chosen["communication_weight"] = dice.choice(("0", "0.25", "1", "2"))
        if dice.random() < 0.3:
            chosen["keep_prefix"] = "true"
    if mode == "serendipity" and dice.random() < 0.2:
        chosen["human_model"] = dice.choice(("observant", "local"))
        if dice.random() < 0.3:
            chosen["no_block"] = "false"
    if dice.random() < 0.4 and mode != "individual":
        chosen["horizon"] = dice.choice(("3", "4", "5", "6"))
    elif mode == "composite" and dice.random() < 0.3:
        chosen["horizon"] = "inf"
    return chosen
