"""What callers say to a session, checked at once."""

from collections.abc import Iterable, Mapping
from typing import Any, Final

from serendipity.facade.call import options_from
from serendipity.facade.known import whole
from serendipity.facade.planning import OF_GOALS, SessionOptions
from serendipity.model import Options, Task, UsageError
from serendipity.model.task.plans import PlanEntry, checked_entries, unknown_action
from serendipity.model.task.plans_in_time import impossible_epoch, require_epoch
from serendipity.model.task.task import canonical_name


def plain(options: Mapping[str, Any]) -> Options:
    """The plain values among a session's options.

    Raises:
        UsageError: an option is unknown or has no legal value.
    """
    others = SessionOptions.__annotations__.keys() - Options.__dataclass_fields__.keys()
    return options_from({name: value for name, value in options.items() if name not in others})


_NOT_ON_THE_WAY: Final = {"goals": None, "plans": None, **OF_GOALS, "on_improvement": None}
"""Options of ``plan`` that ``plan_anytime`` has not, each with its values that say nothing."""


def on_the_way(defaults: Mapping[str, Any], options: Mapping[str, Any]) -> dict[str, Any]:
    """The options of a session's call of ``plan_anytime``.

    Raises:
        UsageError: it is to know what only ``plan`` knows.
    """
    chosen = {name: value for name, value in defaults.items() if name != "on_improvement"} | {**options}
    for name, usual in _NOT_ON_THE_WAY.items():
        if name in chosen and chosen.pop(name) not in (usual, []):
            raise UsageError(f"{name}: goes with plan only, not with plan_anytime")
    return chosen


def entries(task: Task, names: Iterable[PlanEntry]) -> tuple[PlanEntry, ...]:
    """What may be a plan of the human's, now or later: of actions that there are, one after another.

    Raises:
        PlanError: an action is unknown, or begins in an epoch that never comes, or before another has ended.
        UsageError: they are no list of names.
    """
    found, over, busy = checked_entries(names, "human plan"), 0, task.script.busy(task.human)
    for step, entry in enumerate(found, start=1):
        epoch, said = (None, entry) if isinstance(entry, str) else entry
        name, waits = canonical_name(said), task.waits(canonical_name(said))
        if name not in task.named and not waits:
            raise unknown_action(step, name)
        if epoch is not None:
            require_epoch(step, name, epoch, waits=waits)
            if epoch <= over and not (waits and epoch <= busy):
                raise impossible_epoch(step, name, epoch, least=over + 1)
            least = 1 if waits else min(task.actions[i].duration for i in task.named[name])
            over = max(over, epoch + least - 1)
    return found


def time_of(snapshot: Mapping[str, Any]) -> tuple[int, Iterable[Mapping[str, Any]], int | None]:
    """The epochs that are over, what goes on, and what is left of the head start, if a snapshot says that.

    Raises:
        KeyError, TypeError, ValueError, UsageError: it is none.
    """
    time = snapshot.get("time", {"passed": 0, "going": ()})
    asleep = whole("asleep", time["asleep"]) if "asleep" in time else None
    return whole("passed", time["passed"]), time["going"], asleep
