"""Helpers of any kind, scored on sealed cases, as programs import it: ``serendipity_testing.league``."""

from typing import TYPE_CHECKING, Any

from serendipity_testing import league as _home
from serendipity_testing.league import __all__ as __all__

if TYPE_CHECKING:
    from serendipity_testing.league import *  # noqa: F403


def __getattr__(name: str) -> Any:
    return getattr(_home, name)


def __dir__() -> list[str]:
    return [*__all__]
