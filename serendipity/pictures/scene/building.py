"""How a result becomes a scene: its plan, and the human's former one, replayed in words and places."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain, groupby
from typing import Final

from serendipity.model import GroundAction, InputError, PlanStep, Result, Task
from serendipity.model.task.actions import State
from serendipity.model.task.course import BrokenPlanError, PlayedPlan
from serendipity.model.task.execution import actions_named, shares, variant_named
from serendipity.model.task.plans import PlanTimes
from serendipity.model.task.whole_actions import whole
from serendipity.pictures.map.layout import lay_out
from serendipity.pictures.map.places import Places, Whereabouts, find_places
from serendipity.pictures.scene.crowds import cell_size
from serendipity.pictures.scene.finder import Finder
from serendipity.pictures.scene.scenarios import find_histories, find_scenario, played
from serendipity.pictures.scene.scene import Act, Frame, Meeting, Scene, find_changes


@dataclass(frozen=True, slots=True)
class Snapshot:
    """An epoch and the state after it; the first is the initial state, epoch 0.

    ``going`` is what is under way in it, of bystanders too, with the epochs in which it began.
    """

    epoch: int
    state: frozenset[int]
    going: tuple[tuple[int, GroundAction], ...] = ()

    @property
    def actions(self) -> list[GroundAction]:
        """What begins in it."""
        return [action for begun, action in self.going if begun == self.epoch]

    def going_on(self) -> list[GroundAction]:
        """What is under way after it."""
        return [action for begun, action in self.going if begun + action.duration - 1 > self.epoch]


def replay(
    task: Task, steps: Iterable[PlanStep], epochs: int, *, turns: bool = False
) -> tuple[Snapshot, ...]:
    """The epochs of a plan beside the script of its task.

    Args:
        steps: the plan.
        epochs: how many there are; after the plan the script goes on as far as it can.
        turns: whether the steps of an epoch follow each other (semantics 7).

    Raises:
        InputError: the plan names an action that the task lacks or that is not possible.
    """
    by_epoch: dict[int, list[PlanStep]] = defaultdict(list)
    for step in steps:
        by_epoch[step.epoch].append(step)
    end = max((step.end for listed in by_epoch.values() for step in listed), default=0)
    course = PlayedPlan(task.facts, task.init, task.script)
    found = [Snapshot(0, task.init)]
    for epoch in range(1, epochs + 1):
        begun: list[GroundAction] = []
        for part in [[step] for step in by_epoch[epoch]] if turns else [by_epoch[epoch]]:
            try:
                course.begin([_find(task, step, course.state) for step in part])
            except BrokenPlanError as error:
                if epoch <= end:
                    raise InputError(f"plan, epoch {epoch}: {error}") from None
            begun += course.begun
        going = *((e, a) for e, a in found[-1].going if e + a.duration > epoch), *((epoch, a) for a in begun)
        found.append(Snapshot(epoch, course.state, going))
    return tuple(found)


def _find(task: Task, step: PlanStep, state: State) -> GroundAction:
    """The action of a step; of several with one name, the first that is applicable."""
    name, agents = step.action.lower(), [agent.lower() for agent in step.agents]
    if not actions_named(task, name, agents):
        missing = f"the task has no action '{step.action}' of {', '.join(step.agents)}"
        raise InputError(f"plan, epoch {step.epoch}: {missing}")
    return task.actions[variant_named(task, name, agents, state)]


MOST_EPOCHS: Final = 2_000
"""Epochs of a picture: a second of work, and a page of a megabyte; nobody looks at more."""


def build_scene(task: Task, result: Result, scenario: str | None = None) -> Scene:
    """The scene of a result; without a plan, of the human's own plan, or of the initial state.

    Args:
        scenario: what is played of an answer over scenarios, by its name or number; None: the most probable.

    Raises:
        InputError: the plan does not fit the task, or has more than :data:`MOST_EPOCHS` epochs.
    """
    return _scene(task, result, find_scenario(result, scenario))


def other_scenes(task: Task, result: Result, scene: Scene) -> tuple[Scene, ...]:
    """The scenes of the scenarios of a result that are not played in the one that was built of it."""
    numbers = range(len(result.goals or ())) if scene.histories else ()
    return tuple(_scene(task, result, i) for i in numbers if i != scene.scenario)


def _scene(task: Task, result: Result, chosen: int | None) -> Scene:
    """The scene of a scenario of a result, or of one without."""
    if chosen is not None:
        task, result = played(task, result, chosen)
    names = result.human_plan or ()
    usual = PlanTimes(tuple(range(1, len(names) + 1)), (1,) * len(names), len(names))
    times = result.human_plan_times or usual
    begun = zip(times.starts, names, times.durations, strict=True)
    own = [PlanStep(start, (result.human,), name, 0.0, duration) for start, name, duration in begun]
    plan = own if result.plan is None else result.plan
    others = chain.from_iterable(entry.plan or () for entry in result.goals or ())
    last = max([times.epochs, *(step.end for step in (*plan, *others))])
    if last > MOST_EPOCHS:
        raise InputError(f"plan: it has {last} epochs, and at most {MOST_EPOCHS} are drawn")
    places = find_places(task)
    moments = replay(task, plan, last, turns=result.mode == "assistance")
    former = replay(task, own, times.epochs)
    builder = _Builder(task, result, places)
    acts = tuple(chain.from_iterable(builder.acts(moment) for moment in moments))
    scene = Scene(
        name=task.name,
        agents=task.agents,
        human=task.human,
        goals=places.goals(task),
        frames=builder.frames(moments, former, max([0, *(step.end for step in plan)])),
        acts=acts,
        former_acts=tuple(
            act for moment in former for act in builder.acts(moment) if act.agents == (task.human,)
        ),
        meetings=tuple(builder.meetings(moments)),
        changes=find_changes(task, [moment.state for moment in moments], last, places.facts),
        result=result,
        vehicles=places.vehicles,
        bystanders=task.script.people,
        marks={
            epoch: tuple(task.facts[one.fact] if one.true else f"not {task.facts[one.fact]}" for one in some)
            for epoch, some in groupby(task.script.facts, key=lambda one: one.epoch)
            if epoch <= last
        },
        scenario=chosen,
        histories=find_histories(result, last),
        told={step: builder.act(step) for entry in result.goals or () for step in entry.plan or ()},
        unit=task.epoch if task.needs_time or result.in_time else None,
    )
    return replace(scene, layout=lay_out(places, cell_size(scene, places.names))) if places.names else scene


class _Builder:
    """Turns the moments of a replay into frames, acts and meetings."""

    def __init__(self, task: Task, result: Result, places: Places) -> None:
        self.task = task
        self.finder = Finder(places)
        self.window = range(0) if result.window is None else range(result.window.start, result.window.end)
        own = result.mode != "assistance"  # there nobody's cost is discounted (semantics 7)
        self.discount = result.options.discount if own else Fraction(0)
        self.waiting_cost = result.options.waiting_cost

    def frames(self, moments: Sequence[Snapshot], former: Sequence[Snapshot], end: int) -> tuple[Frame, ...]:
        """A frame for each moment; the plan has its end in epoch ``end``."""
        frames = []
        human, spent, former_spent = self.task.human, self._spent(moments), self._spent(former)
        before = moments[0].state
        for epoch, moment in enumerate(moments):
            other = "with the former plan" if epoch < len(former) else "in other scenarios"
            then = former[min(epoch, len(former) - 1)]
            shown = self.finder.shown(moment.state, moment.going_on())
            former_shown = self.finder.shown(then.state, then.going_on())
            frames.append(
                Frame(
                    epoch=epoch,
                    at=self.finder.agents(shown),
                    objects=self.finder.objects(shown),
                    former_at=self.finder.agents(former_shown).get(human),
                    made=self._facts(moment.state - before),
                    undone=self._facts(before - moment.state),
                    spent=spent[epoch],
                    former_spent=former_spent[then.epoch][human],
                    caption=self._caption(moment, other if epoch > end else ""),
                    in_window=epoch in self.window,
                )
            )
            before = moment.state
        return tuple(frames)

    def _spent(self, moments: Sequence[Snapshot]) -> list[dict[int, Fraction]]:
        """What each agent has paid after each epoch, waiting included; bystanders pay nothing."""
        human, people = self.task.human, self.task.script.people
        last = max((m.epoch for m in moments if any(human in a.participants for a in m.actions)), default=0)
        found = [dict.fromkeys(range(len(self.task.agents)), Fraction(0))]
        for moment in moments[1:]:
            own = [action for action in moment.actions if people.isdisjoint(action.participants)]
            paid = shares(self.task, own, self.discount)
            waits = not any(human in action.participants for _, action in moment.going)
            paid[human] += self.waiting_cost * (waits and moment.epoch < last)
            found.append({agent: cost + paid[agent] for agent, cost in found[-1].items()})
        return found

    def acts(self, moment: Snapshot) -> list[Act]:
        """The actions of a moment, the human's first."""
        return self._acts((moment.epoch, action) for action in moment.actions)

    def _acts(self, begun: Iterable[tuple[int, GroundAction]]) -> list[Act]:
        human = self.task.human
        ordered = sorted(begun, key=lambda one: (human not in one[1].participants, one[1].participants))
        return [self._act(epoch, action) for epoch, action in ordered]

    def act(self, step: PlanStep) -> Act:
        """A step by itself, whatever the state."""
        return self._act(step.epoch, _find(self.task, step, self.task.init))

    def meetings(self, moments: Sequence[Snapshot]) -> list[Meeting]:
        """Joint actions as they end, and objects that somebody takes who did not have them last."""
        found = []
        holders: dict[str, int] = {}
        passed: dict[str, int] = {}
        for moment in moments:
            objects = self.finder.objects(moment.state)
            joint = [action for _, action in moment.going if action.joint]
            goes_on = moment.going_on()
            for name, where in objects.items():
                if where.holder is not None:
                    giver = holders.get(name, where.holder)
                    holders[name] = where.holder
                    if giver != where.holder:
                        passed[name] = giver
                        if not any(where.holder in action.participants for action in joint):
                            found.append(self._found(moment, name, giver, where.holder))
            found += [self._joint(moment, a, objects, passed) for a in joint if a not in goes_on]
        return found

    def _found(self, moment: Snapshot, name: str, giver: int, taker: int) -> Meeting:
        agents = self.task.agents
        text = f"{agents[taker]} takes {name}, which {agents[giver]} left"
        return Meeting(moment.epoch, self.finder.agents(moment.state).get(taker), (name,), text)

    def _joint(
        self, moment: Snapshot, action: GroundAction, objects: dict[str, Whereabouts], passed: dict[str, int]
    ) -> Meeting:
        act = self._act(moment.epoch, action)
        at = self.finder.agents(moment.state)
        place = next((at[i] for i in action.participants if i in at), None)
        agents = self.task.agents
        mine = tuple(sorted(name for name in passed if objects[name].holder in action.participants))
        gifts = []
        for name in mine:
            taker = objects[name].holder
            if taker is not None:
                gifts.append(f"{agents[passed.pop(name)]} gives {name} to {agents[taker]}")
        text = ", ".join(gifts) or self._words(act)
        return Meeting(moment.epoch, place, mine, text + (f" in {place}" if gifts and place else ""))

    def _act(self, epoch: int, action: GroundAction) -> Act:
        phrase = self.finder.phrase(whole(action), self.task.agents)
        name = action.name if action.timing is None else f"{action.name} [{action.duration}]"
        return Act(epoch, action.participants, *phrase, name, action.duration)

    def _words(self, act: Act) -> str:
        who = " and ".join(self.task.agents[i] for i in act.agents)
        return f"{who}: {act.verb} {act.detail}".rstrip()

    def _facts(self, ids: frozenset[int]) -> tuple[str, ...]:
        return tuple(self.task.facts[f] for f in sorted(ids))

    def _caption(self, moment: Snapshot, other: str) -> str:
        if moment.epoch == 0:
            return "Before anybody has done anything."
        if other:
            return f"All is done; {other} there would still be something to do."
        lines = []
        for act in self._acts(moment.going):
            part = f" ({moment.epoch - act.epoch + 1} of {act.duration})" if act.duration > 1 else ""
            lines.append(self._words(act) + part)
        return "; ".join(lines) + "." if lines else "Everybody waits."
