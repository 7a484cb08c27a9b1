"""The facade over proof files, which are checked without a solver."""

from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Final

from serendipity.model import Deadline, InputError, ProofCheck, RefutedProgram, Result, Task, UsageError
from serendipity.model.arguments import PATH, RESULT_IN_TIME, TASK_IN_TIME, expect, expect_or_none
from serendipity.model.resources.limits import limits_from
from serendipity.model.telling import counted
from verify.proofs import checker

_OF_VERIPB: Final = (".pbp", ".opb")
"""How files end that another checker reads."""


def check_proof(
    path: str | Path,
    task: Task | None = None,
    result: Result | None = None,
    *,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
) -> ProofCheck:
    """Check a proof file with integers only; no solver is loaded.

    Args:
        path: the file, packed by gzip or not.
        task: the task that the proof is about; with ``result``: the programs are made again and compared.
        result: the result that it proves.
        time_limit: seconds, or None.
        memory_limit: what this process may have in memory, in MiB, or None.
        deadline: one that other work shares, such as loading the task; it holds beside the limits.

    Returns:
        Whether every program is refuted and, with a task and a result, whether the result follows all
        rules and the programs are those of its claim.

    Raises:
        InputError: the file is no proof file, or the result is for another task.
        UsageError: a task without a result, or the other way round; no program proves such a result.
        LimitReachedError: a limit came first.
    """
    started = perf_counter()
    expect(PATH, path=path)
    expect_or_none(TASK_IN_TIME, task=task)
    expect_or_none(RESULT_IN_TIME, result=result)
    file = Path(path)
    if (task is None) != (result is None):
        raise UsageError("check_proof: expected a task and a result, or neither")
    if file.suffix in _OF_VERIPB:
        raise InputError("is for VeriPB: expected a proof file in JSON; run 'veripb FILE.opb FILE.pbp'", file)
    limits = limits_from(time_limit, memory_limit, deadline)
    polled = partial(limits.each, batch=1)
    programs: tuple[RefutedProgram, ...] = ()
    try:
        data = checker.read(file, polled)
        programs = tuple(RefutedProgram(*found) for found in checker.check(data, polled))
        reason = None
    except checker.MalformedProofError as error:
        raise InputError(str(error), file) from None
    except checker.RejectedProofError as error:
        reason = str(error)
    limits.check()
    compared = task is not None and result is not None and reason is None
    if task is not None and result is not None and reason is None:
        from verify.certificate.against import difference

        reason = difference(task, result, data, limits)
    return ProofCheck(
        "accepted" if reason is None else "rejected",
        reason or _accepted(programs, compared=compared),
        data["claim"],
        compared,
        programs,
        perf_counter() - started,
    )


def _accepted(programs: tuple[RefutedProgram, ...], *, compared: bool) -> str:
    leaves = sum(program.leaves for program in programs)
    words = f"{counted(len(programs), 'program')} refuted, {counted(leaves, 'leaf', 'leaves')}"
    if compared:
        return f"{words}; made again from task and result: the same"
    return f"{words}; whether of the claim's programs takes TASK and RESULT.json to tell"
