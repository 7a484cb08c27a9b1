"""Answers as text for people: the plan in parallel columns, a column per agent."""

import io
import math
import shutil
import sys
from collections.abc import Iterable
from dataclasses import fields
from fractions import Fraction
from typing import Final

from rich.console import Console, RenderableType
from rich.table import Table
from rich.text import Text

from serendipity.model import Certificate, Options, Result, Task

_WIDE: Final = 1000
"""Columns where the output is not a terminal: nothing is folded."""

_REASONS: Final = {
    "no-human-plan": "the human can't reach his goal alone, so there is no plan to preserve",
    "no-plan": "no plan reaches the goals within the horizon",
}
"""What the commonest reasons of an infeasible result mean."""


def plan_report(task: Task, result: Result, certificate: Certificate, *, claims: bool = False) -> str:
    """The answer of ``plan``.

    Args:
        task: what was asked.
        result: what was answered.
        certificate: what the checker says of it.
        claims: show each claim of the certificate, not the verdict only.
    """
    parts: list[RenderableType] = [Text(line) for line in _headlines(task, result)]
    if result.plan is not None and (result.plan or result.human_plan):
        parts += ["", _columns(task, result), ""]
    parts += [Text(line) for line in _closing(result)]
    parts += [_claims(certificate)] if claims else [_verdict(certificate)]
    return _rendered(parts)


def certificate_report(certificate: Certificate) -> str:
    """The answer of ``verify``."""
    return _rendered([_claims(certificate), "", _verdict(certificate)])


def number(value: float) -> str:
    """A cost as people write it: ``13``, ``12.6``."""
    return f"{value:.10g}"


def _headlines(task: Task, result: Result) -> Iterable[str]:
    robots = ", ".join(task.agents[i] for i in task.robots)
    yield f"{task.name}: human {result.human}, robots {robots or 'none'}"
    yield f"{', '.join(_options(result.options))}: {_summary(result)}"
    if result.cost is not None and result.human_cost is not None:
        saving = f", saving {number(result.saving)}" if result.opportunity and result.saving else ""
        yield f"cost {number(result.human_cost)} -> {number(result.cost)}{saving}"
    elif result.cost is not None:
        yield f"cost {number(result.cost)}"
    if result.window is not None:
        last = result.window.end - 1
        epochs = f"epoch {last}" if len(result.window) == 1 else f"epochs {result.window.start} to {last}"
        yield f"window: {epochs} (marked *); before it he follows his former plan, after it he goes on alone"


def _options(options: Options) -> Iterable[str]:
    """The mode, and every option that is not the default."""
    usual = Options()
    yield options.mode
    for option in fields(Options):
        value = getattr(options, option.name)
        if option.name != "mode" and value != getattr(usual, option.name):
            shown = number(float(value)) if isinstance(value, Fraction) else str(value)
            yield f"{option.name} {shown}"


def _summary(result: Result) -> str:
    if result.status == "infeasible":
        return f"infeasible (proved): {_REASONS.get(result.reason or '', result.reason or 'no plan')}"
    if result.status == "unknown":
        return "the limit came before any answer"
    proof = "proved to be the best" if result.status == "optimal" else _gap(result)
    if result.opportunity:
        return f"an opportunity, {proof}"
    if result.mode in ("serendipity", "communication"):
        return f"no opportunity, {proof}" if result.status == "feasible" else "no opportunity (proved)"
    return f"a plan, {proof}"


def _gap(result: Result) -> str:
    bound = "" if result.lower_bound is None else f": no better than {number(result.lower_bound)} is possible"
    return f"the limit came before the proof{bound}"


def _columns(task: Task, result: Result) -> Table:
    """Epochs down, agents across; a joint action stands in each participant's column."""
    agents = [result.human, *(task.agents[i] for i in task.robots)]
    former = result.human_plan or ()
    steps = {(step.epoch, agent): step.action for step in result.plan or () for agent in step.agents}
    changed = tuple(step.action for step in result.plan or () if result.human in step.agents) != former
    table = Table(box=None, pad_edge=False, padding=(0, 3, 0, 0), header_style="bold")
    table.add_column("epoch", justify="right")
    for heading in agents:
        table.add_column(heading)
    if changed:
        table.add_column(f"{result.human}'s former plan", style="dim")
    last = max([epoch for epoch, _ in steps] + [len(former)])
    for epoch in range(1, last + 1):
        inside = result.window is not None and result.window.start <= epoch < result.window.end
        row = [f"{'* ' if inside else ''}{epoch}", *(steps.get((epoch, agent), "") for agent in agents)]
        if changed:
            row.append(former[epoch - 1] if epoch <= len(former) else "")
        table.add_row(*(Text(cell) for cell in row), style="bold" if inside else None)
    costs = [number(result.agent_costs[agent]) if agent in result.agent_costs else "" for agent in agents]
    if changed and result.human_cost is not None:
        costs.append(number(result.human_cost))
    table.add_row("cost", *costs)
    return table


def _closing(result: Result) -> Iterable[str]:
    if result.saving_alone:
        yield f"he could save {number(result.saving_alone)} alone: the given human plan is not his best"
    ties = result.statistics.get("ties")
    if ties:
        helped = sum(bool(tie["opportunity"]) for tie in ties)
        yield f"{len(ties)} optimal plans of the human, an opportunity with {helped} ({result.options.ties})"
    for model, realised in sorted(result.realised.items()):
        yield f"with an {model} human the plan {'works out' if realised else 'does not work out'}"
    elapsed = result.statistics.get("elapsed_seconds")
    if isinstance(elapsed, int | float) and math.isfinite(elapsed):
        expanded = result.statistics.get("expanded")
        yield f"planned in {_seconds(elapsed)}" + (f", {expanded} nodes expanded" if expanded else "")


def _verdict(certificate: Certificate) -> Text:
    wrong = certificate.refuted
    if wrong is not None:
        line, style = f"refuted, {wrong.claim}: {wrong.reason}", "bold red"
    elif certificate.verdict == "undecided":
        line, style = "undecided within the limit", "yellow"
    else:
        line, style = "holds", "green"
    return Text(f"checker: {line} ({_seconds(certificate.elapsed_seconds)})", style=style)


def _claims(certificate: Certificate) -> Table:
    table = Table(box=None, pad_edge=False, padding=(0, 3, 0, 0), header_style="bold")
    for heading in ("claim", "verdict", "time", "reason"):
        table.add_column(heading)
    for claim in certificate.claims:
        cells = (claim.claim, claim.verdict.replace("_", " "), _seconds(claim.seconds), claim.reason)
        table.add_row(*(Text(cell) for cell in cells))
    return table


def _seconds(seconds: float) -> str:
    return f"{seconds:.2f} s" if seconds >= 1 else f"{seconds * 1000:.1f} ms"


def _rendered(parts: Iterable[RenderableType]) -> str:
    terminal = sys.stdout.isatty()
    width = shutil.get_terminal_size().columns if terminal else _WIDE
    console = Console(file=io.StringIO(), width=width, force_terminal=terminal, highlight=False)
    with console.capture() as captured:
        for part in parts:
            console.print(part)
    lines = captured.get().splitlines()
    return "\n".join(line.rstrip() for line in lines) + "\n"
