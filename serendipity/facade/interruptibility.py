"""Interruptions that would help the human: every window, with the best possible in it (semantics 3.2)."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import Any, Final, Unpack

from search.modes.interruptions import Interruptions, WindowOutcome
from search.modes.interruptions import interruptions as search_windows
from serendipity.facade.call import Request, checked_call, options_from
from serendipity.facade.in_time import in_units
from serendipity.facade.prepared import HELD
from serendipity.facade.results import named_steps, plan_times
from serendipity.model import Deadline, Options, PlanStep, Step, Table, Task, UsageError, Window
from serendipity.model.answers.fields import written
from serendipity.model.arguments import FUNCTION, TASK_IN_TIME, expect, expect_or_none
from serendipity.model.errors import LIMITS, limit_reason, limit_words
from serendipity.model.keywords import InterruptionOptions, listing
from serendipity.model.numbers import plain
from serendipity.model.resources.collection import no_collection
from serendipity.model.resources.limits import limits_from
from serendipity.model.table import Cell, Tabular
from serendipity.model.task.execution import actions_of
from serendipity.model.task.gate import needs_time
from serendipity.model.task.horizon import horizon_of, require_few_epochs
from serendipity.model.task.plans import PlanEntry, PlanTimes
from serendipity.model.task.unit_steps import unit_steps
from serendipity.model.telling import Grid, Line, Output

SCHEMA: Final = "serendipity.interruptions/1"

_COLUMNS: Final = {
    "window_start": int,
    "window_end": int,
    "human_cost": float,
    "team_cost": float,
    "human_saving": float,
    "team_saving": float,
    "removed_first": int,
    "removed_last": int,
    "removed": str,
    "replacement": str,
    "informative": bool,
}

_COSTS: Final = ("human_cost", "team_cost", "human_saving", "team_saving")

_OPTIONS: Final = tuple(InterruptionOptions.__annotations__)
"""The options that make a difference here."""


@dataclass(frozen=True, slots=True)
class Removal:
    """The part of ``pi_H`` that a plan takes out, and what the human does instead (Def. 2.0).

    Attributes:
        first: ``i``, from 1.
        last: ``j``; ``first - 1`` where nothing is removed.
        removed: names of ``pi_H[i..j]``.
        replacement: names of what stands in its place.
    """

    first: int
    last: int
    removed: tuple[str, ...]
    replacement: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Interruption:
    """The best that is possible in one window; costs in the domain's unit.

    Attributes:
        window: the window.
        human_cost: least undiscounted cost of what the human takes part in; None if no plan fits.
        team_cost: least cost for the team, perhaps of another plan.
        human_saving: cost(pi_H) - ``human_cost``.
        team_saving: cost of doing nothing - ``team_cost``.
        removal: what the plan with ``human_cost`` removes and puts in place.
        plan: that plan.
        informative: no window within this one, of those examined, saves the human as much, or none the team.
    """

    window: Window
    human_cost: Fraction | None
    team_cost: Fraction | None
    human_saving: Fraction | None
    team_saving: Fraction | None
    removal: Removal | None
    plan: tuple[PlanStep, ...] | None
    informative: bool = False

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        gone = self.removal
        removed = None
        if gone is not None and gone.removed:
            removed = {"first": gone.first, "last": gone.last, "actions": list(gone.removed)}
        return {
            **written(self, ("window", *_COSTS)),
            "removed": removed,
            "replacement": None if gone is None else list(gone.replacement),
            **written(self, ("plan", "informative")),
        }

    def cells(self) -> tuple[Cell, ...]:
        """The cells of its row; names of actions with ``; `` between them."""
        gone = self.removal
        taken = (gone.first, gone.last, "; ".join(gone.removed)) if gone and gone.removed else (None,) * 3
        instead = None if gone is None else "; ".join(gone.replacement)
        window = (self.window.start, self.window.end)
        return (*window, *written(self, _COSTS).values(), *taken, instead, self.informative)


@dataclass(frozen=True, slots=True, repr=False)
class InterruptionReport(Tabular, Output):
    """The report of semantics 3.2.

    Attributes:
        human: the human's name.
        human_plan: names of ``pi_H``, or None where they have no plan alone (no report then).
        human_cost: cost(pi_H).
        team_cost: what doing nothing for them costs the team.
        horizon: ``T``.
        interruptible: whether they pay less in some window (Def. 2.1); None where a limit came first.
        windows: ascending; where a limit came first, those that were examined.
        options: in force.
        limit: which limit that was (as ``Result.reason`` has it); None where the report is complete.
        human_plan_times: of ``pi_H``, as in :class:`serendipity.model.Result`.
    """

    human: str
    human_plan: tuple[str, ...] | None
    human_cost: Fraction | None
    team_cost: Fraction | None
    horizon: int | None
    interruptible: bool | None
    windows: tuple[Interruption, ...]
    options: Options
    limit: str | None = None
    human_plan_times: PlanTimes | None = None

    def table(self) -> Table:
        """The windows that were examined, one a row."""
        return Table(_COLUMNS, tuple(window.cells() for window in self.windows))

    @property
    def complete(self) -> bool:
        """Whether every window was examined."""
        return self.limit is None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object (schema ``serendipity.interruptions/1``)."""
        options = self.options.to_dict()
        timed = [] if self.human_plan_times is None else ["human_plan_times"]
        names = (
            "limit",
            "human",
            "human_plan",
            *timed,
            "human_cost",
            "team_cost",
            "horizon",
            "interruptible",
        )
        return {
            "schema": SCHEMA,
            "complete": self.complete,
            **written(self, names),
            "reason": "no-human-plan" if self.human_plan is None else None,
            **written(self, ("windows",)),
            "options": {name: options[name] for name in _OPTIONS if name in options},
        }

    def told(self, *, every: bool = False) -> Iterator[Line | Grid]:
        """The lines that ``interruptions`` prints; with ``every``, those of ``--all``."""
        if self.human_plan is None:
            yield Line(f"{self.human} can't reach the goal alone: there is no plan to interrupt")
            return
        verdicts = {True: "can be", False: "can't be", None: "may or may not be"}
        yield Line(
            f"{self.human}'s plan ({len(self.human_plan)} actions, cost {plain(self.human_cost)}) "
            f"{verdicts[self.interruptible]} interrupted to {self.human}'s advantage"
        )
        if self.limit is not None:
            yield Line(f"{limit_words(self.limit)}: only these windows were examined", "yellow")
        shown = [entry for entry in self.windows if every or entry.informative]
        if len(shown) < len(self.windows):
            less = f"{len(shown)} of {len(self.windows)} windows save more than every window within them"
            yield Line(f"{less}; --all shows the others, too")
        if not shown:
            return
        yield Line()
        who = self.human
        header = ("window", f"{who} pays", "team pays", f"{who} saves", "team saves", "removed", "instead")
        rows = []
        for entry in shown:
            gone = entry.removal
            removed = f"{gone.first}..{gone.last}" if gone is not None and gone.removed else ""
            window = f"[{entry.window.start}, {entry.window.end})"
            costs = (plain(getattr(entry, name)) for name in _COSTS)
            instead = "" if gone is None else "; ".join(gone.replacement)
            rows.append((window, *costs, removed, instead))
        helpful = (i for i, entry in enumerate(shown) if entry.human_saving and entry.human_saving > 0)
        yield Grid(header, rows, frozenset(helpful), numbered=True)

    def _in_short(self) -> Iterator[str]:
        yield self.human
        yield f"{len(self.windows)} windows"
        yield f"interruptible {self.interruptible}"

    def _repr_html_(self) -> str:
        return f"{self._repr_svg_()}{Output._repr_html_(self)}"

    def _repr_svg_(self) -> str:
        return str(drawn(self, ".svg"))


def drawn(report: InterruptionReport, suffix: str) -> str | bytes:
    """A report as heat maps beside each other: what the human saves by window, and what the team does.

    Args:
        suffix: ``.svg`` or ``.png``.

    Raises:
        UsageError: there is no such form, or PNG lacks the extra ``plot``.
    """
    from serendipity.pictures import draw_windows

    maps = {
        f"{report.human} saves at most": {entry.window: entry.human_saving for entry in report.windows},
        "the team saves at most": {entry.window: entry.team_saving for entry in report.windows},
    }
    times = report.human_plan_times
    starts = len(report.human_plan or ()) if times is None else times.epochs
    return draw_windows(maps, starts, report.horizon or 0, suffix)


@listing
def interruptions(
    task: Task,
    *,
    human_plan: Iterable[PlanEntry] | None = None,
    on_progress: Callable[[int, int], None] | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
    **options: Unpack[InterruptionOptions],
) -> InterruptionReport:
    """For each window the best for the human and the best for the team.

    Where a limit comes first, the report is about the windows that were examined by then, and
    says that it is not complete.

    Args:
        task: the task.
        human_plan: the human's plan, as for :func:`serendipity.plan`; None predicts it.
        on_progress: called with the number of searches done, and of all (two for each window).
        time_limit: seconds, or None.
        memory_limit: what the process may have in memory, in MiB, or None.
        deadline: one that other work shares; it holds beside both limits.
        **options: ``discount``, ``horizon``, ``suffix``, ``preservation``, ``interference``,
            ``waiting_cost``, ``head_start``.

    Raises:
        UsageError: an option is not one of these, or has no legal value.
        PlanError: ``human_plan`` can't be executed, or misses the goal.
        LimitReachedError: a limit came before it was known what the human is going to do.
    """
    expect(TASK_IN_TIME, task=task)
    limits = limits_from(time_limit, memory_limit, deadline)
    expect_or_none(FUNCTION, on_progress=on_progress)
    for name in options:
        if name not in _OPTIONS:
            raise UsageError(f"interruptions: expected options among {', '.join(_OPTIONS)}, got '{name}'")
    chosen = options_from(options)
    given = None if human_plan is None else partial(task.plan_from_names, human_plan)
    with HELD.taken(task) as prepared, no_collection():  # beside a large task a collection takes long
        call = checked_call(prepared, chosen, given, None, None, limits)
        if needs_time(task, options=chosen, plan=call.given):
            return _in_time(call, on_progress)
        found = _searched(call, on_progress)
        if found is None:
            return _alone_impossible(task, chosen)
        return _reported(task, chosen, found, task.cost_of(found.human_plan))


def _searched(call: Request, on_progress: Callable[[int, int], None] | None) -> Interruptions | None:
    asked: dict[str, Any] = {"human_plan": call.given, "deadline": call.limits, "on_progress": on_progress}
    return search_windows(call.prepared, call.options, **asked) if call.predicts else None


def _in_time(call: Request, on_progress: Callable[[int, int], None] | None) -> InterruptionReport:
    """The report where epochs count: looked for in single ones, told in whole actions."""
    require_few_epochs(call.task)
    units = unit_steps(call.task, call.limits, call.options.waiting_cost)
    found = _searched(in_units(call, units), on_progress)
    if found is None:
        return _alone_impossible(call.task, call.options)
    plan = units.begun(found.human_plan)
    horizon_of(call.task, call.options, plan)  # which says whether what it reaches lasts
    windows = (
        one if one.steps is None else replace(one, steps=units.steps(one.steps)) for one in found.windows
    )
    told = replace(found, human_plan=plan, windows=windows)
    return _reported(call.task, call.options, told, units.task.cost_of(found.human_plan))


def _alone_impossible(task: Task, options: Options) -> InterruptionReport:
    human = task.agents[task.human]
    return InterruptionReport(human, None, None, None, None, interruptible=False, windows=(), options=options)


def _reported(task: Task, options: Options, found: Interruptions, alone: Fraction) -> InterruptionReport:
    """The windows examined before a limit comes, each put into words at once: that takes time, too."""
    windows: dict[Window, Interruption] = {}
    limit = None
    try:
        for outcome in found.windows:
            windows[outcome.window] = _interruption(task, options, found, alone, outcome)
    except LIMITS as error:
        limit = limit_reason(error)
    helps = any(w.human_saving is not None and w.human_saving > 0 for w in windows.values())
    # What fits some window fits the largest one, but for what `state` asks of its end.
    largest = options.preservation == "kernel" and any(len(window) == found.horizon for window in windows)
    known = helps or limit is None or largest
    return InterruptionReport(
        human=task.agents[task.human],
        human_plan=tuple(task.actions[i].name for i in found.human_plan),
        human_cost=alone,
        team_cost=found.baseline,
        horizon=found.horizon,
        interruptible=helps if known else None,
        windows=_marked([windows[window] for window in sorted(windows)]),
        options=options,
        limit=limit,
        human_plan_times=plan_times(task, found.human_plan),
    )


def _interruption(
    task: Task, options: Options, found: Interruptions, alone: Fraction, outcome: WindowOutcome
) -> Interruption:
    steps = outcome.steps
    return Interruption(
        window=outcome.window,
        human_cost=outcome.human_cost,
        team_cost=outcome.team_cost,
        human_saving=_less(alone, outcome.human_cost),
        team_saving=_less(found.baseline, outcome.team_cost),
        removal=None if steps is None else _removal(task, found.human_plan, steps),
        plan=None if steps is None else named_steps(task, options.discount, steps),
    )


def _marked(windows: list[Interruption]) -> tuple[Interruption, ...]:
    """The same windows; those that say something that no window within them says are marked."""
    for_human = _informative({entry.window: entry.human_saving for entry in windows})
    for_team = _informative({entry.window: entry.team_saving for entry in windows})
    return tuple(replace(w, informative=w.window in for_human or w.window in for_team) for w in windows)


def _informative(savings: dict[Window, Fraction | None]) -> set[Window]:
    """The windows that save something, and more than every window within them."""
    most: dict[tuple[int, int], Fraction] = {}
    found = set()
    for window in sorted(savings, key=len):
        within = ((window.start + 1, window.end), (window.start, window.end - 1))
        before = max((most.get(smaller, Fraction(0)) for smaller in within), default=Fraction(0))
        saving = savings[window] or Fraction(0)
        if saving > before:
            found.add(window)
        most[window.start, window.end] = max(before, saving)
    return found


def removal(former: tuple[str, ...], executed: tuple[str, ...]) -> Removal:
    """The part of ``former`` that is gone in ``executed``: common beginning and end are left out."""
    shortest = min(len(former), len(executed))
    begin = next((k for k in range(shortest) if former[k] != executed[k]), shortest)
    rest = shortest - begin
    end = next((k for k in range(rest) if former[-1 - k] != executed[-1 - k]), rest)
    last = len(former) - end
    return Removal(begin + 1, last, former[begin:last], executed[begin : len(executed) - end])


def _removal(task: Task, human_plan: tuple[int, ...], steps: tuple[Step, ...]) -> Removal:
    executed = (a.name for a in actions_of(task, sorted(steps)) if task.human in a.participants)
    return removal(tuple(task.actions[i].name for i in human_plan), tuple(executed))


def _less(before: Fraction | None, after: Fraction | None) -> Fraction | None:
    return None if before is None or after is None else before - after
