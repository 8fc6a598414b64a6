"""Blocks of a graph."""

from collections.abc import Hashable, Iterable, Mapping
from typing import TypeVar

V = TypeVar("V", bound=Hashable)
E = TypeVar("E", bound=Hashable)


def blocks_of(around: Mapping[V, Iterable[tuple[E, V]]]) -> list[list[E]]:
    """The edges of each block: largest sets of which any two edges lie on a ring (biconnected components).

    `around`: edges at each vertex, with the vertex at their other end; several may join the same two.

    Returns
    -------
    list of list
        Each in the order of a search in depth; an edge on no ring is a block by itself.

    Notes
    -----
    J. Hopcroft, R. Tarjan, Communications of the ACM 16, 1973, algorithm 447; without recursion.
    """
    order: dict[V, int] = {}
    lowest: dict[V, int] = {}
    used: set[E] = set()
    found: list[list[E]] = []
    for root in around:
        if root in order:
            continue
        order[root] = lowest[root] = len(order)
        path, edges = [(root, iter(around[root]), 0)], list[E]()
        while path:
            here, rest, mark = path[-1]
            for edge, other in rest:
                if edge in used:
                    continue
                used.add(edge)
                edges.append(edge)
                if other in order:
                    lowest[here] = min(lowest[here], order[other])
                    continue
                order[other] = lowest[other] = len(order)
                path.append((other, iter(around[other]), len(edges) - 1))
                break
            else:
                path.pop()
                if not path:
                    break
                above = path[-1][0]
                lowest[above] = min(lowest[above], lowest[here])
                if lowest[here] >= order[above]:
                    found.append(edges[mark:])
                    del edges[mark:]
    return found
