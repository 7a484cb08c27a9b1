"""The facade over the verifier: a result in, a certificate out."""

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Literal

from serendipity.facade.logs import recorded
from serendipity.model import Certificate, Deadline, InputError, Result, Task, UsageError
from serendipity.model.arguments import PATH, RESULT_IN_TIME, TASK_IN_TIME, expect, expect_or_none
from serendipity.model.resources.collection import no_collection
from serendipity.model.resources.limits import limits_from
from serendipity.model.task.horizon import require_few_epochs
from verify.certificate.by_rules import check_by_rules
from verify.rules.header import require_same_task

if TYPE_CHECKING:
    from verify.proofs.book import ProofWriter


def _verdict(certificate: Certificate) -> str:
    return certificate.verdict


@recorded("check", _verdict)
def check(
    task: Task, result: Result, *, time_limit: float | None = None, deadline: Deadline | None = None
) -> Certificate:
    """Replay a result rule by rule; quick, and asks no solver.

    A policy of mode ``assistance`` is walked through: every state that it can meet, its actions,
    its values and that every run ends.

    Args:
        task: the task that was asked.
        result: the answer.
        time_limit: seconds, or None.
        deadline: one that other work shares, such as planning; it holds beside ``time_limit``.

    Returns:
        A certificate that refutes what breaks a rule; what only an optimiser can prove is not
        in its scope, and what there was no time for is undecided.

    Raises:
        InputError: the result is for another task.
        UsageError: actions or the script of the task have too many epochs.
    """
    start = perf_counter()
    limits = limits_from(time_limit, None, deadline)
    expect(TASK_IN_TIME, task=task)
    require_few_epochs(task)
    expect(RESULT_IN_TIME, result=result)
    result = result.checked()
    require_same_task(task, result)
    with no_collection():
        claims = check_by_rules(task, result, limits)
    return Certificate(claims, perf_counter() - start)


def require_answer(task: Task, result: Result, file: object, deadline: Deadline | None = None) -> None:
    """An InputError about a file, where rules refute the result in it for the task."""
    wrong = check(task, result, deadline=deadline).refuted
    if wrong is not None:
        raise InputError(f"is no answer to this task: {wrong.claim}: {wrong.reason}", file)


@recorded("verify", _verdict)
def verify(
    task: Task,
    result: Result,
    *,
    solver: Literal["highs", "cbc"] = "highs",
    encoding: Literal["automata", "paper"] = "automata",
    method: Literal["auto", "program", "exhaustive"] = "auto",
    proof: str | Path | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
) -> Certificate:
    """Check a result claim by claim, by code that shares nothing with the search.

    The limits hold for everything: what they keep from being examined is ``undecided``, with the
    reason, and what was decided before stays so.

    Args:
        task: the task that was asked.
        result: the answer, from :func:`serendipity.plan` or read from JSON.
        solver: ``highs``, or ``cbc`` as a cross-check.
        encoding: ``automata``, or ``paper`` for the paper's own equations.
        method: ``auto``; ``program``: a solver decides every integer program, also where reachability
            and shortest paths could; ``exhaustive``: all states are searched, epoch by epoch.
        proof: a file for what convinced, to be checked by :func:`serendipity.check_proof`; packed by gzip
            where its name ends in ``.gz``; OPB and a proof for VeriPB where it ends in ``.pbp``, for each
            program.  The method is ``program`` then, and there is a file only where the certificate is
            proved.
        time_limit: seconds for the whole certificate, or None.
        memory_limit: what this process and a solver's may have in memory, in MiB, or None.
        deadline: one that other work shares, such as loading the task; it holds beside the limits.

    Returns:
        The certificate; ``verdict`` is ``proved``, ``refuted`` or ``undecided``.

    Raises:
        InputError: the result is for another task.
        UsageError: there is no such solver, encoding or method, or a limit has no legal value; there are
            no programs for a proof of such a result, or its name is that of a problem for VeriPB.
        OSError: the file can't be written.
    """
    limits = limits_from(time_limit, memory_limit, deadline)
    expect(TASK_IN_TIME, task=task)
    require_few_epochs(task)
    expect(RESULT_IN_TIME, result=result)
    expect_or_none(PATH, proof=proof)
    if proof is not None and Path(proof).suffix == ".opb":
        raise UsageError(f"proof: expected a name that ends in .pbp for VeriPB, got {Path(proof).name!r}")
    from verify.certificate.certify import certify  # loads the solvers
    from verify.proofs.book import ProofWriter

    writer = None if proof is None else ProofWriter()
    certificate = certify(
        task, result, encoding=encoding, solver=solver, method=method, proof=writer, deadline=limits
    )
    if writer is not None and proof is not None and certificate.verdict == "proved":
        _write(Path(proof), writer, certificate, result)
    return certificate


def _write(path: Path, writer: "ProofWriter", certificate: Certificate, result: Result) -> None:
    """Write down what convinced, in the form that the file's name asks for."""
    from serendipity.writing import veripb
    from serendipity.writing.together import write_together
    from verify.certificate.provable import main_claim
    from verify.programs.effort import NoProgramError
    from verify.proofs.book import packed

    claim = main_claim(result)
    if not writer.programs:
        raise NoProgramError("an answer that rules alone decide")
    if claim is None:
        return
    data = writer.to_dict(claim, certificate.encoding or "")
    if path.suffix == veripb.SUFFIX:
        veripb.write(path, data)
    else:
        write_together({path: packed(data, small=path.suffix == ".gz")})
