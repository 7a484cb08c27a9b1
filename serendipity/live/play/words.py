"""Phrases for actions and facts, as people read them: "go to hall4", "take medkit mk2 from the robot"."""

from collections.abc import Sequence

from serendipity.live.play.labels import DomainLabels
from serendipity.model import GroundAction, Task
from serendipity.model.task.execution import actions_named
from serendipity.model.task.plans import PlanStep
from serendipity.pictures.map.names import parts, without
from serendipity.pictures.map.places import Places
from serendipity.pictures.scene.finder import Finder


class Phrases:
    """Words for a task, said to its human.

    Args:
        labels: of its domain; what has none is said by its name.
    """

    def __init__(self, task: Task, places: Places, labels: DomainLabels) -> None:
        self._task = task
        self._finder = Finder(places)
        self._labels = labels

    def target(self, action: GroundAction) -> str | None:
        """The place that an action of the human's own leads to; None where it leads nowhere."""
        return self._finder.target(action, self._task.human)

    def action(self, action: GroundAction, who: int | None = None) -> str:
        """What somebody does who takes part in an action; by default the human, or else who comes first."""
        labelled = self._labels.action(action.name)
        if labelled is not None:
            return self._labelled(action, *labelled, who)
        return " ".join(self._finder.phrase(action, self._task.agents)).rstrip()

    def _labelled(
        self, action: GroundAction, sentences: Sequence[str], arguments: Sequence[str], who: int | None
    ) -> str:
        agents, human = self._task.agents, self._task.human
        named = [name for name in arguments if name in {agents[i] for i in action.participants}]
        if who is None:
            who = human if human in action.participants else action.participants[0]
        place = named.index(agents[who]) if agents[who] in named else 0
        return sentences[min(place, len(sentences) - 1)].format(*map(self.thing, arguments))

    def step(self, step: PlanStep, who: int | None = None) -> str:
        """What a step of a plan is, as :meth:`action` says it."""
        return self.action(self._task.actions[actions_named(self._task, step.action, step.agents)[0]], who)

    def thing(self, name: str) -> str:
        """A thing, a robot, or ``you``."""
        return "you" if name == self._task.agents[self._task.human] else self._labels.thing(name)

    def robots(self, step: PlanStep) -> str:
        """The robots of a step."""
        human = self._task.agents[self._task.human]
        return " and ".join(self._labels.thing(agent) for agent in step.agents if agent != human)

    def goal(self, known: frozenset[int]) -> list[dict[str, str | bool]]:
        """What the person wants, fact by fact, and what of it they know to hold."""
        goal = self._task.goal
        said: list[dict[str, str | bool]] = []
        for fact in (*goal.positive, *goal.negative):
            wanted = fact in goal.positive
            words = self._wish(self._task.facts[fact])
            said.append({"text": words if wanted else f"not {words}", "holds": (fact in known) == wanted})
        return said

    def _wish(self, fact: str) -> str:
        labelled = self._labels.goal(fact)
        if labelled is not None:
            return labelled[0].format(*map(self.thing, labelled[1]))
        human = parts(self._task.agents[self._task.human])
        return " ".join(without([human], parts(fact))).replace("_", " ")
