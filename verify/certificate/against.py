"""Whether the programs of a proof are those of a result's claim: made again, compared, and believed."""

from collections.abc import Iterator
from contextlib import contextmanager
from copy import copy
from typing import Any

from serendipity.model import Deadline, LimitReachedError, Result, Task
from verify.certificate.certify import certify
from verify.certificate.provable import main_claim
from verify.programs.effort import ENCODINGS
from verify.proofs.book import ProofReader


def difference(task: Task, result: Result, data: dict[str, Any], deadline: Deadline) -> str | None:
    """Why a proof that holds does not prove a result; None where it does.

    The result is certified again, and wherever a solver would be asked the proof answers.

    Raises:
        InputError: the result is for another task.
        UsageError: no program proves such a result.
    """
    claim, encoding = main_claim(result.checked()), data.get("encoding")
    if claim != data["claim"]:
        return f"the proof is of '{data['claim']}', the result claims {claim!r}"
    if not isinstance(encoding, str) or encoding not in ENCODINGS:
        return f"encoding: expected one of {', '.join(ENCODINGS)}, got {encoding!r}"
    reader = ProofReader(data["programs"])
    limits = _Remembering(deadline)
    certificate = certify(task, result, encoding=encoding, proof=reader, deadline=limits)
    deadline.check()
    if certificate.verdict == "undecided" and limits.came:
        raise LimitReachedError(limits.came[0])
    if certificate.verdict != "proved":
        failed = next(each for each in certificate.claims if each.verdict == certificate.verdict)
        return f"{failed.claim}: {failed.reason}"
    if reader.left:
        return f"nobody asks for program {reader.left[0]['name']!r}"
    return None


class _Remembering(Deadline):
    """A deadline whose limits leave claims undecided, and which knows afterwards that they came.

    Attributes:
        came: which of them, as ``LimitReachedError.reason`` has them; parts of this deadline add to it.
    """

    def __init__(self, deadline: Deadline) -> None:
        super().__init__()
        self.renew(deadline)
        self._deadline = deadline
        self.came: list[str] = []

    def sooner(self, share: float) -> "_Remembering":
        """See :class:`Deadline`."""
        part = copy(self)
        part._deadline = self._deadline.sooner(share)
        part.renew(part._deadline)
        return part

    def check(self) -> None:
        """See :class:`Deadline`."""
        with self._remembered():
            self._deadline.check()
        super().check()

    def require(self, size: float) -> None:
        """See :class:`Deadline`."""
        with self._remembered():
            self._deadline.require(size)

    @contextmanager
    def _remembered(self) -> Iterator[None]:
        try:
            yield
        except LimitReachedError as limit:
            self.came.append(limit.reason)
            raise
