"""What each method says of each kind of answer, and whether a proof file can be written.

    python -m tests.verify.kinds

prints the table of kinds.md beside it.
"""

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import serendipity
from serendipity.model import Result, Task, UsageError
from serendipity_testing.builders import task as build
from serendipity_testing.cases import case_4
from tests.verify.edits.corpus import Good, corpus
from tests.verify.test_ties_share_their_plans import errands

METHODS: Final = ("auto", "program", "exhaustive")

NAMES: Final = (
    *("window", "no opportunity", "free windows", "two robots", "longest window", "subplan", "state"),
    *("robots' goal", "gain alone", "no human plan", "told, no plan alone", "communication", "keep prefix"),
    *("composite", "composite infeasible", "composite inf", "individual", "feasible", "unknown", "session"),
    *("robust", "optimistic", "expected", "told, robust", "many ties", "goals", "goals, no help"),
    *("goals, observed", "goals, sure", "goals, one left", "goals, none", "policy", "policy, worst"),
    *("policy, regret", "watched", "library", "observant blocking", "observant help", "local"),
    *("assistance fixed", "assistance robust", "assistance expected", "assistance optimistic"),
    *("assistance infeasible",),
)
"""Answers by their name in the corpus, or here."""


@cache
def kinds() -> dict[str, Good]:
    """An answer of each kind, by name."""
    found = {good.name: good for good in (*corpus(), *_more())}
    return {name: found[name] for name in NAMES}


def _more() -> Iterator[Good]:
    session = serendipity.Session(case_4(), discount="0.9")
    answer = session.plan()
    session.execute([step.action for step in answer.plan or () if step.epoch == 1])
    yield Good("session", session.task, session.plan(), {})
    asked = {"ties": "expected", "discount": "0.5"}
    yield Good("many ties", errands(4), serendipity.plan(errands(4), **asked), asked)
    sure = {"horizon": 2, "goals": [{"goal": ["p"]}, {"goal": ["z"]}]}
    yield Good("goals, sure", alike(), serendipity.plan(alike(), **sure), sure)


def alike() -> Task:
    """Whichever of two goals it is, the same help is best."""
    return build(
        goal="p",
        actions={
            "slow p h": "-> p @ 5",
            "slow z h": "-> z @ 5",
            "lay r": "-> q @ 1",
            "quick p h": "q -> p @ 1",
            "quick z h": "q -> z @ 1",
        },
    )


def verdict(task: Task, result: Result, method: str) -> str:
    """What a method says: its verdict, and what decided what rules alone can't."""
    certificate = serendipity.verify(task, result, method=method)
    if certificate.verdict != "proved":
        return certificate.verdict
    decided = {claim.method for claim in certificate.claims if claim.method is not None}
    return ", ".join(("proved", *sorted(decided)))


def proof(task: Task, result: Result) -> str:
    """The number of programs in the proof file, which was checked with task and result; or none."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "proof.json.gz"
        try:
            serendipity.verify(task, result, proof=path)
        except UsageError:
            return "none"
        if not path.exists():
            return "none"
        found = serendipity.check_proof(path, task, result)
        assert found.accepted, found.reason
    return f"{len(found.programs)} program{'s'[: len(found.programs) != 1]}"


def rows() -> Iterator[tuple[str, ...]]:
    """Name, a cell for each method, and the proof file."""
    for name, good in kinds().items():
        said = (verdict(good.task, good.result, method) for method in METHODS)
        yield name, *said, proof(good.task, good.result)


def table() -> str:
    """As the page has it."""
    head = ("answer", *(f"`{method}`" for method in METHODS), "`--proof`")
    lines = [head, tuple("---" for _ in head), *rows()]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines).replace("| --- |", "|---|")


if __name__ == "__main__":
    print(table())  # noqa: T201 - it is what this is for
