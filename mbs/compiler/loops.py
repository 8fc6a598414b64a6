"""Closed loops of a model, as cycles in the graph of its bodies and joints.

Vertices of the graph are groups of welded bodies and massless rods; an edge has all joints between two vertices. A
block is a largest set of edges of which any two lie on a cycle: two blocks share at most one vertex.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from mbs.common.affine import AffineVector
from mbs.compiler.biconnected_blocks import blocks_of
from mbs.model.body import Body
from mbs.model.joints.joint import Joint
from mbs.model.model import Model


@dataclass(eq=False)
class Vertex:
    """Welded bodies, or a massless rod, which has none."""

    name: str
    bodies: list[Body] = field(default_factory=list)
    edges: dict[Vertex, Edge] = field(default_factory=dict)
    """By the vertex at the other end."""

    @property
    def is_rod(self) -> bool:
        """Whether it is a massless rod."""
        return not self.bodies

    @property
    def is_ground(self) -> bool:
        """Whether it holds the ground."""
        return any(body.is_ground for body in self.bodies)


@dataclass(eq=False)
class Edge:
    """The joints between two vertices."""

    ends: tuple[Vertex, Vertex]
    joints: list[Joint]
    point: AffineVector
    """Of the first joint."""
    axis: AffineVector | None = None
    """Axis of a hinge, line through two ball joints, or line of a slide."""
    slides: bool = False
    line_of: Vertex | None = None
    """Vertex that has the line on which a point slides; None if both have it."""

    def other(self, vertex: Vertex) -> Vertex:
        """The end that is not `vertex`."""
        return self.ends[1] if vertex is self.ends[0] else self.ends[0]


@dataclass(eq=False)
class Block:
    """Edges of which any two lie on a cycle, and their vertices."""

    vertices: list[Vertex]
    edges: list[Edge]
    reference: Vertex
    """Vertex to which the motion of the block is relative: the ground, or the one with most edges in the model."""


def blocks_of_loops(model: Model) -> list[Block]:
    """The blocks that have a cycle; joints with a switch are left out because they are not always closed."""
    blocks = []
    for edges in blocks_of({v: [(e, w) for w, e in v.edges.items()] for v in _graph(model)}):
        vertices = list(dict.fromkeys(v for e in edges for v in e.ends))
        if len(vertices) < 3:
            continue
        reference = next((v for v in vertices if v.is_ground), None)
        if reference is None:
            with_bodies = [v for v in vertices if not v.is_rod]
            reference = max(with_bodies, key=lambda v: len(v.edges))  # the first of equals
        blocks.append(Block(vertices, edges, reference))
    return blocks


def cycles(block: Block) -> list[list[Vertex]]:
    """The shortest cycle through each edge of a block, as its vertices in order, without repetitions.

    Of equally short cycles one without rods is taken, and cycles without rods come first.
    """
    block_edges = set(map(id, block.edges))
    shortest: dict[frozenset[int], list[Vertex]] = {}
    for edge in block.edges:
        start, goal = edge.ends
        before: dict[int, Vertex] = {id(start): start}
        frontier = [start]
        while frontier and id(goal) not in before:
            next_frontier = []
            for v in frontier:
                for w, e in sorted(v.edges.items(), key=lambda item: item[0].is_rod):
                    if id(e) in block_edges and e is not edge and id(w) not in before:
                        before[id(w)] = v
                        next_frontier.append(w)
            frontier = next_frontier
        if id(goal) not in before:
            continue
        cycle = [goal]
        while cycle[-1] is not start:
            cycle.append(before[id(cycle[-1])])
        shortest.setdefault(frozenset(map(id, cycle)), cycle)
    return sorted(shortest.values(), key=lambda cycle: any(v.is_rod for v in cycle))


def _graph(model: Model) -> list[Vertex]:
    """Vertices of a model, with their edges."""
    joints = [j for j in model.joints if j.ends is not None and j.switch is None]
    numbers = {body.start: body.number for body in model.bodies}

    def number(body: Body) -> int:
        """Number of the body, or of the body that a node or a body with ports is part of; -1: ground."""
        return -1 if body.is_ground else numbers[body.start]

    size = max(numbers.values(), default=-1) + 2
    welds = np.zeros((size, size))
    for joint in joints:
        if joint.type == "weld" and joint.ends is not None:
            a, b = (number(body) + 1 for body in joint.ends.bodies)
            welds[a, b] = 1.0
    groups = connected_components(csr_matrix(welds), directed=False)[1]
    vertices: dict[int, Vertex] = {}
    for body in [model.ground, *model.bodies]:
        vertices.setdefault(groups[number(body) + 1], Vertex(body.name)).bodies.append(body)
    all_vertices = list(vertices.values())
    for joint in joints:
        if joint.type == "weld" or joint.ends is None:
            continue
        first, second = (vertices[groups[number(body) + 1]] for body in joint.ends.bodies)
        if first is second:
            continue
        if joint.ends.rod:
            rod = Vertex(joint.name)
            all_vertices.append(rod)
            for vertex, point in zip((first, second), joint.ends.points, strict=True):
                _join(vertex, rod, Edge((vertex, rod), [joint], point))
            continue
        ends, line_of = joint.ends, None
        if ends.slides and joint.type == "point_on_line":
            line_of = second
        point = ends.points[0]
        _join(first, second, Edge((first, second), [joint], point, ends.axis, ends.slides, line_of))
    return all_vertices


def _join(a: Vertex, b: Vertex, new: Edge) -> None:
    """Add an edge between two vertices; a second ball joint between them makes a hinge about the line through both."""
    edge = a.edges.get(b)
    if edge is None:
        a.edges[b] = b.edges[a] = new
        return
    edge.joints += new.joints
    if edge.axis is None and new.axis is None:
        edge.axis = new.point - edge.point
