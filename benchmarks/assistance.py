"""Silent assistance on the published problems: ``python -m benchmarks.assistance [FOLDER] [options]``.

Prints a table (problem, ties, status, lower and upper value as ``human, supporter``,
seconds with loading) and a summary by domain.
"""

import argparse
import re
import statistics
import time
from collections.abc import Iterator
from pathlib import Path

import serendipity

TIES = ("optimistic", "fixed", "expected", "robust")
DEFAULT = Path(__file__).resolve().parents[2] / "shared" / "spa"


def problems(folder: Path) -> Iterator[tuple[str, Path, Path]]:
    """Name, the human's problem file and the supporter's, in the order of their numbers."""
    found = list(folder.glob("*/*_problem_*_prime.pddl"))
    for prime in sorted(found, key=lambda path: (path.parent.name, number(path))):
        supporter = prime.with_name(prime.name.replace("_prime", "_supporter"))
        yield f"{prime.parent.name}/{number(prime)}", prime, supporter


def number(problem: Path) -> int:
    """The number in a problem's file name."""
    return int(re.findall(r"problem_(\d+)", problem.name)[0])


def domain_of(problem: Path) -> Path:
    """The domain file beside a problem file."""
    return problem.with_name(re.sub(r"problem_\d+", "domain", problem.name))


def main() -> None:
    """Run all problems under all ties."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=DEFAULT)
    parser.add_argument("--only", default="", help="part of the problems' names")
    parser.add_argument("--ties", nargs="+", default=TIES, choices=TIES)
    parser.add_argument("--time-limit", type=float, default=60)
    chosen = parser.parse_args()
    seconds: dict[tuple[str, str], list[float]] = {}
    proved: dict[tuple[str, str], int] = {}
    for name, prime, supporter in problems(chosen.folder):
        if chosen.only not in name:
            continue
        for ties in chosen.ties:
            start = time.perf_counter()
            task = serendipity.load_agents(
                {"prime": (domain_of(prime), prime), "supporter": (domain_of(supporter), supporter)},
                human="prime",
            )
            result = serendipity.plan(task, mode="assistance", ties=ties, time_limit=chosen.time_limit)
            took = time.perf_counter() - start
            bounds = result.statistics["bounds"]
            lower, upper = (", ".join(bounds[side] or ["-"]) for side in ("lower", "upper"))
            print(
                f"{name:<28} {ties:<11} {result.status:<10} {lower:>14} {upper:>14} {took:8.3f}", flush=True
            )
            key = (name.split("/")[0], ties)
            seconds.setdefault(key, []).append(took)
            proved[key] = proved.get(key, 0) + (result.status in ("optimal", "infeasible"))
    print(f"\n{'domain':<28} {'ties':<11} {'proved':>10} {'median s':>10} {'max s':>10}")
    for (domain, ties), times in seconds.items():
        share = f"{proved[domain, ties]}/{len(times)}"
        print(f"{domain:<28} {ties:<11} {share:>10} {statistics.median(times):10.3f} {max(times):10.3f}")


if __name__ == "__main__":
    main()
