"""False results are presented to the verifier, in all the ways that it has; none may be proved."""

from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field, fields
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any, Final

from serendipity.facade.certify import verify
from serendipity.facade.proofs import check_proof
from serendipity.model import InputError, SerendipityError, UsageError
from serendipity_testing.crosscheck.forger import Forgery, forgeries
from serendipity_testing.disagreement import Disagreement
from serendipity_testing.generator.calls import PlanCall
from verify.calls.methods import NAMES
from verify.certificate.certify import certify
from verify.limits import VerifierLimits, limited

FALSE_CERTIFICATES: Final = "false-certificates"
"""Name of this judge."""

VERDICTS: Final = ("refuted", "undecided", "refused", "proved")
"""``refused``: no answer to such a call at all, or of another task."""

_WAYS: Final = (
    *(("auto", "automata"),) * 3,
    ("auto", "paper"),
    ("exhaustive", "automata"),
    ("program", "automata"),
)
_PROOF: Final = "proof"
_PROOFS: Final = 0.04
"""The share of results that come with a proof file."""

_SECONDS: Final = 20.0
_SIZES: Final = (0, 1, 2, 3, 10, 50)


@dataclass(frozen=True, slots=True)
class Way:
    """A way to verify a result.

    Attributes:
        method: of ``verify``; or ``proof``: the proof of what it was made from is checked against it.
        encoding: of ``verify``.
        sizes: what is large or long for the verifier, and what it leaves out; defaults are not told.
    """

    method: str
    encoding: str
    sizes: dict[str, Any]

    def __str__(self) -> str:
        sizes = ", ".join(f"{name}={value}" for name, value in self.sizes.items())
        return f"{self.method}, {self.encoding}, limited({sizes})"


def drawn_way(dice: Random) -> Way:
    """A method, an encoding, and sizes from which on the verifier takes its ways for large tasks."""
    share = dice.choice((0, 0.1, 0.5))
    sizes = {each.name: _size(dice, each.name) for each in fields(VerifierLimits) if dice.random() < share}
    method, encoding = dice.choice(_WAYS)
    return Way(_PROOF, "automata", sizes) if dice.random() < _PROOFS else Way(method, encoding, sizes)


def _size(dice: Random, name: str) -> int | float | tuple[str, ...]:
    if name == "methods":
        return tuple(f"-{each}" for each in NAMES if dice.random() < 0.3)
    if name.endswith(("_share", "_seconds")):
        return dice.choice((0.001, 0.01, 0.5))
    if name == "weight":
        return 2 ** dice.choice((4, 10, 20, 40))
    return max(dice.choice(_SIZES), name == "states_at_once")


@dataclass(slots=True)
class FalseCertificates:
    """Presents false results for calls, and counts what becomes of them.

    Attributes:
        counts: by kind, mode, method and verdict.
        time_limit: seconds for each certificate.
    """

    time_limit: float | None = None
    counts: Counter[tuple[str, str, str, str]] = field(default_factory=Counter)

    def __call__(self, call: PlanCall) -> Disagreement | None:
        """The first false result for a call that is proved, or crashes the verifier; None: there is none."""
        dice = Random(f"forger {call.seed}")
        ways = Random(f"ways {call.seed}")
        for forgery in forgeries(call, dice):
            way = drawn_way(ways)
            try:
                verdict = self._verdict(forgery, way)
            except Exception as error:  # whatever it is, it is found
                verdict = f"{type(error).__name__}: {error}"
            if verdict in VERDICTS:
                self.counts[forgery.kind, forgery.result.mode, _named(way), verdict] += 1
            if verdict is not None and verdict not in VERDICTS[:-1]:
                return Disagreement(
                    call, {f"{forgery.kind} ({way})": f"{verdict}, but {forgery.fault}"}, FALSE_CERTIFICATES
                )
        return None

    def shows(self, call: PlanCall) -> bool:
        """True if something false is proved."""
        return self(call) is not None

    def _verdict(self, forgery: Forgery, way: Way) -> str | None:
        """Verdict on a false result; None where it can't be asked so."""
        seconds = _SECONDS if self.time_limit is None else self.time_limit
        with limited(**way.sizes):
            try:
                if way.method == _PROOF:
                    return _with_proof(forgery, seconds)
                return certify(
                    forgery.task, forgery.result, method=way.method, encoding=way.encoding, time_limit=seconds
                ).verdict
            except InputError:
                return "refused"
            except UsageError:
                return None

    def lines(self) -> Iterator[str]:
        """The counts as a table: by kind, by mode, by method."""
        yield f"{'':30}{'presented':>10}" + "".join(f"{verdict:>10}" for verdict in VERDICTS)
        for form in ("{0}", "mode {1}", "method {2}", "all"):
            found: dict[str, Counter[str]] = {}
            for key, number in sorted(self.counts.items()):
                found.setdefault(form.format(*key), Counter())[key[-1]] += number
            for label, of in found.items():
                yield f"{label:30}{of.total():>10,}" + "".join(f"{of[verdict]:>10,}" for verdict in VERDICTS)


def _named(way: Way) -> str:
    return way.method if way.encoding == "automata" else f"{way.method}, {way.encoding}"


def _with_proof(forgery: Forgery, seconds: float) -> str | None:
    """The proof of what a result was made from, checked against the result; else a proof of its own."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "proof.json"
        with suppress(SerendipityError):
            if forgery.source is not None:
                verify(*forgery.source, proof=path, time_limit=seconds)
        if not path.exists():
            verdict = verify(forgery.task, forgery.result, proof=path, time_limit=seconds).verdict
            return "proved" if path.exists() else verdict
        accepted = check_proof(path, forgery.task, forgery.result, time_limit=seconds).accepted
        return "proved" if accepted else "refuted"
