"""A car: the checked content of a car file, and the models made of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from mbs.elements.road import Road, RoadOfFile
from mbs.model.model import Model
from mbs.model.records import DrivingFunction
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.built_car import BuiltCar, checked_car
from mbs.vehicle.changed_content import changed_content
from mbs.vehicle.chassis.flexible_chassis import amplitude_outputs
from mbs.vehicle.chassis.stress_scene import flexible_part
from mbs.vehicle.fidelity import Fidelity


class Car(BuiltCar):
    """Content of a car file, and the models of that car.

    SI units. Drawing axes after ISO 8855: x forward, y left, z up; the origin on level ground under the centre of the
    front axle, the car in static equilibrium. Points are on the left side; the right side mirrors y.
    """

    def model(
        self,
        road: Road | RoadOfFile | None = None,
        fidelity: Fidelity | int | str = Fidelity.RIGID,
        guide: Callable[[Model], DrivingFunction] | None = None,
    ) -> Model:
        """Model of the car at rest in static equilibrium, with its front axle above the origin.

        On a road that is not level at the origin, it starts level, as drawn, and settles; a pose must raise it above
        the road. On a road from a file it is raised automatically.

        Parameters
        ----------
        road : Road or RoadFile, optional
            By default level ground with a kerb, down by `road.kerb_height` at `road.kerb_x` (parameters; far away
            unless set), and the friction `road.friction`. The parameter `road.file` exchanges it for a file.
        fidelity : Fidelity, int or str
            Model of the chassis: a member of `Fidelity`, its number or its name.
        guide : callable, optional
            Adds the driving function that prescribes x of the chassis' reference point, m; the selector is then in
            neutral.

        Raises
        ------
        ModelError
            An argument is invalid, or the car has no frame for the fidelity; the message names it.

        Warns
        -----
        RoadWarning
            The road is a grid with a wall, a face that is higher than the radius of a wheel.
        """
        fidelity = Fidelity.of(fidelity)
        m = self.empty()
        drive = None if guide is None else lambda travel: m.drive("guided way", travel, guide(m))
        b = self.build(m, road, fidelity, drive)
        if Fidelity.DYNAMIC in self.offered:
            m.more_poses.append(partial(self._frame_poses, m, b))
        if fidelity is Fidelity.RIGID and Fidelity.QUASI_STATIC in self.offered:
            m.with_ports = partial(self.model, road, Fidelity.QUASI_STATIC, guide)
        return m

    def _frame_poses(self, m: Model, b: CarBuilder) -> list[dict[str, Any]]:
        """Add the amplitudes of the frame as outputs, and return its parts of the scene."""
        amplitude_outputs(m, b.chassis, self.flexible_frame)
        shift = np.subtract(self.vehicle.reference_point, b.chassis.frame.com)
        return [
            part | {"nodes": [[float(x) for x in np.add(node, shift)] for node in part["nodes"]]}
            for part in self.flexible_parts
        ]

    @cached_property
    def flexible_parts(self) -> list[dict[str, Any]]:
        """The list `flexible` of the scene of the car: its frame, deformed and coloured by stress."""
        return flexible_part(self.flexible_frame, self.model(fidelity=Fidelity.DYNAMIC), self.vehicle.reference_point)

    def fidelities(self) -> dict[Fidelity, Callable[[], Model]]:
        """Functions that build the models of all fidelities in `offered`, by fidelity."""
        return {fidelity: partial(self.model, None, fidelity) for fidelity in self.offered}

    def changed(self, values: Mapping[str, Any]) -> Car:
        """Copy of the car with other values, checked like a file.

        Parameters
        ----------
        values : mapping of str to object
            By key path, as "front.spring.stiffness"; "front.wheel.centre.2" is an element of a list.

        Raises
        ------
        CarFileError
            A key path does not exist, or the values do not describe a car; this car is unchanged.
        """
        what = f"car '{self.name}'"
        data = changed_content(self._data, values, what)
        return car_from(data, self._folder, what)


def car_from(data: Mapping[str, Any], folder: Path, what: str, *, at_rest: bool = True, warn: bool = False) -> Car:
    """The `Car` with the content of a file, checked; arguments as in `checked_car`."""
    return checked_car(Car, data, folder, what, at_rest=at_rest, warn=warn)
