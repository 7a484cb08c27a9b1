"""The scene: all that a picture of a plan shows, epoch by epoch, before it is drawn; and its headline."""

import re
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import takewhile

from serendipity.model import PlanStep, Result, Task
from serendipity.model.answers.histories import History
from serendipity.model.answers.over_scenarios import over_scenarios
from serendipity.model.answers.result import headlines
from serendipity.model.numbers import plain, short
from serendipity.model.task.variables import Variable
from serendipity.model.telling import Line
from serendipity.pictures.map.layout import MapLayout
from serendipity.pictures.map.places import Whereabouts


@dataclass(frozen=True, slots=True)
class Span:
    """A value that a lane has after each of the epochs ``first .. last`` (0: initially)."""

    first: int
    last: int
    value: str


@dataclass(frozen=True, slots=True)
class Change:
    """A lane: a fact by itself, or a variable of several facts.

    Attributes:
        label: the fact, or what its values share.
        goal: whether it is a literal of the human's goal.
        spans: when it has which value; a fact by itself, and a goal, only while it is true.
    """

    label: str
    goal: bool
    spans: tuple[Span, ...]


def find_changes(
    task: Task, states: Sequence[frozenset[int]], last: int, hidden: Set[int]
) -> tuple[Change, ...]:
    """Lanes of what changes, and of the human's goals; first goals, then in order of change.

    Goals that hold all the time say nothing; they have a lane only where that is all there is to say.

    Args:
        states: after each epoch, from 0.
        last: epoch up to which lanes are drawn; the last state lasts till then.
        hidden: facts that the map shows already.
    """
    goals = [_goal(task, states, last, fact, wanted=True) for fact in task.goal.positive]
    goals += [_goal(task, states, last, fact, wanted=False) for fact in task.goal.negative]
    lanes = [goal for goal in goals if [(s.first, s.last) for s in goal.spans] != [(0, last)]] or goals
    shown = {*task.goal.positive, *task.goal.negative, *hidden}
    found = []
    for variable in task.variables:
        if (variable.boolean and variable.facts[0] in shown) or not hidden.isdisjoint(variable.facts):
            continue
        values = [tuple(f for f in variable.facts if f in state) for state in states]
        changes = [epoch for epoch in range(1, len(values)) if values[epoch] != values[epoch - 1]]
        if changes:
            names = [", ".join(task.facts[f] for f in value) for value in values]
            found.append((changes[0], Change(_shared(task, variable), False, _spans(names, last))))
    found.sort(key=lambda entry: entry[0])
    return (*lanes, *(change for _, change in found))


def _goal(task: Task, states: Sequence[frozenset[int]], last: int, fact: int, *, wanted: bool) -> Change:
    """The lane of one literal of the goal: when it holds."""
    name = task.facts[fact] if wanted else f"not {task.facts[fact]}"
    return Change(name, True, _spans([name if (fact in state) == wanted else "" for state in states], last))


def _spans(names: Sequence[str], last: int) -> tuple[Span, ...]:
    """Runs of equal values; an empty one has no span."""
    spans: list[Span] = []
    for epoch, name in enumerate(names):
        end = last if epoch == len(names) - 1 else epoch
        if spans and spans[-1].last == epoch - 1 and spans[-1].value == name:
            spans[-1] = Span(spans[-1].first, end, name)
        elif name:
            spans.append(Span(epoch, end, name))
    return tuple(spans)


def _shared(task: Task, variable: Variable) -> str:
    """What the names of a variable's facts have in common: word by word, else the thing they speak of."""
    if variable.boolean:
        return task.facts[variable.facts[0]]
    first, *others = (task.facts[f].split() for f in variable.facts)
    words = [
        word if all(i < len(other) and other[i] == word for other in others) else "·"
        for i, word in enumerate(first)
    ]
    if set(words) != {"·"}:
        return " ".join(words)
    named = [word for word in first if all(word in other for other in others)]
    return " ".join(named) or " / ".join(task.facts[f] for f in variable.facts[:3])


@dataclass(frozen=True, slots=True)
class Act:
    """An action for the timeline, in two short lines ("go to", a place), and by its full name and epochs."""

    epoch: int
    agents: tuple[int, ...]
    verb: str
    detail: str
    action: str
    duration: int = 1

    @property
    def end(self) -> int:
        """The epoch with which it ends."""
        return self.epoch + self.duration - 1


@dataclass(frozen=True, slots=True)
class Meeting:
    """Something changes hands, or agents act jointly, in a place; None without a map."""

    epoch: int
    place: str | None
    objects: tuple[str, ...]
    text: str


@dataclass(frozen=True, slots=True)
class Frame:
    """The world after an epoch (0: initially).

    Attributes:
        at: place by agent id, for agents with a position.
        objects: where each object is.
        former_at: where the human would be with their former plan, or None without a map.
        made, undone: names of the facts that became true and false in this epoch.
        spent: team costs so far by agent id; joint actions are shared equally.
        former_spent: cost of the human's former plan so far.
        caption: who does what, for people.
    """

    epoch: int
    at: dict[int, str]
    objects: dict[str, Whereabouts]
    former_at: str | None = None
    made: tuple[str, ...] = ()
    undone: tuple[str, ...] = ()
    spent: dict[int, Fraction] = field(default_factory=dict)
    former_spent: Fraction = Fraction(0)
    caption: str = ""
    in_window: bool = False

    @property
    def cost(self) -> Fraction:
        """The team's cost so far."""
        return sum(self.spent.values(), Fraction(0))


@dataclass(frozen=True)
class Scene:
    """A plan ready to be drawn.

    Attributes:
        agents: names by id; ``human`` is an id.
        frames: epoch 0, 1, ... to the end of the plan or of the former plan, whichever is later.
        layout: of the map, or None where the task has none.
        goals: places that the human's goal names.
        acts, former_acts: the two plans.
        changes: facts that change, for the lanes below the timeline.
        vehicles: objects that others can be in or on.
        bystanders: ids of the people whose plans are fixed.
        marks: by epoch the facts that the script changes, ``not`` in front of those that become false.
        unit: of a plan in time, the length of an epoch in the unit of the input; else None.
        scenario: the place in the result of the scenario that is played; None without scenarios.
        histories: of all scenarios, where there are several, each before its branches.
        told: the steps of all scenarios in words.
    """

    name: str
    agents: tuple[str, ...]
    human: int
    result: Result
    frames: tuple[Frame, ...]
    layout: MapLayout | None = None
    goals: tuple[str, ...] = ()
    acts: tuple[Act, ...] = ()
    former_acts: tuple[Act, ...] = ()
    meetings: tuple[Meeting, ...] = ()
    changes: tuple[Change, ...] = ()
    vehicles: frozenset[str] = frozenset()
    bystanders: frozenset[int] = frozenset()
    marks: Mapping[int, tuple[str, ...]] = field(default_factory=dict)
    unit: Fraction | None = None
    scenario: int | None = None
    histories: tuple[History, ...] = ()
    told: Mapping[PlanStep, Act] = field(default_factory=dict)

    @property
    def lanes(self) -> tuple[int, ...]:
        """Agent ids as the timeline shows them: the human first, bystanders last."""
        return tuple(sorted(range(len(self.agents)), key=lambda i: (i != self.human, i in self.bystanders)))

    @property
    def people(self) -> frozenset[int]:
        """Ids of those who are drawn as persons."""
        return self.bystanders | {self.human}

    def title(self, agent: int) -> str:
        """The name of an agent, and whether it is a bystander."""
        return f"{self.agents[agent]} (bystander)" if agent in self.bystanders else self.agents[agent]

    def clock(self, epoch: int) -> str:
        """The times between which an epoch lies; empty where a plan is not in time."""
        if self.unit is None or not epoch:
            return ""
        return f"{plain((epoch - 1) * self.unit)}–{plain(epoch * self.unit)}"

    @cached_property
    def deviates(self) -> bool:
        """Whether the human does anything but their former plan, where that is known."""
        if not self.former_acts:
            return False
        own = [(act.epoch, act.action) for act in self.acts if self.human in act.agents]
        return own != [(act.epoch, act.action) for act in self.former_acts]

    @property
    def legend(self) -> dict[str, str]:
        """What a picture needs samples of besides the agents, with what they mean."""
        together = [w for frame in self.frames for w in frame.objects.values()]
        contains = any(w.carrier or w.riders or w.holder is not None for w in together)
        meanings = {
            "former": (self.deviates, f"{self.agents[self.human]}'s former plan"),
            "window": (self.result.window is not None, "window"),
            "meeting": (bool(self.meetings), "hand-over or joint action"),
            "together": (contains, "in it, on it or carried"),
        }
        return {kind: text for kind, (there, text) in meanings.items() if there}

    @property
    def key_epoch(self) -> int:
        """The epoch that says most: the first meeting, else the window's start, else the end."""
        if self.meetings:
            return self.meetings[0].epoch
        window = self.result.window
        return self.frames[-1].epoch if window is None else window.start


def headline(scene: Scene) -> str:
    """What happens first that helps, else the answer in a line."""
    return _told(scene)[0]


def subtitle(scene: Scene) -> str:
    """The task, and the rest of what the text of the answer begins with."""
    return " · ".join((scene.name, *_told(scene)[1:]))


def _told(scene: Scene) -> list[str]:
    if scene.histories:
        told = (part.text for part in over_scenarios(scene.result) if isinstance(part, Line))
        return [_in_short(line) for line in takewhile(bool, told)]
    lines = [_in_short(line) for line in headlines(scene.result)]
    if scene.result.opportunity and scene.meetings:
        first = scene.meetings[0]
        return [f"{first.text[:1].upper()}{first.text[1:]} at epoch {first.epoch}", *lines]
    return lines


def _in_short(words: str) -> str:
    """The same with no figure of more than four digits, integers left aside."""
    return re.sub(r"(?<![\w.-])\d+\.\d+(?![\w.])", lambda found: short(float(found[0])), words)


def scenario_lines(scene: Scene) -> Iterator[tuple[str, bool]]:
    """A line for each of several scenarios, and whether it is the one that is played."""
    for i, entry in enumerate(scene.result.goals or () if scene.histories else ()):
        window = f", window [{entry.window.start}, {entry.window.end})" if entry.window else ""
        words = f"probability {entry.probability:.4g}, cost {short(entry.cost or 0)}{window}"
        yield f"{i + 1} {entry.name}: {words}", i == scene.scenario
