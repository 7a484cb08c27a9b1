"""A small task, without its script, as the text of a program."""

from dataclasses import replace
from fractions import Fraction

from serendipity.model import Condition, GroundAction, Task


def in_python(task: Task) -> str:
    """The call of :func:`serendipity_testing.task` that builds a task anew; blanks in facts are ``_``."""
    facts = [fact.replace(" ", "_") for fact in task.facts]
    init = " ".join(facts[f] for f in sorted(task.init) if _matters(task, f))
    lines = [f"    agents={' '.join(task.agents)!r},", f"    human={task.agents[task.human]!r},"]
    lines += [f"    init={init!r},"] if init else []
    lines.append(f"    goal={_literals(task.goal, facts)!r},")
    lines += [f"    robot_goal={_literals(task.robot_goal, facts)!r},"] if task.robot_goal else []
    lines.append("    actions={")
    for name, ids in sorted(task.named.items()):
        variants = " | ".join(_action(task.actions[i], facts) for i in ids)
        lines.append(f"        {name!r}: {variants!r},")
    return "\n".join(["task(", *lines, "    },", ")"])


def told_with_people(task: Task) -> str:
    """The same of a task with bystanders, who are robots there, and what they want and begin, in words."""
    deeds, names = task.script.deeds, task.agents
    actions = {action: None for deed in deeds for action in deed.variants} | dict.fromkeys(task.actions)
    everybody = replace(task, actions=tuple(sorted(actions, key=lambda action: action.key)))
    wants = (f"{names[who]} wants {_literals(goal, list(task.facts))}" for who, goal in task.own_goals)
    begins = (f"{names[deed.agent]} begins in epoch {deed.epoch}: {deed.name}" for deed in deeds)
    return "\n".join([in_python(everybody), *wants, *begins])


def _matters(task: Task, fact: int) -> bool:
    """Whether anything asks for a fact or changes it."""
    goals = (*task.goal.positive, *task.goal.negative, *task.robot_goal.positive, *task.robot_goal.negative)
    moments = (moment for action in task.actions for moment in action.moments)
    return fact in goals or any(fact in (*a.pre, *a.neg, *a.add, *a.delete) for a in moments)


def _action(action: GroundAction, facts: list[str]) -> str:
    cost = "" if action.cost == 1 else f" @ {_number(action.cost)}"
    before = _literals(Condition(action.pre, action.neg), facts)
    after = _literals(Condition(action.add, action.delete), facts)
    timing = action.timing
    if timing is None:
        return f"{before} -> {after}{cost}".strip()
    asked = [before, _literals(timing.over_all, facts), _literals(timing.at_end, facts)]
    start = _literals(Condition(timing.start_add, timing.start_delete), facts)
    return f"{' / '.join(asked)} -> {start} / {after}{cost} [{timing.duration}]"


def _literals(condition: Condition, facts: list[str]) -> str:
    return " ".join(condition.literals(facts))


def _number(cost: Fraction) -> str:
    return f"{float(cost):g}" if Fraction(f"{float(cost):g}") == cost else str(cost)
