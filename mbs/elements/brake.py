"""Brake that holds by sticking."""

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import flag
from mbs.elements.element import Element
from mbs.elements.integers import Integer, input_index
from mbs.elements.reals import NotNegative, Positive
from mbs.elements.record import ElementRecord, Output
from mbs.elements.wheel_signals import carrier_signals


@dataclass(frozen=True)
class Brake(Element):
    """Elastoplastic friction torque between a wheel and its carrier.

    Spring and damper in series with a slider: ``k z + c z'``, at most pedal times largest torque times share, plus hand
    brake times its torque; ``z'`` is the spin against the carrier while it sticks.
    """

    max_torque: NotNegative
    """Torque at full pedal, N m."""
    stick_stiffness: Positive
    """Stiffness of a standing brake about the wheel's axis, N m/rad."""
    stick_damping: Positive
    """Damping of a standing brake, N m s/rad."""
    share: NotNegative = 1.0
    """Factor on max_torque, so that a total torque and a balance may be parameters."""
    hand_torque: NotNegative = 0.0
    """Torque at full hand brake, N m; the torque of the pedal is added to it."""
    side: NotNegative = 1.0
    """Factor on the share, so that brakes that differ from left to right may be a parameter."""

    _noun = "a brake"
    _signals = (("f", 3), ("g", 3), ("spin", 1))
    _integers = (
        input_index("pedal", "the input"),
        input_index("hand", "the hand brake", missing=True),
        Integer("by_size", most=1, optional=True, noun="the choice of a size as the input"),
    )
    _states = (0.0, 0.0)
    _outputs = (
        Output("torque", "N m", "torque of the brake on the wheel about the axis"),
        Output("sticking", "1", "1 while the brake sticks, else 0"),
        Output("rate", "rad/s", "spin of the wheel relative to its carrier"),
        Output("power", "W", "power of the torque on wheel and carrier together"),
    )

    def record(
        self,
        name: str,
        f: AffineVector,
        g: AffineVector,
        spin: Affine,
        input: int,
        hand: int | None = None,
        *,
        by_size: bool = False,
    ) -> ElementRecord:
        """Make the record of the element for the kernel.

        Parameters
        ----------
        input : int
            Number of the input of the pedal, 0 to 1, or of the size.
        hand : int, optional
            Number of the input of the hand brake, 0 to 1.
        by_size : bool
            Whether `input` is not a pedal but any number of at least 0, and `max_torque` the torque per unit of it.
        """
        label = self._label(name)
        sized = 1 if flag(by_size, f"The by_size of {label}") else None
        return self._record(name, (*carrier_signals(f, g, label), spin), (input, hand, sized))
