"""A host of FMI 3.0 that calls an FMU through FMPy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import fmpy
from fmpy.simulation import instantiate_fmu

STEP = 0.01


class Host3:
    """An instance of FMI 3.0, its variables by name."""

    def __init__(self, fmu: Path) -> None:
        self.description = fmpy.read_model_description(str(fmu))
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        self.messages: list[str] = []
        self.slave: Any = instantiate_fmu(
            fmpy.extract(str(fmu)), self.description, logger=lambda *a: self.messages.append(a[-1].decode())
        )

    def start(self) -> Host3:
        self.slave.enterInitializationMode(startTime=0.0)
        self.slave.exitInitializationMode()
        return self

    def get(self, name: str, size: int = 1) -> list[float]:
        return list(self.slave.getFloat64([self.references[name]], size))

    def set(self, name: str, value: float) -> None:
        self.slave.setFloat64([self.references[name]], [value])

    def run(self, steps: int, begin: int = 0) -> list[float]:
        for k in range(begin, begin + steps):
            self.slave.doStep(k * STEP, STEP)
        return self.get(self.outputs()[0], 2 if "position" in self.outputs()[0] else 1)

    def outputs(self) -> list[str]:
        return [v.name for v in self.description.modelVariables if v.causality == "output"]
