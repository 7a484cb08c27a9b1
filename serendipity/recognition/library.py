"""Libraries of plans: what the human may be about to do, each plan with its probability (semantics 8).

A file is a JSON object, ``{"schema": "serendipity.plans/1", "plans": [...]}``, and a plan in it one, too:
``{"name": ..., "probability": ..., "goal": [literals], "plan": [actions], "count": ..., "interval": ...}``.
``goal`` is the task's where there is none; ``count`` and ``interval`` inform people.  An action is a line of
a file of ``--human-plan``, with the time at which it begins or without, or ``[epoch, action]``.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from os import PathLike
from typing import Any, Final

from serendipity.model import Condition, HumanPlan, InputError, PlanError, Task, UsageError, exact
from serendipity.model.arguments import LIST, TASK_IN_TIME, Kind, expect
from serendipity.model.schemas import schema_fault
from serendipity.model.task.plans import PlanEntry, checked_entries
from serendipity.pddl.parsing.files import read_text
from serendipity.pddl.parsing.lists import json_value
from serendipity.pddl.parsing.timed_plans import entries, plan_lines
from serendipity.recognition.recognise import CandidateGoal, literals_of

SCHEMA: Final = "serendipity.plans/1"

LibraryGiven = str | PathLike[str] | Mapping[str, Any] | Iterable[Mapping[str, Any]]
"""A file of plans, its JSON object, or the list in it."""

_FIELDS: Final = ("name", "probability", "goal", "plan", "count", "interval")


@dataclass(frozen=True, slots=True)
class LibraryPlan:
    """A plan that the human may follow.

    Attributes:
        name: for people.
        probability: above 0; those of a library add up to 1.
        goal: what it is for, over the task's fact ids.
        plan: that reaches the goal from the task's initial state.
        literals: of the goal, those that have to be false with ``!`` in front.
    """

    name: str
    probability: Fraction
    goal: Condition
    plan: HumanPlan
    literals: tuple[str, ...]

    @property
    def aim(self) -> CandidateGoal:
        """Its goal, as one that the human may have."""
        return CandidateGoal(self.name, self.literals, self.goal, self.probability)


def plan_library(task: Task, given: LibraryGiven) -> tuple[LibraryPlan, ...]:
    """The plans of a library that are possible, their probabilities scaled so that they add up to 1.

    Args:
        task: whose human they are of; each is replayed from its initial state.
        given: a file, its JSON object, or the list of plans in it.

    Raises:
        InputError: something is missing or of another type, a name stands there twice, a fact is unknown, a
            probability is negative or no number, or their sum is 0.
        PlanError: an action is unknown, not theirs or not applicable, or the goal is missed.
        UsageError: ``given`` is none of these.
    """
    expect(TASK_IN_TIME, task=task)
    file = given if isinstance(given, str | PathLike) else None
    ids = {fact: i for i, fact in enumerate(task.facts)}
    found: dict[str, LibraryPlan] = {}
    for number, item in enumerate(_items(given), start=1):
        try:
            one = _plan(task, item, number, ids)
            if one.name in found:
                raise InputError(f"there are two plans named '{one.name}'")
        except PlanError as error:
            message = error.message.removeprefix("human plan")
            raise PlanError(f"plan {number}{message}", file, step=error.step) from None
        except InputError as error:
            where = "" if error.line is None else f", action {error.line}"
            raise InputError(f"plan {number}{where}: {error.message}", file) from None
        found[one.name] = one
    total = sum((one.probability for one in found.values()), Fraction(0))
    if not total:
        raise InputError("plans: expected probabilities with a sum above 0", file)
    scaled = (replace(one, probability=one.probability / total) for one in found.values())
    return tuple(one for one in scaled if one.probability)


def _items(given: LibraryGiven) -> list[Any]:
    """The plans that a caller lists.

    Raises:
        InputError: it is no library.
        UsageError: it is nothing of the kind.
    """
    file = given if isinstance(given, str | PathLike) else None
    value: Any = given if file is None else json_value(read_text(file), file)
    if file is None and not isinstance(given, Mapping):
        expect(Kind("a file, an object or a list of plans", LIST.fits), plans=given)
        return list(value)
    if not isinstance(value, Mapping):
        raise InputError(f"plans: expected a JSON object with the schema '{SCHEMA}'", file)
    if fault := schema_fault(value.get("schema"), SCHEMA):
        raise InputError(f"plans: {fault}", file)
    if not isinstance(value.get("plans"), list | tuple):
        raise InputError(f"plans: expected a list, got {value.get('plans')!r:.50}", file)
    return list(value["plans"])


def _plan(task: Task, item: Any, number: int, ids: Mapping[str, int]) -> LibraryPlan:
    """One plan, its probability as it is given.

    Raises:
        InputError: something is wrong with it.
    """
    if not isinstance(item, Mapping):
        raise InputError(f"expected an object with probability and plan, got {item!r:.50}")
    unknown = sorted(str(key) for key in item.keys() - set(_FIELDS))
    if unknown:
        raise InputError(f"unknown field '{unknown[0]:.50}': expected {', '.join(_FIELDS)}")
    name = item.get("name", f"plan {number}")
    if not isinstance(name, str):
        raise InputError(f"name: expected a text, got {name!r:.50}")
    try:
        probability = exact(item.get("probability"), "probability")  # type: ignore[arg-type]
    except UsageError as error:
        raise InputError(str(error)) from None
    if probability < 0:
        raise InputError(f"probability: expected a number of at least 0, got {item['probability']}")
    goal = item.get("goal")
    literals, wanted = (task.goal.literals(task.facts), task.goal) if goal is None else literals_of(goal, ids)
    aimed = task.with_goal(wanted)
    return LibraryPlan(name, probability, wanted, aimed.plan_from_names(_entries(aimed, item)), literals)


def _entries(task: Task, item: Mapping[str, Any]) -> Sequence[PlanEntry]:
    """The actions of a plan: lines of a plan file, or names with the epochs in which they begin.

    Raises:
        InputError: they are neither.
    """
    actions = item.get("plan")
    if isinstance(actions, list | tuple) and all(isinstance(text, str) for text in actions):
        lines = plan_lines("\n".join(" ".join(action.split()) for action in actions), None)
        return entries(lines, task, None)
    try:
        return checked_entries(actions, "plan")  # type: ignore[arg-type]
    except UsageError:
        raise InputError(f"plan: expected a list of actions, got {actions!r:.50}") from None
