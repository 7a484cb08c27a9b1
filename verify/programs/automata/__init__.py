"""The strong encoding: agent automata as networks, shared facts as value flows."""

from verify.programs.automata.encoding import AutomataEncoding

__all__ = ["AutomataEncoding"]
