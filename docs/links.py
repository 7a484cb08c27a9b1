"""Links for the names in docstrings, on the pages that mkdocstrings makes."""

import re
from typing import Any

from griffe import Extension, Object

import serendipity

_ROLE = re.compile(r":(?:func|class|meth|data):`[~.]?([\w.]+)`")


class Roles(Extension):
    """Names in docstrings become links where the reference has them."""

    def on_object(self, *, obj: Object, **_: Any) -> None:
        """Go through the docstring of one object."""
        if obj.docstring is not None:
            obj.docstring.value = _ROLE.sub(_link, obj.docstring.value)


def _link(found: re.Match[str]) -> str:
    name = found[1].rpartition(".")[2]
    return f"[`{name}`][serendipity.{name}]" if name in serendipity.__all__ else f"`{name}`"
