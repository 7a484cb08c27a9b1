"""A helper that learns: a table of values for each robot, in the PettingZoo environment of each case.

cd docs/examples/league && serendipity league --helper pettingzoo:learner:train
"""

import random

EPISODES, RATE, STRAY = 400, 0.3, 0.2


def train(env):
    """Learn in some episodes; the policy takes the legal action of the greatest value that was ever seen."""
    dice = random.Random(0)
    values = {robot: {} for robot in env.possible_agents}

    def best(robot, seen, unknown):
        """Of legal actions; waiting comes first where they are worth the same."""
        known, key = values[robot], seen["observation"].tobytes()
        legal = map(int, seen["action_mask"].nonzero()[0])
        return max(legal, key=lambda action: (known.get((key, action), unknown), -action))

    def tried(robot, seen):
        """The best so far, or now and then any."""
        stray = dice.random() < STRAY
        return int(dice.choice(seen["action_mask"].nonzero()[0])) if stray else best(robot, seen, 0.0)

    for _ in range(EPISODES):
        seen, _ = env.reset()
        passed = []
        while env.agents:
            chosen = {robot: tried(robot, one) for robot, one in seen.items()}
            after, rewards, *_ = env.step(chosen)
            passed.append((seen, chosen, rewards))
            seen = after
        worth = 0.0
        for before, chosen, rewards in reversed(passed):
            worth += next(iter(rewards.values()))
            for robot, action in chosen.items():
                key = before[robot]["observation"].tobytes(), action
                known = values[robot].get(key, worth)
                values[robot][key] = known + RATE * (worth - known)
    return lambda seen: {robot: best(robot, one, -1e9) for robot, one in seen.items()}
