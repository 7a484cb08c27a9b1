"""Jobs of a worker, JSON in, JSON out; and the tasks and sessions that it has at hand for them."""

import json
import re
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping
from contextlib import chdir, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import serendipity
from serendipity.facade.call import options_from
from serendipity.facade.certify import require_answer
from serendipity.facade.session import Session
from serendipity.model import Deadline, Result, Task, UsageError

GivenTask = Mapping[str, Any]
"""``example``; or ``domain``, ``problem``, ``human``, ``robots``; or ``agents``, ``team``, ``human``."""

_FOLDER_NAME: Final = re.compile(r"\w[\w.-]{0,59}")


class GivenTasks:
    """Reads tasks, and keeps the last few: who asks once about a task often asks again."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._kept: OrderedDict[str, Task] = OrderedDict()

    def task(self, given: GivenTask, deadline: Deadline) -> Task:
        """The task of a request.

        Raises:
            UsageError: no way of naming a task, two at once, or half of one.
            InputError: a file means nothing; files are called ``domain.pddl`` and ``problem.pddl``.
            LimitReachedError: the deadline ran out.
        """
        key = json.dumps(given)  # agents are in the order of their files
        task = self._kept.pop(key, None)
        if task is None:
            task = _read({name: value for name, value in given.items() if value is not None}, deadline)
        self._kept[key] = task
        while len(self._kept) > self._most:
            self._kept.popitem(last=False)
        return task


def _read(given: GivenTask, deadline: Deadline) -> Task:
    ways = [name for name in ("example", "domain", "agents") if name in given]
    if len(ways) != 1:
        got = "none" if not ways else "more than one"
        raise UsageError(f"task: expected one of example, domain and problem, agents; got {got}")
    (way,) = ways
    fits = _FIELDS[way]
    for name in given:
        if name not in fits:
            raise UsageError(f"task: {name}: goes with {_GOES_WITH[name]} only")
    human: str | None = given.get("human")
    if way == "example":
        task = serendipity.example(given["example"], deadline=deadline)
        return task if human is None else task.with_human(human)
    with _written(given) as pairs:
        if way == "agents":
            team = pairs.pop(_TEAM, None)
            return serendipity.load_agents(pairs, team, human, deadline=deadline)
        if human is None:
            raise UsageError(_WITH_DOMAIN)
        return serendipity.load_pddl(*pairs[""], human, given.get("robots", ()), deadline=deadline)


_TEAM: Final = "superagent"
"""The folder of the team's files."""
_WITH_DOMAIN: Final = "task: with domain, expected problem and human, and robots"


@contextmanager
def _written(given: GivenTask) -> Iterator[dict[str, tuple[Path, Path]]]:
    """The files of a task in a folder of their own, by agent; none of an example."""
    with TemporaryDirectory(prefix="serendipity-") as folder, chdir(folder):
        pairs = {agent: _pair(agent, files) for agent, files in (given.get("agents") or {}).items()}
        if given.get("team") is not None:
            pairs[_TEAM] = _pair("team", given["team"], Path(_TEAM))
        if given.get("domain") is not None:
            if given.get("problem") is None:
                raise UsageError(_WITH_DOMAIN)
            pairs[""] = _pair("", given, Path())
        yield pairs


_FIELDS: Final = {
    "example": ("example", "human"),
    "domain": ("domain", "problem", "human", "robots"),
    "agents": ("agents", "team", "human"),
}
_GOES_WITH: Final = {"problem": "domain", "robots": "domain", "team": "agents"}


def _pair(agent: str, files: GivenTask, folder: Path | None = None) -> tuple[Path, Path]:
    """The two texts as files; folders are relative, so that errors name what the request names."""
    if folder is None:
        if not _FOLDER_NAME.fullmatch(agent):
            raise UsageError(f"agents: expected the name of an agent, got {agent!r:.50}")
        folder = Path(agent)
    folder.mkdir(exist_ok=True)
    pair = folder / "domain.pddl", folder / "problem.pddl"
    for path, name in zip(pair, ("domain", "problem"), strict=True):
        path.write_bytes(files[name].encode("utf-8", "surrogatepass"))
    return pair


Remembered = Mapping[str, Any]
"""``id`` and ``version``; ``begun``, the request that began it; ``state``, as :meth:`HeldSessions.keep`
has it, or None at the beginning."""


class HeldSessions:
    """The sessions that were used last, by id and version."""

    def __init__(self, most: int, tasks: GivenTasks) -> None:
        self._most = most
        self._tasks = tasks
        self._held: OrderedDict[str, tuple[int, Session]] = OrderedDict()

    def session(self, remembered: Remembered, deadline: Deadline) -> Session:
        """A session as it stands; the one that is held is taken out, in case that what comes fails halfway.

        Raises:
            SerendipityError: it is new, and its task or its options are wrong.
        """
        version, held = self._held.pop(remembered["id"], (None, None))
        if held is not None and version == remembered["version"]:
            return held
        begun = remembered["begun"]
        task = self._tasks.task(begun["task"], deadline)
        options = begun["options"]
        options_from(dict(options))
        state = remembered["state"]
        if state is None:
            return Session(task, human_plan=begun["human_plan"], **options)
        return Session.restore(task, state)

    def keep(self, remembered: Remembered, session: Session) -> dict[str, Any]:
        """Hold a session as its next version; what has to be remembered of it."""
        self._held[remembered["id"]] = (remembered["version"] + 1, session)
        while len(self._held) > self._most:
            self._held.popitem(last=False)
        return session.snapshot()


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


def explain(worker: WorkerState, asked: Given, deadline: Deadline) -> Answers:
    """Why an answer is as it is; one over scenarios is explained as a policy."""
    task = worker.tasks.task(asked["task"], deadline)
    result = None if asked["result"] is None else Result.from_dict(asked["result"])
    if result is not None:
        require_answer(task, result, "result", deadline)
    if result is not None and len(result.goals or ()) > 1 and not _call(asked):
        yield serendipity.explain_policy(task, result, deadline=deadline).to_dict()
        return
    yield serendipity.explain(task, result, deadline=deadline, **_call(asked)).to_dict()


def check_task(worker: WorkerState, asked: Given, deadline: Deadline) -> Answers:
    """What is wrong with a task."""
    task = worker.tasks.task(asked["task"], deadline)
    with _written(asked["task"]) as pairs:
        yield serendipity.check_task(task, [*pairs.values()], deadline=deadline).to_dict()


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
    "explain": explain,
    "check_task": check_task,
    "session": session,
}


def _call(asked: Given) -> dict[str, Any]:
    """Keyword arguments of a planning call."""
    more = {name: asked.get(name) for name in ("human_plan", "goals", "observed", "beta", "noise", "plans")}
    return {**_options(asked), **{name: value for name, value in more.items() if value is not None}}


def _options(asked: Given) -> dict[str, Any]:
    """Options of a plan by name; others are refused here (UsageError): calls have arguments beside them."""
    options: dict[str, Any] = asked["options"]
    options_from(dict(options))
    return options
