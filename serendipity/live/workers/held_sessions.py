"""Tasks and sessions that a worker has at hand, each of which a request alone is enough to make again."""

import json
import re
from collections import OrderedDict
from collections.abc import Mapping
from contextlib import chdir
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import serendipity
from serendipity.facade.call import options_from
from serendipity.facade.session import Session
from serendipity.model import Deadline, Task, UsageError

Given = Mapping[str, Any]
"""``example``; or ``domain``, ``problem``, ``human``, ``robots``; or ``agents``, ``team``, ``human``."""

_FOLDER_NAME: Final = re.compile(r"\w[\w.-]{0,59}")


class GivenTasks:
    """Reads tasks, and keeps the last few: who asks once about a task often asks again.

    Args:
        most: how many are kept.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._kept: OrderedDict[str, Task] = OrderedDict()

    def task(self, given: Given, deadline: Deadline) -> Task:
        """The task of a request.

        Raises:
            UsageError: no way of naming a task, two at once, or half of one.
            InputError: a file means nothing; files are called ``domain.pddl`` and ``problem.pddl``.
            LimitReachedError: the deadline ran out.
        """
        key = json.dumps(given, sort_keys=True)
        task = self._kept.pop(key, None)
        if task is None:
            task = _read({name: value for name, value in given.items() if value is not None}, deadline)
        self._kept[key] = task
        while len(self._kept) > self._most:
            self._kept.popitem(last=False)
        return task


def _read(given: Given, deadline: Deadline) -> Task:
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
    with TemporaryDirectory(prefix="serendipity-") as folder, chdir(folder):
        if way == "agents":
            pairs = {agent: _pair(agent, files) for agent, files in given["agents"].items()}
            team = _pair("team", given["team"], Path("superagent")) if "team" in given else None
            return serendipity.load_agents(pairs, team, human, deadline=deadline)
        if "problem" not in given or human is None:
            raise UsageError("task: with domain, expected problem and human, and robots")
        pair = _pair("", given, Path())
        return serendipity.load_pddl(*pair, human, given.get("robots", ()), deadline=deadline)


_FIELDS: Final = {
    "example": ("example", "human"),
    "domain": ("domain", "problem", "human", "robots"),
    "agents": ("agents", "team", "human"),
}
_GOES_WITH: Final = {"problem": "domain", "robots": "domain", "team": "agents"}


def _pair(agent: str, files: Given, folder: Path | None = None) -> tuple[Path, Path]:
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
    """The sessions that were used last, by id and version.

    Args:
        most: how many are held.
        tasks: reads their tasks.
    """

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
        session = Session(_moved(task, state), human_plan=state["human_plan"], **options)
        session._remind(state["known"])
        return session

    def keep(self, remembered: Remembered, session: Session) -> dict[str, Any]:
        """Hold a session as its next version; what has to be remembered of it."""
        self._held[remembered["id"]] = (remembered["version"] + 1, session)
        while len(self._held) > self._most:
            self._held.popitem(last=False)
        return stands(session)


def stands(session: Session) -> dict[str, Any]:
    """Where a session stands: the true facts, the human's goal, and what they are going to do, if known.

    ``known`` is what is left of its answers.
    """
    task = session.task
    return {
        "facts": [task.facts[fact] for fact in sorted(task.init)],
        "goal": [
            *(task.facts[fact] for fact in task.goal.positive),
            *(f"!{task.facts[fact]}" for fact in task.goal.negative),
        ],
        "human_plan": None if session.human_plan is None else list(session.human_plan),
        "known": session._remembered(),
    }


def _moved(task: Task, state: Mapping[str, Any]) -> Task:
    """The task from another state, with another goal."""
    fresh = Session(task)
    fresh.set_goal(state["goal"])
    true = frozenset(state["facts"])
    fresh.change({fact: fact in true for fact in task.facts})
    return fresh.task
