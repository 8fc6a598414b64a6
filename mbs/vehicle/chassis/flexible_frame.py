"""Modes of a flexible frame and what its gauges read, at every fidelity."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from mbs.flexible import (
    FiniteElementModel,
    InertiaRelief,
    RayleighDamping,
    ReducedBody,
    craig_bampton,
    gauge_rows,
    inertia_relief,
    load_path_modes,
)
from mbs.flexible.load_path_modes import load_path_deformations
from mbs.vehicle.chassis.tubular_frame import TubularFrame
from mbs.vehicle.fidelity import Fidelity

MANY_MODES = 40
LOAD_PATH_TOLERANCE = 5e-3
"""Load paths whose deformation has less than this part of the largest, in the energy norm, are left out."""


class FlexibleFrame:
    """A frame as the chassis of a car.

    Parameters
    ----------
    tubular : TubularFrame
        Its tables.
    """

    def __init__(self, tubular: TubularFrame) -> None:
        self.tubular = tubular
        self.section = tubular.section
        self.interfaces = tubular.interfaces
        self.damping = RayleighDamping.fitted(self.section.damping.ratio, *self.section.damping.frequencies)
        # wishbones hold the distance of their two pivots: no load stretches the frame between them
        self.stiff_pairs = tuple((f"{a}{s}", f"{b}{s}") for a, b in self.section.rigid_pairs for s in "LR")
        self._reduced: dict[Fidelity, ReducedBody] = {}

    @cached_property
    def _finite_elements(self) -> tuple[FiniteElementModel, np.ndarray]:
        """Model, and rows of the moments at the gauges, then of the half-bridges."""
        frame, tubes = self.tubular.frame()
        return frame.finite_element_model(), np.vstack(gauge_rows(frame, self.tubular.strain_gauges(tubes)))

    @property
    def model(self) -> FiniteElementModel:
        """The finite-element model."""
        return self._finite_elements[0]

    @property
    def gauge_rows(self) -> np.ndarray:
        """From nodal displacements to the moments at the gauges, N m, then the half-bridges, Pa."""
        return self._finite_elements[1]

    def reduced(self, fidelity: Fidelity | int | str) -> ReducedBody:
        """The frame with the modes of a flexible fidelity.

        Parameters
        ----------
        fidelity : Fidelity, int or str
            From LOAD_PATHS on.
        """
        which = Fidelity.of(fidelity)
        if which not in self._reduced:
            self._reduced[which] = self._reduce(which)
        return self._reduced[which]

    def _reduce(self, fidelity: Fidelity) -> ReducedBody:
        s, model = self.section, self.model
        if fidelity is Fidelity.PAPER:
            return craig_bampton(model, s.reference, self.interfaces, s.dynamic_modes, damping=self.damping)
        count = {Fidelity.LOAD_PATHS: 0, Fidelity.DYNAMIC: s.dynamic_modes, Fidelity.MANY_MODES: MANY_MODES}[fidelity]
        body = craig_bampton(model, s.reference, self.interfaces, count, inertia_modes=True, damping=self.damping)
        if fidelity is not Fidelity.LOAD_PATHS:
            return body
        # without the stretch between the pivots of a wishbone the frame could not follow its fixed length, and without
        # all directions at the origin a guide, which pushes a pitched car upwards too, would bend it wrongly
        loads, pairs = self.tubular.recorded_loads(), self._relief_with_stretch[1]
        every = np.hstack([loads, pairs, np.zeros((len(loads), 3))])
        guided = np.zeros((6, every.shape[1]))
        guided[:3, -3:] = np.eye(3)
        deformation = load_path_deformations(body, every, guided)
        size = np.sqrt(np.einsum("ik,ij,jk->k", deformation, body.K, deformation))
        scale = np.ones(every.shape[1])
        scale[loads.shape[1] :] = size[: loads.shape[1]].max() / size[loads.shape[1] :]
        return load_path_modes(body, every * scale, LOAD_PATH_TOLERANCE, guided * scale)

    def settled_loads(self, forces: np.ndarray) -> np.ndarray:
        """Interface forces with the wishbones' axial forces that keep their pivots apart.

        Parameters
        ----------
        forces : ndarray, shape (3 n_interfaces, n)
            N.
        """
        relief, pairs, n = self._relief_with_stretch
        return np.asarray(forces - pairs @ np.linalg.solve(relief.forces[n:] @ pairs, relief.balanced[n:] @ forces))

    def deformation_energy(self, forces: np.ndarray) -> np.ndarray:
        """Products of the deformations under interface forces, freely accelerated, in the energy norm, (n, n), J.

        Parameters
        ----------
        forces : ndarray, shape (3 n_interfaces, n)
            N.
        """
        body = craig_bampton(self.model, self.section.reference, self.interfaces, 0, inertia_modes=True)
        deformation = load_path_deformations(body, forces)
        return np.asarray(deformation.T @ body.K @ deformation)

    @cached_property
    def _relief_with_stretch(self) -> tuple[InertiaRelief, np.ndarray, int]:
        """From loads to the gauges and to the stretch between pivots; forces per axial force; number of gauge rows."""
        model, outputs = self._finite_elements
        stretch = np.zeros((len(self.stiff_pairs), model.n_dof))
        pairs = np.zeros((3 * len(self.interfaces), len(self.stiff_pairs)))
        for k, pair in enumerate(self.stiff_pairs):
            a, b = (model.node(name) for name in pair)
            along = model.positions[a] - model.positions[b]
            along /= np.linalg.norm(along)
            for node, name, sign in ((a, pair[0], 1.0), (b, pair[1], -1.0)):
                stretch[k, model.freedoms(node)[:3]] = sign * along
                start = 3 * self.interfaces.index(name)
                pairs[start : start + 3, k] = sign * along
        relief = inertia_relief(model, self.section.reference, self.interfaces, np.vstack([outputs, stretch]))
        return relief, pairs, len(outputs)

    @cached_property
    def quasi_static(self) -> InertiaRelief:
        """From interface forces and motion to the moments and half-bridges; wishbones keep their pivots apart."""
        relief, pairs, n = self._relief_with_stretch
        # forces of each wishbone along its axis that undo the stretch
        undo = -relief.forces[:n] @ pairs @ np.linalg.inv(relief.forces[n:] @ pairs)

        def mixed(part: np.ndarray) -> np.ndarray:
            return np.asarray(part[:n] + undo @ part[n:])

        return InertiaRelief(
            mixed(relief.forces),
            mixed(relief.acceleration),
            mixed(relief.rotation),
            mixed(relief.balanced),
            relief.acceleration_of_forces,
        )
