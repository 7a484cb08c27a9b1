"""Mutation proof of the verifier: doctored results, and bugs planted in the planner.

    python -m benchmarks.mutations [--count N] [--quick]

Prints two Markdown tables.  The first refutes results that were doctored, each with the claim
(and the rule) that falls; the second plants bugs in the planner, one at a time, and certifies its
answers to a corpus of calls until one is refuted.  ``--quick`` leaves the second one out.
"""

import argparse
from collections import Counter
from time import perf_counter

from serendipity.model import InputError
from tests.verify.doctored import DOCTORED, Doctored
from tests.verify.planted import PLANTED
from tests.verify.planted.judge import fate
from verify.certificate.certify import certify
from verify.rules import check


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--count", type=int, default=1000, help="random calls in the corpus")
    parser.add_argument("--quick", action="store_true", help="doctored results only")
    arguments = parser.parse_args()
    _doctored()
    if not arguments.quick:
        print()
        _planted(arguments.count)


def _doctored() -> None:
    started = perf_counter()
    rows = [(name, *_refutation(doctored)) for name, doctored in DOCTORED.items()]
    right = sum(row[3] for row in rows)
    print(f"{len(rows)} doctored results, {right} refuted for the right reason.\n")
    print("| doctored | refuted as | because |\n|---|---|---|")
    for name, claim, reason, fine in rows:
        print(f"| {name} | {claim}{'' if fine else ' (expected another)'} | {_cell(reason)} |")
    _note(f"{perf_counter() - started:.1f} s")


def _refutation(doctored: Doctored) -> tuple[str, str, bool]:
    """What falls, why, and whether that is what should."""
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


def _planted(count: int) -> None:
    started = perf_counter()
    clean = fate(None, count)
    print(f"Without a bug: {clean.calls} calls, {clean.how}.\n")
    print("| role | bug | fate | calls | certificate, error, or why it survives |\n|---|---|---|---|---|")
    fates: Counter[str] = Counter()
    for bug in PLANTED:
        seen = fate(bug, count)
        fates[seen.how] += 1
        reason = seen.reason or bug.survives or "not explained"
        print(f"| {bug.role} | {bug.what} | {seen.how} | {seen.calls} | {_cell(reason)} |", flush=True)
    words = ", ".join(f"{how} {number}" for how, number in fates.most_common())
    _note(f"{len(PLANTED)} bugs: {words}; {perf_counter() - started:.0f} s")


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def _note(text: str) -> None:
    print(f"\n({text})")


if __name__ == "__main__":
    main()
