"""A classical problem in the form that the kernel reads."""

import ctypes
from array import array
from collections.abc import Iterable
from ctypes import c_char_p, c_int32, c_void_p

from search.classical.problem import ClassicalProblem


class Spec(ctypes.Structure):
    """``Spec`` of ``search/kernel/problem.h``."""

    _fields_ = (
        *(
            (name, c_int32)
            for name in ("words", "n_ops", "n_fields", "n_facts", "n_forbidden", "n_goal_forbidden")
        ),
        *((name, c_char_p) for name in ("need_mask", "need", "keep", "put")),
        ("forbidding", c_void_p),
        ("forbidden", c_char_p),
        ("weight", c_void_p),
        ("fields", c_void_p),
        *((name, c_char_p) for name in ("goal_mask", "goal", "goal_forbidden")),
    )


def memory_for(problem: ClassicalProblem) -> int:
    """Bytes that telling the kernel of a problem takes, here and there."""
    return 20 * _size(problem.mask) * len(problem.operators)


class EncodedProblem:
    """A problem as rows of words, which are there for as long as this is.

    Attributes:
        spec: what the kernel is told; it makes a copy.
        size: bytes of a row.
    """

    def __init__(self, problem: ClassicalProblem) -> None:
        self._mask = problem.mask
        self.size = _size(self._mask)
        goal, operators, full = problem.goal, problem.operators, (1 << 8 * self.size) - 1
        literals = [(number, pair) for number, op in enumerate(operators) for pair in op.forbidden]
        shapes, facts = array("i"), 0
        for field, values in problem.fields:
            shapes.extend(((field & -field).bit_length() - 1, field.bit_count(), facts))
            facts += values
        forbidding = array("i", [number for number, _ in literals])
        weights = array("q", problem.weights)
        self._held = shapes, forbidding, weights  # by address below
        self.spec = Spec(
            *(self.size // 8, len(operators), len(problem.fields), facts, len(literals)),
            len(goal.forbidden),
            self._rows(op.need_mask for op in operators),
            self._rows(op.need for op in operators),
            self._rows(op.keep & full for op in operators),
            self._rows(op.put & self._mask for op in operators),
            forbidding.buffer_info()[0],
            self._rows(word for _, pair in literals for word in pair),
            weights.buffer_info()[0],
            shapes.buffer_info()[0],
            self._rows([goal.need_mask]),
            self._rows([goal.need]),
            self._rows(word for pair in goal.forbidden for word in pair),
        )

    def row(self, state: int) -> bytes:
        """A packed state."""
        return (state & self._mask).to_bytes(self.size, "little")

    def _rows(self, numbers: Iterable[int]) -> bytes:
        return b"".join([number.to_bytes(self.size, "little") for number in numbers])


def _size(mask: int) -> int:
    """Bytes of a row: whole words of 64 bits."""
    return 8 * max(1, -(-mask.bit_length() // 64))
