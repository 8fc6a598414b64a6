"""Physical quantities of a car file: unit, range, and whether a finished FMU may change them."""

import math
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from ali3.message_text import unit_text

Change = Literal["tunable", "fixed"]


@dataclass(frozen=True)
class Quantity:
    """Unit and range of a number."""

    unit: str
    """SI unit; "1" for a number without one."""
    low: float
    """Least value."""
    high: float
    """Largest value. It is less than 1000 `low` if that is positive, so that a value in a unit 1000 times too large or
    too small is always outside; of inertias the radius of gyration and the two other moments show it."""
    zero: bool = False
    """Whether 0 is allowed too; a parameter may then be anywhere between 0 and `high`."""
    change: Change | None = None
    """Whether the FMU has it as a parameter: one that may change while driving, or before the start only."""

    def check(self, value: float) -> float:
        """The value, if it is in the range. `value`: number in `unit`."""
        if math.isfinite(value) and (self.low <= value <= self.high or (self.zero and value == 0.0)):
            return value
        raise PydanticCustomError("quantity", "must be {range}", {"range": self.range})

    @property
    def range(self) -> str:
        """The range in words."""
        zero = "0 or " if self.zero and self.low > 0.0 else ""
        limits = f"{self.low:g}" if self.low == self.high else f"between {self.low:g} and {self.high:g}"
        return f"{zero}{limits}{unit_text(self.unit)}"

    @property
    def least(self) -> float:
        """The lower limit of a parameter."""
        return min(self.low, 0.0) if self.zero else self.low

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_after_validator_function(self.check, core_schema.float_schema(strict=True))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        limits = {"type": "number", "minimum": self.low, "maximum": self.high}
        if self.zero and self.low > 0.0:
            return {"anyOf": [{"const": 0}, limits], "unit": self.unit}
        return limits | {"unit": self.unit}


def quantities_in(annotation: Any) -> list[Quantity]:
    """Quantities of a type, each once: of a number, or of the elements of a list."""
    quantities: dict[Quantity, None] = {}
    for item in (*getattr(annotation, "__metadata__", ()), *get_args(annotation)):
        quantities |= dict.fromkeys([item] if isinstance(item, Quantity) else quantities_in(item))
    return list(quantities)


Coordinate = Annotated[float, Quantity("m", -9.0, 9.0)]
"""A coordinate of the drawing."""
Point = tuple[Coordinate, Coordinate, Coordinate]
"""x forward, y left, z up from the ground under the front axle."""
MassCentre = Annotated[float, Quantity("m", -9.0, 9.0, change="fixed")]
Length = Annotated[float, Quantity("m", 0.01, 9.0)]
FreeLength = Annotated[float, Quantity("m", 0.05, 2.0, change="tunable")]
SmallLength = Annotated[float, Quantity("m", 0.0005, 0.4)]
Travel = Annotated[float, Quantity("m", 0.001, 0.5)]
Thickness = Annotated[float, Quantity("m", 0.0003, 0.2)]

Mass = Annotated[float, Quantity("kg", 20.0, 1.9e4)]
ChassisMass = Annotated[float, Quantity("kg", 20.0, 1.9e4, change="fixed")]
PartMass = Annotated[float, Quantity("kg", 0.2, 190.0)]
Payload = Annotated[float, Quantity("kg", 1.0, 900.0, zero=True, change="fixed")]
Inertia = Annotated[float, Quantity("kg.m2", 5.0, 9.5e4, change="fixed")]
PartInertia = Annotated[float, Quantity("kg.m2", 0.002, 60.0)]
WheelInertia = Annotated[float, Quantity("kg.m2", 0.01, 50.0)]
ProductOfInertia = Annotated[float, Quantity("kg.m2", -2e4, 2e4, change="fixed")]

Stiffness = Annotated[float, Quantity("N/m", 1e3, 9e5, change="tunable")]
Damping = Annotated[float, Quantity("N.s/m", 50.0, 4.9e4, zero=True, change="tunable")]
StopStiffness = Annotated[float, Quantity("N/m", 2e4, 1.9e7)]
MetalStiffness = Annotated[float, Quantity("N/m", 1e5, 9e7)]
HysteresisLoss = Annotated[float, Quantity("s/m", 0.01, 9.0, zero=True)]
TyreStiffness = Annotated[float, Quantity("N/m", 1e4, 9e6)]
TyreDamping = Annotated[float, Quantity("N.s/m", 10.0, 9.9e3, zero=True)]
CarcassStiffness = Annotated[float, Quantity("N/m", 1e4, 9e6)]
Force = Annotated[float, Quantity("N", 200.0, 1.9e5)]
SlopeForce = Annotated[float, Quantity("N", 2e3, 1.9e6)]
Torque = Annotated[float, Quantity("N.m", 5.0, 4.9e3, change="tunable")]
SmallTorque = Annotated[float, Quantity("N.m", 0.5, 400.0, zero=True)]
MotorPower = Annotated[float, Quantity("W", 1e3, 9e5, change="tunable")]
RegenerationTorque = Annotated[float, Quantity("N.m", 0.5, 400.0, zero=True, change="tunable")]
DriveRatio = Annotated[float, Quantity("1", 0.3, 60.0, change="fixed")]
RotorInertia = Annotated[float, Quantity("kg.m2", 1e-3, 0.9)]
MotorSpeed = Annotated[float, Quantity("rad/s", 20.0, 4000.0)]
Efficiency = Annotated[float, Quantity("1", 0.3, 1.0, change="tunable")]
ReverseShare = Annotated[float, Quantity("1", 0.05, 1.0, zero=True)]
FadeSpeed = Annotated[float, Quantity("rad/s", 1.0, 500.0, change="tunable")]
AngularSpeed = Annotated[float, Quantity("rad/s", 1.0, 999.0)]
Frequency = Annotated[float, Quantity("Hz", 0.5, 400.0)]
Area = Annotated[float, Quantity("m2", 0.05, 20.0, zero=True, change="tunable")]
AirDensity = Annotated[float, Quantity("kg/m3", 0.3, 9.0, change="tunable")]
MaterialDensity = Annotated[float, Quantity("kg/m3", 300.0, 2.5e4)]
YoungsModulus = Annotated[float, Quantity("Pa", 1e9, 9e11)]
YieldStrength = Annotated[float, Quantity("Pa", 5e6, 4e9)]
Ratio = Annotated[float, Quantity("1", 0.3, 60.0)]
Fraction = Annotated[float, Quantity("1", 0.002, 1.0, zero=True)]
CamberSlip = Annotated[float, Quantity("1", 0.005, 2.0, zero=True)]
Slip = Annotated[float, Quantity("1", 0.01, 9.0)]
Coefficient = Annotated[float, Quantity("1", 0.003, 2.9, zero=True)]
TrailShare = Annotated[float, Quantity("1", 0.003, 0.5, zero=True)]
Factor = Annotated[float, Quantity("1", 0.02, 10.0, zero=True, change="tunable")]
"""Multiplies what the file gives; 1 leaves it."""
ScalingFactor = Annotated[float, Quantity("1", 0.02, 10.0, change="tunable")]
InflationPressure = Annotated[float, Quantity("Pa", 2e4, 1.5e6)]
Time = Annotated[float, Quantity("s", 0.01, 9.0)]
CreepTorque = Annotated[float, Quantity("N.m", 0.5, 200.0, zero=True, change="tunable")]
TorsionalStiffness = Annotated[float, Quantity("N.m/rad", 20.0, 1.9e4, change="tunable")]
StickStiffness = Annotated[float, Quantity("N.m/rad", 1e4, 9e6)]
YawStiffness = Annotated[float, Quantity("N.m/rad", 100.0, 9e4)]
YawDamping = Annotated[float, Quantity("N.m.s/rad", 0.5, 450.0)]
SteeringFriction = Annotated[float, Quantity("N.m", 0.02, 9.0, zero=True, change="tunable")]
PrescribedFriction = Annotated[float, Quantity("N.m", 0.02, 9.0, zero=True)]
RackFriction = Annotated[float, Quantity("N", 5.0, 2000.0, zero=True, change="tunable")]
SteeringWheelInertia = Annotated[float, Quantity("kg.m2", 0.002, 1.0)]
ColumnStiffness = Annotated[float, Quantity("N.m/rad", 15.0, 1.4e4, change="tunable")]
ColumnDamping = Annotated[float, Quantity("N.m.s/rad", 0.01, 9.0, zero=True, change="tunable")]
AssistanceFactor = Annotated[float, Quantity("1", 0.1, 60.0, zero=True, change="tunable")]
AssistanceTorque = Annotated[float, Quantity("N.m", 0.5, 400.0, zero=True, change="tunable")]
OneOrZero = Annotated[float, Quantity("1", 1.0, 1.0, zero=True, change="fixed")]
SteeringWheelDegrees = Annotated[float, Quantity("deg", 4.0, 3600.0, zero=True)]
RackMillimetres = Annotated[float, Quantity("mm", 0.6, 500.0, zero=True)]
RackPerTurn = Annotated[float, Quantity("m", 0.01, 0.3, change="fixed")]
SteeringBox = Annotated[float, Quantity("1", 3.0, 60.0, change="fixed")]
ArmAngle = Annotated[float, Quantity("rad", 0.1, 1.0)]
PinionPerTurn = Annotated[float, Quantity("m", 0.01, 0.3)]
SteerPerMoment = Annotated[float, Quantity("rad/(N.m)", 2e-6, 9e-4)]
SteerPerForce = Annotated[float, Quantity("rad/N", -1e-4, 1e-4)]
DisplacementPerForce = Annotated[float, Quantity("m/N", 1e-7, 1e-5, zero=True)]
LossTime = Annotated[float, Quantity("s", 1e-4, 0.05)]
AlignmentAngle = Annotated[float, Quantity("rad", -0.2, 0.2, change="fixed")]
RoadWheelAngle = Annotated[float, Quantity("rad", 0.1, 1.2)]
PoissonsRatio = Annotated[float, Quantity("1", 0.01, 0.49, zero=True)]
RoadFriction = Annotated[float, Quantity("1", 0.01, 2.0, zero=True, change="tunable")]
ReferenceFriction = Annotated[float, Quantity("1", 0.02, 10.0)]
WheelSpeed = Annotated[float, Quantity("rad/s", 0.5, 400.0)]
RatioFactor = Annotated[float, Quantity("1", 0.5, 2.0, change="fixed")]
Compression = Annotated[float, Quantity("m", -0.5, 0.9)]
SpringForce = Annotated[float, Quantity("N", -2e5, 4e5)]
DamperSpeed = Annotated[float, Quantity("m/s", -9.0, 9.0)]
DamperForce = Annotated[float, Quantity("N", -2e5, 2e5)]
LiftArea = Annotated[float, Quantity("m2", -9.0, 9.0, change="tunable")]
BrakeTorque = Annotated[float, Quantity("N.m", 30.0, 2.9e4, change="tunable")]
BrakePressure = Annotated[float, Quantity("Pa", 1e5, 4e7)]
HandBrakeTorque = Annotated[float, Quantity("N.m", 10.0, 9e3, zero=True, change="tunable")]
Balance = Annotated[float, Quantity("1", 0.01, 1.0, zero=True, change="tunable")]
Locking = Annotated[float, Quantity("1", 0.01, 1.0, zero=True, change="tunable")]
BrakeSide = Annotated[float, Quantity("1", -0.5, 0.5, change="tunable")]
TyreRate = Annotated[float, Quantity("N/m", 1e4, 9e6, change="tunable")]
RollingResistance = Annotated[float, Quantity("1", 0.001, 0.3, zero=True, change="tunable")]
