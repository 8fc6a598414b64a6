"""Outputs of every steering."""

from mbs.model.model import Model
from mbs.model.records import DrivingFunction, Input
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.steering.steering_section import SteeringSection

WHEEL_ANGLE = "angle of the steering wheel, positive to the left"
WHEEL_TORQUE = "torque of the driver's hands on the steering wheel, positive to the left"
WHEEL_SPEED = "angular velocity of the steering wheel, positive to the left"
RACK_FORCE = "force of the tie rods on the rack, positive to the left"
RADIAN_OUTPUTS = ("steering_wheel_angle", "steering_wheel_speed", "steering_demand_excess")
"""Outputs in radians of the steering wheel, which are sensed from the travel of the rack or the angle of the arm."""
TORQUE_OUTPUT = "steering_wheel_torque"


def demand_outputs(m: Model, demand: Input, guide: DrivingFunction, scale: float) -> None:
    """Add the demand as used, and the part of both demands beyond full lock.

    `demand`: result of `SteeringSection.angle_demand`; `guide`: follows the demand; `scale`: radians of the steering
    wheel per unit of the driving function.
    """
    m.sense_input(f"used.{demand.name}", demand, description=f"{demand.name} as used")
    excess = m.sense_guide(
        "steering_demand_excess",
        guide,
        "excess",
        scale=scale,
        unit="rad",
        description="part of the demanded angle of the steering wheel beyond full lock, which is not followed",
    )
    m.notice(excess, "The demanded angle of the steering wheel is beyond full lock and held there")


def wheel_outputs(m: Model, held: DrivingFunction, per_radian: float, per_unit: float) -> None:
    """Add torque and speed of the steering wheel.

    `held`: driving function of the steering wheel; `per_radian`, `per_unit`: its unit per radian of the steering
    wheel, and the reciprocal.
    """
    m.sense_guide("steering_wheel_torque", held, "force", scale=per_radian, unit="N.m", description=WHEEL_TORQUE)
    m.sense_guide("steering_wheel_speed", held, order=1, scale=per_unit, unit="rad/s", description=WHEEL_SPEED)


def tie_ratio(
    b: CarBuilder, data: SteeringSection, name: str, held: DrivingFunction, turn: float, *, inverse: bool
) -> None:
    """Make the steering ratio a parameter of its driving function and of the outputs of the steering wheel.

    A table is scaled along the angle. Full lock of rack or arm and the range of the demanded angle do not change.

    `held`: driving function of the travel of the rack, of the angle in the table, or of the angle of the arm; `turn`:
    ratio over that driving function per radian of the steering wheel, or of their reciprocals; `inverse`: whether the
    angle of the steering wheel increases with the ratio.
    """
    value = getattr(data, name)
    if b.ports.steering is None:
        b.tie(data, name, held, "gain_2", 1.0 / turn, inverse=inverse)
    for sensor in b.m.sensors:
        if sensor.name in RADIAN_OUTPUTS:
            b.tie(data, name, ("sensor", sensor.name), 0, turn, inverse=not inverse)
        elif sensor.name == TORQUE_OUTPUT:
            weights = [t.weight for t in sensor.terms] or sensor.reals
            for k, weight in enumerate(weights):
                scale = weight * value if inverse else weight / value
                b.tie(data, name, ("sensor", TORQUE_OUTPUT), k, scale, inverse=inverse)
