"""Vocabulary of flexible bodies and of rigid ones with a quasi-static deformation."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.checks import array, instance_of, mapping, shown, vector, whole
from mbs.common.errors import ModelError
from mbs.flexible.modal_body import ModalBody
from mbs.flexible.relief_matrices import InertiaRelief
from mbs.kernel.header.enumerations import SensorType
from mbs.model.bodies import ROTATION
from mbs.model.body import Body
from mbs.model.flexible import FlexibleBody
from mbs.model.ports import PortedBody
from mbs.model.sensor import Sensor
from mbs.model.sensors import SensorVocabulary


class FlexibleVocabulary(SensorVocabulary):
    """Bodies with nodes or ports, and sensors of a structure at ports."""

    def flexible_body(
        self,
        name: str,
        reduced: ModalBody,
        *,
        origin: ArrayLike = (0.0, 0.0, 0.0),
        axes: ArrayLike | None = None,
    ) -> FlexibleBody:
        """A flexible body from a reduced finite-element model.

        Parameters
        ----------
        reduced : ModalBody
            A `ReducedBody`, for instance of `mbs.flexible.craig_bampton`.
        origin : array_like, shape (3,)
            Origin of the finite-element model in the reference configuration, earth axes, m.
        axes : array_like, shape (3, 3), optional
            Columns: axes of the finite-element model in earth axes there; by default the same.

        Returns
        -------
        FlexibleBody
            Its nodes, `FlexibleBody.interface`, take joints, forces and sensors.

        Raises
        ------
        ModelError
            The model is planar, the axes are not a rotation, or all mass lies on a line.
        """
        subject = f"flexible body {shown(name)}"
        if self.dimension != 3:
            raise ModelError(f"The {subject} needs a spatial model; this one has dimension 2.")
        value: object = reduced
        if not isinstance(value, ModalBody):
            kind = type(value).__name__
            raise ModelError(f"The {subject} needs a ReducedBody, got {kind}: the argument reduced is {shown(value)}.")
        position = vector(origin, 3, f"the origin of {subject}")
        R = np.eye(3) if axes is None else array(axes, (3, 3), f"The axes of {subject}")
        if not np.allclose(R @ R.T, np.eye(3), atol=ROTATION) or np.linalg.det(R) < 0.0:
            raise ModelError(f"The axes of {subject} must be the columns of a rotation matrix.")
        new = FlexibleBody(self, self.unique("body", name), reduced, position, R, len(self.coordinates))
        self._register(new)
        return new

    def ported(self, body: Body, ports: Mapping[str, ArrayLike]) -> PortedBody:
        """A rigid body with ports: joints and springs given the result leave the forces there to be read.

        Parameters
        ----------
        ports : mapping of str to array_like, shape (3,)
            Places by name, earth axes in the reference configuration, m.

        Returns
        -------
        PortedBody
            Use it instead of the body.

        Raises
        ------
        ModelError
            The body is not rigid, or the model is planar.
        """
        self.owned(body, "The ports")
        if self.dimension != 3 or body.is_ground or body.is_point or body.is_flexible:
            raise ModelError(f"Ports belong to a rigid body in space, not to '{body.name}'.")
        checked = mapping(ports, f"The ports of body '{body.name}'", "names to places")
        if not checked:
            raise ModelError(f"The ports of body '{body.name}' are {shown(ports)}; it needs one at least.")
        positions = {n: vector(p, 3, f"the port {shown(n)} of body '{body.name}'") for n, p in checked.items()}
        return PortedBody(self, body, positions)

    def sense_quasi_static(
        self,
        name: str,
        body: PortedBody,
        relief: InertiaRelief,
        output: int,
        origin: ArrayLike,
        *,
        unit: str = "",
        description: str = "",
    ) -> Sensor:
        """An output of a structure that follows the forces at the ports of a rigid body and its motion at once.

        Parameters
        ----------
        relief : InertiaRelief
            Interfaces in the order of the ports, in earth axes in the reference configuration.
        output : int
            Row of its matrices.
        origin : array_like, shape (3,)
            Its origin in the reference configuration, m.

        Raises
        ------
        ModelError
            The body has no ports, or the matrices have other ports or lack the row.
        """
        subject = f"sensor '{name}'"
        if not isinstance(self.owned(body, f"The {subject}"), PortedBody):
            raise ModelError(f"The {subject} needs a body with ports, not '{body.name}'.")
        instance_of(InertiaRelief, relief, f"The relief of {subject}", "an InertiaRelief")
        n, row = len(body.ports), whole(output, f"The output of {subject}", 0)
        if relief.forces.shape[1] != 3 * n or not row < len(relief.forces):
            raise ModelError(
                f"The {subject} needs matrices of {n} interfaces and a row of them; they have "
                f"{relief.forces.shape[1] // 3} and {len(relief.forces)} rows, the row is {shown(output)}."
            )
        signals = [*body.point(origin).components, *(s for e in np.eye(3) for s in body.vector(e).components)]
        weights = np.concatenate([relief.forces[row], relief.acceleration[row], relief.rotation[row]])
        reals = [*self.gravity, *weights]
        return self._sense(
            name, unit, description, SensorType.QUASI_STATIC, signals, [n], reals, joints=list(body.ports.values())
        )
