"""Inputs and outputs of ports instead of parts of the car."""

from collections.abc import Mapping
from functools import partial
from typing import Literal

import numpy as np

from mbs.common.affine import AffineVector
from mbs.elements.body_force import BodyForce
from mbs.elements.body_torque import BodyTorque
from mbs.elements.record import ElementRecord
from mbs.elements.road import PortRoad
from mbs.elements.spin_torque import SpinTorque
from mbs.elements.wind import Wind
from mbs.model.carried_parts import Spin
from mbs.model.model import Model
from mbs.model.records import Ahead
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.chassis.ground_contact import NAME as GROUND_CONTACT
from mbs.vehicle.drives import Drive
from mbs.vehicle.inputs import new_port
from mbs.vehicle.road import RoadSection

WHEELS = ("FL", "FR", "RL", "RR")
MAX_TORQUE = 1e4  # N m, on a wheel
MAX_FORCE = 1e5  # N, on the chassis
MAX_MOMENT = 1e5  # N m, on the chassis
FASTEST_WIND = 100.0  # m/s


def torque_ports(
    b: CarBuilder, spins: Mapping[str, Spin], drive: Drive, kind: Literal["half_shafts", "hub_motors"]
) -> None:
    """Add torques on the wheels instead of a drive.

    `spins`: spins of the wheels by name; `drive`: the replaced one, whose parts that turn with the wheels remain with
    half shafts; `kind`: axis of the reaction, "half_shafts": the lateral axis of the chassis, "hub_motors": the axis of
    the wheel on its carrier.
    """
    reaction_body = "chassis" if kind == "half_shafts" else "carrier of the wheel"
    text = f"torque on the wheel about its axis, positive forward, with its reaction on the {reaction_body}"
    for w, spin in spins.items():
        channel = new_port(b, f"wheel_{w}.drive_torque", -MAX_TORQUE, MAX_TORQUE, "N.m", text)
        axes = b.chassis.drive_axes if kind == "half_shafts" else (spin.f, spin.g)
        b.m.add(SpinTorque(channel.index).record(f"port drive {w}", *axes, spin.coordinate))
    if kind == "half_shafts":
        drive.turning_parts(b, spins)


def force_ports(b: CarBuilder, car: CarContent, axes: Literal["earth", "vehicle"]) -> None:
    """Add forces and torques of another program on the chassis, and the motion of their points as outputs.

    `axes`: axes of forces and torques.
    """
    m = b.m
    frame = [AffineVector.constant(v) for v in np.eye(3)] if axes == "earth" else b.chassis.contact_frame[1]
    for name, position in (car.ports.force_points or {"reference": car.vehicle.reference_point}).items():
        point = b.chassis.place(position)
        channels = []
        for letter, unit, largest, kind in (("F", "N", MAX_FORCE, "force"), ("M", "N.m", MAX_MOMENT, "torque")):
            for c in "xyz":
                text = f"{kind} on the chassis along the {c} axis of the {axes}, acting at the point '{name}'"
                channels.append(new_port(b, f"point_{name}.{letter}{c}", -largest, largest, unit, text).index)
        m.add(BodyForce(channels[:3]).record(f"port force {name}", point, frame))
        torque = BodyTorque(channels[3:], "earth" if axes == "earth" else "body")
        m.add(torque.record(f"port torque {name}", b.chassis.contact_frame[1]))
        for order, prefix, unit, kind in ((0, "", "m", "place"), (1, "v", "m/s", "velocity")):
            text = f"{kind} of the point '{name}' of the chassis along the earth's {{}} axis"
            column = f"point_{name}.{prefix}{{}}"
            b.port_senses.append(partial(b.sense_components, column, point, unit, text, order=order))


def wind_port(b: CarBuilder) -> Wind | None:
    """Add speed and heading of the wind; None without the port."""
    if b.ports.wind is None:
        return None
    turn = 2.0 * np.pi
    text = "speed of the air over the ground"
    speed = new_port(b, "wind.speed", 0.0, FASTEST_WIND, "m/s", text)
    text = "heading that the air moves to, from the earth's x axis, positive to the left"
    return Wind(speed.index, new_port(b, "wind.heading", -turn, turn, "rad", text).index)


def road_ports(m: Model, road: RoadSection) -> tuple[int, dict[str, int]]:
    """Add the road under each wheel as inputs, and their mean under the chassis.

    `road`: its friction holds until the inputs are set.

    Returns
    -------
    int
        Number of the road under the chassis.
    dict of str to int
        Numbers of the roads under the wheels by wheel.
    """
    friction = road.friction * road.friction_factor
    answers = {w: m.road_answer(f"wheel_{w}.road", friction=friction, near=f"wheel_{w}.x") for w in WHEELS}
    under = {w: m.road(PortRoad([k])) for w, k in answers.items()}
    return m.road(PortRoad(list(answers.values()))), under


def tyre_outputs(m: Model, w: str, tyre: ElementRecord) -> None:
    """Add radius and moments of the tyre of a wheel. `w`: name of the wheel, such as "FL"."""
    m.sense_element(f"wheel_{w}.loaded_radius", tyre, "loaded_radius")
    if "overturning_moment" in {output.name for output in tyre.outputs}:
        m.sense_element(f"wheel_{w}.Mx", tyre, "overturning_moment")
    else:
        text = "overturning moment of the tyre about the contact point: 0, as its disc has no width"
        m.sense_constant(f"wheel_{w}.Mx", 0.0, unit="N.m", description=text)
    m.sense_element(f"wheel_{w}.My", tyre, "rolling_moment")


def port_outputs(b: CarBuilder, car: CarContent, spins: Mapping[str, Spin]) -> None:
    """Add the outputs for co-simulation through ports. `spins`: spins of the wheels by name."""
    m = b.m
    for channel in b.port_inputs:
        m.sense_input(f"used.{channel.name}", channel, description=f"{channel.name} as used")
    reference = b.chassis.frame.point(car.vehicle.reference_point)
    text = "velocity of the reference point along the earth's {} axis"
    b.sense_components("chassis.earth_v{}", reference, "m/s", text, order=1)
    named = {element.name: element for element in m.elements}
    for w, spin in spins.items():
        _add_wheel_outputs(b, car, w, spin, named)
    for sense in b.port_senses:
        sense()
    _add_energy_outputs(b, car)
    _add_brake_pressures(b, car)


def _add_wheel_outputs(b: CarBuilder, car: CarContent, w: str, spin: Spin, named: Mapping[str, ElementRecord]) -> None:
    """Add the outputs of a wheel: powers of drive and brake, tyre, velocity, road ahead, damper.

    `w`: such as FL; `named`: elements of the model by name.
    """
    m = b.m
    if car.ports.torque is None and w[0].lower() == car.drive.wheels[0]:
        text = "torque of the drive on the wheel about its axis, positive forward"
        side = "left" if w[1] == "L" else "right"
        torque = f"{side}_torque" if car.drive.kind == "automatic" else "wheel_torque"
        m.sense_element(f"wheel_{w}.drive_torque", "drive", torque, description=text)
        m.sense_element(f"wheel_{w}.drive_power", "drive", f"{side}_power")
    if car.ports.torque is not None:
        m.sense_element(f"wheel_{w}.drive_power", f"port drive {w}", "power")
    m.sense_element(f"wheel_{w}.brake_power", f"brake {w}", "power")
    if car.ports.tyre is None:
        tyre_outputs(m, w, named[f"tyre {w}"])
    text = "velocity of the centre of the wheel along the earth's {} axis"
    b.sense_components(f"wheel_{w}.earth_v{{}}", spin.centre, "m/s", text, order=1)
    for c in "xy" if car.ports.road is not None else "":
        text = f"{c} of the contact point ports.road_lead steps of communication later, if they are like the last"
        position_name, rate_name = f"wheel_{w}.contact_{c}", f"wheel_{w}.earth_v{c}"
        m.ahead.append(Ahead(f"wheel_{w}.road_ahead_{c}", "m", text, position_name, rate_name))
    damper = f"damper {w}" if f"damper {w}" in named else f"spring {w}"
    text = "rate of the length of the damper, positive in rebound"
    m.sense_element(f"damper_{w}.speed", damper, "rate", description=text)
    text = "force of the damper without spring and stops, tension positive"
    m.sense_element(f"damper_{w}.force", damper, "damper_force", description=text)


def _add_energy_outputs(b: CarBuilder, car: CarContent) -> None:
    """Add the work that reaches the car through roads and ports."""
    m = b.m
    elements = [element for element in m.elements if element.name.startswith("port ")]
    if car.ports.road is not None:
        standing = [e for e in m.elements if e.name.startswith("tyre ") or e.name == GROUND_CONTACT]
        text = "what answers on the road have added to the energy stored in tyres and ground since the start"
        m.sense_energy("energy.road", "by inputs", standing, description=text)
    text = "work of the ports since the start; the work of the brakes is in energy.brakes"
    guided = car.ports.steering == "rack_position"
    if elements or guided:
        kind = "with guides" if guided else "nonconservative"
        m.sense_energy("energy.ports", kind, elements, description=text)


def _add_brake_pressures(b: CarBuilder, car: CarContent) -> None:
    """Add the pressures that pedal or demanded torques take."""
    m = b.m
    if car.ports.brakes is None:
        text = "pressure in the brakes of all wheels by the pedal"
        m.sense_input("brake_pressure", b.inputs["brake"], scale=car.ports.full_pressure, unit="Pa", description=text)
    for channel in b.port_inputs if car.ports.brakes == "torque" else ():
        wheel, _, name = channel.name.partition(".")
        share, factor = car.brakes.shares(wheel[-2:])
        if name == "brake_torque_demand" and share > 0.0:
            text = "pressure that the torque asked for takes in a brake as that of the car file"
            scale = car.ports.full_pressure / (car.brakes.torque * share * factor)
            m.sense_input(f"used.{wheel}.brake_pressure", channel, scale=scale, unit="Pa", description=text)
