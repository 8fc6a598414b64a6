"""Section forces and stresses of a frame as constant rows on nodal displacements and loads of its beams.

Rows have 9 n columns for n nodes: the 6 n degrees of freedom, then three components per node of the acceleration whose
inertia forces load the beams between their ends (for weight: of free fall). `ModalBody.recovery` and `inertia_relief`
accept both; a frame that is loaded only at its nodes needs the first 6 n columns.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from mbs.common.checks import instance_of, is_finite, shown
from mbs.common.errors import ModelError
from mbs.flexible.beam_frame import BeamFrame
from mbs.flexible.beam_mass import beam_mass_points
from mbs.flexible.beam_stiffness import shear_parameters

FORCES = ("N", "Vy", "Vz", "T", "My", "Mz")


def end_forces(frame: BeamFrame, element: int) -> np.ndarray:
    """Forces and moments on the two ends of a beam, in its local axes, per nodal displacement, shape (12, 12).

    Columns belong to the degrees of freedom `Frame.element_freedoms`.
    """
    T = np.kron(np.eye(4), frame.element_axes(element)[1])
    return frame.element_stiffness(element) @ T


def section_forces(frame: BeamFrame, element: int, xi: float) -> sp.csr_array:
    """Section forces at ``x = xi * length`` per unit nodal displacement.

    They act on the face with the normal +x: N is tensile, T turns about x, positive My stretches the fibres at +z,
    positive Mz those at -y. Between its ends the element is loaded by its consistent mass times an acceleration
    that is linear along it, such as its own weight.

    Parameters
    ----------
    xi : float
        Position along the beam, from 0 to 1 as a fraction of its length.

    Returns
    -------
    sparse array, shape (6, 9 n)
        Rows N, Vy, Vz (N), T, My, Mz (N m), per m and rad, then per m/s2.

    Raises
    ------
    ModelError
        The position is outside the beam, or there is no such beam.
    """
    instance_of(BeamFrame, frame, "The frame of the section forces", "a Frame")
    if not is_finite(xi) or not 0.0 <= xi <= 1.0:
        raise ModelError(f"The place {shown(xi)} on beam {element} is outside the beam: 0 is its start and 1 its end.")
    length, _ = frame.element_axes(element)
    to_nodes, beyond_section = _inertia_forces(frame, element, xi)
    shift = np.eye(6)
    arm = (1 - xi) * length  # moment about the section: M_j + arm e_x cross F_j
    shift[4, 2], shift[5, 1] = -arm, arm
    rows = np.hstack([shift @ end_forces(frame, element)[6:], beyond_section - shift @ to_nodes[6:]])
    n, beam = len(frame.positions), frame.beams[int(element)]
    acceleration_columns = [6 * n + 3 * node + axis for node in (beam.i, beam.j) for axis in range(3)]
    columns = np.concatenate([frame.element_freedoms(element), acceleration_columns])
    indices = (np.repeat(np.arange(6), 18), np.tile(columns, 6))
    return sp.csr_array(sp.coo_array((rows.ravel(), indices), shape=(6, 9 * n)))


def _inertia_forces(frame: BeamFrame, element: int, xi: float) -> tuple[np.ndarray, np.ndarray]:
    """Inertia forces per acceleration of both ends, earth axes: of the beam on its ends, and of its part beyond xi.

    Shapes (12, 6), from the mass points of `beam_mass_points`, and (6, 6): force and moment about the section in local
    axes.
    """
    beam = frame.beams[int(element)]
    length, R = frame.element_axes(element)
    shear = shear_parameters(beam.section, beam.material, length, frame.theory)
    positions, masses, shapes = beam_mass_points(beam.section, beam.material, length, shear, "consistent", False)
    positions_over_length = positions[:, 0] / length
    accelerations = np.stack([np.hstack([(1.0 - s) * R, s * R]) for s in positions_over_length])
    to_nodes = np.einsum("p,pij,pik->jk", masses, shapes, accelerations)
    complement, mass = 1.0 - xi, beam.material.rho * beam.section.area * length
    force = mass * np.hstack([complement**2 / 2 * R, (1.0 - xi**2) / 2 * R])
    first_moment = mass * length * np.hstack([complement**3 / 6 * R, ((1.0 - xi**3) / 3 - xi * (1.0 - xi**2) / 2) * R])
    return to_nodes, np.vstack([force, np.zeros(6), -first_moment[2], first_moment[1]])


def fibre_stresses(frame: BeamFrame, element: int, xi: float, fibres: np.ndarray | None = None) -> sp.csr_array:
    """Normal stress at points of a section, N/A + My z/Iy - Mz y/Iz, shape (n_fibres, 9 n).

    Units: Pa per m and rad, and per m/s2.

    `fibres`: points (y, z) of the section, m, shape (n_fibres, 2); by default `Section.fibres` (highest and
    lowest first).
    """
    section = frame.beams[int(element)].section
    points = np.array(section.fibres if fibres is None else fibres, float).reshape(-1, 2)
    factors = np.zeros((len(points), 6))
    factors[:, 0] = 1 / section.area
    factors[:, 4] = points[:, 1] / section.Iy
    factors[:, 5] = -points[:, 0] / section.Iz
    return sp.csr_array(sp.csr_array(factors) @ section_forces(frame, element, xi))


@dataclass(frozen=True)
class StrainGauge:
    """Strain gauges on a beam, as single ones or joined to bridges.

    Readings are rows of shape (1, 9 n), in N, N m or Pa per m, rad and m/s2 of the nodes.
    """

    name: str
    element: int
    xi: float = 0.5
    """Position along the beam, 0 at its start and 1 at its end."""
    fibre: tuple[float, float] | None = None
    """Point (y, z) of the section at which a gauge sits, m; by default the highest fibre. The second gauge of a
    half-bridge sits on the opposite point."""

    def bending_moment(self, frame: BeamFrame) -> sp.csr_array:
        """Moment about the axis across the fibre, positive when the fibre is stretched; My for the highest fibre."""
        y, z = self._point(frame)
        size = float(np.hypot(y, z))
        forces = section_forces(frame, self.element, self.xi)
        return sp.csr_array(forces[[4]] * (z / size) - forces[[5]] * (y / size))

    def half_bridge(self, frame: BeamFrame) -> sp.csr_array:
        """Stress of the fibre minus the stress of the opposite one, which axial force and torque do not change."""
        y, z = self._point(frame)
        both = fibre_stresses(frame, self.element, self.xi, np.array([(y, z), (-y, -z)]))
        return sp.csr_array(both[[0]] - both[[1]])

    def quarter_bridge(self, frame: BeamFrame) -> sp.csr_array:
        """Normal stress of the fibre, by axial force and bending: Young's modulus times the strain of one gauge."""
        return fibre_stresses(frame, self.element, self.xi, np.array([self._point(frame)]))

    def axial_force(self, frame: BeamFrame) -> sp.csr_array:
        """Axial force N, positive in tension."""
        return sp.csr_array(section_forces(frame, self.element, self.xi)[[0]])

    def axial_stress(self, frame: BeamFrame) -> sp.csr_array:
        """Mean normal stress, N / A."""
        return sp.csr_array(self.axial_force(frame) * (1.0 / frame.beams[int(self.element)].section.area))

    def torque(self, frame: BeamFrame) -> sp.csr_array:
        """Torque T, positive if it turns the far side of the section right-handed about the beam from start to end."""
        return sp.csr_array(section_forces(frame, self.element, self.xi)[[3]])

    def shear_stress(self, frame: BeamFrame) -> sp.csr_array:
        """Shear stress of the torque at the fibre of a round section, T r / J.

        Raises
        ------
        ModelError
            The section is not round.
        """
        section = frame.beams[int(self.element)].section
        if not np.isclose(section.J, section.Iy + section.Iz):
            raise ModelError(f"The section of beam {self.element} is not round: its shear stress is not T r / J.")
        return sp.csr_array(self.torque(frame) * (float(np.hypot(*self._point(frame))) / section.J))

    def _point(self, frame: BeamFrame) -> tuple[float, float]:
        return frame.beams[int(self.element)].section.fibres[0] if self.fibre is None else self.fibre


def gauge_rows(frame: BeamFrame, gauges: tuple[StrainGauge, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Bending moments and half-bridge stresses of several gauges.

    Returns
    -------
    moments, bridges : ndarray, shape (n_gauges, 9 n)
        N m and Pa per m and rad, and per m/s2.
    """
    moments = np.vstack([g.bending_moment(frame).toarray() for g in gauges])
    bridges = np.vstack([g.half_bridge(frame).toarray() for g in gauges])
    return moments, bridges


def section_force_field(frame: BeamFrame) -> sp.csr_array:
    """Section forces at both ends of every element, shape (12 n_elements, 9 n): six at the start, six at the end."""
    sections = [section_forces(frame, e, xi) for e in range(len(frame.beams)) for xi in (0.0, 1.0)]
    return sp.csr_array(sp.vstack(sections))


def stress_field(frame: BeamFrame) -> tuple[sp.csr_array, np.ndarray]:
    """Fibre stresses at both ends of every element as one constant matrix.

    Returns
    -------
    rows : sparse array, shape (n_points, 9 n)
        Pa per m and rad, and per m/s2.
    where : ndarray of int, shape (n_points, 3)
        Element, end (0 or 1) and number of the fibre of each row.
    """
    stresses, where = [], []
    for e, beam in enumerate(frame.beams):
        for end in (0, 1):
            stresses.append(fibre_stresses(frame, e, float(end)))
            where += [(e, end, f) for f in range(len(beam.section.fibres))]
    return sp.csr_array(sp.vstack(stresses)), np.array(where)


def peak_tube_stress(frame: BeamFrame, forces: np.ndarray) -> np.ndarray:
    """Largest absolute normal stress in each round section, |N|/A + r sqrt(My2 + Mz2)/I, Pa.

    `forces`: result of `section_force_field`, shape (12 n_elements,). Returns an array of shape (n_elements, 2): at the
    start and at the end of each element.
    """
    f = np.asarray(forces).reshape(len(frame.beams), 2, 6)
    area = np.array([b.section.area for b in frame.beams])[:, None]
    second = np.array([b.section.Iy for b in frame.beams])[:, None]
    radius = np.array([b.section.fibres[0][1] for b in frame.beams])[:, None]
    return np.asarray(np.abs(f[..., 0]) / area + radius * np.hypot(f[..., 4], f[..., 5]) / second)
