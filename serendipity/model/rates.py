"""Probabilities by name, as command lines write them: ``fail=0.1,drop=0.01``."""

from dataclasses import fields
from typing import Self

from serendipity.model.errors import UsageError
from serendipity.model.numbers import exact


class Rates:
    """A dataclass whose fields are probabilities (or a UsageError), 0 by default."""

    __slots__ = ()

    def __post_init__(self) -> None:
        for name in self._names():
            object.__setattr__(self, name, probability(getattr(self, name), name))

    @classmethod
    def parse(cls, text: str) -> Self:
        """Those that a text names; the others are 0.

        Raises:
            UsageError: it is of another form.
        """
        names, found = cls._names(), dict[str, str]()
        for part in text.replace(" ", "").split(","):
            name, equals, value = part.partition("=")
            if not equals or name not in names or name in found:
                form = ",".join(f"{name}=P" for name in names)
                raise UsageError(f"{cls.__name__.lower()}: expected some of {form}, got '{text}'")
            found[name] = value
        return cls(**found)

    @classmethod
    def _names(cls) -> list[str]:
        return [field.name for field in fields(cls)]  # type: ignore[arg-type]


def probability(value: float | str, what: str) -> float:
    """A number from 0 to 1, or a UsageError."""
    found = exact(value, what)
    if not 0 <= found <= 1:
        raise UsageError(f"{what}: expected a probability from 0 to 1, got {float(found):g}")
    return float(found)
