"""Typed content of a car file."""

from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, PrivateAttr

from mbs.common.errors import ModelError
from mbs.vehicle.aerodynamics import Aerodynamics
from mbs.vehicle.axle import Axle
from mbs.vehicle.brakes import Brakes
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.chassis.frames import Frame
from mbs.vehicle.chassis.section import Chassis
from mbs.vehicle.drives import Drive
from mbs.vehicle.names import CarName, Name, Text
from mbs.vehicle.ports import Ports
from mbs.vehicle.quantities import Length, Mass, Point, Quantity
from mbs.vehicle.quantities import Payload as PayloadMass
from mbs.vehicle.road import RoadSection
from mbs.vehicle.section import Section, sections_of
from mbs.vehicle.side import Point as Coordinates
from mbs.vehicle.steering import Steering

MARGIN = 0.13
"""Margin of the footprint around the wheels and the outline, m; chosen."""


class Payload(Section):
    """A person or a piece of luggage."""

    mass: PayloadMass
    """Mass of the payload."""
    point: Point
    """Centre of mass as drawn; left and right are as given, nothing is mirrored."""

    def build(self, b: CarBuilder, name: str) -> None:
        """Add the payload; a flexible frame takes its force at several joints."""
        point = None if b.chassis.rigid else b.chassis.place(self.point)
        payload = b.m.payload(name, b.chassis.body, self.point, mass=self.mass, point=point)
        b.tie(self, "mass", payload, "mass")


class Vehicle(Section):
    """The car as a whole."""

    mass: Mass
    """Mass of the whole car without payloads, to be checked against the sum of its parts."""
    reference_point: Point
    """Origin of the vehicle axes: the centre of mass of the whole car."""
    length: Length
    """Length of the outline."""
    width: Length
    """Width of the outline without mirrors."""
    category: Literal["passenger_car", "racing_car", "truck"] | None = None
    """Kind of vehicle, against which numbers are called unusual; without the key against all kinds."""


class CarContent(Section):
    """The tables of a car file, typed."""

    schema_version: Annotated[Literal[2], Field(alias="schema")]
    """Version of the form of this file."""
    name: CarName
    """Name of the car, for files: lower-case letters, digits and underscores."""
    description: Text
    """What car it is."""
    vehicle: Vehicle
    """The car as a whole."""
    chassis: Chassis
    """Chassis with all that is fixed to it."""
    payload: dict[Name, Payload] = Field(default_factory=dict)
    """Persons and luggage by name."""
    front: Axle
    """Front axle."""
    rear: Axle
    """Rear axle."""
    steering: Steering
    """Steering of the front axle."""
    brakes: Brakes
    """Brakes."""
    drive: Drive
    """Engine or motor and what is between it and the wheels."""
    aerodynamics: Aerodynamics
    """Forces of the air."""
    road: RoadSection
    """Road under the car if no other is given."""
    ports: Ports = Field(default_factory=Ports)
    """Parts that other programs replace."""

    _folder: Path = PrivateAttr(Path())
    _data: dict[str, Any] = PrivateAttr(default_factory=dict)

    @property
    def folder(self) -> Path:
        """Folder of the file and its tables."""
        return self._folder

    @property
    def axles(self) -> dict[str, Axle]:
        """Front and rear axle by name."""
        return {"front": self.front, "rear": self.rear}

    @property
    def wheelbase(self) -> float:
        """Distance between the axles as drawn, m."""
        return self.front.wheel.centre[0] - self.rear.wheel.centre[0]

    @property
    def frame_section(self) -> Frame:
        """Description of the flexible frame.

        Raises
        ------
        ModelError
            The car has none.
        """
        if self.chassis.frame is None:
            raise ModelError(f"The car '{self.name}' has no flexible frame: its file has no table chassis.frame.")
        return self.chassis.frame

    def faults(self) -> Iterator[str]:
        """Yield contradictions between tables: steering and axles, frame and links, ports and the replaced parts."""
        yield from self.front.suspension.steering_faults(self.steering)
        yield from self.rear.suspension.steering_faults(None)
        if not self.front.suspension.linked and self.steering.without_travel:
            yield (
                f"{self.steering.key('kind')} is '{self.steering.kind}', {self.steering.without_travel}; an axle by "
                "its curves needs 'rack_by_angle'."
            )
        if not self.linked and self.chassis.frame is not None:
            yield f"{self.chassis.key('frame')} needs links; with an axle by its curves the chassis is rigid."
        if self.ports.tyre is not None and self.ports.road is not None:
            yield (
                "ports.tyre and ports.road are both given; the road under a tyre at a port belongs to the program that "
                "has the tyre, so leave one of them out."
            )
        for port, effect in (("gear", "asks for a gear"), ("clutch", "opens the clutch")):
            if getattr(self.ports, port) is None or (self.ports.torque is None and self.drive.kind == "automatic"):
                continue
            reason = (
                "ports.torque leaves the drive out" if self.ports.torque is not None else "an electric drive has none"
            )
            yield f"ports.{port} {effect} of an automatic drive, and {reason}; leave it out."
        port_of_rack = self.ports.steering
        if port_of_rack is not None and port_of_rack != self.steering.rack_port:
            yield (
                f"ports.steering is '{port_of_rack}' and steering.kind '{self.steering.kind}'; a rack_by_angle has the "
                "port rack_position, a column rack_force, a pitman_arm none."
            )
        if port_of_rack is not None:
            yield from self.steering.port_faults()

    def parameters(self) -> Iterator[tuple[Quantity, str, float]]:
        """Yield quantity, key path and value of each parameter of an FMU of the car, SI units."""
        for section in sections_of(self):
            for field in type(section).model_fields:
                quantity = section.quantity(field)
                if quantity is not None and quantity.change is not None and getattr(section, field) is not None:
                    yield from ((quantity, path, value) for path, value in section.numbers(field).items())

    def values(self) -> dict[str, float]:
        """Parameters of an FMU of the car by key path, SI units."""
        return {path: value for _, path, value in self.parameters()}

    def order(self, path: str) -> int:
        """Index of the key path of a number in the type of the file."""
        return self._paths.index(path)

    @cached_property
    def _paths(self) -> list[str]:
        """Key paths of all fields in the order of the type of the file."""
        return [section.key(field) for section in sections_of(self) for field in type(section).model_fields]

    @property
    def rack_end(self) -> Coordinates:
        """Inner end of the left tie rod of the front axle, m."""
        inner = self.front.suspension.rod_point("inner")
        assert inner is not None, "refused with the file, or without links"
        return inner

    @property
    def rack_direction(self) -> float:
        """1 if a rack that moves to the left steers to the left, otherwise -1."""
        return 1.0 if self.front.suspension.steers_left(self.front.wheel.centre) else -1.0

    @property
    def linked(self) -> bool:
        """Whether both axles have links."""
        return len(self.linked_axles) == len(self.axles)

    @property
    def linked_axles(self) -> dict[str, Axle]:
        """Axles with links, by name."""
        return {name: axle for name, axle in self.axles.items() if axle.suspension.linked}

    @property
    def footprint(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and largest x and y of the car as drawn, with a margin."""
        x = self.rear.wheel.centre[0] - self.rear.tyre.radius, self.front.wheel.centre[0] + self.front.tyre.radius
        half_width = 0.5 * self.vehicle.width
        return (x[0] - MARGIN, x[1] + MARGIN), (-half_width - MARGIN, half_width + MARGIN)
