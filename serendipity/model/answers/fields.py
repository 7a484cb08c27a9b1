"""Reading the parts of a JSON object one by one, each of one type."""

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

from serendipity.model.errors import UsageError
from serendipity.model.numbers import MOST_IN_RESULTS, Figure, exact

T = TypeVar("T")


class MalformedError(Exception):
    """Something that a part of a file has to say is missing, or of another form; its text says what."""


class Fields:
    """The fields of a JSON object.

    Args:
        value: what should be an object.
        whole: what errors call the object.
        where: what errors about one of its fields begin with.

    Raises:
        MalformedError: it is no object.
    """

    def __init__(self, value: Any, whole: str, where: str) -> None:
        if not isinstance(value, Mapping):
            raise MalformedError(f"{whole} is not an object")
        self._data = value
        self._where = where

    def get(self, key: str, read: Callable[[Any], T | None]) -> T:
        """What ``read`` makes of a field, which is not None.

        Raises:
            MalformedError: naming the field; so do all other methods.
        """
        value = read(self._data.get(key))
        if value is None:
            raise MalformedError(f"{self._where}: '{key}' is missing or of another type")
        return value

    def raw(self, key: str) -> Any:
        """The value as it stands there."""
        if key not in self._data:
            raise MalformedError(f"{self._where}: '{key}' is missing")
        return self._data[key]

    def text(self, key: str) -> str:
        """A text."""
        return self.get(key, lambda value: value if isinstance(value, str) else None)

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of texts."""
        return self.get(key, names)

    def flag(self, key: str) -> bool:
        """True or false."""
        return self.get(key, lambda value: value if isinstance(value, bool) else None)

    def number(self, key: str) -> float:
        """A finite number of at least 0."""
        return self.get(key, lambda value: None if (found := finite(value)) is None or found < 0 else found)

    def objects(self, key: str) -> "list[Fields]":
        """A list of objects."""
        items = self.get(key, lambda value: value if isinstance(value, list) else None)
        return [Fields(item, key, f"{self._where}.{key}") for item in items]

    def optional(self, key: str, read: Callable[[str], T]) -> T | None:
        """The field as ``read`` reads it, or None where it is null."""
        return None if self.raw(key) is None else read(key)


def finite(value: Any) -> float | None:
    """A JSON number as a float; None where it is none, or has no finite float."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = value if isinstance(value, Figure) else float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def names(value: Any) -> tuple[str, ...] | None:
    """A list of texts; None where it is none."""
    if not isinstance(value, list | tuple) or not all(isinstance(name, str) for name in value):
        return None
    return tuple(value)


def exact_texts(value: Any) -> Any:
    """Texts of the figures in a JSON value whose floats do not say it all, in its shape; None without any."""
    if isinstance(value, Figure):
        return str(value.exact)
    texts = {str(key): exact_texts(part) for key, part in _parts(value)}
    return {key: text for key, text in texts.items() if text is not None} or None


def with_exact(value: Any, texts: Any, where: str) -> Any:
    """A JSON value with the exact figures that :func:`exact_texts` made of it.

    Raises:
        MalformedError: a text is no rational, or that of another float.
    """
    if isinstance(texts, dict):
        parts = {str(key): part for key, part in _parts(value)}
        for key, text in texts.items():
            parts[key] = with_exact(parts.get(key), text, f"{where}.{key}")
        return list(parts.values()) if isinstance(value, list) else parts
    number = finite(value)
    try:
        found = Figure(exact(texts, where, MOST_IN_RESULTS)) if isinstance(texts, str) else None
    except UsageError as error:
        raise MalformedError(str(error)) from None
    if number is None or found != number:
        raise MalformedError(f"{where}: expected the exact text of {value!r:.50}, got {texts!r:.50}")
    return found


def _parts(value: Any) -> Iterable[tuple[Any, Any]]:
    if isinstance(value, dict):
        return value.items()
    return enumerate(value) if isinstance(value, list | tuple) else ()
