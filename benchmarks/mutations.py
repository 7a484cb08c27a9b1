"""Mutation proof of the verifier: doctored results, and bugs planted in the planner.

    python -m benchmarks.mutations [--count N] [--quick]

Prints two Markdown tables.  The first refutes results that were doctored, each with the claim
(and the rule) that falls; the second plants bugs in the planner, one at a time, and certifies its
answers to a corpus of N calls until one is refuted.  ``--quick`` leaves the second one out.
"""

import sys
from collections import Counter

import typer

from serendipity.evaluation.measuring.tables import as_markdown
from serendipity.model import InputError
from serendipity.model.telling import Grid, Line
from tests.verify.doctored import DOCTORED, Doctored
from tests.verify.planted import PLANTED
from tests.verify.planted.judge import fate
from verify.certificate.certify import certify
from verify.rules import check


def main(count: int = 1000, quick: bool = False) -> None:
    """Print both tables."""
    print(as_markdown(_doctored()), flush=True)
    if not quick:
        print(as_markdown(_planted(count)), end="")


def _doctored() -> list[Line | Grid]:
    rows = [(name, *_refutation(doctored)) for name, doctored in DOCTORED.items()]
    right = sum(fine for *_, fine in rows)
    shown = [
        (name, f"{claim}{'' if fine else ' (expected another)'}", _cell(reason))
        for name, claim, reason, fine in rows
    ]
    told = Line(f"{len(rows)} doctored results, {right} refuted for the right reason.")
    return [told, Grid(("doctored", "refuted as", "because"), shown)]


def _refutation(doctored: Doctored) -> tuple[str, str, bool]:
    """The claim that falls, the reason, and True where it is the one that should."""
    task, result = doctored.make()
    rule = check(task, result).first if doctored.rule else None
    named = rule is not None and rule.rule == doctored.rule
    try:
        refuted = certify(task, result).refuted
    except InputError as error:
        return f"bad input, rule {doctored.rule}", error.message, named
    if refuted is None:
        return "-", "not refuted", False
    claim = refuted.claim if rule is None else f"{refuted.claim}, rule {rule.rule}"
    return claim, refuted.reason, refuted.claim == doctored.claim and (named or doctored.rule is None)


def _planted(count: int) -> list[Line | Grid]:
    clean = fate(None, count)
    rows = []
    for bug in PLANTED:
        seen = fate(bug, count)
        reason = seen.reason or bug.survives or "not explained"
        rows.append((bug.role, bug.what, seen.how, str(seen.calls), _cell(reason)))
        print(f"{bug.what}: {seen.how}", file=sys.stderr, flush=True)
    fates = ", ".join(f"{how} {number}" for how, number in Counter(row[2] for row in rows).most_common())
    return [
        Line(f"Without a bug: {clean.calls} calls, {clean.how}. {len(PLANTED)} bugs: {fates}."),
        Grid(("role", "bug", "fate", "calls", "certificate, error, or why it survives"), rows),
    ]


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
