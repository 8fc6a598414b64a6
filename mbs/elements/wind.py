"""Wind from inputs."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Wind:
    """Velocity of the air over the ground from two inputs."""

    speed: int
    """Number of the input of the speed, m/s."""
    heading: int
    """Number of the input of the heading to which the air moves, rad from the x axis of the earth to the left."""

    @property
    def inputs(self) -> tuple[int, int]:
        """Numbers of the inputs, for the record of an element."""
        return self.speed, self.heading
