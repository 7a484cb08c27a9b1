"""Fields that are alike: exchanging their values exchanges operators of the same weight, and keeps the goal.

States that differ only in which of such fields has which value are equally far from the goal, so searches
need but one of them.  Several items that wait in one cupboard for the same table are an example.
"""

from array import array
from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence

from search.classical.problem import ClassicalProblem
from search.packed.operators import Operator, asked_by, split
from serendipity.model.resources.deadline import Deadline

Exchange = Mapping[int, int]
"""By number of the operators that are exchanged with others the numbers of those."""


def like_fields(
    problem: ClassicalProblem, deadline: Deadline, allows: Callable[[Exchange], bool] = lambda _: True
) -> list[list[int]]:
    """Classes of at least two fields, by their numbers.

    Args:
        allows: whether operators may be exchanged by what else is known of them.
    """
    likes = _Likes(problem, deadline, allows)
    classes = defaultdict[Hashable, list[list[int]]](list)
    for number, like in enumerate(map(likes.looks, range(len(problem.fields)))):
        for alike in classes[like]:
            deadline.check()
            if likes.are_alike(alike[0], number):
                alike.append(number)
                break
        else:
            classes[like].append([number])
    return [alike for found in classes.values() for alike in found if len(alike) > 1]


def told(classes: Iterable[Sequence[int]]) -> "array[int]":
    """Classes of fields, as the kernel is told of them."""
    return array("i", [number for alike in classes if len(alike) > 1 for number in (*alike, -1)])


class _Likes:
    def __init__(
        self, problem: ClassicalProblem, deadline: Deadline, allows: Callable[[Exchange], bool]
    ) -> None:
        self._fields, self._goal, self._allows = problem.fields, problem.goal, allows
        self._operators, self._weights = problem.operators, problem.weights
        self._numbers: dict[Hashable, int] = {}
        self._mentioning: list[list[int]] = [[] for _ in problem.fields]
        places = {field & -field: number for number, (field, _) in enumerate(problem.fields)}
        by_lowest_bit, mask = {field & -field: field for field, _ in problem.fields}, problem.mask
        for number, op in enumerate(deadline.each(problem.operators)):
            self._numbers[self._told(number)] = number
            for field in split((asked_by(op) | ~op.keep) & mask, by_lowest_bit):
                self._mentioning[places[field & -field]].append(number)
        self._is_plain = len(self._numbers) == len(problem.operators)

    def looks(self, number: int) -> Hashable:
        """Something that is the same for all fields that are alike."""
        field, values = self._fields[number]
        asked, goal = field & self._goal.need_mask, self._goal.need & field
        return self._is_plain, values, bool(asked), goal // (field & -field), len(self._mentioning[number])

    def are_alike(self, first: int, second: int) -> bool:
        """Whether two fields that look alike are."""
        if not self._is_plain:
            return False
        a, b = self._fields[first][0], self._fields[second][0]
        shift = b.bit_length() - a.bit_length()
        exchange: dict[int, int] = {}
        for number in {*self._mentioning[first], *self._mentioning[second]}:
            if number not in exchange:  # not as the other one of a pair
                other = self._numbers.get(self._told(number, a, b, shift))
                if other is None:
                    return False
                exchange[number], exchange[other] = other, number
        literals = {tuple(_exchanged(word, a, b, shift) for word in pair) for pair in self._goal.forbidden}
        return literals == {*self._goal.forbidden} and self._allows(exchange)

    def _told(self, number: int, a: int = 0, b: int = 0, shift: int = 0) -> Hashable:
        """All that counts of an operator, with two fields exchanged."""
        op: Operator = self._operators[number]
        words, forbidden = [op.need_mask, op.need, ~op.keep, op.put], [*op.forbidden]
        if a:
            words = [_exchanged(word, a, b, shift) for word in words]
            forbidden = [(_exchanged(x, a, b, shift), _exchanged(y, a, b, shift)) for x, y in forbidden]
        return *words, frozenset(forbidden), op.agents, self._weights[number]


def _exchanged(word: int, a: int, b: int, shift: int) -> int:
    """A word with what it has in a field exchanged with what it has in another one, so much further up."""
    return word & ~(a | b) | (word & a) << shift | (word & b) >> shift
