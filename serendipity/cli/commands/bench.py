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
from serendipity.model import InputError, Table, Task, UsageError
from serendipity.model.errors import DisagreementError
from serendipity.model.table import table_of
from serendipity.model.telling import Grid, Line
from serendipity.writing.rows import FORMATS as ROWS
from serendipity.writing.rows import written

if TYPE_CHECKING:
    from serendipity.evaluation.benchmark.contenders import Contender
    from serendipity.evaluation.benchmark.coverage.rows import Row

_MODES: Final = ("serendipity", "communication", "composite-inf")
_DISCOUNTS: Final = ("0", "0.5", "0.9")
_CONTENDERS: Final = ("search", "in-turn", "automata", "fast-downward")

_Tell = Callable[[str, Table | None, str, Sequence[Any]], None]
"""Prints a text, writes a table where there is one, and plots rows by that name where it is asked for."""


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
            "of search, fast-downward, fast-downward-ipdb.",
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

    def told(text: str, table: Table | None, plotted: str, rows: Sequence[Any]) -> None:
        answers = [output.Answer(text, None)]
        if output_file is not None and table is not None:
            answers.append(output.Answer(written(table, form), output_file))
        if plot is not None:
            from serendipity.evaluation.benchmark import plot as plots

            answers.append(output.Answer(getattr(plots, plotted)(rows, plot.suffix), plot, "--plot"))
        output.write_answers(answers)

    if scaling is not None:
        if folder is not None:
            raise UsageError("--scaling: generates its buildings, so it takes no folder")
        return _scaling(scaling, seeds or 5, time_limit, told)
    from serendipity.evaluation.benchmark.coverage.table import read_rows
    from serendipity.evaluation.measuring.figures import machine
    from serendipity.evaluation.measuring.suites import is_suite

    if folder is not None and folder.is_file():
        return _covered(read_rows(folder), [], told, markdown=markdown)
    if folder is not None and folder.is_dir() and is_suite(folder):
        asked = {"discount": discounts or "0.9", "robots": robots or 2, "time_limit": time_limit}
        rows, complete = _suite(folder, _listed(domains, ()), stride, modes, contenders, **asked)
        where = f"{machine()}; at most {time_limit:g} s a call by the clock."
        code = _covered(rows, [Line(where), Line()], told, markdown=markdown)
        return code if complete else ExitCode.INTERRUPTED
    errors: dict[str, Exception] = {}
    if folder is None:
        tasks = list(_generated(rooms, medkits, robots or 1, seeds or 10))
    else:
        tasks = list(_loaded(folder, stride, errors))
    calls = (_listed(modes, _MODES), _listed(discounts, _DISCOUNTS), _listed(contenders, _CONTENDERS))
    return _side_by_side(tasks, errors, calls, told, repeat=repeat, time_limit=time_limit)


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
    from serendipity.evaluation.benchmark.measure import CONTENDERS, MeasuredCall, broken, measure
    from serendipity.evaluation.benchmark.report import ratios, times
    from serendipity.evaluation.measuring.figures import machine, peak_memory

    modes, discounts, names = calls
    present, absent = _present(names, CONTENDERS)
    timings: list[MeasuredCall] = []
    found = measure(tasks, modes, discounts, present, repeat=repeat, time_limit=time_limit)
    with progress.counting("tasks") as on_progress:
        for timing in found:
            timings.append(timing)
            on_progress(len({timing.task for timing in timings}), len(tasks))
    output.warn(*absent)
    most = f"{peak_memory():.0f} MiB with all tasks in memory"
    parts: list[Line | Grid] = [
        Line(f"{len(tasks)} tasks; {machine()}"),
        Line(f"Processor time; at most {time_limit:g} s a call; {most}."),
        Line(),
    ]
    compared = ratios(timings)
    parts += [compared, Line()] if compared.rows else []
    unread = [broken(task, error) for task, error in errors.items()]
    every = [*timings, *unread]

    text = rendered([*parts, times(timings)])
    tell(text, table_of(MeasuredCall, every) if every else None, "side_by_side", timings)
    return (
        broken_tasks({timing.task: timing.reason or "" for timing in unread}) if unread else ExitCode.ANSWERED
    )


def _suite(
    folder: Path, domains: Sequence[str], stride: int, modes: str | None, contenders: str | None, **asked: Any
) -> "tuple[list[Row], bool]":
    """The rows of a suite's calls, and whether these are all; Ctrl-C leaves those that are there."""
    from serendipity.evaluation.benchmark.coverage.rows import CONTENDERS, MODES, measure
    from serendipity.evaluation.measuring.suites import problems

    present, absent = _present(_listed(contenders, CONTENDERS), CONTENDERS)
    output.warn(*absent)
    chosen = problems(folder, domains, stride)
    rows: list[Row] = []
    with cancelling() as cancelled, progress.counting("tasks") as on_progress:
        for row in measure(chosen, _listed(modes, MODES), present, **asked):
            if cancelled.is_set():  # which may have ended the contender, too
                return rows, False
            rows.append(row)
            on_progress(len({(row.domain, row.task) for row in rows}), len(chosen))
    return rows, True


def _covered(rows: "Sequence[Row]", where: list[Line | Grid], tell: _Tell, *, markdown: bool) -> int:
    """Tell what the rows of a suite, measured somewhere, come to.

    Raises:
        DisagreementError: contenders have proved what can't all be true.
    """
    from serendipity.evaluation.benchmark.coverage import report
    from serendipity.evaluation.benchmark.coverage.table import as_table
    from serendipity.evaluation.measuring.tables import as_markdown

    output.warn(*report.failures(rows))
    text = (as_markdown if markdown else rendered)([*where, *report.tables(rows)])
    tell(text, as_table(rows), "over_time", rows)
    differing = report.disagreements(rows)
    if differing:
        raise DisagreementError("; ".join(differing))
    errors = report.errors(rows)
    return broken_tasks(errors) if errors else ExitCode.ANSWERED


def _scaling(axes: str, seeds: int, time_limit: float, tell: _Tell) -> int:
    from serendipity.evaluation.benchmark import scaling as scaled
    from serendipity.evaluation.measuring.figures import machine

    names = list(scaled.AXES) if axes == "all" else axes.split(",")
    total = len(scaled.planned(names, seeds))
    samples: list[scaled.Sample] = []
    with progress.counting("tasks") as on_progress:
        for sample in scaled.scale(names, seeds=seeds, time_limit=time_limit):
            samples.append(sample)
            on_progress(len(samples), total)
    parts: list[Line | Grid] = [
        Line(f"{len(samples)} tasks, each in a process of its own; {machine()}"),
        Line(f"Medians of processor time, at most {time_limit:g} s a call; the most memory."),
        Line(),
        scaled.scaling_table(samples),
        Line(),
        Line("Exponents of time and memory, fitted to all tasks of an axis on a log-log scale:"),
        Line(),
        scaled.exponents(samples),
    ]

    tell(rendered(parts), table_of(scaled.Sample, samples), "series", samples)
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
    """The tasks of a folder; those that can't be read are ``errors`` by name.

    Raises:
        InputError: there is none that can be read.
    """
    from serendipity.pddl import read_folder

    if not folder.is_dir():
        raise InputError("expected a folder of tasks", folder)
    found = sorted(path for path in folder.iterdir() if path.is_dir())
    if not found:
        raise InputError("expected a folder for each task in it", folder)
    for path in found[::stride]:
        try:
            yield read_folder(path)
        except Exception as error:  # one broken task does not end a suite
            errors[path.name] = error
    if len(errors) == len(found[::stride]):
        raise next(iter(errors.values()))


def _generated(rooms: int, medkits: int, robots: int, seeds: int) -> Iterator[Task]:
    from serendipity import generate_usar
    from serendipity.pddl import read_folder

    with tempfile.TemporaryDirectory() as scratch:
        for seed in range(seeds):
            place = Path(scratch, f"seed{seed}")
            generate_usar(place, rooms=rooms, medkits=medkits, robots=robots, seed=seed)
            yield read_folder(place)
