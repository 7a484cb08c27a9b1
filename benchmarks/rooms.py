"""The house in figures: rooms, the arrows between them, circles, sizes, names that mean several things.

    python -m benchmarks.rooms

A *room* is a folder of modules, or a module by itself where folders stand beside it; an *arrow* is an
import, for types included, of one room by another of the same package.  A *circle* is a set of rooms
that reach each other by arrows.
"""

import ast
import re
from collections import Counter
from pathlib import Path
from statistics import median, quantiles

import grimp
import networkx as nx

from serendipity.evaluation.measuring.tables import as_markdown
from serendipity.model.telling import Grid, Line

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
    graph = grimp.build_graph(*PACKAGES)
    files = {package: sorted(Path(package).rglob("*.py")) for package in PACKAGES}
    texts = {path: path.read_text(encoding="utf-8") for of in files.values() for path in of}
    trees = {path: ast.parse(text) for path, text in texts.items()}
    columns = [
        _rooms(package, graph) | _sizes([trees[path] for path in files[package]]) for package in PACKAGES
    ]
    columns = [
        column
        | {"most files": max(Counter(path.parent for path in files[package]).values())}
        | {"median module": int(median(lines)), "longest": max(lines), "lines": sum(lines)}
        for package, column in zip(PACKAGES, columns, strict=True)
        if (lines := [texts[path].count("\n") for path in files[package]])
    ]
    grid = Grid(["", *PACKAGES], [[name, *(str(column[name]) for column in columns)] for name in columns[0]])
    names = Counter(
        node.name for tree in trees.values() for node in tree.body if isinstance(node, ast.ClassDef)
    )
    repeated = sorted(name for name, count in names.items() if count > 1 and not name.startswith("_"))
    told = [Line(f"Class names that are there more than once: {len(repeated)}: {', '.join(repeated)}")]
    for name, pattern in PATTERNS.items():
        within = (path for path in texts if "outside" not in name or "model" not in path.parts)
        told.append(Line(f"{name}: {sum(len(re.findall(pattern, texts[path])) for path in within)}"))
    print(as_markdown([grid, *told]), end="")


def _rooms(package: str, graph: grimp.ImportGraph) -> dict[str, int]:
    arrows = nx.DiGraph()
    modules = {module for module in graph.modules if module.startswith(f"{package}.")}
    rooms = {module: _room(package, module, graph) for module in modules}
    arrows.add_nodes_from({*rooms.values()} - {package})
    for module in modules:
        found = {
            rooms[other] for other in graph.find_modules_directly_imported_by(module) if other in modules
        }
        arrows.add_edges_from((rooms[module], other) for other in found - {rooms[module], package})
    circles = [each for each in nx.strongly_connected_components(arrows) if len(each) > 1]
    return {
        "modules": len(modules) + 1,
        "rooms": len(arrows),
        "arrows": arrows.number_of_edges(),
        "circles": len(circles),
    }


def _room(package: str, module: str, graph: grimp.ImportGraph) -> str:
    """The folder of a module; the module itself where it stands beside folders."""
    parent = module if graph.find_children(module) else module.rpartition(".")[0]
    beside = any(graph.find_children(child) for child in graph.find_children(parent))
    return module if parent == package or beside else parent


def _sizes(trees: list[ast.Module]) -> dict[str, int]:
    functions = [
        (node.end_lineno or node.lineno) - node.lineno + 1
        for tree in trees
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
    ]
    return {"function p95": round(quantiles(functions, n=20)[-1])}


if __name__ == "__main__":
    main()
