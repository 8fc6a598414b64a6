"""Spring of an oscillator in an FMU, which breaks at a time."""

import math
from typing import Any

from pythonfmu import Fmi2Causality, Fmi2Variability, Real

from tests.hosts.systems.partner import Partner


class HalfSpring(Partner):
    """A spring of 1 N/m; from `break_at` on it gives no number."""

    inputs = ("position",)
    outputs = ("force",)

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.break_at, self.time = 1e9, 0.0
        parameter = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.tunable}
        self.register_variable(Real("break_at", **parameter))

    def find(self, step: float) -> None:
        self.time += step
        self.value["force"] = math.nan if self.time > self.break_at else -self.value["position"]
