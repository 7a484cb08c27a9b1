"""Answers as text for people: the plan in parallel columns, a column per agent."""

from collections.abc import Iterator
from dataclasses import fields
from fractions import Fraction
from typing import Final

from serendipity.cli.text.policy_text import policy_lines, totals_line
from serendipity.cli.text.render import Grid, Line, rendered
from serendipity.model import Certificate, Options, Result, Task
from serendipity.model.numbers import as_written, plain

_REASONS: Final = {
    "no-human-plan": "the human can't reach the goal alone, so there is no plan to preserve",
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
    parts: list[Line | Grid] = [Line(text) for text in _headlines(task, result)]
    if result.plan is not None and (result.plan or result.human_plan):
        parts += [Line(), _columns(task, result), Line()]
    parts += [Line(text) for text in policy_lines(task, result)]
    parts += [Line(text) for text in _closing(result)]
    parts += [_claims(certificate)] if claims else [_verdict(certificate)]
    return rendered(parts)


def certificate_report(certificate: Certificate) -> str:
    """The answer of ``verify``."""
    return rendered([_claims(certificate), Line(), _verdict(certificate)])


def _headlines(task: Task, result: Result) -> Iterator[str]:
    robots = ", ".join(task.agents[i] for i in task.robots)
    yield f"{task.name}: human {result.human}, robots {robots or 'none'}"
    yield f"{', '.join(_options(result.options))}: {_summary(result)}"
    if result.human_plan == ():
        yield f"{result.human}'s goal holds already, so there is nothing to help {result.human} with"
    if result.mode == "assistance" and result.agent_costs:
        yield totals_line(result)
    elif result.cost is not None and result.human_cost is not None:
        yield _costs(result.human_cost, result.cost, result.saving if result.opportunity else None)
    elif result.cost is not None:
        yield f"cost {plain(result.cost)}"
    if result.window is not None:
        last = result.window.end - 1
        epochs = f"epoch {last}" if len(result.window) == 1 else f"epochs {result.window.start} to {last}"
        who = result.human
        phases = f"before it {who} follows the former plan, after it {who} goes on alone"
        yield f"window: {epochs} (marked *); {phases}"


def _costs(before: float, after: float, saving: float | None) -> str:
    """The costs without and with help, with as many digits as tell them apart."""
    figures = plain(before), plain(after)
    if saving and figures[0] == figures[1]:
        figures = f"{before:.17g}", f"{after:.17g}"
    if saving and figures[0] == figures[1]:
        return f"cost {plain(before)}, saving {plain(saving)}"
    return f"cost {figures[0]} -> {figures[1]}{f', saving {plain(saving)}' if saving else ''}"


def _options(options: Options) -> Iterator[str]:
    """The mode, and every option that is not the default."""
    usual = Options()
    yield options.mode
    for option in fields(Options):
        value = getattr(options, option.name)
        if option.name != "mode" and value != getattr(usual, option.name):
            shown = plain(value) if isinstance(value, Fraction | float) else str(value)
            yield f"{option.name} {shown}"


def _summary(result: Result) -> str:
    if result.status == "infeasible":
        return f"infeasible (proved): {_REASONS.get(result.reason or '', result.reason or 'no plan')}"
    if result.status == "unknown":
        return f"{'interrupted' if result.reason == 'cancelled' else 'the limit came'} before any answer"
    proof = "proved to be the best" if result.status == "optimal" else _gap(result)
    if result.opportunity:
        return f"an opportunity, {proof}"
    if result.mode in ("serendipity", "communication"):
        return f"no opportunity, {proof}" if result.status == "feasible" else "no opportunity (proved)"
    return f"a plan, {proof}"


def _gap(result: Result) -> str:
    known = f": {_least_cost(result)}" if result.lower_bound else ""
    return f"not proved to be the best{known}"


def _least_cost(result: Result) -> str:
    """What the lower bound of an unproved answer means for costs: without the price of the window itself."""
    assert result.lower_bound is not None
    bound, weight = as_written(result.lower_bound), result.options.window_weight
    paid = "paid, announcements included" if result.options.communication_weight else "paid"
    if result.window is None or not result.options.windowed:
        return f"at least {plain(bound)} has to be {paid}"
    if weight <= (result.human_cost or 0):  # costs may outweigh windows: no figure without both
        return f"no less than {plain(bound)} is possible, with {plain(weight)} for each epoch of a window"
    epochs = max(1, min(int(bound / weight), len(result.window)))
    least = plain(max(bound - epochs * weight, Fraction(0)))
    if epochs == len(result.window):
        return f"at least {least} has to be {paid}"
    return f"in a window of {epochs} epoch{'s' if epochs > 1 else ''}, at least {least} has to be {paid}"


def _columns(task: Task, result: Result) -> Grid:
    """Epochs down, agents across; a joint action stands in each participant's column."""
    agents = [result.human, *(task.agents[i] for i in task.robots)]
    former = result.human_plan or ()
    steps = {(step.epoch, agent): step.action for step in result.plan or () for agent in step.agents}
    changed = tuple(step.action for step in result.plan or () if result.human in step.agents) != former
    inside = range(0) if result.window is None else range(result.window.start, result.window.end)
    epochs = range(1, max([epoch for epoch, _ in steps] + [len(former)]) + 1)
    rows = []
    for epoch in epochs:
        row = [f"{'* ' if epoch in inside else ''}{epoch}", *(steps.get((epoch, a), "") for a in agents)]
        if changed:
            row += former[epoch - 1 : epoch]
        rows.append(row)
    costs = ["cost", *(plain(result.agent_costs[a]) if a in result.agent_costs else "" for a in agents)]
    if changed and result.human_cost is not None:
        costs.append(plain(result.human_cost))
    header = ["epoch", *agents, *([f"{result.human}'s former plan"] if changed else [])]
    return Grid(header, [*rows, costs], frozenset(epoch - 1 for epoch in inside), numbered=True)


def _closing(result: Result) -> Iterator[str]:
    if result.saving_alone:
        yield f"{result.human} could save {plain(result.saving_alone)} alone: the given plan is not the best"
    elif _may_be_dear(result):
        yield f"{result.human} may have a cheaper plan alone: this one is not proved to be the best"
    if result.ties and result.optimal_plans is None:
        yield f"no other plan of the human's was looked at ({result.options.ties})"
    elif result.ties:
        helped = sum(tie.opportunity for tie in result.ties)
        many = f"{len(result.ties)} optimal plans of the human"
        yield f"{many}, an opportunity with {helped} ({result.options.ties})"
    for model, realised in sorted(result.realised.items()):
        article = "an" if model[0] in "aeiou" else "a"
        yield f"with {article} {model} human the plan {'works out' if realised else 'does not work out'}"
    elapsed, expanded = result.figure("elapsed_seconds"), result.figure("expanded")
    if elapsed is not None:
        yield f"planned in {_seconds(elapsed)}" + (f", {expanded} nodes expanded" if expanded else "")


def _may_be_dear(result: Result) -> bool:
    """Whether it is not known what the human could save alone, though nobody's goals stand against that."""
    compared = result.human_plan is not None and result.saving is not None and result.mode != "individual"
    return compared and result.status == "feasible" and result.saving_alone is None


def _verdict(certificate: Certificate) -> Line:
    wrong = certificate.refuted
    if wrong is not None:
        line, style = f"refuted, {wrong.claim}: {wrong.reason}", "bold red"
    elif certificate.verdict == "undecided":
        left = next((claim for claim in certificate.claims if claim.verdict == "undecided"), None)
        line = "has no answer to check" if left is None else f"undecided, {left.claim}: {left.reason}"
        style = "yellow"
    else:
        proved = [claim.claim for claim in certificate.claims if claim.verdict == "proved"]
        line, style = f"proves {', '.join(proved)}" if proved else "finds nothing wrong", "green"
    return Line(f"checker: {line} ({_seconds(certificate.elapsed_seconds)})", style)


def _claims(certificate: Certificate) -> Grid:
    rows = [
        (claim.claim, claim.verdict.replace("_", " "), _seconds(claim.seconds), claim.reason)
        for claim in certificate.claims
    ]
    return Grid(("claim", "verdict", "time", "reason"), rows)


def _seconds(seconds: float) -> str:
    return f"{seconds:.2f} s" if seconds >= 1 else f"{seconds * 1000:.1f} ms"
