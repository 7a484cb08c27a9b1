"""The simulator of the search and the one of the verifier tell the same story."""

from hypothesis import given, settings

from search import PreparedTask
from search.modes.simulation import simulate
from tests.search.modes.simulation.strategies import Played, played
from verify.certificate.simulator import play

EXAMPLES = 10_000 if settings().max_examples >= 1000 else 3 * settings().max_examples
"""More than other tests take: the stories differ in many ways, and each is quick to tell."""


@settings(max_examples=EXAMPLES)
@given(played())
def test_simulators_agree(case: Played) -> None:
    asked = {"human_model": case.human_model, "horizon": case.horizon, "visible": case.visible}
    ours = simulate(PreparedTask(case.task), case.options, case.human_plan, case.steps, **asked)
    theirs = play(case.task, case.options, case.human_plan, case.steps, **asked)
    assert list(ours.steps) == theirs.steps
    assert ours.cost == theirs.cost
    assert ours.goals_hold == theirs.goals_hold
    for promised in (ours.cost, ours.cost - 1):
        assert ours.realised(promised) == theirs.realised(promised)
    skipped = [(e.epoch, s.action) for e in ours.epochs for s in e.skipped]
    assert sorted(skipped) == [(t, i) for t, deed in enumerate(theirs.deeds, 1) for i in deed.skipped]
