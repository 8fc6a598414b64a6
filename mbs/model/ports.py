"""Rigid bodies with ports: points at which the total force of joints and springs can be sensed.

Joints and springs at a port share three coordinates without mass, its position from the centre of mass, which three
linear rows tie to the body. The multipliers of these rows are the total force on the body at the port.
"""

from collections.abc import Mapping

from numpy.typing import ArrayLike

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector, vector
from mbs.model.body import Body, same_place, size_about
from mbs.model.joints.joint import Joint, equal_vectors
from mbs.model.register import Register


class PortedBody(Body):
    """A rigid body with ports; made by `Model.ported`.

    Attributes
    ----------
    ports : dict of str to Joint
        The rows of each port; force on the body: plus the multipliers, earth axes, N.
    """

    def __init__(self, model: Register, owner: Body, places: Mapping[str, Vector]) -> None:
        super().__init__(model, f"{owner.name} with ports", owner.com, owner.start)
        self.owner = owner
        self.ports: dict[str, Joint] = {}
        self._points: list[tuple[Vector, AffineVector]] = []
        for name, position in places.items():
            port_name = f"{owner.name}.{name}"
            # from the centre of mass, so that rows keep their accuracy far from the origin of the earth
            arm = position - owner.com
            numbers = [model.new_coordinate(f"{port_name}.{'xyz'[k]}", "vector", float(arm[k]), k) for k in range(3)]
            arm_vector = AffineVector(tuple(Affine({i: 1.0}) for i in numbers))
            joint = Joint(
                port_name, "port", equal_vectors(port_name, "point", arm_vector, owner.vector(arm)), rows_weight=1.0
            )
            joint.as_rows = True
            self.ports[name] = model._join(joint)
            self._points.append((position, owner.point(owner.com) + arm_vector))

    def point(self, position: ArrayLike) -> AffineVector:
        """The port at a position, or the point of the body if no port is there.

        `position`: earth axes in the reference configuration, m, shape (3,).
        """
        p = vector(position, self.dimension, f"a point of body '{self.name}'")
        for port_position, arm_vector in self._points:
            if same_place(p, port_position, size_about(self, port_position)):
                return arm_vector
        return super().point(p)
