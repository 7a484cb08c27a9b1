"""The answer of ``plan``: the result, and what the checker says of it."""

from serendipity.cli.text.policy_text import policy_lines
from serendipity.cli.text.render import rendered
from serendipity.model import Certificate, Result, Task
from serendipity.model.answers.certificate import claims_told, verdict_told
from serendipity.model.answers.result import closing, opening
from serendipity.model.telling import Grid, Line, team


def plan_report(task: Task, result: Result, certificate: Certificate, *, each_claim: bool = False) -> str:
    """The answer of ``plan``.

    Args:
        task: what was asked.
        result: what was answered.
        certificate: what the checker says of it.
        each_claim: show each claim of the certificate, not the verdict only.
    """
    robots = [task.agents[i] for i in task.robots]
    parts: list[Line | Grid] = [Line(f"{task.name}: {team(result.human, robots)}"), *opening(result, robots)]
    parts += [Line(text) for text in (*policy_lines(task, result), *closing(result))]
    return rendered([*parts, claims_told(certificate) if each_claim else verdict_told(certificate)])
