"""Whether the programs of a proof are those of a result's claim: made again, compared, and believed."""

from typing import Any

from serendipity.model import Deadline, Result, Task
from verify.certificate.certify import certify
from verify.certificate.provable import main_claim
from verify.programs.effort import ENCODINGS
from verify.proofs.book import ProofReader


def difference(task: Task, result: Result, data: dict[str, Any], deadline: Deadline) -> str | None:
    """Why a proof that holds does not prove a result; None where it does.

    The result is certified again, and wherever a solver would be asked the proof answers.

    Args:
        task: the task.
        result: the result.
        data: the proof, which the checker has accepted.
        deadline: when to stop.

    Raises:
        InputError: the result is for another task.
        UsageError: no program proves such a result.
        LimitReachedError: the deadline came first.
    """
    claim, encoding = main_claim(result.checked()), data.get("encoding")
    if claim != data["claim"]:
        return f"the proof is of '{data['claim']}', the result claims {claim!r}"
    if not isinstance(encoding, str) or encoding not in ENCODINGS:
        return f"encoding: expected one of {', '.join(ENCODINGS)}, got {encoding!r}"
    reader = ProofReader(data["programs"])
    certificate = certify(task, result, encoding=encoding, proof=reader, deadline=deadline)
    deadline.check()
    if certificate.verdict != "proved":
        failed = next(each for each in certificate.claims if each.verdict == certificate.verdict)
        return f"{failed.claim}: {failed.reason}"
    if reader.left:
        return f"nobody asks for program {reader.left[0]['name']!r}"
    return None
