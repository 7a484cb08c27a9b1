"""What a step means (semantics 1, 2), in the verifier's own words: names, states, epochs, shares of a cost.

The model says the same for the planner; an error there must not hide here.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TypeVar

from serendipity.model import Deadline, GroundAction, PlanStep, Step, Task
from serendipity.model.numbers import figure
from serendipity.model.task.unit_steps import CLOCK, RESTING, WAITING

State = frozenset[int]
"""The facts that are true."""

K = TypeVar("K")
V = TypeVar("V")


# -- from a name to an action, and back


def meant_by(task: Task, name: str, agents: Iterable[str]) -> list[int]:
    """The actions of a name that these agents do, ascending: variants of one PDDL action."""
    wanted = sorted(agents)
    return [i for i in task.named.get(name, ()) if participants(task, i) == wanted]


def participants(task: Task, action: int) -> list[str]:
    """Names of an action's agents, sorted."""
    return sorted(task.agents[i] for i in task.actions[action].participants)


def plan_step(task: Task, step: Step, discount: Fraction) -> PlanStep:
    """A step as results write it: with names, and with what it costs the team."""
    action = task.actions[step.action]
    agents = tuple(task.agents[i] for i in action.participants)
    return PlanStep(step.epoch, agents, action.name, figure(price(task, action, discount)))


# -- what happens in an epoch


def applicable(action: GroundAction, state: State) -> bool:
    """Whether every precondition holds (eq. 4)."""
    return state.issuperset(action.pre) and state.isdisjoint(action.neg)


def is_last(action: GroundAction) -> bool:
    """Whether an action is the script's own: it takes effect last, in nobody's way (semantics 10.3)."""
    return action.name.startswith(CLOCK)


def after(state: State, *actions: GroundAction) -> State:
    """The state after an epoch in which these actions take place: all deletes, then all adds."""
    state = state.difference(*(a.delete for a in actions)).union(*(a.add for a in actions))
    for action in actions:
        if is_last(action):
            state = state.difference(action.delete).union(action.add)
    return state


def clash(a: GroundAction, b: GroundAction, *, strict: bool) -> int | None:
    """A fact over which two actions conflict (eq. 5, 6), or None; ``strict`` as in semantics 2."""
    clashes = set(a.delete) & set(b.delete) | set(a.delete) & set(b.add) | set(a.add) & set(b.delete)
    if strict:
        clashes |= set(a.delete) & set(b.pre) | set(a.add) & set(b.neg)
        clashes |= set(b.delete) & set(a.pre) | set(b.add) & set(a.neg)
    return None if clashes and (is_last(a) or is_last(b)) else min(clashes, default=None)


def conflicting(a: GroundAction, b: GroundAction, *, strict: bool) -> bool:
    """Whether two actions can't share an epoch: an agent takes part in both (eq. 10), or they clash."""
    return not set(a.participants).isdisjoint(b.participants) or clash(a, b, strict=strict) is not None


def fits(action: GroundAction, others: Iterable[GroundAction], *, strict: bool) -> bool:
    """Whether an action can share an epoch with each of the others."""
    for other in others:  # noqa: SIM110 - a third faster than any()
        if conflicting(action, other, strict=strict):
            return False
    return True


def due(task: Task, state: State) -> list[tuple[int, ...]]:
    """What happens in the next epoch, whatever is chosen (semantics 10): of each of these variants one."""
    return [variants for fact in sorted(state & task.due_for.keys()) for variants in task.due_for[fact]]


def is_calm(task: Task, state: State) -> bool:
    """Whether nothing happens from a state on unless somebody does it."""
    return task.due_for.keys().isdisjoint(state)


def idling(task: Task) -> frozenset[int]:
    """The human's waiting as actions, where the task takes place in time (semantics 10.2)."""
    return frozenset((*task.named.get(WAITING, ()), *task.named.get(RESTING, ())))


def unchosen(task: Task) -> frozenset[int]:
    """What nobody begins: what is due, and waiting."""
    return idling(task).union(i for _, i in task.due)


def awake(task: Task) -> frozenset[int]:
    """The fact, if there is one, while which the human does not wait for nothing, since waiting costs."""
    return frozenset(fact for i in task.named.get(RESTING, ()) for fact in task.actions[i].delete)


def met(task: Task, state: State, chosen: Iterable[int]) -> tuple[int, ...]:
    """Actions, and what is due besides them: of variants the first that is applicable, or else the first."""
    found = [*chosen]
    done = set(found)
    for variants in due(task, state):
        if done.isdisjoint(variants):
            found.append(next((i for i in variants if applicable(task.actions[i], state)), variants[0]))
    return tuple(found)


def executed(state: State, actions: Sequence[GroundAction], *, strict: bool) -> State | None:
    """The state after an epoch; None if an action is not applicable, or two of them can't share it."""
    if not all(applicable(action, state) for action in actions):
        return None
    if not all(fits(action, actions[:k], strict=strict) for k, action in enumerate(actions)):
        return None
    return after(state, *actions)


def sets_beside(
    task: Task, chosen: tuple[int, ...], candidates: Sequence[int], deadline: Deadline, *, strict: bool
) -> Iterator[tuple[int, ...]]:
    """What is chosen, then with each set of candidates that can share its epoch put after it."""
    yield chosen
    beside = [task.actions[i] for i in chosen]
    for k, i in enumerate(deadline.each(candidates)):
        if fits(task.actions[i], beside, strict=strict):
            yield from sets_beside(task, (*chosen, i), candidates[k + 1 :], deadline, strict=strict)


# -- plans


def grouped(pairs: Iterable[tuple[K, V]]) -> dict[K, list[V]]:
    """What belongs to each key, in order: the actions of an epoch, say."""
    found: dict[K, list[V]] = {}
    for key, value in pairs:
        found.setdefault(key, []).append(value)
    return found


def states_along(task: Task, epochs: Iterable[Sequence[int]], *, strict: bool) -> list[State] | None:
    """States ``s_0 .. s_T``, by what takes place in each epoch; None if one can't, or lacks what is due."""
    states = [task.init]
    for chosen in epochs:
        if any(set(variants).isdisjoint(chosen) for variants in due(task, states[-1])):
            return None
        state = executed(states[-1], [task.actions[i] for i in chosen], strict=strict)
        if state is None:
            return None
        states.append(state)
    return states


def states_of_pi_h(task: Task, plan: Iterable[int], deadline: Deadline) -> list[State]:
    """``delta(I, pi_H[1..j])`` for each j from 0: the states that an executable human plan leads through."""
    states = [task.init]
    for i in deadline.each(plan):
        beside = met(task, states[-1], (i,)) if task.of_bystanders else (i,)
        states.append(after(states[-1], *(task.actions[k] for k in beside)))
    return states


def facts_of_his(task: Task, deadline: Deadline) -> State:
    """The facts that the human's own domain mentions: their goal's and their own actions'."""
    facts = {*task.goal.positive, *task.goal.negative}
    for i in deadline.each(task.human_actions):
        action = task.actions[i]
        facts.update(action.pre, action.neg, action.add, action.delete)
    return frozenset(facts) - awake(task)


# -- costs


def price(task: Task, action: GroundAction, discount: Fraction) -> Fraction:
    """Cost to the team: undiscounted if the human takes part (semantics 1)."""
    return action.cost if task.human in action.participants else action.cost * (1 - discount)


def shares(task: Task, actions: Iterable[int], discount: Fraction) -> Mapping[str, Fraction]:
    """What each agent pays, by name: a joint action's cost is shared equally among its participants."""
    paid = dict.fromkeys(task.agents, Fraction(0))
    for i in actions:
        action = task.actions[i]
        for agent in action.participants:
            paid[task.agents[agent]] += price(task, action, discount) / len(action.participants)
    return paid
