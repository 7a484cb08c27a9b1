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
    take = InstantaneousAction("take", who=agent, where=place)
    give = InstantaneousAction("hand_over", giver=agent, taker=agent)
    brew = InstantaneousAction("brew", who=person)
    _set(walk, [Equals(at(walk.who), walk.start), door(walk.start, walk.end)], (at(walk.who), walk.end))
    _set(
        take,
        [Equals(at(take.who), take.where), tea_at(take.where)],
        (tea_at(take.where), False),
        (has_tea(take.who), True),
    )
    apart, near = Not(Equals(give.giver, give.taker)), Equals(at(give.giver), at(give.taker))
    _set(give, [apart, near, has_tea(give.giver)], (has_tea(give.giver), False), (has_tea(give.taker), True))
    _set(brew, [Equals(at(brew.who), rooms["Kitchen"]), has_tea(brew.who)], (brewed, True))
    problem.add_actions([walk, take, give, brew])
    problem.add_goal(brewed)
    problem.add_quality_metric(MinimizeActionCosts({}, default=1))
    return problem


def _set(
    action: InstantaneousAction, conditions: list[Any], *effects: tuple[Any, Any]
) -> InstantaneousAction:
    """The action with these conditions and effects."""
    for condition in conditions:
        action.add_precondition(condition)
    for fluent, value in effects:
        action.add_effect(fluent, value)


def corridor() -> MultiAgentProblem:
    """Ann wants to be in the kitchen; the robot can open its door, which takes her two steps."""
    problem = MultiAgentProblem("corridor")
    place = UserType("Place")
    hall, door, kitchen = rooms = [Object(name, place) for name in ("Hall", "Door", "Kitchen")]
    problem.add_objects(rooms)
    is_open, unlocked = (Fluent(name, BoolType()) for name in ("is_open", "unlocked"))
    problem.ma_environment.add_fluent(is_open, default_initial_value=False)
    pos = Fluent("pos", BoolType(), where=place)
    ann, robot = (Agent(name, problem) for name in ("Ann", "Robot"))
    for agent in (ann, robot):
        agent.add_public_fluent(pos, default_initial_value=False)
        problem.add_agent(agent)
    ann.add_private_fluent(unlocked, default_initial_value=False)
    names = ("approach", "enter", "unlock", "push", "pull")
    approach, enter, unlock, push, pull = (InstantaneousAction(name) for name in names)
    _set(approach, [pos(hall)], (pos(hall), False), (pos(door), True))
    _set(enter, [pos(door), is_open], (pos(door), False), (pos(kitchen), True))
    _set(unlock, [pos(door)], (unlocked, True))
    _set(push, [unlocked], (is_open, True))
    _set(pull, [pos(kitchen)], (is_open, True))
    ann.add_actions([approach, enter, unlock, push])
    robot.add_action(pull)
    problem.set_initial_value(Dot(ann, pos(hall)), True)
    problem.set_initial_value(Dot(robot, pos(kitchen)), True)
    ann.add_public_goal(pos(kitchen))
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


def conditions() -> Problem:
    """Quantifiers, implications, equivalences, disjunctions."""
    problem, n = _blocks()
    marked, done = n["marked"], n["done"]
    x, y = Variable("x", n["block"]), Variable("x", n["red"])
    mark, finish = InstantaneousAction("mark", x=n["block"]), InstantaneousAction("finish")
    _set(mark, [Implies(marked(mark.x), done)], (marked(mark.x), True))
    wanted = [
        Forall(marked(y), y),
        Exists(And(marked(x), Not(Equals(x, n["b"]))), x),
        Iff(marked(n["a"]), done),
        Or(done, marked(n["b"])),
    ]
    _set(finish, wanted, (done, True))
    problem.add_actions([mark, finish])
    problem.add_goal(And(done, Forall(marked(x), x)))
    problem.add_quality_metric(MinimizeSequentialPlanLength())
    return problem


def effects() -> Problem:
    """Conditional effects, for all of a type; fluents and conditions that are assigned."""
    problem, n = _blocks()
    below, marked, done = n["below"], n["marked"], n["done"]
    x = Variable("x", n["block"])
    sweep = InstantaneousAction("sweep", y=n["red"])
    sweep.add_effect(marked(x), True, Equals(below(x), sweep.y), forall=[x])
    sweep.add_effect(marked(sweep.y), False)
    shift = InstantaneousAction("shift", x=n["block"], y=n["block"])
    shift.add_effect(below(shift.x), below(shift.y), marked(shift.y))
    shift.add_effect(marked(shift.x), marked(below(shift.y)))
    place = InstantaneousAction("place", x=n["red"])
    _set(place, [marked(below(place.x))], (below(place.x), place.x), (done, Not(done)))
    problem.add_actions([sweep, shift, place])
    problem.add_goal(And(Not(Equals(below(n["c"]), below(n["a"]))), Not(marked(n["b"]))))
    problem.add_goal(Or(done, Equals(below(n["a"]), n["b"])))
    problem.set_initial_value(below(n["b"]), n["c"])
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
