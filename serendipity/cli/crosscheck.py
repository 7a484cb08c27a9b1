"""``serendipity crosscheck``: search, integer programs and certificates on the same calls."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer

from serendipity.cli import naming
from serendipity.cli.exit_codes import ExitCode
from serendipity.model import UsageError


def crosscheck(
    files: naming.Files = None,
    human: naming.Human = None,
    robot: naming.Robots = None,
    agent: naming.Agents = None,
    team: naming.Team = None,
    example: naming.Example = None,
    count: Annotated[int, typer.Option(min=1, help="Random calls to check.", metavar="N")] = 100,
    seed: Annotated[int, typer.Option(help="Of the first random call.", metavar="S")] = 0,
    judges: Annotated[
        str, typer.Option(help="Who answers, separated by commas: search, automata, paper, cbc.")
    ] = "search,automata,paper",
    folder: Annotated[
        Path, typer.Option("-o", "--output", help="Where a disagreement is written.", metavar="DIR")
    ] = Path("disagreement"),
) -> int:
    """Check that independent methods agree: on random tasks, or on one task in every mode."""
    from serendipity.crosscheck import JUDGES, PlanCall, compare, random_call, shrink, write_case

    chosen = {}
    for name in judges.split(","):
        if name not in JUDGES:
            raise UsageError(f"judges: expected some of {', '.join(JUDGES)}, got '{name}'")
        chosen[name] = JUDGES[name]

    def calls() -> Iterator[PlanCall]:
        if not files and not agent and example is None:
            yield from (random_call(seed + k) for k in range(count))
            return
        name = naming.TaskName(
            tuple(files or ()), human, tuple(robot or ()), tuple(agent or ()), team=team, example=example
        )
        task = name.load()
        for mode in ("individual", "serendipity", "communication", "composite"):
            for discount in ("0", "0.5", "0.9"):
                yield PlanCall(task, {"mode": mode, "discount": discount})

    checked = 0
    for call in calls():
        found = compare(call, chosen)
        if found is not None:
            smallest = shrink(found.call, lambda smaller: compare(smaller, chosen) is not None)
            found = compare(smallest, chosen) or found
            commands = write_case(found, folder)
            sys.stdout.write(
                f"after {checked} calls without, a disagreement: {found}\nreproduce: {commands}\n"
            )
            return ExitCode.REFUTED
        checked += 1
    sys.stdout.write(f"{checked} calls, {', '.join(chosen)}: 0 disagreements\n")
    return ExitCode.ANSWERED
