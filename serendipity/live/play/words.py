"""Actions and facts as people read them: "go to hall4", "hand over mk2"."""

from serendipity.model import GroundAction, Task
from serendipity.model.task.execution import actions_named
from serendipity.model.task.plans import PlanStep
from serendipity.show.map.names import parts, verb_and_rest, without
from serendipity.show.map.places import Places
from serendipity.show.scene.finder import Finder


class Words:
    """Words for a task.

    Args:
        task: the task.
        places: its map.
    """

    def __init__(self, task: Task, places: Places) -> None:
        self._task = task
        self._finder = Finder(places)

    def target(self, action: GroundAction, agent: int) -> str | None:
        """The place that an agent's own action leads to; None where it leads nowhere."""
        if action.joint:
            return None
        told = self._finder.places_of(action, agent)
        return next((told[fact] for fact in action.add if fact in told), None)

    def action(self, action: GroundAction) -> str:
        """What an action is, without who does it and where they are."""
        agents = [self._task.agents[i] for i in action.participants]
        place = self.target(action, action.participants[0])
        if place is not None:
            return f"go to {place}"
        verb, rest = verb_and_rest(action.name, agents)
        here = []
        for agent in action.participants:
            told = self._finder.places_of(action, agent)
            here += [parts(told[fact]) for fact in action.pre if fact in told]
        return f"{verb} {' '.join(without(here, tuple(rest.split()))) or rest}".rstrip()

    def step(self, step: PlanStep) -> str:
        """What a step of a plan is."""
        return self.action(self._task.actions[actions_named(self._task, step.action, step.agents)[0]])

    def robots(self, step: PlanStep) -> str:
        """The robots of a step."""
        human = self._task.agents[self._task.human]
        return " and ".join(agent for agent in step.agents if agent != human)

    def goal(self, known: frozenset[int]) -> list[dict[str, str | bool]]:
        """What the person wants, fact by fact, and what of it they know to hold."""
        human = parts(self._task.agents[self._task.human])
        goal = self._task.goal
        said: list[dict[str, str | bool]] = []
        for fact in (*goal.positive, *goal.negative):
            words = " ".join(without([human], parts(self._task.facts[fact]))).replace("_", " ")
            wanted = fact in goal.positive
            text = words if wanted else f"not {words}"
            said.append({"text": text, "holds": (fact in known) == wanted})
        return said
