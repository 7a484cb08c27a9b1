"""What a unified-planning problem calls things, and the words that a task has for them."""

import re
from collections.abc import Iterable, Mapping
from typing import Final

_ILLEGAL: Final = re.compile(r"[^\w-]")


class UniqueWords:
    """A word for each name: lower case, without blanks, different where names are.

    Args:
        names: in the order in which they choose their words.
        taken: words that are none of theirs.
    """

    def __init__(self, names: Iterable[str], taken: Iterable[str] = ()) -> None:
        used = set(taken)
        self._words: dict[str, str] = {}
        for name in names:
            if name not in self._words:
                self._words[name] = unused(legal(name), used)

    def __getitem__(self, name: str) -> str:
        return self._words[name]

    @property
    def names(self) -> Mapping[str, str]:
        """The names by their words."""
        return {word: name for name, word in self._words.items()}


def legal(name: str) -> str:
    """A name as one word, in lower case."""
    return _ILLEGAL.sub("_", name.lower()) or "_"


def unused(word: str, used: set[str]) -> str:
    """The word, or if it is used already one like it; it is used from now on."""
    candidate, number = word, 1
    while candidate in used:
        number += 1
        candidate = f"{word}_v{number}"
    used.add(candidate)
    return candidate
