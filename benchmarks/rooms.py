"""The house in figures: rooms, the arrows between them, circles, sizes, names that mean several things.

    python -m benchmarks.rooms [FOLDER]

A *room* is a folder of modules, or a module by itself where folders stand beside it; an *arrow* is an
import, for types included, of one room by another of the same package.  A *circle* is a set of rooms
that reach each other by arrows.
"""

import argparse
import ast
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from statistics import median, quantiles

import networkx as nx

PACKAGES = ("search", "verify", "serendipity")

PATTERNS = {
    "Fraction(str( outside the model": r"Fraction\(str\(",
    "statistics[ or .get( outside the model": r"statistics(\[|\.get\()",
    ".derived(": r"\.derived\(",
    "__dict__": r"\.__dict__\b",
    "id(": r"(?<![\w.])id\(",
}
"""What should not be there, by what it is called."""


def main() -> None:
    """Print one table for all packages."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", default=Path())
    folder = parser.parse_args().folder
    classes: Counter[str] = Counter()
    print(f"{'':14}" + "".join(f"{package:>14}" for package in PACKAGES))
    columns = []
    for package in PACKAGES:
        modules = dict(_modules(folder, package))
        trees = {name: ast.parse(path.read_text(encoding="utf-8")) for name, path in modules.items()}
        classes.update(
            node.name for tree in trees.values() for node in tree.body if isinstance(node, ast.ClassDef)
        )
        columns.append(dict([*_rooms(package, modules, trees), *_sizes(modules, trees)]))
    for row in columns[0]:
        print(f"{row:14}" + "".join(f"{column[row]:>14}" for column in columns))
    repeated = sorted(name for name, count in classes.items() if count > 1 and not name.startswith("_"))
    print(f"\nclass names that are there more than once: {len(repeated)}: {', '.join(repeated)}")
    texts = [path for package in PACKAGES for path in dict(_modules(folder, package)).values()]
    for name, pattern in PATTERNS.items():
        within = [path for path in texts if "outside" not in name or "model" not in path.parts]
        found = sum(len(re.findall(pattern, path.read_text(encoding="utf-8"))) for path in within)
        print(f"{name}: {found}")


def _modules(folder: Path, package: str) -> Iterator[tuple[str, Path]]:
    """Modules by dotted name."""
    for path in sorted((folder / package).rglob("*.py")):
        parts = path.relative_to(folder).with_suffix("").parts
        yield ".".join(parts[:-1] if parts[-1] == "__init__" else parts), path


def _rooms(package: str, modules: dict[str, Path], trees: dict[str, ast.Module]) -> Iterator[tuple[str, str]]:
    rooms = {name: _room(package, name, path) for name, path in modules.items()}
    graph = nx.DiGraph()
    graph.add_nodes_from(set(rooms.values()) - {package})
    for name, tree in trees.items():
        for imported in _imports(tree, modules):
            arrow = rooms[name], rooms[imported]
            if arrow[0] != arrow[1] and package not in arrow:
                graph.add_edge(*arrow)
    circles = [sorted(each) for each in nx.strongly_connected_components(graph) if len(each) > 1]
    folders = Counter(path.parent for path in modules.values())
    yield "rooms", str(len(graph))
    yield "arrows", str(graph.number_of_edges())
    yield "circles", str(len(circles))
    yield "most files", str(max(folders.values()))


def _room(package: str, name: str, path: Path) -> str:
    """The folder of a module; the module itself where it stands beside folders."""
    parent = name if path.name == "__init__.py" else name.rpartition(".")[0]
    return name if parent == package or any(path.parent.glob("*/__init__.py")) else parent


def _imports(tree: ast.Module, modules: dict[str, Path]) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                found = full if full in modules else node.module
                if found in modules:
                    yield found
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in modules)


def _sizes(modules: dict[str, Path], trees: dict[str, ast.Module]) -> Iterator[tuple[str, str]]:
    lines = [len(path.read_text(encoding="utf-8").splitlines()) for path in modules.values()]
    functions = [
        (node.end_lineno or node.lineno) - node.lineno + 1
        for tree in trees.values()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
    ]
    yield "modules", str(len(lines))
    yield "lines", str(sum(lines))
    yield "median module", f"{median(lines):.0f}"
    yield "longest", str(max(lines))
    yield "function p95", f"{quantiles(functions, n=20)[-1]:.0f}"


if __name__ == "__main__":
    main()
