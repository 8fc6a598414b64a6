"""The prototype car of the paper (sections 3.4 and 4), rigid or with a flexible chassis: steering, throttle, brake."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from mbs.elements.automatic_drive import AutomaticDrive
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad, Road
from mbs.model import Model
from mbs.model.guides import Guide
from mbs.scenes.prototype_car import car_data
from mbs.scenes.prototype_car.chassis import chassis as chassis_of
from mbs.scenes.prototype_car.chassis import stress_outputs
from mbs.scenes.prototype_car.constants import vehicle_constants
from mbs.scenes.prototype_car.fidelity import OFFERED, Fidelity
from mbs.scenes.prototype_car.front_suspension import front_suspension
from mbs.scenes.prototype_car.ground_contact import ground_contact
from mbs.scenes.prototype_car.outputs import (
    chassis_outputs,
    control_outputs,
    health_outputs,
    wheel_outputs,
    work_outputs,
)
from mbs.scenes.prototype_car.rear_suspension import rear_suspension
from mbs.scenes.prototype_car.side import FRONT_SIDES, REAR_SIDES
from mbs.scenes.prototype_car.tyre_data import FRICTION, NOMINAL_LOAD
from mbs.scenes.prototype_car.wheels import wheel

FAR_AWAY = 1e6  # m: the default kerb lies where no manoeuvre goes
KERB_HEIGHT = 0.08  # m, of the paper's test
FOOTPRINT = (
    (-2.7, 0.4),
    (-0.9, 0.9),
)  # m, x and y of the car as drawn, from the rear edge of its wheels to the front one


def build(
    road: Road | None = None,
    fidelity: Fidelity | int | str = Fidelity.RIGID,
    guide: Callable[[Model], Guide] | None = None,
) -> Model:
    """The car at rest in static equilibrium, its front axle over the origin.

    Where the road under it is not level nothing but the brakes could hold it: there it starts as drawn, level, and
    settles; a pose must lift it above the road.

    Parameters
    ----------
    road : Road, optional
        By default level ground with a kerb, down by `road.kerb_height` at `road.kerb_x` (parameters; far away unless
        set), and the friction `road.friction`.
    fidelity : Fidelity, int or str
        How much of the chassis is modelled, a member of `Fidelity`, its number or its name: 0 "rigid", 1
        "quasi_static", 2 "load_paths", 3 "dynamic", and for comparison 4 "many_modes" and "paper".
    guide : callable, optional
        Makes the guide of the x coordinate of the floor's centre, m; the selector is then in neutral.

    Returns
    -------
    Model
        For `compile`.

    Raises
    ------
    ModelError
        An argument is not what it must be; the message names it.
    """
    fidelity = Fidelity.of(fidelity)
    m = Model("prototype car", gravity=(0.0, 0.0, -car_data.GRAVITY))
    m.floating = True
    m.start_in_equilibrium = _level_under_the_car(road)
    m.stop_time, m.step = 10.0, 0.002
    steering = m.input("steering", min=-1.0, max=1.0, description="steering, positive to the left")
    throttle = m.input("throttle", min=0.0, max=1.0, description="throttle pedal")
    pedal = m.input("brake", min=0.0, max=1.0, description="brake pedal")
    # the tie rods are behind the axle: the rack moves right to steer left
    rack = m.guide_input(
        "rack", input=steering, gain=-car_data.RACK_TRAVEL, frequency=car_data.RACK_FREQUENCY, unit="m"
    )
    ground = m.road(road or KerbRoad(FAR_AWAY, KERB_HEIGHT, -KERB_HEIGHT, "before", FRICTION))

    parts = chassis_of(m, fidelity)
    chassis = parts.frame
    spins = {}
    for side in FRONT_SIDES:
        spins[side.wheel] = wheel(m, front_suspension(m, parts.body, side, rack), side, ground, pedal)
    for side in REAR_SIDES:
        spins[side.wheel] = wheel(m, rear_suspension(m, parts.body, side), side, ground, pedal)
    z, x = parts.drive_axes  # the reaction of the drive is about the lateral axis of the chassis (z cross x = y)
    drive = AutomaticDrive(**(car_data.DRIVELINE if guide is None else car_data.DRIVELINE | {"creep_torque": 0.0}))
    m.add(drive.record("drive", spins["RL"].coordinate, spins["RR"].coordinate, z, x, throttle.index))
    m.drag("drag", chassis, car_data.REFERENCE_POINT, drag_area=car_data.DRAG_AREA, air_density=car_data.AIR_DENSITY)

    m.parameter(
        "drive.creep_torque",
        drive.creep_torque,
        0.0,
        200.0,
        "N.m",
        "torque per rear wheel at rest with closed throttle, the selector in drive; 0: neutral",
        targets=[("drive", "creep_torque", 1.0)],
    )
    m.equilibrium_parameters = {"drive.creep_torque": 0.0}
    _road_parameters(m, road, ground)
    chassis_outputs(m, chassis, parts.accelerated)
    control_outputs(m, rack, [steering, throttle, pedal])
    for w, spin in spins.items():
        wheel_outputs(m, chassis, spin, w)
    health_outputs(m)
    stress_outputs(m, parts, fidelity)
    ground_contact(m, parts, ground)
    work_outputs(m)
    vehicle_constants(m)
    if guide is not None:
        m.drive("guided way", chassis.point(parts.origin)[0], guide(m))
    return m


def fidelities() -> dict[Fidelity, Callable[[], Model]]:
    """The models an FMU offers by its parameter `fidelity`."""
    return {fidelity: partial(build, None, fidelity) for fidelity in OFFERED}


def _level_under_the_car(road: Road | None) -> bool:
    if isinstance(road, PlaneRoad):
        return road.grade_x == 0.0 and road.grade_y == 0.0
    if isinstance(road, GridRoad):
        heights = np.asarray(road.heights, float)
        cells = []
        for k, (low, high) in enumerate(FOOTPRINT):
            # a cell takes its slopes from one point more on each side
            first = math.floor((low - road.origin[k]) / road.spacing[k]) - 1
            last = math.ceil((high - road.origin[k]) / road.spacing[k]) + 1
            cells.append(np.clip(np.arange(first, last + 1), 0, heights.shape[k] - 1))
        return float(np.ptp(heights[np.ix_(*cells)])) == 0.0
    return True


def _road_parameters(m: Model, road: Road | None, ground: int) -> None:
    """What a user may set of the road."""
    names = (road or KerbRoad).real_names
    target = ("road", ground)
    if "friction" in names:
        friction = road.friction if isinstance(road, KerbRoad | PlaneRoad) else FRICTION if road is None else 1.0
        m.parameter(
            "road.friction",
            friction,
            0.0,
            2.0,
            "1",
            ("factor on the friction of the road" if isinstance(road, GridRoad) else "friction coefficient")
            + f": largest longitudinal tyre force over load at {NOMINAL_LOAD:g} N",
            targets=[(target, names.index("friction"), 1.0)],
        )
    if road is None:
        place, low, step = (names.index(n) for n in ("position", "lower_height", "step"))
        m.parameter(
            "road.kerb_x", FAR_AWAY, -FAR_AWAY, FAR_AWAY, "m", "x of the kerb's edge", targets=[(target, place, 1.0)]
        )
        m.parameter(
            "road.kerb_height",
            KERB_HEIGHT,
            0.001,
            0.5,
            "m",
            "drop behind the kerb's edge",
            targets=[(target, low, -1.0), (target, step, 1.0)],
        )


__all__ = ["Fidelity", "build", "fidelities"]
