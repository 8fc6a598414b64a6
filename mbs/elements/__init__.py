"""Force elements: their data, checked, and the records that `compile()` reads.

What several elements ask for in `record`: `centre`, m, and `axis`, a unit vector to the left, are those of a wheel;
`spin`, `left` and `right` are absolute spins of wheels, rad; `f` and `g` are orthonormal vectors of the carrier, f x g
along the axis to the left; a `coordinate` is an angle, rad, or a length, m; a `difference` is p2 - p1 of two points in
earth axes, two or three components, m.
"""

from mbs.elements.automatic_drive import AutomaticDrive
from mbs.elements.body_force import BodyForce
from mbs.elements.body_torque import BodyTorque
from mbs.elements.brake import Brake
from mbs.elements.contact_points import ContactPoints
from mbs.elements.coordinate_friction import CoordinateFriction
from mbs.elements.drag import Drag
from mbs.elements.electric_drive import ElectricDrive
from mbs.elements.gyroscopic_spin import GyroscopicSpin
from mbs.elements.hub_wrench import HubWrench
from mbs.elements.input_force import InputForce
from mbs.elements.lift import Lift
from mbs.elements.magic_tyre import MagicTyre
from mbs.elements.record import ElementRecord, Output
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad, PortRoad, Road
from mbs.elements.scalar_spring_damper import ScalarSpringDamper
from mbs.elements.spin_angle import SpinAngle
from mbs.elements.spin_torque import SpinTorque
from mbs.elements.spring_damper import EndStops, SpringDamper
from mbs.elements.spring_damper_table import SpringDamperTable
from mbs.elements.torsion_bar import TorsionBar
from mbs.elements.tyre import Tyre, TyreCurve
from mbs.elements.tyre_bore import TyreBore
from mbs.elements.wind import Wind
from mbs.elements.wind_drag import WindDrag
from mbs.kernel.header.enumerations import ElementType

__all__ = [
    "AutomaticDrive",
    "BodyForce",
    "BodyTorque",
    "Brake",
    "ContactPoints",
    "CoordinateFriction",
    "Drag",
    "ElectricDrive",
    "ElementRecord",
    "ElementType",
    "EndStops",
    "GridRoad",
    "GyroscopicSpin",
    "HubWrench",
    "InputForce",
    "KerbRoad",
    "Lift",
    "MagicTyre",
    "Output",
    "PlaneRoad",
    "PortRoad",
    "Road",
    "ScalarSpringDamper",
    "SpinAngle",
    "SpinTorque",
    "SpringDamper",
    "SpringDamperTable",
    "TorsionBar",
    "Tyre",
    "TyreBore",
    "TyreCurve",
    "Wind",
    "WindDrag",
]
