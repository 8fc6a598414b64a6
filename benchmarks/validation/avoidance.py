"""Published obstacle avoidance of ISO 3888-2 with a named car, against the hatchback.

The Renault Zoe of 2020 passed at 73 km/h and not at 78 km/h (km77, by evnewstopic.com), that of 2019 at 74 and 76 km/h
and not at 80 km/h (Motor1 Türkiye, by automotivetip.com), with human drivers and stability control. The hatchback is of
that class, with mass, tyres and springs between those of measured cars; it has no stability control, and the best of
four drivers of the catalogue steers it.
"""

from pathlib import Path

from benchmarks.validation.published_figures import Published
from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import settings_of_test
from hosts.catalogue.registry import standard_test
from hosts.fmu.fmu_file import fmu_file
from hosts.fmu.fmu_source import FmuSource

CAR = "hatchback"
SETTINGS = {"course": 2.0, "lowest": 50.0, "highest": 90.0}
FASTEST = Published(
    "Renault Zoe, ISO 3888-2: fastest entry without a cone", "km/h", {"km77": 73.0, "Motor1 Türkiye": 76.0}, 0.5
)


def compared(car: str = CAR) -> list[tuple[Published, float]]:
    """Fastest entry speed, published and of the hatchback by the catalogue, km/h."""
    test = standard_test("double_lane_change")
    record = test.perform(
        TestedCar(car, FmuSource(fmu_file(Path(car)))), settings_of_test(test, SETTINGS), lambda done: None
    )
    (speed,) = (m for m in record.measures if m.name == "iso_3888_2.entry_speed")
    return [(FASTEST, 3.6 * speed.value)]
