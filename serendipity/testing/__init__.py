"""The kit that planners are tested with, as programs import it: ``serendipity_testing``, beside the core.

What is public loads when it is first used; what draws at random with hypothesis needs the extra ``testing``::

    from serendipity.testing import best, check_planner, task, tasks
"""

from typing import TYPE_CHECKING, Any

import serendipity_testing
from serendipity_testing import __all__ as __all__

if TYPE_CHECKING:
    from serendipity_testing import *  # noqa: F403


def __getattr__(name: str) -> Any:
    return getattr(serendipity_testing, name)


def __dir__() -> list[str]:
    return dir(serendipity_testing)
