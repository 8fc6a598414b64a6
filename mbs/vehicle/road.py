"""Road under a car: by default level, with a kerb far away unless its parameters are set."""

from collections.abc import Mapping

from mbs.elements.road import KerbRoad, PlaneRoad, PortRoad, Road, RoadOfFile
from mbs.kernel.header.limits import FARTHEST
from mbs.model.model import Model
from mbs.vehicle.quantities import Factor, RoadFriction
from mbs.vehicle.section import Section
from mbs.vehicle.tyres import Tyre

DEFAULT_KERB_X = 2.0 * FARTHEST  # m, where no car can start
KERB_HEIGHT = 0.08  # m, of the paper's test
BUILT_IN = "of the built-in road, without effect on one from a file"


class RoadSection(Section):
    """Road under the car."""

    friction: RoadFriction
    """Friction of the road: the forces of each tyre are its curves times friction / `reference_friction`."""
    friction_factor: Factor = 1.0
    """Factor on `friction`, and on the frictions of a road from a file."""

    def default(self) -> KerbRoad:
        """Make the road without a file: level ground with a kerb."""
        return KerbRoad(DEFAULT_KERB_X, KERB_HEIGHT, -KERB_HEIGHT, "before", self.friction, self.friction_factor)

    def grip_of(self, tyre: Tyre) -> float:
        """Factor of road and tyre on the largest forces in the file of the tyre."""
        return self.friction * self.friction_factor * tyre.grip / tyre.reference_friction

    def parameters(
        self,
        m: Model,
        road: Road | RoadOfFile | None,
        ground: int,
        hold_at: str,
        works: Mapping[str, tuple[float, float]],
    ) -> None:
        """Add the parameters of the road.

        `road`: road of the model; None: `default`; `hold_at`: frictions at which the curves of the tyres hold, for the
        description; `works`: ranges in which the car works, by key path.
        """
        base_road = self.default() if road is None else road.road if isinstance(road, RoadOfFile) else road
        target = ("road", ground)
        assert not isinstance(base_road, PortRoad), "a car with its road at ports has no parameters of one"
        if isinstance(base_road, KerbRoad | PlaneRoad):
            m.parameter(
                "road.friction",
                base_road.friction,
                *_range(self, "friction"),
                f"friction of the road; the curves of the tyres hold at {hold_at}; {BUILT_IN}",
                targets=[(target, "friction", 1.0)],
                works=works.get("road.friction"),
            )
        if road is None:
            self._kerb(m, ground)
        m.parameter(
            "road.friction_factor",
            base_road.friction_factor,
            *_range(self, "friction_factor"),
            "factor on the friction of the road, also of one from a file",
            targets=[(target, "friction_factor", 1.0)],
            works=works.get("road.friction_factor"),
        )

    @staticmethod
    def _kerb(m: Model, ground: int) -> None:
        """Add the parameters of the kerb."""
        target = ("road", ground)
        m.parameter(
            "road.kerb_x",
            DEFAULT_KERB_X,
            -DEFAULT_KERB_X,
            DEFAULT_KERB_X,
            "m",
            f"x of the kerb's edge; {BUILT_IN}",
            targets=[(target, "position", 1.0)],
        )
        m.parameter(
            "road.kerb_height",
            KERB_HEIGHT,
            0.001,
            0.5,
            "m",
            f"drop behind the kerb's edge; {BUILT_IN}",
            targets=[(target, "lower_height", -1.0), (target, "step", 1.0)],
        )


def _range(section: Section, field: str) -> tuple[float, float, str]:
    """Range and unit of a parameter by the type of its field."""
    q = section.quantity(field)
    assert q is not None, f"{section.key(field)} is not a quantity"
    return q.least, q.high, q.unit
