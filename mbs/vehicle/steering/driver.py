"""What a driver asks of a steering, and what every steering reports to him."""

from __future__ import annotations

from mbs.model.mechanism import Mechanism
from mbs.model.records import Guide, Input

WHEEL_TORQUE = "torque of the driver's hands on the steering wheel, positive to the left"
WHEEL_SPEED = "angular velocity of the steering wheel, positive to the left"
RACK_FORCE = "force of the tie rods on the rack, positive to the left"


def angle_demand(m: Mechanism, largest: float) -> Input:
    """The input of the steering wheel's angle in rad. `largest`: angle at full lock, rad."""
    return m.input(
        "steering_wheel_angle_demand",
        min=-largest,
        max=largest,
        unit="rad",
        description="angle of the steering wheel, positive to the left; it is added to what steering asks for",
    )


def demand_outputs(m: Mechanism, demand: Input, guide: Guide, scale: float) -> None:
    """The demand as used, and what full lock takes away of both demands together.

    `demand`: from `angle_demand`; `guide`: that follows the demand; `scale`: radians of the steering wheel per unit of
    the guide.
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
