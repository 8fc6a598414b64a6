"""Record of a force element for `compile()`: signals, numbers, integers, states and outputs."""

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.common.affine import Affine
from mbs.elements.reals import Check, Reals
from mbs.kernel.header.enumerations import ElementType


@dataclass(frozen=True)
class Output:
    """An output of an element besides its force."""

    name: str
    unit: str
    description: str
    whole: bool = False
    """Whether its values are whole numbers."""
    display_unit: str = ""
    """Customary unit, if it is not `unit`."""


@dataclass(frozen=True)
class ElementRecord:
    """A force element in the terms of the System file."""

    name: str
    type: ElementType
    """Kernel type; it fixes the meaning and order of all that follows."""
    signals: Sequence[Affine]
    """Local variables u, in the order of the type."""
    real: Sequence[float] = ()
    """Numbers, in the order of the type."""
    real_names: Sequence[str] = ()
    """Names of the first entries of `real`, by which parameters write to them."""
    real_checks: Sequence[Check] = ()
    """Check of each of these entries, also for values of parameters; without a check any finite number is valid."""
    integer: Sequence[int] = ()
    """Numbers of inputs and roads, and sizes."""
    states: Sequence[float] = ()
    """Initial values of its slots (internal variables)."""
    outputs: Sequence[Output] = ()
    """Outputs besides the force."""
    tangent: bool = True
    """Whether its force depends on the signals or their rates, so that the tangent couples their coordinates."""
    elastic: bool = False
    """Whether a spring in it holds the bodies it acts on."""


def columns(reals: Reals, *more: float) -> tuple[tuple[float, ...], tuple[str, ...], tuple[Check, ...]]:
    """`real`, `real_names` and `real_checks` of a record; `more`: numbers without a name."""
    values = tuple(x for x, _ in reals.values())
    return (*values, *more), tuple(reals), tuple(check for _, check in reals.values())
