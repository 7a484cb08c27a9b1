"""What the calls of ``serendipity crosscheck`` come to: how many of each family, mode and outcome are drawn.

    python -m benchmarks.drawn [--count N] [--seed S]

Prints a Markdown table; families are those of ``crosscheck``, and all other tasks are ``random``.
"""

import argparse
from collections import Counter

import serendipity
from serendipity import UsageError
from serendipity.evaluation.crosscheck import PlanCall, random_call

OUTCOMES = ("opportunity", "optimal, none", "no-human-plan", "infeasible", "refused")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--count", type=int, default=3000, help="random calls")
    parser.add_argument("--seed", type=int, default=0, help="of the first")
    arguments = parser.parse_args()
    seen: Counter[tuple[str, str, str]] = Counter()
    for seed in range(arguments.seed, arguments.seed + arguments.count):
        call = random_call(seed)
        seen[call.task.name, call.options["mode"], outcome(call)] += 1
    print(f"| family | mode | calls | {' | '.join(OUTCOMES)} |")
    print("|---" * (3 + len(OUTCOMES)) + "|")
    for family, mode in sorted({key[:2] for key in seen}):
        numbers = [seen[family, mode, how] for how in OUTCOMES]
        print(f"| {family} | {mode} | {sum(numbers)} | {' | '.join(map(str, numbers))} |")


def outcome(call: PlanCall) -> str:
    """One of ``OUTCOMES``."""
    try:
        answer = serendipity.plan(call.task, human_plan=call.human_plan, **call.keywords())
    except UsageError:
        return "refused"
    if answer.status == "infeasible":
        return "no-human-plan" if answer.reason == "no-human-plan" else "infeasible"
    return "opportunity" if answer.opportunity else "optimal, none"


if __name__ == "__main__":
    main()
