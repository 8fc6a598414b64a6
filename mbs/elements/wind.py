"""Air that moves over the ground."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Wind:
    """Air that moves over the ground, by two inputs."""

    speed: int
    heading: int
    """`speed`, `heading`: numbers of the inputs: speed of the air, m/s, and the heading that it moves to, rad from the
    x axis of the earth to the left."""

    @property
    def inputs(self) -> tuple[int, int]:
        """Numbers of the inputs, for the record of an element."""
        return self.speed, self.heading
