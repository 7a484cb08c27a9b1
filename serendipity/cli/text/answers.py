"""The answer of ``plan`` as text: the result, what the checker says of it, and what came of strategies."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from serendipity.cli.text.render import rendered
from serendipity.model import Certificate, Result, Task
from serendipity.model.answers.certificate import claims_told, verdict_told
from serendipity.model.answers.result import closing, opening
from serendipity.model.numbers import plain
from serendipity.model.telling import Grid, Line, as_text, team


def plan_report(task: Task, result: Result, certificate: Certificate, *, each_claim: bool = False) -> str:
    """The answer of ``plan``, with ``each_claim`` of the certificate or its verdict only."""
    robots = [task.agents[i] for i in task.robots]
    parts: list[Line | Grid] = [Line(f"{task.name}: {team(result.human, robots)}"), *opening(result, robots)]
    parts += [Line(text) for text in (*policy_lines(task, result), *closing(result))]
    return rendered([*parts, claims_told(certificate) if each_claim else verdict_told(certificate)])


def policy_lines(task: Task, result: Result) -> Iterator[str]:
    """What the supporter does after each of the human's choices; nothing where one plan says it all."""
    if result.policy is None or result.plan is not None or not result.policy.decisions:
        return
    # Loaded only here: other answers have no branches.
    from serendipity.cli.text.branches import branches

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


def table_of(tried: Sequence[Mapping[str, Any]]) -> str:
    """What came of each turn that the strategies of a search had: ``result.statistics["strategies"]``.

    Args:
        tried: ``name``, ``seconds``, ``better`` (how many better answers came of it), ``bound`` (that it
            proved, or None), and whether it ``settled`` the answer.
    """
    rows = [
        [
            row["name"],
            f"{row['seconds']:.3f}",
            f"{row['better'] or ''}",
            "" if row["bound"] is None else plain(row["bound"]),
            "yes" if row["settled"] else "",
        ]
        for row in tried
    ]
    return as_text([Grid(["turn", "seconds", "better answers", "bound", "settled"], rows)])
