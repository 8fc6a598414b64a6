"""Sensors: numbers computed from the state, by the sensor types of the System file."""

from collections.abc import Sequence

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import flag, number, shown, text, whole
from mbs.common.errors import ModelError
from mbs.elements.record import ElementRecord
from mbs.kernel.header.enumerations import SensorType
from mbs.model.bodies import BodyVocabulary
from mbs.model.joints.joint import Joint
from mbs.model.sensor import Sensor, Term

RATE_UNITS = {"m": ("m", "m/s", "m/s2"), "rad": ("rad", "rad/s", "rad/s2")}


def order_number(order: int, max_order: int, subject: str) -> int:
    """Checked order of a rate: 0 for the value, 1 for its rate, 2 for its second rate."""
    return whole(order, f"The order of {subject}", 0, max_order)


def spatial(v: AffineVector) -> list[Affine]:
    """Three components of a vector; z = 0 in the plane."""
    return [*v.components, *([Affine()] * (3 - len(v)))]


class SensorVocabulary(BodyVocabulary):
    """Common parts of the ``sense_...`` methods of a model.

    Each registers one output under a name that is unique among the sensors, and returns its `Sensor`. Values are in SI
    units; `unit` and `description` only tell files, plots and hosts what they are. `scale` is a factor on the value.
    A vector, point, body or joint must be one of this model.
    """

    def _unit(self, unit: str, default: str) -> str:
        """The given unit, or the default if it is empty."""
        return default if isinstance(unit, str) and not unit else unit

    def _sense(
        self,
        name: str,
        unit: str,
        description: str,
        type: SensorType,
        signals: Sequence[Affine] = (),
        integers: Sequence[int] = (),
        reals: Sequence[float] = (),
        joint: Joint | None = None,
        joints: Sequence[Joint] = (),
        terms: Sequence[Term] = (),
        whole: bool = False,
        display_unit: str = "",
        computed: bool = True,
    ) -> Sensor:
        subject = f"sensor {shown(name)}"
        sensor = Sensor(
            name,
            text(unit, f"The unit of {subject}"),
            text(description, f"The description of {subject}", lines=True),
            type,
            signals,
            integers,
            reals,
            joint,
            joints,
            terms,
            flag(whole, f"The whole of {subject}"),
            text(display_unit, f"The display unit of {subject}"),
            computed=flag(computed, f"The computed of {subject}"),
        )
        return self.enter("sensor", self.sensors, sensor)

    def sense_element(
        self,
        name: str,
        element: ElementRecord | str,
        output: str,
        *,
        scale: float = 1.0,
        unit: str = "",
        description: str = "",
    ) -> Sensor:
        """An output of a force element, such as the force of a spring, by default with its unit and description.

        Parameters
        ----------
        element : ElementRecord or str
            A force element of this model or its name.
        output : str
            Name of one of its outputs.
        scale : float
            Factor on it.
        """
        element_name = element.name if isinstance(element, ElementRecord) else element
        if not isinstance(element_name, str) or not isinstance(output, str):
            raise ModelError(
                f"The sensor '{name}' needs a force element, or its name, and the name of an output, got "
                f"{shown(element)} and {shown(output)}."
            )
        factor = number(scale, f"The scale of sensor '{name}'")
        index = self.place_of(self.elements, element_name)
        if index is None:
            raise ModelError(
                f"The sensor '{name}' asks for element {shown(element_name)}, but the model has no such element."
            )
        outputs = self.elements[index].outputs
        k = self.place_of(outputs, output)
        if k is None:
            available = ", ".join(o.name for o in outputs) or "none"
            raise ModelError(
                f"The sensor '{name}' asks for {shown(output)} of element '{element_name}', which has: {available}."
            )
        out = outputs[k]
        return self._sense(
            name,
            self._unit(unit, out.unit),
            self._unit(description, out.description),
            SensorType.ELEMENT_OUTPUT,
            integers=[index, k],
            reals=[factor],
            whole=out.whole and factor == 1.0,
            display_unit=out.display_unit if isinstance(unit, str) and not unit else "",
        )

    def sense_vector(
        self,
        name: str,
        vector: AffineVector,
        axes: Sequence[AffineVector] = (),
        *,
        order: int = 0,
        unit: str = "",
        description: str = "",
    ) -> Sensor:
        """Length of a vector v, its component along a moving axis, or its direction in two of them.

        Without axes the length: the distance of two points, the speed of one. With one axis ``a . v``; with two, square
        to each other, ``atan2(b . v, a . v)``, rad: of a velocity the side-slip angle.

        Parameters
        ----------
        vector : AffineVector
            Such as ``body.point(p)`` or ``body_1.point(p) - body_2.point(q)``, m.
        axes : sequence of AffineVector
            At most two unit vectors of a body, such as ``body.vector((1, 0, 0))``.
        order : {0, 1, 2}
            The vector itself, its rate in the earth or, along one axis only, its second rate.
        """
        subject = f"sensor '{name}'"
        if not isinstance(axes, (list, tuple)) or len(axes) > 2:
            raise ModelError(f"The axes of {subject} must be a list of at most two vectors, not {shown(axes)}.")
        v, *unit_axes = (self.expressions(given, f"The {subject}") for given in (vector, *axes))
        k = order_number(order, 2 if len(unit_axes) == 1 else 1, subject)
        unit = self._unit(unit, "rad" if len(unit_axes) == 2 else RATE_UNITS["m"][k])
        if not unit_axes:
            return self._sense(name, unit, description, SensorType.NORM, v.components, integers=[k, len(v)])
        type = SensorType.COMPONENT if len(unit_axes) == 1 else SensorType.DIRECTION
        signals = [s for part in (v, *unit_axes) for s in spatial(part)]
        return self._sense(name, unit, description, type, signals, integers=[k])
