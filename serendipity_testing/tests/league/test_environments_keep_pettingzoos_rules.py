"""The environment of a case is one of PettingZoo's, and who learns in it plays."""

from collections.abc import Mapping
from typing import Any

import pytest

from serendipity_testing.league import season
from serendipity_testing.league.play import played
from serendipity_testing.league.protocol import Helper
from serendipity_testing.tests.league.small import DOOR, LEAST

pytest.importorskip("pettingzoo")


@pytest.mark.long
@pytest.mark.parametrize("family", ["buildings", "homes", "competition"])
def test_pettingzoos_own_test_passes(family: str) -> None:
    from pettingzoo.test import parallel_api_test

    from serendipity_testing.league import CaseEnv

    (case,) = season("spring", [family], 1)
    parallel_api_test(CaseEnv(case), num_cycles=40)


def test_rewards_are_what_the_person_pays() -> None:
    from serendipity_testing.league import CaseEnv

    (case,) = season("small", tasks=[DOOR])
    env = CaseEnv(case)
    observed, _ = env.reset(seed=1)
    assert observed["robot"]["action_mask"].tolist() == [1, 1, 1]
    rewards = []
    while env.agents:
        _, reward, ended, cut, _ = env.step({"robot": 0})
        rewards.append(reward["robot"])
    assert (rewards, ended["robot"], cut["robot"]) == ([-1, -3, -1], True, False)


def test_a_learner_plays_what_it_has_learnt() -> None:
    from serendipity_testing.league.environment import CaseEnv, Learner

    def train(env: CaseEnv) -> Any:
        """Does what has paid most in the first epoch."""
        paid = {}
        for number in range(env.action_space("robot").n):
            env.reset(seed=number)
            paid[number] = 0
            while env.agents:
                paid[number] += env.step({"robot": number})[1]["robot"]
        best = max(paid, key=lambda number: paid[number])

        def policy(observed: Mapping[str, Any]) -> dict[str, int]:
            return {"robot": best}

        return policy

    (case,) = season("small", tasks=[DOOR])
    learner = Learner(train)
    (person,) = played(case, Helper("learner", learner.robots, learner.close), None)
    learner.close()
    assert person.paid == LEAST
