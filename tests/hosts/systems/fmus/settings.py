"""Parameters of all types in an FMU."""

from typing import Any

from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer, Real, String


class Settings(Fmi2Slave):
    """Has parameters without an effect."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.file, self.count, self.on, self.size = "none", 1, False, 1.0
        parameter = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.tunable}
        for kind, name in ((String, "file"), (Integer, "count"), (Boolean, "on"), (Real, "size")):
            self.register_variable(kind(name, **parameter))

    def do_step(self, current_time: float, step_size: float) -> bool:
        return True
