"""A disagreement as files: the task in PDDL and the command lines that show it."""

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from serendipity.model.numbers import exact
from serendipity.model.task.plans import PlanEntry
from serendipity.pddl.write import composite_files, task_files
from serendipity.writing.together import write_together
from serendipity_testing.disagreement import Disagreement
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.in_python import told_with_people

PLAN: Final = "plan.txt"
"""File of the human plan that is given."""


def write_case(
    found: Disagreement, folder: Path, outside: Sequence[str] = (), *, again: str | None = None
) -> Path:
    """Write ``folder`` (task, ``plan.txt`` where a plan is given, ``commands.txt``) whole; returns the last.

    Args:
        outside: the words that name judges from outside: then what they were given is written, too.
        again: the command that found it; None is the one of ``crosscheck``, where a seed is known.

    Raises:
        OSError: it can't be written.
    """
    call = found.call
    has_files = not call.task.script.people  # whose plans are no part of PDDL
    texts = {
        folder / agent / name: text
        for agent, pair in (task_files(call.task).items() if has_files else ())
        for name, text in zip(("domain.pddl", "problem.pddl"), pair, strict=True)
    }
    if call.human_plan is not None:
        texts[folder / PLAN] = "".join(map(_line, call.human_plan))
    if outside:
        files = composite_files(call.task, exact(call.options.get("discount", "0"), "discount"))
        texts |= {folder / "joint-domain.pddl": files.domain, folder / "joint-problem.pddl": files.problem}
    lines = [f"# {judge}: {words}" for judge, words in found.said.items()]
    if len(call.task.named) < len(call.task.actions):
        lines.append("# variants of one action are written under names of their own, which may hide it")
    if not has_files:
        lines += [f"# {line}" for line in told_with_people(call.task).splitlines()]
        lines.append(f"# asked: {shlex.join(call.command_words())}")
    if again is not None:
        lines.append(again)
    elif call.seed is not None:
        lines.append(
            shlex.join(["serendipity", *f"crosscheck --count 1 --seed {call.seed}".split(), *outside])
        )
    commands = ("plan", "solve", "solve --encoding paper") if has_files else ()
    lines += [command_line(call, folder, command) for command in commands]
    told = folder / "commands.txt"
    texts[told] = "\n".join([*lines, ""])
    write_together({path: text.encode() for path, text in texts.items()})
    return told


def command_line(call: PlanCall, folder: Path, command: str = "plan") -> str:
    """The command line that makes the call on the task written to ``folder``."""
    words = ["serendipity", *command.split(), str(folder), "--human", call.task.agents[call.task.human]]
    words += call.command_words()
    if call.human_plan is not None:
        words += ["--human-plan", str(folder / PLAN)]
    return shlex.join(words)


def _line(entry: PlanEntry) -> str:
    """A line of a plan: an action's name as :func:`write_pddl` writes it, in time when it begins."""
    if isinstance(entry, str):
        return f"{entry.replace(' ', '_')}\n"
    epoch, name = entry
    return f"{epoch - 1}: ({name.replace(' ', '_')})\n"
