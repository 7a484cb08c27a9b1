"""``serendipity front``: what less of a saving leaves a person more in peace."""

from pathlib import Path
from typing import Annotated

import serendipity
from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import limits, naming, planning
from serendipity.cli.process.interrupts import cancelling
from serendipity.cli.streams import output, progress
from serendipity.cli.text.render import shown
from serendipity.model.numbers import plain


def front(
    *,
    task: naming.TaskName,
    options: Annotated[planning.Planning, planning.FRONT],
    goals: planning.Goals = None,
    plans: planning.Plans = None,
    observed: planning.Observed = None,
    beta: planning.Beta = None,
    noise: planning.Noise = None,
    picture: Annotated[Path | None, option("--picture FILE", "Also draw it (.svg, .png).")] = None,
    certify: Annotated[bool, option("--verify", "Prove each point, as `verify` does.")] = False,
    limited: limits.Limits,
    to: Annotated[output.Destination, output.ROWS_TOO],
) -> int:
    """Say what each saving costs of being left in peace. The exact front, from the most help to none."""
    form = to.prepare(output.DATA)
    unsure = () if goals is None and plans is None else ("serendipity.facade.scenarios",)
    if not unsure:
        planning.require_nothing_observed(observed=observed, beta=beta, noise=noise)
    output.check_picture(picture, "--picture", to.output_file)
    deadline = limited.begin("serendipity.facade.front", *unsure, *limits.PLANNING)
    loaded = task.load(deadline)
    given = options.plan_of(loaded)
    with progress.working("planning") as on_news, cancelling() as cancelled:
        asked = options.given | planning.given(
            goals=goals, plans=plans, observed=observed, beta=beta, noise=noise
        )
        asked |= {"human_plan": given, "deadline": deadline, "cancelled": cancelled}

        def on_point(point: serendipity.FrontPoint) -> None:
            on_news(f"disturbance {plain(point.disturbance)}", saving=float(point.saving))

        found = serendipity.front(loaded, verify=certify, on_point=on_point, **asked)
    answers = [output.Answer(shown(found, form), to.output_file)]
    if picture is not None:
        from serendipity.facade.front import drawn

        answers.append(output.Answer(drawn(found, picture.suffix), picture, "--picture"))
    output.write_answers(answers)
    if any(point.certificate and point.certificate.verdict == "refuted" for point in found.points):
        return ExitCode.REFUTED
    if not found.points:
        return ExitCode.INFEASIBLE if found.complete else ExitCode.UNDECIDED
    return ExitCode.ANSWERED
