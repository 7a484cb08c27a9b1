"""Scenarios: the tasks that are shipped, and a generator of search-and-rescue tasks."""

from serendipity.scenarios.examples import EXAMPLES, Example, example
from serendipity.scenarios.generate import PRESETS, generate_usar, make_usar
from serendipity.scenarios.usar_pddl import LAYOUTS

__all__ = ["EXAMPLES", "LAYOUTS", "PRESETS", "Example", "example", "generate_usar", "make_usar"]
