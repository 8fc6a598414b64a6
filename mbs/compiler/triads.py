"""Angles at the joints of closed loops, which distinguish assembly modes.

A joint J of a cycle with the joints P and Q before and after it makes the triad P, J, Q. Seen along an axis n the angle
from JP to JQ is 0 or pi if the two bodies lie in line: at a dead centre, at which the motion may leave in another
assembly mode. The axis is the first of: the axis of J, of a hinge at P or Q (a wishbone), the line to a third joint of
a body (a track rod on an upright).
"""

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.compiler.loops import Block, Edge, Vertex, cycles


@dataclass(frozen=True)
class Triad:
    """Axis n, arms a and b from the joint, and number of the cycle; `turned`: b is the line of a slide, to which its
    body is perpendicular.
    """

    name: str
    n: AffineVector
    a: AffineVector
    b: AffineVector
    turned: bool
    cycle: int

    @property
    def components(self) -> list[Affine]:
        """The nine components of n, a, b."""
        return [c for v in (self.n, self.a, self.b) for c in v.components]


def triads(block: Block) -> list[Triad]:
    """One triad at each joint between two moving vertices of each cycle.

    An edge on a cycle without rods has no triads of cycles with rods.
    """
    by_edges = {}
    rodless_edges: set[int] = set()
    for number, cycle in enumerate(cycles(block)):
        has_rod = any(v.is_rod for v in cycle)
        for k, v in enumerate(cycle):
            w = cycle[(k + 1) % len(cycle)]
            edge = v.edges[w]
            if block.reference in (v, w) or edge.slides:
                continue
            if not has_rod:
                rodless_edges.add(id(edge))
            elif id(edge) in rodless_edges:
                continue
            before = v.edges[cycle[k - 1]]
            after = w.edges[cycle[(k + 2) % len(cycle)]]
            triad = _triad(edge, (v, before), (w, after), block, number)
            if triad is not None:
                by_edges[(id(edge), id(before), id(after))] = triad
    return list(by_edges.values())


def _triad(
    edge: Edge, first: tuple[Vertex, Edge], second: tuple[Vertex, Edge], block: Block, cycle: int
) -> Triad | None:
    (a, turned_a), (b, turned_b) = _arm(edge, *first), _arm(edge, *second)
    n = _axis(edge, first, second, block)
    if n is None or (turned_a and turned_b):
        return None
    if turned_a:
        a, b = b, a
    return Triad(edge.joints[0].name, _in_space(n), _in_space(a), _in_space(b), turned_a or turned_b, cycle)


def _arm(edge: Edge, vertex: Vertex, end: Edge) -> tuple[AffineVector, bool]:
    """Arm from the joint along the body, and False; or the line of a neighbour on which the body slides, and True."""
    if end.slides and end.line_of is not vertex and end.axis is not None:
        return end.axis, True
    return end.point - edge.point, False


def _axis(edge: Edge, first: tuple[Vertex, Edge], second: tuple[Vertex, Edge], block: Block) -> AffineVector | None:
    if len(edge.point) == 2:
        return AffineVector.constant((0.0, 0.0, 1.0))
    for candidate in (edge, first[1], second[1]):
        if candidate.axis is not None and not candidate.slides:
            return candidate.axis
    block_edges = {id(e) for e in block.edges}
    for vertex, end in (first, second):
        for third in vertex.edges.values():
            if id(third) in block_edges and third is not edge and third is not end:
                return third.point - end.point
    return None


def _in_space(v: AffineVector) -> AffineVector:
    return v if len(v) == 3 else AffineVector((*v.components, Affine()))
