"""Finite-element model with reference and interfaces fixed, from which Craig-Bampton modes are computed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu

from mbs.common.checks import instance_of, shown
from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel, Reference
from mbs.flexible.fe_model_checks import check_connected


@dataclass(frozen=True)
class Interface:
    """Node of joints or forces, whose translations and, if requested, rotations become static modes."""

    node: str | int
    translations: bool = True
    rotations: bool = False


class FixedInterface:
    """Model with the reference and the interface degrees of freedom held; the inner stiffness is factorised once.

    `reference`: node that carries the floating frame, or three nodes where nodes have no rotations; `interfaces`: a
    plain node stands for its translations. `held`, `boundary`, `inner`: degrees of freedom of the reference (6), of the
    interfaces (one per static mode, in order), and the others.
    """

    def __init__(
        self, model: FiniteElementModel, reference: Reference, interfaces: Sequence[Interface | str | int]
    ) -> None:
        self.model, self.reference = model, reference
        instance_of(FiniteElementModel, model, "The model", "a FiniteElementModel")
        if not isinstance(interfaces, (list, tuple)):
            raise ModelError(f"The interfaces must be a list of nodes, not {shown(interfaces)}.")
        self.interfaces = tuple(i if isinstance(i, Interface) else Interface(i) for i in interfaces)
        self.held = model.reference_freedoms(reference)
        numbers: list[np.ndarray] = []
        nodes: set[int] = set()
        for interface in self.interfaces:
            node = model.node(interface.node)
            if node in nodes:
                raise ModelError(f"Node {model.names[node]!r} is named twice among the interfaces.")
            nodes.add(node)
            if not (interface.translations or interface.rotations):
                raise ModelError(f"Interface {model.names[node]!r} has neither translations nor rotations.")
            freedom_groups = [model.freedoms(node, rotations=True)] if interface.rotations else []
            if interface.translations:
                freedom_groups.insert(0, model.freedoms(node))
            for freedoms in freedom_groups:
                if np.isin(freedoms, self.held).any():
                    raise ModelError(f"The reference node {model.names[node]!r} does not move: it is not an interface.")
            numbers.extend(freedom_groups)
        self.boundary = np.concatenate(numbers) if numbers else np.zeros(0, int)
        check_connected(model, reference)
        self.inner = np.setdiff1d(np.arange(model.n_dof), np.concatenate([self.held, self.boundary]))
        self._factor: SuperLU | None = None

    def solve(self, forces: np.ndarray) -> np.ndarray:
        """Displacements under nodal forces with reference and interfaces held, both of shape (n_dof, k)."""
        if self._factor is None:
            self._factor = splu(sp.csc_matrix(self.model.K[self.inner][:, self.inner]))
        u = np.zeros_like(forces)
        u[self.inner] = self._factor.solve(np.ascontiguousarray(forces[self.inner]))
        return u

    def static_modes(self) -> np.ndarray:
        """Displacements for unit motions of the interfaces, one after the other, shape (n_dof, n_static)."""
        unit = np.zeros((self.model.n_dof, self.boundary.size))
        unit[self.boundary, np.arange(self.boundary.size)] = 1.0
        if self.boundary.size == 0:
            return unit
        return np.asarray(unit - self.solve(np.asarray(self.model.K @ unit)))

    def held_freedoms(self) -> np.ndarray:
        """Degrees of freedom that are held in the dynamic modes."""
        return np.concatenate([self.held, self.boundary])
