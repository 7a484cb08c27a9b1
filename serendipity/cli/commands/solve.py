"""``serendipity solve``: the integer program as a planner of its own."""

from typing import Final

import serendipity
from serendipity.cli.exit_codes import OF_STATUS, ExitCode
from serendipity.cli.files.human_plan import read_human_plan
from serendipity.cli.options import limits, naming, plan_options, program_options
from serendipity.cli.streams import output, progress

_CHECK_SHARE: Final = 0.05
"""What the check of an answer may add to the time limit: a share of it."""


def solve(
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
    ties: plan_options.Ties = None,
    max_ties: plan_options.MaxTies = None,
    time_limit: limits.TimeLimit = None,
    memory_limit: limits.MemoryLimit = None,
    solver: program_options.Solver = "highs",
    encoding: program_options.Encoding = "automata",
    format: output.Format = None,  # noqa: A002 - the option's name
    output_file: output.Output = None,
    quiet: output.Quiet = False,
    verbose: output.Verbose = 0,
) -> int:
    """Answer as `plan` does, by integer programming alone. It is slower, and independent of the search."""
    arguments = locals()
    from serendipity.facade.call import options_from
    from verify.calls.solve import solve as by_program

    form = output.prepare(format, output_file, verbose)
    deadline = limits.begin(time_limit, memory_limit, "serendipity.facade.certify", *limits.CHECKING)
    task = naming.load(files, human, robot, agent, team, example, quiet=quiet, deadline=deadline)
    options = options_from(plan_options.among(arguments, limits=True))
    given = None if human_plan is None else read_human_plan(human_plan).checked(task)
    with progress.working("solving", quiet=quiet):
        result = by_program(
            task, options, human_plan=given, encoding=encoding, solver=solver, deadline=deadline
        )
    certificate = serendipity.check(task, result, deadline=deadline.sooner(-_CHECK_SHARE))
    if form == "json":
        output.write_answer(result.to_json(), output_file)
    else:
        from serendipity.cli.text.answers import plan_report

        output.write_answer(plan_report(task, result, certificate), output_file)
    return ExitCode.REFUTED if certificate.verdict == "refuted" else OF_STATUS[result.status]
