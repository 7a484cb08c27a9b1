"""The rule that nobody pays for help, and that it leaves little behind (semantics 12), as goals of a task.

What bystanders need for the rest of their plans is worked out backward, from the end of each plan to ``T``.
"""

from collections.abc import Callable, Iterable, Sequence
from fnmatch import fnmatchcase
from fractions import Fraction
from typing import NamedTuple

from serendipity.model import Claim, Condition, Deadline, HumanPlan, Options, PlanError, Result, Task
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.disturbance import Weighed, disturbance_from
from serendipity.model.task.gate import is_bound, nobody_pays
from serendipity.model.task.metered import Metered
from serendipity.model.task.noticed import Noticed
from serendipity.model.task.visibility import surroundings
from verify.base import wording
from verify.base.due import onward
from verify.base.execution import State, after, is_calm, is_last, met
from verify.base.obligations import is_tied, needed
from verify.rules.noticed import unnoticed
from verify.rules.replay import replay, replay_human

Literals = dict[int, bool]
"""By fact whether it has to be true."""


class Rule(NamedTuple):
    """What the last state and the human's payments have to be like.

    Attributes:
        facts: of the last state.
        most: that the human may pay; None: anything.
    """

    facts: Condition
    most: Fraction | None


def under_the_rule(
    task: Task,
    result: Result,
    original: Task,
    deadline: Deadline,
    examine: Callable[[Task, Result], Iterable[Claim]],
) -> tuple[Claim, ...]:
    """The claims of a result about one plan of the human's.

    Where the answer says that the rule binds, it is one to the task with the rule as goals; else the best one
    without the rule, which keeps it.

    Args:
        task: in single epochs where it needs time.
        result: for it.
        original: the task as it was given.
        deadline: polled.
        examine: makes the claims of a task and a result without the rule.
    """
    if not is_bound(original, result.options) or not isinstance(result.horizon, int):
        return tuple(examine(task, result))
    if is_tied(result):
        return tuple(Claim(name, "undecided", wording.RULE_OVER_TIES) for name in needed(result))
    try:
        names = result.human_plan
        plan = None if names is None else replay_human(task, names, deadline)
    except PlanError:
        return tuple(examine(task, result))  # which says so
    rule = rule_of(task, result.options, plan, result.horizon, original)
    fault = (
        broken(task, result, rule, deadline)
        or disturbs(task, result, original, deadline)
        or unnoticed(task, result, plan, original, deadline)
    )
    if fault is not None:
        return (Claim("replay", "refuted", fault),)
    if not result.statistics.get("rule_binds"):
        return tuple(examine(task, result))
    bound = with_goals(task, rule.facts)
    if result.options.noticed and plan is not None:
        bound = Noticed(bound, plan, original).task
    if rule.most is not None and task.robot_goal:
        bound = Metered(bound, rule.most, deadline).task
    most = result.options.max_disturbance
    if most is not None:
        weighed = Weighed(bound, disturbance_from(result.options.disturbance), original)
        bound = Metered(weighed.task, most, deadline, weighed.weights, "disturbed").task
    return tuple(examine(bound, result))


def broken(task: Task, result: Result, rule: Rule, deadline: Deadline) -> str | None:
    """What a plan breaks of the rule, in words; None if nothing, or if it can't be executed."""
    found = replay(task, result.plan or (), deadline, strict=result.options.strict)
    if result.plan is None or found.fault is not None:
        return None
    his = (task.actions[i] for chosen in found.sets.values() for i in chosen)
    paid = sum((one.cost for one in his if task.human in one.participants), Fraction(0))
    if rule.most is not None and paid > rule.most:
        return wording.HUMAN_PAYS.format(float(paid), float(rule.most))
    if not rule.facts.holds(found.last):
        wrong = [fact for fact in rule.facts.positive if fact not in found.last]
        wrong += [fact for fact in rule.facts.negative if fact in found.last]
        return wording.LEFT_CHANGED.format(", ".join(task.facts[fact] for fact in wrong))
    return None


def disturbs(task: Task, result: Result, original: Task, deadline: Deadline) -> str | None:
    """Whether a plan disturbs the human more than it may, in words (semantics 13)."""
    found = replay(task, result.plan or (), deadline, strict=result.options.strict)
    most, kinds = result.options.max_disturbance, disturbance_from(result.options.disturbance)
    if most is None or result.plan is None or found.fault is not None:
        return None
    seen, amount, started = surroundings(original), Fraction(0), {i for _, i in task.due}
    for epoch, chosen in found.sets.items():
        before = found.state_after(epoch - 1)
        here = {at for fact, (who, at) in seen.located.items() if fact in before and who == result.human}
        for i in chosen:
            action, begins = task.actions[i], i not in started
            doers = {task.agents[agent] for agent in action.participants}
            if result.human in doers:
                amount += kinds.ask if begins and len(doers) > 1 else 0
            elif task.script.people.isdisjoint(action.participants):
                changes = [fact for fact in (*action.add, *action.delete) if fact < len(original.facts)]
                named = [seen.located.get(f) for f in ((*action.pre, *action.add) if begins else action.add)]
                amount += kinds.sight * any(here & seen.parts[fact] for fact in changes)
                amount += kinds.meet * any(
                    at is not None and at[0] in doers and at[1] in here for at in named
                )
    return None if amount <= most else wording.DISTURBS.format(float(amount), float(most))


def rule_of(task: Task, options: Options, plan: HumanPlan | None, last: int, original: Task) -> Rule:
    """The rule beside a plan of the human's, or beside none.

    Args:
        task: in single epochs where it needs time.
        options: in force.
        plan: the human's, epoch by epoch.
        last: ``T``.
        original: the task as it was given.
    """
    state: State | None = task.init
    for epoch in range(last):
        chosen = (plan or ())[epoch : epoch + 1]
        state = None if state is None else onward(task, state, chosen, strict=options.strict)
    if state is None:
        return Rule(Condition(), None)
    chosen_ones = (action for i, action in enumerate(task.actions) if i not in task.of_bystanders)
    changed = {fact for action in chosen_ones for fact in (*action.add, *action.delete)}
    kept: Literals = {}
    everybody = nobody_pays(original, options)
    if everybody:
        kept |= _bystanders_need(task, state, len(original.agents))
    if options.leave_free is not None:
        free = [pattern.strip() for pattern in options.leave_free.split(",")]
        for fact, name in enumerate(original.facts):
            if not any(fnmatchcase(name, pattern) for pattern in free):
                kept[fact] = fact in state
    facts = Condition(
        tuple(sorted(fact for fact, true in kept.items() if true and fact in changed)),
        tuple(sorted(fact for fact, true in kept.items() if not true and fact in changed)),
    )
    return Rule(facts, task.cost_of(plan) if everybody and plan is not None else None)


def with_goals(task: Task, facts: Condition) -> Task:
    """The task with more goals of the robots'."""
    own = task.robot_goal
    positive, negative = {*own.positive, *facts.positive}, {*own.negative, *facts.negative}
    return task.with_goal(task.goal, Condition(tuple(sorted(positive)), tuple(sorted(negative))))


# -- bystanders


def _bystanders_need(task: Task, state: State, agents: int) -> Literals:
    """What they need of a state; those who are disturbed in it anyway need nothing."""
    rows, here = list[list[GroundAction]](), state
    while not is_calm(task, here):
        rows.append([task.actions[i] for i in met(task, here, ())])
        here = after(here, *rows[-1])
    found: Literals = {}
    goals = dict(task.own_goals)
    for agent in sorted(task.script.people):
        if agent < agents:
            needs = _needs(agent, goals.get(agent, Condition()), rows)
            if needs is not None and all((fact in state) is true for fact, true in needs.items()):
                found |= needs
    return found


def _needs(agent: int, goal: Condition, rows: Sequence[Sequence[GroundAction]]) -> Literals | None:
    """What one of them needs before epochs that go as planned; None: they are disturbed whatever holds."""
    last = max((k for k, row in enumerate(rows, start=1) if _own(agent, row)), default=0)
    needs: Literals | None = _literals(goal)
    for row in reversed(rows[:last]):
        for own in _own(agent, row):
            needs = None if needs is None else _before(needs, row, own)
        if not _own(agent, row):
            needs = None if needs is None else _before(needs, row, None)
    return needs


def _own(agent: int, row: Iterable[GroundAction]) -> list[GroundAction]:
    return [action for action in row if agent in action.participants]


def _literals(condition: Condition) -> Literals:
    return dict.fromkeys(condition.positive, True) | dict.fromkeys(condition.negative, False)


def _before(needs: Literals, row: Sequence[GroundAction], own: GroundAction | None) -> Literals | None:
    """What has to hold before an epoch for some things to hold after it, and for an action to be possible."""
    made: Literals = {}
    for last in (False, True):  # the script comes last
        now = [action for action in row if is_last(action) is last]
        made |= dict.fromkeys((fact for action in now for fact in action.delete), False)
        made |= dict.fromkeys((fact for action in now for fact in action.add), True)
    if any(made.get(fact, true) is not true for fact, true in needs.items()):
        return None
    before = {fact: true for fact, true in needs.items() if fact not in made}
    asked = {} if own is None else _literals(own.precondition)
    if any(before.get(fact, true) is not true for fact, true in asked.items()):
        return None
    return before | asked
