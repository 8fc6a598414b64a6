"""Force and moment on the hub of a wheel, given by inputs instead of a tyre."""

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.elements.element import Element
from mbs.elements.integers import check_inputs, input_indices
from mbs.elements.record import ElementRecord, Output
from mbs.elements.wheel_signals import WHEEL, wheel_signals


@dataclass(frozen=True)
class HubWrench(Element):
    """Force and moment at the centre of a wheel that is reduced to its spin, earth axes.

    F acts on the centre, ``M.e`` on the spin about the axis e, and ``M x e`` on e, which is the rest of the moment on
    the carrier.
    """

    inputs: Sequence[int]
    """Numbers of the inputs: three components of the force, N, three of the moment, N m."""

    _noun = "a wrench"
    _signals = WHEEL
    _integers = input_indices("force_x force_y force_z moment_x moment_y moment_z", missing=False)
    _outputs = (Output("power", "W", "power of force and moment on wheel and carrier together"),)

    def record(self, name: str, centre: AffineVector, axis: AffineVector, spin: Affine) -> ElementRecord:
        label = self._label(name)
        return self._record(name, wheel_signals(centre, axis, spin, label), check_inputs(self.inputs, 6, label))
