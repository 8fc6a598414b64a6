"""Records of inputs, driving functions, parameters, switches and constants of a model."""

from dataclasses import dataclass
from enum import IntEnum

from mbs.common.affine import Affine
from mbs.kernel.header.enumerations import DrivingFunctionType, ParameterTarget


@dataclass(frozen=True)
class Constant:
    """A number that is stated, not computed."""

    name: str
    """Unique, such as ``vehicle.wheelbase``."""
    value: float
    """In `unit`."""
    unit: str
    description: str


class Role(IntEnum):
    """Check that an FMU makes of an input while it runs."""

    NONE = 0
    NORMAL = 1
    """x of the unit normal of a road, whose y and z follow it."""
    ANSWER = 2
    """x of the point of an answer on a road; `near`: sensor of x of the part that meets the road there."""
    HUB = 3
    """x of the force of a tyre; `near` is the sensor of the velocity of the hub along x, `figures` are settling time of
    its carcass at rest, s, how that goes with speed, s2/m2, settling time by speed, s2/m, and stiffness over inertia of
    the spin, 1/s2."""


@dataclass(frozen=True)
class Input:
    """A number that a host sets; `index`: number in the System, `port`: whether another program sets it at every step.

    An FMU checks inputs with a `role` by the sensor `near` and those after it; its trial runs change them by `tried`
    from the start.
    """

    name: str
    index: int
    start: float
    min: float
    max: float
    unit: str
    description: str
    whole: bool = False
    port: bool = False
    role: Role = Role.NONE
    near: str = ""
    tried: float | None = None
    figures: tuple[float, ...] = ()


@dataclass(frozen=True)
class Ahead:
    """An output of FMUs only: the sensor `value` extrapolated by communication steps with the sensor `rate`."""

    name: str
    unit: str
    description: str
    value: str
    rate: str


@dataclass(frozen=True)
class Switch:
    """A switch of constraint rows; `index`: number in the System, `on`: whether it is on at the start."""

    name: str
    index: int
    on: bool


@dataclass(frozen=True)
class Armature:
    """Inertia that turns `ratio` times as fast as a coordinate; made by `Model.armature`."""

    name: str
    coordinate: Affine
    """The angle as an expression, rad."""
    inertia: float
    """Inertia of the rotor about its own axis, kg m2."""
    ratio: float


@dataclass(frozen=True)
class DrivingFunction:
    """A prescribed motion; `reals`: numbers as in the System file, `second`: number of a second input or -1."""

    name: str
    index: int
    type: DrivingFunctionType
    input: int
    reals: tuple[float, ...]
    start: float
    unit: str
    second: int = -1


@dataclass(frozen=True)
class Parameter:
    """Writes value * scale + offset to data of elements, driving functions, roads, payloads and others."""

    name: str
    value: float
    """Compiled value, in `unit`."""
    min: float
    """Lower limit, in `unit`."""
    max: float
    """Upper limit, in `unit`."""
    unit: str
    description: str
    targets: tuple[tuple[int, int, int, float, float, bool], ...]
    """Family, index in the family, index of the real, scale, offset, whether the scale is divided by the value."""
    tunable: bool = True
    """Whether it may be set while the model moves."""
    works: tuple[float, float] | None = None
    """Range of validity of the model, smallest and largest value in `unit`."""

    @property
    def whole(self) -> bool:
        """Whether its values are whole numbers, because it sets a switch."""
        return any(target[0] == ParameterTarget.SWITCH for target in self.targets)


@dataclass(frozen=True)
class RoadFileParameter:
    """A parameter that is text: the file of a road."""

    name: str
    road: int
    start: str
    """Path of the file; empty: the road of the model."""

    @property
    def description(self) -> str:
        """Description of the parameter, for hosts."""
        return (
            "File of the road (made by ali3 road, or a table .csv with coordinates) in place of the built-in one, "
            "which an empty text means: a path, or the name of one in the folder roads of the resources"
        )
