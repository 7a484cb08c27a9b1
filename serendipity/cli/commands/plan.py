"""``serendipity plan``: the main job."""

import threading
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Final

import typer

import serendipity
from serendipity.cli.exit_codes import OF_STATUS, ExitCode
from serendipity.cli.options import limits, naming, plan_options
from serendipity.cli.process.interrupts import cancelling
from serendipity.cli.streams import output, progress
from serendipity.cli.text import goals as goal_options
from serendipity.model import Certificate, Deadline, Result, Task, UsageError
from serendipity.model.numbers import plain
from serendipity.model.telling import json_of

_CHECK_SHARE: Final = 0.05
"""What of the time limit is kept for checking the answer."""


def plan(
    files: naming.Files = None,
    human: naming.Human = None,
    robot: naming.Robots = None,
    agent: naming.Agents = None,
    team: naming.Team = None,
    example: naming.Example = None,
    mode: plan_options.Mode = None,
    discount: plan_options.Discount = None,
    horizon: plan_options.Horizon = None,
    human_plan: plan_options.HumanPlan = None,
    window_weight: plan_options.WindowWeight = None,
    max_window: plan_options.MaxWindow = None,
    suffix: plan_options.Suffix = None,
    preservation: plan_options.Preservation = None,
    interference: plan_options.Interference = None,
    max_cost: plan_options.MaxCost = None,
    communication_weight: plan_options.CommunicationWeight = None,
    keep_prefix: plan_options.KeepPrefix = None,
    human_model: plan_options.HumanModel = None,
    ties: plan_options.Ties = None,
    max_ties: plan_options.MaxTies = None,
    no_block: plan_options.NoBlock = None,
    goals: goal_options.Goals = None,
    observed: goal_options.Observed = None,
    beta: goal_options.Beta = None,
    time_limit: limits.TimeLimit = None,
    memory_limit: limits.MemoryLimit = None,
    certify: Annotated[bool, typer.Option("--verify", help="Add the certificate of `verify`.")] = False,
    save_plan: Annotated[
        Path | None,
        typer.Option("--save-plan", metavar="FILE", help="Also write the plan, as in planning competitions."),
    ] = None,
    format: output.Format = None,  # noqa: A002 - the option's name
    output_file: output.Output = None,
    quiet: output.Quiet = False,
    verbose: output.Verbose = 0,
) -> int:
    """Find the best help for a person, with a proof."""
    arguments = locals()
    form = output.prepare(format, output_file, verbose)
    output.check_output(save_plan, "--save-plan")
    deadline = limits.begin(time_limit, memory_limit, *_modules(mode, goals, certify=certify))
    task = naming.load(files, human, robot, agent, team, example, quiet=quiet, deadline=deadline)
    options = plan_options.among(arguments, limits=True)
    options["deadline"] = deadline.sooner(_CHECK_SHARE)
    if human_plan is not None:
        from serendipity.cli.files.human_plan import read_human_plan

        options["human_plan"] = read_human_plan(human_plan).checked(task)
    if goals is not None:
        if save_plan is not None:
            raise UsageError("--save-plan: there is no single plan with --goals")
        options |= plan_options.given(goals=goals, observed=observed, beta=beta)
        with progress.working("planning", quiet=quiet), cancelling() as cancelled:
            expected = serendipity.plan(task, cancelled=cancelled, **options)
        with progress.working("verifying", quiet=quiet):
            known = certify and not cancelled.is_set()
            proof = serendipity.verify(task, expected, deadline=deadline) if known else None
        code = _for_goals(expected, proof, form, output_file)
        return ExitCode.INTERRUPTED if cancelled.is_set() else code
    for option, value in (("--observed", observed), ("--beta", beta)):
        if value is not None:
            raise UsageError(f"{option}: goes with --goals only")
    with progress.working("planning", quiet=quiet) as on_news, cancelling() as cancelled:
        result = _last(serendipity.plan_anytime(task, cancelled=cancelled, **options), on_news, cancelled)
    if result is None:
        return ExitCode.INTERRUPTED
    certificate, certify = _certificate(task, result, cancelled, deadline, certify=certify, quiet=quiet)
    answers = [output.Answer(_shown(task, result, certificate, form, claims=certify), output_file)]
    if save_plan is not None and result.plan is not None:
        from serendipity.cli.files.plan_file import plan_file

        answers.append(output.Answer(plan_file(task, result), save_plan, "--save-plan"))
    elif save_plan is not None:
        output.warn((f"--save-plan: there is no plan, so {save_plan} is not written",), quiet=quiet)
    output.write_answers(answers)
    if certificate.verdict == "refuted":
        return ExitCode.REFUTED
    return ExitCode.INTERRUPTED if cancelled.is_set() else OF_STATUS[result.status]


def _certificate(
    task: Task,
    result: Result,
    cancelled: threading.Event,
    deadline: Deadline,
    *,
    certify: bool,
    quiet: bool,
) -> tuple[Certificate, bool]:
    """What the checker says, and whether by a proof: whoever interrupts need not wait for one."""
    with progress.working("verifying", quiet=quiet):
        if certify and not cancelled.is_set():
            try:
                return serendipity.verify(task, result, deadline=deadline), True
            except KeyboardInterrupt:
                cancelled.set()
        return serendipity.check(task, result, deadline=deadline), False


def _shown(task: Task, result: Result, certificate: Certificate, form: str, *, claims: bool) -> str:
    if form == "json":
        certified = {"certificate": certificate.to_dict()} if claims else {}
        return json_of(result.to_dict() | certified)
    from serendipity.cli.text.answers import plan_report

    return plan_report(task, result, certificate, each_claim=claims)


def _modules(mode: str | None, goals: Path | None, *, certify: bool) -> list[str]:
    """What is going to be loaded, or may be."""
    modules = ["serendipity.facade.planning", "serendipity.facade.certify", "serendipity.cli.text.answers"]
    if mode == "assistance":
        modules += [
            "serendipity.facade.assistance",
            "search.modes.assistance.distances.layers",
            "search.modes.assistance.distances.perimeter",
            "verify.policy",
        ]
    if goals is not None:
        modules.append("serendipity.facade.unknown_goals")
    modules += limits.PLANNING
    return [*modules, "verify.certificate.certify", *limits.CHECKING] if certify else modules


def _for_goals(result: Result, certificate: Certificate | None, form: str, output_file: Path | None) -> int:
    """Write the answer where the goal is not known."""
    if form == "json":
        answer = result.to_dict() | ({} if certificate is None else {"certificate": certificate.to_dict()})
        output.write_answer(json_of(answer), output_file)
    else:
        from serendipity.cli.text.render import rendered
        from serendipity.model.answers.words import for_goals

        text = rendered(for_goals(result))
        if certificate is not None:
            text += f"\n{rendered(certificate.told())}"
        output.write_answer(text, output_file)
    refuted = certificate is not None and certificate.verdict == "refuted"
    return ExitCode.REFUTED if refuted else OF_STATUS[result.status]


def _last(answers: Iterable[Result], on_news: progress.News, cancelled: threading.Event) -> Result | None:
    """The last answer that came; ``cancelled`` is set if somebody interrupts the work on a better one."""
    result = None
    try:
        for result in answers:
            if result.cost is not None:
                figures = {name: getattr(result, name) for name in ("objective", "cost", "lower_bound")}
                on_news(f"cost {plain(result.cost)}", **figures)
    except KeyboardInterrupt:
        cancelled.set()
    return result
