"""Input of the demanded angle of the steering wheel."""

from mbs.model.model import Model
from mbs.model.records import Input


def angle_demand(m: Model, max_angle: float) -> Input:
    """Add the input of the demanded angle of the steering wheel, rad. `max_angle`: angle at full lock, rad."""
    return m.input(
        "steering_wheel_angle_demand",
        min=-max_angle,
        max=max_angle,
        unit="rad",
        description="angle of the steering wheel, positive to the left; it is added to what steering asks for",
    )
