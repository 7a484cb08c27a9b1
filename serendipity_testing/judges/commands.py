"""A planner as a process: PDDL in, a plan of the competitions or JSON out."""

import json
import re
import shlex
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any, Final

from serendipity.model import Deadline, SerendipityError, UsageError
from serendipity.model.numbers import exact
from serendipity.pddl.write import composite_files, composite_names
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.judges.claims import TIME_LIMIT, Proposal

_PLACES: Final = ("domain", "problem", "plan")
_STEP: Final = re.compile(r"^\s*(?:\d+(?:\.\d+)?\s*:\s*)?\(\s*([^()]*?)\s*\)", re.MULTILINE)
_NO_PLAN: Final = (10, 11, 12)
"""Exit codes of Fast Downward's that say that there is no plan; others use them, too."""


def program_words(text: str, option: str) -> list[str]:
    """The words of a command line, as a shell splits it; there is no shell.

    Raises:
        UsageError: it can't be split, or there is no such program; ``option`` is what it was given for.
    """
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise UsageError(f"{option}: {error}") from None
    if not words or shutil.which(words[0]) is None:
        raise UsageError(f"{option}: there is no program '{''.join(words[:1])}'")
    return words


class Command:
    """A command line that plans.

    ``{domain}``, ``{problem}`` and ``{plan}`` in it stand for files; without any of them all three are put
    at its end.  It is asked for the best plan.  What it writes to the plan's file (``plan``, or the last of
    ``plan.1``, ``plan.2`` ...), else to standard output, is read: lines ``(action)``, or a JSON object
    with a ``status`` and a ``plan``, a list of actions' names or of objects with an ``action``.
    Neither, and exit code 0, 10, 11 or 12, says that there is no plan.

    Args:
        text: the command line, as a shell splits it; there is no shell.

    Raises:
        UsageError: there is no such program.
    """

    def __init__(self, text: str) -> None:
        self._words = program_words(text, "judge-command")
        if not any(f"{{{place}}}" in word for word in self._words for place in _PLACES):
            self._words += [f"{{{place}}}" for place in _PLACES]

    def __call__(self, call: PlanCall, deadline: Deadline) -> Proposal:
        """Its claim.

        Raises:
            SerendipityError: it fails, or what it writes can't be read.
        """
        files = composite_files(call.task, exact(call.options.get("discount", "0"), "discount"))
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch)
            paths = {"domain": folder / "domain.pddl", "problem": folder / "problem.pddl"}
            for path, text in zip(paths.values(), (files.domain, files.problem), strict=True):
                path.write_text(text, encoding="utf-8")
            places = {**paths, "plan": folder / "plan"}
            try:
                done = subprocess.run(
                    [_filled(word, places) for word in self._words],
                    cwd=folder,
                    capture_output=True,
                    text=True,
                    errors="replace",
                    check=False,
                    timeout=deadline.left(),
                    stdin=subprocess.DEVNULL,
                )
            except subprocess.TimeoutExpired:
                return Proposal("unknown", words=TIME_LIMIT)
            written = _written(folder)
        names = composite_names(call.task)
        claim = _read(done.stdout if written is None else written, names, empty=written is not None)
        if claim is not None:
            return claim
        if done.returncode in (0, *_NO_PLAN):
            return Proposal("infeasible")
        last = " ".join((done.stderr or done.stdout).splitlines()[-3:])
        raise SerendipityError(f"exit code {done.returncode}: {last:.200}")


def _filled(word: str, places: dict[str, Path]) -> str:
    for place, path in places.items():
        word = word.replace(f"{{{place}}}", str(path))
    return word


def _written(folder: Path) -> str | None:
    """The text of the last plan that it wrote."""
    single = folder / "plan"
    numbered = [path for path in folder.glob("plan.*") if path.suffix[1:].isdigit()]
    last = max(numbered, key=lambda path: int(path.suffix[1:]), default=single)
    return last.read_text(encoding="utf-8", errors="replace") if last.exists() else None


def _read(text: str, names: list[str], *, empty: bool) -> Proposal | None:
    """The claim in a text; None if there is none.

    Args:
        text: what was written.
        names: of the task's actions, as they were written.
        empty: whether no lines are a plan without actions.
    """
    if text.lstrip().startswith("{"):
        return _from_json(text, names)
    steps = _STEP.findall("\n".join(line.partition(";")[0] for line in text.splitlines()))
    return Proposal("optimal", _ids(steps, names)) if steps or empty else None


def _from_json(text: str, names: list[str]) -> Proposal:
    try:
        data: Any = json.loads(text)
        steps = data["plan"]
        status = data.get("status", "infeasible" if steps is None else "optimal")
        if steps is None:
            return Proposal(str(status))
        words = [step if isinstance(step, str) else step["action"] for step in steps]
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise SerendipityError(f"its JSON can't be read: {type(error).__name__}: {error}") from None
    return Proposal(str(status), _ids(words, names))


def _ids(steps: list[str], names: list[str]) -> tuple[int, ...]:
    ids = {name: i for i, name in enumerate(names)}
    found = []
    for step in steps:
        name = step.strip().lower()
        if name not in ids:
            raise SerendipityError(f"its plan has '{step}', which is no action of the problem")
        found.append(ids[name])
    return tuple(found)
