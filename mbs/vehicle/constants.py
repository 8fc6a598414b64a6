"""Constants of the FMU for drivers and courses."""

from mbs.model.model import Model
from mbs.vehicle.car_content import CarContent


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
