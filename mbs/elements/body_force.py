"""Force at a point, given by inputs along the axes of a frame."""

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.common.affine import AffineVector
from mbs.common.errors import ModelError
from mbs.elements.element import SPACE_OR_PLANE, Element
from mbs.elements.integers import check_inputs, input_indices
from mbs.elements.record import ElementRecord
from mbs.elements.record_checks import check_components


@dataclass(frozen=True)
class BodyForce(Element):
    """Force with components from inputs, N."""

    inputs: Sequence[int | None]
    """Numbers of the inputs along the axes, three in space and two in the plane; None: no force along that axis."""

    _noun = "a force"
    _signals = (("point", SPACE_OR_PLANE), ("axes", (9, 2)))
    _integers = input_indices("first second third", missing=True)

    def record(self, name: str, point: AffineVector, axes: Sequence[AffineVector]) -> ElementRecord:
        """Make the record of the element for the kernel.

        Parameters
        ----------
        point : AffineVector
            Point at which the force acts, m.
        axes : sequence of AffineVector
            Three unit vectors in space; in the plane one, the second being this one turned left. Constant vectors are
            fixed in the earth.
        """
        label = self._label(name)
        check_components(point, (2, 3), f"The point of {label}")
        dimension = len(point)
        if len(axes) != (3 if dimension == 3 else 1) or any(len(a) != dimension for a in axes):
            expected = "three vectors" if dimension == 3 else "one vector"
            raise ModelError(f"The axes of {label} must be {expected} of {dimension} components.")
        numbers = check_inputs(self.inputs, dimension, label)
        signals = [s for vector in (point, *axes) for s in vector.components]
        return self._record(name, signals, (*numbers, None)[:3])
