"""Force at a point, given by inputs along the axes of a frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.common.affine import AffineVector
from mbs.common.errors import ModelError
from mbs.elements.record import ElementRecord
from mbs.elements.record_checks import channels, size
from mbs.kernel.header.enumerations import ElementType


@dataclass(frozen=True)
class BodyForce:
    """Force with components from inputs, N."""

    inputs: Sequence[int | None]
    """Numbers of the inputs along the axes, three in space and two in the plane; None: no force along that axis."""

    def record(self, name: str, point: AffineVector, axes: Sequence[AffineVector]) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        point : AffineVector
            Where the force acts.
        axes : sequence of AffineVector
            Three unit vectors in space, one in the plane (the second is it turned left); constant ones are fixed in the
            earth.
        """
        what = f"the force '{name}'"
        size(point, (2, 3), f"The point of {what}")
        dimension = len(point)
        if len(axes) != (3 if dimension == 3 else 1) or any(len(a) != dimension for a in axes):
            wanted = "three vectors" if dimension == 3 else "one vector"
            raise ModelError(f"The axes of {what} must be {wanted} of {dimension} components.")
        numbers = channels(self.inputs, dimension, what)
        signals = [s for vector in (point, *axes) for s in vector.components]
        return ElementRecord(name, ElementType.BODY_FORCE, signals, integer=(*numbers, -1)[:3])
