"""Policies of silent assistance as text: a plan with branches, a number for each state."""

from collections.abc import Iterator

from serendipity.model import Result, Task
from serendipity.model.numbers import plain


def totals_line(result: Result) -> str:
    """Both totals of semantics 7, and what the human pays alone."""
    unknown = result.status == "feasible" and result.human_plan is None  # what the human pays alone
    idle = result.plan is None and result.policy is not None and not result.policy.decisions
    pays = "pays at most" if unknown and idle else "pays"
    paid = ", ".join(f"{agent} {pays} {plain(cost)}" for agent, cost in result.agent_costs.items())
    mean = " on average" if result.options.ties == "expected" else ""
    alone = "" if result.human_cost is None else f"; alone {result.human} pays {plain(result.human_cost)}"
    return f"{paid}{mean}{alone}"


def policy_lines(task: Task, result: Result) -> Iterator[str]:
    """What the supporter does after each of the human's choices; nothing where one plan says it all."""
    if result.policy is None or result.plan is not None or not result.policy.decisions:
        return
    # Loaded only here: other answers have no branches.
    from verify.policy.branches import branches

    yield ""
    yield f"{task.agents[task.robots[0]]} starts at 1 and looks what {result.human} does:"
    for number, state in enumerate(branches(task, result), start=1):
        yield f"{number:>4}  {state.action}"
        for reply in state.replies:
            yield f"          {reply.action or 'waits'}: {_next(reply.then, ends=reply.ends)}"
    yield ""


def _next(number: int | None, *, ends: bool) -> str:
    if ends:
        return "the goal holds"
    return "no more help" if number is None else f"go on at {number}"
