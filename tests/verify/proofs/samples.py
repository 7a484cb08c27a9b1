"""Proofs to be doctored: of answers to small calls, and of a covering problem whose tree branches."""

from collections.abc import Callable
from functools import cache
from random import Random
from typing import Any, Final, NamedTuple

import serendipity
from serendipity.model import Deadline, Result, Task
from serendipity_testing.builders import task as build
from serendipity_testing.cases import case_1, case_4, case_8
from tests.verify.test_ip_parts import DETOUR
from verify.certificate.certify import certify
from verify.certificate.provable import main_claim
from verify.proofs.book import ProofWriter
from verify.proofs.checker import SCHEMA
from verify.proofs.tree import refutation
from verify.solvers.mip import Model, optimise

Proof = dict[str, Any]


class Sample(NamedTuple):
    """A proof, and what it is about, where that is a planning call."""

    proof: Proof
    task: Task | None = None
    result: Result | None = None


def proved(task: Task, **options: Any) -> Sample:
    """The answer to a call, and the proof of it."""
    result = serendipity.plan(task, **options)
    writer = ProofWriter()
    certificate = certify(task, result, proof=writer)
    assert certificate.verdict == "proved", certificate
    return Sample(writer.to_dict(main_claim(result) or "", "automata"), task, result)


def covering() -> Model:
    """Six of nine sets are needed, though five and a half would do."""
    dice, model = Random(3), Model()
    for _ in range(24):
        model.objective[model.binary()] = dice.randint(3, 5)
    for _ in range(30):
        model.add(dict.fromkeys(dice.sample(range(24), 4), 1), ">=", 1)
    return model


def optimum(model: Model) -> int:
    """The least objective of a program, by HiGHS."""
    values = optimise(model).values
    assert values is not None
    return sum(weight * values[x] for x, weight in model.objective.items())


def entry(model: Model, limit: int | None) -> dict[str, Any]:
    """A program as a proof file has it, with its tree."""
    return {
        "name": "covering",
        "columns": [list(bounds) for bounds in zip(model.lower, model.upper, strict=True)],
        "objective": [list(term) for term in model.objective.items()],
        "limit": limit,
        "rows": [
            {
                "family": "cover",
                "terms": [list(term) for term in row.terms.items()],
                "sense": row.sense,
                "right": row.right,
            }
            for row in model.rows
        ],
        "tree": refutation(model, limit, Deadline()),
    }


def _branched() -> Sample:
    model = covering()
    program = entry(model, optimum(model) - 1)
    return Sample({"schema": SCHEMA, "claim": "optimal", "encoding": "automata", "programs": [program]})


_TWO_WAYS: Final = {"dear h": "-> p @ 5", "cheap h": "-> p @ 2", "help r": "-> q"}

_MAKE: Final[dict[str, Callable[[], Sample]]] = {
    "help": lambda: proved(case_4(), discount="0.9"),
    "no help": lambda: proved(case_1(), discount="0.5"),
    "two programs": lambda: proved(
        case_4(), discount="0.9", mode="communication", communication_weight="0.5"
    ),
    "no plan": lambda: proved(case_8(), mode="composite", horizon=1),
    "suffixes": lambda: proved(build(goal="p", actions=DETOUR), horizon=3, max_window=1),
    "given plan": lambda: proved(build(goal="p", actions=_TWO_WAYS), human_plan=["dear h"]),
    "branched": _branched,
}
SAMPLES: Final = tuple(_MAKE)


@cache
def sample(name: str) -> Sample:
    """A sample by name; its proof is not to be changed."""
    return _MAKE[name]()
