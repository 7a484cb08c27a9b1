"""How much of the promised help happens with people who replan, over a folder of tasks.

    python benchmarks/realisation.py FOLDER [--human NAME] [--discounts 0,0.5,0.9] [--limit N] [--certify]

For each discount: which of the paper's answers (serendipity, defaults) an observant and a local
human make happen, what the rest of them cost then, and how much can be saved by planning for such
a human in the first place.  Prints tables in Markdown, and the time of the planning calls; with
``--certify`` also how many of the answers for such humans are certified, and the processor time.
"""

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter, process_time

import serendipity
from serendipity import Result, Task
from serendipity.facade.simulation import HUMAN_MODELS

DISCOUNTS = "0,0.1,0.3,0.5,0.7,0.9"
PLANNED = ("omniscient", *HUMAN_MODELS)


@dataclass
class Tally:
    """What one discount adds up to; costs and savings are sums over tasks."""

    tasks: int = 0
    helped: dict[str, int] = field(default_factory=lambda: dict.fromkeys(PLANNED, 0))
    saved: dict[str, float] = field(default_factory=lambda: dict.fromkeys(PLANNED, 0.0))
    realised: dict[str, int] = field(default_factory=lambda: dict.fromkeys(HUMAN_MODELS, 0))
    announced: int = 0
    unannounced: dict[str, int] = field(default_factory=lambda: dict.fromkeys(HUMAN_MODELS, 0))
    stranded: dict[str, int] = field(default_factory=lambda: dict.fromkeys(HUMAN_MODELS, 0))
    turned_out: dict[str, float] = field(default_factory=lambda: dict.fromkeys(HUMAN_MODELS, 0.0))
    seconds: dict[str, list[float]] = field(default_factory=lambda: {model: [] for model in PLANNED})
    proved: dict[str, int] = field(default_factory=lambda: dict.fromkeys(HUMAN_MODELS, 0))
    proving: dict[str, list[float]] = field(default_factory=lambda: {model: [] for model in HUMAN_MODELS})

    def add(self, task: Task, discount: str, *, certify: bool) -> None:
        """Plan for each human, and play the paper's answers against those who replan."""
        self.tasks += 1
        answers = {model: self._plan(task, discount, model) for model in PLANNED}
        for model, result in answers.items():
            self.helped[model] += result.opportunity
            self.saved[model] += result.saving or 0.0
        told = serendipity.plan(task, mode="communication", discount=discount)
        self.announced += told.opportunity
        for model in HUMAN_MODELS:
            if answers["omniscient"].opportunity:
                self._play(task, answers["omniscient"], model)
            if told.opportunity:
                self.unannounced[model] += serendipity.simulate(task, told, model).realised
            if certify:
                started = process_time()
                self.proved[model] += serendipity.verify(task, answers[model]).verdict == "proved"
                self.proving[model].append(process_time() - started)

    def _plan(self, task: Task, discount: str, model: str) -> Result:
        started = perf_counter()
        result = serendipity.plan(task, discount=discount, human_model=model)
        self.seconds[model].append(perf_counter() - started)
        assert result.status == "optimal"
        return result

    def _play(self, task: Task, result: Result, model: str) -> None:
        trace = serendipity.simulate(task, result, model)
        self.realised[model] += trace.realised
        self.stranded[model] += not trace.goals_hold
        if trace.goals_hold and result.human_cost is not None:
            self.turned_out[model] += result.human_cost - trace.cost


def main() -> None:
    """Measure and print the tables."""
    arguments = _arguments()
    tallies = {discount: Tally() for discount in arguments.discounts.split(",")}
    for folder in _folders(arguments.folder, arguments.limit):
        task = serendipity.load(folder, human=arguments.human)
        for discount, tally in tallies.items():
            tally.add(task, discount, certify=arguments.certify)
    _print_realised(tallies)
    _print_savings(tallies)
    _print_times(tallies)
    if arguments.certify:
        _print_proofs(tallies)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--human", default=None)
    parser.add_argument("--discounts", default=DISCOUNTS, help=f"by default {DISCOUNTS}")
    parser.add_argument("--limit", type=int, default=None, help="at most N tasks")
    parser.add_argument("--certify", action="store_true", help="certify the answers for humans who replan")
    return parser.parse_args()


def _folders(folder: Path, limit: int | None) -> Iterator[Path]:
    named = [path for path in folder.iterdir() if path.is_dir()]
    yield from sorted(named, key=lambda path: (len(path.name), path.name))[:limit]


def _row(*cells: object) -> None:
    print(f"| {' | '.join(str(cell) for cell in cells)} |")


def _head(*cells: str) -> None:
    print()
    _row(*cells)
    _row(*("---" for _ in cells))


def _print_realised(tallies: dict[str, Tally]) -> None:
    _head(
        "discount",
        "tasks",
        "helped (paper)",
        *(f"realised, {m}" for m in HUMAN_MODELS),
        *(f"goal missed, {m}" for m in HUMAN_MODELS),
        "helped (communication)",
        *(f"realised unannounced, {m}" for m in HUMAN_MODELS),
    )
    for discount, t in tallies.items():
        helped = t.helped["omniscient"]
        _row(
            discount,
            t.tasks,
            helped,
            *(_share(t.realised[m], helped) for m in HUMAN_MODELS),
            *(t.stranded[m] for m in HUMAN_MODELS),
            t.announced,
            *(_share(t.unannounced[m], t.announced) for m in HUMAN_MODELS),
        )


def _print_savings(tallies: dict[str, Tally]) -> None:
    _head(
        "discount",
        "promised (paper)",
        *(f"paper's plan, {m}" for m in HUMAN_MODELS),
        *(f"planned for {m}" for m in HUMAN_MODELS),
        *(f"helped, {m}" for m in HUMAN_MODELS),
    )
    for discount, t in tallies.items():
        promised = t.saved["omniscient"]
        _row(
            discount,
            f"{promised:.1f}",
            *(f"{t.turned_out[m]:.1f}" for m in HUMAN_MODELS),
            *(f"{t.saved[m]:.1f} ({_percent(t.saved[m], promised)})" for m in HUMAN_MODELS),
            *(t.helped[m] for m in HUMAN_MODELS),
        )


def _print_times(tallies: dict[str, Tally]) -> None:
    _head("discount", *(f"{m}: p50 / p95 / max ms" for m in PLANNED))
    for discount, t in tallies.items():
        _row(discount, *(_quantiles(t.seconds[m]) for m in PLANNED))


def _print_proofs(tallies: dict[str, Tally]) -> None:
    _head("discount", *(f"{m}: proved, p50 / p95 / max ms" for m in HUMAN_MODELS))
    for discount, t in tallies.items():
        _row(
            discount,
            *(f"{_share(t.proved[m], t.tasks)}, {_quantiles(t.proving[m])}" for m in HUMAN_MODELS),
        )


def _share(part: int, whole: int) -> str:
    return f"{part} ({_percent(part, whole)})"


def _percent(part: float, whole: float) -> str:
    return f"{100 * part / whole:.0f} %" if whole else "-"


def _quantiles(seconds: list[float]) -> str:
    ordered = sorted(seconds)
    picked = (ordered[int(len(ordered) * share)] for share in (0.5, 0.95))
    return " / ".join(f"{1000 * value:.1f}" for value in (*picked, ordered[-1]))


if __name__ == "__main__":
    main()
