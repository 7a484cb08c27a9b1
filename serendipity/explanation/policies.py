"""What robots wait to see, and what seeing it is worth, in an answer over scenarios (semantics 11)."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

from serendipity.facade.planning import plan
from serendipity.model import Deadline, Result, Task, UsageError
from serendipity.model.answers.answer import Status
from serendipity.model.answers.fields import Written, written
from serendipity.model.answers.histories import History, histories
from serendipity.model.answers.over_scenarios import goal_of
from serendipity.model.answers.result_parts import GoalAnswer
from serendipity.model.arguments import RESULT_IN_TIME, TASK_IN_TIME, expect
from serendipity.model.numbers import as_written, plain
from serendipity.model.resources.limits import limits_from
from serendipity.model.telling import Grid, Line, Output

_FIELDS: Final = ("answer", "committed", "knowing", "signs", "watching")


@dataclass(frozen=True, slots=True)
class Sign(Written):
    """Something that robots see, and what they know by it.

    Attributes:
        action: what the human does; None where they wait.
        before: scenarios that were possible, by their places in the answer.
        after: those that still are.
        waited_for: whether robots did nothing by themselves as long as they did not know it.
    """

    epoch: int
    action: str | None
    before: tuple[int, ...]
    after: tuple[int, ...]
    waited_for: bool


@dataclass(frozen=True, slots=True)
class PolicyExplanation(Output):
    """Why robots do what they do while several scenarios are possible.

    Attributes:
        answer: what is explained.
        committed: what robots come to that see nothing; None where a limit came first.
        knowing: what they would come to if they knew the scenario from the start; None likewise.
        signs: what they see, in order.
        watching: what robots come to that watch; None likewise.
    """

    answer: Result
    committed: Fraction | None
    knowing: Fraction | None
    signs: tuple[Sign, ...]
    watching: Fraction | None

    @property
    def status(self) -> Status:
        """That of the answer."""
        return self.answer.status

    def _in_short(self) -> Iterator[str]:
        yield from self.answer._in_short()
        yield f"{len(self.signs)} signs"

    def to_dict(self) -> dict[str, Any]:
        """The JSON object (schema ``serendipity.policy-explanation/1``)."""
        return {"schema": "serendipity.policy-explanation/1", **written(self, _FIELDS)}

    def told(self) -> Iterator[Line | Grid]:
        """The lines that ``explain`` prints."""
        yield from self.answer.told()
        yield Line()
        watches = self.answer.options.policy == "watching"
        if self.committed is not None and self.watching is not None:
            worth = plain(self.committed - self.watching)
            if watches:
                yield Line(f"watching is worth {worth}: committed robots cost {plain(self.committed)}")
            else:
                yield Line(f"watching would be worth {worth}: robots that watch cost {plain(self.watching)}")
        if self.knowing is not None and self.watching is not None:
            worth = plain(self.watching - self.knowing)
            yield Line(f"knowing it from the start would be worth {worth} more")
        if not self.signs:
            return
        yield Line()
        rows = [
            (
                str(sign.epoch),
                sign.action or "(waits)",
                ", ".join(str(i + 1) for i in sign.after),
                "yes" if sign.waited_for else "",
            )
            for sign in self.signs
        ]
        yield Grid(
            ("epoch", f"{self.answer.human} does", "so it is", "robots waited for it"), rows, numbered=True
        )


def explain_policy(
    task: Task,
    result: Result,
    *,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
) -> PolicyExplanation:
    """What robots wait to see in an answer over scenarios, and what watching is worth (semantics 11).

    Args:
        task: the task.
        result: the answer; its options hold.
        time_limit: seconds for all calls together; what they leave no time for is left out.
        memory_limit: what the process may have in memory, in MiB, or None.
        deadline: one that other work shares; it holds beside both limits.

    Raises:
        UsageError: the answer is about no scenarios, or none that has a mean cost.
    """
    limits = limits_from(time_limit, memory_limit, deadline)
    expect(TASK_IN_TIME, task=task)
    expect(RESULT_IN_TIME, result=result)
    entries = result.goals or ()
    if len(entries) < 2 or result.cost is None:
        raise UsageError("explain: expected an answer over several goals or plans")
    if (risk := result.options.risk) != "mean":
        raise UsageError(
            f"explain: expected an answer over several goals or plans with risk mean, got {risk}"
        )
    library = _library(result, entries)
    asked: dict[str, Any] = {**result.options.but(ties="fixed", time_limit=None, memory_limit=None).to_dict()}
    watches = result.options.policy == "watching"
    other = plan(
        task, plans=library, deadline=limits, **asked | {"policy": "fixed" if watches else "watching"}
    )
    committed, watching = (other, result) if watches else (result, other)
    known = [plan(task, plans=[one], deadline=limits, **asked) for one in library]
    costs = [
        Fraction(one["probability"]) * as_written(found.cost or 0)
        for one, found in zip(library, known, strict=True)
    ]
    tree = histories(entries, result.human, int(result.horizon or 0))
    return PolicyExplanation(
        result,
        _proved_cost(committed),
        sum(costs, Fraction(0)) if all(found.status == "optimal" for found in known) else None,
        tuple(_signs(tree, result.human)) if watches else (),
        as_written(result.cost) if watches else _proved_cost(watching),
    )


def _proved_cost(answer: Result) -> Fraction | None:
    return as_written(answer.cost or 0) if answer.status == "optimal" else None


def _library(result: Result, scenarios: tuple[GoalAnswer, ...]) -> list[dict[str, Any]]:
    """The scenarios as a library of plans."""
    found = []
    for number, entry in enumerate(scenarios, start=1):
        plan, times = entry.human_plan or (), entry.human_plan_times
        entries = list(plan if times is None else times.entries(plan))
        one: dict[str, Any] = {"name": entry.name or str(number), "plan": entries}
        one["probability"] = str(as_written(entry.probability))
        goal = goal_of(result, entry)
        found.append(one | ({} if goal is None else {"goal": list(goal)}))
    return found


def _signs(history: History, human: str) -> Iterator[Sign]:
    own = any(human not in step.agents for step in history.robots)
    for branch in history.branches:
        action = None if branch.seen is None else branch.seen.action
        yield Sign(branch.start - 1, action, history.scenarios, branch.scenarios, not own)
        yield from _signs(branch, human)
