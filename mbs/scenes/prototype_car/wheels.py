"""Wheels: spin on the upright, tyre on the road, brake."""

from __future__ import annotations

from mbs.elements.brake import Brake
from mbs.model import Model
from mbs.model.body import Body
from mbs.model.inputs import Input
from mbs.model.spin import Spin
from mbs.scenes.prototype_car import car_data
from mbs.scenes.prototype_car.side import Side
from mbs.scenes.prototype_car.tyre_data import RADIUS, tyre

WHEEL = {"front": car_data.FRONT_WHEEL, "rear": car_data.REAR_WHEEL}
CENTRE = {"front": car_data.FRONT["wheel_centre"], "rear": car_data.REAR["wheel_centre"]}


def wheel(m: Model, upright: Body, side: Side, road: int, pedal: Input) -> Spin:
    """Add a wheel with its tyre and brake and return its spin."""
    axle, w = side.axle, side.wheel
    centre = side.point(CENTRE[axle])
    # a free wheel advances by (2 R + loaded radius)/3 per radian; at rest the loaded radius is the height of its centre
    rolling_radius = (2.0 * RADIUS[axle] + centre[2]) / 3.0
    spin = m.spin(
        f"wheel {w}", carrier=upright, centre=centre, axis=(0.0, 1.0, 0.0), rolling_radius=rolling_radius, **WHEEL[axle]
    )
    m.add(tyre(axle).record(f"tyre {w}", spin.centre, spin.axis, spin.coordinate, road))
    brake = Brake.for_wheel(car_data.BRAKE_TORQUE[axle], RADIUS[axle], WHEEL[axle]["spin_inertia"])
    m.add(brake.record(f"brake {w}", spin.f, spin.g, spin.coordinate, pedal.index))
    return spin
