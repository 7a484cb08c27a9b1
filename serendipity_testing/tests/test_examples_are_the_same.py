"""Examples that hypothesis draws do not depend on what a worker has loaded before."""

from hypothesis.internal.conjecture.providers import HypothesisProvider

import serendipity


def test_no_constants_of_loaded_modules_are_drawn() -> None:
    assert serendipity.plan
    assert not len(HypothesisProvider(None)._local_constants)
