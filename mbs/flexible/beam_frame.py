"""Frames of beams: nodes, beams and sections, with the axes of each beam."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.checks import instance_of, is_finite, named, number, numbers, shown
from mbs.common.errors import ModelError
from mbs.flexible.beam_axes import beam_axes
from mbs.flexible.beam_stiffness import THEORIES, beam_stiffness
from mbs.flexible.mass_points import check_masses
from mbs.flexible.material import Material
from mbs.flexible.section import Section


@dataclass(frozen=True)
class Beam:
    """One element from node `i` to node `j`; for its local axes see `beam_axes`."""

    i: int
    j: int
    section: Section
    material: Material


@dataclass(frozen=True)
class BeamFrame:
    """Nodes, rigidly joined beams and lumped masses."""

    positions: np.ndarray
    """Shape (n, 3): nodes, m."""
    beams: tuple[Beam, ...]
    masses: np.ndarray
    """Shape (n,), or by node name or number: lumped masses carried by the nodes in addition to the beams."""
    names: tuple[str, ...]
    """One per node; by default the node numbers."""
    theory: str = field(default="euler_bernoulli")
    """Either "euler_bernoulli" or "timoshenko"."""

    def __init__(
        self,
        positions: ArrayLike,
        beams: Sequence[Beam],
        masses: ArrayLike | Mapping[str | int, float] | None = None,
        names: Sequence[str] | None = None,
        theory: str = "euler_bernoulli",
    ) -> None:
        x = numbers(positions, "the node positions", ModelError, "finite numbers of shape (n, 3)")
        if x.ndim != 2 or x.shape[1] != 3 or not np.isfinite(x).all():
            raise ModelError(f"Node positions have shape {x.shape}; finite numbers of shape (n, 3) are needed.")
        labels = node_labels(names, len(x))
        if not isinstance(theory, str) or theory not in THEORIES:
            raise ModelError(f"The beam theory {shown(theory)} is unknown; one of {', '.join(THEORIES)}.")
        if not isinstance(beams, (list, tuple)) or not beams or not all(isinstance(b, Beam) for b in beams):
            raise ModelError(f"A frame needs at least one beam, in a list of Beams, got {shown(beams)}.")
        for k, beam in enumerate(beams):
            instance_of(Section, beam.section, f"The section of beam {k}", "a Section")
            instance_of(Material, beam.material, f"The material of beam {k}", "a Material")
            for node in (beam.i, beam.j):
                if not is_finite(node) or int(node) != node or not 0 <= node < len(x):
                    raise ModelError(f"Beam {k} ends at node {shown(node)}; there are the nodes 0 to {len(x) - 1}.")
            if beam.i == beam.j or np.array_equal(x[beam.i], x[beam.j]):
                raise ModelError(f"Beam {k} from {labels[beam.i]!r} to {labels[beam.j]!r} has no length.")
        lumped = _node_masses(masses, labels)
        check_masses(lumped, labels)
        for name, value in zip(
            ("positions", "beams", "masses", "names", "theory"), (x, tuple(beams), lumped, labels, theory), strict=True
        ):
            object.__setattr__(self, name, value)

    def element_axes(self, element: int) -> tuple[float, np.ndarray]:
        """Length and local axes of a beam.

        Returns
        -------
        float
            Length, m.
        ndarray, shape (3, 3)
            Local axes, one per row.
        """
        if not is_finite(element) or int(element) != element or not 0 <= element < len(self.beams):
            raise ModelError(f"There is no beam {shown(element)}: the frame has the beams 0 to {len(self.beams) - 1}.")
        beam = self.beams[int(element)]
        return beam_axes(self.positions[beam.i], self.positions[beam.j])

    def element_freedoms(self, element: int) -> np.ndarray:
        """Numbers of the twelve degrees of freedom of a beam.

        Returns an array of shape (12,): six of node i, six of node j.
        """
        beam = self.beams[int(element)]
        return np.concatenate([6 * beam.i + np.arange(6), 6 * beam.j + np.arange(6)])

    def element_stiffness(self, element: int) -> np.ndarray:
        """Stiffness of a beam in its local axes. Returns an array of shape (12, 12): N/m, N and N m per m and rad."""
        beam = self.beams[int(element)]
        return beam_stiffness(beam.section, beam.material, self.element_axes(element)[0], self.theory)


def node_labels(names: Sequence[str] | None, count: int) -> tuple[str, ...]:
    """Check the names of `count` nodes and return them; by default these are the node numbers."""
    if names is None:
        return tuple(str(i) for i in range(count))
    if not isinstance(names, (list, tuple)):
        raise ModelError(f"The names of the nodes must be a list of {count} names, not {shown(names)}.")
    labels = tuple(named(name, "a node") for name in names)
    if len(labels) != count or len(set(labels)) != count:
        raise ModelError(f"The names of {count} nodes must be {count} different names, not {len(set(labels))}.")
    return labels


def _node_masses(masses: ArrayLike | Mapping[str | int, float] | None, names: tuple[str, ...]) -> np.ndarray:
    if masses is None:
        return np.zeros(len(names))
    if isinstance(masses, Mapping):
        lumped = np.zeros(len(names))
        for node, value in masses.items():
            number(value, f"The mass at node {shown(node)}")
            if node not in names and not (isinstance(node, int) and 0 <= node < len(names)):
                raise ModelError(f"A mass of {value:g} kg sits at node {node!r}, which does not exist.")
            lumped[node if isinstance(node, int) else names.index(node)] += value
        return lumped
    lumped = numbers(masses, "the node masses", ModelError)
    if lumped.shape != (len(names),):
        raise ModelError(f"Node masses have shape {lumped.shape}; one number for each of {len(names)} nodes is needed.")
    return lumped
