"""Outputs of the car, with the axes of ISO 8855."""

from collections.abc import Mapping

from mbs.common.affine import Affine
from mbs.model.carried_parts import Spin
from mbs.model.model import Model
from mbs.vehicle.axes import FORWARD, LEFT, UP
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.chassis.flexible_chassis import stress_outputs
from mbs.vehicle.chassis.flexible_frame import FlexibleFrame
from mbs.vehicle.chassis.ground_contact import NAME as GROUND_CONTACT
from mbs.vehicle.checks.equilibrium import travel_output
from mbs.vehicle.constants import vehicle_constants
from mbs.vehicle.fidelity import Fidelity
from mbs.vehicle.port_parts import port_outputs
from mbs.vehicle.ports import Ports
from mbs.vehicle.steering.steering_interface import Steered
from mbs.vehicle.suspensions.anti_roll_bar import LINK


def car_outputs(
    m: Model,
    car: CarContent,
    frame: FlexibleFrame | None,
    fidelity: Fidelity,
    b: CarBuilder,
    steered: Steered,
    spins: Mapping[str, Spin],
) -> None:
    """Add all outputs and constants of a car. `m`: model of `b`; `frame`: None without a flexible frame."""
    _add_chassis_pose(m, b, car)
    _add_chassis_motion(m, b, car)
    _add_accelerometers(m, b, car)
    steered.outputs()
    if car.ports.torque is None:
        car.drive.outputs(b)
    for channel in b.inputs.values():
        m.sense_input(f"used.{channel.name}", channel, description=f"{channel.name} as used")
    for name, spin in spins.items():
        _add_wheel(m, b, spin, name)
    _add_energies_and_solver(m)
    if frame is not None:
        stress_outputs(m, b.chassis, frame, fidelity)
    if car.chassis.ground_contact is not None:
        _add_ground_contact(m)
    _add_work(m)
    vehicle_constants(m, car)
    steered.torque_outputs()
    for name, spin in spins.items():
        _add_wheel_pose(m, b, spin, name)
    _add_levers(m)
    if car.ports.any:
        port_outputs(m, b, car, spins)
    _add_steering_work(m, car.ports)
    m.book_of_added = "energy.added", "work of elements that are not the car's since the start, without what is stored"


def _add_chassis_pose(m: Model, b: CarBuilder, car: CarContent) -> None:
    """Add position of the reference point, and angles and orientation of the chassis."""
    chassis, origin = b.chassis.frame, car.vehicle.reference_point
    for c in "xyz":
        m.sense_position(
            f"chassis.{c}",
            chassis,
            origin,
            c,
            description=f"{c} of the reference point (centre of mass at rest), earth",
        )
    m.sense_angle("chassis.yaw", chassis, "yaw", description="heading, positive to the left")
    m.sense_angle("chassis.pitch", chassis, "pitch", description="positive nose down")
    m.sense_angle("chassis.roll", chassis, "roll", description="positive left side up")
    for c in "wxyz":
        m.sense_rotation(
            f"chassis.q{c}",
            chassis,
            c,
            description=f"q{c} of the orientation, scalar first (qw), from vehicle to earth axes",
        )


def _add_chassis_motion(m: Model, b: CarBuilder, car: CarContent) -> None:
    """Add velocity and acceleration of the reference point in vehicle axes, angular velocity, speed and sideslip."""
    chassis, origin = b.chassis.frame, car.vehicle.reference_point
    for c, direction in zip("xyz", ("forward", "left", "up"), strict=True):
        m.sense_position(
            f"chassis.v{c}",
            chassis,
            origin,
            c,
            chassis,
            order=1,
            description=f"velocity of the reference point along the vehicle's {c} axis, {direction}",
        )
    for c in "xyz":
        m.sense_rotation(
            f"chassis.w{c}", chassis, c, order=1, description=f"angular velocity about the vehicle's {c} axis"
        )
    for c, direction in zip("xyz", ("forward", "left", "up"), strict=True):
        m.sense_position(
            f"chassis.a{c}",
            chassis,
            origin,
            c,
            chassis,
            order=2,
            description=f"acceleration of the reference point along the vehicle's {c} axis, {direction}, "
            "without gravity",
        )
    reference = chassis.point(origin)
    m.sense_vector("speed", reference, order=1, description="speed of the reference point")
    m.sense_vector(
        "sideslip",
        reference,
        [chassis.vector(FORWARD), chassis.vector(LEFT)],
        order=1,
        description="direction of travel from the heading, positive to the left; 0 below 0.1 m/s",
    )


def _add_accelerometers(m: Model, b: CarBuilder, car: CarContent) -> None:
    """Add the accelerations at the corners of the chassis base."""
    for corner, point in car.chassis.accelerometers.items():
        for c in "xyz":
            m.sense_position(
                f"accelerometer_{corner}.a{c}",
                b.chassis.accelerated,
                point,
                c,
                b.chassis.frame,
                order=2,
                description=f"acceleration of the {corner} corner of the chassis base along the vehicle's {c} axis, "
                "without gravity",
            )


def _add_wheel(m: Model, b: CarBuilder, spin: Spin, w: str) -> None:
    """Add angles, travel, spin and tyre forces of a wheel; the FMU puts its name before the descriptions."""
    chassis = b.chassis.frame
    forward, left, up = (chassis.vector(v) for v in (FORWARD, LEFT, UP))
    m.sense_angle(
        f"wheel_{w}.steer", (spin.axis, left, up), description="steer angle about the vehicle's z axis, positive left"
    )
    m.sense_angle(
        f"wheel_{w}.camber",
        (spin.axis, left, forward),
        description="deprecated, not the camber of ISO 8855 but a turn about the vehicle's x axis: use inclination",
    )
    if b.ports.tyre is None:
        m.sense_element(
            f"wheel_{w}.inclination",
            f"tyre {w}",
            "inclination",
            description="of the wheel plane from the road's normal about the wheel's x axis, top right positive "
            "(ISO 8855)",
        )
    m.sense_coordinate(
        f"wheel_{w}.omega", spin, order=1, description="absolute angular velocity, positive forward", display_unit="rpm"
    )
    travel_output(m, chassis, spin, w)
    for name, output in (
        (
            ("Fx", "longitudinal_force"),
            ("Fy", "lateral_force"),
            ("Fz", "vertical_force"),
            ("Mz", "aligning_moment"),
            ("slip", "slip"),
            ("slip_angle", "slip_angle"),
            ("deflection", "deflection"),
        )
        if b.ports.tyre is None
        else ()
    ):
        m.sense_element(f"wheel_{w}.{name}", f"tyre {w}", output)
    m.sense_element(f"wheel_{w}.brake_torque", f"brake {w}", "torque")
    m.sense_element(f"spring_{w}.length", f"spring {w}", "length")
    m.sense_element(f"spring_{w}.force", f"spring {w}", "force")


def _add_wheel_pose(m: Model, b: CarBuilder, spin: Spin, w: str) -> None:
    """Add outputs of the pose of one wheel and its carrier, and of its contact point."""
    for k, c in enumerate("xyz"):
        text = f"{c} of the centre of the wheel, earth"
        m.sense_coordinate(f"wheel_{w}.{c}", spin.centre[k], unit="m", description=text)
    for k, c in enumerate("xyz"):
        text = f"{c} of the spin axis, earth; the unit vector points to the left"
        m.sense_coordinate(f"wheel_{w}.axis_{c}", spin.axis[k], unit="1", description=text)
    m.sense_angle(
        f"wheel_{w}.angle",
        spin,
        description="angle by which the wheel has turned on its carrier since the start, about its axis, so positive "
        "forward; not wrapped",
    )
    for c in "wxyz":
        m.sense_rotation(
            f"wheel_{w}.q{c}",
            spin.carrier,
            c,
            description=f"q{c} of the orientation of the wheel's carrier, which does not spin, scalar first (qw), from "
            "drawing to earth axes",
        )
    for name in ("contact", "normal") if b.ports.tyre is None else ():
        for c in "xyz":
            m.sense_element(f"wheel_{w}.{name}_{c}", f"tyre {w}", f"{name}_{c}")


def _add_levers(m: Model) -> None:
    """Add the angles of the levers of anti-roll bars."""
    for index, coordinate in enumerate(m.coordinates):
        if coordinate.name.startswith(LINK):
            m.sense_coordinate(
                f"anti_roll_bar_{coordinate.name.removeprefix(LINK)}.angle",
                Affine({index: 1.0}),
                unit="rad",
                description="angle of the lever from the drawing, about the vehicle's y axis",
            )


STEERING_WORK = "energy.steering"
WORKS = {  # prefixes of the names of the elements, description
    "drive": (("drive",), "the drive on the car"),
    "brakes": (("brake ",), "the brakes"),
    "tyres": (("tyre ",), "the tyres, by rolling, slip and damping,"),
    "dampers": (("spring ", "damper ", "steering stop "), "dampers and stops of springs and steering"),
    "drag": (("drag", "lift "), "the air"),
    "ground": ((GROUND_CONTACT,), "the ground on the chassis itself"),
}


def _add_work(m: Model) -> None:
    """Add the nonconservative work of groups of elements since the start."""
    for name, (starts, text) in WORKS.items():
        elements = [e for e in m.elements if e.name.startswith(starts)]
        description = f"work of {text} since the start, without what is stored; negative: energy lost"
        if elements:
            m.sense_energy(f"energy.{name}", "nonconservative", elements, description=description)
        else:  # a chassis without contact points
            m.sense_constant(f"energy.{name}", 0.0, unit="J", description=description)


def _add_steering_work(m: Model, ports: Ports) -> None:
    """Add the work of a steering without a column since the start, after all other outputs.

    The work of a port for the travel of the rack is in `energy.ports`.
    """
    friction = [e for e in m.elements if e.name == "steering friction"]
    of_port = ports.steering == "rack_position"
    if any(sensor.name == STEERING_WORK for sensor in m.sensors) or (of_port and not friction):
        return
    text = "" if of_port else "the driver, who moves the steering by its angle, and of "
    m.sense_energy(
        STEERING_WORK,
        "nonconservative" if of_port else "with guides",
        friction,
        description=f"work of {text}friction of the steering since the start",
    )


def _add_energies_and_solver(m: Model) -> None:
    """Add the energies and the statistics of the solver."""
    for kind in ("kinetic", "gravity", "elastic", "total"):
        m.sense_energy(f"energy.{kind}", kind, description=f"{kind} energy")
    for kind in ("iterations", "violation", "residual", "halvings", "status"):
        when = "since the start" if kind == "halvings" else "last step"
        m.sense_solver(f"solver.{kind}", kind, description=f"{kind} of the solver, {when}")


def _add_ground_contact(m: Model) -> None:
    """Add outputs of the contact forces of the ground on the chassis."""
    force = m.sense_element(
        "chassis.ground_force",
        GROUND_CONTACT,
        "normal_force",
        description="sum of the normal forces of the ground on the chassis itself; 0 while only tyres touch",
    )
    m.notice(force, "The chassis touches the ground")
    m.sense_element(
        "chassis.ground_points",
        GROUND_CONTACT,
        "touching",
        description="number of points of the chassis that touch the ground",
    )
