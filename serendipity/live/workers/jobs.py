"""What a worker can be asked for: JSON in, JSON out."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

import serendipity
from serendipity.facade.call import options_from
from serendipity.facade.session import Session
from serendipity.live.workers.held_sessions import GivenTasks, HeldSessions
from serendipity.model import Deadline, Result, UsageError

Given = Mapping[str, Any]
Answers = Iterator["dict[str, Any] | State"]


class State(dict[str, Any]):
    """Where a call has left a session: for the server, not for who asked."""


Job = Callable[["WorkerState", Given, Deadline], Answers]

_TASKS: Final = 8
_SESSIONS: Final = 8


class WorkerState:
    """The state of a worker between jobs, to be quicker; nothing depends on it."""

    def __init__(self) -> None:
        self.tasks = GivenTasks(_TASKS)
        self.sessions = HeldSessions(_SESSIONS, self.tasks)
        self.calling: Session | None = None

    def cancel(self) -> None:
        """End the call of a session that is under way, from another thread."""
        if self.calling is not None:
            self.calling.cancel()


def plan(worker: WorkerState, asked: Given, deadline: Deadline) -> Answers:
    """One answer, as ``serendipity.plan`` gives it."""
    task = worker.tasks.task(asked["task"], deadline)
    yield serendipity.plan(task, deadline=deadline, **_call(asked)).to_dict()


def plan_anytime(worker: WorkerState, asked: Given, deadline: Deadline) -> Answers:
    """Answers as they get better; the last one stands."""
    task = worker.tasks.task(asked["task"], deadline)
    for better in serendipity.plan_anytime(task, deadline=deadline, **_call(asked)):
        yield better.to_dict()


def verify(worker: WorkerState, asked: Given, deadline: Deadline) -> Answers:
    """A certificate for a result."""
    result = Result.from_dict(asked["result"])
    task = worker.tasks.task(asked["task"], deadline)
    how = {name: asked[name] for name in ("solver", "encoding", "method") if asked.get(name) is not None}
    yield serendipity.verify(task, result, deadline=deadline, **how).to_dict()


def session(worker: WorkerState, asked: Given, deadline: Deadline) -> Answers:
    """One call of a session; before the answers comes nothing, behind them where it stands now.

    The request says where it stood before, so that any worker can go on with it.
    """
    held = worker.calling = worker.sessions.session(asked["session"], deadline)
    call, given = asked["call"], asked["given"]
    if call == "plan":
        yield held.plan(deadline=deadline, **_options(given)).to_dict()
    elif call == "plan_anytime":
        for better in held.plan_anytime(deadline=deadline, **_options(given)):
            yield better.to_dict()
    elif call == "execute":
        held.execute(given["actions"])
    elif call == "change":
        held.change(given["facts"])
    elif call == "set_goal":
        held.set_goal(given["goal"])
    worker.calling = None
    yield State(worker.sessions.keep(asked["session"], held))


JOBS: Final[dict[str, Job]] = {
    "plan": plan,
    "plan_anytime": plan_anytime,
    "verify": verify,
    "session": session,
}


def _call(asked: Given) -> dict[str, Any]:
    """Keyword arguments of a planning call."""
    more = {name: asked.get(name) for name in ("human_plan", "goals", "observed", "beta")}
    options = _options(asked)
    for name in ("observed", "beta"):
        if more[name] is not None and more["goals"] is None:
            raise UsageError(f"{name}: goes with goals only")
    return {**options, **{name: value for name, value in more.items() if value is not None}}


def _options(asked: Given) -> dict[str, Any]:
    """Options by name; what is no option of a plan is refused here, since calls have arguments beside them.

    Raises:
        UsageError: there is no such option, or it has no such value.
    """
    options: dict[str, Any] = asked["options"]
    options_from(dict(options))
    return options
