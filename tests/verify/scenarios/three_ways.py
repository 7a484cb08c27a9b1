"""Random calls over scenarios, three ways: the search, brute force, and certificates that are written down.

    python -m tests.verify.scenarios.three_ways SEED COUNT

prints what came of the calls that brute force copes with, by risk.
"""

import sys
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st

import serendipity
from search.modes.scenarios import Candidate
from serendipity.model import Options, Task, UsageError
from serendipity_testing.oracle.scenarios import best_policy
from tests.search.modes.scenarios.strategies import options_over, scenarios
from tests.search.modes.scenarios.test_in_time import library

Asked = tuple[Task, list[Candidate], Options]


@st.composite
def calls_over_scenarios(draw: st.DrawFn) -> Asked:
    """A call over two or three scenarios, or what brute force does not cope with."""
    task, candidates = draw(scenarios())
    return task, candidates, draw(options_over(candidates))


def is_small(asked: Asked) -> bool:
    """Whether there are several scenarios, and brute force copes with them."""
    task, candidates, options = asked
    horizon = int(options.horizon or max((len(one.plan) for one in candidates), default=0))
    longest = {2: 4, 3: 3}.get(len(candidates), 0)
    return 0 < horizon <= longest and len(task.actions) * horizon <= 45


def agreed(asked: Asked) -> str:
    """What came of the proof, where search, brute force and certificate agree; else an AssertionError."""
    task, candidates, options = asked
    right = best_policy(task, options, candidates, options.horizon)
    given_options = {name: getattr(options, name) for name in options.__dataclass_fields__}
    answer = serendipity.plan(task, plans=library(task, candidates), **given_options)
    assert answer.status == "optimal"
    said = (answer.objective, answer.cost, answer.opportunity)
    assert said == (float(right.objective), float(right.cost), right.opportunity), (said, right)
    assert serendipity.verify(task, answer).verdict == "proved"
    with TemporaryDirectory() as folder:
        file = Path(folder, "proof.json")
        try:
            certificate = serendipity.verify(task, answer, proof=file, time_limit=60)
        except UsageError as error:
            assert "rules alone decide" in str(error)
            return "rules alone"
        if certificate.verdict == "undecided":
            return next(claim.reason for claim in certificate.claims if claim.verdict == "undecided")
        assert certificate.verdict == "proved"
        found = serendipity.check_proof(file, task, answer)
        assert found.accepted, found
        several = found.programs[-1].name.startswith("all policies")
        return "one program of all policies" if several else "the best answers to each add up"


def main(first: int, count: int) -> None:
    """Ask so many calls, and tell what came of them."""
    found: Counter[tuple[str, str]] = Counter()

    @seed(first)
    @settings(max_examples=count, database=None, deadline=None, suppress_health_check=list(HealthCheck))
    @given(calls_over_scenarios())
    def ask(asked: Asked) -> None:
        if is_small(asked):
            found[asked[2].risk, agreed(asked)] += 1

    ask()
    lines = [f"{risk}: {number} {how}" for (risk, how), number in sorted(found.items())]
    sys.stdout.write("\n".join([f"{sum(found.values())} calls, no disagreement", *lines, ""]))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
