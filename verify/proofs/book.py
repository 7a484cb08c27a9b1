"""Proof files as a whole: what is written down for each program, and read again."""

import gzip
import json
from collections.abc import Mapping, Sequence
from typing import Any, Final

from verify.base.undecided import UndecidedError
from verify.proofs.checker import SCHEMA

Entry = dict[str, Any]
"""A program of a proof file, as JSON has it."""

MADE_AGAIN: Final = ("name", "unit", "columns", "objective", "rows")
"""What of an entry follows from the question; the rest says why the program is refuted."""


class ProofWriter:
    """Collects the programs that a certificate rests on, refuted."""

    def __init__(self) -> None:
        self.programs: list[Entry] = []

    def to_dict(self, claim: str, encoding: str) -> dict[str, Any]:
        """The JSON object of a proof file: the claim that it proves, and the encoding of its programs."""
        return {"schema": SCHEMA, "claim": claim, "encoding": encoding, "programs": self.programs}


class ProofReader:
    """The programs of a proof that was accepted, in the order in which a certificate asks for them."""

    def __init__(self, programs: Sequence[Entry]) -> None:
        self._programs = list(programs)
        self._read = 0

    def take(self) -> Entry:
        """The next program, or raise an UndecidedError."""
        if self._read == len(self._programs):
            raise UndecidedError("a program is missing")
        self._read += 1
        return self._programs[self._read - 1]

    @property
    def left(self) -> Sequence[Entry]:
        """The programs that nobody has asked for."""
        return self._programs[self._read :]


def require_same(entry: Entry, made: Mapping[str, Any]) -> None:
    """Return if an entry is the program that was made again, or raise an UndecidedError."""
    for name in MADE_AGAIN:
        if entry.get(name) != made[name]:
            raise UndecidedError(
                f"program {entry.get('name')!r}: {_difference(name, entry.get(name), made[name])}"
            )


def _difference(name: str, said: Any, made: Any) -> str:
    if not isinstance(said, list) or len(said) != len(made):
        return f"{name}: not those of the claim" if isinstance(made, list) else f"{name}: expected {made!r}"
    place = next(k for k, (one, other) in enumerate(zip(said, made, strict=True)) if one != other)
    return f"{name}: number {place} is not that of the claim"


def packed(data: Mapping[str, Any], *, small: bool) -> bytes:
    """A proof file's content; ``small``: packed by gzip, and equal proofs are equal files."""
    text = json.dumps(data, separators=(",", ":")).encode() + b"\n"
    return gzip.compress(text, mtime=0) if small else text
