"""Share of the promised help that happens with people who replan, over a folder of tasks.

    python -m benchmarks.realisation FOLDER [--human NAME] [--discounts 0,0.5,0.9] [--limit N]

For each discount, summed over the tasks: which of the paper's answers (serendipity, defaults) help, which
of those an observant and a local human make happen, after which they miss their goal, what is saved in
the end, and how much can be saved by planning for such a human in the first place; what becomes of help
in communication mode that is not announced; and milliseconds of the planning calls (median, 95 %, longest).
"""

from collections import defaultdict
from pathlib import Path
from typing import Any

import typer

import serendipity
from serendipity import Result, Task
from serendipity.evaluation.measuring.figures import milliseconds, timed
from serendipity.evaluation.measuring.suites import folders
from serendipity.evaluation.measuring.tables import as_markdown
from serendipity.facade.simulation import HUMAN_MODELS
from serendipity.model.telling import Grid

Figures = defaultdict[str, list[float]]
"""Figures of each task, by name."""


def main(
    folder: Path,
    human: str | None = None,
    discounts: str = "0,0.1,0.3,0.5,0.7,0.9",
    limit: int | None = None,
) -> None:
    """Measure and print a table, a column for each discount."""
    found: dict[str, Figures] = {discount: defaultdict(list) for discount in discounts.split(",")}
    for place in folders(folder, limit=limit):
        task = serendipity.load(place, human=human)
        for discount, figures in found.items():
            _measure(task, discount, figures)
    names = dict.fromkeys(name for figures in found.values() for name in figures)
    rows = [[name, *(_shown(name, figures[name]) for figures in found.values())] for name in names]
    print(as_markdown([Grid(["", *found], rows)]), end="")


def _measure(task: Task, discount: str, figures: Figures) -> None:
    paper = _planned(task, discount, "omniscient", figures)
    told = serendipity.plan(task, mode="communication", discount=discount)
    figures["helped unannounced"].append(told.opportunity)
    for model in HUMAN_MODELS:
        _planned(task, discount, model, figures)
        trace = serendipity.simulate(task, paper, model)
        figures[f"paper's plan realised, {model}"].append(paper.opportunity and trace.realised)
        figures[f"paper's plan misses the goal, {model}"].append(paper.opportunity and not trace.goals_hold)
        saved = (paper.human_cost or 0) - trace.cost if paper.opportunity and trace.goals_hold else 0
        figures[f"paper's plan saves, {model}"].append(saved)
        happens = told.opportunity and serendipity.simulate(task, told, model).realised
        figures[f"unannounced realised, {model}"].append(happens)


def _planned(task: Task, discount: str, model: Any, figures: Figures) -> Result:
    """The answer for such a human."""
    result, seconds = timed(lambda: serendipity.plan(task, discount=discount, human_model=model))
    assert result.status == "optimal"
    figures[f"helped, {model}"].append(result.opportunity)
    figures[f"planned for, {model}"].append(result.saving or 0)
    figures[f"ms of a call, {model}"].append(seconds)
    return result


def _shown(name: str, found: list[float]) -> str:
    return milliseconds(found) if name.startswith("ms") else f"{sum(found):.10g}"


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
