"""``search`` and ``verify`` are common names: refuse others' packages of that name, and files among ours."""

import os
from functools import cache
from importlib.util import find_spec
from pathlib import Path

_DISTRIBUTION = "serendipity-planner"
_AGAIN = f"pip install --force-reinstall --no-deps {_DISTRIBUTION}"


@cache
def require_siblings(*names: str) -> None:
    """Make sure that the top-level packages ``names`` are the ones shipped beside this one, and ours alone.

    Raises:
        ImportError: naming the stranger, and what to do about it.
    """
    home = Path(__file__).resolve().parent.parent
    for name in names:
        found = _folder(name)
        if found != home / name:
            what = f"uninstall or rename the other one, or put {home} first on PYTHONPATH"
            if not (home / name / "__init__.py").exists():
                what = f"install it again, `{_AGAIN}`"
            where = "nowhere" if found is None else f"at {found}"
            raise ImportError(
                f"serendipity needs its own package '{name}' at {home / name}, but Python finds '{name}' "
                f"{where}: {what}",
                name=name,
            )
    if owner := _stranger(home, ("serendipity", *names)):
        raise ImportError(
            f"{owner} has put files among those of {_DISTRIBUTION} in {home}: give each of the two an "
            f"environment of its own, or `pip uninstall {owner.partition(' ')[0]}`, and then `{_AGAIN}`"
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


@cache
def _stranger(home: Path, packages: tuple[str, ...]) -> str | None:
    """Who else has installed files into our packages, and the version; None in a checkout."""
    strange = {path for package in packages for path in _strange(home, package, _recorded(home))}
    if not strange:
        return None
    from importlib.metadata import distributions  # takes longer than all the rest

    for other in distributions(path=[str(home)]):
        files = {"/".join(file.parts[:2]) for file in other.files or ()}
        if files & strange and other.name != _DISTRIBUTION:
            return f"{other.name} {other.version}"
    return None


@cache
def _recorded(home: Path) -> dict[str, str]:
    """What was installed with us: by the first two parts of each path its size; nothing in a checkout."""
    sizes = {}
    for record in home.glob(f"{_DISTRIBUTION.replace('-', '_')}-*.dist-info/RECORD"):
        for line in record.read_text(encoding="utf-8").splitlines():
            path, _, size = line.rsplit(",", 2)
            sizes["/".join(path.split("/")[:2])] = size
    return sizes


def _strange(home: Path, package: str, recorded: dict[str, str]) -> list[str]:
    """What lies in a package, and is not as we have installed it."""
    if f"{package}/__init__.py" not in recorded:
        return []
    strange = []
    for entry in os.scandir(home / package):
        path = f"{package}/{entry.name}"
        changed = entry.is_file() and recorded.get(path) != str(entry.stat().st_size)
        if entry.name != "__pycache__" and (path not in recorded or changed):
            strange.append(path)
    return strange
