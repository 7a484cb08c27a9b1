"""``search`` and ``verify`` are common names: refuse somebody else's package of that name."""

from importlib.util import find_spec
from pathlib import Path


def require_siblings(*names: str) -> None:
    """Make sure that the top-level packages ``names`` are the ones shipped beside this one.

    Raises:
        ImportError: naming the stranger that shadows ours, and what to do about it.
    """
    home = Path(__file__).resolve().parent.parent
    for name in names:
        found = _folder(name)
        if found != home / name:
            where = "nowhere" if found is None else f"at {found}"
            raise ImportError(
                f"serendipity needs its own package '{name}' at {home / name}, but Python finds '{name}' "
                f"{where}: uninstall or rename the other one, or put {home} first on PYTHONPATH",
                name=name,
            )


def _folder(name: str) -> Path | None:
    """Where Python finds a top-level package: its folder, or the file of a plain module."""
    try:
        spec = find_spec(name)
    except ValueError:  # imported by hand, without a specification
        return None
    if spec is None or spec.origin is None:
        return None
    origin = Path(spec.origin).resolve()
    return origin.parent if origin.name == "__init__.py" else origin
