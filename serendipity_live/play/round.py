"""One round: how it is played, a person's actions in, and out comes what their page shows."""

from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any, Final

import serendipity
from serendipity.execution import Decided, Passed, moment_of
from serendipity.execution.decided import account
from serendipity.execution.log import decision_of
from serendipity.model import GroundAction, HumanModel, InputError, PlanStep, Task, UsageError
from serendipity.model.task.actions import apply
from serendipity.model.task.execution import variant_named
from serendipity.pictures.map.places import find_places
from serendipity.recognition import GoalsGiven
from serendipity_live.play.clock import ClockView
from serendipity_live.play.labels import DomainLabels, Phrases
from serendipity_live.play.language import ENGLISH, Language
from serendipity_live.play.map_view import Knowledge, MapView
from serendipity_live.play.records import Event

VIEWS: Final = ("observant", "local")
"""What the person sees: everything, or what is where they are."""

CONDITIONS: Final = {
    "none": "robots do nothing",
    "silent": "robots help and say nothing",
    "announced": "robots say what they are going to do, and what the person's part is",
}
"""What robots do."""


@dataclass(frozen=True, slots=True)
class RoundSetting:
    """One round.

    Attributes:
        task: where it begins; its goal is the person's.
        view: one of ``VIEWS``.
        condition: one of ``CONDITIONS``.
        goals: goals that robots think possible, as :func:`serendipity.recognise` takes them; None: they
            know the person's.
        deadline: seconds for each decision of the robots, or None.
        most_epochs: after which it is over, whatever has been reached; None: without end.
    """

    name: str
    task: Task
    discount: Fraction
    view: HumanModel = "observant"
    condition: str = "silent"
    goals: GoalsGiven | None = None
    deadline: float | None = None
    labels: DomainLabels = field(default_factory=DomainLabels)
    most_epochs: int | None = None
    say: Language = ENGLISH

    def execution(self) -> serendipity.Execution:
        """The round at its beginning.

        Robots that announce what they do have a person before them who knows their plan, and count on it; the
        others take the person for somebody who replans on sight.
        """
        run = serendipity.Execution(
            self.task,
            discount=self.discount,
            human_model=self.view,
            goals=self.goals,
            deadline=self.deadline,
            told=self.condition == "announced",
        )
        if self.condition == "none":
            run.drop(self.task.agents[robot] for robot in self.task.robots)
        return run


_WAITING: Final = {"action": None, "kind": "wait", "cost": 0, "place": None}

_EXPLAINING = 10.0
"""Seconds for an explanation at the end."""


class Round:
    """A person, robots and the world; a UsageError where the person has no way to reach the goal alone."""

    def __init__(self, setting: RoundSetting) -> None:
        self.setting = setting
        task = setting.task
        alone = serendipity.plan(task, mode="individual")
        if alone.cost is None:
            raise UsageError(f"{setting.name}: {task.agents[task.human]} can't reach the goal alone")
        self.alone = alone.cost
        self.run = setting.execution()
        places = find_places(task)
        self._words = Phrases(task, places, setting.labels, setting.say)
        self._say = setting.say
        self._known = Knowledge(task, setting.view)
        self._map = MapView(task, places, self._known)
        self._seen: list[dict[str, Any]] = []
        self._clock = ClockView(task, self._words, setting.say)
        self.human = task.agents[task.human]

    @property
    def done(self) -> bool:
        """Whether the round is over: the goal is reached, or there are no more epochs."""
        most = self.setting.most_epochs
        return self.run.done or (most is not None and self.run.epoch > most)

    def act(self, action: str | None) -> Event:
        """The person does something, or waits: the epoch as recorded, with what was shown and said before."""
        if self.done:
            raise UsageError("the round is over")
        if action is not None and not isinstance(action, str):
            raise UsageError(f"action: expected a name, got {action!r:.50}")
        decided = self.run.decided
        shown = {
            "said": self._said(decided),
            "choices": [choice["text"] for choice in self._choices(decided)],
            "goal": self._words.goal(self._known.belief),
        }
        passed = self._step(action)
        return {
            "epoch": passed.epoch,
            "action": passed.human or "wait",
            "in_vain": passed.in_vain,
            "steps": [f"{'+'.join(step.agents)}: {step.action}" for step in passed.steps],
            "seen": self._seen[0]["others"],
            "verdict": passed.decided.verdict,
            "reason": passed.decided.reason,
            "goals": dict(passed.decided.goals),
            "offers": [step.action for step in passed.decided.offers],
            **shown,
            "decision_seconds": round(passed.decided.seconds, 4),
            "human_cost": passed.human_cost,
            "team_cost": passed.cost,
            "alone_cost": self.alone,
            "reached": passed.done,
            "done": self.done,
            "chosen": passed.human,
            "decision": passed.decided.to_dict(),
        }

    def again(self, event: Event, file: Path | None = None) -> None:
        """Play a recorded epoch: what robots had decided, and what the person did."""
        try:
            self.run.recall(decision_of(event["decision"], self.run.epoch))
            passed = self._step(event["chosen"])
            same = (passed.epoch, passed.human_cost) == (event["epoch"], event["human_cost"])
        except (KeyError, TypeError, AttributeError, ValueError, UsageError):
            same = False
        if not same:
            raise InputError(f"epoch {event.get('epoch')}: comes out otherwise than it is recorded", file)

    def _step(self, action: str | None) -> Passed:
        near, before, now = self._map.here, self.run.state, self.run.now
        passed = self.run.step(action)
        own = next((step for step in passed.steps if self.human in step.agents), None)
        self._known.look(self.run.now, None if own is None else self._ground(own, before))
        self._map.look()
        told = self._told(passed, near)
        told["others"] += self._clock.happened(now)
        self._seen.insert(0, told)
        return passed

    # -- what the page shows

    def view(self) -> dict[str, Any]:
        """Everything that the page shows of the round."""
        run, names = self.run, self.setting.task.facts
        decided = None if self.done else run.decided
        known, hidden = sorted(self._known.belief), {d.fact for d in self.setting.task.disjunctions}
        return {
            "scenario": self.setting.name,
            "sight": "everywhere" if self._known.everywhere else "here",
            "human": self.human,
            "goal": self._words.goal(self._known.belief),
            "epoch": run.epoch,
            **self._clock.view(run),
            "map": self._map.picture(),
            "legend": self._map.legend(),
            "facts": None if self._map.here else [names[fact] for fact in known if fact not in hidden],
            "can": [] if decided is None else self._choices(decided),
            "paid": float(run.human_cost),
            "team": float(run.cost),
            "alone": self.alone,
            "discount": float(self.setting.discount),
            "log": self._seen,
            "thinking": None if decided is None else self._thinking(decided),
            "said": None if decided is None else self._said(decided),
            "done": self.done,
            "end": self._end() if self.done else None,
        }

    def explanation(self) -> list[dict[str, str]]:
        """Why help came as it did in this run, and what plans say of the task, in sentences by topic."""
        happened = account(self.run.passed, self.human, self.alone)
        found = serendipity.explain(self.setting.task, discount=self.setting.discount, time_limit=_EXPLAINING)
        said = "Beside this run, what plans say of somebody who does as they want, whatever robots promise:"
        return [
            *({"topic": "run", "text": text} for text in happened),
            {"topic": "plan", "text": said},
            *({"topic": topic, "text": text} for topic, text in found.sentences),
        ]

    def robots(self) -> dict[str, int]:
        """In how many epochs robots did something, or offered something, or were taken up on it."""
        passed = self.run.passed
        others = [[s for s in p.steps if list(s.agents) != [self.human]] for p in passed]
        return {
            "helped": sum(bool(steps) for steps in others),
            "offered": sum(bool(p.decided.offers) for p in passed),
            "taken": sum(any(self.human in s.agents for s in steps) for steps in others),
        }

    def _ground(self, step: PlanStep, state: frozenset[int]) -> GroundAction:
        """The action of a step, in the variant that is possible in a state where one is."""
        task = self.setting.task
        return task.actions[variant_named(task, step.action, step.agents, state)]

    def _choices(self, decided: Decided) -> list[dict[str, Any]]:
        """What the person can do, as far as they know: what robots offer first, waiting last."""
        task, belief = self.setting.task, self._known.belief
        lasting = self._clock.lasting
        if (busy := self._clock.busy(self.run.going)) is not None:
            text = self._say("go on: {action}", action=lasting(self._words.step(busy), busy.duration))
            return [{**_WAITING, "text": text}]
        choices = [
            {
                "action": step.action,
                "text": lasting(self._words.step(step), step.duration),
                "with": self._words.robots(step),
                "kind": "offer",
                "cost": step.cost,
                "place": None,
            }
            for step in decided.offers
        ]
        known: dict[str, dict[str, Any]] = {}
        for i in task.human_actions:
            action = task.actions[i]
            changes = any(apply(belief, moment) != belief for moment in action.moments)
            if changes and action.applicable(belief) and action.name not in known:
                place = self._words.target(action)
                known[action.name] = {
                    "action": action.name,
                    "text": lasting(self._words.action(action), action.duration),
                    "kind": "do" if place is None else "go",
                    "cost": float(action.cost),
                    "place": place,
                }
        own = sorted(known.values(), key=lambda choice: choice["kind"])
        return [*choices, *own, {**_WAITING, "text": self._say("wait")}]

    def _thinking(self, decided: Decided) -> dict[str, Any]:
        return {
            "verdict": decided.verdict,
            "reason": decided.reason,
            "goals": [{"name": name, "share": share} for name, share in decided.goals.items()],
            "plan": [
                {
                    "epoch": self.run.epoch + step.epoch - 1,
                    "agents": list(step.agents),
                    "text": self._words.step(step),
                    "help": list(step.agents) != [self.human],
                }
                for step in decided.plan or ()
            ],
            "expected": None if decided.expected is None else self._words.step(decided.expected),
            "window": None if decided.window is None else decided.window.to_dict(),
            "cost": decided.cost,
            "alone": decided.alone,
            "milliseconds": round(1000 * decided.seconds),
        }

    def _said(self, decided: Decided) -> str | None:
        """What robots say aloud, where they do."""
        if self.setting.condition != "announced":
            return None
        if decided.verdict == "stopped":
            return self._say("I have stopped helping; please go on alone.")
        if decided.verdict not in ("helps", "waits"):
            return None
        task = self.setting.task
        mine = [s for s in decided.plan or () if list(s.agents) != [self.human]]
        if not mine:
            return None
        name = moment_of(self.run).wish
        asked = None if name is None else self._words.action(task.actions[task.named[name][0]])
        wish = "" if asked is None else " " + self._say("Please {action} now.", action=asked)
        said: dict[str, list[str]] = {}
        for step in mine:
            robot = next(i for i in task.robots if task.agents[i] in step.agents)
            epoch = self.run.epoch + step.epoch - 1
            text = self._say("{action} (epoch {epoch})", action=self._words.step(step, robot), epoch=epoch)
            said.setdefault(self._words.robots(step), []).append(text)
        if len(task.robots) == 1:
            return self._say("I will {actions}.", actions=", ".join(*said.values())) + wish
        told = (
            self._say("{robot} will {actions}.", robot=who[:1].upper() + who[1:], actions=", ".join(does))
            for who, does in said.items()
        )
        return " ".join(told) + wish

    def _told(self, passed: Passed, near: str | None) -> dict[str, Any]:
        """An epoch as the person has seen it."""
        own = next((step for step in passed.steps if self.human in step.agents), None)
        if own is not None:
            robots = self._words.robots(own)
            did = self._words.step(own)
            did = self._say("{action}, with {robots}", action=did, robots=robots) if robots else did
        elif passed.in_vain:
            did = self._say("tried to {action}, in vain", action=passed.human)
        elif (busy := self._clock.busy(passed.going)) is not None:
            did = self._say("went on: {action}", action=self._words.step(busy))
        else:
            did = self._say("waited")
        seen = (s for s in passed.steps if self.human not in s.agents and self._noticed(s, near))
        others = [f"{self._words.robots(step)}: {self._words.step(step)}" for step in seen]
        return {"epoch": passed.epoch, "you": did, "others": others}

    def _noticed(self, step: PlanStep, near: str | None) -> bool:
        """Whether the person was where a robot did something, or it came to where they are."""
        if self._known.everywhere:
            return True
        action = self._ground(step, self.run.state)
        facts = (*action.pre, *action.add)
        return any(self._known.sees(fact, self.run.state) for fact in facts) and near is not None

    def _end(self) -> dict[str, Any]:
        """What the round came to."""
        run = self.run
        paid, team = float(run.human_cost), float(run.cost)
        theirs = [s for passed in run.passed for s in passed.steps if list(s.agents) != [self.human]]
        return {
            "paid": paid,
            "team": team,
            "alone": self.alone,
            "saved": round(self.alone - team, 9),
            "spared": round(self.alone - paid, 9),
            "epochs": len(run.passed),
            "help": [
                {"epoch": s.epoch, "text": f"{' and '.join(s.agents)}: {self._words.step(s)}"} for s in theirs
            ],
            "reached": run.done,
            **self.robots(),
            "reasons": [{"epoch": p.epoch, "text": p.decided.reason} for p in run.passed],
        }
