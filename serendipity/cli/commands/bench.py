"""``serendipity bench``: the search, integer programs and Fast Downward on the same calls; series, suites."""

import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.process.interrupts import cancelling
from serendipity.cli.streams import output, progress
from serendipity.cli.streams.stderr import broken_tasks
from serendipity.cli.text.render import rendered
from serendipity.model import InputError, Task, UsageError
from serendipity.model.errors import DisagreementError, told
from serendipity.model.telling import Grid, Line
from serendipity.writing.rows import FORMATS as ROWS
from serendipity.writing.rows import written

if TYPE_CHECKING:
    from serendipity.evaluation.benchmark.contenders import Contender
    from serendipity.evaluation.benchmark.rows import BenchRow

_MODES: Final = ("serendipity", "communication", "composite-inf")
_DISCOUNTS: Final = ("0", "0.5", "0.9")
_CONTENDERS: Final = ("search", "in-turn", "automata", "fast-downward")

_Tell = Callable[[str, "Sequence[BenchRow]", str], None]
"""Prints a text, writes rows where there are some, and plots them by that name where it is asked for."""


def bench(
    folder: Annotated[
        Path | None,
        typer.Argument(
            metavar="FOLDER",
            help="Tasks in folders, as for `reproduce`; or a suite, folders with domain.pddl and problems in "
            "MA-PDDL; or the CSV of a suite, to print its tables again. Generated buildings without one.",
        ),
    ] = None,
    stride: Annotated[
        int, option("--stride N", "Take every N-th task of the folder, of each domain of a suite.", min=1)
    ] = 1,
    domains: Annotated[str, option("--domains NAME,...", "Of a suite; by default all.")] = "",
    rooms: Annotated[int, option("--rooms N", "Rooms of generated buildings.", min=2)] = 21,
    medkits: Annotated[int, option("--medkits M", "Their medkits.", min=1)] = 2,
    robots: Annotated[
        int | None, option("--robots K", "Their robots: 1; of a suite's tasks the most: 2.", min=1)
    ] = None,
    seeds: Annotated[
        int | None,
        option("--seeds N", "How many to generate: 10; for each value of a scaling series 5.", min=1),
    ] = None,
    modes: Annotated[
        str | None,
        option(
            "--modes MODE,...",
            "Modes; composite-inf is composite mode without a horizon. Fast "
            "Downward knows that one, and individual in suites, where serendipity-k0 has K = 0.",
        ),
    ] = None,
    discounts: Annotated[
        str | None, option("--discounts D,...", "Discounts: 0,0.5,0.9; one for a suite: 0.9.")
    ] = None,
    contenders: Annotated[
        str | None,
        option(
            "--contenders NAME,...",
            "Some of search (first calls), in-turn (each task's discounts one after another), again "
            "(the same call again), automata, paper, fast-downward; of a suite some "
            "of search, fast-downward, fast-downward-ipdb, symk, and scorpion with --scorpion.",
        ),
    ] = None,
    scorpion: Annotated[
        Path | None,
        option(
            "--scorpion PROGRAM",
            "Scorpion for a suite, which you build: its builds/release/bin/downward.",
        ),
    ] = None,
    scaling: Annotated[
        str | None,
        option(
            "--scaling AXES|all",
            "How the search scales instead: some of rooms, medkits, robots, length, modes, discounts.",
        ),
    ] = None,
    repeat: Annotated[
        int, option("--repeat N", "Calls per figure, after a warm-up; passes for in-turn.", min=1)
    ] = 5,
    time_limit: Annotated[float, option("--time-limit SECONDS", "Seconds for each call.", min=0)] = 20.0,
    output_file: Annotated[
        Path | None,
        option(
            "-o, --output FILE", "Write every timing here: as CSV, or as FILE ends in .jsonl or .parquet."
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        option("--plot FILE", "Plot, a suite's over time: .png, .svg or .pdf (needs matplotlib)."),
    ] = None,
    markdown: Annotated[bool, option("--markdown", "A suite's tables as Markdown.")] = False,
) -> int:
    """Measure the search beside integer programs and others. -o writes every timing."""
    form = _checked_form(output_file, plot)

    def tell(text: str, rows: "Sequence[BenchRow]", plotted: str) -> None:
        from serendipity.evaluation.benchmark.rows import as_table

        answers = [output.Answer(text, None)]
        if output_file is not None and rows:
            answers.append(output.Answer(written(as_table(rows), form), output_file))
        if plot is not None:
            from serendipity.evaluation.benchmark import plot as plots

            drawn = [row for row in rows if row.outcome.status != "error"]
            answers.append(output.Answer(getattr(plots, plotted)(drawn, plot.suffix), plot, "--plot"))
        output.write_answers(answers)

    if scaling is not None:
        if folder is not None:
            raise UsageError("--scaling: generates its buildings, so it takes no folder")
        return _scaling(scaling, seeds or 5, time_limit, tell)
    from serendipity.evaluation.benchmark.coverage import contenders_with
    from serendipity.evaluation.benchmark.rows import read_rows
    from serendipity.evaluation.measuring.figures import machine
    from serendipity.evaluation.measuring.suites import is_suite

    suite = folder is not None and folder.is_dir() and is_suite(folder)
    if scorpion is not None and not suite:
        raise UsageError("--scorpion: is for suites of domains only")
    if folder is not None and folder.is_file():
        return _covered(read_rows(folder), [], tell, markdown=markdown)
    if folder is not None and suite:
        asked = {"discount": discounts or "0.9", "robots": robots or 2, "time_limit": time_limit}
        asked["known"] = contenders_with(scorpion)
        rows, complete = _suite(folder, _listed(domains, ()), stride, modes, contenders, **asked)
        where = f"{machine()}; at most {time_limit:g} s a call by the clock."
        code = _covered(rows, [Line(where), Line()], tell, markdown=markdown)
        return code if complete else ExitCode.INTERRUPTED
    errors: dict[str, Exception] = {}
    if folder is None:
        tasks = list(_generated(rooms, medkits, robots or 1, seeds or 10))
    else:
        tasks = list(_loaded(folder, stride, errors))
    calls = (_listed(modes, _MODES), _listed(discounts, _DISCOUNTS), _listed(contenders, _CONTENDERS))
    return _side_by_side(tasks, errors, calls, tell, repeat=repeat, time_limit=time_limit)


def _side_by_side(
    tasks: Sequence[Task],
    errors: Mapping[str, Exception],
    calls: tuple[list[str], list[str], list[str]],
    tell: _Tell,
    *,
    repeat: int,
    time_limit: float,
) -> int:
    """Contenders on some modes and discounts of tasks; beside tasks that can't be read."""
    from serendipity.evaluation.benchmark.contenders import Outcome
    from serendipity.evaluation.benchmark.rows import BenchRow
    from serendipity.evaluation.benchmark.side_by_side import CONTENDERS, measure, ratios, times
    from serendipity.evaluation.measuring.figures import machine, peak_memory

    modes, discounts, names = calls
    present, absent = _present(names, CONTENDERS)
    rows: list[BenchRow] = []
    found = measure(tasks, modes, discounts, present, repeat=repeat, time_limit=time_limit)
    with progress.counting("tasks") as on_progress:
        for row in found:
            rows.append(row)
            on_progress(len({row.task for row in rows}), len(tasks))
    output.warn(*absent)
    most = f"{peak_memory():.0f} MiB with all tasks in memory"
    parts: list[Line | Grid] = [
        Line(f"{len(tasks)} tasks; {machine()}"),
        Line(f"Processor time; at most {time_limit:g} s a call; {most}."),
        Line(),
    ]
    compared = ratios(rows)
    parts += [compared, Line()] if compared.rows else []
    reasons = {task: told(error) for task, error in errors.items()}
    unread = [
        BenchRow("", task, "", "", False, "", 0.0, "", Outcome("error", reason=why))
        for task, why in reasons.items()
    ]
    tell(rendered([*parts, times(rows)]), [*rows, *unread], "side_by_side")
    return broken_tasks(reasons) if reasons else ExitCode.ANSWERED


def _suite(
    folder: Path, domains: Sequence[str], stride: int, modes: str | None, contenders: str | None, **asked: Any
) -> "tuple[list[BenchRow], bool]":
    """The rows of a suite's calls, and whether these are all; Ctrl-C leaves those that are there."""
    from serendipity.evaluation.benchmark.coverage import MODES, measure
    from serendipity.evaluation.measuring.suites import problems

    present, absent = _present(_listed(contenders, asked["known"]), asked["known"])
    output.warn(*absent)
    chosen = problems(folder, domains, stride)
    rows: list[BenchRow] = []
    with cancelling() as cancelled, progress.counting("tasks") as on_progress:
        for row in measure(chosen, _listed(modes, MODES), present, **asked):
            if cancelled.is_set():  # which may have ended the contender, too
                return rows, False
            rows.append(row)
            on_progress(len({(row.domain, row.task) for row in rows}), len(chosen))
    return rows, True


def _covered(rows: "Sequence[BenchRow]", where: list[Line | Grid], tell: _Tell, *, markdown: bool) -> int:
    """Tell what the rows of a suite, measured somewhere, come to."""
    from serendipity.evaluation.benchmark import coverage as report
    from serendipity.evaluation.benchmark.rows import disagreements
    from serendipity.evaluation.measuring.tables import as_markdown

    output.warn(*report.failures(rows))
    text = (as_markdown if markdown else rendered)([*where, *report.tables(rows)])
    tell(text, rows, "over_time")
    if differing := "; ".join(disagreements(rows)):
        raise DisagreementError(differing)
    errors = report.errors(rows)
    return broken_tasks(errors) if errors else ExitCode.ANSWERED


def _scaling(axes: str, seeds: int, time_limit: float, tell: _Tell) -> int:
    from serendipity.evaluation.benchmark import scaling as scaled
    from serendipity.evaluation.measuring.figures import machine

    names = list(scaled.AXES) if axes == "all" else axes.split(",")
    total = len(scaled.planned(names, seeds))
    rows: list[BenchRow] = []
    with progress.counting("tasks") as on_progress:
        for row in scaled.scale(names, seeds=seeds, time_limit=time_limit):
            rows.append(row)
            on_progress(len(rows), total)
    parts: list[Line | Grid] = [
        Line(f"{len(rows)} tasks, each in a process of its own; {machine()}"),
        Line(f"Medians of processor time, at most {time_limit:g} s a call; the most memory."),
        Line(),
        scaled.scaling_table(rows),
        Line(),
        Line("Exponents of time and memory, fitted to all tasks of an axis on a log-log scale:"),
        Line(),
        scaled.exponents(rows),
    ]
    tell(rendered(parts), rows, "series")
    return ExitCode.ANSWERED


def _checked_form(output_file: Path | None, plot: Path | None) -> str:
    """How the rows are written: as the file's name ends, else CSV; both files can be written."""
    output.check_output(output_file)
    form = output.choose_format(None, output_file, ROWS)
    if plot is not None:
        from serendipity.evaluation.benchmark.plot import check_suffix

        output.check_output(plot, "--plot")
        check_suffix(plot.suffix)
    return form


def _listed(text: str | None, default: Iterable[str]) -> list[str]:
    """The names in an option, which are separated by commas."""
    return text.split(",") if text else list(default)


def _present(names: Sequence[str], known: "Mapping[str, Contender]") -> tuple[list[str], tuple[str, ...]]:
    """The contenders that can run here, and why others can't."""
    reasons = {name: known[name].absent() for name in names if name in known}
    absent = tuple(dict.fromkeys(reason for reason in reasons.values() if reason is not None))
    return [name for name in names if reasons.get(name) is None], absent


def _loaded(folder: Path, stride: int, errors: dict[str, Exception]) -> Iterator[Task]:
    """The tasks of a folder; those that can't be read are ``errors`` by name."""
    from serendipity.evaluation.measuring.suites import folders
    from serendipity.pddl import read_folder

    if not folder.is_dir():
        raise InputError("expected a folder of tasks", folder)
    found = folders(folder, stride)
    if not found:
        raise InputError("expected a folder for each task in it", folder)
    for path in found:
        try:
            yield read_folder(path)
        except Exception as error:  # one broken task does not end a suite
            errors[path.name] = error
    if len(errors) == len(found):
        raise next(iter(errors.values()))


def _generated(rooms: int, medkits: int, robots: int, seeds: int) -> Iterator[Task]:
    from serendipity import generate_usar
    from serendipity.pddl import read_folder

    with tempfile.TemporaryDirectory() as scratch:
        for seed in range(seeds):
            place = Path(scratch, f"seed{seed}")
            generate_usar(place, rooms=rooms, medkits=medkits, robots=robots, seed=seed)
            yield read_folder(place)
