"""A sensor of a model: its type, signals and numbers."""

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.common.affine import Affine
from mbs.kernel.header.enumerations import SensorType
from mbs.model.joints.joint import Joint

MAX_FACTORS = 3


@dataclass(frozen=True)
class Term:
    """``weight * lam * factors[0] * factors[1] * ... * driving function * slope``: the multiplier of an equation of a
    joint times at most three expressions, a driving function and the slope of a driving function by a table (-1: none).
    `joint` is by default the joint of the sensor.
    """

    weight: float
    equation: int
    factors: tuple[Affine, ...] = ()
    guide: int = -1
    joint: Joint | None = None
    slope: int = -1


@dataclass(frozen=True)
class Sensor:
    """A sensor: an output of the model."""

    name: str
    unit: str
    description: str
    type: SensorType
    """Sensor type of the System file."""
    signals: Sequence[Affine] = ()
    """Its signals, whose numbers follow `integers`."""
    integers: Sequence[int] = ()
    reals: Sequence[float] = ()
    joint: Joint | None = None
    """The joint of a joint force; ``integers`` are then numbers of its equations."""
    joints: Sequence[Joint] = ()
    """Joints whose rows, three each, are the last integers."""
    terms: Sequence[Term] = ()
    """Products with multipliers of `joint`, which determine all integers and reals."""
    whole: bool = False
    """Whether its values are whole numbers."""
    display_unit: str = ""
    """Customary unit in engineering, if it is not `unit`."""
    notice: str = ""
    """Sentence that a run reports if the value is not zero; empty: none."""
    computed: bool = True
    """False for a placeholder of a number that the scene computes at another fidelity."""

    @property
    def factors(self) -> int:
        """Number of its reals, without the mass of all bodies."""
        return len(self.terms) or len(self.reals)
