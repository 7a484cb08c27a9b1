"""A case as a parallel environment of PettingZoo, and helpers that learn in it (extra ``pettingzoo``)."""

from collections.abc import Callable, Iterable, Mapping
from random import Random
from typing import Any, Final

import numpy

from serendipity.execution import Robots
from serendipity.model import UsageError
from serendipity_testing.league.cases import Case
from serendipity_testing.league.channels import Timely
from serendipity_testing.league.play import Run
from serendipity_testing.league.protocol import Ask, AskedRobots, Observation

try:
    from gymnasium.spaces import Dict, Discrete, MultiBinary
    from pettingzoo import ParallelEnv
except ImportError:
    raise UsageError("a PettingZoo environment needs: pip install serendipity-planner[pettingzoo]") from None

Policy = Callable[[Mapping[str, Any]], Mapping[str, int]]
"""From what each robot observes to the number of its action."""


class Encoding:
    """A case in numbers: each robot's actions, 0 for waiting, and what it observes.

    ``observation`` has a bit for each fact, and for each action of the person whether they have done it;
    ``action_mask`` one for each action of the robot, whether it is legal.
    """

    def __init__(self, case: Case) -> None:
        task = case.task
        self._bits = {fact: i for i, fact in enumerate(task.facts)}
        theirs = [a.name for a in task.actions if task.human in a.participants]
        self._done = {name: len(self._bits) + i for i, name in enumerate(dict.fromkeys(theirs))}
        self.size = len(self._bits) + len(self._done)
        self.actions: dict[str, list[str | None]] = {
            task.agents[i]: [None, *dict.fromkeys(a.name for a in task.actions if i in a.participants)]
            for i in task.robots
        }

    def observed(self, seen: Observation) -> dict[str, Any]:
        """What each robot observes."""
        bits = numpy.zeros(self.size, numpy.int8)
        bits[[self._bits[fact] for fact in seen["state"]]] = 1
        bits[[self._done[epoch["human"]] for epoch in seen["history"] if epoch["human"]]] = 1
        return {
            robot: {
                "observation": bits.copy(),
                "action_mask": numpy.array(
                    [name is None or name in seen["legal"][robot] for name in names], numpy.int8
                ),
            }
            for robot, names in self.actions.items()
        }

    def answer(self, seen: Observation, chosen: Mapping[str, int]) -> dict[str, Any]:
        """Numbers of actions as an answer; what is not legal, or only some of its robots want, is waiting."""
        names = {robot: self.actions[robot][int(number)] for robot, number in chosen.items()}
        teams = {action["name"]: action["agents"] for action in seen["task"]["actions"]}

        def possible(robot: str, name: str) -> bool:
            team = set(teams[name]) - {seen["task"]["human"]}
            return name in seen["legal"][robot] and all(names.get(other) == name for other in team)

        return {"actions": {r: n if n is not None and possible(r, n) else None for r, n in names.items()}}


class CaseEnv(ParallelEnv):  # type: ignore[misc]
    """A case as PettingZoo's parallel environment, with an agent for each robot.

    Who resets it meets a person, drawn by the probabilities of the plans; nobody tells which.  Each robot's
    reward is what the person has paid in the epoch, negated; those of a run add up to what it is scored by.
    """

    metadata: Final = {"name": "serendipity_league_v0", "render_modes": []}

    def __init__(self, case: Case) -> None:
        self._case, self._encoding = case, Encoding(case)
        self._dice = Random(case.name)
        self._chosen: Mapping[str, int] = {}
        self.possible_agents = list(self._encoding.actions)
        self.agents: list[str] = []
        self.render_mode = None
        self.action_spaces = {robot: Discrete(len(names)) for robot, names in self._encoding.actions.items()}
        self.observation_spaces = {
            robot: Dict(
                {"observation": MultiBinary(self._encoding.size), "action_mask": MultiBinary(len(names))}
            )
            for robot, names in self._encoding.actions.items()
        }

    def action_space(self, agent: str) -> Any:
        """The numbers of a robot's actions; 0 is waiting."""
        return self.action_spaces[agent]

    def observation_space(self, agent: str) -> Any:
        """What a robot observes."""
        return self.observation_spaces[agent]

    def reset(self, seed: int | None = None, options: Any = None) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begin anew with another person."""
        if seed is not None:
            self._dice = Random(seed)
        shares = [float(one.probability) for one in self._case.scenarios]
        (scenario,) = self._dice.choices(self._case.scenarios, shares)
        self.agents = list(self.possible_agents)
        self._robots = AskedRobots(self._case, lambda seen: self._encoding.answer(seen, self._chosen))
        self._run = Run(self._case, scenario, self._robots, None)
        return self._now(self.agents), {robot: {} for robot in self.agents}

    def step(self, actions: Mapping[str, int]) -> tuple[dict[str, Any], ...]:
        """An epoch: observations, rewards, terminations, truncations and more by robot."""
        self._chosen = actions
        loop = self._run.loop
        before = loop.human_cost
        self._run.step()
        robots, over, done = self.agents, self._run.over, loop.done
        reward = before - (self._run.played().paid if over else loop.human_cost)
        self.agents = [] if over else robots
        return (
            self._now(robots),
            dict.fromkeys(robots, float(reward)),
            dict.fromkeys(robots, over and done),
            dict.fromkeys(robots, over and not done),
            {robot: {} for robot in robots},
        )

    def _now(self, robots: Iterable[str]) -> dict[str, Any]:
        loop = self._run.loop
        observed = self._encoding.observed(self._robots.seen(loop.epoch, loop.state, None))
        return {robot: observed[robot] for robot in robots}


class Learner:
    """A helper that learns its policy for a case in the time before the first epoch, as ``train`` does."""

    def __init__(self, train: Callable[[CaseEnv], Policy]) -> None:
        self._train = train
        self._known: tuple[Case, Timely] | None = None

    def robots(self, case: Case, setup: float | None) -> Robots:
        """Those of a case, which is learnt once."""
        if self._known is None or self._known[0] is not case:
            self.close()
            self._known = case, Timely(_learnt(case, self._train))
        return AskedRobots(case, self._known[1], setup)

    def close(self) -> None:
        """Ask no more."""
        if self._known is not None:
            self._known[1].close()


def _learnt(case: Case, train: Callable[[CaseEnv], Policy]) -> Ask:
    encoding, policies = Encoding(case), list[Policy]()

    def ask(seen: Observation) -> Any:
        if not policies:
            policies.append(train(CaseEnv(case)))
        return encoding.answer(seen, policies[0](encoding.observed(seen)))

    return ask
