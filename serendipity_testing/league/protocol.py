"""What a helper is told, and what it may answer: plain values, the same for every kind of helper.

An observation (``serendipity.observation/1``) is an object::

    case, epoch         which task it is, and which epoch is to come; in epoch 0 there is time to get ready
    seconds             for the answer; None: as long as it takes
    task                human, robots, facts; actions: name, agents, pre and effects (literals), cost
    state               the facts that are true
    history             for each epoch that is over: what the human did (None: waited) and the robots, by name
    plans               what the person may be about to do: name, probability, goal and plan
    legal               what each robot can do now, alone or with others, by its name

An answer is None (all wait), or ``{"actions": {robot: action or None}}``.  A joint action of several robots
is named by each of them; one with the person takes place if they take part.  With ``"human": {plan: action or
None}`` a person who follows that plan is asked to do that now; who is asked nothing does as they like.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Final

from serendipity.execution import Decided, Outlook, Robots
from serendipity.facade.results import named_steps
from serendipity.model import Deadline, LimitReachedError, PlanStep, SerendipityError, Step, Task
from serendipity.model.arguments import shown
from serendipity.model.printable import message
from serendipity_testing.league.cases import FREE, Case

SCHEMA: Final = "serendipity.observation/1"

_LONGEST: Final = 200
"""Characters of what is said about an answer."""

Observation = dict[str, Any]
Ask = Callable[[Observation], Any]
"""Answers an observation.  May raise :class:`AnswerError`, or ``LimitReachedError`` where time is up."""


class AnswerError(SerendipityError):
    """A helper's answer is none; it says what was expected.  Such an answer counts as waiting."""


@dataclass(frozen=True, slots=True)
class Helper:
    """Whoever decides for robots in a league.

    Attributes:
        robots: those of a case, given the seconds that they have before the first epoch.
        seconds: for each decision, where that is its own affair; None: the league's deadline.
        plans: whether time before the first epoch is for a first decision.
    """

    name: str
    robots: Callable[[Case, float | None], Robots]
    close: Callable[[], None] = lambda: None
    seconds: float | None = None
    plans: bool = False


class AskedRobots:
    """Robots that ask a helper in each epoch: what the loop of :class:`serendipity.Execution` takes.

    Args:
        setup: seconds to get ready, before the first epoch; None: as long as it takes.
    """

    def __init__(self, case: Case, ask: Ask, setup: float | None = None) -> None:
        self.faults: list[str] = []
        self._case, self._task, self._ask = case, case.task, ask
        self._told = described(case)
        self._history: list[dict[str, Any]] = []
        self.goals: Mapping[str, float] = {one.name: float(one.probability) for one in case.scenarios}
        with suppress(AnswerError, LimitReachedError):  # whoever is not ready yet will be late
            ask(self.seen(0, case.task.init, setup))

    def decide(self, outlook: Outlook, deadline: Deadline) -> Decided:
        """See :class:`serendipity.execution.Robots`."""
        epoch, state = outlook.epoch, outlook.world.state
        try:
            answer = self._ask(self.seen(epoch, state, deadline.left()))
            actions, offers, wishes = self._read(answer, state)
        except AnswerError as error:
            if deadline.left() == 0:
                raise LimitReachedError("time-limit") from None
            self.faults.append(message(str(error), _LONGEST))
            return Decided(epoch, "aside", f"no such answer: {error}", goals=self.goals)
        steps = named_steps(self._task, FREE["discount"], [Step(epoch, i) for i in (*actions, *offers)])
        own, joint = steps[: len(actions)], steps[len(actions) :]
        verdict = "helps" if steps else "aside"
        return Decided(epoch, verdict, "as the helper says", own, joint, goals=self.goals, wishes=wishes)

    def saw(self, own: int | None, executed: Sequence[int], tried: int | None = None) -> None:
        """See :class:`serendipity.execution.Robots`."""
        human, actions = self._task.human, [self._task.actions[i] for i in executed]
        his = [action.name for action in actions if human in action.participants]
        his += [] if tried is None else [self._task.actions[tried].name]
        robots = [action.name for action in actions if human not in action.participants]
        self._history.append({"human": next(iter(his), None), "robots": robots})

    def surprised(self) -> None:
        """Never: there is nothing but actions here."""

    def drop(self, robots: Iterable[int]) -> None:
        """Never."""

    def unable(self, actions: Iterable[int]) -> None:
        """Never."""

    def seen(self, epoch: int, state: frozenset[int], seconds: float | None) -> Observation:
        """What a helper is told before an epoch."""
        return {
            "schema": SCHEMA,
            "case": self._case.name,
            "epoch": epoch,
            "seconds": seconds,
            **self._told,
            "state": [self._task.facts[i] for i in sorted(state)],
            "history": list(self._history),
            "legal": {robot: [*names] for robot, names in legal(self._task, state).items()},
        }

    def _read(self, answer: Any, state: frozenset[int]) -> tuple[list[int], list[int], dict[str, str | None]]:
        """What robots do alone, and offer, by action ids; what the person is asked, by plan."""
        said = _object({} if answer is None else answer, "an answer", ("actions", "human"))
        possible = legal(self._task, state)
        named = _object(said.get("actions") or {}, "actions", possible)
        chosen = set[int]()
        for robot, name in named.items():
            if name is not None and (not isinstance(name, str) or name not in possible[robot]):
                raise AnswerError(f"{robot}: expected a legal action or null, got {shown(name)}")
            chosen |= set() if name is None else {possible[robot][name]}
        human = self._task.human
        for i in chosen:
            action = self._task.actions[i]
            for agent in set(action.participants) - {human}:
                if named.get(self._task.agents[agent]) != action.name:
                    raise AnswerError(f"'{action.name}': expected each of its robots to name it")
        offers = sorted(i for i in chosen if human in self._task.actions[i].participants)
        return sorted(chosen.difference(offers)), offers, self._wishes(said.get("human") or {}, offers)

    def _wishes(self, given: Any, offers: Sequence[int]) -> dict[str, str | None]:
        own = {self._task.actions[i].name for i in (*self._task.human_actions, *offers)}
        wishes = dict(_object(given, "human", self.goals))
        for plan, name in wishes.items():
            if name is not None and (not isinstance(name, str) or name not in own):
                raise AnswerError(f"human, {plan}: expected an action of theirs or null, got {shown(name)}")
        return wishes


def described(case: Case) -> dict[str, Any]:
    """What an observation says of the task and of the plans, the same in each epoch."""
    task = case.task
    facts = task.facts
    actions = [
        {
            "name": action.name,
            "agents": [task.agents[i] for i in action.participants],
            "pre": list(action.precondition.literals(facts)),
            "effects": [*(facts[i] for i in action.add), *(f"!{facts[i]}" for i in action.delete)],
            "cost": float(action.cost),
        }
        for action in task.actions
    ]
    robots = [task.agents[i] for i in task.robots]
    plans = [one | {"probability": float(one["probability"])} for one in case.library()]
    named = {"human": task.agents[task.human], "robots": robots, "facts": list(facts), "actions": actions}
    return {"task": named, "plans": plans}


def legal(task: Task, state: frozenset[int]) -> dict[str, dict[str, int]]:
    """What each robot can take part in, by its name; each action's id by name."""
    possible: dict[str, dict[str, int]] = {task.agents[i]: {} for i in task.robots}
    for number, action in enumerate(task.actions):
        if action.participants != (task.human,) and action.applicable(state):
            for agent in action.participants:
                if agent != task.human:
                    possible[task.agents[agent]].setdefault(action.name, number)
    return possible


def steps_at(plan: Iterable[PlanStep], epoch: int, human: str) -> tuple[dict[str, str], str | None]:
    """What a plan has each robot do in an epoch, by its name, and the person."""
    now = [step for step in plan if step.epoch == epoch]
    robots = {agent: step.action for step in now for agent in step.agents if agent != human}
    return robots, next((step.action for step in now if human in step.agents), None)


def _object(value: Any, what: str, keys: Iterable[str]) -> Mapping[str, Any]:
    """A JSON object with some of the keys."""
    if not isinstance(value, Mapping):
        raise AnswerError(f"{what}: expected an object, got {shown(value)}")
    unknown = next((key for key in value if key not in [*keys]), None)
    if unknown is not None:
        raise AnswerError(f"{what}: expected some of {', '.join(keys)}, got {shown(unknown)}")
    return value
