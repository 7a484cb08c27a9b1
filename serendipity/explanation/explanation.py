"""What an explanation consists of, and its JSON form (schema ``serendipity.explanation/1``)."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import groupby
from typing import Any, Final

from serendipity.explanation.ask import Ask, Parts, Threshold
from serendipity.explanation.person import Reaction, play
from serendipity.explanation.waiting import Wait
from serendipity.facade.interruptibility import Interruption, InterruptionReport, Removal, removal
from serendipity.model import Result, Window
from serendipity.model.answers.fields import Written, written
from serendipity.model.numbers import as_written
from serendipity.model.task.gate import nobody_pays
from serendipity.model.telling import Grid, Line, Output

WHY: Final = {
    "chosen": "this is the answer",
    "as-good": "costs the team as much; the later start is preferred",
    "saves-less": "would save less",
    "not-in-time": "too early: robots can't be there in time",
    "costs-more": "would cost as much as it saves, or more",
    "prefix": "too late: by then the plan that is followed leaves nothing to save",
    "nothing": "no robot can make the human's plan cheaper",
}
"""What the reasons mean."""


@dataclass(frozen=True, slots=True)
class Moment(Written):
    """One start of the window.

    Attributes:
        start: ``xi1``.
        window: the best window that starts there.
        cost: least cost for the team in it, or None where no plan fits.
        why: a key of ``WHY``.
        instead: the nearest window from there that would help, if any.
        saving: what the team saves in ``instead`` (``not-in-time``), or the human does (``costs-more``).
    """

    start: int
    window: Window
    cost: Fraction | None
    why: str
    instead: Window | None = None
    saving: Fraction | None = None


def moments(report: InterruptionReport, answer: Result) -> tuple[Moment, ...]:
    """Each start, judged by the objective of the call that is explained."""
    weight = answer.options.window_weight
    starts: dict[int, list[Interruption]] = {}
    for entry in report.windows:
        starts.setdefault(entry.window.start, []).append(entry)
    return tuple(_moment(start, entries, report, answer, weight) for start, entries in sorted(starts.items()))


def _moment(
    start: int, entries: list[Interruption], report: InterruptionReport, answer: Result, weight: Fraction
) -> Moment:
    fitting = [entry for entry in entries if entry.team_cost is not None]
    if not fitting:
        return Moment(start, entries[0].window, None, "prefix")

    def order(entry: Interruption) -> tuple[Fraction, Fraction, int]:
        assert entry.team_cost is not None
        return entry.team_cost + weight * len(entry.window), entry.team_cost, len(entry.window)

    best = min(fitting, key=order)
    cost = best.team_cost
    if answer.window is not None and answer.window.start == start:
        return Moment(start, answer.window, cost, "chosen")
    if _positive(best.team_saving):
        as_good = answer.cost is not None and cost == as_written(answer.cost)
        return Moment(start, best.window, cost, "as-good" if as_good else "saves-less")
    later = next((entry for entry in fitting if _positive(entry.team_saving)), None)
    if later is not None:
        return Moment(start, best.window, cost, "not-in-time", later.window, later.team_saving)
    dear = next((entry for entry in fitting if _positive(entry.human_saving)), None)
    if dear is not None:
        return Moment(start, best.window, cost, "costs-more", dear.window, dear.human_saving)
    return Moment(start, best.window, cost, "prefix" if report.interruptible else "nothing")


def _positive(value: Fraction | None) -> bool:
    return value is not None and value > 0


RULES: Final = {
    "window-length": "a longer interruption (window_weight 0)",
    "prefix": "telling the human (communication mode)",
    "max_window": "longer windows (no max_window)",
    "suffix": "letting the human replan after the window (suffix replan)",
    "preservation": "keeping only what the human needs (preservation kernel)",
    "interference": "the paper's interference rule",
    "max_cost": "dearer plans (no max_cost)",
    "leave_free": "leaving anything changed (no leave_free)",
    "leave_price": "leaving anything changed for nothing (no leave_price)",
    "max_disturbance": "disturbing the human more (no max_disturbance)",
    "noticed": "help that the human has not noticed (without noticed)",
    "nobody_pays": "help for which somebody pays (somebody-pays)",
    "local": "planning for people who see everything (human model observant)",
    "sight": "planning for people who do what the plan says, told or not (human model omniscient)",
    "no_block": "leaving them without a plan of their own meanwhile (allow-block)",
}
"""The rules that can be relaxed, and what that means."""

_LOOSEST: Final = {
    "max_window": None,
    "suffix": "replan",
    "preservation": "kernel",
    "interference": "paper",
    "max_cost": None,
    "leave_free": None,
    "leave_price": None,
    "max_disturbance": None,
    "noticed": False,
}
"""The loosest value of each option that restricts plans."""


_OF_WINDOWS: Final = ("max_window", "suffix", "preservation")
"""Those without effect where there are no windows."""

TOLD: Final = {
    "mode": "communication",
    "keep_prefix": False,
    "human_model": "omniscient",
    "no_block": None,
    "noticed": False,
}
"""The changes with which the human is told."""


@dataclass(frozen=True, slots=True)
class Miss:
    """What relaxing one rule would give.

    Attributes:
        rule: a key of ``RULES``.
        window: of the answer then, or the shortest that its cost needs.
        removal: what would disappear from their plan, and what would replace it.
        departs: what becomes of it beside the human as they are, who replan; None of others.
    """

    rule: str
    cost: float
    saving: float
    window: Window | None
    removal: Removal
    departs: str | None = None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return {
            **written(self, ("rule", "cost", "saving", "window")),
            "removed": list(self.removal.removed),
            "replacement": list(self.removal.replacement),
            **({} if self.departs is None else {"departs": self.departs}),
        }


def misses(ask: Ask, report: InterruptionReport | None) -> tuple[Miss, ...]:
    """For each rule the answer without it, where that is an opportunity; cheapest first."""
    found, model = [], ask.options.human_model
    for rule, changes in _relaxations(ask):
        answer = ask(**changes)
        if answer.opportunity and answer.cost is not None and answer.saving is not None:
            window = answer.window or _shortest(report, answer)
            departs = play(ask.task, answer, model, ask.deadline).reason if model != "omniscient" else None
            found.append(Miss(rule, answer.cost, answer.saving, window, removal_of(answer), departs))
    return tuple(sorted(found, key=lambda miss: miss.cost))


def removal_of(answer: Result) -> Removal:
    """What an answer takes out of the human's plan, and what they do instead."""
    steps = sorted(answer.plan or (), key=lambda step: step.epoch)
    executed = tuple(step.action for step in steps if answer.human in step.agents)
    return removal(answer.human_plan or (), executed)


def _relaxations(ask: Ask) -> list[tuple[str, dict[str, Any]]]:
    options = ask.options
    replans = options.human_model != "omniscient"
    wanted: list[tuple[str, dict[str, Any]]] = []
    if options.windowed and not replans and options.window_weight > 0:
        wanted.append(("window-length", {"window_weight": 0}))
    if options.mode == "serendipity":
        wanted.append(("prefix", TOLD))
    if options.human_model == "local":
        wanted.append(("local", {"human_model": "observant"}))
    if replans:
        wanted.append(("sight", {"human_model": "omniscient", "no_block": None}))
        wanted += [("no_block", {"no_block": False})] if options.no_block is not False else []
    if nobody_pays(ask.task, options):
        wanted.append(("nobody_pays", {"nobody_pays": False}))
    for name, loosest in _LOOSEST.items():
        if getattr(options, name) != loosest and not (replans and name in _OF_WINDOWS):
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


SCHEMA: Final = "serendipity.explanation/1"

_OF_ANSWER: Final = ("mode", "opportunity", "human_cost", "cost", "saving", "reason")


@dataclass(frozen=True, slots=True, repr=False)
class Explanation(Output):
    """Why an answer is what it is.

    Attributes:
        removal: what disappears from the human's plan and what replaces it; None without help.
        parts: what the answer's plan costs; None without a plan.
        moments: each start of the window; empty where windows play no part.
        discount: where help begins to pay; None where that is not computed.
        window_weight: the greatest ``K`` at which longer interruptions help; None where not computed.
        announcement: the answer in communication mode, or None.
        misses: what would help if a rule were relaxed; empty where a robot helps anyway.
        waits: actions that begin no sooner, and why, as far as script, head start or the human's plan say.
        at_once: the answer without the head start; None where there is none, or no help.
        reaction: what a human who replans makes of help; None beside others, and without help.
        epoch: how long an epoch is, in the unit of the input; None where nothing takes time.
        sentences: all of it in words, topic by topic.
        limit: which limit came before everything was found out (as ``Result.reason`` has it), or None.
        left_out: what is missing for it: ``moment``, ``discount``, ``window_weight``,
            ``announcement``, ``head_start``, ``person``, ``contrast``, ``miss``.
    """

    answer: Result
    removal: Removal | None
    parts: Parts | None
    moments: tuple[Moment, ...]
    discount: Threshold | None
    window_weight: Threshold | None
    announcement: Result | None
    misses: tuple[Miss, ...]
    waits: tuple[Wait, ...] = ()
    at_once: Result | None = None
    reaction: Reaction | None = None
    epoch: Fraction | None = None
    sentences: tuple[tuple[str, str], ...] = ()
    limit: str | None = None
    left_out: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether nothing is missing for want of time or memory."""
        return self.limit is None

    def told(self) -> Iterator[Line | Grid]:
        """What ``explain`` prints: the sentences, topic by topic."""
        for i, (topic, several) in enumerate(groupby(self.sentences, key=lambda sentence: sentence[0])):
            yield from [Line()] if i else []
            yield Line(topic, "bold")
            yield from (Line(f"  {text}") for _, text in several)

    def _in_short(self) -> Iterator[str]:
        yield from self.answer._in_short()
        yield f"{len(self.sentences)} sentences"

    def to_dict(self) -> dict[str, Any]:
        """The JSON object (schema ``serendipity.explanation/1``)."""
        answer, gone, told, early = self.answer, self.removal, self.announcement, self.at_once
        return {
            "schema": SCHEMA,
            "complete": self.complete,
            **written(self, ("limit", "left_out")),
            **{name: getattr(answer, name) for name in _OF_ANSWER},
            "removed": None if gone is None else list(gone.removed),
            "removed_first": None if gone is None else gone.first,
            "removed_last": None if gone is None else gone.last,
            "replacement": None if gone is None else list(gone.replacement),
            "human_part": None if self.parts is None else float(self.parts.human),
            "robot_part": None if self.parts is None else float(self.parts.discounted(answer.options)),
            **({"left_part": float(self.parts.left)} if self.parts is not None and self.parts.left else {}),
            **written(self, ("moments",)),
            "break_even_discount": None if self.discount is None else self.discount.to_dict(),
            "break_even_window_weight": None if self.window_weight is None else self.window_weight.to_dict(),
            "announcement": None if told is None else {"cost": told.cost, "opportunity": told.opportunity},
            **written(self, ("misses", *(() if self.epoch is None else ("epoch", "waits")))),
            **({} if early is None else {"at_once": {"cost": early.cost, "opportunity": early.opportunity}}),
            **({} if self.reaction is None else {"reaction": self.reaction.to_dict()}),
            "sentences": [{"topic": topic, "text": text} for topic, text in self.sentences],
            "options": answer.options.to_dict(),
        }
