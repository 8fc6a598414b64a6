"""Mass of an oscillator in an FMU."""

from typing import Any

from pythonfmu import Fmi2Causality, Fmi2Variability, Real

from tests.hosts.systems.partner import Partner


class HalfMass(Partner):
    """A mass of 1 kg that a force moves."""

    inputs = ("force",)
    outputs = ("position",)

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.start, self.speed = 0.0, 0.0
        parameter = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.tunable}
        self.register_variable(Real("start", **parameter))

    def find(self, step: float) -> None:
        if step == 0.0:
            self.value["position"] = self.start
        self.speed += step * self.value["force"]
        self.value["position"] += step * self.speed

    def memory(self) -> float:
        return self.speed

    def recall(self, memory: float) -> None:
        self.speed = memory
