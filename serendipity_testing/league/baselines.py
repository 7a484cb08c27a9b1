"""Helpers that are shipped: those that know little, and ours."""

from collections.abc import Iterator, Mapping, Sequence
from heapq import heapify, heappop, heappush
from random import Random
from typing import Any, Final

from serendipity.execution import Robots
from serendipity.execution.beliefs import Beliefs
from serendipity.execution.robot_policy import RobotPolicy
from serendipity.facade.planning import plan
from serendipity.model import Options, PlanStep
from serendipity.recognition import plan_library
from serendipity_testing.league.cases import FREE, Case
from serendipity_testing.league.protocol import Ask, AskedRobots, Observation, steps_at

_FAR: Final = 1_000_000
"""Dearer than any way to what a relaxed plan reaches."""

_WORK: Final = 1e-3
"""What an action costs beside what the person pays, so that less of it is better."""


def idle(_: Observation) -> None:
    """Does nothing."""


def random(seen: Observation) -> Any:
    """Does anything that is legal, alone or with the person; the same wherever it sees the same."""
    dice = Random(f"{seen['case']} {len(seen['history'])}")
    return {"actions": {robot: dice.choice([None, *names]) for robot, names in _alone(seen).items()}}


class Greedy:
    """Each robot does what brings the goals nearest for the person, as far as deletions don't count.

    That is the mean over the plans that are possible of what their goals cost (``h_add``) in the state that
    an action leads to; robots wait where nothing is nearer.
    """

    def __init__(self) -> None:
        self._task: Mapping[str, Any] = {}
        self._prices: list[float] = []
        self._asking: dict[str, list[int]] = {}

    def __call__(self, seen: Observation) -> Any:
        """The answer."""
        if seen["task"] is not self._task:
            self._learn(seen["task"])
        by_name = {action["name"]: action for action in seen["task"]["actions"]}
        state, chosen = set(seen["state"]), dict[str, str | None]()
        for robot, names in _alone(seen).items():
            best, nearest = None, self._distance(seen, state)
            for name in names:
                away = self._distance(seen, _after(state, by_name[name]))
                if away < nearest:
                    best, nearest = name, away
            chosen[robot] = best
            state = state if best is None else _after(state, by_name[best])
        return {"actions": chosen}

    def _learn(self, task: Mapping[str, Any]) -> None:
        """What each action costs, and which actions ask for each literal."""
        self._task, self._asking = task, {}
        self._prices = [_WORK + a["cost"] * (task["human"] in a["agents"]) for a in task["actions"]]
        for number, action in enumerate(task["actions"]):
            for literal in action["pre"]:
                self._asking.setdefault(literal, []).append(number)

    def _distance(self, seen: Observation, state: set[str]) -> float:
        actions = seen["task"]["actions"]
        reached = dict[str, float]()
        left, spent = [len(action["pre"]) for action in actions], list(self._prices)
        open_ = [(0.0, fact if fact in state else f"!{fact}") for fact in seen["task"]["facts"]]
        open_ += [(spent[i], effect) for i, n in enumerate(left) if not n for effect in actions[i]["effects"]]
        heapify(open_)
        while open_:
            cost, literal = heappop(open_)
            if literal in reached:
                continue
            reached[literal] = cost
            for i in self._asking.get(literal, ()):
                left[i] -= 1
                spent[i] += cost
                if not left[i]:
                    for effect in actions[i]["effects"]:
                        heappush(open_, (spent[i], effect))
        wanted = ((one["probability"], fact) for one in seen["plans"] for fact in one["goal"])
        return sum(float(share) * reached.get(fact, _FAR) for share, fact in wanted)


def _alone(seen: Observation) -> dict[str, list[str]]:
    """What is legal for each robot without another robot."""
    robots, agents = set(seen["task"]["robots"]), {a["name"]: a["agents"] for a in seen["task"]["actions"]}
    return {
        robot: [name for name in names if robots.intersection(agents[name]) == {robot}]
        for robot, names in seen["legal"].items()
    }


def _after(state: set[str], action: Mapping[str, Any]) -> set[str]:
    effects = action["effects"]
    deleted = {fact[1:] for fact in effects if fact[0] == "!"}
    return (state - deleted) | {fact for fact in effects if fact[0] != "!"}


def ours(case: Case) -> Robots:
    """Our robots, who plan in each epoch: one plan where it is known, else a policy that watches."""
    options = Options(**FREE, human_model="omniscient")
    library = plan_library(case.task, case.library())
    beliefs = Beliefs(case.task, [one.aim for one in library], 1, None)
    return RobotPolicy(case.task, options, beliefs, told=True, habits=[one.plan for one in library])


class Planned:
    """Ours, planned once: robots commit themselves (``fixed``), or act on what they saw (``watching``)."""

    def __init__(self, policy: str) -> None:
        self._policy = policy
        self._made: tuple[Case, Mapping[str, Sequence[PlanStep]]] | None = None

    def robots(self, case: Case, setup: float | None) -> Robots:
        """Those of a case, for which a plan is made once."""
        if self._made is None or self._made[0] is not case:
            asked: Any = {"policy": self._policy, "plans": case.library(), "time_limit": setup, **FREE}
            result = plan(case.task, **asked)
            names = [one.name for one in case.scenarios]
            plans = [one.plan for one in result.goals or (result,)]
            found = zip(names, plans, strict=True)
            self._made = case, {name: steps for name, steps in found if steps is not None}
        return AskedRobots(case, _follow(case, self._made[1]))


def _follow(case: Case, plans: Mapping[str, Sequence[PlanStep]]) -> Ask:
    """Does what plans say, those that what the person did agrees with."""
    human = case.task.agents[case.task.human]

    def possible(seen: Observation) -> Iterator[tuple[str, Sequence[PlanStep]]]:
        done = [epoch["human"] for epoch in seen["history"]]
        for name, steps in plans.items():
            if done == [steps_at(steps, epoch, human)[1] for epoch in range(1, len(done) + 1)]:
                yield name, steps

    def ask(seen: Observation) -> Any:
        actions, wishes = dict[str, str](), dict[str, str | None]()
        for name, steps in possible(seen):
            robots, wishes[name] = steps_at(steps, seen["epoch"], human)
            actions |= {robot: action for robot, action in robots.items() if action in seen["legal"][robot]}
        return {"actions": actions, "human": wishes}

    return ask
