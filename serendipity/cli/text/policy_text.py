"""Policies of silent assistance as text: a plan with branches, a number for each state."""

from collections.abc import Iterator

from serendipity.model import Result, Task


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
