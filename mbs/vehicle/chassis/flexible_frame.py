"""Flexible frame of a car: its modes at each fidelity, loads on it, and the readings of its strain gauges."""

from dataclasses import replace
from functools import cached_property
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from ali3.plausibility import Plausibility
from mbs.common.errors import ModelError
from mbs.flexible.body_plausibility import model_plausibility
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.damping import RayleighDamping
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.load_paths import load_path_deformations, load_path_modes
from mbs.flexible.mass_points import MassPoints
from mbs.flexible.modal_body import ModalBody
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.relief_matrices import InertiaRelief
from mbs.flexible.relief_solution import inertia_relief
from mbs.vehicle.chassis.frame_joints import FrameJoints
from mbs.vehicle.chassis.frames.frame_section import FrameSection, Structure
from mbs.vehicle.fidelity import Fidelity
from mbs.vehicle.table import read_table

MANY_MODES = 40
"""Number of dynamic modes of `Fidelity.MANY_MODES`."""
LOAD_PATH_TOLERANCE = 5e-3
"""Deformation of a neglected load path, relative to the largest, in the energy norm."""
MAX_FORCE = 1e6
"""Largest force in a table of loads, N."""


class FlexibleFrame:
    """A flexible frame as the chassis of a car.

    `section`: section of the car file; `folder`: folder of the file and its tables; `structure`: finite elements and
    gauges; `joints`: joints of suspension, drive and ground.

    Attributes
    ----------
    interfaces : tuple of str
        Joints of the suspension.
    stiff_pairs : tuple of tuple of str
        Pairs of interfaces at constant distance, as pivots of a wishbone: no load stretches the frame between them.
    carrying : tuple of str
        Joints that carry the masses on the frame.
    model : FiniteElementModel
        The frame with its interfaces at the hard points and the masses it carries.
    """

    def __init__(self, section: FrameSection, folder: Path, structure: Structure, joints: FrameJoints) -> None:
        self.section, self.folder, self.structure, self.joints = section, folder, structure, joints
        self.interfaces, self.stiff_pairs, self.reference = tuple(joints.interfaces), joints.held, joints.reference
        self.damping = RayleighDamping.fitted(section.damping.ratio, *section.damping.frequencies)
        self.carrying = tuple(joint for pair in joints.ground for joint in pair)
        self._unloaded_model = self.model = _at_hard_points(structure.model, joints)
        self.model = replace(self._unloaded_model, mass=self._unloaded_model.mass.merged(self._carried_masses()))
        self._reduced: dict[Fidelity, ReducedBody] = {}

    @cached_property
    def gauge_rows(self) -> np.ndarray:
        """Matrix from nodal displacements and accelerations (`recovery`) to the readings of the gauges, in order."""
        rows = np.zeros((len(self.structure.readings), self.model.n_dof + 3 * len(self.model.positions)))
        for row, reading in zip(rows, self.structure.readings, strict=True):
            row[: len(reading.row)] = reading.row
        return rows

    def plausibility(self) -> list[Plausibility]:
        """Plausibility of the frame with the masses it carries, and held at its interfaces."""
        freedoms = [self.model.reference_freedoms(self.reference), *map(self.model.freedoms, self.interfaces)]
        return model_plausibility(self.model, held=np.concatenate(freedoms))

    def place(self, joint: str) -> np.ndarray:
        """Position of a joint, m, shape (3,)."""
        return np.asarray(self.model.positions[self.model.node(joint)])

    def shares(self, sums: np.ndarray) -> np.ndarray:
        """Smallest weights of the carrying joints whose weighted sum of (x, y, z, 1) is `sums`, shape (4,)."""
        rigid = np.vstack([np.transpose([self.place(joint) for joint in self.carrying]), np.ones(len(self.carrying))])
        return np.asarray(np.linalg.lstsq(rigid, sums, rcond=None)[0])

    def _carried_masses(self) -> MassPoints:
        """Masses on the frame, which act on it at the carrying joints like payloads."""
        riding, model = self.structure.riding, self._unloaded_model
        freedoms = np.array([model.freedoms(joint) for joint in self.carrying])
        positions, rows = [self.place(joint) for joint in riding], np.zeros((len(riding), 3, model.n_dof))
        for row, position in zip(rows, positions, strict=True):
            row[np.arange(3), freedoms] = self.shares(np.append(position, 1.0))[:, None]
        masses = np.array([*riding.values()], dtype=float)
        return MassPoints(np.reshape(positions, (-1, 3)), masses, sp.csr_array(rows.reshape(-1, model.n_dof)))

    def reduced(self, fidelity: Fidelity | int | str) -> ReducedBody:
        """The frame reduced to the modes of a fidelity, cached. `fidelity`: LOAD_PATHS or a finer one."""
        level = Fidelity.of(fidelity)
        if level not in self._reduced:
            self._reduced[level] = self._reduce(level).carrying(self._carried_masses())
        return self._reduced[level]

    def _reduce(self, fidelity: Fidelity) -> ReducedBody:
        """Reduce the frame without carried masses to the modes of a fidelity."""
        section, model = self.section, self._unloaded_model
        if fidelity is Fidelity.PAPER:
            return craig_bampton(model, self.reference, self.interfaces, section.dynamic_modes, damping=self.damping)
        count = {Fidelity.LOAD_PATHS: 0, Fidelity.DYNAMIC: section.dynamic_modes, Fidelity.MANY_MODES: MANY_MODES}[
            fidelity
        ]
        body = craig_bampton(model, self.reference, self.interfaces, count, inertia_modes=True, damping=self.damping)
        if fidelity is not Fidelity.LOAD_PATHS:
            return body
        # the frame needs the stretch between the pivots of a wishbone to satisfy its constant length, and all
        # directions at the origin for a driving function, whose force on a pitched car has a vertical component
        loads, pairs = self.recorded_loads(), self._relief_with_stretch[1]
        all_loads = np.hstack([loads, pairs, np.zeros((len(loads), 3))])
        guided = np.zeros((6, all_loads.shape[1]))
        guided[:3, -3:] = np.eye(3)
        deformation = load_path_deformations(body, all_loads, guided)
        norms = np.sqrt(np.einsum("ik,ij,jk->k", deformation, body.K, deformation))
        scale = np.ones(all_loads.shape[1])
        scale[loads.shape[1] :] = norms[: loads.shape[1]].max() / norms[loads.shape[1] :]
        return load_path_modes(body, all_loads * scale, LOAD_PATH_TOLERANCE, guided * scale)

    def recorded_loads(self) -> np.ndarray:
        """Principal combinations of the interface forces in driving, shape (3 n_interfaces, n), N.

        Raises `ModelError` if there is no table of loads, or it has other interfaces.
        """
        if self.section.loads is None:
            raise ModelError(
                f"{self.section.key('loads')} is missing: fidelity {Fidelity.LOAD_PATHS.value} needs a table of the "
                "forces on the frame in driving (python -m benchmarks.frame loads --car writes one)."
            )
        key = self.section.key("loads")
        rows = read_table(self.folder, self.section.loads, key, ("interface", "axis", "load_1"))
        columns = [title for title in rows[0].cells if title not in ("interface", "axis")]
        loads = {}
        for row in rows:
            if row["interface"] not in self.interfaces or row["axis"] not in ("x", "y", "z"):
                names = ", ".join(self.interfaces)
                name = f"{row['interface']} {row['axis']}"
                raise ModelError(f"{row.where}: {name} is not an axis of a joint of the suspension; these are {names}.")
            values = [row.number(column, -MAX_FORCE, MAX_FORCE, "N") for column in columns]
            loads[row["interface"], row["axis"]] = values
        for name in self.interfaces:
            for axis in "xyz":
                if (name, axis) not in loads:
                    raise ModelError(f"{key} ({self.section.loads}) has no line of joint {name}, axis {axis}.")
        return np.array([loads[name, axis] for name in self.interfaces for axis in "xyz"])

    def settled_loads(self, forces: np.ndarray) -> np.ndarray:
        """Interface forces with the axial forces of the wishbones that keep the distances of their pivots.

        `forces`: forces at the interfaces, N, shape (3 n_interfaces, n).
        """
        relief, pairs, n = self._relief_with_stretch
        return np.asarray(forces - pairs @ np.linalg.solve(relief.forces[n:] @ pairs, relief.balanced[n:] @ forces))

    def deformation_energy(self, forces: np.ndarray) -> np.ndarray:
        """Inner products of deformations of the free frame under interface forces, in the energy norm, (n, n), J.

        `forces`: forces at the interfaces, N, shape (3 n_interfaces, n).
        """
        body = craig_bampton(self._unloaded_model, self.reference, self.interfaces, 0, inertia_modes=True)
        deformation = load_path_deformations(body, forces)
        return np.asarray(deformation.T @ body.K @ deformation)

    @cached_property
    def _relief_with_stretch(self) -> tuple[InertiaRelief, np.ndarray, int]:
        """Matrices from loads to gauges and to the stretch between pivots; interface forces per axial force of a
        wishbone; number of gauge rows."""
        return self._relief_for(self.gauge_rows)

    def _relief_for(self, outputs: np.ndarray) -> tuple[InertiaRelief, np.ndarray, int]:
        """As `_relief_with_stretch`, with the rows `outputs` by nodal displacements instead of the gauges."""
        model = self.model
        stretch = np.zeros((len(self.stiff_pairs), outputs.shape[1]))
        pairs = np.zeros((3 * len(self.interfaces), len(self.stiff_pairs)))
        for k, pair in enumerate(self.stiff_pairs):
            a, b = (model.node(name) for name in pair)
            direction = model.positions[a] - model.positions[b]
            direction /= np.linalg.norm(direction)
            for node, name, sign in ((a, pair[0], 1.0), (b, pair[1], -1.0)):
                stretch[k, model.freedoms(node)[:3]] = sign * direction
                start = 3 * self.interfaces.index(name)
                pairs[start : start + 3, k] = sign * direction
        relief = inertia_relief(model, self.reference, self.interfaces, np.vstack([outputs, stretch]))
        return relief, pairs, len(outputs)

    @cached_property
    def quasi_static(self) -> InertiaRelief:
        """Matrices from interface forces and rigid motion to the gauge readings, with wishbones of constant length."""
        return _with_rigid_wishbones(*self._relief_with_stretch)

    @cached_property
    def drawn(self) -> ReducedBody:
        """Modes by which the frame is drawn at every fidelity, as at DYNAMIC."""
        return self.reduced(Fidelity.DYNAMIC)

    @cached_property
    def quasi_static_amplitudes(self) -> InertiaRelief:
        """Matrices from interface forces and rigid motion to the amplitudes of `drawn`.

        The amplitudes solve the static equations of these modes, which represent the deformation under interface forces
        and rigid accelerations exactly, and that under the angular velocity approximately.
        """
        return _with_rigid_wishbones(*self._relief_for(self._amplitudes_of_displacements))

    def drawn_amplitudes(self, body: ModalBody) -> np.ndarray:
        """Matrix from amplitudes of another reduction of the frame to the nearest ones of `drawn` in the energy norm.

        `body`: a reduction of this frame with the same reference. Returns shape (n_modes of `drawn`, n_modes of
        `body`), the identity for `drawn` itself.
        """
        if body is self.drawn:
            return np.eye(body.n_modes)
        return np.asarray(self._amplitudes_of_displacements @ body.modes)

    @cached_property
    def _amplitudes_of_displacements(self) -> np.ndarray:
        """Matrix from nodal displacements to the nearest amplitudes of `drawn`; zero for a rigid motion."""
        drawn = self.drawn
        return np.linalg.solve(drawn.K, np.asarray((self.model.K @ drawn.modes).T))


def _with_rigid_wishbones(relief: InertiaRelief, pairs: np.ndarray, n: int) -> InertiaRelief:
    """The first n outputs of a relief, with the axial forces of the wishbones for which the stretch is zero."""
    correction = -relief.forces[:n] @ pairs @ np.linalg.inv(relief.forces[n:] @ pairs)

    def corrected(matrix: np.ndarray) -> np.ndarray:
        return np.asarray(matrix[:n] + correction @ matrix[n:])

    return InertiaRelief(
        corrected(relief.forces),
        corrected(relief.acceleration),
        corrected(relief.rotation),
        corrected(relief.balanced),
        relief.acceleration_of_forces,
    )


def _at_hard_points(model: FiniteElementModel, joints: FrameJoints) -> FiniteElementModel:
    """Copy of the model with its joints at the points of the car file, which have more digits than matrix files."""
    positions = model.positions.copy()
    for name, position in (*joints.accelerometers.items(), *joints.interfaces.items()):
        positions[model.node(name)] = position
    return replace(model, positions=positions)
