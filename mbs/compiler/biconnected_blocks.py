"""Blocks (biconnected components) of an undirected multigraph."""

from collections.abc import Hashable, Iterable, Mapping
from typing import TypeVar

V = TypeVar("V", bound=Hashable)
E = TypeVar("E", bound=Hashable)


def blocks_of(around: Mapping[V, Iterable[tuple[E, V]]]) -> list[list[E]]:
    """Edges of each block: the largest sets of edges of which any two lie on a common cycle.

    `around`: edges at each vertex, with the vertex at their other end; several edges may join the same two vertices.

    Returns
    -------
    list of list
        Edges of a block in the order of a depth-first search; an edge on no cycle is a block by itself.

    Notes
    -----
    J. Hopcroft, R. Tarjan, Communications of the ACM 16, 1973, algorithm 447; without recursion.
    """
    order: dict[V, int] = {}
    lowest: dict[V, int] = {}
    visited: set[E] = set()
    blocks: list[list[E]] = []
    for root in around:
        if root in order:
            continue
        order[root] = lowest[root] = len(order)
        path, edges = [(root, iter(around[root]), 0)], list[E]()
        while path:
            vertex, remaining, first_edge = path[-1]
            for edge, neighbour in remaining:
                if edge in visited:
                    continue
                visited.add(edge)
                edges.append(edge)
                if neighbour in order:
                    lowest[vertex] = min(lowest[vertex], order[neighbour])
                    continue
                order[neighbour] = lowest[neighbour] = len(order)
                path.append((neighbour, iter(around[neighbour]), len(edges) - 1))
                break
            else:
                path.pop()
                if not path:
                    break
                above = path[-1][0]
                lowest[above] = min(lowest[above], lowest[vertex])
                if lowest[vertex] >= order[above]:
                    blocks.append(edges[first_edge:])
                    del edges[first_edge:]
    return blocks
