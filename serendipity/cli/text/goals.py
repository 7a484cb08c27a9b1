"""Options and texts where the human's goal is not known (semantics 8)."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from serendipity.model import Result, Window
from serendipity.model.numbers import plain

if TYPE_CHECKING:
    from serendipity.cli.text.render import Grid, Line
    from serendipity.recognition import Recognition

Goals = Annotated[
    Path | None,
    typer.Option(
        "--goals",
        metavar="FILE",
        help="Goals that the human may have: JSON, or 'prior: fact, fact' on each line.",
    ),
]
Observed = Annotated[
    Path | None,
    typer.Option("--observed", metavar="FILE", help="What the human has done so far, an action a line."),
]
Beta = Annotated[
    str | None,
    typer.Option("--beta", metavar="B", help="How strictly the human saves cost; 0 and more. [default: 1]"),
]

_UNEXPLAINED: Final = "no goal explains what was observed: the posterior is the prior"


def recognition_text(recognition: "Recognition") -> "Iterator[Line | Grid]":
    """The posterior as a table, and a line that says if it is only the prior."""
    from serendipity.cli.text.render import Grid, Line

    if not recognition.explained:
        yield Line(_UNEXPLAINED)
    best = recognition.most_likely
    yield Line(f"the most likely goal of {recognition.human} is {best.name} ({best.posterior:.4g})")
    yield Line()
    header = ("posterior", "prior", "with observed", "without", "goal")
    rows = [
        (
            f"{goal.posterior:.4f}",
            f"{float(goal.prior):.4f}",
            plain(goal.with_observed),
            plain(goal.without_observed),
            goal.name,
        )
        for goal in recognition.goals
    ]
    yield Grid(header, rows, frozenset({recognition.goals.index(best)}), numbered=True)


def plan_text(result: Result) -> "Iterator[Line | Grid]":
    """The robots' plan, and what happens for each goal that is considered."""
    from serendipity.cli.text.render import Grid, Line

    if result.status == "unknown":
        yield Line("the limit came before any answer")
        return
    entries = result.goals or ()
    if result.recognition is not None and not result.recognition.explained:
        yield Line(_UNEXPLAINED)
    if result.cost is None:
        why = result.reason or result.status
        yield Line(f"no plan: {result.human} can reach none of the goals alone ({why})")
        return
    weight = plain(result.options.window_weight)
    gap = f"not proved; at least {plain(result.lower_bound)}, with {weight} for each epoch of a window"
    proof = "proved" if result.status == "optimal" else gap
    if not result.opportunity:
        yield Line(f"the robots leave {result.human} alone: expected cost {plain(result.cost)} ({proof})")
    else:
        saving = f"{plain(result.saving)} less than {plain(result.human_cost)}"
        yield Line(f"expected cost {plain(result.cost)}, {saving} ({proof})")
    yield Line()
    header = ("probability", "cost", "window", "goal")
    rows = [
        (f"{entry.probability:.4f}", plain(entry.cost), _window(entry.window), entry.name)
        for entry in entries
    ]
    yield Grid(header, rows, numbered=True)
    if result.plan:
        yield Line()
        who = "everybody does" if len(entries) == 1 else "whatever the goal is, robots do"
        yield Line(f"{who}:")
        steps = [(str(step.epoch), ", ".join(step.agents), step.action) for step in result.plan]
        yield Grid(("epoch", "agents", "action"), steps, numbered=True)


def _window(window: Window | None) -> str:
    return "-" if window is None else f"[{window.start}, {window.end})"
