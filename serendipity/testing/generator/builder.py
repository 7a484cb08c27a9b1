"""Tasks put together fact by fact and action by action."""

from fractions import Fraction

from serendipity.model import Condition, GroundAction, Task


class Builder:
    """Facts by name, numbered as they come up; the first agent is the human.

    Args:
        agents: their names.
        name: of the task.
    """

    def __init__(self, agents: tuple[str, ...], name: str = "random") -> None:
        self.agents = agents
        self._name = name
        self._facts: dict[str, int] = {}
        self._actions: list[GroundAction] = []

    def action(self, name: str, agents: tuple[int, ...], pre: str, effects: str, cost: str) -> None:
        """An action; ``!`` in front of a fact negates it."""
        needs, changes = self._literals(pre), self._literals(effects)
        delete = tuple(f for f in changes.negative if f not in changes.positive)
        who = " ".join(self.agents[i] for i in agents)
        ground = GroundAction(
            f"{name} {who}", agents, needs.positive, needs.negative, changes.positive, delete, Fraction(cost)
        )
        self._actions.append(ground)

    def task(self, init: str, goal: str, robot_goal: str = "") -> Task:
        """All actions so far as a task; literals as in :meth:`action`."""
        wanted, theirs = self._literals(goal), self._literals(robot_goal)
        return Task(
            name=self._name,
            agents=self.agents,
            human=0,
            init=frozenset(self._literals(init).positive),
            goal=wanted,
            robot_goal=theirs,
            facts=tuple(self._facts),
            actions=tuple(sorted(self._actions, key=lambda action: action.key)),
        )

    def _literals(self, text: str) -> Condition:
        words = text.split()
        positive = {self._fact(word) for word in words if word[0] != "!"}
        negative = {self._fact(word[1:]) for word in words if word[0] == "!"}
        return Condition(tuple(sorted(positive)), tuple(sorted(negative - positive)))

    def _fact(self, name: str) -> int:
        return self._facts.setdefault(name, len(self._facts))
