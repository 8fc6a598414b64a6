"""Axle whose parts are lookup-table bodies, with tables computed from its links.

The templates of suspensions build it as an axle with links, with `TableParts` instead of the model: each part becomes
a lookup-table body, each angle a lookup-table number, and joints are dropped since the tables contain the links.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.common.errors import ModelError
from mbs.model.body import Body
from mbs.model.carried_parts import Spin
from mbs.model.coordinate import Coordinate
from mbs.model.model import Model
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.linkages.linkage import Linkage, NotReachedError
from mbs.vehicle.linkages.pose_grid import PoseGrid, depends_on_second, pose_grid
from mbs.vehicle.side import Corner, sides

Array = NDArray[np.float64]
Brakes = Callable[[CarBuilder, Corner, Spin, float], None]

JOINTS = frozenset({"spherical", "distance", "point_on_line", "cylindrical", "revolute", "slide"})
"""Joints by which templates of suspensions connect their parts."""


class TableParts:
    """Substitute for the model in templates of suspensions, which adds parts as lookup-table bodies and no joints.

    `m`: the model, which receives the bodies and all other calls; `base`: the chassis; `grid`: poses of the parts;
    `compressions`: compressions of the springs by wheel, m; `rack`: travel of the rack of a steered axle, m.
    """

    def __init__(
        self, m: Model, base: Body, grid: PoseGrid, compressions: Mapping[str, Coordinate], rack: Coordinate | None
    ) -> None:
        self._m, self._base, self._grid = m, base, grid
        self._compressions, self._rack = compressions, rack

    def __getattr__(self, name: str) -> Any:
        if name in JOINTS:
            return lambda *args, **kwargs: None
        return getattr(self._m, name)

    def body(self, name: str, *, mass: float, com: ArrayLike, inertia: ArrayLike) -> Body:
        """Add a part of the axle as a lookup-table body.

        `name`: name of the part, which ends with the name of the wheel; `mass`, `com`, `inertia`: as in `Model.body`.
        """
        (linkage_body,) = (b for b in self._grid.linkage.model.bodies if b.name == name)
        poses = self._grid.full(linkage_body.start, 12)
        parameters, axes, poses = self._table_of(name, poses)
        rotations = np.swapaxes(poses[..., 3:].reshape(*poses.shape[:-1], 3, 3), -1, -2)
        return self._m.tabled_body(
            name,
            base=self._base,
            parameters=parameters,
            axes=axes,
            places=poses[..., :3],
            rotations=rotations,
            mass=mass,
            com=com,
            inertia=inertia,
        )

    def drop_link(self, name: str, *args: object, **kwargs: object) -> Coordinate:
        """Add the angle of the lever of an anti-roll bar, rad."""
        return self._angle(name)

    def relative_angle(self, name: str, *args: object, **kwargs: object) -> Coordinate:
        """Add an angle between two parts, rad."""
        return self._angle(name)

    def _angle(self, name: str) -> Coordinate:
        """Add a full coordinate of the linkage as a lookup-table number."""
        (k,) = (k for k, c in enumerate(self._grid.linkage.model.coordinates) if c.name == name)
        parameters, axes, values = self._table_of(name, self._grid.full(k, 1))
        return self._m.tabled_number(name, parameters=parameters, axes=axes, values=values[..., 0])

    def _table_of(self, name: str, values: Array) -> tuple[list[Coordinate], list[Array], Array]:
        """Table of a quantity of a wheel: its coordinates, the grid points along each, and the values on the grid."""
        grid = self._grid
        if grid.coupled:
            return list(self._compressions.values()), [grid.compression] * 2, values
        compression = self._compressions[name[-2:]]
        if self._rack is not None and depends_on_second(values):
            return [compression, self._rack], [grid.compression, grid.rack], values
        middle = int(np.argmin(np.abs(grid.rack)))
        return [compression], [grid.compression], values[:, middle]


def table_axle(b: CarBuilder, car: CarContent, axle: str, rack: Coordinate | None, brakes: Brakes) -> dict[str, Spin]:
    """Add an axle of lookup-table bodies and return the spins of its wheels by the wheels' names.

    Parameters
    ----------
    car : CarContent
        Car that has passed its checks.
    axle : str
        "front" or "rear".
    rack : Coordinate or None
        Travel of the rack, m, of the steered axle.
    brakes : callable
        Adds the brake of a wheel.

    Raises
    ------
    ModelError
        The links cannot be assembled up to the stops, or each side depends on both springs and on the rack.
    """
    linkage = Linkage(car, axle)
    data = getattr(car, axle)
    try:
        grid = pose_grid(linkage, 0.0 if rack is None else car.steering.full)
    except NotReachedError as error:
        raise ModelError(
            f"{data.suspension.key('kind')} '{data.suspension.kind}' makes no table up to its stops: {error}."
        ) from error
    if grid.coupled and len(grid.rack) > 1:
        raise ModelError(
            f"{data.suspension.key('kind')} '{data.suspension.kind}' steers and joins its sides; it has no table."
        )
    compressions = {s.wheel: b.m.travel(f"spring compression {s.wheel}") for s in sides(axle)}
    parts: Any = TableParts(b.m, b.chassis.frame, grid, compressions, rack)
    # without joints a tie rod needs no inner end
    spins: dict[str, Spin] = data.build(replace(b, m=parts), axle, lambda side, point: None, brakes)
    return spins
