"""Input of the demanded angle of the steering wheel."""

from mbs.model.model import Model
from mbs.model.records import Input


def angle_demand(m: Model, largest: float) -> Input:
    """Add the input of the demanded angle of the steering wheel, rad. `largest`: angle at full lock, rad."""
    return m.input(
        "steering_wheel_angle_demand",
        min=-largest,
        max=largest,
        unit="rad",
        description="angle of the steering wheel, positive to the left; it is added to what steering asks for",
    )
