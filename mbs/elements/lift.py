"""Aerodynamic lift."""

from dataclasses import dataclass, replace

from mbs.common.affine import AffineVector
from mbs.common.checks import instance_of
from mbs.common.errors import ModelError
from mbs.elements.element import SPACE_OR_PLANE, Element
from mbs.elements.integers import WIND
from mbs.elements.reals import NotNegative, Number
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import check_components
from mbs.elements.wind import Wind


@dataclass(frozen=True)
class Lift(Element):
    """Lift rho A v^2 / 2 of a body in the air; several, one per axle, make a pitching moment too.

    It acts along the upward axis of the body; v is the speed of the point along the forward axis, relative to the wind
    if there is one.
    """

    lift_area: Number
    """Lift coefficient times frontal area, m^2; a negative one gives downforce."""
    air_density: NotNegative = 1.225
    """Density of the air, kg/m^3."""

    _noun = "a lift"
    _signals = tuple((name, SPACE_OR_PLANE) for name in ("point", "forward", "up"))
    _integers = tuple(replace(of, optional=True) for of in WIND)
    _outputs = (Output("force", "N", "lift, positive along the upward axis"),)

    def record(
        self, name: str, point: AffineVector, forward: AffineVector, up: AffineVector, wind: Wind | None = None
    ) -> ElementRecord:
        """Make the record of the element for the kernel.

        Parameters
        ----------
        point : AffineVector
            Point at which the force acts, m, two or three components, in wind three.
        forward, up : AffineVector
            Unit vectors of the body, as many components: v is the speed of the point along the first, the force acts
            along the second.
        wind : Wind, optional
            Inputs of the speed and heading of the wind; by default the air is still.
        """
        label = self._label(name)
        check_components(point, (2, 3), f"The point of {label}")
        for axis, noun in ((forward, "forward axis"), (up, "upward axis")):
            check_components(axis, (2, 3), f"The {noun} of {label}")
            if len(axis) != len(point):
                raise ModelError(
                    f"The {noun} of {label} has {len(axis)} components and its point {len(point)}; they must agree."
                )
        air: tuple[int, ...] = ()
        if wind is not None:
            air = instance_of(Wind, wind, f"The wind of {label}", "a Wind or None").inputs
            check_components(point, (3,), f"The point in wind of {label}")
        return self._record(name, (*point.components, *forward.components, *up.components), air)
