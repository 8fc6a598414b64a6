"""What the parts of a car share while a model is made of it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

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


@dataclass
class _Tied:
    """A number of the file and where it is written."""

    section: Section
    name: str
    quantity: Quantity
    value: float
    part: str = ""
    targets: list[Target] = field(default_factory=list)


@dataclass
class CarBuilder:
    """The model so far, its inputs, and the parameters that will be in it."""

    m: Model
    """Gets bodies, joints and elements."""
    road: int
    """Number of the road under the chassis."""
    inputs: Mapping[str, Input]
    """Of the driver, by name."""
    ports: Ports = field(default_factory=Ports)
    """Which parts other programs replace."""
    port_inputs: list[Input] = field(default_factory=list)
    """Those of the ports so far."""
    wheel_roads: Mapping[str, int] = field(default_factory=dict)
    """Those under wheels that have one of their own."""
    port_senses: list[Callable[[], object]] = field(default_factory=list)
    """Add the outputs of ports, which come after all others."""
    rack: Coordinate | None = None
    """Travel of the rack, m, of a front axle by its curves."""
    _chassis: Mount | None = None
    _tied: dict[str, _Tied] = field(default_factory=dict)

    @property
    def chassis(self) -> Mount:
        """What the rest of the car is fixed to; set once the chassis is there."""
        assert self._chassis is not None, "the chassis is made first"
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
        """Let a number of the file be a parameter of the model that writes a real of an element, guide or road.

        Name, unit, range and description of the parameter are those of the file's type. May be called several times
        for one number: for both sides, for instance.

        Parameters
        ----------
        name : str
            Its field, whose type says that it may change.
        owner, real : Owner, str or int
            As in `Model.parameter`.
        scale, offset : float
            The value times `scale` plus `offset` is written.
        value : float, optional
            In the model, where it is not that of the file.
        part : str
            Of a field with several numbers, as "x": the parameter has it behind its name.
        inverse : bool
            Whether `scale` over the value is written, in place of their product.
        """
        quantity = section.quantity(name)
        assert quantity is not None, f"{section.key(name)} is not a quantity"
        assert quantity.change is not None, f"{section.key(name)} is of a type that does not change"
        start = getattr(section, name) if value is None else value
        path = section.key(name) + (f".{part}" if part else "")
        tied = self._tied.setdefault(path, _Tied(section, name, quantity, start, part))
        tied.targets.append((owner, real, scale, offset, inverse))

    def tie_numbers(self, section: Section, element: ElementRecord) -> None:
        """`tie` each number that may change and that has the same name in an element and in the file."""
        for name, value in zip(element.real_names, element.real, strict=False):
            quantity = section.quantity(name) if name in type(section).model_fields else None
            if quantity is not None and quantity.change is not None:
                self.tie(section, name, element, name, value=value)

    def parameters(self, order: Callable[[str], int], works: Mapping[str, tuple[float, float]]) -> None:
        """Write what was tied into the model.

        `order`: place of a key path in the file's type; `works`: by key path, between which values the car works.
        """
        for path, tied in sorted(self._tied.items(), key=lambda item: order(item[1].section.key(item[1].name))):
            q, text = tied.quantity, type(tied.section).model_fields[tied.name].description or ""
            self.m.parameter(
                path,
                tied.value,
                q.least,
                q.high,
                q.unit,
                f"{text.removesuffix('.')}, {tied.part}." if tied.part else text,
                targets=tied.targets,
                tunable=q.change == "tunable",
                works=works.get(path),
            )
