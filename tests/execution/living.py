"""Epochs lived through by a simulated person, with an oracle beside them that knows nothing of the search."""

import json
from random import Random
from typing import Any

from serendipity.execution import Execution, LogLine, Omniscient, Person, log_lines, moment_of, replay
from serendipity.model import Condition, Task
from serendipity_testing.oracle import human_plans
from verify.base.optimal_plans import OptimalPlans

MOST_EPOCHS = 60

ROOMS = ("room1", "room3", "room9")
GOALS = [{"name": room, "goal": [f"conducted_triage commx {room}"]} for room in ROOMS]


def aiming_at(task: Task, room: str) -> Task:
    """The task of somebody who goes to that room."""
    return task.with_goal(Condition((task.facts.index(f"conducted_triage commx {room}"),)))


def lived(run: Execution, person: Person, most: int = MOST_EPOCHS) -> Execution:
    """An execution that has gone on to the goal, or for so many epochs."""
    while not run.done and run.epoch < most:
        run.step(person.choose(moment_of(run)))
    return run


def told(task: Task, **settings: Any) -> Execution:
    """The same with somebody who keeps to the robots' plan."""
    return lived(Execution(task, told=True, **{"discount": "0.9", **settings}), Omniscient(task))


def arrives(task: Task, run: Execution, person: Person) -> None:
    """Go on to the goal; nobody pays more than alone, and no bystander is disturbed."""
    plan = next(human_plans(task), None)
    lived(run, person)
    if plan is not None:
        assert run.done and run.human_cost <= task.cost_of(plan)
        assert not any(missed.why == "broken" for passed in run.passed for missed in passed.unfinished)


def verdicts(run: Execution) -> list[str]:
    """Of all epochs that are over."""
    return [passed.decided.verdict for passed in run.passed]


def as_lines(run: Execution) -> list[LogLine]:
    """The lines of an execution's log, by way of JSON."""
    lines = json.loads(json.dumps(list(log_lines(run, seed=1))))
    return [LogLine(number, line) for number, line in enumerate(lines, start=1)]


def replayed(task: Task, run: Execution) -> Execution:
    """The same again by its log, which comes to the same."""
    again = replay(task, as_lines(run))
    assert (again.state, again.cost, again.human_cost) == (run.state, run.cost, run.human_cost)
    return again


def lived_short_of_a_robot(task: Task, run: Execution, person: Person) -> Execution:
    """An execution after six epochs, the first robot out of order from the fifth on."""
    for epoch in range(6):
        run.step(person.choose(moment_of(run)))
        if epoch == 3:
            run.drop([task.agents[task.robots[0]]])
    return run


def live(
    task: Task, run: Execution, person: Person, *, predicted: bool = True, sees_all: bool = True
) -> None:
    """Go on to the goal, and hold robots to what they promise after every epoch.

    Args:
        task: where it begins; nothing is asked where the person has no plan alone.
        run: the execution.
        person: the person.
        predicted: whether what the person has in mind is what robots take them to follow.
        sees_all: whether they see at once that there is something cheaper, so that they drop their plan.
    """
    oracle = OptimalPlans(task)
    alone = oracle.cost(task.init)
    if alone is None:
        return
    while not run.done:
        assert run.epoch < MOST_EPOCHS, "the person never gets there"
        run.step(person.choose(moment_of(run)))
        rest = oracle.cost(run.state)
        assert rest is not None, "robots took the person's last plan away"
        assert run.human_cost + rest <= alone, "robots made it dearer"
        together = any(len(step.agents) > 1 for step in run.passed[-1].steps)
        if predicted and not together:
            plan = person.plan or ()
            works = oracle.cost_of(plan, run.state) is not None
            dropped = sees_all and rest < task.cost_of(plan)
            assert works or dropped, "robots spoilt the plan that the person was following"
    assert run.human_cost <= alone


def other_goals(task: Task, dice: Random, most: int = 3) -> list[dict[str, object]]:
    """The task's goal and a few others as candidates, in any order."""
    own = [task.facts[f] for f in task.goal.positive] + [f"!{task.facts[f]}" for f in task.goal.negative]
    goals: list[dict[str, object]] = [{"name": "own", "goal": own}]
    for number in range(dice.randint(1, most)):
        facts = dice.sample(range(len(task.facts)), min(len(task.facts), dice.randint(1, 2)))
        goals.append({"name": f"other {number}", "goal": [task.facts[f] for f in facts]})
    dice.shuffle(goals)
    return goals
