"""Air that moves over the ground."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.elements.record_checks import index


@dataclass(frozen=True)
class Wind:
    """Air that moves over the ground, by two inputs."""

    speed: int
    heading: int
    """`speed`, `heading`: numbers of the inputs: speed of the air, m/s, and the heading that it moves to, rad from the
    x axis of the earth to the left."""

    def integers(self, what: str) -> tuple[int, int]:
        """Checked numbers of the inputs.

        Parameters
        ----------
        what : str
            The element that is in it, for sentences.
        """
        speed = index(self.speed, f"The speed of the air of {what}")
        return speed, index(self.heading, f"The heading of the air of {what}")
