"""Silent assistance, solved exactly (semantics 7).

Glossary: *prime* - the human, who does not know that they are helped; *supporter* - the
robot; *choice* - a state with the supporter to move; *reply* - one with the prime to
move; *alone* - the prime's optimal costs with an idle supporter; *value* - both costs in
one integer.
"""

from search.modes.assistance.answer import assist

__all__ = ["assist"]
