"""A disagreement as files: the task in PDDL and the command lines that show it."""

import shlex
from pathlib import Path

from serendipity.crosscheck.calls import PlanCall
from serendipity.crosscheck.judges import Disagreement
from serendipity.pddl.write import write_pddl


def write_case(found: Disagreement, folder: Path) -> Path:
    """Write ``folder`` (task, ``commands.txt``); returns the file with the commands.

    Raises:
        OSError: it can't be written.
    """
    write_pddl(found.call.task, folder)
    commands = folder / "commands.txt"
    lines = [f"# {judge}: {words}" for judge, words in found.said.items()]
    lines += [
        command_line(found.call, folder, command) for command in ("plan", "solve", "solve --encoding paper")
    ]
    commands.write_text("\n".join([*lines, ""]), encoding="utf-8")
    return commands


def command_line(call: PlanCall, folder: Path, command: str = "plan") -> str:
    """The command line that makes the call on the task written to ``folder``."""
    words = ["serendipity", *command.split(), str(folder), "--human", call.task.agents[call.task.human]]
    for name, value in call.options.items():
        words.append(f"--{name.replace('_', '-')}")
        if name != "keep_prefix":
            words.append(value)
    return shlex.join(words)
