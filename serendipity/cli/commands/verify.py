"""``serendipity verify``: a second opinion on a result."""

import serendipity
from serendipity.cli.exit_codes import OF_VERDICT
from serendipity.cli.files.reading import read_result
from serendipity.cli.options import limits, naming, plan_options, program_options
from serendipity.cli.streams import output, progress
from serendipity.model import InputError


def verify(
    files: naming.FilesAndResult,
    human: naming.Human = None,
    robot: naming.Robots = None,
    agent: naming.Agents = None,
    team: naming.Team = None,
    example: naming.Example = None,
    solver: program_options.Solver = "highs",
    encoding: program_options.Encoding = "automata",
    method: program_options.Method = "auto",
    proof: program_options.Proof = None,
    time_limit: limits.TimeLimit = None,
    memory_limit: limits.MemoryLimit = None,
    format: output.Format = None,  # noqa: A002 - the option's name
    output_file: output.Output = None,
    quiet: output.Quiet = False,
    verbose: output.Verbose = 0,
) -> int:
    """Check a result claim by claim. It is one of `plan --format json`; the search has no part in it."""
    form = output.prepare(format, output_file, verbose)
    output.check_output(proof, "--proof")
    modules = ("serendipity.facade.certify", "verify.certificate.certify", "serendipity.cli.text.answers")
    deadline = limits.begin(time_limit, memory_limit, *modules, *limits.CHECKING)
    named, answer, result = read_result(files, "verify")
    task = naming.load(named, human, robot, agent, team, example, quiet=quiet, deadline=deadline)
    try:
        with progress.working("verifying", quiet=quiet):
            certificate = serendipity.verify(
                task,
                result,
                proof=proof,
                deadline=deadline,
                **plan_options.given(solver=solver, encoding=encoding, method=method),
            )
    except InputError as error:
        raise InputError(error.message, answer) from None
    if proof is not None and certificate.verdict != "proved":
        output.warn((f"--proof: {proof} is not written: there is no proof",), quiet=quiet)
    if form == "json":
        output.write_answer(certificate.to_json(), output_file)
    else:
        from serendipity.cli.text.render import rendered

        output.write_answer(rendered(certificate.told()), output_file)
    return OF_VERDICT[certificate.verdict]
