"""``serendipity plan``: the main job."""

import threading
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Final

import serendipity
from serendipity.cli.choices import option
from serendipity.cli.exit_codes import OF_STATUS, ExitCode
from serendipity.cli.options import limits, naming, planning
from serendipity.cli.process.interrupts import cancelling
from serendipity.cli.streams import output, progress
from serendipity.cli.streams.manner import is_verbose
from serendipity.cli.streams.stderr import write_line
from serendipity.model import Certificate, Deadline, Result, Task, UsageError
from serendipity.model.keywords import ANYBODY
from serendipity.model.numbers import plain
from serendipity.model.telling import json_of

_CHECK_SHARE: Final = 0.05
"""What of the time limit is kept for checking the answer."""


def plan(
    *,
    task: naming.TaskName,
    options: planning.Planning,
    goals: planning.Goals = None,
    plans: planning.Plans = None,
    observed: planning.Observed = None,
    beta: planning.Beta = None,
    noise: planning.Noise = None,
    classical: Annotated[
        str | None,
        option(
            "--classical symk", "Also ask this planner, as a process: alone, or together without a horizon."
        ),
    ] = None,
    limited: limits.Limits,
    certify: Annotated[bool, option("--verify", "Add the certificate of `verify`.")] = False,
    save_plan: Annotated[
        Path | None, option("--save-plan FILE", "Also write the plan, as in planning competitions.")
    ] = None,
    to: output.Destination,
) -> int:
    """Find the best help for a person, with a proof."""
    form = to.prepare()
    output.check_output(save_plan, "--save-plan")
    deadline = limited.begin(*_modules(options.given, goals or plans, classical, certify=certify))
    interference = options.given.get("interference", "paper")
    loaded = task.load(deadline, interference=interference, anybody=True)
    anybody = task.settled().for_anybody and ANYBODY not in loaded.agents
    asked = options.given | limited.given | {"deadline": deadline.sooner(_CHECK_SHARE)}
    if classical is not None:
        asked["classical"] = classical
    if options.human_plan is not None:
        asked["human_plan"] = options.plan_of(loaded)
    if anybody and (goals or plans or options.human_plan) is not None:
        raise UsageError("--human any: goes without --goals, --plans and --human-plan")
    watched = options.given.get("ties") == "watched" and options.human_plan is None
    if (goals or plans) is not None or watched:
        if save_plan is not None:
            raise UsageError("--save-plan: there is no single plan with --goals, --plans or --ties watched")
        asked |= planning.given(goals=goals, plans=plans, observed=observed, beta=beta, noise=noise)
        with progress.working("planning"), cancelling() as cancelled:
            expected = serendipity.plan(loaded, cancelled=cancelled, **asked)
        with progress.working("verifying"):
            known = certify and not cancelled.is_set()
            proof = serendipity.verify(loaded, expected, deadline=deadline) if known else None
        output.write_answer(_told_for_goals(loaded, expected, proof, form), to.output_file)
        _tell_strategies(expected)
        refuted = proof is not None and proof.verdict == "refuted"
        return _code(expected, cancelled, refuted=refuted)
    planning.require_nothing_observed(observed=observed, beta=beta, noise=noise)
    result: Result | None
    with progress.working("planning") as on_news, cancelling() as cancelled:
        if anybody:
            from serendipity.facade.bystanders import best_for_anybody

            loaded, result = best_for_anybody(loaded, cancelled, **asked)
        else:
            result = _last(serendipity.plan_anytime(loaded, cancelled=cancelled, **asked), on_news, cancelled)
    if result is None:
        return ExitCode.INTERRUPTED
    certificate, certify = _certificate(loaded, result, cancelled, deadline, certify=certify)
    answers = [output.Answer(_told(loaded, result, certificate, form, claims=certify), to.output_file)]
    if save_plan is not None and result.plan is not None:
        from serendipity.cli.files.plans import plan_file

        answers.append(output.Answer(plan_file(loaded, result), save_plan, "--save-plan"))
    elif save_plan is not None:
        output.warn(f"--save-plan: there is no plan, so {save_plan} is not written")
    output.write_answers(answers)
    _tell_strategies(result)
    return _code(result, cancelled, refuted=certificate.verdict == "refuted")


def _tell_strategies(result: Result) -> None:
    """What came of each turn of the search (``-v``); modes with but one have no table."""
    tried = result.statistics.get("strategies")
    if tried and is_verbose():
        from serendipity.cli.text.answers import table_of

        for line in table_of(tried).splitlines():
            write_line(line)


def _code(result: Result, cancelled: threading.Event, *, refuted: bool) -> ExitCode:
    if refuted:
        return ExitCode.REFUTED
    return ExitCode.INTERRUPTED if cancelled.is_set() else OF_STATUS[result.status]


def _certificate(
    task: Task, result: Result, cancelled: threading.Event, deadline: Deadline, *, certify: bool
) -> tuple[Certificate, bool]:
    """What the checker says, and whether by a proof: whoever interrupts need not wait for one."""
    with progress.working("verifying"):
        if certify and not cancelled.is_set():
            try:
                return serendipity.verify(task, result, deadline=deadline), True
            except KeyboardInterrupt:
                cancelled.set()
        return serendipity.check(task, result, deadline=deadline), False


def _told(task: Task, result: Result, certificate: Certificate, form: str, *, claims: bool) -> str:
    if form == "json":
        return _as_json(result, certificate if claims else None)
    from serendipity.cli.text.answers import plan_report

    return plan_report(task, result, certificate, each_claim=claims)


def _as_json(result: Result, certificate: Certificate | None) -> str:
    return json_of(result.to_dict() | ({} if certificate is None else {"certificate": certificate.to_dict()}))


def _modules(
    given: Mapping[str, Any], unsure: Path | None, classical: str | None, *, certify: bool
) -> list[str]:
    """What is going to be loaded, or may be."""
    modules = ["serendipity.facade.planning", "serendipity.facade.certify", "serendipity.cli.text.answers"]
    if given.get("mode") == "assistance":
        modules += [
            "search.modes.assistance",
            "search.modes.assistance.distances.perimeter",
            "verify.policy",
        ]
    if unsure is not None or given.get("ties") == "watched":
        modules.append("serendipity.facade.scenarios")
    if classical is not None:
        modules.append("serendipity.facade.classical")
    modules += limits.PLANNING
    return [*modules, "verify.certificate.certify", *limits.CHECKING] if certify else modules


def _told_for_goals(task: Task, result: Result, certificate: Certificate | None, form: str) -> str:
    """The answer over scenarios, or for the one optimal plan that the human has."""
    if form == "json":
        return _as_json(result, certificate)
    if result.goals is None:
        known = certificate or serendipity.check(task, result)
        return _told(task, result, known, form, claims=certificate is not None)
    from serendipity.cli.text.render import rendered

    proof = "" if certificate is None else f"\n{rendered(certificate.told())}"
    return rendered(result.told()) + proof


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
