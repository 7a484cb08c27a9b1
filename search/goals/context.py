"""Tables for several candidate goals over one packing, so that robots' actions mean the same in all."""

from collections.abc import Sequence

from search.context import SearchContext
from search.goals.outcome import Candidate
from search.goals.timeline import GoalTimeline
from search.packed.cost_vector import Weights
from search.packed.packed_task import PackedTask, human_facts
from search.spaces.factory import suffix_rule
from serendipity.model.deadline import Deadline
from serendipity.model.options import Options
from serendipity.model.task import Task


class SharedContext(SearchContext):
    """Tables of one candidate whose packing is that of all candidates.

    Args:
        packed: packs what any candidate asks for.
        task: the task with the candidate as its goal.
        options: options in force.
        deadline: asked for time.
    """

    def __init__(self, packed: PackedTask, task: Task, options: Options, deadline: Deadline) -> None:
        self.task = task
        self.options = options
        self.deadline = deadline
        self.packed = packed.for_goal(task)
        self.weights = Weights(packed, options, None)
        self.keys = self.weights.keys


def shared_packing(
    task: Task, options: Options, candidates: Sequence[Candidate], deadline: Deadline
) -> PackedTask:
    """A packing of every fact that a candidate or its plan asks for."""
    asked: set[int] = set(human_facts(task)) if options.preservation == "state" else set()
    for candidate in candidates:
        asked.update(candidate.goal.positive, candidate.goal.negative)
        for action in (task.actions[i] for i in candidate.plan):
            asked.update(action.pre, action.neg)
    return PackedTask(task, frozenset(asked), deadline)


def timeline(context: SharedContext, candidate: Candidate, horizon: int) -> GoalTimeline:
    """The rules of semantics 3.1 for one candidate, under the options of its tables."""
    options = context.options
    return GoalTimeline(
        packed=context.packed,
        goal=context.packed.goal,
        steps=context.followed(candidate.plan),
        suffix=suffix_rule(context, candidate.plan),
        private=context.bound,
        keys=context.keys,
        horizon=horizon,
        max_window=options.max_window or horizon,
        per_start=options.preservation == "state",
        strict=options.strict,
        deadline=context.deadline,
    )


def task_for(task: Task, candidate: Candidate) -> Task:
    """The task in which the candidate is the human's goal."""
    return task.with_goal(candidate.goal)
