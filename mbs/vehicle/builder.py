"""Model of a car under construction, and parameters that are tied to numbers of the car file."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from mbs.common.affine import AffineVector
from mbs.elements.record import ElementRecord
from mbs.model.coordinate import Coordinate
from mbs.model.model import Model
from mbs.model.parameters import Owner
from mbs.model.records import Input
from mbs.vehicle.chassis.mount import Mount
from mbs.vehicle.ports import Ports
from mbs.vehicle.quantities import Quantity
from mbs.vehicle.section import Section

Target: TypeAlias = "tuple[Owner, str | int, float, float, bool]"
"""Owner, number, scale, offset and whether the value is inverted."""


@dataclass
class _TiedNumber:
    """A number of the car file that becomes a parameter, and the numbers of the model that it sets."""

    section: Section
    """Section of the file with the number."""
    name: str
    """Name of its field."""
    quantity: Quantity
    """Range, unit and changeability of the field."""
    value: float
    """Value in the model."""
    part: str = ""
    """Component of a field with several numbers, otherwise empty."""
    targets: list[Target] = field(default_factory=list)
    """Numbers of the model that the parameter sets."""


@dataclass
class CarBuilder:
    """Model of a car under construction with its inputs, and the parameters to add to it."""

    m: Model
    """The model, to which bodies, joints and elements are added."""
    road: int
    """Number of the road under the chassis."""
    inputs: Mapping[str, Input]
    """Inputs of the driver, by name."""
    ports: Ports = field(default_factory=Ports)
    """Parts that other programs replace."""
    port_inputs: list[Input] = field(default_factory=list)
    """Inputs of the ports added so far."""
    wheel_roads: Mapping[str, int] = field(default_factory=dict)
    """Numbers of the roads under wheels whose road is not that under the chassis, by wheel."""
    port_senses: list[Callable[[], object]] = field(default_factory=list)
    """Functions that add the outputs of ports, called after all other outputs have been added."""
    rack: Coordinate | None = None
    """Travel of the rack, m, if the front axle is given by kinematic curves."""
    _chassis: Mount | None = None
    _tied: dict[str, _TiedNumber] = field(default_factory=dict)

    @property
    def chassis(self) -> Mount:
        """Mount of the chassis, to which the other parts are attached; set when the chassis is built."""
        assert self._chassis is not None, "the chassis is built first"
        return self._chassis

    @chassis.setter
    def chassis(self, mount: Mount) -> None:
        self._chassis = mount

    def tie(
        self,
        section: Section,
        name: str,
        owner: Owner,
        real: str | int,
        scale: float = 1.0,
        offset: float = 0.0,
        *,
        value: float | None = None,
        part: str = "",
        inverse: bool = False,
    ) -> None:
        """Make a number of the file a parameter that sets a number of an element, driving function or road.

        Name, unit, range and description of the parameter are as in the field of the file. Several calls for one
        number are allowed, for instance for both sides of the car.

        Parameters
        ----------
        section, name : Section, str
            Section of the file and its field, of a type that may change.
        owner, real : Owner, str or int
            As in `Model.parameter`.
        scale, offset : float
            The number is set to the value times `scale` plus `offset`.
        value : float, optional
            Value in the model, if it differs from the file.
        part : str
            Component of a field with several numbers, such as "x", appended to the name of the parameter.
        inverse : bool
            Whether `scale` is divided by the value instead of multiplied.
        """
        quantity = section.quantity(name)
        assert quantity is not None, f"{section.key(name)} is not a quantity"
        assert quantity.change is not None, f"{section.key(name)} is of a type that does not change"
        start = getattr(section, name) if value is None else value
        path = section.key(name) + (f".{part}" if part else "")
        tied = self._tied.setdefault(path, _TiedNumber(section, name, quantity, start, part))
        tied.targets.append((owner, real, scale, offset, inverse))

    def tie_numbers(self, section: Section, element: ElementRecord) -> None:
        """Tie each number that may change and has the same name in an element and in a section of the file."""
        for name, value in zip(element.real_names, element.real, strict=False):
            quantity = section.quantity(name) if name in type(section).model_fields else None
            if quantity is not None and quantity.change is not None:
                self.tie(section, name, element, name, value=value)

    def sense_components(self, name: str, vector: AffineVector, unit: str, text: str, *, order: int = 0) -> None:
        """Add outputs of the components of a point or vector along the axes of the earth.

        `name`, `text`: name and description, with {} for the axis; `order`: of the derivative with respect to time.
        """
        for k, c in enumerate("xyz"):
            component = vector[k]
            self.m.sense_coordinate(name.format(c), component, order=order, unit=unit, description=text.format(c))

    def parameters(self, order: Callable[[str], int], works: Mapping[str, tuple[float, float]]) -> None:
        """Add the tied numbers to the model as parameters.

        `order`: position of a key path in the type of the file; `works`: range of values by key path for which the
        car can be assembled.
        """
        for path, tied in sorted(self._tied.items(), key=lambda item: order(item[1].section.key(item[1].name))):
            q, description = tied.quantity, type(tied.section).model_fields[tied.name].description or ""
            self.m.parameter(
                path,
                tied.value,
                q.least,
                q.high,
                q.unit,
                f"{description.removesuffix('.')}, {tied.part}." if tied.part else description,
                targets=tied.targets,
                tunable=q.change == "tunable",
                works=works.get(path),
            )
