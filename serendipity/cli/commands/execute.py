"""``serendipity execute``: a person, robots and the world go on epoch by epoch."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import serendipity
from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import naming, planning
from serendipity.cli.streams import output, progress
from serendipity.cli.text.render import shown
from serendipity.model import InputError, UsageError
from serendipity.model.numbers import plain
from serendipity.model.options import limit_of

if TYPE_CHECKING:
    from serendipity.robot.physics import Film, Stage


def execute(
    *,
    files: naming.Files = None,
    human: Annotated[
        str,
        option(
            "--human recorded:FILE|omniscient|observant|local|noisy:P",
            "Who the person is; the FILE of 'recorded' may also stand behind TASK.",
        ),
    ] = "observant",
    person: Annotated[
        str | None, option("--person H", "Which agent is the person; by default the only one with a goal.")
    ] = None,
    task: Annotated[naming.TaskName, ("robot", "agent", "team", "bystander", "example")],
    mode: Annotated[
        str | None,
        option(
            "--mode serendipity|communication",
            "Communication: robots' plan may ask an omniscient person to leave their own.",
        ),
    ] = None,
    discount: Annotated[str | None, planning.told("discount")] = None,
    human_model: Annotated[
        str | None,
        option(
            "--human-model omniscient|observant|local",
            "What robots take the person to be; by default what they are, else observant.",
        ),
    ] = None,
    interference: Annotated[str | None, planning.told("interference")] = None,
    leave_free: Annotated[
        str | None,
        option(
            "--leave-free PATTERNS",
            "Only facts that fit, or that people may change, may be left changed; '*': all. By default, "
            "without --goals, --plans and goals of robots' own, facts that name a robot.",
        ),
    ] = None,
    goals: planning.Goals = None,
    plans: planning.Plans = None,
    beta: planning.Beta = None,
    noise: planning.Noise = None,
    runs: Annotated[int, option("--runs N", "How many runs.")] = 1,
    seed: Annotated[int, option("--seed S", "Of the first run's dice.")] = 0,
    ties: Annotated[
        str,
        option("--ties fixed|drawn", "The person follows the canonical one of their optimal plans, or any."),
    ] = "fixed",
    faults: Annotated[
        str | None,
        option(
            "--faults fail=P,slow=P,drop=P",
            "How often a robot's action fails or takes longer, and a robot drops out.",
        ),
    ] = None,
    adapter: Annotated[
        str | None,
        option(
            "--adapter simulated|pybullet",
            "What carries out what robots do; by default simulated where there are durations or faults, "
            "else all that is possible is done within its epoch. pybullet: figures in physics.",
        ),
    ] = None,
    durations: Annotated[
        str | None,
        option(
            "--durations VERB=SECONDS,...",
            "How long simulated robots take for actions of that first word, '*' for all others: "
            "move=2..4,*=1.",
        ),
    ] = None,
    epoch_seconds: Annotated[
        str | None, option("--epoch-seconds SECONDS", "How long an epoch is for robots; 1, in physics 5.")
    ] = None,
    clip: Annotated[
        Path | None, option("--clip FILE", "Film figures in physics, as .gif, .webp or animated .png.")
    ] = None,
    deadline: Annotated[
        str | None, option("--deadline SECONDS", "For each decision; without one in time robots do nothing.")
    ] = None,
    epochs: Annotated[int | None, option("--epochs N", "The most epochs of a run.")] = None,
    jobs: Annotated[int, option("-j, --jobs N", "Processes.")] = 1,
    log: Annotated[
        Path | None, option("--log FILE", "Also write every epoch of every run as JSON lines.")
    ] = None,
    replay: Annotated[
        Path | None, option("--replay LOG", "Play the runs of a log again, and compare.")
    ] = None,
    to: Annotated[output.Destination, output.ROWS_TOO],
) -> int:
    """Let a person do as they like while robots watch and help. They decide in each epoch anew."""
    form = to.prepare(output.DATA)
    output.check_output(log, "--log")
    output.check_output(clip, "--clip")
    film = None if clip is None else _film(clip, adapter, runs)
    named, policy = _recorded(files, human)
    given = planning.given(
        mode=mode,
        discount=discount,
        interference=interference,
        beta=beta,
        noise=noise,
        ties=ties,
        human_model=human_model,
        leave_free=leave_free,
    )
    loaded = task.but(files=named, human=person).load(interference=given.get("interference", "paper"))
    if replay is not None:
        return _replayed(loaded, replay, to.output_file)
    with progress.counting("runs") as on_progress:
        found = serendipity.execute(
            loaded,
            policy,
            runs=runs,
            seed=seed,
            faults=faults,
            adapter=adapter if film is None else partial(_filmed, film, epoch_seconds),
            durations=durations,
            epoch_seconds=_seconds("epoch_seconds", epoch_seconds),
            goals=goals,
            plans=plans,
            epochs=epochs,
            jobs=jobs,
            on_progress=on_progress if runs > 1 else None,
            deadline=_seconds("deadline", deadline),
            **given,
        )
    answers = [output.Answer(shown(found, form), to.output_file)]
    if log is not None:
        from serendipity.execution import as_text

        answers.append(output.Answer("".join(map(as_text, found.logs)), log, "--log"))
    if clip is not None and film is not None:
        answers.append(output.Answer(film.clip(clip.suffix, found.logs[0]), clip, "--clip"))
    output.write_answers(answers)
    return ExitCode.ANSWERED if all(row.reached for row in found.rows) else ExitCode.REFUTED


def _film(clip: Path, adapter: str | None, runs: int) -> "Film":
    """What a run is filmed with."""
    if adapter != "pybullet" or runs != 1:
        raise UsageError("--clip: expected --adapter pybullet, and a single run")
    from serendipity.robot.physics import Film, check_format

    check_format(clip)
    return Film()


def _filmed(film: "Film", epoch_seconds: str | None, task: serendipity.Task, _dice: object) -> "Stage":
    from serendipity.robot.physics import Stage

    return Stage(task, epoch=_seconds("epoch_seconds", epoch_seconds), film=film)


def _seconds(name: str, text: str | None) -> float | None:
    return None if text is None else limit_of(name, text, "seconds")


def _recorded(files: list[Path] | None, human: str) -> tuple[list[Path] | None, str]:
    """The files that name the task, and the person, whose record may stand behind them."""
    if human.strip() != "recorded":
        return files, human
    if not files:
        raise UsageError("--human recorded: expected recorded:FILE, or the FILE behind TASK")
    *named, record = files
    return named, f"recorded:{record}"


def _replayed(task: serendipity.Task, file: Path, output_file: Path | None) -> int:
    from serendipity.cli.text.render import rendered
    from serendipity.execution import read_logs, replay
    from serendipity.model.telling import Line, counted

    lines, code = [], ExitCode.ANSWERED
    for number, log in enumerate(read_logs(file), start=1):
        try:
            run = replay(task, log, file)
        except InputError as error:
            lines.append(Line(f"run {number}: {error}", "red"))
            code = ExitCode.REFUTED
        else:
            costs = f"{run.human} paid {plain(run.human_cost)}, the team {plain(run.cost)}"
            lines.append(Line(f"run {number}: the same again; {counted(len(run.passed), 'epoch')}, {costs}"))
    output.write_answer(rendered(lines), output_file)
    return code
