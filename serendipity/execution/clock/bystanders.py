"""Whether robots would have bystanders pay for what they begin, in time (semantics 12)."""

from collections.abc import Iterable, Mapping, Sequence

from serendipity.facade.person.ways import Way, begun_in
from serendipity.model import Condition, PlanStep, Task
from serendipity.model.task.course import BrokenPlanError, PlayedPlan
from serendipity.model.task.execution import variant_named

_Begun = Mapping[int, Sequence[tuple[str, Sequence[str]]]]
"""By epoch names of actions that begin in it, and who takes part."""


def would_pay(now: Task, plan: Sequence[PlanStep], alone: Way | None, *, strict: bool) -> bool:
    """Whether by a plan somebody can't do or get what they would with idle robots.

    Args:
        now: the task as it stands.
        plan: of everybody but bystanders.
        alone: what the person does with idle robots.
    """
    if not now.script.people:
        return False
    human = (now.agents[now.human],)
    helped = _by_epoch((step.epoch, (step.action, step.agents)) for step in plan)
    entries = () if alone is None else alone.plan
    idle = _by_epoch((epoch, (name, human)) for epoch, name in begun_in(entries))
    ends = (epoch + _epochs(now, name) - 1 for epoch, name in entries)
    last = max((*ends, *(step.end for step in plan)), default=0)
    return not _served(now, idle, last, strict=strict) <= _served(now, helped, last, strict=strict)


def _epochs(now: Task, name: str) -> int:
    """How long an action goes on; a last ``noop`` is an epoch."""
    return max((now.actions[i].duration for i in now.named.get(name, ())), default=1)


def _by_epoch(steps: Iterable[tuple[int, tuple[str, Sequence[str]]]]) -> _Begun:
    found: dict[int, list[tuple[str, Sequence[str]]]] = {}
    for epoch, step in steps:
        found.setdefault(epoch, []).append(step)
    return found


def _served(now: Task, begun: _Begun, last: int, *, strict: bool) -> frozenset[int]:
    """The bystanders who have what they want in the end; none where one can't do what they planned."""
    course, goals = PlayedPlan(now.facts, now.init, now.script, strict=strict), dict(now.own_goals)
    ends = dict.fromkeys(now.script.people, last)
    for deed in now.script.deeds:
        if deed.agent in ends:
            ends[deed.agent] = max(ends[deed.agent], deed.end)
    events, served = sorted({*begun, *ends.values()}), set[int]()
    try:
        while True:
            met = {who for who in ends if goals.get(who, Condition()).holds(course.state)}
            served |= {who for who in met if ends[who] == course.epoch}
            coming = next((epoch for epoch in events if epoch > course.epoch), None)
            if coming is None:
                return frozenset(served)
            if not course.rest(coming - 1):
                steps = begun.get(course.epoch + 1, ())
                ids = [variant_named(now, name, who, course.state) for name, who in steps]
                course.begin([now.actions[i] for i in ids])
    except BrokenPlanError:
        return frozenset()
