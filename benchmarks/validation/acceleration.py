"""Published full-throttle accelerations from rest of named cars, against cars of the package with their data.

- **VW e-up of 2013**: 12.4 s to 100 km/h by its maker, with 210 N m and 60 kW (auto-motor-und-sport.de),
  1140 kg (derstandard.at). Here the hatchback, which has that motor, with that mass.
- **Renault Zoe of 2013**: 13.5 s to 100 km/h with 220 N m, 65 kW and 1503 kg (autoscout24.be); to 50 km/h in 4 s
  (aargauerzeitung.ch) or 3.7 s (niedrigenergieforum.de). Here the hatchback with that motor and that mass, and with its
  own assumed ratio, efficiency, drag and tyres.
- **BMW 320i of 1980**: 9.8 s to 60 mph, top speed 105 mph (Car and Driver, March 1980, by insurancenewsmag.com). Here
  the saloon, which has masses, rates and tyres of a measured 320i, and assumed engine, gears and drag.
"""

from dataclasses import dataclass

import numpy as np

from benchmarks.validation.drive import Array
from benchmarks.validation.published_figures import KMH, Published, full_throttle

MPH = 1.609344  # km/h
# kg, masses of the hatchback
_BODY = 1040.0
_WITH_DRIVER = 1250.0


def _with_mass(mass: float) -> dict[str, float]:
    """Settings of the hatchback for a mass with driver, kg."""
    return {"chassis.mass": _BODY + mass - _WITH_DRIVER}


@dataclass(frozen=True)
class FromRest:
    """A car with its settings, and its published times and top speed."""

    car: str
    settings: dict[str, float]
    times: dict[float, Published]
    """Times by the speed that is reached, km/h."""
    top_speed: Published | None = None


DRIVES = (
    FromRest(
        "hatchback",
        _with_mass(1140.0),
        {100.0: Published("VW e-up: 0 to 100 km/h", "s", {"auto-motor-und-sport.de": 12.4}, 0.05)},
    ),
    FromRest(
        "hatchback",
        {"drive.max_torque": 220.0, "drive.max_power": 65e3, **_with_mass(1503.0)},
        {
            50.0: Published(
                "Renault Zoe: 0 to 50 km/h", "s", {"aargauerzeitung.ch": 4.0, "niedrigenergieforum.de": 3.7}, 0.05
            ),
            100.0: Published("Renault Zoe: 0 to 100 km/h", "s", {"autoscout24.be": 13.5}, 0.05),
        },
    ),
    FromRest(
        "saloon",
        {},
        {60.0 * MPH: Published("BMW 320i of 1980: 0 to 60 mph", "s", {"Car and Driver, March 1980": 9.8}, 0.05)},
        Published("BMW 320i of 1980: top speed", "mph", {"Car and Driver, March 1980": 105.0}, 0.5),
    ),
)


def reached(time: Array, speed: Array, target: float) -> float:
    """Time at which a speed is first reached, s.

    `time`: s, shape (n,); `speed`: m/s, shape (n,); `target`: km/h.
    """
    after = int(np.argmax(speed >= target / KMH))
    if not speed[after] >= target / KMH:
        raise ValueError(f"The car reaches {KMH * speed.max():.1f} km/h; {target:g} km/h were asked for.")
    return float(np.interp(target / KMH, speed[after - 1 : after + 1], time[after - 1 : after + 1]))


def compared() -> list[tuple[Published, float]]:
    """Published times and top speeds, each with the figure of a car of the package."""
    results = []
    for drive in DRIVES:
        time, speed = full_throttle(drive.car, drive.settings)
        results += [(figure, reached(time, speed, to)) for to, figure in drive.times.items()]
        if drive.top_speed is not None:
            results.append((drive.top_speed, KMH / MPH * float(speed.max())))
    return results
