"""Outputs of the car, with the axes of ISO 8855, and constants of its FMU for drivers and courses."""

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
from mbs.vehicle.port_parts import port_outputs
from mbs.vehicle.ports import Ports
from mbs.vehicle.steering.steering_section import Steered
from mbs.vehicle.suspensions.anti_roll_bar import LINK

TYRE_OUTPUTS = {
    "Fx": "longitudinal_force",
    "Fy": "lateral_force",
    "Fz": "vertical_force",
    "Mz": "aligning_moment",
    "slip": "slip",
    "slip_angle": "slip_angle",
    "deflection": "deflection",
}
"""Outputs of a tyre by the name of the car's."""
STEERING_WORK = "energy.steering"
WORKS = {  # prefixes of the names of the elements, description
    "drive": (("drive",), "the drive on the car"),
    "brakes": (("brake ",), "the brakes"),
    "tyres": (("tyre ",), "the tyres, by rolling, slip and damping,"),
    "dampers": (("spring ", "damper ", "steering stop "), "dampers and stops of springs and steering"),
    "drag": (("drag", "lift "), "the air"),
    "ground": ((GROUND_CONTACT,), "the ground on the chassis itself"),
}


def vehicle_constants(m: Model, car: CarContent) -> None:
    """Add dimensions, steering and tyre friction as constants ``vehicle.*``, and the tables of springs and dampers."""
    drawn = ", with the ratio of the car file"  # a constant of FMI does not depend on the parameter of the ratio
    wheel_angle, angle = car.steering.wheel_angle_max, car.steering.front_wheel_angle_max
    for name, value, unit, text in (
        ("wheelbase", car.wheelbase, "m", "distance between the axles"),
        ("track_front", car.front.track, "m", "distance between the centres of the front wheels"),
        ("track_rear", car.rear.track, "m", "distance between the centres of the rear wheels"),
        ("length", car.vehicle.length, "m", "length of the outline, centred on the origin of the vehicle's axes"),
        ("width", car.vehicle.width, "m", "width of the outline without mirrors, centred on that origin too"),
        ("steering_wheel_angle_max", wheel_angle, "rad", f"angle of the steering wheel at steering = 1{drawn}"),
        ("steering_frequency", car.steering.frequency, "Hz", "of the follower from demand to steering wheel"),
        ("front_wheel_angle_max", angle, "rad", "mean steering angle of the front wheels at steering = 1"),
        (
            "steering_ratio",
            wheel_angle / angle,
            "1",
            f"angle of the steering wheel over that of the front wheels, both full{drawn}",
        ),
    ):
        m.constant(f"vehicle.{name}", value, unit, text)
    for name, axle in car.axles.items():
        tyre = axle.tyre
        m.constant(
            f"vehicle.tyre_friction_{name}",
            tyre.friction[0] / tyre.reference_friction,
            "1",
            f"largest longitudinal force of a {name} tyre over its nominal load, on a road with the coefficient of "
            "friction 1",
        )
    for name, axle in car.axles.items():  # after the others, whose value references must not change
        for part, table, columns in (
            ("spring", axle.spring.table, (("compression", "m"), ("force", "N"))),
            ("damper", axle.damper.table, (("speed", "m/s"), ("force", "N"))),
        ):
            for values, (column, unit) in zip(zip(*(table or ()), strict=True), columns, strict=False):
                for k, value in enumerate(values, 1):
                    text = f"{column} in row {k} of the table of a {name} {part}, a monotone cubic, before its factor"
                    m.constant(f"{name}.{part}.table.{column}_{k}", value, unit, text)


def car_outputs(
    car: CarContent,
    frame: FlexibleFrame | None,
    b: CarBuilder,
    steered: Steered,
    spins: Mapping[str, Spin],
) -> None:
    """Add all outputs and constants of a car. `frame`: None without a flexible frame."""
    m = b.m
    _add_chassis(b, car)
    steered.outputs()
    if car.ports.torque is None:
        car.drive.outputs(b)
    for channel in b.inputs.values():
        m.sense_input(f"used.{channel.name}", channel, description=f"{channel.name} as used")
    for name, spin in spins.items():
        _add_wheel(b, spin, name)
    _add_energies_and_solver(m)
    if frame is not None:
        stress_outputs(m, b.chassis, frame)
    if car.chassis.ground_contact is not None:
        _add_ground_contact(m)
    _add_work(m)
    vehicle_constants(m, car)
    steered.torque_outputs()
    for name, spin in spins.items():
        _add_wheel_pose(b, spin, name)
    _add_levers(m)
    if car.ports.any:
        port_outputs(b, car, spins)
    _add_steering_work(m, car.ports)
    m.book_of_added = "energy.added", "work of elements that are not the car's since the start, without what is stored"


def _add_chassis(b: CarBuilder, car: CarContent) -> None:
    """Add pose, velocity and acceleration of the chassis by its reference point, and its accelerometers."""
    m, chassis, origin = b.m, b.chassis.frame, car.vehicle.reference_point
    for c in "xyz":
        text = f"{c} of the reference point (centre of mass at rest), earth"
        m.sense_position(f"chassis.{c}", chassis, origin, c, description=text)
    m.sense_angle("chassis.yaw", chassis, "yaw", description="heading, positive to the left")
    m.sense_angle("chassis.pitch", chassis, "pitch", description="positive nose down")
    m.sense_angle("chassis.roll", chassis, "roll", description="positive left side up")
    for c in "wxyz":
        text = f"q{c} of the orientation, scalar first (qw), from vehicle to earth axes"
        m.sense_rotation(f"chassis.q{c}", chassis, c, description=text)
    directions = {"x": "forward", "y": "left", "z": "up"}
    for c, direction in directions.items():
        text = f"velocity of the reference point along the vehicle's {c} axis, {direction}"
        m.sense_position(f"chassis.v{c}", chassis, origin, c, chassis, order=1, description=text)
    for c in directions:
        text = f"angular velocity about the vehicle's {c} axis"
        m.sense_rotation(f"chassis.w{c}", chassis, c, order=1, description=text)
    for c, direction in directions.items():
        text = f"acceleration of the reference point along the vehicle's {c} axis, {direction}, without gravity"
        m.sense_position(f"chassis.a{c}", chassis, origin, c, chassis, order=2, description=text)
    reference, axes = chassis.point(origin), [chassis.vector(FORWARD), chassis.vector(LEFT)]
    m.sense_vector("speed", reference, order=1, description="speed of the reference point")
    text = "direction of travel from the heading, positive to the left; 0 below 0.1 m/s"
    m.sense_vector("sideslip", reference, axes, order=1, description=text)
    accelerated = b.chassis.accelerated
    for corner, point in car.chassis.accelerometers.items():
        for c in "xyz":
            text = (
                f"acceleration of the {corner} corner of the chassis base along the vehicle's {c} axis, without gravity"
            )
            m.sense_position(f"accelerometer_{corner}.a{c}", accelerated, point, c, chassis, order=2, description=text)


def _add_wheel(b: CarBuilder, spin: Spin, w: str) -> None:
    """Add angles, travel, spin and tyre forces of a wheel; the FMU puts its name before the descriptions."""
    m, chassis = b.m, b.chassis.frame
    forward, left, up = (chassis.vector(v) for v in (FORWARD, LEFT, UP))
    text = "steer angle about the vehicle's z axis, positive left"
    m.sense_angle(f"wheel_{w}.steer", (spin.axis, left, up), description=text)
    text = "deprecated, not the camber of ISO 8855 but a turn about the vehicle's x axis: use inclination"
    m.sense_angle(f"wheel_{w}.camber", (spin.axis, left, forward), description=text)
    if b.ports.tyre is None:
        text = "of the wheel plane from the road's normal about the wheel's x axis, top right positive (ISO 8855)"
        m.sense_element(f"wheel_{w}.inclination", f"tyre {w}", "inclination", description=text)
    text = "absolute angular velocity, positive forward"
    m.sense_coordinate(f"wheel_{w}.omega", spin, order=1, description=text, display_unit="rpm")
    travel_output(m, chassis, spin, w)
    for name, output in TYRE_OUTPUTS.items() if b.ports.tyre is None else ():
        m.sense_element(f"wheel_{w}.{name}", f"tyre {w}", output)
    m.sense_element(f"wheel_{w}.brake_torque", f"brake {w}", "torque")
    m.sense_element(f"spring_{w}.length", f"spring {w}", "length")
    m.sense_element(f"spring_{w}.force", f"spring {w}", "force")


def _add_wheel_pose(b: CarBuilder, spin: Spin, w: str) -> None:
    """Add outputs of the pose of one wheel and its carrier, and of its contact point."""
    m = b.m
    b.sense_components(f"wheel_{w}.{{}}", spin.centre, "m", "{} of the centre of the wheel, earth")
    text = "{} of the spin axis, earth; the unit vector points to the left"
    b.sense_components(f"wheel_{w}.axis_{{}}", spin.axis, "1", text)
    text = "angle by which the wheel has turned on its carrier since the start, about its axis, so positive forward; "
    m.sense_angle(f"wheel_{w}.angle", spin, description=f"{text}not wrapped")
    for c in "wxyz":
        text = (
            f"q{c} of the orientation of the wheel's carrier, which does not spin, scalar first (qw), from drawing to"
        )
        m.sense_rotation(f"wheel_{w}.q{c}", spin.carrier, c, description=f"{text} earth axes")
    for name in ("contact", "normal") if b.ports.tyre is None else ():
        for c in "xyz":
            m.sense_element(f"wheel_{w}.{name}_{c}", f"tyre {w}", f"{name}_{c}")


def _add_levers(m: Model) -> None:
    """Add the angles of the levers of anti-roll bars."""
    text = "angle of the lever from the drawing, about the vehicle's y axis"
    for index, coordinate in enumerate(m.coordinates):
        if coordinate.name.startswith(LINK):
            name = f"anti_roll_bar_{coordinate.name.removeprefix(LINK)}.angle"
            m.sense_coordinate(name, Affine({index: 1.0}), unit="rad", description=text)


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
    text = f"work of {text}friction of the steering since the start"
    m.sense_energy(STEERING_WORK, "nonconservative" if of_port else "with guides", friction, description=text)


def _add_energies_and_solver(m: Model) -> None:
    """Add the energies and the statistics of the solver."""
    for kind in ("kinetic", "gravity", "elastic", "total"):
        m.sense_energy(f"energy.{kind}", kind, description=f"{kind} energy")
    for kind in ("iterations", "violation", "residual", "halvings", "status"):
        when = "since the start" if kind == "halvings" else "last step"
        m.sense_solver(f"solver.{kind}", kind, description=f"{kind} of the solver, {when}")


def _add_ground_contact(m: Model) -> None:
    """Add outputs of the contact forces of the ground on the chassis."""
    text = "sum of the normal forces of the ground on the chassis itself; 0 while only tyres touch"
    force = m.sense_element("chassis.ground_force", GROUND_CONTACT, "normal_force", description=text)
    m.notice(force, "The chassis touches the ground")
    text = "number of points of the chassis that touch the ground"
    m.sense_element("chassis.ground_points", GROUND_CONTACT, "touching", description=text)
