"""Def. 3.1 by the letter keeps what the human's own domain mentions, as far as anybody can ever use it."""

from pathlib import Path

import pytest

from tests.pddl import texts
from tests.search.exact_answers import proved

DOMAIN = texts.domain(
    texts.action("slow", "()", "(r) (increase (total-cost) 5)", "?h - man"),
    texts.action("odd", "(and (p) (q))", "(a ?h)", "?h - man"),
    texts.action("lift", "(p)", "(r) (not (p)) (increase (total-cost) 1)", "?h - man ?r - bot"),
    types="man bot",
    predicates="(p) (q) (r) (a ?x)",
)


@pytest.mark.parametrize(("init", "cost"), [("(p)", 1.0), ("(p) (q)", 5.0)], ids=["never", "some day"])
def test_what_is_out_of_reach_mentions_nothing(init: str, cost: float, tmp_path: Path) -> None:
    """Help takes p away.  An action of the human's that needs p and q minds that only if q can ever hold."""
    metric = "(:metric minimize (total-cost))"
    problem = texts.problem(init, "(r)", objects="h - man r - bot", more=metric)
    task = texts.one(tmp_path, DOMAIN, problem)
    answer = proved(task, preservation="state")
    assert (answer.cost, answer.opportunity) == (cost, cost < 5)
