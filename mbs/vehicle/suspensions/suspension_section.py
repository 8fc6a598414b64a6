"""Base class of the sections of suspensions in a car file."""

from collections.abc import Iterator
from pathlib import Path
from typing import ClassVar, Literal

from mbs.common.errors import ModelError
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section
from mbs.vehicle.springs import Stops
from mbs.vehicle.steering import Steering


class SuspensionSection(Section):
    """A suspension by links, or by a table in their place."""

    linked: ClassVar[bool] = True
    """Whether links with hard points carry the wheels."""
    near_wheel: ClassVar[tuple[str, ...]] = ()
    """Names of the points on the wheel carrier."""

    def open(self, folder: Path, centre: Point) -> None:
        """Read the files of the suspension. `centre`: centre of the left wheel as drawn, m.

        Raises `CarFileError` if a file is missing or not valid.
        """

    def require_links(self) -> None:
        """Raise `ModelError` if the suspension has no links."""
        if not self.linked:
            raise ModelError(self.unlinked)

    @property
    def unlinked(self) -> str:
        """Sentence that the suspension has no links; empty if it has."""
        return ""

    @property
    def stop_left_out(self) -> str:
        """Key path of the stop of the knuckles if it is missing; empty if it is there or not possible."""
        return ""

    def stop_faults(self, stops: Stops) -> Iterator[str]:
        """Yield a sentence if the suspension does not reach the ends of the stops of its springs."""
        yield from ()

    def rod_point(self, end: Literal["inner", "outer"]) -> Point | None:
        """End of the tie rod or toe link of the left wheel, m; None without a rod."""
        return None

    def steers_left(self, centre: Point) -> bool:
        """Whether a rack that moves to the left steers to the left. `centre`: centre of the left wheel as drawn, m."""
        rod = self.rod_point("outer")
        assert rod is not None, "an axle that cannot steer is refused with the file"
        return rod[0] > centre[0]

    def steering_faults(self, steering: Steering | None) -> Iterator[str]:
        """Yield a sentence if the axle cannot have the steering, or none. `steering`: None for the rear axle."""
        yield from ()

    def steering_oddities(self, steering: Steering, centre: Point) -> Iterator[str]:
        """Yield a sentence if the wheel angle at full lock is not the file's. `centre`: centre of the left wheel, m."""
        yield from ()
