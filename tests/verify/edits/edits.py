"""Every edit of a result's JSON: fields absent, null, of another type or value, of another result."""

import random
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

Path = tuple[str | int, ...]


class _Absent:
    def __repr__(self) -> str:
        return "absent"


ABSENT = _Absent()


@dataclass(frozen=True)
class Edit:
    """One field and what becomes of it."""

    path: Path
    value: Any

    @property
    def where(self) -> str:
        """The path, with ``*`` for places in lists: edits of one kind share it."""
        return ".".join("*" if isinstance(part, int) else part for part in self.path)

    def __str__(self) -> str:
        return f"{'.'.join(map(str, self.path))} = {self.value!r:.60}"


def single(data: dict[str, Any], other: dict[str, Any]) -> Iterator[Edit]:
    """All edits of one field of ``data``, with values from ``other`` among them."""
    for path, value in _places(data):
        found = [ABSENT, None, *_of_other_types(value), *_other_values(value)]
        foreign = _at(other, path)
        if foreign is not ABSENT:
            found.append(foreign)
        for new in found:
            if new is ABSENT or type(new) is not type(value) or new != value:
                yield Edit(path, new)


def pairs(data: dict[str, Any], other: dict[str, Any], count: int, seed: int) -> Iterator[tuple[Edit, Edit]]:
    """``count`` pairs of edits of different fields, drawn by ``seed``."""
    draw = random.Random(seed)
    every = list(single(data, other))
    for _ in range(count):
        first, second = draw.sample(every, 2)
        shorter = min(len(first.path), len(second.path))
        if first.path[:shorter] != second.path[:shorter]:
            yield first, second


def edited(data: dict[str, Any], *edits: Edit) -> dict[str, Any]:
    copy = deepcopy(data)
    for edit in sorted(edits, key=_late):
        *way, last = edit.path
        at: Any = copy
        for part in way:
            at = at[part]
        if edit.value is not ABSENT:
            at[last] = deepcopy(edit.value)
        elif isinstance(at, list):
            at.pop(last)
        else:
            del at[last]
    return copy


def _late(edit: Edit) -> tuple[bool, list[int]]:
    """What is removed comes last, and from the end: places in lists stay what they are until then."""
    return edit.value is ABSENT, [-part for part in edit.path if isinstance(part, int)]


def _places(value: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    if path:
        yield path, value
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _places(item, (*path, key))
    elif isinstance(value, list):
        for i, item in enumerate(value):
            yield from _places(item, (*path, i))


def _at(data: Any, path: Path) -> Any:
    for part in path:
        try:
            data = data[part]
        except (KeyError, IndexError, TypeError):
            return ABSENT
    return data


def _of_other_types(value: Any) -> list[Any]:
    samples: list[Any] = [True, 1, 1.5, "x", ["x"], {"x": 1}]
    if isinstance(value, int | float) and not isinstance(value, bool):
        samples.append(str(value))
    return [sample for sample in samples if not _alike(sample, value)]


def _alike(a: Any, b: Any) -> bool:
    return type(a) is type(b) or (_is_number(a) and _is_number(b))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _other_values(value: Any) -> list[Any]:
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int):
        return [value + 1, value - 1, 0, 10**30, -value]
    if isinstance(value, float):
        return [value + 1, value - 1, value + 1e-9, 0.0, 1e30, -value, value * 2]
    if isinstance(value, str):
        return [f"{value}x", "", "noop", "serendipity", "composite", "assistance", "feasible", "unknown"]
    if isinstance(value, list):
        return [[], value[::-1], value[1:], [*value, *value[-1:]]]
    if isinstance(value, dict):
        return [{}, {**value, "more": 1}]
    return [0, 1.5, "x", False, [], {}]
