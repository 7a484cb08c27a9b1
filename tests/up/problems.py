"""Problems of unified-planning, small enough to search all of them."""

from collections.abc import Callable
from typing import Any

from unified_planning.model import Fluent, InstantaneousAction, Object, Problem, Variable
from unified_planning.model.metrics import MinimizeActionCosts, MinimizeSequentialPlanLength
from unified_planning.model.multi_agent import Agent, MultiAgentProblem
from unified_planning.shortcuts import (
    And,
    BoolType,
    Dot,
    Equals,
    Exists,
    Forall,
    Iff,
    Implies,
    IntType,
    Not,
    Or,
    Plus,
    UserType,
)


def kitchen() -> Problem:
    """Ann fetches tea from the pantry and brews it; the robot in there could bring it to the hall."""
    agent, place = UserType("Agent"), UserType("Place")
    person, helper = UserType("Person", agent), UserType("Helper", agent)
    problem = Problem("kitchen")
    at = Fluent("at", place, who=agent)
    door = Fluent("door", BoolType(), a=place, b=place)
    tea_at = Fluent("tea_at", BoolType(), where=place)
    has_tea = Fluent("has_tea", BoolType(), who=agent)
    brewed = Fluent("brewed", BoolType())
    problem.add_fluent(at)
    for fluent in (door, tea_at, has_tea, brewed):
        problem.add_fluent(fluent, default_initial_value=False)
    ann, robot = Object("Ann", person), Object("Robot", helper)
    rooms = {name: Object(name, place) for name in ("Sofa", "Corridor", "Hall", "Pantry", "Kitchen")}
    problem.add_objects([ann, robot, *rooms.values()])
    for a, b in (("Sofa", "Corridor"), ("Corridor", "Hall"), ("Hall", "Pantry"), ("Hall", "Kitchen")):
        problem.set_initial_value(door(rooms[a], rooms[b]), True)
        problem.set_initial_value(door(rooms[b], rooms[a]), True)
    problem.set_initial_value(at(ann), rooms["Sofa"])
    problem.set_initial_value(at(robot), rooms["Pantry"])
    problem.set_initial_value(tea_at(rooms["Pantry"]), True)

    walk = InstantaneousAction("walk", who=agent, start=place, end=place)
    walk.add_precondition(Equals(at(walk.who), walk.start))
    walk.add_precondition(door(walk.start, walk.end))
    walk.add_effect(at(walk.who), walk.end)
    take = InstantaneousAction("take", who=agent, where=place)
    take.add_precondition(Equals(at(take.who), take.where))
    take.add_precondition(tea_at(take.where))
    take.add_effect(tea_at(take.where), False)
    take.add_effect(has_tea(take.who), True)
    give = InstantaneousAction("hand_over", giver=agent, taker=agent)
    give.add_precondition(Not(Equals(give.giver, give.taker)))
    give.add_precondition(Equals(at(give.giver), at(give.taker)))
    give.add_precondition(has_tea(give.giver))
    give.add_effect(has_tea(give.giver), False)
    give.add_effect(has_tea(give.taker), True)
    brew = InstantaneousAction("brew", who=person)
    brew.add_precondition(Equals(at(brew.who), rooms["Kitchen"]))
    brew.add_precondition(has_tea(brew.who))
    brew.add_effect(brewed, True)
    problem.add_actions([walk, take, give, brew])
    problem.add_goal(brewed)
    problem.add_quality_metric(MinimizeActionCosts({}, default=1))
    return problem


def corridor() -> MultiAgentProblem:
    """Ann wants to be in the kitchen; the robot can open its door, which takes her two steps."""
    problem = MultiAgentProblem("corridor")
    place = UserType("Place")
    rooms = [Object(name, place) for name in ("Hall", "Door", "Kitchen")]
    problem.add_objects(rooms)
    is_open = Fluent("is_open", BoolType())
    problem.ma_environment.add_fluent(is_open, default_initial_value=False)
    pos = Fluent("pos", BoolType(), where=place)
    agents = {name: Agent(name, problem) for name in ("Ann", "Robot")}
    for agent in agents.values():
        agent.add_public_fluent(pos, default_initial_value=False)
        problem.add_agent(agent)
    for name, start, end in (("approach", 0, 1), ("enter", 1, 2)):
        action = InstantaneousAction(name)
        action.add_precondition(pos(rooms[start]))
        if name == "enter":
            action.add_precondition(is_open)
        action.add_effect(pos(rooms[start]), False)
        action.add_effect(pos(rooms[end]), True)
        agents["Ann"].add_action(action)
    unlock, push, pull = (InstantaneousAction(name) for name in ("unlock", "push", "pull"))
    unlocked = Fluent("unlocked", BoolType())
    agents["Ann"].add_private_fluent(unlocked, default_initial_value=False)
    unlock.add_precondition(pos(rooms[1]))
    unlock.add_effect(unlocked, True)
    push.add_precondition(unlocked)
    push.add_effect(is_open, True)
    pull.add_precondition(pos(rooms[2]))
    pull.add_effect(is_open, True)
    agents["Ann"].add_actions([unlock, push])
    agents["Robot"].add_action(pull)
    problem.set_initial_value(Dot(agents["Ann"], pos(rooms[0])), True)
    problem.set_initial_value(Dot(agents["Robot"], pos(rooms[2])), True)
    agents["Ann"].add_public_goal(pos(rooms[2]))
    return problem


def _blocks() -> tuple[Problem, dict[str, Any]]:
    block = UserType("Block")
    red = UserType("Red", block)
    problem = Problem("blocks")
    things = {name: Object(name, kind) for name, kind in (("a", block), ("b", red), ("c", red))}
    problem.add_objects(list(things.values()))
    below, marked, done = (
        Fluent("below", block, x=block),
        Fluent("marked", BoolType(), x=block),
        Fluent("done", BoolType()),
    )
    problem.add_fluent(below, default_initial_value=things["a"])
    problem.add_fluent(marked, default_initial_value=False)
    problem.add_fluent(done, default_initial_value=False)
    names = {"block": block, "red": red, "below": below, "marked": marked, "done": done, **things}
    return problem, names


def _action(problem: Problem, name: str, build: Callable[[InstantaneousAction], None], **kinds: Any) -> None:
    action = InstantaneousAction(name, **kinds)
    build(action)
    problem.add_action(action)


def conditions() -> Problem:
    """Quantifiers, implications, equivalences, disjunctions."""
    problem, n = _blocks()
    x, y = Variable("x", n["block"]), Variable("x", n["red"])

    def mark(action: InstantaneousAction) -> None:
        action.add_precondition(Implies(n["marked"](action.x), n["done"]))
        action.add_effect(n["marked"](action.x), True)

    def finish(action: InstantaneousAction) -> None:
        action.add_precondition(Forall(n["marked"](y), y))
        action.add_precondition(Exists(And(n["marked"](x), Not(Equals(x, n["b"]))), x))
        action.add_precondition(Iff(n["marked"](n["a"]), n["done"]))
        action.add_precondition(Or(n["done"], n["marked"](n["b"])))
        action.add_effect(n["done"], True)

    _action(problem, "mark", mark, x=n["block"])
    _action(problem, "finish", finish)
    problem.add_goal(And(n["done"], Forall(n["marked"](x), x)))
    problem.add_quality_metric(MinimizeSequentialPlanLength())
    return problem


def effects() -> Problem:
    """Conditional effects, for all of a type; fluents and conditions that are assigned."""
    problem, n = _blocks()
    x = Variable("x", n["block"])

    def sweep(action: InstantaneousAction) -> None:
        action.add_effect(n["marked"](x), True, Equals(n["below"](x), action.y), forall=[x])
        action.add_effect(n["marked"](action.y), False)

    def shift(action: InstantaneousAction) -> None:
        action.add_effect(n["below"](action.x), n["below"](action.y), n["marked"](action.y))
        action.add_effect(n["marked"](action.x), n["marked"](n["below"](action.y)))

    def place(action: InstantaneousAction) -> None:
        action.add_precondition(n["marked"](n["below"](action.x)))
        action.add_effect(n["below"](action.x), action.x)
        action.add_effect(n["done"], Not(n["done"]))

    _action(problem, "sweep", sweep, y=n["red"])
    _action(problem, "shift", shift, x=n["block"], y=n["block"])
    _action(problem, "place", place, x=n["red"])
    problem.add_goal(And(Not(Equals(n["below"](n["c"]), n["below"](n["a"]))), Not(n["marked"](n["b"]))))
    problem.add_goal(Or(n["done"], Equals(n["below"](n["a"]), n["b"])))
    problem.set_initial_value(n["below"](n["b"]), n["c"])
    problem.add_quality_metric(MinimizeSequentialPlanLength())
    return problem


def costs() -> Problem:
    """Costs from static numbers: the direct way is the dearer one."""
    problem = Problem("costs")
    place = UserType("Place")
    rooms = [Object(name, place) for name in ("a", "b", "c")]
    problem.add_objects(rooms)
    distance = Fluent("distance", IntType(), x=place, y=place)
    here = Fluent("here", place)
    problem.add_fluent(distance, default_initial_value=9)
    problem.add_fluent(here)
    problem.set_initial_value(here, rooms[0])
    problem.set_initial_value(distance(rooms[0], rooms[1]), 2)
    problem.set_initial_value(distance(rooms[1], rooms[2]), 3)
    go = InstantaneousAction("go", x=place, y=place)
    go.add_precondition(Equals(here, go.x))
    go.add_effect(here, go.y)
    problem.add_action(go)
    problem.add_goal(Equals(here, rooms[2]))
    problem.add_quality_metric(MinimizeActionCosts({go: Plus(distance(go.x, go.y), 1)}))
    return problem


SINGLE: dict[str, Callable[[], Problem]] = {
    "kitchen": kitchen,
    "conditions": conditions,
    "effects": effects,
    "costs": costs,
}
"""Problems of one agent who does all, by name."""
