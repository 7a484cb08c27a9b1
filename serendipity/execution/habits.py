"""Habits: the plans that somebody follows, and how often, from logs of their days.

Logs are those of ``execute --log``, or CSV with a header: ``time``, ``actor`` and ``action``, with a column
``day`` or a date in ``time`` (``2026-03-02T07:30``), and perhaps ``activity``, which says what for.  What the
human does for one activity without another one in between, else on one day, is an episode; so is a run.
"""

import csv
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import date, datetime, time
from fractions import Fraction
from itertools import groupby
from math import sqrt
from os import PathLike
from typing import Any, Final, NamedTuple

from serendipity.execution.log import LogLine, read_logs
from serendipity.model import Condition, InputError, PlanError, Task, UsageError, exact
from serendipity.model.answers.fields import written
from serendipity.model.arguments import PATH, TASK_IN_TIME, TEXT, expect, expect_or_none
from serendipity.model.numbers import Number
from serendipity.model.task.names import canonical_name
from serendipity.model.task.plans import PlanEntry
from serendipity.model.telling import Grid, Line, Output, counted
from serendipity.pddl.parsing.files import read_text
from serendipity.recognition.library import SCHEMA

DAYS: Final = ("mon", "tue", "wed", "thu", "fri", "sat", "sun")
_ON: Final = {**{day: {i} for i, day in enumerate(DAYS)}, "weekday": {*range(5)}, "weekend": {5, 6}}
NOTHING: Final = "nothing"
"""What comes before the first activity of a day."""

_NEAR: Final = 60
"""Minutes by which a time of day may differ."""
_SURE: Final = 1.959963984540054
"""Of a normal variable, 95 % are within so many standard deviations."""

Interval = tuple[float, float]


class Episode(NamedTuple):
    """Actions of the human's that belong together.

    Attributes:
        activity: what they are for; empty where nobody says.
        actions: their names, in order; with the epochs in which they begin where these say more.
        minute: of the day, in which it begins, or None.
        weekday: from 0, or None.
        before: the activity before it on its day.
    """

    activity: str
    actions: tuple[PlanEntry, ...]
    minute: int | None = None
    weekday: int | None = None
    before: str = NOTHING


@dataclass(frozen=True, slots=True)
class KnownPlan:
    """A plan, and how often it was followed.

    Attributes:
        name: its activity and a number.
        probability: that it is the next one.
        goal: what it brings about: the task's goal (None), or else all that it changes.
        plan: names of its actions, in time with the epochs in which they begin.
        count: episodes in which it was followed, of those that fit what was asked.
        interval: Wilson's, at 95 %, of its share of these.
    """

    name: str
    probability: float
    goal: tuple[str, ...] | None
    plan: tuple[PlanEntry, ...]
    count: int
    interval: Interval

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        shown = {**written(self), "interval": list(self.interval)}
        return shown if self.goal is not None else {n: value for n, value in shown.items() if n != "goal"}


@dataclass(frozen=True, slots=True, repr=False)
class Habits(Output):
    """The plans that somebody follows: a library, which is the JSON form.

    Attributes:
        human: who it is.
        episodes: how many were read.
        fitting: those that fit what was asked; probabilities are theirs, and of the others a little.
        plans: the most probable first.
        left_out: episodes that the human can't do alone from the task's initial state.
        reason: why not, of the first of them.
    """

    human: str
    episodes: int
    fitting: int
    plans: tuple[KnownPlan, ...]
    left_out: int = 0
    reason: str | None = None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        return {"schema": SCHEMA, **written(self), "plans": [plan.to_dict() for plan in self.plans]}

    def told(self) -> Iterator[Line | Grid]:
        """The lines that ``learn`` prints."""
        episodes, plans = counted(self.episodes, "episode"), counted(len(self.plans), "plan")
        yield Line(f"{episodes} of {self.human}, {self.fitting} fit, {plans}")
        if self.left_out:
            yield Line(f"{self.left_out} left out, the first one since {self.reason}")
        yield Line()
        rows = [
            (
                f"{one.probability:.4f}",
                str(one.count),
                "{:.3f} to {:.3f}".format(*one.interval),
                str(len(one.plan)),
                one.name,
            )
            for one in self.plans
        ]
        yield Grid(("probability", "count", "share (95 %)", "actions", "plan"), rows, numbered=True)

    def _in_short(self) -> Iterator[str]:
        yield f"{counted(len(self.plans), 'plan')} of {self.human}"


def learn(
    task: Task,
    traces: str | PathLike[str],
    *,
    on: str | None = None,
    at: str | None = None,
    after: str | None = None,
    usual: Number = 1,
) -> Habits:
    """The plans that the human follows, with their probabilities, counted in logs.

    Of the episodes that fit what is asked, ``n`` of ``N`` follow a plan, and of all ``m`` of ``M``: its
    probability is ``(n + usual * m / M) / (N + usual)``.  Without questions that is ``m / M``.

    Args:
        task: whose human it is; plans are from its initial state on.
        traces: the file of logs.
        on: a day as ``mon``, or ``weekday`` or ``weekend``.
        at: a time of day as ``7:30``: episodes fit that begin up to an hour earlier or later.
        after: the activity before; ``nothing`` at the start of a day.
        usual: how many episodes the habits at all times count for.

    Raises:
        InputError: a line of the file is wrong; it says where, and what was expected.
        UsageError: an option is.
    """
    expect(TASK_IN_TIME, task=task)
    expect(PATH, traces=traces)
    expect_or_none(TEXT, on=on, at=at, after=after)
    weight = exact(usual, "usual")
    if weight < 0:
        raise UsageError(f"usual: expected a number of at least 0, got {float(weight):g}")
    found = read_episodes(task, traces)
    goals = {actions: _goal_of(task, actions) for actions in dict.fromkeys(one.actions for one in found)}
    faults = [goal for one in found if isinstance(goal := goals[one.actions], PlanError)]
    known = [one for one in found if not isinstance(goals[one.actions], PlanError)]
    fitting = _fitting(known, on, at, after)
    if known and not fitting and not weight:
        raise UsageError("usual: expected a number above 0, since no episode fits")
    reason = faults[0].message if faults else None
    if not known:
        who = task.agents[task.human]
        raise InputError(f"expected a plan that {who} can follow{f': {reason}' if reason else ''}", traces)
    counts, usually = (Counter((one.activity, one.actions) for one in some) for some in (fitting, known))
    plans = []
    for number, (key, often) in enumerate(usually.most_common(), start=1):
        activity, actions = key
        usually_so = Fraction(often, len(known))
        probability = (counts[key] + weight * usually_so) / (len(fitting) + weight)
        name, goal, bounds = (
            f"{activity or 'plan'} {number}",
            goals[actions],
            wilson(counts[key], len(fitting)),
        )
        assert not isinstance(goal, PlanError), "of such plans none is known"
        plans.append(KnownPlan(name, float(probability), goal, actions, counts[key], bounds))
    plans.sort(key=lambda one: -one.probability)
    return Habits(task.agents[task.human], len(found), len(fitting), tuple(plans), len(faults), reason)


def _fitting(known: Sequence[Episode], on: str | None, at: str | None, after: str | None) -> list[Episode]:
    """The episodes that fit what is asked."""
    if on is not None and on not in _ON:
        raise UsageError(f"on: expected one of {', '.join(_ON)}, got '{on:.50}'")
    try:
        clock = None if at is None else time.fromisoformat(at.zfill(5))
    except ValueError:
        raise UsageError(f"at: expected a time of day as 7:30, got '{at:.50}'") from None
    minute = None if clock is None else _minute(clock)
    activities = sorted({one.activity for one in known if one.activity})
    if known and after not in (None, NOTHING, *activities):
        if not activities:
            raise UsageError("after: expected logs that say activities")
        raise UsageError(f"after: expected one of {', '.join((NOTHING, *activities))}, got '{after:.50}'")
    return [
        one
        for one in known
        if (on is None or one.weekday in _ON[on])
        and (minute is None or (one.minute is not None and _apart(one.minute, minute) <= _NEAR))
        and (after is None or one.before == after)
    ]


def _apart(one: int, other: int) -> int:
    """Minutes between two times of a day, midnight or not."""
    apart = abs(one - other)
    return min(apart, 24 * 60 - apart)


def wilson(count: int, of: int) -> Interval:
    """Wilson's interval (1927), at 95 %, of the probability of what was seen so often."""
    if not of:
        return 0.0, 1.0
    share, square = count / of, _SURE**2
    middle = (share + square / (2 * of)) / (1 + square / of)
    half = _SURE * sqrt(share * (1 - share) / of + square / (4 * of * of)) / (1 + square / of)
    return max(middle - half, 0.0), min(middle + half, 1.0)


def read_episodes(task: Task, traces: str | PathLike[str]) -> list[Episode]:
    """The episodes of the human's in a file of logs.

    Raises:
        InputError: a line is wrong; it says where, and what was expected.
    """
    text = read_text(traces)
    if text.lstrip().startswith("{"):
        runs = [run[1:] for run in read_logs(traces)]
        for number, value in (line for run in runs for line in run):
            if not value.keys() & {"human", "change", "drop"}:
                raise InputError("log: expected an epoch, a change or a drop", traces, number)
        done = [[x for x in run if x.value.get("human") and not x.value.get("in_vain")] for run in runs]
        entries = [[_entry(task, line, traces) for line in run] for run in done]
        acted = [[one for one in some if not task.waits(one[1])] for some in entries]
        timed = task.needs_time
        return [Episode("", tuple(some if timed else (name for _, name in some))) for some in acted if some]
    return [*_of_days(_rows(task, text, traces))]


def _entry(task: Task, line: LogLine, file: object) -> tuple[int, str]:
    """The epoch of a line of a log, and what the human begins in it; without time only their order counts."""
    action, epoch = _action(task, line.value["human"], file, line.number), line.value.get("epoch", 1)
    if not isinstance(epoch, int) or isinstance(epoch, bool) or epoch < 1:
        raise InputError(f"epoch: expected a whole number from 1 on, got {epoch!r:.50}", file, line.number)
    return epoch, action


class _LogRow(NamedTuple):
    day: str
    at: time
    weekday: int | None
    action: str
    activity: str


def _of_days(rows: Iterable[_LogRow]) -> Iterator[Episode]:
    for _, day in groupby(sorted(rows, key=lambda row: row[:2]), key=lambda row: row.day):
        before = NOTHING
        for activity, part in groupby(day, key=lambda row: row.activity):
            first, *more = part
            actions = tuple(row.action for row in (first, *more))
            yield Episode(activity, actions, _minute(first.at), first.weekday, before)
            before = activity


def _rows(task: Task, text: str, file: object) -> Iterator[_LogRow]:
    """The rows of the human's."""
    reader = csv.DictReader(text.splitlines(), skipinitialspace=True)
    reader.fieldnames = [name.strip().lower() for name in reader.fieldnames or ()]
    missing = [name for name in ("time", "actor", "action") if name not in reader.fieldnames]
    if missing:
        raise InputError(f"expected columns day, time, actor and action, got no '{missing[0]}'", file, 1)
    if len(set(reader.fieldnames)) < len(reader.fieldnames):
        raise InputError(f"expected each column once, got {', '.join(reader.fieldnames):.80}", file, 1)
    try:
        rows = [(reader.line_num, row) for row in reader]
    except csv.Error as error:
        raise InputError(f"expected CSV: {error}", file, reader.line_num) from None
    for line, row in rows:
        if None in row or None in row.values():
            raise InputError(f"expected {len(reader.fieldnames)} columns", file, line)
        if canonical_name(row["actor"]) not in task.agents:
            expected = ", ".join(task.agents)
            raise InputError(f"actor: expected one of {expected}, got '{row['actor']:.50}'", file, line)
        if canonical_name(row["actor"]) == task.agents[task.human]:
            activity, action = row.get("activity", "").strip(), _action(task, row["action"], file, line)
            if not task.waits(action):
                yield _LogRow(*_moment(row, file, line), action, activity)


def _moment(row: Mapping[str, str], file: object, line: int) -> tuple[str, time, int | None]:
    """The day, the time and the day of the week of a row."""
    day, clock = row.get("day", "").strip(), row["time"].strip()
    try:
        if not day:
            moment = datetime.fromisoformat(clock)
            day, at = moment.date().isoformat(), moment.time()
        else:
            at = time.fromisoformat(clock.zfill(5) if clock.count(":") == 1 else clock)
    except ValueError:
        form = "a time as 07:30" if day else "a date and a time as 2026-03-02T07:30"
        raise InputError(f"time: expected {form}, got '{clock:.50}'", file, line) from None
    try:
        weekday = date.fromisoformat(day).weekday()
    except ValueError:  # a day may have another name
        if re.fullmatch(r"\d+-\d+-\d+", day):
            raise InputError(f"day: expected a date as 2026-03-02, got '{day:.50}'", file, line) from None
        weekday = None
    return day, at.replace(tzinfo=None), weekday


def _minute(clock: time) -> int:
    return clock.hour * 60 + clock.minute


def _action(task: Task, name: Any, file: object, line: int) -> str:
    """The name of an action that there is."""
    bare = canonical_name(str(name).strip().strip("()"))
    if bare not in task.named and not task.waits(bare):
        raise InputError(f"action: there is no action '{bare:.100}' in the task", file, line)
    return bare


def _goal_of(task: Task, actions: Sequence[PlanEntry]) -> tuple[str, ...] | PlanError | None:
    """What a plan is for: None where that is the task's goal; or why it can't be followed."""
    free = task.with_goal(Condition())
    try:
        plan = free.plan_from_names(actions)
        last = free.replay_alone(plan)[-1]
    except PlanError as error:
        return error
    if task.goal and task.goal.holds(last):
        return None
    made = {fact.fact for fact in task.disjunctions}
    theirs = {fact for i in plan for part in task.actions[i].moments for fact in (*part.add, *part.delete)}
    changed = sorted((last ^ task.init) & theirs - made)
    return tuple(task.facts[i] if i in last else f"!{task.facts[i]}" for i in changed)
