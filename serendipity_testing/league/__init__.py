"""The yardstick: helpers of any kind, on sealed cases, against the proved optimum of what they know."""

from collections.abc import Callable, Iterable
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

from serendipity.model import Task, UsageError
from serendipity.model.arguments import TEXT, WHOLE, expect
from serendipity.model.options import limit_of
from serendipity_testing.league.cases import Case, Scenario, season
from serendipity_testing.league.helpers import SHIPPED, by_function, helper_named
from serendipity_testing.league.play import played
from serendipity_testing.league.protocol import Helper
from serendipity_testing.league.scores import League, Score, Standing, score

if TYPE_CHECKING:
    from serendipity_testing.league.environment import CaseEnv

__all__ = [
    "SHIPPED",
    "Case",
    "CaseEnv",
    "League",
    "Scenario",
    "Score",
    "Standing",
    "league",
    "season",
]


def league(
    name: str,
    helpers: Iterable[str | Callable[[dict[str, Any]], Any]] = SHIPPED,
    *,
    families: Iterable[str] | None = None,
    cases: int = 10,
    tasks: Iterable[Task] = (),
    deadline: float | None = 0.1,
    on_progress: Callable[[int, int], None] | None = None,
) -> League:
    """Let helpers play the cases of a season.

    Args:
        name: of the season; who knows it can play it again.
        helpers: names, as ``serendipity league`` takes them, or functions of an observation.
        families: some of ``buildings``, ``homes`` and ``competition``; None: all, but none beside ``tasks``.
        cases: how many of each.
        tasks: others, each a case by itself.
        deadline: seconds for each decision; without one in time robots wait.
        on_progress: called with the number of cases that are over, and of all.

    Raises:
        UsageError: an argument is wrong, or there is no such helper.
    """
    expect(TEXT, name=name)
    expect(WHOLE, cases=cases)
    seconds = None if deadline is None else limit_of("deadline", deadline, "seconds")
    with ExitStack() as stack:
        players: dict[str, Helper] = {}
        for one in helpers:
            helper = helper_named(one) if isinstance(one, str) else by_function(one)
            stack.callback(helper.close)
            if players.setdefault(helper.name, helper) is not helper:
                raise UsageError(f"helpers: two are named '{helper.name:.50}'")
        rows: list[Score] = []
        chosen = list(season(name, families, cases, tasks))
        for number, case in enumerate(chosen, start=1):
            rows += [score(one.name, case, list(played(case, one, seconds))) for one in players.values()]
            if on_progress is not None:
                on_progress(number, len(chosen))
        return League(name, seconds, tuple(sorted(rows, key=lambda row: row.helper)))


def __getattr__(name: str) -> Any:
    if name == "CaseEnv":
        from serendipity_testing.league.environment import CaseEnv

        return CaseEnv
    raise AttributeError(f"module 'serendipity_testing.league' has no attribute {name!r}")
