"""What participants read and are asked: the study's own texts where its folder has them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from serendipity.model import InputError

_CONSENT: Final = (
    "You will move a person through a building, in a few rounds of some minutes each. A robot may be about.",
    "What you do is recorded with its time, together with your answers to a few questions: under a number, "
    "without your name. It stays on this computer, in the hands of those who run the study.",
    "Taking part is voluntary. You can stop at any time by closing the page, without giving a reason, and "
    "ask for your record to be deleted; tell them your number then.",
)

_QUESTIONS: Final = (
    "I understood what the robot was doing.",
    "The robot helped me.",
    "The robot got in my way.",
    "I would work with this robot again.",
)
"""Each answered from 1, not at all, to 7, very much."""

MOST: Final = 7


@dataclass(frozen=True, slots=True)
class Texts:
    """The texts of a study.

    Attributes:
        consent: paragraphs.
        questions: asked after each round, from 1 to ``MOST``.
    """

    consent: tuple[str, ...]
    questions: tuple[str, ...]


def texts(folder: Path) -> Texts:
    """The texts of a folder: ``consent.txt`` and ``questions.txt``, a paragraph or question a line.

    Raises:
        InputError: one can't be read, or says nothing.
    """
    consent = _lines(folder / "consent.txt") or _CONSENT
    return Texts(consent, _lines(folder / "questions.txt") or _QUESTIONS)


def _lines(file: Path) -> tuple[str, ...]:
    if not file.exists():
        return ()
    try:
        lines = file.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise InputError("expected a text in UTF-8", file) from None
    except OSError as error:
        raise InputError(f"can't be read: {error.strerror}", file) from None
    found = tuple(line.strip() for line in lines if line.strip())
    if not found:
        raise InputError("expected at least one line of text", file)
    return found
