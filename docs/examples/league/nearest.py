"""A helper as a program: robots go for the nearest thing that the person's plan still has to bring about.

serendipity league --helper "command:python3 docs/examples/league/nearest.py"
"""

import json
import sys
from collections import deque

MOST = 400  # states looked at for a decision


def parts(literals):
    """What has to be true, and what false."""
    return {x for x in literals if x[0] != "!"}, {x[1:] for x in literals if x[0] == "!"}


def likeliest(seen):
    """What is left of the likeliest plan that what the person did fits; of any, where none does."""
    done = [epoch["human"] for epoch in seen["history"] if epoch["human"]]
    fitting = [one for one in seen["plans"] if one["plan"][: len(done)] == done] or seen["plans"]
    return max(fitting, key=lambda one: one["probability"])["plan"][len(done) :]


def first_step(state, actions, wanted):
    """The first action on the shortest way to any fact that is wanted; None where there is none near."""
    queue, known = deque([(state, None)]), {state}
    while queue and len(known) < MOST:
        here, first = queue.popleft()
        for name, alone, (needs, bars), (adds, deletes) in actions:
            if needs <= here and not bars & here:
                if adds & wanted:
                    return first or name
                there = frozenset(here - deletes | adds)
                if alone and there not in known:
                    known.add(there)
                    queue.append((there, first or name))
    return None


for line in sys.stdin:
    seen = json.loads(line)
    task, state = seen["task"], frozenset(seen["state"])
    effects = {action["name"]: parts(action["effects"])[0] for action in task["actions"]}
    wanted = {fact for name in likeliest(seen) for fact in effects[name]} - state
    chosen = {}
    for robot in task["robots"]:
        able = [
            (a["name"], a["agents"] == [robot], parts(a["pre"]), parts(a["effects"]))
            for a in task["actions"]
            if robot in a["agents"] and set(a["agents"]) <= {robot, task["human"]}
        ]
        name = first_step(state, able, wanted)
        chosen[robot] = name if name in seen["legal"][robot] else None
        wanted -= effects.get(chosen[robot], set())
    print(json.dumps({"actions": chosen}), flush=True)
