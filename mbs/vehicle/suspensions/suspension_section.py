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
    """Points on what carries the wheel and near to it."""

    def open(self, folder: Path, centre: Point) -> None:
        """Read its files; done once by the reader of the car. `centre`: of the left wheel as drawn, m.

        Raises `CarFileError`: a file is missing or not right.
        """

    def require_links(self) -> None:
        """Refuse what has no links. Raises `ModelError`: it has none."""
        if not self.linked:
            raise ModelError(self.unlinked)

    @property
    def unlinked(self) -> str:
        """A sentence where there are no links, else empty."""
        return ""

    @property
    def stop_left_out(self) -> str:
        """Key path of the stop of the knuckles, where there is a place for one and none is there; else empty."""
        return ""

    def stop_faults(self, stops: Stops) -> Iterator[str]:
        """Whether it reaches to the ends of the stops of its springs."""
        yield from ()

    def rod_point(self, end: Literal["inner", "outer"]) -> Point | None:
        """End of the rod that steers or holds the left wheel, m; None where there is no rod."""
        return None

    def steers_left(self, centre: Point) -> bool:
        """Whether a rack that moves to the left steers to the left. `centre`: of the left wheel as drawn, m."""
        rod = self.rod_point("outer")
        assert rod is not None, "an axle that cannot steer is refused with the file"
        return rod[0] > centre[0]

    def steering_faults(self, steering: Steering | None) -> Iterator[str]:
        """Reasons why the axle cannot be steered so. `steering`: None for the rear axle."""
        yield from ()

    def steering_oddities(self, steering: Steering, centre: Point) -> Iterator[str]:
        """Whether full lock turns the wheels by as much as the file says. `centre`: of the left wheel as drawn, m."""
        yield from ()
