"""Finite-element models of frames of beams."""

import numpy as np
import scipy.sparse as sp

from mbs.common.checks import flag
from mbs.flexible.beam_frame import Beam, BeamFrame
from mbs.flexible.beam_mass import beam_mass_points
from mbs.flexible.beam_stiffness import shear_parameters
from mbs.flexible.body_plausibility import FlexibleWarning, model_plausibility
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.fe_model_checks import check_free
from mbs.flexible.mass_points import MassPoints, nodal_mass_points

__all__ = ["Beam", "Frame"]


class Frame(BeamFrame):
    """Nodes, rigidly joined beams and lumped masses; see `BeamFrame` for its parameters."""

    def finite_element_model(self, mass: str = "consistent", rotary: bool = True) -> FiniteElementModel:
        """Assemble; node k has the degrees of freedom 6 k to 6 k + 5 (x, y, z, rx, ry, rz).

        Parameters
        ----------
        mass : str
            "consistent" or "lumped", see `beam_mass_points`.
        rotary : bool
            Whether the sections of the beams carry their rotary inertia.

        Returns
        -------
        FiniteElementModel
            Free, with the nodes of the frame.

        Raises
        ------
        ModelError
            There is no such kind of mass.

        Warns
        -----
        FlexibleWarning
            Mass or size are impossible in SI units.
        """
        rotary = flag(rotary, "The rotary inertia")
        n = len(self.positions)
        rows, columns, values = [], [], []
        for e in range(len(self.beams)):
            T = np.kron(np.eye(4), self.element_axes(e)[1])
            k = T.T @ self.element_stiffness(e) @ T
            dof = self.element_freedoms(e)
            rows.append(np.repeat(dof, 12))
            columns.append(np.tile(dof, 12))
            values.append(((k + k.T) / 2).ravel())
        indices = (np.concatenate(rows), np.concatenate(columns))
        K = sp.csc_array(sp.coo_array((np.concatenate(values), indices), shape=(6 * n, 6 * n)))
        K.eliminate_zeros()
        dof = np.arange(6 * n).reshape(n, 6)
        points = self._beam_mass(mass, rotary)
        if mass == "lumped" and not rotary:
            nodal = self.masses + np.asarray(points.interpolation.T @ np.repeat(points.masses, 3)).reshape(n, 6)[:, 0]
            points = nodal_mass_points(self.positions, nodal, dof[:, :3], 6 * n)
        else:
            points = points.merged(nodal_mass_points(self.positions, self.masses, dof[:, :3], 6 * n))
        model = FiniteElementModel(self.positions, self.names, dof, K, points, self, mass == "consistent")
        check_free(model)
        for plausibility in model_plausibility(model, modes=False):
            plausibility.warn(FlexibleWarning)
        return model

    def _beam_mass(self, kind: str, rotary: bool) -> MassPoints:
        """Mass points of all beams; arguments as in `finite_element_model`."""
        positions, masses, rows, columns, values = [], [], [], [], []
        count = 0
        for e, beam in enumerate(self.beams):
            length, R = self.element_axes(e)
            shear = shear_parameters(beam.section, beam.material, length, self.theory)
            local, m, shapes = beam_mass_points(beam.section, beam.material, length, shear, kind, rotary)
            N = np.einsum("ba,pbc->pac", R, shapes) @ np.kron(np.eye(4), R)
            positions.append(self.positions[beam.i] + local @ R)
            masses.append(m)
            block = 3 * count + np.arange(3 * len(m))
            dof = self.element_freedoms(e)
            rows.append(np.repeat(block, 12))
            columns.append(np.tile(dof, block.size))
            values.append(N.reshape(-1, 12).ravel())
            count += len(m)
        shape = (3 * count, 6 * len(self.positions))
        indices = (np.concatenate(rows), np.concatenate(columns))
        interpolation = sp.csr_array(sp.coo_array((np.concatenate(values), indices), shape=shape))
        interpolation.eliminate_zeros()
        return MassPoints(np.vstack(positions), np.concatenate(masses), interpolation)
