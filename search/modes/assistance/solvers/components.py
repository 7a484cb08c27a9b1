"""Strongly connected components (Tarjan 1972), each after those that it leads to."""

from collections.abc import Collection, Iterable, Iterator, Mapping


def components(nodes: Iterable[int], onward: Mapping[int, Collection[int]]) -> Iterator[list[int]]:
    """Components of a graph, those without a way out first.

    Args:
        nodes: where to start; every successor is a node.
        onward: successors of each node.
    """
    order: dict[int, int] = {}
    lowest: dict[int, int] = {}
    open_nodes: list[int] = []
    inside: set[int] = set()
    for root in nodes:
        if root in order:
            continue
        stack: list[tuple[int, Iterator[int]]] = [(root, iter(onward[root]))]
        order[root] = lowest[root] = len(order)
        open_nodes.append(root)
        inside.add(root)
        while stack:
            node, left = stack[-1]
            successor = next(left, None)
            if successor is None:
                stack.pop()
                if stack:
                    parent = stack[-1][0]
                    lowest[parent] = min(lowest[parent], lowest[node])
                if lowest[node] == order[node]:
                    yield _take(node, open_nodes, inside)
            elif successor not in order:
                order[successor] = lowest[successor] = len(order)
                open_nodes.append(successor)
                inside.add(successor)
                stack.append((successor, iter(onward[successor])))
            elif successor in inside:
                lowest[node] = min(lowest[node], order[successor])


def _take(root: int, open_nodes: list[int], inside: set[int]) -> list[int]:
    component = []
    while True:
        node = open_nodes.pop()
        inside.discard(node)
        component.append(node)
        if node == root:
            return component
