"""Tasks to grounded PDDL: a folder per agent and ``superagent/``, as :func:`load` reads it.

Blanks in names become ``_`` (``move robot a b`` is written ``move_robot_a_b``), and
names that clash or that PDDL can't hold get a suffix or prefix.  So the task that is
read back is the same up to ids and names; facts that no executable action touches and
no goal needs are not in it.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import lcm
from pathlib import Path
from typing import Final

from serendipity.model import GroundAction, InputError, Task, Timing
from serendipity.model.task.names import unused
from serendipity.pddl.classical import ClassicalFiles
from serendipity.pddl.parsing.scope import RESERVED
from serendipity.pddl.participants import agents_named

TEAM: Final = "superagent"
_ILLEGAL: Final = re.compile(r"[^a-z0-9_-]")


def write_pddl(task: Task, directory: str | Path) -> None:
    """Write a task as a directory that ``load(directory, human=..., epoch=1)`` reads back.

    Args:
        task: the task; its agents' names must do as names of folders.
        directory: is made if it does not exist.

    Raises:
        OSError: it can't be written.
    """
    for folder, (domain, problem) in task_files(task).items():
        place = Path(directory, folder)
        place.mkdir(parents=True, exist_ok=True)
        (place / "domain.pddl").write_text(domain, encoding="utf-8")
        (place / "problem.pddl").write_text(problem, encoding="utf-8")


def task_files(task: Task) -> dict[str, tuple[str, str]]:
    """Texts ``(domain, problem)`` of agents' folders and the team's; an InputError beside bystanders."""
    if task.script.people:
        raise InputError("a task with bystanders can't be written: their plans are no part of PDDL")
    facts = _fact_names(task)
    names = _action_names(task)
    files = {}
    for agent, name in enumerate(task.agents):
        own = {names[i]: a for i, a in enumerate(task.actions) if a.participants == (agent,)}
        goal = _literals(task.goal.positive, task.goal.negative, facts) if agent == task.human else []
        mentioned = _mentioned(own.values())
        if agent == task.human:
            mentioned |= {*task.goal.positive, *task.goal.negative}
            mentioned |= {one.fact for one in task.script.facts}
        files[name] = (_domain(own, facts, mentioned), _problem(task, facts, mentioned, goal))
    joint = {names[i]: a for i, a in enumerate(task.actions) if a.joint}
    goal = _literals(task.robot_goal.positive, task.robot_goal.negative, facts)
    everything = set(range(len(facts)))
    files[TEAM] = (_domain(joint, facts, everything), _problem(task, facts, everything, goal))
    return files


def composite_files(task: Task, discount: Fraction) -> ClassicalFiles:
    """One domain and problem whose optimal plans are the composite ones without a horizon.

    Plans of such a problem are sequences.  Where actions may share an epoch although each
    spoils a precondition of another (``interference="paper"``), no sequence does the same.

    Raises:
        InputError: the task needs time.
    """
    if task.needs_time:
        raise InputError("planners for one agent are given no durations and no timed literals")
    costs = [task.team_cost(action, discount) for action in task.actions]
    scale = lcm(*(cost.denominator for cost in costs))
    facts = _fact_names(task)
    actions = {
        name: replace(action, cost=cost * scale)
        for name, action, cost in zip(composite_names(task), task.actions, costs, strict=True)
    }
    everything = set(range(len(facts)))
    goals = (task.goal, task.robot_goal)
    literals = [text for goal in goals for text in _literals(goal.positive, goal.negative, facts)]
    return ClassicalFiles(
        _domain(actions, facts, everything), _problem(task, facts, everything, literals), scale
    )


def composite_names(task: Task) -> list[str]:
    """The names of a task's actions in :func:`composite_files`, in their order."""
    used: set[str] = set()
    return [unused(_legal(action.name), used) for action in task.actions]


def _mentioned(actions: Iterable[GroundAction]) -> set[int]:
    moments = (moment for action in actions for moment in action.moments)
    return {fact for a in moments for fact in (*a.pre, *a.neg, *a.add, *a.delete)}


def _domain(actions: Mapping[str, GroundAction], facts: Sequence[str], mentioned: set[int]) -> str:
    timed = " :durative-actions" if any(action.timing for action in actions.values()) else ""
    lines = [
        "(define (domain grounded)",
        f"  (:requirements :strips :negative-preconditions :action-costs{timed})",
    ]
    lines += ["  (:predicates", *(f"    ({facts[fact]})" for fact in sorted(mentioned)), "  )"]
    lines.append("  (:functions (total-cost))")
    for name, action in actions.items():
        if action.timing is not None:
            lines += _durative(name, action, action.timing, facts)
            continue
        condition = _literals(action.pre, action.neg, facts)
        effect = [f"(increase (total-cost) {_number(action.cost)})"]
        effect += _literals(action.add, action.delete, facts)
        lines += [
            f"  (:action {name}",
            "    :parameters ()",
            f"    :precondition (and {' '.join(condition)})",
            f"    :effect (and {' '.join(effect)}))",
        ]
    return "\n".join([*lines, ")", ""])


def _durative(name: str, action: GroundAction, timing: Timing, facts: Sequence[str]) -> list[str]:
    cost = f"(increase (total-cost) {_number(action.cost)})"
    conditions = [
        *_at("at start", _literals(action.pre, action.neg, facts)),
        *_at("over all", _literals(timing.over_all.positive, timing.over_all.negative, facts)),
        *_at("at end", _literals(timing.at_end.positive, timing.at_end.negative, facts)),
    ]
    effects = [
        *_at("at start", [cost, *_literals(timing.start_add, timing.start_delete, facts)]),
        *_at("at end", _literals(action.add, action.delete, facts)),
    ]
    return [
        f"  (:durative-action {name}",
        "    :parameters ()",
        f"    :duration (= ?duration {timing.duration})",
        f"    :condition (and {' '.join(conditions)})",
        f"    :effect (and {' '.join(effects)}))",
    ]


def _at(when: str, parts: Iterable[str]) -> Iterator[str]:
    return (f"({when} {part})" for part in parts)


def _problem(task: Task, facts: Sequence[str], mentioned: set[int], goal: Iterable[str]) -> str:
    init = [f"    ({facts[fact]})" for fact in sorted(task.init & mentioned)]
    lines = [
        f"(define (problem {_legal(task.name.lower())})",
        "  (:domain grounded)",
        "  (:init",
        "    (= (total-cost) 0)",
        *init,
        *(
            f"    (at {one.epoch} {literal})"
            for one in task.script.facts
            if one.fact in mentioned
            for literal in _literals([one.fact] if one.true else [], [] if one.true else [one.fact], facts)
        ),
        "  )",
        f"  (:goal (and {' '.join(goal)}))",
        "  (:metric minimize (total-cost))",
        ")",
        "",
    ]
    return "\n".join(lines)


def _literals(positive: Iterable[int], negative: Iterable[int], facts: Sequence[str]) -> list[str]:
    return [*(f"({facts[f]})" for f in positive), *(f"(not ({facts[f]}))" for f in negative)]


def _number(cost: Fraction) -> str:
    return str(cost) if cost.denominator == 1 else f"(/ {cost.numerator} {cost.denominator})"


def _fact_names(task: Task) -> list[str]:
    used: set[str] = set()
    return [unused(_legal(name), used) for name in task.facts]


def _action_names(task: Task) -> list[str]:
    """Names that differ where they meet in a file; a joint action's tells its participants."""
    used: dict[int, set[str]] = {agent: set() for agent in range(len(task.agents))}
    names: dict[int, str] = {}
    for i, action in enumerate(task.actions):
        if not action.joint:
            names[i] = unused(_legal(action.name), used[action.participants[0]])
    taken: set[str] = set().union(*used.values())
    for i, action in enumerate(task.actions):
        if action.joint:
            names[i] = unused(_joint_name(action, task.agents, f"joint{i}"), taken)
    return [names[i] for i in range(len(task.actions))]


def _joint_name(action: GroundAction, agents: Sequence[str], fallback: str) -> str:
    who = "_".join(agents[agent].replace(" ", "_") for agent in action.participants)
    name = _legal(action.name)
    for candidate in (name, f"{name}_{who}"):
        if agents_named(agents, candidate) == action.participants:
            return candidate
    return f"{fallback}_{who}"


def _legal(name: str) -> str:
    """The name as a single word that is no keyword and no number."""
    word = _ILLEGAL.sub("_", name.lower())
    return word if word[:1].isalpha() and word not in RESERVED else f"x_{word}"
