"""The engine's place in the factories of unified-planning."""

from typing import Final

from unified_planning import environment
from unified_planning.engines import factory

ENGINE: Final = "serendipity"
"""The name of the engine."""

_MODULE: Final = "serendipity.up.engine"
_CLASS: Final = "SerendipityEngine"


def register() -> None:
    """Make the engine known to the factory that is in use, if there is one, and to those to come.

    Where ``up.ini`` names it, it is the factory that imports this: so none is made here.
    """
    factory.DEFAULT_ENGINES[ENGINE] = (_MODULE, _CLASS)
    if ENGINE not in factory.DEFAULT_ENGINES_PREFERENCE_LIST:
        factory.DEFAULT_ENGINES_PREFERENCE_LIST.append(ENGINE)
    current = environment.GLOBAL_ENVIRONMENT
    if current is not None and ENGINE not in current.factory.engines:
        current.factory.add_engine(ENGINE, _MODULE, _CLASS)
