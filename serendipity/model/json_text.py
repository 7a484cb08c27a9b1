"""JSON as reports are written in it: a line for each member, and for each of its members, but none below.

With an indent the standard library's encoder is written in Python and takes five times as long; a report
on windows may hold 200,000 steps.
"""

import json
from typing import Any, Final

_encode: Final = json.JSONEncoder(ensure_ascii=False, allow_nan=False).encode


def json_text(value: dict[str, Any]) -> str:
    """A JSON object as text.

    Raises:
        TypeError: something in it is nothing that JSON has.
        ValueError: a number in it is not finite.
    """
    members = ",\n".join(f" {_encode(key)}: {_member(item)}" for key, item in value.items())
    return f"{{\n{members}\n}}"


def _member(item: object) -> str:
    if isinstance(item, dict) and item:
        members = ",\n".join(f"  {_encode(key)}: {_encode(value)}" for key, value in item.items())
        return f"{{\n{members}\n }}"
    if isinstance(item, list | tuple) and item:
        members = ",\n".join(f"  {_encode(value)}" for value in item)
        return f"[\n{members}\n ]"
    return _encode(item)
