"""Force elements: their data, checked, and the records that `compile()` reads.

Arguments of `record` that several elements share: `centre`, m, and `axis`, a unit vector to the left, belong to a
wheel; `spin`, `left` and `right` are absolute spins of wheels, rad; `f` and `g` are orthonormal vectors of the carrier,
f x g along the axis to the left; a `coordinate` is an angle, rad, or a length, m; a `difference` is p2 - p1 of two
points in earth axes, two or three components, m.
"""

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules
from mbs.kernel.header.enumerations import ElementType as _ElementType

if TYPE_CHECKING:
    from mbs.elements.automatic_drive import AutomaticDrive as AutomaticDrive
    from mbs.elements.body_force import BodyForce as BodyForce
    from mbs.elements.body_torque import BodyTorque as BodyTorque
    from mbs.elements.brake import Brake as Brake
    from mbs.elements.contact_points import ContactPoints as ContactPoints
    from mbs.elements.coordinate_friction import CoordinateFriction as CoordinateFriction
    from mbs.elements.drag import Drag as Drag
    from mbs.elements.electric_drive import ElectricDrive as ElectricDrive
    from mbs.elements.gyroscopic_spin import GyroscopicSpin as GyroscopicSpin
    from mbs.elements.hub_wrench import HubWrench as HubWrench
    from mbs.elements.input_force import InputForce as InputForce
    from mbs.elements.lift import Lift as Lift
    from mbs.elements.magic_tyre import MagicTyre as MagicTyre
    from mbs.elements.record import ElementRecord as ElementRecord
    from mbs.elements.record import Output as Output
    from mbs.elements.road import GridRoad as GridRoad
    from mbs.elements.road import KerbRoad as KerbRoad
    from mbs.elements.road import PlaneRoad as PlaneRoad
    from mbs.elements.road import PortRoad as PortRoad
    from mbs.elements.road import Road as Road
    from mbs.elements.scalar_spring_damper import ScalarSpringDamper as ScalarSpringDamper
    from mbs.elements.spin_angle import SpinAngle as SpinAngle
    from mbs.elements.spin_torque import SpinTorque as SpinTorque
    from mbs.elements.spring_damper import EndStops as EndStops
    from mbs.elements.spring_damper import SpringDamper as SpringDamper
    from mbs.elements.spring_damper_table import SpringDamperTable as SpringDamperTable
    from mbs.elements.torsion_bar import TorsionBar as TorsionBar
    from mbs.elements.tyre import Tyre as Tyre
    from mbs.elements.tyre import TyreCurve as TyreCurve
    from mbs.elements.tyre_bore import TyreBore as TyreBore
    from mbs.elements.wind import Wind as Wind
    from mbs.elements.wind_drag import WindDrag as WindDrag
    from mbs.kernel.header.enumerations import ElementType as ElementType

# imported at first use, so that a program that uses one element does not import all
_LAZY = {kind.name.title().replace("_", ""): f"mbs.elements.{kind.name.lower()}" for kind in _ElementType} | {
    "ElementRecord": "mbs.elements.record",
    "ElementType": "mbs.kernel.header.enumerations",
    "EndStops": "mbs.elements.spring_damper",
    "GridRoad": "mbs.elements.road",
    "KerbRoad": "mbs.elements.road",
    "Output": "mbs.elements.record",
    "PlaneRoad": "mbs.elements.road",
    "PortRoad": "mbs.elements.road",
    "Road": "mbs.elements.road",
    "TyreBore": "mbs.elements.tyre_bore",
    "TyreCurve": "mbs.elements.tyre",
    "Wind": "mbs.elements.wind",
}
__getattr__ = lazy_modules(__name__, (), _LAZY)

__all__ = sorted(_LAZY)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
