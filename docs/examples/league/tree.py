"""A helper as a behaviour tree (py_trees), for buildings: fetch a medkit, and bring it to the person.

cd docs/examples/league && serendipity league --families buildings --helper python:tree:helper
"""

from collections import deque

import py_trees
from py_trees.common import Status


def way(seen, robot, places):
    """The first move on the shortest way to one of some places."""
    moves = [
        name.split() for name in (a["name"] for a in seen["task"]["actions"]) if name.startswith("move ")
    ]
    here = next((fact.split()[2] for fact in seen["state"] if fact.startswith(f"at {robot} ")), None)
    queue, known = deque([(here, None)]), {here}
    while queue:
        place, first = queue.popleft()
        if place in places:
            return first
        for _, who, origin, target in moves:
            if who == robot and origin == place and target not in known:
                known.add(target)
                queue.append((target, first or f"move {robot} {origin} {target}"))
    return None


class Does(py_trees.behaviour.Behaviour):
    """Chooses what a function of observation and robot says, if that is legal; else it fails."""

    def __init__(self, name, choose, board):
        super().__init__(name)
        self.choose, self.board = choose, board

    def update(self):
        """Tick: it succeeds where there is something to do."""
        seen, robot = self.board["seen"], self.board["robot"]
        action = self.choose(seen, robot)
        if action not in seen["legal"].get(robot, ()):
            return Status.FAILURE
        self.board["chosen"][robot] = action
        return Status.SUCCESS


def legal(verb):
    """The first legal action of that word, which for a hand-over is one to the person."""

    def choose(seen, robot):
        names = [name for name in seen["legal"][robot] if name.split()[0] == verb]
        given = [name for name in names if name.split()[1:3] == [robot, seen["task"]["human"]]]
        return next(iter(given if verb == "hand_over" else names), None)

    return choose


def to_the_person(seen, robot):
    """Towards the person, with a medkit in the hand."""
    human = f"at {seen['task']['human']} "
    places = {fact.split()[2] for fact in seen["state"] if fact.startswith(human)}
    return way(seen, robot, places) if f"has_medkit {robot}" in seen["state"] else None


def to_a_medkit(seen, robot):
    """Towards the nearest medkit, without one in the hand."""
    return None if f"has_medkit {robot}" in seen["state"] else way(seen, robot, kits(seen))


def kits(seen):
    """Where medkits lie."""
    agents = {seen["task"]["human"], *seen["task"]["robots"]}
    facts = (fact.split() for fact in seen["state"] if fact.startswith("at "))
    return {place for _, what, place in facts if what not in agents}


def take(seen, robot):
    """Picks a medkit up, without one in the hand."""
    return None if f"has_medkit {robot}" in seen["state"] else legal("pick_up_medkit")(seen, robot)


BOARD = {}
ROOT = py_trees.composites.Selector("help", memory=False)
for _name, _choose in (
    ("hand over", legal("hand_over")),
    ("take", take),
    ("to the person", to_the_person),
    ("to a medkit", to_a_medkit),
):
    ROOT.add_child(Does(_name, _choose, BOARD))


def helper(seen):
    """What the tree has each robot do; nothing once the person has a medkit."""
    BOARD.update(seen=seen, chosen={})
    if f"has_medkit {seen['task']['human']}" not in seen["state"]:
        for robot in seen["task"]["robots"]:
            BOARD["robot"] = robot
            ROOT.tick_once()
    return {"actions": BOARD["chosen"]}
