"""People beside the one who is helped: what they will do by themselves, and which of all could be helped."""

import threading
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final, NamedTuple, Unpack

from serendipity.facade.planning import SessionOptions, plan
from serendipity.model import Condition, Deadline, LimitReachedError, Result, Script, Task, UsageError
from serendipity.model.answers.result_parts import HelpedPerson
from serendipity.model.arguments import DEADLINE, TASK_IN_TIME, TEXT, expect, expect_or_none
from serendipity.model.keywords import Interference
from serendipity.model.numbers import as_written
from serendipity.model.resources.limits import limits_from
from serendipity.model.task.facts import Facts
from serendipity.model.task.names import canonical_name, named_alone
from serendipity.model.task.task import several

_GIVE: Final = "so a plan has to be given"

Goals = Mapping[str, Iterable[str]]
"""Literals by name of a person, ``!`` in front of those to be false."""


def with_bystanders(
    task: Task,
    people: Iterable[str] | Goals = (),
    *,
    human: str | None = None,
    interference: Interference = "paper",
    deadline: Deadline | None = None,
) -> Task:
    """The same task with bystanders who do what is best for them (semantics 10.3).

    Each of them, in this order, follows their own optimal plan beside the script so far: what the task has,
    and the plans of those before. What their goal asks for is no goal of the robots any more, nor of the
    human's where it names nobody else.

    Args:
        task: the task.
        people: their names; or the goal of each, by name. Without goals, those of the task are taken: of
            their own files, else what of the human's goal names them and nobody else.
        human: who is helped instead of the task's human, with the goal that the task has for them.
        interference: as in :class:`serendipity.model.Options`.
        deadline: of all these plans.

    Raises:
        UsageError: somebody is no agent, or the human, has a plan already, or no goal, or can't reach it
            alone.
        LimitReachedError: the deadline came first.
    """
    expect(TASK_IN_TIME, task=task)
    expect_or_none(TEXT, human=human)
    expect_or_none(DEADLINE, deadline=deadline)
    goals = {**people} if isinstance(people, Mapping) else dict.fromkeys(several(people, "bystanders"))
    if human is not None:
        task = _helping(task, _agent(task, human))
    facts = Facts(task.facts)
    for name, literals in goals.items():
        agent = _agent(task, name)
        if agent == task.human or agent in task.script.people:
            what = "is the human" if agent == task.human else "has a plan already"
            raise UsageError(f"bystander '{task.agents[agent]}': {what}")
        goal = _goal_of(task, agent) if literals is None else facts.condition(several(literals, "goal"))
        if literals is None and not goal:
            raise UsageError(f"bystander '{task.agents[agent]}': has no goal in the task, {_GIVE}")
        task = _beside(task, agent, goal, {"interference": interference, "deadline": deadline})
    return task


def helping_another(task: Task, names: Collection[str]) -> Task:
    """The same task with somebody as the human who is not among some; with the same one if that fits.

    Raises:
        UsageError: there is nobody else who has a goal.
    """
    if task.agents[task.human] not in names:
        return task
    others = [agent for agent, _ in task.own_goals if task.agents[agent] not in names]
    if not others:
        raise UsageError("human: nobody is left who has a goal and is no bystander")
    return _helping(task, others[0])


class Helped(NamedTuple):
    """Who is helped best.

    Attributes:
        task: with that person as the human, and all others as bystanders.
        result: the answer to it.
    """

    task: Task
    result: Result


def best_for_anybody(
    task: Task, cancelled: threading.Event | None = None, **asked: Unpack[SessionOptions]
) -> Helped:
    """The answer that saves most, of those in which one person is helped and the others are bystanders.

    Of equal savings the smaller objective counts, then the order of the agents. It is proved only where all
    of them are; ``humans`` of the result tells of each.

    Args:
        task: with people who have goals of their own.
        cancelled: as in :func:`serendipity.plan`.
        **asked: its keywords; each person has the same share of the time.

    Raises:
        UsageError: nobody has a goal, somebody can't reach it alone, or an option is wrong.
        LimitReachedError: a limit came before there was a plan for each bystander.
    """
    expect(TASK_IN_TIME, task=task)
    people = _people(task)
    if not people:
        raise UsageError("human: 'any' is for tasks in which somebody has a goal of their own")
    limits = limits_from(asked.get("time_limit"), asked.get("memory_limit"), asked.get("deadline"), cancelled)
    found: list[Helped] = []
    for number, person in enumerate(people):
        part = limits.part(1 / (len(people) - number))
        others = [task.agents[i] for i in people if i != person]
        strict = asked.get("interference", "paper")
        helped = with_bystanders(task, others, human=task.agents[person], interference=strict, deadline=part)
        asked["deadline"] = part
        found.append(Helped(helped, plan(helped, cancelled=cancelled, **asked)))
    best = max(found, key=lambda one: _worth(one.result))  # the first of equals
    told = (one.result for one in found)
    humans = tuple(HelpedPerson(one.human, one.status, one.cost, one.saving) for one in told)
    result = replace(best.result, humans=humans)
    if result.status == "optimal" and any(one.result.status in ("feasible", "unknown") for one in found):
        result = replace(result, status="feasible")
    return Helped(best.task, result)


def _worth(result: Result) -> tuple[int, Fraction, Fraction]:
    """Greater for better answers."""
    rank = 2 if result.cost is not None else ("infeasible", "unknown").index(result.status)
    saving, objective = (as_written(figure or 0) for figure in (result.saving, result.objective))
    return rank, saving, -objective


def _people(task: Task) -> list[int]:
    """Ids of those who have goals of their own, and no plan yet."""
    known = {agent for agent, _ in task.own_goals} | ({task.human} if task.goal else set())
    return sorted(known - task.script.people)


def _agent(task: Task, name: str) -> int:
    canonical = canonical_name(name)
    if canonical not in task.agents:
        raise UsageError(f"bystander: expected one of {', '.join(task.agents)}, got '{name:.50}'")
    return task.agents.index(canonical)


def _helping(task: Task, person: int) -> Task:
    """The same task with another human, whose goal is their own; that of the former is one of the robots'."""
    if person == task.human:
        return task
    goals = dict(task.own_goals)
    if person not in goals or person in task.script.people:
        why = "has a plan already" if person in task.script.people else "has no goal of their own in the task"
        raise UsageError(f"human: '{task.agents[person]}' {why}")
    theirs = goals.pop(person)
    everybody = Condition(
        (*task.robot_goal.positive, *task.goal.positive), (*task.robot_goal.negative, *task.goal.negative)
    )
    return replace(
        task,
        human=person,
        goal=theirs,
        robot_goal=everybody.without(theirs),
        own_goals=tuple(sorted({**goals, **({task.human: task.goal} if task.goal else {})}.items())),
        known_variables=task.variables,
    )


def _goal_of(task: Task, agent: int) -> Condition:
    """What the task has for somebody to want."""
    own = dict(task.own_goals).get(agent)
    return own or _naming(task, task.goal, agent)


def _naming(task: Task, goal: Condition, agent: int) -> Condition:
    """The literals of a goal that name an agent, and no other."""

    def fits(fact: int) -> bool:
        return named_alone(task.agents, task.facts[fact].split()) == agent

    return Condition(tuple(filter(fits, goal.positive)), tuple(filter(fits, goal.negative)))


def _beside(task: Task, agent: int, goal: Condition, how: dict[str, Any]) -> Task:
    """The task with one more bystander, who does what is best for them."""
    name = task.agents[agent]
    alone = replace(
        task, human=agent, goal=goal, robot_goal=Condition(), own_goals=(), known_variables=task.variables
    )
    found = plan(alone, mode="individual", **how)
    if found.status == "infeasible":
        raise UsageError(f"bystander '{name}': can't reach the goal alone, {_GIVE}")
    if found.status != "optimal" or found.human_entries is None:
        reason = found.reason or (how["deadline"] or Deadline()).reached() or "time-limit"
        raise LimitReachedError(reason, f"predicting the plan of '{name}'")
    left = replace(
        task,
        goal=task.goal.without(_naming(task, goal, agent)),
        robot_goal=task.robot_goal.without(goal),
        own_goals=tuple(sorted({**dict(task.own_goals), agent: goal}.items())),
        known_variables=task.variables,
    )
    return left.with_script(Script(people={name: found.human_entries}))
