"""Sensors: numbers computed from the state, by the sensor types of the System file."""

from __future__ import annotations

from collections.abc import Sequence

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import flag, shown, text, whole
from mbs.common.errors import ModelError
from mbs.kernel.header import SensorType
from mbs.model.bodies import BodyVocabulary
from mbs.model.joints.joint import Joint
from mbs.model.reactions import Term
from mbs.model.sensor import Sensor

COMPONENTS = {"x": 0, "y": 1, "z": 2}
SIGNALS = (SensorType.SIGNAL, SensorType.SIGNAL_RATE, SensorType.SIGNAL_SECOND_RATE)
RATE_UNITS = {"m": ("m", "m/s", "m/s2"), "rad": ("rad", "rad/s", "rad/s2")}


def component_number(component: str, dimension: int, what: str) -> int:
    """Number of a component.

    Parameters
    ----------
    component : {"x", "y", "z"}
        Its name.
    dimension : int
        2 or 3.
    what : str
        What asks for it, for the message.

    Returns
    -------
    int
        0, 1 or 2.

    Raises
    ------
    ModelError
        There is no such component.
    """
    k = COMPONENTS.get(component, -1) if isinstance(component, str) else -1
    if not 0 <= k < dimension:
        names = "'x' or 'y'" if dimension == 2 else "'x', 'y' or 'z'"
        raise ModelError(f"The component of {what} is {shown(component)}; it must be {names}.")
    return k


def order_number(order: int, most: int, what: str) -> int:
    """Order of a rate: 0 for the value, 1 for its rate, 2 for its second rate."""
    return whole(order, f"The order of {what}", 0, most)


def spatial(v: AffineVector) -> list[Affine]:
    """Three components; a planar vector gets z = 0."""
    return [*v.components, *([Affine()] * (3 - len(v)))]


class SensorBase(BodyVocabulary):
    """How the ``sense_...`` methods of a model register a sensor: each has a name, a unit and a description."""

    def _unit(self, unit: str, default: str) -> str:
        """The unit that was given, else the default."""
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
        what = f"sensor {shown(name)}"
        sensor = Sensor(
            self.unique("sensor", name),
            text(unit, f"The unit of {what}"),
            text(description, f"The description of {what}", lines=True),
            type,
            signals,
            integers,
            reals,
            joint,
            joints,
            terms,
            flag(whole, f"The whole of {what}"),
            text(display_unit, f"The display unit of {what}"),
            computed=flag(computed, f"The computed of {what}"),
        )
        self.sensors.append(sensor)
        return sensor
