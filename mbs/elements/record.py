"""What a force element hands to `compile()`: signals, data and states, all plain numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from mbs.common.affine import Affine
from mbs.kernel.header import ElementType

Check: TypeAlias = Callable[[object, str], float]
"""One of the checks of numbers of `mbs.common.checks`."""


@dataclass(frozen=True)
class Output:
    """One value an element computes beside its force; `display_unit` is what engineers read it in, if not the unit."""

    name: str
    unit: str
    description: str
    whole: bool = False
    display_unit: str = ""


@dataclass(frozen=True)
class ElementRecord:
    """A force element in the terms of the System file.

    Parameters
    ----------
    name : str
        Unique among the elements of a model.
    type : ElementType
        Kernel type; it fixes the meaning and order of all that follows.
    signals : sequence of Affine
        Local variables u, in the order of the type.
    real, integer : sequence
        Data of the element; `integer` holds input and road numbers.
    states : sequence of float
        Initial values of its slots.
    outputs : sequence of Output
        What it computes beside its force.
    tangent : bool
        Whether its force depends on the signals or their rates, so that the tangent couples their coordinates.
    elastic : bool
        Whether a spring in it holds the bodies it acts on.
    """

    name: str
    type: ElementType
    signals: Sequence[Affine]
    real: Sequence[float] = ()
    integer: Sequence[int] = ()
    states: Sequence[float] = ()
    outputs: Sequence[Output] = field(default_factory=tuple)
    real_names: Sequence[str] = ()
    """Names of the first entries of `real`, so that a parameter can be tied to one."""
    real_checks: Sequence[Check] = ()
    """What each of these must satisfy, also as a parameter writes it; by default any finite number will do."""
    tangent: bool = True
    elastic: bool = False
