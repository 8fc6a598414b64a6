"""A step function in an FMU, which can refuse a communication step."""

from typing import Any

from pythonfmu import Fmi2Causality, Fmi2Variability, Real

from tests.hosts.systems.partner import Partner


class Jump(Partner):
    """0 at the start, 1 from the end of the first step on; steps from `refuse_from` on fail unless `given` is set."""

    inputs = ("given",)
    outputs = ("value",)

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.refuse_from, self.time = 1e9, 0.0
        parameter = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.tunable}
        self.register_variable(Real("refuse_from", **parameter))

    def find(self, step: float) -> None:
        self.time += step
        self.value["value"] = float(self.time > 0.0)

    def memory(self) -> float:
        return self.time

    def recall(self, memory: float) -> None:
        self.time = memory

    def do_step(self, current_time: float, step_size: float) -> bool:
        if self.time > self.refuse_from and self.value["given"] == 0.0:
            return False
        return super().do_step(current_time, step_size)
