"""Published figures of a car, and full-throttle runs on a straight road."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.validation.drive import Array
from hosts.driving.co_simulation import run
from hosts.driving.manoeuvre import Manoeuvre
from hosts.fmu.fmu import Fmu
from hosts.fmu.fmu_file import fmu_file

LENGTH = 90.0  # s, duration of a run
STEP = 0.01  # s
KMH = 3.6  # km/h per m/s
_HUNDRED = 100.0 / KMH


@dataclass(frozen=True)
class Published:
    """A figure that several sources publish."""

    test: str
    unit: str
    values: dict[str, float]
    """Values by source."""
    digit: float
    """Half a unit of the last published digit: the reading error."""

    def row(self, computed: float) -> dict[str, Any]:
        """Row of the table: the verdict is whether the computed value is within the published ones and their
        reading error.
        """
        low, high = min(self.values.values()) - self.digit, max(self.values.values()) + self.digit
        off = computed / float(np.clip(computed, low, high)) - 1.0
        verdict = "within" if off == 0.0 else f"{100.0 * off:+.2g} %"
        return {
            "test": f"{self.test}, {self.unit}",
            "published": "; ".join(f"{value:g} ({source})" for source, value in self.values.items()),
            "read within": self.digit,
            "car": computed,
            "verdict": verdict,
        }


FROM_REST = Published("0 to 100 km/h", "s", {"v12-gt.com": 6.00, "ramp.space, ramp 28": 4.5}, 0.05)
TOP_SPEED = Published(
    "top speed", "km/h", {"v12-gt.com": 287.0, "ramp.space, ramp 28": 290.0, "favx.free.fr": 280.0}, 0.5
)


def full_throttle(car: str, settings: dict[str, float]) -> tuple[Array, Array]:
    """Time, s, and speed, m/s, of a car from rest at full throttle, with the steering straight."""
    time = np.array([0.0, LENGTH])
    inputs = {"steering": np.zeros(2), "throttle": np.ones(2), "brake": np.zeros(2)}
    with Fmu(fmu_file(Path(car))) as fmu:
        result = run(fmu, Manoeuvre("full throttle", time, inputs, LENGTH, dict(settings)), STEP)
    assert not result.failed_steps, result.messages
    return result.time, result["speed"]


def published_rows(time: Array, speed: Array) -> list[dict[str, Any]]:
    """Rows of the table, from a full-throttle run."""
    fast = int(np.argmax(speed >= _HUNDRED))
    reached = float(np.interp(_HUNDRED, speed[fast - 1 : fast + 1], time[fast - 1 : fast + 1]))
    return [FROM_REST.row(reached), TOP_SPEED.row(KMH * float(speed.max()))]
