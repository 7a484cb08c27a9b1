"""Judges from outside on the random calls of ``serendipity crosscheck``: what they say, and what is found.

    python -m benchmarks.outside_judges up:fast-downward-opt up:symk-opt [--count N] [--seed S]

Judges are named as for ``crosscheck --judge``.  Each has calls of its own, since one that counts
actions only is asked about tasks of unit costs.  A disagreement is printed, shrunk, and written.
"""

import argparse
import warnings
from collections import Counter
from dataclasses import replace
from pathlib import Path

from serendipity import Deadline
from serendipity.evaluation.crosscheck import (
    JUDGES,
    PlanCall,
    compare,
    random_call,
    shows_it_too,
    shrink,
    write_case,
)
from serendipity.testing.judges import OutsideJudge, Proposal, by_name

SEARCH = {"search": JUDGES["search"]}
STATUSES = ("optimal", "feasible", "infeasible", "unknown")


def main() -> None:
    """Print the table, a line a judge."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("judges", nargs="+", help="as for crosscheck --judge")
    parser.add_argument("--count", type=int, default=1000, help="random calls")
    parser.add_argument("--seed", type=int, default=0, help="of the first")
    parser.add_argument("--time-limit", type=float, default=60.0, help="seconds for each answer")
    parser.add_argument("-o", "--output", type=Path, default=Path("build/outside"), help="for cases")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    print(f"| judge | calls | {' | '.join(STATUSES)} | disagreements |")
    print("|---" * (3 + len(STATUSES)) + "|")
    for name in arguments.judges:
        seen: Counter[str] = Counter()
        judge = counted(by_name(name), seen)
        seeds = range(arguments.seed, arguments.seed + arguments.count)
        faults = sum(asked(seed, judge, arguments.time_limit, arguments.output) for seed in seeds)
        numbers = [arguments.count, *(seen[status] for status in STATUSES), faults]
        print(f"| {name} | {' | '.join(map(str, numbers))} |", flush=True)
        for words, number in seen.items():
            if words not in STATUSES:
                print(f"  {words}: {number}", flush=True)


def counted(judge: OutsideJudge, seen: Counter[str]) -> OutsideJudge:
    """A judge whose answers are counted, until the count is read."""

    def answer(call: PlanCall, deadline: Deadline) -> Proposal:
        claim = judge.answer(call, deadline)
        seen[claim.status] += 1
        if claim.status == "unknown":
            seen[claim.words] += 1
        return claim

    return replace(judge, answer=answer)


def asked(seed: int, judge: OutsideJudge, time_limit: float, folder: Path) -> bool:
    """Whether a judge and the search, or the verifier, disagree on a call."""
    found = compare(random_call(seed), SEARCH, outside=[judge], time_limit=time_limit)
    if found is None:
        return False
    print(f"seed {seed}: {found}", flush=True)
    silent = by_name(judge.name)
    differs = shows_it_too(found, SEARCH, outside=[silent], time_limit=time_limit)
    smallest = shrink(found.call, differs, most=300)
    case = compare(smallest, SEARCH, outside=[silent], time_limit=time_limit) or found
    print(f"  {write_case(case, folder / f'{seed}', ['--judge', judge.name])}: {case}", flush=True)
    return True


if __name__ == "__main__":
    main()
