"""``serendipity verify``: a second opinion on a result."""

from typing import Annotated

import serendipity
from serendipity.cli.exit_codes import OF_VERDICT
from serendipity.cli.files.reading import about
from serendipity.cli.options import limits, naming, planning
from serendipity.cli.streams import output, progress
from serendipity.cli.text.render import shown


def verify(
    *,
    task: Annotated[naming.TaskName, naming.AND_RESULT],
    solver: planning.Solver = "highs",
    encoding: planning.Encoding = "automata",
    method: planning.Method = "auto",
    proof: planning.Proof = None,
    limited: limits.Limits,
    to: output.Destination,
) -> int:
    """Check a result claim by claim. It is one of `plan --format json`; the search has no part in it."""
    form = to.prepare()
    output.check_output(proof, "--proof")
    modules = ("serendipity.facade.certify", "verify.certificate.certify", "serendipity.cli.text.answers")
    deadline = limited.begin(*modules, *limits.CHECKING)
    loaded, answer, result = task.with_result("verify", deadline)
    with about(answer), progress.working("verifying"):
        certificate = serendipity.verify(
            loaded,
            result,
            proof=proof,
            deadline=deadline,
            **planning.given(solver=solver, encoding=encoding, method=method),
        )
    if proof is not None and certificate.verdict != "proved":
        output.warn(f"--proof: {proof} is not written: there is no proof")
    output.write_answer(shown(certificate, form), to.output_file)
    return OF_VERDICT[certificate.verdict]
