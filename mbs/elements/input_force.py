"""Generalised force given by an input."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.common.affine import Affine
from mbs.common.checks import number
from mbs.common.errors import ModelError
from mbs.elements.element import Element
from mbs.elements.integers import an_input
from mbs.elements.reals import Reals
from mbs.elements.record import ElementRecord
from mbs.elements.record_checks import several


@dataclass(frozen=True)
class InputForce(Element):
    """An input times constant weights on some expressions."""

    input: int
    weights: Sequence[float] = (1.0,)
    """Force on each expression per unit of the input."""

    _words = "an input force"
    _signals = None
    _integers = (an_input("input"),)
    _behind = None
    _tangent = False

    def record(self, name: str, signals: Sequence[Affine]) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        signals : sequence of Affine
            As many expressions as there are weights.
        """
        what = self._what(name)
        weights: Reals = {
            f"weight_{i}": (x, number) for i, x in enumerate(several(self.weights, f"the weights of {what}"))
        }
        if len(signals) != len(weights) or not signals:
            raise ModelError(f"T{what[1:]} has {len(weights)} weights for {len(signals)} signals, not one each.")
        return self._record(name, signals, (self.input,), behind=weights)
