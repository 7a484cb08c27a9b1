"""How a result becomes a scene: its plan, and the human's former one, replayed in words and places."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain
from typing import Final

from serendipity.model import GroundAction, InputError, PlanStep, Result, Task
from serendipity.model.numbers import total
from serendipity.model.task.actions import State, apply
from serendipity.model.task.execution import actions_named, shares, variant_named
from serendipity.pictures.map.layout import lay_out
from serendipity.pictures.map.places import Places, Whereabouts, find_places
from serendipity.pictures.scene.crowds import cell_size
from serendipity.pictures.scene.finder import Finder
from serendipity.pictures.scene.scene import Act, Frame, Meeting, Scene, find_changes


@dataclass(frozen=True, slots=True)
class Snapshot:
    """An epoch and the state after it; the first is the initial state, epoch 0."""

    epoch: int
    actions: tuple[GroundAction, ...]
    state: frozenset[int]


def replay(task: Task, result: Result) -> tuple[Snapshot, ...]:
    """The epochs of a result's plan; without one, of the human's own plan.

    Raises:
        InputError: the plan names an action that the task lacks or that is not applicable.
    """
    if result.plan is None:
        return replay_former(task, result)
    by_epoch: dict[int, list[PlanStep]] = defaultdict(list)
    for step in result.plan:
        by_epoch[step.epoch].append(step)
    found = [Snapshot(0, (), task.init)]
    turns = result.mode == "assistance"  # they act one after the other (semantics 7)
    for epoch in range(1, max(by_epoch, default=0) + 1):
        state = before = found[-1].state
        actions = []
        for step in by_epoch[epoch]:
            actions.append(_find(task, step, state if turns else before))
            state = apply(state, actions[-1])
        found.append(Snapshot(epoch, tuple(actions), state))
    return tuple(found)


def replay_former(task: Task, result: Result) -> tuple[Snapshot, ...]:
    """The epochs of the human's former plan with idle robots; the initial one without a plan.

    Raises:
        InputError: the plan can't be executed in the task.
    """
    if not result.human_plan:
        return (Snapshot(0, (), task.init),)
    plan = task.plan_from_names(result.human_plan)
    did = [(), *((task.actions[i],) for i in plan)]
    return tuple(map(Snapshot, range(len(did)), did, task.replay_alone(plan)))


def _find(task: Task, step: PlanStep, state: State) -> GroundAction:
    """The action of a step; of several with one name, the first that is applicable."""
    name, agents = step.action.lower(), [agent.lower() for agent in step.agents]
    where = f"plan, epoch {step.epoch}:"
    if not actions_named(task, name, agents):
        raise InputError(f"{where} the task has no action '{step.action}' of {', '.join(step.agents)}")
    action = task.actions[variant_named(task, name, agents, state)]
    if not action.applicable(state):
        raise InputError(f"{where} '{step.action}' is not applicable in this task")
    return action


MOST_EPOCHS: Final = 2_000
"""Epochs of a picture: a second of work, and a page of a megabyte; nobody looks at more."""


def build_scene(task: Task, result: Result) -> Scene:
    """The scene of a result; without a plan, of the human's own plan, or of the initial state.

    Raises:
        InputError: the plan does not fit the task, or has more than :data:`MOST_EPOCHS` epochs.
    """
    epochs = max([step.epoch for step in result.plan or ()] + [len(result.human_plan or ())], default=0)
    if epochs > MOST_EPOCHS:
        raise InputError(f"plan: it has {epochs} epochs, and at most {MOST_EPOCHS} are drawn")
    places = find_places(task)
    moments, former = replay(task, result), replay_former(task, result)
    last = max(len(moments), len(former)) - 1
    builder = _Builder(task, result, places)
    acts = tuple(chain.from_iterable(builder.acts(moment) for moment in moments))
    hidden = {f for told in places.positions.values() for f in told}
    hidden |= {f for told in places.objects.values() for f in told}
    scene = Scene(
        name=task.name,
        agents=task.agents,
        human=task.human,
        goals=places.goals(task),
        frames=builder.frames(moments, former, last),
        acts=acts,
        former_acts=tuple(chain.from_iterable(builder.acts(moment) for moment in former)),
        meetings=tuple(builder.meetings(moments)),
        window=result.window,
        changes=find_changes(task, [moment.state for moment in moments], last, hidden),
        result=result,
        vehicles=places.vehicles,
        towers=places.towers,
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

    def frames(self, moments: Sequence[Snapshot], former: Sequence[Snapshot], last: int) -> tuple[Frame, ...]:
        frames = []
        spent = dict.fromkeys(range(len(self.task.agents)), Fraction(0))
        former_spent = Fraction(0)
        before = moments[0].state
        for epoch in range(last + 1):
            moment = moments[epoch] if epoch < len(moments) else Snapshot(epoch, (), moments[-1].state)
            then = former[min(epoch, len(former) - 1)]
            for agent, share in shares(self.task, moment.actions, self.discount).items():
                spent[agent] += share
            if epoch < len(former):
                former_spent += total(action.cost for action in then.actions)
            state = moment.state
            frames.append(
                Frame(
                    epoch=epoch,
                    at=self.finder.agents(state),
                    objects=self.finder.objects(state),
                    former_at=self.finder.agents(then.state).get(self.task.human),
                    made=self._facts(state - before),
                    undone=self._facts(before - state),
                    spent=dict(spent),
                    former_spent=former_spent,
                    caption=self._caption(moment, ended=epoch >= len(moments)),
                    in_window=epoch in self.window,
                )
            )
            before = state
        return tuple(frames)

    def acts(self, moment: Snapshot) -> list[Act]:
        """The actions of a moment, the human's first."""
        human = self.task.human
        ordered = sorted(moment.actions, key=lambda a: (human not in a.participants, a.participants))
        return [self._act(moment.epoch, action) for action in ordered]

    def meetings(self, moments: Sequence[Snapshot]) -> list[Meeting]:
        """Joint actions, and objects that somebody takes who did not have them last."""
        found = []
        holders: dict[str, int] = {}
        for moment in moments:
            objects = self.finder.objects(moment.state)
            joint = [action for action in moment.actions if action.joint]
            passed: dict[str, int] = {}
            for name, where in objects.items():
                if where.holder is not None:
                    giver = holders.get(name, where.holder)
                    holders[name] = where.holder
                    if giver != where.holder:
                        passed[name] = giver
                        if not any(where.holder in action.participants for action in joint):
                            found.append(self._found(moment, name, giver, where.holder))
            found += [self._joint(moment, action, objects, passed) for action in joint]
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
                gifts.append(f"{agents[passed[name]]} gives {name} to {agents[taker]}")
        who = " and ".join(agents[i] for i in action.participants)
        text = ", ".join(gifts) or f"{who}: {act.verb} {act.detail}".rstrip()
        return Meeting(moment.epoch, place, mine, text + (f" in {place}" if gifts and place else ""))

    def _act(self, epoch: int, action: GroundAction) -> Act:
        return Act(epoch, action.participants, *self.finder.phrase(action, self.task.agents), action.name)

    def _facts(self, ids: frozenset[int]) -> tuple[str, ...]:
        return tuple(self.task.facts[f] for f in sorted(ids))

    def _caption(self, moment: Snapshot, *, ended: bool) -> str:
        if moment.epoch == 0:
            return "Before anybody has done anything."
        if ended:
            return "All is done; with the former plan there would still be something to do."
        lines = []
        for act in self.acts(moment):
            who = " and ".join(self.task.agents[i] for i in act.agents)
            lines.append(f"{who}: {act.verb} {act.detail}".rstrip())
        return "; ".join(lines) + "." if lines else "Everybody waits."
