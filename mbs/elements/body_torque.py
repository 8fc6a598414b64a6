"""Torque on a body from inputs."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from mbs.common.affine import AffineVector
from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.elements.element import Element
from mbs.elements.integers import Integer, check_inputs, input_indices
from mbs.elements.record import ElementRecord


@dataclass(frozen=True)
class BodyTorque(Element):
    """Torque with components from inputs, N m."""

    inputs: Sequence[int | None]
    """Numbers of the inputs: three in space, one in the plane; None: no torque about that axis."""
    axes: Literal["earth", "body"] = "earth"
    """Axes of the components."""

    _noun = "a torque"
    _signals = (("frame", (9, 2)),)
    _integers = (*input_indices("first second third", missing=True), Integer("axes", most=1))

    def record(self, name: str, frame: Sequence[AffineVector]) -> ElementRecord:
        """Make the record of the element for the kernel.

        Parameters
        ----------
        frame : sequence of AffineVector
            Orthonormal vectors of a body: a, b, c in space, a alone in the plane.
        """
        label = self._label(name)
        lengths = [len(v) for v in frame]
        if lengths not in ([3, 3, 3], [2]):
            raise ModelError(f"The frame of {label} must be three spatial or one planar vector, not {lengths} numbers.")
        numbers = check_inputs(self.inputs, len(frame), label)
        if not isinstance(self.axes, str) or self.axes not in ("earth", "body"):
            raise ModelError(f"The axes of {label} are {shown(self.axes)}; they must be 'earth' or 'body'.")
        signals = [s for vector in frame for s in vector.components]
        integers = (*numbers, int(self.axes == "body")) if len(frame) == 3 else (None, None, *numbers, 0)
        return self._record(name, signals, integers)
