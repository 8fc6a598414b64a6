"""Generalised force given by an input."""

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.common.affine import Affine
from mbs.common.checks import number
from mbs.common.errors import ModelError
from mbs.elements.element import Element
from mbs.elements.integers import input_index
from mbs.elements.reals import Reals
from mbs.elements.record import ElementRecord
from mbs.elements.record_checks import number_list


@dataclass(frozen=True)
class InputForce(Element):
    """An input times constant weights on some expressions."""

    input: int
    weights: Sequence[float] = (1.0,)
    """Force on each expression per unit of the input."""

    _noun = "an input force"
    _signals = None
    _integers = (input_index("input"),)
    _appended = None
    _tangent = False

    def record(self, name: str, signals: Sequence[Affine]) -> ElementRecord:
        """Make the record of the element for the kernel.

        Parameters
        ----------
        signals : sequence of Affine
            As many expressions as there are weights.
        """
        label = self._label(name)
        weights: Reals = {
            f"weight_{i}": (x, number) for i, x in enumerate(number_list(self.weights, f"the weights of {label}"))
        }
        if len(signals) != len(weights) or not signals:
            raise ModelError(f"T{label[1:]} has {len(weights)} weights for {len(signals)} signals, not one each.")
        return self._record(name, signals, (self.input,), appended=weights)
