"""Generalised force given by an input."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.common.affine import Affine
from mbs.common.checks import number
from mbs.common.errors import ModelError
from mbs.elements.reals import Reals
from mbs.elements.record import ElementRecord, columns
from mbs.elements.record_checks import index, several
from mbs.kernel.header.enumerations import ElementType


@dataclass(frozen=True)
class InputForce:
    """An input times constant weights on some expressions."""

    input: int
    weights: Sequence[float] = (1.0,)
    """Force on each expression per unit of the input."""

    def record(self, name: str, signals: Sequence[Affine]) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        signals : sequence of Affine
            As many expressions as there are weights.
        """
        what = f"the input force '{name}'"
        weights: Reals = {
            f"weight_{i}": (x, number) for i, x in enumerate(several(self.weights, f"the weights of {what}"))
        }
        if len(signals) != len(weights) or not signals:
            raise ModelError(f"T{what[1:]} has {len(weights)} weights for {len(signals)} signals, not one each.")
        return ElementRecord(
            name,
            ElementType.INPUT_FORCE,
            signals,
            *columns(weights),
            (index(self.input, f"The input of {what}"),),
            tangent=False,
        )
