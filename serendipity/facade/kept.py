"""What help has to leave as it would be without it (semantics 12)."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import NamedTuple

from serendipity.facade.call import Request
from serendipity.model import Condition, HumanPlan, Options, Step, Task
from serendipity.model.answers.answer import Answer, ServedGoal
from serendipity.model.numbers import total
from serendipity.model.task.course import BrokenPlanError, PlayedPlan
from serendipity.model.task.gate import nobody_pays
from serendipity.model.task.leftovers import leftovers
from serendipity.model.task.single_epochs import after, due, epochs

Literal = tuple[int, bool]
"""A fact, and whether it is to be true."""

_Literals = set[Literal]


class Kept(NamedTuple):
    """What has to be as it would be without help.

    Attributes:
        facts: of the last state.
        most: that the human may pay; None: anything.
        prices: of literals that may be left otherwise, in the order of the facts.
    """

    facts: Condition
    most: Fraction | None
    prices: tuple[tuple[Literal, Fraction], ...] = ()


def is_kept(task: Task, rule: Kept, answer: Answer | ServedGoal, last: int | None = None) -> bool:
    """Whether what happens in an answer, or in one of its scenarios, keeps the rule; ``last`` is ``T``."""
    steps = answer.steps or ()
    if last is None:
        assert isinstance(answer, Answer)
        last = int(answer.horizon or 0)
    if rule.most is not None and paid(task, steps) > rule.most:
        return False
    return rule.facts.holds(_played(task, steps, last))


def left(call: Request, rule: Kept, answer: Answer) -> list[tuple[Literal, Fraction]]:
    """What an answer leaves that is priced, the dearest first."""
    return left_by(call.task, rule, answer.steps or (), int(answer.horizon or 0))


def left_by(task: Task, rule: Kept, steps: Sequence[Step], last: int) -> list[tuple[Literal, Fraction]]:
    """The same of what happens until ``T``, the last epoch."""
    if not rule.prices:
        return []
    state = _played(task, steps, last)
    found = [(literal, price) for literal, price in rule.prices if (literal[0] in state) is not literal[1]]
    return sorted(found, key=lambda one: -one[1])


def paid(task: Task, steps: Iterable[Step]) -> Fraction:
    """What the human pays in a plan."""
    actions = (task.actions[step.action] for step in steps)
    return total(action.cost for action in actions if task.human in action.participants)


def happening_costs(task: Task, steps: Iterable[Step], last: int, discount: Fraction) -> Fraction:
    """What the team pays until an epoch, also for what goes on and is not among the steps."""
    happening = (action for _, actions in epochs(task, steps, last) for action in actions)
    return total(task.team_cost(action, discount) for action in happening)


def kept_by(call: Request, answer: Answer) -> Kept:
    """What an answer has to keep."""
    last = int(answer.horizon or 0)
    return kept(call.task, call.options, answer.human_plan, last, call.original or call.task)


def kept(task: Task, options: Options, plan: HumanPlan | None, last: int, original: Task) -> Kept:
    """What a plan of the human's and ``T`` ask of everybody else (semantics 12).

    Args:
        task: in single epochs.
        plan: of the human, or None without one.
        last: ``T``.
        original: the task as it was given.
    """
    if plan is None and _is_broken(original, last, strict=options.strict):
        return Kept(Condition(), None)
    state = _played(task, [Step(epoch, action) for epoch, action in enumerate(plan or (), start=1)], last)
    literals: _Literals = set()
    everybody = nobody_pays(original, options)
    if everybody:
        literals |= _undisturbed(task, state)
    prices: list[tuple[Literal, Fraction]] = []
    rest = leftovers(options)
    for fact in sorted(f for f in task.unsettled if rest is not None and f < len(original.facts)):
        price = None if rest is None else rest.price(task.facts[fact])
        if price is None:
            literals.add((fact, fact in state))
        elif price:
            prices.append(((fact, fact in state), price))
    most = task.cost_of(plan) if everybody and plan is not None else None
    facts = _condition((fact, true) for fact, true in literals if fact in task.unsettled)
    return Kept(facts, most, tuple(prices))


def _is_broken(task: Task, last: int, *, strict: bool) -> bool:
    """Whether bystanders are disturbed by ``T`` where nobody else does anything."""
    course = PlayedPlan(task.facts, task.init, task.script, strict=strict)
    try:
        while course.epoch < last:
            if not course.rest(last):
                course.begin([])
    except BrokenPlanError:
        return True
    return False


def _condition(literals: Iterable[tuple[int, bool]]) -> Condition:
    told = sorted(literals)
    return Condition(tuple(f for f, true in told if true), tuple(f for f, true in told if not true))


def with_goals(task: Task, facts: Condition, literals: Iterable[Literal] = ()) -> Task:
    """The task with more goals of the robots'."""
    return task.with_goal(
        task.goal, with_literals(with_literals(task.robot_goal, literals), _literals(facts))
    )


def with_literals(condition: Condition, literals: Iterable[Literal]) -> Condition:
    """A condition that asks for more."""
    return _condition(_literals(condition) | {*literals})


def _literals(condition: Condition) -> _Literals:
    return {*((fact, True) for fact in condition.positive), *((fact, False) for fact in condition.negative)}


def _played(task: Task, steps: Iterable[Step], last: int) -> frozenset[int]:
    """The state after an epoch if these things are done, and what goes on by itself."""
    state = task.init
    for before, actions in epochs(task, steps, last):
        state = after(task, before, actions)
    return state


def _undisturbed(task: Task, state: frozenset[int]) -> _Literals:
    """What the bystanders ask of a state for the rest of their plans and their goals (a triangle table).

    Those whom it does not serve ask for nothing.
    """
    people, goals = task.script.people, dict(task.own_goals)
    asked: dict[int, _Literals] = {agent: set() for agent in people}
    disturbed: set[int] = set()
    touched: set[int] = set()

    def ask(condition: Condition) -> _Literals | None:
        """The literals of a condition that nothing has changed since; None where it does not hold."""
        literals = _literals(condition)
        return {one for one in literals if one[0] not in touched} if condition.holds(state) else None

    ends = {agent: ask(goals.get(agent, Condition())) for agent in people}
    while going := due(task, state):
        own = [(agent, one) for one in going for agent in one.participants if agent in people]
        for agent, action in own:
            needed = ask(action.precondition)
            if needed is None:
                disturbed.add(agent)
            asked[agent] |= needed or set()
        state = after(task, state, going)
        touched.update(fact for one in going for fact in (*one.add, *one.delete))
        for agent, _ in own:
            ends[agent] = ask(goals.get(agent, Condition()))
    found: _Literals = set()
    for agent, needed in ends.items():
        if needed is not None and agent not in disturbed:
            found |= asked[agent] | needed
    return found
