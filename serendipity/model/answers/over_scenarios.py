"""An answer over scenarios in words: what it costs, what happens in each, what robots do (semantics 11)."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from serendipity.model.answers.histories import histories
from serendipity.model.answers.recognition import UNEXPLAINED
from serendipity.model.answers.result_parts import GoalAnswer
from serendipity.model.numbers import plain
from serendipity.model.task.facts import Facts
from serendipity.model.task.plans import Window
from serendipity.model.telling import Grid, Line

if TYPE_CHECKING:
    from serendipity.model.answers.result import Result
    from serendipity.model.task.task import Task

MEASURES: Final = {"mean": "expected cost", "worst": "greatest cost", "regret": "greatest regret"}
"""What the cost of an answer is, by ``risk``."""


def goal_of(result: "Result", entry: GoalAnswer) -> tuple[str, ...] | None:
    """The literals of a scenario's goal; None for that of the task.

    Args:
        entry: one of its scenarios, which has the name of its goal, or that and a plan's number.
    """
    known = {} if result.recognition is None else {one.name: one.goal for one in result.recognition.goals}
    if entry.goal is not None:
        return entry.goal
    return known.get(entry.name, known.get(entry.name.rpartition(" ")[0]))


def task_of(task: "Task", result: "Result") -> "Task":
    """The task with the goal of the one scenario that an answer is about; itself without one.

    Raises:
        UsageError: there is no such fact.
    """
    entries = result.goals or ()
    goal = goal_of(result, entries[0]) if len(entries) == 1 else None
    return task if goal is None else task.with_goal(Facts(task.facts).condition(goal))


def rule_told(result: "Result") -> Iterator[str]:
    """What the rules of help (semantics 12 to 14) cost, if anything, and what is paid for."""
    price, left = result.figure("rule_price"), result.statistics.get("left")
    if price:
        yield f"what help has to keep to costs {plain(price)}"
    if isinstance(left, dict) and left:
        told = ", ".join(f"{fact} ({plain(each)})" for fact, each in left.items())
        yield f"left changed, at a price: {told}"


def over_scenarios(result: "Result") -> Iterator[Line | Grid]:
    """The robots' plan, and what happens for each goal that is considered."""
    if result.status == "unknown":
        yield Line("the limit came before any answer")
        return
    entries = result.goals or ()
    if result.recognition is not None and not result.recognition.explained:
        yield Line(UNEXPLAINED)
    if result.cost is None:
        why = result.reason or result.status
        yield Line(f"no plan: {result.human} can reach none of the goals alone ({why})")
        return
    weight = plain(result.options.window_weight)
    gap = f"not proved; at least {plain(result.lower_bound)}, with {weight} for each epoch of a window"
    proof = "proved" if result.status == "optimal" else gap
    what = MEASURES[result.options.risk]
    if not result.opportunity:
        yield Line(f"the robots leave {result.human} alone: {what} {plain(result.cost)} ({proof})")
    else:
        saving = f"{plain(result.saving)} less than {plain((result.cost or 0) + (result.saving or 0))}"
        yield Line(f"{what} {plain(result.cost)}, {saving} ({proof})")
    yield from map(Line, rule_told(result))
    yield Line()
    header = ("", "probability", "cost", "window", "goal" if result.recognition else "plan")
    rows = [
        (str(number), f"{entry.probability:.4f}", plain(entry.cost), _window(entry.window), entry.name)
        for number, entry in enumerate(entries, start=1)
    ]
    yield Grid(header, rows, numbered=True)
    yield from _policy(result, entries)


def _policy(result: "Result", entries: Sequence[GoalAnswer]) -> Iterator[Line | Grid]:
    """What robots do, and what they have seen by then."""
    if len(entries) == 1 or result.options.policy == "fixed":
        told = [("", step) for step in result.plan or ()]
    else:
        tree = histories(entries, result.human, int(result.horizon or 0))
        told = [
            (", ".join(str(i + 1) for i in history.scenarios), step)
            for history in tree
            for step in (history.robots if result.opportunity else ())
        ]
    if not told:
        return
    yield Line()
    if not told[0][0]:
        yield Line("everybody does:" if len(entries) == 1 else "whatever it is, robots do:")
        steps = [(str(step.epoch), ", ".join(step.agents), step.action) for _, step in told]
        yield Grid(("epoch", "agents", "action"), steps, numbered=True)
        return
    yield Line(f"robots watch {result.human}, and do:")
    rows = [(str(step.epoch), ", ".join(step.agents), step.action, possible) for possible, step in told]
    yield Grid(("epoch", "agents", "action", "while it may be"), rows, numbered=True)


def _window(window: Window | None) -> str:
    return "-" if window is None else f"[{window.start}, {window.end})"
