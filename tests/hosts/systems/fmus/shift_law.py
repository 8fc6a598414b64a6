"""Gears by the speed of the engine, in a second FMU."""

from typing import Any

from tests.hosts.systems.partner import Partner

UP = 420.0  # rad/s
DOWN = 200.0  # rad/s
GEARS = 3


class ShiftLaw(Partner):
    """Demands the next gear above one engine speed, and the previous one below another."""

    inputs = ("engine_speed", "gear")
    outputs = ("request",)

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.request = 1

    def find(self, step: float) -> None:
        if self.value["gear"] == self.request:  # the last one is engaged
            self.request += (self.value["engine_speed"] > UP) - (self.value["engine_speed"] < DOWN)
            self.request = min(max(self.request, 1), GEARS)
        self.value["request"] = float(self.request)

    def memory(self) -> Any:
        return self.request

    def recall(self, memory: Any) -> None:
        self.request = memory
