"""Sensors: numbers computed from the state, by the sensor types of the System file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NoReturn

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import flag, shown, text, whole
from mbs.common.errors import ModelError
from mbs.kernel.header.enumerations import SensorType
from mbs.model.bodies import BodyVocabulary
from mbs.model.joints.joint import Joint
from mbs.model.reactions import Term
from mbs.model.sensor import Sensor

COMPONENTS = {"x": 0, "y": 1, "z": 2}
SIGNALS = (SensorType.SIGNAL, SensorType.SIGNAL_RATE, SensorType.SIGNAL_SECOND_RATE)
RATE_UNITS = {"m": ("m", "m/s", "m/s2"), "rad": ("rad", "rad/s", "rad/s2")}


def component_number(component: str, dimension: int, what: str) -> int:
    """Number of a component. `dimension`: 2 or 3."""
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


RENAMED = {
    "sense_velocity": "sense_position(..., order=1)",
    "sense_acceleration": "sense_position(..., order=2)",
    "sense_norm": "sense_vector(name, vector)",
    "sense_component": "sense_vector(name, vector, [axis])",
    "sense_direction": "sense_vector(name, point, [axis_1, axis_2], order=1)",
    "sense_quaternion": 'sense_rotation(name, body, "w")',
    "sense_angular_rate": "sense_rotation(name, body, component, order=1)",
    "sense_yaw": 'sense_angle(name, body, "yaw")',
    "sense_pitch": 'sense_angle(name, body, "pitch")',
    "sense_roll": 'sense_angle(name, body, "roll")',
    "sense_angle_between": "sense_angle(name, (a, b, c))",
    "sense_spin_angle": "sense_angle(name, spin)",
    "sense_recovery": "sense_coordinate(name, body.combination(weights))",
    "sense_guide_excess": 'sense_guide(name, guide, "excess")',
    "sense_guide_force": 'sense_guide(name, guide, "force")',
    "sense_joint_force": "sense_joint(name, joint, component)",
    "sense_joint_moment": 'sense_joint(name, joint, component, "moment")',
    "sense_work": 'sense_energy(name, "work", elements)',
}
"""Calls of earlier versions, and what they are now."""


class SensorBase(BodyVocabulary):
    """What the ``sense_...`` methods of a model have in common.

    Each registers one output under a name that is unique among the sensors, and returns its `Sensor`. Values are in SI
    units; `unit` and `description` only tell files, plots and hosts what they are. `scale` is a factor on the value.
    A vector, point, body or joint must be one of this model.
    """

    if not TYPE_CHECKING:  # for mypy a name that is not there stays an error

        def __getattr__(self, name: str) -> NoReturn:
            more = f"; it is now {RENAMED[name]}" if name in RENAMED else ""
            raise AttributeError(f"A model has no {name!r}{more}.", name=name, obj=self)

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

    def _joint(self, name: str, joint: Joint | str) -> Joint:
        found = self.joint_named(joint) if isinstance(joint, str) else joint
        if not isinstance(found, Joint) or found not in self.joints:
            raise ModelError(f"The sensor '{name}' needs a joint of model '{self.name}', got {shown(joint)}.")
        self.remember(found)
        return found

    def _joints(self, name: str, argument: str, given: Sequence[Joint | str]) -> list[Joint]:
        if not isinstance(given, (list, tuple)) or not given:
            raise ModelError(f"The {argument} of sensor '{name}' must be a list of joints, not {shown(given)}.")
        return [self._joint(name, joint) for joint in given]
