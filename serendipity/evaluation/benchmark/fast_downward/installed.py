"""Where it is installed, if it is."""

from functools import cache
from importlib.util import find_spec
from pathlib import Path


def absent() -> str | None:
    """Why it can't be run, or None."""
    missing = [
        name
        for name, found in (("fast-downward.translate", _has_translator()), ("up-fast-downward", binary()))
        if not found
    ]
    if not missing:
        return None
    absent = " and no ".join(missing)
    return f"fast-downward is left out: no {absent} here: pip install serendipity-planner[bench]"


@cache
def binary() -> Path | None:
    """The search's program."""
    below = Path("downward", "builds", "release", "bin", "downward")
    return next(
        (Path(place, below) for place in _places("up_fast_downward") if Path(place, below).is_file()), None
    )


@cache
def _has_translator() -> bool:
    return any(Path(place, "translate", "__main__.py").is_file() for place in _places("fast_downward"))


def _places(package: str) -> list[str]:
    """The folders of a package, which is not imported."""
    found = find_spec(package)
    return [] if found is None else list(found.submodule_search_locations or ())
